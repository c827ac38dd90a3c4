"""The coupled solver against references solved by other means: sliding and squeezed soft films."""

from types import SimpleNamespace

import numpy as np
import pytest

import reference_soft_ehl as reference
from underfoot.core import Status
from underfoot.reference import contact, lubrication
from underfoot.rough_contact.pressure_gap_law import ExponentialLaw
from underfoot.sole_contact.compliance import half_space_compliance
from underfoot.sole_contact.solver import SolverSettings, solve_sliding

RATIO = 0.49
SLIDING = {  # M: radius m, modulus Pa, viscosity Pa s, speed m/s
    reference.LOADS[0]: (20e-3, 3e6, 0.219, 0.7),
    reference.LOADS[1]: (30e-3, 5e6, 0.219, 0.3),
    reference.LOADS[2]: (40e-3, 9e6, 0.050, 0.1),
}
CELLS = 20  # in a contact radius
SQUEEZED = {
    "radius": 30e-3,
    "viscosity": 0.219,
    "force": 10.0,
    "rise_time": 5e-3,
    "end_time": 20e-3,
    "outer": 9.6e-3,
}


def flat_map(x, y, clearance):
    ones = np.ones(clearance.shape, bool)
    return SimpleNamespace(
        cut=None,
        slits=None,
        joint=None,
        cells=None,
        columns=1,
        x=x,
        y=y,
        clearance=clearance,
        inside=ones,
        land=ones,
        tread_depth=np.zeros_like(clearance),
        spacing=float(x[1] - x[0]),
    )


def body(shape, spacing, modulus):
    return half_space_compliance(shape, spacing, modulus=modulus, poisson_ratio=RATIO)


@pytest.mark.slow
@pytest.mark.parametrize("load", SLIDING)
def test_sliding_soft_film_is_that_of_the_reference(load):
    """Centre and least film within 3 %, load and Hertz peak within 1 %."""
    radius, modulus, viscosity, speed = SLIDING[load]
    plane = modulus / (1 - RATIO**2)
    moving = viscosity * speed / (2 * plane * radius)
    force = load * moving**0.75 * 2 * plane * radius**2
    given = {"force": force, "effective_modulus": 2 * plane, "radius": radius}
    found = reference.load_parameter(viscosity=viscosity, speed=speed, **given)
    assert found == pytest.approx(load)
    hertz = contact.hertz_point(force, radius, plane)
    size = hertz.half_width
    x = np.arange(-round(1.7 * CELLS), round(2.6 * CELLS) + 1) * (size / CELLS)
    y = np.arange(-round(1.8 * CELLS), round(1.8 * CELLS) + 1) * (size / CELLS)
    sole = flat_map(x, y, (x[:, None] ** 2 + y**2) / (2 * radius))
    solved = solve_sliding(
        sole,
        body(sole.clearance.shape, sole.spacing, modulus),
        ExponentialLaw(modulus, RATIO, 2e-8),
        viscosity=viscosity,
        speed=speed,
        normal_force=force,
        settings=SolverSettings(pool_depth=1.0, start_film=2e-5, end_time=None),
    )
    assert solved.status is Status.CONVERGED
    assert solved.fluid_load == pytest.approx(force, rel=1e-3)
    film = solved.film_thickness * radius / size**2
    (central, least), unsure = reference.extrapolated(reference.table()[load])
    assert (unsure < (0.001, 0.02)).all()
    assert film[np.argmin(np.abs(x)), np.argmin(np.abs(y))] == pytest.approx(central, rel=0.03)
    assert film.min() == pytest.approx(least, rel=0.03)
    assert solved.fluid_pressure.max() == pytest.approx(hertz.peak_pressure, rel=0.02)


@pytest.mark.slow
@pytest.mark.parametrize("load", reference.LOADS[:2])
def test_stored_films_are_recomputed(load):
    stored = reference.table()[load][1]
    found = reference.point_contact(load, 1 / stored[0])
    assert (found.central, found.least) == pytest.approx(stored[1:], rel=1e-6)
    # the least film is in the lobes beside the exit, the pressure nearly Hertz's
    assert 0.2 < found.place[0] < 0.6
    assert 0.75 < found.place[1] < 0.95
    assert 0.97 < found.peak < 1.0


def test_reference_converges_to_the_second_order():
    """The least film; the central one is there already."""
    for rows in reference.table().values():
        least = {cells: film for cells, _, film in rows}
        ratio = (least[27] - least[18]) / (least[36] - least[27])
        assert ratio > (1 / 18**2 - 1 / 27**2) / (1 / 27**2 - 1 / 36**2)


def test_reference_is_kapitzas_where_the_sphere_is_rigid():
    rate = 5 / 6
    load = (128 * np.pi**3 / (3 * rate**3)) ** 0.25
    errors = []
    for cells in (8, 12):
        found = reference.point_contact(
            load, 1 / cells, inlet=100.0, outlet=0.0, aside=100.0, rigid=True
        )
        x, y, pressure, approach = found.fields
        gap = (x[:, None] ** 2 + y**2) / 2 - approach
        exact = -rate / 5 * x[:, None] / gap**2
        errors.append(float(np.abs(pressure - exact).max() / exact.max()))
    assert errors[1] < 4e-3
    assert errors[0] > 1.4 * errors[1]
    # half the infinite film carries 12 pi / 5 eta V R^2 / sqrt(2 R h); 0.8 % lie beyond the rim
    assert -approach == pytest.approx((0.6 * rate) ** 2 / 2, rel=0.02)


def test_reference_is_near_the_published_regression():
    """Hamrock and Dowson 1978: their fit to 17 coarse solutions is not better than this."""
    effective, radius = 8e6, 30e-3
    for load, rows in reference.table().items():
        force = 1e-3 * effective * radius**2
        moving = (1e-3 / load) ** (4 / 3)  # eta V / (E' R)
        central, least = lubrication.soft_ehl_film(
            viscosity=0.5 * moving * effective * radius,
            entrainment_speed=1.0,
            load=force,
            radius=radius,
            effective_modulus=effective,
        )
        scale = radius / contact.hertz_point(force, radius, effective / 2).half_width ** 2
        (found, thinnest), _ = reference.extrapolated(rows)
        assert central * scale == pytest.approx(found, rel=0.12)
        assert least * scale == pytest.approx(thinnest, rel=0.12)


def test_ring_influence_is_hertzian():
    faces = np.linspace(0.0, 1.0, 81)
    r = 0.5 * (faces[1:] + faces[:-1])
    deflection = reference.ring_influence(faces, 1.0) @ np.sqrt(1 - r**2)
    assert deflection == pytest.approx(np.pi / 4 * (2 - r**2), abs=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize(("modulus", "start"), [(3e6, 50e-6), (9e6, 100e-6)])
def test_squeezed_soft_film_is_that_of_the_radial_reference(modulus, start):
    """Sphere pressed on a flooded floor: dimple and rim within 3 % of the radial solution."""
    plane = modulus / (1 - RATIO**2)
    given = SQUEEZED | {"plane_modulus": plane, "start": start}
    coarse = reference.squeeze(**given, rings=100, steps=100)
    centre, rim = reference.squeeze(**given, rings=160, steps=160)
    assert coarse == pytest.approx((centre, rim), rel=0.015)
    spacing = SQUEEZED["outer"] / 25
    x = np.arange(-27, 28) * spacing
    distance = np.hypot(x[:, None], x)
    inside = distance < SQUEEZED["outer"]
    sole = flat_map(x, x, np.where(inside, distance**2 / (2 * SQUEEZED["radius"]), np.inf))
    solved = solve_sliding(
        sole,
        body(inside.shape, spacing, modulus),
        ExponentialLaw(modulus, RATIO, 2e-8),
        viscosity=SQUEEZED["viscosity"],
        speed=0.0,
        normal_force=SQUEEZED["force"],
        settings=SolverSettings(
            start_film=start,
            rise_time=SQUEEZED["rise_time"],
            end_time=SQUEEZED["end_time"],
            pool_depth=1.0,
            time_resolution=40.0,
        ),
    )
    assert solved.status is Status.CONVERGED
    assert solved.film_thickness[27, 27] == pytest.approx(centre, rel=0.03)
    assert solved.film_thickness.min() == pytest.approx(rim, rel=0.03)
    assert rim < 0.95 * centre
