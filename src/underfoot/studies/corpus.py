"""Everybody's measurements: each laboratory predicted from all others; effects from whole cases."""

from __future__ import annotations

import inspect
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from underfoot.case import Case
from underfoot.compute.run import run
from underfoot.core import UnderfootError, content_hash
from underfoot.core.arrays import Array
from underfoot.friction import packaged_pair_draws, pair_contact
from underfoot.friction.tread_error import tread_pairs

from .corpus_cases import (
    Contrast,
    Stand,
    contrasts,
    verdict,
    whole_shoe_stands,
)
from .figure import PRINTED, Figure, Panel, line, points
from .pair_law import (
    FEATURE_RIVALS,
    LAWS,
    CorpusScore,
    LaboratoryScore,
    PairPosterior,
    corpus_score,
    fit_law,
    laboratory_left_out,
    law_named,
    middle,
    r2,
    score_predictions,
)
from .runner import Computed, Options, StudyTable, cached_arrays, part
from .slips import POINTS, predict_shares, published_shares
from .sources import PublishedCondition, PublishedReading, corpus
from .verdict import ComputedQuantity

STATEMENTS = Path(__file__).with_name("corpus.toml")

STEPS, QUICK_STEPS = 1000, 400
"""A fifth of the sampler's points."""
LAW, PRIORS, REPORT = "pair", "pair, priors alone", "report"
"""REPORT is the laboratory of the report's own studies; everybody else is scored beside all."""
OWN_FORMS = (LAW, PRIORS, "pair, dry area to a power")
"""Not rivals of the law: itself, and a form of it that cases do not use."""
QUICK_LAWS = ("one constant", *FEATURE_RIVALS, PRIORS, LAW)
QUICK_SOURCES = ("khaday_2021", "li_2006", "mohamed_2011", "report_g6", "strobel_2012")
"""Whose effects and whole shoes the quick form computes."""
NEVER_ABSENT = {"hardness", "roughness", "groove direction", "depth", "edge radius"}
HUMAN_SLIPS = {
    "name": "human slips, treaded (G.5)",
    "shoe": "slip_resistant_shoe_treaded",
    "floor": "vinyl_g4",
    "contaminant": "glycerol_90pct",
    "motion": {"from": "slip_tester_g4"},
}
CASES = "corpus_cases-2"
FEWEST_VALUES = 3
"""Of a source for an R2 about its own mean: of two, an order is all there is."""
CODE = ("pair_law.py", "sources.py")
"""What the fits depend on beside the readings and the law."""


@cache
def draws_hash() -> str:
    """Return the content of the packaged draws of the law."""
    return content_hash(packaged_pair_draws().columns())


@dataclass(frozen=True, slots=True)
class LaboratorySplit:
    """A law and the laboratory that is left out of its fit."""

    law: str
    laboratory: str
    steps: int


def draws_of(split: LaboratorySplit) -> Mapping[str, Any]:
    """Return draws of ln COF of the laboratory left out, their mean, and the rest of each source
    given one of its readings."""
    law = (
        split.law
        if split.law in FEATURE_RIVALS
        else law_named(LAW if split.law == PRIORS else split.law)
    )
    left = laboratory_left_out(
        law, readings(), split.laboratory, steps=split.steps, data=split.law != PRIORS
    )
    return {"draws": left.draws, "expected": left.expected, "after": left.after}


def readings() -> list[PublishedCondition]:
    """Return every condition with a reading of the verified sources."""
    return [c for source in corpus() if source.verified for c in source.conditions]


def compute(options: Options) -> Computed:
    """Return the score of each law, the prediction of each reading and the constants."""
    conditions = readings()
    laboratories = list(dict.fromkeys(c.laboratory for c in conditions))
    steps = QUICK_STEPS if options.quick else STEPS
    every = (*(law.name for law in LAWS[:-1]), *FEATURE_RIVALS, PRIORS, LAW)
    names = QUICK_LAWS if options.quick else every
    splits = [
        LaboratorySplit(name, laboratory, steps) for name in names for laboratory in laboratories
    ]
    code = [(STATEMENTS.parent / name).read_text(encoding="utf-8") for name in CODE]
    code += [inspect.getsource(pair_contact), [repr(pair) for pair in tread_pairs()]]
    content = content_hash([repr(c) for c in conditions], *code)
    keys = [content_hash(asdict(split), content) for split in splits]
    results: dict[tuple[str, str], LaboratoryScore] = {}
    fits = part(options.progress, 0.0, 0.5)
    work = cached_arrays("corpus-4", draws_of, splits, keys, processes=options.processes)
    for number, (split, arrays) in enumerate(work, start=1):
        fits("leaving one laboratory out", number / len(splits))
        own = tuple(c for c in conditions if c.laboratory == split.laboratory)
        results[split.law, split.laboratory] = LaboratoryScore(
            split.laboratory, own, score=score_predictions(arrays["draws"], own), **arrays
        )

    def score(name: str, left: Sequence[str]) -> CorpusScore:
        return corpus_score(name, [results[name, one] for one in left])

    others = [one for one in laboratories if one != REPORT]
    scores = {name: (score(name, others), score(name, laboratories)) for name in names}
    posterior = fit_law(law_named(LAW), conditions, steps=steps, seed=options.seed)
    own = [results[LAW, one] for one in laboratories]
    (best, whole_best) = scores[LAW]
    rivals = [pair[0] for name, pair in scores.items() if name not in OWN_FORMS]
    sources, highest_prior = _sources(own, [results[PRIORS, one] for one in laboratories])
    after, known = _after(own)
    width, inside_known = _where_known(own)
    sides, shoes = _compare_sources(options)
    effects, shares = _effects(sides)
    whole, inside = _whole(shoes)
    slips, shares_of_slips = _slips(options)
    verdicts = Counter(row[effects.columns.index("verdict")] for row in effects.rows)
    strongest = max(rivals, key=lambda one: one.r2)
    return Computed(
        {
            **shares,
            **inside,
            **known,
            **shares_of_slips,
            **{
                f"others.{name}": ComputedQuantity.of(getattr(best, name))
                for name in ("r2", "inside_50", "inside_95")
            },
            "pair.width": ComputedQuantity.of(width),
            "pair.inside_known": ComputedQuantity.of(inside_known),
            "others.above_rivals": ComputedQuantity.of(best.r2 - strongest.r2),
            "others.gain": ComputedQuantity.of(
                best.log_density - max(rival.log_density for rival in rivals)
            ),
            "priors.r2": ComputedQuantity.of(highest_prior),
            "pair.r2": ComputedQuantity.of(whole_best.r2),
            "pair.rank_correlation": ComputedQuantity.of(whole_best.rank_correlation),
            "evidence.readings": ComputedQuantity.of(len(conditions)),
            "evidence.laboratories": ComputedQuantity.of(len(laboratories)),
            "evidence.dry": ComputedQuantity.of(
                sum(not c.members and c.fluid == "dry" for c in conditions)
            ),
        },
        (
            _scores(scores),
            sources,
            after,
            _constants(posterior),
            effects,
            whole,
            slips,
            _basis(sides, shoes),
        ),
        {"predicted": _figure(own)},
        (
            f"Contact friction in a laboratory that was not used, everybody but the report: R2 of "
            f"ln COF {best.r2:.2f} ({strongest.law}: {strongest.r2:.2f}; priors alone: "
            f"{scores[PRIORS][0].r2:.2f}); all laboratories: {whole_best.r2:.2f}.",
            f"{best.inside_95:.0%} of everybody else's readings lie inside the 95 % interval, "
            f"{best.inside_50:.0%} inside the 50 % one; its mean width is a factor of "
            f"{np.exp(best.width):.0f}. {len(conditions)} readings of {len(laboratories)} "
            "laboratories, each counts once.",
            f"Published effects as whole cases: {verdicts['right']} right, {verdicts['undecided']} "
            f"undecided, {verdicts['absent']} absent, {verdicts['wrong']} wrong and "
            f"{verdicts['not computed']} not computed (counted by fluid).",
        ),
    )


@dataclass(frozen=True, slots=True)
class Side:
    """COF of what stands for one condition, at the medians and in the joint draws."""

    cof: float
    draws: Array
    reason: str = ""


def whole_cof(case: Case) -> Mapping[str, Any]:
    """Return COF of a case and its draws, or why there is none."""
    try:
        result = run(case, quick=True)
        return {"cof": result.value("cof"), "draws": result.data["cof_draws"].values}
    except UnderfootError as error:
        return {"reason": np.array(" ".join(str(error).split()))}


def _compare_sources(
    options: Options,
) -> tuple[list[tuple[Contrast, Side, Side]], list[tuple[PublishedCondition, Stand, Side]]]:
    sources = [s for s in corpus() if not options.quick or s.name in QUICK_SOURCES]
    sides = [contrast for source in sources if source.verified for contrast in contrasts(source)]
    shoes = [
        whole_shoe_stand
        for source in sources
        if source.verified
        for whole_shoe_stand in whole_shoe_stands(source)
    ]
    stands = [stand for contrast in sides for stand in (contrast.over, contrast.under)]
    stands += [stand for _, stand in shoes]
    cases = {case.hash: case for stand in stands for case in stand.cases}
    values: dict[str, Mapping[str, Any]] = {}
    runs = part(options.progress, 0.5, 1.0)
    work = cached_arrays(
        CASES,
        whole_cof,
        list(cases.values()),
        [_key(case) for case in cases.values()],
        processes=options.processes,
    )
    for number, (case, arrays) in enumerate(work, start=1):
        runs("whole cases", number / len(cases))
        values[case.hash] = arrays

    def side(stand: Stand) -> Side:
        own = [values[case.hash] for case in stand.cases]
        reason = stand.reason or next((str(v["reason"]) for v in own if "reason" in v), "")
        if reason:
            return Side(np.nan, np.array([np.nan]), reason)
        cof, draws = (np.mean([v[name] for v in own], axis=0) for name in ("cof", "draws"))
        return Side(float(cof) * stand.contact_time, draws * stand.contact_time)

    return (
        [(contrast, side(contrast.over), side(contrast.under)) for contrast in sides],
        [(condition, stand, side(stand)) for condition, stand in shoes],
    )


def _effects(
    sides: list[tuple[Contrast, Side, Side]],
) -> tuple[StudyTable, dict[str, ComputedQuantity]]:
    rows: list[dict[str, Any]] = []
    for contrast, over, under in sides:
        reason = over.reason or under.reason
        drawn, ratio = over.draws / under.draws, over.cof / under.cof
        higher = np.mean(drawn > 1) + np.mean(drawn == 1) / 2
        chance = higher if contrast.rises else 1 - higher
        low, high = np.quantile(drawn, (0.025, 0.975))
        slope = (over.cof - under.cof) / contrast.step
        rows.append(
            {
                "source": contrast.source,
                "effect": contrast.effect,
                "fluid": contrast.fluid,
                "about": contrast.topic,
                "published": contrast.published,
                "computed ratio": ratio,
                "low 95 %": low,
                "high 95 %": high,
                "per mm": slope,
                "probability of the sign": np.nan if reason else chance,
                "verdict": "not computed" if reason else verdict(ratio, chance),
            }
        )
    table = StudyTable.of(
        "effects",
        "Published effects: COF of one whole case over that of the other, with joint draws",
        rows,
    )
    known = [row for row in rows if row["verdict"] != "not computed"]
    right: dict[tuple[str, str], list[bool]] = {}
    for row, (contrast, over, under) in zip(rows, sides, strict=True):
        if row in known:
            sign = row["verdict"] != "absent" and (over.cof > under.cof) == contrast.rises
            right.setdefault((contrast.source, contrast.effect), []).append(sign)
    absent = [row for row in known if row["verdict"] == "absent" and NEVER_ABSENT & {row["about"]}]
    return table, {
        "effects.right_sign": ComputedQuantity.of(
            float(np.mean([np.mean(v) for v in right.values()]))
        ),
        "effects.absent": ComputedQuantity.of(len(absent)),
    }


def _whole(
    shoes: list[tuple[PublishedCondition, Stand, Side]],
) -> tuple[StudyTable, dict[str, ComputedQuantity]]:
    rows: list[dict[str, Any]] = []
    for condition, _, side in shoes:
        low, inner_low, inner_high, high = np.quantile(side.draws, (0.025, 0.25, 0.75, 0.975))
        reading = condition.reading
        rows.append(
            {
                "source": condition.source,
                "condition": condition.id,
                "measured": _reading_text(reading),
                "predicted median": side.cof,
                "low 95 %": low,
                "high 95 %": high,
                "inside 50 %": _inside(reading, inner_low, inner_high, side),
                "inside 95 %": _inside(reading, low, high, side),
            }
        )
    title = "Whole shoes: readings against the whole case that stands for them"
    known = [row for row in rows if row["inside 95 %"]]
    return StudyTable.of("whole", title, rows), {
        f"whole.inside_{level}": ComputedQuantity.of(
            float(np.mean([row[f"inside {level} %"] == "yes" for row in known]))
        )
        for level in (50, 95)
    }


def _slips(options: Options) -> tuple[StudyTable, dict[str, ComputedQuantity]]:
    """Return shares of slips of four sources against the slip model."""
    case = Case.from_mapping(HUMAN_SLIPS)
    ((_, arrays),) = cached_arrays(
        CASES, whole_cof, [case], [_key(case)], processes=options.processes
    )
    rows = predict_shares(published_shares(arrays["draws"][::4]))
    title = "Shares of steps that slipped: report's curve, and what the other sources say"
    worst: dict[str, float] = {}
    for row in rows:
        off = abs(float(row["report's curve off by, points"]))
        worst[str(row["source"])] = max(off, worst.get(str(row["source"]), 0.0))
    return StudyTable.of("slips", title, rows), {
        "slips.within": ComputedQuantity.of(sum(off <= POINTS for off in worst.values())),
    }


def _key(case: Case) -> str:
    return content_hash(case.hash, inspect.getsource(pair_contact), draws_hash())


def _basis(
    sides: list[tuple[Contrast, Side, Side]], shoes: list[tuple[PublishedCondition, Stand, Side]]
) -> StudyTable:
    stands = [(c.source, c.id, stand.taken, side.reason) for c, stand, side in shoes]
    stands += [
        (
            contrast.source,
            contrast.effect,
            contrast.over.taken + contrast.under.taken,
            over.reason or under.reason,
        )
        for contrast, over, under in sides
    ]
    rows = [
        (source, name, ", ".join(dict.fromkeys(taken)), reason)
        for source, name, taken, reason in stands
    ]
    title = "What the sources leave open and was taken, and why an effect is not computed"
    columns = ("source", "effect or condition", "taken", "not computed because")
    return StudyTable("basis", title, columns, list(dict.fromkeys(rows)))


def _reading_text(reading: PublishedReading) -> str:
    if not reading.is_censored:
        return f"{reading.low:.3g}"
    words = {"lower": f"at least {reading.low:.3g}", "upper": f"at most {reading.high:.3g}"}
    return words.get(reading.kind, f"{reading.low:.3g} to {reading.high:.3g}")


def _inside(reading: PublishedReading, low: float, high: float, side: Side) -> str:
    if side.reason:
        return ""
    return "yes" if reading.low <= high and reading.high >= low else "no"


def _scores(scores: Mapping[str, tuple[CorpusScore, CorpusScore]]) -> StudyTable:
    return StudyTable.of(
        "scores",
        "Each laboratory predicted from all others, each counts once (log density: sum)",
        [
            {
                "law": name,
                "R2 of ln COF, everybody else": others.r2,
                "rms error of ln COF, everybody else": others.rms_error,
                "bias of ln COF, everybody else": others.bias,
                "inside 50 %, everybody else": others.inside_50,
                "inside 95 %, everybody else": others.inside_95,
                "95 % interval, factor, everybody else": float(np.exp(others.width)),
                "log density, everybody else": others.log_density,
                "R2 of ln COF, all": every.r2,
                "rms error of ln COF, all": every.rms_error,
                "rank correlation within a laboratory": every.rank_correlation,
            }
            for name, (others, every) in scores.items()
        ],
    )


def _where_known(left_out: list[LaboratoryScore]) -> tuple[float, float]:
    """Return the 95 % interval, a factor, of wet readings with roughness of both sides printed.

    And the share of these readings that lies inside it.
    """
    known = [
        (width, inside)
        for score in left_out
        for c, width, inside in zip(
            score.conditions, score.score.width, score.score.inside_95, strict=True
        )
        if not c.members and c.fluid != "dry"
        if not (c.numbers["sole_rq"].is_open or c.numbers["floor_rq"].is_open)
    ]
    width, inside = np.mean(known, axis=0)
    return float(np.exp(width)), float(inside)


def _sources(
    left_out: list[LaboratoryScore], priors: list[LaboratoryScore]
) -> tuple[StudyTable, float]:
    """Return the table of sources and the highest R2 that the priors alone have on one."""
    rows: list[dict[str, Any]] = []
    for score, prior in zip(left_out, priors, strict=True):
        for source in dict.fromkeys(c.source for c in score.conditions):
            at = [i for i, c in enumerate(score.conditions) if c.source == source]
            measured = middle([score.conditions[i] for i in at])
            few = np.isfinite(measured).sum() < FEWEST_VALUES
            own, alone = (
                np.nan if few else r2(measured, np.median(x.draws, axis=0)[at], np.ones(len(at)))
                for x in (score, prior)
            )
            rows.append(
                {
                    "source": source,
                    "laboratory": score.laboratory,
                    "readings": float(len(at)),
                    "measured / predicted": np.exp(score.score.error[at].mean()),
                    "inside 50 %": score.score.inside_50[at].mean(),
                    "inside 95 %": score.score.inside_95[at].mean(),
                    "R2 about its own mean": own,
                    "R2 of the priors alone": alone,
                }
            )
    title = "The law of the pair, source by source: measured over predicted, readings inside"
    return StudyTable.of("sources", title, rows), float(
        np.nanmax([row["R2 of the priors alone"] for row in rows])
    )


def _after(left_out: list[LaboratoryScore]) -> tuple[StudyTable, dict[str, ComputedQuantity]]:
    """Return what one reading of a source says of the rest of it; each source counts once."""
    found: dict[str, list[tuple[float, ...]]] = {}
    for score in left_out:
        before = np.median(score.draws, axis=0)
        measured = middle(score.conditions)
        for i, j, median, low, high in score.after:
            row = (measured[int(j)], before[int(j)], measured[int(i)], median, low, high)
            found.setdefault(score.conditions[int(j)].source, []).append(row)
    rows, every, weight = [], [], []
    for source, values in found.items():
        y, before, known, median, low, high = np.array(values).T
        every += values
        weight += [1 / len(values)] * len(values)
        rows.append(
            {
                "source": source,
                "pairs of readings": float(len(values)),
                "rms of ln COF, before": np.sqrt(np.mean((y - before) ** 2)),
                "after": np.sqrt(np.mean((y - median) ** 2)),
                "the same as the reading": np.sqrt(np.mean((y - known) ** 2)),
                "inside 95 %": np.mean((low <= y) & (y <= high)),
                "95 % interval, factor": np.exp(np.mean(high - low)),
            }
        )
    y, _, _, median, low, high = np.array(every).T
    weights = np.array(weight)
    inside = float(np.average((low <= y) & (y <= high), weights=weights))
    return StudyTable.of(
        "after", "The rest of a source, once one of its readings is known", rows
    ), {
        "after.r2": ComputedQuantity.of(r2(y, median, weights)),
        "after.inside_95": ComputedQuantity.of(inside),
    }


def _constants(posterior: PairPosterior) -> StudyTable:
    names = ("tester", "pair", "reading", "dry part of a tester")
    every = [
        *zip(posterior.law.parameters, posterior.theta.T, strict=True),
        *zip((f"sd of ln COF, {name}" for name in names), posterior.spreads.T, strict=True),
    ]
    rows = []
    for name, draws in every:
        low, median, high = np.quantile(draws, (0.025, 0.5, 0.975))
        if name.startswith("ln "):
            name, (low, median, high) = name[3:], np.exp((low, median, high))
        rows.append({"constant": name, "median": median, "low 95 %": low, "high 95 %": high})
    title = "Constants of the law of the pair from all sources: calibrated, measurements of no pair"
    return StudyTable.of("constants", title, rows)


def _figure(left_out: list[LaboratoryScore]) -> Figure:
    values = [
        (c.reading.low, *np.exp(np.quantile(draws, (0.025, 0.5, 0.975))))
        for score in left_out
        for c, draws in zip(score.conditions, score.draws.T, strict=True)
        if not c.reading.is_censored
    ]
    measured, low, median, high = np.array(values).T
    layers = (
        line((0.03, 1.2), (0.03, 1.2), "equal", colour=PRINTED),
        points(measured, median, "median and 95 % interval", low=low, high=high, marker="o"),
    )
    panel = Panel(
        layers,
        x_label="measured COF",
        y_label="predicted from the other laboratories",
        x_scale="log",
        y_scale="log",
        x_limits=(0.04, 1.1),
        y_limits=(0.02, 2.0),
    )
    return Figure([panel], "Readings predicted from all other laboratories", size=(5.6, 4.6))
