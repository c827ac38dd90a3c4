"""Readers of measurement files: the format is found, the answer is a Trial or a DataError."""

from dataclasses import replace
from pathlib import Path

from underfoot.core import DataError, UnderfootError
from underfoot.core.deprecation import package_names
from underfoot.core.registry import find_offer
from underfoot.core.remark import Message

from ..recording.trial import Trial, file_checksum
from .draft import RecordingDraft
from .file_bytes import FileBytes
from .formats import (
    C3D,
    READERS,
    TABLE,
    TrialReader,
    file_format,
    nearest_format,
    trial_suffixes,
)
from .profile import PlateColumns, TrialsProfile, profile_from, read_profile, with_channels
from .sheet import Sheet, read_sheet

__all__ = [
    "READERS",
    "PlateColumns",
    "Sheet",
    "TrialReader",
    "TrialsProfile",
    "file_format",
    "nearest_format",
    "profile_from",
    "read_profile",
    "read_sheet",
    "read_trial",
    "read_trials",
    "trial_suffixes",
    "with_channels",
]

_LARGEST = 2_000_000_000  # bytes; a recording of hours stays far below
_LONG = 64_000_000  # bytes, above which a file is not held beside what was read of it


def read_trials(
    path: Path | str,
    profile: TrialsProfile | Path | str | None = None,
    *,
    subtract_baseline: bool = True,
) -> tuple[Trial, ...]:
    """Return the trials in a measurement file; most files hold one, tribometer logs one a step.

    Understood are the formats of ``READERS`` (C3D, TRC, MOT/STO, exports of Cortex, BioWare,
    Qualisys, Vicon and others), CSV, XLSX and XLS.

    ``profile``: what the columns, axes and heels are called: a ``TrialsProfile`` or a TOML file.
    ``subtract_baseline``: subtract the mean force of the unloaded samples from each plate.

    DataError: the file can't be read as any of these, with the reason. InputError: the profile is
    wrong.
    """
    path = Path(path)
    if profile is None:
        profile = TrialsProfile()
    elif not isinstance(profile, TrialsProfile):
        profile = read_profile(Path(profile))
    ending = path.suffix.casefold()
    data, file = _content(path, in_parts=ending in C3D.suffixes)
    reader = None if ending in trial_suffixes() else find_offer("trial_readers", ending[1:])
    if reader is None:
        kind = file_format(data, path)
        reader = (TABLE if kind.name == "BioWare" and profile.plates else kind).function
    subtracted = subtract_baseline and profile.subtract_baseline
    try:
        draft = RecordingDraft(data, path.name, profile, subtracted, file=file)
        trials = reader(draft)
    except UnderfootError as error:
        error.where = error.where or path.name
        raise
    except (ValueError, IndexError, KeyError, TypeError, ArithmeticError, MemoryError) as error:
        # Damaged files break assumptions in ways no check foresees; the user gets one kind of
        # answer, the programmer the cause.
        raise DataError(
            "damaged in a way that was not foreseen",
            where=path.name,
            remedy="Export the file again; if it opens elsewhere, please report it",
        ) from error
    finally:
        if file is not None:
            file.close()
    settings = {} if profile.body_mass is None else {"body mass (kg)": f"{profile.body_mass:g}"}
    accuracy = {} if profile.accuracy is None else {"accuracy": profile.accuracy}
    checksum = file_checksum(path)
    return tuple(
        replace(
            trial,
            checksum=checksum,
            settings={**trial.settings, **settings},
            plates=tuple(replace(plate, **accuracy) for plate in trial.plates),
        )
        for trial in (trials if isinstance(trials, tuple) else (trials,))
    )


def read_trial(
    path: Path | str,
    profile: TrialsProfile | Path | str | None = None,
    *,
    step: int | None = None,
    subtract_baseline: bool = True,
) -> Trial:
    """Return the one trial in a file, or trial number ``step`` (from 1) of several.

    Errors as ``read_trials``; several trials without ``step`` are a DataError.
    """
    trials, where = read_trials(path, profile, subtract_baseline=subtract_baseline), Path(path).name
    if step is None and len(trials) > 1:
        words, remedy = (
            Message("the file holds {count} steps", count=len(trials)),
            "Choose one with step=1 ...",
        )
        raise DataError(words, where=where, remedy=remedy)
    if not 1 <= (1 if step is None else step) <= len(trials):
        raise DataError(
            Message("there is no step {step}", step=step),
            where=where,
            allowed=f"1 to {len(trials)}",
        )
    return trials[0 if step is None else step - 1]


def _content(path: Path, *, in_parts: bool) -> tuple[bytes, FileBytes | None]:
    """Bytes of a file, or the long file that a reader reads ``in_parts``."""
    try:
        size = path.stat().st_size
        if size > _LARGEST:
            raise DataError("larger than any recording", where=path.name)
        if in_parts and size > _LONG:
            return b"", FileBytes(path)
        data = path.read_bytes()
    except OSError as error:
        words = Message("can't be read: {strerror}", strerror=error.strerror or error)
        raise DataError(words, where=path.name or str(path)) from error
    if not data:
        raise DataError("empty", where=path.name)
    return data, None


__getattr__ = package_names(__name__, gone="0.5", Draft="RecordingDraft", Profile="TrialsProfile")
