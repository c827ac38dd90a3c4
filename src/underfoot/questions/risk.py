"""Slip probability of a case by every published model, and the effect of possible changes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from underfoot.compute.numbers import required_friction
from underfoot.compute.run import run
from underfoot.compute.summary import FrictionLimit, cautions, friction_limit, no_result
from underfoot.core import InputError, Progress, SourcedValue, silent
from underfoot.core.arrays import Array
from underfoot.core.presentation import (
    Presentable,
    Table,
    drawn_probability_text,
    is_wide,
    percent,
    probability_text,
    value_text,
)
from underfoot.core.progress import part
from underfoot.core.remark import NOTHING, Message
from underfoot.slip import MODELS, RcofPopulation, needed_acof, slip_model, slip_risk

from .changes import Change, possible_changes
from .effects import ChangeEffect, change_effects
from .outcomes import CaseOutcome

if TYPE_CHECKING:
    from underfoot.case import Case
    from underfoot.compute.result import Result
    from underfoot.slip import SlipModel

MOST_CHANGES = 3
APART = 0.1
"""Difference of two slip probabilities from which their models are said to differ."""
TOSS_UP = 0.05
"""Distance from one half up to which the chance of a higher COF tells nothing: two standard errors
of 400 draws."""
RARE = 0.2
"""Slip probability below which people read odds ("1 in 12 steps") more easily than percent."""


@dataclass(frozen=True, slots=True)
class ModelRisk:
    """Slip probability by one published model, and the ACOF it requires for the target.

    ``assumption`` is what sets the model apart.
    """

    name: str
    source: str
    assumption: str
    probability: float
    low: float | None
    high: float | None
    needed_acof: float | None


@dataclass(frozen=True, slots=True)
class RiskAssessment(Presentable):
    """Slip probability of a case, what limits its friction, and the effect of changes.

    ``missing_friction`` is the COF that is missing for the ``target`` probability, with a spread of
    the friction that grows with it: 0 where the slip probability meets the target, None where no
    friction does. ``slip_model`` is the name of the case's own.
    """

    kind: ClassVar[str] = "risk"

    name: str
    outcome: CaseOutcome
    models: tuple[ModelRisk, ...]
    limit: FrictionLimit
    target: float
    missing_friction: float | None
    changes: tuple[ChangeEffect, ...]
    slip_model: str = ""

    def __repr__(self) -> str:
        return f"<RiskAssessment of {self.name!r}: {self.outcome.scalars['slip_probability']}>"

    @property
    def usable(self) -> bool:
        return self.outcome.usable

    @property
    def best(self) -> list[ChangeEffect]:
        """Return the changes that reduce the slip probability, the most effective first.

        As a page prints it; COF must be more probably higher than lower, where it changes.
        """
        slip, present = "slip_probability", self.outcome.number("slip_probability")
        useful = [
            each
            for each in self.effective
            if each.number(slip) < present
            and not self._same_chance(each)
            and (not _sure(each) or (each.higher or 0.0) > 0.5 + TOSS_UP)
        ]
        return sorted(useful, key=lambda each: (each.number(slip), -each.number("cof")))

    @property
    def effective(self) -> list[ChangeEffect]:
        """Return the changes that were computed and do something."""
        return [change for change in self.changes if change.computed and self._moves(change)]

    @property
    def apart(self) -> list[ModelRisk]:
        """Return the models whose slip probability is another than that of the case's model.

        Or lies on the other side of the target: there friction is enough by one of both alone.
        """
        own, target = self.outcome.number("slip_probability"), self.target
        return [
            model
            for model in self.models
            if abs(model.probability - own) > APART
            or (model.probability > target) != (own > target)
        ]

    def headline(self) -> tuple[Message, ...]:
        if not self.usable:
            return (no_result(self.outcome.status),)
        scalars = self.outcome.scalars
        slip = scalars["slip_probability"]
        probability = self.outcome.number("slip_probability")
        rare = probability < RARE and not is_wide(slip.interval)
        sentence = Message(
            "Slip probability {slip}{extrapolated}{often} at an available COF of {cof}.",
            slip=value_text("slip_probability", slip), cof=value_text("cof", scalars["cof"]),
            extrapolated=Message(", extrapolated") if slip.note else NOTHING,
            often=Message(", {odds},", odds=odds(probability)) if rare else NOTHING,
        )  # fmt: skip
        target = percent(self.target)
        enough = Message(
            "Friction is sufficient for a slip probability below {target}.", target=target
        )
        if probability > self.target:
            enough = (
                Message(
                    "No COF gives a slip probability of {target} while so little is known of the "
                    "friction.",
                    target=target,
                )
                if self.missing_friction is None
                else Message(
                    "A slip probability of {target} needs a COF higher by {missing:.2f}.",
                    target=target, missing=self.missing_friction,
                )
            )  # fmt: skip
        return sentence, self.limit.sentence(), enough

    def cautions(self) -> tuple[str, ...]:
        outcome = self.outcome
        others = [
            Message(
                "Another model has {probability} for the same friction and people ({name}): "
                "{assumption:small}",
                probability=probability_text(risk.probability), name=risk.name,
                assumption=risk.assumption,
            )
            for risk in self.apart
        ]  # fmt: skip
        return (
            *cautions(
                *(outcome.status, outcome.scalars, outcome.breaches, outcome.assumptions),
                self.slip_model,
                outcome.labels,
            ),
            *others,
        )

    def change_sentences(self, most: int = MOST_CHANGES) -> list[Message]:
        """Return the most effective changes with the COF and probability they lead to."""
        chance = _chance(self.outcome.scalars["slip_probability"])
        lines = [
            Message(
                "{action}: COF {before:.2f} to {after:.2f}, slip probability {chance} to "
                "{changed}{extrapolated}{sure}",
                action=each.change.action, before=self.outcome.number("cof"),
                after=each.number("cof"), chance=chance,
                changed=_chance(each.scalars["slip_probability"]),
                extrapolated=Message(" (extrapolated)") if _note(each) else NOTHING,
                sure=Message(", higher COF with a probability of {chance}", chance=_sure(each))
                if _sure(each)
                else NOTHING,
            )
            for each in self.best[:most]
        ]  # fmt: skip
        return lines or [Message("No tested change reduces the slip probability.")]

    def table(self) -> Table:
        place = {id(each): number for number, each in enumerate(self.best, 1)}
        rows = []
        told = [change for change in self.changes if not change.computed or self._moves(change)]
        for each in sorted(told, key=lambda one: place.get(id(one), len(told) + 1)):
            rank = place.get(id(each))
            if not each.computed:
                why = Message("not computed: {reason}", reason=each.reason)
                rows.append(("-", each.change.action, "", "", "", why))
                continue
            texts = [value_text(k, each.scalars[k]) for k in ("cof", "slip_probability")]
            note = "extrapolated" if _note(each) else ""
            place_text = "-" if rank is None else f"{rank}."
            rows.append((place_text, each.change.action, *texts, _sure(each), note))
        heads = ("", "Change", "COF", "Slip probability", "Higher COF", "")
        return Table("Most effective changes (each simulated)", heads, rows)

    def tables(self) -> tuple[Table, ...]:
        rows = []
        for model in self.models:
            needed = "not reachable" if model.needed_acof is None else f"{model.needed_acof:.3f}"
            ends = None if model.low is None or model.high is None else (model.low, model.high)
            chance = _chance(SourcedValue(model.probability, interval=ends))
            rows.append((model.name, chance, needed))
        heads = (
            "Model",
            "Slip probability",
            Message("COF needed for {target}", target=percent(self.target)),
        )
        models = Table("Slip probability of the same friction by every model", heads, rows)
        return (self.table(), models) if self.usable else ()

    def remarks(self) -> dict[str, Sequence[str]]:
        told = {id(each) for each in self.effective}
        idle = [
            change.change.action
            for change in self.changes
            if change.computed and id(change) not in told
        ]
        return {**self.outcome.remarks(), "Tried without effect": idle}

    def _moves(self, effect: ChangeEffect) -> bool:
        """Return whether a change does something that a page shows, and no toss-up."""
        if not self._same_chance(effect):
            return True
        toss_up = effect.higher is not None and abs(effect.higher - 0.5) <= TOSS_UP
        return not toss_up and f"{effect.number('cof'):.3f}" != f"{self.outcome.number('cof'):.3f}"

    def _same_chance(self, effect: ChangeEffect) -> bool:
        """Return whether the slip probability prints as it does without the change."""
        before, after = (one.number("slip_probability") for one in (self.outcome, effect))
        return probability_text(before) == probability_text(after)

    def to_dict(self) -> dict[str, Any]:
        film_share = self.limit.film_share
        return {
            "cof": self.outcome.scalars["cof"].to_dict(),
            "slip_probability": self.outcome.scalars["slip_probability"].to_dict(),
            "limit": {
                "kind": self.limit.kind,
                "film_share": None if math.isnan(film_share) else film_share,
                "cof_without_film": self.limit.cof_without_film,
            },
            "target": self.target,
            "missing_friction": self.missing_friction,
            "models": [
                {
                    "name": model.name,
                    "source": model.source,
                    "assumption": model.assumption,
                    "probability": model.probability,
                    "interval_95": [model.low, model.high],
                    "needed_acof": model.needed_acof,
                }
                for model in self.models
            ],
            "changes": [
                {
                    "name": change.change.name,
                    "action": change.change.action,
                    "lever": change.change.lever,
                    "values": dict(change.change.values),
                    **{
                        name: change.number(name) if change.computed else None
                        for name in ("cof", "slip_probability", "fluid_load")
                    },
                    "slip_interval": change.scalars["slip_probability"].interval
                    if change.computed
                    else None,
                    "extrapolated": change.computed and bool(_note(change)),
                    "cof_error": change.error,
                    "higher_cof": change.higher,
                    "does_something": change.computed and self._moves(change),
                    "reason": change.reason,
                }
                for change in self.changes
            ],
        }

    def data_tables(self) -> dict[str, Table]:
        names = (
            "name",
            "lever",
            "action",
            "cof",
            "slip_probability",
            "fluid_load",
            "cof_error",
            "higher_cof",
            "reason",
        )
        rows = [tuple(change[name] for name in names) for change in self.to_dict()["changes"]]
        return {"changes": Table("", names, rows)}


def risk_assessment(
    case: Case,
    *,
    result: Result | None = None,
    target: float = 0.05,
    changes: Sequence[Change] | None = None,
    quick: bool = True,
    processes: int | None = 1,
    progress: Progress = silent,
) -> RiskAssessment:
    """Return the slip probability by every model, what limits the friction, and effects of changes.

    Parameters:
        case: Shoe, floor, fluid, motion and people.
        target: Slip probability to aim at, for the friction that is missing.
        result: Of the case as ``run`` gave it; None computes it.
        changes: What to try; None takes ``possible_changes(case)``.
        quick: Compute on the coarse grid, as ``change_effects`` says.
        processes: At most so many for changes that need a run of their own; None takes the cores.

    Raises:
        InputError: ``target`` outside (0, 1); a case that can't be computed; a result of another.
    """
    if not 0 < target < 1:
        raise InputError(f"{target:g}", where="target", allowed="above 0 and below 1")
    if result is None:
        present = run(case, quick=quick, progress=part(progress, 0.0, 0.3))
    elif result.provenance.case_hash == case.hash:
        present = result
    else:
        raise InputError(
            Message("the result of {name} is not of this case", name=repr(result.name)),
            where="result",
            remedy="Run the case as it is, without objects",
        )
    outcome, tried = CaseOutcome.of(present), possible_changes(case) if changes is None else changes
    if not outcome.usable:
        nothing = FrictionLimit(*[math.nan] * 3)
        return RiskAssessment(case.name, outcome, (), nothing, target, None, ())
    rest = part(progress, 0.3, 1.0) if result is None else progress
    draws = present.data.get("cof_draws")
    acof = present.scalars["cof"], None if draws is None else np.asarray(draws)
    models = model_risks(case, *acof, target)
    own = _needed_acof(target, *acof, required_friction(case), case.risk.build())
    return RiskAssessment(
        case.name,
        outcome,
        models,
        friction_limit(present.scalars),
        target,
        None if own is None else max(own - outcome.number("cof"), 0.0),
        change_effects(case, present, tried, quick=quick, processes=processes, progress=rest),
        present.provenance.closures.get("slip", ""),
    )


def model_risks(
    case: Case, acof: SourcedValue, draws: Array | None, target: float
) -> tuple[ModelRisk, ...]:
    """Return the slip probability by each published model, and the ACOF for ``target``.

    Each as the result has it: a mean over the same draws of the friction, those of the model's
    constants on top.

    Parameters:
        case: Who walks where.
        acof: Available friction.
        draws: Of it, (samples,); None where its spread is not known.
        target: Slip probability that is aimed at, 0 to 1.
    """
    people, risks = required_friction(case), []
    for name in MODELS:
        model = slip_model(name)
        risk = slip_risk(acof, rcof=people, model=model, samples=draws)
        risks.append(
            ModelRisk(
                name,
                model.source,
                next(iter(model.assumptions), ""),
                float(risk.probability),
                risk.low,
                risk.high,
                _needed_acof(target, acof, draws, people, model),
            )
        )
    return tuple(risks)


def odds(probability: float) -> Message:
    """Return a probability as people say it: "1 in 12 steps" below a fifth, else percent."""
    if math.isnan(probability):
        return Message("not determined")
    if probability < 1e-3:
        return Message("fewer than 1 in 1000 steps")
    if probability < RARE:
        return Message("1 in {count:.0f} steps", count=1 / probability)
    return Message("{probability} of steps", probability=probability_text(probability))


def _note(effect: ChangeEffect) -> str:
    return effect.scalars["slip_probability"].note


def _chance(slip: SourcedValue) -> str:
    """Return a slip probability without its spread, but with an interval that is wide."""
    if is_wide(slip.interval):
        return value_text("slip_probability", slip)
    return probability_text(math.nan if slip.value is None else slip.value)


def _sure(effect: ChangeEffect) -> str:
    """Return the probability that a change raises COF; empty where it changes none."""
    if effect.higher is None or effect.change.lever == "walking":
        return ""
    return drawn_probability_text(effect.higher)


def _needed_acof(
    target: float,
    acof: SourcedValue,
    draws: Array | None,
    people: RcofPopulation,
    model: SlipModel,
) -> float | None:
    """Return the ACOF that a model requires for ``target``; None where none is enough."""
    try:
        return needed_acof(target, rcof=people, model=model, acof=acof, samples=draws)
    except InputError:
        return None
