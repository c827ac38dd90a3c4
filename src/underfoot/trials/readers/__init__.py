"""Readers of measurement files: the format is found, the answer is a Trial or a DataError."""

import hashlib
from dataclasses import replace
from importlib import import_module
from pathlib import Path

from underfoot.core import DataError, UnderfootError

from ..trial import Trial
from .draft import Draft
from .profile import PlateColumns, Profile, profile_from, read_profile, with_channels
from .sheet import Sheet, is_workbook, read_sheet
from .text import utf16_of

__all__ = [
    "PlateColumns",
    "Profile",
    "Sheet",
    "file_format",
    "profile_from",
    "read_profile",
    "read_sheet",
    "read_trial",
    "read_trials",
    "with_channels",
]

SUFFIXES = (
    ".c3d", ".trc", ".mot", ".sto", ".forces", ".txt", ".csv", ".tsv", ".dat", ".xlsx", ".xls",
    ".mat", ".json", ".asc", ".fgt", ".asf",
)  # fmt: skip
_LARGEST = 2_000_000_000  # bytes; a recording of hours stays far below
_READERS = {
    "C3D": "c3d.read_c3d", "TRC": "text_exports.read_trc", "motion": "text_exports.read_motion",
    "Cortex": "text_exports.read_cortex_forces", "BioWare": "text_exports.read_bioware",
    "Qualisys": "text_exports.read_qualisys", "Vicon": "text_exports.read_vicon_csv",
    "CETR": "instrument_logs.read_cetr", "PCS": "instrument_logs.read_pcs",
    "JSON": "pose_json.read_pose_json", "MATLAB": "matlab.read_matlab",
    "Pedar": "instrument_logs.read_pedar", "F-Scan": "instrument_logs.read_fscan",
    "table": "columns.read_columns",
}  # fmt: skip


def file_format(data: bytes, path: Path) -> str:
    """Return the format of a file from its first bytes: the name's ending only breaks ties."""
    head, suffix = data[:4096], path.suffix.casefold()
    # "P" as second letter happens in text too: a C3D header holds binary zeros.
    signed = len(data) > 1 and data[1] == 0x50 and 0 < data[0] < 128
    wide = utf16_of(data)
    if suffix == ".c3d" or (signed and b"\0" in head and not wide):
        return "C3D"
    if is_workbook(data):
        return "table"
    if head.startswith((b"MATLAB 5.0", b"MATLAB 7.3", b"\x89HDF")) or suffix == ".mat":
        return "MATLAB"
    text = head[: len(head) // 2 * 2].decode(wide or "latin-1", "replace")
    text = text.lstrip("\ufeffï»¿").casefold()
    lines = text.splitlines() or [""]
    found = {
        "TRC": text.startswith("pathfiletype"),
        "Cortex": "[force data]" in text[:100],
        "CETR": "cetr" in text[:200],
        "PCS": "test data file" in lines[0],
        "Qualisys": text.startswith(("no_of_frames", "no_of_samples")),
        "Vicon": lines[0].strip(' ,"') in ("devices", "trajectories", "model outputs", "joints"),
        "F-Scan": text.startswith("data_type") or (suffix == ".asf" and "rows" in text),
        "Pedar": any(line.startswith("time[secs]") for line in lines),
        "JSON": suffix == ".json" or text.lstrip().startswith("{"),
        "motion": "endheader" in text or suffix in (".mot", ".sto"),
        "BioWare": any(line.startswith("abs time") for line in lines),
    }
    by_suffix = {".trc": "TRC", ".forces": "Cortex", ".fgt": "Pedar"}
    return next((name for name, yes in found.items() if yes), by_suffix.get(suffix, "table"))


def read_trials(
    path: Path | str, profile: Profile | Path | str | None = None, *, subtract_baseline: bool = True
) -> tuple[Trial, ...]:
    """Return the trials in a measurement file; most files hold one, tribometer logs one a step.

    Understood are C3D, TRC, MOT/STO, Cortex .forces, BioWare text, Qualisys TSV, Vicon CSV,
    MATLAB, JSON of pose systems, Pedar or F-Scan text, CETR or PCS log, CSV, XLSX or XLS.

    ``profile``: what the columns, axes and heels are called: a ``Profile`` or a TOML file.
    ``subtract_baseline``: subtract the mean force of the unloaded samples from each plate.

    DataError: the file can't be read as any of these, with the reason. InputError: the profile is
    wrong.
    """
    path = Path(path)
    if profile is None:
        profile = Profile()
    elif not isinstance(profile, Profile):
        profile = read_profile(Path(profile))
    data = _bytes(path)
    kind = file_format(data, path)
    if kind == "BioWare" and profile.plates:
        kind = "table"
    module, _, function = _READERS[kind].partition(".")
    reader = getattr(import_module(f".{module}", __package__), function)
    subtracted = subtract_baseline and profile.subtract_baseline
    try:
        trials = reader(Draft(data, path.name, profile, subtracted))
    except UnderfootError:
        raise
    except (ValueError, IndexError, KeyError, TypeError, ArithmeticError, MemoryError) as error:
        # Damaged files break assumptions in ways no check foresees; the user gets one kind of
        # answer, the programmer the cause.
        raise DataError(
            f"damaged in a way that was not foreseen ({type(error).__name__}: {error})",
            where=path.name,
            remedy="Export the file again; if it opens elsewhere, please report it",
        ) from error
    settings = {} if profile.body_mass is None else {"body mass (kg)": f"{profile.body_mass:g}"}
    accuracy = {} if profile.accuracy is None else {"accuracy": profile.accuracy}
    checksum = hashlib.sha256(data).hexdigest()
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
    profile: Profile | Path | str | None = None,
    *,
    step: int | None = None,
    subtract_baseline: bool = True,
) -> Trial:
    """Return the one trial in a file, or trial number ``step`` (from 1) of several.

    Errors as ``read_trials``; several trials without ``step`` are a DataError.
    """
    trials, where = read_trials(path, profile, subtract_baseline=subtract_baseline), Path(path).name
    if step is None and len(trials) > 1:
        words, remedy = f"the file holds {len(trials)} steps", "Choose one with step=1 ..."
        raise DataError(words, where=where, remedy=remedy)
    if not 1 <= (step or 1) <= len(trials):
        raise DataError(f"there is no step {step}", where=where, allowed=f"1 to {len(trials)}")
    return trials[(step or 1) - 1]


def _bytes(path: Path) -> bytes:
    try:
        if path.stat().st_size > _LARGEST:
            raise DataError("larger than any recording", where=path.name)
        data = path.read_bytes()
    except OSError as error:
        words = f"can't be read: {error.strerror or error}"
        raise DataError(words, where=path.name or str(path)) from error
    if not data:
        raise DataError("empty", where=path.name)
    return data
