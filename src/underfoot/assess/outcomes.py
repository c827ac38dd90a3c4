"""The numbers of many cases: computed side by side, each only once."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from underfoot.core import Progress, SourcedValue, Status, content_hash, silent
from underfoot.core.cache import Cache

if TYPE_CHECKING:
    from underfoot.case import Case
    from underfoot.case.result import Result

_THREADS = ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS")


@dataclass(frozen=True, slots=True)
class Outcome:
    """Numbers of one computed case, without its maps; as those of ``case.Result``."""

    name: str
    case_hash: str
    scalars: dict[str, SourcedValue]
    labels: dict[str, str]
    status: Status
    remedy: str
    breaches: tuple[str, ...]
    assumptions: tuple[str, ...]
    seconds: float

    @property
    def usable(self) -> bool:
        """Whether the numbers are a result."""
        return self.status.usable

    def number(self, name: str) -> float:
        """Return a scalar in SI; nan where it was not determined."""
        value = self.scalars[name].value
        return float("nan") if value is None or not self.usable else value

    def spread(self, name: str) -> float:
        """Return a scalar's standard deviation; nan where it was not estimated."""
        found = self.scalars[name].uncertainty
        return float("nan") if found is None or not self.usable else found

    @classmethod
    def of(cls, result: Result) -> Outcome:
        """Return the numbers of a result."""
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
        )

    def as_text(self) -> str:
        """Return the outcome as JSON."""
        plain = {
            "name": self.name,
            "case_hash": self.case_hash,
            "scalars": {name: value.as_dict() for name, value in self.scalars.items()},
            "labels": self.labels,
            "status": str(self.status),
            "remedy": self.remedy,
            "breaches": list(self.breaches),
            "assumptions": list(self.assumptions),
            "seconds": self.seconds,
        }
        return json.dumps(plain)

    @classmethod
    def from_text(cls, text: str) -> Outcome:
        """Return the outcome written by ``as_text``."""
        plain = json.loads(text)
        plain["scalars"] = {name: SourcedValue(**v) for name, v in plain["scalars"].items()}
        plain["status"] = Status(plain["status"])
        for name in ("breaches", "assumptions"):
            plain[name] = tuple(plain[name])
        return cls(**plain)


def outcomes(
    cases: Sequence[Case],
    *,
    quick: bool = False,
    processes: int | None = 1,
    cached: bool = True,
    progress: Progress = silent,
    stage: str = "Computing variants",
) -> list[Outcome]:
    """Return the outcome of every case, in order; equal cases are computed once.

    Parameters
    ----------
    cases
        What to compute.
    quick
        Use the coarse grid of the cases.
    processes
        Cases computed at the same time, each on one thread; None takes the cores, at most 4.
        With more than one, a script needs ``if __name__ == "__main__":`` around its work.
    cached
        Keep outcomes on disk and take them from there. An entry belongs to this code and
        this catalogue: any change of either computes again.
    progress
        Receives the share of cases that are done; an exception it raises stops the work, and
        what is done stays in the cache.

    Errors
    ------
    UnderfootError
        As ``case.run`` raises it for the first case that can't be computed at all.
    """
    store = Cache("outcomes-1")
    keys = [_key(case, quick) for case in cases]
    found: dict[str, Outcome] = {}
    waiting: dict[str, Case] = {}
    for key, case in zip(keys, cases, strict=True):
        stored = store.load(key) if cached and key not in found else None
        if stored is not None:
            found[key] = Outcome.from_text(str(stored["outcome"]))
        elif key not in found:
            waiting[key] = case
    done = len(found)
    progress(stage, done / max(len(set(keys)), 1))
    for key, outcome in _computed(waiting, quick, processes):
        found[key] = outcome
        if cached and outcome.usable:
            store.store(key, {"outcome": np.array(outcome.as_text())})
        done += 1
        progress(stage, done / len(set(keys)))
    return [found[key] for key in keys]


def _computed(
    waiting: dict[str, Case], quick: bool, processes: int | None
) -> Iterable[tuple[str, Outcome]]:
    count = min(processes or min(os.cpu_count() or 1, 4), len(waiting))
    if count <= 1:
        for key, case in waiting.items():
            yield key, _one(case, quick)
        return
    from concurrent.futures import ProcessPoolExecutor, as_completed
    from multiprocessing import get_context

    before = {name: os.environ.get(name) for name in _THREADS}
    os.environ.update(dict.fromkeys(_THREADS, "1"))  # children read it when they start
    try:
        with ProcessPoolExecutor(count, mp_context=get_context("spawn")) as pool:
            jobs = {pool.submit(_one, case, quick): key for key, case in waiting.items()}
            try:
                for job in as_completed(jobs):
                    yield jobs[job], job.result()
            except BaseException:
                pool.shutdown(wait=False, cancel_futures=True)
                raise
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value


def _one(case: Case, quick: bool) -> Outcome:
    from underfoot.case.run import run

    return Outcome.of(run(case, quick=quick))


def _key(case: Case, quick: bool) -> str:
    return content_hash(case.hash, quick, _code(), _files(case.catalogue.folders))


@cache
def _code() -> str:
    """Return a hash of the package's own text: numbers of another code are not ours."""
    import underfoot

    return _files((str(Path(str(underfoot.__file__)).parent),))


def _files(folders: Sequence[str]) -> str:
    parts: list[str] = []
    for folder in folders:
        for path in sorted(Path(folder).rglob("*")):
            if path.suffix in (".py", ".toml", ".csv"):
                parts.append(path.read_text(encoding="utf-8", errors="replace"))
    return content_hash(*parts)
