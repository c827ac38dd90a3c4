"""``underfoot micro`` and ``underfoot studies`` as a user types them."""

import json

import pytest
from typer.testing import CliRunner

from underfoot.block import MicroBlock
from underfoot.block.command_input import TEMPLATE, micro_case
from underfoot.cli.app import app
from underfoot.core import silent

SMALL = """
name = "small"
[block]
size = ["0.4 mm", "0.4 mm", "0.4 mm"]
elements = [10, 10, 5]
sides = "periodic"
[block.roughness]
peak_to_valley = "0 um"
[floor]
peak_to_valley = "24.3 um"
wavelength = "0.4 mm"
[material]
power_law = { shear_modulus = "0.44 MPa", exponent = 0.12 }
[loading]
speeds = ["0.5 m/s"]
slide_distance = "0.8 mm"
control = "load"
"""


@pytest.fixture
def run():
    def typed(*words):
        return CliRunner().invoke(app, [str(word) for word in words])

    return typed


@pytest.fixture
def small(tmp_path):
    path = tmp_path / "small.toml"
    path.write_text(SMALL, encoding="utf-8")
    return path


def test_a_case_is_run_and_written(run, small, tmp_path):
    done = run("micro", small, "--out", tmp_path / "out", "--json")
    assert done.exit_code == 0, done.output
    content = json.loads(done.stdout)
    row = content["results"][0]
    assert row["status"] == "converged"
    assert row["mean_pressure"] == pytest.approx(160e3, rel=1e-9)
    assert 0.005 < row["cof_hysteresis"] < 0.05
    assert content["assumed"]  # the power law is no measurement
    names = {path.name for path in (tmp_path / "out").glob("[!.]*")}
    assert names == {"micro.json", "history_0.5.csv", "history.png"}


def test_the_template_is_a_case_with_the_defaults(run, tmp_path):
    assert run("micro", "--template").stdout == TEMPLATE
    path = tmp_path / "block.toml"
    path.write_text(TEMPLATE, encoding="utf-8")
    written = micro_case(path)
    path.write_text('[material]\nreport = "rubber"\n', encoding="utf-8")
    default = micro_case(path)
    for name in ("size", "elements", "bottom_layer", "roughness_layers", "sides"):
        assert getattr(written.block, name) == getattr(default.block, name)
    assert written.loading == default.loading
    assert written.speeds == default.speeds
    assert written.material.bulk_modulus == default.material.bulk_modulus
    assert written.block.size == MicroBlock().size
    assert written.block.elements == MicroBlock().elements
    path.write_text('[block.roughness]\npeak_to_valley = "10 um"\n', encoding="utf-8")
    partly = micro_case(path).block.roughness
    assert (partly.peak_to_valley, partly.wavelength) == (10e-6, 0.5e-3)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('wavelength = "0.4 mm"', 'wavelength = "4 mm"', "wavelength of 0.004 m on a block"),
        ("elements = [10, 10, 5]", "elements = [3, 3, 5]", "elements a wavelength"),
        ("speeds", "speed", 'Did you mean "speeds"'),
        ('"24.3 um"', "24.3", "unit"),
        ("power_law", "#", "no relaxation data"),
        ('sides = "periodic"', 'sides = "open"', "sides"),
        ("[material]", "[material]\npoisson_ratio = 0.5", "Poisson's ratio 0.5"),
        ('control = "load"', 'control = "force"', "unknown control"),
        ('name = "small"', "name = small", "no TOML"),
        (", exponent = 0.12", "", "power_law"),
    ],
)
def test_bad_cases_are_refused_in_words(run, small, old, new, words):
    assert old in SMALL
    small.write_text(SMALL.replace(old, new), encoding="utf-8")
    done = run("micro", small)
    assert done.exit_code == 2, done.output
    assert words in done.output


def test_no_case_says_how_to_start(run):
    done = run("micro")
    assert done.exit_code == 2
    assert "--template" in done.output


def test_studies_are_listed_and_unknown_ones_refused(run):
    assert "g1" in run("studies", "list").stdout
    done = run("studies", "run", "h9")
    assert done.exit_code == 2
    assert "unknown study" in done.output


@pytest.mark.slow
def test_a_study_prints_each_line_with_its_verdict(run):
    done = run("studies", "run", "g1", "--quick", "--series", "broad")
    assert done.exit_code == 0, done.output
    for words in ("rougher floor", "verdict   undecided", "Not taken as printed", "wavelengths"):
        assert words in done.stdout


EXPLICIT = (
    SMALL.replace('speeds = ["0.5 m/s"]', 'speeds = ["1 m/s"]')
    .replace(
        'power_law = { shear_modulus = "0.44 MPa", exponent = 0.12 }',
        'report = "rubber"\npoisson_ratio = 0.45',
    )
    .replace('"0.8 mm"', '"0.2 mm"')
    + 'press_time = "0.2 ms"\nhold_time = "0.1 ms"\n'
)


@pytest.mark.slow
def test_an_explicit_run_goes_on_where_it_was_stopped(run, small, tmp_path, monkeypatch):
    monkeypatch.setenv("UNDERFOOT_CACHE", str(tmp_path / "cache"))
    small.write_text(EXPLICIT, encoding="utf-8")
    case = micro_case(small, solver="explicit")
    stages = []

    def stopped(stage, fraction, residual=None):
        if stage == "slide" and fraction > 0.5:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        case.result(1.0, stopped, snapshots=4)
    rest = case.result(
        1.0,
        lambda stage, fraction, residual=None: stages.append(stage),
        snapshots=4,
        folder=tmp_path / "vtu",
    )
    assert set(stages) == {"slide"}  # neither pressed nor held again
    names = sorted(path.name for path in (tmp_path / "vtu").iterdir())
    assert names == ["block.pvd", *(f"block_{n:04d}.vtu" for n in range(1, 5))]
    whole = case.result(1.0, silent)
    assert (whole.shear_force == rest.shear_force).all()
    assert not list((tmp_path / "cache" / "micro").iterdir())
    done = run("micro", small, "--snapshots", "2")
    assert done.exit_code == 2
    assert "--solver explicit" in done.output


def test_finite_strain_and_settings_of_the_elements_come_from_the_case(small):
    small.write_text(
        "finite_strain = true\n" + SMALL + '[explicit]\nhourglass = "viscous"\n', encoding="utf-8"
    )
    case = micro_case(small)
    assert case.finite_strain
    assert case.settings is not None
    assert case.settings.hourglass == "viscous"
    assert "finite compression" in case.describe_case()[0]
