"""The chance of a slip, what limits the friction, and which changes help most."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from underfoot.core import InputError, Progress, SourcedValue, UnderfootError, silent

from .changes import Change, possible_changes
from .outcomes import Outcome, outcomes

if TYPE_CHECKING:
    from underfoot.case import Case
    from underfoot.slip import SlipModel

FILM_MATTERS = 0.05
"""Share of the load carried by the film from which drainage is worth naming."""
GAIN_MATTERS = 1.1
"""Factor on the COF from which drainage is worth naming; a film's own shear counts against it."""
QUOTED_SLOPES = (-41.2, -45.1, -54.7)
_QUOTED = (
    "slope of another study as quoted in final progress report on shoe-floor friction, G.6.3; "
    "even odds as in the report"
)


@dataclass(frozen=True, slots=True)
class ModelRisk:
    """What one published model says about the same friction and people."""

    name: str
    source: str
    probability: float
    low: float | None
    high: float | None
    needed_acof: float | None


@dataclass(frozen=True, slots=True)
class Limit:
    """What keeps the friction low.

    ``drained`` is the COF if the film carried no load and the present friction of the touching
    part held everywhere: (COF - viscous part) / (1 - share).
    """

    film_share: float
    cof: float
    drained: float

    @property
    def kind(self) -> str:
        """ "film", "fluid" (what it leaves of adhesion) or "dry"."""
        if math.isnan(self.film_share):
            return "dry"
        carried = self.film_share > FILM_MATTERS and self.drained > GAIN_MATTERS * self.cof
        return "film" if carried else "fluid"

    @property
    def words(self) -> str:
        """Return what limits the friction in a sentence."""
        if self.kind == "dry":
            return "No fluid: the friction of the dry pair limits it."
        if self.kind == "film":
            return (
                f"The film carries {100 * self.film_share:.0f} % of the load; "
                f"drained, the same surfaces would give about {self.drained:.2f}."
            )
        share = f"The film carries {100 * self.film_share:.0f} % of the load"
        return (
            f"{share}, which matters little here; what limits the friction is the adhesion that "
            "the fluid blocks where the surfaces touch."
        )


@dataclass(frozen=True, slots=True)
class Bought:
    """A change, computed, with the friction and the chance of a slip it leads to."""

    change: Change
    outcome: Outcome | None
    reason: str = ""

    @property
    def computed(self) -> bool:
        """Whether the change gave a result."""
        return self.outcome is not None and self.outcome.usable

    def number(self, name: str) -> float:
        """Return a number of the changed case; nan where it could not be computed."""
        return float("nan") if self.outcome is None else self.outcome.number(name)


@dataclass(frozen=True, slots=True)
class RiskReport:
    """Everything ``underfoot risk`` says about a case."""

    case: str
    outcome: Outcome
    models: tuple[ModelRisk, ...]
    limit: Limit
    wanted: float
    more_friction: float | None
    changes: tuple[Bought, ...]

    @property
    def best(self) -> list[Bought]:
        """Return the changes that lower the chance of a slip, the most effective first."""
        present = self.outcome.number("slip_probability")
        found = [
            one for one in self.changes if one.computed and one.number("slip_probability") < present
        ]
        return sorted(found, key=lambda one: (one.number("slip_probability"), -one.number("cof")))


def risk_report(
    case: Case,
    *,
    wanted: float = 0.05,
    changes: Sequence[Change] | None = None,
    quick: bool = True,
    processes: int | None = 1,
    progress: Progress = silent,
) -> RiskReport:
    """Return the chance of a slip by every model, what limits the friction, and what would help.

    Parameters
    ----------
    case
        Shoe, floor, fluid, motion and people.
    wanted
        Chance of a slip to aim at, for the friction that is missing.
    changes
        What to try; None takes ``possible_changes(case)``. Each is computed with the whole model.
    quick
        The coarse grid for all, so that differences are between like and like.

    Errors
    ------
    InputError
        ``wanted`` outside (0, 1); a case that can't be computed.
    """
    if not 0 < wanted < 1:
        raise InputError(f"{wanted:g}", where="wanted", allowed="above 0 and below 1")
    tried = list(possible_changes(case) if changes is None else changes)
    variants: list[Case] = []
    reasons: dict[int, str] = {}
    for number, change in enumerate(tried):
        try:
            variants.append(case.replace(change.values))
        except UnderfootError as error:
            reasons[number] = str(error)
    computed = outcomes(
        [case, *variants],
        quick=quick,
        processes=processes,
        progress=progress,
        stage="Computing changes",
    )
    present, rest = computed[0], iter(computed[1:])
    bought = []
    for number, change in enumerate(tried):
        outcome = None if number in reasons else next(rest)
        reason = reasons.get(number, "")
        if outcome is not None and not outcome.usable:
            reason = str(outcome.status)
        bought.append(Bought(change, outcome, reason))
    return RiskReport(
        case.name,
        present,
        model_risks(case, present.scalars["cof"], wanted) if present.usable else (),
        limit(present),
        wanted,
        _missing(case, present, wanted),
        tuple(bought),
    )


def model_risks(case: Case, acof: SourcedValue, wanted: float) -> tuple[ModelRisk, ...]:
    """Return what each published model says, and the ACOF it asks for ``wanted``."""
    from underfoot.slip import ReportG6, slip_model
    from underfoot.slip.model import MODELS

    models: list[tuple[str, str, SlipModel]] = []
    for name in MODELS:
        model = slip_model(name)
        models.append((name, model.source, model))
    for slope in QUOTED_SLOPES:
        models.append((f"slope {slope:g}", _QUOTED, ReportG6(slope=slope)))
    return tuple(
        _model_risk(case, name, source, model, acof, wanted) for name, source, model in models
    )


def limit(outcome: Outcome) -> Limit:
    """Return what limits the friction of an outcome."""
    cof = outcome.number("cof")
    load = outcome.number("normal_force")
    fluid = outcome.number("fluid_load")
    if outcome.scalars["minimum_film_thickness"].value is None:
        return Limit(float("nan"), cof, cof)
    share = fluid / load
    solid = cof - outcome.number("cof_viscous")
    return Limit(share, cof, solid / (1 - share) if share < 1 else float("nan"))


def _model_risk(
    case: Case, name: str, source: str, model: SlipModel, acof: SourcedValue, wanted: float
) -> ModelRisk:
    from underfoot.slip import RequiredFriction, slip_risk
    from underfoot.slip.needed import needed_acof

    rcof = RequiredFriction(case.risk.rcof_mean, case.risk.rcof_sd)
    risk = slip_risk(acof, rcof=rcof, model=model)
    try:
        needed = needed_acof(wanted, rcof=rcof, model=model)
    except InputError:
        needed = None
    return ModelRisk(name, source, risk.probability.value or 0.0, risk.low, risk.high, needed)


def _missing(case: Case, outcome: Outcome, wanted: float) -> float | None:
    """Return how much more ACOF the case's own model asks for ``wanted``; 0 where it is there."""
    from underfoot.slip import RequiredFriction, slip_model
    from underfoot.slip.needed import needed_acof

    if not outcome.usable:
        return None
    rcof = RequiredFriction(case.risk.rcof_mean, case.risk.rcof_sd)
    try:
        needed = needed_acof(wanted, rcof=rcof, model=slip_model(case.risk.model))
    except InputError:
        return None
    return max(needed - outcome.number("cof"), 0.0)
