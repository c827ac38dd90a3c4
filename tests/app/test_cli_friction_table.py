"""A law of trials, a table beside a case: from file to friction, and what is refused."""

import json
import shutil
from pathlib import Path

import numpy as np
import openpyxl
import pytest
from typer.testing import CliRunner

from underfoot.calibrate import law_file_text, law_table, trial_readings
from underfoot.case import Case
from underfoot.cli.app import app
from underfoot.compute.resolve import resolve_context
from underfoot.core import DataError, InputError
from underfoot.friction import stribeck_cof

EXAMPLE = Path(__file__).parents[2] / "examples" / "work_shoe_half_tread_detergent.toml"
TABLE = "# source: our rig, 3 May\nspeed (cm/s),COF,sd\n5,0.5,0.03\n50,0.3,0.02\n100,0.2,0.02\n"


def called(*words):
    return CliRunner().invoke(app, [str(word) for word in words])


@pytest.fixture
def folder(tmp_path):
    shutil.copy(EXAMPLE, tmp_path / "case.toml")
    (tmp_path / "law.csv").write_text(TABLE)
    return tmp_path


def loaded(folder, **settings):
    given = {"models.friction": "table", "interface.friction_table": "law.csv"}
    return Case.load(folder / "case.toml", settings=given | settings)


def test_the_table_beside_a_case_becomes_its_law(folder):
    case = loaded(folder)
    law = case.friction.build(resolve_context(case))
    assert law.source == "our rig, 3 May"
    assert law(1e5, [0.05, 0.5, 1.0], 1.0).adhesion == pytest.approx([5e4, 3e4, 2e4])
    assert [one.quantity for one in law.breaches(contact_pressure=1e5, speed=2.0, film_thickness=1)]


def test_a_complete_case_holds_the_readings_and_needs_no_file(folder):
    case = loaded(folder)
    alone = Case.from_text(case.to_toml(complete=True))
    assert alone == case
    assert len(alone.friction.readings) == 3
    (folder / "law.csv").write_text(TABLE.replace("0.5,0.03", "0.4,0.03"))
    assert loaded(folder) != case  # the hash follows what the file holds


@pytest.mark.parametrize(("head", "cof"), [(("speed", "cof"), None), (("fluid", "amount"), 0.5)])
def test_of_two_tables_in_a_workbook_none_is_taken_without_a_word(folder, head, cof):
    """The readings on the dry floor, on the first sheet, were taken for those of the wet one."""
    book = openpyxl.Workbook(write_only=True)
    for name, heads, first in (("wet", head, 0.1), ("dry", ("speed", "cof"), 0.5)):
        sheet = book.create_sheet(name)
        for row in (heads, (0.1, first), (0.3, first), (1.0, first)):
            sheet.append(row)
    book.save(folder / "law.xlsx")
    given = {"interface.friction_table": "law.xlsx"}
    if cof is None:
        with pytest.raises(InputError, match="wet, dry"):
            loaded(folder, **given)
    else:
        case = loaded(folder, **given)
        law = case.friction.build(resolve_context(case))
        assert float(law(1.0, 0.3, 1.0).adhesion) == pytest.approx(cof)


def test_a_table_read_under_another_fluid_counts_at_equal_viscosity_times_speed(folder):
    text = "speed,cof,viscosity (cP)\n0.1,0.5,3.78\n0.2,0.4,3.78\n"
    (folder / "law.csv").write_text(text)
    case = loaded(folder)
    law = case.friction.build(resolve_context(case))  # detergent of 1.89 cP
    assert law(1.0, [0.2, 0.4], 1.0).adhesion == pytest.approx([0.5, 0.4])
    assert any("viscosity x speed" in note for note in law.assumptions)


def test_a_dry_case_takes_a_table(folder):
    case = loaded(folder, contaminant="none")
    law = case.friction.build(resolve_context(case))
    assert float(law(1.0, 0.05, 1.0).total) == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("speed,friction\n1,2\n3,4\n", 'no column "cof"'),
        ("speed (kg),cof\n1,0.2\n3,0.4\n", "kg"),
        ("speed,cof,sd (%)\n1,0.2,5\n3,0.4,5\n", '"%" is no unit of sd'),
        ("speed,cof\n0.1,0.5\n0.2,-0.4\n", "row 2"),
        ("speed,cof\n0.1,0.5\n0.2,\n", "missing"),
        ("speed,cof\n0.1,0.5\n0.1,0.4\n", "two or more speeds"),
    ],
)
def test_bad_tables_are_refused_with_the_row(folder, text, word):
    (folder / "law.csv").write_text(text)
    found = called(
        "check", folder / "case.toml",
        "--set", "models.friction=table", "--set", "interface.friction_table=law.csv",
    )  # fmt: skip
    assert found.exit_code == 2
    assert word in found.stderr


@pytest.mark.parametrize("name", ["viscosity", "sd"])
def test_what_some_readings_lack_is_asked(folder, name):
    """Viscosities of three readings counted for nothing where the fourth had none."""
    value = {"viscosity": "50 cP", "sd": 0.02}[name]
    readings = [{"speed": f"{v} m/s", "cof": 0.2, name: value} for v in (0.1, 0.3, 1)]
    case = Case.load(folder / "case.toml")
    lacking = [*readings[:2], {key: readings[2][key] for key in ("speed", "cof")}]
    with pytest.raises(InputError, match=rf"friction.readings 3.{name}: is missing, other"):
        case.replace({"friction": {"model": "table", "readings": lacking}})
    case.replace({"friction": {"model": "table", "readings": readings}})


def test_a_missing_table_names_the_nearest(folder):
    found = called(
        "check", folder / "case.toml",
        "--set", "models.friction=table", "--set", "interface.friction_table=lav.csv",
    )  # fmt: skip
    assert found.exit_code == 2
    assert 'Did you mean "law.csv"?' in found.stderr


@pytest.fixture
def analysed(tmp_path):
    """Analysed trials of two fluids: one falls with speed as Eq. 17, one does not."""
    rng = np.random.default_rng(5)
    lines = ["file,verdict,COF,speed (m/s),fluid,viscosity,reasons"]
    for speed in np.linspace(0.05, 1.0, 11):
        for run in range(4):
            falling = stribeck_cof(speed, 0.5, 0.2, 0.1) + rng.normal(0.0, 0.01)
            flat = 0.1 + rng.normal(0.0, 0.01)
            lines.append(f"a{run},accepted,{falling:.6f},{speed:.4f},thin,0.0055,")
            lines.append(f"b{run},accepted,{flat:.6f},{speed:.4f},thick,0.0746,")
    lines.append("a9,refused,3.0,0.5,thin,0.0055,no load")
    (tmp_path / "done" / "tables").mkdir(parents=True)
    (tmp_path / "done" / "tables" / "files.csv").write_text("\n".join(lines) + "\n")
    return tmp_path / "done"


def test_a_law_of_trials_holds_truth_and_scatter(analysed):
    table = law_table(trial_readings(analysed, {"fluid": "thin"}))
    truth = stribeck_cof(table.speed, 0.5, 0.2, 0.1)
    assert np.abs(table.cof - truth).max() < 0.02
    assert table.deviation == pytest.approx(np.full(table.speed.size, 0.0105), abs=0.003)
    assert any("1 refused" in note for note in table.notes)
    assert table.viscosity == pytest.approx(5.5e-3)
    text = law_file_text(table, pressure=266.1e3)
    assert text.startswith("# source: trials analysed in done, fluid = thin; fit of Eq. 17")


def test_from_trials_to_the_friction_of_a_case(analysed, folder):
    out = folder / "thin.csv"
    made = called("calibrate", "law", analysed, "--where", "fluid=thin", "--out", out)
    assert made.exit_code == 0, made.output
    shown = called(
        "stribeck", folder / "case.toml", "--json",
        "--set", "models.friction=table", "--set", "interface.friction_table=thin.csv",
        "--set", "contaminant.viscosity=5.5 cP",
    )  # fmt: skip
    assert shown.exit_code == 0, shown.output
    rows = json.loads(shown.stdout)["curves"][0]["rows"]
    for row in rows:
        if 0.05 <= row["speed_m_per_s"] <= 1.0:
            truth = stribeck_cof(row["speed_m_per_s"], 0.5, 0.2, 0.1)
            assert row["cof"] - row["viscous"] == pytest.approx(truth, abs=0.02)
            assert row["cof_low_95"] - 0.01 < truth < row["cof_high_95"] + 0.01


@pytest.mark.parametrize(
    ("words", "word"),
    [
        ((), "--where fluid="),
        (("--where", "fluid=thn"), 'Did you mean "thin"?'),
        (("--where", "flud=thin"), 'Did you mean "fluid"?'),
        (("--where", "thin"), "CONDITION=VALUE"),
        (("--where", "fluid=thin", "--where", "fluid=thick"), "fluid is chosen twice"),
        (("--where", "fluid=thick"), "--form readings"),
        (("--where", "fluid=thin", "--form", "fitt"), 'Did you mean "fit"?'),
        (("--where", "fluid=thin", "--pressure", "0 kPa"), "above 0"),
    ],
)
def test_bad_requests_say_what_to_do(analysed, tmp_path, words, word):
    found = called("calibrate", "law", analysed, "--out", tmp_path / "x.csv", *words)
    assert found.exit_code != 0
    assert word in found.stderr
    assert not (tmp_path / "x.csv").exists()


def test_what_is_no_analysis_is_refused(tmp_path):
    found = called("calibrate", "law", tmp_path, "--out", tmp_path / "x.csv")
    assert found.exit_code == 2
    assert "trials analyse" in found.stderr


def test_means_need_repeats(analysed):
    readings = trial_readings(analysed, {"fluid": "thick"})
    assert law_table(readings, form="readings").cof == pytest.approx(np.full(11, 0.1), abs=0.02)
    path = analysed / "tables" / "files.csv"
    once = [
        line for line in path.read_text().splitlines() if not line.startswith(("a", "b1", "b2"))
    ]
    path.write_text("\n".join(line for line in once if not line.startswith("b3")) + "\n")
    with pytest.raises(DataError, match="read once"):
        law_table(trial_readings(analysed), form="readings")
