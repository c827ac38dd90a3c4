"""Optional packages: imported where they are needed, with the remedy where they are missing."""

from importlib import import_module
from typing import Any

from .errors import MissingExtraError


def optional_module(name: str, extra: str, purpose: str) -> Any:
    """Return the module ``name`` of a package that only some features need.

    Raises ``MissingExtraError`` where it is not installed or does not load: ``extra`` of this
    package installs it, ``purpose`` is what needs it, as the subject of a sentence.
    """
    try:
        return import_module(name)
    except ImportError as error:
        raise MissingExtraError(name.partition(".")[0], extra, purpose) from error
