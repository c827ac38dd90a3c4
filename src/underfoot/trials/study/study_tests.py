"""The statistical tests of a study, each with its convention and what is doubtful about it."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any, TypeVar

import numpy as np

from underfoot.core import DataError, UnderfootError
from underfoot.core.presentation import p_text
from underfoot.core.remark import Message, Remark, together
from underfoot.core.unit_text import plain_number

from .. import statistics
from ..recording.protocols import Protocol
from ..statistics.logistic import METHODS, risk_curve
from .conditions import person_condition
from .field_statistics import (
    curve_findings,
    effect_cells,
    equivalence_findings,
    multiplicity_findings,
    person_columns,
    prediction_finding,
    rank_findings,
    reliability_findings,
    share_findings,
)
from .file_result import FileResult
from .model_scripts import model_files
from .tables import (
    HOLM_P,
    P_VALUE,
    Cell,
    Finding,
    Role,
    TrialColumn,
    TrialTable,
    condition_columns,
    decimals_of,
    finding,
    not_done,
    plain_columns,
    quantity_name,
)

_Fit = TypeVar("_Fit")
_LAST = ("date", "day", "time", "session", "visit", "order", "operator")
"""Columns that give way where they can't be told from another."""


def comparison_findings(
    response: str,
    values: Sequence[float],
    factors: Mapping[str, Sequence[str]],
    persons: Sequence[str] = (),
    *,
    margin: float = 0.0,
) -> list[Finding]:
    """Return tests of factors on a response, and Tukey's comparisons of the levels.

    Factors of one level, or of a level each value, are named and left out; so are all but one of
    those that can't be told apart. Where persons repeat, repeated measures come first where every
    person has every condition, then the mixed model; Tukey's comparisons are its. The analysis of
    variance that takes trials as independent follows with a warning. Otherwise it stands alone.
    Rank tests follow where the scatter is not normal, tests of equivalence where there is a
    ``margin``, and the reliability of repeated trials.
    """
    factors, left = varying(response, factors, persons)
    factors, confounded = statistics.told_apart(factors, persons, last=_LAST)
    repeated = reliability_findings(response, values, factors, persons)
    if not factors and (left or confounded):
        title = Message("Comparisons of {response}", response=quantity_name(response))
        nothing = [
            Message("{confounded}: nothing is left to compare", confounded=each.message)
            for each in confounded
        ]
        reasons = [*left, *nothing]
        lost = finding(f"anova_{response}", title, ("not done",), [(reason,) for reason in reasons])
        return [lost, *repeated]
    if not factors:
        return repeated
    if margin:
        repeated = [*equivalence_findings(response, values, factors, persons, margin), *repeated]
    repeated = [*rank_findings(response, values, factors, persons), *repeated]
    warning = statistics.independence_warning(persons)
    name = quantity_name(response)
    findings, model = _mixed_model(response, values, factors, persons) if warning else ([], None)
    try:
        table = _crossed_model(
            factors,
            lambda terms: statistics.analysis_of_variance(values, factors, terms, name=name),
        )
    except UnderfootError as error:
        title = Message("Analysis of variance of {name}", name=name)
        first, *rest = [*findings, not_done(f"anova_{response}", title, error)]
        return [_with_left_out(first, left, confounded), *rest, *repeated]
    if model is None and not warning and not table.model.dependent:
        model = table.model
    tukey = _tukey(response, model, values, factors, persons) if model is not None else []
    # the mixed model of persons who repeat counts in place of trials taken as independent
    repeats = bool(warning) and len(set(persons)) > 1
    anova = Finding.of_anova(table, warning, outcome="" if repeats else name)
    found = [*findings, *tukey, anova] if warning else [anova, *tukey]
    return [_with_left_out(found[0], left, confounded), *found[1:], *repeated]


def _with_left_out(
    first: Finding, left: Sequence[Remark], confounded: Sequence[statistics.Confounded]
) -> Finding:
    """Return the first finding of a response with the factors that it says nothing of."""
    doubtful = tuple(
        Message("{confounded}; it is left out of this analysis", confounded=each.message)
        for each in confounded
    )
    table = replace(first.table, notes=(*first.table.notes, *left))
    return replace(first, table=table, cautions=(*doubtful, *first.cautions))


def _crossed_model(
    factors: Mapping[str, Sequence[str]], fit: Callable[[tuple[str, ...] | None], _Fit]
) -> _Fit:
    """Return a crossed model; without the interactions that there are too few values for."""
    for order in (None, 2):
        try:
            return fit(statistics.crossed_terms(*factors, order=order))
        except DataError:
            continue
    return fit(tuple(factors))


def _mixed_model(
    response: str,
    values: Sequence[float],
    factors: Mapping[str, Sequence[str]],
    persons: Sequence[str],
) -> tuple[list[Finding], statistics.MixedModel | None]:
    name = quantity_name(response)
    title = Message(
        "Mixed model of {name}: persons, and how each reacts, at random (REML)", name=name
    )
    key = f"mixed_{response}"
    try:
        model = _crossed_model(
            factors,
            lambda terms: statistics.mixed_model(values, factors, persons, terms, name=name),
        )
    except UnderfootError as error:
        return [not_done(key, title, error)], None
    spreads = [
        Message("{what} {sd}", what=what, sd=plain_number(float(np.sqrt(max(variance, 0.0)))))
        for what, variance in model.variances.items()
        if np.isfinite(variance)
    ]
    note = Message(
        "{persons} persons, {trials} trials; standard deviations: {spreads}. "
        "F tests, type III, each against how differently persons react to "
        "the factor, degrees of freedom after Kenward and Roger.",
        persons=model.persons, trials=model.trials, spreads=spreads,
    )  # fmt: skip
    note = together([note, *_power_note(model, factors)])
    heads = ("term", "df", "df of error", "F", P_VALUE)
    rows = [(row.term, row.df, row.error_df, row.f, row.p) for row in model.tests]
    files = model_files(key, title, model, response, values, factors, persons)
    mixed = finding(key, title, heads, rows, note, model.warnings)
    mixed = replace(mixed, files=files, outcome=name)
    try:
        repeated = statistics.repeated_measures(values, factors, persons)
    except UnderfootError:
        return [mixed], model
    title = Message("Repeated-measures analysis of variance of {name}, means of persons", name=name)
    heads = (*heads, "epsilon", TrialColumn("p (Greenhouse-Geisser)", Role.CHANCE))
    corrected = zip(repeated.rows, repeated.epsilon, repeated.p_corrected, strict=True)
    rows = [(row.term, row.df, row.error_df, row.f, row.p, *more) for row, *more in corrected]
    note = (
        "Every person has every condition. The corrected p holds also where persons' reactions to "
        "some levels differ more than to others."
    )
    return [finding(f"repeated_{response}", title, heads, rows, note), mixed], model


def _power_note(
    model: statistics.MixedModel, factors: Mapping[str, Sequence[str]]
) -> list[Message]:
    """Return the difference that so many persons find, by the error of each factor within them."""
    found, half = [], []
    for factor in (name for name in factors if name in model.within):
        errors = [c.standard_error for c in statistics.tukey_hsd(model, factor)]
        spread = float(np.median(errors)) * np.sqrt(model.persons)
        least = statistics.detectable_difference("paired", model.persons, spread)
        count = statistics.persons_needed(
            lambda n, d=least / 2, sd=spread: statistics.power("paired", n, difference=d, sd=sd)
        )
        found.append(
            Message(
                "{least} between two levels of {factor}",
                least=plain_number(least, 2), factor=factor,
            )
        )  # fmt: skip
        half.append(str(count))
    if not found:
        return []
    return [
        Message(
            "So many persons find a difference of {names} with 80 % power "
            "(paired t); half of it would take {half}.",
            names=found, half=dict.fromkeys(half),
        )
    ]  # fmt: skip


def _tukey(
    response: str,
    model: statistics.LinearModel | statistics.MixedModel,
    values: Sequence[float],
    factors: Mapping[str, Sequence[str]],
    persons: Sequence[str],
) -> list[Finding]:
    findings = []
    mixed = isinstance(model, statistics.MixedModel)
    by = "mixed model" if mixed else "analysis of variance"
    for factor, levels in factors.items():
        if len(set(levels)) < 3 and not mixed:
            continue
        title = Message(
            "Tukey's comparisons of {response} by {factor} ({by})",
            response=quantity_name(response), factor=factor, by=by,
        )  # fmt: skip
        name = f"tukey_{response}_{factor}".replace(" ", "_")
        try:
            comparisons = statistics.tukey_hsd(model, factor)
        except UnderfootError as error:
            findings.append(not_done(name, title, error))
            continue
        marks = statistics.letters(comparisons)
        drawn = person_columns(values, levels, persons or range(len(values)))
        rows = tuple(
            (c.first, c.second, c.difference, c.standard_error, c.low, c.high, c.p,
             *effect_cells(drawn, c.first, c.second))
            for c in comparisons
        )  # fmt: skip
        listed = [
            Message("{level} {mark}", level=level, mark=mark) for level, mark in marks.items()
        ]
        effect = Message(
            "Hedges' g is not estimated: so few values have no SD that can be trusted."
        )
        if any(row[-3] is not None for row in rows):
            effect = Message(
                "Hedges' g of the persons who have both levels (difference over the SD of their "
                "differences), else over the pooled SD; its interval is exact and holds one "
                "comparison."
            )
        alike = Message(
            "Levels that share a letter do not differ at 0.05: {listed}.", listed=listed
        )
        note = together([alike, effect])
        places = decimals_of(min(c.standard_error for c in comparisons))
        heads = (
            "first", "second",
            *plain_columns("difference", "SE", "95 % low", "95 % high", decimals=places),
            TrialColumn("p adjusted", Role.CHANCE),
            *plain_columns("Hedges' g", "g 95 % low", "g 95 % high", decimals=2),
        )  # fmt: skip
        table = TrialTable.of(name, title, heads, rows, note)
        findings.append(
            Finding(name, title, table, (), response, factor, marks, drawn, by_person=bool(persons))
        )
    return findings


def slip_findings(
    files: Sequence[FileResult], protocol: Protocol, keys: tuple[str, ...]
) -> tuple[list[Finding], dict[str, Any]]:
    """Return the tests a human-slip protocol asks for, and curves for figures."""
    findings: list[Finding] = []
    curves: dict[str, Any] = {}
    wanted = protocol.texts("tests")
    judged = [f for f in files if "slip" in f.main]
    person = person_condition(files, protocol.text("subject"))
    for key in keys:
        if "fisher" in wanted:
            findings.append(_fisher(judged, key, person))
            findings += share_findings(judged, key, person)
        levels = {str(f.conditions.get(key)) for f in files if key in f.conditions}
        if "anova" not in wanted and len(levels) == 2:
            findings += _t_tests(files, key, [*statistics.ordered_levels(sorted(levels))], person)
    if "anova" in wanted:
        for name in ("rcof", "acof"):
            having = [f for f in files if name in f.main and all(k in f.conditions for k in keys)]
            if having:
                values = [f.main[name] for f in having]
                factors, persons = columns_of(having, keys), persons_of(having, person)
                margin = protocol.number("equivalence", "1", 0.0)
                findings += comparison_findings(name, values, factors, persons, margin=margin)
        findings += multiplicity_findings(findings)
    findings += curve_findings(files, keys, person)
    if "logistic" in wanted:
        found, curves["risk"] = _logistic(judged, person)
        findings += found
    if "line" in wanted:
        findings.append(_line(files, curves, person))
    if "subsets" in wanted:
        findings += _subsets(files)
    return findings, curves


def persons_of(files: Sequence[FileResult], person: str) -> tuple[str, ...]:
    """Return whom each file is of; a file without the condition is a person of its own."""
    if not person:
        return ()
    return tuple(str(f.conditions.get(person, f.file)) for f in files)


def varying(
    response: str, factors: Mapping[str, Sequence[str]], persons: Sequence[str] = ()
) -> tuple[dict[str, Sequence[str]], list[Remark]]:
    """Return the factors with levels that can be compared, and why the others are not estimated.

    ``response``: name of the quantity. ``factors``: level of each of its values, by factor.
    ``persons``: whose each value is; a factor that only says who it was (a date each) is told so.
    """
    compared: dict[str, Sequence[str]] = {}
    left = []
    for name, levels in factors.items():
        several = set(levels)
        if statistics.names_persons(levels, persons):
            left.append(
                Remark(name, "each person has one of their own: its effect is not estimated")
            )
            continue
        if 1 < len(several) < len(levels):
            compared[name] = levels
            continue
        known = Message("once at each value") if several else Message("nowhere")
        if len(several) == 1:
            known = Message('at one value only, "{level}"', level=levels[0])
        left.append(
            Remark(
                name,
                "{response} is known {known}: the effect of {name} is not estimated",
                response=quantity_name(response), known=known, name=name,
            )
        )  # fmt: skip
    return compared, left


def columns_of(files: Sequence[FileResult], keys: Sequence[str]) -> dict[str, list[str]]:
    """Return conditions that all the files have, each with its level by file."""
    return {
        key: [str(f.conditions[key]) for f in files]
        for key in keys
        if all(key in f.conditions for f in files)
    }


def _fisher(files: Sequence[FileResult], key: str, person: str) -> Finding:
    having = [f for f in files if key in f.conditions]
    counts: dict[str, list[int]] = {}
    for f in having:
        counts.setdefault(str(f.conditions[key]), [0, 0])[f.main["slip"] != 1.0] += 1
    title = Message("Slips by {key}: Fisher's exact test", key=key)
    name = f"fisher_{key}"
    try:
        exact = statistics.fisher_exact(list(counts.values()))
    except UnderfootError as error:
        return not_done(name, title, error)
    rows = [(level, slips, none, slips / (slips + none)) for level, (slips, none) in counts.items()]
    counted = {"p": p_text(exact.p)}
    note = Message(
        "Two-sided exact p {p}, by enumeration of all tables with these margins.", **counted
    )
    if exact.p_error is not None:
        note = Message(
            "Two-sided p {p} ± {error} (standard error) from 100 000 random tables with these "
            "margins: counting all would take too long.",
            **counted, error=plain_number(exact.p_error, 1),
        )  # fmt: skip
    if exact.odds_ratio is not None and exact.low is not None and exact.high is not None:
        ratio = Message(
            "Odds ratio {ratio} (conditional estimate; 95 % {low} to {high}).",
            ratio=plain_number(exact.odds_ratio), low=plain_number(exact.low),
            high=plain_number(exact.high),
        )  # fmt: skip
        note = together([note, ratio])
    warning = statistics.independence_warning(persons_of(having, person))
    heads = (*condition_columns([key]), "slips", "no slips", "share")
    return finding(name, title, heads, rows, note, warning)


def _t_tests(
    files: Sequence[FileResult], key: str, levels: list[str], person: str
) -> list[Finding]:
    """Return t tests of persons' means where persons are known, of trials otherwise."""
    rows, kinds, findings = [], [], []
    for name in ("peak_pressure", "peak_slipping_speed", "rcof"):
        having = [f for f in files if name in f.main and str(f.conditions.get(key)) in levels]
        values = [f.main[name] for f in having]
        group = [str(f.conditions[key]) for f in having]
        if min(group.count(level) for level in levels) < 2:
            continue
        persons = persons_of(having, person)
        if statistics.independence_warning(persons):
            mixed, model = _mixed_model(name, values, {key: group}, persons)
            tukey = _tukey(name, model, values, {key: group}, persons) if model else []
            findings += mixed + tukey
            continue
        samples = [[v for v, g in zip(values, group, strict=True) if g == lv] for lv in levels]
        for kind in ("welch", "pooled"):
            try:
                t = statistics.t_test(*samples, kind=kind)
            except UnderfootError:
                continue
            rows.append((quantity_name(name), t.title, t.difference, t.t, t.df, t.p))
            kinds.append(kind)
    if rows:
        # rows come in pairs: Welch's test, on which the correction stands, then Student's
        welch = [row[-1] for row, kind in zip(rows, kinds, strict=True) if kind == "welch"]
        corrected = iter(statistics.corrected_p(welch))
        rows = [
            (*row, next(corrected) if kind == "welch" else None)
            for row, kind in zip(rows, kinds, strict=True)
        ]
        title = Message(
            "t tests of {first} against {second} ({key})",
            first=levels[0], second=levels[1], key=key,
        )  # fmt: skip
        heads = ("quantity", "test", "difference (SI)", "t", "df", P_VALUE, HOLM_P)
        findings.insert(0, finding(f"t_{key}", title, heads, rows))
    return findings


def _logistic(
    files: Sequence[FileResult], subject: str
) -> tuple[list[Finding], list[dict[str, Any]]]:
    findings, drawn = [], []
    for name in ("acof", "rcof", "acof_minus_rcof"):
        having = [f for f in files if name in f.main]
        if len(having) < 8:
            continue
        y = [int(f.main["slip"]) for f in having]
        x = [f.main[name] for f in having]
        title = Message("Logistic regression of slip on {name}", name=quantity_name(name))
        rows: list[tuple[Cell, ...]] = []
        cautions: list[Message] = []
        best: statistics.LogisticFit | statistics.ClusteredFit | None = None
        for method in ("maximum_likelihood", "firth"):
            try:
                fit = statistics.logistic_regression(y, {name: x}, method=method)
            except UnderfootError as error:
                cautions.append(Remark.of(method.replace("_", " "), error.what))
                continue
            best = best or fit
            cautions += fit.warnings
            c = fit[name]
            intercept = fit["intercept"].estimate
            rows.append((method.replace("_", " "), intercept, c.estimate, c.low, c.high, c.p))
        persons = persons_of(having, subject)
        warning = statistics.independence_warning(persons)
        if warning:
            cautions += [*warning, Message("read the last line, errors by person")]
            try:
                best = gee = statistics.clustered_logistic(y, {name: x}, persons)
                c = gee[name]
                intercept = gee["intercept"].estimate
                by_person = "estimating equations, errors by person"
                rows.append((by_person, intercept, c.estimate, c.low, c.high, c.p))
            except UnderfootError as error:
                cautions.append(Remark.of("estimating equations", error.what))
        heads = ("method", "intercept", "slope", "95 % low", "95 % high", P_VALUE)
        note = (
            "Intervals of the first lines are profile likelihoods, p from likelihood ratios; those "
            "by person are Kauermann and Carroll's errors with t, p from flipped signs of persons."
        )
        cautions = list(dict.fromkeys(cautions))
        findings.append(finding(f"logistic_{name}", title, heads, rows, note, cautions))
        told = prediction_finding(name, y, x, persons)
        findings += [told] if told is not None else []
        if best is not None:
            reach = 0.1 * (max(x) - min(x))
            curve = risk_curve(best, np.linspace(min(x) - reach, max(x) + reach, 121))
            drawn.append(
                {
                    "name": name, "x": x, "y": y, "grid": curve.x.tolist(),
                    "risk": curve.risk.tolist(), "low": curve.low.tolist(),
                    "high": curve.high.tolist(), "method": METHODS[best.method],
                    "slope": float(best[name].estimate), "half": curve.half,
                }
            )  # fmt: skip
    return findings, drawn


def _line(files: Sequence[FileResult], curves: dict[str, Any], person: str) -> Finding:
    having = [
        f for f in files
        if {"peak_slipping_speed", "peak_pressure"} <= {*f.main} and f.main.get("crossed_array", 1)
    ]  # fmt: skip
    x = [1e-3 * f.main["peak_pressure"] for f in having]
    y = [f.main["peak_slipping_speed"] for f in having]
    title = "Peak slipping speed against peak pressure"
    try:
        line = statistics.regression_line(x, y)
    except UnderfootError as error:
        return not_done("line", title, error)
    curves["line"] = {"x": x, "y": y, "slope": line.slope, "intercept": line.intercept, "r": line.r}
    heads = ("r", P_VALUE, "slope (m/s per kPa)", "SE", "intercept (m/s)", "n")
    row = (line.r, line.p, line.slope, line.slope_error, line.intercept, line.n)
    note = "Trials whose heel crossed the sensor array."
    warning = statistics.independence_warning(persons_of(having, person))
    return finding("line", title, heads, [row], note, warning)


def _subsets(files: Sequence[FileResult]) -> list[Finding]:
    rows = [
        row for f in files for row in f.curves.get("sensor_rows", []) if f.main.get("slip", 1.0)
    ]
    title = "Adjusted R^2 of sensor peak pressure by subsets of variables (as Table 7)"
    if len(rows) < 12:
        return []
    pressure = [1e-3 * r["pressure"] for r in rows]
    shared = {"ML distance": [abs(r["ml"]) for r in rows], "IRSS": [r["irss"] for r in rows]}
    made = []
    for label, kind in (("as a factor (2 df)", str), ("as a trend (1 df)", float)):
        try:
            subsets = statistics.all_subsets(
                pressure, {"SPRWD": [kind(r["row"]) for r in rows], **shared}
            )
        except UnderfootError as error:
            return [not_done("subsets", title, error)]
        made += [
            (" + ".join(s.predictors), label, s.adjusted_r_squared, s.r_squared, len(rows))
            for s in subsets
        ]
    heads = ("variables", "SPRWD enters", "adjusted R^2", "R^2", "n")
    note = "Sensor passages of trials with a slip; ML is the distance without its sign."
    caution = Message("Nine sensors of one slip are not independent: p values would be too small.")
    return [finding("subsets", title, heads, made, note, (caution,))]
