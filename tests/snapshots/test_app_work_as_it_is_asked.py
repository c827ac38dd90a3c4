"""What the app asks of the rooms behind it, and what it writes and tells of their answers."""

import asyncio
import json
import os
import socket
from contextlib import contextmanager
from pathlib import Path
from typing import Any, cast

import pytest

import made_answers as made
from small_pads import BARS, pad
from small_soles import fake
from snapshot import held, refusal
from trial_exports import EXPORTS
from underfoot.app import (
    jobs,
    run_preview,
    serve,
    work,
    work_place,
    work_studies,
    work_trials,
)
from underfoot.core import InputError, SourcedValue, Status, silent
from underfoot.core.unit_text import UNITS_VARIABLE


def quiet(*_):
    """Progress that nobody hears."""


@pytest.fixture
def reports(monkeypatch):
    """Note what is written where, in place of reports; further files are written."""
    noted: list[Any] = []

    def write(result, folder, *, overwrite, further=None, advice=None):
        folder = Path(folder)
        folder.mkdir(parents=True, exist_ok=True)
        for name, writer in (further or {}).items():
            writer(folder / name)
        kind = type(result).__name__
        noted.append([kind, folder.name, overwrite, sorted(further or {}), advice is not None])
        return fake(page=folder / "report.html")

    for module in (work, work_place):
        monkeypatch.setattr(module, "write_report", write)
    for module in (work, work_place, work_studies, work_trials):
        monkeypatch.setattr(
            module, "put_language", lambda page: noted.append(["language", Path(page).name])
        )
    return noted


def answered(noted, name, answer):
    """Return what notes the arguments of a question and answers."""

    def call(*given, **more):
        more.pop("progress", None)
        result = more.pop("result", None)
        noted.append([name, len(given), more, result and result.name])
        return answer

    return call


def test_runs_and_their_reports(file_regression, tmp_path, monkeypatch, reports):
    case = made.CASE
    path = tmp_path / "case.toml"
    path.write_text(case.to_toml())
    told: dict[str, Any] = {}
    monkeypatch.setattr(work, "sensitivity", answered(reports, "effects", made.sensitivity()))
    work.effects(str(path), str(tmp_path / "effects"), progress=quiet)
    kept = (tmp_path / "effects" / "case-hash.txt").read_text()
    told["hash"] = kept == work.case_of(str(path)).hash
    for name, status in (("good", Status.CONVERGED), ("lost", Status.NOT_CONVERGED)):
        result = made.result(cof=0.3, status=status)
        monkeypatch.setattr(work, "result_of", answered(reports, "run", result))
        told[name] = work.computed(str(path), str(tmp_path / "r"), progress=quiet)
    changed = {"motion.speed": "0.2 m/s"}
    asked: list[Any] = []
    monkeypatch.setattr(
        work, "result_of", lambda case, **more: asked.append(case.motion.speed) or made.result()
    )
    work.computed(str(path), str(tmp_path / "r"), changed, True, progress=quiet)
    work.computed(str(path), str(tmp_path / "r"), progress=quiet)
    told["speeds"] = asked
    monkeypatch.setattr(work, "wear_series", answered(reports, "wear", made.wear()))
    work.worn(str(path), str(tmp_path / "worn"), "1.2 mm after 5 months", progress=quiet)
    shown = json.loads((tmp_path / "worn" / "shown.json").read_text())
    told["worn"] = sorted(shown), shown["hash"] == work.case_of(str(path)).hash
    monkeypatch.setattr(work, "risk_assessment", answered(reports, "advice", made.assessment()))
    for name, result in {
        "same": made.result("same", case_hash=work.case_of(str(path)).hash),
        "other": made.result("other"),
        "unusable": made.result("unusable", case_hash=work.case_of(str(path)).hash,
                                status=Status.NOT_CONVERGED),
    }.items():  # fmt: skip
        result.save(tmp_path / name)
        work.advised(str(path), str(tmp_path / name), progress=quiet)
    told["asked"] = reports
    held(file_regression, told)


def test_a_place_and_its_picture(file_regression, tmp_path, monkeypatch, reports):
    class Picture:
        def savefig(self, stream, *, format, dpi):
            reports.append([format, dpi])
            stream.write(b"picture")

    monkeypatch.setattr(work_place, "read_place", lambda path: path.name)
    monkeypatch.setattr(work_place, "choose_shoe", answered(reports, "choose", made.sensitivity()))
    monkeypatch.setattr(work_place, "slips_figure", lambda choice: Picture())
    work_place.chosen_shoe("here.toml", str(tmp_path / "out"), progress=quiet)
    shown = json.loads((tmp_path / "out" / "shown.json").read_text())
    held(file_regression, {"asked": reports, "picture": shown["picture"], "shown": sorted(shown)})


def test_studies_are_asked_and_told(file_regression, tmp_path, monkeypatch, reports):
    class Store:
        exists = True

        def __init__(self, ended):
            self.ended = ended

        def records(self):
            return range(self.ended)

        def jobs(self):
            return [1, 2]

        def plan(self):
            return plan

        def stop(self):
            reports.append("stop")

    def result():
        return fake(jobs=[fake(design=1, changes={"motion.speed": 0.2}),
                          fake(design=2, changes={"motion.speed": 0.3})])  # fmt: skip

    def run(*, workers, progress):
        reports.append(["run", workers])
        return "ended"

    plan = fake(text="t", name="ribs", base=made.CASE, method=fake(design="sobol", budget=9))
    study = fake(store=Store(3), plan=plan, run=run, result=result)
    monkeypatch.setattr(work_studies, "Study", fake(load=lambda file, folder: study))
    monkeypatch.setattr(work_studies, "available_processors", lambda: 7)

    @contextmanager
    def live(one, progress, workers):
        reports.append(["live", workers])
        yield progress

    def written(one, answer):
        reports.append(["report", answer])
        return fake(page="report.html")

    monkeypatch.setattr(work_studies, "with_live_page", live)
    monkeypatch.setattr(work_studies, "write_study_report", written)
    work_studies.computed("s.toml", "out", progress=quiet)
    work_studies.stop("s.toml", "out", progress=quiet)
    told: dict[str, Any] = {}
    status = fake(cases_left=2, working=1)
    monkeypatch.setattr(work_studies, "presented", lambda one: {"kind": type(one).__name__})
    monkeypatch.setattr(work_studies, "study_status", lambda one: status)
    monkeypatch.setattr(work_studies, "study_check", lambda plan, tried: [tried])
    monkeypatch.setattr(work_studies, "results", lambda *given, **_: list(given))

    def state(seen=None, **changes):
        for name, value in changes.items():
            setattr(status if hasattr(status, name) else study.store, name, value)
        one = work_studies.state("s.toml", "out", seen, progress=quiet)
        assert one.pop("seconds", 0.0) < 60
        return one

    told["runs"] = state()
    told["seen"] = [state(3), state(2)]
    told["done"] = state(cases_left=0)
    told["idle"] = state(working=0, ended=0)
    told["by others"] = state(working=2)
    told["none"] = state(exists=False)
    study.store.exists, plan.method.design = True, "grid"
    told["a grid"] = state(ended=4)
    study.store.plan = lambda: fake(text="another")
    told["changed"] = state()
    monkeypatch.setattr(work_studies, "design_sole", lambda *given: given[2])
    monkeypatch.setattr(work_studies, "designed_surface", lambda case: case.motion.speed)
    monkeypatch.setattr(
        work_studies, "viewer_scene", lambda soles, surfaces: [soles[0].name, surfaces]
    )
    monkeypatch.setattr(work_studies, "scene_section", lambda scene: scene)
    one = work_studies.design("s.toml", "out", 2, progress=quiet)
    told["design"] = one["html"], one["case"].splitlines()[:2]
    told["form"] = work_studies.form(
        'base = "a"\n[vary]\nshoe.tread.depth = [1, 2]\n"motion.speed" = {from = 1, to = 2}\n',
        progress=quiet,
    )
    told["asked"] = reports
    held(file_regression, told)


def test_a_folder_of_trials_is_analysed(file_regression, tmp_path, monkeypatch, reports):
    folder = tmp_path / "walks"
    folder.mkdir()
    for name in ("walk.csv", "walk_2.csv"):
        (folder / name).write_bytes(EXPORTS["walk.csv"]())
    (folder / "conditions.csv").write_text("file,floor,load\nwalk.csv,wet,2.5\nwalk_2.csv,dry,3\n")
    asked = {"folder": str(folder), "report": str(tmp_path / "report"), "names": "",
             "protocol": "level_walking", "merge_spelling": False}  # fmt: skip
    told: dict[str, Any] = {"protocols": sorted(work_trials.protocols())[:3]}
    view = work_trials.folder_view(asked)
    told["folder"] = {
        key: value for key, value in view.items() if key in ("title", "kind", "notes", "counts")
    } | {"keys": sorted(view)}
    told["cards"] = [
        {**card, "svg": [len(card["svg"]), card["svg"][:120]]} for card in view["cards"]
    ]
    first = view["cards"][0]["file"]

    def trial(*given, **more):
        one = work_trials.trial_view(asked, *given, **more)
        plots = {name: one[name] and len(str(one[name])) for name in ("whole", "plot")}
        return {**{k: v for k, v in one.items() if k not in plots}, "plots": plots}

    told["trial"] = trial(first)
    told["second"] = trial(first, 2)["chosen"]
    edit = {"step": 1, "what": "side", "value": "left", "why": "seen"}
    told["tried"] = trial(first, change={**edit, "why": ""})["edits"]
    kept = trial(first, change=edit, keep=True)
    told["kept"] = kept["edits"], kept["before"], kept["after"]
    again = trial(first, change={"step": 1, "what": "exclude", "value": "", "why": "slipped"},
                  keep=True)  # fmt: skip
    told["excluded"] = again["edits"], again["after"], again["numbers"], again["verdict"]
    back = trial(first, change={"step": 0, "what": "take back"}, keep=True)
    told["taken back"] = back["edits"], back["after"]
    work_trials.put_edits(asked, kept["after"], back["after"])
    told["put"] = (folder / "edits.csv").read_text()
    told["refused"] = [
        refusal(work_trials.put_edits, asked, "x", "y"), refusal(trial, "gone.csv"),
        refusal(trial, first, change={"step": 1, "what": "side", "value": "left"}, keep=True),
        refusal(trial, first, change={"step": 99, "what": "exclude", "why": "w"}),
    ]  # fmt: skip
    noted: list[Any] = []
    monkeypatch.setattr(
        work_trials, "write_trials_report",
        lambda analysis, place, **more: noted.append([len(analysis.files), place, more.pop(
            "progress") is not None, more]),
    )  # fmt: skip
    told["report"] = work_trials.written_report(asked), noted, reports
    made_of: list[Any] = []
    monkeypatch.setattr(
        work_trials, "simulated_folder",
        lambda kind, place, **more: made_of.append([kind, more.pop("progress") is silent, more]),
    )  # fmt: skip
    work_trials.example(str(tmp_path / "example"))
    told["example"] = made_of
    held(file_regression, told)


def test_a_preview_is_of_a_run(file_regression, monkeypatch):
    case = pad(BARS, {"contaminant": "glycerol_90pct"})
    bare = pad({}, {"contaminant": "glycerol_90pct"})
    asked: list[Any] = []
    solved = fake(case=case, values={"cof": 0.2, "fluid_load": 10.0},
                  continue_march=lambda changes: changes)  # fmt: skip
    monkeypatch.setattr(run_preview, "kept_continuation", lambda *_, **__: solved)
    monkeypatch.setattr(run_preview, "of_run", lambda *given: asked.append(given[1:]) or "preview")
    whole = {"cof": SourcedValue(0.3), "fluid_load": SourcedValue(9.0)}
    told = {
        "lugs": run_preview.preview_of_run(case, {"motion.speed": "0.2 m/s"}, whole),
        "nothing": run_preview.preview_of_run(bare, {}, whole),
        "worn": refusal(run_preview.preview_of_run, case, {"shoe.wear.depth": "0.2 mm"}, whole),
        "bare": refusal(run_preview.preview_of_run, bare, {"motion.speed": "0.2 m/s"}, whole),
        "asked": [given[0] for given in asked],
        "limits": [run_preview.MOST_UNSURE, run_preview.USUAL, run_preview.DRIFT],
    }
    held(file_regression, told)


def test_the_server_is_told_and_ended(file_regression, tmp_path, monkeypatch):
    lines: list[str] = []

    class Listening:
        def getsockname(self):
            return ("h", 8001)

    class Queue:
        def __init__(self, folder, preload):
            lines.append(f"queue of {folder.name} with {preload}")

        def close(self):
            lines.append("queue closed")

    class Others:
        def close(self):
            lines.append("others closed")

    def application(project, queue, elsewhere):
        lines.append(f"application of {project.folder.name}, others {elsewhere is not None}")
        return "app"

    def server(app, token, port, name):
        lines.append(f"server of {app} at {port}: {name == serve.own_name('t' * 40)}")
        return fake(run=lambda sockets: lines.append(f"runs on {len(sockets)}"))

    monkeypatch.setattr(serve, "_socket", lambda host, port: lines.append(f"{host} {port}")
                        or Listening())  # fmt: skip
    monkeypatch.setattr(serve, "_token", lambda: "t" * 40)
    monkeypatch.setattr(serve, "JobQueue", Queue)
    monkeypatch.setattr(serve, "Servers", Others)
    monkeypatch.setattr(serve, "_application", application)
    monkeypatch.setattr(serve, "_server", server)
    monkeypatch.setattr(serve, "remember", lambda folder: lines.append(f"remember {folder.name}"))
    monkeypatch.setattr(serve, "_own_address", lambda: "10.0.0.7")
    monkeypatch.setattr(serve.webbrowser, "open", lambda link: lines.append(f"opens {link[:40]}"))
    told: dict[str, Any] = {}
    for name, options, known in (
        ("here", {}, True), ("not known", {}, False), ("quiet", {"open_browser": False,
        "port": 0, "host": "localhost"}, True), ("everywhere", {"host": "0.0.0.0"}, True),
        ("six", {"host": "::1"}, True), ("all of six", {"host": "::"}, True),
        ("another", {"host": "192.168.1.4"}, True),
    ):  # fmt: skip
        lines.clear()
        monkeypatch.setattr(serve, "_is_this_machine", lambda _, known=known: known)
        serve.serve(tmp_path / "p", say=lambda text: lines.append(str(text)), **cast(Any, options))
        told[name] = [line.replace("t" * 40, "TOKEN") for line in lines]
    held(file_regression, told, hide=r"underfoot-[0-9a-f]{16}|HASH")


def test_addresses_secrets_and_servers(file_regression, tmp_path, monkeypatch):
    told: dict[str, Any] = {}

    class Probe:
        def __init__(self, **given):
            told.setdefault("probe", {key: int(one) for key, one in given.items()})

        def __enter__(self):
            return self

        def __exit__(self, *_):
            return False

        def connect(self, place):
            told["asks"] = place
            if told.get("away"):
                raise OSError("no network")

        def getsockname(self):
            return ("10.1.2.3", 9)

    monkeypatch.setattr(serve.socket, "socket", Probe)
    monkeypatch.setattr(serve.socket, "gethostname", lambda: "me")
    monkeypatch.setattr(serve.socket, "gethostbyname", lambda name: f"address of {name}")
    told["address"] = serve._own_address()
    told["away"] = True
    told["alone"] = serve._own_address()
    monkeypatch.undo()
    monkeypatch.setattr(serve, "user_state_path", lambda name: tmp_path / name)
    first = serve._token()
    told["token"] = len(first) >= 32, first == serve._token()
    file = tmp_path / "underfoot" / "app-token"
    told["mode"] = oct(file.stat().st_mode & 0o777)
    file.write_text("x" * 31)
    told["short"] = serve._token() != "x" * 31
    file.write_text("y" * 32)
    told["long enough"] = serve._token() == "y" * 32
    one = serve._server(cast(Any, fake()), "t", 8001, "n")
    told["server"] = one.config.log_level, one.config.lifespan, type(one.config.app).__name__
    listening = serve._socket("127.0.0.1", 0)
    port = listening.getsockname()[1]
    told["family"] = listening.family == socket.AF_INET, port > 1023
    taken = refusal(serve._socket, "127.0.0.1", port)
    told["taken"] = taken.replace(str(port), "PORT")
    listening.close()
    for platform, found in (("linux", True), ("darwin", True), ("darwin", False)):
        monkeypatch.setattr(serve.sys, "platform", platform)

        def look(name, service, found=found):
            if not found:
                raise OSError
            return [name]

        monkeypatch.setattr(serve.socket, "getaddrinfo", look)
        told[f"{platform} {found}"] = serve._is_this_machine("underfoot-a.localhost")
    held(file_regression, told)


def test_questions_are_called_by_name_and_give_way(monkeypatch):
    niceness, asked = [0], []

    def nice(step):
        niceness[0] += step
        return niceness[0]

    monkeypatch.setattr(os, "nice", nice, raising=False)
    for name in (UNITS_VARIABLE, jobs.LANGUAGE_VARIABLE):
        monkeypatch.setenv(name, "x")
    monkeypatch.setattr(
        work, "answer", lambda *given, **more: asked.append((given, more)) or "answered"
    )
    function = "underfoot.app.work:answer"
    assert jobs.patiently(function, 1, progress=quiet, quick=True, units="us") == "answered"
    assert niceness == [jobs.PATIENT]
    assert os.environ[UNITS_VARIABLE] == "us"
    assert os.environ[jobs.LANGUAGE_VARIABLE] == "en"
    niceness[0] = 9
    assert jobs.patiently(function, progress=quiet, language="de") == "answered"
    assert niceness == [9]
    assert (os.environ[UNITS_VARIABLE], os.environ[jobs.LANGUAGE_VARIABLE]) == ("si", "de")
    assert asked == [((1,), {"progress": quiet, "quick": True}), ((), {"progress": quiet})]


def test_a_queue_follows_its_tasks(file_regression, tmp_path, monkeypatch):
    queue = jobs.JobQueue(tmp_path)
    told: dict[str, Any] = {}

    class Lane:
        async def ask(self, function, *args, heard, **options):
            heard(fake(stage="half", fraction=0.5))
            if function.endswith("bad"):
                raise InputError("no such thing")
            if function.endswith("stop"):
                raise jobs.Cancelled("stopped")
            return [function, list(args), options]

        def stop(self):
            told["stopped"] = True

        def start(self):
            told["started"] = True

        def close(self):
            told["closed"] = told.get("closed", 0) + 1

    monkeypatch.setattr(queue, "_lane", lambda module: Lane())
    queue.live = queue.reading = cast(Any, Lane())
    first = queue.submit("A", "m:one", 1, about="x", quick=True, then=("B", "m:two", 2))
    bad = queue.submit("C", "m:bad")
    stop = queue.submit("D", "n:stop")
    urgent = queue.submit("E", "m:three", first=True)
    gone = queue.submit("F", "m:four")
    queue.cancel(gone)
    told["order"] = [task.title for task in queue._waiting]

    async def work_on():
        running = asyncio.create_task(queue.run())
        for task in (first, bad, stop, urgent):
            await queue.wait_for(task)
        while any(task.open for task in queue.tasks.values()):
            await asyncio.sleep(0.01)
        running.cancel()

    asyncio.run(work_on())
    again = queue.again(first)
    told["tasks"] = [
        [task.title, task.state, task.stage, task.fraction, task.problem, task.answer, task.about]
        for task in queue.tasks.values()
    ]
    told["latest"] = queue.latest("x", "m:one") is again, queue.latest("x", "m:none")
    told["again"] = [again.arguments, again.options, again.then, again.number]
    queue.cancel_all("m:one")
    told["after"] = again.state
    queue.warm()
    queue.close()
    told["read"] = [
        [task.number, task.title, task.state] for task in jobs.JobQueue(tmp_path).tasks.values()
    ]
    held(file_regression, told)
