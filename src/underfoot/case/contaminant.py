"""Slot for the fluid on the floor: its viscosity as measured, or glycerol in water."""

import math
from abc import abstractmethod
from dataclasses import replace
from typing import Annotated, ClassVar, Literal

import numpy as np

from underfoot.core import Breach, SourcedValue

from .quantity import Quantity, Viscosity, default, required
from .section import Option

Fraction = Annotated[float, Quantity("1", 0.0, 1.0)]
Temperature = Annotated[float, Quantity("K", 250.0, 450.0)]

SLOPE = 0.01
"""Share of a spread over which the slope of the viscosity is taken."""


class ContaminantSection(Option):
    """Fluid on the floor."""

    slot: ClassVar[str] = "contaminant"
    usual: ClassVar[str | None] = "measured"

    pool_depth: Annotated[float, Quantity("m", 1e-6, 0.05)] = default(
        0.6e-3,
        "0.6 mm",
        "final progress report on shoe-floor friction, G.6.1 (150 ml on 0.4 m x 0.6 m)",
    )

    @abstractmethod
    def build(self) -> SourcedValue:
        """Return the dynamic viscosity, Pa s."""

    def breaches(self) -> list[Breach]:
        return []

    @property
    def chemistry(self) -> Literal["aqueous", "detergent", "oil"]:
        """Family of the fluid, by what its boundary film leaves of adhesion."""
        return "aqueous"


class MeasuredFluid(ContaminantSection):
    """Fluid of known viscosity."""

    name: ClassVar[str] = "measured"
    source: ClassVar[str] = "viscosity as given"

    viscosity: Viscosity = required(
        "dynamic viscosity as measured",
        missing="neither a viscosity nor a share of glycerol is given",
        remedy='Write viscosity = "219 cP", or glycerol_fraction = "90 %" with its basis. Without '
        'one only a measured friction applies: contaminant = "none" with friction.model = '
        '"constant" or "table", and no film',
    )

    family: Literal["aqueous", "detergent", "oil"] = default(
        "aqueous", "aqueous", "not given: taken as no oil", assumed=True
    )

    @property
    def chemistry(self) -> Literal["aqueous", "detergent", "oil"]:
        return self.family

    def build(self) -> SourcedValue:
        return self.sourced_value("viscosity")


class GlycerolWater(ContaminantSection):
    """Glycerol in water; the viscosity follows from share and temperature."""

    name: ClassVar[str] = "glycerol_water"
    source: ClassVar[str] = "Cheng 2008"
    chosen_by: ClassVar[tuple[str, ...]] = ("glycerol_fraction",)

    glycerol_fraction: Fraction
    fraction_basis: Literal["mass", "volume"] = required(
        missing="is missing: the same percentage by mass and by volume differs by half in viscosity"
    )
    temperature: Temperature = default(293.15, "20 degC", "room temperature", assumed=True)

    def build(self) -> SourcedValue:
        from underfoot.fluid import glycerol_water, glycerol_water_viscosity
        from underfoot.fluid.cheng_2008 import RANGES

        at = {"fraction": self.glycerol_fraction, "temperature": self.temperature}
        viscosity = glycerol_water(*at.values(), basis=self.fraction_basis).viscosity
        spreads = [viscosity.uncertainty or 0.0]
        for name, field in (("fraction", "glycerol_fraction"), ("temperature", "temperature")):
            if spread := self.sourced_value(field).uncertainty:
                near = at[name] - SLOPE * spread, at[name] + SLOPE * spread
                ends = np.clip(near, RANGES[name].low, RANGES[name].high)
                values = glycerol_water_viscosity(**{**at, name: ends}, basis=self.fraction_basis)
                spreads.append(spread * float(np.ptp(values) / np.ptp(ends)))
        return replace(viscosity, uncertainty=math.hypot(*spreads))

    def breaches(self) -> list[Breach]:
        from underfoot.fluid import glycerol_water_breaches

        return glycerol_water_breaches(self.glycerol_fraction, self.temperature)
