"""``underfoot check``: the whole case in words; solves nothing."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .options import AsJson, CasePath, CatalogueFolders, Settings, loaded

if TYPE_CHECKING:
    from underfoot.case import Case


MIDDLING_AREA = 2e-3
"""m^2: a heel touches on some 20 cm2, for the pressure at which ranges are looked at."""


def check(
    case: CasePath,
    set_: Settings = None,
    catalogue: CatalogueFolders = None,
    json: AsJson = False,
) -> None:
    """Read a case and print all of it: values, sources, what is assumed, what it will cost."""
    from underfoot.case import assumptions
    from underfoot.case.describe import composition, given_in_vain, rows

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
            "breaches": breaches(found),
            "given_in_vain": given_in_vain(found),
        }
        print(json_text.dumps(content, indent=2, ensure_ascii=False))
        return
    print(composition(found))
    _listed("Assumed, with no measurement behind it", assumptions(found))
    _listed("Outside a tested range, as far as it shows before solving", breaches(found))
    aside = given_in_vain(found)
    if aside:
        _listed("Given, but looked at by none of the chosen models", aside)
    print(f"\n{cost_words(found)}")


def breaches(case: Case) -> list[str]:
    """Return what is known before solving to lie outside a tested range."""
    import numpy as np

    from underfoot.case import build
    from underfoot.case.describe import tested_range_breaches
    from underfoot.core import InputError

    found = tested_range_breaches(case)
    try:
        law = build.friction_law(case, case.catalogue)
    except InputError as error:
        return [*found, f"a run would be refused: {error}"]
    pressure = np.array([case.motion.normal_force / MIDDLING_AREA])
    local = {
        "contact_pressure": pressure,
        "speed": case.motion.speed,
        "film_thickness": np.full(1, 1e-5),
    }
    return list(dict.fromkeys([*found, *(str(breach) for breach in law.breaches(**local))]))


def cost_words(case: Case) -> str:
    """Return what a run will take, in words; a warning where it would be refused."""
    from underfoot.case.build_motion import cost
    from underfoot.outsole.cost import megabytes

    numerics = case.numerics
    full, quick = cost(case, numerics.grid_spacing), cost(case, numerics.quick_grid_spacing)
    words = f"Cost: {full}, on one core; with --quick {quick}."
    words += "".join(
        f" {more}"
        for wanted, more in (
            (
                case.models.compliance == "finite_element",
                "The finite-element sole takes up to a minute and 2 GB more, once: it is kept.",
            ),
            (
                case.models.asperity == "contact_table",
                "The contact table takes minutes more, once: it is kept.",
            ),
            (
                case.motion.history is not None or case.motion.history_points is not None,
                "A history takes several times as long.",
            ),
        )
        if wanted
    )
    if full.memory > numerics.most_memory:
        limit = megabytes(numerics.most_memory)
        words += f" Refused as it is: numerics.most_memory is {limit}."
    return words


def _listed(title: str, lines: list[str]) -> None:
    print(f"\n{title}:" + ("" if lines else " nothing"))
    for line in lines:
        print(f"  - {line}")
