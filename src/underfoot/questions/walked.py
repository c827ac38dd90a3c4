"""How far and how long a person walks until a sole has lost a volume."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from underfoot.core import InputError, to_si
from underfoot.core.remark import Message
from underfoot.core.unit_text import metres
from underfoot.core.units import si_unit

LANDING_LOAD = 180.0
"""N on a shoe that slides at heel contact (Iraqi et al. 2018, doi 10.1016/j.jbiomech.2018.04.018,
39 slips at their start: 179 N)."""
SLIDING = (2.2e-3, 12.6e-3)
"""m a heel slides forward at contact: means of two groups of 494 walks over dry and contaminated
floors (McGorry et al. 2008, Appl. Ergon. 39:678, abstract)."""
STEP = (0.5, 0.75)
"""m: 0.30 to 0.43 of body height (samples in table 2 of PMC2943048) at 1.7 m, rounded."""
STEPS_A_DAY = (4000.0, 18000.0)
"""Of healthy adults, both feet (Tudor-Locke et al. 2011, doi 10.1186/1479-5868-8-79)."""
DAYS_A_MONTH = 365.25 / 12
MONTH = DAYS_A_MONTH * 86400.0
"""s."""
SOURCES = Message(
    "walked: V / (k F s) landings of one shoe, k the wear rate of the case, F 180 N (Iraqi et al. "
    "2018), s 2 to 13 mm (McGorry et al. 2008), steps of 0.5 to 0.75 m (30 to 43 % of 1.7 m), "
    "4,000 to 18,000 steps a day, every day in these shoes (Tudor-Locke et al. 2011)"
)
THICKEST = 0.1
"""m: no sole loses as much."""
_PAIR = re.compile(r"(?P<lost>.+?)\s+(?:after|in)\s+(?P<walked>[^a-zA-Z].*)")


@dataclass(frozen=True, slots=True)
class WornPair:
    """A pair of the same make that was measured.

    Attributes:
        lost: Thickness lost, m.
        walked: Distance walked, m; None where the time is known.
        months: In which it was worn.
    """

    lost: float
    walked: float | None
    months: float | None = None


@dataclass(frozen=True, slots=True)
class Walked:
    """Distance (m) and time (months) until a volume is lost, least and most."""

    distance: tuple[float, float]
    months: tuple[float, float]

    @property
    def text(self) -> Message:
        """Both as people read them."""
        low, high = self.distance
        distance = _range((low / 1e3, high / 1e3))
        return Message(
            "{distance} km, {months} months", distance=distance, months=_range(self.months)
        )


@dataclass(frozen=True, slots=True)
class WearWalker:
    """What turns a volume lost into a distance.

    Parameters:
        wear_rate: k, m^2/N; on the sheet of an abrasion test it is larger than on floors.
        pair: A measured pair; it replaces the wear rate, load and sliding.
    """

    wear_rate: float
    pair: WornPair | None = None

    def walk_until(self, volume: float, volumes: Sequence[float], lost: Sequence[float]) -> Walked:
        """Return the walk until ``volume`` (m^3) is lost.

        Without a pair L = 2 l V / (k F s), two steps l to each landing of one shoe. With one,
        L = V L_pair / V_pair, its volume read from the series at its thickness lost.

        Args:
            volume: Lost, m^3.
            volumes, lost: Of all states of the series, m^3 and m.

        Raises:
            InputError: The pair has lost more than the last state.
        """
        if self.pair is not None:
            times = volume / _volume_at(self.pair.lost, volumes, lost)
            if self.pair.walked is None:
                months = times * (self.pair.months or 0.0)
                days = months * DAYS_A_MONTH
                least, most = (days * a * step for a, step in zip(STEPS_A_DAY, STEP, strict=True))
                return Walked((least, most), (months, months))
            length = times * self.pair.walked
            distance = (length, length)
            steps = [length / step for step in reversed(STEP)]
        else:
            landings = [volume / (self.wear_rate * LANDING_LOAD * s) for s in reversed(SLIDING)]
            steps = [2 * landing for landing in landings]
            distance = (steps[0] * STEP[0], steps[1] * STEP[1])
        low, high = (n / a / DAYS_A_MONTH for n, a in zip(steps, STEPS_A_DAY[::-1], strict=True))
        return Walked(distance, (low, high))


def worn_pair(text: str | None) -> WornPair | None:
    """Return a measured pair from text, as "1.2 mm after 300 km" or "after 5 months"."""
    if text is None:
        return None
    match = _PAIR.fullmatch(text.strip())
    unit = "" if match is None else si_unit(match["walked"], where="--worn-pair")
    if match is None or unit not in ("m", "s"):
        raise InputError(
            f'"{text}"', where="--worn-pair", allowed='"1.2 mm after 300 km" or "after 5 months"'
        )
    lost = to_si(match["lost"], "m", where="--worn-pair")
    walked = to_si(match["walked"], unit, where="--worn-pair")
    if not (0 < lost < THICKEST and walked > 0):
        allowed = Message("both above 0, a sole thinner than {metres}", metres=metres(THICKEST))
        raise InputError(f'"{text}"', where="--worn-pair", allowed=allowed)
    return WornPair(lost, walked) if unit == "m" else WornPair(lost, None, walked / MONTH)


def _volume_at(depth: float, volumes: Sequence[float], lost: Sequence[float]) -> float:
    """Return the volume (m^3) at a thickness lost, linear between the states."""
    for (d0, v0), (d1, v1) in pairwise(zip(lost, volumes, strict=True)):
        if d0 < depth <= d1 * (1 + 1e-9):
            return v0 + (v1 - v0) * (depth - d0) / (d1 - d0)
    raise InputError(
        Message(
            "the pair has lost {depth:g} mm, the series does not pass that", depth=depth * 1000.0
        ),
        where="--worn-pair",
        allowed=Message("at most {lost:.3g} mm (--to)", lost=max(lost) * 1000.0),
    )


def _range(ends: tuple[float, float]) -> Message:
    """Return a range with one figure at each end, once where both are the same."""
    low, high = (_one_figure(end) for end in ends)
    if low == high:
        return Message.plain(low)
    return Message("{low} to {high}", low=low, high=high)


def _one_figure(value: float) -> str:
    if value <= 0:
        return "0"
    digits = -math.floor(math.log10(value))
    return f"{round(value, digits):.{max(digits, 0)}f}"
