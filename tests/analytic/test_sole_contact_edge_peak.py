"""Highest pressure at an edge and away from it."""

import math

import numpy as np
import pytest

from underfoot.shoe import Heel, Tread, heel_map
from underfoot.sole_contact.edge_peak import peak_pressure


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
