"""The numbers of many cases, computed side by side, each only once."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from underfoot.compute.numbers import undetermined_numbers
from underfoot.compute.run import run
from underfoot.compute.summary import ranked_assumptions
from underfoot.core import ConvergenceError, Progress, SourcedValue, Status, content_hash, silent
from underfoot.core.arrays import Array
from underfoot.core.cache import Cache
from underfoot.core.deprecation import renamed_member
from underfoot.core.pool import in_processes, workers
from underfoot.core.progress import part
from underfoot.core.remark import Remark, from_stored, stored_form

if TYPE_CHECKING:
    from underfoot.case import Case
    from underfoot.compute.result import Result


@dataclass(frozen=True, slots=True)
class CaseOutcome:
    """Numbers of one computed case, as those of ``compute.result.Result``.

    ``maps`` holds the fields that were asked for, where it has them, with ``x`` and ``y``, SI.
    """

    name: str
    case_hash: str
    scalars: dict[str, SourcedValue]
    labels: dict[str, str]
    status: Status
    remedy: str
    breaches: tuple[Remark, ...]
    assumptions: tuple[Remark, ...]
    seconds: float
    maps: dict[str, Array] = field(default_factory=dict, compare=False, repr=False)

    @property
    def usable(self) -> bool:
        """Whether the numbers are a result."""
        return self.status.usable

    def number(self, name: str) -> float:
        """Return a scalar in SI; nan where it was not determined."""
        value = self.scalars[name].value
        return float("nan") if value is None or not self.usable else value

    def standard_deviation(self, name: str) -> float:
        """Return a scalar's standard deviation; nan where it was not estimated."""
        deviation = self.scalars[name].uncertainty
        return float("nan") if deviation is None or not self.usable else deviation

    spread = renamed_member("spread", "standard_deviation", gone="0.4")

    def remarks(self) -> dict[str, Sequence[str]]:
        """Return the assumptions, the decisive ones first, and the tested ranges left."""
        return {
            "Outside the tested range": self.breaches,
            "Assumptions": ranked_assumptions(self.assumptions),
        }

    @classmethod
    def of(cls, result: Result, maps: Sequence[str] = ()) -> CaseOutcome:
        """Return the numbers of a result and its fields of the names ``maps``."""
        axes = ("x", "y") if maps else ()
        return cls(
            result.name,
            result.provenance.case_hash,
            dict(result.scalars),
            dict(result.labels),
            result.status,
            result.status.remedy,
            result.breaches,
            result.assumptions,
            float(sum(result.provenance.timings.values())),
            {name: np.asarray(result.data[name]) for name in (*axes, *maps) if name in result.data},
        )

    def as_text(self) -> str:
        """Return the outcome as JSON, without its maps."""
        plain = asdict(replace(self, maps={}))
        del plain["maps"]
        return json.dumps(stored_form(plain))

    @classmethod
    def from_text(cls, text: str) -> CaseOutcome:
        """Return the outcome written by ``as_text``."""
        plain = json.loads(text)
        plain["scalars"] = {
            name: SourcedValue(**from_stored(value)) for name, value in plain["scalars"].items()
        }
        plain["status"] = Status(plain["status"])
        plain["labels"] = from_stored(plain["labels"])
        for name in ("breaches", "assumptions"):
            plain[name] = tuple(map(Remark.from_stored, plain[name]))
        return cls(**plain)


def outcomes(
    cases: Sequence[Case],
    *,
    quick: bool = False,
    maps: Sequence[str] = (),
    processes: int | None = 1,
    cached: bool = True,
    progress: Progress = silent,
    stage: str = "Computing variants",
) -> list[CaseOutcome]:
    """Return the outcome of every case, in order; equal cases are computed once.

    A case whose contact can't be solved even at its start is an outcome that did not converge.

    Parameters:
        quick: Use the coarse grid of the cases.
        maps: Names of the fields on (x, y) that each outcome keeps.
        processes: Cases computed at the same time, each on one thread; None takes the cores, at
            most 4. With more than one, a script needs ``if __name__ == "__main__":`` around its
            work.
        cached: Keep outcomes on disk and take them from there. Any change of this
            code computes again.
        progress: Receives the share of cases that are done; an exception it raises stops the work,
            and what is done stays in the cache.

    Raises:
        InputError: As ``compute.run`` raises it for the first case whose parts don't fit.
    """
    store = Cache("outcomes-1")
    keys = [content_hash(case.hash, quick, list(maps)) for case in cases]
    known: dict[str, CaseOutcome] = {}
    waiting: dict[str, Case] = {}
    for key, case in zip(keys, cases, strict=True):
        stored = store.load(key) if cached and key not in known else None
        if stored is not None:
            outcome = CaseOutcome.from_text(str(stored.pop("outcome")))
            known[key] = replace(outcome, maps=stored)
        elif key not in known:
            waiting[key] = case
    ready = len(known) / max(len(set(keys)), 1)
    progress(stage, ready)
    compute = partial(_computed_alone, quick=quick, maps=maps)
    names, items, rest = list(waiting), list(waiting.values()), part(progress, ready, 1.0)
    for index, outcome in in_processes(
        compute, items, workers(processes), progress=rest, stage=stage
    ):
        key = names[index]
        known[key] = outcome
        if cached and outcome.usable:
            store.store(key, {"outcome": np.array(outcome.as_text()), **outcome.maps})
    return [known[key] for key in keys]


def _computed_alone(case: Case, *, quick: bool, maps: Sequence[str]) -> CaseOutcome:
    try:
        return CaseOutcome.of(run(case, quick=quick), maps)
    except ConvergenceError as error:  # one case without numbers, the others go on
        status = Status.NOT_CONVERGED
        none = undetermined_numbers(case, status)
        return CaseOutcome(case.name, case.hash, none, {}, status, error.message, (), (), 0.0)
