"""Films under lugs whose outlines cut cells: loads add up, a ruptured film has one pressure."""

import pytest

from small_pads import pad
from snapshot import held
from underfoot.compute.prepare import prepare_case
from underfoot.sole_contact.sole_state import SolverSettings
from underfoot.sole_contact.stepping import SlidingSole

CUT = {
    "shoe.tread": {"pattern": "bars", "depth": "3 mm", "lug_width": "5.3 mm",
                   "channel_width": "3.9 mm"},
    "shoe.heel.length": "11 mm", "shoe.heel.width": "6 mm", "contaminant.viscosity": "500 cP",
    "motion.shoe_angle": "0 deg", "numerics.grid_spacing": "1 mm",
    "numerics.quick_grid_spacing": "1 mm",
}  # fmt: skip


@pytest.mark.parametrize("cells_along", [1, 2])
def test_a_lug_pressed_into_a_film_and_lifted(file_regression, cells_along):
    parts = prepare_case(pad(CUT, {"numerics.cells_along": cells_along}), 1e-3)
    sole = SlidingSole(
        parts.sole, parts.compliance, parts.asperities, viscosity=0.5,
        settings=SolverSettings(tolerance=1e-6, cavity_pressure=-3e3, rise_time=5e-3),
    )  # fmt: skip
    said = {}
    for force, duration in ((20.0, 3e-3), (1.0, 5e-4)):
        made = sole.advance(duration, normal_force=force, speed=0.1)
        cut = made.wet & (made.cut.film_area != 1)
        assert cut.sum() > 9
        assert made.fluid_load + made.contact_load == pytest.approx(force, rel=1e-6)
        assert made.cell_load.sum() * made.spacing**2 == pytest.approx(force, rel=1e-6)
        finest = made.finest
        loads = [
            (pressure * area).sum() * 1e-6
            for pressure, area in zip(
                (finest.contact_pressure, finest.fluid_pressure),
                (finest.areas["area"], finest.areas["film_area"]),
                strict=True,
            )
        ]
        assert loads == pytest.approx([made.contact_load, made.fluid_load])
        # of what a tolerance leaves no cell bears less than its cavity
        assert finest.fluid_pressure.min() >= -3e3 * (1 + 1e-12)
        said[force] = made
    torn = made.cavitated & cut
    assert torn.sum() > 4
    assert made.fluid_pressure[torn] == pytest.approx(-3e3)
    assert made.liquid_fraction[torn].max() < 1
    held(file_regression, said, f"cells_{cells_along}", hide=r"residuals: .*")
    newton, krylov = {1: (23, 95), 2: (30, 133)}[cells_along]
    assert sole.counts.newton == pytest.approx(newton, abs=2)
    assert sole.counts.krylov == pytest.approx(krylov, rel=0.08)
