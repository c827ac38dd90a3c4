"""Highest pressure at an edge and away from it."""

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from underfoot.case import Case
from underfoot.compute.numbers import bearing_pressure, overload_words
from underfoot.compute.run import run
from underfoot.compute.sole import overload_breaches
from underfoot.compute.summary import headline
from underfoot.shoe import Heel, Tread, heel_map
from underfoot.sole_contact.edge_peak import overloaded_share, peak_pressure


def test_a_peak_at_a_lug_edge_is_marked_and_its_mean_stays():
    """p = p0 sqrt(w / x) from an edge grows with the grid; its mean over 10 mm2 hardly does."""
    tread = Tread("transverse", 5e-3, 2.5e-3, 2e-3)
    heel = Heel(length=30e-3, width=30e-3, rear_radius=0.0, outsole_thickness=0.01, tread=tread)
    found = []
    for spacing in (0.5e-3, 0.125e-3):
        sole = heel_map(heel, shoe_angle=0.0, spacing=spacing)
        from_edge = np.mod(sole.x, 7.5e-3)[:, None]
        pressure = np.where(sole.land, 1e5 * np.sqrt(1e-3 / np.maximum(from_edge, 1e-9)), 0.0)
        peak = peak_pressure(sole, pressure)
        assert peak.at_edge
        assert "finer grid" in peak.remark
        assert peak.highest == pytest.approx(1e5 * math.sqrt(2e-3 / spacing), rel=1e-6)
        found.append(peak)
    assert found[1].highest == pytest.approx(2 * found[0].highest)
    assert found[1].mean == pytest.approx(found[0].mean, rel=0.1)


def test_a_peak_in_the_middle_is_not_marked():
    heel = Heel(length=30e-3, width=30e-3, rear_radius=0.0, outsole_thickness=0.01)
    sole = heel_map(heel, shoe_angle=0.0, spacing=0.5e-3)
    distance = np.hypot(sole.x[:, None] - 15e-3, sole.y[None, :])
    peak = peak_pressure(sole, 1e5 * np.exp(-((distance / 8e-3) ** 2)))
    assert not peak.at_edge
    assert peak.remark == ""
    assert peak.mean == pytest.approx(peak.highest, rel=0.03)


def test_cells_of_the_border_are_at_the_edge_and_no_others():
    heel = Heel(length=7e-3, width=6e-3, rear_radius=0.0, outsole_thickness=0.01)
    sole = heel_map(heel, shoe_angle=0.0, spacing=1e-3)
    along, across = np.nonzero(sole.land)
    for i, j in zip(along, across, strict=True):
        pressure = np.where(sole.land, 1.0, 0.0)
        pressure[i, j] = 2.0
        beside = sole.land[max(i - 1, 0) : i + 2, max(j - 1, 0) : j + 2]
        assert peak_pressure(sole, pressure).at_edge == (beside.sum() < 9)


def test_load_on_what_rubber_cannot_bear_is_counted_with_what_cells_stand_for():
    pressure, area = np.array([[1e6, 9e6]]), np.array([[1.5, 0.5]])
    assert overloaded_share(pressure, pressure * area, 5e6) == pytest.approx(4.5 / 6.0)
    assert overloaded_share(pressure, pressure * area, 10e6) == 0.0


def test_few_cells_at_an_edge_do_not_decide_which_pressure_the_contact_bears():
    """Pressures even from 0 to 1 MPa: the load up to p is p^2 of it, 99 % up to sqrt(0.99)."""

    def bears(pressure, area):
        state: Any = SimpleNamespace(contact_pressure=pressure, cut=SimpleNamespace(area=area))
        return bearing_pressure(state)

    even = np.linspace(0, 1e6, 10_000).reshape(100, 100)
    area = np.ones_like(even)
    assert bears(even, area) == pytest.approx(math.sqrt(0.99) * 1e6, rel=1e-3)
    even[0, 0] = 2e7  # 0.4 % of the load in one cell
    assert bears(even, area) == pytest.approx(1e6, rel=5e-3)
    assert bears(np.zeros_like(even), area) == 0.0


@pytest.mark.slow
def test_a_sole_worn_nearly_through_has_no_rigid_points():
    """Remains of channels and of lugs, a tenth of a millimetre high, on the body of the sole."""
    case = Case.load("examples/work_shoe_full_tread_glycerol.toml")
    case = case.replace("shoe.wear.mode", "walk").replace("numerics.tread_positions", 1)
    case = case.replace("shoe.heel.profile.length", "30 mm")  # these remains are of its wear
    loads = []
    for depth in ("3.8 mm", "4.4 mm"):
        found = run(case.replace("shoe.wear.depth", depth), quick=True)
        data = found.data
        highest = (data["fluid_pressure"].values + data["contact_pressure"].values).max()
        assert highest < 3 * 500 / (75e-3 * 70e-3 / 4)  # thrice the mean over a quarter of the heel
        assert "overload" not in found.labels
        loads.append(found.scalars["fluid_load"].value)
    assert loads == sorted(loads)
    # more of the load than edges take on pressures above the modulus is said beside COF
    heavy = SimpleNamespace(total_pressure=np.array([1e5, 2e7]), cell_load=np.array([1e6, 1e6]))
    words = overload_words(overload_breaches(heavy, 5e6))
    said = headline(found.status, found.scalars, {**found.labels, "overload": words})
    assert said[1].startswith("50% of the load rests on pressures above the modulus")
