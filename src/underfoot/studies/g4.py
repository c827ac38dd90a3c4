"""Grant report G.4: fluid pressure under six shoes in two fluids on the slip tester."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from underfoot.core import Progress, silent

from .g4_conditions import (
    DepthRow,
    Reading,
    at_lower_force,
    conditions,
    depth_series,
    reading,
    sensitivities,
)
from .g4_judged import Judged, judged
from .g4_lines import all_lines, threshold
from .g4_tables import conditions_table, depth_table, inputs_table, lower_table
from .study_result import StudyResult
from .verdict import Erratum

if TYPE_CHECKING:
    from underfoot.assess.sensitivity import Sensitivity

DEPTHS = (0.0, 0.1e-3, 0.2e-3, 0.3e-3, 0.5e-3, 0.8e-3, 1.5e-3, 2.0e-3, 3.0e-3)
QUICK_DEPTHS = (0.0, 0.3e-3, 0.8e-3, 1.5e-3, 3.0e-3)
ERRATA = (
    Erratum("G.4.2, first sentence", "untreated shoes", "untreaded shoes", "no shoe was treated"),
    Erratum(
        "G.4.2, last sentence", "medium or full tread", "half or full tread",
        "Table 6 and Fig. 28 know half tread only",
    ),
    Erratum(
        "G.4.2, p < 0.01", "three terms of an analysis of variance", "the signs and sizes",
        "the twelve printed loads alone do not give these p; what was repeated is not said",
    ),
)  # fmt: skip
ASSUMPTIONS = (
    "One heel for all six shoes (slip_tester_heel): 75 x 70 mm, rear radius 33 mm, ground flat at "
    "10 degrees over the rear 30 mm, edges rounded by 2 mm, 25 mm of one rubber on a stiff last. "
    "The report prints no shape.",
    "Plan form: a last's heel is about a quarter of its length, the heel of a men's size 9 65 to "
    "75 mm wide inside. It was 60 x 60 mm before; loads and peaks of both were computed.",
    "Lugs of 5 mm in a grid (those of G.5); arc channel of the untreaded athletic shoe 4 mm wide, "
    "1 mm deep, 20 mm from the back: not printed.",
    "interface.roughness_beyond_cutoff = 2: chosen on one reading, the untreaded work shoe in "
    "glycerol, with an earlier compliance and heel, and not changed since. The stylus sees no "
    "waves beyond 0.8 mm.",
    "Rq 1.25 Ra, modulus from Shore A (Gent), starting film 50 um, load at 30 ms, read at 120 ms.",
    "Inlet of 10 mm: a pocket of one pressure that does not change the film.",
    "Nothing is set for one condition alone.",
)


def run(
    *, quick: bool = False, processes: int | None = None, progress: Progress = silent
) -> StudyResult:
    """Return the twelve conditions beside the report, with bands from what it leaves open.

    Parameters
    ----------
    quick
        The quick grid, no bands under treaded shoes, fewer depths.
    processes
        For the variants behind the bands; None takes the cores, at most 4.
    progress
        Sees every condition; variants are kept on disk, so that a run stopped early goes on.
    """
    started, process = time.perf_counter(), time.process_time()
    readings: list[Reading] = []
    plan = conditions()
    for number, one in enumerate(plan):
        progress(one.name, 0.3 * number / len(plan))
        readings.append(reading(one, quick=quick))

    def later(stage: str, fraction: float, residual: float | None = None) -> None:
        progress(stage, 0.3 + 0.6 * fraction, residual)

    varied, lost = sensitivities(
        [one for one in plan if one.untreaded or not quick], processes=processes, progress=later
    )
    progress("Tread depth and lower force", 0.9)
    depths = depth_series(QUICK_DEPTHS if quick else DEPTHS, processes=processes)
    lower = at_lower_force(readings, processes=processes)
    numerics = plan[0].case.numerics
    refinement = 1.0 if quick else numerics.quick_grid_spacing / numerics.grid_spacing
    results = [
        judged(one, varied.get(one.condition.name), refinement=refinement) for one in readings
    ]
    progress("done", 1.0)
    return StudyResult(
        "g4",
        all_lines(results, depths),
        (
            conditions_table(results),
            lower_table(results, lower),
            *(inputs_table(one, varied[one.name]) for one in plan if one.printed_load is not None),
            depth_table(depths),
        ),
        conclusions(results, varied, depths),
        ERRATA,
        _notes(results, lost, quick),
        ASSUMPTIONS,
        time.perf_counter() - started,
        time.process_time() - process,
        {"results": tuple(results), "varied": varied, "depths": tuple(depths)},
    )


def conclusions(
    results: Sequence[Judged], varied: Mapping[str, Sensitivity], depths: Sequence[DepthRow]
) -> tuple[str, ...]:
    """Return what the study says, in sentences."""
    right = sum(one.right for one in results)
    said = [f"{right} of {len(results)} conditions lie on the report's side of 5 N by the sensor."]
    doubtful = [
        f"{one.condition.name} ({one.probability:.2f})"
        for one in results
        if one.probability is not None and one.probability < 0.95
    ]
    if doubtful:
        said.append(f"The open inputs leave that side uncertain for: {'; '.join(doubtful)}.")
    treaded = [one for one in results if not one.condition.untreaded]
    most = max(treaded, key=lambda one: one.true_load.value)
    said.append(
        f"The sensor does not see the film under lugs: up to {most.true_load.value:.0f} N "
        f"({most.condition.name}), of which it reads {most.load.value:.1f} N. "
        "'Below 5 N' is a statement on the sensor."
    )
    for one in results:
        if one.condition.printed_load is None or one.condition.name not in varied:
            continue
        ranks = (
            (label, varied[one.condition.name].ranked(name)[0])
            for name, label in (
                ("fluid_load_sensor", "load"), ("peak_fluid_pressure_sensor", "peak"),
            )
        )  # fmt: skip
        said.append(
            f"{one.condition.name}: "
            + ", ".join(f"{label} hangs most on {effect.path}" for label, effect in ranks)
            + "."
        )
    found = threshold(depths)
    if found is not None:
        said.append(
            f"Tread of {1e3 * found[1]:g} mm is enough to bring the sensor below 5 N, "
            f"{1e3 * found[0]:g} mm is not (lugs of 5 mm, channels of 2.4 mm)."
        )
    return tuple(said)


def _notes(results: Sequence[Judged], lost: Sequence[str], quick: bool) -> tuple[str, ...]:
    spacing = results[0].condition.case.numerics
    grid = spacing.quick_grid_spacing if quick else spacing.grid_spacing
    notes = [
        f"grid of {1e3 * grid:g} mm; 500 N in all twelve, as the printed loads; 250 N beside it",
        "bands: each open input at one standard deviation to either side on the quick grid, taken "
        "as factors that multiply and drawn together (20 000 draws, normal, held at the computed "
        "ends, loads below 500 N, peaks below the highest film pressure computed); grid and place "
        "of the tracks drawn with them",
        "treaded shoes: facet angle, roughness, starting film and lug width are varied"
        if not quick
        else "quick: no bands under treaded shoes, no grid error in the others",
        "places: 10 mm between tracks; the assumed heel is the same on both sides",
    ]
    notes += [f"not computed, not in a band: {each}" for each in lost]
    for one in results:
        if not one.reading.outcome.usable:
            notes.append(f"{one.condition.name}: {one.reading.outcome.status}")
    return tuple(notes)
