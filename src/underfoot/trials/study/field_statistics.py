"""What reviewers and courts ask of a study: reliability, agreement, equivalence, curves, ranks."""

from collections.abc import Mapping, Sequence
from itertools import combinations

import numpy as np

from underfoot.core import DataError
from underfoot.core.presentation import p_text
from underfoot.core.remark import Message

from .. import statistics
from ..walking.gait_context import PERCENT
from .file_result import FileResult
from .tables import (
    HOLM_P,
    P_VALUE,
    Cell,
    Finding,
    Role,
    TrialColumn,
    decimals_of,
    finding,
    plain_columns,
    quantity_name,
)

_FEWEST = 5  # persons from which curves are compared and normality is judged


def person_columns(
    values: Sequence[float], levels: Sequence[str], persons: Sequence[object]
) -> dict[str, dict[str, float]]:
    """Return the mean of each person by level: {level: {person: mean}}."""
    means = statistics.person_means(values, {"level": levels}, persons)
    columns: dict[str, dict[str, float]] = {}
    for who, level, mean in zip(means.person, means.factors["level"], means.mean, strict=True):
        columns.setdefault(level, {})[who] = float(mean)
    return columns


def pair_values(
    columns: Mapping[str, Mapping[str, float]], first: str, second: str
) -> tuple[list[float], list[float], bool]:
    """Return the values of two levels: of the persons who have both, else of all, and which."""
    a, b = columns[first], columns[second]
    both = [who for who in a if who in b]
    if len(both) >= 2:
        return [a[who] for who in both], [b[who] for who in both], True
    return list(a.values()), list(b.values()), False


def effect_cells(
    columns: Mapping[str, Mapping[str, float]], first: str, second: str
) -> tuple[Cell, ...]:
    """Return Hedges' g of two levels with its interval; None where it can't be estimated."""
    a, b, same = pair_values(columns, first, second)
    try:
        effect = statistics.effect_size(a, b, paired=same)
    except DataError:
        return None, None, None
    return effect.value, effect.low, effect.high


def reliability_findings(
    response: str,
    values: Sequence[float],
    factors: Mapping[str, Sequence[str]],
    persons: Sequence[str],
) -> list[Finding]:
    """Return ICC, error of measurement and detectable change of repeated trials, by condition."""
    cells: dict[str, dict[str, list[float]]] = {}
    for i, (who, value) in enumerate(zip(persons, values, strict=False)):
        label = ", ".join(column[i] for column in factors.values()) or "all"
        cells.setdefault(label, {}).setdefault(who, []).append(value)
    rows = []
    for label, own in cells.items():
        repeated = [trials for trials in own.values() if len(trials) > 1]
        if len(repeated) < 3:
            continue
        try:
            one = statistics.intraclass_correlation(repeated, "ICC(1,1)")
            mean = statistics.intraclass_correlation(repeated, "ICC(1,k)")
        except DataError:
            continue
        ends = one.value, one.low, one.high, mean.value, mean.low, mean.high
        rows.append((label, *ends, one.error, one.detectable_change, one.subjects, one.k))
    if not rows:
        return []
    note = (
        "Repeated trials of persons, one-way random (trials have no order); k: mean of a person's "
        "trials. SEM: standard error of measurement of one trial; MDC95 = 2.77 SEM: smallest "
        "change of one person's single trial beyond chance."
    )
    title = f"Reliability of {quantity_name(response)}: intraclass correlation"
    places = decimals_of(min(float(row[7]) for row in rows))
    shares = ("ICC(1,1)", "95 % low", "95 % high", "ICC(1,k)", "low", "high")
    heads = (
        "condition", *plain_columns(*shares, decimals=3),
        *plain_columns("SEM", "MDC95", decimals=places),
        "persons", TrialColumn("trials each", decimals=1),
    )  # fmt: skip
    return [finding(f"reliability_{response}", title, heads, rows, note)]


def agreement_findings(
    groups: Mapping[tuple[str, ...], Mapping[str, Sequence[float]]], by: str, quantity: str
) -> list[Finding]:
    """Return ICC over raters of the samples' means, and Bland-Altman where there are two raters.

    ``groups``: readings by sample and by rater (operator, machine, laboratory).
    """
    raters = statistics.ordered_levels(sorted({rater for own in groups.values() for rater in own}))
    whole = {sample: own for sample, own in groups.items() if len(own) == len(raters)}
    if len(raters) < 2 or len(whole) < 3:
        return []
    name, findings = quantity_name(quantity), []
    means = [[float(np.mean(own[rater])) for rater in raters] for own in whole.values()]
    rows = []
    for form in ("ICC(A,1)", "ICC(C,1)"):
        try:
            icc = statistics.intraclass_correlation(means, form)
        except DataError:
            continue
        ends = icc.value, icc.low, icc.high, icc.error, icc.detectable_change
        rows.append((form, *ends, icc.subjects, len(raters)))
    if rows:
        heads = ("form", "ICC", "95 % low", "95 % high", "SEM", "MDC95", "samples", f"{by}s")
        title = f"Agreement of {name} over each {by}: intraclass correlation"
        note = f"Of the means of each sample by {by}. A: absolute agreement; C: consistency."
        findings.append(finding(f"icc_{by}", title, heads, rows, note))
    if len(raters) > 2:
        return findings
    first, second, samples = [], [], []
    for sample, own in whole.items():
        pairs = zip(own[raters[0]], own[raters[1]], strict=False)
        for a, b in pairs:
            first.append(a)
            second.append(b)
            samples.append(sample)
    try:
        limits = statistics.bland_altman(first, second, samples)
    except DataError:
        return findings
    heads = ("", name, "95 % low", "95 % high")
    rows = [
        ("bias", limits.bias, *limits.bias_interval),
        ("lower limit of agreement", limits.lower, *limits.lower_interval),
        ("upper limit of agreement", limits.upper, *limits.upper_interval),
    ]
    note = (
        f"{raters[0]} - {raters[1]}, {limits.pairs} pairs of {limits.subjects} samples; readings "
        "are paired in their order. Limits: bias -+ 1.96 SD of a single difference; the true value "
        f"may vary between readings. Differences against means: slope {limits.slope:.2g} "
        f"(p {limits.slope_p:.2g})."
    )
    title = f"Bland-Altman: {name}, {raters[0]} against {raters[1]}"
    caution = (
        (Message("the difference changes with the size: one bias does not describe it"),)
        if limits.slope_p < 0.05
        else ()
    )
    return [*findings, finding(f"bland_altman_{by}", title, heads, rows, note, caution)]


def equivalence_findings(
    response: str,
    values: Sequence[float],
    factors: Mapping[str, Sequence[str]],
    persons: Sequence[object],
    margin: float,
) -> list[Finding]:
    """Return two one-sided tests of each pair of levels, Holm's p over the pairs of a factor."""
    findings = []
    for factor, levels in factors.items():
        columns_of = person_columns(values, levels, persons or range(len(values)))
        rows: list[list[Cell]] = []
        for first, second in combinations(columns_of, 2):
            a, b, same = pair_values(columns_of, first, second)
            try:
                test = statistics.equivalence(a, b, margin, kind="paired" if same else "welch")
            except DataError:
                continue
            p = max(test.not_lower, test.not_higher)
            cells = first, second, test.difference, test.low, test.high
            rows.append([*cells, test.not_lower, test.not_higher, p, test.verdict])
        if not rows:
            continue
        for row, p in zip(
            rows, statistics.corrected_p([float(row[7] or 0.0) for row in rows]), strict=True
        ):
            row[7] = p
        tests = ("p (lower by the margin)", "p (higher by the margin)", "p equivalent (Holm)")
        heads = (
            "first", "second", "difference", "90 % low", "90 % high",
            *(TrialColumn(test, Role.CHANCE) for test in tests), "single verdict",
        )  # fmt: skip
        title = f"Equivalence of {quantity_name(response)} by {factor} within {margin:g}"
        note = (
            "Two one-sided t tests of persons' means, alpha 0.05. Not lower: the first is shown to "
            "be less than the margin below the second. The margin has to be fixed before the "
            "data are seen."
        )
        name = f"equivalence_{response}_{factor}".replace(" ", "_")
        findings.append(finding(name, title, heads, rows, note))
    return findings


def rank_findings(
    response: str,
    values: Sequence[float],
    factors: Mapping[str, Sequence[str]],
    persons: Sequence[object],
) -> list[Finding]:
    """Return rank tests where the scatter of persons' means is not normal (Shapiro and Wilk).

    Of three levels and more the pairs follow, with letters.
    """
    from scipy.stats import shapiro

    rows: list[tuple[Cell, ...]] = []
    findings: list[Finding] = []
    for factor, levels in factors.items():
        columns = person_columns(values, levels, persons or range(len(values)))
        people = {who: [own[who] for own in columns.values() if who in own]
                  for own in columns.values() for who in own}  # fmt: skip
        several = any(len(own) > 1 for own in people.values())
        left = [
            value - np.mean(list(own.values())) - (np.mean(people[who]) if several else 0.0)
            for own in columns.values()
            for who, value in own.items()
        ]
        if len(left) < 2 * _FEWEST or np.ptp(left) <= statistics.ROUNDING * max(map(abs, values)):
            continue
        normal = float(shapiro(left).pvalue)
        if normal >= 0.05:
            continue
        try:
            test = statistics.rank_test(values, levels, persons)
        except DataError:
            continue
        rows.append(
            (factor, test.name, test.statistic, test.p, _HOW[test.how], test.persons, normal)
        )
        if test.pairs:
            findings.append(_ranked_pairs(response, factor, test.pairs))
    if not rows:
        return []
    title = f"Rank tests of {quantity_name(response)}: the scatter is not normal"
    normality = TrialColumn("p of normality (Shapiro-Wilk)", Role.CHANCE)
    heads = ("factor", "test", "statistic", P_VALUE, "p by", "persons", normality)
    note = "Read beside the tests above, which assume a normal scatter of persons' means."
    return [finding(f"ranks_{response}", title, heads, rows, note), *findings]


_HOW = {"exact": "all orders", "drawn": "100 000 random orders", "large sample": "large samples"}


def _ranked_pairs(response: str, factor: str, pairs: Sequence[statistics.LevelPair]) -> Finding:
    marks = statistics.letters(pairs)
    listed = ", ".join(f"{level} {mark}" for level, mark in marks.items())
    title = f"Pairs of {quantity_name(response)} by {factor}: rank tests"
    heads = ("first", "second", "median difference", HOLM_P)
    note = f"Levels that share a letter do not differ at 0.05: {listed}."
    rows = [(pair.first, pair.second, pair.difference, pair.p) for pair in pairs]
    name = f"rank_pairs_{response}_{factor}".replace(" ", "_")
    return finding(name, title, heads, rows, note)


def share_findings(files: Sequence[FileResult], key: str, person: str) -> list[Finding]:
    """Return the differences of the shares of slips of two levels, with score intervals."""
    levels: dict[str, tuple[list[int], list[str]]] = {}
    for f in files:
        if key in f.conditions:
            slips, who = levels.setdefault(str(f.conditions[key]), ([], []))
            slips.append(int(f.main["slip"]))
            who.append(str(f.conditions.get(person, f.file)))
    rows: list[list[Cell]] = []
    for first, second in combinations(levels, 2):
        (a, a_person), (b, b_person) = levels[first], levels[second]
        told = statistics.share_difference(a, b, a_person, b_person)
        rows.append(
            [first, second, *told.shares, told.difference, told.low, told.high, told.p, None]
        )
    if not rows:
        return []
    p = statistics.corrected_p([float(row[-2] or 0.0) for row in rows])
    for row, held in zip(rows, p, strict=True):
        row[-1] = held
    shares = ("share of first", "share of second", "difference", "95 % low", "95 % high")
    heads = ("first", "second", *plain_columns(*shares, decimals=3), P_VALUE, HOLM_P)
    note = (
        "Score intervals (Miettinen and Nurminen). Persons who repeat count as many trials as have "
        "the variance between persons."
    )
    title = f"Shares of slips by {key}: differences of two"
    name = f"shares_{key}".replace(" ", "_")
    return [finding(name, title, heads, rows, note)]


def multiplicity_findings(findings: Sequence[Finding]) -> list[Finding]:
    """Return the p of all factors over several outcomes with Holm's and Benjamini-Hochberg's."""
    named = []
    for one in findings:
        at = one.table.heads.index(P_VALUE) if one.outcome else 0
        rows = one.table.rows if one.outcome else ()
        named += [(one.outcome, row[0], row[at]) for row in rows if row[at] is not None]
    if len({outcome for outcome, *_ in named}) < 2:
        return []
    p = [float(value) for *_, value in named if isinstance(value, float)]
    both = statistics.corrected_p(p), statistics.corrected_p(p, "fdr_bh")
    rows = [(*row, a, b) for row, a, b in zip(named, *both, strict=True)]
    heads = ("outcome", "term", P_VALUE, HOLM_P, TrialColumn("p (Benjamini-Hochberg)", Role.CHANCE))
    note = f"{len(rows)} tests of one study: Holm holds the chance of any false one at 5 %."
    title = "Several outcomes: p corrected for their number"
    return [finding("multiplicity", title, heads, rows, note)]


def prediction_finding(
    name: str, slips: Sequence[int], predictor: Sequence[float], persons: Sequence[str]
) -> Finding | None:
    """Return how well a number foretells slips: ROC area, Brier score, calibration by persons."""
    # A slip is expected where there is little friction available, or much needed.
    sign = 1.0 if name == "rcof" else -1.0
    try:
        area = statistics.roc_area(slips, sign * np.array(predictor), persons)
        told = statistics.slip_prediction(slips, predictor, persons)
    except DataError:
        return None
    rows: list[tuple[Cell, ...]] = [
        ("area under the ROC curve", area.area, area.low, area.high),
        ("Brier score, persons left out in turn", told.brier, told.brier_low, told.brier_high),
        ("Brier score of the share of slips alone", told.constant, None, None),
        ("calibration slope", told.calibration_slope, None, None),
        ("calibration intercept", told.calibration_intercept, None, None),
    ]
    note = (
        f"{area.persons} persons. Area: chance that a slip has the worse number (0.5: none); "
        "interval with persons as units (Obuchowski). Brier: mean squared error of the predicted "
        "risk, interval by bootstrap of persons. Calibration: slope 1, intercept 0 is right."
    )
    worse = (Message("the prediction is no better than the share of slips alone"),)
    caution = worse if told.brier >= told.constant else ()
    title = f"Prediction of slips from {quantity_name(name)}"
    heads = ("", *plain_columns("value", "95 % low", "95 % high", decimals=3))
    return finding(f"prediction_{name}", title, heads, rows, note, caution)


def curve_findings(
    files: Sequence[FileResult], factors: Sequence[str], person: str
) -> list[Finding]:
    """Return paired tests of the ratio of shear to normal force over the whole of stance."""
    if not person:
        return []
    having = [f for f in files if f.curves.get("normalised") and person in f.conditions]
    findings = []
    for factor in factors:
        curves: dict[str, dict[str, list[np.ndarray]]] = {}
        for f in (f for f in having if factor in f.conditions):
            own = curves.setdefault(str(f.conditions[factor]), {})
            for curve in f.curves["normalised"]:
                ratio = np.array(curve["ratio"], dtype=float)
                own.setdefault(str(f.conditions[person]), []).append(ratio)
        rows: list[list[Cell]] = []
        wholes = []
        for first, second in combinations(statistics.ordered_levels(sorted(curves)), 2):
            both = [who for who in curves[first] if who in curves[second]]
            if len(both) < _FEWEST:
                continue
            a, b = (
                np.array([np.mean(curves[level][who], axis=0) for who in both])
                for level in (first, second)
            )
            known = np.isfinite(a + b).all(axis=0)
            try:
                test = statistics.paired_curve_test(a[:, known], b[:, known])
            except DataError:
                continue
            percent = PERCENT[known]
            beyond = [
                f"{percent[c.start]:.0f} to {percent[c.stop]:.0f} % "
                f"(p of its length {p_text(c.p)}, of its peak {p_text(c.p_peak)})"
                for c in test.clusters
            ]
            wholes.append(test.p)
            where = ", ".join(beyond) or "nowhere"
            still = ", ".join(f"{percent[i]:.0f} %" for i in test.still)
            rows.append([first, second, len(both), test.threshold, where, test.p, None, still])
        if not rows:
            continue
        for row, p in zip(rows, statistics.corrected_p(wholes), strict=True):
            row[-2] = p
        heads = (
            "first", "second", "persons", TrialColumn("t beyond chance", decimals=2),
            "differs at (stance)", TrialColumn("p of the curve", Role.CHANCE), HOLM_P,
            "left out: no scatter at",
        )  # fmt: skip
        title = f"Shear / normal force over stance by {factor}: paired curves (SPM)"
        note = (
            "Paired t of persons' mean curves at each instant; one threshold for the whole curve "
            "(random field theory, two-sided, 5 %). p of the curve is that of its highest peak."
        )
        key = f"curves_{factor}".replace(" ", "_")
        findings.append(finding(key, title, heads, rows, note))
    return findings
