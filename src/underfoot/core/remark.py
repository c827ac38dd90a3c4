"""Sentences made of a template and values: both travel, and text is made once a language.

Nobody reads out of a text what it is about, which sentence it is, or its numbers: they stand in
fields beside it.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from html import escape
from string import Formatter
from typing import Any, Self

MARK = "data-message"
"""Attribute of an element of a page that holds ``page_data`` of its text, as JSON."""
ASSUMED = "Assumed"
"""What a line is about that tells a guess: what nobody stated."""
HERE = "here"
"""Field of a message for what it tells of one case alone: a line of several leaves it out."""


@dataclass(frozen=True, slots=True)
class Amount:
    """A value (SI) with its unit, in a sentence: it is written in a unit that people read.

    >>> f"{Amount(0.06, 'm')}"
    '60 mm'
    """

    value: float
    unit: str = "1"
    digits: int = 3

    def __format__(self, spec: str) -> str:
        from .unit_text import display

        return display(self.value, self.unit, self.digits)


class Message(str):
    """A sentence that knows what it was made of; it prints, compares and hashes as English text.

    Parameters:
        code: The sentence in English with named fields, by which other languages know it. A field
            formats as in ``str.format``; besides, ``{count:step|steps}`` is the first where the
            count is 1, ``{part:capital}`` begins a sentence, ``{part:small}`` does not, and several
            values are joined by what stands behind the colon, else by a comma.
        values: What the fields hold: numbers, amounts, names, other messages, or several of them.

    Raises:
        KeyError: A field without a value.

    >>> message = Message("{count} {count:step|steps} in {time}", count=2, time=Amount(0.6, "s"))
    >>> message, message.values["count"]
    ('2 steps in 600 ms', 2)
    """

    __slots__ = ("code", "values")
    code: str
    values: Mapping[str, Any]

    def __new__(cls, code: str, /, **values: Any) -> Self:
        """Return the sentence."""
        plain = {name: _plain(value) for name, value in values.items()}
        line = super().__new__(cls, _FIELDS.vformat(code, (), plain))
        line.code, line.values = code, plain
        return line

    def __reduce__(self) -> tuple[Any, ...]:
        """Return what makes an equal one, its text as it is: for copies and other processes."""
        return _copy_message, (type(self), str(self), self._parts())

    def _parts(self) -> dict[str, Any]:
        return {"code": self.code, "values": self.values}

    @classmethod
    def plain(cls, text: str) -> Message:
        """Return a text that nobody made of values, as a message of itself."""
        return text if isinstance(text, Message) else Message("{text}", text=text)

    @property
    def subject(self) -> str:
        """What the line is about; the line itself where it is about the whole."""
        return self._parts().get("about") or self

    def page_data(self) -> dict[str, Any]:
        """Return template and formatted values, which a page puts into its language."""
        specs = _specs(self.code)
        values = {name: _of_page(self.values[name], spec) for name, spec in specs.items()}
        return {"code": self.code, "values": values}

    def page_mark(self) -> str:
        """Return ``page_data`` as JSON, for the attribute ``MARK`` of an element."""
        return json.dumps(self.page_data(), ensure_ascii=False)

    def __html__(self) -> str:
        """Return the text as an element that a page can put into its language."""
        return f'<span {MARK}="{escape(self.page_mark())}">{escape(self)}</span>'


class Remark(Message):
    """A line "about: what" of breaches or assumptions.

    Parameters:
        about: Section of the case ("shoe.heel") or name of the model ("pair") that it is about; ""
            for a line about the whole.
        code: Template of what is to be said of it, as of a ``Message``.
        values: What the fields of the template hold.

    >>> remark = Remark("shoe.heel", "length = {length}", length=Amount(0.06, "m"))
    >>> remark, remark.about
    ('shoe.heel: length = 60 mm', 'shoe.heel')
    """

    __slots__ = ("about",)
    about: str

    def __new__(cls, about: str, code: str, /, **values: Any) -> Self:
        """Return the line."""
        what = Message(code, **values)
        line = str.__new__(cls, f"{about}: {what}" if about else what)
        line.about, line.code, line.values = about, what.code, what.values
        return line

    def _parts(self) -> dict[str, Any]:
        return {"about": self.about, **super()._parts()}

    @property
    def what(self) -> Message:
        """What is to be said of it."""
        return Message(self.code, **self.values)

    def page_data(self) -> dict[str, Any]:
        """Return what it is about, template and formatted values."""
        return {"about": self.about, **super().page_data()}

    @classmethod
    def of(cls, about: str, message: str) -> Self:
        """Return a message, or a plain text, as a line about something."""
        whole = Message.plain(message)
        if isinstance(whole, Remark) and whole.about:
            return cls(about, "{text}", text=whole)
        return cls(about, whole.code, **whole.values)

    @classmethod
    def from_stored(cls, line: Any) -> Self:
        """Return the remark that a file of results holds: ``stored_form``, or an old line of text.

        Its text is made anew, in the units of who asks.
        """
        if not isinstance(line, str):
            return cls.of(line.get("about", ""), from_stored({**line, "about": ""}))
        about, colon, what = line.partition(": ")
        return cls.of(about, what) if colon else cls.of("", line)


def join_lines(lines: Iterable[object]) -> Message:
    """Return several lines as one, "a; b"; each keeps what it was made of."""
    texts = [line if isinstance(line, str) else str(line) for line in lines]
    return Message("{texts:; }", texts=texts)


def together(sentences: Iterable[str]) -> Message:
    """Return sentences one after the other; each keeps what it was made of."""
    return Message("{sentences: }", sentences=sentences)


def kind_of(line: Any) -> Any:
    """Return what a line shares with others that differ from it in numbers alone."""
    if isinstance(line, tuple):
        return tuple(map(kind_of, line))
    if not isinstance(line, Message):
        return line if isinstance(line, str) else None
    values = {name: kind_of(value) for name, value in line.values.items() if name != HERE}
    return line.code, *values.items()


def of_several(lines: Sequence[Message]) -> Message:
    """Return one line for several of one kind: "3 ms" and "9 ms" give "3 to 9 ms"."""
    first = Message.plain(lines[0])
    if first is not lines[0]:
        return first
    values = {
        name: "" if name == HERE else _span([line.values[name] for line in lines], spec)
        for name, spec in _specs(first.code).items()
    }
    return Message(first.code, **values)


def _span(values: Sequence[Any], spec: str) -> Any:
    first = values[0]
    if isinstance(first, Message):
        return of_several(values)
    if not isinstance(first, int | float):
        return first
    low, high = (format(end, spec) for end in (min(values), max(values)))
    return first if low == high else Message("{low} to {high}", low=low, high=high)


def assumption_line(code: str, /, **values: Any) -> Remark:
    """Return the line that tells a guess, of a template and its values."""
    return Remark(ASSUMED, code, **values)


def is_assumed(line: str) -> bool:
    """Return whether a line tells a guess."""
    return isinstance(line, Remark) and line.about == ASSUMED


def remarks(lines: Iterable[object]) -> tuple[Remark, ...]:
    """Return lines as remarks, each once; what says nothing of it is about the whole."""
    made = (
        line
        if isinstance(line, Remark)
        else Remark.of("", line if isinstance(line, str) else str(line))
        for line in lines
    )
    return tuple(dict.fromkeys(made))


def subjects(lines: Iterable[Message]) -> tuple[str, ...]:
    """Return what lines are about, each once; the line itself where it is about the whole."""
    return tuple(dict.fromkeys(line.subject for line in lines))


def stored_form(value: Any) -> Any:
    """Return data for JSON: a message is {about, code, values, text}, text for other readers."""
    if isinstance(value, Message):
        return {**stored_form(value._parts()), "text": str(value)}
    if isinstance(value, Amount):
        return {"value": value.value, "unit": value.unit, "digits": value.digits}
    if isinstance(value, Mapping):
        return {name: stored_form(each) for name, each in value.items()}
    if not isinstance(value, list | tuple) or _is_series(value):
        return value
    return [*map(stored_form, value)]


def from_stored(value: Any) -> Any:
    """Return what ``stored_form`` made data of; texts are made anew, in the units of who asks."""
    if isinstance(value, list):
        return value if _is_series(value) else [*map(from_stored, value)]
    if not isinstance(value, Mapping):
        return value
    parts = {name: from_stored(each) for name, each in value.items()}
    if parts.keys() == {"value", "unit", "digits"}:
        return Amount(**parts)
    if not {"code", "values", "text"} <= parts.keys():
        return parts
    about = parts.get("about", "")
    return (Remark(about, parts["code"], **parts["values"]) if about else
            Message(parts["code"], **parts["values"]))  # fmt: skip


def _is_series(value: list[Any] | tuple[Any, ...]) -> bool:
    """Whether a list is one of numbers, as of a curve: it holds no messages."""
    return bool(value) and isinstance(value[0], float)


class _Fields(Formatter):
    def format_field(self, value: Any, format_spec: str) -> str:
        if isinstance(value, str):
            first = {"capital": value[:1].upper(), "small": value[:1].lower()}
            return first.get(format_spec, value[:1]) + value[1:]
        if isinstance(value, Iterable):
            return (format_spec or ", ").join(map(str, value))
        one, plural, many = format_spec.partition("|")
        return (one if value == 1 else many) if plural else format(value, format_spec)


_FIELDS = _Fields()


@cache
def _specs(code: str) -> Mapping[str, str]:
    """Return how each field of a template is formatted; that of a plural has no format."""
    specs: dict[str, str] = {}
    for _, name, spec, _ in Formatter().parse(code):
        if name and ("|" in specs.setdefault(name, spec or "")):
            specs[name] = spec or ""
    return specs


def _plain(value: Any) -> Any:
    """Return a value as JSON can hold it: no number of numpy, no generator."""
    if isinstance(value, str | Amount):
        return value
    if isinstance(message := getattr(value, "message", None), Message):  # of an error
        return message
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, Iterable):
        return tuple(map(_plain, value))
    return value if isinstance(value, int | float | None) else str(value)


def _of_page(value: Any, spec: str) -> Any:
    if isinstance(value, Message):
        return value.page_data()
    if isinstance(value, tuple):
        return [_of_page(each, "") for each in value]
    return _FIELDS.format_field(value, "" if "|" in spec or isinstance(value, str) else spec)


def _copy_message(kind: type[Message], text: str, parts: Mapping[str, Any]) -> Message:
    line = str.__new__(kind, text)
    for name, value in parts.items():
        setattr(line, name, value)
    return line


NOTHING = Message("")
"""A line that says nothing."""
