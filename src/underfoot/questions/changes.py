"""Changes of shoe, floor, cleaning and walking that may reduce the slip probability."""

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
"""Pa s below which a fluid counts as thin as water."""


@dataclass(frozen=True, slots=True)
class Change:
    """One change of a case: what is done, who decides on it, and the new values."""

    name: str
    action: str
    lever: str
    values: Mapping[str, Any]


def possible_changes(case: Case) -> list[Change]:
    """Return the changes that make sense for a case, in no order of merit."""
    return [change for make in _MAKERS if (change := make(case)) is not None]


def _new_tread(case: Case) -> Change | None:
    tread = case.shoe.tread
    if tread is None:  # the outsole comes from a file
        return None
    if (case.value("shoe.tread.depth") or 0.0) >= WORN_OUT:
        return None
    return Change(
        "new_tread",
        "replace the worn shoe by one with 3 mm of tread (lugs 5 mm, channels 2.5 mm)",
        "shoe",
        TREAD,
    )


def _wider_channels(case: Case) -> Change | None:
    channel = case.value("shoe.tread.channel_width")
    if not channel or case.value("shoe.tread.depth") < WORN_OUT:
        return None
    wider = 1.5 * channel
    return Change(
        "wider_channels",
        f"channels 50 % wider ({wider * 1e3:.1f} mm)",
        "shoe",
        {"shoe.tread.channel_width": wider},
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
        {"shoe.roughness.rq": 2 * rq, "shoe.roughness.ra": None},
    )


def _rougher_floor(case: Case) -> Change | None:
    rq = case.floor.roughness.rq_or_estimate
    if rq is None or rq > ROUGH_FLOOR_RQ / 2:
        return None
    return Change(
        "rougher_floor",
        f"a floor of Rq {ROUGH_FLOOR_RQ * 1e6:.0f} µm (as a rough ceramic tile)",
        "floor",
        {"floor.roughness.rq": ROUGH_FLOOR_RQ},
    )


def _rinsed(case: Case) -> Change | None:
    viscosity = case.value("contaminant.viscosity")
    if viscosity is None or viscosity < THIN:
        return None
    return Change(
        "rinse", "rinse the contaminant away with water", "cleaning", {"contaminant": "water"}
    )


def _diluted(case: Case) -> Change | None:
    viscosity = case.value("contaminant.viscosity")
    if viscosity is None or viscosity < 5 * THIN:
        return None
    return Change(
        "dilute",
        "clean with a detergent solution",
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
