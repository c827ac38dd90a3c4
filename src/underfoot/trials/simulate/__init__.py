"""Made-up measurements with known truth, clearly synthetic, for trying out and testing."""

from .c3d_file import NOTICE, walk_c3d
from .folder import KINDS, simulated_folder, slip_truth
from .tester import ScanTruth, scan_columns
from .walk import Defects, SlipTruth, WalkRecording, walk_with_slip

__all__ = [
    "KINDS",
    "NOTICE",
    "Defects",
    "ScanTruth",
    "SlipTruth",
    "WalkRecording",
    "scan_columns",
    "simulated_folder",
    "slip_truth",
    "walk_c3d",
    "walk_with_slip",
]
