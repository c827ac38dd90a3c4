"""Damaged files of every reader outside trials: an answer whose numbers are numbers, or a refusal.

A refusal is one of ours, in words: no name of an exception of another library is in it.
"""

from __future__ import annotations

import builtins
import re
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings

from damaged_bytes import damaged, damages
from underfoot.case import Case, load
from underfoot.compute.result import Result
from underfoot.compute.run import run
from underfoot.core import DataError, UnderfootError
from underfoot.core.text import harmless
from underfoot.material import read
from underfoot.shoe.files.read import read_mesh
from underfoot.slip.dynamics.gait import load_history
from underfoot.surface.read import read_surface
from underfoot_design_studies.study_file import load_plan

TESTS = Path(__file__).parents[1]
EXAMPLES = TESTS.parent / "examples"
RAW = [name for name, one in vars(builtins).items() if isinstance(one, type) and "Error" in name]
SWEEP = "f (Hz),E_stor (Pa),E_loss (Pa)\n" + "".join(
    f"{10**k:g},{1e6 * 2**k:g},{2e5 * 2**k:g}\n" for k in range(-3, 4)
)
PRONY = """# M\u00fcller, compound with \u00b5m particles
modulus = "young"
equilibrium_modulus = "3 MPa"
[[term]]
modulus = "1 MPa"
relaxation_time = "0.01 s"
[[term]]
modulus = "2 MPa"
relaxation_time = "1 s"
"""
HISTORY = "# note: Gr\u00f6\u00dfe\ntime_s,normal_per_body_weight,shear_ratio\n" + "".join(
    f"{k / 50:g},{0.1 + 0.02 * k:g},{0.2 - 0.005 * k:g}\n" for k in range(30)
)
HEIGHTS = "x [\u00b5m]; z [\u00b5m]\n" + "".join(f"{k};{np.sin(k):.4f}\n" for k in range(64))
STUDY = f"""base = "{(EXAMPLES / "work_shoe_untreaded_glycerol.toml").as_posix()}"
[vary]
"motion.speed" = {{ from = "0.3 m/s", to = "0.7 m/s", steps = 3 }}
"shoe.material.shore_a" = [50, 60]
[uncertain]
"contaminant.viscosity" = {{ lognormal = "200 cP", factor = 1.3 }}
[method]
budget = 20
design = "sobol"
"""


def mesh_bytes(kind):
    import trimesh

    data = trimesh.creation.box((0.1, 0.05, 0.01)).export(file_type=kind)
    return data if isinstance(data, bytes) else data.encode()


def checked_mesh(path):
    assert np.isfinite(read_mesh(path).triangles).all()


def checked_sweep(path):
    for one in read.read_dynamic(path):
        assert np.isfinite(one.storage_modulus).all()


def checked_history(path):
    history = load_history(path)
    assert np.isfinite(history.time).all()


SEEDS = {
    **{f"sole.{kind}": (lambda kind=kind: mesh_bytes(kind), checked_mesh) for kind in
       ("stl", "obj", "ply", "off", "glb")},
    "sweep.csv": (lambda: SWEEP.encode(), checked_sweep),
    "prony.toml": (lambda: PRONY.encode("latin-1"), read.read_prony),
    "gait.csv": (lambda: HISTORY.encode("latin-1"), checked_history),
    "heights.txt": (lambda: HEIGHTS.encode("utf-16"), read_surface),
    "study.toml": (lambda: STUDY.encode(), load_plan),
    "case.toml": ((EXAMPLES / "work_shoe_untreaded_glycerol.toml").read_bytes, Case.load),
}  # fmt: skip


@cache
def seed(name):
    return SEEDS[name][0]()


def refusal(function, path):
    """Return our refusal of a file, None where it is read; anything else that is raised passes."""
    try:
        function(path)
    except UnderfootError as error:
        refused = error
    else:
        return None
    assert not [name for name in RAW if re.search(rf"\b{name}\b", str(refused))], str(refused)
    return refused


@pytest.mark.parametrize("name", SEEDS)
@settings(
    max_examples=40, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(damage=damages())
def test_a_damaged_file_is_read_or_refused_in_words(tmp_path, name, damage):
    path = tmp_path / name
    path.write_bytes(damaged(seed(name), damage))
    refusal(SEEDS[name][1], path)


@pytest.mark.parametrize("name", SEEDS)
def test_what_is_damaged_was_whole(tmp_path, name):
    path = tmp_path / name
    path.write_bytes(seed(name))
    assert refusal(SEEDS[name][1], path) is None


@pytest.fixture(scope="module")
def result_folder(tmp_path_factory):
    case = load(EXAMPLES / "work_shoe_untreaded_glycerol.toml")
    case = case.replace({"numerics.quick_grid_spacing": "3 mm", "numerics.grid_spacing": "3 mm"})
    folder = tmp_path_factory.mktemp("result") / "one"
    run(case, quick=True).save(folder)
    return folder


# h5netcdf's File that could not be opened fails once more where it is collected
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
@settings(
    max_examples=30, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(damage=damages())
@example(damage=("overwrite", True, 0.2, b"\xff" * 8, b""))
@pytest.mark.parametrize("name", ["result.nc", "result.json"])
def test_a_damaged_result_is_read_or_refused_in_words(result_folder, tmp_path, name, damage):
    for path in result_folder.iterdir():
        (tmp_path / path.name).write_bytes(path.read_bytes())
    (tmp_path / name).write_bytes(damaged((result_folder / name).read_bytes(), damage))
    refusal(Result.load, tmp_path)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "latin-1", "utf-16", "utf-16-le"])
@pytest.mark.parametrize(
    ("text", "name"), [(HISTORY, "gait.csv"), (PRONY, "prony.toml"), (HEIGHTS, "heights.txt")]
)
def test_a_text_file_is_read_in_every_encoding_that_programs_write(tmp_path, encoding, text, name):
    path = tmp_path / name
    path.write_bytes(text.encode(encoding))
    assert refusal(SEEDS[name][1], path) is None


@pytest.mark.parametrize("number", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("kind", ["stl", "obj", "ply", "off", "glb"])
def test_a_mesh_with_one_corner_that_is_no_number_is_refused(tmp_path, kind, number):
    import trimesh

    box = trimesh.creation.box((0.1, 0.05, 0.01))
    corners = np.array(box.vertices)
    corners[3, 1] = number
    with np.errstate(all="ignore"):  # its normals
        data = trimesh.Trimesh(corners, box.faces, process=False).export(file_type=kind)
    path = tmp_path / f"sole.{kind}"
    path.write_bytes(data if isinstance(data, bytes) else data.encode())
    with pytest.raises(DataError):
        read_mesh(path)


@pytest.mark.parametrize(
    ("text", "safe"),
    [
        ("=cmd|' /C calc'!A0", False),
        ("@SUM(1)", False),
        ("-2+3+cmd|' /C calc'!A0", False),
        ("+HYPERLINK(A1)", False),
        ("\t=1", False),
        ("-0.25", True),
        ("-0.2 to 0.3", True),
        ("-", True),
        ("work shoe = 3", True),
    ],
)
def test_text_that_a_spreadsheet_would_run_gets_a_quote(text, safe):
    assert harmless(text) == (text if safe else f"'{text}")
