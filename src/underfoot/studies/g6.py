"""Report G.6: friction of three outsoles in 50 % glycerol, and who slips on them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from underfoot.calibrate import pin_on_disk
from underfoot.case import Case
from underfoot.case.friction import measured_fluids
from underfoot.compute.run import run
from underfoot.compute.slips import slip_population, slip_sensors, slip_setting
from underfoot.core import DataError, Progress, silent
from underfoot.core.catalogue import Catalogue
from underfoot.friction import SpeedTableLaw, self_affine_scale, stribeck_cof
from underfoot.friction import shear_strength_from_cof as strength_from_cof
from underfoot.friction.asperity_ehl import STYLUS_RESOLUTION
from underfoot.friction.propagation import normal_draws
from underfoot.questions.outcomes import CaseOutcome, outcomes
from underfoot.slip import ADULTS_LEVEL_WALKING as ADULTS
from underfoot.slip import MODELS, ReportG6, slip_model
from underfoot.slip.dynamics import cof_table, slip_study
from underfoot.trials.statistics.logistic import logistic_regression, risk_curve

from .default_law import chance_of_order, file_without_report
from .figure import PRINTED, Figure, Layer, Panel, grouped_bars, line, points
from .runner import Computed, Options, StudyTable, part
from .verdict import ComputedQuantity

STATEMENTS = Path(__file__).with_name("g6.toml")

Array = NDArray[np.float64]
SOLES: dict[str, float] = {"hard": 70.0, "medium": 60.0, "soft": 50.0}
"""Shore A, assumed: the report prints no hardness."""
HARDNESS_BAND = 5.0
"""Shore A to either side of each, assumed."""
JUDGED = "pair_without_report"
"""The default law of a case, fitted to everybody's readings but the report's."""
LAWS: dict[str, str] = {
    JUDGED: "default law, without the report's readings",
    "stribeck": "Eq. 17 of the pin as it is",
    "asperity_ehl": "films at asperities",
    "bowden_tabor": "real contact area",
    "pair": "default law as shipped (knows these readings)",
}
SETUP, FLUID = "whole_shoe_g6", "glycerol_50pct"
WINDOW = (0.2, 0.3, 0.4)
"""Beginning, middle and end of the averaging window after first contact, s (G.6.1)."""
PRINTED_ACOF = {"hard": 0.159, "medium": 0.159, "soft": 0.182}
"""G.6.3; that of the medium outsole is not printed, but "indistinguishable" from the hard one."""
PRINTED_RISK = {"hard": 0.54, "medium": 0.42, "soft": 0.077}
PRINTED_SLOPE, PRINTED_HALF = -49.2, -0.06
TIE = 0.008
"""COF: what one reading of the tester scatters by (the corpus' standard deviation of these)."""
TRIALS = 52
"""29 persons, two slips each, less 6 that did not hit the plate cleanly (G.6.1)."""
SUBJECTS, QUICK_SUBJECTS = 200, 60
SPEEDS = {"constant": "at every speed", "falling": "falling with speed"}
STEPS = {name: f"ACOF as printed, {speeds}" for name, speeds in SPEEDS.items()}
SOLE_COLOURS = ("#e08a2e", "#e8c93c", "#c9c3b0")
"""Nearly those of the report's Fig. 36."""


@dataclass(frozen=True, slots=True)
class SoleFriction:
    """One sole under the tester of G.6 by one law; ``cof`` is the window's mean.

    ``deviation`` is the law's own standard deviation (nan: none known); ``low`` and ``high`` are
    the COF at the hardness band's ends, ``coarse`` is on the quick grid (nan: not run); ``draws``
    (n,) of the law and the hardness, joint over the soles, are those of the law of the pair.
    """

    sole: str
    law: str
    shore: float
    cof: float
    coarse: float
    deviation: float
    low: float
    high: float
    sensor_pressure: tuple[float, ...]
    film_share: float
    draws: Array | None = None

    @property
    def spread(self) -> float:
        """Standard deviation of the law and of the hardness (its band as one)."""
        own = 0.0 if math.isnan(self.deviation) else self.deviation
        return math.hypot(own, 0.5 * (self.high - self.low))


@dataclass(frozen=True, slots=True)
class Logistic:
    """A fitted logistic in ACOF - RCOF: slope and 50 % point with 95 % bounds (nan: none)."""

    slope: float
    slope_low: float
    slope_high: float
    half: float
    half_error: float


@dataclass(frozen=True, slots=True)
class OutsoleSlips:
    """Steps of one population on three outsoles.

    ``acof``, ``rcof``, ``slipped`` (n,) are of all steps; ``share`` of each outsole.
    """

    acof: Array
    rcof: Array
    slipped: Array
    share: dict[str, float]
    fit: Logistic


def compute(options: Options) -> Computed:
    """Return friction, pressures and slips of the three outsoles.

    ``quick``: coarse grid, the middle of the averaging window alone, fewer persons.
    """
    quick, progress = options.quick, options.progress
    frictions = sole_frictions(
        quick=quick, processes=options.processes, progress=part(progress, 0.0, 0.7)
    )
    steps = {
        name: slips(
            PRINTED_ACOF,
            own_speed=name == "falling",
            subjects=QUICK_SUBJECTS if quick else SUBJECTS,
            progress=part(progress, 0.7 + 0.1 * k, 0.8 + 0.1 * k),
        )
        for k, name in enumerate(STEPS)
    }
    progress("Precision of the printed logistic", 0.9)
    drawn = precision_of_published(draws=60 if quick else 200, seed=options.seed)
    return Computed(
        quantities(frictions, steps, quick=quick, seed=options.seed),
        (_friction_table(frictions), _risk_table(frictions), _step_table(steps)),
        {
            "fig36_outsoles": outsole_figure(frictions, steps),
            "fig37_logistic": logistic_figure(steps, drawn),
        },
        _conclusions(frictions, steps, drawn),
    )


def sole_case(shore: float, law: str) -> Case:
    """Return the case of one outsole (Shore A) under one friction law."""
    tread = {"depth": "3 mm", "lug_width": "3.6 mm", "channel_width": "2.4 mm"}
    mapping: dict[str, Any] = {
        "file_version": 1,
        "name": f"Outsole of {shore:g} Shore A, 50 % glycerol",
        "shoe": {
            "from": "slip_tester_heel",
            "material": {"shore_a": shore},
            "roughness": {"ra": "7.24 um", "cutoff": "0.8 mm"},
            "tread": {"pattern": "grid", **tread},
        },
        "floor": {"from": "vinyl_g4"},
        "contaminant": {"from": FLUID},
        "motion": {"from": SETUP},
        "sensor": {"from": "human_slip_g5"},
        "models": {"friction": "pair" if law == JUDGED else law},
    }
    if law == "bowden_tabor":
        strength, left = pin_strength()
        mapping["interface"] = {"shear_strength": f"{strength!r} Pa", "hysteresis_cof": left}
    case = Case.from_mapping(mapping)
    if law == JUDGED:
        case = case.replace("friction.draws_file", str(file_without_report()))
    return case


def pin_strength() -> tuple[float, float]:
    """Return shear strength (Pa) under the fluid at the tester's speed, and what is hysteresis.

    The adhesion that Eq. 17 leaves on the pin at 0.3 m/s, over the pin's real contact area. The
    pin's asperities follow from its roughness by the rules that the sole's follow from.
    """
    catalogue = Catalogue.load()
    pin = pin_on_disk(catalogue)
    friction = next(fluid for fluid in measured_fluids(catalogue) if fluid.fluid == FLUID)
    assert friction.tau_hydro is not None
    assert friction.cof_asymptote is not None
    left = float(friction.cof_asymptote)
    cof = float(stribeck_cof(0.3, float(friction.cof_boundary), float(friction.tau_hydro), left))
    rules = sole_case(60.0, "stribeck")
    factor, longest, hurst = (
        float(rules.value(f"interface.{name}"))
        for name in ("roughness_beyond_cutoff", "longest_wave", "hurst")
    )
    rq = factor * float(np.hypot(pin.sole_rq, pin.floor_rq))
    fractal = {"longest_wave": longest, "hurst": min(hurst, 0.99)}
    scale = self_affine_scale(STYLUS_RESOLUTION, rq=rq, **fractal)
    share = float(scale.contact_fraction(pin.pressure / pin.modulus))
    source = "final progress report on shoe-floor friction, G.2.2"
    return strength_from_cof(cof - left, pin.pressure, share, source).strength, left


def sole_frictions(
    *, quick: bool, processes: int | None = 1, progress: Progress = silent
) -> list[SoleFriction]:
    """Return the three soles by the five laws: 90 cases (45 with ``quick``)."""
    times = WINDOW[1:2] if quick else WINDOW
    plan = [(sole, law, shore) for law in LAWS for sole, shore in SOLES.items()]

    def at(shore: float, law: str, time: float) -> Case:
        return sole_case(shore, law).replace("motion.duration", f"{time!r} s")

    cases = []
    for _, law, shore in plan:
        cases += [at(shore, law, time) for time in times]
        cases += [at(shore + side * HARDNESS_BAND, law, WINDOW[1]) for side in (1, -1)]
    fine = {"progress": part(progress, 0.0, 0.8), "stage": "Whole-shoe friction"}
    found = outcomes(cases, quick=quick, processes=processes, **fine)
    coarse: Sequence[CaseOutcome | None] = [None] * len(plan)
    if not quick:
        cases = [at(shore, law, WINDOW[1]) for _, law, shore in plan]
        stage = {"progress": part(progress, 0.8, 1.0), "stage": "Coarse grid"}
        coarse = outcomes(cases, quick=True, processes=processes, **stage)
    width = len(times) + 2
    frictions = [
        _friction(*one, found[i * width : (i + 1) * width], coarse[i]) for i, one in enumerate(plan)
    ]
    return [
        _with_draws(friction) if friction.law in (JUDGED, "pair") else friction
        for friction in frictions
    ]


def _with_draws(friction: SoleFriction) -> SoleFriction:
    """Return the friction with the joint draws of its law, on the quick grid about its value."""
    case = sole_case(friction.shore, friction.law).replace("motion.duration", f"{WINDOW[1]!r} s")
    result = run(case, quick=True)
    draws = result.data["cof_draws"].values
    hardness = normal_draws(0, f"hardness of the {friction.sole} outsole", draws.size)
    spread = 0.5 * math.log(friction.high / friction.low)
    drawn = draws * (friction.cof / result.value("cof")) * np.exp(abs(spread) * hardness)
    return replace(friction, draws=drawn)


def _friction(
    sole: str, law: str, shore: float, computed: list[CaseOutcome], coarse: CaseOutcome | None
) -> SoleFriction:
    window, ends = computed[:-2], [outcome.number("cof") for outcome in computed[-2:]]
    values = np.array([outcome.number("cof") for outcome in window])
    weights = np.array([1.0, 4.0, 1.0]) / 6 if values.size == 3 else np.ones(1)
    middle = window[len(window) // 2]
    mean = float(weights @ values)
    pressures = [max(outcome.number("peak_fluid_pressure_sensor") for outcome in window)]
    on_coarse = math.nan
    if coarse is not None:
        on_coarse = mean + coarse.number("cof") - middle.number("cof")
        pressures.insert(0, coarse.number("peak_fluid_pressure_sensor"))
    return SoleFriction(
        sole,
        law,
        shore,
        mean,
        on_coarse,
        middle.standard_deviation("cof"),
        min(ends),
        max(ends),
        tuple(pressures),
        middle.number("fluid_load") / middle.number("normal_force"),
    )


def population_risk(acof: float) -> dict[str, float]:
    """Return the share of the default population that slips by each published model."""
    return {
        name: float(slip_model(name).population(acof, ADULTS.mean, ADULTS.sd)) for name in MODELS
    }


def risk_by_rcof(count: int = 29) -> tuple[float, float, float]:
    """Return the risk of the lowest, median and highest RCOF of ``count`` persons, by the report's
    logistic, mean over the three outsoles with their printed ACOF.

    Lowest and highest are the expected extremes of normal values (0.20 ± 0.03).
    """
    rcof = risk_places(count)
    incomplete = np.mean([ReportG6()(acof, rcof) for acof in PRINTED_ACOF.values()], axis=0)
    return float(incomplete[0]), float(incomplete[1]), float(incomplete[2])


def risk_places(count: int = 29) -> Array:
    """Return the lowest, median and highest RCOF to be expected of ``count`` persons, (3,)."""
    from scipy.stats import norm

    z = np.linspace(-8, 8, 4001)
    highest = np.gradient(norm.cdf(z) ** count, z)
    reach = float(np.trapezoid(z * highest, z)) * ADULTS.sd
    return np.array([ADULTS.mean - reach, ADULTS.mean, ADULTS.mean + reach])


def precision_of_published(*, draws: int = 200, seed: int = 0) -> tuple[Array, Array]:
    """Return slopes and 50 % points (draws,) of studies as large as G.6 if its logistic were true.

    People 0.20 ± 0.03, printed ACOF; a study whose data separate is fitted with Firth's penalty.
    """
    generator = np.random.default_rng(seed)
    levels = np.array(list(PRINTED_ACOF.values()))
    model, found = ReportG6(), []
    while len(found) < draws:
        acof = levels[generator.integers(3, size=TRIALS)]
        rcof = np.clip(generator.normal(ADULTS.mean, ADULTS.sd, TRIALS), 0.0, 1.0)
        slipped = generator.random(TRIALS) < model(acof, rcof)
        if slipped.any() and not slipped.all():
            fit = fitted_logistic(acof - rcof, slipped)
            found.append((fit.slope, fit.half))
    slopes, halves = np.array(found).T
    return slopes, halves


def fitted_logistic(difference: Array, slipped: Array) -> Logistic:
    """Return the logistic of slips in ACOF - RCOF; separated data by Firth's penalty.

    All nan where everybody slips or nobody does: there is none then.
    """
    if slipped.all() or not slipped.any():
        return Logistic(*[math.nan] * 5)
    outcome = slipped.astype(int)
    try:
        fit = logistic_regression(outcome, {"difference": difference})
    except DataError:
        fit = logistic_regression(outcome, {"difference": difference}, method="firth")
    slope, curve = fit.coefficients[1], risk_curve(fit)
    low, high = (math.nan if v is None else float(v) for v in (slope.low, slope.high))
    return Logistic(slope.estimate, low, high, curve.half, curve.half_error)


def slips(
    acof: Mapping[str, float], *, own_speed: bool, subjects: int, progress: Progress = silent
) -> OutsoleSlips:
    """Return computed steps of one population on three outsoles.

    Parameters:
        acof: Friction of each outsole under the tester.
        own_speed: Friction falls with the slipping speed as on the pin (Eq. 17), scaled to ``acof``
            at the tester's 0.3 m/s; otherwise it is ``acof`` at every speed.
        subjects: Persons, each on all three outsoles.

    The film is left out (under the tester it carries about 2 % of the load, see the table):
    friction then depends on speed alone and the fast model has no error of its own.
    """
    case = sole_case(SOLES["medium"], "stribeck").replace(
        {"slip.mass_mean": "76.7 kg", "slip.mass_sd": "20 kg"}
    )
    setting = replace(slip_setting(case), viscosity=None)
    population = slip_population(case, subjects=subjects)
    speed, shape = cof_table(setting.friction, 2.5e5)
    at_tester = float(np.interp(0.3, speed, shape))
    every, share = [], {}
    for number, (sole, level) in enumerate(acof.items()):
        progress(f"Slips on the {sole} outsole", number / len(acof), None)
        cofs = shape * (level / at_tester) if own_speed else np.full(speed.size, level)
        law = SpeedTableLaw(speed[1:], cofs[1:], source=f"{sole} outsole")
        study = slip_study(
            replace(setting, friction=law, key=""), population, array=slip_sensors(case)
        )
        fell = np.array([subject.seen.slipped for subject in study.subjects])
        rcof = np.array([subject.walker.rcof for subject in study.subjects])
        share[sole] = float(fell.mean())
        every.append((np.full(fell.size, level), rcof, fell))
    levels, rcof, fell = (np.concatenate(column) for column in zip(*every, strict=True))
    return OutsoleSlips(levels, rcof, fell, share, fitted_logistic(levels - rcof, fell))


def of_law(frictions: Sequence[SoleFriction], law: str) -> dict[str, SoleFriction]:
    """Return the soles of one law by name."""
    return {friction.sole: friction for friction in frictions if friction.law == law}


def quantities(
    frictions: Sequence[SoleFriction], steps: Mapping[str, OutsoleSlips], *, quick: bool, seed: int
) -> dict[str, ComputedQuantity]:
    """Return every quantity of the study by name."""
    numerics = sole_case(60.0, "stribeck").numerics
    spacings = (numerics.quick_grid_spacing, numerics.grid_spacing)
    spacings = spacings[:1] if quick else spacings
    by_name: dict[str, ComputedQuantity] = {}

    def on_grids(coarse: float, fine: float) -> list[tuple[float, float]]:
        return list(zip(spacings, (fine,) if quick else (coarse, fine), strict=True))

    for law in LAWS:
        soles = of_law(frictions, law)
        for sole, friction in soles.items():
            levels = on_grids(friction.coarse, friction.cof)
            draws = friction.draws
            if draws is None:
                normal = np.random.default_rng(seed).normal(size=400)
                draws = friction.cof * np.exp(friction.spread / friction.cof * normal)
            by_name[f"acof.{law}.{sole}"] = ComputedQuantity.of(
                friction.cof, draws=draws, levels=levels
            )
            risks = [population_risk(min(float(v), 1.0))["report_g6"] for v in draws]
            by_name[f"risk.{law}.{sole}"] = ComputedQuantity.of(
                population_risk(friction.cof)["report_g6"], draws=risks
            )
        hard, soft = soles["hard"], soles["soft"]
        # the pin's own error is common to both soles: the hardness alone moves their difference
        spread = 0.5 * math.hypot(hard.high - hard.low, soft.high - soft.low)
        change = soft.cof - hard.cof
        levels = on_grids(soft.coarse - hard.coarse, change)
        given: dict[str, Any] = {"deviation": spread or None}
        chance = None
        if soft.draws is not None and hard.draws is not None:
            given = {"draws": soft.draws - hard.draws}
            chance = chance_of_order([soft.draws, hard.draws], TIE)
        by_name[f"softer.{law}"] = ComputedQuantity.of(change, **given, levels=levels)
        order = ComputedQuantity.of([soft.cof, hard.cof], names=("soft", "hard"), chance=chance)
        by_name[f"order.{law}"] = order
    pressures = np.max([sole_friction.sensor_pressure for sole_friction in frictions], axis=0)
    levels = on_grids(pressures[0], pressures[-1])
    by_name["sensor_pressure"] = ComputedQuantity.of(pressures[-1], "Pa", levels=levels)
    for sole, acof in PRINTED_ACOF.items():
        by_name[f"risk.printed.{sole}"] = ComputedQuantity.of(population_risk(acof)["report_g6"])
    for name, risk in zip(("lowest", "median", "highest"), risk_by_rcof(), strict=True):
        by_name[f"risk.rcof.{name}"] = ComputedQuantity.of(risk)
    for name, walked in steps.items():
        count = walked.slipped.size // len(walked.share)
        shares = {**walked.share, "all": float(np.mean(list(walked.share.values())))}
        for sole, share in shares.items():
            trials = count * (len(walked.share) if sole == "all" else 1)
            slipped = round(share * trials)
            drawn = np.random.default_rng(seed).beta(
                slipped + 0.5, trials - slipped + 0.5, 4000
            )  # Jeffreys' posterior of a share
            by_name[f"steps.{name}.{sole}"] = ComputedQuantity.of(share, draws=drawn)
        spread = (walked.fit.slope_high - walked.fit.slope_low) / (2 * 1.96)
        if math.isnan(walked.fit.slope):
            none = ComputedQuantity.none(f"{_who(walked)} slips: there is no logistic")
            by_name |= {f"slope.{name}": none, f"half.{name}": none}
        else:
            by_name[f"slope.{name}"] = ComputedQuantity.of(walked.fit.slope, deviation=spread)
            by_name[f"half.{name}"] = ComputedQuantity.of(
                walked.fit.half, deviation=walked.fit.half_error
            )
    return by_name


def _friction_table(frictions: Sequence[SoleFriction]) -> StudyTable:
    return StudyTable.of(
        "whole_shoe_acof",
        "ACOF under the slip tester of G.6; low and high: hardness ± 5 Shore A",
        [
            {
                "law": friction.law,
                "outsole": friction.sole,
                "Shore A": friction.shore,
                "ACOF": friction.cof,
                "±": friction.deviation,
                "low": friction.low,
                "high": friction.high,
                "coarse grid": friction.coarse,
                "sensor Pa": friction.sensor_pressure[-1],
                "load on film": friction.film_share,
            }
            for friction in frictions
        ],
    )


def _risk_table(frictions: Sequence[SoleFriction]) -> StudyTable:
    every = [("printed", name, acof) for name, acof in PRINTED_ACOF.items()]
    every += [(friction.law, friction.sole, friction.cof) for friction in frictions]
    return StudyTable.of(
        "slip_risk",
        "Share of a population with RCOF 0.20 ± 0.03 that slips, by published models",
        [
            {"ACOF from": origin, "outsole": sole, "ACOF": acof, **population_risk(acof)}
            for origin, sole, acof in every
        ],
    )


def _step_table(steps: Mapping[str, OutsoleSlips]) -> StudyTable:
    return StudyTable.of(
        "slips",
        "Steps computed one by one",
        [
            {
                "friction": STEPS[name],
                **{sole: step.share[sole] for sole in SOLES},
                "all": np.mean(list(step.share.values())),
                "slope": step.fit.slope,
                "slope low": step.fit.slope_low,
                "slope high": step.fit.slope_high,
                "half slip at": step.fit.half,
            }
            for name, step in steps.items()
        ],
    )


def _conclusions(
    frictions: Sequence[SoleFriction], steps: Mapping[str, OutsoleSlips], drawn: tuple[Array, Array]
) -> tuple[str, ...]:
    area, own = of_law(frictions, "bowden_tabor"), of_law(frictions, JUDGED)
    constant, falling = (steps[name] for name in STEPS)
    low, high = np.percentile(drawn[0], [2.5, 97.5])
    return (
        "The default law, which knows no reading of the report, gives "
        f"{own['hard'].cof:.3f}, {own['medium'].cof:.3f} and {own['soft'].cof:.3f} (hard, medium, "
        "soft; printed 0.159 and 0.182). The level follows from a pin too: "
        f"{of_law(frictions, 'stribeck')['medium'].cof:.3f} by Eq. 17 without any whole-shoe data. "
        "The differences between outsoles do not follow with certainty: the default law gives the "
        f"right order by {own['soft'].cof - own['hard'].cof:+.3f}, real contact area "
        f"by {area['soft'].cof - area['hard'].cof:+.3f} (from hard to soft), films at "
        "asperities the opposite one, and the hardness itself is not printed.",
        "Slips computed from gait and mass alone, with the printed friction at every speed: "
        f"{_logistic_words(constant)}. If friction falls with the slipping speed as on the pin "
        f"(0.47 at rest): {_logistic_words(falling)}. The observed slope of -49.2 speaks for "
        "friction that does not rise much towards rest under a real heel.",
        f"Fifty trials fix the slope to {low:.0f} .. {high:.0f} only: the slopes quoted from other "
        "studies (-41 to -55) are not told apart from -49.2.",
    )


def outsole_figure(frictions: Sequence[SoleFriction], steps: Mapping[str, OutsoleSlips]) -> Figure:
    """Return slip risk (left) and friction (right) of the outsoles, printed and by each law."""
    risks = {
        sole: [100 * PRINTED_RISK[sole], *(100 * s.share[sole] for s in steps.values())]
        for sole in SOLES
    }
    laws = {law: of_law(frictions, law) for law in LAWS}
    acof, low, high = (
        {sole: [getattr(laws[law][sole], name) for law in LAWS] for sole in SOLES}
        for name in ("cof", "low", "high")
    )
    style: dict[str, Any] = {"colour": PRINTED, "style": "horizontal"}
    band = Layer("span", low=0.159, high=0.182, label="report, hard to soft", **style)
    bars = grouped_bars(acof, colours=SOLE_COLOURS, low=low, high=high)
    computed = [f"computed,\n{speeds}" for speeds in SPEEDS.values()]
    return Figure(
        (
            Panel(
                grouped_bars(risks, colours=SOLE_COLOURS),
                y_label="steps that slip (%)",
                x_ticks=["report", *computed],
            ),
            Panel(
                [band, *bars],
                y_label="available friction (ACOF)",
                x_ticks=[*LAWS.values()],
                y_limits=(0.0, None),
            ),
        ),
        "Fig. 36: slip risk and friction by outsole; bars on the right: hardness ± 5 Shore A",
        columns=2,
        size=(5.4, 4.0),
    )


def logistic_figure(steps: Mapping[str, OutsoleSlips], drawn: tuple[Array, Array]) -> Figure:
    """Return simulated slips over ACOF, RCOF and their difference, with what is printed of each."""
    columns = len(steps)
    rows: list[list[Panel]] = [[], [], []]
    reach = risk_places()
    for name, steps_of_law in steps.items():
        difference = steps_of_law.acof - steps_of_law.rcof
        noise = np.random.default_rng(0).uniform(-0.02, 0.02, difference.size)
        shares = [
            float(steps_of_law.slipped[steps_of_law.acof == level].mean())
            for level in np.unique(steps_of_law.acof)
        ]
        rows[0].append(
            Panel(
                (
                    points(
                        [*PRINTED_RATES], [*PRINTED_RATES.values()], "report", **_PRINTED_POINTS
                    ),
                    points(np.unique(steps_of_law.acof), shares, "steps", marker="o"),
                ),
                "ACOF",
                "share that slips",
                f"A: {STEPS[name]}",
                x_limits=(0.15, 0.19),
                y_limits=(0.0, 1.0),
            )
        )
        bins = np.quantile(steps_of_law.rcof, np.linspace(0, 1, 9))
        place = np.clip(np.searchsorted(bins, steps_of_law.rcof, side="right") - 1, 0, 7)
        middle = [float(steps_of_law.rcof[place == k].mean()) for k in range(8)]
        by_rcof = [float(steps_of_law.slipped[place == k].mean()) for k in range(8)]
        rows[1].append(
            Panel(
                (
                    points(reach, PRINTED_BY_RCOF, "report's model", **_PRINTED_POINTS),
                    points(middle, by_rcof, "steps, by eighths", marker="o"),
                ),
                "RCOF",
                "share that slips",
                "B",
                y_limits=(0.0, 1.0),
            )
        )
        x = np.linspace(min(difference.min(), -0.13), max(difference.max(), 0.06), 201)
        curves = _curve(x[:, None], drawn[0][None, :], drawn[1][None, :])
        low, high = np.percentile(curves, [2.5, 97.5], axis=1)
        text = "52 trials of that curve, 95 %"
        fitted = _curve(x, steps_of_law.fit.slope, steps_of_law.fit.half)
        layers = (
            points(difference, steps_of_law.slipped + noise, colour="0.6", marker="."),
            Layer("band", x, low=low, high=high, colour=PRINTED, label=text),
            line(x, _curve(x, PRINTED_SLOPE, PRINTED_HALF), "report: slope -49.2", colour=PRINTED),
            line(x, fitted, f"steps: {_logistic_words(steps_of_law)}"),
        )
        rows[2].append(Panel(layers, "ACOF - RCOF", "chance of a slip", "C"))
    title = "Fig. 37: computed slips over available and required friction and their difference"
    panels = [panel for row in rows for panel in row]
    return Figure(panels, title, columns=columns, size=(5.0, 3.0))


PRINTED_RATES = {0.159: 0.41, 0.182: 0.06}
PRINTED_BY_RCOF = (0.03, 0.26, 0.83)
"""Risk at the lowest, median and highest RCOF (G.6.2)."""
_PRINTED_POINTS: dict[str, Any] = {"colour": PRINTED, "marker": "D"}


def _who(steps: OutsoleSlips) -> str:
    return "everybody" if steps.slipped.all() else "nobody"


def _logistic_words(steps: OutsoleSlips) -> str:
    if math.isnan(steps.fit.slope):
        return f"{_who(steps)} slips"
    return f"slope {steps.fit.slope:.0f}, half at {steps.fit.half:.3f}"


def _curve(x: Any, slope: Any, half: Any) -> Array:
    return 0.5 * (1 + np.tanh(0.5 * slope * (x - half)))
