"""The outsole file of a case: found beside it, known by its checksum."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from underfoot.core import InputError

from .beside import existing_file
from .places import Places

_REPLACED = ("heel", "tread")


def with_checksum(mapping: Mapping[str, Any], folder: Path, places: Places) -> Mapping[str, Any]:
    """Return a case's mapping with the full path and the checksum of ``shoe.outsole.file``.

    The file is looked for from ``folder``, that of the case file. The checksum becomes part of the
    case, the path does not count in its hash.

    Errors
    ------
    InputError
        No such file, a checksum that differs, or heel and tread given beside it.
    """
    shoe = mapping.get("shoe")
    outsole = shoe.get("outsole") if isinstance(shoe, Mapping) else None
    name = _plain(outsole.get("file")) if isinstance(outsole, Mapping) else None
    if not isinstance(name, str):
        return mapping
    assert isinstance(shoe, Mapping)
    assert isinstance(outsole, Mapping)
    where = places("shoe.outsole.file")
    for part in _REPLACED:
        if part in shoe:
            raise InputError(
                f"is not used: the outsole comes from {name}",
                where=places(f"shoe.{part}"),
                remedy=f"Remove [shoe.{part}], or shoe.outsole.file",
            )
    path = (folder / name).resolve()
    found = _checksum(path, where)
    meant = _plain(outsole.get("sha256"))
    if isinstance(meant, str) and meant.lower() != found:
        raise InputError(
            f"{path.name} is not the file that the case means: its checksum is {found[:12]}..., "
            f"not {meant[:12]}...",
            where=where,
            remedy="Bring back that file, or remove sha256 to take this one",
        )
    changed = {**shoe, "outsole": {**outsole, "file": str(path), "sha256": found}}
    if "from" not in shoe:
        changed["tread"] = {"pattern": "none"}  # a section that every other case must give
    return {**mapping, "shoe": changed}


def _plain(given: Any) -> Any:
    return given.get("value") if isinstance(given, Mapping) else given


def _checksum(path: Path, where: str) -> str:
    from underfoot.outsole.files.checksum import checksum

    existing_file(path, where)
    try:
        return checksum(path)
    except OSError as error:
        raise InputError(f"{path} can't be read ({error.strerror})", where=where) from error
