"""Made-up measurements with known truth, clearly synthetic, for trying out and testing."""

from .folder import KINDS, NOTICE, simulated_folder, slip_truth, walk_c3d
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
