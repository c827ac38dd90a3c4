"""Dektak stylus profiles (CSV) with the results that the instrument printed itself."""

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from underfoot.core import DataError

from ._text import length_factor
from .profile import Profile, profile_from_positions

_QUANTITY = re.compile(r"([+-]?\d+(?:\.\d+)?)\s*([A-Za-zµμ]+)?")


@dataclass(frozen=True, slots=True)
class InstrumentResult:
    """A number that the instrument printed: over which part (m), in m or without unit."""

    name: str
    start: float
    end: float
    value: float
    unit: str


def is_dektak(path: Path | str) -> bool:
    """Return whether the file looks like a Dektak CSV export."""
    with Path(path).open("rb") as stream:
        return stream.read(64).lstrip(b"\xef\xbb\xbf").startswith(b"Scan Parameters")


def read_dektak(path: Path | str) -> tuple[Profile, tuple[InstrumentResult, ...]]:
    """Return the profile of a Dektak CSV file and the results in its header.

    Spacing and tip radius come from the header; printed positions are rounded and only checked
    against it.

    Raises:
        DataError: No such file, another format, heights missing.
    """
    path = Path(path)
    if not path.is_file():
        raise DataError("there is no such file", where=str(path))
    lines = path.read_bytes().decode("latin-1").splitlines()
    start = next((i for i, line in enumerate(lines) if line.startswith("Lateral")), None)
    if not is_dektak(path) or start is None:
        raise DataError("this is not a Dektak CSV file", where=str(path))
    heads = [cell.strip() for cell in lines[start].split(",")]
    lateral = length_factor(heads[0].split()[-1], f"{path}, line {start + 1}")
    vertical = length_factor(heads[1].split()[-1], f"{path}, line {start + 1}")
    rows: list[tuple[float, float]] = []
    for number, line in enumerate(lines[start + 1 :], start + 2):
        cells = line.split(",")
        if not line.strip(" ,"):
            continue
        try:
            rows.append((float(cells[0]), float(cells[1])))
        except (ValueError, IndexError):
            raise DataError(
                f'no position and height in line {number}: "{line[:40]}"', where=str(path)
            ) from None
    x, z = np.array(rows).T
    radius = next((line for line in lines[:start] if line.startswith("Stylus")), "")
    match = re.search(r"Radius:\s*(.*)", radius)
    profile = profile_from_positions(
        x * lateral,
        z * vertical,
        rounding=0.05 * lateral,
        tip_radius=_length(match.group(1), str(path)) if match else None,
        source=str(path),
    )
    return profile, _results(lines[:start], str(path))


def _results(header: list[str], where: str) -> tuple[InstrumentResult, ...]:
    start = next((i for i, line in enumerate(header) if line.startswith("Function,")), None)
    if start is None:
        return ()
    results = []
    for line in header[start + 1 :]:
        cells = [cell.strip() for cell in line.split(",")]
        if len(cells) < 6:
            break
        match = _QUANTITY.match(cells[5])
        if match is None:
            continue
        unit = "m" if match.group(2) else "1"
        value = _length(cells[5], where) if match.group(2) else float(match.group(1))
        results.append(
            InstrumentResult(
                cells[0], _length(cells[1], where), _length(cells[3], where), value, unit
            )
        )
    return tuple(results)


def _length(text: str, where: str) -> float:
    match = _QUANTITY.match(text)
    if match is None or not match.group(2):
        raise DataError(f'"{text}" is not a length', where=where)
    return float(match.group(1)) * length_factor(match.group(2), where)
