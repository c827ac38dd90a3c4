"""Maps of fluid pressure, flat tops, empty plates, made-up steps, sheets of heels: by hand."""

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.trials.machines.pressure_map import PressureScan, pressure_map
from underfoot.trials.pages.figures import sheets
from underfoot.trials.readers.text import measurable
from underfoot.trials.recording.signals import is_saturated, unloaded_samples
from underfoot.trials.simulator import walk
from underfoot.trials.simulator.activities import activity
from underfoot.trials.statistics.ranks import _of_two
from underfoot.trials.study.file_result import FileResult
from underfoot.trials.study.readings import _boards
from underfoot.trials.study.study_tests import _logistic
from underfoot.trials.walking.events import _two_feet


def scan(lateral, line_load, peak=0.0):
    """Return a scan of 0.2 m in steps of 2 mm, mm to the left, with its line load (N/m)."""
    along = np.linspace(0.2, 0.0, 101)
    pressure = np.where(np.isclose(along, 0.05), peak, 0.0)
    return PressureScan(str(lateral), along, pressure, 1e-3 * lateral, 0.3, 0.0, 100.0, line_load)


def test_scans_that_lie_unevenly_count_by_the_width_that_is_theirs():
    """Of gaps of 10, 20, 30 and 10 mm each scan has half on either side, the outer ones a whole."""
    places, lines = (0, 10, 30, 60, 70), (100.0, 300.0, 200.0, 400.0, 50.0)
    scans = [scan(*one, peak=1e4 * one[0]) for one in zip(places, lines, strict=True)]
    found = pressure_map([scans[k] for k in (3, 0, 4, 2, 1)])
    widths = 1e-3 * np.array([10, 15, 25, 20, 10])
    assert found.load.value == pytest.approx(1.0 + 4.5 + 5.0 + 8.0 + 0.5)
    # noise of one scan: 100 Pa in each of 101 samples of 2 mm
    error = 100.0 * 2e-3 * np.sqrt(101) * np.sqrt(np.sum(widths**2))
    assert found.load.uncertainty == pytest.approx(error)
    assert found.outer_share == pytest.approx(1.5 / 19.0)
    # 0, 30 and 70 mm alone carry 3 + 7 + 2 N; 10 and 60 mm alone 15 + 20 N
    assert found.half_spacing_change == pytest.approx(35.0 / 19.0 - 1.0)
    assert found.peak.value == pytest.approx(7e5)
    assert found.peak_along.value == pytest.approx(0.05)
    assert found.peak_lateral.value == pytest.approx(0.07)
    assert found.peak_lateral.uncertainty == pytest.approx(0.0175 / np.sqrt(12))
    said = " ".join(flag.message for flag in found.load.flags)
    assert "a gap of 30 mm" in said
    assert "outermost scans carry 8 %" in said


def test_a_spacing_that_was_set_is_the_width_of_every_scan():
    found = pressure_map([scan(0, 100.0), scan(20, 300.0), scan(40, 200.0)], spacing=0.02)
    assert found.load.value == pytest.approx(600.0 * 0.02)
    assert found.outer_share == pytest.approx(0.5)
    assert found.half_spacing_change is None  # of three scans


@pytest.mark.parametrize(
    ("slope", "every", "flat"),
    [
        (1.5, 1, True),  # 7.5 N in the last 5 ms: more than 1 % of 500 N
        (0.75, 1, False),  # 3.75 N: a rounded peak
        (1.6, 5, False),  # one step of 8 N: a converter that dwells
        (16.0, 5, True),  # one of 80 N over steps of 2 N
    ],
)
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_top_is_flat_where_the_signal_comes_from_further_away_than_it_dwells(
    slope, every, flat, side
):
    rise = 500.0 - slope * every * (np.arange(100, 0, -1) // every + 1)
    fine = np.full(10, 2.0) if slope == 16.0 else []
    signal = np.concatenate([np.zeros(300), fine, rise[rise > 100], np.full(40, 500.0)])
    assert is_saturated(side * np.concatenate([signal, np.zeros(300)]), 1000.0) == flat


def test_the_level_of_an_empty_plate_is_the_fullest_within_a_few_newtons():
    """3 s of noise about 0, and 0.4 s in which a bag lies still on it with 60 N."""
    noise = np.random.default_rng(1).normal(0.0, 8.0, 3000)
    force = np.concatenate([noise, np.full(400, 60.0), np.full(600, 700.0)])
    mask = unloaded_samples(force, 1000.0)
    assert mask[:2900].mean() > 0.9
    assert not mask[3050:].any()


def test_a_made_up_step_is_that_of_walking_with_a_transient_of_the_heel():
    """0.12 body weights more at 3 % of a stance of 0.66 s, gone 12 ms before and after."""
    step = activity("walk", np.random.default_rng(1))
    force, weight = step.force[0], 70.0 * walk.GRAVITY
    share = (np.arange(len(force)) / walk.RATE - 1.2) / 0.66
    more = force[:, 2] / weight - walk.stance_load(share)
    assert more[np.argmin(np.abs(share - 0.03))] == pytest.approx(0.12, abs=0.01)
    assert np.abs(more[np.abs(share - 0.03) > 0.018]).max() < 0.01
    # it brakes by 0.2 of the load where the ratio peaks, 17 % of the stance
    top = np.argmin(np.abs(share - 0.17))
    assert -force[top, 0] / force[top, 2] == pytest.approx(0.2, abs=0.005)
    on = (share > 0) & (share < 1)
    assert step.centre[0][on, 0] == pytest.approx(0.15 + 0.22 * share[on])


@pytest.mark.parametrize("count", [1, 3])
def test_a_sheet_of_heels_has_the_threshold_and_the_scale_of_the_fastest(count):
    time = np.linspace(0.0, 1.0, 101).tolist()
    heels = [
        {"time": time, "speed": time, "peak": peak, "peak_time": 0.3, "end": 0.5, "threshold": 0.2}
        for peak in (0.93, 0.4, 0.6)[:count]
    ]
    files = [FileResult(f"{k}", curves={"heel": [one]}) for k, one in enumerate(heels)]
    (sheet,) = sheets([*files, FileResult("empty", reasons=("no marker", "no plate"))])
    assert sheet.line == 0.2
    assert (sheet.x_range, sheet.y_range) == ((0.0, 0.8), (0.0, 1.0))
    *tiles, empty = [tile for _, tile in sheet.tiles]
    assert [tile.remark for tile in tiles] == ["0.93", "0.40", "0.60"][:count]
    assert tiles[0].x[-1] == pytest.approx(0.52)  # until 30 ms after the end of the slip
    assert empty.reason == "no marker; no plate"


@pytest.mark.parametrize(
    ("along", "across", "feet"),
    [(0.20, 0.10, 1), (0.02, 0.20, 2), (0.30, 0.20, 1), (0.40, 0.02, 2)],
)
def test_a_centre_of_pressure_that_moves_farther_than_a_foot_is_wide_is_of_two(along, across, feet):
    """0.36 m along; across 0.14 m and, without markers, a quarter of what it moves along."""
    share = np.linspace(0, 1, 60)[:, None]
    place = share * np.array([along, across, 0.0])
    plate = SimpleNamespace(
        centre_of_pressure=place, force=np.tile([0.0, 0.0, 700.0], (60, 1)), start=0.0, rate=100.0
    )
    beside = SimpleNamespace(
        on_plate=lambda _: [], plate=plate, up=np.array([0.0, 0.0, 1.0]),
        surface=lambda _: np.zeros(3), walk=SimpleNamespace(trial=SimpleNamespace(markers={})),
    )  # fmt: skip
    stance = SimpleNamespace(
        start=0, stop=60, walking=np.array([1.0, 0.0, 0.0]), contact=0.0, peak=700.0
    )
    assert bool(_two_feet(cast(Any, stance), cast(Any, beside))) == (feet == 2)


def test_a_board_is_read_with_the_standard_error_of_its_readings():
    operators = {"operator": ["A", "A", "A", "B"]}
    standards, values = np.array([8.7, 8.7, 8.7, 27.3]), np.array([9.0, 9.4, 9.2, 28.0])
    read = _boards("sheet", "standard angle", standards, operators, values).read
    assert read["A"] == (pytest.approx((8.7, 9.2, 0.2 / np.sqrt(3))),)
    assert read["B"] == ((27.3, 28.0, 0.0),)  # of one reading nothing is known


def test_persons_who_differ_by_rounding_alone_are_no_pair():
    """By what is rounding beside the largest of both levels, also where one is nought."""
    nought, other = np.zeros(5), np.array([1.0, 2.0, 4.0, 8.0, 1e-13])
    test = _of_two(nought, other, several=True)
    assert test.statistic == 0.0
    assert test.p == pytest.approx(2 / 2**4)


def test_a_curve_of_chances_reaches_a_tenth_beyond_what_was_read():
    cofs = np.linspace(0.1, 0.3, 12)
    slips = [1, 1, 1, 1, 0, 1, 1, 0, 0, 1, 0, 0]
    files = [
        SimpleNamespace(
            file=f"{k}", main={"acof": cof, "slip": slip}, conditions={"person": f"{k}"}
        )
        for k, (cof, slip) in enumerate(zip(cofs, slips, strict=True))
    ]
    _, (curve,) = _logistic(cast(Any, files), "person")
    assert (curve["grid"][0], curve["grid"][-1]) == pytest.approx((0.08, 0.32))
    assert curve["slope"] < 0


def test_numbers_that_nothing_measures_are_missing_and_counted():
    notes: list[str] = []
    read = measurable(np.array([1.0, np.inf, -2e31, np.nan, 9e29]), notes)
    np.testing.assert_array_equal(read, [1.0, np.nan, np.nan, np.nan, 9e29])
    assert [note.partition(" ")[0] for note in notes] == ["2"]
    notes.clear()
    sound = np.array([0.0, -3.5, np.nan])
    assert measurable(sound, notes) is sound
    assert not notes
