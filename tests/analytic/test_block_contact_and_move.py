"""Contact and move of the explicit block on a few nodes: forces are gradients of energies."""

import numpy as np
import pytest

from underfoot.block._kernels import motion
from underfoot.block._kernels import names as at
from underfoot.block.inputs import MicroSurface

STATE, CONTROL = at.STATE_SIZE, at.CONTROL_SIZE


def plain(kernel):
    """Return a kernel as it is written: the parts that it calls stay compiled."""
    return getattr(kernel, "py_func", kernel)


FLOORS = {
    "wave": MicroSurface("wave", 20e-6, 0.4e-3),
    "cosine": MicroSurface.checkerboard(20e-6, 0.4e-3),
}


@pytest.mark.parametrize("form", FLOORS)
def test_the_push_of_the_floor_is_the_gradient_of_its_energy(form):
    generator, count = np.random.default_rng(3), 5
    x, y = generator.uniform(0, 0.4e-3, (2, count))
    z = FLOORS[form].height(x, y) - generator.uniform(1e-6, 3e-6, count)
    z[-1] += 20e-6  # one is in the air
    number, numbers, coefficients = FLOORS[form].kernel_arrays()
    floor = (number, numbers, coefficients, 1.0)
    area, stiffness = np.full(count, 1e-10), generator.uniform(1e3, 2e3, count)

    def pushed(u):
        state, control = np.zeros(STATE), np.zeros(CONTROL)
        f = np.zeros(3 * count)
        mesh = (None, x, y, z, area, stiffness, np.zeros(count), *(None,) * 4, np.ones((3, count)))
        plain(motion.contact)((u, np.zeros(3 * count), f), mesh, floor, state, control)
        return state, f

    state, force = pushed(np.zeros(3 * count))
    assert state[at.CONTACT_ENERGY] > 0
    assert state[at.AREA] == pytest.approx(4e-10)
    step, slopes = 1e-11, []
    for one in np.eye(3 * count):
        above, below = (pushed(sign * step * one)[0][at.CONTACT_ENERGY] for sign in (1, -1))
        slopes.append((above - below) / (2 * step))
    # internal forces point along the gradient; up is away from the floor
    np.testing.assert_allclose(force, slopes, atol=1e-4 * np.abs(force).max())
    assert np.all(force[2 * count : 3 * count - 1] < 0)
    assert state[at.NORMAL] == pytest.approx(-force[2 * count :].sum())
    assert state[at.SHEAR] == pytest.approx(force[:count].sum())


def test_free_nodes_are_accelerated_by_their_own_mass_and_the_top_in_one_piece():
    columns, rows, layers = 3, 2, 2
    plane = columns * rows
    stride, dt, top_mass, load = plane * layers, 1e-3, 0.4, 2.0
    generator = np.random.default_rng(5)
    u, v, f = generator.normal(size=(3, 3 * stride))
    v[2 * stride + plane :] = 0.0
    mass = generator.uniform(1, 2, plane)
    state, control = np.zeros(STATE), np.zeros(CONTROL)
    for name, value in (("COLUMNS", columns), ("ROWS", rows), ("LAYERS", layers), ("DT", dt),
                        ("FREE", 1.0), ("LOAD", load), ("PLATE_MASS", 0.1)):  # fmt: skip
        control[getattr(at, name)] = value
    mesh = (*(None,) * 7, 1 / mass, mass, np.array([top_mass]), None, None)
    before = [each.copy() for each in (u, v, f)]
    plain(motion.move)((u, v, f), mesh, state, control, True)
    kinetic = 0.0
    for axis in range(3):
        low = slice(axis * stride, axis * stride + plane)
        speed = before[1][low] - dt * before[2][low] / mass
        np.testing.assert_allclose(v[low], speed, rtol=1e-9)
        np.testing.assert_allclose(u[low], before[0][low] + dt * speed, rtol=1e-9)
        kinetic += 0.5 * np.sum(mass * before[1][low] * speed)
    assert state[at.KINETIC] == pytest.approx(kinetic)  # the top stood still
    reaction = before[2][2 * stride + plane :].sum()
    falls = -dt * (reaction + load) / (0.1 + top_mass)
    assert state[at.TOP_SPEED] == pytest.approx(falls)
    np.testing.assert_allclose(u[2 * stride + plane :], dt * falls)
