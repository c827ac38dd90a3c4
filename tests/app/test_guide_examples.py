"""The guides' own examples, run as they stand."""

import re
from pathlib import Path

import pytest

from underfoot.case import Case
from underfoot.core.catalogue import Catalogue

GUIDE = Path(__file__).parents[2] / "docs" / "guide"


def blocks(page, language):
    return re.findall(rf"```{language}\n(.*?)```", (GUIDE / page).read_text(), flags=re.DOTALL)


def test_the_case_of_the_guide_loads_and_its_python_does_what_it_says(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (toml,) = blocks("case_files.md", "toml")
    Path(toml.splitlines()[0].removeprefix("# ")).write_text(toml)
    from_file, from_names = blocks("case_files.md", "python")
    names: dict = {}
    exec(compile(from_file, "case_files.md", "exec"), names)
    without_file = {"uf": names["uf"]}
    exec(compile(from_names, "case_files.md", "exec"), without_file)
    assert without_file["case"].motion.speed == 0.5
    assert without_file["case"].shoe.tread.depth == 1.1e-3
    assert names["case"].contaminant.viscosity == 0.07
    assert names["case"].sourced_value("contaminant.viscosity").uncertainty == 0.003
    assert names["thin"].contaminant.viscosity == 0.041
    assert Case.load("thin.toml") == names["thin"]


def test_the_catalogue_of_the_guide_loads_and_makes_a_case(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (toml,) = blocks("catalogue.md", "toml")
    file = tmp_path / toml.splitlines()[0].removeprefix("# ")
    folder = file.parent
    folder.mkdir()
    file.write_text(toml)
    (python,) = blocks("catalogue.md", "python")
    exec(compile(python, "catalogue.md", "exec"), {})
    case = Case.from_mapping(
        {
            "shoe": "our_clog",
            "floor": "vinyl_g4",
            "contaminant": "fryer_oil",
            "motion": "slip_tester_g4",
        },
        catalogue=Catalogue.load([folder]),
    )
    assert case.contaminant.viscosity == 0.018
    assert case.shoe.heel.profile.radius == pytest.approx(0.08)
    assert case.shoe.heel.profile.start == pytest.approx(0.025)


def test_the_guide_names_every_exit_code():
    text = (GUIDE / "command_line.md").read_text()
    from underfoot.core import errors

    codes = {
        item.exit_code
        for item in vars(errors).values()
        if isinstance(item, type) and issubclass(item, errors.UnderfootError)
    }
    for code in codes:
        assert f"| {code} |" in text
