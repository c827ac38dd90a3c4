"""Height maps of soles against closed forms: tilt, tread map, measures, resting plane, wear."""

import math

import numpy as np
import pytest

from underfoot.core import InputError
from underfoot.shoe import Facet, Heel, SoleSurface, Tread, WearPlane, heel_map, heel_surface
from underfoot.shoe import surface_map as tilted
from underfoot.shoe._kernels.covering_discs import local_width
from underfoot.shoe.files.orientation import level_axes, other_rest, resting_plane
from underfoot.shoe.tread_measures import (
    QUIET,
    height_noise,
    tread_map,
    tread_measures,
    without_noise,
)
from underfoot.shoe.worn import WornPatch, worn_surface

HEEL = Heel(
    0.060,
    0.060,
    0.028,
    0.02,
    profile=Facet(math.radians(10), 0.03),
    tread=Tread("grid", 6e-3, 3e-3, 3e-3),
)


def plate(height, spacing=0.25e-3, land=None):
    """A rectangular sole from an array of heights."""
    nx, ny = height.shape
    x = (np.arange(nx) + 0.5) * spacing
    y = (np.arange(ny) - (ny - 1) / 2) * spacing
    found = tread_map(height, spacing)
    long, half = nx * spacing, ny * spacing / 2
    rim = np.array([[0, -half], [long, -half], [long, half], [0, half], [0, -half]])
    return SoleSurface(
        x, y, height, found.land if land is None else land, found.tread_depth, spacing, rim
    )


@pytest.mark.parametrize("angle", [0.0, 10.0, 25.0, -8.0])
def test_heel_as_heights_gives_the_heel_map(angle):
    exact = heel_map(HEEL, shoe_angle=math.radians(angle), spacing=0.6e-3)
    found = tilted(
        heel_surface(HEEL, spacing=0.1e-3), shoe_angle=math.radians(angle), spacing=0.6e-3
    )
    assert found.clearance.shape == exact.clearance.shape
    both = exact.land & found.land
    channel = exact.inside & ~exact.land & found.inside & ~found.land
    error = np.zeros(both.shape)
    error[both | channel] = np.abs(
        found.clearance[both | channel] - exact.clearance[both | channel]
    )
    assert both.sum() > 0.985 * exact.land.sum()
    assert (found.inside != exact.inside).mean() < 0.005
    assert error[both].max() < 20e-6
    assert np.percentile(error[channel], 99) < 20e-6
    lugs = exact.tread_depth[both]
    assert np.array_equal(found.tread_depth[both], lugs)


def test_tilted_curve_converges_with_the_height_map():
    """A parabola z = x^2 / 2R tilted by a: linear between cells, so of second order."""
    radius, angle, errors = 0.3, math.radians(12), []
    for spacing in (2e-3, 1e-3, 0.5e-3):
        x = (np.arange(round(0.08 / spacing)) + 0.5) * spacing
        surface = plate(np.repeat((x**2 / (2 * radius))[:, None], 80, 1), spacing)
        floor = tilted(surface, shoe_angle=angle, spacing=4e-3)
        # x of the sole over each place: x cos a - x^2 sin a / 2R = X
        sine, cosine = math.sin(angle), math.cos(angle)
        place = floor.x[floor.inside[:, floor.y.size // 2]]
        at = (cosine - np.sqrt(cosine**2 - 2 * sine * place / radius)) * radius / sine
        exact = at * sine + at**2 / (2 * radius) * cosine
        heights = floor.clearance[floor.inside[:, floor.y.size // 2], floor.y.size // 2]
        difference = (heights - exact)[2:-2]
        errors.append(np.std(difference - difference.mean()))
    assert errors[0] / errors[2] > 8
    assert errors[2] < 1e-6


def test_tread_map_finds_the_channels_it_is_given():
    surface = heel_surface(HEEL, spacing=0.25e-3)
    found = tread_map(surface.height, 0.25e-3)
    assert (found.land == surface.land).mean() > 0.98
    inner = surface.land & found.land
    inner[:8] = False
    assert np.median(found.tread_depth[inner]) == pytest.approx(3e-3, abs=5e-5)
    assert np.nanmedian(np.abs(found.base - surface.base)) < 0.2e-3


def test_bevelled_rim_and_facet_are_no_tread():
    plain = Heel(0.06, 0.06, 0.028, 0.02, profile=Facet(math.radians(10), 0.03), edge_radius=2e-3)
    surface = heel_surface(plain, spacing=0.25e-3)
    found = tread_map(surface.height, 0.25e-3)
    assert np.array_equal(found.land, surface.land)
    assert found.tread_depth.max() == 0


def test_noise_is_estimated_and_raises_the_threshold():
    rng = np.random.default_rng(3)
    height = np.where(np.mod(np.arange(240), 40)[:, None] > 27, 3e-3, 0.0) + np.zeros((240, 200))
    assert height_noise(height) == 0.0
    noisy = height + rng.normal(0, 0.1e-3, height.shape)
    found = tread_map(noisy, 0.25e-3)
    assert found.noise == pytest.approx(0.1e-3, rel=0.03)
    assert found.level == pytest.approx(0.6e-3, rel=0.03)
    # the last channel ends at the rim and is a step there, not a channel
    assert (found.land == (height == 0))[:200].mean() > 0.999


def test_noise_of_a_scan_is_no_shape_of_its_lugs():
    """Points 0.75 mm apart; lugs of 6 mm on a crowned, sloping base."""
    spacing, lag = 0.25e-3, 3
    x, y = (spacing * each for each in np.indices((240, 240)))
    land = np.mod(x, 10e-3) < 6e-3
    shape = 0.02 * x + (y - 0.03) ** 2 / (2 * 0.4) + np.where(land, 0.0, 3e-3)
    points = np.random.default_rng(5).normal(0, 80e-6, (81, 81))
    noisy = shape + np.kron(points, np.ones((lag, lag)))[:240, :240]
    quiet = without_noise(noisy, land, 80e-6, spacing, lag)
    assert np.array_equal(quiet[~land], noisy[~land])
    assert (
        np.std((quiet - shape)[land]) < 2 * QUIET
    )  # at a lug's edges half of the points are known
    # planes stay to the last digit, and what is quieter than the target stays as it is
    plane = np.where(land, 0.02 * x - 0.01 * y, 3e-3)
    assert without_noise(plane, land, 80e-6, spacing, lag) == pytest.approx(plane, abs=1e-12)
    assert without_noise(noisy, land, QUIET, spacing, lag) is noisy


def test_measures_of_straight_channels_are_those_of_the_drawing():
    rows = np.mod(np.arange(400), 40)  # lugs of 7 mm, channels of 3 mm along x, 0.25 mm cells
    height = np.where(rows[:, None] >= 28, 2.5e-3, 0.0) + np.zeros((400, 240))
    height[-12:] = 0.0
    found = tread_measures(plate(height))
    assert found.land_ratio == pytest.approx((400 - 9 * 12) / 400)
    assert found.channel_width == pytest.approx((3e-3,) * 3, abs=0.13e-3)
    assert found.channel_depth == pytest.approx((2.5e-3,) * 3, abs=1e-9)
    assert found.drained_share == 1.0
    assert found.lug_count == 10
    assert found.lug_area[1] == pytest.approx(7e-3 * 60e-3)
    assert found.patch_area == pytest.approx(10e-3 * 60e-3)
    assert (found.patch_length, found.patch_width) == pytest.approx((10e-3, 60e-3))
    assert found.patch_circle == pytest.approx(10e-3, abs=0.13e-3)


def test_ring_channel_is_closed_and_a_cut_opens_it():
    x, y = np.meshgrid(np.arange(200) - 99.5, np.arange(200) - 99.5, indexing="ij")
    distance = np.hypot(x, y) * 0.25e-3
    ring = np.abs(distance - 14e-3) < 1.5e-3
    closed = tread_measures(plate(np.where(ring, 3e-3, 0.0)))
    assert closed.drained_share == 0.0
    assert closed.lug_count == 2
    assert closed.patch_circle == pytest.approx(2 * 12.5e-3, abs=0.3e-3) or closed.patch_area > 1e-3
    cut = ring | ((np.abs(y) * 0.25e-3 < 1.5e-3) & (x > 0) & (distance > 14e-3))
    opened = tread_measures(plate(np.where(cut, 3e-3, 0.0)))
    assert opened.drained_share == 1.0
    assert opened.lug_count == 2


@pytest.mark.parametrize("cells", [3, 4, 7, 12, 25])
def test_local_width_of_a_strip_is_its_width(cells):
    strip = np.zeros((80, 60), dtype=bool)
    strip[:, 20 : 20 + cells] = True
    width = local_width(strip, 1.0)[strip]
    assert np.abs(np.median(width) - cells) <= 0.5
    assert width.max() <= cells + 0.5


def test_resting_plane_is_that_of_three_points_under_the_centre():
    """A plate on three studs: the plane through them, whatever else hangs above it."""
    x, y = np.meshgrid(np.arange(300) * 0.5e-3, np.arange(160) * 0.5e-3, indexing="ij")
    studs = [(20e-3, 40e-3, 0.0), (120e-3, 15e-3, 1e-3), (120e-3, 65e-3, -0.5e-3)]
    height = np.full(x.shape, 6e-3)
    for at_x, at_y, z in studs:
        height[np.hypot(x - at_x, y - at_y) < 5e-3] = z
    a, b, c = resting_plane(height, 0.5e-3)
    for at_x, at_y, z in studs:  # it touches the rims of their flat ends, 5 mm from the middle
        assert a * at_x + b * at_y + c == pytest.approx(z, abs=5e-3 * math.hypot(a, b) + 5e-5)
    turned, angle = level_axes(np.eye(3), (a, b, c))
    assert angle == pytest.approx(math.atan(math.hypot(a, b)), rel=1e-6)
    assert np.allclose(turned @ turned.T, np.eye(3), atol=1e-12)


@pytest.mark.parametrize("bevel", [25e-3, 43e-3, 55e-3])
def test_a_heel_that_was_drawn_level_is_not_laid_on_its_bevel(bevel):
    x, y = np.meshgrid(np.arange(150) * 0.5e-3, np.arange(120) * 0.5e-3, indexing="ij")
    height = np.maximum(bevel - x, 0.0) * math.tan(math.radians(10))
    height[(y % 9e-3 < 3.5e-3) & (x > 2e-3)] += 3.5e-3
    a, b, c = resting_plane(height, 0.5e-3)
    assert (a, b, c) == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)
    # tilted as a whole it is laid level again where its bevel does not carry it
    tilt = 0.03 * x
    a, *_ = resting_plane(height + tilt, 0.5e-3)
    assert (a == pytest.approx(0.03, abs=1e-3)) == (bevel < 30e-3)


def test_single_spike_does_not_carry_the_sole():
    rng = np.random.default_rng(0)
    height = rng.normal(0, 10e-6, (300, 160))
    height[250, 150] = -8e-3
    a, b, _ = resting_plane(height, 0.5e-3)
    assert math.hypot(a, b) < math.radians(0.05)


def test_plane_wear_of_heights_is_that_of_the_heel():
    from dataclasses import replace

    wear = WearPlane(1.5e-3, math.radians(8))
    worn = worn_surface(heel_surface(HEEL, spacing=0.5e-3), wear)
    exact = heel_surface(replace(HEEL, wear=wear), spacing=0.5e-3)
    assert np.nanmax(np.abs(worn.base - exact.base)) < 0.1e-3  # centre line by cells
    assert (worn.land != exact.land).mean() < 0.01
    assert np.nanmean(np.abs(worn.tread_depth - exact.tread_depth)) < 0.05e-3


def test_worn_patch_reaches_the_channel_floor_and_must_fit():
    surface = heel_surface(HEEL, spacing=0.5e-3)
    worn = worn_surface(surface, WornPatch(3.2e-3, 0.02, 0.02, position=0.045))
    assert tread_measures(worn).patch_area > 0.8 * math.pi / 4 * 0.02**2
    assert tread_measures(worn).land_ratio > tread_measures(surface).land_ratio
    with pytest.raises(InputError, match="larger than the shoe"):
        worn_surface(surface, WornPatch(1e-3, 0.2, 0.02))


def test_surface_that_is_none_is_refused():
    height = np.full((10, 10), np.nan)
    axis = np.arange(10) * 1e-3
    rim = np.zeros((2, 2))
    with pytest.raises(InputError, match="no height anywhere"):
        SoleSurface(axis, axis, height, height > 0, height * 0, 1e-3, rim)
    height[0, 0] = 0.0
    with pytest.raises(InputError, match="land lies outside"):
        SoleSurface(axis, axis, height, np.ones((10, 10), bool), height * 0, 1e-3, rim)


@pytest.mark.parametrize(("bevel", "is_land"), [(0.0, True), (0.2, False)])
def test_a_slice_of_a_lug_at_the_rim_is_land_where_it_lies_like_the_land_beside_it(bevel, is_land):
    """Bars on a heel with a facet of 10 degrees, whose rearmost lug is cut to 1.5 mm."""
    spacing = 0.25e-3
    x = spacing * (np.arange(240) + 0.5)[:, None] + np.zeros((1, 120))
    facet = math.tan(math.radians(10)) * np.maximum(30e-3 - x, 0.0)
    rim = bevel * np.maximum(1.5e-3 - x, 0.0)
    channel = np.mod(x - 1.5e-3, 10e-3) < 4e-3
    land = tread_map(facet + rim + 3e-3 * channel, spacing).land
    assert np.unique(land[:4]).tolist() == [is_land]
    assert np.array_equal(land[6:], ~channel[6:])


def test_a_second_face_that_could_stand_on_the_floor_is_told():
    """A heel that lies on its facet of 45 mm; no sole whose toe or bevel is a small part of it."""
    spacing = 0.5e-3
    x = spacing * (np.arange(150) + 0.5)[:, None] + np.zeros((1, 140))
    other = other_rest(math.tan(math.radians(10)) * np.maximum(x - 45e-3, 0.0), spacing)
    assert other is not None
    share, angle = other
    assert share == pytest.approx(30 / 75, abs=0.03)
    assert angle == pytest.approx(math.radians(10), abs=math.radians(0.3))
    assert other_rest(np.zeros_like(x), spacing) is None
    assert other_rest(math.tan(math.radians(10)) * np.maximum(x - 65e-3, 0.0), spacing) is None
    assert other_rest((np.maximum(x - 30e-3, 0.0)) ** 2 / (2 * 0.15), spacing) is None


@pytest.mark.parametrize("slopes", [(10, 0), (-10, 4), (6, 6)])
def test_lugs_of_a_grid_on_a_bevel_are_as_high_as_its_channels_are_deep(slopes):
    """Where channels cross, land is on both sides along the diagonals alone."""
    spacing, edge = 0.25e-3, 12e-3  # m: beyond, a channel that the rim cuts shows a wall alone
    x, y = spacing * (np.indices((320, 280)) + 0.5)
    along, across = np.tan(np.radians(slopes))
    channel = (np.mod(x, 10e-3) < 4e-3) | (np.mod(y, 10e-3) < 4e-3)
    plane = along * x + across * y
    tread = tread_map(plane + 3e-3 * channel, spacing)
    cells = round(edge / spacing)
    inner = np.zeros_like(channel)
    inner[cells:-cells, cells:-cells] = True
    assert np.array_equal(tread.land[inner], ~channel[inner])
    assert tread.tread_depth[inner & ~channel] == pytest.approx(3e-3, abs=1e-6)
    assert (tread.base - plane)[inner] == pytest.approx(0.0, abs=1e-6)
