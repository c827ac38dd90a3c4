"""Output that is either whole or absent."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from .errors import InputError

MARKER = ".underfoot"
"""File that says a folder may be replaced."""
_OWN = (MARKER, "result.json", ".files", "restart.npz")


@contextmanager
def whole_folder(path: Path, *, overwrite: bool = False) -> Iterator[Path]:
    """Yield a temporary folder that becomes ``path`` only when the block ends well.

    An existing, non-empty ``path`` is refused unless ``overwrite``; then it is replaced as a
    whole, and kept as it was if the block fails.
    """
    path = Path(path).resolve()
    check_writable_folder(path, overwrite=overwrite)
    path.parent.mkdir(parents=True, exist_ok=True)
    staging = Path(tempfile.mkdtemp(prefix=f".{path.name}-", dir=path.parent))
    staging.chmod(0o755)
    try:
        yield staging
        (staging / MARKER).write_text("made by underfoot; --overwrite may replace this folder\n")
        if path.exists():
            aside = staging.with_name(staging.name + "-old")
            path.rename(aside)
            try:
                staging.rename(path)
            except BaseException:
                aside.rename(path)
                raise
            shutil.rmtree(aside)
        else:
            staging.rename(path)
    except BaseException:
        shutil.rmtree(staging, ignore_errors=True)
        raise


def check_writable_folder(path: Path, *, overwrite: bool = False) -> None:
    """Refuse an output folder that holds something or can't be made, before any work is done."""
    if path.is_file():
        raise InputError(f"{path} is a file", where="--out", allowed="a folder to be made")
    if path.is_dir() and any(path.iterdir()) and not overwrite:
        raise InputError(
            f"the folder {path} exists and is not empty",
            where="--out",
            remedy="Choose another folder, or add --overwrite to replace it as a whole",
        )
    if path.is_dir() and any(path.iterdir()) and not any((path / own).exists() for own in _OWN):
        names = sorted(entry.name for entry in path.iterdir())
        raise InputError(
            f"the folder {path} was not made by underfoot and holds {', '.join(names[:3])}"
            + (" and more" if len(names) > 3 else ""),
            where="--out",
            allowed="with --overwrite: a folder of earlier results",
            remedy="Choose another folder, or empty this one yourself",
        )
    _check_place(path.resolve())


def _check_place(path: Path) -> None:
    """Refuse a folder beside which nothing can be written."""
    place = path.parent
    while not place.exists():
        place = place.parent
    try:
        with tempfile.TemporaryDirectory(prefix=".underfoot-", dir=place):
            pass
    except OSError as error:
        reason = "it is a file" if place.is_file() else (error.strerror or str(error)).lower()
        raise InputError(
            f"{path} can't be made: nothing can be written in {place} ({reason})",
            where="--out",
            remedy="Choose another folder",
        ) from error
