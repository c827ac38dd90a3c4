"""What the processes behind pages answer, and what the app keeps in its folder."""

import asyncio
import json
import os
import re
import zipfile
from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest

import made_answers as made
from page_session import session_of
from small_soles import fake, scene_lines, sole
from snapshot import held, refusal
from underfoot.app import (
    gate,
    jobs,
    projects,
    run_preview,
    serve,
    trials_plots,
    uploads,
    work,
    work_sole,
    work_studies,
    work_table,
    work_trials,
)
from underfoot.app import project as project_module
from underfoot.app.jobs import DONE, FAILED, RUNNING, STOPPED, JobQueue, QueuedTask
from underfoot.app.project import Project, append_line, lines
from underfoot.app.trials_study import STANDARD, TrialsFolder, free_name, studies
from underfoot.app.variant_bar import USUAL, new_variant
from underfoot.core import SourcedValue, Status, silent
from underfoot.trials.pages.figures import Tile
from underfoot.trials.study.file_result import StepResult
from underfoot.trials.study.record_signals import Envelope

PACKED = r'"data": "[^"]*"|"(?:viridis|RdBu_r|cividis|YlGnBu_r)": "[^"]*"|/[^ "]*underfoot-\w+'


def scene_of(html):
    """Return the data of the viewer in a part of a page, as lines."""
    found = re.search(r"<script type=\"application/json\"[^>]*>(.*?)</script>", html, re.DOTALL)
    return scene_lines(json.loads(found[1])) if found else html[:200]


def plain(answer):
    return answer | {"html": scene_of(answer["html"])}


@pytest.fixture
def stored(tmp_path):
    """Return cases and folders of results: current, of other inputs, unusable, none, broken."""
    case = made.CASE
    lugs = {
        f"lug_{name}": ("lug", np.array(values))
        for name, values in (
            ("way", [2e-3, 9e-3]),
            ("height", [3e-3, 3e-3]),
            ("x", [0.01, 0.02]),
            ("y", [0.0, 4e-3]),
            ("groove", [4e-3, 5e-3]),
            ("groove_side", [0.0, 3.0]),
        )
    }
    data = made.result().data.assign(lugs)
    kinds: dict[str, Any] = {
        "current": made.result("current", case_hash=case.hash, data=data),
        "earlier": made.result("earlier", cof=0.3, slip=0.01),
        "lost": made.result("lost", status=Status.NOT_CONVERGED, case_hash=case.hash),
        "none": None,
        "broken": None,
    }
    entries = []
    for name, result in kinds.items():
        text = (
            case.replace("motion.speed", "0.5 m/s").to_toml() if name == "none" else case.to_toml()
        )
        (tmp_path / f"{name}.toml").write_text("[shoe" if name == "broken" else text)
        if result is not None:
            result.save(tmp_path / name)
        entries.append((name, str(tmp_path / f"{name}.toml"), str(tmp_path / name)))
    return entries


def test_stored_results_in_words(file_regression, stored):
    told: dict[str, Any] = {}
    for name, _, folder in stored[:3]:
        told[name] = plain(work.answer(folder, progress=silent))
    told["current"]["html"] = {k: told["current"]["html"][k] for k in ("quantities", "steps")}
    del told["earlier"]["html"], told["lost"]["html"]
    held(file_regression, told)


def test_a_table_of_variants(file_regression, stored, tmp_path):
    told: dict[str, Any] = {"rows": work_table.rows(stored, progress=silent)}
    for kind in ("csv", "xlsx"):
        file = Path(work_table.written(stored, "My table", kind, progress=silent))
        told[kind] = [file.name, file.read_text() if kind == "csv" else file.stat().st_size > 5000]
    told["pictures"] = [
        work_table.picture(case, progress=silent)[:120] for _, case, _ in stored[::4]
    ]
    told["units"] = [work_table._unit(path) for path in ("motion.speed", "odd.key")]
    held(file_regression, made.placeless(told, tmp_path), hide=PACKED)


def test_results_side_by_side(file_regression, stored, tmp_path):
    folders = [folder for _, _, folder in stored[:2]]
    found = work_studies.comparison(folders, progress=silent)
    told = {k: v for k, v in found.items() if k != "html"}
    told["panes"] = [each["name"] for each in scene_of(found["html"])["panes"]]
    lost = work_studies.comparison([stored[0][2], stored[2][2]], progress=silent)
    told["lost"] = {k: v for k, v in lost.items() if k != "html"}
    file = Path(folders[0]) / "sole.csv"
    told["exported"] = work_studies.exported(folders[0], str(file), progress=silent)
    held(file_regression, made.placeless(told, tmp_path))


def test_the_sole_of_a_case(file_regression, stored):
    plain_case, told = stored[0][1], {}
    for name, changes in (
        ("as it is", {}),
        ("worn", {"shoe.wear.depth": "1 mm", "shoe.wear.angle": "5 deg"}),
    ):
        found = work.sole(plain_case, changes, progress=silent)
        scene = scene_of(found["html"])
        told[name] = [
            found["measures"],
            scene["quantities"],
            scene["panes"][0]["height"],
            scene["panes"][0]["surface"]["steps"],
        ]
    coarse = work._moving_spacing(sole(side=4e-3))
    big = work._moving_spacing(sole(side=4e-2, long=0.9))
    held(file_regression, [told, coarse, big, work.SHAPED, work.UNREAD])


def test_a_project_in_a_zip(file_regression, tmp_path):
    folder = tmp_path / "mine"
    for name in ("variants/a.toml", ".hidden/b", "results/a/.c", "results/a/d.csv", "e.txt"):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(name)
    (folder / "link").symlink_to(folder / "e.txt")
    heard: list[Any] = []
    file = work.zipped(str(folder), progress=lambda *told: heard.append(told))
    with zipfile.ZipFile(file) as archive:
        held(file_regression, [Path(file).name, archive.namelist(), heard])


def test_files_of_soles(file_regression, tmp_path):
    heel = Path(__file__).parents[2] / "examples" / "measured" / "heel.stl"
    heard: list[Any] = []
    found = work_sole.inspected_sole(
        str(heel), {"spacing": 1.5e-3}, str(tmp_path), progress=lambda *told: heard.append(told)
    )
    scene = scene_of(found.pop("html"))
    shoe = found.pop("shoe")
    told = {
        **found,
        "heard": heard,
        "quantities": scene["quantities"],
        "shoe": sorted(shoe),
        "fields": scene["panes"][0]["fields"],
    }
    held(file_regression, told)


def tread_case(tmp_path, name, **changes):
    shoe = {
        "from": "work_shoe_full_tread",
        "heel": {"length": "40 mm", "width": "30 mm", "rear_radius": "10 mm"},
    }
    case = made.Case.from_mapping(
        {
            "name": name,
            "shoe": shoe,
            "floor": "vinyl_g4",
            "contaminant": "glycerol_90pct",
            "motion": "slip_tester_g4",
        }
    ).replace(
        {"numerics.grid_spacing": "0.5 mm", "numerics.quick_grid_spacing": "0.7 mm", **changes}
    )
    (tmp_path / f"{name}.toml").write_text(case.to_toml())
    return str(tmp_path / f"{name}.toml")


def test_soles_of_equal_land(file_regression, tmp_path):
    one = tread_case(tmp_path, "one")
    wide = tread_case(tmp_path, "wide", **{"shoe.tread.channel_width": "4 mm"})
    bare = tread_case(tmp_path, "bare", shoe="work_shoe_untreaded")
    told = {
        "wider": work_sole.equal_land(wide, one, progress=silent),
        "narrower": work_sole.equal_land(one, wide, progress=silent),
        "same": work_sole.equal_land(one, one, progress=silent),
        "refused": [
            refusal(work_sole.equal_land, one, bare, progress=silent),
            refusal(work_sole.equal_land, bare, one, progress=silent),
        ],
    }
    held(file_regression, told)


def test_a_groove_that_is_advised(file_regression, stored, tmp_path):
    case = tread_case(tmp_path, "one")
    folder = stored[0][2]
    held(
        file_regression,
        [work_sole.advised_groove(case, folder, lug, progress=silent) for lug in (0, 1)],
    )


def test_previews_as_the_change_of_a_run(file_regression):
    def of(cof=0.3, load=100.0, error=0.01, turned=0.0, numerical: float | None = 0.005, run=0.25):
        case = fake(motion=fake(normal_force=500.0, shoe_angle=0.1))
        changed = fake(motion=fake(normal_force=600.0, shoe_angle=0.1 + turned))
        solved: Any = fake(
            case=fake(motion=case.motion, replace=lambda _: changed),
            values={"cof": 0.28, "fluid_load": 90.0},
        )
        seen: Any = made.dataclasses.make_dataclass(
            "Seen", ["changes", "values", "errors", "cof", "cof_draws"]
        )(
            {},
            {"cof": cof, "fluid_load": load},
            {"cof": error, "fluid_load": 5.0},
            SourcedValue(cof, uncertainty=0.02),
            np.array([cof, 2 * cof]),
        )
        whole = {
            "cof": SourcedValue(run, numerical=numerical),
            "fluid_load": SourcedValue(80.0, "N", numerical=None),
        }
        return run_preview.of_run(solved, seen, whole)

    moved = run_preview._move_number
    held(
        file_regression,
        {
            "plain": of(),
            "turned": of(turned=0.2),
            "unknown": of(numerical=None),
            "no run": of(run=0.0),
            "refused": refusal(of, error=0.2),
            "nothing": refusal(of, cof=0.0),
            "moved": [
                moved(0.3, 0.2, 0.4, (1e9, 1e9)),
                moved(80.0, 90.0, 110.0, (100.0, 120.0)),
                moved(0.0, 1.0, 2.0, (9.0, 9.0)),
                moved(80.0, 200.0, 90.0, (100.0, 120.0)),
            ],
        },
    )


# the folder of a project


def test_a_project_and_its_states(file_regression, tmp_path, monkeypatch):
    monkeypatch.setattr(project_module, "_now", lambda: "now")
    monkeypatch.setattr(project_module, "MOST_STATES", 4)
    session = session_of(tmp_path / "p")
    project, told = session.project, {}
    new_variant(session, "a")
    told["entries"] = [USUAL, project.case("a").entries]
    states = []
    for speed in ("0.1 m/s", "0.2 m/s", "0.3 m/s", "0.4 m/s", "0.5 m/s"):
        project.change("a", {"motion.speed": speed})
    for step in (project.undo, project.undo, project.undo, project.undo, project.redo):
        step("a")
        states.append(
            [project.case("a").value("motion.speed"), project.can_undo("a"), project.can_redo("a")]
        )
    project.write("a", project.text("a"))  # nothing new
    project.path("a").write_text(project.text("a").replace("a", "a"))
    project.copy("a", "b/..", {"motion.speed": "0.7 m/s"})
    project.rename("b", "c")
    project.remove("c")
    told["states"], told["removed"] = states, project.removed_variants()
    project.restore("c")
    again = Project(tmp_path / "p")
    told["again"] = [sorted(again.variants()), again.can_undo("a"), again.can_redo("a"), again.name]
    told["actions"] = [
        (one["variant"], one["action"], "text" in one)
        for one in lines(tmp_path / "p" / "history.jsonl")
    ]
    told["names"] = [
        project.free_name(wanted) for wanted in ("a", "A", "x/y", "", " ._", "ä" * 70, "c")
    ]
    told["known"] = [project.known, setattr(project, "known", "a"), project.known]
    told["refused"] = [
        refusal(project.path, name) for name in ("", "a.", "a ", "a/b", "_a", "x" * 61)
    ] + [
        refusal(project.add, "a", ""),
        refusal(project.case, "zz"),
        refusal(project.inside, "..", "x"),
        refusal(Project, tmp_path / "p" / "history.jsonl"),
    ]
    held(file_regression, made.placeless(told, tmp_path))


def test_results_of_a_project(file_regression, tmp_path):
    project = Project(tmp_path)
    stored = {
        "full": {
            "status": {"value": "converged"},
            "cof": {"value": 0.3, "interval": [0.2, 0.4]},
            "slip_probability": {"value": 0.1},
            "provenance": {"case_hash": "h", "created": "2"},
        },
        "bare": {
            "status": {"value": "failed"},
            "cof": {"value": None},
            "slip_probability": None,
            "provenance": {"case_hash": "h", "created": "3"},
        },
        "odd": {"status": 3},
        "list": [],
    }
    for name, content in stored.items():
        project.result_folder(name).mkdir()
        (project.result_folder(name) / "result.json").write_text(json.dumps(content))
    project.result_folder("empty").mkdir()
    told = {
        "summaries": {name: project.summary(name) for name in (*stored, "empty", "gone")},
        "results": [one.name for one in project.results()],
        "state": project.state("full"),
        "current": [project.is_current(name) for name in ("full", "empty")],
    }
    held(file_regression, told)


def test_lines_that_a_power_cut_left(file_regression, tmp_path):
    file = tmp_path / "x.jsonl"
    append_line(file, {"a": "ä"})
    with file.open("a") as stream:
        stream.write('{"b": ')
    append_line(file, {"c": 1})
    with file.open("a") as stream:
        stream.write("[1]\n\n")
    held(file_regression, [file.read_text(), lines(file), lines(tmp_path / "none")])


def test_the_queue_and_its_file(file_regression, tmp_path, monkeypatch):
    clock = iter(range(1, 99))
    monkeypatch.setattr(jobs.time, "time", lambda: float(next(clock)))
    queue = JobQueue(tmp_path)
    inside = str(tmp_path / "x.toml")
    made_tasks = [
        queue.submit("run", "m:run", inside, str(tmp_path), f"{tmp_path}y", about="a", quick=True),
        queue.submit("later", "m:run", [inside, {"k": inside}], about="b"),
        queue.submit("first", "m:run", about="c", first=True, then=("next", "m:next", inside)),
        queue.submit("second", "n:run", about="a", first=True),
    ]
    waiting = [task.title for task in queue._waiting]
    made_tasks[0].state = RUNNING
    queue.cancel(made_tasks[1])
    queue.cancel_all("n:run")
    again = queue.again(made_tasks[2])
    told = {
        "waiting": waiting,
        "states": {t.title: [t.state, t.open, t.module] for t in made_tasks},
        "again": [again.number, again.first, again.then, again.about],
        "latest": [
            one and one.number for one in (queue.latest("c", "m:run"), queue.latest("c", "x"))
        ],
        "file": (tmp_path / "jobs.jsonl").read_text().replace(str(tmp_path), "HERE"),
    }
    other = JobQueue(tmp_path)
    told["read"] = [(t.number, t.title, t.state, t.ended) for t in other.tasks.values()]
    for k in range(60):
        task = other.submit(f"t{k}", "m:x")
        other._waiting.clear()
        other._end(task, (DONE, FAILED, STOPPED)[k % 3])
    told["kept"] = [
        len(other.tasks),
        min(other.tasks),
        [other.tasks[n].fraction for n in (70, 69, 68) if n in other.tasks],
    ]
    told["of next"] = len(JobQueue(tmp_path).tasks)
    told["moved"] = jobs._move_paths(
        {"a": [str(tmp_path), f"{tmp_path}/b", f"{tmp_path}c", 3]}, str(tmp_path), "X"
    )
    held(file_regression, made.placeless(told, tmp_path))


@pytest.mark.parametrize("failing", [False, True])
def test_a_job_from_its_begin_to_its_end(file_regression, tmp_path, monkeypatch, failing):
    clock = iter(range(1, 99))
    monkeypatch.setattr(jobs.time, "time", lambda: float(next(clock)))
    queue: Any = JobQueue(tmp_path)

    async def ask(function, *args, heard, **options):
        heard(fake(stage="film", fraction=0.4))
        if failing:
            raise ValueError("odd")
        return [function, args, options]

    queue._lane = lambda module: fake(ask=ask)
    task = queue.submit("run", "m:run", 1, about="a", then=("next", "m:next", 2), units="us")

    async def run():
        await queue._compute(task)

    asyncio.run(run())
    rest = [(t.title, t.function, t.arguments, t.options, t.about) for t in queue._waiting]
    held(file_regression, [QueuedTask(**vars(task)), task.answer, rest])


def test_files_that_come(file_regression, tmp_path, monkeypatch):
    project = Project(tmp_path)

    async def stream(*parts):
        for each in parts:
            yield each

    def come(place, *parts):
        return (
            asyncio.run(uploads.receive_file(project, place, stream(*parts)))
            .relative_to(tmp_path)
            .as_posix()
        )

    told: dict[str, Any] = {
        "came": [
            come("soles/a.stl", b"one"),
            come("soles/a.stl", b"two", b"more"),
            come("soles/a.stl", b"one"),
            come("soles/a.stl", b"three"),
            come("trials/x/y.csv", b"1"),
        ],
        "revisions": [
            [(p.name, n) for p, n in [uploads.revision(one)]]
            for one in uploads.revisions(tmp_path / "soles" / "a.stl")
        ],
    }
    monkeypatch.setattr(uploads, "MOST_BYTES", 2_000_000)
    told["refused"] = [
        refusal(come, "soles/b.stl", b"x" * 1_500_000, b"x" * 600_000),
        refusal(come, "soles/b.stl"),
        *(
            refusal(come, place, b"x")
            for place in (
                "soles",
                "odd/a",
                "soles/../a",
                "soles/con.txt",
                "soles/ a",
                "soles/a.",
                "soles/a:b",
                "soles//a",
            )
        ),
    ]
    told["left"] = sorted(os.listdir(tmp_path / "soles"))
    held(file_regression, told)


def test_who_may_talk_to_the_server(file_regression):
    reached: list[Any] = []

    async def app(scope, receive, send):
        reached.append(scope["path"])
        await send({"type": "http.response.start", "status": 200, "headers": [(b"a", b"b")]})
        await send({"type": "http.response.body", "body": b"hello"})

    door = gate.Gate(app, "secret", 80, 5_000_000, "mine.localhost")

    def ask(kind="http", path="/", query="", method="GET", **headers):
        sent: list[Any] = []

        async def send(message):
            sent.append(message)

        given = {"host": "localhost", "cookie": "underfoot-80=secret"} | headers
        coded = [(k.replace("_", "-").encode(), v.encode()) for k, v in given.items() if v]
        scope = {
            "type": kind,
            "path": path,
            "query_string": query.encode(),
            "method": method,
            "headers": coded,
        }
        asyncio.run(door(scope, cast(Any, None), send))
        coded = [
            (k.decode(), v.decode())
            for each in sent
            for k, v in each.get("headers", ())
            if k != b"a"
        ]
        told = [each.get(key, b"") for each in sent for key in ("status", "code", "reason", "body")]
        words = [one.decode() if isinstance(one, bytes) else str(one) for one in told if one]
        return " ".join(words), [one for one in coded if kind != "http" or path == "//evil.com/ä"]

    told = {
        "let in": ask(),
        "by name": ask(host="mine.localhost:80"),
        "by number": ask(host="127.0.0.1"),
        "own origin": ask(origin="http://localhost"),
        "posted": ask(method="POST", content_length="9"),
        "lifespan": ask("lifespan"),
        "socket": ask("websocket", cookie=""),
        "other host": ask(host="evil.com"),
        "other port": ask(host="localhost:81"),
        "no host": ask(host=""),
        "odd host": ask(host="[::1"),
        "other origin": ask(origin="http://evil.com"),
        "no cookie": ask(cookie=""),
        "wrong cookie": ask(cookie="underfoot-80=x"),
        "odd cookie": ask(cookie="a\x01=b"),
        "token": ask(query="token=secret&a=b%20c&token=", cookie=""),
        "the token": ask(path="//evil.com/ä", query="a=1&token=secret", cookie=""),
        "without length": ask(method="POST"),
        "too long": ask(method="POST", content_length="1000001"),
        "just": ask(method="POST", content_length="1000000"),
        "upload": ask(method="POST", path="/api/files/soles/a", content_length="5000000"),
        "long upload": ask(method="POST", path="/api/files/soles/a", content_length="5000001"),
        "policy": gate.POLICY,
        "reached": reached,
        "name": gate.own_name("secret")[:11],
        "length": len(gate.own_name("secret")),
        "large": gate.too_large(12_345_678, 9_000_000),
        "hosts": [gate._host_and_port(h) for h in ("a:1", "a", "a:x", "")],
    }
    held(file_regression, told)


def test_other_projects(file_regression, tmp_path, monkeypatch):
    monkeypatch.setattr(projects, "_list", lambda: tmp_path / "list.txt")
    told = [projects.known_projects()]
    for k in range(15):
        folder = Project(tmp_path / f"p{k:02}").folder
        projects.remember(folder)
    projects.remember(tmp_path / "p03")
    told.append([path.name for path in projects.known_projects()])
    (tmp_path / "p14" / "variants").rmdir()
    told.append([path.name for path in projects.known_projects()][:3])
    held(file_regression, [told, serve.PORT, serve.LOOPBACK])


# trials


def test_a_folder_of_trials_and_how_it_is_analysed(file_regression, tmp_path):
    project = Project(tmp_path)
    for name in ("b", "a", ".c"):
        project.inside("trials", name).mkdir()
    study = TrialsFolder(project, "a")
    told: dict[str, Any] = {
        "names": [studies(project), free_name(project, "a"), free_name(project, "z")],
        "standard": [STANDARD, study.command],
        "kept": [study.keep({"names": "{a} b"}), study.keep({})],
        "file": project.inside("trials", "a.json").read_text(),
        "command": study.command,
    }
    study.keep({"merge_spelling": True, "protocol": "report_g6"})
    told["merged"] = [study.command, TrialsFolder(project, "a").settings, sorted(study.asked)]
    for text in ("{", "[]", '{"protocol": "x"}'):
        project.inside("trials", "b.json").write_text(text)
        told[text] = TrialsFolder(project, "b").settings
    held(file_regression, told)


def envelope(high):
    return lambda begin, end, width: Envelope(
        begin, (end - begin) / 3, np.array([0.0, 1.0, high / 2]), np.array([0.5, 1.0, high])
    )


def test_plots_of_trials(file_regression):
    signals: Any = fake(
        force={
            "P": fake(start=0.0, end=9.0, rate=1000.0, envelope=envelope(900.0)),
            "Q": fake(start=-1.0, end=8.0, rate=1000.0, envelope=envelope(5.0)),
            "R": fake(start=0.5, end=9.5, rate=1000.0, envelope=envelope(80.0)),
        },
        heel_speed={"left": fake(envelope=envelope(2.0))},
    )
    ratio = {
        "number": 2,
        "ratio": [0.9, 0.2, 0.3],
        "normal": [600.0, 50.0, None],
        "time": np.array([0.0, 0.1, 0.2]),
        "peak": 0.35,
        "peak_time": 0.02,
        "gate": 0.01,
    }
    heel = {"start": 0.05, "end": None, "peak_time": 0.08, "peak": 1.2}
    step = StepResult(
        number=2, contact=0.1, toe_off=8.95, plate="P", verdict="accepted", side="left"
    )
    steps = {
        "plain": (step, {"steps": [ratio, ratio | {"number": 3}], "heel": [heel]}),
        "without a peak": (step, {"rejected": [ratio | {"peak": None}]}),
        "by hand": (made.dataclasses.replace(step, by_hand=("exclude",)), {"slipping": []}),
    }
    told: dict[str, Any] = {
        name: trials_plots.step_plot(cast(Any, fake(curves=curves, steps=[each])), each, signals)
        for name, (each, curves) in steps.items()
    }
    told["slip"] = trials_plots._slip_events(heel, 1.0, 2)
    told["record"] = trials_plots.record_plot(cast(Any, fake(steps=[step])), signals)
    time = np.array([0.0, 0.1, 0.4])
    runs = {
        "slide": [
            {
                "time": time,
                "normal": time,
                "shear": 2 * time,
                "ratio": 3 * time,
                "begin": 0.1,
                "end": 0.3,
            }
        ],
        "hold": [{"time": time, "force": -time}],
        "run": [{"time": time, "ratio": np.array([0.1, np.nan, 0.2])}],
    }
    told["runs"] = {
        k: trials_plots.run_plot(cast(Any, fake(curves={k: v}))) for k, v in runs.items()
    }
    told["no run"] = trials_plots.run_plot(cast(Any, fake(curves={"slide": []})))
    x = np.linspace(-0.1, 1.1, 200)
    tiles = [
        Tile("one", "accepted", x, x**2, ((0.5, 0.25), (np.nan, 0.3))),
        Tile("two", "refused", x[:9], np.full(9, np.nan), ()),
    ]
    sheets = [fake(x_range=(0.0, 1.0), y_range=(0.0, 0.8), line=line) for line in (0.2, None)]
    told["tiles"] = [trials_plots.tile_svg(tiles, cast(Any, sheet)) for sheet in sheets]
    held(file_regression, scene_lines(told))


def test_the_result_of_a_recording(monkeypatch):
    found = [fake(file="a.csv #1"), fake(file="a.csv #2")]
    monkeypatch.setattr(work_trials, "recording_results", lambda *_, **__: found)
    study = work_trials.TrialsWork(Path("x"), Path("y"), cast(Any, None), {})
    recording: Any = fake(name="a.csv")
    assert study.result(recording, "a.csv #2") is found[1]
    assert study.result(recording, "a.csv #9") is found[0]
    assert study.store == Path("y") / work_trials.STORE
