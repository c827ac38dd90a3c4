"""Design studies: the study file as a form, what it will take, its run, and what came of it."""

from __future__ import annotations

import json
import re
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from functools import partial
from typing import Any

import tomlkit
from nicegui import ui
from nicegui.events import GenericEventArguments

from underfoot.case import unit_at
from underfoot.case.parts import paths
from underfoot.core import InputError
from underfoot.core.errors import UnderfootError
from underfoot.core.files import whole_file
from underfoot.core.typed import split_quantity
from underfoot.core.unit_text import display
from underfoot.core.units import to_si

from ..components import SoleView, interruption, sentences, task_line, title
from ..inputs import read_count, read_field, whole_number
from ..jobs import QueuedTask
from ..labels import package_label
from ..project import NAME
from ..session import Session, address, problem_parts
from ..variant_bar import new_variant

ROUTE = "/studies"
WORK = "underfoot.app.work_studies"
COMPUTED = f"{WORK}:computed"
KINDS = {"normal": ("normal", "sd"), "lognormal": ("lognormal", "factor"), "even": ("from", "to")}
"""Keys of the two numbers of each distribution."""
FIELDS = {
    "vary": ("from", "to", "steps", "values"),
    "uncertain": ("kind", "first", "second"),
    "conditions": ("values",),
}
SEPARATOR = re.compile(r"\s*(?:;|,(?=\s)|(?<!\d),|,(?!\d))\s*")
"""Between values: a comma between digits belongs to a number."""
GOALS = ("maximise", "minimise", "require")
METHOD = {
    "kind": ("sweep", "sensitivity", "optimise", "robust"),
    "budget": (),
    "draws": (),
    "grid": ("quick", "standard"),
    "front_grid": ("", "none", "quick", "standard"),
}
WIDE = 0.3
"""Share of a value by which a new range goes to either side of it."""
NEW = """\
file_version = 1
base = "../variants/{variant}.toml"

[vary]
"shoe.tread.depth" = {{ from = "1 mm", to = "4 mm" }}
"shoe.tread.channel_width" = {{ from = "2 mm", to = "4 mm" }}

[outputs]
maximise = ["cof"]
minimise = ["rubber_volume"]

[method]
kind = "optimise"
budget = 40
"""


def build(session: Session) -> None:
    """Show the study of the address, or the studies there are and how to begin one."""
    ui.add_head_html('<script defer src="/viewer/design_study.js"></script>')
    files = session.project.inside("studies").glob("*.toml")
    names = sorted(file.stem for file in files if NAME.fullmatch(file.stem))
    name = session.query.get("study", "")
    if name in names:
        _Study(session, name)
        return
    text = session.text
    title(text("studies.title")).classes("hidden-title")
    ui.label(text("studies.lead")).classes("lead")
    with ui.element("div").classes("recent"):
        for each in names:
            with ui.element("div").classes("recent-row"):
                ui.link(each, address(ROUTE, study=each))
    begin = ui.button(text("studies.new"), icon="add", on_click=lambda: example(session))
    begin.props("no-caps unelevated")


def example(session: Session) -> None:
    """Begin a study of the variant that was changed last, of a new one where there is none."""
    variant = session.variant or new_variant(session, session.text("design.example"))
    wanted, number = f"{variant} {session.text('studies.word')}", 1
    name = wanted
    while session.project.inside("studies", f"{name}.toml").exists():
        number += 1
        name = f"{wanted} {number}"
    with whole_file(session.project.inside("studies", f"{name}.toml")) as part:
        part.write_text(NEW.format(variant=variant), encoding="utf-8")
    session.go(ROUTE, study=name)


class _Study:
    """The page of one study: its file is the truth, the form and the text are views of it."""

    def __init__(self, session: Session, name: str) -> None:
        self.session, self.text, self.name = session, session.text, name
        self.file = session.project.inside("studies", f"{name}.toml")
        self.at = (str(self.file), str(self.file.with_suffix("")))
        self.chosen = -1
        self.sheet: dict[str, Any] | None = None
        title(name).classes("hidden-title")
        with ui.element("div").classes("bar-row"):
            back = ui.button(icon="arrow_back", on_click=lambda: session.go(ROUTE))
            back.props(f'flat round dense aria-label="{self.text("studies.all")}"')
            ui.label(name).classes("strong")
            ui.space()
            self.run_button = ui.button(icon="play_arrow", on_click=self.run)
            self.run_button.props("no-caps unelevated").classes("main-action")
            self.run_button.disable()  # until the study is read
        with ui.element("div").classes("split"):
            with ui.element("section").classes("side"):
                with ui.tabs().props("dense no-caps align=left") as tabs:
                    made = [ui.tab(key, self.text(f"studies.{key}")) for key in ("form", "file")]
                with ui.tab_panels(tabs, value=made[0], animated=False).props("keep-alive"):
                    self.form = ui.tab_panel(made[0])
                    with ui.tab_panel(made[1]):
                        self.editor = ui.textarea(value=self.study_text()).classes("study-file")
                        self.editor.props("autogrow outlined spellcheck=false")
                        self.editor.on("blur", self._take_text)
            with ui.element("section").classes("study-results"):
                self.checked = ui.element("div").props('role="status"')
                self.progress = ui.element("div")
                with ui.element("div").classes("study-row") as self.steps:
                    self.stop_button = ui.button(self.text("studies.stop"), on_click=self.stop)
                    self.more = ui.input(self.text("studies.more"))
                    self.more.props("dense outlined inputmode=numeric")
                    self.widen_button = ui.button(self.text("studies.widen"), on_click=self.widen)
                    for each in (self.stop_button, self.widen_button):
                        each.props("flat no-caps")
                    ui.label(self.text("studies.wider")).classes("soft")
                self.plots = ui.element("div").classes("report")
                self.plots.on("chosen", self._choose, args=["detail"])
                with ui.element("div").classes("bar-row") as self.design:
                    self.caption = ui.label().classes("strong")
                    variant = ui.button(self.text("studies.to_variant"), icon="content_copy")
                    variant.on_click(self._to_variant).props("flat no-caps")
                self.sole = SoleView(session)
                self.rest = ui.element("div").classes("report")
        for each in (self.design, self.sole, self.steps):
            each.set_visibility(False)
        ui.timer(0, self._open, once=True)

    def study_text(self) -> str:
        """Return the study file."""
        return self.file.read_text(encoding="utf-8")

    async def _open(self) -> None:
        await self._fill()
        self.sheet = await self._check()
        task = self.session.jobs.latest(self.name, COMPUTED)
        if task is not None and task.open:
            self._follow(task)
        elif self._working:
            self._watch(others=True)
        else:
            with self.progress:
                interruption(self.session, task)
        if self.sheet and self.sheet["ended"]:
            await self._show(whole=not self._working)

    # the file

    async def _fill(self) -> None:
        """Fill the form from the file."""
        try:
            plain = await self.session.ask(f"{WORK}:form", self.study_text())
        except UnderfootError:
            return  # the check says what is wrong with the text
        self.form.clear()
        with self.form:
            self._base(str(plain.get("base", "")))
            for section in FIELDS:
                _Rows(self, section, plain.get(section, {}))
            self._heading("outputs")
            for goal in GOALS:
                self._goals(goal, plain.get("outputs", {}))
            self._heading("method")
            with ui.element("div").classes("study-row"):
                for key, options in METHOD.items():
                    self._method(key, options, plain.get("method", {}))

    def _heading(self, key: str) -> None:
        title(self.text(f"studies.{key}"), 2)
        ui.label(self.text(f"studies.{key}_hint")).classes("soft")

    def _base(self, base: str) -> None:
        known = {
            f"../variants/{variant}.toml": variant for variant in self.session.project.variants()
        }
        choice = ui.select({**({base: base} if base else {}), **known}, value=base or None)
        choice.props("dense outlined options-dense").props(f'label="{self.text("studies.base")}"')

        async def keep_base() -> None:
            await self.keep("base", choice.value)

        choice.on_value_change(keep_base)

    def _goals(self, goal: str, given: Mapping[str, Any]) -> None:
        listed = given.get(goal, [])
        lines = "\n".join(map(str, listed if isinstance(listed, list) else [listed]))
        area = ui.textarea(self.text(f"studies.{goal}"), value=lines)
        area.props("autogrow dense outlined spellcheck=false")

        async def keep_goals() -> None:
            wanted = [line.strip() for line in (area.value or "").splitlines() if line.strip()]
            await self.keep("outputs", {goal: wanted or None}, part=True)

        area.on("blur", keep_goals)

    def _method(self, key: str, options: tuple[str, ...], given: Mapping[str, Any]) -> None:
        value, label = given.get(key, ""), self.text(f"studies.{key}")
        field: Any
        if options:
            words = {option: self.text(f"studies.{key}_{option or 'usual'}") for option in options}
            field = ui.select(words, value=value if value in options else options[0], label=label)
            field.props("options-dense")
        else:
            field = ui.input(label, value=str(value or ""))
            field.props("inputmode=numeric")
        field.props("dense outlined")

        async def keep_field() -> None:
            try:
                new = (field.value or None) if options else read_count(self.session, field)
            except InputError:
                return  # the field says what is wrong
            await self.keep("method", {key: new}, part=True)

        field.on_value_change(keep_field) if options else field.on("blur", keep_field)

    async def keep(self, section: str, value: Any, *, part: bool = False) -> None:
        """Write a section of the file anew, or with ``part`` some keys of it (None: gone)."""
        document = tomlkit.parse(self.study_text())
        if isinstance(value, Mapping):
            table = document.get(section) if part else None
            table = tomlkit.table() if table is None else table
            for key, item in value.items():
                if item is None:
                    table.pop(key, None)
                elif isinstance(item, Mapping):
                    table[key] = tomlkit.inline_table()
                    table[key].update(item)
                else:
                    table[key] = item
            document[section] = table
        else:
            document[section] = value
        await self._write(tomlkit.dumps(document))

    async def _take_text(self) -> None:
        text = self.editor.value or ""
        if text != self.study_text():
            await self._write(text)
            await self._fill()

    async def _write(self, text: str) -> None:
        if text == self.study_text():
            return
        with whole_file(self.file) as part:
            part.write_text(text, encoding="utf-8")
        self.editor.value = text
        self.sheet = await self._check()

    async def _check(self, seen: int | None = None) -> dict[str, Any] | None:
        """Say what the study will take, how far it is, or what is wrong with the file.

        With the number of cases that are ``seen``: for a study that runs.
        """
        sheet = problem = None
        try:
            sheet = await self.session.ask(f"{WORK}:state", *self.at, seen)
        except UnderfootError as error:
            problem = error
        self.checked.clear()
        with self.checked:
            for kind, words in problem_parts(problem) if problem else ():
                package_label(words).classes(f"problem-{kind}")
            if sheet:
                ui.label(" ".join(sheet["headline"])).classes("lead")
                sentences(sheet["cautions"], "soft")
                for kind, lines in sheet["remarks"].items():
                    sentences([f"{kind}: {line}" for line in lines[:3]], "soft")
        words = "run" if not (sheet and sheet["begun"]) else "go_on" if sheet["open"] else "done"
        self.run_button.text = self.text(f"studies.{words}")
        self.run_button.set_enabled(words != "done" and sheet is not None)
        self._working = sheet["working"] if sheet and sheet["begun"] else 0
        budget = sheet["budget"] if sheet and sheet["begun"] else None
        self.steps.set_visibility(bool(self._working or budget))
        self.stop_button.set_visibility(self._working > 0)
        for each in (self.more, self.widen_button):
            each.set_visibility(budget is not None)
        self.more.value = self.more.value or (str(max(1, budget // 2)) if budget else "")
        return sheet

    # the run

    async def run(self) -> None:
        """Compute what is not finished; what is finished stays, however the run ends."""
        name = self.text("studies.job")
        self._follow(self.session.submit(name, COMPUTED, *self.at, about=self.name))

    async def stop(self) -> None:
        """Stop whoever computes: this app, and others in the same folder."""
        await self.session.ask(f"{WORK}:stop", *self.at)

    async def widen(self) -> None:
        """Give the study more runs, and go on."""
        try:
            more = read_count(self.session, self.more)
        except InputError:
            return  # the field says what is wrong
        task = self.session.jobs.latest(self.name, COMPUTED)
        if task is not None and task.open:
            self.session.jobs.cancel(task)
            await self.session.jobs.wait_for(task)
        if self.sheet and self.sheet["budget"] and more:
            await self.keep("method", {"budget": self.sheet["budget"] + more}, part=True)
            await self._fill()
        await self.run()

    def _follow(self, task: QueuedTask) -> None:
        timer = self._watch()

        async def show_end(ended: QueuedTask) -> None:
            timer.deactivate()
            if ended.problem:
                self.session.tell(InputError(ended.problem))
            self.sheet = await self._check()
            await self._show()

        with self.progress:
            task_line(self.session, task, show_end)

    def _watch(self, *, others: bool = False) -> ui.timer:
        """Show again and again how far it is, with ``others`` as long as they work on it."""
        self.run_button.set_enabled(False)
        count = self.sheet["ended"] if self.sheet else 0
        began, spent = time.monotonic(), 0.0

        async def look() -> None:
            nonlocal count, spent
            self.sheet = sheet = await self._check(count)
            self.run_button.set_enabled(others and not self._working)
            if others and not self._working:
                timer.deactivate()
                await self._show()
            elif sheet and "parts" in sheet:
                count = sheet["ended"]
                self._put(sheet["parts"])
            spent += sheet.get("seconds", 0.0) if sheet else 0.0
            timer.interval = max(LOOK, spent / SHARE - (time.monotonic() - began))

        timer = ui.timer(LOOK, look)
        return timer

    # what came of it

    async def _show(self, *, whole: bool = True) -> None:
        """Show what is finished."""
        self._put(await self.session.ask(f"{WORK}:results", *self.at, whole))

    def _put(self, parts: Sequence[str]) -> None:
        addresses = [self.session.keep(part) for part in parts]
        ui.run_javascript(f"showStudy({self.plots.html_id!r}, {addresses[0]!r})")
        ui.run_javascript(f"showPart({self.rest.html_id!r}, {addresses[1]!r})")

    async def _choose(self, event: GenericEventArguments) -> None:
        """Show the sole of the design that was clicked."""
        self.chosen = int(event.args["detail"])
        shown = await self.session.ask(f"{WORK}:design", *self.at, self.chosen)
        self.caption.text = self.text("studies.design", number=self.chosen)
        self.design.set_visibility(True)
        self.sole.set_visibility(True)
        self.sole.show(shown["html"])

    async def _to_variant(self) -> None:
        """Make a variant of the design that is shown."""
        shown = await self.session.ask(f"{WORK}:design", *self.at, self.chosen)
        project = self.session.project
        name = project.free_name(f"{self.name} {self.chosen}")
        project.add(name, str(tomlkit.dumps({**tomlkit.parse(shown["case"]), "name": name})))
        ui.notify(self.text("studies.made", name=name))


LOOK = 1.0
"""s between two looks at a study that runs, at least ..."""
SHARE = 0.05
"""... and of one processor what all looks may take. What a look waits, beside the study's workers,
does not count: else the first would come late, and the next later still."""


class _Rows:
    """The rows of a section: a path and what is said of it; what no row can say stays as it is."""

    def __init__(self, page: _Study, section: str, given: Mapping[str, Any]) -> None:
        self.page, self.section, self.text = page, section, page.text
        self.rows: list[Callable[[], tuple[str, Any]]] = []
        page._heading(section)
        self.place = ui.element("div")
        for path, value in given.items():
            self.add(path, value)
        more = ui.button(self.text(f"studies.add_{section}"), icon="add")
        more.on_click(lambda: self.add("", {})).props("flat dense no-caps")

    def add(self, path: str, value: Any) -> None:
        """Show a row."""
        shown = _fields(self.section, value)
        with self.place, ui.element("div").classes("study-row") as row:
            if shown is None:
                ui.label(f"{path} = {json.dumps(value, ensure_ascii=False)}")
                self._keep(row, lambda: (path, value))
                return
            options = [*({path} if path else ()), *ALIASES[self.section], *paths()]
            choice = ui.select(options, value=path or None, with_input=True)
            choice.props("dense outlined options-dense").classes("study-path")
            choice.props(f'label="{self.text("studies.path")}"')
            fields: dict[str, Any] = {}
            good: list[Any] = [path, value]

            def read_row() -> tuple[str, Any]:
                at, comma = choice.value or "", self.text.comma
                given = {key: field.value or "" for key, field in fields.items()}
                for key in given.keys() - {"kind"}:
                    fields[key].error = None

                def read_cell(key: str, reader: Callable[[str], Any]) -> Any:
                    return read_field(fields[key], reader)

                with suppress(InputError):  # its field tells it; the file keeps what it has
                    good[:] = at, _value(self.section, at, given, comma=comma, read=read_cell)
                return good[0], good[1]

            self._keep(row, read_row)
            fields |= {key: self._field(key, shown[key]) for key in FIELDS[self.section]}
            choice.on_value_change(lambda: self._propose(choice.value, fields))

    def _keep(self, row: ui.element, read: Callable[[], tuple[str, Any]]) -> None:
        """Count a row, and show the button that removes it."""
        self.rows.append(read)

        async def remove() -> None:
            self.rows.remove(read)
            row.delete()
            await self.write_section()

        gone = ui.button(icon="close", on_click=remove).props("flat round dense")
        gone.props(f'aria-label="{self.text("studies.remove")}"')

    def _field(self, key: str, value: str) -> Any:
        label = self.text(f"studies.field_{key}")
        if key == "kind":
            kinds = {kind: self.text(f"studies.{kind}") for kind in KINDS}
            made: Any = ui.select(kinds, value=value or "normal", label=label)
            made.on_value_change(self.write_section)
        else:
            made = ui.input(label, value=value)
            made.on("blur", self.write_section)
            made.on("keydown.enter", self.write_section)
        return made.props("dense outlined").classes(f"study-{key}")

    async def _propose(self, path: str, fields: Mapping[str, Any]) -> None:
        """Propose a range about the value of the base, where the path is new."""
        variant = (await self.page.session.ask(f"{WORK}:form", self.page.study_text())).get(
            "base", ""
        )
        name = str(variant).removeprefix("../variants/").removesuffix(".toml")
        known = name in self.page.session.project.variants()
        value = self.page.session.project.case(name).value(path) if known and "." in path else None
        if isinstance(value, float) and value > 0 and not any(f.value for f in fields.values()):
            unit, ends = unit_at(path), {"from": 1 - WIDE, "to": 1 + WIDE}
            for key, factor in ends.items():
                if key in fields:
                    fields[key].value = display(value * factor, unit)
        await self.write_section()

    async def write_section(self) -> None:
        """Write the section as its rows say; rows that say nothing yet are left out."""
        fields = dict(read() for read in self.rows)
        await self.page.keep(self.section, {k: v for k, v in fields.items() if k and v})


ALIASES = {"vary": (), "uncertain": (), "conditions": ("wear",)}
"""Short names of paths, where a section knows any."""


def _fields(section: str, value: Any) -> dict[str, str] | None:
    """Return what a row shows of a value; None where a row can't."""
    fields = dict.fromkeys(FIELDS[section], "")
    if isinstance(value, list) and "values" in fields:
        return fields | {"values": "; ".join(map(str, value))}
    if not isinstance(value, Mapping) or (section == "conditions" and value):
        return None
    if section == "uncertain":
        for kind, keys in KINDS.items():
            if set(keys) == set(value):
                first, second = (str(value[key]) for key in keys)
                return {"kind": kind, "first": first, "second": second}
    return fields | {k: str(v) for k, v in value.items()} if set(value) <= set(fields) else None


def _value(
    section: str,
    path: str,
    fields: Mapping[str, str],
    *,
    comma: bool = False,
    read: Callable[[str, Callable[[str], Any]], Any] | None = None,
) -> Any:
    """Return what the file says for what a row shows; None while it is not complete.

    ``read`` gets the name of a field and what reads its text.

    Raises:
        InputError: A field holds no such value.
    """
    read = read or (lambda key, reader: reader(fields[key]))
    if fields.get("values", "").strip():
        each = partial(typed_value, path=path, comma=comma, names=True)
        return read(
            "values", lambda text: [each(part) for part in SEPARATOR.split(text.strip()) if part]
        )
    ends = ("first", "second") if section == "uncertain" else ("from", "to")
    if not all(fields.get(key, "").strip() for key in ends):
        return None
    keys = KINDS[fields["kind"]] if section == "uncertain" else ends
    value = {
        key: read(end, partial(typed_value, path="" if key == "factor" else path, comma=comma))
        for key, end in zip(keys, ends, strict=True)
    }
    if fields.get("steps", "").strip():
        value["steps"] = read("steps", partial(whole_number, comma=comma))
    return value


def typed_value(text: str, path: str, *, comma: bool, names: bool = False) -> Any:
    """Return what was typed of a value at a path as a study file writes it: a number, a quantity.

    Parameters:
        text: What was typed.
        path: In a case; "" for a number without a unit.
        comma: The writer's decimal sign is the comma.
        names: What is no number may stand, as the name of a pattern.

    Raises:
        InputError: No number, one that can be two, a unit that is missing or of another quantity.
    """
    unit = "1"
    with suppress(InputError):  # a section, a short name, a path that the check of the file refuses
        unit = unit_at(path)
    parts = split_quantity(text, comma=comma)
    if names and unit == "1" and (parts is None or parts[1]):
        return text
    value = to_si(text, unit, where="", comma=comma)
    if unit == "1":
        return int(value) if value == int(value) else value
    assert parts is not None  # else it was refused above
    return f"{repr(parts[0]).removesuffix('.0')} {parts[1]}"
