"""Contact friction of pairs on everybody's measurements: each source predicted from all others."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from underfoot.calibrate.corpus import Condition, corpus
from underfoot.calibrate.pair_law import (
    LAWS,
    CorpusScore,
    PairPosterior,
    SourceScore,
    corpus_score,
    fitted,
    law_named,
    scored,
    source_left_out,
)
from underfoot.core import content_hash

from .figure import PRINTED, Figure, Panel, line, points
from .runner import Computed, Options, Table, kept, part
from .verdict import Quantity

STEPS, QUICK_STEPS = 600, 150
"""Of the sampler's walkers."""
LAW = "pair"
QUICK_LAWS = ("one constant", LAW)


@dataclass(frozen=True, slots=True)
class Split:
    """A law and the source that is left out of its fit."""

    law: str
    source: str
    steps: int


def draws_of(split: Split) -> Mapping[str, Any]:
    """Return the draws of ln COF of the source that is left out."""
    left = source_left_out(law_named(split.law), readings(), split.source, steps=split.steps)
    return {"draws": left.draws}


def readings() -> list[Condition]:
    """Return every condition with a reading of the verified sources."""
    return [c for source in corpus() if source.verified for c in source.conditions]


def compute(options: Options) -> Computed:
    """Return the score of each law, the prediction of each reading and the constants."""
    conditions = readings()
    sources = list(dict.fromkeys(c.source for c in conditions))
    steps = QUICK_STEPS if options.quick else STEPS
    names = QUICK_LAWS if options.quick else tuple(law.name for law in LAWS)
    splits = [Split(name, source, steps) for name in names for source in sources]
    content = content_hash([repr(c) for c in conditions])
    keys = [content_hash(asdict(split), content, options.seed) for split in splits]
    results: dict[tuple[str, str], SourceScore] = {}
    fits = part(options.progress, 0.0, 0.9)
    work = kept("corpus-1", draws_of, splits, keys, processes=options.processes)
    for number, (split, arrays) in enumerate(work, start=1):
        fits("leaving one source out", number / len(splits))
        own = tuple(c for c in conditions if c.source == split.source)
        results[split.law, split.source] = SourceScore(
            split.source, own, arrays["draws"], scored(arrays["draws"], own)
        )
    scores = [corpus_score(name, [results[name, source] for source in sources]) for name in names]
    posterior = fitted(law_named(LAW), conditions, steps=steps, seed=options.seed)
    own = [results[LAW, source] for source in sources]
    best = scores[-1]
    return Computed(
        {
            **{
                f"pair.{name}": Quantity.of(getattr(best, name))
                for name in ("r2", "inside_50", "inside_95", "rank_correlation")
            },
            "pair.gain": Quantity.of(best.log_density - scores[0].log_density),
        },
        (_scores(scores), _sources(own), _constants(posterior)),
        {"predicted": _figure(own)},
        (
            f"Contact friction of a source that was not used: R2 of ln COF {best.r2:.2f}, "
            f"{best.inside_95:.0%} of the readings inside the 95 % interval, "
            f"{best.inside_50:.0%} inside the 50 % one, over {len(sources)} sources and "
            f"{len(conditions)} readings.",
            "The error between laboratories is the largest part of the interval: a pair that "
            "nobody measured is known to a factor of two to three either way.",
        ),
    )


def _scores(scores: list[CorpusScore]) -> Table:
    return Table.of(
        "scores",
        "Each source predicted from all others, means over sources (log density: sum)",
        [
            {
                "law": s.law,
                "log density": s.log_density,
                "R2 of ln COF": s.r2,
                "rms error of ln COF": s.rms_error,
                "bias of ln COF": s.bias,
                "inside 50 %": s.inside_50,
                "inside 95 %": s.inside_95,
                "rank correlation within a source": s.rank_correlation,
            }
            for s in scores
        ],
    )


def _sources(left_out: list[SourceScore]) -> Table:
    return Table.of(
        "sources",
        "The law of the pair, source by source: measured over predicted, readings inside",
        [
            {
                "source": one.source,
                "readings": float(len(one.conditions)),
                "measured / predicted": np.exp(one.score.error.mean()),
                "inside 50 %": one.score.inside_50.mean(),
                "inside 95 %": one.score.inside_95.mean(),
            }
            for one in left_out
        ],
    )


def _constants(posterior: PairPosterior) -> Table:
    names = ("source", "pair", "reading", "dry part of a source")
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
    return Table.of("constants", title, rows)


def _figure(left_out: list[SourceScore]) -> Figure:
    values = [
        (c.reading.low, *np.exp(np.quantile(draws, (0.025, 0.5, 0.975))))
        for one in left_out
        for c, draws in zip(one.conditions, one.draws.T, strict=True)
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
        y_label="predicted from the other sources",
        x_scale="log",
        y_scale="log",
        x_limits=(0.05, 1.0),
        y_limits=(0.02, 2.0),
    )
    return Figure([panel], "Readings predicted from all other sources", size=(5.6, 4.6))
