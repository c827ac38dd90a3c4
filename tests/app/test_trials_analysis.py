"""Whole folders: verdicts, bad files, resuming, the same bytes, the commands."""

import hashlib
import os
import re
import shutil
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import psutil
import pytest
from typer.testing import CliRunner

from underfoot.core import InputError
from underfoot.trials import TrialsProfile
from underfoot.trials.pages.report import STORE, write_trials_report
from underfoot.trials.recording.protocols import QUANTITIES, protocol, protocol_names
from underfoot.trials.simulator import simulated_folder
from underfoot.trials.study import analyse_folder
from underfoot.trials.study import folder as folder_module
from underfoot.trials.study.conditions import conditions_of
from underfoot.trials.study.methods import methods_paragraphs


@pytest.fixture(scope="module")
def tester(tmp_path_factory):
    folder = tmp_path_factory.mktemp("tester")
    simulated_folder("tester", folder, count=3)
    return folder


def _hashes(folder: Path) -> dict[str, str]:
    return {
        str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


@pytest.mark.slow
def test_the_same_folder_gives_the_same_bytes(tester, tmp_path):
    for name, processes in (("a", 1), ("b", 2)):
        analysis = analyse_folder(
            tester, protocol("report_g4"), store=tmp_path / name / STORE, processes=processes
        )
        write_trials_report(analysis, tmp_path / name, details=1)
    first, second = _hashes(tmp_path / "a"), _hashes(tmp_path / "b")
    assert first == second
    assert {"report.html", "trials.xlsx", "tables/files.csv", "figures/maps.svg"} <= set(first)
    # Once more from the stored results, over the old report.
    analysis = analyse_folder(tester, protocol("report_g4"), store=tmp_path / "a" / STORE)
    write_trials_report(analysis, tmp_path / "a", details=1)
    assert _hashes(tmp_path / "a") == first


def test_spreadsheet_holds_the_numbers_and_no_formulas(tmp_path):
    import openpyxl

    from underfoot.trials.pages.report import csv_text, write_spreadsheet
    from underfoot.trials.study import TrialTable

    rows = (("=1+1", 1.5, None, ""), ("plain", float("nan"), 3, "-x"))
    table = TrialTable.of(
        "odd: name/1", "A title", ("text", "number", "count", "more"), rows, "note"
    )
    write_spreadsheet([table, table], ["How it was done."], tmp_path / "a.xlsx")
    book = openpyxl.load_workbook(tmp_path / "a.xlsx")
    assert len(book.sheetnames) == 3
    cells = list(book.worksheets[1].iter_rows(min_row=3, max_row=4, values_only=True))
    assert cells == [("'=1+1", 1.5, None, None), ("plain", None, 3, "-x")]
    assert csv_text(table).splitlines()[1] == "'=1+1,1.5,,"


def test_an_interrupted_analysis_goes_on(tester, tmp_path, monkeypatch):
    store = tmp_path / STORE
    count = 0

    def stop_after_four(stage, fraction, residual=None):
        nonlocal count
        count += 1
        if count == 4:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        analyse_folder(
            tester, protocol("report_g4"), store=store, processes=1, progress=stop_after_four
        )
    kept = len(list(store.glob("*.json")))
    assert 3 <= kept < 9
    made = []
    original = folder_module._analyse_file
    monkeypatch.setattr(
        folder_module, "_analyse_file", lambda *job: made.append(job) or original(*job)
    )
    analysis = analyse_folder(tester, protocol("report_g4"), store=store, processes=1)
    assert len(analysis.files) == 9
    assert len(made) == 9 - kept
    # A changed file, or a damaged store, is analysed again.
    for damaged in ("{", '[{"file": "without its rows"}]'):
        (next(store.glob("*.json"))).write_text(damaged)
        made.clear()
        again = analyse_folder(tester, protocol("report_g4"), store=store, processes=1)
        assert len(made) == 1
        assert [one.main for one in again.files] == [one.main for one in analysis.files]


def test_one_bad_file_never_stops_the_rest(tester, tmp_path):
    folder = tmp_path / "trials"
    shutil.copytree(tester, folder)
    (folder / "empty.csv").write_bytes(b"")
    (folder / "noise.c3d").write_bytes(bytes(range(256)) * 20)
    (folder / "words.csv").write_text("this is\nno table\n")
    (folder / "short.csv").write_text("time (s),Fx (N),Fy (N),Fz (N)\n0,1,1,1\n0.001,1,1,1\n")
    text = (folder / "work_none_scan_1.csv").read_text().splitlines()
    (folder / "truncated.csv").write_text("\n".join(text[:200]) + "\n0.2,3")
    (folder / "unloaded.csv").write_text(
        "\n".join([text[0], *(line.replace(",5", ",0") for line in text[1:280])])
    )
    (folder / "photo.jpg").write_bytes(b"\xff\xd8\xff")
    analysis = analyse_folder(folder, protocol("report_g4"), processes=1)
    verdicts = {one.file: one for one in analysis.files}
    assert sum(one.usable for one in analysis.files) == 9
    for name in ("empty.csv", "noise.c3d", "words.csv", "short.csv", "truncated.csv"):
        assert verdicts[name].verdict == "refused"
        assert verdicts[name].reasons[0]
        assert "Traceback" not in verdicts[name].reasons[0]
    assert any("photo.jpg" in note for note in analysis.notes)


class _Deadly:
    """Ends the process that unpickles it, as a crash in a native library would."""

    def __reduce__(self):
        return os._exit, (1,)


def test_a_file_that_kills_its_process_is_refused_alone(tester):
    files = sorted(tester.glob("work_none*.csv"))
    jobs = [
        (path.name, (path,), {}, [], TrialsProfile(), protocol("report_g4"), "base", None)
        for path in files
    ]
    deadly = (
        "deadly.csv",
        (tester / "deadly.csv",),
        _Deadly(),
        [],
        TrialsProfile(),
        None,
        "b",
        None,
    )
    jobs.insert(1, deadly)
    jobs.append(jobs[0])
    seen = []
    results = folder_module._run(
        jobs, 2, lambda stage, fraction, residual=None: seen.append(fraction)
    )
    verdicts = [result[0].verdict for result in results]
    assert verdicts == ["accepted", "refused", "accepted", "accepted", "accepted"]
    assert "ended without an answer" in results[1][0].reasons[0]
    assert seen[-1] == 1.0


def test_scripts_without_a_guard_work_too(tester, tmp_path):
    script = tmp_path / "plain.py"
    script.write_text(
        "from pathlib import Path\n"
        "from underfoot.trials.study import analyse_folder\n"
        "from underfoot.trials.recording.protocols import protocol\n"
        f"found = analyse_folder(Path({str(tester)!r}), protocol('report_g4'), processes=2)\n"
        "print(sum(one.usable for one in found.files))\n"
    )
    done = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "9"


def test_rules_refuse_and_caution(tester):
    # The made-up scans run at 0.7 m/s: the standard asks for 0.3 m/s.
    analysis = analyse_folder(tester, protocol("en_iso_13287"), processes=1)
    for one in analysis.files:
        assert one.verdict == "refused"
        assert any("sliding speed" in reason for reason in one.reasons)
    assert analysis.study.notes == ("no usable file",)


def test_markers_and_forces_of_one_name_are_one_trial(tmp_path):
    source = Path(__file__).parents[1] / "data" / "trials"
    pairs = sorted(source.rglob("walk1.*"))
    assert len(pairs) >= 2
    for path in pairs:
        if path.suffix in (".trc", ".forces"):
            shutil.copy(path, tmp_path)
    analysis = analyse_folder(tmp_path, protocol("level_walking"), processes=1)
    assert len(analysis.files) == 1
    # README of the data: three clean stances, RCOF 0.21, 0.18, 0.18.
    assert analysis.files[0].main["rcof"] == pytest.approx(0.19, abs=0.02)


def test_conditions_table(tmp_path):
    path = tmp_path / "conditions.csv"
    path.write_text("File;Shoe;Viscosity (cP);thickness (mm)\na.csv;one;219;5,5\nb.csv;two;;6\n")
    found = conditions_of(tmp_path)
    assert found["a.csv"]["shoe"] == "one"
    assert found["a.csv"]["viscosity"] == pytest.approx(0.219)
    assert found["a.csv"]["thickness"] == pytest.approx(5.5e-3)
    assert "viscosity" not in found["b.csv"]
    path.write_text("File,x\na.csv,1\na.csv,2\n")
    with pytest.raises(InputError, match="named twice"):
        conditions_of(tmp_path)
    path.write_text("name,x\na.csv,1\n")
    with pytest.raises(InputError, match='no column "file"'):
        conditions_of(tmp_path)


@pytest.mark.parametrize("name", sorted(protocol_names()))
def test_every_protocol_reads(name):
    one = protocol(name)
    assert one.source
    for rule in one.rules:
        assert rule.quantity in QUANTITIES
        assert rule.statement()
        inside = rule.low if rule.low is not None else rule.high
        assert inside is not None
        assert rule.broken_by(inside) == ""
        assert rule.broken_by(-1e9 if rule.low is not None else 1e9)


def test_protocols_of_a_user(tmp_path):
    (tmp_path / "mine.toml").write_text(
        '[protocol.ours]\ntitle = "Ours"\nkind = "slip_tester"\nsource = "our manual"\n'
        '[protocol.ours.method]\nwindow_begin = "0.1 s"\nwindow_end = "0.2 s"\n'
        '[protocol.ours.rules.normal_force]\nlow = "300 N"\n'
    )
    assert protocol("ours", [tmp_path]).number("window_end", "s") == 0.2
    (tmp_path / "mine.toml").write_text(
        '[protocol.ours]\ntitle = "Ours"\nkind = "slip_tester"\nsource = "x"\n'
        '[protocol.ours.rules.normal_farce]\nlow = "300 N"\n'
    )
    with pytest.raises(InputError, match="normal_force"):
        protocol("ours", [tmp_path])


def test_commands(tmp_path, monkeypatch):
    from underfoot.cli.trials import trials_app

    monkeypatch.chdir(tmp_path)
    run = CliRunner().invoke
    made = run(trials_app, ["simulate", "relaxation", "--count", "2", "--out", "made"])
    assert made.exit_code == 0, made.output
    shown = run(trials_app, ["analyse", "--list"])
    assert "report_g6" in shown.output
    options = ["analyse", "made", "--protocol", "report_g1_relaxation", "--out", "out"]
    done = run(trials_app, options)
    assert done.exit_code == 0, done.output
    assert "accepted" in done.output
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert "Methods" in page
    assert "http" not in page.replace("http://www.w3.org", "")
    assert run(trials_app, options).exit_code == 0
    wrong = run(trials_app, ["analyse", "made", "--protocol", "report_g11", "--out", "o"])
    assert wrong.exit_code == 2
    assert "report_g1" in wrong.output
    assert run(trials_app, ["analyse", "made", "--protocol", "report_g2"]).exit_code == 2
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "thesis.doc").write_text("mine")
    full = run(trials_app, [*options[:-1], "full"])
    assert full.exit_code == 2
    assert (tmp_path / "full" / "thesis.doc").read_text() == "mine"


def test_methods_are_true_for_each_file(tmp_path):
    source = Path(__file__).parents[1] / "data" / "trials"
    for path in [
        *source.rglob("walk1.trc"),
        *source.rglob("walk1.forces"),
        *source.rglob("HC030A05.c3d"),
    ]:
        shutil.copy(path, tmp_path)
    analysis = analyse_folder(tmp_path, protocol("level_walking"), processes=1)
    text = " ".join(analysis.methods)
    assert "more than 20 N of normal force" in text
    used = sum(step.verdict != "rejected" for one in analysis.files for step in one.steps)
    every = sum(len(one.steps) for one in analysis.files)
    assert f"Of {every} contacts {used} were used" in text
    assert "ends after the record (1)" in text
    assert "± is the standard uncertainty" in text
    # Made unlike by hand: both ways are told, with their counts, and no majority speaks for all.
    one = analysis.files[0]
    other = [
        replace(m, conventions={**m.conventions, "baseline": "not subtracted"})
        for m in one.measurements
    ]
    files = [replace(one, numbers=tuple(other)), *analysis.files[1:]]
    paragraphs = methods_paragraphs(files, analysis.protocol, analysis.study, "1")
    assert "subtracted (3 of 5: walk1.trc); not subtracted (2 of 5: HC030A05.c3d)" in " ".join(
        paragraphs
    )


def test_page_has_the_summary_first_and_reasons_on_it(tmp_path):
    source = Path(__file__).parents[1] / "data" / "trials"
    for path in source.rglob("walk1.*"):
        shutil.copy(path, tmp_path)
    analysis = analyse_folder(tmp_path, protocol("level_walking"), processes=1)
    write_trials_report(analysis, tmp_path / "out", details=0)
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert page.index("Required friction (RCOF) 0.187") < page.index("<details")
    assert "3 steps" in page
    # The reason stands below its row over the whole width: no column runs out of the page.
    assert re.search(
        r'<tr class="below"><td colspan="\d+">(<span[^>]*>)?ends after the record', page
    )
    assert "rejected" in page
    assert "details::details-content" in page


def test_no_worker_outlives_a_killed_analysis(tmp_path):
    """kill -9 of the command while its workers read: they end by themselves within seconds."""
    folder = tmp_path / "slips"
    simulated_folder("slips", folder, count=40)
    command = [str(Path(sys.executable).with_name("underfoot")), "trials", "analyse", str(folder)]
    command += ["--protocol", "report_g6", "--processes", "2", "--out", str(tmp_path / "out")]
    parent = subprocess.Popen(
        command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True
    )
    workers = []
    limit = time.monotonic() + 60
    while len(workers) < 2 and time.monotonic() < limit:
        assert parent.poll() is None, "the analysis ended before it was killed"
        family = psutil.Process(parent.pid).children(recursive=True)
        workers = [p for p in family if "spawn_main" in " ".join(p.cmdline())]
        time.sleep(0.05)
    assert len(workers) >= 2
    parent.kill()
    parent.wait(timeout=10)
    assert psutil.wait_procs(family, timeout=10)[1] == []
    assert not list(tmp_path.glob("out/report.html"))
