"""Design a variant: sole, floor, spill, motion, and what is assumed of them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from time import monotonic
from typing import Any

from nicegui import ui

from underfoot.case import Case
from underfoot.case.compose import DRY
from underfoot.case.sole import TreadPattern, usual_tread
from underfoot.core.errors import UnderfootError

from ..components import SoleView, title
from ..inputs import GROOVES, Input, Slider, grooves_of, number_field, sliders
from ..session import Session
from ..text import as_json
from ..variant_bar import new_variant, no_variant, variant_bar
from . import assumptions, measured_file, repair, sole_file
from .answer import begin_run

ROUTE = "/design"
TREAD = (
    Slider("shoe.tread.lug_width", "mm", 2.0, 20.0, 0.1),
    Slider("shoe.tread.lug_length", "mm", 2.0, 40.0, 0.1),
    Slider("shoe.tread.channel_width", "mm", 1.0, 10.0, 0.1),
    Slider("shoe.tread.depth", "mm", 0.5, 8.0, 0.1),
    Slider("shoe.tread.arm_length", "mm", 4.0, 40.0, 0.5),
    Slider("shoe.tread.wave_length", "mm", 8.0, 60.0, 1.0),
    Slider("shoe.tread.wave_height", "mm", 1.0, 20.0, 0.5),
    Slider("shoe.tread.ring_width", "mm", 1.0, 10.0, 0.1),
    Slider("shoe.tread.front_lug_width", "mm", 2.0, 20.0, 0.1),
    Slider("shoe.tread.graded_length", "mm", 10.0, 200.0, 5.0),
    Slider("shoe.tread.angle", "deg", -90.0, 90.0, 1.0),
    Slider("shoe.tread.edge_radius", "mm", 0.0, 2.0, 0.05),
    Slider("shoe.tread.edge_chamfer", "mm", 0.0, 2.0, 0.05),
    Slider("shoe.tread.sipes.width", "mm", 0.2, 2.0, 0.1),
    Slider("shoe.tread.sipes.depth", "mm", 0.5, 8.0, 0.1),
    Slider("shoe.tread.sipes.spacing", "mm", 1.0, 20.0, 0.5),
    Slider("shoe.heel.profile.angle", "deg", 0.0, 30.0, 0.5),
    Slider("shoe.heel.profile.length", "mm", 1.0, 60.0, 0.5),
    Slider("shoe.material.shore_a", "", 40.0, 90.0, 1.0),
    Slider("shoe.wear.depth", "mm", 0.0, 6.0, 0.1),
)
LAYERS = (
    Input("shoe.sole.outsole_thickness", "mm"),
    Input("shoe.sole.midsole.thickness", "mm"),
    Input("shoe.sole.midsole.modulus", "MPa"),
    Input("shoe.roughness.ra", "um"),
    Input("shoe.roughness.rq", "um"),
)
"""What carries the tread, and the surface of the rubber."""
MIDSOLE = {"shoe.sole.midsole": {"modulus": "2 MPa", "thickness": "15 mm"}}
"""Foam under the outsole as ``underfoot outsole inspect`` assumes it."""
CONDITIONS = {
    "floor": (
        Input("floor.roughness.rq", "um"),
        Input("floor.roughness.ra", "um"),
    ),
    "contaminant": (Input("contaminant.viscosity", "cP"),),
    "motion": (
        Input("motion.speed", "m/s"),
        Input("motion.normal_force", "N"),
        Input("motion.shoe_angle", "deg"),
        Input("risk.rcof_mean", ""),
    ),
}
"""Values of each part of the conditions that a person may set, beside its catalogue entry."""
HELD = 0.8
"""s after a slider was moved in which the form is not built anew."""
KINDS = {"floor": "floor", "contaminant": "fluid", "motion": "setup"}
"""Kind of catalogue entry of each part."""


def build(session: Session) -> None:
    """Show the variant's form beside its sole."""
    name = session.variant
    if name is None:
        no_variant(session, ROUTE, example)
    elif repair.open_variant(session, ROUTE, name) is not None:
        _Design(session, name).show()


def example(session: Session) -> None:
    """Open a work shoe on a wet floor."""
    name = new_variant(session, session.text("design.example"))
    session.go(ROUTE, variant=name)


class _Design:
    """The page of one variant; parts are filled anew after a change."""

    def __init__(self, session: Session, name: str) -> None:
        self.session, self.name, self.text = session, name, session.text
        self.moved = 0.0

    def show(self) -> None:
        title(self.text("design.title")).classes("hidden-title")
        with ui.element("div").classes("bar-row"):
            variant_bar(self.session, ROUTE, self.name, self.fill)
            ui.space()
            run = ui.button(self.text("design.run"), icon="play_arrow", on_click=self.run)
            run.props("no-caps unelevated").classes("main-action")
        with ui.element("div").classes("split"):
            with ui.element("section").classes("side"):
                parts = ("sole", "floor", "contaminant", "motion", "assumptions")
                with ui.tabs().props("dense no-caps align=left") as tabs:
                    made = [ui.tab(part, label=self.text(f"design.{part}")) for part in parts]
                with ui.tab_panels(tabs, value=made[0], animated=False).props("keep-alive"):
                    self.places = {}
                    for part, tab in zip(parts, made, strict=True):
                        with ui.tab_panel(tab) as panel:
                            self.places[part] = panel
            with ui.element("section").classes("stage-side"):
                ui.label("").props('data-live=measures role="status"').classes("soft measures")
                self.view = SoleView(self.session)
        self.shown = self.session.follow(
            lambda: self.session.project.state(self.name)[0],
            self.fill,
            busy=lambda: monotonic() - self.moved < HELD,
        )
        self.fill()

    def fill(self) -> None:
        """Fill the form from the file of the variant, and draw its sole."""
        try:
            case = self.session.project.case(self.name)
        except UnderfootError:  # removed or made unreadable by another page or program
            self.session.go(ROUTE, variant=self.name)
            return
        self.shown()
        for part, place in self.places.items():
            place.clear()
            with place:
                if part == "sole":
                    self._sole(case)
                elif part == "assumptions":
                    assumptions.build(self.session, self.name)
                else:
                    self._condition(part, case)
        self.draw()

    def draw(self) -> None:
        """Draw the sole of the file."""

        async def draw_first() -> None:
            answer = await self._draw({})
            self.session.jobs.warm()
            self.view.show(answer["html"])
            ui.run_javascript(f"showTexts({as_json(answer['texts'])})")

        ui.timer(0, draw_first, once=True)

    def change(self, changes: dict[str, Any]) -> None:
        """Change the file of the variant and what is shown of it."""
        self.session.project.change(self.name, changes)
        self.fill()

    def run(self) -> None:
        """Compute the variant and open its answer."""
        begin_run(self.session, self.name)
        self.session.go("/answer", variant=self.name)

    def _sole(self, case: Case) -> None:
        if case.shoe.outsole is not None:
            file = Path(case.shoe.outsole.file).name
            ui.label(self.text("design.from_file", file=file)).classes("strong")
        shoes = self._entries("shoe", case.catalogue)
        self._choice("shoe", shoes, case.entries.get("shoe"))
        if case.shoe.tread is not None:
            patterns = {name: self.text(f"patterns.{name}") for name in TreadPattern.options()}
            pattern = ui.select(patterns, label=self.text("design.pattern"))
            pattern.value = case.value("shoe.tread.pattern")
            pattern.props("dense outlined options-dense")
            pattern.on_value_change(lambda event: self.change(self._pattern_changes(event.value)))
        self._choice(
            "shoe.material",
            self._entries("material", case.catalogue),
            case.entries.get("shoe.material"),
        )
        if case.value("shoe.tread.depth") and case.value("shoe.tread.sipes.width") is None:
            sipes = ui.button(self.text("sole.sipes"), on_click=lambda: self.change(_sipes(case)))
            sipes.props("no-caps flat dense")
        if grooves := grooves_of(case):
            fewer = {GROOVES: grooves[:-1] or None}
            label = self.text("sole.grooves", count=len(grooves))
            last = ui.button(label, on_click=lambda: self.change(fewer))
            last.props("no-caps flat dense")
        sliders(self.session, TREAD, case, self._moving, self._keep, self.view, keep=True)
        for each in LAYERS:
            number_field(self.session, each, case, self.change)
        if case.value("shoe.sole.midsole") is None:
            midsole = ui.button(self.text("sole.midsole"), on_click=lambda: self.change(MIDSOLE))
            midsole.props("no-caps flat dense")
        ui.separator()
        sole_file.build(self.session, self.name, self.view, self.fill)
        measured_file.build(self.session, self.name, "sole", self.fill)

    def _pattern_changes(self, pattern: str) -> dict[str, Any]:
        """Return a pattern with what it lacks, or with all of its own where lugs don't suit it."""
        case = self.session.project.case(self.name)
        usual = {f"shoe.tread.{key}": value for key, value in usual_tread(pattern).items()}
        changes: dict[str, Any] = {"shoe.tread.pattern": pattern}
        lacking = {path: value for path, value in usual.items() if case.value(path) is None}
        try:
            case.replace(changes | lacking)
        except UnderfootError:  # such as walls of rings thicker than half a lug
            return changes | usual
        return changes | lacking

    def _keep(self, changes: dict[str, Any]) -> None:
        self.moved = 0.0
        self.shown(lambda: self.session.project.change(self.name, changes))

    async def _moving(self, changes: dict[str, Any]) -> dict[str, Any]:
        self.moved = monotonic()  # a slider that is held is not taken away
        return await self._draw(changes)

    async def _draw(self, changes: dict[str, Any]) -> dict[str, Any]:
        path = str(self.session.project.path(self.name))
        answer = await self.session.ask("underfoot.app.work:sole", path, changes)
        measures = self.text("design.measures", **answer["measures"])
        return {"html": answer["html"], "texts": {"measures": measures}}

    def _condition(self, part: str, case: Case) -> None:
        entries = self._entries(KINDS[part], case.catalogue)
        present = case.entries.get(part)
        if part == "contaminant":
            entries = {DRY: self.text("design.dry"), **entries}
            present = DRY if case.contaminant is None else present
        self._choice(part, entries, present)
        for each in CONDITIONS[part]:
            number_field(self.session, each, case, self.change)
        measured_file.build(self.session, self.name, part, self.fill)

    def _choice(self, part: str, entries: dict[str, str], present: str | None) -> None:
        choice = ui.select(entries, label=self.text(f"design.choose_{part.replace('.', '_')}"))
        choice.value = present if present in entries else None
        choice.props("dense outlined options-dense")
        choice.on_value_change(lambda event: self.change({part: event.value}))

    def _entries(self, kind: str, catalogue: Any) -> dict[str, str]:
        """Return title by name of the entries that can stand in a case."""
        names: Sequence[str] = catalogue.names(kind)
        if kind == "setup":
            entries = (catalogue.entry(kind, name) for name in names)
            names = [entry.name for entry in entries if any("motion." in p for p in entry.values)]
        return {name: catalogue.entry(kind, name).title for name in names}


def _sipes(case: Case) -> dict[str, str]:
    """Return sipes as changes of a case: 0.8 mm wide, across the shoe, a lug and channel apart."""
    lug, channel = (case.value(f"shoe.tread.{name}_width") for name in ("lug", "channel"))
    along = case.value("shoe.tread.lug_length") or lug
    lengths = {
        "width": 0.8e-3,
        "depth": 0.75 * case.value("shoe.tread.depth"),
        "spacing": along + channel,
    }
    return {f"shoe.tread.sipes.{name}": f"{1e3 * v:.4g} mm" for name, v in lengths.items()}
