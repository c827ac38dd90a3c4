"""A tread of any form: coefficients of a height map in a cell that repeats, for a study to vary."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import product
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

from pydantic import Field, create_model

from underfoot.core import InputError, RangeError, display
from underfoot.core.remark import Message

from .quantity import Angle, Length, Quantity, default
from .section import CaseView
from .sole import Lugs

if TYPE_CHECKING:
    from underfoot.shoe.lettering import Lettering

LEAST_FLOOR = 0.5e-3
"""m: of a channel between walls with draft: a rib of the mould that still fills (assumed)."""
LEAST_LAND, MOST_LAND = 0.1, 0.9
LARGEST_CELL = 40
"""Smallest widths in a cell at most: waves are far longer than they beyond it, and slow to cut."""
MOST_WAVES = 2
"""Waves along or across a cell at most: 24 coefficients, 14 of them with a mirror."""
Coefficient = Annotated[float, Quantity("1", -1.0, 1.0)]
Share = Annotated[float, Quantity("1", 0.0, 1.0)]
_WAVES = ["cos0", *(f"{wave}{n}" for n in range(1, MOST_WAVES + 1) for wave in ("cos", "sin"))]
TERMS = tuple(f"{along}_{across}" for along, across in product(_WAVES, _WAVES))[1:]
"""Names of the coefficients: waves along the shoe, waves across it."""
# the fields have names that are made: they can't be written below
_FIELDS: Any = {name: (Coefficient, default(0.0, "0", "no such wave")) for name in TERMS}
_Waves = create_model("_Waves", __base__=Lugs, **_FIELDS)


def keeps(symmetry: str, name: str) -> bool:
    """Return whether a term has a symmetry."""
    along, across = name.split("_")
    even_along, even_across = along[:3] == "cos", across[:3] == "cos"
    return {
        "none": True,
        "mirror": even_across,
        "two_fold": even_along == even_across,
        "both": even_along and even_across,
        "glide": even_across == (int(along[3]) % 2 == 0),
    }[symmetry]


class FreeTread(_Waves):
    """Land where a periodic height map is high: lugs, channels and networks of any form.

    The map is the sum of coefficient x wave along x wave across; ``cos1_sin2`` is that of
    cos(2 pi x / cell_length) sin(4 pi y / cell_width). It is cut where the land has its share;
    ``lug_width`` and ``channel_width`` are the smallest that land and channels have anywhere, and
    the diameter of their roundest corners. A factor of all coefficients changes nothing.
    """

    name: ClassVar[str] = "free"
    kind: ClassVar[str] = "lettering"
    source: ClassVar[str] = "level set of a Fourier series, opened by discs (Serra, 1982)"

    lug_width: Length = Field(description="smallest width of land")
    channel_width: Length = Field(description="smallest width of a channel")
    land: Share = Field(description="share of land, 0.1 to 0.9")
    cell_length: Length = Field(description="period along the shoe")
    cell_width: Length = Field(description="period across the shoe")
    symmetry: Literal["mirror", "glide", "two_fold", "both", "none"] = default(
        "mirror", "mirror", "left and right shoe are alike; both: mirror and two-fold"
    )
    mould_draft: Angle = default(
        0.0, "0 deg", "walls are drawn upright; the floor of a channel must be left with this draft"
    )

    @property
    def coefficients(self) -> dict[str, float]:
        """Coefficients that are not 0, by name."""
        return {name: getattr(self, name) for name in TERMS if getattr(self, name)}

    def letters(self) -> Lettering:
        """Return the outlines of the land."""
        from underfoot.shoe.free_land import free_land

        return free_land(
            tuple(self.coefficients.items()),
            (self.cell_length, self.cell_width),
            self.land,
            self.lug_width,
            self.channel_width,
        )

    def problems(self, case: CaseView, where: str) -> Iterator[InputError]:
        """Yield what keeps it from being a tread."""
        first = [*super().problems(case, where), *self._unlike(where), *self._too_small(where)]
        yield from first
        if not first:
            try:
                self.letters()
            except InputError as error:
                yield InputError(
                    error.what, where=f"{where}.land", allowed=error.allowed, remedy=error.remedy
                )

    def _unlike(self, where: str) -> Iterator[InputError]:
        """Yield what is wrong with the coefficients."""
        allowed = [name for name in TERMS if keeps(self.symmetry, name)]
        if not self.coefficients:
            yield InputError(
                "all coefficients are 0: the height map is flat",
                where=where,
                allowed=", ".join(allowed),
                remedy="Write cos1_cos0 = 1 for bars across the shoe, cos1_cos1 = 1 for lugs",
            )
        for name in self.coefficients:
            if name not in allowed:
                yield InputError(
                    f'is not of the symmetry "{self.symmetry}"',
                    where=f"{where}.{name}",
                    allowed=", ".join(allowed),
                    remedy='Write symmetry = "none", or leave it out',
                )

    def _too_small(self, where: str) -> Iterator[InputError]:
        """Yield what leaves no room for a tread."""
        if not LEAST_LAND <= self.land <= MOST_LAND:
            yield RangeError(
                f"{self.land:g}",
                where=f"{where}.land",
                allowed=Message("{low:g} to {high:g}", low=LEAST_LAND, high=MOST_LAND),
                remedy='Write pattern = "none" for a sole without tread',
            )
        cell, both = max(self.cell_length, self.cell_width), self.lug_width + self.channel_width
        if both > cell:
            yield RangeError(
                f"a cell of {display(cell, 'm')} has no room for land of "
                f"{display(self.lug_width, 'm')} and a channel",
                where=f"{where}.channel_width",
                allowed=f"below {display(max(cell - self.lug_width, 0.0), 'm')} (cell - lug_width)",
                remedy="Take a larger cell_length or cell_width",
            )
        longest = LARGEST_CELL * min(self.lug_width, self.channel_width)
        for name in ("cell_length", "cell_width"):
            if getattr(self, name) > longest:
                yield RangeError(
                    f"{display(getattr(self, name), 'm')} is far longer than its land and channels",
                    where=f"{where}.{name}",
                    allowed=f"up to {display(longest, 'm')} ({LARGEST_CELL} smallest widths)",
                )
        floor = self.channel_width - 2 * self.depth * math.tan(self.mould_draft)
        if floor < LEAST_FLOOR:
            widest = (self.channel_width - LEAST_FLOOR) / 2 / math.tan(self.mould_draft or 1.0)
            yield RangeError(
                f"walls with a draft of {display(self.mould_draft, 'rad')} close a channel of "
                f"{display(self.channel_width, 'm')}",
                where=f"{where}.mould_draft",
                allowed=f"a floor of {display(LEAST_FLOOR, 'm')}: a depth up to "
                f"{display(max(widest, 0.0), 'm')}",
                remedy="Take a wider channel_width, less depth or less draft",
            )
