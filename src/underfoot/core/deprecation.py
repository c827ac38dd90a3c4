"""Old names that still answer: for one minor version, with a warning that names the new one.

The policy stands in ``CONTRIBUTING.md``; the names that answer so, in ``CHANGELOG.md``.
"""

import sys
from collections.abc import Callable
from typing import Any
from warnings import warn


def renamed(old: str, new: str, *, gone: str) -> Callable[..., Any]:
    """Return a method for a class to keep as ``old``: it warns and answers as its member ``new``.

    ``gone``: version without the old name. The warning is a FutureWarning, which people see who
    only run a script, and points at the line that calls. For a field, make it a ``property``.
    """

    def answer(self: Any, *arguments: Any, **options: Any) -> Any:
        message = f"{type(self).__name__}.{old} is {new} now; the old name goes in {gone}"
        warn(message, FutureWarning, stacklevel=2)
        member = getattr(self, new)
        return member(*arguments, **options) if callable(member) else member

    answer.__name__ = old
    answer.__doc__ = f"Old name of ``{new}``, until {gone}."
    return answer


def renamed_classes(package: str, *, gone: str, **names: str) -> Callable[[str], Any]:
    """Return a ``__getattr__`` of a package whose classes answer to their old names.

    ``names``: the new name of each old one. ``gone``: version without the old names.
    """

    def answer(name: str) -> Any:
        if name not in names:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        new = names[name]
        warn(f"{package}.{name} is {new} now; the old name goes in {gone}", FutureWarning, 2)
        return getattr(sys.modules[package], new)

    return answer
