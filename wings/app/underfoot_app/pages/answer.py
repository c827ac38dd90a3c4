"""The answer for a variant: friction with its interval, risk, the sole in 3-D, what would help."""

from __future__ import annotations

import json
import shutil
from functools import partial
from typing import Any

from nicegui import ui

from underfoot.case import Case
from underfoot.core.presentation import percent

from ..components import SoleView, sentences, table, task_line, title
from ..inputs import Input, sliders
from ..jobs import DONE, Task
from ..session import Session, address
from ..variant_bar import new_variant, no_variant, variant_bar

ROUTE = "/answer"
LIVE = (
    Input("motion.speed", "m/s", 0.05, 1.5, 0.01),
    Input("contaminant.viscosity", "cP", 0.5, 1000.0, 1.0, log=True),
    Input("shoe.wear.depth", "mm", 0.0, 4.0, 0.1),
    Input("shoe.material.shore_a", "", 45.0, 85.0, 1.0),
    Input("motion.normal_force", "N", 100.0, 900.0, 10.0),
)
"""Values that a preview can follow while they move."""
RUN, ADVICE = "underfoot_app.work:computed", "underfoot_app.work:advised"
TRIED = ".tried"
"""Folder of results that holds full runs behind previews until they are kept as a variant."""


def build(session: Session) -> None:
    """Show the variant's answer, computing it first where the address says so."""
    name = session.variant
    if name is None:
        no_variant(session, example)
    else:
        _Answer(session, name).show()


def example(session: Session) -> None:
    """Compute a worn work shoe on a floor with detergent."""
    wanted = session.text("answer.example")
    name = new_variant(session, wanted, shoe="work_shoe_half_tread", contaminant="detergent")
    session.go(ROUTE, variant=name, run="1")


class _Answer:
    """The page of one variant."""

    def __init__(self, session: Session, name: str) -> None:
        self.session, self.name, self.text = session, name, session.text
        self.case: Case = session.project.case(name)
        self.folder = session.project.result_folder(name)
        self.changes: dict[str, Any] = {}
        self.preview_cof = 0.0
        self.tried: Task | None = None

    def show(self) -> None:
        title(self.text("answer.title")).classes("hidden-title")
        with ui.element("div").classes("bar-row"):
            variant_bar(self.session, ROUTE, self.name, self._reload)
            ui.link(self.text("answer.to_design"), f"/design?variant={self.name}")
            ui.space()
            self.run_button = ui.button(
                self.text("design.run"), icon="play_arrow", on_click=self.run
            )
            self.run_button.props("no-caps unelevated").classes("main-action")
        self.progress = ui.element("div")
        self.place = ui.element("div")
        current = self._current()
        task = self.session.jobs.latest(self.name, RUN)
        if task is not None and task.open:
            self._follow(task)
        elif not current and self.session.query.get("run"):
            self.run()
        self._fill()

    def run(self) -> None:
        """Compute the variant as its file says."""
        arguments = (str(self.session.project.path(self.name)), str(self.folder))
        job = self.text("answer.job")
        task = self.session.jobs.submit(job, RUN, *arguments, about=self.name)
        self._follow(task)

    def _reload(self) -> None:
        self.session.go(ROUTE, variant=self.name)

    def _current(self) -> bool:
        """Return whether there is a result of what the file says now."""
        summary = self.session.project.summary(self.name)
        return summary is not None and summary.case_hash == self.case.hash

    def _follow(self, task: Task) -> None:
        self.run_button.disable()

        async def ended(done: Task) -> None:
            self.run_button.enable()
            if done.problem:
                with self.progress:
                    ui.label(done.problem).classes("problem problem-what").props('role="alert"')
            if done.state == DONE:
                path = str(self.session.project.path(self.name))
                arguments = (self.text("answer.help_job"), ADVICE, path, str(self.folder))
                self.session.jobs.submit(*arguments, about=self.name)
                self._fill()

        self.progress.clear()
        with self.progress:
            task_line(self.session, task, ended)

    def _fill(self) -> None:
        self.place.clear()
        if self.session.project.summary(self.name) is None:
            with self.place:
                ui.label(self.text("answer.not_yet")).classes("lead")
            return
        with self.place:
            with ui.element("div").classes("split"):
                side = ui.element("section").classes("side")
                with ui.element("section").classes("stage-side"):
                    self.view = SoleView(self.session)
            self.tables = ui.element("section").classes("whole")
        with side:
            if not self._current():
                ui.label(self.text("answer.changed")).classes("caution")
            self.summary = ui.element("div").props('aria-live="polite"')
            beside = self.session.query.get("beside", "")
            if beside in self.session.project.variants():
                label = self.text("answer.beside", name=beside)
                pair = address("/compare", variants=f"{beside}|{self.name}")
                ui.link(label, pair).classes("strong")
            self._live()
            self.help = ui.element("div")
        with self.place:
            ui.timer(0, self._answer, once=True)
            self.helped = ui.timer(1.0, self._helps)
        self._helps()

    async def _answer(self) -> None:
        answer = await self.session.ask("underfoot_app.work:answer", str(self.folder))
        self.view.show(answer["html"])
        with self.summary:
            self._headline(answer)
        with self.tables:
            self._tables(answer)
        if self._current():  # the march from which previews go on
            path = str(self.session.project.path(self.name))
            await self.session.ask("underfoot_app.work:previewed", path, {})

    def _headline(self, answer: dict[str, Any]) -> None:
        with ui.element("div").classes("answer-card"):
            if answer["usable"]:
                ui.label(self.text("answer.cof")).classes("soft")
                ui.label(f"{answer['cof']:.3f}").classes("big")
                if answer["interval"]:
                    low, high = (f"{end:.3f}" for end in answer["interval"])
                    ui.label(self.text("answer.interval", low=low, high=high))
                if answer["slip"] is not None:
                    ui.label(self._risk(answer["slip"])).classes("strong")
                ui.label(answer["limit"]).classes("soft")
            else:
                sentences(answer["headline"], "strong")
        for caution in answer["cautions"]:
            ui.label(caution).classes("caution")

    def _tables(self, answer: dict[str, Any]) -> None:
        sentences(answer["headline"])
        for shown in answer["tables"]:
            table(shown)
        for heading, lines in answer["remarks"].items():
            with ui.expansion(heading).classes("plain"):
                sentences(lines, "soft")
        report = self.session.project.folder.name
        ui.label(self.text("answer.files", folder=f"{report}/results/{self.name}")).classes("soft")

    def _risk(self, probability: float) -> str:
        """Return how often a person slips, as people say it."""
        if probability < 1e-3:
            return self.text("answer.risk_rare")
        if probability < 0.2:
            return self.text("answer.risk_odds", count=f"{1 / probability:.0f}")
        return self.text("answer.risk", share=percent(probability))

    # previews

    def _live(self) -> None:
        title(self.text("answer.live"), 2)
        ui.label(self.text("answer.live_lead")).classes("soft")
        with ui.element("div").classes("answer-card live-answer"):
            for name in ("preview", "preview_note"):
                kind = "strong" if name == "preview" else "soft"
                ui.label("").classes(kind).props(f'data-live={name} aria-live="polite"')
            self.behind = ui.element("div")
        sliders(self.session, LIVE, self.case, self._moved, self._rested, self.view, keep=False)

    async def _moved(self, changes: dict[str, Any]) -> dict[str, Any]:
        path = str(self.session.project.path(self.name))
        answer = await self.session.ask("underfoot_app.work:previewed", path, changes)
        self.preview_cof = answer["cof"]
        cof, error = f"{answer['cof']:.3f}", f"{answer['error']:.3f}"
        load, slip = answer["fluid_load"], answer["slip"]
        message = {
            "preview": self.text("answer.preview", cof=cof, error=error, fluid_load=load),
            "preview_note": "" if slip is None else self._risk(slip),
        }
        return {"texts": message, "html": answer["html"]}

    def _rested(self, changes: dict[str, Any]) -> None:
        """Start the full run of what the preview shows; give an earlier one up."""
        path = str(self.session.project.path(self.name))
        self.changes = changes
        jobs = self.session.jobs
        if self.tried is not None and self.tried.open:
            jobs.cancel(self.tried)
        folder = str(self.session.project.inside("results", TRIED, self.name))
        arguments = (path, folder, self.changes)
        self.tried = jobs.submit(
            self.text("answer.full"),
            RUN,
            *arguments,
            about=f"{self.name} ({self.text('answer.live')})",
        )
        self.behind.clear()

        async def ended(done: Task) -> None:
            if done is not self.tried or done.state != DONE or done.answer is None:
                return
            answer = await self.session.ask("underfoot_app.work:answer", folder)
            self.view.show(answer["html"])
            off = 100 * (done.answer / self.preview_cof - 1) if self.preview_cof else 0.0
            self.behind.clear()
            with self.behind:
                cof, before = f"{done.answer:.3f}", f"{self.preview_cof:.3f}"
                message = self.text("answer.replaced", cof=cof, preview=before, off=f"{off:+.1f}")
                ui.label(message).classes("strong")
                keep = ui.button(self.text("answer.keep"), on_click=lambda: self._keep(folder))
                keep.props("no-caps outline")

        with self.behind:
            task_line(self.session, self.tried, ended)

    def _keep(self, folder: str) -> None:
        project = self.session.project
        new = project.copy(self.name, self.name, self.changes)
        shutil.move(folder, project.result_folder(new))
        self.session.go(ROUTE, variant=new)

    # what would help

    def _helps(self) -> None:
        try:
            stored = json.loads((self.folder / "risk.json").read_text(encoding="utf-8"))
        except (OSError, ValueError):
            task = self.session.jobs.latest(self.name, ADVICE)
            self.help.clear()
            if task is not None and task.open:
                with self.help:
                    ui.label(self.text("answer.help_waits")).classes("soft")
            else:
                self.helped.deactivate()
            return
        self.helped.deactivate()
        self.help.clear()
        computed = [each for each in stored["changes"] if each["cof"] is not None]
        computed.sort(key=lambda each: each["slip_probability"])
        present = stored["slip_probability"]["value"]
        better = [each for each in computed if each["slip_probability"] < present]
        with self.help:
            title(self.text("answer.help"), 2)
            for each in better:
                with ui.element("div").classes("help"):
                    ui.label(self._change(each, stored))
                    make = ui.button(self.text("answer.make"), on_click=partial(self._make, each))
                    make.props("no-caps flat dense")
            if not better:
                ui.label(self.text("answer.no_help"))
            rest = [self._change(each, stored) for each in computed if each not in better]
            for each in stored["changes"]:
                if each["cof"] is None:
                    message = {"action": _capital(each["action"]), "reason": each["reason"]}
                    rest.append(self.text("answer.not_computed", **message))
            if rest:
                with ui.expansion(self.text("answer.tried")).classes("soft"):
                    for message in rest:
                        ui.label(message).classes("soft")

    def _change(self, each: dict[str, Any], now: dict[str, Any]) -> str:
        slip = now["slip_probability"]["value"]
        message = self.text(
            "answer.change",
            action=_capital(each["action"]),
            now=f"{now['cof']['value']:.3f}",
            cof=f"{each['cof']:.3f}",
            before=percent(slip),
            after=percent(each["slip_probability"]),
        )
        return message.replace(" %", "\u00a0%")  # a narrow column must not part number and unit

    def _make(self, each: dict[str, Any]) -> None:
        wanted = f"{self.name}, {each['name'].replace('_', ' ')}"
        new = self.session.project.copy(self.name, wanted, each["values"])
        self.session.go(ROUTE, variant=new, run="1", beside=self.name)


def _capital(sentence: str) -> str:
    return sentence[:1].upper() + sentence[1:]
