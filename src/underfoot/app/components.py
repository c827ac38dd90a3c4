"""Parts that several pages show: soles in 3-D, tables, a place for files, a progress line."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Mapping, Sequence
from functools import partial
from html import escape
from typing import Any

from nicegui import ui
from nicegui.events import GenericEventArguments

from underfoot.core.presentation import Part
from underfoot.core.remark import Message

from .jobs import INTERRUPTED, QueuedTask
from .labels import package_label
from .session import Session
from .text import as_json
from .uploads import MOST_BYTES


class SoleView(ui.element):
    """The 3-D viewer of the reports on a page; it keeps its place while the data change."""

    def __init__(self, session: Session) -> None:
        super().__init__("div")
        self._session = session
        self.classes("sole-view")
        for key in ("lugs", "file-lugs", "loading"):
            self.props(f'data-{key}="{escape(session.text(f"sole.{key}"))}"')

    def show(self, html: str) -> None:
        """Show what ``scene_section`` returned, from the answer of a computing process."""
        self.fetch(self._session.keep(html))

    def fetch(self, address: str) -> None:
        """Show the viewer at an address, where the view and the colour stay if they can."""
        ui.run_javascript(f"showSole({self.html_id!r}, {address!r})")


def title(heading: str, level: int = 1) -> ui.element:
    """Return a heading."""
    with ui.element(f"h{level}") as made:
        package_label(heading)
    return made


def sole_picture(session: Session, name: str) -> ui.element:
    """Return the small picture of the sole of a variant, fetched when it comes into view."""
    made = ui.element("img").classes("sole-picture").props('loading="lazy"')
    for key, words in session.picture(name).items():
        made.props(f'{key}="{escape(words)}"')
    return made


def folded_section(heading: str) -> ui.element:
    """Return a part of a page that is shown when its heading is clicked, and on paper."""
    with ui.element("details").classes("section") as made, ui.element("summary"):
        ui.label(heading)
    return made


SCALE_END = 0.8
"""COF at the end of the scale."""


def scale(marks: Sequence[tuple[str, str, float]], interval: Sequence[float] | None) -> None:
    """Show coefficients of friction on one scale: (kind, name, COF) of each, and an interval."""

    def place(cof: float) -> str:
        return f"{100 * min(max(cof / SCALE_END, 0.0), 1.0):.1f}%"

    names = "; ".join(f"{name}: {cof:.3f}" for _, name, cof in marks)
    with ui.element("div").classes("scale").props(f'role="img" aria-label="{escape(names)}"'):
        if interval:
            low, high = map(place, interval)
            ui.element("i").classes("reach").style(f"left: {low}; right: calc(100% - {high})")
        for kind, _, cof in marks:
            ui.element("i").classes(kind).style(f"left: {place(cof)}")
    with ui.element("ul").classes("scale-names"):
        for kind, name, cof in marks:
            with ui.element("li"):
                ui.element("i").classes(kind)
                ui.label(f"{name}: {cof:.3f}")


def table(
    shown: Mapping[str, Any],
    action: tuple[str, Callable[[int], object]] | None = None,
    rows: Sequence[int] = (),
) -> ui.element:
    """Return a table of text: ``title``, ``columns``, ``rows``; what of the sole its rows show.

    ``action``: name of a button at the end of ``rows``, and what is called with a row's number.
    """
    with ui.element("div").classes("wide") as made, ui.element("table"):
        if shown["title"]:
            with ui.element("caption"):
                package_label(shown["title"])
        if any(shown["columns"]):
            with ui.element("thead"), ui.element("tr"):
                for name in shown["columns"]:
                    with ui.element("th").props('scope="col"'):
                        package_label(name)
        with ui.element("tbody"):
            for place, row in enumerate(shown["rows"]):
                with ui.element("tr") as line:
                    if shown.get("shows"):
                        line.props(f"data-{shown['shows']}={place} tabindex=0")
                    for number, cell in enumerate(row):
                        part = isinstance(cell, Part)
                        with ui.element("td" if number else "th") as made_cell:
                            words = cell.label if part else cell
                            whole = isinstance(words, Message)  # no % alone on a line
                            package_label(words if whole else words.replace(" %", "\u00a0%"))
                        if not number:
                            made_cell.props('scope="row"').classes("part" * part)
                        if action and place in rows and number == len(row) - 1:
                            with made_cell:
                                button = ui.button(action[0], on_click=partial(action[1], place))
                                button.props("no-caps flat dense")
    return made


def sentences(lines: Sequence[str], kind: str = "") -> None:
    """Show sentences, a paragraph each."""
    for line in lines:
        package_label(line).classes(kind)


def drop_zone(
    session: Session,
    folder: str,
    on_files: Callable[[list[str]], Awaitable[None]],
    *,
    label: str,
    accept: str = "",
    multiple: bool = False,
) -> ui.element:
    """Return a place that takes files by drop or choice into ``folder`` of the project.

    ``on_files`` gets their paths in the project when all are there.
    """
    settings = {"folder": folder, "most": MOST_BYTES, "multiple": multiple, "accept": accept}
    zone = ui.element("div").classes("drop")
    zone.props(f'role="button" tabindex="0" aria-label="{label}"')
    with zone:
        ui.label(label)
        ui.label("").classes("soft drop-state").props('aria-live="polite"')

    async def take_files(event: GenericEventArguments) -> None:
        await on_files(list(event.args["detail"]["paths"]))

    zone.on("files", take_files, args=["detail"])
    messages = {key: session.text(f"files.{key}") for key in ("sending", "too_large", "failed")}
    ui.run_javascript(f"takeFiles({zone.html_id!r}, {as_json(settings)}, {as_json(messages)})")
    return zone


def task_line(
    session: Session, task: QueuedTask, done: Callable[[QueuedTask], Awaitable[None]]
) -> ui.element:
    """Return a line with the progress of a task and a button to stop it; ``done`` when it ended."""
    text = session.text
    with ui.element("div").classes("task").props('role="status"') as line:
        label = ui.label(task.title)
        bar = ui.linear_progress(0.0, show_value=False).props(f'aria-label="{task.title}"')
        stop = ui.button(text("jobs.stop"), on_click=lambda: session.jobs.cancel(task))
        stop.props("flat dense no-caps")

    async def look() -> None:
        state = task.stage if task.state == "running" else text(f"jobs.{task.state}")
        label.text = f"{task.title}: {state}"
        bar.value = task.fraction
        if not task.open:
            timer.deactivate()
            line.delete()
            await done(task)

    timer = ui.timer(0.1, look)
    return line


def interruption(session: Session, task: QueuedTask | None) -> None:
    """Say it where the end of the server has interrupted a task."""
    if task is not None and task.state == INTERRUPTED:
        message = f"{task.title}: {session.text('jobs.interrupted')}"
        ui.label(message).classes("caution").props('role="status"')


def show_refillable(fill: Callable[[Callable[..., Awaitable[None]]], None]) -> None:
    """Show what ``fill`` shows in a place of its own; awaiting what it is given shows it anew."""
    place = ui.element("div")

    async def again(_: QueuedTask | None = None) -> None:
        place.clear()
        with place:
            fill(again)

    with place:
        fill(again)
