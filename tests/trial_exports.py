"""Small exports of many systems, written from the same made-up step."""

import io
import json

import numpy as np

RATE = 500.0
TIME = np.arange(600) / RATE
LOAD = 700.0 * np.clip(np.minimum(TIME - 0.2, 0.9 - TIME) / 0.05, 0, 1)
FORCE = np.column_stack((-0.2 * LOAD * np.sin(2 * np.pi * (TIME - 0.2) / 0.7), 0 * LOAD, LOAD))
HEEL = np.column_stack((0.5 * TIME, 0 * TIME + 0.1, 0.02 + 0.05 * np.abs(np.cos(3 * TIME))))


def qualisys_markers() -> bytes:
    lines = [
        "NO_OF_FRAMES\t600", "NO_OF_CAMERAS\t8", "NO_OF_MARKERS\t2", "FREQUENCY\t500",
        "NO_OF_ANALOG\t0", "ANALOG_FREQUENCY\t0", "DESCRIPTION\t--",
        "TIME_STAMP\t2026-01-01, 10:00:00.000", "DATA_INCLUDED\t3D", "MARKER_NAMES\tLHEE\tRHEE",
        "Frame\tTime\tLHEE X\tLHEE Y\tLHEE Z\tRHEE X\tRHEE Y\tRHEE Z",
    ]  # fmt: skip
    for i, (t, p) in enumerate(zip(TIME, 1e3 * HEEL, strict=True)):
        lines.append(f"{i + 1}\t{t:.5f}\t" + "\t".join(f"{v:.3f}" for v in (*p, *(p + 50))))
    return "\r\n".join(lines).encode()


def qualisys_forces() -> bytes:
    lines = ["NO_OF_SAMPLES\t600", "FREQUENCY\t500", "DATA_INCLUDED\tForce", "FORCE_PLATE_NAME\t1"]
    for name, (x, y) in zip(
        ("POSX_POSY", "NEGX_POSY", "NEGX_NEGY", "POSX_NEGY"),
        ((600, 400), (0, 400), (0, 0), (600, 0)),
        strict=True,
    ):
        lines += [
            f"FORCE_PLATE_CORNER_{name}_{a}\t{v}" for a, v in zip("XYZ", (x, y, 0), strict=True)
        ]
    lines.append("Force_X\tForce_Y\tForce_Z\tMoment_X\tMoment_Y\tMoment_Z\tCOP_X\tCOP_Y\tCOP_Z")
    lines += ["\t".join(f"{v:.3f}" for v in (*f, 0, 0, 0, 300, 200, 0)) for f in FORCE]
    return "\n".join(lines).encode()


def vicon() -> bytes:
    lines = [
        "Devices", "500", ",,AMTI #1 - Force,,,AMTI #1 - CoP,,",
        "Frame,Sub Frame,Fx,Fy,Fz,Cx,Cy,Cz", ",,N,N,N,mm,mm,mm",
    ]  # fmt: skip
    # Nexus gives the force on the plate.
    lines += [f"{i // 5 + 1},{i % 5}," + ",".join(f"{v:.3f}" for v in (*-f, 300, 200, 0))
              for i, f in enumerate(FORCE)]  # fmt: skip
    lines += ["", "Trajectories", "100", ",,Anna:LHEE,,,Anna:RHEE,,", "Frame,Sub Frame,X,Y,Z,X,Y,Z",
              ",,mm,mm,mm,mm,mm,mm"]  # fmt: skip
    lines += [f"{i + 1},0," + ",".join(f"{v:.3f}" for v in (*p, *(p + 50)))
              for i, p in enumerate(1e3 * HEEL[::5])]  # fmt: skip
    return "\r\n".join(lines).encode()


def matlab_arrays() -> bytes:
    from scipy.io import savemat

    out = io.BytesIO()
    savemat(out, {"time": TIME, "Force1": FORCE, "LHEE": 1e3 * HEEL, "subject": "Anna"})
    return out.getvalue()


def matlab_qualisys() -> bytes:
    from scipy.io import savemat

    data = np.concatenate((1e3 * HEEL.T, np.zeros((1, len(TIME)))))[None]
    corners = 1e3 * np.array([[0.6, 0.4, 0], [0, 0.4, 0], [0, 0, 0], [0.6, 0, 0]])
    labelled = {"Count": 1, "Labels": np.array(["LHEE"], dtype=object), "Data": data}
    force = {
        "ForcePlateName": "one", "Frequency": RATE, "Force": FORCE.T, "ForcePlateLocation": corners,
        "COP": np.tile([[300.0], [200.0], [0.0]], len(TIME)),
    }  # fmt: skip
    measured = {"FrameRate": RATE, "Trajectories": {"Labeled": labelled}, "Force": force}
    out = io.BytesIO()
    savemat(out, {"walk1": measured})
    return out.getvalue()


def matlab_73() -> bytes:
    import h5py

    out = io.BytesIO()
    with h5py.File(out, "w", userblock_size=512) as file:
        file["time"] = TIME[None]
        file["grf"] = FORCE.T
        file["fs"] = np.array([[RATE]])
    data = bytearray(out.getvalue())
    data[:19] = b"MATLAB 7.3 MAT-file"
    return bytes(data)


def json_paths() -> bytes:
    points = {"LHeel": HEEL.tolist(), "RHeel": (HEEL + 0.05).tolist()}
    return json.dumps({"fps": RATE, "unit": "m", "markers": points}).encode()


def json_open_pose() -> bytes:
    frames = []
    for t, p in zip(TIME, HEEL, strict=True):
        flat = [0.0] * 100
        flat[84:88] = [*p.tolist(), 0.9]
        frames.append({"time": float(t), "people": [{"pose_keypoints_3d": flat}]})
    frames[7]["people"] = []
    return json.dumps({"frames": frames, "unit": "m"}).encode()


def pedar() -> bytes:
    lines = [
        "file name:\tanna.sol", "sensor type:\tpedar insole", "comment:",
        "total time [secs]:\t1.2\ttime per frame [secs]:\t0.002", "pressure values in kPa", "",
        "time[secs]\t" + "\t".join(str(i) for i in range(1, 199)),
    ]  # fmt: skip
    for t, load in zip(TIME, LOAD, strict=True):
        cells = [f"{load / 10:.1f}"] * 99 + ["0.0"] * 98 + ["5.0"]
        lines.append("\t".join([f"{t:.3f}", *cells]))
    return "\n".join(lines).encode()


def fscan() -> bytes:
    lines = [
        "DATA_TYPE MOVIE", "VERSION ASCII", "ROWS 4", "COLS 3", "ROW_SPACING 5.08 mm",
        "COL_SPACING 5.08 mm", "SECONDS_PER_FRAME 0.01", "START_FRAME 1", "END_FRAME 20",
        "UNITS KPA", "ASCII_DATA @@", "",
    ]  # fmt: skip
    for i in range(20):
        lines += [f"Frame {i + 1}", "0,0,0,", f"0,{10 * i},0,", "0,0,B,", "0,0,0,", ""]
    return "\n".join(lines).encode()


# File name and its bytes.
EXPORTS = {
    "walk.tsv": qualisys_markers,
    "walk_f_1.tsv": qualisys_forces,
    "walk.csv": vicon,
    "arrays.mat": matlab_arrays,
    "qtm.mat": matlab_qualisys,
    "new.mat": matlab_73,
    "pose.json": json_paths,
    "open.json": json_open_pose,
    "anna.asc": pedar,
    "anna.asf": fscan,
}
