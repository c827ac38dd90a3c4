"""Case files of version 1: their paths in version 2."""

from collections.abc import Iterator, Mapping
from typing import Any

from underfoot.core.leaves import INHERITED

RENAMED = {
    "models.friction": "friction.model",
    "models.asperity": "rough_contact.model",
    "models.compliance": "compliance.model",
    "models.hardness": "hardness.model",
    "interface.constant_cof": "friction.cof",
    "interface.hysteresis_cof": "friction.hysteresis_cof",
    "interface.dry_adhesion_cof": "friction.dry_adhesion_cof",
    "interface.fine_roughness": "friction.fine_roughness",
    "interface.friction_table": "friction.table_file",
    "interface.friction_readings": "friction.readings",
    "interface.friction_source": "friction.readings_source",
    "interface.shear_strength": "friction.shear_strength",
    "contaminant.boundary.cof_bl": "friction.cof_bl",
    "contaminant.boundary.tau_hydro": "friction.tau_hydro",
    "contaminant.boundary.cof_asymptote": "friction.cof_asymptote",
    "contaminant.boundary.alpha": "friction.alpha",
    "contaminant.boundary.beta": "friction.beta",
    "contaminant.boundary.load": "friction.load",
    "contaminant.boundary.pair": "friction.pair",
    "shoe.heel.facet_angle": "shoe.heel.profile.angle",
    "shoe.heel.facet_length": "shoe.heel.profile.length",
    "shoe.heel.rocker_radius": "shoe.heel.profile.radius",
    "shoe.heel.rocker_start": "shoe.heel.profile.start",
    "shoe.sole.midsole_modulus": "shoe.sole.midsole.modulus",
    "shoe.sole.midsole_thickness": "shoe.sole.midsole.thickness",
    "shoe.sole.midsole_poisson_ratio": "shoe.sole.midsole.poisson_ratio",
    "sensor.rows": "sensor.array.rows",
    "sensor.columns": "sensor.array.columns",
    "sensor.array_spacing": "sensor.array.spacing",
    "sensor.array_inlet_diameter": "sensor.array.inlet_diameter",
    "sensor.array_position": "sensor.array.position",
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
            for key, item in value.items():
                if f"{path}.{key}" in below:
                    changed[below[f"{path}.{key}"]] = item
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
            yield path, new, _marked(item, marks)
        elif not leaf:
            yield from _moves(item, f"{path}.", marks)


def _marked(item: Any, marks: Mapping[str, Any]) -> Any:
    if not marks:
        return item
    return {**marks, **(item if isinstance(item, Mapping) else {"value": item})}


def sentence(old: str, new: str) -> str:
    """Return what happened to one path, for a reader."""
    return f"{old} is {new} in case files of version 2"
