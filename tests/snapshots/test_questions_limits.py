"""Questions: what is decided just below and just above each limit, and their numbers by hand."""

import dataclasses
import math
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from test_questions_answers_made_by_hand import TREADED, spread

import made_answers as made
from snapshot import held, refusal
from underfoot.core import SourcedValue, Status
from underfoot.questions import (
    changes,
    comparison,
    contact,
    effects,
    method,
    order,
    outcomes,
    risk,
    sensitivity,
    separation,
    slips,
    walked,
    wear,
    wear_limit,
    worn_states,
)
from underfoot.questions.wear_limit import Crossing, WearPoint
from underfoot.shoe.worn import WearMeasures

WIDE_SOLE = {"shoe.heel.plan": "sole", "shoe.heel.length": "280 mm", "shoe.heel.width": "68 mm",
             "shoe.heel.waist_width": "58 mm", "shoe.heel.ball_width": "100 mm"}  # fmt: skip


def measures(depth=1e-3, left=2e-3, patch=0.0, volume=1e-9):
    return WearMeasures(depth, left, left, patch, 0, 0, volume)


# changes


@pytest.mark.parametrize(
    ("name", "path", "within", "beyond"),
    [
        ("new_tread", "shoe.tread.depth", "1.499 mm", "1.5 mm"),
        ("wider_channels", "shoe.tread.depth", "1.5 mm", "1.499 mm"),
        ("softer_compound", "shoe.material.shore_a", 60.0, 59.9),
        ("abraded_sole", "shoe.roughness.rq", "14.9 um", "15.1 um"),
        ("rougher_floor", "floor.roughness.rq", "2.49 um", "2.51 um"),
        ("rinse", "contaminant.viscosity", "2.01 mPa s", "1.99 mPa s"),
        ("dilute", "contaminant.viscosity", "10.01 mPa s", "9.99 mPa s"),
        ("shorter_steps", "risk.rcof_mean", 0.12, 0.119),
    ],
)
def test_a_change_is_tried_up_to_its_limit(name, path, within, beyond):
    tried = [
        {one.name for one in changes.possible_changes(TREADED.replace(path, value))}
        for value in (within, beyond)
    ]
    assert [name in names for names in tried] == [True, False]


def test_changes_take_what_is_there_as_their_measure():
    case = TREADED.replace(
        {"shoe.tread.channel_width": "4 mm", "shoe.material.shore_a": 70.0,
         "shoe.roughness.rq": "5 um", "risk.rcof_mean": 0.2}
    )  # fmt: skip
    values = {one.name: dict(one.values) for one in changes.possible_changes(case)}
    assert values["wider_channels"]["shoe.tread.channel_width"] == pytest.approx(6e-3)
    assert values["softer_compound"]["shoe.material.shore_a"] == 55.0
    assert values["abraded_sole"] == {
        "shoe.roughness.rq": pytest.approx(1e-5),
        "shoe.roughness.ra": None,
    }
    assert values["shorter_steps"]["risk.rcof_mean"] == pytest.approx(0.17)
    of_modulus = case.replace("shoe.material.modulus", "4 MPa")
    assert "softer_compound" not in {one.name for one in changes.possible_changes(of_modulus)}


# risk


def of_slip(value, low, high, **scalars):
    present = made.outcome()
    numbers = {"slip_probability": spread(value, low, high), **scalars}
    return dataclasses.replace(present, scalars=present.scalars | numbers)


def test_odds_stand_beside_a_rare_slip_that_is_sure_enough():
    told = {
        value: made.assessment(present=of_slip(value, value - 0.01, value + 0.01)).headline()[0]
        for value in (0.199, 0.201)
    }
    assert "1 in 5 steps" in told[0.199]
    assert "steps" not in told[0.201]
    assert risk.odds(0.199) == "1 in 5 steps"
    assert risk.odds(0.201) == "20 % of steps"
    assert risk.odds(1e-3) == "1 in 1000 steps"
    assert risk.odds(9.9e-4) == "fewer than 1 in 1000 steps"
    assert risk.odds(math.nan) == "not determined"


@pytest.mark.parametrize(
    ("own", "other", "target", "apart"),
    [
        (0.5, 0.599, 0.05, False), (0.5, 0.601, 0.05, True), (0.5, 0.401, 0.05, False),
        (0.5, 0.399, 0.05, True), (0.04, 0.049, 0.05, False), (0.04, 0.051, 0.05, True),
        (0.06, 0.049, 0.05, True), (0.05, 0.05, 0.05, False),
    ],
)  # fmt: skip
def test_models_are_apart_by_a_tenth_or_by_the_target(own, other, target, apart):
    found = made.assessment(present=of_slip(own, own / 2, own * 1.1))
    one = dataclasses.replace(found.models[0], probability=other)
    found = dataclasses.replace(found, models=(one,), target=target)
    assert bool(found.apart) is apart
    assert any("Another model" in line for line in found.cautions()) is apart


@pytest.mark.parametrize(
    ("higher", "cof", "slip", "moves", "best"),
    [
        (0.551, 0.12, 0.5, True, True), (0.549, 0.12, 0.5, True, False),
        (None, 0.12, 0.5, True, True), (0.99, 0.12, 0.6, True, False),
        (0.549, 0.12, 0.6, False, False), (0.451, 0.12, 0.6, False, False),
        (0.449, 0.12, 0.6, True, False), (0.99, 0.1004, 0.6, False, False),
        (0.99, 0.1006, 0.6, True, False), (0.99, 0.12, 0.7, True, False),
        (None, 0.12, 0.6, True, False),
    ],
)  # fmt: skip
def test_a_change_counts_where_it_does_something_and_helps(higher, cof, slip, moves, best):
    found = made.assessment(made.change("a", cof, slip, higher=higher))
    assert (len(found.effective), len(found.best)) == (moves, best)
    told = found.remarks()["Tried without effect"]
    assert len(told) == (not moves)
    assert len(found.table().rows) == moves
    assert found.to_dict()["changes"][0]["does_something"] is moves


def test_the_best_changes_come_first_and_three_of_them_are_told():
    found = made.assessment(*(made.change(f"c{k}", 0.2, 0.1 * k) for k in (5, 2, 4, 1, 3)))
    assert [one.change.name for one in found.best] == ["c1", "c2", "c3", "c4", "c5"]
    assert [line.partition(":")[0] for line in found.change_sentences()] == ["do c1", "do c2",
                                                                             "do c3"]  # fmt: skip
    assert len(found.change_sentences(most=4)) == 4
    assert [row[:2] for row in found.table().rows[:2]] == [("1.", "do c1"), ("2.", "do c2")]
    walking = made.change("w", 0.2, 0.1, higher=0.1)
    walking = dataclasses.replace(walking, change=dataclasses.replace(walking.change,
                                                                      lever="walking"))  # fmt: skip
    assert len(made.assessment(walking).best) == 1


@pytest.mark.parametrize(("value", "enough"), [(0.05, True), (0.0501, False)])
def test_friction_is_enough_up_to_the_target(value, enough):
    found = made.assessment(present=of_slip(value, value / 2, value * 1.2))
    assert ("sufficient" in found.headline()[-1]) is enough


# wear


@pytest.mark.parametrize(
    ("cofs", "bare", "rises"),
    [
        ((0.1, 0.1051), None, True), ((0.1, 0.1049), None, False), ((0.1, 0.12, 0.11), None, False),
        ((0.1, 0.12), 0.05, False), ((None, 0.1, 0.12), None, True),
        ((0.1, 0.12, None), None, False), ((0.12, 0.1, 0.13), None, True),
    ],
)  # fmt: skip
def test_a_series_that_still_rises_at_its_end_says_so(cofs, bare, rises):
    series = made.wear(cofs, untreaded=None if bare is None else made.outcome(bare))
    assert any("still rises" in line for line in series.cautions()) is rises


@pytest.mark.parametrize(
    ("cofs", "bare", "told"),
    [
        ((0.1, 0.12), 0.05, "0.050 with the tread gone; shortly before that 0.120"),
        ((0.1, 0.12), 0.11, "0.120 at the last state; 0.110 if that sole had no tread"),
        ((0.12, 0.1), 0.05, "0.100 at the last state; 0.050 if that sole had no tread"),
        ((0.1, 0.12), None, "COF 0.100 new and 0.120 at the last state."),
        ((None, 0.1, 0.12), 0.05, "at state 1 and 0.120 at state 2; 0.050 if"),
        ((0.1, 0.12, None), 0.05, "at state 0 and 0.120 at state 1; 0.050 if"),
        ((0.1, None, 0.12), 0.05, "COF 0.100 new and 0.120 at the last state; 0.050 if"),
        ((None, 0.1), 0.05, "COF 0.050 if that sole had no tread at all."),
        ((0.1, 0.1), 0.05, "COF 0.100 new and 0.100 at the last state; 0.050"),
    ],
)
def test_a_series_tells_the_friction_of_its_ends(cofs, bare, told):
    series = made.wear(cofs, untreaded=None if bare is None else made.outcome(bare))
    assert told in series.headline()[2]


@pytest.mark.parametrize(
    ("cofs", "bare", "agrees"),
    [
        ((0.1, 0.12, 0.1), None, True), ((0.1, 0.1006, 0.1), None, True),
        ((0.1, 0.1004, 0.09), None, False), ((0.1, 0.12, 0.1196), None, False),
        ((0.1, 0.12, 0.11, 0.1104, 0.1), None, True), ((0.1, 0.12, 0.11, 0.1106, 0.1), None, False),
        ((0.1, 0.12), 0.1, True), ((0.1, None), 0.1, None), ((0.12, 0.11, 0.1), None, False),
        ((0.1, 0.11, 0.12), None, False),
    ],
)  # fmt: skip
def test_friction_rises_first_by_more_than_is_printed(cofs, bare, agrees):
    series = made.wear(cofs, untreaded=None if bare is None else made.outcome(bare))
    assert wear.trends(series)[2].agrees is agrees


@pytest.mark.parametrize(
    ("loads", "late"),
    [
        ((10, 10, 10, 10, 90), True), ((10, 20, 49, 60, 90), True), ((10, 20, 51, 60, 90), False),
        ((10, 80, 10, 60, 90), False), ((10, 49, 90), True), ((10, 51, 90), False),
        ((90, 20, 20, 20, 10), None), ((10, 90), False), ((10, 20, 20, 51, 60, 90), True),
        ((10, 20, 51, 51, 60, 90), False), ((90, 90), None),
    ],
)  # fmt: skip
def test_a_load_rises_late_where_half_of_the_wear_brings_less_than_half_of_it(loads, late):
    points = tuple(WearPoint(measures(), made.outcome(fluid=10.0 * load)) for load in loads)
    series = dataclasses.replace(made.wear(), points=points)
    assert wear.trends(series)[3].agrees is late


def test_worn_regions_are_ranked_from_the_last_state_without_one():
    patches, peaks, cofs = (0, 0, 0, 1, 2, 3), (9, 8, 1, 2, 3, 4), (1, 2, 0.6, 0.5, 0.4, 0.3)
    points = []
    for patch, peak, cof in zip(patches, peaks, cofs, strict=True):
        one = made.outcome(cof)
        sensed = {"peak_fluid_pressure_sensor": SourcedValue(1e5 * peak, "Pa")}
        one = dataclasses.replace(one, scalars=one.scalars | sensed)
        points.append(WearPoint(measures(patch=1e-4 * patch), one))
    series = dataclasses.replace(made.wear(), points=tuple(points))
    larger, less, *_ = wear.trends(series)
    assert (larger.correlation, larger.agrees) == (pytest.approx(1.0), True)
    assert (less.correlation, less.agrees) == (pytest.approx(-1.0), True)
    short = dataclasses.replace(series, points=series.points[:4])
    assert wear.trends(short)[0].correlation is None
    three = dataclasses.replace(series, points=series.points[:5])
    assert wear.trends(three)[0].correlation == pytest.approx(1.0)


def test_pressures_of_a_state_lie_on_the_cells_of_its_sole():
    """A sole 3 by 2 at the places of a map shifted by one: what is outside stays unknown."""
    along, across = np.array([2e-3, 3e-3, 4e-3]), np.array([0.0, 1e-3])
    x, y = np.array([1e-3, 2e-3, 3.4e-3, 4.6e-3]), np.array([-1e-3, 0.4e-3, 1e-3, 2e-3])
    inside = np.ones((4, 4), bool)
    inside[1, 1] = False
    sole: Any = SimpleNamespace(y=y, inside=inside)
    field = 10.0 * np.arange(3)[:, None] + np.arange(2)
    maps = {"x": along, "y": across, "contact_pressure": field, "fluid_pressure": 100 + field}
    outcome = dataclasses.replace(made.outcome(), maps=maps)
    with pytest.MonkeyPatch.context() as patch:
        placed = np.repeat(x[:, None], 4, axis=1)
        patch.setattr("underfoot.shoe.place_on_floor", lambda of, angle: placed)
        seen = wear.maps_on_sole(sole, outcome, 0.1)
        lost = dataclasses.replace(outcome, status=Status.NOT_CONVERGED)
        unknown = wear.maps_on_sole(sole, lost, 0.1)
    nan = math.nan
    expected = [[nan] * 4, [nan, nan, 1.0, nan], [nan, 10.0, 11.0, nan], [nan] * 4]
    np.testing.assert_array_equal(seen["contact_pressure"], expected)
    np.testing.assert_array_equal(seen["fluid_pressure"], 100 + np.array(expected))
    assert np.isnan(unknown["contact_pressure"]).all()


def test_a_series_without_maps_has_the_shapes_of_its_soles_alone(file_regression):
    cells = {name: np.arange(6.0).reshape(3, 2) + k
             for k, name in enumerate(("height", "land", "tread_depth"))}  # fmt: skip
    sole = SimpleNamespace(x=np.arange(3.0), y=np.arange(2.0), **cells)
    series = dataclasses.replace(made.wear(), soles=cast(Any, (sole,) * 4))
    bare, mapped = series.fields(), None
    shown = {"contact_pressure": np.ones((3, 2)), "fluid_pressure": np.full((3, 2), 2.0)}
    mapped = dataclasses.replace(series, maps=(shown,) * 4).fields()
    held(file_regression, {
        "bare": sorted(bare.data_vars), "of": bare["height"].values,
        "mapped": {name: (mapped[name].attrs, mapped[name].values)
                   for name in mapped.data_vars},
        "state": mapped["state"].values,
    })  # fmt: skip


EXTENTS = {
    "heel": ({}, 1.0),
    "sole": (WIDE_SOLE, worn_states.HEEL_PART),
}


@pytest.mark.parametrize("name", EXTENTS)
def test_the_heel_of_a_whole_sole_is_a_part_of_it(name):
    changed, part = EXTENTS[name]
    case = TREADED.replace(changed)
    depth, length, width = worn_states.tread_and_heel(case)
    heel: Any = case.shoe.heel
    assert (depth, length) == (case.value("shoe.tread.depth"), pytest.approx(heel.length * part))
    assert width == heel.width
    last = worn_states.worn_cases(case, "patch", 4, None)[-1]
    assert last.value("shoe.wear.patch_length") == pytest.approx(0.8 * length)
    assert last.value("shoe.wear.patch_width") == pytest.approx(0.8 * width)
    areas = [
        one.value("shoe.wear.patch_length") * one.value("shoe.wear.patch_width")
        for one in worn_states.worn_cases(case, "patch", 4, 1e-4)[1:]
    ]
    # an ellipse: even steps of its area
    assert np.pi / 4 * np.array(areas) == pytest.approx([0.25e-4, 0.5e-4, 0.75e-4, 1e-4])


@pytest.mark.parametrize(("long", "part", "wide"), [(0.1199, 1.0, 1.0), (0.1201, 0.25, 0.65)])
def test_a_file_longer_than_a_heel_is_a_sole(monkeypatch, long, part, wide):
    surface = SimpleNamespace(length=long, width=0.08, tread_depth=np.array([[1e-3, 3e-3]]))
    monkeypatch.setattr(
        "underfoot.compute.sole.file_outsole", lambda _: SimpleNamespace(surface=surface)
    )
    case: Any = SimpleNamespace(shoe=SimpleNamespace(heel=None, outsole=object()))
    assert worn_states.tread_and_heel(case) == (
        3e-3,
        pytest.approx(long * part),
        pytest.approx(0.08 * wide),
    )
    told = refusal(wear.wear_series, case, mode="archard")
    assert "needs a parametric sole" in told


def test_series_end_where_the_sole_allows(file_regression):
    thick = TREADED.replace({"shoe.sole.outsole_thickness": "20 mm", "shoe.tread.depth": "3 mm"})
    thin = TREADED.replace({"shoe.sole.outsole_thickness": "5 mm", "shoe.tread.depth": "3 mm"})

    def depths(case, mode, steps=2, deepest=None):
        return [
            one.value("shoe.wear.depth")
            for one in worn_states.worn_cases(case, mode, steps, deepest)
        ]

    assert depths(thick, "plane") == pytest.approx([0, 1.5e-3, 3e-3])
    assert depths(thick, "walk") == pytest.approx([0, 3.6e-3, 7.2e-3])
    assert depths(thick, "archard") == pytest.approx([0, 2.4e-3, 4.8e-3])
    assert depths(thin, "walk")[-1] == pytest.approx(4e-3)  # midway between tread and sole
    assert depths(thick, "walk", 1, 19.9e-3)[-1] == pytest.approx(19.9e-3)
    assert "deeper than the sole" in refusal(depths, thick, "walk", 1, 20e-3)
    turned = thick.replace("motion.shoe_angle", "-5 deg")
    given = thick.replace({"shoe.wear.mode": "plane", "shoe.wear.angle": "9 deg",
                           "shoe.wear.depth": "1 mm"})  # fmt: skip
    angles = [
        math.degrees(worn_states.worn_cases(one, "plane", 1, None)[-1].value("shoe.wear.angle"))
        for one in (thick.replace("motion.shoe_angle", "7 deg"), turned, given)
    ]
    assert angles == pytest.approx([7.0, 0.0, 9.0])
    case = worn_states.worn_cases(thick, "walk", 1, None)[-1]
    held(file_regression, {
        mode: wear._assumptions(worn_states.worn_cases(thick, mode, 1, None)[-1], mode,
                                sensitivity.open_inputs(case)[:1])
        for mode in worn_states.MODES
    })  # fmt: skip


def test_shapes_are_worn_in_the_order_of_their_depth(monkeypatch):
    worn: list[float] = []
    heard: list[Any] = []
    monkeypatch.setattr("underfoot.compute.sole.archard_state",
                        lambda case: worn.append(case.shoe.wear.depth))  # fmt: skip
    cases: Any = [SimpleNamespace(shoe=SimpleNamespace(wear=SimpleNamespace(depth=depth)))
                  for depth in (3e-3, 0.0, 1e-3, 2e-3, 0.0, 4e-3)]  # fmt: skip
    worn_states.wear_down(cases, lambda stage, share, *more: heard.append((stage, share)))
    assert worn == [1e-3, 2e-3, 3e-3, 4e-3]
    assert heard == [("Wearing the sole", share) for share in (0.0, 0.25, 0.5, 0.75)]
    told = []

    def outcomes_of(plan, **options):
        options["progress"]("Simulating the worn soles", 0.0)
        told.append(len(plan))
        raise RuntimeError("enough")

    monkeypatch.setattr(wear, "outcomes", outcomes_of)
    worn.clear()
    heard.clear()

    def hear(stage, share, *_):
        heard.append((stage, share))

    options: Any = {"steps": 2, "band": False, "progress": hear}
    for mode, first in (("archard", 0.1), ("plane", 0.0)):
        assert "enough" in refusal(wear.wear_series, TREADED, mode=mode, **options)
        assert heard[-1] == ("Simulating the worn soles", pytest.approx(first))
    assert len(worn) == 2
    assert heard[:2] == [("Wearing the sole", 0.0), ("Wearing the sole", pytest.approx(0.05))]
    assert told == [4, 4]


def test_sizes_of_a_tread_have_three_figures():
    assert [wear._short(v) for v in (99.94, 100.0, 123.4, -123.4, 0.01234)] == [
        "99.9", "100", "123", "-123", "0.0123"]  # fmt: skip
    assert wear._interval([2e-3, 1e-3, math.inf], "m") == "2 mm (90 %: 1 to beyond the range)"
    assert wear._interval([2e-4, 1e-4, 3e-4], "m^2") == "200 mm² (90 %: 100 to 300)"


def test_a_pair_that_lost_as_much_as_the_series_is_taken(monkeypatch):
    asked: list[Any] = []

    def stop(*args, **options):
        asked.append(options)
        raise RuntimeError("enough")

    monkeypatch.setattr(wear, "outcomes", stop)
    options: Any = {"mode": "plane", "steps": 2, "deepest": 1e-3, "band": False}
    for lost, taken in ((1e-3, True), (1.001e-3, False)):
        told = refusal(wear.wear_series, TREADED, pair=walked.WornPair(lost, 1e5), **options)
        assert ("enough" in told) is taken
    force = TREADED.motion.normal_force
    for limit, taken in ((force * 0.999, True), (force, False), (1e-3, True), (0.0, False)):
        told = refusal(wear.wear_series, TREADED, limit=limit, **options)
        assert ("enough" in told) is taken
    told = refusal(wear.wear_series, TREADED, **{**options, "steps": 1})
    assert "make no series" in told
    assert asked[0]["quick"]
    assert asked[0]["processes"] == 1


# walks


def test_walks_by_hand():
    """k F s = 1e-15 * 180 * s: of 1e-9 m^3 441 to 2525 km of sliding steps."""
    rate = walked.WearWalker(1e-15).walk_until(1e-9, [], [])
    landings = [1e-9 / (1e-15 * 180 * s) for s in (12.6e-3, 2.2e-3)]
    assert rate.distance == pytest.approx((2 * landings[0] * 0.5, 2 * landings[1] * 0.75))
    month = 365.25 / 12
    assert rate.months == pytest.approx(
        (2 * landings[0] / 18000 / month, 2 * landings[1] / 4000 / month)
    )
    series = [0.0, 1e-9, 4e-9], [0.0, 1e-3, 2e-3]
    way = walked.WearWalker(1e-15, walked.WornPair(1.5e-3, 5e5)).walk_until(1e-9, *series)
    assert way.distance == pytest.approx((2e5, 2e5))
    assert way.months == pytest.approx((2e5 / 0.75 / 18000 / month, 2e5 / 0.5 / 4000 / month))
    time = walked.WearWalker(1e-15, walked.WornPair(1.5e-3, None, 5.0)).walk_until(1e-9, *series)
    assert time.months == pytest.approx((2.0, 2.0))
    assert time.distance == pytest.approx((2 * month * 4000 * 0.5, 2 * month * 18000 * 0.75))
    assert walked._volume_at(2e-3, *series) == pytest.approx(4e-9)
    assert walked._volume_at(1e-3, *series) == pytest.approx(1e-9)
    assert walked.worn_pair("1 mm after 2 months") == walked.WornPair(
        1e-3, None, pytest.approx(2.0, rel=0.02))  # fmt: skip
    assert walked.worn_pair("9.9 cm after 3 km") == walked.WornPair(0.099, 3000.0)
    assert "thinner" in refusal(walked.worn_pair, "10 cm after 3 km")


# limits of loads


def points_of(*loads, variants=()):
    return [WearPoint(measures(k * 1e-3, (5 - k) * 1e-3, k * 1e-4), made.outcome(fluid=load),
                      variants) for k, load in enumerate(loads)]  # fmt: skip


def test_a_limit_is_crossed_between_two_states():
    found = wear_limit.limit_crossing(points_of(10.0, 40.0), "fluid_load", 20.0, draws=400, seed=1)
    # half by the logarithm (0.5), half by the value (1/3)
    assert found.at["removed_depth"] == pytest.approx(0.5 * (0.5 + 1 / 3) * 1e-3)
    assert 1 / 3e3 <= found.low["removed_depth"] < found.high["removed_depth"] <= 0.5e-3
    assert found.low["removed_depth"] == pytest.approx((1 / 3 + 0.05 / 6) * 1e-3, rel=0.03)
    assert (found.crossing, found.share) == (Crossing.WITHIN, 1.0)
    never = wear_limit.limit_crossing(points_of(10.0, 40.0), "fluid_load", 40.0, draws=9, seed=1)
    assert (never.crossing, never.share) == (Crossing.NEVER, 0.0)
    assert (never.at["removed_depth"], never.at["tread_left"]) == (math.inf, -math.inf)
    new = wear_limit.limit_crossing(points_of(10.0, 40.0), "fluid_load", 9.9, draws=9, seed=1)
    assert (new.crossing, new.at["removed_depth"]) == (Crossing.FROM_NEW, 0.0)
    one = wear_limit.limit_crossing(points_of(10.0), "fluid_load", 9.9, draws=9, seed=1)
    assert (one.crossing, math.isnan(one.share)) == (Crossing.UNKNOWN, True)


def test_open_inputs_widen_a_limit_to_their_own_side():
    pair = ("x", made.outcome(fluid=10.0), made.outcome(fluid=90.0))
    wide = [dataclasses.replace(p, variants=(pair,)) for p in points_of(10.0, 40.0)]
    found = wear_limit._departure(wide, 0, "fluid_load", 1, np.log([10.0, 40.0]))
    assert found == pytest.approx([math.log(9.0), math.log(2.25)])
    found = wear_limit._departure(wide, 0, "fluid_load", 0, np.log([10.0, 40.0]))
    assert found == pytest.approx([0.0, math.log(0.25)])
    lost = ("x", made.FAILED, made.outcome(fluid=90.0))
    gone = [dataclasses.replace(p, variants=(lost,)) for p in points_of(10.0, 40.0)]
    assert (wear_limit._departure(gone, 0, "fluid_load", 0, np.zeros(2)) == 0).all()
    share = wear_limit.limit_crossing(wide, "fluid_load", 60.0, draws=4000, seed=3).share
    # of the draws above one half of the way to 90 N: z > log(1.5) / log(2.25)
    assert share == pytest.approx(
        0.5 * math.erfc(math.log(1.5) / math.log(2.25) / 2**0.5), abs=0.03
    )


# orders


def test_orders_by_hand():
    a, b = np.array([1.0, 2.0, 3.0, 4.0]), np.array([1.0, 1.9, 3.4, 1.0])
    found = order.order_of_draws(a, b)
    assert found.higher == pytest.approx((0.5 + 1 + 0 + 1) / 4)
    assert found.within == pytest.approx(0.5)
    assert order.Order(0.3, 0.0).told == 0.7
    for value, interval, ends in (
        (0.3, (0.2, 0.5), (0.2, 0.5)), (0.3, (0.0, 0.5), (0.0, 0.5)), (0.3, None, (0.202, 0.398)),
        (0.3, (0.3, 0.5), (0.3, 0.5)),
    ):  # fmt: skip
        one = SourcedValue(value, uncertainty=0.05, interval=interval)
        strata = order._strata(one)
        assert strata is not None
        low, middle, high = np.quantile(strata, (0.025, 0.5, 0.975))
        assert (low, middle, high) == pytest.approx((ends[0], value, ends[1]), abs=2e-3)
    assert order._strata(SourcedValue(0.3)) is None


def test_what_conditions_two_share():
    names = [kind for kind, *_ in separation._conditions(TREADED, TREADED)]
    for depth, worn in (("2.01 mm", True), ("2 mm", False)):
        case = TREADED.replace("shoe.tread.depth", depth)
        assert ("worn" in [kind for kind, *_ in separation._conditions(TREADED, case)]) is worn
    assert "fluid" in names
    assert separation.SeparatingStep("worn", 2e-3, 0.6).step == "both with 2 mm of tread worn off"


# comparisons


def test_comparisons_tell_how_far_two_are_apart():
    one, two = made.result("a", cof=0.3), made.result("b", cof=0.3004)
    found = comparison.compare(one, two)
    assert f"COF less than {comparison.LEAST_SHOWN:.3f} apart" in found.headline()[0]
    far = comparison.compare(one, made.result("b", cof=0.302))
    assert "COF 0.002 apart" in far.headline()[0]
    assert comparison._check_count(12) is None
    assert "2 to 12" in refusal(comparison._check_count, 13)
    assert [rank.letter for rank in comparison.compare(one, far.results[1]).ranking] == ["B", "A"]
    assert comparison.interval_95(SourcedValue(0.1, uncertainty=0.1)) == (
        0.0, pytest.approx(0.296, abs=1e-3))  # fmt: skip


@pytest.mark.parametrize(("side", "told"), [(4.03e-3, False), (4.05e-3, True)])
def test_grids_differ_by_more_than_a_hundredth(side, told):
    two = made.result("b", data=made.sole(side=side))
    assert (
        any("grids differ" in c for c in comparison.compare(made.result(), two).cautions()) is told
    )


# methods


def test_sides_of_an_interval_by_hand():
    z = 1.959963984540054
    assert method._sides(spread(0.3, 0.2, 0.5)) == pytest.approx(
        (math.log(1.5) / z, math.log(5 / 3) / z)
    )
    assert method._sides(SourcedValue(0.3, uncertainty=0.06, interval=(0.0, 0.5))) == pytest.approx(
        (0.2, 0.2)
    )
    assert method._sides(spread(0.3, 0.31, 0.5))[0] == 0.0
    assert method.probability_at_least(0.0, 1.0, 1.0) == pytest.approx(0.158655, abs=1e-6)
    assert [method.probability_at_least(0.3, 0.0, at) for at in (0.3, 0.31)] == [1.0, 0.0]


def test_what_a_condition_says(file_regression):
    """With and without a limit, an interval and a result; the limit alone is no chance."""
    limit = SourcedValue(0.3)
    base = method.MethodCondition("flat", "flat", "tile", "water",
                                  SourcedValue(0.35, reason="why", note="law"), 0.3, 0.4, limit,
                                  0.9, None, made.outcome())  # fmt: skip
    kinds = {
        "all": {}, "no chance": {"probability": None}, "no limit": {"limit": None},
        "neither": {"limit": None, "probability": None}, "no interval": {"low": None, "high": None},
        "none": {"cof": SourcedValue(None, reason="why")},
    }  # fmt: skip
    told = {name: dataclasses.replace(base, **cast(Any, change)).sentence
            for name, change in kinds.items()}  # fmt: skip
    assert told["no chance"] == told["no limit"] == told["neither"]
    held(file_regression, told)


# slips


@pytest.mark.parametrize(("count", "shown"), [(4, False), (5, True)])
def test_a_range_needs_five_walkers(count, shown):
    values = np.append(np.arange(float(count)), np.nan)
    subjects = [SimpleNamespace(seen=SimpleNamespace(crossed=True))] * (count + 1)
    study: Any = SimpleNamespace(of=lambda _: values, subjects=subjects)
    one = slips.SlipPopulation("a", study, spread(0.3, 0.1, 0.5), "m")
    text = one._range("peak_speed", "m/s")
    assert bool(text) is shown
    if shown:
        assert text == "90 % of the walkers: 0.20 m/s to 3.80 m/s"
    assert [slips._speed_text(v) for v in (0.0049, 0.005)] == ["below 0.01", "0.01"]


def test_required_friction_of_walkers_by_hand():
    steps = {"a": [0.2, 0.22], "b": [0.26, 0.28, 0.3]}
    one = slips.MeasuredRcof.of(steps, cast(Any, "persons"), cast(Any, ""))
    assert (one.mean, one.sd) == pytest.approx((0.245, 0.07 / 2**0.5))
    assert one.within == pytest.approx(math.sqrt((2e-4 + 8e-4) / 3))
    assert (one.mean_deviation, one.sd_deviation) == pytest.approx((0.035, one.sd / 2**0.5))
    alone = slips.MeasuredRcof.of({"a": [0.2, 0.22, 0.27]}, cast(Any, "x"), cast(Any, ""))
    assert (alone.persons, alone.sd) == (1, pytest.approx(np.std([0.2, 0.22, 0.27], ddof=1)))
    assert alone.within == pytest.approx(alone.sd)
    assert (alone.mean_deviation, alone.sd_deviation) == pytest.approx(
        (alone.sd / 3**0.5, alone.sd / 2)
    )
    assert (
        slips.MeasuredRcof.of({"a": [0.2], "b": [0.3]}, cast(Any, ""), cast(Any, "")).within is None
    )


# sensitivities


@pytest.mark.parametrize(
    ("given", "value", "ends"),
    [
        ({"deviation": 2.0}, 5.0, (3.0, 7.0)), ({"deviation": 2.0, "ratio": True}, 5.0, (2.5, 10)),
        ({"deviation": 2.0, "low": 4.0, "high": 6.0}, 5.0, (4.0, 6.0)),
        ({"deviation": 2.0, "ratio": True, "low": 3.0, "high": 9.0}, 5.0, (3.0, 9.0)),
    ],
)  # fmt: skip
def test_ends_of_an_input(given, value, ends):
    assert sensitivity.OpenInput("a", reason="r", **given).ends(value) == ends


def test_open_inputs_of_cases(file_regression):
    kinds = {
        "steady": {}, "at a time": {"motion.duration": "0.2 s"},
        "of a modulus": {"shoe.material.modulus": "4 MPa"},
        "stated": {"shoe.material.shore_a": {"value": 65, "uncertainty": 2}},
        "measured heel": {"shoe.heel.width": "70 mm"},
    }  # fmt: skip
    told = {}
    for name, change in kinds.items():
        case = TREADED.replace(change)
        told[name] = [[one.path, one.deviation, one.ratio, one.reason]
                      for one in sensitivity.open_inputs(case)]  # fmt: skip
    told["limits"] = [(one.path, one.low, one.high) for one in sensitivity.OPEN_INPUTS]
    wide = next(one for one in sensitivity.OPEN_INPUTS if one.path == "shoe.heel.width")
    at = sensitivity._at(TREADED, wide, 1.1 * TREADED.value("shoe.heel.width"))
    radius = "shoe.heel.rear_radius"
    assert at.value(radius) == pytest.approx(1.1 * TREADED.value(radius))
    held(file_regression, told)


def test_a_sensitivity_has_the_case_itself_in_its_middle(monkeypatch):
    asked: list[Any] = []

    def outcomes_of(cases, **options):
        asked.append([case.value("motion.speed") for case in cases])
        return [made.outcome(0.1 + 0.01 * at) for at in range(len(cases))]

    monkeypatch.setattr(sensitivity, "outcomes", outcomes_of)
    inputs = [sensitivity.OpenInput("motion.speed", 2.0, "r", ratio=True),
              sensitivity.OpenInput("motion.speed", 0.1, "s")]  # fmt: skip
    case = TREADED.replace("motion.speed", "0.4 m/s")
    one = sensitivity.sensitivity(case, inputs=inputs, quick=False)
    assert asked[0] == pytest.approx([0.4, 0.2, 0.8, 0.3, 0.5])
    assert one.nominal.number("cof") == pytest.approx(0.1)
    ends = [[each.low.number("cof"), each.high.number("cof")] for each in one.effects]
    assert ends == [pytest.approx([0.11, 0.12]), pytest.approx([0.13, 0.14])]
    assert [(each.low_value, each.high_value) for each in one.effects] == [
        pytest.approx((0.2, 0.8)), pytest.approx((0.3, 0.5))]  # fmt: skip
    assert not one.quick


# changes beside a march


def test_frictions_move_from_one_start_to_another_by_hand():
    """COF 0.2 at half of the load of the start: half of what is between the levels is added."""
    one = effects._Friction(SourcedValue(0.2, uncertainty=0.02), np.array([0.2, 0.3]),
                            SourcedValue(40.0, "N"))  # fmt: skip
    start, unchanged = effects._Level(0.1, 80.0), effects._Level(0.14, 100.0)
    moved = one.move_start(start, unchanged)
    assert (moved.cof.value, moved.fluid_load.value) == pytest.approx((0.22, 50.0))
    assert moved.draws == pytest.approx([0.22, 0.33])
    assert one.move_start(unchanged, effects._Level(-9.0, 0.0)).cof.value == 0.0
    assert one.film_left(effects._Level(0.1, 20.0)) == 1.0
    assert one.film_left(effects._Level(0.1, 0.0)) == 1.0
    far = dataclasses.replace(one, fluid_load=SourcedValue(5.0, "N"))
    assert far.move_start(start, effects._Level(0.1, 0.0)).fluid_load.value == pytest.approx(0.0)
    logs = np.log(np.array([0.1, 0.2]))
    narrow = effects._Friction(SourcedValue(0.2), np.exp(0.5 * logs) * 0.2**0.5, one.fluid_load)
    wide = effects._Friction(SourcedValue(0.2), np.exp(logs), one.fluid_load)
    beyond = effects._Spread.beyond(wide, narrow)
    half = math.log(2.0) / 2
    assert beyond.shift == pytest.approx(-half / 2)
    assert beyond.deviation == pytest.approx(half * 0.75**0.5)
    assert effects._Spread.beyond(narrow, wide).deviation == 0.0
    undrawn = dataclasses.replace(wide, draws=None)
    assert effects._Spread.beyond(undrawn, wide) == effects._Spread(0.0, 0.0)
    assert undrawn.widen_draws(beyond, 1.0) is undrawn
    shifted = wide.widen_draws(effects._Spread(0.3, 0.0), 0.5).draws
    assert shifted == pytest.approx(np.array([0.1, 0.2]) * math.exp(0.15))


@pytest.mark.parametrize(
    ("error", "sd", "lugs", "taken"),
    [(0.01, 0.1, False, True), (0.011, 0.1, False, False), (0.05, 0.1, True, True),
     (0.051, 0.1, True, False), (0.01, 0.001, True, True), (0.011, 0.001, True, False)],
)  # fmt: skip
def test_a_continuation_is_taken_within_its_error(error, sd, lugs, taken):
    seen = SimpleNamespace(cof=SourcedValue(0.2, uncertainty=sd), errors={"cof": error})
    march: Any = SimpleNamespace(continue_march=lambda _: seen)
    change: Any = SimpleNamespace(values={})
    assert (effects._continue_march(march, change, lugs) is seen) is taken


# contacts


def test_shortest_waves_double_up_to_half_of_a_side(monkeypatch):
    asked: list[Any] = []

    def noted(floor, modulus, speed, pressure, waves, ratio):
        asked.append((speed, pressure, waves, ratio))

    solved = SimpleNamespace(notes=("n",), status=Status.CONVERGED)
    monkeypatch.setattr(contact, "cutoff_dependence", noted)
    monkeypatch.setattr(contact, "solve_contact", lambda *given: (solved, given))
    rubber: Any = (5e6, "soft", ["a"])
    for points in (16, 32, 64, 512):
        floor: Any = SimpleNamespace(resolution=None, spacing=1e-5, size=(points * 1e-5, 1.0),
                                     processing=("p",))  # fmt: skip
        one = contact.rough_contact(floor, rubber, pressure=2e5, speed=0.1, scales=points > 16)
        assert one.notes == ("a", "n", "p")
    assert contact.rough_contact(floor, rubber, pressure=2e5).flow[2:] == (0.0, 2e5, 0.5, "cpu")
    assert [len(one[2]) for one in asked] == [2, 3, 5]
    assert asked[0][:2] == (0.1, 2e5)
    assert asked[0][3] == 0.5
    assert asked[-1][2] == pytest.approx([64e-5, 32e-5, 16e-5, 8e-5, 4e-5])
    assert asked[0][2] == pytest.approx([8e-5, 4e-5])


def test_a_map_and_its_mirror_images_close():
    """Of a tilted 2 by 3 map: levelled, four times the area, even about both middles."""
    from underfoot.surface import HeightMap

    rng = np.random.default_rng(1)
    floor = HeightMap(rng.normal(size=(4, 6)) * 1e-6, 1e-5)
    closed = contact.mirror_map(floor)
    assert closed.periodic
    assert closed.heights.shape == (8, 12)
    np.testing.assert_array_equal(closed.heights, closed.heights[::-1])
    np.testing.assert_array_equal(closed.heights, closed.heights[:, ::-1])


# outcomes


def test_what_is_known_of_many_cases_is_told_at_once(monkeypatch, tmp_path):
    monkeypatch.setenv("UNDERFOOT_CACHE", str(tmp_path))
    monkeypatch.setattr(outcomes, "run", lambda case, *, quick: made.result(case.name))
    heard: list[float] = []
    cases = [made.CASE.replace("motion.speed", f"{v} m/s") for v in (0.1, 0.2)]
    outcomes.outcomes(cases[:1])
    outcomes.outcomes([*cases, cases[0]], progress=lambda _, share, *more: heard.append(share))
    assert heard[0] == 0.5
    assert heard[-1] == 1.0
    assert outcomes.outcomes([]) == []


def test_outcomes_that_shall_not_be_taken_from_the_disk_are_computed(monkeypatch, tmp_path):
    monkeypatch.setenv("UNDERFOOT_CACHE", str(tmp_path))
    asked: list[str] = []

    def run(case, *, quick):
        asked.append(case.name)
        return made.result(case.name)

    monkeypatch.setattr(outcomes, "run", run)
    for cached, times in ((False, 1), (True, 2), (True, 2), (False, 3), (True, 3)):
        outcomes.outcomes([made.CASE, made.CASE], cached=cached)
        assert len(asked) == times
