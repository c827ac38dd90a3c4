"""Pages of studies and comparisons, the frame, and how the server opens its door."""

import asyncio
import json
import socket
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
import tomlkit
from nicegui import ui

from page_session import (
    answering,
    button,
    computed,
    press,
    session_of,
    session_of_a_variant,
    shown,
    until,
    words_of,
)
from underfoot.app import frame, projects, serve, work, work_studies
from underfoot.app.jobs import DONE, FAILED, RUNNING, STOPPED, QueuedTask
from underfoot.app.pages import compare, studies
from underfoot.app.pages.studies import _fields, _value
from underfoot.app.project import Project
from underfoot.app.variant_bar import new_variant
from underfoot.core import InputError, silent

SHEET: dict[str, Any] = {
    "headline": ["Twelve cases.", "An hour."], "cautions": ["careful"],
    "remarks": {"Note": ["1", "2", "3", "4"]}, "ended": 0, "begun": False, "open": True,
}  # fmt: skip


@pytest.fixture
def session(tmp_path):
    return session_of_a_variant(tmp_path)


# studies


def test_a_new_study_is_of_the_variant_and_has_a_name_of_its_own(session, monkeypatch):
    went = []
    monkeypatch.setattr(session, "go", lambda route, **query: went.append(query["study"]))
    for _ in range(3):
        studies.example(session)
    name = f"a {session.text('studies.word')}"
    assert went == [name, f"{name} 2", f"{name} 3"]
    file = session.project.inside("studies", f"{name}.toml")
    assert tomlkit.parse(file.read_text("utf-8"))["base"] == "../variants/a.toml"
    names = [each.text for each in shown(lambda: studies.build(session), lambda e: [
        each for each in e if isinstance(each, ui.link)])]  # fmt: skip
    assert names == went


def study_page(session, monkeypatch, look, sheet, form=None, **answers):
    """Return what ``look`` finds on the page of a study once its form is filled."""
    monkeypatch.setattr(session, "go", lambda *_, **__: None)
    studies.example(session)
    (file,) = session.project.inside("studies").glob("*.toml")
    pages, put = [], []
    asked = answering(monkeypatch, session, form=form or {"base": "../variants/a.toml"},
                      state=sheet, results=["plots", "rest"], **answers)  # fmt: skip
    monkeypatch.setattr(studies._Study, "_put", lambda _, parts: put.append(parts))

    def build():
        pages.append(studies._Study(session, file.stem))

    async def ready(elements):
        await until(lambda: any(name == "state" for name, *_ in asked))
        await asyncio.sleep(0.05)
        found = look(pages[0], elements)
        return await found if asyncio.iscoroutine(found) else found

    return shown(build, ready), asked, put, file


@pytest.mark.parametrize(
    ("sheet", "run", "enabled", "steps", "stop", "more"),
    [
        (SHEET, "run", True, False, False, None),
        (SHEET | {"begun": True, "working": 0, "budget": None}, "go_on", True, False, False, None),
        (SHEET | {"begun": True, "working": 0, "budget": 41}, "go_on", True, True, False, "20"),
        (SHEET | {"begun": True, "working": 0, "budget": 1}, "go_on", True, True, False, "1"),
        (SHEET | {"begun": True, "working": 2, "budget": None}, "go_on", False, True, True, None),
        (SHEET | {"begun": True, "open": False, "working": 0, "budget": 8}, "done", False, True,
         False, "4"),
        (InputError("no base", where="base"), "run", False, False, False, None),
    ],
)  # fmt: skip
def test_a_study_says_how_far_it_is_and_offers_what_is_left(
    session, monkeypatch, sheet, run, enabled, steps, stop, more
):
    def look(page, elements):
        text = session.text
        assert page.run_button.text == text(f"studies.{run}")
        assert page.run_button.enabled is enabled
        assert page.steps.visible is steps
        if steps:
            assert page.stop_button.visible is stop
            assert page.widen_button.visible is page.more.visible is (more is not None)
        assert (page.more.value or None) == more
        return words_of(elements)

    words, *_ = study_page(session, monkeypatch, look, sheet)
    if isinstance(sheet, dict):
        assert "Twelve cases. An hour." in words
        assert "careful" in words
        assert [w for w in words if w.startswith("Note: ")] == ["Note: 1", "Note: 2", "Note: 3"]
    else:
        assert "base" in words
        assert "no base" in words


@pytest.mark.parametrize(("ended", "working", "whole"), [(0, 0, None), (3, 0, True), (3, 2, False)])
def test_what_is_finished_of_a_study_is_shown_at_once(session, monkeypatch, ended, working, whole):
    sheet = SHEET | {"ended": ended, "begun": ended > 0, "working": working, "budget": None}
    _, asked, put, _ = study_page(session, monkeypatch, lambda *_: None, sheet)
    given = [args[-1] for name, args, _ in asked if name == "results"]
    assert given == ([] if whole is None else [whole])
    assert put == ([["plots", "rest"]] if ended else [])


@pytest.mark.parametrize(("typed", "budget"), [("5", 45), ("", None), ("some", ...)])
def test_a_study_is_widened_by_what_is_typed_and_goes_on(session, monkeypatch, typed, budget):
    sheet = SHEET | {"ended": 40, "begun": True, "working": 0, "budget": 40}

    ran = []

    async def look(page, elements):
        async def run():
            ran.append(1)

        page.run, page.more.value = run, typed
        await page.widen()
        return bool(page.more.error)

    error, _, _, file = study_page(session, monkeypatch, look, sheet)
    written = tomlkit.parse(file.read_text("utf-8"))["method"]["budget"]
    assert written == (budget if isinstance(budget, int) else 40)
    assert error is (budget is ...)
    assert ran == ([] if error else [1])


def test_a_study_is_run_once_more_and_a_design_of_it_becomes_a_variant(session, monkeypatch):
    case = session.project.text("a").replace('name = "a"', 'name = "b"')
    followed = []

    async def look(page, elements):
        page._follow = followed.append
        await page.run()
        sole = []
        page.sole.show = sole.append
        await page._choose(SimpleNamespace(args={"detail": "7"}))
        await page._to_variant()
        return page.caption.text, page.design.visible, page.sole.visible, sole

    design = {"html": "the sole", "case": case}
    seen, asked, _, file = study_page(session, monkeypatch, look, SHEET, {}, design=design)
    assert seen == (session.text("studies.design", number=7), True, True, ["the sole"])
    (task,) = followed
    assert (task.function, task.about) == (studies.COMPUTED, file.stem)
    assert tuple(task.arguments) == (str(file), str(file.with_suffix("")))
    assert [args[-1] for name, args, _ in asked if name == "design"] == [7, 7]
    assert f"{file.stem} 7" in session.project.variants()


def test_a_form_shows_what_the_file_says_and_writes_what_is_changed(session, monkeypatch):
    form = {
        "base": "../variants/a.toml", "outputs": {"maximise": ["cof", "x"], "require": "cof > 0.2"},
        "method": {"kind": "robust", "budget": 40},
        "vary": {"motion.speed": {"from": "1 m/s", "to": "2 m/s"}, "odd": {"else": 1}},
    }  # fmt: skip

    async def look(page, elements):
        areas = {each.props.get("label"): each for each in elements
                 if isinstance(each, ui.textarea) and "label" in each.props}  # fmt: skip
        lines = {key: areas[session.text(f"studies.{key}")].value for key in studies.GOALS}
        area = areas[session.text("studies.minimise")]
        area.value = " rubber_volume \n\ncof\n"
        press(area, "blur")
        await asyncio.sleep(0.05)
        tabs = {each.props["name"]: each.props["label"] for each in elements
                if isinstance(each, ui.tab)}  # fmt: skip
        assert tabs == {key: session.text(f"studies.{key}") for key in ("form", "file")}
        odd = [word for word in words_of(elements) if word.startswith("odd")]
        selects = {each.props.get("label"): each for each in elements
                   if isinstance(each, ui.select)}  # fmt: skip
        kind = selects[session.text("studies.kind")]
        value = kind.value
        kind.value = "sweep"
        await asyncio.sleep(0.05)
        return lines, odd, value

    found, _, _, file = study_page(session, monkeypatch, look, SHEET, form)
    lines, odd, value = found
    assert lines == {"maximise": "cof\nx", "minimise": "", "require": "cof > 0.2"}
    assert odd == ['odd = {"else": 1}']
    assert value == "robust"
    written: Any = tomlkit.parse(file.read_text("utf-8"))
    assert list(written["outputs"]["minimise"]) == ["rubber_volume", "cof"]
    assert list(written["outputs"]["maximise"]) == ["cof"]
    assert (written["method"]["kind"], written["method"]["budget"]) == ("sweep", 40)


@pytest.mark.parametrize(("path", "old", "proposed"), [
    ("motion.speed", "", True), ("motion.speed", "1 m/s", False), ("speed", "", False),
])  # fmt: skip
def test_a_new_path_is_proposed_a_range_about_its_value(session, path, old, proposed):
    page: Any = SimpleNamespace(session=session, study_text=lambda: 'base = "../variants/a.toml"')
    fields = {key: SimpleNamespace(value=old * (key == "from")) for key in ("from", "to")}
    changed = []

    async def change():
        changed.append(1)

    rows: Any = SimpleNamespace(page=page, write_section=change)
    asyncio.run(studies._Rows._propose(rows, path, fields))
    speed = session.project.case("a").value("motion.speed")
    wanted = [f"{share * speed:.3g}" for share in (0.7, 1.3)] if proposed else [old, ""]
    assert [field.value.partition(" ")[0] for field in fields.values()] == [
        each.partition(" ")[0] for each in wanted
    ]
    assert changed == [1]


@pytest.mark.parametrize(
    ("section", "value", "row"),
    [
        ("vary", ["1 mm", "2 mm"], {"values": "1 mm; 2 mm"}),
        ("vary", {"from": "1 mm", "to": "2 mm", "steps": 3},
         {"from": "1 mm", "to": "2 mm", "steps": "3"}),
        ("vary", {"like": 1}, None),
        ("vary", 5, None),
        ("uncertain", {"normal": "1 mm", "sd": "2 mm"},
         {"kind": "normal", "first": "1 mm", "second": "2 mm"}),
        ("uncertain", {"from": "1 mm", "to": "2 mm"},
         {"kind": "even", "first": "1 mm", "second": "2 mm"}),
        ("uncertain", ["1 mm"], None),
        ("conditions", ["1 mm"], {"values": "1 mm"}),
        ("conditions", {}, {}),
        ("conditions", {"values": 1}, None),
    ],
)  # fmt: skip
def test_a_row_shows_what_a_file_says_where_it_can(section, value, row):
    blank = dict.fromkeys(studies.FIELDS[section], "")
    assert _fields(section, value) == (None if row is None else blank | row)


@pytest.mark.parametrize(
    ("section", "fields", "value"),
    [
        ("vary", {"from": "1 mm", "to": "2 mm", "steps": "3", "values": ""},
         {"from": "1 mm", "to": "2 mm", "steps": 3}),
        ("vary", {"from": "1 mm", "to": "", "values": ""}, None),
        ("vary", {"from": "", "to": "", "values": "1 mm;2 mm; "}, ["1 mm", "2 mm"]),
        ("uncertain", {"kind": "lognormal", "first": "1 mm", "second": "1.5"},
         {"lognormal": "1 mm", "factor": 1.5}),
        ("uncertain", {"kind": "even", "first": "1 mm", "second": "2 mm"},
         {"from": "1 mm", "to": "2 mm"}),
    ],
)  # fmt: skip
def test_a_row_is_written_as_the_file_says_it(section, fields, value):
    assert _value(section, "shoe.tread.depth", fields) == value


# comparisons


def comparing(session, monkeypatch, look, **answers):
    for name in "abc":
        if name != "a":
            new_variant(session, name, shoe="work_shoe_half_tread", contaminant="detergent")
        computed(session, name)
    pages: list[Any] = []
    asked = answering(monkeypatch, session, **answers)

    async def table(*_):
        return []

    monkeypatch.setattr(compare.ResultTable, "show", table)

    async def ready(elements):
        await until(lambda: asked)
        await asyncio.sleep(0.05)
        found = look(pages[0], elements)
        return await found if asyncio.iscoroutine(found) else found

    return shown(lambda: pages.append(compare._Compare(session)), ready), asked


COMPARED: dict[str, Any] = {
    "headline": ["b is better.", "By 5 %."], "cautions": ["mind"], "open": False, "html": "<i>",
    "letters": ["A", "B"], "chances": [["", "25 %"], ["75 %", ""]],
    "tables": [{"title": "Inputs", "columns": ["", "A", "B"], "shows": "",
                "rows": [["motion.speed", "1", "2"], ["other", "3", "4"]]}],
}  # fmt: skip


@pytest.mark.parametrize("asked_for", ["", "c|b", "c|gone"])
def test_results_of_the_address_are_compared_else_the_first_two(tmp_path, monkeypatch, asked_for):
    session = session_of(tmp_path, variants=asked_for)
    new_variant(session, "a", shoe="work_shoe_half_tread", contaminant="detergent")
    monkeypatch.setattr(Project, "is_current", lambda _, name: name == "c")

    def look(page, elements):
        return list(page.choice.value), words_of(elements), page._entries()

    found, asked = comparing(session, monkeypatch, look, comparison=COMPARED)
    chosen, words, entries = found
    names = [each.name for each in session.project.results()]
    if asked_for == "c|gone":
        assert chosen == ["c"]
        return
    assert chosen == (asked_for.split("|") if asked_for else names[:2])
    folders = [str(session.project.result_folder(name)) for name in chosen]
    assert asked[0][:2] == ("comparison", (folders,))
    assert entries == [(name, str(Path(folder) / "case.toml"), folder)
                       for name, folder in zip(chosen, folders, strict=True)]  # fmt: skip
    text = session.text
    assert [name for name in "abc" if text("compare.changed", name=name) in words] == [
        name for name in "abc" if name in chosen and name != "c"
    ]
    assert "b is better. By 5\u00a0%." in words
    for said in ("mind", text("inputs.motion.speed"), "other", "75\u00a0%"):
        assert said in words


@pytest.mark.parametrize("task", [None, "new", "old", "open", "unanswered"])
def test_what_would_tell_an_open_order_is_computed_once_for_these_results(
    session, monkeypatch, task
):
    submitted = []

    def look(page, _):
        return list(page.choice.value)

    names: list[str] = []
    real = session.jobs.latest

    def latest(about, function):
        if function != compare.SEPARATED or task is None:
            return real(about, function)
        names.append(about)
        began = 1e9 if task in ("old", "open") else 4e9
        if task == "open":
            began = 4e9
        made = QueuedTask(
            99, "separate", function, about, state=RUNNING if task == "open" else DONE
        )
        made.began = began
        made.answer = None if task in ("open", "unanswered") else {**COMPARED, "cautions": ["told"]}
        return made

    monkeypatch.setattr(session.jobs, "latest", latest)
    real_submit = session.submit

    def submit(*args, **more):
        submitted.append((args, more))
        return real_submit(*args, **more)

    monkeypatch.setattr(session, "submit", submit)
    chosen, _ = comparing(session, monkeypatch, look, comparison=COMPARED | {"open": True})
    assert len(submitted) == (task in (None, "old", "unanswered"))
    if submitted:
        ((_, function, folders), more) = submitted[0]
        assert function == compare.SEPARATED
        assert folders == [str(session.project.result_folder(name)) for name in chosen]
        assert more == {"about": " | ".join(chosen), "first": True}


@pytest.mark.parametrize("changes", [{}, {"motion.speed": "0.5 m/s"}])
def test_a_second_of_equal_land_is_a_variant_of_its_own_and_may_be_undone(
    session, monkeypatch, changes
):
    monkeypatch.setattr(Project, "is_current", lambda *_: True)
    words = {"before": "1 mm", "after": "2 mm", "land": "50 %", "had": "40 %"}

    async def look(page, elements):
        first, second = page.choice.value
        await page._equal_land()
        said = words_of(page.equal.descendants())
        new = [name for name in session.project.variants() if name not in "abc"]
        speeds = [session.project.case(name).value("motion.speed") for name in new]
        if not changes:
            return first, second, said, new, speeds, None, None
        (task,) = session.jobs.tasks.values()
        press(button(elements, session.text("variant.undo")))
        await asyncio.sleep(0.02)
        return first, second, said, new, speeds, task, session.project.variants()

    found, _ = comparing(session, monkeypatch, look, comparison=COMPARED,
                         equal_land=(changes, words))  # fmt: skip
    first, second, said, new, speeds, task, left = found
    text = session.text
    if not changes:
        assert said == [text("compare.equal_already", a=first, b=second, **words)]
        assert new == []
        return
    assert new == [text("compare.equal_name", a=first, b=second)]
    assert speeds == pytest.approx([0.5])
    assert text("compare.equal_made", a=first, b=second, name=new[0], **words) in said
    assert (task.function, task.about, task.state) == (work_of(), new[0], STOPPED)
    assert sorted(left) == ["a", "b", "c"]


def work_of():
    return "underfoot.app.work:computed"


# the frame


@pytest.mark.parametrize(
    ("cookies", "units", "theme"),
    [({}, "si", ""), ({"units": "us", "theme": "dark"}, "us", "dark"), ({"units": "x"}, "si", "")],
)
def test_a_page_is_opened_as_its_cookies_say(session, cookies, units, theme):
    request: Any = SimpleNamespace(
        headers={"accept-language": "de"}, cookies=cookies, query_params={"variant": "a"}
    )
    made = frame.open_session(session.project, session.jobs, session.exchange, (), None, request)
    assert (made.units, made.theme, made.text.language) == (units, theme, "de")
    assert made.variant == "a"


def test_every_page_stands_in_a_frame_that_leads_to_the_others(session):
    page = next(each for each in session.pages if each.door)

    def look(elements):
        links = {each.text: each.props.get("aria-current") for each in elements
                 if isinstance(each, ui.link) and "tab" in each.classes}  # fmt: skip
        return links

    broken: Any = SimpleNamespace(
        **{name: getattr(page, name) for name in ("door", "route", "title")}, build=None
    )
    links = shown(lambda: frame.build_framed_page(session, page), look)
    text = session.text
    assert links == {
        text(each.title): "page" if each is page else None for each in session.pages if each.door
    }

    def fails(_):
        raise InputError("it is broken")

    broken.build = fails
    assert "it is broken" in shown(lambda: frame.build_framed_page(session, broken), words_of)


@pytest.mark.parametrize(
    ("state", "problem", "line", "offered"),
    [(RUNNING, "", "half way, 42 %", "stop"), (DONE, "", "jobs.done", None),
     (FAILED, "too thin", "too thin", "again"), (STOPPED, "", "jobs.stopped", "again"),
     ("waiting", "", "jobs.waiting", "stop")],
)  # fmt: skip
def test_a_job_says_its_state_and_may_be_stopped_or_run_again(
    session, monkeypatch, state, problem, line, offered
):
    task = QueuedTask(
        1, "Run", about="a", state=state, problem=problem, stage="half way", fraction=0.42
    )
    did = []
    monkeypatch.setattr(session.jobs, "cancel", lambda task: did.append(("stop", task)))
    monkeypatch.setattr(session.jobs, "again", lambda task: did.append(("again", task)))

    def look(elements):
        for each in elements:
            if isinstance(each, ui.button):
                press(each)
        return words_of(elements)

    words = shown(lambda: frame._job_row(session, task), look)
    said = session.text(line) if line.startswith("jobs.") else line
    assert words[:2] == ["Run: a", said]
    assert did == ([] if offered is None else [(offered, task)])


def test_jobs_stand_in_the_order_in_which_they_come():
    tasks = [QueuedTask(n, "", state=s) for n, s in ((1, DONE), (2, "waiting"), (3, RUNNING),
                                               (4, "waiting"), (5, FAILED))]  # fmt: skip
    assert [task.number for task in sorted(tasks, key=frame._place)] == [3, 2, 4, 5, 1]


# the server


def test_a_port_has_one_server_and_a_free_one_is_found():
    first = serve._socket("127.0.0.1", 0)
    try:
        port = first.getsockname()[1]
        assert port > 0
        assert first.getsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR)
        with socket.create_connection(("127.0.0.1", port), timeout=5):
            pass
        with pytest.raises(InputError, match=f"port {port}"):
            serve._socket("127.0.0.1", port)
    finally:
        first.close()
    if socket.has_ipv6:
        with pytest.MonkeyPatch.context() as patch:
            made = []
            patch.setattr(serve.socket, "socket", lambda family, kind: made.append(
                (family, kind)) or SimpleNamespace(setsockopt=lambda *_: None,
                bind=lambda _: None, listen=lambda _: None))  # fmt: skip
            serve._socket("::1", 1)
        assert made == [(socket.AF_INET6, socket.SOCK_STREAM)]


def test_a_secret_lasts_over_a_restart_and_a_short_one_is_made_anew(tmp_path, monkeypatch):
    monkeypatch.setattr(serve, "user_state_path", lambda _: tmp_path)
    first = serve._token()
    assert len(first) >= 32
    assert serve._token() == first
    file = tmp_path / "app-token"
    assert file.stat().st_mode & 0o077 == 0
    file.write_text("x" * 32, encoding="ascii")
    assert serve._token() == "x" * 32
    file.write_text("x" * 31, encoding="ascii")
    assert len(serve._token()) > 31
    monkeypatch.setattr(serve, "user_state_path", lambda _: Path("/dev/null"))
    assert len(serve._token()) >= 32


@pytest.mark.parametrize(
    ("host", "place", "warned", "elsewhere"),
    [("127.0.0.1", "underfoot", False, True), ("localhost", "underfoot", False, True),
     ("::1", "[::1]", False, True), ("0.0.0.0", "192.168.1.9", True, False),
     ("10.0.0.3", "10.0.0.3", True, False)],
)  # fmt: skip
@pytest.mark.parametrize("browser", [False, True])
def test_the_address_of_the_app_is_told_and_its_processes_end_with_it(
    tmp_path, monkeypatch, host, place, warned, elsewhere, browser
):
    said, opened, ended = [], [], []
    listening = SimpleNamespace(getsockname=lambda: (host, 4321))
    fakes: dict[str, Any] = {
        "_socket": lambda *_: listening, "_token": lambda: "secret",
        "own_name": lambda _: "underfoot",
        "JobQueue": lambda *_: SimpleNamespace(close=lambda: ended.append("jobs")),
        "Servers": lambda: SimpleNamespace(close=lambda: ended.append("servers")),
        "_application": lambda *given: given, "remember": lambda _: None,
        "_server": lambda app, *given: SimpleNamespace(
            run=lambda sockets: said.append((app, given, sockets))),
        "_own_address": lambda: "192.168.1.9", "_is_this_machine": lambda _: True,
    }  # fmt: skip
    for name, fake in fakes.items():
        monkeypatch.setattr(serve, name, fake)
    monkeypatch.setattr(serve.webbrowser, "open", opened.append)
    serve.serve(tmp_path, host, 0, browser, said.append)
    address = f"http://{place}:4321/?token=secret"
    *words, (app, given, sockets) = said
    assert any(address in line for line in words)
    assert any(line.startswith("Warning") for line in words) is warned
    assert opened == [address] * browser
    assert (given, sockets) == (("secret", 4321, "underfoot"), [listening])
    assert (app[2] is not None) is elsewhere
    assert ended == ["jobs", "servers"][: 1 + elsewhere]


@pytest.mark.parametrize(
    ("system", "known", "here"),
    [("linux", False, True), ("darwin", True, True), ("darwin", False, False)],
)
def test_a_name_below_localhost_is_asked_for_where_browsers_ask(monkeypatch, system, known, here):
    def asked(*_):
        if not known:
            raise OSError
        return [1]

    monkeypatch.setattr(serve.sys, "platform", system)
    monkeypatch.setattr(serve.socket, "getaddrinfo", asked)
    assert serve._is_this_machine("x.localhost") is here


# projects


def test_projects_are_remembered_from_the_newest_on_while_they_are_there(tmp_path, monkeypatch):
    monkeypatch.setattr(projects, "user_state_path", lambda _: tmp_path / "state")
    assert projects.known_projects() == []
    folders = [tmp_path / f"p{k}" for k in range(projects.MOST_KNOWN + 2)]
    for folder in folders:
        (folder / "variants").mkdir(parents=True)
        projects.remember(folder)
    newest = folders[::-1][: projects.MOST_KNOWN]
    assert projects.known_projects() == newest
    projects.remember(newest[3])
    assert projects.known_projects()[:3] == [newest[3], newest[0], newest[1]]
    (newest[0] / "variants").rmdir()
    assert newest[0] not in projects.known_projects()


@pytest.mark.parametrize("starts", [True, False])
def test_the_server_of_another_project_is_started_once_and_tells_its_address(
    tmp_path, monkeypatch, starts
):
    began = []

    class Process:
        def __init__(self, command, **_):
            began.append(command)
            lines = ["Underfoot shows\n", "  http://x:1/?token=abc\n"] if starts else ["no port\n"]
            self.stdout = Lines(lines)
            self.ended = None

        def poll(self):
            return self.ended

        def terminate(self):
            self.ended = 0

    class Lines(list):
        def read(self):
            return ""

    monkeypatch.setattr(projects.subprocess, "Popen", Process)
    servers = projects.Servers()

    async def links():
        return [await servers.link(tmp_path) for _ in range(2)]

    if not starts:
        with pytest.raises(InputError, match="no port"):
            asyncio.run(links())
        return
    assert asyncio.run(links()) == ["http://x:1/?token=abc"] * 2
    assert len(began) == 1
    assert began[0][-4:] == [str(tmp_path), "--no-browser", "--port", "0"]
    servers.close()
    asyncio.run(links())
    assert len(began) == 2


# what the computing processes are asked


@pytest.mark.parametrize("seen", [None, 3, 5])
@pytest.mark.parametrize("known", [True, False])
@pytest.mark.parametrize("design", ["grid", "doe"])
def test_a_study_is_as_far_as_its_folder_says(monkeypatch, seen, known, design):
    plan = SimpleNamespace(text="now", method=SimpleNamespace(design=design, budget=40))
    store = SimpleNamespace(
        exists=True, records=lambda: range(5), jobs=lambda: ["job"],
        plan=lambda: SimpleNamespace(text="now" if known else "before"),
    )  # fmt: skip
    monkeypatch.setattr(
        work_studies,
        "Study",
        SimpleNamespace(load=lambda *_: SimpleNamespace(store=store, plan=plan)),
    )
    status = SimpleNamespace(working=2, cases_left=0)
    monkeypatch.setattr(work_studies, "study_status", lambda _: status)
    monkeypatch.setattr(work_studies, "study_check", lambda *given: ("check", given))
    monkeypatch.setattr(work_studies, "presented", lambda what: {"of": what})
    monkeypatch.setattr(work_studies, "results", lambda *given, progress: ("parts", given))
    found = work_studies.state("f", "d", seen, progress=silent)
    if not known:
        assert found == {"of": ("check", (plan, work_studies.TRIED)), "ended": 5, "begun": False,
                         "open": True}  # fmt: skip
        return
    assert (found["of"], found["working"], found["open"], found["begun"]) == (
        status,
        2,
        False,
        True,
    )
    assert (found["ended"], found["budget"]) == (5, None if design == "grid" else 40)
    assert found.get("parts") == (("parts", ("f", "d", False)) if seen == 3 else None)
    assert 0 <= found["seconds"] < 60


def test_pairs_of_results_have_the_chance_that_one_is_above_the_other(monkeypatch):
    results = [SimpleNamespace(name=name) for name in "ab"]
    found = SimpleNamespace(results=results, letters=("A", "B"))
    monkeypatch.setattr(work_studies, "compared", lambda *_, **more: (found, {"said": more}))
    monkeypatch.setattr(
        work_studies, "chance_higher", lambda one, other: 0.25 if one.name == "a" else 0.75
    )
    monkeypatch.setattr(work_studies, "surface_of_result", lambda result: f"of {result.name}")
    monkeypatch.setattr(work_studies, "viewer_scene", lambda *given: given)
    monkeypatch.setattr(work_studies, "scene_section", lambda scene: scene)
    told = work_studies.comparison(["x", "y"], progress=silent)
    assert told["said"] == {"separate": False, "progress": silent}
    assert told["letters"] == ["A", "B"]
    assert told["html"] == (results, ["of a", "of b"])
    (aa, ab), (ba, bb) = told["chances"]
    assert (ab, ba) == ("25 %", "75 %")
    assert aa == bb


def test_a_design_has_the_sole_and_the_file_of_its_job(monkeypatch):
    jobs = [SimpleNamespace(design=k, changes={"x": k}) for k in (1, 4, 7)]
    case = SimpleNamespace(replace=lambda given: SimpleNamespace(to_toml=lambda: json.dumps(given)))
    study = SimpleNamespace(
        result=lambda: SimpleNamespace(jobs=jobs), plan=SimpleNamespace(name="mine", base=case)
    )
    monkeypatch.setattr(work_studies, "Study", SimpleNamespace(load=lambda *_: study))
    monkeypatch.setattr(work_studies, "design_sole", lambda *given: ("sole", given[-1]))
    monkeypatch.setattr(work_studies, "designed_surface", lambda case: "surface")
    monkeypatch.setattr(work_studies, "viewer_scene", lambda *given: given)
    monkeypatch.setattr(work_studies, "scene_section", lambda scene: scene)
    told: Any = work_studies.design("f", "d", 4, progress=silent)
    assert json.loads(told["case"]) == {"x": 4, "name": "mine, design 4"}
    ((drawn,), surfaces) = told["html"]
    assert (drawn.name, drawn.data) == ("mine, design 4", ("sole", 4))
    assert surfaces == ["surface"]


@pytest.mark.parametrize("order", ["open", "decided", None])
@pytest.mark.parametrize("ranked", [True, False])
def test_a_comparison_is_told_without_the_numbers_that_stand_in_rows(monkeypatch, order, ranked):
    verdict = work.OrderVerdict.OPEN if order == "open" else next(
        each for each in work.OrderVerdict if each is not work.OrderVerdict.OPEN)  # fmt: skip
    found = SimpleNamespace(
        ranking=("a", "b") if ranked else (),
        order=None if order is None else SimpleNamespace(verdict=verdict),
    )
    monkeypatch.setattr(work.Result, "load", lambda folder: Loaded(folder))
    given = []
    monkeypatch.setattr(
        work, "compare", lambda *results, **more: given.append((results, more)) or found
    )
    monkeypatch.setattr(work, "replace", lambda result, name: (result.folder, name))
    words = {"headline": ["h"], "cautions": ["c"], "tables": [1, 2, 3], "rest": 0}
    monkeypatch.setattr(work, "presented", lambda _: words)
    told = work.separated(["x/one", "x/two"], progress=silent)
    assert told == {"headline": ["h"], "cautions": ["c"], "tables": [3] if ranked else [2, 3],
                    "open": order == "open"}  # fmt: skip
    assert given == [
        ((("x/one", "one"), ("x/two", "two")), {"separate": True, "progress": silent}),
    ]  # fmt: skip


class Loaded:
    def __init__(self, folder):
        self.folder = folder


@pytest.mark.parametrize(("usable", "same"), [(True, True), (True, False), (False, True)])
def test_help_is_added_to_a_result_of_the_present_case_alone(monkeypatch, usable, same):
    result = SimpleNamespace(usable=usable, provenance=SimpleNamespace(case_hash="h"))
    monkeypatch.setattr(work.Result, "load", lambda _: result)
    monkeypatch.setattr(work.Case, "load", lambda _: SimpleNamespace(hash="h" if same else "other"))
    monkeypatch.setattr(work, "risk_assessment", lambda case, result, progress: "advice")
    written = []
    monkeypatch.setattr(
        work, "write_report",
        lambda *given, **more: written.append((given, more)) or SimpleNamespace(page=None),
    )  # fmt: skip
    monkeypatch.setattr(work, "put_language", lambda _: None)
    work.advised("case", "folder", progress=silent)
    more = {"overwrite": True, "advice": "advice"}
    assert written == ([((result, "folder"), more)] if usable and same else [])


@pytest.mark.parametrize("usable", [True, False])
def test_a_run_that_is_stored_returns_its_cof_where_it_may_be_used(monkeypatch, usable):
    scalars = {"cof": SimpleNamespace(value=0.3)}
    result = SimpleNamespace(usable=usable, scalars=scalars)
    asked = []
    monkeypatch.setattr(work, "case_of", lambda path, changes: (path, changes))
    monkeypatch.setattr(
        work, "result_of", lambda case, quick, progress: asked.append((case, quick)) or result
    )
    monkeypatch.setattr(work, "write_report", lambda *_, **more: SimpleNamespace(page=more))
    pages = []
    monkeypatch.setattr(work, "put_language", pages.append)
    cof = work.computed("path", "folder", {"a": 1}, progress=silent)
    assert cof == (0.3 if usable else None)
    assert asked == [(("path", {"a": 1}), False)]
    assert pages == [{"overwrite": True}]
