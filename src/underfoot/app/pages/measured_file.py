"""A measured file that a variant takes: a scan, a rubber test, a contact table."""

from __future__ import annotations

from collections.abc import Callable

from nicegui import ui

from ..components import drop_zone
from ..session import Session

COMPOUND = "shoe.material.file"
FILES = {
    "sole": {"shoe.roughness.file": "", COMPOUND: ""},
    "floor": {"floor.roughness.file": "", "rough_contact.file": ".npz"},
}
"""Values of a case that name a measured file, by the part of the design, and what is accepted."""


def build(session: Session, name: str, part: str, used: Callable[[], None]) -> None:
    """Show a place for each measured file of a part, and what the variant has; it can be let go."""
    case = session.project.case(name)
    for path, accept in FILES.get(part, {}).items():
        _place(session, name, path, accept, case.value(path), used)


def _place(
    session: Session,
    name: str,
    path: str,
    accept: str,
    present: str | None,
    used: Callable[[], None],
) -> None:
    async def take_file(paths: list[str]) -> None:
        file = paths[0]
        if path == COMPOUND and not file.endswith(".toml"):  # a test of the rubber
            full = str(session.project.inside(file))
            file = f"measured/{await session.ask('underfoot.app.work:compound', full)}"
        session.project.change(name, {path: f"../{file}"})
        used()

    def leave() -> None:
        session.project.change(name, {path: None})
        used()

    if present:
        with ui.element("div").classes("row"):
            ui.label(session.text(f"measured.{path}", file=present.rpartition("/")[2]))
            ui.button(session.text("measured.leave"), on_click=leave).props("flat dense no-caps")
    drop_zone(
        session, "measured", take_file, label=session.text(f"measured.drop.{path}"), accept=accept
    )
