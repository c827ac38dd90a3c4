"""The table of file formats: how each is recognised, and what reads it.

A reader is one function and one entry. The core reads C3D and plain tables; all other formats
enter by the registry, those of the wing ``underfoot_readers`` as a whole (``trial_formats``), those
of others one by one (``trial_readers``, ``docs/extending.md``).
"""

import re
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass
from difflib import get_close_matches
from functools import lru_cache
from importlib import import_module
from pathlib import Path
from typing import Any

from underfoot.core import DataError, InputError
from underfoot.core.registry import offered, offers
from underfoot.core.text import utf16_of


@dataclass(frozen=True, slots=True)
class TrialReader:
    """One format of files.

    ``address``: the reader as "package.module:function"; it takes a ``Draft`` and returns a
    ``Trial`` or several, and is imported when a file of the format is read. Empty for a format
    that is known and not read; ``remedy`` then says what to do. ``marks``: regular expressions, one
    of which the first 4096 characters hold (casefolded, ``^`` at each line, ``\\A`` at the file).
    ``magic``: first bytes of a binary file. ``suffixes``: endings of names, which decide where no
    mark does.
    """

    name: str
    address: str
    marks: tuple[str, ...] = ()
    magic: tuple[bytes, ...] = ()
    suffixes: tuple[str, ...] = ()
    remedy: str = ""

    def recognises(self, data: bytes, text: str) -> bool:
        """True when the first bytes, or the first characters (casefolded), are of this format."""
        return data.startswith(self.magic or (b"\xff\xff\xff\xff none",)) or any(
            re.search(mark, text, re.MULTILINE) for mark in self.marks
        )

    def function(self, draft: Any) -> Any:
        """Return what the reader makes of a draft; a DataError for a format that is not read."""
        if not self.address:
            raise DataError(f"{self.name} is not read", remedy=self.remedy)
        module, _, name = self.address.partition(":")
        return getattr(import_module(module), name)(draft)


_DOOR, _HERE = "trial_formats", "underfoot.trials.readers."
C3D = TrialReader("C3D", _HERE + "c3d:read_c3d", suffixes=(".c3d",))
TABLE = TrialReader(
    "table", _HERE + "columns:read_columns", magic=(b"PK\x03\x04", b"\xd0\xcf\x11\xe0"),
    suffixes=(".txt", ".csv", ".tsv", ".dat", ".xlsx", ".xls", ".asc"),
)  # fmt: skip


@lru_cache(maxsize=1)
def trial_readers() -> tuple[TrialReader, ...]:
    """Return the readers of the packages that are here and can be loaded."""
    found: list[TrialReader] = []
    for name in offers(_DOOR):
        with suppress(InputError):  # told by underfoot doctor; files of other formats are read
            found += offered(_DOOR, name)
    return tuple(found)


def missing_readers() -> str:
    """Return what to do where the wing of readers is not here, "" where it is."""
    try:
        offered(_DOOR, "readers")
    except InputError as error:
        return f"For formats of other makers: {error.remedy}"
    return ""


def trial_suffixes() -> tuple[str, ...]:
    """Return the endings of names by which a folder's trial files are found."""
    every = (C3D, *trial_readers(), TABLE)
    return tuple(dict.fromkeys(suffix for one in every for suffix in one.suffixes))


def file_format(data: bytes, path: Path) -> TrialReader:
    """Return the format of a file from its first bytes; the name's ending only breaks ties."""
    head, suffix = data[:4096], path.suffix.casefold()
    # "P" as second letter happens in text too: a C3D header holds binary zeros.
    signed = len(data) > 1 and data[1] == 0x50 and 0 < data[0] < 128
    wide = utf16_of(data)
    if suffix == ".c3d" or (signed and b"\0" in head and not wide):
        return C3D
    if data.startswith(TABLE.magic):
        return TABLE
    text = head[: len(head) // 2 * 2].decode(wide or "latin-1", "replace")
    text = text.lstrip("\ufeffï»¿").casefold().replace("\r", "\n")
    readers = trial_readers()
    found = next((one for one in readers if one.recognises(data, text)), None)
    return found or next((one for one in readers if suffix in one.suffixes), TABLE)


def nearest_format(header: Iterable[str]) -> str | None:
    """Return the format whose marks come nearest to words of a file's first lines, or None."""
    words = {
        word: one.name
        for one in trial_readers()
        for mark in one.marks
        for word in re.findall(r"[a-z_]{6,}", mark)
    }
    lines = [line.casefold() for line in header]
    parts = (part for line in lines for part in re.split(r"[,;:\t= ]", line) if len(part) > 5)
    found = next((near for part in parts if (near := get_close_matches(part, words, 1, 0.8))), None)
    return words[found[0]] if found else None
