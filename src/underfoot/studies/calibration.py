"""Which parameters the report's data can fix, on which part of them, checked on the rest."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from underfoot.calibrate.identifiability import Fixed, Profile, chi_square, model_error, profile
from underfoot.core import Progress, silent
from underfoot.core.catalogue import Catalogue

from .g5 import slip_case
from .g6_people import precision_of_published
from .pin_study import PinLine, PinTable
from .study_result import StudyResult
from .verdict import Verdict

if TYPE_CHECKING:
    from underfoot.slip.dynamics import ReducedSole, SlipStudy

Array = NDArray[np.float64]
FACETS = (8.0, 9.0, 10.0, 11.0, 12.0)
ROUGHNESS = (1.0, 1.5, 2.0, 3.0, 4.0)
MASSES = (0.04, 0.06, 0.08, 0.114, 0.17, 0.25, 0.4, 0.7)
CONTACTS = (0.08, 0.11, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.5)
READING = 0.15
"""Relative standard deviation of a reading of the slip tester, assumed: none is printed."""
OPEN = (
    ("heel's facet length, radius, width; outsole thickness", "G.4", "few readings stand against "
     "them all, and each moves load and peak as the facet's angle does"),
    ("adhesion and hysteresis apart", "G.2", "only their sum is printed; Fig. 22 and 23 hold the "
     "readings as pictures"),
    ("shear strength with speed", "G.2", "moves COF as the fine roughness of films at asperities "
     "does"),
    ("hardness of the outsoles", "G.6", "friction of three outsoles, three unknown hardnesses and "
     "no law that is known to carry from pin to outsole"),
    ("rubber's relaxation under sliding", "G.1", "the printed beta (0.013 and 0.025 1/s) is of "
     "seconds; sliding asks for milliseconds"),
    ("reaction of a person to a slip", "G.5", "no time histories are printed; it moves peak speed "
     "as the moving mass does"),
)  # fmt: skip
NOTES = (
    "95 % interval: where chi-square, least over the other parameters, has risen by 3.84",
    f"readings of the slip tester: ± {100 * READING:.0f} % (assumed, none is printed)",
    "where even the least chi-square is beyond its 95 % point no value is given",
    "the defaults of the program are not changed by this study",
)


def run(
    *, quick: bool = False, processes: int | None = 1, progress: Progress = silent
) -> StudyResult:
    """Return profiles of the parameters that the report's data touch, and the errors on the rest.

    Parameters
    ----------
    quick
        Three by three values of facet and roughness instead of five by five; quick slips.
    processes
        Cases computed at the same time.
    """
    started, used = time.perf_counter(), time.process_time()

    def part(low: float, high: float) -> Progress:
        def told(stage: str, fraction: float, residual: float | None = None) -> None:
            progress(stage, low + (high - low) * fraction, residual)

        return told

    facets = FACETS[1:4] if quick else FACETS
    roughness = ROUGHNESS[::2] if quick else ROUGHNESS
    loads, peaks = slip_tester_grid(facets, roughness, processes=processes, progress=part(0.0, 0.5))
    heel = heel_profiles(facets, roughness, loads, peaks)
    bare = _slips("untreaded", quick, part(0.5, 0.75))
    tread = _slips("treaded", quick, part(0.75, 1.0))
    mass, cof = mass_profile(bare), contact_profile(tread)
    lines = (
        *_heel_lines(facets, roughness, loads, peaks, heel),
        *_decay_lines(),
        *_slip_lines(mass, cof, bare),
        _logistic_line(),
        *(
            PinLine(what, where, "-", "not identifiable", Verdict.NOT_AVAILABLE, why)
            for what, where, why in OPEN
        ),
    )
    progress("done", 1.0, None)
    return StudyResult(
        "calibration", lines, _tables(facets, roughness, loads, peaks, (*heel, mass, cof)),
        _conclusions(heel, mass, cof), (), NOTES,
        (f"Readings of the slip tester spread by {100 * READING:.0f} %.",),
        time.perf_counter() - started, time.process_time() - used,
        {"profiles": (*heel, mass, cof)},
    )  # fmt: skip


def slip_tester_grid(
    facets: Sequence[float],
    roughness: Sequence[float],
    *,
    processes: int | None = 1,
    progress: Progress = silent,
) -> tuple[Array, Array]:
    """Return fluid load (N) and peak (Pa) as the sensors read them, (2 shoes, facets, roughness).

    Untreaded work and athletic shoe in 90 % glycerol, coarse grid.
    """
    from underfoot.assess.outcomes import outcomes
    from underfoot.case import Case

    cases = []
    for shoe in ("work_shoe_untreaded", "athletic_shoe_untreaded"):
        base = Case.from_mapping(
            {
                "file_version": 1,
                "name": shoe,
                "shoe": {"from": shoe},
                "floor": {"from": "vinyl_g4"},
                "contaminant": {"from": "glycerol_90pct"},
                "motion": {"from": "slip_tester_g4"},
                "sensor": {"from": "slip_tester_g4"},
            }
        )
        for facet in facets:
            for rough in roughness:
                cases.append(
                    base.replace(
                        {
                            "shoe.heel.facet_angle": f"{facet} deg",
                            "interface.roughness_beyond_cutoff": rough,
                        }
                    )
                )
    found = outcomes(
        cases, quick=True, processes=processes, progress=progress, stage="Heel and roughness"
    )
    shape = (2, len(facets), len(roughness))
    return tuple(  # type: ignore[return-value]
        np.array([one.number(name) for one in found]).reshape(shape)
        for name in ("fluid_load_sensor", "peak_fluid_pressure_sensor")
    )


def readings() -> Array:
    """Return load (N) and peak (Pa) of both untreaded shoes in glycerol, (2 shoes, 2)."""
    entry = Catalogue.load().entry("published", "slip_tester_g4")
    return np.array(
        [
            [
                entry.sourced(f"{name}_{shoe}_untreaded_glycerol", unit).value or 0.0
                for name, unit in (("fluid_load", "N"), ("peak_pressure", "Pa"))
            ]
            for shoe in ("work_shoe", "athletic_shoe")
        ]
    )


def heel_profiles(
    facets: Sequence[float], roughness: Sequence[float], loads: Array, peaks: Array
) -> tuple[Profile, Profile]:
    """Return profiles of facet angle (deg) and roughness factor from the work shoe's readings."""
    data = readings()[0]
    misfit = chi_square(np.stack([loads[0], peaks[0]], axis=-1), data, READING * data)
    return (
        profile("facet angle", "deg", facets, misfit, data=2),
        profile("roughness beyond the cut-off", "1", roughness, misfit.T, data=2),
    )


def mass_profile(study: SlipStudy, masses: Sequence[float] = MASSES) -> Profile:
    """Return the profile of the share of the body that moves with the heel, from G.5's mean."""
    given = Catalogue.load().entry("published", "human_slips_g5")
    mean = given.sourced("peak_slipping_speed_over_sensors_untreaded", "m/s")
    assert study.sole is not None
    speeds = np.array([study.peak_speed_at(share) or math.nan for share in masses])
    error = (mean.uncertainty or 1.0) / math.sqrt(11)
    misfit = chi_square(speeds[:, None], [mean.value or 0.0], [error])
    return profile("share of the body moving with the heel", "1", masses, misfit, data=1)


def contact_profile(study: SlipStudy, contacts: Sequence[float] = CONTACTS) -> Profile:
    """Return the profile of the contact's COF under lugs in 90 % glycerol, from the treaded slips.

    The film is that of the case; the contact has one COF at every speed.
    """
    given = Catalogue.load().entry("published", "human_slips_g5")
    mean = given.sourced("peak_slipping_speed_over_sensors_treaded", "m/s")
    assert study.sole is not None
    speeds = np.array([treaded_speed(study, study.sole, cof) for cof in contacts])
    error = (mean.uncertainty or 1.0) / math.sqrt(6)
    error = math.hypot(error, 0.06)  # what a marker moves at without any slip (required_friction)
    misfit = chi_square(speeds[:, None], [mean.value or 0.0], [error])
    return profile("contact COF under lugs, 90 % glycerol", "1", contacts, misfit, data=1)


def treaded_speed(study: SlipStudy, sole: ReducedSole, cof: float) -> float:
    """Return the mean peak slipping speed (m/s) if the contact had one COF."""
    from underfoot.slip.dynamics import judged

    changed = replace(sole, cofs=np.full(sole.cofs.size, cof))
    peaks = [judged(changed.motion(one.walker)).peak_speed.value for one in study.subjects]
    return float(np.mean([0.0 if v is None else v for v in peaks]))


def _slips(name: str, quick: bool, progress: Progress) -> SlipStudy:
    from underfoot.case.build_slip import slips

    return slips(slip_case(name, quick=quick), progress=progress)


def _heel_lines(
    facets: Sequence[float],
    roughness: Sequence[float],
    loads: Array,
    peaks: Array,
    heel: tuple[Profile, Profile],
) -> list[PinLine]:
    data = readings()
    misfit = chi_square(np.stack([loads[0], peaks[0]], axis=-1), data[0], READING * data[0])
    at = np.unravel_index(int(misfit.argmin()), misfit.shape)
    i, j = int(at[0]), int(at[1])
    best = f"{facets[i]:g} deg, {roughness[j]:g}"
    checked = np.array([loads[1, i, j], peaks[1, i, j]])
    _, error = model_error(checked, data[1])
    lines = [_profile_line(one, "G.4.2, work shoe") for one in heel]
    for k, (what, unit, scale) in enumerate(
        (("fluid load", "N", 1.0), ("peak pressure", "kPa", 1e3))
    ):
        off = math.log(checked[k] / data[1, k])
        lines.append(
            PinLine(
                f"checked on the athletic shoe, not fitted: {what}", "G.4.2",
                f"{data[1, k] / scale:.0f} {unit}", f"{checked[k] / scale:.0f} {unit}",
                Verdict.REPRODUCED if abs(off) < READING
                else Verdict.WITHIN_SCATTER if abs(off) < 2 * READING
                else Verdict.TREND_ONLY if 0.2 < checked[k] / data[1, k] < 5
                else Verdict.DISAGREES,
                f"at the work shoe's best values ({best}); its arc channel's size is assumed",
                f"{(checked[k] - data[1, k]) / scale:+.0f} {unit}",
            )
        )  # fmt: skip
    lines.append(
        PinLine(
            "model error of film loads and peaks on untreaded heels", "G.4.2", "-",
            f"factor {math.exp(error):.2f} either way", Verdict.NOT_AVAILABLE,
            "rms of ln(ours / printed) on the two readings that were not fitted: what a prediction "
            "of this kind carries beside the spread of its inputs",
        )
    )  # fmt: skip
    return lines


def _profile_line(one: Profile, source: str, reason: str = "") -> PinLine:
    words = {
        Fixed.FIXED: "fixed",
        Fixed.LOWER_BOUND: "one side open within the grid",
        Fixed.UPPER_BOUND: "one side open within the grid",
        Fixed.NOT_IDENTIFIABLE: "both sides open within the grid: the other parameters make up "
        "for it",
        Fixed.REFUTED: "even the least misfit is beyond its 95 % point: the model lacks something",
    }[one.fixed]
    return PinLine(
        one.name, source, "-", one.text(), Verdict.NOT_AVAILABLE,
        f"{words} (least chi-square {one.misfit:.2g} of {one.data} data; grid {one.grid[0]:g} to "
        f"{one.grid[-1]:g}){'; ' + reason if reason else ''}",
    )  # fmt: skip


def _decay_lines() -> list[PinLine]:
    """Viscosity x tau from three fluids, the fourth predicted, four times."""
    from underfoot.case.build import measured_fluids
    from underfoot.friction import viscous_decay

    fitted = [one for one in measured_fluids(Catalogue.load()) if one.tau_hydro is not None]
    whole = viscous_decay(fitted)
    ours, theirs, inside = [], [], 0
    for one in fitted:
        rest = viscous_decay([other for other in fitted if other is not one])
        tau = one.tau_hydro
        assert tau is not None
        ours.append((rest.value or 0.0) / one.viscosity)
        theirs.append(tau.value or 0.0)
        spread = math.hypot(tau.uncertainty or 0.0, (rest.uncertainty or 0.0) / one.viscosity)
        inside += abs(ours[-1] - theirs[-1]) <= 1.96 * spread
    _, error = model_error(ours, theirs)
    value, spread = 1e3 * (whole.value or 0.0), 1e3 * (whole.uncertainty or 0.0)
    return [
        PinLine(
            "viscosity x tau of Eq. 17", "G.2.2", "-",
            f"{value:.2f} ({value - 1.96 * spread:.2f} to {value + 1.96 * spread:.2f}) mPa m",
            Verdict.NOT_AVAILABLE, "fixed by four fluids",
        ),
        PinLine(
            "checked: tau of each fluid from the other three", "G.2.2",
            ", ".join(f"{v:.2f}" for v in theirs) + " m/s",
            ", ".join(f"{v:.2f}" for v in ours) + " m/s",
            Verdict.REPRODUCED if inside == len(fitted) else Verdict.WITHIN_SCATTER,
            f"{inside} of {len(fitted)} within 95 %; rms of the logarithm {error:.2f}, which "
            "predictions for fluids that were not measured carry",
        ),
    ]  # fmt: skip


def _slip_lines(mass: Profile, cof: Profile, study: SlipStudy) -> list[PinLine]:
    lines = [
        _profile_line(
            mass, "G.5.2, over the sensors",
            "in this model alone: a person who unloads the foot looks like a heavier heel",
        ),
        _profile_line(
            cof, "G.5.2, treaded", "the law in use has 0.11; above its bound nobody slips and all "
            "values are alike",
        ),
    ]  # fmt: skip
    clean = Catalogue.load().entry("published", "human_slips_g5")
    other = clean.sourced("peak_slipping_speed_clean_untreaded", "m/s")
    if mass.best is not None:
        speed = study.peak_speed_at(mass.best) or math.nan
        off = speed - (other.value or 0.0)
        lines.append(
            PinLine(
                "checked: peak speed of clean steps at that share", "G.5.2",
                f"{other.value:g} ± {other.uncertainty:g} m/s", f"{speed:.2f} m/s",
                Verdict.WITHIN_SCATTER if abs(off) <= (other.uncertainty or 0.0)
                else Verdict.DISAGREES,
                "a weak check: partly the same persons", f"{off:+.2f} m/s",
            )
        )  # fmt: skip
    return lines


def _logistic_line() -> PinLine:
    slopes, halves = precision_of_published()
    a, b = np.percentile(slopes, [2.5, 97.5]), np.percentile(halves, [2.5, 97.5])
    return PinLine(
        "slope and 50 % point of the slip logistic", "G.6.3", "-49.2 and -0.06",
        f"{a[0]:.0f} to {a[1]:.0f} and {b[0]:.3f} to {b[1]:.3f}", Verdict.NOT_AVAILABLE,
        "what 52 trials leave open; the trials themselves are not printed, so nothing is held out",
    )  # fmt: skip


def _tables(
    facets: Sequence[float],
    roughness: Sequence[float],
    loads: Array,
    peaks: Array,
    profiles: Sequence[Profile],
) -> tuple[PinTable, ...]:
    rows = [
        (float(facet), float(rough), *(float(v) for s in (0, 1) for v in
         (loads[s, i, j], peaks[s, i, j] / 1e3)))
        for i, facet in enumerate(facets)
        for j, rough in enumerate(roughness)
    ]  # fmt: skip
    return (
        PinTable(
            "heel_and_roughness",
            "Sensor readings by facet angle and roughness (printed: work 201 N, 234 kPa; athletic "
            "83 N, 214 kPa), coarse grid",
            ("facet deg", "roughness", "work N", "work kPa", "athletic N", "athletic kPa"),
            tuple(rows),
        ),
        PinTable(
            "profiles",
            "Least chi-square against each parameter",
            ("parameter", "value", "chi-square"),
            tuple(
                (one.name, float(x), float(y))
                for one in profiles
                for x, y in zip(one.grid, one.profile, strict=True)
            ),
        ),
    )


def _conclusions(heel: tuple[Profile, Profile], mass: Profile, cof: Profile) -> tuple[str, ...]:
    return (
        "From two readings of the work shoe: "
        + "; ".join(f"{one.name} {one.text()}" for one in heel)
        + ". Both together cannot be told apart from other shapes of the heel.",
        f"Share of the body that moves with the heel: {mass.text()} (default 0.114, not changed).",
        f"Contact friction under lugs in 90 % glycerol: {cof.text()}.",
    )
