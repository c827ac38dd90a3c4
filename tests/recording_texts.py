"""Short exports of many systems as text, and what was read from a file, in a few lines."""

import csv
import io
import json
import struct
from pathlib import Path
from typing import Any

import numpy as np

from underfoot.core import UnderfootError
from underfoot.trials import Trial, read_trials
from underfoot.trials.readers import TrialsProfile

TIME = np.arange(60) / 100.0
HEEL = np.column_stack((0.7 * TIME, 0.05 + 0.02 * np.sin(9 * TIME), 0.1 + 0.04 * np.cos(7 * TIME)))
TOE = HEEL + np.array([0.2, 0.01, -0.03])
LOAD = 650.0 * np.clip(np.minimum(TIME - 0.1, 0.5 - TIME) / 0.1, 0, 1)
FORCE = np.column_stack((-0.2 * LOAD * np.cos(6 * TIME), 0.03 * LOAD, LOAD))


def _rows(sign: str, *columns: np.ndarray, form: str = ".3f") -> list[str]:
    return [sign.join(f"{value:{form}}" for value in row) for row in np.column_stack(columns)]


def trc() -> str:
    lines = [
        "PathFileType\t4\t(X/Y/Z)\ta.trc",
        "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate",
        "100\t100\t60\t2\tmm\t100",
        "Frame#\tTime\tLHEE\t\t\tLTOE\t\t",
        "\t\tX1\tY1\tZ1\tX2\tY2\tZ2",
        "",
    ]
    return "\n".join([*lines, *_rows("\t", np.arange(60) + 1, TIME, 1e3 * HEEL, 1e3 * TOE)])


def mot() -> str:
    lines = ["forces", "version=1", "nRows=60", "nColumns=8", "inDegrees=no", "endheader"]
    heads = "time ground_force_vx ground_force_vy ground_force_vz ground_force_px ground_force_py"
    lines.append("\t".join([*heads.split(), "ground_force_pz", "knee_angle"]))
    turned = FORCE[:, [0, 2, 1]]
    return "\n".join([*lines, *_rows("\t", TIME, turned, 100 * HEEL, 30 * TIME)])


def sto() -> str:
    lines = ["DataRate=100", "DataType=Vec3", "Units=mm", "endheader", "time\tf1\tp1\tLHEE"]
    for t, f, p, q in zip(TIME, FORCE, HEEL, TOE, strict=True):
        cells = (",".join(f"{v:.3f}" for v in one) for one in (f, p, 1e3 * q))
        lines.append("\t".join([f"{t:.3f}", *cells]))
    return "\n".join(lines)


def cortex() -> str:
    lines = ["[Force Data]", "NumberOfForcePlates=1", "SampleRate=100.0", "NumberOfSamples=60"]
    lines.append("#Sample\tFX1\tFY1\tFZ1\tX1\tY1\tZ1\tMZ1")
    return "\n".join([*lines, *_rows("\t", np.arange(60) + 1, FORCE, 1e3 * HEEL, 0.1 * LOAD)])


def bioware() -> str:
    lines = ["BioWare export", "Sampling rate (Hz):\t100", ""]
    lines.append("abs time (s)\tFx\tFy\tFz\t|Ft|\tAx\tAy\tFx\tFy\tFz")
    lines.append("s\tN\tN\tN\tN\tm\tm\tN\tN\tN")
    return "\n".join([*lines, *_rows("\t", TIME, FORCE, LOAD, HEEL[:, :2], 0.5 * FORCE)])


def qualisys_markers() -> str:
    lines = [
        "NO_OF_FRAMES\t60",
        "NO_OF_MARKERS\t2",
        "FREQUENCY\t100",
        "MARKER_NAMES\tLHEE\tLTOE",
        "Frame\tTime\tLHEE X\tLHEE Y\tLHEE Z\tLTOE X\tLTOE Y\tLTOE Z",
    ]
    return "\n".join([*lines, *_rows("\t", np.arange(60) + 1, TIME, 1e3 * HEEL, 1e3 * TOE)])


def qualisys_forces() -> str:
    lines = ["NO_OF_SAMPLES\t60", "FREQUENCY\t100", "FORCE_PLATE_NAME\tleft one"]
    for name, place in zip(
        ("POSX_POSY", "NEGX_POSY", "NEGX_NEGY", "POSX_NEGY"),
        ((600, 400), (0, 400), (0, 0), (600, 0)),
        strict=True,
    ):
        lines += [
            f"FORCE_PLATE_CORNER_{name}_{a}\t{v}" for a, v in zip("XYZ", (*place, 0), strict=True)
        ]
    lines.append("Force_X\tForce_Y\tForce_Z\tMoment_X\tCOP_X\tCOP_Y\tCOP_Z")
    return "\n".join([*lines, *_rows("\t", FORCE, LOAD, 1e3 * HEEL)])


def vicon() -> str:
    lines = [
        "Devices",
        "100",
        ",,AMTI #1 - Force,,,AMTI #1 - CoP,,,Sync",
        "Frame,Sub Frame,Fx,Fy,Fz,Cx,Cy,Cz,Pulse",
        ",,N,N,N,mm,mm,mm,V",
    ]
    lines += _rows(",", np.arange(60) + 1, 0 * TIME, -FORCE, 1e3 * HEEL, TIME)
    lines += ["", "Model Outputs", "100", ",,Angle", "Frame,Sub Frame,X", ",,deg"]
    lines += _rows(",", np.arange(60) + 1, 0 * TIME, TIME)
    lines += ["", "Trajectories", "100", ",,Anna:LHEE,,,Anna:LTOE,,", "Frame,Sub Frame,X,Y,Z,X,Y,Z"]
    lines += [",,mm,mm,mm,mm,mm,mm"]
    return "\n".join([*lines, *_rows(",", np.arange(60) + 1, 0 * TIME, 1e3 * HEEL, 1e3 * TOE)])


def dflow() -> str:
    lines = [
        "TimeStamp\tFrameNumber\tLHEE.PosX\tLHEE.PosY\tLHEE.PosZ\tFP1.CopX\tFP1.CopY\tFP1.CopZ"
        "\tFP1.ForX\tFP1.ForY\tFP1.ForZ\tFP1.MomX\tlevel"
    ]
    turned = [0, 2, 1]
    columns = (HEEL[:, turned], HEEL[:, turned], FORCE[:, turned], TIME, TIME)
    return "\n".join([*lines, *_rows("\t", TIME, np.arange(60) + 5, *columns, form=".6f")])


def motive() -> str:
    kinds = ["Marker"] * 3 + ["Rigid Body"] * 7
    names = ["Anna:LHEE"] * 3 + ["Left Shoe"] * 7
    what = ["Position"] * 3 + ["Rotation"] * 4 + ["Position"] * 3
    lines = [
        "Format Version,1.23,Take Name,w 1,Capture Frame Rate,100.0,Total Exported Frames,60,"
        "Length Units,Millimeters",
        "",
        ",Type," + ",".join(kinds),
        ",Name," + ",".join(names),
        ",ID," + ",".join(["A1"] * 10),
        ",," + ",".join(what),
        "Frame,Time (Seconds),X,Y,Z,X,Y,Z,W,X,Y,Z",
    ]
    pose = np.tile([0.0, 0.0, 0.0, 1.0], (60, 1))
    return "\n".join([*lines, *_rows(",", np.arange(60), TIME, 1e3 * HEEL, pose, 1e3 * TOE)])


def bts() -> str:
    head = "BTS ASCII format\n\nType:         \tPoint 3D tracks\nMeasure unit: \tmm\n\n"
    head += "Tracks:       \t1\nFrequency:    \t100 Hz\nFrames:       \t60\n\n"
    head += " Frame\t  Time\tl heel.X\tl heel.Y\tl heel.Z\t\n"
    return head + "\n".join(_rows("\t", np.arange(60) + 1, TIME, 1e3 * HEEL[:, [0, 2, 1]]))


def bts_events() -> str:
    text = "BTS ASCII format\n\nType:\tEvent Sequences\nMeasure unit:\ts\n\n"
    return text + "Item\teRHS\teRTO\teLHS\n1\t0.40\t1.00\t0.90\n2\t1.50\t\t2.00\n"


def mvnx() -> str:
    q = f"{np.sqrt(0.5)} 0 0 {np.sqrt(0.5)}"
    frames = "".join(
        f'<frame time="{10 * i}" type="{kind}"><orientation>1 0 0 0 {q}</orientation>'
        f"<position>0 0.1 1 {0.01 * i:.2f} 0.2 {0.1 + 0.002 * (i % 7):.3f}</position></frame>\n"
        for i, kind in enumerate(["identity", "tpose"] + ["normal"] * 30)
    )
    return (
        '<?xml version="1.0"?>\n<mvnx version="4" xmlns="http://www.xsens.com/mvn/mvnx">\n'
        '<subject label="A" frameRate="100" segmentCount="2">\n<segments>\n'
        '<segment label="Pelvis" id="1"/>\n<segment label="RightFoot" id="2"><points>\n'
        '<point label="pHeelFoot"><pos_b>0.1 0.02 -0.05</pos_b></point>\n'
        '<point label="pToe"></point>\n</points></segment>\n'
        f"</segments>\n<frames>\n{frames}</frames>\n</subject>\n</mvnx>"
    )


def xsensor() -> str:
    lines = [
        '"FILENAME:","walk.xsn"',
        '"Units:","kPa"',
        '"Sensel Width (cm):","0.5"',
        '"Sensel Height (cm):","0.8"',
    ]
    for frame in range(12):
        lines += [
            "",
            f'"Frame:","{frame + 1}"',
            f'"Time:","10:01:{frame / 50:06.3f}"',
            f'"Sensor:","{("Left", "Right")[frame % 2]}"',
            '"Rows:","2"',
            '"Columns:","3"',
            f'"{frame}","{2 * frame}","0"',
            f'"1","{frame}","3"',
        ]
    return "\n".join(lines)


def satra() -> str:
    lines = ["SATRA STM 603 slip resistance", "Test no,12", "Specimen,heel", ""]
    lines += ["Time (s),Vertical Force (N),Horizontal Force (N),COF"]
    return "\n".join([*lines, *_rows(",", TIME, LOAD, 0.12 * LOAD + 1, 0.12 + 0 * TIME)])


def cetr() -> str:
    lines = [
        "Created by CETR Data Viewer ver.2.19",
        "Total number of runs - 1",
        "Total number of steps = 2",
        "Run date 12 May 2022",
        "",
    ]
    for step in (1, 2):
        lines += [
            f"Step No. {step}",
            "",
            "Radius       = 3.9",
            "Velocity     = 240",
            "Data Count   = 20",
            "Started at: 12:21:58",
            "",
            "Fx,Fz,Z,V1,T,Ff,COF",
            "g,g,mm,mm/sec,sec,g,",
            "",
        ]
        at = np.arange(20.0)
        lines += _rows(
            ",", 7 + at * step, -200 + at, -0.69 + 0 * at, at, 0.02 * at, 7 + at, 0.04 + 0.001 * at
        )
        lines += [""]
    return "\n".join(lines)


def pcs() -> str:
    heads = [
        "Rolling Speed (mm/s)",
        "Film (nm)",
        "",
        "Step Time (s)",
        "Lube Temp (°C)",
        "Ball Load (N)",
        "Ball Speed 1",
        "Rolling Speed (mm/s)",
        "SRR (%)",
        "Comments",
        "Mu (-)",
    ]
    lines = [
        "MTM2 Test Data File",
        "Profile description:\tprofile one",
        "Lubricant name:\t",
        "Number of steps in profile:\t3",
        "Number of steps completed:\t3",
        "",
        'Step 1 "zero" started at 28/02/2017',
        "Step type\tZERO",
        "Ball load = 19.9 N",
        "",
    ]
    for step in (2, 3):
        lines += [f'Step {step} "film" started at 28/02/2017', "Step type\tFILM", "\t".join(heads)]
        for i in range(12):
            cells = [
                20 + 5 * i,
                24 + i * step,
                "",
                10 + 2 * i,
                40.4,
                20.02,
                20.2 + 5 * i,
                20 + 5 * i,
                50,
                "ok",
                0.05 + 0.001 * i,
            ]
            lines.append("\t".join(map(str, cells)))
        lines.append("")
    return "\n".join(lines)


def pedar() -> str:
    lines = [
        "file name:\tanna.sol",
        "pressure values in n/cm2",
        "",
        "time[secs]\t" + "\t".join(str(i) for i in range(1, 100)),
    ]
    for t, load in zip(TIME[:20], LOAD[10:30], strict=True):
        lines.append("\t".join([f"{t:.3f}", *[f"{load / 100:.2f}"] * 98, "5.0"]))
    return "\n".join(lines)


def fscan() -> str:
    lines = [
        "DATA_TYPE MOVIE",
        "ROWS 3",
        "COLS 2",
        "ROW_SPACING 5.08 mm",
        "COL_SPACING 4 mm",
        "SECONDS_PER_FRAME 0.01",
        "UNITS KPA",
        "ASCII_DATA @@",
        "",
    ]
    for i in range(6):
        lines += [f"Frame {i + 1}", "0,2,", f"1,{10 * i},", "0,B,", ""]
    return "\n".join(lines)


def pose() -> str:
    points = {"LHeel": HEEL.round(4).tolist(), "LBigToe": TOE.round(4).tolist()}
    return json.dumps({"fps": 100, "unit": "m", "markers": points}, indent=0)


def open_pose() -> str:
    frames = []
    for t, p, q in zip(TIME, HEEL, TOE, strict=True):
        flat = [0.0] * 100
        flat[84:88] = [*p.round(4).tolist(), 0.9]
        flat[76:80] = [*q.round(4).tolist(), 0.9 * (t != 0.2)]
        frames.append({"time": round(float(t), 3), "people": [{"pose_keypoints_3d": flat}]})
    frames[7]["people"] = []
    return json.dumps({"frames": frames, "unit": "m"})


def events() -> str:
    listed = [
        {"frame": 40, "event": "HS", "side": "L"},
        {"time": 1.1, "event": "toe_off", "foot": "left"},
        {"time_s": 0.9, "name": "stamp"},
    ]
    return json.dumps({"fps": 100, "events": listed, "heel_strikes": [0.2, {"time": 2}]}, indent=0)


def table() -> str:
    lines = ["Hall 2;Anna", "Time (ms);Fx (N);Fy (N);Fz (N);Cx (mm);Cy (mm);heel_x;heel_y;heel_z;p"]
    lines += [";;;;;;m;m;m;kPa"][:0]
    columns = (1e3 * TIME, FORCE, 1e3 * HEEL[:, :2], HEEL, LOAD)
    return "\n".join([*lines, *(row.replace(".", ",") for row in _rows(";", *columns))])


def bsf(samples: int = 50, claimed: int = 50) -> bytes:
    main = struct.pack("<4i", 100, 0, 1, 0) + bytes(124) + struct.pack("<dd", 70, 1.8) + b"M\0\0\0"
    main += struct.pack("<i", 1) + struct.pack("<d", claimed / 1000) + bytes(28)
    main += bytes(12) + struct.pack("<i", 1000) + bytes(752) + struct.pack("<i", 1)
    head = struct.pack("<3i", 0, 1, 1) + b"OR6".ljust(20) + struct.pack("<5i", 6, 0, 5, 0, 5)
    head += struct.pack("<5f", 18, 20, 0, 0, 0) + struct.pack("<32f", *[0.5, 0.4] * 16)
    head += bytes(128) + bytes(76)
    head += struct.pack("<96f", *[4000.0, 3000] * 16, *[10.0] * 32, *[204.8] * 32) + bytes(20)
    head += bytes(128) + struct.pack("<iff", 1000, 0, 0)
    counts = np.array([[-5 - i, 3, -100 * i, i, 2 * i, -i] for i in range(samples)], "<i2")
    return main + head + counts.tobytes()


TEXTS = {
    "a.trc": trc,
    "a.mot": mot,
    "b.sto": sto,
    "a.forces": cortex,
    "walk.txt": bioware,
    "q.tsv": qualisys_markers,
    "q_f_1.tsv": qualisys_forces,
    "v.csv": vicon,
    "d.txt": dflow,
    "take.csv": motive,
    "p.emt": bts,
    "e.emt": bts_events,
    "w.mvnx": mvnx,
    "x.csv": xsensor,
    "s.csv": satra,
    "c.csv": cetr,
    "pcs.txt": pcs,
    "p.asc": pedar,
    "f.asf": fscan,
    "m.json": pose,
    "o.json": open_pose,
    "e.json": events,
    "t.csv": table,
}


def read_lines(folder: Path, name: str, data: str | bytes, **options: Any) -> dict[str, str]:
    """Return what is read from a file of these bytes, or why it is refused, in a few lines."""
    path = folder / name
    path.write_bytes(data if isinstance(data, bytes) else data.encode())
    try:
        trials = read_trials(path, **options)
    except UnderfootError as error:
        return {"refused": f"{type(error).__name__}: {error}".replace("\n", " | ")}
    return {
        f"{key}{n or ''}": line
        for n, trial in enumerate(trials)
        for key, line in trial_lines(trial).items()
    }


def trial_lines(trial: Trial) -> dict[str, str]:
    """Return what stands in a trial, a line each channel, plate, marker and note."""
    lines = {"source": trial.source + (f", {trial.name}" if "," in trial.name else "")}
    for name, one in list(trial.channels.items())[:12]:
        text = f"{_series(one.values)} {one.unit} at {_clock(one)}; {one.note}"
        lines[f"channel {name}"] = text
    if len(trial.channels) > 12:
        last = list(trial.channels)[-1]
        lines["channels"] = f"{len(trial.channels)}, {last} {_series(trial.channels[last].values)}"
    for one in trial.plates:
        parts = [_series(one.force[:, i]) for i in range(3)] if one.force.size else []
        said = [str(part) for part in (one.kind, one.problem, *one.flags, *one.notes) if part]
        text = f"{'' if one.usable else 'unusable '}{parts} at {_clock(one)}; {said}"
        if one.centre_of_pressure is not None:
            text += f"; at {[_series(one.centre_of_pressure[:, i]) for i in range(3)]}"
        if one.corners is not None:
            text += f"; corners {np.round(one.corners, 4).tolist()}"
        if not one.accuracy.source.startswith("assumed"):
            text += f"; {one.accuracy}"
        lines[f"plate {one.name}"] = text
    for name, one in list(trial.markers.items())[:12]:
        parts = [_series(one.positions[:, i]) for i in range(3)]
        lines[f"marker {name}"] = f"{parts} at {_clock(one)}; {one.note}"
    for n, event in enumerate(trial.events):
        lines[f"event {n}"] = f"{event.name} {event.side} {event.time:.4g} {event.source}"
    lines |= {f"note {n}": str(note).replace("\n", " | ") for n, note in enumerate(trial.notes)}
    lines |= {f"setting {key}": str(value) for key, value in trial.settings.items()}
    lines["vertical"] = str(trial.vertical)
    return lines


def _clock(one: Any) -> str:
    uneven = getattr(one, "times", None)
    times = "" if uneven is None else f", uneven {len(uneven)}"
    return f"{one.rate:.5g} Hz from {one.start:.4g} s{times}"


def _series(values: np.ndarray) -> str:
    """How many are finite, the first, the mean and the weight behind of a row of numbers."""
    seen = np.isfinite(values)
    if not seen.any():
        return f"0 of {len(values)}"
    kept = values[seen]
    numbers = (kept[0], kept.mean(), kept @ (1.0 + np.flatnonzero(seen)) / len(values))
    texts = " ".join(f"{0.0 if abs(v) < 1e-9 else v:.5g}" for v in numbers)
    return f"{seen.sum()} of {len(values)}: {texts}"


def changes(before: dict[str, str], after: dict[str, str], most: int = 5) -> str:
    """Return what differs between two readings, in one line."""
    if "refused" in after:
        return after["refused"]
    parts = [f"{key}: {after[key]}" for key in after if before.get(key) != after[key]]
    parts += [f"without {key}" for key in before if key not in after]
    more = f" and {len(parts) - most} more" if len(parts) > most else ""
    return " // ".join(parts[:most]) + more if parts else "the same"


def workbook(sheets: dict[str, list[list[Any]]]) -> bytes:
    """Return sheets of cells as a workbook."""
    from openpyxl import Workbook

    book = Workbook()
    book.remove(book.active)
    for name, rows in sheets.items():
        sheet = book.create_sheet(name)
        for row in rows:
            sheet.append(row)
    out = io.BytesIO()
    book.save(out)
    return out.getvalue()


def cells(text: str, sign: str) -> list[list[Any]]:
    """Return a text's cells, numbers as numbers."""
    return [
        [float(cell) if cell.replace(".", "").lstrip("-").isdigit() else cell for cell in row]
        for row in csv.reader(text.splitlines(), delimiter=sign)
    ]


def plain(**given: Any) -> TrialsProfile:
    """Return a profile with these parts."""
    return TrialsProfile(**given)
