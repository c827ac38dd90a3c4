"""Whole soles from files under the slip tester, on coarse cells and on those of the default."""

import numpy as np
import pytest

from outsole_bodies import sole_body, triangles, write_stl
from underfoot.case import Case
from underfoot.compute.run import run
from underfoot.shoe import Tread

MM = 1e-3
TREADS = {
    "hexagons": Tread("hexagons", 8 * MM, 3 * MM, 3.5 * MM),
    "herringbone": Tread("chevrons", 5 * MM, 3 * MM, 3 * MM, angle=0.7, arm_length=15 * MM),
    "circles": Tread("circles", 9 * MM, 3 * MM, 3.5 * MM),
}
SLOW = [
    pytest.param(*each, marks=pytest.mark.slow)
    for each in [*((name, "1 mm") for name in TREADS if name != "hexagons"), ("hexagons", "0.6 mm")]
]


def sole_file(folder, tread):
    def bottom(x, y):
        return np.where(tread.channel_distance(x, y) > 0, tread.depth, 0.0)

    body = sole_body(bottom, length=0.298, step=0.5 * MM)
    return write_stl(folder / "sole.stl", triangles(body))


@pytest.mark.parametrize(("name", "spacing"), [("hexagons", "1 mm"), *SLOW])
def test_a_whole_sole_converges(tmp_path, name, spacing):
    case = Case(
        name=name,
        shoe={
            "outsole": {"file": str(sole_file(tmp_path, TREADS[name]))},
            "material": {"shore_a": 60},
            "roughness": {"ra": "7 um"},
        },
        floor="vinyl_g4",
        contaminant="glycerol_90pct",
        motion={"from": "slip_tester_g4"},
        numerics={"grid_spacing": spacing, "tread_positions": 1, "grid_check": False},
    )
    found = run(case)
    data = found.data
    cells = [data[f"cell_{each}"].values for each in ("area", "film_area")]
    assert all(each.min() > 0 for each in cells)
    assert found.usable, found.headline()
    assert not found.labels.get("sipes"), "what the outline leaves of a channel is no sipe"
    pressures = [data[f"{each}_pressure"].values for each in ("contact", "fluid")]
    load = sum((p * a).sum() for p, a in zip(pressures, cells, strict=True))
    assert load * float(spacing[:-3]) ** 2 * 1e-6 == pytest.approx(500.0, rel=1e-3)
    assert 0 < found.scalars["cof"].value < 0.3
