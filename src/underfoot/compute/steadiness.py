"""Is an answer that of steady sliding, and what becomes of it if it is not?"""

from collections.abc import Mapping

import numpy as np

from underfoot.core import SourcedValue
from underfoot.sole_contact.solver import SoleContact

from .contact_friction import friction_sums
from .prepare import Prepared

WITHIN = 0.01
"""Share of COF, and of the load on the film or on what touches, by which a steady answer moves."""
LATER = ("later_time", "later_cof", "later_fluid_load")


def steady_slide(parts: Prepared, contact: SoleContact) -> dict[str, SourcedValue]:
    """Return by name how far (m) a sole slides until its film stays; empty where that is unknown.

    Known of a march to the steady state.
    """
    if parts.viscosity is None or parts.case.motion.end_time is not None:
        return {}
    slid = parts.case.motion.speed * settling_time(contact)
    return {"steady_slide": SourcedValue(slid, "m", source="coupled contact and film")}


def later_numbers(parts: Prepared, contact: SoleContact) -> dict[str, SourcedValue]:
    """Return ``LATER`` of a motion that ends, empty of steady sliding and on a dry floor.

    Time (s), COF and load on the film (N) where load, speed and shoe angle are held on at its end.
    """
    motion = parts.case.motion
    if parts.viscosity is None or motion.end_time is None:
        return {}
    later = contact.later or contact
    cof = friction_sums(parts.local_law, later, motion.speed).cof.value
    values = (later.time, "s"), (cof, "1"), (later.fluid_load, "N")
    source = "contact and film with load, speed and shoe angle held on"
    return {
        name: SourcedValue(value, unit, source=source)
        for name, (value, unit) in zip(LATER, values, strict=True)
    }


def settling_time(contact: SoleContact) -> float:
    """Return the time (s) from which on the load on the film is that at the end.

    Within a step, that of an implicit Euler step with the memory that its two ends tell of.
    """
    time, film = np.array(contact.history.time), np.array(contact.history.fluid_load)
    least = _least(film[-1], contact.normal_force)
    off = np.abs(film - film[-1])
    far = np.flatnonzero(off > least)
    if not far.size:
        return float(time[0])
    begin, end = far[-1], far[-1] + 1
    step = time[end] - time[begin]
    memory = step * off[end] / (off[begin] - off[end])
    return float(time[begin] + min(step, memory * np.log(off[begin] / least)))


def with_steadiness(values: Mapping[str, SourcedValue]) -> dict[str, SourcedValue]:
    """Return the numbers of a result without ``LATER`` where it is steady."""
    if "later_cof" not in values:
        return dict(values)
    names = ("cof", "later_cof", "fluid_load", "later_fluid_load", "normal_force")
    cof, later, film, later_film, whole = (float(values[name]) for name in names)
    moves = abs(later - cof) > WITHIN * cof or abs(later_film - film) > _least(film, whole)
    return {name: value for name, value in values.items() if moves or name not in LATER}


def _least(film: float, whole: float) -> float:
    """Return by how much (N) a load on the film of the whole load differs from another."""
    return WITHIN * max(min(film, whole - film), WITHIN * whole)
