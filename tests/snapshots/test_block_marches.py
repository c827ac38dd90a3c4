"""Rough blocks: meshes, compliance, both marches, restarts, cases of the command, refusals."""

import math
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from block_loops import plain, written_loops
from snapshot import held, refusal
from underfoot.block._kernels import motion, names
from underfoot.block._kernels.active_set import contact_at_height, contact_under_load
from underfoot.block._kernels.floor import floor_at_points
from underfoot.block._kernels.hexahedron import mean_gradient, stiffness_matrices
from underfoot.block.assembly import (
    ExplicitSettings,
    assemble_march,
    impact_friction,
    largest_mass_scaling,
    mass_scaling_error,
)
from underfoot.block.command_input import TEMPLATE, micro_case
from underfoot.block.compliance import bulk_ratio, condensed_block, pressed_block
from underfoot.block.condensed import (
    condensed_poisson_ratio,
    condensed_sliding,
    edge_corrected_contact_area,
    nodal_contact_area,
    pressure_ratio_of,
)
from underfoot.block.explicit import explicit_sliding
from underfoot.block.inputs import MicroBlock, MicroLoading, MicroMaterial, MicroSurface
from underfoot.block.march import collection, loaded_state
from underfoot.block.mesh import block_mesh, layer_heights
from underfoot.block.one_term_fit import fit_single_exponential
from underfoot.block.prony_march import (
    advance_memory,
    known_displacement,
    prony_step,
    relaxed_memory,
)
from underfoot.block.report_g1 import report_block, report_floor, report_loading, report_material
from underfoot.block.result import MicroResult, edge_excess_area, whole_wavelength_averages
from underfoot.core import Cancelled
from underfoot.material import Elastomer, RelaxationSpectrum
from underfoot.surface import HeightMap

ONE = RelaxationSpectrum(0.5e6, np.array([0.3e6]), np.array([1e-3]))
TWO = RelaxationSpectrum(0.5e6, np.array([0.3e6, 0.2e6]), np.array([1e-3, 2e-5]))
NONE = RelaxationSpectrum(0.6e6, np.array([]), np.array([]))
RUBBER = MicroMaterial.from_poisson(TWO, 0.49)
NU = condensed_poisson_ratio(RUBBER)
SMALL = MicroBlock((0.4e-3, 0.4e-3, 0.2e-3), (8, 8, 3), 40e-6,
                   MicroSurface.checkerboard(8e-6, 0.4e-3, offset=(3e-5, 1e-5)), 2)  # fmt: skip
SIDELESS = replace(SMALL, sides="periodic")
FLOOR = MicroSurface.checkerboard(10e-6, 0.2e-3, offset=(1e-5, 2e-5))
QUICK = MicroLoading(60e3, 1.0, 0.2e-3, "displacement", 2e-5, 2e-5, 1e-5)
MAP = HeightMap(2e-6 * np.random.default_rng(2).normal(size=(8, 8)), 5e-5, periodic=True)


def told(result: MicroResult) -> dict[str, Any]:
    """Return a result without the time that it took."""
    names = (
        "time", "distance", "normal_force", "shear_force", "lateral_force", "real_contact_area",
        "corrected_contact_area", "height", "nominal_area", "averages", "energy", "status",
        "steps", "time_step", "notes", "breaches",
    )  # fmt: skip
    return {name: getattr(result, name) for name in names}


SURFACES: dict[str, MicroSurface] = {
    "flat": MicroSurface(),
    "cosine": FLOOR,
    "triangular": MicroSurface.checkerboard(10e-6, 0.2e-3, form="triangular", offset=(1e-5, 0.0)),
    "wave": MicroSurface("wave", 10e-6, 0.2e-3, (1e-5, 0.0)),
    "paraboloid": MicroSurface("paraboloid", radius=1e-3, offset=(2e-4, 1e-4)),
    "map": MicroSurface.of_map(MAP, offset=(1e-5, 3e-5)),
}


def test_faces_and_meshes(file_regression):
    x, y = np.linspace(-1.13e-4, 5.3e-4, 9), np.linspace(3.1e-4, -2.27e-4, 9)
    said: dict[str, Any] = {
        name: (one.height_and_slope(x, y), one.height(1e-4, 2e-4), one.rough, one.kernel_arrays(),
               floor_at_points(x, y, *one.kernel_arrays()))
        for name, one in SURFACES.items()
    }  # fmt: skip
    even = replace(SMALL, bottom_layer=None)
    for name, block in (("free", SMALL), ("periodic", SIDELESS), ("even", even)):
        mesh = block_mesh(block)
        moved = 1e-6 * np.random.default_rng(1).normal(size=mesh.nodes.shape)
        said[f"mesh {name}"] = (
            mesh, mesh.offsets, mesh.deformation_gradient(moved), mesh.largest_gradient_square(),
            mesh.largest_gradient_square(moved), layer_heights(block), block.nominal_area,
        )  # fmt: skip
    corners = block_mesh(SMALL).nodes.T[block_mesh(SMALL).elements[:2, None]
                                        + block_mesh(SMALL).offsets]  # fmt: skip
    said["gradients"] = mean_gradient(corners)
    said["stiffness"] = stiffness_matrices(corners, 1.0, 30.0)
    said["materials"] = [
        (one, one.poisson_ratio, one.wave_speeds)
        for one in (RUBBER, MicroMaterial.from_poisson(ONE, 0.49),
                    MicroMaterial.from_poisson(ONE, 0.49, at="instantaneous", name="a"),
                    MicroMaterial.from_elastomer(Elastomer(3e6, 0.49), elastic=True))
    ]  # fmt: skip
    held(file_regression, said)


def test_the_blocks_of_the_report(file_regression):
    said = {
        "blocks": [report_block(shoe, asperities=a) for shoe in ("low", "high")
                   for a in ("tenths", "nodes")],
        "floors": [report_floor(f, asperities=a) for f in ("low", "medium", "high")
                   for a in ("tenths", "nodes")],
        "materials": [report_material(m, bulk=b) for m in ("rubber", "neolite")
                      for b in ("corrected", "printed")],
        "loads": [report_loading(0.5), report_loading(0.1, wavelengths=3)],
        "defaults": (MicroLoading(), MicroBlock(), MicroSurface(), ExplicitSettings()),
    }  # fmt: skip
    held(file_regression, said)


def test_condensed_blocks(file_regression):
    said: dict[str, Any] = {}
    for name, block in (("free", SMALL), ("periodic", SIDELESS)):
        made = condensed_block(block, NU)
        wide = condensed_block(block, NU, sideways=True)
        touching = np.arange(made.areas.size) % 5 < 2
        said[name] = (
            made.points, made.areas, made.grid, made.unit_compliance, wide.unit_vector_compliance,
            nodal_contact_area(made, touching), edge_corrected_contact_area(made, touching),
        )  # fmt: skip
        np.testing.assert_allclose(
            wide.unit_vector_compliance[2, :, 2, :], made.unit_compliance, rtol=1e-7, atol=1e-3
        )
        for kind, condensed, load in (
            ("kept", made, QUICK), ("loaded", made, replace(QUICK, control="load")),
            ("sideways", wide, replace(QUICK, slide_distance=0.1e-3)),
        ):  # fmt: skip
            slid = condensed_sliding(condensed, FLOOR, RUBBER, load)
            said[f"{name} {kind}"] = told(slid)
    flat = condensed_sliding(made, MicroSurface(), RUBBER, QUICK)
    said["smooth"] = told(flat)
    stiff = MicroMaterial.from_poisson(NONE, NU)
    elastic = condensed_sliding(made, FLOOR, stiff, QUICK)
    said["elastic"] = elastic.averages, elastic.notes
    still = condensed_sliding(made, FLOOR, RUBBER, replace(QUICK, speed=0.0, slide_distance=0.0))
    said["still"] = still.averages, still.notes, still.normal_force
    heavy = condensed_sliding(made, FLOOR, RUBBER, replace(QUICK, mean_pressure=300e3))
    said["heavy"] = heavy.notes, heavy.averages

    def stops(stage: str, fraction: float, residual: float | None = None) -> None:
        if fraction > 0.5:
            raise Cancelled("enough")

    ended = condensed_sliding(made, FLOOR, RUBBER, QUICK, progress=stops)
    said["cancelled"] = ended.status, ended.notes, ended.time.size
    said["ratios"] = (condensed_poisson_ratio(RUBBER), pressure_ratio_of(RUBBER, QUICK),
                      [bulk_ratio(nu) for nu in (0.0, 0.3, 0.499)])  # fmt: skip
    pressed = pressed_block(SMALL, NU, 0.2)
    said["pressed"] = pressed.points, pressed.unit_compliance, pressed.pressure_ratio
    said["pressed slides"] = told(
        condensed_sliding(pressed, FLOOR, RUBBER, replace(QUICK, slide_distance=0.05e-3))
    )
    held(file_regression, said, hide=r"asymmetry: .*")


MARCHES: dict[str, tuple[MicroBlock, MicroMaterial, dict[str, Any], dict[str, Any]]] = {
    "two terms": (SMALL, RUBBER, {}, {}),
    "one term": (SIDELESS, MicroMaterial(ONE, 20e6), {"control": "load"}, {}),
    "elastic": (SMALL, MicroMaterial(NONE, 20e6), {}, {"contact_damping": 0.1, "cfl": 0.5}),
    "viscous": (SMALL, MicroMaterial(ONE, 20e6), {}, {"hourglass": "viscous"}),
    "bulk": (SIDELESS, RUBBER, {}, {"bulk_viscosity": 0.06, "penalty_factor": 0.7}),
    "scaled": (SMALL, RUBBER, {}, {"mass_scaling": 3.0, "hourglass_coefficient": 1.0,
                                   "hourglass_modulus": 1e6}),
    "auto": (SMALL, RUBBER, {"speed": 0.5}, {"mass_scaling": "auto"}),
}  # fmt: skip


@pytest.mark.slow  # each kind of material is compiled on its first use, 20 s each
@pytest.mark.parametrize("name", MARCHES)
def test_explicit_marches(file_regression, name):
    block, material, loading, settings = MARCHES[name]
    load = replace(QUICK, **{"slide_distance": 2e-5, **loading})
    given = ExplicitSettings(samples_per_wavelength=100, **settings)
    made = explicit_sliding(block, FLOOR, material, load, given)
    held(file_regression, told(made), f"march_{name}")
    assembly = assemble_march(block, FLOOR, material, load, given)
    assert assembly.impact_friction >= 0


def test_steps_of_the_written_loops(file_regression):
    loops, said = written_loops(), dict[str, Any]()
    tiny = {"size": (0.2e-3, 0.2e-3, 0.1e-3), "elements": (4, 4, 2),
            "roughness": MicroSurface.checkerboard(4e-6, 0.2e-3), "bottom_layer": None}  # fmt: skip
    for name, (block, material, loading, settings) in MARCHES.items():
        made = assemble_march(
            replace(block, **tiny), FLOOR, material, replace(QUICK, **loading),
            ExplicitSettings(**settings),
        )  # fmt: skip
        u, v, _ = made.nodes
        rng = np.random.default_rng(8)
        u[:], v[:] = 2e-7 * rng.normal(size=u.size), 1e-2 * rng.normal(size=v.size)
        u[-u.size // 3 :] -= 2e-6
        if loading:  # the plate carries a load and the floor moves
            made.control[[names.FREE, names.LOAD, names.LOAD_TIME]] = 1.0, 2e-3, 1e-6
            made.control[names.SLIDE_START] = 0.0
        loops[made.kernel](3, made.nodes, made.arrays, made.constants, made.history,
                           made.parameters, made.work, made.floor, made.state, made.control,
                           made.terms)  # fmt: skip
        said[name] = {"state": made.state, "u": u, "v": v, "f": made.nodes[2],
                      "history": made.history, "touch": made.arrays[11]}  # fmt: skip
    for name, floor in SURFACES.items():
        block = SMALL if name == "map" else replace(SMALL, **tiny)
        floor = replace(floor, wavelength=0.2e-3)
        made = assemble_march(block, floor, RUBBER, QUICK, ExplicitSettings())
        made.nodes[0][-made.nodes[0].size // 3 :] -= 2e-6
        plain(motion.contact)(made.nodes, made.arrays, made.floor, made.state, made.control)
        said[f"on {name}"] = made.nodes[2], made.state
    held(file_regression, said)


def test_assemblies(file_regression):
    said: dict[str, Any] = {}
    for name, (block, material, loading, settings) in MARCHES.items():
        load = replace(QUICK, **loading)
        made = assemble_march(block, FLOOR, material, load, ExplicitSettings(**settings))
        said[name] = (
            made.constants, made.parameters, made.terms, made.control, made.time_step,
            made.density, made.penalty, made.mass_scaling, made.impact_friction, made.kernel,
            made.arrays, made.history.shape,
        )  # fmt: skip
    for name, floor in SURFACES.items():
        floor = replace(floor, wavelength=0.4e-3) if name == "wave" else floor
        said[f"floor {name}"] = impact_friction(SMALL, floor, 1e3, QUICK)
    single = ExplicitSettings(precision="single", time_step=1e-9, penalty_stiffness=1e10)
    made = assemble_march(SMALL, FLOOR, RUBBER, QUICK, single)
    said["single"] = made.constants.dtype.name, made.time_step, made.penalty
    said["scaling"] = (
        mass_scaling_error(1.0, 20.0, 3.0),
        [largest_mass_scaling(*one) for one in ((1.0, 20.0), (0.0, 20.0), (1.0, 20.0, 1e-5),
                                                (1.0, 20.0, 1.0), (1e-3, 20.0, 0.0))],
    )  # fmt: skip
    held(file_regression, said)


@pytest.mark.slow
def test_restarts_and_snapshots(file_regression, tmp_path):
    load = replace(QUICK, slide_distance=2e-5)
    given = ExplicitSettings(samples_per_wavelength=100)
    calls: list[Any] = []

    def stops(stage: str, fraction: float, residual: float | None = None) -> None:
        calls.append(stage)
        if fraction > 0.6:
            raise Cancelled("enough")

    parts = SMALL, FLOOR, RUBBER, load, given
    whole = explicit_sliding(*parts)
    half = explicit_sliding(*parts, output=tmp_path / "a", snapshots=2, progress=stops)
    restart = tmp_path / "a" / "restart.npz"
    rest = explicit_sliding(*parts, restart=restart, output=tmp_path / "a", snapshots=2)
    np.testing.assert_array_equal(rest.shear_force, whole.shear_force)
    assert rest.steps == whole.steps
    collection(tmp_path / "b.pvd", [(1e-3, "a & b.vtu")])
    said = {
        "half": (half.status, half.notes, half.time.size), "stages": list(dict.fromkeys(calls)),
        "files": sorted(path.name for path in (tmp_path / "a").iterdir()),
        "pvd": (tmp_path / "b.pvd").read_text(encoding="utf-8"),
        "other": refusal(explicit_sliding, *parts[:3], replace(load, speed=0.9), given,
                         restart=restart),
        "damaged": refusal(loaded_state, Path(__file__), "a"),
        "full folder": refusal(explicit_sliding, *parts, output=tmp_path / "a"),
    }  # fmt: skip
    held(
        file_regression, said, hide=rf"\S*/test_block_marches\.py|{re.escape(str(tmp_path))}|FOLDER"
    )


def test_steps_of_relaxation_and_contact(file_regression):
    step = prony_step([0.3, 0.2], [1e3, 1e-6], 1e-4)
    rng = np.random.default_rng(3)
    old, new = rng.random((2, 3, 4))
    memory = relaxed_memory(old, [0.3, 0.2])
    known = known_displacement(memory, old, step)
    advance_memory(memory, old, new, step)
    matrix = rng.random((12, 12))
    compliance = 1e-3 * (matrix @ matrix.T + 4 * np.eye(12))
    gaps = 1e-3 * rng.random(12)
    none = np.zeros(12, bool)
    time = np.geomspace(1e-3, 10, 15)
    curves = {
        "good": 1e6 + 2e6 * np.exp(-time / 0.3), "short": 1e6 + 2e6 * np.exp(-time / 300.0),
        "over": 1e6 + 1e5 * np.exp(-time / 1e-5), "falls": 2e6 * np.exp(-time / 0.3) + 1.0,
        "broad": 1e6 + 2e6 * (time / 1e-3) ** -0.2,
    }  # fmt: skip
    distance = np.linspace(0.02, 2.3, 40)
    values = [10 + np.sin(6 * distance), np.cos(6 * distance), np.abs(np.cos(6 * distance)),
              1.2 * np.abs(np.cos(6 * distance)), 2 + 0 * distance, 1.5 + 0 * distance]  # fmt: skip
    touching = np.zeros((5, 6), bool)
    touching[1:3, 2:5] = touching[4, 0] = True
    said = {
        "step": step, "known": known, "memory": memory,
        "under load": [contact_under_load(compliance, gaps, load, start)
                       for load in (0.1, 2.0) for start in (none, ~none)],
        "at height": [contact_at_height(compliance, gaps, height, none)
                      for height in (0.0, -1e-4, -2e-3)],
        "fits": {name: (fit, str(fit)) for name, fit in (
            (name, fit_single_exponential(time, curve)) for name, curve in curves.items())},
        "edges": [edge_excess_area(touching, 1e-3, 2e-3, periodic=way) for way in (True, False)],
        "means": [whole_wavelength_averages(distance, values, w, 3.0)
                  for w in (0.5, 1.2, 2.3, 2.31, math.inf)],
        "few": whole_wavelength_averages(distance[:3], [v[:3] for v in values], 0.02, 3.0),
        "pulled": whole_wavelength_averages(distance, [-v for v in values], 0.5, 3.0),
        "spots": whole_wavelength_averages(distance, [*values[:5], 0.9 + 0 * distance], 0.5, 3.0),
    }  # fmt: skip
    held(file_regression, said)


CASES = {
    "template": TEMPLATE,
    "nothing": "",
    "others": """
solver = "explicit"
finite_strain = true
[block]
size = ["0.4 mm", "0.4 mm", "0.2 mm"]
elements = [8, 8, 3]
bottom_layer = "40 um"
roughness_layers = 2
sides = "periodic"
[block.roughness]
peak_to_valley = "0 um"
[floor]
peak_to_valley = "5 um"
wavelength = "0.2 mm"
form = "triangular"
[material]
power_law = { shear_modulus = "0.44 MPa", exponent = 0.12 }
bulk_modulus = "300 MPa"
[loading]
speeds = "0.3 m/s"
control = "load"
[explicit]
mass_scaling = "auto"
""",
}
BAD = {
    "key": "solverr = 1", "solver": 'solver = "fast"', "strain": 'finite_strain = "yes"',
    "inner key": "[block]\nsizes = 1", "no section": "block = 3",
    "control": '[loading]\ncontrol = "speed"', "unit": '[loading]\nmean_pressure = "3 m"',
    "no roughness": '[floor]\nform = "cosine"\nwavelength = "1 mm"\n',
    "two materials": '[material]\nreport = "rubber"\nspectrum = "a.csv"',
    "law": "[material]\npower_law = {exponent = 0.1}", "text": "[[",
    "material": '[material]\nreport = "steel"', "no file": '[floor]\nfile = "scan.xyz"',
}  # fmt: skip


def test_cases_of_the_command(file_regression, tmp_path):
    said: dict[str, Any] = {}
    path = tmp_path / "case.toml"
    for name, text in CASES.items():
        path.write_text(text, encoding="utf-8")
        case = micro_case(path)
        said[name] = case, case.describe_case()
    other = micro_case(path, solver="condensed")
    said["solver"] = other.solver, other.describe_case()
    small = replace(
        other, block=SIDELESS, floor=FLOOR, material=RUBBER, loading=QUICK, finite_strain=False
    )
    made = small.result(1.0, lambda *_: None)
    said["run"] = made.averages, made.notes
    for name, text in BAD.items():
        path.write_text(text, encoding="utf-8")
        said[f"refused {name}"] = refusal(micro_case, path).replace(str(tmp_path), "FOLDER")
    held(file_regression, said)


REFUSED: dict[str, Callable[[], Any]] = {
    "form": lambda: MicroSurface("sine"),
    "depth": lambda: MicroSurface("cosine", -1e-6),
    "wave": lambda: MicroSurface("cosine", 1e-6, 0.0),
    "radius": lambda: MicroSurface("paraboloid", radius=0.0),
    "no map": lambda: MicroSurface("map"),
    "open map": lambda: MicroSurface.of_map(HeightMap(MAP.heights, 5e-5)),
    "infinite": lambda: MicroMaterial(ONE, math.inf),
    "soft": lambda: MicroMaterial(ONE, 0.5e6),
    "light": lambda: MicroMaterial(ONE, 1e8, 0.0),
    "at": lambda: MicroMaterial.from_poisson(ONE, 0.4, at="rest"),
    "poisson": lambda: MicroMaterial.from_poisson(ONE, 0.5),
    "no poisson": lambda: MicroMaterial.from_poisson(ONE, 0.0),
    "flows": lambda: MicroMaterial.from_poisson(
        RelaxationSpectrum(0.0, np.array([1e6]), np.array([1e-3])), 0.4),
    "no data": lambda: MicroMaterial.from_elastomer(Elastomer(3e6, 0.49)),
    "size": lambda: replace(SMALL, size=(1e-3, 0.0, 1e-3)),
    "two sizes": lambda: replace(SMALL, size=(1e-3, 1e-3)),
    "elements": lambda: replace(SMALL, elements=(8, 0, 3)),
    "sides": lambda: replace(SMALL, sides="open"),
    "layer": lambda: replace(SMALL, bottom_layer=0.2e-3),
    "layers": lambda: replace(SMALL, roughness_layers=4),
    "no layers": lambda: replace(SMALL, roughness_layers=0),
    "pressure": lambda: MicroLoading(0.0),
    "speed": lambda: MicroLoading(speed=-0.1),
    "press": lambda: MicroLoading(press_time=0.0),
    "control": lambda: MicroLoading(control="speed"),
    "ratio": lambda: block_mesh(replace(SMALL, bottom_layer=2e-6)),
    "thick": lambda: block_mesh(replace(SMALL, bottom_layer=0.15e-3)),
    "deep": lambda: block_mesh(
        replace(SMALL, roughness=MicroSurface.checkerboard(0.2e-3, 0.4e-3))),
    "long": lambda: block_mesh(
        replace(SMALL, roughness=MicroSurface.checkerboard(1e-6, 0.41e-3))),
    "coarse": lambda: block_mesh(
        replace(SMALL, roughness=MicroSurface.checkerboard(1e-6, 0.15e-3))),
    "repeats": lambda: block_mesh(
        replace(SIDELESS, roughness=MicroSurface.checkerboard(1e-6, 0.3e-3))),
    "bulk": lambda: bulk_ratio(0.5),
    "no bulk": lambda: bulk_ratio(-0.01),
    "pressed": lambda: pressed_block(SMALL, 0.49, 1.01),
    "not pressed": lambda: pressed_block(SMALL, 0.49, 0.0),
    "steps": lambda: condensed_sliding(SMALL, FLOOR, RUBBER, QUICK, steps_per_wavelength=15),
    "rests": lambda: condensed_sliding(SMALL, FLOOR, RUBBER, replace(QUICK, speed=0.0)),
    "other": lambda: condensed_sliding(condensed_block(SMALL, 0.4), FLOOR, RUBBER, QUICK),
    "hourglass": lambda: ExplicitSettings(hourglass="soft"),
    "precision": lambda: ExplicitSettings(precision="half"),
    "cfl": lambda: ExplicitSettings(cfl=1.0),
    "no cfl": lambda: ExplicitSettings(cfl=0.0),
    "scaling": lambda: ExplicitSettings(mass_scaling=0.99),
    "words": lambda: ExplicitSettings(mass_scaling="much"),
    "step": lambda: ExplicitSettings(time_step=0.0),
    "damping": lambda: ExplicitSettings(contact_damping=-0.1),
    "samples": lambda: ExplicitSettings(samples_per_wavelength=19),
    "long step": lambda: assemble_march(SMALL, FLOOR, RUBBER, QUICK,
                                        ExplicitSettings(time_step=1e-3)),
    "stiff": lambda: assemble_march(SMALL, FLOOR, RUBBER, QUICK,
                                    ExplicitSettings(penalty_stiffness=1e16)),
    "floor": lambda: assemble_march(SIDELESS, MicroSurface.checkerboard(1e-6, 0.3e-3), RUBBER,
                                    QUICK, ExplicitSettings()),
    "shoe": lambda: report_block("middle"), "asperities": lambda: report_floor("low",
                                                                             asperities="x"),
    "rubber": lambda: report_material("steel"), "bulk of": lambda: report_material("rubber",
                                                                                  bulk="x"),
}  # fmt: skip


def test_what_is_refused(file_regression):
    held(file_regression, {name: refusal(call) for name, call in REFUSED.items()})
