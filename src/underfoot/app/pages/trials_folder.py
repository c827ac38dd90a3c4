"""One folder of trials: how it is analysed, a card a trial, statistics, the report."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Mapping
from functools import partial
from importlib.resources import files
from pathlib import Path
from typing import Any

from nicegui import ui

from underfoot.core import InputError
from underfoot.core.errors import UnderfootError
from underfoot.core.remark import Message, join_lines

from ..components import sentences, table, task_line, title
from ..jobs import QueuedTask
from ..labels import package_label
from ..session import Session
from ..trials_study import TrialsFolder

WORK = "underfoot.app.work_trials"
STATIC = Path(str(files("underfoot.app"))) / "static"
SHOWN = 60
"""Cards that are shown at once; more on demand."""


class FolderView:
    """A folder in the element that is open; ``back`` and ``show`` lead to all folders, a trial."""

    def __init__(
        self,
        session: Session,
        study: TrialsFolder,
        back: Callable[[], None],
        show: Callable[[str], Awaitable[None]],
    ) -> None:
        self.session, self.study, self.text, self.show = session, study, session.text, show
        self.cards: list[dict[str, Any]] = []
        self.only, self.count = "", SHOWN
        text = self.text
        with ui.element("div").classes("trial-bar"):
            leave = ui.button(text("trials.all_folders"), icon="arrow_back", on_click=back)
            leave.props("flat no-caps dense")
            title(study.name)
            ui.space()
            report = ui.button(text("trials.report"), icon="description", on_click=self.report)
            report.props("no-caps unelevated")
        self._settings_row()
        self.report_place = ui.element("div")
        with ui.element("div").classes("task") as self.busy:
            self.progress = ui.linear_progress(0.0, show_value=False)
            self.progress.props(f'aria-label="{text("trials.reading")}"')
            stop = ui.button(text("jobs.stop"), on_click=session.jobs.live.stop)
            stop.props("flat dense no-caps")
        self.body = ui.element("div")
        ui.timer(0.01, self.refresh, once=True)

    def _settings_row(self) -> None:
        text, settings = self.text, self.study.settings
        with ui.element("div").classes("trial-settings"):
            self.protocol = ui.select([settings["protocol"]], label=text("trials.protocol"))
            self.protocol.value = settings["protocol"]
            with ui.element("div").classes("names"):
                names = ui.input(text("trials.names"), value=settings["names"])
                ui.label(text("trials.names_hint")).classes("soft")
            merge = ui.checkbox(text("trials.merge"), value=settings["merge_spelling"])

        async def keep_settings() -> None:
            chosen = {"protocol": self.protocol.value, "merge_spelling": merge.value}
            if self.study.keep({**chosen, "names": (names.value or "").strip()}):
                await self.refresh()

        self.protocol.on_value_change(keep_settings)
        merge.on_value_change(keep_settings)
        names.on("blur", keep_settings)
        names.on("keydown.enter", keep_settings)

    async def refresh(self) -> None:
        """Analyse the folder anew; what has not changed is known already."""
        ask = self.session.ask
        self.busy.set_visibility(True)

        def heard(job: Any) -> None:
            self.progress.value = job.fraction

        view = None
        try:
            titles = await ask(f"{WORK}:protocols")
            self.protocol.set_options({name: f"{words} ({name})" for name, words in titles.items()})
            view = await ask(f"{WORK}:folder_view", self.study.asked, heard=heard)
        except UnderfootError as error:
            self.session.tell(error)
        self.busy.set_visibility(False)
        self.body.clear()
        with self.body:
            if view is None:
                again = ui.button(self.text("trials.again"), on_click=self.refresh)
                again.props("flat no-caps")
            else:
                self._folder(view)

    def _folder(self, view: Mapping[str, Any]) -> None:
        text = self.text
        self.cards = view["cards"]
        self.study.files = [card["file"] for card in self.cards]
        package_label(view["lead"]).classes("lead")
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
            ui.label(self.study.command).classes("command").props("translate=no")

    def _chip(self, verdict: str, count: int) -> None:
        def choose() -> None:
            self.only, self.count = verdict, SHOWN
            self._sheet()

        words = self.text(f"trials.{verdict or 'every'}")
        chip = ui.button(f"{count} {words}", on_click=choose, color=None).classes(
            f"chip is-{verdict}"
        )
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
        made = ui.element("button").classes(f"trial-card is-{card['verdict']}")
        with made.on("click", partial(self.show, card["file"])):
            ui.label(card["file"]).classes("name")
            if card["svg"]:
                ui.html(card["svg"], sanitize=False)
            package_label(Message("{numbers: · }", numbers=card["numbers"][:2])).classes("number")
            ui.label(card["noted"]).classes("soft")
            words = [self.text("trials.edited", count=card["edits"])] if card["edits"] else []
            if card["verdict"] != "accepted":
                words += card["reasons"][:1]
            package_label(join_lines(words)).classes("reason")

    async def report(self) -> None:
        """Write the report and show the way to it."""
        session, text = self.session, self.text
        work = f"{WORK}:written_report"
        task = session.submit(
            text("trials.report_job"), work, self.study.asked, about=self.study.name
        )

        async def show_end(ended: QueuedTask) -> None:
            if ended.problem:
                session.tell(InputError(ended.problem))
            elif ended.answer:
                address = session.keep(Path(ended.answer).read_text(encoding="utf-8"))
                with self.report_place:
                    ui.link(text("trials.report_open"), address, new_tab=True)
                ui.navigate.to(address, new_tab=True)

        self.report_place.clear()
        with self.report_place:
            task_line(session, task, show_end)


def _study_table(shown: Mapping[str, Any]) -> None:
    """Show a table of the statistics with what stands below its rows, its notes and cautions."""
    below = shown["below"] if any(shown["below"]) else []
    rows = [[*row, *below[i : i + 1]] for i, row in enumerate(shown["rows"])]
    table(
        {"title": shown["title"], "columns": [*shown["columns"], *[""] * bool(below)], "rows": rows}
    )
    sentences([*shown.get("cautions", ()), *shown["notes"]], "soft")
