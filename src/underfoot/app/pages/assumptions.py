"""What is assumed of a variant and what each assumption does to the answer: measure this first."""

from __future__ import annotations

import json
from functools import partial
from typing import Any

from nicegui import ui

from underfoot.case import Case, assumptions, unit_at
from underfoot.core import display

from ..components import interruption, show_refillable, task_line
from ..labels import package_label
from ..session import Session

EFFECTS = "underfoot.app.work:effects"


def build(session: Session, name: str) -> None:
    """Show the assumptions, those with the largest known effect first."""
    show_refillable(partial(_fill_dialog, session, name))


def _fill_dialog(session: Session, name: str, again: Any) -> None:
    text, case = session.text, session.project.case(name)
    ui.label(text("assumptions.lead")).classes("soft")
    task = session.jobs.latest(name, EFFECTS)
    effects = _effects(session, name, case)
    if task is not None and task.open:
        task_line(session, task, again)
    elif effects is None:

        async def compute() -> None:
            project = session.project
            folder = project.inside("studies", f"{name}, sensitivity")
            arguments = (str(project.path(name)), str(folder))
            session.submit(text("assumptions.job"), EFFECTS, *arguments, about=name)
            await again()

        interruption(session, task)
        ui.button(text("assumptions.compute"), on_click=compute).props("no-caps outline")
    largest = max((each["deviation"] or 0.0 for each in effects or ()), default=0.0)
    for rank, each in enumerate(effects or ()):
        with ui.element("div").classes("assumption"):
            first = f" {text('assumptions.first')}" if rank == 0 and largest else ""
            ui.label(_label(session, each["path"]) + first).classes("strong")
            unit = unit_at(each["path"])
            ends = (display(each[end][0], unit) for end in ("low", "high"))
            low, high = ends
            effect = each["deviation"]
            ui.label(
                text("assumptions.unknown")
                if effect is None
                else text("assumptions.effect", low=low, high=high, effect=f"{effect:.3f}")
            )
            if effect and largest:
                ui.element("div").classes("effect").style(f"width: {100 * effect / largest:.0f}%")
            package_label(each["reason"]).classes("soft")
    with ui.expansion(text("assumptions.all"), value=effects is None).classes("plain"):
        for line in assumptions(case):
            package_label(line).classes("soft")


def _label(session: Session, path: str) -> str:
    return session.text.get(f"inputs.{path}", path.replace(".", ": ").replace("_", " "))


def _effects(session: Session, name: str, case: Case) -> list[dict[str, Any]] | None:
    """Return the stored effects on the COF, largest first; None where the case has changed."""
    folder = session.project.inside("studies", f"{name}, sensitivity")
    try:
        if (folder / "case-hash.txt").read_text(encoding="ascii").strip() != case.hash:
            return None
        stored = json.loads((folder / "sensitivity.json").read_text(encoding="utf-8"))
        return stored["quantities"]["cof"]["effects"]
    except (OSError, ValueError, KeyError):
        return None
