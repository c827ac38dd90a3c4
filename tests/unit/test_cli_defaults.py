"""What a command does that is given nothing."""

import inspect

import pytest

from commands import called
from underfoot.cli import cases, contact
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
