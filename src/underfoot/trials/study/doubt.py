"""A doubt about the files of a study, and the table of them."""

from collections.abc import Sequence
from dataclasses import dataclass

from underfoot.core.remark import Message

from .file_result import FileResult
from .tables import TrialTable


@dataclass(frozen=True, slots=True)
class Doubt:
    """One doubt about a study: what, the files it is about, and whether they are out.

    Files of an ``out`` doubt take no part in means and tests.
    """

    message: Message
    files: tuple[str, ...]
    out: bool = False

    def __str__(self) -> str:
        shown = ", ".join(self.files[:4]) + (" ..." if len(self.files) > 4 else "")
        return f"{self.message} ({shown}){'; left out' if self.out else ''}"


def doubt_table(doubts: Sequence[Doubt]) -> TrialTable | None:
    """Return the doubts as a table, a row each, or None where there is none."""
    if not doubts:
        return None
    rows = tuple(
        (d.message, "yes" if d.out else "", len(d.files), ", ".join(d.files)) for d in doubts
    )
    heads = ("doubt", "left out of means and tests", "number", "files")
    return TrialTable.of("doubts", "Read this first: doubts about the study's files", heads, rows)


def names_of(files: Sequence[FileResult]) -> tuple[str, ...]:
    """Return the names of files, for a doubt."""
    return tuple(file.file for file in files)
