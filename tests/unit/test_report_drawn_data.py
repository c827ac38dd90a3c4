"""Figures hold the numbers that they were given: along which axis, how wide, of which design."""

import re
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from matplotlib.figure import Figure

from underfoot.case import load
from underfoot.explore.record import Ending
from underfoot.report import chart, compound, design_study, live_study, slips, sole_mesh
from underfoot.report.design_study import _centre, slices_figure
from underfoot.report.question_figures import wear_figure
from underfoot.report.solver_input import with_middle_nodes
from underfoot.report.thumbnail import CELLS, _draw_sole
from underfoot.slip.dynamics.sensors import MAP_X, MAP_Y

EXAMPLES = Path(__file__).parents[2] / "examples"


def made_up_surrogate():
    """Return a surrogate that is 3 times its first input, with an error of 0.5."""
    dimensions = [
        SimpleNamespace(path="shoe.material.shore_a", value=lambda share: 40 + 30 * share),
        SimpleNamespace(path="motion.speed", value=lambda share: 0.1 + share),
    ]
    made = SimpleNamespace(
        dimensions=dimensions,
        name="cof",
        unit="1",
        q2=0.9,
        runs=SimpleNamespace(values=np.array([1.0, 3.0])),
        prediction=lambda points: (3 * points[:, 0], np.full(len(points), 0.5)),
    )
    return cast(Any, made)


def test_slices_go_through_the_centre_with_one_deviation_each_way():
    first, second = slices_figure([made_up_surrogate()], np.array([0.2, 0.6])).axes
    line, marked = first.lines
    x, y = line.get_data()
    assert (x[0], x[-1]) == pytest.approx((40, 70))
    np.testing.assert_allclose(y, 3 * (x - 40) / 30, atol=1e-12)
    assert marked.get_xdata()[0] == pytest.approx(40 + 30 * 0.2, abs=0.6)
    _, still = second.lines[0].get_data()
    np.testing.assert_allclose(still, 0.6)  # 3 times the 0.2 of the centre
    for axes, line in ((first, first.lines[0]), (second, second.lines[0])):
        (band,) = axes.collections
        ends = band.get_paths()[0].vertices[:, 1]
        middle = line.get_ydata()
        assert ends.min() == pytest.approx(np.min(middle) - 0.5)
        assert ends.max() == pytest.approx(np.max(middle) + 0.5)


def test_slices_go_through_the_best_design_or_the_first_with_numbers():
    first, second, failed = (
        SimpleNamespace(point=(place, 0.5), usable=usable)
        for place, usable in ((0.1, True), (0.9, True), (0.4, False))
    )

    def centre(best):
        return _centre(
            cast(Any, SimpleNamespace(designs=[failed, first, second], best=lambda count: best))
        )

    assert centre([second]).tolist() == [0.9, 0.5]
    assert centre([]).tolist() == [0.1, 0.5]


@pytest.mark.parametrize("mode", ["patch", "thickness"])
def test_wear_is_drawn_over_what_wore_off(mode):
    count = 5
    measured = {
        "worn_patch_area": 1e-6 * np.array([100.0, 200, 300, 400, 500]),
        "removed_depth": 1e-3 * np.arange(count),
        "tread_left": 1e-3 * np.arange(count)[::-1],
    }
    numbers = {
        name: scale * np.arange(1.0, count + 1)
        for name, scale in (
            ("fluid_load", 20.0), ("fluid_load_sensor", 10.0), ("peak_fluid_pressure", 5e4),
            ("peak_fluid_pressure_sensor", 3e4), ("cof", 0.05),
        )
    }  # fmt: skip
    series = SimpleNamespace(
        mode=mode, wear_measures=measured.__getitem__, values=numbers.__getitem__, untreaded=None,
        limit=75.0, ends=lambda name: (0.9 * numbers[name], 1.1 * numbers[name]),
    )  # fmt: skip
    load, peak, friction = wear_figure(cast(Any, series)).axes[:3]
    worn = np.arange(100.0, 600, 100) if mode == "patch" else np.arange(5.0)
    for axes, name, scale in (
        (load, "fluid_load", 1.0), (peak, "peak_fluid_pressure", 1e-3), (friction, "cof", 1.0),
    ):  # fmt: skip
        x, y = axes.lines[0].get_data()
        np.testing.assert_allclose(x, worn)
        np.testing.assert_allclose(y, numbers[name] * scale)
        ends = axes.collections[0].get_paths()[0].vertices[:, 1]
        assert ends.max() == pytest.approx(1.1 * scale * numbers[name].max())


def test_soles_of_the_best_designs_are_made_once_each_and_told_as_they_are(monkeypatch):
    shares = []
    monkeypatch.setattr(design_study, "design_sole", lambda study, result, number: number)
    front = [SimpleNamespace(number=number) for number in (4, 2, 4, 7)]
    result = SimpleNamespace(front=front, designs=[SimpleNamespace(number=9)])

    def progress(stage, share, residual=None):
        shares.append(share)
        assert stage == "Soles"

    soles = design_study._soles(cast(Any, None), cast(Any, result), progress)
    assert list(soles) == [4, 2, 7]
    assert shares == pytest.approx([1 / 3, 2 / 3, 1.0])
    result.front = []
    assert list(design_study._soles(cast(Any, None), cast(Any, result), progress)) == [9]


@pytest.mark.parametrize(
    ("page", "ended", "written"),
    [(True, [10.0, 20.0], 1), (True, [10.0, None], 0), (False, [10.0], 0), (False, [None], 0)],
)
def test_who_ends_last_writes_the_live_page_again_where_there_is_one(
    monkeypatch, tmp_path, page, ended, written
):
    times = []

    class Writer:
        def __init__(self, study, workers):
            pass

        def write(self):
            times.append("end")

        def write_if_due(self):
            times.append("due")

    monkeypatch.setattr(live_study, "_Writer", Writer)
    if page:
        (tmp_path / live_study.PAGE).touch()
    store = SimpleNamespace(folder=tmp_path, sessions=lambda: [{"ended": one} for one in ended])
    told = []
    study = cast(Any, SimpleNamespace(store=store))
    with live_study.with_live_page(study, lambda *parts: told.append(parts), 2) as progress:
        progress("Cases", 0.5)
    assert told == [("Cases", 0.5, None)]
    assert times == ["due"] + ["end"] * written


def test_a_picture_of_a_heel_is_as_long_as_wide_as_the_heel_and_darker_where_it_has_land():
    case = load(EXAMPLES / "work_shoe_full_tread_glycerol.toml")
    picture = _draw_sole(case)
    wide, high = map(int, re.search(r'viewBox="0 0 (\d+) (\d+)"', picture).groups())
    heel = case.shoe.heel
    assert wide / high == pytest.approx(heel.length / heel.widest, rel=0.05)
    assert 0.85 * CELLS < wide <= CELLS
    plan, land = re.findall(r' d="([^"]*)"', picture)
    cells = [sum(int(length) for length in re.findall(r"h(\d+)", path)) for path in (plan, land)]
    assert 0.1 < cells[1] / cells[0] < 0.9  # channels are left out
    assert cells[0] <= wide * high


def test_corners_of_drawn_cells_lie_on_the_plane_of_their_middles_and_no_step_is_smeared():
    x, y = np.meshgrid(np.arange(8.0), np.arange(6.0), indexing="ij")
    height = 1e-5 * (2 * x - y)
    land = np.ones((8, 6), bool)

    def corners(land):
        sole = SimpleNamespace(land=land, height=height, spacing=1e-3)
        return sole_mesh._corner_heights(cast(Any, sole), height)

    inner = (slice(1, -1), slice(1, -1))
    for number, (step_x, step_y) in enumerate(sole_mesh._CORNERS):
        exact = 1e-5 * (2 * (x + step_x - 0.5) - (y + step_y - 0.5))
        np.testing.assert_allclose(corners(land)[..., number][inner], exact[inner], atol=1e-12)
    land[4:] = False  # a channel's cells are no neighbours of the land's
    apart = corners(land)
    for number, (step_x, step_y) in enumerate(sole_mesh._CORNERS):
        beside = 3 if step_x else 4  # the last of the land, the first of the channel
        exact = 1e-5 * (2 * beside - (y[0] + step_y - 0.5))
        np.testing.assert_allclose(apart[beside, 1:-1, number], exact[1:-1], atol=1e-12)


def test_a_prism_of_second_order_has_its_middle_nodes_in_the_order_of_the_solvers():
    """Of C3D15: 7 to 9 between the nodes below, 10 to 12 between those above, 13 to 15 upright."""
    corners = np.random.default_rng(5).uniform(size=(6, 3))
    nodes, prisms, triangles = with_middle_nodes(
        corners, np.arange(6)[None, :], np.array([[0, 1, 2]])
    )
    pairs = [(1, 2), (2, 3), (3, 1), (4, 5), (5, 6), (6, 4), (1, 4), (2, 5), (3, 6)]
    between = [(corners[a - 1] + corners[b - 1]) / 2 for a, b in pairs]
    np.testing.assert_allclose(nodes[prisms[0, 6:]], between)
    np.testing.assert_allclose(nodes[triangles[0, 3:]], between[:3])
    assert len(nodes) == 15


@pytest.mark.parametrize("highest", [2.0, 200.0])
def test_a_pressure_at_a_sensor_is_drawn_whole(monkeypatch, highest):
    time = np.linspace(0, 0.1, 11)
    pulse = 1e3 * highest * np.sin(np.pi * time / 0.1)[:, None, None] * np.ones((1, 2, 3))
    monkeypatch.setattr(slips, "array_pressures", lambda *_: pulse)
    study = SimpleNamespace(
        representative=SimpleNamespace(maps=None), array=SimpleNamespace(rows=2, columns=3)
    )
    figure = Figure()
    slips._draw_pressures(
        figure.subfigures(), cast(Any, study), cast(Any, SimpleNamespace(time=time))
    )
    for axes in figure.subfigs[0].axes:
        low, high = axes.get_ylim()
        assert low == 0
        assert high >= 1.1 * highest


def test_a_sweep_is_drawn_over_hertz_with_the_line_of_its_fit():
    hertz = np.array([0.1, 1.0, 10.0])
    storage, loss = np.array([2e6, 3e6, 5e6]), np.array([2e5, 6e5, 2e6])
    band = SimpleNamespace(loss_low=np.ones(200), loss_high=np.ones(200))
    spectrum = SimpleNamespace(
        storage_modulus=lambda w: 1e6 * w, loss_modulus=lambda w: 1e5 * w, loss_tangent=np.sqrt
    )
    shown = SimpleNamespace(
        sweep=SimpleNamespace(
            angular_frequency=2 * np.pi * hertz, storage_modulus=storage, loss_modulus=loss
        ),
        fit=SimpleNamespace(band=lambda _: band, spectrum=spectrum),
    )
    left, right = compound._sweep(cast(Any, shown)).axes
    for line, megapascals in zip(left.lines[:2], (storage / 1e6, loss / 1e6), strict=True):
        np.testing.assert_allclose(line.get_data(), (hertz, megapascals))
    np.testing.assert_allclose(right.lines[0].get_data(), (hertz, loss / storage))
    x, y = left.lines[2].get_data()
    np.testing.assert_allclose(y, 2 * np.pi * x)


@pytest.mark.parametrize(
    ("goals", "title"), [(0, "Designs"), (1, "Best designs, as run"), (2, "Front, as run")]
)
def test_a_live_page_shows_the_best_designs_or_the_first_without_a_goal(goals, title):
    live = SimpleNamespace(
        plan=SimpleNamespace(goals=["cof"] * goals),
        shown=["first"], front=["front"], best=lambda _: ["best"],
        design_table=lambda designs, title: (designs, title),
    )  # fmt: skip
    designs, said = live_study.LiveStudy.table(cast(Any, live))
    assert (designs, said) == ([("first", "best", "front")[goals]], title)


def test_a_run_has_ended_with_all_its_numbers_or_where_it_can_not_have_them():
    order = [Ending.OPEN, Ending.COMPUTED, Ending.NOT_CONVERGED, Ending.FAILED]
    number = {ending: list(Ending).index(ending) for ending in order}
    waiting, computed, lost, failed = (number[ending] for ending in order)
    runs = np.array(
        [[computed] * 2, [waiting, computed], [lost, waiting], [waiting] * 2, [computed, failed]]
    )
    ended = live_study.LiveStudy.ended_runs.func(cast(Any, SimpleNamespace(_endings_of_runs=runs)))
    assert ended == [0, 2, 4]


def test_a_line_runs_from_the_corner_of_its_axes_to_the_highest_number():
    svg = chart.line_chart([0, 1, 2], [("friction", [0.0, 0.5, 1.0])], "time", "COF")
    points = re.search(r'points="([^"]*)"', svg)
    assert points is not None
    ends = [tuple(map(float, place.split(","))) for place in points[1].split()]
    left, right = chart.LEFT, chart.WIDTH - 10
    low, high = chart.HEIGHT - chart.BOTTOM, chart.TOP
    assert ends == [(left, low), ((left + right) / 2, (low + high) / 2), (right, high)]


def test_a_moving_picture_of_a_slip_holds_its_numbers_in_their_units(monkeypatch):
    time = np.linspace(0, 0.2, 21)
    motion = SimpleNamespace(
        time=time, walker=None, speed=2 * time, distance=time**2,
        **dict.fromkeys(("normal", "fluid_load", "friction", "drive"), 100 * time),
        shoe_angle=0 * time,
    )  # fmt: skip
    run = SimpleNamespace(
        profile_x=np.array([0.0, 0.01]), profiles=np.full((21, 2), 15e-6),
        maps=np.full((21, MAP_X.size, MAP_Y.size), 3e4),
    )  # fmt: skip
    study = SimpleNamespace(
        representative=run, array=SimpleNamespace(places=lambda _: (np.array([0.1]), None)),
        setting=SimpleNamespace(viscosity=0.2, settings=SimpleNamespace(pool_depth=1e-3)),
    )  # fmt: skip
    monkeypatch.setattr(slips, "shown_motion", lambda _: motion)
    data = slips.animation_data(cast(Any, study))
    assert data["highest"] == 30.0  # kPa
    assert np.unique(data["pressures"]).tolist() == [30.0]
    assert np.unique(data["films"]).tolist() == [15.0]  # um
    assert data["pool"] == pytest.approx(1000.0)
    assert (data["speed"][-1], data["normal"][-1]) == pytest.approx((0.4, 20.0))
