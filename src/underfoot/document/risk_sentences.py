"""The chance of a slip and what would help, in plain words."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from .sentences import percent

if TYPE_CHECKING:
    from underfoot.assess.risk import Bought, RiskReport
    from underfoot.case.result import Result

MOST = 3


def risk_sentences(found: RiskReport) -> list[str]:
    """Return the chance with its band, what limits the friction, what is missing."""
    if not found.outcome.usable:
        return [f"Not computed: {found.outcome.status}. {found.outcome.remedy}"]
    risk = found.outcome.scalars["slip_probability"]
    cof = found.outcome.scalars["cof"]
    chance = found.outcome.number("slip_probability")
    text = f"About {chance_words(chance)} of steps would slip"
    own = next((one for one in found.models if one.source == risk.source), None)
    if own is not None and own.low is not None and own.high is not None:
        ends = [percent(own.low), percent(own.high)]
        if ends[0] != ends[1]:
            text += f" ({ends[0]} to {ends[1]} with the spread of the friction)"
    spread = "" if cof.uncertainty is None else f" ± {cof.uncertainty:.3f}"
    text += f": the available friction is {found.outcome.number('cof'):.3f}{spread}."
    lines = [text, found.limit.words]
    if found.more_friction:
        lines.append(
            f"For a chance of {percent(found.wanted)} the friction would have to be "
            f"{found.more_friction:.2f} higher."
        )
    elif found.more_friction == 0.0:
        lines.append(f"That is friction enough for a chance below {percent(found.wanted)}.")
    return lines


def change_lines(found: RiskReport) -> list[str]:
    """Return the most effective changes, each computed, with what it buys."""
    best = found.best[:MOST]
    if not best:
        return ["None of the changes that were computed lowers it."]
    before = f"{found.outcome.number('cof'):.2f}"
    chance = percent(found.outcome.number("slip_probability"))
    return [
        f"{one.change.words}: friction {before} to {one.number('cof'):.2f}, "
        f"steps that slip {chance} to {percent(one.number('slip_probability'))}"
        for one in best
    ]


def limit_words(result: Result) -> str:
    """Return what limits the friction of a result, in a sentence."""
    from underfoot.assess.outcomes import Outcome
    from underfoot.assess.risk import limit

    return limit(Outcome.of(result)).words


def bought_words(one: Bought) -> str:
    """Return the friction and the chance that a change leads to."""
    if not one.computed:
        return f"not computed ({one.reason})"
    risk = one.number("slip_probability")
    return f"friction {one.number('cof'):.2f}, {percent(risk)} of steps slip"


def chance_words(chance: float) -> str:
    """Return a chance as people say it: "1 in 12" below a fifth, else percent."""
    if math.isnan(chance):
        return "an unknown share"
    if chance < 1e-3:
        return "fewer than 1 in 1000"
    return f"1 in {1 / chance:.0f}" if chance < 0.2 else percent(chance)
