"""Lists that pages take from the code are whole, and the front pages' numbers are computed."""

import os
import re
import sys
import tempfile
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "docs"))
sys.path.insert(0, str(Path(__file__).parent))

import generated
from pages import ROOT, command_output, held, numbers_compared, reader

README = (ROOT / "README.md").read_text("utf-8")
SLIP_TESTER = (ROOT / "docs/studies/slip_tester.md").read_text("utf-8")
PHYSICS = [p for p in sorted((ROOT / "docs/physics").glob("*.md")) if p.stem != "index"]
LETTERS = (
    "alpha beta gamma delta varepsilon eta theta kappa lambda mu nu rho sigma tau phi varphi omega "
    "Delta Phi"
).split()


def symbols_of(text):
    """Return the letters of a page's formulas, without indices, d, e, i and pi."""
    text, found = re.sub(r"^```.*?^```", "", text, flags=re.DOTALL | re.MULTILINE), set()
    for parts in re.findall(r"\$\$(.*?)\$\$|(?<!\\)\$([^$\n]+)\$", text, re.DOTALL):
        formula = "".join(parts)
        for pattern in (
            r"\\(?:text|operatorname|begin|end|mathcal|mathsf)\s?(?:\{[^}]*\}|[A-Z])",
            r"_(?:\{[^}]*\}|\\?[A-Za-z0-9]+)",
            rf"\\(?!(?:{'|'.join(LETTERS)})\b)[A-Za-z]+",
        ):
            formula = re.sub(pattern, " ", formula)
        found |= set(re.findall(r"\\[A-Za-z]+|(?<![A-Za-z\\])[A-Za-z](?![A-Za-z])", formula))
    return found - set("dei")


@pytest.mark.parametrize("page", PHYSICS, ids=lambda page: page.stem)
def test_every_letter_of_a_formula_stands_in_the_table_of_symbols(page):
    told = {row["symbol"] for row in generated.symbol_rows() if page.stem in row["pages"].split()}
    assert symbols_of(page.read_text("utf-8")) - told == set()


def test_the_table_of_symbols_names_pages_that_exist_and_a_unit():
    stems = {page.stem for page in PHYSICS}
    for row in generated.symbol_rows():
        assert set(row["pages"].split()) <= stems, row
        assert row["unit"]
        assert row["meaning"]


def test_every_command_is_in_the_list_with_its_help():
    text = generated.commands()
    for name in generated.command_tree():
        assert f"| `underfoot {name}" in text
    assert "calibrate pair" in text
    assert "|  |" not in text.replace("|  |\n", "")


def test_every_reference_names_its_use_and_every_citation_of_the_theory_is_listed():
    listed = generated.references()
    assert len(listed) >= 100
    assert all(places for _, places in listed.values())
    authors = {key.rpartition(" ")[0].casefold() for key in listed}
    words = " ".join(text for text, _ in listed.values()).casefold()
    for page in PHYSICS:
        for row in re.findall(r"^\| Sources? \| (.*) \|$", page.read_text("utf-8"), re.MULTILINE):
            for key, _ in generated.cited(row):
                author = key.rpartition(" ")[0].casefold()
                assert author in authors or author in words, f"{page.name}: {key}"


def test_the_numbers_of_the_first_page_are_those_of_the_studies():
    assert generated.score_table() in README


@pytest.mark.slow
def test_readme_shows_what_a_run_prints(tmp_path):
    shown = re.search(r"^```\n(Available COF.*?)^```", README, re.DOTALL | re.MULTILINE)
    assert shown
    with reader(tmp_path):
        os.environ["COLUMNS"] = "240"  # the page does not fold lines
        case = "$UNDERFOOT/examples/work_shoe_untreaded_glycerol.toml"
        printed = command_output(f"underfoot run {case} --out out")
    assert held(shown.group(1), printed) >= 20


@pytest.mark.study
def test_the_page_shows_what_the_slip_tester_prints(tmp_path):
    table = re.search(r"^\| shoe \| fluid \|.*?(?=\n\n)", SLIP_TESTER, re.DOTALL | re.MULTILINE)
    assert table
    rows = "\n".join(table.group(0).splitlines()[2:])
    with reader(tmp_path):
        printed = command_output(f"{sys.executable} {ROOT}/examples/slip_tester_g4.py")
    assert held(rows, printed) >= 60


@pytest.mark.slow
def test_the_example_of_each_room_prints_what_it_shows(tmp_path):
    assert numbers_compared(ROOT / "docs" / "api" / "examples.md", tmp_path) >= 25


def test_no_page_of_the_interface_is_too_long():
    with tempfile.TemporaryDirectory() as folder:
        pages = generated.write_interface_pages(Path(folder) / "rooms")
        text = "".join((Path(folder) / "rooms" / f"{p}.md").read_text() for p in pages)
    assert len(pages) > 60
    names = re.findall(r"auto(?:class|function):: (\S+)", text)
    assert len(names) == len(set(names)) > 600
