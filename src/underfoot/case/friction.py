"""Slot ``friction``: the local friction law of sole, floor and fluid, one class a law."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

import numpy as np

from underfoot.core import InputError, RangeError, SourcedValue
from underfoot.core.catalogue import Catalogue
from underfoot.core.remark import Message

from .context import Context
from .quantity import (
    Force,
    Friction,
    FrictionSpread,
    Pressure,
    Quantity,
    Speed,
    Viscosity,
    optional,
    required,
)
from .section import CaseView, Option, Section
from .surfaces import FLOOR_RQ, SOLE_RQ, WAVES, SurfaceRoughness
from .tables import as_written, meant_file, plain, table_columns, table_source, with_checksum

if TYPE_CHECKING:
    from underfoot.friction import AsperityScale, BoundaryFriction, FrictionLaw, SpeedEffectLaw
    from underfoot.rough_contact import ContactTable

PIN = ("setup", "pin_on_disk_g2")
"""Catalogue entry of the pin whose readings the laws of a mechanism are calibrated on."""
RIVAL_DEVIATION = {"mean_film_sharing": 0.095, "viscoelastic_area": 0.241}
"""Root mean square error of COF of five fluids predicted blind from 50 % glycerol with their COF_BL
(docs/studies/g2.md); what stands behind ``asperity_ehl`` is in ``friction.asperity_ehl``."""
HYSTERESIS_WAVES = (2.5e-6, 0.2e-3, 0.8e-3)
"""Shortest wave, roll-off and longest wave (m) of the floor that make hysteresis: with these and a
loss tangent of 0.2 theory gives the closed form of ``friction.pair_contact``."""
SHORTEST_WAVE_DEVIATION = 0.3
"""Standard deviation of ln of hysteresis and of real area by the shortest wave: hysteresis is 30 %
lower down to 10 um and 65 % higher down to 0.3 um than down to 2.5 um (Persson theory)."""
NO_LOSS = 1e-4
"""Hysteresis COF below which a contact table is that of an elastic compound."""
SAME_VISCOSITY = 0.01
"""Relative difference up to which two viscosities are the same fluid."""
COLUMNS = {
    "speed": ("m/s", ("speed", "sliding speed", "velocity")),
    "cof": ("1", ("cof", "coefficient of friction", "friction coefficient")),
    "sd": ("1", ("sd", "cof sd", "standard deviation", "cof standard deviation")),
    "pressure": ("Pa", ("pressure", "contact pressure")),
    "viscosity": ("Pa*s", ("viscosity",)),
}


class FrictionOption(Option):
    """Local friction law: shear stress at contact pressure, speed and film.

    A law of your own is a class derived from this one, with ``name``, its fields and ``build``.
    """

    slot: ClassVar[str] = "friction"
    usual: ClassVar[str | None] = "pair"
    dry: ClassVar[bool] = False
    """Whether the law holds without a fluid."""
    compound: ClassVar[tuple[str, ...]] = ()
    """What it reads of the compound beside modulus and relaxation; of the packaged laws."""

    @abstractmethod
    def build(self, context: Context) -> FrictionLaw:
        """Return the law."""

    def problems(self, case: CaseView, where: str) -> Iterator[InputError]:
        if case.contaminant is None and not self.dry:
            yield InputError(
                Message("the law {name} needs a fluid", name=self.name),
                where=f"{where}.{self.key}",
                remedy='On a dry floor write friction.model = "pair", or "constant" with a '
                "measured friction.cof",
            )


class PairOption(FrictionOption):
    """Contact friction from what is known of compound, both roughnesses and fluid.

    Its constants are calibrated on published measurements; the interval is that of a pair that
    nobody measured. Roughness that is not given is drawn. Dry, adhesion follows the real area of
    contact.
    """

    name: ClassVar[str] = "pair"
    dry: ClassVar[bool] = True
    source: ClassVar[str] = "calibrated on published measurements of other pairs"
    reads: ClassVar[tuple[str, ...]] = ("contaminant.family",)
    compound: ClassVar[tuple[str, ...]] = ("polymer", "shore_a", "loss_tangent")
    file_paths: ClassVar[tuple[str, ...]] = ("draws_file", "contact_table")

    draws_file: str | None = optional(
        "draws calibrated to readings of your own by underfoot calibrate pair; the "
        "path counts from the case file's folder"
    )
    sha256: str | None = optional("checksum of the file that is meant")
    contact_table: str | None = optional(
        "contact table of the rubber on the floor (underfoot contact), for hysteresis and, dry, "
        "real contact area; default: that of rough_contact, theory where a spectrum is given, else "
        "a closed form"
    )
    contact_table_sha256: str | None = optional("checksum of the contact table that is meant")

    @classmethod
    def complete_data(cls, table: dict[str, Any], folder: Path, where: str) -> dict[str, Any]:
        table = with_checksum(table, "draws_file", folder, where)
        return with_checksum(
            table, "contact_table", folder, where, checksum_key="contact_table_sha256"
        )

    def build(self, context: Context) -> FrictionLaw:
        from scipy.special import erfinv

        from underfoot.friction import Pair, PairContactLaw, packaged_pair_draws, read_pair_draws
        from underfoot.friction.pair_contact import CONTACT_PRESSURE, LOSS_TANGENTS
        from underfoot.rough_contact import ContactTable

        material, hurst = context.shoe.material, context.interface.hurst
        surfaces = context.shoe.roughness, context.floor.roughness
        table, full_contact, deviation = context.rough_contact(context), None, 0.0
        origin = "the rough contact of both surfaces"
        if self.contact_table:
            with meant_file(
                self.contact_table, self.contact_table_sha256, "friction.contact_table"
            ) as path:
                table, origin = ContactTable.load(path), Path(self.contact_table).name
        hysteresis = None
        if table is not None:
            at = CONTACT_PRESSURE, context.motion.speed
            area = float(table.real_contact_fraction(*at))
            full_contact = CONTACT_PRESSURE / float(erfinv(min(area, 1 - 1e-9)))
            deviation = contact_deviation(table, *at, context)
            lossy = bool(self.contact_table) or _loss_tested(context)
            if lossy and table.values["cof_hysteresis"].max() > NO_LOSS:
                hysteresis = float(table.cof_hysteresis(*at))
        if hysteresis is None:
            hysteresis, origin = _hysteresis(context)
        draws = packaged_pair_draws()
        if self.draws_file:
            with meant_file(self.draws_file, self.sha256, "friction.draws_file") as path:
                draws = read_pair_draws(path)
        pair = Pair(
            shore_a=_hardness(context),
            sole_rq=_span(surfaces[0], SOLE_RQ, hurst),
            floor_rq=_span(surfaces[1], FLOOR_RQ, hurst),
            family=context.contaminant.chemistry if context.contaminant else "dry",
            hysteresis=hysteresis,
            hysteresis_origin=origin,
            full_contact=full_contact,
            polymer=material.polymer,
            contact_deviation=deviation,
            measured=(
                context.shoe.roughness.rq_or_estimate is not None,
                context.floor.roughness.rq_or_estimate is not None,
            ),
            shore_a_deviation=(material.shore_a and material.sourced_value("shore_a").uncertainty)
            or 0.0,
            loss_tangent=range_95(material.sourced_value("loss_tangent")) or LOSS_TANGENTS,
            sole_slope=_slope(surfaces[0]),
            floor_slope=_slope(surfaces[1]),
        )
        return PairContactLaw(pair, context.viscosity_value, draws)


class _Measured(FrictionOption):
    """What was measured with the fluid: COF_BL, its pair, and the hysteresis part."""

    hysteresis_cof: Friction | None = optional("hysteresis part, if measured")
    cof_bl: Friction | None = optional("COF in boundary lubrication (Eq. 17)")
    pair: str | None = optional("sole and floor it was measured on")

    def _optional(self, name: str) -> SourcedValue | None:
        return None if getattr(self, name, None) is None else self.sourced_value(name)

    def measured_friction(self, context: Context) -> BoundaryFriction | None:
        """Return what was measured with the case's own fluid, if anything."""
        from underfoot.friction import BoundaryFriction

        viscosity = context.viscosity_value
        if viscosity is None or self.cof_bl is None:
            return None
        return BoundaryFriction(
            fluid=context.fluid,
            pair=self.pair or "",
            viscosity=viscosity,
            cof_boundary=self.sourced_value("cof_bl"),
            tau_hydro=self._optional("tau_hydro"),
            cof_asymptote=self._optional("cof_asymptote"),
        )


class BoundaryOption(_Measured):
    """COF_BL at every speed."""

    name: ClassVar[str] = "boundary"
    source: ClassVar[str] = "boundary friction of the pair and fluid"
    consults: ClassVar[tuple[str, ...]] = ("fluid",)

    def build(self, context: Context) -> FrictionLaw:
        from underfoot.friction import BoundaryLaw, boundary_friction_at

        others, measured = measured_fluids(context.catalogue), self.measured_friction(context)
        if measured is None:
            measured = boundary_friction_at(_viscosity(context), others, fluid=context.fluid)
        hysteresis = self._optional("hysteresis_cof")
        return BoundaryLaw.from_measured(measured, cof_hysteresis=hysteresis, others=others)


class StribeckOption(_Measured):
    """The measured fall with speed (Eq. 17) where the fluid has the fit, the measured mean over
    speeds where the report found no fall, and the curve of viscosity times speed for a fluid that
    was not measured.
    """

    name: ClassVar[str] = "stribeck"
    source: ClassVar[str] = "friction of the pair and fluid as measured at the speed"
    chosen_by: ClassVar[tuple[str, ...]] = ("cof_bl", "tau_hydro", "cof_asymptote")
    consults: ClassVar[tuple[str, ...]] = ("fluid",)

    tau_hydro: Speed | None = optional("decay speed (Eq. 17)")
    cof_asymptote: Friction | None = optional("COF at high speed (Eq. 17)")

    def unused_keys(self, case: CaseView) -> tuple[str, ...]:
        if self.cof_bl is None:
            return ("tau_hydro", "cof_asymptote", "hysteresis_cof")
        fall = ("tau_hydro", "cof_asymptote")
        return () if all(getattr(self, name) is not None for name in fall) else fall

    def build(self, context: Context) -> FrictionLaw:
        from underfoot.friction import BoundaryLaw, StribeckLaw, stribeck_law_at

        others, measured = measured_fluids(context.catalogue), self.measured_friction(context)
        hysteresis = self._optional("hysteresis_cof")
        if measured is None:
            return stribeck_law_at(_viscosity(context), others, fluid=context.fluid)
        if measured.tau_hydro is None or measured.cof_asymptote is None:
            return BoundaryLaw.from_measured(measured, cof_hysteresis=hysteresis, others=others)
        return StribeckLaw.from_measured(measured, cof_hysteresis=hysteresis, others=others)


class AdhesionBlockingOption(FrictionOption):
    """Dry adhesion less what the fluid blocks (Eq. 26), plus hysteresis."""

    name: ClassVar[str] = "adhesion_blocking"
    source: ClassVar[str] = "Strobel et al. 2012 (Eq. 26)"
    _remedy: ClassVar[str] = (
        "Without it choose asperity_ehl or stribeck, which need the fluid's viscosity alone, or "
        "constant with a measured friction"
    )

    dry_adhesion_cof: Friction = required("adhesion part dry, measured", remedy=_remedy)
    hysteresis_cof: Friction = required("hysteresis part, measured", remedy=_remedy)
    alpha: Annotated[float, Quantity("N", 0.0, 1e4)] = required(
        "adhesion independent of the pair (Eq. 26)", remedy=_remedy
    )
    beta: Annotated[float, Quantity("1", 0.0, 1.0)] = required(
        "share of dry adhesion left (Eq. 26)", remedy=_remedy
    )
    load: Force | None = optional("at which alpha was measured; default: 20.9 N, that of Eq. 26")
    pair: str | None = optional("sole and floor it was measured on")

    def build(self, context: Context) -> FrictionLaw:
        from underfoot.fluid import AdhesionBlocking
        from underfoot.friction import AdhesionBlockingLaw

        return AdhesionBlockingLaw(
            AdhesionBlocking(
                self.alpha,
                self.beta,
                self.sourced_value("alpha").source,
                **({} if self.load is None else {"normal_force": self.load}),
            ),
            self.sourced_value("dry_adhesion_cof"),
            self.sourced_value("hysteresis_cof"),
            _viscosity(context),
        )


class ConstantOption(FrictionOption):
    """One coefficient of friction as measured on this pair and floor."""

    name: ClassVar[str] = "constant"
    source: ClassVar[str] = "given in the case"
    dry: ClassVar[bool] = True

    cof: Friction = required("measured coefficient of friction, all parts")
    hysteresis_cof: Friction | None = optional("its hysteresis part")

    def build(self, context: Context) -> FrictionLaw:
        from underfoot.friction import ConstantLaw

        part, whole = self.hysteresis_cof or 0.0, self.sourced_value("cof")
        spread = whole.uncertainty  # of the sum: its parts only share it
        shared = spread, None if spread is None else 0.0
        return ConstantLaw(self.cof - part, part, whole.source, context.viscosity_value, *shared)

    def problems(self, case: CaseView, where: str) -> Iterator[InputError]:
        if (self.hysteresis_cof or 0.0) > self.cof:
            yield RangeError(
                f"{self.hysteresis_cof:g} is more than the whole",
                where=f"{where}.hysteresis_cof",
                allowed=Message(
                    "at most {most} ({what})", most=f"{self.cof:g}", what="friction.cof"
                ),
            )


class _Mechanism(_Measured):
    """Law of a mechanism that makes friction fall with speed."""

    reads: ClassVar[tuple[str, ...]] = WAVES[:2]
    tau_hydro: Speed | None = optional(
        "decay speed (Eq. 17): with it, cof_bl is a limit at low speed"
    )

    def unused_keys(self, case: CaseView) -> tuple[str, ...]:
        limit = self.cof_bl is not None and self.tau_hydro is not None
        return () if limit else ("cof_bl", "tau_hydro")

    def _asperity_law(self, context: Context) -> SpeedEffectLaw:
        from underfoot.friction import asperity_ehl_law
        from underfoot.friction.asperity_ehl import STYLUS_RESOLUTION

        return asperity_ehl_law(
            _scale(context, STYLUS_RESOLUTION),
            modulus=context.youngs_modulus,
            poisson_ratio=context.poisson_ratio,
            viscosity=_viscosity(context),
            friction=self.measured_friction(context),
            cof_hysteresis=self._optional("hysteresis_cof"),
            fine_roughness=self._optional("fine_roughness"),
            modulus_deviation=context.modulus.uncertainty,
            roughness_deviation=context.rq_deviation,
        )

    def _rival(self, effect: Any, context: Context) -> FrictionLaw:
        from underfoot.friction import SpeedEffectLaw

        law = self._asperity_law(context)
        levels = (law.cof_boundary, law.cof_hysteresis, _viscosity(context))
        return SpeedEffectLaw(effect, *levels, RIVAL_DEVIATION[self.name], law.assumed)


class AsperityEhlOption(_Mechanism):
    """Films at single asperities."""

    name: ClassVar[str] = "asperity_ehl"
    source: ClassVar[str] = "films at single asperities, calibrated on the report's fluids"

    fine_roughness: Annotated[float, Quantity("m", 1e-10, 1e-4)] | None = optional(
        "roughness finer than a stylus sees; default: the one calibrated on the report's fluids"
    )

    def build(self, context: Context) -> FrictionLaw:
        return self._asperity_law(context)


class MeanFilmSharingOption(_Mechanism):
    """The film of the report's pin against the floor's roughness, on top of which the film under
    the shoe acts; levels of ``asperity_ehl``.
    """

    name: ClassVar[str] = "mean_film_sharing"
    source: ClassVar[str] = "load shared with the mean film of a pin"
    consults: ClassVar[tuple[str, ...]] = ("setup",)

    def build(self, context: Context) -> FrictionLaw:
        from underfoot.friction import MeanFilmSharing

        pin = context.catalogue.entry(*PIN)
        rq = context.floor.roughness.rq_or_estimate
        if rq is None:
            raise InputError(
                "the floor's own roughness is not given",
                where="floor.roughness.rq",
                remedy="Give it, or choose friction.model = asperity_ehl",
            )
        effect = MeanFilmSharing(
            radius=float(pin.sourced_value("method.reduced_radius", "m")),
            normal_force=float(pin.sourced_value("method.normal_force", "N")),
            effective_modulus=2 * context.plane_strain_modulus,
            rq=rq,
            stiffness=context.plane_strain_modulus,
        )
        return self._rival(effect, context)


class ViscoelasticAreaOption(_Mechanism):
    """Contact area that falls as the compound stiffens with speed; levels of ``asperity_ehl``."""

    name: ClassVar[str] = "viscoelastic_area"
    source: ClassVar[str] = "contact area from the compound's relaxation spectrum"
    reads: ClassVar[tuple[str, ...]] = WAVES

    def build(self, context: Context) -> FrictionLaw:
        from underfoot.friction import ViscoelasticArea, modulus_exponent

        rest, wave = ViscoelasticArea(0.0).rest_speed, context.interface.shortest_wave
        fast = max(context.motion.speed, 2 * rest)
        frequencies = (2 * math.pi * speed / wave for speed in (rest, fast))
        exponent = modulus_exponent(context.rubber().complex_modulus, *frequencies)
        return self._rival(ViscoelasticArea(exponent), context)

    def problems(self, case: CaseView, where: str) -> Iterator[InputError]:
        yield from super().problems(case, where)
        if case.shoe.material.relaxation is None:
            yield InputError(
                "a relaxation spectrum is missing: without it the contact area has no speed",
                where="shoe.material.relaxation",
                remedy="Give the spectrum of the compound, or choose friction.model = "
                '"asperity_ehl" or "stribeck"',
            )


class BowdenTaborOption(FrictionOption):
    """Shear strength times real contact area, at the interface's shortest wave.

    The area is that of elastic contact on the self-affine interface down to
    ``interface.shortest_wave`` (Persson 2001); finer waves would lower it further.
    """

    name: ClassVar[str] = "bowden_tabor"
    source: ClassVar[str] = "Bowden and Tabor; Persson 2001, elastic contact area"
    dry: ClassVar[bool] = True
    reads: ClassVar[tuple[str, ...]] = WAVES

    shear_strength: Annotated[float, Quantity("Pa", 0.0, 1e9)] = required(
        "of the real contact",
        remedy="Take it from a measured adhesion: COF times pressure over the share of real "
        'contact, as shear_strength = "0.3 MPa"',
    )
    hysteresis_cof: Friction | None = optional("hysteresis part, if measured")

    def build(self, context: Context) -> FrictionLaw:
        from underfoot.friction import BowdenTaborLaw, ShearStrength

        stiffness = context.plane_strain_modulus
        scale = _scale(context, context.interface.shortest_wave)
        sourced = self.sourced_value("shear_strength")
        return BowdenTaborLaw(
            ShearStrength(self.shear_strength, sourced.source, deviation=sourced.uncertainty),
            lambda pressure, _speed: scale.contact_fraction(np.asarray(pressure) / stiffness),
            self.hysteresis_cof or 0.0,
            context.viscosity_value,
            contact_source="Persson 2001, elastic contact area",
        )


class FrictionReading(Section):
    """One reading of a user's own friction table."""

    speed: Speed
    cof: Friction
    sd: FrictionSpread | None = None
    pressure: Pressure | None = None
    viscosity: Viscosity | None = None


class TableOption(FrictionOption):
    """A user's own readings over speed.

    Repeated speeds are averaged; their scatter joins the standard deviation. Readings under
    another viscosity than the case's (or several) count at equal viscosity x speed, as the report
    finds for its fluids (Fig. 16); the law's assumptions say so.
    """

    name: ClassVar[str] = "table"
    source: ClassVar[str] = "readings given in the case"
    dry: ClassVar[bool] = True
    replaced: ClassVar[tuple[str, ...]] = ("table_file",)

    table_file: str | None = optional(
        "file (CSV, XLSX) with columns speed, cof and, where known, sd, pressure, "
        "viscosity; the path counts from the case file's folder"
    )
    readings: tuple[FrictionReading, ...] = required(
        "the same readings written in the case",
        missing='are missing for friction.model = "table"',
        remedy='Write friction.table_file = "law.csv" (columns speed, cof, and sd where known), or '
        'choose "constant"',
    )
    readings_source: str | None = optional("who read them, and on what")
    hysteresis_cof: Friction | None = optional("hysteresis part, if measured")

    @classmethod
    def complete_data(cls, table: dict[str, Any], folder: Path, where: str) -> dict[str, Any]:
        name = plain(table.get("table_file"))
        if not isinstance(name, str):
            return table
        if "readings" in table:
            raise InputError(
                "a table and readings are given",
                where=f"{where}.table_file",
                remedy="Keep table_file or readings",
            )
        readings, source = read_friction_table(folder / name, f"{where}.table_file")
        return {"readings_source": source, **table, "readings": readings}

    def build(self, context: Context) -> FrictionLaw:
        from underfoot.friction import SpeedTableLaw

        readings, viscosity = self.readings, context.viscosity_value
        rows = [(r.speed, r.cof, r.sd, r.viscosity) for r in readings]
        speed, cof, sd, fluids = np.array(rows, dtype=float).reshape(-1, 4).T.copy()
        pressures = [r.pressure for r in readings if r.pressure is not None]
        notes = []
        if viscosity is not None and np.isfinite(fluids).all():
            ratio = fluids / viscosity
            if (np.abs(ratio - 1) > SAME_VISCOSITY).any():
                speed = speed * ratio
                notes.append(
                    Message("Readings under another viscosity count at equal viscosity x speed.")
                )
        speeds, group = np.unique(np.round(speed, 12), return_inverse=True)
        counts = np.bincount(group)
        mean = np.bincount(group, cof) / counts
        scatter = np.bincount(group, (cof - mean[group]) ** 2) / np.maximum(counts - 1, 1)
        deviation = None
        if np.isfinite(sd).all():
            deviation = np.sqrt(np.bincount(group, sd**2) / counts + scatter)
        elif (counts > 1).all():
            deviation = np.sqrt(scatter)
        if self.hysteresis_cof is None:
            notes.append(Message("All of the friction read counts as adhesion."))
        return SpeedTableLaw(
            speeds,
            mean,
            source=self.readings_source or self.source,
            cof_hysteresis=self.hysteresis_cof or 0.0,
            viscosity=viscosity,
            cof_deviation=deviation,
            pressure=(min(pressures), max(pressures)) if pressures else None,
            assumed=tuple(notes),
        )

    def problems(self, case: CaseView, where: str) -> Iterator[InputError]:
        for name in ("sd", "viscosity"):
            lacking = [n for n, each in enumerate(self.readings, 1) if getattr(each, name) is None]
            if 0 < len(lacking) < len(self.readings):
                yield InputError(
                    "is missing, other readings have it",
                    where=f"{where}.readings {lacking[0]}.{name}",
                    allowed=Message("{name} of all readings, or of none", name=name),
                )
        if len({reading.speed for reading in self.readings}) < 2:
            yield InputError(
                "of one speed only" if self.readings else "are missing",
                where=f"{where}.readings",
                allowed="readings at two or more speeds",
                remedy='Add readings, or choose friction.model = "constant"',
            )


def read_friction_table(path: Path, where: str) -> tuple[list[dict[str, str | float]], str]:
    """Return the readings of a table (CSV, XLSX) as a case file writes them, and their source.

    Columns ``speed`` and ``cof``; optional ``sd``, ``pressure``, ``viscosity``; units stand in the
    heading, as ``speed (m/s)``, else SI. A line ``# source: ...`` above says where they come from.

    Raises:
        InputError: No file, no table, a column missing, a value missing or negative.
    """
    read = table_columns(path, COLUMNS, where, needed=("speed", "cof"), lowest=0.0)
    return as_written(read, COLUMNS), table_source(path)


def measured_fluids(catalogue: Catalogue) -> tuple[BoundaryFriction, ...]:
    """Return every fluid of the catalogue whose own boundary friction was measured."""
    from underfoot.friction import BoundaryFriction

    fluids = []
    for name in catalogue.names("fluid"):
        entry = catalogue.entry("fluid", name)
        leaf = entry.values.get("boundary.cof_bl")
        if leaf is None or leaf.assumed or entry.parents or "boundary.pair" not in entry.values:
            continue
        optional = {
            key: entry.sourced_value(f"boundary.{key}", unit)
            for key, unit in (("tau_hydro", "m/s"), ("cof_asymptote", "1"))
            if f"boundary.{key}" in entry.values
        }
        viscosity = entry.sourced_value("viscosity", "Pa*s").value
        assert viscosity is not None
        fluids.append(
            BoundaryFriction(
                fluid=name,
                pair=entry.text("boundary.pair"),
                viscosity=viscosity,
                cof_boundary=entry.sourced_value("boundary.cof_bl", "1"),
                **optional,
            )
        )
    return tuple(fluids)


def contact_deviation(
    table: ContactTable, pressure: float, speed: float, context: Context
) -> float:
    """Return the standard deviation of ln of real area and hysteresis of a contact table.

    Of the mean over its random surfaces, of the roughness measured, and of the shortest wave.
    """
    area = table.sourced_value("real_contact_fraction", pressure, speed)
    count = float(table.realizations.min())
    between = (area.uncertainty or 0.0) / float(area) / math.sqrt(count)
    return math.hypot(between, context.rq_deviation or 0.0, SHORTEST_WAVE_DEVIATION)


def _hardness(context: Context) -> float:
    """Return Shore A, or where a modulus is given that of an equal ratio to Shore A 60."""
    from underfoot.friction.pair_contact import GENT_SLOPE, REFERENCE_HARDNESS
    from underfoot.material import youngs_modulus_gent

    shore = context.shoe.material.shore_a
    if shore is not None:
        return shore
    ratio = context.youngs_modulus / youngs_modulus_gent(REFERENCE_HARDNESS)
    return REFERENCE_HARDNESS + math.log(ratio) / GENT_SLOPE


def _span(
    roughness: SurfaceRoughness, unknown: tuple[float, float], hurst: float
) -> tuple[float, float]:
    """Return Rq (m) of waves up to 0.8 mm twice, or its 95 % range where it has a spread.

    ``unknown`` without one. Longer waves, of a scan or a longer cut-off, are left out.
    """
    rq = roughness.rq_or_estimate
    if rq is None:
        return unknown
    spread = range_95(SourcedValue(rq, "m", uncertainty=roughness.rq_uncertainty))
    assert spread is not None
    longest = HYSTERESIS_WAVES[2]
    share = roughness.share_up_to(longest, hurst)
    if roughness.file is not None:
        share = roughness.moment(0, HYSTERESIS_WAVES[0], longest) / rq
    return spread[0] * share, spread[1] * share


def range_95(given: SourcedValue) -> tuple[float, float] | None:
    """Return a value twice, or its 95 % range where it has a spread; None without a value."""
    if given.value is None:
        return None
    factor = math.exp(1.96 * (given.uncertainty or 0.0) / given.value)
    return given.value / factor, given.value * factor


def _slope(roughness: SurfaceRoughness) -> float | None:
    """Return the rms slope of a scan's waves up to 0.8 mm; None without a scan."""
    return None if roughness.file is None else roughness.moment(1, *HYSTERESIS_WAVES[::2])


def _hysteresis(context: Context) -> tuple[float | None, str]:
    """Return the hysteresis COF of the compound's spectrum on the floor's, and what it is from.

    None without a spectrum of the compound, or one tested at slower rates than those of sliding;
    the spectrum of a floor without a scan has its usual form.
    """
    from underfoot.friction.pair_contact import CONTACT_PRESSURE, SLOPE, real_slope
    from underfoot.rough_contact import persson

    floor, (shortest, roll_off, longest) = context.floor.roughness, HYSTERESIS_WAVES
    if not _loss_tested(context):
        return None, ""
    wavenumber = np.geomspace(2 * math.pi / longest, 2 * math.pi / shortest, 60)
    directions = floor.directions(wavenumber)
    if floor.file is None:
        rq = math.sqrt(math.prod(_span(floor, FLOOR_RQ, context.interface.hurst)))
        rq = float(real_slope(rq)) / SLOPE
        shape = wavenumber * roll_off / (2 * math.pi)
        spectrum = np.where(shape < 1, 1.0, shape ** (-2 * (1 + context.interface.hurst)))
        spectrum *= rq**2 / (2 * math.pi * np.trapezoid(wavenumber * spectrum, wavenumber))
    else:
        spectrum = floor.density(wavenumber)
    contact = persson(
        CONTACT_PRESSURE,
        wavenumber,
        spectrum,
        context.rubber().complex_modulus,
        context.motion.speed,
        context.poisson_ratio,
        directions,
    )
    assert contact.cof_hysteresis is not None  # the rubber is viscoelastic
    surface = "" if floor.file is None else " on the floor's scan"
    if directions is not None:
        surface += ", sliding along its x axis"
    return float(contact.cof_hysteresis[0]), f"Persson theory{surface}"


def _loss_tested(context: Context) -> bool:
    """Return whether the compound's loss is known at the slowest rate of sliding asperities."""
    rate = 2 * math.pi * abs(context.motion.speed) / HYSTERESIS_WAVES[2]
    return context.shoe.material.loss_tested_at(rate)


def _viscosity(context: Context) -> float:
    viscosity = context.viscosity_value
    if viscosity is None:
        raise InputError("this law needs a fluid", where="contaminant")
    return viscosity


def _scale(context: Context, shortest: float) -> AsperityScale:
    """Return the asperities of sole and floor: self-affine from the interface's effective Rq, its
    longest wave and its Hurst exponent, down to ``shortest`` (m).
    """
    from underfoot.friction import self_affine_scale

    return self_affine_scale(
        shortest,
        rq=context.rq_value,
        longest_wave=context.interface.longest_wave,
        hurst=min(context.interface.hurst, 0.99),
    )
