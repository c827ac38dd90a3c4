"""What a surface is taken for: dead points, held heights, lays, cut-offs, by their limits."""

import math

import numpy as np
import pytest

from underfoot.core import DataError, InputError, RangeError
from underfoot.surface.heights import (
    HeightMap,
    Profile,
    profile_from_positions,
    shortest_reliable_wavelength,
)
from underfoot.surface.lay import (
    Directions,
    Texture,
    directions,
    lines_across,
    lines_along_axes,
    texture,
)
from underfoot.surface.prepare import (
    fill_missing_heights,
    held_level,
    level_surface,
    make_periodic,
    square_cells,
    without_spikes,
)
from underfoot.surface.read import read_surface
from underfoot.surface.roughness import (
    areal_roughness,
    curvature,
    element_spacing,
    height_numbers,
    profile_roughness,
    rms_slope,
    slope,
)
from underfoot.surface.scan import (
    _cutoff,
    _equal_heights_question,
    _numbers,
    _uneven,
    height_cautions,
)
from underfoot.surface.spectrum import ProfileSpectrum

UM = 1e-6


def test_heights_that_are_one_number_too_often():
    usual = np.arange(1000.0)
    for count, held in ((9, True), (8, False)):  # with its own 1 % of 1000
        level = np.concatenate([usual[: 1000 - count], np.full(count, 500.0)])
        share, height = held_level(level)
        assert share == pytest.approx((count + 1) / 1000 if held else 0.0, abs=2e-3)
        assert height == (500.0 if held else 0.0)
    # five times as often as the three to both sides
    for times, held in ((5, True), (4, False)):
        steps = np.repeat(np.arange(20.0), 10)
        level = np.concatenate([steps, np.full(10 * (times - 1), 7.0)])
        assert held_level(level)[1] == (7.0 if held else 0.0)
    for beside, held in ((3, False), (4, True)):
        steps = np.repeat(np.arange(20.0), 1)
        more = np.concatenate([steps, np.full(9, 9.0), np.full(8, 9.0 + beside)])
        assert held_level(more)[1] == (9.0 if held else 0.0)
    few = np.concatenate([np.arange(7.0), np.full(50, 3.0)])
    assert held_level(few) == (0.0, 0.0)
    assert held_level(np.append(few, 7.0))[1] == 3.0


def test_missing_heights_of_a_twentieth_are_filled():
    x = np.arange(100.0)
    for count, filled in ((5, True), (6, False)):
        gaps = 2.0 * x
        gaps[10 : 10 + 7 * count : 7] = np.nan
        if filled:
            z, told = fill_missing_heights(gaps)
            assert z == pytest.approx(2.0 * x)
            assert str(told) == "5 of 100 missing heights interpolated"
        else:
            with pytest.raises(DataError, match=r"6 of 100 heights are missing \(6.0 %\)"):
                fill_missing_heights(gaps)
    plane = x[:20, None] + 3 * x[None, :20]
    gaps = plane.copy()
    gaps[5:7, 8:12] = np.nan
    assert fill_missing_heights(gaps)[0] == pytest.approx(plane)


def test_points_that_stand_ten_deviations_out_are_dead():
    rough = np.random.default_rng(3).normal(size=(60, 60))
    flat = level_surface(HeightMap(rough, UM)).heights
    robust = 1.4826 * np.median(np.abs(flat - np.median(flat)))
    around = np.median(flat[28:33, 18:23])
    for size, dead in ((9.5, False), (10.5, True)):
        made = rough.copy()
        made[30, 20] += around + size * robust - flat[30, 20]
        whole, _ = without_spikes(HeightMap(made, UM))
        assert (whole.heights[30, 20] != made[30, 20]) == dead
        assert ("1 of 3600 points" in str(whole.processing)) == dead


def waves(angle, length=8.0, n=128, mix=0.0, seed=1):
    """Grooves at an angle (degrees) from x over noise that runs in no direction."""
    x, y = np.meshgrid(np.arange(n), np.arange(n), indexing="ij")
    across = math.radians(angle + 90)
    z = np.sin(2 * np.pi * (x * math.cos(across) + y * math.sin(across)) / length)
    noise = np.random.default_rng(seed).normal(size=(n, n))
    spectrum = np.fft.fft2(noise)
    q = np.hypot(np.fft.fftfreq(n)[:, None], np.fft.fftfreq(n)[None])
    noise = np.fft.ifft2(spectrum * np.exp(-((q / 0.1) ** 2))).real
    return HeightMap(UM * (z + mix * noise / noise.std()), 2 * UM)


@pytest.mark.parametrize("angle", [0.0, 30.0, 90.0, 140.0])
def test_the_lay_of_grooves_is_their_direction(angle):
    found = texture(waves(angle, mix=0.1))
    assert found is not None
    assert len(found.lays) == 1
    off = (math.degrees(found.lays[0]) - angle + 90) % 180 - 90
    assert abs(off) < 2.0
    assert math.degrees(found.across) == pytest.approx(math.degrees(found.lays[0]) + 90)
    assert found.has_lay
    assert found.coherence > 0.9
    plain = texture(waves(angle, mix=50.0))
    assert plain is not None
    assert not plain.has_lay
    assert plain.ratio > 0.5


def test_grooves_of_two_directions_are_two_lays():
    both = HeightMap(waves(20.0).heights + 0.8 * waves(100.0).heights, 2 * UM)
    found = texture(both)
    assert found is not None
    assert [round(math.degrees(lay)) for lay in found.lays] == pytest.approx([20, 100], abs=2)
    assert found.named_lays.count("°") == 2
    # lines between them see both: 60 or 150 degrees, the farther from each
    assert math.degrees(found.across) == pytest.approx(150, abs=2)
    weak = HeightMap(waves(20.0).heights + 0.05 * waves(100.0).heights, 2 * UM)
    assert len(texture(weak).lays) == 1
    near = HeightMap(waves(20.0).heights + waves(32.0).heights, 2 * UM)
    assert len(texture(near).lays) == 1
    long = HeightMap(waves(20.0, 60).heights + waves(110.0, 60).heights, 2 * UM)
    assert len(texture(long).lays) < 2  # too few waves across the map


def test_lines_across_a_lay():
    made = waves(0.0, n=64)
    for degrees, rows in ((2.9, True), (3.1, False), (177.1, True), (87.1, True), (92.9, True)):
        lines = lines_across(made, math.radians(degrees), 5)
        assert len(lines) == 5
        assert (lines[0].heights.size == 64) == rows, degrees
    across = lines_across(made, math.radians(60), 4)
    longest = 63 / math.sin(math.radians(60))
    assert 0.65 * longest < across[0].heights.size <= longest + 1
    assert {line.heights.size for line in across} == {across[0].heights.size}
    plane = HeightMap(np.add.outer(3.0 * np.arange(64), 1.0 * np.arange(50)) * UM, 2 * UM)
    for degrees in (20.0, 60.0, 130.0):
        a = math.radians(degrees)
        for line in lines_across(plane, a, 3):
            rise = np.diff(line.heights) / line.spacing
            assert rise[9:-9] == pytest.approx((3 * math.cos(a) + math.sin(a)) / 2, rel=1e-3)
    assert len(lines_along_axes(made, 7)) == 14
    oblong = HeightMap(made.heights, 2 * UM, spacing_y=3 * UM)
    assert {line.spacing for line in lines_along_axes(oblong, 7)} == {2 * UM}
    assert {line.spacing for line in lines_along_axes(
        HeightMap(made.heights, 3 * UM, spacing_y=2 * UM), 7)} == {2 * UM}  # fmt: skip


def test_power_of_one_wave_goes_one_way():
    ring = np.geomspace(1e5, 2e6, 6)
    for angle in (0.0, 90.0):
        made = directions(waves(angle), ring)
        assert made.share.sum(axis=1) == pytest.approx(np.where(made.share.sum(axis=1) > 0, 1, 0))
        q = 2 * math.pi / (16 * UM)
        cosine, share = made.at(np.array([q]))
        assert share.max() > 0.95
        seen = cosine[0, int(share.argmax())]
        assert seen == pytest.approx(0.0 if angle == 0.0 else 1.0, abs=0.05)
    rings = Directions(np.array([1.0, 4.0, 16.0]), np.eye(3), np.eye(3))
    for q, at in ((1.9, 0), (2.1, 1), (7.9, 1), (8.1, 2), (0.1, 0), (99.0, 2)):
        assert rings.at(np.array([q]))[1].argmax() == at


def test_what_a_texture_says():
    one = Texture(0.213, True, 0.1, 1e-4, 0.9, (math.radians(30),))
    assert str(one) == "Str at most 0.21, lay at 30° from x"
    two = Texture(0.5, False, 0.1, 1e-4, 0.9, (math.radians(90), 0.0))
    assert str(two) == "Str 0.5, lays at 0° and 90° from x"
    assert math.degrees(two.across) in (45.0, 135.0)


def sine(n=2000, waves=40.0, size=2e-6, spacing=UM):
    return Profile(size * np.sin(2 * np.pi * waves * np.arange(n) / n), spacing)


def test_numbers_of_waves_are_those_of_their_formulas():
    z = np.sin(2 * np.pi * np.arange(1000) / 50)
    made = height_numbers(z)
    assert (made.rq, made.ra) == pytest.approx((math.sqrt(0.5), 2 / math.pi), rel=2e-3)
    assert (made.rsk, made.rku) == pytest.approx((0.0, 1.5), abs=1e-9)
    assert (made.rp, made.rv, made.rt) == pytest.approx((1.0, 1.0, 2.0), abs=5e-3)
    assert height_numbers(np.full(9, 3.0)).rsk is None
    x = np.arange(400) * 0.01
    for degree in range(7):
        want = degree * x[3:-3] ** max(degree - 1, 0)
        assert slope(x**degree, 0.01) == pytest.approx(want if degree else 0 * want, abs=1e-6)
    for degree in (2, 4, 6):
        want = degree * (degree - 1) * x[3:-3] ** (degree - 2)
        assert curvature(x**degree, 0.01) == pytest.approx(want, abs=1e-6)


def test_elements_of_a_profile_rise_above_a_tenth_of_its_height():
    x = np.arange(1000) / 100
    z = np.sin(2 * np.pi * x)
    assert element_spacing(z, 0.01, 0.1) == pytest.approx(1.0, rel=1e-3)
    low = np.where(np.floor(x) % 2 == 0, z, 0.05 * z)  # every other hill and dale is too low
    assert element_spacing(low, 0.01, 0.1) == pytest.approx(2.0, rel=1e-2)
    assert element_spacing(z[:140], 0.01, 0.1) is None  # one crossing upward
    assert element_spacing(z[:60], 0.01, 2.0) is None
    assert element_spacing(z[50:270], 0.01, 0.1) == pytest.approx(1.0, rel=1e-2)


def test_cut_offs_and_sections_that_a_profile_can_have():
    profile = sine()
    made = profile_roughness(profile, 250 * UM, 8 * UM)
    assert (made.sections, made.section_length, made.evaluation_length) == pytest.approx(
        (5, 250 * UM, 1250 * UM)
    )
    assert made.rq == pytest.approx(2e-6 / math.sqrt(2), rel=0.03)
    assert made.rsm == pytest.approx(50 * UM, rel=0.02)
    assert made.rdq == pytest.approx(made.rq * 2 * math.pi / (50 * UM), rel=0.02)
    curve = profile_roughness(profile, 250 * UM, 8 * UM, standard="ISO 4287:1997")
    assert curve.rms_curvature == pytest.approx(made.rq * (2 * math.pi / (50 * UM)) ** 2, rel=0.03)
    for sections, fits in ((7, True), (8, False)):
        if fits:
            profile_roughness(profile, 250 * UM, sections=sections - 1)
        else:
            with pytest.raises(DataError, match="the filter uses"):
                profile_roughness(profile, 250 * UM, sections=sections)
    with pytest.raises(InputError):
        profile_roughness(profile, 250 * UM, sections=0)
    profile_roughness(profile, 250 * UM, sections=1)
    with pytest.raises(RangeError, match="at least twice"):
        profile_roughness(profile, 9.9 * UM)
    profile_roughness(profile, 10.1 * UM)
    with pytest.raises(RangeError, match="below what was measured"):
        profile_roughness(profile, 250 * UM, 4.99 * UM)
    profile_roughness(profile, 250 * UM, 5.0 * UM)
    with pytest.raises(InputError, match="below 250"):
        profile_roughness(profile, 250 * UM, 250 * UM)


def test_maps_and_their_slopes():
    made = waves(90.0, 16.0)
    q = 2 * math.pi / (32 * UM)
    rq = float(np.std(made.heights))
    assert rms_slope(made) == pytest.approx(q * rq, rel=0.02)
    periodic = HeightMap(made.heights, 2 * UM, periodic=True)
    assert rms_slope(periodic) == pytest.approx(q * rq, rel=1e-9)
    found = areal_roughness(made, None, 10 * UM)
    assert found.sdq == pytest.approx(q * rq, rel=0.15)
    assert "sdq" in areal_roughness(made).not_estimated
    narrow = HeightMap(made.heights[:8], 2 * UM, resolution=10 * UM)
    assert "nine points" in areal_roughness(narrow).not_estimated["sdq"]
    assert areal_roughness(HeightMap(made.heights[:9], 2 * UM, resolution=10 * UM)).sdq is not None
    coarse = HeightMap(made.heights, 2 * UM, resolution=9.9 * UM)
    assert "not resolved" in areal_roughness(coarse).not_estimated["sdq"]


def test_what_short_scans_lack():
    def chosen(length, resolved=10 * UM, given=None):
        return _cutoff(length, resolved, given, "a.csv")

    assert chosen(1.0)[0] == 0.8e-3
    assert str(chosen(1.0)[1]) == ""
    assert "Measure 4.8 mm" in str(chosen(0.6e-3)[1])
    for resolved, cutoff in ((0.2e-3, 0.8e-3), (0.0201e-3, 0.25e-3)):
        length = 1.0 if cutoff == 0.8e-3 else 0.6e-3
        assert chosen(length, resolved)[0] == cutoff
    with pytest.raises(DataError, match="holds no cut-off"):
        chosen(1.0, 0.201e-3)
    with pytest.raises(DataError, match="holds no cut-off"):
        chosen(0.01e-3)
    assert chosen(1e-3, given=0.3e-3)[0] == 0.3e-3
    with pytest.raises(DataError, match="for a cut-off of"):
        chosen(0.2e-3, given=0.3e-3)


def test_heights_that_no_floor_has_and_sections_that_carry_the_roughness():
    for rq, odd in ((49e-9, True), (51e-9, False), (299e-6, False), (301e-6, True)):
        assert bool(height_cautions(rq)) == odd
    for high, told in ((5.02, True), (4.98, False)):  # root mean square twice the median
        sections = np.array([1.0] * 7 + [high * 1.0])
        whole = math.sqrt((7 + high**2) / 8)
        assert bool(_uneven(sections * UM)) == (whole > 2.0) == told
    assert not _uneven(np.array([1.0, 9.0]))
    held = Profile(np.append(np.arange(900.0), np.full(100, 950.0)) * UM, UM)
    assert "10 % of the heights are one number" in str(_equal_heights_question(held)).replace(
        "10.0", "10"
    )
    assert not _equal_heights_question(sine())


def test_numbers_of_lines_and_their_spread():
    rng = np.random.default_rng(2)
    line = Profile(UM * rng.normal(size=4000), UM)
    values, count, doubt = _numbers([line], [line], 250 * UM, 5 * UM, None, line)
    assert (count, str(doubt)) == (5, "")
    rq = values["rq"]
    assert rq.uncertainty is not None
    assert 0 < rq.uncertainty < 0.1 * rq.value
    two = _numbers([line, line], [line, line], 250 * UM, 5 * UM, None, line)[0]
    assert two["rq"].value == pytest.approx(rq.value)
    flat = Profile(2e-6 * np.sin(2 * np.pi * np.arange(4000) / 50), UM)
    assert _numbers([flat], [flat], 250 * UM, 5 * UM, None, flat)[0]["rq"].uncertainty is None
    short = Profile(line.heights[:400], UM)
    assert _numbers([short], [short], 250 * UM, 5 * UM, None, short)[1] == 1
    # the short cut-off must lie four times below the long one
    assert _numbers([line], [line], 250 * UM, 62.4 * UM, None, line)[0]["rdq"].value is not None
    assert _numbers([line], [line], 250 * UM, 62.6 * UM, None, line)[0]["rdq"].value is None


def test_positions_and_what_they_resolve():
    x = np.arange(101.0)
    for off, even in ((0.0099, True), (0.0102, False)):
        moved = x.copy()
        moved[50] += off
        if even:
            assert profile_from_positions(moved * UM, 0 * x).spacing == pytest.approx(UM)
        else:
            with pytest.raises(DataError, match="positions are uneven"):
                profile_from_positions(moved * UM, 0 * x)
            assert "resampled" in str(
                profile_from_positions(moved * UM, 0 * x, resample=True).processing
            )
    back = profile_from_positions(x[::-1] * UM, x * UM)
    assert back.heights[0] == 100 * UM
    assert shortest_reliable_wavelength(Profile(x, UM)).wavelength == pytest.approx(5 * UM)
    known = Profile(x, UM, resolution=2.5 * UM)
    assert shortest_reliable_wavelength(known).wavelength == pytest.approx(2.5 * UM)
    fine = Profile(x, UM, resolution=1.5 * UM)
    assert shortest_reliable_wavelength(fine).wavelength == pytest.approx(2 * UM)


def test_maps_made_periodic():
    made = waves(30.0, mix=1.0)
    fades = make_periodic(made, share=0.25)
    flat = level_surface(made).heights
    assert fades.periodic
    middle = slice(32, 96)
    assert fades.heights[middle, middle] == pytest.approx(flat[middle, middle])
    at = 0.5 - 0.5 * math.cos(math.pi * 0.5 / 32)
    assert fades.heights[0, 64] == pytest.approx(at * flat[0, 64])
    mirror = make_periodic(made, "mirror")
    assert mirror.heights.shape == (256, 256)
    assert mirror.heights[0] == pytest.approx(mirror.heights[-1])
    assert mirror.heights[:, 127] == pytest.approx(mirror.heights[:, 128])


def test_positions_rounded_in_print_are_a_grid_and_others_are_none(tmp_path):
    """Steps of 0.15 um in one decimal are off by half a digit, no more."""
    rng = np.random.default_rng(6)

    def read(places):
        rows = [f"{x:.1f} {y:.1f} {rng.normal():.4f}" for x in places for y in places]
        path = tmp_path / "a.xyz"
        path.write_text("\n".join(rows) + "\n", encoding="utf-8")
        return read_surface(path, length_unit="um", height_unit="um")

    made = read([0.0, 0.2, 0.3, 0.5, 0.6, 0.8, 0.9])
    assert made.spacings == pytest.approx((0.15 * UM, 0.15 * UM))
    assert made.shape == (7, 7)
    with pytest.raises(DataError, match="is uneven: up to"):
        read([0.0, 1.0, 2.0, 3.1, 4.0, 5.0, 6.0])


@pytest.mark.parametrize("wrong", [[0.0, 1.0], [-1.0, 1.0], [2.0, 1.0], [1.0, 1.0], [1.0, np.nan]])
def test_wave_numbers_rise_from_above_nothing(wrong):
    with pytest.raises(InputError, match="ascending, above 0"):
        ProfileSpectrum(np.array(wrong), np.ones(2), (1.0, 2.0))
    one = ProfileSpectrum(np.array([0.5]), np.ones(1), (0.5, 0.5))
    assert one.area == pytest.approx([1.0])
    for density in ([1.0, -1e-9], [1.0, np.nan]):
        with pytest.raises(InputError, match="negative or missing"):
            ProfileSpectrum(np.array([1.0, 2.0]), np.array(density), (1.0, 2.0))


@pytest.mark.parametrize("rows", [2, 3, 4])
def test_few_oblong_rows_are_divided_by_what_they_bear(rows):
    """A line through two rows, a parabola through three, a cubic through four: exact."""
    x = np.arange(rows) * 3e-6
    degree = rows - 1
    surface = HeightMap(np.tile((x**degree)[:, None], (1, 6)), 3e-6, spacing_y=1e-6)
    square = square_cells(surface)
    fine = np.arange(3 * degree + 1) * 1e-6
    assert square.spacings == (1e-6, 1e-6)
    assert square.heights[:, 2] == pytest.approx(fine**degree, abs=1e-12 * x[-1] ** degree)


@pytest.mark.parametrize(("off", "marked"), [(0.009, False), (0.011, True)])
def test_positions_rounded_in_print_are_marked_from_one_percent_of_the_spacing_on(off, marked):
    x = np.arange(201.0)
    x[100] += off
    profile = profile_from_positions(x * 1e-6, np.zeros(201), rounding=0.02e-6)
    assert bool(profile.processing) == marked
