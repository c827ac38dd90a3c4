"""Readings of other durometers as Shore A."""

from __future__ import annotations

import re
from dataclasses import dataclass

from underfoot.core import InputError
from underfoot.core.remark import Message
from underfoot.core.typed import split_quantity


@dataclass(frozen=True, slots=True)
class DurometerScale:
    """A scale and its line to Shore A: A = ``offset`` + ``slope`` S.

    ``low`` and ``high`` bound the readings for which the source gives the line; ``spread`` is the
    uncertainty of the converted reading in points of Shore A.
    """

    name: str
    offset: float
    slope: float
    low: float
    high: float
    spread: float
    source: str


SHORE_A = DurometerScale("Shore A", 0.0, 1.0, 0.0, 100.0, 0.0, "ISO 48-4, type A")
SCALES = (
    SHORE_A,
    DurometerScale(
        "Shore D", 50.0, 1.0, 30.0, 49.0, 5.0,
        "Qi, Joyce and Boyce 2003: one modulus for S_A and S_D + 50; spread: the usual tolerance "
        "of 5 points",
    ),
    DurometerScale(
        "Asker C", -10.8, 0.8333, 45.0, 75.0, 5.0,
        "hardness guide of a foam supplier (Foam Products Australia, 45 to 75 JIS C); spread: the "
        "usual tolerance of 5 points",
    ),
)  # fmt: skip
"""Scales of durometers that footwear is specified in."""
_NAMES = {
    "": SCALES[0], "a": SCALES[0], "sha": SCALES[0], "shorea": SCALES[0], "shore": SCALES[0],
    "d": SCALES[1], "shd": SCALES[1], "shored": SCALES[1],
    "c": SCALES[2], "askerc": SCALES[2], "asker": SCALES[2], "jisc": SCALES[2],
}  # fmt: skip
_WORDS = re.compile(r"[a-z]+(?:[ -]+[a-z]+)*")


@dataclass(frozen=True, slots=True)
class DurometerReading:
    """A hardness as it was read: ``value`` on its ``scale``."""

    value: float
    scale: DurometerScale

    @property
    def shore_a(self) -> float:
        """The reading in Shore A."""
        return self.scale.offset + self.scale.slope * self.value

    def note(self) -> str:
        """Return what the conversion rests on; empty where nothing was converted."""
        if self.scale is SHORE_A:
            return ""
        return Message(
            "{value:g} {name} taken as Shore A {shore_a:.0f} ± {spread:g} ({source})",
            value=self.value,
            name=self.scale.name,
            shore_a=self.shore_a,
            spread=self.scale.spread,
            source=self.scale.source,
        )


def durometer_reading(text: str, *, where: str = "") -> DurometerReading:
    """Return the reading in a text such as "62 A", "55 Asker C" or "Shore D 40".

    Raises:
        InputError: No number or one that can be two, a scale that is not known, or a reading beyond
            those that the scale's conversion was given for.
    """
    plain = text.lower().replace("°", " ").strip()
    first = _WORDS.match(plain)
    before = "" if first is None else first[0]
    try:
        reading = split_quantity(plain.removeprefix(before))
    except InputError as error:
        error.where = where
        raise
    value, after = reading or (0.0, "")
    scale = _NAMES.get(re.sub("[ -]", "", before + after))
    names = ", ".join(f'"62 {each.name}"' for each in SCALES)
    if reading is None or scale is None:
        raise InputError(
            Message('"{text}" is no hardness on a known scale', text=text),
            where=where,
            allowed=f'62, "62 A", {names}',
        )
    if not scale.low <= value <= scale.high:
        raise InputError(
            Message(
                "{value:g} {name} is outside the readings that convert to Shore A",
                value=value,
                name=scale.name,
            ),
            where=where,
            allowed=f"{scale.low:g} to {scale.high:g} {scale.name}",
            remedy='Read the hardness in Shore A, or give the measured modulus (modulus = "5 MPa")',
        )
    return DurometerReading(value, scale)
