"""The contact law of a pair and its rivals, fitted to the corpus with the errors between sources.

    ln COF = ln law(theta) + u_source + w d_source + v_pair + t_tread + e

u is the error of a source's tester on everything, d its error on the dry-like part (w is that
part's share of the friction), v the pair's, t that of the tread (learned from other laboratories'
treads), e that of the reading and of what the source leaves open. Two studies of one laboratory
are two testers. The points of a printed curve count once together. Bounds and ranges count by the
probability between them given the values of the same source, one after another with the moments of
what is left (Mendell and Elston 1974, Biometrics 30:41; exact for one). The posterior is sampled by
adaptive importance sampling from its mode (Cornuet et al. 2012, Scand. J. Statist. 39:798).

No prior knows a source that is scored: each is a range that physics leaves, with its reason.

    python -m underfoot.studies.pair_law DRAWS.csv
"""

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize
from scipy.stats import norm, qmc, spearmanr

from underfoot.core.arrays import Array
from underfoot.core.errors import ConvergenceError
from underfoot.friction.pair_contact import (
    CONTACT_PRESSURE,
    LOSS_TANGENTS,
    Family,
    PairConstants,
    PairDraws,
    contact_terms,
    relative_area,
)
from underfoot.friction.tread_error import PRIOR as TREAD_PRIOR
from underfoot.friction.tread_error import fluid_class, learned_deviation, tread_pairs

from .sources import NUMBERS, PublishedCondition, Span, corpus, sampled_numbers

DRAWS_KEPT = 2000
"""Of a posterior."""
ROUNDS = 24
"""Most rounds of the sampler; the last twelve have all of its points."""
FREEDOM = 5.0
"""Degrees of freedom of the sampler's proposals."""
DRAWS = 8
"""Points over the open ranges of a condition."""
SD_SOURCE = 0.33
"""Between laboratories, sd of ln COF: reproducibility limits of 70 and 100 % of one shoe on eight
machines, over 2.8 (Jung and Fischer 1993, Safety Science 16:115): 0.25 and 0.36."""
SPREAD_PRIOR = (SD_SOURCE, 0.4, 0.2, SD_SOURCE)
"""Of a laboratory, a pair, a reading and the dry part of a laboratory; the first log-normal with sd
0.35 of its logarithm, the others half-normal. The dry part of a laboratory is off by no more than
its whole reading."""
FAMILIES: dict[str, Family] = {
    "dry": "dry",
    "water": "aqueous",
    "detergent": "detergent",
    "aqueous": "aqueous",
    "oil": "oil",
}
"""Family of the law's fluids by that of the corpus."""
OPEN = {
    "loss_tangent": Span(*LOSS_TANGENTS),
    "pressure": Span(CONTACT_PRESSURE, CONTACT_PRESSURE),
}
"""Of a condition whose loss tangent or pressure is not printed (assumed)."""


@dataclass(frozen=True, slots=True)
class PairLaw:
    """A law of the contact friction with normal priors on its parameters.

    ``ln_cof(theta, numbers, fluid)`` takes (draws, parameters) and numbers (points,) and returns
    (draws, points); ``dry`` is the parameter of the dry-like part, if the law has one.
    """

    name: str
    parameters: tuple[str, ...]
    prior: tuple[tuple[float, float], ...]
    ln_cof: Callable[[Array, dict[str, Array], str], Array]
    dry: int | None = None


def _constants(columns: Array) -> PairConstants:
    return PairConstants(*np.exp(columns[:5]), *columns[5:])


def _pair(theta: Array, numbers: dict[str, Array], fluid: str) -> Array:
    columns = theta.T[..., None]
    terms = contact_terms(_constants(columns), numbers, family=FAMILIES[fluid])
    drag = None if fluid == "dry" else numbers["viscosity"] * np.abs(numbers["speed"])
    return np.log(terms.adhesion(numbers["pressure"], drag) + terms.hysteresis)


def _dry_power(theta: Array, numbers: dict[str, Array], fluid: str) -> Array:
    if fluid != "dry":
        return _pair(theta[:, :-1], numbers, fluid)
    columns = theta.T[..., None]
    terms = contact_terms(_constants(columns[:-1]), numbers, family="dry")
    area = relative_area(numbers["pressure"], terms.full_contact)
    return np.log(terms.rest * area ** columns[-1] + terms.hysteresis)


def _without_roughness(theta: Array, numbers: dict[str, Array], fluid: str) -> Array:
    zero = np.zeros((theta.shape[0], 2))
    return _pair(np.hstack([theta, zero]), numbers, fluid)


def _constant(theta: Array, numbers: dict[str, Array], fluid: str) -> Array:
    return np.broadcast_to(theta[:, :1], (theta.shape[0], numbers["speed"].size))


def _by_fluid(theta: Array, numbers: dict[str, Array], fluid: str) -> Array:
    column = {"water": 0, "detergent": 1, "aqueous": 2, "oil": 3, "dry": 4}[fluid]
    return np.broadcast_to(theta[:, column, None], (theta.shape[0], numbers["speed"].size))


def _eq_17(theta: Array, numbers: dict[str, Array], fluid: str) -> Array:
    level, rest, scale = np.exp(theta).T
    drag = numbers["viscosity"] * numbers["speed"]
    return np.log(level[:, None] + rest[:, None] * np.exp(-drag / scale[:, None]))


_L = np.log
_DECADE = 1.15
"""sd of ln x for a number that is known to lie within two decades (95 %)."""
_LEVEL = (_L(0.1), _DECADE)
"""COF under a fluid: from 0.01, a full film, to 1, dry rubber."""
_DRY = (0.0, _DECADE)
"""COF of adhesion: from 0.1, waxed, to 10, clean soft rubber on glass."""
_SCALE = (_L(30e-3), 2 * _DECADE)
"""Viscosity times speed at which a fluid no longer leaves the spots, Pa m: it has the dimension of
a surface energy, and those of rubber, water and minerals are tens of mJ/m2; two decades either
way."""
_CONTACT = (
    ("ln film, aqueous", "ln film, oil", "ln dry", "ln kappa_0, Pa m", "ln surfactant"),
    # a surfactant may halve adhesion or raise it
    (_LEVEL, _LEVEL, _DRY, _SCALE, (0.0, 0.7)),
)
_ROUGHNESS = (0.0, 1.5)
"""None, to the cube of the gap that a film leaves by (Reynolds); its sign is left to readings."""
_HARDNESS = (0.0, 0.5)
"""None, to that of a real contact area that falls as 1 / E; its sign is left to readings."""
_SHAPE = (_ROUGHNESS, _HARDNESS)
_AREA = (0.5, 0.5)
"""From none, friction that knows the load alone, to that of adhesion by the real area."""
LAWS = (
    PairLaw("one constant", ("ln COF",), (_LEVEL,), _constant),
    PairLaw(
        "one constant a family of fluids",
        ("ln COF, water", "detergent", "aqueous", "oil", "dry"),
        (_LEVEL,) * 4 + (_DRY,),
        _by_fluid,
    ),
    PairLaw(
        "Eq. 17 in viscosity x speed",
        ("ln asymptote", "ln fall", "ln scale, Pa m"),
        (_LEVEL, _DRY, _SCALE),
        _eq_17,
        dry=1,
    ),
    PairLaw("pair, without roughness and hardness", *_CONTACT, _without_roughness, dry=2),
    PairLaw(
        "pair, dry area to a power",
        (*_CONTACT[0], "roughness exponent", "hardness exponent", "dry area exponent"),
        (*_CONTACT[1], *_SHAPE, _AREA),
        _dry_power,
        dry=2,
    ),
    PairLaw(
        "pair",
        (*_CONTACT[0], "roughness exponent", "hardness exponent"),
        (*_CONTACT[1], *_SHAPE),
        _pair,
        dry=2,
    ),
)
"""Rivals, the simplest first. Priors: median and sd of each parameter."""


def law_named(name: str) -> PairLaw:
    """Return a law of ``LAWS`` by its name."""
    return next(law for law in LAWS if law.name == name)


class Rows:
    """Conditions with their open numbers drawn once, and the law's prediction of each.

    ``left`` names a laboratory whose treads say nothing of the error of the tread model.
    """

    def __init__(self, conditions: Sequence[PublishedCondition], left: str = "") -> None:
        self.conditions = tuple(conditions)
        shares = qmc.Sobol(len(NUMBERS), rng=0).random(DRAWS)
        members = [(row, m) for row, c in enumerate(conditions) for m in c.members or (c,)]
        self._counts = np.bincount([row for row, _ in members])
        self._blocks: list[tuple[str, NDArray[np.intp], dict[str, Array]]] = []
        for fluid in dict.fromkeys(member.fluid for _, member in members):
            at = [index for index, (_, member) in enumerate(members) if member.fluid == fluid]
            drawn = [sampled_numbers(members[index][1], shares, OPEN) for index in at]
            names = set().union(*drawn) | {"viscosity"}
            numbers = {
                name: np.concatenate(
                    [np.broadcast_to(item.get(name, np.nan), DRAWS) for item in drawn]
                )
                for name in names
            }
            if fluid == "dry":
                numbers["viscosity"] = np.zeros(numbers["viscosity"].shape)
            self._blocks.append((fluid, np.array(at, dtype=np.intp), numbers))
        self.censored = np.array([c.reading.is_censored for c in self.conditions])
        with np.errstate(divide="ignore"):
            self.low = np.log([c.reading.low for c in self.conditions])
            self.high = np.log([c.reading.high for c in self.conditions])
        curves = [c.curve for c in self.conditions]
        self.points = np.array([curves.count(curve) for curve in curves], dtype=float)
        self.error = np.array([c.reading.sd_ln for c in self.conditions])
        sources = [c.source for c in self.conditions]
        self.groups = [
            np.flatnonzero([source == name for source in sources])
            for name in dict.fromkeys(sources)
        ]
        self.pairs = [c.pair for c in self.conditions]
        self.same_pair = [_same(self.pairs, group) for group in self.groups]
        spread = tread_spreads(left)
        self.treads = [_tread(c) for c in self.conditions]
        self.tread = np.array(
            [
                spread[_fluid_class(c)] if tread else 0.0
                for c, tread in zip(conditions, self.treads, strict=True)
            ]
        )
        self.same_tread = [
            _same(self.treads, group) * np.outer(self.tread[group], self.tread[group])
            for group in self.groups
        ]

    def predicted(self, law: PairLaw, theta: Array) -> tuple[Array, Array]:
        """Return ln COF (draws, rows), mean over the open numbers, and its variance over them."""
        cof = np.empty((theta.shape[0], int(self._counts.sum()), DRAWS))
        for fluid, at, numbers in self._blocks:
            ln = law.ln_cof(theta, numbers, fluid)
            cof[:, at] = np.exp(ln).reshape(theta.shape[0], at.size, DRAWS)
        first = np.cumsum(self._counts) - self._counts
        ln = np.log(np.add.reduceat(cof, first, axis=1) / self._counts[:, None])
        return ln.mean(axis=2), ln.var(axis=2)

    def noise(self, spreads: Array, variance: Array) -> Array:
        """Return the variance of ln COF of a reading alone (draws, rows); a curve counts once."""
        return self.points * (self.error**2 + spreads[:, 2:3] ** 2) + variance


def _same(names: Sequence[object], group: NDArray[np.intp]) -> Array:
    return np.array([[float(names[i] == names[j]) for j in group] for i in group])


def _tread(condition: PublishedCondition) -> str:
    """Return the name of the tread whose error a reading has; empty where there is none."""
    if "tread" in condition.labels or condition.labels.get("device") == "whole shoe":
        return f"{condition.source} {condition.labels.get('tread')}"
    return ""


def _fluid_class(condition: PublishedCondition) -> str:
    one = (condition.members or (condition,))[-1]
    return fluid_class(None if one.fluid == "dry" else one.numbers["viscosity"].low)


@cache
def tread_spreads(left: str = "") -> dict[str, float]:
    """Return sd of ln COF of the tread model by class of fluid, from other laboratories' treads."""
    own = {source.name for source in corpus() if source.laboratory == left}
    pairs = [pair for pair in tread_pairs() if pair.source not in own]
    return {
        fluid: learned_deviation([pair for pair in pairs if pair.fluid == fluid], prior)
        for fluid, prior in TREAD_PRIOR.items()
    }


@dataclass(frozen=True, slots=True)
class PairPosterior:
    """Draws of a law's parameters (draws, parameters) and of the spreads (draws, 4).

    ``effective`` is the number of equal draws that those of the sampler are worth.
    """

    law: PairLaw
    theta: Array
    spreads: Array
    effective: float
    left: str = ""

    def draws(self, count: int, seed: int = 0) -> PairDraws:
        """Return draws of the law "pair" as a case uses them: a random choice of the sampler's."""
        generator = np.random.default_rng(seed)
        rows = generator.choice(self.theta.shape[0], count, replace=False)
        columns, spreads = self.theta[rows].T, self.spreads[rows].T
        return PairDraws(_constants(columns), *spreads[[0, 3, 1, 2]])

    def expected(self, conditions: Sequence[PublishedCondition]) -> Array:
        """Return the mean of ln COF (rows,) without errors: equal for equal conditions."""
        return Rows(conditions).predicted(self.law, self.theta)[0].mean(axis=0)

    def predicted(
        self, conditions: Sequence[PublishedCondition], seed: int = 0
    ) -> tuple[Array, Array]:
        """Return ln COF (draws, rows) on unseen testers, one a source, and sd of a reading."""
        rows, generator = Rows(conditions, self.left), np.random.default_rng(seed)
        count = self.theta.shape[0]
        mean = np.empty((count, len(rows.conditions)))
        variance = np.empty_like(mean)
        for group in rows.groups:
            theta = self.theta.copy()
            if self.law.dry is not None:
                theta[:, self.law.dry] += generator.normal(0.0, self.spreads[:, 3])
            ln, spread = rows.predicted(self.law, theta)
            shared = generator.normal(0.0, self.spreads[:, 0])
            mean[:, group], variance[:, group] = ln[:, group] + shared[:, None], spread[:, group]
        pairs = {name: generator.normal(0.0, self.spreads[:, 1]) for name in rows.pairs}
        treads = {name: generator.normal(size=count) for name in rows.treads}
        own = np.stack([pairs[name] for name in rows.pairs], axis=1)
        own += rows.tread * np.stack([treads[name] for name in rows.treads], axis=1)
        noise = np.sqrt(self.spreads[:, 2:3] ** 2 + rows.error**2 + variance)
        return mean + own, noise


def _covariance(spread: Array, weight: Array, same_pair: Array, noise: Array) -> Array:
    """Return the covariance of ln COF of one source, (draws, rows, rows).

    ``spread`` (draws, 4) are standard deviations of laboratory, pair, reading (in ``noise``) and
    dry-like part, which counts by ``weight`` (draws, rows); ``noise`` (draws, rows) is a variance.
    """
    laboratory, pair, _, dry = (spread.T[..., None, None]) ** 2
    shared = laboratory + dry * weight[:, :, None] * weight[:, None, :] + pair * same_pair
    return shared + noise[:, :, None] * np.eye(noise.shape[1])


def log_likelihood(mean: Array, covariance: Array, low: Array, high: Array) -> Array:
    """Return ln p (draws,) of normal values of which some are known within bounds alone.

    Parameters:
        mean: (draws, rows).
        covariance: (draws, rows, rows).
        low, high: Bounds (rows,); equal for a value.
    """
    values, bounds = np.flatnonzero(high <= low), np.flatnonzero(high > low)
    total = np.zeros(mean.shape[0])
    if values.size:
        lower = np.linalg.cholesky(covariance[:, values[:, None], values])
        rest = (low - mean)[:, values, None]
        scaled = np.linalg.solve(lower, rest)[:, :, 0]
        total -= 0.5 * (scaled**2).sum(axis=1) + 0.5 * values.size * _L(2 * np.pi)
        total -= np.log(np.diagonal(lower, axis1=1, axis2=2)).sum(axis=1)
        if bounds.size:
            cross = np.linalg.solve(lower, covariance[:, values[:, None], bounds])
            mean = mean.copy()
            mean[:, bounds] += (cross * scaled[:, :, None]).sum(axis=1)
            inner = covariance[:, bounds[:, None], bounds] - cross.transpose(0, 2, 1) @ cross
        else:
            return total
    else:
        inner = covariance[:, bounds[:, None], bounds]
    centre = mean[:, bounds].copy()
    for i, row in enumerate(bounds):
        sd = np.sqrt(inner[:, i, i])
        a, b = (low[row] - centre[:, i]) / sd, (high[row] - centre[:, i]) / sd
        # from the nearer tail: Phi(b) - Phi(a) loses its digits above the mean
        a, b, sign = np.where(a > 0, -b, a), np.where(a > 0, -a, b), np.where(a > 0, -1.0, 1.0)
        mass = np.maximum(norm.cdf(b) - norm.cdf(a), 1e-300)
        total += np.log(mass)
        at_a, at_b = norm.pdf(a), norm.pdf(b)
        step = (at_a - at_b) / mass
        with np.errstate(invalid="ignore"):  # an end at infinity times a density of 0 is 0
            ends = np.nan_to_num(a * at_a, nan=0.0) - np.nan_to_num(b * at_b, nan=0.0)
        gone = np.clip(step**2 - ends / mass, 0.0, 1.0)
        column = inner[:, i] / sd[:, None]
        centre = centre + (sign * step)[:, None] * column
        inner = inner - gone[:, None, None] * column[:, :, None] * column[:, None, :]
    return total


def fit_law(
    law: PairLaw,
    conditions: Sequence[PublishedCondition],
    *,
    steps: int = 600,
    seed: int = 0,
    left: str = "",
) -> PairPosterior:
    """Return the posterior of a law over conditions; the priors alone where there are none.

    Parameters:
        law: One of ``LAWS`` or of your own.
        conditions: With readings; those of one source share the errors of its tester.
        steps: A fifth of the points of the last round.
        seed: Of the sampler.
        left: Laboratory that is left out, of whose treads nothing is learned either.
    """
    prior = np.array(law.prior)
    count = len(law.parameters)
    generator = np.random.default_rng(seed)
    if not conditions:
        size = DRAWS_KEPT
        theta = prior[:, 0] + prior[:, 1] * generator.normal(size=(size, count))
        spread = np.array(SPREAD_PRIOR) * np.abs(generator.normal(size=(size, 4)))
        spread[:, 0] = SD_SOURCE * np.exp(0.35 * generator.normal(size=size))
        return PairPosterior(law, theta, spread, float(size), left)
    rows = Rows(conditions, left)

    def log_posterior(points: Array) -> Array:
        theta, ln_spread = np.split(points, [count], axis=1)
        outside = (np.abs(ln_spread + 1.5) > 2.5).any(axis=1)
        outside |= (np.abs(theta - prior[:, 0]) > 6 * prior[:, 1]).any(axis=1)
        # the mode is looked for out there too
        value = _log_prior(prior, theta, ln_spread)
        spread = np.exp(np.clip(ln_spread, -4.0, 1.0))
        theta = np.clip(theta, *(prior[:, 0] + end * prior[:, 1] for end in (-6, 6)))
        mean, variance = rows.predicted(law, theta)
        weight = np.zeros_like(mean)
        if law.dry is not None:
            shifted = theta.copy()
            shifted[:, law.dry] += 0.05
            weight = (rows.predicted(law, shifted)[0] - mean) / 0.05
        noise = rows.noise(spread, variance)
        for group, pair, tread in zip(rows.groups, rows.same_pair, rows.same_tread, strict=True):
            covariance = _covariance(spread, weight[:, group], pair, noise[:, group]) + tread
            value += log_likelihood(mean[:, group], covariance, rows.low[group], rows.high[group])
        return np.where(outside, -np.inf, value)

    first = np.append(prior[:, 0], np.log((SD_SOURCE, 0.3, 0.1, 0.4)))
    width = np.append(prior[:, 1], np.full(4, 0.5))
    points, weight = _sample_density(log_posterior, first, width, 5 * steps, generator)
    rows_kept = generator.choice(weight.size, DRAWS_KEPT, p=weight)
    return PairPosterior(
        law,
        points[rows_kept, :count],
        np.exp(points[rows_kept, count:]),
        float(1 / (weight**2).sum()),
        left,
    )


def _log_prior(prior: Array, theta: Array, ln_spread: Array) -> Array:
    """Return the logarithm of the prior density, (n,), of parameters and logarithms of spreads."""
    spread = np.exp(np.clip(ln_spread, -4.0, 1.0))
    value = -0.5 * (((theta - prior[:, 0]) / prior[:, 1]) ** 2).sum(axis=1)
    value -= 0.5 * ((ln_spread[:, 0] - _L(SD_SOURCE)) / 0.35) ** 2
    return value + (ln_spread[:, 1:] - 0.5 * (spread[:, 1:] / SPREAD_PRIOR[1:]) ** 2).sum(axis=1)


def _sample_density(
    log_density: Callable[[Array], Array],
    first: Array,
    width: Array,
    size: int,
    generator: np.random.Generator,
) -> tuple[Array, Array]:
    """Return points (size, dimensions) of a density and their weights, which add up to 1.

    From the mode, which lies near ``first`` on the scale ``width``, a Student t of five degrees
    of freedom takes mean and covariance of the weighted points, round after round, until they are
    worth a twentieth of their number; ``ConvergenceError`` where they never are.
    """
    step = 1e-3 * width

    def slope(x: Array) -> tuple[float, Array]:
        near = x * width + np.concatenate([np.zeros((1, x.size)), np.diag(step), -np.diag(step)])
        value = -np.maximum(log_density(near), -1e12)
        return value[0], (value[1 : x.size + 1] - value[x.size + 1 :]) / 2e-3

    best = minimize(slope, first / width, jac=True, method="BFGS", options={"gtol": 0.05})
    mean, covariance = best.x, 1.3 * np.atleast_2d(best.hess_inv)
    points, weight = np.empty(0), np.empty(0)
    settled = False
    for number in range(ROUNDS):
        # fewer points than this leave the covariance to a handful of them
        count = size if settled else 50 * mean.size
        lower = np.linalg.cholesky(covariance + 1e-6 * np.eye(mean.size))
        normal = generator.normal(size=(count, mean.size))
        tails = np.sqrt(FREEDOM / generator.chisquare(FREEDOM, size=(count, 1)))
        scaled = normal * tails
        points = mean + scaled @ lower.T
        far = (scaled**2).sum(axis=1)
        proposal = -0.5 * (FREEDOM + mean.size) * np.log1p(far / FREEDOM)
        log_weight = log_density(points * width) - proposal
        weight = np.exp(log_weight - log_weight.max())
        weight /= weight.sum()
        # a single point must not narrow the next round
        tempered = np.minimum(weight, 20 / count)
        tempered /= tempered.sum()
        mean = tempered @ points
        covariance = (points - mean).T @ (tempered[:, None] * (points - mean))
        worth = 1 / (weight**2).sum() > count / 20
        if settled and worth:
            break
        settled = settled or worth or number == ROUNDS // 2 - 1
    else:
        raise ConvergenceError(
            f"The {size} points of the posterior are worth {1 / (weight**2).sum():.0f} equal ones, "
            f"fewer than a twentieth of them. More steps give the sampler more points."
        )
    return points * width, weight


def _ridge(x: Array, y: Array, weight: Array, at: Array) -> Array:
    root = np.sqrt(weight)[:, None]
    lower = (root * x).T @ (root * x) / weight.sum() + 0.1 * np.eye(x.shape[1])
    return at @ np.linalg.solve(lower, (weight[:, None] * x).T @ y / weight.sum())


def _line(x: Array, y: Array, weight: Array, at: Array) -> Array:
    return at[:, 0] * (weight * x[:, 0] * y).sum() / (weight * x[:, 0] ** 2).sum()


def _nearest(x: Array, y: Array, weight: Array, at: Array) -> Array:
    apart = ((at[:, None] - x) ** 2).sum(axis=2)
    nearest = np.argsort(apart, axis=1)[:, :3]
    return y[nearest].mean(axis=1)


FEATURE_RIVALS = {
    "line in ln(viscosity x speed)": _line,
    "three nearest neighbours": _nearest,
    "ridge": _ridge,
}
"""Regressions of ln COF on ``features``, scaled, each laboratory counting once; ridge with a
penalty of 0.1 variances."""
AIR = 1.8e-5
"""Viscosity of air (Pa s): the fluid of a dry floor."""


def features(conditions: Sequence[PublishedCondition]) -> Array:
    """Return ln(viscosity x speed), ln Rq of sole and floor, Shore A and whether the fluid is oil.

    At the geometric middle of what is open, (rows, 5); means over members.
    """

    def feature_row(c: PublishedCondition) -> list[float]:
        middle = {name: np.sqrt(s.low * s.high) for name, s in c.numbers.items()}
        drag = (AIR if c.fluid == "dry" else middle["viscosity"]) * middle["speed"]
        rough = [_L(middle[name]) for name in ("sole_rq", "floor_rq")]
        return [_L(drag), *rough, middle["shore_a"], float(c.fluid == "oil")]

    return np.array(
        [np.mean([feature_row(m) for m in c.members or (c,)], axis=0) for c in conditions]
    )


def middle(conditions: Sequence[PublishedCondition]) -> Array:
    """Return ln COF (rows,) of values and of the middle of ranges; nan for a bound of one side."""
    with np.errstate(divide="ignore", invalid="ignore"):
        found = np.log([(c.reading.low, c.reading.high) for c in conditions]).mean(axis=1)
    return np.where(np.isfinite(found), found, np.nan)


def weights(conditions: Sequence[PublishedCondition]) -> Array:
    """Return weights (rows,): each laboratory 1, its printed curves alike, their points alike."""
    curves = [c.curve for c in conditions]
    each = [
        len({c.curve for c in conditions if c.laboratory == condition.laboratory})
        for condition in conditions
    ]
    return np.array([1 / (n * curves.count(c)) for n, c in zip(each, curves, strict=True)])


@dataclass(frozen=True, slots=True)
class DrawScore:
    """How draws of ln COF (draws, rows) meet readings; one number a row.

    ``inside_50`` and ``inside_95`` are 1 or 0 for a value; for bounds the share of the draws
    between them that lies inside (Czado et al. 2009, Biometrics 65:1254): 0.5 and 0.95 in the mean
    where the draws are right, however wide the bounds are.
    """

    log_density: Array
    error: Array
    inside_50: Array
    inside_95: Array
    width: Array


def score_predictions(draws: Array, conditions: Sequence[PublishedCondition]) -> DrawScore:
    """Return the score of predictions; a bound counts by the probability beyond it.

    ``width`` is that of the 95 % interval of ln COF.
    """
    censored = np.array([c.reading.is_censored for c in conditions])
    with np.errstate(divide="ignore"):
        lows = np.log([c.reading.low for c in conditions])
        highs = np.log([c.reading.high for c in conditions])
    mean, sd = draws.mean(axis=0), draws.std(axis=0)
    median = np.median(draws, axis=0)
    density = norm.logpdf(lows, mean, sd)
    mass = norm.cdf(highs, mean, sd) - norm.cdf(lows, mean, sd)
    log_density = np.where(censored, np.log(np.maximum(mass, 1e-9)), density)
    nearest = np.clip(median, lows, highs)
    share = np.stack([(draws < lows).mean(axis=0), (draws <= highs).mean(axis=0)])
    inside = []
    for level in (0.5, 0.95):
        tail = (1 - level) / 2
        within = np.clip(share, tail, 1 - tail)
        known = np.ptp(within, axis=0) / np.maximum(np.ptp(share, axis=0), 1 / len(draws))
        inside.append(np.where(censored, known, np.all(within == share, axis=0)))
    low, high = np.quantile(draws, [0.025, 0.975], axis=0)
    return DrawScore(log_density, nearest - median, inside[0], inside[1], high - low)


@dataclass(frozen=True, slots=True)
class LaboratoryScore:
    """One laboratory predicted from all others: draws of ln COF, and their mean without errors.

    ``after`` is the rest of each source once one of its readings is known: rows of (row that is
    known, row predicted, median, 2.5 %, 97.5 %) of ln COF.
    """

    laboratory: str
    conditions: tuple[PublishedCondition, ...]
    draws: Array
    expected: Array
    after: Array
    score: DrawScore


def laboratory_left_out(
    law: PairLaw | str,
    conditions: Sequence[PublishedCondition],
    laboratory: str,
    *,
    steps: int = 600,
    seed: int = 0,
    data: bool = True,
) -> LaboratoryScore:
    """Return how well a laboratory is predicted by what is fitted to all others.

    Parameters:
        law: A law, or the name of one of ``FEATURE_RIVALS``.
        conditions: Of every laboratory.
        laboratory: The one that is left out.
        steps: Of the sampler.
        seed: Of the sampler and of the draws.
        data: Whether the others are fitted; else the priors alone speak.
    """
    training = [c for c in conditions if c.laboratory != laboratory] if data else []
    left_out = tuple(c for c in conditions if c.laboratory == laboratory)
    after = np.empty((0, 5))
    if isinstance(law, str):
        draws, expected = _regression(law, training, left_out, seed)
    else:
        posterior = fit_law(law, training, steps=steps, seed=seed, left=laboratory)
        latent, noise = posterior.predicted(left_out, seed)
        generator = np.random.default_rng(seed)
        draws = latent + noise * generator.normal(size=latent.shape)
        expected, after = posterior.expected(left_out), one_reading(left_out, latent, noise)
    return LaboratoryScore(
        laboratory, left_out, draws, expected, after, score_predictions(draws, left_out)
    )


def _regression(
    name: str,
    training: Sequence[PublishedCondition],
    left_out: Sequence[PublishedCondition],
    seed: int,
) -> tuple[Array, Array]:
    """Return draws (draws, rows) and means of ln COF by a regression on features.

    The error is that of leaving out each of the other laboratories in turn, means over them.
    """
    training = [c for c, y in zip(training, middle(training), strict=True) if np.isfinite(y)]
    x, y, weight = features(training), middle(training), weights(training)
    centre, scale = x.mean(axis=0), x.std(axis=0)

    def predicted(train: NDArray[np.bool_], at: Array) -> Array:
        level = np.average(y[train], weights=weight[train])
        rest = FEATURE_RIVALS[name](
            (x[train] - centre) / scale, y[train] - level, weight[train], (at - centre) / scale
        )
        return level + rest

    names = np.array([c.laboratory for c in training])
    rest = np.empty_like(y)
    for laboratory in dict.fromkeys(names):
        left = names == laboratory
        rest[left] = y[left] - predicted(~left, x[left])
    sd = np.sqrt(np.average(rest**2, weights=weight))
    mean = predicted(np.ones(y.size, dtype=bool), features(left_out))
    noise = np.random.default_rng(seed).normal(size=(2000, len(left_out)))
    return mean + sd * noise, mean


def one_reading(conditions: Sequence[PublishedCondition], latent: Array, noise: Array) -> Array:
    """Return the rest of each source given one of its values, each in turn, (rows, 5).

    Columns: row that is known, row predicted, median and 95 % interval of ln COF. Points of one
    curve are not predicted from one another.
    """
    predicted = []
    measured, generator = middle(conditions), np.random.default_rng(0)
    values = [i for i, c in enumerate(conditions) if not c.reading.is_censored]
    for i in values:
        rest = [
            j
            for j in values
            if conditions[j].source == conditions[i].source
            and conditions[j].curve != conditions[i].curve
        ]
        if not rest:
            continue
        log_weight = norm.logpdf(measured[i], latent[:, i], noise[:, i])
        weight = np.exp(log_weight - log_weight.max())
        rows = generator.choice(weight.size, 4000, p=weight / weight.sum())
        for j in rest:
            draws = latent[rows, j] + noise[rows, j] * generator.normal(size=rows.size)
            predicted.append((i, j, *np.quantile(draws, (0.5, 0.025, 0.975))))
    return np.array(predicted).reshape(-1, 5)


@dataclass(frozen=True, slots=True)
class CorpusScore:
    """How a law predicts laboratories it was not fitted to; each counts once (``weights``).

    ``log_density``: sum over laboratories of the mean over their curves. ``r2`` of ln COF over
    values and the middles of ranges (bounds left out). ``rms_error``, ``bias``: of ln COF.
    ``inside_50``, ``inside_95``: shares of the readings, of bounds in part. ``width``: mean of the
    95 % interval of ln COF. ``rank_correlation``: Spearman's within laboratories of four and more
    values, mean; equal predictions are ties, all of them equal count 0; nan where there is no such
    laboratory.
    """

    law: str
    log_density: float
    r2: float
    rms_error: float
    bias: float
    inside_50: float
    inside_95: float
    width: float
    rank_correlation: float


def corpus_score(law: str, left_out: Sequence[LaboratoryScore]) -> CorpusScore:
    """Return the summary over the laboratories left out in turn."""
    conditions = [c for score in left_out for c in score.conditions]
    weight = weights(conditions)
    log_density, error, inside_50, inside_95, width = (
        np.concatenate([getattr(score.score, name) for score in left_out])
        for name in ("log_density", "error", "inside_50", "inside_95", "width")
    )
    median = np.concatenate([np.median(score.draws, axis=0) for score in left_out])
    ranks = []
    for score in left_out:
        rows = np.flatnonzero([not c.reading.is_censored for c in score.conditions])
        if rows.size >= 4:
            values = [score.conditions[row].reading.low for row in rows]
            expected = score.expected[rows].round(6)
            # equal predictions order nothing
            ranks.append(spearmanr(values, expected)[0] if np.ptp(expected) > 0 else 0.0)
    return CorpusScore(
        law=law,
        log_density=float(weight @ log_density),
        r2=r2(middle(conditions), median, weight),
        rms_error=float(np.sqrt(np.average(error**2, weights=weight))),
        bias=float(np.average(error, weights=weight)),
        inside_50=float(np.average(inside_50, weights=weight)),
        inside_95=float(np.average(inside_95, weights=weight)),
        width=float(np.average(width, weights=weight)),
        rank_correlation=float(np.mean(ranks)) if ranks else float("nan"),
    )


def r2(measured: Array, predicted: Array, weight: Array) -> float:
    """Return the share of the weighted variance of measured values that is predicted.

    Values that are nan are left out; below 0 the mean of the measured ones is better.
    """
    known = np.isfinite(measured)
    y, rest, weight = measured[known], (measured - predicted)[known], weight[known]
    variance = np.average((y - np.average(y, weights=weight)) ** 2, weights=weight)
    return float(1 - np.average(rest**2, weights=weight) / variance)


def write_draws(path: Path, *, seed: int = 0) -> None:
    """Write draws of the law "pair" fitted to every reading, as a case takes them."""
    conditions = [c for source in corpus() if source.verified for c in source.conditions]
    fit_law(law_named("pair"), conditions, steps=3000, seed=seed).draws(1000, seed).write(path)


if __name__ == "__main__":
    write_draws(Path(sys.argv[1]))
