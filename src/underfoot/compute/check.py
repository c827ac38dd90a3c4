"""A case before it is computed: values, assumptions, ranges and cost; solves nothing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from underfoot.case import assumptions
from underfoot.case.describe import tested_range_breaches
from underfoot.core import InputError
from underfoot.core.presentation import Presentable, Table
from underfoot.core.remark import Message, Remark
from underfoot.sole_contact.cost import Cost, megabytes

from .positions import run_cost
from .resolve import resolve_context
from .sole import outsole_notes
from .summary import in_words, ranked_assumptions

if TYPE_CHECKING:
    from underfoot.case import Case

USUAL_AREA = 2e-3
"""m^2: a heel touches on some 20 cm2, for the pressure at which ranges are checked."""
DEAR = {
    "finite_element": "The finite-element sole takes up to a minute and 2 GB more, once.",
    "contact_table": "The contact table takes about 10 s more, once.",
    "history": "A history takes several times as long.",
}
"""Extra cost of the options that are dear, by their name."""


@dataclass(frozen=True, slots=True)
class CaseCheck(Presentable):
    """What is known of a case before it is computed."""

    kind: ClassVar[str] = "check"

    case: Case
    refusal: str
    breaches: tuple[Remark, ...]
    full: Cost
    quick: Cost

    def __repr__(self) -> str:
        return f"<CaseCheck of {self.case.name!r:.100}: {self.full.cells} cells>"

    def heading(self) -> str:
        return f"{self.case.name}  [{self.case.hash[:12]}]"

    def headline(self) -> tuple[Message, ...]:
        case = self.case
        options = (case.compliance.name, case.rough_contact.name, case.motion.name)
        made = not case.value("rough_contact.file")
        dear = [name for name in options if name in DEAR and (made or name != "contact_table")]
        return (
            Message(
                "Cost: {full}, on one core; with --quick {quick}.", full=self.full, quick=self.quick
            ),
            *(Message.plain(DEAR[name]) for name in dear),
        )

    def cautions(self) -> tuple[Message, ...]:
        reasons, limit = [self.refusal] if self.refusal else [], self.case.numerics.most_memory
        if self.full.memory > limit:
            reasons.append(
                Message(
                    "numerics.most_memory is {limit}; use --quick or a coarser "
                    "numerics.grid_spacing.",
                    limit=megabytes(limit),
                )
            )
        return tuple(
            Message("A run would be refused: {reason}", reason=reason) for reason in reasons
        )

    def table(self) -> Table:
        return self.case.table()

    def remarks(self) -> dict[str, Sequence[str]]:
        return {
            "Outside the tested range, as far as it shows before solving": in_words(self.breaches),
            "Assumptions": ranked_assumptions((*assumptions(self.case), *outsole_notes(self.case))),
            "Read from an older version of case files": tuple(self.case.changes),
        }

    def to_dict(self) -> dict[str, Any]:
        keys = ("path", "value", "origin")
        return {
            "hash": self.case.hash,
            "values": [dict(zip(keys, row, strict=True)) for row in self.case.rows()],
            "assumptions": assumptions(self.case),
            "breaches": list(self.breaches),
            "refusal": self.refusal,
            "changes": list(self.case.changes),
            "cost": {
                name: {"cells": cost.cells, "seconds": list(cost.seconds), "bytes": cost.memory}
                for name, cost in (("full", self.full), ("quick", self.quick))
            },
        }


def case_check(case: Case) -> CaseCheck:
    """Return what is known of a case before it is computed."""
    breaches, refusal = [*tested_range_breaches(case)], ""
    try:
        context = resolve_context(case)
        if not case.value("rough_contact.file"):  # a check computes no contact
            context = replace(context, rough_contact=lambda _: None)
        breaches += [breach.remark for breach in context.modulus_breaches]
        law = case.friction.build(context)
        local = {
            "contact_pressure": np.array([case.motion.normal_force / USUAL_AREA]),
            "speed": case.motion.speed,
            "film_thickness": np.full(1, 1e-5),
        }
        breaches += [breach.remark for breach in law.breaches(**local)]
    except InputError as error:
        refusal = error.message
    return CaseCheck(
        case,
        refusal,
        tuple(dict.fromkeys(breaches)),
        run_cost(case, quick=False),
        run_cost(case, quick=True),
    )
