"""Underfoot: the friction between a shoe, a floor and what is spilled on it.

import underfoot as uf

case = uf.load("examples/work_shoe_untreaded_glycerol.toml")
uf.run(case).value("cof")
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .case import Case, load
    from .compute.result import Result
    from .compute.run import run
    from .core.catalogue import catalogue
    from .explore import Study, optimise, sweep
    from .questions.comparison import compare
    from .questions.explanation import explain

    __version__: str

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
    "catalogue": ".core.catalogue",
    "compare": ".questions.comparison",
    "explain": ".questions.explanation",
    "Study": ".explore.study",
    "load": ".case",
    "optimise": ".explore.sweeps",
    "run": ".compute.run",
    "sweep": ".explore.sweeps",
}


def __getattr__(name: str) -> Any:
    if name == "__version__":
        return import_module(".core.provenance", __name__).version()
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_HOMES[name], __name__), name)


def __dir__() -> list[str]:
    return __all__
