"""All studies one after the other, and every printed statement beside ours in one table."""

from __future__ import annotations

import csv
import inspect
import re
import time
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, fields
from importlib import import_module
from pathlib import Path
from typing import Any

from underfoot.core import Progress, silent
from underfoot.core.errors import Cancelled

from .registry import STUDIES, Study
from .verdict import Verdict

_NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?")
_REPORT = "final progress report on shoe-floor friction, "
_UNITS = re.compile(r"%|kPa|kN|\bN\b|ms|m/s|mm")


@dataclass(frozen=True, slots=True)
class SummaryLine:
    """One printed statement of any study beside ours."""

    study: str
    source: str
    quantity: str
    printed: str
    ours: str
    difference: str
    verdict: str
    reason: str


@dataclass(frozen=True, slots=True, eq=False)
class StudyRun:
    """A study that was run: its result, or why there is none."""

    study: Study
    result: Any
    error: str
    seconds: float
    process_seconds: float


def run_study(study: Study, *, quick: bool, processes: int | None, progress: Progress) -> Any:
    """Return the result of a study; options that it does not know are left out."""
    run = import_module(study.module).run
    known = inspect.signature(run).parameters
    given: dict[str, Any] = {"quick": quick, "processes": processes, "progress": progress}
    options = {name: value for name, value in given.items() if name in known}
    if study.name == "g1":
        from .g1_cases import G1Settings

        settings = G1Settings()
        return run(settings.quick if quick else settings, progress=progress)
    return run(**options)


def run_all(
    studies: Sequence[Study] = STUDIES,
    *,
    quick: bool = False,
    processes: int | None = 1,
    progress: Progress = silent,
) -> list[StudyRun]:
    """Return every study's result; one that fails says why and does not stop the others.

    What the studies keep in the cache is found again, so that a stopped run goes on.

    Errors
    ------
    Cancelled
        ``progress`` raised it.
    """
    found = []
    for number, study in enumerate(studies):

        def told(
            stage: str, fraction: float, residual: float | None = None, n: int = number, s=study
        ) -> None:
            progress(f"{s.name}: {stage}", (n + fraction) / len(studies), residual)

        told("begins", 0.0)
        started, used = time.perf_counter(), time.process_time()
        result, error = None, ""
        try:
            result = run_study(study, quick=quick, processes=processes, progress=told)
        except Cancelled:
            raise
        except Exception as failure:  # said on the page; the other studies go on
            error = f"{type(failure).__name__}: {failure}"
        found.append(
            StudyRun(
                study, result, error, time.perf_counter() - started, time.process_time() - used
            )
        )
    return found


def summary_lines(runs: Iterable[StudyRun]) -> list[SummaryLine]:
    """Return the statements of all studies that gave a result."""
    lines = []
    for run in runs:
        for line in getattr(run.result, "lines", ()):
            lines.append(_line(run.study.name, line))
    return lines


def _line(study: str, line: Any) -> SummaryLine:
    quantity = line.quantity
    if hasattr(line, "condition"):
        quantity = f"{quantity}, {line.condition} ({line.series} parameters)"
    printed = str(getattr(line, "printed_text", line.printed))
    ours = str(getattr(line, "ours_text", line.ours))
    difference = getattr(line, "difference", "") or range_difference(printed, ours)
    return SummaryLine(
        study,
        line.source.removeprefix(_REPORT),
        quantity,
        printed,
        ours,
        difference,
        str(line.verdict),
        line.reason,
    )


def range_difference(printed: str, ours: str) -> str:
    """Return how far our range lies beyond the printed one, for texts as "7 to 27 %".

    Empty where one of them holds no number, more than two, or another unit.
    """
    pairs = []
    for text in (printed, ours):
        values = [float(v) for v in _NUMBER.findall(text.replace("−", "-"))]
        if not 1 <= len(values) <= 2 or "±" in text or "<" in text or "(" in text:
            return ""
        unit = _UNITS.search(text)
        pairs.append((min(values), max(values), unit.group() if unit else ""))
    (low, high, unit), (least, most, other) = pairs
    if unit != other:
        return ""
    below, above = min(least - low, 0.0), max(most - high, 0.0)
    if below == above == 0:
        return "inside" if low < high else "none"
    name = "points" if unit == "%" else unit
    parts = [f"{value:+.3g}" for value in (below, above) if value]
    return f"{' and '.join(parts)} {name}".strip()


def verdict_counts(lines: Iterable[SummaryLine]) -> dict[str, dict[str, int]]:
    """Return how many statements of each study got each verdict."""
    counts: dict[str, dict[str, int]] = {}
    for line in lines:
        row = counts.setdefault(line.study, {str(verdict): 0 for verdict in Verdict})
        row[line.verdict] = row.get(line.verdict, 0) + 1
    return counts


def summary_markdown(runs: Sequence[StudyRun], *, quick: bool = False) -> str:
    """Return the table of verdicts as Markdown, as docs/studies/summary.md keeps it."""
    lines = summary_lines(runs)
    text = [
        "# Every printed number beside ours",
        "",
        "Written by `underfoot studies run all" + (" --quick" if quick else "") + "`; the table is "
        "`summary.md` in its folder.",
        "",
        "| study | " + " | ".join(str(verdict) for verdict in Verdict) + " |",
        "|---" * (len(Verdict) + 1) + "|",
    ]
    for study, counts in verdict_counts(lines).items():
        text.append(f"| {study} | " + " | ".join(str(counts[str(v)]) for v in Verdict) + " |")
    text += ["", *(f"- *{verdict}*: {verdict.rule}" for verdict in Verdict)]
    text += [
        "",
        "Of a mean that is printed with its deviation: reproduced within 1.96 standard errors, "
        "within scatter within one standard deviation.",
        "",
    ]
    for run in runs:
        text += [f"## {run.study.name}: {run.study.title}", "", f"Source: {run.study.source}.", ""]
        if run.error:
            text += [f"Failed: {run.error}", ""]
            continue
        text += ["| statement | printed | ours | difference | verdict | why |", "|---" * 6 + "|"]
        for line in lines:
            if line.study == run.study.name:
                cells = (
                    f"{line.quantity} ({line.source})", line.printed, line.ours, line.difference,
                    line.verdict, line.reason,
                )  # fmt: skip
                text.append("| " + " | ".join(_cell(cell) for cell in cells) + " |")
        text.append("")
        for title, entries in (
            ("Not taken as printed", [_erratum(e) for e in getattr(run.result, "errata", ())]),
            ("Assumed", list(getattr(run.result, "assumptions", ()))),
        ):
            if entries:
                text += [f"{title}:", "", *(f"- {entry}" for entry in entries), ""]
    return "\n".join(text).rstrip() + "\n"


def write_summary(runs: Sequence[StudyRun], folder: Path, *, quick: bool = False) -> None:
    """Write summary.csv and summary.md into an existing folder."""
    with (folder / "summary.csv").open("w", newline="", encoding="utf-8-sig") as stream:
        writer = csv.DictWriter(stream, [field.name for field in fields(SummaryLine)])
        writer.writeheader()
        writer.writerows(asdict(line) for line in summary_lines(runs))
    (folder / "summary.md").write_text(summary_markdown(runs, quick=quick), encoding="utf-8")


def _erratum(one: Any) -> str:
    return f"{one.where}: {one.printed} -> {one.used}: {one.why}"


def _cell(text: str) -> str:
    return text.replace("|", "\\|").replace("\n", " ") or " "
