"""Where a load passes a limit, on loads made up with a known answer."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from underfoot.case import Case
from underfoot.core import InputError
from underfoot.questions.walked import WornPair
from underfoot.questions.wear import WearSeries, trends, wear_series
from underfoot.questions.wear_limit import Crossing, WearPoint, first_exceeding, limit_crossing
from underfoot.questions.worn_states import worn_cases
from underfoot.report.question_figures import wear_figure
from underfoot.shoe.worn import WearMeasures

OUTSOLES = Path(__file__).parents[2] / "examples" / "outsoles"


class Loads:
    """Stands for an outcome: one number for the loads."""

    def __init__(self, load, cof=0.1):
        self.values = {"cof": cof}
        self.load = load

    def number(self, name):
        return self.values.get(name, self.load)


def states(loads, factor=None):
    points = []
    for number, load in enumerate(loads):
        measures = WearMeasures(
            number * 1e-3, (3 - number) * 1e-3, 3e-3, number * 1e-4, 0, 0, number * 1e-9
        )
        ends = () if factor is None else (("x", Loads(load / factor), Loads(load * factor)),)
        points.append(WearPoint(measures, Loads(load, 0.2 - 0.01 * number), ends))
    return points


def test_exponential_loads_are_passed_where_they_are():
    found = limit_crossing(
        states([1, 10, 100, 1000]), "fluid_load", math.sqrt(1000), draws=1, seed=0
    )
    assert found.crossing is Crossing.WITHIN
    # half way between linear and logarithmic: (1.5 + 1.24) / 2
    linear = 1 + (math.sqrt(1000) - 10) / 90
    assert found.at["removed_depth"] == pytest.approx(1e-3 * (1.5 + linear) / 2)
    assert found.at["tread_left"] == pytest.approx(3e-3 - found.at["removed_depth"])
    assert found.at["worn_patch_area"] == pytest.approx(0.1 * found.at["removed_depth"])


def test_band_of_a_lognormal_factor_covers_what_it_should():
    # log load = w ln 10: a factor e^(s z) moves the passing by -s z / ln 10 states
    fine = [10 ** (k / 10) for k in range(31)]
    points = states(fine, factor=math.e**0.5)
    found = limit_crossing(points, "fluid_load", 30.0, draws=20000, seed=1)
    half = 10 * 1.645 * 0.5 / math.log(10)
    centre = 10 * math.log10(30)
    assert found.low["removed_depth"] == pytest.approx((centre - half) * 1e-3, rel=0.03)
    assert found.high["removed_depth"] == pytest.approx((centre + half) * 1e-3, rel=0.03)
    assert found.low["tread_left"] < found.at["tread_left"] < found.high["tread_left"]


def test_not_passed_and_passed_when_new_are_said_so():
    never = limit_crossing(states([1, 2, 3]), "fluid_load", 5.0, draws=10, seed=0)
    assert never.crossing is Crossing.NEVER
    assert never.share == 0.0
    assert never.at["removed_depth"] == math.inf
    assert never.at["tread_left"] == -math.inf
    two = limit_crossing(states([1, 2]), "fluid_load", 5.0, draws=10, seed=0)
    assert (two.at["removed_depth"], two.at["tread_left"]) == (math.inf, -math.inf)
    always = limit_crossing(states([9, 9, 9]), "fluid_load", 5.0, draws=10, seed=0)
    assert always.crossing is Crossing.FROM_NEW
    assert always.at["removed_depth"] == 0.0


def test_a_band_that_reaches_beyond_the_range_says_so():
    points = states([1, 2, 4], factor=2.0)
    found = limit_crossing(points, "fluid_load", 5.0, draws=2000, seed=0)
    assert found.crossing is Crossing.NEVER
    # log2(5/4) = 0.32 deviations are needed
    assert found.share == pytest.approx(0.374, abs=0.03)
    assert math.isinf(found.high["removed_depth"])


def test_states_that_failed_are_left_out():
    found = limit_crossing(states([1, math.nan, 100]), "fluid_load", 10.0, draws=1, seed=0)
    assert 0 < found.at["removed_depth"] < 2e-3
    nothing = limit_crossing(states([math.nan, math.nan, 3]), "fluid_load", 10.0, draws=1, seed=0)
    assert nothing.crossing is Crossing.UNKNOWN


def test_same_seed_same_band():
    points = states([1, 3, 9, 27], factor=1.5)
    first = limit_crossing(points, "fluid_load", 5.0, draws=500, seed=3)
    assert first == limit_crossing(points, "fluid_load", 5.0, draws=500, seed=3)
    assert first != limit_crossing(points, "fluid_load", 5.0, draws=500, seed=4)


def test_first_passing_takes_the_first_of_several():
    rows = np.log(np.array([[1.0, 9.0, 1.0, 9.0]]))
    place = first_exceeding(rows, math.log(5.0), np.zeros(1))
    assert place == pytest.approx([0.5])


def test_trends_see_which_way_the_numbers_go():
    series = WearSeries("x", "plane", 5.0, tuple(states([1, 1.1, 1.2, 9])), {}, ())
    region, friction, slight, threshold = trends(series)
    assert region.agrees
    assert region.correlation == pytest.approx(1.0)
    assert friction.agrees
    assert slight.agrees is False  # it falls from new
    assert threshold.agrees
    even = WearSeries("x", "plane", 5.0, tuple(states([1, 5, 6, 7])), {}, ())
    assert trends(even)[3].agrees is False


@pytest.mark.parametrize(
    ("cof", "agrees"),
    [
        ([0.137, 0.147, 0.0099, 0.0098, 0.00984], True),  # the end moves by less than is printed
        ([0.137, 0.1373, 0.09], False),
        ([0.1, 0.12, 0.09, 0.11], False),
    ],
)
def test_friction_that_first_rises_and_then_falls(cof, agrees):
    points = states([1] * len(cof))
    for point, value in zip(points, cof, strict=True):
        point.outcome.values["cof"] = value
    series = WearSeries("x", "plane", 5.0, tuple(points), {}, ())
    assert trends(series)[2].agrees is agrees


def test_the_patch_at_the_limit_is_measured_not_interpolated():
    # no patch before the last tenth of the last step, though the last state has one
    def state(part):
        patch = max(part - 2.9, 0.0) * 1e-3
        return WearMeasures(part * 1e-3, (3 - part) * 1e-3, 0, patch, 0, 0, 0)

    between = [state(part) for part in np.linspace(0, 3, 31)]
    loads = states([1, 1.1, 2, 20])
    found = limit_crossing(loads, "fluid_load", 5.0, draws=1, seed=0, between=between)
    assert 2e-3 < found.at["removed_depth"] < 2.9e-3
    assert found.at["worn_patch_area"] == 0.0


def test_worn_cases_keep_what_the_case_says_of_its_wear():
    case = Case.load(OUTSOLES / "heel_hexagons_glycerol.toml")
    plain = worn_cases(case, "archard", 2, None)
    assert [round(each.shoe.wear.depth * 1e3, 3) for each in plain] == [0, 2, 4]
    assert plain[-1].shoe.wear.angle == pytest.approx(case.motion.shoe_angle)
    own = case.replace("shoe.wear", {"mode": "archard", "angle": "14 deg", "angle_range": "6 deg"})
    worn = worn_cases(own, "archard", 2, 1e-3)[-1].shoe.wear
    assert worn.angle == pytest.approx(math.radians(14))
    assert worn.angle_range == pytest.approx(math.radians(6))
    areas = [
        each.shoe.wear.patch_length * each.shoe.wear.patch_width * math.pi / 4
        for each in worn_cases(case, "patch", 4, 1e-3)[1:]
    ]
    assert areas == pytest.approx([0.25e-3, 0.5e-3, 0.75e-3, 1e-3])


def test_the_last_state_is_drawn_in_curve_and_table_and_gives_the_verdict():
    """Friction that rises to the last tread and is gone with it rises first, then falls."""
    points = states([1, 1, 1])
    for point, value in zip(points, (0.10, 0.11, 0.12), strict=True):
        point.outcome.values["cof"] = value
    rising = WearSeries("x", "plane", 5.0, tuple(points), {}, ())
    assert trends(rising)[2].agrees is False
    series = replace(rising, untreaded=Loads(30.0, 0.047))
    assert trends(series)[2].agrees
    friction = wear_figure(series).axes[2]
    drawn = np.concatenate([line.get_ydata() for line in friction.get_lines()])
    assert 0.047 in drawn
    place, bare = friction.get_lines()[-1].get_data()  # the open mark of the sole without tread
    assert (place[-1], bare[-1]) == pytest.approx((2.0, 0.047))
    assert len(series.table().rows) == 4
    assert "0.047" in series.table().rows[-1]


@pytest.mark.parametrize(("lost", "refused"), [(1.9e-3, False), (2.1e-3, True)])
def test_a_pair_worn_beyond_the_series_is_refused_and_one_within_it_is_not(
    monkeypatch, lost, refused
):
    class Begun(Exception):
        pass

    def begun(*_, **__):
        raise Begun

    monkeypatch.setattr("underfoot.questions.wear.outcomes", begun)
    case = Case.load(OUTSOLES / "heel_hexagons_glycerol.toml")
    with pytest.raises(InputError if refused else Begun):
        wear_series(case, mode="plane", steps=4, deepest=2e-3, pair=WornPair(lost, 1e6), band=False)
