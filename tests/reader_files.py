"""A whole file for every reader, by name, with a reader that checks its numbers."""

from __future__ import annotations

import builtins
import re
import tempfile
from functools import cache, partial
from pathlib import Path

import numpy as np

from underfoot.case import Case, load
from underfoot.compute.result import Result
from underfoot.compute.run import run
from underfoot.core import UnderfootError
from underfoot.explore.study_file import load_plan
from underfoot.material import read
from underfoot.shoe.files.read import read_mesh
from underfoot.slip.dynamics.gait import load_history
from underfoot.surface.read import read_surface
from underfoot.trials import read_trial

TESTS = Path(__file__).parent
EXAMPLES = TESTS.parent / "examples"
RAW = [name for name, one in vars(builtins).items() if isinstance(one, type) and "Error" in name]
SWEEP = "f (Hz),E_stor (Pa),E_loss (Pa)\n" + "".join(
    f"{10**k:g},{1e6 * 2**k:g},{2e5 * 2**k:g}\n" for k in range(-3, 4)
)
RUBBER, DATA_FORMS = (TESTS / "data" / name for name in ("rubber_forms", "surface_forms"))
GSF = (
    b"Gwyddion Simple Field 1.0\nXRes = 5\nYRes = 4\nXReal = 5e-5\nYReal = 4e-5\nXYUnits = m\n"
    b"ZUnits = m\n\0\0\0\0"
)
GSF = GSF[: len(GSF) - 4 + (4 - (len(GSF) - 4) % 4)] + np.arange(20, dtype="<f4").tobytes()
PRONY = """# M\u00fcller, compound with \u00b5m particles
modulus = "young"
equilibrium_modulus = "3 MPa"
[[term]]
modulus = "1 MPa"
relaxation_time = "0.01 s"
[[term]]
modulus = "2 MPa"
relaxation_time = "1 s"
"""
HISTORY = "# note: Gr\u00f6\u00dfe\ntime_s,normal_per_body_weight,shear_ratio\n" + "".join(
    f"{k / 50:g},{0.1 + 0.02 * k:g},{0.2 - 0.005 * k:g}\n" for k in range(30)
)
HEIGHTS = "x [\u00b5m]; z [\u00b5m]\n" + "".join(f"{k};{np.sin(k):.4f}\n" for k in range(64))
STUDY = f"""base = "{(EXAMPLES / "work_shoe_untreaded_glycerol.toml").as_posix()}"
[vary]
"motion.speed" = {{ from = "0.3 m/s", to = "0.7 m/s", steps = 3 }}
"shoe.material.shore_a" = [50, 60]
[uncertain]
"contaminant.viscosity" = {{ lognormal = "200 cP", factor = 1.3 }}
[method]
budget = 20
design = "sobol"
"""


def mesh_bytes(kind):
    import trimesh

    data = trimesh.creation.box((0.1, 0.05, 0.01)).export(file_type=kind)
    return data if isinstance(data, bytes) else data.encode()


def checked_mesh(path):
    assert np.isfinite(read_mesh(path).triangles).all()


def checked_sweep(path):
    for one in read.read_dynamic(path):
        assert np.isfinite(one.storage_modulus).all()


def checked_rubber(path):
    test = read.read_rubber(path, modulus_unit="MPa", instantaneous_modulus=8e6)
    for one in test.sweeps if test is not None else ():
        assert np.isfinite(one.storage_modulus).all()


def checked_history(path):
    history = load_history(path)
    assert np.isfinite(history.time).all()


def checked_relaxation(path):
    assert np.isfinite(read.read_relaxation(path)[0].modulus).all()


def checked_trial(path):
    trial = read_trial(path)
    for plate in trial.plates:
        assert not np.isinf(plate.force).any()
    for marker in trial.markers.values():
        assert not np.isinf(marker.positions).any()


def checked_result(part, path):
    """Read the result of which one file is that of ``path``."""
    for name, data in result_files().items():
        if name != part:
            path.with_name(name).write_bytes(data)
    (path.parent / part).write_bytes(path.read_bytes())
    values = Result.load(path.parent).scalars.values()
    assert not [
        one for one in values if one.value is not None and not np.isfinite(float(one.value))
    ]


@cache
def result_files():
    """Return the files of the result of a small case."""
    case = load(EXAMPLES / "work_shoe_untreaded_glycerol.toml")
    case = case.replace({"numerics.quick_grid_spacing": "3 mm", "numerics.grid_spacing": "3 mm"})
    with tempfile.TemporaryDirectory() as folder:
        run(case, quick=True).save(Path(folder) / "one")
        return {path.name: path.read_bytes() for path in (Path(folder) / "one").iterdir()}


SEEDS = {
    **{f"sole.{kind}": (lambda kind=kind: mesh_bytes(kind), checked_mesh) for kind in
       ("stl", "obj", "ply", "off", "glb")},
    "sweep.csv": (lambda: SWEEP.encode(), checked_sweep),
    **{name: ((RUBBER / name).read_bytes, checked_rubber) for name in
       ("reptate_25.osc", "rheocompass_utf16.csv", "general_viscoelastic.k", "viscoelastic.inp",
        "viscoelastic.feb", "prony_beta.csv")},
    "profile.x3p": ((DATA_FORMS / "profile.x3p").read_bytes, read_surface),
    "floor.gsf": (lambda: GSF, read_surface),
    "prony.toml": (lambda: PRONY.encode("latin-1"), read.read_prony),
    "gait.csv": (lambda: HISTORY.encode("latin-1"), checked_history),
    "heights.txt": (lambda: HEIGHTS.encode("utf-16"), read_surface),
    "study.toml": (lambda: STUDY.encode(), load_plan),
    "case.toml": ((EXAMPLES / "work_shoe_untreaded_glycerol.toml").read_bytes, Case.load),
}  # fmt: skip

TRIALS = (
    "bmc/walk1.trc",
    "bmc/walk1.forces",
    "opensim/leg69_stance_grf.mot",
    "btk/ADemo1_rewrite_c3d_pc_integer.c3d",
)
VISCOELASTIC = TESTS / "data" / "viscoelastic" / "pyvisco"
MORE = {
    **{Path(name).name: ((TESTS / "data" / "trials" / name).read_bytes, checked_trial)
       for name in TRIALS},
    "freq_user_raw.csv": ((VISCOELASTIC / "freq_user_raw.csv").read_bytes, checked_sweep),
    "time_user_master.csv": (
        (VISCOELASTIC / "time_user_master.csv").read_bytes, checked_relaxation),
    "dektak-1.csv": ((TESTS / "data" / "roughness" / "dektak-1.csv").read_bytes, read_surface),
    "case_v1.toml": (
        (TESTS / "data" / "case_v1" / "work_shoe_untreaded_glycerol.toml").read_bytes, Case.load),
    "every_slot.toml": ((TESTS / "data" / "case_v1" / "every_slot.toml").read_bytes, Case.load),
    **{f"result_{name}": (lambda name=name: result_files()[name], partial(checked_result, name))
       for name in ("result.json", "case.toml")},
}  # fmt: skip
"""Files that are larger or slower to read: ``fuzz_files.py`` alone damages them.

Not result.nc: of some damaged lists of dimensions the HDF5 library counts for ever, where no signal
ends it.
"""


def refusal(function, path):
    """Return our refusal of a file, None where it is read; anything else that is raised passes."""
    try:
        function(path)
    except UnderfootError as error:
        refused = error
    else:
        return None
    assert not [name for name in RAW if re.search(rf"\b{name}\b", str(refused))], str(refused)
    return refused
