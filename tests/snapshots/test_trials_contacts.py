"""Which contacts are steps, whose foot it is and what edits change: each limit on both sides."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from underfoot.core.remark import Message
from underfoot.trials.recording.axes import LEVEL, Direction
from underfoot.trials.recording.trial import Edit
from underfoot.trials.walking import events as check
from underfoot.trials.walking.events import EditError, Stance, edited_contacts

UP, ON, RATE = np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0]), 1000.0
CORNERS = np.array([[0, 0, 0], [0.6, 0, 0], [0.6, 0.4, 0], [0, 0.4, 0]])


def plate(count=2000, **more) -> Any:
    force = np.zeros((count, 3))
    given = {
        "name": "one",
        "force": force,
        "rate": RATE,
        "start": 0.0,
        "saturated": "",
        "corners": CORNERS,
        "centre_of_pressure": None,
        "usable": True,
        "problem": "",
    }
    return SimpleNamespace(**(given | more))


def walk_of(*plates, weight=None, **more) -> Any:
    trial = SimpleNamespace(plates=plates, markers={}, channels={}, **more)
    weight = weight and SimpleNamespace(newtons=weight)
    return SimpleNamespace(trial=trial, up=UP, weight=weight, axes=SimpleNamespace(ramp=LEVEL),
                           heels={}, belts={})  # fmt: skip


def stance(start, stop, peak=800.0, number=1, name="one", **more):
    given = {"direction": Direction(ON), **more}
    return Stance(name, start, stop, start / RATE, stop / RATE, peak, number=number, **given)


NOBODY: Any = SimpleNamespace(on_plate=lambda _: {}, up=UP, outside=lambda _: 0.0)


def reason(duration=0.7, peak=800.0, *, weight=None, braking=1.0, start=500, others=(), usual=0.0,
           feet=None, mean=None, **more):  # fmt: skip
    """Why a contact is no step; it brakes with as much of what is asked for as ``braking``."""
    count = round(duration * RATE)
    made = plate(start + count + more.pop("after", 500), **more.pop("plate", {}))
    part = made.force[start : start + count]
    part[:, 2] = mean or 0.8 * peak
    part[count // 4, 2] = peak
    part[: count // 2, 0] = -braking * 0.01 * peak * duration / (count // 2 / RATE)
    if "spoil" in more:
        part[5, 1] = more.pop("spoil")
    feet = feet or NOBODY
    feet = SimpleNamespace(**{**vars(feet), "plate": made, "walk": walk_of(made)})
    judged = stance(start, start + count, peak, **more)
    walk = walk_of(made, weight=weight)
    return str(check._reason(walk, judged, list(others), usual, feet))


def test_what_is_a_step_and_why_others_are_none():
    assert reason(braking=1.01) == ""
    assert "no braking" in reason(braking=0.99)
    assert reason(0.351, braking=2) == ""
    assert "349 ms" in reason(0.349, braking=2)
    assert reason(1.499, braking=2) == ""
    assert "1.50 s" in reason(1.501, braking=2)
    assert reason(start=0, braking=2) == "begins before the record"
    assert reason(start=0, braking=2, by_hand=("contact",)) == ""
    assert reason(after=0, braking=2) == "ends after the record"
    assert reason(after=1, braking=2) == ""
    assert reason(spoil=np.nan, braking=2) == "samples without a number"
    assert reason(plate={"saturated": "yes"}, braking=2) == "the plate is saturated"
    other = stance(543, 900, number=2, name="two")
    assert "43 ms from the contact on two" in reason(others=(other,), braking=2)
    assert "no walking direction" in reason(braking=2, direction=Direction())
    why = Direction(explanation=Message("nobody said"))
    assert reason(braking=2, direction=why) == "no walking direction: nobody said"


def test_peaks_that_are_too_low_or_too_high():
    assert reason(peak=0.701 * 800, weight=800.0, braking=2) == ""
    assert "70 % of body weight" in reason(peak=0.699 * 800, weight=800.0, braking=2)
    assert reason(peak=0.631 * 800, usual=800.0, braking=2) == ""
    assert "of the usual peak" in reason(peak=0.629 * 800, usual=800.0, braking=2)
    peak, mean = 800.0, 800.0 / 2.19
    assert reason(mean=mean, braking=2) == ""
    assert "2.2 times the mean" in reason(mean=peak / 2.22, braking=2)
    assert reason(peak=1.99 * 800, weight=800.0, braking=2) == ""
    assert "2.0 times body weight" in reason(peak=2.01 * 800, weight=800.0, braking=2)


def test_feet_that_are_two_or_stand_beside_the_plate():
    both = SimpleNamespace(**{**vars(NOBODY), "on_plate": lambda _: {"left": 9, "right": 9}})
    assert reason(feet=both, braking=2) == "both heels are on the plate"
    for way, words in ((0.049, ""), (0.051, "51 mm outside the plate")):
        beside = SimpleNamespace(**{**vars(NOBODY), "outside": lambda _, way=way: way})
        text = reason(feet=beside, braking=2)
        assert words in text
        assert bool(text) == bool(words)


@pytest.mark.parametrize(
    ("along", "across", "markers", "belt", "two"),
    [
        (0.359, 0.0, False, 0.0, False), (0.361, 0.0, False, 0.0, True),
        (0.2, 0.189, False, 0.0, False), (0.2, 0.191, False, 0.0, False),
        (0.2, 0.241, False, 0.0, True), (0.2, 0.239, True, 0.0, False),
        (0.2, 0.241, True, 0.0, True), (0.9, 0.0, False, -1.0, False),
    ],
)  # fmt: skip
def test_how_far_the_pressure_of_a_foot_moves(along, across, markers, belt, two):
    made = plate()
    made.force[500:1200, 2] = 800.0
    share = np.linspace(0, 1, 700)
    made.centre_of_pressure = np.full((2000, 3), np.nan)
    # across it swings, so that both ends are far from the line
    made.centre_of_pressure[500:1200] = np.column_stack(
        [along * share * (belt == 0) + belt * share * 0.7, across * share**2, 0 * share]
    )
    feet = SimpleNamespace(
        on_plate=lambda _: {}, plate=made, up=UP, walk=walk_of(made),
        surface=lambda _: np.array([belt, 0.0, 0.0]),
    )  # fmt: skip
    feet.walk.trial.markers = {"a": 1} if markers else {}
    text = str(check._two_feet(stance(500, 1200), feet))
    limit = along > 0.36 or across > 0.14 + 0.5 * along * (1.0 if markers else 0.5)
    assert bool(text) == (two if belt else limit)
    made.centre_of_pressure[509:1200] = np.nan  # nine places are left
    assert str(check._two_feet(stance(500, 1200), feet)) == ""


def marker(path, rate=100.0) -> Any:
    path = np.asarray(path, float)
    return SimpleNamespace(positions=path, rate=rate, time=np.arange(len(path)) / rate)


def feet_of(made, heels, **more) -> Any:
    walk = walk_of(made, *more.pop("others", ()))
    walk.heels = {side: f"{side} heel" for side in heels}
    walk.trial.markers = {f"{side} heel": one for side, one in heels.items()}
    walk.belts = more.pop("belts", {})
    return check._Feet(walk, made)


def at(x=0.3, y=0.2, z=0.05, speed=0.0, frames=200):
    """A heel that is still at a place, or passes over it at an even speed along the plate."""
    time = np.arange(frames) / 100.0
    path = np.column_stack([x + speed * (time - 0.85), y + 0 * time, z + 0 * time])
    path[0] = [5.0, 5.0, 0.05]  # where it stood lowest
    return marker(path)


def test_a_heel_stands_on_a_plate_where_it_is_near_low_and_slow():
    span = stance(500, 1200)
    for place, stands in (
        ({}, True), ({"x": 0.619}, True), ({"x": 0.621}, False), ({"y": -0.019}, True),
        ({"y": -0.021}, False), ({"z": 0.109}, True), ({"z": 0.111}, False),
        ({"speed": 0.79}, True), ({"speed": 0.81}, False),
    ):  # fmt: skip
        feet = feet_of(plate(), {"left": at(**place)})
        assert bool(feet.on_plate(span)) == stands, place
    beside = plate(name="two", corners=CORNERS + 0.61 * ON)
    feet = feet_of(plate(), {"left": at(x=0.615)}, others=(beside,))
    assert not feet.on_plate(span)
    assert feet_of(plate(), {"left": at(x=0.605)}, others=(beside,)).on_plate(span)
    # on for a tenth of a second: ten frames at 100 Hz
    for frames, stands in ((12, True), (11, False)):
        path = at().positions
        path[:, 0] = 3.0
        path[60 : 60 + frames, 0] = 0.3
        made = feet_of(plate(), {"left": marker(path)})
        # it is fast in its first and last frame, and must stand for ten
        assert bool(made.on_plate(span)) == stands
    assert feet_of(plate(corners=None), {"left": at()}).on_plate(span) == {}


def test_on_a_belt_a_heel_is_slow_that_goes_with_it():
    belt = SimpleNamespace(velocity=lambda _: np.array([-0.9, 0.0, 0.0]))
    span = stance(500, 700)
    for speed, stands in ((-0.9, True), (-0.11, True), (-0.09, False), (0.0, False)):
        made = feet_of(plate(), {"left": at(speed=speed)}, belts={"one": belt})
        made.plate.name = "one"
        assert bool(made.on_plate(span)) == stands, speed


def test_whose_heel_is_low_over_the_plate_at_contact():
    span = stance(500, 1200)
    for place, side in (
        ({"z": 0.109}, "left"),
        ({"z": 0.111}, ""),
        ({"x": 0.699}, "left"),
        ({"x": 0.701}, ""),
        ({"y": -0.099}, "left"),
        ({"y": -0.101}, ""),
    ):
        assert feet_of(plate(), {"left": at(**place)}).landing(span) == side
    both = feet_of(plate(), {"left": at(z=0.09), "right": at(z=0.08)})
    assert both.landing(span) == "right"


def test_without_corners_the_heel_nearest_to_the_first_pressure_is_the_foot():
    made = plate(corners=None)
    made.centre_of_pressure = np.tile([0.3, 0.2, 0.0], (2000, 1))
    span = stance(500, 1200)
    for x, side in ((0.449, "left"), (0.451, "unknown")):
        found = feet_of(made, {"left": at(x=x, z=0.4)}).foot(span)
        assert found == (side, "left heel" if side == "left" else "")
    near = feet_of(made, {"left": at(x=0.4), "right": at(x=0.35)})
    assert near.foot(span) == ("right", "right heel")
    assert len(near.early(span, 7)) == 7


def test_how_far_outside_a_plate_a_heel_stands():
    made = plate()
    made.centre_of_pressure = np.tile([0.58, 0.2, 0.0], (2000, 1))
    span = stance(500, 1200)
    for place, outside in (({"x": 0.7}, 0.1), ({"x": 0.938}, 0.338), ({"x": 0.942}, 0.0),
                           ({"x": 0.7, "y": 0.44}, np.hypot(0.1, 0.04)), ({"x": 0.3}, 0.0),
                           ({"x": 0.7, "z": 0.111}, 0.0)):  # fmt: skip
        assert feet_of(made, {"left": at(**place)}).outside(span) == pytest.approx(outside)
    nobody = feet_of(plate(), {"left": at(x=0.7)})
    assert nobody.outside(span) == 0.0


def test_edges_of_a_plate_that_stands_askew():
    c, s = np.cos(0.4), np.sin(0.4)
    turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    edges = check._Edges(CORNERS @ turn.T + [1.0, 2.0, 0.0])
    assert sorted(edges.half) == pytest.approx([0.2, 0.3])
    place = (np.array([0.65, 0.1, 0.0]) @ turn.T) + [1.0, 2.0, 0.0]
    assert sorted(edges.beyond(place)) == pytest.approx([-0.1, 0.05])


PLATES: dict[str, Any] = {"one": plate(), "two": plate(name="two")}
PLATES["one"].force[:, 2] = np.arange(2000.0)


def edited(*edits, contacts=None):
    contacts = contacts or [stance(500, 1200, number=1), stance(560, 1300, number=2, name="two"),
                            stance(1500, 1900, number=3)]  # fmt: skip
    told = [Edit(step, what, value, "seen", "row 2") for step, what, value in edits]
    return edited_contacts(contacts, told,
                           PLATES, UP)  # fmt: skip


def test_edits_name_steps_by_number_or_time():
    for step, number in (
        (1, 1),
        (0.201, 1),
        (0.499, 1),
        (0.54, 2),
        (1.19, 2),
        (1.9, 3),
        (1.201, 3),
    ):
        made = edited((step, "exclude", None))
        (gone,) = [one.number for one in made if one.reason]
        assert gone == number, step
        assert made[gone - 1].by_hand == ("exclude",)
    for step in (0.199, 1.901, 4):
        with pytest.raises(EditError, match="there is no step"):
            edited((step, "exclude", None))


def test_edits_of_times_sides_and_plates():
    moved = edited((1, "contact", 0.6), (1, "toe off", 1.1))[0]
    assert (moved.start, moved.stop, moved.contact, moved.toe_off) == (600, 1100, 0.6, 1.1)
    assert (moved.peak, moved.by_hand) == (1099.0, ("contact", "toe off"))
    for wrong, words in (
        ((1, "contact", 0.5004), "changes nothing"), ((1, "toe off", 1.2), "changes nothing"),
        ((1, "contact", 1.199), "end before it begins"),
        ((1, "contact", 2.0), "outside the record"),
        ((1, "contact", -0.001), "outside the record"), ((3, "plate", "one"), "on one alone"),
        ((1, "plate", "four"), "plate with a contact"),
    ):  # fmt: skip
        with pytest.raises(EditError, match=words):
            edited(wrong)
    assert edited((1, "contact", 1.198))[0].start == 1198
    assert edited((3, "toe off", 1.999))[2].stop == 1999
    side = edited((1, "side", "left"))[0]
    assert (side.side, side.heel, side.by_hand) == ("left", "", ("side",))
    with pytest.raises(EditError, match="the left foot already"):
        edited((1, "side", "left"), contacts=[stance(500, 1200, side="left")])
    on_two = edited((1, "plate", "two"))
    assert [bool(one.reason) for one in on_two] == [True, False, False]
    assert [one.by_hand for one in on_two] == [("plate",), ("plate",), ()]
    apart = [stance(500, 1200), stance(601, 1300, number=2, name="two")]
    with pytest.raises(EditError, match="plate with a contact"):
        edited((1, "plate", "two"), contacts=apart)
    for pair in ((("contact", 0.6), ("contact", 0.7)), (("exclude", None), ("contact", 0.7)),
                 (("contact", 0.7), ("exclude", None))):  # fmt: skip
        with pytest.raises(EditError, match="contradicts row 2"):
            edited(*((1, *one) for one in pair))
