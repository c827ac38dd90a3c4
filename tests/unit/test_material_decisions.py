"""Moduli, scales and averages of rubber files by values that follow from their definitions."""

from types import SimpleNamespace

import numpy as np
import pytest

from underfoot.core import DataError, InputError
from underfoot.material import master_curve
from underfoot.material.curves import RelaxationCurve
from underfoot.material.decks import _elastic
from underfoot.material.durometer_scales import durometer_reading
from underfoot.material.master_curve import relaxation_master_curve
from underfoot.material.read import read_rubber


@pytest.mark.parametrize(
    ("options", "card", "shear"),
    [
        (["*ELASTIC"], [3.0, 0.5], 1.0),
        (["*ELASTIC"], [3.0, 0.25], 1.2),
        (["*HYPERELASTIC", "NEO HOOKE"], [0.4, 0.01], 0.8),
        (["*HYPERELASTIC", "YEOH"], [0.4, 0.1, 0.02, 0.01], 0.8),
        (["*HYPERELASTIC", "MOONEY-RIVLIN"], [0.3, 0.1, 0.01], 0.8),
        (["*HYPERELASTIC", "OGDEN"], [0.7, 2.0, 0.01], 0.7),
        (["*HYPERELASTIC", "OGDEN", "N=2"], [0.7, 2.0, 0.2, -2.0, 0.01, 0.02], 0.9),
        (["*HYPERELASTIC", "OGDEN", "N=3"], [0.7, 2, 0.2, -2, 0.1, 4, 0.01, 0.02, 0.03], 1.0),
    ],
)
def test_the_shear_modulus_of_a_deck_is_that_of_small_strain(options, card, shear):
    assert _elastic(options, card, "deck") == pytest.approx(shear)


@pytest.mark.parametrize(
    ("options", "card"),
    [
        (["*ELASTIC"], [3.0]),
        (["*HYPERELASTIC", "OGDEN"], [3.0]),
        (["*HYPERELASTIC", "MOONEY-RIVLIN"], [3.0]),
        (["*HYPERELASTIC", "NEO HOOKE"], []),
        (["*HYPERELASTIC", "MARLOW"], [3.0, 1.0]),
    ],
)
def test_a_deck_without_what_its_modulus_needs_is_refused(options, card):
    with pytest.raises(DataError, match="elastic part"):
        _elastic(options, card, "deck")


@pytest.mark.parametrize(
    ("reading", "edges"),
    [("A", (0, 100)), ("Shore D", (30, 49)), ("Asker C", (45, 75))],
)
def test_a_scale_is_read_to_the_ends_that_its_source_gives(reading, edges):
    for edge, past in zip(edges, (-1, 1), strict=True):
        assert durometer_reading(f"{edge} {reading}").value == edge
        if edge + past >= 0:
            with pytest.raises(InputError):
                durometer_reading(f"{edge + past} {reading}")


@pytest.mark.parametrize(("reading", "spread"), [("40 D", 5), ("60 C", 5), ("60", 0)])
def test_a_converted_hardness_says_the_tolerance_that_it_rests_on(reading, spread):
    told = durometer_reading(reading)
    assert told.scale.spread == spread
    assert (f"± {spread} " in told.note()) == bool(spread)


def test_readings_at_one_reduced_time_are_averaged_with_their_temperatures(monkeypatch):
    """No shift between tests at 290 and 310 K: what both have at a time is one reading."""
    shifts = SimpleNamespace(log10_shift_factors=[0.0, 0.0])
    monkeypatch.setattr(master_curve, "_shift_table", lambda *_: shifts)
    cold = RelaxationCurve(np.array([1.0, 10.0, 100.0, 1e3]), np.array([9.0, 7.0, 5.0, 3.0]), 290.0)
    warm = RelaxationCurve(np.array([10.0, 100.0, 1e3, 1e4]), np.array([5.0, 3.0, 1.0, 1.0]), 310.0)
    master = relaxation_master_curve([warm, cold])
    assert master.time == pytest.approx([1.0, 10.0, 100.0, 1e3, 1e4])
    assert master.modulus == pytest.approx([9.0, 6.0, 4.0, 2.0, 1.0])
    assert master.temperature == pytest.approx([290.0, 300.0, 300.0, 300.0, 310.0])


@pytest.mark.parametrize(
    ("head", "ratio", "of_young"),
    [
        ('modulus = "shear"\n', "poisson_ratio = 0.5\n", 3.0),
        ('modulus = "shear"\n', "poisson_ratio = 0.25\n", 2.5),
        ('modulus = "young"\n', "poisson_ratio = 0.25\n", 1.0),
        ("", "poisson_ratio = 0.25\n", 1.0),
        ('modulus = "shear"\n', "", None),
    ],
)
def test_a_series_of_shear_with_a_ratio_becomes_one_of_young(tmp_path, head, ratio, of_young):
    path = tmp_path / "rubber.toml"
    path.write_text(
        f'{head}{ratio}equilibrium_modulus = "1 MPa"\n'
        '[[term]]\nmodulus = "2 MPa"\nrelaxation_time = "1 s"\n'
    )
    test = read_rubber(path)
    assert test is not None
    assert test.series is not None
    assert test.shear is (of_young is None)
    assert test.series.equilibrium_modulus == pytest.approx(1e6 * (of_young or 1.0))
