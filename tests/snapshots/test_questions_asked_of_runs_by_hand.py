"""Questions asked of runs that are made by hand: what they run, and what they make of them."""

import dataclasses
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
from test_questions_answers_made_by_hand import TREADED, said, spread, words

import made_answers as made
from snapshot import held, refusal
from trial_exports import EXPORTS
from underfoot.core import Cache, ConvergenceError, InputError, SourcedValue, Status
from underfoot.questions import (
    comparison,
    contact,
    effects,
    method,
    outcomes,
    risk,
    sensitivity,
    separation,
    slips,
    wear,
    worn_states,
)
from underfoot.questions.changes import Change
from underfoot.questions.sensitivity import OpenInput
from underfoot.questions.slips import SlipPopulation
from underfoot.trials.recording.measurement import MEAN_OF_STEPS

PAD = made.CASE.replace(
    {"shoe.tread": {"pattern": "bars", "lug_width": "6 mm", "channel_width": "3 mm",
                    "depth": "2 mm"}, "numerics.grid_spacing": "1 mm",
     "numerics.quick_grid_spacing": "1.5 mm", "contaminant": "glycerol_90pct"}
)  # fmt: skip


def noted(asked, answer):
    """Return what notes what it was asked and gives an answer of it."""

    def call(cases, **options):
        options.pop("progress", None)
        asked.append([len(cases), options])
        return [answer(case, number) for number, case in enumerate(cases)]

    return call


# slips of a population


def number(value, unit="1", sd: float | None = None, reason=""):
    return SourcedValue(value, unit, source="by hand", uncertainty=sd, reason=reason)


def study(count=6, **changes) -> Any:
    """A study of slips by hand."""
    times = np.linspace(0.0, 0.2, 3)
    motion = SimpleNamespace(still_sliding=True, time=times, speed=times, distance=times**2,
                             normal=500 + times, drive=90 - times, friction=80 * times,
                             fluid_load=7 * times)  # fmt: skip
    seen = [
        SimpleNamespace(slipped=k % 2 == 0, peak_speed=0.1 + 0.3 * k, distance=0.01 * k,
                        outcome=("no slip", "slide", "fall")[k % 3], duration=0.04 if k else None,
                        crossed=k != 2, peak_pressure=2e4 * k, start=0.02, flags=("a", "b")[:k])
        for k in range(count)
    ]  # fmt: skip
    walker = SimpleNamespace(
        name="w", history=SimpleNamespace(name="h"), mass=70.0, rcof=0.2, walking_speed=None,
        heel_speed=0.5, shoe_angle=0.3, landing=0.01, lateral=-0.002,
    )  # fmt: skip
    subjects = [SimpleNamespace(walker=walker, seen=one, motion=motion) for one in seen]
    normal = SimpleNamespace(mean=0.2, sd=0.03, assumed=True)
    people = SimpleNamespace(effective_mass=0.114, weight_transfer=(0.5, 0.8), mass=normal,
                             rcof=normal, heel_speed=normal)  # fmt: skip
    error = SimpleNamespace(peak_speed=0.05)
    fit = SimpleNamespace(at_bound=("k",), held_out=error, fitted=error)
    given = {
        "subjects": subjects, "population": people, "fit": fit, "pressure_error": 0.2,
        "setting": SimpleNamespace(viscosity=0.2, friction=SimpleNamespace(assumptions=("law",))),
        "array": SimpleNamespace(inlet_diameter=2e-3), "full": False, "failed": 2, "full_runs": [1],
        "by_friction": object(), "breaches": ("speed 9",), "representative": None,
        "slip_share": lambda: (0.5, 0.2, 0.8), "highest_seen": lambda: 0.4,
        "mean": lambda name, unit, crossed=False: number(0.3, unit, 0.004, f"{name} {crossed}"),
        "shares": lambda: {"no slip": (0.5, 0.2, 0.8), "fall": (0.1, 0.0, 0.3)},
        "slip_start": lambda: (0.021, 0.3), "correlation": lambda: 0.8765,
        "peak_speed_at": lambda **by: sum(v if isinstance(v, float) else 0.1 for v in by.values()),
        "rows": lambda: np.array([2e4, 1e4, 5e3]), "numbers": lambda: {"peak_speed": 0.3},
        "of": lambda name: np.array([getattr(one, name) or np.nan for one in seen], float),
    } | changes  # fmt: skip
    return SimpleNamespace(**given)


def population(one, predicted=None):
    return SlipPopulation("a shoe", one, predicted or spread(0.3, 0.1, 0.5), "report_g6")


def test_slips_of_a_population(file_regression):
    quiet = [SimpleNamespace(**vars(one)) for one in study().subjects]
    for one in quiet:
        one.seen = SimpleNamespace(**{**vars(one.seen), "duration": None})
    dry = SimpleNamespace(viscosity=None, friction=SimpleNamespace(assumptions=()))
    still = {"peak_speed_at": lambda **by: 0.004, "slip_start": lambda: None}
    kinds = {
        "one": population(study(1)),
        "one still": population(study(1, subjects=study(2).subjects[1:], fit=None,
                                      of=lambda _: np.ones(1))),
        "own": population(study(by_friction=None, failed=0, correlation=lambda: None)),
        "none heard": population(study(subjects=quiet)),
        "dry": population(study(setting=dry, fit=None, full=True)),
        "still": population(study(**still), SourcedValue(None, reason="no model")),
        "slow": population(study(peak_speed_at=lambda **by: 0.006)),
        "unknown": population(study(peak_speed_at=lambda **by: None, pressure_error=None,
                                    rows=lambda: np.array([np.nan, 1.0]),
                                    highest_seen=lambda: 0.9)),
        "few": population(study(4)), "seen": population(study(highest_seen=lambda: None)),
    }  # fmt: skip
    told: dict[str, Any] = {"whole": said(population(study()))}
    for name, one in kinds.items():
        told[name] = words(one)
    full = study(representative=SimpleNamespace(motion="full"))
    told["motion"] = [slips.shown_motion(study()).time, slips.shown_motion(full)]
    told["texts"] = [slips._value_text(one) for one in
                     (number(0.3, "m/s", 0.004), number(0.3, "m/s"), number(2e4, "Pa", 1e3),
                      number(None, reason="nobody"))]  # fmt: skip
    told["limit"] = slips.BLIND
    held(file_regression, told)


ROWS = f"""file,person,item,quantity,value,caution
a,S1,1,rcof,0.20,no
a,S1,2,rcof,0.24,yes
a,S1,{MEAN_OF_STEPS},rcof,0.9,no
b,S2,1,rcof,0.26,no
b,S2,2,rcof,0.28,no
c,,1,rcof,0.7,no
c,S2,1,speed,0.7,no
c,S2,1,rcof,,no
"""


def test_measured_walkers(file_regression, tmp_path):
    texts = {
        "two": ROWS, "one": "\n".join(ROWS.splitlines()[:3]), 
        "files": ROWS.replace("S1", "").replace("S2", ""),
        "alike": ROWS.replace("0.20", "0.27").replace("0.24", "0.27"),
        "one step": "\n".join(ROWS.splitlines()[:2]), "none": ROWS.replace("rcof", "x"),
        "single steps": "file,person,item,quantity,value\na,A,1,rcof,0.2\na,B,1,rcof,0.3\n",
    }  # fmt: skip
    told: dict[str, Any] = {}
    for name, text in texts.items():
        path = tmp_path / f"{name}.csv"
        path.write_text(text)
        try:
            one = slips.measured_rcof(path)
            told[name] = one, one.settings(steps=False), one.settings(steps=True)
        except InputError as error:
            told[name] = str(error)
    told["gone"] = refusal(slips.measured_rcof, tmp_path / "gone.csv")
    (tmp_path / "walk.csv").write_bytes(EXPORTS["walk.csv"]())
    (tmp_path / "own.csv").write_text(
        "time [s],vertical [N],shear [N]\n" + "".join(
            f"{0.01 * k},{700 * np.sin(0.05 * k):.3f},{90 * np.sin(0.1 * k):.3f}\n"
            for k in range(1, 62)))  # fmt: skip
    for name in ("walk.csv", "own.csv", "gone.csv"):
        try:
            told[name] = [one.name for one in slips.own_histories(tmp_path / name)]
        except Exception as error:  # how it is refused is what is held
            told[name] = f"{type(error).__name__}: {error}"
    held(file_regression, told)


def test_slips_are_asked_for(file_regression, monkeypatch):
    asked: list[Any] = []

    def simulated(case, **options):
        options.pop("progress")("slips", 1.0)
        asked.append(options)
        return study()

    def run(case, **options):
        options.pop("progress")("run", 1.0)
        asked.append(options)
        return made.result()

    heard: list[Any] = []
    monkeypatch.setattr(slips, "slips", simulated)
    monkeypatch.setattr(slips, "run", run)
    first = slips.slip_population(PAD, progress=lambda *told: heard.append(told[:2]))
    slips.slip_population(PAD, subjects=3, histories=cast(Any, ["h"]), full_model=True, quick=False)
    held(file_regression, [asked, heard, first.model, first.name, first.predicted])


# tests by a method, sensitivities, risks


def test_methods_of_made_up_runs(file_regression, monkeypatch):
    asked: list[Any] = []

    def answer(case, at):
        if "forepart" in case.name:
            return made.FAILED
        scalars = made.scalars(cof=0.2 + 0.1 * at)
        scalars["cof"] = spread(0.2 + 0.1 * at, 0.1, 0.5 + at)
        return dataclasses.replace(made.outcome(), scalars=scalars, assumptions=("as given",))

    def band(case, **options):
        options.pop("progress")
        asked.append(["sensitivity", options])
        return made.sensitivity()

    monkeypatch.setattr(method, "outcomes", noted(asked, answer))
    monkeypatch.setattr(method, "sensitivity", band)
    told: dict[str, Any] = {}
    whole = PAD.replace({"shoe.heel.plan": "sole", "shoe.heel.length": "280 mm",
                         "shoe.heel.width": "68 mm", "shoe.heel.waist_width": "58 mm",
                         "shoe.heel.ball_width": "100 mm"})  # fmt: skip
    for name, case, how, options in (
        ("iso", PAD, "iso13287", {}), ("law alone", PAD, "astmf2913", {"with_band": False}),
        ("kept", PAD, "iso13287", {"keep": ("floor", "speed", "contaminant"), "quick": True,
                                   "processes": 2}),
        ("report", PAD, "report-slip-tester", {}), ("flat", whole, "iso13287-flat", {}),
        ("heel piece", PAD, "iso13287-forepart", {}),
    ):  # fmt: skip
        try:
            one: Any = method.method_prediction(case, how, **options)
            told[name] = said(one) if name == "iso" else words(one)
        except InputError as error:
            told[name] = str(error)
    failed = dataclasses.replace(made.outcome(), status=Status.NOT_CONVERGED)
    monkeypatch.setattr(method, "outcomes", noted(asked, lambda case, at: failed))
    told["failed"] = words(method.method_prediction(PAD, "iso13287"))
    bare = dataclasses.replace(made.outcome(), scalars=made.scalars(spread=None))
    monkeypatch.setattr(method, "outcomes", noted(asked, lambda case, at: bare))
    told["no spread"] = words(method.method_prediction(PAD, "iso13287", with_band=False))
    told["asked"] = asked
    held(file_regression, told)


def test_sensitivities_and_risks_of_made_up_runs(file_regression, monkeypatch):
    asked: list[Any] = []
    monkeypatch.setattr(
        sensitivity, "outcomes", noted(asked, lambda case, at: made.outcome(0.1 + 0.01 * at))
    )
    inputs = [OpenInput("motion.speed", 1.2, "r", ratio=True),
              OpenInput("shoe.material.shore_a", 3.0, "s")]  # fmt: skip
    one = sensitivity.sensitivity(PAD, inputs=inputs, processes=3)
    told: dict[str, Any] = {
        "effects": [[e.path, e.low_value, e.high_value, e.unit, e.low.number("cof"),
                     e.high.number("cof")] for e in one.effects],
        "all": len(sensitivity.sensitivity(PAD, quick=False).effects),
    }  # fmt: skip
    told["paths"] = [each.path for each in sensitivity.open_inputs(PAD)]
    soft = PAD.replace({"shoe.material.modulus": "4 MPa"})
    told["of a modulus"] = [each.path for each in sensitivity.open_inputs(soft)]

    def run(case, **options):
        options.pop("progress")("run", 1.0)
        asked.append(["run", options])
        return made.result(case_hash=case.hash)

    def changed(case, present, tried, **options):
        options.pop("progress")("changes", 0.5)
        asked.append(["changes", len(tried), options])
        return (made.change("good"),)

    monkeypatch.setattr(risk, "run", run)
    monkeypatch.setattr(risk, "change_effects", changed)
    heard: list[Any] = []
    first = risk.risk_assessment(PAD, target=0.1, progress=lambda *a: heard.append(a[:2]))
    told["risk"] = words(first), first.missing_friction, first.models, first.target
    given = made.result(case_hash=PAD.hash, data=made.result().data.assign(
        made.draws(0.1 + 0.02 * np.sin(np.arange(200)))))  # fmt: skip
    second = risk.risk_assessment(PAD, result=given, changes=[], processes=2, quick=False,
                                  progress=lambda *a: heard.append(a[:2]))  # fmt: skip
    told["drawn"] = words(second), second.missing_friction, second.models
    lost = dataclasses.replace(given, status=Status.NOT_CONVERGED)
    told["lost"] = words(risk.risk_assessment(PAD, result=lost))
    told["refused"] = [refusal(risk.risk_assessment, PAD, target=0.0),
                       refusal(risk.risk_assessment, PAD, target=1.0),
                       refusal(risk.risk_assessment, PAD, result=made.result("other"))]  # fmt: skip
    told["asked"], told["heard"] = asked, heard
    held(file_regression, told)


# changes beside a march


def test_effects_of_changes(file_regression, monkeypatch):
    normal = 0.02 * np.sin(np.arange(60))

    class March:
        def __init__(self, values, draws):
            self.values, self.cof_draws = values, draws
            self.cof = number(values["cof"], "1", 0.01)

        def continue_march(self, changes):
            if "motion.normal_force" in changes:
                raise ConvergenceError("too far")
            far = "shoe.heel.facet_angle" in changes
            one = March({"cof": 0.25, "fluid_load": 30.0}, 0.25 * np.exp(normal))
            one.errors = {"cof": 0.5 if far else 0.001}
            return one

    changes = [
        Change("wider", "w", "maker", {"shoe.tread.channel_width": "4 mm"}),
        Change("steeper", "s", "maker", {"shoe.heel.facet_angle": "9 deg"}),
        Change("harder", "h", "maker", {"shoe.material.shore_a": 80.0}),
        Change("lighter", "l", "walker", {"motion.normal_force": "200 N"}),
        Change("shorter steps", "p", "walking", {"risk.rcof_mean": 0.15}),
        Change("not", "n", "maker", {}, "can't be done"),
        Change("wrong", "n", "maker", {"shoe.tread.depth": "90 mm"}),
    ]  # fmt: skip
    asked: list[Any] = []

    def answer(case, at):
        if at == 1:
            return made.FAILED
        return dataclasses.replace(
            made.outcome(0.18 + 0.01 * at, fluid=40.0), maps={"cof_draws": 0.18 * np.exp(normal)}
        )

    at_one = {"position_cof": ("p", np.ones(2), {"as_described": 0.11}),
              "position_fluid_load": ("p", np.ones(2), {"as_described": 90.0})}  # fmt: skip
    data = made.result().data.assign(made.draws(0.1 * np.exp(2 * normal)))
    present = made.result(data=data)
    spread_out = made.result(data=data.assign(at_one))
    march = March({"cof": 0.09, "fluid_load": 80.0}, 0.09 * np.exp(normal))
    told: dict[str, Any] = {}
    for key, lugs, there, how, result in (
        ("marched", True, march, {}, present),
        ("plain", False, march, {"processes": 3}, spread_out),
        ("no march", True, None, {}, spread_out), ("full", True, march, {"quick": False}, present),
    ):  # fmt: skip
        monkeypatch.setattr(effects, "_march", lambda *_, there=there: there)
        monkeypatch.setattr(effects, "has_lugs", lambda _, lugs=lugs: lugs)
        monkeypatch.setattr(effects, "outcomes", noted(asked, answer))
        heard: list[Any] = []
        found = effects.change_effects(
            PAD, result, changes, progress=lambda *a, heard=heard: heard.append(a[:2]), **how
        )
        told[key] = [
            [one.change.name, one.reason, one.number("cof"), one.number("fluid_load"),
             one.number("slip_probability"), one.error, one.higher]
            for one in found
        ]  # fmt: skip
        told[f"{key} heard"] = heard
    told["asked"] = asked
    walking = effects.change_effects(PAD, present, changes[4:6])
    told["walking"] = [one.number("slip_probability") for one in walking]
    monkeypatch.undo()
    told["seen"] = effects._continue_march(cast(Any, march), changes[3], True)
    held(file_regression, told)


# outcomes


def test_outcomes_are_kept(file_regression, monkeypatch, tmp_path):
    asked: list[Any] = []

    def run(case, *, quick):
        asked.append([case.motion.speed, quick])
        if case.motion.speed == 0.2:
            raise ConvergenceError("no answer")
        return made.result(case.name, cof=case.motion.speed)

    class Kept(Cache):
        def __init__(self, room):
            super().__init__(room)
            self.folder = tmp_path / room

    monkeypatch.setattr(outcomes, "run", run)
    monkeypatch.setattr(outcomes, "Cache", Kept)
    cases = [made.CASE.replace("motion.speed", f"{v} m/s") for v in (0.1, 0.2, 0.1, 0.4)]
    heard: list[Any] = []
    found = outcomes.outcomes(
        cases, maps=("contact_pressure",), progress=lambda *a: heard.append(a[:2])
    )
    again = outcomes.outcomes(cases, maps=("contact_pressure",), stage="again")
    outcomes.outcomes(cases[:1], quick=True, cached=False)
    outcomes.outcomes(cases[:1], quick=True)
    held(
        file_regression,
        {
            "cof": [one.number("cof") for one in found], "status": [one.status for one in found],
            "names": [[one.name, one.case_hash == one.name] for one in found[:2]],
            "message": found[1].remedy, "maps": [sorted(one.maps) for one in found],
            "same": found[0] is found[2], "asked": asked, "heard": heard,
            "again": [one.number("cof") for one in again],
            "map": again[0].maps["contact_pressure"],
        },
    )  # fmt: skip


# wear


def test_series_of_wear_of_made_up_runs(file_regression, monkeypatch):
    asked: list[Any] = []
    x, y = np.arange(0.0, 0.035, 5e-3), np.arange(-0.015, 0.016, 5e-3)

    def answer(case, at):
        maps = {"x": x, "y": y, "cof_draws": np.linspace(0.1, 0.2, 20)}
        maps |= {name: np.add.outer(1e3 * x, y) + k for k, name in enumerate(wear.MAPS)}
        rough = case.value("interface.roughness_beyond_cutoff") or 1.0
        soft = (68.0 / case.value("shoe.material.shore_a")) ** 0.5 * rough**-0.3
        lost = 2.0 * at if case.value("shoe.wear.mode") == "patch" else 1e3 * case.shoe.wear.depth
        one = made.outcome(0.2 - 0.01 * lost * soft, fluid=(2.0 + 8.0 * lost) * soft)
        return dataclasses.replace(one, maps=maps)

    monkeypatch.setattr(wear, "outcomes", noted(asked, answer))
    told: dict[str, Any] = {}
    for mode, options in (
        ("plane", {"steps": 3, "limit": 9.0}),
        ("patch", {"steps": 2, "band": False, "quick": False}),
        ("walk", {"steps": 2, "band": False, "deepest": 1e-3, "seed": 3, "draws": 50}),
    ):
        one = wear.wear_series(PAD, mode=mode, **cast(Any, options))
        told[mode] = words(one)
        fields = one.fields()
        told[f"{mode} fields"] = {name: fields[name].values for name in fields.data_vars}
        told[f"{mode} numbers"] = one.data_tables()["wear"].rows[-1], one.assumptions, one.limit
        told[f"{mode} maps"] = [{name: np.isfinite(v).sum() for name, v in maps.items()}
                                for maps in one.maps]  # fmt: skip
    told["trends"] = wear.trends(one)
    told["asked"] = asked
    deep = PAD.replace({"shoe.wear.depth": "0.5 mm"})
    told["worn"] = wear._replaced_wear_note(deep), worn_states.tread_and_heel(PAD)
    told["refused"] = [
        refusal(wear.wear_series, PAD, mode="odd"), refusal(wear.wear_series, PAD, steps=1),
        refusal(wear.wear_series, made.CASE), refusal(wear.wear_series, PAD, limit=0.0),
        refusal(wear.wear_series, PAD, limit=1e6),
        refusal(wear.wear_series, PAD, pair=cast(Any, SimpleNamespace(lost=9e-3))),
    ]  # fmt: skip
    given = np.array([1.0, 2.0, 3.0, np.nan])
    rows = ([1, 2, 3, 9.0], [3, 2, 2.5, 1], [1, 1, 1, 1])
    told["ranks"] = [wear._rank("f", given, np.array(y), sign) for y in rows for sign in (1, -1)]
    told["sizes"] = [wear._size(v, u) for v, u in ((1.2345e-3, "m"), (0.2, "m"), (2e-4, "m^2"))]
    held(file_regression, told)


# contacts


def test_surfaces_and_rubbers(file_regression, tmp_path, monkeypatch):
    x = np.arange(0, 2.0, 0.01)
    (tmp_path / "p.csv").write_text("x [mm],z [um]\n" + "".join(
        f"{a:.3f},{3 * np.sin(9 * a) + np.sin(40 * a + 1):.5f}\n" for a in x))  # fmt: skip
    (tmp_path / "prony.csv").write_text("tau (s),E_i (MPa)\ninf,1\n0.01,2\n1,1\n")
    hertz = np.geomspace(0.1, 100, 10)
    (tmp_path / "dma.csv").write_text("f (Hz),E' (MPa),E'' (MPa)\n" + "".join(
        f"{f:.4g},{2 * f**0.1:.5g},{0.4 * f**0.1:.5g}\n" for f in hertz))  # fmt: skip
    both = [f"{t},{f:.4g},{2 * f**0.1:.5g},{0.4 * f**0.1:.5g}" for t in (0, 20) for f in hertz]
    (tmp_path / "two.csv").write_text("\n".join(["T (degC),f (Hz),E' (MPa),E'' (MPa)", *both]))
    told: dict[str, Any] = {}
    for name, options in {
        "rms": {"rms": "5 um"}, "rms and all": {"rms": "5 um", "hurst": 0.6, "longest": "1 mm",
        "shortest": "300 um", "seed": 2}, "board": {"checkerboard": ("20 um", "0.4 mm")},
        "profile": {"file": tmp_path / "p.csv"}, "part": {"file": tmp_path / "p.csv",
        "longest": "0.8 mm", "shortest": "0.3 mm", "seed": 1}, "few": {"rms": "5 um", "points": 7},
        "many": {"rms": "5 um", "points": 8193}, "two": {"rms": "5 um", "checkerboard": ("1 um",
        "1 mm")}, "none": {},
    }.items():  # fmt: skip
        try:
            one = contact.surface_from(**cast(Any, {"points": 32, **options}))
            told[name] = one.heights, one.spacing, one.processing
        except InputError as error:
            told[name] = str(error)
    for name, options in {
        "modulus": {"modulus": "5 MPa"}, "shore": {"shore": 60.0}, "hard": {"shore": 95.0},
        "name": {"name": "neolite"}, "prony": {"spectrum": tmp_path / "prony.csv"},
        "sweep": {"spectrum": tmp_path / "dma.csv"}, "sweeps": {"spectrum": tmp_path / "two.csv"},
        "profile": {"spectrum": tmp_path / "p.csv"}, "no": {}, "both": {"shore": 1.0, "name": "a"},
    }.items():  # fmt: skip
        try:
            rubber = contact.rubber_from(**cast(Any, options))
            at = rubber[0] if isinstance(rubber[0], float) else rubber[0].storage_modulus(10.0)
            told[f"rubber {name}"] = float(at), rubber[1], rubber[2]
        except Exception as error:  # how it is refused is what is held
            told[f"rubber {name}"] = f"{type(error).__name__}: {error}"
    asked: list[Any] = []

    def table(density, waves, rubber, pressures, speeds, **options):
        options.pop("progress")
        asked.append([waves, rubber, pressures, speeds, options.pop("shoe") is None,
                      options.pop("cache") is not None, options])  # fmt: skip
        return "a table"

    monkeypatch.setattr(contact, "table_over_scales", table)
    soft: Any = (5e6, "soft", [])
    contact.measured_table(tmp_path / "p.csv", soft, speed=0.3)
    contact.measured_table(tmp_path / "p.csv", soft, speed=0.3, shoe=tmp_path / "p.csv",
                           poisson_ratio=0.45, longest=1e-3, device="cuda")  # fmt: skip
    told["tables"] = asked
    told["at rest"] = refusal(contact.measured_table, tmp_path / "p.csv", soft, speed=0.0)
    floor = contact.surface_from(rms="5 um", points=128)
    one = contact.rough_contact(floor, soft, pressure=2e5, scales=True)
    two = contact.rough_contact(
        floor, contact.rubber_from(spectrum=tmp_path / "prony.csv"), pressure=1e5, speed=0.1
    )
    told["contact"] = words(one), one.to_dict(), one.remarks()
    told["sliding"] = words(two)
    small = contact.surface_from(checkerboard=("20 um", "0.4 mm"), points=8)
    told["one wave"] = refusal(contact.rough_contact, small, soft, pressure=1e5, scales=True)
    held(file_regression, told)


# comparisons


def test_what_would_tell_two_results_apart(file_regression, monkeypatch):
    asked: list[Any] = []
    heard: list[Any] = []

    class March:
        def __init__(self, case):
            self.level = 1.0 if case.name == "a" else 1.02
            if case.name == "lost":
                raise ConvergenceError("no")

        def continue_march(self, changes):
            asked.append(dict(changes))
            if "shoe.wear.depth" in changes:
                raise InputError("too deep")
            draws = self.level * (0.2 + 0.01 * np.sin(np.arange(80) * (1 + self.level)))
            if changes.get("contaminant") == "canola_oil":
                return SimpleNamespace(cof_draws=None)
            return SimpleNamespace(cof_draws=draws + 0.1 * (self.level - 1) * len(asked))

    monkeypatch.setattr(separation, "Continuation", March)
    cases = [TREADED.replace("name", name) for name in ("a", "b", "lost")]
    first, second, lost = cases
    found = separation.of_conditions(first, second, progress=lambda *a: heard.append(a[:2]))
    data, places = made.result().data, np.arange(200)
    drawn = [
        dataclasses.replace(
            made.result(name, cof=0.2, case=case,
                        data=data.assign(made.draws(0.2 + 0.03 * np.sin(places * (1 + k))))),
            provenance=dataclasses.replace(made.result(name).provenance,
                                           closures={"friction": "pair"}),
        )
        for k, (name, case) in enumerate(zip("ab", cases, strict=False))
    ]  # fmt: skip
    told: dict[str, Any] = {
        "steps": [[one.kind, one.value, one.told, one.step] for one in found],
        "lost": separation.of_conditions(first, lost), "heard": heard, "asked": asked[:4],
    }  # fmt: skip
    for name, separate in (("separate", True), ("reading alone", False)):
        one = comparison.compare(*drawn, separate=separate)
        told[name] = one.headline(), one.cautions(), [s.kind for s in one.separations], one.order

    def run(case, *, quick, progress):
        progress("run", 1.0)
        return drawn[case.name == "b"]

    monkeypatch.setattr(comparison, "run", run)
    heard.clear()
    cased = comparison.compare(first, second, progress=lambda *a: heard.append(a[:2]))
    told["cases"] = cased.headline(), list(heard), cased.differences
    coarse = dataclasses.replace(drawn[1], data=made.sole(side=5e-3, sensors=2).assign(
        made.draws(np.linspace(0.1, 0.3, 200))))  # fmt: skip
    told["grids"] = comparison.compare(drawn[0], coarse).cautions()
    told["chance"] = comparison.chance_higher(*drawn), comparison.chance_higher(drawn[1], drawn[0])
    told["names"] = comparison.with_short_names([("shoe.outsole.file", "/a/x.stl", "/b/x.stl"),
                                                 ("a", "1", "2")])  # fmt: skip
    near = Path(__file__).parent / "test_questions_asked"
    told["near"] = refusal(comparison.check_paths, [near, near]).partition("tests/")[0][:40]
    held(file_regression, told)
