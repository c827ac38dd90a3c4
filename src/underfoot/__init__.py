"""Underfoot: the friction between a shoe, a floor and what is spilled on it.

>>> from underfoot import Case, run
>>> result = run(Case.load("examples/work_shoe_untreaded_glycerol.toml"))  # doctest: +SKIP
>>> result.value("cof")  # doctest: +SKIP
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .case import Case
    from .case.result import Result
    from .case.run import run

__all__ = ["Case", "Result", "run"]

_HOMES = {"Case": ".case", "Result": ".case.result", "run": ".case.run"}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from importlib import import_module

    return getattr(import_module(_HOMES[name], __name__), name)


def __dir__() -> list[str]:
    return sorted([*globals(), *_HOMES])
