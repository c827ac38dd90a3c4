"""What a command does that is given nothing."""

import inspect

import pytest
from typer.main import get_command

from commands import called
from underfoot.cli import cases, contact
from underfoot.cli.app import app
from underfoot.core import InputError
from underfoot.questions.contact import surface_from
from underfoot.questions.wear import wear_series


@pytest.mark.parametrize("words", [(), ("study",), ("studies",), ("trials",)], ids=" ".join)
def test_a_command_without_a_word_shows_its_help(words):
    done = called(*words)
    for part in ("Usage:", "Commands", "--help"):
        assert part in done.stdout, words
    assert "Missing command" not in done.stdout + done.stderr


@pytest.mark.parametrize(
    ("command", "function", "names"),
    [
        (cases.wear, wear_series, ("seed",)),
        (contact.contact, surface_from, ("seed", "hurst", "points")),
    ],
)
def test_a_command_has_the_defaults_of_the_function_that_answers(command, function, names):
    for name in names:
        typed, called_with = (inspect.signature(one).parameters[name].default
                              for one in (command, function))  # fmt: skip
        assert typed == called_with, name


def commands_of(group, *path):
    for name, command in group.commands.items():
        if hasattr(command, "commands"):
            yield from commands_of(command, *path, name)
        else:
            yield (*path, name), {each.name: each.default for each in command.params}


def test_no_command_replaces_what_exists_unless_it_is_asked_to():
    options = dict(commands_of(get_command(app)))
    assert {("trials", "plan"), ("wear",), ("study", "run")} <= options.keys()
    for name, value in (("overwrite", False), ("json", False)):
        asked = [path for path, known in options.items() if name in known]
        assert asked, name
        assert [path for path in asked if options[path][name] not in (value, None)] == []


def test_a_table_of_two_scans_is_of_the_floor_under_the_sole(monkeypatch, tmp_path):
    asked = []

    def measured_table(floor, rubber, *, shoe, speed, **_):
        asked.append((floor.name, rubber[1], shoe.name, speed))
        raise InputError("that is all")

    monkeypatch.setattr("underfoot.questions.contact.measured_table", measured_table)
    words = ("--sole", "shoe.csv", "--table", "t.npz", "--modulus", "5 MPa", "--speed", "0.3 m/s")
    done = called("contact", "floor.csv", *words, folder=tmp_path)
    assert done.returncode == 2
    ((floor, rubber, shoe, speed),) = asked
    assert (floor, shoe, speed) == ("floor.csv", "shoe.csv", 0.3)
    assert "5 MPa" in rubber
