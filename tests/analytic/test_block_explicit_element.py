"""Element and march against exact facts: patch, rotation, energy gradient, momentum, wave speed.

Each number follows from the equations in docs/physics/micro_finite_elements.md.
"""

import math
from pathlib import Path

import numpy as np
import pytest

from underfoot.block import (
    ExplicitSettings,
    MicroBlock,
    MicroLoading,
    MicroMaterial,
    MicroSurface,
)
from underfoot.block._kernels import loops, names
from underfoot.block.assembly import Assembly, assemble_march
from underfoot.material import RelaxationSpectrum

pytestmark = pytest.mark.slow  # the element loops are compiled on their first use, 20 s each

G, NU = 1.0e6, 0.45
ELASTIC = MicroMaterial.from_poisson(RelaxationSpectrum(G), NU, density=1000.0)
ROUGH = MicroSurface.checkerboard(35.1e-6, 0.5e-3)


def block_at_rest(
    material: MicroMaterial = ELASTIC, *, hourglass: str = "stiffness", precision: str = "double"
) -> Assembly:
    block = MicroBlock(
        size=(1e-3, 0.6e-3, 0.5e-3), elements=(9, 5, 4), bottom_layer=80e-6, roughness=ROUGH
    )
    assembly = assemble_march(
        block,
        MicroSurface(),
        material,
        MicroLoading(),
        ExplicitSettings(hourglass=hourglass, precision=precision),
    )
    assembly.arrays[3][:] += 1.0  # far above the floor
    return assembly


def internal_forces(assembly: Assembly, displacement: np.ndarray) -> np.ndarray:
    """Return the nodal forces of a displacement field, (3, n); leaves the nodes there."""
    n = displacement.shape[1]
    assembly.nodes[0].reshape(3, -1)[:, :n] = displacement
    inverse = assembly.arrays[7]
    kept = inverse.copy()
    inverse[:] = 0.0
    assembly.advance(1)
    inverse[:] = kept
    assembly.nodes[0].reshape(3, -1)[:, :n] = displacement
    return assembly.nodes[2].reshape(3, -1)[:, :n].copy()


def inner_nodes(assembly: Assembly) -> np.ndarray:
    grid = np.arange(assembly.mesh.nodes.shape[1]).reshape(assembly.mesh.shape[::-1])
    return grid[1:-1, 1:-1, 1:-1].ravel()


def test_element_loops_are_made_once_and_never_meet_old_machine_code(tmp_path, monkeypatch):
    monkeypatch.setattr(loops, "HERE", tmp_path)
    for name in ("energy.py", "motion.py"):
        (tmp_path / name).write_text("first = 1\n", encoding="utf-8")
    made = loops.element_loops.__wrapped__()
    path = Path(made.__file__)
    assert path.parent == tmp_path / "__pycache__"
    assert callable(made.advance_many_viscous)
    written = path.stat().st_mtime_ns
    assert loops.element_loops.__wrapped__().__file__ == str(path)
    assert path.stat().st_mtime_ns == written  # Numba's cache asks for the time of the source
    path.write_text(path.read_text()[:1000], encoding="utf-8")  # damaged
    assert callable(loops.element_loops.__wrapped__().advance_many_viscous)
    (tmp_path / "motion.py").write_text("second = 2\n", encoding="utf-8")
    assert loops.element_loops.__wrapped__().__file__ != str(path)


def test_element_loops_without_any_cache_folder_work_and_say_so(tmp_path, monkeypatch):
    (tmp_path / "__pycache__").write_text("a file where the folder should be")
    monkeypatch.setattr(loops, "HERE", tmp_path)
    monkeypatch.setenv("UNDERFOOT_CACHE", str(tmp_path / "__pycache__"))
    with pytest.warns(RuntimeWarning, match="no cache folder can be written") as told:
        made = loops.element_loops.__wrapped__()
    assert told[0].filename == __file__  # who asked for them
    monkeypatch.setattr("underfoot.block.assembly.element_loops", lambda: made)
    assembly = block_at_rest()
    turned = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]) - np.eye(3)
    forces = internal_forces(assembly, turned @ assembly.mesh.nodes)
    assert np.abs(forces).max() < 1e-12 * G * 1e-6 * 1e3


def test_patch_of_distorted_elements_carries_a_homogeneous_strain():
    assembly = block_at_rest()
    h = np.array([[0.05, 0.02, -0.01], [0.03, -0.04, 0.02], [0.01, -0.03, 0.06]])
    forces = internal_forces(assembly, h @ assembly.mesh.nodes)
    inside = np.abs(forces[:, inner_nodes(assembly)]).max()
    assert inside < 1e-13 * np.abs(forces).max() * 10
    # Stress from the outer faces: Cauchy's theorem gives sum of x_i f_j = V P_ij.
    f = np.eye(3) + h
    jac = np.linalg.det(f)
    i1 = np.trace(f.T @ f)
    cofactor = jac * np.linalg.inv(f).T
    a = G * jac ** (-2.0 / 3.0)
    stress = a * f + (ELASTIC.bulk_modulus * (jac - 1.0) - a * i1 / (3.0 * jac)) * cofactor
    volume = assembly.mesh.volume.sum()
    assert np.allclose(forces @ assembly.mesh.nodes.T / volume, stress, rtol=1e-12)


def test_rigid_rotation_is_free_of_force():
    assembly = block_at_rest()
    angle = 0.7
    turn = np.array(
        [
            [math.cos(angle), -math.sin(angle), 0.0],
            [math.sin(angle), math.cos(angle), 0.0],
            [0.0, 0.0, 1.0],
        ]
    )
    forces = internal_forces(assembly, (turn - np.eye(3)) @ assembly.mesh.nodes)
    assert np.abs(forces).max() < 1e-9 * G * 0.1e-3**2


def test_forces_are_the_gradient_of_the_energy():
    assembly = block_at_rest()
    generator = np.random.default_rng(4)
    shape = assembly.mesh.nodes.shape
    state = generator.normal(scale=4e-6, size=shape)
    direction = generator.normal(size=shape)

    def energy(displacement: np.ndarray) -> float:
        internal_forces(assembly, displacement)
        return assembly.state[names.STRAIN] + assembly.state[names.HOURGLASS]

    step = 2e-10
    slope = (energy(state + step * direction) - energy(state - step * direction)) / (2.0 * step)
    exact = float(np.sum(internal_forces(assembly, state) * direction))
    assert exact == pytest.approx(slope, rel=1e-6)


def test_single_precision_follows_double():
    shear = RelaxationSpectrum(G, np.array([0.5 * G]), np.array([1e-5]))
    material = MicroMaterial.from_poisson(shear, NU)
    both = []
    for precision in ("double", "single"):
        assembly = block_at_rest(material, precision=precision)
        field = np.random.default_rng(7).normal(scale=2e-6, size=assembly.mesh.nodes.shape)
        both.append(internal_forces(assembly, field))
    assert np.abs(both[1] - both[0]).max() < 1e-5 * np.abs(both[0]).max()


def test_free_block_keeps_its_momentum():
    assembly = block_at_rest()
    generator = np.random.default_rng(2)
    velocity = assembly.nodes[1].reshape(3, -1)
    n = assembly.mesh.nodes.shape[1]
    free = n - assembly.mesh.shape[0] * assembly.mesh.shape[1]
    velocity[:2, :free] = generator.normal(scale=0.1, size=(2, free))
    # The top holds x and y: take its reaction into the balance of impulse.
    mass = assembly.arrays[8]
    before = (mass[:free] * velocity[:, :free]).sum(axis=1)
    impulse = np.zeros(3)
    for _ in range(60):
        assembly.advance(1)
        impulse += assembly.nodes[2].reshape(3, -1)[:, free:n].sum(axis=1) * assembly.time_step
    after = (mass[:free] * velocity[:, :free]).sum(axis=1)
    scale = float(np.abs(mass[:free] * velocity[:, :free]).sum())
    assert np.abs(after - before - impulse)[:2].max() < 1e-12 * scale


@pytest.mark.parametrize(("axis", "which"), [(0, 1), (2, 0)])
def test_wave_speeds(axis: int, which: int):
    """A standing quarter wave in a periodic column: frequency c / (4 H)."""
    layers, height = 40, 2e-3
    block = MicroBlock(
        size=(0.15e-3, 0.15e-3, height),
        elements=(3, 3, layers),
        bottom_layer=None,
        roughness_layers=1,
        sides="periodic",
    )
    assembly = assemble_march(block, MicroSurface(), ELASTIC, MicroLoading(), ExplicitSettings())
    assembly.arrays[3][:] += 1.0
    z = assembly.mesh.nodes[2]
    assembly.displacement[axis] = 1e-9 * np.cos(0.5 * math.pi * z / height)
    period = 4.0 * height / ELASTIC.wave_speeds[which]
    quarter = 0.25 * period / assembly.time_step
    assembly.advance(math.floor(quarter))
    first = float(assembly.displacement[axis, 0])
    assembly.advance(1)
    second = float(assembly.displacement[axis, 0])
    # The march starts with the speed of half a step before: half a step late.
    crossing = math.floor(quarter) + 0.5 + first / (first - second)
    assert crossing == pytest.approx(quarter, rel=1e-3)


def test_relaxation_of_a_sheared_block_follows_the_spectrum():
    """Eq. 7: stress at a held small shear falls as G(t), for two terms."""
    shear = RelaxationSpectrum(0.4 * G, np.array([0.35 * G, 0.25 * G]), np.array([2e-6, 2e-5]))
    material = MicroMaterial.from_poisson(shear, NU)
    assembly = block_at_rest(material)
    nodes = assembly.mesh.nodes
    field = np.zeros_like(nodes)
    field[0] = 1e-4 * nodes[2]
    assembly.arrays[7][:] = 0.0
    assembly.displacement[:] = field
    steps = 600
    stress = []
    for _ in range(steps):
        # Held: the top's plane is put back where the march sets it to one height.
        assembly.displacement[:] = field
        assembly.advance(1)
        force = assembly.nodes[2].reshape(3, -1)[:, : nodes.shape[1]]
        stress.append(float(force[0] @ nodes[2]) / assembly.mesh.volume.sum())
    dt = assembly.time_step
    times = dt * np.arange(1, steps + 1)
    # A constant strain from t = 0, seen at the end of each step.
    expected = 1e-4 * np.asarray(shear.relaxation_modulus(times))
    assert np.allclose(stress, expected, rtol=1e-3)


def test_bound_on_the_friction_of_scaled_inertia_is_that_of_the_largest_slope():
    """rho h (v s)^2 / (p w) with s = pi R_z / w, the largest slope of a cosine checkerboard."""
    floor = MicroSurface.checkerboard(20e-6, 0.25e-3)
    block = MicroBlock(size=(1e-3, 0.5e-3, 0.5e-3), elements=(16, 8, 4), bottom_layer=80e-6)
    loading = MicroLoading(mean_pressure=2e5, speed=0.4)
    assembly = assemble_march(block, floor, ELASTIC, loading, ExplicitSettings(mass_scaling=3.0))
    slope = math.pi * 20e-6 / 0.25e-3
    exact = 3.0 * 1000.0 * 80e-6 * (0.4 * slope) ** 2 / (2e5 * 0.25e-3)
    assert assembly.impact_friction == pytest.approx(exact, rel=1e-9)
