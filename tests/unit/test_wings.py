"""The wings beside the core: what they offer, and what is said where one is missing."""

import tomllib
from pathlib import Path

import pytest

import underfoot
from commands import called
from underfoot.core import InputError, registry
from underfoot.core.installation import installation

FOLDERS = sorted(Path(__file__).parents[2].glob("wings/*/pyproject.toml"))


@pytest.fixture
def no_wings(monkeypatch):
    """No package offers anything, as where the core alone is installed."""
    monkeypatch.setattr(registry, "all_offers", tuple)


def test_the_core_names_what_its_wings_offer():
    offers = {}
    for path in FOLDERS:
        project = tomllib.loads(path.read_text())["project"]
        assert project["name"] == f"underfoot-{path.parent.name}".replace("_", "-")
        for group, names in project["entry-points"].items():
            offers |= {(group.partition(".")[2], name): project["name"] for name in names}
    assert offers == registry.WINGS


def test_all_wings_come_with_the_extra_all():
    extras = tomllib.loads(FOLDERS[0].parents[2].joinpath("pyproject.toml").read_text())["project"]
    told = {f"underfoot-{path.parent.name}".replace("_", "-") for path in FOLDERS}
    assert told <= set(extras["optional-dependencies"]["all"])


COMMANDS = [name for door, name in registry.WINGS if door == "commands"]


@pytest.mark.parametrize("name", COMMANDS)
def test_a_command_of_a_missing_wing_says_in_one_line_what_to_install(no_wings, name):
    words, wing = name.replace(".", " "), registry.WINGS["commands", name]
    done = called(*words.split(), "--help")
    assert done.returncode == 2
    folder = wing.removeprefix("underfoot-").replace("-", "_")
    assert done.stderr == (
        f"error: {words} comes with the package {wing}. "
        f"pip install {wing} (in the source: ./wings/{folder}).\n"
    )


def test_the_doctor_names_a_missing_wing(no_wings):
    rows = dict(installation())
    assert {*registry.WINGS.values()} <= rows.keys()
    assert rows["underfoot-app"].endswith("pip install underfoot-app (in the source: ./wings/app)")


def test_with_all_wings_the_doctor_names_none():
    assert registry.missing_wings() == {}


def test_without_wings_the_help_holds_the_core(no_wings):
    shown = called("--help")
    assert shown.returncode == 0
    assert " run " in shown.stdout
    assert not [name for name in COMMANDS if f"│ {name} " in shown.stdout]


@pytest.mark.parametrize("name", [name for door, name in registry.WINGS if door == "names"])
def test_a_name_of_a_missing_wing_says_what_to_install(no_wings, name):
    assert name in underfoot.__all__
    with pytest.raises(InputError, match=rf"^{name} comes with .* pip install underfoot-\w+"):
        getattr(underfoot, name)
