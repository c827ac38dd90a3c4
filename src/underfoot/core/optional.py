"""Optional packages: imported where they are needed, with the remedy where they are missing."""

from collections.abc import Callable
from importlib import import_module
from typing import Any

from .errors import MissingExtraError

try:
    from numba import njit
except ImportError:

    def njit(*_: Any, **__: Any) -> Callable[[Any], Any]:
        """Leave a kernel as it is where numba is not installed: the same numbers, slower."""
        return lambda function: function


__all__ = ["njit", "optional_module"]


def optional_module(name: str, extra: str, purpose: str) -> Any:
    """Return the module ``name`` of a package that only some features need.

    Raises ``MissingExtraError`` where it is not installed or does not load: ``extra`` of this
    package installs it, ``purpose`` is what needs it, as the subject of a sentence.
    """
    try:
        return import_module(name)
    except ImportError as error:
        raise MissingExtraError(name.partition(".")[0], extra, purpose) from error
