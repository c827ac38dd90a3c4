"""The report of a project: its variants in one table, computed in one click; other projects."""

from __future__ import annotations

import time
from functools import partial
from pathlib import Path

from nicegui import ui

from underfoot.core import InputError

from ..components import title
from ..jobs import DONE, FAILED, RUNNING, QueuedTask
from ..projects import known_projects
from ..result_table import ResultTable
from ..session import LOOK, Session
from .answer import RUN, begin_run

ROUTE = "/project"
ROWS_A_SECOND = 50
"""Rows that are shown anew a second, at most: a large table is looked at less often."""


def build(session: Session) -> None:
    """Show what is known of each variant, and the other projects of this person."""
    text, project = session.text, session.project
    title(project.name).props('translate="no"')
    count = len(project.variants())
    ui.label(text("project.lead", count=count, date=time.strftime("%Y-%m-%d")))
    with ui.element("div").classes("bar-row no-print"):
        compute = ui.button(text("project.reading"), icon="play_arrow")
        compute.props("no-caps unelevated").disable()
        printed = ui.button(text("place.print"), icon="print")
        printed.on_click(lambda: ui.run_javascript("window.print()"))
        printed.props("flat no-caps dense")
    progress = ui.element("div").classes("no-print")
    table = ResultTable(
        session,
        project.name,
        lambda: [(n, str(project.path(n)), str(project.result_folder(n))) for n in _names(session)],
    )
    missing: list[str] = []
    shown = 0.0

    async def show() -> None:
        nonlocal shown
        runs = _runs(session)
        rows = await table.show({name: _state_text(session, task) for name, task in runs.items()})
        waits = {name for name, task in runs.items() if task.open}
        missing[:] = [row["name"] for row in rows if row["state"] in ("not_computed", "earlier")]
        missing[:] = [name for name in missing if name not in waits]
        label = "project.compute_some" if missing else "project.compute_none"
        compute.text = text(label, count=len(missing))
        compute.set_enabled(bool(missing))
        shown = time.monotonic()

    async def compute_all() -> None:
        for name in missing:
            begin_run(session, name, later=True)
        _progress(session, progress)
        await show()

    compute.on_click(compute_all)
    _progress(session, progress)
    ui.timer(0, show, once=True)
    session.follow(
        lambda: (
            [(name, *project.state(name)) for name in project.variants()],
            [(task.number, task.state) for task in _runs(session).values()],
        ),
        show,
        lambda: time.monotonic() - shown < len(table.rows) / ROWS_A_SECOND,
    )
    if session.elsewhere is not None:
        with ui.element("section").classes("no-print"):
            title(text("project.others"), 2)
            ui.label(text("project.others_lead")).classes("soft")
            _others(session)


def _names(session: Session) -> list[str]:
    """Return the variants by name, so that rows stay in their places while others change."""
    return sorted(session.project.variants(), key=str.casefold)


def _runs(session: Session) -> dict[str, QueuedTask]:
    """Return the newest run of each variant."""
    return {task.about: task for task in session.jobs.tasks.values() if task.function == RUN}


def _state_text(session: Session, task: QueuedTask) -> str:
    """Return what a run does or why it has no result; empty where it is done."""
    if task.state == DONE:
        return ""
    words = session.text(f"jobs.{task.state}")
    return f"{words}: {task.problem}" if task.state == FAILED and task.problem else words


def _progress(session: Session, place: ui.element) -> None:
    """Show how far the runs are while there are any, whoever began them, and stop them all."""
    text = session.text
    place.clear()
    with place, ui.element("div").classes("task").props('role="status"') as line:
        label = ui.label("")
        bar = ui.linear_progress(0.0, show_value=False)
        bar.props(f'aria-label="{text("project.compute")}"')
        stop = ui.button(text("project.stop")).props("flat dense no-caps")
    stop.on_click(lambda: session.jobs.cancel_all(RUN))
    most = 0

    def look() -> None:
        nonlocal most
        left = [t for t in session.jobs.tasks.values() if t.function == RUN and t.open]
        most = max(most, len(left)) if left else 0
        line.set_visibility(bool(left))
        if left:
            done = most - len(left)
            part = sum(task.fraction for task in left if task.state == RUNNING)
            bar.value = (done + part) / most
            now = next((task.about for task in left if task.state == RUNNING), "")
            label.text = text("project.left", done=done, total=most, now=now)

    look()
    ui.timer(LOOK, look)


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

        async def open_folder() -> None:
            wanted = Path((field.value or "").strip()).expanduser()
            if not (field.value or "").strip():
                raise InputError("a folder is needed", where=text("project.folder"))
            await go(wanted if wanted.is_absolute() else session.project.folder.parent / wanted)

        field.on("keydown.enter", open_folder)
        ui.button(text("project.open"), on_click=open_folder).props("no-caps outline")
