"""Filters, roughness numbers and spectra of surfaces whose values are known."""

import numpy as np
import pytest

from underfoot.core import DataError, InputError, RangeError
from underfoot.surface import (
    HeightMap,
    Profile,
    areal_roughness,
    asperities,
    autocorrelation,
    checkerboard,
    correlation_length,
    fill_missing_heights,
    height_numbers,
    isotropic_from_profile,
    isotropic_spectrum,
    level_surface,
    long_waves,
    make_periodic,
    profile_from_positions,
    profile_roughness,
    profile_spectrum,
    rms_slope,
    self_affine,
    short_waves,
    shortest_reliable_wavelength,
    sinusoidal,
    spectral_moments,
    surface_from_spectrum,
)

UM, MM = 1e-6, 1e-3


def mean_square(spectrum):
    return float(np.sum(spectrum.density * spectrum.area))


def wave(amplitude, wavelength, length=5.6 * MM, spacing=0.5 * UM):
    x = spacing * np.arange(round(length / spacing))
    return Profile(amplitude * np.sin(2 * np.pi * x / wavelength), spacing)


@pytest.mark.parametrize("ends", ["drop", "regression", "periodic"])
@pytest.mark.parametrize("ratio", [0.25, 0.5, 1.0, 2.0, 4.0])
def test_gaussian_filter_transmits_by_its_formula(ends, ratio):
    """ISO 16610-21: exp(-pi (alpha lambda_c / lambda)^2), 50 % at the cut-off."""
    cutoff = 0.8 * MM
    profile = wave(1 * UM, ratio * cutoff, length=32 * cutoff, spacing=4 * UM)
    if ends == "periodic":
        profile = Profile(profile.heights, profile.spacing, periodic=True)
    kept = long_waves(profile, cutoff, ends).heights
    inner = kept[kept.size // 4 : -kept.size // 4]
    expected = 2.0 ** -((1 / ratio) ** 2)
    # Weights cut at half a cut-off alter the transmission by up to 1.1 %.
    assert np.ptp(inner) / 2 / UM == pytest.approx(expected, abs=0.011 if ends == "drop" else 5e-4)
    if ratio == 1.0:
        assert expected == 0.5


def test_long_and_short_waves_add_up_and_lengths_shrink_as_told():
    profile = wave(1 * UM, 0.3 * MM)
    for ends, lost in (("drop", 0.8 * MM), ("regression", 0.0)):
        long, short = (f(profile, 0.8 * MM, ends) for f in (long_waves, short_waves))
        n = (profile.heights.size - long.heights.size) // 2
        np.testing.assert_allclose(
            long.heights + short.heights,
            profile.heights[n : profile.heights.size - n],
            atol=1e-12 * UM,
        )
        assert profile.length - long.length == pytest.approx(lost, abs=1e-9)
        assert ends in long.processing[-1]


def test_lines_pass_the_regression_filter_to_the_very_ends():
    x = np.linspace(0.0, 1.0, 501)
    line = Profile(3 * UM + 7 * UM * x, 2 * UM)
    np.testing.assert_allclose(short_waves(line, 0.25 * MM, "regression").heights, 0.0, atol=1e-17)
    plane = HeightMap(x[:101, None] * UM + 2 * x[None, :101] * UM, 2 * UM)
    np.testing.assert_allclose(short_waves(plane, 0.05 * MM, "regression").heights, 0.0, atol=1e-17)


def test_levelling_removes_exactly_its_form():
    x = np.linspace(-1, 1, 301)
    cubic = Profile(1 + 2 * x + 3 * x**2 + 4 * x**3, UM)
    assert np.abs(level_surface(cubic, 3).heights).max() < 1e-13
    assert np.abs(level_surface(cubic, 2).heights).max() > 0.1
    y = np.linspace(-1, 1, 77)
    form = HeightMap(1 + 2 * x[:, None] + 3 * y + x[:, None] * y + y**2, UM)
    assert np.abs(level_surface(form, 2).heights).max() < 1e-13
    assert "polynomial of degree 2" in level_surface(form, 2).processing[-1]
    assert "plane" in level_surface(form).processing[-1]
    with pytest.raises(InputError, match="degree"):
        level_surface(cubic, -1)
    with pytest.raises(InputError, match="coefficients"):
        level_surface(Profile([1.0, 2.0, 3.0], UM), 2)


@pytest.mark.parametrize("standard", ["ISO 21920-2:2021", "ISO 4287:1997"])
def test_numbers_of_a_sine(standard):
    # 16 waves of 50 um in each section of 0.8 mm; the filter passes 99.7 % of them.
    a, wavelength = 2 * UM, 50 * UM
    passed = 1 - 2.0 ** -((0.8 * MM / wavelength) ** 2)
    kept = 2.0 ** -((2.5 * UM / wavelength) ** 2)
    a *= passed * kept
    found = profile_roughness(wave(2 * UM, wavelength), 0.8 * MM, 2.5 * UM, standard=standard)
    q = 2 * np.pi / wavelength
    assert found.ra == pytest.approx(2 * a / np.pi, rel=1e-3)
    assert found.rq == pytest.approx(a / np.sqrt(2), rel=1e-3)
    assert found.rz == pytest.approx(2 * a, rel=1e-3)
    assert found.rp == pytest.approx(a, rel=1e-3)
    assert found.rv == pytest.approx(a, rel=1e-3)
    assert found.rt == pytest.approx(2 * a, rel=1e-3)
    assert found.rsk == pytest.approx(0.0, abs=1e-3)
    assert found.rku == pytest.approx(1.5, rel=1e-3)
    assert found.rsm == pytest.approx(wavelength, rel=1e-3)
    assert found.rdq == pytest.approx(a * q / np.sqrt(2), rel=2e-3)
    assert found.rms_curvature == pytest.approx(a * q**2 / np.sqrt(2), rel=4e-3)
    assert found.evaluation_length == pytest.approx(4 * MM)
    assert found.standard == standard
    assert "cut-off 800 um" in found.processing[-1]


def test_sections_count_their_own_peaks_and_the_standards_differ():
    profile = wave(1 * UM, 50 * UM)
    z = profile.heights.copy()
    middle = z.size // 2
    z[middle] += 10 * UM
    spiked = Profile(z, profile.spacing)
    new, old = (
        profile_roughness(spiked, 0.8 * MM, standard=s)
        for s in ("ISO 21920-2:2021", "ISO 4287:1997")
    )
    assert new.rt == pytest.approx(11 * UM, rel=0.15)
    assert new.rz == pytest.approx(2 * UM + (new.rt - 2 * UM) / 5, rel=0.02)
    assert new.rz == old.rz
    assert new.rku > old.rku  # one section of five holds the spike
    assert new.rdq is None
    assert "short cut-off" in new.not_estimated["rdq"]
    assert "not estimated" in str(new)


def test_small_ripples_do_not_count_as_elements():
    profile = wave(1 * UM, 100 * UM)
    ripple = Profile(profile.heights + wave(0.05 * UM, 7 * UM).heights, profile.spacing)
    assert profile_roughness(ripple, 0.8 * MM).rsm == pytest.approx(100 * UM, rel=0.02)
    flat = profile_roughness(wave(1 * UM, 4 * MM), 0.8 * MM)
    assert flat.rsm is None or flat.rsm > 1 * MM


def test_triangle_and_square_waves():
    n = 4000
    triangle = 2 * np.abs(2 * ((np.arange(n) / 100) % 1) - 1) - 1
    numbers = height_numbers(triangle)
    assert numbers.ra == pytest.approx(0.5, rel=1e-3)
    assert numbers.rq == pytest.approx(1 / np.sqrt(3), rel=1e-3)
    assert numbers.rku == pytest.approx(1.8, rel=2e-3)
    square = height_numbers(np.sign(np.sin(2 * np.pi * (np.arange(n) + 0.5) / 100)))
    assert (square.ra, square.rq, square.rku) == pytest.approx((1.0, 1.0, 1.0))
    assert height_numbers(np.ones(5)).rsk is None
    flat = profile_roughness(Profile(np.zeros(10_000), UM), 0.8 * MM)
    assert (flat.ra, flat.rz, flat.rsk, flat.rsm) == (0.0, 0.0, None, None)
    assert {"rsk", "rku", "rsm"} <= set(flat.not_estimated)
    assert "Rsk not estimated" in str(flat)
    assert "ssk" in areal_roughness(HeightMap(np.zeros((32, 32)), UM)).not_estimated


def test_refusals_of_roughness_numbers():
    profile = wave(1 * UM, 50 * UM)
    with pytest.raises(DataError, match="sections"):
        profile_roughness(profile, 2.5 * MM)
    with pytest.raises(DataError, match="too short"):
        profile_roughness(profile, 8 * MM)
    assert profile_roughness(profile, 0.8 * MM, sections=7, ends="regression").sections == 7
    with pytest.raises(RangeError, match="below what was measured"):
        profile_roughness(profile, 0.8 * MM, 1 * UM)
    coarse = Profile(profile.heights, profile.spacing, resolution=20 * UM)
    with pytest.raises(RangeError, match="resolution of the instrument"):
        profile_roughness(coarse, 0.8 * MM, 8 * UM)
    with pytest.raises(RangeError, match="long cut-off"):
        profile_roughness(coarse, 25 * UM)
    with pytest.raises(InputError, match="standard"):
        profile_roughness(profile, 0.8 * MM, standard="DIN")
    with pytest.raises(InputError, match="sections"):
        profile_roughness(profile, 0.8 * MM, sections=0)
    with pytest.raises(InputError, match="short_cutoff"):
        profile_roughness(profile, 0.8 * MM, 0.9 * MM)
    with pytest.raises(InputError, match="periodic"):
        long_waves(profile, 0.8 * MM, "periodic")
    with pytest.raises(InputError, match="ends"):
        long_waves(profile, 0.8 * MM, "reflect")
    with pytest.raises(InputError, match="two spacings"):
        long_waves(profile, 0.5 * UM)


def test_the_tip_sets_the_resolution():
    sharp = wave(0.5 * UM, 5 * UM, length=0.2 * MM, spacing=0.1 * UM)
    # Curvature a q^2 = 0.79 / um, more than half that of a 2 um tip (0.25 / um).
    tipped = Profile(sharp.heights, sharp.spacing, tip_radius=2 * UM)
    limit = shortest_reliable_wavelength(tipped)
    assert "tip" in limit.reason
    assert limit.wavelength > 1 * UM
    smooth = Profile(0.01 * sharp.heights, sharp.spacing, tip_radius=2 * UM)
    assert shortest_reliable_wavelength(smooth).wavelength == pytest.approx(0.5 * UM)


def test_areal_numbers_of_a_wave_and_a_checkerboard():
    a, wavelength = 1 * UM, 64 * UM
    surface = sinusoidal((256, 64), 1 * UM, a, wavelength)
    found = areal_roughness(surface)
    assert found.sa == pytest.approx(2 * a / np.pi, rel=1e-3)
    assert found.sq == pytest.approx(a / np.sqrt(2), rel=1e-9)
    assert found.sz == pytest.approx(2 * a, rel=1e-9)
    assert found.sku == pytest.approx(1.5, rel=1e-9)
    assert found.sdq == pytest.approx(a * 2 * np.pi / wavelength / np.sqrt(2), rel=1e-6)
    board = areal_roughness(checkerboard(128, 1 * UM, 2 * a, wavelength))
    assert board.sq == pytest.approx(a / 2, rel=1e-9)
    assert board.sz == pytest.approx(2 * a, rel=1e-9)
    assert board.sdq == pytest.approx(a * 2 * np.pi / wavelength / np.sqrt(2), rel=1e-6)
    cut = HeightMap(surface.heights[:200], 1 * UM)
    measured = areal_roughness(cut, 50 * UM, 5 * UM)
    assert measured.sdq is not None
    assert "ISO 16610-61" in measured.processing[-1]
    assert areal_roughness(cut).sdq is None
    assert "short cut-off" in areal_roughness(cut).not_estimated["sdq"]
    with pytest.raises(RangeError, match="below what was measured"):
        areal_roughness(cut, short_cutoff=2 * UM)


@pytest.mark.parametrize("n", [255, 256])
def test_parseval_of_profiles_and_maps(n):
    z = np.random.default_rng(1).standard_normal((n, 200)) * UM
    surface = HeightMap(z - z.mean(), 1 * UM, periodic=True)
    assert mean_square(isotropic_spectrum(surface)) == pytest.approx(z.var(), rel=1e-12)
    line = Profile(z[:, 0], 1 * UM, periodic=True)
    assert mean_square(profile_spectrum(line)) == pytest.approx(z[:, 0].var(), rel=1e-12)
    windowed = profile_spectrum(Profile(z[:, 0], 1 * UM))
    assert mean_square(windowed) == pytest.approx(z[:, 0].var(), rel=0.2)
    assert "hann" in " ".join(windowed.notes)


def test_spectra_against_surface_topography():
    topography = pytest.importorskip("SurfaceTopography")
    surface = self_affine(128, 1 * UM, 1 * UM, 0.8, 128 * UM, 4 * UM, 1)
    peer = topography.Topography(surface.heights, surface.size, periodic=True)
    q, density = peer.power_spectrum_from_profile(resampling_method=None, reliable=False)
    ours = profile_spectrum(surface)
    # Its density is 2 pi times Persson's.
    np.testing.assert_allclose(ours.wavenumber[:62], q[1:63], rtol=1e-12)
    np.testing.assert_allclose(density[1:31], 2 * np.pi * ours.density[:30], rtol=1e-9)


def test_tip_limit_against_surface_topography():
    topography = pytest.importorskip("SurfaceTopography")
    z = self_affine(512, 0.1 * UM, 0.2 * UM, 0.7, 51.2 * UM, 0.2 * UM, 1).heights[:, 0]
    peer = topography.UniformLineScan(z, 51.2 * UM)
    for radius in (3 * UM, 10 * UM):
        ours = shortest_reliable_wavelength(Profile(z, 0.1 * UM, tip_radius=radius))
        # Ours takes whole grid steps.
        assert ours.wavelength == pytest.approx(
            peer.scanning_probe_reliability_cutoff(radius), rel=0.12
        )


def test_hann_window_keeps_the_level_of_a_broad_spectrum():
    ratios = []
    for seed in range(4):
        surface = self_affine(256, 1 * UM, 1 * UM, 0.8, 64 * UM, 4 * UM, seed, 32 * UM)
        cut = HeightMap(surface.heights[:200, :200], 1 * UM)
        whole, part = isotropic_spectrum(surface), isotropic_spectrum(cut)
        q = np.geomspace(0.3e6, 1.2e6, 12)
        ratios.append(
            np.interp(q, part.wavenumber, part.density)
            / np.interp(q, whole.wavenumber, whole.density)
        )
    assert np.mean(ratios) == pytest.approx(1.0, abs=0.06)


def test_self_affine_spectrum_has_its_slope_and_level():
    surface = self_affine(512, 1 * UM, 2 * UM, 0.7, 512 * UM, 4 * UM, 5, 128 * UM)
    assert surface.rms_height == pytest.approx(2 * UM, rel=1e-12)
    found = isotropic_spectrum(surface)
    q = found.wavenumber
    power = (q > 1.3 * 2 * np.pi / (128 * UM)) & (q < 0.9 * 2 * np.pi / (4 * UM))
    slope = np.polyfit(np.log(q[power]), np.log(found.density[power]), 1)[0]
    assert slope == pytest.approx(-2 * (1 + 0.7), abs=0.03)
    flat = (q > 1.5 * 2 * np.pi / (512 * UM)) & (q < 0.8 * 2 * np.pi / (128 * UM))
    assert np.ptp(np.log(found.density[flat])) < 0.02
    assert np.all(found.density[q > 1.02 * 2 * np.pi / (4 * UM)] < 1e-12 * found.density.max())


def test_moments_against_direct_derivatives():
    surface = self_affine(256, 1 * UM, 1 * UM, 0.8, 256 * UM, 8 * UM, 2, 64 * UM)
    moments = spectral_moments(isotropic_spectrum(surface), (1.0, 1e9))
    assert moments.m0 == pytest.approx(surface.rms_height**2, rel=1e-9)
    assert 2 * moments.m2 == pytest.approx(rms_slope(surface) ** 2, rel=0.01)
    # By differences of the same heights: within what seven points give at eight to a wave.
    assert rms_slope(HeightMap(surface.heights, surface.spacing)) == pytest.approx(
        rms_slope(surface), rel=0.02
    )
    # A generated surface is reliable to its cut-off; the ring that lies across it is left out.
    default = spectral_moments(isotropic_spectrum(surface))
    assert default.m4 == pytest.approx(moments.m4, rel=0.05)
    found = asperities(moments)
    assert found.density * found.radius * found.height_sd == pytest.approx(0.05, abs=0.03)
    assert moments.bandwidth > 1.5
    single = spectral_moments(profile_spectrum(sinusoidal(64, 1 * UM, 1 * UM, 16 * UM)), (1.0, 1e9))
    q = 2 * np.pi / (16 * UM)
    assert (single.m0, single.m2, single.m4) == pytest.approx(
        (0.5 * UM**2, 0.5 * UM**2 * q**2, 0.5 * UM**2 * q**4), rel=1e-9
    )
    with pytest.raises(InputError, match="bandwidth"):
        asperities(single)
    with pytest.raises(InputError, match="no roughness"):
        spectral_moments(isotropic_spectrum(surface), (1e9, 1e10))


def test_abel_inversion_of_a_gaussian_spectrum():
    """C(q) = s^2 l^2 / (4 pi) exp(-q^2 l^2 / 4) has the profiles s^2 l / (2 sqrt pi) exp(...)."""
    from underfoot.surface import ProfileSpectrum

    s, length = 1 * UM, 20 * UM
    q = np.geomspace(1e3, 4e5, 400)
    profile = ProfileSpectrum(
        q, s**2 * length / (2 * np.sqrt(np.pi)) * np.exp(-(q**2) * length**2 / 4), (1e3, 4e5)
    )
    found = isotropic_from_profile(profile)
    exact = s**2 * length**2 / (4 * np.pi) * np.exp(-(found.wavenumber**2) * length**2 / 4)
    body = (found.wavenumber > 2e4) & (found.wavenumber < 2e5)
    np.testing.assert_allclose(found.density[body], exact[body], rtol=0.06)
    assert "isotropy assumed" in " ".join(found.notes)
    with pytest.raises(InputError, match="decade"):
        isotropic_from_profile(ProfileSpectrum(q, profile.density, (1e3, 1.5e3)))


def test_abel_inversion_of_a_power_law():
    """C1 ~ q^-(1+2H) comes from C ~ q^-(2+2H): ratio Gamma(H+1/2) sqrt(pi) / Gamma(H+1)."""
    from scipy.special import gamma

    from underfoot.surface import ProfileSpectrum

    hurst = 0.8
    q = np.geomspace(1e4, 1e7, 200)
    found = isotropic_from_profile(ProfileSpectrum(q, q ** -(1 + 2 * hurst), (1e4, 1e7)))
    exact = (
        found.wavenumber ** -(2 + 2 * hurst)
        * gamma(hurst + 1)
        / (np.sqrt(np.pi) * gamma(hurst + 0.5))
    )
    np.testing.assert_allclose(found.density, exact, rtol=0.03)


def test_a_surface_made_from_a_spectrum_has_it():
    given = self_affine(256, 1 * UM, 1 * UM, 0.8, 256 * UM, 8 * UM, 2, 64 * UM)
    spectrum = isotropic_spectrum(given)
    made = surface_from_spectrum(spectrum, 512, 1 * UM, 9)
    assert made.rms_height == pytest.approx(1 * UM, rel=0.03)
    again = isotropic_spectrum(made)
    q = np.geomspace(3e4, 7e5, 30)
    np.testing.assert_allclose(
        np.interp(q, again.wavenumber, again.density),
        np.interp(q, spectrum.wavenumber, spectrum.density),
        rtol=0.15,
    )
    assert "nothing extrapolated" in made.processing[-1]
    np.testing.assert_array_equal(
        made.heights, surface_from_spectrum(spectrum, 512, 1 * UM, 9).heights
    )
    with pytest.raises(RangeError, match="grid"):
        surface_from_spectrum(spectrum, 16, 1e-9, 0)
    with pytest.raises(InputError, match="4 x 4"):
        surface_from_spectrum(spectrum, 2, 1 * UM, 0)
    narrow = spectrum.within(1e5, 4e5)
    assert mean_square(narrow) < mean_square(spectrum)
    with pytest.raises(InputError, match="wave number"):
        spectrum.within(1e9, 1e10)


def test_autocorrelation_of_a_wave_and_of_noise():
    lag, value = autocorrelation(sinusoidal(256, 1 * UM, 1 * UM, 64 * UM))
    np.testing.assert_allclose(value, np.cos(2 * np.pi * lag / (64 * UM)), atol=1e-12)
    expected = 64 * UM * np.arccos(np.exp(-1)) / (2 * np.pi)
    assert correlation_length(sinusoidal(256, 1 * UM, 1 * UM, 64 * UM)) == pytest.approx(
        expected, rel=2e-3
    )
    noise = Profile(np.random.default_rng(0).standard_normal(4000), 1 * UM)
    assert correlation_length(noise) < 1 * UM
    assert autocorrelation(noise)[1][0] == 1.0
    with pytest.raises(InputError, match="flat"):
        autocorrelation(Profile(np.zeros(10), 1 * UM, periodic=True))
    with pytest.raises(InputError, match="level"):
        correlation_length(noise, 2.0)


def test_patterns_and_their_refusals():
    board = checkerboard((64, 32), 1 * UM, 10 * UM, 16 * UM, form="triangular")
    assert board.heights.max() == pytest.approx(5 * UM)
    assert board.heights.min() == pytest.approx(-5 * UM)
    # A frictionless slope can't carry more than its steepest part: Rz / lambda * 2 here.
    steps = np.diff(board.heights, axis=0) / UM
    assert np.abs(steps).max() * UM / (1 * UM) == pytest.approx(2 * 10 / 16)
    for bad in (15 * UM, 3.3 * UM):
        with pytest.raises(InputError, match="whole number"):
            checkerboard(64, 1 * UM, 10 * UM, bad)
    with pytest.raises(InputError, match="two spacings"):
        sinusoidal(64, 1 * UM, 10 * UM, 1 * UM)
    with pytest.raises(InputError, match="form"):
        checkerboard(64, 1 * UM, 10 * UM, 16 * UM, form="square")


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"long_cutoff": 200 * UM}, "longest wavelength"),
        ({"short_cutoff": 1.5 * UM}, "two grid spacings"),
        ({"hurst": 1.2}, "Hurst"),
        ({"rms_height": -1.0}, "rms height"),
        ({"roll_off": 100 * UM}, "roll-off"),
        ({"spacing": 0.0}, "spacing"),
        ({"shape": 2}, "grid of"),
        ({"anisotropy": 0.0}, "anisotropy"),
    ],
)
def test_self_affine_refusals(change, says):
    given = {
        "shape": 64,
        "spacing": 1 * UM,
        "rms_height": 1 * UM,
        "hurst": 0.8,
        "long_cutoff": 64 * UM,
        "short_cutoff": 4 * UM,
        "seed": 1,
    }
    with pytest.raises(InputError, match=says):
        self_affine(**(given | change))


def test_bad_heights_are_refused():
    for heights in (np.array([0.0, np.nan, 1.0]), np.array([0.0, np.inf])):
        with pytest.raises(InputError, match="missing or infinite"):
            Profile(heights, UM)
    with pytest.raises(InputError, match=r"first at \(1, 2\)"):
        HeightMap(np.where(np.arange(9).reshape(3, 3) == 5, np.nan, 1.0), UM)
    with pytest.raises(InputError, match="shape"):
        HeightMap(np.ones(5), UM)
    with pytest.raises(InputError, match="shape"):
        Profile(np.ones((5, 2)), UM)
    with pytest.raises(InputError, match="spacing"):
        Profile(np.ones(5), -UM)
    with pytest.raises(InputError, match="section"):
        Profile(np.ones(5), UM).section(0.0, 1.0)
    with pytest.raises(DataError, match="positions"):
        profile_from_positions([0.0, np.nan, 2.0], [1.0, 2.0, 3.0])


def test_filling():
    z = np.add.outer(np.arange(20.0), 2 * np.arange(20.0))
    holed = z.copy()
    holed[5, 5] = holed[0, 0] = np.nan
    whole, note = fill_missing_heights(holed)
    assert whole[5, 5] == pytest.approx(z[5, 5])
    assert np.isfinite(whole).all()
    assert "2 of 400" in note
    assert fill_missing_heights(z)[1] == "no heights were missing"
    with pytest.raises(DataError, match="missing"):
        fill_missing_heights(np.where(z > 30, np.nan, z))


def test_periodised_maps_say_what_was_done():
    z = self_affine(128, 1 * UM, 1 * UM, 0.8, 128 * UM, 4 * UM, 3).heights[:100, :90]
    measured = HeightMap(z + 0.1 * np.arange(100)[:, None] * UM, 1 * UM)
    tapered, mirrored = make_periodic(measured), make_periodic(measured, "mirror")
    for made in (tapered, mirrored):
        assert made.periodic
        assert "made periodic" in made.processing[-1]
        assert "rms height" in made.processing[-1]
        # The jump over the edge is no larger than the steps within.
        inside = np.abs(np.diff(made.heights, axis=0)).max()
        assert np.abs(made.heights[0] - made.heights[-1]).max() <= inside
    assert mirrored.shape == (200, 180)
    assert mirrored.rms_height == pytest.approx(level_surface(measured).rms_height, rel=1e-12)
    assert tapered.rms_height < level_surface(measured).rms_height
    np.testing.assert_allclose(
        tapered.heights[20:80, 20:70], level_surface(measured).heights[20:80, 20:70], rtol=1e-12
    )
    assert make_periodic(tapered) is tapered
    with pytest.raises(InputError, match="method"):
        make_periodic(measured, "none")
    with pytest.raises(InputError, match="share"):
        make_periodic(measured, share=0.7)


def test_a_map_from_a_profile_has_the_slopes_of_the_profile():
    floor = self_affine(512, 1 * UM, 1 * UM, 0.8, 512 * UM, 4 * UM, 7, 128 * UM)
    spectrum = isotropic_from_profile(profile_spectrum(floor))
    made = surface_from_spectrum(spectrum, 512, 1 * UM, 11)
    assert made.rms_height == pytest.approx(floor.rms_height, rel=0.15)
    assert rms_slope(made) == pytest.approx(rms_slope(floor), rel=0.1)
    assert "isotropy assumed" in " ".join(made.processing)


def test_moments_of_an_isotropic_surface_are_mean_squares_of_its_derivatives():
    """m0 = <h^2>, m2 = <h_x^2>, m4 = <h_xx^2>: means over both axes by Fourier derivatives."""
    floor = self_affine(256, 4e-6, 4e-6, 0.8, 256e-6, 32e-6, 3)
    spectrum = np.fft.fft2(floor.heights - floor.heights.mean())
    q = 2 * np.pi * np.fft.fftfreq(256, 4e-6)
    moments = spectral_moments(isotropic_spectrum(floor))
    for order, moment in ((0, moments.m0), (1, moments.m2), (2, moments.m4)):
        along = np.fft.ifft2((1j * q[:, None]) ** order * spectrum).real
        across = np.fft.ifft2((1j * q[None, :]) ** order * spectrum).real
        assert moment == pytest.approx(np.mean([along**2, across**2]), rel=0.03)
