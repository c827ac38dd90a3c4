"""The explicit matrix goes on where it was stopped, and takes over nothing else."""

from dataclasses import replace

import numpy as np
import pytest

from underfoot.studies import g1_kept
from underfoot.studies.g1_cases import HISTORY, G1Outcome, G1Row, G1Settings, matrix

SETTINGS = G1Settings(series=("report",), solver="explicit", speeds=(0.1, 1.0))


@pytest.fixture
def computed(monkeypatch, tmp_path):
    """Count the cases that are computed; the third raises as Ctrl-C does."""
    monkeypatch.setenv("UNDERFOOT_CACHE", str(tmp_path))
    done = []

    def outcome(case, settings):
        if len(done) == 3 and done[-1] != "again":
            done.append("again")
            raise KeyboardInterrupt
        done.append(case)
        numbers = [case.speed] * 7
        row = G1Row(
            case.series,
            case.material,
            case.shoe_rz,
            case.floor_rz,
            case.speed,
            *numbers,
            status="converged",
            note="",
            seconds=1.0,
        )
        return G1Outcome(row, {name: np.arange(3.0) * case.speed for name in HISTORY})

    monkeypatch.setattr(g1_kept, "explicit_outcome", outcome)
    return done


def test_finished_cases_are_kept(computed):
    cases = list(matrix(SETTINGS))
    with pytest.raises(KeyboardInterrupt):
        list(g1_kept.explicit_outcomes(cases, SETTINGS))
    assert g1_kept.kept_cases(SETTINGS, cases) == 3
    found = list(g1_kept.explicit_outcomes(cases, SETTINGS))
    assert len(computed) == len(cases) + 1  # none twice
    assert [(o.row.material, o.row.floor_rz, o.row.speed) for o in found] == [
        (c.material, c.floor_rz, c.speed) for c in cases
    ]
    assert np.array_equal(found[0].history["shear_force"], np.arange(3.0) * cases[0].speed)


def test_other_settings_or_another_program_start_anew(computed, monkeypatch):
    cases = list(matrix(SETTINGS))[:2]
    list(g1_kept.explicit_outcomes(cases, SETTINGS))
    same = replace(SETTINGS, processes=2, speeds=(0.1, 0.5, 1.0))
    assert g1_kept.kept_cases(same, cases) == 2
    assert g1_kept.kept_cases(replace(SETTINGS, control="load"), cases) == 0
    monkeypatch.setattr(g1_kept, "_source", lambda: "another version")
    assert g1_kept.kept_cases(SETTINGS, cases) == 0
