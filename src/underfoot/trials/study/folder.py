"""A folder of trials: every file analysed, in parallel, resumable; one bad file stops nothing."""

import json
import os
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from underfoot.core import Progress, UnderfootError, content_hash, silent, unknown_name
from underfoot.core.pool import available_processors, in_processes
from underfoot.core.provenance import version
from underfoot.core.remark import Message, from_stored, stored_form

from ..readers import TrialsProfile, read_trials, with_channels
from ..recording.protocols import Protocol
from ..recording.tester_calibration import FILE as CALIBRATION
from ..recording.tester_calibration import read_calibration
from ..recording.trial import Edit, Trial, file_checksum, join_trials
from ..walking.body_weight import body_mass
from ..walking.events import EditError
from .conditions import body_mass_noted, person_condition, profile_of, study_folder
from .doubt import Doubt, doubt_table
from .edit_table import edits_of
from .file_result import REFUSED, FileResult, FileResultDraft
from .methods import methods_paragraphs
from .readings import reading_results
from .steps import STEP_KINDS, analysed_trial, check_ramp
from .study import TrialStudy, study_of
from .study_guard import guarded_files, study_doubts
from .tables import TrialTable, curve_table, edit_table, file_table, measurement_table, step_tables

_CODE = "9"  # raised when what a file gives changes, so that stored results are made again
_OTHER_MASS = 0.1  # relative; shoes and clothes weigh less
_DIED = "the process that analysed it ended without an answer"


@dataclass(frozen=True, slots=True)
class FolderAnalysis:
    """Everything a folder gave.

    ``files`` are sorted by name; ``methods`` is the text for a paper; ``notes`` hold files left
    aside and conditions without a file; ``doubts`` are what the files say against each other, to
    be read before the statistics.
    """

    protocol: Protocol
    files: tuple[FileResult, ...]
    study: TrialStudy
    methods: tuple[str, ...]
    notes: tuple[str, ...]
    doubts: tuple[Doubt, ...] = ()

    @property
    def person(self) -> str:
        """Name of the condition that says whom a file is of, or nothing."""
        return person_condition(self.files, self.protocol.text("subject"))

    @property
    def tables(self) -> tuple[TrialTable, ...]:
        """All tables: files, study, tests, edits, steps, curves over stance, measurements."""
        files = self.files
        tests = (finding.table for finding in self.study.findings)
        found = (edit_table(files), *step_tables(files), curve_table(files))
        steps = (table for table in found if table is not None)
        first = [table for table in [doubt_table(self.doubts)] if table is not None]
        last = measurement_table(files)
        return (*first, file_table(files), *self.study.tables, *tests, *steps, last)


def analyse_folder(
    folder: Path,
    protocol: Protocol,
    *,
    profile: Path | None = None,
    conditions: Path | None = None,
    names: str = "",
    merge_spelling: bool = False,
    store: Path | None = None,
    processes: int | None = None,
    progress: Progress = silent,
) -> FolderAnalysis:
    """Return the analysis of every trial file in a folder and in the folders below it.

    A file that can't be read or analysed is refused with its reason and the rest goes on. The
    same files, protocol, profile and conditions give the same result, whatever the number of
    processes.

    ``profile``: what columns, axes and markers are called; by default ``profile.toml`` in the
    folder. ``conditions``: what was noted about the files; by default ``conditions.csv`` or
    ``.xlsx`` in the folder; the calibration record of a tester is its ``calibration.toml``.
    ``names`` and ``merge_spelling``: pattern of file names and what spellings count as one; see
    ``study_folder``. ``store``: folder that keeps the result of each file: an interrupted run goes
    on where it stopped. ``processes``: number of processes; by default the number of processors.

    InputError: no such folder, no trial file in it, a wrong profile, ramp or table of conditions.
    EditError: an edit by hand that names no step, changes nothing or contradicts another.
    """
    jobs, notes = _jobs(Path(folder), protocol, profile, conditions, names, merge_spelling, store)
    results = _run(jobs, processes or available_processors(), progress)
    files, doubts = guarded_files(results)
    doubts += study_doubts(files, protocol)
    out = {name for doubt in doubts if doubt.out for name in doubt.files}
    study = study_of([file for file in files if file.file not in out or not file.usable], protocol)
    methods = tuple(methods_paragraphs(files, protocol, study, version()))
    return FolderAnalysis(protocol, tuple(files), study, methods, notes, tuple(doubts))


def recording_results(
    folder: Path,
    name: str,
    protocol: Protocol,
    *,
    edits: Sequence[Edit] | None = None,
    names: str = "",
    merge_spelling: bool = False,
    store: Path | None = None,
) -> list[FileResult]:
    """Return what ``analyse_folder`` finds in one recording, without the work for the others.

    ``name`` is that of a ``Recording`` of the folder. ``edits`` stand in place of those that the
    folder's ``edits.csv`` has for it: what an edit would do before it is written. The rest and the
    errors are those of ``analyse_folder``; an unknown name is an InputError too.
    """
    jobs, _ = _jobs(Path(folder), protocol, None, None, names, merge_spelling, store)
    job = next((job for job in jobs if job[0] == name), None)
    if job is None:
        raise unknown_name("recording", name, [job[0] for job in jobs], where=str(folder))
    return _job(job if edits is None else (*job[:3], list(edits), *job[4:]))


def _jobs(
    folder: Path,
    protocol: Protocol,
    profile: Path | None,
    conditions: Path | None,
    names: str,
    merge_spelling: bool,
    store: Path | None,
) -> tuple[list[tuple[Any, ...]], tuple[str, ...]]:
    """Return what ``_job`` takes for each recording of a folder; notes on what is left aside."""
    check_ramp(protocol)
    names = names or protocol.text("names")
    study_files = study_folder(
        folder, conditions=conditions, names=names, merge_spelling=merge_spelling
    )
    read, text = profile_of(folder, profile)
    columns = protocol.text("friction"), protocol.text("normal")
    read = with_channels(read, *columns, where=protocol.where)
    record = folder / CALIBRATION
    if record.is_file():
        read = replace(read, calibration=read_calibration(record))
        text += record.read_text(encoding="utf-8-sig")
    edits = edits_of(folder, [recording.name for recording in study_files.recordings])
    base = content_hash(protocol.key, text and content_hash(text), version(), _CODE)
    jobs: list[tuple[Any, ...]] = [
        (one.name, one.paths, one.conditions, edits.get(one.name, []), read, protocol, base, store)
        for one in study_files.recordings
    ]
    return jobs, study_files.notes


def _run(jobs: list[tuple[Any, ...]], processes: int, progress: Progress) -> list[list[FileResult]]:
    count = processes if len(jobs) >= 4 else 1  # a process takes longer to start than a file
    stage = "analysing files"
    answers = in_processes(_job, jobs, count, progress=progress, stage=stage, died=_death_result)
    return [results for _, results in sorted(answers, key=lambda answer: answer[0])]


def _death_result(job: tuple[Any, ...]) -> list[FileResult]:
    return [FileResult(job[0], "", REFUSED, (_DIED,))]


def _job(job: tuple[Any, ...]) -> list[FileResult]:
    name, files, noted, edits, *_, base, store = job
    try:
        checksums = [file_checksum(path) for path in files]
    except OSError as error:
        reason = Message("can't be read: {strerror}", strerror=error.strerror or error)
        return [FileResult(name, "", REFUSED, (reason,), conditions=noted)]
    key = content_hash(
        base, checksums, name, [p.name for p in files], noted, list(map(repr, edits))
    )
    if store is None:
        return _analyse_file(checksums[0], *job[:6])
    path = store / f"{key}.json"
    try:
        kept = json.loads(path.read_text(encoding="utf-8"))
        return [FileResult.from_dict(from_stored(one)) for one in kept]
    except (OSError, ValueError, TypeError, KeyError):
        pass
    results = _analyse_file(checksums[0], *job[:6])
    store.mkdir(parents=True, exist_ok=True)
    handle, part = tempfile.mkstemp(dir=store, suffix=".part")
    with os.fdopen(handle, "w", encoding="utf-8") as stream:
        # faster than json.dump
        stream.write(
            json.dumps([stored_form(result.as_dict()) for result in results], default=list)
        )
    os.replace(part, path)
    return results


def _analyse_file(
    checksum: str,
    name: str,
    files: tuple[Path, ...],
    noted: dict[str, Any],
    edits: list[Edit],
    profile: TrialsProfile,
    protocol: Protocol,
) -> list[FileResult]:
    if protocol.kind == "readings":
        try:
            return reading_results(name, files[0], checksum, noted, protocol, profile.calibration)
        except UnderfootError as error:
            return [FileResult(name, checksum, REFUSED, (error.message,), conditions=noted)]
    trials, refusals, notes = recording_trials(files, profile)
    if not trials:
        return [FileResult(name, checksum, REFUSED, tuple(refusals), conditions=noted)]
    notes += [Message("left out: {reason}", reason=reason) for reason in refusals]
    if protocol.kind not in STEP_KINDS:
        _check_whole_edits(edits, len(trials), protocol)
    results = []
    mass = body_mass_noted(noted)
    for number, trial in enumerate(trials, start=1):
        own = body_mass(trial)
        if mass is not None:
            if own and abs(own / mass - 1.0) > _OTHER_MASS:
                notes.append(
                    Message(
                        "mass {noted:g} kg by the conditions, {recorded:g} kg in the recording",
                        noted=mass,
                        recorded=own,
                    )
                )
            trial = replace(trial, settings={**trial.settings, "body mass (kg)": f"{mass:g}"})
        steps = protocol.kind in STEP_KINDS
        trial = trial.with_edits(*(edit for edit in edits if steps or edit.step == number))
        label = name if len(trials) == 1 else f"{name} #{number}"
        draft = FileResultDraft(label, noted, checksum)
        draft.cautions += notes
        try:
            analysed_trial(trial, draft, protocol, profile)
        except EditError as error:
            error.what = Message("{label}: {what}", label=label, what=error.what)
            raise
        except UnderfootError as error:
            draft.refusals.append(error.message)
        except Exception as error:
            # One odd file must not end the work on hundreds of others; the cause is kept.
            draft.refusals.append(
                Message(
                    "the analysis failed ({kind}: {error})",
                    kind=type(error).__name__,
                    error=str(error),
                )
            )
        results.append(replace(draft.finish_result(protocol), run=number))
    return results


def recording_trials(
    files: Sequence[Path], profile: TrialsProfile
) -> tuple[list[Trial], list[str], list[Message]]:
    """Return the trials in the files of one recording, why files can't be read, and notes."""
    notes: list[Message] = []
    trials: list[Trial] = []
    refusals: list[str] = []
    for file in files:
        try:
            read = read_trials(file, profile)
        except UnderfootError as error:
            refusals.append(error.message)
            continue
        if not trials:
            trials = list(read)
        elif len(trials) == len(read) == 1:
            trials = [join_trials(trials[0], read[0])]
        else:
            notes.append(
                Message("{file} holds {count} trials: not joined", file=file.name, count=len(read))
            )
    return trials, refusals, notes


def _check_whole_edits(edits: list[Edit], trials: int, protocol: Protocol) -> None:
    """Where a file holds runs and no steps, an edit can only exclude a run by its number."""
    for i, edit in enumerate(edits):
        if edit.what != "exclude":
            text = Message(
                "the protocol {name} has no steps: {what} changes nothing",
                name=protocol.name,
                what=edit.what,
            )
            raise EditError(text, where=edit.where, allowed="exclude")
        if edit.step not in range(1, trials + 1):
            text = Message("there is no {step_words}", step_words=edit.step_words)
            raise EditError(text, where=edit.where, allowed=f"1 to {trials}")
        if any(edit.step == other.step for other in edits[:i]):
            raise EditError(
                Message("{step_words} is excluded twice", step_words=edit.step_words),
                where=edit.where,
            )
