"""Damaged files of every reader outside trials: an answer whose numbers are numbers, or a refusal.

A refusal is one of ours, in words: no name of an exception of another library is in it.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings

from damaged_bytes import damaged, damages
from reader_files import HEIGHTS, HISTORY, PRONY, SEEDS, refusal, result_files
from underfoot.compute.result import Result
from underfoot.core import DataError
from underfoot.core.text import harmless
from underfoot.shoe.files.read import read_mesh


@cache
def seed(name):
    return SEEDS[name][0]()


@pytest.mark.filterwarnings("ignore::ImportWarning")  # a library's own choices
@pytest.mark.parametrize("name", SEEDS)
@settings(
    max_examples=20, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
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


# h5netcdf's File that could not be opened fails once more where it is collected
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
@settings(
    max_examples=12, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(damage=damages())
@example(damage=("overwrite", True, 0.2, b"\xff" * 8, b""))
@pytest.mark.parametrize("name", ["result.nc", "result.json"])
def test_a_damaged_result_is_read_or_refused_in_words(tmp_path, name, damage):
    for other, data in result_files().items():
        (tmp_path / other).write_bytes(damaged(data, damage) if other == name else data)
    refused = refusal(Result.load, tmp_path)
    if name == "result.nc":  # HDF5 may read some for ever: none is opened
        fields = result_files()[name]
        assert (refused is None) == ((tmp_path / name).read_bytes() == fields)


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
