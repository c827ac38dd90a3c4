"""Damaged real files of every kind: an answer or a DataError, never anything else."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from damaged_bytes import damaged, damages
from underfoot.core import DataError
from underfoot.trials import described_file

DATA = Path(__file__).parents[1] / "data" / "trials"
FILES = [
    "bmc/Gait.c3d",
    "biomechzoo/HC036A23.c3d",
    "btk/ADemo1_rewrite_c3d_pc_integer.c3d",
    "bmc/walk1.trc",
    "bmc/walk1.forces",
    "opensim/leg69_stance_grf.mot",
    "cetr/HT-2n-6-4_2_001.csv",
    "pcs/demo_3.txt",
]


@cache
def _content(name: str) -> bytes:
    return (DATA / name).read_bytes()


def _refusal(path: Path) -> DataError | None:
    try:
        for description in described_file(path):
            description.text()
            description.as_dict()
    except DataError as error:
        return error
    return None


@pytest.mark.parametrize("name", FILES)
@settings(
    max_examples=12,
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
@given(damage=damages())
def test_damaged_files_never_raise_anything_else(tmp_path, name, damage):
    path = tmp_path / Path(name).name
    path.write_bytes(damaged(_content(name), damage))
    refused = _refusal(path)
    assert refused is None or (refused.where and "not foreseen" not in refused.what)


@pytest.fixture(scope="module")
def workbook(tmp_path_factory) -> bytes:
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    book.active.append(["time (s)", "Fx (N)", "Fy (N)", "Fz (N)"])
    for i in range(200):
        book.active.append([i / 100, 10.0, 0.0, 300.0 * (i > 50)])
    path = tmp_path_factory.mktemp("book") / "whole.xlsx"
    book.save(path)
    return path.read_bytes()


@settings(
    max_examples=20,
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
@given(damage=damages())
def test_damaged_workbooks_never_raise_anything_else(tmp_path, workbook, damage):
    path = tmp_path / "run.xlsx"
    path.write_bytes(damaged(workbook, damage))
    refused = _refusal(path)
    assert refused is None or refused.where


@settings(max_examples=40, deadline=None)
@given(data=st.binary(max_size=3000), suffix=st.sampled_from([".c3d", ".csv", ".mot", ".trc"]))
def test_random_bytes_are_refused(tmp_path_factory, data, suffix):
    path = tmp_path_factory.mktemp("random") / f"x{suffix}"
    path.write_bytes(data)
    refused = _refusal(path)
    assert refused is None or refused.where
