"""Who slips in G.6: the report's logistic over a population, and slips computed step by step."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from underfoot.core import DataError, Progress, silent

from .g6_soles import SOLES, sole_case

Array = NDArray[np.float64]
PRINTED_ACOF = {"hard": 0.159, "medium": 0.159, "soft": 0.182}
"""G.6.3; that of the medium outsole is not printed, but "indistinguishable" from the hard one."""
PRINTED_RISK = {"hard": 0.54, "medium": 0.42, "soft": 0.077}
TRIALS = 52
"""29 persons, two slips each, less 6 that did not hit the plate cleanly (G.6.1)."""
SUBJECTS, QUICK_SUBJECTS = 200, 60


@dataclass(frozen=True, slots=True)
class Logistic:
    """A fitted logistic in ACOF - RCOF: slope and 50 % point with 95 % bounds (nan: none)."""

    slope: float
    slope_low: float
    slope_high: float
    half: float
    half_error: float
    trials: int


@dataclass(frozen=True, slots=True)
class Slips:
    """Steps of one population on three outsoles.

    ``acof``, ``rcof``, ``slipped`` (n,) are of all steps; ``share`` of each outsole.
    """

    acof: Array
    rcof: Array
    slipped: Array
    share: dict[str, float]
    fit: Logistic


def population_risk(acof: float) -> dict[str, float]:
    """Return the share of the default population that slips by each published model."""
    from underfoot.slip import ADULTS_LEVEL_WALKING as adults
    from underfoot.slip import MODELS, slip_model

    return {
        name: float(slip_model(name).population(acof, adults.mean, adults.sd)) for name in MODELS
    }


def risk_by_rcof(count: int = 29) -> tuple[float, float, float]:
    """Return the risk of the lowest, median and highest RCOF of ``count`` persons, by the report's
    logistic, mean over the three outsoles with their printed ACOF.

    Lowest and highest are the expected extremes of normal values (0.20 ± 0.03).
    """
    from scipy.stats import norm

    from underfoot.slip import ADULTS_LEVEL_WALKING as adults
    from underfoot.slip import ReportG6

    z = np.linspace(-8, 8, 4001)
    highest = np.gradient(norm.cdf(z) ** count, z)
    reach = float(np.trapezoid(z * highest, z))
    rcof = np.array([adults.mean - reach * adults.sd, adults.mean, adults.mean + reach * adults.sd])
    model = ReportG6()
    found = np.mean([model(acof, rcof) for acof in PRINTED_ACOF.values()], axis=0)
    return float(found[0]), float(found[1]), float(found[2])


def implied_differences() -> dict[str, float]:
    """Return ACOF - RCOF behind the printed risks 0.6, 21 and 92.5 %, and the slope of the log
    odds with ACOF alone between the printed slip rates (per unit)."""

    def logit(p: float) -> float:
        return math.log(p / (1 - p))

    places = {p: -0.06 + logit(p) / -49.2 for p in (0.006, 0.21, 0.925)}
    return {
        "lowest": places[0.006],
        "median": places[0.21],
        "highest": places[0.925],
        "acof_slope": (logit(0.06) - logit(0.41)) / (0.182 - 0.159),
    }


def precision_of_published(*, draws: int = 200, seed: int = 0) -> tuple[Array, Array]:
    """Return slopes and 50 % points (draws,) of studies as large as G.6 if its logistic were true.

    People 0.20 ± 0.03, printed ACOF; a study whose data separate is fitted with Firth's penalty.
    """
    from underfoot.slip import ADULTS_LEVEL_WALKING as adults
    from underfoot.slip import ReportG6

    generator = np.random.default_rng(seed)
    levels = np.array(list(PRINTED_ACOF.values()))
    model, found = ReportG6(), []
    while len(found) < draws:
        acof = levels[generator.integers(3, size=TRIALS)]
        rcof = np.clip(generator.normal(adults.mean, adults.sd, TRIALS), 0.0, 1.0)
        slipped = generator.random(TRIALS) < model(acof, rcof)
        if slipped.any() and not slipped.all():
            fit = fitted_logistic(acof - rcof, slipped)
            found.append((fit.slope, fit.half))
    slopes, halves = np.array(found).T
    return slopes, halves


def fitted_logistic(difference: Array, slipped: Array) -> Logistic:
    """Return the logistic of slips in ACOF - RCOF; separated data by Firth's penalty."""
    from underfoot.trials.risk_curves import risk_curve
    from underfoot.trials.statistics.logistic import logistic_regression

    outcome = slipped.astype(int)
    try:
        fit = logistic_regression(outcome, {"difference": difference})
    except DataError:
        fit = logistic_regression(outcome, {"difference": difference}, method="firth")
    slope = fit.coefficients[1]
    curve = risk_curve(fit)
    low, high = (math.nan if v is None else float(v) for v in (slope.low, slope.high))
    return Logistic(slope.estimate, low, high, curve.half, curve.half_error, len(outcome))


def slips(
    acof: dict[str, float], *, own_speed: bool, subjects: int, progress: Progress = silent
) -> Slips:
    """Return computed steps of one population on three outsoles.

    Parameters
    ----------
    acof
        Friction of each outsole under the tester.
    own_speed
        Friction falls with the slipping speed as on the pin (Eq. 17), scaled to ``acof`` at the
        tester's 0.3 m/s; otherwise it is ``acof`` at every speed.
    subjects
        Persons, each on all three outsoles.

    Notes
    -----
    The film is left out (under the tester it carries about 2 % of the load, see the table):
    friction then depends on speed alone and the fast model has no error of its own.
    """
    from underfoot.case.build_slip import slip_population, slip_sensors, slip_setting
    from underfoot.friction import SpeedTableLaw
    from underfoot.slip.dynamics import cof_table, slip_study

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
        fell = np.array([one.seen.slipped for one in study.subjects])
        rcof = np.array([one.walker.rcof for one in study.subjects])
        share[sole] = float(fell.mean())
        every.append((np.full(fell.size, level), rcof, fell))
    levels, rcof, fell = (np.concatenate(column) for column in zip(*every, strict=True))
    return Slips(levels, rcof, fell, share, fitted_logistic(levels - rcof, fell))


def published_mean(shares: Sequence[float]) -> float:
    """Return the mean over the outsoles, each worn equally often."""
    return float(np.mean(shares))
