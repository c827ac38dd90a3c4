"""Isotropic elastic constants from one another."""

from typing import Any

import numpy as np

from underfoot.core import RangeError


def shear_modulus(youngs_modulus: Any, poisson_ratio: float) -> Any:
    """Return G = E / (2 (1 + nu)), Pa; real or complex ``youngs_modulus``, any shape."""
    check_poisson_ratio(poisson_ratio)
    return youngs_modulus / (2.0 * (1.0 + poisson_ratio))


def youngs_modulus_from_shear(shear: Any, poisson_ratio: float) -> Any:
    """Return E = 2 G (1 + nu), Pa; real or complex ``shear``, any shape."""
    check_poisson_ratio(poisson_ratio)
    return 2.0 * (1.0 + poisson_ratio) * shear


def bulk_modulus(youngs_modulus: Any, poisson_ratio: float) -> Any:
    """Return K = E / (3 (1 - 2 nu)), Pa; infinite for nu = 0.5."""
    check_poisson_ratio(poisson_ratio)
    if poisson_ratio == 0.5:
        return np.full(np.shape(youngs_modulus), np.inf) if np.ndim(youngs_modulus) else np.inf
    return youngs_modulus / (3.0 * (1.0 - 2.0 * poisson_ratio))


def plane_strain_modulus(youngs_modulus: Any, poisson_ratio: float) -> Any:
    """Return E* = E / (1 - nu^2), Pa: the modulus that contact problems see."""
    check_poisson_ratio(poisson_ratio)
    return youngs_modulus / (1.0 - poisson_ratio**2)


def poisson_ratio_from_moduli(bulk: float, shear: float) -> float:
    """Return nu = (3 K - 2 G) / (2 (3 K + G)) for positive moduli (Pa)."""
    if not (np.isfinite(bulk) and np.isfinite(shear) and bulk > 0.0 and shear > 0.0):
        raise RangeError(
            f"K = {bulk:g} Pa, G = {shear:g} Pa", where="bulk, shear", allowed="positive moduli"
        )
    return (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear))


def check_poisson_ratio(poisson_ratio: float) -> None:
    """Refuse a Poisson ratio that no stable isotropic material has."""
    if not (np.isfinite(poisson_ratio) and -1.0 < poisson_ratio <= 0.5):
        raise RangeError(
            f"Poisson ratio {poisson_ratio:g}",
            where="poisson_ratio",
            allowed="above -1, at most 0.5 (rubber: 0.49 to 0.5)",
        )
