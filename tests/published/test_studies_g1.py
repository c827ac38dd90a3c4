"""Report G.1 against our run of its matrix; the printed ranges come from the catalogue."""

import json

import numpy as np
import pytest

from underfoot.core.catalogue import Catalogue
from underfoot.studies.g1 import ERRATA, run
from underfoot.studies.g1_cases import G1Settings, changes
from underfoot.studies.g1_lines import AREA, HYSTERESIS
from underfoot.studies.verdict import Verdict

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def study():
    return run(G1Settings().quick)


def lines(study, series, quantity):
    return {
        line.condition: line
        for line in study.lines
        if line.series == series and line.quantity == quantity
    }


def test_every_case_gives_a_result(study):
    assert len(study.rows) == 2 * 2 * 2 * 3 * 2  # series, materials, shoes, floors, speeds
    assert {row.status for row in study.rows} == {"converged"}
    pressures = [row.mean_pressure for row in study.rows]
    assert 100e3 < min(pressures) <= max(pressures) < 200e3


def test_the_report_s_parameters_have_no_hysteresis(study):
    mine = [row for row in study.rows if row.series == "report"]
    assert max(abs(row.cof_hysteresis) for row in mine) < 1e-4
    assert max(row.cof_absolute for row in mine) > 0.02
    found = lines(study, "report", HYSTERESIS)
    assert {line.verdict for line in found.values()} == {Verdict.NOT_AVAILABLE}
    assert all("loss tangent" in line.reason for line in found.values())


def test_contact_area_follows_roughness_without_any_loss(study):
    found = lines(study, "report", AREA)
    good = {Verdict.REPRODUCED, Verdict.WITHIN_SCATTER}
    for condition in ("neolite, rougher shoe", "rubber, rougher shoe", "rubber, rougher floor"):
        assert found[condition].verdict in good
    assert found["neolite, rougher floor"].verdict is Verdict.TREND_ONLY
    for material in ("neolite", "rubber"):  # a frozen term has no effect of speed
        line = found[f"{material}, 0.1 to 1 m/s"]
        assert np.abs(line.ours).max() < 0.005
        assert line.verdict is Verdict.DISAGREES


def test_a_broad_spectrum_gives_the_fall_of_area_with_speed(study):
    entry = Catalogue.load().entry("published", "micro_fe_g1")
    found = lines(study, "broad", AREA)
    for material in ("neolite", "rubber"):
        low, high = entry.numbers(f"contact_area_per_force_change.speed_up_{material}")
        line = found[f"{material}, 0.1 to 1 m/s"]
        assert line.printed == (low, high)
        assert low <= min(line.ours) <= max(line.ours) <= high
        assert line.verdict is Verdict.REPRODUCED


def test_a_broad_spectrum_gives_the_floor_s_effect_on_hysteresis(study):
    found = lines(study, "broad", HYSTERESIS)
    assert found["rubber, rougher floor"].verdict is Verdict.WITHIN_SCATTER
    assert found["experiment, rougher floor"].verdict is Verdict.REPRODUCED
    # friction that losses make, of the size that the loss tangent allows
    cofs = [row.cof_hysteresis for row in study.rows if row.series == "broad"]
    assert 0.004 < min(cofs) < max(cofs) < 0.03


def test_what_disagrees_is_said(study):
    found = lines(study, "broad", HYSTERESIS)
    assert found["rubber, rougher shoe"].verdict is Verdict.DISAGREES
    assert found["experiment, faster"].verdict is Verdict.DISAGREES
    assert all(line.reason for line in study.lines)
    assert {"G.1.1, wavelengths", "Table 2, bulk modulus of rubber"} <= {e.where for e in ERRATA}


def test_changes_pair_the_right_cases(study):
    some = [row for row in study.rows if row.series == "broad" and row.material == "rubber"]
    found = changes(some, "area_per_force", "floor_rz", speed=0.1)
    by = {(row.shoe_rz, row.floor_rz): row.area_per_force for row in some if row.speed == 0.1}
    assert found == pytest.approx(
        [by[shoe, 35.1e-6] / by[shoe, 16.6e-6] - 1.0 for shoe in (12.1e-6, 35.1e-6)]
    )


def test_the_folder_holds_figures_and_tables(study, tmp_path):
    from underfoot.cli.studies import write_study

    write_study(study, tmp_path)
    names = {path.name for path in tmp_path.iterdir()}
    for number in ("03", "05", "06", "07", "08", "10", "11"):
        assert any(name.startswith(f"fig{number}") and name.endswith(".png") for name in names)
    assert {"study.json", "verdicts.csv", "cases.csv", "errata.csv"} <= names
    content = json.loads((tmp_path / "study.json").read_text(encoding="utf-8"))
    assert len(content["rows"]) == len(study.rows)
    assert len(content["lines"]) == len(study.lines)
