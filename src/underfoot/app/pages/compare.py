"""Results side by side: soles with one camera, how sure each order is, a table to sort, files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from nicegui import ui

from underfoot.core import InputError
from underfoot.core.remark import together

from ..components import SoleView, sentences, table, task_line, title
from ..jobs import DONE, QueuedTask
from ..labels import package_label
from ..result_table import ResultTable
from ..session import PICTURES, Session
from .answer import begin_run

ROUTE = "/compare"
WORK, EQUAL = "underfoot.app.work_studies", "underfoot.app.work_sole:equal_land"
MOST = 12
SEPARATED = "underfoot.app.work:separated"
OPTION = f"""<q-item v-bind="props.itemProps"><q-item-section side>
<img class="sole-picture" :src="'{PICTURES}result/' + encodeURIComponent(props.opt.label)"
:alt="'ALT' + props.opt.label"></q-item-section>
<q-item-section translate="no">{{{{ props.opt.label }}}}</q-item-section></q-item>"""


def build(session: Session) -> None:
    """Show the choice of results, and those chosen side by side."""
    _Compare(session)


class _Compare:
    def __init__(self, session: Session) -> None:
        self.session, self.text = session, session.text
        names = [result.name for result in session.project.results()]
        asked = [name for name in session.query.get("variants", "").split("|") if name in names]
        title(self.text("compare.title")).classes("hidden-title")
        ui.label(self.text("compare.lead", most=MOST)).classes("lead")
        if len(names) < 2:
            ui.label(self.text("compare.too_few")).classes("soft")
            return
        with ui.element("div").classes("bar-row no-print"):
            self.choice = ui.select(names, multiple=True, value=asked or names[:2])
            self.choice.props(f'dense outlined use-chips label="{self.text("compare.choose")}"')
            self.choice.props(f"max-values={MOST} translate=no").classes("compare-choice")
            self.choice.add_slot(
                "option", OPTION.replace("ALT", self.text("sole.picture", name=""))
            )
            self.choice.on_value_change(self.show)
            for key, icon, action in (
                ("glb", "view_in_ar", self._glb),
                ("equal", "balance", self._equal_land),
                ("pdf", "print", lambda: ui.run_javascript("window.print()")),
            ):
                button = ui.button(self.text(f"compare.{key}"), icon=icon, on_click=action)
                button.props("flat no-caps dense")
        self.equal = ui.element("div").props('role="status"')
        self.summary = ui.element("div").props('role="status"')
        self.sole = SoleView(session)
        self.table = ResultTable(session, "comparison", self._entries, lettered=True)
        self.rest = ui.element("div")
        ui.timer(0, self.show, once=True)
        states = session.project.state
        session.follow(lambda: [states(name) for name in self.choice.value], self.show)

    def folders(self) -> list[str]:
        """Return the folders of the results that are chosen."""
        return [str(self.session.project.result_folder(name)) for name in self.choice.value]

    def _entries(self) -> list[tuple[str, str, str]]:
        """Return what is compared: the inputs are those that were computed."""
        named = zip(self.choice.value, self.folders(), strict=True)
        return [(name, str(Path(folder) / "case.toml"), folder) for name, folder in named]

    async def show(self) -> None:
        """Show what is chosen."""
        if len(self.choice.value) < 2:
            return
        comparison = await self.session.ask(f"{WORK}:comparison", self.folders())
        self.rest.clear()
        self.sole.show(comparison["html"])
        await self.table.show()
        with self.rest:
            letters = comparison["letters"]
            rows = [[a, *row] for a, row in zip(letters, comparison["chances"], strict=True)]
            table({"title": self.text("compare.chances"), "columns": ["", *letters], "rows": rows})
            self.inputs = ui.element("div")
        self._say(comparison)
        if comparison["open"]:
            self._separate()

    def _say(self, comparison: dict[str, Any]) -> None:
        """Say the order, what would tell it, and in what the inputs differ."""
        self.summary.clear()
        self.inputs.clear()
        with self.summary:
            for name in self.choice.value:
                if not self.session.project.is_current(name):
                    ui.label(self.text("compare.changed", name=name)).classes("caution")
            headline = together(comparison["headline"])
            lead = package_label(headline).classes("lead")
            lead.set_text(headline.replace(" %", "\u00a0%"))
            sentences(comparison["cautions"], "soft")
        with self.inputs:
            for each in comparison["tables"]:
                named = [[self.text.get(f"inputs.{key}", key), *row] for key, *row in each["rows"]]
                table({**each, "rows": named})

    def _separate(self) -> None:
        """Compute what would tell an order that is open, once for the same results."""
        chosen, project = list(self.choice.value), self.session.project
        about = " | ".join(chosen)
        newest = max(
            project.result_folder(n).joinpath("result.json").stat().st_mtime for n in chosen
        )
        task = self.session.jobs.latest(about, SEPARATED)
        if task is None or not (task.open or task.answer) or task.began < newest:
            words = self.text("compare.separate")
            task = self.session.submit(words, SEPARATED, self.folders(), about=about, first=True)

        async def show_end(done: QueuedTask) -> None:
            if done.answer and self.choice.value == chosen:
                self._say(done.answer)

        with self.summary:
            task_line(self.session, task, show_end)

    async def _equal_land(self) -> None:
        """Make a variant of the second with the land of the first, compute and compare it."""
        project, chosen = self.session.project, list(self.choice.value)
        if len(chosen) != 2:
            remedy = self.text("compare.equal_two")
            raise InputError(self.text("compare.equal_which"), where="compare", remedy=remedy)
        first, second = chosen
        for name in chosen:
            if not project.is_current(name):
                remedy = self.text("compare.equal_anew", name=name)
                raise InputError(
                    self.text("compare.changed", name=name), where="compare", remedy=remedy
                )
        files = (str(project.path(name)) for name in chosen)
        changes, words = await self.session.ask(EQUAL, *files)
        self.equal.clear()
        if not changes:
            with self.equal:
                ui.label(self.text("compare.equal_already", a=first, b=second, **words))
            return
        new = project.copy(second, self.text("compare.equal_name", a=first, b=second))
        project.change(new, changes)  # a state of its own: undone, it is the second again

        def show(names: list[str]) -> None:
            self.choice.set_options([r.name for r in project.results()], value=names)

        def undo() -> None:
            self.session.jobs.cancel(task)
            project.remove(new)
            self.equal.clear()
            show(chosen)

        async def show_end(done: QueuedTask) -> None:
            if done.state == DONE and new in project.variants():
                show([first, new])

        with self.equal:
            ui.label(self.text("compare.equal_made", a=first, b=second, name=new, **words))
            button = ui.button(self.text("variant.undo"), icon="undo", on_click=undo)
            button.props("flat no-caps dense data-step=undo")
            task = begin_run(self.session, new)
            task_line(self.session, task, show_end)

    async def _glb(self) -> None:
        for name, folder in zip(self.choice.value, self.folders(), strict=True):
            file = self.session.project.inside("results", name, f"{name}.glb")
            await self.session.ask(f"{WORK}:exported", folder, str(file))
            ui.download.file(file)
