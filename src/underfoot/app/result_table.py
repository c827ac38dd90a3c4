"""The table of variants: inputs that differ and results, to sort and to take along."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from itertools import zip_longest
from string import ascii_uppercase
from typing import Any

from nicegui import ui

from .session import Session, address

WORK = "underfoot.app.work_table"
NUMBERS = ("cof", "slip_probability", "fluid_load", "peak_fluid_pressure", "contact_area")
OLD = """:class="props.row.state === 'earlier' && 'stale'\""""
SOLE = '<img class="sole-picture" loading="lazy" v-bind="props.row.picture">'
INPUTS = 6
"""Inputs that differ which are shown; files have all."""


class ResultTable:
    """A table whose rows are those of ``work_table.rows``; each column can be sorted by.

    ``entries`` returns name, case file and folder of the result of each row; ``title`` is the name
    of its files. ``lettered``: rows have letters, and inputs that differ stand elsewhere.
    """

    def __init__(
        self,
        session: Session,
        title: str,
        entries: Callable[[], Sequence[Any]],
        *,
        lettered: bool = False,
    ) -> None:
        self.session, self.text, self.title, self.entries = session, session.text, title, entries
        self.lettered = lettered
        self.kind = "result" if lettered else "variant"
        self.rows: list[dict[str, Any]] = []
        self._inputs: list[str] = []
        with ui.element("div").classes("row no-print"):
            for kind in ("csv", "xlsx"):
                button = ui.button(self.text(f"table.{kind}"), icon="table_view")
                button.on_click(partial(self._file, kind)).props("flat no-caps dense")
        self.place = ui.element("div")
        self.more = ui.label("").classes("soft")
        self.made: ui.table | None = None

    async def show(self, states: dict[str, str] | None = None) -> list[dict[str, Any]]:
        """Show what is known now and return it; ``states`` has words for rows that are computed."""
        found = await self.session.ask(f"{WORK}:rows", self.entries())
        inputs = [] if self.lettered else [path for path, _ in found["inputs"]]
        self.rows = [
            {
                **row,
                "letter": letter,
                "link": address("/answer", variant=row["name"]),
                "picture": self.session.picture(row["name"], self.kind),
                "is": self._state(row, states),
                "judged": self.text(f"answer.{row['verdict']}") if row["verdict"] else "",
            }
            for letter, row in zip_longest(ascii_uppercase, found["rows"])
            if row is not None
        ]
        if self.made is None or inputs[:INPUTS] != self._inputs:
            self._inputs = inputs[:INPUTS]
            self.place.clear()
            with self.place:
                self.made = self._table(inputs[:INPUTS])
        else:
            self.made.rows = self.rows
            self.made.update()
        more = len(inputs) - INPUTS
        self.more.text = self.text("table.more", count=more) if more > 0 else ""
        return self.rows

    def _state(self, row: dict[str, Any], states: dict[str, str] | None) -> str:
        told = (states or {}).get(row["name"]) if row["state"] != "current" else None
        words = told or self.text(f"table.{row['state']}")
        return f"{words}: {row['remark']}" if row["remark"] and not told else words

    def _table(self, inputs: list[str]) -> ui.table:
        labels = {"letter": ""} if self.lettered else {}
        labels |= {"name": self.text("table.variant")}
        labels |= {name: self.text(f"compare.{name}") for name in NUMBERS[:2]}
        labels |= {"judged": self.text("table.verdict"), "is": self.text("table.state")}
        labels |= {path: self.text.get(f"inputs.{path}", path) for path in inputs}
        labels |= {name: self.text(f"compare.{name}") for name in NUMBERS[2:]}
        columns = [
            {"name": name, "label": label, "field": name, "sortable": True, "align": "left"}
            for name, label in labels.items()
        ]
        made = ui.table(columns=columns, rows=self.rows, row_key="name").props("flat dense")
        made.classes("result-table")
        link = '<a :href="props.row.link" translate="no">{{ props.row.name }}</a>'
        made.add_slot("body-cell-name", f'<q-td><div class="named">{link}{SOLE}</div></q-td>')
        for name in (*inputs, *NUMBERS):  # sorted by the number, shown with unit and interval
            old = "" if name in inputs else OLD
            cell = f"<q-td {old}>{{{{ props.row['{name}_text'] }}}}</q-td>"
            made.add_slot(f"body-cell-{name}", cell)
        return made

    async def _file(self, kind: str) -> None:
        ui.download.file(
            await self.session.ask(f"{WORK}:written", self.entries(), self.title, kind)
        )
