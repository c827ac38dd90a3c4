"""Text exports of motion laboratories: TRC, MOT and STO, Cortex, BioWare, Qualisys, Vicon."""

import re

import numpy as np

from underfoot.core import DataError
from underfoot.core.remark import Message

from ..recording.trial import Trial, Vertical
from .draft import RecordingDraft
from .text import delimiter_of, is_number, line_of, number_after, si_unit, split, truncation_error


def read_trc(draft: RecordingDraft) -> Trial:
    """Return the markers of a TRC file as a trial."""
    lines = draft.lines()
    if len(lines) < 6 or "PathFileType" not in lines[0]:
        raise draft.error("not a TRC file", allowed="a first line with PathFileType")
    header = dict(zip(split(lines[1], "\t"), split(lines[2], "\t"), strict=False))
    labels = [cell for cell in split(lines[3], "\t")[2:] if cell]
    if not labels:
        raise DataError("no marker is named", where=line_of(draft.name, 4))
    announced = header.get("NumMarkers", "")
    if announced.isdigit() and int(announced) < len(labels):
        draft.notes.append(
            Message(
                "NumMarkers is {announced}, the labels name {count}: all are read",
                announced=announced, count=len(labels),
            )
        )  # fmt: skip
    else:
        draft.count(announced, len(labels), "NumMarkers")
    candidates = ((i, split(lines[i], "\t")) for i in range(4, min(len(lines), 12)))
    first = next((i for i, c in candidates if len(c) > 1 and is_number(c[0].replace(",", "."))), 0)
    if not first:
        raise draft.error("truncated: there are no rows")
    columns = 2 + 3 * len(labels)
    rows = [row for line in lines[first:] if (row := line.rstrip(" \t"))]
    written = header.get("NumFrames", "")
    cut = len(rows) > 1 and rows[-1].count("\t") < min(row.count("\t") for row in rows[:-1])
    if cut and written.isdigit() and len(rows) <= int(written):
        raise truncation_error("truncated: the last row is shorter than the others", draft.name)
    rows = [row + "\t" * (columns - 1 - row.count("\t")) for row in rows]
    numbers = draft.table(rows, "\t", columns, first + 1)
    draft.count(written, len(numbers), "NumFrames", rows=True)
    draft.clock(numbers[:, 1])
    unit = header.get("Units", "")
    positions = numbers[:, 2:].reshape(len(numbers), -1, 3)
    positions = positions * draft.length_unit(unit, positions)
    for i, name in enumerate(draft.names(labels, "marker")):
        draft.marker(name, positions[:, i])
    return draft.trial("TRC")


# ground_force_vx, 1_ground_force_vx, R_ground_force_vx, ground_force_1_vx, FP1_vx ...
# and, where a table with two plates of one name went through pandas, ground_force_vx.1
_GROUND = re.compile(r"^(?P<base>.*?)_?(?P<kind>[vp][xyz])(?:\.(?P<number>\d+))?$")
_REACTION = re.compile(r"ground|grf|force|fp|plate", re.IGNORECASE)
# OpenSim's own tables of a C3D, three numbers a name: f1, p1, and in flat tables f1_1, f1_2 ...
_NUMBERED = re.compile(r"^(?P<kind>f|force|p|point)_?(?P<base>\d+)_(?P<axis>[123])$", re.I)
_FAR = 5.0  # m; no plate lies further from the origin: larger numbers are mm


def read_motion(draft: RecordingDraft) -> Trial:
    """Return the table of a .mot or .sto file as a trial; ground reactions become plates.

    OpenSim's ground reactions are forces on the body in ground axes, N and m; y is up in its own
    models, which way it is in a file the load tells.
    """
    lines = draft.lines()
    ends = (i for i, x in enumerate(lines[:200]) if x.strip().casefold().startswith("endheader"))
    end = next(ends, None)
    if end is None:
        raise draft.error("not a motion file", allowed="a header closed by endheader")
    header = _header(lines[:end])
    at = next((i for i in range(end + 1, len(lines)) if lines[i].strip()), None)
    if at is None:
        raise draft.error("truncated: the column names are missing")
    if header.get("datatype", "").casefold() == "quaternion":
        raise draft.error(
            "orientations of sensors (OpenSense), no forces and no markers",
            allowed="ground reactions (.mot, .sto) or markers (.trc)",
            remedy="Record the steps on a force plate, and export its forces and the markers",
        )
    delimiter = "\t" if "\t" in lines[at] else ""
    labels = split(lines[at].rstrip(), delimiter)
    if labels[0].casefold() not in ("time", "frame", "t"):
        raise draft.error(f'the first column is "{labels[0]}", not time')
    rows = [line.strip() for line in lines[at + 1 :]]
    vectors = header.get("datatype", "").casefold() == "vec3"
    if vectors:  # x, y and z of a name stand in one cell, with commas between
        labels = [labels[0], *(_part(label, i) for label in labels[1:] for i in range(3))]
        rows = [re.sub(r"\s*,\s*", delimiter or " ", row) for row in rows]
    names = draft.names(labels, "column")
    numbers = draft.table(rows, delimiter, len(labels), at + 2)
    draft.count(header.get("nrows", ""), len(numbers), "nrows", rows=True)
    draft.count(header.get("ncolumns", ""), len(labels), "ncolumns")
    draft.clock(numbers[:, 0])
    draft.up = Vertical((0.0, 1.0, 0.0), "y by OpenSim's convention: nobody on a plate")
    degrees = header.get("indegrees", "").casefold() in ("yes", "true", "1")
    for i, name in enumerate(names[1:], start=1):
        draft.channel(name, numbers[:, i], note="angles in degrees" if degrees else "")
    unit = si_unit(header.get("units", ""))
    if vectors and unit is not None and unit[0] == "m":
        for i in range(1, len(labels), 3):
            if not (_NUMBERED.match(labels[i]) or _GROUND.match(labels[i])):
                draft.marker(labels[i].rpartition("_")[0], numbers[:, i : i + 3] * unit[1])
    if draft.times is None:
        _plates(draft, labels, numbers)
    else:
        draft.notes.append("samples are not equally spaced: no plates were made")
    return draft.trial("OpenSim motion")


def _part(label: str, axis: int) -> str:
    """The name of one number of a vector: of a force "..._vx", of anything else "..._1"."""
    return f"{label}{'xyz'[axis]}" if _GROUND.match(label + "x") else f"{label}_{axis + 1}"


def _header(lines: list[str]) -> dict[str, str]:
    found: dict[str, str] = {}
    for line in lines:
        key, separator, value = line.partition("=")
        words = line.split()
        if separator:
            found[key.strip().casefold()] = value.strip()
        elif len(words) == 2 and words[0].casefold() in ("datarows", "datacolumns"):
            found["n" + words[0].casefold().removeprefix("data")] = words[1]  # the older form
    return found


def _plates(draft: RecordingDraft, labels: list[str], numbers: np.ndarray) -> None:
    groups: dict[tuple[str, int], dict[str, int]] = {}
    for i, label in enumerate(labels[1:], start=1):
        match = _GROUND.match(label)
        told = _NUMBERED.match(label)
        if told:
            kind = ("v" if told["kind"][0] in "fF" else "p") + "xyz"[int(told["axis"]) - 1]
            groups.setdefault((told["base"], 0), {})[kind] = i
        elif match and _REACTION.search(match["base"]):
            number = int(match["number"] or 0)
            while match["kind"] in groups.setdefault((match["base"], number), {}):
                number += 1  # columns of one name are those of the next plate
            groups[match["base"], number][match["kind"]] = i
    for columns in groups.values():
        if not {"vx", "vy", "vz"} <= columns.keys():
            continue
        force = numbers[:, [columns["vx"], columns["vy"], columns["vz"]]]
        place = None
        if {"px", "py", "pz"} <= columns.keys():
            place = numbers[:, [columns["px"], columns["py"], columns["pz"]]]
            far = np.abs(place[np.isfinite(place)])
            if far.size and float(np.percentile(far, 90)) > _FAR:
                place = 1e-3 * place
                draft.notes.append("centre of pressure taken as mm from its size")
        kind = Message("ground reaction ({label})", label=labels[columns["vx"]])
        draft.plate(force, centre_of_pressure=place, kind=kind)


_LENGTH = 1e-3  # Cortex writes positions in mm, moments in N mm
_COLUMNS = ("FX", "FY", "FZ", "X", "Y", "Z", "MZ")


def read_cortex_forces(draft: RecordingDraft) -> Trial:
    """Return the plates of a Cortex .forces file as a trial.

    The forces are those on the foot in laboratory axes. The vertical axis is the one that
    carries the load.
    """
    lines = draft.lines()
    if len(lines) < 6 or "[force data]" not in lines[0].casefold():
        raise draft.error("not a Cortex file", allowed="a first line [Force Data]")
    header = {line.split("=")[0].strip().casefold(): line for line in lines[1:20] if "=" in line}
    for key in ("samplerate", "numberofsamples"):
        if key not in header:
            raise draft.error(f"the header has no {key}")
    draft.rate = number_after(header["samplerate"], draft.name)
    expected = number_after(header["numberofsamples"], draft.name)
    if not 0 < draft.rate < 1e6:
        rate = Message("{name} is {value:g}", name="SampleRate", value=draft.rate)
        raise draft.error(rate, allowed="a positive rate in Hz")
    at = next((i for i, line in enumerate(lines[:30]) if line.startswith("#")), None)
    if at is None:
        raise draft.error("truncated: the column names are missing")
    labels = split(lines[at].lstrip("#"), "\t")
    names = draft.names(labels, "column")
    numbers = draft.table(lines[at + 1 :], "\t", len(labels), at + 2)
    draft.count(str(int(expected)), len(numbers))
    index = {label.upper(): i for i, label in enumerate(labels)}
    suffixes = [m[1] for m in (re.match(r"^FX(\d+)$", label.upper()) for label in labels) if m]
    complete = [s for s in suffixes if all(name + s in index for name in _COLUMNS)]
    if not complete:
        raise draft.error("no plate has all of FX FY FZ X Y Z MZ")
    for s in complete:
        force = numbers[:, [index[name + s] for name in _COLUMNS[:3]]]
        place = numbers[:, [index[name + s] for name in _COLUMNS[3:6]]] * _LENGTH
        kind = "Cortex force and centre of pressure"
        draft.plate(force, f"plate {s}", centre_of_pressure=place, kind=kind)
    for i, name in enumerate(names[1:], start=1):
        draft.channel(name, numbers[:, i], unit="N" if name.upper().startswith("F") else "")
    return draft.trial("Cortex forces")


_CENTRE = ("AX", "AY")


def read_bioware(draft: RecordingDraft) -> Trial:
    """Return the plates of a BioWare text export as a trial.

    BioWare writes the force **on the plate** in Kistler's axes (z into the floor). On the foot
    that is -Fx, -Fy and Fz upward; Fx and Fy are turned here, which a C3D export of the same
    recording confirms.
    """
    lines = [line.rstrip("\t ") for line in draft.lines()]
    heads = (i for i, line in enumerate(lines[:80]) if line.casefold().startswith("abs time"))
    at = next(heads, None)
    if at is None:
        raise draft.error("not a BioWare export", allowed='a column "abs time (s)"')
    labels = split(lines[at], "\t")
    first, units = at + 1, [""] * len(labels)
    if first < len(lines):
        cells = split(lines[first], "\t")
        if cells and not is_number(cells[0].replace(",", ".")):
            units = (cells + units)[: len(labels)]
            first += 1
    names = draft.names(labels, "column")
    numbers = draft.table(lines[first:], "\t", len(labels), first + 1)
    draft.clock(numbers[:, 0])
    if draft.times is not None:
        raise draft.error("the samples are not equally spaced")
    for i in range(1, len(labels)):
        default = "N" if labels[i].strip("|").upper().startswith("F") else "m"
        draft.channel(names[i], numbers[:, i], units[i], unit=default)
    kinds = [label.upper()[:2] for label in labels]
    for i in range(1, len(labels) - 2):
        if kinds[i : i + 3] != ["FX", "FY", "FZ"]:
            continue
        columns = [draft.channels[name].values for name in names[i : i + 3]]
        force = np.column_stack((-columns[0], -columns[1], columns[2]))
        following = kinds[i + 3 : i + 6]
        place = None
        if set(_CENTRE) <= set(following):
            x, y = (draft.channels[names[i + 3 + following.index(a)]].values for a in _CENTRE)
            place = np.column_stack((x, y, np.zeros(len(x))))
        kind = "BioWare text, force on the plate turned to the foot, plate axes"
        draft.plate(force, centre_of_pressure=place, kind=kind)
    draft.up = Vertical((0.0, 0.0, 1.0), "axes of the plates")
    if not draft.plates:
        raise draft.error("no plate has Fx, Fy and Fz")
    return draft.trial("BioWare text")


_CORNERS = ("POSX_POSY", "NEGX_POSY", "NEGX_NEGY", "POSX_NEGY")


def read_qualisys(draft: RecordingDraft) -> Trial:
    """Return the markers or the force plate of a Qualisys TSV file as a trial.

    Lengths are mm. Forces are taken as exported, in laboratory axes (QTM can also export plate
    axes: choose "global" there).
    """
    lines = draft.lines()
    header: dict[str, list[str]] = {}
    at = 0
    while at < len(lines) and (cells := split(lines[at], "\t")) and not is_number(cells[0]):
        header.setdefault(cells[0].upper(), cells[1:])
        at += 1

    def first(key: str) -> str:
        return (header.get(key) or [""])[0]

    draft.rate = float(first("FREQUENCY") or "nan")
    if not 0 < draft.rate < 1e6:
        raise draft.error("the header has no FREQUENCY")
    rows = [line.rstrip("\t ") for line in lines[at:] if line.strip()]
    if not rows:
        raise draft.error("truncated: there are no rows")
    width = max(row.count("\t") for row in rows) + 1
    numbers = draft.table(rows, "\t", width, at + 1)
    for key in ("NO_OF_FRAMES", "NO_OF_SAMPLES"):
        draft.count(first(key), len(numbers), key)
    if "MARKER_NAMES" in header:
        names = draft.names([n for n in header["MARKER_NAMES"] if n], "marker")
        extra = width - 3 * len(names)
        if extra not in (0, 1, 2):
            raise draft.error(f"{width} columns for {len(names)} markers")
        if extra == 2:
            draft.clock(numbers[:, 1])
        places = numbers[:, extra:].reshape(len(numbers), -1, 3) * 1e-3
        for i, name in enumerate(names):
            draft.marker(name, places[:, i])
        return draft.trial("Qualisys TSV")
    labels = [cell.upper().replace(" ", "_") for cell in split(lines[at - 1], "\t")]

    def triple(kind: str) -> np.ndarray | None:
        wanted = [f"{kind}_{axis}" for axis in "XYZ"]
        known = set(wanted) <= set(labels)
        return numbers[:, [labels.index(label) for label in wanted]] if known else None

    force, place = triple("FORCE"), triple("COP")
    if force is None:
        raise draft.error("no columns Force_X, Force_Y, Force_Z and no markers")
    keys = [[f"FORCE_PLATE_CORNER_{corner}_{axis}" for axis in "XYZ"] for corner in _CORNERS]
    corners = 1e-3 * np.array([[float((header.get(k) or ["nan"])[0]) for k in row] for row in keys])
    name = " ".join(header.get("FORCE_PLATE_NAME", [])) or "1"
    draft.plate(
        force,
        name if name.startswith("plate") else f"plate {name}",
        centre_of_pressure=None if place is None else place * 1e-3,
        corners=corners if np.isfinite(corners).all() else None,
        kind="Qualisys TSV, taken as laboratory axes",
    )
    for i, label in enumerate(draft.names(labels, "column")[:width]):
        draft.channel(label, numbers[:, i], unit="N" if label.startswith("FORCE") else "")
    return draft.trial("Qualisys TSV")


BLOCKS = ("devices", "trajectories", "model outputs", "joints", "segments")
_PLATE = re.compile(r"^(?P<device>.*?)\s*-\s*(?P<what>force|moment|cop)$", re.IGNORECASE)


def read_vicon_csv(draft: RecordingDraft) -> Trial:
    """Return devices (force plates, channels) and trajectories of a Nexus export as one trial."""
    lines = draft.lines()
    kinds = [line.strip(' ,;\t"').casefold() for line in lines]
    delimiter = delimiter_of(lines) or ","
    starts = [i for i, kind in enumerate(kinds) if kind in BLOCKS]
    if not starts:
        raise draft.error("no block of devices or trajectories")
    for start, stop in zip(starts, [*starts[1:], len(lines)], strict=True):
        names, axes, units, numbers = _block(draft, lines[start:stop], start, delimiter)
        if kinds[start] == "devices":
            _devices(draft, names, axes, units, numbers)
        elif kinds[start] == "trajectories":
            for name in dict.fromkeys(names):
                at = [i for i, n in enumerate(names) if n == name]
                if name and len(at) == 3:
                    metres = draft.length_unit(units[at[0]] or "mm", numbers[:, at])
                    draft.marker(name.rsplit(":", 1)[-1], numbers[:, at] * metres)
        else:
            draft.notes.append(Message("the block of {kinds} was left out", kinds=kinds[start]))
    return draft.trial("Vicon CSV")


def _block(
    draft: RecordingDraft, lines: list[str], start: int, delimiter: str
) -> tuple[list[str], list[str], list[str], np.ndarray]:
    rate = split(lines[1], delimiter)[0].replace(",", ".") if len(lines) > 1 else ""
    if not is_number(rate) or not 0 < float(rate) < 1e6 or len(lines) < 6:
        where = line_of(draft.name, start + 2)
        raise DataError("a block has no rate or no rows", where=where)
    draft.rate = float(rate)
    names, axes, units = (split(line, delimiter) for line in lines[2:5])
    width = len(axes)
    names, units = ((row + [""] * width)[:width] for row in (names, units))
    for i in range(3, width):
        names[i] = names[i] or names[i - 1]  # a name stands over the first of its columns only
    return names, axes, units, draft.table(lines[5:], delimiter, width, start + 6)


def _devices(
    draft: RecordingDraft, names: list[str], axes: list[str], units: list[str], numbers: np.ndarray
) -> None:
    whole = [f"{name} {axis}".strip() for name, axis in zip(names, axes, strict=True)]
    labels = draft.names(whole, "column")
    groups: dict[str, dict[str, list[np.ndarray]]] = {}
    for i in range(2, len(labels)):
        draft.channel(labels[i], numbers[:, i], units[i])
        match = _PLATE.match(names[i])
        if match:
            parts = groups.setdefault(match["device"], {})
            parts.setdefault(match["what"].casefold(), []).append(draft.channels[labels[i]].values)
    for device, parts in groups.items():
        if len(parts.get("force", [])) != 3:
            continue
        place = parts.get("cop", [])
        force = np.column_stack(parts["force"])
        draft.plate(
            force,
            centre_of_pressure=np.column_stack(place) if len(place) == 3 else None,
            kind=f"Vicon CSV, {device}",
        )
