"""The statistical tests of a study, each with its convention and what is doubtful about it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from underfoot.core import DataError, UnderfootError

from ..protocols import Protocol
from ..risk_curves import risk_curve
from ..statistics import (
    AnovaTable,
    ClusteredFit,
    LinearModel,
    LogisticFit,
    MixedModel,
    all_subsets,
    analysis_of_variance,
    clustered_logistic,
    fisher_exact,
    independence_warning,
    letters,
    logistic_regression,
    mixed_model,
    regression_line,
    repeated_measures,
    t_test,
    tukey_hsd,
)
from ..statistics.logistic import METHODS
from .conditions import person_condition
from .file_result import FileResult
from .tables import Cell, Table, decimals_of, quantity_name


@dataclass(frozen=True, slots=True)
class Finding:
    """One test: what was asked, the table, and cautions.

    Comparisons after Tukey name ``response`` and ``factor``; ``marks`` are the letters by level.
    """

    name: str
    title: str
    table: Table
    cautions: tuple[str, ...] = ()
    response: str = ""
    factor: str = ""
    marks: Mapping[str, str] = field(default_factory=dict)

    @classmethod
    def of_anova(cls, found: AnovaTable, cautions: tuple[str, ...] = ()) -> Finding:
        """Return an analysis of variance as a finding."""
        rows = tuple((r.term, r.sum_of_squares, r.df, r.f, r.p) for r in found.rows)
        plain = "".join(c if c.isalnum() else "_" for c in found.model.response_name.casefold())
        name = f"anova_{plain}_type_{found.ss_type}"
        columns = ("term", "sum of squares", "df", "F", "p")
        table = Table(name, found.title, columns, rows)
        return cls(name, found.title, table, (*cautions, *found.warnings))


def comparison_findings(
    response: str,
    values: Sequence[float],
    factors: Mapping[str, Sequence[str]],
    persons: Sequence[str] = (),
) -> list[Finding]:
    """Return tests of factors on a response, and Tukey's comparisons of the levels.

    Where persons repeat, the mixed model of their means comes first (and repeated measures, when
    every person has every condition); Tukey's comparisons are then its. The analysis of variance
    that takes trials as independent follows with a warning. Otherwise it stands alone.
    """
    if not factors:
        return []
    warning = independence_warning(persons)
    name = quantity_name(response)
    findings: list[Finding] = []
    model: LinearModel | MixedModel | None = None
    if warning:
        mixed, model = _mixed(response, values, factors, persons)
        findings += mixed
    try:
        table = _anova(values, factors, name)
    except UnderfootError as error:
        title = f"Analysis of variance of {name}"
        return [*findings, _not_done(f"anova_{response}", title, error)]
    if model is None and not any("empty cells" in text for text in table.warnings):
        model = table.model
    tukey = _tukey(response, model, factors) if model is not None else []
    return (
        [*findings, *tukey, Finding.of_anova(table, warning)]
        if warning
        else [Finding.of_anova(table), *tukey]
    )


def _anova(values: Sequence[float], factors: Mapping[str, Sequence[str]], name: str) -> AnovaTable:
    try:
        return analysis_of_variance(values, dict(factors), ss_type=3, name=name)
    except DataError:
        # Too few values for interactions: main effects alone.
        return analysis_of_variance(values, dict(factors), tuple(factors), ss_type=3, name=name)


def _mixed(
    response: str,
    values: Sequence[float],
    factors: Mapping[str, Sequence[str]],
    persons: Sequence[str],
) -> tuple[list[Finding], MixedModel | None]:
    name = quantity_name(response)
    title = f"Mixed model of {name}: means of persons, random intercept for each (REML)"
    key = f"mixed_{response}"
    try:
        try:
            model = mixed_model(values, factors, persons, name=name)
        except DataError:
            model = mixed_model(values, factors, persons, tuple(factors), name=name)
    except UnderfootError as error:
        return [_not_done(key, title, error)], None
    rows = tuple((row.term, row.df, row.error_df, row.f, row.p) for row in model.tests)
    notes = (
        f"{model.persons} persons, {model.trials} trials; standard deviation between persons "
        f"{model.person_sd:.3g}, within {model.residual_sd:.3g}. Wald F tests, type III, degrees "
        "of freedom between and within persons.",
    )
    columns = ("term", "df", "df of error", "F", "p")
    findings = [Finding(key, title, Table(key, title, columns, rows, notes), model.warnings)]
    try:
        repeated = repeated_measures(values, factors, persons)
    except UnderfootError:
        return findings, model
    title = f"Repeated-measures analysis of variance of {name}, means of persons"
    key = f"repeated_{response}"
    notes = ()
    if repeated.epsilon is not None and repeated.p_corrected is not None:
        notes = (
            f"Greenhouse-Geisser epsilon {repeated.epsilon:.3f}, p corrected with it "
            f"{repeated.p_corrected:.4g}.",
        )
    rows = tuple((row.term, row.df, row.error_df, row.f, row.p) for row in repeated.rows)
    return [*findings, Finding(key, title, Table(key, title, columns, rows, notes))], model


def _tukey(
    response: str, model: LinearModel | MixedModel, factors: Mapping[str, Sequence[str]]
) -> list[Finding]:
    findings = []
    by = "mixed model" if isinstance(model, MixedModel) else "analysis of variance"
    for factor, levels in factors.items():
        if len(set(levels)) < 3 and not isinstance(model, MixedModel):
            continue
        title = f"Tukey's comparisons of {quantity_name(response)} by {factor} ({by})"
        name = f"tukey_{response}_{factor}".replace(" ", "_")
        try:
            comparisons = tukey_hsd(model, factor)
        except UnderfootError as error:
            findings.append(_not_done(name, title, error))
            continue
        marks = letters(comparisons)
        rows = tuple(
            (c.first, c.second, c.difference, c.standard_error, c.low, c.high, c.p)
            for c in comparisons
        )
        columns = ("first", "second", "difference", "SE", "95 % low", "95 % high", "p adjusted")
        listed = ", ".join(f"{level} {mark}" for level, mark in marks.items())
        note = f"Levels that share a letter do not differ at 0.05: {listed}."
        places = decimals_of(min(c.standard_error for c in comparisons))
        decimals = {str(column): places for column in columns[2:6]}
        table = Table(name, title, columns, rows, (note,), decimals)
        findings.append(Finding(name, title, table, (), response, factor, marks))
    return findings


def slip_findings(
    files: Sequence[FileResult], protocol: Protocol, keys: tuple[str, ...]
) -> tuple[list[Finding], dict[str, Any], list[str]]:
    """Return the tests a human-slip protocol asks for, curves for figures, and notes."""
    findings: list[Finding] = []
    curves: dict[str, Any] = {}
    notes: list[str] = []
    wanted = protocol.words("tests")
    judged = [f for f in files if "slip" in f.main]
    person = person_condition((f.conditions for f in files), protocol.text("subject"))
    for key in keys:
        if "fisher" in wanted:
            findings += _fisher(judged, key, person)
        levels = {str(f.conditions.get(key)) for f in files if key in f.conditions}
        if "anova" not in wanted and len(levels) == 2:
            findings += _t_tests(files, key, sorted(levels), person)
    if "anova" in wanted:
        for name in ("rcof", "acof"):
            having = [f for f in files if name in f.main and all(k in f.conditions for k in keys)]
            factors = {
                k: [str(f.conditions[k]) for f in having]
                for k in keys
                if len({str(f.conditions[k]) for f in having}) > 1
            }
            if having:
                values = [f.main[name] for f in having]
                findings += comparison_findings(name, values, factors, persons_of(having, person))
    if "logistic" in wanted:
        found, curves["risk"] = _logistic(judged, person)
        findings += found
    if "line" in wanted:
        findings += _line(files, curves, person)
    if "subsets" in wanted:
        findings += _subsets(files)
    return findings, curves, notes


def persons_of(files: Sequence[FileResult], person: str) -> tuple[str, ...]:
    """Return whom each file is of; a file without the condition is a person of its own."""
    if not person:
        return ()
    return tuple(str(f.conditions.get(person, f.file)) for f in files)


def _fisher(files: Sequence[FileResult], key: str, person: str) -> list[Finding]:
    having = [f for f in files if key in f.conditions]
    levels = list(dict.fromkeys(str(f.conditions[key]) for f in having))
    counts = [
        [
            sum(str(f.conditions[key]) == level and f.main["slip"] == slip for f in having)
            for slip in (1.0, 0.0)
        ]
        for level in levels
    ]
    title = f"Slips by {key}: Fisher's exact test"
    name = f"fisher_{key}"
    try:
        found = fisher_exact(counts)
    except UnderfootError as error:
        return [_not_done(name, title, error)]
    rows = tuple(
        (level, slips, none, slips / (slips + none) if slips + none else None)
        for level, (slips, none) in zip(levels, counts, strict=True)
    )
    note = f"Two-sided exact p = {found.p:.4g}, by enumeration of all tables with these margins."
    if found.p_error is not None:
        note = (
            f"Two-sided p = {found.p:.4g} ± {found.p_error:.1g} (standard error) from 100 000 "
            "random tables with these margins: counting all would take too long."
        )
    if found.odds_ratio is not None:
        note += (
            f" Odds ratio {found.odds_ratio:.3g} (conditional estimate; 95 % {found.low:.3g} to "
            f"{found.high:.3g})."
        )
    table = Table(name, title, (key, "slips", "no slips", "share"), rows, (note,))
    return [Finding(name, title, table, independence_warning(persons_of(having, person)))]


def _t_tests(
    files: Sequence[FileResult], key: str, levels: list[str], person: str
) -> list[Finding]:
    """Return t tests of persons' means where persons are known, of trials otherwise."""
    rows, findings = [], []
    for name in ("peak_pressure", "peak_slipping_speed", "rcof"):
        having = [f for f in files if name in f.main and str(f.conditions.get(key)) in levels]
        values = [f.main[name] for f in having]
        group = [str(f.conditions[key]) for f in having]
        if min(group.count(level) for level in levels) < 2:
            continue
        persons = persons_of(having, person)
        if independence_warning(persons):
            mixed, model = _mixed(name, values, {key: group}, persons)
            findings += mixed + (_tukey(name, model, {key: group}) if model else [])
            continue
        samples = [[v for v, g in zip(values, group, strict=True) if g == lv] for lv in levels]
        for kind in ("welch", "pooled"):
            try:
                t = t_test(samples[0], samples[1], kind=kind)
            except UnderfootError:
                continue
            rows.append((quantity_name(name), t.title, t.difference, t.t, t.df, t.p))
    if rows:
        title = f"t tests of {levels[0]} against {levels[1]} ({key})"
        columns = ("quantity", "test", "difference (SI)", "t", "df", "p")
        table = Table(f"t_{key}", title, columns, tuple(rows))
        findings.insert(0, Finding(f"t_{key}", title, table))
    return findings


def _logistic(
    files: Sequence[FileResult], subject: str
) -> tuple[list[Finding], list[dict[str, Any]]]:
    from scipy.stats import t as student

    findings, drawn = [], []
    for name in ("acof", "rcof", "acof_minus_rcof"):
        having = [f for f in files if name in f.main]
        if len(having) < 8:
            continue
        y = [int(f.main["slip"]) for f in having]
        x = [f.main[name] for f in having]
        title = f"Logistic regression of slip on {quantity_name(name)}"
        rows: list[tuple[Cell, ...]] = []
        cautions: list[str] = []
        best = None
        for method in ("maximum_likelihood", "firth"):
            try:
                fit = logistic_regression(y, {name: x}, method=method)
            except UnderfootError as error:
                cautions.append(f"{METHODS[method].split(' (')[0]}: {error.what}")
                continue
            best = best or fit
            cautions += fit.warnings
            c = fit[name]
            intercept = fit["intercept"].estimate
            rows.append((method.replace("_", " "), intercept, c.estimate, c.low, c.high, c.p))
        curve_fit: LogisticFit | ClusteredFit | None = best
        persons = persons_of(having, subject)
        if independence_warning(persons):
            cautions += [*independence_warning(persons), "read the last line, errors by person"]
            try:
                gee = clustered_logistic(y, {name: x}, persons)
                c = gee[name]
                reach = float(student.ppf(0.975, gee.clusters - 2)) * c.corrected_error
                rows.append(
                    ("estimating equations, errors by person", gee["intercept"].estimate,
                     c.estimate, c.estimate - reach, c.estimate + reach, c.p)
                )  # fmt: skip
                curve_fit = gee
            except UnderfootError as error:
                cautions.append(f"estimating equations: {error.what}")
        columns = ("method", "intercept", "slope", "95 % low", "95 % high", "p")
        note = "Intervals of the first lines are profile likelihoods, p from likelihood ratios."
        table = Table(f"logistic_{name}", title, columns, tuple(rows), (note,))
        findings.append(Finding(f"logistic_{name}", title, table, tuple(dict.fromkeys(cautions))))
        if curve_fit is not None:
            reach = 0.1 * (max(x) - min(x))
            curve = risk_curve(curve_fit, np.linspace(min(x) - reach, max(x) + reach, 121))
            drawn.append(
                {
                    "name": name, "x": x, "y": y, "grid": curve.x.tolist(),
                    "risk": curve.risk.tolist(), "low": curve.low.tolist(),
                    "high": curve.high.tolist(), "method": METHODS[curve_fit.method],
                    "slope": float(curve_fit[name].estimate), "half": curve.half,
                }
            )  # fmt: skip
    return findings, drawn


def _line(files: Sequence[FileResult], curves: dict[str, Any], person: str) -> list[Finding]:
    having = [
        f for f in files
        if {"peak_slipping_speed", "peak_pressure"} <= {*f.main} and f.main.get("crossed_array", 1)
    ]  # fmt: skip
    x = [1e-3 * f.main["peak_pressure"] for f in having]
    y = [f.main["peak_slipping_speed"] for f in having]
    title = "Peak slipping speed against peak pressure"
    try:
        line = regression_line(x, y)
    except UnderfootError as error:
        return [_not_done("line", title, error)]
    curves["line"] = {"x": x, "y": y, "slope": line.slope, "intercept": line.intercept, "r": line.r}
    columns = ("r", "p", "slope (m/s per kPa)", "SE", "intercept (m/s)", "n")
    row = (line.r, line.p, line.slope, line.slope_error, line.intercept, line.n)
    note = "Trials whose heel crossed the sensor array."
    table = Table("line", title, columns, (row,), (note,))
    return [Finding("line", title, table, independence_warning(persons_of(having, person)))]


def _subsets(files: Sequence[FileResult]) -> list[Finding]:
    rows = [
        row for f in files for row in f.curves.get("sensor_rows", []) if f.main.get("slip", 1.0)
    ]
    title = "Adjusted R^2 of sensor peak pressure by subsets of variables (as Table 7)"
    if len(rows) < 12:
        return []
    pressure = [1e-3 * r["pressure"] for r in rows]
    shared = {
        "ML distance": [abs(r["ml"]) for r in rows],
        "IRSS": [r["irss"] for r in rows],
    }
    made = []
    for label, kind in (("as a factor (2 df)", str), ("as a trend (1 df)", float)):
        try:
            found = all_subsets(pressure, {"SPRWD": [kind(r["row"]) for r in rows], **shared})
        except UnderfootError as error:
            return [_not_done("subsets", title, error)]
        made += [
            (" + ".join(s.predictors), label, s.adjusted_r_squared, s.r_squared, len(rows))
            for s in found
        ]
    columns = ("variables", "SPRWD enters", "adjusted R^2", "R^2", "n")
    note = "Sensor passages of trials with a slip; ML is the distance without its sign."
    caution = "Nine sensors of one slip are not independent: p values would be too small."
    table = Table("subsets", title, columns, tuple(made), (note,))
    return [Finding("subsets", title, table, (caution,))]


def _not_done(name: str, title: str, error: UnderfootError) -> Finding:
    return Finding(name, title, Table(name, title, ("not done",), ((error.what,),)))
