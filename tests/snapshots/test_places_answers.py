"""Places: machines and what they read, draws that learn, files of places, the answer as pages."""

import dataclasses
import math
from types import SimpleNamespace

import numpy as np
import pytest

from snapshot import held, refusal, tried
from underfoot.case import Case
from underfoot.compute.resolve import resolve_context
from underfoot.core import SourcedValue
from underfoot.film.tapered_wedge import side_leakage, wedge_load_factor
from underfoot.friction.pair_contact import Pair, UnexpectedReading
from underfoot.places import calibration, cells, choice, evidence, joint, machines, place
from underfoot.places.calibration import FloorReading
from underfoot.places.joint import CofReading, PlaceDraws
from underfoot.places.place import place_of, read_place

UM = 1e-6
RQ = (1e-6, 4e-6)
COUNT = 400


def _draws():
    return PlaceDraws(count=COUNT, seed=3)


def _page(told):
    """Return everything that an answer tells in words."""
    return {
        "heading": str(told.heading()),
        "headline": [str(each) for each in told.headline()],
        "cautions": [str(each) for each in told.cautions()],
        "remarks": {name: [str(one) for one in each] for name, each in told.remarks().items()},
        "tables": [
            [str(each.title), " | ".join(map(str, each.columns))]
            + [" | ".join(map(str, row)) for row in each.rows]
            for each in told.tables()
        ],
    }


def test_machines(file_regression):
    """Settings of each machine, its classes around their limits, its readings of one floor."""
    answers = {}
    for name, device in machines.machines().items():
        limits = [limit + step for limit, _ in device.classes for step in (-0.01, 0.0, 0.01)]
        fluid = machines.FLUIDS[device.fluids[0]]
        values = (device.scale.least, device.scale.least + 0.1, device.most, device.most + 0.1)
        answers[name] = {
            "settings": [
                f"{field.name}: {getattr(device, field.name)}"
                for field in dataclasses.fields(device)
                if field.name != "entry"
            ],
            "told": [device.title, device.standard, device.reproducibility],
            "classes": [f"{limit:.2f} {device.class_of(limit)}" for limit in limits],
            "checked": [tried(device.check_reading, value, "x") for value in (*values, True, "3")],
            "read": [
                np.quantile(
                    device.draw_readings(_draws(), "hall", RQ, each), (0.1, 0.5, 0.9)
                ).tolist()
                for each in (fluid, machines.FLUIDS["dry"])
            ],
            "likely": [
                np.quantile(
                    device.log_likelihood(_draws(), "hall", RQ, fluid, device.most / 3, **more),
                    (0.1, 0.9),
                ).tolist()
                for more in ({}, {"kind": "lower"}, {"kind": "upper"}, {"sd": 0.05 * device.most})
            ],
        }
    held(file_regression, answers)


def test_readings_foretold(file_regression):
    pages = {
        "usual": machines.predicted_reading("pendulum-96"),
        "known": machines.predicted_reading("pendulum_55", (2 * UM, 3 * UM), seed=1),
        "ramp": machines.predicted_reading("ramp-oil", machines.rq_of_rz(40 * UM)),
        "unlearned": machines.predicted_reading("english-xl", fluid="oil"),
        "tribometer": machines.predicted_reading("bot-3000e", (9 * UM, 9 * UM), fluid="dry"),
    }
    answers = {}
    for name, told in pages.items():
        page = _page(told)
        page["tables"][1] = page["tables"][1][:8]  # the rest is the catalogue's
        answers[name] = page
    reading = UnexpectedReading("A machine", "PTV", 12.0, 20.0, 30.0, 40.0)
    answers["outside"] = [
        str(each) for each in dataclasses.replace(pages["usual"], outside=(reading,)).cautions()
    ]
    scales = {name: [each.reading(0.3), each.cof(20.0 if name != "cof" else 0.4), each.slope(0.3)]
              for name, each in machines.SCALES.items()}  # fmt: skip
    held(file_regression, {
        **answers, "scales": scales,
        "refused": [
            refusal(machines.machine, ""), refusal(machines.machine, "pendlum"),
            refusal(machines.machine_fluid, "watr"),
            refusal(machines.machine("ramp-oil").fluid_of_standard, "dry"),
            refusal(machines.predicted_reading, "ramp-oil", (0.5e-9, 1e-6)),
            refusal(machines.predicted_reading, "ramp-oil", (1e-6, math.inf)),
        ],
        "not refused": [str(machines.predicted_reading("ramp-oil", ends).median) for ends in
                        ((1e-9, 1e-6), (1e-6, 1e-3))],
    })  # fmt: skip


def test_bearing(file_regression):
    """Film and gap of an edge over taper, length and drag, over the ends of their tables."""
    edge = machines.Bearing((1e-3, 3e-3), 76e-3, 25.0)
    answers = {}
    for drag in (1e-4, 2.6e-3, 0.3):
        each = [np.full(4, x) for x in (160e3, 2e-3, drag)]
        taper, rq = np.array([0.1, 1.19, 2.0, 0.5]), np.array([1e-7, 1e-6, 5e-6, 2e-5])
        answers[str(drag)] = edge.film(*each, rq, 30e6, taper)
    answers["factors"] = machines._wedge_factors(
        np.array([0.1, 1.0, 2.0]), np.array([5e-3, 0.1, 3.0])
    )
    held(file_regression, answers)


def test_draws(file_regression):
    draws = _draws()
    aqueous, oily = Pair(60.0, RQ, RQ, "aqueous"), Pair(60.0, RQ, RQ, "oil")
    where = {"laboratory": "a", "floor": "hall", "sole": "s", "pressure": 2e5}
    answers = {
        "cof": [
            np.quantile(draws.contact_cof(pair, **where, drag=drag, middle=middle), (0.1, 0.5, 0.9))
            for pair in (aqueous, oily)
            for drag in (1e-3, 0.05)
            for middle in (False, True)
        ],
        "between": np.quantile(draws.drawn_between("x", (1.0, 16.0)), (0.0, 0.5, 1.0)),
        "floor": joint.floor_name(aqueous),
        "alike": [
            float(np.corrcoef(draws.beyond_roughness("hall", name, family),
                              draws.beyond_roughness("hall", "other", family))[0, 1])
            for name, family in (("one", "aqueous"), ("two", "detergent"), ("three", "oil"))
        ],
        "named": sorted(draws.values_of("floor", "x")),
        "interval": joint.interval(np.arange(1000.0)),
    }  # fmt: skip
    cof = np.array([1e-9, 0.1, 0.3, 0.9])
    small = PlaceDraws(count=4)
    answers["likely"] = [
        small.log_likelihood(cof, CofReading(0.3, kind, sd))
        for kind in joint.KINDS
        for sd in (None, 0.06)
    ]
    before = draws.fewest
    rows = draws.learn(-0.5 * np.linspace(-2, 2, COUNT) ** 2, "x")
    answers["learned"] = [
        before,
        draws.fewest,
        np.unique(rows).size,
        float(draws.share("x").mean()),
    ]
    answers["refused"] = [
        refusal(draws.learn, np.where(np.arange(COUNT) < 40, 0.0, -900.0), "floor hall"),
        refusal(CofReading, 0.3, "middle"), refusal(CofReading, 0.0), refusal(CofReading, 5.0),
        refusal(CofReading, 0.3, "value", 0.0), refusal(CofReading, 0.3, "value", 5.0),
    ]  # fmt: skip
    held(file_regression, answers)


def _case(**more):
    return Case(**{
        "shoe": "work_shoe_untreaded", "floor": {"roughness": {}}, "contaminant": "water",
        "motion": "whole_shoe_g6", **more,
    })  # fmt: skip


def test_floors_read(file_regression):
    """What a reading leaves of a floor: in a file, in a case, beside another one."""
    measured = {"floor": {"roughness": {"rq": {"value": "3 um", "uncertainty": "1 um"}}}}
    plain, exact = _case(**measured), _case(floor={"roughness": {"rq": "3 um"}})
    read = _case(friction={"model": "pair_read", "ptv_96": 40, "ramp_class": "R11"})
    answers = {}
    for name, (case, *given, kind) in {
        "value": (plain, "pendulum-96", 60.0, "value"),
        "lower": (plain, "ramp-oil", 20.0, "lower"),
        "upper": (plain, "bot-3000e", 0.3, "upper"),
        "given roughness": (exact, "english-xl", 0.9, "value"),
        "beside": (read, "bot-3000e", 0.5, "value"),
    }.items():
        told = calibration.calibrated_floor(case, *given, kind=kind)
        answers[name] = {
            "heading": str(told.heading()),
            "headline": list(map(str, told.headline())),
            "cautions": list(map(str, told.cautions())),
            "ends": [[f"{1e6 * x:.2g}" for x in each] for each in (told.before, told.after)],
            "left": [f"{told.effective:.2g}", told.draws.basis, told.draws.count],
            "source": told.draws.source[-90:],
            "errors": sorted(told.draws.errors),
        }
    again = dataclasses.replace(told, again=(machines.machine("ramp-oil"),))
    answers["again"] = str(again.cautions()[-1])
    option = read.friction
    answers["readings"] = [str(each.text) for each in option.floor_readings()]
    law = option.build(resolve_context(read))
    answers["law"] = {name: f"{float(value):.2g}" for name, value in law.medians.items()}
    answers["foretold"] = _page(calibration.machine_reading(read, method="pendulum_96"))["headline"]
    answers["kept"] = _page(
        calibration.machine_reading(plain, method="pendulum_96", keep=["contaminant"])
    )["cautions"]
    bounds = [calibration.class_bounds(machines.machine("ramp-oil"), each, "x") for each in
              ("no class", "R9", "R13")]  # fmt: skip
    answers["bounds"] = [[str(one.text) for one in each] for each in bounds]
    constant = plain.replace("friction", {"model": "constant", "cof": 0.3})
    answers["refused"] = [
        refusal(calibration.class_bounds, machines.machine("ramp-oil"), "R8", "x"),
        refusal(calibration.calibrated_floor, read, "pendulum-96", 36.0),
        refusal(calibration.calibrated_floor, plain, "pendulum-96", 0.4),
        refusal(calibration.calibrated_floor, constant, "pendulum-96", 36.0),
        refusal(calibration.machine_reading, plain, method="pendulum_96", keep=["speed"]),
        *(tried(_case, friction={"model": "pair_read", **each}) for each in (
            {}, {"ptv_96": 1}, {"ptv_55": 151}, {"barefoot_class": "D"}, {"dcof": 1.3})),
    ]  # fmt: skip
    held(file_regression, answers)


def test_published_readings(file_regression):
    """Each reading that was published, and scores of some that are made."""
    every = evidence.evidence()
    listed = [
        f"{each.floor} | {each.machine.name} | {each.rq[0]:.4g} {each.rq[1]:.4g} | {each.printed} "
        f"| {', '.join(str(one.value_text) for one in each.bounds)} | {each.ends} {each.middle}"
        for each in every
    ]
    pendulum = [each for each in every if each.machine.name == "pendulum-96" and each.middle][:5]
    rows = tuple(
        evidence.ScoredReading(
            each, (each.middle * low, each.middle * mid, each.middle * 1.4), rival
        )
        for each, low, mid, rival in zip(pendulum, (0.5, 0.8, 1.2, 0.9, 0.7), (0.9, 1.1, 1.3, 1, 1),
                                         (30.0, None, 25.0, 40.0, 35.0), strict=True)
    )  # fmt: skip
    scores = evidence.MachineScores(rows)
    held(file_regression, {
        "listed": listed,
        "inside": [[row.inside, row.error] for row in rows],
        "score": [evidence.score(part) for part in (rows, rows[:2], rows[1:2])],
        "page": {"headline": list(map(str, scores.headline())),
                 "tables": [[" | ".join(map(str, row)) for row in table.rows]
                            for table in scores.tables()]},
        "printed": len(scores.of("pendulum-96", printed=True)),
        "learned": evidence.learn_machine(machines.machine("ramp-oil"), every[0].source),
    })  # fmt: skip


def _table(**changes):
    table = {
        "fluids": {"dry": 0.9, "glycerol_90pct": 0.1},
        "floor": [{"name": "hall", "roughness": {"rq": "2 um"}}],
        "shoe": [
            {"name": "smooth", "from": "work_shoe_untreaded"},
            {"name": "treaded", "from": "work_shoe_full_tread"},
        ],
    }
    for path, value in changes.items():
        section, _, key = path.partition("__")
        if key:
            table[section] = [{**table[section][0], key: value}, *table[section][1:]]
        else:
            table[section] = value
    return table


_SHOES = [
    {"name": "old", "from": "work_shoe_full_tread", "present": True, "price": 60, "months": 6,
     "wear_per_month": "0.2 mm"},
    {"name": "ruled", "from": "work_shoe_full_tread", "worn_region": ["30 mm", "25 mm"]},
    {"name": "classed", "from": "work_shoe_untreaded", "class": "EN ISO 20345 SR",
     "reading": [{"test": "tile_glycerine", "cof": 0.3, "sd": 0.02},
                 {"test": "tile_glycerine", "cof": 0.2, "kind": "lower"}]},
]  # fmt: skip
_FLOORS = [
    {"name": "hall", "area": 60, "rz": "20 um", "slope": "5 deg",
     "reading": [{"machine": "pendulum-96", "value": 36},
                 {"machine": "ramp-oil", "value": 12, "kind": "lower", "sd": 1}]},
    {"name": "store", "area": 20, "fluids": {"dry": 0.5, "water": 0.3, "detergent": 0.2}},
    {"name": "dock", "area": 20, "from": "quarry_tile"},
]  # fmt: skip
_PEOPLE = {
    "rcof_mean": 0.22, "rcof_sd": 0.04, "steps_per_day": 5000, "days_per_year": 200,
    "reported_slips": 12,
    "task": [{"name": "walking", "share": 0.8}, {"name": "pushing", "share": 0.2, "rcof": 0.35}],
}  # fmt: skip
PLACES = {
    "small": {},
    "all": {"name": "works", "floor": _FLOORS, "shoe": _SHOES, "people": _PEOPLE},
    "nothing known": {"floor": [{"name": "a"}, {"name": "b"}]},
    "read alone": {"floor": [{"name": "a", "reading": [{"machine": "bot-3000e", "value": 0.5}]}]},
    "shares by half a percent": {"fluids": {"dry": 0.5, "water": 0.504}},
    "steepest": {"floor__slope": "15 deg"},
    "small region": {"shoe__from": "work_shoe_full_tread", "shoe__worn_region": ["2 mm", "70 mm"]},
    "one task": {"people": {"task": [{"rcof": 0.3}]}},
}
REFUSED = {
    "no table": {"floor": 3},
    "no floors": {"floor": []},
    "no name": {"floor": [{"rz": "20 um"}]},
    "blank name": {"shoe": [{"name": " "}]},
    "key": {"walls": 3},
    "key of a floor": {"floor__ptv": 3},
    "twice": {"shoe": [{"name": "a", "from": "work_shoe_untreaded"}] * 2},
    "two present": {"shoe": [{**each, "present": True} for each in _SHOES[:2]]},
    "all have fluids": {"floor__fluids": {"water": 1.0}},
    "some area": {"floor": [_FLOORS[0], {"name": "x"}]},
    "dry": {"fluids": {"dry": 1.0}},
    "shares": {"fluids": {"dry": 0.5, "water": 0.506}},
    "no shares": {"fluids": {}},
    "wrong share": {"fluids": {"dry": "much"}},
    "flag": {"people": {"rcof_mean": True}},
    "no fluids": {"fluids": None},
    "people": {"people": {"rcof_sd": 0.3}},
    "tasks": {"people": {"task": [{"share": 0.5}]}},
    "task": {"people": {"task": {"share": 0.5}}},
    "task and mean": {"people": {"rcof_mean": 0.2, "task": [{"rcof": 0.3}]}},
    "slope": {"floor__slope": "15.1 deg"},
    "rz": {"floor__rz": "20 um"},
    "reading": {"floor__reading": [{"machine": "pendulum-96"}]},
    "kind": {"floor__reading": [{"machine": "pendulum-96", "value": 36, "kind": "about"}]},
    "test": {"shoe__reading": [{"test": "tile", "cof": 0.3}]},
    "no cof": {"shoe__reading": [{"test": "tile_glycerine"}]},
    "cof": {"shoe__reading": [{"test": "tile_glycerine", "cof": 2.1}]},
    "no months": {"shoe__wear_per_month": "0.1 mm"},
    "worn off": {"shoe__wear_per_month": "5 mm", "shoe__months": 4},
    "not worn": {"shoe__wear_per_month": "0 mm", "shoe__months": 4},
    "months": {"shoe__months": 0.05},
    "wear twice": {"shoe__wear": {"depth": "1 mm"}, "shoe__worn_region": ["9 mm", "9 mm"]},
    "region": {"shoe__worn_region": "30 mm"},
    "region size": {"shoe__worn_region": ["1.9 mm", "30 mm"]},
    "large region": {"shoe__worn_region": ["9 mm", "91 mm"]},
    "region of no tread": {"shoe__worn_region": ["9 mm", "9 mm"]},
    "present": {"shoe__present": "yes"},
    "class": {"shoe__class": "SRX"},
    "fluid": {"fluids": {"dry": 0.5, "watr": 0.5}},
    "shoe": {"shoe__from": "work_sho"},
    "floor": {"floor__from": "quary_tile"},
}


def test_files_of_places(file_regression, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    answers = {}
    for name, changes in PLACES.items():
        told = place_of(_table(**changes))
        case = told.case(told.shoes[0], told.floors[0], told.fluids()[0])
        answers[name] = {
            "place": {field.name: getattr(told, field.name) for field in dataclasses.fields(told)
                      if field.name not in ("shoes", "floors", "folder", "assumed")},
            "assumed": list(map(str, told.assumed)),
            "floors": [
                [each.name, each.share, each.slope, each.known, dict(each.fluids),
                 str(each.section), [str(one.text) for one in each.readings]]
                for each in told.floors
            ],
            "shoes": [
                [each.name, each.present, each.price, each.months, each.wear_depth,
                 each.worn_region, each.known_class and each.known_class.name, each.readings]
                for each in told.shoes
            ],
            "wet": [told.wet_share, told.wet_steps, told.fluids()],
            "case": [row[:2] for row in case.rows() if row[2].startswith("given")],
            "name": case.name,
        }  # fmt: skip
    told = place_of(_table(**PLACES["all"]))
    answers["worn"] = [
        [
            row[:2]
            for row in told.case(shoe, told.floors[0], "water", True).rows()
            if "wear" in row[0]
        ]
        for shoe in told.shoes[:2]
    ]
    (tmp_path / "a hall.toml").write_text(
        '[fluids]\nwater = 1.0\n[[floor]]\nname = "x"\n[[shoe]]\nname = "s"\n'
        'from = "work_shoe_untreaded"\n', "utf-8"
    )  # fmt: skip
    answers["read"] = read_place(tmp_path / "a hall.toml").name
    answers["same"] = [
        place.same_shoe(told.shoes[0], dataclasses.replace(told.shoes[0], **each))
        for each in ({"name": "x", "price": 3.0}, {"wear_depth": 0.0}, {"readings": (1,)},
                     {"known_class": 1}, {"worn_region": (1, 1)}, {"section": {}})
    ]  # fmt: skip
    answers["refused"] = {
        name: refusal(place_of, {k: v for k, v in _table(**each).items() if v is not None})
        for name, each in REFUSED.items()
    }
    held(file_regression, answers)


def _answer(shoe, best, slips, replaced="", reported=""):
    value = SourcedValue(slips, "1", interval=(slips / 2, min(2 * slips, 1.0)))
    return choice.ShoeAnswer(shoe, value, best, replaced, reported)


def test_pages_of_choices(file_regression):
    """Answers made by hand: decided, level, one shoe, the same shoe, with changes and without."""
    told = place_of(_table(**PLACES["all"]))
    old, ruled, classed = told.shoes
    lever, gain = choice.Lever, choice.PossibleMeasurement
    levers = (
        lever("another floor", (0.001, 0.3, 0.7), 0.97),
        lever("another shoe", (0.9, 0.9, 0.9), 0.5),
        lever("salt", (0.99, 3.0, 400.0), 0.2),
    )
    measured = (gain("PTV of dock", 0.3, 0.12), gain("EN value of old", 0.02, 0.001))
    cofs = (("old", "hall", "water", 0.1, 0.2, 0.345, 0.25),)
    floors = (("hall", "1 (0.5 to 2)", "1.5 (1 to 2)"),)
    reading = UnexpectedReading("A machine", "PTV", 12.0, 20.0, 30.0, 40.0)

    def made(*shoes, levers=(), measured=(), outside=(), before_after=(), place=told):
        return choice.ShoeChoice(place, shoes, levers, measured, (("hall, water", 0.8),), cofs,
                                 "old", 812.3, before_after, outside)  # fmt: skip

    decided = (_answer(old, 0.2, 0.03, "after 3 months", "12"), _answer(ruled, 0.78, 0.01),
               _answer(classed, 0.02, 0.2))  # fmt: skip
    twin = dataclasses.replace(old, name="twin")
    pages = {
        "decided": made(*decided, levers=levers, measured=measured, outside=(("hall", reading),),
                        before_after=floors),
        "not": made(_answer(old, 0.5, 0.03), _answer(ruled, 0.4, 0.01), levers=levers[1:]),
        "level": made(_answer(old, 0.5, 0.03), _answer(ruled, 0.5, 0.01), measured=measured[1:]),
        "almost": made(_answer(old, 0.749, 0.03), _answer(ruled, 0.251, 0.01)),
        "just": made(_answer(old, 0.75, 0.03), _answer(ruled, 0.25, 0.01)),
        "one": made(_answer(old, 1.0, 0.03)),
        "the same": made(_answer(old, 0.5, 0.03), _answer(twin, 0.5, 0.03)),
        "unknown floor": made(_answer(old, 1.0, 0.03), place=place_of(_table(
            **PLACES["nothing known"]))),
    }  # fmt: skip
    answers = {name: _page(page) for name, page in pages.items()}
    for name, page in answers.items():
        if name != "decided":
            page["tables"] = page["tables"][0]
    answers["data"] = pages["decided"].to_dict()
    answers["idle"] = [choice.Lever("x", ends, 0.5).does_something for ends in
                       ((0.996, 1.0, 1.004), (0.995, 1.0, 1.0), (1.0, 1.0, 1.006))]  # fmt: skip
    held(file_regression, answers)


def test_numbers_of_choices(file_regression):
    """Slips from friction, ratios, wear and reports, of cells made by hand."""
    told = place_of(_table(**PLACES["all"]))
    draws = PlaceDraws(count=COUNT, seed=2)
    normal = draws.normal("friction")

    def cells_of(level):
        return {
            (floor.name, fluid): cells.Cell(level * np.exp(0.3 * normal), level, 0.2)
            for floor in told.floors
            for fluid in floor.fluids
            if fluid != "dry"
        }

    new, worn = cells_of(0.32), cells_of(0.2)
    slips = cells.slips_in_cells(told, draws, new)
    after = cells.sum_of_shares(cells.slips_in_cells(told, draws, worn))
    today = cells.sum_of_shares(slips)
    old, ruled, _ = told.shoes
    states = {False: new, True: worn}
    rq = {floor.name: RQ for floor in told.floors}
    answers = {
        "slips": {str(key): [value.mean(), value.max()] for key, value in slips.items()},
        "steep": [
            float(cells.slip_share(new["hall", "glycerol_90pct"].acof, r, sd, slope, draws).mean())
            for r, sd, slope in ((0.2, 0.03, 0.0), (0.3, 0.03, 0.0), (0.2, 0.1, 0.1))
        ],
        "left": [choice._slip_ratio(after, today), choice._slip_ratio(today, today),
                 choice._slip_ratio(np.zeros(3), np.zeros(3)),
                 choice._slip_ratio(np.zeros(3), np.ones(3))],
        "lever": choice._lever("worn", after, today),
        "even": choice._lever("same", today, today),
        "replaced": [
            str(choice._replacement_time(shoe, states, rate, told, draws))
            for shoe, rate in ((old, None), (old, after), (old, today * 1.01), (ruled, after),
                               (ruled, today), (dataclasses.replace(old, months=None), after))
        ],
        "reported": [str(choice._reported_slips(where, after, part)) for where, part in (
            (told, today), (told, after), (told, 1e-4 * today), (told, 1e4 * today),
            (place_of(_table()), today))],
        "ratios": [str(choice._ratio(x)) for x in (0.0099, 0.01, 0.5, 99.6, 100.0, 100.1)],
        "shares": [str(choice._share(each)) for each in ((0.5, 0.5, 0.5), (0.001, 0.3, 200.0))],
        "bins": [str(choice._of_bins(x)) for x in (0.0, 0.05, 0.051, 0.4)],
        "monthly": [choice._monthly(each) for each in told.shoes],
        "oil": [choice._is_oil(told, old, fluid) for fluid in ("water", "canola_oil")],
        "floors": choice._floors(told, draws, rq, {"hall": (1e-6, 2e-6, 4e-6)}),
        "names": len({cells.shoe_name(shoe) for shoe in told.shoes}),
    }  # fmt: skip
    cases = {shoe.name: told.case(shoe, told.floors[0], "water") for shoe in told.shoes}
    answers["measured"] = choice._measurements(
        told, draws, rq, cases, np.array([today, 0.5 * (today + after), np.sort(today)])
    )
    answers["outside"] = [
        f"{floor}: {each.text}" for floor, each in choice._learn(told, _large(), rq, cases)
    ]
    held(file_regression, answers)


def _large():
    return PlaceDraws(count=2000, seed=1)


def test_places_of_a_tread(file_regression):
    """Odds of the film over places of a tread are those of none where there is no tread or film."""
    bare = _case()
    dry = _case(shoe="work_shoe_full_tread", contaminant="none")
    assert cells.film_odds_over_positions(bare).tolist() == [0.0]
    assert cells.film_odds_over_positions(dry).tolist() == [0.0]
    held(file_regression, [cells.tread_place(bare), cells.tread_place(dry)])


def test_small_readings(file_regression):
    reading = FloorReading(machines.machine("pendulum-96"), machines.FLUIDS["water"], 36.0)
    held(file_regression, [
        [str(one.text), str(one.value_text)]
        for kind in joint.KINDS
        for one in [dataclasses.replace(reading, kind=kind)]
    ] + [
        len(calibration.learn_floor(_large(), "hall", RQ, dataclasses.replace(reading, **each)))
        for each in ({"value": 90.0, "kind": "upper"}, {"value": 20.0, "kind": "lower"},
                     {"value": 55.0}, {"value": 30.0})
    ] + [SimpleNamespace(x=machines.rq_of_rz(40 * UM)).x])  # fmt: skip


@pytest.mark.parametrize("name", ["ramp_angle", "barefoot_angle"])
def test_angles_of_ramps_are_degrees_to_the_machine(name):
    (reading,) = _case(friction={"model": "pair_read", name: "12 deg"}).friction.floor_readings()
    assert reading.value == pytest.approx(12.0)


@pytest.mark.parametrize(("taper", "ratio"), [(0.5, 0.3), (1.2, 1.0), (2.0, 2.0)])
def test_a_wedge_bears_its_share_of_the_wide_one(taper, ratio):
    found = machines._wedge_factors(np.array([taper]), np.array([ratio]))
    assert found == pytest.approx(wedge_load_factor(taper) * side_leakage(ratio, taper), abs=1e-3)
