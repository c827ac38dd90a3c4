"""Sections for the shoe: compound, surface, shape or outsole file, tread, wear, layers."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

import numpy as np
from pydantic import Field, create_model

from underfoot.core import InputError, RangeError, display, nearest_match
from underfoot.core.registry import find_offer
from underfoot.core.remark import Message

from .quantity import Flag, Length, Quantity, default, optional
from .section import (
    CATALOGUE,
    GIVEN,
    CaseView,
    Origin,
    Section,
    from_catalogue,
    leaf_of,
    origin_of,
    refused_at,
    with_file_values,
)
from .sole import SolePlan, TreadPattern
from .surfaces import SurfaceRoughness
from .tables import meant_file, plain, with_checksum
from .wear import Wear

if TYPE_CHECKING:
    from underfoot.friction.shoe_class import Certified, ShoeClass
    from underfoot.material import RelaxationSpectrum

Modulus = Annotated[float, Quantity("Pa", 1e4, 1e12)]
Rate = Annotated[float, Quantity("rad/s", 0.0, 1e15, open_low=True)]
TermModulus = Annotated[float, Quantity("Pa", 0.0, 1e12, open_low=True)]
RelaxationTime = Annotated[float, Quantity("s", 0.0, 1e12, open_low=True)]
Hardness = Annotated[float, Quantity("1", 0.0, 100.0, open_low=True)]
Poisson = Annotated[float, Quantity("1", 0.0, 0.5)]
CertifiedFriction = Annotated[float, Quantity("1", 0.0, 5.0, open_low=True)]
LossTangent = Annotated[float, Quantity("1", 0.0, 3.0, open_low=True)]
Density = Annotated[float, Quantity("kg/m^3", 10.0, 3e4)]
Direction = Literal["auto", "flip", "+x", "-x", "+y", "-y", "+z", "-z"]
_mm = 1e-3
BY_LAW = ("polymer", "shore_a", "loss_tangent")
"""What friction laws read of a compound beside its modulus and its relaxation."""
_READ = "read from the file; underfoot check tells what and how"


class RelaxationTerm(Section):
    """One Maxwell element: shear modulus that decays with a time constant."""

    shear_modulus: TermModulus
    time: RelaxationTime


class Relaxation(Section):
    """Relaxation spectrum G(t) = equilibrium + sum of terms exp(-t / time)."""

    equilibrium_shear_modulus: TermModulus
    terms: tuple[RelaxationTerm, ...]

    def young(self, poisson_ratio: float) -> RelaxationSpectrum:
        """Return the spectrum of Young's modulus, Pa."""
        from underfoot.material import RelaxationSpectrum, young_from_shear

        shear = RelaxationSpectrum(
            self.equilibrium_shear_modulus,
            np.array([term.shear_modulus for term in self.terms]),
            np.array([term.time for term in self.terms]),
        )
        return young_from_shear(shear, poisson_ratio)


class Material(Section):
    """Outsole compound. A measured modulus goes before one from hardness."""

    file_paths: ClassVar[tuple[str, ...]] = ("file",)

    polymer: str | None = optional(
        "TPU, PU, SBR, NBR, ...; soles of one polymer share the error of its friction"
    )
    shore_a: Hardness | None = optional(
        'Shore A hardness; "40 Shore D" and "55 Asker C" are converted, with their spread'
    )
    modulus: Modulus | None = optional("measured Young's modulus")
    poisson_ratio: Poisson = default(0.49, 0.49, "rubber, nearly incompressible", assumed=True)
    bulk_modulus: Modulus | None = None
    density: Density | None = None
    loss_tangent: LossTangent | None = optional(
        "at 100 Hz to 10 kHz and room temperature, about -ln(rebound resilience) / pi; a "
        "relaxation spectrum goes before it"
    )
    relaxation: Relaxation | None = None
    slowest_tested: Rate | None = optional("lowest frequency that the relaxation was measured at")
    fastest_tested: Rate | None = optional("highest frequency that the relaxation was measured at")
    file: str | None = optional(
        "compound that underfoot material wrote; the path counts from the case file's folder"
    )
    sha256: str | None = optional("checksum of the file that is meant; another file is refused")

    @classmethod
    def complete_data(cls, table: dict[str, Any], folder: Path, where: str) -> dict[str, Any]:
        table = with_checksum(table, "file", folder, where)
        name = plain(table.get("file"))
        if not isinstance(name, str):
            return table
        values = _compound(Path(name), plain(table["sha256"]), f"{where}.file")
        name = Path(name).name
        if "modulus" in values:  # a measured modulus goes before a hardness of the catalogue
            table = {
                k: item
                for k, item in table.items()
                if k != "shore_a" or not _is_from_catalogue(item)
            }
        if "relaxation" in values:
            given = table.get("relaxation") or {}
            spectrum = with_file_values(given, values.pop("relaxation"), name)
            table = {**table, "relaxation": spectrum}
        return with_file_values(table, values, name)

    def unused_keys(self, case: CaseView) -> tuple[str, ...]:
        by_law = set(BY_LAW) - set(case.friction.compound)
        if self.modulus is None:
            by_law -= {"shore_a"}  # the modulus is made of it
        tested = () if self.relaxation else ("slowest_tested", "fastest_tested")
        return ("bulk_modulus", "density", *tested, *(name for name in BY_LAW if name in by_law))

    def loss_tested_at(self, rate: float) -> bool:
        """Return whether a test of the compound tells its loss at a rate (rad/s)."""
        return self.relaxation is not None and rate <= (self.fastest_tested or math.inf)

    @classmethod
    def in_own_terms(cls, given: Mapping[str, Any]) -> Mapping[str, Any]:
        from underfoot.material.durometer_scales import durometer_reading

        leaf = leaf_of(given.get("shore_a"))
        if not isinstance(leaf.given, str):
            return given
        try:
            reading = durometer_reading(leaf.given)
        except InputError as error:
            raise refused_at(cls, ("shore_a",), error, leaf.given) from error
        leaf = replace(leaf, given=round(reading.shore_a, 1))
        if reading.note():
            leaf = replace(leaf, uncertainty=reading.scale.spread, source=reading.note())
        return {**given, "shore_a": Origin(GIVEN, leaf)}

    def problems(self, case: CaseView, where: str) -> Iterator[InputError]:
        if self.shore_a is None and self.modulus is None:
            yield InputError(
                "neither hardness nor modulus is given",
                where=where,
                remedy='Write shore_a = 68 (a durometer reading) or modulus = "5 MPa"',
            )
        if self.modulus is None and self.shore_a is not None and self.shore_a >= 100:
            yield RangeError(
                "Shore A 100 has no finite modulus",
                where=f"{where}.shore_a",
                allowed="below 100",
                remedy='Write modulus = "50 MPa" from a measurement instead',
            )


def _is_from_catalogue(item: Any) -> bool:
    origin = origin_of(item)
    return origin is not None and origin.kind == CATALOGUE


def _compound(path: Path, sha256: str | None, where: str) -> dict[str, Any]:
    """Return the values of a compound's file by field."""
    with meant_file(str(path), sha256, where):
        try:
            read = tomllib.loads(path.read_text(encoding="utf-8"))
        except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
            raise InputError(
                Message("{name} is no compound ({error})", name=path.name, error=error),
                where=where,
                allowed="a file that underfoot material wrote",
                remedy=Message("underfoot material {name} --out compound.toml", name=path.name),
            ) from error
    fields = set(Material.model_fields) - {"file", "sha256"}
    if wrong := sorted(read.keys() - fields):
        raise InputError(
            Message("{name}: a compound has no {wrong}", name=path.name, wrong=wrong[0]),
            where=where,
            allowed=", ".join(sorted(fields)),
            nearest=nearest_match(wrong[0], sorted(fields)),
        )
    return read


class Midsole(Section):
    """Soft layer between outsole and the stiff foot."""

    modulus: Modulus
    thickness: Length
    poisson_ratio: Poisson = default(0.3, 0.3, "foam", assumed=True)

    def unused_keys(self, case: CaseView) -> tuple[str, ...]:
        return () if case.compliance.layers else tuple(type(self).model_fields)


class SoleLayers(Section):
    """What carries the tread: outsole layer and midsole on a stiff foot."""

    outsole_thickness: Length = default(25 * _mm, "25 mm", "assumption", assumed=True)
    midsole: Midsole | None = None

    @property
    def thickness(self) -> float:
        """Outsole and midsole together, m."""
        return self.outsole_thickness + (self.midsole.thickness if self.midsole else 0.0)

    def unused_keys(self, case: CaseView) -> tuple[str, ...]:
        return () if case.compliance.layers else ("outsole_thickness",)


class OutsoleFile(Section):
    """Outsole from a file in place of heel and tread; ``underfoot outsole inspect`` reads one."""

    file_paths: ClassVar[tuple[str, ...]] = ("file",)  # the checksum tells which outsole it is

    file: str = Field(
        description="STEP, IGES, BREP, 3DM, STL, OBJ, PLY, OFF, GLB, GLTF or 3MF; the path counts "
        "from the case file's folder"
    )
    sha256: str | None = optional("checksum of the file that is meant; another file is refused")
    unit: Literal["auto", "mm", "cm", "m", "inch"] = default("auto", "auto", _READ)
    down: Direction = default("auto", "auto", _READ)
    forward: Direction = default("auto", "auto", _READ)
    foot: Literal["auto", "left", "right"] = default("auto", "auto", _READ)
    mirror: Flag = default(False, False, "the shoe that the file shows, not the other of the pair")
    region: Literal["whole", "heel", "forepart"] = default(
        "whole", "whole", "all of the file; the part far from the floor is trimmed"
    )
    region_length: Length | None = optional(
        "of the region; default: rear 30 %, front 45 % of a whole sole"
    )
    solid: str | None = optional("name of the body that is the outsole; default: found")
    side: Literal["auto", "left", "right"] = default(
        "auto", "auto", "of a pair in one file; auto refuses a pair"
    )
    cut_floor: Flag = default(False, False, "a plane that hardly reaches beyond the sole is kept")
    map_spacing: Annotated[float, Quantity("m", 2e-5, 0.002)] = default(
        0.25 * _mm, "0.25 mm", "of the height map, finer than the grid of the solver"
    )
    reach: Length = default(
        12 * _mm, "12 mm", "parts of the tilted sole higher above the floor are trimmed off"
    )

    @classmethod
    def complete_data(cls, table: dict[str, Any], folder: Path, where: str) -> dict[str, Any]:
        return with_checksum(table, "file", folder, where)

    def code(self) -> Any:
        return find_offer("outsole_readers", Path(self.file).suffix.lower()[1:])

    def problems(self, case: CaseView, where: str) -> Iterator[InputError]:
        down, forward = self.down, self.forward
        if down[0] in "+-" and forward[0] in "+-" and down[1] == forward[1]:
            yield InputError(
                Message(
                    "down {down} and forward {forward} lie on one axis", down=down, forward=forward
                ),
                where=f"{where}.forward",
                allowed="two different axes of the file",
            )
        finest = min(case.numerics.grid_spacing, case.numerics.quick_grid_spacing)
        if self.map_spacing > finest * (1 + 1e-9):
            yield RangeError(
                Message(
                    "{map_spacing} is coarser than the solver's grid",
                    map_spacing=display(self.map_spacing, "m"),
                ),
                where=f"{where}.map_spacing",
                allowed=Message("at most {most}", most=display(finest, "m")),
            )


class Certificate(Section):
    """What a test house read of the sole: a bound or a value of COF in one of its tests."""

    test: str
    cof: CertifiedFriction
    kind: str = "lower"
    sd: CertifiedFriction | None = optional("standard deviation of a value of COF")

    def reading(self, where: str = "shoe.certificate") -> Certified:
        """Return the reading."""
        from underfoot.friction.shoe_class import certificate_line

        return certificate_line(self.test, self.cof, self.kind, self.sd, where)


# a word of Python: the field can't be written below
_FIELDS: Any = {"class": (str | None, optional("slip class: EN ISO 20345 SR, ASTM F3445 SR, ..."))}
_Classed = create_model("_Classed", __base__=Section, **_FIELDS)


class Shoe(_Classed):
    """Shoe: slip class, compound, surface, shape (or outsole file), tread, wear, layers."""

    material: Material
    roughness: SurfaceRoughness
    outsole: OutsoleFile | None = None
    heel: SolePlan | None = Field(default={}, validate_default=True)
    tread: TreadPattern | None
    wear: Wear = Field(default={}, validate_default=True)
    sole: SoleLayers = SoleLayers()
    certificate: tuple[Certificate, ...] = ()

    def known_class(self) -> ShoeClass | None:
        """Return what the slip class and the certificates say of the sole; None: nothing."""
        name = getattr(self, "class")
        if name is None and not self.certificate:
            return None
        # SciPy is not for pages that only show a case
        from underfoot.friction.shoe_class import ShoeClass, shoe_class

        lines = tuple(line.reading() for line in self.certificate)
        if name is None:
            return ShoeClass("as certified", "shoe.certificate", lines)
        known = shoe_class(name)
        return replace(known, readings=(*known.readings, *lines)) if lines else known

    def problems(self, case: CaseView, where: str) -> Iterator[InputError]:
        try:
            known = self.known_class()
        except InputError as error:
            yield error
            return
        if known is None or known.fails:
            return
        from underfoot.friction.shoe_class import exclusive

        both = exclusive(known.readings)
        if both:
            yield InputError(
                Message("{first} and {second} exclude each other", first=both[0], second=both[1]),
                where=f"{where}.certificate",
                remedy="Leave out the bound that is not of this sole",
            )

    @classmethod
    def complete_data(cls, table: dict[str, Any], folder: Path, where: str) -> dict[str, Any]:
        outsole = table.get("outsole")
        if outsole is None:
            return {key: item for key, item in table.items() if key != "outsole"}
        for part in ("heel", "tread"):
            if table.get(part) and not from_catalogue(table[part]):
                raise InputError(
                    Message(
                        "is not used: the outsole comes from {plain}",
                        plain=plain(outsole.get("file")),
                    ),
                    where=f"{where}.{part}",
                    remedy=Message("Remove [shoe.{part}], or shoe.outsole.file", part=part),
                )
        if from_catalogue(table.get("roughness", {})):
            table = {**table, "roughness": {}}  # read on another sole
        return {**table, "heel": None, "tread": None}
