"""``validate`` runs what a run runs: wrong faces, rims and leaning of the film fail its checks."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from underfoot.core import ConvergenceError
from underfoot.film import Upwinding, face_operator
from underfoot.sole_contact import march, newton
from underfoot.studies import validation

CORNERS = (30e-3, 30.3e-3, 30.6e-3, 30.97e-3)


@pytest.mark.parametrize("corner", CORNERS)
def test_the_inlet_is_resolved_wherever_the_corner_lies(corner):
    assert validation.inlet_of_a_worn_heel(corner).passed


@pytest.mark.parametrize(
    "check", [validation.soft_ball, validation.pressed_lug, validation.squeezed_lug]
)
def test_soles_with_a_known_answer_pass(check):
    found = as_it_is(check)
    assert found.passed, found


def test_the_load_of_the_strip_is_that_of_its_pressure():
    from scipy.integrate import solve_ivp

    film, corner, slope, pool = 15e-6, 0.02, 0.2, 0.3e-3
    end = corner + (pool - film) / slope

    def rates(x, _):
        gap = film + slope * max(x - corner, 0.0)
        return [gap**-2, gap**-3]

    ends = {"rtol": 1e-10, "atol": 1e-30, "max_step": 1e-4}
    squares, cubes = solve_ivp(rates, (0, end), [0, 0], **ends).y[:, -1]
    still = squares / cubes

    def pressure_and_load(x, y):
        gap = film + slope * max(x - corner, 0.0)
        return [6 * 0.2 * 0.5 * (still - gap) / gap**3, y[0]]

    pressure, load = solve_ivp(pressure_and_load, (0, end), [0, 0], **ends).y[:, -1]
    assert abs(pressure) < 1e-3 * load / end
    found = validation._strip_load(film, corner, slope, pool, viscosity=0.2, speed=0.5)
    assert found == pytest.approx(load, rel=1e-5)


@cache
def as_it_is(check):
    return check()


def passes_as_it_is_and_fails_with(monkeypatch, check, where, name, mutant):
    assert as_it_is(check).passed
    monkeypatch.setattr(where, name, mutant)
    try:
        found = check()
    except ConvergenceError:  # a mutant may not even converge
        return
    assert not found.passed, found


def test_faces_that_forget_the_corner_fail(monkeypatch):
    faces = newton.Faces

    def straight(*given):
        made = faces(*given)
        return replace(made, rise=np.zeros_like(made.rise))

    check = validation.inlet_of_a_worn_heel
    passes_as_it_is_and_fails_with(monkeypatch, check, newton, "Faces", straight)


def test_a_rim_of_the_pool_in_the_wrong_place_fails(monkeypatch):
    faces = newton.Faces

    def at_centres(*given):
        made = faces(*given)
        parted = made.lean[0] != made.lean[1]
        return replace(
            made, node=np.where(parted, 0.02, made.node), crossing=0.02 + 0 * made.crossing
        )

    check = validation.squeezed_lug
    passes_as_it_is_and_fails_with(monkeypatch, check, newton, "Faces", at_centres)


def test_faces_that_lean_fully_upstream_fail(monkeypatch):
    leaning = face_operator.leaning

    def fully(*given, **named):
        found = leaning(*given, **named)
        return Upwinding(np.ones_like(found.strength), 0 * found.correction)

    check = validation.soft_ball
    passes_as_it_is_and_fails_with(monkeypatch, check, march, "leaning", fully)
