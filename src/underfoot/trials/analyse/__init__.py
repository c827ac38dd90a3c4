"""Analysis of whole folders by a protocol."""

from .file_result import ACCEPTED, CAUTION, REFUSED, FileResult
from .folder import FolderAnalysis, analyse_folder
from .study import Study, study_of
from .study_tests import Finding
from .tables import Table

__all__ = [
    "ACCEPTED",
    "CAUTION",
    "REFUSED",
    "FileResult",
    "Finding",
    "FolderAnalysis",
    "Study",
    "Table",
    "analyse_folder",
    "study_of",
]
