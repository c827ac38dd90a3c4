"""Face fluxes: derivatives, steps and upwinding."""

import numpy as np
import pytest

from underfoot.film import Pattern, Upwinding, film_flow, upwinding

VISCOSITY, SPACING = 0.1, 5e-4


def conductance(gap):
    return gap**3 / (12 * VISCOSITY), gap**2 / (4 * VISCOSITY)


def flow(gap, pressure, lean, wall_speed):
    return film_flow(
        gap, pressure, *conductance(gap), spacing=SPACING, wall_speed=wall_speed, lean=lean
    )


@pytest.mark.parametrize("wall_speed", [-0.7, 0.7])
@pytest.mark.parametrize("strength", [None, 0.0, 0.6, 1.0])
def test_derivatives_match_differences(wall_speed, strength):
    rng = np.random.default_rng(7)
    shape = (7, 6)
    gap = 10e-6 * np.exp(rng.normal(size=shape))
    pressure = 1e5 * rng.random(shape)
    lean = None
    if strength is not None:
        faces = (shape[0] - 1, shape[1])
        lean = Upwinding(np.full(faces, strength), rng.normal(size=faces) * 1e-6)
    everything = Pattern(np.ones(shape, bool))
    plain = flow(gap, pressure, lean, wall_speed)
    for field, stencil, step in ((gap, plain.by_gap, 1e-11), (pressure, plain.by_pressure, 1.0)):
        matrix = everything.matrix(everything.rows_of(stencil)).toarray()
        for cell in range(0, gap.size, 5):
            shift = np.zeros(gap.size)
            shift[cell] = step
            moved = [
                flow(
                    gap + (sign * shift.reshape(shape) if field is gap else 0.0),
                    pressure + (sign * shift.reshape(shape) if field is pressure else 0.0),
                    lean,
                    wall_speed,
                ).outflow.ravel()
                for sign in (1, -1)
            ]
            slope = (moved[0] - moved[1]) / (2 * step)
            assert matrix[:, cell] == pytest.approx(slope, rel=1e-4, abs=1e-5 * np.abs(slope).max())


def test_what_leaves_one_cell_enters_the_next():
    rng = np.random.default_rng(8)
    gap = 10e-6 * (1 + rng.random((8, 9)))
    lean = upwinding(gap, np.full(gap.shape, 1e-15), conductance(gap)[0], from_a=True)
    total = flow(gap, 1e5 * rng.random(gap.shape), lean, -0.5)
    assert total.outflow.sum() == pytest.approx(0.0, abs=1e-12 * np.abs(total.outflow).sum())


def test_a_deep_channel_does_not_feed_the_lug():
    """Across a step in the sole the upwinding leaves nothing of the channel's depth."""
    found = []
    for depth in (0.3e-3, 3e-3):
        gap = np.full((6, 3), 5e-6)
        gap[3:] = depth
        lean = Upwinding(np.ones((5, 3)), np.zeros((5, 3)))
        found.append(flow(gap, np.zeros((6, 3)), lean, -0.7).outflow)
    carried = 0.35 * SPACING * 5e-6
    assert np.abs(found[0][1:3]).max() < 0.01 * carried
    assert found[1][1:3] == pytest.approx(found[0][1:3], abs=0.01 * carried)


def test_upwinding_is_second_order_on_smooth_films():
    errors = []
    for cells in (20, 40, 80):
        x = (np.arange(cells) + 0.5) / cells
        gap = np.repeat(10e-6 * (1 + x**2)[:, None], 3, axis=1)
        faces = np.arange(1, cells) / cells
        stiff = np.full(gap.shape, 1e-9)
        lean = upwinding(gap, stiff, conductance(gap)[0], from_a=True)
        carried = flow(gap, np.zeros(gap.shape), lean, -1.0).outflow[:, 1]
        flux = -np.cumsum(carried)[:-1] / (0.5 * SPACING)
        flux = flux[2:-2] - (flux - 10e-6 * (1 + faces**2))[2]
        exact = 10e-6 * (1 + faces**2)[2:-2]
        errors.append(np.abs(flux - exact).max())
    assert np.log2(errors[0] / errors[1]) > 1.6
    assert np.log2(errors[1] / errors[2]) > 1.6
