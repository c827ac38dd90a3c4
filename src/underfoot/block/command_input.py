"""The case of ``underfoot micro``: TOML with units, to block, floor, material and loading."""

import shutil
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any

import underfoot.block as model
from underfoot import material
from underfoot.core import DataError, InputError, Progress, to_si, unknown_name
from underfoot.core.cache import default_folder
from underfoot.core.checks import choice, exactly_one
from underfoot.core.files import read_toml
from underfoot.core.identity import content_hash
from underfoot.core.remark import Message
from underfoot.surface import HeightMap, make_periodic, read_surface

TEMPLATE = """\
# A rough rubber block on a rough rigid floor. What is left out takes the value shown.
name = "rubber on a rough tile"
solver = "condensed"            # condensed: small strains, no inertia; explicit: finite elements
finite_strain = false           # true: condensed about the block's own finite compression (slower)

[block]
size = ["0.8 mm", "0.5 mm", "0.5 mm"]   # along sliding, across, high
elements = [26, 16, 9]
bottom_layer = "31.25 um"
roughness_layers = 4            # layers over which the roughness fades out
sides = "free"                  # or "periodic"

[block.roughness]               # checkerboard; or file = "scan.xyz" (periodic height map)
peak_to_valley = "35.1 um"
wavelength = "0.5 mm"           # assumed in the grant report's case

[floor]
peak_to_valley = "35.1 um"
wavelength = "0.4 mm"

[material]                      # one of: report, power_law, spectrum
report = "rubber"               # the grant report's: rubber or neolite (no hysteresis to speak of)
# power_law = { shear_modulus = "0.44 MPa", exponent = 0.12 }   # |G*| at 1 rad/s
# spectrum = "prony.csv"        # Prony series of Young's modulus
poisson_ratio = 0.499
# bulk_modulus = "220 MPa"      # in place of poisson_ratio

[loading]
mean_pressure = "160 kPa"
speeds = ["0.1 m/s", "1 m/s"]
slide_distance = "1.2 mm"
control = "height"              # keep the height reached under the load, or "load"
press_time = "1 ms"
hold_time = "0.3 ms"
ramp_time = "0.1 ms"

[explicit]                      # of the explicit solver only
mass_scaling = 1.0              # factor on the density, or "auto": the largest within its bounds
hourglass = "stiffness"         # or "viscous", which makes friction of its own
contact_damping = 0.3           # of critical
precision = "double"            # or "single"
"""
_DEFAULTS = tomllib.loads(TEMPLATE)
_CHOICES = ("peak_to_valley", "report")
"""Keys in whose place others may stand: a section that is given does not take the template's."""
_ROUGHNESS = {"peak_to_valley", "wavelength", "form", "file"}
_KEYS: Mapping[str, set[str]] = {
    "": set(_DEFAULTS),
    "block": set(_DEFAULTS["block"]),
    "block.roughness": _ROUGHNESS,
    "floor": _ROUGHNESS,
    "material": {"report", "power_law", "spectrum", "poisson_ratio", "bulk_modulus"},
    "material.power_law": {"shear_modulus", "exponent"},
    "loading": set(_DEFAULTS["loading"]),
    "explicit": set(_DEFAULTS["explicit"]),
}


@dataclass(frozen=True, slots=True, eq=False)
class MicroCase:
    """What ``underfoot micro`` runs."""

    name: str
    solver: str
    block: model.MicroBlock
    floor: model.MicroSurface
    material: model.MicroMaterial
    loading: model.MicroLoading
    speeds: tuple[float, ...]
    assumed: tuple[str, ...]
    finite_strain: bool
    settings: model.ExplicitSettings
    _condensed: list[Any] = field(default_factory=list)

    def result(
        self,
        speed: float,
        progress: Progress,
        *,
        snapshots: int = 0,
        folder: Path | None = None,
    ) -> model.MicroResult:
        """Return the history at one speed; ``folder`` gets the snapshots of explicit elements."""
        loading = replace(self.loading, speed=speed)
        if self.solver == "explicit":
            return self._explicit(loading, progress, snapshots, folder)
        if not self._condensed:
            nu = model.condensed_poisson_ratio(self.material)
            ratio = model.pressure_ratio_of(self.material, loading)
            self._condensed.append(
                model.pressed_block(self.block, nu, ratio, progress=progress)
                if self.finite_strain
                else model.condensed_block(self.block, nu, progress=progress)
            )
        return model.condensed_sliding(
            self._condensed[0], self.floor, self.material, loading, progress=progress
        )

    def _explicit(
        self, loading: model.MicroLoading, progress: Progress, snapshots: int, folder: Path | None
    ) -> model.MicroResult:
        """March on from where an earlier run of the same case was stopped, if there is one."""
        parts = (self.block, self.floor, self.material, loading, self.settings)
        kept = default_folder() / "micro" / content_hash(*parts, snapshots)
        restart = kept / "restart.npz"
        run = partial(
            model.explicit_sliding,
            *parts,
            output=kept,
            overwrite=True,
            snapshots=snapshots,
            progress=progress,
        )
        try:
            result = run(restart=restart if restart.is_file() else None)
        except DataError:  # left by another version
            shutil.rmtree(kept)
            result = run()
        if folder is not None:
            for path in sorted(kept.glob("block*")):
                folder.mkdir(parents=True, exist_ok=True)
                shutil.copy2(path, folder)
        shutil.rmtree(kept)
        return result

    def describe_case(self) -> list[str]:
        """Return the case in words."""
        b, m = self.block, self.material
        size = " x ".join(f"{length * 1e3:g}" for length in b.size)
        mesh = " x ".join(str(count) for count in b.elements)
        strain = ", about its finite compression" if self.finite_strain else ""
        control = "load kept" if self.loading.control == "load" else "height kept"
        return [
            f"{self.solver} block of {size} mm, {mesh} elements, {b.sides} sides{strain}",
            f"roughness Rz {b.roughness.peak_to_valley * 1e6:g} um on a floor of Rz "
            f"{self.floor.peak_to_valley * 1e6:g} um",
            f"shear modulus {m.shear.equilibrium_modulus * 1e-6:.4g} MPa relaxed, "
            f"{m.shear.instantaneous_modulus * 1e-6:.4g} MPa at once, {len(m.shear)} terms; "
            f"bulk modulus {m.bulk_modulus * 1e-6:.4g} MPa",
            f"{self.loading.mean_pressure * 1e-3:g} kPa, then sliding with the {control}",
        ]


def micro_case(path: Path, *, solver: str | None = None) -> MicroCase:
    """Return the case of a file.

    Errors:
        InputError: A file that is no TOML, an unknown key, a value without its unit, and what
            block, surface, material and loading refuse.
    """
    case = _complete_section(read_toml(path), {**_DEFAULTS, "name": path.stem}, "", str(path))
    chosen = choice(str(solver or case["solver"]), ("condensed", "explicit"), "solver")
    if not isinstance(case["finite_strain"], bool):
        raise InputError(
            f"{case['finite_strain']!r}", where="finite_strain", allowed="true or false"
        )
    block, loading = case["block"], case["loading"]
    control = choice(str(loading["control"]), ("height", "load"), "loading.control")
    speeds = loading["speeds"]
    size: Any = tuple(to_si(side, "m", where=f"{path}, block.size") for side in block["size"])
    rubber, assumed = _material(case["material"], path)

    def si(section: str, key: str, unit: str) -> float:
        return to_si(case[section][key], unit, where=f"{path}, {section}.{key}")

    return MicroCase(
        str(case["name"]),
        chosen,
        model.MicroBlock(
            size,
            tuple(block["elements"]),
            si("block", "bottom_layer", "m"),
            _surface(block["roughness"], path, "block.roughness"),
            block["roughness_layers"],
            block["sides"],
        ),
        _surface(case["floor"], path, "floor"),
        rubber,
        model.MicroLoading(
            mean_pressure=si("loading", "mean_pressure", "Pa"),
            slide_distance=si("loading", "slide_distance", "m"),
            control="load" if control == "load" else "displacement",
            **{key: si("loading", key, "s") for key in ("press_time", "hold_time", "ramp_time")},
        ),
        tuple(
            to_si(speed, "m/s", where=f"{path}, loading.speeds")
            for speed in (speeds if isinstance(speeds, list) else [speeds])
        ),
        assumed,
        case["finite_strain"],
        model.ExplicitSettings(**case["explicit"]),
    )


def _complete_section(
    given: Mapping[str, Any], defaults: Mapping[str, Any], section: str, path: str
) -> dict[str, Any]:
    """Return a section with the template's values where it has none; refuse unknown keys."""
    completed = {**defaults, **given}
    for key, value in given.items():
        if key not in _KEYS[section]:
            place = f"{path}, {section}" if section else path
            raise unknown_name("key", key, _KEYS[section], where=place)
        inner = f"{section}.{key}" if section else key
        if inner in _KEYS:
            if not isinstance(value, Mapping):
                raise InputError(
                    Message("{given} is no section", given=repr(value)), where=f"{path}, {inner}"
                )
            kept = {k: v for k, v in defaults.get(key, {}).items() if k not in _CHOICES}
            completed[key] = _complete_section(value, kept, inner, path)
    return completed


def _surface(given: Mapping[str, Any], path: Path, where: str) -> model.MicroSurface:
    if "file" in given:
        surface = read_surface(path.parent / str(given["file"]))
        if not isinstance(surface, HeightMap):
            raise InputError(
                "holds a profile", where=f"{path}, {where}.file", allowed="a height map"
            )
        return model.MicroSurface.of_map(surface if surface.periodic else make_periodic(surface))
    if "peak_to_valley" not in given:
        raise InputError(
            "no roughness",
            where=f"{path}, {where}",
            allowed='peak_to_valley = "35.1 um" with wavelength = "0.4 mm", or file = "scan.xyz"',
        )
    height = to_si(given["peak_to_valley"], "m", where=f"{path}, {where}.peak_to_valley")
    if height == 0.0:
        return model.MicroSurface()
    wavelength = to_si(given["wavelength"], "m", where=f"{path}, {where}.wavelength")
    return model.MicroSurface(str(given.get("form", "cosine")), height, wavelength)


def _material(given: Mapping[str, Any], path: Path) -> tuple[model.MicroMaterial, tuple[str, ...]]:
    where = f"{path}, material"
    kinds = {key: given.get(key) for key in ("report", "power_law", "spectrum")}
    allowed = 'one of: report = "rubber", power_law = {...}, spectrum = "prony.csv"'
    kind = exactly_one(kinds, "no relaxation data", where, allowed)
    nu = to_si(given["poisson_ratio"], "1", where=f"{where}.poisson_ratio")
    if kind == "report":
        young = material.report_elastomer(str(given["report"])).modulus
        assert isinstance(young, material.RelaxationSpectrum)
        shear = material.shear_from_young(young, nu)
    elif kind == "power_law":
        law = given["power_law"]
        if len(law) < 2:
            raise InputError(
                f"{law!r}",
                where=f"{where}.power_law",
                allowed='{ shear_modulus = "0.44 MPa", exponent = 0.12 }',
            )
        modulus = to_si(law["shear_modulus"], "Pa", where=f"{where}.power_law.shear_modulus")
        exponent = to_si(law["exponent"], "1", where=f"{where}.power_law.exponent")
        shear = material.power_law_spectrum(modulus, exponent, terms_per_decade=2)
    else:
        shear = material.shear_from_young(
            material.read_prony(path.parent / str(given["spectrum"]), poisson_ratio=nu), nu
        )
    at = "equilibrium" if shear.equilibrium_modulus else "instantaneous"
    rubber = model.MicroMaterial.from_poisson(shear, nu, at=at)
    if "bulk_modulus" in given:
        bulk_modulus = to_si(given["bulk_modulus"], "Pa", where=f"{where}.bulk_modulus")
        rubber = replace(rubber, bulk_modulus=bulk_modulus)
    return rubber, (f"material: {shear.source}",) if shear.assumed else ()
