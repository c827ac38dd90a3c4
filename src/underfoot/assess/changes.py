"""What a person could change about a shoe, a floor and what is spilled on it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from underfoot.case import Case

TREAD = {
    "shoe.tread.pattern": "grid",
    "shoe.tread.depth": "3 mm",
    "shoe.tread.lug_width": "5 mm",
    "shoe.tread.channel_width": "2.5 mm",
}
WORN_OUT = 1.5e-3
"""m of tread below which a shoe counts as worn."""
SOFTEST = 45.0
ROUGH_FLOOR_RQ = 5e-6
THIN = 2e-3
"""Pa s below which a fluid is as thin as water for our purpose."""


@dataclass(frozen=True, slots=True)
class Change:
    """One change of a case: what a person does, who decides on it, and the new values."""

    name: str
    words: str
    lever: str
    values: Mapping[str, Any]


def possible_changes(case: Case) -> list[Change]:
    """Return the changes that make sense for a case, in no order of merit."""
    return [change for make in _MAKERS if (change := make(case)) is not None]


def _new_tread(case: Case) -> Change | None:
    tread = case.shoe.tread
    if case.shoe.outsole.file is not None:  # its tread is the file's
        return None
    if tread.pattern != "none" and (tread.depth or 0.0) >= WORN_OUT:
        return None
    return Change(
        "new_tread",
        "replace the worn shoe by one with 3 mm of tread (lugs 5 mm, channels 2.5 mm)",
        "shoe",
        TREAD,
    )


def _wider_channels(case: Case) -> Change | None:
    tread = case.shoe.tread
    if case.shoe.outsole.file is not None or tread.pattern == "none":
        return None
    if not tread.channel_width or (tread.depth or 0.0) < WORN_OUT:
        return None
    wider = 1.5 * tread.channel_width
    return Change(
        "wider_channels",
        f"half as wide again channels ({wider * 1e3:.1f} mm)",
        "shoe",
        {"shoe.tread.channel_width": f"{wider!r} m"},
    )


def _softer(case: Case) -> Change | None:
    hardness = case.shoe.material.shore_a
    if hardness is None or case.shoe.material.modulus is not None or hardness - 15 < SOFTEST:
        return None
    return Change(
        "softer_compound",
        f"a softer compound (Shore A {hardness - 15:.0f} for {hardness:.0f})",
        "shoe",
        {"shoe.material.shore_a": hardness - 15},
    )


def _rougher_sole(case: Case) -> Change | None:
    rq = case.shoe.roughness.rq_or_estimate
    if rq is None or rq > 15e-6:
        return None
    return Change(
        "abraded_sole",
        f"abrade the sole to twice its roughness (Rq {2e6 * rq:.0f} µm)",
        "shoe",
        {"shoe.roughness.rq": f"{2 * rq!r} m", "shoe.roughness.ra": None},
    )


def _rougher_floor(case: Case) -> Change | None:
    rq = case.floor.roughness.rq_or_estimate
    if rq is None or rq > ROUGH_FLOOR_RQ / 2:
        return None
    return Change(
        "rougher_floor",
        f"a floor of Rq {ROUGH_FLOOR_RQ * 1e6:.0f} µm (as a rough ceramic tile)",
        "floor",
        {"floor.roughness.rq": f"{ROUGH_FLOOR_RQ!r} m"},
    )


def _rinsed(case: Case) -> Change | None:
    fluid = case.contaminant
    if fluid is None or fluid.viscosity is None or fluid.viscosity < THIN:
        return None
    return Change(
        "rinse", "rinse what is spilled away with water", "cleaning", {"contaminant": "water"}
    )


def _diluted(case: Case) -> Change | None:
    fluid = case.contaminant
    if fluid is None or fluid.viscosity is None or fluid.viscosity < 5 * THIN:
        return None
    return Change(
        "dilute",
        "clean until a detergent solution is left",
        "cleaning",
        {"contaminant": "detergent"},
    )


def _shorter_steps(case: Case) -> Change | None:
    mean = case.risk.rcof_mean
    if mean < 0.12:
        return None
    return Change(
        "shorter_steps",
        f"shorter, slower steps (required friction {mean - 0.03:.2f} for {mean:.2f})",
        "walking",
        {"risk.rcof_mean": mean - 0.03},
    )


_MAKERS: tuple[Callable[[Case], Change | None], ...] = (
    _new_tread,
    _wider_channels,
    _softer,
    _rougher_sole,
    _rougher_floor,
    _rinsed,
    _diluted,
    _shorter_steps,
)
