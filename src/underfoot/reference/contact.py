"""Closed forms of dry contact: Hertz, Westergaard, sliding sinusoids, bonded layer.

Throughout, ``modulus`` is the plane-strain modulus E* = E/(1-nu^2) (Pa) of an elastic half-space
against a rigid body, and pressures are positive in compression.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

Array = np.ndarray


@dataclass(frozen=True, slots=True)
class HertzContact:
    """Contact of a smooth elastic half-space with a rigid sphere or cylinder.

    ``half_width`` is the contact radius of a sphere or the half width of a cylinder's strip (m);
    ``approach`` is None for a cylinder, where it depends on the body's size.
    """

    half_width: float
    peak_pressure: float
    mean_pressure: float
    approach: float | None


def hertz_point(force: float, radius: float, modulus: float) -> HertzContact:
    """Return the contact of a sphere: a^3 = 3 F R / (4 E*), p0 = 3 F / (2 pi a^2), d = a^2 / R.

    Parameters are the normal force (N, > 0), sphere radius (m) and plane-strain modulus (Pa).
    Valid for a << R, no adhesion, no friction.
    Source: Johnson (1985) Contact Mechanics, Eqs. 4.22 to 4.24.

    >>> round(hertz_point(10.0, 0.01, 5e6).peak_pressure)
    785020
    """
    _positive(force=force, radius=radius, modulus=modulus)
    a = (0.75 * force * radius / modulus) ** (1.0 / 3.0)
    mean = force / (math.pi * a**2)
    return HertzContact(a, 1.5 * mean, mean, a**2 / radius)


def hertz_line(line_force: float, radius: float, modulus: float) -> HertzContact:
    """Return the contact of a cylinder: a^2 = 4 F' R / (pi E*), p0 = 2 F' / (pi a).

    ``line_force`` is the normal force per length (N/m, > 0). Valid for a << R, plane strain.
    Source: Johnson (1985) Contact Mechanics, Eqs. 4.43 to 4.45.

    Parameters:
        line_force: Normal force per length, N/m, above 0.
        radius: Of the cylinder, m.
        modulus: E*, Pa.

    >>> round(hertz_line(1e3, 0.01, 5e6).half_width * 1e3, 3)
    1.596
    """
    _positive(line_force=line_force, radius=radius, modulus=modulus)
    a = math.sqrt(4.0 * line_force * radius / (math.pi * modulus))
    return HertzContact(a, 2.0 * line_force / (math.pi * a), line_force / (2.0 * a), None)


def hertz_point_pressure(distance: ArrayLike, contact: HertzContact) -> Array:
    """Return p0 sqrt(1 - (r/a)^2) at the distances r (m) from the axis, 0 outside (Pa)."""
    r = np.asarray(distance, dtype=float) / contact.half_width
    return contact.peak_pressure * np.sqrt(np.clip(1.0 - r**2, 0.0, None))


def sinusoid_full_contact_pressure(amplitude: float, wavelength: float, modulus: float) -> float:
    """Return the mean pressure p* = pi E* a / lambda that closes a 1-D sinusoid (Pa).

    The surface is h(x) = a cos(2 pi x / lambda), peak to valley 2a.
    Source: Westergaard (1939) J. Appl. Mech. 6:A49; Johnson (1985) Eq. 13.7.

    Parameters:
        amplitude: a, m.
        wavelength: lambda, m.
        modulus: E*, Pa.

    >>> round(sinusoid_full_contact_pressure(1e-6, 1e-4, 5e6))
    157080
    """
    _positive(amplitude=amplitude, wavelength=wavelength, modulus=modulus)
    return math.pi * modulus * amplitude / wavelength


def sinusoid_contact_fraction(pressure: ArrayLike, full_contact_pressure: float) -> Array:
    """Return the contact fraction 2 b / lambda = (2/pi) asin(sqrt(p/p*)), 1 beyond p*.

    Source: Westergaard (1939); Johnson (1985) Eq. 13.9: p/p* = sin^2(pi b / lambda).

    >>> round(float(sinusoid_contact_fraction(0.5, 1.0)), 3)
    0.5
    """
    ratio = _pressure_ratio(pressure, full_contact_pressure)
    return 2.0 / np.pi * np.arcsin(np.sqrt(np.minimum(ratio, 1.0)))


def sinusoid_mean_gap(pressure: ArrayLike, amplitude: float, full_contact_pressure: float) -> Array:
    """Return the mean gap a (1 - P + P ln P), P = p/p*, of a partly closed 1-D sinusoid (m).

    It follows from du/dp = (a/p*) ln P, the compliance of a row of strip punches at the present
    contact width, integrated from full contact (zero gap); it is the mean of ``sinusoid_gap``.

    Parameters:
        pressure: Mean, Pa.
        amplitude: a, m.
        full_contact_pressure: p*, Pa.
    """
    ratio = np.minimum(_pressure_ratio(pressure, full_contact_pressure), 1.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        term = np.where(ratio > 0.0, ratio * np.log(ratio), 0.0)
    return amplitude * (1.0 - ratio + term)


def sinusoid_pressure(
    x: ArrayLike, pressure: float, wavelength: float, full_contact_pressure: float
) -> Array:
    """Return the contact pressure at x (m, 0 = crest) under a 1-D sinusoid (Pa).

    Partial contact: 2 p cos(psi) sqrt(sin^2 psi_b - sin^2 psi) / sin^2 psi_b, psi = pi x/lambda.
    Full contact (p >= p*): p + p* cos(2 psi). Source: Johnson (1985) Eqs. 13.7 and 13.8.
    """
    psi = np.pi * np.asarray(x, dtype=float) / wavelength
    ratio = float(_pressure_ratio(pressure, full_contact_pressure))
    if ratio >= 1.0:
        return pressure + full_contact_pressure * np.cos(2.0 * psi)
    if ratio == 0.0:
        return np.zeros_like(psi)
    inside = np.sqrt(np.clip(ratio - np.sin(psi) ** 2, 0.0, None))
    return 2.0 * pressure * np.abs(np.cos(psi)) * inside / ratio


def sinusoid_gap(
    x: ArrayLike, pressure: float, amplitude: float, wavelength: float, full_contact_pressure: float
) -> Array:
    """Return the gap at x (m, 0 = crest) under a 1-D sinusoid (m).

    2 a [s sqrt(s^2 - b^2) - b^2 arcosh(s/b)], s = |sin(pi x/lambda)|, b^2 = p/p*; 0 where s <= b.
    It is the integral of the surface slope that belongs to Westergaard's stress function.
    """
    s = np.abs(np.sin(np.pi * np.asarray(x, dtype=float) / wavelength))
    ratio = float(_pressure_ratio(pressure, full_contact_pressure))
    if ratio >= 1.0:
        return np.zeros_like(s)
    if ratio == 0.0:
        return 2.0 * amplitude * s**2
    b = math.sqrt(ratio)
    outside = np.maximum(s, b)
    root = np.sqrt(np.maximum(outside**2 - ratio, 0.0))
    return 2.0 * amplitude * (outside * root - ratio * np.arccosh(np.maximum(outside / b, 1.0)))


def sliding_sinusoid_cof(
    pressure: ArrayLike, amplitude: float, wavelength: float, modulus: ArrayLike
) -> Array:
    """Return the hysteresis COF of a rigid sinusoid sliding in full contact along its wave.

    mu = q^2 a^2 Im E*(q v) / (4 p), q = 2 pi / lambda. ``modulus`` is the complex plane-strain
    modulus at the angular frequency q v (Pa, rubber convention E' + i E'', E'' >= 0).

    Valid only in full contact: p >= q a |E*(q v)| / 2 (Pa); raises ValueError otherwise.
    Source: the work q Im(...) of the pressure component out of phase with the slope; e.g.
    Persson (2001) J. Chem. Phys. 115:3840, full-contact limit of Eq. 1 for one wave.
    """
    q = 2.0 * np.pi / wavelength
    e = np.asarray(modulus, dtype=complex)
    p = np.asarray(pressure, dtype=float)
    _require_full_contact(p, q * amplitude * np.abs(e) / 2.0)
    return q**2 * amplitude**2 * np.imag(e) / (4.0 * p)


def sliding_checkerboard_cof(
    pressure: ArrayLike, amplitude: float, wavelength: float, modulus: ArrayLike
) -> Array:
    """Return the hysteresis COF of h = a cos(k x) cos(k y) sliding along x in full contact.

    mu = (sqrt(2)/8) k^2 a^2 Im E*(k v) / p, k = 2 pi / lambda; ``modulus`` is the complex
    plane-strain modulus at the angular frequency k v (Pa). Valid only in full contact,
    p >= k a |E*(k v)| / sqrt(2); raises ValueError otherwise.
    Source: the sum of q cos(phi) over the four waves of wave number sqrt(2) k (derived here).

    Parameters:
        pressure: Mean, Pa.
        amplitude: a, m.
        wavelength: lambda, m.
        modulus: Complex plane-strain modulus at k v, Pa.
    """
    k = 2.0 * np.pi / wavelength
    e = np.asarray(modulus, dtype=complex)
    p = np.asarray(pressure, dtype=float)
    _require_full_contact(p, k * amplitude * np.abs(e) / math.sqrt(2.0))
    return math.sqrt(2.0) / 8.0 * k**2 * amplitude**2 * np.imag(e) / p


def half_space_compliance(wavenumber: ArrayLike, modulus: float) -> Array:
    """Return 2 / (E* k): surface displacement per pressure of a wave on a half-space (m/Pa).

    >>> round(float(half_space_compliance(1e3, 5e6)) * 1e9, 3)
    0.4
    """
    return 2.0 / (modulus * np.asarray(wavenumber, dtype=float))


def bonded_layer_compliance(
    wavenumber: ArrayLike, thickness: float, young_modulus: float, poisson_ratio: float
) -> Array:
    """Return the compliance of a layer bonded to a rigid base, frictionless on top (m/Pa).

    C(k) = 2 (1-nu^2)/(E k) [(3-4nu) sinh 2q - 2q] / [(3-4nu) cosh 2q + 2q^2 + 5 - 12nu + 8nu^2],
    q = k T. Limits: 2/(E* k) for k T >> 1; T (1+nu)(1-2nu)/(E (1-nu)) for k -> 0, nu < 1/2;
    k^2 T^3 / (3 G) for k -> 0, nu = 1/2. ``wavenumber`` k >= 0 (rad/m); at k = 0 the limit.
    Source: Bentall and Johnson (1968) Int. J. Mech. Sci. 10:637; Johnson (1985) section 5.8.

    Parameters:
        wavenumber: k >= 0, rad/m.
        thickness: T, m.
        young_modulus: E, Pa.
        poisson_ratio: nu, 0 to 0.5.

    >>> round(float(bonded_layer_compliance(1e3, 0.01, 5e6, 0.49)) * 1e9, 3)
    0.304
    """
    _positive(thickness=thickness, young_modulus=young_modulus)
    if not -1.0 < poisson_ratio <= 0.5:
        raise ValueError(f"Poisson's ratio {poisson_ratio} is not in (-1, 0.5]")
    nu = poisson_ratio
    k = np.asarray(wavenumber, dtype=float)
    q = np.maximum(k * thickness, 1e-3)
    # divided by exp(2q)/2, so that thick layers do not overflow
    decay = np.exp(-2.0 * np.minimum(q, 350.0))
    small = 2.0 * decay * np.where(q < 350.0, 1.0, 0.0)
    over = (3.0 - 4.0 * nu) * (1.0 - decay**2) - 2.0 * q * small
    under = (3.0 - 4.0 * nu) * (1.0 + decay**2) + (
        2.0 * q**2 + 5.0 - 12.0 * nu + 8.0 * nu**2
    ) * small
    thick = 2.0 * (1.0 - nu**2) * thickness / (young_modulus * q) * over / under
    shear = young_modulus / (2.0 * (1.0 + nu))
    thin = thickness * (1.0 - 2.0 * nu) / (2.0 * shear * (1.0 - nu))
    if nu == 0.5:
        thin = k**2 * thickness**3 / (3.0 * shear)
    return np.where(k * thickness < 1e-3, thin, thick)


def _pressure_ratio(pressure: ArrayLike, full_contact_pressure: float) -> Array:
    p = np.asarray(pressure, dtype=float)
    if not np.all(p >= 0.0):
        raise ValueError("pressure must be zero or positive")
    return p / full_contact_pressure


def _require_full_contact(pressure: Array, needed: Array) -> None:
    if not np.all(pressure >= needed * (1.0 - 1e-12)):
        raise ValueError(
            f"pressure {np.min(pressure):.6g} Pa does not close the surface: "
            f"full contact needs {np.max(needed):.6g} Pa"
        )


def _positive(**values: float) -> None:
    for name, value in values.items():
        if not (math.isfinite(value) and value > 0.0):
            raise ValueError(f"{name} must be positive, not {value}")
