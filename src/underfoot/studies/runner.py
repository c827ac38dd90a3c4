"""A study that was run: quantities with their verdicts, tables, figures; one runner for all."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from typing import Any, ClassVar

import numpy as np
from pydantic import TypeAdapter

from underfoot.core import Cache, InputError, Progress, content_hash, silent
from underfoot.core.errors import Cancelled
from underfoot.core.pool import in_processes
from underfoot.core.presentation import Presentable
from underfoot.core.presentation import Table as ShownTable
from underfoot.core.progress import part as part

from .figure import Figure
from .statements import PublishedStudy, studies, study, study_module
from .verdict import ComputedQuantity, Judgement, Verdict, counts, judge_study, tables_by_kind


@dataclass(frozen=True, slots=True)
class Options:
    """How a study is run; ``settings`` are those of a study that has its own (g1)."""

    quick: bool = False
    processes: int | None = 1
    seed: int = 0
    settings: Any = None
    progress: Progress = silent


@dataclass(frozen=True, slots=True)
class StudyTable:
    """A table: ``columns`` and ``rows`` of words or numbers; None and nan are kept as None."""

    name: str
    title: str
    columns: tuple[str, ...]
    rows: Sequence[Sequence[Any]]

    def __post_init__(self) -> None:
        cells = tuple(tuple(map(_cell, row)) for row in self.rows)
        object.__setattr__(self, "rows", cells)

    @classmethod
    def of(cls, name: str, title: str, records: Iterable[Mapping[str, Any]]) -> StudyTable:
        """Return the table of one or more records, each cell by the name of its column."""
        items = list(records)
        return cls(name, title, tuple(items[0]), [tuple(item.values()) for item in items])


def _cell(value: Any) -> Any:
    if isinstance(value, np.generic):
        value = value.item()
    return None if value != value else value


@dataclass(frozen=True, slots=True, eq=False)
class Computed:
    """What a study computes: quantities by name, and what a reader sees beside the verdicts."""

    quantities: Mapping[str, ComputedQuantity]
    tables: Sequence[StudyTable] = ()
    figures: Mapping[str, Figure] = field(default_factory=dict)
    conclusions: Sequence[str] = ()
    notes: Sequence[str] = ()
    assumptions: Sequence[str] = ()


@dataclass(frozen=True, slots=True, eq=False)
class PublishedStudyResult(Presentable):
    """A study that was run; ``error`` says why there is nothing, where it failed."""

    kind: ClassVar[str] = "study"
    study: PublishedStudy
    computed: Computed
    quick: bool
    seconds: float
    process_seconds: float
    error: str = ""

    @property
    def judgements(self) -> list[Judgement]:
        """Every statement with its verdict; empty where the study failed."""
        return [] if self.error else judge_study(self.study.statements, self.computed.quantities)

    def __repr__(self) -> str:
        return f"PublishedStudyResult({self.study.name}: {len(self.study.statements)} statements)"

    def table(self) -> ShownTable:
        return self.tables()[0]

    def tables(self) -> tuple[ShownTable, ...]:
        columns = ("statement", "printed", "computed", "verdict", "why")
        verdicts = [
            ShownTable(
                kind.heading,
                columns,
                [
                    (
                        f"{s.text} ({s.place})",
                        s.printed,
                        judgement.ours,
                        str(judgement.verdict),
                        judgement.reason,
                    )
                    for judgement in some
                    for s in [judgement.statement]
                ],
            )
            for kind, some in tables_by_kind(self.judgements)
        ]
        computed = [
            ShownTable(table.title, table.columns, table.rows) for table in self.computed.tables
        ]
        return (*verdicts, *computed)

    def heading(self) -> str:
        return f"{self.study.title} ({self.study.source})"

    def headline(self) -> tuple[str, ...]:
        verdicts = counts(self.judgements)
        parts = [f"{number} {verdict}" for verdict, number in verdicts.items() if number]
        if not parts:
            return (f"Failed: {self.error}",) if self.error else ()
        return (f"Of {sum(verdicts.values())} independent statements: {', '.join(parts)}.",)

    def cautions(self) -> tuple[str, ...]:
        text = "One coarse grid (--quick): what that can be off by is part of each tolerance."
        return (text,) if self.quick else ()

    def remarks(self) -> dict[str, Sequence[str]]:
        return {
            "Conclusions": self.computed.conclusions,
            "Method": (*self.study.notes, *self.computed.notes),
            "Assumptions": (*self.study.assumptions, *self.computed.assumptions),
            "Not taken as printed": [f"{a}: {b} -> {c}: {d}" for a, b, c, d in self.study.errata],
            "Verdicts": [f"{verdict}: {verdict.rule}" for verdict in Verdict],
        }

    @property
    def usable(self) -> bool:
        return not self.error

    def to_dict(self, *, figures: bool = False) -> dict[str, Any]:
        """Return plain data for JSON (SI units), from which ``from_dict`` judges again."""
        computed = asdict(self.computed)
        if not figures:
            del computed["figures"]
        return {
            "study": self.study.name,
            "source": self.study.source,
            "statements": [judgement.to_dict() for judgement in self.judgements],
            **computed,
            "errata": self.study.errata,
            "quick": self.quick,
            "seconds": self.seconds,
            "process_seconds": self.process_seconds,
            "error": self.error,
        }

    @classmethod
    def from_dict(cls, content: Mapping[str, Any]) -> PublishedStudyResult:
        """Return the result that ``to_dict`` wrote; its statements are those of today."""
        computed = TypeAdapter(Computed).validate_python(content)
        names = ("quick", "seconds", "process_seconds", "error")
        return cls(study(content["study"]), computed, *(content[name] for name in names))


def run_study(chosen: PublishedStudy, options: Options) -> PublishedStudyResult:
    """Return the result of a study; a finished one of the same program is taken from the cache.

    Raises:
        InputError: Settings for a study that has none.
    """
    module = study_module(chosen.name)
    if options.settings is not None and not hasattr(module, "Settings"):
        raise InputError(
            f"study {chosen.name} has no settings of its own",
            where="settings",
            remedy="Leave out the options of g1",
        )
    store = Cache("studies-1")
    key = content_hash(chosen.name, module.compute, options.quick, options.seed, options.settings)
    stored = store.load(key)
    if stored is not None:
        return PublishedStudyResult.from_dict(json.loads(str(stored["result"])))
    started, used = time.perf_counter(), time.process_time()
    computed: Computed = module.compute(options)
    options.progress("done", 1.0)
    seconds, process_seconds = time.perf_counter() - started, time.process_time() - used
    result = PublishedStudyResult(chosen, computed, options.quick, seconds, process_seconds)
    if not any(q.unconverged for q in computed.quantities.values()):
        store.store(key, {"result": np.array(json.dumps(result.to_dict(figures=True)))})
    return result


def run_all(
    names: Sequence[str] | None = None, options: Options | None = None
) -> Iterator[PublishedStudyResult]:
    """Yield every study's result; one that fails says why and does not stop the others.

    Raises:
        Cancelled: The receiver of progress raised it.
    """
    options, names = options or Options(), studies() if names is None else names
    for number, name in enumerate(names):
        share = part(options.progress, number / len(names), (number + 1) / len(names))
        stage = name_progress(share, name)
        stage("begins", 0.0)
        try:
            yield run_study(study(name), replace(options, settings=None, progress=stage))
        except Cancelled:
            raise
        except Exception as failure:  # stands on the page; the other studies go on
            text = f"{type(failure).__name__}: {failure}"
            yield PublishedStudyResult(study(name), Computed({}), options.quick, 0.0, 0.0, text)


def name_progress(progress: Progress, name: str) -> Progress:
    """Return a receiver of progress that puts a name before every stage."""

    def report(stage: str, fraction: float, residual: float | None = None) -> None:
        progress(f"{name}: {stage}", fraction, residual)

    return report


def cached_arrays(
    room: str,
    function: Callable[[Any], Mapping[str, Any]],
    items: Sequence[Any],
    keys: Sequence[str],
    *,
    processes: int | None = 1,
) -> Iterator[tuple[Any, dict[str, np.ndarray]]]:
    """Yield (item, arrays) in the order in which they end; a stopped run goes on from there.

    Parameters:
        room: Of the cache.
        function: Item -> arrays by name; on the top level of a module, since other processes call
            it.
        items, keys: What is computed, and under which content key each is kept.
        processes: Items at the same time.
    """
    store = Cache(room)
    waiting: dict[str, Any] = {}
    for key, item in zip(keys, items, strict=True):
        stored = store.load(key)
        if stored is None:
            waiting[key] = item
        else:
            yield item, stored
    for index, arrays in in_processes(function, list(waiting.values()), processes):
        key = list(waiting)[index]
        store.store(key, arrays)
        yield waiting[key], {name: np.asarray(value) for name, value in arrays.items()}
