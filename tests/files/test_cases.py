"""Files of known right value that programs read wrongly: recordings, surfaces, soles, rubber."""

import zipfile
from pathlib import Path

import numpy as np
import pytest

from underfoot.calibrate.compound import compound_from_files
from underfoot.core import DataError
from underfoot.shoe.files import outsole_from_file
from underfoot.shoe.tread_measures import tread_measures
from underfoot.surface import read_scan, read_surface
from underfoot.trials import read_trial
from underfoot.trials.machines.pin_on_disk import friction_point
from underfoot.trials.recording.protocols import protocol
from underfoot.trials.study.folder import analyse_folder
from underfoot.trials.walking.describe import described_file

ARCHIVE = Path(__file__).parents[1] / "data" / "cases" / "cases.zip"
TWO_STEPS = (0.172, 0.192)
"""RCOF of one recording in many forms; by own code from the bytes of the recording."""
WALKS = {
    "c3d_fixed_markers/fix8.c3d": None,
    "c3d_fixed_markers/fix8feet.c3d": None,
    "c3d_pounds/v_lb.c3d": None,
    "c3d_pounds/uw_daN.c3d": None,
    "mot_repeated_columns/m_dup.mot": None,
    "mot_z_up/m_zup.mot": None,
    "trc_sentinel/t_999.trc": "trc_sentinel/t0.mot",
    "trc_sentinel/t_9999.trc": "trc_sentinel/t0.mot",
}
# plan cm2, land, depth mm, lugs
SOLES = {
    "outsole_more/h_whole_hex.obj": (208.8, 0.531, 3.5, 213),
    "soles/b02_bars_bevel10_shell4.stl": (None, 0.60, 3.5, None),
    "soles/w23_two_depths.stl": (209, 0.48, (2.0, 4.0), None),
}
FORWARD = ("f1_angle5", "h06_oblique", "h2_heelcut8")
TURNED = ("h01_round", "s12_draft7_fine", "h10_chevron_bevel")


@pytest.fixture(scope="module")
def cases(tmp_path_factory):
    folder = tmp_path_factory.mktemp("cases")
    with zipfile.ZipFile(ARCHIVE) as archive:
        archive.extractall(folder)
    return folder


@pytest.mark.parametrize("name", WALKS)
def test_both_steps_of_a_walk(cases, name):
    beside = WALKS[name]
    found = described_file(cases / name, companion=beside and cases / beside)[0]
    values = sorted(step.measurement.value or np.nan for step in found.steps)
    assert values == pytest.approx(TWO_STEPS, abs=0.002)


def test_moments_and_centre_of_pressure_are_no_markers(cases):
    trial = read_trial(cases / "force_columns_moments" / "bertec.csv")
    assert not trial.markers
    assert trial.plates[0].centre_of_pressure is not None
    (step,) = described_file(cases / "force_columns_moments" / "bertec.csv")[0].steps
    assert step.measurement.value


def test_thousands_are_no_text(cases):
    found = described_file(cases / "text_thousands" / "th2_apos.csv")[0]
    (step,) = found.steps
    assert found.trial.plates[0].force[:, 2].max() == pytest.approx(1075, abs=1)
    assert step.measurement.value == pytest.approx(0.171, abs=0.002)


@pytest.mark.parametrize("rows", [100, 1000])
def test_markers_held_between_frames_are_a_slower_clock(cases, rows):
    file = f"dflow_markers_100_rows_{rows}.txt"
    marker = read_trial(cases / "dflow_held_between_frames" / file).marker("RHEE")
    assert marker.rate == pytest.approx(100, rel=1e-3)
    assert not marker.missing.any()


@pytest.mark.parametrize("unit", ["Centimeters", "Meters", "Millimeters"])
def test_lengths_of_motive_in_words(cases, unit):
    trial = read_trial(cases / "optitrack_units" / f"optitrack_{unit}.csv")
    assert trial.marker("RHEE").positions[0] == pytest.approx([1.44, 0.045, 0.92], abs=0.5)


def test_a_held_marker_is_named(cases):
    folder = cases / "slip_held_marker" / "trial"
    (file,) = analyse_folder(folder, protocol("report_g6"), processes=1).files
    told = " ".join((file.verdict, *file.reasons))
    assert "slip" not in file.verdict
    assert "43" in told or "held" in told or "repeat" in told, told


@pytest.mark.parametrize("name", ["sine.gsf", "sine_um.gsf", "sine_matrix.txt"])
def test_a_lay_is_named_and_numbers_are_across_it(cases, name):
    path = next(cases.rglob(name))
    given = {"spacing": 1e-5, "height_unit": "um"} if name.endswith("txt") else {}
    scan = read_scan(path, **given)
    assert scan.values["ra"].value == pytest.approx(3.07e-6, rel=0.02)
    assert scan.values["rq"].value == pytest.approx(3.42e-6, rel=0.02)
    assert np.ptp(scan.surface.heights) == pytest.approx(10e-6, rel=0.01)
    assert scan.texture is not None
    assert "lay at 90" in str(scan.texture)  # degrees from x: its ridges run along y


def test_oblong_cells_are_read(cases):
    surface = read_surface(cases / "map_oblong_cells" / "x_dy.x3p")
    assert surface.spacings == pytest.approx((16e-6, 32e-6))
    scan = read_scan(cases / "map_oblong_cells" / "x_dy.x3p")
    assert scan.values["rq"].value == pytest.approx(4.3e-6, rel=0.05)


def test_maps_of_newer_standards_are_read(cases):
    text, binary = (read_surface(cases / "sdf-iso2" / name) for name in ("iso2a.sdf", "iso2.sdf"))
    np.testing.assert_allclose(text.heights, binary.heights, atol=1e-12)
    assert text.spacing == pytest.approx(binary.spacing)
    assert np.isfinite(read_surface(cases / "x3p-amd1" / "amd1.x3p").heights).all()


def test_a_profile_with_quoted_decimal_commas(cases):
    profile = read_surface(cases / "csv_quoted_decimal_comma" / "p_one.csv", spacing=2e-6)
    assert profile.heights[:3] == pytest.approx([1.2811e-6, 2.1374e-6, 2.2187e-6])


def test_a_pin_without_offset(cases):
    trial = read_trial(cases / "pin_on_disk_offset" / "o0" / "a.csv")
    assert friction_point(trial).cof.value == pytest.approx(0.350, abs=0.0015)


def test_sweeps_three_kelvin_apart_are_a_master_curve(cases):
    compound = compound_from_files([cases / "sweep_2K_steps" / "mt_3K.csv"], temperature=298.15)
    # E at 1 Hz
    assert compound.spectrum is not None
    assert abs(compound.spectrum.complex_modulus(2 * np.pi)) == pytest.approx(5.1e6, rel=0.03)


@pytest.mark.slow
@pytest.mark.parametrize("name", SOLES)
def test_plan_land_and_depth_of_a_sole(cases, name):
    plan, land, depth, lugs = SOLES[name]
    measures = tread_measures(outsole_from_file(cases / name).surface)
    if plan:
        assert measures.plan_area * 1e4 == pytest.approx(plan, rel=0.005)
    assert measures.land_ratio == pytest.approx(land, rel=0.015)
    low, usual, high = (1e3 * one for one in measures.channel_depth)
    found = (low, high) if isinstance(depth, tuple) else usual
    assert found == pytest.approx(depth, abs=0.05)
    if lugs:
        assert measures.lug_count == pytest.approx(lugs, abs=8)


@pytest.mark.slow
@pytest.mark.parametrize("name", FORWARD)
def test_a_piece_cut_askew_is_not_turned(cases, name):
    found = outsole_from_file(cases / "soles" / f"{name}.stl")
    assert "+x" in found.forward


@pytest.mark.slow
@pytest.mark.parametrize("name", TURNED)
def test_lugs_face_the_floor(cases, name):
    found = outsole_from_file(cases / "soles" / f"{name}.stl")
    assert 0.2 < tread_measures(found.surface).land_ratio < 0.8


@pytest.mark.slow
def test_which_shoe_of_a_pair_is_asked(cases):
    with pytest.raises(DataError, match=r"holds a pair.*--side left or --side right"):
        outsole_from_file(cases / "soles" / "p01_pair.3mf")
