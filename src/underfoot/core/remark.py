"""A line of a result that knows what it is about: nobody reads that back out of its text."""

from __future__ import annotations

from collections.abc import Iterable

ASSUMED = "Assumed"
"""What a line is about that tells a guess: what nobody stated."""


class Remark(str):
    """A line "about: what" of breaches or assumptions; it prints, compares and is stored as text.

    Parameters:
        about: Section of the case ("shoe.heel") or name of the model ("pair") that it is about; ""
            for a line about the whole.
        what: What is to be said of it.

    >>> remark = Remark("shoe.heel", "length = 60 mm")
    >>> remark, remark.about
    ('shoe.heel: length = 60 mm', 'shoe.heel')
    """

    __slots__ = ("about", "what")
    about: str
    what: str

    def __new__(cls, about: str, what: str) -> Remark:
        """Return the line."""
        line = super().__new__(cls, f"{about}: {what}" if about else what)
        line.about, line.what = about, what
        return line

    def __reduce__(self) -> tuple[type[Remark], tuple[str, str]]:
        """Return what makes an equal line, for copies and other processes."""
        return Remark, (self.about, self.what)

    @classmethod
    def stored(cls, line: str) -> Remark:
        """Return the remark that a file of results holds as one line of text."""
        about, colon, what = line.partition(": ")
        return cls(about, what) if colon else cls("", line)


def assumed(what: str) -> Remark:
    """Return the line that tells a guess."""
    return Remark(ASSUMED, what)


def is_assumed(line: str) -> bool:
    """Return whether a line tells a guess."""
    return isinstance(line, Remark) and line.about == ASSUMED


def remarks(lines: Iterable[object]) -> tuple[Remark, ...]:
    """Return lines as remarks, each once; plain text is about the whole."""
    made = (line if isinstance(line, Remark) else Remark("", str(line)) for line in lines)
    return tuple(dict.fromkeys(made))


def subjects(lines: Iterable[Remark]) -> tuple[str, ...]:
    """Return what remarks are about, each once; the line itself where it is about the whole."""
    return tuple(dict.fromkeys(line.about or line for line in lines))
