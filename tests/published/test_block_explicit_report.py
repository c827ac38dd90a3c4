"""Grant report G.1: where the friction of a frictionless, nearly loss-free block can come from."""

from dataclasses import replace

import pytest

from underfoot.block import (
    ExplicitSettings,
    MicroMaterial,
    MicroResult,
    explicit_sliding,
    report_block,
    report_floor,
    report_loading,
    report_material,
)
from underfoot.core import InputError


def test_table_2_bulk_moduli():
    """Printed: neolite 9324 MPa, rubber 2180 MPa; nu = 0.499 with G_inf gives 9324 and 220."""
    assert report_material("neolite").bulk_modulus == pytest.approx(9324e6, rel=1e-3)
    assert report_material("rubber").bulk_modulus == pytest.approx(219.9e6, rel=1e-3)
    assert report_material("rubber", bulk="printed").bulk_modulus == 2180e6
    assert report_material("rubber", bulk="printed").poisson_ratio > 0.4998


def test_table_1_and_block():
    block = report_block("high")
    assert block.size == (0.8e-3, 0.5e-3, 0.5e-3)
    assert block.roughness.peak_to_valley == 35.1e-6
    assert report_floor("medium").peak_to_valley == 24.3e-6
    loading = report_loading(0.25)
    assert (loading.mean_pressure, loading.press_time) == (160e3, 1e-3)
    with pytest.raises(InputError, match="medium"):
        report_floor("middling")


def slide(hourglass: str) -> MicroResult:
    # K lowered to nu = 0.45 and a quarter millimetre (two wavelengths), for speed.
    rubber = MicroMaterial.from_poisson(report_material("rubber").shear, 0.45)
    loading = replace(
        report_loading(1.0), slide_distance=0.25e-3, press_time=0.3e-3, hold_time=0.1e-3
    )
    return explicit_sliding(
        report_block("high", asperities="nodes"),
        report_floor("high", asperities="nodes"),
        rubber,
        loading,
        ExplicitSettings(hourglass=hourglass),
    )


@pytest.mark.slow
def test_viscous_hourglass_control_makes_friction_of_its_own():
    """With peaks on single nodes the roughness is the hourglass mode; the ledger shows the loss."""
    viscous, elastic = slide("viscous"), slide("stiffness")
    means = viscous.averages
    assert means is not None
    assert elastic.averages is not None
    assert means.cof_hysteresis > 2.0 * elastic.averages.cof_hysteresis
    energy = viscous.energy
    assert energy is not None
    moving = viscous.distance > 0.0
    lost = energy.hourglass_loss[-1] - energy.hourglass_loss[moving][0]
    work = energy.floor_work[-1] - energy.floor_work[moving][0]
    assert lost > 0.5 * work
    material = energy.material_loss[-1] - energy.material_loss[moving][0]
    assert material < 1e-3 * work
    assert any("viscous hourglass" in note for note in viscous.notes)
