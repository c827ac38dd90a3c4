"""Plain tables and findings: what ends in CSV, spreadsheet and page."""

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum
from typing import Self

import numpy as np

from underfoot.core import UnderfootError
from underfoot.core.remark import Message, join_lines

from .. import statistics
from ..recording.measurement import MEAN_OF_STEPS
from ..walking.gait_context import PERCENT
from .condition_table import NUMBERS
from .conditions import person_condition
from .file_result import FileResult

Cell = str | float | int | None


class Role(StrEnum):
    """What the cells of a column are; a page shows some in a way of their own."""

    PLAIN = "plain"
    CONDITION = "condition"
    """What a laboratory noted."""
    COUNT = "count"
    """How many persons, trials or steps a mean is of."""
    MEAN = "mean"
    SD = "standard deviation"
    LOW = "low end"
    HIGH = "high end"
    CHANCE = "p"
    ANSWER = "answer"
    """1 for yes, 0 for no."""
    LONG = "long text"
    """Stands below its row, over the whole width of a page."""


@dataclass(frozen=True, slots=True)
class TrialColumn:
    """A column of a table: heading, what its cells are, and of which quantity.

    ``decimals``: those that a reader should see, None for as many as the value needs; files keep
    all. ``always``: it stands even where it is empty.
    """

    name: str
    role: Role = Role.PLAIN
    quantity: str = ""
    decimals: int | None = None
    always: bool = False


P_VALUE = TrialColumn("p", Role.CHANCE)
HOLM_P = TrialColumn("p (Holm)", Role.CHANCE)


def plain_columns(*names: str, decimals: int | None = None) -> tuple[TrialColumn, ...]:
    """Return plain columns that share their decimals."""
    return tuple(TrialColumn(name, decimals=decimals) for name in names)


def condition_columns(names: Iterable[str]) -> tuple[TrialColumn, ...]:
    """Return the columns of conditions."""
    return tuple(TrialColumn(name, Role.CONDITION, always=True) for name in names)


@dataclass(frozen=True, slots=True)
class TrialTable:
    """Rows under columns; ``notes`` stand below. ``name`` is a file name without ending."""

    name: str
    title: str
    heads: tuple[TrialColumn, ...]
    rows: tuple[tuple[Cell, ...], ...]
    notes: tuple[str, ...] = ()

    @classmethod
    def of(
        cls,
        name: str,
        title: str,
        heads: Iterable[TrialColumn | str],
        rows: Iterable[Iterable[Cell]],
        *notes: str,
    ) -> Self:
        """Return the table; a heading alone stands for a plain column."""
        columns = (head if isinstance(head, TrialColumn) else TrialColumn(head) for head in heads)
        return cls(name, title, tuple(columns), tuple(map(tuple, rows)), notes)

    @property
    def columns(self) -> tuple[str, ...]:
        """Headings; a condition that is called like another column says that it is a condition."""
        others = {head.name for head in self.heads if head.role is not Role.CONDITION}
        return tuple(
            f"{head.name} (condition)"
            if head.role is Role.CONDITION and head.name in others
            else head.name
            for head in self.heads
        )

    def filled_columns(self) -> list[int]:
        """Return the numbers of the columns with content."""
        cells = range(len(self.heads))
        return [i for i in cells if any(row[i] not in (None, "") for row in self.rows)]

    def without_empty(self) -> Self:
        """Return the table without the columns that have no content and need not stand."""
        filled = self.filled_columns()
        return self.only([i for i, h in enumerate(self.heads) if h.always or i in filled])

    def only(self, keep: Collection[int]) -> Self:
        """Return the table with the columns of these numbers alone."""
        rows = tuple(tuple(row[i] for i in keep) for row in self.rows)
        return replace(self, heads=tuple(self.heads[i] for i in keep), rows=rows)


@dataclass(frozen=True, slots=True)
class Finding:
    """One test: what was asked, the table, and cautions.

    Comparisons after Tukey name ``response`` and ``factor``; ``marks`` are the letters by level,
    ``values`` the means of the persons (``by_person``, else single values) by level. ``outcome``:
    what was measured, where the p of the table are those that this outcome stands on. ``files``:
    text by the name of a file from which other programs find the test again.
    """

    name: str
    title: str
    table: TrialTable
    cautions: tuple[Message, ...] = ()
    response: str = ""
    factor: str = ""
    marks: Mapping[str, str] = field(default_factory=dict)
    values: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    files: Mapping[str, str] = field(default_factory=dict)
    outcome: str = ""
    by_person: bool = False

    @classmethod
    def of_anova(
        cls, anova: statistics.AnovaTable, cautions: tuple[Message, ...] = (), *, outcome: str = ""
    ) -> Self:
        """Return an analysis of variance as a finding."""
        rows = tuple((r.term, r.sum_of_squares, r.df, r.f, r.p) for r in anova.rows)
        plain = "".join(c if c.isalnum() else "_" for c in anova.model.response_name.casefold())
        name = f"anova_{plain}_type_{anova.ss_type}"
        table = TrialTable.of(
            name, anova.title, ("term", "sum of squares", "df", "F", P_VALUE), rows
        )
        return cls(name, anova.title, table, (*cautions, *anova.warnings), outcome=outcome)


def finding(
    name: str,
    title: str,
    heads: Iterable[TrialColumn | str],
    rows: Iterable[Iterable[Cell]],
    note: str = "",
    cautions: Sequence[Message] = (),
) -> Finding:
    """Return a finding from the rows of its table."""
    table = TrialTable.of(name, title, heads, rows, *filter(None, [note]))
    return Finding(name, title, table, tuple(cautions))


def not_done(name: str, title: str, error: UnderfootError) -> Finding:
    """Return the finding of a test that could not be done, with the reason."""
    return finding(name, title, ("not done",), ((error.what,),))


# Names that are not the key in words, units shown, and what an SI value is multiplied by for one.
_NAMES = {
    "rcof": "RCOF", "acof": "ACOF", "acof_minus_rcof": "ACOF - RCOF", "cof": "COF", "ptv": "PTV",
    "cof_bl": "COF_BL", "tau_hydro": "tau_hydro", "cof_asymptote": "COF_asymptote",
    "crossed_array": "heel crossed the array", "scan_peak_pressure": "peak pressure of the scan",
    "force_2_percent": "force at 2 %",
}  # fmt: skip
_UNITS = {
    "angle": "deg", "tau_hydro": "m/s", "peak_slipping_speed": "m/s", "slip_margin": "m/s",
    "speed": "m/s", "slip_distance": "mm", "peak_pressure": "kPa", "scan_peak_pressure": "kPa",
    "friction_force": "N", "force_2_percent": "N", "peak_force": "N", "final_force": "N",
    **{f"{time}-time stiffness": "N/mm" for time in ("short", "long")},
    **{f"{time}-time {of}modulus": "MPa" for time in ("short", "long") for of in ("", "Young's ")},
}  # fmt: skip
_ANSWERS = frozenset({"slip", "crossed_array"})
_FACTORS = {"mm": 1e3, "kPa": 1e-3, "N/mm": 1e-3, "MPa": 1e-6}


def quantity_name(name: str) -> str:
    """Return a quantity's name as people write it."""
    return _NAMES.get(name, name.replace("_", " "))


def shown_unit(name: str) -> str:
    """Return the unit that people read a quantity in; "" for a ratio."""
    return _UNITS.get(name, "")


def heading(name: str, what: str = "") -> str:
    """Return a column heading of a quantity (its mean, or ``what`` of it) with its unit."""
    tail = f" ({_UNITS[name]})" if name in _UNITS else ""
    quantity = quantity_name(name)
    if not what:
        return quantity + tail
    return Message("{quantity} {what}{tail}", quantity=quantity, what=what, tail=tail)


def scale_to_heading(name: str, value: float | None) -> float | None:
    """Return an SI value in the unit of its heading."""
    return None if value is None else value * _FACTORS.get(_UNITS.get(name, ""), 1.0)


def group_files(
    files: Iterable[FileResult], keys: Sequence[str]
) -> dict[tuple[str, ...], list[FileResult]]:
    """Return the files that have all the conditions ``keys``, by their levels."""
    groups: dict[tuple[str, ...], list[FileResult]] = {}
    for file in files:
        if all(key in file.conditions for key in keys):
            groups.setdefault(tuple(str(file.conditions[key]) for key in keys), []).append(file)
    return in_order(groups)


def in_order(
    groups: Mapping[tuple[str, ...], list[FileResult]],
) -> dict[tuple[str, ...], list[FileResult]]:
    """Return groups by their levels; where no levels have an order of value, as they come."""
    columns = [*zip(*groups, strict=True)]
    levels = [statistics.ordered_levels(column) for column in columns]
    if all(own == tuple(dict.fromkeys(of)) for own, of in zip(levels, columns, strict=True)):
        return dict(groups)
    places = [{level: i for i, level in enumerate(own)} for own in levels]

    def place(key: tuple[str, ...]) -> list[int]:
        return [known[level] for known, level in zip(places, key, strict=True)]

    return {key: groups[key] for key in sorted(groups, key=place)}


def file_table(files: Sequence[FileResult]) -> TrialTable:
    """Return one row per file: verdict, main numbers, conditions, reasons."""
    numbers = list(dict.fromkeys(name for file in files for name in file.main))
    # A number that the analysis took over from the conditions is shown once.
    conditions = [
        name
        for name in dict.fromkeys(name for file in files for name in file.conditions)
        if any(f.main.get(name, level) != level for f in files if (level := f.conditions.get(name)))
        or name not in numbers
    ]
    rows = tuple(
        (
            file.file,
            file.verdict,
            *(scale_to_heading(name, file.main.get(name)) for name in numbers),
            *(file.conditions.get(name) for name in conditions),
            join_lines(file.reasons),
        )
        for file in files
    )
    measured = (
        TrialColumn(heading(name), Role.ANSWER if name in _ANSWERS else Role.PLAIN)
        for name in numbers
    )
    reasons = TrialColumn("reasons", Role.LONG)
    heads = ("file", "verdict", *measured, *condition_columns(conditions), reasons)
    return TrialTable.of("files", "Every file with its verdict", heads, rows)


def measurement_table(files: Sequence[FileResult]) -> TrialTable:
    """Return one row per number with uncertainty, reason, flags and conventions."""
    person = person_condition(files)
    rows = tuple(
        (
            file.file,
            str(file.conditions.get(person, "")),
            *(m.item, m.name, m.value, m.unit, m.uncertainty, m.reason, m.n),
            "yes" if m.caution_flags else "",
            join_lines(flag.message for flag in m.flags),
            "; ".join(f"{key}: {value}" for key, value in m.conventions.items()),
        )
        for file in files
        for m in file.measurements
    )
    heads = (
        "file", "person", "item", "quantity", "value", "unit", "standard uncertainty",
        "not estimated because", "n", "caution", TrialColumn("flags", Role.LONG), "conventions",
    )  # fmt: skip
    return TrialTable.of("measurements", "Every number with its conventions", heads, rows)


def edit_table(files: Iterable[FileResult]) -> TrialTable | None:
    """Return the edit log: every edit by hand with event and number before and after, or None."""
    edits = [(result.file, edit) for result in files for edit in result.edits]
    if not edits:
        return None
    rows = tuple(
        (
            file,
            e.step,
            e.what,
            e.before,
            e.after,
            e.quantity,
            e.number_before,
            e.number_after,
            e.why,
        )
        for file, e in edits
    )  # fmt: skip
    heads = (
        "file", "step", "what", "before", "after", "quantity", "number before", "number after",
        "why",
    )  # fmt: skip
    return TrialTable.of("edits", "Edits by hand", heads, rows)


_STEP_COLUMNS = {
    "item": TrialColumn("step", always=True), "side": TrialColumn("side"),
    "contact": TrialColumn("contact (s)", decimals=3),
    "rcof": TrialColumn("RCOF", decimals=3, always=True),
    "rcof_uncertainty": TrialColumn("RCOF standard uncertainty", decimals=3),
    "walking_speed": TrialColumn("walking speed (m/s)", decimals=2), "outcome": TrialColumn("slip"),
    "verdict": TrialColumn("verdict", always=True),
    "reason": TrialColumn("reason", Role.LONG, always=True),
    "cautions": TrialColumn("cautions", Role.LONG, always=True), "by_hand": TrialColumn("by hand"),
}  # fmt: skip
"""Columns of the table of steps by the field of a step."""


def steps_table(files: Iterable[FileResult]) -> TrialTable:
    """Return one row for each contact with a plate, rejected ones with the reason."""
    rows = []
    for file in files:
        for step in file.steps:
            values = [getattr(step, name) for name in _STEP_COLUMNS]
            texts = [join_lines(v) if isinstance(v, tuple) else v for v in values]
            rows.append((file.file, *texts))
    heads = (TrialColumn("file", always=True), *_STEP_COLUMNS.values())
    note = "All that is known of a step is in tables/steps_wide.csv and steps_long.csv."
    title = "Every contact, rejected ones with the reason"
    return TrialTable.of("steps", title, heads, rows, note).without_empty()


def condition_table(
    files: Iterable[FileResult],
    keys: tuple[str, ...],
    numbers: tuple[str, ...],
    *,
    person: str = "",
    name: str = "conditions",
) -> TrialTable | None:
    """Return mean, SD and 95 % interval of numbers by conditions, persons counted once in each.

    Trials of a person are averaged first, so that SD and interval are those between persons (the
    interval is t times SD / sqrt(persons)). Without a condition that names the persons (``person``)
    files take their place, and the table says so. The slip is a share, with persons who slipped.
    """
    usable = [f for f in files if f.usable and all(key in f.conditions for key in keys)]
    numbers = tuple(n for n in numbers if any(n in f.main for f in usable))
    if not usable or not numbers:
        return None
    groups = group_files(usable, keys)
    if len(groups) > 1:
        groups[("all", *("" for _ in keys[1:]))] = usable
    unit = "persons" if person else "files"
    rows = []
    errors: dict[str, list[float]] = {}
    for group, members in groups.items():
        people = [str(m.conditions.get(person, m.file)) for m in members]
        steps = sum(counted_steps(m) for m in members)
        cells: list[Cell] = [*group, len(set(people)), len(members), steps or None]
        for number in numbers:
            values: dict[str, list[float]] = {}
            for member, who in zip(members, people, strict=True):
                if number in member.main:
                    values.setdefault(who, []).append(
                        float(scale_to_heading(number, member.main[number]) or 0)
                    )
            if number == "slip":
                trials = [x for v in values.values() for x in v]
                cells += [float(np.mean(trials)) if trials else None]
                counts = [(sum(v), len(v)) for v in values.values()]
                ends = (
                    statistics.share_interval(*zip(*counts, strict=True))
                    if person and counts
                    else None
                )
                cells += [*(ends or (None, None)), sum(max(v) > 0 for v in values.values())]
                continue
            means = [float(np.mean(v)) for v in values.values()]
            mean, spread, low, high = mean_and_interval(means, number)
            cells += [mean, spread, low, high]
            if spread:
                errors.setdefault(number, []).append(spread / np.sqrt(len(values)))
        rows.append(tuple(cells))
    trials = "trials" if person or any(f.steps for f in usable) else "readings"
    averaged = ", each person's trials averaged first." if person else "."
    notes = [f"Mean, SD and 95 % interval between {unit}{averaged} {INTERVALS}"]
    if any(
        len({str(m.conditions.get(person, m.file)) for m in results}) < 2
        for results in groups.values()
    ):
        notes.append(
            Message(
                "Of one of the {unit} alone SD and interval are not estimated: no scatter.",
                unit=unit,
            )
        )
    if not person and len(usable) > 1:
        notes.append(
            "No condition names the persons or samples: every file counts as one. Where files "
            'repeat a person, note it ("subject" in conditions.csv, or a pattern of names).'
        )
    shares = ("share of trials with a slip", "95 % from", "95 % to", f"{unit} who slipped")
    heads: list[TrialColumn | str] = [*condition_columns(keys)]
    heads += [TrialColumn(things, Role.COUNT) for things in (unit, trials, "steps")]
    for number in numbers:
        places = decimals_of(float(np.median(errors[number]))) if number in errors else None
        heads += shares if number == "slip" else number_columns(number, places)
    title = "By " + ", ".join(keys) if keys else "All trials"
    return TrialTable.of(name, title, heads, rows, *notes).without_empty()


def number_columns(name: str, decimals: int | None = None) -> list[TrialColumn]:
    """Return the columns of mean, SD and interval of a quantity."""
    quantity = quantity_name(name)
    ends = (
        Message("{quantity} 95 % low", quantity=quantity),
        Message("{quantity} 95 % high", quantity=quantity),
    )
    heads = (heading(name), heading(name, "SD"), *ends)
    roles = (Role.MEAN, Role.SD, Role.LOW, Role.HIGH)
    return [TrialColumn(*both, name, decimals) for both in zip(heads, roles, strict=True)]


INTERVALS = (
    "Intervals: t on the logarithm of a mean that can't be negative (none from two values), on the "
    "logit of a share. Values that are all alike scatter by less than their resolution: no SD."
)
_SIGNED = ("acof_minus_rcof", "slip_margin")


def mean_and_interval(values: Sequence[float] | np.ndarray, name: str) -> tuple[float | None, ...]:
    """Return mean, SD and the 95 % interval of the mean of a quantity; None from too few values.

    Values that are all alike have neither SD nor interval: they scatter by less than their
    resolution.
    """
    if not len(values):
        return None, None, None, None
    mean, spread = float(np.mean(values)), statistics.standard_deviation(values)
    if spread is None:
        return mean, None, None, None
    ends = statistics.mean_interval(values, positive=name not in _SIGNED) or (None, None)
    return mean, spread, *ends


def counted_steps(result: FileResult) -> int:
    """Return the number of steps of a file that gave a required friction."""
    return sum(
        m.name == "rcof" and m.value is not None and m.item != MEAN_OF_STEPS
        for m in result.measurements
    )


def decimals_of(uncertainty: float) -> int:
    """Return the decimals that show two digits of an uncertainty."""
    if not uncertainty > 0:
        return 3
    return int(np.clip(1 - np.floor(np.log10(uncertainty)), 0, 8))


# Numbers of a step with their SI unit, in the order of the tables.
STEP_NUMBERS = {
    "rcof": "1", "rcof_uncertainty": "1", "peak_slipping_speed": "m/s", "slip_start": "s",
    "slip_distance": "m", "toe_slip": "m", "trailing_slip": "m", "contact": "s", "toe_off": "s",
    "stance_time": "s", "peak_force": "N", "walking_speed": "m/s", "step_length": "m",
    "step_time": "s", "cadence": "1/s", "foot_angle": "rad", "heel_speed": "m/s",
    "belt_speed": "m/s",
}  # fmt: skip
_TEXTS = ("plate", "side", "verdict", "reason", "outcome", "slip_direction", "recovery_or_fall")
_CURVES = ("vertical", "braking", "to the left", "ratio")


def step_tables(files: Iterable[FileResult]) -> list[TrialTable]:
    """Return one row a step (``steps_wide``) and one row a number (``steps_long``).

    Conditions stand beside. Refused files and rejected steps are in both, with their verdict.
    """
    files = [file for file in files if file.steps]
    if not files:
        return []
    conditions = list(dict.fromkeys(name for file in files for name in file.conditions))
    wide: list[tuple[Cell, ...]] = []
    long: list[tuple[Cell, ...]] = []
    for file in files:
        own = [file.conditions.get(name) for name in conditions]
        for step in file.steps:
            head = (file.file, file.verdict, *own, step.number)
            texts = [getattr(step, name) or "" for name in _TEXTS]
            cautions = join_lines(step.cautions)
            wide.append((*head, *texts, cautions, *(getattr(step, name) for name in STEP_NUMBERS)))
            long += [
                (*head, step.side, step.verdict, name, getattr(step, name), unit)
                for name, unit in STEP_NUMBERS.items()
                if getattr(step, name) is not None
            ]
    first = ("file", "file verdict", *condition_columns(conditions), "step")
    units = [f"{n} ({u})" if u != "1" else n for n, u in STEP_NUMBERS.items()]
    heads = (*first, *_TEXTS, "cautions", *units)
    tidy = (*first, "side", "step verdict", "quantity", "value", "unit")
    return [
        TrialTable.of("steps_wide", "Every step with its numbers", heads, wide),
        TrialTable.of("steps_long", "Every number of every step", tidy, long),
    ]


def curve_table(files: Iterable[FileResult]) -> TrialTable | None:
    """Return mean and SD of the forces over 0 to 100 % of stance, by condition, or None.

    The steps of a person (of a file, where no person is named) are averaged first; SD is that
    between persons.
    """
    files = [file for file in files if file.usable and file.curves.get("normalised")]
    if not files:
        return None
    person = person_condition(files)
    keys = [
        name
        for name in dict.fromkeys(name for file in files for name in file.conditions)
        if name != person
        and name not in NUMBERS
        and 1 < len({str(file.conditions.get(name)) for file in files}) < len(files)
        and all(isinstance(file.conditions.get(name, ""), str) for file in files)
    ]
    groups: dict[tuple[str, ...], dict[str, list[np.ndarray]]] = {}
    for file in files:
        key = tuple(str(file.conditions.get(name, "")) for name in keys)
        who = str(file.conditions.get(person, file.file))
        for curve in file.curves["normalised"]:
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
    both = [
        column
        for name in names
        for column in (Message("mean {curve}", curve=name), Message("SD {curve}", curve=name))
    ]
    heads = (*condition_columns(keys), "percent of stance", "persons" if person else "files", *both)
    return TrialTable.of("stance_curves", "Forces over stance", heads, rows)
