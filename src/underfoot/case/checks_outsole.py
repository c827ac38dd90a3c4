"""What must fit together when the outsole of a case is a file."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from underfoot.core import InputError, RangeError, display

if TYPE_CHECKING:
    from .case import Case
    from .places import Places


def outsole_mismatches(case: Case, places: Places) -> Iterator[InputError]:
    """Yield what does not fit together; the file itself is read when it is needed."""
    outsole, wear, thickness = case.shoe.outsole, case.shoe.wear, case.shoe.sole.outsole_thickness
    down, forward = outsole.down, outsole.forward
    if down[0] in "+-" and forward[0] in "+-" and down[1] == forward[1]:
        yield InputError(
            f"down {down} and forward {forward} lie on one axis",
            where=places("shoe.outsole.forward"),
            allowed="two different axes of the file",
        )
    finest = min(case.numerics.grid_spacing, case.numerics.quick_grid_spacing)
    if outsole.map_spacing > finest * (1 + 1e-9):
        yield RangeError(
            f"{display(outsole.map_spacing, 'm')} is coarser than the solver's grid",
            where=places("shoe.outsole.map_spacing"),
            allowed=f"at most {display(finest, 'm')}",
        )
    if wear.depth >= thickness:
        yield RangeError(
            f"{display(wear.depth, 'm')} goes through the outsole",
            where=places("shoe.wear.depth"),
            allowed=f"below {display(thickness, 'm')} (shoe.sole.outsole_thickness)",
        )
    if wear.depth == 0:
        return
    if wear.mode == "archard":
        yield InputError(
            'wear by pressure and sliding (mode = "archard") needs a parametric sole',
            where=places("shoe.wear.mode"),
            allowed='"plane" or "patch" with an outsole file',
        )
    if wear.mode == "patch":
        for name in ("patch_length", "patch_width"):
            if getattr(wear, name) is None:
                yield InputError('is missing for mode = "patch"', where=places(f"shoe.wear.{name}"))
