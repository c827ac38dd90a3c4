"""Commands as they are given: options with their defaults, what is printed and what is written."""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import typer
import typer.main

import made_answers as made
from commands import said
from snapshot import folder_lines, held, refusal
from trial_exports import EXPORTS
from underfoot.cli import (
    calibrate,
    cases,
    contact,
    material,
    micro,
    options,
    output,
    outsole,
    outsole_make,
    places,
    stribeck,
    study,
    surface,
    tools,
    trials_curves,
    trials_steps,
)
from underfoot.cli.app import app
from underfoot.core.presentation import Part, Table

ROOMS = (calibrate, cases, contact, material, micro, options, outsole, outsole_make, output, places,
         stribeck, study, surface, tools, trials_curves, trials_steps)  # fmt: skip
HEEL = '[heel]\nlength = "40 mm"\nwidth = "30 mm"\nrear_radius = "10 mm"\nprofile = "flat"\n'


pytestmark = pytest.mark.usefixtures("wide")


def every_command(group, names=()):
    """Yield each command and its words."""
    for name, command in sorted(getattr(group, "commands", {}).items()):
        yield from every_command(command, (*names, name))
    if not getattr(group, "commands", {}):
        yield names, group


def test_options_and_their_defaults(file_regression):
    assert all(module.__name__.startswith("underfoot.cli") for module in ROOMS)
    told = {}
    for names, command in every_command(typer.main.get_command(app)):
        told[" ".join(names)] = [
            " ".join(
                str(part)
                for part in (
                    "/".join([*one.opts, *one.secondary_opts]),
                    one.default,
                    getattr(one, "min", None),
                    getattr(one, "max", None),
                    "many" * bool(one.nargs != 1 or getattr(one, "multiple", 0)),
                    "must" * one.required,
                    "flag" * bool(getattr(one, "is_flag", False)),
                )
                if part not in ("", None)
            )
            for one in command.params
            if one.name not in ("help", "install_completion", "show_completion")
        ]
    held(file_regression, told)


# what is printed


LONG = (
    "a sentence that goes on and on, far beyond what a terminal shows of it in one line (Source 1)"
)
TABLES = {
    "plain": Table("Numbers", ("name", "value"), [("a", "1"), (Part("of it"), "2"), ("[b]", "3")]),
    "remarks": Table(
        "R", ("name", "value", "Source"), [("a.b.c.d.e.f.g.h.i.j.k.l.m.n.o.p.q.r.s.t.u", "1", LONG)]
    ),
    "records": Table(
        "Long", ("name", "what", "why"), [(f"row {k}", LONG, f"{LONG} {k}") for k in range(42)]
    ),
    "blocks": Table(
        "Many",
        ("name", "of", *(f"column {k}" for k in range(12))),
        [("row", "abc", *(f"{k} mm" for k in range(12)))] * 13,
    ),
    "numbers": Table(
        "", tuple(f"column {k}" for k in range(14)), [tuple(f"{k}.5 mm" for k in range(14))] * 3
    ),
    "no heads": Table("", ("", ""), [("a", "1")]),
    "hashes": Table(
        "", ("a", "b", "c"), [("f" * 64, "/a/very/long/path/to/a/file/of/some/body/heel.stl", "x")]
    ),
    "two": Table("", ("a", "b"), [("x", LONG)]),
}


@pytest.mark.parametrize("columns", ["100", "60"])
def test_tables(file_regression, capsys, monkeypatch, columns):
    monkeypatch.setenv("COLUMNS", columns)
    told = {}
    for name, table in TABLES.items():
        for everything in (False, True):
            if everything and name in ("records", "blocks") and columns == "60":
                continue
            output.print_table(table, everything=everything)
            told[f"{name} {'all' * everything}"] = capsys.readouterr().out
    told["cells"] = "\n".join(
        output.narrow_cell(cell)
        for cell in (
            "a" * 36,
            "a" * 37,
            "a b" * 20,
            "f" * 64,
            "0" * 63,
            "a." * 20,
            "/" + "ab/" * 20,
            "x" * 30 + "." + "y" * 9,
        )
    )
    told["remark"] = output.shorten_remark("w " * 80) + "|" + output.shorten_remark("a (b) c")
    held(file_regression, told)


@pytest.mark.parametrize("name", ["risk", "sensitivity", "wear", "result", "failed"])
def test_answers(file_regression, capsys, name):
    shown: Any = {
        "risk": lambda: made.assessment(
            made.change("good"), made.change("x", failure="not converged")
        ),
        "sensitivity": made.sensitivity,
        "wear": made.wear,
        "result": made.result,
        "failed": lambda: made.assessment(present=made.FAILED),
    }[name]()
    told: dict[str, Any] = {}
    for as_json, everything in ((False, False), (False, True), (True, False)):
        code = 0
        try:
            advice = made.assessment(made.change("good")) if name == "result" else None
            output.finish(shown, None, json=as_json, everything=everything, advice=advice)
        except typer.Exit as ended:
            code = ended.exit_code
        printed = capsys.readouterr().out
        key = "json" if as_json else "all" if everything else "short"
        told[key] = [code, sorted(json.loads(printed)) if as_json else printed]
    held(file_regression, told)


def test_settings(file_regression):
    texts = ("a.b=1", "a = 2.5", 'x="3 mm"', "x=3 mm", "y=true", "z=[1, 2]", "e=", "n=1e3", "w=0,5")
    held(
        file_regression,
        {
            "settings": [options.setting(text) for text in texts],
            "numbers": [options.number(text) for text in ("0,5", "50 %", "1e3", 0.25)],
            "refused": [refusal(options.setting, text) for text in ("a", "=1", "")]
            + [refusal(options.number, text) for text in ("x", "3 mm")],
            "folder": refusal(options.load_case, Path(__file__).parent, None, None),
        },
    )


# commands


def test_a_case(file_regression, tmp_path):
    (tmp_path / "case.toml").write_text(made.CASE.to_toml())
    told = {
        "check": said(tmp_path, "check", "case.toml"),
        "set": "0.2 m/s"
        in said(tmp_path, "check", "case.toml", "--set", "motion.speed=0.2 m/s")[1],
        "json": sorted(json.loads(said(tmp_path, "check", "case.toml", "--json")[1])),
        "wrong": said(tmp_path, "check", "case.toml", "--set", "motion.speed"),
        "unknown": said(tmp_path, "check", "case.toml", "--set", "motion.sped=1 m/s"),
        "none": said(tmp_path, "check", "gone.toml"),
        "folder": said(tmp_path, "check", "."),
        "compare": said(tmp_path, "compare", "case.toml"),
        "target": said(tmp_path, "risk", "case.toml", "--target", "much"),
        "limit": said(tmp_path, "wear", "case.toml", "--limit", "much"),
        "mode": said(tmp_path, "wear", "case.toml", "--mode", "odd"),
        "method": said(tmp_path, "test", "case.toml", "--method", "iso"),
        "word": said(tmp_path, "chek"),
    }
    held(file_regression, told, hide=r"[\d.]+ [GM]B|\d+ processors?|about [\d.]+ to [\d.]+ \w+")


def test_stored_results(file_regression, tmp_path):
    for name, cof in (("a", 0.1), ("b", 0.3)):
        made.result(name, cof=cof).save(tmp_path / name)
    told = {
        "compare": said(tmp_path, "compare", "a", "b"),
        "json": sorted(json.loads(said(tmp_path, "compare", "a", "b", "--json")[1])),
        "export": said(tmp_path, "export", "a", "--to", "sole.csv"),
        "pressed": said(tmp_path, "export", "a", "--to", "sole.csv", "--pressed", "--overwrite"),
        "again": said(tmp_path, "export", "a", "--to", "sole.csv"),
        "field": said(tmp_path, "export", "a", "--to", "x.csv", "--field", "odd"),
        "kind": said(tmp_path, "export", "a", "--to", "x.odd"),
        "nothing": said(tmp_path, "export", "a"),
        "none": said(tmp_path, "compare", "a", "gone"),
    }  # fmt: skip
    held(file_regression, told)


def test_soles_that_are_made(file_regression, tmp_path):
    (tmp_path / "sole.toml").write_text(
        HEEL
        + '[tread]\npattern = "bars"\nlug_width = "6 mm"\nchannel_width = "3 mm"\ndepth = "2 mm"\n'
    )
    (tmp_path / "case.toml").write_text(made.CASE.to_toml())
    make = ("outsole", "make")
    small = ("--set", "length=40 mm", "--set", "width=30 mm", "--set", "rear_radius=10 mm")
    told = {
        "file": said(tmp_path, *make, "sole.toml"),
        "case": said(tmp_path, *make, "case.toml"),
        "json": said(tmp_path, *make, "sole.toml", "--json"),
        "assumed": said(tmp_path, *make, "--pattern", "waves", *small),
        "pitch": said(
            tmp_path,
            *make,
            "--pattern",
            "grid",
            "--lug",
            "5 mm",
            "--pitch",
            "8 mm",
            "--depth",
            "2 mm",
            *small,
            "--sipes",
            "0.5 mm, 1 mm, 4 mm",
        ),
        "written": said(tmp_path, *make, "sole.toml", "--out", "a.stl"),
        "again": said(tmp_path, *make, "sole.toml", "--out", "a.stl"),
        "nothing": said(tmp_path, *make),
        "both": said(tmp_path, *make, "sole.toml", "--pattern", "grid"),
        "pattern": said(tmp_path, *make, "--pattern", "odd"),
        "twice": said(
            tmp_path,
            *make,
            "--pattern",
            "grid",
            "--lug",
            "5 mm",
            "--pitch",
            "8 mm",
            "--channel",
            "3 mm",
        ),
        "no channel": said(
            tmp_path, *make, "--pattern", "grid", "--lug", "8 mm", "--pitch", "8 mm"
        ),
        "sipes": said(tmp_path, *make, "--pattern", "grid", "--sipes", "1 mm"),
        "inspect": said(tmp_path, "outsole", "inspect", "a.stl"),
        "refused": said(tmp_path, "outsole", "inspect", "a.stl", "--unit", "miles"),
    }
    held(file_regression, told)


def test_what_the_package_knows(file_regression, tmp_path):
    told = {
        "new": said(tmp_path, "new", "case.toml"),
        "again": said(tmp_path, "new", "case.toml"),
        "catalogue": [line.strip() for line in said(tmp_path, "catalogue")[1].splitlines()[:12]],
        "fluid": len(said(tmp_path, "catalogue", "fluid")[1].splitlines()) > 5,
        "kind": said(tmp_path, "catalogue", "odd"),
        "explain": said(tmp_path, "explain", "cof")[0::2],
        "unknown": said(tmp_path, "explain", "coff"),
        "schema": len(said(tmp_path, "schema")[1]) > 1000,
        "studies": said(tmp_path, "studies", "list"),
        "study": said(tmp_path, "studies", "run", "g99"),
        "bare": [
            said(tmp_path, *words)[0] for words in ((), ("trials",), ("outsole",), ("study",))
        ],
    }
    held(file_regression, told, hide=r"and \d+ more")  # as many as this process has loaded


def scan(tmp_path):
    x = np.arange(0, 3.0, 0.004)
    z = 5 * np.sin(9 * x) + 2 * np.sin(31 * x + 1) + 0.5 * np.sin(140 * x)
    rows = [f"{a:.4f},{b:.5f}" for a, b in zip(x, z, strict=True)]
    (tmp_path / "scan.csv").write_text("\n".join(["x [mm],z [um]", *rows]))


def test_measured_files(file_regression, tmp_path):
    scan(tmp_path)
    time = np.geomspace(0.1, 100, 12)
    sweep = [f"{f:.4g},{2e6 * (1 + 0.1 * math.log10(f * 10)):.6g},{3e5:.6g}" for f in time]
    (tmp_path / "sweep.csv").write_text("\n".join(["frequency [Hz],E' [Pa],E'' [Pa]", *sweep]))
    told = {
        "surface": said(tmp_path, "surface", "scan.csv"),
        "surface out": said(tmp_path, "surface", "scan.csv", "--out", "s")[0],
        "json": sorted(json.loads(said(tmp_path, "surface", "scan.csv", "--json")[1])),
        "gone": said(tmp_path, "surface", "gone.csv"),
        "material": said(tmp_path, "material", "sweep.csv"),
        "no material": said(tmp_path, "material", "scan.csv"),
    }  # fmt: skip
    told["files"] = sorted(folder_lines(tmp_path / "s", "*.json", "*.csv", "*.toml"))
    held(file_regression, told)


def test_a_study(file_regression, tmp_path):
    tread = "examples/work_shoe_full_tread_glycerol.toml"
    base = Path(__file__).parents[2] / tread
    (tmp_path / "base.toml").write_text(base.read_text())
    (tmp_path / "s.toml").write_text(
        'name = "A study"\nbase = "base.toml"\n[vary]\n'
        '"shoe.tread.depth" = { from = "1 mm", to = "2 mm" }\n'
        '[outputs]\nmaximise = ["cof"]\n[method]\nbudget = 4\n'
    )
    told = {
        "check": said(tmp_path, "study", "check", "s.toml"),
        "status": said(tmp_path, "study", "status", "s.toml"),
        "stop": said(tmp_path, "study", "stop", "s.toml"),
        "live": said(tmp_path, "study", "live", "s.toml"),
        "best": said(tmp_path, "study", "best", "s.toml"),
        "gone": said(tmp_path, "study", "status", "gone.toml"),
        "json": sorted(json.loads(said(tmp_path, "study", "check", "s.toml", "--json")[1])),
    }
    held(
        file_regression,
        told,
        hide=r"[\d.]+ (?:to [\d.]+ )?(?:[kMG]?B|s|min|h)\b|\d+ (?:processor|worker)s?",
    )


def test_rough_contacts(file_regression, tmp_path):
    (tmp_path / "case.toml").write_text(made.CASE.to_toml())
    small = ("--points", "16", "--rms", "5 um", "--longest", "1 mm", "--modulus", "5 MPa")
    told = {
        "contact": said(tmp_path, "contact", *small),
        "json": sorted(json.loads(said(tmp_path, "contact", *small, "--json")[1])),
        "cutoffs": said(tmp_path, "contact", *small, "--cutoffs"),
        "pressure": said(tmp_path, "contact", *small, "--pressure", "much"),
        "bare": said(tmp_path, "contact"),
        "micro": said(tmp_path, "micro", "gone.toml"),
        "no micro": said(tmp_path, "micro"),
        "template": len(said(tmp_path, "micro", "--template")[1]) > 300,
        "stribeck": said(
            tmp_path, "stribeck", "case.toml", "--fluid", "water", "--fluid", "canola_oil"
        ),
        "speeds": said(tmp_path, "stribeck", "case.toml", "--slowest", "2 m/s"),
        "odd": said(tmp_path, "stribeck", "case.toml", "--fluid", "odd"),
        "law": said(tmp_path, "stribeck", "case.toml", "--law", "odd"),
    }
    held(file_regression, told)


def test_recordings(file_regression, tmp_path):
    for name in ("walk.csv", "walk.tsv", "walk_f_1.tsv"):
        (tmp_path / name).write_bytes(EXPORTS[name]())
    step = ("trials", "edit", "walk.csv", "--reason", "seen so", "--step")
    told = {
        "describe": said(tmp_path, "trials", "describe", "walk.csv"),
        "none": said(tmp_path, *step, "1"),
        "two": said(tmp_path, *step, "1", "--side", "left", "--exclude"),
        "side": said(tmp_path, *step, "1", "--side", "right"),
        "contact": said(tmp_path, *step, "1", "--contact", "0.25 s"),
        "gone": said(tmp_path, *step, "9", "--exclude"),
        "mot": said(tmp_path, "trials", "export", "walk.csv", "--out", "a.mot"),
        "trc": said(tmp_path, "trials", "export", "walk.csv", "--out", "a.trc"),
        "c3d": said(tmp_path, "trials", "export", "walk.csv", "--out", "a.c3d"),
        "with": said(
            tmp_path, "trials", "export", "walk.tsv", "--with", "walk_f_1.tsv", "--out", "b.mot"
        ),
        "again": said(tmp_path, "trials", "export", "walk.csv", "--out", "a.mot"),
        "odd": said(tmp_path, "trials", "export", "walk.csv", "--out", "a.odd"),
        "definitions": said(tmp_path, "trials", "definitions", ".", "--out", "d"),
    }
    edits = tmp_path / "edits.csv"
    told["edits"] = edits.read_text() if edits.exists() else ""
    told["files"] = {
        p.name: len(p.read_text().splitlines()) for p in sorted(tmp_path.glob("[ab].*o*"))
    }
    held(file_regression, told)


def test_json_is_set_in_by_two(tmp_path):
    (tmp_path / "case.toml").write_text(made.CASE.to_toml())
    for words in (("check", "case.toml"), ("stribeck", "case.toml", "--fluid", "water")):
        lines = said(tmp_path, *words, "--json")[1].splitlines()
        assert (lines[0], lines[-1]) == ("{", "}")
        assert {len(line) - len(line.lstrip()) for line in lines[1:-1]} == set(
            range(2, 2 * max(len(line) - len(line.lstrip()) for line in lines) // 2 + 1, 2)
        )
