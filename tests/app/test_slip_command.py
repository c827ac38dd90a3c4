"""``underfoot slip`` as a person uses it."""

import csv
import json
from pathlib import Path

import pytest

from commands import called

EXAMPLES = Path(__file__).parents[2] / "examples"
DRY = EXAMPLES / "work_shoe_full_tread_dry.toml"
WET = EXAMPLES / "human_slip_untreaded.toml"


@pytest.fixture(autouse=True)
def _own_cache(tmp_path, monkeypatch):
    monkeypatch.setenv("UNDERFOOT_CACHE", str(tmp_path))


def slip(*arguments, check=True):
    found = called("slip", *arguments, "--set", "numerics.tread_positions=1")
    if check:
        assert found.returncode == 0, found.stderr
    return found


def test_a_dry_floor_needs_no_film(tmp_path):
    out = tmp_path / "out"
    found = slip(DRY, "--subjects", 12, "--out", out)
    assert "of simulated steps slip" in found.stdout
    assert "run and risk answer" in " ".join(found.stdout.split())
    assert "The case has no fluid" in found.stdout
    assert "± 0.00" not in found.stdout
    rows = list(csv.DictReader((out / "subjects.csv").read_text().splitlines()))
    assert len(rows) == 12
    assert {row["outcome"] for row in rows} == {"no slip"}
    page = (out / "report.html").read_text()
    assert "http" not in page.replace("http://www.w3.org", "")
    assert {p.name for p in out.iterdir()} >= {"slip.png", "motion.csv", "slip.json"}


def test_a_slippery_dry_floor_slips(tmp_path):
    found = slip(
        DRY, "--json", "--subjects", 20, "--set", "interface.constant_cof=0.05",
    )  # fmt: skip
    data = json.loads(found.stdout)
    assert data["numbers"]["slipped"] > 0.9
    by_mass = data["peak_speed_by_effective_mass"]
    assert by_mass["0.06"] > by_mass["0.114"] > by_mass["0.17"]


def test_one_person_has_no_band(tmp_path):
    data = json.loads(slip(DRY, "--json", "--subjects", 1).stdout)
    assert "no interval" in data["headline"][1]
    assert data["numbers"]["peak_speed_sd"] is None
    assert data["numbers"]["slipped_low"] is None


def test_rcof_from_measurements_replaces_the_case_s(tmp_path):
    table = tmp_path / "measurements.csv"
    table.write_text("file,item,quantity,value,unit\na,1,rcof,0.25,1\nb,1,rcof,0.35,1\nb,2,x,9,1\n")
    arguments = ("--json", "--subjects", 3, "--rcof-from", table)
    data = json.loads(slip(DRY, *arguments).stdout)
    assert any("RCOF 0.3 ± 0.071" in line for line in data["remarks"]["Assumptions"])


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (("--set", "slip.mass_mean=-70 kg"), "slip.mass_mean"),
        (("--set", "risk.rcof_mean=1.5"), "risk.rcof_mean"),
        (("--set", "slip.landing_from=50 mm"), "landing_from"),
        (("--set", "slip.subject=3"), "slip.subject"),
        (("--history", "no_such_file.c3d"), "no_such_file"),
        (("--rcof-from", "no_such_file.csv"), "no_such_file"),
    ],
)
def test_bad_input_is_said(tmp_path, arguments, says):
    found = slip(DRY, *arguments, check=False)
    assert found.returncode not in (0, 70)
    assert says in found.stderr
    assert "Traceback" not in found.stderr


def test_a_history_that_ends_before_the_slip_is_flagged(tmp_path):
    table = tmp_path / "short.csv"
    rows = "\n".join(f"{0.01 * i},1.0,0.25" for i in range(12))
    table.write_text(f"time_s,normal_per_body_weight,shear_ratio\n{rows}\n")
    data = json.loads(
        slip(
            DRY, "--json", "--subjects", 4, "--history", table,
            "--set", "interface.constant_cof=0.02",
        ).stdout
    )  # fmt: skip
    assert any("lower bounds" in line for line in data["cautions"])


@pytest.mark.slow
def test_an_untreaded_sole_in_glycerol_slips_and_the_run_is_kept(tmp_path):
    arguments = (
        "--json", "--subjects", 10, "--set", "slip.fit_runs=4", "--set", "slip.test_runs=1",
        "--set", "slip.time_step=20 ms", "--set", "numerics.quick_grid_spacing=2.5 mm",
        "--set", "numerics.cells_along=1", "--set", "numerics.tread_positions=1",
    )  # fmt: skip
    first = json.loads(slip(WET, *arguments).stdout)
    assert first["numbers"]["slipped"] == 1.0
    assert first["numbers"]["peak_speed"] > 1.0
    assert first["numbers"]["peak_pressure"] > 20e3
    kept = sorted(p.name for p in tmp_path.glob("slip-*/*.npz"))
    again = json.loads(slip(WET, *arguments).stdout)
    assert sorted(p.name for p in tmp_path.glob("slip-*/*.npz")) == kept
    assert again["numbers"] == first["numbers"]
