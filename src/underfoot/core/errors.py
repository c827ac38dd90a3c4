"""The error family: where, what, what is allowed, the nearest match, the remedy."""

import difflib
import errno
from collections.abc import Iterable, Sequence
from pathlib import Path

from .remark import Message, together


class UnderfootError(Exception):
    """Base of all errors a user can meet.

    ``what`` names the offending value, ``where`` its dotted path, file, line or argument,
    ``allowed`` what would have been accepted, ``nearest`` the closest accepted value and
    ``remedy`` what to do next.
    """

    exit_code = 1

    def __init__(
        self,
        what: str,
        *,
        where: str | None = None,
        allowed: str | None = None,
        nearest: str | None = None,
        remedy: str | None = None,
    ) -> None:
        super().__init__(what)
        self.what = what
        self.where = where
        self.allowed = allowed
        self.nearest = nearest
        self.remedy = remedy

    @property
    def parts(self) -> dict[str, str | None]:
        """All but ``what`` and ``where``, by name."""
        return {name: getattr(self, name) for name in ("allowed", "nearest", "remedy")}

    @property
    def sentences(self) -> dict[str, Message]:
        """The sentences that it says, by what each is: where and what, allowed, nearest, remedy."""
        what = Message("{what}", what=self.what)
        if self.where:
            what = Message("{where}: {what}", where=self.where, what=self.what)
        named = {
            "what": what,
            "allowed": Message("Allowed: {allowed}", allowed=self.allowed),
            "nearest": Message('Did you mean "{nearest}"?', nearest=self.nearest),
            "remedy": Message("{remedy}", remedy=self.remedy),
        }
        return {name: named[name] for name in named if name == "what" or self.parts[name]}

    @property
    def message(self) -> Message:
        """All that it says, which knows what it was made of."""
        return together(map(_sentence, self.sentences.values()))

    def __str__(self) -> str:
        return str(self.message)


class InputError(UnderfootError):
    """A value, key, name or unit that can't be accepted."""

    exit_code = 2


class RangeError(InputError):
    """A value outside the physical range or outside the range a closure was tested on."""


class DataError(UnderfootError):
    """A measurement or geometry file that can't be read or can't be analysed."""

    exit_code = 3


class ConvergenceError(UnderfootError):
    """An iteration that did not reach its tolerance; carries the residual history."""

    exit_code = 4

    def __init__(self, what: str, *, history: Sequence[float] = (), **parts: str | None) -> None:
        super().__init__(what, **parts)
        self.history = tuple(float(value) for value in history)


class MissingExtraError(UnderfootError):
    """A feature that needs an optional package which is not installed."""

    exit_code = 5

    def __init__(self, package: str, extra: str, purpose: str) -> None:
        super().__init__(
            Message(
                "{purpose} needs the package {package}, which is not installed",
                purpose=purpose,
                package=package,
            ),
            remedy=Message('Install it with: pip install "underfoot[{extra}]"', extra=extra),
        )


class Cancelled(UnderfootError):
    """The user stopped the work."""

    exit_code = 130


def error_text(error: BaseException) -> str:
    """Return what went wrong in words for people; of an error of the program itself its type."""
    if isinstance(error, UnderfootError):
        return error.message
    if isinstance(error, OSError):
        return file_trouble(error)
    if isinstance(error, MemoryError):
        return "not enough memory. Choose a coarser numerics.grid_spacing."
    return Message(
        "internal error: {name}: {error}\nPlease report it with the case file",
        name=type(error).__name__,
        error=str(error),
    )


def file_trouble(error: OSError) -> str:
    """Return what went wrong with a file, with its name."""
    name = str(error.filename or "the file")
    refused = Message("no permission to use {name}", name=name)
    texts = {
        errno.ENOENT: Message("{name} does not exist", name=name),
        errno.EISDIR: Message("{name} is a folder; a file is needed", name=name),
        errno.ENOTDIR: Message("a part of {name} is a file, not a folder", name=name),
        errno.EACCES: refused,
        errno.EPERM: refused,
        errno.EROFS: Message("{name} can't be written: the disk is read-only", name=name),
        errno.ENOSPC: Message("no space left on the disk for {name}", name=name),
        errno.EEXIST: Message("{name} exists already", name=name),
        errno.ENAMETOOLONG: Message("the name {name} is too long", name=name),
    }
    if text := texts.get(error.errno or 0):
        return _sentence(text)
    return f"{error.strerror or error}: {error.filename or ''}".rstrip(": ") + "."


def missing_file(
    path: Path, pattern: str = "*", *, where: str | None = None, remedy: str | None = None
) -> InputError:
    """Return the error of a file that is not there: the nearest of ``pattern`` in its folder."""
    near = [other.name for other in path.parent.glob(pattern)] if path.parent.is_dir() else []
    return InputError(
        Message("there is no file {path}", path=path),
        where=where,
        nearest=nearest_match(path.name, near),
        remedy=remedy,
    )


def nearest_match(given: str, known: Iterable[str], *, least: float = 0.5) -> str | None:
    """Return the known name closest to ``given``, or None when nothing is close.

    ``least`` (0 to 1) is the share of letters that both must have in one order.

    >>> nearest_match("coff", ["cof", "fluid_load"])
    'cof'
    """
    names = list(known)
    folded = {name.casefold(): name for name in names}
    matches = difflib.get_close_matches(given.casefold(), folded, n=1, cutoff=least)
    return folded[matches[0]] if matches else None


def first_names(names: Iterable[str], most: int = 12) -> Message:
    """Return the first of some names, and how many more there are; empty where there are none."""
    every = list(names)
    if (more := len(every) - most) > 0:
        return Message("{names} and {more} more", names=every[:most], more=more)
    return Message("{names}", names=every)


def unknown_name(
    kind: str, given: str, known: Iterable[str], *, where: str | None = None
) -> InputError:
    """Return the error for a name that is not in a list, with the list and the nearest match."""
    names = sorted(known)
    return InputError(
        Message('unknown {kind} "{given}"', kind=kind, given=given),
        where=where,
        allowed=first_names(names) or "none defined",
        nearest=nearest_match(given, names),
    )


def _sentence(text: Message) -> Message:
    return text if text.rstrip().endswith((".", "?", "!")) else Message("{text}.", text=text)
