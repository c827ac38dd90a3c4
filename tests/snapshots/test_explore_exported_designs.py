"""Which designs of a study are exported, in which files, and what is said of those without."""

from types import SimpleNamespace
from typing import Any

import pytest

from underfoot.case import Case
from underfoot.core import InputError, MissingExtraError
from underfoot.explore import export
from underfoot.shoe import parametric
from underfoot.shoe.parametric import mould

BASE = Case(
    shoe="work_shoe_half_tread", floor="vinyl_g4", contaminant="detergent", motion="slip_tester_g4"
)


def study_of(folder, goals=("cof",)):
    designs = [SimpleNamespace(number=number) for number in (4, 7, 2, 9)]
    jobs = [SimpleNamespace(design=each.number, changes={"motion.speed": f"0.{each.number} m/s"})
            for each in designs for _ in range(2)]  # fmt: skip
    for later in jobs[1::2]:
        later.changes = {"motion.speed": "3 m/s"}  # of other conditions
    written: list[Any] = []
    result = SimpleNamespace(designs=designs, jobs=jobs, cases=lambda: "cases",
                             best=lambda count: designs[::-1][:count])  # fmt: skip
    store = SimpleNamespace(folder=folder / "study", write_views=written.append)
    store.folder.mkdir()
    (store.folder / "results.csv").write_text("a table")
    plan = SimpleNamespace(goals=goals, base=BASE, name="wide")
    made: Any = SimpleNamespace(result=lambda: result, plan=plan, store=store)
    return made, written


@pytest.fixture
def solids(monkeypatch):
    """What is written of which solid, as text; a fifth cannot be made."""
    told: list[Any] = []

    def write(shape, path, *, solid):
        told.append([solid, path.name])
        path.write_text("STEP")

    def write_drafted(shape, solid, draft, path):
        told.append([solid, draft, path.name])
        path.write_text("STL")

    monkeypatch.setattr(export, "new_sole", lambda case: f"sole of {case.name}")
    monkeypatch.setattr(parametric, "sole_solid", lambda shape: f"solid {shape}")
    monkeypatch.setattr(parametric, "write_sole", write)
    monkeypatch.setattr(mould, "write_drafted", write_drafted)
    return told


def names(folder):
    return sorted(path.name for path in folder.glob("[!.]*"))


def test_the_best_three_are_written_with_the_case_of_their_first_condition(tmp_path, solids):
    study, written = study_of(tmp_path)
    out = tmp_path / "out"
    assert export.export_designs(study, out) == []
    assert written == ["cases"]
    best = (9, 2, 7)
    assert names(out) == sorted(
        ["results.csv", *(f"design_{n}.{end}" for n in best for end in ("step", "toml"))]
    )
    for number in best:
        case = Case.load(out / f"design_{number}.toml")
        assert case.name == f"wide, design {number}"
        assert case.value("motion.speed") == pytest.approx(0.1 * number)
    assert solids == [[f"solid sole of wide, design {n}", f"design_{n}.step"] for n in best]
    with pytest.raises(InputError):
        export.export_designs(study, out)
    export.export_designs(study, out, count=1, step=False, overwrite=True)
    assert names(out) == ["design_9.toml", "results.csv"]


def test_without_goals_the_first_are_written(tmp_path, solids):
    study, _ = study_of(tmp_path, goals=())
    (study.store.folder / "results.parquet").write_text("another")
    export.export_designs(study, tmp_path / "out", count=2)
    assert names(tmp_path / "out") == [
        "design_4.step", "design_4.toml", "design_7.step", "design_7.toml", "results.csv",
        "results.parquet",
    ]  # fmt: skip


def test_walls_with_a_draft_stand_in_a_mesh_beside(tmp_path, solids, monkeypatch):
    study, _ = study_of(tmp_path)
    tread = SimpleNamespace(mould_draft=0.1)
    case: Any = SimpleNamespace(
        name="free", shoe=SimpleNamespace(tread=tread), save=lambda path: path.write_text("case")
    )
    study.plan.base = SimpleNamespace(replace=lambda changes: case)
    export.export_designs(study, tmp_path / "out", count=1)
    assert solids == [["solid sole of free", "design_9.step"],
                      ["solid sole of free", 0.1, "design_9.stl"]]  # fmt: skip


@pytest.mark.parametrize(
    "error",
    [InputError("from a file", where="shoe.outsole"), MissingExtraError("x", "cad", "STEP")],
)
def test_a_sole_that_is_no_solid_is_told(tmp_path, solids, monkeypatch, error):
    study, _ = study_of(tmp_path)

    def refused(shape):
        raise error

    monkeypatch.setattr(parametric, "sole_solid", refused)
    remarks = export.export_designs(study, tmp_path / "out", count=2)
    assert remarks == [f"design_{n}.step was not written: {error}" for n in (9, 2)]
    assert names(tmp_path / "out") == ["design_2.toml", "design_9.toml", "results.csv"]
