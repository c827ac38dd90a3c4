"""What a study wants of a design: statistics of an output over conditions and draws, and bounds.

    mean(cof) in canola_oil over conditions      a goal: statistic, output, conditions, over what
    quantile(cof, 0.1) > 0.16                    a requirement
    wear_life(cof > 0.16)                        wear at which a requirement stops to hold

A bare output is its mean. Over conditions and draws, where nothing is said.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np

from underfoot.core import InputError, to_si, unknown_name
from underfoot.core.arrays import Array
from underfoot.core.presentation import quantity_text
from underfoot.core.remark import Message
from underfoot.core.units import refuse_percent

from .record import Record

STATISTICS = ("mean", "min", "max", "sd", "quantile")
SAID = {"mean": "", "min": "lowest", "max": "highest", "sd": "standard deviation of"}
"""Statistics as people say them."""
OVER = ("conditions", "draws", "conditions and draws")
LIFE = "wear_life"
WEAR = "shoe.wear.depth"
_CLAUSE = re.compile(r"\s+(in|over)\s+([^<>()]*?)(?=\s+(?:in|over)\s|$)")
_STATISTIC = re.compile(r"(\w+)\s*\(\s*(\w+)\s*(?:,\s*([^()]+))?\)|(\w+)")
_BOUND = re.compile(r"(.+?)\s*(<=|>=|<|>)\s*(.+)")


@dataclass(frozen=True, slots=True)
class Condition:
    """A state that every design is run in: what it is called, in parts, and what makes it."""

    parts: tuple[str, ...]
    changes: Mapping[str, Any]

    @property
    def label(self) -> str:
        """All parts in one line."""
        return ", ".join(self.parts)


@dataclass(frozen=True, slots=True)
class Goal:
    """A statistic of an output; ``within`` names the conditions that count, () for all."""

    output: str
    unit: str
    statistic: str = "mean"
    share: float = 0.5
    over: str = "conditions and draws"
    within: tuple[str, ...] = ()

    def __str__(self) -> str:
        inner = f"{self.output}, {self.share:g}" if self.statistic == "quantile" else self.output
        text = inner if self.statistic == "mean" else f"{self.statistic}({inner})"
        text += f" in {', '.join(self.within)}" if self.within else ""
        return text + (f" over {self.over}" if self.over != OVER[2] else "")

    @property
    def phrase(self) -> str:
        """Return it as people say it: "lowest COF over conditions"."""
        output = "COF" if self.output == "cof" else self.output.replace("_", " ")
        how = SAID.get(self.statistic, f"{self.share:.0%} quantile of").strip()
        where = f" in {', '.join(self.within)}" if self.within else ""
        over = f" over {self.over}" if self.over != OVER[2] else ""
        return f"{how} {output}{where}{over}".strip()

    @property
    def of_draws(self) -> bool:
        """Whether the friction law's draws of COF count; a mean is that of the numbers computed."""
        return self.statistic != "mean" and self.over != "conditions" and self.output == "cof"

    def value(
        self, records: Mapping[tuple[int, int], Record], states: Sequence[Condition]
    ) -> float:
        """Return the statistic over a design's records by (condition, draw); nan if one lacks."""
        values = output_array(records, range(len(states)), self.output, law=self.of_draws)
        return float(self.values(values[None], states)[0])

    def values(self, outputs: Array, states: Sequence[Condition]) -> Array:
        """Return the statistic (designs,) of outputs (designs, conditions, draws, law's draws).

        "Over conditions" takes the mean over draws first, "over draws" the mean over conditions.
        """
        chosen = outputs[:, _states_within(states, self.within)]
        if self.statistic != "mean" and self.over == "conditions":
            chosen = chosen.mean(axis=(2, 3))
        elif self.statistic != "mean" and self.over == "draws":
            chosen = chosen.mean(axis=1)
        flat = chosen.reshape(len(chosen), -1)
        if self.statistic == "quantile":
            return np.quantile(flat, self.share, axis=1)
        return {"mean": np.mean, "min": np.min, "max": np.max, "sd": np.std}[self.statistic](
            flat, axis=1
        )

    def numbers(self, states: Sequence[Condition], draws: int) -> int:
        """Return how many numbers of a design the statistic is of, the law's draws left out."""
        each = {"conditions": len(_states_within(states, self.within)), "draws": draws}
        return math.prod(each[name] for name in self.over.split(" and "))

    def error(
        self, records: Mapping[tuple[int, int], Record], states: Sequence[Condition]
    ) -> float:
        """Return the numerical error of ``value``, SI: the mean of those of the runs that count.

        Runs of one design share tread and grid, so no mean over them makes it smaller. nan where a
        run states none.
        """
        chosen = _states_within(states, self.within)
        runs = (record for (state, _), record in records.items() if state in chosen)
        return float(np.mean([record.errors.get(self.output, np.nan) for record in runs]))


@dataclass(frozen=True, slots=True)
class Requirement:
    """A goal and its bound (SI): ``sense`` 1 for at least, -1 for at most."""

    goal: Goal
    sense: int
    bound: float

    def __str__(self) -> str:
        sign = ">" if self.sense > 0 else "<"
        return f"{self.goal} {sign} {quantity_text(self.bound, self.goal.unit)}"

    def margin(self, value: float | Array) -> float | Array:
        """Return by how much a value holds the bound, SI; negative where it does not."""
        return self.sense * (value - self.bound)


@dataclass(frozen=True, slots=True)
class WearLife:
    """Wear (m) at which a requirement stops to hold, linear between the wears that were run.

    The least over the other conditions; 0 where it does not hold new. Where it holds to the last
    wear, that one: a lower bound.
    """

    requirement: Requirement
    unit = "m"

    def __str__(self) -> str:
        return f"{LIFE}({self.requirement})"

    @property
    def output(self) -> str:
        """The output that is bounded."""
        return self.requirement.goal.output

    @property
    def phrase(self) -> str:
        """Return it as people say it: "wear life with COF > 0.12"."""
        bound = self.requirement
        of = {"goal": bound.goal.phrase, "limit": quantity_text(bound.bound, bound.goal.unit)}
        if bound.sense > 0:
            return Message("wear life with {goal} > {limit}", **of)
        return Message("wear life with {goal} < {limit}", **of)

    @property
    def of_draws(self) -> bool:
        """As of a goal."""
        return self._bounded.of_draws

    @property
    def _bounded(self) -> Goal:
        return replace(self.requirement.goal, within=())

    def value(
        self, records: Mapping[tuple[int, int], Record], states: Sequence[Condition]
    ) -> float:
        """Return the life over the records of a design; nan where one lacks."""
        values = output_array(records, range(len(states)), self.output, law=self.of_draws)
        return float(self.values(values[None], states)[0])

    def values(self, outputs: Array, states: Sequence[Condition]) -> Array:
        """Return the lives (designs,) of outputs (designs, conditions, draws, law's draws)."""
        groups: dict[str, dict[float, Array]] = {}
        for number in _states_within(states, self.requirement.goal.within):
            changes = dict(states[number].changes)
            wear = float(changes.pop(WEAR))
            values = self._bounded.values(outputs[:, [number]], [Condition((), {})])
            margins = np.asarray(self.requirement.margin(values))
            groups.setdefault(repr(changes), {})[wear] = margins
        lives = []
        for group in groups.values():
            wears = sorted(group)
            rows = np.transpose([group[wear] for wear in wears])
            lives.append([_crossing(list(zip(wears, row, strict=True))) for row in rows])
        return np.min(lives, axis=0)  # nan where one lacks

    def error(self, *_: object) -> float:
        """Return nan: how far the error of a run moves a crossing is not known."""
        return float("nan")


AnyGoal = Goal | WearLife


def _crossing(margins: Sequence[tuple[float, float]]) -> float:
    if any(np.isnan(margin) for _, margin in margins):
        return float("nan")
    before = None
    for wear, margin in margins:
        if margin < 0:
            if before is None:
                return 0.0
            return before[0] + (wear - before[0]) * before[1] / (before[1] - margin)
        before = wear, margin
    return margins[-1][0]


def output_array(
    records: Mapping[tuple[int, int], Record],
    conditions: Sequence[int],
    name: str,
    *,
    law: bool = False,
) -> Array:
    """Return an output as (conditions, draws, law's draws), nan where a case has none."""
    draws = sorted({draw for _, draw in records})
    rows = []
    for state in conditions:
        for draw in draws:
            record = records.get((state, draw))
            if record is None or not record.usable:
                rows.append(np.array([np.nan]))
            elif law and name == "cof" and record.draws.size:
                rows.append(record.draws)
            else:
                rows.append(np.array([record.number(name)]))
    width = max(row.size for row in rows)
    rows = [row if row.size == width else np.full(width, row.mean()) for row in rows]
    return np.array(rows).reshape(len(conditions), len(draws), width)


def _states_within(states: Sequence[Condition], within: Sequence[str]) -> list[int]:
    return [k for k, state in enumerate(states) if set(within) <= set(state.parts)]


def read_goal(
    text: object,
    units: Mapping[str, str],
    states: Sequence[Condition],
    require: Sequence[Requirement] = (),
) -> AnyGoal:
    """Return the goal of a text; ``units`` are those of the outputs that there are."""
    body, clauses = _clauses(text)
    if body == LIFE:
        if not require:
            raise InputError(
                f"{LIFE} of what", remedy=f"Write {LIFE}(cof > 0.16), or a requirement"
            )
        return _life(require[0], states)
    if body.startswith(f"{LIFE}(") and body.endswith(")"):
        inner = body[len(LIFE) + 1 : -1] + "".join(f" {k} {v}" for k, v in clauses.items())
        return _life(read_requirement(inner, units, states), states)
    match = _STATISTIC.fullmatch(body)
    if match is None:
        raise InputError(
            Message('"{text}" is no goal', text=text),
            allowed='an output, or "quantile(cof, 0.1) in canola_oil over conditions"',
        )
    statistic, output = (match[1] or "mean"), (match[2] or match[4])
    if statistic not in STATISTICS:
        raise unknown_name("statistic", statistic, STATISTICS)
    if output not in units:
        raise unknown_name("output", output, [*units, LIFE])
    share = to_si(match[3], "1", where="") if match[3] else 0.5
    if (statistic == "quantile") != bool(match[3]) or not 0 < share < 1:
        raise InputError(f'"{text}"', allowed="quantile(output, share), share between 0 and 1")
    over = clauses.get("over", OVER[2])
    if over not in OVER:
        raise unknown_name("word after over", over, OVER)
    words = sorted({part for state in states for part in state.parts})
    within = tuple(_split_list(clauses.get("in", ""), words))
    for word in within:
        if word not in words:
            raise unknown_name("condition", word, words)
        meant = {k for state in states for k, part in enumerate(state.parts) if part == word}
        if len(meant) > 1:
            raise InputError(
                Message("{word} stands under several conditions", word=word),
                remedy="Write one in another unit",
            )
    if not _states_within(states, within):
        raise InputError(Message("no condition is {within}", within=" and ".join(within)))
    return Goal(output, units[output], statistic, share, over, within)


def _split_list(text: str, names: Sequence[str]) -> Iterator[str]:
    """Yield the parts of a list with commas, of which a name may hold some too."""
    parts = [part.strip() for part in text.split(",") if part.strip()]
    while parts:
        sizes = range(len(parts), 1, -1)
        size = next((size for size in sizes if ", ".join(parts[:size]) in names), 1)
        yield ", ".join(parts[:size])
        parts = parts[size:]


def read_requirement(
    text: object, units: Mapping[str, str], states: Sequence[Condition]
) -> Requirement:
    """Return the requirement of a text."""
    body, clauses = _clauses(text)
    match = _BOUND.fullmatch(body)
    if match is None:
        raise InputError(
            Message('"{text}" is no requirement', text=text),
            allowed='as "cof > 0.16 in canola_oil"',
        )
    whole = match[1] + "".join(f" {word} {rest}" for word, rest in clauses.items())
    goal = read_goal(whole, units, states)
    if not isinstance(goal, Goal):
        raise InputError(Message("{goal} can't be required", goal=goal), allowed="an output")
    if goal.statistic == "sd":
        refuse_percent(match[3], where="")
    return Requirement(goal, 1 if ">" in match[2] else -1, to_si(match[3], goal.unit, where=""))


def check_agreement(require: Sequence[Requirement]) -> None:
    """Refuse requirements that no design can meet: the least above, or the greatest below, others'.

    Of one output over the same; between different statistics only what holds of all numbers.
    """
    for low, high in product(require, require):
        one, other = low.goal, high.goal
        same = replace(one, statistic=other.statistic, share=other.share) == other
        ordered = one == other or one.statistic == "min" or other.statistic == "max"
        numbers = "sd" not in (one.statistic, other.statistic) or one == other
        if same and ordered and numbers and low.sense > 0 > high.sense and low.bound >= high.bound:
            raise InputError(
                Message('"{low}" and "{high}" can\'t both hold', low=low, high=high),
                remedy="Drop one",
            )


def _life(requirement: Requirement, states: Sequence[Condition]) -> WearLife:
    states = [states[k] for k in _states_within(states, requirement.goal.within)]
    wears = {state.changes.get(WEAR) for state in states}
    if None in wears or len(wears) < 2:
        raise InputError(
            f"{LIFE} needs at least two states of wear",
            remedy='Write wear = ["0 mm", "1 mm", "2 mm"] under [conditions]',
        )
    return WearLife(requirement)


def _clauses(text: object) -> tuple[str, dict[str, str]]:
    if not isinstance(text, str):
        raise InputError(f"{text!r}", allowed="text, as quantile(cof, 0.1)")
    clauses = {match[1]: match[2].strip() for match in _CLAUSE.finditer(text)}
    return _CLAUSE.sub("", text).strip(), clauses
