"""A drawn outsole turned in space is the same sole: its land, its size, its film."""

import ast
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from soles_solved import sole_of_mesh
from underfoot.shoe.files.mesh import Mesh
from underfoot.shoe.files.outsole import outsole_from_mesh
from underfoot.shoe.files.read import read_mesh

HEEL = Path(__file__).parents[2] / "examples" / "measured" / "heel.stl"
WITHIN = 0.003
"""Share of the plan form by which the land may differ: what cells explain."""


def turned(mesh: Mesh, rotation: Rotation) -> Mesh:
    corners = mesh.triangles.astype(np.float64) @ rotation.as_matrix().T
    return replace(mesh, triangles=corners.astype(np.float32))


def land_share(mesh: Mesh) -> tuple[float, tuple[int, ...]]:
    surface = sole_of_mesh(mesh).outsole.surface
    return surface.land.sum() / surface.inside.sum(), surface.land.shape


@pytest.mark.parametrize(
    "rotation",
    [
        *Rotation.random(2, random_state=7),
        # nearer to an axis of the file than that is taken for a direction drawn along it
        Rotation.from_euler("xyz", [16.0, 5.0, 30.0], degrees=True),
        Rotation.from_euler("xyz", [3.0, -12.0, 100.0], degrees=True),
    ],
    ids=["1", "2", "16 deg off an axis", "12 deg off an axis"],
)
def test_a_sole_turned_in_space_keeps_its_land(rotation):
    mesh = read_mesh(HEEL, "auto")
    share, shape = land_share(mesh)
    after, cells = land_share(turned(mesh, rotation))
    assert after == pytest.approx(share, abs=WITHIN)
    assert cells == shape


@pytest.mark.parametrize("degrees", [1.0, -7.0, 12.0])
def test_a_heel_turned_in_plan_is_the_same_heel(degrees):
    mesh = read_mesh(HEEL, "auto")
    share, shape = land_share(mesh)
    after = turned(mesh, Rotation.from_euler("z", degrees, degrees=True))
    assert land_share(after) == (pytest.approx(share, abs=WITHIN), shape)
    assert sole_of_mesh(mesh).outsole.forward == "+x"
    along = np.array(ast.literal_eval(sole_of_mesh(after).outsole.forward))
    assert along == pytest.approx(
        [np.cos(np.deg2rad(degrees)), np.sin(np.deg2rad(degrees)), 0], abs=0.006
    )


def test_a_scan_of_a_heel_that_is_not_quite_alike_stays_as_drawn():
    mesh = read_mesh(HEEL, "auto")
    places, which = np.unique(mesh.triangles.reshape(-1, 3), axis=0, return_inverse=True)
    moved = places + np.random.default_rng(0).normal(0.0, 0.05, places.shape)
    rough = replace(mesh, triangles=moved[which].reshape(-1, 3, 3).astype(np.float32))
    assert outsole_from_mesh(rough).forward == "+x"
