"""The statistical tests of a study, each with its convention and what is doubtful about it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from underfoot.core import UnderfootError

from ..protocols import Protocol
from ..risk_curves import risk_curve
from ..statistics import (
    all_subsets,
    analysis_of_variance,
    clustered_logistic,
    fisher_exact,
    letters,
    logistic_regression,
    regression_line,
    t_test,
    tukey_hsd,
)
from ..statistics.anova import AnovaTable
from ..statistics.logistic import METHODS
from .file_result import FileResult
from .tables import Cell, Table, words


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
    def of_anova(cls, found: AnovaTable) -> Finding:
        """Return an analysis of variance as a finding."""
        rows = tuple((r.term, r.sum_of_squares, r.df, r.f, r.p) for r in found.rows)
        plain = "".join(c if c.isalnum() else "_" for c in found.model.response_name.casefold())
        name = f"anova_{plain}_type_{found.ss_type}"
        columns = ("term", "sum of squares", "df", "F", "p")
        return cls(name, found.title, Table(name, found.title, columns, rows), found.warnings)


def anova_finding(
    response: str, values: Sequence[float], factors: Mapping[str, Sequence[str]]
) -> list[Finding]:
    """Return a type III analysis of variance and Tukey's comparisons of each factor."""
    if not factors:
        return []
    try:
        found = analysis_of_variance(values, dict(factors), ss_type=3, name=words(response))
    except UnderfootError as first:
        try:
            found = analysis_of_variance(
                values, dict(factors), tuple(factors), ss_type=3, name=words(response)
            )
        except UnderfootError:
            return [
                _not_done(f"anova_{response}", f"Analysis of variance of {words(response)}", first)
            ]
    results = [Finding.of_anova(found)]
    empty = any("empty cells" in text for text in found.warnings)
    for factor, levels in factors.items():
        if empty or len(set(levels)) < 3:
            continue
        comparisons = tukey_hsd(found.model, factor)
        marks = letters(comparisons)
        title = f"Tukey's comparisons of {words(response)} by {factor} (least-squares means)"
        name = f"tukey_{response}_{factor}".replace(" ", "_")
        rows = tuple(
            (c.first, c.second, c.difference, c.standard_error, c.low, c.high, c.p)
            for c in comparisons
        )
        columns = ("first", "second", "difference", "SE", "95 % low", "95 % high", "p adjusted")
        shown = ", ".join(f"{level} {mark}" for level, mark in marks.items())
        note = f"Levels that share a letter do not differ at 0.05: {shown}."
        table = Table(name, title, columns, rows, (note,))
        results.append(Finding(name, title, table, (), response, factor, marks))
    return results


def slip_findings(
    files: Sequence[FileResult], protocol: Protocol, keys: tuple[str, ...]
) -> tuple[list[Finding], dict[str, Any], list[str]]:
    """Return the tests a human-slip protocol asks for, curves for figures, and notes."""
    findings: list[Finding] = []
    curves: dict[str, Any] = {}
    notes: list[str] = []
    wanted = protocol.words("tests")
    judged = [f for f in files if "slip" in f.main]
    for key in keys:
        if "fisher" in wanted:
            findings += _fisher(judged, key)
        levels = {str(f.conditions.get(key)) for f in files if key in f.conditions}
        if "anova" not in wanted and len(levels) == 2:
            findings += _t_tests(files, key, sorted(levels))
    if "anova" in wanted:
        for name in ("rcof", "acof"):
            having = [f for f in files if name in f.main and all(k in f.conditions for k in keys)]
            factors = {
                k: [str(f.conditions[k]) for f in having]
                for k in keys
                if len({str(f.conditions[k]) for f in having}) > 1
            }
            if having:
                findings += anova_finding(name, [f.main[name] for f in having], factors)
    if "logistic" in wanted:
        found, curves["risk"] = _logistic(judged, protocol.text("subject", "subject"))
        findings += found
    if "line" in wanted:
        findings += _line(files, curves)
    if "subsets" in wanted:
        findings += _subsets(files)
    return findings, curves, notes


def _fisher(files: Sequence[FileResult], key: str) -> list[Finding]:
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
    if found.odds_ratio is not None:
        note += (
            f" Odds ratio {found.odds_ratio:.3g} (conditional estimate; 95 % {found.low:.3g} to "
            f"{found.high:.3g})."
        )
    table = Table(name, title, (key, "slips", "no slips", "share"), rows, (note,))
    return [Finding(name, title, table, _repeats(having))]


def _t_tests(files: Sequence[FileResult], key: str, levels: list[str]) -> list[Finding]:
    rows = []
    for name in ("peak_pressure", "peak_slipping_speed", "rcof"):
        samples = [
            [f.main[name] for f in files if name in f.main and str(f.conditions.get(key)) == level]
            for level in levels
        ]
        if min(map(len, samples)) < 2:
            continue
        for kind in ("welch", "pooled"):
            try:
                t = t_test(samples[0], samples[1], kind=kind)
            except UnderfootError:
                continue
            rows.append((words(name), t.title, t.difference, t.t, t.df, t.p))
    if not rows:
        return []
    title = f"t tests of {levels[0]} against {levels[1]} ({key})"
    columns = ("quantity", "test", "difference (SI)", "t", "df", "p")
    return [Finding(f"t_{key}", title, Table(f"t_{key}", title, columns, tuple(rows)))]


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
        title = f"Logistic regression of slip on {words(name)}"
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
        clusters = [str(f.conditions.get(subject, f.file)) for f in having]
        if len(set(clusters)) < len(clusters):
            cautions.append(
                f"{len(y)} trials of {len(set(clusters))} subjects are not independent: "
                "compare the last line"
            )
            try:
                gee = clustered_logistic(y, {name: x}, clusters)
                c = gee[name]
                low, high = (c.estimate + s * 1.96 * c.corrected_error for s in (-1, 1))
                rows.append(
                    ("estimating equations, clusters = subjects", gee["intercept"].estimate,
                     c.estimate, low, high, c.p)
                )  # fmt: skip
            except UnderfootError as error:
                cautions.append(f"estimating equations: {error.what}")
        columns = ("method", "intercept", "slope", "95 % low", "95 % high", "p")
        note = "Intervals of the first lines are profile likelihoods, p from likelihood ratios."
        table = Table(f"logistic_{name}", title, columns, tuple(rows), (note,))
        findings.append(Finding(f"logistic_{name}", title, table, tuple(dict.fromkeys(cautions))))
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


def _line(files: Sequence[FileResult], curves: dict[str, Any]) -> list[Finding]:
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
    return [Finding("line", title, Table("line", title, columns, (row,), (note,)))]


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


def _repeats(files: Sequence[FileResult]) -> tuple[str, ...]:
    subjects = [str(f.conditions["subject"]) for f in files if "subject" in f.conditions]
    if len(set(subjects)) < len(subjects):
        return (
            f"{len(subjects)} trials of {len(set(subjects))} subjects: the test takes them as "
            "independent",
        )
    return ()


def _not_done(name: str, title: str, error: UnderfootError) -> Finding:
    return Finding(name, title, Table(name, title, ("not done",), ((error.what,),)))
