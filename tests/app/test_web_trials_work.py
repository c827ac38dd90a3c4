"""What the trials page is told and writes: the numbers of the command line, edits, odd folders."""

import csv
import json
import math
import shutil
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from underfoot.app import work_trials
from underfoot.cli.trials import trials_app
from underfoot.core import InputError
from underfoot.trials.simulator import simulated_folder
from underfoot.trials.study.edit_table import edit_text, edits_of, with_edit_row
from underfoot.trials.study.record_signals import Signal
from underfoot.trials.walking.events import EditError

DATA = Path(__file__).parents[1] / "data" / "trials"
WALK, OTHER = "HC030A05.c3d", "HC036A23.c3d"


def _asked(folder: Path, **options):
    standard = {"protocol": "level_walking", "names": "", "merge_spelling": False}
    report = folder.with_name(f"{folder.name} report")
    return {"folder": str(folder), "report": str(report), **standard, **options}


@pytest.fixture
def walks(tmp_path):
    folder = tmp_path / "walks"
    folder.mkdir()
    for name in (WALK, OTHER):
        shutil.copy(DATA / "biomechzoo" / name, folder)
    return folder


def _by_command(asked, tmp_path):
    """Return the tables "steps" and "edits" that the command writes of the same folder."""
    out = tmp_path / "by command"
    arguments = [asked["folder"], "--protocol", asked["protocol"], "--out", str(out)]
    done = CliRunner().invoke(trials_app, ["analyse", *arguments, "--processes", "1"])
    assert done.exit_code == 0, done.output
    tables = {}
    for name in ("steps_wide", "edits", "measurements"):
        path = out / "tables" / f"{name}.csv"
        tables[name] = list(csv.DictReader(path.read_text(encoding="utf-8").splitlines()))
    return tables


@pytest.mark.slow
def test_what_is_shown_after_edits_is_what_the_command_says(walks, tmp_path):
    """A contact is moved, moved again and another step excluded; numbers, reasons and log agree."""
    asked = _asked(walks)
    first = {"step": 1, "what": "contact", "value": "3.0800 s", "why": "seen in the video"}
    work_trials.trial_view(asked, WALK, change=first, keep=True)
    again = {**first, "value": "3.0700 s"}
    work_trials.trial_view(asked, WALK, change=again, keep=True)
    out = {"step": 2, "what": "exclude", "value": "", "why": "targeted, the plate"}
    shown = work_trials.trial_view(asked, WALK, change=out, keep=True)
    assert (walks / "edits.csv").read_text().splitlines() == [
        "file,step,edit,value,why",
        f"{WALK},1,contact,3.0700 s,seen in the video",
        f'{WALK},2,exclude,,"targeted, the plate"',
    ]
    tables = _by_command(asked, tmp_path)
    theirs = [row for row in tables["steps_wide"] if row["file"] == WALK]
    for step, row in zip(shown["steps"], theirs, strict=True):
        assert step["contact"] == pytest.approx(float(row["contact (s)"]), abs=1e-9)
        assert step["rcof"] == (pytest.approx(float(row["rcof"])) if row["rcof"] else None)
        assert (step["verdict"], step["reason"]) == (row["verdict"], row["reason"])
    for entry, row in zip(shown["edits"], tables["edits"], strict=True):
        assert [entry[key] for key in ("step", "what", "before", "after", "why")] == [
            row[key] for key in ("step", "what", "before", "after", "why")
        ]
    folder = work_trials.folder_view(asked)
    card = next(card for card in folder["cards"] if card["file"] == WALK)
    (mean,) = (
        float(row["value"])
        for row in tables["measurements"]
        if row["file"] == WALK and row["item"] == "mean of the steps"
    )
    assert card["numbers"] == [f"RCOF {mean:.3g}"]
    assert card["edits"] == 2
    assert [step["verdict"] for step in shown["steps"]] == ["accepted", "rejected"]


def test_the_step_that_was_chosen_is_drawn(walks):
    """Without one, or where there is none of this number, the first accepted."""
    asked = _asked(walks)
    views = {step: work_trials.trial_view(asked, WALK, step) for step in (None, 1, 2, 99)}
    assert {step: view["chosen"] for step, view in views.items()} == {None: 1, 1: 1, 2: 2, 99: 1}
    begun = {step: view["plot"]["events"][0]["time"] for step, view in views.items()}
    contacts = [step["contact"] for step in views[1]["steps"]]
    assert [begun[1], begun[2]] == pytest.approx(contacts[:2])


def test_an_edit_is_tried_before_it_is_written(walks):
    asked = _asked(walks)
    before = work_trials.trial_view(asked, WALK)
    change = {"step": 1, "what": "contact", "value": "3.0800 s"}
    tried = work_trials.trial_view(asked, WALK, change=change)
    assert tried["edits"][0]["number_after"] == tried["steps"][0]["rcof"]
    assert tried["steps"][0]["rcof"] != before["steps"][0]["rcof"]
    assert tried["plot"]["events"][0] == {
        **before["plot"]["events"][0],
        "time": pytest.approx(3.08),
    }
    assert not (walks / "edits.csv").exists()
    with pytest.raises(EditError, match="needs its reason"):
        work_trials.trial_view(asked, WALK, change=change, keep=True)
    same = {"step": 1, "what": "contact", "value": "3.0280 s", "why": "x"}
    with pytest.raises(EditError, match="changes nothing"):
        work_trials.trial_view(asked, WALK, change=same, keep=True)
    assert not (walks / "edits.csv").exists()


def test_edits_are_taken_back_undone_and_done_again(walks):
    asked = _asked(walks)
    start = work_trials.trial_view(asked, WALK)["steps"]
    change = {"step": 1, "what": "exclude", "value": "", "why": "stumbled"}
    kept = work_trials.trial_view(asked, WALK, change=change, keep=True)
    assert kept["steps"][0]["reason"] == "excluded by hand: stumbled"
    work_trials.put_edits(asked, kept["before"], kept["after"])
    assert not (walks / "edits.csv").exists()
    assert work_trials.trial_view(asked, WALK)["steps"] == start
    work_trials.put_edits(asked, kept["after"], kept["before"])
    assert work_trials.trial_view(asked, WALK)["steps"] == kept["steps"]
    back = {"step": 0, "what": "take back"}
    assert work_trials.trial_view(asked, WALK, change=back, keep=True)["steps"] == start
    with pytest.raises(InputError, match="another program"):
        work_trials.put_edits(asked, "", "something else")


def test_an_edit_table_of_a_laboratory_keeps_its_form(walks):
    """Semicolons, another order, a column more and an edit that names its step by a time."""
    (walks / "edits.csv").write_text(
        "why;who;file;value (s);edit;step\nvideo;AB;HC030A05.c3d;3,07;contact;3,1 s\n",
        encoding="utf-8-sig",
    )
    asked = _asked(walks)
    change = {"step": 1, "what": "contact", "value": "3.0800 s", "why": "again"}
    shown = work_trials.trial_view(asked, WALK, change=change, keep=True)
    assert shown["steps"][0]["contact"] == 3.08
    assert edit_text(walks).splitlines() == [
        "why;who;file;value (s);edit;step",
        "again;;HC030A05.c3d;3.0800 s;contact;1",
    ]
    assert [edit.value for edit in edits_of(walks, [WALK])[WALK]] == [3.08]


def test_a_row_is_added_and_taken_from_any_table():
    text = with_edit_row("", ("a.c3d", "1", "exclude", "", 'said "no", twice'))
    assert text == 'file,step,edit,value,why\na.c3d,1,exclude,,"said ""no"", twice"\n'
    more = with_edit_row(text, ("b.c3d", "2", "side", "left", "x"))
    assert with_edit_row(more, without={2}) == ("file,step,edit,value,why\nb.c3d,2,side,left,x\n")
    assert with_edit_row(more, without={3}) == text


def test_edits_in_a_workbook_are_not_hidden_by_a_new_table(walks):
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    book.active.append(["file", "step", "edit", "value", "why"])
    book.active.append([WALK, "1", "exclude", "", "stumbled"])
    book.save(walks / "edits.xlsx")
    change = {"step": 2, "what": "exclude", "value": "", "why": "x"}
    with pytest.raises(EditError, match="workbook"):
        work_trials.trial_view(_asked(walks), WALK, change=change, keep=True)
    arguments = ["edit", str(walks / WALK), "--step", "2", "--exclude", "--reason", "x"]
    assert CliRunner().invoke(trials_app, arguments).exit_code == 2


@pytest.mark.slow
def test_slips_show_the_heel_and_its_events(tmp_path):
    folder = tmp_path / "slips"
    simulated_folder("slips", folder, count=3)
    asked = _asked(folder, protocol="report_g6")
    cards = {card["file"]: card for card in work_trials.folder_view(asked)["cards"]}
    assert cards["slip_003.c3d"]["numbers"][:2] == ["RCOF 0.226", "peak slipping speed 0.612 m/s"]
    shown = work_trials.trial_view(asked, "slip_003.c3d")
    assert shown["chosen"] == 2
    events = {event["id"]: event for event in shown["plot"]["events"]}
    slip = next(step for step in shown["steps"] if step["number"] == 2)
    assert events["slip peak"]["value"] == pytest.approx(slip["peak_slipping_speed"], rel=1e-6)
    assert events["contact"]["time"] < events["slip start"]["time"] < events["slip end"]["time"]
    speeds = shown["plot"]["panels"][events["slip peak"]["panel"]]
    assert speeds["id"] == "speed"
    assert speeds["high"] > 0.9 * slip["peak_slipping_speed"]
    change = {"step": 2, "what": "contact", "value": "2500 ms", "why": "marker lost"}
    moved = work_trials.trial_view(asked, "slip_003.c3d", 2, change=change, keep=True)
    again = {**change, "what": "exclude", "value": "", "why": "no slip at all"}
    gone = work_trials.trial_view(asked, "slip_003.c3d", 2, change=again, keep=True)
    assert moved["edits"][0]["quantity"] == "peak slipping speed"
    assert [edit["what"] for edit in gone["edits"]] == ["exclude"]
    assert len((folder / "edits.csv").read_text().splitlines()) == 2


def test_a_run_without_steps_is_excluded_and_taken_in_again(tmp_path):
    folder = tmp_path / "tester"
    simulated_folder("tester", folder, count=2)
    asked = _asked(folder, protocol="report_g4")
    name = "work_none_scan_1.csv"
    before = work_trials.trial_view(asked, name)
    assert [panel["id"] for panel in before["plot"]["panels"]] == ["force", "ratio"]
    assert before["plot"]["begin"] < before["plot"]["events"][0]["time"] < before["plot"]["end"]
    change = {"step": before["run"], "what": "exclude", "value": "", "why": "belt slipped"}
    gone = work_trials.trial_view(asked, name, change=change, keep=True)
    assert (gone["verdict"], gone["edits"][0]["why"]) == ("refused", "belt slipped")
    back = {"step": 0, "what": "take back"}
    assert work_trials.trial_view(asked, name, change=back, keep=True)["verdict"] == "accepted"


def test_bad_files_stand_beside_the_good_ones(walks):
    """Text called .c3d, a file cut short, a name that is a script: words for each, all on cards."""
    (walks / "text.c3d").write_text("this is text\n")
    (walks / "cut.c3d").write_bytes((walks / WALK).read_bytes()[:9000])
    hostile = "<img src=x onerror=alert(1)>; 'drop.csv"
    (walks / hostile).write_text("a,b\n1,2\n")
    asked = _asked(walks)
    shown = work_trials.folder_view(asked)
    cards = {card["file"]: card for card in shown["cards"]}
    assert shown["counts"] == {"accepted": 1, "caution": 1, "refused": 3}
    for name in ("text.c3d", "cut.c3d", hostile):
        assert cards[name]["verdict"] == "refused"
        assert cards[name]["reasons"][0]
        assert cards[name]["svg"] == ""
        one = work_trials.trial_view(asked, name)
        assert (one["plot"], one["steps"], one["reasons"]) == (None, [], cards[name]["reasons"])
    assert "<polyline" in cards[WALK]["svg"]
    json.dumps(shown, allow_nan=False)
    json.dumps(work_trials.trial_view(asked, WALK), allow_nan=False)


def test_a_folder_without_trials_says_what_would_be_one(tmp_path):
    folder = tmp_path / "photos"
    folder.mkdir()
    (folder / "photo.jpg").write_bytes(b"\xff\xd8\xff")
    with pytest.raises(InputError, match="holds no trial file") as error:
        work_trials.folder_view(_asked(folder))
    assert ".c3d" in str(error.value)


def test_conditions_come_from_a_pattern_of_names(tmp_path):
    folder = tmp_path / "study"
    folder.mkdir()
    for source, name in ((WALK, "S1_soft.c3d"), (OTHER, "S2_hard.c3d")):
        shutil.copy(DATA / "biomechzoo" / source, folder / name)
    asked = _asked(folder, names=r"(?P<subject>S\d)_(?P<shoe>\w+)")
    cards = work_trials.folder_view(asked)["cards"]
    assert [card["conditions"] for card in cards] == [
        {"subject": "S1", "shoe": "soft"},
        {"subject": "S2", "shoe": "hard"},
    ]
    with pytest.raises(InputError, match="pattern of names"):
        work_trials.folder_view(_asked(folder, names="(?P<shoe>"))


def test_the_report_is_written_with_the_edits(walks):
    asked = _asked(walks)
    change = {"step": 1, "what": "exclude", "value": "", "why": "stumbled on the way"}
    work_trials.trial_view(asked, WALK, change=change, keep=True)
    page = Path(work_trials.written_report(asked))
    assert "stumbled on the way" in page.read_text(encoding="utf-8")


def test_an_envelope_keeps_every_peak():
    values = np.sin(np.arange(10_000) / 50.0)
    values[4321] = 9.0
    values[100:200] = math.nan
    signal = Signal("x", values, 1000.0, 2.0)
    seen = signal.envelope(2.0, 12.0, 300)
    assert len(seen.low) <= 300
    assert np.nanmax(seen.high) == 9.0
    assert np.nanmin(seen.low) == np.nanmin(values)
    assert np.isnan(seen.high[3:5]).all()
    place = int(np.nanargmax(seen.high))
    assert (
        seen.start + place * seen.spacing <= 2.0 + 4.321 < seen.start + (place + 1) * seen.spacing
    )
    few = signal.envelope(3.0, 3.05, 300)
    assert np.array_equal(few.low, few.high)
    assert few.low == pytest.approx(values[1000:1051])
    assert len(signal.envelope(99.0, 100.0, 10).low) == 0
