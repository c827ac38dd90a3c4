"""Steps of reading rubber by their values: pairs of columns, cards of decks, scales, ranges."""

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.core import InputError
from underfoot.material import RelaxationSpectrum, fit_relaxation
from underfoot.material.decks import _elastic
from underfoot.material.durometer_scales import SCALES
from underfoot.material.gent_1958 import shore_a_gent, youngs_modulus_gent
from underfoot.material.read import SAME, _moduli, _test_rows
from underfoot.material.ruess import youngs_modulus_ruess
from underfoot.material.spectrum_fit import reduce_spectrum
from underfoot.material.tables import _is_row

FREQUENCY = np.geomspace(0.1, 1e3, 9)
MODULUS = 2e6 * FREQUENCY**0.2 * np.exp(1j * np.linspace(0.1, 0.9, 9))
COLUMNS = {
    "storage modulus": MODULUS.real,
    "loss modulus": MODULUS.imag,
    "loss factor": MODULUS.imag / MODULUS.real,
    "phase angle": np.angle(MODULUS),
    "modulus magnitude": np.abs(MODULUS),
    "complex viscosity": np.abs(MODULUS) / FREQUENCY,
    "storage compliance": (1 / MODULUS).real,
    "loss compliance": -(1 / MODULUS).imag,
}


@pytest.mark.parametrize(
    "names",
    [
        ("storage modulus", "loss modulus"),
        ("storage modulus", "loss factor"),
        ("storage modulus", "phase angle"),
        ("loss modulus", "loss factor"),
        ("loss modulus", "phase angle"),
        ("modulus magnitude", "phase angle"),
        ("modulus magnitude", "loss factor"),
        ("complex viscosity", "phase angle"),
        ("storage compliance", "loss compliance"),
    ],
    ids=" and ".join,
)
def test_two_columns_of_a_sweep_tell_its_complex_modulus(names):
    columns = {name: COLUMNS[name] for name in names}
    table = SimpleNamespace(
        find_column=lambda name: name if name in columns else None, si=columns.get
    )
    storage, loss = _moduli(cast(Any, table), FREQUENCY)
    np.testing.assert_allclose(storage + 1j * loss, MODULUS, rtol=1e-12)


@pytest.mark.parametrize(
    ("options", "card", "shear"),
    [
        (("*ELASTIC",), (3e6, 0.5), 1e6),
        (("*HYPERELASTIC", "NEO HOOKE"), (0.5e6, 1e-9), 1e6),
        (("*HYPERELASTIC", "MOONEY-RIVLIN"), (0.4e6, 0.1e6, 1e-9), 1e6),
        (("*HYPERELASTIC", "OGDEN"), (1e6, 2.0), 1e6),
        (("*HYPERELASTIC", "OGDEN", "N=2"), (0.7e6, 2.0, 0.3e6, -2.0, 1e-9), 1e6),
    ],
    ids=str,
)
def test_a_card_of_a_deck_tells_the_shear_modulus(options, card, shear):
    assert _elastic(options, card, "a deck") == pytest.approx(shear)


def test_a_foam_reads_higher_on_asker_c_than_on_shore_a_and_an_outsole_lower_on_shore_d():
    asker = next(one for one in SCALES if one.name == "Asker C")
    for reading in np.linspace(asker.low, asker.high, 7):
        assert 0 < asker.offset + asker.slope * reading < reading
    shore_d = next(one for one in SCALES if one.name == "Shore D")
    assert shore_d.offset + shore_d.slope * 40.0 == 90.0  # Qi, Joyce and Boyce 2003


def test_a_scaled_spectrum_is_scaled_at_every_time_and_rate():
    one = RelaxationSpectrum(1e6, np.array([2e6, 5e5]), np.array([0.01, 1.0]), source="made up")
    time = np.geomspace(1e-4, 100, 7)
    np.testing.assert_allclose(
        one.scale_moduli(1.7).relaxation_modulus(time), 1.7 * one.relaxation_modulus(time)
    )
    assert one.scale_moduli(1.7).equilibrium_modulus == pytest.approx(1.7e6)


@pytest.mark.parametrize(
    "ask",
    [
        RelaxationSpectrum(1e6, np.array([2e6]), np.array([0.01])).complex_modulus,
        RelaxationSpectrum(1e6, np.array([2e6]), np.array([0.01])).relaxation_modulus,
        youngs_modulus_gent,
        youngs_modulus_ruess,
        shore_a_gent,
    ],
)
def test_one_missing_value_among_good_ones_is_refused(ask):
    good = [50e6, 60e6] if ask is shore_a_gent else [50.0, 60.0]
    assert np.shape(ask(good)) == (2,)
    with pytest.raises(InputError):
        ask([good[0], np.nan])


def test_a_fit_is_believed_between_the_ends_of_its_test():
    time = np.geomspace(0.05, 200.0, 25)
    fit = fit_relaxation(time, 2e6 + 1e6 * np.exp(-time / 3))
    assert fit.frequency_range == pytest.approx((1 / 200.0, 1 / 0.05))


@pytest.mark.parametrize(
    ("cells", "row"),
    [
        (["1", "2.5"], True), (["1", "dry"], True), (["1", "", ""], True),
        (["1", "dry", "rubber"], False), (["dry"], False), ([""], False),
    ],
)  # fmt: skip
def test_a_row_holds_at_least_as_many_numbers_as_words(cells, row):
    assert _is_row(cells) == row


def test_fewer_terms_reach_half_a_decade_beyond_what_they_follow():
    times = np.geomspace(1e-6, 1e6, 49)
    every = RelaxationSpectrum(1e6, 1e6 * times**-0.1, times)  # loss at every rate
    few = reduce_spectrum(every, (0.1, 1e3), terms_per_decade=2).spectrum.relaxation_times
    assert few.min() == pytest.approx(1 / (1e3 * 10**0.5))
    assert few.max() == pytest.approx(10**0.5 / 0.1)


@pytest.mark.parametrize(("rise", "tests"), [(0.1, 1), (0.8 * SAME, 5), (4 * SAME, 5)])
def test_sweeps_on_a_slow_ramp_are_tests_of_their_own(rise, tests):
    """Five sweeps, each ``rise`` (K) warmer: one temperature, a slow ramp, steps."""
    sweep = np.geomspace(0.1, 10, 6)
    kelvin = 293 + rise * np.repeat(np.arange(5), sweep.size)
    assert len(_test_rows(np.tile(sweep, 5), kelvin)) == tests
