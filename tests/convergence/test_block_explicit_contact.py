"""Contact of the block against exact and half-space solutions, with refinement."""

import math

import numpy as np
import pytest

from underfoot.block import (
    ExplicitSettings,
    MicroBlock,
    MicroLoading,
    MicroMaterial,
    MicroSurface,
    explicit_sliding,
)
from underfoot.block.assembly import Assembly, assemble_march
from underfoot.block.march import BlockMarch
from underfoot.core import Status, silent
from underfoot.material import RelaxationSpectrum
from underfoot.rough_contact import steady_sliding

pytestmark = pytest.mark.slow  # the element loops are compiled on their first use, 20 s each

G, NU, LENGTH = 1.0e6, 0.45, 0.4e-3
MATERIAL = MicroMaterial.from_poisson(RelaxationSpectrum(G), NU)


def pressed(
    floor: MicroSurface, n: int, pressure: float, settings: ExplicitSettings
) -> tuple[Assembly, np.ndarray]:
    """Return the march at rest under a pressure, and the gap at the nodes, (n, n)."""
    block = MicroBlock(
        size=(LENGTH, LENGTH, LENGTH),
        elements=(n, n, max(4, n // 2)),
        bottom_layer=0.6 * LENGTH / n,
        roughness_layers=1,
        sides="periodic",
    )
    loading = MicroLoading(
        mean_pressure=pressure, speed=0.0, press_time=1e-4, hold_time=5e-5, slide_distance=0.0
    )
    assembly = assemble_march(block, floor, MATERIAL, loading, settings)
    confined = MATERIAL.bulk_modulus + 4.0 / 3.0 * G
    BlockMarch(assembly, loading, LENGTH**2, LENGTH, 100, confined, "", silent).run()
    plane = (n + 1) ** 2
    x, y, z = assembly.mesh.nodes[:, :plane] + assembly.displacement[:, :plane]
    z = assembly.arrays[3] + assembly.displacement[2, :plane]
    gap = (z - floor.height(x, y)).reshape(n + 1, n + 1)[:-1, :-1]
    return assembly, gap


def test_full_contact_stiffness_of_a_wave_is_that_of_the_half_space():
    """p = |q| E* u / 2 (Johnson 1985, 13.2): second order in the element size."""
    wave = 2.0 * math.pi * math.sqrt(2.0) / LENGTH
    stiffness = wave * G / (1.0 - NU)
    floor = MicroSurface.checkerboard(1e-8, LENGTH)
    errors = []
    for n in (8, 16):
        assembly, gap = pressed(
            floor, n, 1.5 * stiffness * 5e-9, ExplicitSettings(penalty_factor=1.0)
        )
        shape = np.cos(2.0 * math.pi * np.arange(n) / n)
        form = np.outer(shape, shape)
        z = assembly.displacement[2, : (n + 1) ** 2].reshape(n + 1, n + 1)[:-1, :-1]
        ratio = -assembly.penalty * np.sum(gap * form) / np.sum(z * form)
        errors.append(abs(ratio / stiffness - 1.0))
    assert errors[1] < 0.04
    assert errors[0] / errors[1] > 3.0


def test_hertz_indentation_and_partial_contact():
    """Mean gap and area against the FFT solver's layer of the same height, same paraboloid."""
    radius, spot = 2e-3, 0.08e-3
    young = 2.0 * G * (1.0 + NU)
    load = 4.0 / 3.0 * young / (1.0 - NU**2) * spot**3 / radius
    floor = MicroSurface("paraboloid", radius=radius, offset=(0.5 * LENGTH, 0.5 * LENGTH))
    x = LENGTH * np.arange(128) / 128
    exact = steady_sliding(
        floor.height(x[:, None], x[None, :]),
        LENGTH / 128,
        young,
        0.0,
        load / LENGTH**2,
        NU,
        layer_thickness=LENGTH,
    )
    # Hertz: the spot's radius (the neighbours at five radii and the layer change it by 0.3 %).
    share = math.pi * spot**2 / LENGTH**2
    assert exact.real_contact_fraction_corrected == pytest.approx(share, rel=0.02)
    _, gap = pressed(floor, 16, load / LENGTH**2, ExplicitSettings(penalty_factor=4.0, cfl=0.3))
    assert np.clip(gap, 0.0, None).mean() == pytest.approx(exact.mean_gap, rel=0.01)
    # Closed nodes count their whole cells: too much by about half a cell all round.
    assert 1.0 < np.mean(gap < 0.0) / share < 1.2


def test_gap_converges_with_the_penalty():
    """Sinking into the contact's springs is inversely proportional to their stiffness."""
    floor = MicroSurface.checkerboard(4e-6, LENGTH)
    gaps = [
        np.clip(pressed(floor, 12, 15e3, ExplicitSettings(penalty_factor=k, cfl=c))[1], 0, None)
        for k, c in ((0.3, 0.6), (1.5, 0.5), (7.5, 0.25))
    ]
    first, second, third = (float(gap.mean()) for gap in gaps)
    # 1/6 where the gap answers in proportion; it is curved here.
    assert 0.0 < (third - second) / (third - first) < 1.0 / 3.0


def test_sliding_friction_and_area_against_the_half_space():
    """Two relaxation terms, 24 elements a wavelength: within 5 % of the FFT solver.

    The half-space gets the block's material: constant K, so E/(1-nu^2) = 4 G (3K + G)/(3K + 4G).
    Closed nodes count whole cells: without their edges the area is that of the half-space.
    """
    shear = RelaxationSpectrum(0.6e6, np.array([0.5e6, 0.4e6]), np.array([3e-5, 1e-4]))
    rubber = MicroMaterial.from_poisson(shear, 0.49, at="instantaneous")
    floor = MicroSurface.checkerboard(35.1e-6, LENGTH)
    block = MicroBlock(
        size=(LENGTH, LENGTH, 0.5 * LENGTH),
        elements=(24, 24, 7),
        bottom_layer=LENGTH / 24,
        roughness_layers=1,
        sides="periodic",
    )
    loading = MicroLoading(
        mean_pressure=100e3,
        speed=1.0,
        slide_distance=1.5 * LENGTH,
        control="load",
        press_time=0.2e-3,
        hold_time=0.15e-3,
    )
    result = explicit_sliding(block, floor, rubber, loading)
    assert result.status is Status.CONVERGED

    def modulus(frequency: np.ndarray) -> np.ndarray:
        g, k = shear.complex_modulus(frequency), rubber.bulk_modulus
        return 3.0 * g * (3.0 * k + g) / (3.0 * k + 4.0 * g)

    x = LENGTH * np.arange(96) / 96
    exact = steady_sliding(
        floor.height(x[:, None], x[None, :]), LENGTH / 96, modulus, 1.0, 100e3, 0.5
    )
    # The wavelength after the first half one, in which rubber and speed settle.
    last = result.distance > 0.5 * LENGTH
    normal = result.normal_force[last].mean()
    cof = result.shear_force[last].mean() / normal
    assert cof == pytest.approx(exact.cof_hysteresis, rel=0.05)
    nodal, corrected = (
        area[last].mean() / LENGTH**2 / exact.real_contact_fraction_corrected
        for area in (result.real_contact_area, result.corrected_contact_area)
    )
    assert 1.1 < nodal < 1.3
    assert corrected == pytest.approx(1.0, abs=0.05)
