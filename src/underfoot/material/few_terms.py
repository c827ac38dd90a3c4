"""Spectra from a few numbers: one term, the report's materials, a power law."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

import numpy as np

from underfoot.core import InputError, RangeError, unknown_name
from underfoot.core.remark import Message

from .elastomer import Elastomer, young_from_shear
from .spectrum import RelaxationSpectrum
from .spectrum_fit import check_terms, nonnegative


def single_exponential_spectrum(
    instantaneous_modulus: float, equilibrium_modulus: float, decay_rate: float, *, source: str = ""
) -> RelaxationSpectrum:
    """Return G(t) = G_inf + (G_0 - G_inf) exp(-beta t) as a spectrum of one term (Eq. 7).

    Moduli in Pa (E or G, the spectrum is of the same kind), ``decay_rate`` beta in 1/s.

    Parameters:
        instantaneous_modulus: G_0, Pa.
        equilibrium_modulus: G_inf, Pa.
        decay_rate: beta, 1/s.
        source: Where the numbers are from.
    """
    if not (np.isfinite(decay_rate) and decay_rate > 0.0):
        raise InputError(
            f"decay rate {decay_rate:g} 1/s", where="decay_rate", allowed="above 0 1/s"
        )
    if not instantaneous_modulus >= equilibrium_modulus:
        raise InputError(
            f"instantaneous modulus {instantaneous_modulus:g} Pa below the equilibrium modulus "
            f"{equilibrium_modulus:g} Pa",
            where="instantaneous_modulus",
            remedy="A passive material relaxes: check whether the two were exchanged",
        )
    return RelaxationSpectrum(
        equilibrium_modulus,
        np.array([instantaneous_modulus - equilibrium_modulus]),
        np.array([1.0 / decay_rate]),
        source=source,
    )


REPORT_SOURCE = "Grant report G.1.1, Eq. 7 and Table 2"
POISSON_RATIO = 0.499

SHEAR_CONSTANTS: Mapping[str, tuple[float, float, float]] = MappingProxyType(
    {"neolite": (30.24e6, 18.66e6, 0.013), "rubber": (0.59e6, 0.44e6, 0.025)}
)
"""G_0 (Pa), G_inf (Pa), beta (1/s) of Table 2."""


def report_elastomer(name: str) -> Elastomer:
    """Return "neolite" (Shore A 95) or "rubber" (Shore A 50) of the report as an ``Elastomer``.

    One term (Eq. 7) with 1 / beta = 77 s and 40 s: at 0.1 to 1 m/s over asperities of 0.4 mm its
    loss tangent is 1e-7 to 1e-5, so that this material has practically no hysteresis friction.
    The bulk modulus follows from nu = 0.499; Table 2's 2180 MPa for rubber is ten times what that
    rule gives (neolite's 9324 MPa obeys it).

    Raises:
        InputError: Another name.

    >>> report_elastomer("rubber").poisson_ratio
    0.499
    """
    if name not in SHEAR_CONSTANTS:
        raise unknown_name("material of the report", name, SHEAR_CONSTANTS)
    g0, ginf, beta = SHEAR_CONSTANTS[name]
    shear = single_exponential_spectrum(g0, ginf, beta, source=REPORT_SOURCE)
    young = young_from_shear(shear, POISSON_RATIO)
    return Elastomer(young, POISSON_RATIO, name=name, source=REPORT_SOURCE)


def power_law_spectrum(
    modulus: float,
    exponent: float,
    *,
    shortest_time: float = 1e-7,
    longest_time: float = 1.0,
    terms_per_decade: int = 2,
) -> RelaxationSpectrum:
    """Return non-negative Maxwell terms that follow E*(w) = modulus (i w s)^exponent.

    The loss tangent is tan(exponent pi / 2) over the decades covered: a broad, flat loss as
    filled rubber shows it. It is a stand-in with a chosen loss level, marked ``assumed``, and
    not a measurement of anything.

    Parameters:
        modulus: |E*| at 1 rad/s, Pa, above 0 (or |G*|, for a shear spectrum).
        exponent: 0 to below 1; 0.12 gives tan delta 0.19.
        shortest_time, longest_time: First and last relaxation time, s.
        terms_per_decade: 2 follows the loss tangent to 1 % away from the ends; 1 leaves a ripple of
            6 %.

    The fit is a non-negative least squares one to real and imaginary part, each relative to
    |E*|, at eight frequencies a decade from 1 / longest_time to 1 / shortest_time.
    """
    if not (np.isfinite(modulus) and modulus > 0.0):
        raise InputError(
            Message("modulus {modulus:g} Pa", modulus=modulus),
            where="modulus",
            allowed="above 0 Pa",
        )
    if not 0.0 < exponent < 1.0:
        raise RangeError(f"exponent {exponent:g}", where="exponent", allowed="between 0 and 1")
    if not 0.0 < shortest_time < longest_time < np.inf:
        raise RangeError(
            f"times {shortest_time:g} s to {longest_time:g} s",
            where="shortest_time, longest_time",
            allowed="0 < shortest < longest",
        )
    check_terms(terms_per_decade)
    decades = np.log10(longest_time / shortest_time)
    n = round(decades * terms_per_decade) + 1
    times = np.geomspace(shortest_time, longest_time, n)
    w = np.geomspace(1.0 / longest_time, 1.0 / shortest_time, round(8 * decades) + 1)
    target: Any = modulus * (1j * w) ** exponent
    x = 1j * np.outer(w, times)
    kernel: Any = np.column_stack([np.ones(w.size, dtype=complex), x / (1.0 + x)])
    kernel /= np.abs(target)[:, None]
    goal: Any = target / np.abs(target)
    stacked = np.vstack([kernel.real, kernel.imag])
    solution = nonnegative(stacked, np.concatenate([goal.real, goal.imag]))
    return RelaxationSpectrum(
        solution[0],
        solution[1:],
        times,
        source=(
            f"assumed power law {modulus:g} Pa (i w)^{exponent:g} over {shortest_time:g} s to "
            f"{longest_time:g} s; stand-in, not a measurement"
        ),
        assumed=True,
    )
