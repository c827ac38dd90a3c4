"""Report G.1 against our run of its matrix; the printed ranges are the statements'."""

import numpy as np
import pytest

from underfoot.studies import ComputedQuantity, Options, judge_study, study
from underfoot.studies.g1 import Settings, changes, matrix, outcomes, series_quantities

pytestmark = pytest.mark.slow
QUICK = Settings().quick


@pytest.fixture(scope="module")
def rows():
    return [row for row, _ in outcomes(list(matrix(QUICK)), QUICK)]


@pytest.fixture(scope="module")
def found(rows):
    values = {}
    for name in ("report", "broad"):
        values |= series_quantities(name, [(1e-3, rows)])
    return values


def test_every_case_gives_a_result(rows):
    assert len(rows) == 2 * 2 * 2 * 3 * 2  # series, materials, shoes, floors, speeds
    assert {row.status for row in rows} == {"converged"}
    pressures = [row.mean_pressure for row in rows]
    assert 100e3 < min(pressures) <= max(pressures) < 200e3


def test_the_reports_parameters_have_no_hysteresis(rows, found):
    mine = [row for row in rows if row.series == "report"]
    assert max(abs(row.cof_hysteresis) for row in mine) < 1e-4
    assert max(row.cof_absolute for row in mine) > 0.02
    missing = [q for name, q in found.items() if name.startswith("report.hysteresis.s")]
    assert missing
    assert all("no hysteresis" in q.missing and not q.unconverged for q in missing)


def test_contact_area_follows_roughness_without_any_loss(found):
    """Signs and rough sizes of G.1.2 on the coarse mesh: +-10 points, what meshes differ by."""
    for path, low, high in (
        ("shoe_rz.neolite", -0.36, -0.26),
        ("shoe_rz.rubber", -0.18, -0.14),
        ("floor_rz.rubber", -0.21, -0.17),
    ):
        values = found[f"report.area.{path}"].values
        assert low - 0.1 < min(values) <= max(values) < high + 0.1
    for material in ("neolite", "rubber"):  # a frozen term has no effect of speed
        assert np.abs(found[f"report.area.speed.{material}"].values).max() < 0.005


def test_a_broad_spectrum_gives_the_printed_fall_of_area_with_speed(found):
    assert min(found["broad.area.speed.neolite"].values) > -0.295
    assert max(found["broad.area.speed.neolite"].values) < -0.155
    assert min(found["broad.area.speed.rubber"].values) > -0.255
    assert max(found["broad.area.speed.rubber"].values) < -0.115
    assert min(found["broad.experiment.hysteresis.floor_rz"].values) > 0.3


def test_one_mesh_has_the_known_error_of_a_quick_grid(found):
    """What a mesh enters is judged on two; within the error of one alone it does not agree."""
    values = found | {"broad.hysteresis.largest": ComputedQuantity.of(0.02, levels=[(1e-3, 0.02)])}
    verdicts = {
        one.statement.id: str(one.verdict) for one in judge_study(study("g1").statements, values)
    }
    assert verdicts["area_shoe_neolite"] in {"overlaps", "undecided", "not converged"}
    assert verdicts["hysteresis_shoe_neolite"] == "not comparable"


def test_changes_pair_the_right_cases(rows):
    some = [row for row in rows if row.series == "broad" and row.material == "rubber"]
    by = {(row.shoe_rz, row.floor_rz): row.area_per_force for row in some if row.speed == 0.1}
    assert changes(some, "area_per_force", "floor_rz", speed=0.1) == pytest.approx(
        [by[shoe, 35.1e-6] / by[shoe, 16.6e-6] - 1.0 for shoe in (12.1e-6, 35.1e-6)]
    )


def test_the_folder_holds_figures_and_tables(tmp_path, monkeypatch):
    import json

    from underfoot.report.studies_page import write_study
    from underfoot.studies import PublishedStudyResult, run_study

    monkeypatch.setenv("UNDERFOOT_CACHE", str(tmp_path / "cache"))
    options = Options(quick=True, settings=Settings(series=("broad",)))
    result = run_study(study("g1"), options)
    folder = tmp_path / "g1"
    folder.mkdir()
    write_study(result, folder)
    names = {path.name for path in folder.iterdir()}
    for number in ("03", "05", "06", "07", "08", "10", "11"):
        assert any(name.startswith(f"fig{number}") and name.endswith(".png") for name in names)
    assert {"study.json", "verdicts.csv", "cases.csv", "errata.csv", "fig03_history.csv"} <= names
    content = json.loads((folder / "study.json").read_text(encoding="utf-8"))
    again = PublishedStudyResult.from_dict(content)
    assert [j.to_dict() for j in again.judgements] == [j.to_dict() for j in result.judgements]
    kept = run_study(study("g1"), options)  # from the cache, with its figures
    assert kept.seconds == result.seconds
    assert set(kept.computed.figures) == set(result.computed.figures)
