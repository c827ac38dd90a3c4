"""``underfoot check``: the whole case in words; solves nothing."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .options import AsJson, CasePath, CatalogueFolders, Settings, loaded

if TYPE_CHECKING:
    from underfoot.case import Case


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
    print(f"\n{cost_words(found)}")


def cost_words(case: Case) -> str:
    """Return what a run will take, in words; a warning where it would be refused."""
    from underfoot.case.build_motion import cost
    from underfoot.outsole.cost import megabytes

    numerics = case.numerics
    full, quick = cost(case, numerics.grid_spacing), cost(case, numerics.quick_grid_spacing)
    words = f"Cost: {full}, on one core; with --quick {quick}."
    if full.memory > numerics.most_memory:
        limit = megabytes(numerics.most_memory)
        words += f" Refused as it is: numerics.most_memory is {limit}."
    return words


def _listed(title: str, lines: list[str]) -> None:
    print(f"\n{title}:" + ("" if lines else " nothing"))
    for line in lines:
        print(f"  - {line}")
