"""Options for reading an outsole file; which unit it is in."""

import math
from dataclasses import dataclass

from underfoot.core import InputError, unknown_name
from underfoot.core.remark import Message, assumption_line

UNITS = {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "inch": 0.0254}
"""Units of length a file may be in, m."""
DIRECTIONS = ("+x", "-x", "+y", "-y", "+z", "-z")
"""Directions in the frame of the file."""
REGIONS = ("whole", "heel", "forepart")
FEET = ("left", "right")
SHARES = {"whole": 1.0, "heel": 0.30, "forepart": 0.45}
"""Share of the length of a whole sole that a region takes, from its own end."""


@dataclass(frozen=True, slots=True)
class FileSettings:
    """How to read an outsole file.

    Parameters:
        unit: "mm", "cm", "m", "inch", or "auto": the one that makes the length that of a sole.
        down: Where the ground is, in the file's axes ("-z", ...); "auto" finds it by the tread,
            "flip" takes the opposite side.
        forward: Where the toe is ("+x", ...); "auto" or "flip".
        foot: Which foot the file shows, "left" or "right"; "auto" finds it by the bend of the sole.
        mirror: Take the other shoe of the pair.
        region: "whole", "heel" (rear 30 % of a whole sole) or "forepart" (front 45 %).
        region_length: Length of the region, m; None for these shares.
        spacing: Of the height map, m.
        solid: Name of the body that is the outsole; None to find it.
        side: Which shoe of a pair in one file, "left" or "right"; "auto" refuses a pair.
        cut_floor: Cut a plane that reaches beyond the sole even where it may be its land.
    """

    unit: str = "auto"
    down: str = "auto"
    forward: str = "auto"
    foot: str = "auto"
    mirror: bool = False
    region: str = "whole"
    region_length: float | None = None
    spacing: float = 0.25e-3
    solid: str | None = None
    side: str = "auto"
    cut_floor: bool = False

    def __post_init__(self) -> None:
        allowed = {
            "unit": ("auto", *UNITS),
            "down": ("auto", "flip", *DIRECTIONS),
            "forward": ("auto", "flip", *DIRECTIONS),
            "foot": ("auto", *FEET),
            "region": REGIONS,
            "side": ("auto", *FEET),
        }
        for name, known in allowed.items():
            if getattr(self, name) not in known:
                raise unknown_name(name, str(getattr(self, name)), known, where=f"outsole.{name}")
        if {self.down, self.forward} <= {*DIRECTIONS} and self.down[1] == self.forward[1]:
            raise InputError(
                Message(
                    "down {down} and forward {forward} lie on one axis",
                    down=self.down,
                    forward=self.forward,
                ),
                where="outsole.forward",
                allowed="two different axes of the file",
            )
        for name in ("spacing", "region_length"):
            value = getattr(self, name)
            if value is not None and not (math.isfinite(value) and value > 0):
                raise InputError(
                    Message("{value:g} is not positive", value=value),
                    where=f"outsole.{name}",
                    allowed="above 0",
                )
        if self.spacing < 2e-5:
            raise InputError(
                Message("{spacing:g} mm is finer than any tread", spacing=self.spacing * 1000.0),
                where="outsole.spacing",
                allowed="0.02 mm or more",
            )


SOLE = (0.150, 0.350)
"""Length of a whole sole, m."""
HEEL = (0.040, 0.110)
"""Length of a heel piece, m."""
PIECE = (0.110, 0.150)
"""Length of a forepart or of a small child's sole, m."""
SLENDER = 1.7
"""A whole sole is longer than this many widths, a heel piece shorter."""
_SHORTEST = 0.020  # m: below it a unit chosen by hand is refused


def length_unit(
    length: float,
    width: float,
    *,
    chosen: str = "auto",
    in_file: float | None = None,
    where: str,
    longest: float = 0.5,
) -> tuple[float, Message]:
    """Return the file's unit in m and a remark on how it was determined.

    Parameters:
        length, width: Longest extent and the one across, in the file's unit.
        chosen: Unit the user names, or "auto".
        in_file: Unit stated in the file (STEP), m.
        longest: Length beyond which a unit that is stated or chosen is refused, m.

    Raises:
        InputError: No unit makes it as long as a sole, or the chosen unit makes it absurd.
    """
    unit, by = in_file, Message("by the unit in the file")
    origin = Message("as stated in the file")
    if chosen != "auto":
        unit, by = UNITS[chosen], Message("in {unit}", unit=chosen)
        origin = Message("{unit} (chosen)", unit=chosen)
    if unit is not None:
        if not _SHORTEST <= length * unit <= longest:
            raise InputError(
                Message("{by} the sole is {length} long", by=by, length=_length(length * unit)),
                where=where,
                allowed=Message("20 mm to {length}", length=_length(longest)),
                remedy=_suggestion(length, width),
            )
        return unit, Message(
            "Unit: {origin}; length {length}.", origin=origin, length=_length(length * unit)
        )
    likely = _likely(length, width)
    if not likely:
        lengths = [
            Message("{length} in {unit}", length=_length(length * unit), unit=name)
            for name, unit in UNITS.items()
        ]
        raise InputError(
            Message(
                "no unit makes it a sole: its length of {length:.4g} would be {lengths}",
                length=length,
                lengths=lengths,
            ),
            where=where,
            allowed="110 to 350 mm for a sole or forepart, 40 to 110 mm for a heel piece",
            remedy="State the unit if the length is right, or check that the file holds one "
            "outsole alone; --cut-floor cuts a table",
        )
    name = likely[0]
    metres = _metres(length, name)
    kind = next(
        name
        for name, (_, high) in (
            (Message("heel piece"), HEEL),
            (Message("forepart or small sole"), PIECE),
            (Message("sole"), SOLE),
        )
        if metres <= high
    )
    other = ""
    if len(likely) > 1:
        size = _length(length * UNITS[likely[1]])
        other = Message(" It could also be {unit} ({length}).", unit=likely[1], length=size)
    return UNITS[name], assumption_line(
        "unit {unit} (the file states none); length {length}, that of a {kind}.{other}",
        unit=name,
        length=_length(metres),
        kind=kind,
        other=other,
    )


def _metres(length: float, unit: str) -> float:
    """Return a length in m without the rounding of the factor: 350 mm is 0.35 m."""
    return round(length * UNITS[unit], 9)


def _likely(length: float, width: float) -> list[str]:
    ranges = (SOLE, PIECE, HEEL) if length > SLENDER * width else (HEEL, PIECE, SOLE)
    likely = [
        name
        for low, high in ranges
        for name in ("mm", "m", "inch", "cm")
        if low <= _metres(length, name) <= high
    ]
    return list(dict.fromkeys(likely))


def likely_unit(length: float, width: float) -> float:
    """Return the unit (m) that makes it as long as a sole, else one that makes it 280 mm."""
    likely = _likely(length, width)
    return UNITS[likely[0]] if likely else 0.28 / length


def _suggestion(length: float, width: float) -> str | None:
    likely = _likely(length, width)
    if not likely:
        return None
    name = likely[0]
    return Message(
        "It would be {length} in {name}: choose it with --unit {name}",
        length=_length(length * UNITS[name]),
        name=name,
    )


def _length(metres: float) -> str:
    return f"{metres * 1e3:.4g} mm" if metres < 1 else f"{metres:.4g} m"
