"""Classes of floors: which reading is called what, by which rule and edition."""

import math
from dataclasses import dataclass

from underfoot.core import unknown_name
from underfoot.core.remark import Message


@dataclass(frozen=True, slots=True)
class ClassScheme:
    """Classes in rising order: (smallest value, name). Below the first there is no class.

    ``quantity``: ``"ptv"`` (pendulum test value), ``"angle"`` (degrees), ``"cof"``. ``rule`` is the
    rule with its edition, ``source`` what was read of it ("" where it is from memory). ``above``:
    True where a value must exceed a limit (the lowest apart), False where reaching it is enough.
    ``whole``: True where readings are rounded to whole numbers first, halves down. ``dry`` is the
    scheme of readings taken dry, where that is another.
    """

    name: str
    title: str
    quantity: str
    limits: tuple[tuple[float, str], ...]
    rule: str
    source: str = ""
    above: bool = False
    whole: bool = False
    dry: str = ""

    def class_of(self, value: float) -> str:
        """Return the class of a value; ``"none"`` below the lowest."""
        if self.whole:
            value = math.ceil(value - 0.5)
        name = "none"
        for i, (limit, label) in enumerate(self.limits):
            if value > limit or (value == limit and (i == 0 or not self.above)):
                name = label
        return name

    def standing(self) -> str:
        """Return the rule with its edition and what was read of it."""
        read = (
            Message("read at {source}", source=self.source)
            if self.source
            else Message("from memory, not verified")
        )
        return Message("{rule} ({read})", rule=self.rule, read=read)


_NO_LIMIT = "below the limit"
SCHEMES: dict[str, ClassScheme] = {
    scheme.name: scheme
    for scheme in (
        ClassScheme(
            "uksrg_pendulum", "Slip potential by pendulum", "ptv",
            tuple((ptv, f"{risk} slip potential") for ptv, risk in
                  ((0, "high"), (25, "moderate"), (36, "low"))),
            "UK Slip Resistance Group Guidelines 2005, Table 1: 0-24 high, 25-35 moderate, 36 and "
            "more low; EN 16165 has no classes",
            "thenbs.com, Pendulum, ramp and Tortus slip resistance test methods", whole=True,
        ),
        ClassScheme(
            "din_51130", "Shod ramp with oil", "angle",
            ((6, "R9"), (10, "R10"), (19, "R11"), (27, "R12"), (35, "R13")),
            "ASR A1.5/1,2, annex 1, Table 1, of the corrected mean angle (DIN 51130 alike): R9 "
            "from 6 to 10 deg, R10 above 10, R11 above 19, R12 above 27, R13 above 35; in EN "
            "16165:2021 only by the national foreword of DIN EN 16165",
            "vorschriften.bgn-branchenwissen.de, ASR A1.5/1,2; ukslipresistance.org.uk", above=True,
        ),
        ClassScheme(
            "din_51097", "Barefoot ramp with soapy water", "angle",
            ((12, "A"), (18, "B"), (24, "C")),
            "DGUV Information 207-006, Table 1: A from 12 deg, B from 18, C from 24; in EN "
            "16165:2021 only by the national foreword of DIN EN 16165",
            "arbeitssicherheit.de, DGUV Information 207-006, 3.1; ukslipresistance.org.uk",
        ),
        ClassScheme(
            "dguv_tribometer", "Sliding friction of floors", "cof",
            ((0, "not sufficiently slip resistant"), (0.30, "conditionally safe"), (0.45, "safe")),
            "DGUV Information 208-041, 4.3: below 0.30 not sufficiently slip resistant, unless the "
            "floor has the R group that ASR A1.5/1,2 asks for and differs by less than 10 % from "
            "its measurement when new; from 0.45 safe",
            "arbeitssicherheit.de, DGUV Information 208-041, 4.3, for 0.30; 0.45 from memory, not "
            "verified",
        ),
        ClassScheme(
            "ansi_a326_3", "Wet dynamic COF, product use", "cof",
            ((0, _NO_LIMIT), (0.42, "interior wet"), (0.50, "interior wet plus"),
             (0.55, "exterior wet, oils and greases")),
            "ANSI A326.3-2021: wet 0.42 interior, 0.50 interior wet plus, 0.55 exterior and oils, "
            "where the manufacturer declares no category",
            "discus.4specs.com, thread 8467; wmgsouthfl.com, A326.3-2022", dry="ansi_a326_3_dry",
        ),
        ClassScheme(
            "ansi_a326_3_dry", "Dry dynamic COF, product use", "cof",
            ((0, _NO_LIMIT), (0.42, "interior dry")),
            "ANSI A326.3-2021: dry 0.42 interior, kept dry",
            "discus.4specs.com, thread 8467; wmgsouthfl.com, A326.3-2022",
        ),
    )
}  # fmt: skip


def class_scheme(name: str, *, dry: bool = False) -> ClassScheme:
    """Return a scheme of classes, for readings taken ``dry`` where they have their own.

    InputError: unknown name, with the nearest one.
    """
    if name not in SCHEMES:
        raise unknown_name("scheme of classes", name, SCHEMES, where="classes")
    return SCHEMES[(dry and SCHEMES[name].dry) or name]


def cof_of_pendulum(ptv: float, uncertainty: float = 0.0) -> tuple[float, float]:
    """Return the COF of a pendulum test value, 3 PTV / (330 - PTV), and its uncertainty.

    Range: PTV from 0 to 150. Source: the pendulum's energy balance (C. G. Giles, B. E. Sabey,
    K. H. F. Cardew, Road Research Technical Paper 66, 1964; from memory, not verified).
    """
    return 3.0 * ptv / (330.0 - ptv), 990.0 / (330.0 - ptv) ** 2 * uncertainty
