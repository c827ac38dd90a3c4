"""Analysis of whole folders of recordings by a protocol: numbers, statistics, reports, audits."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .file_result import ACCEPTED as ACCEPTED
    from .file_result import CAUTION as CAUTION
    from .file_result import REFUSED as REFUSED
    from .file_result import FileResult as FileResult
    from .folder import FolderAnalysis as FolderAnalysis
    from .folder import analyse_folder as analyse_folder
    from .folder import recording_results as recording_results
    from .study import Study as Study
    from .study import study_of as study_of
    from .tables import Finding as Finding
    from .tables import Table as Table

_HOMES = {
    "ACCEPTED": ".file_result",
    "CAUTION": ".file_result",
    "REFUSED": ".file_result",
    "FileResult": ".file_result",
    "Finding": ".tables",
    "FolderAnalysis": ".folder",
    "Study": ".study",
    "Table": ".tables",
    "analyse_folder": ".folder",
    "recording_results": ".folder",
    "study_of": ".study",
}

__all__ = [*_HOMES]  # pyright: ignore[reportUnsupportedDunderAll]


def __getattr__(name: str) -> Any:
    # statistics are loaded when they are used
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_HOMES[name], __name__), name)
