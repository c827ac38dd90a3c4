"""Joint draws of contact friction: what soles, floors and machines share, and what readings say.

Every draw is one state of the world: constants of the law, the error of each laboratory, the
roughness of each floor and sole. A reading keeps draws by how well they foresee it, so that what it
says of a floor counts for every shoe on it, and of a sole on every floor. Readings are learned one
after the other; what no reading has touched is drawn when it is asked for, independently of what
was learned (sequential importance resampling).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import log_ndtr, ndtri

from underfoot.core import InputError, unknown_name
from underfoot.core.arrays import Array
from underfoot.core.remark import Message
from underfoot.friction import PairDraws, packaged_pair_draws
from underfoot.friction.pair_contact import (
    DRY_PART,
    LABORATORY,
    TERMS,
    ContactTerms,
    Pair,
    PairConstants,
    even_rows,
)
from underfoot.friction.propagation import named_shares
from underfoot.friction.tread_error import READING, SharedError

DRAWS = 8000
FEWEST = 50
"""Effective draws below which a reading contradicts the law or the readings before it."""
KINDS = ("value", "lower", "upper")
FLOOR_LIKENESS = 0.64
"""Correlation of what two rubbers find on one wet floor beyond its roughness (ln COF): as machines
teach that read the same floors (``evidence.floor_likeness``)."""
LIKE_FAMILIES = ("aqueous", "detergent")
"""Fluids of those readings."""
KEPT_AS = "share of "


def floor_name(pair: Pair) -> str:
    """Return the name of the share of the floor's roughness in ``Pair.draw_inputs``."""
    return f"floor_rq {pair.floor_rq[0]:.3g} {pair.floor_rq[1]:.3g}"


@dataclass(frozen=True, slots=True)
class CofReading:
    """COF that was read, or a bound of it; ``sd`` of repeats, where known."""

    cof: float
    kind: str = "value"
    sd: float | None = None

    def __post_init__(self) -> None:
        check_kind(self.kind, "reading.kind")
        if not 0 < self.cof < 5:
            raise InputError(f"{self.cof:g}", where="reading", allowed="a COF above 0, below 5")
        if self.sd is not None and not 0 < self.sd < 5:
            raise InputError(f"{self.sd:g}", where="reading.sd", allowed="above 0, below 5")


def check_kind(kind: str, where: str) -> None:
    """Raise an error for a kind of reading that there is not, and name its place."""
    if kind not in KINDS:
        raise unknown_name("kind", kind, KINDS, where=where)


class PlaceDraws:
    """Draws of everything, each (count,), by the name of what it belongs to.

    ``constants`` are those of the law; ``fewest`` is the least number of equal draws that a reading
    left of them.
    """

    def __init__(self, count: int = DRAWS, seed: int = 0, start: PairDraws | None = None) -> None:
        begin = packaged_pair_draws() if start is None else start
        self.count, self.seed = count, seed
        rows = np.arange(count) % begin.count
        self.constants = begin.rows(rows)
        self.fewest = float(count)
        self._shares: dict[str, Array] = {}
        self._errors = {name: values[rows] for name, values in begin.errors.items()}

    def values_of(self, *heads: str) -> dict[str, Array]:
        """Return the shares of what begins with one of ``heads``, by the name kept for them."""
        return {
            f"{KEPT_AS}{name}": share
            for name, share in self._shares.items()
            if name.startswith(heads)
        }

    def begin(self, name: str, share: Array) -> None:
        """Set the draws of ``share`` under a name: what readings before determined."""
        self._shares[name] = share

    def errors(self) -> dict[str, Array]:
        """Return the errors that are known, by name."""
        return dict(self._errors)

    def share(self, name: str) -> Array:
        """Return draws between 0 and 1; the same name gives the same."""
        if name not in self._shares:
            self._shares[name] = named_shares(self.seed, name, self.count)
        return self._shares[name]

    def normal(self, name: str) -> Array:
        """Return standard normal draws; the same name gives the same."""
        return ndtri(self.share(name))

    def beyond_roughness(self, floor: str, name: str, family: str = LIKE_FAMILIES[0]) -> Array:
        """Return standard normal draws (count,) of what a contact finds of a floor, its roughness
        known; contacts of several names on one floor are alike by ``FLOOR_LIKENESS``.
        """
        own = self.normal(name)
        if family not in LIKE_FAMILIES:
            return own
        shared = self.normal(f"floor {floor} beyond its roughness")
        return np.sqrt(FLOOR_LIKENESS) * shared + np.sqrt(1 - FLOOR_LIKENESS) * own

    def drawn_between(self, name: str, ends: tuple[float, float]) -> Array:
        """Return draws between two ends, even in the logarithm."""
        low, high = ends
        return low * (high / low) ** self.share(name)

    def error(self, error: SharedError, place: Array) -> Array:
        """Return draws of an error that soles share as far as their treads at a place are alike."""
        name = error.name(place)
        if name not in self._errors:
            self._errors[name] = error.draws(
                place, samples=self.count, seed=self.seed, known=self._errors
            )
        return self._errors[name]

    def contact_cof(
        self,
        pair: Pair,
        *,
        laboratory: str,
        floor: str,
        sole: str,
        pressure: ArrayLike,
        drag: ArrayLike | None,
        middle: bool = False,
    ) -> Array:
        """Return COF (count,) of a contact by the law of the pair.

        Parameters:
            pair: What is known of sole, floor and fluid.
            laboratory, floor, sole: Names; what has one name has one error or roughness.
            pressure: Pa, above 0.
            drag: Viscosity times speed, N/m; None on a dry floor.
            middle: At the median of the law's constants and without its errors.
        """
        base, scale = self.constants, float(not middle)
        if middle:
            columns = base.constants, PairConstants.__dataclass_fields__
            medians = (np.median(getattr(columns[0], name)) for name in columns[1])
            middle_of = PairConstants(*(np.full(self.count, value) for value in medians))
            base = replace(base, constants=middle_of)
        errors = {
            DRY_PART: scale * base.sd_dry_part * self.normal(f"dry part: {laboratory}"),
            LABORATORY: scale * base.sd_laboratory * self.normal(f"laboratory: {laboratory}"),
            pair.compound_and_floor: scale * base.sd_pair * self.pair_error(pair, sole, floor),
            floor_name(pair): self.share(f"roughness of floor {floor}"),
            pair.sole_roughness: self.share(f"roughness of sole {sole}"),
        }
        drawn = pair.draw_inputs(replace(base, errors=errors), self.seed)
        terms = ContactTerms(*(drawn[name] for name in TERMS))
        cof = terms.adhesion(pressure, drag) + terms.hysteresis
        return cof * drawn["laboratory"] * drawn["pair"]

    def pair_error(self, pair: Pair, sole: str, floor: str) -> Array:
        """Return standard normal draws (count,) of the error of a pair."""
        return self.beyond_roughness(floor, f"pair: {sole}, {floor}, {pair.family}", pair.family)

    def log_likelihood(self, cof: Array, reading: CofReading) -> Array:
        """Return ln p(reading | draw), (count,), of a predicted COF."""
        repeat = READING if reading.sd is None else reading.sd / reading.cof
        deviation = np.hypot(repeat, self.constants.sd_reading)
        rest = (np.log(np.maximum(cof, 1e-6)) - np.log(reading.cof)) / deviation
        if reading.kind == "value":
            return -0.5 * rest**2 - np.log(deviation)
        return log_ndtr(rest if reading.kind == "lower" else -rest)

    def learn(self, log_likelihood: Array, where: str) -> Array:
        """Keep draws by the likelihood of a reading, (count,), and return the rows that are kept.

        Raises:
            InputError: So few draws agree with it that nothing can be said.
        """
        weight = np.exp(log_likelihood - log_likelihood.max())
        weight /= weight.sum()
        effective = 1 / float((weight**2).sum())
        rows = np.random.default_rng(self.seed).permutation(even_rows(weight, self.count, 0.5))
        left = min(effective, np.unique(self.constants.constants.kappa_0[rows]).size)
        if left < FEWEST:
            raise InputError(
                Message(
                    "only {left:.0f} of {count} draws agree with this reading and those before",
                    left=left,
                    count=self.count,
                ),
                where=where,
                remedy="Check value and unit, kind (value, lower, upper) and what it was read on; "
                "leave out a reading that contradicts the others",
            )
        self.fewest = min(self.fewest, left)
        self.constants = self.constants.rows(rows)
        for kept in (self._shares, self._errors):
            kept.update({name: values[rows] for name, values in kept.items()})
        return rows


def interval(values: Array) -> tuple[float, float, float]:
    """Return the 2.5, 50 and 97.5 % of draws."""
    low, median, high = (float(x) for x in np.quantile(values, (0.025, 0.5, 0.975)))
    return low, median, high
