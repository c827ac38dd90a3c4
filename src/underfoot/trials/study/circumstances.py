"""How fast and when in a session each condition was walked: what goes with it and is not it."""

import re
from collections.abc import Mapping, Sequence

import numpy as np

from underfoot.core import DataError

from ..statistics import ROUNDING, mixed_model, person_means
from .condition_table import ORDERS
from .file_result import FileResult
from .tables import Cell, TrialColumn, TrialTable, group_files, mean_and_interval, plain_columns

_SURE, _SPEED, _SHARE = 0.01, 0.05, 0.25
"""p below which, relative difference of speed from which, and share of the variance of the places
in the session from which a condition goes with it; assumed."""


def walking_speed(result: FileResult) -> float | None:
    """Return the mean speed (m/s) of the steps of a file that count, or None."""
    speeds = [
        step.walking_speed
        for step in result.steps
        if step.rcof is not None and step.walking_speed is not None
    ]
    return float(np.mean(speeds)) if speeds else None


def places_in_session(files: Sequence[FileResult], person: str) -> dict[str, float]:
    """Return the place of each file among those of its person: 0 the first, 1 the last.

    By a column that numbers a person's trials through (trial, run, order), else by the number at
    the end of file names; nobody's where numbers repeat.
    """
    places: dict[str, float] = {}
    for results in group_files(files, (person,)).values():
        for key in (*ORDERS, ""):
            numbers = [_number(result, key) for result in results]
            known = [number for number in numbers if number is not None]
            if len(results) < 3 or len(known) < len(results) or len(set(known)) < len(results):
                continue
            ranks = np.argsort(np.argsort(known)) / (len(results) - 1.0)
            places |= {
                result.file: float(rank) for result, rank in zip(results, ranks, strict=True)
            }
            break
    return places


def run_numbers(files: Sequence[FileResult]) -> dict[str, float]:
    """Return the place of each file in the order of runs: by a column, else by its name."""
    for key in (*ORDERS, ""):
        numbers = [_number(file, key) for file in files]
        known = [number for number in numbers if number is not None]
        if len(known) == len(files) == len(set(known)):
            return {file.file: number for file, number in zip(files, known, strict=True)}
    names = sorted(file.file for file in files)
    return {file.file: float(names.index(file.file)) for file in files}


def _number(result: FileResult, key: str) -> float | None:
    text = str(result.conditions.get(key, "")) if key else result.file.rsplit(".", 1)[0]
    match = re.search(r"(\d+)(\.0+)?$", text)
    return float(match[1]) if match else None


def circumstances(
    files: Sequence[FileResult], person: str
) -> dict[str, tuple[list[FileResult], list[float]]]:
    """Return the files and their numbers for "speed" (m/s) and "place" in the session (0 to 1)."""
    speeds = [(file, walking_speed(file)) for file in files]
    places = places_in_session(files, person) if person else {}
    both = {
        "speed": [(result, speed) for result, speed in speeds if speed is not None],
        "place": [(file, places[file.file]) for file in files if file.file in places],
    }
    return {
        name: ([result for result, _ in pairs], [value for _, value in pairs])
        for name, pairs in both.items()
        if len(pairs) > 1
    }


def circumstance_table(
    files: Sequence[FileResult], keys: Sequence[str], person: str
) -> TrialTable | None:
    """Return speed and place in the session by level of each condition, persons as units."""
    found = circumstances(files, person)
    if not found or not keys:
        return None
    levels = dict.fromkeys(
        (key, str(file.conditions[key])) for key in keys for file in files if key in file.conditions
    )
    rows: list[tuple[Cell, ...]] = []
    for key, level in levels:
        cells: list[Cell] = [key, level]
        for name in ("speed", "place"):
            own: dict[str, list[float]] = {}
            for result, value in zip(*found.get(name, ([], [])), strict=True):
                if str(result.conditions.get(key)) == level:
                    own.setdefault(str(result.conditions.get(person, result.file)), []).append(
                        value
                    )
            means = [float(np.mean(values)) for values in own.values()]
            cells += mean_and_interval(means, name)[:2] if name == "speed" else [
                100.0 * float(np.mean(means)) if means else None
            ]  # fmt: skip
        rows.append(tuple(cells))
    heads = (
        *(TrialColumn(name, always=True) for name in ("condition", "level")),
        *plain_columns("walking speed (m/s)", "SD", decimals=2),
        *plain_columns("mean place in the session (%)", decimals=0),
    )
    note = (
        "A condition that was walked faster or slower, or always early or late, can't be told from "
        "speed, habit or fatigue. Place: 0 % the first trial of a person, 100 % the last."
    )
    title = "Speed and order by condition"
    return TrialTable.of("speed_and_order", title, heads, rows, note).without_empty()


def gone_with(files: Sequence[FileResult], key: str, person: str) -> dict[str, Mapping[str, float]]:
    """Return the mean speed or place of each level where a condition goes with it.

    Speed: levels differ by 5 % and more, at p below 0.01 with persons as units. Place: levels
    explain a quarter and more of it, at p below 0.01.
    """
    from scipy.stats import f_oneway

    told: dict[str, Mapping[str, float]] = {}
    for name, (having, values) in circumstances(files, person).items():
        rows = [
            (str(result.conditions[key]), str(result.conditions.get(person, result.file)), value)
            for result, value in zip(having, values, strict=True)
            if key in result.conditions
        ]
        levels = list(dict.fromkeys(level for level, _, _ in rows))
        if not 1 < len(levels) < len(rows):
            continue
        column, who, numbers = (list(one) for one in zip(*rows, strict=True))
        own = person_means(numbers, {key: column}, who)
        of = np.array(own.factors[key])
        groups = [own.mean[of == level] for level in levels]
        means = {level: float(np.mean(group)) for level, group in zip(levels, groups, strict=True)}
        if np.ptp(list(means.values())) <= ROUNDING * max(map(abs, means.values())):
            continue
        try:
            if name == "speed":
                (test,) = mixed_model(numbers, {key: column}, who).tests
                apart = max(means.values()) / min(means.values()) - 1.0 >= _SPEED
                p = test.p
            else:
                if len(own.mean) - len(levels) < 3:
                    continue
                spread = sum(len(group) * (group.mean() - own.mean.mean()) ** 2 for group in groups)
                apart = spread >= _SHARE * float(((own.mean - own.mean.mean()) ** 2).sum())
                # the same order in all: no scatter, and F is infinite
                p = float(np.nan_to_num(f_oneway(*groups).pvalue))
        except DataError:
            continue
        if apart and p is not None and p < _SURE:
            told[name] = means
    return told
