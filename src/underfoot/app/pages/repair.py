"""A variant that can't be read: what keeps it, and what would mend it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from nicegui import ui

from underfoot.case import Case
from underfoot.case import text as toml
from underfoot.core.errors import UnderfootError
from underfoot.core.files import checksum

from ..components import drop_zone
from ..labels import package_label
from ..project import Project
from ..session import Session
from ..uploads import PLACES
from ..variant_bar import variant_bar


@dataclass(frozen=True, slots=True)
class FileReference:
    """A file of the project that a variant names, with the checksum of the one it means."""

    name: str
    sha256: str | None

    def path(self, project: Project) -> Path:
        """Return where the file is meant to be."""
        return (project.folder / "variants" / self.name).resolve()

    def holds(self, project: Project) -> bool:
        """Return whether the file is there and the one that is meant."""
        path = self.path(project)
        return path.is_file() and self.sha256 in (None, checksum(path))


def references(project: Project, name: str) -> list[FileReference]:
    """Return the files of the project that a variant names, whether it can be read or not."""
    try:
        return list(_references(toml.parse_toml(project.text(name))))
    except UnderfootError:
        return []


def _references(table: Mapping[str, Any]) -> Iterator[FileReference]:
    for key, value in table.items():
        if isinstance(value, Mapping):
            yield from _references(value)
        elif isinstance(value, str) and value.split("/")[:2] in [["..", each] for each in PLACES]:
            yield FileReference(value, table.get("sha256") if key == "file" else None)


def replace_file(project: Project, name: str, reference: FileReference, path: Path) -> None:
    """Let a variant name another file: in its text, since it can't be read as a case."""
    text = project.text(name)
    new = f"../{path.relative_to(project.folder).as_posix()}"
    for quote in "\"'":
        text = text.replace(f"{quote}{reference.name}{quote}", f"{quote}{new}{quote}")
    if reference.sha256:
        text = text.replace(reference.sha256, checksum(path))
    project.write(name, text)


def open_variant(session: Session, route: str, name: str) -> Case | None:
    """Return the case of a variant; where it can't be read, show the bar and what would mend it."""
    try:
        return session.project.case(name)
    except UnderfootError as error:

        def again() -> None:
            session.go(route, variant=name)

        with ui.element("div").classes("bar-row"):
            variant_bar(session, route, name, again)
        _card(session, name, error, again)
        session.follow(lambda: session.project.state(name)[0], again)
        return None


def _card(session: Session, name: str, error: UnderfootError, mended: Callable[[], None]) -> None:
    """Show why a variant can't be read and, for each file it lacks, what would take its place."""
    text, project = session.text, session.project
    lacking = [reference for reference in references(project, name) if not reference.holds(project)]
    with ui.element("div").classes("answer-card repair").props('role="alert"'):
        ui.label(text("repair.title")).classes("strong")
        for each in lacking:
            _choices(session, name, each, mended)
        if not lacking:
            package_label(error.message).classes("soft")
            ui.label(text("repair.undo"))


def _choices(
    session: Session, name: str, reference: FileReference, mended: Callable[[], None]
) -> None:
    text, project = session.text, session.project
    path = reference.path(project)
    beside = sorted(each for each in path.parent.glob("[!.]*") if each.suffix == path.suffix)
    same = [each for each in beside if reference.sha256 and checksum(each) == reference.sha256]

    def take(file: Path) -> None:
        replace_file(project, name, reference, file)
        mended()

    async def take_drop(paths: list[str]) -> None:
        take(project.inside(paths[0]))

    ui.label(text("repair.lacks", file=path.name))
    with ui.element("div").classes("row"):
        for each in same:
            button = ui.button(text("repair.same", file=each.name), on_click=partial(take, each))
            button.props("no-caps unelevated")
        if path.is_file() and not same:
            button = ui.button(text("repair.present", file=path.name), on_click=partial(take, path))
            button.props("no-caps outline")
        other = [each.name for each in beside if each not in (*same, path)]
        if other:
            choice = ui.select(other, label=text("repair.other")).props("dense outlined")
            choice.on_value_change(lambda event: take(path.with_name(event.value)))
    drop_zone(
        session, path.parent.name, take_drop, label=text("repair.drop", file=path.name),
        accept=path.suffix,
    )  # fmt: skip
