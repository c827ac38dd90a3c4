"""Results side by side: which has the highest friction, how sure the order is, what differs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from underfoot.case import Case
from underfoot.compute import summary
from underfoot.compute.numbers import required_friction
from underfoot.compute.result import Result
from underfoot.compute.run import run
from underfoot.core import InputError, Progress, SourcedValue, nearest_match, silent
from underfoot.core.arrays import Array
from underfoot.core.presentation import Part, Presentable, Table, drawn_probability_text, value_text
from underfoot.core.progress import part
from underfoot.core.remark import Message, Remark, join_lines, subjects
from underfoot.slip import slip_chances

from .order import SEEN, Order, OrderVerdict, order_of_draws, order_of_values
from .separation import MOVES, SeparatingStep, of_conditions, of_reading

if TYPE_CHECKING:
    from underfoot.core.catalogue import Catalogue

LETTERS = "ABCDEFGHIJKL"
Z95 = 1.96
_FILE, _CHECKSUM = "shoe.outsole.file", "shoe.outsole.sha256"
LONGEST_CELL = 34
"""Characters of an input in a table; longer ones (paths, checksums) keep their end."""
LEAST_SHOWN = 0.001
"""Difference of two COF that is printed, the smallest."""


@dataclass(frozen=True, slots=True)
class Rank:
    """Place of one result by COF; ``better_than_next`` is the probability of that order."""

    letter: str
    name: str
    cof: SourcedValue
    interval: tuple[float, float] | None
    better_than_next: float | None


@dataclass(frozen=True, slots=True)
class ComparedQuantity:
    """One quantity of all results.

    ``orders`` has that of each result against the first, by its letter: by the draws that both
    share where there are any, as the ranking has it; empty where no spread is known.
    """

    name: str
    label: str
    values: tuple[SourcedValue | None, ...]
    orders: Mapping[str, Order]

    @property
    def different(self) -> tuple[str, ...]:
        """Letters of the results of which an order against the first is stated."""
        told = (OrderVerdict.HIGHER, OrderVerdict.LOWER)
        return tuple(letter for letter, order in self.orders.items() if order.verdict in told)


@dataclass(frozen=True, slots=True)
class Comparison(Presentable):
    """Two to twelve results side by side.

    ``order`` is that of the two highest COF; ``separations``, where it is open, what would tell
    them apart, the surest first.
    """

    kind: ClassVar[str] = "comparison"

    results: tuple[Result, ...]
    ranking: tuple[Rank, ...]
    quantities: tuple[ComparedQuantity, ...]
    differences: tuple[tuple[str, ...], ...]
    reasons: tuple[Message, ...]
    order: Order | None = None
    separations: tuple[SeparatingStep, ...] = ()

    def __repr__(self) -> str:
        return f"<Comparison of {len(self.results)} results: {self.headline()[0]:.120}>"

    @property
    def usable(self) -> bool:
        return all(result.status.usable for result in self.results)

    def heading(self) -> str:
        return "Comparison of friction"

    def label(self, letter: str) -> Message:
        """Return the name of a result, with its letter where names repeat."""
        names = [result.name for result in self.results]
        name = names[LETTERS.index(letter)]
        if names.count(name) == 1:
            return Message.plain(name)
        return Message("{letter} ({name})", letter=letter, name=name)

    def headline(self) -> tuple[Message, ...]:
        for result in self.results:
            if not (status := result.status).usable:
                told = {"name": result.name, "status": status, "remedy": status.remedy}
                return (Message("No comparison: {name} is {status}. {remedy}", **told),)
        if len({result.provenance.case_hash for result in self.results}) == 1:
            return (Message("The cases are the same; the results differ by grid or version only."),)
        first, second = self.ranking[:2]
        lead = float(first.cof) - float(second.cof)
        both: dict[str, Any] = {
            "better": self.label(first.letter),
            "other": self.label(second.letter),
        }
        apart = Message("{lead:.3f}", lead=lead)
        if lead < LEAST_SHOWN:
            apart = Message("less than {least:.3f}", least=LEAST_SHOWN)
        if self.order is None:
            exact = [self.label(rank.letter) for rank in (first, second) if rank.interval is None]
            return (
                Message(
                    "COF of {better} is {apart} above that of {other}. How sure that is can't be "
                    "told: no spread is known of {names: and }.",
                    **both, apart=apart, names=exact,
                ),
            )  # fmt: skip
        both["chance"] = _chance(first.better_than_next)
        if self.order.verdict is OrderVerdict.EQUAL:
            return (
                Message(
                    "{better} and {other} are equal for every purpose: COF {apart} apart "
                    "(probability {chance} that the first has more), too small to see. "
                    "Readings of one tester repeat within {seen:.0f} %.",
                    **both, apart=apart, seen=100 * SEEN,
                ),
                self._different(),
            )  # fmt: skip
        if self.order.verdict is not OrderVerdict.HIGHER:
            return (
                Message(
                    "Whether {better} or {other} has more friction is open: COF {apart} apart "
                    "(probability {chance} that the first has more).",
                    **both, apart=apart,
                ),
                *self._telling(self.order, float(second.cof)),
            )  # fmt: skip
        if len(self.results) > 2:
            order = Message(
                "{better} has the highest COF, {lead:.3f} above {other} (probability {chance}).",
                **both, lead=lead,
            )  # fmt: skip
        else:
            order = Message(
                "{better} has the higher COF than {other}, by {lead:.3f} (probability {chance}).",
                **both, lead=lead,
            )  # fmt: skip
        return order, self._different()

    def _telling(self, order: Order, least: float) -> tuple[Message, ...]:
        """Return what would tell an order that is open, and what a tester could see of it."""
        seen = Message(
            "The smallest difference a tester would see is {least:.3f} ({share:.0f} %).",
            least=SEEN * least, share=100 * SEEN,
        )  # fmt: skip
        if not self.separations:
            return (seen,)
        best = self.separations[0]
        step = {"step": best.step, "chance": drawn_probability_text(best.told)}
        if best.told - order.told < MOVES:
            nothing = Message(
                "Nothing that was tried would tell: at best {step} ({chance}).", **step
            )
            return nothing, seen
        return Message("What would tell: {step} ({chance}).", **step), seen

    def cautions(self) -> tuple[Message, ...]:
        return self.reasons

    def table(self) -> Table:
        rows = []
        for quantity in self.quantities:
            texts = ["" if v is None else value_text(quantity.name, v) for v in quantity.values]
            remark = join_lines(
                _order_text(order, letter if len(self.results) > 2 else "")
                for letter, order in quantity.orders.items()
            )
            rows.append((quantity.label, *texts, remark))
        against = Message("{letters} against A", letters=self.letters[1:])
        return Table("Results", ("Quantity", *self.letters, against), rows)

    def tables(self) -> tuple[Table, ...]:
        ranking = Table(
            "Ranking by COF",
            ("", "Case", "COF", "95 % interval", "Higher than the next"),
            [
                (
                    rank.letter,
                    rank.name,
                    value_text("cof", rank.cof),
                    _interval(rank.interval) if rank.interval else "",
                    _chance(rank.better_than_next),
                )
                for rank in self.ranking
            ],
        )
        rows = [tuple(map(_shorten_cell, row)) for row in with_short_names(self.differences)]
        inputs = Table("Inputs that differ", ("Input", *self.letters), rows)
        steps = Table(
            "What would tell the two highest apart",
            ("Step", "Probability of the order then"),
            [
                (separation.step, drawn_probability_text(separation.told))
                for separation in self.separations
            ],
        )
        parts = (*((ranking,) if self.ranking else ()), self.table(), inputs)
        return (*parts, *((steps,) if self.separations else ()))

    @property
    def letters(self) -> str:
        """Return A, B, ... for the results."""
        return LETTERS[: len(self.results)]

    def to_dict(self) -> dict[str, Any]:
        return {
            "ranking": [
                {"letter": rank.letter, "name": rank.name, "cof": rank.cof.to_dict()}
                | {"interval_95": rank.interval, "higher_than_next": rank.better_than_next}
                for rank in self.ranking
            ],
            "quantities": [
                {
                    "name": quantity.name,
                    "values": [None if v is None else v.to_dict() for v in quantity.values],
                    "different_from_first": quantity.different,
                    "orders": {
                        letter: {"verdict": str(order.verdict), **asdict(order)}
                        for letter, order in quantity.orders.items()
                    },
                }
                for quantity in self.quantities
            ],
            "differences": [
                {"path": path, "values": list(values)} for path, *values in self.differences
            ],
            "order": self.order and {"verdict": str(self.order.verdict), **asdict(self.order)},
            "separations": [asdict(separation) for separation in self.separations],
            "results": [result.to_dict() for result in self.results],
        }

    def data_tables(self) -> dict[str, Table]:
        quantities = [
            (q.name, next((v.unit for v in q.values if v), ""), *(v and v.value for v in q.values))
            for q in self.quantities
        ]
        return {
            "quantities": Table("", ("quantity", "unit", *self.letters), quantities),
            "differences": Table("", ("path", *self.letters), self.differences),
        }

    def _different(self) -> Message:
        several, names, whole = len(self.results) > 2, [], ""
        for quantity in self.quantities:
            label = quantity.label
            if isinstance(label, Part):
                name = Message("{whole} {part}", whole=whole, part=label.label)
            else:
                whole = label[:1].lower() + label[1:]
                name = Message.plain(whole)
            if quantity.different and several:
                name = Message("{name} ({letters})", name=name, letters=quantity.different)
            if quantity.different:
                names.append(name)
        if not names:
            return Message("No other quantity differs for sure.")
        if several:
            first = self.label("A")
            return Message("These differ from {first}: {names:; }.", first=first, names=names)
        return Message("These differ: {names:; }.", names=names)


def compare(
    *items: Result | Case,
    quick: bool = False,
    catalogue: Catalogue | None = None,
    separate: bool = False,
    progress: Progress = silent,
) -> Comparison:
    """Return results side by side, ranked by COF; cases are computed first.

    Parameters:
        *items: Two to twelve results or cases.
        quick: Compute cases on the coarse grid.
        catalogue: Where the stored cases of results find their entries; the built-in one by
            default.
        separate: Where the order of the two highest is open, compute them under other fluids,
            angles and worn, to say what would tell them apart; else a reading alone is thought of.
        progress: Receives stage, fraction and residual.

    The probability that one COF is higher than another is the share of the joint draws in which it
    is: what two cases have in common (laboratory, compound, floor, law) is drawn once for both and
    cancels; the errors of film and tread do as far as both treads are alike. Results without draws,
    or of different laws or seeds, count as independent: Phi(d / s), d their difference and
    s = sqrt(s1^2 + s2^2).

    Raises:
        InputError: Fewer than two or more than twelve items.
    """
    _check_count(len(items))
    results = tuple(
        item
        if isinstance(item, Result)
        else run(item, quick=quick, progress=part(progress, k / len(items), (k + 1) / len(items)))
        for k, item in enumerate(items)
    )
    cases = [
        Case.from_text(item.case_text, catalogue=catalogue) if isinstance(item, Result) else item
        for item in items
    ]
    ranking = _ranking(results)
    order, separations = None, ()
    if ranking:
        top = [LETTERS.index(rank.letter) for rank in ranking[:2]]
        order = order_of(results[top[0]], results[top[1]])
        if order is not None and order.verdict is OrderVerdict.OPEN:
            separations = _separations(
                [results[k] for k in top], [cases[k] for k in top], separate, progress
            )
    return Comparison(
        results,
        ranking,
        _quantities(results, cases),
        tuple(case_differences(cases)),
        _reasons(results),
        order,
        separations,
    )


def _separations(
    results: Sequence[Result], cases: Sequence[Case], separate: bool, progress: Progress
) -> tuple[SeparatingStep, ...]:
    """Return what would tell two results apart, the surest first."""
    separations = of_conditions(*cases, progress=progress) if separate else []
    drawn = _shared_draws(*results)
    if drawn is not None:
        separations.append(of_reading(*drawn))
    return tuple(sorted(separations, key=lambda one: -one.told))


def check_paths(paths: Sequence[Path]) -> None:
    """Refuse what is no result folder and no case file, before anything is computed."""
    _check_count(len(paths))
    for path in paths:
        if path.is_dir() and not (path / "result.json").is_file():
            raise InputError(
                f"the folder {path} holds no result (there is no result.json in it)",
                where="compare",
                allowed="folders that underfoot run made, or case files",
            )
        if not path.exists():
            beside = path.parent.iterdir() if path.parent.is_dir() else ()
            near = nearest_match(path.name, [entry.name for entry in beside])
            raise InputError(
                f"there is no result folder or case file {path}",
                where="compare",
                nearest=None if near is None else str(path.parent / near),
                remedy="Give folders that underfoot run made, or case files",
            )


def case_differences(cases: Sequence[Case]) -> list[tuple[str, ...]]:
    """Return (path, value in each case) of the inputs in which the cases are not all alike."""
    texts = [{path: value for path, value, _ in case.rows()} for case in cases]
    paths = [path for path, *_ in differences([compared_values(case) for case in cases])]
    return [(path, *(text.get(path, "-") for text in texts)) for path in paths]


def compared_values(case: Case) -> dict[str, Any]:
    """Return by path what is compared of a case: values (SI) and how sure they are."""
    return {path: (value, case.origins[path].uncertainty) for path, value in case.named_values("")}


def differences(tables: Sequence[Mapping[str, Any]]) -> list[tuple[Any, ...]]:
    """Return (key, value in each table) of what is not alike in all tables; "-" where missing."""
    paths = dict.fromkeys(path for table in tables for path in table)
    rows = [(path, *(table.get(path, "-") for table in tables)) for path in paths]
    return [row for row in rows if len(set(row[1:])) > 1]


def _check_count(count: int) -> None:
    if not 2 <= count <= len(LETTERS):
        raise InputError(
            Message("{count} {count:result|results} to compare", count=count),
            where="compare",
            allowed=f"2 to {len(LETTERS)}",
        )


def _ranking(results: Sequence[Result]) -> tuple[Rank, ...]:
    if not all(result.status.usable for result in results):
        return ()
    order = sorted(zip(LETTERS, results, strict=False), key=lambda one: -one[1].value("cof"))
    ranks = []
    for place, (letter, result) in enumerate(order, start=1):
        cof = result.scalars["cof"]
        chance = chance_higher(result, order[place][1]) if place < len(order) else None
        ranks.append(Rank(letter, result.name, cof, interval_95(cof), chance))
    return tuple(ranks)


def chance_higher(first: Result, second: Result) -> float | None:
    """Return the probability that the first COF is higher, from shared draws where there are."""
    order = order_of(first, second)
    return None if order is None else order.higher


def order_of(first: Result, second: Result) -> Order | None:
    """Return the order of two COF: by the draws that both share, else as independent values."""
    drawn = _shared_draws(first, second)
    if drawn is not None:
        return order_of_draws(*drawn)
    return order_of_values(first.scalars["cof"], second.scalars["cof"])


def _shared_draws(first: Result, second: Result) -> tuple[Array, Array] | None:
    """Return the draws of COF of two results of the law of the pair; None without."""
    if any(result.provenance.closures.get("friction") != "pair" for result in (first, second)):
        return None
    both = [result.data.get("cof_draws") for result in (first, second)]
    if both[0] is None or both[1] is None or both[0].size != both[1].size:
        return None
    return np.asarray(both[0].values), np.asarray(both[1].values)


def interval_95(scalar: SourcedValue) -> tuple[float, float] | None:
    """Return the 95 % interval of a value, from its standard deviation where it has no other."""
    if scalar.interval is not None:
        return scalar.interval
    if scalar.value is None or scalar.uncertainty is None:
        return None
    half = Z95 * scalar.uncertainty
    return max(scalar.value - half, 0.0), scalar.value + half


def _quantities(results: Sequence[Result], cases: Sequence[Case]) -> tuple[ComparedQuantity, ...]:
    rows = []
    for name, (label, _) in summary.QUANTITIES.items():
        values = tuple(result.scalars.get(name) for result in results)
        if any(value is not None for value in values):
            pairs = zip(LETTERS[1:], range(1, len(results)), strict=False)
            orders = {letter: _order_in(name, results, cases, at) for letter, at in pairs}
            known = {letter: order for letter, order in orders.items() if order is not None}
            rows.append(ComparedQuantity(name, label, values, known))
    return tuple(rows)


def _order_in(name: str, results: Sequence[Result], cases: Sequence[Case], at: int) -> Order | None:
    """Return the order of a quantity of one result against the first."""
    first, other = results[0], results[at]
    if name not in other.scalars or name not in first.scalars:
        return None
    if name == "cof":
        return order_of(other, first)
    drawn = _shared_draws(other, first)
    if name != "slip_probability" or drawn is None:
        return order_of_values(other.scalars[name], first.scalars[name])
    chances = [
        slip_chances(draws, required_friction(case), case.risk.build())
        for draws, case in zip(drawn, (cases[at], cases[0]), strict=True)
    ]
    slips, friction = order_of_draws(chances[0], chances[1]), order_of_draws(*drawn)
    # what nobody can tell of the friction nobody can tell of the slips
    same = required_friction(cases[at]) == required_friction(cases[0])
    return replace(slips, within=friction.within if same else slips.within)


def _order_text(order: Order, letter: str) -> Message:
    """Return what is said of an order, with its probability where one is stated."""
    chance = {
        OrderVerdict.HIGHER: order.higher,
        OrderVerdict.LOWER: 1 - order.higher,
        OrderVerdict.EQUAL: order.within,
        OrderVerdict.OPEN: None,
    }[order.verdict]
    text = Message("not decided")
    if chance is not None:
        sure = drawn_probability_text(chance)
        text = Message("{verdict}, {sure}", verdict=order.verdict, sure=sure)
    return Message("{letter} {text}", letter=letter, text=text) if letter else text


def _reasons(results: Sequence[Result]) -> tuple[Message, ...]:
    reasons: list[Message] = []
    sides = [float(np.median(np.diff(result.data["x"].values))) for result in results]
    if max(sides) > 1.01 * min(sides):
        reasons.append(
            Message(
                "The grids differ ({grids}): part of the difference may be discretisation error. "
                "Compute all with --quick or all without.",
                grids=[
                    Message("{letter} {side:.3g} mm", letter=letter, side=side * 1e3)
                    for letter, side in zip(LETTERS, sides, strict=False)
                ],
            )
        )
    versions = {result.provenance.versions.get("underfoot", "") for result in results}
    if len(versions) > 1:
        reasons.append(
            Message("Computed with different versions: {versions}.", versions=sorted(versions))
        )
    for letter, result in zip(LETTERS, results, strict=False):
        if result.status.usable and result.breaches:
            reasons.append(Remark.of(letter, summary.beyond_tests(subjects(result.breaches))))
    return tuple(reasons)


def _chance(probability: float | None) -> str:
    return "" if probability is None else drawn_probability_text(probability)


def _interval(ends: tuple[float, float]) -> Message:
    return Message("{low:.3f} to {high:.3f}", low=ends[0], high=ends[1])


def with_short_names(rows: Sequence[tuple[str, ...]]) -> list[tuple[str, ...]]:
    """Return rows with files by their names; a checksum only where the names do not tell.

    Result files keep both in full.
    """
    files = next((row[1:] for row in rows if row[0] == _FILE), ())
    names = [Path(file).name for file in files]
    told = bool(files) and len(set(names)) == len(set(files))
    short: list[tuple[str, ...]] = []
    for path, *values in rows:
        if path == _FILE and told:
            short.append((path, *names))
        elif path != _CHECKSUM or not told:
            short.append((path, *(v[:8] if path == _CHECKSUM else v for v in values)))
    return short


def _shorten_cell(text: str) -> str:
    return text if len(text) <= LONGEST_CELL else f"…{text[1 - LONGEST_CELL :]}"
