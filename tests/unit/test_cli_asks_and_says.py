"""What a command asks of the rooms behind it for its options, and what it says of their answer."""

import json
import signal
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import typer
from typer.testing import CliRunner

from commands import called
from underfoot.block import command_input
from underfoot.calibrate import pair_readings
from underfoot.cli import groups, guard, micro, outsole_make, studies, study
from underfoot.core import Cancelled, InputError
from underfoot.core.presentation import Presentable, Table
from underfoot.explore import check as explore_check
from underfoot.explore import posterior as explore_posterior
from underfoot.places import calibration, choice, evidence, machines, place
from underfoot.questions import method, risk, sensitivity, wear
from underfoot.report import design_study, live_study, sole_export
from underfoot.shoe import parametric
from underfoot.studies import validation

CASE = Path(__file__).parents[2] / "examples" / "work_shoe_full_tread_glycerol.toml"


class Told(Presentable):
    kind = "told"
    name = "What is told"

    def headline(self):
        return ("The answer.",)

    def table(self):
        return Table("", ("a",), [("b",)])


def noted(calls):
    """Return what notes how it was called and answers."""

    def call(*given, **more):
        more.pop("progress", None)
        calls.append((given, more))
        return Told()

    return call


# questions about a case


@pytest.mark.parametrize(
    ("module", "name", "words", "options"),
    [
        (risk, "risk_assessment", ["risk"], {"target": 0.05, "quick": True}),
        (risk, "risk_assessment", ["risk", "--target", "0.02", "--full"],
         {"target": 0.02, "quick": False}),
        (sensitivity, "sensitivity", ["sensitivity"], {"quick": True}),
        (wear, "wear_series", ["wear"],
         {"steps": 6, "band": True, "seed": 0, "limit": 5.0, "deepest": None, "pair": None,
          "quick": True, "mode": "walk"}),
        (wear, "wear_series",
         ["wear", "--mode", "plane", "--steps", "3", "--no-band", "--seed", "7", "--limit", "20 %",
          "--to", "2 mm"],
         {"steps": 3, "band": False, "seed": 7, "limit": 50.0, "deepest": 2e-3, "pair": None,
          "quick": True, "mode": "plane"}),
        (method, "method_prediction", ["test"],
         {"method": "iso13287", "keep": (), "with_band": True, "quick": False}),
        (method, "method_prediction",
         ["test", "--method", "astmf2913", "--keep", "floor", "--quick"],
         {"method": "astmf2913", "keep": ["floor"], "with_band": False, "quick": True}),
    ],
)  # fmt: skip
def test_a_question_is_asked_with_what_its_options_say(monkeypatch, module, name, words, options):
    calls: list[Any] = []
    monkeypatch.setattr(module, name, noted(calls))
    load = 'motion.normal_force="250 N"'
    done = called(words[0], CASE, *words[1:], "--set", load, "--processes", "3")
    assert done.returncode == 0, done.stderr
    (((case,), more),) = calls
    assert case.value("motion.normal_force") == pytest.approx(250)
    assert more == {**options, "processes": 3}
    assert "The answer." in done.stdout


def test_places_and_machines_are_asked_with_what_is_given(monkeypatch, tmp_path):
    calls: list[Any] = []
    monkeypatch.setattr(place, "read_place", lambda path: SimpleNamespace(name=path.name))
    monkeypatch.setattr(choice, "choose_shoe", noted(calls))
    for words, quick in (([], True), (["--full"], False)):
        assert called("choose", "ward.toml", *words).returncode == 0
        (((told,), more),) = calls
        assert (told.name, more) == ("ward.toml", {"quick": quick})
        calls.clear()
    monkeypatch.setattr(machines, "predicted_reading", noted(calls))
    monkeypatch.setattr(machines, "rq_of_rz", lambda rz: (rz / 8, rz / 4))
    for words, span in (
        ([], None), (["--rz", "20 um"], (2.5e-6, 5e-6)), (["--rq", "3 um"], (3e-6, 3e-6)),
    ):  # fmt: skip
        assert called("machine", "pendulum-96", "--fluid", "oil", *words).returncode == 0
        (((name, found), more),) = calls
        assert (name, more) == ("pendulum-96", {"fluid": "oil"})
        assert found == (span if span is None else pytest.approx(span))
        calls.clear()
    both = called("machine", "pendulum-96", "--rz", "20 um", "--rq", "3 um")
    assert both.returncode == 2 or both.returncode == 1
    assert not calls
    monkeypatch.setattr(evidence, "machine_scores", noted(calls))
    assert called("machines").returncode == 0
    assert len(calls) == 1


@pytest.mark.parametrize(("there", "overwrite"), [(False, False), (True, False), (True, True)])
def test_a_floor_is_calibrated_by_what_a_machine_read(monkeypatch, tmp_path, there, overwrite):
    out, calls, wrote = tmp_path / "draws.csv", [], []

    class Floor(Told):
        draws = SimpleNamespace(write=wrote.append)

    def calibrated(*given, **more):
        calls.append((given, more))
        return Floor()

    monkeypatch.setattr(calibration, "calibrated_floor", calibrated)
    if there:
        out.touch()
    words = ["--out", out, "--reading", "36", "--kind", "lower"] + ["--overwrite"] * overwrite
    done = called("calibrate", "machine", CASE, *words)
    refused = there and not overwrite
    assert (done.returncode != 0) is refused
    assert wrote == [] if refused else [out]
    if not refused:
        (((case, name, reading), more),) = calls
        assert (name, reading, more) == ("pendulum-96", 36.0, {"kind": "lower", "fluid": ""})
        assert case.value("motion.speed") > 0


@pytest.mark.parametrize(("there", "overwrite"), [(False, False), (True, False), (True, True)])
@pytest.mark.parametrize("as_json", [False, True])
def test_the_law_of_a_pair_is_narrowed_and_says_how_to_use_it(
    monkeypatch, tmp_path, there, overwrite, as_json
):
    out, asked, wrote = tmp_path / "new" / "draws.csv", [], []

    class Pair(Told):
        draws = SimpleNamespace(write=wrote.append)

    def calibrated(given, **more):
        more.pop("progress")
        asked.append((given, more))
        return Pair()

    monkeypatch.setattr(pair_readings, "read_pair_readings", lambda path: path.name)
    monkeypatch.setattr(pair_readings, "calibrated_pair", calibrated)
    if there:
        out.parent.mkdir()
        out.touch()
    words = ["--out", out] + ["--overwrite"] * overwrite + ["--json"] * as_json
    done = called("calibrate", "pair", "mine.toml", *words)
    if there and not overwrite:
        assert (done.returncode != 0, asked, wrote) == (True, [], [])
        return
    assert (asked, wrote) == ([("mine.toml", {"quick": True})], [out])
    assert out.parent.is_dir()
    assert ('friction.draws_file = "draws.csv"' in done.stdout) is not as_json


# studies of one's own


def a_study(monkeypatch, **parts):
    store = SimpleNamespace(folder=Path("here"), exists=True, **parts.pop("store", {}))
    made = SimpleNamespace(plan=SimpleNamespace(name="mine"), store=store, **parts)
    monkeypatch.setattr(study, "_study", lambda *_: made)
    return made


@pytest.mark.parametrize("timed", [0, 10])
@pytest.mark.parametrize("cost", [None, "known"])
@pytest.mark.parametrize("as_json", [False, True])
def test_a_check_of_a_study_computes_what_is_timed_and_says_what_is_next(
    monkeypatch, timed, cost, as_json
):
    some, given = [], []
    made = a_study(monkeypatch, compute_some=lambda count, _: some.append(count))

    class Checked(Told):
        pass

    def check(plan, store):
        given.append((plan, store))
        told = Checked()
        told.cost = cost  # type: ignore[attr-defined]
        return told

    monkeypatch.setattr(explore_check, "study_check", check)
    done = called("study", "check", "my study.toml", *["--timed", timed] * (timed > 0),
                  *["--json"] * as_json)  # fmt: skip
    assert some == [timed] * (timed > 0)
    assert given == [(made.plan, made.store)]
    assert ("underfoot study run 'my study.toml'" in done.stdout) is not as_json
    assert ("--timed 10" in done.stdout) is (cost is None and not as_json)


@pytest.mark.parametrize(("ended", "said"), [
    ([1.0, 2.0], "nobody works"), ([None], "asked 1 process "), ([None, 2.0, None], "asked 2 proc"),
])  # fmt: skip
def test_a_study_is_stopped_where_somebody_works_on_it(monkeypatch, ended, said):
    stopped = []
    sessions = [{"ended": each} for each in ended]
    a_study(monkeypatch, store={"sessions": lambda: sessions, "stop": lambda: stopped.append(1)})
    assert said in called("study", "stop", "a.toml").stdout
    assert bool(stopped) is (None in ended)


@pytest.mark.parametrize("exists", [True, False])
def test_a_live_page_is_written_of_a_study_that_has_begun(monkeypatch, exists):
    made, wrote = a_study(monkeypatch), []
    made.store.exists = exists
    monkeypatch.setattr(live_study, "write_live_page", wrote.append)
    done = called("study", "live", "a.toml")
    assert wrote == ([made] if exists else [])
    assert (done.returncode == 0) is exists
    assert (str(Path("here") / live_study.PAGE) in done.stdout) is exists


def test_work_on_a_study_tells_how_many_cases_it_computed(monkeypatch):
    asked = []

    def work(workers, progress):
        asked.append(workers)
        return 7

    made = a_study(monkeypatch, work=work)
    pages = []

    @contextmanager
    def page(chosen, bare, workers):
        pages.append((chosen, workers))
        yield bare

    monkeypatch.setattr(live_study, "with_live_page", page)
    done = called("study", "work", "a.toml", "--workers", 3)
    assert (asked, pages) == ([3], [(made, 3)])
    assert "computed 7 cases" in done.stdout
    called("study", "work", "a.toml")
    assert asked == [3, 1]


def test_a_report_of_a_study_is_of_its_result(monkeypatch):
    result, wrote = Told(), []
    made = a_study(monkeypatch, result=lambda: result)

    def write(chosen, shown, progress):
        wrote.append((chosen, shown))
        return SimpleNamespace(lines=lambda: ["Files in here"], failures=())

    monkeypatch.setattr(design_study, "write_study_report", write)
    done = called("study", "report", "a.toml")
    assert wrote == [(made, result)]
    assert "The answer." in done.stdout


@pytest.mark.parametrize("as_json", [False, True])
@pytest.mark.parametrize("count", [None, 2])
def test_the_best_designs_have_the_chance_to_be_above_the_next(monkeypatch, as_json, count):
    designs = [SimpleNamespace(number=n, again=0) for n in (4, 2, 9)]
    rows = [{"design": n, "again": 0, "cof": n / 10} for n in (2, 4, 9)]
    chances = {(4, 2): 0.75, (2, 9): None}
    asked = []

    def best(count):
        asked.append(count)
        return designs[:count]

    result = SimpleNamespace(
        best=best, higher_cof=lambda one, other: chances[one.number, other.number],
        to_dict=lambda: {"designs": rows},
        design_table=lambda given, title: Table(title, ("no",), [(str(d.number),) for d in given]),
    )  # fmt: skip
    a_study(monkeypatch, result=lambda: result)
    done = called("study", "best", "a.toml", *["--count", count] * bool(count),
                  *["--json"] * as_json)  # fmt: skip
    assert asked == [count or 5]
    if as_json:
        told = json.loads(done.stdout)
        assert [each["design"] for each in told] == [4, 2, 9][: count or 3]
        above = [0.75, None, None][: count or 3]
        above[-1] = None
        assert [each["higher_cof_than_next"] for each in told] == above
    else:
        lines = [line.split() for line in done.stdout.splitlines()]
        assert ["4", "75", "%"] in lines
        assert ["2"] in lines
        assert (["9"] in lines) is (count is None)


@pytest.mark.parametrize("usable", [True, False])
@pytest.mark.parametrize("as_json", [True, False])
@pytest.mark.parametrize("there", [True, False])
def test_a_posterior_is_written_where_it_can_be_used(monkeypatch, tmp_path, usable, as_json, there):
    out, wrote, asked = tmp_path / "new" / "draws.csv", [], []

    class Posterior(Told):
        def __init__(self):
            self._usable = usable

        @property
        def usable(self):
            return self._usable

        def write(self, path):
            wrote.append(path)

    def joint(given, *, on, workers, progress):
        asked.append((given, on, workers))
        return Posterior()

    monkeypatch.setattr(explore_posterior, "posterior", joint)
    from underfoot import explore

    made = SimpleNamespace(plan=SimpleNamespace(name="mine"))
    monkeypatch.setattr(explore, "Study", SimpleNamespace(load=lambda *given: made))
    if there:
        out.parent.mkdir()
        out.touch()
    done = called("calibrate", "posterior", "mine.toml", "--out", out, "--workers", 2,
                  *["--json"] * as_json)  # fmt: skip
    assert asked == ([] if there else [(made, None, 2)])
    assert wrote == ([out] if usable and not there else [])
    said = 'posterior = "draws.csv"' in done.stdout
    assert said is (usable and not as_json and not there)


# published studies


@pytest.mark.parametrize(
    ("changes", "settings"),
    [
        ({}, None),
        ({"explicit": True}, {"series": ("report",), "solver": "explicit"}),
        ({"series": "broad"}, {"series": ("broad",), "solver": "condensed"}),
        ({"series": "both", "explicit": True}, {"series": ("report", "broad")}),
        ({"control": "load"}, {"control": "load", "series": ("report", "broad")}),
        ({"bulk_modulus": "printed"}, {"bulk_modulus": "printed", "control": "displacement"}),
        ({"wavelengths": ("1 mm", "0.4 mm")}, {"shoe_wavelength": 1e-3, "floor_wavelength": 4e-4}),
        ({"wavelengths": ("0.5 mm", "1 mm")}, {"shoe_wavelength": 5e-4, "floor_wavelength": 1e-3}),
    ],
)
def test_settings_of_a_study_are_those_that_differ_from_the_usual_ones(changes, settings):
    usual: dict[str, Any] = {
        "explicit": False, "series": "", "control": "height", "bulk_modulus": "corrected",
        "wavelengths": ("0.5 mm", "0.4 mm"),
    }  # fmt: skip
    found = studies._settings(" G1", **(usual | changes))
    assert (found is None) is (settings is None)
    for name, value in (settings or {}).items():
        assert getattr(found, name) == (pytest.approx(value) if "wave" in name else value)
    if settings:
        with pytest.raises(InputError, match="no such setting"):
            studies._settings("g4", **(usual | changes))
    wrongs: tuple[dict[str, Any], ...] = ({"series": "x"}, {"control": "x"})
    for wrong in wrongs:
        with pytest.raises(InputError):
            studies._settings("g1", **(usual | wrong))


@pytest.mark.parametrize("as_json", [False, True])
@pytest.mark.parametrize("passes", [False, True])
def test_checks_with_exact_solutions_are_counted_and_one_that_fails_ends_in_an_error(
    monkeypatch, as_json, passes
):
    rows = [
        validation.Check("one", 1.01, 1.0, 0.02, "s"),
        validation.Check("two", 2.0, 1.0, 0.5, "s"),
    ]
    monkeypatch.setattr(validation, "checks", lambda: rows[: 1 + (not passes)])
    done = called("validate", *["--json"] * as_json)
    assert done.returncode == (0 if passes else 1)
    assert ("two" in done.stderr) is not passes
    if as_json:
        told = json.loads(done.stdout)
        assert [each["relative_error"] for each in told] == pytest.approx([0.01, 1.0][: len(told)])
    else:
        assert ("1 of 1 within" if passes else "1 of 2 within") in done.stdout
        one = next(line for line in done.stdout.splitlines() if line.strip().startswith("one"))
        assert [word for word in one.split() if word != "%"] == [
            "one",
            "1.01",
            "1",
            "1",
            "2",
            "yes",
            "s",
        ]


# soles


def test_a_sole_of_options_is_that_of_its_lengths(monkeypatch):
    given: dict[str, str | None] = dict.fromkeys(outsole_make.LENGTHS)
    said = []
    monkeypatch.setattr(outsole_make, "say", said.append)

    def made(pattern="grid", pitch=None, sipes=None, whole=False, settings=None, **lengths) -> Any:
        return outsole_make._from_options(
            pattern, given | lengths, pitch, sipes, whole, settings
        )  # fmt: skip

    shape = made(lug="6 mm", pitch="10 mm", depth="3 mm")
    tread: Any = shape.tread
    assert (tread.lug_width, tread.channel_width, tread.depth) == pytest.approx((6e-3, 4e-3, 3e-3))
    assert not said
    assert made(lug="6 mm", channel="2 mm", depth="3 mm", pitch=None).tread.channel_width == (
        pytest.approx(2e-3)
    )
    sipes = made(lug="6 mm", channel="3 mm", depth="3 mm", sipes="0.5 mm, 2 mm, 4 mm").tread.sipes
    assert (sipes.width, sipes.depth, sipes.spacing) == pytest.approx((5e-4, 2e-3, 4e-3))
    whole = made(lug="6 mm", channel="3 mm", depth="3 mm", whole=True)
    assert whole.length == pytest.approx(0.29)
    longer = made(lug="6 mm", channel="3 mm", depth="3 mm", settings=["length=80 mm"])
    assert longer.length == pytest.approx(0.08)
    made(lug="6 mm", settings=["tread.depth=2 mm"])
    assert said
    assert "--channel" in said[0]
    assert "--lug " not in said[0]
    assert "--depth" not in said[0]
    refused: tuple[dict[str, Any], ...] = (
        {"lug": "6 mm", "pitch": "6 mm"}, {"lug": "6 mm", "pitch": "9 mm", "channel": "3 mm"},
        {"sipes": "1 mm, 2 mm"}, {"pattern": "gird"},
    )  # fmt: skip
    for wrong in refused:
        with pytest.raises(InputError):
            made(**wrong)


@pytest.mark.parametrize("triangles", [0, 12])
def test_a_sole_that_was_written_is_said_with_its_volumes(capsys, triangles):
    measures = {"length_m": 0.0704, "width_m": 0.065, "plan_area_m2": 0.00412,
                "land_ratio": 0.456, "tread_depth_m": 3e-3}  # fmt: skip
    written: Any = SimpleNamespace(path="sole.stl", triangles=triangles, volume=2e-6,
                                   read_volume=1.98e-6, remarks=["mind"])  # fmt: skip
    outsole_make._show(measures, written)
    first, second, third = capsys.readouterr().out.splitlines()
    assert first == "70 x 65 mm, 41.2 cm2, 46% of it land, tread 3 mm"
    kind = "12 triangles, watertight" if triangles else "a solid"
    assert second == f"wrote sole.stl: {kind}, 2.00 cm3 (read back: -1.00%)"
    assert third == "note: mind"
    outsole_make._show(measures, None)
    assert "--out" in capsys.readouterr().out.splitlines()[1]


@pytest.mark.parametrize(
    ("words", "asks"),
    [([], False), (["--pattern", "grid", str(CASE)], False), ([str(CASE)], True)],
)
def test_a_sole_is_made_of_a_file_or_a_pattern(words, asks):
    done = called("outsole", "make", *words, "--json")
    assert (done.returncode == 0) is asks
    if asks:
        told = json.loads(done.stdout)
        assert told["length_m"] == pytest.approx(0.07, abs=0.03)
        assert 0 < told["land_ratio"] < 1
        assert "volume_m3" not in told


@pytest.mark.parametrize("worn", [None, "1.5 mm"])
def test_the_solid_of_a_case_is_written_new_or_worn(monkeypatch, tmp_path, worn):
    wrote = []

    def write(shape, path):
        wrote.append((shape, path))
        return SimpleNamespace(volume=3.5e-5, remarks=["mind"])

    monkeypatch.setattr(parametric, "write_sole", write)
    case = tmp_path / "mine.toml"
    text = CASE.read_text("utf-8")
    case.write_text(
        text + f'\n[shoe.wear]\ndepth = "{worn}"\nangle = "7 deg"\n' * bool(worn), "utf-8"
    )
    done = called("export", case, "--to", "step")
    assert done.returncode == 0, done.stderr
    assert wrote[0][1] == tmp_path / "mine.step"
    assert "35.00 cm3" in done.stdout
    assert ("worn by 1.5 mm" if worn else "new") in done.stdout
    assert "note: mind" in done.stdout


@pytest.mark.parametrize(
    ("words", "written"),
    [(["--to", "glb"], "sole.glb"), (["--to", "glb", "--out", "x.ply"], None),
     (["--to", "ply", "--field", "fluid_pressure", "--pressed"], "sole.ply")],
)  # fmt: skip
def test_a_result_is_exported_as_its_kind(monkeypatch, tmp_path, words, written):
    from underfoot.compute import result

    calls: list[Any] = []

    def export(loaded, path, *, field, pressed):
        calls.append((loaded, path, field, pressed))
        return SimpleNamespace(sentence=lambda: "it")

    monkeypatch.setattr(result.Result, "load", lambda folder: folder)
    monkeypatch.setattr(sole_export, "export_result", export)
    done = called("export", tmp_path, *words)
    if written is None:
        assert (done.returncode != 0, calls) == (True, [])
        return
    more = ("fluid_pressure", True) if "--field" in words else (None, False)
    assert calls == [(tmp_path, tmp_path / written, *more)]
    assert "wrote it" in done.stdout
    (tmp_path / written).touch()
    assert called("export", tmp_path, *words).returncode != 0
    assert called("export", tmp_path, *words, "--overwrite").returncode == 0


# a rough block


def test_numbers_of_a_rough_block_are_shown_in_their_units(capsys):
    row = {"speed_m_per_s": 0.3, "cof_hysteresis": 0.0123456, "cof_absolute": 0.23456,
           "area_per_force": 2.5e-6, "area_per_force_corrected": None, "mean_pressure": 123456.0,
           "status": "converged", "notes": ["a note"], "breaches": ["a breach"]}  # fmt: skip
    failed = {"speed_m_per_s": 1.0, "status": "not converged", "notes": ["a note"], "breaches": []}
    content = {"name": "block", "block": ["of rubber"], "assumed": ["dry"],
               "results": [row, failed]}  # fmt: skip
    micro._show(content, Path("there"))
    said = capsys.readouterr().out
    lines = said.splitlines()
    of_row = next(line for line in lines if line.strip().startswith("0.3 m/s")).split()
    assert of_row == ["0.3", "m/s", "0.01235", "0.2346", "2.5", "mm²/N", "-", "123.5", "kPa",
                      "converged"]  # fmt: skip
    of_failed = next(line for line in lines if line.strip().startswith("1 m/s")).split()
    assert of_failed == ["1", "m/s", *"-----", "not", "converged"]
    assert [line.strip(" -") for line in lines if line.startswith("  - ")] == [
        "dry", "a note", "a breach",
    ]  # fmt: skip
    assert "there" in said
    micro._show(content | {"results": [row | {"area_per_force_corrected": 3e-6}]}, None)
    assert "3 mm²/N" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "solver", "goes"),
    [(["--snapshots", "3"], "explicit", False), (["--snapshots", "3", "--out", "o"], "condensed",
     False), (["--snapshots", "3", "--out", "o"], "explicit", True), ([], "condensed", True)],
)  # fmt: skip
@pytest.mark.parametrize("usable", [True, False])
def test_snapshots_of_a_block_need_a_folder_and_the_explicit_solver(
    monkeypatch, tmp_path, words, solver, goes, usable
):
    asked, wrote = [], []
    result = SimpleNamespace(status=SimpleNamespace(usable=usable))

    def run(speed, progress, *, snapshots, folder):
        asked.append((speed, snapshots, folder.name))
        return result

    chosen = SimpleNamespace(solver=solver, speeds=[0.1, 0.5], result=run)
    monkeypatch.setattr(command_input, "micro_case", lambda case, solver: chosen)
    monkeypatch.setattr(micro, "as_data", lambda *given: {"of": len(given[1])})
    monkeypatch.setattr(micro, "_write", lambda folder, *given: wrote.append(given[-1]))
    monkeypatch.setattr(micro, "_show", lambda *_: None)
    done = called("micro", "block.toml", *words, folder=tmp_path)
    if not goes:
        assert (done.returncode in (1, 2), asked) == (True, [])
        return
    count = 3 if words else 0
    assert asked == [(0.1, count, "snapshots_0.1"), (0.5, count, "snapshots_0.5")]
    assert wrote == ([{"of": 2}] if words else [])
    assert (done.returncode == 0) is usable


# the program around a command


@pytest.mark.parametrize(
    ("error", "code", "said"),
    [
        (KeyboardInterrupt(), 130, "stopped; no partial output"),
        (KeyboardInterrupt("kept"), 130, "stopped; kept"),
        (guard.Terminated(), 143, "terminated; no partial"),
        (Cancelled("x", remedy="go on"), 130, "stopped; go on"),
        (InputError("odd"), InputError("odd").exit_code, "error: odd"),
        (OSError(28, "No space"), 1, "error: "),
        (ValueError("broken"), 70, "UNDERFOOT_DEBUG=1"),
        (typer.Exit(4), 4, ""),
        (MemoryError(), 1, "error: "),
    ],
)
def test_an_error_is_said_and_ends_with_its_code(monkeypatch, capsys, error, code, said):
    monkeypatch.delenv("UNDERFOOT_DEBUG", raising=False)

    def fails():
        raise error

    with pytest.raises(typer.Exit) as ended:
        guard.guard_command(fails)()
    assert ended.value.exit_code == code
    assert said in capsys.readouterr().err
    if not isinstance(error, typer.Exit):
        monkeypatch.setenv("UNDERFOOT_DEBUG", "1")
        with pytest.raises(type(error)):
            guard.guard_command(fails)()


@pytest.mark.parametrize("usual", [True, False])
def test_a_signal_to_end_is_taken_where_nobody_took_it(monkeypatch, usual):
    taken = []
    before = signal.SIG_DFL if usual else signal.SIG_IGN
    monkeypatch.setattr(guard.signal, "getsignal", lambda _: before)
    monkeypatch.setattr(guard.signal, "signal", lambda *given: taken.append(given))
    guard.end_cleanly_on_sigterm()
    assert [number for number, _ in taken] == [signal.SIGTERM] * usual
    for _, end in taken:
        with pytest.raises(guard.Terminated):
            end(15, None)


@pytest.mark.parametrize("name", ["underfoot", "more"])
def test_commands_of_other_packages_stand_beside_ones_own(monkeypatch, name):
    prefix = "" if name == "underfoot" else "more."
    group = typer.Typer()
    group.command("inner")(lambda: print("the inner"))
    group.command("other")(lambda: None)

    def extra():
        print("the extra")

    broken = f"{prefix}broken"
    items: dict[str, Any] = {f"{prefix}extra": extra, f"{prefix}group": group, broken: None}
    alien = {"elsewhere.thing": extra, f"{prefix}group.deep": extra}

    def offered(door, wanted):
        assert door == "commands"
        if wanted == broken:
            raise InputError("it is broken")
        return items.get(wanted)

    monkeypatch.setattr(groups, "find_offer", offered)
    listed = [*items, *(alien if prefix else [*alien][1:])]
    monkeypatch.setattr(groups, "offers", lambda door: listed)
    app = typer.Typer(name=name, cls=groups.Group)
    app.command("own")(lambda: print("my own"))
    app.command("second")(lambda: None)

    def words(*given):
        app.info.name = name
        return CliRunner().invoke(app, given)

    shown = words("--help").output
    for each in ("own", "second", "extra", "group"):
        assert f" {each} " in shown
    assert " deep " not in shown
    assert " thing " not in shown
    assert "the extra" in words("extra").output
    assert "the inner" in words("group", "inner").output
    assert "my own" in words("own").output
    failed = words("broken")
    assert failed.exit_code == 2
    unknown = words("ownn")
    assert unknown.exit_code == 2


@pytest.mark.parametrize(
    ("values", "component", "refused"),
    [((3, 4), 0, False), ((3, 4), 1, True), ((3, 4, 2), 0, True), ((3, 4, 2), 1, False),
     ((3, 4, 2), 2, False), ((3, 4, 2), 3, True), ((3, 4, 2), -1, True)],
)  # fmt: skip
def test_a_component_is_taken_of_curves_of_vectors_alone(values, component, refused):
    from underfoot.cli.trials_curves import _component

    given = np.arange(np.prod(values)).reshape(values)
    if refused:
        with pytest.raises(InputError):
            _component(given, component, "a")
    else:
        wanted = given[:, :, component - 1] if component else given
        np.testing.assert_array_equal(_component(given, component, "a"), wanted)
