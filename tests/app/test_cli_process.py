"""The command line as a person meets it: a real process with its exit code, output and files."""

import json
import signal
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

import pytest

from commands import COMMAND, called, process

EXAMPLES = Path(__file__).parents[2] / "examples"
DRY = EXAMPLES / "work_shoe_full_tread_dry.toml"
WET = EXAMPLES / "work_shoe_untreaded_glycerol.toml"
COARSE = {"grid_spacing": "1.2 mm", "quick_grid_spacing": "1.2 mm", "tread_positions": 1}
FAST = [word for key in COARSE for word in ("--set", f"numerics.{key}={COARSE[key]}")]


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """Return the folder and the process of one quick run."""
    folder = tmp_path_factory.mktemp("run")
    listed = {"PYTHONPROFILEIMPORTTIME": "1"}  # on stderr, what the process imports
    done = process("run", DRY, "--quick", *FAST, "--out", "result", folder=folder, **listed)
    return folder, done


def test_the_package_runs_where_the_command_is_not_on_the_path(tmp_path):
    done = subprocess.run(
        [sys.executable, "-m", "underfoot", "--version"],
        cwd=tmp_path, capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip
    assert (done.returncode, done.stdout.strip()) == (0, f"underfoot {version('underfoot')}")


def test_help_imports_nothing_heavy(tmp_path):
    program = (
        "import sys\nsys.argv = ['underfoot', '--help']\nfrom underfoot.cli import main\n"
        "try:\n    main()\nexcept SystemExit as end:\n    assert end.code == 0\n"
        "print(sorted({name.split('.')[0] for name in sys.modules}))\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program],
        cwd=tmp_path, capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip
    assert "Commands" in done.stdout, done.stderr
    loaded = done.stdout.strip().splitlines()[-1]
    heavy = "numpy scipy pydantic pint tomlkit xarray matplotlib jinja2 numba".split()
    assert [name for name in heavy if f"'{name}'" in loaded] == []


def test_a_run_on_a_parametric_tread_imports_no_compiler(finished):
    _, done = finished
    lines = (line for line in done.stderr.splitlines() if line.startswith("import time:"))
    loaded = {line.rpartition("|")[2].strip() for line in lines}
    assert {"underfoot.compute.run", "underfoot.shoe.grids", "scipy.ndimage"} <= loaded
    assert loaded & {"numba", "pandas", "xarray", "matplotlib"} == set()


def test_a_run_ends_with_a_table_and_leaves_a_whole_folder(finished):
    folder, done = finished
    assert done.returncode == 0, done.stderr
    for words in (
        "Coefficient of friction",
        "0.800",
        "Assumptions (",
        "Available COF 0.800",
        "report.html",
    ):
        assert words in done.stdout
    names = {path.name for path in (folder / "result").iterdir()}
    files = "case.toml result.nc result.json summary.csv report.html .underfoot"
    assert set(files.split()) == names
    assert [path.name for path in folder.iterdir()] == ["result"]
    stored = json.loads((folder / "result" / "result.json").read_text())
    # the law of this case is a constant: friction is exactly what the case gives
    assert stored["cof"]["value"] == pytest.approx(0.8, rel=1e-6)
    assert stored["normal_force"]["value"] == pytest.approx(500, rel=1e-3)


def test_the_case_of_a_result_runs_again_as_the_same_case(finished):
    from underfoot.case import Case

    folder, _ = finished
    stored = json.loads((folder / "result" / "result.json").read_text())
    assert Case.load(folder / "result" / "case.toml").hash == stored["provenance"]["case_hash"]


def test_an_existing_folder_is_refused_before_anything_is_computed(finished):
    folder, _ = finished
    before = {path: path.stat().st_mtime_ns for path in (folder / "result").iterdir()}
    done = called("run", DRY, "--quick", "--out", "result", folder=folder)
    assert done.returncode == 2
    assert "exists and is not empty" in done.stderr
    assert "--overwrite" in done.stderr
    assert "computing" not in done.stderr
    assert {path: path.stat().st_mtime_ns for path in (folder / "result").iterdir()} == before


def test_json_goes_to_standard_output_alone_and_writes_nothing(tmp_path):
    done = process("run", DRY, "--quick", *FAST, "--json", folder=tmp_path)
    assert done.returncode == 0, done.stderr
    content = json.loads(done.stdout)
    assert content["cof"]["value"] == pytest.approx(0.8, rel=1e-6)
    for name, scalar in content.items():
        if isinstance(scalar, dict) and "value" in scalar:
            assert {"value", "unit", "uncertainty", "assumed"} <= set(scalar), name
    assert list(tmp_path.iterdir()) == []


def test_compare_reads_result_folders_and_names_what_differs(finished):
    folder, _ = finished
    other = called(
        "run", DRY, "--quick", *FAST, "--out", "other",
        "--set", "interface.constant_cof=0.6", folder=folder,
    )  # fmt: skip
    assert other.returncode == 0, other.stderr
    done = called("compare", "result", "other", "--json", folder=folder)
    assert done.returncode == 0, done.stderr
    content = json.loads(done.stdout)
    assert content["differences"] == [{"path": "friction.cof", "values": ["0.8", "0.6"]}]
    assert " is 0.200 above that of " in content["headline"][0]
    assert "no spread is known" in content["headline"][0]  # of constants that nobody measured
    shown = called("compare", "result", "other", folder=folder)
    assert "friction.cof" in shown.stdout
    three = called(
        "compare", "result", "other", "other", "--out", "compared", "--json", folder=folder
    )
    assert three.returncode == 0, three.stderr
    several = json.loads(three.stdout)
    assert [rank["letter"] for rank in several["ranking"]] == ["A", "B", "C"]
    assert several["differences"][0]["values"] == ["0.8", "0.6", "0.6"]
    page = (folder / "compared" / "report.html").read_text()
    assert page.count('class="stage"') == 3
    assert (folder / "compared" / "contact_pressure.png").stat().st_size > 10_000
    missing = called("compare", "result", "nothing.toml", folder=folder)
    assert missing.returncode == 2


def test_a_bad_case_ends_with_its_exit_code_and_no_files(tmp_path):
    done = called(
        "run", WET, "--set", "shoe.sole.outsole_thickness=0 mm", "--set", "motion.speed=0.7",
        folder=tmp_path,
    )  # fmt: skip
    assert done.returncode == 2
    assert "2 problems" in done.stderr
    assert "Traceback" not in done.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.slow
@pytest.mark.parametrize(
    ("number", "code", "message"),
    [
        (signal.SIGINT, 130, "stopped"),
        (signal.SIGTERM, 143, "terminated"),
        (signal.SIGKILL, -signal.SIGKILL, ""),
    ],
)
def test_a_run_ended_by_a_signal_leaves_nothing_behind(tmp_path, number, code, message):
    (tmp_path / "kept").mkdir()
    (tmp_path / "kept" / ".underfoot").write_text("earlier results")
    (tmp_path / "kept" / "old.txt").write_text("mine")
    running = subprocess.Popen(
        [*COMMAND, "run", str(WET), "--out", "kept", "--overwrite", "--set",
         "numerics.grid_spacing=0.3 mm"],
        cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    try:
        assert running.stderr is not None
        assert " s so far" in running.stderr.readline()
        assert running.poll() is None, "it ended before it could be stopped"
        running.send_signal(number)
        out, err = running.communicate(timeout=180)
    finally:
        running.kill()
    assert running.returncode == code, err
    lines = [line for line in err.splitlines() if " s so far" not in line]
    assert len(lines) == bool(message)
    assert message in err
    assert out == ""
    assert [path.name for path in tmp_path.iterdir()] == ["kept"]
    names = sorted(path.name for path in (tmp_path / "kept").iterdir())
    assert names == [".underfoot", "old.txt"]


def test_a_closed_pipe_is_no_error(tmp_path):
    done = subprocess.run(
        f"{sys.executable} -c 'from underfoot.cli import main; main()' schema | head -1",
        shell=True, cwd=tmp_path, capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip
    assert done.stdout == "{\n"
    assert done.stderr == ""
