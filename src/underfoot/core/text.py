"""Text files of instruments: encoding, cells, decimal commas, what stands for a missing value."""

import csv
import re
from pathlib import Path

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
    """Return the lines of a text file with their numbers, from 1.

    Raises:
        DataError: No such file, or a binary or empty one, with the ``remedy`` for that.
    """
    return list(
        enumerate(decode_text(existing(path).read_bytes(), str(path), remedy).splitlines(), 1)
    )


def decode_text(data: bytes, where: str, remedy: str = "Export it again as text") -> str:
    """Return the text of a file: UTF-8, UTF-16, else Latin-1; a DataError for binary content."""
    wide = utf16_of(data)
    try:
        text = data.decode(wide or "utf-8-sig")
    except UnicodeDecodeError as error:
        if wide:
            raise DataError("damaged UTF-16 text", where=where) from error
        text = data.decode("latin-1")
    if "\0" in text or not text.strip():
        raise DataError(
            "binary, not a text file" if "\0" in text else "empty", where=where, remedy=remedy
        )
    return text


def utf16_of(data: bytes) -> str:
    """Return the name of the encoding when a file is UTF-16 (with or without its mark), or ""."""
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return "utf-16"
    head = data[: min(400, len(data)) // 2 * 2]
    if len(head) < 20:
        return ""
    for name, blank, filled in (("utf-16-le", head[1::2], head[::2]),
                                ("utf-16-be", head[::2], head[1::2])):  # fmt: skip
        # a letter that is not Latin may stand among them
        if blank.count(0) >= 0.8 * len(blank) and all(filled):
            text = head.decode(name, "replace")
            return "" if re.search(r"[\x01-\x08\x0e-\x1f\ufffd]", text) else name
    return ""


def harmless(cell: str) -> str:
    """Return a cell that no spreadsheet runs as a formula: such text gets a quote before it."""
    return f"'{cell}" if re.match(r"(?s)[=@\t\r]|[+-].*([|!]|[A-Za-z]\()", cell) else cell


def with_content(lines: list[tuple[int, str]]) -> list[tuple[int, str]]:
    """Return the lines that are neither empty nor a comment."""
    return [(i, line) for i, line in lines if line.strip() and not line.lstrip().startswith("#")]


def cells_of(line: str, separator: str | None) -> list[str]:
    """Return the cells of a line, blanks and quotes around them removed; None: blanks separate.

    A separator between quotes is part of the cell.
    """
    if '"' not in line:
        return [cell.strip() for cell in line.split(separator)]
    if separator is None:
        found = re.findall(r'"[^"]*"(?=\s|$)|\S+', line)
        return [_strip_quotes(cell) for cell in found]
    row = next(csv.reader([line], delimiter=separator, skipinitialspace=True), [])
    return [cell.strip() for cell in row]


def _strip_quotes(cell: str) -> str:
    return cell[1:-1].strip() if len(cell) > 1 and cell[0] == cell[-1] == '"' else cell


def excerpt(cell: str, longest: int = 40) -> str:
    """Return what a cell of a damaged file holds as a message can show it."""
    plain = "".join(letter if letter.isprintable() else "?" for letter in cell)
    return plain if len(plain) <= longest else f"{plain[: longest - 3]}..."
