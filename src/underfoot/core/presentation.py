"""How the types that a person holds present themselves: text, notebook table, frame, picture."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from html import escape
from importlib import import_module
from typing import TYPE_CHECKING, Any, ClassVar, Protocol, Self, runtime_checkable

from underfoot.core.remark import Message

from .unit_text import display_unit, number_text, unit_system
from .values import SourcedValue

if TYPE_CHECKING:
    import pandas

BACKEND = "underfoot.report"
"""Module that draws and writes pages. It lies above every room, so it is named, not imported."""
PROBABILITIES = ("slip_probability",)
"""Dimensionless values that people read in percent."""
WIDE = 0.5
"""Width of the interval of a probability from which it is never printed without."""
SKEWED = 0.25
"""Difference of an interval's two sides over its width above which the interval is printed in
place of one standard deviation."""


@runtime_checkable
class SourcedModel(Protocol):
    """A model that a case chooses by name."""

    @property
    def name(self) -> str:
        """Short name for reports."""
        ...

    @property
    def source(self) -> str:
        """Paper and equation, measurement, or the computation that it comes from."""
        ...


@runtime_checkable
class AssumingModel(SourcedModel, Protocol):
    """A model that says what it assumes."""

    @property
    def assumptions(self) -> tuple[Message, ...]:
        """What no measurement stands behind, a line each."""
        ...


class Part(Message):
    """First cell of a row that is a part of the row above it; text shows it two blanks in.

    >>> Part("from adhesion")
    '  from adhesion'
    """

    __slots__ = ()

    def __new__(cls, label: str, /) -> Self:
        """Return the cell of a label."""
        return super().__new__(cls, "  {label}", label=label)

    @property
    def label(self) -> str:
        """What the cell says, without blanks."""
        return self.values["label"]

    def __html__(self) -> str:
        """Return the label as an element; where it stands, the page says by its style."""
        label = self.label
        return label.__html__() if isinstance(label, Message) else escape(label)


@dataclass(frozen=True, slots=True)
class Table:
    """Title, column names and rows of text or numbers; without names where all are empty.

    ``shows`` says what of a picture its rows are ("lug"), in the picture's order; "" for nothing.
    """

    title: str
    columns: tuple[str, ...]
    rows: Sequence[Sequence[Any]]
    shows: str = ""

    def cells(self) -> list[list[str]]:
        """Return every row as text; numbers with four figures."""
        return [[_cell(value) for value in row] for row in self.rows]

    def text(self) -> str:
        """Return the table as aligned plain text."""
        cells = [*([list(self.columns)] if any(self.columns) else []), *self.cells()]
        widths = [max(len(row[i]) for row in cells) for i in range(len(self.columns))]
        lines = ["  ".join(map(str.ljust, row, widths)).rstrip() for row in cells]
        return "\n".join([self.title, *lines])

    def html(self) -> str:
        """Return the table as HTML for a notebook."""
        head = "".join(f"<th>{escape(name)}</th>" for name in self.columns)
        body = "".join(
            "<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row) + "</tr>"
            for row in self.cells()
        )
        return (
            f"<table><caption>{escape(self.title)}</caption>"
            f"<thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
        )

    def frame(self) -> pandas.DataFrame:
        """Return the table as a pandas DataFrame."""
        import pandas

        return pandas.DataFrame([list(row) for row in self.rows], columns=list(self.columns))


class Presentable(ABC):
    """Mixin of a type with one ``table()``: its summary, notebook view, frame, plot and report.

    A subclass keeps a short ``__repr__`` of its own (one line, below 200 characters). Commands,
    pages and notebooks print the same parts: the headline (number, unit, uncertainty), the cautions
    that decide whether the numbers can be used, the tables, and lists of remarks.
    """

    __slots__ = ()
    kind: ClassVar[str] = "object"
    """What the object is, as JSON and file names call it."""

    @abstractmethod
    def table(self) -> Table:
        """Return what the object says of itself, a row a quantity."""

    def heading(self) -> str:
        """Return the name that stands above everything else."""
        return str(getattr(self, "name", type(self).__name__))

    def headline(self) -> tuple[str, ...]:
        """Return the answer in one to three sentences."""
        return ()

    def cautions(self) -> tuple[str, ...]:
        """Return why the headline may not be trusted, if there is a reason."""
        return ()

    def tables(self) -> tuple[Table, ...]:
        """Return every table for people, the main one first."""
        return (self.table(),)

    def remarks(self) -> Mapping[str, Sequence[str]]:
        """Return lists of sentences by title, the most important sentence of each first."""
        return {}

    def to_dict(self) -> dict[str, Any]:
        """Return plain data for JSON: by default the rows of the table, by column."""
        table = self.table()
        rows = [dict(zip(table.columns, row, strict=True)) for row in table.rows]
        return {"kind": self.kind, "name": self.heading(), "rows": rows}

    def data_tables(self) -> Mapping[str, Table]:
        """Return tables in SI for other programs, by name of the CSV file."""
        return {}

    @property
    def usable(self) -> bool:
        """Whether the numbers are a result."""
        return True

    def summary(self) -> str:
        """Return headline, cautions and tables as plain text."""
        parts = [" ".join(self.headline()), *(f"Caution: {text}" for text in self.cautions())]
        return "\n".join([*filter(None, parts), *(table.text() for table in self.tables())])

    def _repr_html_(self) -> str:
        return "".join(table.html() for table in self.tables())

    def to_frame(self) -> pandas.DataFrame:
        """Return the table as a pandas DataFrame."""
        return self.table().frame()

    def plot(self, *args: Any, **options: Any) -> Any:
        """Draw the object; see ``underfoot.report.plot`` for what each type takes."""
        return import_module(BACKEND).plot(self, *args, **options)

    def report(self, folder: Any, **options: Any) -> Any:
        """Write the object's page into ``folder``; see ``underfoot.report.write_report``."""
        return import_module(BACKEND).write_report(self, folder, **options)


def percent(share: float) -> str:
    """Return a share in percent without false digits."""
    value = 100.0 * share
    if 0.0 < value < 0.1:
        return "below 0.1 %"
    if 99.9 < value < 100.0:
        return "above 99.9 %"
    return f"{value:.0f} %" if 9.95 <= value < 99.5 or value == 100.0 else f"{value:.1f} %"


def probability_text(probability: float) -> str:
    """Return a computed probability in percent: none is exactly 0 or 1."""
    return percent(min(max(probability, 1e-9), 1 - 1e-9))


def p_text(p: float) -> str:
    """Return the p of a test to four decimals; a smaller one is below them."""
    return "< 0.0001" if p < 1e-4 else f"{p:.4f}"


def drawn_probability_text(probability: float) -> str:
    """Return a probability in percent that is told to 1 % at most, as by hundreds of draws."""
    if probability < 0.01:
        return "below 1 %"
    return "above 99 %" if probability > 0.99 else percent(probability)


def quantity_text(value: float, unit: str, uncertainty: float | None = None) -> str:
    """Return a number, and its uncertainty, in one unit people read; forces in newtons."""
    newtons = unit == "N" and unit_system() == "si"
    factor, name = (1.0, "N") if newtons else display_unit(value, unit)
    if newtons and 0.0 < abs(value) < 0.01:
        return "below 0.01 N"
    text = number_text(value / factor, 3)
    if uncertainty is not None:
        text += f" ± {number_text(uncertainty / factor, 2)}"
    for plain, sign in (("um", "µm"), ("^2", "²"), ("^3", "³"), ("*", "·")):
        name = name.replace(plain, sign)
    return text if name == "1" else f"{text} {name}"


def value_text(name: str, scalar: SourcedValue) -> str:
    """Return a named value with its uncertainty as people read it.

    Dimensionless values have three decimals, probabilities are in percent; a skewed 95 % interval
    takes the place of one standard deviation.
    """
    if scalar.value is None:
        return f"not determined: {scalar.reason}"
    if name not in PROBABILITIES and scalar.unit != "1":
        return quantity_text(scalar.value, scalar.unit, scalar.uncertainty)
    shown = _plain(name, scalar.value)
    if shows_interval(name, scalar):
        interval = interval_text(name, scalar)
        return f"{shown} ({interval})" if interval else shown
    if scalar.uncertainty is None or (name in PROBABILITIES and scalar.uncertainty < 1e-3):
        return shown
    return f"{shown} ± {_plain(name, scalar.uncertainty)}"


def shows_interval(name: str, scalar: SourcedValue) -> bool:
    """Return whether ``value_text`` gives the 95 % interval in place of a standard deviation."""
    if scalar.value is None or scalar.interval is None:
        return False
    wide = name in PROBABILITIES and is_wide(scalar.interval)
    return wide or _is_skewed(scalar.value, scalar.interval)


def interval_text(name: str, scalar: SourcedValue) -> str:
    """Return the 95 % interval of a named value; empty where there is none."""
    if scalar.interval is None:
        return ""
    plain = name in PROBABILITIES or scalar.unit == "1"
    low, high = (
        _plain(name, end) if plain else quantity_text(end, scalar.unit) for end in scalar.interval
    )
    return "" if low == high else f"{low} to {high}"


def _plain(name: str, value: float) -> str:
    return probability_text(value) if name in PROBABILITIES else f"{value:.3f}"


def is_wide(interval: tuple[float, float] | None) -> bool:
    """Return whether a probability is so uncertain that one number would say what nobody knows."""
    return interval is not None and interval[1] - interval[0] > WIDE


def _is_skewed(value: float, interval: tuple[float, float]) -> bool:
    """Return True where a single standard deviation would misrepresent the interval."""
    below, above = value - interval[0], interval[1] - value
    return abs(above - below) > SKEWED * (interval[1] - interval[0])


def _cell(value: Any) -> str:
    if value is None:
        return ""
    if isinstance(value, str):  # a message stays one: pages put it into their language
        return value
    return f"{value:.4g}" if isinstance(value, float) else str(value)
