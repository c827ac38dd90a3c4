"""Means over whole floor wavelengths of a sliding history (Eq. 8 to 12)."""

from __future__ import annotations

import math

import numpy as np

from .inputs import MicroAverages

LEAST_RESOLVED = 0.5
"""Share of the nodal contact area that must be left without its edges; below it spots are of a node
or two, and the correction was never measured there."""


def resolution_note(means: MicroAverages) -> list[str]:
    """Say when contact spots are too small for their area to be known."""
    if not math.isnan(means.area_per_force_corrected):
        return []
    return [
        "contact spots are of a node or two: the real contact area is a count of nodes, up to "
        "several times too large; refine the lower face or take steady_sliding"
    ]


def whole_wavelength_averages(
    distance: np.ndarray,
    normal_force: np.ndarray,
    shear_force: np.ndarray,
    absolute_shear: np.ndarray,
    resultant: np.ndarray,
    real_contact_area: np.ndarray,
    corrected_area: np.ndarray,
    *,
    wavelength: float,
    nominal_area: float,
    skip: int = 1,
) -> MicroAverages | None:
    """Return the means over whole wavelengths after the first ``skip``, or None.

    Arrays (n,) have one value for each interval that ends at ``distance`` (m, increasing from
    above 0); integrals are interpolated to the ends of the wavelengths. When only ``skip`` whole
    wavelengths were slid, the last of them is taken.
    """
    if distance.size < 4 or not math.isfinite(wavelength):
        return None
    whole = int(distance[-1] / wavelength * (1.0 + 1e-6))
    if whole < 1:
        return None
    first = min(skip, whole - 1)
    marks = np.minimum(wavelength * np.arange(first, whole + 1), distance[-1])
    steps = np.diff(distance, prepend=0.0)
    ends = np.concatenate([[0.0], distance])

    def between(values: np.ndarray) -> np.ndarray:
        total = np.concatenate([[0.0], np.cumsum(values * steps)])
        return np.diff(np.interp(marks, ends, total)) / wavelength

    normal = between(normal_force)
    shear = between(shear_force)
    if not float(normal.mean()) > 0.0:
        return None
    each = shear / normal
    cof = float(shear.mean() / normal.mean())
    mean_normal = float(normal.mean())
    area = float(between(real_contact_area).mean())
    corrected = float(between(corrected_area).mean())
    if corrected < LEAST_RESOLVED * area:
        corrected = math.nan
    return MicroAverages(
        cof_hysteresis=cof,
        cof_absolute=float(between(absolute_shear).mean()) / mean_normal,
        cof_resultant=float(between(resultant).mean()) / mean_normal,
        area_per_force=area / mean_normal,
        real_contact_fraction=area / nominal_area,
        mean_pressure=mean_normal / nominal_area,
        wavelengths=whole - first,
        scatter=float(np.abs(each - cof).max()) if each.size > 1 else math.nan,
        area_per_force_corrected=corrected / mean_normal,
        real_contact_fraction_corrected=corrected / nominal_area,
    )
