"""A case whose outsole is a file: read, checked, run, kept apart by its checksum; and the CLI."""

import json
import shutil
from pathlib import Path

import numpy as np
import pytest

from commands import called
from outsole_bodies import flat, grooved, heel_body, triangles, write_stl
from underfoot.case import Case
from underfoot.case.describe import assumptions
from underfoot.compute.sole import (
    compression_breaches,
    file_outsole,
    file_sole_map,
    outsole_notes,
)
from underfoot.core import InputError

CASE = """
name = "my sole"
contaminant = "glycerol_90pct"
[shoe]
from = "work_shoe_half_tread"
[shoe.outsole]
file = "my_sole.stl"
map_spacing = "0.5 mm"
[shoe.sole]
outsole_thickness = "15 mm"
[floor]
from = "vinyl_g4"
[motion]
from = "slip_tester_g4"
shoe_angle = "0 deg"
[numerics]
grid_spacing = "1.5 mm"
quick_grid_spacing = "2 mm"
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    place = tmp_path_factory.mktemp("outsole")
    write_stl(place / "my_sole.stl", triangles(heel_body(grooved(width=4e-3), step=1e-3)))
    (place / "case.toml").write_text(CASE)
    return place


def case_with(folder, text=CASE, **settings):
    path = folder / "other.toml"
    path.write_text(text)
    return Case.load(path, settings=settings)


def test_case_takes_its_sole_from_the_file(folder):
    case = Case.load(folder / "case.toml")
    sole = file_sole_map(case, 1.5e-3)
    assert sole.land_ratio == pytest.approx(0.30, abs=0.04)  # walls of 1 mm
    assert np.median(sole.tread_depth[sole.land]) == pytest.approx(3e-3, abs=1e-4)
    told = " ".join([*assumptions(case), *outsole_notes(case)])
    assert "Assumed: unit mm" in told
    assert "determined from the tread" in told
    assert "shoe.heel" not in str(case)
    assert "channel_width" not in str(case)


def test_hash_follows_the_content_of_the_file_not_its_place(folder, tmp_path):
    case = Case.load(folder / "case.toml")
    (tmp_path / "my_sole.stl").write_bytes((folder / "my_sole.stl").read_bytes())
    (tmp_path / "case.toml").write_text(CASE)
    assert Case.load(tmp_path / "case.toml").hash == case.hash
    # soles of one name share the draws of their film's error
    (tmp_path / "other.stl").write_bytes((folder / "my_sole.stl").read_bytes())
    (tmp_path / "other.toml").write_text(CASE.replace("my_sole.stl", "other.stl"))
    assert Case.load(tmp_path / "other.toml").hash != case.hash
    write_stl(tmp_path / "my_sole.stl", triangles(heel_body(grooved(2e-3), step=1e-3)))
    assert Case.load(tmp_path / "case.toml").hash != case.hash
    assert case.replace("shoe.outsole.mirror", True).hash != case.hash


def test_complete_text_is_the_same_case_from_anywhere(folder, tmp_path):
    case = Case.load(folder / "case.toml")
    (tmp_path / "complete.toml").write_text(case.to_toml(complete=True))
    assert Case.load(tmp_path / "complete.toml") == case


def test_another_file_under_the_same_name_is_refused(folder):
    text = CASE.replace("map_spacing", f'sha256 = "{"0" * 64}"\nmap_spacing')
    with pytest.raises(InputError, match="is not the file that the case means"):
        case_with(folder, text)


def test_missing_file_names_the_nearest(folder):
    with pytest.raises(InputError, match=r'there is no file.*Did you mean "my_sole.stl"'):
        case_with(folder, CASE.replace("my_sole.stl", "my_soles.stl"))


def test_heel_or_tread_beside_a_file_is_refused(folder):
    with pytest.raises(InputError, match=r"is not used: the outsole comes from my_sole\.stl"):
        case_with(folder, CASE + '[shoe.heel]\nlength = "50 mm"\n')


def test_shoe_needs_no_tread_when_it_has_a_file(folder):
    text = CASE.replace(
        'from = "work_shoe_half_tread"\n', 'material.shore_a = 60\nroughness.rq = "5 um"\n'
    )
    assert file_outsole(case_with(folder, text)).foot == ""


def test_what_does_not_fit_together_is_refused(folder):
    with pytest.raises(InputError, match="lie on one axis"):
        case_with(folder, CASE.replace("map_spacing", 'down = "-z"\nforward = "+z"\nmap_spacing'))
    with pytest.raises(InputError, match="coarser than the solver's grid"):
        case_with(folder, CASE.replace('"0.5 mm"', '"1.8 mm"'))
    with pytest.raises(InputError, match="needs a parametric sole"):
        case_with(folder, CASE + '[shoe.wear]\ndepth = "1 mm"\nmode = "archard"\nangle = "5 deg"\n')


def test_channels_below_the_grid_are_refused(folder):
    write_stl(folder / "fine.stl", triangles(heel_body(grooved(2e-3, 5e-3, 1.5e-3), step=0.5e-3)))
    text = CASE.replace("my_sole.stl", "fine.stl")
    with pytest.raises(InputError, match=r"channel area.*Use a grid spacing of 0\.\d+ mm or less"):
        file_sole_map(case_with(folder, text), 1.5e-3)


def test_load_that_bottoms_out_and_nothing_under_the_load(folder):
    case = case_with(folder, CASE, **{"motion.normal_force": "9000 N"})
    with pytest.raises(InputError, match="bottoms out the sole"):
        file_sole_map(case, 2e-3)

    def pinned(x, y):  # all of the sole hangs 10 mm above the floor, but for one stud
        return np.where(np.hypot(x - 30e-3, y) < 3e-3, 0.0, 10e-3)

    write_stl(folder / "pin.stl", triangles(heel_body(pinned, step=1e-3, thickness=0.02)))
    text = CASE.replace("my_sole.stl", "pin.stl")
    with pytest.raises(InputError, match=r"on \d+(\.\d+)? mm² of land.*outsole inspect"):
        file_sole_map(case_with(folder, text), 1.5e-3)


def test_strong_compression_is_listed(folder):
    case = Case.load(folder / "case.toml")
    assert compression_breaches(case, 1e-3) == []
    assert "compression of the sole" in str(compression_breaches(case, 6e-3)[0])


def test_wear_takes_the_tread_of_a_file_off(folder):
    text = CASE + '[shoe.wear]\ndepth = "3.2 mm"\n'
    worn = file_sole_map(case_with(folder, text), 1.5e-3)
    assert worn.land_ratio > 0.99


def test_far_parts_of_a_tilted_sole_are_trimmed(folder):
    tilted = case_with(
        folder, CASE, **{"motion.shoe_angle": "25 deg", "motion.normal_force": "50 N"}
    )
    sole = file_sole_map(tilted, 1.5e-3)
    assert sole.x.size * sole.spacing < 0.045
    assert sole.clearance[np.isfinite(sole.clearance)].min() == 0


@pytest.mark.slow
def test_run_of_a_file_beats_the_same_sole_without_tread(folder):
    from underfoot.compute.run import run

    case = Case.load(folder / "case.toml")
    treaded = run(case)
    write_stl(folder / "plain.stl", triangles(heel_body(flat, step=1e-3)))
    plain = run(case_with(folder, CASE.replace("my_sole.stl", "plain.stl")))
    assert treaded.status.usable
    assert plain.status.usable
    assert treaded.scalars["fluid_load"].value < 0.7 * plain.scalars["fluid_load"].value
    assert any("determined from the tread" in line for line in treaded.assumptions)


@pytest.mark.slow
def test_what_comes_next_never_meets_a_sole_of_the_same_name(folder):
    sole, told = folder / "my_sole.stl", []
    for name in ("my_sole", "first", "supplier/second"):
        (folder / "files" / name).mkdir(parents=True)
        copy = Path(shutil.copy(sole, folder / "files" / name)).relative_to(folder)
        done = called("outsole", "inspect", copy, "--out", name, folder=folder)
        assert done.returncode == 0, done.stderr
        told.append(done.stdout.splitlines()[-1])
    assert told == [
        "Next: underfoot run my_sole/my_sole.toml",
        "Next: underfoot run first/my_sole.toml --out out/first",
        "Next: underfoot run supplier/second/my_sole.toml --out out/supplier/second",
    ]


def test_inspect_prints_and_writes_a_case_that_checks(folder):
    out = folder / "out"
    done = called("outsole", "inspect", "my_sole.stl", "--out", out, folder=folder)
    assert done.returncode == 0, done.stderr
    assert "Largest untreaded patch" in done.stdout
    # the run of a sole of the same name from another folder does not meet it
    told = f"Next: underfoot run {out / 'my_sole.toml'} --out {out / 'run'}"
    assert done.stdout.splitlines()[-1] == told
    assert "Determined, assumed and repaired" in done.stdout
    names = {path.name for path in out.iterdir()}
    assert {"outsole.png", "measures.csv", "heights.csv.gz", "my_sole.toml"} <= names
    assert (out / "outsole.png").stat().st_size > 20_000
    heights = np.loadtxt(out / "heights.csv.gz", delimiter=",")
    assert np.nanmax(heights) == pytest.approx(3.0, abs=0.01)
    case = Case.load(out / "my_sole.toml")
    assert Path(case.shoe.outsole.file or "").name == "my_sole.stl"
    assert case.shoe.sole.outsole_thickness == pytest.approx(15e-3, abs=1e-4)


def test_inspect_as_json_and_its_errors(folder):
    done = called("outsole", "inspect", "my_sole.stl", "--json", folder=folder)
    found = json.loads(done.stdout)
    assert found["measures"]["land_ratio"] == pytest.approx(0.30, abs=0.04)  # walls of 1 mm
    assert found["mesh"]["open_edges"] == 0
    wrong = called("outsole", "inspect", "my_sole.stl", "--unit", "m", folder=folder)
    assert wrong.returncode == 2
    assert "It would be 60 mm in mm" in wrong.stderr
    (folder / "letter.stl").write_text("Dear Sir,\n")
    letter = called("outsole", "inspect", "letter.stl", folder=folder)
    assert letter.returncode == 3
    assert 'holds no STL: it begins with "Dear Sir,"' in letter.stderr
