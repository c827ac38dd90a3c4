"""``underfoot explain`` answers each key of a case file and each option of a slot."""

import pytest

from underfoot.case.explanation import explanation
from underfoot.case.parts import keys, paths
from underfoot.core.catalogue import Catalogue


@pytest.fixture(scope="module")
def catalogue():
    return Catalogue.load()


def test_every_key_of_a_case_file_is_explained(catalogue):
    for path in paths():
        assert path in explanation(path, catalogue)


@pytest.mark.parametrize("path", keys())
def test_the_key_of_a_slot_names_every_option_and_each_is_explained(catalogue, path):
    shown = explanation(path, catalogue).splitlines()
    for name, option in keys()[path].options().items():
        assert any(line.split()[:1] == [name] for line in shown)
        text = explanation(name, catalogue)
        assert f'{path} = "{name}": ' in text
        assert option.source in text
