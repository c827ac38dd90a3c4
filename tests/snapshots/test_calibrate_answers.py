"""Compounds, laws of readings, fits and curves as they come out of small made-up tests."""

from pathlib import Path

import numpy as np
import pytest

from snapshot import held, refusal
from underfoot.calibrate import Parameter, calibrate_model, pair_readings
from underfoot.calibrate.compound import Compound, compound_from_files
from underfoot.calibrate.law_file import law_file_text, law_table, trial_readings
from underfoot.calibrate.pair_readings import PairReading, calibrated_pair, read_pair_readings
from underfoot.calibrate.pin_regimes import _spans, pin_regimes
from underfoot.calibrate.stribeck_curve import stribeck_curve
from underfoot.calibrate.stribeck_points import fluid_points, pin_on_disk, roughness_series
from underfoot.calibrate.trial_laws import stribeck_law_from_fit
from underfoot.case import Case
from underfoot.case.friction import measured_fluids
from underfoot.core import UnderfootError
from underfoot.friction import packaged_pair_draws
from underfoot.material import power_law_spectrum
from underfoot.material.durometer_scales import SHORE_A, DurometerReading
from underfoot.trials.machines.stribeck_fit import stribeck_fit

TRUTH = power_law_spectrum(4e6, 0.1, shortest_time=1e-6, longest_time=1e4)


def answer(call, *args, **options):
    """What a call gives, or the error that it ends with."""
    try:
        return call(*args, **options)
    except UnderfootError as error:
        return f"{type(error).__name__}: {error}"


def written(path: Path, heads: str, *columns) -> Path:
    rows = [",".join(f"{x:.6g}" for x in row) for row in zip(*columns, strict=True)]
    path.write_text("\n".join([heads, *rows, ""]))
    return path


@pytest.fixture
def tests(tmp_path):
    """Files of one rubber: sweeps at one and four temperatures, holds, a series, a block."""
    time, hertz = np.geomspace(1e-2, 1e3, 40), np.geomspace(0.1, 100, 13)
    w = 2 * np.pi * hertz
    heads = "f (Hz),E' (MPa),E'' (MPa)"
    parts = TRUTH.storage_modulus(w) / 1e6, TRUTH.loss_modulus(w) / 1e6
    files = {
        "sweep": written(tmp_path / "sweep.csv", heads, hertz, *parts),
        "shear": written(tmp_path / "shear.csv", "f (Hz),G' (MPa),G'' (MPa)", hertz, *parts),
    }
    rows = []
    for celsius in (-10.0, 5.0, 20.0, 35.0):
        shifted = w * 10 ** (-0.08 * (celsius - 20.0))
        both = TRUTH.storage_modulus(shifted) / 1e6, TRUTH.loss_modulus(shifted) / 1e6
        rows.append(np.column_stack((np.full(13, celsius), hertz, *both)))
    files["sweeps"] = written(tmp_path / "sweeps.csv", f"T (degC),{heads}", *np.vstack(rows).T)
    modulus = TRUTH.relaxation_modulus(time) / 1e6
    files["hold"] = written(tmp_path / "hold.csv", "t (s),E (MPa)", time, modulus)
    files["stiffer"] = written(tmp_path / "stiffer.csv", "t (s),E (MPa)", time, 1.2 * modulus)
    files["short"] = written(tmp_path / "short.csv", "t (s),E (MPa)", time[-9:], modulus[-9:])
    rough = modulus * (1 + 0.04 * np.sin(5 * np.arange(40)))
    files["rough"] = written(tmp_path / "rough.csv", "t (s),E (MPa)", time, rough)
    files["rising"] = written(tmp_path / "rising.csv", "t (s),E (MPa)", time, modulus[::-1])
    files["series"] = written(
        tmp_path / "series.csv", "tau (s),E_i (MPa)", [1e-4, 1e-2, 1, 100], [2, 1, 0.5, 0.3]
    )
    files["times"] = written(
        tmp_path / "times.csv", "tau (s),E_i (MPa)", [1e-10, 1e-2, 1, 1e7], [2, 1, 0.5, 0.3]
    )
    seconds = np.arange(4000) * 0.02
    pressed = np.clip(seconds / 2.0, 0, 1)
    force = 300 * pressed * (1 + np.maximum(seconds - 2, 0)) ** -0.1
    heads = "time (s),displacement (mm),force (N)"
    files["block"] = written(tmp_path / "block.csv", heads, seconds, 2.0 * pressed, force)
    (tmp_path / "words.csv").write_text("a,b\n1,2\n3,4\n5,6\n")
    files["words"] = tmp_path / "words.csv"
    return files


def seen(compound):
    if not isinstance(compound, Compound):
        return compound
    modulus = compound.modulus()
    return {
        "headline": compound.headline(),
        "modulus": [modulus.value, modulus.uncertainty, modulus.source, modulus.reason],
        "tables": [
            f"{table.title}: " + "; ".join(" | ".join(map(str, row)) for row in table.rows)
            for table in compound.tables()
        ],
        "data": {name: table.rows for name, table in compound.data_tables().items()},
        "heads": {name: table.columns for name, table in compound.data_tables().items()},
        "toml": compound.toml(),
        "told": compound.to_dict(),
        "at": compound.temperature,
    }


BLOCK = {"thickness": 5.5e-3, "area": 1.6e-4}
SHORE = DurometerReading(68.0, SHORE_A)


@pytest.mark.parametrize(
    ("name", "files", "given"),
    [
        ("hold", ["hold"], {}),
        ("shear", ["shear"], {}),
        ("sweeps", ["sweeps"], {}),
        ("two", ["hold", "stiffer"], {"temperature": 300.0}),
        ("series", ["series"], {"equilibrium_modulus": 1e6}),
        ("block", ["block"], BLOCK),
        ("hardness", [], {"hardness": SHORE}),
        ("of_all_times", ["times"], {"equilibrium_modulus": 1e5}),
        ("at_rest_soft", ["series"], {"instantaneous_modulus": 3.8e6 * (1 + 1e-10)}),
    ],
)
def test_a_compound_in_full(name, files, given, tests, file_regression):
    made = answer(compound_from_files, [tests[file] for file in files], **given)
    held(file_regression, seen(made), f"compound_{name}")


def test_compounds_in_short(tests, file_regression):
    asked = {
        "sweep": (["sweep"], {}),
        "warm": (["sweep"], {"temperature": 310.0}),
        "of shear": (["hold"], {"shear": True}),
        "Poisson": (["shear"], {"poisson_ratio": 0.4}),
        "sweep and hold": (["sweep", "hold"], {}),
        "sweep and late hold": (["sweep", "short"], {}),
        "series and hold": (["series", "hold"], {"equilibrium_modulus": 1e6}),
        "rough": (["rough"], {}),
        "at 5 C": (["sweeps"], {"temperature": 278.15}),
        "at 90 C": (["sweeps"], {"temperature": 363.15}),
        "series of shear": (["series"], {"equilibrium_modulus": 1e6, "shear": True}),
        "block and sweep": (["block", "sweep"], BLOCK),
        "hold and hardness": (["hold"], {"hardness": SHORE, "polymer": "nitrile"}),
        "short": (["short"], {}),
        "rising": (["rising"], {}),
        "words": (["words"], {}),
        "no size": (["block"], {}),
        "nothing": ([], {}),
        "thickness alone": (["block"], {"thickness": 5e-3}),
        "in kPa": (["series"], {"modulus_unit": "kPa", "equilibrium_modulus": 1e6}),
        "at once": (["series"], {"instantaneous_modulus": 9e6}),
        "no rest": (["series"], {}),
    }
    told = {}
    for said, (files, given) in asked.items():
        made = answer(compound_from_files, [tests[file] for file in files], **given)
        told[said] = made
        if isinstance(made, Compound):
            terms = made.spectrum
            told[said] = {
                "is": [repr(made).partition("at once,")[0], *made.headline()],
                "modulus": made.modulus().value,
                "spread": made.modulus().uncertainty,
                "rest": None if terms is None else terms.equilibrium_modulus,
                "tested": made.tested,
                "notes": [str(note) for note in made.notes],
                "warnings": [str(one) for one in made.warnings],
                "at": made.temperature,
            }
        else:
            told[said] = made.replace(str(tests["words"].parent), "")
    held(file_regression, told)


def test_least_squares(file_regression):
    x = np.linspace(0.1, 2, 12)
    noise = 0.01 * np.sin(37 * np.arange(12))

    def line(v):
        return v["a"] + v["b"] * x

    def power(v):
        return v["a"] * x ** v["b"]

    def same(v):
        return (v["a"] + v["b"]) * x

    a, b = Parameter(1.0, -9.0, 9.0, "Pa"), Parameter(0.5, -9.0, 9.0)
    held(
        file_regression,
        {
            "line": calibrate_model(line, 2 + 3 * x + noise, {"a": a, "b": b}),
            "exact": calibrate_model(power, 2 * x**0.7, {"a": a, "b": b}).values,
            "weighed": calibrate_model(
                line, 2 + 3 * x + noise, {"a": a, "b": b}, deviation=0.02 * x, source="w"
            ),
            "logarithm": calibrate_model(
                power, 2 * x**0.7 + noise, {"a": Parameter(1.0, 1e-3, 1e3, "Pa", True), "b": b}
            ),
            "bound": calibrate_model(
                line, 2 + 3 * x + noise, {"a": Parameter(0.5, 0.0, 1.5), "b": b}
            ),
            "both bound": calibrate_model(
                line,
                2 + 3 * x + noise,
                {"a": Parameter(0.5, 0.0, 1.5), "b": Parameter(0.5, 0.0, 1.0)},
            ).at_bound,
            "not told apart": {
                name: [one.uncertainty, one.reason]
                for name, one in calibrate_model(
                    same, 3 * x + noise, {"a": a, "b": b}
                ).parameters.items()
            },
            "as many": [
                str(one.reason)
                for one in calibrate_model(
                    lambda v: np.array([v["a"], v["a"] + v["b"]]), [1.0, 3.0], {"a": a, "b": b}
                ).parameters.values()
            ],
            "error": calibrate_model(line, 2 + 3 * x + noise, {"a": a, "b": b}).mean_absolute_error,
            "refused": [
                refusal(calibrate_model, line, [1.0], {"a": a, "b": b}),
                refusal(calibrate_model, line, [1.0, np.nan, 2], {"a": a}),
                refusal(Parameter, 1.0, 1.0, 2.0),
                refusal(Parameter, 3.0, 1.0, 2.0),
                refusal(Parameter, 1.0, 0.0, 2.0, logarithmic=True),
            ],
        },
    )


READINGS = """file,verdict,fluid,shoe,COF,speed (m/s),viscosity (Pa s),friction force (N)
a,usable,water,A,0.40,0.05,0.001,5
b,usable,water,A,0.37,0.1,0.001,5
c,usable,water,A,0.30,0.2,0.001,5
d,usable,water,A,0.24,0.4,0.001,5
e,usable,water,A,0.19,0.8,0.001,5
f,usable,water,A,0.41,0.05,0.001,5
g,refused,water,A,0.90,0.8,0.001,5
h,usable,oil,A,0.12,0.1,0.05,5
i,usable,oil,A,0.10,0.4,0.05,5
j,usable,oil,B,0.11,0.4,0.06,5
k,usable,oil,A,,0.4,0.05,5
l,usable,oil,A,0.1,0,0.05,5
"""


def test_laws_of_readings(tmp_path, file_regression):
    (tmp_path / "tables").mkdir()

    def folder(text):
        (tmp_path / "tables" / "files.csv").write_text(text)
        return tmp_path

    def law(where, form="fit", pressure=None, text=READINGS):
        folder(text)
        found = answer(trial_readings, tmp_path, where)
        if isinstance(found, str):
            return found
        table = answer(law_table, found, form=form)
        return [found, table if isinstance(table, str) else law_file_text(table, pressure=pressure)]

    water, oil = {"fluid": "water"}, {"fluid": "oil"}
    rising = READINGS.replace("0.19,0.8", "0.60,0.8").replace("0.24,0.4", "0.5,0.4")
    held(
        file_regression,
        {
            "water": law(water),
            "pressure": law(water, pressure=2e5),
            "means": law(water, "readings"),
            "all": law(None),
            "oil": law(oil),
            "oil of A": law({**oil, "shoe": "A"}, "readings"),
            "oil of A, fit": law({**oil, "shoe": "A"}),
            "oil of B": law({"shoe": "B"}),
            "no such": law({"fluid": "watr"}),
            "no such name": law({"fluids": "water"}),
            "form": law(water, "fits"),
            "rising": law(water, text=rising),
            "rising means": law(water, "readings", text=rising),
            "no COF": law(water, text=READINGS.replace("COF", "mu")),
            "no speed": law(water, text=READINGS.replace("speed (m/s)", "pace")),
            "no verdicts": law(water, "readings", text=READINGS.replace("verdict", "told")),
            "two viscosities": law(
                water, "readings", text=READINGS.replace("0.37,0.1,0.001", "0.37,0.1,0.002")
            ),
            "absent": refusal(trial_readings, tmp_path / "tables"),
        },
    )


def test_fits_of_trials_as_laws(file_regression):
    speed = np.geomspace(0.05, 1.5, 12)
    falling = stribeck_fit(
        speed, 0.1 + 0.3 * np.exp(-speed / 0.3) + 0.004 * np.sin(9 * np.arange(12))
    )
    linear = stribeck_fit(speed, 0.4 - 0.2 * speed + 0.004 * np.sin(9 * np.arange(12)))
    flat = stribeck_fit(speed, 0.3 + 0.05 * np.sin(9 * np.arange(12)))
    held(
        file_regression,
        {
            "falling": stribeck_law_from_fit(falling, source="trials", viscosity=0.05),
            "linear": answer(stribeck_law_from_fit, linear, source="trials"),
            "flat": answer(stribeck_law_from_fit, flat, source="trials", fluid="water"),
        },
    )


SHOE = {"shoe": "work_shoe_untreaded", "floor": "vinyl_g4", "motion": "slip_tester_g4"}


def test_curves_over_speed(file_regression):
    glycerol = Case(name="a shoe", contaminant="glycerol_50pct", **SHOE)
    pair = Case(name="a pair", contaminant="water", friction={"model": "pair"}, **SHOE)
    curve = stribeck_curve(glycerol, "50 % glycerol", pressure=2e5, slowest=0.05, fastest=1.0)
    other = stribeck_curve(pair, "water", pressure=2e5, slowest=0.02, fastest=0.6)
    pin = pin_on_disk(glycerol.catalogue)
    held(
        file_regression,
        {
            "curve": curve,
            "rows": [curve.rows()[i] for i in (0, 9, -1)],
            "states": curve.states,
            "sentences": curve.regimes.sentences(),
            "other": other,
            "other rows": [other.rows()[i] for i in (0, 9, -1)],
            "told": {key: value for key, value in other.to_dict().items() if key != "rows"},
            "no pressure": refusal(
                stribeck_curve, glycerol, "x", pressure=0.0, slowest=0.1, fastest=1.0
            ),
            "dry": refusal(
                stribeck_curve,
                Case(name="dry", contaminant="none", **SHOE),
                "x",
                pressure=1e5,
                slowest=0.1,
                fastest=1.0,
            ),
            "regimes": pin_regimes(glycerol, 0.006, np.geomspace(0.01, 10, 6), 2e5),
            "spans": [
                _spans(np.array([0.1, 0.2, 0.4, 0.8]), names)
                for names in (["a"] * 4, ["a", "a", "b", "b"], ["a", "b", "c", "c"])
            ],
            "pin": pin,
            "series": roughness_series(glycerol.catalogue),
            "points": [fluid_points(one, rq=1e-6) for one in measured_fluids(glycerol.catalogue)],
        },
    )


def test_pairs_calibrated_to_readings(tmp_path, file_regression, monkeypatch):
    def whole(case, law, quick, progress):  # the solution of a whole sole takes minutes
        errors = law.draws.errors
        share = {"a shoe": 1.0, "another": 0.5}[case.name]
        return 0.2 * np.exp(share * sum(errors.values()))

    monkeypatch.setattr(pair_readings, "_whole_cof", whole)
    cases = [
        Case(
            name=name,
            contaminant="water",
            friction={"model": "pair"},
            **{**SHOE, "shoe": {"from": "work_shoe_untreaded", "roughness": {"rq": rq}}},
        )
        for name, rq in (("a shoe", "3 um"), ("another", "9 um"))
    ]
    start = packaged_pair_draws()
    few = start.rows(np.arange(0, start.count, 4))

    def told(*readings, draws=few, **options):
        found = answer(calibrated_pair, readings, draws=draws, **options)
        if isinstance(found, str):
            return found
        return {
            "says": [*found.headline(), *found.cautions()],
            "tables": [
                [[str(cell) for cell in row] for row in table.rows] for table in found.tables()
            ],
            "effective": found.effective,
            "source": found.draws.source,
            "count": found.draws.count,
            "errors": [found.draws.errors[name] for name in list(found.draws.errors)[:3]],
        }

    one, two = cases
    other = Case(
        name="measured", contaminant="glycerol_50pct", friction={"model": "stribeck"}, **SHOE
    )
    for name, text in {
        "good": '[[reading]]\ncase = "a.toml"\ncof = 0.24\nsd = 0.02\n'
        '[[reading]]\ncase = "a.toml"\ncof = 1\nkind = "upper"\n',
        "none": "",
        "more": "x = 1\n[[reading]]\ncof = 1\n",
        "key": '[[reading]]\ncase = "a.toml"\ncf = 1\n',
        "kind": '[[reading]]\ncase = "a.toml"\ncof = 1\nkind = "uper"\n',
        "large": '[[reading]]\ncase = "a.toml"\ncof = 5\n',
        "no case": "[[reading]]\ncof = 0.2\n",
        "words": 'reading = ["a"]\n',
        "sd": '[[reading]]\ncase = "a.toml"\ncof = 1\nsd = 0\n',
        "no list": "[reading]\ncof = 1\n",
    }.items():
        (tmp_path / f"{name}.toml").write_text(text)
    (tmp_path / "a.toml").write_text(
        'file_version = 2\nshoe = "work_shoe_untreaded"\nfloor = "vinyl_g4"\n'
        'contaminant = "water"\nmotion = "slip_tester_g4"\n'
    )
    read = {
        name: answer(read_pair_readings, tmp_path / f"{name}.toml")
        for name in (
            "good",
            "none",
            "more",
            "key",
            "kind",
            "large",
            "no case",
            "words",
            "sd",
            "no list",
        )
    }
    rows, errors = np.geomspace(0.05, 0.6, 5), np.full(5, 0.1)
    held(
        file_regression,
        {
            "value": told(PairReading(one, 0.24, 0.02)),
            "no sd": told(PairReading(one, 0.24), seed=4),
            "lower": told(PairReading(one, 0.24, 0.02, "lower")),
            "upper": told(PairReading(one, 0.15, kind="upper")),
            "two": told(PairReading(one, 0.24, 0.02), PairReading(two, 0.18, 0.02), quick=False),
            "far": told(PairReading(one, 3.0, 0.01)),
            "every draw": told(PairReading(one, 0.2, 0.02), draws=None)["says"],
            "of another law": told(PairReading(other, 0.2)),
            "excluded": told(
                PairReading(one, 0.3, kind="lower"), PairReading(one, 0.2, kind="upper")
            ),
            "weights": {
                kind: [
                    PairReading(one, 0.2, sd, kind).log_weight(rows, errors).round(6) + 0.0
                    for sd in (None, 0.01)
                ]
                for kind in ("value", "lower", "upper")
            },
            "words": [
                str(PairReading(one, 0.2468, kind=kind)) for kind in ("value", "lower", "upper")
            ],
            "read": {
                name: value
                if isinstance(value, str)
                else [[one.cof, one.sd, one.kind, one.case.name] for one in value]
                for name, value in read.items()
            },
        },
    )
