"""Steps of the micro models with a value of their own; no block is solved."""

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.block._kernels import names
from underfoot.block.assembly import (
    SINKING,
    ExplicitSettings,
    assemble_march,
    critical_time_step,
    impact_friction,
)
from underfoot.block.inputs import MicroBlock, MicroLoading, MicroMaterial, MicroSurface
from underfoot.block.march import COLUMNS, BlockMarch, _edges, loaded_state, saved_state
from underfoot.block.mesh import block_mesh, layer_heights
from underfoot.block.one_term_fit import fit_single_exponential
from underfoot.block.prony_march import prony_step
from underfoot.block.result import EDGE_EXCESS, EnergyLedger, edge_excess_area
from underfoot.core import ConvergenceError, DataError, InputError, silent
from underfoot.material import single_exponential_spectrum
from underfoot.surface import HeightMap

WAVE = 0.4e-3


def waves_map():
    """Return a periodic map of 0.8 by 0.6 mm with a wave along x and another along y."""
    x, y = 0.8e-3 * np.arange(64) / 64, 0.6e-3 * np.arange(40) / 40
    heights = 3e-6 * np.sin(2 * np.pi * x / 0.8e-3)[:, None] + 2e-6 * np.cos(2 * np.pi * y / 0.3e-3)
    return HeightMap(heights, 0.8e-3 / 64, True, spacing_y=0.6e-3 / 40)


FLOORS = {
    "cosine": MicroSurface.checkerboard(20e-6, WAVE, offset=(0.07e-3, 0.02e-3)),
    "triangular": MicroSurface.checkerboard(20e-6, WAVE, form="triangular"),
    "wave": MicroSurface("wave", 20e-6, WAVE),
    "paraboloid": MicroSurface("paraboloid", radius=1e-3),
    "map": MicroSurface.of_map(waves_map()),
}


@pytest.mark.parametrize("form", FLOORS)
def test_the_slope_of_a_floor_is_how_its_height_changes(form):
    floor, step = FLOORS[form], 1e-10
    x, y = np.random.default_rng(1).uniform(0.01e-3, 0.5e-3, (2, 60))
    _, slope_x, slope_y = floor.height_and_slope(x, y)
    along = (floor.height(x + step, y) - floor.height(x - step, y)) / (2 * step)
    across = (floor.height(x, y + step) - floor.height(x, y - step)) / (2 * step)
    steepest = max(np.abs(slope_x).max(), np.abs(slope_y).max())
    np.testing.assert_allclose(slope_x, along, atol=1e-3 * steepest)
    np.testing.assert_allclose(slope_y, across, atol=1e-3 * steepest)


def test_heights_of_floors_are_those_of_their_names():
    place = np.array([0.0, WAVE / 4, WAVE / 2])
    assert FLOORS["wave"].height(place, 0.3e-3) == pytest.approx([10e-6, 0, -10e-6], abs=1e-12)
    straight = FLOORS["triangular"].height(WAVE * np.array([0, 1 / 8, 1 / 4, 1 / 2]), 0.0)
    assert straight == pytest.approx([10e-6, 5e-6, 0, -10e-6], abs=1e-12)
    ball = FLOORS["paraboloid"].height(0.1e-3, 0.2e-3)
    assert ball == pytest.approx(-(0.1e-3**2 + 0.2e-3**2) / 2e-3)
    made, points = waves_map(), FLOORS["map"]
    x, y = made.spacings[0] * np.arange(64), made.spacings[1] * np.arange(40)
    np.testing.assert_allclose(
        points.height(x[:, None], y), made.heights - made.heights.mean(), atol=1e-12
    )


def test_a_wave_is_a_cosine_to_the_last_digits():
    """Also in the middle of an eighth turn, where each term of its series counts most."""
    x = WAVE * np.linspace(-1.5, 1.5, 601)
    height, slope, across = FLOORS["wave"].height_and_slope(x, 0.0)
    turn = 2 * np.pi / WAVE
    np.testing.assert_allclose(height, 10e-6 * np.cos(turn * x), atol=1e-14 * 10e-6)
    np.testing.assert_allclose(slope, -10e-6 * turn * np.sin(turn * x), atol=1e-14 * 10e-6 * turn)
    assert not across.any()


@pytest.mark.parametrize("ratio", [0.2, 0.45, 0.499])
def test_a_material_of_a_poisson_ratio_has_it(ratio):
    shear = single_exponential_spectrum(3e6, 1e6, 100.0, source="made up")
    made = MicroMaterial.from_poisson(shear, ratio, at="instantaneous")
    assert made.poisson_ratio == pytest.approx(ratio)
    fast = shear.instantaneous_modulus
    assert made.bulk_modulus == pytest.approx(2 * fast * (1 + ratio) / (3 * (1 - 2 * ratio)))


def test_energy_that_comes_in_is_stored_moves_or_is_lost():
    stored = {"kinetic": 1.0, "strain": 2.0, "hourglass": 3.0, "contact": 4.0}
    lost = {"material_loss": 5.0, "hourglass_loss": 6.0, "contact_loss": 7.0, "damping_loss": 8.0}

    def residual(floor_work, top_work, **more):
        parts = {**stored, **lost, **more, "floor_work": floor_work, "top_work": top_work}
        arrays = {name: np.array([value]) for name, value in parts.items()}
        return float(EnergyLedger(time=np.zeros(1), **arrays).residual[0])

    assert residual(30.0, 6.0) == 0.0
    assert residual(36.0, 6.0) == residual(30.0, 12.0) == 6.0
    for name in (*stored, *lost):
        assert residual(30.0, 6.0, **{name: 0.0}) == (stored | lost)[name]


def test_the_area_at_the_rim_of_contact_is_its_length_times_a_share_of_an_element():
    touching = np.zeros((8, 8), bool)
    touching[2:5, 2:6] = True  # 3 rows across of 4 along
    dx, dy = 2e-5, 1e-5
    length = 2 * 3 * dy + 2 * 4 * dx
    expected = EDGE_EXCESS * length * np.sqrt(dx * dy)
    for periodic in (True, False):
        assert edge_excess_area(touching, dx, dy, periodic=periodic) == pytest.approx(expected)
    whole = np.ones((8, 8), bool)
    assert edge_excess_area(whole, dx, dy, periodic=True) == 0.0
    # a strip over the side is one strip where sides join, and ends at the side where they are free
    strip = np.zeros((8, 8), bool)
    strip[:, [0, 7]] = True
    for periodic in (True, False):
        rim = edge_excess_area(strip, dx, dy, periodic=periodic)
        assert rim == pytest.approx(EDGE_EXCESS * 2 * 8 * dy * np.sqrt(dx * dy))


@pytest.mark.parametrize("sides", ["periodic", "free"])
def test_the_rim_of_a_march_is_that_of_the_nodes_that_touch_by_the_steps_of_its_mesh(sides):
    """Periodic sides have their nodes twice: the last column and row are the first again."""
    x, y = 2e-5 * np.arange(7), 1e-5 * np.arange(6)
    gap = np.ones((6, 7))
    gap[1:4, 2:6] = -1.0  # 3 rows across of 4 along
    control = np.zeros(names.CONTROL_SIZE)
    control[names.PERIODIC] = float(sides == "periodic")
    arrays: list[Any] = [None] * 12
    arrays[1], arrays[2], arrays[11] = x, y, gap.reshape(1, -1)
    march = SimpleNamespace(mesh=SimpleNamespace(shape=(7, 6, 4)), control=control, arrays=arrays)
    length = 2 * 3 * 1e-5 + 2 * 4 * 2e-5
    expected = EDGE_EXCESS * length * np.sqrt(2e-5 * 1e-5)
    assert _edges(cast(Any, march)) == pytest.approx(expected)


@pytest.mark.parametrize(
    ("rough", "pressure", "factor"),
    [(False, 1e5, 0.5), (True, 1e3, 0.5), (True, 2.4e6, 1.0), (True, 1e8, 1.5)],
)
def test_the_contact_is_as_stiff_as_the_lowest_layer_where_the_load_asks_no_more(
    rough, pressure, factor
):
    """Springs sink by 0.003 of the roughness: p / (0.003 20 um) is M / h at p = M 60 nm / h.

    M = K + 4/3 G at once; of a layer of 25 um and 1 GPa that is 2.4 MPa.
    """
    spectrum = single_exponential_spectrum(1e6, 0.5e6, 100.0, source="made up")
    fast = spectrum.instantaneous_modulus
    rubber = MicroMaterial(spectrum, 1e9 - 4 / 3 * fast)
    size, elements = (0.8e-3, 0.1e-3, 70e-6), (26, 2, 2)
    block = MicroBlock(size, elements, bottom_layer=25e-6, roughness_layers=2)
    floor = MicroSurface("wave", 20e-6, WAVE) if rough else MicroSurface()
    load = MicroLoading(mean_pressure=pressure)
    made = assemble_march(block, floor, rubber, load, ExplicitSettings())
    assert pytest.approx(60e-9) == SINKING * 20e-6
    assert made.penalty == pytest.approx(factor * 1e9 / 25e-6, rel=1e-9)
    told = ExplicitSettings(penalty_factor=0.7)
    assert assemble_march(block, floor, rubber, load, told).penalty == pytest.approx(0.7e9 / 25e-6)


def test_friction_by_impacts_grows_as_the_speed_squared_and_falls_with_pressure():
    block, floor = MicroBlock(size=(0.8e-3, 0.8e-3, 0.5e-3)), FLOORS["cosine"]

    def bound(speed, pressure, **more):
        loading = MicroLoading(mean_pressure=pressure, speed=speed)
        return impact_friction(block, more.get("floor", floor), 1150.0, loading)

    assert bound(0.5, 1e5) > 0
    assert bound(1.0, 1e5) == pytest.approx(4 * bound(0.5, 1e5))
    assert bound(0.5, 2e5) == pytest.approx(0.5 * bound(0.5, 1e5))
    assert bound(0.5, 1e5, floor=MicroSurface()) == 0.0
    # rho h (v s)^2 / (p w) with the slope s = pi Rz / w of a checkerboard's flank
    slope = np.pi * 20e-6 / WAVE
    expected = 1150.0 * 31.25e-6 * (0.5 * slope) ** 2 / (1e5 * WAVE)
    assert bound(0.5, 1e5) == pytest.approx(expected, rel=0.02)


def test_a_decay_of_one_term_is_found_whatever_its_time():
    t = np.geomspace(0.01, 100.0, 30)
    for tau in (0.05, 1.0, 40.0):
        fit = fit_single_exponential(t, 2e6 + 3e6 * np.exp(-t / tau))
        assert fit.decay_rate.value == pytest.approx(1 / tau, rel=1e-4)
        assert fit.equilibrium_modulus.value == pytest.approx(2e6, rel=1e-4)
        assert fit.instantaneous_modulus.value == pytest.approx(5e6, rel=1e-4)
        assert fit.spectrum.relaxation_modulus(tau) == pytest.approx(2e6 + 3e6 / np.e, rel=1e-4)


def test_a_run_goes_on_from_its_own_file_and_from_no_other(tmp_path):
    path = saved_state(tmp_path / "state.npz", {"key": np.array("this one"), "u": np.arange(3.0)})
    assert loaded_state(path, "this one")["u"].tolist() == [0, 1, 2]
    with pytest.raises(DataError, match="belongs to another"):
        loaded_state(path, "another")


@pytest.mark.parametrize("step", [1e-3, 1e-7, 1e-12])
def test_a_step_of_any_length_has_the_mean_of_its_decay(step):
    """phi = (1 - exp(-x)) / x = 1 - x / 2 + x^2 / 6 - ...; a short step is stiff as glass."""
    rates, fractions = np.array([0.5, 40.0]), np.array([0.3, 0.6])
    found, x = prony_step(fractions, rates, step), rates * step
    assert found.decay == pytest.approx(np.exp(-x), rel=1e-12)
    mean = 1 - x / 2 + x**2 / 6 - x**3 / 24
    assert found.mean_decay == pytest.approx(mean, rel=1e-6)
    assert found.stiffening == pytest.approx(1 - fractions @ (1 - mean), rel=1e-6)


@pytest.mark.parametrize("form", ["cosine", "triangular", "wave", "map"])
def test_a_floor_comes_again_after_each_of_its_waves(form):
    floor, (x, y) = FLOORS[form], np.random.default_rng(2).uniform(0.0, 0.4e-3, (2, 40))
    along, across = (0.8e-3, 0.6e-3) if form == "map" else (WAVE, WAVE)
    here = floor.height_and_slope(x, y)
    for turns in (-3, 1, 2):
        there_too = floor.height_and_slope(x + turns * along, y - turns * across)
        for value, again in zip(here, there_too, strict=True):
            np.testing.assert_allclose(again, value, atol=1e-9 * np.abs(value).max())


def test_the_summit_of_a_checkerboard_stands_where_it_was_put():
    floor = FLOORS["cosine"]
    height, *slopes = floor.height_and_slope(0.07e-3, 0.02e-3)
    assert height == pytest.approx(10e-6)
    assert slopes == pytest.approx([0.0, 0.0], abs=1e-12)
    for x, y in ((WAVE / 2, 0.0), (0.0, WAVE / 2)):
        assert floor.height(0.07e-3 + x, 0.02e-3 + y) == pytest.approx(-10e-6)


def test_the_longest_step_of_a_cube_is_the_time_that_a_wave_takes_through_it():
    """At rest, and of cubes squeezed to half their height the way through the thin side."""
    given = {"size": (40e-6, 30e-6, 20e-6), "elements": (4, 3, 2), "bottom_layer": None}
    mesh = block_mesh(MicroBlock(**given, roughness_layers=2))
    modulus, density = 4e9, 1000.0  # 2,000 m/s
    step = critical_time_step(mesh.largest_gradient_square(), modulus, density)
    assert step == pytest.approx(10e-6 / 2000.0)
    squeezed = np.zeros_like(mesh.nodes)
    squeezed[2] = -0.5 * mesh.nodes[2]
    step = critical_time_step(mesh.largest_gradient_square(squeezed), modulus, density)
    assert step == pytest.approx(5e-6 / 2000.0)


@pytest.mark.parametrize(
    ("before", "row", "least", "trouble"),
    [
        ({}, {"floor_work": 3.0, "kinetic": 2.0, "strain": 3.9}, 0.5, ""),
        ({}, {"floor_work": 3.0, "kinetic": 2.0, "strain": 4.1}, 0.5, "makes energy"),
        ({}, {"floor_work": -1.0, "top_work": 2.0, "hourglass": 3.0, "contact": 2.9}, 0.5, ""),
        ({}, {"floor_work": -1.0, "top_work": 2.0, "contact": 6.1}, 0.5, "makes energy"),
        # what the load gave before counts where the top has come back since
        ({"top_work": 3.0}, {"strain": 5.9}, 0.5, ""),
        ({"top_work": 3.0, "kinetic": 9.0}, {"strain": 6.1}, 0.5, "makes energy"),
        ({}, {"normal": np.nan}, 0.5, "unstable"),
        ({}, {}, 0.0, "inside out"),
    ],
)
def test_a_march_stops_where_it_makes_energy_or_turns_an_element(
    before, row, least, trouble, tmp_path
):
    def row_of(parts):
        return np.array([parts.get(name, 0.0) for name in COLUMNS])

    state = np.zeros(64)
    state[names.LEAST_J] = least
    march = BlockMarch(
        cast(Any, SimpleNamespace(state=state)), cast(Any, None), 1.0, WAVE, 20, 1e6, "key", silent,
        output=tmp_path, rows=[row_of(before)] * bool(before),
    )  # fmt: skip
    if not trouble:
        march._check(row_of(row))
    else:
        with pytest.raises(ConvergenceError, match=trouble):
            march._check(row_of(row))


@pytest.mark.parametrize(("ratio", "fits"), [(0.49, False), (0.6, True), (1.9, True), (2.1, False)])
def test_layers_grow_by_at_most_two_from_one_to_the_next(ratio, fits):
    """Of four layers of one ratio the lowest is h / (1 + r + r^2 + r^3)."""
    lowest = 20e-6 / float(np.sum(ratio ** np.arange(4)))
    block = MicroBlock((40e-6, 30e-6, 20e-6), (4, 3, 4), bottom_layer=lowest)
    if not fits:
        with pytest.raises(InputError, match="asks for a ratio of"):
            layer_heights(block)
        return
    layers = np.diff(layer_heights(block))
    assert layers[1:] / layers[:-1] == pytest.approx([ratio] * 3)


@pytest.mark.parametrize("count", [0, 2])
def test_the_state_of_a_march_has_a_row_for_each_step_that_was_written(count, tmp_path):
    nodes = np.ones((2, 3)), np.zeros((2, 3)), None
    assembly = SimpleNamespace(
        nodes=nodes, history=np.zeros(4), state=np.zeros(64), control=np.zeros(3)
    )
    march = BlockMarch(
        cast(Any, assembly), cast(Any, None), 1.0, WAVE, 20, 1e6, "key", silent,
        output=tmp_path, rows=[np.arange(float(len(COLUMNS)))] * count,
    )  # fmt: skip
    assert march.state()["rows"].shape == (count, len(COLUMNS))
