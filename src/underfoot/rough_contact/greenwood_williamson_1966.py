"""Greenwood and Williamson (1966): a rough surface as independent spherical summits."""

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike
from scipy import special

from underfoot.core import InputError, RangeError, ValidityRange, breaches
from underfoot.core.checks import poisson_ratio as checked_ratio
from underfoot.core.checks import positive
from underfoot.surface import SpectralMoments, asperities

from .pressure_gap_law import TabulatedLaw
from .theory import TheoryContact, checked_spectrum

SOURCE = (
    "Greenwood and Williamson (1966) Proc. R. Soc. A 295:300-319; summits from the moments of "
    "the spectrum as surface.asperities gives them"
)
TESTED = {
    "real_contact_fraction": ValidityRange(
        0.0, 0.05, "1", "area and gap 5 to 15 % low against half-space solutions up to here"
    )
}


def greenwood_williamson(
    pressure: ArrayLike, moments: SpectralMoments, modulus: float, poisson_ratio: float = 0.5
) -> TheoryContact:
    """Return area, mean gap and contacts at nominal pressures (Pa, > 0).

    p = (4/3) E* D R^(1/2) int_d^inf (z-d)^(3/2) phi(z) dz, area fraction pi D R int (z-d) phi dz,
    contacts per area D int phi dz; E* = E/(1-nu^2), ``modulus`` = E (Pa) of the elastic body.
    The gap returned is that of the mean planes, d + z_s; negative where the planes cross.

    Valid at light load only: summits neither interact nor merge. Beside half-space solutions of a
    self-affine surface the area is 8 % low at 1 % contact, 14 % at 5 %, 26 % at 20 %; the gap 5 %
    low at 2 % contact and useless above 10 %, where the mean planes cross.

    Parameters:
        pressure: Nominal, Pa, above 0.
        moments: Spectral moments of the heights.
        modulus: E of the elastic body, Pa.
        poisson_ratio: Poisson's ratio, 0 to 0.5.

    Raises RangeError when no separation down to minus eight deviations carries the pressure.
    """
    p = np.atleast_1d(np.asarray(pressure, dtype=float))
    if not np.all((p > 0.0) & np.isfinite(p)):
        raise InputError("pressure must be positive", where="Greenwood-Williamson")
    summits = asperities(moments)
    deviation = summits.height_sd
    stiffness = positive(modulus, "modulus", "Pa") / (1.0 - checked_ratio(poisson_ratio) ** 2)
    scale = 4.0 / 3.0 * stiffness * summits.density * math.sqrt(summits.radius) * deviation**1.5
    t = _separation(p / scale)
    area = math.pi * summits.density * summits.radius * deviation * _summit_integral(1.0, t)
    values = {"real_contact_fraction": area}
    return TheoryContact(
        closure="greenwood_williamson_1966",
        source=SOURCE,
        pressure=p,
        real_contact_fraction=area,
        mean_gap=deviation * t + summits.mean_height,
        spot_density=summits.density * _summit_integral(0.0, t),
        not_estimated="hysteresis: the theory is elastic",
        breaches=tuple(breaches("greenwood_williamson_1966", TESTED, values)),
    )


def greenwood_williamson_law(
    wavenumber: ArrayLike,
    spectrum: ArrayLike,
    modulus: float,
    poisson_ratio: float = 0.5,
    flow_factor: Callable[[np.ndarray], np.ndarray] | None = None,
) -> TabulatedLaw:
    """Return the law p(u) of independent summits, from a contact of 1e-5 to where planes meet.

    Arguments as ``persson_law``. The range ends at 5 % of real contact: beyond it summits merge,
    and the gap falls to 0 too soon.

    Parameters:
        wavenumber: rad/m, ascending, (m,).
        spectrum: C(q), m^4, (m,).
        modulus: E of the elastic body, Pa.
        poisson_ratio: Poisson's ratio, 0 to 0.5.
        flow_factor: Of the gap (m); None takes none.
    """
    q, c = checked_spectrum(wavenumber, spectrum)
    m0, m2, m4 = (
        weight * np.pi * float(np.trapezoid(q ** (1 + 2 * order) * c, q))
        for order, weight in enumerate((2.0, 1.0, 0.75))
    )
    moments = SpectralMoments(m0, m2, m4, (float(q[0]), float(q[-1])))
    scale = positive(modulus, "modulus", "Pa") / (1.0 - checked_ratio(poisson_ratio) ** 2)
    scale *= math.sqrt(m2)
    contact = greenwood_williamson(
        np.geomspace(0.3, 1e-5, 200) * scale, moments, modulus, poisson_ratio
    )
    assert contact.mean_gap is not None
    open_ = contact.mean_gap > 0.0
    gap, pressure = contact.mean_gap[open_], contact.pressure[open_]
    area = contact.real_contact_fraction
    highest = float(contact.pressure[area <= TESTED["real_contact_fraction"].high].max())
    flow = np.ones_like(gap) if flow_factor is None else np.asarray(flow_factor(gap), dtype=float)
    return TabulatedLaw(
        name="greenwood_williamson_1966",
        source=SOURCE,
        gap=gap,
        node_pressure=pressure,
        node_flow_factor=flow,
        ranges={"pressure": ValidityRange(0.0, highest, "Pa", "up to 5 % of real contact")},
    )


def _summit_integral(power: float, t: np.ndarray) -> np.ndarray:
    """Return int_t^inf (z-t)^n exp(-z^2/2)/sqrt(2 pi) dz through parabolic cylinder functions."""
    cylinder, _ = special.pbdv(-power - 1.0, t)
    factor = math.gamma(power + 1.0) / math.sqrt(2.0 * math.pi)
    return factor * np.exp(-(t**2) / 4.0) * cylinder


def _separation(load: np.ndarray) -> np.ndarray:
    """Return t with F_3/2(t) = load: table for the start, Newton on the logarithm."""
    table = np.linspace(-8.0, 12.0, 401)
    logarithm = np.log(_summit_integral(1.5, table))
    log_load = np.log(load)
    if log_load.max() > logarithm[0] or log_load.min() < logarithm[-1]:
        raise RangeError(
            "no separation between -8 and 12 summit deviations carries this pressure",
            where="Greenwood-Williamson",
            remedy="Use the sliding half-space, which holds up to full contact",
        )
    t = np.interp(log_load, logarithm[::-1], table[::-1])
    for _ in range(4):
        value = _summit_integral(1.5, t)
        slope = -1.5 * _summit_integral(0.5, t) / value
        t = t - (np.log(value) - log_load) / slope
    return t
