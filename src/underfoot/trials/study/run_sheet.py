"""The plan of a test: every combination of its conditions in a random order, as a run sheet."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from underfoot.core import InputError
from underfoot.core.remark import Message

from ..readers import trial_suffixes

REPEAT = "repeat"
MOST_RUNS = 10_000
OWN = ("run", "file", REPEAT, "done", "remarks")
"""Columns of the sheet that are no conditions."""


@dataclass(frozen=True, slots=True)
class RunSheet:
    """Runs in the order in which they are to be done; ``seed`` gives the same order again.

    ``runs`` hold the level of each factor; ``blocks`` says what is complete before the next begins.
    """

    factors: Mapping[str, tuple[str, ...]]
    repeats: int
    runs: tuple[Mapping[str, str], ...]
    blocks: str
    seed: int

    def csv_text(self, suffix: str = ".csv") -> str:
        """Return the sheet as CSV: ``conditions.csv`` of the analysis once the files are there."""
        stream = io.StringIO()
        table = csv.writer(stream, lineterminator="\n")
        table.writerow(("run", "file", *self.factors, REPEAT, "done", "remarks"))
        digits = len(str(len(self.runs)))
        for number, run in enumerate(self.runs, start=1):
            file = f"run_{number:0{digits}d}{suffix}"
            table.writerow((number, file, *(run[key] for key in (*self.factors, REPEAT)), "", ""))
        return stream.getvalue()


def run_sheet(
    factors: Mapping[str, Sequence[str]],
    *,
    repeats: int = 1,
    blocks: str = REPEAT,
    together: str = "",
    seed: int = 0,
) -> RunSheet:
    """Return every combination of the factors, ``repeats`` times, in a random order.

    Parameters:
        factors: Levels of each condition, as {"shoe": ("A", "B"), "fluid": ("dry", "water")}.
        repeats: Of each combination.
        blocks: Condition whose levels are done one after the other, each with all that belongs to
            it ("subject" for persons, "repeat" by default: a drift of the tester falls on all
            conditions alike); their order is random too, that of the repeats is not.
        together: Condition that costs time to change: within a block its levels come in a random
            order, all runs of one level after each other. What is compared over it then has as
            many independent runs as there are blocks.
        seed: Of the order.

    Raises:
        InputError: A factor without two levels, a level twice, more than 10 000 runs, a block or
            condition that is no factor.
    """
    for name, levels in factors.items():
        if name.casefold() in OWN:
            raise InputError(f'"{name}" is a column of the sheet', where="factors")
        if len(levels) < 2 or len(set(levels)) < len(levels):
            raise InputError(
                Message("{name}: {error}", name=name, error=", ".join(levels) or "no level"),
                where="factors",
                allowed="two levels or more, each once, as shoe=A,B",
            )
    for given, where in ((blocks, "block"), (together, "together")):
        if given and given not in (*factors, REPEAT):
            raise InputError(f'"{given}"', where=where, allowed=", ".join((*factors, REPEAT)))
    if not factors or repeats < 1:
        raise InputError(
            f"{len(factors)} factors, {repeats} repeats", where="plan", allowed="1 or more of each"
        )
    count = repeats * int(np.prod([len(levels) for levels in factors.values()], dtype=float))
    if count > MOST_RUNS:
        raise InputError(
            Message("{count} runs", count=count),
            where="plan",
            allowed=Message("up to {most}", most=MOST_RUNS),
        )
    levels_of = {name: tuple(levels) for name, levels in factors.items()}
    every = {**levels_of, REPEAT: tuple(str(n + 1) for n in range(repeats))}
    runs = [dict(zip(every, one, strict=True)) for one in product(*every.values())]
    generator = np.random.default_rng(seed)
    order = {
        key: {level: int(place) for level, place in zip(
            levels,
            range(len(levels)) if key == REPEAT else generator.permutation(len(levels)),
            strict=True,
        )}
        for key, levels in every.items()
    }  # fmt: skip
    within = {
        (block, level): float(place)
        for block in every[blocks]
        for level, place in zip(
            every[together] if together else ("",),
            generator.permutation(len(every[together]) if together else 1),
            strict=True,
        )
    }
    keys = [
        (
            order[blocks][run[blocks]],
            within[run[blocks], run[together] if together else ""],
            float(generator.random()),
        )
        for run in runs
    ]
    ordered = [run for _, run in sorted(zip(keys, runs, strict=True), key=lambda pair: pair[0])]
    return RunSheet(levels_of, repeats, tuple(ordered), blocks, seed)


def factors_from(texts: Sequence[str]) -> dict[str, tuple[str, ...]]:
    """Return the factors of texts as "shoe=A,B".

    Raises:
        InputError: A text without a name and levels, or a name twice.
    """
    found: dict[str, tuple[str, ...]] = {}
    for text in texts:
        name, equals, levels = text.partition("=")
        name = name.strip()
        if not equals or not name or name in found:
            raise InputError(f'"{text}"', where="factors", allowed='each once, as "shoe=A,B"')
        found[name] = tuple(level.strip() for level in levels.split(",") if level.strip())
    return found


def checked_suffix(suffix: str) -> str:
    """Return the ending of the files to be recorded, with its dot.

    Raises:
        InputError: An ending that is not read.
    """
    ending = f".{suffix.strip().lstrip('.').casefold()}"
    known = trial_suffixes()
    if ending not in known:
        raise InputError(f'"{suffix}"', where="--suffix", allowed=", ".join(known))
    return ending
