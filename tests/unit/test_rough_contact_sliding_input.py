"""What the sliding solvers refuse, mark and accept."""

import importlib
import tracemalloc
from pathlib import Path

import numpy as np
import pytest

from underfoot.core import Cancelled, InputError, Status
from underfoot.core.fourier import ArrayTransform, transform
from underfoot.core.mkl import MklTransform, mkl_library
from underfoot.material import RelaxationSpectrum
from underfoot.rough_contact import SlidingSettings, steady_sliding
from underfoot.rough_contact._kernels.nested import low_pass, repeat_cells
from underfoot.rough_contact._kernels.periodic import boundary_length, contact_fractions
from underfoot.rough_contact.sliding_input import slow_transform
from underfoot.studies.transient import TransientSettings, transient_sliding

MATERIAL = RelaxationSpectrum(1e6, [6e5, 6e5], [1e-3, 1e-4])


def waves(nodes: int = 32, amplitude: float = 1e-5) -> np.ndarray:
    c = np.cos(2 * np.pi * np.arange(nodes) / nodes)
    return amplitude * c[:, None] * c[None, :]


GOOD = {
    "height": waves(),
    "spacing": 1e-5,
    "modulus": MATERIAL,
    "speed": 0.1,
    "pressure": 2e4,
    "poisson_ratio": 0.5,
}


def holed() -> np.ndarray:
    height = waves()
    height[3, 7] = np.nan
    return height


def a_little_back_at_high_rates(w):
    return np.where(np.abs(w) > 1e5, 1e9 - 1e6j, 1e6 - 1e5j)


def negative_term(w):
    return 1e6 - 5e5j * w * 1e-3 / (1 + 1j * w * 1e-3)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (
            {"height": holed()},
            r"1 of 1024 heights are missing.*\(3, 7\).*surface.fill_missing_heights",
        ),
        ({"height": np.empty((0, 0))}, "at least 8 x 4"),
        ({"height": np.zeros((3, 3))}, "at least 8 x 4"),
        ({"height": waves()[:, 0]}, "1 dimension.*np.repeat"),
        ({"height": np.zeros((4, 8, 8))}, "3 dimension"),
        ({"height": "rough"}, "an array of heights"),
        ({"height": waves() + 0j}, "complex"),
        ({"spacing": 0.0}, "above 0 m"),
        ({"spacing": (1e-5, 1e-5, 1e-5)}, "one length or two"),
        ({"pressure": 0.0}, "above 0 Pa"),
        ({"pressure": -1.0}, "above 0 Pa"),
        ({"pressure": float("nan")}, "above 0 Pa"),
        ({"speed": float("nan")}, "finite speed"),
        ({"poisson_ratio": 0.6}, "0 to 0.5"),
        ({"modulus": -1e6}, "above 0 Pa"),
        ({"modulus": "soft"}, "complex_modulus"),
        ({"modulus": lambda w: -1.0 + 0j * w}, "positive real part"),
        ({"modulus": lambda w: 1e6 * 1j * w}, "liquid"),
        ({"modulus": lambda w: 1e6 - 1e5j * np.sign(w)}, "conjugate"),
        ({"modulus": negative_term}, "energy back"),
        ({"modulus": a_little_back_at_high_rates}, r"E\* = 1e\+06-1e\+05j Pa.*energy back"),
        ({"layer_thickness": 0.0}, "above 0 m"),
    ],
)
def test_refused(change, words):
    with pytest.raises(InputError, match=f"(?s){words}"):
        steady_sliding(**{**GOOD, **change})


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({}, "one of them"),
        ({"pressure": 1e4, "separation": 1e-6}, "one of them"),
        ({"pressure": 1e4, "modulus": 1e6}, "steady_sliding takes any"),
        ({"pressure": 1e4, "modulus": RelaxationSpectrum(0.0, [1e6], [1.0])}, "liquid"),
        ({"pressure": 1e4, "speed": 0.0}, "above 0 m/s"),
        ({"pressure": 1e4, "shoe_height": waves(16)}, "same shape"),
        ({"pressure": 1e4, "floor_height": np.zeros((8, 8))}, "flat"),
    ],
)
def test_march_refuses(change, words):
    arguments = {"floor_height": waves(), "spacing": 1e-5, "modulus": MATERIAL, "speed": 0.1}
    with pytest.raises(InputError, match=words):
        transient_sliding(**{**arguments, **change})


@pytest.mark.parametrize(
    ("change", "words"), [({"start": "cold"}, "relaxed"), ({"max_periods": 0}, "1 or more")]
)
def test_march_settings_refuse(change, words):
    with pytest.raises(InputError, match=words):
        TransientSettings(**change)


def test_flat_surface_is_full_contact():
    result = steady_sliding(**{**GOOD, "height": np.full((8, 8), 3.0)})
    assert result.full_contact
    assert result.cof_hysteresis == 0.0
    assert "flat" in result.notes[0]
    np.testing.assert_array_equal(result.pressure, 2e4)


def test_steep_or_unresolved_surfaces_are_marked():
    steep = steady_sliding(**{**GOOD, "height": waves(amplitude=1e-4)})
    assert steep.status is Status.OUT_OF_RANGE
    assert "rms slope" in str(steep.breaches[0])
    noise = np.random.default_rng(0).standard_normal((32, 32))
    coarse = steady_sliding(**{**GOOD, "height": 1e-8 * noise})
    assert coarse.status is Status.OUT_OF_RANGE
    assert "4 grid spacings" in str(coarse.breaches[0])
    assert steady_sliding(**GOOD).status is Status.CONVERGED


def test_too_few_iterations_are_not_a_result():
    height = np.cumsum(np.random.default_rng(1).standard_normal((32, 32)), axis=0) * 1e-7
    hasty = SlidingSettings(max_iterations=1, tolerance=1e-9)
    result = steady_sliding(**{**GOOD, "height": height, "settings": hasty})
    assert result.status is Status.NOT_CONVERGED
    assert any("not a result" in note for note in result.notes)
    assert result.pressure.mean() == pytest.approx(2e4)


def test_progress_reports_and_cancels():
    seen = []

    def watch(stage, fraction, residual=None):
        seen.append((stage, fraction, residual))
        if len(seen) == 2:
            raise Cancelled("enough")

    with pytest.raises(Cancelled):
        steady_sliding(**GOOD, progress=watch)
    assert seen[0][0] == "rough contact"
    assert 0.0 <= seen[0][1] <= seen[1][1] <= 1.0


def test_single_maxwell_term_over_a_thousandfold_rise():
    # the hardest material: one relaxation time, glass a thousand times stiffer than rubber
    generator = np.random.default_rng(4)
    q = np.hypot(np.fft.fftfreq(64, 1 / 64)[:, None], np.fft.rfftfreq(64, 1 / 64)[None, :])
    spectrum = np.fft.rfft2(generator.standard_normal((64, 64)))
    height = np.fft.irfft2(spectrum * np.where((q >= 2) & (q <= 8), q + 1e-9, np.inf) ** -1.8)
    height *= 1e-6 / height.std()
    material = RelaxationSpectrum(1e6, [999e6], [1e-3])
    for speed in (1e-4, 1e-3, 1e-2, 1e-1, 1.0):
        result = steady_sliding(height, 1e-5, material, speed, 3e4)
        assert result.status.usable
        assert result.complementarity_error <= 1e-6


@pytest.mark.parametrize(
    ("shape", "better"),
    [
        ((131, 128), (144, 128)),  # a prime
        ((130, 130), (144, 144)),  # 2 x 5 x 13
        ((4096, 17), (4096, 32)),  # the side across alone
        ((8193, 8191), (8400, 8192)),
        ((8190, 8192), (8192, 8192)),
        ((8192, 8000), None),
        ((135, 125), None),  # odd, yet quick
        ((1001, 16), None),  # too small a grid to matter
    ],
)
def test_sizes_whose_transform_is_slow_are_named_with_the_next_good_one(shape, better):
    slow = slow_transform(shape)
    assert (slow and slow.better) == better
    if slow is not None:
        assert slow.shape == shape
        assert slow_transform(slow.better) is None


def test_the_result_says_that_its_size_is_slow():
    quick, slow = (
        steady_sliding(**{**GOOD, "height": waves(nodes), "spacing": 3.2e-4 / nodes})
        for nodes in (128, 129)
    )
    assert quick.slow_transform is None
    assert slow.slow_transform == slow_transform((129, 129))
    assert str(slow.slow_transform) in slow.notes
    assert "144 x 144" in str(slow.slow_transform)
    assert slow.status is quick.status


@pytest.mark.slow
def test_memory_is_that_of_sixteen_fields(monkeypatch):
    """Of arrays: pages that a transform library or the system keeps beside them are not ours."""
    monkeypatch.syspath_prepend(Path(__file__).parents[2])
    benchmark = importlib.import_module("benchmarks.rough_contact")
    height = benchmark.self_affine(1024)
    for pressure, speed in ((0.3, 0.0), (1.0, 1.0)):
        tracemalloc.start()
        benchmark.ours(height, pressure, speed, "auto")
        _, peak = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        assert peak < 16.0 * height.nbytes


def test_libraries_and_threads_give_the_same_contact():
    one = steady_sliding(**GOOD)
    for options in ({"fft": "scipy"}, {"fft": "scipy", "threads": 2}, {"threads": 2}):
        other = steady_sliding(**GOOD, settings=SlidingSettings(**options))
        assert other.cof_hysteresis == pytest.approx(one.cof_hysteresis, rel=1e-5)


@pytest.mark.skipif(
    mkl_library() is None, reason="MKL, an extra, has no wheel for this machine or is left out"
)
@pytest.mark.parametrize("shape", [(8, 8), (33, 20), (16, 27), (5, 7), (3, 20, 27)])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_both_fourier_libraries_agree(shape, dtype):
    field = np.random.default_rng(0).standard_normal(shape).astype(dtype)
    mkl, scipy = MklTransform(shape, dtype), transform(shape, dtype, library="scipy")
    tolerance = 1e-4 if dtype is np.float32 else 1e-12
    spectrum = mkl.forward(field)
    np.testing.assert_allclose(spectrum, scipy.forward(field), atol=tolerance)
    np.testing.assert_allclose(mkl.backward(spectrum), field, atol=tolerance)
    # a spectrum and a field that are not the transform's own buffers, or not contiguous
    np.testing.assert_allclose(mkl.backward(1.0 * scipy.forward(field)), field, atol=tolerance)
    np.testing.assert_allclose(
        mkl.forward(np.asfortranarray(field)), scipy.forward(field), atol=tolerance
    )


def test_unknown_library_falls_back_to_scipy():
    assert isinstance(transform((8, 8), np.float64, library="scipy"), ArrayTransform)


def test_low_pass_keeps_long_waves():
    x = np.arange(64) / 64
    field = np.cos(2 * np.pi * 3 * x)[:, None] * np.sin(2 * np.pi * 5 * x)[None, :]
    noise = np.cos(2 * np.pi * 20 * x)[:, None] + 0.0 * x
    coarse = low_pass(np.fft.rfft2(field + noise), (64, 64), (2, 4), np)
    np.testing.assert_allclose(coarse, field[::2, ::4], atol=1e-12)
    assert repeat_cells(coarse, (2, 4), np).shape == (64, 64)


def test_area_correction_is_the_published_share_of_the_boundary():
    # Yastrebov et al. (2017): A' = A - (pi - 1 + ln 2)/24 S dx
    contact = np.zeros((16, 16), dtype=bool)
    contact[3:9, 4:7] = True
    assert boundary_length(contact, (2.0, 2.0), np) == pytest.approx(2 * (6 + 3) * 2.0)
    plain, corrected = contact_fractions(contact, (2.0, 2.0), np)
    assert plain == 18 / 256
    assert corrected == pytest.approx((18 - (np.pi - 1 + np.log(2)) / 24 * 18) / 256)


@pytest.mark.parametrize(
    ("changed", "text"),
    [
        ({"speed": [0.1, 0.2]}, "Call it once for each"),
        ({"pressure": np.array([1e5, 2e5])}, "Call it once for each"),
        ({"speed": "0.1 m/s"}, "is a str"),
        ({"poisson_ratio": None}, "is a NoneType"),
    ],
)
def test_lists_and_words_in_place_of_a_number_are_refused(changed, text):
    given = {"spacing": 1e-6, "modulus": 2e6, "speed": 0.1, "pressure": 1e5} | changed
    height = np.random.default_rng(0).normal(0.0, 1e-7, (16, 16))
    with pytest.raises(InputError, match=next(iter(changed))) as refused:
        steady_sliding(height, **given)
    assert text in str(refused.value)


def test_a_contact_of_a_few_nodes_is_marked():
    from underfoot.surface import self_affine

    floor = self_affine(64, 5e-6, 5e-6, 0.8, 1.6e-4, 4e-5, seed=1)
    light = steady_sliding(floor.heights, floor.spacing, 5e6, 0.0, 1.0)
    assert light.status is Status.OUT_OF_RANGE
    assert [one.quantity for one in light.breaches] == ["nodes in contact"]
    heavy = steady_sliding(floor.heights, floor.spacing, 5e6, 0.0, 1e5)
    assert heavy.status is Status.CONVERGED
