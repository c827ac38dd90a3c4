"""Parametric heel under grid refinement."""

import math

import numpy as np

from underfoot.shoe import Facet, Heel, Tread, heel_map

MM = 1e-3


def test_areas_converge_to_the_closed_form():
    """Counting cells along a rim errs by far less than one cell times its length, falling with it.

    Rim of the plan form 207 mm: one cell times the rim is 103 mm^2 at 0.5 mm.
    """
    shape = Heel(
        length=61.3 * MM, width=58.7 * MM, rear_radius=27.1 * MM, outsole_thickness=10 * MM
    )
    errors = []
    for spacing in (2.0, 1.0, 0.5, 0.25, 0.125):
        sole = heel_map(shape, shoe_angle=0.0, spacing=spacing * MM)
        errors.append(abs(sole.plan_area / shape.plan_area - 1))
        assert errors[-1] < 207 * spacing * 0.5 / (shape.plan_area / MM**2)
    assert max(errors[-2:]) < 0.2 * max(errors[:2])
    assert errors[-1] < 1e-3


def test_tread_areas_settle():
    """With at least four cells across channel and lug the land ratio is within 6 % of 0.125 mm."""
    shape = Heel(
        length=60 * MM,
        width=60 * MM,
        rear_radius=28 * MM,
        outsole_thickness=10 * MM,
        profile=Facet(math.radians(10), 30 * MM),
        tread=Tread("grid", 5 * MM, 2.4 * MM, 3 * MM),
    )
    angle = math.radians(10)
    fine = heel_map(shape, shoe_angle=angle, spacing=0.125 * MM)
    ratios = [
        heel_map(shape, shoe_angle=angle, spacing=s * MM).land_ratio / fine.land_ratio - 1
        for s in (0.6, 0.5, 0.4, 0.3)
    ]
    assert np.abs(ratios).max() < 0.06
    assert not fine.breaches


def test_clearance_does_not_depend_on_the_grid():
    """Cells of 0.3 mm and 0.1 mm share their centres: the heights there are the same."""
    shape = Heel(
        length=60 * MM,
        width=20 * MM,
        rear_radius=0.0,
        outsole_thickness=10 * MM,
        profile=Facet(math.radians(8), 30 * MM),
        edge_radius=2 * MM,
    )
    coarse = heel_map(shape, shoe_angle=0.15, spacing=0.3 * MM)
    fine = heel_map(shape, shoe_angle=0.15, spacing=0.1 * MM)
    at = [np.searchsorted(fine.x, x - 0.05 * MM) for x in coarse.x[20:100]]
    row, fine_row = (
        coarse.y.size // 2,
        int(np.argmin(np.abs(fine.y - coarse.y[coarse.y.size // 2]))),
    )
    assert np.allclose(fine.x[at], coarse.x[20:100], atol=1e-12)
    difference = coarse.clearance[20:100, row] - fine.clearance[at, fine_row]
    assert np.ptp(difference) < 1e-10
