"""Soft elastohydrodynamic film of a point contact: Hamrock and Dowson 1978 (Eq. 18 to 21)."""

import math
from dataclasses import dataclass
from enum import StrEnum

from numpy.typing import ArrayLike

from underfoot.core import Breach, InputError, ValidityRange, breaches, checks, unknown_name
from underfoot.core.arrays import Array
from underfoot.core.checks import not_negative, positive, positive_array

SPEEDS = {"entrainment": 0.5, "sliding": 1.0}
"""Share of the sliding speed that the formula is given."""

RANGES = {
    "dimensionless speed U": ValidityRange(
        0.5e-8, 5.1e-8, "1", "Hamrock and Dowson 1978, from memory"
    ),
    "dimensionless load W": ValidityRange(
        0.2e-3, 2.2e-3, "1", "Hamrock and Dowson 1978, from memory"
    ),
    "ellipticity k": ValidityRange(1.0, 12.0, "1", "Hamrock and Dowson 1978, from memory"),
}
"""Films the formula was fitted to; it is a power law and often used far outside."""


class FilmRegime(StrEnum):
    """What makes the film: the fluid's viscosity alone, or pressure on fluid or solid as well."""

    ISOVISCOUS_RIGID = "isoviscous-rigid"
    ISOVISCOUS_ELASTIC = "isoviscous-elastic"
    PIEZOVISCOUS_RIGID = "piezoviscous-rigid"
    PIEZOVISCOUS_ELASTIC = "piezoviscous-elastic"


@dataclass(frozen=True, slots=True)
class SoftEhlFilm:
    """Film of a soft point contact; arrays take the shape of the inputs together."""

    minimum: Array  # m
    central: Array  # m
    speed_number: Array  # U = eta u / (E' R')
    load_number: Array  # W = F / (E' R'^2)
    entrainment_speed: Array  # m/s, what the formula was given as u
    breaches: tuple[Breach, ...]

    def lambda_ratio(self, rq_first: float, rq_second: float) -> Array:
        """Return lambda of the minimum film over both roughnesses (Eq. 21)."""
        return lambda_ratio(self.minimum, rq_first, rq_second)


def soft_ehl(
    *,
    viscosity: ArrayLike,
    speed: ArrayLike,
    load: ArrayLike,
    radius: ArrayLike,
    effective_modulus: ArrayLike,
    ellipticity: float = 1.0,
    speed_is: str = "entrainment",
) -> SoftEhlFilm:
    """Return the film between a soft curved body and a wall that slides past it.

    H_min = 7.43 (1 - 0.85 exp(-0.31 k)) U^0.65 W^-0.21
    H_c   = 7.32 (1 - 0.72 exp(-0.28 k)) U^0.64 W^-0.22
    H = h / R',  U = eta u / (E' R'),  W = F / (E' R'^2)

    Parameters:
        viscosity, speed, load, radius: Pa s; sliding speed, m/s (0 gives no film); N; reduced
            radius R' along the motion, m. Scalars or arrays that go together.
        effective_modulus: E', Pa: 2 E / (1 - nu^2) of the soft body against a rigid wall
            (``effective_modulus``).
        ellipticity: k, 1 for a circle.
        speed_is: "entrainment": u = half the sliding speed, the mean of both surfaces, as the
            formula was made; "sliding": u = the sliding speed, as the report put it (films 1.57
            times as thick).

    Raises:
        InputError: Values that are not finite or not physical.

    Fully flooded, smooth, no change of viscosity with pressure, half-space behind the contact.
    ``breaches`` of the result names what leaves the fitted ``RANGES``.

    Source: Hamrock and Dowson (1978) J. Lubr. Technol. 100:236-245; Eq. 18 of the report, whose
    printed W = w / (E' R') is not dimensionless.

    >>> ball = {"load": 10.0, "radius": 0.01, "effective_modulus": 1e7}
    >>> round(float(soft_ehl(viscosity=0.1, speed=0.5, **ball).central) * 1e6, 2)
    5.47
    """
    if speed_is not in SPEEDS:
        raise unknown_name("speed", speed_is, SPEEDS, where="speed_is")
    eta, force = positive_array(viscosity, "viscosity"), positive_array(load, "load")
    r = positive_array(radius, "radius")
    modulus = positive_array(effective_modulus, "effective_modulus")
    k = positive(ellipticity, "ellipticity")
    u = SPEEDS[speed_is] * positive_array(speed, "speed", zero=True)
    speed_number = eta * u / (modulus * r)
    load_number = force / (modulus * r**2)
    least = 7.43 * (1 - 0.85 * math.exp(-0.31 * k)) * speed_number**0.65 * load_number**-0.21
    central = 7.32 * (1 - 0.72 * math.exp(-0.28 * k)) * speed_number**0.64 * load_number**-0.22
    values = {
        "dimensionless speed U": speed_number,
        "dimensionless load W": load_number,
        "ellipticity k": k,
    }
    return SoftEhlFilm(
        minimum=least * r,
        central=central * r,
        speed_number=speed_number,
        load_number=load_number,
        entrainment_speed=u,
        breaches=tuple(breaches("soft_ehl", RANGES, values)),
    )


def effective_modulus(modulus: float, poisson_ratio: float = 0.5) -> float:
    """Return E' (Pa) of a soft body against a rigid one, 2 E / (1 - nu^2).

    2 / E' = (1 - nu1^2) / E1 + (1 - nu2^2) / E2 with E2 without limit. The report took E' = E:
    films 1.53 times as thick at nu = 0.5. Source: Hamrock and Dowson 1978.

    >>> round(effective_modulus(5e6, 0.49))
    13159626
    """
    return 2 * positive(modulus, "modulus") / (1 - checks.poisson_ratio(poisson_ratio) ** 2)


def radius_of_parabola(coefficient: float) -> float:
    """Return the reduced radius R' = 1 / (2 B) (m) of a profile h = B r^2, B in 1/m (Eq. 19, 20).

    ``trials.reduced_radius`` fits B to a recorded profile.

    >>> radius_of_parabola(50.0)
    0.01
    """
    return 1 / (2 * positive(coefficient, "coefficient"))


def lambda_ratio(film_thickness: ArrayLike, rq_first: float, rq_second: float) -> Array:
    """Return lambda = h / (Rq1^2 + Rq2^2)^(1/2), film over the roughness of both walls (Eq. 21).

    ``film_thickness`` in m (any shape), roughnesses in m (one may be 0). Both roughnesses count as
    they were measured, undeformed.

    >>> round(float(lambda_ratio(10e-6, 3e-6, 4e-6)), 3)
    2.0
    """
    thickness = positive_array(film_thickness, "film_thickness", zero=True)
    first, second = not_negative(rq_first, "rq_first"), not_negative(rq_second, "rq_second")
    if first == second == 0:
        raise InputError("both walls are smooth", where="rq_first", remedy="Give a roughness.")
    return thickness / math.hypot(first, second)


def film_regime(
    *,
    viscosity: float,
    entrainment_speed: float,
    load: float,
    radius: float,
    effective_modulus: float,
    radius_ratio: float = 1.0,
    pressure_viscosity: float = 0.0,
) -> tuple[FilmRegime, dict[FilmRegime, float]]:
    """Return which of four theories makes the thickest film, and the minimum film (m) of each.

    h' = (h / R') (W / U)^2 against g_V = G W^3 / U^2 and g_E = W^(8/3) / U^2, G = xi E':

    isoviscous-rigid 128 a b^2 (0.131 atan(a / 2) + 1.683)^2, b = 1 / (1 + 2 / (3 a));
    isoviscous-elastic 8.70 g_E^0.67 (1 - 0.85 exp(-0.31 k));
    piezoviscous-rigid 141 g_V^0.375 (1 - exp(-0.0387 a));
    piezoviscous-elastic 3.42 g_V^0.49 g_E^0.17 (1 - exp(-0.68 k)); k = a^(2 / pi).

    Parameters:
        viscosity, entrainment_speed, load, radius, effective_modulus: As in ``soft_ehl``; the speed
            is the mean of both surfaces, above 0.
        radius_ratio: a, radius across over radius along the motion.
        pressure_viscosity: xi, 1/Pa; 0 leaves the two piezoviscous theories out. For oils some
            2e-8.

    Source: Hamrock and Dowson 1979; Esfahanian and Hamrock 1991, Tribol. Trans. 34:628-632
    (coefficients as in public lecture codes; 141 and 128 from memory).

    >>> ball = {"load": 10.0, "radius": 0.01, "effective_modulus": 1e7}
    >>> str(film_regime(viscosity=0.1, entrainment_speed=0.5, **ball)[0])
    'isoviscous-elastic'
    """
    eta = positive(viscosity, "viscosity")
    u = positive(entrainment_speed, "entrainment_speed")
    r, modulus = positive(radius, "radius"), positive(effective_modulus, "modulus")
    a = positive(radius_ratio, "radius_ratio")
    speed_number = eta * u / (modulus * r)
    load_number = positive(load, "load") / (modulus * r**2)
    k = a ** (2 / math.pi)
    elasticity = load_number ** (8 / 3) / speed_number**2
    side = 1 / (1 + 2 / (3 * a))
    grouped = {
        FilmRegime.ISOVISCOUS_RIGID: 128 * a * side**2 * (0.131 * math.atan(a / 2) + 1.683) ** 2,
        FilmRegime.ISOVISCOUS_ELASTIC: 8.70 * elasticity**0.67 * (1 - 0.85 * math.exp(-0.31 * k)),
    }
    xi = not_negative(pressure_viscosity, "pressure_viscosity")
    if xi > 0:
        viscous = xi * modulus * load_number**3 / speed_number**2
        grouped[FilmRegime.PIEZOVISCOUS_RIGID] = 141 * viscous**0.375 * (1 - math.exp(-0.0387 * a))
        grouped[FilmRegime.PIEZOVISCOUS_ELASTIC] = (
            3.42 * viscous**0.49 * elasticity**0.17 * (1 - math.exp(-0.68 * k))
        )
    scale = r * (speed_number / load_number) ** 2
    films = {regime: value * scale for regime, value in grouped.items()}
    return max(films, key=films.__getitem__), films
