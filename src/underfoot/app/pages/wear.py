"""How long a variant lasts: its friction over wear, and months from one worn shoe."""

from __future__ import annotations

import json
from functools import partial
from typing import Any

from nicegui import ui

from underfoot.core import InputError
from underfoot.core.remark import Message, from_stored
from underfoot.core.units import to_si

from ..components import interruption, sentences, show_refillable, table, task_line
from ..inputs import read_field
from ..labels import package_label
from ..session import Session

WORN = "underfoot.app.work:worn"


def build(session: Session, name: str) -> None:
    """Show what was computed of the wear of a variant, and two fields that begin it."""
    show_refillable(partial(_fill_dialog, session, name))


def _fill_dialog(session: Session, name: str, again: Any) -> None:
    text, project = session.text, session.project
    folder = project.inside("studies", f"{name}, wear")
    task = session.jobs.latest(name, WORN)
    with ui.expansion(text("wear.title"), value=task is not None).classes("plain"):
        ui.label(text("wear.lead")).classes("soft")
        with ui.element("div").classes("row"):
            lost = ui.input(text("wear.lost")).props('dense outlined suffix="mm"')
            months = ui.input(text("wear.months")).props("dense outlined")
            for field in (lost, months):
                field.props('inputmode="decimal"').classes("number")

        async def compute() -> None:
            thickness = read_field(lost, partial(_above_0, session, unit="m", usual="mm"))
            time = read_field(months, partial(_above_0, session, unit="1", usual=""))
            pair = Message(
                "{thickness} mm after {time} months",
                thickness=repr(1000.0 * thickness),
                time=repr(time),
            )
            arguments = (str(project.path(name)), str(folder), pair)
            session.submit(text("wear.job"), WORN, *arguments, about=name)
            await again()

        interruption(session, task)
        button = ui.button(text("wear.compute"), on_click=compute).props("no-caps outline")
        if task is not None and task.open:
            button.disable()
            task_line(session, task, again)
        elif task is not None and task.problem:
            package_label(task.problem).classes("problem problem-what").props('role="alert"')
        elif (shown := _read_stored_wear(session, name)) is not None:
            sentences(shown["headline"])
            sentences(shown["cautions"], "caution")
            for each in shown["tables"]:
                table(each)


def _above_0(session: Session, typed: str, *, unit: str, usual: str) -> float:
    value = to_si(typed, unit, where="", usual=usual, comma=session.text.comma)
    if value <= 0:
        raise InputError(Message("{typed} is nothing", typed=typed), allowed="above 0")
    return value


def _read_stored_wear(session: Session, name: str) -> dict[str, Any] | None:
    """Return what was computed of the present case; None where there is nothing."""
    file = session.project.inside("studies", f"{name}, wear", "shown.json")
    try:
        shown = from_stored(json.loads(file.read_text(encoding="utf-8")))
        return shown if shown["hash"] == session.project.case(name).hash else None
    except (OSError, ValueError, KeyError):
        return None
