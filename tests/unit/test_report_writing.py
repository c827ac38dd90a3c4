"""Output that fails in part: what was computed is kept, each failure is one line, and is named."""

import errno
import json
import math
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import typer

from underfoot.cli.output import finish
from underfoot.core import InputError, SourcedValue
from underfoot.core.page import PageSection
from underfoot.core.presentation import (
    Part,
    Presentable,
    Table,
    percent,
    quantity_text,
    value_text,
)
from underfoot.report import dispatch, figures, plot, write_report
from underfoot.report.writing import (
    WRITTEN_IN_PART,
    data_text,
    json_text,
    write_folder,
    write_text,
)


class Answer(Presentable):
    kind = "answer"
    name = "An answer"

    def headline(self):
        return ("Forty-two ± 1.",)

    def cautions(self):
        return ("The question is not known.",)

    def table(self):
        return Table(
            "Numbers", ("Quantity", "Value"), [("answer", "42"), (Part("of it"), float("nan"))]
        )

    def remarks(self):
        return {"Assumptions": ["first", "second", "third", "fourth [bold]"]}

    def to_dict(self):
        return {"answer": {"value": 42.0, "spread": float("inf")}}

    def data_tables(self):
        return {"numbers": Table("", ("name", "value"), [("a", 1.5), ("b", None)])}


def fails(error):
    def write(path):
        path.write_text("half")
        raise error

    return write


SKEWED = (0.08, 0.3)
FULL = OSError(errno.ENOSPC, "No space left on device")
MISSING = ModuleNotFoundError("No module named 'h5py'", name="h5py")


@pytest.mark.parametrize(
    ("error", "message"),
    [
        (FULL, "no space left on device; free some space."),
        (MISSING, "the package h5py is missing; install it with: pip install h5py"),
        (OSError(errno.EACCES, "Permission denied"), "check the permissions"),
        (InputError("bad", remedy="Mend it"), "bad. Mend it."),
        (RuntimeError("odd"), "internal error (RuntimeError: odd)"),
    ],
)
def test_a_picture_that_fails_costs_no_other_file(tmp_path, error, message):
    written = write_folder(
        tmp_path / "out",
        {"a.txt": write_text("a")},
        {"bad.png": fails(error), "good.png": write_text("b")},
        write_text("page"),
    )
    assert len(written.failures) == 1
    assert written.failures[0].startswith("bad.png could not be written: ")
    assert message in written.failures[0]
    names = {path.name for path in written.folder.iterdir()}
    assert names == {".underfoot", "a.txt", "good.png", "report.html"}
    assert written.page == tmp_path / "out" / "report.html"


def test_data_that_does_not_fit_is_saved_elsewhere(tmp_path, monkeypatch):
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    monkeypatch.setenv("TMPDIR", str(elsewhere))
    monkeypatch.setattr("tempfile.tempdir", None)

    def only_elsewhere(path):
        if elsewhere not in path.parents:
            raise FULL
        path.write_text("kept")

    written = write_folder(tmp_path / "out", {"a.json": only_elsewhere}, {}, fails(FULL))
    assert written.page is None
    assert len(written.failures) == 3
    (saved,) = elsewhere.rglob("a.json")
    assert saved.read_text() == "kept"
    assert str(saved.parent) in written.failures[-1]
    nowhere = write_folder(tmp_path / "no", {"a.json": fails(FULL)}, {})
    assert nowhere.failures[-1] == "Not saved anywhere: a.json."


def test_a_report_names_its_failures_and_the_command_says_written_in_part(
    tmp_path, monkeypatch, capsys
):
    def broken(table):
        return fails(FULL)

    monkeypatch.setattr("underfoot.report.writing.write_csv", broken)
    answer = Answer()
    written = write_report(answer, tmp_path / "out")
    assert [line.partition(" ")[0] for line in written.failures] == ["numbers.csv", "Not"]
    assert json.loads((tmp_path / "out" / "answer.json").read_text())["answer"]["value"] == 42.0
    with pytest.raises(typer.Exit) as stop:
        finish(answer, written, json=False)
    assert stop.value.exit_code == WRITTEN_IN_PART
    seen = capsys.readouterr()
    assert "Forty-two" in seen.out
    assert "numbers.csv could not be written" in seen.err
    assert "written in part" in seen.err


def test_a_full_disk_keeps_what_fits(tmp_path):
    disk = tmp_path / "disk"
    disk.mkdir()
    mounted = shutil.which("mount") and os.geteuid() == 0
    command = ["mount", "-t", "tmpfs", "-o", "size=256k", "tmpfs", str(disk)]
    if not mounted or subprocess.run(command, capture_output=True).returncode:
        # without the right to mount: the limit of a process on the size of a file
        import resource

        before = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, before[1]))
        try:
            _fill(disk)
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, before)
        return
    try:
        _fill(disk)
    finally:
        subprocess.run(["umount", str(disk)], check=True)


def _fill(disk: Path):
    written = write_folder(
        disk / "out",
        {"small.json": write_text("{}")},
        {"large.png": lambda path: path.write_bytes(bytes(1_000_000))},
        write_text("page"),
    )
    assert [line.partition(" ")[0] for line in written.failures] == ["large.png"]
    assert (disk / "out" / "small.json").read_text() == "{}"
    assert (disk / "out" / "report.html").read_text() == "page"


def test_a_page_has_the_headline_the_cautions_and_folds_the_rest(tmp_path):
    page = write_report(Answer(), tmp_path / "out").page
    assert page is not None
    text = page.read_text()
    assert '<p class="lead">Forty-two ± 1.</p>' in text
    assert '<p class="caution">The question is not known.</p>' in text
    assert "<summary>1 more</summary>" in text
    assert text.index("third") < text.index("<summary>1 more") < text.index("fourth [bold]")
    assert '<td class="part">of it</td>' in text
    assert (tmp_path / "out" / "numbers.csv").read_text() == "name,value\na,1.5\nb,\n"


def test_json_has_one_shape_and_no_infinite_number():
    content = json.loads(json_text(Answer(), advice=Answer()))
    assert list(content)[:6] == ["format", "kind", "name", "usable", "headline", "cautions"]
    assert content["kind"] == "answer"
    assert content["answer"] == {"value": 42.0, "spread": None}
    assert content["advice"]["kind"] == "answer"


def test_what_has_no_figure_and_no_page_is_refused(tmp_path):
    assert figures(Answer()) == {}
    with pytest.raises(InputError, match="nothing of a Answer can be drawn"):
        plot(Answer())
    with pytest.raises(InputError, match="has no report"):
        write_report(3.0, tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_the_report_room_is_not_imported_by_the_types_it_draws():
    program = (
        "import sys; from underfoot.core.presentation import Presentable; "
        "print([name for name in sys.modules if name.startswith('underfoot.report')])"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert done.stdout.strip() == "[]"


@pytest.mark.parametrize(
    ("name", "scalar", "text"),
    [
        ("p", SourcedValue(1130.0, "Pa", uncertainty=126.0), "1.13 ± 0.13 kPa"),
        ("f", SourcedValue(0.36, "N", uncertainty=0.004), "0.36 ± 0.004 N"),
        ("f", SourcedValue(0.001, "N"), "below 0.01 N"),
        ("a", SourcedValue(16.4e-4, "m^2"), "16.4 cm²"),
        ("t", SourcedValue(15e-6, "m"), "15 µm"),
        (
            "cof",
            SourcedValue(0.1, uncertainty=0.05, interval=(0.08, 0.3)),
            "0.100 (0.080 to 0.300)",
        ),
        ("cof", SourcedValue(0.1, uncertainty=0.05, interval=(0.0, 0.2)), "0.100 ± 0.050"),
        ("cof", SourcedValue(0.1), "0.100"),
        ("cof", SourcedValue(None, reason="not converged"), "not determined: not converged"),
        ("slip_probability", SourcedValue(0.73, uncertainty=0.2), "73 % ± 20 %"),
        ("slip_probability", SourcedValue(1.0, uncertainty=1e-5), "above 99.9 %"),
    ],
)
def test_a_value_has_number_unit_and_uncertainty(name, scalar, text):
    assert value_text(name, scalar) == text


def test_shares_and_quantities_have_no_false_digits():
    shares = (0.0, 1e-4, 0.0123, 0.5, 0.9995, 1.0)
    assert [percent(share) for share in shares] == [
        "0.0 %", "below 0.1 %", "1.2 %", "50 %", "above 99.9 %", "100 %",
    ]  # fmt: skip
    assert quantity_text(123456.0, "1") == "123456"


def test_data_of_a_command_is_json_for_every_program():
    data = {"a": math.nan, "b": [math.inf, np.float32(0.5)], "straße": (np.nan, Path("x")), 1: None}
    told = data_text(data)
    assert told.endswith("}\n")
    assert told.splitlines()[6] == '  "straße": ['
    assert json.loads(told, parse_constant=pytest.fail) == {
        "a": None, "b": [None, 0.5], "straße": [None, "x"], "1": None,
    }  # fmt: skip


def test_sections_of_another_package_get_the_object_and_its_pictures(monkeypatch):
    def made(shown, pictures):
        return [PageSection(shown)], "".join(pictures)

    monkeypatch.setattr(dispatch, "_registered_function", lambda *_: made)
    parts, script = dispatch.sections("an answer", {"a": b"1", "b": b"2"})
    assert [part.title for part in parts] == ["an answer"]
    assert script == "ab"
