"""Persson's theory of rough contact: area, mean gap and hysteresis friction over pressure."""

import math

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import erf, exp1

from underfoot.core import InputError, ValidityRange, breaches

from .sliding_input import Modulus, modulus_function
from .theory import TheoryContact, checked_spectrum

AREA_SOURCE = "Persson (2001) J. Chem. Phys. 115:3840-3861"
GAP_SOURCE = "Yang and Persson (2008) J. Phys.: Condens. Matter 20:215214"
FRICTION_SOURCE = (
    f"{AREA_SOURCE}; S(q): Scaraggi and Persson (2015) J. Phys.: Condens. Matter 27:105102"
)
TESTED = {
    "real_contact_fraction": ValidityRange(
        0.15, 1.0, "1", "within 25 % of half-space solutions; area 25 to 30 % low below"
    )
}
GAP_GAMMA = 0.45
"""Reduction of stored energy in partial contact, fitted to simulations in the source."""
FRICTION_GAMMA = 0.5
"""Reduced deformation in partial contact (source: about 0.5, from simulations)."""
_DIRECTIONS = 48
Directions = tuple[np.ndarray, np.ndarray]


def persson(
    pressure: ArrayLike,
    wavenumber: ArrayLike,
    spectrum: ArrayLike,
    modulus: Modulus,
    speed: float = 0.0,
    poisson_ratio: float = 0.5,
    directions: Directions | None = None,
) -> TheoryContact:
    """Return area, mean gap (elastic case) and hysteresis COF at nominal pressures (Pa, > 0).

    The arguments are those of ``persson_growth``. The mean gap is given for speed 0 or a constant
    modulus; otherwise None with the reason.

    Parameters:
        pressure: Nominal, Pa, above 0.
        wavenumber: rad/m, ascending, (m,).
        spectrum: C(q), m^4, (m,).
        modulus: Complex modulus of the rubber over frequency, or E in Pa.
        speed: Of sliding, m/s.
        poisson_ratio: Poisson's ratio, 0 to 0.5.
        directions: How the spectrum is spread over directions; None for an isotropic one.
    """
    q, c = checked_spectrum(wavenumber, spectrum)
    p = np.atleast_1d(np.asarray(pressure, dtype=float))
    fractions, friction = persson_growth(
        p, q, c, modulus, speed, poisson_ratio, directions=directions
    )
    area = fractions[:, -1]
    gap, reason = None, "mean gap: the theory derives it from stored energy, which sliding loses"
    source = FRICTION_SOURCE
    if speed == 0.0 or isinstance(modulus, int | float):
        young = float(np.real(modulus_function(modulus, np.zeros(1))(np.zeros(1))[0]))
        gap, reason = yang_persson_mean_gap(p, q, c, young, poisson_ratio), ""
        source = f"{AREA_SOURCE}; {GAP_SOURCE}"
    return TheoryContact(
        closure="persson",
        source=source,
        pressure=p,
        real_contact_fraction=area,
        mean_gap=gap,
        cof_hysteresis=friction[:, -1],
        not_estimated=reason,
        breaches=tuple(breaches("persson", TESTED, {"real_contact_fraction": area})),
    )


def persson_growth(
    pressure: ArrayLike,
    wavenumber: ArrayLike,
    spectrum: ArrayLike,
    modulus: Modulus,
    speed: float = 0.0,
    poisson_ratio: float = 0.5,
    gamma: float = FRICTION_GAMMA,
    directions: Directions | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """Return real contact fraction P and hysteresis COF from roughness up to each wave number.

    P = erf(1/(2 sqrt(G))), G(q) = (1/8) int_q0^q q^3 C(q) int_0^2pi |E*(q v cos phi)/p|^2 dphi dq,
    E* = E/(1-nu^2). Elastic: P = erf(sqrt(2) p/(E* h'(q))).
    mu = (1/2) int q^3 C(q) S(q) P(q) int_0^2pi cos(phi) Im E*(q v cos phi)/p dphi dq,
    S = gamma + (1-gamma) P^2. gamma = 1 leaves S out. Both (pressures, wave numbers); the last
    values are those of the contact, the others show which scales make it.

    Parameters:
        pressure: Nominal pressures, Pa, > 0.
        wavenumber, spectrum: q (rad/m, rising) and the isotropic 2-D spectrum C(q) (m^4), <h^2> = 2
            pi int q C dq.
        modulus: Young's modulus as in ``steady_sliding``: Pa, a material, or E*(rad/s).
        speed: m/s; 0 takes the modulus at rest; mu(-v) = -mu(v).
        directions: Of a surface with a lay, |cos| of the angles from sliding and the share of C in
            each, (wave numbers, angles); None: all directions alike. The integrals over phi are
            then sums, 2 pi times the shares: waves whose crests lie along sliding lose nothing.

    Exact at full contact (P = S = 1), where friction is a sum over independent waves. At light load
    the area is p/(E* h') times 1.60, where half-space solutions of broad spectra give 2.0 to 2.3:
    about 25 to 30 % low there. Expect the right order and trends of friction in partial contact; it
    is worse where sliding strongly reduces the area (Sukhomlinov and Mueser 2021,
    arXiv:2104.15056).
    """
    q, c = checked_spectrum(wavenumber, spectrum)
    p = np.atleast_1d(np.asarray(pressure, dtype=float))
    bad = p[~(np.isfinite(p) & (p > 0.0))]
    if bad.size:
        raise InputError(f"the pressure is {bad[0]}", where="Persson", allowed="above zero")
    nodes, weights = np.polynomial.legendre.leggauss(_DIRECTIONS)
    cosine = np.broadcast_to(np.cos(0.25 * np.pi * (nodes + 1.0)), (q.size, nodes.size))
    quadrant = np.broadcast_to(0.25 * np.pi * weights, cosine.shape)
    if directions is not None:
        cosine, quadrant = directions[0], 0.5 * np.pi * directions[1]
    frequency = np.abs(speed) * q[:, None] * cosine
    e = modulus_function(modulus, frequency.ravel())(frequency) / (1.0 - poisson_ratio**2)
    stiffness_squared = 4.0 * np.sum(np.abs(e) ** 2 * quadrant, axis=1)
    loss = 4.0 * np.sum(np.imag(e) * cosine * quadrant, axis=1) * np.sign(speed)
    spread = cumulative(q**3 * c * stiffness_squared, q) / (8.0 * p[:, None] ** 2)
    with np.errstate(divide="ignore"):
        fraction = erf(0.5 / np.sqrt(spread))
    correction = gamma + (1.0 - gamma) * fraction**2
    return fraction, 0.5 * cumulative(q**3 * c * fraction * correction * loss, q) / p[:, None]


def cumulative(integrand: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Return the running integral over q, trapezoids on log q, 0 at the first wave number."""
    from scipy.integrate import cumulative_trapezoid

    return cumulative_trapezoid(integrand * q, np.log(q), initial=0)


def yang_persson_mean_gap(
    pressure: ArrayLike,
    wavenumber: ArrayLike,
    spectrum: ArrayLike,
    modulus: float,
    poisson_ratio: float = 0.5,
    gamma: float = GAP_GAMMA,
) -> np.ndarray:
    """Return the mean interfacial gap (m) at nominal pressures (Pa, > 0).

    u(p) = sqrt(pi) int q^2 C(q) w(q) int_p^inf [gamma + 3 (1-gamma) P^2] exp(-(w p'/E*)^2) dp'/p'
    dq, w(q) = (pi int_q0^q q^3 C dq)^(-1/2), P = erf(w p'/E*), E* = E/(1-nu^2).
    It follows from p = -dU/du with the stored energy U = (pi/2) E* int q^2 C [gamma P +
    (1-gamma) P^3] dq. At light load p ~ exp(-u/u0), u0 = sqrt(pi) gamma int q^2 C w dq.

    Elastic only: a sliding viscoelastic contact dissipates, so no stored energy gives its gap.
    ``wavenumber`` (rad/m, rising), ``spectrum`` C(q) in m^4 with <h^2> = 2 pi int q C dq.
    """
    q, c = checked_spectrum(wavenumber, spectrum)
    p = np.atleast_1d(np.asarray(pressure, dtype=float))
    if not np.all((p > 0.0) & np.isfinite(p)):
        raise InputError("pressure must be positive", where="Yang-Persson")
    root, inverse = _root_grid(q, c)
    with np.errstate(divide="ignore"):
        x = p[:, None] * (1.0 - poisson_ratio**2) / (modulus * math.sqrt(math.pi) * root)
    return 2.0 * np.asarray(np.trapezoid(_inner_integral(x, gamma) * inverse, root, axis=1))


def _root_grid(q: np.ndarray, c: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return s = (int q^3 C dq)^(1/2) and 1/q on a grid that is fine near s = 0.

    In s the integrand q^2 C w dq = (2/sqrt(pi)) ds/q has no singularity at the first wave.
    """
    root = np.sqrt(cumulative(q**3 * c, q))
    fine = np.concatenate([[0.0], np.geomspace(1e-7 * root[-1], root[-1], 1200)])
    return fine, np.interp(fine, root, 1.0 / q)


def _inner_integral(x: np.ndarray, gamma: float) -> np.ndarray:
    """Return int_x^inf [gamma + 3 (1-gamma) erf^2(t)] exp(-t^2) dt/t."""
    grid = np.linspace(math.log(1e-7), math.log(8.0), 4000)
    t = np.exp(grid)
    integrand = 3.0 * erf(t) ** 2 * np.exp(-(t**2))
    steps = 0.5 * (integrand[1:] + integrand[:-1]) * np.diff(grid)
    tail = np.concatenate([np.cumsum(steps[::-1])[::-1], [0.0]])
    second = np.interp(np.log(np.clip(x, t[0], t[-1])), grid, tail)
    return 0.5 * gamma * exp1(np.minimum(x, 26.0) ** 2) + (1.0 - gamma) * second
