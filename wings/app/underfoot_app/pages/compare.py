"""Results side by side: soles with one camera, how sure each order is, a table to sort, files."""

from __future__ import annotations

import csv
import io
from typing import Any

from nicegui import ui

from ..components import SoleView, sentences, table, title
from ..session import Session

ROUTE = "/compare"
WORK = "underfoot_app.work_studies"
MOST = 12
COLUMNS = ("letter", "name", "cof", "slip_probability", "fluid_load", "peak_fluid_pressure",
           "contact_area")  # fmt: skip


def build(session: Session) -> None:
    """Show the choice of results, and those chosen side by side."""
    _Compare(session)


class _Compare:
    def __init__(self, session: Session) -> None:
        self.session, self.text = session, session.text
        names = [each.name for each in session.project.results()]
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
            self.choice.on_value_change(self.show)
            for key, icon, action in (
                ("csv", "table_view", self._csv),
                ("glb", "view_in_ar", self._glb),
                ("pdf", "print", lambda: ui.run_javascript("window.print()")),
            ):
                button = ui.button(self.text(f"compare.{key}"), icon=icon, on_click=action)
                button.props("flat no-caps dense")
        self.summary = ui.element("div").props('role="status"')
        self.sole = SoleView(session)
        self.rest = ui.element("div")
        self.rows: list[dict[str, Any]] = []
        ui.timer(0, self.show, once=True)
        states = session.project.state
        session.follow(lambda: [states(name) for name in self.choice.value], self.show)

    def folders(self) -> list[str]:
        """Return the folders of the results that are chosen."""
        return [str(self.session.project.result_folder(name)) for name in self.choice.value]

    async def show(self) -> None:
        """Show what is chosen."""
        if len(self.choice.value) < 2:
            return
        comparison = await self.session.ask(f"{WORK}:comparison", self.folders())
        self.rows = comparison["rows"]
        self.summary.clear()
        self.rest.clear()
        self.sole.show(comparison["html"])
        with self.summary:
            for name in self.choice.value:
                if not self.session.project.is_current(name):
                    ui.label(self.text("compare.changed", name=name)).classes("caution")
            ui.label(" ".join(comparison["headline"])).classes("lead")
            sentences(comparison["cautions"], "soft")
        with self.rest:
            self._sortable()
            letters = [row["letter"] for row in self.rows]
            rows = [[a, *row] for a, row in zip(letters, comparison["chances"], strict=True)]
            table({"title": self.text("compare.chances"), "columns": ["", *letters], "rows": rows})
            for each in comparison["tables"][-1:]:
                table(each)

    def _sortable(self) -> None:
        columns = [
            {
                "name": key,
                "label": self.text(f"compare.{key}"),
                "field": key,
                "sortable": True,
                "align": "left",
            }
            for key in COLUMNS
            if any(row.get(key) is not None for row in self.rows)
        ]
        made = ui.table(columns=columns, rows=self.rows, row_key="letter").props("flat dense")
        for key in COLUMNS[2:]:  # sorted by the number, shown with unit and interval
            made.add_slot(f"body-cell-{key}", f"<q-td>{{{{ props.row.{key}_text }}}}</q-td>")

    def _csv(self) -> None:
        stream = io.StringIO()
        writer: Any = csv.DictWriter(stream, COLUMNS, extrasaction="ignore")
        writer.writeheader()
        writer.writerows(self.rows)
        ui.download.content(stream.getvalue(), "comparison.csv")

    async def _glb(self) -> None:
        for name, folder in zip(self.choice.value, self.folders(), strict=True):
            file = self.session.project.inside("results", name, f"{name}.glb")
            await self.session.ask(f"{WORK}:exported", folder, str(file))
            ui.download.file(file)
