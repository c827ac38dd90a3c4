"""Whether the roughness of an interface is one: known, and not too steep or too deep."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from underfoot.core import InputError, RangeError, display

if TYPE_CHECKING:
    from .case import Case
    from .places import Places

STEEPEST = 0.5
"""Largest rms slope of the interface's longest waves (small-slope theory, assumed)."""


def roughness_mismatches(case: Case, places: Places) -> Iterator[InputError]:
    """Yield what is missing or impossible in the roughness of sole, floor and interface."""
    if case.interface.effective_rq is not None:
        yield from _too_rough(case, case.interface.effective_rq, "interface.effective_rq", places)
        return
    known = True
    for path, roughness in (("shoe", case.shoe.roughness), ("floor", case.floor.roughness)):
        if roughness.rq_or_estimate is None:
            known = False
            yield InputError(
                "neither Rq nor Ra is given",
                where=places(f"{path}.roughness"),
                remedy=f'Write {path}.roughness.rq = "5 um" (or ra), or interface.effective_rq',
            )
    if known:
        rq = case.effective_rq.value or 0.0
        yield from _too_rough(case, rq, "interface.roughness_beyond_cutoff", places)


def _too_rough(case: Case, rq: float, path: str, places: Places) -> Iterator[InputError]:
    waves = case.interface.longest_wave
    limits = {
        f"its waves of up to {display(waves, 'm')} would be steeper than the theory of rough "
        "contact holds for": STEEPEST * waves / (2 * math.pi)
    }
    if case.contaminant is not None:
        pool = case.contaminant.pool_depth
        limits[f"its summits (3 Rq) would stand out of {display(pool, 'm')} of fluid"] = pool / 3
    why, limit = min(limits.items(), key=lambda one: one[1])
    if rq > limit:
        yield RangeError(
            f"an Rq of {display(rq, 'm')} is no roughness of a sole on a floor: {why}",
            where=places(path),
            allowed=f"at most {display(limit, 'm')}",
            remedy="Soles and floors have a few to some tens of micrometres; a deeper pattern "
            "belongs to shoe.tread",
        )
