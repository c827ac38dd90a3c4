"""Tidy tables for other software: one row a step, one row a number, mean curves over stance."""

from collections.abc import Iterable

import numpy as np

from ..gait_context import PERCENT
from .conditions import NUMBERS, person_condition
from .file_result import FileResult
from .tables import Cell, Table

# Numbers of a step with their SI unit, in the order of the tables.
STEP_NUMBERS = {
    "rcof": "1", "rcof_uncertainty": "1", "peak_slipping_speed": "m/s", "slip_start": "s",
    "slip_distance": "m", "toe_slip": "m", "trailing_slip": "m", "contact": "s", "toe_off": "s",
    "stance_time": "s", "peak_force": "N", "walking_speed": "m/s", "step_length": "m",
    "step_time": "s", "cadence": "1/s", "foot_angle": "rad", "heel_speed": "m/s",
}  # fmt: skip
_TEXTS = ("plate", "side", "verdict", "reason", "outcome", "slip_direction", "recovery_or_fall")
_CURVES = ("vertical", "braking", "to the left", "ratio")


def step_tables(files: Iterable[FileResult]) -> list[Table]:
    """Return one row a step (``steps_wide``) and one row a number (``steps_long``).

    Conditions stand beside. Refused files and rejected steps are in both, with their verdict.
    """
    files = [one for one in files if one.steps]
    if not files:
        return []
    noted = list(dict.fromkeys(name for one in files for name in one.conditions))
    wide: list[tuple[Cell, ...]] = []
    long: list[tuple[Cell, ...]] = []
    for one in files:
        own = [one.conditions.get(name) for name in noted]
        for step in one.steps:
            head = (one.file, one.verdict, *own, step["number"])
            texts = [step.get(name) or "" for name in _TEXTS]
            cautions = "; ".join(step["cautions"])
            wide.append((*head, *texts, cautions, *(step.get(name) for name in STEP_NUMBERS)))
            long += [
                (*head, step["side"], step["verdict"], name, step[name], unit)
                for name, unit in STEP_NUMBERS.items()
                if step.get(name) is not None
            ]
    first = ("file", "file verdict", *noted, "step")
    units = [f"{n} ({u})" if u != "1" else n for n, u in STEP_NUMBERS.items()]
    columns = (*first, *_TEXTS, "cautions", *units)
    tidy = (*first, "side", "step verdict", "quantity", "value", "unit")
    return [
        Table("steps_wide", "Every step with its numbers", columns, tuple(wide)),
        Table("steps_long", "Every number of every step", tidy, tuple(long)),
    ]


def curve_table(files: Iterable[FileResult]) -> Table | None:
    """Return mean and SD of the forces over 0 to 100 % of stance, by condition, or None.

    The steps of a person (of a file, where no person is named) are averaged first; SD is that
    between persons.
    """
    files = [one for one in files if one.usable and one.curves.get("normalised")]
    if not files:
        return None
    person = person_condition(files)
    keys = [
        name
        for name in dict.fromkeys(name for one in files for name in one.conditions)
        if name != person
        and name not in NUMBERS
        and 1 < len({str(one.conditions.get(name)) for one in files}) < len(files)
        and all(isinstance(one.conditions.get(name, ""), str) for one in files)
    ]
    groups: dict[tuple[str, ...], dict[str, list[np.ndarray]]] = {}
    for one in files:
        key = tuple(str(one.conditions.get(name, "")) for name in keys)
        who = str(one.conditions.get(person, one.file))
        for curve in one.curves["normalised"]:
            values = np.array([curve[name] for name in _CURVES], dtype=float)  # None gives NaN
            groups.setdefault(key, {}).setdefault(who, []).append(values)
    rows: list[tuple[Cell, ...]] = []
    for key, people in groups.items():
        means = np.array([np.mean(curves, axis=0) for curves in people.values()])
        mean = means.mean(axis=0)
        spread = means.std(axis=0, ddof=1) if len(means) > 1 else np.full_like(mean, np.nan)
        pairs = np.stack((mean, spread), axis=1).reshape(-1, len(PERCENT)).T.tolist()
        rows += [
            (*key, int(percent), len(people), *(v if np.isfinite(v) else None for v in own))
            for percent, own in zip(PERCENT, pairs, strict=True)
        ]
    names = [f"{n} (N)" if n != "ratio" else n for n in _CURVES]
    both = [column for name in names for column in (f"mean {name}", f"SD {name}")]
    columns = (*keys, "percent of stance", "persons" if person else "files", *both)
    return Table("stance_curves", "Forces over stance", columns, tuple(rows))
