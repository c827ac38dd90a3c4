"""The sole of a case: shape, tread and wear."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from underfoot.core import Cache, Progress, content_hash, silent

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from underfoot.outsole import Profile, SoleMap, Tread
    from underfoot.outsole.shape import SoleShape, SoleWear
    from underfoot.outsole.worn import ArchardStep

    from .case import Case
    from .sections_sole import HeelShape
    from .sections_tread import Tread as TreadSection

WEAR_STEP = 0.25e-3
"""Thickness that Archard wear removes between two contacts, m."""


def sole_shape(case: Case, progress: Progress = silent) -> SoleShape:
    """Return the parametric heel or sole of the case, worn as it says."""
    new = new_sole(case)
    wear = case.shoe.wear
    if wear.depth == 0:
        return new
    from underfoot.outsole import WearPlane
    from underfoot.outsole.worn import WornPatch

    if wear.mode == "plane":
        return _worn(new, WearPlane(wear.depth, wear.angle))
    if wear.mode == "patch":
        assert wear.patch_length is not None  # checked with the case, like the width
        assert wear.patch_width is not None
        patch = WornPatch(
            depth=wear.depth,
            length=wear.patch_length,
            width=wear.patch_width,
            position=wear.patch_position,
            lateral=wear.patch_lateral,
            form=wear.patch_form,
            taper=wear.patch_taper,
        )
        patch.check_within(new)
        return _worn(new, patch)
    return _worn(new, archard_state(case, progress=progress).worn)


def new_sole(case: Case) -> SoleShape:
    """Return the parametric heel or sole of the case before any wear."""
    return shape_from(case.shoe.heel, case.shoe.tread, case.shoe.sole.outsole_thickness)


def shape_from(shape: HeelShape, tread: TreadSection, outsole_thickness: float) -> SoleShape:
    """Return the new sole that the sections of a case or of an outsole file describe."""
    from underfoot.outsole import ArcChannel, Heel
    from underfoot.outsole.parametric import ShoeOutline, ToeSpring, WholeSole

    arc = tread.arc_channel
    common: dict[str, Any] = {
        "outsole_thickness": outsole_thickness,
        "edge_radius": shape.edge_radius,
        "crown_radius": shape.crown_radius,
        "tread": lugs_from(tread),
        "arc_channel": arc and ArcChannel(arc.position, arc.radius, arc.width, arc.depth),
    }
    if shape.plan == "heel":
        return Heel(
            length=shape.length,
            width=shape.width,
            rear_radius=shape.rear_radius,
            front_radius=shape.front_radius,
            profile=_rear(shape),
            **common,
        )
    assert shape.waist_width is not None  # checked with the case, like the ball
    assert shape.ball_width is not None
    toe = None
    if shape.toe_spring and shape.toe_start:
        toe = ToeSpring(shape.toe_spring, shape.toe_start, shape.length)
    outline = ShoeOutline(
        shape.length, shape.width, shape.waist_width, shape.ball_width, shape.side
    )
    return WholeSole(outline, rear_profile=_rear(shape), toe_spring=toe, **common)


def lugs_from(tread: TreadSection) -> Tread | None:
    """Return the tread that a section describes; None for an untreaded sole."""
    from underfoot import outsole
    from underfoot.outsole.sipes import Sipes

    if tread.pattern == "none" or not tread.lug_width or not tread.channel_width:
        return None
    sipes = tread.sipes
    return outsole.Tread(
        tread.pattern,
        tread.lug_width,
        tread.channel_width,
        tread.depth or 0.0,
        tread.edge_radius,
        angle=tread.angle,
        lug_length=tread.lug_length if tread.pattern == "blocks" else None,
        arm_length=tread.arm_length if tread.pattern == "chevrons" else None,
        sipes=sipes and Sipes(sipes.width, sipes.depth, sipes.spacing, sipes.angle),
    )


def archard_state(case: Case, *, progress: Progress = silent) -> ArchardStep:
    """Return the sole of the case worn by pressure and sliding to its wear depth.

    The contact is dry, on the quick grid, at three shoe angles. Every ``WEAR_STEP`` is kept on
    disk, so that a sole worn further goes on from there.
    """
    from underfoot.outsole.worn import ArchardStep, WornMap, archard_wear

    from .build import youngs_modulus

    wear, new = case.shoe.wear, new_sole(case)
    modulus = youngs_modulus(case)[0].value
    assert modulus is not None
    spacing = case.numerics.quick_grid_spacing
    force = wear.normal_force or case.motion.normal_force
    half = wear.angle_range / 2
    middle = wear.angle
    angles = (middle - half, middle, middle + half) if half > 0 else (middle,)
    rq = case.effective_rq.value
    sole = case.shoe.sole.model_dump()
    ratio = case.shoe.material.poisson_ratio
    identity = (new, list(angles), force, modulus, ratio, rq, sole, spacing, wear.wear_rate)
    store = Cache("archard_wear-1")
    state: ArchardStep | None = None
    steps = [*np.arange(WEAR_STEP, wear.depth - 1e-9, WEAR_STEP), wear.depth]
    for number, depth in enumerate(steps):
        key = content_hash("archard", *identity, round(float(depth), 9))
        stored = store.load(key)
        if stored is None:
            progress("Wearing the sole", number / len(steps))
            state = archard_wear(
                new,
                angles=angles,
                depth=float(depth),
                contact=lambda shape, angle: _dry_contact(case, shape, angle, modulus, force),
                wear_rate=wear.wear_rate,
                spacing=spacing,
                step=WEAR_STEP,
                begin=state,
            )
            worn = state.worn
            arrays = {"x": worn.x, "y": worn.y, "removed": worn.removed}
            store.store(key, {**arrays, "way": np.array(state.sliding_distance)})
        else:
            worn = WornMap(stored["x"], stored["y"], stored["removed"])
            state = ArchardStep(worn, float(stored["way"]))
    assert state is not None
    return state


def _dry_contact(
    case: Case, shape: SoleShape, angle: float, modulus: float, force: float
) -> tuple[SoleMap, NDArray[np.float64]]:
    from underfoot.core import ConvergenceError
    from underfoot.outsole import heel_map
    from underfoot.outsole.solver import SolverSettings, solve_sliding

    from .build import asperity_law, compliance

    sole = heel_map(shape, shoe_angle=angle, spacing=case.numerics.quick_grid_spacing)
    contact = solve_sliding(
        sole,
        compliance(case, sole, modulus),
        asperity_law(case, modulus),
        viscosity=None,
        speed=case.motion.speed,
        normal_force=force,
        settings=SolverSettings(tolerance=case.numerics.tolerance),
    )
    if not contact.status.usable:
        raise ConvergenceError(
            "the dry contact of the worn sole did not converge",
            history=contact.residuals,
            where="shoe.wear",
            remedy="Refine numerics.quick_grid_spacing, or wear at another angle.",
        )
    return sole, contact.contact_pressure


def _worn(new: SoleShape, wear: SoleWear) -> SoleShape:
    return cast("SoleShape", replace(cast("Any", new), wear=wear))


def _rear(shape: HeelShape) -> Profile:
    from underfoot.outsole import Facet, Flat, Rocker

    if shape.profile == "facet" and shape.facet_angle and shape.facet_length:
        return Facet(shape.facet_angle, shape.facet_length)
    if shape.profile == "rocker" and shape.rocker_radius and shape.rocker_start:
        return Rocker(shape.rocker_radius, shape.rocker_start)
    return Flat()
