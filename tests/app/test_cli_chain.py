"""Two scans, a rubber test, an outsole and a walker become COF and slip probability."""

import json
import shutil
from pathlib import Path

import numpy as np
import pytest

from commands import called, process
from underfoot.case import Case
from underfoot.compute.resolve import resolve_context
from underfoot.compute.result import Result
from underfoot.core import DataError, InputError
from underfoot.rough_contact import ContactTable

ROOT = Path(__file__).parents[2]
MEASURED = ROOT / "examples" / "measured"
WALK = ROOT / "tests" / "data" / "trials" / "kineticstoolkit" / "c3d_sample.c3d"
COARSE = {"numerics.quick_grid_spacing": "2 mm", "numerics.tread_positions": 1}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """The example with its compound, and a folder with the walker's recording."""
    folder = tmp_path_factory.mktemp("chain")
    for file in MEASURED.iterdir():
        if file.is_file():
            shutil.copy(file, folder)
    (folder / "walk").mkdir()
    shutil.copy(WALK, folder / "walk")
    done = called("material", "dma.csv", "--out", "compound.toml", folder=folder)
    assert done.returncode == 0, done.stderr
    return folder


def law(case):
    return case.friction.build(resolve_context(case))


@pytest.mark.slow
def test_five_commands_from_measurements_to_cof_and_slip_probability(tmp_path):
    for name in ("floor.csv", "sole.csv", "dma.csv", "heel.stl", "case.toml"):
        shutil.copy(MEASURED / name, tmp_path)
    (tmp_path / "walk").mkdir()
    shutil.copy(WALK, tmp_path / "walk")
    coarse = [word for path, value in COARSE.items() for word in ("--set", f"{path}={value}")]
    commands = (
        ("surface", "floor.csv", "--out", "floor"),
        ("surface", "sole.csv", "--out", "sole"),
        ("material", "dma.csv", "--out", "compound.toml"),
        ("trials", "analyse", "walk", "--protocol", "level_walking", "--out", "rcof"),
        ("run", "case.toml", "--rcof-from", "rcof/tables/measurements.csv", "--quick", *coarse),
    )
    for words in commands:
        done = process(*words, folder=tmp_path, UNDERFOOT_CACHE=str(tmp_path / "cache"))
        assert done.returncode == 0, (words, done.stderr)
    assert "between 3 steps of one walker" in done.stderr
    result = Result.load(tmp_path / "out" / "case")
    numbers = {name: scalar.value for name, scalar in result.scalars.items()}
    assert 0.03 < numbers["cof"] < 1.0
    assert 0.0 < numbers["slip_probability"] < 1.0
    assert result.provenance.closures["asperity contact"] == "contact table"
    for name in ("micro_contact", "micro_hysteresis", "micro_gap", "micro_flow"):
        assert numbers[name] > 0
        assert result.scalars[name].interval is not None
    told = result.labels["cof_spread_from"]
    for share in ("hysteresis of the rough contact", "gap between", "flow between"):
        assert share in told


def test_measured_surfaces_and_compound_choose_the_contact_table(folder):
    case = Case.load(folder / "case.toml")
    assert case.rough_contact.name == "contact_table"
    assert case.origins["rough_contact.model"].kind == "default"
    assert "rough_contact" not in case.to_toml()
    assert {"interface.hurst", "interface.roughness_beyond_cutoff"} <= case.idle_paths
    for change in (
        {"floor.roughness.file": None},
        {"shoe.roughness.file": None},
        {"shoe.material.file": None},
    ):
        assert case.replace(change).rough_contact.name == "exponential", change
    assert case.replace("rough_contact.model", "exponential").rough_contact.name == "exponential"
    rest = {"shoe.material.file": None, "shoe.material.modulus": "5 MPa"}
    assert case.replace(rest).rough_contact.name == "exponential"
    spectrum = {"shear_modulus": {"value": "1 MPa", "assumed": True}, "time": "1 us"}
    relaxation = {"equilibrium_shear_modulus": {"value": "1 MPa", "assumed": True}}
    assumed = {**rest, "shoe.material.relaxation": {**relaxation, "terms": [spectrum]}}
    assert case.replace(assumed).rough_contact.name == "exponential"


@pytest.mark.slow
def test_the_floors_scan_moves_hysteresis_area_gap_and_flow_by_its_spectrum(folder):
    """Heights scaled to one Rq, so that what moves is the spectrum: finer waves are steeper."""
    rows = np.loadtxt(folder / "floor.csv", delimiter=",", skiprows=1)
    smooth = np.convolve(rows[:, 1], np.hanning(61) / np.hanning(61).sum(), "same")
    smooth *= rows[:, 1].std() / smooth.std()
    lines = [f"{x:.3f},{z:.3f}" for x, z in zip(rows[:, 0], smooth, strict=True)]
    (folder / "smooth.csv").write_text("\n".join(["x (mm),z (um)", *lines, ""]))
    given = {"floor.roughness.rq": "3 um"}
    case = Case.load(folder / "case.toml").replace(given)
    other = case.replace("floor.roughness.file", str(folder / "smooth.csv")).replace(given)
    tables = [one.rough_contact.table(resolve_context(one)) for one in (case, other)]
    at = 3e5, case.motion.speed
    area, loss, gap = (
        [float(getattr(table, name)(*at)) for table in tables]
        for name in ("real_contact_fraction", "cof_hysteresis", "mean_gap")
    )
    assert area[1] > 1.2 * area[0]
    assert loss[1] < 0.8 * loss[0]
    assert abs(gap[1] / gap[0] - 1) > 0.02
    hysteresis = [law(one).pair.hysteresis for one in (case, other)]
    assert hysteresis == pytest.approx(loss, rel=1e-6)
    dry = [law(one.replace("contaminant", "none")).pair.full_contact for one in (case, other)]
    assert dry[1] < dry[0]


@pytest.mark.slow
def test_what_underfoot_contact_writes_is_taken_as_it_is(folder):
    done = called(
        *("contact", "floor.csv", "--sole", "sole.csv", "--spectrum", "compound.toml"),
        *("--speed", "0.3 m/s", "--poisson", "0.49", "--table", "contact.npz"),
        folder=folder,
    )
    assert done.returncode == 0, done.stderr
    assert '[rough_contact]\nfile = "contact.npz"' in done.stdout
    case = Case.load(folder / "case.toml")
    filed = case.replace("rough_contact.file", str(folder / "contact.npz"))
    assert filed.rough_contact.name == "contact_table"
    own = case.rough_contact.table(resolve_context(case))
    made = ContactTable.load(folder / "contact.npz")
    for name in ("real_contact_fraction", "cof_hysteresis", "mean_gap"):
        assert made.values[name] == pytest.approx(own.values[name], rel=1e-6)
    assert law(filed).pair.hysteresis == pytest.approx(law(case).pair.hysteresis, rel=1e-6)
    friction = case.replace(
        {"friction.contact_table": str(folder / "contact.npz"), "rough_contact.model": "persson"}
    )
    assert law(friction).pair.hysteresis == pytest.approx(law(case).pair.hysteresis, rel=1e-6)
    again = called(
        *("contact", "floor.csv", "--modulus", "5 MPa", "--speed", "1 m/s", "--table"),
        "contact.npz",
        folder=folder,
    )
    assert "contact.npz exists" in again.stderr


@pytest.mark.parametrize("theory", ["persson", "greenwood_williamson"])
def test_theories_are_options_of_the_slot(folder, theory):
    case = Case.load(folder / "case.toml").replace("rough_contact.model", theory)
    contact = case.rough_contact.build(resolve_context(case))
    gap = contact.mean_gap([1e4, 1e5])
    assert gap[0] > gap[1] > 0
    assert 0 < contact.flow_factor(gap)[1] < contact.flow_factor(gap)[0] <= 1
    rough = case.replace("floor.roughness.rq", "10 um")
    assert rough.rough_contact.build(resolve_context(rough)).mean_gap(1e5) > gap[1]
    light = contact.breaches(pressure=2e6, speed=0.3)
    assert bool(light) == (theory == "greenwood_williamson")


def test_no_table_of_what_is_no_scan_or_does_not_slide(folder):
    done = called("contact", "--rms", "5 um", "--modulus", "5 MPa", "--table", "t.npz",
                  folder=folder)  # fmt: skip
    assert "a table is one of measured surfaces" in " ".join(done.stderr.split())
    done = called("contact", "floor.csv", "--modulus", "5 MPa", "--table", "t.npz", folder=folder)
    assert "a contact table at rest has no friction" in " ".join(done.stderr.split())
    assert not (folder / "t.npz").exists()


def test_a_table_that_is_none_or_another_is_refused(folder):
    (folder / "none.npz").write_bytes(b"no archive")
    case = Case.load(folder / "case.toml").replace("rough_contact.file", str(folder / "none.npz"))
    with pytest.raises(DataError, match="is not a contact table"):
        case.rough_contact.build(resolve_context(case))
    (folder / "none.npz").write_bytes(b"other")
    with pytest.raises(InputError, match="has changed since the case was made"):
        case.rough_contact.build(resolve_context(case))


def test_the_app_takes_compound_and_rubber_test(folder, monkeypatch):
    app = pytest.importorskip("underfoot.app.project")
    from underfoot.app.pages.measured_file import FILES
    from underfoot.app.work import compound

    project = app.Project(folder / "project")
    parts = ("floor = 'matt_tile'", "shoe = 'work_shoe_full_tread'", "motion = 'whole_shoe_g6'")
    head = (folder / "case.toml").read_text().partition("[shoe]")[0]
    project.add("Heel", head + "\n".join([*parts, ""]))
    for name in ("dma.csv", "sole.csv", "floor.csv"):
        shutil.copy(folder / name, project.inside("measured"))
    made = compound(str(project.inside("measured", "dma.csv")), progress=lambda *_: None)
    paths = [path for part in FILES.values() for path in part]
    files = {"shoe.material.file": made, "shoe.roughness.file": "sole.csv",
             "floor.roughness.file": "floor.csv"}  # fmt: skip
    assert set(files) <= set(paths)
    case = project.change("Heel", {path: f"../measured/{name}" for path, name in files.items()})
    assert case.rough_contact.name == "contact_table"
    assert case.value("shoe.material.modulus") == pytest.approx(5.07e6, rel=0.02)


def test_one_walker_has_a_probability_of_his_own(tmp_path):
    from underfoot.questions.slips import measured_rcof

    path = tmp_path / "measurements.csv"
    heads = "file,person,item,quantity,value,caution"
    path.write_text("\n".join([heads, "a,,step 1,rcof,0.20,", "a,,step 2,rcof,0.24,", ""]))
    read = measured_rcof(path)
    assert (read.mean, read.sd) == pytest.approx((0.22, 0.02828), rel=1e-3)
    assert "that walker's, nobody else's" in read.text
    path.write_text("\n".join([heads, "a,,step 1,rcof,0.20,", ""]))
    with pytest.raises(InputError, match="RCOF of one step"):
        measured_rcof(path)
    path.write_text("\n".join([heads, "a,A,step 1,rcof,0.1,", "b,B,step 1,rcof,0.1,", ""]))
    with pytest.raises(InputError, match="RCOF of 2 persons, all alike: there is no spread"):
        measured_rcof(path)


def test_json_of_a_compound_is_complete(folder):
    read = json.loads(called("material", "dma.csv", "--json", folder=folder).stdout)
    assert read["kind"] == "compound"
    assert len(read["term_moduli_Pa"]) == len(read["relaxation_times_s"]) > 20
