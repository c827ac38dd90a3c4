"""Made-up measurements with known truth, clearly synthetic, for trying out and testing."""

from .c3d_file import NOTICE as NOTICE
from .c3d_file import walk_c3d as walk_c3d
from .folder import KINDS as KINDS
from .folder import ScanTruth as ScanTruth
from .folder import scan_columns as scan_columns
from .folder import simulated_folder as simulated_folder
from .folder import slip_truth as slip_truth
from .treadmill import treadmill_walk as treadmill_walk
from .walk import Defects as Defects
from .walk import SlipTruth as SlipTruth
from .walk import WalkRecording as WalkRecording
from .walk import walk_with_slip as walk_with_slip
