"""Closed forms of contact and of films: values, limits on both sides, what they refuse."""

import math

import numpy as np
import pytest

from snapshot import held, refusal
from underfoot.reference import lubrication
from underfoot.reference.contact import (
    bonded_layer_compliance,
    half_space_compliance,
    hertz_line,
    hertz_point,
    hertz_point_pressure,
    sinusoid_contact_fraction,
    sinusoid_full_contact_pressure,
    sinusoid_gap,
    sinusoid_mean_gap,
    sinusoid_pressure,
    sliding_checkerboard_cof,
    sliding_sinusoid_cof,
)
from underfoot.reference.lubrication import (
    inclined_bearing_load,
    inclined_bearing_pressure,
    parabolic_bearing_load,
    soft_ehl_film,
    squeeze_disc_gap,
    squeeze_disc_load,
    squeeze_disc_pressure,
    step_bearing_load,
    tapered_wedge_load,
)

X = np.linspace(-0.6e-4, 0.6e-4, 12)
CLOSING = sinusoid_full_contact_pressure(1e-6, 1e-4, 5e6)
WAVES = np.array([0.0, 0.05, 0.2, 50, 500, 1e5, 1e6])
SHARES = (0.0, 0.2, 0.7, 1.0, 1.5)


def test_dry_contact(file_regression):
    ball = hertz_point(10.0, 0.01, 5e6)
    answers = {
        "ball": ball, "line": hertz_line(1e3, 0.01, 5e6),
        "pressure": hertz_point_pressure(np.linspace(0, 3e-3, 7), ball), "closing": CLOSING,
        "fraction": sinusoid_contact_fraction(np.array(SHARES) * CLOSING, CLOSING),
        "mean gap": sinusoid_mean_gap(np.array(SHARES) * CLOSING, 1e-6, CLOSING),
        "pressures": [sinusoid_pressure(X, s * CLOSING, 1e-4, CLOSING) for s in SHARES],
        "gaps": [sinusoid_gap(X, s * CLOSING, 1e-6, 1e-4, CLOSING) for s in SHARES],
        "sliding": sliding_sinusoid_cof([6e5, 9e5], 1e-6, 1e-4, 5e6 + 2e6j),
        "board": sliding_checkerboard_cof([6e5, 9e5], 1e-6, 1e-4, 5e6 + 2e6j),
        "half space": half_space_compliance(np.array([1e2, 1e3, 1e4]), 5e6),
        "layer": [bonded_layer_compliance(WAVES, 0.01, 5e6, nu)
                  for nu in (0.3, 0.499, 0.5)],
    }  # fmt: skip
    answers["refused"] = [
        refusal(hertz_point, 0.0, 0.01, 5e6), refusal(hertz_point, 1.0, -0.01, 5e6),
        refusal(hertz_line, 1.0, 0.01, math.inf), refusal(sinusoid_full_contact_pressure, 0, 1, 1),
        refusal(sinusoid_pressure, X, -1.0, 1e-4, CLOSING),
        refusal(sliding_sinusoid_cof, 1.6e5, 1e-6, 1e-4, 5e6 + 2e6j),
        refusal(sliding_checkerboard_cof, 2.3e5, 1e-6, 1e-4, 5e6 + 2e6j),
        refusal(bonded_layer_compliance, 1.0, 0.0, 5e6, 0.4),
        refusal(bonded_layer_compliance, 1.0, 0.01, 5e6, 0.51),
        refusal(bonded_layer_compliance, 1.0, 0.01, 5e6, -1.0),
    ]  # fmt: skip
    least = math.pi / 1e-4 * 1e-6 * abs(5e6 + 2e6j)
    sliding_sinusoid_cof(least, 1e-6, 1e-4, 5e6 + 2e6j)
    sliding_checkerboard_cof(math.sqrt(2) * least, 1e-6, 1e-4, 5e6 + 2e6j)
    bonded_layer_compliance(1.0, 0.01, 5e6, -0.99)
    held(file_regression, answers)


def test_a_sinusoid_carries_its_mean_pressure():
    x = (np.arange(4000) + 0.5) / 4000 * 1e-4
    for share in SHARES[1:]:
        mean = sinusoid_pressure(x, share * CLOSING, 1e-4, CLOSING).mean()
        assert mean == pytest.approx(share * CLOSING, rel=1e-3)


BEARING = {"viscosity": 0.1, "speed": 1.0, "length": 0.01, "leading_gap": 2.5e-4,
           "trailing_gap": 1e-4}  # fmt: skip
DISC = {"viscosity": 0.1, "radius": 0.01}


def test_films(file_regression):
    place = np.linspace(0, 0.01, 11)
    pressure = inclined_bearing_pressure(place, **BEARING)
    film = {"viscosity": 0.05, "load": 5.0, "radius": 0.01, "effective_modulus": 1e7}
    answers = {
        "inclined": inclined_bearing_load(**BEARING), "pressure": pressure,
        "parabolic": parabolic_bearing_load(**BEARING),
        "step": [step_bearing_load(**BEARING, leading_share=s) for s in (0.3, 0.72)],
        "leakage": lubrication.SIDE_LEAKAGE, "taper": lubrication.BEST_TAPER,
        "wedge": tapered_wedge_load(**BEARING, width=0.02, leakage=0.7),
        "disc": squeeze_disc_load(**DISC, gap=1e-4, closing_speed=1e-3),
        "under": squeeze_disc_pressure(np.array([0.0, 4e-3, 0.01]), **DISC, gap=1e-4,
                                       closing_speed=1e-3),
        "sinking": squeeze_disc_gap(np.array([0.0, 0.01, 1.0]), **DISC, start_gap=1e-4, load=10.0),
        "soft": soft_ehl_film(**film, entrainment_speed=np.array([0.1, 0.4])),
        "ellipse": soft_ehl_film(**film, entrainment_speed=0.1, ellipticity=2.5),
    }  # fmt: skip
    held(file_regression, answers)
    fine = np.linspace(0, 0.01, 20_001)
    load = np.trapezoid(inclined_bearing_pressure(fine, **BEARING), fine)
    assert load == pytest.approx(answers["inclined"], rel=1e-6)
    gaps = np.array([1.0, 1.0 + lubrication.BEST_TAPER - 1e-3, 1.0 + lubrication.BEST_TAPER + 1e-3])
    best = inclined_bearing_load(**(BEARING | {"leading_gap": (1 + lubrication.BEST_TAPER) * 1e-4}))
    for gap in gaps[1:]:
        assert inclined_bearing_load(**(BEARING | {"leading_gap": gap * 1e-4})) < best
    radii = np.linspace(0, 0.01, 20_001)
    under = squeeze_disc_pressure(radii, **DISC, gap=1e-4, closing_speed=1e-3)
    assert np.trapezoid(under * 2 * math.pi * radii, radii) == pytest.approx(
        answers["disc"], rel=1e-6
    )
    assert math.isfinite(pressure.max())
