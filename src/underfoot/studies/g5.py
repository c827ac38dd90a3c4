"""Grant report G.5: pressure and speed in unexpected slips, untreaded against treaded."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from underfoot.core import Progress, silent
from underfoot.core.catalogue import Catalogue

from .g5_lines import g5_conclusions, g5_lines, g5_tables
from .study_result import StudyResult
from .verdict import Erratum

if TYPE_CHECKING:
    from underfoot.case import Case
    from underfoot.slip.dynamics import SlipStudy

Array = NDArray[np.float64]
SHOES = {
    "untreaded": "slip_resistant_shoe_untreaded",
    "treaded": "slip_resistant_shoe_treaded",
}
COUNTS = {"untreaded": 11, "treaded": 6}
"""Persons whose heel crossed the sensors (G.5.2)."""
SAMPLES = 2000
ERRATA = (
    Erratum(
        "G.5.3", "2.5 mm of tread was sufficient", "2.4 mm",
        "the shoes of G.5.1 have a tread of 2.4 mm",
    ),
)  # fmt: skip
NOTES = (
    "one parameter set, that of the slip tester (G.4): heel, interface, friction law, floor, "
    "fluid; nothing was fitted to G.5",
    "bands: 95 % of the means that studies with as many persons as the report's would find "
    "(drawn from the simulated population)",
    "heel marker and sensors are simulated and judged by the same functions as recordings",
)


def slip_case(name: str, *, quick: bool = False) -> Case:
    """Return the case of a shoe of G.5, "untreaded" or "treaded"; that of the examples.

    ``quick`` takes 24 persons, fewer full slips behind the reduced model and untreaded a grid of
    2 mm.
    """
    from underfoot.case import Case

    mapping: dict[str, Any] = {
        "file_version": 1,
        "name": f"Human slips, {name}, 90 % glycerol",
        "shoe": {"from": SHOES[name]},
        "floor": {"from": "vinyl_g4"},
        "contaminant": {"from": "glycerol_90pct"},
        "motion": {"from": "slip_tester_g4"},
        "sensor": {"from": "human_slip_g5"},
        "slip": {"subjects": 40},
    }
    if quick:
        mapping["slip"] = {"subjects": 24, "fit_runs": 8, "test_runs": 2}
        if name == "untreaded":
            mapping["numerics"] = {"quick_grid_spacing": "2 mm"}
    return Case.from_mapping(mapping)


def run(
    *,
    quick: bool = False,
    processes: int | None = 1,
    seed: int = 0,
    progress: Progress = silent,
) -> StudyResult:
    """Return the slips on both shoes beside the printed ones.

    Parameters
    ----------
    quick
        See ``slip_case``.
    processes
        2 or None: both shoes at the same time.
    seed
        Of the draws behind the bands.
    """
    started, used = time.perf_counter(), time.process_time()
    if processes != 1:
        _kept(quick, progress)
    found = {}
    for number, name in enumerate(SHOES):

        def told(
            stage: str, fraction: float, residual: float | None = None, n: int = number, s=name
        ) -> None:
            progress(f"{s}: {stage}", (n + fraction) / len(SHOES), residual)

        found[name] = _slips(slip_case(name, quick=quick), told)
    published = Catalogue.load().entry("published", "human_slips_g5")
    bands = {name: study_bands(found[name], COUNTS[name], seed=seed) for name in SHOES}
    passages = found["untreaded"].sensor_passages()
    lines = g5_lines(found, bands, published, passages)
    progress("done", 1.0, None)
    return StudyResult(
        "g5", lines, g5_tables(found, bands, passages, published),
        g5_conclusions(found, passages), ERRATA, NOTES, _assumptions(found),
        time.perf_counter() - started, time.process_time() - used,
        {"slips": found, "passages": passages, "bands": bands},
    )  # fmt: skip


def study_bands(
    study: SlipStudy, count: int, *, samples: int = SAMPLES, seed: int = 0
) -> dict[str, tuple[float, float]]:
    """Return 2.5 and 97.5 % points of what studies of ``count`` crossing persons would find.

    Means of peak speed (m/s), peak pressure (Pa) and duration (s), the correlation of the first
    two, and the last row over the first.
    """
    crossed = np.array([one.seen.crossed for one in study.subjects])
    columns = {
        name: study.of(name)[crossed] for name in ("peak_speed", "peak_pressure", "duration")
    }
    rows = np.array([one.seen.row_peaks for one in study.subjects if one.seen.crossed])
    nothing = (float("nan"), float("nan"))
    if crossed.sum() < 2:
        return dict.fromkeys((*columns, "correlation", "last_over_first"), nothing)
    generator = np.random.default_rng(seed)
    drawn = generator.integers(int(crossed.sum()), size=(samples, count))
    found = {name: _points(_row_means(values[drawn])) for name, values in columns.items()}
    speed, pressure = columns["peak_speed"][drawn], columns["peak_pressure"][drawn]
    found["correlation"] = _points(correlations(speed, pressure))
    if rows.size:
        means = rows[drawn].mean(axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            found["last_over_first"] = _points(means[:, -1] / means[:, 0])
    else:
        found["last_over_first"] = nothing
    return found


def correlations(x: Array, y: Array) -> Array:
    """Return Pearson's r of every row of two arrays (m, n); nan where one does not vary."""
    a = x - x.mean(axis=1, keepdims=True)
    b = y - y.mean(axis=1, keepdims=True)
    with np.errstate(divide="ignore", invalid="ignore"):
        return (a * b).sum(axis=1) / np.sqrt((a * a).sum(axis=1) * (b * b).sum(axis=1))


def _row_means(values: Array) -> Array:
    known = np.isfinite(values)
    with np.errstate(invalid="ignore"):
        return np.where(known, values, 0.0).sum(axis=1) / known.sum(axis=1)


def _points(values: Array) -> tuple[float, float]:
    values = values[np.isfinite(values)]
    if not values.size:
        return float("nan"), float("nan")
    low, high = np.percentile(values, [2.5, 97.5])
    return float(low), float(high)


def _slips(case: Case, progress: Progress) -> SlipStudy:
    from underfoot.case.build_slip import slips

    return slips(case, progress=progress)


def _kept(quick: bool, progress: Progress) -> None:
    """Let both shoes run at the same time; their full slips are found in the cache afterwards."""
    from concurrent.futures import ProcessPoolExecutor, as_completed
    from multiprocessing import get_context

    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        jobs = [pool.submit(_fill, name, quick) for name in SHOES]
        try:
            for number, job in enumerate(as_completed(jobs)):
                progress("Slips on both shoes", 0.45 * (number + 1), None)
                job.exception()  # what failed is met again, and said, by the run itself
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def _fill(name: str, quick: bool) -> None:
    _slips(slip_case(name, quick=quick), silent)


def _assumptions(found: dict[str, SlipStudy]) -> tuple[str, ...]:
    study = found["untreaded"]
    people = study.population
    return (
        f"{people.effective_mass:.3g} of the body moves with the heel (not printed, not measured).",
        "Heel shape, and everything else of the interface, as in G.4 (assumed there).",
        f"RCOF {people.rcof.mean:.2f} ± {people.rcof.sd:.2f}, heel speed at contact "
        f"{people.heel_speed.mean:.2f} ± {people.heel_speed.sd:.2f} m/s: not printed.",
        "Load and drive are those of recorded dry walking: nobody reacts to the slip.",
        "The shoe angle at landing is held through the slip.",
        *study.setting.friction.assumptions,
    )
