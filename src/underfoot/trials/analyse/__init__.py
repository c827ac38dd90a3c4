"""Analysis of whole folders by a protocol."""

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
