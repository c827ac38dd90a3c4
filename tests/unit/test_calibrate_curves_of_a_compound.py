"""Several relaxation tests are one curve; a hold is read at even steps of log time."""

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.calibrate.compound import Compound, _beside, _relaxation_curve, relaxation_of
from underfoot.core import SourcedValue
from underfoot.material.curves import RelaxationCurve


def curve(first, last, scale, temperature=296.0):
    time = np.geomspace(first, last, 400)
    return RelaxationCurve(time, scale * time**-0.1, temperature)


def test_tests_at_one_temperature_are_averaged_where_all_of_them_have_readings():
    mean, shifts, temperature = _relaxation_curve([curve(1, 100, 2e6), curve(3, 40, 4e6)], None)
    assert shifts is None
    assert temperature == 296.0
    assert mean.time[[0, -1]] == pytest.approx([3.0, 40.0])
    assert mean.modulus == pytest.approx(3e6 * mean.time**-0.1, rel=1e-3)
    alone, _, _ = _relaxation_curve([curve(1, 100, 2e6)], None)
    assert alone.time[[0, -1]] == pytest.approx([1.0, 100.0])


def test_a_hold_is_read_from_its_first_instant_to_its_last_against_its_own_peak():
    time = 0.01 * np.arange(5001)
    share = (1 + time) ** -0.2
    low, peak = 5.0, 105.0
    test: Any = SimpleNamespace(
        reading=SimpleNamespace(
            hold=(time, low + (peak - low) * share), force_2_percent=SourcedValue(low),
            peak_force=SourcedValue(peak),
        ),
        moduli=SimpleNamespace(short_time_modulus=6e6), factor=1.5, name="made",
    )  # fmt: skip
    read = relaxation_of(test)  # the last part has its reading at its end, 1 % in time off
    assert read.time[[0, -1]] == pytest.approx([0.01, 50.0])
    assert read.modulus == pytest.approx(4e6 * (1 + read.time) ** -0.2, rel=3e-3)
    late = read.time > 1
    assert np.diff(np.log(read.time[late])).std() < 0.2 * np.diff(np.log(read.time[late])).mean()


def test_a_sweep_and_a_relaxation_test_that_share_no_time_are_not_compared():
    """Up to 1 s (1 rad/s) by one, from 1.5 s on by the other."""

    def fitted(low, high):
        spectrum = SimpleNamespace(relaxation_modulus=lambda time: 1e6)
        return cast(Any, SimpleNamespace(frequency_range=(low, high), spectrum=spectrum))

    assert "share no time" in _beside(fitted(1.0, 100.0), fitted(1e-3, 1 / 1.5))
    assert "1.00 times" in _beside(fitted(1.0, 100.0), fitted(1e-3, 1 / 0.8))


@pytest.mark.parametrize(
    ("tested", "first", "last"),
    [(None, 1e-2, 1e6), ((0.2, 20.0), 1e-2, 1e6), ((7e3, 7e7), 1e2, 1e8)],
)
def test_losses_are_shown_at_whole_decades_of_what_was_tested_and_of_sliding(tested, first, last):
    """Waves of 0.8 mm to 2.5 um at 0.3 m/s pass 375 to 120,000 times a second."""
    shown = []
    made: Any = SimpleNamespace(
        spectrum=object(),
        tested=tested,
        fit=None,
        _loss=lambda n, w, band: shown.append(w) or ("",),
    )
    Compound._losses(made)
    hertz = np.array(shown) / (2 * np.pi)
    assert hertz[[0, -1]] == pytest.approx([first, last])
    assert np.diff(np.log10(hertz)) == pytest.approx(1.0)
