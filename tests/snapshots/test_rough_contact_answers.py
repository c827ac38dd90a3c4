"""Rough contacts: solved ones, theories, laws, tables, flow factors, kernels, refusals."""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from snapshot import held, refusal
from underfoot.core import Cache
from underfoot.rough_contact._kernels import periodic
from underfoot.rough_contact._kernels.monotone import interpolated_grid, pchip_slopes
from underfoot.rough_contact._kernels.nested import _coarsenings, low_pass, repeat_cells
from underfoot.rough_contact.composite import composite_surface
from underfoot.rough_contact.contact_table import ContactTable, leave_out_errors
from underfoot.rough_contact.cutoff import cutoff_dependence
from underfoot.rough_contact.flow_factor import flow_factors
from underfoot.rough_contact.greenwood_williamson_1966 import (
    greenwood_williamson,
    greenwood_williamson_law,
)
from underfoot.rough_contact.persson import (
    cumulative,
    persson,
    persson_growth,
    yang_persson_mean_gap,
)
from underfoot.rough_contact.pressure_gap_law import ExponentialLaw, TabulatedLaw, persson_law
from underfoot.rough_contact.scales import table_over_scales
from underfoot.rough_contact.sliding_input import (
    batch_size,
    checked_contact_input,
    loss_reason,
    modulus_function,
    resolution_breaches,
    slow_transform,
)
from underfoot.rough_contact.steady import (
    SlidingSettings,
    SteadySliding,
    contacts_of,
    steady_sliding,
)
from underfoot.rough_contact.theory import TheoryContact, checked_spectrum
from underfoot.surface import HeightMap, SpectralMoments

SPACING = 2e-6


def heights(shape: tuple[int, int] = (32, 32), seed: int = 1) -> np.ndarray:
    """Return heights of long and of short waves, m."""
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(*(2 * np.pi * np.arange(n) / n for n in shape), indexing="ij")
    made = np.zeros(shape)
    for k in range(1, 5):
        for j in range(5):
            phase = rng.uniform(0, 2 * np.pi)
            made += np.cos(k * x + j * y + phase) / (k * k + j * j) ** 0.9
    return 1e-6 * made / made.std()


def soft(w: np.ndarray) -> np.ndarray:
    """Return E* (Pa) of a rubber that loses energy."""
    x = 1j * np.asarray(w) * 1e-4
    return 2e6 + 6e6 * x / (1 + x)


def told(contact: SteadySliding) -> dict[str, Any]:
    """Return a contact without the steps that led to it."""
    left = {"operator_applications", "history", "iterations", "complementarity_error"}
    names = contact.__dataclass_fields__.keys() - left
    return {name: getattr(contact, name) for name in sorted(names)} | {
        "short": repr(contact),
        "heads": (contact.table().title, contact.table().columns),
        "rows": [row[0] for row in contact.table().rows],
    }


SMOOTH = SlidingSettings(tolerance=1e-9)
CONTACTS: dict[str, Callable[[], SteadySliding]] = {
    "slides": lambda: steady_sliding(heights(), SPACING, soft, 0.3, 3e5, settings=SMOOTH),
    "back": lambda: steady_sliding(heights(), SPACING, soft, -0.3, 3e5, settings=SMOOTH),
    "rests": lambda: steady_sliding(heights(), SPACING, soft, 0.0, 3e5, settings=SMOOTH),
    "elastic": lambda: steady_sliding(heights(), SPACING, 4e6, 0.3, 3e5, 0.4, settings=SMOOTH),
    "layer": lambda: steady_sliding(heights(), SPACING, soft, 0.3, 3e5, layer_thickness=2e-5,
                                    settings=SMOOTH),
    "oblong": lambda: steady_sliding(heights((32, 20)), (2e-6, 3e-6), soft, 0.1, 3e5,
                                     settings=SMOOTH),
    "odd": lambda: steady_sliding(heights((27, 15)), SPACING, soft, 0.1, 3e5, settings=SMOOTH),
    "light": lambda: steady_sliding(heights(), SPACING, soft, 0.3, 3e3, settings=SMOOTH),
    "full": lambda: steady_sliding(heights(), SPACING, soft, 0.3, 3e7),
    "flat": lambda: steady_sliding(np.zeros((8, 8)), SPACING, soft, 0.3, 3e5),
    "steep": lambda: steady_sliding(20 * heights(), SPACING, soft, 0.3, 3e6),
    "gives up": lambda: steady_sliding(heights(), SPACING, soft, 0.3, 3e5,
                                       settings=SlidingSettings(1e-12, 1)),
}  # fmt: skip


COSTS = {
    "slides": (11, 79), "back": (12, 80), "rests": (8, 40), "elastic": (9, 44), "layer": (10, 64),
    "oblong": (12, 89), "odd": (11, 71), "light": (12, 69), "full": (1, 2), "flat": (0, 0),
    "steep": (8, 55),
}  # fmt: skip
"""Steps and products of each: a worse correction finds the same by more."""


@pytest.mark.parametrize("name", CONTACTS)
def test_contacts(file_regression, name):
    made = CONTACTS[name]()
    if name == "gives up":
        held(file_regression, (made.status, [note[:40] for note in made.notes]), "contact gives up")
        return
    held(file_regression, told(made), f"contact {name}")
    assert np.mean(made.pressure) == pytest.approx(made.nominal_pressure)
    steps, products = COSTS[name]
    assert made.iterations == pytest.approx(steps, abs=1 if steps > 1 else 0)
    assert made.operator_applications == pytest.approx(products, abs=5 if products > 2 else 0)


def test_a_batch_is_each_alone_and_the_mirror_image_slides_back():
    loads = [(3e5, 0.3), (1e5, -0.1), (3e7, 0.3)]
    batch = contacts_of(heights(), SPACING, soft, loads, settings=SMOOTH)
    for (pressure, speed), one in zip(loads, batch, strict=True):
        alone = steady_sliding(heights(), SPACING, soft, speed, pressure, settings=SMOOTH)
        np.testing.assert_allclose(one.pressure, alone.pressure, atol=1e-5 * pressure)
        assert one.cof_hysteresis == pytest.approx(alone.cof_hysteresis, rel=1e-5)
    turned = steady_sliding(heights()[::-1], SPACING, soft, -0.3, 3e5, settings=SMOOTH)
    assert turned.cof_hysteresis == pytest.approx(-batch[0].cof_hysteresis, rel=1e-5)
    np.testing.assert_allclose(turned.pressure[::-1], batch[0].pressure, atol=3.0)
    assert contacts_of(heights(), SPACING, soft, []) == []


def texture(seed: int = 1, **more: Any) -> HeightMap:
    return HeightMap(heights((16, 16), seed), SPACING, periodic=True, **more)


NODES = np.array([3e4, 1e5, 3e5, 1e6, 3e6])


@pytest.fixture(scope="module")
def table(tmp_path_factory):
    store = Cache("a", tmp_path_factory.mktemp("tables"))
    return ContactTable.from_surfaces(
        [texture(), texture(2, resolution=9e-6)], soft, NODES, [0.1, 0.5], cache=store,
        description="made", shoe_surfaces=[texture(3), texture(4)],
    )  # fmt: skip


def test_tables(file_regression, table, tmp_path):
    at = [(5e4, 0.2), (1e5, 0.1), (2.9e6, 0.5)]
    said: dict[str, Any] = {
        "it": (table.values, table.deviation, table.realizations, table.notes, table.out_of_range),
        "between": [
            [float(one(p, v)) for one in (table.real_contact_fraction, table.cof_hysteresis,
                                          table.mean_gap, table.flow_factor)]
            for p, v in at
        ],
        "ways": [float(table.flow_factor(2e5, 0.2, way)) for way in ("along", "across", "mean")],
        "beyond": [
            [float(one(p, v, "extend")) for one in (table.real_contact_fraction,
                                                    table.cof_hysteresis, table.mean_gap)]
            + [float(table.flow_factor(p, v, outside="extend"))]
            for p, v in ((1e3, 0.2), (1e8, 0.9), (2e5, 0.01), (0.0, 0.2), (2e5, -0.2))
        ],
        "sourced": [table.sourced_value(name, 2e5, 0.2) for name in table.values],
        "table": table.table(), "shown": (table.heading(), table.headline(), table.tables()),
        "remarks": table.remarks(), "short": repr(table), "ranges": table.ranges,
        "breaches": [table.breaches(pressure=p, speed=v)
                     for p, v in ((1e5, 0.2), (1e4, -0.2), (1e5, 0.6))],
        "errors": leave_out_errors(table),
        "scaled": table.scale_contact(2.0, 3.0, 0.5).values,
        "scaled nodes": (table.scale_contact(2.0, 3.0, 0.5).pressure,
                         table.scale_contact(2.0, 3.0, 0.5).speed),
        "refused": [
            refusal(table.real_contact_fraction, 1e4, 0.2), refusal(table.mean_gap, 1e5, 0.9),
            refusal(table.sourced_value, "gap", 1e5, 0.2),
            refusal(leave_out_errors, table, "speed"),
            refusal(table.cof_hysteresis, -1e5, 0.2), refusal(table.flow_factor, np.nan, 0.2),
        ],
    }  # fmt: skip
    for way in ("mean", "along"):
        law = table.law(0.2, way)
        gaps = np.linspace(-1e-7, 1.2 * law.gap[-1], 9)
        said[f"law {way}"] = (law.gap, law.node_pressure, law.node_flow_factor, law.ranges,
                              law.pressure(gaps), law.stiffness(gaps), law.flow_factor(gaps),
                              law.flow_factor_slope(gaps), law.speed, law.source)  # fmt: skip
    table.save(tmp_path / "a.npz")
    again = ContactTable.load(tmp_path / "a.npz")
    for name, values in table.values.items():
        np.testing.assert_array_equal(again.values[name], values)
    assert again.notes == tuple(map(str, table.notes))
    (tmp_path / "b.npz").write_bytes(b"nothing")
    why = refusal(ContactTable.load, tmp_path / "b.npz")
    said["damaged"] = why.replace(str(tmp_path), "FOLDER")
    held(file_regression, said)


def test_one_surface_and_ranges_of_waves(file_regression, tmp_path):
    store = Cache("a", tmp_path)
    told_of: list[Any] = []
    one = ContactTable.from_surfaces(
        [texture()], 4e6, NODES[:4], 0.3, cache=store, poisson_ratio=0.4,
        progress=lambda stage, share, _=None: told_of.append((stage, share)),
    )  # fmt: skip
    again = ContactTable.from_surfaces([texture()], 4e6, NODES[:4], 0.3, cache=store,
                                       poisson_ratio=0.4)  # fmt: skip
    np.testing.assert_array_equal(again.values["mean_gap"], one.values["mean_gap"])
    finer = ContactTable.from_surfaces([texture(5)], soft, [1e4, 1e6, 1e7, 3e7], 0.3, cache=store)
    within = ContactTable.from_surfaces([texture()], soft, NODES[:4], 0.3, cache=store,
                                        finer=finer)  # fmt: skip
    said = {
        "one": (one.values, one.deviation, one.notes, one.key and len(one.key)),
        "sourced": one.sourced_value("mean_gap", 1e5, 0.3), "headline": one.headline(),
        "within": (within.values, within.notes), "told": told_of,
        "refused": [
            refusal(ContactTable.from_surfaces, *args, cache=store, **more)
            for args, more in (
                (([], soft, NODES, 0.3), {}), (([texture()], soft, NODES[:3], 0.3), {}),
                (([texture()], soft, NODES[::-1], 0.3), {}), (([texture()], soft, NODES, 0.0), {}),
                (([HeightMap(heights(), SPACING)], soft, NODES, 0.3), {}),
                (([texture()], soft, NODES, 0.3), {"shoe_surfaces": [texture(), texture()]}),
                (([texture()], soft, NODES, 0.3), {"device": "abacus"}),
                (([texture()], lambda w: soft(w), NODES, [0.3, 0.4]), {"processes": 2}),
                (([texture()], "rubber", NODES, 0.3), {}),
            )
        ],
        "waves": [refusal(table_over_scales, lambda q: q, waves, soft, NODES, 0.3)
                  for waves in ((1e-3, 1e-3), (1e-3, 0.0), (math.inf, 1e-6))],
    }  # fmt: skip
    held(file_regression, said)


WAVES = np.geomspace(1e4, 1e6, 40)
DENSITY = 1e-15 * (WAVES / 1e5) ** -3.6


def shown(contact: TheoryContact) -> Any:
    return contact, contact.status


def test_theories(file_regression):
    pressures = np.array([1e3, 1e5, 1e6, 1e8])
    moments = SpectralMoments(1e-12, 0.04, 4e9, (1e4, 1e6))
    lay = np.full((40, 3), 0.5), np.full((40, 3), 1 / 3)
    said: dict[str, Any] = {
        "persson": shown(persson(pressures, WAVES, DENSITY, soft, 0.3)),
        "at rest": shown(persson(pressures, WAVES, DENSITY, soft)),
        "elastic": shown(persson(pressures, WAVES, DENSITY, 4e6, 0.3, 0.4)),
        "growth": persson_growth(1e5, WAVES, DENSITY, soft, -0.3),
        "plain": persson_growth(1e5, WAVES, DENSITY, soft, 0.3, gamma=1.0),
        "lay": persson_growth(1e5, WAVES, DENSITY, soft, 0.3, directions=lay),
        "gap": yang_persson_mean_gap(pressures, WAVES, DENSITY, 4e6),
        "other gap": yang_persson_mean_gap(pressures, WAVES, DENSITY, 4e6, 0.3, 1.0),
        "sum": cumulative(WAVES, WAVES),
        "summits": shown(greenwood_williamson([1e2, 1e4, 1e5], moments, 4e6)),
        "summits, stiff": shown(greenwood_williamson([1e4], moments, 4e7, 0.3)),
        "spectrum": checked_spectrum(WAVES, DENSITY),
    }  # fmt: skip
    gaps = np.array([-1e-7, 1e-7, 5e-7, 2e-6, 1e-5])
    for name, law in (
        ("persson", persson_law(WAVES, DENSITY, 4e6)),
        ("open", persson_law(WAVES, DENSITY, 4e6, 0.4, lambda gap: np.minimum(gap * 1e5, 1.0))),
        ("summits", greenwood_williamson_law(WAVES, DENSITY, 4e6, 0.4)),
        ("exponential", ExponentialLaw(4e6, 0.5, 2e-6)),
        ("half", ExponentialLaw(4e6, 0.3, 2e-6)),
        (
            "nodes",
            TabulatedLaw(
                "a",
                "b",
                np.array([1e-6, 2e-6, 4e-6]),
                np.array([1e6, 1e5, 1e4]),
                np.array([0.0, 0.4, 0.9]),
                0.3,
            ),
        ),
        (
            "flat",
            TabulatedLaw(
                "a",
                "b",
                np.array([1e-6, 2e-6, 4e-6]),
                np.array([1e6, 1e5, 1e4]),
                np.array([0.2, 0.4, 0.4]),
            ),
        ),
    ):
        said[f"law {name}"] = (
            law.pressure(gaps), law.stiffness(gaps), law.flow_factor(gaps),
            law.flow_factor_slope(gaps), law.mean_gap([1e3, 2e5, 3e6]), law.table(), repr(law),
            law.breaches(pressure=1e9, speed=0.1), law.breaches(pressure=1e4, speed=0.1), law.name,
        )  # fmt: skip
        if isinstance(law, TabulatedLaw):
            scaled = law.scale_contact(2.0, 3.0)
            assert (scaled.name, scaled.source, scaled.speed) == (law.name, law.source, None)
            other = law.change_gap_and_flow(2.0, 3.0)
            said[f"scaled {name}"] = scaled.pressure(gaps), scaled.ranges, other.flow_factor(gaps)
    held(file_regression, said)


def test_surfaces_and_flow(file_regression):
    floor, shoe = texture(resolution=5e-6, source="floor"), texture(2)
    gap = np.maximum(heights((12, 10)) + 1e-6, 0.0)
    neck = np.zeros((8, 8))
    neck[2] = neck[:, 3] = 1e-6
    island = np.zeros((8, 8))
    island[2:4, 3:6] = 1e-6
    said: dict[str, Any] = {
        "plain": composite_surface(floor, shoe),
        "resting": composite_surface(floor, shoe, soft, 0.3),
        "back": composite_surface(floor, shoe, soft, -0.3).heights,
        "still": composite_surface(floor, shoe, soft).processing,
        "flow": [flow_factors(gap), flow_factors(gap, (1e-6, 2e-6)),
                 flow_factors(gap, 1.0, closed=5e-7)],
        "mean": flow_factors(gap).mean,
        "one": flow_factors(np.full((6, 6), 3e-6)), "none": flow_factors(np.zeros((6, 6))),
        "neck": flow_factors(neck), "island": flow_factors(island),
        "rows": flow_factors(np.repeat([[1e-6], [3e-6]] * 2, 6, axis=1)),
    }  # fmt: skip
    cut = cutoff_dependence(texture(), soft, 0.3, 3e5, [3.2e-5, 1.6e-5, 8e-6])
    said["cut"] = cut, cut.area_exponent, cut.note
    assert cutoff_dependence(texture(), soft, 0.3, 3e5, [8e-6, 2 * SPACING]).status is not None
    open_map = HeightMap(heights((16, 16)), SPACING)
    said["refused"] = [
        refusal(composite_surface, floor, HeightMap(heights(), SPACING, periodic=True)),
        refusal(composite_surface, floor, HeightMap(shoe.heights, 2.1e-6, periodic=True)),
        refusal(composite_surface, floor, open_map),
        *(refusal(cutoff_dependence, texture(), soft, 0.3, 3e5, waves)
          for waves in ([8e-6], [8e-6, 9e-6], [8e-6, 3.9e-6], [[8e-6, 7e-6]], [math.nan, 8e-6])),
        refusal(cutoff_dependence, open_map, soft, 0.3, 3e5, [8e-6, 6e-6]),
        refusal(flow_factors, np.ones(4)), refusal(flow_factors, np.full((4, 4), math.nan)),
        refusal(flow_factors, -np.ones((4, 4))),
    ]  # fmt: skip
    held(file_regression, said)
    # across parallel plates of two gaps in turn the resistances add up
    a, b = 1.0, 3.0
    face = 2 * a**2 * b**2 / (a + b)
    assert flow_factors(np.repeat([[a], [b]] * 2, 6, axis=1)).along == pytest.approx(face / 8.0)


def test_kernels(file_regression):
    h = heights((12, 10))
    steps = (2e-6, 3e-6)
    qx, qy = periodic.wavenumbers(h.shape, steps)
    odd = periodic.odd_wavenumbers(h.shape, steps)
    spectrum = np.fft.rfft2(h)
    pressure = np.fft.rfft2(1e5 + 1e10 * h)
    table = soft(1e5 * np.arange(7))
    moduli = periodic.sliding_moduli(table, 12 * 2e-6, True, qx)
    contact = h > 0
    moved = periodic.ShiftedMap(h, 2e-6)
    x = np.array([0.0, 1.0, 2.0, 4.0])
    grid = np.array([[0.0, 1], [1, 3], [1, 4], [5, 6]])
    said = {
        "waves": (qx, qy, odd, periodic.wavenumbers((5, 4), steps), periodic.odd_wavenumbers(
            (5, 4), steps)),
        "half": [periodic.half_sum(np.arange(12.0).reshape(3, 4), n) for n in (6, 7)],
        "slopes": [periodic.slope_numbers(spectrum, qx**2 + qy**2, h.shape, limit)
                   for limit in (3e5, 1e9)],
        "work": periodic.work_against_slope(pressure, spectrum, odd, h.shape),
        "moduli": (moduli, periodic.sliding_moduli(table, 24e-6, False, qx),
                   periodic.sliding_moduli(table.real + 0j, 24e-6, True, qx)),
        "lost": periodic.dissipation(pressure, 1e-6 + 0 * qx + 0 * qy, moduli, odd, h.shape),
        "compliance": [periodic.unit_compliance(np.array([1e3, 1e5, 1e8]), t, nu)
                       for t in (None, 2e-5) for nu in (0.3, 0.5)],
        "moved": (moved.at(3.1e-6), moved.slope_at(3.1e-6)),
        "edge": periodic.boundary_length(contact, steps, np),
        "fractions": [periodic.contact_fractions(one, steps, np)
                      for one in (contact, np.eye(8, dtype=bool), ~contact & contact)],
        "slopes of nodes": pchip_slopes(x, np.array([0.0, 1.0, 1.0, 5.0])),
        "grid": interpolated_grid(x, np.array([0.0, 2.0]), grid, np.array([-1.0, 0.5, 3.0, 9.0]),
                                  np.array([1.0, 0.5, -1.0, 3.0])),
        "column": interpolated_grid(x, np.array([3.0]), grid[:, :1], np.array([0.5]),
                                    np.array([0.0])),
        "low": [low_pass(spectrum, (12, 10), f, np) for f in ((2, 1), (1, 2), (2, 2), (3, 1))],
        "repeated": repeat_cells(np.arange(6.0).reshape(2, 3), (2, 3), np),
        "coarser": [_coarsenings(shape) for shape in ((16, 16), (64, 64), (128, 48), (256, 30))],
        "batch": [batch_size(*one) for one in ((100, None), (10**9, None), (100, 10**6))],
        "slow": [str(slow_transform(s)) for s in ((128, 128), (131, 128), (13, 13), (260, 130))],
        "breaches": [resolution_breaches(*one) for one in ((0.5, 0.1, 30), (0.51, 0.1, 30),
                                                           (0.5, 0.11, 30), (0.5, 0.1, 29))],
        "loss": [loss_reason(e + 1j * e * np.array([0.0, t]), np.array([0.0, 30.0]))
                 for e, t in ((1e6, 0.0), (1e6, 9.9e-4), (1e6, 1e-3))],
        "still": loss_reason(np.array([1e6 + 0j]), np.array([0.0])),
        "number": modulus_function(3e6, x)(x), "input": checked_contact_input(
            heights(), [1e-6, 2e-6], 0.1, 1e5, 0.5, 1e-3)[1],
    }  # fmt: skip
    held(file_regression, said)
    np.testing.assert_allclose(moved.at(2e-6), np.roll(h, -1, axis=0), atol=1e-12)


def test_what_is_refused(file_regression):
    h = heights()
    good: dict[str, Any] = {"height": h, "spacing": 1e-6, "modulus": soft, "speed": 0.1,
                            "pressure": 1e5}  # fmt: skip
    hole = h.copy()
    hole[2, 3] = math.nan
    said: dict[str, Any] = {}
    for name, change in {
        "line": {"height": h[0]}, "small": {"height": h[:3]}, "short": {"height": h[:7, :7]},
        "hole": {"height": hole}, "text": {"height": [["a"] * 8] * 8},
        "complex": {"height": h + 0j}, "bool": {"height": h > 0},
        "spacing": {"spacing": 0.0}, "three": {"spacing": (1e-6, 1e-6, 1e-6)},
        "pressure": {"pressure": 0.0}, "pressures": {"pressure": [1e5, 2e5]},
        "word": {"pressure": "much"}, "speed": {"speed": math.inf}, "speeds": {"speed": [0.1]},
        "poisson": {"poisson_ratio": 0.51}, "layer": {"layer_thickness": 0.0},
        "stiff": {"modulus": -1.0}, "no modulus": {"modulus": "rubber"},
        "liquid": {"modulus": lambda w: 1j * w}, "gives": {"modulus": lambda w: 1e6 - 1e3j + 0 * w},
        "nan": {"modulus": lambda w: math.nan + 0 * w},
    }.items():  # fmt: skip
        said[name] = refusal(steady_sliding, **(good | change))
    nodes = np.array([1e-6, 2e-6, 4e-6]), np.array([1e6, 1e5, 1e4]), np.array([0.1, 0.4, 0.9])
    law = TabulatedLaw("a", "b", *nodes)
    for name, change in {
        "two": {"gap": nodes[0][:2]}, "falls": {"gap": nodes[0][::-1]},
        "rises": {"node_pressure": nodes[1][::-1]}, "zero": {"node_pressure": nodes[1] - 1e4},
        "flow": {"node_flow_factor": -nodes[2]}, "flows": {"node_flow_factor": nodes[2] * np.nan},
    }.items():  # fmt: skip
        said[f"law {name}"] = refusal(replace, law, **change)
    said |= {f"exponential {args}": refusal(ExponentialLaw, *args)
             for args in ((0.0, 0.5, 1e-6), (1e6, 0.6, 1e-6), (1e6, 0.5, 0.0))}  # fmt: skip
    said |= {f"gap of {p} {one.name}": refusal(one.mean_gap, p)
             for one in (law, ExponentialLaw(1e6, 0.5, 1e-6)) for p in (0.0, math.nan)}  # fmt: skip
    for name, args in {
        "lengths": (WAVES, DENSITY[:9]), "few": (WAVES[:7], DENSITY[:7]),
        "infinite": (WAVES, DENSITY * math.inf), "falling": (WAVES[::-1], DENSITY),
        "from zero": (WAVES - 1e4, DENSITY), "below zero": (WAVES, -DENSITY),
        "nothing": (WAVES, 0 * DENSITY),
    }.items():  # fmt: skip
        said[f"spectrum {name}"] = refusal(checked_spectrum, *args)
    moments = SpectralMoments(1e-12, 0.04, 4e9, (1e4, 1e6))
    said["persson"] = refusal(persson, [1e5, 0.0], WAVES, DENSITY, 4e6)
    said["yang"] = refusal(yang_persson_mean_gap, [-1.0], WAVES, DENSITY, 4e6)
    said["summits"] = [refusal(greenwood_williamson, [p], moments, 4e6) for p in (0.0, math.nan)]
    said["modulus"] = refusal(greenwood_williamson, [1e5], moments, 0.0)
    said["ratio"] = refusal(greenwood_williamson_law, WAVES, DENSITY, 4e6, 0.6)
    held(file_regression, said)
