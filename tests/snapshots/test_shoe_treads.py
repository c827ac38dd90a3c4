"""Land, channels, slits and lugs of a sole by its heights, each limit just below and just above."""

import math

import numpy as np
import pytest

from underfoot.shoe._kernels.regions import nearest_true
from underfoot.shoe.geometry import SoleSurface
from underfoot.shoe.tread_measures import (
    TreadMap,
    _bare_ends,
    _rounded_rim,
    _shares,
    _slit_pieces,
    _slit_widths,
    _slopes,
    arch_area,
    channel_depth,
    floor_depth,
    height_noise,
    largest_patch,
    lower_lugs,
    reached_by_floor,
    surface_without_slits,
    tread_map,
    tread_measures,
    without_noise,
)

STEP = 0.25e-3


def surface(depth, spacing=STEP, base=0.0):
    """A flat sole whose channels are so deep, cell by cell; nan outside."""
    depth = np.asarray(depth, float)
    inside = np.isfinite(depth)
    land = inside & (depth == 0)
    x, y = (spacing * (np.arange(n) + 0.5) for n in depth.shape)
    height = base + depth
    corners = spacing * np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]]) * depth.shape
    return SoleSurface(
        x=x, y=y, height=height, land=land, tread_depth=np.where(land, 3e-3, 0.0),
        base=np.where(inside, base, np.nan), spacing=spacing, outline=corners,
    )  # fmt: skip


def bars(width, depth=3e-3, count=3, lug=24, length=60):
    """Channels of so many cells across a sole, between lugs of 24."""
    rows = np.zeros((count * (width + lug) + lug, length))
    for n in range(count):
        rows[lug + n * (width + lug) :][:width] = depth
    return rows


@pytest.mark.parametrize("width", [5, 8, 16])
def test_measures_of_bars(width):
    made = tread_measures(surface(bars(width)))
    rows = 3 * (width + 24) + 24
    assert (made.length, made.width) == pytest.approx((rows * STEP, 60 * STEP))
    assert made.plan_area == pytest.approx(rows * 60 * STEP**2)
    assert made.land_ratio == pytest.approx(96 / rows)
    assert made.channel_depth == pytest.approx((3e-3,) * 3)
    assert made.channel_width == pytest.approx((width * STEP,) * 3, abs=0.6 * STEP)
    assert (made.drained_share, made.lug_count, made.sipe_count) == (1.0, 4, 0)
    assert made.lug_area == pytest.approx((24 * 60 * STEP**2,) * 3)
    assert made.patch_area == pytest.approx(24 * 60 * STEP**2)
    assert (made.patch_length, made.patch_width) == pytest.approx((24 * STEP, 60 * STEP))
    assert made.patch_circle == pytest.approx(24 * STEP, abs=1.1 * STEP)
    assert made.free_circle == made.patch_circle


def test_slits_are_narrow_long_and_between_walls():
    for width, slits in ((4, 3), (5, 0)):  # 1 mm and 1.25 mm
        made = tread_measures(surface(bars(width)))
        assert made.sipe_count == slits
        assert made.sipe_length == pytest.approx(slits * 60 * STEP, rel=0.06)
    for length, counted in ((11, False), (12, True)):  # 3 mm, by the box around
        depth = np.zeros((60, 60))
        depth[30, 20 : 20 + length] = 3e-3
        assert (tread_measures(surface(depth)).sipe_count == 1) == counted
    rim = np.zeros((60, 60))
    rim[0, 10:40] = 3e-3  # what the outline leaves of a channel
    assert tread_measures(surface(rim)).sipe_count == 0


def test_widths_of_slits_at_any_angle():
    x, y = np.meshgrid(np.arange(160), np.arange(160), indexing="ij")
    for degrees in (0, 20, 45, 70, 90):
        a = math.radians(degrees)
        across = (x - 79.5) * math.cos(a) + (y - 79.5) * math.sin(a)
        along = -(x - 79.5) * math.sin(a) + (y - 79.5) * math.cos(a)
        mask = (np.abs(across) < 3) & (np.abs(along) < 60)
        numbers, count = _slit_pieces(mask, np.ones_like(mask), STEP)
        assert count == 1
        areas, widths = _slit_widths(numbers, count, STEP)
        assert areas[0] == pytest.approx(720 * STEP**2, rel=0.06)
        assert widths[0] == pytest.approx(6 * STEP, rel=0.12)


def test_specks_drains_and_patches():
    depth = np.zeros((60, 60))
    depth[20:40, 20:40] = 3e-3  # a pit that drains nowhere
    made = tread_measures(surface(depth))
    assert (made.drained_share, made.lug_count) == (0.0, 1)
    depth[30, 40:] = 3e-3
    assert tread_measures(surface(depth)).drained_share == 1.0
    for cells, count in ((15, 1), (16, 2)):  # a piece of 1 mm^2 is a lug
        made = tread_measures(surface(np.where(_lugs(cells), 0.0, 3e-3)))
        assert made.lug_count == count
    two = surface(bars(8, lug=10) * 1.0)
    two.land[:10, 30:] = False
    patch = largest_patch(two)
    assert patch.sum() == 600
    assert not patch[:10].any()
    assert _shares(np.arange(101.0)) == (10.0, 50.0, 90.0)


def _lugs(cells):
    land = np.zeros((60, 60), bool)
    land[5:40, 5:30] = True
    land[50, 10 : 10 + cells] = True
    return land


def test_land_is_what_a_rolling_body_reaches():
    for depth, channel in ((0.31e-3, True), (0.29e-3, False)):
        made = tread_map(bars(16, depth), STEP)
        assert made.land.all() != channel
        if channel:
            assert made.land.sum() == 96 * 60
            assert made.tread_depth[made.land] == pytest.approx(depth)
            assert made.base == pytest.approx(0.0, abs=1e-9)
    # land that no channel is near to is no lug
    height = np.zeros((140, 40))
    height[10:18] = 3e-3
    made = tread_map(height, STEP)
    assert made.tread_depth[[0, 18, 57]][:, 20] == pytest.approx([3e-3] * 3)
    assert made.tread_depth[[59, 100]][:, 20] == pytest.approx([0.0, 0.0])
    noisy = bars(16, 3e-3) + 60e-6 * np.random.default_rng(1).normal(size=bars(16).shape)
    rough = tread_map(noisy, STEP)
    assert rough.noise == pytest.approx(60e-6, rel=0.1)
    assert rough.level == pytest.approx(6 * rough.noise)
    given = np.zeros((40, 40), bool)
    given[10:20] = True
    assert not tread_map(np.zeros((40, 40)), STEP, channels=given).land[10:20].any()


def test_noise_of_heights_is_that_of_third_differences():
    x = np.arange(400)[:, None] * STEP + np.zeros((400, 50))
    noise = 20e-6 * np.random.default_rng(2).normal(size=(400, 50))
    for shape in (0 * x, 0.1 * x, 3 * x**2):
        assert height_noise(shape) == pytest.approx(0.0, abs=1e-12)
        assert height_noise(shape + noise) == pytest.approx(20e-6, rel=0.03)
    pairs = np.repeat(noise[::2], 2, axis=0)
    assert height_noise(pairs, 2) == pytest.approx(20e-6, rel=0.05)
    assert height_noise(noise[:3]) == 0.0
    assert height_noise(noise[:4]) > 0.0
    land = np.ones((400, 50), bool)
    quiet = without_noise(0.1 * x + noise, land, 20e-6, STEP)
    assert np.std(quiet - 0.1 * x) < 15e-6
    assert without_noise(noise, land, 15e-6, STEP) is noise
    assert without_noise(noise, land, 15.1e-6, STEP) is not noise
    half = land.copy()
    half[200:] = False
    assert np.array_equal(without_noise(noise, half, 30e-6, STEP)[200:], noise[200:])


def test_slopes_are_over_a_millimetre():
    x, y = np.meshgrid(np.arange(40) * STEP, np.arange(30) * STEP, indexing="ij")
    slope = _slopes(0.3 * x - 0.2 * y, STEP)
    assert slope[0][4:-4] == pytest.approx(0.3)
    assert slope[1][:, 4:-4] == pytest.approx(-0.2)
    step = np.where(x > 20 * STEP, 1e-3, 0.0)
    steep = _slopes(step, STEP)[0][:, 10]
    assert np.flatnonzero(steep).tolist() == [19, 20, 21, 22]
    assert steep.max() == pytest.approx(1.0)


def test_rounded_rims_are_steep_and_no_walls():
    x = np.arange(80)[:, None] * STEP + np.zeros((80, 40))
    onto = nearest_true(np.ones((80, 40), bool))
    for slope, rounded in ((0.24, False), (0.26, True), (2.9, True), (3.1, False)):
        height = np.maximum(0.01 - x, 0.0) * slope
        assert np.isfinite(_rounded_rim(height, STEP, onto)[10:30, 20]).all() == rounded
    flat = np.zeros((80, 40))
    for high, reached in ((29e-6, True), (31e-6, False)):
        lug = flat.copy()
        lug[30:34, 18:22] = high
        assert reached_by_floor(lug, flat == 0, STEP)[31, 20] == reached


def test_an_end_without_edges_is_bare():
    """A piece that lies above other land and bends nowhere along its border."""

    def ends(rise, bend):
        height = np.zeros((80, 40))
        land = np.ones((80, 40), bool)
        land[40:48] = False
        height[40:48] = rise + bend
        height[48:] = rise
        onto = nearest_true(land | True)
        return _bare_ends(height, land, STEP, onto)

    assert ends(0.31e-3, 0.0)[60, 20]
    assert not ends(0.29e-3, 0.0).any()
    assert not ends(0.31e-3, 0.11e-3).any()
    assert ends(0.31e-3, 0.09e-3)[60, 20]
    assert not ends(0.31e-3, 0.0)[:40].any()
    one = np.ones((20, 20), bool)
    assert not _bare_ends(np.zeros((20, 20)), one, STEP, nearest_true(one)).any()
    none = np.zeros((20, 20), bool)
    assert not _bare_ends(np.zeros((20, 20)), none, STEP, nearest_true(one)).any()


def test_lower_lugs_stand_between_deeper_channels():
    for depth, lower in ((1.45e-3, True), (1.55e-3, False)):  # half of 3 mm
        height = np.full((80, 80), 3e-3)
        height[:10] = 0.0
        height[40:50, 30:50] = depth
        made = surface(height)
        found = lower_lugs(channel_depth(made), made.inside & ~made.land, STEP)
        assert found[45, 40] == lower
        assert not found[20, 20]
        floor = floor_depth(channel_depth(made), made.inside & ~made.land, STEP)
        assert floor[45, 40] == pytest.approx(depth)
    for wide, lower in ((4, False), (5, True)):  # wider than a millimetre
        height = np.full((80, 80), 3e-3)
        height[:10] = 0.0
        height[40 : 40 + wide, 30:50] = 1e-3
        made = surface(height)
        assert lower_lugs(channel_depth(made), made.inside & ~made.land, STEP).any() == lower


def test_arches_are_wider_than_fifty_millimetres():
    for width, arch in ((49, False), (51, True)):
        inside = np.ones((120, 120), bool)
        land = inside.copy()
        land[30 : 30 + width] = False
        flat = np.zeros((120, 120))
        found = arch_area(TreadMap(land, flat, flat, 3e-4, 0.0), inside, 1e-3)
        assert (found > 0) == arch
        if arch:
            assert found == pytest.approx(51 * 120e-6, rel=0.1)
    assert arch_area(TreadMap(inside, flat, flat, 3e-4, 0.0), inside, 1e-3) == 0.0


def test_a_surface_without_its_slits():
    made = surface(bars(3, 2e-3))
    filled, slits = surface_without_slits(made, 1.2e-3)
    assert filled.land.all()
    assert slits.mask.sum() == 9 * 60
    assert slits.depth == pytest.approx(2e-3)
    assert slits.width[slits.mask] == pytest.approx(3 * STEP, rel=0.1)
    along = np.abs(slits.tangent[1][slits.mask])
    assert along == pytest.approx(1.0, abs=0.02)
    assert filled.tread_depth[filled.land].max() == pytest.approx(2e-3)
    same, nothing = surface_without_slits(made, 0.7e-3)
    assert (same is made, nothing) == (True, None)
    wide = surface(bars(8, 2e-3))
    assert surface_without_slits(wide, 5e-3)[1] is None
    assert surface_without_slits(surface(np.zeros((20, 20))), 5e-3)[1] is None
