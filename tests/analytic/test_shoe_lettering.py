"""Letters as lugs: distances, share of land, and the solid, against brute force and polygons."""

import numpy as np
import pytest

from underfoot.case.sole import LetteringTread
from underfoot.core import InputError, UnderfootError
from underfoot.shoe import Heel, Tread, heel_surface
from underfoot.shoe.parametric import sole_solid, solid, write_sole

SPACING = 5e-5
KIND = {"length": 0.06, "width": 0.06, "rear_radius": 0.0, "outsole_thickness": 0.025}


def tread(text, height=8e-3, gap=2e-3, **more):
    option = LetteringTread(
        pattern="lettering", text=text, lug_width=height, channel_width=gap, depth=2e-3, **more
    )
    found = option.build()
    assert isinstance(found, Tread)
    return found


def grid(pattern, periods=(1, 1)):
    along, across = np.abs(pattern.periods).max(axis=0) * periods
    x, y = (np.arange(SPACING / 2, size, SPACING) for size in (along, across))
    return np.meshgrid(x, y, indexing="ij")


@pytest.mark.parametrize("text", ["GRIP", "B8 ö", "a&Q"])
def test_distance_is_that_to_the_nearest_wall(text):
    pattern = tread(text)
    assert pattern.letters is not None
    walls = pattern.letters.segments.reshape(-1, 2, 2)
    pitch = pattern.letters.pitch
    walls = np.concatenate([walls + pitch * (i, j) for i in range(-2, 3) for j in range(-2, 3)])
    begin, way = walls[:, 0], walls[:, 1] - walls[:, 0]
    place = np.random.default_rng(1).uniform(size=(800, 1, 2)) * pitch + pattern.letters.corner
    share = ((place - begin) * way).sum(axis=2) / (way * way).sum(axis=1)
    beside = place - begin - np.clip(share, 0, 1)[..., None] * way
    nearest = np.hypot(beside[..., 0], beside[..., 1]).min(axis=1)
    found = pattern.channel_distance(*place[:, 0].T)
    assert np.abs(found) == pytest.approx(nearest, abs=1e-6)


@pytest.mark.parametrize("text", ["GRIP", "O", "B8 ö"])
def test_share_of_land_is_the_area_of_the_letters(text):
    pattern = tread(text)
    shares = (pattern.channel_distance(*grid(pattern)) <= 0).mean()
    assert shares == pytest.approx(pattern.land_ratio, rel=0.01)
    assert pattern.letters is not None
    from matplotlib.path import Path as Outline

    by_outline = np.zeros(grid(pattern)[0].size, dtype=bool)
    x, y = grid(pattern)
    place = np.column_stack([x.ravel(), y.ravel()])
    place = pattern.letters.corner + np.mod(place - pattern.letters.corner, pattern.letters.pitch)
    for ring in (*pattern.letters.shells, *pattern.letters.holes):
        by_outline ^= Outline(np.array(ring)).contains_points(place)
    assert by_outline.mean() == pytest.approx(shares, abs=2e-3)


def test_text_reads_from_heel_to_toe_seen_from_below():
    # the L: its stem at the rear, its foot (bottom of the letter) at larger y
    land = tread("L").channel_distance(*np.meshgrid([1e-3, 4e-3], [-3.5e-3, 3.5e-3])) <= 0
    assert land.tolist() == [[True, False], [True, True]]  # rows: y, columns: x


def test_pattern_repeats_by_its_periods():
    pattern = tread("GRIP", angle=0.3)
    rng = np.random.default_rng(0)
    x, y = rng.uniform(-0.03, 0.03, (2, 500))
    for shift in pattern.periods:
        moved = pattern.channel_distance(x + shift[0], y + shift[1])
        assert moved == pytest.approx(pattern.channel_distance(x, y), abs=1e-7)


def test_solid_and_map_are_one_description():
    heel = Heel(**KIND, tread=tread("PO", 22e-3, 5e-3, angle=0.2))
    surface = heel_surface(heel, spacing=0.25e-3)
    made = sole_solid(heel)
    # the slab less the channels' depth over what is not land
    channels = (1 - surface.land_ratio) * heel.plan_area * 2e-3
    slab = sole_solid(Heel(**KIND)).volume
    assert made.volume == pytest.approx(slab - channels, rel=1e-3)
    assert slab - made.volume == pytest.approx(channels, rel=5e-3)


@pytest.mark.parametrize("text", ["", " ", "@", "x" * 25, "日本"])
def test_text_that_can_not_be_moulded_is_refused(text):
    from underfoot.compute.sole import outsole_from

    sizes = {"lug_width": "12 mm", "channel_width": "3 mm", "depth": "2 mm"}
    with pytest.raises(InputError, match="text"):
        outsole_from({"tread": {"pattern": "lettering", "text": text, **sizes}})


def test_a_refused_mesh_is_not_left_on_disk(tmp_path, monkeypatch):
    import trimesh

    box = trimesh.creation.box()
    box.update_faces(np.arange(len(box.faces)) > 3)
    monkeypatch.setattr(solid, "sole_mesh", lambda made: box)
    with pytest.raises(UnderfootError, match="watertight"):
        write_sole(Heel(**KIND), tmp_path / "sole.stl")
    assert not list(tmp_path.iterdir())


def test_triangles_back_to_back_are_taken_out():
    faces = np.array([[0, 1, 2], [3, 4, 5], [2, 1, 0], [1, 2, 3]])
    assert solid._without_pairs(faces).tolist() == [[3, 4, 5], [1, 2, 3]]
