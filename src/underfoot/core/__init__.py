"""Units at the door, sourced values, errors, status, provenance, progress and the cache."""

from .cache import Cache, content_hash
from .errors import (
    Cancelled,
    ConvergenceError,
    DataError,
    InputError,
    MissingExtraError,
    RangeError,
    UnderfootError,
    nearest_match,
    unknown_name,
)
from .progress import Progress, silent
from .provenance import Provenance
from .status import Status
from .units import display, to_si
from .validity import Breach, Range, breaches
from .values import SourcedValue

__all__ = [
    "Breach",
    "Cache",
    "Cancelled",
    "ConvergenceError",
    "DataError",
    "InputError",
    "MissingExtraError",
    "Progress",
    "Provenance",
    "Range",
    "RangeError",
    "SourcedValue",
    "Status",
    "UnderfootError",
    "breaches",
    "content_hash",
    "display",
    "nearest_match",
    "silent",
    "to_si",
    "unknown_name",
]
