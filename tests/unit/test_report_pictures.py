"""What pictures are made of: which curve, on which axis, in which unit, with which ends."""

import re
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from underfoot.core import SourcedValue
from underfoot.explore.effects import Effects
from underfoot.report import chart, design_study, laws, places, slips, study_figures
from underfoot.report.question_figures import contact_figure
from underfoot.report.study_figures import draw_figure, stribeck_figure
from underfoot.rough_contact import ExponentialLaw
from underfoot.slip import ReportG6, slip_model, slip_risk
from underfoot.slip.dynamics import FloorSensors
from underfoot.slip.dynamics.sensors import MAP_X, MAP_Y
from underfoot.studies.figure import Figure as FigureData
from underfoot.studies.figure import Layer, Panel
from underfoot.surface import HeightMap, Profile


def ends_of(collection, axis=1):
    """Return lowest and highest of what is filled."""
    vertices = collection.get_paths()[0].vertices[:, axis]
    return vertices.min(), vertices.max()


def xy(line):
    return tuple(np.asarray(part, dtype=float) for part in line.get_data())


def painted(line):
    return to_hex(line.get_color())


def fake(**parts) -> Any:
    return SimpleNamespace(**parts)


# slips


def a_slip(monkeypatch, *, wet=True, way=0.3, sensors=(2, 3), walkers=5):
    """Return a study of a slip of constant speed: the heel begins 20 mm before the first row."""
    time = np.linspace(0, 0.2, 41)
    walker = fake(landing=0.02, lateral=0.01, name="the median")
    motion = fake(
        walker=walker, time=time, distance=way * time, speed=2 * time, normal=500 - 100 * time,
        fluid_load=300 * time, drive=90 + 10 * time, friction=40 - 20 * time, shoe_angle=0.3 - time,
    )  # fmt: skip
    subjects = [fake(motion=fake(time=time, speed=k * time)) for k in range(1, walkers + 1)]
    shown = fake(
        setting=fake(viscosity=0.2 if wet else None, settings=fake(pool_depth=1e-3)),
        representative=fake(maps=None) if wet else None,
        array=FloorSensors(*sensors),
        subjects=subjects,
    )
    monkeypatch.setattr(slips, "shown_motion", lambda _: motion)
    number = 1.0 + np.arange(np.prod(sensors)).reshape(sensors)
    pulse = np.where(time < 0.1, 1e3, 0.0)[:, None, None] * number
    monkeypatch.setattr(slips, "array_pressures", lambda *_: pulse)
    return shown, motion


@pytest.mark.parametrize("way", [0.3, 0.5])
def test_a_heel_slides_over_the_sensors_where_they_lie(monkeypatch, way):
    study, motion = a_slip(monkeypatch, way=way)
    above, below = slips.slip_figure(study).subfigs
    (path,) = above.subfigs[0].axes
    crosses, heel, contact = path.lines
    met = sorted(zip(*(np.round(part, 9) for part in xy(crosses)), strict=True))
    assert met == [(y, x) for y in (-30, 0, 30) for x in (0, 30)]  # in the frame of the array
    side, along = xy(heel)
    assert np.unique(side) == pytest.approx([10])
    assert along == pytest.approx(1e3 * way * motion.time - 20)
    assert [part[0] for part in xy(contact)] == pytest.approx([10, -20])
    assert path.get_xlim() == pytest.approx((52, -52))  # left of the walk is to the left
    assert path.get_ylim() == pytest.approx((-35, 55))
    arrows = [each for each in path.texts if each.get_text() == ""]
    assert bool(arrows) is (1e3 * way * 0.2 - 20 > 55)  # it leaves the picture
    assert len(below.axes) == 2


def test_each_sensor_has_its_pressure_at_its_place_and_one_scale(monkeypatch):
    study, motion = a_slip(monkeypatch)
    above, _ = slips.slip_figure(study).subfigs
    panels = above.subfigs[1].axes
    assert len(panels) == 6
    for number, axes in enumerate(panels):
        row, column = divmod(number, 3)
        highest = 1.0 + 3 * (1 - row) + column  # the row that is met first is at the bottom
        time, pressure = xy(axes.lines[0])
        assert time == pytest.approx(1e3 * motion.time)
        assert (pressure[0], pressure[-1]) == pytest.approx((highest, 0))
        assert axes.texts[0].get_text() == f"{highest:.0f} kPa"
        assert ends_of(axes.collections[0]) == pytest.approx((0, highest))
        assert axes.get_xlim() == pytest.approx((0, 135))  # 40 ms after the last pressure, at 95
        assert axes.get_ylim() == pytest.approx((0, 1.15 * 6))


def test_one_sensor_has_an_array_of_its_own_width_and_a_dry_slip_no_pressures(monkeypatch):
    study, _ = a_slip(monkeypatch, sensors=(1, 1))
    path = slips.slip_figure(study).subfigs[0].subfigs[0].axes[0]
    assert path.get_xlim() == pytest.approx((40, -40))
    assert path.get_ylim()[1] == pytest.approx(25)
    dry, motion = a_slip(monkeypatch, wet=False)
    speeds, forces = slips.slip_figure(dry).axes
    load, drive, friction, _ = forces.lines
    for line, values in ((load, "normal"), (drive, "drive"), (friction, "friction")):
        assert xy(line)[1] == pytest.approx(getattr(motion, values))
    assert speeds.get_xlim()[0] == speeds.get_ylim()[0] == 0


def test_a_wet_slip_has_four_forces_and_the_speeds_of_the_walkers_behind_its_own(monkeypatch):
    study, motion = a_slip(monkeypatch)
    speeds, forces = slips.slip_figure(study).subfigs[1].axes
    for line, name in zip(
        forces.lines[:4], ("normal", "fluid_load", "drive", "friction"), strict=True
    ):
        time, values = xy(line)
        assert time == pytest.approx(1e3 * motion.time)
        assert values == pytest.approx(getattr(motion, name))
    colours = [slips.LOAD, slips.FLUID, slips.DRIVE, slips.FRICTION]
    assert [painted(each) for each in forces.lines[:4]] == [to_hex(each) for each in colours]
    median, own, limit = speeds.lines
    time, middle = xy(median)
    assert (time[0], time[-1], time.size) == pytest.approx((0, 200, 200))
    assert middle == pytest.approx(3e-3 * time)  # of 1 to 5 times the time in s
    assert xy(own)[1] == pytest.approx(2 * motion.time)
    assert np.unique(limit.get_ydata()) == pytest.approx([0.2])
    assert ends_of(speeds.collections[0])[1] == pytest.approx(4.8 * 0.2)  # the 95 % quantile
    low = np.asarray(speeds.collections[0].get_paths()[0].vertices)
    assert low[low[:, 0] == 200, 1].min() == pytest.approx(1.2 * 0.2)
    few, _ = a_slip(monkeypatch, walkers=4)
    assert not slips.slip_figure(few).subfigs[1].axes[0].collections


def test_a_moving_picture_has_the_film_of_its_instant_and_the_pressure_under_the_middle(
    monkeypatch,
):
    study, motion = a_slip(monkeypatch)
    count = motion.time.size
    films = 1e-6 * np.arange(count)[:, None] * np.ones((count, 200))
    films[:, 0] = np.nan
    beside = 1e6 * np.abs(MAP_Y) > 1
    maps = np.where(beside, 9e5, 1e3 * np.arange(MAP_X.size)[:, None]) * np.ones((count, 1, 1))
    study.representative = fake(profile_x=1e-3 * np.arange(200), profiles=films, maps=maps)
    data = slips.animation_data(study)
    time = np.asarray(data["time"])
    assert (time[0], time[-1], time.size) == pytest.approx((0, 0.2, slips.FRAMES))
    assert data["speed"] == pytest.approx(2 * time, abs=2e-4)
    assert data["distance"] == pytest.approx(0.3 * time, abs=2e-5)
    for name, values in (("normal", 500 - 100 * time), ("film_load", 300 * time),
                         ("drive", 90 + 10 * time), ("friction", 40 - 20 * time)):  # fmt: skip
        assert data[name] == pytest.approx(values, abs=0.1)
    assert data["angle"] == pytest.approx(0.3 - time, abs=2e-4)
    assert data["sensors"] == pytest.approx([0.02, 0.05])
    assert data["wet"] is True
    assert data["sole_x"] == pytest.approx(2e-3 * np.arange(100))
    film = np.array([row[1] for row in data["films"]], dtype=float)
    instant = time / 0.005
    assert ((film >= instant - 0.02) & (film <= np.maximum(instant + 1, 1))).all()
    assert [row[0] for row in data["films"]] == [None] * slips.FRAMES
    assert np.asarray(data["pressures"])[7].tolist() == list(range(MAP_X.size))
    assert data["map_x"] == pytest.approx(MAP_X, abs=1e-4)


# laws


def test_parts_of_the_friction_lie_on_each_other_and_a_gap_is_drawn_to_where_it_is_open():
    class Law:
        name = "A law"

        def __call__(self, pressure, speed, film):
            assert np.unique(pressure) == pytest.approx([laws.PIN_PRESSURE])
            return fake(hysteresis=0.1 * pressure, adhesion=0.3 * pressure * speed)

    figure = Figure()
    laws._friction_law(Law(), figure)
    (axes,) = figure.axes
    speed, cof = xy(axes.lines[0])
    assert (speed[0], speed[-1]) == pytest.approx((0.01, 2.0))
    assert cof == pytest.approx(0.1 + 0.3 * speed)
    lower, upper = axes.collections
    assert (lower.get_label(), upper.get_label()) == ("hysteresis", "adhesion")
    assert ends_of(lower) == pytest.approx((0, 0.1))
    assert ends_of(upper) == pytest.approx((0.1, 0.7))
    assert axes.get_title() == f"A law, {laws.PIN_PRESSURE / 1000:.0f} kPa"
    gap_law = ExponentialLaw(3e6, 0.5, 4e-6)
    left, right = gap_law.plot().axes
    gap, flow = xy(right.lines[0])
    assert (gap[0], gap[-1]) == pytest.approx((0, 1.2e6 * float(gap_law.mean_gap(1e3))))
    assert flow == pytest.approx(gap_law.flow_factor(1e-6 * gap))
    assert xy(left.lines[0])[0] == pytest.approx(gap)


def test_a_contact_table_has_a_line_a_speed_with_its_spread():
    pressure, speed = np.array([1e5, 2e5, 4e5, 8e5, 1.6e6]), np.array([0.1, 0.5])
    values = {
        name: scale * (1 + np.arange(10.0).reshape(5, 2))
        for name, scale in (
            ("real_contact_fraction", 1e-2), ("cof_hysteresis", 1e-1), ("mean_gap", 1e-6),
        )
    }  # fmt: skip
    deviation = {name: 0.1 * each for name, each in values.items()}
    deviation["mean_gap"] = np.full((5, 2), np.nan)
    figure = Figure()
    laws._contact_table(
        fake(pressure=pressure, speed=speed, values=values, deviation=deviation), figure
    )
    for axes, name, scale in zip(
        figure.axes, ("real_contact_fraction", "cof_hysteresis", "mean_gap"), (1, 1, 1e6),
        strict=True,
    ):  # fmt: skip
        assert len(axes.containers) == 2
        for column, made in enumerate(axes.containers):
            line, _, (bars,) = made
            assert xy(line)[0] == pytest.approx(pressure / 1000)
            middle = scale * values[name][:, column]
            assert xy(line)[1] == pytest.approx(middle)
            spread = 0.0 if name == "mean_gap" else 0.1 * middle
            for (low, high), at, half in zip(
                bars.get_segments(), middle, spread * np.ones(5), strict=True
            ):
                assert (low[1], high[1]) == pytest.approx((at - half, at + half))
            assert made.get_label() == f"{speed[column]:g} m/s"
        assert axes.get_xticks() == pytest.approx(pressure / 1000)


@pytest.mark.parametrize("mapped", [False, True])
def test_a_scan_is_drawn_in_millimetres_with_its_spectrum_over_the_wavelength(mapped):
    rng = np.random.default_rng(3)
    heights = 1e-6 * rng.normal(size=(12, 8) if mapped else 40)
    surface = HeightMap(heights, 1e-5) if mapped else Profile(heights, 1e-5)
    low, high = 2 * np.pi / 1e-3, 2 * np.pi / 1e-5
    scan = fake(
        surface=surface, spectrum=fake(reliable=(low, high)), density=lambda q: 1e-20 * q**-3.0,
        cutoff=0.8e-3, hurst=SourcedValue(0.5),
    )  # fmt: skip
    figure = Figure()
    laws._scan(scan, figure)
    left, right = figure.axes[:2]
    levelled = 1e6 * laws.level_surface(surface).heights
    if mapped:
        image = left.images[0]
        assert np.asarray(image.get_array()) == pytest.approx(levelled.T)
        assert image.get_extent() == pytest.approx((0, 0.12, 0, 0.08))
    else:
        x, y = xy(left.lines[0])
        assert (x[0], x[-1]) == pytest.approx((0, 0.39))
        assert y == pytest.approx(levelled)
    whole, measured, cut = right.lines
    for line, ends in ((whole, (3.0, 0.01 / 3)), (measured, (1.0, 0.01))):
        wave, density = xy(line)
        assert (wave[0], wave[-1]) == pytest.approx(ends, rel=0.04)  # mm
        assert density == pytest.approx(1e-20 * (2e3 * np.pi / wave) ** -3.0)
    assert ((xy(measured)[0] <= 1 + 1e-9) & (xy(measured)[0] >= 0.01 - 1e-9)).all()
    assert np.unique(cut.get_xdata()) == pytest.approx([0.8])
    assert right.xaxis_inverted()


def test_a_risk_is_drawn_with_its_interval_on_the_curve_of_its_population():
    risk = slip_risk(SourcedValue(0.2, uncertainty=0.02))
    assert risk.low is not None
    (axes,) = risk.plot().axes
    acof, share = xy(axes.lines[0])
    assert (acof[0], acof[-1]) == (0, 0.6)
    curve = slip_model(risk.model).population(acof, risk.rcof.mean, risk.rcof.sd)
    assert share == pytest.approx(100 * curve)
    (band,) = axes.patches
    assert band.get_extents().height > 0
    assert (band.get_y(), band.get_y() + band.get_height()) == pytest.approx(
        (100 * risk.low, 100 * (risk.high or 0))
    )
    model = ReportG6().plot().axes[0]
    (tested,) = model.patches
    ends = tested.get_x(), tested.get_x() + tested.get_width()
    assert ends == pytest.approx((ReportG6().tested.low, ReportG6().tested.high))
    assert model.get_xlim()[0] < -0.2 < 0.2 < model.get_xlim()[1]


# questions, studies, places


@pytest.mark.parametrize("touching", ["some", "all", "none"])
def test_maps_of_a_contact_are_in_their_units_and_tell_the_share_that_touches(touching):
    heights = 1e-6 * np.arange(40.0).reshape(4, 10)
    pressure = np.zeros((4, 10))
    pressure[{"some": (0,), "all": slice(None), "none": slice(0)}[touching]] = 3e6
    gap = np.where(pressure > 0, 0.0, 1e-6 * np.arange(40).reshape(4, 10))
    figure = contact_figure(heights, 2e-6, fake(pressure=pressure, gap=gap), "A title")
    surface, carried, patches, gaps = figure.axes[:4]
    assert surface.images[0].get_extent() == pytest.approx((0, 20, 0, 8))  # um, across and along
    assert np.asarray(surface.images[0].get_array()) == pytest.approx(
        np.arange(40).reshape(4, 10) - 19.5
    )
    share = {"some": 25, "all": 100, "none": 0}[touching]
    assert re.findall(r"[\d.]+", patches.get_title()) == [str(share)]
    force = np.ma.masked_array(carried.images[0].get_array())
    assert force.count() == 40 * share // 100
    assert force.compressed() == pytest.approx(3.0)  # MPa
    if touching == "all":
        assert not gaps.images
        return
    assert np.ma.masked_array(gaps.images[0].get_array()).count() == 40 - force.count()
    opened = 1e6 * gap[pressure == 0]
    assert gaps.images[0].get_clim() == pytest.approx((0, np.quantile(opened, 0.99)))
    assert figure.get_suptitle() == "A title"


def test_curves_of_fluids_are_drawn_over_speed_and_over_its_product_with_viscosity():
    speed = np.array([0.01, 0.1, 1.0])
    curves = [
        fake(
            speed=speed, viscosity=viscosity, label=f"fluid {k}", pair=f"pair {k}",
            parts={"adhesion": 0.3 - 0.1 * speed, "hysteresis": 0.05 + 0 * speed,
                   "viscous": 0.02 * speed * (k + 1)},
            interval=(0.2 + 0 * speed, 0.5 + 0.1 * speed) if k == 0 else None,
            points=None if k == 0 else (np.array([0.2, 0.4]), np.array([0.31, 0.29])),
        )
        for k, viscosity in enumerate((0.05, 0.2))
    ]  # fmt: skip
    figure = stribeck_figure(cast(Any, curves), "Fluids")
    over_speed, over_product, first, second = figure.axes
    for axes, factors in ((over_speed, (1, 1)), (over_product, (50, 200))):
        for line, curve, factor in zip(axes.lines[:3:1], (*curves, None), (*factors, 1),
                                       strict=False):  # fmt: skip
            if curve is None:
                continue
            whole = sum(curve.parts.values())
            assert xy(line) == (pytest.approx(factor * speed), pytest.approx(whole))
        (band,) = axes.collections
        assert ends_of(band) == pytest.approx((0.2, 0.6))
        assert ends_of(band, 0) == pytest.approx((0.01 * factors[0], factors[0]))
        assert xy(axes.lines[2]) == (
            pytest.approx(factors[1] * np.array([0.2, 0.4])), pytest.approx([0.31, 0.29]),
        )  # fmt: skip
        assert painted(axes.lines[2]) == painted(axes.lines[1]) != painted(axes.lines[0])
        assert axes.get_xscale() == "log"
        assert axes.get_ylim()[0] == 0
    assert over_speed.get_legend() is None
    assert [t.get_text() for t in cast(Any, over_product.get_legend()).get_texts()] == [
        "fluid 0",
        "fluid 1",
    ]
    assert "pair 1" in over_product.get_title()
    assert "pair 0" not in over_product.get_title()
    for axes, curve in ((first, curves[0]), (second, curves[1])):
        tops = [ends_of(each)[1] for each in axes.collections]
        sums = np.cumsum([curve.parts[name] for name in study_figures.PART_COLOURS], axis=0)
        assert tops == pytest.approx(sums.max(axis=1))
        assert curve.label in axes.get_title()


def every_mark():
    return {
        "line": Layer("line", [0, 1], [2, 3], label="l", colour="#112233", marker="s"),
        "outline": Layer("outline", [0, 1, 1], [0, 0, 1], colour="#112233"),
        "points": Layer("points", [1, 2], [5, 6], low=[4, 5.5], high=[7, 6.1], label="p"),
        "bars": Layer("bars", [0, 1], [2, 3], low=[1, 2], high=[3, 5], width=0.4, label="b"),
        "across": Layer("across", [2, 3], [0, 1], width=0.5, label="a"),
        "band": Layer("band", [0, 1], low=[1, 2], high=[3, 5]),
        "level": Layer("level", y=[0.3, 0.4]),
        "limit": Layer("limit", x=[0.6]),
        "span": Layer("span", low=[1], high=[2], style="horizontal"),
        "upright": Layer("span", low=[1], high=[2]),
    }


def test_every_mark_of_a_figure_is_drawn_at_its_numbers():
    marks = every_mark()
    panels = [Panel([layer], f"x {name}", f"y {name}", name) for name, layer in marks.items()]
    figure = draw_figure(FigureData(panels, "All of them", columns=4, size=(2.0, 1.5)))
    assert figure.get_size_inches() == pytest.approx((8.0, 1.5 * 3 + 0.5))
    axes: dict[str, Any] = dict(zip(marks, figure.axes, strict=False))
    assert [each.get_visible() for each in figure.axes] == [True] * len(marks) + [False] * 2
    for name, each in axes.items():
        assert (each.get_xlabel(), each.get_title()) == (f"x {name}", name)
        assert each.get_ylabel() == f"y {name}"
    assert xy(axes["line"].lines[0])[1] == pytest.approx([2, 3])
    assert painted(axes["line"].lines[0]) == "#112233"
    assert axes["line"].lines[0].get_linewidth() > axes["outline"].lines[0].get_linewidth()
    (bars, own) = axes["points"].containers[0], axes["points"].lines[-1]
    reach = [(low[1], high[1]) for low, high in bars[2][0].get_segments()]
    assert reach == [pytest.approx((4, 7)), pytest.approx((5.5, 6.1))]
    assert xy(own)[1] == pytest.approx([5, 6])
    assert own.get_linestyle() == "None"
    assert [bar.get_height() for bar in axes["bars"].patches] == [2, 3]
    assert [bar.get_width() for bar in axes["bars"].patches] == pytest.approx([0.4] * 2)
    assert [tuple(xy(line)[1]) for line in axes["bars"].lines[1::2]] == [(1, 3), (2, 5)]
    assert [tuple(xy(line)[0]) for line in axes["bars"].lines[1::2]] == [(0, 0), (1, 1)]
    assert [bar.get_width() for bar in axes["across"].patches] == [2, 3]
    assert [bar.get_height() for bar in axes["across"].patches] == pytest.approx([0.5] * 2)
    assert ends_of(axes["band"].collections[0]) == pytest.approx((1, 5))
    assert [line.get_ydata()[0] for line in axes["level"].lines] == [0.3, 0.4]
    assert [line.get_xdata()[0] for line in axes["limit"].lines] == [0.6]
    for name, low, size in (
        ("span", "get_y", "get_height"), ("upright", "get_x", "get_width"),
    ):  # fmt: skip
        (box,) = axes[name].patches
        assert (getattr(box, low)(), getattr(box, size)()) == pytest.approx((1, 1))
    legends = [name for name, each in axes.items() if each.get_legend() is not None]
    assert legends == ["line", "points", "bars", "across"]


def test_maps_of_a_figure_share_one_scale_and_stacks_stand_on_each_other():
    def a_map(highest):
        return Layer("map", [0, 1, 2], [0, 1], z=np.array([[0, 1], [2, 3], [4, highest]]))

    stack = [Layer("stack", [0, 1], [1, 2], label=name) for name in "ab"]
    panels = [Panel([a_map(5)]), Panel([a_map(9)]), Panel(stack), Panel([], note="nothing")]
    figure = draw_figure(FigureData(panels, columns=2, colour_bar="m", legend_below=True))
    first, second, piled, empty = figure.axes[:4]
    for axes in (first, second):
        assert axes.collections[0].get_clim() == (0, 9)
        assert axes.get_aspect() == 1
    assert np.asarray(second.collections[0].get_array()).tolist() == [[0, 2, 4], [1, 3, 9]]
    assert [ends_of(each)[1] for each in piled.collections] == [2, 4]
    assert [text.get_text() for text in empty.texts] == ["nothing"]
    assert empty.texts[0].get_position() == (0.5, 0.5)
    assert list(empty.get_xticks()) == []
    assert figure.axes[4].get_ylabel() == "m"
    (legend,) = figure.legends
    assert sorted(text.get_text() for text in legend.get_texts()) == ["a", "b"]
    assert piled.get_legend() is None


@pytest.mark.parametrize(("shared", "scale"), [(True, "linear"), (False, "symlog")])
def test_ticks_are_names_of_places_or_numbers_and_axes_are_shared_where_said(shared, scale):
    long = "a name that is long"
    panels = [
        Panel([Layer("line", [1, 2], [1, 5])], "x", "y", x_ticks=["one", long], y_scale=scale),
        Panel([Layer("line", [1, 2], [1, 50])], "x", "y", x_ticks=[1.0, 1.5], y_ticks=["a", "b"]),
    ]
    figure = draw_figure(FigureData(panels, columns=2, share_y=shared))
    left, right = figure.axes
    assert left.get_yscale() == scale
    assert left.get_xticks().tolist() == [0, 1]
    labels = [text.get_text() for text in left.get_xticklabels()]
    assert labels == ["one", long]
    assert {text.get_rotation() for text in left.get_xticklabels()} == {20.0}
    assert right.get_xticks().tolist() == [1.0, 1.5]
    assert {text.get_rotation() for text in right.get_xticklabels()} == {0.0}
    if not shared:  # else they stand at the left
        assert [text.get_text() for text in right.get_yticklabels()] == ["a", "b"]
    assert (left.get_ylim() == right.get_ylim()) is shared
    assert (right.get_ylabel() == "") is shared


def test_effects_stand_in_their_order_with_their_intervals():
    numbers = {"main": [0.1, 0.5, 0.3], "main_half": [0.01, 0.02, 0.03],
               "total": [0.2, 0.6, 0.4], "total_half": [0.04, 0.05, 0.06]}  # fmt: skip
    arrays: Any = {name: np.array(each) for name, each in numbers.items()}
    made = Effects("cof", "1", "sobol", paths=("a", "b", "c"), basis="runs", **arrays)
    (axes,) = design_study.effects_figure(made).axes
    assert [text.get_text() for text in axes.get_yticklabels()] == ["a", "c", "b"]
    bars: Any = [each for each in axes.containers if each.get_label() in ("ST", "S1")]
    for container, name, up in zip(bars, ("total", "main"), (0.2, -0.2), strict=True):
        assert [bar.get_width() for bar in container] == sorted(numbers[name])
        middles = [bar.get_y() + bar.get_height() / 2 for bar in container]
        assert middles == pytest.approx([up, 1 + up, 2 + up])
        halves = [(end[0] - begin[0]) / 2
                  for begin, end in container.errorbar.lines[2][0].get_segments()]  # fmt: skip
        assert halves == pytest.approx([numbers[f"{name}_half"][k] for k in (0, 2, 1)])
    assert axes.get_xlim()[0] == 0
    assert "variance" in axes.get_xlabel()


def test_shoes_of_a_place_stand_by_their_chance_to_be_the_best():
    shoes = [
        fake(best=best, slips=SourcedValue(value, interval=ends), shoe=fake(name=name))
        for name, best, value, ends in (
            ("a", 0.7, 0.1, (0.05, 0.2)), ("b", 0.1, 0.45, (0.3, 0.6)), ("c", 0.2, 0.3, (0.2, 0.4)),
        )
    ]  # fmt: skip
    (axes,) = places.slips_figure(cast(Any, fake(shoes=shoes))).axes
    labels = [text.get_text() for text in axes.get_yticklabels()]
    assert labels == ["b (10 %)", "c (20 %)", "a (70 %)"]
    assert xy(axes.lines[0]) == (pytest.approx([45, 30, 10]), pytest.approx([0, 1, 2]))
    reach = [(low[0], high[0]) for low, high in cast(Any, axes.collections[0]).get_segments()]
    assert reach == [pytest.approx(ends) for ends in ((30, 60), (20, 40), (5, 20))]
    assert axes.get_xlim() == (0, 100)
    assert axes.get_ylim() == pytest.approx((-0.6, 2.6))


# the chart of pages without pictures


@pytest.mark.parametrize(
    ("most", "ticks"),
    [(1.0, [0, 0.2, 0.4, 0.6, 0.8, 1]), (0.0, [0, 0.2, 0.4, 0.6, 0.8, 1]),
     (2.3, [0, 0.5, 1, 1.5, 2, 2.5]), (12.0, [0, 5, 10, 15]), (40.0, [0, 10, 20, 30, 40]),
     (0.05, [0, 0.01, 0.02, 0.03, 0.04, 0.05]), (101.0, [0, 50, 100, 150])],
)  # fmt: skip
def test_ticks_of_a_chart_are_round_and_reach_beyond_its_highest(most, ticks):
    assert chart._ticks(most) == pytest.approx(ticks)


def test_a_chart_has_its_ticks_at_their_places_and_a_key_a_line():
    x = [0.0, 1.0, 2.0, 4.0]
    svg = chart.line_chart(x, [("a", [0, 1, np.nan, 4]), ("b", [4, 3, 2, 0])], "t", "<N>")
    lines = re.findall(r'points="([^"]*)"', svg)
    first, second = (
        [tuple(map(float, at.split(","))) for at in line.split()] for line in lines
    )  # fmt: skip
    left, right, low, high = chart.LEFT, chart.WIDTH - 10, chart.HEIGHT - chart.BOTTOM, chart.TOP
    quarter = (right - left) / 4
    assert first[1] == pytest.approx((left + quarter, low - (low - high) / 4), abs=0.06)
    assert len(first) == 3  # what is not known is left out
    assert second == [
        pytest.approx((left + k * quarter, low - (low - high) * y / 4), abs=0.06)
        for k, y in ((0, 4), (1, 3), (2, 2), (4, 0))
    ]
    texts = re.findall(r'<text x="([\d.]+)" y="([\d.]+)" text-anchor="(\w+)">([^<]*)<', svg)
    up = {text: float(y) for x, y, anchor, text in texts if float(x) == left - 6}
    assert up == {str(k): pytest.approx(low - (low - high) * k / 4 + 4, abs=0.06) for k in range(5)}
    across = [(float(x), anchor) for x, y, anchor, _ in texts if float(y) == low + 16]
    assert across[:-1] == [
        (pytest.approx(left + k * quarter, abs=0.06), "middle") for k in range(4)
    ]
    assert across[-1] == (chart.WIDTH - 1, "end")
    keys = [float(x) for x in re.findall(r'<path d="M([\d.]+) 12h26"', svg)]
    assert keys == [left, left + 190]
    assert re.findall(r'<text x="(\d+)" y="16">([^<]*)<', svg) == [
        (str(left + 32), "a"), (str(left + 222), "b"),
    ]  # fmt: skip
    grid = [float(y) for y in re.findall(rf'M{left} ([\d.]+)H{chart.WIDTH - 10}"', svg)]
    assert grid == pytest.approx([low - (low - high) * k / 4 for k in range(5)], abs=0.06)
    assert "<title>&lt;N&gt; over t</title>" in svg
    middle = re.findall(r'x="([\d.]+)" y="(\d+)" text-anchor="middle">t<', svg)
    assert [tuple(map(float, at)) for at in middle] == [((left + chart.WIDTH) / 2, 264)]
    turned = re.findall(r"translate\(14 ([\d.]+)\)", svg)
    assert [float(at) for at in turned] == [(low + high) / 2]
