"""Rough contact on arrays of other libraries and devices: NumPy's numbers, cost and refusals."""

import importlib
import tracemalloc
from pathlib import Path
from typing import Any

import array_api_strict
import numpy as np
import pytest

from underfoot.core import Cache, InputError, MissingExtraError
from underfoot.core import device as devices
from underfoot.core.fourier import ArrayTransform, transform
from underfoot.core.mkl import mkl_library
from underfoot.core.threads import namespace
from underfoot.material import RelaxationSpectrum
from underfoot.rough_contact import (
    ContactTable,
    SlidingSettings,
    contact_table,
    contacts_of,
    flow_factors,
    sliding_input,
    steady,
    steady_sliding,
)
from underfoot.rough_contact._kernels import krylov, nested, operators
from underfoot.rough_contact._kernels.krylov import Restriction
from underfoot.studies.transient import transient_sliding
from underfoot.surface import HeightMap

MATERIAL = RelaxationSpectrum(1e6, [6e5, 6e5], [1e-3, 1e-4])
CASES = [(0.02, 0.1), (0.1, 1.0), (0.3, 0.0), (0.1, 0.01)]
GIVEN = {"spacing": 1e-5, "modulus": MATERIAL, "speed": 0.1, "pressure": 2e4}
ANOTHER_DEVICE = array_api_strict.Device("device1")


TRANSFORMS = ("scipy",) if mkl_library() is None else ("scipy", "mkl")


def waves(nodes: int = 32) -> np.ndarray:
    c = np.cos(2 * np.pi * np.arange(nodes) / nodes)
    return 1e-5 * c[:, None] * c[None, :]


def rough(nodes: int) -> np.ndarray:
    """Return random heights over waves of 4 to nodes / 8 to the side, with an rms slope of 0.3."""
    spectrum = np.fft.rfft2(np.random.default_rng(3).standard_normal((nodes, nodes)))
    q = np.hypot(np.fft.fftfreq(nodes, 1 / nodes)[:, None], np.arange(nodes // 2 + 1))
    spectrum *= np.where((q >= 4) & (q <= nodes / 8), q.clip(1) ** -1.8, 0.0)
    height = np.fft.irfft2(spectrum)
    return height * 0.3e-5 / np.std(np.diff(height, axis=0)) / 2**0.5


def on_device(height: np.ndarray, device: str) -> Any:
    """Return the heights as an array of another library where it and its device are there."""
    if device == "strict":
        return array_api_strict.asarray(height)
    if device == "strict device1":
        return array_api_strict.asarray(height, device=ANOTHER_DEVICE)
    library, _, place = device.partition(" ")
    module = pytest.importorskip(library, reason=f"{library}, an extra, is not installed")
    if place == "cuda" and not module.cuda.is_available():
        pytest.skip("no CUDA device on this machine")
    return module.asarray(height, **({"device": place} if library == "torch" else {}))


def on_host(array: Any) -> np.ndarray:
    if isinstance(array, array_api_strict._array_object.Array):
        array = array.to_device(array_api_strict.Device("CPU_DEVICE"))
    array = array.get() if hasattr(array, "get") else array
    return np.asarray(array.cpu() if hasattr(array, "cpu") else array)


DEVICES = ["strict", "strict device1", "torch cpu", "torch cuda", "cupy"]


@pytest.mark.parametrize("library", TRANSFORMS)
def test_a_field_that_is_not_to_be_written_to_has_its_transform(library):
    field = rough(64)
    field.flags.writeable = False
    there_and_back = transform((1, 64, 64), np.float64, library=library)
    spectrum = there_and_back.forward(np.broadcast_to(field, (1, 64, 64)))
    np.testing.assert_allclose(spectrum[0], np.fft.rfft2(field), atol=1e-18)
    spectrum.flags.writeable = library != "mkl"
    np.testing.assert_allclose(there_and_back.backward(spectrum)[0], field, atol=1e-18)


@pytest.mark.parametrize("device", DEVICES)
@pytest.mark.parametrize("pressure", [2e4, 2e5])  # partial contact and full
def test_any_array_library_and_device_gives_the_same_contact(device, pressure):
    other = on_device(waves(64), device)
    one = steady_sliding(waves(64), **{**GIVEN, "pressure": pressure})
    two = steady_sliding(other, **{**GIVEN, "pressure": pressure})
    assert isinstance(two.pressure, type(other))
    assert two.pressure.device == other.device
    assert two.cof_hysteresis == pytest.approx(one.cof_hysteresis, rel=1e-6)
    np.testing.assert_allclose(on_host(two.pressure), one.pressure, atol=1e-3 * pressure)


@pytest.fixture
def cost(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Return the function (heights, pressure, speed) -> (steps, products) of the benchmark.

    With the room for search directions that large grids have, three arrays, on small ones.
    """
    monkeypatch.syspath_prepend(Path(__file__).parents[2])
    benchmark = importlib.import_module("benchmarks.rough_contact")
    monkeypatch.setattr(nested, "_SMALL", 0.0)

    def counted(
        nodes: int, pressure: float, speed: float, device: str, fft: str = "scipy"
    ) -> tuple[int, float]:
        height = benchmark.self_affine(nodes)
        height = height if device == "numpy" else on_device(height, device)
        result = benchmark.ours(height, pressure, speed, fft)
        assert result.complementarity_error <= 1e-6
        return result.iterations, result.operator_applications

    return counted


def same_transform(monkeypatch: pytest.MonkeyPatch) -> None:
    """Give NumPy's arrays NumPy's transform: rounding of another decides the last step at times."""

    class Module:
        @staticmethod
        def rfftn(field, axes):
            return np.fft.rfftn(field, axes=axes).astype(np.result_type(field, np.complex64))

        @staticmethod
        def irfftn(spectrum, s, axes):
            field = np.fft.irfftn(spectrum, s=s, axes=axes)
            return field.astype(np.float32 if spectrum.dtype == np.complex64 else np.float64)

    monkeypatch.setattr(
        operators, "transform", lambda shape, *_, **__: ArrayTransform(shape, Module)
    )


SIZES = [256, pytest.param(512, marks=pytest.mark.slow), pytest.param(1024, marks=pytest.mark.slow)]


@pytest.mark.parametrize("nodes", SIZES)
@pytest.mark.parametrize(("pressure", "speed"), CASES)
def test_another_library_takes_the_same_steps_and_products(
    monkeypatch, cost, nodes, pressure, speed
):
    other = cost(nodes, pressure, speed, "strict")
    same_transform(monkeypatch)
    steps, products = cost(nodes, pressure, speed, "numpy")
    assert other[0] == steps
    assert other[1] == pytest.approx(products, rel=0.1)


@pytest.mark.parametrize("nodes", SIZES)
@pytest.mark.parametrize(("pressure", "speed"), CASES)
def test_torch_takes_the_steps_and_products_of_numpy(monkeypatch, cost, nodes, pressure, speed):
    # torch's transform rounds in its own way: NumPy's arrays with three transforms differ alike
    steps, products = cost(nodes, pressure, speed, "torch cpu")
    numpys = [cost(nodes, pressure, speed, "numpy", fft) for fft in TRANSFORMS]
    same_transform(monkeypatch)
    numpys.append(cost(nodes, pressure, speed, "numpy"))
    assert steps in [one for one, _ in numpys]
    least, most = (pick(one for _, one in numpys) for pick in (min, max))
    assert 0.9 * least <= products <= 1.1 * most


@pytest.mark.parametrize("device", DEVICES)
@pytest.mark.parametrize("shares", [(0.02,), (0.5,), (0.9,), (1.0,), (0.02, 0.5, 1.0)])
def test_vectors_on_the_contact_hold_its_nodes_alone_on_every_library(device, shares):
    generator = np.random.default_rng(2)
    least = 35 * 24 * np.array(shares)[:, None, None]
    inside = generator.permutation(35 * 24).reshape(1, 35, 24) < least
    field = generator.standard_normal(inside.shape).astype(np.float32)
    xp_mask, xp_field = on_device(inside, device), on_device(field, device)
    xp = namespace(xp_field)
    part = Restriction(xp_mask, xp)
    reference = Restriction(inside, np)
    assert part.size == reference.size
    assert part.nodes == inside.sum(axis=(1, 2)).tolist()
    vector = part.take(xp_field)
    np.testing.assert_array_equal(on_host(part.full_field(vector)), np.where(inside, field, 0))
    part.centre(vector)
    mean = field.mean(axis=(1, 2), where=inside, dtype=float)[:, None, None]
    np.testing.assert_allclose(
        on_host(part.full_field(vector)), np.where(inside, field - mean, 0), atol=1e-6
    )


@pytest.mark.parametrize("device", ["numpy", *DEVICES])
@pytest.mark.parametrize("shape", [(12, 9), (9, 12), (8, 4)])
def test_neighbours_are_those_of_the_periodic_grid(device, shape):
    generator = np.random.default_rng(4)
    inside = generator.random((1, *shape)) < 0.4
    field = np.where(inside, generator.standard_normal(inside.shape), 0.0).astype(np.float32)
    kernel = generator.standard_normal((3, 3)).astype(np.float32)
    there = [array if device == "numpy" else on_device(array, device) for array in (inside, field)]
    part = Restriction(there[0], namespace(there[1]))
    assert part.gathered
    whole = sum(
        kernel[a + 1, b + 1] * np.roll(field, (a, b), (1, 2))
        for a in (-1, 0, 1)
        for b in (-1, 0, 1)
    )
    convolved = part.full_field(part.near(kernel)(part.take(there[1])))
    np.testing.assert_allclose(on_host(convolved), np.where(inside, whole, 0.0), atol=1e-5)


def test_neighbours_hold_what_a_pressure_and_its_displacement_share():
    """S between neighbours: the answer of a whole product to a displacement of one node."""
    body = operators.ElasticBody(
        lambda qx: 1.0 + 0.3j * np.sign(qx), lambda q: 1.0 / q, (1e-5, 2e-5), 1.0
    )
    one = operators.Operators(body, (1, 16, 12))
    bump = np.zeros((1, 16, 12), np.float32)
    bump[0, 3, 5] = 1.0
    answer = one.pressure(bump)
    np.testing.assert_allclose(one.near(), answer[0, 2:5, 4:7], rtol=1e-4, atol=1e-2)


LOADS = [(p, v) for v in (0.01, 1.0) for p in (3e3, 2e4, 1e5, 3e6)]  # the last in full contact


# steps; with 10 some go by thinner mattresses
@pytest.mark.parametrize(
    ("most", "device"),
    [(60, "numpy"), (60, "strict device1"), *((10, device) for device in DEVICES)],
)
def test_contacts_side_by_side_are_those_of_numpy_alone(device, most):
    height = rough(64)
    there = height if device == "numpy" else on_device(height, device)
    settings = SlidingSettings(max_iterations=most, tolerance=1e-8)
    given = {"spacing": 1e-5, "modulus": MATERIAL, "settings": settings}
    batch = contacts_of(there, loads=LOADS, **given)
    alone = [steady_sliding(height, pressure=p, speed=v, **given) for p, v in LOADS]
    assert {contact.full_contact for contact in alone} == {True, False}
    by_mattresses = [contact.iterations > 20 for contact in alone]
    assert any(by_mattresses) == (most == 10)
    assert not all(by_mattresses)
    for one, two in zip(alone, batch, strict=True):
        assert (two.nominal_pressure, two.speed) == (one.nominal_pressure, one.speed)
        assert (two.status, two.full_contact) == (one.status, one.full_contact)
        assert two.notes == one.notes
        for name in ("cof_hysteresis", "real_contact_fraction", "mean_gap", "cof_slope"):
            assert getattr(two, name) == pytest.approx(getattr(one, name), rel=1e-6, abs=1e-20)
        np.testing.assert_allclose(
            on_host(two.pressure), one.pressure, atol=1e-5 * one.pressure.max()
        )


def test_contacts_side_by_side_share_their_transforms(monkeypatch):
    """A batch calls the device as often as its slowest contact, and a few times a contact more."""
    height, calls = on_device(rough(64), "strict"), []
    back = ArrayTransform.backward
    monkeypatch.setattr(
        ArrayTransform, "backward", lambda *given: (calls.append(0), back(*given))[1]
    )
    counts = []
    for loads in ([load] for load in LOADS):
        calls.clear()
        contacts_of(height, 1e-5, MATERIAL, loads)
        counts.append(len(calls))
    calls.clear()
    contacts_of(height, 1e-5, MATERIAL, LOADS)
    assert len(calls) < 1.5 * max(counts) < 0.3 * sum(counts)


def refused_input(call: Any) -> str | None:
    with pytest.raises(InputError) as refused:
        call()
    return refused.value.where


@pytest.mark.parametrize("device", DEVICES)
@pytest.mark.parametrize(
    "wrong", ["missing", "infinite", "thin", "low", "line", "cube", "complex", "bool"]
)
def test_heights_of_any_library_are_refused_like_numpy_s(device, wrong):
    height: Any = waves()
    height[3, 7] = {"missing": np.nan, "infinite": np.inf}.get(wrong, 0.0)
    height = {
        "thin": height[:, :1],
        "low": height[:1],
        "line": height[0],
        "cube": height[None],
    }.get(wrong, height)
    height = {"complex": height + 0j, "bool": height > 0.0}.get(wrong, height)
    other = on_device(np.ascontiguousarray(height), device)
    texts = []
    for given in (height, other):
        with pytest.raises(InputError) as refused:
            steady_sliding(given, **GIVEN)
        texts.append(
            str(refused.value).partition("(")[0] if wrong == "complex" else str(refused.value)
        )
    assert texts[0] == texts[1]


@pytest.mark.parametrize("device", DEVICES)
@pytest.mark.parametrize("name", ["spacing", "speed", "pressure", "poisson_ratio", "modulus"])
def test_an_array_of_another_device_in_place_of_a_number_is_refused(device, name):
    two = on_device(np.array([0.1, 0.2]), device)
    assert refused_input(lambda: steady_sliding(waves(), **{**GIVEN, name: two})) == name


@pytest.mark.parametrize("device", ["numpy", *DEVICES])
def test_loads_side_by_side_are_refused_like_one(device):
    height: Any = waves() if device == "numpy" else on_device(waves(), device)
    there = np.array([0.1, 0.2]) if device == "numpy" else on_device(np.array([0.1, 0.2]), device)
    wrong: dict[str, list[Any]] = {"pressure": [0.0, np.nan, there], "speed": [np.inf, there]}
    for name, values in wrong.items():
        for value in values:
            one = {"pressure": 2e4, "speed": 0.1, name: value}
            loads = [(2e4, 0.1), (one["pressure"], one["speed"])]
            with pytest.raises(InputError) as alone:
                steady_sliding(height, **{**GIVEN, **one})
            with pytest.raises(InputError) as batch:
                contacts_of(height, 1e-5, MATERIAL, loads)
            assert alone.value.where == batch.value.where == name
            assert str(alone.value) == str(batch.value)
    assert contacts_of(height, 1e-5, MATERIAL, []) == []


def test_a_batch_is_as_large_as_the_memory_and_refused_beyond(monkeypatch):
    points = 32 * 32
    free = 8 * sliding_input.BATCH_ARRAYS * points * 3
    assert sliding_input.batch_size(points, free) == 3
    assert sliding_input.batch_size(points, None) == sliding_input._BATCH // points
    assert sliding_input.batch_size(8192**2, 0) == 1  # refused by the contact itself
    monkeypatch.setattr(sliding_input, "free_memory", lambda _: free)
    loads = [(p, 0.1) for p in (1e4, 2e4, 3e4, 4e4)]
    assert len(contacts_of(waves(), 1e-5, MATERIAL, loads[:3])) == 3
    assert refused_input(lambda: contacts_of(waves(), 1e-5, MATERIAL, loads)) == "height"


def test_what_lies_on_another_device_is_refused_where_numpy_computes():
    there = on_device(waves(), "strict device1")
    calls = {
        "gap": lambda: flow_factors(there),
        "heights": lambda: HeightMap(there, 1e-5),
        "floor_height": lambda: transient_sliding(there, 1e-5, MATERIAL, 0.1, pressure=1e4),
        "shoe_height": lambda: transient_sliding(
            waves(), 1e-5, MATERIAL, 0.1, pressure=1e4, shoe_height=there
        ),
        "modulus": lambda: steady_sliding(
            waves(),
            **{**GIVEN, "modulus": lambda w: on_device(1e6 + 0.0 * w, "strict device1")},
        ),
    }
    assert {name: refused_input(call) for name, call in calls.items()} == {
        name: name for name in calls
    }


@pytest.mark.parametrize("device", DEVICES)
@pytest.mark.parametrize("shape", [(31, 29), (45, 8), (9, 64)])
def test_single_precision_and_odd_sizes_solve_like_numpy_s(device, shape):
    x, y = (np.arange(n) / n for n in shape)
    height = 1e-6 * np.cos(2 * np.pi * x)[:, None] * np.cos(2 * np.pi * y)[None, :]
    height = height.astype(np.float32)
    one = steady_sliding(height, **GIVEN)
    two = steady_sliding(on_device(height, device), **GIVEN)
    assert two.cof_hysteresis == pytest.approx(one.cof_hysteresis, rel=1e-5)
    assert two.status is one.status


@pytest.mark.slow
def test_heights_that_ask_for_a_gradient_or_hold_nothing_are_refused():
    torch = pytest.importorskip("torch", reason="torch, an extra, is not installed")
    asked = torch.asarray(waves()).requires_grad_()
    for height in (asked, asked.detach().to_sparse(), asked.detach().to("meta")):
        assert refused_input(lambda height=height: steady_sliding(height, **GIVEN)) == "height"


def test_what_has_the_size_of_the_grid_is_made_where_the_heights_lie(monkeypatch):
    height = on_device(waves(64), "strict device1")
    crossed = {"brought": [], "read": 0}
    bring, wait = array_api_strict.asarray, krylov.on_host

    def brought(array, **options):
        crossed["brought"].append(np.size(array) if isinstance(array, np.ndarray) else 0)
        return bring(array, **options)

    def read(array):
        crossed["read"] += 1
        return wait(array)

    monkeypatch.setattr(array_api_strict, "asarray", brought)
    monkeypatch.setattr(krylov, "on_host", read)
    contact = steady_sliding(height, **GIVEN)
    assert 0 < max(crossed["brought"]) <= 64  # rows and columns, never the grid
    # one wait for two products of the inner solve, at most
    assert 0 < crossed["read"] <= contact.operator_applications / 2


def test_a_contact_that_does_not_fit_is_refused_before_it_starts(monkeypatch):
    monkeypatch.setattr(
        sliding_input, "free_memory", lambda _: 8 * sliding_input.ARRAYS * 32 * 32 - 1
    )
    assert refused_input(lambda: steady_sliding(waves(), **GIVEN)) == "height"
    monkeypatch.setattr(sliding_input, "free_memory", lambda _: 8 * sliding_input.ARRAYS * 32 * 32)
    assert steady_sliding(waves(), **GIVEN).status.usable


def test_a_batch_takes_the_memory_that_its_size_counts_on():
    height = rough(128)
    loads = [(p, 0.1) for p in (3e3, 2e4, 1e5, 3e6)]
    tracemalloc.start()
    contacts_of(height, 1e-5, MATERIAL, loads)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    whole = len(loads) * height.nbytes
    assert 0.5 * sliding_input.BATCH_ARRAYS * whole < peak < sliding_input.BATCH_ARRAYS * whole


@pytest.mark.slow
@pytest.mark.parametrize("library", ["scipy", "auto"])
@pytest.mark.parametrize(
    ("pressure", "speed", "steps"),
    [
        *((*case, 60) for case in [*CASES, (1.0, 0.0), (3.0, 1.0)]),
        *(pytest.param(p, 1.0, 3, id=f"{p} by thinner mattresses") for p in (0.1, 1.0)),
    ],
)
def test_a_contact_takes_ten_arrays_of_its_grid_at_most(
    monkeypatch, library, pressure, speed, steps
):
    monkeypatch.syspath_prepend(Path(__file__).parents[2])
    monkeypatch.setattr(nested, "_SMALL", 0.0)  # the room that large grids have
    benchmark = importlib.import_module("benchmarks.rough_contact")
    height = benchmark.self_affine(512)
    tracemalloc.start()
    result = benchmark.ours(height, pressure, speed, library, max_iterations=steps)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert sliding_input.ARRAYS == 10
    assert peak < sliding_input.ARRAYS * height.nbytes
    assert (result.iterations > steps) == (steps == 3)  # the first way takes no more than those


def test_a_device_that_is_not_there_is_refused(monkeypatch):
    floor = HeightMap(waves(), 1e-5, periodic=True)
    given = ([floor], MATERIAL, [1e4, 2e4, 3e4, 4e4], [0.1])
    monkeypatch.setattr(devices, "card", lambda: None)
    monkeypatch.setattr(devices, "find_spec", lambda _: object())
    for named in ("cuda", "gpu", None, 0):
        call = lambda named=named: ContactTable.from_surfaces(*given, device=named)  # noqa: E731
        assert refused_input(call) == "device"
    monkeypatch.setattr(devices, "find_spec", lambda _: None)
    with pytest.raises(MissingExtraError):
        ContactTable.from_surfaces(*given, device="cuda")
    assert not devices.on_card("auto", 2048**2)


@pytest.mark.parametrize("batch", [sliding_input._BATCH, 3 * 32 * 32])  # all at once, by threes
@pytest.mark.parametrize("rough_shoe", [False, True])
def test_a_table_on_the_card_names_it_and_is_kept_apart(monkeypatch, tmp_path, batch, rough_shoe):
    """Another device of array_api_strict in the place of the card."""
    floor, cache = HeightMap(waves(), 1e-5, periodic=True), Cache("card", tmp_path)
    given = ([floor], MATERIAL, [1e4, 2e4, 3e4, 4e4], [0.1, 0.2])
    shoes = [HeightMap(0.5 * rough(32), 1e-5, periodic=True)] if rough_shoe else None
    one = ContactTable.from_surfaces(*given, shoe_surfaces=shoes, cache=cache, device="auto")
    sizes = []
    of_batch = steady.contacts_of

    def counted(height, spacing, modulus, loads, *rest, **options):
        sizes.append(len(loads))
        return of_batch(height, spacing, modulus, loads, *rest, **options)

    monkeypatch.setattr(steady, "contacts_of", counted)
    monkeypatch.setattr(sliding_input, "_BATCH", batch)
    monkeypatch.setattr(devices, "card", lambda: "a card")
    monkeypatch.setattr(contact_table, "card", lambda: "a card")
    monkeypatch.setattr(steady, "to_card", lambda h: on_device(h, "strict device1"))
    two = ContactTable.from_surfaces(*given, shoe_surfaces=shoes, cache=cache, device="cuda")
    assert sum(sizes) == (16 if rough_shoe else 8)  # the floor alone too, for its hysteresis
    # pressures and speeds of the floor together, those of a composite at each speed
    assert max(sizes) == min(8, batch // 32**2)
    assert any("8 contacts on a card" in note for note in two.notes)
    assert not any("card" in note for note in one.notes)
    assert one.key != two.key
    for name, values in two.values.items():
        np.testing.assert_allclose(values, one.values[name], rtol=1e-6)
