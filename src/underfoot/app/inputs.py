"""Values of a case as people set them: sliders that answer while moved, fields with units."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from html import escape
from itertools import count
from math import degrees, log10
from typing import Any, TypeVar

from nicegui import ui
from nicegui.events import GenericEventArguments

from underfoot.case import Case, unit_at
from underfoot.core import InputError
from underfoot.core.errors import UnderfootError
from underfoot.core.remark import Message
from underfoot.core.typed import split_quantity
from underfoot.core.units import si_unit, to_si

from .session import Session

SIGNS = {"deg": "°", "um": "µm"}
"""How a unit is shown where it is not as it is written in a case."""
CUSTOMARY = {
    "mm": (25.4, "in"),
    "um": (25.4, "mil"),
    "m/s": (0.3048, "ft/s"),
    "N": (4.4482216152605, "lbf"),
}
"""Size and sign of the US unit that is shown in place of one of a case."""
GROOVES = "shoe.tread.grooves"
_numbers = count()
Read = TypeVar("Read")


@dataclass(frozen=True, slots=True)
class Input:
    """A value of a case with the unit in which it is set.

    Attributes:
        path: In the case; its name is ``inputs.PATH`` in the text files.
        unit: As a case file writes it, "" for a number.
    """

    path: str
    unit: str

    def shown_in(self, units: str) -> tuple[float, str]:
        """Return size and sign of the unit that is shown."""
        metric = (1.0, SIGNS.get(self.unit, self.unit))
        return CUSTOMARY.get(self.unit, metric) if units == "us" else metric

    def value_in(self, case: Case) -> float | None:
        """Return the value of a case in the unit, None where it has none."""
        value = case.value(self.path)
        factor = to_si(f"1 {self.unit}", unit_at(self.path), where=self.path) if self.unit else 1.0
        return None if value is None else float(value) / factor

    def read_typed(self, typed: str, units: str, *, comma: bool) -> str | float:
        """Return what was typed as a case takes it; without a unit it is in that shown.

        Raises:
            InputError: No number, a unit of another quantity, or a number that can be two.
        """
        if not self.unit:
            return to_si(typed, "1", where="", comma=comma)
        si, shown = unit_at(self.path), self.unit
        if units == "us" and self.unit in CUSTOMARY:
            shown = CUSTOMARY[self.unit][1]
        to_si(typed, si, where="", usual=shown, comma=comma)  # refuses what is no such quantity
        parts = split_quantity(typed, comma=comma)
        assert parts is not None  # else it was refused above
        number, unit = parts
        return f"{repr(number).removesuffix('.0')} {unit or shown}"


@dataclass(frozen=True, slots=True)
class Slider(Input):
    """A value that is set with a slider, in the range in which it usually lies.

    Attributes:
        low, high, step: In the unit; of a slider in decades (``log``) too.
    """

    low: float
    high: float
    step: float
    log: bool = False

    def case_value(self, value: float) -> str | float:
        """Return where the slider stands as a case takes it."""
        return f"{value:.9g} {self.unit}" if self.unit else float(f"{value:.9g}")


def changes(inputs: Sequence[Slider], values: Mapping[str, Any]) -> dict[str, Any]:
    """Return values of sliders as changes of a case; unknown names are left out."""
    known = {each.path: each for each in inputs}
    return {path: known[path].case_value(float(v)) for path, v in values.items() if path in known}


def grooves_of(case: Case) -> list[dict[str, str]]:
    """Return the grooves of a case's tread as its file writes them, in mm and degrees."""
    grooves = []
    for each in case.value(GROOVES) or ():
        values = {name: getattr(each, name) for name in ("along", "across", "width", "length")}
        written = {name: f"{1e3 * v:.9g} mm" for name, v in values.items() if v is not None}
        grooves.append({**written, "angle": f"{degrees(each.angle):.9g} deg"})
    return grooves


def sliders(
    session: Session,
    inputs: Sequence[Slider],
    case: Case,
    moving: Callable[[dict[str, Any]], Awaitable[dict[str, Any]]],
    resting: Callable[[dict[str, Any]], object],
    view: ui.element,
    *,
    keep: bool,
) -> ui.element:
    """Show a slider for each input that the case has, with what is done while they move.

    ``moving`` gets the changes of the case and returns ``{"texts": {name: words}, "html": sole}``:
    the words go to every element with ``data-live="name"``, the sole into ``view``; with
    ``"unanswered": True`` the sole there is marked as of another setting. ``resting`` gets the
    changes when a slider was let go, at once where it keeps them.
    """
    rows = []
    for each in inputs:
        value = each.value_in(case)
        if value is not None:
            origin, _ = _origin(session, case, each.path, "guess")  # in a word
            rows.append(_row(session, each, value, origin))
    root = ui.html("".join(rows) + '<p data-part="problem" role="alert"></p>', sanitize=False)
    root.classes("sliders").props(f'data-own="{escape(session.text("origin.given"))}"')

    async def answer_question(question: dict[str, Any]) -> dict[str, Any]:
        changed = changes(inputs, question["values"])
        if question["last"]:
            resting(changed)
            return {}
        return await moving(changed)

    link, keeps = session.answers(answer_question), "true" if keep else "false"
    ui.run_javascript(f"askLive({root.html_id!r}, {link!r}, {view.html_id!r}, {keeps})")
    return root


def _origin(session: Session, case: Case, path: str, assumed: str = "assumed") -> tuple[str, str]:
    """Return in words where a value of a case comes from, and its source; empty where not known.

    ``assumed`` is the key of what stands for a guess.
    """
    origin = case.origins.get(path)
    if origin is None:
        return "", ""
    kind = assumed if origin.leaf.assumed else origin.kind
    return session.text(f"origin.{kind}"), origin.leaf.source or ""


def _row(session: Session, each: Slider, value: float, origin: str) -> str:
    low, high, shown, step = each.low, max(each.high, value), value, each.step
    size, sign = each.shown_in(session.units)
    if each.log:
        low, high, shown, step = log10(low), log10(high), log10(max(value, low)), 0.01
    key = f"slider-{next(_numbers)}"
    # the browser moves the thumb to the next step: the value stands beside it until it is moved
    marks = f'data-unit="{sign}" data-size="{size}" data-given="{value:.6g}"'
    marks += ' data-log="1"' * each.log
    return (
        f'<label for="{key}">{escape(session.text(f"inputs.{each.path}"))}'
        f"<small>{escape(origin)}</small></label>"
        f'<input type="range" id="{key}" name="{each.path}" min="{min(low, shown):.6g}" '
        f'max="{high:.6g}" step="{step:g}" value="{shown:.6g}" {marks}>'
        f'<output for="{key}"></output>'
    )


def read_in_unit(typed: str, unit: str, *, comma: bool) -> float:
    """Return the number in a unit that was typed with that unit, with another one or with none.

    Raises:
        InputError: No such quantity, or a number that can be two.
    """
    si = si_unit(f"1 {unit}", where="")
    return to_si(typed, si, where="", usual=unit, comma=comma) / to_si(f"1 {unit}", si, where="")


def read_field(field: ui.input, read: Callable[[str], Read]) -> Read:
    """Return what ``read`` makes of the text of a field; its error is told there, too.

    Raises:
        InputError: As ``read``.
    """
    field.error = None
    try:
        return read(field.value or "")
    except InputError as error:
        field.error = str(error)
        raise


def whole_number(text: str, *, comma: bool) -> int:
    """Return the whole number from 1 on that was typed.

    Raises:
        InputError: Another text.
    """
    number = to_si(text, "1", where="", comma=comma)
    if number < 1 or number != int(number):
        raise InputError(Message("{given} is no count", given=text), allowed="1, 2, 3 ...")
    return int(number)


def read_count(session: Session, field: ui.input) -> int | None:
    """Return the whole number from 1 on in a field, None where it is empty; else it is told there.

    Raises:
        InputError: Another text, which the field tells, too.
    """
    field.error = None
    if not (field.value or "").strip():
        return None
    return read_field(field, partial(whole_number, comma=session.text.comma))


def number_field(
    session: Session, each: Input, case: Case, change: Callable[[dict[str, Any]], None]
) -> None:
    """Show a value with its unit and where it comes from; ``change`` gets what is typed.

    An empty field takes back what a person gave: the catalogue's value returns.
    """
    value = each.value_in(case)
    if value is None and case.value(each.path.rpartition(".")[0]) is None:
        return
    size, sign = each.shown_in(session.units)
    shown = None if value is None else value / size
    label, text = session.text(f"inputs.{each.path}"), session.text.number(shown)
    field = ui.input(label, value=text)
    field.props(f'dense outlined suffix="{sign}" inputmode="decimal"').classes("number")

    def take_typed(_: GenericEventArguments) -> None:
        if field.value == text:
            return
        given = (field.value or "").strip()
        origin = case.origins.get(each.path)
        if not given and (origin is None or origin.kind != "given"):
            field.error, field.value = None, text  # there is nothing of one's own to take away
            return
        try:
            comma = session.text.comma
            change(
                {each.path: each.read_typed(given, session.units, comma=comma) if given else None}
            )
        except UnderfootError as error:  # the file stays as it was
            field.error = str(error)
            return
        field.error = None

    field.on("change", take_typed)
    hint, source = _origin(session, case, each.path)
    if hint:
        field.props(f'hint="{escape(hint)}"')
    if source:
        field.tooltip(source)
