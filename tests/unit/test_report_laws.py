"""Laws, tables and models of the lower rooms draw themselves with what they return."""

import numpy as np
import pytest

from underfoot.core import SourcedValue
from underfoot.friction import StribeckLaw
from underfoot.friction.law import PIN_PRESSURE
from underfoot.material import RelaxationSpectrum
from underfoot.rough_contact import ExponentialLaw, steady_sliding
from underfoot.slip import ReportG6, slip_risk


def line(shown, number=0):
    """Return x and y of a line of the object's figure."""
    return shown.plot().axes[0].lines[number].get_xydata().T


def test_the_figure_of_a_friction_law_is_its_cof():
    law = StribeckLaw(SourcedValue(0.5), SourcedValue(0.2, "m/s"), SourcedValue(0.1))
    speed, cof = line(law)
    parts = law(np.full(speed.size, PIN_PRESSURE), speed, np.full(speed.size, 1e-3))
    assert cof == pytest.approx(parts.total / PIN_PRESSURE)
    assert cof[0] > cof[-1]


def test_the_figure_of_a_pressure_gap_law_is_its_pressure():
    law = ExponentialLaw(3e6, 0.5, 4e-6)
    gap, pressure = line(law)
    assert pressure == pytest.approx(law.pressure(1e-6 * gap))


def test_the_figure_of_a_slip_model_and_of_a_risk():
    difference, percent = line(ReportG6())
    assert percent == pytest.approx(100.0 * ReportG6()(0.3 + difference, 0.3))
    risk = slip_risk(SourcedValue(0.2, uncertainty=0.02))
    assert line(risk, 1)[1][0] == pytest.approx(100.0 * risk.probability.value)


def test_the_figures_of_a_spectrum_and_of_a_contact():
    spectrum = RelaxationSpectrum(1e6, [2e6], [1e-2])
    frequency, storage = line(spectrum)
    assert storage == pytest.approx(spectrum.storage_modulus(frequency))
    x = np.arange(32) / 32
    heights = 1e-6 * np.cos(2 * np.pi * x)[:, None] * np.cos(2 * np.pi * x)[None, :]
    contact = steady_sliding(heights, 1e-5, 2e6, 0.0, 1e4)
    image = contact.plot().axes[0].images[0].get_array()
    assert np.asarray(image) == pytest.approx(1e-6 * contact.pressure.T)
