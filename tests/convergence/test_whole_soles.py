"""Whole soles from files under the slip tester, on coarse cells and on those of the default."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from outsole_bodies import sole_body, triangles, write_stl
from underfoot.case import Case
from underfoot.compute.run import run
from underfoot.shoe import SoleSurface, Tread, surface_map
from underfoot.shoe.tread_measures import tread_map

MM = 1e-3
TREADS = {
    "hexagons": Tread("hexagons", 8 * MM, 3 * MM, 3.5 * MM),
    "herringbone": Tread("chevrons", 5 * MM, 3 * MM, 3 * MM, angle=0.7, arm_length=15 * MM),
    "circles": Tread("circles", 9 * MM, 3 * MM, 3.5 * MM),
}
SOLES = [*((name, "1 mm") for name in TREADS), ("hexagons", "0.6 mm")]


def sole_file(folder, tread):
    def bottom(x, y):
        return np.where(tread.channel_distance(x, y) > 0, tread.depth, 0.0)

    body = sole_body(bottom, length=0.298, step=0.5 * MM)
    return write_stl(folder / "sole.stl", triangles(body))


@pytest.mark.slow
@pytest.mark.parametrize(("name", "spacing"), SOLES)
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


def test_no_wall_or_tip_of_a_lug_that_is_no_land_stands_near_the_floor():
    """It would be a rigid stud between lugs that give way."""
    height = np.zeros((80, 80))
    height[20:40] = 3 * MM  # a channel
    height[20], height[39] = 1 * MM, 1 * MM  # its walls
    height[29:31, :3] = 0.0  # the tip of a lug, 0.4 mm^2
    tread = tread_map(height, 0.25 * MM)
    assert not tread.land[20:40].any()
    assert tread.land[:20].all()
    assert np.unique(tread.tread_depth[tread.land]) == pytest.approx([3 * MM])
    x = (np.arange(80) + 0.5) * 0.25 * MM
    rim = np.array([[0, -10], [20, -10], [20, 10], [0, 10], [0, -10]]) * MM
    surface = SoleSurface(
        x, x - 10 * MM, height, tread.land, tread.tread_depth, 0.25 * MM, rim, base=tread.base
    )
    sole = surface_map(surface, shoe_angle=0.0, spacing=0.5 * MM)
    channel = sole.inside & ~sole.land
    assert channel.sum() == 10 * 40
    assert sole.clearance[channel] == pytest.approx(3 * MM)
    assert sole.clearance[sole.land] == pytest.approx(0.0)


@pytest.mark.slow
def test_peak_under_a_whole_sole_from_a_file_is_that_of_a_finer_grid(tmp_path):
    """Below twice the modulus (5.0 MPa); tips of lugs at the rim took 25 MPa on 0.6 mm."""
    file, command = tmp_path / "sole.stl", Path(sys.executable).with_name("underfoot")
    make = [command, "outsole", "make", "examples/outsoles/sole_hexagons.toml", "--out", file]
    subprocess.run(make, check=True, capture_output=True)
    peaks = []
    for spacing in ("1 mm", "0.6 mm"):
        result = run(
            Case(
                shoe={
                    "outsole": {"file": str(file)},
                    "material": {"shore_a": 68},
                    "roughness": {"ra": "6 um"},
                },
                floor="vinyl_g4",
                contaminant="glycerol_90pct",
                motion="slip_tester_g4",
                numerics={"grid_spacing": spacing, "tread_positions": 1},
            )
        )
        pressures = [result.data[f"{each}_pressure"].values for each in ("contact", "fluid")]
        assert sum(pressures).max() < 2 * 5.0e6
        peaks.append(result.value("peak_fluid_pressure"))
    assert peaks[0] == pytest.approx(peaks[1], rel=0.2)
