"""The contact law of a pair and its rivals, fitted to the corpus with the errors between sources.

    ln COF = ln law(theta) + u_source + w d_source + v_pair + e

u is a laboratory's error on everything, d its error on the dry-like part (w is that part's share
of the friction), v the pair's, e that of the reading and of what the source leaves open. Bounds and
ranges enter as latent values. Sampling by emcee (Foreman-Mackey et al. 2013).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.stats import norm, qmc, spearmanr

from underfoot.core.arrays import Array
from underfoot.core.optional import optional_module
from underfoot.fluid import BLOCKING
from underfoot.friction.pair_contact import (
    CONTACT_PRESSURE,
    LOSS_TANGENTS,
    Family,
    PairConstants,
    PairDraws,
    contact_terms,
)

from .sources import NUMBERS, Condition, Span, sampled_numbers

DRAWS = 8
"""Points over the open ranges of a condition."""
SD_SOURCE = 0.33
"""Between laboratories, sd of ln COF: reproducibility limits of 70 and 100 % of one shoe on eight
machines, over 2.8 (Jung and Fischer 1993, Safety Science 16:115): 0.25 and 0.36."""
SPREAD_PRIOR = (SD_SOURCE, 0.4, 0.2, 0.7)
"""Of a source, a pair, a reading and the dry part of a source; the first log-normal with sd 0.35 of
its logarithm, the others half-normal."""
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


def _without_roughness(theta: Array, numbers: dict[str, Array], fluid: str) -> Array:
    zero = np.zeros((theta.shape[0], 2))
    return _pair(np.hstack([theta, zero]), numbers, fluid)


def _constant(theta: Array, numbers: dict[str, Array], fluid: str) -> Array:
    return np.broadcast_to(theta[:, :1], (theta.shape[0], numbers["speed"].size))


def _by_fluid(theta: Array, numbers: dict[str, Array], fluid: str) -> Array:
    column = {"dry": 0, "water": 0, "detergent": 1, "aqueous": 2, "oil": 3}[fluid]
    return np.broadcast_to(theta[:, column, None], (theta.shape[0], numbers["speed"].size))


def _eq_26(theta: Array, numbers: dict[str, Array], fluid: str) -> Array:
    tested = {"water": "water", "dry": "water", "detergent": "detergent 1.5 %", "oil": "canola oil"}
    if fluid == "aqueous":
        names = ("glycerol 25 %", "glycerol 50 %", "glycerol 75 %")
        at = np.log(np.clip(numbers["viscosity"], 1.9e-3, 41e-3))
        known = np.log([1.9e-3, 5.54e-3, 41e-3])
        alpha = np.interp(at, known, [BLOCKING[name].alpha for name in names])
        beta = np.interp(at, known, [BLOCKING[name].beta for name in names])
    else:
        alpha, beta = (np.array(getattr(BLOCKING[tested[fluid]], n)) for n in ("alpha", "beta"))
    dry, hysteresis = np.exp(theta).T
    size = numbers["speed"].size
    fluid_part = np.broadcast_to(alpha / 20.9, size)
    dry_part = np.outer(dry, np.broadcast_to(beta, size))
    return np.log(fluid_part + dry_part + hysteresis[:, None])


def _eq_17(theta: Array, numbers: dict[str, Array], fluid: str) -> Array:
    level, rest, scale = np.exp(theta).T
    drag = numbers["viscosity"] * numbers["speed"]
    return np.log(level[:, None] + rest[:, None] * np.exp(-drag / scale[:, None]))


_L = np.log
_CONTACT = (
    ("ln film, aqueous", "ln film, oil", "ln dry", "ln kappa_0, Pa m", "ln surfactant"),
    ((_L(0.10), 0.5), (_L(0.08), 0.5), (_L(0.4), 0.5), (_L(1.08e-3), 0.5), (0.0, 0.3)),
)
LAWS = (
    PairLaw("one constant", ("ln COF",), ((_L(0.25), 1.0),), _constant),
    PairLaw(
        "one constant a family of fluids",
        ("ln COF, water", "detergent", "aqueous", "oil"),
        ((_L(0.3), 1.0),) * 4,
        _by_fluid,
    ),
    PairLaw(
        "Eq. 26", ("ln dry adhesion", "ln hysteresis"), ((_L(0.5), 0.4), (_L(0.05), 0.5)), _eq_26
    ),
    PairLaw(
        "Eq. 17 in viscosity x speed",
        ("ln asymptote", "ln fall", "ln scale, Pa m"),
        ((_L(0.12), 0.7), (_L(0.5), 0.7), (_L(1.08e-3), 0.7)),
        _eq_17,
        dry=1,
    ),
    PairLaw("pair, without roughness and hardness", *_CONTACT, _without_roughness, dry=2),
    PairLaw(
        "pair",
        (*_CONTACT[0], "roughness exponent", "hardness exponent"),
        (*_CONTACT[1], (1.5, 0.8), (0.15, 0.10)),
        _pair,
        dry=2,
    ),
)
"""Rivals, the simplest first. Priors: median and sd of each parameter."""


def law_named(name: str) -> PairLaw:
    """Return a law of ``LAWS`` by its name."""
    return next(law for law in LAWS if law.name == name)


class Rows:
    """Conditions with their open numbers drawn once, and the law's prediction of each."""

    def __init__(self, conditions: Sequence[Condition]) -> None:
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
        self.error = np.array([c.reading.sd_ln for c in self.conditions])
        sources = [c.source for c in self.conditions]
        self.groups = [
            np.flatnonzero([s == source for s in sources]) for source in dict.fromkeys(sources)
        ]
        pairs = [c.pair for c in self.conditions]
        self.same_pair = [
            np.array([[pairs[i] == pairs[j] for j in g] for i in g]) for g in self.groups
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


@dataclass(frozen=True, slots=True)
class PairPosterior:
    """Draws of a law's parameters (draws, parameters) and of the spreads (draws, 4)."""

    law: PairLaw
    theta: Array
    spreads: Array
    acceptance: float

    def draws(self, count: int, seed: int = 0) -> PairDraws:
        """Return draws of the law "pair" as a case uses them: a random choice of the sampler's."""
        generator = np.random.default_rng(seed)
        rows = generator.choice(self.theta.shape[0], count, replace=False)
        columns, spreads = self.theta[rows].T, self.spreads[rows].T
        return PairDraws(_constants(columns), *spreads[[0, 3, 1, 2]])

    def expected(self, conditions: Sequence[Condition]) -> Array:
        """Return the mean of ln COF (rows,) without errors: equal for equal conditions."""
        return Rows(conditions).predicted(self.law, self.theta)[0].mean(axis=0)

    def predicted(self, conditions: Sequence[Condition], seed: int = 0) -> Array:
        """Return draws of ln COF (draws, rows) as one unseen source would read the conditions."""
        rows, generator = Rows(conditions), np.random.default_rng(seed)
        count, theta = self.theta.shape[0], self.theta.copy()
        if self.law.dry is not None:
            theta[:, self.law.dry] += generator.normal(0.0, self.spreads[:, 3])
        mean, variance = rows.predicted(self.law, theta)
        pairs = {c.pair: generator.normal(0.0, self.spreads[:, 1]) for c in conditions}
        shared = generator.normal(0.0, self.spreads[:, 0])
        noise = np.sqrt(self.spreads[:, 2:3] ** 2 + rows.error**2 + variance)
        own = np.stack([pairs[c.pair] for c in conditions], axis=1)
        readings = noise * generator.normal(size=(count, len(conditions)))
        return mean + shared[:, None] + own + readings


def _covariance(spread: Array, weight: Array, same_pair: Array, noise: Array) -> Array:
    """Return the covariance of ln COF of one source, (draws, rows, rows).

    ``spread`` (draws, 4) are standard deviations of laboratory, pair, reading (in ``noise``) and
    dry-like part, which counts by ``weight`` (draws, rows); ``noise`` (draws, rows) is a variance.
    """
    laboratory, pair, _, dry = (spread.T[..., None, None]) ** 2
    shared = laboratory + dry * weight[:, :, None] * weight[:, None, :] + pair * same_pair
    return shared + noise[:, :, None] * np.eye(noise.shape[1])


def fitted(
    law: PairLaw, conditions: Sequence[Condition], *, steps: int = 1500, seed: int = 0
) -> PairPosterior:
    """Return the posterior of a law over conditions.

    Parameters:
        law: One of ``LAWS`` or of your own.
        conditions: With readings; those of one source share its errors.
        steps: Of each of the walkers; the first third is dropped.
        seed: Of the sampler.
    """
    rows = Rows(conditions)
    prior = np.array(law.prior)
    count = len(law.parameters)
    latent = np.flatnonzero(rows.censored)
    dimensions = count + 4 + latent.size
    generator = np.random.default_rng(seed)

    def log_posterior(points: Array) -> Array:
        theta, ln_spread, hidden = np.split(points, [count, count + 4], axis=1)
        value = -0.5 * (((theta - prior[:, 0]) / prior[:, 1]) ** 2).sum(axis=1)
        spread = np.exp(ln_spread)
        value -= 0.5 * ((ln_spread[:, 0] - _L(SD_SOURCE)) / 0.35) ** 2
        value += (ln_spread[:, 1:] - 0.5 * (spread[:, 1:] / SPREAD_PRIOR[1:]) ** 2).sum(axis=1)
        outside = (ln_spread < -4).any(axis=1)
        outside |= ((hidden < rows.low[latent]) | (hidden > rows.high[latent])).any(axis=1)
        outside |= (np.abs(hidden) > 12).any(axis=1)
        mean, variance = rows.predicted(law, theta)
        weight = np.zeros_like(mean)
        if law.dry is not None:
            shifted = theta.copy()
            shifted[:, law.dry] += 0.05
            weight = (rows.predicted(law, shifted)[0] - mean) / 0.05
        observed = np.broadcast_to(rows.low, mean.shape).copy()
        observed[:, latent] = hidden
        noise = rows.error**2 + variance + spread[:, 2:3] ** 2
        for group, same in zip(rows.groups, rows.same_pair, strict=True):
            lower = np.linalg.cholesky(_covariance(spread, weight[:, group], same, noise[:, group]))
            rest = (observed - mean)[:, group]
            scaled = np.linalg.solve(lower, rest[:, :, None])[:, :, 0]
            value -= 0.5 * (scaled**2).sum(axis=1)
            value -= np.log(np.diagonal(lower, axis1=1, axis2=2)).sum(axis=1)
        return np.where(outside, -np.inf, value)

    walkers = 4 * dimensions
    start = np.empty((walkers, dimensions))
    start[:, :count] = prior[:, 0] + 0.3 * prior[:, 1] * generator.normal(size=(walkers, count))
    start[:, count : count + 4] = np.log((0.33, 0.2, 0.1, 0.3)) + 0.1 * generator.normal(
        size=(walkers, 4)
    )
    inside = np.where(np.isfinite(rows.high), rows.high - 0.2, rows.low + 0.2)[latent]
    inside = np.where(
        np.isfinite(rows.low[latent]), np.minimum(inside, rows.low[latent] + 0.2), inside
    )
    start[:, count + 4 :] = inside + 0.02 * generator.random((walkers, latent.size))
    emcee = optional_module("emcee", "study", "fitting the law of a pair")
    sampler = emcee.EnsembleSampler(walkers, dimensions, log_posterior, vectorize=True)
    sampler.random_state = np.random.RandomState(seed).get_state()
    sampler.run_mcmc(start, steps)
    chain: Any = sampler.get_chain(discard=steps // 3, thin=max(1, steps // 60), flat=True)
    return PairPosterior(
        law,
        chain[:, :count],
        np.exp(chain[:, count : count + 4]),
        float(np.mean(sampler.acceptance_fraction)),
    )


@dataclass(frozen=True, slots=True)
class Score:
    """How draws of ln COF (draws, rows) meet readings; one number or flag a row."""

    log_density: Array
    error: Array
    inside_50: Array
    inside_95: Array


def scored(draws: Array, conditions: Sequence[Condition]) -> Score:
    """Return the score of predictions; a bound counts by the probability beyond it."""
    rows = Rows(conditions)
    mean, sd = draws.mean(axis=0), draws.std(axis=0)
    median = np.median(draws, axis=0)
    density = norm.logpdf(rows.low, mean, sd)
    mass = norm.cdf(rows.high, mean, sd) - norm.cdf(rows.low, mean, sd)
    log_density = np.where(rows.censored, np.log(np.maximum(mass, 1e-9)), density)
    nearest = np.clip(median, rows.low, rows.high)
    flags = []
    for level in (0.5, 0.95):
        low, high = np.quantile(draws, [(1 - level) / 2, (1 + level) / 2], axis=0)
        flags.append((low <= rows.high) & (high >= rows.low))
    return Score(log_density, nearest - median, *flags)


@dataclass(frozen=True, slots=True)
class SourceScore:
    """One source predicted from all others: draws of ln COF, and their mean without errors."""

    source: str
    conditions: tuple[Condition, ...]
    draws: Array
    expected: Array
    score: Score


def source_left_out(
    law: PairLaw, conditions: Sequence[Condition], source: str, *, steps: int = 600, seed: int = 0
) -> SourceScore:
    """Return how well a source is predicted by the law fitted to all others."""
    kept = [c for c in conditions if c.source != source]
    left = tuple(c for c in conditions if c.source == source)
    posterior = fitted(law, kept, steps=steps, seed=seed)
    draws = posterior.predicted(left, seed)
    return SourceScore(source, left, draws, posterior.expected(left), scored(draws, left))


@dataclass(frozen=True, slots=True)
class CorpusScore:
    """How a law predicts sources it was not fitted to.

    ``log_density``: sum over sources of the mean over their rows. ``r2`` of ln COF over values
    (bounds left out). ``rms_error``, ``bias``: of ln COF, means over sources. ``inside_50``,
    ``inside_95``: shares of the rows, means over sources. ``rank_correlation``: Spearman's within
    sources of four and more values, mean; equal predictions are ties, all of them equal count 0;
    nan where there is no such source.
    """

    law: str
    log_density: float
    r2: float
    rms_error: float
    bias: float
    inside_50: float
    inside_95: float
    rank_correlation: float


def corpus_score(law: str, sources: Sequence[SourceScore]) -> CorpusScore:
    """Return the summary over the sources left out in turn."""
    readings = [
        (np.log(c.reading.low), median)
        for one in sources
        for c, median in zip(one.conditions, np.median(one.draws, axis=0), strict=True)
        if not c.reading.is_censored
    ]
    measured, predicted = np.array(readings).T
    rest = ((measured - predicted) ** 2).sum() / ((measured - measured.mean()) ** 2).sum()
    ranks = []
    for one in sources:
        rows = np.flatnonzero([not c.reading.is_censored for c in one.conditions])
        if rows.size >= 4:
            values = [one.conditions[row].reading.low for row in rows]
            expected = one.expected[rows].round(6)
            # equal predictions order nothing
            ranks.append(spearmanr(values, expected)[0] if np.ptp(expected) > 0 else 0.0)
    each = [one.score for one in sources]
    return CorpusScore(
        law=law,
        log_density=float(sum(s.log_density.mean() for s in each)),
        r2=float(1 - rest),
        rms_error=float(np.sqrt(np.mean([np.mean(s.error**2) for s in each]))),
        bias=float(np.mean([s.error.mean() for s in each])),
        inside_50=float(np.mean([s.inside_50.mean() for s in each])),
        inside_95=float(np.mean([s.inside_95.mean() for s in each])),
        rank_correlation=float(np.mean(ranks)) if ranks else float("nan"),
    )
