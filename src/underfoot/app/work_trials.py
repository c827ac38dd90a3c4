"""A folder of trials and one trial, as plain data for a page; computed in a worker process.

The analysis is that of ``underfoot trials analyse``; here it is only asked, thinned and named.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Self

from underfoot.core import InputError, Progress, silent
from underfoot.core.files import whole_folder
from underfoot.core.progress import part
from underfoot.core.remark import Message
from underfoot.trials.pages.figures import Tile, sheets
from underfoot.trials.pages.report import (
    STORE,
    check_report_folder,
    study_parts,
    write_trials_report,
)
from underfoot.trials.recording.protocols import Protocol, protocol, protocol_names
from underfoot.trials.recording.trial import Edit
from underfoot.trials.simulator import simulated_folder
from underfoot.trials.study import (
    FileResult,
    FolderAnalysis,
    analyse_folder,
    recording_results,
)
from underfoot.trials.study.conditions import Recording, profile_of, study_folder
from underfoot.trials.study.edit_table import (
    edit_from,
    edit_rows,
    edit_text,
    with_edit_row,
    write_edit_text,
)
from underfoot.trials.study.file_result import parts
from underfoot.trials.study.folder import recording_trials
from underfoot.trials.study.record_signals import record_signals
from underfoot.trials.study.tables import quantity_name, scale_to_heading, shown_unit

from .text import put_language
from .trials_plots import record_plot, run_plot, step_plot, tile_svg


@dataclass(frozen=True, slots=True)
class TrialsWork:
    """A folder of trials and how it is analysed, as ``underfoot trials analyse`` is told.

    ``report`` takes the report and, while there is none, the results of single files.
    """

    folder: Path
    report: Path
    protocol: Protocol
    options: Mapping[str, Any]

    @classmethod
    def of(cls, asked: Mapping[str, Any]) -> Self:
        """Return it from plain data: folder, report, protocol, names and merge_spelling."""
        chosen = protocol(asked["protocol"])
        names = asked["names"] or chosen.text("names")
        options = {"names": names, "merge_spelling": asked["merge_spelling"]}
        return cls(Path(asked["folder"]), Path(asked["report"]), chosen, options)

    @property
    def store(self) -> Path:
        """Where results of single files are kept, as the command keeps them."""
        return self.report / STORE

    def recording(self, file: str) -> Recording:
        """Return the recording of a result, which is called like it or like one of its runs."""
        for recording in study_folder(self.folder, **self.options).recordings:
            if file == recording.name or file.startswith(
                (f"{recording.name} #", f"{recording.name}: ")
            ):
                return recording
        gone = Message('"{file}" is not in the folder any more', file=file)
        raise InputError(gone, where="trials")

    def result(self, recording: Recording, file: str, **how: Any) -> FileResult:
        """Return what is found in a recording under the name ``file``."""
        results = recording_results(
            self.folder, recording.name, self.protocol, **self.options, **how
        )
        return next((result for result in results if result.file == file), results[0])


@dataclass(frozen=True, slots=True)
class HandEdit:
    """An edit by hand: the number of a step, what, the new value and why, as ``edits.csv`` has it.

    ``what`` is also "take back", with the edit's place in the file's log as ``step``, from 0.
    """

    step: int
    what: str
    value: str = ""
    why: str = ""


def protocols(*, progress: Progress = silent) -> dict[str, str]:
    """Return the protocols as name and title."""
    return protocol_names()


def example(folder: str, *, progress: Progress = silent) -> None:
    """Make a folder of made-up slips with known truth."""
    with whole_folder(Path(folder)) as made:
        simulated_folder("slips", made, count=6, progress=progress)


def folder_view(asked: Mapping[str, Any], *, progress: Progress = silent) -> dict[str, Any]:
    """Return what a folder says as a whole (``study_parts``), a card a file, and notes.

    An InputError as ``analyse_folder``'s says what stands in the way of all of it.
    """
    analysis = _analysis(TrialsWork.of(asked), progress)
    parts = study_parts(analysis)
    return {
        **parts,
        "counts": dict(parts["counts"]),
        "title": analysis.protocol.title,
        "kind": analysis.protocol.kind,
        "notes": [*map(str, analysis.doubts), *analysis.notes, *analysis.study.notes],
        "cards": _cards(analysis),
    }


def written_report(asked: Mapping[str, Any], *, progress: Progress = silent) -> str:
    """Write the report of a folder and return the path of its page."""
    study = TrialsWork.of(asked)
    check_report_folder(study.report)
    analysis = _analysis(study, part(progress, 0.0, 0.4))
    drawing = part(progress, 0.4, 1.0)
    write_trials_report(analysis, study.report, processes=1, progress=drawing)
    put_language(study.report / "report.html")
    return str(study.report / "report.html")


def trial_view(
    asked: Mapping[str, Any],
    file: str,
    step: int | None = None,
    *,
    change: Mapping[str, Any] | None = None,
    keep: bool = False,
    progress: Progress = silent,
) -> dict[str, Any]:
    """Return a trial with its steps, edit log and plots of one step.

    ``step``: the number of that step; without it a slip, else the first accepted one.
    ``change``: what a ``HandEdit`` holds; the trial is shown as it would be with this edit.
    ``keep`` writes it to the folder's ``edits.csv``; that file's text before and after is then told
    as ``before`` and ``after``.

    EditError: the edit changes nothing, contradicts another or has no reason; nothing is written.
    """
    study = TrialsWork.of(asked)
    recording = study.recording(file)
    one = study.result(recording, file, store=study.store)
    texts: dict[str, str] = {}
    if change is not None:
        edit = HandEdit(**change)
        if not keep:
            edit = replace(edit, why=edit.why or "not said yet")
        before, after, edits = _change_edits(study, recording.name, one, edit)
        one = study.result(recording, file, edits=edits, store=study.store if keep else None)
        if keep:
            write_edit_text(study.folder, after)
            texts = {"before": before, "after": after}
    return {
        **_summary(one),
        "steps": [*map(parts, one.steps)],
        "edits": [*map(parts, one.edits)],
        "kind": study.protocol.kind,
        "run": one.run,
        **_plots(study, recording, one, step),
        **texts,
    }


def put_edits(
    asked: Mapping[str, Any], text: str, expected: str, *, progress: Progress = silent
) -> None:
    """Make ``text`` the folder's ``edits.csv``: undo and redo.

    InputError: it is not ``expected`` any more; nothing is written.
    """
    folder = Path(asked["folder"])
    if edit_text(folder) != expected:
        raise InputError(
            "the edits were changed by another program",
            where="edits.csv",
            remedy="Look at them again, then go on from there",
        )
    write_edit_text(folder, text)


def _analysis(study: TrialsWork, progress: Progress) -> FolderAnalysis:
    return analyse_folder(
        study.folder,
        study.protocol,
        **study.options,
        store=study.store,
        processes=1,  # a worker has no children
        progress=progress,
    )


def _change_edits(
    study: TrialsWork, name: str, record: FileResult, change: HandEdit
) -> tuple[str, str, list[Edit]]:
    """Return the text of ``edits.csv`` before and after a change, and the recording's edits then.

    A new edit takes the place of earlier ones of the step that it would contradict.
    """
    text = edit_text(study.folder)
    own = [(line, e) for line, f, e in edit_rows(study.folder, [name], others=True) if f == name]
    row: tuple[str, ...] = ()
    if change.what == "take back":
        logged = own if record.steps else [row for row in own if row[1].step == record.run]
        gone, new = {logged[change.step][0]}, []
    else:
        row = (name, str(change.step), change.what, change.value, change.why)
        new = [edit_from(*row[1:], "this edit")]
        gone = {
            line
            for line, edit in own
            if _number(edit, record) == change.step
            and (edit.what == change.what or "exclude" in (edit.what, change.what))
        }
    edits = [edit for line, edit in own if line not in gone] + new
    return text, with_edit_row(text, row, gone), edits


def _number(edit: Edit, record: FileResult) -> int:
    """Return the number of the step that an edit names by its number or a time within it."""
    if isinstance(edit.step, int) or not record.steps:
        return int(edit.step)
    at = edit.step
    return min(record.steps, key=lambda step: abs(step.contact - at)).number


def _cards(analysis: FolderAnalysis) -> list[dict[str, Any]]:
    """Return a card a file: verdict, numbers, conditions, reasons, edits and a small plot."""
    plots: dict[str, str] = {}
    # A trial is drawn once: as a slip where it is one, else by its steps or its run.
    for sheet in sorted(sheets(analysis.files), key=lambda each: each.kind != "heel"):
        tiles: dict[str, list[Tile]] = {}
        for file, tile in sheet.tiles:
            if len(tile.x):
                tiles.setdefault(file, []).append(tile)
        for file, own in tiles.items():
            plots.setdefault(file, tile_svg(own, sheet))
    return [
        {
            **_summary(result),
            "edits": len(result.edits),
            "noted": ", ".join(v for v in result.conditions.values() if isinstance(v, str)),
            "svg": plots.get(result.file, ""),
        }
        for result in analysis.files
    ]


def _summary(record: FileResult) -> dict[str, Any]:
    return {
        "file": record.file,
        "verdict": record.verdict,
        "numbers": _numbers(record),
        "conditions": {
            name: f"{value:g}" if isinstance(value, float) else str(value)
            for name, value in record.conditions.items()
        },
        "reasons": list(record.reasons),
    }


def _numbers(record: FileResult) -> list[Message]:
    """Return the main numbers of a file in words, with units."""
    texts = []
    for name, value in record.main.items():
        text = f"{scale_to_heading(name, value):.3g} {shown_unit(name)}".strip()
        if name in ("slip", "crossed_array"):
            text = "yes" if value else "no"
        texts.append(Message("{quantity} {value}", quantity=quantity_name(name), value=text))
    return texts


def _plots(
    study: TrialsWork, recording: Recording, record: FileResult, step: int | None
) -> dict[str, Any]:
    """Return the plot of the whole record and of what was chosen, None where there is none."""
    if not record.steps:
        return {"whole": None, "chosen": None, "plot": run_plot(record)}
    profile, _ = profile_of(study.folder, None)
    trials, *_ = recording_trials(recording.paths, profile)
    trial = trials[record.run - 1]
    signals = record_signals(trial, study.protocol, profile)
    order = {"accepted": 1, "caution": 1}
    first = min(record.steps, key=lambda s: 0 if s.judged_for_slip else order.get(s.verdict, 2))
    shown = next((each for each in record.steps if each.number == step), first)
    return {
        "whole": record_plot(record, signals),
        "chosen": shown.number,
        "plot": step_plot(record, shown, signals),
    }
