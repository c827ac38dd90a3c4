"""Steps of both marches of a block: times of load and floor, decays, contact where nodes went."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from underfoot.block import (
    ExplicitSettings,
    MicroBlock,
    MicroLoading,
    MicroMaterial,
    MicroSurface,
    march,
)
from underfoot.block._kernels import energy, generate, motion
from underfoot.block._kernels import names as at
from underfoot.block.assembly import assemble_march
from underfoot.block.compliance import CondensedBlock
from underfoot.block.condensed import CondensedMarch, Moment
from underfoot.block.march import BlockMarch
from underfoot.block.report_g1 import FLOOR_ROUGHNESS
from underfoot.core.catalogue import Catalogue
from underfoot.material import RelaxationSpectrum

STEP = 1e-3
ELASTIC = RelaxationSpectrum(1e6, np.array([]), np.array([]))


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
    made = assemble_march(block, MicroSurface(), rubber, MicroLoading(), ExplicitSettings())
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


def element(spectrum, seed=0):
    """Return the arrays of a block of rough elements, moved at random by a tenth of one."""
    block = MicroBlock(
        size=(0.4e-3, 0.4e-3, 0.5e-3), elements=(4, 4, 4), bottom_layer=0.1e-3,
        roughness=MicroSurface.checkerboard(20e-6, 0.4e-3, offset=(0.1e-3, 0.2e-3)),
    )  # fmt: skip
    made = assemble_march(
        block, MicroSurface(), MicroMaterial(spectrum, 2e7), MicroLoading(), ExplicitSettings()
    )
    moved = 1e-5 * np.random.default_rng(seed).normal(size=made.nodes[0].size)
    return made, moved


def energies(made, u, history=None, terms=None):
    state = np.zeros(at.STATE_SIZE)
    given = made.history if history is None else history
    terms = made.terms if terms is None else terms
    arrays = (made.arrays, made.constants, given, made.control, terms, False, state)
    plain(energy.element_energies)(u, *arrays)
    return state


def test_energy_of_a_homogeneous_strain_is_that_of_its_formula():
    """V (G/2 (J^(-2/3) I1 - 3) + K/2 (J - 1)^2), without hourglass, at any shear."""
    made, _ = element(ELASTIC)
    strain = np.array([[0.1, 0.04, -0.03], [0.02, -0.06, 0.05], [-0.07, 0.01, 0.08]])
    u = np.zeros((3, made.nodes[0].size // 3))
    u[:, : made.mesh.nodes.shape[1]] = strain @ made.mesh.nodes
    state = energies(made, u.ravel())
    gradient = np.eye(3) + strain
    jac, first = np.linalg.det(gradient), np.sum(gradient**2)
    density = 0.5 * 1e6 * (jac ** (-2 / 3) * first - 3) + 0.5 * 2e7 * (jac - 1) ** 2
    assert state[at.STRAIN] == pytest.approx(made.mesh.volume.sum() * density, rel=1e-9)
    assert state[at.HOURGLASS] < 1e-12 * state[at.STRAIN]
    assert state[at.LEAST_J] == pytest.approx(jac)


def test_what_a_term_loses_is_the_square_of_what_it_has_not_followed():
    """From rest, Q = 0: rate V b g^2 S:S / (2 G), with S = G0 J^(-2/3) (I - I1 / 3 C^-1)."""
    made, _ = element(RelaxationSpectrum(1e6, np.array([2e6]), np.array([0.01])))
    strain = np.array([[0.1, 0.04, -0.03], [0.02, -0.06, 0.05], [-0.07, 0.01, 0.08]])
    u = np.zeros((3, made.nodes[0].size // 3))
    u[:, : made.mesh.nodes.shape[1]] = strain @ made.mesh.nodes
    state = energies(made, u.ravel())
    gradient = np.eye(3) + strain
    right = gradient.T @ gradient
    stress = np.eye(3) - np.trace(right) / 3 * np.linalg.inv(right)
    stress *= 3e6 * np.linalg.det(gradient) ** (-2 / 3)
    lost = 100.0 * np.sum((2 / 3 * stress) ** 2) / (2 * 2e6)
    assert state[at.LOSS_RATE] == pytest.approx(made.mesh.volume.sum() * lost, rel=1e-9)


@pytest.mark.parametrize(("terms", "viscous"), generate.VARIANTS)
def test_written_loops_push_nodes_along_the_gradient_of_the_energy(terms, viscous):
    """With decays of 1 and weights of 0 each variant is the elastic one."""
    made, u = element(ELASTIC)
    loops: dict[str, Any] = {
        "njit": lambda **_: lambda kernel: kernel, "prefer_wide_registers": lambda: None,
    }  # fmt: skip
    exec(generate._element_function(terms, viscous), loops)
    force = np.zeros_like(u)
    stride, lanes = u.size // 3, generate.LANES
    chunk = np.arange(lanes)
    relaxed = np.tile([1.0, 0.0], {"none": 0, "one": 1, "many": 2}[terms])
    parameters = np.concatenate([made.parameters[: len(generate.PARAMETERS)], relaxed])
    for c, constants in enumerate(made.constants):
        work, history = made.work.copy(), np.zeros((40, lanes)).ravel()
        nodes = c * lanes + chunk + made.arrays[0][:, None]
        for axis in range(3):
            work[8 * axis * lanes : 8 * (axis + 1) * lanes] = u[axis * stride + nodes].ravel()
        loops[generate.kernel_name(terms, viscous)](work, constants, history, parameters)
        for axis in range(3):
            part = work[8 * axis * lanes : 8 * (axis + 1) * lanes]
            np.add.at(force, axis * stride + nodes.ravel(), part)

    def stored(moved):
        state = energies(made, moved)
        return state[at.STRAIN] + state[at.HOURGLASS]

    chosen = np.random.default_rng(1).choice(made.mesh.nodes.shape[1], 3, replace=False)
    for one in (axis * stride + node for axis in range(3) for node in chosen):
        step = np.zeros_like(u)
        step[one] = 1e-9
        slope = (stored(u + step) - stored(u - step)) / 2e-9
        assert force[one] == pytest.approx(slope, abs=1e-5 * np.abs(force).max())


class Marched:
    """An explicit march whose floor and clock move as they should; nothing is computed."""

    def __init__(self, step, speed=0.0, goal=0.0):
        self.assembly = SimpleNamespace(state=np.zeros(at.STATE_SIZE), time_step=step)
        self.loading = SimpleNamespace(speed=speed, slide_distance=goal)
        self.wavelength, self.samples_per_wavelength = 1e-3, 20
        self.counts, self.output, self.snapshots = list[int](), None, 0

    def _sample(self, count):
        self.counts.append(count)
        self.assembly.state[at.TIME] += count * self.assembly.time_step
        self.assembly.state[at.SLID] += count * self.assembly.time_step * self.loading.speed

    def progress(self, *_):
        pass


def test_a_stage_is_sampled_evenly_and_ends_at_its_time():
    made: Any = Marched(1e-6)
    BlockMarch._until_time(made, "press", 103.2e-6, 10e-6)
    assert made.counts == [10] * 10 + [3]


def test_a_slide_is_sampled_evenly_and_ends_with_the_step_that_is_there():
    """50 um a sample at 0.5 m/s are 100 steps of 1 us; 120.1 um are 241, and one for rounding."""
    made: Any = Marched(1e-6, speed=0.5, goal=0.1201e-3)
    BlockMarch._slide(made)
    assert made.counts[:2] == [100, 100]
    assert sum(made.counts[2:]) in (41, 42)


def test_a_picture_of_a_block_at_rest_touches_the_floor(tmp_path, monkeypatch):
    made, _ = element(ELASTIC)
    drawn = {}

    class Mesh:
        def __init__(self, points, cells, **data):
            drawn.update(points=points, cells=cells[0][1], **data)

        def write(self, part, **_):
            part.touch()

    monkeypatch.setattr(march, "optional_module", lambda *_: SimpleNamespace(Mesh=Mesh))
    march.snapshot(tmp_path / "block.vtu", made)
    points = drawn["points"]
    assert points[:, 2].min() == pytest.approx(0.0, abs=1e-12)
    assert np.ptp(points, axis=0) == pytest.approx(np.ptp(made.mesh.nodes, axis=1))
    # cells of right-handed corners that fill the block
    sides = points[drawn["cells"]]
    edges = sides[:, [1, 3, 4]] - sides[:, :1]
    assert (np.linalg.det(edges) > 0).all()
    assert drawn["cell_data"]["volume_ratio"][0] == pytest.approx(1.0)


def test_roughness_of_the_micro_model_is_that_of_the_catalogue():
    catalogue = Catalogue.load()
    for name, height in FLOOR_ROUGHNESS.items():
        entry = catalogue.entry("floor", f"ceramic_{name}_g1")
        assert entry.sourced_value("roughness.rz", "m").value == pytest.approx(height)
