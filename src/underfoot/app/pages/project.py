"""The report of a project: its variants on one page to print; and the way to another project."""

from __future__ import annotations

import time
from functools import partial
from pathlib import Path

from nicegui import ui

from underfoot.core import InputError

from ..components import title
from ..projects import known_projects
from ..session import Session, address

ROUTE = "/project"
COLUMNS = ("variant", "state", "verdict", "cof", "interval", "slips")


def build(session: Session) -> None:
    """Show what is known of each variant, and the other projects of this person."""
    text, project = session.text, session.project
    title(project.name).props('translate="no"')
    ui.label(text("project.lead", count=len(project.variants()), date=time.strftime("%Y-%m-%d")))
    with ui.element("div").classes("row no-print"):
        printed = ui.button(text("place.print"), icon="print")
        printed.on_click(lambda: ui.run_javascript("window.print()"))
        printed.props("flat no-caps dense")
    place = ui.element("div")

    async def show() -> None:
        names = project.variants()
        folders = [str(project.result_folder(name)) for name in names]
        answers = await session.ask("underfoot.app.work:verdicts", folders)
        place.clear()
        with place:
            _rows(session, dict(zip(names, answers, strict=True)))

    ui.timer(0, show, once=True)
    session.follow(lambda: [(name, *project.state(name)) for name in project.variants()], show)
    if session.elsewhere is not None:
        with ui.element("section").classes("no-print"):
            title(text("project.others"), 2)
            ui.label(text("project.others_lead")).classes("soft")
            _others(session)


def _rows(session: Session, verdicts: dict[str, list[str]]) -> None:
    """Show a row a variant: no number stands without what it is of."""
    text, project = session.text, session.project
    with ui.element("div").classes("wide"), ui.element("table"):
        with ui.element("thead"), ui.element("tr"):
            for column in COLUMNS:
                with ui.element("th").props('scope="col"'):
                    ui.label(text(f"project.{column}"))
        with ui.element("tbody"):
            for name, (word, steps) in verdicts.items():
                summary, current = project.summary(name), project.is_current(name)
                cells = [text(f"answer.{word}") if word else "", "", "", steps]
                if summary is not None and summary.cof is not None:
                    cells[1] = f"{summary.cof:.3f}"
                    if summary.low is not None and summary.high is not None:
                        cells[2] = text("answer.between", low=f"{summary.low:.3f}",
                                        high=f"{summary.high:.3f}")  # fmt: skip
                state = "current" if current else "earlier" if summary else "not_computed"
                with ui.element("tr"):
                    with ui.element("th").props('scope="row" translate="no"'):
                        ui.link(name, address("/answer", variant=name))
                    with ui.element("td"):
                        ui.label(text(f"project.{state}"))
                    for cell in cells:
                        with ui.element("td").classes("" if current else "stale"):
                            ui.label(cell)


def _others(session: Session) -> None:
    text = session.text

    async def go(folder: Path) -> None:
        assert session.elsewhere is not None
        ui.navigate.to(await session.elsewhere.link(folder))

    with ui.element("ul").classes("folders"):
        for folder in known_projects():
            if folder != session.project.folder:
                with ui.element("li"):
                    link = ui.button(str(folder), icon="folder", on_click=partial(go, folder))
                    link.props('flat no-caps align=left translate="no"')
    with ui.element("div").classes("row"):
        field = ui.input(text("project.folder")).props("dense outlined").classes("compare-choice")

        async def opened() -> None:
            wanted = Path((field.value or "").strip()).expanduser()
            if not (field.value or "").strip():
                raise InputError("a folder is needed", where=text("project.folder"))
            await go(wanted if wanted.is_absolute() else session.project.folder.parent / wanted)

        field.on("keydown.enter", opened)
        ui.button(text("project.open"), on_click=opened).props("no-caps outline")
