"""What would tell two soles apart whose order is open: computed under other conditions."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from underfoot.compute.continuation import Continuation
from underfoot.core import ConvergenceError, InputError, Progress, silent
from underfoot.core.arrays import Array
from underfoot.core.remark import Amount, Message
from underfoot.friction.tread_error import READING

from .order import Order, certainty_after_reading, order_of_draws

if TYPE_CHECKING:
    from underfoot.case import Case

REPEATS = 2**0.5 * READING
"""Standard deviation of ln of the ratio of two readings of one tester."""
FLUIDS = ("water", "detergent", "glycerol_50pct", "glycerol_90pct", "canola_oil")
ANGLES = (7.0, 10.0, 13.0, 17.0)
"""Shoe angles (deg) of the test methods."""
WORN = 2e-3
"""m of tread worn off."""
MOVES = 0.2
"""Change of the probability of an order from which a step is said to tell."""


@dataclass(frozen=True, slots=True)
class SeparatingStep:
    """A step that was computed, and the probability of the likelier order after it.

    Parameters:
        kind: "reading" of both on one tester, "fluid", "angle" or "worn".
        value: Name of the fluid, shoe angle in rad, depth in m; None of a reading.
        told: 0.5 to 1; of a reading the mean over what it may read.
        order: Of the two under that condition; None of a reading.
    """

    kind: str
    value: str | float | None
    told: float
    order: Order | None = None

    @property
    def step(self) -> Message:
        """What is done, in words."""
        if self.kind == "reading":
            return Message("COF of both on one tester, all else alike")
        if self.kind == "fluid":
            return Message("both in {fluid}", fluid=str(self.value).replace("_", " "))
        value = float(self.value or 0.0)
        if self.kind == "angle":
            return Message("both at {angle}", angle=Amount(value, "rad"))
        return Message("both with {depth} of tread worn off", depth=Amount(value, "m"))


def of_reading(first: Array, second: Array) -> SeparatingStep:
    """Return what a reading of both on one tester would tell."""
    return SeparatingStep("reading", None, certainty_after_reading(first, second, REPEATS))


def of_conditions(
    first: Case, second: Case, *, progress: Progress = silent
) -> list[SeparatingStep]:
    """Return the order of two cases under each fluid, angle and wear that both can share.

    Each sole is marched once on its coarse grid, and continued from there. What can't be continued
    is left out, and so is what the cases do not have in common: another fluid tells nothing of two
    cases that differ by their fluids.
    """
    marches, found = [], []
    for number, case in enumerate((first, second)):
        progress("What would tell them apart", 0.3 * number)
        try:
            marches.append(Continuation(case))
        except (ConvergenceError, InputError):
            return []
    tried = list(_conditions(first, second))
    for number, (kind, value, changes) in enumerate(tried):
        progress("What would tell them apart", 0.6 + 0.4 * number / len(tried))
        draws = []
        for march in marches:
            try:
                draws.append(march.continue_march(changes).cof_draws)
            except (ConvergenceError, InputError):
                break
        if len(draws) == 2 and draws[0] is not None and draws[1] is not None:
            order = order_of_draws(np.asarray(draws[0]), np.asarray(draws[1]))
            found.append(SeparatingStep(kind, value, order.told, order))
    return found


def _conditions(first: Case, second: Case) -> Iterator[tuple[str, str | float, Mapping[str, Any]]]:
    """Yield what both cases can be asked under, as changes of either."""
    if first.contaminant is not None and first.contaminant == second.contaminant:
        known = first.catalogue.names("fluid")
        present = first.entries.get("contaminant")
        for name in FLUIDS:
            if name in known and name != present:
                yield "fluid", name, {"contaminant": name}
    if first.motion == second.motion:
        for angle in np.radians(ANGLES):
            if abs(angle - first.motion.shoe_angle) > np.radians(1):
                yield "angle", float(angle), {"motion.shoe_angle": float(angle)}
    depths = [case.value("shoe.tread.depth") or 0.0 for case in (first, second)]
    new = not any(case.value("shoe.wear.depth") for case in (first, second))
    if new and min(depths) > WORN:
        yield "worn", WORN, {"shoe.wear.depth": WORN}
