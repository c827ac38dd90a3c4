"""Case files of version 1: their paths in version 2."""

from collections.abc import Iterator, Mapping
from typing import Any

from underfoot.core.leaves import INHERITED
from underfoot.core.remark import Message

_MOVED = {
    ("contaminant.boundary", "friction"): "cof_bl tau_hydro cof_asymptote alpha beta load pair",
    ("interface", "friction"): "constant_cof=cof hysteresis_cof dry_adhesion_cof fine_roughness "
    "friction_table=table_file friction_readings=readings friction_source=readings_source "
    "shear_strength",
    ("shoe.heel", "shoe.heel.profile"): "facet_angle=angle facet_length=length "
    "rocker_radius=radius rocker_start=start",
    ("shoe.sole", "shoe.sole.midsole"): "midsole_modulus=modulus midsole_thickness=thickness "
    "midsole_poisson_ratio=poisson_ratio",
    ("sensor", "sensor.array"): "rows columns array_spacing=spacing array_position=position "
    "array_inlet_diameter=inlet_diameter",
}
RENAMED = {
    "models.friction": "friction.model",
    "models.asperity": "rough_contact.model",
    "models.compliance": "compliance.model",
    "models.hardness": "hardness.model",
    **{
        f"{old}.{key.partition('=')[0]}": f"{new}.{key.rpartition('=')[2]}"
        for (old, new), moved in _MOVED.items()
        for key in moved.split()
    },
}
"""Path in a file of version 1: path in version 2."""
SHORT = {"shoe.heel.profile": "shoe.heel.profile.model"}
"""Slots whose option version 1 named by the path of the slot itself."""
GONE = ("models", "contaminant.boundary")
"""Sections of version 1 that hold nothing in version 2."""


def current_path(path: str) -> str:
    """Return the path of version 2 for a path of either version."""
    return RENAMED.get(path, path)


def current_settings(settings: Mapping[str, Any]) -> dict[str, Any]:
    """Return settings by dotted path with the paths of version 2."""
    changed: dict[str, Any] = {}
    for path, value in settings.items():
        below = {old: new for old, new in RENAMED.items() if old.startswith(f"{path}.")}
        if isinstance(value, Mapping) and below and "value" not in value:
            rest = {key: item for key, item in value.items() if f"{path}.{key}" not in below}
            changed |= {below[f"{path}.{k}"]: item for k, item in value.items() if k not in rest}
            if rest and path not in GONE:
                changed[path] = rest
        elif path in SHORT and not isinstance(value, Mapping):
            changed[SHORT[path]] = value
        else:
            changed[current_path(path)] = value
    return changed


def upgrade(mapping: Mapping[str, Any]) -> list[tuple[str, str, Any]]:
    """Return what moves in the mapping of a case file: old path, new path, value with its marks."""
    return list(_moves(mapping, "", {}))


def _moves(
    table: Mapping[str, Any], prefix: str, inherited: Mapping[str, Any]
) -> Iterator[tuple[str, str, Any]]:
    marks = {**inherited, **{key: table[key] for key in INHERITED if key in table and prefix}}
    for key, item in table.items():
        path = f"{prefix}{key}"
        leaf = not isinstance(item, Mapping) or "value" in item
        if path in RENAMED or (leaf and path in SHORT):
            new = RENAMED.get(path) or SHORT[path]
            yield path, new, _with_marks(item, marks)
        elif not leaf:
            yield from _moves(item, f"{path}.", marks)


def _with_marks(item: Any, marks: Mapping[str, Any]) -> Any:
    if not marks:
        return item
    return {**marks, **(item if isinstance(item, Mapping) else {"value": item})}


def sentence(old: str, new: str) -> str:
    """Return what happened to one path, for a reader."""
    return Message("{old} is {new} in case files of version 2", old=old, new=new)
