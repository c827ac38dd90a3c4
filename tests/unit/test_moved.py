"""Old paths of modules: answered with a warning that names the new one."""

import importlib
import sys
import warnings

import pytest

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
