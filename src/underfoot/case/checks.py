"""What must fit together within a case: checked once every single value is sound."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import TYPE_CHECKING

from underfoot.core import InputError, RangeError, display

from .checks_motion import motion_mismatches
from .checks_outsole import outsole_mismatches
from .checks_roughness import roughness_mismatches
from .checks_sole import sole_mismatches

if TYPE_CHECKING:
    from .case import Case
    from .places import Places


def mismatches(case: Case, given: Collection[str], places: Places) -> Iterator[InputError]:
    """Yield what does not fit together; ``given`` are the paths written in the file."""
    yield from _material(case, places)
    yield from roughness_mismatches(case, places)
    if case.shoe.outsole.file is not None:
        yield from outsole_mismatches(case, places)
    else:
        yield from _heel(case, given, places)
        yield from sole_mismatches(case, given, places)
    yield from _contaminant(case, given, places)
    yield from _rest(case, places)


def _material(case: Case, places: Places) -> Iterator[InputError]:
    material, sole = case.shoe.material, case.shoe.sole
    if material.shore_a is None and material.modulus is None:
        yield InputError(
            "neither hardness nor modulus is given",
            where=places("shoe.material"),
            remedy='Write shore_a = 68 (a durometer reading) or modulus = "5 MPa"',
        )
    if material.modulus is None and material.shore_a is not None and material.shore_a >= 100:
        yield RangeError(
            "Shore A 100 has no finite modulus",
            where=places("shoe.material.shore_a"),
            allowed="below 100",
            remedy='Write modulus = "50 MPa" from a measurement instead',
        )
    if (sole.midsole_modulus is None) != (sole.midsole_thickness is None):
        missing = "midsole_modulus" if sole.midsole_modulus is None else "midsole_thickness"
        yield InputError(
            "a midsole needs both its modulus and its thickness",
            where=places(f"shoe.sole.{missing}"),
        )


def _heel(case: Case, given: Collection[str], places: Places) -> Iterator[InputError]:
    heel = case.shoe.heel
    needed = {
        "flat": (),
        "facet": ("facet_angle", "facet_length"),
        "rocker": ("rocker_radius", "rocker_start"),
    }
    for name in needed[heel.profile]:
        if getattr(heel, name) is None:
            yield InputError(
                f'is missing for the profile "{heel.profile}"', where=places(f"shoe.heel.{name}")
            )
    for profile, names in needed.items():
        for name in names:
            if profile != heel.profile and f"shoe.heel.{name}" in given:
                yield InputError(
                    f'is not used by the profile "{heel.profile}"',
                    where=places(f"shoe.heel.{name}"),
                    remedy=f'Remove it, or write profile = "{profile}"',
                )
    if (
        heel.profile == "rocker"
        and heel.rocker_radius is not None
        and heel.rocker_start is not None
        and heel.rocker_start >= heel.rocker_radius
    ):
        yield RangeError(
            f"{display(heel.rocker_start, 'm')} reaches beyond the rocker's radius",
            where=places("shoe.heel.rocker_start"),
            allowed=f"below {display(heel.rocker_radius, 'm')} (rocker_radius)",
        )
    limit = min(heel.width, heel.length) / 2
    for name in ("rear_radius", "front_radius", "edge_radius") if heel.plan == "heel" else ():
        if getattr(heel, name) > limit:
            yield RangeError(
                f"{display(getattr(heel, name), 'm')} does not fit the plan form",
                where=places(f"shoe.heel.{name}"),
                allowed=f"at most {display(limit, 'm')} (half of the smaller of length and width)",
            )


def _contaminant(case: Case, given: Collection[str], places: Places) -> Iterator[InputError]:
    fluid = case.contaminant
    if fluid is None:
        return
    if fluid.viscosity is None and fluid.glycerol_fraction is None:
        yield InputError(
            "neither a viscosity nor a share of glycerol is given",
            where=places("contaminant"),
            remedy='Write viscosity = "219 cP", or glycerol_fraction = "90 %" with its basis. '
            'Without one only a measured friction applies: contaminant = "none" with '
            'models.friction = "constant" or "table", and no film',
        )
    if fluid.viscosity is not None and fluid.glycerol_fraction is not None:
        yield InputError(
            "viscosity and glycerol_fraction say the same thing twice",
            where=places("contaminant.glycerol_fraction"),
            remedy="Keep the measured viscosity, or only the share of glycerol",
        )
    if fluid.glycerol_fraction is not None and fluid.fraction_basis is None:
        yield InputError(
            "is missing: the same percentage by mass and by volume differs by half in viscosity",
            where=places("contaminant.fraction_basis"),
            allowed='"mass" or "volume"',
        )
    if fluid.glycerol_fraction is None and "contaminant.fraction_basis" in given:
        yield InputError(
            "is not used without glycerol_fraction", where=places("contaminant.fraction_basis")
        )


def _rest(case: Case, places: Places) -> Iterator[InputError]:
    yield from motion_mismatches(case, places)
    if case.interface.shortest_wave >= case.interface.longest_wave:
        yield RangeError(
            "the shortest wave of the interface is not shorter than the longest",
            where=places("interface.shortest_wave"),
            allowed=f"below {display(case.interface.longest_wave, 'm')} (interface.longest_wave)",
        )
    yield from _friction(case, places)


def _friction(case: Case, places: Places) -> Iterator[InputError]:
    model, interface = case.models.friction, case.interface
    if case.contaminant is None and model not in ("constant", "bowden_tabor", "table"):
        yield InputError(
            "a dry case needs a measured coefficient of friction",
            where=places("models.friction"),
            remedy='Write models.friction = "constant" and interface.constant_cof = 0.8',
        )
    if model == "bowden_tabor" and interface.shear_strength is None:
        yield InputError(
            'is missing for models.friction = "bowden_tabor"',
            where=places("interface.shear_strength"),
            remedy="Take it from a measured adhesion: COF times pressure over the share of real "
            'contact, as shear_strength = "0.3 MPa"',
        )
    if model == "viscoelastic_area" and case.shoe.material.relaxation is None:
        yield InputError(
            "a relaxation spectrum is missing: without it the contact area has no speed",
            where=places("shoe.material.relaxation"),
            remedy='Give the spectrum of the compound, or choose models.friction = "asperity_ehl" '
            'or "stribeck"',
        )
    if model == "table":
        speeds = {one.speed for one in interface.friction_readings or ()}
        if len(speeds) < 2:
            yield InputError(
                'are missing for models.friction = "table"' if not speeds else "of one speed only",
                where=places("interface.friction_readings"),
                allowed="readings at two or more speeds",
                remedy='Write interface.friction_table = "law.csv" (columns speed, cof, and sd '
                'where known), or choose "constant"',
            )
    if model == "constant" and interface.constant_cof is None:
        yield InputError(
            'is missing for models.friction = "constant"', where=places("interface.constant_cof")
        )
    if (
        model == "constant"
        and interface.constant_cof is not None
        and (interface.hysteresis_cof or 0.0) > interface.constant_cof
    ):
        yield RangeError(
            f"{interface.hysteresis_cof:g} is more than the whole",
            where=places("interface.hysteresis_cof"),
            allowed=f"at most {interface.constant_cof:g} (interface.constant_cof)",
        )
    if model == "adhesion_blocking" and case.contaminant is not None:
        boundary = case.contaminant.boundary
        needed = {
            "interface.dry_adhesion_cof": interface.dry_adhesion_cof,
            "interface.hysteresis_cof": interface.hysteresis_cof,
            "contaminant.boundary.alpha": boundary.alpha,
            "contaminant.boundary.beta": boundary.beta,
        }
        for path, value in needed.items():
            if value is None:
                yield InputError(
                    f'is missing for models.friction = "{model}"',
                    where=places(path),
                    remedy="Without it choose asperity_ehl or stribeck, which need the fluid's "
                    "viscosity alone, or constant with a measured friction",
                )
