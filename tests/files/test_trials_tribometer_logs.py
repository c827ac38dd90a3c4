"""Real tribometer logs (README of the data): mean COF over the whole run, and the steady part."""

from pathlib import Path

import pytest

from underfoot.trials import read_trials
from underfoot.trials.machines.pin_on_disk import friction_point

_DATA = Path(__file__).parents[1] / "data" / "trials"
_ALL = (-1.0, 1e9)


@pytest.mark.parametrize("name", sorted(p.name for p in (_DATA / "cetr").glob("*.csv")))
def test_cetr_steps(name):
    first, second = read_trials(_DATA / "cetr" / name)[:2]
    # README: mean COF 0.64 to 0.70 in step 1, 0.79 to 0.83 in step 2.
    assert 0.635 < (friction_point(first, window=_ALL).cof.value or 0) < 0.705
    assert 0.785 < (friction_point(second, window=_ALL).cof.value or 0) < 0.835


@pytest.mark.parametrize(("name", "mean"), [("demo_7.txt", 0.102), ("demo_5.txt", 0.113)])
def test_pcs_logs(name, mean):
    trial = read_trials(_DATA / "pcs" / name)[0]
    assert friction_point(trial, window=_ALL).cof.value == pytest.approx(mean, abs=0.001)
    steady = friction_point(trial)
    assert any("not steady" in flag.message for flag in steady.cof.flags)
    assert steady.cof.conventions["cof"] == "column of the file"
