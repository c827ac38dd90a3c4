"""Old names that still answer: for one minor version, with a warning that names the new one.

The policy stands in ``CONTRIBUTING.md``; the names that answer so, in ``CHANGELOG.md``.
"""

import sys
from collections.abc import Callable, Mapping
from importlib import import_module
from types import MappingProxyType
from typing import Any
from warnings import warn


def renamed_member(old: str, new: str, *, gone: str) -> Callable[..., Any]:
    """Return a method for a class to keep as ``old``: it warns and answers as its member ``new``.

    ``gone``: version without the old name. The warning is a FutureWarning, which people see who
    only run a script, and points at the line that calls. For a field, make it a ``property``.
    """

    def answer(self: Any, *arguments: Any, **options: Any) -> Any:
        kind = self if isinstance(self, type) else type(self)  # of a class method
        message = f"{kind.__name__}.{old} is {new} now; the old name goes in {gone}"
        warn(message, FutureWarning, stacklevel=2)
        member = getattr(self, new)
        return member(*arguments, **options) if callable(member) else member

    answer.__name__ = old
    answer.__doc__ = f"Old name of ``{new}``, until {gone}."
    return answer


def package_names(
    package: str, homes: Mapping[str, str] = MappingProxyType({}), *, gone: str = "", **renamed: str
) -> Callable[[str], Any]:
    """Return a ``__getattr__`` of a package that loads a name when it is used, old ones too.

    Parameters:
        package: Its dotted name.
        homes: Module of each name, as ".module"; what a command imports stays light.
        gone: Version in which the old names go.
        renamed: The new name of each old one.
    """

    def answer(name: str) -> Any:
        room, new = sys.modules[package], renamed.get(name, name)
        if name in renamed:
            warn(f"{package}.{name} is {new} now; the old name goes in {gone}", FutureWarning, 2)
        elif name not in homes:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        if new not in vars(room):
            setattr(room, new, getattr(import_module(homes[new], package), new))
        return vars(room)[new]

    return answer
