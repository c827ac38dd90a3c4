"""Study g1: settings, changes between cases, and explicit cases that are kept."""

import json
from dataclasses import asdict, replace

import numpy as np
import pytest

from underfoot.core import InputError
from underfoot.studies import g1
from underfoot.studies.g1 import HISTORY, MatrixRow, Settings, matrix

SETTINGS = Settings(series=("report",), solver="explicit", speeds=(0.1, 1.0))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"series": ("wide",)}, "unknown series"),
        ({"solver": "ansys"}, "unknown solver"),
        ({"bulk_modulus": "best"}, "unknown bulk modulus"),
        ({"speeds": (0.1,)}, "two or more speeds"),
        ({"floor_wavelength": 4e-3}, "one whole wavelength"),
    ],
)
def test_settings_refuse_what_cannot_be_run(change, words):
    with pytest.raises(InputError, match=words):
        Settings(**change)


@pytest.fixture
def computed(monkeypatch, tmp_path):
    """Count the cases that are computed; the fourth raises as Ctrl-C does."""
    monkeypatch.setenv("UNDERFOOT_CACHE", str(tmp_path))
    done = []

    def outcome(item):
        case = item[0]
        if len(done) == 3:
            done.append("stopped")
            raise KeyboardInterrupt
        done.append(case)
        row = MatrixRow(*asdict(case).values(), *[case.speed] * 7, "converged", "", 1.0)
        history = {name: np.arange(3.0) * case.speed for name in HISTORY}
        return {"row": np.array(json.dumps(asdict(row))), **history}

    monkeypatch.setattr(g1, "explicit_outcome", outcome)
    return done


def test_finished_cases_are_kept(computed):
    cases = list(matrix(SETTINGS))
    with pytest.raises(KeyboardInterrupt):
        list(g1.outcomes(cases, SETTINGS))
    assert g1.kept_cases(SETTINGS, cases) == 3
    found = list(g1.outcomes(cases, SETTINGS))
    assert len(computed) == len(cases) + 1  # none twice
    rows = [row for row, _ in found]
    assert [(r.material, r.floor_rz, r.speed) for r in rows] == [
        (c.material, c.floor_rz, c.speed) for c in cases
    ]
    assert np.array_equal(found[0][1]["shear_force"], np.arange(3.0) * cases[0].speed)


def test_other_settings_or_another_program_start_anew(computed, monkeypatch):
    cases = list(matrix(SETTINGS))[:2]
    list(g1.outcomes(cases, SETTINGS))
    assert g1.kept_cases(replace(SETTINGS, speeds=(0.1, 0.5, 1.0)), cases) == 2
    assert g1.kept_cases(replace(SETTINGS, control="load"), cases) == 0
    monkeypatch.setattr(g1, "_source", lambda: "another version")
    assert g1.kept_cases(SETTINGS, cases) == 0
