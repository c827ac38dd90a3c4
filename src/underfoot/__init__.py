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
    from .case.explanation import explain
    from .compute.result import Result
    from .compute.run import run
    from .core.catalogue import catalogue
    from .questions.comparison import compare

    Study: Any
    optimise: Any
    sweep: Any
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
    "explain": ".case.explanation",
    "load": ".case",
    "run": ".compute.run",
}
_OFFERED = ("Study", "optimise", "sweep")
"""Names of the wing of design studies."""


def __getattr__(name: str) -> Any:
    if name == "__version__":
        return import_module(".core.provenance", __name__).version()
    if name in _OFFERED:
        return import_module(".core.registry", __name__).offered("names", name)
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_HOMES[name], __name__), name)


def __dir__() -> list[str]:
    return __all__
