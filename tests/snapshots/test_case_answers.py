"""Cases: every key with its range and default, every option, scenarios, refusals and texts.

Of ``underfoot.case.describe``, ``underfoot.case.schema``, ``underfoot.case.tables``,
``underfoot.case.template``, ``underfoot.case.versions``.
"""

import math
import re
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

from snapshot import held, refusal, snapshot_lines, tried
from underfoot.case import describe, schema, sole, tables, template, text, versions
from underfoot.case.case import Case, with_settings
from underfoot.case.errors import CaseError
from underfoot.case.explanation import equations, explanation
from underfoot.case.free_tread import TERMS, keeps
from underfoot.case.friction import (
    measured_fluids,
    range_95,
    read_friction_table,
)
from underfoot.case.lettering import check_text, text_rings
from underfoot.case.motion import read_motion_table
from underfoot.case.parts import (
    field_at,
    fields,
    keys,
    nearest_path,
    path_kind,
    paths,
    sections_at,
    unit_at,
    unknown_path,
)
from underfoot.case.quantity import default_of, one_spelling, one_value
from underfoot.case.section import Section, quantity_of
from underfoot.case.surfaces import SurfaceRoughness
from underfoot.compute.resolve import resolve_context
from underfoot.core import SourcedValue
from underfoot.core.catalogue import Catalogue

BASE = {
    "shoe": "work_shoe_full_tread",
    "floor": "vinyl_g4",
    "contaminant": "glycerol_90pct",
    "motion": "slip_tester_g4",
}
HEAD = "".join(f'{key} = "{value}"\n' for key, value in BASE.items())
EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture(autouse=True)
def at_home(tmp_path, monkeypatch):
    """Work in an empty folder: errors and tables name files without it."""
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def base(at_home):
    return Case(**BASE)


def _held(file_regression, value):
    """Hold a value without the folders of its files."""
    held(file_regression, value, hide=r"(?<![\w>.])/[^\s\"']*/(?=\w)|FOLDER/")


def _bounds(field):
    """Return what a field says of values at and just beyond both of its limits."""
    quantity = quantity_of(field)
    if quantity is None:
        return "words"
    unit = "" if quantity.unit == "1" else f" {quantity.unit}"
    beyond = (quantity.low - abs(quantity.low) * 0.01 - 1e-9, quantity.high * 1.01 + 1e-9)
    said = []
    for value in (beyond[0], quantity.low, quantity.high, beyond[1]):
        try:
            said.append(f"{quantity.parse(f'{value:.9g}{unit}', None):.6g}")
        except Exception as error:  # its text is held
            said.append(str(error).partition(" is outside the physical range")[0] + "!")
    return f"{quantity.range_text()}: {'; '.join(said)}"


SECTIONS = (
    "underfoot.case.contact", "underfoot.case.contaminant", "underfoot.case.free_tread",
    "underfoot.case.friction", "underfoot.case.motion", "underfoot.case.numerics",
    "underfoot.case.parts", "underfoot.case.people", "underfoot.case.section",
    "underfoot.case.shoe", "underfoot.case.sole", "underfoot.case.surfaces", "underfoot.case.wear",
)  # fmt: skip
"""Modules whose sections have keys; with ranges of ``underfoot.case.quantity``."""


def test_every_module_of_sections_is_known():
    def below(kind):
        return {kind} | {each for one in kind.__subclasses__() for each in below(one)}

    modules = {kind.__module__ for kind in below(Section)}
    assert {name for name in modules if name.startswith("underfoot.case.")} == set(SECTIONS)


def test_every_key(file_regression):
    """Unit, range with its ends, default with its source and what it is."""
    import_module("underfoot.places.calibration")  # which brings options too
    lines = {}
    for path, field in fields().items():
        known = default_of(field)
        told = "" if known is None else f"{known.text!r} ({known.source}; {known.assumed})"
        lines[path] = f"{unit_at(path)} | {_bounds(field)} | {told} | {field.description or ''}"
    _held(file_regression, {"keys": lines, "options": {
        path: f"{unit_at(path)} {slot.key} {slot.usual} {sorted(slot.options())}"
        for path, slot in keys().items()
    }})  # fmt: skip


def _short(text):
    return text if len(text) < 240 else f"{text[:140]} ... {text[-80:]}"


def test_paths(file_regression):
    names = """shoe shoe.heel shoe.heel.profile shoe.heel.profile.angle shoe.from motion.from
        shoe.heel.rocker_radius models.friction motion.load motion.velocity floor.rq floor.hardness
        friction.readings friction.readings.speed risk sho shoe.materiel.shore_a wholly.unknown
        shoe.tread.depht sensor.rows interface numerics film.model film.sucton name""".split()
    answers = {
        name: {
            "kind": _short(tried(path_kind, name)),
            "unit": _short(tried(unit_at, name)),
            "nearest": nearest_path(name),
            "unknown": _short(str(unknown_path(name))),
            "sections": [each.__name__ for each in sections_at(name)],
            "field": field_at(name) is not None,
        }
        for name in names
    }
    spelled = {
        f"{value} {unit}": [one_spelling(value, unit), one_value(value, unit)]
        for value, unit in ((0.075, "m"), (math.radians(7), "rad"), (3, "N"), (0.8, "1"),
                            (True, "1"), ("grid", "1"), (None, "m"))
    }  # fmt: skip
    _held(file_regression, {"count": len(paths()), "paths": answers, "spelled": spelled})


@pytest.mark.parametrize(
    "names",
    [
        "tread shoe.tread.pattern shoe.tread.lug_width facet walk archard film.model measured",
        "held friction.model pair contact_table motion.speed contaminant.viscosity shoe.material",
        "Eq.5 eq(17) equation26 Eq.999 glycerol_90pct vinyl_g4 slip_tester_g4 rcof gent persson",
    ],
)
def test_explanations(file_regression, names):
    """First lines: what a formula's docstring says further is not the case's."""
    catalogue = Catalogue.load()
    lines = {}
    for name in names.split():
        answer = str(tried(explanation, name, catalogue))
        lines[name] = "\n".join(answer.splitlines()[:14])
    # how many more names there are depends on the options that other tests have made
    lines["unknown"] = re.sub(r"\d+ more", "N more", refusal(explanation, "tred", catalogue))
    if "gent" in names:
        full = explanation("youngs_modulus_gent", catalogue, full=True)
        lines["short"] = explanation("youngs_modulus_gent", catalogue)
        lines["longer"] = len(full) > len(lines["short"])
        lines["equations"] = [equations(each) for each in (resolve_context, text_rings)]
    _held(file_regression, lines)


def _unlike(value, usual):
    return snapshot_lines(value) != snapshot_lines(usual)


def _told(case):
    """Return the rows of a case and what is said and made of it."""
    shoe, floor = case.shoe.roughness, case.floor.roughness
    heel, tread, wear = case.shoe.heel, case.shoe.tread, case.shoe.wear
    return {
        "rows": [" | ".join(row) for row in case.rows()],
        "assumed": [str(each) for each in describe.assumptions(case)],
        "breaches": [str(each) for each in describe.tested_range_breaches(case)],
        "idle": {name: list(names) for name, names in case.idle_given.items()},
        "changes": list(case.changes),
        "entries": dict(case.entries),
        "case": repr(case),
        "rq": case.effective_rq,
        "rq_deviation": case.interface.rq_deviation(shoe, floor),
        "leak_deviation": case.interface.leak_deviation(shoe, floor),
        "widest": heel and heel.widest,
        "thickness": case.shoe.sole.thickness,
        "tread": tread and tread.build(),
        "profile": heel and heel.profile.build(),
        "wear": wear.build(),
        "moved": [case.motion.end_time, case.motion.forward, case.motion.sliding_speed],
        "history": case.motion.build(),
        "viscosity": case.contaminant and case.contaminant.build(),
        "chemistry": case.contaminant and case.contaminant.chemistry,
        "bare": sole.is_bare(case),
    }


def _heel(**more):
    return {"shoe.heel.profile": more}


_ROCKER = {"model": "rocker", "radius": "120 mm", "start": "25 mm"}
_WHOLE = {"plan": "sole", "length": "280 mm", "width": "70 mm", "waist_width": "55 mm",
          "ball_width": "95 mm"}  # fmt: skip
_HISTORY = [
    {"time": "0 s", "normal_force": "100 N", "speed": "0.3 m/s"},
    {"time": "0.2 s", "normal_force": "400 N", "speed": "-0.2 m/s"},
]
CHANGES = {
    "base": {},
    "flat": _heel(model="flat"),
    "facet of no angle": _heel(model="facet", angle="0 deg", length="20 mm"),
    "rocker": _heel(**_ROCKER),
    "left sole": {"shoe.heel": {**_WHOLE, "side": "left", "toe_spring": "15 mm",
                                "toe_start": "210 mm"}},
    "sole": {"shoe.heel": _WHOLE, "numerics.grid_check": True},
    "crowned": {"shoe.heel.crown_radius": "0.4 m", "shoe.heel.front_radius": "5 mm"},
    "no tread": {"shoe.tread": "none"},
    "arc": {"shoe.tread": {"pattern": "none", "arc_channel": {"width": "4 mm", "depth": "2 mm",
            "position": "20 mm", "radius": "25 mm"}}},
    "sipes": {"shoe.tread.sipes": {"width": "0.7 mm", "depth": "2 mm", "spacing": "6 mm",
              "angle": "20 deg"}},
    "grooves": {"shoe.tread.grooves": [
        {"along": "30 mm", "across": "-5 mm", "width": "3 mm", "length": "20 mm"},
        {"along": "50 mm", "across": "0 mm", "width": "3 mm", "angle": "15 deg"}]},
    "worn plane": {"shoe.wear.depth": "1 mm", "shoe.wear.angle": "12 deg"},
    "walked": {"shoe.wear": {"mode": "walk", "depth": "0.8 mm"}},
    "patch": {"shoe.wear": {"mode": "patch", "depth": "1 mm", "patch_length": "30 mm",
              "patch_width": "40 mm", "patch_form": "rectangle", "patch_lateral": "3 mm"}},
    "patch, unworn": {"shoe.wear": {"mode": "patch", "patch_length": "30 mm",
                      "patch_width": "40 mm"}},
    "archard": {"shoe.wear": {"mode": "archard", "depth": "1 mm", "angle": "12 deg",
                "abrasion": "DIN 120 mm3"}},
    "archard, rate": {"shoe.wear": {"mode": "archard", "depth": "1 mm", "angle": "12 deg",
                      "abrasion": "ISO 4649 0.15 cm^3", "normal_force": "300 N"}},
    "glycerol in water": {"contaminant": {"glycerol_fraction": "85 %", "fraction_basis": "volume"}},
    "glycerol with spread": {"contaminant": {
        "glycerol_fraction": {"value": "0.8", "uncertainty": "0.02"}, "fraction_basis": "mass",
        "temperature": {"value": "25 degC", "uncertainty": "2 K"}}},
    "almost all glycerol": {"contaminant": {
        "glycerol_fraction": {"value": "0.995", "uncertainty": "0.02"}, "fraction_basis": "mass"}},
    "oil": {"contaminant": {"viscosity": "60 cP", "family": "oil", "pool_depth": "0.3 mm"}},
    "dry": {"contaminant": "none"},
    "dry, constant": {"contaminant": "none", "friction": {"model": "constant", "cof": "0.8"}},
    "backward": {"motion.backward": True, "motion.duration": "0.2 s"},
    "steady": {"motion.steady": True, "motion.duration": "0.2 s"},
    "history": {"motion": {"history_points": _HISTORY, "shoe_angle": "5 deg"}},
    "history that stops": {"motion": {"history_points": [
        *_HISTORY, {"time": "0.3 s", "normal_force": "300 N", "speed": "0 m/s",
                    "shoe_angle": "3 deg"}]}},
    "effective rq": {"interface.effective_rq": {"value": "12 um", "uncertainty": "3 um"}},
    "spread of ra": {"shoe.roughness.ra": {"value": "4 um", "uncertainty": "0.4 um"},
                     "interface.roughness_beyond_cutoff": {"value": "3", "uncertainty": "0.5"}},
    "rz": {"shoe.roughness.rz": {"value": "30 um", "uncertainty": "2 um"},
           "floor.roughness.rz": "3 um"},
    "short cut-off": {"shoe.roughness.cutoff": "0.25 mm", "floor.roughness.cutoff": "2.5 mm"},
    "ruess": {"hardness.model": "ruess", "shoe.material.shore_a": "95"},
    "very soft": {"shoe.material.shore_a": "8"},
    "Shore D": {"shoe.material.shore_a": "40 Shore D"},
    "Asker": {"shoe.material.shore_a": "55 Asker C"},
    "modulus": {"shoe.material.modulus": "6 MPa"},
    "midsole": {"shoe.sole.midsole": {"modulus": "2 MPa", "thickness": "12 mm"}},
    "half space": {"compliance": "half_space", "shoe.sole.outsole_thickness": "10 mm",
                   "shoe.sole.midsole": {"modulus": "2 MPa", "thickness": "12 mm"}},
    "no film": {"film": "none", "sensor.scans": 5,
                "sensor.array": {"rows": 2, "columns": 3, "spacing": "30 mm",
                                 "inlet_diameter": "4 mm"}},
    "no edges": {"film.lug_edges": False, "film.suction": "40 kPa"},
    "ramp": {"floor.slope": "5 deg", "risk.model": "chang_2004", "slip.heel_brake": "none",
             "slip.brake_time_mean": "12 ms"},
    "idle things": {"shoe.material.density": "1100 kg/m^3", "shoe.roughness.rp": "9 um",
                    "friction.model": "constant", "friction.cof": "0.3",
                    "shoe.material.polymer": "TPU", "shoe.material.slowest_tested": "1 rad/s"},
    "by Bowden": {"friction": {"model": "bowden_tabor", "shear_strength": "0.3 MPa"},
                  "interface.hurst": "0.7"},
    "other floor": {"floor": "vinyl_g2", "name": "another"},
    "three changes": {"motion.speed": "0.4 m/s", "motion.normal_force": 300.0,
                      "motion.shoe_angle": None, "numerics.tread_positions": 2},
}  # fmt: skip


@pytest.mark.parametrize("part", range(4))
def test_changed_cases(file_regression, base, part):
    answers, usual = {}, _told(base)
    for name in list(CHANGES)[part::4]:
        case = tried(base.replace, CHANGES[name])
        told = case if isinstance(case, str) else _told(case)
        if name != "base" and not isinstance(told, str):
            told = {key: value for key, value in told.items() if _unlike(value, usual[key])}
            for key in ("rows", "assumed"):
                told[key] = [each for each in told.get(key, ()) if each not in usual[key]]
        answers[name] = told
    _held(file_regression, answers)


def test_patterns(file_regression, base):
    """Each pattern with its usual lengths: what the keys make, and what is told as assumed."""
    answers = {}
    for pattern in ("none", *sole.TreadPattern.options()):
        case = base.replace("shoe.tread", {"pattern": pattern, **sole.usual_tread(pattern)})
        tread = case.shoe.tread.build()
        letters = tread and tread.letters
        answers[pattern] = {
            "rows": [
                f"{row[0]} {row[1]}"
                for row in case.rows()
                if row[0].startswith("shoe.tread") and "default" not in row[2]
            ],
            "lengths": tread and [tread.pattern, tread.lug_width, tread.channel_width, tread.depth],
            "outlines": None if letters is None else str(letters)[:80],
        }
    _held(file_regression, answers)


LAWS = {
    "pair": {},
    "pair, dry": {"contaminant": "none"},
    "pair, spread": {"shoe.material.shore_a": {"value": 60, "uncertainty": 3},
                     "shoe.material.loss_tangent": {"value": 0.2, "uncertainty": 0.03},
                     "shoe.material.polymer": "TPU"},
    "pair, modulus": {"shoe.material.modulus": "6 MPa"},
    "pair, relaxation": {"shoe.material.relaxation": {
        "equilibrium_shear_modulus": "1 MPa",
        "terms": [{"shear_modulus": "3 MPa", "time": "1e-5 s"},
                  {"shear_modulus": "1 MPa", "time": "1e-3 s"}]}},
    "boundary": {"friction": "boundary"},
    "stribeck": {"friction": "stribeck"},
    "boundary, another fluid": {"friction": "boundary", "contaminant": {"viscosity": "30 cP"}},
    "stribeck, another fluid": {"friction": "stribeck", "contaminant": {"viscosity": "30 cP"}},
    "stribeck, given": {"friction": {"cof_bl": 0.3, "tau_hydro": "0.5 m/s",
                                     "cof_asymptote": 0.05}},
    "stribeck, bl alone": {"friction": {"cof_bl": 0.3, "hysteresis_cof": 0.04}},
    "blocking": {"friction": {"model": "adhesion_blocking", "dry_adhesion_cof": 0.8,
                              "hysteresis_cof": 0.05, "alpha": "1 N", "beta": 0.2}},
    "blocking, load": {"friction": {"model": "adhesion_blocking", "dry_adhesion_cof": 0.8,
                       "hysteresis_cof": 0.05, "alpha": "1 N", "beta": 0.2, "load": "40 N"}},
    "constant": {"friction": {"model": "constant", "cof": {"value": 0.4, "uncertainty": 0.03},
                              "hysteresis_cof": 0.1}},
    "asperity": {"friction": {"model": "asperity_ehl", "cof_bl": 0.3, "tau_hydro": "0.4 m/s",
                              "fine_roughness": "0.2 um"}},
    "asperity, plain": {"friction": "asperity_ehl"},
    "sharing": {"friction": "mean_film_sharing"},
    "area": {"friction": "viscoelastic_area", "shoe.material.relaxation": {
        "equilibrium_shear_modulus": "1 MPa",
        "terms": [{"shear_modulus": "3 MPa", "time": "1e-4 s"}]}},
    "bowden": {"friction": {"model": "bowden_tabor",
                            "shear_strength": {"value": "0.3 MPa", "uncertainty": "0.05 MPa"}}},
    "table": {"friction": {"model": "table", "readings": [
        {"speed": "0.1 m/s", "cof": 0.4, "sd": 0.02}, {"speed": "0.1 m/s", "cof": 0.44, "sd": 0.03},
        {"speed": "0.6 m/s", "cof": 0.2, "sd": 0.02, }]}},
    "table, another fluid": {"friction": {"model": "table", "hysteresis_cof": 0.05, "readings": [
        {"speed": "0.1 m/s", "cof": 0.4, "viscosity": "100 cP", "pressure": "100 kPa"},
        {"speed": "0.1 m/s", "cof": 0.38, "viscosity": "100 cP", "pressure": "200 kPa"},
        {"speed": "0.6 m/s", "cof": 0.2, "viscosity": "50 cP"},
        {"speed": "0.6 m/s", "cof": 0.24, "viscosity": "50 cP"}]}},
}  # fmt: skip


@pytest.mark.parametrize("part", range(2))
def test_laws(file_regression, base, part):
    """What an option makes of a case, and the friction that it draws over speeds."""
    answers = {}
    for name in list(LAWS)[part::2]:
        context = resolve_context(case := base.replace(LAWS[name]))
        law = tried(case.friction.build, context)
        speeds, pressure = np.array([0.02, 0.3, 1.0]), np.full(3, 2e5)
        answers[name] = law if isinstance(law, str) else {
            "law": law.pair if name.startswith("pair") else None,
            "kind": type(law).__name__,
            "cof": [part / 2e5 for part in law.contact_shear(pressure, speeds)],
            "inputs": law.inputs, "error": law.error_of_model,
            "assumed": [str(each) for each in getattr(law, "assumed", ())],
            "measured": getattr(case.friction, "measured_friction", lambda _: None)(context),
            "fluid": context.fluid, "rq": context.rq_value, "E": context.youngs_modulus,
        }  # fmt: skip
    _held(file_regression, answers)


def test_contacts(file_regression, base):
    gaps = np.array([5e-6, 20e-6, 60e-6])
    answers = {}
    for model in ("exponential", "persson", "greenwood_williamson"):
        case = base.replace({"rough_contact": model})
        law = case.rough_contact.build(resolve_context(case))
        answers[model] = np.asarray(law.pressure(gaps), dtype=float).tolist()
    answers["fluids"] = measured_fluids(base.catalogue)
    answers["range"] = [
        range_95(SourcedValue(2.0, "1", uncertainty=0.2)),
        range_95(SourcedValue(2.0, "1")),
        range_95(SourcedValue(None, "1", reason="not known")),
    ]
    for model in ("gent", "ruess"):
        hardness = base.replace("hardness.model", model).hardness
        answers[model] = [hardness.build(shore) for shore in (20.0, 58.0, 95.0)]
    for risk in ("report_g6", "beschorner_2016", "chang_2004"):
        answers[risk] = base.replace("risk.model", risk).risk.build()
    _held(file_regression, answers)


REFUSED = {
    "rocker": _heel(model="rocker", radius="20 mm", start="25 mm"),
    "radii": {"shoe.heel.rear_radius": "36 mm", "shoe.heel.edge_radius": "35.1 mm"},
    "toe": {"shoe.heel": {**_WHOLE, "toe_spring": "15 mm"}},
    "toe start": {"shoe.heel": {**_WHOLE, "toe_start": "150 mm"}},
    "no depth": {"shoe.tread.depth": "0 mm"},
    "too deep": {"shoe.tread.depth": "26 mm"},
    "narrow": {"shoe.tread.channel_width": "1.1 mm", "shoe.tread.lug_width": "1 mm"},
    "edges": {"shoe.tread.edge_radius": "2.6 mm", "shoe.tread.edge_chamfer": "1 mm"},
    "sipes": {"shoe.tread.sipes": {"width": "3 mm", "depth": "4 mm", "spacing": "6 mm"}},
    "no sipes": {"shoe.tread.sipes": {"width": "1 mm", "depth": "0 mm", "spacing": "6 mm"}},
    "grooves": {"shoe.tread.grooves": [
        {"along": "90 mm", "across": "0 mm", "width": "3 mm"},
        {"along": "30 mm", "across": "40 mm", "width": "0.5 mm"}]},
    "arc": {"shoe.tread.arc_channel": {"width": "1 mm", "depth": "30 mm", "position": "20 mm",
                                       "radius": "25 mm"}},
    "chevrons": {"shoe.tread": {"pattern": "chevrons", **sole.usual_tread("chevrons"),
                                "angle": "76 deg"}},
    "rings": {"shoe.tread": {"pattern": "rings", **sole.usual_tread("rings"),
                             "ring_width": "6 mm"}},
    "graded": {"shoe.tread": {"pattern": "graded_circles", **sole.usual_tread("graded_circles"),
                              "front_lug_width": "0.8 mm", "graded_length": "0.1 mm"}},
    "lettering": {"shoe.tread": {"pattern": "lettering", **sole.usual_tread("lettering"),
                                 "text": "a_b"}},
    "free, flat": {"shoe.tread": {"pattern": "free", **sole.usual_tread("free"),
                                  "cos1_cos0": 0}},
    "free, symmetry": {"shoe.tread": {"pattern": "free", **sole.usual_tread("free"),
                                      "cos1_sin1": 0.5}},
    "free, little land": {"shoe.tread": {"pattern": "free", **sole.usual_tread("free"),
                          "land": 0.05, "mould_draft": "50 deg"}},
    "free, small": {"shoe.tread": {"pattern": "free", **sole.usual_tread("free"),
                    "cell_length": "9 mm", "cell_width": "9 mm"}},
    "free, large": {"shoe.tread": {"pattern": "free", **sole.usual_tread("free"),
                    "cell_length": "200 mm"}},
    "wear": {"shoe.wear.depth": "26 mm"},
    "patch": {"shoe.wear": {"mode": "patch", "depth": "1 mm", "patch_length": "80 mm",
                            "patch_width": "71 mm"}},
    "abrasion": {"shoe.wear": {"mode": "archard", "depth": "1 mm", "angle": "12 deg",
                               "abrasion": "quite some"}},
    "abrasion twice": {"shoe.wear": {"mode": "archard", "depth": "1 mm", "angle": "12 deg",
                       "abrasion": "DIN 120 mm3", "wear_rate": "0.3 mm^3/(N*m)"}},
    "short": {"motion.duration": "20 ms"},
    "never": {"motion.steady": False},
    "ends idle": {"motion": {"shoe_angle": "5 deg", "history_points": [
        _HISTORY[0], {**_HISTORY[1], "normal_force": "0.5 N"}]}},
    "one point": {"motion": {"shoe_angle": "5 deg", "history_points": _HISTORY[:1]}},
    "another end": {"motion": {"shoe_angle": "5 deg", "history_points": _HISTORY,
                    "duration": "0.3 s", "normal_force": "450 N"}},
    "file and points": {"motion": {"shoe_angle": "5 deg", "history_points": _HISTORY,
                                   "history": "a.csv"}},
    "rough": {"interface.effective_rq": "0.2 mm"},
    "rough sole": {"shoe.roughness.ra": "0.2 mm"},
    "rough together": {"shoe.roughness.ra": "90 um", "floor.roughness.rq": "100 um"},
    "shallow": {"contaminant.pool_depth": "0.02 mm"},
    "waves": {"interface.shortest_wave": "2 mm"},
    "hard": {"shoe.material.shore_a": "100"},
    "scale": {"shoe.material.shore_a": "40 Shore X"},
    "dry law": {"contaminant": "none", "friction": "stribeck"},
    "more than whole": {"friction": {"model": "constant", "cof": 0.2, "hysteresis_cof": 0.3}},
    "no spectrum": {"friction": "viscoelastic_area"},
    "no readings": {"friction": {"model": "table", "readings": []}},
    "one speed": {"friction": {"model": "table", "readings": [
        {"speed": "0.1 m/s", "cof": 0.4, "sd": 0.1}, {"speed": "0.1 m/s", "cof": 0.4}]}},
    "table": {"friction": "table"},
    "hardness": {"shoe.material.modulus": "6 MPa", "hardness.model": "ruess"},
    "certified": {"shoe.certificate": [{"test": "a walk", "cof": 0.3}]},
    "class": {"shoe.class": "nothing known"},
    "no fluid": {"contaminant": "honey"},
    "no shoe": {"shoe": "work_shoe_full_tred"},
    "no option": {"friction.model": "pear"},
    "other key": {"film.model": "none", "film.suction": "40 kPa"},
    "near key": {"shoe.tread.lugwidth": "4 mm"},
    "far key": {"wind.speed": "4 m/s"},
    "percent": {"risk.rcof_sd": "3 %"},
    "milli": {"shoe.heel.length": "75 m"},
    "unit": {"motion.speed": "3 kg"},
    "word": {"slip.heel_brake": "maybe"},
    "flag": {"motion.backward": "yes"},
    "count": {"sensor.scans": 0, "slip.fit_runs": 201},
    "half": {"sensor.scans": 2.5},
    "section": {"shoe": 3.0},
    "within a value": {"motion.speed.fast": "3 m/s"},
    "not read": {"interface.hurst": "0.7", "friction": {"model": "constant", "cof": 0.2}},
    "outsole": {"shoe.outsole": {"file": "none.stl"}},
}  # fmt: skip


def test_refused(file_regression, base):
    answers = {}
    for name, each in REFUSED.items():
        answer = tried(base.replace, each)
        answers[name] = answer if isinstance(answer, str) else repr(answer)
    _held(file_regression, answers)


_LONG = {"cell_length": "64 mm", "cell_width": "20 mm"}
_AREA = {"friction": {"model": "bowden_tabor", "shear_strength": "0.3 MPa"}}
_FREE = {"pattern": "free", **sole.usual_tread("free")}
TAKEN = {
    "rocker": _heel(model="rocker", radius="25.1 mm", start="25 mm"),
    "radii": {"shoe.heel.rear_radius": "35 mm", "shoe.heel.edge_radius": "35 mm"},
    "depth": {"shoe.tread.depth": "24.9 mm", "shoe.wear.depth": "24.9 mm"},
    "two cells": {"shoe.tread.channel_width": "2 mm"},
    "edge of a lug": {"shoe.tread.edge_radius": "2.5 mm"},
    "chamfer of a lug": {"shoe.tread.edge_chamfer": "2.5 mm"},
    "sipes": {"shoe.tread.sipes": {"width": "2.9 mm", "depth": "3 mm", "spacing": "6 mm"}},
    "grooves": {"shoe.tread.grooves": [
        {"along": "0 mm", "across": "35 mm", "width": "2 mm"},
        {"along": "75 mm", "across": "-35 mm", "width": "2 mm"}]},
    "rings": {"shoe.tread": {"pattern": "rings", **sole.usual_tread("rings"),
                             "ring_width": "5.9 mm"}},
    "chevrons": {"shoe.tread": {"pattern": "chevrons", **sole.usual_tread("chevrons"),
                                "angle": "-74.9 deg"}},
    "little land": {"shoe.tread": {**_FREE, **_LONG, "land": 0.1}},
    "much land": {"shoe.tread": {**_FREE, **_LONG, "land": 0.9}},
    "patch": {"shoe.wear": {"mode": "patch", "depth": "1 mm", "patch_length": "75 mm",
                            "patch_width": "70 mm"}},
    "as short as the rise": {"motion.duration": "30 ms"},
    "hardest": {"shoe.material.shore_a": "99.9"},
    "all hysteresis": {"friction": {"model": "constant", "cof": 0.3, "hysteresis_cof": 0.3}},
    "waves": {**_AREA, "interface.shortest_wave": "1.99 mm"},
    "rough": {"interface.effective_rq": "159 um", "contaminant.pool_depth": "0.48 mm"},
    "last force": {"motion": {"shoe_angle": "5 deg", "history_points": [
        _HISTORY[0], {**_HISTORY[1], "normal_force": "1 N"}]}},
    "counts": {"sensor.scans": 200, "slip.fit_runs": 4, "slip.test_runs": 100,
               "slip.subjects": 10_000, "slip.sensor_rows": 20, "slip.seed": 2**31},
}  # fmt: skip
JUST_BEYOND = {
    "rocker": _heel(model="rocker", radius="25 mm", start="25 mm"),
    "through": {"shoe.tread.depth": "25 mm"},
    "sipes": {"shoe.tread.sipes": {"width": "3 mm", "depth": "3 mm", "spacing": "6 mm"}},
    "waves": {**_AREA, "interface.shortest_wave": "2 mm"},
    "rough": {"interface.effective_rq": "160 um", "contaminant.pool_depth": "1 mm"},
    "shallow": {"interface.effective_rq": "159 um", "contaminant.pool_depth": "0.47 mm"},
    "much land": {"shoe.tread": {**_FREE, "land": 0.91}},
    "largest cell": {"shoe.tread": {**_FREE, "cell_width": "161 mm"}},
    "subjects": {"slip.subjects": 10_001},
    "runs": {"slip.fit_runs": 3},
    "tests": {"slip.test_runs": 101},
    "rows": {"slip.sensor_rows": 21},
    "columns": {"slip.sensor_columns": 0},
    "seed": {"slip.seed": 2**31 + 1},
    "scans": {"sensor.scans": 201},
}


def test_ends_of_what_fits(base):
    """What just fits is taken, what just does not is refused."""
    refused = {name: tried(base.replace, each) for name, each in TAKEN.items()}
    assert {name: each for name, each in refused.items() if isinstance(each, str)} == {}
    taken = [name for name, each in JUST_BEYOND.items()
             if not isinstance(tried(base.replace, each), str)]  # fmt: skip
    assert taken == []


FILES = {
    "plain": HEAD,
    "comments": "# first\n" + HEAD.replace(
        'motion = "slip_tester_g4"',
        '[motion]  # the rig\nfrom = "slip_tester_g4"\nspeed = "0.5 m/s"  # as set\n'),
    "inline": HEAD.replace('shoe = "work_shoe_full_tread"', 'shoe = {from = "work_shoe_full_tread",'
                           ' tread.depth = {value = "2 mm", source = "a gauge"}}'),
    "version 1": HEAD.replace("motion =", "file_version = 1\nmotion =")
    + '[models]\nfriction = "constant"\nhardness = "ruess"\n[interface]\nconstant_cof = 0.4\n'
    '[sensor]\nrows = 2\ncolumns = 2\narray_spacing = "20 mm"\narray_inlet_diameter = "4 mm"\n',
    "version 3": "file_version = 3\n" + HEAD,
    "no version": 'file_version = "two"\n' + HEAD,
    "no contaminant": HEAD.replace("contaminant", "# contaminant"),
    "no motion": HEAD.replace("motion =", "# motion ="),
    "numbers": HEAD + "[numerics]\ngrid_spacing = 0.001\n",
    "twice": HEAD + '[shoe]\ntread.depth = "3 mm"\n',
    "no toml": HEAD + "speed = 0.7 m/s\n",
    "two faults": HEAD.replace("vinyl_g4", "vynil_g4") + '[risk]\nrcof_mean = 7\nwhat = "that"\n',
    "list": HEAD + '[friction]\nmodel = "table"\nreadings = [\n{speed = "0.1 m/s", cof = 9},\n]\n',
}  # fmt: skip


def test_files(file_regression, tmp_path):
    """Files as read: errors with their lines, notes of older versions, texts as written anew."""
    answers = {}
    for name, written in FILES.items():
        path = Path(f"{name.replace(' ', '_')}.toml")
        path.write_text(written, encoding="utf-8")
        case = tried(Case.load, path)
        answers[name] = case
        if not isinstance(case, str):
            changed = case.replace({"motion.speed": 0.4, "shoe.tread.depth": "2.5 mm"})
            changed = changed.replace("friction", {"model": "constant", "cof": 0.3})
            set_so = Case.load(path, settings={"motion.normal_force": "250 N", "floor": "vinyl_g2"})
            answers[name] = {
                "name": case.name, "changes": list(case.changes), "text": case.to_toml(),
                "changed": changed.to_toml(), "set": set_so.name, "set text": set_so.to_toml(),
                "entries": dict(set_so.entries),
            }  # fmt: skip
    Case.load("plain.toml").save("kept.toml")
    answers["saved"] = Path("kept.toml").read_text(encoding="utf-8")
    answers["exists"] = refusal(Case.load("plain.toml").save, "kept.toml")
    answers["no file"] = refusal(Case.load, "plan.toml")
    Path("latin.toml").write_bytes("name = 'é'".encode("latin-1"))
    answers["latin"] = refusal(Case.load, "latin.toml")
    answers["set badly"] = [
        refusal(Case.load, "plain.toml", settings=each)
        for each in ({"motion.speed": "900 m/s"}, {"motion.sped": "1 m/s"}, {"floor": 2.0})
    ]
    _held(file_regression, answers)


def test_examples(file_regression):
    dry = Case.load(EXAMPLES / "work_shoe_full_tread_dry.toml")
    walking = Case.load(EXAMPLES / "whole_sole_walking.toml")
    told = _told(walking)
    del told["rows"]  # the complete text has them
    _held(file_regression, {
        "dry": [" | ".join(row) for row in dry.rows() if "default" not in row[2]],
        "assumed, dry": [str(each) for each in describe.assumptions(dry)],
        "walking": told,
        "complete": walking.to_toml(complete=True),
    })  # fmt: skip


def test_programs(file_regression, base):
    """Cases made of parts, of mappings and of other cases; what is frozen, equal and absent."""
    sections = Case(**{**BASE, "motion": base.motion, "floor": base.floor.model_copy()})
    mapped = Case.from_mapping({**BASE, "motion": {"from": "slip_tester_g4", "speed": "0.5 m/s"}})
    moved = base.replace("motion", base.motion.model_copy(update={"speed": 0.5}))
    _held(file_regression, {
        "same": [sections == base, mapped == base, moved == mapped, base == 3,
                 hash(sections) == hash(base), sections.hash == base.hash],
        "text": sections.to_toml()[:600],
        "moved": moved.to_toml(),
        "mapped": mapped.to_toml(),
        "frozen": [refusal(setattr, base, "floor", 1), refusal(delattr, base, "floor")],
        "values": {path: base.value(path) for path in (
            "motion.speed", "friction.model", "models.friction", "shoe.heel.profile.radius",
            "shoe.tread.pattern", "shoe.tread.grooves", "shoe.outsole.file")},
        "no value": refusal(base.value, "shoe.tred"),
        "sourced": [base.sourced_value(path) for path in (
            "shoe.roughness.ra", "motion.speed", "shoe.heel.profile.radius", "shoe.heel.length")],
        "copy": base.model_copy(update={"contaminant": "none"}).rows()[:3],
        "dry": Case(**{**BASE, "contaminant": None}).table().rows[-2:],
        "missing": refusal(Case, shoe="work_shoe_full_tread"),
        "none": refusal(Case, **{k: v for k, v in BASE.items() if k != "contaminant"}),
        "names": [base.replace(each).name for each in CHANGES.values()
                  if not isinstance(tried(base.replace, each), str)][:6],
        "settings": with_settings(BASE, {"models.friction": "pair", "motion.speed": 1.0}),
        "several": str(CaseError(_tried_errors(base))),
    })  # fmt: skip


def _tried_errors(base):
    try:
        base.replace({"motion.speed": "900 m/s", "shoe.heel.length": "75 m"})
    except CaseError as error:
        return error.errors
    raise AssertionError("no error")


def test_texts(file_regression):
    written = (
        '# head\nshoe = "a"\n[motion] # rig\nspeed = "1 m/s" # here\n"odd key" = 3\n'
        "note = '''\nspeed = 3\n'''\n[heel.profile]\nangle.value = 3\n[[list]]\nx = 1\n"
    )

    def expand(item, path):
        return {"from": item} if isinstance(item, str) and path in ("shoe", "floor") else item

    settings = {
        "number": {"motion.speed": "2 m/s"},
        "below a name": {"shoe.depth": "2 mm"},
        "taken out": {"motion.speed": None, "floor.x": None},
        "new tables": {"floor": "c", "sole.heel.width": 3, "heel.profile.radius": {"value": 2}},
        "section": {"motion": {"force": 3, "speed": 2}},
    }
    tree = {"a": 1, "b": {"value": 2, "source": "x"}, "c": {"d": {"e": [1, {"f": "g"}], "h": True}},
            "empty": {}, "odd key": "x\ny"}  # fmt: skip
    places = text.Places("f.toml", written, changed=["floor"])
    places.moved = {"heel.angle": "heel.profile.angle"}
    _held(file_regression, {
        "changed": {n: text.change_text(written, each, expand) for n, each in settings.items()},
        "refused": refusal(text.change_text, written, {"motion.speed.x": 1}, expand),
        "tree": text.toml_text(tree, "a tree"),
        "lines": {".".join(key): line for key, line in text.key_lines(written).items()},
        "places": [places(path) for path in ("motion.speed", "motion.speed[3].x", "heel.angle",
                   "floor.rq", "floors", "nothing")] + [text.Places()("motion.speed")],
        "parsed": text.parse_toml("\ufeffa = 0.1\nb = 1e3\n"),
        "wrong": [refusal(text.parse_toml, each, "f") for each in ("a = b", "a=1\n[a]\nb=1\n",
                  "a = " + "[" * 3000)],
        "versions": [versions.upgrade(each) for each in (
            {"models": {"friction": "x", "value": 3}}, {"shoe": {"heel": {"profile": "flat"}}},
            {"interface": {"constant_cof": 0.4, "source": "me", "assumed": True}})],
        "settings": [versions.current_settings(each) for each in (
            {"models": {"friction": "x"}}, {"shoe.heel": {"facet_angle": 3, "width": 2}},
            {"shoe.heel.profile": "flat"}, {"interface.hysteresis_cof": 0.1})],
        "sentence": versions.sentence("a", "b"),
    })  # fmt: skip


def test_templates(file_regression):
    catalogue = Catalogue.load()
    wet = template.template(**BASE, catalogue=catalogue)
    dry = template.template(**{**BASE, "contaminant": "none"}, catalogue=catalogue, name='a "b"',
                            description="c\\d", file="my case.toml")  # fmt: skip
    Case.from_text(wet)
    Case.from_text(dry)
    wrong = refusal(template.template, **{**BASE, "floor": "ice"}, catalogue=catalogue)
    _held(file_regression, {"wet": wet, "dry": dry[:1500], "wrong": wrong})


def test_schema(file_regression):
    read = schema.json_schema()
    definitions = {
        name: {
            key: value if key != "properties" else {
                field: str({k: v for k, v in entry.items() if k != "description"})[:200]
                for field, entry in value.items()
                if field not in ("assumed", "verified", "source", "note")
            }
            for key, value in each.items()
        }
        for name, each in read.pop("$defs").items()
        if name in ("Shoe", "Material", "GridTread", "Walkers", "GlycerolWater", "MotionPoint",
                    "FacetRear", "HeelPlan", "TableOption", "SourcedLeaf", "Numerics")
    }  # fmt: skip
    _held(file_regression, {**read, "definitions": definitions, "end": schema.schema_text()[-3:]})


TABLES = {
    "good.csv": "# source: a bench\nspeed (mm/s),COF,sd\n100,0.4,0.02\n500,0.2,0.03\n",
    "si.csv": "velocity;coefficient of friction;pressure (kPa)\n0,1;0,4;200\n0,5;0,2;210\n",
    "missing.csv": "speed,cof\n0.1,0.4\n0.5,\n",
    "negative.csv": "speed,cof\n0.1,0.4\n-0.5,0.3\n",
    "no_cof.csv": "speed,friction\n0.1,0.4\n",
    "unit.csv": "speed (kg),cof\n0.1,0.4\n0.2,0.4\n",
    "percent.csv": "speed (m/s),cof (%)\n0.1,40\n0.2,30\n",
    "percent_sd.csv": "speed (m/s),cof,sd (%)\n0.1,0.4,4\n0.2,0.3,4\n",
    "motion.csv": "t (ms),Force (kN),speed,angle (deg)\n0,0.1,0.3,5\n200,0.4,0.2,0\n",
    "one_row.csv": "time,load,speed\n0,100,0.3\n",
    "text.csv": "nothing here\n",
}


def test_tables(file_regression, base):
    for name, written in TABLES.items():
        Path(name).write_text(written, encoding="utf-8")
    answers = {
        name: {
            "friction": tried(read_friction_table, Path(name), "friction.table_file"),
            "motion": tried(read_motion_table, Path(name), "motion.history"),
            "source": tables.table_source(Path(name)),
        }
        for name in TABLES
    }
    here = Path()
    case = base.replace("motion", {"history": "motion.csv"})
    table = base.replace("friction", {"model": "table", "table_file": "good.csv"})
    both = {"model": "table", "table_file": "good.csv", "readings": []}
    _held(file_regression, {
        "tables": answers,
        "no file": refusal(tables.existing_file, here / "god.csv", "x", "*.csv"),
        "motion": [row for row in case.rows() if row[0].startswith("motion")],
        "history": case.motion.build(),
        "table": [row for row in table.rows() if row[0].startswith("friction")],
        "both": refusal(base.replace, "friction", both),
        "sums": [tables.with_checksum({"file": 3}, "file", here, "x")],
        "another": refusal(tables.with_checksum, {"file": "good.csv", "sha256": "0" * 64}, "file",
                           here, "x"),
        "changed": refusal(tables.meant_file("good.csv", "0", "x").__enter__),
    })  # fmt: skip


COMPOUNDS = {
    "rubber.toml": 'modulus = "5 MPa"\npoisson_ratio = 0.48\npolymer = "NBR"\n',
    "spectrum.toml": "[relaxation]\nequilibrium_shear_modulus = '1 MPa'\n"
    "terms = [{shear_modulus = '2 MPa', time = '1 ms'}]\n",
    "wrong.toml": "modulos = '5 MPa'\n",
    "none.toml": "modulus = \n",
}


def test_files_of_parts(file_regression, base):
    """Compound and scans beside the case."""
    for name, written in COMPOUNDS.items():
        Path(name).write_text(written, encoding="utf-8")
    x = np.arange(800) * 5e-6
    waves = 4e-6 * np.sin(2 * np.pi * x / 0.4e-3) + 2e-6 * np.sin(2 * np.pi * x / 0.11e-3)
    rows = "\n".join(
        f"{at * 1e3:.4f},{height * 1e6:.5f}" for at, height in zip(x, waves, strict=True)
    )
    Path("scan.csv").write_text(f"x (mm),z (um)\n{rows}\n", encoding="utf-8")
    answers = {}
    for name in COMPOUNDS:
        case = tried(base.replace, "shoe.material.file", name)
        answers[name] = case if isinstance(case, str) else {
            "rows": [row for row in case.rows() if row[0].startswith("shoe.material")
                     and row[0].rpartition(".")[2] not in ("file", "sha256")],
            "shore_a": case.shoe.material.shore_a,
            "tested": [case.shoe.material.loss_tested_at(rate) for rate in (0.0, 1e9)],
        }  # fmt: skip
    for label, more in {
        "scan": {"shoe.roughness.ra": None},
        "scan with ra": {"shoe.roughness.ra": "5 um"},
        "both scans": {"shoe.roughness.ra": None, "floor.roughness.file": "scan.csv"},
    }.items():
        case = base.replace({"shoe.roughness": {}, "shoe.roughness.file": "scan.csv", **more})
        rough = case.shoe.roughness
        answers[label] = {
            "rows": [row for row in case.rows() if ".roughness" in row[0] or ("rough_" in row[0]
                     and row[0].rpartition(".")[2] not in ("file", "sha256"))],
            "rq": case.effective_rq,
            "leak": case.interface.leak_deviation(rough, case.floor.roughness),
            "moments": [rough.moment(order, 5e-6, 0.8e-3) for order in (0, 1)],
            "directions": rough.directions(np.array([1e4, 1e5])),
        }  # fmt: skip
    _held(file_regression, answers)


def test_small_things(file_regression):
    """Lettering, symmetry of terms, roughness without a case."""
    rings = [text_rings(each, 0.016, 0.003) for each in ("H", "O i", "é8")]
    bare, only_rz = SurfaceRoughness(), SurfaceRoughness(rz=10e-6)
    _held(file_regression, {
        "rings": [[[np.round(ring.mean(axis=0), 6).tolist(), len(ring)] for ring in part]
                  for pair in rings for part in pair],
        "letters": [tried(check_text, each, "x") for each in ("GRIP", "", "---", "A" * 24,
                    "A" * 25,
                    "a_b", "Ä/1?")],
        "keeps": {name: [key for key in TERMS if keeps(name, key)] for name in (
            "mirror", "two_fold", "both", "glide")},
        "rough": [bare.rq_or_estimate, only_rz.rq_or_estimate, only_rz.rq_uncertainty,
                  SurfaceRoughness(ra=2e-6).rq_or_estimate, only_rz.share_up_to(1e-3, 0.8),
                  SurfaceRoughness(cutoff=4e-3).share_up_to(1e-3, 0.5), bare.scan()],
    })  # fmt: skip


def test_a_long_name_is_cut_where_a_case_is_shown(base):
    for length, shown in ((60, "x" * 60), (61, "x" * 57 + "...")):
        assert f"<Case {shown!r} [" in repr(base.replace("name", "x" * length))
