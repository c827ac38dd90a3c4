"""Viscosity of glycerol-water mixtures: Cheng (2008)."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import Breach, InputError, RangeError, ValidityRange, breaches
from underfoot.core.arrays import scalar_or_array
from underfoot.core.remark import Message

NAME = "cheng_2008"
SOURCE = (
    "N.-S. Cheng, Formula for the viscosity of a glycerol-water mixture, "
    "Ind. Eng. Chem. Res. 47 (2008) 3285-3288, Eq. 6, 12, 13, 21-25"
)
RANGES = {
    "fraction": ValidityRange(0.0, 1.0, "1", "Cheng 2008"),
    "temperature": ValidityRange(273.15, 373.15, "K", "Cheng 2008"),
}
BASES = ("mass", "volume")


def glycerol_water_viscosity(
    fraction: ArrayLike, temperature: ArrayLike, basis: str = "mass"
) -> Any:
    """Return the dynamic viscosity of a glycerol-water mixture, Pa s.

    mu = mu_w^a mu_g^(1-a), a = 1 - C + A B C (1-C) / (A C + B (1-C)), with C the mass fraction,
    A = 0.705 - 0.0017 T, B = (4.9 + 0.036 T) A^2.5 and T in degrees Celsius.

    Parameters:
        fraction: Glycerol fraction, 0 to 1 (0.25, not 25).
        temperature: K; tested from 273.15 to 373.15.
        basis: "mass" or "volume" (volumes before mixing, at ``temperature``). The same percentage
            differs by up to 60 % in viscosity between the two: it has to be known.

    Arrays broadcast; a float comes back for scalars. Cheng states a deviation of at most 5 %
    from the tabulated data for 0 to 100 degC and every concentration.

    Raises:
        RangeError: Fraction outside 0 to 1, temperature outside 0 to 100 degC (the fit has no
            meaning there).
        InputError: Unknown basis; a value that is not finite.

    >>> round(float(glycerol_water_viscosity(0.9, 293.15)), 3)
    0.224
    """
    share, celsius = _check_mixture(fraction, temperature, basis)
    mass = share if basis == "mass" else _mass_fraction(share, celsius)
    a = 0.705 - 0.0017 * celsius
    b = (4.9 + 0.036 * celsius) * a**2.5
    weight = 1.0 - mass + a * b * mass * (1.0 - mass) / (a * mass + b * (1.0 - mass))
    water = 1.790e-3 * np.exp((-1230.0 - celsius) * celsius / (36100.0 + 360.0 * celsius))
    glycerol = 12.100 * np.exp((-1233.0 + celsius) * celsius / (9900.0 + 70.0 * celsius))
    viscosity = water**weight * glycerol ** (1.0 - weight)
    return scalar_or_array(viscosity)


def water_viscosity(temperature: ArrayLike) -> Any:
    """Return the dynamic viscosity of pure water, Pa s, at ``temperature`` (K).

    Cheng (2008), Eq. 21; within 1 % of the reference values from 0 to 100 degC.

    >>> round(float(water_viscosity(293.15)) * 1e3, 3)
    1.005
    """
    return glycerol_water_viscosity(0.0, temperature)


def glycerol_water_density(fraction: ArrayLike, temperature: ArrayLike, basis: str = "mass") -> Any:
    """Return the density of a glycerol-water mixture, kg/m^3, mixing without contraction.

    rho = rho_g C + rho_w (1 - C) with C the mass fraction, as Cheng (2008), Eq. 23-25, uses it.

    Parameters:
        fraction: Of glycerol, 0 to 1.
        temperature: K.
        basis: Of the fraction: "mass" or "volume".

    >>> round(float(glycerol_water_density(0.9, 293.15)))
    1237
    """
    share, celsius = _check_mixture(fraction, temperature, basis)
    mass = share if basis == "mass" else _mass_fraction(share, celsius)
    density = mass * _glycerol_density(celsius) + (1.0 - mass) * _water_density(celsius)
    return scalar_or_array(density)


def glycerol_mass_fraction(volume_fraction: ArrayLike, temperature: ArrayLike) -> Any:
    """Return the mass fraction of glycerol for a volume fraction, both 0 to 1.

    >>> round(float(glycerol_mass_fraction(0.5, 293.15)), 3)
    0.559
    """
    share, celsius = _check_mixture(volume_fraction, temperature, "volume")
    mass = np.asarray(_mass_fraction(share, celsius))
    return scalar_or_array(mass)


def glycerol_water_breaches(fraction: ArrayLike, temperature: ArrayLike) -> list[Breach]:
    """Return which inputs leave the range of Cheng (2008).

    >>> glycerol_water_breaches(0.9, 293.15)
    []
    """
    return breaches(NAME, RANGES, {"fraction": fraction, "temperature": temperature})


def _mass_fraction(volume: np.ndarray, celsius: np.ndarray) -> np.ndarray:
    glycerol = volume * _glycerol_density(celsius)
    return glycerol / (glycerol + (1.0 - volume) * _water_density(celsius))


def _glycerol_density(celsius: np.ndarray) -> np.ndarray:
    return 1277.0 - 0.654 * celsius


def _water_density(celsius: np.ndarray) -> np.ndarray:
    return 1000.0 * (1.0 - np.abs((celsius - 4.0) / 622.0) ** 1.7)


def _check_mixture(
    fraction: ArrayLike, temperature: ArrayLike, basis: str
) -> tuple[np.ndarray, np.ndarray]:
    if basis not in BASES:
        raise InputError(
            Message('"{basis}" is not a basis of concentration', basis=basis),
            where="basis",
            allowed='"mass" (weighed) or "volume" (measured by jug)',
        )
    share = np.asarray(fraction, dtype=float)
    kelvin = np.asarray(temperature, dtype=float)
    for name, array in (("fraction", share), ("temperature", kelvin)):
        if not np.all(np.isfinite(array)):
            raise InputError("a value is not finite", where=name, allowed="finite numbers")
    if np.any((share < 0.0) | (share > 1.0)):
        raise RangeError(
            Message("glycerol fraction {min:g} to {max:g}", min=share.min(), max=share.max()),
            where="fraction",
            allowed="0 to 1",
            remedy="Write 25 % as 0.25",
        )
    low, high = RANGES["temperature"].low, RANGES["temperature"].high
    if np.any((kelvin < low) | (kelvin > high)):
        raise RangeError(
            Message("temperature {min:g} K to {max:g} K", min=kelvin.min(), max=kelvin.max()),
            where="temperature",
            allowed="273.15 K to 373.15 K (0 to 100 degC)",
            remedy="Give kelvin; outside this range enter a measured viscosity instead",
        )
    return share, kelvin - 273.15
