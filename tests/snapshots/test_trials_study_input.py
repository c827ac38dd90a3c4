"""What studies are given: folders, conditions, sheets, edits, plans; and what is doubted.

Of ``underfoot.trials.study.conditions``.
"""

from dataclasses import replace
from functools import cache
from types import MappingProxyType

import numpy as np
import pytest

import trial_studies as made
from snapshot import held, refusal, tried
from underfoot.trials.readers.profile import TrialsProfile
from underfoot.trials.recording import protocols
from underfoot.trials.recording.axes import axes_of
from underfoot.trials.recording.plates import finished_plate
from underfoot.trials.recording.trial import Channel, Edit, Marker, Trial
from underfoot.trials.simulator.folder import ScanTruth as Scanned
from underfoot.trials.simulator.folder import disk_run, relaxation, scan_columns, slip_truth
from underfoot.trials.simulator.walk import SENSORS, Defects, SlipTruth, walk_with_slip
from underfoot.trials.study import condition_table
from underfoot.trials.study import conditions as noted
from underfoot.trials.study.boundary import alpha_beta, friction_split
from underfoot.trials.study.edit_table import (
    edit_from,
    edit_log,
    edit_rows,
    edit_text,
    edits_of,
    with_edit_row,
    write_edit_text,
)
from underfoot.trials.study.export import c3d_with_events, mot_text, trc_text
from underfoot.trials.study.file_result import FileResult, FileResultDraft, StepResult
from underfoot.trials.study.floor_classes import SCHEMES, class_scheme, cof_of_pendulum
from underfoot.trials.study.folder import analyse_folder, recording_results
from underfoot.trials.study.model_scripts import model_files
from underfoot.trials.study.person_measures import person_measures
from underfoot.trials.study.readings import board_correction, reading_results
from underfoot.trials.study.record_signals import Signal, record_signals
from underfoot.trials.study.run_sheet import checked_suffix, factors_from, run_sheet
from underfoot.trials.study.steps import (
    analysed_trial,
    check_ramp,
    protocol_ramp,
    rcof_definition,
    slip_definition,
)
from underfoot.trials.study.study import study_of
from underfoot.trials.study.study_guard import guarded_files, study_doubts
from underfoot.trials.walking.events import stances
from underfoot.trials.walking.walkway import walkway_of
from walk_forms import walk

protocol = cache(protocols.protocol)
UP = np.array([0.0, 0.0, 1.0])


def written(folder, files):
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")
    return folder


TABLES = {
    "plain": "file,shoe,mass (kg),speed (m/s)\na.csv,x,70,1.2\nb.csv,y,80.5,\n",
    "german": "Datei;Schuh;Körpergröße (cm);Gewicht (kg);Datum\na.csv;x;170,5;70,1;5.3.2026\n"
    "b.csv;y;181;80;n/a\n",
    "codes": "file,floor,size,order\na,1,42,1\nb,2,43,2\nc,1,42,3\nd,2,43,4\n",
    "units": "file,viscosity (cP),thickness (mm),area (mm^2),hardness (Shore A),temp (°C)\n"
    "a,41,5.5,161,60,20\n",
    "quantities": "file,viscosity,speed\na,41 cP,0.3 m/s\nb,0.1 Pa*s,\n",
    "empty cells": "file,shoe\na,?\nb,-\n",
    "angle": "file,angle (deg),ptv,cof\na,12,36,0.3\n",
    "no unit": "file,viscosity\na,41\n",
    "wrong unit": "file,mass (m)\na,70\n",
    "out of range": "file,mass\na,7000\n",
    "high cof": "file,cof\na,30\n",
    "text number": "file,mass (kg)\na,heavy\n",
    "no file": "shoe\nx\n",
    "twice": "file,shoe\na,x\na,y\n",
    "two columns": "file,Shoe,shoe\na,x,y\n",
    "long row": "file,shoe\na,0,45\n",
    "no rows": "file,shoe\n",
    "nothing": "",
    "steep": "file,angle (rad)\na,1.2\n",
    "many codes": "file,kind\n" + "".join(f"f{i},{i % 8}\n" for i in range(16)),
    "broken codes": "file,kind\n" + "".join(f"f{i},{i % 2 + 0.5}\n" for i in range(4)),
    "coded persons": "file,subject,kind\n" + "".join(f"f{i},S{i // 2},{i % 2}\n" for i in range(4)),
}


def test_tables_of_conditions(file_regression, tmp_path):
    found = {}
    for name, text in TABLES.items():
        path = tmp_path / "conditions.csv"
        path.write_text(text, encoding="utf-8")
        found[name] = tried(noted.conditions_of, tmp_path)
    path.unlink()
    labels = ["a/one.c3d", "b/one.c3d", "two.csv", "a/three.trc"]
    held(
        file_regression,
        {
            **found,
            "none": noted.conditions_of(tmp_path),
            "missing": refusal(noted.conditions_of, tmp_path, tmp_path / "no.csv").replace(
                str(tmp_path), "PLACE"
            ),
            "named": {
                name: tried(noted.named_file, name, labels, below)
                for name, below in (
                    ("a/one.c3d", "."),
                    ("one.c3d", "a"),
                    ("ONE.c3d", "B"),
                    ("one", "."),
                    ("Two", ""),
                    ("x", "."),
                    ("a\\three.trc", "."),
                    ("three.trc", "b"),
                )
            },
            "spelling": [
                noted.plain_spelling(x, person=p)
                for x, p in (
                    ("S 007", True),
                    ("VP03b", True),
                    ("Größe_Ø-å", False),
                    ("s01", False),
                    ("0,05", False),
                    ("person12", True),
                    ("007", False),
                    ("日本", False),
                )
            ],
            "delimiter": [condition_table.table_delimiter(x) for x in ("a,b;c;d", "a\tb", "a")],
            "mass": [
                noted.body_mass_noted(x)
                for x in ({"mass": 70.0}, {"weight": 60.0}, {"mass": "x"}, {})
            ],
            "person": [
                noted.person_condition([FileResult("a", conditions=x)], p)
                for x, p in (
                    ({"subject": "a", "vp": "b"}, ""),
                    ({"walker": "a"}, "walker"),
                    ({}, ""),
                )
            ],
        },
    )


FOLDERS = {
    "flat": ({"a.csv": "x", "b.c3d": "", "photo.jpg": "", "notes.txt": "", "truth.csv": ""}, {}),
    "persons": ({"S01/x/a.csv": "", "S02/y/b.csv": "", ".hidden/c.csv": ""}, {}),
    "one person": ({"S01/a.csv": "", "S01/b.csv": ""}, {}),
    "partners": (
        {"MarkerData/a.trc": "", "a.mot": "", "b.trc": "", "b.forces": "", "c.mot": ""},
        {},
    ),
    "report": ({"a.csv": "", "out/analysis.txt": "", "out/b.csv": ""}, {}),
    "session": (
        {"s/sessionMetadata.yaml": "subjectID: 'Anna'\nmass_kg: 60.5 # kg\n", "s/a.trc": ""},
        {},
    ),
    "names": (
        {"S1_soft_1.csv": "", "S2_hard_1.csv": ""},
        {"names": r"S(?P<subject>\d+)_(?P<shoe>[a-z]+)_(?P<n>\d+)"},
    ),
    "wrong names": ({"S1_soft.csv": "", "other.csv": ""}, {"names": r"S(?P<subject>\d+)"}),
    "no group": ({"a.csv": ""}, {"names": "a"}),
    "no pattern": ({"a.csv": ""}, {"names": "("}),
    "spelling": (
        {
            "a.csv": "",
            "b.csv": "",
            "c.csv": "",
            "conditions.csv": "file,shoe\na,Big Shoe\nb,big_shoe\nc,Big Shoe\n",
        },
        {},
    ),
    "merged": (
        {
            "a.csv": "",
            "b.csv": "",
            "c.csv": "",
            "conditions.csv": "file,shoe\na,Big Shoe\nb,big_shoe\nc,Big Shoe\n",
        },
        {"merge_spelling": True},
    ),
    "conflict": ({"S01/a.csv": "", "S02/b.csv": "", "conditions.csv": "file,subject\na,S03\n"}, {}),
    "absent": ({"a.csv": "", "conditions.csv": "file,shoe\na,x\nb,y\n"}, {}),
    "all absent": ({"a.csv": "", "conditions.csv": "file,shoe\nb,y\nc,z\n"}, {}),
    "empty": ({"x.jpg": ""}, {}),
    "below": ({"d/a.csv": "", "d/conditions.csv": "file,shoe\na,x\n", "b.csv": ""}, {}),
}


def test_folders(file_regression, tmp_path):
    def told(name):
        files, options = FOLDERS[name]
        folder = written(tmp_path / name, files)
        found = tried(noted.study_folder, folder, **options)
        if isinstance(found, str):
            return found.replace(str(tmp_path), "PLACE")
        return {
            "notes": found.notes,
            **{one.name: [[p.name for p in one.paths], one.conditions] for one in found.recordings},
        }

    missing = refusal(noted.study_folder, tmp_path / "no").replace(str(tmp_path), "PLACE")
    held(file_regression, {**{name: told(name) for name in FOLDERS}, "missing": missing})


PTV = "slider,condition,direction,ptv\n"
SHEETS = {
    "pendulum": (
        "en_16165_pendulum",
        PTV
        + "".join(f"96,wet,along,{v}\n" for v in (45, 42, 41, 36, 36, 37, 36, 36))
        + "".join(f"96,wet,across,{v}\n" for v in (30, 31, 30, 30, 31)),
    ),
    "pendulum with checks": (
        "en_16165_pendulum",
        "run,slider,condition,direction,PTV\n"
        + "".join(
            f"{run},{slider},wet,along,{v}\n"
            for run, slider, v in (
                ("zero", "96", 2),
                ("zero", "96", 1),
                ("conditioning", "96", 50),
                ("", "96", 40),
                ("", "96", 41),
                ("", "96", 40),
                ("", "96", 42),
                ("", "96", 40),
                ("check glass", "96", 8),
                ("check lapping film", "96", 66),
            )
        ),
    ),
    "pendulum, check passed": (
        "en_16165_pendulum",
        "run,slider,ptv\ncheck glass,Four S,7\ncheck pavigr,55,15\n"
        + "".join(f",four-s,{v}\n" for v in (25, 25, 25, 25, 25)),
    ),
    "unknown surface": ("en_16165_pendulum", "run,slider,ptv\ncheck wood,96,7\n,96,40\n"),
    "unknown slider": ("en_16165_pendulum", "run,slider,ptv\ncheck glass,12,7\n,12,40\n,12,41\n"),
    "as a coefficient": ("en_16165_pendulum", PTV + "96,wet,along,0.4\n96,wet,along,0.41\n"),
    "wide": (
        "en_16165_pendulum",
        "slider,condition,direction,swing 1,swing 2,swing 3,mean\n"
        "96,wet,along,30,36,33,33\n96,dry,along,50,51,52,51\n",
    ),
    "ramp": (
        "en_16165_shod_ramp",
        "sample,operator,angle\n"
        + "".join(
            f"T,{who},{v}\n"
            for who, values in (("A", (18, 19, 18.5)), ("B", (20, 21, 20.5)))
            for v in values
        ),
    ),
    "ramp with boards": (
        "en_16165_shod_ramp",
        "sample;Prüfperson;Winkel;Sollwinkel\n"
        + "".join(
            f"{sample};{who};{v};{board}\n"
            for sample, who, v, board in (
                ("P", "A", "8,5", "8"),
                ("P", "A", "8,7", "8"),
                ("P", "A", "21", "20"),
                ("P", "B", "7,5", "8"),
                ("P", "B", "19", "20"),
                ("T", "A", "11", ""),
                ("T", "A", "11,4", ""),
                ("T", "A", "11,2", ""),
                ("T", "B", "9,5", ""),
                ("T", "B", "9,8", ""),
                ("T", "B", "9,6", ""),
            )
        ),
    ),
    "boards without walkers": ("en_16165_shod_ramp", "sample,angle,standard angle\nT,11,\nP,8,8\n"),
    "radians": ("en_16165_shod_ramp", "operator,angle\nA,0.3\nA,0.31\nA,0.3\n"),
    "in radians": ("en_16165_barefoot_ramp", "operator,angle (rad)\nA,0.3\nA,0.31\nA,0.3\n"),
    "one walker": ("en_16165_barefoot_ramp", "operator,angle\nA,17.9\nA,18.2\n"),
    "laboratories": (
        "machine_cof",
        "floor,laboratory,cof\n"
        + "".join(
            f"F{f},{lab},{0.3 + 0.1 * f + 0.02 * k + 0.01 * r:.3f}\n"
            for f in range(4)
            for k, lab in enumerate(("A", "B", "C"))
            for r in range(2)
        ),
    ),
    "operators": (
        "ansi_a326_3",
        "floor;Prüfer;condition;DCOF\n"
        + "".join(
            f"F{f};{who};wet;{0.4 + 0.05 * f + 0.01 * k + 0.004 * r + 0.003 * (f * k % 2):.3f}\n"
            for f in range(3)
            for k, who in enumerate(("A", "B"))
            for r in range(3)
        ),
    ),
    "dry": (
        "ansi_a326_3",
        "condition,direction,cof\n"
        + "".join(f"dry,{d},{v}\n" for d, v in (("n", 0.41), ("n", 0.43), ("e", 0.5), ("e", 0.52))),
    ),
    "percent": ("machine_cof", "cof (%)\n30\n31\n"),
    "equal": ("en_16165_tribometer", "cof\n0.44\n0.44\n0.46\n0.46\n0.44\n"),
    "single": ("en_16165_tribometer", "cof\n0.3\n"),
    "high": ("machine_cof", "cof\n1.3\n1.4\n"),
    "falling": ("machine_cof", "cof\n" + "".join(f"{0.5 - 0.02 * i}\n" for i in range(6))),
    "negative": ("machine_cof", "cof\n-0.1\n-0.2\n"),
    "too high": ("machine_cof", "cof\n3.5\n"),
    "zero": ("machine_cof", "run,cof\nzero,0.2\n,0.1\n,0.12\n"),
    "no readings": ("machine_cof", "run,cof\nzero,0.2\n"),
    "two columns": ("machine_cof", "cof,friction\n0.2,0.3\n"),
    "no column": ("machine_cof", "floor,x\na,b\n"),
    "a word": ("machine_cof", "floor,cof\na,0.2\nb,wet\n"),
    "another unit": ("machine_cof", "cof (N)\n2\n"),
    "angles for cof": ("machine_cof", "angle\n12\n13\n"),
    "beside": ("machine_cof", "floor,1,2,3,mean\na,0.2,0.21,0.22,0.21\n"),
    "summary": ("machine_cof", "floor,cof\na,0.2\nmean,0.2\n"),
    "coded": ("machine_cof", "floor,cof\n1,0.2\n1,0.21\n2,0.3\n2,0.31\n"),
    "remarks": ("machine_cof", "floor,remarks,cof\na,,0.2\na,windy,0.21\n"),
}


def sample_of(one):
    return {
        "is": f"{one.file} {one.verdict} {one.sample.scheme}",
        "conditions": one.conditions,
        "reasons": one.reasons,
        "numbers": [
            (m.name, m.value, m.uncertainty, m.spread, m.n, m.reason) for m in one.measurements
        ],
        "conventions": [m.conventions for m in one.measurements],
        "readings": list(one.sample.readings),
        "boards": one.sample.boards,
    }


@pytest.mark.parametrize("part", range(3))
def test_sheets_of_readings(file_regression, tmp_path, part):
    found = {}
    for name in list(SHEETS)[part::3]:
        way, text = SHEETS[name]
        path = tmp_path / "sheet.csv"
        path.write_text(text, encoding="utf-8")
        results = tried(reading_results, "sheet.csv", path, "sum", {"who": "me"}, protocol(way))
        if isinstance(results, str):
            found[name] = results
            continue
        study = study_of(results, protocol(way))
        rows = {t.name: [list(t.columns), *t.rows[:5], *t.notes[:4]] for t in study.tables}
        rows |= {
            f.name: [*f.table.rows[:4], *f.table.notes[-1:], *f.cautions] for f in study.findings
        }
        doubts = [str(one) for one in study_doubts(results, protocol(way))]
        found[name] = {
            "samples": list(map(sample_of, results))[:3],
            "count": len(results),
            "rows": rows,
            "notes": study.notes,
            "doubts": doubts,
        }
    held(file_regression, found, f"readings_{part}")


def test_small_parts(file_regression):
    lines = ([(8.0, 8.5, 0.1), (20.0, 21.0, 0.2)], 14.0, 0.5)
    forces = {
        "dry": [10.0, 11.0],
        "blocked": [2.0, 2.5],
        "lubricated": {"water": [5.0, 6.0], "soap": [1.0]},
    }
    split = friction_split(**forces)
    fluids = ["a", "a", "a", "b", "b", "b"]
    fit = alpha_beta(fluids, [1.0, 2.0, 3.0, 1.0, 2.0, 3.0], [0.6, 1.1, 1.7, 0.2, 0.35, 0.5])
    held(
        file_regression,
        {
            "schemes": SCHEMES,
            "standing": {n: s.standing() for n, s in SCHEMES.items()},
            "classes": {
                n: [
                    s.class_of(v)
                    for limit, _ in s.limits
                    for v in (limit - 0.51, limit - 0.49, limit, limit + 0.01)
                ]
                + [s.class_of(-5.0)]
                for n, s in SCHEMES.items()
            },
            "dry": [
                class_scheme("ansi_a326_3", dry=True).name,
                class_scheme("din_51130", dry=True).name,
            ],
            "cof": [cof_of_pendulum(36.0, 2.0), cof_of_pendulum(0.0)],
            "boards": [
                board_correction(lines[1], *x)
                for x in ((lines[0], 0.5), (lines[0], 1.0), ((), 0.5), (lines[0][:1], 1.0))
            ],
            "split": split,
            "alone": friction_split([10.0], [2.0]),
            "fit": [
                fit.fluids,
                fit["b"],
                fit.comparisons,
                fit.mean_absolute_residual,
                fit.type_two.rows,
            ],
            "refused": [
                refusal(class_scheme, "din"),
                refusal(friction_split, [], [1.0]),
                refusal(friction_split, [np.nan], [1.0]),
                refusal(alpha_beta, fluids, [1.0] * 6, [1.0] * 6),
            ],
        },
    )


def test_run_sheets(file_regression):
    factors = factors_from(["shoe=A, B", "floor=wet,dry,"])
    sheet = run_sheet(factors, repeats=2, seed=3)
    held(
        file_regression,
        {
            "factors": factors,
            "sheet": sheet,
            "csv": sheet.csv_text(),
            "other": sheet.csv_text(".c3d"),
            "blocks": run_sheet(factors, repeats=2, blocks="shoe", seed=1).csv_text(),
            "together": run_sheet(factors, repeats=2, together="floor", seed=2).csv_text(),
            "both": run_sheet(
                {"shoe": ["A", "B", "C"], "floor": ["x", "y"]},
                repeats=4,
                blocks="repeat",
                together="shoe",
            ).csv_text(),
            "suffixes": [checked_suffix(x) for x in ("c3d", ".CSV", " trc")],
            "refused": [
                *(refusal(factors_from, x) for x in (["shoe"], ["=A"], ["a=1,2", "a=3,4"])),
                *(
                    refusal(run_sheet, f, **o)
                    for f, o in (
                        ({"run": ["a", "b"]}, {}),
                        ({"shoe": ["a"]}, {}),
                        ({"shoe": ["a", "a"]}, {}),
                        ({}, {}),
                        (factors, {"repeats": 0}),
                        (factors, {"blocks": "x"}),
                        (factors, {"together": "x"}),
                        (factors, {"repeats": 2501}),
                    )
                ),
                refusal(checked_suffix, "jpg"),
            ],
            "most": len(run_sheet(factors, repeats=2500).runs),
        },
    )


def test_edit_tables(file_regression, tmp_path):
    labels = ["a.c3d", "b.c3d"]
    text = "file,step,edit,value (s),why\na,1,contact,0.5,late\nb.c3d,1.2 s,toe off,1.5 s,early\n"
    text += "a,2,side,Left,seen\n"
    written(tmp_path, {"edits.csv": text})
    wrong = {
        "column": "file,step\na,1\n",
        "file": text + "c,1,exclude,,why\n",
        "time": text + "a,x,exclude,,why\n",
        "value": text + "a,1,contact,soon,why\n",
        "edit": text + "a,1,move,,why\n",
        "why": text + "a,1,exclude,,\n",
        "unit": text + "a,1,contact,3 kg,why\n",
    }
    rows = edit_rows(tmp_path, labels)
    before = [
        StepResult(number=1, item="step 1", contact=0.4, toe_off=1.0, rcof=0.2, side="left"),
        StepResult(
            number=2,
            item="step 2",
            contact=1.3,
            rcof=0.1,
            judged_for_slip=True,
            peak_slipping_speed=0.3,
        ),
    ]
    after = [
        replace(before[0], contact=0.5, rcof=0.21, toe_off=1.1, side="right"),
        replace(before[1], reason="excluded by hand", peak_slipping_speed=None),
    ]
    logged = [
        Edit(1, "contact", 0.5, "a"),
        Edit(1.25, "exclude", None, "b"),
        Edit(1, "toe off", 1.1, "c"),
        Edit(1, "side", "right", "d"),
    ]
    kept = edit_text(tmp_path)
    write_edit_text(tmp_path, with_edit_row(kept, ("b", "2", "exclude", "", "x, y"), without=(2,)))
    rewritten = (tmp_path / "edits.csv").read_text(encoding="utf-8")
    write_edit_text(tmp_path, "")
    found = {
        "gone": (tmp_path / "edits.csv").exists(),
        "none": [edit_text(tmp_path), edits_of(tmp_path, labels)],
    }
    for name, one in wrong.items():
        written(tmp_path, {"edits.csv": one})
        found[name] = refusal(edits_of, tmp_path, labels)
    written(tmp_path, {"edits.csv": wrong["file"]})
    found["others"] = {k: len(v) for k, v in edits_of(tmp_path, labels, others=True).items()}
    (tmp_path / "edits.csv").unlink()
    written(tmp_path, {"edits.xlsx": ""})
    held(
        file_regression,
        {
            "rows": rows,
            "log": edit_log(logged, before, after),
            "rewritten": rewritten,
            **found,
            "workbook": refusal(edit_text, tmp_path),
            "new": with_edit_row("", ("a", "1", "exclude", "", "w")),
            "semicolons": with_edit_row(
                "file;why;step;edit;value\na;w;1;exclude;", ("a", "2", "exclude", "", "w")
            ),
            "one": [
                edit_from("1", " Exclude ", "", "w", "here"),
                edit_from("1.5 s", "toe off", "2", "w", "here", "s"),
            ],
        },
    )


def test_model_files(file_regression):
    class Model:
        variances = MappingProxyType({"person": 0.1, "person:my shoe": np.nan, "trial": -0.1})
        design = type("D", (), {"terms": ("my shoe", "floor", "my shoe:floor")})

    held(
        file_regression,
        model_files(
            "m",
            "A title",
            Model,
            "RCOF",
            [0.1, 0.2],
            {"my shoe": ["a", "b"], "floor": ["x", "y"], "1 my shoe": ["c", "d"]},
            ["p", "q"],
        ),
    )


def slider(**truth):
    columns = scan_columns(Scanned(rise=0.1, **truth), 0.0, np.random.default_rng(3))
    force = np.column_stack([columns[f"F{axis} (N)"] for axis in "xyz"])
    path = 1e-3 * np.column_stack([columns[f"heel_{axis} (mm)"] for axis in "xyz"])
    channels = {"p": Channel(1e3 * columns["pressure (kPa)"], "Pa", 1000.0)}
    plate = finished_plate("plate", force, rate=1000.0, up=UP)
    return Trial("tester", channels, (plate,), {"heel": Marker(path, 1000.0)})


@cache
def slipper(number=1):
    truth, defects, _ = slip_truth(number, 3) if number else (SlipTruth(), Defects(), {})
    made_up = walk_with_slip(
        truth, replace(defects, dropped_samples=3), np.random.default_rng(1), duration=3.6
    )
    plates = [
        finished_plate(
            f"plate {i}", f, rate=1000.0, up=UP, corners=c, moment=np.cross(p - c.mean(axis=0), f)
        )
        for i, (f, p, c) in enumerate(
            zip(made_up.force, made_up.centre, made_up.corners, strict=True), 1
        )
    ]
    markers = {name: Marker(p, 200.0) for name, p in made_up.markers.items()}
    channels = {n: Channel(v, "Pa", 1000.0) for n, v in made_up.pressures.items()}
    return Trial(
        "slip",
        channels,
        tuple(plates),
        markers,
        settings={"software": "underfoot trials simulate", "body mass (kg)": "70"},
    )


def pin():
    columns = disk_run(0.3, 0.5, np.random.default_rng(4))
    units = {"normal force (N)": "N", "friction force (N)": "N", "sliding speed (m/s)": "m/s"}
    return Trial(
        "pin", {n.partition(" (")[0]: Channel(columns[n], u, 100.0) for n, u in units.items()}
    )


def block():
    columns = {name: values[::10] for name, values in relaxation(np.random.default_rng(5)).items()}
    return Trial(
        "block",
        {
            "force": Channel(columns["force (N)"], "N", 5.0),
            "displacement": Channel(1e-3 * columns["displacement (mm)"], "m", 5.0),
        },
    )


def finished(trial, way, conditions=None, profile=None, **settings):
    chosen = protocol(way).with_settings(settings)
    draft = FileResultDraft("one", conditions or {})
    try:
        analysed_trial(trial, draft, chosen, profile or TrialsProfile(vertical="+z"))
    except Exception as error:  # which one is held
        return f"{type(error).__name__}: {error}"
    one = draft.finish_result(chosen)
    return {
        "is": f"{one.verdict} {list(one.reasons)}"[:600],
        "kinds": one.kinds,
        "main": one.main,
        "facts": one.facts,
        "numbers": [
            f"{m.item} | {m.name} {m.unit} {m.value and f'{m.value:.5g}'} {m.reason}"
            for m in one.measurements
        ],
        "steps": [
            f"{s.item} {s.verdict} {s.side} {s.reason} {s.outcome} {s.slip_direction} {s.by_hand} "
            f"{s.recovery_or_fall} {s.misstep}"
            for s in one.steps
        ],
        "edits": one.edits,
        "curves": {
            k: v if isinstance(v, dict) else {x: y for x, y in v[0].items() if x != "pulses"}
            for k, v in one.curves.items()
        },
        "body": dict(list(one.body.items())[:3]),
        "pulses": one.curves.get("track", [{}])[0].get("pulses", [])[:2],
    }


def test_analysed_trials(file_regression):
    scan = replace(TrialsProfile(), sensors={"p": (0.3, 0.0, 0.0)}, vertical="+z")
    first = stances(walkway_of(walk()))[0]
    edited = walk().with_edits(
        Edit(1, "contact", first.contact + 0.02, "late"), Edit(2, "exclude", None, "no")
    )
    held(
        file_regression,
        {
            "tester": finished(slider(), "report_g4", profile=scan),
            "no sensor": finished(slider(), "report_g4")["kinds"],
            "sensor beside": finished(
                slider(), "report_g4", profile=replace(scan, sensors={"p": (9.0, 0, 0)})
            )["is"],
            "excluded": finished(slider().with_edits(Edit(1, "exclude", None, "bad")), "report_g4")[
                "edits"
            ],
            "pin": finished(pin(), "report_g2", {"speed": 0.51}),
            "another speed": finished(pin(), "report_g2", {"speed": 0.8})["is"],
            "boundary": finished(pin(), "report_g3")["main"],
            "block": finished(
                block(), "report_g1_relaxation", {"thickness": 0.0055, "area": 1.61e-4}
            ),
            "without an area": finished(block(), "report_g1_relaxation", {"thickness": 0.0055})[
                "numbers"
            ],
            "without a thickness": finished(block(), "report_g1_relaxation"),
            "walk": finished(walk(), "level_walking"),
            "edited": {
                k: v
                for k, v in finished(edited, "level_walking").items()
                if k in ("is", "steps", "edits", "main")
            },
            "a walk as a slide": finished(walk(), "en_iso_13287"),
            "a slide as a walk": finished(slider(), "level_walking"),
            "nothing": finished(Trial("empty"), "level_walking"),
        },
    )


def test_analysed_slips(file_regression):
    sensors = replace(TrialsProfile(), sensors=dict(SENSORS), walking="+x", vertical="+z")
    slipped = [slipper(n) for n in (0, 3)]
    brief = ("is", "steps", "main")
    held(
        file_regression,
        {
            "sensors": finished(slipped[0], "report_g5", {"acof": 0.1}, sensors),
            "other": {
                k: v
                for k, v in finished(slipped[1], "report_g6", {"side": "right"}).items()
                if k in brief
            },
            "far sensors": finished(
                slipped[0], "report_g5", profile=replace(sensors, sensors={"Q": (0.0, 0, 0)})
            )["is"],
            "no plate": finished(slipped[0], "report_g6", {"slip plate": "plate 9"}),
            "first plate": {
                k: v
                for k, v in finished(slipped[0], "report_g6", {"slip plate": "plate 1"}).items()
                if k in brief
            },
            "excluded": {
                k: v
                for k, v in finished(
                    slipped[0].with_edits(Edit(2, "exclude", None, "x")), "report_g6"
                ).items()
                if k in (*brief, "edits")
            },
            "limits": finished(
                slipped[0],
                "report_g6",
                no_slip_distance="1 mm",
                microslip_distance="400 mm",
                slide_distance="2 m",
                slip_threshold="5 m/s",
            )["steps"],
        },
    )


def test_settings_of_protocols(file_regression):
    way = protocol("level_walking")
    own = {
        "definition": "peak-3",
        "rcof_gate": "80 N",
        "rcof_shear": "anterior-posterior",
        "rcof_part": 0.4,
        "rcof_braking": "no",
        "rcof_gate_body_weight": "10 %",
        "rcof_filter": "none",
    }
    held(
        file_regression,
        {
            "default": rcof_definition(way),
            "own": rcof_definition(way.with_settings(own)),
            "slip": [
                slip_definition(way),
                slip_definition(
                    way.with_settings({"slip_threshold": "0.5 m/s", "marker_cutoff": "6 Hz"})
                ),
            ],
            "braking": [
                rcof_definition(way.with_settings({"rcof_braking": x})).braking
                for x in ("true", "Yes", "1", "no", True)
            ],
            "ramp": [
                protocol_ramp(way),
                protocol_ramp(way.with_settings({"ramp": "5 deg", "plate_frame": "surface"})),
            ],
            "refused": [
                refusal(rcof_definition, way.with_settings({"rcof_gat": "1 N"})),
                refusal(rcof_definition, way.with_settings({"definition": "x"})),
                refusal(check_ramp, protocol("report_g2").with_settings({"ramp": "5 deg"})),
                refusal(check_ramp, way.with_settings({"ramp": "5 deg"})),
            ],
        },
    )


def test_exports_and_signals(file_regression):
    whole, trial = walk(), slipper(0)
    bare = replace(
        whole, plates=tuple(replace(p, moment=None) for p in whole.plates[:1]), markers={}
    )
    down = replace(trial, vertical=None, plates=trial.plates[1:])
    from underfoot.trials.recording.trial import Vertical

    turned = [
        replace(whole, vertical=Vertical(v, "x"))
        for v in ((0.0, 0.0, 1.0), (0.0, -1.0, 0.0), (1.0, 0, 0))
    ]
    signals = record_signals(whole, protocol("level_walking"), TrialsProfile())
    one = signals.force["plate 1"]
    odd = replace(whole, plates=(whole.plates[0], replace(whole.plates[1], rate=500.0)))
    held(
        file_regression,
        {
            "c3d": [len(c3d_with_events(t, stances(walkway_of(t)))) for t in (whole, bare)],
            "trc": [trc_text(t).splitlines()[:9] for t in turned],
            "trc end": trc_text(trial).splitlines()[-1],
            "mot": [
                mot_text(t).splitlines()[:7] + mot_text(t).splitlines()[700:702]
                for t in (turned[1], bare, down)
            ],
            "signals": {
                k: (s.name, s.rate, s.start, s.end, s.values)
                for k, s in {
                    **signals.force,
                    **{f"heel {k}": v for k, v in signals.heel_speed.items()},
                }.items()
            },
            "envelopes": [
                one.envelope(*x)
                for x in ((0.0, 1.0, 10), (-1.0, 0.1, 4), (5.0, 6.0, 4), (0.5, 0.502, 99))
            ],
            "of nan": Signal("x", np.array([1.0, np.nan, 3.0, 2.0]), 2.0, 1.0).envelope(
                1.0, 9.0, 2
            ),
            "body": person_measures(whole, stances(walkway_of(whole)), axes_of(whole)),
            "no body": person_measures(bare, [], axes_of(bare)),
            "refused": [
                refusal(f, t)
                for f, t in (
                    (trc_text, bare),
                    (mot_text, replace(whole, plates=())),
                    (mot_text, odd),
                )
            ]
            + [refusal(c3d_with_events, Trial("e"), [])],
        },
    )


def test_folder_of_readings(file_regression, tmp_path):
    text = "floor,cof\na,0.2\na,0.21\n"
    folder = written(
        tmp_path / "study",
        {
            "one.csv": text,
            "two.csv": "floor,cof\nb,0.3\nb,0.31\n",
            "bad.csv": "words\n",
            "conditions.csv": "file,machine,date\none,M1,2026-03-05\ntwo,M1,2026-03-06\n",
            "edits.csv": "file,step,edit,value,why\n",
            "calibration.toml": '[tester]\ndate = "2026-03-01"\nvalid_until = "2026-03-05"\n',
        },
    )
    store = tmp_path / "store"
    told = []
    one = analyse_folder(
        folder,
        protocol("machine_cof"),
        store=store,
        processes=1,
        progress=lambda s, x, r=None: told.append((s, round(x, 3))),
    )
    again = analyse_folder(folder, protocol("machine_cof"), store=store, processes=1)
    held(
        file_regression,
        {
            "files": [sample_of(f) for f in one.files],
            "notes": one.notes,
            "doubts": [str(d) for d in one.doubts],
            "tables": [t.name for t in one.tables],
            "told": told[-1],
            "stored": len(list(store.glob("*.json"))),
            "same": again.files == one.files,
            "single": [
                f.main for f in recording_results(folder, "one.csv", protocol("machine_cof"))
            ],
            "refused": refusal(
                recording_results, folder, "on.csv", protocol("machine_cof")
            ).replace(str(tmp_path), "PLACE"),
        },
    )


def _with(files, change):
    return [replace(f, conditions=change(i, dict(f.conditions))) for i, f in enumerate(files)]


def _steps(files, change):
    return [replace(f, steps=tuple(change(i, s) for s in f.steps)) for i, f in enumerate(files)]


def _main(files, change):
    return [
        replace(
            f,
            numbers=tuple(
                replace(n, value=change(i, f, n.value)) if n.main == "rcof" else n
                for n in f.numbers
            ),
        )
        for i, f in enumerate(files)
    ]


def _drop(conditions, *names):
    return {k: v for k, v in conditions.items() if k not in names}


def test_doubts(file_regression):
    gait = made.gait_files(8)
    way = protocol("level_walking")
    sound = [str(one) for one in study_doubts(gait, way)]
    cases = {
        "incomplete": _with(gait, lambda i, c: _drop(c, "shoe") if i < 4 else c),
        "few noted": _with(gait, lambda i, c: {**c, "sock": "wool"} if i < 9 else c),
        "numbers lacking": _with(gait, lambda i, c: _drop(c, "mass") if i == 3 else c),
        "near names": _with(gait, lambda i, c: {**c, "shoe": "sofft"} if i == 0 else c),
        "swapped letters": _with(gait, lambda i, c: {**c, "shoe": "hrad"} if i == 2 else c),
        "words exchanged": _with(
            gait, lambda i, c: {**c, "place": "hall two" if i % 5 else "two hall"}
        ),
        "single level": _with(gait, lambda i, c: {**c, "sky": "blue" if i else "grey"}),
        "confounded": _with(
            gait, lambda i, c: {**c, "colour": {"soft": "r", "hard": "g", "worn": "b"}[c["shoe"]]}
        ),
        "sides": _with(gait, lambda i, c: {**c, "subject": c["subject"] + " LR"[1 + i % 2]}),
        "sides as words": _with(
            gait, lambda i, c: {**c, "subject": c["subject"] + (" left", " right")[i % 2]}
        ),
        "exchanged": _with(
            gait,
            lambda i, c: (
                {**c, "shoe": {"soft": "hard", "hard": "soft"}.get(c["shoe"], c["shoe"])}
                if c["subject"] == "P3"
                else c
            ),
        ),
        "mislabelled": _with(
            made.gait_files(8, trials=4), lambda i, c: {**c, "shoe": "hard"} if i == 12 else c
        ),
        "mass": _with(gait, lambda i, c: {**c, "mass": 90.0} if i == 1 else c),
        "sex": _with(gait, lambda i, c: {**c, "sex": "mf"[i == 2]}),
        "height": _with(gait, lambda i, c: {**c, "height": 1.8 + 0.05 * (i == 2)}),
        "crowded": _with(gait, lambda i, c: {**c, "shoe": "soft"} if c["subject"] == "P4" else c),
        "unlike": _main(gait, lambda i, f, v: 2.2 * v if i == 7 else v),
        "speed": _steps(
            gait,
            lambda i, s: (
                replace(s, walking_speed=1.2 + 0.2 * (i // 2 % 3 == 0) + 0.01 * (i % 7))
                if s.rcof
                else s
            ),
        ),
        "place": _with(gait, lambda i, c: {**c, "order": str(i % 6 + 1)}),
        "plates": _steps(
            gait, lambda i, s: replace(s, rcof=0.3 + 0.001 * (i % 5)) if s.number == 2 else s
        ),
        "peaks": _steps(
            gait,
            lambda i, s: replace(
                s, rcof=0.2, peak_force=s.peak_force * (1.1 if s.number == 2 else 1.0) + i % 3
            ),
        ),
        "another person": [
            replace(f, body={k: 1.3 * v for k, v in f.body.items()}) if i == 4 else f
            for i, f in enumerate(gait)
        ],
        "one body": [
            replace(f, body=gait[i % 6].body) if 6 <= i < 12 else f for i, f in enumerate(gait)
        ],
    }
    found = {
        name: [str(one) for one in study_doubts(files, way) if str(one) not in sound]
        for name, files in cases.items()
    }
    slides = made.slide_files()
    drifting = [
        replace(f, numbers=(replace(f.numbers[0], value=0.1 + 0.01 * (i % 6)), *f.numbers[1:]))
        for i, f in enumerate(slides)
    ]
    held(
        file_regression,
        {
            "sound": sound,
            **found,
            "slides": [str(one) for one in study_doubts(slides, protocol("report_g4"))],
            "drifting": [str(one) for one in study_doubts(drifting, protocol("report_g4"))],
            "a few": [str(one) for one in study_doubts(gait[:3], way)],
            "none": study_doubts([], way),
        },
    )


def test_the_same_files(file_regression):
    gait = made.gait_files(3)
    copied = [
        replace(gait[0], file="copy.c3d"),
        replace(gait[1], checksum="other", file="numbers.c3d"),
        replace(gait[2], file="else.c3d", conditions={**gait[2].conditions, "shoe": "x"}),
    ]
    same_steps = replace(gait[4], file="steps.c3d", checksum="new", numbers=())
    files, doubts = guarded_files([[f] for f in (*gait, *copied, same_steps)])
    held(
        file_regression,
        {
            "doubts": [(str(d.message), d.files, d.out) for d in doubts],
            "files": [(f.file, f.verdict, f.reasons, f.kinds) for f in files],
            "none": guarded_files([]),
            "one": len(guarded_files([gait[:2]])[0]),
        },
    )
