"""The answer for a variant: friction with its interval, risk, the sole in 3-D, what would help."""

from __future__ import annotations

import json
import shutil
from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any

from nicegui import ui

from underfoot.case import Case
from underfoot.core.errors import UnderfootError
from underfoot.core.presentation import is_wide, percent, probability_text

from ..components import (
    SoleView,
    folded_section,
    interruption,
    scale,
    sentences,
    table,
    task_line,
    title,
)
from ..inputs import Slider, sliders
from ..jobs import DONE, QueuedTask
from ..labels import package_label
from ..session import Session, address, problem_parts
from ..variant_bar import new_variant, no_variant, variant_bar
from . import repair, wear

ROUTE = "/answer"
LIVE = (
    Slider("motion.speed", "m/s", 0.05, 1.5, 0.01),
    Slider("contaminant.viscosity", "cP", 0.5, 1000.0, 1.0, log=True),
    Slider("shoe.wear.depth", "mm", 0.0, 4.0, 0.1),
    Slider("shoe.material.shore_a", "", 45.0, 85.0, 1.0),
    Slider("motion.normal_force", "N", 100.0, 900.0, 10.0),
    Slider("motion.shoe_angle", "deg", 0.0, 20.0, 0.5),
    Slider("shoe.tread.lug_width", "mm", 2.0, 20.0, 0.1),
    Slider("shoe.tread.channel_width", "mm", 1.0, 10.0, 0.1),
    Slider("shoe.tread.depth", "mm", 0.5, 8.0, 0.1),
)
"""Values that a preview follows while they move; of another tread the full run answers."""
RUN, ADVICE = "underfoot.app.work:computed", "underfoot.app.work:advised"
GROOVE = "underfoot.app.work_sole:advised_groove"
TRIED = ".tried"
"""Folder of results that holds full runs behind previews until they are kept as a variant."""


def build(session: Session) -> None:
    """Show the variant's answer."""
    name = session.variant
    if name is None:
        no_variant(session, ROUTE, example)
    elif (case := repair.open_variant(session, ROUTE, name)) is not None:
        _Answer(session, name, case).show()


def begin_run(session: Session, name: str, *, later: bool = False) -> QueuedTask:
    """Queue the full run of a variant as its file says; one of these inputs is taken as it is.

    It comes before those that wait, and what would help follows it; not so one of many (``later``).
    """
    project, job = session.project, session.text("answer.job")
    task = session.jobs.latest(name, RUN)
    if task is not None and task.open:
        if not task.began or project.path(name).stat().st_mtime <= task.began:
            return task
        session.jobs.cancel(task)  # the file has changed since it began
    arguments = str(project.path(name)), str(project.result_folder(name))
    if later:
        return session.submit(job, RUN, *arguments, about=name)
    help_job = (session.text("answer.help_job"), ADVICE, *arguments)
    return session.submit(job, RUN, *arguments, about=name, then=help_job, first=True)


def example(session: Session) -> None:
    """Compute a worn work shoe on a floor with detergent."""
    wanted = session.text("answer.example")
    name = new_variant(session, wanted, shoe="work_shoe_half_tread", contaminant="detergent")
    begin_run(session, name)
    session.go(ROUTE, variant=name)


class _Answer:
    """The page of one variant."""

    def __init__(self, session: Session, name: str, case: Case) -> None:
        self.session, self.name, self.text = session, name, session.text
        self.case = case
        self.folder = session.project.result_folder(name)
        self.changes: dict[str, Any] = {}
        self.preview_cof = 0.0
        self.tried: QueuedTask | None = None

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
        task = self.session.jobs.latest(self.name, RUN)
        if task is not None and task.open:
            self._follow(task)
        elif not self.session.project.is_current(self.name):
            with self.progress:
                interruption(self.session, task)
        self._fill()
        self.session.follow(lambda: self.session.project.state(self.name), self._reload)

    def run(self) -> None:
        """Compute the variant as its file says."""
        self._follow(begin_run(self.session, self.name))

    def _reload(self) -> None:
        self.session.go(ROUTE, **{**self.session.query, "variant": self.name})

    def _follow(self, task: QueuedTask) -> None:
        self.run_button.disable()

        async def show_end(done: QueuedTask) -> None:
            self.run_button.enable()
            with self.progress:
                _alert(done.problem)
            if done.state == DONE:
                self._reload()

        self.progress.clear()
        with self.progress:
            task_line(self.session, task, show_end)

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
        current = self.session.project.is_current(self.name)
        with side:
            if not current:
                ui.label(self.text("answer.changed")).classes("caution")
            self.verdict = ui.element("div").classes("verdict-place").props('aria-live="polite"')
            self.summary = ui.element("div").classes("number-place").props('aria-live="polite"')
            self.reasons = ui.element("div")
            beside = self.session.query.get("beside", "")
            if beside in self.session.project.variants():
                label = self.text("answer.beside", name=beside)
                pair = address("/compare", variants=f"{beside}|{self.name}")
                ui.link(label, pair).classes("strong")
            self.help = ui.element("div")
            if current:
                self._live()
                if self.case.value("shoe.tread.depth") or self.case.shoe.outsole is not None:
                    wear.build(self.session, self.name)
        if not current:  # what was computed is of other inputs than the file's
            for part in (self.verdict, self.summary, self.reasons, self.view, self.tables):
                part.classes("stale")
        with self.place:
            ui.timer(0, partial(self._answer, current), once=True)
        if current:
            with self.place:
                self.helped = ui.timer(1.0, self._helps)
            self._helps()

    async def _answer(self, current: bool) -> None:
        answer = await self.session.ask("underfoot.app.work:answer", str(self.folder))
        self.view.show(answer["html"])
        self._headline(answer, current)
        with self.tables:
            self._tables(answer, current)
        if current:  # the march from which previews go on
            path = str(self.session.project.path(self.name))
            await self.session.ask("underfoot.app.work:previewed", path, str(self.folder), {})

    def _headline(self, answer: dict[str, Any], current: bool) -> None:
        """Show the verdict, then number and interval, then a shoe that one knows, then why."""
        if not answer["usable"]:
            with self.summary, ui.element("div").classes("answer-card"):
                sentences(answer["headline"], "strong")
            return
        with self.verdict:
            if answer["slip"] is not None:
                word = answer["verdict"]
                with ui.element("p").classes(f"verdict {word}"):
                    ui.html(f"<b>{self.text(f'answer.{word}')}</b>", sanitize=False, tag="span")
                    ui.label(self._risk(answer)).classes("strong")
        with self.summary:
            with ui.element("div").classes("answer-card"):
                if current:
                    ui.label(self.text("answer.under", **self._under())).classes("soft")
                ui.label(self.text("answer.cof")).classes("soft")
                ui.label(f"{answer['cof']:.3f}").classes("big")
                if answer["interval"]:
                    low, high = (f"{end:.3f}" for end in answer["interval"])
                    ui.label(self.text("answer.interval", low=low, high=high))
            cautions = list(answer["cautions"])
            if not (self.folder / "report.html").exists():
                cautions.insert(0, self.text("answer.no_report"))
            for caution in cautions:
                package_label(caution).classes("caution")
        with self.reasons, ui.element("div").classes("answer-card"):
            self.beside = ui.element("div")
            self._beside(answer)
            package_label(answer["limit"]).classes("soft")

    def _under(self) -> dict[str, str]:
        """Return floor and contaminant of what was computed, which no name of a variant tells."""
        under = {}
        for part, (entry, changed) in conditions(self.case).items():
            shown = entry or self.text("origin.given" if changed else "design.dry")
            altered = entry and changed
            under[part] = self.text("answer.changed_entry", title=shown) if altered else shown
        return under

    def _beside(self, answer: dict[str, Any]) -> None:
        """Show the COF on a scale with what walkers need and a shoe that the person knows."""
        project = self.session.project
        computed = [
            result.name for result in project.results() if result.cof and result.name != self.name
        ]
        known = project.known if project.known in computed else None
        marks = [("here", self.text("answer.here"), answer["cof"])]
        if (needed := self.case.value("risk.rcof_mean")) is not None:
            marks.append(("needed", self.text("answer.needed"), needed))
        if known and (summary := project.summary(known)) and summary.cof:
            marks.append(("known", known, summary.cof))
        self.beside.clear()
        with self.beside:
            scale(marks, answer["interval"])
            if not computed:
                return
            choice = ui.select(computed, label=self.text("answer.known"), value=known)
            choice.props("dense outlined options-dense clearable")

            def show_choice() -> None:
                project.known = choice.value
                self._beside(answer)

            choice.on_value_change(show_choice)
            if known:
                pair = address("/compare", variants=f"{known}|{self.name}")
                ui.link(self.text("answer.how_sure"), pair)

    def _tables(self, answer: dict[str, Any], current: bool) -> None:
        with folded_section(self.text("answer.in_words")):
            sentences(answer["headline"])
        cut = (self.text("answer.cut"), self._cut) if current and self.case.shoe.tread else None
        for shown in answer["tables"]:
            with folded_section(shown["title"]):
                untitled = {**shown, "title": ""}
                table(untitled, cut, answer["advised"] if shown["shows"] == "lug" else ())
        for heading, lines in answer["remarks"].items():
            with folded_section(heading):
                sentences(lines, "soft")
        report = self.session.project.folder.name
        ui.label(self.text("answer.files", folder=f"{report}/results/{self.name}")).classes("soft")

    async def _cut(self, lug: int) -> None:
        """Cut the groove that is advised for a lug into the file, and compute anew."""
        path = str(self.session.project.path(self.name))
        changes = await self.session.ask(GROOVE, path, str(self.folder), lug)
        self.session.project.change(self.name, changes)
        self.run()

    def _risk(self, answer: Mapping[str, Any]) -> str:
        """Return how often a person slips, as people say it, with how unsure that is."""
        probability, interval = answer["slip"], answer["slip_interval"]
        low, high = map(probability_text, interval or (0.0, 0.0))
        if is_wide(interval):
            words = self.text("answer.risk_unknown", low=low, high=high)
        else:
            if probability < 1e-3:
                words = self.text("answer.risk_rare")
            elif probability < 0.2:
                words = self.text("answer.risk_odds", count=f"{1 / probability:.0f}")
            else:
                words = self.text("answer.risk", share=percent(probability))
            if interval:
                words += f" ({self.text('answer.interval', low=low, high=high)})"
        return words + self._extrapolation_note(answer)

    def _extrapolation_note(self, answer: Mapping[str, Any]) -> str:
        return f" ({self.text('answer.extrapolated')})" if answer.get("extrapolated") else ""

    # previews

    def _live(self) -> None:
        title(self.text("answer.live"), 2)
        ui.label(self.text("answer.live_lead")).classes("soft")
        with ui.element("div").classes("answer-card live-answer"):
            for name in ("preview", "preview_note"):
                kind = "strong" if name == "preview" else "soft"
                ui.label("").classes(kind).props(f'data-live={name} aria-live="polite"')
            self.behind = ui.element("div")
        sliders(
            self.session, LIVE, self.case, self._preview, self._start_tried, self.view, keep=False
        )

    async def _preview(self, changes: dict[str, Any]) -> dict[str, Any]:
        path = str(self.session.project.path(self.name))
        self.preview_cof = 0.0
        try:
            answer = await self.session.ask(
                "underfoot.app.work:previewed", path, str(self.folder), changes
            )
        except UnderfootError as error:
            # nothing of an earlier setting stays; the full run starts when the slider rests
            message = {
                "preview": self.text("answer.no_preview"),
                "preview_note": _capital(dict(problem_parts(error)).get("what", "")),
            }
            return {"texts": message, "unanswered": True}
        self.preview_cof = answer["cof"]
        cof, error = f"{answer['cof']:.3f}", f"{answer['error']:.3f}"
        message = {
            "preview": self.text(
                "answer.preview", cof=cof, error=error, fluid_load=answer["fluid_load"]
            ),
            "preview_note": "" if answer["slip"] is None else self._risk(answer),
        }
        return {"texts": message, "html": answer["html"]}

    def _start_tried(self, changes: dict[str, Any]) -> None:
        """Start the full run of what the preview shows; give an earlier one up."""
        path = str(self.session.project.path(self.name))
        self.changes = changes
        jobs = self.session.jobs
        if self.tried is not None and self.tried.open:
            jobs.cancel(self.tried)
        folder = str(self.session.project.inside("results", TRIED, self.name))
        told = [f"{self.text(f'inputs.{path}')} {value}" for path, value in changes.items()]
        wanted = ", ".join([self.name, *told]).replace("/", " per ")  # a file's name, too
        named = {**changes, "name": self.session.project.free_name(wanted)}
        arguments = (path, folder, named)
        self.tried = self.session.submit(
            self.text("answer.full"),
            RUN,
            *arguments,
            about=f"{self.name} ({self.text('answer.live')})",
        )
        self.behind.clear()

        async def show_end(done: QueuedTask) -> None:
            if done is not self.tried:
                return
            with self.behind:
                _alert(done.problem)
            if done.state != DONE:
                return
            answer = await self.session.ask("underfoot.app.work:answer", folder)
            self.behind.clear()
            with self.behind:
                if not self.preview_cof:  # what waited for this run waits no more
                    ui.run_javascript('showTexts({preview: "", preview_note: ""})')
                if done.answer is None:  # ended without a number to trust
                    _alert(answer["verdict"])
                    return
                self.view.show(answer["html"])
                cof, before = f"{done.answer:.3f}", f"{self.preview_cof:.3f}"
                message = self.text("answer.full_run", cof=cof)
                if self.preview_cof:
                    off = f"{100 * (done.answer / self.preview_cof - 1):+.1f}"
                    message += " " + self.text("answer.replaced", preview=before, off=off)
                ui.label(message).classes("strong")
                if answer["slip"] is not None:
                    ui.label(self._risk(answer)).classes("soft")
                keep = ui.button(
                    self.text("answer.keep"), on_click=lambda: self._keep(folder, named)
                )
                keep.props("no-caps outline")

        with self.behind:
            task_line(self.session, self.tried, show_end)

    def _keep(self, folder: str, changes: Mapping[str, Any]) -> None:
        project = self.session.project
        new = project.copy(self.name, changes["name"], changes)
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
                self._offer_help(task)
            return
        self.helped.deactivate()
        self.help.clear()
        computed = [each for each in stored["changes"] if each["cof"] is not None]
        computed.sort(key=lambda each: each["slip_probability"])
        present = stored["slip_probability"]["value"]
        better = [
            each
            for each in computed
            if each["slip_probability"] < present and each.get("does_something", True)
        ]
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

    def _offer_help(self, task: QueuedTask | None) -> None:
        """Offer to simulate what would help where nothing has: of many runs at once none does."""
        project = self.session.project
        if (task is not None and task.state == DONE) or not project.is_current(self.name):
            return

        def begin() -> None:
            files = str(project.path(self.name)), str(self.folder)
            title = self.text("answer.help_job")
            self.session.submit(title, ADVICE, *files, about=self.name, first=True)
            self.helped.activate()
            self._helps()

        with self.help:
            interruption(self.session, task)
            button = ui.button(self.text("answer.help_begin"), on_click=begin)
            button.props("no-caps outline")

    def _change(self, each: dict[str, Any], now: dict[str, Any]) -> str:
        slip = now["slip_probability"]["value"]
        message = self.text(
            "answer.change",
            action=_capital(each["action"]),
            now=f"{now['cof']['value']:.3f}",
            cof=f"{each['cof']:.3f}",
            before=self._chance(slip, now["slip_probability"].get("interval")),
            after=self._chance(each["slip_probability"], each.get("slip_interval")),
        )
        message += self._extrapolation_note(each)
        return message.replace(" %", "\u00a0%")  # a narrow column must not part number and unit

    def _chance(self, probability: float, interval: Sequence[float] | None) -> str:
        """Return a slip probability, as its interval where one number would say too much."""
        if interval and is_wide((interval[0], interval[1])):
            return self.text(
                "answer.between",
                low=probability_text(interval[0]),
                high=probability_text(interval[1]),
            )
        return probability_text(probability)

    def _make(self, each: dict[str, Any]) -> None:
        change = self.text.get(f"changes.{each['name']}", each["name"].replace("_", " "))
        wanted = f"{self.name}, {change}"
        new = self.session.project.copy(self.name, wanted, each["values"])
        begin_run(self.session, new)
        self.session.go(ROUTE, variant=new, beside=self.name)


def conditions(case: Case) -> dict[str, tuple[str, bool]]:
    """Return the titles of floor and contaminant of a case, and whether values were changed."""
    told = {}
    for part, kind in (("floor", "floor"), ("contaminant", "fluid")):
        entry = case.entries.get(part)
        title = "" if entry is None else case.catalogue.entry(kind, entry).title
        paths = [path for path, origin in case.origins.items() if origin.kind == "given"]
        told[part] = title, any(path.startswith(f"{part}.") for path in paths)
    return told


def _capital(sentence: str) -> str:
    return sentence[:1].upper() + sentence[1:]


def _alert(problem: str) -> None:
    """Say a problem where there is one."""
    if problem:
        package_label(problem).classes("problem problem-what").props('role="alert"')
