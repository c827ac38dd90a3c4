"""A free tread as a file for others: read again, it has the heights, widths and draft asked for."""

import json
import math
from pathlib import Path

import numpy as np
import pytest
from scipy.ndimage import distance_transform_edt

from commands import called
from underfoot.case import load
from underfoot.compute.sole import new_sole
from underfoot.shoe.parametric.mould import write_drafted

pytest.importorskip("netgen")
trimesh = pytest.importorskip("trimesh")
pytestmark = pytest.mark.slow

EXAMPLES = Path(__file__).parents[2] / "examples"
DEPTH, DRAFT, SPACING = 3e-3, math.radians(3), 1e-4
FORMS = {
    "a network with an island in each pocket": {
        "cos1_cos0": 0.8,
        "cos0_cos1": 0.8,
        "cos1_cos1": 1.0,
        "cos2_cos0": 0.7,
        "cos0_cos2": 0.7,
    },
    "bars that end nowhere": {"cos1_cos0": 1.0, "sin1_cos1": 0.6, "cos1_cos2": -0.4},
    "lugs": {"cos1_cos1": 1.0, "cos0_cos1": 0.3},
}


def case(terms):
    tread = {"pattern": "free", "depth": DEPTH, "land": 0.55, "lug_width": 3e-3, **terms}
    tread |= {"channel_width": 2.5e-3, "cell_length": 0.02, "cell_width": 0.02}
    heel = {"length": "44 mm", "width": "40 mm", "rear_radius": "12 mm", "edge_radius": "0 mm"}
    heel |= {"profile": {"model": "facet", "angle": "8 deg", "length": "15 mm"}}
    one = load(EXAMPLES / "work_shoe_full_tread_detergent.toml")
    return one.replace({"shoe.tread": tread | {"mould_draft": DRAFT}, "shoe.heel": heel})


def bottom(path, x, y):
    """Return the lowest height (m) of a mesh in mm over the places of a grid."""
    from underfoot.shoe._kernels.height_buffer import height_buffer

    mesh = trimesh.load_mesh(str(path))
    assert mesh.is_watertight
    triangles = np.asarray(mesh.triangles, dtype=np.float32)
    first = (float(x[0]), float(y[0]))
    return height_buffer(triangles, np.eye(3) / 1e3, first, SPACING, (x.size, y.size))[0]


def beyond_discs(mask, width):
    """Return how far (m) the farthest place of a mask lies from the discs of a width within it."""
    inside = (distance_transform_edt(mask) - 0.5) * SPACING >= width / 2 - SPACING / 2
    return distance_transform_edt(~inside) * SPACING - (width / 2 - SPACING / 2), inside.any()


@pytest.mark.parametrize("form", FORMS)
def test_files_hold_the_tread(form, tmp_path):
    from underfoot.shoe.parametric import sole_solid, write_sole

    shape = new_sole(case(FORMS[form]))
    solid = sole_solid(shape)
    step = write_sole(shape, tmp_path / "sole.step", solid=solid)  # reads it back
    assert step.read_volume == pytest.approx(step.volume, rel=1e-6)
    write_sole(shape, tmp_path / "upright.stl", solid=solid)
    write_drafted(shape, solid, DRAFT, tmp_path / "drafted.stl")
    x = np.arange(SPACING / 2, shape.length, SPACING)
    y = np.arange(SPACING / 2 - shape.width / 2, shape.width / 2, SPACING)
    place = np.meshgrid(x, y, indexing="ij")
    into, land = shape.tread.channel_distance(*place), shape.unworn_height(*place)
    within = shape.inward_distance(*place) > 0.3e-3
    for name, slope in (("upright", 0.0), ("drafted", math.tan(DRAFT))):
        height = bottom(tmp_path / f"{name}.stl", x, y)
        wall = (into > -3e-5) & (into < DEPTH * slope + 3e-5)  # there 0.03 mm aside are all depth
        rise = np.minimum(DEPTH, into / slope) if slope else np.full_like(into, DEPTH)
        expected = land + np.where(into > 0, rise, 0.0)
        assert np.abs(height - expected)[within & ~wall].max() < 5e-5
        assert wall.mean() < 0.2
    # smallest land and channel of the upright file, away from where the rim cuts them
    height = bottom(tmp_path / "upright.stl", x, y)
    middle = shape.inward_distance(*place) > 4e-3
    lug = within & (height - land < DEPTH / 2)
    for mask, width in ((lug, 3e-3), (within & ~lug, 2.5e-3)):
        away, any_disc = beyond_discs(mask, width)
        assert any_disc
        assert away[mask & middle].max() < 2 * SPACING


def test_the_reader_of_outsoles_sees_draft_land_and_depth(tmp_path):
    from underfoot.shoe.files import FileSettings, outsole_from_file
    from underfoot.shoe.parametric import sole_solid
    from underfoot.shoe.tread_measures import tread_measures

    # on a bevel the reader's base, a paraboloid rolled under the sole, lies a little off the land
    flat = case(FORMS["bars that end nowhere"]).replace("shoe.heel.profile", {"model": "flat"})
    shape = new_sole(flat)
    write_drafted(shape, sole_solid(shape), DRAFT, tmp_path / "sole.stl")
    read = outsole_from_file(tmp_path / "sole.stl", FileSettings(unit="mm", down="-z"))
    measures = tread_measures(read.surface)
    assert read.draft == pytest.approx(DRAFT, abs=math.radians(0.3))
    assert measures.channel_depth[1] == pytest.approx(DEPTH, abs=5e-5)
    x, y = read.surface.x, read.surface.y - read.surface.y.mean()
    drawn = shape.tread.channel_distance(*np.meshgrid(x, y, indexing="ij")) <= 0
    inside = read.surface.inside
    assert (read.surface.land != drawn)[inside].mean() < 0.05


def test_a_study_varies_it_and_gives_it_away(tmp_path):
    text = (EXAMPLES / "studies" / "free_tread.toml").read_text()
    text = text.replace("../", f"{EXAMPLES.as_posix()}/").replace("budget = 156", "budget = 4")
    for old in ('"1.25 mm"', '"1 mm"'):
        text = text.replace(f'grid_spacing" = {old}', 'grid_spacing" = "1.25 mm"')
    text = text.replace("[vary]", '"numerics.tread_positions" = 1\n[vary]').replace(
        'kind = "optimise"', 'kind = "sweep"'
    )
    (tmp_path / "free.toml").write_text(text)
    called("study", "run", "free.toml", "--workers", "1", folder=tmp_path)
    told = json.loads(called("study", "status", "out/free", "--json", folder=tmp_path).stdout)
    assert told["endings"]["computed"] >= 3
    best = json.loads(called("study", "best", "out/free", "--json", folder=tmp_path).stdout)
    assert len({row["goals"][0] for row in best}) == len(best) >= 3  # the coefficients matter
    called("study", "export", "out/free", "given", "--count", "1", folder=tmp_path)
    (path,) = (tmp_path / "given").glob("*.toml")
    assert load(path).shoe.tread.name == "free"
    for kind in ("step", "stl"):
        assert path.with_suffix(f".{kind}").stat().st_size > 1e4
    assert trimesh.load_mesh(str(path.with_suffix(".stl"))).is_watertight
