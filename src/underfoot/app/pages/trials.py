"""Measurements: a folder of trials at a glance, each trial to look at and to correct by hand."""

from __future__ import annotations

import json
import secrets
import shutil
from collections.abc import Mapping
from functools import partial
from importlib.resources import files
from pathlib import Path
from typing import Any
from urllib.parse import urlencode

from nicegui import ui
from nicegui.events import GenericEventArguments

from underfoot.core import InputError
from underfoot.core.errors import UnderfootError
from underfoot.core.files import whole_file

from ..components import sentences, table, task_line, title
from ..gate import UPLOADS
from ..jobs import Task
from ..session import Session

ROUTE = "/trials"
WORK = "underfoot.app.work_trials"
STATIC = Path(str(files("underfoot.app"))) / "static"
SHOWN = 60
"""Cards that are shown at once; more on demand."""
ARRIVING = "arriving "
"""Start of the name of a folder whose files are still on their way."""
PLOT_WORDS = (
    "plot", "step", "time", "force", "ratio", "speed", "cof", "contact", "toe off", "gate", "rcof",
    "slip start", "slip end", "slip peak", "begin", "end", "normal", "shear", "left", "right",
    "unknown",
)  # fmt: skip
"""What a plot names: itself, its panels, lines and events."""
STANDARD = {"protocol": "level_walking", "names": "", "merge_spelling": False}


class FolderDrop(ui.element, component=STATIC / "folder_drop.js"):
    """A place that takes a folder of files into the project; ``arrived`` says how many came."""

    def __init__(self, session: Session, folder: str) -> None:
        super().__init__()
        words = {key: session.text(f"trials.{key}") for key in ("drop", "folder", "files")}
        self._props.update(words=words, address=f"{UPLOADS}trials/{folder}")


class TrialPlot(ui.element, component=STATIC / "trial.js"):
    """Signals with events that may be moved (``moved``) and steps that may be chosen."""

    def __init__(self, session: Session, *, choosing: bool = False, panel: int = 104) -> None:
        super().__init__()
        words = {id: session.text(f"trials.plot.{id.replace(' ', '_')}") for id in PLOT_WORDS}
        self._props.update(words=words, choosing=choosing, panel=panel, revision=0)

    def show(self, plot: Mapping[str, Any], chosen: int | None) -> None:
        """Draw a plot; what was being moved is where the plot says."""
        self._props.update(plot=plot, chosen=chosen, revision=self._props["revision"] + 1)
        self.update()


def build(session: Session) -> None:
    """Show the folder of the address, or the folders there are and a place for a new one."""
    ui.add_head_html('<link rel="stylesheet" href="/static/trials.css">')
    page = _Trials(session)
    wanted = session.query.get("study", "")
    if wanted in page.studies():
        page.open(wanted, session.query.get("trial", ""))
        return
    page.choose()
    if "example" in session.query:
        ui.timer(0.01, page.make_example, once=True)


def example(session: Session) -> None:
    """Open a folder of made-up slips."""
    session.go(ROUTE, example="slips")


class _Trials:
    """The page: folders, then one folder, then one trial of it."""

    def __init__(self, session: Session) -> None:
        self.session, self.text = session, session.text
        self.place = ui.element("div")
        self.study = self.file = ""
        self.settings: dict[str, Any] = dict(STANDARD)
        self.cards: list[dict[str, Any]] = []
        self.only, self.count = "", SHOWN
        self.pending: dict[str, Any] | None = None
        self.done: list[tuple[str, str]] = []
        self.undone: list[tuple[str, str]] = []

    def studies(self) -> list[str]:
        """Return the names of the folders of trials."""
        found = self.session.project.inside("trials").iterdir()
        return sorted(each.name for each in found if each.is_dir() and each.name[0] != ".")

    def asked(self) -> dict[str, Any]:
        """Return what the computing process is asked about: folder, report and settings."""
        inside = self.session.project.inside
        report = str(inside("results", f"{self.study} trials"))
        return {"folder": str(inside("trials", self.study)), "report": report, **self.settings}

    # folders

    def choose(self) -> None:
        """Show the folders there are and take a new one."""
        text, session = self.text, self.session
        arriving = ARRIVING + secrets.token_hex(4)

        async def arrived(event: GenericEventArguments) -> None:
            name = self._settled(arriving)
            if name:
                self.open(name)
            for words in event.args["refused"][:5]:
                session.tell(InputError(words))

        self.place.clear()
        with self.place:
            title(text("trials.title"))
            ui.label(text("trials.lead")).classes("lead")
            FolderDrop(session, arriving).on("arrived", arrived)
            made = ui.button(text("trials.try"), on_click=self.make_example)
            made.props("flat no-caps")
            if self.studies():
                title(text("trials.folders"), 2)
            with ui.element("ul").classes("folders"):
                for name in self.studies():
                    with ui.element("li"):
                        link = ui.button(name, icon="folder", on_click=partial(self.open, name))
                        link.props("flat no-caps align=left")

    async def make_example(self) -> None:
        """Make a folder of made-up slips and open it."""
        name = _free_name(self.session, self.text("trials.example"))
        await self.session.ask(f"{WORK}:example", str(self.session.project.inside("trials", name)))
        _keep_settings(self.session, name, {**STANDARD, "protocol": "report_g6"})
        self.open(name)

    def _settled(self, arriving: str) -> str:
        """Give a folder that has arrived its name; a folder in it alone is the folder meant."""
        folder = self.session.project.inside("trials", arriving)
        if not folder.is_dir():
            return ""
        inside = list(folder.iterdir())
        one = inside[0] if len(inside) == 1 and inside[0].is_dir() else folder
        wanted = one.name if one is not folder else self.text("trials.unnamed")
        name = _free_name(self.session, wanted)
        one.rename(self.session.project.inside("trials", name))
        shutil.rmtree(folder, ignore_errors=True)
        return name

    # one folder

    def open(self, study: str, file: str = "") -> None:
        """Show a folder, or one trial of it."""
        self.study, self.done, self.undone = study, [], []
        self.settings = _settings(self.session, study)
        if file:
            ui.timer(0.01, lambda: self.show(file), once=True)
        else:
            self.overview()

    def overview(self) -> None:
        """Show the folder: how it is analysed, what it says, a card a trial."""
        text = self.text
        self.file, self.pending = "", None
        self._address(study=self.study)
        self.place.clear()
        with self.place:
            with ui.element("div").classes("trial-bar"):
                back = ui.button(text("trials.all_folders"), icon="arrow_back")
                back.on_click(self.choose).props("flat no-caps dense")
                title(self.study)
                ui.space()
                report = ui.button(text("trials.report"), icon="description", on_click=self.report)
                report.props("no-caps unelevated")
            self._settings_row()
            self.report_place = ui.element("div")
            with ui.element("div").classes("task") as self.busy:
                self.progress = ui.linear_progress(0.0, show_value=False)
                self.progress.props(f'aria-label="{text("trials.reading")}"')
                stop = ui.button(text("jobs.stop"), on_click=self.session.jobs.live.stop)
                stop.props("flat dense no-caps")
            self.body = ui.element("div")
            ui.timer(0.01, self.refresh, once=True)

    def _settings_row(self) -> None:
        text = self.text
        with ui.element("div").classes("trial-settings"):
            self.protocol = ui.select([self.settings["protocol"]], label=text("trials.protocol"))
            self.protocol.value = self.settings["protocol"]
            with ui.element("div").classes("names"):
                names = ui.input(text("trials.names"), value=self.settings["names"])
                ui.label(text("trials.names_hint")).classes("soft")
            merge = ui.checkbox(text("trials.merge"), value=self.settings["merge_spelling"])

        async def changed() -> None:
            new = {"protocol": self.protocol.value, "names": (names.value or "").strip()}
            new["merge_spelling"] = merge.value
            if new != self.settings:
                self.settings = new
                _keep_settings(self.session, self.study, new)
                await self.refresh()

        self.protocol.on_value_change(changed)
        merge.on_value_change(changed)
        names.on("blur", changed)
        names.on("keydown.enter", changed)

    async def refresh(self) -> None:
        """Analyse the folder anew; what has not changed is known already."""
        self.busy.set_visibility(True)
        self.body.clear()
        if len(self.protocol.options) < 2:
            titles = await self.session.ask(f"{WORK}:protocols")
            self.protocol.set_options({n: f"{t} ({n})" for n, t in titles.items()})

        def heard(job: Any) -> None:
            self.progress.value = job.fraction

        try:
            view = await self.session.ask(f"{WORK}:folder_view", self.asked(), heard=heard)
        except UnderfootError as error:
            self.session.tell(error)
            return
        finally:
            self.busy.set_visibility(False)
        with self.body:
            self._folder(view)

    def _folder(self, view: Mapping[str, Any]) -> None:
        text = self.text
        self.cards, self.count = view["cards"], SHOWN
        ui.label(view["lead"]).classes("lead")
        sentences(view["notes"], "soft")
        with ui.element("div").classes("chips"):
            for verdict in ("", "accepted", "caution", "refused"):
                count = view["counts"].get(verdict, 0) if verdict else len(self.cards)
                if count:
                    self._chip(verdict, count)
        self.sheet = ui.element("div")
        self._sheet()
        for shown in ([view["summary"]] if view["summary"] else []) + view["findings"][:1]:
            _study_table(shown)
        rest = [*view["findings"][1:], *view["study"]]
        if rest:
            with ui.expansion(text("trials.more_statistics", count=len(rest))).classes("wide"):
                for shown in rest:
                    _study_table(shown)
        with ui.expansion(text("trials.by_command")):
            ui.label(self._command()).classes("command")

    def _command(self) -> str:
        parts = ["underfoot trials analyse", json.dumps(f"trials/{self.study}"), "--protocol"]
        parts += [self.settings["protocol"], "--out", json.dumps(f"results/{self.study} trials")]
        if self.settings["names"]:
            parts += ["--names", f"'{self.settings['names']}'"]
        return " ".join(parts + ["--merge-spelling"] * self.settings["merge_spelling"])

    def _chip(self, verdict: str, count: int) -> None:
        def choose() -> None:
            self.only, self.count = verdict, SHOWN
            self._sheet()

        words = self.text(f"trials.{verdict or 'every'}")
        chip = ui.button(f"{count} {words}", on_click=choose, color=None).classes(f"chip {verdict}")
        chip.props("flat no-caps dense")

    def _sheet(self) -> None:
        """Show the cards of the chosen verdict, the first ones of many."""
        chosen = [card for card in self.cards if self.only in ("", card["verdict"])]

        def more() -> None:
            self.count += SHOWN
            self._sheet()

        self.sheet.clear()
        with self.sheet:
            with ui.element("div").classes("trial-cards"):
                for card in chosen[: self.count]:
                    self._card(card)
            if len(chosen) > self.count:
                rest = self.text("trials.more", count=len(chosen) - self.count)
                ui.button(rest, on_click=more).props("flat no-caps")

    def _card(self, card: Mapping[str, Any]) -> None:
        async def show() -> None:
            await self.show(card["file"])

        with ui.element("button").classes(f"trial-card {card['verdict']}").on("click", show):
            ui.label(card["file"]).classes("name")
            if card["svg"]:
                ui.html(card["svg"], sanitize=False)
            ui.label(" · ".join(card["numbers"][:2])).classes("number")
            ui.label(card["noted"]).classes("soft")
            words = [self.text("trials.edited", count=card["edits"])] if card["edits"] else []
            if card["verdict"] != "accepted":
                words += card["reasons"][:1]
            ui.label("; ".join(words)).classes("reason")

    async def report(self) -> None:
        """Write the report and show the way to it."""
        session, text = self.session, self.text
        work = f"{WORK}:written_report"
        task = session.jobs.submit(text("trials.report_job"), work, self.asked(), about=self.study)

        async def done(ended: Task) -> None:
            if ended.problem:
                session.tell(InputError(ended.problem))
            elif ended.answer:
                address = session.keep(Path(ended.answer).read_text(encoding="utf-8"))
                with self.report_place:
                    ui.link(text("trials.report_open"), address, new_tab=True)
                ui.navigate.to(address, new_tab=True)

        self.report_place.clear()
        with self.report_place:
            task_line(session, task, done)

    # one trial

    async def show(self, file: str, step: int | None = None) -> None:
        """Show a trial; ``step`` is the number of the step chosen."""
        view = await self.session.ask(f"{WORK}:trial_view", self.asked(), file, step)
        self.file, self.pending, text = file, None, self.text
        self._address(study=self.study, trial=file)
        self.place.clear()
        with self.place:
            with ui.element("div").classes("trial-bar"):
                back = ui.button(text("trials.all_trials"), icon="arrow_back")
                back.on_click(self.overview).props("flat no-caps dense")
                title(file)
                ui.space()
                self._beside(-1, "navigate_before", "trials.before")
                self._beside(1, "navigate_next", "trials.after")
                self.undo = self._tool("undo", "trials.undo", self._undo)
                self.redo = self._tool("redo", "trials.redo", self._redo)
            self.head = ui.element("div")
            if view["whole"]:
                self.whole = TrialPlot(self.session, choosing=True, panel=46)
                self.whole.on("chosen", lambda e: self.choose_step(e.args))
            self.bar = ui.element("div").classes("edit-bar").props('aria-live="polite"')
            if view["plot"]:
                self.plot = TrialPlot(self.session).on("moved", self._moved)
            self.log = ui.element("div")
        self._fill(view)

    def _tool(self, icon: str, key: str, on_click: Any) -> ui.button:
        made = ui.button(icon=icon, on_click=on_click).props("flat round dense")
        return made.props(f'aria-label="{self.text(key)}"').tooltip(self.text(key))

    def _beside(self, by: int, icon: str, key: str) -> None:
        names = [card["file"] for card in self.cards]
        at = names.index(self.file) + by if self.file in names else -1

        async def go() -> None:
            await self.show(names[at])

        self._tool(icon, key, go).set_enabled(0 <= at < len(names))

    async def choose_step(self, number: int) -> None:
        """Show another step of the trial; an edit that was not kept is gone."""
        self.pending = None
        args = self.asked(), self.file, number
        self._fill(await self.session.ask(f"{WORK}:trial_view", *args))

    def _fill(self, view: Mapping[str, Any]) -> None:
        """Show a view of the trial in the elements that are there."""
        self.view = view
        if view["whole"]:
            self.whole.show(view["whole"], view["chosen"])
        if view["plot"]:
            self.plot.show(view["plot"], view["chosen"])
        self.undo.set_enabled(bool(self.done))
        self.redo.set_enabled(bool(self.undone))
        self.head.clear()
        with self.head:
            self._summary()
        self.bar.clear()
        with self.bar:
            self._edit_bar()
        self.log.clear()
        with self.log:
            self._log()

    def _summary(self) -> None:
        view, text = self.view, self.text
        with ui.element("div").classes("trial-summary"):
            ui.label(text(f"trials.{view['verdict']}")).classes(f"tag {view['verdict']}")
            for words in view["numbers"]:
                ui.label(words).classes("number")
            ui.label(", ".join(f"{n}: {v}" for n, v in view["conditions"].items())).classes("soft")
            self._step_chips()
        sentences(view["reasons"], "reason")

    def _step_chips(self) -> None:
        view, text = self.view, self.text
        with ui.element("div").classes("chips"):
            for step in sorted(view["steps"], key=lambda each: each["number"]):
                number = "–" if step["rcof"] is None else f"{step['rcof']:.3f}"
                words = f"{step['number']} {text('trials.side_' + step['side'])}: {number}"
                chip = ui.button(words, color=None).classes(f"chip {step['verdict']}")
                chip.on_click(partial(self.choose_step, step["number"]))
                chip.props("flat no-caps dense")
                chip.props(f'aria-pressed="{str(step["number"] == view["chosen"]).lower()}"')

    def _chosen(self) -> dict[str, Any] | None:
        return next((s for s in self.view["steps"] if s["number"] == self.view["chosen"]), None)

    def _edit_bar(self) -> None:
        """Show the chosen step and what may be done with it, or the edit that lacks a reason."""
        text, step = self.text, self._chosen()
        if self.pending is not None:
            self._reason()
            return
        if step is not None:
            ui.label(f"{step['item']}: {_step_words(step)}").classes("step-words")
            sentences(step["cautions"], "reason")
            self._offer(step)
        elif self.view["kind"] != "readings" and not self.view["edits"] and self.view["plot"]:
            change = {"step": self.view["run"], "what": "exclude"}
            self._change_button("trials.exclude_run", change)
        if step is not None:
            ui.label(text("trials.drag")).classes("soft")

    def _offer(self, step: Mapping[str, Any]) -> None:
        number = step["number"]
        if "exclude" in step["by_hand"]:
            return
        self._change_button("trials.exclude", {"step": number, "what": "exclude"})
        other = {"left": "right", "right": "left"}.get(step["side"])
        for side in [other] if other else ["left", "right"]:
            change = {"step": number, "what": "side", "value": side}
            self._change_button(f"trials.is_{side}", change)
        near = [s for s in self.view["steps"] if abs(s["contact"] - step["contact"]) < 0.1]
        if len(near) > 1:
            change = {"step": number, "what": "plate", "value": step["plate"]}
            self._change_button("trials.this_plate", change)

    def _change_button(self, key: str, change: dict[str, Any]) -> None:
        made = ui.button(self.text(key), on_click=lambda: self.tried(change))
        made.props("outline no-caps dense")

    def _reason(self) -> None:
        """Show what the edit would do and ask for its reason."""
        text, entry = self.text, self.view["edits"][-1]
        ui.label(f"{entry['step']}: {_edit_words(entry)}").classes("step-words").props(
            'role="status"'
        )
        why = ui.input(text("trials.why"), validation={text("trials.why_missing"): bool})
        why.without_auto_validation()
        past = dict.fromkeys(each["why"] for each in self.view["edits"][:-1])
        why.set_autocomplete(list(past))
        why.props("autofocus dense hide-bottom-space").classes("why")

        async def keep() -> None:
            if why.validate():
                await self._kept({**(self.pending or {}), "why": (why.value or "").strip()})

        why.on("keydown.enter", keep)
        why.on("keydown.escape", self._discard)
        ui.button(text("trials.keep"), on_click=keep).props("unelevated no-caps")
        ui.button(text("trials.discard"), on_click=self._discard).props("flat no-caps")

    def _log(self) -> None:
        text, edits = self.text, self.view["edits"]
        if not edits or (self.pending is not None and len(edits) == 1):
            return
        title(text("trials.edits"), 2)
        for number, entry in enumerate(edits[:-1] if self.pending is not None else edits):
            with ui.element("div").classes("edit"):
                ui.label(f"{entry['step']}: {_edit_words(entry)}. {entry['why']}")
                take = ui.button(text("trials.take_back"))
                take.on_click(partial(self._kept, {"step": number, "what": "take back"}))
                take.props("flat no-caps dense")

    async def _moved(self, event: GenericEventArguments) -> None:
        value = f"{event.args['time']:.4f} s"
        await self.tried({"step": self.view["chosen"], "what": event.args["id"], "value": value})

    async def tried(self, change: dict[str, Any]) -> None:
        """Show what an edit would do; it is not written."""
        if await self._answered(change, keep=False):
            self.pending = change
            self._fill(self.view)

    async def _kept(self, change: dict[str, Any]) -> None:
        if await self._answered(change, keep=True):
            self.done.append((self.view["before"], self.view["after"]))
            self.pending, self.undone = None, []
            self._fill(self.view)

    async def _answered(self, change: dict[str, Any], *, keep: bool) -> bool:
        arguments = self.asked(), self.file, self.view["chosen"]
        options = {"change": change, "keep": keep}
        try:
            self.view = await self.session.ask(f"{WORK}:trial_view", *arguments, **options)
        except UnderfootError as error:
            self.session.tell(error)
            await self._discard()
            return False
        return True

    async def _discard(self) -> None:
        await self.choose_step(self.view["chosen"])

    async def _undo(self) -> None:
        await self._put(self.done, self.undone, 0)

    async def _redo(self) -> None:
        await self._put(self.undone, self.done, 1)

    async def _put(
        self, source: list[tuple[str, str]], target: list[tuple[str, str]], to: int
    ) -> None:
        """Make ``edits.csv`` what it was before (0) or after (1) the last edit of ``source``."""
        texts = source.pop()
        await self.session.ask(f"{WORK}:put_edits", self.asked(), texts[to], texts[1 - to])
        target.append(texts)
        await self._discard()

    def _address(self, **query: str) -> None:
        ui.run_javascript(f"history.replaceState(null, '', {json.dumps('?' + urlencode(query))})")


def _study_table(shown: Mapping[str, Any]) -> None:
    """Show a table of the statistics with what stands below its rows, its notes and cautions."""
    below = shown["below"] if any(shown["below"]) else []
    rows = [[*row, *below[i : i + 1]] for i, row in enumerate(shown["rows"])]
    table(
        {"title": shown["title"], "columns": [*shown["columns"], *[""] * bool(below)], "rows": rows}
    )
    sentences([*shown.get("cautions", ()), *shown["notes"]], "soft")


def _step_words(step: Mapping[str, Any]) -> str:
    """Return a step's number with its uncertainty, or why it has none."""
    parts = []
    if step["rcof"] is not None:
        spread = step["rcof_uncertainty"]
        parts.append(f"RCOF {step['rcof']:.4f}" + (f" ± {spread:.4f}" if spread else ""))
    if step.get("peak_slipping_speed") is not None:
        parts.append(f"peak slipping speed {step['peak_slipping_speed']:.3f} m/s")
    if step.get("outcome"):
        parts.append(f"{step['outcome']}, {1e3 * step['slip_distance']:.0f} mm")
    return ", ".join(parts) or step["reason"] or "–"


def _edit_words(entry: Mapping[str, Any]) -> str:
    """Return what an edit did: the event and the number before and after."""
    event = f"{entry['what']} {entry['before']} → {entry['after']}"
    if not entry["quantity"]:
        return event
    numbers = (entry["number before"], entry["number after"])
    before, after = ("–" if number is None else f"{number:.4f}" for number in numbers)
    name = "RCOF" if entry["quantity"] == "rcof" else f"{entry['quantity']} (m/s)"
    return f"{event}, {name} {before} → {after}"


def _free_name(session: Session, wanted: str) -> str:
    trials, number, name = session.project.inside("trials"), 1, wanted
    while (trials / name).exists():
        number += 1
        name = f"{wanted} {number}"
    return name


def _settings_file(session: Session, study: str) -> Path:
    return session.project.inside("trials", f"{study}.json")


def _settings(session: Session, study: str) -> dict[str, Any]:
    """Return how a folder was analysed last, or the standard."""
    try:
        kept = json.loads(_settings_file(session, study).read_text(encoding="utf-8"))
        return {key: type(value)(kept[key]) for key, value in STANDARD.items()}
    except (OSError, ValueError, KeyError, TypeError):
        return dict(STANDARD)


def _keep_settings(session: Session, study: str, settings: Mapping[str, Any]) -> None:
    with whole_file(_settings_file(session, study)) as part:
        part.write_text(json.dumps(settings, indent=2, ensure_ascii=False), encoding="utf-8")
