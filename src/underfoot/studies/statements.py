"""Printed statements as data: what a publication says, and what counts as agreeing with it.

``STUDY.toml`` beside the module of a study holds one table for each statement. Its accepted
interval follows from what is printed (digits, scatter, number of persons) and is fixed before
anything is computed.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any

from underfoot.core import InputError, to_si, unknown_name
from underfoot.core.files import read_toml
from underfoot.core.registry import find_offer, offers

Z95 = 1.959963984540054
OURS = ("g1", "g2", "g3", "g4", "g5", "g6", "calibration", "corpus")
"""Studies of this package, each a module of this room."""
KEYS = (
    "id text place claim printed shown unit tolerance reason count deviation effect quantity kind "
    "of not_comparable remark remarks alternatives resolution quick_error"
).split()
"""Of a statement's table."""
UNITS = {
    "": (1.0, "1"),
    "%": (1e-2, "1"),
    "N": (1.0, "N"),
    "kPa": (1e3, "Pa"),
    "m/s": (1.0, "m/s"),
    "ms": (1e-3, "s"),
    "mm": (1e-3, "m"),
    "kPa/mm": (1e6, "Pa/m"),
    "kPa per m/s": (1e3, "Pa*s/m"),
    "deg": (math.pi / 180.0, "rad"),
}
"""SI over a printed unit, and the SI unit."""


class StatementKind(StrEnum):
    """What a statement is worth as evidence; only independent ones are counted."""

    INDEPENDENT = "independent"
    RESTATES = "restates"
    AGAINST_ITSELF = "report_against_itself"
    OWN_GOAL = "own_goal"
    CALIBRATED_ON = "calibrated_on"
    ALTERNATIVE = "alternative"

    @property
    def heading(self) -> str:
        """Return the heading of the table of such statements."""
        return {
            StatementKind.INDEPENDENT: "Independent statements",
            StatementKind.RESTATES: "The same readings in other words",
            StatementKind.AGAINST_ITSELF: "The report's numbers against each other",
            StatementKind.OWN_GOAL: "Goals of this project; the report prints no number",
            StatementKind.CALIBRATED_ON: "Readings that a parameter was chosen on",
            StatementKind.ALTERNATIVE: "The same statements with a model or parameters "
            "other than the default",
        }[self]


class Claim(StrEnum):
    """The form of what is printed."""

    VALUE = "value"
    RANGE = "range"
    BELOW = "below"
    ABOVE = "above"
    RISES = "rises"
    FALLS = "falls"
    ORDER = "order"
    WORDS = "words"


@dataclass(frozen=True, slots=True)
class Statement:
    """One printed statement.

    Parameters:
        study, id: Together its name, as "g4.load_athletic".
        text, place: What it is about, and where it is printed (section, figure, table).
        claim, printed: Its form, and what a reader sees.
        names: Of an order: highest first.
        unit, factor, si_unit: As printed; SI = printed x factor.
        accepted: Interval that agrees (SI), from printed value and tolerance; sign and bounds are
            half-lines.
        tolerance, tolerance_reason: Half width (SI; 0 of a bound) and where it comes from.
        effect: +1 or -1 where the number is a change of which zero means no effect; 0 elsewhere.
        quick_error: (share of the value, SI) that the one grid of a quick run may be off by, the
            larger of both; () where it is not known.
        quantity: Name of ours in the study's result.
        kind, of: What it is worth; the statement that it restates or is an alternative of.
        not_comparable: Why nothing computed can stand beside it; "" where something does.
        remark: What a reader should know about the cause.
    """

    study: str
    id: str
    text: str
    place: str
    claim: Claim
    printed: str
    names: tuple[str, ...]
    unit: str
    factor: float
    si_unit: str
    accepted: tuple[float, float]
    tolerance: float
    tolerance_reason: str
    effect: int
    quick_error: tuple[float, float] | tuple[()]
    quantity: str
    kind: StatementKind
    of: str
    not_comparable: str
    remark: str

    @property
    def name(self) -> str:
        """Study and id."""
        return f"{self.study}.{self.id}"

    def quick_error_of(self, value: float) -> float:
        """Return what the one grid of a quick run may be off by, SI."""
        share, least = self.quick_error or (math.nan, math.nan)
        return max(share * abs(value), least)

    @property
    def half_scale(self) -> float:
        """Half of the scale on which ours is judged (SI): 50 points of a share, else the printed
        value's size; without end for a sign."""
        if self.claim in (Claim.RISES, Claim.FALLS, Claim.ORDER):
            return math.inf
        if self.unit == "%" and not self.effect:
            return 0.5
        return max(abs(end) for end in self.accepted if math.isfinite(end))


@dataclass(frozen=True, slots=True)
class PublishedStudy:
    """One publication that can be run again, with everything that is fixed before a run.

    ``errata`` are (where, printed, used, why); ``figures`` are (number in the publication, what it
    shows, our file or "", remark).
    """

    name: str
    title: str
    source: str
    statements: tuple[Statement, ...]
    assumptions: tuple[str, ...]
    notes: tuple[str, ...]
    errata: tuple[tuple[str, str, str, str], ...]
    figures: tuple[tuple[int, str, str, str], ...]


def studies() -> tuple[str, ...]:
    """Return the names of all studies: ours in their order, then those of other packages."""
    return (*OURS, *sorted(offers("studies").keys() - set(OURS)))


def study_module(name: str) -> Any:
    """Return the module of a study: its ``STATEMENTS`` and ``compute``.

    Raises:
        InputError: No study has the name.
    """
    if name in OURS:
        return import_module(f".{name}", __package__)
    if (module := find_offer("studies", name)) is None:
        raise unknown_name("study", name, studies())
    return module


@cache
def study(name: str) -> PublishedStudy:
    """Return a study by its name; an unknown name is answered with the nearest one."""
    chosen = name.strip().lower()
    return read_study(chosen, read_toml(Path(study_module(chosen).STATEMENTS)))


def read_study(name: str, content: Mapping[str, Any]) -> PublishedStudy:
    """Return a study from the content of its file.

    Raises:
        InputError: A statement without tolerance or reason, an unknown kind or claim, a reference
            to a statement that is not there, two independent statements on one quantity.
    """
    statements = []
    quick = {"quick_error": content["quick_error"]} if "quick_error" in content else {}
    for table in content.get("statement", ()):
        table = quick | table
        statements.append(_statement(name, table))
        for label, path in table.get("alternatives", {}).items():
            other = {
                **{key: table[key] for key in table if key not in ("alternatives", "kind", "of")},
                "id": f"{table['id']}_{label}",
                "text": f"{table['text']} ({label.replace('_', ' ')})",
                "quantity": path,
                "kind": "alternative",
                "of": table["id"],
                "remark": table.get("remarks", {}).get(label, table.get("remark", "")),
            }
            statements.append(_statement(name, other))
    _check(name, statements)
    return PublishedStudy(
        name,
        content["title"],
        content["source"],
        tuple(statements),
        tuple(content.get("assumptions", ())),
        tuple(content.get("notes", ())),
        tuple((e["where"], e["printed"], e["used"], e["why"]) for e in content.get("erratum", ())),
        tuple(
            (f["number"], f["shows"], f.get("file", ""), f.get("remark", ""))
            for f in content.get("figure", ())
        ),
    )


def _check(study_name: str, statements: Sequence[Statement]) -> None:
    """Refuse what would let one reading count twice."""
    ids = [statement.id for statement in statements]
    read: dict[str, str] = {}
    for statement in statements:
        where = f"statements/{study_name}.toml, {statement.id}"
        if ids.count(statement.id) > 1:
            raise InputError("two statements have this id", where=where)
        if statement.kind in (StatementKind.RESTATES, StatementKind.ALTERNATIVE):
            other, _, rest = statement.of.partition(".")
            if not rest and statement.of not in ids:
                raise unknown_name("statement", statement.of or "(none)", ids, where=f"{where}.of")
            if rest and other not in studies():
                raise unknown_name("study", other, studies(), where=f"{where}.of")
        if statement.kind is StatementKind.INDEPENDENT and statement.quantity:
            if statement.quantity in read:
                raise InputError(
                    f"reads {statement.quantity}, as {read[statement.quantity]} does",
                    where=where,
                    remedy='Mark it kind = "restates", of = "..."; a reading counts once',
                )
            read[statement.quantity] = statement.id


def _statement(study_name: str, table: Mapping[str, Any]) -> Statement:
    where = f"statements/{study_name}.toml, {table.get('id', '?')}"
    for key in table:
        if key not in KEYS:
            raise unknown_name("key of a statement", key, KEYS, where=where)
    try:
        claim, kind = Claim(table["claim"]), StatementKind(table.get("kind", "independent"))
    except ValueError as error:
        raise InputError(str(error), where=where) from error
    none = table.get("not_comparable", "")
    if not none and not table.get("quantity"):
        raise InputError("no computed quantity", where=where, allowed="quantity or not_comparable")
    printed, unit = table.get("printed", ""), table.get("unit", "")
    numbers: tuple[float, ...] = ()
    names: tuple[str, ...] = ()
    if unit not in UNITS:
        raise unknown_name("unit", unit, UNITS, where=f"{where}.unit")
    factor, si_unit = UNITS[unit]
    if claim is Claim.ORDER:
        names = tuple(printed)
    elif claim in (Claim.VALUE, Claim.RANGE, Claim.BELOW, Claim.ABOVE):
        texts = printed if isinstance(printed, list) else [printed]
        if len(texts) != (2 if claim is Claim.RANGE else 1):
            raise InputError(f"{printed!r}", where=f"{where}.printed")
        numbers = tuple(float(text) * factor for text in texts)
        if claim is Claim.RANGE and numbers[0] > numbers[1]:
            raise InputError(f"{printed}", where=f"{where}.printed", allowed="lowest first")
    below, above, reason = 0.0, 0.0, ""
    if not none and claim is not Claim.WORDS:
        below, above, reason = _tolerance(claim, printed, numbers, factor, table, where)
    return Statement(
        study_name,
        table["id"],
        table["text"],
        table["place"],
        claim,
        table.get("shown") or _claim_text(claim, printed, unit, table.get("deviation")),
        names,
        unit,
        factor,
        si_unit,
        _accepted_range(claim, numbers, below, above),
        max(below, above),
        reason,
        round(math.copysign(1, sum(numbers))) if table.get("effect") else 0,
        _quick_error(table.get("quick_error", ()), factor, where),
        table.get("quantity", ""),
        kind,
        table.get("of", ""),
        none,
        table.get("remark", ""),
    )


def _quick_error(given: Any, factor: float, where: str) -> tuple[float, float] | tuple[()]:
    """Return (share, SI) of ``["10 %", 5]`` (a share, and a number in the printed unit)."""
    if not given:
        return ()
    share, least = given
    return to_si(share, "1", where=f"{where}.quick_error"), float(least) * factor


def _tolerance(
    claim: Claim,
    printed: Any,
    numbers: Sequence[float],
    factor: float,
    table: Mapping[str, Any],
    where: str,
) -> tuple[float, float, str]:
    """Return tolerance below and above (SI) and reason, by what the statement names.

    "digits": half of the last printed digit. "mean": 95 % of a mean of ``count`` values with the
    printed ``deviation``. "share", "correlation": exact binomial and Fisher's 95 % interval of a
    share or correlation of ``count``.
    """
    given, reason = table.get("tolerance", ""), table.get("reason", "")
    count = int(table.get("count", 0))
    if claim in (Claim.RISES, Claim.FALLS, Claim.ORDER):
        limit = float(table.get("resolution", 0.0)) * factor
        if limit <= 0.0:
            raise InputError(
                "no smallest difference",
                where=f"{where}.resolution",
                allowed="above 0, in the printed unit: what is smaller is a tie",
            )
        least = f"by sign; below {table['resolution']} {table.get('unit', '')}".rstrip()
        return limit, limit, reason or f"{least} is a tie"
    if given == "digits":
        texts = printed if isinstance(printed, list) else [printed]
        ends = [0.5 * 10.0 ** -len(re.sub(r"^[^.]*\.?", "", str(text))) * factor for text in texts]
        return ends[0], ends[-1], reason or "half of the last printed digit"
    if given == "mean" and count > 1:
        half = Z95 * float(table["deviation"]) * factor / math.sqrt(count)
        return half, half, reason or f"95 % of a mean of {count} by the printed scatter"
    if given == "share" and count > 0:
        from scipy.stats import binomtest

        low, high = binomtest(round(numbers[0] * count), count).proportion_ci(0.95)
        text = reason or f"95 % of a share of {count}"
        return numbers[0] - float(low), float(high) - numbers[0], text
    if given == "correlation" and count > 3:
        z, half = math.atanh(numbers[0]), Z95 / math.sqrt(count - 3)
        text = reason or f"95 % of a correlation of {count} (Fisher)"
        return numbers[0] - math.tanh(z - half), math.tanh(z + half) - numbers[0], text
    if isinstance(given, str) and given.endswith("%") and reason:
        half = abs(numbers[0]) * to_si(given, "1", where=f"{where}.tolerance")
        return half, half, f"{given}: {reason}"
    if isinstance(given, int | float) and reason:
        return float(given) * factor, float(given) * factor, reason
    raise InputError(
        f"tolerance {given!r}, reason {reason!r}",
        where=where,
        allowed='"digits", "mean", "share" or "correlation" (with count), or a number in the '
        'printed unit or as "15 %" with its reason',
    )


def _accepted_range(
    claim: Claim, numbers: Sequence[float], below: float, above: float
) -> tuple[float, float]:
    match claim:
        case Claim.VALUE | Claim.RANGE if numbers:
            return numbers[0] - below, numbers[-1] + above
        case Claim.BELOW if numbers:
            return -math.inf, numbers[0] + above
        case Claim.ABOVE if numbers:
            return numbers[0] - below, math.inf
        case Claim.RISES | Claim.ORDER:
            return above, math.inf
        case Claim.FALLS:
            return -math.inf, -below
        case _:
            return math.nan, math.nan


def _claim_text(claim: Claim, printed: Any, unit: str, deviation: Any) -> str:
    tail = f" {unit}" if unit else ""
    match claim:
        case Claim.ORDER:
            return " > ".join(printed)
        case Claim.RANGE:
            return f"{printed[0]} to {printed[1]}{tail}"
        case Claim.BELOW | Claim.ABOVE:
            return f"{claim} {printed}{tail}"
        case Claim.RISES | Claim.FALLS:
            return str(claim)
        case Claim.VALUE if deviation is not None:
            return f"{printed} ± {deviation}{tail}"
        case _:
            return f"{printed}{tail}"
