"""What the coupled solver refuses, how it reports, and how it stops."""

import dataclasses

import numpy as np
import pytest

from underfoot.core import Cancelled, ConvergenceError, InputError, Status
from underfoot.rough_contact.pressure_gap_law import ExponentialLaw, PressureGapLaw
from underfoot.shoe import Heel, Tread, heel_map
from underfoot.sole_contact.compliance import half_space_compliance, layered_compliance
from underfoot.sole_contact.solver import (
    FINEST,
    PIECES,
    SolverSettings,
    longest_step,
    passing_time,
    solve_sliding,
)

SOLE = heel_map(
    Heel(length=0.04, width=0.04, rear_radius=0.015, outsole_thickness=0.02, edge_radius=0.002),
    shoe_angle=0.1,
    spacing=2e-3,
)
BODY = layered_compliance(SOLE, modulus=5e6, poisson_ratio=0.49, thickness=0.02)
LAW = ExponentialLaw(5e6, 0.5, 10e-6)
GIVEN = {"viscosity": 0.1, "speed": 0.5, "normal_force": 100.0}


def test_law_is_a_pressure_gap_law():
    assert isinstance(LAW, PressureGapLaw)
    gap = np.linspace(-5e-6, 60e-6, 400)
    step = 1e-10
    slope = (LAW.pressure(gap + step) - LAW.pressure(gap - step)) / (2 * step)
    assert LAW.stiffness(gap) == pytest.approx(-slope, rel=1e-4)
    assert (LAW.flow_factor(gap) == 1).all()
    assert (LAW.flow_factor_slope(gap) == 0).all()
    assert LAW.breaches(pressure=1e4, speed=1.0) == []
    assert LAW.breaches(pressure=3e6, speed=1.0)


@pytest.mark.parametrize(
    ("change", "where"),
    [
        ({"viscosity": 0.0}, "viscosity"),
        ({"viscosity": -1.0}, "viscosity"),
        ({"viscosity": float("nan")}, "viscosity"),
        ({"speed": float("nan")}, "speed"),
        ({"speed": float("inf")}, "speed"),
        ({"normal_force": 0.0}, "normal_force"),
        ({"normal_force": float("nan")}, "normal_force"),
        ({"settings": SolverSettings(pool_depth=0.0)}, "settings.pool_depth"),
        ({"settings": SolverSettings(start_film=-1e-6)}, "settings.start_film"),
        ({"settings": SolverSettings(end_time=0.01)}, "settings.end_time"),
        ({"settings": SolverSettings(most_newton=0)}, "settings.most_newton"),
        ({"settings": SolverSettings(backend="umfpack")}, "settings.backend"),
    ],
)
def test_bad_numbers_are_refused(change, where):
    with pytest.raises(InputError) as caught:
        solve_sliding(SOLE, BODY, LAW, **(GIVEN | change))
    assert caught.value.where == where


def test_bad_heights_are_refused():
    broken = SOLE.clearance.copy()
    broken[5, 5] = -1e-3
    with pytest.raises(InputError, match="negative"):
        solve_sliding(dataclasses.replace(SOLE, clearance=broken), BODY, LAW, **GIVEN)


def test_compliance_of_another_grid_is_refused():
    other = half_space_compliance((9, 9), 2e-3, modulus=5e6, poisson_ratio=0.5)
    with pytest.raises(InputError) as caught:
        solve_sliding(SOLE, other, LAW, **GIVEN)
    assert caught.value.where == "compliance"


@pytest.mark.parametrize(
    ("change", "where"),
    [
        ({"modulus": 0.0}, "modulus"),
        ({"modulus": float("nan")}, "modulus"),
        ({"poisson_ratio": 0.6}, "poisson_ratio"),
        ({"thickness": -1.0}, "thickness"),
        ({"midsole_modulus": 1e6}, "midsole_thickness"),
        ({"midsole_modulus": 1e6, "midsole_thickness": 0.0}, "midsole_thickness"),
    ],
)
def test_bad_layers_are_refused(change, where):
    given = {"modulus": 5e6, "poisson_ratio": 0.49, "thickness": 0.02} | change
    with pytest.raises(InputError) as caught:
        layered_compliance(SOLE, **given)
    assert caught.value.where == where


@pytest.mark.parametrize(
    ("values", "where"),
    [((0.0, 0.5, 1e-6), "modulus"), ((1e6, 0.7, 1e-6), "poisson_ratio"), ((1e6, 0.5, 0.0), "rq")],
)
def test_bad_law_is_refused(values, where):
    with pytest.raises(InputError) as caught:
        ExponentialLaw(*values)
    assert caught.value.where == where


def test_a_softer_midsole_gives_way():
    plain = solve_sliding(SOLE, BODY, LAW, **GIVEN)
    soft = layered_compliance(
        SOLE,
        modulus=5e6,
        poisson_ratio=0.49,
        thickness=0.02,
        midsole_modulus=1e6,
        midsole_thickness=0.015,
    )
    assert solve_sliding(SOLE, soft, LAW, **GIVEN).approach > 1.2 * plain.approach


def test_progress_rises_and_can_cancel():
    seen = []
    solve_sliding(SOLE, BODY, LAW, **GIVEN, progress=lambda *report: seen.append(report))
    fractions = [fraction for _, fraction, _ in seen]
    assert 0 < fractions[0] < 0.1
    assert fractions[-1] == pytest.approx(1.0)
    assert all(residual is not None and residual >= 0 for _, _, residual in seen)

    def stop(stage, fraction, residual=None):
        if fraction > 0.2:
            raise Cancelled("stopped")

    with pytest.raises(Cancelled):
        solve_sliding(SOLE, BODY, LAW, **GIVEN, progress=stop)


def test_not_converged_is_marked_with_history_and_remedy():
    solved = solve_sliding(SOLE, BODY, LAW, **GIVEN, settings=SolverSettings(most_time_steps=6))
    assert solved.status is Status.NOT_CONVERGED
    assert not solved.status.usable
    assert solved.remedy
    assert solved.time < 0.12
    assert len(solved.history.time) == solved.counts.time_steps <= 6
    assert solved.residuals


def test_nothing_usable_raises_with_history():
    with pytest.raises(ConvergenceError) as caught:
        solve_sliding(
            SOLE,
            BODY,
            LAW,
            **GIVEN,
            settings=SolverSettings(tolerance=1e-300, most_newton=3, most_time_steps=30),
        )
    assert caught.value.history
    assert caught.value.remedy


def test_the_floor_passes_the_land_that_a_cell_lies_in():
    assert passing_time(SOLE, 0.0) == np.inf
    assert passing_time(SOLE, -2.0) == passing_time(SOLE, 2.0) == passing_time(SOLE, 1.0) / 2
    tread = Tread("grid", lug_width=6e-3, channel_width=4e-3, depth=3e-3)
    plain = Heel(length=0.06, width=0.05, rear_radius=0.001, outsole_thickness=0.02)
    lugs = heel_map(dataclasses.replace(plain, tread=tread), shoe_angle=0.1, spacing=1e-3)
    assert passing_time(lugs, 0.5) == pytest.approx(12e-3, rel=0.05)
    assert passing_time(heel_map(plain, shoe_angle=0.1, spacing=1e-3), 0.5) == pytest.approx(
        0.12, rel=0.03
    )


def test_steps_follow_the_lugs_between_those_of_the_stage_and_a_bound():
    assert longest_step(0.09, np.inf) == 0.09
    assert longest_step(0.09, 5e-3) == PIECES * 5e-3
    assert longest_step(0.09, 1e-6) == 0.09 / FINEST
