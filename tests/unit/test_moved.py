"""Old paths of modules: answered with a warning that names the new one."""

import ast
import importlib
import sys
import warnings
from pathlib import Path

import pytest

import underfoot
from underfoot.core.moved import HOMES, new_home


@pytest.mark.parametrize("old", HOMES)
def test_an_old_path_answers_and_names_the_new_one(old):
    home = HOMES[old]
    own = importlib.import_module(home)
    loaded = set(sys.modules)
    try:
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            assert importlib.import_module(old) is own
        said = [str(each.message) for each in told if each.category is FutureWarning]
        assert any(text.startswith(f"{old} is now {home};") for text in said)
        assert own.__name__ == own.__spec__.name == home
    finally:
        for name in set(sys.modules) - loaded:
            del sys.modules[name]


def test_what_never_was_is_still_missing():
    assert new_home("underfoot.trial") is None
    with pytest.raises(ModuleNotFoundError, match=r"underfoot\.trials\.gaits"):
        importlib.import_module("underfoot.trials.gaits")
    with pytest.warns(FutureWarning), pytest.raises(ModuleNotFoundError, match="nothing_here"):
        importlib.import_module("underfoot_places.nothing_here")


def old_members():
    """Yield module, class, name and the two names that each ``renamed_member`` of a class has."""
    source = Path(underfoot.__file__).parent
    for path in sorted(source.rglob("*.py")):
        if "renamed_member(" not in (text := path.read_text(encoding="utf-8")):
            continue
        module = ".".join(path.relative_to(source.parent).with_suffix("").parts)
        for of in (one for one in ast.walk(ast.parse(text)) if isinstance(one, ast.ClassDef)):
            for line in (one for one in of.body if isinstance(one, ast.Assign)):
                calls = [one for one in ast.walk(line.value) if isinstance(one, ast.Call)]
                if made := [one for one in calls if ast.unparse(one.func) == "renamed_member"]:
                    old, new = (one.value for one in made[0].args)
                    yield module.removesuffix(".__init__"), of.name, line.targets[0].id, old, new


OLD_MEMBERS = list(old_members())


@pytest.mark.parametrize(("module", "of", "name", "old", "new"), OLD_MEMBERS)
def test_an_old_member_is_called_as_before_and_answers_as_one_that_is_there(
    module, of, name, old, new
):
    kind = getattr(importlib.import_module(module), of)
    assert name == old != new
    assert hasattr(kind, new) or new in getattr(kind, "__dataclass_fields__", {})


def test_there_are_old_members():
    assert len(OLD_MEMBERS) >= 3
