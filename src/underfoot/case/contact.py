"""Slots of the contact: hardness to modulus, rough contact, compliance of the sole, film."""

from __future__ import annotations

import math
from abc import abstractmethod
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

import numpy as np

from underfoot.core import Breach, Cache, SourcedValue

from .context import Context
from .quantity import Flag, Quantity, default
from .section import Option
from .surfaces import WAVES

if TYPE_CHECKING:
    from underfoot.film import FilmModel
    from underfoot.rough_contact.pressure_gap_law import PressureGapLaw
    from underfoot.shoe import SoleMap
    from underfoot.sole_contact.compliance import Compliance

HARDNESS_SPREAD = 0.3
"""Relative standard deviation of a modulus from hardness (assumed: tens of percent)."""
TABLE_CELLS, TABLE_SURFACES, TABLE_WAVES = 128, 4, 4
"""Contact table: cells along a side, surfaces, longest waves along a side."""
TABLE_PRESSURES = (1e3, 2e6, 14)
"""Contact table: lowest and highest nominal pressure, Pa, and their number."""
ELASTIC_RQ, ELASTIC_MODULUS, ELASTIC_PRESSURES = 1e-6, 1e6, (1.0, 3e4, 22)
"""Contact table of an elastic compound: Rq (m), Young's modulus and pressures (Pa) at which it is
computed, once for every roughness and hardness."""


class HardnessOption(Option):
    """Young's modulus from Shore A hardness, where none was measured."""

    slot: ClassVar[str] = "hardness"
    usual: ClassVar[str | None] = "gent"

    @abstractmethod
    def build(self, shore_a: float) -> tuple[SourcedValue, list[Breach]]:
        """Return Young's modulus, Pa, and what leaves the range of the relation."""


class _Published(HardnessOption):
    """Relation of ``material`` by the option's name."""

    def build(self, shore_a: float) -> tuple[SourcedValue, list[Breach]]:
        from underfoot import material

        relation, breaches = {
            "gent": (material.youngs_modulus_gent, material.gent_breaches),
            "ruess": (material.youngs_modulus_ruess, material.ruess_breaches),
        }[self.name]
        modulus = float(relation(shore_a))
        sourced = SourcedValue(
            modulus,
            "Pa",
            source=f"{self.source} from Shore A {shore_a:g}",
            uncertainty=HARDNESS_SPREAD * modulus,
            note="static modulus from hardness, good to tens of percent",
        )
        return sourced, breaches(shore_a)


class GentHardness(_Published):
    """Gent 1958."""

    name: ClassVar[str] = "gent"
    source: ClassVar[str] = "Gent 1958"


class RuessHardness(_Published):
    """Ruess."""

    name: ClassVar[str] = "ruess"
    source: ClassVar[str] = "Ruess"


class RoughContactOption(Option):
    """How the rough interface carries load and lets fluid through."""

    slot: ClassVar[str] = "rough_contact"
    usual: ClassVar[str | None] = "exponential"

    @abstractmethod
    def build(self, context: Context) -> PressureGapLaw:
        """Return the law of pressure and permeability against the mean gap."""


class ExponentialContact(RoughContactOption):
    """One formula, no flow factor."""

    name: ClassVar[str] = "exponential"
    source: ClassVar[str] = "Persson 2007, low-load form"

    def build(self, context: Context) -> PressureGapLaw:
        from underfoot.rough_contact import ExponentialLaw

        return ExponentialLaw(context.youngs_modulus, context.poisson_ratio, context.rq_value)


class ContactTableOption(RoughContactOption):
    """Self-affine surfaces of the interface's Rq in sliding contact with the outsole's rubber, with
    the flow factors of their own gaps; computed once and cached. Elastic compounds of one set of
    waves share one table: heights and pressures scale.
    """

    name: ClassVar[str] = "contact_table"
    source: ClassVar[str] = "sliding rough contact by boundary elements"
    reads: ClassVar[tuple[str, ...]] = WAVES

    def build(self, context: Context) -> PressureGapLaw:
        from underfoot.material import Elastomer
        from underfoot.rough_contact import ContactTable
        from underfoot.surface import self_affine

        rq, waves, speed = context.rq_value, context.interface, context.motion.speed
        elastic = context.shoe.material.relaxation is None
        height, rubber, pressures, speeds = (
            (ELASTIC_RQ, Elastomer(ELASTIC_MODULUS, context.poisson_ratio), ELASTIC_PRESSURES, [1])
            if elastic
            else (rq, context.rubber(), TABLE_PRESSURES, [0.5 * speed, speed, 2.0 * speed])
        )
        side = TABLE_WAVES * waves.longest_wave
        spacing = min(side / TABLE_CELLS, waves.shortest_wave / 2)
        cells = 2 * math.ceil(side / spacing / 2)
        shape = (height, waves.hurst, waves.longest_wave, waves.shortest_wave)
        seeds = range(TABLE_SURFACES)
        surfaces = [self_affine(cells, side / cells, *shape, seed) for seed in seeds]
        table = ContactTable.from_surfaces(
            surfaces,
            rubber,
            np.geomspace(*pressures),
            np.array(speeds, dtype=float),
            poisson_ratio=context.poisson_ratio,
            cache=Cache("contact_table"),
            description=f"self-affine interface, Rq {rq * 1e6:.3g} um",
            progress=context.progress,
        )
        if not elastic:
            return table.law(speed)
        higher, stiffer = rq / ELASTIC_RQ, context.youngs_modulus / ELASTIC_MODULUS
        return table.law(1.0).scaled(higher, higher * stiffer)


class ComplianceOption(Option):
    """How the sole gives way under pressure."""

    slot: ClassVar[str] = "compliance"
    usual: ClassVar[str | None] = "layered"
    cut: ClassVar[bool] = False
    """Whether sipes finer than the grid let the lugs give way further."""

    @abstractmethod
    def build(self, context: Context, sole: SoleMap) -> Compliance:
        """Return the map from pressure to deflection on the grid of ``sole``."""


def _layers(context: Context) -> dict[str, Any]:
    layers, midsole = context.shoe.sole, context.shoe.sole.midsole
    return {
        "modulus": context.youngs_modulus,
        "poisson_ratio": context.poisson_ratio,
        "thickness": layers.outsole_thickness,
        "shoe_angle": context.motion.shoe_angle,
        "midsole_modulus": midsole and midsole.modulus,
        "midsole_thickness": midsole and midsole.thickness,
        **({"midsole_poisson_ratio": midsole.poisson_ratio} if midsole else {}),
    }


class LayeredCompliance(ComplianceOption):
    """Endless layers with free edges, by convolution."""

    name: ClassVar[str] = "layered"
    source: ClassVar[str] = "outsole layer with free edges"
    cut: ClassVar[bool] = True

    def build(self, context: Context, sole: SoleMap) -> Compliance:
        from underfoot.sole_contact.compliance import layered_compliance

        return layered_compliance(sole, **_layers(context))


class FiniteElementCompliance(ComplianceOption):
    """The real shape of sole, lugs and rim, condensed once and kept in the cache."""

    name: ClassVar[str] = "finite_element"
    source: ClassVar[str] = "linear finite elements, condensed to the sole's surface"

    def build(self, context: Context, sole: SoleMap) -> Compliance:
        from underfoot.sole_contact.finite_element import finite_element_compliance

        store = Cache("sole_compliance-1")
        return finite_element_compliance(
            sole, **_layers(context), cache=store, progress=context.progress
        )


class HalfSpaceCompliance(ComplianceOption):
    """Elastic half-space, for comparison."""

    name: ClassVar[str] = "half_space"
    source: ClassVar[str] = "Boussinesq half-space"

    def build(self, context: Context, sole: SoleMap) -> Compliance:
        from underfoot.sole_contact.compliance import half_space_compliance

        return half_space_compliance(
            (sole.x.size, sole.y.size),
            sole.spacing,
            modulus=context.youngs_modulus,
            poisson_ratio=context.poisson_ratio,
        )


class FilmOption(Option):
    """Fluid film between sole and floor."""

    slot: ClassVar[str] = "film"
    usual: ClassVar[str | None] = "reynolds"

    @abstractmethod
    def build(self, context: Context) -> FilmModel | None:
        """Return the film; None where the fluid builds up no pressure."""

    @property
    def closure(self) -> str:
        """The equation, for the provenance."""
        return self.source


class ReynoldsFilm(FilmOption):
    """Reynolds equation with cavitation, wedge and squeeze."""

    name: ClassVar[str] = "reynolds"
    source: ClassVar[str] = "Reynolds equation with cavitation, wedge and squeeze (Eq. 4, 5)"

    lug_edges: Flag = default(True, True, "edges of lugs wipe the floor and suck (closed forms)")
    suction: Annotated[float, Quantity("Pa", 0.0, 1e5)] = default(
        70e3,
        "70 kPa",
        "highest pull of an emptied contact: 0 where air reaches it, 100 kPa where none does",
        assumed=True,
    )
    dewetting: Annotated[float, Quantity("Pa", 0.0, 1e3)] = default(
        0.2,
        "0.2 Pa",
        "over the viscosity, how fast the spots behind a wiping edge dry, per metre of lug; fitted "
        "to a tread in water and two outsoles in 50 % glycerol; 0 leaves lugs in one mean state",
        assumed=True,
    )

    def build(self, context: Context) -> FilmModel | None:
        from underfoot.film import NewtonianFilm

        viscosity = context.viscosity_value
        return None if viscosity is None else NewtonianFilm(viscosity)


class NoFilm(FilmOption):
    """The fluid changes friction only; it builds up no pressure (as if it drained at once)."""

    name: ClassVar[str] = "none"
    source: ClassVar[str] = "none: the fluid builds up no pressure"

    def build(self, context: Context) -> FilmModel | None:
        return None
