"""Rows of a march's history, and what a result makes of them."""

from __future__ import annotations

import numpy as np

from ._kernels import names
from .assembly import Assembly
from .averages import whole_wavelength_averages
from .inputs import EnergyLedger, MicroAverages

COLUMNS = (
    "time",
    "distance",
    "normal",
    "shear",
    "lateral",
    "area",
    "absolute",
    "resultant",
    "top",
    "floor_work",
    "top_work",
    "kinetic",
    "strain",
    "hourglass",
    "contact",
    "material_loss",
    "hourglass_loss",
    "contact_loss",
    "damping_loss",
)
"""Of a row; forces and area are means over the steps since the row before."""


def new_row(assembly: Assembly, before: np.ndarray | None, rate: float) -> np.ndarray:
    """Return the row of the sample just marched, and start the next one.

    ``rate`` is the loss rate at the row before: the loss is integrated by trapezoids.
    """
    s = assembly.state
    count = s[names.COUNT]
    # State holds the moment after the last move; energies and forces belong to the one before it.
    time = s[names.TIME] - assembly.time_step
    distance = s[names.SLID] - s[names.LAST_STEP]
    lost = 0.0
    if before is not None:
        lost = before[15] + 0.5 * (rate + s[names.LOSS_RATE]) * (time - before[0])
    row = np.array(
        [
            time,
            distance,
            *(s[names.NORMAL : names.COUNT] / count),
            s[names.TOP],
            s[names.SAMPLE_FLOOR_WORK],
            s[names.SAMPLE_TOP_WORK],
            s[names.KINETIC],
            s[names.STRAIN],
            s[names.HOURGLASS],
            s[names.CONTACT_ENERGY],
            lost,
            s[names.HOURGLASS_LOSS],
            s[names.CONTACT_LOSS],
            s[names.DAMPING_LOSS],
        ]
    )
    s[names.NORMAL : names.COUNT + 1] = 0.0
    return row


def ledger(rows: np.ndarray) -> EnergyLedger:
    """Return the energies of rows (n, columns)."""
    c = dict(zip(COLUMNS, rows.T, strict=True))
    return EnergyLedger(
        time=c["time"],
        floor_work=c["floor_work"],
        top_work=c["top_work"],
        kinetic=c["kinetic"],
        strain=c["strain"],
        hourglass=c["hourglass"],
        contact=c["contact"],
        material_loss=c["material_loss"],
        hourglass_loss=c["hourglass_loss"],
        contact_loss=c["contact_loss"],
        damping_loss=c["damping_loss"],
    )


def averages(rows: np.ndarray, wavelength: float, area: float) -> MicroAverages | None:
    """Return the means over whole wavelengths of the sliding rows."""
    c = dict(zip(COLUMNS, rows[rows[:, 1] > 0.0].T, strict=True))
    return whole_wavelength_averages(
        c["distance"],
        c["normal"],
        c["shear"],
        c["absolute"],
        c["resultant"],
        c["area"],
        wavelength=wavelength,
        nominal_area=area,
    )
