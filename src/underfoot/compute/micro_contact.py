"""The rough contact of two measured surfaces under the sole: real area, hysteresis, gap, flow."""

import math
from dataclasses import dataclass

from underfoot.case.friction import contact_deviation
from underfoot.core import SourcedValue
from underfoot.core.remark import Amount, Message
from underfoot.rough_contact import ContactTable
from underfoot.sole_contact.solver import SoleContact

from .prepare import Prepared

GAP_ERROR, FLOW_ERROR = 0.1, 0.45
"""Relative error of gap and flow factor of nested grids beside one grid: 8 % and 6 to 45 %
(docs/physics/contact_table.md)."""


@dataclass(frozen=True, slots=True)
class MicroContact:
    """A contact table at the pressure on which the sole's contact rests.

    ``pressure`` (Pa): mean over the load; ``gap_deviation``, ``flow_deviation``: relative standard
    deviations of mean gap and flow factor; ``contact_deviation``: of ln of area and hysteresis.
    """

    table: ContactTable
    pressure: float
    speed: float
    contact_deviation: float
    gap_deviation: float
    flow_deviation: float

    def scalars(self) -> dict[str, SourcedValue]:
        """Return real area (share of the apparent), hysteresis COF, mean gap (m), flow factor."""
        at = Message("at {pressure}", pressure=Amount(self.pressure, "Pa"))
        names = {
            "micro_contact": ("real_contact_fraction", self.contact_deviation),
            "micro_hysteresis": ("cof_hysteresis", self.contact_deviation),
            "micro_gap": ("mean_gap", self.gap_deviation),
            "micro_flow": ("flow_factor_along", self.flow_deviation),
        }
        found = {}
        for name, (quantity, deviation) in names.items():
            value = self._value(quantity)
            most = 1.0 if quantity != "mean_gap" else math.inf
            factor = math.exp(1.96 * deviation)
            found[name] = SourcedValue(
                value,
                "m" if quantity == "mean_gap" else "1",
                source=f"contact table: {self.table.description}",
                uncertainty=deviation * value,
                interval=(value / factor, min(value * factor, most)),
                note=at,
            )
        return found

    def _value(self, quantity: str) -> float:
        at = self.pressure, self.speed, "extend"
        if quantity == "flow_factor_along":
            return max(float(self.table.flow_factor(*at[:2], outside="extend")), 0.0)
        return float(getattr(self.table, quantity)(*at))


def micro_contact(parts: Prepared, contact: SoleContact) -> MicroContact | None:
    """Return the rough contact of a case at its pressure; None without measured surfaces."""
    table = parts.context.rough_contact(parts.context)
    loaded = contact.contact_pressure
    if table is None or "rough_contact" in parts.objects or not loaded.any():
        return None
    pressure = float((loaded**2).sum() / loaded.sum())
    speed = parts.case.motion.speed
    inside = min(max(pressure, table.pressure[0]), table.pressure[-1])
    at = inside, min(max(abs(speed), table.speed[0]), table.speed[-1])
    rq = parts.context.rq_deviation or 0.0
    spreads = []
    for quantity, error in (("mean_gap", GAP_ERROR), ("flow_factor_along", FLOW_ERROR)):
        value = table.sourced_value(quantity, *at)
        mean = (value.uncertainty or 0.0) / math.sqrt(float(table.realizations.min()))
        spreads.append(math.hypot(mean / max(float(value), 1e-30), rq, error))
    deviation = contact_deviation(table, *at, parts.context)
    return MicroContact(table, pressure, speed, deviation, spreads[0], min(spreads[1], 1.0))
