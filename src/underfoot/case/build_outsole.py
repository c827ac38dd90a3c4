"""The sole of a case whose outsole is a file: read once, worn, tilted, trimmed, checked."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from underfoot.core import Breach, InputError, Range, breaches, display

if TYPE_CHECKING:
    from underfoot.outsole import SoleMap, SoleSurface
    from underfoot.outsole.files import FileOutsole, FileSettings
    from underfoot.outsole.shape import SoleWear

    from .case import Case

BOTTOMED = 0.5
"""Share of the outsole's thickness beyond which the load bottoms it out: refused."""
LINEAR_STRAIN = Range(0.0, 0.25, "1", "linear elasticity of rubber in compression")


def file_outsole(case: Case) -> FileOutsole:
    """Return the outsole in the file of the case, as the case says it is to be read."""
    outsole = case.shoe.outsole
    assert outsole.file is not None
    return _read(outsole.file, outsole.sha256 or "", file_settings(case))


def file_settings(case: Case) -> FileSettings:
    """Return how the case wants its outsole file read."""
    from underfoot.outsole.files import FileSettings

    outsole = case.shoe.outsole
    return FileSettings(
        unit=outsole.unit,
        down=outsole.down,
        forward=outsole.forward,
        foot=outsole.foot,
        mirror=outsole.mirror,
        region=outsole.region,
        region_length=outsole.region_length,
        spacing=outsole.map_spacing,
    )


@lru_cache(maxsize=4)
def _read(path: str, checksum: str, settings: FileSettings) -> FileOutsole:
    """Read a file once in a process: the checksum is part of the key."""
    from underfoot.outsole.files import outsole_from_file

    return outsole_from_file(path, settings)


def file_surface(case: Case) -> SoleSurface:
    """Return the bottom of the case's outsole file, worn as the case says."""
    surface = file_outsole(case).surface
    wear = _wear(case)
    if wear is None:
        return surface
    from underfoot.outsole.worn_surface import worn_surface

    return worn_surface(surface, wear)


def file_sole_map(case: Case, spacing: float) -> SoleMap:
    """Return the tilted outsole of the case's file on the solver's grid, trimmed to its reach.

    Errors
    ------
    InputError
        Channels below the grid, a region or unit that doesn't fit, tread deeper than the outsole,
        nothing under the load.
    """
    from underfoot.outsole import surface_map

    surface = file_surface(case)
    thickness = case.shoe.sole.outsole_thickness
    deepest = float(np.max(surface.tread_depth))
    if deepest >= thickness:
        raise InputError(
            f"the tread of {surface.name} is {display(deepest, 'm')} deep, the outsole "
            f"{display(thickness, 'm')} thick",
            where="shoe.sole.outsole_thickness",
            allowed=f"above {display(deepest, 'm')}",
        )
    sole = trimmed(
        surface_map(surface, shoe_angle=case.motion.shoe_angle, spacing=spacing),
        case.shoe.outsole.reach,
    )
    check_load(case, sole)
    return sole


def trimmed(sole: SoleMap, reach: float, padding: float = 0.004) -> SoleMap:
    """Return the map without rows and columns that lie more than ``reach`` (m) above the floor."""
    near = sole.clearance <= reach
    margin = max(1, math.ceil(padding / sole.spacing))
    keep = []
    for axis in (0, 1):
        places = np.nonzero(near.any(axis=1 - axis))[0]
        first, last = max(int(places[0]) - margin, 0), int(places[-1]) + margin + 1
        keep.append(slice(first, last))
    part = (keep[0], keep[1])
    return replace(
        sole,
        x=sole.x[keep[0]],
        y=sole.y[keep[1]],
        clearance=sole.clearance[part],
        inside=sole.inside[part],
        land=sole.land[part],
        tread_depth=sole.tread_depth[part],
    )


def check_load(case: Case, sole: SoleMap) -> None:
    """Refuse a load that bottoms the sole out, or that meets next to nothing of it.

    A first look without a solver: each place of the land as a spring of its own, F = E / t sum
    (d - c) dA over the land with clearance c below d, outsole thickness t. This estimate of the
    approach d is too stiff for a thin layer's middle and too soft for none; refused is d above
    half the thickness.
    """
    from .build import youngs_modulus

    thickness = case.shoe.sole.outsole_thickness
    thickness += case.shoe.sole.midsole_thickness or 0.0
    modulus = youngs_modulus(case)[0].value
    assert modulus is not None
    force = case.motion.normal_force
    heights = np.sort(sole.clearance[sole.land])
    stiffness = modulus / thickness * sole.spacing**2
    # with the n lowest places in touch: F = k (n d - sum of their clearances)
    count = np.arange(1, heights.size + 1)
    approach = (force / stiffness + np.cumsum(heights)) / count
    reached = np.append(heights[1:], np.inf) >= approach
    depth = float(approach[int(np.argmax(reached))])
    if depth <= BOTTOMED * thickness:
        return
    area = np.count_nonzero(heights < depth) * sole.spacing**2 * 1e6
    raise InputError(
        f"{force:g} N bottoms out the sole: it would press {display(depth, 'm')} into "
        f"{display(thickness, 'm')} of outsole, on {area:.0f} mm² of land",
        where="motion.normal_force",
        allowed=f"an approach of up to {BOTTOMED:.0%} of the outsole's thickness",
        remedy="Look at the file with: underfoot outsole inspect. Is the right region under the "
        "load (region, forward, down), is the unit right, does a stray point stand out",
    )


def compression_breaches(case: Case, approach: float) -> list[Breach]:
    """Return whether the sole was pressed together more than linear elasticity is good for."""
    thickness = case.shoe.sole.outsole_thickness + (case.shoe.sole.midsole_thickness or 0.0)
    name = "compression of the sole (approach / thickness)"
    return breaches("compliance", {name: LINEAR_STRAIN}, {name: max(approach, 0.0) / thickness})


def outsole_notes(case: Case) -> list[str]:
    """Return in words what was found, assumed and repaired in the outsole file; else nothing."""
    if case.shoe.outsole.file is None:
        return []
    return [f"shoe.outsole: {line}" for line in file_outsole(case).surface.remarks]


def _wear(case: Case) -> SoleWear | None:
    from underfoot.outsole import WearPlane
    from underfoot.outsole.worn import WornPatch

    wear = case.shoe.wear
    if wear.depth == 0:
        return None
    if wear.mode == "plane":
        return WearPlane(wear.depth, wear.angle)
    assert wear.patch_length is not None  # checked with the case, like the width and the mode
    assert wear.patch_width is not None
    return WornPatch(
        depth=wear.depth,
        length=wear.patch_length,
        width=wear.patch_width,
        position=wear.patch_position,
        lateral=wear.patch_lateral,
        form=wear.patch_form,
        taper=wear.patch_taper,
    )
