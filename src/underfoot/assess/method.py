"""A case under the set-up of a test method: predicted COF and the probability of passing."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from underfoot.core import InputError, Progress, SourcedValue, display, silent, unknown_name

from .outcomes import Outcome, outcomes
from .sensitivity import Band, Sensitivity, sensitivity, variants

if TYPE_CHECKING:
    from underfoot.case import Case
    from underfoot.core.catalogue import Entry
    from underfoot.core.leaves import Leaf

_Z95 = 1.959963984540054
AS_IN_CASE = "as in the case"
NICKNAMES = {
    "iso13287": "en_iso_13287",
    "iso_13287": "en_iso_13287",
    "en13287": "en_iso_13287",
    "f2913": "astm_f2913",
    "astmf2913": "astm_f2913",
    "report_slip_tester": "slip_tester_g4",
    "report_whole_shoe": "whole_shoe_g6",
}
KEEPABLE = ("floor", "contaminant", "normal_force", "shoe_angle", "speed")


@dataclass(frozen=True, slots=True)
class Requirement:
    """One thing that the method prescribes, what was used, and how sure its source is."""

    name: str
    required: str
    used: str
    mark: str


@dataclass(frozen=True, slots=True)
class Condition:
    """One floor and fluid of the method with the COF predicted for it.

    ``cof`` is the mean over the method's averaging window with the standard deviation of the
    friction law and of the open inputs; ``low`` and ``high`` bound 95 % of it. ``probability`` is
    that of ``cof`` at or above ``limit``; None where the method sets no limit or where the COF was
    not determined.
    """

    name: str
    title: str
    floor: str
    contaminant: str
    cof: SourcedValue
    low: float | None
    high: float | None
    limit: SourcedValue | None
    probability: float | None
    band: Band | None
    outcome: Outcome
    window: tuple[Outcome, ...]


@dataclass(frozen=True, slots=True)
class MethodPrediction:
    """What a test by the method would give."""

    method: str
    title: str
    source: str
    note: str
    requirements: tuple[Requirement, ...]
    conditions: tuple[Condition, ...]


def method_names(case: Case) -> list[str]:
    """Return the set-ups of the catalogue that a case can be tested by."""
    names = case.catalogue.names("setup")
    entries = [case.catalogue.entry("setup", name).values for name in names]
    return [
        name
        for name, values in zip(names, entries, strict=True)
        if "motion.speed" in values and any(path.startswith("method.") for path in values)
    ]


def method_name(given: str, case: Case) -> str:
    """Return the set-up that a person means: ``iso13287``, ``report-slip-tester`` ..."""
    plain = given.strip().lower().replace("-", "_").replace(" ", "_")
    plain = NICKNAMES.get(plain, plain)
    known = method_names(case)
    if plain not in known:
        raise unknown_name("test method", given, known, where="--method")
    return plain


def predict(
    case: Case,
    method: str,
    *,
    keep: Sequence[str] = (),
    with_band: bool = True,
    quick: bool = False,
    processes: int | None = 1,
    progress: Progress = silent,
) -> MethodPrediction:
    """Return the COF that a test method would find for the shoe of a case.

    Parameters
    ----------
    case
        Shoe and models; floor, fluid and motion as far as the method leaves them open.
    method
        Name of a set-up in the catalogue, see ``method_name``.
    keep
        What of the case stands against the method: any of ``KEEPABLE``; each is listed as a
        departure from it.
    with_band
        Vary the open inputs too (two quick runs each); without it the spread is that of the
        friction law alone.
    quick
        The coarse grid for the prediction itself.

    Notes
    -----
    The mean over the averaging window is Simpson's rule on its beginning, middle and end. The
    probability of passing takes the COF as normally distributed.

    Errors
    ------
    InputError
        An unknown method, a case without what the method leaves open.
    """
    for name in keep:
        if name not in KEEPABLE:
            raise unknown_name("part of the case to keep", name, KEEPABLE, where="--keep")
    entry = case.catalogue.entry("setup", method_name(method, case))
    plan = [
        (name, *_prepared(case, entry, floor, fluid, keep))
        for name, floor, fluid in _conditions(entry)
    ]
    times = _window(entry)
    batches = [
        [one.replace("motion.duration", f"{time!r} s") for time in times] or [one]
        for _, one, _ in plan
    ]
    found = outcomes(
        [each for batch in batches for each in batch],
        quick=quick,
        processes=processes,
        progress=progress,
        stage="Testing by the method",
    )
    conditions, requirements = [], []
    width = len(batches[0])
    for number, (name, changed, listed) in enumerate(plan):
        window = tuple(found[number * width : (number + 1) * width])
        effects = _effects(changed, processes, progress) if with_band else None
        conditions.append(_condition(entry, name, changed, window, effects))
        if len(plan) > 1:  # floor and fluid differ from condition to condition
            listed = [
                replace(one, name=f"{one.name}, {name.replace('_', ' ')}")
                if one.name in ("floor", "contaminant")
                else one
                for one in listed
            ]
        requirements += [one for one in listed if one not in requirements]
    if times:
        requirements.append(_window_words(entry, times))
    return MethodPrediction(
        entry.name,
        entry.title,
        entry.values["motion.speed"].source,
        entry.note,
        tuple(requirements),
        tuple(conditions),
    )


def _effects(case: Case, processes: int | None, progress: Progress) -> Sensitivity:
    if not variants(case):
        raise InputError("no open input to vary", where="sensitivity")
    return sensitivity(case, quick=True, processes=processes, progress=progress)


def _conditions(entry: Entry) -> list[tuple[str, Leaf | None, Leaf | None]]:
    """Return name, floor and fluid of each condition; one without either where none is set."""
    listed = entry.under("conditions")
    names = list(dict.fromkeys(path.partition(".")[0] for path in listed))
    if not names:
        return [(AS_IN_CASE, None, None)]
    return [
        (name, listed.get(f"{name}.floor"), listed.get(f"{name}.contaminant")) for name in names
    ]


def _prepared(
    case: Case, entry: Entry, floor: Leaf | None, fluid: Leaf | None, keep: Sequence[str]
) -> tuple[Case, list[Requirement]]:
    """Return the case under the method, and what the method asked for."""
    own = case.motion
    changes: dict[str, object] = {"motion": entry.name}
    if any(path.startswith("sensor.") for path in entry.values):
        changes["sensor"] = entry.name
    listed = []
    for section, leaf in (("floor", floor), ("contaminant", fluid)):
        present = case.entries.get(section, "given in the case")
        if section == "contaminant" and case.contaminant is None:
            present = "none: dry"
        if leaf is None:
            asked = entry.values.get(f"method.{section}")
            words = "as agreed" if asked is None else str(asked.given)
            listed.append(Requirement(section, words, f"{present} (of the case)", "left open"))
        elif section in keep:
            listed.append(Requirement(section, str(leaf.given), f"{present} (kept)", "departs"))
        else:
            changes[section] = str(leaf.given)
            listed.append(Requirement(section, str(leaf.given), "as required", _mark(leaf)))
    changed = case.replace(changes)
    kept = {
        name: f"{getattr(own, name)!r} {unit}"
        for name, unit in (("normal_force", "N"), ("shoe_angle", "rad"), ("speed", "m/s"))
        if name in keep
    }
    if kept:
        changed = changed.replace({f"motion.{name}": value for name, value in kept.items()})
    for name, unit in (("shoe_angle", "rad"), ("normal_force", "N"), ("speed", "m/s")):
        leaf = entry.values[f"motion.{name}"]
        used = display(getattr(changed.motion, name), unit)
        listed.append(
            Requirement(
                name.replace("_", " "),
                f"{leaf.given}" + (f" ({leaf.note})" if leaf.note else ""),
                f"{used} (kept)" if name in keep else "as required",
                "departs" if name in keep else _mark(leaf),
            )
        )
    return changed, listed


def _window(entry: Entry) -> tuple[float, ...]:
    """Return beginning, middle and end of the averaging window after first contact, s."""
    if "method.averaging_end" not in entry.values:
        return ()
    begin = float(entry.sourced("method.averaging_start", "s").value or 0.0)
    end = float(entry.sourced("method.averaging_end", "s").value or 0.0)
    if entry.text("method.averaging_from") == "force":
        rise = float(entry.sourced("motion.force_rise_time", "s").value or 0.0)
        begin, end = begin + rise, end + rise
    return begin, 0.5 * (begin + end), end


def _window_words(entry: Entry, times: tuple[float, ...]) -> Requirement:
    leaf = entry.values["method.averaging_end"]
    shown = f"{display(times[0], 's')} to {display(times[-1], 's')} after first contact"
    return Requirement("averaging window", shown, "mean by Simpson's rule", _mark(leaf))


def _mark(leaf: Leaf) -> str:
    if leaf.assumed:
        return "assumed"
    return leaf.source + ("" if leaf.verified else " (from memory, not verified)")


def _condition(
    entry: Entry, name: str, case: Case, window: tuple[Outcome, ...], effects: Sensitivity | None
) -> Condition:
    middle = window[len(window) // 2]
    limit = None
    if f"limits.{name}" in entry.values:
        limit = entry.sourced(f"limits.{name}", "1")
    title = name.replace("_", " ")
    if f"conditions.{name}.title" in entry.values:
        title = entry.text(f"conditions.{name}.title")
    band = effects.band("cof") if effects is not None and effects.nominal.usable else None
    failed = next((one for one in window if not one.usable), None)
    if failed is not None:
        cof = SourcedValue(None, "1", reason=str(failed.status))
        low = high = probability = None
    else:
        values = [one.number("cof") for one in window]
        mean = values[0] if len(values) == 1 else (values[0] + 4 * values[1] + values[2]) / 6
        law = middle.spread("cof")
        deviation = math.hypot(0.0 if math.isnan(law) else law, band.inputs if band else 0.0)
        cof = SourcedValue(
            mean,
            "1",
            source=middle.scalars["cof"].source,
            uncertainty=deviation,
            note="friction law and open inputs" if band else "friction law alone",
        )
        low, high = max(mean - _Z95 * deviation, 0.0), mean + _Z95 * deviation
        probability = None
        if limit is not None and limit.value is not None:
            probability = probability_at_least(mean, deviation, limit.value)
    return Condition(
        name,
        title,
        case.entries.get("floor", "given in the case"),
        case.entries.get("contaminant", "given in the case" if case.contaminant else "none: dry"),
        cof,
        low,
        high,
        limit,
        probability,
        band,
        middle,
        window,
    )


def probability_at_least(mean: float, deviation: float, limit: float) -> float:
    """Return P(X >= limit) of a normal X; a step where the deviation is zero."""
    if deviation == 0:
        return 1.0 if mean >= limit else 0.0
    return 0.5 * math.erfc((limit - mean) / (deviation * math.sqrt(2.0)))
