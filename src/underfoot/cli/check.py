"""``underfoot check``: the whole case in words; solves nothing."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .options import AsJson, CasePath, CatalogueFolders, Settings, loaded

if TYPE_CHECKING:
    from underfoot.case import Case

SECONDS_PER_CELL = (0.4e-3, 1.2e-3)
"""Solution time of the example cases, untreaded to treaded, on one core of a small server."""


def check(
    case: CasePath,
    set_: Settings = None,
    catalogue: CatalogueFolders = None,
    json: AsJson = False,
) -> None:
    """Read a case and print all of it: values, sources, what is assumed, what it will cost."""
    from underfoot.case import assumptions
    from underfoot.case.describe import composition, rows, tested_range_breaches

    found = loaded(case, catalogue, set_)
    if json:
        import json as json_text

        content = {
            "name": found.name,
            "hash": found.hash,
            "values": [
                dict(zip(("path", "value", "origin"), row, strict=True)) for row in rows(found)
            ],
            "assumptions": assumptions(found),
            "breaches": tested_range_breaches(found),
        }
        print(json_text.dumps(content, indent=2, ensure_ascii=False))
        return
    print(composition(found))
    _listed("Assumed, with no measurement behind it", assumptions(found))
    _listed("Outside a tested range", tested_range_breaches(found))
    print(f"\n{cost(found)}")


def cost(case: Case) -> str:
    """Return what a run will take, in words."""
    if case.shoe.outsole.file is not None:
        from underfoot.case.build_outsole import file_sole_map

        area = file_sole_map(case, case.numerics.quick_grid_spacing).plan_area
    else:
        area = case.shoe.heel.length * case.shoe.heel.width
    full = _estimate(area / case.numerics.grid_spacing**2)
    quick = _estimate(area / case.numerics.quick_grid_spacing**2)
    return f"Cost: {full} on one core; with --quick {quick}."


def _estimate(cells: float) -> str:
    low, high = (seconds * cells for seconds in SECONDS_PER_CELL)
    return f"{cells:.0f} cells under the sole, about {low:.0f} to {high:.0f} s"


def _listed(title: str, lines: list[str]) -> None:
    print(f"\n{title}:" + ("" if lines else " nothing"))
    for line in lines:
        print(f"  - {line}")
