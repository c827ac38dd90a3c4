"""Readers of measurement files: the format is found, the answer is a Trial or a DataError."""

from __future__ import annotations

import hashlib
from dataclasses import replace
from pathlib import Path

from underfoot.core import DataError, UnderfootError

from ..trial import Trial
from .profile import PlateColumns, Profile, profile_from, read_profile
from .sheet import Sheet, read_sheet

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
]

SUFFIXES = (".c3d", ".trc", ".mot", ".sto", ".forces", ".txt", ".csv", ".tsv", ".dat", ".xlsx")
_LARGEST = 2_000_000_000  # bytes; a recording of hours stays far below


def file_format(data: bytes, path: Path) -> str:
    """Return the format of a file from its first bytes: the name's ending only breaks ties."""
    head = data[:4096]
    # "P" as second letter happens in text too: a C3D header holds binary zeros.
    signed = len(data) > 1 and data[1] == 0x50 and 0 < data[0] < 128
    if path.suffix.casefold() == ".c3d" or (signed and b"\0" in head):
        return "C3D"
    if head[:4] == b"PK\x03\x04":
        return "table"
    text = head.decode("latin-1").lstrip("ï»¿").casefold()
    if text.startswith("pathfiletype"):
        return "TRC"
    if "[force data]" in text[:100]:
        return "Cortex"
    if "cetr" in text[:200]:
        return "CETR"
    if "test data file" in text.split("\n", 1)[0]:
        return "PCS"
    if "endheader" in text or path.suffix.casefold() in (".mot", ".sto"):
        return "motion"
    if any(line.startswith("abs time") for line in text.splitlines()):
        return "BioWare"
    suffix = path.suffix.casefold()
    return {".trc": "TRC", ".forces": "Cortex"}.get(suffix, "table")


def read_trials(
    path: Path | str, profile: Profile | Path | str | None = None, *, subtract_baseline: bool = True
) -> tuple[Trial, ...]:
    """Return the trials in a measurement file; most files hold one, tribometer logs one a step.

    Parameters
    ----------
    path
        C3D, TRC, MOT/STO, Cortex .forces, BioWare text, CETR or PCS log, CSV or XLSX.
    profile
        What the columns, axes and heels are called: a ``Profile`` or a TOML file.
    subtract_baseline
        Subtract the mean force of the unloaded samples from each plate.

    Errors
    ------
    DataError
        The file can't be read as any of these, with the reason.
    InputError
        The profile is wrong.
    """
    path = Path(path)
    if profile is None:
        profile = Profile()
    elif not isinstance(profile, Profile):
        profile = read_profile(Path(profile))
    data = _bytes(path)
    checksum = hashlib.sha256(data).hexdigest()
    try:
        trials = _read(
            data, path, checksum, profile, subtract_baseline and profile.subtract_baseline
        )
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
    return tuple(replace(t, settings={**t.settings, **settings}) for t in trials)


def read_trial(
    path: Path | str,
    profile: Profile | Path | str | None = None,
    *,
    step: int | None = None,
    subtract_baseline: bool = True,
) -> Trial:
    """Return the one trial in a file, or trial number ``step`` (from 1) of several.

    Errors
    ------
    DataError
        As ``read_trials``; or several trials and no ``step``.
    """
    trials = read_trials(path, profile, subtract_baseline=subtract_baseline)
    if step is None and len(trials) > 1:
        raise DataError(
            f"the file holds {len(trials)} steps",
            where=Path(path).name,
            remedy="Choose one with step=1 ...",
        )
    if not 1 <= (step or 1) <= len(trials):
        raise DataError(
            f"there is no step {step}", where=Path(path).name, allowed=f"1 to {len(trials)}"
        )
    return trials[(step or 1) - 1]


def _bytes(path: Path) -> bytes:
    try:
        if path.stat().st_size > _LARGEST:
            raise DataError("larger than any recording", where=path.name)
        data = path.read_bytes()
    except OSError as error:
        raise DataError(
            f"can't be read: {error.strerror or error}", where=path.name or str(path)
        ) from error
    if not data:
        raise DataError("empty", where=path.name)
    return data


def _read(
    data: bytes, path: Path, checksum: str, profile: Profile, subtract: bool
) -> tuple[Trial, ...]:
    kind = file_format(data, path)
    if kind == "C3D":
        from .c3d import read_c3d

        return (read_c3d(data, path, checksum, subtract_baseline=subtract),)
    if kind == "TRC":
        from .trc import read_trc

        return (read_trc(data, path, checksum),)
    if kind == "Cortex":
        from .cortex_forces import read_cortex_forces

        return (read_cortex_forces(data, path, checksum, subtract_baseline=subtract),)
    if kind == "CETR":
        from .cetr import read_cetr

        return read_cetr(data, path, checksum)
    if kind == "PCS":
        from .pcs import read_pcs

        return read_pcs(data, path, checksum)
    if kind == "motion":
        from .motion import read_motion

        return (read_motion(data, path, checksum, subtract_baseline=subtract),)
    if kind == "BioWare" and not profile.plates:
        from .bioware import read_bioware

        return (read_bioware(data, path, checksum, subtract_baseline=subtract),)
    from .columns import read_columns

    return (read_columns(data, path, checksum, profile, subtract_baseline=subtract),)
