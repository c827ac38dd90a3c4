"""What a command does that is given nothing."""

import ast
import inspect
import textwrap
from collections import defaultdict
from importlib import import_module
from typing import Any, cast

import pytest
from typer.main import get_command

from commands import called
from underfoot.cli.app import app
from underfoot.core import InputError


@pytest.mark.parametrize("words", [(), ("study",), ("studies",), ("trials",)], ids=" ".join)
def test_a_command_without_a_word_shows_its_help(words):
    done = called(*words)
    for part in ("Usage:", "Commands", "--help"):
        assert part in done.stdout, words
    assert "Missing command" not in done.stdout + done.stderr


def commands_of(group, *path):
    for name, command in group.commands.items():
        if hasattr(command, "commands"):
            yield from commands_of(command, *path, name)
        else:
            yield (*path, name), command


def handed_on(command):
    """Yield (parameter, default of the command, function, its default) of what a command hands on.

    Keywords of calls in its body, and what stands in dictionaries there, which calls take by **.
    """
    body = ast.parse(textwrap.dedent(inspect.getsource(command)))
    defaults = {name: one.default for name, one in inspect.signature(command).parameters.items()}
    known = dict(vars(inspect.getmodule(command)))
    nodes = list(ast.walk(body))
    for node in nodes:
        if isinstance(node, ast.ImportFrom):
            room = import_module("." * node.level + (node.module or ""), command.__module__[:13])
            for each in node.names:
                known[each.asname or each.name] = getattr(room, each.name)
    several = [
        (key.value, value)
        for node in nodes
        if isinstance(node, ast.Dict)
        for key, value in zip(node.keys, node.values, strict=True)
        if isinstance(key, ast.Constant)
    ]
    for call in (node for node in nodes if isinstance(node, ast.Call)):
        if isinstance(call.func, ast.Name):
            function = known.get(call.func.id)
        elif isinstance(call.func, ast.Attribute) and isinstance(call.func.value, ast.Name):
            function = getattr(known.get(call.func.value.id), call.func.attr, None)
        else:
            continue
        if not (getattr(function, "__module__", None) or "").startswith("underfoot."):
            continue
        takes = inspect.signature(cast(Any, function)).parameters
        named = [(each.arg, each.value) for each in call.keywords if each.arg]
        for name, value in named + several * any(each.arg is None for each in call.keywords):
            if isinstance(value, ast.Name) and value.id in defaults and name in takes:
                yield value.id, defaults[value.id], function, takes[name].default


OWN_DEFAULT = {
    ("contact", "device"): "auto",  # a command looks for a card; Python is told
    # a command asks; in Python a difference without ``sd`` is one in standard deviations
    **{("trials", "persons", name): None for name in ("difference", "sd", "shares")},
}


def test_a_command_has_the_defaults_of_the_functions_that_answer():
    none, compared = inspect.Parameter.empty, 0
    for path, command in commands_of(get_command(app)):
        for name, typed, function, called_with in handed_on(inspect.unwrap(command.callback)):
            if none not in (typed, called_with):
                wanted = OWN_DEFAULT.get((*path, name), called_with)
                assert typed == wanted, (*path, name, function.__qualname__)
                compared += 1
    assert compared > 80


def test_no_command_replaces_what_exists_unless_it_is_asked_to():
    options = {
        path: {each.name: each.default for each in command.params}
        for path, command in commands_of(get_command(app))
    }
    assert {("trials", "plan"), ("wear",), ("study", "run")} <= options.keys()
    for name, value in (("overwrite", False), ("json", False)):
        asked = [path for path, known in options.items() if name in known]
        assert asked, name
        assert [path for path in asked if options[path][name] not in (value, None)] == []


def test_few_flags_are_on_where_nothing_is_said():
    """Coarse grids of questions that ask for many runs, bands, solids, and what a heading needs."""
    on = {
        (*path, each.name)
        for path, command in commands_of(get_command(app))
        for each in command.params
        if getattr(each, "is_flag", False) and each.default
    }
    many_runs = {("slip",), ("sensitivity",), ("risk",), ("wear",), ("choose",)}
    assert on == {(*path, "quick") for path in (*many_runs, ("calibrate", "pair"))} | {
        ("wear", "band"), ("study", "export", "step"), ("trials", "describe", "baseline"),
    }  # fmt: skip


def test_no_words_of_an_option_hide_two_defaults():
    """Where nothing is the default the words say what is done then: in every command the same."""
    defaults = defaultdict(set)
    for _, command in commands_of(get_command(app)):
        for each in command.params:
            defaults[each.name, getattr(each, "help", None)].add(repr(each.default))
    assert len(defaults) > 100
    for words, known in defaults.items():
        assert "None" not in known or known == {"None"}, words


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
