"""Trends of the grant report's micro-model (G.1.2), with a rubber that has loss where it slides.

The report's one-term materials relax in 40 to 77 s and have no hysteresis at sliding speeds; a
power-law spectrum of the same stiffness is the stand-in (loss tangent 0.16 to 0.19, assumed).
Floors are its checkerboards: peak to valley 16.6, 24.3 and 35.1 um, 0.4 mm, 160 kPa.
"""

import numpy as np
import pytest

from underfoot.material import power_law_spectrum, report_elastomer
from underfoot.rough_contact import steady_sliding
from underfoot.rough_contact.composite import composite_surface
from underfoot.surface import checkerboard, self_affine

# |G*| = 0.44 MPa and 18.66 MPa at 1 rad/s, the report's equilibrium moduli; E = 3 G
RUBBER = power_law_spectrum(3 * 0.44e6, 0.12)
NEOLITE = power_law_spectrum(3 * 18.66e6, 0.10)
FLOORS = (16.6e-6, 24.3e-6, 35.1e-6)
PRESSURE = 160e3


def floor(peak_to_valley, wavelength=0.4e-3):
    return checkerboard(80, 2e-3 / 80, peak_to_valley, wavelength)


def slide(surface, rubber, speed):
    contact = steady_sliding(surface.heights, surface.spacing, rubber, speed, PRESSURE)
    assert contact.status.usable
    return contact


@pytest.mark.parametrize("rubber", [RUBBER, NEOLITE], ids=["rubber", "neolite"])
def test_rougher_floor_has_less_contact_and_more_hysteresis(rubber):
    found = [slide(floor(height), rubber, 0.1) for height in FLOORS]
    area = [contact.real_contact_fraction_corrected for contact in found]
    cof = [contact.cof_hysteresis for contact in found]
    assert area[0] > area[1] > area[2]
    assert cof[0] < cof[1] < cof[2]


def test_size_of_the_floor_effect_on_rubber_hysteresis():
    """The report: +164 to +170 % from 16.6 to 35.1 um; here more than doubled."""
    smooth, rough = (slide(floor(height), RUBBER, 0.1).cof_hysteresis for height in FLOORS[::2])
    assert 0.9 < rough / smooth - 1 < 1.8


@pytest.mark.parametrize("height", FLOORS)
def test_contact_area_of_rubber_falls_with_speed_as_much_as_in_the_report(height):
    """The report: A_c/F_N falls by 12 to 25 % from 0.1 to 1 m/s (rubber, all roughness pairs)."""
    both = composite_surface(floor(height), floor(12.1e-6, 0.5e-3))
    slow, fast = (slide(both, RUBBER, speed) for speed in (0.1, 1.0))
    change = fast.real_contact_fraction_corrected / slow.real_contact_fraction_corrected - 1
    assert -0.25 < change < -0.12


def test_rougher_shoe_has_less_contact():
    """The report: A_c/F_N falls with the shoe's roughness, -14 to -36 %."""
    area = [
        slide(
            composite_surface(floor(24.3e-6), floor(shoe, 0.5e-3)), NEOLITE, 0.1
        ).real_contact_fraction_corrected
        for shoe in (12.1e-6, 35.1e-6)
    ]
    assert -0.36 < area[1] / area[0] - 1 < -0.14


@pytest.mark.parametrize("name", ["rubber", "neolite"])
@pytest.mark.parametrize("speed", [0.1, 1.0])
def test_the_reports_own_material_has_no_hysteresis_and_the_result_says_why(name, speed):
    contact = slide(floor(24.3e-6), report_elastomer(name).spectrum, speed)
    assert abs(contact.cof_hysteresis) < 1e-6
    assert any("loss tangent is at most" in note for note in contact.notes)


def test_the_same_trends_on_a_surface_with_many_scales():
    found = {
        (rms, speed): slide(self_affine(96, 4e-6, rms, 0.8, 192e-6, 32e-6, seed=0), RUBBER, speed)
        for rms in (2e-6, 4e-6, 8e-6)
        for speed in (0.01, 1.0)
    }
    area = {key: contact.real_contact_fraction_corrected for key, contact in found.items()}
    cof = {key: contact.cof_hysteresis for key, contact in found.items()}
    for speed in (0.01, 1.0):
        assert area[2e-6, speed] > area[4e-6, speed] > area[8e-6, speed]
        assert cof[2e-6, speed] < cof[4e-6, speed] < cof[8e-6, speed]
    for rms in (2e-6, 4e-6, 8e-6):
        assert area[rms, 0.01] > area[rms, 1.0]


def test_shoe_roughness_at_rest_is_overrated_by_the_composite():
    """Two bounds that the composite's limits name: floor alone and both moving together."""
    alone = slide(floor(24.3e-6), RUBBER, 0.1)
    both = slide(composite_surface(floor(24.3e-6), floor(35.1e-6, 0.5e-3)), RUBBER, 0.1)
    assert both.cof_hysteresis > alone.cof_hysteresis
    assert both.real_contact_fraction_corrected < alone.real_contact_fraction_corrected
    assert np.isfinite(alone.mean_gap)
