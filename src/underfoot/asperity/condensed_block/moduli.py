"""Poisson's ratio and pressure over modulus that a block is condensed for."""

from __future__ import annotations

from underfoot.asperity.finite_element import MicroLoading, MicroMaterial


def pressure_ratio_of(material: MicroMaterial, loading: MicroLoading) -> float:
    """Return mean pressure over the shear modulus that answers it at the end of pressing."""
    since = loading.press_time + loading.hold_time
    return loading.mean_pressure / float(material.shear.relaxation_modulus(since))


def condensed_poisson_ratio(material: MicroMaterial) -> float:
    """Return nu = (3 K - 2 G) / (2 (3 K + G)) with the relaxed shear modulus.

    Where the rubber relaxes to nothing, the instantaneous one is taken. Between both, the contact
    compliance changes by 2 (1 - nu): 2 % from 0.499 to 0.49.
    """
    k, g = material.bulk_modulus, material.shear.equilibrium_modulus
    g = g if g > 0.0 else material.shear.instantaneous_modulus
    return (3.0 * k - 2.0 * g) / (2.0 * (3.0 * k + g))
