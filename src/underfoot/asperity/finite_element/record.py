"""Rows of a march's history, and what a result makes of them."""

from __future__ import annotations

import numpy as np

from ._kernels import names
from .area import edge_excess_area
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
    "edges",
)
"""Of a row; forces and area are means over the steps since the row before, ``edges`` is the area
that the edges of contact spots count too much at the row's end."""


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
            _edges(assembly),
        ]
    )
    s[names.NORMAL : names.COUNT + 1] = 0.0
    return row


def _edges(assembly: Assembly) -> float:
    """Return the edge excess of the nodes that touch now, m^2."""
    nx, ny, _ = assembly.mesh.shape
    periodic = assembly.control[names.PERIODIC] != 0.0
    touching = (assembly.arrays[11][0] < 0.0).reshape(ny, nx)
    if periodic:
        touching = touching[:-1, :-1]
    dx, dy = (
        float(axis[-1]) / (count - 1)
        for axis, count in ((assembly.arrays[1], nx), (assembly.arrays[2], ny))
    )
    return edge_excess_area(touching, dx, dy, periodic=periodic)


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
        np.maximum(c["area"] - c["edges"], 0.0),
        wavelength=wavelength,
        nominal_area=area,
    )
