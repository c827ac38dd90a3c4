"""From a scan to a case: numbers, lines of a case, friction by height and spectrum, bad scans."""

import json
import math
import shutil
from pathlib import Path

import numpy as np
import pytest

from commands import called
from underfoot.case import Case
from underfoot.compute.resolve import resolve_context
from underfoot.core import DataError, InputError
from underfoot.surface import (
    Profile,
    isotropic_spectrum,
    profile_roughness,
    read_scan,
    rms_slope,
    self_affine,
)

CASE = """file_version = 2
shoe = "work_shoe_half_tread"
contaminant = "sodium_lauryl_sulphate"
motion = "slip_tester_g4"

[floor.roughness]
file = "boden.csv"
"""
RUBBER = {
    "shoe.material.relaxation": {
        "equilibrium_shear_modulus": "1 MPa",
        "terms": [{"shear_modulus": "1 MPa", "time": f"1e-{n} s"} for n in range(1, 7)],
    }
}


def mean_square(spectrum):
    return float(np.sum(spectrum.density * spectrum.area))


def surface(hurst=0.8, rms=3e-6, seed=1, roll_off=3e-4, points=(2048, 512)):
    return self_affine(points, 4e-6, rms, hurst, 2e-3, 2e-5, seed, roll_off)


def german(path, heights, spacing=4e-6, unit="µm", scale=1e6):
    """Write a profile as a German spreadsheet does."""
    rows = [f"{1e3 * spacing * n:.4f};{scale * z:.5f}" for n, z in enumerate(heights)]
    text = "\n".join([f"x [mm];z [{unit}]", *rows]).replace(".", ",")
    path.write_bytes(text.encode("cp1252"))
    return path


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "case.toml").write_text(CASE)
    german(tmp_path / "boden.csv", surface().heights[:, 7])
    return tmp_path


def law(case):
    return case.friction.build(resolve_context(case))


def test_a_scan_is_read_and_its_lines_make_a_case(folder):
    done = called("surface", "boden.csv", "--out", "scan", folder=folder)
    assert done.returncode == 0, done.stderr
    assert 'file = "boden.csv"' in done.stdout
    assert "waves below 20 um not seen" in done.stdout
    assert {"scan.png", "spectrum.csv", "report.html"} <= {
        p.name for p in (folder / "scan").iterdir()
    }
    told = json.loads(called("surface", "boden.csv", "--json", folder=folder).stdout)
    profile = Profile(surface().heights[:, 7], 4e-6)
    exact = profile_roughness(profile, 0.8e-3, 20e-6)
    for name in ("ra", "rq", "rz", "rdq"):
        assert told[name] == pytest.approx(getattr(exact, name), rel=1e-3)
    checked = called("check", folder / "case.toml", "--all", folder=folder.parent)
    assert checked.returncode == 0, checked.stderr
    assert "file: boden.csv" in checked.stdout
    case = Case.load(folder / "case.toml")
    assert case.value("floor.roughness.rq") == pytest.approx(told["rq"], rel=1e-9)
    assert case.value("floor.roughness.cutoff") == 0.8e-3


@pytest.mark.slow
@pytest.mark.parametrize("hurst", [0.6, 0.8])
def test_spectrum_of_one_profile_is_that_of_its_surface(tmp_path, hurst):
    """Slope and height within 15 % of the map's; the map's Hurst exponent within 0.1."""
    made = [surface(hurst, seed=seed) for seed in range(4)]
    q = np.geomspace(2 * math.pi / 1e-3, 2 * math.pi / 2.1e-5, 200)
    slopes, heights = [], []
    for number, each in enumerate(made):
        scan = read_scan(german(tmp_path / f"{number}.csv", each.heights[:, 9]))
        slopes.append(math.sqrt(2 * math.pi * np.trapezoid(q**3 * scan.density(q), q)))
        heights.append(math.sqrt(2 * math.pi * np.trapezoid(q * scan.density(q), q)))
    spectrum = isotropic_spectrum(made[0]).within(q[0], q[-1])
    assert np.mean(heights) == pytest.approx(math.sqrt(mean_square(spectrum)), rel=0.15)
    assert np.mean(slopes) == pytest.approx(rms_slope(made[0]), rel=0.15)
    rows = 1e6 * made[0].heights
    np.savetxt(tmp_path / "map.csv", rows, fmt="%.5f", delimiter=";", header="z [um]", comments="")
    area = read_scan(tmp_path / "map.csv", spacing=4e-6)
    assert area.hurst.value == pytest.approx(hurst, abs=0.1)
    assert area.roll_off == pytest.approx(3e-4, rel=0.6)


def test_a_floor_moves_friction_by_height_and_by_spectrum(folder):
    """One Rq, waves of another Hurst exponent: the fine one loses more energy and touches less."""
    case = Case.load(folder / "case.toml")
    before = law(case).medians
    rougher = german(folder / "rau.csv", 2 * surface().heights[:, 7])
    rough = law(case.replace("floor.roughness.file", rougher.name)).medians
    assert rough["kappa"] > before["kappa"]
    fine = german(folder / "fein.csv", surface(0.5).heights[:, 7])
    other = case.replace(
        {"floor.roughness.file": fine.name, "floor.roughness.rq": case.value("floor.roughness.rq")}
    )
    assert law(other).medians["kappa"] == pytest.approx(before["kappa"], rel=0.05)
    assert law(other).medians["hysteresis"] > 1.2 * before["hysteresis"]
    rubber = (law(each.replace(RUBBER)).medians["hysteresis"] for each in (case, other))
    assert 1.1 * next(rubber) < next(rubber)
    dry = [law(each.replace("contaminant", "none")).medians for each in (case, other)]
    assert dry[1]["full_contact"] > 1.1 * dry[0]["full_contact"]


def test_two_scans_stand_for_waves_beyond_the_cutoff(folder):
    both = Case.load(folder / "case.toml", settings={"shoe.roughness.file": "boden.csv"})
    assert not both.effective_rq.assumed
    assert "interface.roughness_beyond_cutoff" in both.idle_paths
    one = both.floor.roughness.moment(0, 2.5e-6, both.interface.longest_wave)
    assert both.effective_rq.value == pytest.approx(math.sqrt(2) * one)
    assert one == pytest.approx(float(np.std(surface().heights)), rel=0.25)


def test_content_of_the_scan_is_the_hash(folder, tmp_path):
    case = Case.load(folder / "case.toml")
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    for name in ("case.toml", "boden.csv"):
        shutil.copy(folder / name, elsewhere)
    assert Case.load(elsewhere / "case.toml").hash == case.hash
    again = Case.from_text(case.to_toml(complete=True))
    assert again.hash == case.hash
    german(elsewhere / "boden.csv", 1.001 * surface().heights[:, 7])
    assert Case.load(elsewhere / "case.toml").hash != case.hash
    german(folder / "boden.csv", surface(seed=5).heights[:, 7])
    with pytest.raises(InputError, match="has changed since"):
        law(case)


def test_a_given_height_goes_before_the_scan(folder):
    case = Case.load(folder / "case.toml", settings={"floor.roughness.rq": "6 um"})
    assert case.value("floor.roughness.rq") == 6e-6
    assert case.origins["floor.roughness.rq"].kind == "given"
    plain = Case.load(folder / "case.toml")
    ratio = 6e-6 / plain.value("floor.roughness.rq")
    slope = [each.floor.roughness.moment(1, 2e-5, 8e-4) for each in (case, plain)]
    assert slope[0] / slope[1] == pytest.approx(ratio)


def refused(folder, *words):
    done = called("check", "case.toml", folder=folder)
    assert done.returncode != 0
    for word in words:
        assert word in done.stderr, done.stderr


def test_millimetres_called_micrometres_and_a_wafer_are_no_floor(folder):
    german(folder / "boden.csv", 1e-3 * surface().heights[:, 7], scale=1e6)
    refused(folder, "floor.roughness.file", "is no floor and no sole", "height_unit")
    told = called("surface", "boden.csv", folder=folder)
    assert told.returncode == 0
    assert "is the unit of the heights right?" in told.stdout
    german(folder / "boden.csv", surface().heights[:, 7], scale=1e6, unit="mm")
    refused(folder, "is no roughness")


def test_a_scan_shorter_than_the_cutoff(folder):
    german(folder / "boden.csv", surface().heights[:150, 7])
    told = called("surface", "boden.csv", folder=folder).stdout
    assert "shorter than the usual cut-off" in told
    assert "Measure 4.8 mm or more" in " ".join(told.split())
    asked = called("surface", "boden.csv", "--cutoff", "0.8 mm", folder=folder)
    assert asked.returncode != 0
    assert "for a cut-off of 800 um" in asked.stderr
    german(folder / "boden.csv", surface().heights[:30, 7], spacing=20e-6)
    refused(folder, "holds no cut-off", "Measure a longer part")


@pytest.mark.slow
def test_dead_pixels_are_filled_and_told(tmp_path):
    whole = surface()
    heights = 1e6 * whole.heights[:512]
    dead = heights.copy()
    dead[40:42, 90] = 900.0, 871.3  # twice the same number would be a code for "missing"
    lines = [";".join(f"{z:.4f}" for z in row) for row in dead]
    lines[7] = lines[7].replace(";", ";NaN;", 1).rpartition(";")[0]
    path = tmp_path / "map.csv"
    path.write_text("\n".join(["z [um]", *lines]))
    scan = read_scan(path, spacing=4e-6)
    words = " ".join(scan.surface.processing)
    assert "2 of 262144 points stand out of their neighbours (dead pixels)" in words
    assert "1 of 262144 missing heights interpolated" in words
    np.savetxt(tmp_path / "whole.csv", heights, fmt="%.4f", header="z [um]", comments="")
    sound = read_scan(tmp_path / "whole.csv", spacing=4e-6)
    assert scan.values["rq"].value == pytest.approx(sound.values["rq"].value, rel=1e-3)
    lines = [";".join(["NaN"] * 60 + line.split(";")[60:]) for line in lines]
    path.write_text("\n".join(["z [um]", *lines]))
    with pytest.raises(DataError, match="heights are missing"):
        read_scan(path, spacing=4e-6)


def test_the_app_takes_a_dropped_scan(folder):
    project = pytest.importorskip("underfoot.app.project").Project(folder / "project")
    project.add(
        "Fliese", CASE.replace('[floor.roughness]\nfile = "boden.csv"\n', 'floor = "vinyl_g4"\n')
    )
    shutil.copy(folder / "boden.csv", project.inside("measured"))
    case = project.change("Fliese", {"floor.roughness.file": "../measured/boden.csv"})
    assert Path(case.floor.roughness.file).name == "boden.csv"
    assert case.origins["floor.roughness.rq"].kind == "file"
    assert project.change("Fliese", {"floor.roughness.file": None}).floor.roughness.file is None
