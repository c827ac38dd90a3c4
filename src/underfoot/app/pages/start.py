"""The first page: three doors, each with a worked example, and what was worked on last."""

from __future__ import annotations

from nicegui import ui

from ..session import Session


def build(session: Session) -> None:
    """Show the doors that have pages, and the recent work."""
    text = session.text
    ui.label(text("start.lead")).classes("lead")
    doors = dict.fromkeys(page.door for page in session.pages if page.door)
    with ui.element("div").classes("doors"):
        for door in doors:
            pages = [page for page in session.pages if page.door == door]
            with ui.element("section").classes("door"):
                ui.element("h2").props(f'innerHTML="{text(f"doors.{door}")}"')
                ui.label(text(f"doors.{door}_lead")).classes("soft")
                for page in pages:
                    ui.link(text(page.title), page.route)
