"""How far a contact table is off between its nodes, by leaving nodes out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from underfoot.core import InputError

from .contact_table import QUANTITIES, ContactTable


def leave_out_errors(table: ContactTable, axis: str = "pressure") -> dict[str, float]:
    """Return the largest interpolation error at every second node when those are left out.

    The contact fraction is relative; the mean gap relative to the largest gap of the table;
    the others absolute. ``axis`` is "pressure" or "speed". The node distance is doubled, so that
    the table itself is several times better than this between its nodes.

    Errors
    ------
    InputError
        Fewer than 5 pressures or 5 speeds.
    """
    nodes = {"pressure": table.pressure, "speed": table.speed}[axis]
    if nodes.size < 5:
        raise InputError(
            f"{nodes.size} {axis} nodes", where="leave_out_errors", allowed="5 or more"
        )
    left = np.arange(1, nodes.size - 1, 2)
    kept = np.setdiff1d(np.arange(nodes.size), left)
    index = (kept, slice(None)) if axis == "pressure" else (slice(None), kept)
    changes = {"pressure": table.pressure[index[0]], "speed": table.speed[index[1]]}
    coarse = replace(
        table,
        values={name: array[index] for name, array in table.values.items()},
        deviation={name: array[index] for name, array in table.deviation.items()},
        realizations=table.realizations[index],
        **changes,
    )
    p, v = np.meshgrid(table.pressure, table.speed, indexing="ij")
    found = {
        "real_contact_fraction": coarse.real_contact_fraction(p, v),
        "cof_hysteresis": coarse.cof_hysteresis(p, v),
        "mean_gap": coarse.mean_gap(p, v),
        "flow_factor_along": coarse.flow_factor(p, v, "along"),
        "flow_factor_across": coarse.flow_factor(p, v, "across"),
    }
    errors = {}
    for name in QUANTITIES:
        error = np.abs(found[name] - table.values[name])
        if name == "real_contact_fraction":
            error = error / table.values[name]
        if name == "mean_gap":
            error = error / table.values[name].max()
        errors[name] = float(error.max())
    return errors
