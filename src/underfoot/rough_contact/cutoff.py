"""How a contact depends on the shortest wave that a surface keeps."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import InputError, Progress, Status, silent
from underfoot.core.status import worst
from underfoot.surface import HeightMap

from .sliding_input import Modulus, check_map
from .steady import steady_sliding


@dataclass(frozen=True, slots=True, eq=False)
class CutoffDependence:
    """Averages of one contact over the shortest wave kept; arrays over ``shortest_wave``.

    ``shortest_wave`` (m) falls. Contact area has no value of its own on a surface with
    roughness at every scale: it belongs to the shortest wave of the measurement or the model.
    """

    shortest_wave: np.ndarray
    rms_gradient: np.ndarray
    real_contact_fraction: np.ndarray
    cof_hysteresis: np.ndarray
    mean_gap: np.ndarray
    status: Status

    @property
    def area_exponent(self) -> float:
        """Return d ln(area) / d ln(shortest wave) between the last two cut-offs; 0 = settled."""
        area, wave = np.log(self.real_contact_fraction[-2:]), np.log(self.shortest_wave[-2:])
        return float((area[1] - area[0]) / (wave[1] - wave[0]))

    @property
    def note(self) -> str:
        """Return in words what halving the shortest wave does to the last contact area."""
        change = 0.5**self.area_exponent - 1.0
        return (
            f"contact fraction at a shortest wave of {self.shortest_wave[-1] * 1e6:.3g} um; "
            f"halving it would change the contact fraction by about {100.0 * change:+.0f} %"
        )


def cutoff_dependence(
    surface: HeightMap,
    modulus: Modulus,
    speed: float,
    pressure: float,
    shortest_waves: ArrayLike,
    poisson_ratio: float = 0.5,
    *,
    progress: Progress = silent,
) -> CutoffDependence:
    """Return the contact of a periodic surface whose waves below each cut-off are removed.

    ``shortest_waves`` (m, falling, 2 or more, none below twice the grid spacing); the other
    arguments are those of ``steady_sliding``. The filter is sharp in the wave number.

    Parameters:
        surface: Periodic heights, m.
        modulus: Complex modulus of the rubber over frequency, or E in Pa.
        speed: Of sliding, m/s.
        pressure: Nominal, Pa.
        shortest_waves: Cut-offs, m, falling.
        poisson_ratio: Poisson's ratio, 0 to 0.5.
        progress: Called with stage, fraction and residual; an exception it raises stops the work.
    """
    waves = np.asarray(shortest_waves, dtype=float)
    limit = 2.0 * surface.spacing * (1.0 - 1e-9)
    falling = waves.ndim == 1 and waves.size >= 2 and np.all(np.diff(waves) < 0.0)
    if not (falling and np.all(np.isfinite(waves)) and waves[-1] >= limit):
        raise InputError(
            f"shortest waves {shortest_waves}",
            where="shortest_waves",
            allowed=f"2 or more falling lengths down to {2.0 * surface.spacing:.4g} m",
        )
    check_map(surface, "surface")
    q = np.hypot(
        *np.meshgrid(
            *(2.0 * np.pi * np.fft.fftfreq(n, surface.spacing) for n in surface.shape),
            indexing="ij",
        )
    )
    spectrum = np.fft.fft2(surface.heights)
    rows, states = [], []
    for n, wave in enumerate(waves):
        filtered = np.where(q <= 2.0 * np.pi / wave * (1.0 + 1e-9), spectrum, 0.0)
        contact = steady_sliding(
            np.fft.ifft2(filtered).real, surface.spacing, modulus, speed, pressure, poisson_ratio
        )
        power = np.abs(filtered / filtered.size) ** 2
        averages = (
            contact.real_contact_fraction_corrected,
            contact.cof_hysteresis,
            contact.mean_gap,
        )
        known = averages if contact.status.usable else (np.nan,) * 3
        rows.append([float(np.sqrt((power * q**2).sum())), *known])
        states.append(contact.status)
        progress("shortest wave", (n + 1) / waves.size)
    values = np.array(rows).T
    return CutoffDependence(waves, *values, status=worst(*states))
