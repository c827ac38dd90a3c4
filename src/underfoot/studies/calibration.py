"""Which parameters the report's data can fix, on which part of them, checked on the rest."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from underfoot.case.friction import measured_fluids
from underfoot.compute.slips import slips
from underfoot.core import Progress, silent
from underfoot.core.catalogue import Catalogue
from underfoot.friction import viscous_decay
from underfoot.questions.outcomes import outcomes
from underfoot.questions.sensitivity import OPEN_INPUTS
from underfoot.questions.slips import BANDS
from underfoot.slip.dynamics import ReducedSole, SlipStudy, judge_slip

from . import identifiability
from .figure import OURS, PRINTED, Figure, Layer, Panel, level, line
from .g4 import LOAD, PEAK, ShoeInFluid, printed_value
from .g5 import slip_case
from .g6 import precision_of_published
from .identifiability import Fixed, MisfitProfile, chi_square, model_error, profile
from .runner import Computed, Options, StudyTable, part
from .verdict import ComputedQuantity

STATEMENTS = Path(__file__).with_name("calibration.toml")

Array = NDArray[np.float64]
FACETS = (8.0, 9.0, 10.0, 11.0, 12.0)
ROUGHNESS = (1.0, 1.5, 2.0, 3.0, 4.0)
MASSES = (0.04, 0.06, 0.08, 0.114, 0.17, 0.25, 0.4, 0.7)
CONTACTS = (0.08, 0.11, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.5)
Z95 = 1.96
READING = 0.15
"""Relative standard deviation of a reading of the slip tester, assumed: none is printed."""
KINDS = ("work", "athletic")
NOT_IDENTIFIABLE = (
    (
        "heel's facet length, radius, width; outsole thickness",
        "G.4",
        "few readings for them all, and each moves load and peak as the facet's angle does",
    ),
    (
        "adhesion and hysteresis apart",
        "G.2",
        "only their sum is printed; Fig. 22 and 23 hold the readings as pictures",
    ),
    (
        "shear strength with speed",
        "G.2",
        "moves COF as the fine roughness of films at asperities does",
    ),
    (
        "hardness of the outsoles",
        "G.6",
        "friction of three outsoles, three unknown hardnesses and no law that is known to carry "
        "from pin to outsole",
    ),
    (
        "rubber's relaxation under sliding",
        "G.1",
        "the printed beta (0.013 and 0.025 1/s) is of seconds; sliding asks for milliseconds",
    ),
    (
        "reaction of a person to a slip",
        "G.5",
        "no time histories are printed; it moves peak speed as the moving mass does",
    ),
)


@dataclass(frozen=True, slots=True)
class Calibrated:
    """A parameter's profile beside what the program uses by default, and from where to where."""

    profile: MisfitProfile
    data: str
    default: float
    low: float
    high: float

    @property
    def holds_default(self) -> str:
        """Whether the default, or at least a part of its 95 % range, lies in the 95 % interval."""
        if self.profile.fixed in (Fixed.NOT_IDENTIFIABLE, Fixed.REFUTED):
            return "-"
        low = -math.inf if self.profile.low is None else self.profile.low
        high = math.inf if self.profile.high is None else self.profile.high
        if low <= self.default <= high:
            return "inside"
        return "its range is" if self.low <= high and low <= self.high else "OUTSIDE"


def compute(options: Options) -> Computed:
    """Return profiles of the parameters that the report's data touch, and the errors on the rest.

    ``quick``: three by three values of facet and roughness instead of five by five; quick slips.
    """
    quick, progress = options.quick, options.progress
    facets = FACETS[1:4] if quick else FACETS
    roughness = ROUGHNESS[::2] if quick else ROUGHNESS
    loads, peaks = slip_tester_grid(
        facets, roughness, processes=options.processes, progress=part(progress, 0.0, 0.5)
    )
    bare = slips(slip_case("untreaded", quick=quick), progress=part(progress, 0.5, 0.75))
    tread = slips(slip_case("treaded", quick=quick), progress=part(progress, 0.75, 1.0))
    case = ShoeInFluid("work", "untreaded", "glycerol").case
    angle = math.degrees(float(case.value("shoe.heel.profile.angle")))
    rough = float(case.value("interface.roughness_beyond_cutoff"))
    assert tread.by_friction is not None  # the law of the pair has a spread
    at_contact = np.quantile(tread.by_friction.cof, [0.5, 0.025, 0.975]).tolist()
    # N and Pa of both untreaded shoes in glycerol
    data = np.array(
        [
            [printed_value("fluid_load", k, "N"), printed_value("peak_pressure", k, "Pa")]
            for k in KINDS
        ]
    )
    misfit = chi_square(np.stack([loads[0], peaks[0]], axis=-1), data[0], READING * data[0])
    by_angle = profile("facet angle", "deg", facets, misfit, data=2)
    by_roughness = profile("roughness beyond the cut-off", "1", roughness, misfit.T, data=2)
    by_mass, by_contact = mass_profile(bare), contact_profile(tread)
    moving, (*_, shares) = bare.population.effective_mass, BANDS["effective_mass"]
    calibrated = (
        Calibrated(by_angle, "G.4.2, work shoe", angle, angle - Z95, angle + Z95),
        Calibrated(by_roughness, "G.4.2, work shoe", rough, *_range_of_roughness(rough)),
        Calibrated(by_mass, "G.5.2, over the sensors", moving, min(shares), max(shares)),
        Calibrated(by_contact, "G.5.2, treaded", *at_contact),
    )
    i, j = (int(k) for k in np.unravel_index(int(misfit.argmin()), misfit.shape))
    mass = by_mass.best
    reaches = {
        "OUTSIDE": "and so does the range that runs carry",
        "its range is": "the range that runs carry reaches into it",
    }
    _, error = model_error([loads[1, i, j], peaks[1, i, j]], data[1])
    return Computed(
        {
            "athletic.load": ComputedQuantity.of(loads[1, i, j], "N"),
            "athletic.peak": ComputedQuantity.of(peaks[1, i, j], "Pa"),
            "clean.speed": ComputedQuantity.none("the data fix no moving mass", "m/s")
            if mass is None
            else ComputedQuantity.of(bare.peak_speed_at(effective_mass=mass) or math.nan, "m/s"),
        },
        _tables(facets, roughness, loads, peaks, calibrated),
        {"profiles": profile_figure(calibrated)},
        (
            *(
                f"{one.profile.name}: fitted {one.profile.text()}; the default {one.default:.3g} "
                f"lies outside this 95 % interval, {reaches[one.holds_default]}; it is kept."
                for one in calibrated
                if one.holds_default in reaches
            ),
            f"Model error of film loads and peaks on untreaded heels: a factor of "
            f"{math.exp(error):.2f} either way, on the athletic shoe's readings at the work shoe's "
            f"values ({facets[i]:g} deg, roughness factor {roughness[j]:g}).",
            *_other_conclusions(),
        ),
    )


def _range_of_roughness(value: float) -> tuple[float, float]:
    """Return the 95 % range of the roughness factor that intervals carry."""
    (input_,) = (each for each in OPEN_INPUTS if each.path == "interface.roughness_beyond_cutoff")
    spread = input_.deviation**Z95
    return max(value / spread, input_.low), value * spread


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
    cases = [
        ShoeInFluid(kind, "untreaded", "glycerol").case.replace(
            {"shoe.heel.facet_angle": f"{facet} deg", "interface.roughness_beyond_cutoff": rough}
        )
        for kind in KINDS
        for facet in facets
        for rough in roughness
    ]
    found = outcomes(
        cases, quick=True, processes=processes, progress=progress, stage="Heel and roughness"
    )
    shape = (2, len(facets), len(roughness))
    loads, peaks = (
        np.array([outcome.number(name) for outcome in found]).reshape(shape)
        for name in (LOAD, PEAK)
    )
    return loads, peaks


def mass_profile(study: SlipStudy) -> MisfitProfile:
    """Return the profile of the share of the body that moves with the heel, from G.5's mean."""
    mean = _published_value("peak_slipping_speed_over_sensors_untreaded")
    speeds = np.array([study.peak_speed_at(effective_mass=share) or math.nan for share in MASSES])
    misfit = chi_square(speeds[:, None], [mean[0]], [mean[1] / math.sqrt(11)])
    return profile("share of the body moving with the heel", "1", MASSES, misfit, data=1)


def contact_profile(study: SlipStudy) -> MisfitProfile:
    """Return the profile of the contact's COF under lugs in 90 % glycerol, from the treaded slips.

    The film is that of the case; the contact has one COF at every speed.
    """
    assert study.sole is not None
    mean = _published_value("peak_slipping_speed_over_sensors_treaded")
    speeds = np.array([treaded_speed(study, study.sole, cof) for cof in CONTACTS])
    # 0.06 m/s is what a marker moves at without any slip (required_friction)
    error = math.hypot(mean[1] / math.sqrt(6), 0.06)
    misfit = chi_square(speeds[:, None], [mean[0]], [error])
    return profile("contact COF under lugs, 90 % glycerol", "1", CONTACTS, misfit, data=1)


def _published_value(name: str) -> tuple[float, float]:
    value = Catalogue.load().entry("published", "human_slips_g5").sourced_value(name, "m/s")
    return float(value), value.uncertainty or 0.0


def treaded_speed(study: SlipStudy, sole: ReducedSole, cof: float) -> float:
    """Return the mean peak slipping speed (m/s) if the contact had one COF."""
    changed = replace(sole, cofs=np.full(sole.cofs.size, cof))
    peaks = [
        judge_slip(changed.motion(subject.walker)).peak_speed.value for subject in study.subjects
    ]
    return float(np.mean([0.0 if v is None else v for v in peaks]))


def _other_conclusions() -> tuple[str, ...]:
    fitted = [fluid for fluid in measured_fluids(Catalogue.load()) if fluid.tau_hydro is not None]
    decay = viscous_decay(fitted)
    value, spread = 1e3 * float(decay), 1.96e3 * (decay.uncertainty or 0.0)
    slopes, halves = precision_of_published()
    a, b = np.percentile(slopes, [2.5, 97.5]), np.percentile(halves, [2.5, 97.5])
    return (
        f"Viscosity x tau of Eq. 17: {value:.2f} ({value - spread:.2f} to {value + spread:.2f}) "
        "mPa m, fixed by four fluids; each predicted from the other three in study g2.",
        f"52 trials leave slope and 50 % point of the slip logistic at {a[0]:.0f} to {a[1]:.0f} "
        f"and {b[0]:.3f} to {b[1]:.3f}; the trials themselves are not printed.",
    )


def _tables(
    facets: Sequence[float],
    roughness: Sequence[float],
    loads: Array,
    peaks: Array,
    calibrated: Sequence[Calibrated],
) -> tuple[StudyTable, ...]:
    why = "{0.fixed}; least chi-square {0.misfit:.2g} of {0.data} data; grid {1:g} to {2:g}"
    parameters = [
        {
            "parameter": one.profile.name,
            "data": one.data,
            "fitted (95 %)": one.profile.text(),
            "default (95 %)": f"{one.default:.3g} ({one.low:.2g} to {one.high:.2g})",
            "inside fitted 95 %": one.holds_default,
            "why": why.format(one.profile, one.profile.grid[0], one.profile.grid[-1]),
        }
        for one in calibrated
    ]
    columns = tuple(parameters[0])
    none = [
        (what, where, "not identifiable", "-", "-", why) for what, where, why in NOT_IDENTIFIABLE
    ]
    return (
        StudyTable(
            "parameters",
            "Parameters fitted to the report's data, beside the program's defaults",
            columns,
            [*(tuple(row.values()) for row in parameters), *none],
        ),
        StudyTable.of(
            "heel_and_roughness",
            "Sensor readings by facet angle and roughness (printed: work 201 N, 234 kPa; athletic "
            "83 N, 214 kPa), coarse grid",
            [
                {
                    "facet deg": facet,
                    "roughness": rough,
                    "work N": loads[0, i, j],
                    "work kPa": peaks[0, i, j] / 1e3,
                    "athletic N": loads[1, i, j],
                    "athletic kPa": peaks[1, i, j] / 1e3,
                }
                for i, facet in enumerate(facets)
                for j, rough in enumerate(roughness)
            ],
        ),
        StudyTable(
            "profiles",
            "Least chi-square against each parameter",
            ("parameter", "value", "chi-square"),
            [
                (one.profile.name, x, y)
                for one in calibrated
                for x, y in zip(one.profile.grid, one.profile.profile, strict=True)
            ],
        ),
    )


def profile_figure(calibrated: Sequence[Calibrated]) -> Figure:
    """Return chi-square over its least against each parameter; below the line lies 95 %."""
    panels = []
    for parameter in calibrated:
        p = parameter.profile
        layers = [
            line(p.grid, np.minimum(p.profile, 1e3), marker="o"),
            level(p.misfit + identifiability.RISE, "95 %", colour="0.5", style="--"),
        ]
        for k, end in enumerate(v for v in (p.low, p.high) if v is not None):
            label = "" if k else "end of 95 %"
            layers.append(Layer("limit", end, colour=PRINTED, label=label))
        layers.append(Layer("limit", parameter.default, colour=OURS, style=":", label="default"))
        unit = "" if p.unit == "1" else f" ({p.unit})"
        title = f"{p.fixed}: {p.text()}"
        scale: dict[str, Any] = {"y_scale": "symlog", "y_limits": (0.0, None)}
        panels.append(Panel(layers, p.name + unit, "least chi-square", title, **scale))
    title = "What the report's data fix, beside the program's defaults"
    return Figure(panels, title, columns=2, size=(4.8, 3.2))
