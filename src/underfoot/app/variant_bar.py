"""The variant that is worked on: choose, copy, rename, remove, undo, redo."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from nicegui import ui

from underfoot.case.template import template
from underfoot.core.catalogue import Catalogue

from .session import Session

USUAL = {
    "shoe": "work_shoe_full_tread",
    "floor": "vinyl_g4",
    "contaminant": "glycerol_90pct",
    "motion": "slip_tester_g4",
}
"""Catalogue entries of a new variant: the best documented pair of the package."""


def no_variant(session: Session, route: str, example: Callable[[Session], None]) -> None:
    """Say that there is no variant, and offer an example to begin with and those removed."""
    ui.label(session.text("design.none")).classes("lead")
    begin = ui.button(session.text("design.begin"), on_click=lambda: example(session))
    begin.props("no-caps unelevated")
    for name in session.project.removed_variants():
        back = ui.button(
            session.text("variant.restore", name=name),
            on_click=partial(_back, session, name, route),
        )
        back.props("no-caps flat")


def new_variant(session: Session, wanted: str, **entries: str) -> str:
    """Write a variant made of catalogue entries and return its name."""
    name = session.project.free_name(wanted)
    catalogue = Catalogue.load()
    text = template(**{**USUAL, **entries}, catalogue=catalogue, name=name, file=f"{name}.toml")
    return session.project.add(name, text)


def variant_bar(session: Session, route: str, name: str, changed: Callable[[], None]) -> None:
    """Show the bar; ``changed`` is called after undo and redo."""
    text, project = session.text, session.project

    def go(to: str) -> None:
        session.go(route, variant=to)

    def step(move: Callable[[str], None]) -> None:
        move(name)
        changed()

    def remove() -> None:
        project.remove(name)
        ui.notify(text("variant.removed", name=name))
        go(next(iter(project.variants()), ""))

    with ui.element("div").classes("variant-bar"):
        choice = ui.select(project.variants(), value=name, label=text("variant.label"))
        choice.props('dense outlined options-dense translate="no"').classes("variant")
        choice.on_value_change(lambda event: go(event.value))
        for key, icon, action in (
            ("undo", "undo", lambda: step(project.undo)),
            ("redo", "redo", lambda: step(project.redo)),
        ):
            button = ui.button(icon=icon, on_click=action).props("flat round dense")
            button.props(f'aria-label="{text(f"variant.{key}")}" data-step={key}')
            button.tooltip(text(f"variant.{key}"))
        with ui.button(icon="more_horiz").props("flat round dense") as more:
            more.props(f'aria-label="{text("variant.more")}"')
            with ui.menu():
                ui.menu_item(
                    text("variant.new"), lambda: go(new_variant(session, text("variant.usual")))
                )
                ui.menu_item(text("variant.copy"), lambda: go(project.copy(name, name)))
                ui.menu_item(text("variant.rename"), lambda: _rename(session, route, name))
                ui.menu_item(text("variant.remove"), remove)
                for gone in project.removed_variants():
                    ui.menu_item(
                        text("variant.restore", name=gone), partial(_back, session, gone, route)
                    )


def _back(session: Session, name: str, route: str) -> None:
    session.project.restore(name)
    session.go(route, variant=name)


def _rename(session: Session, route: str, name: str) -> None:
    text = session.text
    with ui.dialog(value=True) as dialog, ui.card():
        dialog.props(f'aria-label="{text("variant.rename")}"')
        field = ui.input(text("variant.name"), value=name).props("autofocus")

        def rename_variant() -> None:
            dialog.close()
            session.go(route, variant=session.project.rename(name, (field.value or "").strip()))

        field.on("keydown.enter", rename_variant)
        with ui.element("div").classes("row"):
            ui.button(text("variant.rename"), on_click=rename_variant).props("no-caps unelevated")
            ui.button(text("frame.cancel"), on_click=dialog.close).props("no-caps flat")
