"""Underfoot: the friction between a shoe, a floor and what is spilled on it.

import underfoot as uf

case = uf.load("examples/work_shoe_untreaded_glycerol.toml")
uf.run(case).value("cof")
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from underfoot.core.moved import answer_old_paths

if TYPE_CHECKING:
    from underfoot.case import Case, load
    from underfoot.case.explanation import explain
    from underfoot.compute.result import Result
    from underfoot.compute.run import run
    from underfoot.core.catalogue import catalogue
    from underfoot.explore import Study, optimise, sweep
    from underfoot.questions.comparison import compare

    __version__: str

answer_old_paths()

__all__ = [
    "Case",
    "Result",
    "Study",
    "__version__",
    "catalogue",
    "compare",
    "explain",
    "load",
    "optimise",
    "run",
    "sweep",
]

_HOMES = {
    "Case": ".case",
    "Result": ".compute.result",
    "Study": ".explore",
    "catalogue": ".core.catalogue",
    "compare": ".questions.comparison",
    "explain": ".case.explanation",
    "load": ".case",
    "optimise": ".explore",
    "run": ".compute.run",
    "sweep": ".explore",
}


def __getattr__(name: str) -> Any:
    if name == "__version__":
        return import_module(".core.provenance", __name__).version()
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_HOMES[name], __name__), name)


def __dir__() -> list[str]:
    return __all__
