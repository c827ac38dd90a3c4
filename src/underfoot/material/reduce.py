"""The same material with fewer terms."""

from dataclasses import dataclass

import numpy as np

from underfoot.core import InputError

from ._kernels import maxwell
from .spectrum import RelaxationSpectrum


@dataclass(frozen=True, slots=True, eq=False)
class ReducedSpectrum:
    """A spectrum with fewer terms and the largest relative errors of E' and E'' in the range."""

    spectrum: RelaxationSpectrum
    frequency_range: tuple[float, float]
    storage_error: float
    loss_error: float


def reduced(
    spectrum: RelaxationSpectrum,
    frequency_range: tuple[float, float],
    *,
    terms_per_decade: int = 1,
) -> ReducedSpectrum:
    """Return the spectrum with evenly spread terms that follow it over ``frequency_range`` only.

    For methods whose cost grows with the number of terms (time marching). Non-negative least
    squares on the relative errors of E' and E'' at twelve frequencies a decade (rad/s), with half
    a decade of terms beyond each end; faster terms act as part of the last one, slower ones as
    part of the equilibrium modulus.

    Raises:
        InputError: Range not ascending, fewer than one term a decade, no loss in the range.
    """
    from scipy.optimize import nnls

    low, high = frequency_range
    if not 0.0 < low < high < np.inf:
        raise InputError(
            f"{low:g} to {high:g} rad/s", where="frequency_range", allowed="0 < lowest < highest"
        )
    if terms_per_decade < 1:
        raise InputError(
            f"{terms_per_decade} terms a decade", where="terms_per_decade", allowed="1 or more"
        )
    w = np.geomspace(low, high, max(round(12 * np.log10(high / low)), 6) + 1)
    storage, loss = spectrum.storage_modulus(w), spectrum.loss_modulus(w)
    if not np.all(loss > 0.0):
        raise InputError(
            "the material has no loss in this range",
            where="frequency_range",
            remedy="Use its elastic modulus",
        )
    edge = np.sqrt(10.0)
    n = max(round((np.log10(high / low) + 1.0) * terms_per_decade), 1) + 1
    times = np.geomspace(1.0 / (high * edge), edge / low, n)
    matrix = np.vstack(
        [
            maxwell.storage_kernel(w, times) / storage[:, None],
            maxwell.loss_kernel(w, times) / loss[:, None],
        ]
    )
    size = np.linalg.norm(matrix, axis=0)
    solution, _ = nnls(matrix / size, np.ones(2 * w.size))
    solution = solution / size
    keep = solution[1:] > 0.0
    found = RelaxationSpectrum(
        solution[0],
        solution[1:][keep],
        times[keep],
        source=f"{spectrum.source}; reduced to {int(keep.sum())} terms, {low:g} to {high:g} rad/s",
        assumed=spectrum.assumed,
    )
    return ReducedSpectrum(
        found,
        (float(low), float(high)),
        float(np.max(np.abs(found.storage_modulus(w) / storage - 1.0))),
        float(np.max(np.abs(found.loss_modulus(w) / loss - 1.0))),
    )
