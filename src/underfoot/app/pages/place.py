"""Which shoe for a place: a file of floors, fluids, shoes and people, and the page of evidence."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path

from nicegui import ui

from underfoot.core.remark import from_stored

from ..components import drop_zone, interruption, sentences, table, task_line, title
from ..jobs import QueuedTask
from ..labels import package_label
from ..session import Session

ROUTE = "/place"
FOLDER = "places"
WORK = "underfoot.app.work_place:chosen_shoe"


def build(session: Session) -> None:
    """Show a place for the file, the places of the project, and the answer for one of them."""
    _Place(session)


class _Place:
    def __init__(self, session: Session) -> None:
        self.session, self.text = session, session.text
        self.folder = session.project.inside(FOLDER)
        with ui.element("div").classes("no-print"):
            title(self.text("place.title")).classes("hidden-title")
            ui.label(self.text("place.lead")).classes("lead")
            drop_zone(
                session, FOLDER, self.take_file, label=self.text("place.drop"), accept=".toml"
            )
            self.choice = ui.select(self.names(), label=self.text("place.of_project"))
            self.choice.props("dense outlined").classes("compare-choice")
            self.choice.on_value_change(lambda event: self.show(event.value))
        self.busy = ui.element("div").classes("no-print")
        self.answer = ui.element("div")
        wanted = session.query.get("place", "")
        if wanted in self.names():
            self.choice.value = wanted

    def names(self) -> list[str]:
        """Return the names of the places of the project."""
        return sorted(path.stem for path in self.folder.glob("*.toml"))

    def stored_file(self, name: str) -> Path:
        """Return the file that a computed answer stands in."""
        return self.folder / name / "shown.json"

    async def take_file(self, paths: list[str]) -> None:
        """Compute the place of a file that was dropped."""
        name = Path(paths[0]).stem
        self.choice.set_options(self.names())
        self.choice.value = name
        self.compute(name)

    def compute(self, name: str) -> None:
        """Queue the choice of a place."""
        file, folder = self.folder / f"{name}.toml", self.folder / name
        self.answer.clear()
        task = self.session.submit(self.text("place.job"), WORK, str(file), str(folder), about=name)
        self.busy.clear()
        with self.busy:
            task_line(self.session, task, partial(self.show_end, name))

    async def show_end(self, name: str, task: QueuedTask) -> None:
        """Show what came of a task, and what there was before it where nothing did."""
        self.show(name)
        if task.problem:
            with self.answer:
                package_label(task.problem).classes("caution")

    def show(self, name: str) -> None:
        """Show the stored answer of a place, or that there is none."""
        self.answer.clear()
        file, stored = self.folder / f"{name}.toml", self.stored_file(name)
        with self.answer:
            interruption(self.session, self.session.jobs.latest(name, WORK))
            if not stored.exists():
                self.compute_button(name, "place.compute")
                return
            if file.exists() and file.stat().st_mtime > stored.stat().st_mtime:
                ui.label(self.text("start.changed")).classes("caution")
            shown = from_stored(json.loads(stored.read_text(encoding="utf-8")))
            title(shown["heading"])
            sentences(shown["headline"], "lead")
            sentences(shown["cautions"], "soft")
            with ui.element("div").classes("row no-print"):
                printed = ui.button(self.text("place.print"), icon="print")
                printed.on_click(lambda: ui.run_javascript("window.print()"))
                printed.props("flat no-caps dense")
                self.compute_button(name, "place.again")
            picture = ui.image(shown["picture"]).style("max-width: 44rem")
            picture.props(f'alt="{self.text("place.title")}: {name}"')
            for each in shown["tables"]:
                table(each)
            for heading, lines in shown["remarks"].items():
                title(heading, 2)
                sentences(lines, "soft")

    def compute_button(self, name: str, key: str) -> None:
        """Show a button that computes a place."""
        button = ui.button(self.text(key), icon="refresh", on_click=lambda: self.compute(name))
        button.props("flat no-caps dense")
