"""Examples in public docstrings run and give what they print."""

import doctest
import importlib
import inspect
import pkgutil

import pytest

import underfoot

ROOMS = "core reference material surface fluid film rough_contact friction shoe sole_contact slip"


def examples():
    """Return the examples of everything that a room shows, by their names."""
    finder, found = doctest.DocTestFinder(recurse=False), {}
    for room in ROOMS.split():
        face = importlib.import_module(f"underfoot.{room}")
        for name in sorted({*dir(face), *getattr(face, "__all__", ())}):  # some when asked for
            item = getattr(face, name)
            if inspect.isfunction(item) or inspect.isclass(item):
                module = inspect.getmodule(item)
                tests = finder.find(item, f"{room}.{name}", module=module)
                found |= {each.name: each for each in tests if each.examples}
    return found


FOUND = examples()


def test_there_are_sixty():
    assert len(FOUND) >= 60


@pytest.mark.parametrize("name", FOUND)
def test_the_example_gives_what_it_prints(name):
    told = []
    runner = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE)
    runner.run(FOUND[name], out=told.append)
    assert runner.failures == 0, "".join(told)


def test_no_example_is_skipped():
    for module in pkgutil.iter_modules(underfoot.__path__):
        text = inspect.getdoc(importlib.import_module(f"underfoot.{module.name}")) or ""
        assert "+SKIP" not in text
