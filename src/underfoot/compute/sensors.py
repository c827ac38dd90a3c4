"""What sensors in the floor read of a solved contact."""

from underfoot.case import Case
from underfoot.core.presentation import percent
from underfoot.core.remark import NOTHING, Message
from underfoot.shoe import SoleMap
from underfoot.sole_contact import SensorReading, floor_sensor_reading
from underfoot.sole_contact.reading import BLIND
from underfoot.sole_contact.sole_state import SoleState

FILM_WORTH_SEEING = 0.01
"""Share of the load on the film below which no caution about the sensor is given."""


def scan_reading(
    case: Case, sole: SoleMap, state: SoleState, *, viscosity: float | None, offsets: int = 11
) -> SensorReading:
    """Return what the scans of the case read under one state."""
    return floor_sensor_reading(
        sole.x,
        sole.y,
        state.fluid_pressure,
        state.film_thickness,
        inlet_diameter=case.sensor.inlet_diameter,
        scan_spacing=case.sensor.scan_spacing,
        scans=case.sensor.scans,
        offsets=offsets,
        compliance=case.sensor.compliance if viscosity and state.speed > 0 else 0.0,
        viscosity=viscosity or 0.0,
        speed=state.speed,
    )


def blind_sensor(case: Case, reading: SensorReading, state: SoleState) -> Message:
    """Return the caution about an inlet that cannot see the film; empty where it can."""
    if reading.seen >= BLIND or state.fluid_load < FILM_WORTH_SEEING * (
        state.fluid_load + state.contact_load
    ):
        return NOTHING
    return Message(
        "of the film's load {share} lies where an inlet of {inlet:.3g} mm reads half of its "
        "pressure or more: elsewhere its rim meets a channel or the film's end and reads less. "
        "A low reading does not show that there is no film.",
        share=percent(reading.seen),
        inlet=1e3 * case.sensor.inlet_diameter,
    )
