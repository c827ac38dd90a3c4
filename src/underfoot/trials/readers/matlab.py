"""MATLAB files (.mat, version 5 and 7.3): exports of Qualisys, or named arrays."""

import pickle
import re
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator, Mapping
from io import BytesIO
from typing import Any

import numpy as np

from underfoot.core import DataError

from ..recording.trial import Trial
from .columns import trial_from_sheet
from .draft import RecordingDraft
from .sheet import Sheet

_HDF5 = b"\x89HDF\r\n\x1a\n"
_FORCE = re.compile(r"(^|[^a-z])(f|force|grf)\d*$", re.IGNORECASE)
_RATE = ("fs", "rate", "framerate", "frequency", "samplerate", "fps")
_LARGEST = 200_000_000  # bytes of one array
_PATIENCE = 15.0  # s


def read_matlab(draft: RecordingDraft) -> Trial:
    """Return the recording in a .mat file.

    Understood: the structure that Qualisys Track Manager writes, and plain arrays: vectors are
    columns; arrays of three columns are markers, or forces when called so (``F``, ``Force1``,
    ``GRF``); ``time`` or a scalar ``fs`` gives the rate.
    """
    content = _content(draft.data, draft.name)
    for value in content.values():
        if isinstance(value, Mapping) and ("Trajectories" in value or "Force" in value):
            return _qualisys(draft, value)
    numbers: dict[str, np.ndarray] = {}
    header: list[str] = []
    for name, value in _arrays(content):
        if value.size == 1 and name.casefold().rsplit(".", 1)[-1] in _RATE:
            header.append(f"rate = {float(value.ravel()[0]):g} Hz")
        elif value.ndim == 1 and value.size > 1:
            numbers[name] = value
        elif value.ndim == 2 and 3 in value.shape and value.size > 3:
            columns = value if value.shape[1] == 3 else value.T
            force = _FORCE.search(name)
            for i, axis in enumerate("xyz"):
                numbers[f"{name} F{axis}" if force else f"{name}_{axis}"] = columns[:, i]
    if not numbers:
        raise draft.error("no array of samples", allowed=", ".join(content) or "arrays")
    lengths = Counter(len(v) for v in numbers.values())
    longest = max(sorted(lengths), key=lambda n: lengths[n])
    other = [name for name, v in numbers.items() if len(v) != longest]
    notes = (f"arrays of another length are left out: {', '.join(other[:6])}",) if other else ()
    columns = {n: np.asarray(v, dtype=float) for n, v in numbers.items() if len(v) == longest}
    sheet = Sheet(draft.name, columns, {}, {}, tuple(header), notes)
    return trial_from_sheet(draft, sheet, "MATLAB")


def _content(data: bytes, where: str) -> dict[str, Any]:
    """Return the variables of a file as nested dictionaries of arrays.

    Both libraries can end the whole process on a damaged file: another one does the reading.
    """
    code = (
        f"import sys; sys.path[:] = {sys.path!r}; from {__name__} import send_content; "
        "send_content()"
    )
    try:
        done = subprocess.run(
            [sys.executable, "-c", code], input=data, capture_output=True, timeout=_PATIENCE
        )
        content = pickle.loads(done.stdout) if done.returncode == 0 else None
    except (subprocess.TimeoutExpired, pickle.UnpicklingError, EOFError):
        content = None
    if not isinstance(content, dict):
        raise DataError("the file is damaged", where=where, remedy="Save it again in MATLAB")
    return content


def send_content() -> None:
    """Read a file from standard input and write its variables to standard output (pickled)."""
    data = sys.stdin.buffer.read()
    if _HDF5 in data[:1024]:
        import h5py

        with h5py.File(BytesIO(data), "r") as file:
            content = _group(file)
    else:
        from scipy.io import loadmat

        read = loadmat(BytesIO(data), struct_as_record=False, squeeze_me=True)
        content = {name: _plain(v) for name, v in read.items() if not name.startswith("__")}
    sys.stdout.buffer.write(pickle.dumps(content))


def _plain(value: Any) -> Any:
    if hasattr(value, "_fieldnames"):
        return {field: _plain(getattr(value, field)) for field in value._fieldnames}
    array = np.asarray(value)
    if array.dtype == object:
        return [_plain(item) for item in array.ravel()]
    return array


def _group(group: Any) -> dict[str, Any]:
    import h5py

    content: dict[str, Any] = {}
    for name, item in group.items():
        if name.startswith("#"):
            continue
        if isinstance(item, h5py.Group):
            content |= {f"{name}.{k}": v for k, v in _group(item).items()}
        elif item.dtype.kind in "fiu" and item.size * item.dtype.itemsize < _LARGEST:
            # MATLAB writes the first index fastest: arrays arrive transposed.
            content[name] = np.squeeze(item[()].T)
    return content


def matlab_arrays(data: bytes, where: str) -> Iterator[tuple[str, np.ndarray]]:
    """Yield the arrays of numbers of a .mat file with their names."""
    return _arrays(_content(data, where))


def _arrays(content: Mapping[str, Any], before: str = "") -> Iterator[tuple[str, np.ndarray]]:
    for name, value in content.items():
        if isinstance(value, Mapping):
            yield from _arrays(value, f"{before}{name}.")
        elif isinstance(value, np.ndarray) and value.dtype.kind in "fiu":
            yield f"{before}{name}", np.atleast_1d(value)


def _qualisys(draft: RecordingDraft, value: Mapping[str, Any]) -> Trial:
    labelled = _part(_part(value, "Trajectories"), "Labeled")
    if labelled:
        places = np.asarray(labelled["Data"], dtype=float)
        places = places[None] if places.ndim == 2 else places
        labels = [str(x) for x in np.atleast_1d(labelled["Labels"])]
        draft.rate = float(value["FrameRate"])
        for i, name in enumerate(draft.names(labels, "marker")):
            draft.marker(name, 1e-3 * places[i, :3].T)
    forces = value.get("Force", [])
    forces = [forces] if isinstance(forces, Mapping) else forces
    forces = [one for one in forces if isinstance(one, Mapping)]
    for number, one in enumerate(forces, start=1):
        force, corners, place = (
            np.asarray(one.get(key, []), dtype=float)
            for key in ("Force", "ForcePlateLocation", "COP")
        )
        if force.ndim != 2 or 3 not in force.shape:
            draft.notes.append(f"plate {number} holds no forces")
            continue
        force = force.T if force.shape[0] == 3 else force
        draft.rate = float(one["Frequency"])
        draft.plate(
            force,
            f"plate {number}",
            centre_of_pressure=1e-3 * place.T if place.shape == force.T.shape else None,
            corners=1e-3 * corners if corners.shape == (4, 3) else None,
            kind="Qualisys MATLAB export, taken as laboratory axes",
        )
    if not draft.markers and not draft.plates:
        raise draft.error("no markers and no forces")
    return draft.trial("Qualisys MATLAB")


def _part(value: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    part = value.get(name, {})
    return part if isinstance(part, Mapping) else {}
