"""A generated heel written as a file and read back is the heel again, within a cell."""

import math

import numpy as np
import pytest

from underfoot.shoe import Facet, Heel, Tread, heel_map, heel_surface, surface_map
from underfoot.shoe.files import FileSettings, outsole_from_file

HEEL = Heel(
    0.064,
    0.060,
    0.028,
    0.020,
    profile=Facet(math.radians(10), 0.03),
    tread=Tread("transverse", 10e-3, 4e-3, 3e-3),
)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["stl", "step"])
def test_generated_heel_is_read_back_as_itself(tmp_path, kind):
    pytest.importorskip("netgen.occ")
    from underfoot.shoe.parametric import write_sole

    path = tmp_path / f"heel.{kind}"
    write_sole(HEEL, path)
    found = outsole_from_file(path, FileSettings(spacing=0.25e-3))
    assert (found.down, found.forward) == ("-z", "+x")
    assert found.thickness == pytest.approx(0.020, abs=1e-3)
    made = heel_surface(HEEL, spacing=0.25e-3)
    assert found.surface.height.shape == made.height.shape
    both = made.land & found.surface.land
    assert both.sum() > 0.97 * made.land.sum()
    assert np.percentile(np.abs(found.surface.height - made.height)[both], 99) < 0.05e-3
    assert (found.surface.inside != made.inside).mean() < 0.01
    angle = math.radians(10)
    exact = heel_map(HEEL, shoe_angle=angle, spacing=0.6e-3)
    floor = surface_map(found.surface, shoe_angle=angle, spacing=0.6e-3)
    assert floor.clearance.shape == exact.clearance.shape
    land = exact.land & floor.land
    assert land.sum() > 0.93 * exact.land.sum()
    # the rear end is known within half a cell of the map, which shifts the facet's heights
    assert np.percentile(np.abs(floor.clearance[land] - exact.clearance[land]), 95) < 0.06e-3
