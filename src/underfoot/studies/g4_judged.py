"""How far the readings of G.4 can be trusted: bands from the open inputs, grid and tracks."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .g4_conditions import LEAST, Condition, Reading
from .verdict import Verdict

if TYPE_CHECKING:
    from underfoot.assess.sensitivity import Sensitivity

SMALL = 5.0
"""N: what the report calls negligible."""
LOAD_WITHIN, PEAK_WITHIN = 0.30, 0.50
"""Agreement that is wanted of loads and peaks where the report prints one."""


@dataclass(frozen=True, slots=True)
class Banded:
    """A reading with its central 95 % band (nan where no band was computed)."""

    value: float
    low: float
    high: float

    @property
    def has_band(self) -> bool:
        """Whether a band was computed."""
        return not math.isnan(self.low)


@dataclass(frozen=True, slots=True, eq=False)
class Judged:
    """A reading with bands, its side of 5 N and the probability of that side.

    ``within`` are the probabilities of the wanted agreement of load and peak; None where the report
    prints none or no band was computed.
    """

    reading: Reading
    load: Banded
    true_load: Banded
    peak: Banded
    cof: Banded
    right: bool
    probability: float | None
    load_within: float | None
    peak_within: float | None

    @property
    def condition(self) -> Condition:
        """Which shoe and fluid."""
        return self.reading.condition


def grid_factor(fine: float, coarse: float, refinement: float, least: float) -> float:
    """Return the factor that the fine grid still lacks: exp(|ln fine/coarse| / (r - 1)).

    First order in the spacing; ``refinement`` r is coarse over fine, 1 where there is one grid.
    """
    if refinement <= 1.0 or math.isnan(fine) or math.isnan(coarse):
        return 1.0
    return math.exp(abs(math.log(max(fine, least) / max(coarse, least))) / (refinement - 1.0))


def judged(reading: Reading, found: Sensitivity | None, *, refinement: float) -> Judged:
    """Return a reading with the bands that its open inputs, the grid and the tracks give."""
    draws = {name: _draws(name, reading, found, refinement) for name in LEAST}
    condition = reading.condition
    value = reading.number("fluid_load_sensor")
    load, peak = draws["fluid_load_sensor"], draws["peak_fluid_pressure_sensor"]
    large = condition.printed_load is not None
    there = found is not None
    return Judged(
        reading,
        _banded(value, load),
        _banded(reading.number("fluid_load"), draws["fluid_load"]),
        _banded(reading.number("peak_fluid_pressure_sensor"), peak),
        _cof(reading, found),
        right_side(value, printed=condition.printed_load),
        float(np.mean(load > SMALL if large else load < SMALL)) if there else None,
        _share(load, condition.printed_load, LOAD_WITHIN) if there else None,
        _share(peak, condition.printed_peak, PEAK_WITHIN) if there else None,
    )


def right_side(value: float, *, printed: float | None) -> bool:
    """Return whether a load (N) lies on the side of 5 N that the report prints."""
    return value > SMALL if printed is not None else value < SMALL


def against(printed: float, within: float, value: Banded, *, right: bool) -> Verdict:
    """Return the verdict on a reading against a printed one.

    Reproduced within the wanted agreement, within scatter where the band reaches it, else trend
    only on the right side of 5 N.
    """
    low, high = printed * (1 - within), printed * (1 + within)
    if math.isnan(value.value):
        return Verdict.NOT_AVAILABLE
    if low <= value.value <= high:
        return Verdict.REPRODUCED
    if value.has_band and value.low <= high and value.high >= low:
        return Verdict.WITHIN_SCATTER
    return Verdict.TREND_ONLY if right else Verdict.DISAGREES


def _draws(name: str, reading: Reading, found: Sensitivity | None, refinement: float) -> np.ndarray:
    from underfoot.assess.sampled import sampled

    if found is None:
        return np.full(1, np.nan)
    value = reading.number(name)
    factors = [grid_factor(value, found.nominal.number(name), refinement, LEAST[name])]
    spread = reading.outcome.spread(name)
    if value > LEAST[name] and spread > 0:
        factors.append(1.0 + spread / value)
    most = reading.condition.case.motion.normal_force
    if name == "peak_fluid_pressure_sensor":
        most = max(value * (1.0 + 1e-6), highest_film_pressure(reading, found))
    return sampled(found, name, value=value, factors=factors, least=LEAST[name], most=most)


def highest_film_pressure(reading: Reading, found: Sensitivity) -> float:
    """Return the highest pressure under the sole in any computed case, Pa: no pocket reads more."""
    ends = [end for effect in found.effects for end in (effect.low, effect.high)]
    outcomes = (reading.outcome, found.nominal, *ends)
    return float(np.nanmax([one.number("peak_fluid_pressure") for one in outcomes]))


def _banded(value: float, draws: np.ndarray) -> Banded:
    """Return the value with its band, which holds the value itself."""
    low, high = np.percentile(draws, [2.5, 97.5])
    return Banded(value, float(np.minimum(low, value)), float(np.maximum(high, value)))


def _cof(reading: Reading, found: Sensitivity | None) -> Banded:
    value, deviation = reading.number("cof"), reading.outcome.spread("cof")
    if found is not None:
        deviation = found.band("cof").deviation
    return Banded(value, max(0.0, value - 1.96 * deviation), value + 1.96 * deviation)


def _share(draws: np.ndarray, printed: float | None, within: float) -> float | None:
    if printed is None:
        return None
    return float(np.mean(np.abs(draws / printed - 1.0) <= within))
