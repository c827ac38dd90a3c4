"""Units, clocks, names, layouts of tables, profiles and formats: each answer and each refusal."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from recording_texts import (
    FORCE,
    HEEL,
    LOAD,
    TEXTS,
    TIME,
    TOE,
    cells,
    changes,
    read_lines,
    table,
    trc,
    workbook,
)
from snapshot import held, refusal
from underfoot.core import UnderfootError
from underfoot.trials import read_trial
from underfoot.trials.readers import (
    READERS,
    TrialsProfile,
    file_format,
    nearest_format,
    profile_from,
    read_profile,
    read_sheet,
    trial_suffixes,
    with_channels,
)
from underfoot.trials.readers.curve_arrays import read_curves
from underfoot.trials.readers.draft import RecordingDraft
from underfoot.trials.readers.file_bytes import FileBytes
from underfoot.trials.readers.seen import camera_clock, coded_forces, unseen
from underfoot.trials.readers.sheet import sheet_from
from underfoot.trials.readers.text import (
    clock_time,
    delimiter_of,
    force_unit,
    is_number,
    is_written_number,
    known_units,
    lines_of,
    name_and_unit,
    number_after,
    plain_numbers,
    rate_of,
    si_unit,
    unique_names,
    without_restarts,
)
from underfoot.trials.readers.text import table as text_table


def answer(call, *args, **options):
    """What a call gives, or the error that it ends with."""
    try:
        return call(*args, **options)
    except UnderfootError as error:
        return f"{type(error).__name__}: {error}".replace("\n", " | ")


def test_every_unit_and_many_ways_to_write_one(file_regression):
    words = [
        "Newton",
        "newtons",
        "NEWTON",
        "kn",
        "KN",
        "mn",
        "MN",
        "mN",
        "mpa",
        "MPa",
        "mPa",
        "N m",
        "Nm",
        "N·m",
        "N*mm",
        "Nmm",
        "nm",
        "N-m",
        "Nms",
        "ft-lb",
        "lb ft",
        "in.lbf",
        "inlb",
        "kgm",
        "kg cm",
        "kpcm",
        "kg",
        "g",
        "lb",
        "oz",
        "t",
        "lbs",
        "pounds",
        "Kilopond",
        "gramme",
        "[N]",
        "(mm)",
        "{s}",
        "µm",
        "μm",
        "um/s",
        "Â°C",
        "°C",
        "degC",
        "deg C",
        "Celsius",
        "Grad Celsius",
        "°",
        "deg",
        "grad",
        "rad/s",
        "1/min",
        "U/min",
        "rev/min",
        "m/s²",
        "N/mm²",
        "N/mm^2",
        "N/cm2",
        "%",
        "-",
        "1",
        "",
        " ",
        "−",
        "psi",
        "PSI",
        "mmHg",
        "feet",
        "foot",
        "'",
        '"',
        "Zoll",
        "inches",
        "msec",
        "secs",
        "Sekunde",
        "std",
        "min",
        "h",
        "fpm",
        "fps",
        "ips",
        "km/h",
        "Hz",
        "kHz",
        "volts",
        "V",
        "mV",
        "A",
        "K",
        "ms",
        "Ms",
        "S",
        "s.",
        "m s",
        "kN.m",
    ]
    held(
        file_regression,
        {
            "si": {word: si_unit(word) for word in words},
            "force": {
                word: force_unit(word) for word in words if force_unit(word) != si_unit(word)
            },
            "known": {word: f"{si_unit(word)}" for word in known_units()},
        },
    )


def test_cells_clocks_and_names(file_regression):
    labels = [
        "Fx (N)",
        "Fx [kN]",
        "Fx(N)",
        "Fx / N",
        "Fx, N",
        "Fx in N",
        "Fx_N",
        "Fx_kN",
        "t_ms",
        "x_mm",
        "Fx_n",
        "speed / rpm",
        "m/s",
        "Force (N) (left)",
        "  heel x (m) ",
        "(N)",
        "F_x",
        "a / b",
        "pressure, kPa",
        "M_Nm",
        "load_lbf",
        "load_kg",
        "temp_C",
        "U / V",
        "x/mm",
        "name",
        "",
        "Fx ()",
        "Fx (N] ",
    ]
    times = [
        "10:15:20",
        "10:15:20.25",
        "10:15:20,5",
        "10:15:20:75",
        "1:02:03",
        "10:15",
        "25:00:00",
        "10:60:00",
        "10:15:20 am",
        "12:15:20 AM",
        "12:15:20 pm",
        "1:15:20pm",
        "2026-01-02T10:15:20Z",
        "02.01.2026 10:15:20",
        "2026-01-02 10:15:20+01:00",
        "1/2/26 10:15:20",
        "x 10:15:20",
        "3.5",
        "",
    ]
    numbers = [
        "1",
        "-1.5",
        "+.5",
        "5.",
        "1e3",
        "1E-3",
        "1d5",
        "1,5",
        "1.234,5",
        "1'234",
        "1 234",
        "−3",
        "1e",
        "e5",
        "0x1",
        "",
        ".",
        "-",
        "nan",
        "1.5.2",
        "12a",
        "1e5.5",
        " 7 ",
    ]
    held(
        file_regression,
        {
            "labels": {label: name_and_unit(label) for label in labels},
            "times": {cell: clock_time(cell) for cell in times},
            "numbers": {cell: (is_number(cell), is_written_number(cell)) for cell in numbers},
            "after": {
                line: answer(number_after, line, "a.txt")
                for line in ("rate=5", "rate = 5,5", "rate", "rate=x", "7", "rate=inf", "a=b=3")
            },
            "signs": {
                said: delimiter_of(lines)
                for said, lines in {
                    "tab": ["1\t2"] * 3,
                    "semicolon": ["1,5;2,5"] * 3,
                    "bar": ["1|2"] * 3,
                    "comma": ["1,2"] * 3,
                    "blanks": ["1 2"] * 3,
                    "some": ["1;2", "1 2", "1 2"],
                    "half": ["1;2", "1 2"],
                    "most": ["1;2", "1;2", "1 2"],
                    "none": [],
                }.items()
            },
            "lines": [
                lines_of(t) for t in ("a\r\nb\rc\nd", "a\r\r\nb", "a\n\nb\n\nc\n\n", "a\n\nb\nc")
            ],
        },
    )


def test_names_numbers_and_clocks_of_columns(file_regression):
    def with_notes(call, *args):
        notes: list[str] = []
        return {"is": answer(call, *args, notes), "notes": notes}

    rows = {
        "plain": ["1,2", "3,4"],
        "blanks": ["1 2", "3 4"],
        "decimal": ["1,5;2", "2,5;3"],
        "thousands": ["1,234;2", "2,345;3"],
        "large": ["1234.5;2"],
        "three": ["1.234;2.345"],
        "small": ["0.125;2.345"],
        "words": ["1;x"],
        "holes": ["1;;3"],
        "zero": ["0;0"],
        "hex": ["0x1;2"],
        "mixed": ["1,5;2.5"],
    }
    tables = {
        "plain": (["1;2", "3;4"], 2),
        "short": (["1;2;3", "3;4", "5;6;7"], 3),
        "cut": (["1;2;3", "3;4"], 3),
        "long": (["1;2", "3;4;5"], 2),
        "behind": (["1;2;", "3;4;"], 2),
        "word": (["1;2", "x;4"], 2),
        "nothing": (["1;n/a", "NaN;4", "--;5"], 2),
        "no rows": (["", " ; "], 2),
        "no number": (["nan;nan"], 2),
        "endless": (["1;inf", "2;1e31"], 2),
        "German": (["1.234,5;2", "1,5;3"], 2),
        "American": (["1,234.5;2", "1;3"], 2),
        "apostrophes": (["1'234;2", "2'345'678;3"], 2),
    }
    clocks = {
        "even": TIME,
        "late": TIME + 5,
        "jitter": TIME + 0.0005 * (np.arange(60) % 2),
        "uneven": np.append(TIME, 0.7),
        "back": np.append(TIME, 0.1),
        "stopped": np.append(TIME, TIME[-1]),
        "hole": np.append(TIME, np.nan),
        "one": TIME[:1],
        "two": TIME[:2],
    }
    restarts = {
        "none": TIME,
        "once": np.concatenate((TIME, TIME)),
        "twice": np.concatenate((TIME, TIME, TIME)),
        "not at the start": np.concatenate((TIME, TIME + 0.3)),
        "often": np.tile([0, 1.0], 9),
        "still": np.zeros(5),
        "a step late": np.concatenate((TIME, TIME + 0.01)),
    }
    names = ["a", "b", "a", " a ", "", "", "a #2", "b", "c", "c", "d", "d", "e", "e", "f", "f"]
    held(
        file_regression,
        {
            "names": with_notes(unique_names, names, "column"),
            "few names": with_notes(unique_names, ["a", "a"], "marker"),
            "numbers": {
                said: with_notes(
                    plain_numbers, lines, ";" if ";" in lines[0] else "," if "," in lines[0] else ""
                )
                for said, lines in rows.items()
            },
            "tables": {
                said: [answer(text_table, lines, ";", width, "a.txt", notes := [], 7), notes]
                for said, (lines, width) in tables.items()
            },
            "ignored": text_table(["1;x", "2;y"], ";", 2, "a.txt", [], 1, frozenset({1})),
            "clocks": {said: answer(rate_of, times, "a.txt") for said, times in clocks.items()},
            "restarts": {said: without_restarts(times) for said, times in restarts.items()},
        },
    )


def settled(clock):
    """A clock whose first row is rounded."""
    return clock and replace(clock, first=round(clock.first, 6) + 0.0)


SHEETS = {
    "plain": "a,b\n1,2\n3,4\n",
    "no names": "1,2\n3,4\n",
    "units below": "a,b\nN,mm\n1,2\n3,4\n",
    "units beside": "a (N),b [mm]\n1,2\n3,4\n",
    "two units": "a (N),b\nmm,m\n1,2\n3,4\n",
    "the same unit twice": "a (N),b\nnewton,m\n1,2\n3,4\n",
    "in cells": "a,b\n1 N,2 mm\n3 N,4 mm\n5 N,6 mm\n",
    "text": "a,b,c\n1,x,2\n3,y,4\n",
    "nothing": "a,b\n1,n/a\n3,#DIV/0!\n5,\n",
    "above": "Hall\nRoom;5\n\na;b\n1;2\n3;4\n",
    "footer": "a,b\n1,2\n3,4\nEnd of file\n\nmean,3\n",
    "footer of numbers": "a,b\n1,2\n3,4\nmean,x,y\n5,6\n",
    "empty": "\n\n",
    "words": "a,b\nx,y\n",
    "short row": "a,b,c\n1,2,3\n4,5\n6,7,8\n",
    "cut": "a,b,c\n1,2,3\n4,5\n",
    "long row": "a,b\n1,2\n3,4,5\n",
    "names behind": "a,b,,\n1,2\n3,4\n",
    "no name inside": "a,,c\n1,2,3\n4,5,6\n",
    "twice": "a,a,b\n1,2,3\n4,5,6\n",
    "one column": "a\n1\n2\n3\n",
    "numbers as names": "2024,2025\n1,2\n3,4\n",
    "quoted": '"a","b, c"\n"1,5","2"\n"3,5","4"\n',
    "endless": "a,b\n1,inf\n2,1e31\n3,4\n",
    "blanks": "a b\n1 2\n3 4\n",
    "rows between": "a,b\n1,2\n\n3,4\n",
    "thousands": "a;b\n1.234,5;2\n2.345,5;3\n",
    "one row": "a,b\n1,2\n",
    "times": "time,b\n10:00:00,1\n10:00:01,2\n",
    "uneven head": "x\na,b,c\n1,2,3\n4,5,6\n",
}


def test_layouts_of_tables(tmp_path, file_regression):
    def seen(*args, **options):
        sheet = answer(sheet_from, *args, **options)
        if isinstance(sheet, str):
            return sheet
        numbers = {name: values.tolist() for name, values in sheet.numbers.items()}
        said = [str(note) for note in sheet.notes]
        parts = f"{numbers} texts {dict(sheet.texts)} units {dict(sheet.units)}"
        return f"{parts} header {sheet.header} notes {said}"

    (tmp_path / "a.csv").write_text("a,b\n1,2\n")
    books = {
        "one": {"one": cells("t,Fz\n0,5\n1,6", ",")},
        "with a title": {
            "title": [["Hall 2"], [3.0]],
            "data": cells("a (N),b\n1,2\n3,4\n5,x", ","),
        },
        "empty": {"none": []},
        "gaps": {"g": [["a", None, "b"], [1.0, None, 2.5], [None, None, 3.0], []]},
    }
    held(
        file_regression,
        {
            "texts": {said: seen(text.encode(), "a.csv") for said, text in SHEETS.items()},
            "sign": seen(b"a,5;b\n1,5;2\n", "a.csv", None, ";"),
            "line": {
                f"{line}": seen(b"q\na,b\nN,m\n1,2\n3,4\n", "a.csv", None, None, line)
                for line in range(1, 7)
            },
            "books": {said: seen(workbook(book), "a.xlsx") for said, book in books.items()},
            "sheet": seen(workbook(books["with a title"]), "a.xlsx", "title"),
            "no sheet": seen(workbook(books["with a title"]), "a.xlsx", "titel"),
            "cut": seen(workbook(books["one"])[:900], "a.xlsx"),
            "xls": seen(b"\xd0\xcf\x11\xe0" + bytes(90), "a.xls"),
            "columns": read_sheet(tmp_path / "a.csv").columns,
            "not there": refusal(read_sheet, Path("no.csv")),
        },
    )


PROFILE = {
    "name": "hall 2",
    "file": {"header_line": 2, "rate": "200 Hz", "length_unit": "cm"},
    "channels": {"pressure": {"column": "p", "unit": "kPa", "scale": 2}},
    "plates": {
        "1": {
            "force": ["Fx", "Fy", "Fz"],
            "unit": "kN",
            "force_is": "on the plate",
            "sign": [1, -1, 1],
            "centre_of_pressure": ["Cx", "Cy", ""],
            "length_unit": "cm",
            "corners": [[60, 40, 0], [60, 0, 0], [0, 0, 0], [0, 40, 0]],
        }
    },
    "markers": {"left heel": {"columns": ["heel_x", "heel_y", "heel_z"], "unit": "cm"}},
    "heel": {"left": "left heel"},
    "axes": {"vertical": "z", "walking": "+x"},
    "subject": {"mass": "70 kg"},
    "sensors": {"unit": "mm", "P1": [100, 0, 5]},
    "accuracy": {"gain": "2 %", "crosstalk": 0.01, "source": "sheet of data"},
}


def _with(*keys, value=None):
    """The profile with one part of it changed, or left out where ``value`` is None."""

    def copied(part, keys):
        part = dict(part)
        if len(keys) > 1:
            part[keys[0]] = copied(part.get(keys[0], {}), keys[1:])
        elif value is None:
            part.pop(keys[0], None)
        else:
            part[keys[0]] = value
        return part

    return copied(PROFILE, keys)


def test_profiles_and_what_is_wrong_with_one(tmp_path, file_regression):
    plate = ("plates", "1")
    wrong = [
        ("plate",),
        ("file",),
        ("file", "header"),
        ("file", "header_line"),
        ("file", "rate"),
        ("file", "delimiter"),
        ("file", "length_unit"),
        ("channels", "x"),
        ("channels", "pressure", "unit"),
        ("channels", "pressure", "scale"),
        ("channels", "pressure", "colour"),
        plate,
        (*plate, "force"),
        (*plate, "unit"),
        (*plate, "force_is"),
        (*plate, "sign"),
        (*plate, "corners"),
        (*plate, "moment"),
        (*plate, "length_unit"),
        (*plate, "friction"),
        (*plate, "forces"),
        ("markers", "x"),
        ("markers", "left heel", "columns"),
        ("markers", "left heel", "unit"),
        ("axes", "vertical"),
        ("axes", "up"),
        ("subject", "mass"),
        ("subject", "size"),
        ("sensors", "unit"),
        ("sensors", "P2"),
        ("accuracy", "gain"),
        ("accuracy", "gains"),
        ("landmarks",),
        ("landmarks", "x"),
        ("heel", "both"),
        ("heel", "left"),
    ]
    values = {
        "file header_line": 0,
        "file rate": "0 Hz",
        "subject mass": "-5 kg",
        "plates 1 sign": [1, True, 1],
        "plates 1 corners": [[0, 0, 0]],
        "plates 1 force": ["Fx", "Fx", "Fz"],
        "axes vertical": "up",
        "plates 1 moment": ["a", "b", 3],
        "channels pressure scale": True,
        "accuracy gain": "2 N",
        "landmarks x": "heel",
        "file delimiter": 5,
    }
    answers = {
        " ".join(keys): answer(profile_from, _with(*keys, value=values.get(" ".join(keys), "odd")))
        for keys in wrong
    }
    testers = {
        "both": {"force": ["a", "b", "c"], "friction": "f"},
        "none": {"unit": "N"},
        "one": {"friction": "f"},
        "the same": {"friction": "f", "normal": "f"},
        "two": {"friction": "f", "normal": "n"},
        "odd": {"friction": 5, "normal": "n"},
        "holes": {"force": ["a", "", "c"]},
        "twice": {"force": ["", "a", "a"]},
    }
    (tmp_path / "bad.toml").write_text("a = ")
    (tmp_path / "good.toml").write_text(
        'name = "a"\n[axes]\nvertical = "-y"\n[landmarks]\nA = "left heel"\n'
    )
    held(
        file_regression,
        {
            "whole": profile_from(PROFILE),
            "empty": profile_from({}),
            "no baseline": profile_from({"file": {"subtract_baseline": False}}).subtract_baseline,
            "wrong": {
                key: value if isinstance(value, str) else "taken" for key, value in answers.items()
            },
            "testers": {
                said: answer(profile_from, {"plates": {"t": part}}, where="p.toml")
                for said, part in testers.items()
            },
            "read": read_profile(tmp_path / "good.toml"),
            "no TOML": refusal(read_profile, tmp_path / "bad.toml").split("bad.toml")[-1],
            "with": {
                "none": with_channels(TrialsProfile(), "", "", where="w") == TrialsProfile(),
                "both": with_channels(TrialsProfile(), "f", "n", where="w").plates,
                "one": answer(with_channels, TrialsProfile(), "f", "", where="w"),
                "two places": answer(with_channels, profile_from(PROFILE), "f", "n", where="w"),
            },
        },
    )


def test_a_table_read_by_profiles(tmp_path, file_regression):
    text = table()
    whole = read_lines(tmp_path, "t.csv", text, profile=profile_from(PROFILE))
    others = {
        "no plates": _with("plates"),
        "no rate": _with("file", "rate"),
        "by time": _with("file", "time", value="Time"),
        "by another time": _with("file", "time", value="p"),
        "no such time": _with("file", "time", value="Uhr"),
        "unit of time": _with("file", "time_unit", value="s"),
        "line 1": _with("file", "header_line", value=1),
        "sign": _with("file", "delimiter", value=","),
        "on the foot": _with("plates", "1", "force_is"),
        "N": _with("plates", "1", "unit"),
        "no places": _with("plates", "1", "centre_of_pressure"),
        "no channels": _with("channels"),
        "absent": _with("channels", "q", value={"column": "P2"}),
        "folded": _with("channels", "q", value={"column": " FX ", "unit": "lbf"}),
        "no markers": _with("markers"),
        "two": _with("plates", "2", value={"friction": "Fx", "normal": "Fz"}),
        "metres": _with("file", "length_unit", value="m"),
        "vertical": _with("axes", "vertical", value="x"),
        "no baseline": _with("file", "subtract_baseline", value=False),
        "mass": _with("subject"),
        "accuracy": _with("accuracy"),
        "sign of x": _with("plates", "1", "sign", value=[-1, 2, 1]),
        "metre corners": _with("plates", "1", "length_unit"),
        "plate 7": {"plates": {"plate 7": {"force": ["Fx", "", "Fz"]}}},
    }
    answers = {
        said: changes(
            whole, read_lines(tmp_path, "t.csv", text, profile=answer(profile_from, given))
        )
        for said, given in others.items()
    }
    plain = {
        f"{said} {form}": changes(whole, read_lines(tmp_path, name, data(), profile=given))
        for said, given in {
            "length in m": TrialsProfile(length_unit="m"),
            "by x": TrialsProfile(vertical="x"),
        }.items()
        for form, (name, data) in {
            "trc": ("a.trc", trc),
            "mvnx": ("w.mvnx", TEXTS["w.mvnx"]),
        }.items()
    }
    held(file_regression, {"whole": whole, "others": answers, "plain": plain})


def test_books_with_a_sheet_for_each_recording(tmp_path, file_regression):
    rows = cells(table().replace(",", ".").replace("Hall 2;Anna\n", ""), ";")
    half = [rows[0], *rows[20:]]
    held(
        file_regression,
        {
            "one": read_lines(tmp_path, "a.xlsx", workbook({"a": rows})),
            "two": read_lines(tmp_path, "a.xlsx", workbook({"a": rows, "b": half})),
            "two and words": read_lines(
                tmp_path, "a.xlsx", workbook({"a": rows, "b": half, "c": [["x"]]})
            ),
            "one by name": read_lines(
                tmp_path,
                "a.xlsx",
                workbook({"a": rows, "b": half}),
                profile=TrialsProfile(sheet="b"),
            ),
            "other columns": read_lines(
                tmp_path, "a.xlsx", workbook({"a": rows, "b": [row[:5] for row in half]})
            ),
        },
    )


def test_which_reader_a_file_gets(tmp_path, file_regression):
    heads = {reader.name: reader.marks for reader in READERS}
    texts = {
        "c3d": b"\2P" + bytes(20),
        "c3d by signs": bytes([5, 80, 0, 1]),
        "zip": b"PK\3\4 ",
        "xls": b"\xd0\xcf\x11\xe0",
        "json": b' {"a": 1}',
        "mat": b"MATLAB 5.0 x",
        "hdf": b"\x89HDF ",
        "bsf": b"d\0\0\0",
        "tdms": b"TDSm",
        "datx": b"datx",
        "utf-16": "PathFileType".encode("utf-16"),
        "bvh": b"HIERARCHY\nROOT",
        "anc": b"File_Type: Analog R/C ASCII",
        "v3d": b"a\nITEM\tX",
        "moticon": b"# Moticon x",
        "loadsol": b"novel loadsol",
        "noraxon": b"a\nb\nNoraxon",
        "dot": b"x\nPacketCounter,1",
        "apdm": b"APDM x",
        "skeleton": b"<?xml version='1'?><skeleton>",
        "delsys": b"X [s],EMG 1",
        "devices": b'"Devices",,\n',
        "segments": b"Segments\n",
        "mot": b"x\nendheader\n",
        "stm": b"Test\nSATRA slip\n",
        "cetr": b"a\nb\nc\nCETR x",
        "cetr late": b"a\nb\nc\nd\nCETR x",
        "pedar": b"x\ntime[secs]\t1",
        "nothing": b"1,2\n",
        "sensors": b'"Sensor:","a"\nx\n"Rows:","3"',
        "marked": b"\xef\xbb\xbfNO_OF_FRAMES\t9",
    }
    endings = [
        ".trc",
        ".C3D",
        ".mot",
        ".sto",
        ".forces",
        ".emt",
        ".mvnx",
        ".tdf",
        ".mdf",
        ".hpf",
        ".n3d",
        ".mvn",
        ".xyz",
        ".csv",
        "",
    ]
    unread = [reader for reader in READERS if not reader.address]
    (tmp_path / "many.txt").write_bytes(TEXTS["c.csv"]().encode())
    (tmp_path / "empty.txt").write_bytes(b"")
    many = tmp_path / "many.txt"
    held(
        file_regression,
        {
            "marks": {name: " ".join(marks) for name, marks in heads.items()},
            "endings": trial_suffixes(),
            "by text": {
                said: file_format(data, Path("a.dat")).name for said, data in texts.items()
            },
            "by ending": {
                ending: file_format(b"1,2\n", Path(f"a{ending}")).name for ending in endings
            },
            "not read": {reader.name: refusal(reader.function, None) for reader in unread},
            "nearest": {
                line: nearest_format([line])
                for line in (
                    "No_of_Frame 9",
                    "endheadr",
                    "loadsl x",
                    "Moticom",
                    "room 5",
                    "emgwork=3",
                    "devises",
                )
            },
            "steps": {
                "of two": refusal(read_trial, many),
                "second": read_trial(many, step=2).name,
                "third": refusal(read_trial, many, step=3),
                "none": refusal(read_trial, many, step=0),
                "empty": refusal(read_trial, tmp_path / "empty.txt"),
                "absent": refusal(read_trial, Path("no.txt")),
            },
        },
    )


def test_what_stands_for_a_lost_place(file_regression):
    still = np.tile([0.1, 0.2, 0.3], (60, 1))
    paths = {
        "moving": HEEL,
        "held": np.where((np.abs(TIME - 0.3) < 0.05)[:, None], HEEL[25], HEEL),
        "still": still,
        "coded": np.where((np.abs(TIME - 0.3) < 0.05)[:, None], 999.0, HEEL),
        "far": np.where((np.abs(TIME - 0.3) < 0.05)[:, None], [900.0, 80, 0], HEEL),
        "line": np.array(
            [
                np.interp(TIME, TIME[(TIME < 0.2) | (TIME > 0.4)], p[(TIME < 0.2) | (TIME > 0.4)])
                for p in HEEL.T
            ]
        ).T,
        "short": HEEL[:3],
        "one value": np.full((20, 3), 5.0),
        "held at the start": np.vstack((HEEL[[0] * 9], HEEL)),
        "held at the end": np.vstack((HEEL, HEEL[[-1] * 9])),
        "three places": HEEL.round(2),
        "held twice": np.repeat(HEEL, 2, axis=0),
    }
    forces = {
        "plain": FORCE,
        "coded": np.where((TIME > 0.4)[:, None], 9999.0, FORCE),
        "few": np.where((TIME == 0.3)[:, None], -1e6, FORCE),
        "small": np.where((TIME > 0.4)[:, None], 50.0, FORCE),
    }
    turned = {"a": HEEL, "b": TOE}
    clocks = {
        "each row": turned,
        "ten rows": {n: np.repeat(p, 10, axis=0) for n, p in turned.items()},
        "two rows": {n: np.repeat(p, 2, axis=0) for n, p in turned.items()},
        "uneven": {n: p[np.floor(np.arange(150) / 2.5).astype(int)] for n, p in turned.items()},
        "still": {"a": still},
        "other length": {"a": np.repeat(HEEL, 3, axis=0), "b": HEEL},
        "late": {n: np.repeat(p, 4, axis=0)[2:] for n, p in turned.items()},
        "short": {"a": HEEL[:15]},
        "odd": {n: np.repeat(p, (np.arange(60) * 7 % 5) + 1, axis=0) for n, p in turned.items()},
    }
    held(
        file_regression,
        {
            "paths": {
                f"{said}, {every}": {
                    kind: f"{mask.sum()} from {np.argmax(mask)}"
                    for kind, mask in unseen(path, every_repeat=every).items()
                }
                for said, path in paths.items()
                for every in (False, True)
            },
            "how far is lost": [
                [far for far in np.arange(40.0, 90.0, 0.25) if "sign" in unseen(one(far))]
                for one in (
                    lambda far: np.where((TIME == 0.3)[:, None], [far, 0.1, 0.2], HEEL),
                    lambda far: np.where((TIME == 0.3)[:, None], [far, 0.1, 0.2], HEEL**2),
                )
            ],
            "forces": {said: np.flatnonzero(coded_forces(force)) for said, force in forces.items()},
            "clocks": {said: settled(camera_clock(given)) for said, given in clocks.items()},
            "seen": camera_clock(clocks["late"]).blank_unseen(clocks["late"]["a"]),
        },
    )


def test_lengths_counts_and_channels_of_a_draft(file_regression):
    def draft(**given):
        return RecordingDraft(b"", "a.dat", **given)

    def lengths(scale, names=("LHEE", "LTOE"), apart=1.0):
        made = draft()
        made.rate = 100.0
        for name, path in zip(names, (HEEL, HEEL + apart * (TOE - HEEL)), strict=True):
            made.marker(name, scale * path)
        trial = answer(made.trial, "x")
        return trial if isinstance(trial, str) else [str(note) for note in trial.notes]

    def counted(*args, **options):
        made = draft()
        return [answer(made.count, *args, **options), [str(note) for note in made.notes]]

    def of_length(written, size, stated=None):
        made = draft(profile=TrialsProfile(length_unit=stated))
        return [
            answer(made.length_unit, written, np.full(5, size)),
            made.metres,
            [str(note) for note in made.notes],
        ]

    codes = draft()
    codes.rate = 100.0
    codes.channel("Fz", np.where(TIME > 0.5, 99999.0, LOAD), "N")
    codes.channel("T", 20 + TIME, "degC")
    codes.channel("x", TIME, unit="m", scale=3.0)
    codes.channel("y", TIME, "odd", note="said")
    held(
        file_regression,
        {
            "lengths": {f"{scale:g}": lengths(scale) for scale in (1e-3, 0.1, 1.0, 3.0, 1000.0)},
            "feet": {
                f"{apart:g}": lengths(1.0, apart=apart) for apart in (0.05, 0.4, 3.9, 4.2, 9.0)
            },
            "no feet": lengths(1.0, ("A", "B"), 9.0),
            "of": {
                f"{written} {size:g} {stated}": of_length(written, size, stated)
                for written, size, stated in (
                    ("mm", 5, None),
                    ("", 19, None),
                    ("", 21, None),
                    ("furlong", 5, None),
                    ("metr", 5, None),
                    ("N", 5, None),
                    ("mm", 5, "cm"),
                    ("", 900, "m"),
                    (" ", np.nan, None),
                    ("km", 1, None),
                )
            },
            "counts": [
                counted("60", 60),
                counted("60", 59),
                counted("60", 61),
                counted("x", 5),
                counted("60", 59, "rows"),
                counted("60", 59, "rows", rows=True),
                counted("60", 61, "rows", rows=True),
                counted("", 5),
            ],
            "channels": {
                name: [channel.unit, channel.note, channel.values]
                for name, channel in codes.channels.items()
            },
            "notes": codes.notes,
        },
    )


def test_files_of_curves_and_bytes(tmp_path, file_regression):
    smooth = np.cumsum(np.random.default_rng(3).normal(size=(4, 30)), axis=1)
    texts = {
        "plain.txt": "1 2 3\n1 3 5\n",
        "tabs.txt": "1\t2\n3\t4\n",
        "semicolons.csv": "1,5;2\n3;4\n",
        "commas.csv": "1,2,3\n4,5,7\n",
        "decimal.txt": "1,5 2,5\n3,5 4,5\n",
        "uneven.txt": "1 2\n3\n",
        "words.txt": "1 x\n3 4\n",
        "empty.txt": "\n\n",
        "notes.txt": "# a\n1 2\n\n3 4\n",
        "one.txt": "1\n2\n3\n",
        "thousands.csv": "1.234,5;2\n1,5;3\n",
    }
    for name, text in texts.items():
        (tmp_path / name).write_text(text)
    np.save(tmp_path / "a.npy", smooth)
    np.save(tmp_path / "turned.npy", smooth.T)
    np.save(tmp_path / "line.npy", smooth[0])
    np.save(tmp_path / "text.npy", np.array(["a", "b"]))
    np.savez(tmp_path / "b.npz", one=smooth, two=np.ones((2, 3, 4)), three=np.arange(3))
    (tmp_path / "bad.npy").write_bytes(b"x")
    (tmp_path / "bad.npz").write_bytes(b"PK\3\4 x")
    names = [*texts, *(path.name for path in sorted(tmp_path.glob("*.np*")))]
    data = FileBytes(tmp_path / "plain.txt")
    parts = [len(data), data[0], data[3], data[2:5], data[:2], data[4:], data[2:2], data[90:95]]
    data.close()
    held(
        file_regression,
        {
            "curves": {name: answer(read_curves, tmp_path / name) for name in names},
            "absent": refusal(read_curves, tmp_path / "no.txt"),
            "bytes": parts,
        },
    )


ARRAYS = {
    "the walk": {
        "time": TIME,
        "Force1": FORCE,
        "LHEE": 1e3 * HEEL,
        "who": "Anna",
        "short": TIME[:9],
    },
    "turned": {"fs": np.array(200.0), "grf": FORCE.T, "a": {"LTOE": TOE.T}, "x": TIME},
    "no arrays": {"fs": np.array(5.0)},
    "structure": {
        "walk": {
            "FrameRate": 100.0,
            "Trajectories": {
                "Labeled": {
                    "Labels": np.array(["LHEE", "LTOE"], dtype=object),
                    "Data": 1e3 * np.stack((HEEL.T, TOE.T)),
                }
            },
            "Force": [
                {
                    "Frequency": 200.0,
                    "Force": FORCE.T,
                    "COP": 1e3 * HEEL.T,
                    "ForcePlateLocation": 1e3
                    * np.array([[0.6, 0.4, 0], [0, 0.4, 0], [0, 0, 0], [0.6, 0, 0]]),
                },
                {"Frequency": 200.0, "Force": FORCE, "COP": HEEL},
                {"Frequency": 9.0, "Force": []},
            ],
        }
    },
    "one marker": {
        "walk": {
            "FrameRate": 50,
            "Trajectories": {"Labeled": {"Labels": "LHEE", "Data": 1e3 * HEEL.T}},
        }
    },
    "nothing inside": {"walk": {"Force": []}},
}


def test_arrays_of_matlab(tmp_path, file_regression, monkeypatch):
    answers = {}
    for said, content in ARRAYS.items():
        # a process of its own reads the file: its content is what counts here
        monkeypatch.setattr("underfoot.trials.readers.matlab._content", lambda *_, c=content: c)
        answers[said] = read_lines(tmp_path, "a.mat", b"MATLAB 5.0")
    held(file_regression, answers)
