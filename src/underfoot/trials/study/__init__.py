"""Analysis of whole folders of recordings by a protocol: numbers, statistics, reports, audits."""

from __future__ import annotations

from typing import TYPE_CHECKING

from underfoot.core.deprecation import package_names

if TYPE_CHECKING:
    from .file_result import ACCEPTED as ACCEPTED
    from .file_result import CAUTION as CAUTION
    from .file_result import REFUSED as REFUSED
    from .file_result import FileResult as FileResult
    from .folder import FolderAnalysis as FolderAnalysis
    from .folder import analyse_folder as analyse_folder
    from .folder import recording_results as recording_results
    from .study import TrialStudy as TrialStudy
    from .study import study_of as study_of
    from .tables import Finding as Finding
    from .tables import TrialTable as TrialTable

_HOMES = {
    "ACCEPTED": ".file_result",
    "CAUTION": ".file_result",
    "REFUSED": ".file_result",
    "FileResult": ".file_result",
    "Finding": ".tables",
    "FolderAnalysis": ".folder",
    "TrialStudy": ".study",
    "TrialTable": ".tables",
    "analyse_folder": ".folder",
    "recording_results": ".folder",
    "study_of": ".study",
}

__all__ = [*_HOMES]  # pyright: ignore[reportUnsupportedDunderAll]

__getattr__ = package_names(__name__, _HOMES, gone="0.5", Study="TrialStudy", Table="TrialTable")
