"""``underfoot stribeck`` and ``underfoot studies run g2``/``g3`` as a user meets them."""

import csv
import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from underfoot.cli.app import app

EXAMPLES = Path(__file__).parents[2] / "examples"
CASE = str(EXAMPLES / "work_shoe_half_tread_detergent.toml")
RUNNER = CliRunner()


def called(*words):
    return RUNNER.invoke(app, list(words), catch_exceptions=False)


def test_one_table_and_one_figure_for_several_fluids(tmp_path):
    out = tmp_path / "st"
    found = called(
        "stribeck",
        CASE,
        "--law",
        "stribeck",
        "--fluid",
        "measured",
        "--fluid",
        "glycerol_90pct",
        "--out",
        str(out),
    )
    assert found.exit_code == 0, found.output
    assert (out / "stribeck.png").stat().st_size > 2e4
    with (out / "stribeck.csv").open(encoding="utf-8-sig") as stream:
        rows = list(csv.DictReader(stream))
    assert len({row["fluid"] for row in rows}) == 7
    for row in rows:
        parts = sum(float(row[name]) for name in ("adhesion", "hysteresis", "viscous"))
        assert float(row["cof"]) == pytest.approx(parts)
    published = [row for row in rows if row["fluid"] == "glycerol_25pct" and row["published_cof"]]
    assert len(published) == 11
    # the stribeck law is the published fit; what is above it is the fluid's own shear
    for row in published:
        assert float(row["cof"]) - float(row["viscous"]) == pytest.approx(
            float(row["published_cof"])
        )


@pytest.mark.parametrize("law", ["asperity_ehl", "mean_film_sharing", "boundary"])
def test_any_law_can_be_chosen(law):
    found = called("stribeck", CASE, "--law", law, "--json")
    assert found.exit_code == 0, found.output
    curve = json.loads(found.output)["curves"][0]
    assert curve["law"] == law
    cofs = [row["cof"] - row["viscous"] for row in curve["rows"]]
    assert cofs == sorted(cofs, reverse=True)
    assert curve["notes"]


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (("--fluid", "oliv_oil"), "canola_oil"),
        (("--law", "viscoelastic_area"), "relaxation spectrum"),
        (("--law", "bowden_tabor"), "shear_strength"),
        (("--slowest", "2 m/s"), "rising"),
        (("--pressure", "0 kPa"), "above 0"),
    ],
)
def test_bad_input_says_what_is_missing(words, text):
    found = RUNNER.invoke(app, ["stribeck", CASE, *words])
    assert found.exit_code == 2
    assert text in found.output + found.stderr


def test_a_relaxation_spectrum_makes_the_area_fall(tmp_path):
    relaxed = """relaxation.equilibrium_shear_modulus = "1 MPa"
relaxation.terms = [
    {shear_modulus = "1 MPa", time = "1e-3 s"},
    {shear_modulus = "1 MPa", time = "1e-5 s"},
]
"""
    text = Path(CASE).read_text()
    assert "[shoe.material]" not in text
    path = tmp_path / "case.toml"
    path.write_text(text + '\n[shoe.material]\nmodulus = "3 MPa"\n' + relaxed)
    found = called("stribeck", str(path), "--law", "viscoelastic_area", "--json")
    assert found.exit_code == 0, found.output
    rows = json.loads(found.output)["curves"][0]["rows"]
    assert rows[-1]["adhesion"] < 0.95 * rows[0]["adhesion"]


@pytest.mark.parametrize(
    "name", ["asperity_ehl", "bowden_tabor", "mean_film_sharing", "viscoelastic_area", "propagated"]
)
def test_every_law_explains_itself(name):
    found = called("explain", name)
    assert found.exit_code == 0
    assert len(found.output.splitlines()) <= 36  # one screen
    whole = called("explain", name, "--full").output
    assert "Parameters:\n    " in whole
    assert len(whole) > len(found.output)


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("StribeckLaw", "Eq. 17 of the report"),
        ("soft_ehl", "Eq. 18 of the report"),
        ("Eq. 17", "stribeck_cof"),
        ("eq 26", "AdhesionBlockingLaw"),
        ("film_pressure", "Eq. 4 of the report"),
        ("glycerol_water_density", "not in the report"),
        ("regime", "They can differ"),
    ],
)
def test_the_report_s_equations_are_named_and_found(name, text):
    found = called("explain", name)
    assert found.exit_code == 0
    assert text in found.output


def test_options_of_another_study_are_refused():
    found = RUNNER.invoke(app, ["studies", "run", "g3", "--explicit"])
    assert found.exit_code == 2


@pytest.mark.slow
def test_study_g2_draws_its_figures(tmp_path):
    out = tmp_path / "g2"
    found = RUNNER.invoke(app, ["studies", "run", "g2", "--quick", "--out", str(out)])
    assert found.exit_code == 0, found.output
    names = {path.name for path in out.iterdir()}
    assert {"fig16_master_curve.png", "blind_predictions.png", "blind_errors.png"} <= names
    with (out / "mechanisms.csv").open(encoding="utf-8-sig") as stream:
        assert len(list(csv.DictReader(stream))) == 9
