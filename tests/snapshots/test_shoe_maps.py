"""Soles on cells: maps over the floor, cells in rows, slits, drainage of lugs, places of treads."""

import math
from dataclasses import replace

import numpy as np
import pytest

from snapshot import held, refusal
from underfoot.shoe import grids
from underfoot.shoe.cut_cells import CutCells, cut_cells, with_least_area
from underfoot.shoe.drawn_surface import drawn_surface, rounded_rims
from underfoot.shoe.geometry import SoleMap, SoleSurface, centred_places
from underfoot.shoe.grids import (
    floor_lines,
    heel_map,
    heel_surface,
    place_on_floor,
    resolution_breaches,
    surface_map,
)
from underfoot.shoe.lug_drainage import LugDrainage, across_text, lug_drainage
from underfoot.shoe.parametric.sole import ShoeOutline, ToeSpring, WholeSole
from underfoot.shoe.row_cells import RowCells
from underfoot.shoe.row_division import row_cells
from underfoot.shoe.shape import Facet, Heel, Rocker
from underfoot.shoe.slits import slit_drainage, without_slits
from underfoot.shoe.tread import ArcChannel, Sipes, Tread
from underfoot.shoe.tread_measures import (
    arch_area,
    channel_depth,
    floor_depth,
    height_noise,
    largest_patch,
    lower_lugs,
    reached_by_floor,
    surface_without_slits,
    tread_map,
    tread_measures,
    without_noise,
)
from underfoot.shoe.tread_place import tread_place
from underfoot.shoe.tread_shift import carried_base, moved_tread, tread_periods
from underfoot.shoe.tread_shift import tread_place as place_of_waves
from underfoot.shoe.worn.forms import WearPlane, WornPatch
from underfoot.shoe.worn.surface import worn_surface

HEEL = Heel(0.031, 0.026, 0.009, 0.012, edge_radius=1e-3)
GRID = Tread("grid", 6e-3, 3.1e-3, 3e-3, offset=(1e-3, 0.5e-3))
HEELS = {
    "plain": HEEL,
    "grid": replace(HEEL, tread=GRID),
    "rounded lugs": replace(HEEL, tread=replace(GRID, edge_radius=1e-3), profile=Facet(0.1, 0.01)),
    "chamfered lugs": replace(
        HEEL, tread=replace(GRID, edge_chamfer=1e-3), profile=Rocker(0.06, 0.02), crown_radius=0.3
    ),
    "slits": replace(HEEL, tread=replace(GRID, angle=0.2, sipes=Sipes(0.4e-3, 2e-3, 3e-3, 0.3))),
    "wide sipes": replace(HEEL, tread=replace(GRID, sipes=Sipes(2.1e-3, 2e-3, 6e-3))),
    "worn": replace(
        HEEL, tread=replace(GRID, sipes=Sipes(0.4e-3, 1e-3, 3e-3)), wear=WearPlane(2e-3, 0.12)
    ),
    "worn through": replace(HEEL, tread=GRID, wear=WornPatch(3.5e-3, 0.015, 0.012)),
    "arc": replace(
        HEEL, arc_channel=ArcChannel(7e-3, 6e-3, 3e-3, 2e-3), wear=WornPatch(1e-3, 0.02, 0.01)
    ),
    "both": replace(
        HEEL, tread=GRID, arc_channel=ArcChannel(7e-3, 6e-3, 3e-3, 4e-3), wear=WearPlane(3.2e-3)
    ),
    "discs": replace(HEEL, tread=Tread("circles", 5e-3, 3.1e-3, 2e-3, angle=0.3)),
}
SOLE = WholeSole(
    ShoeOutline(0.12, 0.03, 0.026, 0.045), 0.012, Facet(0.15, 0.012), ToeSpring(0.006, 0.09, 0.12),
    tread=Tread("hexagons", 12e-3, 6.2e-3, 4e-3),
)  # fmt: skip


@pytest.mark.parametrize("name", HEELS)
def test_heels_on_cells(file_regression, name):
    heel = HEELS[name]
    tilted = heel_map(heel, shoe_angle=0.1, spacing=1e-3)
    fine = heel_map(heel, shoe_angle=0.1, spacing=1.04e-3, padding=1e-3, columns=4)
    level = heel_map(heel, shoe_angle=0.0, spacing=1.5e-3, padding=0.0)
    cells = row_cells(level)
    answers = {
        "tilted": tilted, "areas": (tilted.plan_area, tilted.land_area, tilted.land_ratio),
        "down": heel_map(heel, shoe_angle=-0.05, spacing=1.04e-3).clearance,
        "fine": fine, "level": level, "cells": cells, "at rim": cells.at_rim,
        "place": (tread_place(tilted), tread_place(level, 0.4e-3)),
        "finest": refusal(_rows, heel) if heel.tread and heel.tread.sipes else _rows(heel),
    }  # fmt: skip
    if tilted.slits:
        slits = tilted.slits
        shut = slits.closed_by(0.15e-3)
        answers["slits"] = {
            "drains": (slits.drainage, slits.drained, shut.drainage, shut.drained),
            "length": slits.whole_length, "count": slits.count, "shut": shut,
            "all shut": slits.closed_by(1e-3), "open": slits.closed_by(0.0).openness,
            "part": slits.part(np.s_[3:20, 5:25]),
        }  # fmt: skip
    held(file_regression, answers, f"heel {name}")


def _rows(heel):
    square = heel_map(heel, shoe_angle=0.1, spacing=1.5e-3, padding=1.5e-3)
    fine = heel_map(heel, shoe_angle=0.1, spacing=1.5e-3, padding=1.5e-3, columns=4)
    cells = row_cells(square, fine)
    values = np.linspace(0, 1, cells.size) ** 2
    return {
        "cells": cells,
        "sums": cells.sums(values),
        "means": cells.means(values, np.where(cells.land, cells.area, 0.0)),
        "of": cells.of(square.clearance),
        "part": cells.part(np.arange(3, 17)),
    }


@pytest.mark.parametrize("name", ["grid", "arc", "worn through"])
def test_rows_of_parts(file_regression, name):
    """Two and three cells in a spacing; a part of the sole has the cells of that part."""
    tilted = {"shoe_angle": 0.1, "spacing": 1.5e-3, "padding": 1.5e-3}
    square = heel_map(HEELS[name], **tilted)
    rows = np.s_[3:-2], np.s_[4:-3]
    part = replace(
        square,
        x=square.x[rows[0]],
        y=square.y[rows[1]],
        cut=square.cut and square.cut.part(rows),
        removed=None,
        **{
            each: getattr(square, each)[rows]
            for each in ("clearance", "inside", "land", "tread_depth")
        },
    )
    answers = {}
    for columns in (2, 3):
        fine = heel_map(HEELS[name], **tilted, columns=columns)
        answers[str(columns)] = row_cells(square, fine)
        answers[f"{columns}, part"] = row_cells(part, fine)
        assert answers[f"{columns}, part"].shape == part.clearance.shape
    held(file_regression, answers, f"rows {name}")


@pytest.mark.parametrize("name", ["grid", "rounded lugs", "slits", "worn through", "arc"])
def test_heels_as_surfaces(file_regression, name):
    surface = heel_surface(HEELS[name], spacing=0.5e-3)
    worn = worn_surface(surface, WearPlane(0.8e-3, 0.1))
    periods = tread_periods(surface)
    lines = np.array([[[0.01, 0.002], [0.02, -0.01]], [[0.0, 0.0], [0.03, 0.01]]])
    answers = {
        "surface": surface, "extent": (surface.length, surface.width, surface.land_ratio),
        "map": surface_map(surface, shoe_angle=0.1, spacing=1e-3),
        "fine map": surface_map(
            worn, shoe_angle=-0.05, spacing=1.2e-3, padding=1e-3, columns=2
        ),
        "worn": worn,
        "lines": floor_lines(surface, [lines, lines[:1]], shoe_angle=0.1, spacing=1e-3),
        "on floor": place_on_floor(surface, 0.1),
        "breaches": resolution_breaches(surface, 1.5e-3),
        "measures": tread_measures(surface),
        "of walls": tread_measures(surface, lines),
        "periods": periods, "waves": place_of_waves(surface, periods),
        "base": carried_base(surface),
        "moved": moved_tread(surface, (1.2e-3, -0.9e-3), periods),
        "turned": moved_tread(
            surface, (0.4e-3, 2.3e-3), periods, yaw=0.3, pivot=(0.01, 1e-3)
        ).height,
        "drawn": drawn_surface(surface), "rims": rounded_rims(surface),
    }  # fmt: skip
    held(file_regression, answers, f"surface {name}")


def test_a_whole_sole_on_cells(file_regression):
    surface = heel_surface(SOLE, spacing=1.5e-3)
    held(
        file_regression,
        {
            "surface": surface,
            "map": heel_map(SOLE, shoe_angle=0.15, spacing=1.5e-3),
            "of surface": surface_map(surface, shoe_angle=-0.2, spacing=1.5e-3),
            "measures": tread_measures(surface),
            "outline": grids.plan_outline(SOLE),
            "outline of few": grids.plan_outline(HEEL, 3),
        },
    )


def _hills(shape=(46, 34), spacing=1e-3):
    """A sole of lugs of two heights, slits, an arch, a rounded rim."""
    x, y = np.meshgrid(*(np.arange(n) * spacing for n in shape), indexing="ij")
    inside = (x - 0.023) ** 2 / 0.022**2 + (y - 0.0165) ** 2 / 0.0155**2 < 1
    lug = (np.mod(x, 9e-3) < 6e-3) & (np.mod(y, 8e-3) < 5e-3)
    low = (x > 0.027) & (x < 0.035)
    height = np.where(lug, np.where(low, 1.5e-3, 0.0), 4e-3) + 2.0 * (x - 0.02) ** 2
    return np.where(inside, height, np.nan), spacing


def test_heights_of_a_sole(file_regression):
    height, spacing = _hills()
    noisy = height + 4e-5 * np.cos(np.arange(height.size).reshape(height.shape) ** 1.7)
    tread = tread_map(height, spacing)
    known = np.zeros(height.shape, bool)
    known[10:14] = True
    inside = np.isfinite(height)
    surface = SoleSurface(
        np.arange(46) * spacing, np.arange(34) * spacing, height, tread.land, tread.tread_depth,
        spacing, np.array([[0, 0], [0.046, 0], [0.046, 0.034], [0, 0.034], [0, 0]]),
    )  # fmt: skip
    deep = channel_depth(surface)
    channel = inside & ~tread.land
    measures = tread_measures(surface)
    assert measures.lug_count == len(np.unique(_pieces(tread.land))) - 1
    held(
        file_regression,
        {
            "tread": _steady(tread),
            "with channels": _steady(tread_map(height, spacing, channels=known)),
            "noisy": tread_map(noisy, spacing, lag=2),
            "flat": tread_map(np.zeros((20, 20)), spacing),
            "measures": measures,
            "noise": (height_noise(noisy), height_noise(noisy, 3), height_noise(noisy[:3])),
            "quiet": without_noise(noisy, tread.land, 4e-5, spacing, 2),
            "as it was": without_noise(noisy, tread.land, 1.5e-5, spacing).sum(where=inside),
            "reached": reached_by_floor(height, tread.land, spacing),
            "deep": deep,
            "floor": floor_depth(deep, channel, spacing),
            "lower": lower_lugs(deep, channel, spacing),
            "patch": largest_patch(surface),
            "arch": arch_area(tread, inside, 20e-3),
            "no arch": arch_area(tread, inside, 1e-3),
            "no channel": arch_area(replace(tread, land=inside), inside, 1e-3),
            "slits": surface_without_slits(surface, 1e-3)[1],
            "drawn": drawn_surface(surface),
            "rims": rounded_rims(surface),
            "moved": moved_tread(surface, (2e-3, 1e-3), tread_periods(surface)),
        },
    )  # fmt: skip


def _steady(tread):
    """Return it without what rounding makes of heights that have no noise."""
    return replace(tread, noise=round(tread.noise, 9))


def _pieces(mask):
    from underfoot.shoe._kernels.regions import pieces

    numbers, _ = pieces(mask)
    return numbers


def test_slits_of_a_surface(file_regression):
    spacing = 0.3e-3
    x = np.arange(90) * spacing
    y = centred_places(60, spacing)
    land = np.ones((90, 60), bool)
    land[20:23] = land[:, 40:46] = False  # a slit across, a channel along
    land[50, 5:30] = land[70:72, 5:12] = False
    for n in range(12):
        land[55 + n, 8 + n : 10 + n] = False
    height = np.where(land, 0.0, 2e-3)
    outline = np.array([[0, -9e-3], [27e-3, -9e-3], [27e-3, 9e-3], [0, 9e-3], [0, -9e-3]])
    surface = SoleSurface(x, y, height, land, np.where(land, 2e-3, 0.0), spacing, outline)
    answers = {"measures": tread_measures(surface)}
    for widest in (0.2e-3, 0.7e-3, 2e-3):
        filled, slits = surface_without_slits(surface, widest)
        answers[f"{widest:g}"] = {"filled": filled, "slits": slits}
    answers["map"] = surface_map(surface, shoe_angle=0.05, spacing=0.6e-3)
    answers["drainage"] = slit_drainage(
        np.array([0.2e-3, 1e-3, 3e-3]), np.array([1e-3, 1e-3, 1e-3])
    )
    held(file_regression, answers)


def test_lugs_that_drain(file_regression):
    sole = heel_map(replace(HEEL, tread=GRID), shoe_angle=0.03, spacing=1e-3)
    x, y = np.meshgrid(sole.x, sole.y, indexing="ij")
    pressure = 1e5 * np.exp(-((x - 0.01) ** 2 + (y + 2e-3) ** 2) / 0.008**2)
    pressure = np.where(sole.land, pressure, 0.02 * pressure)
    found = lug_drainage(sole, pressure, np.full(sole.land.shape, 20e-6))
    backed = lug_drainage(sole, np.where(sole.inside, 1e5, 0.0), sole.clearance.clip(1e-6, 1e-4))
    few = lug_drainage(replace(sole, cut=None), np.where(x < 0.012, pressure, 0.0), 1e-5 + 0 * x)
    assert isinstance(found, LugDrainage)
    assert found.share.sum() < 1
    low = replace(found, height=found.height * 0 + 9e-3)
    held(
        file_regression,
        {
            "found": found, "advice": found.advice(), "fields": found.fields(),
            "backed up": (backed, backed.advice()), "few": (few, few.advice()),
            "slender": low.advice(), "little": replace(found, share=found.share * 0.01).advice(),
            "where": [across_text(at) for at in (-2e-3, -0.9e-3, 0.0, 0.99e-3, 1.01e-3)],
        },
    )  # fmt: skip
    assert lug_drainage(sole, 0 * pressure, 0 * pressure) is None
    plain = heel_map(HEEL, shoe_angle=0.03, spacing=1e-3)
    assert lug_drainage(plain, plain.land * 1e5, plain.land * 1e-5) is None


def test_cells_that_outlines_cut(file_regression):
    x, y = np.meshgrid(np.arange(14.0), np.arange(12.0), indexing="ij")
    inside = (x > 0) & (y < 11)

    def level_at(i, j, along, across):
        return _ring(i + along, j + across)

    cut = cut_cells(_ring(x, y), inside, level_at)
    slivers = np.ones((5, 6))
    slivers[1, 1], slivers[3, 4], slivers[0, 5] = 0.03, -0.4, -2.5
    land = np.ones((5, 6), bool)
    land[3] = False
    none = CutCells.none((3, 2))
    held(
        file_regression,
        {
            "cut": cut,
            "part": cut.part(np.s_[2:7, 3:5]),
            "none": none,
            "all": cut_cells(-np.ones((4, 3)), np.ones((4, 3), bool), level_at),
            "least": with_least_area(slivers.copy(), land),
        },
    )
    assert with_least_area(slivers.copy(), land).sum() == pytest.approx(slivers.sum())


def _ring(x, y):
    """Land between two circles, 0.37 cells off the centres."""
    far = np.hypot(x - 6.37, y - 5.21)
    return np.maximum(2.1 - far, far - 4.6)


REFUSED = {
    "coarse channel": (HEELS["grid"], 0.1, 1.56e-3),
    "coarse lug": (replace(HEEL, tread=Tread("grid", 2e-3, 6e-3, 2e-3)), 0.1, 1.01e-3),
    "coarse arc": (HEELS["arc"], 0.1, 1.51e-3),
    "coarse plan": (HEEL, 0.1, 6.6e-3),
    "no spacing": (HEEL, 0.1, 0.0),
    "too steep": (HEEL, math.radians(60.1), 1e-3),
    "too far down": (HEEL, math.radians(-30.1), 1e-3),
}


def test_maps_that_are_refused(file_regression):
    answers = {
        name: refusal(heel_map, heel, shoe_angle=angle, spacing=spacing)
        for name, (heel, angle, spacing) in REFUSED.items()
    }
    answers["padding"] = refusal(heel_map, HEEL, shoe_angle=0.1, spacing=1e-3, padding=-1e-3)
    surface = heel_surface(HEELS["grid"], spacing=0.5e-3)
    answers["narrow"] = refusal(resolution_breaches, surface, 2.5e-3)
    answers["of few cells"] = resolution_breaches(surface, 1e-3)
    answers["enough"] = resolution_breaches(surface, 0.6e-3)
    answers["surface of no spacing"] = refusal(heel_surface, HEEL, spacing=0.0)
    level = heel_map(HEEL, shoe_angle=0.0, spacing=2e-3)
    for name, change in {
        "shape": {"land": level.land[:3]},
        "nowhere": {"inside": level.inside & False},
        "no land": {"land": level.land & False},
        "not finite": {"clearance": level.clearance * np.nan},
        "land outside": {"land": ~level.inside},
    }.items():
        answers[name] = refusal(replace, level, **change)
    for name, change in {
        "heights": {"height": surface.height * np.nan},
        "land beside": {"land": ~surface.land | True},
        "base": {"base": np.zeros(3)},
        "spacing": {"spacing": -1.0},
    }.items():
        answers[name] = refusal(replace, surface, **change)
    held(file_regression, answers)
    assert isinstance(level, SoleMap)
    assert isinstance(row_cells(level), RowCells)
    cut = CutCells.none(level.land.shape)
    slits = heel_map(HEELS["slits"], shoe_angle=0.0, spacing=1e-3).slits
    whole = CutCells.none(slits.covered.shape)
    assert without_slits(whole, slits, slits.covered > 9).area.sum() == pytest.approx(
        whole.area.sum() - slits.covered.sum()
    )
    assert replace(level, cut=cut).land_area == pytest.approx(replace(level, cut=None).land_area)
