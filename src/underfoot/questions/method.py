"""Predicted COF of a case by a standard test method, and the probability of passing."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from enum import StrEnum
from typing import TYPE_CHECKING, Any, ClassVar

from underfoot.compute import summary
from underfoot.core import InputError, Progress, SourcedValue, display, silent, unknown_name
from underfoot.core.presentation import Presentable, Table, drawn_probability_text, value_text
from underfoot.core.progress import part
from underfoot.core.remark import Amount, Message, Remark, subjects
from underfoot.slip import MODELS

from .ask import ask
from .outcomes import CaseOutcome, outcomes
from .sensitivity import Band, Sensitivity, sensitivity, variants

if TYPE_CHECKING:
    from underfoot.case import Case
    from underfoot.core.catalogue import Entry
    from underfoot.core.leaves import Leaf

_Z95 = 1.959963984540054
AS_IN_CASE = "as in the case"
METHODS = (("iso13287", "en_iso_13287"), ("astmf2913", "astm_f2913"))
PARTS = ("forepart", "flat")
NICKNAMES = {
    "iso13287": "en_iso_13287",
    "iso_13287": "en_iso_13287",
    "en13287": "en_iso_13287",
    "f2913": "astm_f2913",
    "astmf2913": "astm_f2913",
    **{f"{short}_{part}": f"{name}_{part}" for short, name in METHODS for part in PARTS},
    "report_slip_tester": "slip_tester_g4",
    "report_whole_shoe": "whole_shoe_g6",
}
KEEPABLE = ("floor", "contaminant", "normal_force", "shoe_angle", "speed")


class Basis(StrEnum):
    """How sure a requirement of a method is, or what was used in its place."""

    VERIFIED = "verified"
    FROM_MEMORY = "from memory, not verified"
    ASSUMED = "assumed"
    OPEN = "left open by the method"
    DEPARTURE = "departs from the method"


@dataclass(frozen=True, slots=True)
class MethodRequirement:
    """One thing that the method prescribes, what was used, and how sure its source is."""

    name: str
    required: str
    used: str
    basis: Basis
    source: str = ""


@dataclass(frozen=True, slots=True)
class MethodCondition:
    """One floor and fluid of the method with the COF predicted for it.

    ``cof`` is that of steady sliding, as the method's averaging window takes it, or of the instant
    that the method sets, with the standard deviation of the friction law and of the open inputs;
    ``low`` and ``high`` bound 95 % of it. ``probability`` is that of ``cof`` at or above ``limit``;
    None where the method sets no limit, where the COF was not determined, and with ``low`` and
    ``high`` where the spread of the law is not known.
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
    outcome: CaseOutcome

    @property
    def breaches(self) -> list[Remark]:
        """Return what left a tested range; that of a slip model is no matter of a method."""
        return [breach for breach in self.outcome.breaches if breach.about not in MODELS]

    @property
    def sentence(self) -> Message:
        """The COF with its interval, and how likely it passes."""
        values: dict[str, Any] = {"title": self.title, "reason": self.cof.reason}
        if self.cof.value is None:
            return Message("{title}: not determined: {reason}.", **values)
        values["cof"] = self.cof.value
        if self.low is None:
            return Message("{title}: COF {cof:.3f}; no interval: {reason}.", **values)
        passing = Message("the method sets no limit")
        if self.probability is not None and self.limit is not None:
            passing = Message(
                "probability of at least {limit:g} is {chance}",
                limit=self.limit.value, chance=drawn_probability_text(self.probability),
            )  # fmt: skip
        values |= {"low": self.low, "high": self.high, "note": self.cof.note, "passing": passing}
        del values["reason"]
        return Message(
            "{title}: COF {cof:.3f} (95 %: {low:.2f} to {high:.2f}; {note}); {passing}.", **values
        )


@dataclass(frozen=True, slots=True)
class MethodPrediction(Presentable):
    """Prediction of a test by the method, one condition after the other."""

    kind: ClassVar[str] = "test"

    name: str
    method: str
    title: str
    source: str
    note: str
    requirements: tuple[MethodRequirement, ...]
    conditions: tuple[MethodCondition, ...]

    def __repr__(self) -> str:
        return f"<MethodPrediction of {self.name!r} by {self.method}>"

    @property
    def usable(self) -> bool:
        return all(condition.outcome.usable for condition in self.conditions)

    def heading(self) -> str:
        return Message("{name} by {title}", name=self.name, title=self.title)

    def headline(self) -> tuple[Message, ...]:
        return tuple(condition.sentence for condition in self.conditions)

    def cautions(self) -> tuple[Message, ...]:
        reasons: list[Message] = []
        unsure = [
            requirement.name
            for requirement in self.requirements
            if requirement.basis is not Basis.VERIFIED
        ]
        if unsure:
            reasons.append(
                Message(
                    "{unsure} of {count} settings are not verified against the printed method or "
                    "depart from it; see the table.",
                    unsure=len(unsure), count=len(self.requirements),
                )
            )  # fmt: skip
        if models := subjects(self._breaches()):
            reasons.append(summary.beyond_tests(models))
        return tuple(reasons)

    def table(self) -> Table:
        rows = [
            (
                condition.title,
                condition.floor,
                condition.contaminant,
                value_text("cof", condition.cof)
                if condition.cof.value is None
                else f"{condition.cof.value:.3f}",
                ""
                if condition.low is None
                else Message("{low:.2f} to {high:.2f}", low=condition.low, high=condition.high),
                "none" if condition.limit is None else f"{condition.limit.value:g}",
                ""
                if condition.probability is None
                else drawn_probability_text(condition.probability),
            )
            for condition in self.conditions
        ]
        heads = ("Condition", "Floor", "Contaminant", "COF", "95 %", "Limit")
        return Table("Prediction", (*heads, "Probability of passing"), rows)

    def tables(self) -> tuple[Table, ...]:
        rows = [
            (
                requirement.name,
                requirement.required,
                requirement.used,
                Message("{basis} ({source})", basis=requirement.basis, source=requirement.source)
                if requirement.source
                else str(requirement.basis),
            )
            for requirement in self.requirements
        ]
        settings = Table("Settings of the method", ("Setting", "Required", "Used", "Basis"), rows)
        return self.table(), settings

    def remarks(self) -> dict[str, Sequence[str]]:
        notes = (self.note,) if self.note else ()
        return {
            "Notes": notes,
            "Outside the tested range": self._breaches(),
            "Assumptions": list(
                dict.fromkeys(
                    line for condition in self.conditions for line in condition.outcome.assumptions
                )
            ),
        }

    def to_dict(self) -> dict[str, Any]:
        return {
            "method": self.method,
            "title": self.title,
            "source": self.source,
            "requirements": [asdict(requirement) for requirement in self.requirements],
            "conditions": [
                {
                    "name": condition.name,
                    "title": condition.title,
                    "floor": condition.floor,
                    "contaminant": condition.contaminant,
                    "cof": condition.cof.to_dict(),
                    "interval_95": [condition.low, condition.high],
                    "limit": None if condition.limit is None else condition.limit.to_dict(),
                    "probability_of_passing": condition.probability,
                    "status": str(condition.outcome.status),
                    "breaches": condition.breaches,
                    "assumptions": list(condition.outcome.assumptions),
                }
                for condition in self.conditions
            ],
        }

    def data_tables(self) -> dict[str, Table]:
        heads = (
            "condition floor contaminant cof uncertainty low high limit limit_source "
            "probability_of_passing status".split()
        )
        rows = [
            (
                condition.title,
                condition.floor,
                condition.contaminant,
                condition.cof.value,
                condition.cof.uncertainty,
                condition.low,
                condition.high,
                condition.limit and condition.limit.value,
                condition.limit and condition.limit.source,
                condition.probability,
                str(condition.outcome.status),
            )
            for condition in self.conditions
        ]
        required = [tuple(asdict(requirement).values()) for requirement in self.requirements]
        names = ("requirement", "required", "used", "basis", "source")
        return {
            "conditions": Table("", tuple(heads), rows),
            "requirements": Table("", names, required),
        }

    def _breaches(self) -> list[Remark]:
        return list(dict.fromkeys(b for condition in self.conditions for b in condition.breaches))


def method_name(name: str, case: Case) -> str:
    """Return the set-up that a person means: ``iso13287``, ``report-slip-tester`` ..."""
    plain = name.strip().lower().replace("-", "_").replace(" ", "_")
    plain = NICKNAMES.get(plain, plain)
    entries = [case.catalogue.entry("setup", known) for known in case.catalogue.names("setup")]
    asked = {"motion.speed", "method.question"}
    known = [
        entry.name for entry in entries if asked & entry.values.keys() and entry.under("method")
    ]
    if plain not in known:
        raise unknown_name("test method", name, known, where="--method")
    return plain


def method_prediction(
    case: Case,
    method: str,
    *,
    keep: Sequence[str] = (),
    with_band: bool = True,
    quick: bool = False,
    processes: int | None = 1,
    progress: Progress = silent,
) -> Presentable:
    """Return the COF that a test method would measure on the shoe of a case.

    Of a set-up with ``method.question``, as machines that read floors, what its package answers.

    Parameters:
        case: Shoe and models; floor, fluid and motion as far as the method leaves them open.
        method: Name of a set-up in the catalogue, see ``method_name``.
        keep: Parts of the case to keep against the method: any of ``KEEPABLE``; each is listed as a
            departure from it.
        with_band: Vary the open inputs too (two quick runs each); without it the spread is that of
            the friction law alone.
        quick: The coarse grid for the prediction itself.

    An averaging window counts as steady sliding, unless the method sets the duration. The
    probability of passing takes ln COF as two halves of normal distributions, as wide as the
    interval is on either side.

    Raises:
        InputError: An unknown method, a case without what the method leaves open.
    """
    for name in keep:
        if name not in KEEPABLE:
            raise unknown_name("part of the case to keep", name, KEEPABLE, where="--keep")
    entry = case.catalogue.entry("setup", method_name(method, case))
    if "method.question" in entry.values:
        return ask(entry.text("method.question"), case, method=entry.name, keep=keep)
    plan = [
        (name, *_prepare_case(case, entry, floor, fluid, keep))
        for name, floor, fluid in _conditions(entry)
    ]
    share = 1.0 / (1 + len(plan)) if with_band else 1.0
    results = outcomes(
        [tested for _, tested, _ in plan],
        quick=quick,
        processes=processes,
        progress=part(progress, 0.0, share),
        stage="Testing by the method",
    )
    conditions, requirements = [], []
    for number, (name, tested, settings) in enumerate(plan):
        effects = None
        if with_band:
            if not variants(tested):
                raise InputError("no open input to vary", where="sensitivity")
            rest = part(progress, (number + 1) * share, (number + 2) * share)
            effects = sensitivity(tested, quick=True, processes=processes, progress=rest)
        conditions.append(_condition(entry, name, tested, results[number], effects))
        if len(plan) > 1:  # floor and fluid differ from condition to condition
            settings = [
                replace(setting, name=f"{setting.name}, {name.replace('_', ' ')}")
                if setting.name in ("floor", "contaminant")
                else setting
                for setting in settings
            ]
        requirements += [setting for setting in settings if setting not in requirements]
    if window := _window(entry):
        end = plan[0][1].motion.end_time
        used = "steady sliding" if end is None else Message("at {end}", end=Amount(end, "s"))
        leaf = entry.values["method.averaging_end"]
        requirements.append(_requirement("averaging window", window, used, leaf))
    return MethodPrediction(
        case.name,
        entry.name,
        entry.title,
        entry.values["motion.speed"].source,
        entry.note,
        tuple(requirements),
        tuple(conditions),
    )


def _conditions(entry: Entry) -> list[tuple[str, Leaf | None, Leaf | None]]:
    """Return name, floor and fluid of each condition; one without either where none is set."""
    listed = entry.under("conditions")
    names = dict.fromkeys(path.partition(".")[0] for path in listed) or (AS_IN_CASE,)
    return [
        (name, listed.get(f"{name}.floor"), listed.get(f"{name}.contaminant")) for name in names
    ]


def _prepare_case(
    case: Case, entry: Entry, floor: Leaf | None, fluid: Leaf | None, keep: Sequence[str]
) -> tuple[Case, list[MethodRequirement]]:
    """Return the case under the method, and what the method asked for."""
    changes: dict[str, object] = {"motion": entry.name}
    if any(path.startswith("sensor.") for path in entry.values):
        changes["sensor"] = entry.name
    settings = []
    for section, leaf in (("floor", floor), ("contaminant", fluid)):
        present = _present(case, section)
        if leaf is None:
            open_leaf = entry.values.get(f"method.{section}")
            required = "as agreed" if open_leaf is None else str(open_leaf.given)
            settings.append(
                MethodRequirement(
                    section,
                    required,
                    Message("{present} (of the case)", present=present),
                    Basis.OPEN,
                )
            )
        elif section in keep:
            used = Message("{present} (kept)", present=present)
            settings.append(MethodRequirement(section, str(leaf.given), used, Basis.DEPARTURE))
        else:
            changes[section] = str(leaf.given)
            settings.append(_requirement(section, str(leaf.given), "as required", leaf))
    if "method.sole" in entry.values and not has_whole_sole(case):
        raise InputError(
            "the sole is a heel piece",
            where="shoe.outsole.region" if case.shoe.heel is None else "shoe.heel.plan",
            allowed=f"a whole sole: {entry.title} loads more than the heel",
            remedy='Write plan = "sole" under [shoe.heel], or give the file of a whole sole',
        )
    changed = case.replace(changes)
    units = {"shoe_angle": "rad", "normal_force": "N", "speed": "m/s"}
    case_settings = {
        f"motion.{name}": f"{getattr(case.motion, name)!r} {unit}"
        for name, unit in units.items()
        if name in keep
    }
    if case_settings:
        changed = changed.replace(case_settings)
    for name, unit in units.items():
        leaf = entry.values[f"motion.{name}"]
        label = name.replace("_", " ")
        required = f"{leaf.given}" + (f" ({leaf.note})" if leaf.note else "")
        if name in keep:
            used = Message("{setting} (kept)", setting=Amount(getattr(changed.motion, name), unit))
            settings.append(MethodRequirement(label, required, used, Basis.DEPARTURE))
        else:
            settings.append(_requirement(label, required, "as required", leaf))
    return changed, settings


def has_whole_sole(case: Case) -> bool:
    """Return whether the case holds more of a sole than its heel."""
    if case.shoe.outsole is not None:
        return case.shoe.outsole.region != "heel"
    return case.shoe.heel is not None and case.shoe.heel.name == "sole"


def _present(case: Case, section: str) -> str:
    if getattr(case, section) is None:
        return "none"
    return case.entries.get(section, "given in the case")


def _window(entry: Entry) -> str:
    """Return the averaging window of a method; empty where it sets none."""
    if "method.averaging_end" not in entry.values:
        return ""
    begin, end = (
        display(float(entry.sourced_value(f"method.averaging_{name}", "s")), "s")
        for name in ("start", "end")
    )
    after = "the force is there" if entry.text("method.averaging_from") == "force" else "contact"
    return Message("{begin} to {end} after {after}", begin=begin, end=end, after=after)


def _requirement(name: str, required: str, used: str, leaf: Leaf) -> MethodRequirement:
    if leaf.assumed:
        return MethodRequirement(name, required, used, Basis.ASSUMED)
    basis = Basis.VERIFIED if leaf.verified else Basis.FROM_MEMORY
    return MethodRequirement(name, required, used, basis, leaf.source)


def _condition(
    entry: Entry, name: str, case: Case, outcome: CaseOutcome, effects: Sensitivity | None
) -> MethodCondition:
    limits, titled = f"limits.{name}", f"conditions.{name}.title"
    limit = entry.sourced_value(limits, "1") if limits in entry.values else None
    title = entry.text(titled) if titled in entry.values else name.replace("_", " ")
    band = effects.band("cof") if effects is not None and effects.nominal.usable else None
    low = high = probability = None
    if not outcome.usable:
        cof = SourcedValue(None, "1", reason=str(outcome.status))
    else:
        mean, law = outcome.number("cof"), outcome.scalars["cof"]
        inputs = band.inputs if band else 0.0
        cof = SourcedValue(
            mean,
            "1",
            source=law.source,
            uncertainty=None if law.uncertainty is None else math.hypot(law.uncertainty, inputs),
            reason=law.reason,
            note="friction law and open inputs" if band else "friction law alone",
        )
        if law.uncertainty is not None:
            # of ln COF, each side as wide as the interval of the run, and the open inputs
            below, above = (math.hypot(side, inputs / max(mean, 1e-9)) for side in _sides(law))
            low, high = mean * math.exp(-_Z95 * below), mean * math.exp(_Z95 * above)
            if limit is not None and limit.value:
                least = math.log(limit.value) - math.log(max(mean, 1e-9))
                probability = probability_at_least(0.0, below if least < 0 else above, least)
    floor, fluid = (_present(case, part) for part in ("floor", "contaminant"))
    return MethodCondition(name, title, floor, fluid, cof, low, high, limit, probability, band,
                     outcome)  # fmt: skip


def _sides(cof: SourcedValue) -> tuple[float, float]:
    """Return the standard deviation of ln COF below and above its value, by its interval."""
    value = max(float(cof), 1e-9)
    if cof.interval is None or cof.interval[0] <= 0:
        half = (cof.uncertainty or 0.0) / value
        return half, half
    low, high = cof.interval
    return max(math.log(value / low), 0.0) / _Z95, max(math.log(high / value), 0.0) / _Z95


def probability_at_least(mean: float, deviation: float, limit: float) -> float:
    """Return P(X >= limit) of a normal X; a step where the deviation is zero."""
    if deviation == 0:
        return 1.0 if mean >= limit else 0.0
    return 0.5 * math.erfc((limit - mean) / (deviation * math.sqrt(2.0)))
