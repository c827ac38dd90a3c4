"""Readers of the wing, the registry, C3D files with faults, and text that nobody knows."""

import json
import struct
from importlib import import_module

import ezc3d
import numpy as np
import pytest

from underfoot.core import DataError
from underfoot.trials import read_trial, read_trials
from underfoot.trials.readers import READERS

TIME = np.arange(200) / 100.0
HEEL = np.column_stack((0.5 * TIME, 0.05 + 0.02 * np.sin(9 * TIME), 0.1 + 0 * TIME))


def motive(units="Meters", version="1.23", tagged=True):
    lead = [",Type,", ",Name,", ",ID,", ",,"] if tagged else [",,", ",,", ",,", ",,"]
    kinds = ["Marker"] * 3 + ["Rigid Body"] * 7
    names = ["Anna:LHeel"] * 3 + ["Left Shoe"] * 7
    what = ["Position"] * 3 + ["Rotation"] * 4 + ["Position"] * 3
    lines = [
        f"Format Version,{version},Take Name,w 1,Capture Frame Rate,100.000000,"
        f"Export Frame Rate,100.000000,Total Exported Frames,200,Length Units,{units}",
        "",
        lead[0] + ",".join(kinds), lead[1] + ",".join(names),
        lead[2] + ",".join(["A1"] * 10), lead[3] + ",".join(what),
        "Frame,Time (Seconds),X,Y,Z,X,Y,Z,W,X,Y,Z",
    ]  # fmt: skip
    scale = 1000.0 if units == "Millimeters" else 1.0
    for i, (t, p) in enumerate(zip(TIME, HEEL * scale, strict=True)):
        cells = ["", "", ""] if i == 7 else [f"{v:.6f}" for v in p]
        body = [f"{v:.6f}" for v in p + scale]
        lines.append(",".join([str(i), f"{t:.6f}", *cells, "0", "0", "0", "1", *body]))
    return "\n".join(lines)


@pytest.mark.parametrize("units", ["Meters", "Millimeters"])
@pytest.mark.parametrize("tagged", [True, False])
def test_motive(tmp_path, units, tagged):
    path = tmp_path / "take.csv"
    path.write_text(motive(units, tagged=tagged))
    trial = read_trial(path)
    assert trial.source == "OptiTrack Motive CSV"
    assert list(trial.markers) == ["LHeel", "Left Shoe"]
    heel = trial.markers["LHeel"]
    assert heel.rate == pytest.approx(100)
    assert heel.missing.tolist() == [i == 7 for i in range(200)]
    seen = ~heel.missing
    assert heel.positions[seen] == pytest.approx(HEEL[seen], abs=1e-6)
    assert trial.markers["Left Shoe"].positions == pytest.approx(HEEL + 1, abs=1e-6)


def test_motive_truncated_or_without_positions(tmp_path):
    path = tmp_path / "take.csv"
    path.write_text("\n".join(motive().split("\n")[:-20]))
    with pytest.raises(DataError, match="Total Exported Frames is 200"):
        read_trial(path)
    path.write_text(motive().replace("Position", "Rotation"))
    with pytest.raises(DataError, match="no marker has a position"):
        read_trial(path)


def emt(kind, unit, labels, rows):
    head = f"BTS ASCII format\n\nType:         \t{kind}\nMeasure unit: \t{unit}\n\n"
    head += f"Tracks:       \t3\nFrequency:    \t100 Hz\nFrames:       \t{len(rows)}\n"
    head += "Start time:   \t0.000\n\n"
    return head + "\t".join(labels) + "\t\n" + "\n".join("\t".join(row) for row in rows)


def test_bts_tracks_and_events(tmp_path):
    rows = [[f"{i}", f"{t:.3f}", *(f"{v:.2f}" for v in 1e3 * p)]
            for i, (t, p) in enumerate(zip(TIME, HEEL, strict=True), 1)]  # fmt: skip
    labels = [" Frame", "  Time", "r heel.X", "r heel.Y", "r heel.Z"]
    (tmp_path / "points.emt").write_text(emt("Point 3D tracks", "mm", labels, rows))
    trial = read_trial(tmp_path / "points.emt")
    assert trial.markers["r heel"].positions == pytest.approx(HEEL, abs=1e-5)
    load = 700 * np.sin(np.pi * TIME / 2)
    rows = [[f"{i}", f"{t:.3f}", "1.0", f"{v:.3f}", "2.0"]
            for i, (t, v) in enumerate(zip(TIME, load, strict=True), 1)]  # fmt: skip
    labels = ["Frame", "Time", "FP1.FX", "FP1.FY", "FP1.FZ"]
    (tmp_path / "force.emt").write_text(emt("Force tracks", "N", labels, rows))
    forces = read_trial(tmp_path / "force.emt", subtract_baseline=False)
    names = list(forces.channels)
    assert forces.channels[names[-2]].values.max() == pytest.approx(700, abs=1)
    assert forces.channels[names[-2]].unit == "N"
    text = "BTS ASCII format\n\nType:\tEvent Sequences\nMeasure unit:\ts\n\n"
    text += "Item\teRHS\teRTO\teLHS\n1\t0.40\t1.00\t0.90\n2\t1.50\t\t2.00\n"
    (tmp_path / "events.emt").write_text(text)
    events = read_trial(tmp_path / "events.emt").events
    assert [(e.name, e.side, e.time) for e in events][:2] == [
        ("heel contact", "right", 0.4), ("heel contact", "left", 0.9)]  # fmt: skip
    assert len(events) == 5


def test_mvnx_turns_the_points_of_the_foot(tmp_path):
    # the foot is turned by 90 deg about z: a point 0.1 m along its x lies 0.1 m along y
    q = f"{np.sqrt(0.5)} 0 0 {np.sqrt(0.5)}"
    frames = "".join(
        f'<frame time="{10 * i}" type="{kind}"><orientation>1 0 0 0 {q}</orientation>'
        f"<position>0 0 1 {0.01 * i} 2 0.1</position></frame>"
        for i, kind in enumerate(["identity", "tpose"] + ["normal"] * 50)
    )
    text = (
        '<?xml version="1.0"?><mvnx version="4" xmlns="http://www.xsens.com/mvn/mvnx">'
        '<subject label="A" frameRate="100" segmentCount="2"><segments>'
        '<segment label="Pelvis" id="1"/><segment label="RightFoot" id="2"><points>'
        '<point label="pHeelFoot"><pos_b>0.1 0 -0.05</pos_b></point></points></segment></segments>'
        f"<frames>{frames}</frames></subject></mvnx>"
    )
    (tmp_path / "walk.mvnx").write_text(text)
    trial = read_trial(tmp_path / "walk.mvnx")
    heel = trial.markers["Right HeelFoot"].positions
    assert heel.shape == (50, 3)
    assert heel[0] == pytest.approx([0.02, 2.1, 0.05])
    for right, wrong, what in (
        ("0.1 0 -0.05", "0.1 0 -0.05 1", "pos_b of a point of RightFoot is not 3 numbers"),
        ("0.1 0 -0.05", "0.1 0 none", "pos_b of a point of RightFoot is not 3 numbers"),
        ("<position>0 0 1 ", "<position>0 0 ", "position of a frame is not 6 numbers"),
        ("<orientation>1 0", "<orientation>1 ?", "orientation of a frame is not 8 numbers"),
    ):
        (tmp_path / "damaged.mvnx").write_text(text.replace(right, wrong))
        with pytest.raises(DataError, match=f"damaged: {what}"):
            read_trial(tmp_path / "damaged.mvnx")
    (tmp_path / "cut.mvnx").write_text(text[:-60])
    with pytest.raises(DataError, match="not valid XML"):
        read_trial(tmp_path / "cut.mvnx")


def xsensor(rows=4):
    lines = ['"FILENAME:","walk.xsn"', '"Units:","kPa"', '"Sensel Width (cm):","0.5"',
             '"Sensel Height (cm):","0.5"']  # fmt: skip
    for frame in range(30):
        lines += ["", f'"Frame:","{frame + 1}"', f'"Time:","10:00:{frame / 50:06.3f}"',
                  '"Sensor:","Left"', f'"Rows:","{rows}"', '"Columns:","3"']  # fmt: skip
        lines += [f'"{frame}","{2 * frame}","0"'] * 4
    return "\n".join(lines)


def test_xsensor(tmp_path):
    (tmp_path / "insole.csv").write_text(xsensor())
    trial = read_trial(tmp_path / "insole.csv")
    force = trial.channel("Left, force")
    assert force.rate == pytest.approx(50)
    assert force.values == pytest.approx(12e3 * np.arange(30) * 0.5e-2**2)
    assert trial.channel("Left, largest pressure").values.max() == 58e3
    (tmp_path / "cut.csv").write_text(xsensor(rows=5))
    with pytest.raises(DataError, match="truncated: a frame of Left has 4 of 5 rows"):
        read_trial(tmp_path / "cut.csv")


def test_tdms(tmp_path):
    nptdms = pytest.importorskip("nptdms")
    path = tmp_path / "slide.tdms"
    properties = {"unit_string": "N", "wf_increment": 0.001}
    with nptdms.TdmsWriter(path) as writer:
        writer.write_segment([
            nptdms.ChannelObject("slide", name, values, properties=properties)
            for name, values in (("Fx", np.linspace(0, 90, 500)), ("Fy", np.zeros(500)),
                                 ("Fz", np.full(500, 500.0)))
        ])  # fmt: skip
    trial = read_trial(path, subtract_baseline=False)
    assert trial.source == "TDMS"
    assert trial.plates[0].rate == pytest.approx(1000)
    assert trial.plates[0].force[-1] == pytest.approx([90, 0, 500])
    path.write_bytes(path.read_bytes()[:100])
    with pytest.raises(DataError):
        read_trial(path)


def test_stm_603(tmp_path):
    lines = ["SATRA STM 603 slip resistance", "Test no,12", "Specimen,heel", ""]
    lines += ["Time (s),Vertical Force (N),Horizontal Force (N),COF"]
    lines += [f"{t:.3f},500,{60 + t:.3f},0.12" for t in TIME]
    (tmp_path / "slide.csv").write_text("\n".join(lines))
    trial = read_trial(tmp_path / "slide.csv", subtract_baseline=False)
    assert trial.source == "SATRA STM 603"
    assert trial.plates[0].force[0] == pytest.approx([60, 0, 500])
    assert any('friction is "Horizontal Force"' in note for note in trial.notes)
    (tmp_path / "odd.csv").write_text("\n".join(lines).replace("Horizontal Force", "A"))
    with pytest.raises(DataError, match="no column of vertical and of horizontal force"):
        read_trial(tmp_path / "odd.csv")


def bsf(samples=100, claimed=None):
    main = (
        struct.pack("<4i", 100, 0, 1, 0)
        + bytes(124)
        + struct.pack("<dd", 70, 1.8)
        + b"M"
        + bytes(3)
    )
    main += struct.pack("<i", 1) + struct.pack("<d", (claimed or samples) / 1000) + bytes(28)
    main += bytes(12) + struct.pack("<i", 1000) + bytes(752) + struct.pack("<i", 1)
    head = struct.pack("<3i", 0, 1, 1) + b"OR6".ljust(20) + struct.pack("<5i", 6, 0, 5, 0, 5)
    head += struct.pack("<5f", 18, 20, 0, 0, 0) + struct.pack("<32f", *[0.5] * 32)
    head += bytes(128) + bytes(76)
    head += struct.pack("<96f", *[4000.0] * 32, *[10.0] * 32, *[204.8] * 32) + bytes(20)
    head += bytes(128) + struct.pack("<iff", 1000, 0, 0)
    counts = np.tile(np.array([-5, 3, -100, 0, 0, 0], "<i2"), (samples, 1))
    return main + head + counts.tobytes()


def test_amti_bsf(tmp_path):
    (tmp_path / "trial.bsf").write_bytes(bsf())
    trial = read_trial(tmp_path / "trial.bsf", subtract_baseline=False)
    count = 1e6 / (0.5 * 4000 * 10 * 204.8) * 4.4482216152605  # N
    assert trial.plates[0].rate == 1000
    assert trial.plates[0].force[0] == pytest.approx([5 * count, -3 * count, 100 * count])
    (tmp_path / "cut.bsf").write_bytes(bsf(samples=60, claimed=100))
    with pytest.raises(DataError, match="truncated"):
        read_trial(tmp_path / "cut.bsf")


@pytest.mark.parametrize("last", [[1.0, 2.0], [1.0, 2.0, "none"], 7.0, {"x": 1.0}])
def test_json_with_a_damaged_point_names_it(tmp_path, last):
    path = tmp_path / "points.json"
    path.write_text(json.dumps({"fps": 100, "markers": {"LHeel": [[0.0, 0.1, 0.2]] * 20 + [last]}}))
    with pytest.raises(DataError, match="LHeel has no three coordinates a frame"):
        read_trial(path)


def test_json_of_gait_events(tmp_path):
    (tmp_path / "e.json").write_text(json.dumps(
        {"fps": 100, "events": [{"frame": 40, "event": "HS", "side": "L"},
                                {"time": 1.1, "event": "toe_off", "foot": "left"}]}
    ))  # fmt: skip
    events = read_trial(tmp_path / "e.json").events
    assert [(e.name, e.side, e.time) for e in events] == [
        ("heel contact", "left", 0.4), ("toe off", "left", 1.1)]  # fmt: skip
    (tmp_path / "b.json").write_text(json.dumps({"events": [{"frame": 40, "event": "HS"}]}))
    with pytest.raises(DataError, match="event 1 has no time"):
        read_trial(tmp_path / "b.json")


def c3d_with_rotations(path, points=True):
    """Write points and rotations; without points the header says that there are none."""
    file = ezc3d.c3d()
    file["parameters"]["POINT"]["RATE"]["value"] = [100.0]
    file["parameters"]["POINT"]["UNITS"]["value"] = ["m"]
    file["parameters"]["POINT"]["LABELS"]["value"] = ["LHEE"]
    file["data"]["points"] = np.vstack((HEEL.T, np.ones(200)))[:, None]
    poses = np.tile(np.eye(4)[:, :, None, None], (1, 1, 2, 200))
    poses[:3, 3, 1] = HEEL.T + 1
    file.add_parameter("ROTATION", "LABELS", ["pelvis_4X4", "l_foot_4X4"])
    file.add_parameter("ROTATION", "RATIO", [1])
    file["data"]["rotations"] = poses
    file.write(str(path))
    if not points:
        data = path.read_bytes()
        path.write_bytes(data[:2] + bytes(2) + data[4:])


@pytest.mark.parametrize("points", [True, False])
def test_rotations_as_theia_writes_them(tmp_path, points):
    c3d_with_rotations(tmp_path / "theia.c3d", points)
    trial = read_trial(tmp_path / "theia.c3d")
    foot = trial.markers["l_foot"]
    assert foot.rate == 100
    assert foot.positions == pytest.approx(HEEL + 1, abs=1e-5)
    whole = (tmp_path / "theia.c3d").read_bytes()
    (tmp_path / "cut.c3d").write_bytes(whole[: len(whole) - 2048])
    with pytest.raises(DataError, match="truncated"):
        read_trial(tmp_path / "cut.c3d")


def test_a_parameter_section_longer_than_it_says(tmp_path):
    c3d_with_rotations(tmp_path / "good.c3d")
    data = bytearray((tmp_path / "good.c3d").read_bytes())
    start = (data[0] - 1) * 512
    assert data[start + 2] > 1
    data[start + 2] = 1
    (tmp_path / "short.c3d").write_bytes(data)
    good, short = read_trial(tmp_path / "good.c3d"), read_trial(tmp_path / "short.c3d")
    assert list(short.markers) == list(good.markers)


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("x.tdf", b"\x82K`A" + bytes(50), "BTS TDF is not read"),
        ("x.csv", b"GAITRite export\n" + b"1,2\n" * 20, "GAITRite is not read"),
        ("x.n3d", bytes(100), "NDI N3D is not read"),
        ("notes.txt", b"Lab of X\nModel Y\nSerial 9\nOperator Z\n\nt\ta\tb\n" + b"0.1\t2\t3\n" * 9,
         "unknown system: 4 lines stand above the table"),
        ("near.csv", b"No_of_Frame 9\nMade by X\nRoom Y\n\nt,a,b\n" + b"0.1,2,3\n" * 9, "Qualisys"),
    ],
)  # fmt: skip
def test_what_is_known_and_not_read_and_what_nobody_knows(tmp_path, name, content, words):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(DataError, match=words):
        read_trials(tmp_path / name)


def test_every_reader_can_be_imported():
    assert len(READERS) > 20
    for one in READERS:
        if one.address:
            module, _, name = one.address.partition(":")
            assert callable(getattr(import_module(module), name))
