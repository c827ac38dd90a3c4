"""Two-dimensional spectrum of an isotropic surface from the spectrum of its profiles."""

import numpy as np

from underfoot.core import InputError

from .spectrum import IsotropicSpectrum, ProfileSpectrum

POINTS_PER_DECADE = 12


def isotropic_from_profile(spectrum: ProfileSpectrum) -> IsotropicSpectrum:
    """Return C(q) of the isotropic surface whose profiles have the given spectrum.

    C1(q) = int C(sqrt(q^2 + k^2)) dk over all k, inverted by Abel's formula
    C(q) = -1/pi int_q^inf C1'(k) / sqrt(k^2 - q^2) dk.

    The profile spectrum is first averaged over a twelfth of a decade, cut to what is reliable,
    and made to fall (a profile of an isotropic surface can't have a rising spectrum; the running
    minimum is the least change). Beyond the last wave number the power law of the last half
    decade is taken on. The notes say so.

    Raises:
        InputError: Less than half a decade of reliable wave numbers.
    """
    q, c = _averaged(spectrum)
    falling = np.minimum.accumulate(c)
    changed = float(np.max(1.0 - falling / c))
    tail = q >= q[-1] / np.sqrt(10.0)
    exponent = float(min(np.polyfit(np.log(q[tail]), np.log(falling[tail]), 1)[0], -1.05))
    density = np.array([_abel(one, q, falling, exponent) for one in q])
    edges = np.concatenate([[q[0]], np.sqrt(q[1:] * q[:-1]), [q[-1]]])
    notes = (
        *spectrum.notes,
        "isotropy assumed: two-dimensional spectrum by Abel inversion",
        f"extrapolated beyond {q[-1]:.4g} rad/m with the power {exponent:.3g} for the inversion",
    )
    if changed > 0.0:
        notes += (f"rises of the profile spectrum levelled (by up to {100 * changed:.0f} %)",)
    return IsotropicSpectrum(
        q, density, np.pi * np.diff(edges**2), (float(q[0]), float(q[-1])), notes
    )


def _averaged(spectrum: ProfileSpectrum) -> tuple[np.ndarray, np.ndarray]:
    low, high = spectrum.reliable
    inside = (spectrum.wavenumber >= low) & (spectrum.wavenumber <= high) & (spectrum.density > 0.0)
    q, c = spectrum.wavenumber[inside], spectrum.density[inside]
    if q.size < 4 or q[-1] < q[0] * np.sqrt(10.0):
        raise InputError(
            "less than half a decade of reliable wave numbers",
            where="spectrum",
            remedy="Measure a longer profile, or with a smaller spacing",
        )
    place = np.floor(np.log10(q / q[0]) * POINTS_PER_DECADE).astype(int)
    _, place = np.unique(place, return_inverse=True)
    count = np.bincount(place)
    mean_q = np.exp(np.bincount(place, np.log(q)) / count)
    return mean_q, np.bincount(place, c) / count


def _abel(q: float, nodes: np.ndarray, values: np.ndarray, exponent: float) -> float:
    # With k = q cosh u the singular root goes away: C = -1/pi int C1'(q cosh u) du.
    u = np.linspace(0.0, np.arccosh(max(1e3 * nodes[-1] / q, 2.0)), 2000)
    k = q * np.cosh(u)
    log_k, log_nodes, log_values = np.log(k), np.log(nodes), np.log(values)
    slopes = np.concatenate([np.diff(log_values) / np.diff(log_nodes), [exponent]])
    inside = np.interp(log_k, log_nodes, log_values)
    beyond = log_k > log_nodes[-1]
    inside[beyond] = log_values[-1] + exponent * (log_k[beyond] - log_nodes[-1])
    # Slopes between nodes are joined linearly, so that the integrand has no steps.
    middles = np.concatenate([0.5 * (log_nodes[1:] + log_nodes[:-1]), [log_nodes[-1]]])
    power = np.interp(log_k, middles, slopes)
    return float(-np.trapezoid(np.exp(inside) / k * power, u) / np.pi)
