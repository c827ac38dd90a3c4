"""Rows of places, of machines and of what tells two apart, by small answers made by hand."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.core import SourcedValue
from underfoot.core.presentation import probability_text
from underfoot.places import choice
from underfoot.places.calibration import FloorCalibration
from underfoot.places.choice import BINS, ShoeAnswer, ShoeChoice, _floors, _measurements
from underfoot.places.machines import MachinePrediction
from underfoot.questions import comparison, separation
from underfoot.questions.order import Order, OrderVerdict
from underfoot.questions.separation import SeparatingStep, of_conditions


def answer(name, best, *, price=None, months=None):
    shoe = SimpleNamespace(
        name=name, price=price, months=months, readings=(), known_class=None, wear_depth=0.0
    )
    slips = SourcedValue(0.1 * best, "1", interval=(0.05 * best, 0.2 * best))
    return ShoeAnswer(cast(Any, shoe), slips, best, "", "")


def choice_of(*shoes, floors=(), readings_leave=1000.0):
    place = SimpleNamespace(
        name="here", shoes=[one.shoe for one in shoes], floors=floors, assumed=()
    )
    return ShoeChoice(cast(Any, place), shoes, (), (), (), (), shoes[0].shoe.name, readings_leave)


def test_shoes_stand_by_their_chance_whatever_their_order_in_the_place():
    shoes = answer("a", 0.2, price=60.0, months=6), answer("b", 0.7), answer("c", 0.0)
    for given in (shoes, shoes[::-1]):
        table = choice_of(*given).table()
        assert [row[0] for row in table.rows] == ["b", "a", "c"]
        assert list(table.columns)[:2] == ["Shoe", "Best"]
    slips = {row[0]: row[2] for row in table.rows}
    assert slips == {"a": "2.0 %", "b": "7.0 %", "c": probability_text(0.0)}
    prices = {row[0]: row[-2:] for row in table.rows}
    assert prices["a"] == ["60", "10"]  # 60 in six months
    assert prices["b"] == ["", ""]


def test_one_shoe_alone_has_no_chance_of_being_best_and_no_empty_column():
    table = choice_of(answer("a", 1.0)).table()
    assert list(table.columns) == ["Shoe", "Steps in a fluid that slip", "95 %"]


class Device:
    name, title, standard, entry = "m", "M", "S", SimpleNamespace(name="m")


def test_a_floor_with_readings_has_its_roughness_before_and_after_them():
    drawn = {("roughness of floor hall", (1e-6, 4e-6)): np.full(99, 2e-6)}
    joint = SimpleNamespace(drawn_between=lambda name, ends: drawn[name, ends])
    read, unread = (
        SimpleNamespace(name=name, readings=readings)
        for name, readings in (("hall", ("one",)), ("stair", ()))
    )
    place, ends = SimpleNamespace(floors=(read, unread)), {"hall": (1e-6, 4e-6)}
    rows = _floors(cast(Any, place), cast(Any, joint), ends, {"hall": (1e-6, 2.5e-6, 4e-6)})
    assert rows == (("hall", "2.5 (1 to 4)", "2 (2 to 2)"),)


@pytest.mark.parametrize("where", ["floor", "shoe", "class", None])
def test_draws_that_readings_leave_are_told_where_there_are_readings(where):
    machine = Device()
    reading = SimpleNamespace(machine=machine)
    floor = SimpleNamespace(known=True, readings=(reading,) if where == "floor" else ())
    one = answer("a", 1.0)
    if where == "shoe":
        cast(Any, one.shoe).readings = (reading,)
    if where == "class":
        cast(Any, one.shoe).known_class = "SRA"
    told = choice_of(one, floors=(floor,), readings_leave=123.0).remarks()
    assert any("123" in line for line in told["Assumed"]) == (where is not None)
    assert len(told["Machines"]) == (where == "floor")


CLASSES = ((0.0, "high"), (25.0, "moderate"), (36.0, "low"))


def test_the_chance_of_at_least_a_class_is_that_of_it_and_all_above():
    machine = SimpleNamespace(classes=CLASSES, scale=SimpleNamespace(unit="PTV"))
    chances = tuple((label, p) for (_, label), p in zip(CLASSES, (0.2, 0.3, 0.5), strict=True))
    told = MachinePrediction(
        cast(Any, machine), cast(Any, None), (1e-6, 1e-6), True, 1.0, 2.0, 3.0, chances
    )
    assert [tuple(row) for row in told.table().rows] == [
        ("high", "0", "20 %", "100 %"),
        ("moderate", "25", "30 %", "80 %"),
        ("low", "36", "50 %", "50 %"),
    ]


def measured(monkeypatch, slips, cof):
    """Return what a reading of a floor would change, of shoes whose slips (shoes, draws) it tells.

    ``cof`` is what the machine reads in each draw.
    """
    read = {"blank": np.full(cof.size, 0.5) + 1e-9 * np.arange(cof.size) % 7e-9, "hall": cof}
    device = SimpleNamespace(cof=lambda _, name, *__: read[name], fluids=("water",))
    monkeypatch.setattr(choice, "machines", lambda: {choice.CHECKED[0]: device})
    monkeypatch.setattr(choice, "slip_tests", lambda: {choice.CHECKED[1]: None})
    joint = SimpleNamespace(
        count=cof.size,
        constants=SimpleNamespace(sd_reading=0.0),
        normal=lambda name: np.zeros(cof.size),
    )
    floors = [SimpleNamespace(name=name, readings=()) for name in read]
    shoes = [SimpleNamespace(name=str(k), readings=("read",)) for k in range(len(slips))]
    place = SimpleNamespace(floors=floors, shoes=shoes)
    return _measurements(
        cast(Any, place), cast(Any, joint), dict.fromkeys(read, (1e-6, 2e-6)), {}, np.asarray(slips)
    )


def test_a_reading_is_worth_what_the_other_choice_saves_where_it_is_better(monkeypatch):
    count = 100 * BINS
    cof = np.linspace(0.1, 1.0, count)
    rough = np.arange(count) >= count // 2
    first = np.where(rough, 0.4, 0.1)
    second = np.where(rough, 0.1, 0.5)
    one, blank = measured(monkeypatch, [first, second], cof)
    assert one.name.endswith("hall")  # the most first
    assert blank.saves < one.saves
    # now the first (0.25 against 0.3); half of the draws read that the second saves 0.3 there
    assert one.changes == pytest.approx(0.5)
    assert one.saves == pytest.approx(0.5 * 0.3 / 0.25)
    for second in (first + 0.1, first):  # of equals none is another choice
        told = measured(monkeypatch, [first, second], cof)
        assert [(each.changes, each.saves) for each in told] == [(0.0, 0.0)] * 2
    assert measured(monkeypatch, [first], cof) == ()


def test_a_condition_tells_the_order_of_the_first_against_the_second(monkeypatch):
    generator = np.random.default_rng(0)
    normal = 0.05 * generator.standard_normal((2, 4000))
    cofs = {("a", "x"): 0.3, ("b", "x"): 0.2, ("a", "y"): 0.2, ("b", "y"): 0.3, ("a", "z"): None}

    class March:
        def __init__(self, case):
            self.case = case

        def continue_march(self, changes):
            cof = cofs.get((self.case, changes["contaminant"]), 0.3)
            rows = normal[int(self.case == "b")]
            return SimpleNamespace(cof_draws=None if cof is None else cof * np.exp(rows))

    monkeypatch.setattr(separation, "Continuation", March)
    asked = [("fluid", name, {"contaminant": name}) for name in "xyz"]
    monkeypatch.setattr(separation, "_conditions", lambda *_: iter(asked))
    shares = []
    told = of_conditions(cast(Any, "a"), cast(Any, "b"), progress=lambda _, s: shares.append(s))
    assert [one.value for one in told] == ["x", "y"]
    orders = [cast(Order, one.order) for one in told]
    assert [one.verdict for one in orders] == [OrderVerdict.HIGHER, OrderVerdict.LOWER]
    assert all(one.told > 0.99 for one in told)
    assert shares == pytest.approx([0.0, 0.3, 0.6, 0.6 + 0.4 / 3, 0.6 + 0.8 / 3])


@pytest.mark.parametrize("letters", ["ABC", "CAB", "BCA"])
def test_the_two_first_of_a_ranking_are_ordered_as_they_rank(monkeypatch, letters):
    results = [SimpleNamespace(name=one, case_text="") for one in "ABC"]
    asked = []

    def order_of(first, second):
        asked.append(first.name + second.name)
        return Order(0.6, 0.1)  # open

    def separations(two, cases, *_):
        asked.append("".join(one.name for one in two) + "".join(cases))
        return ()

    def cases(*_, **__):
        return next(names)

    for name, new in {
        "Result": SimpleNamespace,
        "Case": SimpleNamespace(from_text=cases),
        "_ranking": lambda _: tuple(SimpleNamespace(letter=one) for one in letters),
        "order_of": order_of,
        "_separations": separations,
        "_quantities": lambda *_: (),
        "case_differences": lambda _: (),
        "_reasons": lambda _: (),
    }.items():
        monkeypatch.setattr(comparison, name, new)
    names = iter("abc")
    comparison.compare(*cast(Any, results))
    top = letters[:2]
    assert asked == [top, top + top.lower()]


def test_what_tells_two_apart_stands_surest_first(monkeypatch):
    given = [SeparatingStep("fluid", str(p), p) for p in (0.6, 0.9, 0.7)]
    monkeypatch.setattr(comparison, "of_conditions", lambda *_, **__: list(given))
    monkeypatch.setattr(comparison, "_shared_draws", lambda *_: (1, 2))
    monkeypatch.setattr(comparison, "of_reading", lambda *_: SeparatingStep("reading", None, 0.8))
    pair = cast(Any, ("a", "b"))
    for separate, order in ((True, [0.9, 0.8, 0.7, 0.6]), (False, [0.8])):
        told = comparison._separations(pair, pair, separate, lambda *_: None)
        assert [one.told for one in told] == order


def test_a_calibrated_floor_says_what_its_readings_leave() -> None:
    before, after = (1e-6, 2e-6, 3e-6), (1.5e-6, 2e-6, 2.5e-6)
    made = FloorCalibration((), cast(Any, SimpleNamespace(outside=())), before, after, 123.4)
    assert made.headline() == (
        "Rq of the floor was 2 um (95 %: 1 to 3) and is 2 um (95 %: 1.5 to 2.5).",
    )
    given = replace(made, before=(2e-6,) * 3)
    assert given.headline() == (
        "The roughness of the floor is given: the reading narrows the law alone.",
    )
    table = made.table()
    assert table.title == "Draws"
    assert [*table.columns] == ["quantity", "value"]
    assert [*map(tuple, table.rows)] == [("equal draws that are left", "123")]
    assert made.cautions() == ()
