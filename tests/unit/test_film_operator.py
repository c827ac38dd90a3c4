"""The film's operator: derivatives, conservation, steps in the gap, upwinding, cavities."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from underfoot.film import Cavity, Conductance, Pattern, Upwinding, film_operator, upwinding

VISCOSITY, SPACING = 0.1, 5e-4


def conductance(gap):
    return Conductance(gap**3 / (12 * VISCOSITY), gap**2 / (4 * VISCOSITY))


def operator(gap, speed, lean=None, *, storage=0.0, factor=1.0, spacing=(SPACING, SPACING), **more):
    along = conductance(gap)
    across = Conductance(factor * along.value, factor * along.slope)
    return film_operator(
        gap, along, across, spacing=spacing, speed=speed, storage=storage, upwinding=lean, **more
    )


@pytest.mark.parametrize("speed", [-0.35, 0.35])
@pytest.mark.parametrize("strength", [None, 0.0, 0.6, 1.0])
def test_derivatives_match_differences(speed, strength):
    rng = np.random.default_rng(7)
    shape = (7, 6)
    gap = 10e-6 * np.exp(rng.normal(size=shape))
    pressure = 1e5 * rng.random(shape)
    fraction = rng.random(shape)
    content = gap * rng.random(shape)
    lean = None
    if strength is not None:
        faces = (shape[0] - 1, shape[1])
        lean = Upwinding(np.full(faces, strength), rng.normal(size=faces) * 1e-6)
    given = {"storage": 2.5e-4, "factor": 0.6, "spacing": (5e-4, 3e-4)}
    everything = Pattern(np.ones(shape, bool))

    def imbalance(gap=gap, pressure=pressure, fraction=fraction):
        return operator(gap, speed, lean, **given).imbalance(pressure, fraction, content)

    here = operator(gap, speed, lean, **given)
    fields = {"gap": gap, "pressure": pressure, "fraction": fraction}
    stencils = {
        "gap": (here.by_gap(pressure, fraction), 1e-11),
        "pressure": (here.by_pressure, 1.0),
        "fraction": (here.by_fraction, 1e-4),
    }
    for name, (stencil, step) in stencils.items():
        matrix = everything.matrix(everything.rows_of(stencil)).toarray()
        for cell in range(0, gap.size, 5):
            shift = np.zeros(shape)
            shift.flat[cell] = step
            ahead, behind = (
                imbalance(**{name: fields[name] + sign * shift}).ravel() for sign in (1, -1)
            )
            slope = (ahead - behind) / (2 * step)
            assert matrix[:, cell] == pytest.approx(slope, rel=1e-4, abs=1e-5 * np.abs(slope).max())


def test_what_leaves_one_cell_enters_the_next():
    rng = np.random.default_rng(8)
    gap = 10e-6 * (1 + rng.random((8, 9)))
    lean = upwinding(gap, np.full(gap.shape, 1e-15), conductance(gap).value, from_a=True)
    rough = 1e-7 * rng.random(gap.shape)
    balance = operator(gap, -0.25, lean, roughness_flow=rough)
    total = balance.imbalance(1e5 * rng.random(gap.shape), rng.random(gap.shape))
    assert total.sum() == pytest.approx(0.0, abs=1e-12 * np.abs(total).sum())


@pytest.mark.parametrize("way", [-1, 1])
def test_walls_that_carry_both_ways_carry_what_each_face_has_upstream(way):
    """Without a mean speed roughness alone carries, from the middle to both ends or from both."""
    flat = np.full((6, 2), 10e-6)
    rough = way * np.array([-3.0, -3.0, -3.0, 2.0, 2.0, 2.0])[:, None] * np.ones(2) * 1e-7
    fraction = np.linspace(0.1, 0.6, 6)[:, None] * np.ones(2)
    carried = operator(flat, 0.0, roughness_flow=rough).wall_transport(fraction)
    mean = SPACING * 0.5 * (rough[1:] + rough[:-1])
    upstream = np.where(mean > 0, fraction[:-1], fraction[1:])
    np.testing.assert_allclose(carried, mean * upstream)
    assert (carried[0] * carried[-1] < 0).all()


def test_a_deep_channel_does_not_feed_the_lug():
    """Across a step in the sole the upwinding leaves nothing of the channel's depth."""
    outflows = []
    for depth in (0.3e-3, 3e-3):
        gap = np.full((6, 3), 5e-6)
        gap[3:] = depth
        lean = Upwinding(np.ones((5, 3)), np.zeros((5, 3)))
        outflows.append(operator(gap, -0.35, lean).imbalance(np.zeros((6, 3)), np.ones((6, 3))))
    carried = 0.35 * SPACING * 5e-6
    assert np.abs(outflows[0][1:3]).max() < 0.01 * carried
    assert outflows[1][1:3] == pytest.approx(outflows[0][1:3], abs=0.01 * carried)


def test_upwinding_is_second_order_on_smooth_films():
    errors = []
    for cells in (20, 40, 80):
        x = (np.arange(cells) + 0.5) / cells
        gap = np.repeat(10e-6 * (1 + x**2)[:, None], 3, axis=1)
        faces = np.arange(1, cells) / cells
        stiff = np.full(gap.shape, 1e-9)
        lean = upwinding(gap, stiff, conductance(gap).value, from_a=True)
        carry = operator(gap, -0.5, lean).carry.value[:, 1] / (-0.5 * SPACING)
        errors.append(np.abs(carry - 10e-6 * (1 + faces**2))[2:-2].max())
    assert np.log2(errors[0] / errors[1]) > 1.9
    assert np.log2(errors[1] / errors[2]) > 1.9


@given(st.integers(0, 2**32 - 1), st.sampled_from([-0.4, 0.4]))
def test_a_cavity_passes_on_what_it_receives(seed, speed):
    """In cells that are cavitated the fraction closes the balance to rounding."""
    rng = np.random.default_rng(seed)
    shape = tuple(rng.integers(3, 12, size=2))
    gap = 10e-6 * np.exp(0.5 * rng.normal(size=shape))
    mask = rng.random(shape) < 0.6
    pressure = np.where(mask, 0.0, 1e5 * rng.random(shape))
    content = gap * rng.random(shape)
    balance = operator(gap, speed, storage=SPACING**2 / 10 ** rng.uniform(-5, 0))
    pattern = Pattern(mask | (rng.random(shape) < 0.5))
    rows = pattern.rows_of(balance.by_fraction)
    cavity = Cavity(pattern, rows, pattern.gather(mask))
    fraction = np.where(mask, 0.0, 1.0)
    sent = pattern.gather(-balance.imbalance(pressure, fraction, content))
    fraction += pattern.scatter(cavity.filled_by(sent))
    assert (fraction >= 0).all()
    assert (fraction[~mask] == 1).all()
    left = balance.imbalance(pressure, fraction, content)[mask]
    largest = np.abs(balance.imbalance(pressure, np.where(mask, 0.0, 1.0), content)).max()
    assert np.abs(left).max(initial=0.0) <= 1e-12 * largest
