"""Two shares of slips: their difference with its score interval, equivalence, power."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import DataError, InputError
from underfoot.core.remark import Message


@dataclass(frozen=True, slots=True)
class ShareDifference:
    """Difference of two shares, first - second, with its score interval.

    ``p``: of no difference. ``slips`` and ``trials``: of both groups. ``counted``: trials that the
    interval counts, fewer where persons repeat and are alike. ``apart``: of pairs, how many slipped
    in the first alone and in the second alone.
    """

    difference: float
    low: float
    high: float
    p: float
    slips: tuple[int, int]
    trials: tuple[int, int]
    counted: tuple[float, float]
    apart: tuple[int, int] | None = None

    @property
    def shares(self) -> tuple[float, float]:
        """Share of slips in each group."""
        return self.slips[0] / self.trials[0], self.slips[1] / self.trials[1]

    def beyond(self, margin: float) -> float:
        """Return p (one side) of a true difference of ``margin``, against a larger one.

        InputError: a margin that is not between -1 and 1.
        """
        from scipy.stats import norm

        if not -1 < margin < 1:
            raise InputError(
                Message("margin {margin:g}", margin=margin),
                where="shares",
                allowed="between -1 and 1",
            )
        if self.apart is not None:
            return float(norm.sf(paired_score(*self.apart, self.trials[0], margin)))
        return float(norm.sf(score(*self.shares, *self.counted, margin)))


def is_share(values: ArrayLike) -> bool:
    """Return whether the values are slips: 0 and 1 alone."""
    return bool(np.isin(np.asarray(values, dtype=float), (0.0, 1.0)).all())


def share_difference(
    first: ArrayLike,
    second: ArrayLike,
    first_person: Sequence[object] = (),
    second_person: Sequence[object] = (),
    *,
    paired: bool = False,
    confidence: float = 0.95,
) -> ShareDifference:
    """Return the difference of two shares of slips with its score interval.

    The interval holds every difference that the score test does not reject (Miettinen and
    Nurminen's for two groups, Tango's for ``paired`` rows); it stays between -1 and 1 and has a
    width also where nobody slipped. Where persons repeat, each group counts as many trials as have
    the variance between persons (Rao and Scott); where all or none slip, as many as there are
    persons. Unless ``paired``, both groups are taken as different persons.

    ``first``, ``second``: 0 or 1, one row a trial. ``first_person``, ``second_person``: whose each
    row is; each its own without.

    DataError: no trial in a group; values other than 0 and 1; lengths differ.

    Source: O. Miettinen, M. Nurminen, Stat. Med. 4 (1985) 213; T. Tango, Stat. Med. 17 (1998) 891;
    J. N. K. Rao, A. J. Scott, Biometrics 48 (1992) 577.
    """
    from scipy.optimize import brentq

    a, b = np.asarray(first, dtype=float), np.asarray(second, dtype=float)
    for values, persons in ((a, first_person), (b, second_person)):
        if not len(values) or not is_share(values) or len(persons) not in (0, len(values)):
            raise DataError("a share needs trials with 0 or 1 each", where="shares")
    if paired and len(a) != len(b):
        raise DataError(
            Message("{count} against {other} trials can't be paired", count=len(a), other=len(b)),
            where="shares",
        )
    counted = _effective_count(a, first_person), _effective_count(b, second_person)
    apart = (int(np.sum(a > b)), int(np.sum(a < b))) if paired else None
    difference = float(a.mean() - b.mean())
    told = ShareDifference(
        difference, -1.0, 1.0, 1.0, (int(a.sum()), int(b.sum())), (len(a), len(b)), counted, apart
    )
    tail = 0.5 - confidence / 2.0
    near = 1.0 - 1e-12
    if told.beyond(-near) < tail:
        low = brentq(lambda d: told.beyond(d) - tail, -near, min(difference, near))
        told = replace(told, low=float(np.asarray(low)))
    if told.beyond(near) > 1.0 - tail:
        high = brentq(lambda d: told.beyond(d) - 1.0 + tail, max(difference, -near), near)
        told = replace(told, high=float(np.asarray(high)))
    one_side = told.beyond(0.0)
    return replace(told, p=min(2.0 * min(one_side, 1.0 - one_side), 1.0))


def paired_score(first: int, second: int, n: int, difference: float) -> float:
    """Return Tango's score of pairs against a difference, as ``score``.

    ``first`` and ``second``: of ``n`` pairs, those who slipped in that one alone.
    """
    d = difference
    b = (2.0 * n - first + second) * d - first - second
    c = -second * d * (1.0 - d)
    alone = (np.sqrt(max(b * b - 8.0 * n * c, 0.0)) - b) / (4.0 * n)
    variance = n * (2.0 * alone + d * (1.0 - d))
    off = first - second - n * d
    if abs(off) < 1e-12 * n:
        return 0.0
    return float(off / np.sqrt(variance)) if variance > 0 else float(np.copysign(np.inf, off))


def _effective_count(values: np.ndarray, persons: Sequence[object]) -> float:
    """Return the number of independent trials that tell as much of the share."""
    n, share = len(values), float(values.mean())
    names = {str(person): i for i, person in enumerate(dict.fromkeys(map(str, persons)))}
    if len(names) in (0, n):
        return float(n)
    if share in (0.0, 1.0) or len(names) < 2:
        return float(len(names))
    who = np.array([names[str(person)] for person in persons])
    off = np.bincount(who, values - share)
    variance = float(off @ off) * len(names) / (len(names) - 1.0) / n**2
    return min(share * (1.0 - share) / variance, float(n)) if variance > 0 else float(n)


def score(
    a: ArrayLike, b: ArrayLike, m: ArrayLike, n: ArrayLike, difference: ArrayLike
) -> np.ndarray:
    """Return the score of shares ``a`` of ``m`` and ``b`` of ``n`` against a difference a - b.

    Standard normal where it is the true one; the shares under it are those of maximum likelihood
    (the root of a cubic). Arrays of one shape. 0 where the shares are the difference exactly.
    """
    a, b, m, n, d = (np.asarray(one, dtype=float) for one in (a, b, m, n, difference))
    total, slips = m + n, m * a + n * b
    c2 = ((m + 2.0 * n) * d - total - slips) / (3.0 * total)
    c1 = ((n * d - total - 2.0 * n * b) * d + slips) / (3.0 * total)
    c0 = n * b * d * (1.0 - d) / (2.0 * total)
    q = c2**3 - 1.5 * c1 * c2 + c0
    root = np.copysign(np.sqrt(np.maximum(c2**2 - c1, 0.0)), q)
    with np.errstate(divide="ignore", invalid="ignore"):
        angle = (np.pi + np.arccos(np.clip(np.nan_to_num(q / root**3), -1.0, 1.0))) / 3.0
        ends = np.maximum(0.0, -d), np.minimum(1.0, 1.0 - d)
        low = np.clip(2.0 * root * np.cos(angle) - c2, *ends)
        high = low + d
        variance = (high * (1.0 - high) / m + low * (1.0 - low) / n) * total / (total - 1.0)
        found = (a - b - d) / np.sqrt(np.maximum(variance, 0.0))
    return np.where(np.abs(a - b - d) < 1e-12, 0.0, found)
