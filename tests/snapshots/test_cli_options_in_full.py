"""Commands with every option: what they ask for, print and write, and how they end."""

import dataclasses
import json
import os
import re
from importlib import import_module
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from test_calibrate_answers import READINGS

import made_answers as made
import underfoot.app.serve
import underfoot.cli
from commands import said
from snapshot import folder_lines, held
from underfoot.block import command_input
from underfoot.block.result import MicroAverages, MicroResult
from underfoot.cli import guard, micro, studies
from underfoot.compute import run as compute_run
from underfoot.core import Status
from underfoot.core.presentation import Presentable, Table
from underfoot.core.unit_text import UNITS_VARIABLE
from underfoot.places import machines as machines_of_places
from underfoot.questions import ask, comparison, contact, risk, slips
from underfoot.studies import Options, g1
from underfoot.studies import study as study_named
from underfoot.studies.runner import Computed, PublishedStudyResult, StudyTable
from underfoot.studies.verdict import ComputedQuantity

pytestmark = pytest.mark.usefixtures("wide")


class Told(Presentable):
    """An answer that says what it was asked."""

    kind = "told"

    def __init__(self, *asked: Any, usable=True) -> None:
        self.asked, self._usable = asked, usable
        self.name = "told"

    @property
    def usable(self):
        return self._usable

    def headline(self):
        return tuple(map(str, self.asked))

    def table(self):
        return Table("", ("a",), [("b",)])

    def save(self, file):
        Path(file).write_text("saved")


def asked(*given, **more):
    """Answer with what was asked, cases by their names and paths by theirs."""
    more.pop("progress", None)

    def short(one):
        if isinstance(one, list | tuple):
            return [short(each) for each in one]
        if isinstance(one, float):
            return float(f"{one:.4g}")
        if hasattr(one, "heights"):
            z = one.heights
            return (
                f"{z.shape}, rms {z.std():.4g} m, {z[0, 0]:.4g} m first, {one.spacing:.4g} m apart"
            )
        if hasattr(one, "storage_modulus"):
            return f"{type(one).__name__} {float(one.storage_modulus(1.0)):.4g} Pa"
        name = getattr(one, "name", None)
        return name if isinstance(name, str) else type(one).__name__ if hasattr(
            one, "load") else one  # fmt: skip

    return Told([short(one) for one in given], {key: short(one) for key, one in more.items()})


# a rough block


def march(speed, status=Status.CONVERGED, corrected=2e-6, whole=True):
    ramp = np.linspace(0.0, 1.0, 5)
    means = None
    if whole:
        means = MicroAverages(
            cof_hysteresis=0.02, cof_absolute=0.12, cof_resultant=0.2, area_per_force=3e-6,
            real_contact_fraction=0.3, mean_pressure=1.6e5, wavelengths=2, scatter=0.01,
            area_per_force_corrected=corrected, real_contact_fraction_corrected=0.2,
        )  # fmt: skip
    return MicroResult(
        1e-3 * ramp, speed * 1e-3 * ramp, 0.06 * ramp, 0.01 * ramp**2, 0.001 * ramp, 1e-7 * ramp,
        9e-8 * ramp, -1e-5 * ramp, 4e-7, means, None, status, 40, 1e-5, 2.5, (f"a note {speed:g}",),
    )  # fmt: skip


def test_a_rough_block(file_regression, tmp_path, monkeypatch):
    (tmp_path / "block.toml").write_text('name = "a [block]"\n')
    heard: list[Any] = []
    answers: dict[str, Any] = {}

    def result(self, speed, progress, *, snapshots=0, folder=None):
        heard.append([self.solver, speed, snapshots, folder.name])
        if answers["now"] == "stopped":
            raise KeyboardInterrupt
        if snapshots:
            folder.mkdir()
            (folder / "block.pvd").write_text("x")
        if answers["now"] == "lost":
            return march(speed, Status.NOT_CONVERGED)
        return march(speed, corrected=float("nan") if speed > 0.5 else 2e-6, whole=speed < 0.9)

    monkeypatch.setattr(command_input.MicroCase, "result", result)
    told: dict[str, Any] = {}
    for name, words in {
        "plain": [], "json": ["--json"], "out": ["--out", "a"], "again": ["--out", "a"],
        "over": ["--out", "a", "--overwrite", "--json"], "lost": [], "stopped": [],
        "stopped explicit": ["--solver", "explicit"], "solver": ["--solver", "fast"],
        "pictures": ["--solver", "explicit", "--out", "b", "--snapshots", "2"],
        "no folder": ["--solver", "explicit", "--snapshots", "1"],
        "condensed": ["--out", "c", "--snapshots", "1"],
    }.items():  # fmt: skip
        answers["now"] = name.split()[0]
        told[name] = said(tmp_path, "micro", "block.toml", *words)
    told["asked"] = heard
    told["files"] = folder_lines(tmp_path / "a", "*.csv", "*.json")
    told["names"] = sorted(path.relative_to(tmp_path).as_posix() for path in tmp_path.rglob("*.*"))
    table = micro.COLUMNS
    assert set(table.values()) <= {field.name for field in dataclasses.fields(MicroResult)}
    held(file_regression, told)


# laws


def test_laws_and_their_conditions(file_regression, tmp_path):
    (tmp_path / "r" / "tables").mkdir(parents=True)
    (tmp_path / "r" / "tables" / "files.csv").write_text(READINGS)
    law = ("calibrate", "law", "r", "--out")
    water = ("--where", "fluid=water")
    told = {
        "fit": said(tmp_path, *law, "a.csv", *water),
        "again": said(tmp_path, *law, "a.csv", *water),
        "over": said(tmp_path, *law, "a.csv", *water, "--overwrite", "--form", "readings")[:2],
        "oil": said(tmp_path, *law, "b.csv", "--where", " fluid = oil ", "--where", "shoe=A",
                    "--pressure", "2 bar"),
        "twice": said(tmp_path, *law, "c.csv", *water, *water),
        "no sign": said(tmp_path, *law, "c.csv", "--where", "fluid"),
        "no name": said(tmp_path, *law, "c.csv", "--where", "=oil"),
        "no value": said(tmp_path, *law, "c.csv", "--where", "fluid="),
        "no load": said(tmp_path, *law, "c.csv", *water, "--pressure", "0 Pa"),
        "form": said(tmp_path, *law, "c.csv", *water, "--form", "line"),
        "gone": said(tmp_path, "calibrate", "law", "gone", "--out", "c.csv"),
        "pair": said(tmp_path, "calibrate", "pair", "x.toml", "--out", "a.csv"),
    }  # fmt: skip
    told["files"] = folder_lines(tmp_path, "*.csv")
    del told["files"]["r/tables/files.csv"]
    held(file_regression, told)


# cases


def test_a_run(file_regression, tmp_path, monkeypatch):
    (tmp_path / "case.toml").write_text(made.CASE.to_toml())
    heard: list[Any] = []
    answers = {"usable": True}

    def run(case, **options):
        options.pop("progress")
        heard.append(["run", case.name, case.value("motion.speed"), options])
        return made.result() if answers["usable"] else made.result(status=Status.NOT_CONVERGED)

    def advice(case, **options):
        options.pop("progress")
        heard.append(["advice", case.name, options.pop("result").name, options])
        return made.assessment(made.change("good"))

    def write(result, folder, *, overwrite, maps, advice=None):
        heard.append(["write", folder, overwrite, maps, advice is not None])
        return SimpleNamespace(lines=lambda: [f"wrote {folder}"])

    monkeypatch.setattr(compute_run, "run", run)
    monkeypatch.setattr(risk, "risk_assessment", advice)
    monkeypatch.setattr("underfoot.report.write_report", write)
    told: dict[str, Any] = {}
    for name, words in {
        "plain": [], "json": ["--json"], "json out": ["--json", "--out", "x"],
        "quick": ["--quick", "--maps", "--processes", "2"], "no advice": ["--no-advice"],
        "renamed": ["--no-changes"], "lost": ["--overwrite", "--out", "y"],
        "set": ["--set", "motion.speed=0.7 m/s", "--quick"],
    }.items():  # fmt: skip
        answers["usable"] = name != "lost"
        heard.clear()
        code, out, err = said(tmp_path, "run", "case.toml", *words)
        lines = out.strip().splitlines()
        told[name] = [code, lines[-3:] if "json" not in name else lines[:2], err, list(heard)]
    held(file_regression, told)


def test_questions_of_a_case(file_regression, tmp_path, monkeypatch):
    (tmp_path / "case.toml").write_text(made.CASE.to_toml())
    (tmp_path / "b.toml").write_text(made.CASE.replace({"contaminant": "water"}).to_toml())
    (tmp_path / "empty").mkdir()
    monkeypatch.setattr(ask, "ask", asked)
    monkeypatch.setattr(slips, "slip_population", asked)
    monkeypatch.setattr(comparison, "compare", asked)
    monkeypatch.setattr(slips, "own_histories", lambda path: [path.name, path.name])
    rcof = SimpleNamespace(
        text="RCOF of 3 walkers", settings=lambda steps=False: ["risk.rcof_mean=0.2"] * (1 + steps)
    )
    monkeypatch.setattr(slips, "measured_rcof", lambda path: rcof)
    told: dict[str, Any] = {}
    for words in (
        ("ask", "how", "case.toml"), ("ask", "how", "case.toml", "--quick", "--processes", "3"),
        ("slip", "case.toml", "--json"),
        ("slip", "case.toml", "--json", "--full", "--subjects", "3", "--full-model", "--history",
         "a.csv", "--history", "b.csv", "--rcof-from", "m.csv"),
        ("slip", "case.toml", "--json", "--fine"), ("slip", "case.toml", "--subjects", "0"),
        ("compare", "case.toml", "b.toml"),
        ("compare", "case.toml", "b.toml", "--quick", "--set", "motion.speed=0.6 m/s"),
        ("compare", "case.toml", "empty"), ("ask", "how", "gone.toml"),
        ("ask", "how", "case.toml", "--processes", "0"),
    ):  # fmt: skip
        code, out, err = said(tmp_path, *words)
        told[" ".join(words)] = [code, json.loads(out) if out.startswith("{") else out, err]
    told["outs"] = sorted(path.name for path in tmp_path.rglob("*slip*"))
    held(file_regression, told)


# published studies


def computed(names, error=""):
    """A result of a study whose quantities all have one value."""
    chosen = study_named(names)
    some = [each for each in chosen.statements if each.claim == "value"][:4]
    chosen = dataclasses.replace(chosen, statements=tuple(some))
    quantities = {each.quantity: ComputedQuantity.of(0.2, each.si_unit) for each in some}
    table = StudyTable("t", "A table", ("a", "b"), [("x", 1.5), ("y", float("nan"))])
    content = Computed(quantities, [] if error else [table], {}, ["It is so."], ["By hand."])
    return PublishedStudyResult(chosen, content, not error, 1.5, 2.5, error)


def test_published_studies(file_regression, tmp_path, monkeypatch):
    heard: list[Any] = []

    def one(chosen, options):
        heard.append(
            [chosen.name, dataclasses.asdict(dataclasses.replace(options, progress=print))]
        )
        heard[-1][1].pop("progress")
        return computed("g5")

    def every(options):
        heard.append(["all", options.quick, options.processes, options.seed, options.settings])
        yield computed("g5")
        yield computed("g3", "ValueError: no such thing")

    monkeypatch.setattr("underfoot.studies.run_study", one)
    monkeypatch.setattr("underfoot.studies.run_all", every)
    run, told = ("studies", "run"), {}
    for name, words in {
        "one": ["g5"], "everything": ["g5", "--all"], "all": [" ALL ", "--out", "all", "--quick"],
        "quick": ["g5", "--out", "x", "--quick", "--processes", "3"],
        "again": ["g5", "--out", "x"], "summary": [],
    }.items():  # fmt: skip
        words = ["studies", "summary", "all"] if name == "summary" else [*run, *words]
        code, out, err = said(tmp_path, *words)
        lines = out.splitlines()
        told[name] = [code, len(lines), *lines[:14], *lines[-3:], err]
    for name, words in {
        "json": [*run, "g5", "--json"], "all json": [*run, "all", "--json"],
        "list": ["studies", "list", "--json"], "errata": ["studies", "errata", "g1", "--json"],
        "every erratum": ["studies", "errata", " ALL ", "--json"],
    }.items():  # fmt: skip
        code, out, _ = said(tmp_path, *words)
        content = json.loads(out) if out.startswith(("[", "{")) else [{"printed": out}]
        first = content[0] if isinstance(content, list) else content
        told[name] = [code, len(content), sorted(first), out[:2].encode().hex()]
    told["table"] = [len(said(tmp_path, "studies", "errata", word)[1].splitlines())
                     for word in ("g2", "all")]  # fmt: skip
    page = (tmp_path / "all" / "studies.html").read_text(encoding="utf-8")
    told["page"] = re.sub(r"<(style|script).*?</\1>|<[^>]+>|\s+", " ", page, flags=re.DOTALL)[:1500]
    told["no study"] = said(tmp_path, "studies", "summary", "x/figures")
    told["asked"] = list(heard)
    told["files"] = sorted(path.relative_to(tmp_path).as_posix() for path in tmp_path.rglob("*.*"))
    for words in (["g1", "--series", "odd"], ["g1", "--control", "odd"], ["g2", "--explicit"],
                  ["all", "--series", "both"], ["g1", "--processes", "0"]):  # fmt: skip
        told[" ".join(words)] = said(tmp_path, *run, *words)
    heard.clear()
    for words in (["--explicit"], ["--series", "both"], ["--control", "load"],
                  ["--bulk-modulus", "printed"], ["--shoe-wavelength", "0.6 mm"],
                  ["--floor-wavelength", "1 mm"]):  # fmt: skip
        said(tmp_path, *run, "G1", *words, "--json")
    usual = dataclasses.asdict(g1.Settings())
    told["settings"] = [
        {key: value for key, value in options["settings"].items() if value != usual[key]}
        for _, options in heard
    ]
    held(file_regression, told)
    assert studies._settings("g5", False, "", "height", "corrected", ("0.5 mm", "0.4 mm")) is None
    assert Options().settings is None


# surfaces, contacts and rubbers


def scan(tmp_path):
    x = np.arange(0, 3.0, 0.01)
    rows = [f"{a:.4f},{5 * np.sin(9 * a) + 0.5 * np.sin(140 * a):.5f}" for a in x]
    (tmp_path / "scan.csv").write_text("\n".join(["x [mm],z [um]", *rows]))
    (tmp_path / "bare.txt").write_text("\n".join(row.replace(",", " ") for row in rows))


def test_surfaces_and_contacts(file_regression, tmp_path, monkeypatch):
    scan(tmp_path)
    monkeypatch.setattr(contact, "measured_table", asked)
    monkeypatch.setattr(contact, "rough_contact", asked)
    monkeypatch.setattr(machines_of_places, "predicted_reading", asked)
    small = ("--points", "16", "--modulus", "5 MPa")
    told: dict[str, Any] = {}
    for words in (
        ("surface", "scan.csv", "--cutoff", "0.8 mm"),
        ("surface", "bare.txt", "--length-unit", "mm", "--height-unit", "um"),
        ("surface", "scan.csv", "--out", "a.sdf"), ("surface", "scan.csv", "--out", "a.sdf"),
        ("surface", "scan.csv", "--out", "a.sdf", "--overwrite"),
        ("surface", "scan.csv", "--spacing", "wide"),
        ("contact", *small, "--rms", "5 um"),
        ("contact", *small, "--rms", "5 um", "--hurst", "0,7", "--longest", "1 mm", "--seed", "3",
         "--shortest", "260 um", "--pressure", "2 bar", "--speed", "0.1 m/s", "--poisson", "0.45",
         "--cutoffs", "--device", "cpu"),
        ("contact", *small, "--checkerboard", "24 um", "0.4 mm"),
        ("contact", "--points", "16", "--rms", "5 um", "--shore", "60"),
        ("contact", "--points", "16", "--rms", "5 um", "--material", "neolite"),
        ("contact", "scan.csv", "--modulus", "5 MPa", "--table", "t.npz", "--speed", "0.3 m/s"),
        ("contact", "scan.csv", "--modulus", "5 MPa", "--table", "t.npz"),
        ("contact", "scan.csv", "--modulus", "5 MPa", "--sole", "bare.txt", "--json",
         "--longest", "1 mm"),
        ("contact", "--modulus", "5 MPa", "--table", "u.npz"),
        ("contact", "scan.csv", "--rms", "5 um", "--modulus", "5 MPa", "--sole", "scan.csv"),
        ("contact", "scan.csv", "--modulus", "5 MPa", "--table", "u.npz", "--checkerboard", "1 um",
         "1 mm"),
        ("machine", "pendulum-96", "--scan", "scan.csv", "--fluid", "oil"),
        ("machine", "pendulum-96", "--scan", "scan.csv", "--rq", "3 um"),
    ):  # fmt: skip
        code, out, err = said(tmp_path, *words)
        name = " ".join(words)
        while name in told:
            name += " again"
        told[name] = [code, json.loads(out) if out.startswith("{") else out, err]
    told["files"] = {path.name: path.stat().st_size for path in sorted(tmp_path.glob("*.[ns]*"))}
    held(file_regression, told)


def test_rubbers(file_regression, tmp_path, monkeypatch):
    heard: list[Any] = []
    monkeypatch.setattr("underfoot.report.write_report", written_by(heard))
    time = np.geomspace(0.01, 1000, 25)
    rows = [f"{t:.5g},{1.0 + 1.2 * t**-0.1:.5g}" for t in time]
    (tmp_path / "hold.csv").write_text("\n".join(["t (s),E (MPa)", *rows]))
    (tmp_path / "series.csv").write_text("tau (s),E_i\n0.01,2\n1,1\n")
    told: dict[str, Any] = {}
    for words in (
        ("hold.csv", "--out", "a.toml"), ("hold.csv", "--out", "a.toml"),
        ("hold.csv", "--out", "c.inp"), ("hold.csv", "--out", "d.k", "--json"),
        ("--shore", "68 A"), ("--shore", "68 A", "--out", "b.inp"), ("--shore", "much"),
        ("--shore", "40 Shore D", "--polymer", "nitrile", "--temperature", "23 degC"),
        ("series.csv", "--unit", "MPa", "--at-rest", "0.8 MPa"),
        ("series.csv", "--unit", "MPa", "--at-once", "8 MPa", "--shear", "--poisson", "0,45"),
        ("series.csv",), ("hold.csv", "--temperature", "warm"), (),
        ("hold.csv", "--thickness", "5 mm"), ("hold.csv", "--area", "1 cm^2"),
    ):  # fmt: skip
        code, out, err = said(tmp_path, "material", *words)
        name = " ".join(words) or "nothing"
        while name in told:
            name += " again"
        told[name] = [code, sorted(json.loads(out)) if out.startswith("{") else out[:900], err]
    told["files"] = sorted(path.relative_to(tmp_path).as_posix() for path in tmp_path.rglob("*.*"))
    told["written"] = heard
    told["toml"] = (tmp_path / "a.toml").read_text()[:1500]
    told["deck"] = (tmp_path / "c.inp").read_text()[:700]
    held(file_regression, told)


def test_curves_over_speed(file_regression, tmp_path, monkeypatch):
    module = import_module("underfoot.calibrate.stribeck_curve")
    curve = module.stribeck_curve

    def bracketed(case, label, **given):
        made_of = curve(case, f"[{label}]", **given)
        return dataclasses.replace(made_of, notes=(*made_of.notes, "[b] and [/b]"))

    monkeypatch.setattr(module, "stribeck_curve", bracketed)
    (tmp_path / "case.toml").write_text(made.CASE.to_toml())
    told: dict[str, Any] = {}
    for words in (
        (), ("--fluid", "measured", "--json"), ("--fluid", "water", "--fluid",
        "glycerol_50pct", "--fluid", "water", "--out", "s", "--slowest", "0.05 m/s",
        "--fastest", "0.2 m/s", "--pressure", "1 bar"),
        ("--law", "pair", "--set", "motion.speed=0.2 m/s", "--slowest", "0.011 m/s", "--fastest",
         "0.013 m/s"), ("--slowest", "0 m/s"), ("--out", "s"), ("--law", "pair", "--json"),
    ):  # fmt: skip
        code, out, err = said(tmp_path, "stribeck", "case.toml", *words)
        read = json.loads(out)["curves"] if out.startswith("{") else []
        told[" ".join(words)] = [code, [one["rows"][-1] for one in read] or out, err]
    table = (tmp_path / "s" / "stribeck.csv").read_bytes()
    told["files"] = sorted(path.name for path in (tmp_path / "s").iterdir())
    told["table"] = table[:3].hex(), table.count(b"\r\n"), table.splitlines()[0].decode("utf-8-sig")
    held(file_regression, told)


# soles


def written_by(heard):
    """Note what is written where."""

    def write(result, folder, *, overwrite, further=None):
        heard.append([folder, overwrite, sorted(further or {})])
        return SimpleNamespace(lines=lambda: [f"wrote {folder}"])

    return write


def test_soles_of_files(file_regression, tmp_path, monkeypatch):
    heard: list[Any] = []
    monkeypatch.setattr("underfoot.report.outsole.inspect_outsole", asked)
    monkeypatch.setattr("underfoot.report.write_report", written_by(heard))
    monkeypatch.setattr("underfoot.report.outsole.case_text", lambda sole, folder: f"in {folder}")
    inspect = ("outsole", "inspect", "heel.stl")
    told: dict[str, Any] = {}
    for name, words in {
        "here": ["--out", "heel"], "elsewhere": ["--out", "b/c d"], "above": ["--out", "x/../y"],
        "absolute": ["--out", tmp_path / "z"], "json": ["--json", "--out", "q"], "plain": [],
        "stem": ["--out", "heel/"],
        "options": ["--unit", "inch", "--spacing", "1 mm", "--down", "-z", "--forward", "+x",
                    "--foot", "left",
                    "--mirror",
                    "--region", "heel", "--region-length", "30 mm", "--cut-floor"],
        "region": ["--region-length", "far"], "foot": ["--foot", "both"],
        "body": ["--solid", "sole"], "side": ["--side", "right", "--overwrite", "--out", "w"],
    }.items():  # fmt: skip
        code, out, err = said(tmp_path, *inspect, *words)
        told[name] = [code, sorted(json.loads(out)) if out.startswith("{") else out[-900:], err]
    told["written"] = heard
    held(file_regression, told)


# files of cases and the program


def test_cases_and_their_files(file_regression, tmp_path, monkeypatch):
    new = made.CASE.to_toml()
    (tmp_path / "case.toml").write_text(new)
    (tmp_path / "old.toml").write_text(new.replace("file_version = 2", "file_version = 1"))
    heard: list[Any] = []
    monkeypatch.setattr(underfoot.app.serve, "serve", lambda *given: heard.append(given))
    told: dict[str, Any] = {}
    for words in (
        ("migrate", "case.toml"), ("migrate", "case.toml", "--out", "b.toml"),
        ("migrate", "case.toml", "--out", "b.toml"), ("migrate", "old.toml"),
        ("migrate", "old.toml", "--overwrite"), ("migrate", "old.toml"),
        ("new", "n.toml", "--shoe", "work_shoe_untreaded", "--floor", "vinyl_g4", "--fluid",
         "water", "--name", "mine"), ("new", "m.toml", "--setup", "odd"),
        ("schema", "--out", "s.json"),
        ("schema", "--out", "s.json"), ("app", "p"),
        ("app", "p", "--port", "0", "--host", "0.0.0.0", "--no-browser"), ("app",),
        ("app", "--port", "65536"), ("catalogue", "fluids", "--json"), 
        ("explain", "canola_oil", "--full"), ("risk", "case.toml", "--wanted=x"),
        ("--units", "us", "explain", "canola_oil"), ("--units", "odd"),
        ("trials", "plan", "shoe=A,B", "fluid=dry,water", "--repeats", "2", "--seed", "3"),
        ("trials", "plan", "shoe=A,B", "fluid=dry,water", "--together", "fluid", "--suffix", ".c3d",
         "--out", "plan.csv", "--block", "shoe"), ("trials", "plan", "shoe"),
        ("trials", "persons", "paired", "--difference", "0.02", "--sd", "0.03"),
        ("trials", "persons", "groups", "--difference", "0.02", "--sd", "0.03", "--power", "0.9"),
        ("trials", "persons", "repeated", "--difference", "0.02", "--sd", "0.03", "--conditions",
         "3"), ("trials", "persons", "slips", "--shares", "0.1", "0.4"),
        ("trials", "persons", "slips_equivalent", "--shares", "0.1", "0.1", "--difference", "20 %"),
        ("trials", "persons", "slips_equivalent", "--shares", "0.1", "0.1"),
        ("trials", "persons", "paired", "--sd", "1"), ("trials", "persons", "odd"),
        ("trials", "simulate", "relaxation", "--out", "pins", "--count", "2", "--seed", "4"),
        ("trials", "simulate", "relaxation", "--out", "pins"), 
        ("trials", "simulate", "odd", "--out", "odd"), ("trials", "analyse", "--list"),
        ("trials", "analyse", "pins"),
        ("trials", "analyse", "pins", "--protocol", "report_g2"), ("trials", "analyse"),
        ("trials", "analyse", "pins", "--protocol", "odd", "--out", "r"),
        ("trials", "analyse", "pins", "--protocol", "report_g2", "--out", "r",
         "--equivalence", "0"),
        ("trials", "analyse", "pins", "--protocol", "report_g2", "--out", "pins"),
        ("trials", "analyse", "pins", "--protocol", "report_g2", "--out", "r", "--details", "-1"),
        ("trials", "analyse", "pins", "--protocol", "report_g2", "--out", "r", "--processes", "0"),
        ("trials", "analyse", "gone", "--protocol", "report_g2", "--out", "r", "--details", "0",
         "--processes", "1"),
        ("trials", "bundle"), ("trials", "bundle", "pins"),
        ("trials", "bundle", "pins", "--protocol", "report_g2"),
        ("trials", "bundle", "pins", "--protocol", "report_g2", "--out", "pins/b"),
        ("trials", "bundle", "--check", "pins"),
    ):  # fmt: skip
        monkeypatch.setenv(UNITS_VARIABLE, "si")  # --units sets it for the process
        code, out, err = said(tmp_path, *words)
        name = " ".join(words)
        while name in told:
            name += " again"
        told[name] = [code, json.loads(out) if out.startswith(("{", "[")) else out, err]
    told["served"] = heard
    told["plan"] = (tmp_path / "plan.csv").read_text()
    told["mine"] = (tmp_path / "n.toml").read_text()[:200]
    files = [path for path in tmp_path.rglob("*.*") if path.suffix != ".toml"]
    told["files"] = sorted(path.relative_to(tmp_path).as_posix() for path in files)
    held(file_regression, told, hide=r"Checksums? .*|[0-9a-f]{6}-\S+")


def test_the_program_begins_with_one_thread_and_ends_cleanly(monkeypatch, capsys):
    names = ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS")
    for name in names[:2]:
        monkeypatch.setenv(name, "x")  # so that it is as it was afterwards
        monkeypatch.delenv(name)
    monkeypatch.setenv(names[2], "3")
    monkeypatch.setattr(guard, "end_cleanly_on_sigterm", lambda: None)
    ends: list[Any] = [None, KeyboardInterrupt(), guard.Terminated()]

    def app():
        if (end := ends.pop(0)) is not None:
            raise end

    monkeypatch.setattr("underfoot.cli.app.app", app)
    underfoot.cli.main()
    assert [os.environ[name] for name in names] == ["1", "1", "3"]
    for code in (guard.INTERRUPTED, guard.TERMINATED):
        with pytest.raises(SystemExit) as ended:
            underfoot.cli.main()
        assert ended.value.code == code
    assert (guard.INTERRUPTED, guard.TERMINATED, guard.INTERNAL) == (130, 143, 70)
    assert capsys.readouterr().err == 2 * "stopped; nothing was written\n"
