"""The case: shoe, floor, contaminant, motion and models; frozen, complete, with a hash."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pydantic import Field, PrivateAttr, ValidationError

from underfoot.core import InputError, SourcedValue
from underfoot.core.catalogue import Catalogue, catalogue_folders
from underfoot.core.leaves import Leaf

from . import toml
from .checks import mismatches
from .compose import DEFAULT, DRY, GIVEN, Origin, composed, nested
from .content import case_hash, spread
from .errors import CaseError, translated
from .friction_table import with_friction_table
from .keys import known_paths, path_kind, unit_of, unknown_path
from .motion_table import with_motion_history
from .outsole_checksum import with_checksum
from .places import Places
from .quantity import DOOR, default_of
from .schema import FILE_VERSION, fields
from .sections import (
    Contaminant,
    Floor,
    Interface,
    Models,
    Numerics,
    Risk,
    Section,
    Shoe,
)
from .sections_motion import Motion, Sensor
from .sections_slip import SlipPeople


class Case(Section):
    """Everything one computation needs. Values are SI floats; text with units is for the door.

    Make one with ``load`` (a TOML file) or ``from_mapping``; change one with ``replace``. Two
    cases are equal when their content is: ``name``, ``description``, comments and values that no
    chosen model looks at don't count.
    """

    file_version: int = FILE_VERSION
    name: str = "case"
    description: str = ""
    shoe: Shoe
    floor: Floor
    contaminant: Contaminant | None = Field(None, description='"none" for a dry floor')
    motion: Motion
    interface: Interface = Interface()
    models: Models = Models()
    numerics: Numerics = Numerics()
    sensor: Sensor = Sensor()
    risk: Risk = Risk()
    slip: SlipPeople = SlipPeople()

    _origins: dict[str, Origin] = PrivateAttr(default_factory=dict)
    _entries: dict[str, str] = PrivateAttr(default_factory=dict)
    _text: str = PrivateAttr(default="")
    _catalogue: Catalogue = PrivateAttr(default_factory=Catalogue)
    _hash: str = PrivateAttr(default="")
    _folder: Path = PrivateAttr(default_factory=Path.cwd)

    @classmethod
    def load(
        cls,
        path: Path | str,
        *,
        catalogue: Catalogue | None = None,
        settings: Mapping[str, Any] | None = None,
    ) -> Case:
        """Return the case in a TOML file.

        Parameters
        ----------
        path
            The file. A folder ``catalogue`` beside it and ``UNDERFOOT_CATALOGUE`` are read too.
        catalogue
            To use instead of those.
        settings
            Dotted paths and values that replace what the file says.

        Errors
        ------
        CaseError
            Everything that is wrong with the file, each with its line.
        """
        path = Path(path)
        text = toml.read(path)
        if catalogue is None:
            catalogue = Catalogue.load(catalogue_folders(path.parent))
        places = Places(str(path), text, changed=settings or ())
        if settings:
            toml.parsed(text, str(path))
            text = toml.changed(text, settings, _path_kind)
        return cls._from_text(text, catalogue, places, path.parent)

    @classmethod
    def from_text(cls, text: str, *, catalogue: Catalogue | None = None) -> Case:
        """Return the case in a TOML text."""
        return cls._from_text(text, catalogue or Catalogue.load(), Places())

    @classmethod
    def from_mapping(
        cls, mapping: Mapping[str, Any], *, catalogue: Catalogue | None = None
    ) -> Case:
        """Return the case in nested mappings, numbers as text with units as in a file."""
        return cls.from_text(toml.written(mapping), catalogue=catalogue)

    @classmethod
    def _from_text(
        cls, text: str, catalogue: Catalogue, places: Places, folder: Path | None = None
    ) -> Case:
        mapping: Mapping[str, Any] = toml.parsed(text, places.file)
        _check_version(mapping, places)
        folder = Path.cwd() if folder is None else folder
        mapping = with_friction_table(mapping, folder, places)
        mapping = with_motion_history(mapping, folder, places)
        mapping = with_checksum(mapping, folder, places)
        dry = _is_dry(mapping)
        if dry:
            mapping = {**mapping, "contaminant": {"from": DRY}}
        elif "contaminant" not in mapping:
            raise CaseError(
                [
                    InputError(
                        "this section is missing",
                        where=places("contaminant"),
                        remedy='Write contaminant = "glycerol_90pct" (any fluid of the catalogue), '
                        'or contaminant = "none" for a dry floor',
                    )
                ]
            )
        parts = composed(mapping, catalogue, places)
        origins = parts.origins
        tree = nested(origins, mapping)
        if dry:
            tree.pop("contaminant", None)
        try:
            case = cls.model_validate(tree, context=DOOR)
        except ValidationError as error:
            found = translated(error, cls, places, without=parts.failed)
            raise CaseError([*parts.errors, *found]) from None
        if parts.errors:
            raise CaseError(parts.errors)
        given = {path for path, origin in origins.items() if origin.kind == GIVEN}
        problems = list(mismatches(case, given, places))
        if problems:
            raise CaseError(problems)
        case._origins = {**case._default_origins(origins), **origins}
        case._entries = parts.entries
        case._text = text
        case._catalogue = catalogue
        case._folder = folder
        case._hash = case_hash(case)
        return case

    def save(self, path: Path | str, *, overwrite: bool = False) -> None:
        """Write the file as it was read: comments, catalogue entries and units kept."""
        toml.save(self._text, Path(path), overwrite=overwrite)

    def to_toml(self, *, complete: bool = False) -> str:
        """Return the file's text; ``complete`` writes every value with its source, no entries."""
        return toml.complete_text(self) if complete else self._text

    def replace(self, path: str | Mapping[str, Any], value: Any = None, /) -> Case:
        """Return a new case with one value changed (or several, as a mapping).

        ``case.replace("contaminant.viscosity", "41 cP")``; None takes a key out, so that the
        catalogue or the default counts again; a section's path takes the name of an entry.
        """
        settings = path if isinstance(path, Mapping) else {path: value}
        text = toml.changed(self._text, settings, _path_kind)
        return type(self)._from_text(text, self._catalogue, Places(), self._folder)

    @property
    def hash(self) -> str:
        """Hash of the content, the same on every machine; names and comments don't count."""
        return self._hash

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Case) and self._hash == other._hash

    def __hash__(self) -> int:
        return hash(self._hash)

    def __str__(self) -> str:
        from .describe import composition

        return composition(self)

    @property
    def origins(self) -> Mapping[str, Origin]:
        """Where each value comes from, by dotted path."""
        return self._origins

    @property
    def catalogue(self) -> Catalogue:
        """The catalogue that the case was read with."""
        return self._catalogue

    @property
    def entries(self) -> Mapping[str, str]:
        """Catalogue entry of each section that was taken from one."""
        return self._entries

    def value(self, path: str) -> Any:
        """Return the value at a dotted path, in SI."""
        found: Any = self
        for part in path.split("."):
            if found is None:
                return None
            if not isinstance(found, Section) or part not in type(found).model_fields:
                raise unknown_path(Case, path)
            found = getattr(found, part)
        return found

    def sourced(self, path: str) -> SourcedValue:
        """Return the number at a dotted path with its uncertainty, source and marks."""
        value, unit = self.value(path), unit_at(path)
        if value is None:
            return SourcedValue(None, unit, reason="not given in the case")
        origin = self._origins.get(path)
        if origin is None:
            return SourcedValue(float(value), unit, source="case")
        leaf = origin.leaf
        source = leaf.source or ("given in the case" if origin.kind == GIVEN else origin.kind)
        return SourcedValue(
            float(value),
            unit,
            source=source + ("" if leaf.verified else " (from memory, not verified)"),
            uncertainty=spread(self, path),
            assumed=leaf.assumed,
            note=leaf.note,
        )

    @property
    def effective_rq(self) -> SourcedValue:
        """Rq of the interface, m: as given, else f sqrt(Rq_shoe^2 + Rq_floor^2) of the stylus.

        f is ``interface.roughness_beyond_cutoff``.
        """
        if self.interface.effective_rq is not None:
            return self.sourced("interface.effective_rq")
        shoe, floor = self.shoe.roughness.rq_or_estimate, self.floor.roughness.rq_or_estimate
        if shoe is None or floor is None:
            raise InputError("no roughness is given", where="interface.effective_rq")
        return SourcedValue(
            self.interface.roughness_beyond_cutoff * math.hypot(shoe, floor),
            "m",
            source=f"composite of the stylus Rq of shoe and floor, "
            f"times {self.interface.roughness_beyond_cutoff:g}",
            assumed=True,
            note="the stylus' cut-off hides long waves, through which fluid leaks",
        )

    def _default_origins(self, known: Mapping[str, Origin]) -> dict[str, Origin]:
        found = {}
        for path, field in fields(type(self)):
            default = default_of(field)
            if default is None or path in known or self.value(path) is None:
                continue
            leaf = Leaf(default.text, source=default.source, assumed=default.assumed)
            found[path] = Origin(DEFAULT, leaf)
        return found


def unit_at(path: str) -> str:
    """Return the SI unit of the value at a dotted path of a case, ``"1"`` for words."""
    return unit_of(Case, path)


def paths() -> list[str]:
    """Return every dotted path that a case file may set, sections included."""
    return known_paths(Case)


def _path_kind(path: str) -> str:
    return path_kind(Case, path)


def _is_dry(mapping: Mapping[str, Any]) -> bool:
    fluid = mapping.get("contaminant")
    return fluid == DRY or (isinstance(fluid, Mapping) and fluid.get("from") == DRY)


def _check_version(mapping: Mapping[str, Any], places: Places) -> None:
    version = mapping.get("file_version", FILE_VERSION)
    if isinstance(version, bool) or not isinstance(version, int) or version < 1:
        raise CaseError(
            [InputError(f"{version!r} is no version", where=places("file_version"), allowed="1")]
        )
    if version > FILE_VERSION:
        raise CaseError(
            [
                InputError(
                    f"the file was written for version {version} of the case format",
                    where=places("file_version"),
                    allowed=f"{FILE_VERSION} or older",
                    remedy="Update underfoot",
                )
            ]
        )
