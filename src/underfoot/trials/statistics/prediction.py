"""How well a number predicts slips: ROC, Brier score, calibration, with persons as units."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import DataError, UnderfootError
from underfoot.core.remark import Message

from .logistic import logistic_regression


@dataclass(frozen=True, slots=True)
class RocArea:
    """Area under the ROC curve with standard error and interval (logit scale)."""

    area: float
    error: float
    low: float
    high: float
    persons: int


def roc_area(
    outcome: ArrayLike,
    score: ArrayLike,
    person: Sequence[object] = (),
    *,
    confidence: float = 0.95,
) -> RocArea:
    """Return the chance that a slip has a higher score than a trial without one.

    Ties count one half. The error holds persons together (Obuchowski); with one row a person it
    is DeLong's.

    ``outcome``: 0 or 1, shape (n,). ``score``: higher means a slip is expected. ``person``: whose
    each row is; each its own without.

    DataError: lengths differ, missing values, one outcome alone, fewer than three persons.

    Source: N. A. Obuchowski, Biometrics 53 (1997) 567; E. R. DeLong et al., Biometrics 44 (1988)
    837.
    """
    from scipy.stats import norm, rankdata

    y, x, who, persons = _rows(outcome, score, person)
    slips, others = x[y == 1], x[y == 0]
    m, n = len(slips), len(others)
    ranks = rankdata(x)
    # placements: share of the other group that each row beats
    of_slips = (ranks[y == 1] - rankdata(slips)) / n
    of_others = 1.0 - (ranks[y == 0] - rankdata(others)) / m
    area = float(of_slips.mean())
    above = np.bincount(who[y == 1], of_slips - area, persons)
    below = np.bincount(who[y == 0], of_others - area, persons)
    with_slip = len(set(who[y == 1].tolist()))
    without = len(set(who[y == 0].tolist()))
    if min(with_slip, without) < 2:
        raise DataError("one person alone has slips, or none", where="ROC")
    variance = (
        with_slip / (with_slip - 1) * float(above @ above) / m**2
        + without / (without - 1) * float(below @ below) / n**2
        + 2.0 * persons / (persons - 1) * float(above @ below) / (m * n)
    )
    error = float(np.sqrt(max(variance, 0.0)))
    if not 0 < area < 1:
        # all slips above all others: what so few persons could have hidden (rule of three)
        edge = float((0.5 - confidence / 2) ** (1.0 / min(with_slip, without)))
        ends = (edge, 1.0) if area == 1 else (0.0, 1.0 - edge)
        return RocArea(area, error, *ends, persons)
    reach = float(norm.ppf(0.5 + confidence / 2)) * error / (area * (1.0 - area))
    middle = np.log(area / (1.0 - area))
    low, high = (float(0.5 * (1 + np.tanh(0.5 * (middle + s * reach)))) for s in (-1, 1))
    return RocArea(area, error, low, high, persons)


@dataclass(frozen=True, slots=True)
class Prediction:
    """Slips as a logistic model foretells them for persons that it has not seen.

    ``risk``: predicted probability of each row. ``brier``: mean squared error of it, with its
    interval (bootstrap by persons); ``constant``: that of the share of slips of the other persons.
    ``calibration_slope`` (1 is right, below 1 too extreme) and ``calibration_intercept`` (0 is
    right, above 0 too few foretold): of a logistic regression of the slips on the predicted log
    odds; None where that has no finite answer.
    """

    risk: np.ndarray
    brier: float
    brier_low: float
    brier_high: float
    constant: float
    calibration_slope: float | None
    calibration_intercept: float | None


def slip_prediction(
    outcome: ArrayLike, predictor: ArrayLike, person: Sequence[object] = ()
) -> Prediction:
    """Return the prediction of slips by Firth's logistic regression, each person left out in turn.

    DataError: as ``roc_area``; or a person without whom nobody slipped.

    Source: G. W. Brier, Mon. Weather Rev. 78 (1950) 1; D. R. Cox, Biometrika 45 (1958) 562.
    """
    y, x, who, persons = _rows(outcome, predictor, person)
    risk, constant = np.empty(len(y)), np.empty(len(y))
    for one in range(persons):
        own = who == one
        fit = logistic_regression(y[~own].astype(int), {"x": x[~own]}, method="firth")
        risk[own], constant[own] = fit.probability(x=x[own]), y[~own].mean()

    def brier(rows: np.ndarray) -> float:
        return float(np.mean((risk[rows] - y[rows]) ** 2))

    low, high = person_bootstrap(brier, who.tolist())
    odds = np.log(np.clip(risk, 1e-12, None) / np.clip(1.0 - risk, 1e-12, None))
    slope = intercept = None
    try:
        fit = logistic_regression(y.astype(int), {"x": odds})
        slope, intercept = fit["x"].estimate, fit["intercept"].estimate
    except UnderfootError:  # separated: the slope is infinite
        pass
    whole = brier(np.arange(len(y)))
    flat = float(np.mean((constant - y) ** 2))
    return Prediction(risk, whole, low, high, flat, slope, intercept)


def person_bootstrap(
    statistic: Callable[[np.ndarray], float],
    person: Sequence[object],
    *,
    confidence: float = 0.95,
    draws: int = 2000,
    seed: int = 20_260_101,
) -> tuple[float, float]:
    """Return the BCa bootstrap interval of a statistic, drawing whole persons with replacement.

    ``statistic``: of row numbers (m,); draws for which it is not finite or raises DataError are
    left out. ``person``: whose each row is, shape (n,). The same seed gives the same interval.

    DataError: fewer than three persons, or a statistic that is mostly undefined.

    Source: B. Efron, J. Am. Stat. Assoc. 82 (1987) 171.
    """
    from scipy.stats import norm

    names = list(map(str, person))
    rows = [np.flatnonzero(np.array(names) == name) for name in dict.fromkeys(names)]
    if len(rows) < 3:
        raise DataError(
            Message("{count} persons", count=len(rows)), where="bootstrap", allowed="three or more"
        )

    def of(persons: np.ndarray) -> float:
        try:
            return statistic(np.concatenate([rows[i] for i in persons]))
        except DataError:
            return np.nan

    rng = np.random.default_rng(seed)
    samples = np.array([of(rng.integers(len(rows), size=len(rows))) for _ in range(draws)])
    samples = samples[np.isfinite(samples)]
    if len(samples) < draws / 2:
        raise DataError("undefined in most draws of persons", where="bootstrap")
    everyone = np.arange(len(rows))
    whole = of(everyone)
    left_out = np.array([of(np.delete(everyone, i)) for i in everyone])
    away = np.nanmean(left_out) - left_out
    spread = float(np.nansum(away**2))
    skew = float(np.nansum(away**3)) / (6.0 * spread**1.5) if spread > 0 else 0.0
    share = np.clip((samples < whole).mean() + 0.5 * (samples == whole).mean(), 1e-4, 1 - 1e-4)
    shift = norm.ppf(share)
    z = shift + norm.ppf([0.5 - confidence / 2, 0.5 + confidence / 2])
    low, high = np.quantile(samples, norm.cdf(shift + z / (1.0 - skew * z)))
    return float(low), float(high)


def _rows(
    outcome: ArrayLike, score: ArrayLike, person: Sequence[object]
) -> tuple[np.ndarray, np.ndarray, np.ndarray, int]:
    y, x = np.asarray(outcome, dtype=float), np.asarray(score, dtype=float)
    names = list(map(str, person)) if len(person) else list(map(str, range(len(y))))
    if not len(y) == len(x) == len(names) or not np.isfinite(x).all():
        raise DataError("rows are incomplete", where="prediction")
    if not np.isin(y, (0.0, 1.0)).all() or not 0 < y.sum() < len(y):
        raise DataError("the outcome must be 0 and 1, both of them", where="prediction")
    order = {name: i for i, name in enumerate(dict.fromkeys(names))}
    if len(order) < 3:
        raise DataError(
            Message("{count} persons", count=len(order)),
            where="prediction",
            allowed="three or more",
        )
    return y, x, np.array([order[name] for name in names]), len(order)
