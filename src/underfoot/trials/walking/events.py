"""Contacts with a force plate: begin and end, edits by hand, which of them are steps."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from underfoot.core import InputError, unknown_name
from underfoot.core.remark import NOTHING, Message, Remark

from ..recording.axes import Direction
from ..recording.measurement import Flag
from ..recording.plates import plate_axes
from ..recording.signals import CONTACT_FORCE, frames_between
from ..recording.trial import Edit, Plate
from .walkway import Walkway, of_walkway

_UNKNOWN = Direction()


@dataclass(frozen=True, slots=True, eq=False)
class Stance:
    """One contact with one plate; ``reason`` says why it is no step, and is empty when it is.

    ``number`` counts the contacts of a trial from 1, ``start`` and ``stop`` are sample numbers of
    the plate (stop excluded), ``contact`` and ``toe_off`` the times (s), ``peak`` the largest
    vertical force (N). ``by_hand`` names what was edited.
    """

    plate: str
    start: int
    stop: int
    contact: float
    toe_off: float
    peak: float
    reason: Message = NOTHING
    side: str = "unknown"
    heel: str = ""
    direction: Direction = _UNKNOWN
    flags: tuple[Flag, ...] = ()
    number: int = 0
    by_hand: tuple[str, ...] = ()

    @property
    def accepted(self) -> bool:
        """True when the contact is one whole step."""
        return not self.reason

    @property
    def walking(self) -> np.ndarray | None:
        """Walking direction (3,), or None."""
        return self.direction.vector

    @property
    def duration(self) -> float:
        """Length of the contact (s)."""
        return self.toe_off - self.contact

    @property
    def label(self) -> str:
        """Name of the step in tables."""
        return f"step {self.number} on {self.plate}"


TOGETHER = 0.1  # s; two contacts of a walk begin half a second apart
_NEAR = 0.3  # s before its contact up to which a time still names a step


class EditError(InputError):
    """An edit that names no step, changes nothing or contradicts another: it ends the run."""


def edited_contacts(
    detected: Sequence[Stance], edits: Sequence[Edit], plates: Mapping[str, Plate], up: np.ndarray
) -> list[Stance]:
    """Return the contacts with a trial's edits applied; ``side`` is applied where it is judged.

    ``plates``: those of the contacts by name; ``up`` (3,): unit vector out of the floor.

    An excluded contact, and one that is no step because another plate was named, have a reason.

    EditError: an edit names no contact, lies outside the record, changes nothing or contradicts
    another.
    """
    contacts = list(detected)
    seen: dict[tuple[int, str], Edit] = {}
    for edit in edits:
        at = _find_contact(contacts, edit)
        number = contacts[at].number
        for (other, what), earlier in seen.items():
            if other == number and (what == edit.what or "exclude" in (what, edit.what)):
                raise EditError(
                    Message(
                        "{what} of step {number} contradicts {where}",
                        what=edit.what,
                        number=number,
                        where=earlier.where,
                    ),
                    where=edit.where,
                    remedy="Keep one of the two",
                )
        seen[number, edit.what] = edit
        if edit.what == "plate":
            contacts = _on_plate(contacts, at, edit)
        else:
            contacts[at] = _apply_edit(contacts[at], edit, plates[contacts[at].plate], up)
    return contacts


def _find_contact(contacts: Sequence[Stance], edit: Edit) -> int:
    """Index of the contact that an edit names by number or by a time."""
    allowed = "; ".join(f"{s.number} at {s.contact:.3f} s on {s.plate}" for s in contacts[:20])
    allowed = allowed or "the recording has no contact with a plate"
    if isinstance(edit.step, int):
        for i, stance in enumerate(contacts):
            if stance.number == edit.step:
                return i
        raise EditError(
            Message("there is no step {step}", step=edit.step), where=edit.where, allowed=allowed
        )
    near = [
        (abs(edit.step - s.contact), i)
        for i, s in enumerate(contacts)
        if s.contact - _NEAR <= edit.step <= s.toe_off
    ]
    if not near:
        raise EditError(
            Message("there is no step at {step:g} s", step=edit.step),
            where=edit.where,
            allowed=allowed,
        )
    return min(near)[1]


def _apply_edit(stance: Stance, edit: Edit, plate: Plate, up: np.ndarray) -> Stance:
    by_hand = (*stance.by_hand, edit.what)
    if edit.what == "exclude":
        return replace(
            stance, reason=Remark("excluded by hand", "{why}", why=edit.why), by_hand=by_hand
        )
    if edit.what == "side":
        if stance.side == edit.value:
            text = Message(
                "step {step} is the {side} foot already: the edit changes nothing",
                step=stance.number,
                side=edit.value,
            )
            raise EditError(text, where=edit.where)
        return replace(stance, side=str(edit.value), heel="", by_hand=by_hand)
    time = float(edit.value or 0.0)
    last = plate.start + (len(plate.force) - 1) / plate.rate
    if not plate.start <= time <= last:
        raise EditError(
            Message("{what} at {time:g} s lies outside the record", what=edit.what, time=time),
            where=edit.where,
            allowed=f"{plate.start:.3f} to {last:.3f} s",
        )
    sample = round((time - plate.start) * plate.rate)
    if sample == (stance.start if edit.what == "contact" else stance.stop):
        text = Message(
            "{what} of step {number} is at {time:g} s already: the edit changes nothing",
            what=edit.what,
            number=stance.number,
            time=time,
        )
        raise EditError(text, where=edit.where)
    if edit.what == "contact":
        stance = replace(stance, start=sample, contact=time)
    else:
        stance = replace(stance, stop=sample, toe_off=time)
    if stance.stop - stance.start < 2:
        raise EditError(
            Message("step {number} would end before it begins", number=stance.number),
            where=edit.where,
            allowed=Message(
                "contact before toe off, now {contact:.3f} and {toe_off:.3f} s",
                contact=stance.contact,
                toe_off=stance.toe_off,
            ),
        )
    peak = float(np.nanmax(plate.force[stance.start : stance.stop] @ up, initial=0.0))
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
        words = Message(
            "step {step} is on {plate} alone: the edit changes nothing",
            step=named.number,
            plate=edit.value,
        )
        raise EditError(words, where=edit.where)
    out = list(contacts)
    other = Remark("by hand", "the step is on {plate} ({why})", plate=edit.value, why=edit.why)
    for i in together:
        reason = out[i].reason if out[i].plate == edit.value else other
        out[i] = replace(out[i], reason=reason, by_hand=(*out[i].by_hand, "plate"))
    return out


_SHORTEST, _LONGEST = 0.35, 1.5  # s; runners are below, standing and two feet above
_FOOT_LENGTH, _FOOT_WIDTH = 0.36, 0.14  # m, the most that the centre of pressure of one foot moves
_OUTSIDE = 0.05  # m; the marker sits behind the shoe, so a heel at the edge is a little outside


@of_walkway
def stances(walk: Walkway, *, threshold: float = CONTACT_FORCE) -> list[Stance]:
    """Return every contact with every usable plate, each accepted or rejected with a reason.

    Rejected are contacts cut by the record, too short or too long, two that begin together (a
    jump, or one foot on two plates), two feet on one plate, partial hits, impacts, saturated
    plates, samples without numbers, and contacts without a braking phase or while nobody walks.
    The trial's edits are applied first.

    EditError: an edit names no contact, changes nothing or contradicts another.
    """
    trial, up = walk.trial, walk.up
    plates = {plate.name: plate for plate in trial.plates if plate.usable}
    feet = {plate.name: _Feet(walk, plate) for plate in plates.values()}
    detected: list[Stance] = []
    for plate in plates.values():
        usual = threshold == CONTACT_FORCE
        found = walk.contacts[plate] if usual else walk.contacts_above(plate, threshold)
        for contact, way in found:
            time = plate.start + np.array([contact.start, contact.stop]) / plate.rate
            span = contact.start, contact.stop, float(time[0]), float(time[1])
            detected.append(Stance(plate.name, *span, contact.peak, direction=way))
    detected.sort(key=lambda stance: stance.contact)

    def locate_stance(stance: Stance) -> Stance:
        if "side" in stance.by_hand:
            return replace(stance, heel=walk.heels.get(stance.side, ""))
        side, heel = feet[stance.plate].foot(stance)
        return replace(stance, side=side, heel=heel)

    detected = [
        locate_stance(replace(stance, number=i)) for i, stance in enumerate(detected, start=1)
    ]
    if trial.edits:
        detected = edited_contacts(detected, trial.edits, plates, up)
        for i, stance in enumerate(detected):
            if stance.by_hand and not stance.reason:
                way = walk.direction(plates[stance.plate], stance.start, stance.stop)
                detected[i] = locate_stance(replace(stance, direction=way))
    usual = float(np.median([s.peak for s in detected])) if detected else 0.0
    # One that the record cuts began at a time nobody knows.
    begun = [s for s in detected if not s.reason and (s.start or "contact" in s.by_hand)]
    contacts = np.array([s.contact for s in begun])
    judged = []
    for stance in detected:
        near = np.flatnonzero(np.abs(contacts - stance.contact) < TOGETHER)
        others = [begun[i] for i in near if begun[i].plate != stance.plate]
        reason = stance.reason or _reason(walk, stance, others, usual, feet[stance.plate])
        judged.append(replace(stance, reason=reason))
    return judged


def _reason(
    walk: Walkway, stance: Stance, others: list[Stance], usual_peak: float, feet: "_Feet"
) -> Message:
    plate, weight = feet.plate, walk.weight
    part = plate.force[stance.start : stance.stop]
    vertical = part @ walk.up
    if stance.start == 0 and "contact" not in stance.by_hand:
        return Message("begins before the record")
    if stance.stop == len(plate.force):
        return Message("ends after the record")
    if not np.isfinite(part).all():
        return Message("samples without a number")
    if plate.saturated:
        return Message("the plate is saturated")
    if stance.duration < _SHORTEST:
        return Remark("too short for a walking step", "{time:.0f} ms", time=1e3 * stance.duration)
    if stance.duration > _LONGEST:
        return Remark("standing, or more than one foot", "{time:.2f} s", time=stance.duration)
    if others:
        gap = 1e3 * abs(others[0].contact - stance.contact)
        return Remark(
            "one foot on both, or a jump",
            "{gap:.0f} ms from the contact on {plate}",
            gap=gap,
            plate=others[0].plate,
        )
    expected = weight.newtons if weight else 0.9 * usual_peak
    if stance.peak < 0.7 * expected:
        return Remark(
            "partial",
            "peak {peak:.0f} N is {share:.0f} % of {of}",
            peak=stance.peak,
            share=100 * stance.peak / expected,
            of=Message("body weight") if weight else Message("the usual peak"),
        )
    ratio = stance.peak / float(vertical.mean())
    if ratio > 2.2 or (weight and stance.peak > 2.0 * expected):
        times = Message("{ratio:.1f} times the mean", ratio=ratio)
        if weight:
            times = Message("{ratio:.1f} times body weight", ratio=stance.peak / expected)
        return Remark(
            "an impact, not a walking step",
            "peak {peak:.0f} N, {times}",
            peak=stance.peak,
            times=times,
        )
    two = _two_feet(stance, feet)
    if two:
        return two
    outside = feet.outside(stance)
    if outside > _OUTSIDE:
        return Remark(
            "a partial hit", "the heel stands {way:.0f} mm outside the plate", way=1e3 * outside
        )
    if stance.walking is None:
        return Remark.of("no walking direction", stance.direction.explanation)
    # Walking up a slope, gravity along the surface hides the braking: it is sought horizontally.
    along = part @ walk.axes.ramp.gravity(walk.up, stance.walking)[1]
    braking = -float(np.minimum(along[: len(along) // 2], 0.0).sum()) / plate.rate
    if braking < 0.01 * stance.peak * stance.duration:
        return Remark("not a heel-first step", "no braking in its first half")
    return NOTHING


@of_walkway
def no_contact_reason(walk: Walkway) -> Message:
    """Return why a trial has no contact with a force plate: which of four causes it is."""
    trial = walk.trial
    usable = [plate for plate in trial.plates if plate.usable]
    if usable:
        peak = max(float(np.nanmax(plate.force @ walk.up, initial=0.0)) for plate in usable)
        return Message(
            "nobody steps on a force plate: the largest vertical force is {peak:.3g} N and a step "
            "needs {least:g} N for 30 ms (at {rates}; is the unit right?)",
            peak=peak,
            least=5 * CONTACT_FORCE,
            rates=sorted({f"{plate.rate:g} Hz" for plate in usable}),
        )
    problems = [Remark.of(plate.name, plate.problem) for plate in trial.plates if plate.problem]
    if problems:
        return Message("no force plate can be used: {problems:; }", problems=problems)
    names = list(trial.channels)[:8]
    if any("cof" in name.casefold() or "friction" in name.casefold() for name in trial.channels):
        return Message(
            "a log of friction ({names}) without force plates: choose a protocol for testers",
            names=names,
        )
    if names:
        return Message(
            "no columns are recognised as force plates ({names}): name them in a profile",
            names=names,
        )
    return Message("the file holds no force plate")


def _two_feet(stance: Stance, feet: "_Feet") -> Message:
    if {"left", "right"} <= set(feet.on_plate(stance)):
        return Message("both heels are on the plate")
    plate, way, up = feet.plate, stance.walking, feet.up
    if plate.centre_of_pressure is None or way is None:
        return NOTHING
    part = slice(stance.start, stance.stop)
    time = plate.start + np.arange(stance.start, stance.stop) / plate.rate
    carried = np.outer(time - stance.contact, feet.surface(stance))
    place = plate.centre_of_pressure[part] - carried
    inside = place[plate.force[part] @ up > 0.2 * stance.peak]
    inside = inside[np.isfinite(inside).all(axis=1)]
    if len(inside) < 10:
        return NOTHING
    along = float(np.ptp(inside @ way))
    sideways = float(np.ptp(inside @ np.cross(up, way)))
    # A foot set down at an angle to the path lets the centre of pressure move across.
    turning = 1.0 if feet.walk.trial.markers else 0.5
    if along > _FOOT_LENGTH or sideways > _FOOT_WIDTH + 0.5 * along * turning:
        return Remark(
            "more than one foot",
            "the centre of pressure moves {along:.0f} mm along and {sideways:.0f} mm across",
            along=1e3 * along,
            sideways=1e3 * sideways,
        )
    return NOTHING


class _Edges:
    """The edges of a plate in its own axes: one that stands askew is no larger for it."""

    def __init__(self, corners: np.ndarray) -> None:
        self.axes, self.middle = plate_axes(corners)[:, :2], corners.mean(axis=0)
        self.half = np.abs((corners - self.middle) @ self.axes).max(axis=0)

    def beyond(self, places: np.ndarray) -> np.ndarray:
        """How far places (..., 3) lie beyond the edges along the plate's two axes (m)."""
        return np.abs((places - self.middle) @ self.axes) - self.half


def _lowest(height: np.ndarray) -> float:
    """Lowest of heights (n,); NaN where none is known."""
    return float(np.nanmin(height)) if np.isfinite(height).any() else np.nan


class _Feet:
    """The heels of a trial, the best-seen marker of each side, against one plate."""

    def __init__(self, walk: Walkway, plate: Plate) -> None:
        self.walk, self.plate, self.up = walk, plate, walk.up
        self.markers = {side: walk.trial.markers[name] for side, name in walk.heels.items()}
        others = (p.corners for p in walk.trial.plates if p.usable and p is not plate)
        self.edges = None if plate.corners is None else _Edges(plate.corners)
        self.others = [_Edges(corners) for corners in others if corners is not None]
        self.belt = walk.belts.get(plate.name)
        self.seen: dict[tuple[float, float], dict[str, int]] = {}
        self.lowest = {side: _lowest(m.positions @ self.up) for side, m in self.markers.items()}

    def surface(self, stance: Stance) -> np.ndarray:
        """Velocity (3,) of the surface under a stance (m/s)."""
        return np.zeros(3) if self.belt is None else self.belt.velocity(stance.contact)

    def over(self, edges: _Edges, places: np.ndarray) -> np.ndarray:
        """Mask of places (n, 3) over the plate, up to 20 mm beyond where no other plate lies."""
        beyond = edges.beyond(places).max(axis=1)
        inside = beyond <= 0.02
        beside = np.flatnonzero(inside & (beyond > 0.0))
        for other in self.others if len(beside) else ():
            inside[beside] &= other.beyond(places[beside]).max(axis=1) > 0.0
        return inside

    def on_plate(self, stance: Stance) -> dict[str, int]:
        """Frames of the sides whose heel stays over the plate, low and slow, for 100 ms."""
        span = stance.contact, stance.toe_off
        if span in self.seen or self.edges is None:
            return self.seen.get(span, {})
        frames = self.seen[span] = {}
        for side, marker in self.markers.items():
            near = frames_between(marker.time, stance.contact, stance.toe_off, beside=1)
            time, at = marker.time[near], marker.positions[near]
            if len(at) < 2:
                continue
            inside = (time >= stance.contact) & (time <= stance.toe_off)
            inside &= np.isfinite(at).all(axis=1) & self.over(self.edges, at)
            inside &= at @ self.up < self.lowest[side] + 0.06
            velocity = np.gradient(at, 1.0 / marker.rate, axis=0) - self.surface(stance)
            speed = np.linalg.norm(velocity, axis=1)
            inside &= np.nan_to_num(speed, nan=9.0) < 0.8
            if inside.sum() >= 0.1 * marker.rate:
                frames[side] = int(inside.sum())
        return frames

    def foot(self, stance: Stance) -> tuple[str, str]:
        """Side and heel marker of the foot on the plate."""
        seen = self.on_plate(stance)
        side = max(seen, key=lambda key: seen[key]) if seen else self.landing(stance)
        # Without corners: the heel nearest to where the centre of pressure begins.
        early = self.early(stance, max(5, (stance.stop - stance.start) // 5))
        distance, end = 0.15, stance.contact + 0.2 * stance.duration
        for name, marker in self.markers.items() if not side and len(early) else ():
            at = marker.positions[frames_between(marker.time, stance.contact, end)]
            at = at[np.isfinite(at).all(axis=1)]
            if len(at):
                away = self.flat(np.median(at, axis=0), early)
                if away < distance:
                    side, distance = name, away
        return (side, self.walk.heels[side]) if side else ("unknown", "")

    def early(self, stance: Stance, samples: int) -> np.ndarray:
        """Centres of pressure (n, 3) of the first samples of a stance, where there are any."""
        place = self.plate.centre_of_pressure
        if place is None:
            return np.empty((0, 3))
        early = place[stance.start : stance.start + samples]
        return early[np.isfinite(early).all(axis=1)]

    def flat(self, place: np.ndarray, early: np.ndarray) -> float:
        """Distance (m) in the floor's plane of a place (3,) and the first centres of pressure."""
        gap = place - np.median(early, axis=0)
        return float(np.linalg.norm(gap - (gap @ self.up) * self.up))

    def outside(self, stance: Stance) -> float:
        """How far outside the plate (m) a heel stands within a foot's length of the first pressure.

        Zero when a heel stands on the plate, or when nothing is known. Standing: low and slow for
        40 ms from contact.
        """
        early = self.early(stance, max(5, round(0.05 * self.plate.rate)))
        if self.edges is None or not len(early) or self.on_plate(stance):
            return 0.0
        most = 0.0
        for side, marker in self.markers.items():
            near = frames_between(marker.time, stance.contact, stance.contact + 0.04)
            time, at = marker.time[near], marker.positions[near]
            inside = np.isfinite(at).all(axis=1)
            if inside.sum() < 2:
                continue
            stand = np.median(at[inside], axis=0)
            carried = np.outer(time[inside] - stance.contact, self.surface(stance))
            speed = float(np.linalg.norm(np.ptp(at[inside] - carried, axis=0))) / 0.04
            low = float(stand @ self.up - self.lowest[side]) < 0.06
            if speed < 0.8 and low and self.flat(stand, early) < _FOOT_LENGTH:
                most = max(most, float(np.linalg.norm(np.maximum(self.edges.beyond(stand), 0.0))))
        return most

    def landing(self, stance: Stance) -> str:
        """Side of the lower of the heels low over the plate at contact: a slipping heel is fast."""
        best, lowest = "", 0.06
        for side, marker in self.markers.items() if self.edges else ():
            most = max(0.03, 1.0 / marker.rate)
            near = frames_between(marker.time, stance.contact - most, stance.contact + most)
            at = marker.positions[near]
            at = at[
                (np.abs(marker.time[near] - stance.contact) < most) & np.isfinite(at).all(axis=1)
            ]
            if not len(at):
                continue
            place = np.median(at, axis=0)
            lift = float(place @ self.up - self.lowest[side])
            if self.edges and lift < lowest and (self.edges.beyond(place) <= 0.1).all():
                best, lowest = side, lift
        return best
