"""Printed statements beside computed values: a headline of independent ones, tables apart."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from underfoot.core import InputError
from underfoot.core.remark import Message

from .runner import PublishedStudyResult
from .statements import studies
from .verdict import Verdict, counts, tables_by_kind


def headline(results: Iterable[PublishedStudyResult]) -> list[tuple[str, list[int]]]:
    """Return (study, independent statements by verdict) and the sum over all studies last."""
    rows = []
    for result in results:
        number = counts(result.judgements)
        if sum(number.values()):
            rows.append((result.study.name, [number[verdict] for verdict in Verdict]))
    if rows:
        rows.append(("all", [sum(column) for column in zip(*(r for _, r in rows), strict=True)]))
    return rows


def figure_rows(
    results: Iterable[PublishedStudyResult], written: Mapping[str, Sequence[str]]
) -> list[tuple[int, str, str, str]]:
    """Return (number, what it shows, our file or "-", remark) of the publication's figures."""
    rows = []
    for result in results:
        name = result.study.name
        for number, shows, file, remark in result.study.figures:
            if file and file in written.get(name, ()):
                rows.append((number, shows, f"{name}/{file}", remark))
            else:
                rows.append((number, shows, "-", "not written in this run" if file else remark))
    return sorted(rows)


def summary_markdown(results: Sequence[PublishedStudyResult]) -> str:
    """Return all statements as Markdown, as docs/studies/summary.md keeps it."""
    missing = [name for name in studies() if name not in {r.study.name for r in results}]
    text = [
        "# Every printed statement beside the computed value",
        "",
        "Written by `underfoot studies run all`. Counted are independent statements: each reading "
        "once, nothing that a parameter was chosen on, no comparison of the report's numbers "
        "with each other. What an agreement needs is fixed in `src/underfoot/studies` before "
        "anything is computed.",
        "",
        "| study | " + " | ".join(str(verdict) for verdict in Verdict) + " |",
        "|---" * (len(Verdict) + 1) + "|",
    ]
    text += [f"| {name} | " + " | ".join(map(str, row)) + " |" for name, row in headline(results)]
    text += ["", *(f"- *{verdict}*: {verdict.rule}" for verdict in Verdict), ""]
    if missing:
        text += [f"Not in this run: {', '.join(missing)}.", ""]
    for result in results:
        text += [f"## {result.study.name}: {result.study.title}", ""]
        text += [f"Source: {result.study.source}.", ""]
        if result.quick:
            text += [
                "Run with --quick: what one coarse grid can be off by is part of each tolerance.",
                "",
            ]
        if result.error:
            text += [f"Failed: {result.error}", ""]
            continue
        for kind, some in tables_by_kind(result.judgements):
            text += [f"### {kind.heading}", ""]
            table = ["| statement | printed | tolerance | computed | outside by | verdict | why |"]
            table += ["|---" * 7 + "|"]
            for judgement in some:
                s = judgement.statement
                ours = (
                    judgement.ours,
                    judgement.difference,
                    str(judgement.verdict),
                    judgement.reason,
                )
                cells = (f"{s.text} ({s.place})", s.printed, s.tolerance_reason, *ours)
                table.append("| " + " | ".join(_cell(cell) for cell in cells) + " |")
            text += folded_lines(f"Statements: {len(some)}", table)
        remarks = result.remarks()
        for key, title in (("Not taken as printed",) * 2, ("Assumptions", "Assumed")):
            if remarks[key]:
                label = f"{title} ({len(remarks[key])})"
                text += folded_lines(label, (f"- {entry}" for entry in remarks[key]))
    return "\n".join(text).rstrip() + "\n"


def folded_lines(label: str, lines: Iterable[str]) -> list[str]:
    """Return lines of Markdown that a page hides until their label is opened."""
    return ["<details>", f"<summary>{label}</summary>", "", *lines, "", "</details>", ""]


def write_summary(results: Sequence[PublishedStudyResult], folder: Path) -> None:
    """Write summary.csv and summary.md into an existing folder."""
    rows = [judgement.to_dict() for result in results for judgement in result.judgements]
    with (folder / "summary.csv").open("w", newline="", encoding="utf-8-sig") as stream:
        writer = csv.DictWriter(stream, list(rows[0]) if rows else ["statement"])
        writer.writeheader()
        writer.writerows(rows)
    (folder / "summary.md").write_text(summary_markdown(results), encoding="utf-8")


def read_results(folder: Path) -> list[PublishedStudyResult]:
    """Return the results that earlier runs left in a folder, judged by today's statements.

    Raises
    ------
    InputError
        No study.json in the folder or its sub-folders.
    """
    paths = [folder / name / "study.json" for name in studies()] + [folder / "study.json"]
    texts = [path.read_text(encoding="utf-8") for path in paths if path.is_file()]
    if not texts:
        allowed = "a folder that `underfoot studies run --out` wrote"
        raise InputError(
            Message("{folder} holds no study", folder=folder), where="FOLDER", allowed=allowed
        )
    return [PublishedStudyResult.from_dict(json.loads(text)) for text in texts]


def _cell(text: str) -> str:
    return text.replace("|", "\\|").replace("\n", " ") or " "
