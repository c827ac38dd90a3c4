"""Files that a case names: they lie beside the case file."""

from __future__ import annotations

from pathlib import Path

from underfoot.core import InputError, nearest_match


def existing_file(path: Path, where: str, pattern: str = "*") -> Path:
    """Return ``path``; an error names the nearest file of ``pattern`` in its folder."""
    if path.is_file():
        return path
    near = [one.name for one in path.parent.glob(pattern)] if path.parent.is_dir() else []
    raise InputError(
        f"there is no file {path}",
        where=where,
        nearest=nearest_match(path.name, near),
        remedy="The path counts from the folder of the case file",
    )
