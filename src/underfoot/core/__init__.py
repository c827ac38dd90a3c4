"""Units at the door, sourced values, errors, status, provenance, progress and the cache."""

from typing import TYPE_CHECKING

from underfoot.core.deprecation import package_names

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
    from .unit_text import display as display
    from .units import to_si as to_si
    from .validity import Breach as Breach
    from .validity import ValidityRange as ValidityRange
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
    "display": ".unit_text",
    "to_si": ".units",
    "Breach": ".validity",
    "ValidityRange": ".validity",
    "breaches": ".validity",
    "SourcedValue": ".values",
}

__all__ = [*_HOMES]  # pyright: ignore[reportUnsupportedDunderAll]

__getattr__ = package_names(__name__, _HOMES, gone="0.5", Range="ValidityRange")
