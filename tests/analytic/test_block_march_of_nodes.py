"""Steps of both marches of a block: times of load and floor, decays, contact where nodes went."""

import numpy as np
import pytest

from underfoot.block import ExplicitSettings, MicroBlock, MicroLoading, MicroMaterial, MicroSurface
from underfoot.block._kernels import motion
from underfoot.block._kernels import names as at
from underfoot.block.assembly import assembled
from underfoot.block.compliance import CondensedBlock
from underfoot.block.condensed import CondensedMarch, Moment
from underfoot.material import RelaxationSpectrum

STEP = 1e-3


def plain(kernel):
    """Return a kernel as it is written."""
    return getattr(kernel, "py_func", kernel)


def moved(time, **control):
    """Return the state after a plate of 2 kg over four weightless nodes moved by a step."""
    state, numbers = np.zeros(at.STATE_SIZE), np.zeros(at.CONTROL_SIZE)
    given = {"COLUMNS": 2, "ROWS": 2, "LAYERS": 1, "DT": STEP, "PLATE_MASS": 2.0, **control}
    for name, value in given.items():
        numbers[getattr(at, name)] = value
    state[at.TIME] = time
    none = np.zeros(0)
    mesh = (*(None,) * 7, none, none, np.zeros(1), None, None)
    plain(motion.move)((np.zeros(12), np.zeros(12), np.zeros(12)), mesh, state, numbers, False)
    return state


@pytest.mark.parametrize(("share", "loaded"), [(0.0, 0.0), (0.5, 0.5), (1.0, 1.0), (1.6, 1.0)])
def test_a_load_grows_until_its_time_and_then_stays(share, loaded):
    rise = 20 * STEP
    state = moved(share * rise, FREE=1.0, LOAD=3.0, LOAD_TIME=rise)
    assert state[at.TOP_SPEED] == pytest.approx(-STEP * loaded * 3.0 / 2.0, abs=1e-15)
    assert plain(motion._smooth)(share) == pytest.approx(loaded)


def test_the_floor_slides_by_the_speed_in_the_middle_of_each_step():
    """A ramp takes the floor half as far as its speed would: the middles' sum is exact."""
    ramp, speed = 5 * STEP, 0.4
    ways = [
        moved(k * STEP, SPEED=speed, RAMP=ramp, SLIDE_START=2 * STEP)[at.LAST_STEP]
        for k in range(9)
    ]
    assert ways[:2] == [0.0, 0.0]
    assert sum(ways[2:7]) == pytest.approx(0.5 * ramp * speed, rel=1e-12)
    assert ways[7:] == pytest.approx([STEP * speed] * 2)
    assert (np.diff(ways[1:8]) > 0).all()


def test_terms_of_an_explicit_block_decay_by_their_own_times():
    spectrum = RelaxationSpectrum(1e6, np.array([2e6, 0.0, 1e6]), np.array([1e-4, 1e-2, 5.0]))
    block, rubber = MicroBlock(elements=(4, 4, 6)), MicroMaterial(spectrum, 1e9)
    made = assembled(block, MicroSurface(), rubber, MicroLoading(), ExplicitSettings())
    # a term without modulus has no history
    assert made.terms == pytest.approx(np.array([[2e6, 1e4], [1e6, 0.2]]))
    assert made.parameters[5:7] == pytest.approx([4e6, 1e9])
    decay = np.exp(-made.time_step / np.array([1e-4, 5.0]))
    assert made.parameters[7::2] == pytest.approx(decay, rel=1e-12)
    assert made.parameters[8::2] == pytest.approx([0.5, 0.25] * (1 - decay), rel=1e-6)


def test_nodes_that_move_sideways_press_where_the_floor_is_under_them():
    """Forces along the floor's normal at the new places; a node in the air bears none."""
    generator, count = np.random.default_rng(4), 6
    points = np.column_stack(
        [np.linspace(0, 0.35e-3, count), np.linspace(0, 0.1e-3, count), np.zeros(count)]
    )
    root = generator.normal(size=(3 * count, 3 * count))
    held = np.where(np.arange(3 * count) == 0, 1e-6, 1.0)  # the first hardly goes along x
    compliance = np.outer(held, held) * (root @ root.T / (3 * count) + 2 * np.eye(3 * count))
    compliance = compliance.reshape(3, count, 3, count)
    made = CondensedBlock(
        MicroBlock(elements=(5, 5, 4)), 0.49, points, np.full(count, 1e-9), (count, 1),
        compliance[2, :, 2, :], 0.0, compliance,
    )  # fmt: skip
    floor = MicroSurface.checkerboard(20e-6, 0.4e-3)
    glassy = RelaxationSpectrum(1.0, np.array([1.0]), np.array([1.0]))
    march = CondensedMarch(made, MicroMaterial(glassy, 1e3), floor)
    load = 1.5e-5
    push, drag, *_ = march.step(Moment(1e-9, 0.03e-3, load))
    there = points.T + march.displacement
    h, slope, across = floor.height_and_slope(there[0] + 0.03e-3, there[1])
    gap = there[2] + march.height - h
    touching = march.active
    assert 1 < touching.sum() < count
    assert np.abs(gap[touching]).max() < 1e-4 * 20e-6
    assert gap[~touching].min() > 0
    # what moves the nodes are the forces on them, each normal to the floor
    pushed = np.linalg.solve(compliance.reshape(3 * count, -1), 2.0 * march.displacement.ravel())
    along, aside, up = pushed.reshape(3, count)
    assert up.sum() == pytest.approx(load, rel=1e-6)
    assert push == pytest.approx(load, rel=1e-6)
    assert slope @ up == pytest.approx(drag, rel=1e-3)
    assert along[1:] == pytest.approx((-slope * up)[1:], abs=1e-3 * load)
    assert aside == pytest.approx(-across * up, abs=1e-3 * load)
    assert march.unsettled < 1e-5
