"""The coupled solver on every tread pattern, as on the plain ones."""

import pytest

from underfoot.case import Case
from underfoot.compute.run import run

BASE = {
    "shoe.tread.depth": "2.5 mm",
    "shoe.tread.lug_width": "6 mm",
    "shoe.tread.channel_width": "2.4 mm",
    "numerics.grid_spacing": "0.6 mm",
    "numerics.quick_grid_spacing": "1 mm",
}
KINDS = {
    "grid": {},
    "blocks": {"shoe.tread.lug_length": "9 mm"},
    "bars": {"shoe.tread.angle": "45 deg"},
    "chevrons": {"shoe.tread.arm_length": "12 mm", "shoe.tread.angle": "30 deg"},
    "circles": {},
    "hexagons": {},
}


@pytest.mark.slow
@pytest.mark.parametrize("pattern", KINDS)
def test_solver_converges_on_the_pattern(pattern):
    case = Case.load("examples/work_shoe_half_tread_glycerol.toml")
    case = case.replace({**BASE, "shoe.tread.pattern": pattern, **KINDS[pattern]})
    found = run(case, quick=True)
    assert found.status.usable
    load = found.scalars["fluid_load"].value
    # lugs of 6 mm carry a film in 219 cP, and never most of the load
    assert load is not None
    assert 20 < load < 250
    # a 10 mm inlet overlaps a channel of every pattern
    sensor = found.scalars["fluid_load_sensor"].value
    assert sensor is not None
    assert sensor < 0.1 * load
