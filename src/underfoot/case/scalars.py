"""The named numbers of a result, each with its spread or the reason why there is none."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from underfoot.core import SourcedValue, Status

if TYPE_CHECKING:
    from underfoot.friction import FrictionCoefficients, SampledCof
    from underfoot.outsole import SensorReading
    from underfoot.outsole.solver import SoleContact
    from underfoot.slip import SlipRisk

    from .case import Case

_NOT_ESTIMATED = "heel shape and interface roughness dominate; their spread is not propagated yet"
CONTACT_SHARE = 1e-3
"""Contact pressure below this share of the mean pressure doesn't count as contact."""
_INPUTS = {
    "cof_boundary": "friction at rest",
    "cof_hysteresis": "hysteresis",
    "cof_asymptote": "friction at high speed",
    "cof_adhesion": "adhesion",
    "dry_adhesion": "dry adhesion",
    "tau_hydro": "decay speed",
    "fine_roughness": "fine roughness",
    "roughness_factor": "roughness",
    "shear_strength": "shear strength",
    "model": "the law itself",
}
REGIMES = ((0.05, "boundary lubrication"), (0.95, "mixed lubrication"), (np.inf, "full film"))


def scalars(
    case: Case,
    contact: SoleContact,
    friction: FrictionCoefficients,
    sensor: SensorReading,
    sampled: SampledCof | None = None,
) -> tuple[dict[str, SourcedValue], SlipRisk]:
    """Return the numbers of a result by name, and the slip risk behind one of them."""
    from underfoot.slip import RequiredFriction, slip_model, slip_risk

    mean, spread = case.sourced("risk.rcof_mean"), case.sourced("risk.rcof_sd")
    # the case itself lists an assumed required friction, so the risk need not do so again
    risk = slip_risk(
        friction.cof,
        rcof=RequiredFriction(case.risk.rcof_mean, case.risk.rcof_sd, mean.source),
        model=slip_model(case.risk.model),
        samples=None if sampled is None else sampled.cof,
    )
    assumed = risk.probability.assumed or mean.assumed or spread.assumed

    def computed(value: float, unit: str, note: str = "") -> SourcedValue:
        return SourcedValue(
            value, unit, source="coupled contact and film", reason=_NOT_ESTIMATED, note=note
        )

    touching = contact.contact_pressure > CONTACT_SHARE * _mean_pressure(contact)
    under_load = touching | (contact.fluid_pressure > 0)
    thinnest = None
    if under_load.any() and case.contaminant is not None:
        thinnest = float(contact.film_thickness[under_load].min())
    numbers = {
        "cof": friction.cof,
        "cof_adhesion": friction.cof_adhesion,
        "cof_hysteresis": friction.cof_hysteresis,
        "cof_viscous": friction.cof_viscous,
        "normal_force": case.sourced("motion.normal_force"),
        "fluid_load": computed(contact.fluid_load, "N"),
        "fluid_load_sensor": sensor.load,
        "peak_fluid_pressure": computed(float(contact.fluid_pressure.max()), "Pa"),
        "peak_fluid_pressure_sensor": sensor.peak_pressure,
        "contact_area": computed(
            float(np.count_nonzero(touching)) * contact.spacing**2, "m^2", "apparent, on the grid"
        ),
        "minimum_film_thickness": computed(thinnest, "m")
        if thinnest is not None
        else SourcedValue(None, "m", reason="dry floor: no film"),
        "slip_probability": replace(risk.probability, assumed=assumed),
    }
    return numbers, risk


def undetermined(case: Case, status: Status) -> dict[str, SourcedValue]:
    """Return the same names without numbers: what a computation that failed may show."""
    units = {
        "fluid_load": "N",
        "fluid_load_sensor": "N",
        "peak_fluid_pressure": "Pa",
        "peak_fluid_pressure_sensor": "Pa",
        "contact_area": "m^2",
        "minimum_film_thickness": "m",
    }
    names = ("cof", "cof_adhesion", "cof_hysteresis", "cof_viscous", *units, "slip_probability")
    found = {name: SourcedValue(None, units.get(name, "1"), reason=str(status)) for name in names}
    return {**found, "normal_force": case.sourced("motion.normal_force")}


def regime(contact: SoleContact) -> dict[str, str]:
    """Return the lubrication regime by the share of the load that the fluid carries."""
    share = contact.fluid_load / contact.normal_force
    name = next(name for limit, name in REGIMES if share <= limit)
    return {
        "regime": name,
        "regime_rule": "by load share: below 5 % boundary, above 95 % full film",
    }


def spread_origin(sampled: SampledCof | None) -> dict[str, str]:
    """Return in words which inputs the spread of COF comes from, and how it was sampled."""
    if sampled is None:
        return {}
    words = sorted(sampled.share.items(), key=lambda one: -one[1])
    parts = [f"{_INPUTS.get(name, name)} {share:.0%}" for name, share in words if share >= 0.005]
    if sampled.left_out:
        names = ", ".join(_INPUTS.get(name, name) for name in sampled.left_out)
        parts.append(f"taken as exact: {names}")
    drawn = f"{sampled.cof.size} draws, seed {sampled.seed}; contact and film as computed"
    return {"cof_spread_from": ", ".join(parts), "cof_spread_how": drawn}


def _mean_pressure(contact: SoleContact) -> float:
    loaded = np.count_nonzero(contact.total_pressure > 0)
    return contact.normal_force / max(loaded * contact.spacing**2, contact.spacing**2)
