"""A sole from a file: drop it, see what was read and what assumed, correct it, use it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

from nicegui import ui

from underfoot.core import InputError
from underfoot.core.errors import Cancelled
from underfoot.core.remark import Message, is_assumed, together
from underfoot.core.worker import Job

from ..components import SoleView, drop_zone, sentences, table
from ..labels import package_label
from ..session import Session
from ..text import as_json
from ..uploads import revision, revisions
from .repair import references

ACCEPT = ".step,.stp,.iges,.igs,.brep,.stl,.obj,.ply,.off,.glb,.gltf,.3mf,.3dm"
WORK = "underfoot.app.work_sole:inspected_sole"
AXES = ("auto", "+x", "-x", "+y", "-y", "+z", "-z")
CHOICES = {
    "down": AXES,
    "forward": AXES,
    "unit": ("auto", "mm", "cm", "m", "inch"),
    "foot": ("auto", "left", "right"),
    "region": ("whole", "heel", "forepart"),
    "side": ("auto", "left", "right"),
}
"""What a person can correct of a file that was read, by the keys of a case's outsole."""


def build(session: Session, name: str, view: SoleView, used: Callable[[], None]) -> None:
    """Show where files are dropped; ``used`` is called when the variant takes one."""
    text = session.text
    place = ui.element("div")

    async def inspect_file(paths: list[str]) -> None:
        _Inspection(session, name, paths[0], view, used, place)

    drop_zone(session, "soles", inspect_file, label=text("sole_file.drop"), accept=ACCEPT)
    place.move(target_index=-1)
    files = [
        path
        for path in session.project.inside("soles").glob("[!.]*")
        if path.suffix.lower() in ACCEPT.split(",")
    ]
    if files:
        count = Counter(revision(path)[0] for path in files)
        newest = sorted(
            files, key=lambda path: (revision(path)[0].name.casefold(), -revision(path)[1])
        )
        labels = {path.name: path.name for path in newest}
        for first, number in count.items():
            if number > 1:
                latest = revisions(first)[-1].name
                labels[latest] = text("sole_file.revision", file=latest, count=number)
        known = ui.select(labels, label=text("sole_file.known")).props("dense outlined")
        known.on_value_change(
            lambda event: _Inspection(session, name, f"soles/{event.value}", view, used, place)
        )


class _Inspection:
    """One file as it is read, with what can be corrected."""

    def __init__(
        self,
        session: Session,
        name: str,
        path: str,
        view: SoleView,
        used: Callable[[], None],
        place: ui.element,
    ) -> None:
        self.session, self.name, self.path, self.view, self.used = session, name, path, view, used
        self.text = session.text
        self.settings: dict[str, Any] = {}
        self.busy = False
        place.clear()
        with place:
            ui.label(self.text("sole_file.file", file=path.partition("/")[2])).classes("file-name")
            with ui.element("div").classes("corrections"):
                for key, options in CHOICES.items():
                    self._choice(key, options)
                solid = ui.input(self.text("sole_file.solid")).props("dense outlined")
                solid.on("change", lambda: self._set("solid", (solid.value or "").strip() or None))
            self.reading = ui.element("div").props('aria-live="polite"')
        self._read()

    def _choice(self, key: str, options: tuple[str, ...]) -> None:
        labels = {option: self.text.get(f"sole_file.{option}", option) for option in options}
        choice = ui.select(labels, value=options[0], label=self.text(f"sole_file.{key}"))
        choice.props("dense outlined options-dense")
        choice.on_value_change(lambda event: self._set(key, event.value))

    def _set(self, key: str, value: Any) -> None:
        self.settings[key] = value
        self._read()

    def _read(self) -> None:
        if self.busy:  # with other settings
            self.session.jobs.reading.stop()
        self.busy = True
        self.reading.clear()
        with self.reading, ui.element("div").classes("task").props('role="status"'):
            self.stage = ui.label(self.text("sole_file.reading"))
            self.bar = ui.linear_progress(0.0, show_value=False)
            self.bar.props(f'aria-label="{self.text("sole_file.reading")}"')
            stop = ui.button(self.text("jobs.stop"), on_click=self.session.jobs.reading.stop)
            stop.props("flat dense no-caps")
        with self.reading:
            ui.timer(0, self._show, once=True)

    async def _show(self) -> None:
        def heard(job: Job) -> None:
            self.stage.text, self.bar.value = job.stage or self.stage.text, job.fraction

        file = str(self.session.project.inside(self.path))
        settings = {
            key: value for key, value in self.settings.items() if value not in ("auto", None)
        }
        read = dict(self.settings)
        try:
            variants = str(self.session.project.inside("variants"))
            answer = await self.session.ask(
                WORK, file, settings, variants, lane=self.session.jobs.reading, heard=heard
            )
        except Exception as error:
            if read == self.settings:
                self.busy = False
                self.reading.clear()
                if isinstance(error, Cancelled):
                    with self.reading:
                        ui.label(self.text("sole_file.stopped")).classes("soft")
                        again = ui.button(self.text("sole_file.again"), on_click=self._read)
                        again.props("flat dense no-caps")
            raise
        if read != self.settings:
            return
        self.busy = False
        self.reading.clear()
        self.view.show(answer["html"])
        measures = together(answer["headline"])
        values = {"measures": {"text": measures, "message": measures.page_mark()}}
        ui.run_javascript(f"showTexts({as_json(values)})")
        with self.reading:
            sentences(answer["headline"])
            self._uses(answer["shoe"])
            for line in next(iter(answer["remarks"].values()), []):
                package_label(line).classes("assumed" if is_assumed(line) else "soft")
            for shown in answer["tables"]:
                table(shown)

    def _uses(self, shoe: dict[str, Any]) -> None:
        """Show what can be done with the file: nothing is changed until one is pressed."""
        project, text = self.session.project, self.text
        path = project.inside(self.path)
        same = {*revisions(path)} - {path}
        others = [
            name
            for name in project.variants()
            if name != self.name
            and any(reference.path(project) in same for reference in references(project, name))
        ]

        def use() -> None:
            self._use([self.name], shoe)
            self.used()

        def use_everywhere() -> None:
            self._use([self.name, *others], shoe)
            self.used()

        def use_new() -> None:
            new = project.copy(self.name, Path(self.path).stem)
            self._use([new], shoe)
            self.session.go("/design", variant=new)

        with ui.element("div").classes("row"):
            ui.button(text("sole_file.use"), on_click=use).props("no-caps unelevated")
            ui.button(text("sole_file.use_new"), on_click=use_new).props("no-caps flat")
            if others:
                words = text("sole_file.use_in", names=", ".join(others))
                ui.button(words, on_click=use_everywhere).props("no-caps outline")

    def _use(self, names: list[str], shoe: dict[str, Any]) -> None:
        """Give variants the shoe that a case of the file has; what a person set of it stays."""
        project = self.session.project
        if not project.inside(self.path).is_file():
            raise InputError(Message("there is no file {path}", path=self.path), where="sole")
        for name in names:  # undo brings back what was drawn with sliders
            project.take_sole(name, shoe)
