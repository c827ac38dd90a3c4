"""Which values of a case no model looks at: left out of its hash and of what was assumed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .schema import fields

if TYPE_CHECKING:
    from .case import Case


def unused(case: Case) -> frozenset[str]:
    """Return the dotted paths of values that the chosen shape, fluid and models leave aside."""
    found: list[str] = []
    shoe = case.shoe
    if shoe.heel.profile != "facet":
        found += ["shoe.heel.facet_angle", "shoe.heel.facet_length"]
    if shoe.heel.profile != "rocker":
        found += ["shoe.heel.rocker_radius", "shoe.heel.rocker_start"]
    found += [*_sole(case), *_tread(case), *_wear(case), *_outsole(case)]
    if shoe.sole.midsole_modulus is None:
        found.append("shoe.sole.midsole_poisson_ratio")
    if shoe.material.modulus is not None:
        found += ["shoe.material.shore_a", "models.hardness"]
    for path, roughness in (("shoe", shoe.roughness), ("floor", case.floor.roughness)):
        if roughness.rq is not None:
            found.append(f"{path}.roughness.ra")
    if case.contaminant is not None and case.contaminant.glycerol_fraction is None:
        found += ["contaminant.temperature", "contaminant.fraction_basis"]
    if case.models.friction != "constant":
        found.append("interface.constant_cof")
    if case.models.friction != "adhesion_blocking":
        found += ["interface.dry_adhesion_cof", "contaminant.boundary.load"]
        found += ["contaminant.boundary.alpha", "contaminant.boundary.beta"]
    friction = case.models.friction
    mechanisms = ("asperity_ehl", "mean_film_sharing", "viscoelastic_area")
    if friction not in ("boundary", "stribeck", *mechanisms):
        found.append("contaminant.boundary.cof_bl")
    if friction not in ("stribeck", *mechanisms):
        found.append("contaminant.boundary.tau_hydro")
    if friction != "stribeck":
        found.append("contaminant.boundary.cof_asymptote")
    if friction != "asperity_ehl":
        found.append("interface.fine_roughness")
    if friction != "bowden_tabor":
        found.append("interface.shear_strength")
    found.append("interface.friction_table")  # its readings are part of the case
    found.append("motion.history")  # its points are
    if friction != "table":
        found += ["interface.friction_readings", "interface.friction_source"]
    if case.models.asperity != "contact_table":
        spectral = friction in ("asperity_ehl", "bowden_tabor")
        found += [] if spectral else ["interface.hurst", "interface.longest_wave"]
        if friction not in ("bowden_tabor", "viscoelastic_area"):
            found.append("interface.shortest_wave")
    if case.interface.effective_rq is not None:
        found.append("interface.roughness_beyond_cutoff")
    # who slips is asked by ``underfoot slip`` alone, which keys its own results
    found += ["slip", *(f"slip.{name}" for name in type(case.slip).model_fields)]
    return frozenset(found)


def _sole(case: Case) -> list[str]:
    """Return what a heel, or a whole sole, has no use for."""
    if case.shoe.heel.plan == "heel":
        names = ("plan", "side", "waist_width", "ball_width", "toe_spring", "toe_start")
    else:
        names = ("rear_radius", "front_radius")
    return [f"shoe.heel.{name}" for name in names]


def _outsole(case: Case) -> list[str]:
    """Return heel and tread of a case with an outsole file; without one, how to read it."""
    if case.shoe.outsole.file is None:
        return ["shoe.outsole", *_all_of(case, "outsole")]
    return ["shoe.heel", "shoe.tread", *_all_of(case, "heel"), *_all_of(case, "tread")]


def _all_of(case: Case, part: str) -> list[str]:
    section = type(getattr(case.shoe, part))
    return [f"shoe.{part}.{path}" for path, _ in fields(section)]


def _tread(case: Case) -> list[str]:
    tread = case.shoe.tread
    names: list[str] = []
    if tread.pattern == "none":
        names += ["depth", "lug_width", "channel_width", "edge_radius", "sipes"]
    if tread.pattern == "none" or tread.angle == 0.0:
        names.append("angle")
    if tread.pattern != "blocks":
        names.append("lug_length")
    if tread.pattern != "chevrons":
        names.append("arm_length")
    if tread.sipes is None and "sipes" not in names:
        names.append("sipes")
    return [f"shoe.tread.{name}" for name in names]


def _wear(case: Case) -> list[str]:
    wear = case.shoe.wear
    archard = ["angle_range", "normal_force", "wear_rate"]
    patch = [
        f"patch_{name}" for name in ("form", "length", "width", "position", "lateral", "taper")
    ]
    names: list[str] = []
    if wear.depth == 0.0:
        names = ["mode", "angle", *archard, *patch]
    elif wear.mode == "plane":
        names = ["mode", *archard, *patch]
    elif wear.mode == "patch":
        names = ["angle", *archard]
    else:
        names = patch
    return [f"shoe.wear.{name}" for name in names]
