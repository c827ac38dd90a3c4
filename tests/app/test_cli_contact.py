"""The command ``contact``: what a user types, reads and gets told."""

import json
from dataclasses import replace

import numpy as np
import pytest
import typer
from typer.testing import CliRunner

from underfoot.cli.contact import contact
from underfoot.cli.guard import guard_command
from underfoot.core import Status
from underfoot.surface import self_affine

APP = typer.Typer(pretty_exceptions_enable=False)
APP.command()(guard_command(contact))
RANDOM = ["--rms", "4 um", "--points", "64"]


def run(*arguments):
    return CliRunner().invoke(APP, list(arguments))


def test_random_surface_as_json():
    found = run(*RANDOM, "--modulus", "5 MPa", "--pressure", "100 kPa", "--json")
    assert found.exit_code == 0, found.output
    content = json.loads(found.stdout)
    assert 0.05 < content["real_contact_fraction"] < 0.9
    assert content["cof_hysteresis"] == 0.0
    assert content["pressure_Pa"] == pytest.approx(1e5)
    assert content["rms_height_m"] == pytest.approx(4e-6)
    assert content["shortest_wave_m"] == pytest.approx(1.25e-4)


def test_table_and_files(tmp_path):
    out = tmp_path / "result"
    toml = tmp_path / "rubber.toml"
    toml.write_text(
        'modulus = "young"\nequilibrium_modulus = "2 MPa"\n'
        '[[term]]\nrelaxation_time = "1 us"\nmodulus = "3 MPa"\n'
        '[[term]]\nrelaxation_time = "0.1 ms"\nmodulus = "1.5 MPa"\n',
        encoding="utf-8",
    )
    given = (*RANDOM, "--spectrum", str(toml), "--speed", "0.3 m/s", "--out", str(out))
    found = run(*given)
    assert found.exit_code == 0, found.output
    assert "Real contact fraction" in found.output
    assert "0.3 m/s" in found.output
    assert {path.name for path in out.glob("[!.]*")} == {
        "contact.json",
        "contact.npz",
        "contact.png",
        "report.html",
    }
    assert (out / "contact.png").read_bytes().startswith(b"\x89PNG")
    content = json.loads((out / "contact.json").read_text(encoding="utf-8"))
    assert content["cof_hysteresis"] > 1e-3
    with np.load(out / "contact.npz") as arrays:
        assert arrays["pressure"].mean() == pytest.approx(160e3, rel=1e-6)
    refused = run(*given)
    assert refused.exit_code == 2
    assert "--overwrite" in refused.stderr


def test_checkerboard_of_the_reports_material_says_why_there_is_no_hysteresis():
    found = run(
        "--checkerboard", "24.3 um", "0.4 mm", "--material", "neolite", "--speed", "0.5 m/s",
        "--points", "48", "--json",
    )  # fmt: skip
    content = json.loads(found.stdout)
    assert abs(content["cof_hysteresis"]) < 1e-4
    assert any("loss tangent" in note for note in content["notes"])


def test_cutoffs_are_listed():
    found = run(*RANDOM, "--longest", "1 mm", "--shore", "60", "--cutoffs", "--pressure", "50 kPa")
    assert found.exit_code == 0, found.output
    assert "halving it would change the contact fraction" in " ".join(found.output.split())


def test_measured_map_is_mirrored_and_says_so(tmp_path):
    heights = self_affine(32, 1e-5, 3e-6, 0.8, 3.2e-4, 8e-5, seed=1).heights[:24, :20]
    x, y = np.meshgrid(np.arange(24) * 10.0, np.arange(20) * 10.0, indexing="ij")
    file = tmp_path / "floor.csv"
    rows = np.column_stack([x.ravel(), y.ravel(), heights.ravel() * 1e6])
    text = "x (um),y (um),z (um)\n" + "\n".join(",".join(f"{v:.6g}" for v in row) for row in rows)
    file.write_text(text, encoding="utf-8")
    found = run(str(file), "--modulus", "5 MPa", "--json")
    assert found.exit_code == 0, found.output
    content = json.loads(found.stdout)
    assert content["grid"] == [48, 40]
    assert any("mirrored" in note for note in content["notes"])


def test_measured_profile_becomes_a_surface_with_its_spectrum(tmp_path):
    line = self_affine(1024, 2e-6, 3e-6, 0.8, 1e-3, 2e-5, seed=1).heights[:, 0]
    file = tmp_path / "floor.csv"
    text = "x (um),z (um)\n" + "\n".join(f"{2.0 * n:.6g},{z * 1e6:.6g}" for n, z in enumerate(line))
    file.write_text(text, encoding="utf-8")
    found = run(str(file), "--modulus", "5 MPa", "--points", "64", "--json")
    assert found.exit_code == 0, found.output
    content = json.loads(found.stdout)
    assert content["grid"] == [64, 64]
    assert any("isotropy assumed" in note for note in content["notes"])
    assert any("the levelled profile has" in note for note in content["notes"])
    assert 0.3e-6 < content["rms_height_m"] < 10e-6


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--modulus", "5 MPa"], "no surface"),
        (RANDOM, "no rubber"),
        ([*RANDOM, "--modulus", "5 MPa", "--shore", "60"], "together"),
        ([*RANDOM, "--checkerboard", "1 um", "1 mm", "--shore", "60"], "together"),
        ([*RANDOM, "--modulus", "5"], "has no unit"),
        ([*RANDOM, "--modulus", "5 MPa", "--pressure", "160 kPq"], "unknown unit"),
        ([*RANDOM, "--modulus", "5 MPa", "--pressure", "-1 kPa"], "pressure"),
        ([*RANDOM, "--material", "neolit"], 'Did you mean "neolite"'),
        (["absent.csv", "--modulus", "5 MPa"], "no such file"),
        (["--rms", "4 um", "--points", "4", "--modulus", "5 MPa"], "--points"),
    ],
)
def test_mistakes_are_told_in_words(arguments, said):
    found = run(*arguments)
    assert found.exit_code in (2, 3)
    assert said in found.stderr
    assert "Traceback" not in found.output


def test_a_file_that_is_no_spectrum(tmp_path):
    wrong = tmp_path / "rubber.csv"
    wrong.write_text("a,b\n1,2\n", encoding="utf-8")
    found = run(*RANDOM, "--spectrum", str(wrong))
    assert found.exit_code == 3
    assert "neither" in found.stderr


def test_what_did_not_converge_is_no_number(monkeypatch, tmp_path):
    import underfoot.questions.contact as command

    honest = command.solve_contact

    def failing(*arguments):
        found, flow = honest(*arguments)
        return replace(found, status=Status.NOT_CONVERGED), flow

    monkeypatch.setattr(command, "solve_contact", failing)
    out = tmp_path / "result"
    found = run(*RANDOM, "--modulus", "5 MPa", "--json", "--out", str(out))
    assert found.exit_code == 4
    content = json.loads(found.stdout)
    assert content["real_contact_fraction"] is None
    assert content["status"] == "not converged"
    assert sorted(path.name for path in out.glob("[!.]*")) == ["contact.json", "report.html"]
