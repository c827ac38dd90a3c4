"""Slots of the contact: hardness to modulus, rough contact, compliance of the sole, film."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

import numpy as np

from underfoot.core import Breach, Cache, SourcedValue, display
from underfoot.core.arrays import Array
from underfoot.core.remark import Message

from .context import Context
from .quantity import Flag, Quantity, default, optional
from .section import CaseView, Option
from .sole import is_bare
from .surfaces import STYLUS_WAVES, WAVES
from .tables import meant_file, with_checksum

if TYPE_CHECKING:
    from underfoot.film import FilmModel
    from underfoot.rough_contact import ContactTable
    from underfoot.rough_contact.pressure_gap_law import PressureGapLaw
    from underfoot.shoe import SoleMap
    from underfoot.sole_contact.compliance import Compliance

Density = Callable[[Array], Array]
"""C(q) (m^4) of wave numbers (rad/m)."""
HARDNESS_SPREAD = 0.3
"""Relative standard deviation of a modulus from hardness (assumed: tens of percent)."""
TABLE_PRESSURES = (1e3, 2e6, 12)
"""Contact table: lowest and highest nominal pressure, Pa, and their number."""
ELASTIC_MODULUS = 1e6
"""Young's modulus (Pa) at which the table of an elastic compound is computed; others scale it."""
ELASTIC_RQ, ELASTIC_PRESSURES = 1e-6, (1.0, 3e4, 22)
"""Rq (m) and pressures (Pa) of the table that all self-affine elastic interfaces share."""


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
            source=Message(
                "{relation} from Shore A {shore_a:g}", relation=self.source, shore_a=shore_a
            ),
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

    def table(self, context: Context) -> ContactTable | None:
        """Return the contact that friction takes too: of a file or of scans; else None."""
        return None


class ExponentialContact(RoughContactOption):
    """One formula, no flow factor."""

    name: ClassVar[str] = "exponential"
    source: ClassVar[str] = "Persson 2007, low-load form"

    def build(self, context: Context) -> PressureGapLaw:
        from underfoot.rough_contact import ExponentialLaw

        return ExponentialLaw(context.youngs_modulus, context.poisson_ratio, context.rq_value)


class ContactTableOption(RoughContactOption):
    """Both surfaces in sliding contact by boundary elements, with the flow factors of their gap.

    From a file of ``underfoot contact``; of two scans; else of self-affine surfaces with the
    interface's Rq. Waves from the interface's longest to 2.5 um, in nested grids. Computed once and
    cached. It is chosen by itself where both surfaces and the compound are measured.
    """

    name: ClassVar[str] = "contact_table"
    source: ClassVar[str] = "sliding rough contact by boundary elements"
    reads: ClassVar[tuple[str, ...]] = WAVES[:2]
    chosen_by: ClassVar[tuple[str, ...]] = ("file",)
    file_paths: ClassVar[tuple[str, ...]] = ("file",)

    file: str | None = optional(
        "contact table that underfoot contact wrote; the path counts from the case file's folder"
    )
    sha256: str | None = optional("checksum of the file that is meant")

    @classmethod
    def complete_data(cls, table: dict[str, Any], folder: Path, where: str) -> dict[str, Any]:
        return with_checksum(table, "file", folder, where)

    def build(self, context: Context) -> PressureGapLaw:
        return (self.table(context) or self._self_affine(context)).law(context.motion.speed)

    def table(self, context: Context) -> ContactTable | None:
        """Return the contact of the file or of two scans; None where neither is given."""
        if self.file:
            from underfoot.rough_contact import ContactTable

            with meant_file(self.file, self.sha256, "rough_contact.file") as path:
                return ContactTable.load(path)
        shoe, floor = context.shoe.roughness, context.floor.roughness
        if not (shoe.file and floor.file):
            return None
        modulus = context.youngs_modulus
        elastic = context.shoe.material.relaxation is None
        scale = modulus / ELASTIC_MODULUS if elastic else 1.0
        low, high, count = TABLE_PRESSURES
        name = f"{Path(shoe.file).name} on {Path(floor.file).name}"
        # pressures at a modulus of whole tenths of a decade: one table serves draws near to it
        near = 10 ** (round(10 * math.log10(scale)) / 10)
        nodes = np.geomspace(low / near, high / near, count)
        made = self._new_table(context, floor.density, shoe.density, nodes, name)
        return made.scale_contact(1.0, scale, context.motion.speed) if elastic else made

    def _self_affine(self, context: Context) -> ContactTable:
        """Return the contact of self-affine surfaces with the interface's Rq."""
        rq, waves = context.rq_value, context.interface
        elastic = context.shoe.material.relaxation is None
        height = ELASTIC_RQ if elastic else rq
        exponent, longest = -2 * (1 + waves.hurst), 2 * math.pi / waves.longest_wave
        q = np.geomspace(longest, 2 * math.pi / STYLUS_WAVES[0], 400)
        level = height**2 / (2 * math.pi * np.trapezoid(q * (q / longest) ** exponent, q))

        def density(wavenumber: Array) -> Array:
            return level * (wavenumber / longest) ** exponent

        nodes = np.geomspace(*(ELASTIC_PRESSURES if elastic else TABLE_PRESSURES))
        name = f"self-affine interface, Rq {display(rq, 'm')}"
        made = self._new_table(context, density, None, nodes, name)
        if not elastic:
            return made
        higher, stiffer = rq / ELASTIC_RQ, context.youngs_modulus / ELASTIC_MODULUS
        return made.scale_contact(higher, higher * stiffer, context.motion.speed)

    def _new_table(
        self, context: Context, floor: Density, shoe: Density | None, pressure: Array, name: str
    ) -> ContactTable:
        """Return the table of an elastic compound at ``ELASTIC_MODULUS``, of another as it is."""
        from underfoot.material import Elastomer
        from underfoot.rough_contact import table_over_scales

        elastic = context.shoe.material.relaxation is None
        rubber = Elastomer(ELASTIC_MODULUS, context.poisson_ratio) if elastic else context.rubber()
        return table_over_scales(
            floor,
            (context.interface.longest_wave, STYLUS_WAVES[0]),
            rubber,
            pressure,
            [1.0 if elastic else context.motion.speed],
            shoe=shoe,
            poisson_ratio=context.poisson_ratio,
            cache=Cache("contact_table"),
            description=name,
            progress=context.progress,
        )


class _Theory(RoughContactOption):
    """A theory on the spectra of both surfaces, fluid slowed as by Patir and Cheng 1978.

    The spectra are those of the scans; a surface without one is self-affine with its Rq. A
    viscoelastic compound has the modulus at the rate of the longest wave.
    """

    reads: ClassVar[tuple[str, ...]] = WAVES[:2]

    def build(self, context: Context) -> PressureGapLaw:
        wave = context.interface.longest_wave
        q = np.geomspace(2 * math.pi / wave, 2 * math.pi / STYLUS_WAVES[0], 300)
        parts = context.shoe.roughness, context.floor.roughness
        if all(part.file for part in parts):
            density = np.sum([part.density(q) for part in parts], axis=0)
        else:
            density = (q / q[0]) ** (-2 * (1 + context.interface.hurst))
            density *= context.rq_value**2 / (2 * math.pi * np.trapezoid(q * density, q))
        rate = 2 * math.pi * abs(context.motion.speed) / wave
        modulus = float(np.abs(context.rubber().complex_modulus(rate)))
        return self._law(q, density, modulus, context.poisson_ratio)

    @abstractmethod
    def _law(self, q: Array, density: Array, modulus: float, poisson: float) -> PressureGapLaw:
        """Return the law of the theory."""


def _passing(q: Array, density: Array) -> Callable[[Array], Array]:
    """Return the flow factor of Patir and Cheng against the mean gap of a spectrum."""
    from underfoot.film import patir_cheng_pressure_factors

    rq = math.sqrt(2 * math.pi * np.trapezoid(q * density, q))
    return lambda gap: np.clip(patir_cheng_pressure_factors(gap, rq)[0], 0.0, 1.0)


class PerssonContact(_Theory):
    """Persson's theory: mean gap of an elastic contact over all its waves."""

    name: ClassVar[str] = "persson"
    source: ClassVar[str] = "Yang and Persson 2008"

    def _law(self, q: Array, density: Array, modulus: float, poisson: float) -> PressureGapLaw:
        from underfoot.rough_contact import persson_law

        return persson_law(q, density, modulus, poisson, _passing(q, density))


class GreenwoodWilliamsonContact(_Theory):
    """Greenwood and Williamson's independent summits: light loads only."""

    name: ClassVar[str] = "greenwood_williamson"
    source: ClassVar[str] = "Greenwood and Williamson 1966"

    def _law(self, q: Array, density: Array, modulus: float, poisson: float) -> PressureGapLaw:
        from underfoot.rough_contact import greenwood_williamson_law

        return greenwood_williamson_law(q, density, modulus, poisson, _passing(q, density))


class ComplianceOption(Option):
    """How the sole gives way under pressure."""

    slot: ClassVar[str] = "compliance"
    usual: ClassVar[str | None] = "layered"
    layers: ClassVar[bool] = True
    """Whether the thickness of outsole and midsole counts."""
    cut: ClassVar[bool] = False
    """Whether sipes finer than the grid let the lugs give way further."""

    @abstractmethod
    def build(self, context: Context, sole: SoleMap) -> Compliance:
        """Return the map from pressure to deflection on the grid of ``sole``."""

    def rebuilt(self, known: Compliance, context: Context, sole: SoleMap) -> Compliance:
        """Return the same on another map of the shoe; ``known`` is that of one of its maps."""
        return self.build(context, sole)


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

    def rebuilt(self, known: Compliance, context: Context, sole: SoleMap) -> Compliance:
        from underfoot.sole_contact.compliance import layered_compliance

        return layered_compliance(sole, known=getattr(known, "body", None), **_layers(context))


class FiniteElementCompliance(ComplianceOption):
    """The real shape of sole, lugs and rim, condensed once and kept in the cache."""

    name: ClassVar[str] = "finite_element"
    source: ClassVar[str] = "linear finite elements, condensed to the sole's surface"

    def build(self, context: Context, sole: SoleMap) -> Compliance:
        from underfoot.sole_contact.finite_element import finite_element_compliance

        store = Cache("sole_compliance-3")
        return finite_element_compliance(
            sole, **_layers(context), cache=store, progress=context.progress
        )


class HalfSpaceCompliance(ComplianceOption):
    """Elastic half-space, for comparison."""

    name: ClassVar[str] = "half_space"
    layers: ClassVar[bool] = False
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
    bears: ClassVar[bool] = True
    """Whether the fluid builds up pressure."""

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

    def unused_keys(self, case: CaseView) -> tuple[str, ...]:
        edges = ("suction", "dewetting")
        if case.contaminant is None or is_bare(case):
            return ("lug_edges", *edges)
        return () if self.lug_edges else edges

    def build(self, context: Context) -> FilmModel | None:
        from underfoot.film import NewtonianFilm

        viscosity = context.viscosity_value
        return None if viscosity is None else NewtonianFilm(viscosity)


class NoFilm(FilmOption):
    """The fluid changes friction only; it builds up no pressure (as if it drained at once)."""

    name: ClassVar[str] = "none"
    bears: ClassVar[bool] = False
    source: ClassVar[str] = "none: the fluid builds up no pressure"

    def build(self, context: Context) -> FilmModel | None:
        return None
