"""One rough surface, told in other ways: the numbers stay, turn round or scale with it."""

from dataclasses import replace

import numpy as np
import pytest

from underfoot.surface import (
    HeightMap,
    Profile,
    areal_roughness,
    autocorrelation,
    correlation_length,
    isotropic_spectrum,
    level_surface,
    profile_from_positions,
    profile_roughness,
    profile_spectrum,
    self_affine,
    spectral_moments,
    write_surface,
)
from underfoot.surface.lay import lines_across, texture
from underfoot.surface.scan import read_scan

STANDARDS = ("ISO 21920-2:2021", "ISO 4287:1997")
LENGTHS = ("ra", "rq", "rz", "rp", "rv", "rt", "rsm")
SAME = {"rsk": "rsk", "rku": "rku", "rdq": "rdq"}


def wavy(n, seed, shortest=12):
    """Return heights (n,) of waves of ``shortest`` points and more, with skew."""
    generator = np.random.default_rng(seed)
    power = np.fft.rfft(generator.standard_normal(n))
    power[n // shortest :] = 0
    z = np.fft.irfft(power, n)
    return 2e-6 * (z / z.std() + 0.3 * (z / z.std()) ** 2)


@pytest.fixture(scope="module", params=STANDARDS)
def numbers(request):
    """Return a profile and how its numbers are taken."""

    def of(profile, scale=1.0):
        return profile_roughness(profile, 0.8e-3 * scale, 20e-6 * scale, standard=request.param)

    return Profile(wavy(3000, 3), 2e-6, periodic=False), of


def test_a_profile_read_backward_has_the_same_numbers(numbers):
    profile, of = numbers
    one, other = of(profile), of(replace(profile, heights=profile.heights[::-1].copy()))
    for name in (*LENGTHS[:-1], *SAME, "rms_curvature"):
        assert getattr(other, name) == pytest.approx(getattr(one, name), rel=1e-9), name


def test_hills_are_dales_of_the_cast(numbers):
    profile, of = numbers
    one, cast = of(profile), of(replace(profile, heights=-profile.heights))
    assert (cast.rp, cast.rv) == pytest.approx((one.rv, one.rp))
    assert cast.rsk == pytest.approx(-one.rsk)
    for name in ("ra", "rq", "rz", "rt", "rku", "rdq", "rms_curvature"):
        assert getattr(cast, name) == pytest.approx(getattr(one, name)), name
    assert one.rp > 1.1 * one.rv  # else this says nothing


def test_a_tilt_and_a_level_change_nothing(numbers):
    profile, of = numbers
    one = of(profile)
    tilted = of(replace(profile, heights=profile.heights + 3e-4 + 0.01 * profile.positions))
    for name in (*LENGTHS, *SAME, "rms_curvature"):
        assert getattr(tilted, name) == pytest.approx(getattr(one, name), rel=1e-6), name


def test_lengths_scale_with_the_unit_and_slopes_do_not(numbers):
    profile, of = numbers
    one = of(profile)
    large = of(replace(profile, heights=7 * profile.heights, spacing=7 * profile.spacing), 7)
    for name in LENGTHS:
        assert getattr(large, name) == pytest.approx(7 * getattr(one, name)), name
    for name in SAME:
        assert getattr(large, name) == pytest.approx(getattr(one, name)), name
    assert large.rms_curvature == pytest.approx(one.rms_curvature / 7)
    assert large.evaluation_length == pytest.approx(7 * one.evaluation_length)


def test_heights_alone_scale_heights_slopes_and_no_spacing(numbers):
    profile, of = numbers
    one, high = of(profile), of(replace(profile, heights=3 * profile.heights))
    for name in ("ra", "rq", "rz", "rp", "rv", "rt", "rdq", "rms_curvature"):
        assert getattr(high, name) == pytest.approx(3 * getattr(one, name)), name
    for name in ("rsm", "rsk", "rku"):
        assert getattr(high, name) == pytest.approx(getattr(one, name)), name


def lying(nx=96, ny=80, spacing=(4e-6, 5e-6), seed=1, stretch=6):
    """Return a map with grooves along x: ``stretch`` times as long as wide."""
    generator = np.random.default_rng(seed)
    qx, qy = np.fft.fftfreq(nx, spacing[0])[:, None], np.fft.fftfreq(ny, spacing[1])[None, :]
    power = np.exp(-((stretch * qx * 20e-6) ** 2) - (qy * 20e-6) ** 2)
    z = np.fft.ifft2(np.fft.fft2(generator.standard_normal((nx, ny))) * power).real
    return HeightMap(2e-6 * z / z.std(), spacing[0], spacing_y=spacing[1])


def turned(surface):
    """Return the map with x and y changed over."""
    return replace(
        surface,
        heights=surface.heights.T.copy(),
        spacing=surface.spacings[1],
        spacing_y=surface.spacings[0],
    )


def scaled(surface, factor):
    along, across = surface.spacings
    return replace(
        surface,
        heights=factor * surface.heights,
        spacing=factor * along,
        spacing_y=factor * across,
    )


def mirrored(surface, axis):
    return replace(surface, heights=np.flip(surface.heights, axis).copy())


AREAL = ("sa", "sq", "sz", "sp", "sv", "ssk", "sku", "sdq")


@pytest.mark.parametrize("other", [turned, lambda s: mirrored(s, 0), lambda s: mirrored(s, 1)])
def test_areal_numbers_know_no_direction(other):
    surface = lying()
    one, two = (areal_roughness(s, 0.2e-3, 50e-6) for s in (surface, other(surface)))
    for name in AREAL:
        assert getattr(two, name) == pytest.approx(getattr(one, name), rel=1e-9), name
    assert sorted(two.evaluation_size) == pytest.approx(sorted(one.evaluation_size))


def test_a_plane_under_a_map_changes_nothing():
    surface = lying()
    x, y = (np.arange(n) * h for n, h in zip(surface.shape, surface.spacings, strict=True))
    plane = 1e-4 + 0.02 * x[:, None] - 0.03 * y[None, :]
    one = areal_roughness(surface, 0.2e-3, 50e-6)
    two = areal_roughness(replace(surface, heights=surface.heights + plane), 0.2e-3, 50e-6)
    for name in AREAL:
        assert getattr(two, name) == pytest.approx(getattr(one, name), rel=1e-6), name


def test_the_lay_turns_with_the_map_and_mirrors_with_it():
    surface = lying()
    one, across = texture(surface), texture(turned(surface))
    assert one.has_lay
    assert across.has_lay
    # x and y change over: an angle from x is one from y
    assert np.degrees(one.direction + across.direction) % 180 == pytest.approx(90, abs=1e-6)
    assert across.ratio == pytest.approx(one.ratio, rel=0.05)
    assert across.length == pytest.approx(one.length, rel=0.05)
    image = texture(mirrored(surface, 0))
    assert np.sin(image.direction + one.direction) == pytest.approx(0, abs=1e-6)
    assert image.coherence == pytest.approx(one.coherence)


def test_the_lay_scales_with_the_unit_and_not_with_the_heights():
    surface = lying()
    one = texture(surface)
    large = texture(scaled(surface, 5))
    assert large.length == pytest.approx(5 * one.length)
    assert (large.ratio, large.direction) == pytest.approx((one.ratio, one.direction))
    high = texture(replace(surface, heights=9 * surface.heights))
    assert (high.length, high.ratio, high.coherence) == pytest.approx(
        (one.length, one.ratio, one.coherence)
    )


def test_lines_across_a_lay_see_its_grooves():
    surface = lying()
    across, along = (
        np.sqrt(np.mean([np.mean(np.diff(line.heights) ** 2) / line.spacing**2 for line in lines]))
        for lines in (
            lines_across(surface, texture(surface).across, 9),
            lines_across(surface, texture(surface).across + 0.5 * np.pi, 9),
        )
    )
    assert across > 3 * along


def test_spectra_know_no_direction_and_scale():
    surface = replace(lying(), periodic=True)
    one, two = isotropic_spectrum(surface), isotropic_spectrum(turned(surface))
    np.testing.assert_allclose(two.wavenumber, one.wavenumber)
    np.testing.assert_allclose(two.density, one.density, rtol=1e-9, atol=1e-40)
    k = 3.0
    larger = scaled(surface, k)
    three = isotropic_spectrum(larger)
    np.testing.assert_allclose(three.wavenumber, one.wavenumber / k)
    np.testing.assert_allclose(three.density, k**4 * one.density, rtol=1e-9, atol=1e-40)
    m1, m3 = spectral_moments(one), spectral_moments(three)
    assert (m3.m0, m3.m2, m3.m4) == pytest.approx((k**2 * m1.m0, m1.m2, m1.m4 / k**2))
    assert m3.bandwidth == pytest.approx(m1.bandwidth)


def test_spectrum_and_correlation_of_a_line_read_backward():
    line = Profile(wavy(600, 5), 2e-6, periodic=True)
    back = replace(line, heights=line.heights[::-1].copy())
    one, two = profile_spectrum(line), profile_spectrum(back)
    np.testing.assert_allclose(two.density, one.density, rtol=1e-9, atol=1e-30)
    for first, second in zip(autocorrelation(line), autocorrelation(back), strict=True):
        np.testing.assert_allclose(second, first, atol=1e-9 * np.abs(first).max())
    large = replace(line, spacing=4 * line.spacing)
    assert correlation_length(large) == pytest.approx(4 * correlation_length(line))


def test_positions_shifted_or_read_backward_are_the_same_profile():
    x, z = 2e-6 * np.arange(200), wavy(200, 2)
    one = profile_from_positions(x, z)
    shifted = profile_from_positions(x + 5e-3, z)
    back = profile_from_positions(x[::-1], z[::-1])
    for other in (shifted, back):
        np.testing.assert_allclose(other.heights, one.heights)
        assert other.spacing == pytest.approx(one.spacing)


def test_levelling_twice_is_levelling_once():
    surface = lying()
    for degree in (1, 2):
        once = level_surface(surface, degree)
        np.testing.assert_allclose(level_surface(once, degree).heights, once.heights, atol=1e-15)


def test_a_scan_turned_round_has_the_same_numbers(tmp_path):
    surface = lying(160, 128)
    found = {}
    for name, one in {
        "as it is": surface,
        "turned": turned(surface),
        "mirrored": mirrored(surface, 0),
        "upside down": mirrored(mirrored(surface, 0), 1),
    }.items():
        path = tmp_path / f"{name}.sdf"
        write_surface(one, path)
        found[name] = read_scan(path, cutoff=0.25e-3)
    first = found["as it is"]
    assert first.texture.has_lay
    for other in found.values():
        for name, value in first.values.items():
            if value.value is not None:
                assert other.values[name].value == pytest.approx(value.value, rel=0.03), name
        assert other.hurst.value == pytest.approx(first.hurst.value, rel=0.02)


def test_a_correlation_knows_no_level():
    line = Profile(wavy(600, 5), 2e-6, periodic=True)
    raised = replace(line, heights=line.heights + 1e-4)
    np.testing.assert_allclose(autocorrelation(raised)[1], autocorrelation(line)[1], atol=1e-6)


def test_a_scan_finds_the_power_law_that_its_surface_was_made_of(tmp_path):
    for hurst in (0.5, 0.8):
        made = self_affine(256, 4e-6, 2e-6, hurst, 1024e-6, 8e-6, 3)
        path = tmp_path / f"{hurst}.sdf"
        write_surface(replace(made, periodic=False), path)
        assert read_scan(path, cutoff=0.25e-3).hurst.value == pytest.approx(hurst, abs=0.15)


def test_only_oblong_cells_are_said_to_show_more_along_one_side(tmp_path):
    made = replace(self_affine(128, 4e-6, 2e-6, 0.8, 512e-6, 32e-6, 4), periodic=False)
    forms = {
        "": made,
        "along x": replace(made, heights=made.heights[:, ::2].copy(), spacing_y=8e-6),
        "along y": replace(made, heights=made.heights[::2].copy(), spacing=8e-6, spacing_y=4e-6),
    }
    for finer, surface in forms.items():
        path = tmp_path / f"{finer or 'square'}.sdf"
        write_surface(surface, path)
        said = [note for note in read_scan(path, cutoff=0.08e-3).notes if "cells of" in note]
        assert len(said) == bool(finer)
        assert all(finer in note for note in said)
