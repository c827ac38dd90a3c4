"""Steps of a calibration with a value of their own."""

import math
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.calibrate.compound import Compound, _beside
from underfoot.calibrate.law_file import ENOUGH, TrialReadings, law_table
from underfoot.calibrate.stribeck_curve import _gap
from underfoot.case import load
from underfoot.compute.resolve import resolve_context
from underfoot.trials.machines.compression import BONDED, Compression, compression_moduli

EXAMPLE = Path(__file__).parents[2] / "examples" / "work_shoe_untreaded_glycerol.toml"


def test_a_speed_read_often_has_its_own_scatter_and_others_share_one():
    often, twice = 0.3 + 0.02 * np.arange(-3, 4), np.array([0.5, 0.6])
    assert often.size >= ENOUGH
    readings = TrialReadings(
        np.repeat([0.1, 0.4], [often.size, 2]), np.concatenate([often, twice]), 0.05, 0, "made"
    )
    table = law_table(readings, form="readings")
    assert table.speed.tolist() == [0.1, 0.4]
    assert table.cof == pytest.approx([0.3, 0.55])
    squares = float(((often - 0.3) ** 2).sum())
    assert table.deviation == pytest.approx(
        [math.sqrt(squares / (often.size - 1)), math.sqrt((squares + 0.005) / often.size)]
    )


@pytest.mark.parametrize("pressure", [1e4, 1e5, 1e6])
def test_the_gap_of_a_pair_carries_its_pressure(pressure):
    case = load(EXAMPLE)
    gap = _gap(case, pressure)
    interface = case.rough_contact.build(resolve_context(case))
    assert 0 < gap < 1e-4
    assert float(interface.pressure(gap)) == pytest.approx(pressure, rel=1e-4)


def test_a_pair_that_closes_has_no_gap():
    case = load(EXAMPLE)
    assert _gap(case, 1e12) == 0.0


def test_a_sweep_and_a_relaxation_test_are_compared_in_the_middle_of_what_both_saw():
    """Sweep of 0.1 to 100 rad/s, test of 0.1 to 10 s: both saw 0.1 to 10 s, and 1 s."""

    def fitted(low, high, modulus):
        spectrum = SimpleNamespace(relaxation_modulus=lambda time: modulus / time)
        return cast(Any, SimpleNamespace(frequency_range=(low, high), spectrum=spectrum))

    told = _beside(fitted(0.1, 100.0, 2.0), fitted(0.01, 10.0, 3.0))
    assert "1.50 times" in told
    assert "at 1 s;" in told
    assert "share no time" in _beside(fitted(1.0, 100.0, 2.0), fitted(1e-3, 1.0, 3.0))


def test_a_compound_shows_the_moduli_of_each_compression_test():
    """Of blocks of 10 mm and 10 cm^2: 10 N at 2 %, 190 N at the end, 100 N after the hold."""
    moduli = compression_moduli(10.0, 190.0, 100.0, 0.01, 1e-3)
    test = Compression("block.csv", cast(Any, None), moduli, shape_factor=0.5)
    compound = Compound(
        "own", None, None, None, None, None, (test, test), None, None, 0.5, None, (), ()
    )
    value = {label.strip(): told for label, told, _ in compound.table().rows}
    apparent = value.pop("over Young's modulus")
    assert value.pop("Young's modulus").startswith("not")
    # 180 N over 0.18 of 10 mm, 2 T / A = 20 1/m, and half of both after the hold
    assert value == {
        "K_0 (Eq. 13)": "100 N/mm", "E_0 (Eq. 14)": "2 MPa",
        "K_inf (Eq. 15)": "50 N/mm", "E_inf (Eq. 16)": "1 MPa",
    }  # fmt: skip
    assert len(compound.table().rows) == 1 + 2 * 5
    assert apparent.startswith(f"{1 + 2 * BONDED[0] * 0.25:.3g} ± ")
