"""Questions: what they say of made-up outcomes, what they would try, and their numbers by hand."""

import dataclasses
import math
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

import made_answers as made
from snapshot import held, refusal
from underfoot.case import load
from underfoot.core import SourcedValue, Status
from underfoot.questions import (
    changes,
    comparison,
    method,
    order,
    outcomes,
    risk,
    sensitivity,
    separation,
    walked,
    wear,
    wear_limit,
    worn_states,
)
from underfoot.questions.wear_limit import Crossing, WearPoint
from underfoot.shoe.worn import WearMeasures

EXAMPLES = Path(__file__).parents[2] / "examples"
TREADED = load(EXAMPLES / "work_shoe_full_tread_glycerol.toml")


def said(shown):
    """Return all that an answer says of itself."""
    return {
        "heading": shown.heading(), "repr": repr(shown), "usable": shown.usable,
        "headline": shown.headline(), "cautions": shown.cautions(), "tables": shown.tables(),
        "remarks": shown.remarks(), "dict": shown.to_dict(), "data": shown.data_tables(),
    }  # fmt: skip


def words(shown):
    return [shown.headline(), shown.cautions(), [table.rows for table in shown.tables()]]


# risk


def spread(value, low, high):
    return SourcedValue(value, uncertainty=(high - low) / 4, interval=(low, high))


def of_slip(value, low, high, note=""):
    present = made.outcome()
    scalars = present.scalars | {"slip_probability": spread(value, low, high)}
    if note:
        scalars["slip_probability"] = dataclasses.replace(scalars["slip_probability"], note=note)
    return dataclasses.replace(present, scalars=scalars)


RISKS = {
    "several": lambda: made.assessment(
        made.change("good", higher=0.8),
        made.change("best", 0.3, 0.1, higher=0.99),
        made.change("worse", 0.05, 0.9),
        made.change("x", failure="not converged"),
        made.change("idle", 0.1003, 0.6003),
        made.change("toss-up", 0.099, 0.59, higher=0.5),
        made.change("sure", 0.12, 0.5, higher=0.56, error=0.003),
    ),
    "nothing helps": lambda: made.assessment(made.change("worse", 0.05, 0.9)),
    "failed": lambda: made.assessment(present=made.FAILED),
    "wide": lambda: made.assessment(
        made.change("good", 0.2, 0.1), present=of_slip(0.45, 0.002, 0.93)
    ),
    "rare": lambda: made.assessment(missing=0.0, present=of_slip(1e-4, 1e-5, 1e-3)),
    "enough": lambda: made.assessment(missing=None, present=of_slip(0.05, 0.04, 0.06)),
    "not enough": lambda: made.assessment(
        missing=None, present=of_slip(0.0501, 0.04, 0.06, "extrapolated: x")
    ),
    "apart": lambda: made.assessment(present=of_slip(0.3, 0.2, 0.4)),
}


@pytest.mark.parametrize("name", ["several", "others"])
def test_risks(file_regression, name):
    if name == "several":
        held(file_regression, said(RISKS["several"]()))
        return
    told: dict[str, Any] = {key: words(make()) for key, make in RISKS.items() if key != "several"}
    told["odds"] = [risk.odds(p) for p in (0.0, 1e-4, 1e-3, 0.01, 0.049, 0.1, 0.34, 0.5, 0.9, 1.0)]
    models = risk.model_risks(made.CASE, SourcedValue(0.2, uncertainty=0.02), None, 0.05)
    drawn = risk.model_risks(made.CASE, SourcedValue(0.2), np.linspace(0.15, 0.25, 50), 0.001)
    told["models"] = [
        [each.name, each.probability, each.low, each.high, each.needed]
        if hasattr(each, "needed")
        else dataclasses.astuple(each)
        for each in (*models, *drawn)
    ]
    told["best"] = [effect.change.name for effect in RISKS["several"]().best]
    held(file_regression, told)


# sensitivity


def test_sensitivities(file_regression):
    one = made.sensitivity()
    told: dict[str, Any] = {"whole": said(one), "failed": words(made.sensitivity(made.FAILED))}
    told["bands"] = {name: one.band(name) for name, _ in sensitivity.QUANTITIES.items()}
    told["ranked"] = [effect.path for effect in one.ranked_effects("cof")]
    without = dataclasses.replace(made.outcome(), scalars=made.scalars(spread=None))
    told["without a spread"] = words(made.sensitivity(without))
    for name, case in (("bare", made.CASE), ("treaded", TREADED)):
        told[name] = [
            (each.path, each.ends(float(case.value(each.path))), each.reason)
            for each in sensitivity.open_inputs(case)
        ]
        told[f"{name} variants"] = [
            [each.path, low, high, *(one.value(each.path) for one in at)]
            for each, low, high, *at in sensitivity.variants(case)
        ]
    held(file_regression, told)


# wear


def lost(k, cof, **numbers):
    return WearPoint(
        WearMeasures(k * 1e-3, (3 - k) * 1e-3, 3e-3, max(k - 1, 0) * 1e-4, 0, 0, k * 1e-9),
        made.outcome(cof, **numbers),
    )


def drawn_wear(cofs):
    """Return a series whose states have draws of COF, the middle one others than its ends."""
    made_of = made.wear(cofs)
    ends = [np.linspace(0.0, 1.0, 50), np.zeros(50), np.linspace(0.3, 0.9, 50)]
    points = [
        dataclasses.replace(
            point, outcome=dataclasses.replace(point.outcome, maps={"cof_draws": each})
        )
        for point, each in zip(made_of.points, ends, strict=True)
    ]
    return dataclasses.replace(made_of, points=tuple(points))


WEARS = {
    "rising": lambda: made.wear((0.1, 0.11, 0.12)), "falling": lambda: made.wear((0.12, 0.11, 0.1)),
    "patch": lambda: made.wear(mode="patch", quick=False),
    "bare": lambda: made.wear(untreaded=made.outcome(0.05)),
    "lost": lambda: made.wear((0.1, None, 0.1)), "one": lambda: made.wear((None, 0.1)),
    "one and bare": lambda: made.wear((None, 0.1), untreaded=made.outcome(0.05)),
    "none": lambda: made.wear((None, None)),
    **{str(kind): (lambda kind=kind: made.wear(crossing=kind)) for kind in Crossing},
    "varied": lambda: made.wear((0.1, 0.1), Crossing.NEVER,
                                variants=(("x", made.outcome(0.05), made.outcome(0.2)),)),
    "walked": lambda: made.wear(walker=walked.WearWalker(1e-15, None)),
    "pair": lambda: made.wear(walker=walked.WearWalker(1e-15, walked.WornPair(1e-3, None, 5.0))),
}  # fmt: skip


@pytest.mark.parametrize("name", ["walked", "others"])
def test_wear(file_regression, name):
    if name == "walked":
        held(file_regression, said(WEARS["walked"]()))
        return
    held(file_regression, {key: words(make()) for key, make in WEARS.items() if key != "walked"})


def test_how_sure_a_series_is(file_regression):
    held(
        file_regression,
        [drawn_wear(cofs).headline() for cofs in ((0.1, 0.2, 0.3), (0.3, 0.2, 0.1))],
    )


def test_where_a_load_exceeds_its_limit(file_regression):
    points = [lost(k, 0.1, fluid=load) for k, load in enumerate((20.0, 40.0, 90.0, 200.0))]
    varied = [
        dataclasses.replace(
            p, variants=(("x", made.outcome(fluid=0.7 * f), made.outcome(fluid=1.5 * f)),)
        )
        for p, f in zip(points, (20.0, 40.0, 90.0, 200.0), strict=True)
    ]
    gone = [dataclasses.replace(points[0], outcome=made.FAILED), *points[1:]]
    told = {}
    for name, given, limit in (
        ("within", points, 60.0), ("from new", points, 10.0), ("never", points, 900.0),
        ("at the last", points, 199.0), ("varied", varied, 60.0), ("gone", gone, 60.0),
        ("one", points[:1], 60.0),
    ):  # fmt: skip
        told[name] = wear_limit.limit_crossing(given, "fluid_load", limit, draws=300, seed=1)
    between = [p.measures for p in points for _ in (0, 1)]
    told["between"] = wear_limit.limit_crossing(
        points, "fluid_load", 60.0, draws=50, seed=2, between=between
    )
    told["first"] = wear_limit.first_exceeding(
        np.log([[1.0, 4.0, 9.0], [5.0, 1.0, 9.0], [1.0, 1.0, 1.0], [1.0, 1.0, 4.0]]), math.log(2.0),
        np.array([0.0, 0.5, 0.5, 1.0]),
    )  # fmt: skip
    held(file_regression, told)


def test_states_of_wear(file_regression):
    def states(mode, steps=3, deepest=None, case=TREADED):
        found = worn_states.worn_cases(case, mode, steps, deepest)
        return [
            {
                k: each.value(f"shoe.wear.{k}")
                for k in ("mode", "depth", "angle", "patch_length", "patch_width")
            }
            for each in found
        ]

    told: dict[str, Any] = {mode: states(mode) for mode in worn_states.MODES}
    told["deep"] = [states("plane", 2, 1e-3), states("patch", 2, 1e-4)]
    told["refused"] = [refusal(states, "plane", 2, deepest) for deepest in (0.0, 0.5)]
    told["between"] = worn_states.measures_between(TREADED, [TREADED] * 2, "plane", 1e-3)
    told["modes"] = [wear.wear_mode(None, TREADED), wear.wear_mode("patch", TREADED),
                     refusal(wear.wear_mode, "odd", TREADED)]  # fmt: skip
    told["limits"] = [wear.limit_load(text, 500.0) for text in ("5 N", "20 %", "0 N", "1 kN")]
    told["no limits"] = [refusal(wear.limit_load, text, 500.0) for text in ("x", "-1 N", "5")]
    told["deepest"] = [
        wear.deepest_wear("2 mm", "plane"),
        wear.deepest_wear("1500 mm^2", "patch"),
        wear.deepest_wear(None, "plane"),
        refusal(wear.deepest_wear, "2 mm", "patch"),
    ]
    held(file_regression, told)


def test_how_far_one_walks(file_regression):
    volumes, depths = [0.0, 1e-9, 3e-9, 9e-9], [0.0, 1e-3, 2e-3, 4e-3]
    walkers = {
        "rate": walked.WearWalker(1e-15, None),
        "by way": walked.WearWalker(1e-15, walked.WornPair(1.5e-3, 3e5)),
        "by time": walked.WearWalker(1e-15, walked.WornPair(1e-3, None, 5.0)),
    }
    told: dict[str, Any] = {}
    for name, walker in walkers.items():
        ways = [walker.walk_until(volume, volumes, depths) for volume in volumes]
        told[name] = [[way.distance, way.months, way.text] for way in ways]
    told["pairs"] = [
        walked.worn_pair(text)
        for text in (None, "1.2 mm after 300 km", "1 mm after 5 months", "1 mm in 2 years")
    ]
    told["refused"] = [
        refusal(walked.worn_pair, text)
        for text in (
            "1 mm",
            "0 mm after 3 km",
            "99 cm after 1 km",
            "1 mm after 3 kg",
            "x after 3 km",
        )
    ]
    told["beyond"] = refusal(walked._volume_at, 9e-3, volumes, depths)
    told["figures"] = [walked._one_figure(v) for v in (0.0, 0.0123, 0.99, 1.4, 15.0, 149.0, 3e6)]
    told["ranges"] = [walked._range(ends) for ends in ((1.0, 1.2), (1.0, 9.0), (0.0, 0.0))]
    held(file_regression, told)


# orders and comparisons


def test_orders(file_regression):
    rng = np.random.default_rng(3)
    first = 0.3 * np.exp(0.1 * rng.standard_normal(400))
    kinds = {
        "same": first, "higher": 1.3 * first, "a little": 1.02 * first, "shuffled": first[::-1],
        "none": 0 * first,
    }  # fmt: skip
    told: dict[str, Any] = {}
    for name, second in kinds.items():
        found = order.order_of_draws(first, second)
        told[name] = [
            found,
            found.verdict,
            found.told,
            order.certainty_after_reading(first, second, 0.1),
        ]
    values = {
        "interval": spread(0.3, 0.2, 0.5), "normal": SourcedValue(0.31, uncertainty=0.03),
        "at zero": spread(0.1, 0.0, 0.3), "bare": SourcedValue(0.3), "none": SourcedValue(None),
    }  # fmt: skip
    told["values"] = {
        f"{a}, {b}": order.order_of_values(values[a], values[b])
        for a in values
        for b in values
        if a < b
    }
    ends = ((0.75, 0.0), (0.7499, 0.0), (0.25, 0.0), (0.2501, 0.0), (0.9, 0.75), (0.9, 0.7499))
    told["verdicts"] = [order.Order(*each).verdict for each in ends]
    told["limits"] = [order.DECIDED, order.SEEN, order.STRATA]
    held(file_regression, told)


def test_what_would_tell_two_apart(file_regression):
    water = TREADED.replace({"contaminant": "water"})
    turned = TREADED.replace({"motion.shoe_angle": "13 deg"})
    worn = TREADED.replace({"shoe.wear.depth": "0.5 mm"})
    pairs = {"same": (TREADED, TREADED), "fluids": (TREADED, water), "angles": (TREADED, turned),
             "worn": (TREADED, worn), "bare": (TREADED, made.CASE),
             "turned": (turned, turned)}  # fmt: skip
    told: dict[str, Any] = {
        name: list(separation._conditions(*pair)) for name, pair in pairs.items()
    }
    steps = [
        separation.SeparatingStep(*each)
        for each in (
            ("reading", None, 0.8),
            ("fluid", "canola_oil", 0.9),
            ("angle", 0.2, 0.7),
            ("worn", 2e-3, 0.6),
        )
    ]
    told["steps"] = [each.step for each in steps]
    told["reading"] = separation.of_reading(np.linspace(0.2, 0.3, 50), np.linspace(0.21, 0.29, 50))
    held(file_regression, told)


def test_comparisons(file_regression):
    one, two, three = (
        made.result("a", cof=0.1),
        made.result("b", cof=0.103),
        made.result("c", cof=0.3, slip=0.1),
    )
    bare = made.result("d", cof=0.2, spread=None)
    drawn = [
        made.result(
            name, cof=cof, data=one.data.assign(made.draws(cof + 0.01 * np.sin(np.arange(200))))
        )
        for name, cof in (("e", 0.2), ("f", 0.21))
    ]
    told: dict[str, Any] = {"three": said(comparison.compare(one, two, three))}
    for name, several in (
        ("open", (one, two)),
        ("same", (one, one)),
        ("bare", (one, bare)),
        ("drawn", tuple(drawn)),
        ("failed", (one, made.result("g", status=Status.NOT_CONVERGED))),
    ):
        told[name] = words(comparison.compare(*several))
    told["refused"] = [refusal(comparison.compare, one), refusal(comparison.compare, *[one] * 13),
                       refusal(comparison.check_paths, [Path("/gone"), Path("/lost")])]  # fmt: skip
    told["intervals"] = [
        comparison.interval_95(each)
        for each in (spread(0.3, 0.2, 0.5), SourcedValue(0.3, uncertainty=0.1), SourcedValue(0.3))
    ]
    told["differences"] = comparison.case_differences(
        [TREADED, TREADED.replace({"motion.speed": "0.1 m/s"})]
    )
    told["none"] = comparison.case_differences([TREADED, TREADED])
    told["shortened"] = [comparison._shorten_cell(text) for text in ("a" * 64, "b", "/x/y.stl")]
    held(file_regression, told)


# changes, methods, outcomes


def test_changes_that_are_tried(file_regression):
    kinds = {
        "bare": made.CASE,
        "treaded": TREADED,
        "water": TREADED.replace({"contaminant": "water"}),
        "oil": TREADED.replace({"contaminant": "canola_oil"}),
        "dry": TREADED.replace({"contaminant": "none"}),
        "soft": TREADED.replace({"shoe.material.shore_a": 59.0}),
        "just": TREADED.replace({"shoe.material.shore_a": 60.0}),
        "thin tread": TREADED.replace({"shoe.tread.depth": "1.4 mm"}),
        "rough": TREADED.replace({"floor.roughness.rq": "6 um"}),
        "turned": TREADED.replace({"motion.shoe_angle": "17 deg"}),
    }
    held(
        file_regression,
        {
            name: [[each.name, each.action, each.lever, dict(each.values), each.reason]
                   for each in changes.possible_changes(case)]
            for name, case in kinds.items()
        },
    )  # fmt: skip


def test_methods(file_regression):
    names = ("iso13287", "ASTMF2913", "report slip-tester", "slip-prediction-13-deg")
    told: dict[str, Any] = {name: method.method_name(name, TREADED) for name in names}
    told["refused"] = [
        refusal(method.method_name, "iso", TREADED),
        refusal(method.method_prediction, TREADED, "iso13287", keep=("odd",)),
    ]
    told["chances"] = [method.probability_at_least(*given) for given in
                       ((0.3, 0.05, 0.3), (0.3, 0.05, 0.2), (0.3, 0.05, 0.36), (0.3, 0.0, 0.2),
                        (0.3, 0.0, 0.4))]  # fmt: skip
    for name in ("iso13287", "report_slip_tester"):
        entry = TREADED.catalogue.entry("setup", method.method_name(name, TREADED))
        told[f"{name} window"] = method._window(entry)
        found = []
        for condition, floor, fluid in method._conditions(entry):
            tested, settings = method._prepare_case(TREADED, entry, floor, fluid, ())
            found.append([condition, tested.motion.speed, tested.motion.shoe_angle, settings])
        told[name] = found
        kept = method._prepare_case(
            TREADED, entry, *method._conditions(entry)[0][1:], ("speed", "floor")
        )
        told[f"{name} kept"] = kept[1]
    told["sole"] = [method.has_whole_sole(TREADED), method.has_whole_sole(made.CASE)]
    told["sides"] = [method._sides(each) for each in
                     (spread(0.3, 0.2, 0.5), SourcedValue(0.3, uncertainty=0.1))]  # fmt: skip
    held(file_regression, told)


def test_outcomes(file_regression):
    result = made.result("a")
    outcome = outcomes.CaseOutcome.of(result, ("contact_pressure", "odd"))
    again = outcomes.CaseOutcome.from_text(outcome.as_text())
    assert again == outcome
    failed = dataclasses.replace(outcome, status=Status.NOT_CONVERGED)
    numbers = [[one.number(name), one.standard_deviation(name)] for one in (outcome, failed)
               for name in ("cof", "cof_viscous")]  # fmt: skip
    shown: Any = cast(Any, SimpleNamespace(maps=sorted(outcome.maps), seconds=outcome.seconds))
    held(file_regression, [vars(shown), numbers, outcome.remarks(), outcome.usable, failed.usable])
