"""History of a sliding block: forces, real contact area, energies, means over wavelengths."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from underfoot.core import Breach, Status

EDGE_EXCESS = 0.33
"""Area counted too much, over boundary length times element width. A node of a linear element
carries force as soon as contact reaches into its neighbourhood. Measured with the condensed block
against the half-space at 13 to 26 elements a wavelength and 14 to 67 % contact: 0.30 to 0.38."""


def edge_excess_area(touching: np.ndarray, dx: float, dy: float, *, periodic: bool) -> float:
    """Return ``EDGE_EXCESS`` times boundary length times element width, m^2.

    ``touching`` (ny, nx) bool: the lower nodes in contact, each once; ``dx``, ``dy`` element widths
    in m. The boundary is counted along the grid; free sides of the block are none.
    """
    if periodic:
        along = np.count_nonzero(touching != np.roll(touching, 1, axis=1))
        across = np.count_nonzero(touching != np.roll(touching, 1, axis=0))
    else:
        along = np.count_nonzero(touching[:, 1:] != touching[:, :-1])
        across = np.count_nonzero(touching[1:] != touching[:-1])
    return EDGE_EXCESS * (along * dy + across * dx) * math.sqrt(dx * dy)


@dataclass(frozen=True, slots=True, eq=False)
class EnergyLedger:
    """Energies of the block in J against ``time`` (n,); in the frame of the block's top.

    ``residual`` is what came in less what is stored, moving or lost: the error of the march, and
    with relaxation terms that of ``strain`` and ``material_loss``, which hold for small strains.

    Parameters:
        time: s.
        floor_work: Done by the floor passing underneath: friction force times distance.
        top_work: Done by the load on the top.
        kinetic, strain, hourglass, contact: In motion and stored.
        material_loss, hourglass_loss, contact_loss, damping_loss: Lost in the rubber, in viscous
            hourglass control with bulk viscosity, in contact damping, in the body damping of
            pressing.
    """

    time: np.ndarray
    floor_work: np.ndarray
    top_work: np.ndarray
    kinetic: np.ndarray
    strain: np.ndarray
    hourglass: np.ndarray
    contact: np.ndarray
    material_loss: np.ndarray
    hourglass_loss: np.ndarray
    contact_loss: np.ndarray
    damping_loss: np.ndarray

    @property
    def residual(self) -> np.ndarray:
        """Work done less everything stored, moving and lost, J."""
        held = self.kinetic + self.strain + self.hourglass + self.contact
        lost = self.material_loss + self.hourglass_loss + self.contact_loss + self.damping_loss
        return self.floor_work + self.top_work - held - lost


@dataclass(frozen=True, slots=True)
class MicroAverages:
    """Means over whole floor wavelengths of sliding, the first left out (Eq. 8 to 12).

    Parameters:
        cof_hysteresis: Signed mean shear over mean normal force (Eq. 8): friction.
        cof_absolute, cof_resultant: The same with the mean of |shear|, and of the resultant of
            shear and lateral force: not friction, but what unsigned averages give.
        area_per_force: A_c / F_N, m^2/N (Eq. 12), with the cells of all nodes in contact, as finite
            elements do.
        real_contact_fraction: A_c over the nominal area.
        mean_pressure: Pa, over the nominal area.
        wavelengths: How many were averaged.
        scatter: Largest difference of one wavelength's signed COF from their mean (NaN with only
            one).
        area_per_force_corrected, real_contact_fraction_corrected: The same area less what the edges
            of contact spots count too much (``edge_excess_area``): the better estimate. NaN where
            the edges are more than half of it: spots of a node or two.
    """

    cof_hysteresis: float
    cof_absolute: float
    cof_resultant: float
    area_per_force: float
    real_contact_fraction: float
    mean_pressure: float
    wavelengths: int
    scatter: float
    area_per_force_corrected: float
    real_contact_fraction_corrected: float


@dataclass(frozen=True, slots=True, eq=False)
class MicroResult:
    """History of pressing and sliding a block; arrays of one value per sample.

    Parameters:
        time, distance: s since the start of pressing; m of sliding (0 while pressing).
        normal_force, shear_force, lateral_force: N at the rough interface: on the block, upwards;
            against sliding (-x); along y.
        real_contact_area: m^2: cells of the nodes in contact.
        corrected_contact_area: m^2: the same less its edges (``edge_excess_area``).
        height: m, displacement of the block's top.
        nominal_area: m^2.
        averages: None when no whole wavelength was slid.
        energy: None where the solver keeps no energies.
        status: How it ended.
        steps, time_step, process_seconds: Count, s, s.
        notes, breaches: What is to be said of it.
    """

    time: np.ndarray
    distance: np.ndarray
    normal_force: np.ndarray
    shear_force: np.ndarray
    lateral_force: np.ndarray
    real_contact_area: np.ndarray
    corrected_contact_area: np.ndarray
    height: np.ndarray
    nominal_area: float
    averages: MicroAverages | None
    energy: EnergyLedger | None
    status: Status
    steps: int
    time_step: float
    process_seconds: float
    notes: tuple[str, ...] = ()
    breaches: tuple[Breach, ...] = ()


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
    distance: np.ndarray, values: Sequence[np.ndarray], wavelength: float, nominal_area: float
) -> MicroAverages | None:
    """Return the means over whole wavelengths after the first, or None.

    ``values`` are normal force, shear force, its magnitude, resultant, real contact area and that
    without its edges, each (n,) with one value for each interval that ends at ``distance`` (m,
    increasing from above 0); integrals are interpolated to the ends of the wavelengths. When only
    one whole wavelength was slid, it is taken.
    """
    if distance.size < 4 or not math.isfinite(wavelength):
        return None
    count = int(distance[-1] / wavelength * (1.0 + 1e-6))
    if count < 1:
        return None
    first = min(1, count - 1)
    marks = np.minimum(wavelength * np.arange(first, count + 1), distance[-1])
    steps = np.diff(distance, prepend=0.0)
    ends = np.concatenate([[0.0], distance])

    def between(values: np.ndarray) -> np.ndarray:
        total = np.concatenate([[0.0], np.cumsum(values * steps)])
        return np.diff(np.interp(marks, ends, total)) / wavelength

    normal, shear, absolute, resultant, real_area, corrected_area = map(between, values)
    mean_normal = float(normal.mean())
    if not mean_normal > 0.0:
        return None
    cof = float(shear.mean()) / mean_normal
    area, corrected = float(real_area.mean()), float(corrected_area.mean())
    if corrected < LEAST_RESOLVED * area:
        corrected = math.nan
    return MicroAverages(
        cof_hysteresis=cof,
        cof_absolute=float(absolute.mean()) / mean_normal,
        cof_resultant=float(resultant.mean()) / mean_normal,
        area_per_force=area / mean_normal,
        real_contact_fraction=area / nominal_area,
        mean_pressure=mean_normal / nominal_area,
        wavelengths=count - first,
        scatter=float(np.abs(shear / normal - cof).max()) if normal.size > 1 else math.nan,
        area_per_force_corrected=corrected / mean_normal,
        real_contact_fraction_corrected=corrected / nominal_area,
    )
