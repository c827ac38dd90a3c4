"""Friction of slides: window, flags, contact before sliding, calibration; the filter's cutoff."""

from dataclasses import replace
from datetime import date

import numpy as np
import pytest
from scipy.signal import freqz, savgol_coeffs

from underfoot.trials.machines.slip_friction import (
    apply_calibration,
    mean_friction,
    slide_friction,
    slide_plate,
)
from underfoot.trials.recording import tester_calibration
from underfoot.trials.recording.protocols import protocol
from underfoot.trials.recording.trial import Channel, Marker, Plate, Trial
from underfoot.trials.walking.slips import SlipDefinition, _half_window, heel_motion

RATE, UP = 1000.0, np.array([0.0, 0.0, 1.0])
CHANNELS = {"normal": (1.1, 0.03, 500.0), "friction": (0.9, 0.04, 300.0)}
RECORD = tester_calibration.TesterCalibration(
    "tester", "no. 1", date(2026, 1, 1), None, 0.02,
    {name: tester_calibration.ChannelCalibration(*values) for name, values in CHANNELS.items()},
)  # fmt: skip


def slide(contact=0.2, onset=0.5, cof=0.3):
    """A shoe set down, held and slid at 0.3 m/s."""
    time = np.arange(0.0, 2.0, 1 / RATE)
    normal = np.where(time >= contact, 500.0, 0.0)
    force = np.column_stack([np.where(time >= onset, cof, 0.0) * normal, 0 * time, normal])
    speed = Channel(np.where(time >= onset, 0.3, 0.0), "m/s", RATE)
    return Trial("slide", {"speed": speed}, (Plate("plate", force, RATE),))


def test_the_time_that_a_shoe_stands_before_it_slides():
    for contact, onset in ((0.2, 0.5), (0.1, 0.9)):
        found = slide_friction(slide(contact, onset), protocol("en_iso_13287"))
        assert found.facts["static_contact_time"] == pytest.approx(onset - contact, abs=2 / RATE)
        assert found.cof.value == pytest.approx(0.3)


def test_the_window_begins_with_the_sample_that_reaches_the_target():
    normal = np.r_[np.full(50, 100.0), np.full(10, 250.0), np.full(50, 300.0)]
    shear = np.r_[np.zeros(50), np.full(10, 50.0), np.full(50, 90.0)]
    found = mean_friction(normal, shear, RATE, target=250.0, window=0.02)
    assert found.value == pytest.approx(0.5 * (50 / 250 + 90 / 300))


@pytest.mark.parametrize(("least", "flags", "refused"), [(240, 0, 0), (200, 1, 0), (30, 0, 1)])
def test_a_force_that_falls_is_flagged_and_a_lift_refused(least, flags, refused):
    normal = np.full(200, 250.0)
    normal[100] = least
    found = mean_friction(normal, 0.2 * normal, RATE, target=250.0)
    assert (len(found.flags), found.value is None) == (flags, bool(refused))


def test_calibration_multiplies_forces_and_adds_its_uncertainty():
    (plain,), whole = slide().plates, slide_plate(slide(), UP, RECORD)
    np.testing.assert_allclose(whole.force, plain.force * [0.9, 0.9, 1.1])
    cof = replace(slide_friction(slide(), protocol("en_iso_13287")).cof, uncertainty=0.01)
    added = apply_calibration(cof, RECORD)
    assert added.uncertainty == pytest.approx(np.hypot(0.01, 0.3 * np.hypot(0.03, 0.04)))


@pytest.mark.parametrize(
    ("rate", "cutoff", "within"), [(120.0, 10.0, 0.17), (250.0, 10.0, 0.05), (1000.0, 24.0, 0.05)]
)
def test_the_window_of_savitzky_and_golay_has_the_cutoff_asked_for(rate, cutoff, within):
    """-3 dB of a third-order smoother, from its coefficients."""
    weights = savgol_coeffs(2 * _half_window(rate, cutoff) + 1, 3)
    frequency, gain = freqz(weights, worN=20000, fs=rate)
    passed = frequency[np.flatnonzero(np.abs(gain) < np.sqrt(0.5))[0]]
    assert passed == pytest.approx(cutoff, rel=within)


def test_a_wave_at_the_cutoff_keeps_its_place_and_half_its_power():
    rate, cutoff = 250.0, 10.0  # of the filter that is the default
    time = np.arange(500) / rate
    wave = np.exp(2j * np.pi * cutoff * time)
    path = np.outer(5e-3 * wave.real, [1.0, 0.0, 0.0]) + np.array([0.1, 0.2, 0.3])
    definition = SlipDefinition(derivative="savitzky-golay")
    motion = heel_motion(Marker(path, rate), UP, definition)
    middle = slice(100, 400)  # 12 waves, off the ends
    passed = 2 * np.mean((motion.position[middle, 0] - 0.1) * wave[middle].conj()) / 5e-3
    assert abs(passed) == pytest.approx(np.sqrt(0.5), rel=0.05)
    assert np.angle(passed) == pytest.approx(0.0, abs=1e-6)
