"""What is spilled on the floor."""

import math
from dataclasses import dataclass

from underfoot.core import InputError, RangeError, SourcedValue, display
from underfoot.core.remark import Message

from .cheng_2008 import SOURCE as CHENG
from .cheng_2008 import glycerol_water_density, glycerol_water_viscosity
from .strobel_2012 import AdhesionBlocking

CHENG_DEVIATION = 0.05
"""Largest relative deviation Cheng states from the tabulated data, 0-100 %, 0-100 degC."""


@dataclass(frozen=True, slots=True)
class Contaminant:
    """A Newtonian liquid on the floor.

    Parameters:
        name: What a person calls it.
        viscosity: Dynamic, Pa s, measured (preferred) or computed; its source says which.
        density: kg/m^3, where known.
        temperature: K, at which the viscosity holds, where known.
        blocking: How much adhesion it leaves (Eq. 26), where measured.
    """

    name: str
    viscosity: SourcedValue
    density: SourcedValue | None = None
    temperature: float | None = None
    blocking: AdhesionBlocking | None = None

    def __post_init__(self) -> None:
        _check(self.viscosity, "viscosity", "Pa*s")
        if self.density is not None:
            _check(self.density, "density", "kg/m^3")
        if self.temperature is not None and not self.temperature > 0.0:
            raise RangeError(
                Message("temperature {temperature:g} K", temperature=self.temperature),
                where="temperature",
                allowed="above 0 K",
            )


@dataclass(frozen=True, slots=True)
class ViscosityComparison:
    """A measured viscosity beside the ones computed from a stated glycerol percentage."""

    measured: float
    by_mass: float
    by_volume: float

    @property
    def closer_basis(self) -> str:
        """Reading of the percentage that comes closer to the measurement."""
        mass, volume = (abs(math.log(x / self.measured)) for x in (self.by_mass, self.by_volume))
        return "mass" if mass <= volume else "volume"

    @property
    def deviation(self) -> float:
        """Relative deviation of the closer computed value from the measured one."""
        nearer = self.by_mass if self.closer_basis == "mass" else self.by_volume
        return nearer / self.measured - 1.0

    @property
    def explained(self) -> bool:
        """True when one of the two readings is within the 5 % that the formula claims."""
        return abs(self.deviation) <= CHENG_DEVIATION

    def __str__(self) -> str:
        cp = [display(value, "Pa*s") for value in (self.measured, self.by_mass, self.by_volume)]
        verdict = (
            f"it is the percentage by {self.closer_basis}"
            if self.explained
            else f"neither fits (the closer one, by {self.closer_basis}, is off by "
            f"{100.0 * self.deviation:+.0f} %)"
        )
        return f"measured {cp[0]}; computed {cp[1]} by mass, {cp[2]} by volume: {verdict}"


def glycerol_water(
    fraction: float,
    temperature: float,
    basis: str = "mass",
    *,
    measured_viscosity: SourcedValue | None = None,
    blocking: AdhesionBlocking | None = None,
) -> Contaminant:
    """Return a glycerol-water mixture as a contaminant.

    The measured viscosity, where given, is what counts; the computed one then stands in its
    note, so that a disagreement is seen. ``fraction`` 0 to 1, ``temperature`` in K, ``basis``
    "mass" or "volume".

    Parameters:
        fraction: Of glycerol, 0 to 1.
        temperature: K.
        basis: Of the fraction: "mass" or "volume".
        measured_viscosity: Pa s; None takes the computed one.
        blocking: How the fluid blocks adhesion; None where it is not known.

    >>> glycerol_water(0.9, 293.15).viscosity.unit
    'Pa*s'
    """
    computed = glycerol_water_viscosity(fraction, temperature, basis)
    label = f"glycerol {100.0 * fraction:g} % by {basis}, {temperature - 273.15:g} degC"
    if measured_viscosity is None:
        viscosity = SourcedValue(
            computed,
            "Pa*s",
            source=CHENG,
            uncertainty=CHENG_DEVIATION / math.sqrt(3.0) * computed,
            note="uncertainty: Cheng's largest deviation of 5 % taken as a uniform distribution",
        )
    else:
        _check(measured_viscosity, "measured_viscosity", "Pa*s")
        comparison = compared_viscosity(measured_viscosity, fraction, temperature)
        viscosity = SourcedValue(
            measured_viscosity.value,
            "Pa*s",
            source=measured_viscosity.source,
            uncertainty=measured_viscosity.uncertainty,
            reason=measured_viscosity.reason,
            assumed=measured_viscosity.assumed,
            note="; ".join(filter(None, (measured_viscosity.note, str(comparison)))),
        )
    density = SourcedValue(
        glycerol_water_density(fraction, temperature, basis),
        "kg/m^3",
        source=CHENG,
        note="mixed without contraction",
    )
    return Contaminant(label, viscosity, density, temperature, blocking)


def compared_viscosity(
    measured: SourcedValue, fraction: float, temperature: float
) -> ViscosityComparison:
    """Return a measured viscosity beside the computed ones, percentage read both ways.

    Published percentages often don't say whether they are by mass or by volume, and the grant
    report mixes both: 25 and 50 % fit by mass, 75 and 90 % are nearer to by volume.

    Parameters:
        measured: Viscosity in Pa s.
        fraction: Published, 0 to 1.
        temperature: K.
    """
    _check(measured, "measured", "Pa*s")
    assert measured.value is not None  # _check refuses None
    return ViscosityComparison(
        measured=measured.value,
        by_mass=glycerol_water_viscosity(fraction, temperature, "mass"),
        by_volume=glycerol_water_viscosity(fraction, temperature, "volume"),
    )


def _check(quantity: SourcedValue, name: str, unit: str) -> None:
    if quantity.unit.replace(" ", "") not in (unit, unit.replace("*", "")):
        raise InputError(
            Message('{name} has the unit "{unit}"', name=name, unit=quantity.unit),
            where=name,
            allowed=unit,
        )
    if quantity.value is None or not (math.isfinite(quantity.value) and quantity.value > 0.0):
        raise RangeError(
            Message("{name} is {value}", name=name, value=quantity.value),
            where=name,
            allowed=f"above 0 {unit}",
        )
