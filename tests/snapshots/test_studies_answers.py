"""Published studies: sources read, cases that stand for them, verdicts, fits and drawings."""

from dataclasses import asdict, replace
from types import SimpleNamespace

import numpy as np
import pytest

from snapshot import held, refusal
from underfoot.core import UnderfootError
from underfoot.friction import packaged_pair_draws
from underfoot.material import power_law_spectrum
from underfoot.studies import (
    g1,
    g2,
    g3,
    g6,
    pair_law,
    report_ledger,
    slips,
    sources,
    statements,
    verdict,
)
from underfoot.studies.corpus_cases import contrasts, stand, whole_shoe_stands
from underfoot.studies.corpus_cases import verdict as effect_verdict
from underfoot.studies.figure import Figure, Panel, grouped_bars, level, line, points
from underfoot.studies.identifiability import chi_square, model_error, profile
from underfoot.studies.mechanisms import (
    calibrated_mechanism,
    leave_one_out,
    mechanism,
    mechanisms,
    predict_cof,
    stribeck_left_out,
)
from underfoot.studies.runner import Computed, Options, PublishedStudyResult, StudyTable
from underfoot.studies.sampled import sample_inputs
from underfoot.studies.summary import figure_rows, headline, summary_markdown
from underfoot.studies.transient import TransientSettings, transient_sliding
from underfoot.studies.validation import _strip_load, hertz, inclined_bearing, squeeze_disc
from underfoot.studies.verdict import ComputedQuantity, grid_value, judge


def answer(call, *args, **options):
    """What a call gives, or the error that it ends with."""
    try:
        return call(*args, **options)
    except UnderfootError as error:
        return f"{type(error).__name__}: {error}"


def settled(values):
    """Values of a fit without what a bound leaves of nothing."""
    return {name: round(value, 5) + 0.0 for name, value in values.items()}


def weighed(values):
    """Sum of numbers, each times its place."""
    return np.nansum(np.array(values, dtype=float) * (1 + np.arange(len(values))))


def drawn(figure):
    """A figure in a line a layer."""
    lines = [
        f"{figure.title} | {figure.columns} {figure.size} {figure.share_x} {figure.legend_below}"
    ]
    for panel in figure.panels:
        words = (
            panel.title,
            panel.x_label,
            panel.y_label,
            panel.x_scale,
            panel.y_scale,
            panel.x_limits,
            panel.y_limits,
        )
        lines.append(
            " | ".join(map(str, (*words, list(panel.x_ticks), list(panel.y_ticks), panel.legend)))
        )
        for layer in panel.layers:
            sums = [
                f"{name} {len(values)}: {weighed(values):.5g}"
                for name in ("x", "y", "low", "high")
                if (values := getattr(layer, name)) and np.ndim(values[0]) == 0
            ]
            words = (
                layer.mark,
                layer.label,
                layer.colour,
                layer.style,
                layer.marker,
                f"{layer.width:.3g}",
            )
            lines.append("  " + " | ".join((*words, *sums)))
    return lines


def told(quantities):
    """Quantities in a line each."""
    return {
        name: f"{[f'{v:.5g}' for v in one.values]} {one.unit} {one.names} {one.missing} "
        f"{one.unconverged} "
        f"{'' if one.chance is None else f'{one.chance:.4g}'} "
        f"{[f'{v:.4g}' for v in one.quantiles[::100]]} "
        f"{[(h, [f'{x:.4g}' for x in v]) for h, v in one.levels]}"
        for name, one in quantities.items()
    }


def test_sources_as_read(file_regression):
    def numbers(one):
        return {
            name: [span.low, span.high, span.note, span.assumed]
            for name, span in one.numbers.items()
        }

    shares = np.random.default_rng(1).random((3, len(sources.NUMBERS)))
    lines = {}
    for source in sources.corpus():
        conditions = source.conditions
        readings = [c.reading for c in conditions]
        lines[source.name] = {
            "head": [
                source.laboratory,
                source.verified,
                len(conditions),
                [e.kind for e in source.effects],
            ],
            "low": np.array([r.low for r in readings]),
            "sd": np.array([r.sd_ln for r in readings]),
            "high": np.array([min(r.high, 9.0) for r in readings]),
            "kinds": " ".join(r.kind for r in readings),
            "fluids": " ".join(str(c.labels.get("fluid")) for c in conditions)[:300],
            "numbers": {
                name: float(
                    np.sum(
                        [
                            c.numbers[name].low + 2 * c.numbers[name].high
                            for c in conditions
                            if name in c.numbers
                        ]
                    )
                )
                for name in sources.NUMBERS
                if any(name in c.numbers for c in conditions)
            },
            "members": sum(len(c.members) for c in conditions),
        }
        if conditions:
            first = conditions[0]
            lines[source.name]["first"] = [
                first.id,
                first.pair if not first.members else "",
                numbers(first),
            ]
            lines[source.name]["sampled"] = dict(
                sources.sampled_numbers((first.members or (first,))[0], shares).items()
            )
    held(file_regression, lines)


CONDITION = """reference = "a report"
read = "whole"
[[condition]]
id = "one"
device = "block"
fluid = "water"
viscosity = "1 cP"
speed = "0.3 m/s"
shore_a = 60
sole_ra = { range = ["2 um", "4 um"], note = "not printed" }
floor_rq = "3 um"
measured = { kind = "value", cof = 0.3, sd = 0.03 }
[[effect]]
id = "e"
kind = "sign"
higher = { fluid = "dry" }
lower = { fluid = "water" }
"""


def test_sources_that_are_wrong(tmp_path, file_regression):
    changed = {
        "as it is": ("", ""),
        "no reference": ('reference = "a report"', ""),
        "blank": ('"whole"', '" "'),
        "a key": ("device", "devise"),
        "no id": ('id = "one"', ""),
        "nothing measured": ("measured =", "measure ="),
        "kind": ('"value"', '"values"'),
        "no cof": ("cof = 0.3,", ""),
        "another key": ("sd = 0.03", "std = 0.03"),
        "no fluid": ('fluid = "water"\nv', "v"),
        "no viscosity": ('viscosity = "1 cP"', ""),
        "dry": ('fluid = "water"\nviscosity = "1 cP"', 'fluid = "dry"'),
        "unknown fluid": ('fluid = "water"\nv', 'fluid = "watr"\nv'),
        "range": ('["2 um", "4 um"]', '["4 um", "2 um"]'),
        "no unit": ('"0.3 m/s"', '"0.3"'),
        "PTV": ("cof = 0.3,", 'cof = "36 PTV",'),
        "PTV 0": ("cof = 0.3,", 'cof = "0 PTV",'),
        "words": ("cof = 0.3,", 'cof = "high",'),
        "lower": ('"value"', '"lower"'),
        "upper": ('"value"', '"upper"'),
        "range of COF": ('"value", cof = 0.3, sd = 0.03', '"range", low = 0.2, high = 0.4'),
        "no sd": (", sd = 0.03", ""),
        "sd of ln": ("sd = 0.03", "sd_ln = 0.2"),
        "effect": ('kind = "sign"', 'kind = "signs"'),
        "TOML": ("[[condition]]", "[[condition"),
        "Eq. 17": (
            '"value", cof = 0.3, sd = 0.03',
            '"eq_17", cof_bl = 0.5, tau_hydro = "0.2 m/s", cof_asymptote = 0.1, '
            'speeds = ["0.1 m/s", "1 m/s"], sd_ln = 0.1',
        ),
        "one of": ('fluid = "water"\nv', 'fluid = { one_of = ["oil", "water"] }\nv'),
        "assumed": ('note = "not printed"', "assumed = true"),
        "members": (
            'fluid = "water"\n',
            'members = [{ fluid = "water" }, { fluid = "oil", viscosity = "70 cP" }]\n',
        ),
        "laboratory": ('read = "whole"', 'read = "whole"\nlaboratory = "L"\nverified = false'),
        "shared": ('read = "whole"', 'read = "whole"\nconditions = { load = "100 N" }'),
    }
    path, lines = tmp_path / "a.toml", {}
    for said, (old, new) in changed.items():
        path.write_text(CONDITION.replace(old, new, 1) if old else CONDITION)
        found = answer(sources.read_source, path)
        if not isinstance(found, str):
            found = [
                f"{found.laboratory} {found.verified} {[e.kind for e in found.effects]}",
                *(
                    f"{c.id} {c.fluid if 'fluid' in c.labels else [m.fluid for m in c.members]} "
                    f"{c.reading.kind} {c.reading.low:.5g} "
                    f"{c.reading.high:.5g} {c.reading.sd_ln:.4g} "
                    + str(
                        [f"{n} {s.low:.4g} {s.high:.4g} {s.assumed}" for n, s in c.numbers.items()]
                    )
                    for c in found.conditions
                ),
            ]
        lines[said] = found
    lines["absent"] = refusal(sources.read_source, tmp_path / "no.toml")
    held(file_regression, lines)


TABLE = {
    "device": "whole shoe",
    "fluid": "water",
    "viscosity": "1 cP",
    "speed": "0.5 m/s",
    "load": "400 N",
    "shore_a": 60,
    "sole_ra": "6 um",
    "floor_rq": ["2 um", "4 um"],
    "tread": {"pattern": "grooves", "direction": "along", "depth": "2 mm"},
}


def test_cases_that_stand_for_conditions(file_regression):
    tables = {
        "shoe": {},
        "block": {"device": "block"},
        "drop pad": {"device": "drop pad"},
        "no device": {"device": "sled"},
        "dry": {"fluid": "dry"},
        "oil": {"fluid": "oil", "viscosity": "70 cP"},
        "no fluid": {"fluid": "beer"},
        "walking": {"walking": "backwards"},
        "worn": {"wear": "through"},
        "badly worn": {"wear": "old"},
        "bare": {"tread": {}},
        "bare block": {"tread": {}, "device": "pin"},
        "oblique": {"tread": {"pattern": "strips", "direction": "oblique"}},
        "land": {"tread": {"pattern": "market", "land": 0.36}},
        "stars": {"tread": {"pattern": "stars"}},
        "neolite": {"compound": "neolite"},
        "members": {"members": [{"fluid": "oil"}, {"shore_a": [50, 72]}]},
        "angle": {"shoe_angle": "7 deg", "device": "slipmeter"},
    }

    def lines(one):
        cases = [case.to_toml().split("\n") for case in one.cases]
        kept = [
            [row for row in rows if row.strip() and not row.lstrip().startswith("#")]
            for rows in cases
        ]
        return [
            one.reason,
            ", ".join(one.taken),
            f"{one.contact_time:.5g}",
            *(" ; ".join(rows)[:900] for rows in kept),
        ]

    of_sources = {}
    for source in sources.corpus():
        for contrast in contrasts(source)[:2]:
            cases = [len(side.cases) for side in (contrast.over, contrast.under)]
            of_sources[f"{source.name} {contrast.effect} {contrast.fluid}"] = (
                f"{contrast.topic} | {contrast.published} | {contrast.rises} {contrast.step:.4g} "
                f"{cases} {contrast.reason} "
                f"| {', '.join(contrast.over.taken)}"
            )
        for condition, one in whole_shoe_stands(source)[:1]:
            of_sources[f"{source.name}, {condition.id}"] = (
                f"{len(one.cases)} {one.reason} | {', '.join(one.taken)}"
            )
    without = {
        key: value
        for key, value in TABLE.items()
        if key not in ("viscosity", "shore_a", "sole_ra", "load")
    }
    held(
        file_regression,
        {
            "tables": {said: lines(stand({**TABLE, **more})) for said, more in tables.items()},
            "little said": lines(stand(without)),
            "sources": of_sources,
            "verdicts": {
                f"{r} {c}": effect_verdict(r, c)
                for r in (0.5, 0.99, 1.5)
                for c in (0.1, 0.25, 0.5, 0.75)
            },
        },
    )


def test_verdicts_of_every_statement(file_regression):
    """Each statement by values inside, at the ends of, and outside what it accepts."""
    lines = {}
    for name in statements.OURS:
        study = statements.study(name)
        rows = []
        for one in study.statements:
            rows.append(
                f"{one.id}: {one.claim} {one.printed} | {one.unit} {one.accepted} "
                f"{one.tolerance:.4g} {one.kind} {one.of} "
                f"{one.effect} {one.quick_error}"
            )
            if one.not_comparable or one.claim in ("words", "order"):
                continue
            low, high = (end if np.isfinite(end) else None for end in one.accepted)
            low, high = (high - 1.0 if low is None else low), (low + 1.0 if high is None else high)
            half = 0.5 * (high - low) or 1.0
            told_of = []
            for place in (0.5, 1.6, -2.0):
                value = low + place * (high - low)
                given = ComputedQuantity.of(value, one.si_unit, deviation=0.4 * half)
                found = judge(one, {one.quantity: given})
                told_of.append(
                    f"{found.ours}, {found.verdict}, {found.difference}, {found.reason[:60]}"
                )
            rows += [f"  {text}" for text in told_of[: 3 if len(rows) % 3 == 1 else 2]]
        lines[name] = [
            *rows,
            f"errata {len(study.errata)}, figures {len(study.figures)}, notes {len(study.notes)}",
        ]
    held(file_regression, lines)


STATEMENT = {
    "id": "a",
    "text": "t",
    "place": "p",
    "claim": "value",
    "printed": "0.30",
    "tolerance": "digits",
    "quantity": "q",
}


def test_statements_and_judgements_made_up(file_regression):
    def read(*tables, **content):
        given = {"title": "T", "source": "S", "statement": tables, **content}
        return answer(statements.read_study, "x", given)

    changes = {
        "as it is": {},
        "key": {"colour": 1},
        "claim": {"claim": "about"},
        "kind": {"kind": "own"},
        "no quantity": {"quantity": ""},
        "unit": {"unit": "furlong"},
        "percent": {"unit": "%", "printed": "30"},
        "range": {"claim": "range", "printed": ["1", "2"]},
        "range of one": {"claim": "range"},
        "descending": {"claim": "range", "printed": ["2", "1"]},
        "below": {"claim": "below"},
        "above": {"claim": "above"},
        "rises": {"claim": "rises"},
        "rises by": {"claim": "rises", "resolution": "0.02", "effect": True},
        "falls": {"claim": "falls", "resolution": "0.02"},
        "order": {"claim": "order", "printed": ["b", "a"], "resolution": "0.01"},
        "mean": {"tolerance": "mean", "count": 9, "deviation": "0.06"},
        "share": {"tolerance": "share", "count": 20},
        "correlation": {"tolerance": "correlation", "count": 12},
        "per cent": {"tolerance": "15 %", "reason": "r"},
        "number": {"tolerance": 0.02, "reason": "r"},
        "no reason": {"tolerance": 0.02},
        "words": {"claim": "words", "printed": "more"},
        "none": {"not_comparable": "not printed"},
        "effect": {"effect": True},
        "quick": {"quick_error": ["5 %", 0.01]},
        "alternatives": {"alternatives": {"other_way": "r"}},
        "restates": {"kind": "restates", "of": "b"},
        "of another": {"kind": "restates", "of": "g2.x"},
        "of none": {"kind": "restates", "of": "g9.x"},
    }
    made = {said: read({**STATEMENT, **more}) for said, more in changes.items()}
    lines = {
        said: one
        if isinstance(one, str)
        else [
            f"{s.id} {s.claim} {s.printed} {s.names} {s.accepted} {s.tolerance:.4g} | "
            f"{s.tolerance_reason} | {s.kind} {s.of} {s.effect} "
            f"{s.quick_error} {0.0 if s.claim == 'words' or s.not_comparable else s.half_scale:.4g}"
            for s in one.statements
        ]
        for said, one in made.items()
    }
    lines["twice"] = read(STATEMENT, STATEMENT)
    lines["one reading"] = read(STATEMENT, {**STATEMENT, "id": "b"})
    draws = 0.3 + 0.02 * np.random.default_rng(2).standard_normal(500)
    three = [(4.0, 0.4), (2.0, 0.34), (1.0, 0.31)]
    given = {
        "inside": ComputedQuantity.of(0.302),
        "outside": ComputedQuantity.of(0.5),
        "draws": ComputedQuantity.of(0.31, draws=draws),
        "wide": ComputedQuantity.of(0.35, deviation=0.4, scale="log"),
        "share": ComputedQuantity.of(0.31, deviation=0.01, scale="logit"),
        "three grids": ComputedQuantity.of(0.31, levels=three),
        "two grids": ComputedQuantity.of(0.31, levels=three[1:]),
        "one grid": ComputedQuantity.of(0.31, levels=three[2:]),
        "several": ComputedQuantity.of([0.2, 0.302, 0.4]),
        "none": ComputedQuantity.none("not run"),
        "no number": ComputedQuantity.of(np.nan),
        "unit": ComputedQuantity.of(0.3, "N"),
        "settled": ComputedQuantity.of(0.3, levels=[(2.0, 0.301), (1.0, 0.3)]),
    }
    for kind in ("as it is", "percent", "below", "rises by", "falls", "effect", "quick", "number"):
        (one,) = made[kind].statements
        lines[f"judged, {kind}"] = {
            said: f"{found.verdict}: {found.ours}; {found.difference}; {found.reason}; "
            f"{found.probability}"
            if not isinstance(found := answer(judge, one, {"q": quantity}), str)
            else found
            for said, quantity in given.items()
        }
    (order,) = made["order"].statements
    lines["judged, order"] = [
        str(
            judge(
                order, {"q": ComputedQuantity.of(values, names=("a", "b"), chance=chance)}
            ).verdict
        )
        for values in ([1.0, 2.0], [2.0, 1.0], [1.0, 1.005])
        for chance in (None, 0.01, 0.1, 0.3, 0.6)
    ]
    lines["unknown"] = answer(judge, order, {})
    lines["rules"] = {str(each): f"{each.step} {each.rule}" for each in verdict.Verdict}
    lines["grids"] = {
        str(values): grid_value([(2.0**-n, v) for n, v in enumerate(values)], tolerance)
        for values, tolerance in (
            ((1.0, 0.5, 0.3), 0.1),
            ((1.0, 0.5, 0.6), 0.1),
            ((1.0, 0.99), 0.1),
            ((1.0, 0.5, 0.1), 0.1),
            ((0.3, 0.2, 0.16), 0.05),
        )
    }
    lines["dicts"] = ComputedQuantity.from_dict(given["draws"].to_dict()) == given["draws"]
    held(file_regression, lines)


def test_a_result_of_a_study(file_regression):
    study = statements.study("g3")
    rng = np.random.default_rng(4)
    quantities = {}
    for one in study.statements:
        if one.quantity and one.quantity not in quantities:
            ends = [end for end in one.accepted if np.isfinite(end)] or [1.0]
            names = one.names if one.claim == "order" else ()
            values = np.sort(rng.random(len(names)))[::-1] if names else float(np.mean(ends))
            quantities[one.quantity] = ComputedQuantity.of(
                values, one.si_unit, names=names, chance=0.7 if names else None
            )
    table = StudyTable.of(
        "t", "A table", [{"a": 1.0, "b": np.float64("nan")}, {"a": np.int64(2), "b": "x"}]
    )
    figure = Figure([Panel([line([1, 2], [3, 4], "l"), level(2.0, "v")], "x", "y", "p")], "title")
    made = Computed(quantities, (table,), {"f": figure}, ("so",), ("note",), ("assumed",))
    result = PublishedStudyResult(study, made, True, 1.5, 1.25)
    failed = PublishedStudyResult(study, Computed({}), False, 0.0, 0.0, "it fell")
    again = PublishedStudyResult.from_dict(result.to_dict(figures=True))
    held(
        file_regression,
        {
            "says": [
                repr(result),
                result.heading(),
                *result.headline(),
                *result.cautions(),
                *failed.headline(),
                failed.usable,
            ],
            "tables": [
                [one.title, len(one.rows), [str(cell) for cell in one.rows[0]]]
                for one in result.tables()
            ],
            "remarks": {
                key: [str(line) for line in lines][:3] for key, lines in result.remarks().items()
            },
            "told": {
                key: value
                for key, value in result.to_dict().items()
                if key not in ("statements", "quantities")
            },
            "same": again.to_dict() == result.to_dict(),
            "rows": figure.rows(),
            "counts": headline([result, failed]),
            "figures": figure_rows([result], {"g3": ["fig22_dry_adhesion.png", "f"]}),
            "summary": summary_markdown([result, failed]).split("\n")[:60],
        },
        hide=r"[^ \"]*/statements",
    )


def test_drawings_of_figures(file_regression):
    bars = grouped_bars(
        {"a": [1.0, 2.0], "b": [3.0, 4.0]},
        low={"a": [0.5, 1.5], "b": [2, 3]},
        high={"a": [2, 3], "b": [4, 5]},
    )
    marks = points([1.0], [2.0], "p", low=[1.0], high=[3.0], colour="red")
    held(file_regression, drawn(Figure([Panel([*bars, marks])], "t", columns=3, share_x=True)))


def made_rows(settings):
    rows = []
    for n, cell in enumerate(g1.matrix(settings)):
        loss = (
            (0.1 if cell.series == "broad" else 1e-5)
            * (1 + 0.3 * cell.speed)
            * cell.floor_rz
            / 2e-5
            * (1 + 1e4 * cell.shoe_rz)
        )
        loss *= 1.4 if cell.material == "rubber" else 1.0
        area = 1e-6 * (2 - cell.speed) / (cell.floor_rz / 2e-5)
        bad = n == 7
        rows.append(
            g1.MatrixRow(
                *asdict(cell).values(),
                *(
                    [np.nan] * 7
                    if bad
                    else [loss, 1.1 * loss, 1.2 * loss, area, 0.9 * area, 0.1, 1.6e5]
                ),
                "not converged" if bad else "converged",
                "" if n % 5 else "slow steps",
                1.0,
            )
        )
    return rows


def test_g1_of_rows(file_regression):
    settings = g1.Settings()
    rows = made_rows(settings)
    levels = [
        (2e-5, [replace(row, cof_hysteresis=1.1 * row.cof_hysteresis) for row in rows]),
        (1e-5, rows),
    ]
    time = np.linspace(0, 3e-3, 40)
    distance = np.maximum(time - 1e-3, 0) * 1.0
    history = {
        "time": time,
        "distance": distance,
        "normal_force": 0.1 + 0 * time,
        "shear_force": 0.02 * np.sin(2 * np.pi * distance / 4e-4),
        "real_contact_area": 1e-7 + 1e-8 * np.cos(9e3 * distance),
    }
    figures = g1.figures(rows, {("broad", 1.0): history}, 4e-4)
    cells = list(g1.matrix(settings))
    held(
        file_regression,
        {
            "matrix": [len(cells), cells[0], cells[37]],
            "quick": settings.quick,
            "quantities": told(g1.series_quantities("broad", levels)),
            "report": told(g1.series_quantities("report", levels)),
            "not run": len(
                g1.series_quantities(
                    "report", [(1e-5, [row for row in rows if row.series == "broad"])]
                )
            ),
            "notes": g1._notes(rows, settings, 3),
            "by load": g1._notes(rows, replace(settings, control="load"), 0)[:1],
            "table": g1.cases_table(rows).rows[5],
            "columns": g1.cases_table(rows).columns,
            "figures": {name: drawn(figure) for name, figure in figures.items()},
            "materials": {
                f"{cell.series} {cell.material} {bulk}": [
                    (made := g1.material_of(cell, bulk)).bulk_modulus,
                    made.shear.equilibrium_modulus,
                    made.shear.term_moduli.sum(),
                ]
                for cell in (cells[0], cells[20], cells[35], cells[50])
                for bulk in ("corrected", "printed")
            },
            "parts": list(g1.parts_of(cells[3], replace(settings, solver="explicit"))[3:]),
            "means": [
                g1.whole_wavelength_mean(distance, np.sin(3e3 * distance) + 1, wave)
                for wave in (4e-4, 1e-3, 3e-3)
            ],
            "changes": {
                f"{q} {a}": g1.changes(rows[:30], q, a)
                for q in ("cof_hysteresis", "area_per_force")
                for a in ("speed", "floor_rz")
            },
            "refused": [
                answer(g1.Settings, **given)
                for given in ({"control": "x"}, {"speeds": (1.0, 0.1)}, {"slide_distance": 3e-4})
            ],
        },
    )


def test_g3_of_few_draws(file_regression, monkeypatch):
    every = packaged_pair_draws()
    monkeypatch.setattr(
        g3, "draws_without_report", lambda seed=0: every.rows(np.arange(0, every.count, 20))
    )
    made = g3.compute(Options(quick=True))
    held(
        file_regression,
        {
            "quantities": told(made.quantities),
            "tables": {t.name: [t.title, t.columns, *t.rows] for t in made.tables},
            "figures": {name: drawn(figure) for name, figure in made.figures.items()},
            "says": [*made.conclusions, *made.notes, *made.assumptions],
        },
    )


def test_mechanisms_of_a_pin(file_regression):
    from underfoot.calibrate.stribeck_points import fluid_points, pin_on_disk, roughness_series
    from underfoot.case.friction import measured_fluids
    from underfoot.core.catalogue import Catalogue

    catalogue = Catalogue.load()
    pin = pin_on_disk(catalogue)
    fluids = sorted(measured_fluids(catalogue), key=lambda one: one.viscosity)
    curves = [fluid_points(one, rq=pin.sole_rq) for one in fluids]
    series = roughness_series(catalogue)
    values = {"cof_adhesion": 0.5, "cof_hysteresis": 0.1}
    told_of = {
        name: [
            one.label,
            one.needs,
            *(
                predict_cof(
                    one,
                    {**values, "parameter": one.parameter.start if one.parameter else 0.0},
                    curve,
                    pin,
                    own_boundary=own,
                )
                for curve in (curves[0], curves[3], series[1])
                for own in (True, False)
            ),
        ]
        for name, one in mechanisms().items()
    }
    chosen = mechanism("viscoelastic_area")
    fit = calibrated_mechanism(chosen, (curves[2],), pin)
    held(
        file_regression,
        {
            "mechanisms": told_of,
            "fit": [settled(fit.values), fit.deviation],
            "own": settled(
                calibrated_mechanism(chosen, (curves[2],), pin, own_boundary=True).values
            ),
            "left out": [one.error for one in leave_one_out(chosen, curves[:2], pin)],
            "Stribeck": [one.error for one in stribeck_left_out(fluids, pin)],
            "refused": [
                refusal(mechanism, "films"),
                refusal(calibrated_mechanism, chosen, (), pin),
                refusal(leave_one_out, chosen, curves[:1], pin),
            ],
        },
    )


def test_the_law_of_a_pair(file_regression):
    every = [c for source in sources.corpus() if source.verified for c in source.conditions]
    some = every[::9]
    rows = pair_law.Rows(some)
    predicted = {}
    for law in pair_law.LAWS:
        prior = np.array(law.prior)
        theta = np.vstack([prior[:, 0], prior[:, 0] + 0.3 * prior[:, 1]])
        mean, variance = rows.predicted(law, theta)
        predicted[law.name] = [mean[0], mean[1], variance[0]]
    rng = np.random.default_rng(8)
    mean = rng.normal(size=(3, 4))
    lower = rng.normal(size=(4, 4))
    covariance = np.repeat((lower @ lower.T + np.eye(4))[None], 3, axis=0)
    low, high = np.array([0.1, -0.2, -np.inf, 0.3]), np.array([0.1, -0.2, 0.5, np.inf])
    bounds = np.full(4, -0.4), np.full(4, 0.6)
    none = pair_law.fit_law(pair_law.law_named("pair"), [])
    few = replace(none, theta=none.theta[:300], spreads=none.spreads[:300])
    latent, noise = few.predicted(some)
    draws = latent + noise * rng.normal(size=latent.shape)
    score = pair_law.score_predictions(draws, some)
    halves = {
        name: pair_law.LaboratoryScore(
            name,
            tuple(own),
            draws[:, at],
            few.expected(own),
            np.empty((0, 5)),
            pair_law.score_predictions(draws[:, at], own),
        )
        for name in ("a", "b")
        for at in [np.arange(0 if name == "a" else 1, len(some), 2)]
        for own in [[some[i] for i in at]]
    }
    left = next(c.laboratory for c in some)
    rivals = {
        name: pair_law.laboratory_left_out(name, some, left).expected
        for name in pair_law.FEATURE_RIVALS
    }
    one_source = [c for c in every if c.source == some[0].source][:6]
    known, spread = few.predicted(one_source)
    held(
        file_regression,
        {
            "predicted": predicted,
            "rows": [
                rows.low[np.isfinite(rows.low)],
                rows.high[np.isfinite(rows.high)],
                rows.points,
                rows.error,
                rows.tread,
                len(rows.groups),
                rows.pairs[:3],
                sum(m.sum() for m in rows.same_pair),
                sum(m.sum() for m in rows.same_tread),
            ],
            "noise": rows.noise(np.full((1, 4), 0.2), np.zeros((1, len(some)))),
            "treads": pair_law.tread_spreads(),
            "likelihood": [
                pair_law.log_likelihood(mean, covariance, low, high),
                pair_law.log_likelihood(mean, covariance, *bounds),
                pair_law.log_likelihood(mean, covariance, low[:2].repeat(2), low[:2].repeat(2)),
            ],
            "covariance": pair_law._covariance(
                np.array([[0.3, 0.2, 0.1, 0.4]]),
                np.array([[1.0, 0.5]]),
                np.eye(2),
                np.full((1, 2), 0.04),
            ),
            "prior": pair_law._log_prior(
                np.array([[0.0, 1.0], [1.0, 2.0]]),
                rng.normal(size=(3, 2)),
                np.log(np.full((3, 4), 0.3)),
            ),
            "no data": [
                none.theta.mean(axis=0),
                none.theta.std(axis=0),
                none.spreads.mean(axis=0),
                none.effective,
            ],
            "posterior": [latent.mean(axis=0), noise.mean(axis=0), few.draws(50).constants],
            "score": score,
            "corpus": [pair_law.corpus_score("pair", list(halves.values()))],
            "rivals": rivals,
            "after": pair_law.one_reading(one_source, known, spread),
            "features": pair_law.features(some).sum(axis=0),
            "middle": pair_law.middle(some)[np.isfinite(pair_law.middle(some))],
            "weights": pair_law.weights(some),
            "r2": pair_law.r2(
                np.array([1.0, 2.0, np.nan, 4.0]),
                np.array([1.1, 1.8, 3.0, 3.5]),
                np.array([1.0, 2.0, 3.0, 1.0]),
            ),
        },
    )


def test_samples_slips_and_profiles(file_regression, monkeypatch):
    slope, half, prior = (each[::10] for each in slips._grid())
    monkeypatch.setattr(slips, "_grid", lambda: (slope, half, prior / prior.sum()))

    def outcome(value):
        return SimpleNamespace(number=lambda name: value)

    def sensitivity(nominal, *effects):
        made = [SimpleNamespace(low=outcome(low), high=outcome(high)) for low, high in effects]
        return SimpleNamespace(nominal=outcome(nominal), effects=made)

    known = sensitivity(0.3, (0.25, 0.4), (np.nan, 0.35), (0.33, np.nan), (np.nan, np.nan))
    grid = np.linspace(0.1, 2.0, 9)
    profiles = {
        "fixed": 40 * (grid - 0.9) ** 2,
        "above": np.where(grid < 0.7, 9.0, 0.5),
        "below": np.where(grid > 1.4, 9.0, 0.5),
        "flat": 0 * grid,
        "refuted": 30 + grid,
        "endless": np.where(np.abs(grid - 1) < 0.3, 0.0, np.inf),
        "two": np.outer(4 * (grid - 0.9) ** 2, [1.0, 9.0]),
    }
    computed = 0.2 * np.exp(0.3 * np.random.default_rng(5).standard_normal(6))
    every = slips.published_shares(computed)
    few = [every[0], every[1], every[2]]
    grids = [
        chi_square([[1.0, 2.0]], [1.1, 1.8], [0.1, 0.2]),
        chi_square([[np.nan, 2.0]], [1.1, 1.8], [0.1, 0.2]),
    ]
    held(
        file_regression,
        {
            "samples": {
                "wide": sample_inputs(known, "x", least=0.01, draws=4000),
                "share": sample_inputs(known, "x", least=0.01, most=1.0, draws=4000),
                "value": sample_inputs(
                    known, "x", value=0.5, factors=(1.5,), least=0.01, draws=4000
                ),
                "none": np.isnan(sample_inputs(sensitivity(np.nan), "x", least=0.1, draws=5)).sum(),
            },
            "refused": [
                refusal(sample_inputs, known, "x", least=0.5, most=0.4),
                refusal(sample_inputs, known, "x", least=0.0),
                refusal(sample_inputs, known, "x", least=0.1, factors=(0.0,)),
                refusal(chi_square, [1.0], [1.0], [0.0]),
                refusal(profile, "a", "m", [1.0, 2.0], [0, 1], data=1),
                refusal(profile, "a", "m", [1.0, 2.0, 3.0], [0, 1], data=1),
                refusal(model_error, [1.0], [0.0]),
            ],
            "profiles": {
                said: [
                    f"{(p := profile(said, 'mm', grid, misfit, data=2)).fixed}: {p.text()}; "
                    f"{p.text(0.001, 'um')}; {p.misfit:.4g}"
                ]
                for said, misfit in profiles.items()
            },
            "misfits": [grids[0], float(grids[1][0])],
            "error": model_error([1.0, 2.0, 3.0], [1.5, 1.5, 4.0]),
            "slips": slips.predict_shares(few),
            "published": [
                [one.source, one.low, one.high, one.steps, one.own_scale, one.acof.mean()]
                for one in every
            ],
            "ledger rows": len(report_ledger.rows()),
            "beside": [report_ledger.beside_the_print(row, {}) for row in report_ledger.rows()[:9]],
        },
    )


def test_marches_and_checks(file_regression):
    x = np.arange(16) / 16 * 1e-3
    floor = (
        5e-6 * np.sin(2 * np.pi * x / 1e-3)[:, None] + 1e-6 * np.sin(2 * np.pi * x / 5e-4)[None, :]
    )
    rubber = power_law_spectrum(
        1e6, 0.15, shortest_time=1e-5, longest_time=1e-2, terms_per_decade=1
    )
    given = {"settings": TransientSettings(max_periods=3, steady_tolerance=0.05)}

    def march(**more):
        return answer(transient_sliding, floor, x[1], rubber, 0.1, **{**given, **more})

    checks = [inclined_bearing(), squeeze_disc(), hertz()]
    held(
        file_regression,
        {
            "load": march(pressure=2e4),
            "height": march(separation=8e-6),
            "far": march(separation=1e-4),
            "fresh": march(pressure=2e4, settings=TransientSettings(start="fresh", max_periods=1)),
            "shoe": march(pressure=2e4, shoe_height=np.roll(floor, 3, axis=0)),
            "refused": [
                march(),
                march(pressure=1.0, separation=1.0),
                march(pressure=1e4, shoe_height=floor[:8]),
                answer(transient_sliding, 0 * floor, x[1], rubber, 0.1, pressure=1e4),
                answer(transient_sliding, floor, x[1], 1e6, 0.1, pressure=1e4),
                answer(TransientSettings, start="cold"),
                answer(TransientSettings, max_periods=0),
                answer(
                    transient_sliding,
                    floor,
                    x[1],
                    SimpleNamespace(
                        equilibrium_modulus=0.0, term_moduli=[1.0], relaxation_times=[1.0]
                    ),
                    0.1,
                    pressure=1e4,
                ),
            ],
            "checks": [
                [one.name, one.computed, one.exact, one.tolerance, one.source, one.passed]
                for one in checks
            ],
            "strip": _strip_load(2e-5, 5e-3, 0.05, 3e-4, viscosity=0.2, speed=0.5),
        },
    )


@pytest.mark.parametrize("name", ["g9", "G3 "])
def test_names_of_studies(name, file_regression):
    found = answer(statements.study, name)
    held(
        file_regression,
        found if isinstance(found, str) else found.title,
        f"named_{name.strip().lower()}",
    )


def made_comparison():
    """Mechanisms as if each had been fitted: with numbers of its own."""
    from underfoot.calibrate import Calibration
    from underfoot.calibrate.stribeck_points import fluid_points, pin_on_disk, roughness_series
    from underfoot.case.friction import measured_fluids
    from underfoot.core import SourcedValue
    from underfoot.core.catalogue import Catalogue
    from underfoot.studies.mechanisms import (
        CALIBRATION_FLUID,
        BlindTest,
        FluidPrediction,
        MechanismComparison,
        MechanismTests,
    )

    catalogue = Catalogue.load()
    pin = pin_on_disk(catalogue)
    measured = sorted(measured_fluids(catalogue), key=lambda one: one.viscosity)
    fluids = {one.fluid: one for one in measured}
    curves = {name: fluid_points(one, rq=pin.sole_rq) for name, one in fluids.items()}
    others = [one for name, one in curves.items() if name != CALIBRATION_FLUID]
    series = [
        one
        for one in roughness_series(catalogue)
        if not (one.fluid == CALIBRATION_FLUID and abs(one.rq - pin.sole_rq) < 1e-9)
    ]
    tests = {}
    for n, (name, one) in enumerate(mechanisms().items()):
        values = {"cof_adhesion": 0.5 + 0.01 * n, "cof_hysteresis": 0.1}
        if one.parameter is not None:
            values["parameter"] = one.parameter.start
        units = {"parameter": one.parameter.unit if one.parameter else "1"}
        parameters = {
            key: SourcedValue(value, units.get(key, "1"), source="made up", uncertainty=0.02)
            for key, value in values.items()
        }
        fit = Calibration(parameters, np.full(11, 0.01 + 0.001 * n), 0.02)

        def blind(these, own, one=one, fit=fit, values=values):
            predicted = tuple(
                FluidPrediction(c, predict_cof(one, values, c, pin, own_boundary=own))
                for c in these
            )
            return BlindTest(one, fit, predicted, own)

        of_fluids, of_roughness = ((blind(x, True), blind(x, False)) for x in (others, series))
        tests[name] = MechanismTests(one, of_fluids, of_roughness, 0.05 + 0.01 * n)
    return MechanismComparison(pin, curves, fluids, tests, 0.0625)


def test_g2_of_a_made_up_comparison(file_regression, monkeypatch):
    every = packaged_pair_draws()
    few = every.rows(np.arange(0, every.count, 20))
    monkeypatch.setattr(g2, "draws_without_report", lambda seed=0: few)
    monkeypatch.setattr(g2, "compare_mechanisms", lambda catalogue: made_comparison())

    def intervals(comparison, test, samples, seed):
        cof = np.array([one.cof for one in comparison.points.values()])
        off = 0.05 * np.cos(np.arange(len(cof)))[:, None]
        ends = {"low": cof + off - 0.04, "high": cof + off + 0.04}
        return SimpleNamespace(value=cof + off, **ends)

    def master(chosen, pin):
        product = np.geomspace(1e-5, 0.1, 30)
        fit = {"mean_absolute": 0.05, "best_possible": 0.04, "r_squared": 0.85}
        return (product, 0.1 + 0.4 * np.exp(-product / 1e-3)), fit

    monkeypatch.setattr(g2, "intervals", intervals)
    monkeypatch.setattr(g2, "master_curve", master)
    made = g2.compute(Options(quick=True))
    held(
        file_regression,
        {
            "quantities": told(made.quantities),
            "tables": {t.name: [t.title, t.columns, *t.rows[:12]] for t in made.tables},
            "figures": {name: drawn(figure) for name, figure in made.figures.items()},
            "says": [*made.conclusions, *made.notes, *made.assumptions],
        },
    )


def test_g6_of_made_up_runs(file_regression, monkeypatch):
    rng = np.random.default_rng(6)
    frictions = []
    for n, law in enumerate(g6.LAWS):
        for k, (sole, shore) in enumerate(g6.SOLES.items()):
            cof = 0.15 + 0.01 * n + 0.012 * k
            draws = cof * np.exp(0.2 * rng.standard_normal(60)) if "pair" in law else None
            ends = (0.004 + 0.001 * k, cof - 0.01, cof + 0.012)
            one = g6.SoleFriction(
                sole, law, shore, cof, 1.02 * cof, *ends, (900.0, 850.0 + n), 0.1, draws
            )
            frictions.append(one)
    every = {}
    for n, name in enumerate(g6.STEPS):
        acof = np.repeat([0.159, 0.182], [40, 20])
        rcof = np.linspace(0.14, 0.26, 60)[rng.permutation(60)]
        slipped = rng.random(60) < 1 / (1 + np.exp(60 * (acof - rcof + 0.01 * n)))
        share = {
            sole: float(slipped[20 * k : 20 * k + 20].mean()) for k, sole in enumerate(g6.SOLES)
        }
        every[name] = g6.OutsoleSlips(
            acof, rcof, slipped, share, g6.fitted_logistic(acof - rcof, slipped)
        )
    made = iter(every.values())
    monkeypatch.setattr(g6, "sole_frictions", lambda **_: frictions)
    monkeypatch.setattr(g6, "slips", lambda *_, **__: next(made))
    precise = g6.precision_of_published(draws=3, seed=1)
    lines = -49.2 + 9 * rng.standard_normal(40), -0.06 + 0.01 * rng.standard_normal(40)
    monkeypatch.setattr(g6, "precision_of_published", lambda **_: lines)
    risk = g6.population_risk
    monkeypatch.setattr(
        g6, "population_risk", lambda acof: {"report_g6": 0.9 - 4 * acof, "x": acof}
    )
    whole = g6.compute(Options(quick=True))
    monkeypatch.setattr(g6, "population_risk", risk)
    none = replace(
        every["constant"],
        slipped=np.zeros(60, bool),
        fit=g6.fitted_logistic(np.arange(4.0), np.zeros(4, bool)),
    )

    def outcome(cof):
        numbers = {
            "cof": cof,
            "peak_fluid_pressure_sensor": 1e4 * cof,
            "fluid_load": 30.0,
            "normal_force": 250.0,
        }
        return SimpleNamespace(
            number=numbers.__getitem__, standard_deviation=lambda name: 0.1 * cof
        )

    monkeypatch.setattr(g6, "LAWS", {g6.JUDGED: "the first"})
    two_grids = told(g6.quantities(frictions, {"constant": none}, quick=False, seed=3))
    window = [outcome(cof) for cof in (0.15, 0.16, 0.18, 0.14, 0.17)]
    held(
        file_regression,
        {
            "quantities": told(whole.quantities),
            "on two grids": two_grids,
            "tables": {t.name: [t.title, t.columns, *t.rows[:9]] for t in whole.tables},
            "figures": {name: drawn(figure) for name, figure in whole.figures.items()},
            "says": whole.conclusions,
            "precise": precise,
            "nobody": g6._logistic_words(none),
            "friction": [
                g6._friction("hard", "pair", 70.0, window, outcome(0.2)),
                g6._friction("hard", "pair", 70.0, window[2:], None),
            ],
            "spread": frictions[0].spread,
            "places": g6.risk_places(),
            "by RCOF": g6.risk_by_rcof(),
            "strength": g6.pin_strength(),
            "risk": g6.population_risk(0.17),
            "case": [
                row
                for row in g6.sole_case(60.0, "bowden_tabor").to_toml().split("\n")
                if row and not row.startswith("#")
            ],
        },
    )
