"""Units at the door, sourced values, errors, status, provenance, progress and the cache."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from underfoot.core.deprecation import renamed_classes

if TYPE_CHECKING:
    from .cache import Cache as Cache
    from .errors import Cancelled as Cancelled
    from .errors import ConvergenceError as ConvergenceError
    from .errors import DataError as DataError
    from .errors import InputError as InputError
    from .errors import MissingExtraError as MissingExtraError
    from .errors import RangeError as RangeError
    from .errors import UnderfootError as UnderfootError
    from .errors import nearest_match as nearest_match
    from .errors import unknown_name as unknown_name
    from .identity import content_hash as content_hash
    from .progress import Progress as Progress
    from .progress import silent as silent
    from .provenance import Provenance as Provenance
    from .remark import Remark as Remark
    from .status import Status as Status
    from .units import display as display
    from .units import to_si as to_si
    from .validity import Breach as Breach
    from .validity import TestedRange as TestedRange
    from .validity import breaches as breaches
    from .values import SourcedValue as SourcedValue

_HOMES = {
    "Cache": ".cache",
    "Cancelled": ".errors",
    "ConvergenceError": ".errors",
    "DataError": ".errors",
    "InputError": ".errors",
    "MissingExtraError": ".errors",
    "RangeError": ".errors",
    "UnderfootError": ".errors",
    "nearest_match": ".errors",
    "unknown_name": ".errors",
    "content_hash": ".identity",
    "Progress": ".progress",
    "silent": ".progress",
    "Provenance": ".provenance",
    "Remark": ".remark",
    "Status": ".status",
    "display": ".units",
    "to_si": ".units",
    "Breach": ".validity",
    "TestedRange": ".validity",
    "breaches": ".validity",
    "SourcedValue": ".values",
}

__all__ = [*_HOMES]  # pyright: ignore[reportUnsupportedDunderAll]


def __getattr__(name: str) -> Any:
    # what a command imports to print its help stays light: no arrays, no units
    if name not in _HOMES:
        return renamed_classes(__name__, gone="0.4", Range="TestedRange")(name)
    value = globals()[name] = getattr(import_module(_HOMES[name], __name__), name)
    return value
