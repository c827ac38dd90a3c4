"""Generalised Maxwell spectra against their closed forms."""

from itertools import pairwise

import numpy as np
import pytest

from underfoot.core import InputError, content_hash
from underfoot.material import (
    Elastomer,
    RelaxationSpectrum,
    bulk_modulus,
    plane_strain_modulus,
    poisson_ratio_from_moduli,
    power_law_spectrum,
    reduce_spectrum,
    report_elastomer,
    shear_from_young,
    shear_modulus,
    single_exponential_spectrum,
    young_from_shear,
    youngs_modulus_from_shear,
)

THREE = RelaxationSpectrum(1e6, np.array([5e6, 2e6, 1e7]), np.array([2e-3, 0.7, 110.0]))


def test_standard_linear_solid():
    solid = RelaxationSpectrum(2e6, [6e6], [0.5])
    # At w tau = 1: E' = E_inf + E_1 / 2, E'' = E_1 / 2.
    assert solid.complex_modulus(2.0) == pytest.approx(5e6 + 3e6j, rel=1e-14)
    # Peak of tan delta: w = sqrt(E_inf / E_0) / tau, (E_0 - E_inf) / (2 sqrt(E_0 E_inf)).
    peak = np.sqrt(2.0 / 8.0) / 0.5
    assert solid.loss_tangent(peak) == pytest.approx(6.0 / (2.0 * np.sqrt(16.0)), rel=1e-12)
    assert solid.relaxation_modulus(0.5 * np.log(2.0)) == pytest.approx(5e6, rel=1e-14)


def test_limits():
    assert THREE.complex_modulus(0.0) == 1e6
    assert THREE.complex_modulus(np.inf) == THREE.instantaneous_modulus == 18e6
    assert THREE.relaxation_modulus(0.0) == 18e6
    assert THREE.relaxation_modulus(np.inf) == 1e6
    # First orders: E'' = w sum E_i tau_i for slow, sum E_i / tau_i / w for fast motion.
    assert THREE.loss_modulus(1e-8) == pytest.approx(1e-8 * (1e4 + 1.4e6 + 1.1e9), rel=1e-10)
    assert THREE.loss_modulus(1e9) == pytest.approx((2.5e9 + 2e6 / 0.7 + 1e7 / 110) / 1e9, rel=1e-9)
    assert np.all(np.isfinite(THREE.complex_modulus([1e-300, 1e300, -np.inf])))


def test_transform_of_the_relaxation_modulus():
    """E*(w) = E_0 + int E'(t) exp(-i w t) dt, integrated numerically."""
    from scipy.integrate import quad

    w = 3.0

    def slope(t):
        return -np.sum(
            THREE.term_moduli / THREE.relaxation_times * np.exp(-t / THREE.relaxation_times)
        )

    pieces = [0.0, 0.002, 0.02, 0.2, 2.0, 20.0, 200.0, 2000.0]
    total = THREE.instantaneous_modulus + 0j
    for a, b in pairwise(pieces):
        total += quad(slope, a, b, weight="cos", wvar=w, limit=500)[0]
        total -= 1j * quad(slope, a, b, weight="sin", wvar=w, limit=500)[0]
    assert THREE.complex_modulus(w) == pytest.approx(total, rel=1e-6)


def test_kramers_kronig():
    """E'(w) - E_inf = (2 w^2 / pi) PV int E''(x) / (x (w^2 - x^2)) dx, singularity subtracted."""
    from scipy.integrate import simpson

    u = np.linspace(np.log(1e-9), np.log(1e9), 200_001)
    x = np.exp(u)
    for w in (0.003, 1.234, 777.0):
        loss = THREE.loss_modulus(x)
        # The principal value of int dx / (w^2 - x^2) over (0, inf) is zero.
        with np.errstate(divide="ignore", invalid="ignore"):
            kernel = (loss - x / w * THREE.loss_modulus(w)) / (w**2 - x**2)
        near = np.abs(u - np.log(w)) < 1e-5
        kernel[near] = np.interp(u[near], u[~near], kernel[~near])
        got = 2.0 * w**2 / np.pi * simpson(kernel, x=u)
        tail = -2.0 * w / np.pi * THREE.loss_modulus(w) * (-1.0) * 1e-9  # beyond the grid
        assert THREE.storage_modulus(w) - 1e6 == pytest.approx(got + tail, rel=2e-4)


def test_power_law_has_the_loss_level_it_states():
    w = 2 * np.pi * np.geomspace(1.0, 1e5, 40)
    exact = 0.44e6 * (1j * w) ** 0.12
    spectrum = power_law_spectrum(0.44e6, 0.12)
    assert spectrum.assumed
    assert "not a measurement" in spectrum.source
    assert np.all(spectrum.term_moduli >= 0)
    inner = (w > 10) & (w < 1e6)
    np.testing.assert_allclose(spectrum.storage_modulus(w), exact.real, rtol=0.01)
    np.testing.assert_allclose(spectrum.loss_tangent(w[inner]), np.tan(0.06 * np.pi), rtol=0.015)
    # One term a decade: its own eight terms from 1 to 1e-7 s leave a ripple in the loss tangent.
    coarse = power_law_spectrum(0.44e6, 0.12, terms_per_decade=1)
    assert len(coarse) == 8
    np.testing.assert_allclose(coarse.loss_tangent(w), np.tan(0.06 * np.pi), rtol=0.07)
    assert coarse.instantaneous_modulus == pytest.approx(3.548e6, rel=2e-3)
    assert coarse.equilibrium_modulus == pytest.approx(0.360e6, rel=3e-3)
    wide = power_law_spectrum(
        0.44e6, 0.12, terms_per_decade=3, shortest_time=1e-9, longest_time=100
    )
    np.testing.assert_allclose(wide.complex_modulus(w), exact, rtol=2e-3)


def test_report_materials_are_eq_7_and_nearly_elastic_at_sliding_frequency():
    for name, g0, ginf, beta in (
        ("neolite", 30.24e6, 18.66e6, 0.013),
        ("rubber", 0.59e6, 0.44e6, 0.025),
    ):
        material = report_elastomer(name)
        shear = shear_from_young(material.spectrum, 0.499)
        for t in (0.0, 10.0, 1e9):
            assert shear.relaxation_modulus(t) == pytest.approx(
                ginf + (g0 - ginf) * np.exp(-beta * t), rel=1e-12
            )
        # 1 m/s over a wavelength of 0.4 mm.
        assert material.spectrum.loss_tangent(2 * np.pi * 1.0 / 0.4e-3) < 1e-6
    # Table 2: neolite's bulk modulus 9324 MPa follows from nu = 0.499; rubber's is ten times less
    # than the 2180 MPa printed.
    assert report_elastomer("neolite").bulk_modulus == pytest.approx(9324e6, rel=1e-3)
    assert report_elastomer("rubber").bulk_modulus == pytest.approx(219.9e6, rel=1e-3)
    with pytest.raises(InputError, match="Did you mean"):
        report_elastomer("Neolit")


def test_elastic_constants():
    assert shear_modulus(3e6, 0.5) == 1e6
    assert youngs_modulus_from_shear(1e6, 0.5) == 3e6
    assert plane_strain_modulus(3e6, 0.5) == 4e6
    assert bulk_modulus(3e6, 0.5) == np.inf
    assert np.all(bulk_modulus(np.ones(2), 0.5) == np.inf)
    assert bulk_modulus(3e6, 0.4) == pytest.approx(5e6)
    assert poisson_ratio_from_moduli(
        bulk_modulus(3e6, 0.4), shear_modulus(3e6, 0.4)
    ) == pytest.approx(0.4)
    for bad in (-1.0, 0.51, np.nan):
        with pytest.raises(InputError, match="Poisson"):
            shear_modulus(1e6, bad)
    with pytest.raises(InputError, match="moduli"):
        poisson_ratio_from_moduli(-1.0, 1.0)


def test_elastomer():
    hard = Elastomer(5e6, 0.49, name="x")
    assert hard.spectrum.term_moduli.size == 0
    assert hard.complex_modulus(100.0) == 5e6
    assert hard.equilibrium_modulus == hard.instantaneous_modulus == 5e6
    soft = Elastomer(THREE, 0.499)
    assert soft.spectrum.term_moduli.sum() > 0.0
    w = np.geomspace(1e-3, 1e3, 5)
    np.testing.assert_allclose(soft.plane_strain_modulus(w), THREE(w) / (1 - 0.499**2))
    np.testing.assert_allclose(soft.shear_modulus(w) * 2 * 1.499, THREE(w))
    for bad in (0.0, -1.0, np.nan):
        with pytest.raises(InputError, match="modulus"):
            Elastomer(bad)
    with pytest.raises(InputError, match="density"):
        Elastomer(1e6, density=-1.0)


def test_conversion_shift_and_scale():
    back = shear_from_young(young_from_shear(THREE, 0.4), 0.4)
    np.testing.assert_allclose(back.term_moduli, THREE.term_moduli)
    assert THREE.shift_times(100.0).complex_modulus(0.01) == pytest.approx(
        THREE.complex_modulus(1.0)
    )
    assert THREE.scale_moduli(2.0).instantaneous_modulus == 36e6
    for change in (THREE.scale_moduli, THREE.shift_times):
        with pytest.raises(InputError, match="factor"):
            change(0.0)


def test_identity_order_and_content():
    turned = RelaxationSpectrum(1e6, [1e7, 2e6, 5e6], [110.0, 0.7, 2e-3])
    assert turned == THREE
    assert hash(turned) == hash(THREE)
    assert content_hash(turned) == content_hash(THREE)
    assert turned != THREE.scale_moduli(1.1)
    assert THREE != "spectrum"
    with pytest.raises(ValueError, match="read-only"):
        THREE.term_moduli[0] = 0.0


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ((1e6, [-1.0], [1.0]), "term 1 has the modulus"),
        ((1e6, [1.0], [0.0]), "relaxation time"),
        ((1e6, [1.0, 2.0], [1.0]), "same length"),
        ((-1.0, [], []), "equilibrium modulus"),
        ((np.nan, [], []), "equilibrium modulus"),
        ((1e6, [np.nan], [1.0]), "modulus"),
        ((0.0, [0.0], [1.0]), "zero"),
    ],
)
def test_bad_spectra_are_refused(arguments, says):
    with pytest.raises(InputError, match=says):
        RelaxationSpectrum(*arguments)


def test_bad_arguments_are_refused():
    with pytest.raises(InputError, match="time"):
        THREE.relaxation_modulus(-1.0)
    with pytest.raises(InputError, match="NaN"):
        THREE.complex_modulus(np.nan)
    with pytest.raises(InputError, match="exchanged"):
        single_exponential_spectrum(1e6, 2e6, 0.1)
    with pytest.raises(InputError, match="decay"):
        single_exponential_spectrum(2e6, 1e6, 0.0)
    for arguments in ((0.0, 0.1), (1e6, 1.0), (1e6, np.nan)):
        with pytest.raises(InputError):
            power_law_spectrum(*arguments)
    with pytest.raises(InputError, match="times"):
        power_law_spectrum(1e6, 0.1, shortest_time=1.0, longest_time=0.1)
    with pytest.raises(InputError, match="terms"):
        power_law_spectrum(1e6, 0.1, terms_per_decade=0)


def test_a_reduced_spectrum_states_its_error():
    many = power_law_spectrum(
        0.44e6, 0.12, shortest_time=1e-10, longest_time=1e4, terms_per_decade=4
    )
    errors = []
    for per_decade, most in ((1, 0.08), (2, 0.01)):
        few = reduce_spectrum(many, (1e2, 1e6), terms_per_decade=per_decade)
        assert len(few.spectrum) <= 5 * per_decade + 1
        w = np.geomspace(1e2, 1e6, 333)
        np.testing.assert_allclose(
            few.spectrum.loss_modulus(w), many.loss_modulus(w), rtol=1.05 * few.loss_error
        )
        assert max(few.storage_error, few.loss_error) < most
        assert "reduced" in few.spectrum.source
        assert few.spectrum.assumed
        errors.append(few.loss_error)
    assert errors[1] < errors[0]
    with pytest.raises(InputError, match="lowest"):
        reduce_spectrum(many, (1e6, 1e2))
    with pytest.raises(InputError, match="terms"):
        reduce_spectrum(many, (1.0, 1e2), terms_per_decade=0)
    with pytest.raises(InputError, match="no loss"):
        reduce_spectrum(RelaxationSpectrum(1e6), (1.0, 1e2))


def test_spectrum_presents_itself():
    spectrum = RelaxationSpectrum(1e6, [2e6, 3e6], [1e-3, 1.0], source="a test")
    assert len(repr(spectrum)) < 200
    assert list(spectrum.to_frame()["modulus Pa"]) == [1e6, 2e6, 3e6]
    assert "a test" in spectrum.summary()
