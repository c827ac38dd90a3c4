"""Classes of floors by what a machine reads: pendulum, ramps, tribometers."""

from dataclasses import dataclass

from underfoot.core import unknown_name


@dataclass(frozen=True, slots=True)
class ClassScheme:
    """Classes in rising order: (smallest value, name). Below the first there is no class.

    ``quantity``: ``"ptv"`` (pendulum test value), ``"angle"`` (degrees), ``"cof"``. ``above``: True
    where a value must exceed a limit, False where reaching it is enough. ``whole``: True where
    readings are rounded to whole numbers first.
    """

    name: str
    title: str
    quantity: str
    limits: tuple[tuple[float, str], ...]
    source: str
    above: bool = False
    whole: bool = False

    def class_of(self, value: float) -> str:
        """Return the class of a value; ``"none"`` below the lowest."""
        if self.whole:
            value = float(round(value))
        name = "none"
        for limit, label in self.limits:
            if value > limit or (value == limit and not self.above):
                name = label
        return name


_MEMORY = "from memory, not verified against the text"
SCHEMES: dict[str, ClassScheme] = {
    scheme.name: scheme
    for scheme in (
        ClassScheme(
            "uksrg_pendulum", "Slip potential by pendulum (UKSRG)", "ptv",
            tuple((ptv, f"{risk} slip potential") for ptv, risk in
                  ((0, "high"), (25, "moderate"), (36, "low"))),
            f"UK Slip Resistance Group: 0-24 high, 25-35 moderate, 36 and more low; {_MEMORY}",
            whole=True,
        ),
        ClassScheme(
            "din_51130", "Shod ramp with oil (DIN 51130, EN 16165 annex B)", "angle",
            ((6, "R9"), (10, "R10"), (19, "R11"), (27, "R12"), (35, "R13")),
            "DIN 51130: R9 above 6 deg, R10 above 10, R11 above 19, R12 above 27, R13 above 35; "
            + _MEMORY, above=True,
        ),
        ClassScheme(
            "din_51097", "Barefoot ramp with soapy water (DIN 51097, EN 16165 annex A)", "angle",
            ((12, "A"), (18, "B"), (24, "C")),
            f"DIN 51097: A from 12 deg, B from 18, C from 24; {_MEMORY}",
        ),
        ClassScheme(
            "dguv_tribometer", "Sliding friction of floors (DIN 51131, EN 16165 annex D)", "cof",
            ((0, "unsafe"), (0.30, "conditionally safe"), (0.45, "safe")),
            f"DGUV Information 208-041: below 0.30 unsafe, from 0.45 safe; {_MEMORY}",
        ),
        ClassScheme(
            "ansi_a326_3", "Wet dynamic COF of tiles (ANSI A326.3, BOT-3000E)", "cof",
            ((0, "below the limit"), (0.42, "at or above 0.42")),
            f"ANSI A326.3: wet DCOF of 0.42 or greater for level interior floors; {_MEMORY}",
        ),
    )
}  # fmt: skip


def class_scheme(name: str) -> ClassScheme:
    """Return a scheme of classes.

    InputError: unknown name, with the nearest one.
    """
    if name not in SCHEMES:
        raise unknown_name("scheme of classes", name, SCHEMES, where="classes")
    return SCHEMES[name]


def cof_of_pendulum(ptv: float) -> float:
    """Return the COF of a pendulum test value, 3 PTV / (330 - PTV).

    Range: PTV from 0 to 150. Source: the pendulum's energy balance (C. G. Giles, B. E. Sabey,
    K. H. F. Cardew, Road Research Technical Paper 66, 1964; from memory, not verified).
    """
    return 3.0 * ptv / (330.0 - ptv)
