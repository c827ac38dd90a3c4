"""Condensed block against closed forms and against the half-space solver."""

from dataclasses import replace

import numpy as np
import pytest

from underfoot.block import (
    MicroBlock,
    MicroLoading,
    MicroMaterial,
    MicroSurface,
    condensed_block,
    condensed_poisson_ratio,
    condensed_sliding,
)
from underfoot.block._kernels.hexahedron import stiffness_matrices
from underfoot.material import RelaxationSpectrum, power_law_spectrum, young_from_shear
from underfoot.rough_contact import steady_sliding
from underfoot.surface import checkerboard

CUBE = np.array(
    [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)],
    dtype=float,
)


def rubber(shear, nu=0.499):
    g = shear.equilibrium_modulus
    return MicroMaterial(shear, 2.0 * g * (1.0 + nu) / (3.0 * (1.0 - 2.0 * nu)))


def distorted_elements(count=5):
    return CUBE + 0.25 * np.random.default_rng(3).uniform(-1, 1, (count, 8, 3))


def test_rigid_motion_costs_no_energy():
    corners = distorted_elements()
    stiffness, _ = stiffness_matrices(corners, 1.0, 500.0)
    for k, x in zip(stiffness, corners, strict=True):
        assert np.allclose(k, k.T, atol=1e-10)
        for axis in range(3):
            turn = np.zeros((8, 3))
            turn[:, (axis + 1) % 3] = -x[:, (axis + 2) % 3]
            turn[:, (axis + 2) % 3] = x[:, (axis + 1) % 3]
            move = np.zeros((8, 3))
            move[:, axis] = 1.0
            for u in (turn, move):
                assert np.abs(k @ u.ravel()).max() < 1e-10 * np.abs(k).max()
        assert np.linalg.eigvalsh(k)[6] > 1e-3  # six rigid motions and no other free one


def test_uniform_strain_has_its_exact_energy():
    corners = distorted_elements()
    shear, bulk = 0.7, 90.0
    stiffness, _ = stiffness_matrices(corners, shear, bulk)
    gradient = np.random.default_rng(5).uniform(-1, 1, (3, 3))
    strain = 0.5 * (gradient + gradient.T)
    trace = np.trace(strain)
    deviator = strain - trace / 3.0 * np.eye(3)
    density = shear * np.sum(deviator**2) + 0.5 * bulk * trace**2
    for k, x in zip(stiffness, corners, strict=True):
        u = (x @ gradient.T).ravel()
        assert 0.5 * u @ k @ u == pytest.approx(density * volume_of(x), rel=1e-12)


def volume_of(x):
    """Volume of a trilinear hexahedron by 3 x 3 x 3 Gauss points."""
    signs = 2.0 * CUBE - 1.0
    total = 0.0
    points, weights = np.polynomial.legendre.leggauss(3)
    for i, a in enumerate(points):
        for j, b in enumerate(points):
            for k, c in enumerate(points):
                t = np.array([a, b, c])
                one = 1.0 + signs * t
                local = np.stack(
                    [
                        signs[:, m] * one[:, (m + 1) % 3] * one[:, (m + 2) % 3] / 8.0
                        for m in range(3)
                    ]
                )
                total += weights[i] * weights[j] * weights[k] * np.linalg.det(local @ x)
    return total


def test_flat_block_between_periodic_sides_is_compressed_uniaxially():
    shear = RelaxationSpectrum(0.44e6)
    material = rubber(shear)
    block = MicroBlock(
        size=(0.2e-3, 0.2e-3, 0.5e-3), elements=(4, 4, 5), bottom_layer=None, sides="periodic"
    )
    found = condensed_sliding(block, MicroSurface(), material, MicroLoading(slide_distance=0.0))
    confined = material.bulk_modulus + 4.0 / 3.0 * 0.44e6
    assert -found.height[-1] == pytest.approx(160e3 * 0.5e-3 / confined, rel=1e-9)
    assert found.real_contact_area[-1] == pytest.approx(block.nominal_area, rel=1e-12)
    assert found.normal_force[-1] == pytest.approx(160e3 * block.nominal_area, rel=1e-12)


def test_held_load_creeps_to_the_relaxed_height():
    shear = RelaxationSpectrum(1.0e6, np.array([2.0e6, 1.0e6]), np.array([1e-4, 1e-3]))
    block = MicroBlock(
        size=(0.2e-3, 0.2e-3, 0.5e-3), elements=(2, 2, 4), bottom_layer=None, sides="periodic"
    )
    floor = MicroSurface()
    loading = MicroLoading(slide_distance=0.0, press_time=1e-6, hold_time=0.1)
    soft = condensed_sliding(block, floor, rubber(RelaxationSpectrum(1.0e6)), loading)
    creeping = condensed_sliding(block, floor, rubber(shear), loading)
    assert creeping.height[-1] == pytest.approx(soft.height[-1], rel=1e-6)
    assert creeping.height[15] == pytest.approx(0.25 * soft.height[-1], rel=0.01)  # E(0) = 4 E_inf


def test_wave_in_full_contact_has_the_exact_hysteresis():
    # mean shear = q^2 a^2 Im E*(q v) / 4 for a half-space pressed flat onto a wave
    shear = RelaxationSpectrum(0.5e6, np.array([1.0e6]), np.array([5e-5]))
    wave, amplitude, speed = 0.4e-3, 2e-6, 1.0
    block = MicroBlock(
        size=(wave, wave / 12, 0.5e-3),
        elements=(24, 2, 12),
        bottom_layer=wave / 24,
        sides="periodic",
    )
    floor = MicroSurface("wave", 2.0 * amplitude, wave)
    loading = MicroLoading(speed=speed, slide_distance=4 * wave, control="load", mean_pressure=1e6)
    found = condensed_sliding(block, floor, rubber(shear), loading)
    q = 2.0 * np.pi / wave
    modulus = young_from_shear(shear, 0.499).complex_modulus(q * speed) / (1.0 - 0.499**2)
    assert found.averages is not None
    assert found.averages.real_contact_fraction == pytest.approx(1.0)
    exact = 0.25 * (q * amplitude) ** 2 * modulus.imag / 1e6
    assert found.averages.cof_hysteresis == pytest.approx(exact, rel=0.01)


@pytest.mark.slow
def test_periodic_cell_agrees_with_the_half_space():
    # loss without slow terms, so that the march reaches the steady state
    shear = power_law_spectrum(0.4e6, 0.12, longest_time=1e-4, terms_per_decade=1)
    wave, rz, n = 0.4e-3, 35.1e-6, 20
    block = MicroBlock(
        size=(wave, wave, 0.5e-3), elements=(n, n, 10), bottom_layer=wave / n, sides="periodic"
    )
    loading = MicroLoading(speed=1.0, slide_distance=5 * wave, control="load")
    found = condensed_sliding(block, MicroSurface.checkerboard(rz, wave), rubber(shear), loading)
    floor = checkerboard(64, wave / 64, rz, wave)
    exact = steady_sliding(
        floor.heights, floor.spacing, young_from_shear(shear, 0.499), 1.0, 160e3, 0.499
    )
    assert found.averages is not None
    assert found.averages.scatter < 2e-4
    assert found.averages.cof_hysteresis == pytest.approx(exact.cof_hysteresis, rel=0.05)
    area = exact.real_contact_fraction_corrected
    assert found.averages.real_contact_fraction_corrected == pytest.approx(area, rel=0.05)


def test_sliding_without_loss_has_no_mean_shear():
    block = MicroBlock(elements=(20, 13, 7), roughness=MicroSurface.checkerboard(35.1e-6, 0.5e-3))
    floor = MicroSurface.checkerboard(35.1e-6, 0.4e-3)
    material = rubber(RelaxationSpectrum(0.5e6))
    found = condensed_sliding(block, floor, material, MicroLoading(slide_distance=0.8e-3))
    assert found.averages is not None
    assert abs(found.averages.cof_hysteresis) < 1e-4
    assert found.averages.cof_absolute > 0.02  # it swings all the same


def test_both_factorisations_give_one_symmetric_compliance(monkeypatch):
    block = MicroBlock(elements=(8, 5, 5), roughness=MicroSurface.checkerboard(20e-6, 0.5e-3))
    fast = condensed_block(block, 0.499, sideways=True)
    monkeypatch.setenv("UNDERFOOT_SPARSE", "superlu")
    plain = condensed_block(block, 0.499, sideways=True)
    assert fast.unit_vector_compliance is not None
    assert plain.unit_vector_compliance is not None
    both = fast.unit_vector_compliance, plain.unit_vector_compliance
    assert np.abs(both[0] - both[1]).max() < 1e-11 * np.abs(both[1]).max()
    scale = np.abs(plain.unit_compliance).max()
    assert max(fast.asymmetry, plain.asymmetry) < 1e-11
    assert np.abs(fast.unit_compliance - plain.unit_compliance).max() < 1e-11 * scale
    assert np.linalg.eigvalsh(plain.unit_compliance)[0] > 0.0


@pytest.mark.slow
def test_sideways_motion_lowers_the_swing_of_shear_and_makes_no_friction():
    # explicit finite elements at this roughness: mean |shear| 15 % below the vertical block's
    material = rubber(RelaxationSpectrum(0.59e6))
    ratio = {}
    for part in (0.1, 1.0):
        block = MicroBlock(
            elements=(14, 9, 6), roughness=MicroSurface.checkerboard(35.1e-6 * part, 0.5e-3)
        )
        floor = MicroSurface.checkerboard(35.1e-6 * part, 0.4e-3)
        pressed = MicroLoading(slide_distance=0.4e-3, mean_pressure=160e3 * part)
        found = [
            condensed_sliding(condensed_block(block, 0.499, sideways=s), floor, material, pressed)
            for s in (False, True)
        ]
        vertical, free = (result.averages for result in found)
        assert vertical is not None
        assert free is not None
        assert abs(free.cof_hysteresis) < 1e-4
        ratio[part] = free.cof_absolute / vertical.cof_absolute
    assert ratio[0.1] == pytest.approx(1.0, abs=0.03)  # an effect of second order
    assert 0.75 < ratio[1.0] < 0.9


@pytest.mark.slow
def test_explicit_finite_elements_agree_where_strains_are_small():
    # two formulations of the element and of the march; roughness and pressure a tenth of the
    # report's, where finite strain plays no part
    from underfoot.block import ExplicitSettings, explicit_sliding

    block = MicroBlock(elements=(18, 12, 6), roughness=MicroSurface.checkerboard(3.51e-6, 0.5e-3))
    floor = MicroSurface.checkerboard(3.51e-6, 0.4e-3)
    material = rubber(RelaxationSpectrum(0.59e6), 0.49)
    loading = MicroLoading(speed=0.5, slide_distance=0.4e-3, mean_pressure=16e3, press_time=0.6e-3)
    quick = condensed_sliding(block, floor, material, loading).averages
    settings = ExplicitSettings(mass_scaling="auto")
    full = explicit_sliding(
        block, floor, material, replace(loading, slide_distance=0.41e-3), settings
    ).averages
    assert quick is not None
    assert full is not None
    assert quick.mean_pressure == pytest.approx(full.mean_pressure, rel=0.01)
    assert quick.cof_absolute == pytest.approx(full.cof_absolute, rel=0.03)
    assert quick.area_per_force == pytest.approx(full.area_per_force, rel=0.03)


@pytest.mark.parametrize("nu", [0.3, 0.45, 0.499])
def test_moduli_of_a_poisson_ratio_are_those_of_engineering(nu):
    """K, nu and the confined modulus E (1 - nu) / ((1 + nu) (1 - 2 nu)) go together."""
    shear = RelaxationSpectrum(0.44e6, np.array([0.15e6]), np.array([40.0]))
    material = MicroMaterial.from_poisson(shear, nu)
    assert condensed_poisson_ratio(material) == pytest.approx(nu, rel=1e-12)
    young = 2.0 * 0.44e6 * (1.0 + nu)
    assert material.bulk_modulus == pytest.approx(young / (3.0 * (1.0 - 2.0 * nu)), rel=1e-12)
    block = MicroBlock(
        size=(0.2e-3, 0.2e-3, 0.5e-3), elements=(2, 2, 5), bottom_layer=None, sides="periodic"
    )
    loading = MicroLoading(slide_distance=0.0, press_time=1e-3, hold_time=1e4)
    found = condensed_sliding(block, MicroSurface(), material, loading)
    confined = young * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu))
    assert -found.height[-1] == pytest.approx(160e3 * 0.5e-3 / confined, rel=1e-6)
