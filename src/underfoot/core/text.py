"""Text files of instruments: encoding, cells, decimal commas, what stands for a missing value."""

from pathlib import Path

import numpy as np

from .errors import DataError

MISSING = frozenset(
    {"", "nan", "na", "n/a", "#n/a", "null", "none", "-", "--", "***", "bad", "no data", "1.#qnan"}
)


def existing(path: Path | str) -> Path:
    """Return the path of a file; refuse one that is not there."""
    path = Path(path)
    if not path.is_file():
        raise DataError("there is no such file", where=str(path))
    return path


def numbered_lines(path: Path | str, remedy: str) -> list[tuple[int, str]]:
    """Return the lines of a text file (UTF-8, else Latin-1) with their numbers, from 1.

    Raises:
        DataError: No such file, or a binary one, with the ``remedy`` for that.
    """
    raw = existing(path).read_bytes()
    if b"\x00" in raw[:4096]:
        raise DataError("this is a binary file", where=str(path), remedy=remedy)
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = raw.decode("latin-1")
    return list(enumerate(text.splitlines(), 1))


def with_content(lines: list[tuple[int, str]]) -> list[tuple[int, str]]:
    """Return the lines that are neither empty nor a comment."""
    return [(i, line) for i, line in lines if line.strip() and not line.lstrip().startswith("#")]


def cells_of(line: str, separator: str | None) -> list[str]:
    """Return the cells of a line, blanks and quotes around them removed; None: blanks separate."""
    return [cell.strip().strip('"') for cell in line.split(separator)]


def row_of_numbers(cells: list[str], comma: bool, line: int, where: str) -> list[float]:
    """Return the numbers of a row, NaN where one is missing; ``comma``: the decimal sign is one.

    Raises:
        DataError: Text among the numbers.
    """
    row = []
    for cell in cells:
        try:
            missing = cell.casefold() in MISSING
            row.append(np.nan if missing else float(cell.replace(",", ".") if comma else cell))
        except ValueError:
            raise DataError(
                f'"{cell}" in line {line} is not a number', where=where, allowed="numbers"
            ) from None
    return row
