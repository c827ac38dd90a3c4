"""The case of ``underfoot micro``: TOML with units, to block, floor, material and loading."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from underfoot.block import (
        ExplicitSettings,
        MicroBlock,
        MicroLoading,
        MicroMaterial,
        MicroResult,
        MicroSurface,
    )
    from underfoot.core import Progress

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
KEYS: Mapping[str, frozenset[str]] = {
    "": frozenset(
        {"name", "solver", "finite_strain", "block", "floor", "material", "loading", "explicit"}
    ),
    "block": frozenset(
        {"size", "elements", "bottom_layer", "roughness_layers", "sides", "roughness"}
    ),
    "block.roughness": frozenset({"peak_to_valley", "wavelength", "form", "file"}),
    "floor": frozenset({"peak_to_valley", "wavelength", "form", "file"}),
    "material": frozenset({"report", "power_law", "spectrum", "poisson_ratio", "bulk_modulus"}),
    "material.power_law": frozenset({"shear_modulus", "exponent"}),
    "explicit": frozenset({"mass_scaling", "hourglass", "contact_damping", "precision"}),
    "loading": frozenset(
        {
            "mean_pressure",
            "speeds",
            "slide_distance",
            "control",
            "press_time",
            "hold_time",
            "ramp_time",
        }
    ),
}


@dataclass(frozen=True, slots=True, eq=False)
class MicroCase:
    """What ``underfoot micro`` runs."""

    name: str
    solver: str
    block: MicroBlock
    floor: MicroSurface
    material: MicroMaterial
    loading: MicroLoading
    speeds: tuple[float, ...]
    assumed: tuple[str, ...] = ()
    finite_strain: bool = False
    settings: ExplicitSettings | None = None
    _condensed: list[Any] = field(default_factory=list)

    def result(
        self,
        speed: float,
        progress: Progress,
        *,
        snapshots: int = 0,
        folder: Path | None = None,
    ) -> MicroResult:
        """Return the history at one speed; ``folder`` gets the snapshots of explicit elements."""
        loading = replace(self.loading, speed=speed)
        if self.solver == "explicit":
            return self._explicit(loading, progress, snapshots, folder)
        from underfoot.block import (
            condensed_block,
            condensed_poisson_ratio,
            condensed_sliding,
            pressed_block,
            pressure_ratio_of,
        )

        if not self._condensed:
            nu = condensed_poisson_ratio(self.material)
            self._condensed.append(
                pressed_block(
                    self.block, nu, pressure_ratio_of(self.material, loading), progress=progress
                )
                if self.finite_strain
                else condensed_block(self.block, nu, progress=progress)
            )
        return condensed_sliding(
            self._condensed[0], self.floor, self.material, loading, progress=progress
        )

    def _explicit(
        self, loading: MicroLoading, progress: Progress, snapshots: int, folder: Path | None
    ) -> MicroResult:
        """March on from where an earlier run of the same case was stopped, if there is one."""
        import shutil

        from underfoot.block import explicit_sliding
        from underfoot.core import DataError
        from underfoot.core.cache import content_hash, default_folder

        parts = (self.block, self.floor, self.material, loading, self.settings)
        kept = default_folder() / "micro" / content_hash(*parts, snapshots)
        restart = kept / "restart.npz"
        run: dict[str, Any] = {"output": kept, "overwrite": True, "progress": progress}
        run["snapshots"] = snapshots
        try:
            result = explicit_sliding(*parts, restart=restart if restart.is_file() else None, **run)
        except DataError:  # left by another version
            shutil.rmtree(kept)
            result = explicit_sliding(*parts, **run)
        if folder is not None:
            for path in sorted(kept.glob("block*")):
                folder.mkdir(parents=True, exist_ok=True)
                shutil.copy2(path, folder)
        shutil.rmtree(kept)
        return result

    def described(self) -> list[str]:
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

    Errors
    ------
    InputError
        A file that is no TOML, an unknown key, a value without its unit, and what block, surface,
        material and loading refuse.
    """
    import tomllib

    from underfoot.block import ExplicitSettings, MicroBlock, MicroLoading
    from underfoot.core import InputError, to_si, unknown_name

    try:
        given = tomllib.loads(path.read_text(encoding="utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise InputError(f"is no TOML file ({error})", where=str(path)) from error
    _check_keys(given, "", str(path))
    chosen = solver or given.get("solver", "condensed")
    if chosen not in ("condensed", "explicit"):
        raise unknown_name("solver", str(chosen), ("condensed", "explicit"), where="solver")
    finite_strain = given.get("finite_strain", False)
    if not isinstance(finite_strain, bool):
        raise InputError(f"{finite_strain!r}", where="finite_strain", allowed="true or false")
    where = str(path)
    block = given.get("block", {})
    values: dict[str, Any] = {
        key: block[key] for key in ("roughness_layers", "sides") if key in block
    }
    if "size" in block:
        values["size"] = tuple(to_si(v, "m", where=f"{where}, block.size") for v in block["size"])
    if "elements" in block:
        values["elements"] = tuple(block["elements"])
    if "bottom_layer" in block:
        values["bottom_layer"] = to_si(block["bottom_layer"], "m", where=f"{where}, block")
    rough = block.get("roughness", {"peak_to_valley": "35.1 um", "wavelength": "0.5 mm"})
    floor = given.get("floor", {"peak_to_valley": "35.1 um", "wavelength": "0.4 mm"})
    loading = given.get("loading", {})
    speeds = loading.get("speeds", ["0.1 m/s", "1 m/s"])
    times = ("press_time", "hold_time", "ramp_time")
    pressing: dict[str, Any] = {
        key: to_si(loading[key], "s", where=f"{where}, loading.{key}")
        for key in times
        if key in loading
    }
    control = loading.get("control", "height")
    if control not in ("height", "load"):
        raise unknown_name("control", str(control), ("height", "load"), where="loading.control")
    material, assumed = _material(given.get("material", {"report": "rubber"}), path)
    return MicroCase(
        str(given.get("name", path.stem)),
        str(chosen),
        MicroBlock(**values, roughness=_surface(rough, path, "block.roughness")),
        _surface(floor, path, "floor"),
        material,
        MicroLoading(
            mean_pressure=to_si(
                loading.get("mean_pressure", "160 kPa"), "Pa", where="loading.mean_pressure"
            ),
            slide_distance=to_si(
                loading.get("slide_distance", "1.2 mm"), "m", where="loading.slide_distance"
            ),
            control="load" if control == "load" else "displacement",
            **pressing,
        ),
        tuple(
            to_si(v, "m/s", where="loading.speeds")
            for v in (speeds if isinstance(speeds, list) else [speeds])
        ),
        tuple(assumed),
        finite_strain,
        ExplicitSettings(**given.get("explicit", {})),
    )


def _surface(given: Mapping[str, Any], path: Path, where: str) -> MicroSurface:
    from underfoot.block import MicroSurface
    from underfoot.core import InputError, to_si

    if "file" in given:
        from underfoot.surface import HeightMap, periodised, read_surface

        found = read_surface(path.parent / str(given["file"]))
        if not isinstance(found, HeightMap):
            raise InputError(
                "holds a profile", where=f"{path}, {where}.file", allowed="a height map"
            )
        return MicroSurface.of_map(found if found.periodic else periodised(found))
    if "peak_to_valley" not in given:
        raise InputError(
            "no roughness",
            where=f"{path}, {where}",
            allowed='peak_to_valley = "35.1 um" with wavelength = "0.4 mm", or file = "scan.xyz"',
        )
    height = to_si(given["peak_to_valley"], "m", where=f"{path}, {where}.peak_to_valley")
    if height == 0.0:
        return MicroSurface()
    return MicroSurface(
        str(given.get("form", "cosine")),
        height,
        to_si(given.get("wavelength", "0.4 mm"), "m", where=f"{path}, {where}.wavelength"),
    )


def _material(given: Mapping[str, Any], path: Path) -> tuple[MicroMaterial, list[str]]:
    from underfoot.block import MicroMaterial
    from underfoot.core import InputError, to_si
    from underfoot.material import (
        RelaxationSpectrum,
        bulk_modulus,
        power_law_spectrum,
        read_prony,
        report_elastomer,
        shear_from_young,
        youngs_modulus_from_shear,
    )

    kinds = [key for key in ("report", "power_law", "spectrum") if key in given]
    if len(kinds) != 1:
        raise InputError(
            "no relaxation data" if not kinds else f"{' and '.join(kinds)} together",
            where=f"{path}, material",
            allowed='one of: report = "rubber", power_law = {...}, spectrum = "prony.csv"',
        )
    nu = float(given.get("poisson_ratio", 0.499))
    if not 0.0 < nu < 0.5:
        raise InputError(
            f"Poisson's ratio {nu:g}",
            where=f"{path}, material.poisson_ratio",
            allowed="0 to 0.5, both excluded",
            remedy="Choose 0.499 for rubber: at 0.5 the bulk modulus is infinite",
        )
    assumed = []
    if kinds[0] == "report":
        young = report_elastomer(str(given["report"])).modulus
        assert isinstance(young, RelaxationSpectrum)
        shear = shear_from_young(young)
    elif kinds[0] == "power_law":
        law = given["power_law"]
        if not isinstance(law, Mapping) or "shear_modulus" not in law or "exponent" not in law:
            raise InputError(
                f"{law!r}",
                where=f"{path}, material.power_law",
                allowed='{ shear_modulus = "0.44 MPa", exponent = 0.12 }',
            )
        shear = power_law_spectrum(
            to_si(law["shear_modulus"], "Pa", where="material.power_law.shear_modulus"),
            float(law["exponent"]),
            terms_per_decade=2,
        )
    else:
        shear = shear_from_young(read_prony(path.parent / str(given["spectrum"])), nu)
    if shear.assumed:
        assumed.append(f"material: {shear.source}")
    if "bulk_modulus" in given:
        k = to_si(given["bulk_modulus"], "Pa", where="material.bulk_modulus")
    else:
        g = shear.equilibrium_modulus or shear.instantaneous_modulus
        k = float(bulk_modulus(youngs_modulus_from_shear(g, nu), nu))
    return MicroMaterial(shear, k, source=shear.source), assumed


def _check_keys(given: Mapping[str, Any], section: str, path: str) -> None:
    from underfoot.core import InputError, unknown_name

    for key, value in given.items():
        if key not in KEYS[section]:
            place = f"{path}, {section}" if section else path
            raise unknown_name("key", key, KEYS[section], where=place)
        inner = f"{section}.{key}" if section else key
        if inner in KEYS:
            if not isinstance(value, Mapping):
                raise InputError(f"{value!r} is no section", where=f"{path}, {inner}")
            _check_keys(value, inner, path)
