"""What a valid recording says is what we read, in every form, or we stop with the reason."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import walk_forms
from commands import called
from underfoot.core import DataError
from underfoot.trials import Channel, Trial, read_trial, read_trials
from underfoot.trials.machines.pin_on_disk import friction_point
from underfoot.trials.readers import TrialsProfile
from underfoot.trials.readers.c3d_writer import c3d_bytes
from underfoot.trials.readers.seen import HELD, SIGN, STRAIGHT, unseen
from underfoot.trials.readers.text import force_unit, si_unit
from underfoot.trials.walking.describe import describe_trial, described_file
from walk_forms import FORMS, RCOF, SHORT, written

DATA = Path(__file__).parents[1] / "data"
OWN = DATA / "recordings"


@pytest.mark.parametrize("form", FORMS)
def test_one_walk_in_every_form(form, tmp_path):
    path, beside = written(form, tmp_path)
    found = described_file(path, companion=beside)[0]
    values = sorted(step.measurement.value or np.nan for step in found.steps)
    assert values == pytest.approx(sorted(RCOF.values()), abs=0.002)


@pytest.mark.parametrize("axes", ["+x +y +z", "+z +x +y", "+x -y -z"])
def test_a_walk_written_for_opensim_is_the_same_walk(tmp_path, axes):
    given = tmp_path / "given.c3d"
    given.write_bytes(walk_forms._c3d(("N", 1.0), ("Nmm", 1e-3), axes=axes))
    for name in ("a.trc", "b.mot"):
        done = called("trials", "export", given, "--out", tmp_path / name)
        assert done.returncode == 0, done.stderr
        again = called("trials", "export", given, "--out", tmp_path / name)
        assert "is there already" in again.stderr
    markers, forces = read_trial(tmp_path / "a.trc"), read_trial(tmp_path / "b.mot")
    assert forces.vertical.axis == (0.0, 1.0, 0.0)
    assert forces.plates[0].force[:, 1].max() > 400.0
    found = described_file(tmp_path / "a.trc", companion=tmp_path / "b.mot")[0]
    values = sorted(step.measurement.value or np.nan for step in found.steps)
    assert values == pytest.approx(sorted(RCOF.values()), abs=0.002)
    first, trial = markers.markers["RHEE"].positions, read_trial(given)
    steps = np.linalg.norm(np.diff(trial.markers["RHEE"].positions, axis=0), axis=1)
    np.testing.assert_allclose(np.linalg.norm(np.diff(first, axis=0), axis=1), steps, atol=1e-6)


def test_markers_of_pyomeca_are_markers(tmp_path):
    """x_LHEE, y_LHEE, z_LHEE, as it writes points of a C3D in mm."""
    markers = walk_forms.walk().markers
    heads = [f"{axis}_{name}" for axis in "xyz" for name in markers]
    columns = [1e3 * one.positions[:, i] for i in range(3) for one in markers.values()]
    rate = next(iter(markers.values())).rate
    rows = np.column_stack([np.arange(len(columns[0])) / rate, *columns])
    path = tmp_path / "points.csv"
    np.savetxt(path, rows, "%.6g", ",", header=",".join(["time", *heads]), comments="")
    found = read_trial(path).markers
    assert {*found} == {*markers}
    for name, marker in markers.items():
        np.testing.assert_allclose(found[name].positions, marker.positions, atol=1e-5)


@pytest.mark.parametrize("columns", [range(1, 7), [3], [3, 6]])
@pytest.mark.parametrize("code", ["-9999", "9999999"])
def test_codes_for_lost_forces_are_no_forces(tmp_path, columns, code):
    lines = walk_forms.table().splitlines()
    for i in range(701, 705):  # within a step
        cells = lines[i].split(",")
        lines[i] = ",".join(code if k in columns else cell for k, cell in enumerate(cells))
    path = tmp_path / "a.csv"
    path.write_text("\n".join(lines))
    values = [step.measurement.value for step in described_file(path)[0].steps]
    assert sum(value is None for value in values) >= 1
    right = list(RCOF.values())
    assert all(np.isclose(value, right, atol=0.002).any() for value in values if value is not None)
    assert np.isnan(read_trial(path).plates[0].force[700:704]).all()


@pytest.mark.parametrize("column", [1, 2])
def test_codes_of_a_tribometer_are_no_forces(tmp_path, column):
    generator, time = np.random.default_rng(1), np.arange(0.0, 60.0, 0.02)
    load = np.where((time > 10) & (time < 50), 20.0, 0.0)
    values = np.column_stack([time, load, 0.35 * load])
    values[:, 1:] += generator.normal(0.0, 0.05, (len(time), 2))
    values[1500:1504, column] = -9999.0
    head = "Time (s),Normal Force (N),Friction Force (N)\n"
    path = tmp_path / "a.csv"
    path.write_text(head + "\n".join(",".join(f"{v:.4f}" for v in row) for row in values))
    trial = read_trial(path)
    assert any("hold a code" in note for note in trial.notes)
    assert friction_point(trial).cof.value == pytest.approx(0.35, abs=0.002)


def test_a_clock_goes_on_after_midnight(tmp_path):
    lines = ["Time,Fx1 (N),Fy1 (N),Fz1 (N)"]
    stamps = ["23:59:59.98", "23:59:59.99", "00:00:00.00", "00:00:00.01", "00:00:00.02"]
    lines += [f"2.1.2026 {stamp},1,2,{900 + n}" for n, stamp in enumerate(stamps)]
    path = tmp_path / "a.csv"
    path.write_text("\n".join(lines))
    assert read_trial(path).plates[0].rate == pytest.approx(100.0)
    path.write_text("\n".join(lines).replace("00:00:00.00", "late"))
    with pytest.raises(DataError, match=r'"2\.1\.2026 late" in the column "Time" is no time'):
        read_trial(path)


def test_vectors_are_places_of_markers_where_their_unit_is_a_length(tmp_path):
    rows = [f"{n / 100}\t{n},800,20\t{n + 180},805,{20 + n}" for n in range(9)]
    head = ["DataType=Vec3", "Units=mm", "endheader", "time\tRHEE\tRTOE"]
    path = tmp_path / "a.sto"
    path.write_text("\n".join([*head, *rows]))
    markers = read_trial(path).markers
    assert markers["RTOE"].positions[4] == pytest.approx([0.184, 0.805, 0.024])
    path.write_text("\n".join([head[0], *head[2:], *rows]))
    assert not read_trial(path).markers


def test_counts_that_contradict_the_bytes_are_told():
    notes = [note for note in read_trial(SHORT).notes if "frames are counted" in note]
    assert notes == ["frames are counted in two ways (the header 100): the data hold 195, all read"]


def test_plates_that_are_described_and_not_used_are_told(tmp_path):
    data = walk_forms._c3d(("N", 1.0), ("Nmm", 1e-3))
    group = data.index(b"FORCE_PLATFORM")
    at = data.index(b"USED", group) + 4
    kind, dimensions = data[at + 2], data[at + 3]
    assert (kind, dimensions) == (2, 0)
    (tmp_path / "a.c3d").write_bytes(data[: at + 4] + b"\1\0" + data[at + 6 :])
    trial = read_trial(tmp_path / "a.c3d")
    assert len(trial.plates) == 1
    assert any("1 more" in note for note in trial.notes)
    (tmp_path / "b.c3d").write_bytes(data)
    assert not any("left out" in note for note in read_trial(tmp_path / "b.c3d").notes)


@pytest.mark.parametrize("word", ["slug", "tonf-ish", "V"])
def test_a_unit_that_is_not_known_stops_the_plate(word, tmp_path):
    (tmp_path / "a.c3d").write_bytes(walk_forms._c3d((word, 1.0), ("Nmm", 1e-3)))
    for plate in read_trial(tmp_path / "a.c3d").plates:
        assert not plate.usable
        assert f'"{word}", which is no known N' in plate.problem


@pytest.mark.parametrize("word", ["ells", "N"])
def test_a_unit_that_is_no_length_stops_the_markers_of_nexus(word, tmp_path):
    (tmp_path / "a.csv").write_text(walk_forms.vicon(unit=word))
    with pytest.raises(DataError, match=f'"{word}", which is no known length'):
        read_trial(tmp_path / "a.csv")


def test_two_units_of_one_force_stop(tmp_path):
    head, *rows = walk_forms.table().splitlines()
    (tmp_path / "a.csv").write_text("\n".join([head, "ms" + ",kN" * 6, *rows]))
    with pytest.raises(DataError, match=r'column Fx1: two units.*"N" and "kN"'):
        read_trial(tmp_path / "a.csv")


@pytest.mark.parametrize(
    ("words", "unit", "factor"),
    [
        ("mm millimeter Millimetres MM [mm]", "m", 1e-3),
        ("cm Centimeters centimetre", "m", 1e-2),
        ("m meters Metre", "m", 1.0),
        ("in inches Inch", "m", 0.0254),
        ("ft feet foot", "m", 0.3048),
        ("N Newton NEWTONS (N)", "N", 1.0),
        ("daN", "N", 10.0),
        ("Nm N*m N-m N.m", "N*m", 1.0),
        ("Nmm N*mm kNum", "N*m", 1e-3),
        ("kNmm kN*mm", "N*m", 1.0),
        ("ft-lb lbf-ft lb*ft", "N*m", 1.3558179483314),
        ("in-lb lbs-in inlbf", "N*m", 0.1129848290276),
    ],
)
def test_unit_words(words, unit, factor):
    for word in words.split():
        found = si_unit(word)
        assert found is not None, word
        assert found[0] == unit, word
        assert found[1] == pytest.approx(factor, rel=1e-9), word


def test_a_mass_is_a_force_only_where_a_force_is_meant():
    assert si_unit("kg") is None
    assert force_unit("kg") == ("N", 9.80665, 0.0)
    assert force_unit("lbs") == ("N", 4.4482216152605, 0.0)


@pytest.mark.parametrize(
    ("markers", "events", "frames", "first"),
    [(3, 520, 60, 1), (300, 3, 20, 1), (2, 2, 70_000, 1), (2, 2, 900, 65_200)],
)
def test_an_export_of_any_size_is_read_back(markers, events, frames, first, tmp_path):
    ezc3d = pytest.importorskip("ezc3d")
    time = np.arange(frames) / 100.0
    paths = {
        f"M{i}": np.column_stack((0.01 * time + i, np.full(frames, 0.1 + i), 1 + 0.0 * time))
        for i in range(markers)
    }
    when = [("Foot Strike", "Left", (first - 1) / 100.0 + 0.3 * i) for i in range(events)]
    data = c3d_bytes(paths, 100.0, {}, 100.0, [], events=when, first_frame=first)
    (tmp_path / "a.c3d").write_bytes(data)
    trial = read_trial(tmp_path / "a.c3d")
    assert list(trial.markers) == list(paths)
    assert not trial.notes
    assert [event.time for event in trial.events] == pytest.approx([t for *_, t in when], abs=1e-4)
    last = trial.markers[f"M{markers - 1}"]
    assert last.start == pytest.approx((first - 1) / 100.0)
    np.testing.assert_allclose(last.positions, paths[f"M{markers - 1}"], atol=1e-5)
    other = ezc3d.c3d(str(tmp_path / "a.c3d"))["data"]["points"]
    assert other.shape[1] == markers
    assert other.shape[2] - frames in range(16)  # ezc3d counts the padding of a long file
    np.testing.assert_allclose(other[:3, -1, :frames].T * 1e-3, last.positions, atol=1e-5)


def test_a_marker_is_seen_where_it_was_measured():
    rng = np.random.default_rng(5)
    time = np.arange(300) / 100.0
    path = np.column_stack((time, 0.1 * np.sin(5 * time), 0.05 + 0.04 * np.cos(7 * time)))
    path = np.round(path + rng.normal(0, 1e-4, path.shape), 5)
    assert not unseen(path)
    held, back, line, sign = (path.copy() for _ in range(4))
    held[101:140] = held[100]
    assert unseen(held)[HELD].nonzero()[0] == pytest.approx(np.arange(101, 140))
    back[101:140] = back[140]
    assert unseen(back)[HELD].nonzero()[0] == pytest.approx(np.arange(101, 140))
    line[101:140] = np.round(
        line[100] + np.outer(np.arange(1, 40) / 40.0, line[140] - line[100]), 5
    )
    assert unseen(line)[STRAIGHT].nonzero()[0] == pytest.approx(np.arange(101, 140), abs=1)
    for number in (9999999.0, -999.0, -1.0, 123.456):
        sign[50:60], sign[70] = number, number
        assert unseen(sign)[SIGN].sum() == 11


@settings(max_examples=60, deadline=None)
@given(
    st.integers(0, 4),
    st.floats(0.05, 2.0),
    st.integers(20, 60),
    st.integers(0, 10_000),
)
def test_a_foot_that_stands_was_seen(digits, speed, still, seed):
    """A path that stops and starts by itself, in any resolution: nothing of it was held."""
    rng = np.random.default_rng(seed)
    ramp = np.cumsum(np.concatenate([
        np.linspace(speed, 0, 30) ** 2, np.zeros(still), np.linspace(0, speed, 30) ** 2,
    ])) / 100.0  # fmt: skip
    noise = rng.normal(0, 3e-4, (len(ramp), 3)) if digits > 3 else 0.0
    path = np.column_stack((ramp, 0.3 * ramp, 0.04 + 0.1 * ramp)) + noise
    assert HELD not in unseen(np.round(path, digits))


@pytest.mark.parametrize("name", sorted(p.name for p in (DATA / "trials").rglob("*.c3d")))
def test_nothing_of_a_sound_recording_is_lost(name):
    trial = read_trial(next((DATA / "trials").rglob(name)))
    assert not [note for note in trial.notes if "not seen" in note or "counted" in note]


def test_rows_faster_than_the_cameras_are_a_slower_clock():
    marker = read_trial(OWN / "dflow_markers_100_rows_300.txt").marker("RHEE")
    assert marker.rate == pytest.approx(100.0, rel=1e-3)
    assert not marker.missing.any()


def test_lengths_in_words_and_lengths_that_contradict_them(tmp_path):
    near = read_trial(OWN / "optitrack_Centimeters_near_origin.csv")
    assert near.marker("RHEE").positions[0] == pytest.approx([-0.6, 0.04, 0.092])
    assert near.vertical is not None
    assert near.vertical.axis == (0.0, 1.0, 0.0)
    with pytest.raises(DataError, match="As m it would fit"):
        read_trial(OWN / "metres_under_mm.trc")
    stated = read_trial(OWN / "metres_under_mm.trc", TrialsProfile(length_unit="m"))
    assert stated.marker("SACR").positions[0] == pytest.approx([0.0, 0.95, 0.0])
    (tmp_path / "a.trc").write_text(walk_forms.trc("furlongs"))
    with pytest.raises(DataError, match='"furlongs", which is no known length'):
        read_trial(tmp_path / "a.trc")


@pytest.mark.parametrize("factor", [10.0, 1000.0, 0.1, 0.001])
def test_a_body_of_a_wrong_size_stops(factor, tmp_path):
    (tmp_path / "a.trc").write_text(walk_forms.trc("mm", 1e-3 * factor, digits=7))
    with pytest.raises(DataError, match=r"As (cm|m|mm|inch) it would fit"):
        read_trial(tmp_path / "a.trc")


def test_the_vertical_that_a_person_gives_reaches_the_plates(tmp_path):
    (tmp_path / "a.mot").write_text(walk_forms.mot("+y +z +x"))
    found = described_file(tmp_path / "a.mot", vertical="x")[0]
    assert [plate.baseline_samples for plate in found.trial.plates] == [1257, 1272]
    wrong = described_file(tmp_path / "a.mot", vertical="z")[0]
    assert all("RCOF" not in step.reason for step in ())
    assert not [s for s in wrong.steps if s.measurement.value == pytest.approx(0.192, abs=0.002)]


def test_moments_and_pressure_of_a_plate_are_no_markers(tmp_path):
    plate = walk_forms.walk().plates[0]
    labels = "Frame,Time,FP1_Fx,FP1_Fy,FP1_Fz,FP1_Mx,FP1_My,FP1_Mz,FP1_COPx,FP1_COPy"
    place = np.nan_to_num(plate.centre_of_pressure, nan=0.2)
    rows = np.column_stack((plate.force, plate.moment, place[:, :2]))
    lines = [f"{i},{i / 1000:.3f}," + ",".join(f"{v:.4f}" for v in r) for i, r in enumerate(rows)]
    (tmp_path / "a.csv").write_text("\n".join([labels, *lines]))
    trial = read_trial(tmp_path / "a.csv")
    assert not trial.markers
    (step,) = describe_trial(trial).steps
    assert step.measurement.value == pytest.approx(0.192, abs=0.002)
    assert step.stance.direction.source == "centre of pressure"


def test_thousands_in_a_table_with_tabs():
    (step,) = described_file(OWN / "th2.txt")[0].steps
    assert step.stance.peak == pytest.approx(1075, abs=1)
    assert step.measurement.value == pytest.approx(0.171, abs=0.001)


REFUSED = {
    "a.sto": ((OWN / "orientations.sto").read_text(), "orientations of sensors"),
    "a.bvh": ("HIERARCHY\nROOT Hips\n{\n", "BVH"),
    "a.anc": ("File_Type:\tAnalog R/C ASCII\tGeneration#:\t2\nBoard_Type:\tX\n", r"\.anc"),
    "v3d.txt": ("\ta.c3d\n\tRHEE\n\tTARGET\n\tORIGINAL\nITEM\tX\tY\n1\t2\t3\n", "Visual3D"),
    "insole.txt": ("# Moticon OpenGo export\n0\t1\t2\n1\t2\t3\n", "Moticon"),
    "sole.txt": ("loadsol recording\nTime\tLeft\n0\t1\n1\t2\n", "loadsol"),
    "emg.csv": ("Noraxon MR3\nt,a\n0,1\n1,2\n", "Noraxon"),
    "delsys.csv": ("Delsys Trigno\nt,a\n0,1\n1,2\n", "Delsys"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_not_read_says_what_it_is(name, tmp_path):
    content, words = REFUSED[name]
    (tmp_path / name).write_text(content)
    with pytest.raises(DataError, match=words) as told:
        read_trials(tmp_path / name)
    assert told.value.remedy
    assert "OptiTrack" not in str(told.value)


def _machine(
    load=21.0, offset=0.0, drift=0.0, before=8.0, after=8.0, stroke=None, own_zero=0.0, seed=0
):
    """A run of 40 s at COF 0.35; off the disk before and after."""
    rng, rate = np.random.default_rng(seed), 50.0
    time = np.arange(round((before + 40.0 + after) * rate)) / rate
    normal = np.where((time >= before) & (time < before + 40.0), load, 0.0)
    way = np.tanh(8.0 * np.sin(2 * np.pi * time)) if stroke else np.ones(len(time))
    way = np.abs(way) if stroke == "rectified" else way
    way = (time % 2.0 < 1.2) * 1.0 if stroke == "rests" else way
    push = 0.35 * normal * way + offset + drift * time / time[-1]
    return Trial("run", channels={
        "Fx": Channel(push + rng.normal(0, 0.1, len(time)), "N", rate),
        "Fz": Channel(own_zero - normal + rng.normal(0, 0.05, len(time)), "N", rate),
    })  # fmt: skip


@pytest.mark.parametrize(
    "given",
    [
        {}, {"offset": 2.1}, {"offset": -12.0}, {"offset": 30.0}, {"drift": 3.0},
        {"own_zero": 4.0}, {"offset": 2.0, "after": 0.0}, {"offset": 2.0, "before": 0.0},
        {"offset": 2.0, "before": 100.0, "after": 60.0}, {"stroke": "signed"},
        {"stroke": "signed", "offset": 9.0}, {"stroke": "rectified"},
        {"stroke": "signed", "offset": 9.0, "before": 0.0, "after": 0.0},
        {"stroke": "rests"}, {"stroke": "rests", "offset": -3.0},
        {"stroke": "rests", "before": 0.0, "after": 0.0},
    ],
)  # fmt: skip
def test_zero_and_strokes_of_a_pin(given):
    cof = friction_point(_machine(**given)).cof
    assert cof.value == pytest.approx(0.35, abs=0.0015)
    assert not cof.flags
    off = given.get("before", 8.0) or given.get("after", 8.0)
    assert ("zero" in cof.conventions) == bool(off)
    assert ("strokes" in cof.conventions) == ("stroke" in given)


def test_the_uncertainty_tells_what_the_zero_adds():
    steady, drifting = (friction_point(_machine(drift=d)).cof.uncertainty for d in (0.0, 3.0))
    assert steady == pytest.approx(0.0004, abs=0.0003)
    # A zero that may go from 0 to 3 N at any time: 3 N / sqrt(12) of 21 N, less at its ends.
    assert 0.02 < drifting < 3.0 / 12**0.5 / 21.0


def _logged(heading, columns):
    rows = "\n".join(";".join(f"{v:.4f}" for v in row) for row in columns(*_forces()))
    return f"{heading}\n{rows}\n"


def _forces():
    run = _machine(offset=1.0)
    return np.arange(len(run.channels["Fz"].values)) / 50.0, *(
        run.channels[name].values for name in ("Fz", "Fx")
    )


@pytest.mark.parametrize(
    ("heading", "columns"),
    [
        ("Time (s);Load (kg);Friction (N)", lambda t, n, f: np.c_[t, -n / 9.80665, f]),
        ("Zeit in s;Last in g;Reibkraft in mN", lambda t, n, f: np.c_[t, -n * 101.97162, 1e3 * f]),
        ("Time (s);COF", lambda t, n, f: np.c_[t, np.where(n < -2.0, (1.0 - f) / n, 0.0)]),
    ],
    ids=["weights", "German weights", "a COF of zero off the disk"],
)
def test_a_log_has_the_friction_of_its_pressed_part(tmp_path, heading, columns):
    (tmp_path / "log.csv").write_text(_logged(heading, columns))
    cof = friction_point(read_trial(tmp_path / "log.csv")).cof
    assert cof.value == pytest.approx(0.35, abs=0.0015)
    assert not cof.flags


@pytest.mark.parametrize("name", ["pin_offset.csv", "pin_reciprocating.csv"])
def test_pins_with_a_right_value(name):
    assert friction_point(read_trial(OWN / name)).cof.value == pytest.approx(0.35, abs=0.001)


def _trb3(point):
    head = "Time [s]\tDistance [m]\tLaps\tMax Linear Speed [m/s]\tNominal Load [N]\tµ\tAngle [°]"
    rows = (f"{i / 10:.3f}\t{i / 100:.4f}\t{i // 10}\t0.1\t5\t{0.35:.4f}\t{i * 36 % 360}"
            for i in range(600))  # fmt: skip
    above = "TRB3\nSoftware\tTribometer\nSample:\tA\nMode:\tSingle-way mode\n\n"
    return above + "\n".join([head, *rows]).replace(".", point) + "\n"


def _rtec():
    rows = []
    for step, (count, load) in enumerate(((200, 0.0), (800, 20.0), (200, 0.0)), 1):
        rows += [f"{i},{i * 0.02:.3f},{step},{load:.4f},{0.35 * load + 1.5:.4f},0.4,60,"
                 for i in range(count)]  # fmt: skip
    head = "Step, Timestamp, RecipeStep, DAQ.Fz (N),DAQ.Fx (N),DAQ.COF (),Rotary.Velocity (rpm),"
    return "Operator,Sample\rAnna,s1\r\n" + "\n".join([head, *rows]) + "\nTotalTime\n00:00:24\n"


@pytest.mark.parametrize(
    "content",
    [_trb3("."), _trb3(","), _trb3(",").encode("utf-16"), _rtec()],
    ids=["TRB3", "TRB3, commas", "TRB3, UTF-16", "Rtec"],
)
def test_logs_as_they_come_from_the_machine(content, tmp_path):
    data = content if isinstance(content, bytes) else content.encode()
    (tmp_path / "log.csv").write_bytes(data)
    assert friction_point(read_trial(tmp_path / "log.csv")).cof.value == pytest.approx(0.35)


def test_the_heel_that_was_held_is_named(tmp_path):
    from underfoot.trials.simulator.folder import simulated_folder
    from underfoot.trials.walking.events import stances
    from underfoot.trials.walking.slips import slip_of
    from underfoot.trials.walking.walkway import walkway_of

    simulated_folder("slips", tmp_path, count=4)
    judged = 0
    for path in sorted(tmp_path.glob("*.c3d")):
        trial = read_trial(path)
        for stance in stances(walkway_of(trial)):
            whole = slip_of(walkway_of(trial), stance)
            if not whole.slipped or not stance.heel:
                continue
            marker = trial.marker(stance.heel)
            first = int(np.searchsorted(marker.time, stance.contact + 0.05))
            held = marker.positions.copy()
            held[first + 1 : first + 45] = held[first]
            assert unseen(held)[HELD][first + 1 : first + 45].all()
            lost = np.where(unseen(held)[HELD][:, None], np.nan, held)
            markers = {**trial.markers, stance.heel: replace(marker, positions=lost, note="held")}
            found = slip_of(walkway_of(replace(trial, markers=markers)), stance)
            assert found.slipped is None
            assert "(held)" in found.peak_speed.reason
            judged += 1
    assert judged
