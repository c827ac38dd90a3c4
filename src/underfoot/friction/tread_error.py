"""Error of the tread model: what a computed COF misses of a tread, in draws that treads share.

    ln COF = ln COF computed + s z(x),   cov z(x), z(x') = k(x - x') - k(x) k(x'),
    k(d) = exp(-d^2 / 2)

x is the place of a tread among treads (``underfoot.shoe.tread_place``): equal treads miss by the
same, like ones by nearly the same, and a sole without tread (x = 0) has no tread to miss. z is
drawn as a sum of waves whose coefficients depend on seed and name alone, so that whatever is
compared takes one field. s is learned from published pairs of treads: ``tread_pairs.csv`` holds
their ln ratio and the computed one (``underfoot.studies.tread_pairs`` writes it).
"""

import csv
import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache, lru_cache
from importlib import resources

import numpy as np
from scipy.special import ndtr

from underfoot.core.arrays import Array

WAVES = 64
"""Of the field; its correlation is k within 0.1."""
THIN = 2e-3
"""Pa s below which a fluid counts as thin as water: its films are thinner than the roughness."""
PRIOR = {"thin": 0.5, "thick": 0.5, "dry": 0.15}
"""Scale of the half-normal prior of s, by class of fluid (assumed): the ratio of two unlike treads
may be off by a factor of two under a film, of 1.2 without one."""
READING = 0.10
"""Standard deviation of ln COF of one reading where none is given: repeats of one tester."""


@dataclass(frozen=True, slots=True)
class TreadPair:
    """Two treads whose order or ln ratio of COF was published, and what is computed of them.

    ``low`` and ``high`` bound the published ln ratio (equal: a value; infinite: the order alone);
    ``sd`` is what the computed one spreads by for other reasons; ``first`` and ``second`` are the
    places of the treads, the highest and the lowest of ``extremes_of``.
    """

    source: str
    effect: str
    fluid: str
    low: float
    high: float
    computed: float
    sd: float
    first: Array
    second: Array
    extremes_of: int = 2


def fluid_class(viscosity: float | None) -> str:
    """Return which error a fluid takes part in: "dry", "thin" or "thick" (viscosity in Pa s)."""
    if viscosity is None:
        return "dry"
    return "thin" if viscosity < THIN else "thick"


def likeness(first: Array, second: Array | float) -> Array:
    """Return the correlation k of fields at places (..., 6)."""
    return np.mean(np.cos((np.asarray(first) - second) @ _waves().T), axis=-1)


def variance_between(first: Array, second: Array) -> float:
    """Return the variance of z(first) - z(second): 0 for equal treads, 2 for unlike ones."""
    apart, one, other = (likeness(a, b) for a, b in ((first, second), (first, 0), (second, 0)))
    return float(max(2 - 2 * apart - (one - other) ** 2, 0.0))


@dataclass(frozen=True, slots=True)
class SharedError:
    """A normal error that soles share as far as their treads are alike.

    ``subject`` names what is off, ``deviation`` by how much; ``of_tread`` leaves a sole without
    tread without error.
    """

    subject: str
    deviation: float
    of_tread: bool = False

    def name(self, place: Array) -> str:
        """Return the name of the error at a place, as files of draws keep it."""
        return f"{self.subject}: " + " ".join(f"{x:.4f}" for x in place)

    def draws(
        self, place: Array, *, samples: int, seed: int, known: Mapping[str, Array] | None = None
    ) -> Array:
        """Return (samples,) draws at a place; one seed gives one field.

        ``known`` holds errors (samples,) that readings determined, by ``name``; Matheron's rule
        carries them on: z = f(x) + k(x, X) K^-1 (z_X - f(X)), f the field without them.
        """
        origin, head = np.zeros(len(place)), f"{self.subject}:"
        if self.of_tread and not np.any(place):
            return np.zeros(samples)
        places, values = ([origin], [np.zeros(samples)]) if self.of_tread else ([], [])
        for name, errors in (known or {}).items():
            if name.startswith(head):
                places.append(np.array(name.removeprefix(head).split(), dtype=float))
                values.append(errors / self.deviation)
        every = np.array([place, *places])
        phase = every @ _waves().T
        waves = np.concatenate([np.cos(phase), np.sin(phase)], axis=1) / np.sqrt(WAVES)
        field = waves @ _coefficients(self.subject, samples, seed)
        found = field[0]
        if places:
            like = waves @ waves.T
            among = like[1:, 1:] + 1e-9 * np.eye(len(places))
            found = found + np.linalg.solve(among, like[1:, 0]) @ (np.array(values) - field[1:])
        return self.deviation * found


def tread_error(viscosity: float | None) -> SharedError:
    """Return the error of ln COF of a tread under a fluid (Pa s; None: dry)."""
    fluid = fluid_class(viscosity)
    return SharedError(f"tread, {fluid}", tread_deviation(fluid), of_tread=True)


@cache
def tread_deviation(fluid: str) -> float:
    """Return s of a class of fluids, from the published pairs."""
    pairs = [pair for pair in tread_pairs() if pair.fluid == fluid]
    return learned_deviation(pairs, PRIOR[fluid])


@cache
def tread_pairs() -> tuple[TreadPair, ...]:
    """Return the published pairs of treads and what is computed of them."""
    path = resources.files("underfoot") / "data" / "friction" / "tread_pairs.csv"
    rows = csv.DictReader(path.read_text(encoding="utf-8").splitlines())
    return tuple(
        TreadPair(
            row["source"],
            row["effect"],
            row["fluid"],
            float(row["low"]),
            float(row["high"]),
            float(row["computed"]),
            float(row["sd"]),
            np.array(row["first"].split(), dtype=float),
            np.array(row["second"].split(), dtype=float),
            int(row["extremes_of"]),
        )
        for row in rows
    )


def learned_deviation(pairs: Sequence[TreadPair], prior: float) -> float:
    """Return the root mean square of s over its posterior, on a grid."""
    s, log_density = log_posterior(pairs, prior)
    density = np.exp(log_density - log_density.max())
    return float(np.sqrt(np.average(s**2, weights=density)))


def log_posterior(pairs: Sequence[TreadPair], prior: float) -> tuple[Array, Array]:
    """Return s on a grid and ln of prior times likelihood there.

    An order counts by its probability, bounds by that between them, a value by its density (of the
    highest and the lowest of n by that of the range of n), with the error of two readings; a source
    counts once, however many effects it prints.
    """
    s = np.linspace(0.005, 4, 400) * prior
    log_density = -0.5 * (s / prior) ** 2
    for pair in pairs:
        apart = variance_between(pair.first, pair.second)
        spread = np.sqrt(s**2 * apart + pair.sd**2 + 2 * READING**2)
        low, high = ((end - pair.computed) / spread for end in (pair.low, pair.high))
        if pair.low == pair.high:
            found = np.log(range_density(2**0.5 * np.abs(low), pair.extremes_of) / spread)
        else:
            found = np.log(np.maximum(ndtr(high) - ndtr(low), 1e-12))
        log_density += found / sum(other.source == pair.source for other in pairs)
    return s, log_density


def range_density(width: Array, count: int) -> Array:
    """Return the density of the range of ``count`` standard normal values at ``width`` (n,).

    n (n - 1) integral of phi(x) phi(x + w) (Phi(x + w) - Phi(x))^(n - 2) over x.
    """
    x = np.linspace(-8, 8, 161)
    above = x + np.asarray(width)[:, None]
    normal = np.exp(-0.5 * (x**2 + above**2)) / (2 * np.pi)
    inner = normal * (ndtr(above) - ndtr(x)) ** (count - 2)
    return count * (count - 1) * np.maximum(np.trapezoid(inner, x, axis=1), 1e-300)


@cache
def _waves() -> Array:
    return np.random.default_rng(0).standard_normal((WAVES, 6))


@lru_cache(maxsize=16)
def _coefficients(name: str, samples: int, seed: int) -> Array:
    """Return (2 WAVES, samples) normal draws, of mean 0 and covariance 1 where samples allow."""
    generator = np.random.default_rng([seed, zlib.crc32(name.encode())])
    drawn = generator.standard_normal((samples, 2 * WAVES))
    if samples > 4 * WAVES:
        drawn -= drawn.mean(axis=0)
        drawn = np.linalg.qr(drawn)[0] * np.sqrt(samples)
    return drawn.T
