"""Output that is either whole or absent."""

import hashlib
import shutil
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any
from uuid import uuid4

from .errors import InputError, first_names, missing_file
from .remark import Message
from .typed import float_of_text

MARKER = ".underfoot"
"""File that says a folder may be replaced."""
_OWN = (MARKER, "result.json", ".files", "restart.npz")
# Waits for the end of its parent, then removes what that had no time to remove.
_GUARD = """
import os, shutil, sys
sys.stdin.buffer.read()
staging, path = sys.argv[1:]
aside = staging + "-old"
if os.path.isdir(aside) and not os.path.exists(path):
    os.rename(aside, path)
for folder in (staging, aside):
    shutil.rmtree(folder, ignore_errors=True)
"""


@contextmanager
def whole_folder(path: Path, *, overwrite: bool = False) -> Iterator[Path]:
    """Yield a temporary folder that becomes ``path`` only when the block ends well.

    An existing, non-empty ``path`` is refused unless ``overwrite``; then it is replaced as a
    whole, and kept as it was if the block fails. Where this process is killed, a small process of
    its own removes the temporary folder.
    """
    path = Path(path).resolve()
    check_writable_folder(path, overwrite=overwrite)
    path.parent.mkdir(parents=True, exist_ok=True)
    staging = Path(tempfile.mkdtemp(prefix=f".{path.name}-", dir=path.parent))
    staging.chmod(0o755)
    guard = _guard(staging, path)
    try:
        # first: a disk that fills up later must not cost the files that fit
        (staging / MARKER).write_text("made by underfoot; --overwrite may replace this folder\n")
        yield staging
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
    finally:
        if guard is not None:
            guard.kill()
            guard.communicate()


@contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """Yield a path beside ``path`` whose file takes its place when the block ends well."""
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(f".{path.name}-{uuid4().hex}")
    try:
        yield part
        part.replace(path)
    except OSError as error:
        if error.errno is None or error.filename not in (None, part, str(part)):
            raise  # of another file
        raise named_for(error, path) from error
    finally:
        with suppress(OSError):  # a disk that can only be read refuses even what is not there
            part.unlink(missing_ok=True)


def named_for(error: OSError, path: Path) -> OSError:
    """Return an error of a part of a file with the name of the whole: people know no other."""
    named = type(error)(error.errno, error.strerror)
    named.filename = str(path)
    return named


def _guard(staging: Path, path: Path) -> subprocess.Popen[bytes] | None:
    """Start the process that removes ``staging`` when this one ends without having done so."""
    if getattr(sys, "frozen", False):
        return None  # there is no interpreter to start
    try:
        return subprocess.Popen(
            [sys.executable, "-I", "-S", "-c", _GUARD, str(staging), str(path)],
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,  # a signal to the group of this process leaves it alone
        )
    except OSError:
        return None


def check_writable_folder(path: Path, *, overwrite: bool = False) -> None:
    """Refuse an output folder that holds something or can't be made, before any work is done."""
    if path.is_file():
        raise InputError(
            Message("{path} is a file", path=path), where="--out", allowed="a folder to be made"
        )
    if path.is_dir() and any(path.iterdir()) and not overwrite:
        raise InputError(
            Message("the folder {path} exists and is not empty", path=path),
            where="--out",
            remedy="Choose another folder, or add --overwrite to replace it as a whole",
        )
    if path.is_dir() and any(path.iterdir()) and not any((path / mark).exists() for mark in _OWN):
        held = first_names(sorted(entry.name for entry in path.iterdir()), most=3)
        raise InputError(
            Message(
                "the folder {path} was not made by underfoot and holds {held}", path=path, held=held
            ),
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
            Message(
                "{path} can't be made: nothing can be written in {place} ({reason})",
                path=path,
                place=place,
                reason=reason,
            ),
            where="--out",
            remedy="Choose another folder",
        ) from error


def checksum(path: Path | str) -> str:
    """Return the SHA-256 of a file as 64 hexadecimal digits."""
    with Path(path).open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()


def read_toml(path: Path) -> dict[str, Any]:
    """Return the content of a TOML file; InputError where it is none, or not there.

    A byte-order mark, as some editors write it, is no part of the text.
    """
    try:
        return tomllib.loads(path.read_text(encoding="utf-8-sig"), parse_float=float_of_text)
    except FileNotFoundError as error:
        raise missing_file(path, "*.toml") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise InputError(
            Message("is no TOML file ({error})", error=error), where=str(path)
        ) from error
