"""A folder of trials: every file analysed, in parallel, resumable; one bad file stops nothing."""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Mapping
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from underfoot.core import InputError, Progress, UnderfootError, content_hash, silent
from underfoot.core.provenance import version

from ..protocols import Protocol
from ..readers import SUFFIXES, Profile, read_profile, read_trials
from ..trial import Event, Trial, file_checksum, joined
from .conditions import conditions_of, edits_of
from .file_result import REFUSED, Draft, FileResult
from .kinds import analysed_trial
from .methods import methods_paragraphs
from .study import Study, study_of
from .tables import Table, edit_table, file_table, measurement_table

NOT_TRIALS = (
    "conditions.csv",
    "conditions.xlsx",
    "edits.csv",
    "edits.xlsx",
    "truth.csv",
    "synthetic.txt",
    "readme.txt",
    "license.txt",
    "licence.txt",
)
_FORCES = (".forces", ".mot", ".sto")
_STEP = "#"


@dataclass(frozen=True, slots=True)
class FolderAnalysis:
    """Everything a folder gave.

    ``files`` are sorted by name; ``methods`` is the text for a paper; ``notes`` hold files left
    aside and conditions without a file.
    """

    protocol: Protocol
    files: tuple[FileResult, ...]
    study: Study
    methods: tuple[str, ...]
    notes: tuple[str, ...]

    @property
    def tables(self) -> tuple[Table, ...]:
        """All tables: files, study, tests, measurements."""
        tests = (finding.table for finding in self.study.findings)
        edits = edit_table(self.files)
        log = () if edits is None else (edits,)
        files = file_table(self.files)
        return (files, *self.study.tables, *tests, *log, measurement_table(self.files))


def analyse_folder(
    folder: Path,
    protocol: Protocol,
    *,
    profile: Path | None = None,
    conditions: Path | None = None,
    store: Path | None = None,
    processes: int | None = None,
    progress: Progress = silent,
) -> FolderAnalysis:
    """Return the analysis of every trial file in a folder (not in folders below it).

    A file that can't be read or analysed is refused with its reason and the rest goes on. The
    same files, protocol, profile and conditions give the same result, whatever the number of
    processes.

    Parameters
    ----------
    profile
        What columns, axes and markers are called; by default ``profile.toml`` in the folder.
    conditions
        What was noted about the files; by default ``conditions.csv`` or ``.xlsx`` in the folder.
    store
        Folder that keeps the result of each file: an interrupted run goes on where it stopped.
    processes
        Number of processes; by default the number of processors.

    Errors
    ------
    InputError
        No such folder, no trial file in it, a wrong profile or table of conditions.
    """
    folder = Path(folder)
    groups, aside = _trial_files(folder)
    profile_path = profile or (
        folder / "profile.toml" if (folder / "profile.toml").is_file() else None
    )
    read = read_profile(profile_path) if profile_path else Profile()
    noted = conditions_of(folder, conditions)
    edits = edits_of(folder)
    names = {path.name for group in groups for path in group}
    notes = [f"{name}: noted in the conditions, but there is no such file" for name in noted
             if name not in names]  # fmt: skip
    notes += aside
    base = content_hash(protocol.key, _profile_key(profile_path), version(), _code_version())
    jobs = []
    for group in groups:
        own = next((noted[path.name] for path in group if path.name in noted), {})
        by_hand = [edit for path in group for edit in edits.get(path.name, [])]
        place = None if store is None else str(store)
        jobs.append((tuple(map(str, group)), own, by_hand, read, protocol, base, place))
    results = _run(jobs, processes or os.cpu_count() or 1, progress)
    files = tuple(sorted((one for part in results for one in part), key=lambda one: one.file))
    study = study_of(files, protocol)
    methods = tuple(methods_paragraphs(files, protocol, study, version()))
    return FolderAnalysis(protocol, files, study, methods, tuple(notes))


def _run(jobs: list[tuple[Any, ...]], processes: int, progress: Progress) -> list[list[FileResult]]:
    done: list[list[FileResult]] = []
    processes = min(processes, len(jobs))
    if processes <= 1 or len(jobs) < 4:
        for job in jobs:
            done.append(_job(job))
            progress("analysing files", len(done) / len(jobs))
        return done
    size = max(1, min(16, len(jobs) // (4 * processes)))
    try:
        with _pool(processes) as pool:
            try:
                for result in pool.map(_job, jobs, chunksize=size):
                    done.append(result)
                    progress("analysing files", len(done) / len(jobs))
            except BaseException:
                pool.shutdown(cancel_futures=True)
                raise
    except BrokenProcessPool:
        return _one_by_one(jobs, done, progress)
    return done


def _one_by_one(
    jobs: list[tuple[Any, ...]], done: list[list[FileResult]], progress: Progress
) -> list[list[FileResult]]:
    """Go on after a process died: find the file that kills it, and refuse that one alone."""
    if not _processes_work():
        # A script without its "if __name__" guard can't start processes: do the work here.
        for job in jobs[len(done) :]:
            done.append(_job(job))
            progress("analysing files", len(done) / len(jobs))
        return done
    pool = _pool(1)
    try:
        for job in jobs[len(done) :]:
            try:
                done.append(pool.submit(_job, job).result())
            except BrokenProcessPool:
                pool = _pool(1)
                name = Path(job[0][0]).name
                reason = "the process that analysed it ended without an answer"
                done.append([FileResult(name, "", REFUSED, (reason,))])
            progress("analysing files", len(done) / len(jobs))
    finally:
        pool.shutdown(cancel_futures=True)
    return done


def _pool(processes: int) -> ProcessPoolExecutor:
    import multiprocessing

    # Fresh processes: a forked one can inherit locks of numerical libraries' threads.
    context = multiprocessing.get_context("spawn")
    return ProcessPoolExecutor(processes, mp_context=context, initializer=_quiet)


def _processes_work() -> bool:
    try:
        with _pool(1) as pool:
            return pool.submit(os.getpid).result() > 0
    except BrokenProcessPool:
        return False


def _quiet() -> None:
    """One thread each: the processes share the processors already."""
    from threadpoolctl import threadpool_limits

    threadpool_limits(1)


def _job(job: tuple[Any, ...]) -> list[FileResult]:
    paths, noted, edits, profile, protocol, base, store = job
    files = [Path(path) for path in paths]
    name = files[0].name
    try:
        checksums = [file_checksum(path) for path in files]
    except OSError as error:
        reason = f"can't be read: {error.strerror or error}"
        return [FileResult(name, "", REFUSED, (reason,), conditions=noted)]
    key = content_hash(base, checksums, [path.name for path in files], noted, edits)
    kept = _load(store, key)
    if kept is not None:
        return kept
    results = _analysed(files, checksums[0], noted, edits, profile, protocol)
    _keep(store, key, results)
    return results


def _analysed(
    files: list[Path],
    checksum: str,
    noted: Mapping[str, Any],
    edits: list[tuple[str, float, str]],
    profile: Profile,
    protocol: Protocol,
) -> list[FileResult]:
    name = files[0].name
    try:
        trials = list(read_trials(files[0], profile))
        for other in files[1:]:
            trials = [joined(trials[0], read_trials(other, profile)[0])]
    except UnderfootError as error:
        return [FileResult(name, checksum, REFUSED, (str(error),), conditions=noted)]
    results = []
    for number, trial in enumerate(trials, start=1):
        for event, time, why in edits:
            trial = trial.with_event(Event(event, time), why=why)
        label = name if len(trials) == 1 else f"{name} {_STEP}{number}"
        results.append(_one(trial, label, checksum, noted, profile, protocol))
    return results


def _one(
    trial: Trial,
    label: str,
    checksum: str,
    noted: Mapping[str, Any],
    profile: Profile,
    protocol: Protocol,
) -> FileResult:
    draft = Draft(label, noted)
    draft.checksum = checksum
    try:
        analysed_trial(trial, draft, protocol, profile)
    except UnderfootError as error:
        draft.refusals.append(_plain(error))
    except Exception as error:
        # One odd file must not end the work on hundreds of others; the cause is kept.
        draft.refusals.append(f"the analysis failed ({type(error).__name__}: {error})")
    return draft.finished(protocol)


def _trial_files(folder: Path) -> tuple[list[list[Path]], list[str]]:
    """Return trial files, markers joined with the forces of the same name, and files set aside."""
    if not folder.is_dir():
        raise InputError(f"there is no folder {folder}", where="FOLDER")
    aside, found = [], []
    for path in sorted(folder.iterdir()):
        if not path.is_file() or path.name.startswith("."):
            continue
        if path.name.casefold() in NOT_TRIALS or path.suffix.casefold() == ".toml":
            continue
        if path.suffix.casefold() in SUFFIXES:
            found.append(path)
        else:
            aside.append(f"{path.name}: not a measurement file by its ending, left aside")
    if not found:
        raise InputError(
            f"the folder {folder} holds no trial file",
            where="FOLDER",
            allowed=", ".join(SUFFIXES),
        )
    markers = {path.stem: path for path in found if path.suffix.casefold() == ".trc"}
    partners = {p for p in found if p.suffix.casefold() in _FORCES and p.stem in markers}
    groups = []
    for path in found:
        if path in partners:
            continue
        same = [p for p in sorted(partners) if path == markers.get(p.stem)]
        groups.append([path, *same])
    return groups, aside


def _plain(error: UnderfootError) -> str:
    return str(error)


def _profile_key(path: Path | None) -> str:
    return "" if path is None else content_hash(path.read_text(encoding="utf-8-sig"))


def _code_version() -> str:
    """Raise this when the numbers of a file change, so that stored results are made again."""
    return "1"


def _load(store: str | None, key: str) -> list[FileResult] | None:
    if store is None:
        return None
    try:
        data = json.loads((Path(store) / f"{key}.json").read_text(encoding="utf-8"))
        return [FileResult.from_dict(one) for one in data]
    except (OSError, ValueError, TypeError):
        return None


def _keep(store: str | None, key: str, results: list[FileResult]) -> None:
    if store is None:
        return
    Path(store).mkdir(parents=True, exist_ok=True)
    handle, part = tempfile.mkstemp(dir=store, suffix=".part")
    with os.fdopen(handle, "w", encoding="utf-8") as stream:
        json.dump([one.as_dict() for one in results], stream)
    os.replace(part, Path(store) / f"{key}.json")
