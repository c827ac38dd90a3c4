"""A broad spectrum from a power law: a stand-in where no dynamic test exists."""

from typing import Any

import numpy as np

from underfoot.core import InputError, RangeError

from .spectrum import RelaxationSpectrum


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
    from scipy.optimize import nnls

    if not (np.isfinite(modulus) and modulus > 0.0):
        raise InputError(f"modulus {modulus:g} Pa", where="modulus", allowed="above 0 Pa")
    if not 0.0 < exponent < 1.0:
        raise RangeError(f"exponent {exponent:g}", where="exponent", allowed="between 0 and 1")
    if not 0.0 < shortest_time < longest_time < np.inf:
        raise RangeError(
            f"times {shortest_time:g} s to {longest_time:g} s",
            where="shortest_time, longest_time",
            allowed="0 < shortest < longest",
        )
    if terms_per_decade < 1:
        raise RangeError(
            f"{terms_per_decade} terms a decade", where="terms_per_decade", allowed="1 or more"
        )
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
    scale = np.linalg.norm(stacked, axis=0)
    solution, _ = nnls(stacked / scale, np.concatenate([goal.real, goal.imag]))
    solution = solution / scale
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
