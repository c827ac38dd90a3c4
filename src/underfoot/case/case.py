"""The case: shoe, floor, contaminant, motion and one option in each slot; frozen, with a hash."""

from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from functools import cached_property
from pathlib import Path
from typing import Any, Never, Self

from pydantic import ValidationError

from underfoot.core import InputError, SourcedValue, content_hash, display
from underfoot.core.catalogue import Catalogue, catalogue_folders
from underfoot.core.deprecation import renamed_member
from underfoot.core.presentation import Presentable, Table
from underfoot.core.remark import Message

from . import text as toml
from .compose import DRY, compose_case, expand_sections, optional_reads
from .contact import ComplianceOption, FilmOption, HardnessOption, RoughContactOption
from .contaminant import ContaminantSection
from .errors import CaseError, place_error, translate_errors
from .friction import FrictionOption
from .motion import Motion, Sensor
from .numerics import Numerics
from .parts import FILE_VERSION, CaseParts, field_at, path_kind, slot_table, unit_at
from .people import Risk, Walkers
from .quantity import DOOR, one_value
from .section import (
    DEFAULT,
    FILE,
    GIVEN,
    Option,
    Origin,
    Section,
    item_section,
    origin_of,
    plain_text,
    unit_of,
    walk,
)
from .shoe import Shoe
from .surfaces import Floor, Interface
from .versions import GONE, current_path, current_settings, sentence, upgrade

_SECTIONS = tuple(CaseParts.model_fields)
UNNAMED, NAMED = {"numerics", "sensor", "file_version", "name", "description"}, 3
"""Sections that no name speaks of; changes that a name tells at most."""
_ABSENT = SourcedValue(None, "1", reason="not given in the case")


class Case(Presentable):
    """Everything one computation needs. Values are SI floats; text with units is for the door.

    The sections are the truth: text, hash and equality are computed from them. Make a case with
    ``load`` (a TOML file) or from its parts; change one with ``replace``. Two cases are equal when
    their content is: ``name``, ``description`` and comments don't count.

    Parameters:
        shoe, floor, contaminant, motion: Name of a catalogue entry, mapping (``{"from": "...",
            "speed": 0.5}``), or section. Numbers are SI floats or text with a unit;
            ``contaminant="none"`` is a dry floor.
        interface, hardness, rough_contact, film, compliance, friction, risk: Name of an option,
            mapping (``{"model": "constant", "cof": 0.5}``), or option.
        numerics, sensor, slip, name, description: Further sections and text.
        catalogue: To use instead of the package's own.

    Raises:
        CaseError: Everything that is wrong, each with its path.
    """

    name: str
    description: str
    shoe: Shoe
    floor: Floor
    contaminant: ContaminantSection | None
    motion: Motion
    interface: Interface
    hardness: HardnessOption | None
    rough_contact: RoughContactOption
    film: FilmOption
    compliance: ComplianceOption
    friction: FrictionOption
    numerics: Numerics
    sensor: Sensor
    risk: Risk
    slip: Walkers
    catalogue: Catalogue
    """The catalogue that the case was composed with."""
    changes: tuple[str, ...]
    """What reading a file of an older version changed, in words."""

    _parts: CaseParts
    _given: Mapping[str, Any]
    _text: str | None
    _edits: Mapping[str, Any]
    _folder: Path

    def __init__(self, *, catalogue: Catalogue | None = None, **parts: Any) -> None:
        if "contaminant" in parts and parts["contaminant"] is None:
            parts["contaminant"] = DRY
        given, edits = _current(parts)
        self._compose(given, catalogue or Catalogue.load(), toml.Places(), Path.cwd(), bool(edits))

    @classmethod
    def load(
        cls,
        path: Path | str,
        *,
        catalogue: Catalogue | None = None,
        settings: Mapping[str, Any] | None = None,
    ) -> Self:
        """Return the case in a TOML file.

        Parameters:
            path: The file. A folder ``catalogue`` beside it and ``UNDERFOOT_CATALOGUE`` are read
                too.
            catalogue: To use instead of those.
            settings: Dotted paths and values that replace what the file says.

        Raises:
            CaseError: Everything that is wrong with the file, each with its line.
        """
        path = Path(path)
        text = toml.read_text(path)
        if catalogue is None:
            catalogue = Catalogue.load(catalogue_folders(path.parent))
        places = toml.Places(str(path), text, changed=current_settings(settings or {}))
        return cls._from_text(text, catalogue, places, path.parent, settings or {})

    @classmethod
    def from_text(
        cls, text: str, *, catalogue: Catalogue | None = None, folder: Path | None = None
    ) -> Self:
        """Return the case in a TOML text; its files count from ``folder``, the present one."""
        there = folder or Path.cwd()
        return cls._from_text(text, catalogue or Catalogue.load(), toml.Places(), there, {})

    @classmethod
    def from_mapping(
        cls,
        mapping: Mapping[str, Any],
        *,
        catalogue: Catalogue | None = None,
        folder: Path | None = None,
    ) -> Self:
        """Return the case in nested mappings, numbers as text with units as in a file.

        Its files count from ``folder``, the present one.
        """
        return cls.from_text(toml.toml_text(mapping), catalogue=catalogue, folder=folder)

    @classmethod
    def _from_text(
        cls,
        text: str,
        catalogue: Catalogue,
        places: toml.Places,
        folder: Path,
        settings: Mapping[str, Any],
    ) -> Self:
        mapping = toml.parse_toml(text, places.file)
        version = _version(mapping, places)
        mapping.pop("file_version", None)
        given, edits = _current(mapping) if version < FILE_VERSION else (mapping, {})
        case = object.__new__(cls)
        older = bool(edits) or ("file_version" in text and version == 1)
        places.moved = {new: old for old, new, _ in upgrade(mapping)} if edits else {}
        remarks = [sentence(old, new) for new, old in places.moved.items()]
        if older:
            edits = {"file_version": FILE_VERSION, **edits}
        if places.file and "name" not in given:
            edits = {**edits, "name": Path(places.file).stem}
            given = {**given, "name": edits["name"]}
        changes = _with_name(given, _check_settings(settings))
        given = _set_paths(given, changes)
        case._compose(
            given,
            catalogue,
            places,
            folder,
            lambda path: older or (bool(changes) and not _covers(changes, path)),
            text=text,
            edits={**edits, **changes},
            remarks=remarks,
            context=DOOR,
        )
        return case

    def _compose(
        self,
        given: Mapping[str, Any],
        catalogue: Catalogue,
        places: toml.Places,
        folder: Path,
        lenient: Callable[[str], bool] | bool,
        *,
        text: str | None = None,
        edits: Mapping[str, Any] | None = None,
        remarks: list[str] | None = None,
        context: Mapping[str, Any] | None = None,
    ) -> None:
        """Set every section from what is given and the catalogue."""
        if "contaminant" not in given:
            error = InputError(
                "this section is missing",
                where=places("contaminant"),
                remedy='Write contaminant = "glycerol_90pct" (any fluid of the catalogue), '
                'or contaminant = "none" for a dry floor',
            )
            raise CaseError([error])
        allow = lenient if callable(lenient) else (lambda _path: lenient)
        composition = compose_case(given, catalogue, places, folder, allow)
        try:
            parts = CaseParts.model_validate(composition.tree, context=context)
        except ValidationError as error:
            more = translate_errors(
                error, CaseParts, composition.tree, places, without=composition.failed
            )
            raise CaseError([*composition.errors, *more]) from None
        for path, entry in composition.entries.items():
            section: Any = parts
            for part in path.split("."):
                section = getattr(section, part)
            if isinstance(section, Section):
                section._entry = entry
        problems = [p for path, section in walk(parts) for p in section.problems(parts, path)]
        if composition.errors or problems:
            raise CaseError(
                [*composition.errors, *(place_error(error, places) for error in problems)]
            )
        dropped = dict.fromkeys(composition.dropped)
        left_out = [f"{path} is left out: {why}" for path, why in composition.dropped.items()]
        vars(self).update(
            {name: getattr(parts, name) for name in _SECTIONS},
            catalogue=catalogue,
            changes=(*(remarks or ()), *(left_out if remarks or callable(lenient) else ())),
            _parts=parts,
            _given=_set_paths(given, dropped),
            _text=text,
            _edits={**(edits or {}), **dropped},
            _folder=folder,
        )

    def __setattr__(self, name: str, value: Any) -> Never:
        raise InputError(
            Message("a case is frozen: {name} can't be set", name=name),
            where=f"case.{name}",
            remedy=Message('Make a new case: case = case.replace("{name}", ...)', name=name),
        )

    def __delattr__(self, name: str) -> Never:
        self.__setattr__(name, None)

    def replace(self, path: str | Mapping[str, Any], value: Any = None, /) -> Self:
        """Return a new case with one value changed, or several as a mapping.

        ``case.replace("contaminant.viscosity", "41 cP")`` or ``0.041`` (SI); None takes a key out,
        so that the catalogue or the default counts again; a section's path takes the name of a
        catalogue entry, a slot's that of an option, a mapping or a section. What the new option of
        a slot does not use goes with the old one.
        """
        changes = _check_settings(path if isinstance(path, Mapping) else {path: value})
        for section_path, section in list(changes.items()):
            if isinstance(section, Section):
                fields = self._changed_fields(section_path, section)
                if fields is not None:
                    del changes[section_path]
                    changes |= fields
        case = object.__new__(type(self))
        before = {path: old for path, old in self._edits.items() if not _covers(changes, path)}
        case._compose(
            _set_paths(self._given, changes),
            self.catalogue,
            toml.Places(),
            self._folder,
            lambda path: not _covers(changes, path),
            text=self._text,
            edits={**before, **changes},
        )
        return case

    def _changed_fields(self, path: str, section: Section) -> dict[str, Any] | None:
        """Return what a section changes by dotted path; None where a file can't say it so."""
        present: Any = self._parts
        for part in path.split("."):
            present = getattr(present, part, None)
        if type(present) is not type(section):
            return None
        changed: dict[str, Any] = {}
        for name, value in section.tree().items():
            old, here = getattr(present, name, None), f"{path}.{name}"
            plain = getattr(section, name, None)
            if name == getattr(section, "key", None) or (
                plain == old and section.origin(name) == present.origin(name)
            ):
                continue
            if isinstance(value, Section):
                below = self._changed_fields(here, value)
                if below is None:
                    return None
                changed |= below
            elif value is None:
                return None
            else:
                changed[here] = value
        return changed

    def model_copy(self, *, update: Mapping[str, Any] | None = None) -> Self:
        """Return the case with other sections, as ``Case(**{**parts, **update})``."""
        parts = {name: getattr(self, name) for name in _SECTIONS}
        return type(self)(catalogue=self.catalogue, **{**parts, **(update or {})})

    def __replace__(self, **changes: Any) -> Self:
        return self.model_copy(update=changes)

    def save(self, path: Path | str, *, overwrite: bool = False) -> None:
        """Write the case as a file: comments, catalogue entries and units of its file kept."""
        toml.save(self.to_toml(), Path(path), overwrite=overwrite)

    def to_toml(self, *, complete: bool = False) -> str:
        """Return the case as TOML; ``complete`` writes every value with its source, no entries."""
        if complete or _has_section(self._given):
            return toml.toml_text(
                self._complete_tree(), "Complete case: every value with its source."
            )
        if self._text is None:
            head = {"file_version": FILE_VERSION}
            return toml.toml_text(head | {k: _as_text(v, k) for k, v in self._given.items()})
        if not self._edits:
            return self._text
        edits = {path: _as_text(value, path) for path, value in self._edits.items()}
        text = toml.change_text(self._text, edits, expand_sections)
        return toml.change_text(text, dict.fromkeys(_empty_sections(text)), expand_sections)

    @cached_property
    def hash(self) -> str:
        """Hash of the values and their uncertainties, the same on every machine.

        Files count by their content, options of other packages by their code, and what an option
        looks up in the catalogue by what stands there. Names, comments, sources and what nothing
        reads don't count.
        """
        content: dict[str, Any] = {"catalogue": self.consulted.content()}
        content["code"] = {path: section.code() for path, section in walk(self._parts)}
        for path, section, name in self._values():
            cls, here = type(section), f"{path}.{name}"
            if isinstance(section, Option) and name == section.key:
                content[here] = section.name if _is_packaged(section) else cls
                continue
            value = getattr(section, name)
            if here in self.idle_paths or value is None or isinstance(value, Section):
                continue
            if name in cls.file_paths:
                content[here] = Path(value).stem
            elif name not in cls.replaced:
                content[here] = _round_number(value)
                origin = section._origins.get(name)
                if origin and origin.value == value and origin.uncertainty is not None:
                    content[f"{here}.uncertainty"] = _round_number(origin.uncertainty)
        return content_hash(content)[:32]

    @property
    def consulted(self) -> Catalogue:
        """The entries of the catalogue that the chosen options look up."""
        options = (each for _, each in walk(self._parts) if isinstance(each, Option))
        return self.catalogue.of({kind for option in options for kind in option.consults})

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Case) and self.hash == other.hash

    def __hash__(self) -> int:
        return hash(self.hash)

    @cached_property
    def idle_paths(self) -> frozenset[str]:
        """Paths of values that count for nothing: nothing that is chosen reads them.

        What an option of another package reads is not known: beside one, every value counts.
        """
        sections = list(walk(self._parts))
        options = [each for _, each in sections if isinstance(each, Option)]
        idle = set(optional_reads()) - {path for option in options for path in option.reads}
        if all(map(_is_packaged, options)):
            idle |= {
                f"{path}.{name}"
                for path, section in sections
                for name in section.unused_keys(self._parts)
            }
        return frozenset(idle)

    @cached_property
    def idle_given(self) -> Mapping[str, tuple[str, ...]]:
        """Names of the values that were given and count for nothing, by section."""
        named: dict[str, tuple[str, ...]] = {}
        for path, origin in self.origins.items():
            section, _, name = path.rpartition(".")
            if origin.kind == GIVEN and path in self.idle_paths:
                named[section] = (*named.get(section, ()), name)
        return named

    @cached_property
    def origins(self) -> Mapping[str, Origin]:
        """Where each value comes from, by dotted path."""
        return {
            f"{path}.{name}": origin
            for path, section, name in self._values()
            if (origin := section.origin(name)) is not None
        }

    def _values(self) -> Iterator[tuple[str, Section, str]]:
        """Yield path, section and name of every value, of an option its key first."""
        for path, section in walk(self._parts):
            key = (section.key,) if isinstance(section, Option) else ()
            yield from ((path, section, name) for name in (*key, *type(section).model_fields))

    @property
    def entries(self) -> Mapping[str, str]:
        """Catalogue entry of each section that was taken from one."""
        return {path: section._entry for path, section in walk(self._parts) if section._entry}

    def value(self, path: str) -> Any:
        """Return the value at a dotted path, in SI; None where the chosen option has none."""
        section, name = self._holder(path)
        if section is None:
            return None
        if isinstance(section, Option) and name == section.key:
            return section.name
        return getattr(section, name) if name in type(section).model_fields else None

    def named_values(
        self, *heads: str, spelled: Callable[[Any, str], Any] = one_value
    ) -> list[tuple[str, Any]]:
        """Return path and value of all that is set below some sections, free of their spelling.

        Draws are named by them: what counts for nothing stands with its default, as if nobody had
        given it. ``spelled`` takes value and unit.
        """
        values = []
        for path in (path for path in self.origins if path.startswith(heads)):
            value = self.value(path)
            if path in self.idle_paths:
                value = None if (field := field_at(path)) is None else field.default
            if value is not None:
                values.append((path, spelled(value, unit_at(path))))
        return values

    def sourced_value(self, path: str) -> SourcedValue:
        """Return the number at a dotted path with its uncertainty, source and marks."""
        section, name = self._holder(path)
        if section is None or name not in type(section).model_fields:
            return _ABSENT
        return section.sourced_value(name)

    sourced = renamed_member("sourced", "sourced_value", gone="0.4")

    def _holder(self, path: str) -> tuple[Section | None, str]:
        """Return the section that holds a value, and the value's name in it."""
        path = current_path(path)
        path_kind(path)
        section: Any = self._parts
        *parents, name = path.split(".")
        for part in parents:
            section = getattr(section, part, None)
            if not isinstance(section, Section):
                return None, name
        return section, name

    @property
    def effective_rq(self) -> SourcedValue:
        """Rq of the interface, m: as given, else f sqrt(Rq_shoe^2 + Rq_floor^2) of the stylus."""
        return self.interface.rq(self.shoe.roughness, self.floor.roughness)

    def __repr__(self) -> str:
        fluid = "dry" if self.contaminant is None else self.entries.get("contaminant", "fluid")
        shoe, floor = self.entries.get("shoe", "shoe"), self.entries.get("floor", "floor")
        name = self.name if len(self.name) <= 60 else self.name[:57] + "..."
        return (
            f"<Case {name!r} [{self.hash[:12]}]: {shoe}, {floor}, {fluid}, "
            f"friction {self.friction.name}>"[:199]
        )

    def __str__(self) -> str:
        return self.summary()

    def table(self) -> Table:
        """Return every value that is set with its origin."""
        rq = self.effective_rq
        rows = [*self.rows(), ("effective Rq of the interface", str(rq), rq.source)]
        if self.contaminant is None:
            rows.append(("contaminant", "none", "dry floor"))
        return Table(f"{self.name}  [{self.hash[:12]}]", ("value", "given", "origin"), rows)

    def rows(self) -> list[tuple[str, str, str]]:
        """Return (dotted path, value as given, origin in words) of every value that is set."""
        return [
            (path, value_text(origin, unit_at(path)), _origin_text(origin))
            for path, origin in self.origins.items()
            if path not in self.idle_paths or origin.kind != DEFAULT
        ]

    def _complete_tree(self) -> dict[str, Any]:
        tree: dict[str, Any] = {
            "file_version": FILE_VERSION,
            "name": self.name,
            "description": self.description,
        }
        for path, section, name in self._values():
            table, here = tree, f"{path}.{name}"
            for part in path.split("."):
                table = table.setdefault(part, {})
            origin = self.origins.get(here)
            if origin is None or name in section.replaced:
                continue
            if here not in self.idle_paths or origin.kind == GIVEN:
                table[name] = _origin_toml(origin, here)
        if self.contaminant is None:
            tree["contaminant"] = DRY
        return tree


def _is_packaged(option: Option) -> bool:
    """Return whether an option is of this package."""
    return type(option).__module__.startswith("underfoot.")


def value_text(origin: Origin, unit: str, *, spread: bool = True) -> str:
    """Return a value as given, with its uncertainty unless ``spread`` is off."""
    given = origin.leaf.given
    if isinstance(given, bool):
        return "yes" if given else "no"
    if isinstance(given, list | tuple):
        return f"{len(given)} term{'s' * (len(given) != 1)}"
    if origin.kind == FILE and isinstance(origin.value, float):
        return display(origin.value, unit)
    text, deviation = f"{plain_text(given, unit)}", origin.leaf.uncertainty
    return text if deviation is None or not spread else f"{text} ± {deviation}"


def _origin_text(origin: Origin) -> str:
    leaf = origin.leaf
    plain = {GIVEN: "given", DEFAULT: "default"}
    sentence = plain.get(origin.kind, f"{origin.kind}: {origin.entry}")
    sentence += ", assumed" if leaf.assumed else ""
    sentence += "" if leaf.verified else ", from memory"
    return sentence + (f" ({leaf.source})" if leaf.source else "")


def _version(mapping: Mapping[str, Any], places: toml.Places) -> int:
    version = mapping.get("file_version", 1)
    if isinstance(version, bool) or not isinstance(version, int) or version < 1:
        error = InputError(
            Message("{version} is no version", version=repr(version)),
            where=places("file_version"),
            allowed="1 or 2",
        )
        raise CaseError([error])
    if version > FILE_VERSION:
        error = InputError(
            Message(
                "the file was written for version {version} of the case format", version=version
            ),
            where=places("file_version"),
            allowed=Message("{file_version} or older", file_version=FILE_VERSION),
            remedy="Update underfoot",
        )
        raise CaseError([error])
    return version


def _current(mapping: Mapping[str, Any]) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return a mapping in the paths of version 2, and the edits that make it so."""
    edits: dict[str, Any] = {}
    for old, new, value in upgrade(mapping):
        edits |= {old: None, new: value}
    if not edits:
        return dict(mapping), edits
    current = _set_paths(mapping, edits)
    gone = [path for path in GONE if _is_empty(current, path)]
    edits |= dict.fromkeys(gone)
    return _set_paths(current, dict.fromkeys(gone)), edits


def with_settings(mapping: Mapping[str, Any], settings: Mapping[str, Any]) -> dict[str, Any]:
    """Return a mapping in the paths of version 2 with values set by dotted path."""
    return _set_paths(_current(mapping)[0], current_settings(settings))


def _with_name(given: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """Return changes with a name that tells them: the file's own may state what they replace."""
    replaced = {
        path: value
        for path, value in changes.items()
        if path.partition(".")[0] not in UNNAMED
        and expand_sections(_value_at(given, path), path) != expand_sections(value, path)
    }
    if "name" in changes or not isinstance(given.get("name"), str) or not replaced:
        return dict(changes)
    told = [_told_change(path, value) for path, value in replaced.items()]
    more = [Message("and {count} more", count=len(told) - NAMED)] if len(told) > NAMED else []
    return {**changes, "name": ", ".join([given["name"], *told[:NAMED], *more])}


def _told_change(path: str, value: Any) -> str:
    """Return a changed value in words: of a section the entry or option that it takes."""
    section, _, key = path.rpartition(".")
    if key in ("value", "from", "model") and section:  # it says nothing by itself
        key = section.rpartition(".")[2]
    words = key.replace("_", " ")
    if isinstance(value, Mapping):
        value = next((value[key] for key in ("value", "from", "model") if key in value), "changed")
    if isinstance(value, Section | list | tuple):
        value = "changed"
    if isinstance(value, float):  # of a program, for people type texts: no false digits
        value = f"{value:.3g}"
    return f"{words} {'as by default' if value is None else str(value).replace('_', ' ')}"


def _value_at(mapping: Mapping[str, Any], path: str) -> Any:
    item: Any = mapping
    for part in path.split("."):
        item = item.get(part) if isinstance(item, Mapping) else None
    return item


def _is_empty(mapping: Mapping[str, Any], path: str) -> bool:
    item = _value_at(mapping, path)
    marks = {"source", "note", "assumed", "verified"}
    return isinstance(item, Mapping) and set(item) <= marks


def _empty_sections(text: str) -> list[str]:
    mapping = toml.parse_toml(text)
    return [path for path in GONE if _is_empty(mapping, path)]


def _check_settings(settings: Mapping[str, Any]) -> dict[str, Any]:
    """Return settings in the paths of version 2; refuse unknown paths and misfits."""
    changes = current_settings(settings)
    for path, value in changes.items():  # an option of one's own brings its keys
        slot = slot_table().get(path.rpartition(".")[0])
        if slot is not None and isinstance(value, str) and path.endswith(f".{slot.key}"):
            with suppress(ValueError, InputError):  # what is wrong with it is told with all else
                slot.pick(value)
    for path, value in changes.items():
        allowed = value is None or isinstance(value, str | Mapping | Section)
        if path_kind(path) == "section" and (not allowed or origin_of(value) is not None):
            raise InputError(
                Message("{given} can't stand for a section", given=repr(value)),
                where=path,
                allowed="the name of a catalogue entry or option, a mapping, or a section",
            )
    return changes


def _covers(changes: Mapping[str, Any], path: str) -> bool:
    """Return whether a path, or a section around it, is among those set."""
    return any(path == other or path.startswith(other + ".") for other in changes)


def _set_paths(mapping: Mapping[str, Any], edits: Mapping[str, Any]) -> dict[str, Any]:
    """Return nested mappings with values set (or, with None, taken out) by dotted path."""
    edited = dict(mapping)
    for path, value in edits.items():
        table, parts = edited, path.split(".")
        for depth, part in enumerate(parts[:-1]):
            here = ".".join(parts[: depth + 1])
            if table.get(part) is None and value is None:
                break
            below = expand_sections(table.get(part, {}), here) if part in table else {}
            if not isinstance(below, Mapping) or "value" in below:
                raise InputError("is a value, not a section", where=here)
            table[part] = dict(below)
            table = table[part]
        else:
            if value is None:
                table.pop(parts[-1], None)
            else:
                table[parts[-1]] = value
    return edited


def _as_text(item: Any, path: str) -> Any:
    """Return a given value as TOML writes it: SI numbers as text with their unit."""
    if isinstance(item, Section):
        item = {key: value for key, value in item.tree().items() if key not in item.replaced}
    origin = None if isinstance(item, Mapping) else origin_of(item)
    if origin is not None:
        return _origin_toml(origin, path)
    if isinstance(item, Mapping):
        leaf = "value" in item
        return {
            k: _as_text(v, path if leaf and k in ("value", "uncertainty") else f"{path}.{k}")
            for k, v in item.items()
        }
    if isinstance(item, list | tuple):
        return [_as_text(value, path) for value in item]
    return plain_text(item, _unit_in(path))


def _has_section(item: Any) -> bool:
    if isinstance(item, Mapping):
        return any(map(_has_section, item.values()))
    return isinstance(item, Section)


def _unit_in(path: str) -> str:
    field = field_at(path)
    if field is not None:
        return unit_of(field)
    head, _, name = path.rpartition(".")
    parent = field_at(head) if head else None
    section = None if parent is None else item_section(parent)
    if section is not None and name in section.model_fields:
        return unit_of(section.model_fields[name])
    return "1"


def _origin_toml(origin: Origin, path: str) -> Any:
    leaf = origin.leaf
    given = _as_text(leaf.given, path)
    spread = _as_text(leaf.uncertainty, path)
    marks: dict[str, Any] = {"uncertainty": spread, "source": leaf.source or None}
    if origin.kind != DEFAULT or not isinstance(origin.value, str) or origin.value != given:
        marks |= {
            "assumed": True if leaf.assumed else None,
            "verified": None if leaf.verified else False,
            "note": leaf.note or None,
            "erratum": leaf.erratum or None,
        }
    marks = {key: value for key, value in marks.items() if value is not None}
    return {"value": given, **marks} if marks else given


def _round_number(value: Any) -> Any:
    """Return the value with 12 significant digits: "219 cP" and "0.219 Pa*s" are the same."""
    if isinstance(value, float):
        return float(f"{value:.12g}")
    if isinstance(value, Section):
        return {name: _round_number(getattr(value, name)) for name in type(value).model_fields}
    if isinstance(value, list | tuple):
        return [_round_number(item) for item in value]
    return value
