"""What is drawn of a data set, on which scale, and how fields of different grids are compared."""

import dataclasses

import numpy as np
import pytest
import xarray
from hypothesis import given, settings
from hypothesis import strategies as st
from matplotlib.contour import QuadContourSet

from underfoot.core import SourcedValue, Status
from underfoot.core.fields import Fields, from_xarray
from underfoot.questions.comparison import compare
from underfoot.report import figures
from underfoot.report.common_grid import common_grid, difference, on_grid, sole_on_grid
from underfoot.report.maps import comparison_figure, grid_note, map_figure
from underfoot.report.quantities import DrawnQuantity, carried_load, drawn_values, quantities, scale
from underfoot.report.viewer import pack_array, viewer_scene
from viewer_fields import unpacked

PRESSURE = DrawnQuantity("contact_pressure", "", 1e3, "kPa")


def sole(side, *, shift=0.0, seed=0, **fields):
    """A disc of 20 mm radius with a field of pressure on cells of ``side``."""
    n = round(0.05 / side)
    x = shift + side * (np.arange(n) + 0.5) - 0.025
    y = side * (np.arange(n) + 0.5) - 0.025
    along, across = np.meshgrid(x, y, indexing="ij")
    inside = np.hypot(along, across) < 0.02
    waves = 2e5 * (1.5 + np.sin(along * 300 + seed) * np.cos(across * 250))
    given = {
        "contact_pressure": (np.where(inside, waves, 0.0), "Pa", "asperity contact pressure"),
        "fluid_pressure": (np.where(inside & (along > 0.0), 1e5, 0.0), "Pa", "fluid pressure"),
        "film_thickness": (np.full(inside.shape, 2e-5), "m", "mean gap"),
        "clearance": (np.where(inside, 1e-3 + along**2, np.inf), "m", "height"),
        **fields,
    }
    made = {
        name: (("x", "y"), values, {"units": unit, "long_name": title})
        for name, (values, unit, title) in given.items()
    }
    made["inside"] = (("x", "y"), inside, {"units": "1"})
    return xarray.Dataset(made, coords={"x": x, "y": y})


def as_result(worn_shoe_result, fields, **changes):
    return dataclasses.replace(worn_shoe_result, data=from_xarray(fields), **changes)


def test_a_field_that_is_not_known_is_drawn_by_its_own_labels():
    heat = np.full((50, 50), 3.0)
    found = {q.name: q for q in quantities([sole(1e-3, warmth=(heat, "K", "flash temperature"))])}
    assert found["warmth"].title == "Flash temperature"
    assert found["warmth"].unit == "K"
    assert list(found)[:4] == ["contact_pressure", "fluid_pressure", "film_thickness", "warmth"]
    assert list(found)[-1] == "clearance"
    assert "inside" not in found


def test_a_map_shows_its_lugs_where_they_are():
    place = np.linspace(-24.5e-3, 24.5e-3, 50)
    land = np.broadcast_to(np.abs(place[:, None]) < 5e-3, (50, 50)) * 1.0
    lugs = sole(1e-3, land=(land, "1", "land"))
    (pressure,) = [each for each in quantities([lugs]) if each.name == "contact_pressure"]
    axes = map_figure(lugs, pressure).axes[0]
    (lines,) = [each for each in axes.collections if isinstance(each, QuadContourSet)]
    edges = np.concatenate([path.vertices for path in lines.get_paths()])
    assert np.abs(edges[:, 1]) == pytest.approx(np.full(len(edges), 5.0))  # along the sole, mm
    assert (edges[:, 0].min(), edges[:, 0].max()) == pytest.approx((-24.5, 24.5))


def test_only_what_all_results_hold_is_compared():
    heat = np.full((50, 50), 3.0)
    both = quantities([sole(1e-3, warmth=(heat, "K", "flash temperature")), sole(1e-3)])
    assert "warmth" not in [q.name for q in both]


def test_a_pressure_tells_the_load_that_it_carries():
    dataset = sole(1e-3)
    found = {q.name: q for q in quantities([dataset])}
    half_disc = 0.5 * np.pi * 0.02**2
    assert carried_load(dataset, found["fluid_pressure"]) == pytest.approx(
        1e5 * half_disc, rel=0.02
    )
    assert carried_load(dataset, found["film_thickness"]) is None
    fluid = drawn_values(dataset, found["fluid_pressure"])
    assert np.isnan(fluid[dataset.fluid_pressure.values == 0]).all()


def test_a_lone_peak_does_not_swallow_the_scale_but_is_told():
    values = np.linspace(0.0, 10.0, 5000)
    values[7] = 500.0
    found = scale([values], PRESSURE)
    assert found.high == pytest.approx(10.0, rel=0.02)
    assert found.peak == 500.0
    assert found.cut
    assert not scale([values[8:]], PRESSURE).cut
    signed = scale([values - 4.0], PRESSURE)
    assert signed.low == -signed.high


@pytest.mark.parametrize("values", [np.zeros((4, 4)), np.full((4, 4), np.nan)])
def test_a_field_of_nothing_can_be_drawn(values):
    dataset = sole(1e-3, contact_pressure=(np.zeros((50, 50)), "Pa", "none"))
    assert map_figure(dataset, quantities([dataset])[0])
    assert scale([values], PRESSURE).high > 0.0


@settings(max_examples=30, deadline=None)
@given(fine=st.floats(0.3e-3, 0.9e-3), coarse=st.floats(1e-3, 2e-3), shift=st.floats(-1e-3, 1e-3))
def test_resampling_keeps_the_load(fine, coarse, shift):
    first, second = sole(coarse), sole(fine, shift=shift)
    grid = common_grid([first, second])
    assert grid.resampled
    assert grid.spacing == pytest.approx(coarse)
    for dataset in (first, second):
        side = float(np.diff(dataset.x[:2])[0])
        load = float(dataset.contact_pressure.sum()) * side**2 * 1e-3
        # cells on the rim count with what covers them
        there = sole_on_grid(dataset, grid)
        again = float(np.nansum(on_grid(dataset, PRESSURE, grid)[there])) * grid.spacing**2
        assert again == pytest.approx(load, rel=0.03)


def test_the_same_field_on_two_grids_differs_by_little_and_on_one_grid_by_nothing():
    grid = common_grid([sole(1e-3), sole(0.25e-3)])
    one, other = (on_grid(dataset, PRESSURE, grid) for dataset in (sole(1e-3), sole(0.25e-3)))
    change = difference(other, one, PRESSURE)
    within = np.hypot(grid.x[:, None], grid.y) < 0.018  # cells on the rim are partly covered
    assert np.nanmax(np.abs(change[within])) < 0.01 * np.nanmax(one)
    same = common_grid([sole(1e-3), sole(1e-3, seed=1)])
    assert not same.resampled
    field = on_grid(sole(1e-3), PRESSURE, same)
    assert np.nanmax(np.abs(difference(field, field, PRESSURE))) == 0.0
    film = DrawnQuantity("film_thickness", "", 1e-6, "µm", logarithmic=True)
    assert np.nanmax(difference(2.0 * field, field, film)) == pytest.approx(2.0)


@given(st.integers(0, 2**32 - 1), st.floats(1e-9, 1e9))
@settings(max_examples=40, deadline=None)
def test_packed_fields_unpack_to_three_digits(seed, size):
    values = size * np.random.default_rng(seed).random((7, 5))
    values[3, 2] = np.nan
    again = unpacked(pack_array(values), values.shape)
    assert np.isnan(again[3, 2])
    known = values > 1e-3 * size
    np.testing.assert_allclose(again[known], values[known], rtol=5e-4)


@pytest.mark.slow
def test_a_history_of_a_field_becomes_frames_and_a_long_one_is_thinned(worn_shoe_result):
    dataset = sole(1e-3)
    frames = np.stack([k * dataset.contact_pressure.values for k in range(1, 31)])
    dataset["contact_pressure_history"] = (("time", "x", "y"), frames, {"units": "Pa"})
    dataset = dataset.assign_coords(time=np.linspace(0.0, 0.1, 30))
    scene = viewer_scene([as_result(worn_shoe_result, dataset)])
    pane = scene["panes"][0]
    past = pane["histories"]["contact_pressure"]
    assert len(past["frames"]) == len(past["labels"]) == 30
    last = unpacked(past["frames"][-1], (pane["nx"], pane["ny"]))
    now = unpacked(pane["fields"]["contact_pressure"], (pane["nx"], pane["ny"]))
    np.testing.assert_allclose(last, 30 * now, rtol=2e-3)
    assert scene["quantities"][0]["peak"] >= np.nanmax(last) * 0.999


@pytest.mark.slow
def test_a_run_keeps_a_few_instants_of_its_march_and_shows_them_of_one_sole(
    worn_shoe_case, worn_shoe_result, tmp_path, monkeypatch
):
    from underfoot.compute import histories
    from underfoot.compute.run import run

    steady = worn_shoe_case.replace({"motion.steady": True, "numerics.tread_positions": 1})
    settled = run(steady)
    for result in (worn_shoe_result, settled):
        data = result.data
        times, load = data["march_time"].values, data["load_history"].values
        assert 4 <= times.size <= 12
        assert (np.diff(times) > 0).all()
        assert times[-1] == data["time"].values[-1]
        total = 0.0
        for name in ("contact_pressure", "fluid_pressure"):
            frames = data[f"{name}_history"].values
            assert frames.dtype == np.float32
            assert np.abs(frames[-1] - data[name].values).max() <= 50.1  # to 100 Pa
            total = total + frames.sum(axis=(1, 2), dtype=float)
        at = np.interp(times, data["time"].values, load)
        share = total / total[-1] * load[-1] / at
        assert share[1:] == pytest.approx(1.0, abs=0.02)  # at each instant they carry its load
        without = {k: v for k, v in data.data_vars.items() if data[k].dims[0] != "march_time"}
        sizes = []
        for number, fields in enumerate((data, Fields(without, data.coords))):
            fields.to_netcdf(tmp_path / f"{number}.nc")
            sizes.append((tmp_path / f"{number}.nc").stat().st_size)
        assert sizes[0] - sizes[1] < 100_000
        (pane,) = viewer_scene([result])["panes"]
        assert set(pane["histories"]) == {"contact_pressure", "fluid_pressure"}
        assert len(pane["histories"]["fluid_pressure"]["labels"]) == times.size
    assert not any(pane["histories"] for pane in viewer_scene([settled, settled])["panes"])
    monkeypatch.setattr(histories, "PICTURED_CELLS", 5 * data["clearance"].values.size)
    fewer = run(steady).data["march_time"].values
    assert 2 <= fewer.size <= 5
    assert (fewer[0], fewer[-1]) == (times[0], times[-1])


def cof(value, spread):
    return {"cof": SourcedValue(value, "1", uncertainty=spread, source="made up")}


def test_three_results_are_ranked_and_beyond_their_bands_or_not(worn_shoe_result):
    def made(name, value, spread, side=1e-3):
        hash_of = dataclasses.replace(worn_shoe_result.provenance, case_hash=name)
        scalars = {**worn_shoe_result.scalars, **cof(value, spread)}
        return as_result(
            worn_shoe_result, sole(side), name=name, scalars=scalars, provenance=hash_of
        )

    results = [made("a", 0.10, 0.02), made("b", 0.11, 0.02), made("c", 0.30, 0.02, side=2e-3)]
    comparison = compare(*results)
    assert [rank.name for rank in comparison.ranking] == ["c", "b", "a"]
    assert comparison.ranking[0].better_than_next > 0.999
    # Phi(0.01 / (0.02 sqrt 2)) = 0.638
    assert comparison.ranking[1].better_than_next == pytest.approx(0.638, abs=1e-3)
    assert comparison.ranking[2].better_than_next is None
    assert compare(results[1], results[0]).headline()[0].startswith("Whether b or a has more")
    assert comparison.ranking[0].interval == pytest.approx((0.2608, 0.3392))
    assert (
        comparison.headline()[0] == "c has the highest COF, 0.190 above b (probability above 99 %)."
    )
    cof_row = next(row for row in comparison.quantities if row.name == "cof")
    assert cof_row.different == ("C",)
    assert "coefficient of friction" in comparison.headline()[1]
    assert any("grids differ" in caution for caution in comparison.cautions())
    assert "2 mm" in grid_note([result.fields for result in results])
    assert len(figures(comparison)) == 4
    fields = [result.fields for result in results]
    assert len(comparison_figure(fields, quantities(fields)[0]).axes) >= 5
    failed = dataclasses.replace(results[1], status=Status.NOT_CONVERGED)
    none = compare(results[0], failed)
    assert none.headline()[0].startswith("No comparison: b is not converged")
    assert none.ranking == ()
    assert not none.usable
    assert figures(none) == {}


def test_shared_draws_decide_an_order(worn_shoe_result):
    def result(name, factor):
        provenance = dataclasses.replace(worn_shoe_result.provenance, case_hash=name)
        draws = worn_shoe_result.fields["cof_draws"]
        value = factor * worn_shoe_result.value("cof")
        return dataclasses.replace(
            worn_shoe_result,
            name=name,
            scalars={**worn_shoe_result.scalars, **cof(value, 0.4 * value)},
            provenance=provenance,
            data=from_xarray(worn_shoe_result.fields.assign(cof_draws=draws * factor)),
        )

    higher = compare(result("a", 1.0), result("b", 1.1)).ranking[0]
    assert (higher.name, higher.better_than_next) == ("b", 1.0)
    equal = compare(result("a", 1.0), result("b", 1.0)).ranking[0]
    assert equal.better_than_next == 0.5


def test_an_order_is_stated_from_three_quarters_on(worn_shoe_result):
    def result(name, value):
        provenance = dataclasses.replace(worn_shoe_result.provenance, case_hash=name)
        scalars = {**worn_shoe_result.scalars, **cof(value, 0.02)}
        return dataclasses.replace(
            worn_shoe_result,
            name=name,
            scalars=scalars,
            provenance=provenance,
            data=from_xarray(worn_shoe_result.fields.drop_vars("cof_draws")),
        )

    # Phi(d / (0.02 sqrt 2)) = 0.75 at d = 0.0191
    undecided = compare(result("a", 0.1), result("b", 0.1190))
    decided = compare(result("a", 0.1), result("b", 0.1192))
    assert undecided.headline()[0].startswith("Whether b or a has more friction is open")
    assert decided.headline()[0].startswith("b has the higher COF than a, by 0.019")
    # one rule: the table says of COF what the headline says
    near, far = undecided.quantities[0], decided.quantities[0]
    assert (near.different, far.different) == ((), ("B",))
    assert decided.table().rows[0][-1] == "higher, 75 %"
    assert undecided.table().rows[0][-1] == "not decided"


def test_no_order_is_stated_where_a_spread_is_not_known(worn_shoe_result):
    def result(name, value):
        provenance = dataclasses.replace(worn_shoe_result.provenance, case_hash=name)
        scalars = {**worn_shoe_result.scalars, **cof(value, None)}
        data = from_xarray(worn_shoe_result.fields.drop_vars("cof_draws"))
        changes = {"name": name, "scalars": scalars, "provenance": provenance, "data": data}
        return dataclasses.replace(worn_shoe_result, **changes)

    for apart, shown in ((0.2, "0.200"), (0.0, "less than 0.001")):
        both = compare(result("a", 0.3 + apart), result("b", 0.3))
        assert both.order is None
        [line] = both.headline()
        assert line.startswith(f"COF of a is {shown} above that of b.")
        assert "no spread is known of a and b" in line


def test_of_three_results_it_is_said_which_differs_from_the_first(worn_shoe_result):
    def result(name, value):
        provenance = dataclasses.replace(worn_shoe_result.provenance, case_hash=name)
        scalars = {**worn_shoe_result.scalars, **cof(value, 0.001)}
        data = from_xarray(worn_shoe_result.fields.drop_vars("cof_draws"))
        changes = {"name": name, "scalars": scalars, "provenance": provenance, "data": data}
        return dataclasses.replace(worn_shoe_result, **changes)

    three = compare(result("a", 0.3), result("b", 0.3), result("c", 0.1))
    assert three.headline()[0].startswith("a and b are equal for every purpose")
    assert three.headline()[1] == "These differ from a: coefficient of friction (C)."
