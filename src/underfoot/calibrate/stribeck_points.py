"""The pin-on-disk data of the report as points: what stands for the readings it does not print."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from underfoot.core import InputError

if TYPE_CHECKING:
    from underfoot.core.catalogue import Catalogue, Entry
    from underfoot.friction import BoundaryFriction

SPEEDS = np.array([0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0])
"""m/s, the 11 speeds of the report (G.2.1)."""


@dataclass(frozen=True, slots=True)
class CofPoints:
    """COF of one fluid at several speeds.

    ``curve``: the points lie on a published fit of Eq. 17 ("fit") or are one published mean over
    all speeds ("mean"); the single readings are not published. ``cof_boundary`` is COF_BL where
    it was measured as the limit at low speed, None for a mean. ``rq`` of the sole, m.
    """

    fluid: str
    viscosity: float
    speed: NDArray[np.float64]
    cof: NDArray[np.float64]
    curve: str
    rq: float
    cof_boundary: float | None
    label: str = ""


@dataclass(frozen=True, slots=True)
class Pin:
    """What the mechanisms need to know of the pin-on-disk of G.2.

    ``modulus`` of the sole (Pa), ``poisson_ratio`` (assumed), ``sole_rq`` and ``floor_rq`` (m) by
    stylus with the cut-off ``cutoff`` (m), ``radius`` of the pin (m), ``normal_force`` (N).
    """

    modulus: float
    sole_rq: float
    floor_rq: float
    cutoff: float
    radius: float
    normal_force: float
    pressure: float
    poisson_ratio: float = 0.5


def pin_on_disk(catalogue: Catalogue) -> Pin:
    """Return the pin-on-disk of the report's speed series from the catalogue."""
    sole = catalogue.entry("material", "polyurethane_g2")
    floor = catalogue.entry("floor", "vinyl_g2")
    method = catalogue.entry("setup", "pin_on_disk_g2")

    def number(entry: Entry, path: str, unit: str) -> float:
        value = entry.sourced_value(path, unit).value
        assert value is not None  # entries of the package hold numbers
        return float(value)

    return Pin(
        modulus=number(sole, "modulus", "Pa"),
        sole_rq=number(sole, "roughness.rq", "m"),
        floor_rq=number(floor, "roughness.rq", "m"),
        cutoff=number(floor, "roughness.cutoff", "m"),
        radius=number(method, "method.reduced_radius", "m"),
        normal_force=number(method, "method.normal_force", "N"),
        pressure=number(method, "method.pressure", "Pa"),
    )


def fluid_points(
    friction: BoundaryFriction, *, rq: float, speed: NDArray[np.float64] = SPEEDS
) -> CofPoints:
    """Return COF of a measured fluid at ``speed``: its fit of Eq. 17, else its mean."""
    from underfoot.friction import stribeck_cof

    boundary = friction.cof_boundary.value
    if boundary is None:
        raise InputError("no boundary friction was measured", where=friction.fluid)
    tau, left = friction.tau_hydro, friction.cof_asymptote
    fitted = tau is not None and left is not None
    if tau is not None and left is not None:
        cof = stribeck_cof(speed, boundary, float(tau), float(left))
    else:
        cof = np.full(speed.shape, boundary)
    return CofPoints(
        fluid=friction.fluid,
        viscosity=friction.viscosity,
        speed=speed,
        cof=cof,
        curve="fit" if fitted else "mean",
        rq=rq,
        cof_boundary=boundary if fitted else None,
        label=friction.fluid,
    )


def roughness_series(catalogue: Catalogue) -> tuple[CofPoints, ...]:
    """Return Table 3: two glycerols on three roughnesses of the sole, Eq. 17 at the 11 speeds."""
    from underfoot.friction import stribeck_cof

    entry = catalogue.entry("published", "pin_on_disk_g2")
    units = {"viscosity": "Pa*s", "rq": "m", "cof_bl": "1", "tau_hydro": "m/s"}
    units["cof_asymptote"] = "1"
    columns = [entry.numbers(f"roughness_series.{name}", unit) for name, unit in units.items()]
    return tuple(
        CofPoints(
            fluid="glycerol_25pct" if viscosity < 3e-3 else "glycerol_50pct",
            viscosity=viscosity,
            speed=SPEEDS,
            cof=stribeck_cof(SPEEDS, boundary, tau, left),
            curve="fit",
            rq=rq,
            cof_boundary=boundary,
            label=f"{'25' if viscosity < 3e-3 else '50'} % glycerol, Rq {rq * 1e6:.1f} um",
        )
        for viscosity, rq, boundary, tau, left in zip(*columns, strict=True)
    )
