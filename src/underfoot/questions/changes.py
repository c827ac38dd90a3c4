"""Changes of shoe, floor, cleaning and walking that may reduce the slip probability."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from underfoot.core.presentation import quantity_text
from underfoot.core.remark import NOTHING, Message

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
    """One change of a case: what is done, who decides on it, and the new values.

    ``reason`` says why it can't be computed, where it can't.
    """

    name: str
    action: Message
    lever: str
    values: Mapping[str, Any]
    reason: Message = NOTHING


def possible_changes(case: Case) -> list[Change]:
    """Return the changes that make sense for a case, in no order of merit."""
    return list(_possible_changes(case))


def _possible_changes(case: Case) -> Iterator[Change]:
    shoe, tread_depth = case.shoe, case.value("shoe.tread.depth") or 0.0
    worn_out = tread_depth < WORN_OUT
    if shoe.tread is not None and worn_out:  # else the outsole comes from a file
        action = Message(
            "replace the worn shoe by one with 3 mm of tread (lugs 5 mm, channels 2.5 mm)"
        )
        yield Change("new_tread", action, "shoe", TREAD)
    channel = case.value("shoe.tread.channel_width")
    if channel and not worn_out:
        wider = 1.5 * channel
        action = Message("channels 50 % wider ({width})", width=_length(wider))
        yield Change("wider_channels", action, "shoe", {"shoe.tread.channel_width": wider})
    hardness = shoe.material.shore_a
    if hardness is not None and shoe.material.modulus is None and hardness - 15 >= SOFTEST:
        action = Message(
            "a softer compound (Shore A {softer:.0f} for {hardness:.0f})",
            softer=hardness - 15,
            hardness=hardness,
        )
        yield Change("softer_compound", action, "shoe", {"shoe.material.shore_a": hardness - 15})
    rq = shoe.roughness.rq_or_estimate
    if rq is not None and rq <= 15e-6:
        action = Message("abrade the sole to twice its roughness (Rq {rq})", rq=_length(2 * rq))
        values = {"shoe.roughness.rq": 2 * rq, "shoe.roughness.ra": None}
        yield Change("abraded_sole", action, "shoe", values)
    rq = case.floor.roughness.rq_or_estimate
    if rq is not None and rq <= ROUGH_FLOOR_RQ / 2:
        action = Message("a floor of Rq {rq} (as a rough ceramic tile)", rq=_length(ROUGH_FLOOR_RQ))
        yield Change("rougher_floor", action, "floor", {"floor.roughness.rq": ROUGH_FLOOR_RQ})
    viscosity = case.value("contaminant.viscosity") or 0.0
    if viscosity >= THIN:
        action, reason = Message("rinse with water (as a clean wet floor)"), NOTHING
        family = case.origins.get("contaminant.family")
        if case.contaminant is not None and case.contaminant.chemistry == "oil":
            reason = Message("water spreads oil; a film of it stays on the floor under the water")
        elif family is not None and family.leaf.assumed:
            reason = Message(
                "contaminant.family is not given: whether it mixes with water is not known"
            )
        yield Change("rinse", action, "cleaning", {"contaminant": "water"}, reason)
    if viscosity >= 5 * THIN:
        action = Message("clean with a detergent solution (as the floor wet with it alone)")
        yield Change("dilute", action, "cleaning", {"contaminant": "detergent"})
    mean = case.risk.rcof_mean
    if mean >= 0.12:
        action = Message(
            "shorter, slower steps (required friction {lower:.2f} for {mean:.2f})",
            lower=mean - 0.03,
            mean=mean,
        )
        yield Change("shorter_steps", action, "walking", {"risk.rcof_mean": mean - 0.03})


def _length(metres: float) -> str:
    return quantity_text(float(f"{metres:.2g}"), "m")
