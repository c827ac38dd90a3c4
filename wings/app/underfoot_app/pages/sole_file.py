"""A sole from a file: drop it, see what was read and what assumed, correct it, use it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from nicegui import ui

from underfoot.core import InputError

from ..components import SoleView, drop_zone, sentences, table
from ..session import Session, as_json

ACCEPT = ".step,.stp,.iges,.igs,.brep,.stl,.obj,.ply,.off,.glb,.gltf,.3mf,.3dm"
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

    async def arrived(paths: list[str]) -> None:
        _Inspection(session, name, paths[0], view, used, place)

    drop_zone(session, "soles", arrived, label=text("sole_file.drop"), accept=ACCEPT)
    place.move(target_index=-1)
    files = sorted(
        path.name
        for path in session.project.inside("soles").iterdir()
        if path.suffix.lower() in ACCEPT.split(",")
    )
    if files:
        known = ui.select(files, label=text("sole_file.known")).props("dense outlined")
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
        labels = {each: self.text.get(f"sole_file.{each}", each) for each in options}
        choice = ui.select(labels, value=options[0], label=self.text(f"sole_file.{key}"))
        choice.props("dense outlined options-dense")
        choice.on_value_change(lambda event: self._set(key, event.value))

    def _set(self, key: str, value: Any) -> None:
        self.settings[key] = value
        self._read()

    def _read(self) -> None:
        self.reading.clear()
        with self.reading:
            ui.label(self.text("sole_file.reading")).classes("soft")
            ui.timer(0, self._show, once=True)

    async def _show(self) -> None:
        file = str(self.session.project.inside(self.path))
        settings = {
            key: value for key, value in self.settings.items() if value not in ("auto", None)
        }
        try:
            answer = await self.session.ask("underfoot_app.work:inspected_sole", file, settings)
        except Exception:
            self.reading.clear()
            raise
        self.reading.clear()
        self.view.show(answer["html"])
        values = {"measures": " ".join(answer["headline"])}
        ui.run_javascript(f"showTexts({as_json(values)})")
        with self.reading:
            sentences(answer["headline"])
            use = ui.button(
                self.text("sole_file.use"), on_click=lambda: self._use(answer["sha256"])
            )
            use.props("no-caps unelevated")
            for line in next(iter(answer["remarks"].values()), []):
                ui.label(line).classes("assumed" if line.startswith("Assumed") else "soft")
            for shown in answer["tables"]:
                table(shown)

    def _use(self, sha256: str) -> None:
        project = self.session.project
        given = {key: value for key, value in self.settings.items() if value not in ("auto", None)}
        outsole = {"file": f"../{self.path}", "sha256": sha256, **given}
        if not project.inside(self.path).is_file():
            raise InputError(f"there is no file {self.path}", where="sole")
        project.change(self.name, {"shoe.outsole": outsole})
        self.used()
