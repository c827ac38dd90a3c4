"""Which readings a place learns from; where the results of all studies go."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from commands import called
from underfoot import studies
from underfoot.cli import studies as command
from underfoot.places import choice


def shoe(name, **known):
    parts = {"section": "a", "wear_depth": 0.0, "worn_region": "", "known_class": None}
    return SimpleNamespace(name=name, **parts | {"readings": ()} | known)


@pytest.mark.parametrize("fails", [False, True])
def test_a_shoe_is_learned_from_once_by_its_readings_and_its_class(monkeypatch, fails):
    """A class holds readings that all were passed, or, of a shoe that failed, not all."""
    asked, taught = [], {}

    class Draws:
        count = 3

        def log_likelihood(self, cof, reading):
            return np.log(np.full(3, 0.5)) * np.asarray(cof)

        def learn(self, log, name):
            taught[name] = log

    def tested(joint, case, law, one, test):
        asked.append((joint, case, law, one.name, test))
        return np.array([1.0, 2.0, 3.0])

    joint = Draws()
    readings = (SimpleNamespace(test="tile", reading="r"),)
    readings_of_class = [SimpleNamespace(test=t, cof=0.3, kind="lower", sd=0.01) for t in "st"]
    known = SimpleNamespace(name="SR", readings=readings_of_class, fails=fails)
    shoes = [shoe("b", known_class=known), shoe("a", section="b", readings=readings),
             shoe("c", section="b", readings=readings)]  # fmt: skip
    monkeypatch.setattr(choice, "tested_cof", tested)
    monkeypatch.setattr(choice, "law_of_pair", lambda case: f"law of {case}")
    monkeypatch.setattr(choice, "slip_tests", lambda: {"tile": "the tile"})
    place = SimpleNamespace(floors=[], shoes=shoes)
    cases = {name: f"case {name}" for name in "abc"}
    assert choice._learn(cast(Any, place), cast(Any, joint), {}, cases) == ()
    of_a = (joint, "case a", "law of case a", "a", "the tile")
    of_b = [(joint, "case b", "law of case b", "b", test) for test in "st"]
    assert asked == [of_a, *of_b]  # c is a under another name
    assert list(taught) == ["shoe a", "shoe b, class SR"]
    passed = 0.25 ** np.array([1.0, 2.0, 3.0])
    expected = np.log(1 - passed) if fails else np.log(passed)
    assert taught["shoe b, class SR"] == pytest.approx(expected)


@pytest.mark.parametrize(
    ("words", "to"),
    [
        (["all"], Path("out") / "studies"), (["all", "--json"], None),
        (["all", "--out", "here"], Path("here")), (["g1"], None), (["g1", "--json"], None),
        (["g1", "--out", "here"], Path("here")),
    ],
)  # fmt: skip
def test_all_studies_have_a_folder_and_one_has_what_was_asked(monkeypatch, tmp_path, words, to):
    went = []
    monkeypatch.setattr(studies, "run_all", lambda **_: [SimpleNamespace(error="")])
    monkeypatch.setattr(studies, "run_study", lambda *_: SimpleNamespace(error=""))
    monkeypatch.setattr(command, "_deliver", lambda results, out, **_: went.append(out))
    done = called("studies", "run", *words, folder=tmp_path)
    assert done.returncode == 0, done.stderr
    assert went == [to]
