"""``underfoot explain`` answers each key of a case file and each option of a slot."""

import pytest

from underfoot.case.explanation import explanation
from underfoot.case.parts import keys, paths
from underfoot.core import InputError
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


def test_the_last_word_of_a_key_is_enough(catalogue):
    shown = explanation("viscosity", catalogue)
    assert shown.startswith("contaminant.viscosity: dynamic viscosity as measured\n  unit Pa*s")
    assert explanation("ramp_angle", catalogue).startswith("friction.ramp_angle: ramp with boots")
    assert "KEY): floor.shore_a, shoe.material.shore_a" in explanation("shore_a", catalogue)


def test_an_unknown_name_is_answered_with_the_nearest_key_of_any_package(catalogue):
    for typed, meant in (("viscosty", "viscosity"), ("friction.ramp_angel", "friction.ramp_angle")):
        with pytest.raises(InputError, match=f'Did you mean "{meant}"'):
            explanation(typed, catalogue)
