"""Edits by hand: a step's contact, end, side or plate set, or the step excluded."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from underfoot.core import InputError, unknown_name

from .plates import plate_named
from .stance import Stance
from .trial import Edit, Trial

TOGETHER = 0.1  # s; two contacts of a walk begin half a second apart
_NEAR = 0.3  # s before its contact up to which a time still names a step


class EditError(InputError):
    """An edit that names no step, changes nothing or contradicts another: it ends the run."""


def edited_contacts(found: Sequence[Stance], trial: Trial, up: np.ndarray) -> list[Stance]:
    """Return the contacts with the trial's edits applied; ``side`` is applied where it is judged.

    An excluded contact, and one that is no step because another plate was named, have a reason.

    EditError: an edit names no contact, lies outside the record, changes nothing or contradicts
    another.
    """
    contacts = list(found)
    seen: dict[tuple[int, str], Edit] = {}
    for edit in trial.edits:
        at = _named(contacts, edit)
        number = contacts[at].number
        for (other, what), earlier in seen.items():
            if other == number and (what == edit.what or "exclude" in (what, edit.what)):
                raise EditError(
                    f"{edit.what} of step {number} contradicts {earlier.where}",
                    where=edit.where,
                    remedy="Keep one of the two",
                )
        seen[number, edit.what] = edit
        if edit.what == "plate":
            contacts = _on_plate(contacts, at, edit)
        else:
            contacts[at] = _changed(contacts[at], edit, trial, up)
    return contacts


def _named(contacts: Sequence[Stance], edit: Edit) -> int:
    """Index of the contact that an edit names by number or by a time."""
    allowed = "; ".join(f"{s.number} at {s.contact:.3f} s on {s.plate}" for s in contacts[:20])
    allowed = allowed or "the recording has no contact with a plate"
    if isinstance(edit.step, int):
        for i, stance in enumerate(contacts):
            if stance.number == edit.step:
                return i
        raise EditError(f"there is no step {edit.step}", where=edit.where, allowed=allowed)
    near = [
        (abs(edit.step - s.contact), i)
        for i, s in enumerate(contacts)
        if s.contact - _NEAR <= edit.step <= s.toe_off
    ]
    if not near:
        raise EditError(f"there is no step at {edit.step:g} s", where=edit.where, allowed=allowed)
    return min(near)[1]


def _changed(stance: Stance, edit: Edit, trial: Trial, up: np.ndarray) -> Stance:
    by_hand = (*stance.by_hand, edit.what)
    if edit.what == "exclude":
        return replace(stance, reason=f"excluded by hand: {edit.why}", by_hand=by_hand)
    if edit.what == "side":
        if stance.side == edit.value:
            words = f"step {stance.number} is the {edit.value} foot already"
            raise EditError(f"{words}: the edit changes nothing", where=edit.where)
        return replace(stance, side=str(edit.value), heel="", by_hand=by_hand)
    plate = plate_named(trial, stance.plate)
    time = float(edit.value or 0.0)
    last = plate.start + (len(plate.force) - 1) / plate.rate
    if not plate.start <= time <= last:
        raise EditError(
            f"{edit.what} at {time:g} s lies outside the record",
            where=edit.where,
            allowed=f"{plate.start:.3f} to {last:.3f} s",
        )
    sample = round((time - plate.start) * plate.rate)
    if sample == (stance.start if edit.what == "contact" else stance.stop):
        words = f"{edit.what} of step {stance.number} is at {time:g} s already"
        raise EditError(f"{words}: the edit changes nothing", where=edit.where)
    if edit.what == "contact":
        stance = replace(stance, start=sample, contact=time)
    else:
        stance = replace(stance, stop=sample, toe_off=time)
    if stance.stop - stance.start < 2:
        raise EditError(
            f"step {stance.number} would end before it begins",
            where=edit.where,
            allowed=f"contact before toe off, now {stance.contact:.3f} and {stance.toe_off:.3f} s",
        )
    peak = float(np.nanmax((plate.force @ up)[stance.start : stance.stop], initial=0.0))
    return replace(stance, peak=peak, by_hand=by_hand)


def _on_plate(contacts: list[Stance], at: int, edit: Edit) -> list[Stance]:
    """The step is on the plate named: contacts that begin with it on other plates are no steps."""
    named = contacts[at]
    together = [i for i, s in enumerate(contacts) if abs(s.contact - named.contact) < TOGETHER]
    plates = [contacts[i].plate for i in together]
    if edit.value not in plates:
        known = unknown_name("plate with a contact at that time", str(edit.value), plates)
        more = {"allowed": known.allowed, "nearest": known.nearest}
        raise EditError(known.what, where=edit.where, **more)
    if len(together) == 1:
        words = f"step {named.number} is on {edit.value} alone: the edit changes nothing"
        raise EditError(words, where=edit.where)
    out = list(contacts)
    other = f"by hand: the step is on {edit.value} ({edit.why})"
    for i in together:
        reason = out[i].reason if out[i].plate == edit.value else other
        out[i] = replace(out[i], reason=reason, by_hand=(*out[i].by_hand, "plate"))
    return out
