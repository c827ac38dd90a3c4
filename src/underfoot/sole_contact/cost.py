"""What solving a contact will cost, before it is solved."""

import math
from dataclasses import dataclass

from underfoot.core import InputError
from underfoot.core.remark import Message

AT_REST = 130e6
"""Bytes of the program with its libraries."""
BYTES_PER_CELL = 5e3
"""Of peak memory, per cell under the sole: factors and Krylov basis."""
SECONDS_PER_CELL = (0.05e-3, 0.19e-3)
"""CPU seconds per cell under a sole with lugs on 0.5 mm: easiest and hardest of the report's."""
GROWTH = 0.2
"""Exponent by which the time per cell grows with the cells."""
CELLS_MEASURED = 14400.0


@dataclass(frozen=True, slots=True)
class Cost:
    """CPU seconds (low, high) on one core and peak memory (bytes) that a solution will take."""

    cells: int
    seconds: tuple[float, float]
    memory: float

    def __str__(self) -> str:
        low, high = self.seconds
        return Message(
            "{cells} cells under the sole, about {low:.0f} to {high:.0f} s and {megabytes}",
            cells=self.cells,
            low=low,
            high=high,
            megabytes=megabytes(self.memory),
        )


def solution_cost(plan_area: float, spacing: float) -> Cost:
    """Return what a sole of ``plan_area`` (m^2) on cells of ``spacing`` (m) will take.

    Measured on the report's slip-tester heels with lugs (a quarter of the cells wet) at 1 to
    0.25 mm: memory grows as the cells, time as cells^1.2. A history of the motion takes more in
    proportion to its steps.
    """
    cells = math.ceil(plan_area / spacing**2)
    growth = cells * (cells / CELLS_MEASURED) ** GROWTH
    low, high = SECONDS_PER_CELL
    return Cost(cells, (low * growth, high * growth), AT_REST + cells * BYTES_PER_CELL)


def refuse_too_large(cost: Cost, *, most_memory: float, where: str, spacing: float) -> None:
    """Refuse a grid that needs more than ``most_memory`` bytes, with the spacing that would do."""
    if cost.memory <= most_memory:
        return
    coarser = spacing * math.sqrt(cost.memory / max(most_memory - AT_REST, 1e6)) * 1.05
    raise InputError(
        Message("{cost}: more memory than allowed", cost=cost),
        where=where,
        allowed=Message(
            "up to {megabytes} (numerics.most_memory)", megabytes=megabytes(most_memory)
        ),
        remedy=Message(
            "Use a grid spacing of {coarser:.2g} mm or more, or raise numerics.most_memory",
            coarser=coarser * 1000.0,
        ),
    )


def megabytes(size: float) -> str:
    """Return a size in bytes as text, two digits."""
    return f"{float(f'{size / 1e6:.2g}'):.0f} MB"
