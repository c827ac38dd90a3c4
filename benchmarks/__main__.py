"""Run benchmarks: ``python -m benchmarks [NAME ...]``.

Without names: one table of all jobs that modules tell of by ``rows()``, kept in history.csv and
drawn; with names, each module's own tables.
"""

from __future__ import annotations

import importlib
import pkgutil
import sys

import benchmarks
from benchmarks import _table


def main(chosen: list[str]) -> int:
    """Run the chosen benchmark modules; each has a ``main()`` that prints its own table."""
    found = sorted(
        module.name
        for module in pkgutil.iter_modules(benchmarks.__path__)
        if not module.name.startswith("_")
    )
    unknown = set(chosen) - set(found)
    if unknown:
        print(f"unknown benchmark {', '.join(sorted(unknown))}; there are: {', '.join(found)}")
        return 2
    if not chosen:
        modules = (importlib.import_module(f"benchmarks.{name}") for name in found)
        rows = [row for module in modules if hasattr(module, "rows") for row in module.rows()]
        print(_table.printed(rows))
        _table.keep(rows)
        print(f"kept in {_table.HISTORY.name}, drawn in {_table.draw()}")
        print(f"more: python -m benchmarks {' '.join(found)}")
    for name in chosen:
        print(f"\n== {name}", flush=True)
        importlib.import_module(f"benchmarks.{name}").main()
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
