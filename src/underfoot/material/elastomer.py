"""A rubber: Young's modulus (elastic or viscoelastic) with its Poisson ratio."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import InputError, RangeError
from underfoot.core.remark import Message

from .spectrum import RelaxationSpectrum


def shear_modulus(youngs_modulus: Any, poisson_ratio: float) -> Any:
    """Return G = E / (2 (1 + nu)), Pa; real or complex ``youngs_modulus``, any shape.

    >>> round(shear_modulus(5e6, 0.49))
    1677852
    """
    check_poisson_ratio(poisson_ratio)
    return youngs_modulus / (2.0 * (1.0 + poisson_ratio))


def youngs_modulus_from_shear(shear: Any, poisson_ratio: float) -> Any:
    """Return E = 2 G (1 + nu), Pa; real or complex ``shear``, any shape.

    >>> round(youngs_modulus_from_shear(1e6, 0.49))
    2980000
    """
    check_poisson_ratio(poisson_ratio)
    return 2.0 * (1.0 + poisson_ratio) * shear


def bulk_modulus(youngs_modulus: Any, poisson_ratio: float) -> Any:
    """Return K = E / (3 (1 - 2 nu)), Pa; infinite for nu = 0.5.

    >>> round(bulk_modulus(5e6, 0.49))
    83333333
    """
    check_poisson_ratio(poisson_ratio)
    if poisson_ratio == 0.5:
        return np.full(np.shape(youngs_modulus), np.inf) if np.ndim(youngs_modulus) else np.inf
    return youngs_modulus / (3.0 * (1.0 - 2.0 * poisson_ratio))


def plane_strain_modulus(youngs_modulus: Any, poisson_ratio: float) -> Any:
    """Return E* = E / (1 - nu^2), Pa: the modulus that contact problems see.

    >>> round(plane_strain_modulus(5e6, 0.49))
    6579813
    """
    check_poisson_ratio(poisson_ratio)
    return youngs_modulus / (1.0 - poisson_ratio**2)


def poisson_ratio_from_moduli(bulk: float, shear: float) -> float:
    """Return nu = (3 K - 2 G) / (2 (3 K + G)) for positive moduli (Pa).

    >>> round(poisson_ratio_from_moduli(2e9, 1e6), 5)
    0.49975
    """
    if not (np.isfinite(bulk) and np.isfinite(shear) and bulk > 0.0 and shear > 0.0):
        raise RangeError(
            f"K = {bulk:g} Pa, G = {shear:g} Pa", where="bulk, shear", allowed="positive moduli"
        )
    return (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear))


def check_poisson_ratio(poisson_ratio: float) -> None:
    """Refuse a Poisson ratio that no stable isotropic material has."""
    if not (np.isfinite(poisson_ratio) and -1.0 < poisson_ratio <= 0.5):
        raise RangeError(
            Message("Poisson ratio {poisson_ratio:g}", poisson_ratio=poisson_ratio),
            where="poisson_ratio",
            allowed="above -1, at most 0.5 (rubber: 0.49 to 0.5)",
        )


@dataclass(frozen=True, slots=True)
class Elastomer:
    """A shoe or floor material for small strains.

    Parameters:
        modulus: Young's modulus: Pa (elastic) or a ``RelaxationSpectrum`` (viscoelastic).
        poisson_ratio: The same at every time: bulk and shear relax together. Right for rubber near
            0.5, not for foams.
        name, source: What it is and where the numbers come from.
        density: kg/m^3, where known.
        assumed: True when no measurement of this material stands behind the modulus.
    """

    modulus: float | RelaxationSpectrum
    poisson_ratio: float = 0.499
    name: str = ""
    source: str = ""
    density: float | None = None
    assumed: bool = False

    def __post_init__(self) -> None:
        check_poisson_ratio(self.poisson_ratio)
        if not isinstance(self.modulus, RelaxationSpectrum):
            if not (np.isfinite(self.modulus) and self.modulus > 0.0):
                raise InputError(
                    Message("modulus {modulus:g} Pa", modulus=self.modulus),
                    where="modulus",
                    allowed="above 0 Pa",
                )
            object.__setattr__(self, "modulus", float(self.modulus))
        if self.density is not None and not (np.isfinite(self.density) and self.density > 0.0):
            raise InputError(
                Message("density {density:g} kg/m^3", density=self.density),
                where="density",
                allowed="above 0 kg/m^3",
            )

    @property
    def spectrum(self) -> RelaxationSpectrum:
        """Young's modulus as a spectrum; without terms when elastic."""
        if isinstance(self.modulus, RelaxationSpectrum):
            return self.modulus
        return RelaxationSpectrum(self.modulus, source=self.source, assumed=self.assumed)

    @property
    def equilibrium_modulus(self) -> float:
        """Young's modulus after infinite time, Pa."""
        return self.spectrum.equilibrium_modulus

    @property
    def instantaneous_modulus(self) -> float:
        """Young's modulus at time zero, Pa."""
        return self.spectrum.instantaneous_modulus

    def complex_modulus(self, angular_frequency: ArrayLike) -> Any:
        """Return E*(w), Pa, complex, for ``angular_frequency`` in rad/s of any shape."""
        return self.spectrum.complex_modulus(angular_frequency)

    def shear_modulus(self, angular_frequency: ArrayLike) -> Any:
        """Return G*(w) = E*(w) / (2 (1 + nu)), Pa, complex."""
        return shear_modulus(self.complex_modulus(angular_frequency), self.poisson_ratio)

    def plane_strain_modulus(self, angular_frequency: ArrayLike) -> Any:
        """Return E*(w) / (1 - nu^2), Pa, complex: the modulus of contact problems."""
        return plane_strain_modulus(self.complex_modulus(angular_frequency), self.poisson_ratio)

    @property
    def bulk_modulus(self) -> float:
        """K = E_inf / (3 (1 - 2 nu)), Pa, at equilibrium; infinite for nu = 0.5."""
        return float(bulk_modulus(self.equilibrium_modulus, self.poisson_ratio))


def young_from_shear(shear: RelaxationSpectrum, poisson_ratio: float = 0.499) -> RelaxationSpectrum:
    """Return the spectrum of E from that of G: every modulus times 2 (1 + nu)."""
    return shear.scale_moduli(youngs_modulus_from_shear(1.0, poisson_ratio))


def shear_from_young(young: RelaxationSpectrum, poisson_ratio: float = 0.499) -> RelaxationSpectrum:
    """Return the spectrum of G from that of E: every modulus over 2 (1 + nu)."""
    return young.scale_moduli(shear_modulus(1.0, poisson_ratio))
