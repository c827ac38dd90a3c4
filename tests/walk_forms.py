"""One walk of two steps in the forms in which laboratories and programs write it."""

from __future__ import annotations

import struct
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np

from underfoot.trials import Trial, read_trial
from underfoot.trials.readers.c3d_writer import c3d_bytes
from underfoot.trials.recording.plates import plate_axes

RCOF = {"plate 1": 0.192, "plate 2": 0.172}
"""Required friction of the two steps; by own code from the bytes of the recording."""
SHORT = Path(__file__).parent / "data" / "recordings" / "hdr_short.c3d"
"""The walk; its header counts 100 frames, POINT:FRAMES and the data 195."""
_FT, _IN, _LB, _KP = 0.3048, 0.0254, 4.4482216152605, 9.80665


@cache
def walk() -> Trial:
    """Return the walk, in laboratory axes: walking along +y, z up."""
    return read_trial(SHORT)


def turned(axes: str) -> np.ndarray:
    """Matrix to other laboratory axes: where x, y, z of the walk go, as "+x +z -y"."""
    rows = np.zeros((3, 3))
    for i, axis in enumerate(axes.split()):
        rows["xyz".index(axis[1]), i] = -1.0 if axis[0] == "-" else 1.0
    return rows


def _c3d(
    force: tuple[str, float],
    moment: tuple[str, float],
    more: int = 0,
    axes: str = "+x +y +z",
    **given: int,
) -> bytes:
    """The walk as C3D: unit words of force and moment with what one of them is in SI."""
    trial, turn = walk(), turned(axes)
    markers = {name: m.positions @ turn.T for name, m in trial.markers.items()}
    for i in range(more):  # corners of plates, a frame
        markers[f"FIX_{i}"] = np.tile([0.1 * (i % 20), 0.1 * (i // 20), 0.0], (195, 1))
    analog: dict[str, tuple[np.ndarray, str]] = {}
    plates = []
    for number, plate in enumerate(trial.plates, start=1):
        names = [f"{letter}{number}" for letter in ("Fx", "Fy", "Fz", "Mx", "My", "Mz")]
        axes = plate_axes(plate.corners)
        values = np.hstack((plate.force @ axes / force[1], plate.moment @ axes / moment[1]))
        for i, name in enumerate(names):
            analog[name] = (values[:, i], (force, moment)[i // 3][0])
        plates.append((plate.corners @ turn.T, np.zeros(3), names))
    return c3d_bytes(markers, 100.0, analog, 1000.0, plates, mass=60.3, **given)


def _header(data: bytes, first: int, last: int) -> bytes:
    return data[:6] + struct.pack("<HH", first, last) + data[10:]


def _frames_as_float(data: bytes) -> bytes:
    """POINT:FRAMES of 2 bytes becomes a float of 4, in a file whose header counts too few."""
    at = data.index(b"FRAMES") + 6
    end = 512 + 512 * data[514]  # of the parameter section, which ends with zeros
    entry = struct.pack("<hbBfB", 9, 4, 0, 195.0, 0)
    return _header(data[:at] + entry + data[at + 7 : end - 2] + data[end:], 1, 100)


def mot(
    axes: str = "+z +x +y",
    names: tuple[str, str] = ("ground_force_", "1_ground_force_"),
    rows: int = 0,
    pandas: bool = False,
) -> str:
    """OpenSim's forces; by default y up, walking along +x. ``rows``: what nRows has too many."""
    turn = turned(axes)
    labels, columns = ["time"], [np.arange(1950) / 1000.0]
    for number, (plate, name) in enumerate(zip(walk().plates, names, strict=True)):
        place = np.nan_to_num(plate.centre_of_pressure)
        for kind, values in (("v", plate.force @ turn.T), ("p", place @ turn.T)):
            for i, axis in enumerate("xyz"):
                labels.append(name + kind + axis + (".1" if pandas and number else ""))
                columns.append(values[:, i])
    lines = ["walk", "version=1", f"nRows={1950 + rows}", f"nColumns={len(labels)}"]
    lines += ["inDegrees=yes", "endheader", "\t".join(labels)]
    lines += ["\t".join(f"{v:.6f}" for v in row) for row in np.column_stack(columns)]
    return "\n".join(lines) + "\n"


def vectors(names: Callable[[int], tuple[str, ...]], comma: str = ",", metres: float = 1.0) -> str:
    """OpenSim's forces, three numbers in a cell; ``names`` of the force and place of a plate."""
    cells = [f"{i / 1000.0:.3f}" for i in range(1950)]
    labels = ["time"]
    for number, plate in enumerate(walk().plates, start=1):
        labels += names(number)
        for part in (plate.force, np.nan_to_num(plate.centre_of_pressure) / metres):
            for i, values in enumerate(part):
                cells[i] += "\t" + comma.join(f"{v:.6f}" for v in values)
    head = ["DataRate=1000.000000", "DataType=Vec3", "version=3", "endheader", "\t".join(labels)]
    return "\n".join([*head, *cells]) + "\n"


def kinetics() -> str:
    """The forces as kineticstoolkit writes them through pandas: an index, vectors of four."""
    plates = walk().plates
    heads = [f'"FP{k}_{what}[:,{i}]"' for k in range(len(plates)) for what in ("Force", "COP")
             for i in range(4)]  # fmt: skip
    lines = [",".join(["", *heads])]
    columns = [part for plate in plates for part in (plate.force, plate.centre_of_pressure)]
    for i in range(len(plates[0].force)):
        cells = [f"{i / 1000:.3f}"]
        for last, values in zip((0.0, 1.0) * len(plates), columns, strict=True):
            cells += ["" if np.isnan(v) else f"{v:.7g}" for v in (*values[i], last)]
        lines.append(",".join(cells))
    return "\n".join(lines) + "\n"


def clocked(date: str = "", hour: int = 10) -> str:
    """The table with the time of day of each row; the second minute begins within."""
    lines = table().replace("Time (ms)", "Time").splitlines()
    for i in range(1, len(lines)):
        at = 58_500 + i
        stamp = f"{date}{hour % 24}:{15 + at // 60_000}:{at % 60_000 / 1000:06.3f}"
        lines[i] = stamp + lines[i][lines[i].index(",") :]
    return "\n".join(lines) + "\n"


def trc(
    unit: str = "mm",
    metres: float = 1e-3,
    axes: str = "+z +x +y",
    lost: str | None = None,
    frames: int = 0,
    digits: int = 4,
) -> str:
    """Markers; ``lost`` stands for RHEE's places in frames 21 to 39.

    "held" repeats the last one, "line" draws a straight line to the next.
    """
    turn = turned(axes)
    names = list(walk().markers)
    lines = [
        "PathFileType\t4\t(X/Y/Z)\ta.trc",
        "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\t"
        "OrigNumFrames",
        f"100\t100\t{195 + frames}\t{len(names)}\t{unit}\t100\t1\t{195 + frames}",
        "Frame#\tTime\t" + "\t\t\t".join(names) + "\t\t",
        "\t\t" + "\t".join(f"{a}{i}" for i in range(1, len(names) + 1) for a in "XYZ"),
    ]
    paths = {name: walk().markers[name].positions @ turn.T / metres for name in names}
    for i in range(195):
        cells = [str(i + 1), f"{i / 100:.3f}"]
        for name in names:
            gone = lost is not None and name == "RHEE" and 21 <= i < 40
            place = paths[name][i]
            if gone and lost == "held":
                place = paths[name][20]
            elif gone and lost == "line":
                place = paths[name][20] + (paths[name][40] - paths[name][20]) * (i - 20) / 20.0
            elif gone:
                cells += [str(lost)] * 3
                continue
            cells += [f"{v:.{digits}f}" for v in place]
        lines.append("\t".join(cells))
    return "\n".join(lines) + "\n"


def _grouped(value: float, sign: str, decimals: int, point: str = ".") -> str:
    text = f"{value:,.{decimals}f}"
    return text.replace(",", "\0").replace(".", point).replace("\0", sign)


def table(
    sign: str = "",
    separator: str = ",",
    point: str = ".",
    decimals: int = 2,
    unit: tuple[str, float] = ("N", 1.0),
    heads: Callable[[int, str], str] = lambda plate, axis: f"F{axis}{plate}",
    scale: float = 1.0,
    quoted: bool = False,
    above: tuple[str, ...] = (),
    below: tuple[str, ...] = (),
    units_row: bool = False,
) -> str:
    """Forces of both plates as columns, N times ``scale``; ``sign`` stands between thousands."""
    labels, columns = ["Time"], [np.arange(1950.0)]
    for number, plate in enumerate(walk().plates, start=1):
        for i, axis in enumerate("xyz"):
            labels.append(heads(number, axis))
            columns.append(scale * plate.force[:, i] / unit[1])
    units = ["ms", *[unit[0]] * 6]
    if not units_row:
        labels = [f"{label} ({one})" for label, one in zip(labels, units, strict=True)]
    lines = [*above, separator.join(labels)]
    lines += [separator.join(f"[{one}]" for one in units)] if units_row else []
    for row in np.column_stack(columns):
        cells = [f"{row[0]:.0f}", *(_grouped(v, sign, decimals, point) for v in row[1:])]
        lines.append(separator.join(f'"{cell}"' if quoted else cell for cell in cells))
    return "\n".join([*lines, *below]) + "\n"


def dflow(axes: str = "+z +x +y") -> str:
    """D-Flow's table at 1000 Hz, cameras at 100 Hz: every marker held for ten rows."""
    turn = turned(axes)
    names = list(walk().markers)
    labels = ["TimeStamp", "FrameNumber"]
    labels += [f"{name}.Pos{axis}" for name in names for axis in "XYZ"]
    kinds = ("Cop", "For", "Mom")
    labels += [f"FP{n}.{kind}{axis}" for n in (1, 2) for kind in kinds for axis in "XYZ"]
    rows = np.arange(1950)
    columns = [rows / 1000.0, rows]
    for name in names:
        columns += list((walk().markers[name].positions @ turn.T)[rows // 10].T)
    for plate in walk().plates:
        place = np.nan_to_num(plate.centre_of_pressure) @ turn.T
        for values in (place, plate.force @ turn.T, np.zeros((1950, 3))):
            columns += list(values.T)
    lines = ["\t".join(labels)]
    lines += ["\t".join(f"{v:.6f}" for v in row) for row in np.column_stack(columns)]
    return "\n".join(lines) + "\n"


def vicon(axes: str = "+x +y +z", unit: str = "mm", metres: float = 1e-3) -> str:
    """Nexus: devices and trajectories; the force on the plate."""
    turn = turned(axes)
    lines = ["Devices", "1000"]
    heads = ",".join(f"Plate{n} - {kind},," for n in (1, 2) for kind in ("Force", "CoP"))
    lines += [",," + heads, "Frame,Sub Frame," + ",".join(["Fx,Fy,Fz,Cx,Cy,Cz"] * 2)]
    lines += [",," + ",".join(["N,N,N,mm,mm,mm"] * 2)]
    values = np.hstack([
        part
        for plate in walk().plates
        for part in (-plate.force @ turn.T, 1e3 * np.nan_to_num(plate.centre_of_pressure) @ turn.T)
    ])  # fmt: skip
    lines += [
        f"{i // 10 + 1},{i % 10}," + ",".join(f"{v:.4f}" for v in row)
        for i, row in enumerate(values)
    ]
    names = list(walk().markers)
    lines += ["", "Trajectories", "100", ",," + ",".join(f"Anna:{name},," for name in names)]
    lines += ["Frame,Sub Frame," + ",".join(["X,Y,Z"] * len(names))]
    lines += [",," + ",".join([unit] * 3 * len(names))]
    paths = np.hstack([walk().markers[name].positions @ turn.T / metres for name in names])
    lines += [f"{i + 1},0," + ",".join(f"{v:.5f}" for v in row) for i, row in enumerate(paths)]
    return "\n".join(lines) + "\n"


def cortex(axes: str = "+x +y +z") -> str:
    """Cortex's forces on the foot."""
    turn = turned(axes)
    heads = [f"{name}{n}" for n in (1, 2) for name in ("FX", "FY", "FZ", "X", "Y", "Z", "MZ")]
    lines = ["[Force Data]", "NumberOfForcePlates=2", "SampleRate=1000.0", "NumberOfSamples=1950"]
    lines += ["#Sample\t" + "\t".join(heads)]
    columns = []
    for plate in walk().plates:
        place = 1e3 * np.nan_to_num(plate.centre_of_pressure) @ turn.T
        columns += [plate.force @ turn.T, place, np.zeros((1950, 1))]
    rows = np.hstack(columns)
    lines += [f"{i + 1}\t" + "\t".join(f"{v:.4f}" for v in row) for i, row in enumerate(rows)]
    return "\n".join(lines) + "\n"


def qtm(axes: str = "+x +y +z") -> bytes:
    """Qualisys' structure in a .mat file."""
    import io

    from scipy.io import savemat

    turn = turned(axes)
    names = list(walk().markers)
    data = np.stack([1e3 * (walk().markers[name].positions @ turn.T).T for name in names])
    labelled = {"Count": len(names), "Labels": np.array(names, dtype=object), "Data": data}
    forces = [
        {
            "ForcePlateName": f"{n}", "Frequency": 1000.0, "Force": (p.force @ turn.T).T,
            "ForcePlateLocation": 1e3 * p.corners @ turn.T,
            "COP": 1e3 * (np.nan_to_num(p.centre_of_pressure) @ turn.T).T,
        }
        for n, p in enumerate(walk().plates, start=1)
    ]  # fmt: skip
    out = io.BytesIO()
    savemat(out, {"walk": {"FrameRate": 100.0, "Trajectories": {"Labeled": labelled},
                           "Force": np.array(forces, dtype=object)}})  # fmt: skip
    return out.getvalue()


def united() -> str:
    """The table with the unit in each cell."""
    head, *rows = table().replace(" (N)", "").splitlines()
    cells = (row.split(",") for row in rows)
    return "\n".join([head, *(",".join([row[0], *(f"{c} N" for c in row[1:])]) for row in cells)])


def workbook(title: bool = False) -> bytes:
    """The table as XLSX, numbers as numbers; on the second sheet behind a ``title`` sheet."""
    import io

    from openpyxl import Workbook

    book = Workbook()
    sheet = book.active
    if title:
        for row in (("Trial", "walk 3"), ("Date", "28.11.2026"), ("Mass", 60.3)):
            sheet.append(row)
        sheet = book.create_sheet("Data")
    rows = [line.split(",") for line in table(decimals=3).splitlines()]
    sheet.append(rows[0])
    for row in rows[1:]:
        sheet.append([float(cell) for cell in row])
    out = io.BytesIO()
    book.save(out)
    return out.getvalue()


_BODY = {"x": "Mediolateral", "y": "Anterior-posterior", "z": "Vertical"}
_SHORT = {"x": "ML", "y": "AP", "z": "Vert"}
_N, _NMM = ("N", 1.0), ("Nmm", 1e-3)
# Name of a form, its file, and the file of the same recording beside it.
FORMS: dict[str, tuple[str, Callable[[], str | bytes], tuple[str, Callable[[], str]] | None]] = {
    "header too short": ("a.c3d", lambda: SHORT.read_bytes(), None),
    "header of one frame": ("a.c3d", lambda: _header(SHORT.read_bytes(), 1, 1), None),
    "header too long": ("a.c3d", lambda: _header(SHORT.read_bytes(), 1, 900), None),
    "frames as float": ("a.c3d", lambda: _frames_as_float(_c3d(_N, _NMM)), None),
    "late first frame": ("a.c3d", lambda: _c3d(_N, _NMM, first_frame=65500), None),
    "lb, ft-lb": ("a.c3d", lambda: _c3d(("lb", _LB), ("ft-lb", _LB * _FT)), None),
    "LBS, in-lbs": ("a.c3d", lambda: _c3d(("LBS", _LB), ("in-lbs", _LB * _IN)), None),
    "daN, daN m": ("a.c3d", lambda: _c3d(("daN", 10.0), ("daN m", 10.0)), None),
    "kp, kp cm": ("a.c3d", lambda: _c3d(("kp", _KP), ("kp cm", _KP * 0.01)), None),
    "kg, kg-m": ("a.c3d", lambda: _c3d(("kg", _KP), ("kg-m", _KP)), None),
    "kN, kNmm": ("a.c3d", lambda: _c3d(("kN", 1e3), ("kNmm", 1.0)), None),
    "Newtons, N-m": ("a.c3d", lambda: _c3d(("Newtons", 1.0), ("N-m", 1.0)), None),
    "C3D, y up": ("a.c3d", lambda: _c3d(_N, _NMM, axes="+z +x +y"), None),
    "C3D, z down": ("a.c3d", lambda: _c3d(_N, _NMM, axes="+x -y -z"), None),
    "C3D, y down": ("a.c3d", lambda: _c3d(_N, _NMM, axes="+x +z -y"), None),
    "8 fixed markers": ("a.c3d", lambda: _c3d(_N, _NMM, 8), None),
    "247 fixed markers": ("a.c3d", lambda: _c3d(_N, _NMM, 247), None),
    "MOT": ("a.mot", mot, None),
    "MOT, z up": ("a.mot", lambda: mot("+x +y +z"), None),
    "MOT, x up": ("a.mot", lambda: mot("+y +z +x"), None),
    "MOT, y down": ("a.mot", lambda: mot("+x +z -y"), None),
    "MOT of one name": ("a.mot", lambda: mot(names=("ground_force_", "ground_force_")), None),
    "MOT of one name, pandas": (
        "a.mot", lambda: mot(names=("ground_force_", "ground_force_"), pandas=True), None),
    "MOT, rows announced": ("a.mot", lambda: mot(rows=5), None),
    "MOT, more rows": ("a.sto", lambda: mot(rows=-5), None),
    "STO of vectors": ("a.sto", lambda: vectors(lambda n: (f"f{n}", f"p{n}")), None),
    "STO of vectors, mm, blanks": (
        "a.sto", lambda: vectors(lambda n: (f"f{n}", f"p{n}"), ", ", 1e-3), None),
    "STO of vectors by OpenSim's names": (
        "a.sto", lambda: vectors(lambda n: (f"ground_force_{n}_v", f"ground_force_{n}_p")), None),
    "STO of vectors, flat": (
        "a.sto",
        lambda: vectors(
            lambda n: tuple("\t".join(f"{k}{n}_{i}" for i in (1, 2, 3)) for k in "fp"), "\t"
        ).replace("DataType=Vec3\n", ""),
        None,
    ),
    "kineticstoolkit": ("a.csv", kinetics, None),
    "times of day": ("a.csv", clocked, None),
    "dates": ("a.csv", lambda: clocked("2026-11-27T"), None),
    "the number before the axis": (
        "a.csv", lambda: table(heads=lambda plate, axis: f"F{plate}{axis.upper()}"), None),
    "GRF": ("a.csv", lambda: table(heads=lambda plate, axis: f"GRF{plate}{axis}"), None),
    "OpenSim's names in a table": (
        "a.csv", lambda: table(heads=lambda plate, axis: f"ground_force_{plate}_v{axis}"), None),
    "TRC": ("a.trc", trc, ("b.mot", mot)),
    "TRC, z up": ("a.trc", lambda: trc(axes="+x +y +z"), ("b.mot", lambda: mot("+x +y +z"))),
    "TRC, Centimeters": ("a.trc", lambda: trc("Centimeters", 0.01), ("b.mot", mot)),
    "TRC, metres": ("a.trc", lambda: trc("metres", 1.0, digits=6), ("b.mot", mot)),
    "TRC, inches": ("a.trc", lambda: trc("inches", _IN), ("b.mot", mot)),
    "TRC, no unit": ("a.trc", lambda: trc(""), ("b.mot", mot)),
    "TRC, rows announced": ("a.trc", lambda: trc(frames=20), ("b.mot", mot)),
    "TRC, more rows": ("a.trc", lambda: trc(frames=-20), ("b.mot", mot)),
    "TRC, blanks": ("a.trc", lambda: trc(lost=""), ("b.mot", mot)),
    "TRC, 9999999": ("a.trc", lambda: trc(lost="9999999"), ("b.mot", mot)),
    "TRC, -999.0": ("a.trc", lambda: trc(lost="-999.0"), ("b.mot", mot)),
    "TRC, 1e6": ("a.trc", lambda: trc(lost="1000000.0"), ("b.mot", mot)),
    "TRC, held": ("a.trc", lambda: trc(lost="held"), ("b.mot", mot)),
    "TRC, a line": ("a.trc", lambda: trc(lost="line"), ("b.mot", mot)),
    "TRC, y down": (
        "a.trc", lambda: trc(axes="+x +z -y"), ("b.mot", lambda: mot("+x +z -y"))),
    "D-Flow, ten rows a frame": ("a.txt", dflow, None),
    "D-Flow, z up": ("a.txt", lambda: dflow("+x +y +z"), None),
    "Vicon": ("a.csv", vicon, None),
    "Vicon, y up, cm": ("a.csv", lambda: vicon("+z +x +y", "cm", 0.01), None),
    "Cortex": ("a.forces", cortex, None),
    "Cortex, y up": ("a.forces", lambda: cortex("+z +x +y"), None),
    "Qualisys MATLAB": ("a.mat", qtm, None),
    "Qualisys MATLAB, y up": ("a.mat", lambda: qtm("+z +x +y"), None),
    # With a load above 1000 N there are thousands: ratios stay.
    "thousands, tab": ("a.txt", lambda: table(",", "\t", scale=3.0, decimals=0), None),
    "thousands, semicolon": ("a.csv", lambda: table(",", ";", scale=3.0, decimals=1), None),
    "thousands, quoted": ("a.csv", lambda: table(",", scale=3.0, quoted=True), None),
    "thousands, apostrophe": ("a.csv", lambda: table("'", ";", scale=3.0), None),
    "thousands, blank": ("a.csv", lambda: table("\u202f", ";", ",", scale=3.0), None),
    "thousands, German": ("a.csv", lambda: table(".", ";", ",", scale=3.0), None),
    "decimal commas, quoted": ("a.csv", lambda: table("", ",", ",", quoted=True), None),
    "units row in brackets": ("a.csv", lambda: table(units_row=True), None),
    "pounds": ("a.csv", lambda: table(unit=("lbf", _LB), decimals=4), None),
    "kilonewtons": ("a.csv", lambda: table(unit=("kN", 1e3), decimals=5), None),
    "preamble and footer": (
        "a.csv",
        lambda: table(above=("Hall 2", "Anna", "Monday", "boots"), below=("", "End of file")),
        None,
    ),
    "plates before the axis": (
        "a.csv", lambda: table(heads=lambda plate, axis: f"FP{plate}_F{axis}"), None),
    "Vicon, semicolons": (
        "a.csv", lambda: vicon().replace(",", ";").replace(".", ","), None),
    "ends of lines twice": ("a.csv", lambda: table().replace("\n", "\r\r\n"), None),
    "every second line empty": ("a.csv", lambda: table().replace("\n", "\n\n"), None),
    "axes of the body": (
        "a.csv",
        lambda: table(heads=lambda plate, axis: f"{_BODY[axis]} force {plate}"), None),
    "axes of the body behind": (
        "a.csv",
        lambda: table(heads=lambda plate, axis: f"FP{plate}_GRF_{_SHORT[axis]}"), None),
    "a clock by its unit": ("a.csv", lambda: table().replace("Time (ms)", "ms"), None),
    "German": (
        "a.csv",
        lambda: table("", ";", ",", heads=lambda plate, axis: f"Kraft {axis.upper()} {plate}")
        .replace("Time (ms)", "Zeit [ms]"),
        None,
    ),
    "units behind a stroke": (
        "a.csv", lambda: table().replace(" (", " / ").replace(")", ""), None),
    "units behind in": (
        "a.txt", lambda: table(separator="\t").replace(" (", " in ").replace(")", ""), None),
    "units behind a low line": (
        "a.csv", lambda: table(unit=("kN", 1e3), decimals=5).replace(" (", "_").replace(")", ""),
        None,
    ),
    "cells between bars": ("a.txt", lambda: table(separator=" | "), None),
    "plates of one name": ("a.csv", lambda: table(heads=lambda plate, axis: f"F{axis}"), None),
    "UTF-16": ("a.csv", lambda: table(point=",", separator=";").encode("utf-16"), None),
    "workbook": ("a.xlsx", workbook, None),
    "workbook with a title sheet": ("a.xlsx", lambda: workbook(title=True), None),
    "units in the cells": ("a.csv", united, None),
    "names and values above": (
        "a.csv",
        lambda: table("", ";", ",", above=("Subject;Anna", "Mass [kg];60,3", "Date;28.11.2026")),
        None,
    ),
}  # fmt: skip


def written(form: str, folder: Path) -> tuple[Path, Path | None]:
    """Write a form of the walk; return its file and the one beside it."""
    name, content, beside = FORMS[form]
    paths = []
    for file, make in ((name, content), *((beside,) if beside else ())):
        data = make()
        paths.append(folder / file)
        paths[-1].write_bytes(data if isinstance(data, bytes) else data.encode())
    return paths[0], paths[1] if beside else None
