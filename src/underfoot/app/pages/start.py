"""The first page: three doors, each with a worked example, and what was worked on last."""

from __future__ import annotations

from nicegui import ui

from ..components import sole_picture, title
from ..session import Session, address

MOST_RECENT = 8
KEPT = "path=/; max-age=31536000; SameSite=Strict"
TOUR = ("doors", "sole", "compute", "live", "files")
"""Steps of the first-run tour, by the keys of their words."""


def build(session: Session) -> None:
    """Show the doors that have pages, and the recent work."""
    text = session.text
    title(text("start.title")).classes("hidden-title")
    ui.label(text("start.lead")).classes("lead")
    doors = dict.fromkeys(page.door for page in session.pages if page.door)
    with ui.element("div").classes("doors"):
        for door in doors:
            _door(session, door)
    recent = ui.element("div")

    def show() -> None:
        recent.clear()
        with recent:
            _recent(session)

    show()
    project = session.project
    session.follow(lambda: [(name, *project.state(name)) for name in project.variants()], show)
    with ui.element("div").classes("row"):
        _tour(session)
        _pack(session)


def _door(session: Session, door: str) -> None:
    text = session.text
    pages = [page for page in session.pages if page.door == door]
    with ui.element("section").classes("door"):
        title(text(f"doors.{door}"), 2)
        ui.label(text(f"doors.{door}_lead")).classes("soft")
        example = next((page.example for page in pages if page.example), None)
        if example is not None:
            button = ui.button(text("start.example"), icon="play_arrow")
            button.props("no-caps unelevated").on_click(lambda: example(session))
        with ui.element("div").classes("row"):
            for page in pages:
                ui.link(text(page.title), page.route)


def _recent(session: Session) -> None:
    text, project = session.text, session.project
    interrupted = [task for task in session.jobs.tasks.values() if task.state == "interrupted"]
    if interrupted:
        names = list(dict.fromkeys(task.about for task in interrupted if task.about))
        about = ", ".join(names[:MOST_RECENT]) + " …" * (len(names) > MOST_RECENT)
        ui.label(text("start.interrupted", about=about)).classes("caution")
    recent = project.variants()[:MOST_RECENT]
    if not recent:
        return
    title(text("start.recent"), 2)
    with ui.element("div").classes("recent"):
        for name in recent:
            summary = project.summary(name)
            with ui.element("div").classes("recent-row"):
                ui.link(name, address("/design", variant=name)).props('translate="no"')
                sole_picture(session, name)
                if summary is None or summary.cof is None:
                    ui.label(text("start.not_computed")).classes("soft")
                    continue
                words = text("start.cof", cof=f"{summary.cof:.3f}")
                if summary.low is not None and summary.high is not None:
                    words += f" ({summary.low:.3f} – {summary.high:.3f})"
                ui.link(words, address("/answer", variant=name))
                if not project.is_current(name):
                    ui.label(text("start.changed")).classes("soft")


def _pack(session: Session) -> None:
    """Offer the project as a ZIP, beside what computes."""

    async def pack_project() -> None:
        button.disable()
        folder = str(session.project.folder)
        task = session.submit(text("start.pack"), "underfoot.app.work:zipped", folder)
        await session.jobs.wait_for(task)
        button.enable()
        if task.answer:
            ui.download.file(task.answer)

    text = session.text
    ui.link(text("project.title"), "/project")
    button = ui.button(text("start.pack"), icon="archive", on_click=pack_project).props(
        "no-caps flat"
    )


def _tour(session: Session) -> None:
    """Offer the tour; it opens by itself once, where the project is new."""
    text = session.text
    with ui.dialog() as dialog, ui.card().classes("tour"), ui.stepper() as steps:
        dialog.props(f'aria-label="{text("tour.open")}"')
        steps.props("flat animated header-nav alternative-labels")
        for number, key in enumerate(TOUR):
            with ui.step(key, title=text(f"tour.{key}")):
                ui.label(text(f"tour.{key}_words"))
                with ui.stepper_navigation():
                    last = number == len(TOUR) - 1
                    forward = dialog.close if last else steps.next
                    name = text("tour.begin") if last else text("tour.next")
                    ui.button(name, on_click=forward).props("no-caps unelevated")
                    ui.button(text("tour.skip"), on_click=dialog.close).props("no-caps flat")
    ui.button(text("tour.open"), icon="help_outline", on_click=dialog.open).props("no-caps flat")
    request, project = ui.context.client.request, session.project
    new = not project.variants() and not project.removed_variants()
    if new and (request is None or "toured" not in request.cookies):
        dialog.open()
        ui.run_javascript(f'document.cookie = "toured=1; {KEPT}"')
