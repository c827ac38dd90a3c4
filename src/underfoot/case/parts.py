"""The sections of a case together, and their dotted paths."""

from collections.abc import Iterable, Iterator
from functools import lru_cache
from typing import Any

from pydantic import Field
from pydantic.fields import FieldInfo

from underfoot.core import InputError, unknown_name
from underfoot.core.errors import nearest_match
from underfoot.core.remark import Message

from .contact import ComplianceOption, FilmOption, HardnessOption, RoughContactOption
from .contaminant import ContaminantSection
from .friction import FrictionOption
from .motion import Motion, Sensor
from .numerics import Numerics
from .people import Risk, Walkers
from .section import Option, Section, section_in, unit_of
from .shoe import Shoe
from .surfaces import Floor, Interface
from .versions import current_path

FILE_VERSION = 2
"""Version of the case files that this package writes; it reads older ones."""
CATALOGUE_SECTIONS: dict[str, tuple[str, str]] = {
    "shoe": ("shoe", ""),
    "shoe.material": ("material", ""),
    "shoe.roughness": ("material", "roughness"),
    "floor": ("floor", ""),
    "contaminant": ("fluid", ""),
    "motion": ("setup", "motion"),
    "sensor": ("setup", "sensor"),
    "risk": ("setup", "risk"),
}
"""Sections that can be taken ``from`` the catalogue: kind of entry and its sub-table."""

USUAL_WORDS = {
    "load": "normal_force",
    "force": "normal_force",
    "velocity": "speed",
    "hardness": "shore_a",
    "shore": "shore_a",
}
"""What people write: the key that it means."""


def _usual() -> Any:
    return Field(default={}, validate_default=True)


class CaseParts(Section):
    """Everything one computation needs."""

    name: str = "case"
    description: str = ""
    shoe: Shoe
    floor: Floor
    contaminant: ContaminantSection | None = Field(description='"none" for a dry floor')
    motion: Motion
    interface: Interface = _usual()
    hardness: HardnessOption | None = _usual()
    rough_contact: RoughContactOption = _usual()
    film: FilmOption = _usual()
    compliance: ComplianceOption = _usual()
    friction: FrictionOption = _usual()
    numerics: Numerics = Numerics()
    sensor: Sensor = Sensor()
    risk: Risk = _usual()
    slip: Walkers = Walkers()


def _nodes(
    model: type[Section], prefix: str = ""
) -> Iterator[tuple[str, FieldInfo, type[Section] | None]]:
    """Yield path, field and section of all below a section; of a slot, that of all options."""
    if issubclass(model, Option) and not model.name:
        seen: set[str] = set()
        for option in model.known_options().values():
            below = [node for node in _nodes(option, prefix) if node[0] not in seen]
            seen |= {path for path, *_ in below}
            yield from below
        return
    for name, field in model.model_fields.items():
        section = section_in(field)
        yield f"{prefix}{name}", field, section
        if section is not None:
            yield from _nodes(section, f"{prefix}{name}.")


@lru_cache(maxsize=1)
def _tables(_count: int) -> tuple[dict[str, FieldInfo], dict[str, type[Option]]]:
    nodes = list(_nodes(CaseParts))
    return (
        {path: field for path, field, section in nodes if section is None},
        {path: slot for path, _, slot in nodes if slot is not None and issubclass(slot, Option)},
    )


def fields() -> dict[str, FieldInfo]:
    """Return every value by its dotted path; of a slot, those of all options."""
    return _tables(Option.count())[0]


def slot_table() -> dict[str, type[Option]]:
    """Return every slot by its dotted path."""
    return _tables(Option.count())[1]


def field_at(path: str) -> FieldInfo | None:
    """Return the field at a dotted path, or None; the first option of a slot that has it."""
    path = current_path(path)
    if path not in fields() and path not in keys():
        for at, slot in slot_table().items():
            if path.startswith(f"{at}."):
                slot.options()  # those of other packages
    return fields().get(path)


def keys() -> dict[str, type[Option]]:
    """Return the dotted path of the key that names the option of each slot."""
    return {f"{path}.{slot.key}": slot for path, slot in slot_table().items()}


def paths() -> list[str]:
    """Return every dotted path that a case file may set, sections included, of all packages."""
    for slot in {*slot_table().values()}:
        slot.options()
    leaves = [*fields(), *keys()]
    sections = {path.rsplit(".", depth)[0] for path in leaves for depth in (1, 2, 3)}
    return sorted({*leaves, *sections})


def unit_at(path: str) -> str:
    """Return the SI unit of the value at a dotted path, ``"1"`` for words."""
    field = field_at(path)
    if field is not None:
        return unit_of(field)
    if current_path(path) in keys():
        return "1"
    raise unknown_path(current_path(path))


def sections_at(path: str) -> list[type[Section]]:
    """Return the sections that may stand at a dotted path: of a slot, every option."""
    models: list[type[Section]] = [CaseParts]
    for part in path.split(".") if path else []:
        if part.isdigit():
            continue
        below: list[type[Section]] = []
        for model in models:
            field = model.model_fields.get(part)
            section = None if field is None else section_in(field)
            if section is not None and issubclass(section, Option) and not section.name:
                below += section.known_options().values()
            elif section is not None:
                below.append(section)
        models = list(dict.fromkeys(below))
    return models


def path_kind(path: str) -> str:
    """Return "section" or "value"; refuse unknown paths."""
    path = path.removesuffix(".from")
    if field_at(path) is not None or path in keys():
        return "value"
    if sections_at(path):
        return "section"
    raise unknown_path(path)


def _below(section: str, listed: Iterable[str]) -> list[str]:
    return [path for path in listed if path.startswith(f"{section}.")]


def nearest_path(path: str) -> str | None:
    """Return the path that another one means, None where none is close.

    One of its own section with the same last word comes first, then any of its section.

    >>> nearest_path("floor.rq"), nearest_path("motion.load"), nearest_path("motion.angle")
    ('floor.roughness.rq', 'motion.normal_force', 'motion.shoe_angle')
    """
    known, section, last = paths(), path.partition(".")[0], path.split(".")[-1]
    last = USUAL_WORDS.get(last, last)
    alike = [each for each in known if each.split(".")[-1] == last]
    return (
        nearest_match(path, _below(section, alike), least=0)
        or nearest_match(path, _below(section, known))
        or nearest_match(path, alike, least=0)
        or nearest_match(path, known)
    )


def unknown_path(path: str) -> InputError:
    """Return the error for a path that is none: the nearest one, or the package that can't load."""
    known, (*sections, _) = paths(), path.split(".")
    if path in known:
        return InputError(
            Message('"{path}" is a section, not a value', path=path),
            allowed=", ".join(_below(path, known)),
        )
    above = [".".join(sections[:depth]) for depth in range(len(sections), 0, -1)]
    beside = next((near for at in above if (near := _below(at, known))), known)
    error = unknown_name("path", path, beside)
    error.nearest = nearest_path(path)
    for at, slot in slot_table().items():
        broken = "; ".join(slot.load_failures()) if path.startswith(f"{at}.") else ""
        if broken:
            error.remedy = Message("If it is a key of a package: {broken}", broken=broken)
    return error
