"""Folders of results: what was computed first, pictures after it, the page last.

A file that can't be written never costs another one; each failure is one line with its remedy.
"""

from __future__ import annotations

import csv
import errno
import json
import os
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from underfoot.core import Cancelled, UnderfootError
from underfoot.core.files import whole_folder
from underfoot.core.presentation import Presentable, Table
from underfoot.core.remark import Message
from underfoot.core.text import harmless

Writer = Callable[[Path], object]
WRITTEN_IN_PART = 6
"""Exit code of a command that computed everything and could not write some of it."""
_REMEDIES = {
    errno.ENOSPC: "free some space",
    errno.EDQUOT: "the quota is used up; free some space",
    errno.EACCES: "check the permissions of the folder",
    errno.EROFS: "choose a folder that can be written",
    errno.ENAMETOOLONG: "choose a shorter name",
}


@dataclass(frozen=True, slots=True)
class Written:
    """What was written: the folder, the page in it, and one line for each file that failed."""

    folder: Path
    page: Path | None
    failures: tuple[str, ...] = ()

    def lines(self) -> list[str]:
        """Return where the files are and what is missing."""
        files = Message("Files in {folder}", folder=self.folder)
        if self.page is not None:
            files = Message("{files}; open {page}", files=files, page=self.page)
        return [files, *self.failures]


def write_folder(
    folder: Path | str,
    data: Mapping[str, Writer],
    pictures: Mapping[str, Writer],
    page: Writer | None = None,
    *,
    overwrite: bool = False,
) -> Written:
    """Write a folder as a whole and return what could be written.

    ``data``, ``pictures`` and ``page`` (report.html) are written in this order, each by a function
    of its path. Data that does not fit on the disk goes to a folder for temporary files instead.
    """
    folder = Path(folder)
    pages = {} if page is None else {"report.html": page}
    failed: dict[str, str] = {}
    with whole_folder(folder, overwrite=overwrite) as staging:
        for name, write in (*data.items(), *pictures.items(), *pages.items()):
            if failure := _failure(staging / name, write):
                failed[name] = failure
        has_page = (staging / "report.html").exists()
    lost = {name: write for name, write in data.items() if name in failed}
    failures = (*failed.values(), *([_rescue(lost)] if lost else []))
    return Written(folder, folder / "report.html" if has_page else None, failures)


def write_text(text: str) -> Writer:
    """Return the writer of a text file."""
    return lambda path: path.write_text(text, encoding="utf-8")


def write_csv(table: Table) -> Writer:
    """Return the writer of a table as CSV; what is missing is an empty cell."""

    def write(path: Path) -> None:
        with path.open("w", newline="", encoding="utf-8") as stream:
            writer = csv.writer(stream)
            writer.writerow(table.columns)
            writer.writerows([_csv_cell(value) for value in row] for row in table.rows)

    return write


def json_text(shown: Presentable, *, advice: Presentable | None = None) -> str:
    """Return the JSON of an object: kind, name, headline, cautions, then its own keys in SI."""
    content = _content(shown)
    if advice is not None:
        content["advice"] = _content(advice)
    return data_text(content)


def data_text(content: Any) -> str:
    """Return data as JSON: null for what is no finite number, text for what JSON does not know."""
    return json.dumps(_finite(content), indent=2, ensure_ascii=False, default=_item) + "\n"


def _content(shown: Presentable) -> dict[str, Any]:
    return {
        "format": 1,
        "kind": shown.kind,
        "name": shown.heading(),
        "usable": shown.usable,
        "headline": list(shown.headline()),
        "cautions": list(shown.cautions()),
        **shown.to_dict(),
    }


def data_writers(shown: Presentable) -> dict[str, Writer]:
    """Return the data files of an object: its kind as JSON and a CSV file for each data table."""
    tables = {f"{stem}.csv": write_csv(table) for stem, table in shown.data_tables().items()}
    return {f"{shown.kind}.json": lambda path: write_text(json_text(shown))(path), **tables}


def _failure(path: Path, write: Writer) -> str:
    """Write one file; return what went wrong with it, or nothing."""
    try:
        write(path)
        return ""
    except Cancelled:
        raise
    except Exception as error:
        if os.environ.get("UNDERFOOT_DEBUG") == "1":
            raise
        path.unlink(missing_ok=True)
        return f"{path.name} could not be written: {_reason(error)}"


def _reason(error: Exception) -> str:
    if isinstance(error, UnderfootError):
        return error.message
    if isinstance(error, OSError):
        remedy = _REMEDIES.get(error.errno or 0, "choose another folder")
        return f"{(error.strerror or str(error)).lower()}; {remedy}."
    if isinstance(error, ImportError):
        package = (error.name or str(error)).partition(".")[0]
        return Message(
            "the package {package} is missing; install it with: pip install {package}",
            package=package,
        )
    return Message(
        "internal error ({name}: {error}); please report it.",
        name=type(error).__name__,
        error=error,
    )


def _rescue(lost: Mapping[str, Writer]) -> str:
    """Write what was computed into a folder for temporary files and return where it is."""
    folder = Path(tempfile.mkdtemp(prefix="underfoot-"))
    saved = [name for name, write in lost.items() if not _failure(folder / name, write)]
    if not saved:
        folder.rmdir()
        return Message("Not saved anywhere: {lost}.", lost=", ".join(lost))
    return Message("Saved in {folder} instead: {saved}.", folder=folder, saved=", ".join(saved))


def _csv_cell(value: Any) -> Any:
    if value is None or value != value:
        return ""
    return repr(float(value)) if isinstance(value, float) else harmless(str(value))


def _finite(value: Any) -> Any:
    """Return plain data with None for what JSON has no number for."""
    if isinstance(value, float):
        return value if abs(value) < float("inf") else None
    if isinstance(value, Mapping):
        return {str(key): _finite(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(item) for item in value]
    return value


def _item(value: Any) -> Any:
    """Return a number of NumPy as one of Python, anything else as text."""
    return _finite(value.item()) if hasattr(value, "item") else str(value)
