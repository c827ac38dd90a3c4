"""The commands within one process: what they print, what they refuse, what they leave alone."""

import functools
import json
import re
import tomllib
from pathlib import Path

import pytest
from typer.testing import CliRunner

from underfoot.case import Case
from underfoot.case.terms import TERMS
from underfoot.cli.app import app
from underfoot.cli.output import print_table, shorten_remark
from underfoot.compute.summary import ranked_assumptions
from underfoot.core import Remark
from underfoot.core.presentation import Table

EXAMPLES = Path(__file__).parents[2] / "examples"
EXAMPLE = EXAMPLES / "work_shoe_untreaded_glycerol.toml"


@pytest.fixture
def underfoot(monkeypatch, tmp_path):
    monkeypatch.delenv("UNDERFOOT_CATALOGUE", raising=False)
    monkeypatch.delenv("UNDERFOOT_DEBUG", raising=False)
    monkeypatch.chdir(tmp_path)

    def call(*arguments):
        return CliRunner().invoke(app, [str(argument) for argument in arguments])

    return call


@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.toml")), ids=lambda path: path.stem)
def test_every_example_checks_and_is_named_after_its_entries(underfoot, path):
    case = Case.load(path)
    if "_shoe_" in path.stem:  # the others are named after what they ask
        assert path.stem.startswith(case.entries["shoe"])
        assert path.stem.split("_")[-1] in {*"glycerol detergent dry".split()}
    shown = underfoot("check", path)
    assert shown.exit_code == 0
    assert case.name in shown.stdout


def test_the_examples_are_the_six_shoes_in_two_fluids_all_different():
    cases = [Case.load(path) for path in EXAMPLES.glob("*_shoe_*.toml")]
    wet = [case for case in cases if case.contaminant is not None]
    assert len(wet) == 12
    assert len({case.hash for case in cases}) == len(cases)
    assert {case.contaminant.viscosity for case in wet} == {0.219, 0.00189}


def test_check_prints_composition_assumptions_ranges_and_cost(underfoot):
    given = underfoot("check", EXAMPLE, "--set", "shoe.material.shore_a=97", "--all").stdout
    text = " ".join(given.split())
    assert "contaminant.viscosity 219 cP" in text
    assert "shoe.material.shore_a 97 given" in text
    assert "Assumptions (" in text
    assert "angle = 10 deg" in text
    assert "outside the tested range" in text
    cells = round(0.075 * 0.070 / 0.6e-3**2, -2)
    found = re.search(r"(\d+) cells under the sole, about \d+ to \d+ s and \d+ MB", text)
    assert found is not None
    assert int(found[1]) == pytest.approx(cells, rel=0.1)


def test_check_as_json_is_readable_by_programs(underfoot):
    content = json.loads(underfoot("check", EXAMPLE, "--json").stdout)
    assert content["hash"] == Case.load(EXAMPLE).hash
    values = {row["path"]: row["value"] for row in content["values"]}
    assert values["contaminant.viscosity"] == "219 cP"
    assert content["breaches"] == []


def test_set_takes_numbers_words_and_quantities(underfoot):
    found = underfoot(
        "check", EXAMPLE, "--json",
        "--set", "sensor.scans=5",
        "--set", "contaminant.viscosity = 41 cP",
        "--set", 'motion.speed="0.3 m/s"',
        "--set", "motion.steady=true",
        "--set", "models.hardness=ruess",
    )  # fmt: skip
    values = {row["path"]: row["value"] for row in json.loads(found.stdout)["values"]}
    assert values["sensor.scans"] == "5"
    assert values["contaminant.viscosity"] == "41 cP"
    assert values["motion.speed"] == "0.3 m/s"
    assert values["motion.steady"] == "yes"
    assert values["hardness.model"] == "ruess"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--set", "contaminant.viscosity"), "is not a setting"),
        (("--set", "contaminant.viscocity=1 cP"), 'Did you mean "contaminant.viscosity"'),
        (("--set", "contaminant.viscosity=41"), "viscosity (set for this run): 41 has no unit"),
        (("--set", "motion.speed=0 m/s"), "outside the physical range"),
        (("--set", "shoe=slipper"), 'unknown shoe "slipper"'),
        (("--set", "contaminant=water_g3"), 'Did you mean "water_g2"'),
        (("--catalogue", "nowhere"), "catalogue folder nowhere does not exist"),
    ],
)
def test_bad_settings_are_refused_with_exit_code_2(underfoot, arguments, message):
    found = underfoot("check", EXAMPLE, *arguments)
    assert found.exit_code == 2
    assert message in found.stderr
    assert found.stderr.startswith("error: ")
    assert "Traceback" not in found.stderr


def test_a_missing_file_is_refused(underfoot):
    found = underfoot("check", "nothing.toml")
    assert found.exit_code == 2
    assert "there is no file nothing.toml" in found.stderr


@pytest.mark.parametrize("command", ["check", "run"])
def test_a_folder_in_place_of_a_case_is_refused_in_words(underfoot, tmp_path, command):
    found = underfoot(command, tmp_path)
    assert found.exit_code == 2
    assert "is a folder" in found.stderr
    assert "rrno" not in found.stderr
    (tmp_path / "case.toml").write_text("")
    assert "case.toml" in underfoot(command, tmp_path).stderr.split("Did you mean")[1]


def test_a_place_that_cannot_be_written_is_refused_before_anything_is_computed(
    underfoot, tmp_path, monkeypatch
):
    def never(*arguments, **options):
        raise AssertionError("computed first")

    monkeypatch.setattr("underfoot.compute.run.run", never)
    (tmp_path / "file").write_text("mine")
    for place in ("/proc/underfoot", tmp_path / "file" / "out"):
        for command in (("run", EXAMPLE), ("compare", EXAMPLE, EXAMPLE)):
            found = underfoot(*command, "--out", place)
            assert found.exit_code == 2, found.stderr
            assert "nothing can be written in" in found.stderr
            assert "computed first" not in found.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_compare_refuses_what_is_no_result_before_anything_is_computed(
    underfoot, tmp_path, monkeypatch
):
    def never(*arguments, **options):
        raise AssertionError("computed first")

    monkeypatch.setattr("underfoot.compute.run.run", never)
    (tmp_path / "empty").mkdir()
    for arguments, words in (
        ((EXAMPLE, "nothere"), "there is no result folder or case file nothere"),
        ((EXAMPLE, "emty"), 'Did you mean "empty"?'),
        ((EXAMPLE, "empty"), "holds no result"),
        ((EXAMPLE,), "1 result to compare"),
        ((EXAMPLE,) * 13, "13 results to compare"),
    ):
        found = underfoot("compare", *arguments)
        assert found.exit_code == 2, found.stderr
        assert words in found.stderr
        assert "underfoot new" not in found.stderr


def test_trouble_with_files_is_told_in_words():
    from underfoot.core.errors import file_trouble

    assert file_trouble(IsADirectoryError(21, "Is a directory", "/tmp")) == (
        "/tmp is a folder; a file is needed."
    )
    assert "no space left" in file_trouble(OSError(28, "No space left on device", "/a"))
    assert file_trouble(OSError("odd")) == "odd."


def test_decisive_assumptions_come_first_one_section_after_the_other():
    listed = (
        Remark("motion", "duration = 0.12 s (90 ms)"),
        Remark("shoe.heel", "length = 60 mm (no heel shape printed)"),
        Remark("interface", "roughness_beyond_cutoff = 2.0 (one reading)"),
        Remark("interface", "effective_rq = 14 um (composite)"),
        Remark("", "Contact friction is proportional to the contact pressure."),
    )
    assert [shorten_remark(line) for line in ranked_assumptions(listed)] == [
        "interface: roughness_beyond_cutoff = 2.0",
        "shoe.heel: length = 60 mm",
        "motion: duration = 0.12 s",
        "Contact friction is proportional to the contact pressure.",
        "interface: effective_rq = 14 um",
    ]


def test_a_check_with_long_paths_stays_a_table_of_80_columns(underfoot, monkeypatch, tmp_path):
    """Paths by their end, checksums by their beginning; --all has them whole."""
    folder = tmp_path / "a_folder_of_a_laboratory_with_a_long_name" / "measurements" / "sole"
    folder.mkdir(parents=True)
    monkeypatch.setenv("COLUMNS", "80")
    case = folder / "case.toml"
    measured = EXAMPLES / "measured"
    text = (
        (measured / "case.toml").read_text(encoding="utf-8").replace('file = "compound.toml"', "")
    )
    for name in ("heel.stl", "sole.csv", "floor.csv"):
        (folder / name).write_bytes((measured / name).read_bytes())
        text = text.replace(f'"{name}"', f'"{folder.as_posix()}/{name}"')
    terms = "{shear_modulus = '1 MPa', time = '1 ms'}"
    more = f"relaxation = {{equilibrium_shear_modulus = '2 MPa', terms = [{terms}]}}\n"
    case.write_text(text.replace("[shoe.material]", f"[shoe.material]\n{more}"), encoding="utf-8")
    found = underfoot("check", case)
    assert found.exit_code == 0, found.stderr
    lines = found.stdout.splitlines()
    assert max(map(len, lines)) <= 80
    rows = [line.split() for line in lines]
    assert ["value", "given", "origin"] in rows
    (path,) = [row[1] for row in rows if row[:1] == ["floor.roughness.file"]]
    assert path.startswith("…")
    assert path.endswith("/sole/floor.csv")
    assert ["equilibrium_shear_modulus"] in rows
    whole = "".join(underfoot("check", case, "--all").stdout.split())
    assert f"{folder.as_posix()}/floor.csv" in whole


def test_a_wide_table_counts_the_rows_that_it_leaves_out(capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    columns = tuple(f"a_rather_long_column_{k}" for k in range(8))
    rows = [tuple(f"{k}.{row}" for k in range(8)) for row in range(20)]
    print_table(Table("wide", columns, rows), everything=False)
    said = capsys.readouterr().out
    assert "8 more rows" in said
    assert max(map(len, said.splitlines())) <= 80


def test_debug_shows_the_traceback(underfoot, monkeypatch):
    monkeypatch.setenv("UNDERFOOT_DEBUG", "1")
    found = underfoot("check", "nothing.toml")
    assert found.exception is not None
    assert "there is no file" in str(found.exception)


def test_new_writes_a_case_that_checks_and_refuses_to_overwrite(underfoot, tmp_path):
    target = tmp_path / "kitchen.toml"
    made = underfoot("new", target, "--fluid", "canola_oil", "--shoe", "athletic_shoe_half_tread")
    assert made.exit_code == 0
    case = Case.load(target)
    assert case.contaminant.viscosity == 0.0746
    assert underfoot("check", target).exit_code == 0
    before = target.read_text()
    again = underfoot("new", target)
    assert again.exit_code == 2
    assert "exists" in again.stderr
    assert target.read_text() == before
    assert underfoot("new", target, "--overwrite").exit_code == 0
    assert Case.load(target).contaminant.viscosity == 0.219


def test_every_commented_line_of_a_new_case_can_be_switched_on(underfoot, tmp_path):
    target = tmp_path / "new.toml"
    underfoot("new", target, "--fluid", "detergent")
    case = Case.load(target)
    lines = []
    for line in target.read_text().splitlines():
        setting = line.removeprefix("# ")
        keep = "=" in setting and not line.startswith("# A ")
        lines.append(setting if keep else line)
    switched = Case.from_text("\n".join(lines))
    assert switched.origins["shoe.tread.depth"].kind == "given"
    paths = {*case.origins, *switched.origins}
    assert {p: switched.value(p) for p in paths} == {p: case.value(p) for p in paths}


def test_new_makes_dry_cases_and_knows_names(underfoot, tmp_path):
    assert underfoot("new", tmp_path / "dry.toml", "--fluid", "none").exit_code == 0
    assert Case.load(tmp_path / "dry.toml").contaminant is None
    found = underfoot("new", tmp_path / "x.toml", "--floor", "vinil_g4")
    assert found.exit_code == 2
    assert 'Did you mean "vinyl_g4"?' in found.stderr
    assert not (tmp_path / "x.toml").exists()


def test_the_catalogue_lists_kinds_and_own_entries(underfoot, tmp_path):
    assert "canola_oil" in underfoot("catalogue", "fluid").stdout
    assert "work_shoe_untreaded" in underfoot("catalogue", "shoes").stdout
    everything = underfoot("catalogue").stdout
    assert "vinyl_g4" in everything
    assert "en_iso_13287" in everything
    (tmp_path / "own").mkdir()
    (tmp_path / "own" / "a.toml").write_text('[fluid.soup]\ntitle = "Soup"\nviscosity = "5 cP"\n')
    names = json.loads(underfoot("catalogue", "fluid", "--json", "--catalogue", "own").stdout)
    assert "soup" in names["fluid"]
    assert "5 cP" in underfoot("explain", "soup", "--catalogue", "own").stdout
    wrong = underfoot("catalogue", "liquids")
    assert wrong.exit_code == 2
    assert "Allowed: floor, fluid" in wrong.stderr


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("canola_oil", "74.6 cP"),
        ("acof", "available coefficient of friction"),
        ("contaminant.viscosity", "unit Pa*s"),
        ("motion.force_rise_time", "default 30 ms"),
        ("shoe.tread", "shoe.tread.depth"),
        ("youngs_modulus_gent", "0.137505"),
        ("gent", "youngs_modulus_gent"),
        ("glycerol_water_viscosity", "Cheng"),
        ("steady_sliding", "underfoot.rough_contact"),
        ("SoleMap", "underfoot.shoe"),
    ],
)
def test_explain_knows_entries_words_keys_and_formulas(underfoot, name, expected):
    found = underfoot("explain", name)
    assert found.exit_code == 0, found.stderr
    assert expected in found.stdout


def test_explain_answers_a_misspelt_name_with_the_nearest(underfoot):
    found = underfoot("explain", "canola_oyl")
    assert found.exit_code == 2
    assert 'Did you mean "canola_oil"?' in found.stderr


def test_terms_are_sentences():
    assert all(text.endswith(".") for text in TERMS.values())
    assert len({name.casefold() for name in TERMS}) == len(TERMS)


def test_the_schema_goes_to_a_file_or_the_screen(underfoot, tmp_path):
    printed = json.loads(underfoot("schema").stdout)
    assert printed["title"] == "Underfoot case"
    assert underfoot("schema", "--out", "a/s.json").exit_code == 0
    assert json.loads((tmp_path / "a" / "s.json").read_text()) == printed
    assert underfoot("schema", "--out", "a/s.json").exit_code == 2


def test_doctor_tells_versions_solver_and_cache(underfoot, monkeypatch, tmp_path):
    monkeypatch.setenv("UNDERFOOT_CACHE", str(tmp_path / "cache"))
    found = underfoot("doctor")
    assert found.exit_code == 0
    for word in ("numpy", "sparse solver", "OMP_NUM_THREADS", str(tmp_path / "cache")):
        assert word in found.stdout


def test_the_version_is_that_of_the_package(underfoot):
    project = tomllib.loads((EXAMPLES.parent / "pyproject.toml").read_text())["project"]
    assert underfoot("--version").stdout == f"underfoot {project['version']}\n"


def test_a_fault_of_the_program_is_told_without_a_traceback(underfoot, monkeypatch):
    def broken(case, *, quick):
        raise RuntimeError("a bug")

    monkeypatch.setattr("underfoot.compute.check.run_cost", broken)
    found = underfoot("check", EXAMPLE)
    assert found.exit_code == 70
    assert "internal error: RuntimeError: a bug" in found.stderr
    assert "UNDERFOOT_DEBUG=1" in found.stderr


def test_a_case_that_does_not_converge_ends_with_4_and_no_plain_number(underfoot, monkeypatch):
    from underfoot.compute import solve

    stunted = functools.partial(solve.SolverSettings, most_time_steps=3)
    monkeypatch.setattr(solve, "SolverSettings", stunted)
    found = underfoot("run", EXAMPLE, "--quick", "--set", "numerics.quick_grid_spacing=2 mm")
    assert found.exit_code == 4
    assert "not converged" in (found.stdout + found.stderr)
    assert "Coefficient of friction" not in found.stdout


def test_the_words_of_a_report_of_trials_are_explained():
    printed = (
        "Bland-Altman", "Wilcoxon", "Mann-Whitney", "Friedman", "Kruskal-Wallis", "FWHM", "Firth",
        "Greenhouse-Geisser", "Benjamini-Hochberg", "TOST", "type III", "standard uncertainty",
    )  # fmt: skip
    assert set(printed) <= set(TERMS)
