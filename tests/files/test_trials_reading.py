"""Real recordings are read, and agree with the public readers; others are refused with a reason."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest
from trials_c3d_writing import c3d_bytes

from underfoot.core import DataError, InputError
from underfoot.trials import profile_from, read_profile, read_sheet, read_trial, read_trials
from underfoot.trials.readers import c3d
from underfoot.trials.recording.trial import Plate, Trial

DATA = Path(__file__).parents[1] / "data" / "trials"
# ezc3d takes crossed corners (biomdp) as they are.
C3D = sorted(p for p in DATA.rglob("*.c3d") if p.parent.name != "biomdp")
VISCOELASTIC = Path(__file__).parents[1] / "data" / "viscoelastic" / "pyvisco"


# Numbers of the data sets' own description (tests/data/trials/README.md and the files' headers).
@pytest.mark.parametrize(
    ("name", "plates", "rate", "markers", "marker_rate", "source"),
    [
        ("biomechzoo/HC030A05.c3d", 2, 1000, 180, 100, "C3D"),
        ("biomechzoo/HC036A23.c3d", 2, 1000, 180, 100, "C3D"),
        ("bmc/Gait.c3d", 2, 1000, 33, 100, "C3D"),
        ("bmc/walk1.forces", 7, 450, 0, 0, "Cortex forces"),
        ("bmc/walk1.trc", 0, 0, 28, 150, "TRC"),
        ("opensim/walking5.c3d", 2, 2000, 40, 250, "C3D"),
        ("opensim/leg69_stance_grf.mot", 2, 600, 0, 0, "OpenSim motion"),
        ("kineticstoolkit/c3d_sample.c3d", 6, 1000, 22, 100, "C3D"),
        ("btk/ADemo1_rewrite_c3d_pc_integer.c3d", 1, 400, 24, 200, "C3D"),
    ],
)
def test_motion_capture_is_read(name, plates, rate, markers, marker_rate, source):
    trial = read_trial(DATA / name)
    assert (len(trial.plates), len(trial.markers), trial.source) == (plates, markers, source)
    assert all(plate.usable for plate in trial.plates)
    assert all(plate.rate == pytest.approx(rate, rel=1e-3) for plate in trial.plates)
    assert all(m.rate == pytest.approx(marker_rate, rel=1e-3) for m in trial.markers.values())
    assert len(trial.checksum) == 64


@pytest.mark.slow
def test_tribometer_logs_are_read():
    steps = read_trials(DATA / "cetr" / "HT-2n-6-4_2_001.csv")
    means = [float(np.mean(step.channel("COF").values)) for step in steps]
    # seen: mean COF 0.64-0.70 in step 1, 0.79-0.83 in step 2 (description of the data)
    assert 0.63 < means[0] < 0.71
    assert 0.78 < means[1] < 0.84
    force = steps[0].channel("Fz")
    assert force.unit == "N"
    assert np.median(force.values) == pytest.approx(-0.2 * 9.80665, rel=0.02)  # set force -200 g
    disc = read_trial(DATA / "pcs" / "demo_7.txt")
    assert disc.channel("Traction Coeff").values.mean() == pytest.approx(0.102, abs=5e-4)
    assert len(disc.channel("Traction Coeff").values) == 7500
    ball = read_trial(DATA / "pcs" / "demo_5.txt")
    assert ball.channel("traction coeff").values.mean() == pytest.approx(0.113, abs=5e-4)
    assert ball.channel("Ball Load").unit == "N"
    assert ball.channel("Pot RTD Temp").values[0] == pytest.approx(94.4 + 273.15)
    film = read_trial(DATA / "pcs" / "demo_3.txt", step=1)
    speed, height = film.channel("Rolling Speed").values, film.channel("Average Film").values
    assert speed[0] == pytest.approx(0.02021)  # the unrounded column of the two
    assert height[0] == pytest.approx(24.4e-9)
    slope = np.polyfit(np.log(speed), np.log(height), 1)[0]
    assert slope == pytest.approx(0.67, abs=0.02)  # film grows with speed^0.67


def test_relaxation_table_is_read_with_its_uneven_times():
    trial = read_trial(VISCOELASTIC / "time_user_master.csv")
    channel = trial.channel("E_relax") if "E_relax" in trial.channels else trial.channel("E")
    assert len(channel.values) == 481
    assert channel.unit == "Pa"
    assert channel.times is not None


@pytest.mark.parametrize(
    ("path", "reason"),
    [
        (VISCOELASTIC / "freq_user_raw.csv", "no time column"),
        (VISCOELASTIC / "time_user_raw.csv", "time does not increase"),
        (DATA.parent / "roughness" / "dektak-1.csv", "25 lines stand above the table"),
        (DATA / "README.md", "no table of numbers"),
    ],
)
def test_what_is_no_trial_is_refused_with_the_reason(path, reason):
    with pytest.raises(DataError, match=reason):
        read_trials(path)


def test_sheets_keep_text_columns(tmp_path):
    sheet = read_sheet(VISCOELASTIC / "freq_user_raw.csv")
    assert sheet.units["f"] == "Hz"
    path = tmp_path / "wear.csv"
    path.write_text("shoe code,wear cycle,COF (-),brand\nS1,0,0.31,A\nS1,1,0.22,A\nS2,0,,B\n")
    wear = read_sheet(path)
    assert wear.texts["shoe code"] == ("S1", "S1", "S2")
    np.testing.assert_array_equal(wear.numbers["COF"], [0.31, 0.22, np.nan])


@pytest.mark.parametrize("path", C3D, ids=lambda p: p.name)
def test_c3d_agrees_with_ezc3d(path):
    ezc3d = pytest.importorskip("ezc3d")
    theirs = ezc3d.c3d(str(path), extract_forceplat_data=True)
    ours = read_trial(path, subtract_baseline=False)
    from underfoot.trials.readers.c3d import parse

    raw = parse(path.read_bytes(), path.name)
    points = np.moveaxis(theirs["data"]["points"][:3], 0, 2).swapaxes(0, 1)
    seen = np.isfinite(raw.points)
    np.testing.assert_array_equal(seen.all(axis=2), np.isfinite(points).all(axis=2))
    np.testing.assert_array_equal(points[seen], raw.points[seen])
    np.testing.assert_array_equal(theirs["data"]["analogs"][0].T, raw.analog)
    for plate, other in zip(ours.plates, theirs["data"]["platform"], strict=True):
        np.testing.assert_allclose(
            plate.force, other["force"].T, atol=1e-4
        )  # it rotates in single precision
        place = other["center_of_pressure"].T / 1e3
        loaded = np.linalg.norm(plate.force, axis=1) > 50.0
        np.testing.assert_allclose(plate.centre_of_pressure[loaded], place[loaded], atol=1e-6)


@pytest.mark.parametrize("path", C3D, ids=lambda p: p.name)
def test_a_megabyte_of_c3d_takes_less_than_half_a_second(path):
    start = time.process_time()
    read_trial(path)
    spent = time.process_time() - start
    assert spent < 0.5 * max(1.0, path.stat().st_size / 1e6)


def _recording(kind: int = 2):
    """Two seconds on one plate: 500 N down and 50 N backward for a second, at (10, 20) mm."""
    rate, frames = 1000, 200
    points = np.full((frames, 2, 3), np.nan)
    points[:, 0] = np.linspace([100.0, 200.0, 30.0], [300.0, 200.0, 30.0], frames)
    points[20:, 1] = [500.0, 100.0, 40.0]
    load = np.zeros(2 * rate)
    load[500:1500] = 1.0
    corners = np.array([[500.0, 300.0, 0.0], [500.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 300.0, 0.0]])
    # plate axes: x = lab y, y = lab x, z down
    force = np.outer(load, [0.0, -50.0, -500.0])
    place = np.array([0.01, 0.02, 0.0])  # from the surface's centre, plate axes, m
    moment = np.cross(place, force)
    return points, force, moment, corners


GROUPS = {
    "POINT": {
        "LABELS": ["LHEE", "RHEE"],
        "UNITS": ["mm"],
        "USED": np.array([2]),
        "FRAMES": np.array([200]),
        "RATE": np.array([100.0]),
        "SCALE": np.array([-0.1]),
        "DATA_START": np.array([4]),
    }
}


def _type_2(tmp_path, **storage):
    points, force, moment, corners = _recording()
    origin = np.array([0.001, -0.002, 0.04])  # m; z > 0 in the file, below the surface in truth
    to_surface = -origin
    about_origin = moment + np.cross(np.broadcast_to(to_surface, force.shape), force)
    analog = np.column_stack((force, 1e3 * about_origin))
    groups = {
        **GROUPS,
        "ANALOG": {
            "LABELS": ["Fx", "Fy", "Fz", "Mx", "My", "Mz"],
            "UNITS": ["N", "N", "N", "Nmm", "Nmm", "Nmm"],
            "SCALE": np.ones(6),
            "GEN_SCALE": np.array([1.0]),
            "OFFSET": np.zeros(6, dtype=int),
            "USED": np.array([6]),
            "RATE": np.array([1000.0]),
        },
        "FORCE_PLATFORM": {
            "USED": np.array([1]),
            "TYPE": np.array([2]),
            "ZERO": np.array([1, 100]),
            "CORNERS": corners.T[:, :, None].astype(float),
            "ORIGIN": 1e3 * origin[:, None],
            "CHANNEL": np.arange(1, 7)[:, None],
        },
    }
    path = tmp_path / "made.c3d"
    path.write_bytes(c3d_bytes(points, analog, groups=groups, **storage))
    return path


@pytest.mark.parametrize("processor", [84, 85, 86])
@pytest.mark.parametrize("real", [True, False])
def test_every_storage_form_gives_the_same(tmp_path, processor, real):
    trial = read_trial(_type_2(tmp_path, processor=processor, real=real, first_frame=11))
    plate = trial.plates[0]
    loaded = slice(600, 1400)
    # lab axes: plate y is lab x, plate z is down
    np.testing.assert_allclose(plate.force[loaded].mean(axis=0), [-50.0, 0.0, 500.0], atol=1e-3)
    place = plate.centre_of_pressure[loaded].mean(axis=0)
    np.testing.assert_allclose(place, [0.25 + 0.02, 0.15 + 0.01, 0.0], atol=2e-5 if real else 3e-3)
    heel = trial.marker("LHEE")
    assert heel.start == pytest.approx(0.1)
    np.testing.assert_allclose(heel.positions[0], [0.1, 0.2, 0.03], atol=1e-4)
    assert trial.marker("RHEE").missing[:20].all()
    assert not trial.marker("RHEE").missing[20:].any()


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("processor", [84, 85, 86])
def test_every_processor_agrees_with_py_c3d(tmp_path, processor):
    c3d = pytest.importorskip("c3d")
    from underfoot.trials.readers.c3d import parse

    path = _type_2(tmp_path, processor=processor)
    raw = parse(path.read_bytes(), path.name)
    with path.open("rb") as stream:
        frames = [(p[:, :3], a) for _, p, a in c3d.Reader(stream).read_frames()]
    points = np.array([p for p, _ in frames])
    seen = np.isfinite(raw.points)
    np.testing.assert_array_equal(points[seen], raw.points[seen])
    np.testing.assert_array_equal(np.concatenate([a.T for _, a in frames]), raw.analog)


def test_all_plate_types_give_the_same_force(tmp_path):
    from underfoot.trials.recording.plates import channel_forces

    _, force, moment, _ = _recording()
    loaded = slice(600, 1400)
    none = np.zeros(3)
    first = channel_forces(
        1,
        np.column_stack((force, np.full((len(force), 2), [0.01, 0.02]), np.zeros(len(force)))),
        none,
        None,
    )
    # type 3: the four vertical forces of half spacings a, b that carry this load and moment
    a, b, depth = 0.12, 0.2, 0.05
    below = moment + np.cross(np.broadcast_to([0.0, 0.0, -depth], force.shape), force)
    total, about_x, about_y = force[:, 2], below[:, 0] / b, below[:, 1] / a
    corners = [
        (total + about_x * s + about_y * t) / 4 for s, t in ((1, -1), (1, 1), (-1, 1), (-1, -1))
    ]
    third = channel_forces(
        3,
        np.column_stack((np.zeros((len(force), 2)), force[:, 1] / 2, force[:, 1] / 2, *corners)),
        np.array([a, b, depth]),
        None,
    )
    matrix = np.diag([2.0, 2.0, 4.0, 0.5, 0.5, 0.5])
    fourth = channel_forces(
        4, np.column_stack((force, moment)) @ np.linalg.inv(matrix).T, none, matrix
    )
    for found in (first, third, fourth):
        np.testing.assert_allclose(found[0][loaded], force[loaded], atol=1e-9)
        np.testing.assert_allclose(found[1][loaded][:, :2], moment[loaded][:, :2], atol=1e-9)


def test_one_bad_plate_does_not_lose_the_file(tmp_path):
    points, force, moment, corners = _recording()
    groups = {
        **GROUPS,
        "ANALOG": {"LABELS": list("abcdef"), "UNITS": ["N"] * 3 + ["Nm"] * 3},
        "FORCE_PLATFORM": {
            "USED": np.array([3]),
            "TYPE": np.array([2, 2, 7]),
            "CORNERS": np.repeat(corners.T[:, :, None].astype(float), 3, axis=2),
            "ORIGIN": np.zeros((3, 3)),
            "CHANNEL": np.column_stack((np.arange(1, 7), np.arange(11, 17), np.arange(1, 7))),
        },
    }
    path = tmp_path / "bad.c3d"
    path.write_bytes(c3d_bytes(points, np.column_stack((force, moment)), groups=groups))
    good, channel, kind = read_trial(path).plates
    assert good.usable
    assert "names channel 16 of 6" in channel.problem
    assert "type 7 is not supported" in kind.problem


def test_analog_alone_with_no_points_and_no_frame_rate(tmp_path):
    groups = {"ANALOG": {"LABELS": ["Fz"], "UNITS": ["N"], "RATE": np.array([1000.0])}}
    path = tmp_path / "analog.c3d"
    analog = np.arange(100.0)[:, None]
    path.write_bytes(c3d_bytes(np.empty((100, 0, 3)), analog, groups=groups, point_rate=0.0))
    channel = read_trial(path).channel("fz")
    assert channel.rate == 1000.0
    np.testing.assert_array_equal(channel.values, np.arange(100.0))


def test_a_damaged_float_of_a_parameter_is_no_number():
    signalling = bytes([4, 1, 1]) + (0x7F800001).to_bytes(4, "little")
    assert np.isnan(c3d._value(signalling, 84, "SCALE", "damaged.c3d")).all()


def test_more_than_255_labels(tmp_path):
    labels = [f"P{i}" for i in range(300)]
    groups = {"POINT": {"LABELS": labels[:255], "LABELS2": labels[255:], "UNITS": ["m"]}}
    path = tmp_path / "many.c3d"
    path.write_bytes(c3d_bytes(np.ones((3, 300, 3)), np.empty((0, 0)), groups=groups))
    assert list(read_trial(path).markers) == labels


BIOWARE = (
    "BioWare export\nSampling rate (Hz):\t1000\n\n"
    "abs time (s)\tFx\tFy\tFz\t|Ft|\tAx\tAy\tFx\tFy\tFz\t|Ft|\tAx\tAy\ns\t"
    + "\t".join(["N", "N", "N", "N", "m", "m"] * 2)
    + "\n"
)


def test_bioware_is_turned_to_the_force_on_the_foot(tmp_path):
    rows = []
    for i in range(1000):
        load = 600.0 if 300 <= i < 900 else 0.0
        one = f"{-0.1 * load:.3f}\t{0.05 * load:.3f}\t{load:.3f}\t{load:.3f}\t0.01\t0.02"
        rows.append(f"{i / 1000:.3f}\t{one}\t" + "\t".join(["0.0"] * 6))
    path = tmp_path / "walk.txt"
    path.write_text(BIOWARE + "\n".join(rows) + "\n")
    trial = read_trial(path)
    assert trial.source == "BioWare text"
    first, second = trial.plates
    np.testing.assert_allclose(first.force[500], [60.0, -30.0, 600.0], atol=1e-9)
    assert "never loaded" in map(str, second.flags)
    assert any("duplicate" in note for note in trial.notes)
    commas = tmp_path / "komma.txt"
    commas.write_text(BIOWARE + "\n".join(row.replace(".", ",") for row in rows) + "\n")
    other = read_trial(commas)
    np.testing.assert_array_equal(other.plates[0].force, first.force)
    assert "decimal commas" in other.notes


@pytest.mark.parametrize("header", ["nRows=50\nnColumns=7\n", "datarows 50\ndatacolumns 7\n"])
@pytest.mark.parametrize("names", ["ground_force_v{}", "1_ground_force_v{}", "R_ground_force_v{}"])
def test_motion_headers_and_column_names(tmp_path, header, names):
    labels = [names.format(axis) for axis in "xyz"]
    labels += [label.replace("force_v", "force_p") for label in labels]
    rows = [f"{i / 100:.2f}\t-10\t{700 + i}\t5\t0.1\t0\t0.2" for i in range(50)]
    path = tmp_path / "grf.sto"
    path.write_text("grf\n" + header + "endheader\ntime\t" + "\t".join(labels) + "\n")
    with path.open("a") as stream:
        stream.write("\n".join(rows) + "\n")
    plate = read_trial(path).plates[0]
    np.testing.assert_allclose(plate.force[3], [-10.0, 703.0, 5.0])
    np.testing.assert_allclose(plate.centre_of_pressure[3], [0.1, 0.0, 0.2])


PROFILE = """
name = "Slip tester, hall 2"
[file]
header_line = 2
rate = "500 Hz"
[channels.pressure_1]
column = "P1"
unit = "kPa"
[plates.1]
force = ["Kraft X", "Kraft Y", "Kraft Z"]
unit = "kN"
force_is = "on the plate"
corners = [[0.6, 0.4, 0], [0.6, 0, 0], [0, 0, 0], [0, 0.4, 0]]
[markers.heel]
columns = ["hx", "hy", "hz"]
unit = "cm"
[heel]
left = "heel"
[axes]
vertical = "z"
walking = "+x"
[subject]
mass = "70 kg"
[sensors]
unit = "mm"
P1 = [100, 0, 0]
"""


def _profiled(tmp_path):
    (tmp_path / "lab.toml").write_text(PROFILE)
    lines = ["Messung 12", "Kraft X;Kraft Y;Kraft Z;P1;hx;hy;hz;note"]
    for i in range(400):
        load = -0.5 if 150 <= i < 350 else 0.0
        lines.append(f"{-0.1 * load:.4f};0;{load:.4f};{2.5 if i > 200 else 0.0};{i};5;3;ok")
    path = tmp_path / "run.csv"
    path.write_text("\n".join(lines).replace(".", ",") + "\n")
    return path


def test_a_profile_maps_columns_units_and_signs(tmp_path):
    trial = read_trial(_profiled(tmp_path), tmp_path / "lab.toml")
    plate = trial.plates[0]
    np.testing.assert_allclose(plate.force[200], [-50.0, 0.0, 500.0], atol=1e-9)
    assert plate.rate == 500.0
    assert trial.channel("pressure_1").values[300] == pytest.approx(2500.0)
    np.testing.assert_allclose(trial.marker("heel").positions[100], [1.0, 0.05, 0.03])
    assert trial.settings["body mass (kg)"] == "70"
    assert any("text are left out" in note for note in trial.notes)
    assert read_profile(tmp_path / "lab.toml").sensors["P1"] == pytest.approx((0.1, 0.0, 0.0))


@pytest.mark.parametrize(
    ("data", "message"),
    [
        ({"plate": {}}, 'Did you mean "plates"'),
        ({"plates": {"1": {"force": ["a", "b"]}}}, "three column names"),
        ({"plates": {"1": {"force": ["a", "b", "c"], "unit": "kPa"}}}, "no known unit of N"),
        ({"file": {"rate": "1000"}}, "has no unit"),
        ({"axes": {"walking": "forward"}}, "is no axis"),
        ({"channels": {"p": {"unit": "Pa"}}}, "needs its column"),
    ],
)
def test_a_wrong_profile_is_told(data, message):
    with pytest.raises(InputError, match=message):
        profile_from(data)


def test_a_profile_naming_an_absent_column(tmp_path):
    path = _profiled(tmp_path)
    text = (tmp_path / "lab.toml").read_text().replace("Kraft Z", "Kraft ZZ")
    (tmp_path / "lab.toml").write_text(text)
    with pytest.raises(DataError, match='Did you mean "Kraft Z"'):
        read_trial(path, tmp_path / "lab.toml")


def test_xlsx_reads_as_csv_does(tmp_path):
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    sheet = book.active
    sheet.append(["Time (s)", "Fx (N)", "Fy (N)", "Fz (N)", "Fz (N)"])
    for i in range(200):
        sheet.append([i / 100, 10.0 * (i > 50), 0.0, 300.0 * (i > 50), 1.0])
    book.save(tmp_path / "run.xlsx")
    trial = read_trial(tmp_path / "run.xlsx")
    assert trial.plates[0].force[100] == pytest.approx([10.0, 0.0, 300.0])
    assert "Fz #2" in trial.channels
    assert trial.source == "XLSX table"
    whole = (tmp_path / "run.xlsx").read_bytes()
    (tmp_path / "cut.xlsx").write_bytes(whole[: len(whole) // 2])
    with pytest.raises(DataError, match="workbook is damaged"):
        read_trial(tmp_path / "cut.xlsx")


def test_units_row_header_rate_and_markers_are_recognised(tmp_path):
    lines = ["sampling rate: 200 Hz", "heel_x,heel_y,heel_z,p1", "mm,mm,mm,bar"]
    lines += [f"{i},{2 * i},30,{0.5}" for i in range(60)]
    (tmp_path / "a.csv").write_text("\n".join(lines))
    trial = read_trial(tmp_path / "a.csv")
    assert trial.marker("heel").rate == 200.0
    np.testing.assert_allclose(trial.marker("heel").positions[10], [0.01, 0.02, 0.03])
    assert trial.channel("p1").values[0] == pytest.approx(5e4)


C3D_FILES = sorted(DATA.rglob("*.c3d"))


@pytest.mark.parametrize("path", C3D_FILES, ids=lambda path: path.stem)
def test_a_long_file_read_in_parts_holds_what_it_holds_as_a_whole(path, monkeypatch):
    from underfoot.trials.readers import file_bytes

    whole = c3d.parse(path.read_bytes(), path.name)
    monkeypatch.setattr(c3d, "_READ", 50_000)
    file = file_bytes.FileBytes(path)
    parts = c3d.parse(file, path.name)
    file.close()
    assert (parts.first_frame, parts.notes) == (whole.first_frame, whole.notes)
    assert parts.points.dtype == parts.analog.dtype == np.float32
    np.testing.assert_allclose(parts.points, whole.points, rtol=1e-6)
    np.testing.assert_allclose(parts.analog, whole.analog, rtol=1e-6)


def test_a_long_recording_gives_the_same_friction_and_checksum(monkeypatch):
    from underfoot.trials import readers, required_frictions, walkway_of

    path = DATA / "biomechzoo/HC030A05.c3d"
    whole = read_trial(path)
    monkeypatch.setattr(readers, "_LONG", 1000)
    parts = read_trial(path)
    assert parts.checksum == whole.checksum
    first, second = (
        [step.measurement.value for step in required_frictions(walkway_of(one))]
        for one in (whole, parts)
    )
    assert second == pytest.approx(first, rel=1e-5)
    assert len(first) == 2


def test_steps_of_a_long_record_are_those_of_the_short_one(tmp_path):
    """A walk again and again: each time the same steps."""
    from benchmarks.long_records import WALKS, write_repeated

    from underfoot.trials import required_frictions, walkway_of

    walk = WALKS["291 points"]
    write_repeated(walk, 3.5e-6 * walk.stat().st_size, tmp_path / "long.c3d")
    once = [step.measurement.value for step in required_frictions(walkway_of(read_trial(walk)))]
    again = [
        s.measurement.value
        for s in required_frictions(walkway_of(read_trial(tmp_path / "long.c3d")))
    ]
    assert len(again) > 2 * len(once)
    assert again[: len(once)] == pytest.approx(once, abs=2e-3)


def test_what_a_step_asks_of_a_whole_record_is_worked_out_once(monkeypatch):
    from underfoot.trials import required_frictions, walkway_of
    from underfoot.trials.walking import plausibility, slips

    trial = read_trial(DATA / "biomechzoo/HC030A05.c3d")
    counts = {"marker_jumps": 0, "runs": 0}

    def counted(module, name):
        function = getattr(module, name)

        def count(*args, **kwargs):
            counts[name] += 1
            return function(*args, **kwargs)

        monkeypatch.setattr(module, name, count)

    counted(slips, "marker_jumps")  # of each heel
    counted(plausibility, "runs")  # of the unloaded parts of each plate, and of lines of a step
    walk = walkway_of(trial)
    first = required_frictions(walk)
    once = dict(counts)
    second = required_frictions(walk)
    assert counts["marker_jumps"] == once["marker_jumps"] == 2
    assert [s.measurement.value for s in second] == [s.measurement.value for s in first]
    assert counts["runs"] - once["runs"] < once["runs"]


def test_a_path_on_a_belt_is_the_15_s_around_the_step():
    from underfoot.trials import walkway_of

    walk = walkway_of(read_trial(DATA / "gaitalytics/treadmill_events.c3d"))
    (plate, *_), name = walk.belts, walk.heels["left"]
    whole = walk.trial.marker(name)
    near = walk.marker(name, plate, 6.0)
    assert len(near.positions) == len(whole.positions)  # a record of 12 s
    np.testing.assert_array_equal(near.time, whole.time)
    early = walk.marker(name, plate, -10.0)
    assert early.time[-1] == pytest.approx(5.0, abs=0.01)
    moved = early.positions - whole.positions[: len(early.positions)]
    speed = walk.belts[plate].velocity(-10.0)
    np.testing.assert_allclose(moved, -np.outer(early.time + 10.0, speed), atol=1e-9)


def test_components_of_single_precision_are_those_of_double():
    from underfoot.trials.recording.signals import along

    forces = np.random.default_rng(1).normal(size=(50, 3)).astype("f4")
    axis = np.array([0.6, 0.0, 0.8])
    found = along(forces, axis)
    assert found.dtype == float
    np.testing.assert_allclose(found, forces.astype(float) @ axis, rtol=1e-12)


def test_standing_is_found_across_the_parts_of_a_long_record(monkeypatch):
    from underfoot.trials.walking import body_weight

    samples = 5000
    normal = np.full(samples, 700.0) + 40.0 * np.sin(np.arange(samples))
    normal[2000:2700] = 690.0  # 0.7 s of standing, over the end of a part
    force = np.column_stack((np.zeros((samples, 2)), normal))
    trial = Trial("a", plates=(Plate("plate 1", force, 1000.0),))
    whole = body_weight.body_weight(trial)
    monkeypatch.setattr(body_weight, "_AT_ONCE", 1900)
    parts = body_weight.body_weight(trial)
    assert whole.newtons == pytest.approx(690.0, abs=3.0)  # the edge may swing by 1.5 %
    assert parts.newtons == pytest.approx(whole.newtons, rel=1e-9)
