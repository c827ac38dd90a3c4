"""Maps, scenes and pages of soles: what is drawn where, thinned how, and in which unit."""

import base64
import dataclasses
import zlib
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
import xarray
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from underfoot.case import load
from underfoot.core.fields import from_xarray
from underfoot.explore.record import Ending
from underfoot.report import light_mesh, live_study, maps, outsole, results, studies_page, viewer
from underfoot.report.drawn_sole import DrawnSole
from underfoot.report.quantities import ColourScale, DrawnQuantity, inside, scale, shown_values
from underfoot.report.surface_mesh import SurfaceMesh, _Edges
from underfoot.shoe import Heel, Tread, heel_surface
from underfoot.shoe.files import FileSettings
from underfoot.shoe.tread_measures import channel_depth, tread_measures
from viewer_fields import unpacked

PRESSURE = DrawnQuantity("fluid_pressure", "Fluid pressure", 1e3, "kPa", stress=True)
RATIO = DrawnQuantity("film_thickness", "Film", 1e-6, "µm", logarithmic=True)


def fake(**parts) -> Any:
    return SimpleNamespace(**parts)


def sole_data(**more):
    """A sole of 40 by 20 mm on cells of 2 mm, with sensors below it."""
    x, y = 1e-3 * np.arange(1.0, 40, 2), 1e-3 * (np.arange(1.0, 20, 2) - 10)
    made = {
        "fluid_pressure": (("x", "y"), np.outer(x, 0 * y + 1e6), {"units": "Pa"}),
        "inside": (("x", "y"), np.ones((20, 10), bool)),
        **more,
    }
    return from_xarray(xarray.Dataset(made, coords={"x": x, "y": y}))


# maps


def test_a_sole_is_framed_with_its_walking_direction_above_and_a_bar_of_its_size_below():
    for long, length in ((100.0, 10), (200.0, 50)):
        axes = Figure().subplots()
        x, y = np.linspace(0, long, 11), np.linspace(-20, 30, 6)
        covered = np.ones((11, 6), bool)
        covered[0] = covered[:, 0] = False
        maps.frame_sole(axes, x, y, covered)
        size, low, right = long - long / 10, long / 10, 30.0
        assert axes.get_xlim() == pytest.approx((-10 - 0.06 * size, 30 + 0.06 * size))
        assert axes.get_ylim() == pytest.approx((low - 0.16 * size, long + 0.2 * size))
        (bar,) = axes.lines
        assert bar.get_xdata() == pytest.approx([right - length, right])
        assert bar.get_ydata() == pytest.approx([low - 0.08 * size] * 2)
        arrow, words, told = axes.texts
        assert cast(Any, arrow).xy == pytest.approx((10, long + 0.16 * size))
        assert arrow.get_position() == pytest.approx((10, long + 0.05 * size))
        assert words.get_position() == pytest.approx((10 + 0.03 * size, long + 0.1 * size))
        assert told.get_text() == f"{length} mm"
        assert told.get_position() == pytest.approx(
            (right - length / 2, low - 0.095 * size)
        )  # fmt: skip
        assert axes.get_aspect() == 1


@pytest.mark.parametrize("count", [3, 12, 13])
@pytest.mark.parametrize("inlet", [None, 6e-3])
def test_few_sensors_are_inlets_and_many_are_tracks(count, inlet):
    along, across = np.linspace(5e-3, 35e-3, count), np.array([-4e-3, 6e-3])
    reading = (("sensor_x", "sensor_y"), np.zeros((count, 2)),
               {"inlet_diameter": inlet} if inlet else {})  # fmt: skip
    data = xarray.Dataset(
        {"sensor_pressure": reading}, coords={"sensor_x": along, "sensor_y": across}
    )
    axes = Figure().subplots()
    maps._draw_sensors(axes, from_xarray(data))
    circles = [each for each in axes.patches if isinstance(each, Circle)]
    if count > 12:
        assert not circles
        tracks = [
            segment for each in cast(Any, axes.collections) for segment in each.get_segments()
        ]
        assert [tuple(track[:, 0]) for track in tracks] == [(-4, -4), (6, 6)]
        assert np.ptp([track[:, 1] for track in tracks]) == pytest.approx(30)
    else:
        assert {each.radius for each in circles} == {3.0 if inlet else 2.0}
        places = sorted((round(x, 6), round(y, 6)) for x, y in (each.center for each in circles))
        assert places == sorted((y, round(1e3 * x, 6)) for y in (-4.0, 6.0) for x in along)
    nothing = Figure().subplots()
    maps._draw_sensors(nothing, sole_data())
    assert not nothing.patches
    assert not nothing.get_legend()


def test_differences_end_at_their_quantile_alike_on_both_sides():
    rng = np.random.default_rng(3)
    change = rng.normal(size=(50, 40))
    change[0, 0] = np.nan
    style, limits = maps._difference_style([change], PRESSURE)
    reach = np.nanquantile(np.abs(change), 0.995)
    assert (limits.low, limits.high) == pytest.approx((-reach, reach), rel=0.01)
    assert (style.unit, style.logarithmic) == ("kPa", False)
    still = maps._difference_style([np.zeros((3, 3))], PRESSURE)[1]
    assert (still.low, still.high) == (-1, 1)
    few = np.zeros((100, 100))
    few[0, :5] = 7.0  # where next to nothing changes, what does is shown
    assert maps._difference_style([few], PRESSURE)[1].high == pytest.approx(7)
    ratio = np.exp(change)
    style, limits = maps._difference_style([ratio], RATIO)
    sizes = np.exp(np.abs(change[np.isfinite(change)]))
    assert limits.high == pytest.approx(np.quantile(sizes, 0.995))
    assert limits.low == pytest.approx(1 / limits.high)
    assert style.logarithmic
    same = maps._difference_style([np.ones((3, 3))], RATIO)[1]
    assert (same.low, same.high) == pytest.approx((1 / 1.05, 1.05))
    assert maps._difference_style([np.full((2, 2), np.nan)], RATIO)[1].high == 1.05


def test_a_comparison_has_a_map_a_sole_and_one_of_each_difference_to_the_first():
    rising = sole_data()
    twice, thrice = (
        rising.assign({"fluid_pressure": (("x", "y"), k * rising["fluid_pressure"].values,
                                          {"units": "Pa"})}) for k in (2, 3)
    )  # fmt: skip
    figure = maps.comparison_figure([rising, twice, thrice], PRESSURE)
    drawn = figure.axes[:5]
    titles = [axes.get_title() for axes in drawn]
    assert titles == [*(f"{letter}: fluid pressure" for letter in "ABC"), "B less A", "C less A"]
    meshes = [axes.collections[0] for axes in drawn]
    kilopascals = 1e3 * np.asarray(rising["x"].values)
    for mesh, factor in zip(meshes, (1, 2, 3, 1, 2), strict=True):
        values = np.asarray(mesh.get_array()).reshape(20, 10)
        assert values[:, 4] == pytest.approx(factor * kilopascals)
    for mesh in meshes[:3]:
        assert mesh.get_clim() == pytest.approx((0, 117))
    assert meshes[3].get_clim() == meshes[4].get_clim()
    bars = [axes for axes in figure.axes if axes not in drawn]
    assert len(bars) == 2


@pytest.mark.parametrize("cut", [True, False])
def test_a_colour_bar_has_the_unit_and_the_peak_beyond_it(cut):
    axes = Figure().subplots()
    values = np.array([[1.0, 2.0], [3.0, 40.0]])
    limits = ColourScale(0.0, 4.0 if cut else 40.0, 40.0)
    maps.draw_field(axes, np.arange(2.0), np.arange(2.0), values, PRESSURE, limits)
    bar = axes.figure.axes[1]
    assert bar.get_title() == ("kPa\npeak 40" if cut else "kPa")
    assert axes.collections[0].get_clim() == (0, limits.high)
    assert maps._tallness(sole_data()) == pytest.approx((0.038 + 0.015) / 0.018)


@pytest.mark.parametrize(
    ("values", "quantity", "found"),
    [
        ([1.0, 5.0, 2.0], PRESSURE, (0.0, 5.0, 5.0)),
        ([-2.0, 5.0], PRESSURE, (-5.0, 5.0, 5.0)),
        ([-7.0, 5.0], PRESSURE, (-7.0, 7.0, 5.0)),
        ([0.0, 0.0], PRESSURE, (0.0, 1e-12, 0.0)),
        ([2.0, 8.0, 0.0], RATIO, (2.0, 8.0, 8.0)),
        ([4.0, 4.0], RATIO, (4.0, 4.04, 4.0)),
        ([np.nan], RATIO, (0.0, 1.0, 0.0)),
    ],
)
def test_a_scale_holds_what_is_drawn(values, quantity, found):
    made = scale([np.array(values)], quantity)
    assert (made.low, made.high, made.peak) == pytest.approx(found)


def test_where_a_sole_is_stands_in_its_heights_where_nothing_else_says_it():
    data, heights = sole_data(), np.full((20, 10), 1e-3)
    heights[:3] = np.nan
    coords = {"x": data["x"].values, "y": data["y"].values}
    for name, count in (("height", 170), ("p", 200)):
        told = from_xarray(xarray.Dataset({name: (("x", "y"), heights)}, coords=coords))
        assert inside(told).sum() == count
    assert inside(data).all()


@pytest.mark.parametrize("stress", [True, False])
def test_next_to_nothing_is_drawn_but_of_a_stress(stress):
    more: dict[str, Any] = {"stress": True} if stress else {}
    values = np.array([0.0, 0.9e-3, 1.1e-3, 1.0])
    found = shown_values(values, DrawnQuantity("a", "", 0.5, "", **more))
    assert np.isnan(found).tolist() == [stress, stress, False, False]
    assert found[2:] == pytest.approx([2.2e-3, 2.0])
    signed = shown_values(values - 0.5, DrawnQuantity("a", "", 1.0, "", **more))
    assert not np.isnan(signed).any()


# the viewer


def integers(stored):
    planes = np.frombuffer(zlib.decompress(base64.b64decode(stored["data"])), np.uint8)
    whole = np.ascontiguousarray(planes.reshape(4, -1).T).view("<u4")
    rows, columns = stored["size"]
    return whole.reshape(columns, rows).T.astype(np.int64)


def test_a_surface_is_packed_and_read_back():
    rng = np.random.default_rng(2)
    points = rng.uniform([-1, 2, 0], [3, 2.5, 0.1], size=(40, 3))
    points[:, 2] *= 1e-3
    triangles = rng.integers(0, 40, size=(70, 3))
    surface = SurfaceMesh(points, np.arange(40) % 3 == 0, triangles, triangles[:5, [0, 1, 2, 0]],
                          triangles[:7, :2])  # fmt: skip
    stored = viewer._packed_surface(surface)
    steps = integers(stored["points"])
    again = np.array(stored["low"]) + steps * np.array(stored["steps"])
    assert (np.abs(again - points) <= 0.51 * np.ptp(points, axis=0) / 65_535).all()
    assert (steps.min(axis=0), steps.max(axis=0)) == (
        pytest.approx([0, 0, 0]), pytest.approx([65_535] * 3),
    )  # fmt: skip
    assert (integers(stored["land"])[:, 0] > 0).tolist() == surface.land.tolist()
    for name in ("triangles", "walls", "sides"):
        np.testing.assert_array_equal(integers(stored[name]), getattr(surface, name))


@pytest.mark.parametrize(
    ("count", "most", "row"),
    [(1, 3, 1), (3, 3, 3), (4, 3, 2), (5, 3, 3), (7, 3, 3), (8, 4, 4), (9, 4, 3), (12, 4, 4)],
)
def test_soles_stand_in_even_rows(count, most, row):
    assert viewer._per_row(count, most) == row


@pytest.mark.parametrize("part", [False, True])
def test_a_pane_says_where_it_was_computed_and_holds_its_states(part):
    height = np.arange(12.0).reshape(4, 3)
    whole = slice(0, 4), slice(0, 3)
    sole = DrawnSole(np.arange(4.0), np.arange(3.0), 1.0, height, None, height > 3,
                     (slice(1, 3), slice(0, 2)) if part else whole, whole)  # fmt: skip
    mesh = SurfaceMesh(np.eye(3), np.ones(3, bool), *(np.array([[0, 1, 2, 0]])[:, :k]
                                                      for k in (3, 4, 2)))  # fmt: skip
    made = viewer.pane("a", sole, {"p": height}, mesh, histories={"p": {"labels": []}},
                       states=[(2 * height, height > 5, mesh)])  # fmt: skip
    assert made["computed"] == ([1, 3, 0, 2] if part else None)
    assert (made["nx"], made["ny"], made["x0"], made["y0"], made["spacing"]) == (4, 3, 0, 0, 1.0)
    assert made["pressed"] is None
    assert unpacked(made["fields"]["p"], (4, 3)) == pytest.approx(height, rel=1e-3)
    (state,) = made["states"]
    assert unpacked(state["height"], (4, 3)) == pytest.approx(2 * height, rel=1e-3)
    assert unpacked(state["land"], (4, 3)).sum() == 6


def test_a_long_history_is_thinned_evenly_and_that_of_a_march_is_of_one_sole(monkeypatch):
    count = 9
    frames = 1e3 * np.arange(count)[:, None, None] * np.ones((count, 20, 10))
    data = sole_data().assign(
        {"fluid_pressure_history": (("instant", "x", "y"), frames, {"units": "Pa"})}
    )
    monkeypatch.setattr(viewer, "_MOST_HISTORY_CELLS", 5 * 200)
    found = viewer._history(data, PRESSURE, True)
    assert found is not None
    times, shown = found
    assert times.tolist() == [0, 2, 4, 6, 8]
    assert shown[1:, 3, 3] == pytest.approx([2, 4, 6, 8])
    monkeypatch.setattr(viewer, "_MOST_HISTORY_CELLS", 1)
    assert cast(Any, viewer._history(data, PRESSURE, True))[0].tolist() == [0, 8]
    march = sole_data().assign(
        {"fluid_pressure_history": ((viewer.MARCH, "x", "y"), frames, {"units": "Pa"})}
    )
    assert viewer._history(march, PRESSURE, False) is None
    assert viewer._history(march, PRESSURE, True) is not None
    assert viewer._history(sole_data(), PRESSURE, True) is None


def test_a_list_of_quantities_has_scale_unit_and_loads_and_differences_their_colours():
    fields = [np.array([[0.0, 2.0], [np.nan, 5.0]]), np.array([[9.0]])]
    listed = viewer.listed_quantity(PRESSURE, fields, [90.0, None, 250.0])
    assert (listed["low"], listed["high"], listed["peak"], listed["cut"]) == (0, 9, 9, False)
    assert (listed["unit"], listed["factor"], listed["log"], listed["stress"]) == (
        "kPa", 1e3, False, True,
    )  # fmt: skip
    assert [load.split()[0] for load in listed["loads"]] == ["90", "250"]
    one, two = ({"name": name} for name in "ab")
    assert set(viewer.scene([one], [listed])["colours"]) == {PRESSURE.colours}
    both = viewer.scene([one, two], [listed], "Wear")
    assert set(both["colours"]) == {PRESSURE.colours, "RdBu_r"}
    assert both["steps"] == "Wear"
    data = sole_data().assign({f"lug_{name}": ("lug", np.array([k, np.nan])) for k, name in
                               enumerate(("x", "y", "groove", "groove_side"))})  # fmt: skip
    assert viewer._lugs(data) == [[0, 1, 2, 3], [0, 0, 0, 0]]
    assert viewer._lugs(sole_data()) == []


# an outsole from a file


@pytest.fixture(scope="module")
def surface():
    heel = Heel(
        length=0.05, width=0.04, rear_radius=0.015, outsole_thickness=0.02,
        tread=Tread("grid", lug_width=8e-3, channel_width=4e-3, depth=3e-3),
    )  # fmt: skip
    return heel_surface(heel, spacing=0.5e-3)


def inspection(surface, tmp_path, *, thickness: float | None = 0.0123, **settings) -> Any:
    file = tmp_path / "soles" / "mine.stl"
    file.parent.mkdir(exist_ok=True)
    file.write_text("a solid")
    read = fake(
        surface=surface, thickness=thickness, draft=None, faces=12, format="STL", unit=1e-3,
        down="-z", forward="+x", foot="", whole_length=0.05,
        soundness=dataclasses.make_dataclass("Sound", ["open"])(0),
    )  # fmt: skip
    measures = tread_measures(surface)
    return outsole.OutsoleInspection(file, FileSettings(**settings), cast(Any, read), measures)


@pytest.mark.parametrize("thickness", [None, 0.0123])
def test_measures_of_an_outsole_stand_in_their_units(surface, tmp_path, thickness):
    shown = inspection(surface, tmp_path, thickness=thickness)
    rows = dict(shown.table().rows)
    m = shown.measures
    assert rows["Length x width"] == f"{1e3 * m.length:.4g} x {1e3 * m.width:.4g} mm"
    assert rows["Plan area"] == f"{1e4 * m.plan_area:.4g} cm²"
    assert rows["Land"] == f"{m.land_ratio:.0%} of the plan area"
    depth = [f"{1e3 * each:.3g}" for each in m.channel_depth]
    assert rows["Channel depth, median"] == (
        f"{depth[1]} mm  (10 to 90 %: {depth[0]} to {depth[2]})"
    )
    assert ("Thickness over the land, median" in rows) is (thickness is not None)
    assert rows["Draft of the walls"] == "none"
    assert rows["Sipes"] == "none"
    assert rows["  largest circle in it"] == f"{1e3 * m.patch_circle:.3g} mm"
    table = dict(shown.data_tables()["measures"].rows)
    assert table["plan_area_m2"] == m.plan_area
    assert table["length_m"] == m.length
    assert [table[f"channel_depth_{share}pct_m"] for share in outsole.SHARES] == list(
        m.channel_depth
    )
    assert table["lug_count"] == m.lug_count
    sipes = dataclasses.replace(m, sipe_count=3, sipe_length=0.045)
    assert outsole._sipes(sipes).startswith("3, 45 mm in all")


@pytest.mark.parametrize("thickness", [None, 0.0123])
def test_a_case_of_an_outsole_says_what_was_set_and_leaves_the_rest_open(
    surface, tmp_path, thickness
):
    shown = inspection(
        surface, tmp_path, thickness=thickness, unit="mm", mirror=True, solid="a", spacing=0.4e-3,
        region="heel", region_length=0.07, side="left",
    )  # fmt: skip
    text = outsole.case_text(shown, tmp_path)
    lines = text.splitlines()
    for line in ('unit = "mm"', '# down = "auto"', '# forward = "auto"', 'region = "heel"',
                 "mirror = true", 'solid = "a"', 'side = "left"', 'region_length = "70 mm"',
                 'map_spacing = "0.4 mm"', 'file = "soles/mine.stl"', 'name = "mine"'):  # fmt: skip
        assert line in lines, line
    assert "cut_floor = true" not in lines
    (thick,) = [line for line in lines if line.startswith("outsole_thickness")]
    assert thick.startswith(f'outsole_thickness = "{"15" if thickness is None else "12.3"} mm"')
    plain = outsole.case_text(inspection(surface, tmp_path), tmp_path)
    for line in ("mirror", "solid", "side", "region_length", "map_spacing", "unit", "region"):
        assert not [each for each in plain.splitlines() if each.startswith(f"{line} =")]
    taken = outsole.case_shoe(shown, tmp_path)
    assert taken["outsole"]["file"] == "soles/mine.stl"


@pytest.mark.parametrize("most", [10**6, 2000])
def test_an_outsole_is_drawn_thinned_where_it_has_many_cells(surface, tmp_path, monkeypatch, most):
    monkeypatch.setattr(outsole, "_MOST_CELLS", most)
    shown = outsole.outsole_scene(inspection(surface, tmp_path))
    (pane,) = shown["panes"]
    every = int(np.ceil(np.sqrt(surface.height.size / most)))
    assert every == (1 if most > 10**5 else every)
    assert pane["nx"] == len(surface.x[::every])
    assert pane["spacing"] == pytest.approx(every * surface.spacing)
    assert pane["nx"] * pane["ny"] <= 1.1 * most
    shape = pane["nx"], pane["ny"]
    height = unpacked(pane["fields"]["height"], shape)
    np.testing.assert_allclose(height, 1e3 * surface.height[::every, ::every], rtol=2e-3, atol=2e-3)
    depth = unpacked(pane["fields"]["channel_depth"], shape)
    land = surface.land[::every, ::every]
    assert np.isnan(depth[land]).all()
    wanted = 1e3 * channel_depth(surface)[::every, ::every]
    np.testing.assert_allclose(depth[~land], wanted[~land], rtol=2e-3, atol=2e-3)


def test_parts_of_a_tread_have_their_colours_and_heights_are_written_in_millimetres(
    surface, tmp_path
):
    measures = tread_measures(surface)
    figure = outsole.outsole_figure(surface, measures)
    heights, _, parts = (axes for axes in figure.axes if axes.get_xlim()[1] > 5)
    known = 1e3 * surface.height[surface.inside]
    assert heights.collections[0].get_clim() == pytest.approx((known.min(), known.max()))
    values = np.ma.masked_invalid(np.asarray(parts.collections[0].get_array())).reshape(
        surface.height.shape
    )
    assert (values[surface.land & ~outsole.largest_patch(surface)] == 0).all()
    assert (values[outsole.largest_patch(surface)] == 3).all()
    assert values.count() == surface.inside.sum()
    assert parts.collections[0].get_clim() == (-0.5, 3.5)  # a colour a part
    assert parts.get_title() == f"Land {measures.land_ratio:.0%} of the plan form"
    path = tmp_path / "heights.csv.gz"
    inspection(surface, tmp_path).write_heights(path)
    again = np.loadtxt(path, delimiter=",")
    np.testing.assert_allclose(again, 1e3 * surface.height, atol=6e-5)


# results and studies


def test_the_surfaces_of_the_last_few_cases_are_kept(monkeypatch):
    case = load(Path(__file__).parents[2] / "examples" / "work_shoe_full_tread_glycerol.toml")
    made = []
    monkeypatch.setattr(results, "_surfaces", {})

    def surface_of(*given, **told):
        made.append((given, told))
        return len(made)

    flat = np.zeros((3, 3))
    sole = fake(whole=None, cut="cut", inside=flat == 0, clearance=flat, x=flat[0], y=flat[0],
                land=flat == 0)  # fmt: skip
    monkeypatch.setattr(results, "drawn_map", lambda *_: sole)
    monkeypatch.setattr(results, "surface_mesh", surface_of)
    for k in range(results.SURFACES_KEPT + 2):
        results.designed_surface(case, 1e-3 * (k + 1))
    assert results.designed_surface(case, 3e-3) == 3
    assert len(made) == results.SURFACES_KEPT + 2
    assert len(results._surfaces) == results.SURFACES_KEPT
    assert made[0][1] == {"cut": "cut"}
    results.designed_surface(case, 1e-3)
    assert len(made) == results.SURFACES_KEPT + 3


@pytest.mark.parametrize("several", [False, True])
def test_a_page_of_studies_has_the_title_of_one_or_of_all(monkeypatch, several):
    given = {}
    template = fake(render=lambda **parts: given.update(parts) or "page")
    monkeypatch.setattr(
        studies_page, "environment", lambda _: fake(get_template=lambda _: template)
    )
    import underfoot.studies.summary as summary
    import underfoot.studies.verdict as verdict

    monkeypatch.setattr(summary, "figure_rows", lambda results, names: names)
    monkeypatch.setattr(summary, "headline", lambda results: len(results))
    monkeypatch.setattr(
        verdict, "tables_by_kind", lambda _: [(fake(heading="h"), "t"), (fake(heading="i"), "u")]
    )

    def png(width, height):
        return bytes(16) + width.to_bytes(4, "big") + height.to_bytes(4, "big")

    studies = [
        fake(study=fake(name=name, title=f"title {name}", figures=[(1, 2, "one", f"of {name}")]),
             computed=fake(tables=[]), judgements=[], remarks=list)
        for name in ("a", "b")[: 1 + several]
    ]  # fmt: skip
    images = {("a", "one"): png(260, 100), ("a", "two"): png(261, 100), ("b", "one"): png(1, 9)}
    assert studies_page.studies_page(cast(Any, studies), images, quick=True) == "page"
    assert given["several"] is several
    assert given["title"] == ("Printed and computed numbers" if several else "title a")
    assert given["headline"] == 1 + several
    first = given["sections"][0]
    assert [(name, remark, broad) for name, _, remark, broad in first["images"]] == [
        ("one", "of a", False), ("two", "", True),
    ]  # fmt: skip
    assert first["kinds"] == [("h", "t", True), ("i", "u", False)]
    assert given["figures"]["a"] == ["one", "two"]
    assert given["quick"] is True


def live(**parts) -> Any:
    made = object.__new__(live_study.LiveStudy)
    for name, value in parts.items():
        object.__setattr__(made, name, value)
    return made


def test_time_that_several_worked_at_once_counts_once():
    sessions = [{"began": 0.0, "ended": 10.0}, {"began": 4.0, "ended": 12.0},
                {"began": 20.0, "ended": None}, {"began": 5.0, "ended": 6.0}]  # fmt: skip
    assert live(sessions=sessions, now=25.0).running_seconds == 17.0
    assert live(sessions=[], now=25.0).running_seconds == 0.0


@pytest.mark.parametrize("known", [True, False])
def test_the_cost_of_a_study_is_that_of_what_ended_and_of_what_is_left(monkeypatch, known):
    monkeypatch.setattr(live_study, "time_text", lambda seconds: f"{seconds:g} s")
    monkeypatch.setattr(live_study, "size_text", lambda size: f"{size:g} B")
    cost = fake(cpu_seconds=20.0, disk=1000.0) if known else None
    endings = dict.fromkeys(Ending, 0) | {Ending.OPEN: 5, Ending.COMPUTED: 3,
                                                  Ending.FAILED: 1}  # fmt: skip

    class Shown(live_study.LiveStudy):
        pass

    scan = fake(case={"cpu_seconds": np.array([10.0, np.nan, 30.0])})
    for name, known_of in (
        ("cases_left", 5), ("seconds_left", 60.0), ("running_seconds", 40.0), ("scan", scan),
    ):  # fmt: skip
        setattr(Shown, name, known_of)
    made = object.__new__(Shown)
    object.__setattr__(made, "endings", endings)
    object.__setattr__(made, "cost", cost)
    rows = {row[0]: row[1:] for row in made.cost_table().rows}
    assert rows["Cases"] == ("4", "5")
    assert rows["Processor"] == ("40 s", "100 s" if known else "")
    assert rows["Disk"] == (("4000 B", "5000 B") if known else ("", ""))


@pytest.mark.parametrize(("count", "places"), [(3, [0, 4, 9]), (12, list(range(10))), (0, []),
                                               (-2, []), (1, [0])])  # fmt: skip
def test_items_are_thinned_evenly_from_first_to_last(count, places):
    assert live_study.thin_evenly(range(10), count) == places


def test_of_many_runs_the_front_the_best_the_last_and_an_even_rest_are_drawn(monkeypatch):
    monkeypatch.setattr(live_study, "MOST_SHOWN", 60)
    monkeypatch.setattr(live_study, "MOST_FRONT", 4)
    monkeypatch.setattr(live_study, "MOST_ROWS", 3)
    count, goal = 200, "cof"
    values = np.random.default_rng(0).permutation(count).astype(float)
    allowed = np.arange(count) % 2 == 0

    class Shown(live_study.LiveStudy):
        pass

    for name, known in (
        ("ended_runs", range(count)), ("front_runs", [2, 4, 6, 8, 10, 12, 14]),
        ("_values_of_runs", {goal: values}), ("_allowed_runs", allowed),
    ):  # fmt: skip
        setattr(Shown, name, known)

    made = object.__new__(Shown)
    object.__setattr__(made, "plan", fake(goals=[goal], signs=[-1.0]))
    chosen = made.shown_runs
    assert len(chosen) == 60
    assert chosen == sorted(set(chosen))
    good = np.flatnonzero(allowed)[np.argsort(-values[allowed])]
    for must in (good[:3], good[-1:], range(count - 20, count), (2, 6, 10, 14)):
        assert {*map(int, must)} <= {*chosen}
    rest = np.diff([k for k in chosen if k < count - 20])
    assert rest.max() < 15
    assert "7" in made.drawn_text()
    few = object.__new__(Shown)
    monkeypatch.setattr(Shown, "ended_runs", list(range(60)))
    assert list(few.shown_runs) == list(range(60))


# lines of a drawing


def test_a_way_along_a_drawn_line_passes_its_corners_in_their_order():
    square = np.array([[0, 0], [10, 0], [10, 10], [0, 10], [0, 0]], float)
    lines = np.stack([square[:-1], square[1:]], axis=1)
    edges = _Edges(lines, 1.0)
    places = np.array([[8.0, 0.5], [10.5, 3.0], [9.6, 8.0]])
    onto, near, part, along = edges.nearest(places)
    assert onto == pytest.approx(np.array([[8, 0], [10, 3], [10, 8]]), abs=1e-6)
    assert near.all()
    assert np.unique(part).size == 1
    way = edges.between(part, along)
    assert way is not None
    forth = np.array([[8, 0], [10, 0], [10, 8]])
    assert way == pytest.approx(forth, abs=1e-6)
    back = edges.between(part[::-1], along[::-1])
    assert back == pytest.approx(forth[::-1], abs=1e-6)
    steps = np.array([[0.2, 3.0], [0.1, 0.2], [3.0, 0.1]])  # past where the line is closed
    _, _, part, along = edges.nearest(steps)
    across = edges.between(part, along)
    assert across is not None
    assert across[[0, -1]] == pytest.approx(np.array([[0, 3], [3, 0]]), abs=1e-6)
    assert np.abs(across - [0, 0]).sum(axis=1).min() == pytest.approx(0, abs=1e-6)
    far = edges.nearest(np.array([[5.0, 4.0], [5.0, 1.5]]))
    assert not far[1].any()
    assert far[0] == pytest.approx(np.array([[5, 4], [5, 1.5]]))
    assert edges.between(part[:0], along[:0]) is None
    assert edges.between(np.array([0, 1]), np.zeros(2)) is None
    jump = edges.nearest(np.array([[1.0, 0.0], [9.5, 0.0]]))
    assert edges.between(jump[2], jump[3]) is None  # 8.5 cells between places
    cut = _Edges(np.array([[[5.0, -5.0], [5.0, 15.0]]]), 1.0)
    assert cut.crossing(0, edges, np.array([5.5, 1.0])) == pytest.approx([5, 0])
    assert cut.crossing(0, edges, np.array([5.5, 9.0])) == pytest.approx([5, 10])
    assert cut.crossing(0, edges, np.array([5.5, 5.0])) == pytest.approx([5.5, 5.0])


def test_sides_of_a_body_reach_its_top_and_walls_stand_on_the_lower_level():
    flat = np.zeros((6, 6))
    sole = DrawnSole(np.arange(6.0), np.arange(6.0), 1.0, flat, None, flat == 0,
                     (slice(0, 6), slice(0, 6)), (slice(0, 6), slice(0, 6)))  # fmt: skip
    points = np.array([[0, 0, 0], [4, 0, 0], [0, 0, 3], [4, 0, 3]], float)
    empty = np.empty((0, 3), np.int64)
    mesh = SurfaceMesh(points, np.array([True, True, False, False]), empty,
                       np.array([[2, 3, 0, 1]]), np.array([[0, 1]]))  # fmt: skip
    corners, triangles = light_mesh._upright(mesh, points, sole)
    wall, side = corners[:4], corners[4:]
    assert wall.tolist() == points[[0, 1, 3, 2]].tolist()
    assert side[:2].tolist() == points[:2].tolist()
    assert side[2:, 2] == pytest.approx([3 + light_mesh.BODY] * 2)
    assert side[2:, 0].tolist() == [4, 0]
    assert triangles.tolist() == [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]]
    none = dataclasses.replace(mesh, walls=np.empty((0, 4), int), sides=np.empty((0, 2), int))
    assert [len(each) for each in light_mesh._upright(none, points, sole)] == [0, 0]


def test_a_field_at_points_is_between_its_cells_and_of_the_nearest_beside_them():
    x, y = np.arange(5.0), np.arange(4.0)
    sole = DrawnSole(2 * x, 2 * y, 2.0, np.zeros((5, 4)), None, np.ones((5, 4), bool),
                     (slice(0, 5), slice(0, 4)), (slice(0, 5), slice(0, 4)))  # fmt: skip
    values = 3 * x[:, None] - y
    points = np.array([[1.0, 2.0, 9.0], [8.0, 6.0, 9.0], [-3.0, 0.0, 9.0]])
    assert light_mesh._at(sole, values, points) == pytest.approx([1.5 - 1, 12 - 3, 0])
    values[2] = np.nan
    at = light_mesh._at(sole, values, np.array([[4.0, 2.0, 0.0]]))
    assert at[0] in (pytest.approx(3 - 1), pytest.approx(9 - 1))
