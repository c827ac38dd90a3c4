"""Contact tables: nodes are solutions, the rest is interpolation with limits."""

from dataclasses import replace

import numpy as np
import pytest

from underfoot.core import (
    Cache,
    Cancelled,
    ConvergenceError,
    DataError,
    InputError,
    RangeError,
    Status,
)
from underfoot.material import Elastomer, power_law_spectrum, report_elastomer
from underfoot.rough_contact import PressureGapLaw, steady_sliding
from underfoot.rough_contact import contact_table as run
from underfoot.rough_contact.composite import composite_surface
from underfoot.rough_contact.contact_table import QUANTITIES, ContactTable, leave_out_errors
from underfoot.rough_contact.cutoff import cutoff_dependence
from underfoot.rough_contact.flow_factor import flow_factors
from underfoot.surface import HeightMap, self_affine

RUBBER = power_law_spectrum(1.3e6, 0.12)
PRESSURE = np.geomspace(2e4, 4e5, 5)
SPEED = np.array([0.03, 0.3])
N = 48


def surfaces(count=3, rms=4e-6):
    return [self_affine(N, 8e-6, rms, 0.8, 384e-6, 48e-6, seed) for seed in range(count)]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("tables")


@pytest.fixture(scope="module")
def table(folder):
    return ContactTable.from_surfaces(
        surfaces(), RUBBER, PRESSURE, SPEED, cache=Cache("t", folder), description="test texture"
    )


# the solver stops at an error of 1e-6 of the rms height, so a node may switch between two runs
def test_nodes_are_means_over_the_surfaces(table):
    contacts = [
        steady_sliding(s.heights, s.spacing, RUBBER, SPEED[1], PRESSURE[2]) for s in surfaces()
    ]
    assert all(contact.status.usable for contact in contacts)
    area = [contact.real_contact_fraction_corrected for contact in contacts]
    cof = [contact.cof_hysteresis for contact in contacts]
    flow = [flow_factors(np.where(c.pressure > 0, 0, c.gap)).along * np.ones(1) for c in contacts]
    p, v = PRESSURE[2], SPEED[1]
    assert table.real_contact_fraction(p, v) == pytest.approx(np.mean(area), rel=1e-3)
    assert table.cof_hysteresis(p, v) == pytest.approx(np.mean(cof), rel=1e-4)
    assert table.cof_hysteresis(p, -v) == pytest.approx(-np.mean(cof), rel=1e-4)
    assert table.mean_gap(p, v) == pytest.approx(np.mean([c.mean_gap for c in contacts]), rel=1e-4)
    assert table.flow_factor(p, v, "along") == pytest.approx(np.mean(flow), rel=1e-2)
    value = table.sourced_value("real_contact_fraction", p, v)
    assert value.uncertainty == pytest.approx(np.std(area, ddof=1), rel=1e-2)


def test_between_the_nodes_it_stays_near_the_solution(table):
    p, v = np.sqrt(PRESSURE[1] * PRESSURE[2]), 0.1
    contacts = [steady_sliding(s.heights, s.spacing, RUBBER, v, p) for s in surfaces()]
    area = np.mean([c.real_contact_fraction_corrected for c in contacts])
    gap = np.mean([c.mean_gap for c in contacts])
    cof = np.mean([c.cof_hysteresis for c in contacts])
    assert table.real_contact_fraction(p, v) == pytest.approx(area, rel=0.02)
    assert table.mean_gap(p, v) == pytest.approx(gap, rel=0.02)
    assert table.cof_hysteresis(p, v) == pytest.approx(cof, rel=0.03)


def test_shape_over_the_box(table):
    p, v = np.meshgrid(np.geomspace(*PRESSURE[[0, -1]], 31), [0.03, 0.1, 0.3], indexing="ij")
    area, gap = table.real_contact_fraction(p, v), table.mean_gap(p, v)
    flow = table.flow_factor(p, v)
    assert np.all(np.diff(area, axis=0) > 0)
    assert np.all(np.diff(gap, axis=0) < 0)
    assert np.all(np.diff(flow, axis=0) <= 1e-12)
    assert np.all(np.diff(area, axis=1) < 0)  # stiffer at speed
    assert np.all(np.diff(gap, axis=1) > 0)


def test_outside_the_box_is_refused_or_extended_knowingly(table):
    assert not table.breaches(pressure=1e5, speed=0.1)
    assert len(table.breaches(pressure=[1e3, 1e5], speed=2.0)) == 2
    with pytest.raises(RangeError, match="outside the tested range"):
        table.mean_gap(1e3, 0.1)
    with pytest.raises(InputError, match="negative"):
        table.mean_gap(-1.0, 0.1, "extend")
    low = PRESSURE[0]
    assert table.real_contact_fraction(low / 10, 0.1, "extend") == pytest.approx(
        table.real_contact_fraction(low, 0.1) / 10
    )
    assert table.real_contact_fraction(0.0, 0.1, "extend") == 0.0
    assert table.mean_gap(low / 10, 0.1, "extend") > table.mean_gap(low, 0.1)
    assert np.isfinite(table.mean_gap(0.0, 0.1, "extend"))
    at_edge = table.cof_hysteresis(1e5, 0.3)
    assert table.cof_hysteresis(1e5, 5.0, "extend") == pytest.approx(at_edge)


def test_law_goes_through_the_nodes(table):
    law = table.law(SPEED[0])
    assert isinstance(law, PressureGapLaw)
    gap = table.mean_gap(PRESSURE, SPEED[0])
    np.testing.assert_allclose(law.pressure(gap), PRESSURE, rtol=1e-9)
    flow = table.flow_factor(PRESSURE, SPEED[0])
    np.testing.assert_allclose(law.flow_factor(gap), np.maximum(flow, run.SEALED), atol=1e-9)
    assert law.breaches(pressure=1e7, speed=0.1)[0].quantity == "pressure"
    assert "test texture" in law.source
    dense = np.geomspace(*PRESSURE[[0, -1]], 40)
    back = law.pressure(table.mean_gap(dense, SPEED[0]))
    np.testing.assert_allclose(back, dense, rtol=0.01)


def test_saved_and_loaded_is_the_same(table, tmp_path):
    table.save(tmp_path / "t.npz")
    again = ContactTable.load(tmp_path / "t.npz")
    for name in QUANTITIES:
        np.testing.assert_array_equal(again.values[name], table.values[name])
        np.testing.assert_array_equal(again.deviation[name], table.deviation[name])
    assert again.notes == table.notes
    assert again.key == table.key
    (tmp_path / "bad.npz").write_bytes(b"nothing")
    for wrong in ("bad.npz", "absent.npz"):
        with pytest.raises(DataError, match="not a contact table"):
            ContactTable.load(tmp_path / wrong)


def test_finished_parts_come_from_the_cache(folder, table, monkeypatch):
    def never(part):
        raise AssertionError("computed again")

    monkeypatch.setattr(run, "_column", never)
    again = ContactTable.from_surfaces(
        surfaces(), RUBBER, PRESSURE, SPEED, cache=Cache("t", folder)
    )
    np.testing.assert_array_equal(again.values["mean_gap"], table.values["mean_gap"])


def test_cancelling_keeps_what_is_done(tmp_path):
    cache, told = Cache("t", tmp_path), []

    def stop(stage, fraction, residual=None):
        told.append(fraction)
        if fraction > 0.4:
            raise Cancelled("stop")

    with pytest.raises(Cancelled):
        ContactTable.from_surfaces(surfaces(1), 5e6, PRESSURE, SPEED, cache=cache, progress=stop)
    assert told[-1] == 0.5
    assert len(list(cache.folder.glob("*.npz"))) == 1
    told.clear()
    ContactTable.from_surfaces(
        surfaces(1), 5e6, PRESSURE, SPEED, cache=cache, progress=lambda *a: told.append(a[1])
    )
    assert told[0] == 0.5
    assert told[-1] == 1.0


def test_processes_give_the_same_numbers(table, tmp_path):
    again = ContactTable.from_surfaces(
        surfaces(), RUBBER, PRESSURE, SPEED, cache=Cache("t", tmp_path), processes=2
    )
    for name in QUANTITIES:
        near = 1e-4 * np.abs(table.values[name]).max()  # a gap is 1e-6 m, a share of contact 1
        np.testing.assert_allclose(again.values[name], table.values[name], rtol=1e-3, atol=near)
    with pytest.raises(InputError, match="another process"):
        ContactTable.from_surfaces(
            surfaces(2),
            lambda w: 5e6 + 1e5j * (w > 0),
            PRESSURE,
            SPEED,
            cache=Cache("u", tmp_path),
            processes=2,
        )


def test_another_modulus_is_another_key(tmp_path):
    heights = surfaces(1)[0]
    parts = [
        run._Part(heights.heights, heights.spacing, modulus, 0.1, PRESSURE, 0.5, None).key
        for modulus in (5e6, 5.0001e6, RUBBER, RUBBER.scale_moduli(1.01))
    ]
    assert len(set(parts)) == 4


def test_one_surface_gives_no_uncertainty_and_says_why(tmp_path):
    single = ContactTable.from_surfaces(
        surfaces(1), 5e6, PRESSURE, [0.1], cache=Cache("t", tmp_path)
    )
    value = single.sourced_value("mean_gap", 1e5, 0.1)
    assert value.uncertainty is None
    assert "one surface" in value.reason
    assert "shortest wave 48 um" in single.notes[0]
    assert single.cof_hysteresis(1e5, 0.1) == pytest.approx(0.0, abs=1e-10)
    with pytest.raises(InputError, match="Did you mean"):
        single.sourced_value("mean_gab", 1e5, 0.1)


def test_a_material_without_loss_says_why_there_is_no_hysteresis(tmp_path):
    lossless = ContactTable.from_surfaces(
        surfaces(1), report_elastomer("rubber"), PRESSURE, SPEED, cache=Cache("t", tmp_path)
    )
    assert np.abs(lossless.values["cof_hysteresis"]).max() < 1e-4
    assert any("loss tangent" in note for note in lossless.notes)


def test_rough_shoe_and_rough_floor(tmp_path, table):
    """Less contact and a wider gap than on the floor alone, but the floor's own hysteresis."""
    floors = surfaces()
    shoes = [self_affine(N, 8e-6, 4e-6, 0.8, 384e-6, 48e-6, seed) for seed in (11, 12, 13)]
    cache = Cache("t", tmp_path)
    both = ContactTable.from_surfaces(
        floors, RUBBER, PRESSURE, SPEED, shoe_surfaces=shoes, cache=cache
    )
    p, v = PRESSURE[2], SPEED[1]
    assert both.real_contact_fraction(p, v) < table.real_contact_fraction(p, v)
    assert both.mean_gap(p, v) > table.mean_gap(p, v)
    assert both.cof_hysteresis(p, v) == pytest.approx(table.cof_hysteresis(p, v), rel=1e-4)
    assert any("rest in" in note for note in both.notes)
    heights = composite_surface(floors[0], shoes[0], RUBBER, v).heights
    one = ContactTable.from_surfaces(
        floors[:1], RUBBER, PRESSURE, [v], shoe_surfaces=shoes[:1], cache=cache
    )
    solved = steady_sliding(heights, 8e-6, RUBBER, v, p)
    assert one.mean_gap(p, v) == pytest.approx(solved.mean_gap, rel=1e-4)
    with pytest.raises(InputError, match="one for each floor"):
        ContactTable.from_surfaces(
            floors, RUBBER, PRESSURE, SPEED, shoe_surfaces=shoes[:1], cache=cache
        )


def test_leave_out_errors_fall_with_node_distance(table, tmp_path):
    fine = ContactTable.from_surfaces(
        surfaces(),
        RUBBER,
        np.geomspace(2e4, 4e5, 9),
        SPEED,
        cache=Cache("t", tmp_path),
    )
    wide, narrow = leave_out_errors(table), leave_out_errors(fine)
    assert narrow["mean_gap"] < 0.5 * wide["mean_gap"]
    assert narrow["real_contact_fraction"] < 0.02
    assert narrow["mean_gap"] < 0.01
    with pytest.raises(InputError, match="5 or more"):
        leave_out_errors(table, "speed")


def test_a_node_that_no_surface_solved_is_an_error(monkeypatch, tmp_path):
    def failing(part):
        column = {name: np.ones(PRESSURE.size) for name in QUANTITIES}
        for array in column.values():
            array[-1] = np.nan
        return column | {"error": np.full(PRESSURE.size, 0.3), "notes": np.array([], dtype=str)}

    monkeypatch.setattr(run, "_column", failing)
    with pytest.raises(ConvergenceError, match="no surface converged"):
        ContactTable.from_surfaces(surfaces(1), 5e6, PRESSURE, [0.1], cache=Cache("t", tmp_path))


@pytest.mark.parametrize(
    ("changes", "match"),
    [
        ({"surfaces": []}, "no surface"),
        ({"pressure": [1e5, 1e4, 1e3, 1e2]}, "pressure nodes"),
        ({"pressure": [0.0, 1e4, 1e5, 1e6]}, "pressure nodes"),
        ({"speed": [0.0, 0.1]}, "speed nodes"),
        ({"modulus": -1.0}, "modulus"),
    ],
)
def test_bad_input_is_refused(changes, match, tmp_path):
    given = {"surfaces": surfaces(1), "modulus": 5e6, "pressure": PRESSURE, "speed": SPEED}
    with pytest.raises(InputError, match=match):
        ContactTable.from_surfaces(**(given | changes), cache=Cache("t", tmp_path))


def test_maps_with_edges_are_refused(tmp_path):
    cut = HeightMap(surfaces(1)[0].heights, 8e-6, periodic=False)
    with pytest.raises(InputError, match="not periodic"):
        ContactTable.from_surfaces([cut], 5e6, PRESSURE, SPEED, cache=Cache("t", tmp_path))
    with pytest.raises(InputError, match="not periodic"):
        cutoff_dependence(cut, 5e6, 0.0, 1e5, [96e-6, 48e-6])
    with pytest.raises(InputError, match="periodic"):
        composite_surface(cut, cut)


def test_maps_of_oblong_cells_are_refused(tmp_path):
    """A solver takes one spacing: cells of 8 by 10 um were taken for squares of 8."""
    floor, shoe = surfaces(2)
    oblong = replace(floor, spacing_y=10e-6)
    given = {"pressure": PRESSURE, "speed": SPEED, "cache": Cache("t", tmp_path)}
    for call in (
        lambda: ContactTable.from_surfaces([oblong], 5e6, **given),
        lambda: ContactTable.from_surfaces([floor], 5e6, shoe_surfaces=[oblong], **given),
        lambda: cutoff_dependence(oblong, 5e6, 0.0, 1e5, [96e-6, 48e-6]),
        lambda: composite_surface(oblong, shoe),
        lambda: composite_surface(shoe, oblong),
    ):
        with pytest.raises(InputError, match=r"by 10 .m\. Allowed: square cells"):
            call()


def test_composite_adds_heights_and_says_what_it_can_not_tell():
    floor, shoe = surfaces(2)
    both = composite_surface(floor, shoe)
    np.testing.assert_array_equal(both.heights, floor.heights + shoe.heights)
    assert both.resolution == 48e-6
    coarser = replace(shoe, resolution=90e-6)
    for pair in ((floor, coarser), (coarser, floor)):
        assert composite_surface(*pair).resolution == 90e-6
    unknown = replace(shoe, resolution=None)
    assert composite_surface(floor, unknown).resolution == 48e-6
    assert "hysteresis" in both.processing[-1]
    assert both.periodic
    fine = replace(floor, spacing=12e-9), replace(shoe, spacing=18e-9)  # of an AFM
    with pytest.raises(InputError, match="one shape"):
        composite_surface(*fine)
    with pytest.raises(InputError, match="one shape"):
        composite_surface(floor, self_affine(32, 8e-6, 4e-6, 0.8, 256e-6, 48e-6, seed=0))


def test_contact_area_falls_with_the_shortest_wave():
    surface = self_affine(96, 4e-6, 4e-6, 0.8, 384e-6, 16e-6, seed=2)
    found = cutoff_dependence(surface, RUBBER, 0.1, 5e4, [192e-6, 96e-6, 48e-6, 24e-6, 16e-6])
    assert np.all(np.diff(found.real_contact_fraction) < 0)
    assert np.all(np.diff(found.rms_gradient) > 0)
    assert found.area_exponent > 0
    assert "halving" in found.note
    assert found.status is not Status.NOT_CONVERGED
    with pytest.raises(InputError, match="shortest waves"):
        cutoff_dependence(surface, RUBBER, 0.1, 5e4, [96e-6, 4e-6])


@pytest.mark.parametrize(("height", "stiffness"), [(3.0, 1.0), (1.0, 4.0), (2.5, 0.5)])
def test_an_elastic_table_scales_with_roughness_and_modulus(height, stiffness, tmp_path):
    """Heights times a and moduli times b: gaps times a, pressures times a b, flow factors as is."""
    surface = self_affine(64, 4e-6, 1e-6, 0.8, 128e-6, 32e-6, seed=2)
    pressure = np.geomspace(1e3, 3e5, 6)
    store = Cache("scaled", folder=tmp_path)
    first = ContactTable.from_surfaces([surface], Elastomer(3e6, 0.5), pressure, [1.0], cache=store)
    higher = replace(surface, heights=height * surface.heights)
    second = ContactTable.from_surfaces(
        [higher], Elastomer(3e6 * stiffness, 0.5), height * stiffness * pressure, [1.0], cache=store
    )
    scaled, solved = first.law(1.0).scale_contact(height, height * stiffness), second.law(1.0)
    at = height * stiffness * np.geomspace(2e3, 1e5, 7)
    np.testing.assert_allclose(scaled.mean_gap(at), solved.mean_gap(at), rtol=2e-3)
    gap = solved.mean_gap(at)
    np.testing.assert_allclose(scaled.flow_factor(gap), solved.flow_factor(gap), atol=2e-3)
    assert scaled.breaches(pressure=at[-1], speed=0.0) == []
    assert scaled.breaches(pressure=1e3 * at[-1], speed=0.0)
