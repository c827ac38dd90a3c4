"""Tables of rubber tests as machines write them: where they stand, what their headings mean."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from underfoot.core import DataError, InputError, nearest_match, text, to_si
from underfoot.core.numbers_text import (
    NumberForm,
    column_numbers,
    column_place,
    number_forms,
    one_unit,
    units_in_cells,
    without_units,
)
from underfoot.core.remark import Message

SYMBOLS: dict[str, str] = {
    symbol: quantity
    for quantity, symbols in {
        "frequency": "f freq ν",
        "angular frequency": "w ω omega Omega",
        "time": "t",
        "temperature": "T",
        "storage modulus": "E' G' M' E1 G1 E_stor G_stor E_storage G_storage Estor Gstor",
        "loss modulus": "E'' G'' M'' E2 G2 E_loss G_loss Eloss Gloss",
        "modulus magnitude": "E* G* |E*| |G*|",
        "phase angle": "δ delta phi",
        "loss factor": "tand tanδ tan(δ) tan(delta) tan_delta tandelta tan(d)",
        "complex viscosity": "η* |η*| eta* |eta*|",
        "storage compliance": "J' D'",
        "loss compliance": "J'' D''",
        "relaxation modulus": "E G E(t) G(t) Et Gt E_relax G_relax",
        "relaxation time": "tau τ tau_i τ_i tau_k",
        "decay rate": "beta β beta_i β_i",
        "term": "E_i G_i E_k G_k",
        "fraction": "e_i g_i alpha_i α_i alpha α e_k g_k",
        "modulus at once": "E_0 G_0 E0 G0",
        "modulus at rest": "E_inf G_inf E_∞ G_∞ Einf Ginf E_e G_e",
    }.items()
    for symbol in symbols.split()
}
"""Short names, whose case counts: t is a time and T a temperature."""
WORDS: tuple[tuple[str, str], ...] = (
    (r"temp(erature|eratur|\.)?", "temperature"),
    (r"(angular|circular|ang\.?) ?freq(uency|\.)?|kreisfrequenz|winkelfrequenz|omega",
     "angular frequency"),
    (r"freq(uency|uenz|\.)?|frequenz|pr[uü]ffrequenz", "frequency"),
    (r"storage compliance|speicher(komplianz|nachgiebigkeit)", "storage compliance"),
    (r"loss compliance|verlust(komplianz|nachgiebigkeit)", "loss compliance"),
    (r"(storage|elastic) (shear |tensile |young'?s )?modulus|(schub|dehn|zug)?speichermodul"
     r"|(tensile|shear) storage modulus|storage_modulus", "storage modulus"),
    (r"(loss|viscous) (shear |tensile |young'?s )?modulus|(schub|dehn|zug)?verlustmodul"
     r"|(tensile|shear) loss modulus|loss_modulus", "loss modulus"),
    (r"loss (factor|tangent)|verlustfaktor|tan[ (_]*(delta|δ|d)\)?|damping factor|damping"
     r"|d[aä]mpfung(sfaktor)?|mechanical loss factor", "loss factor"),
    (r"phase( ?angle| ?shift)?|phasen(winkel|verschiebung)|loss angle|delta", "phase angle"),
    (r"(complex|dynamic|komplexer?) ?(shear |schub|tensile |young'?s )?modul(us)?",
     "modulus magnitude"),
    (r"complex viscosity|komplexe viskosit[aä]t", "complex viscosity"),
    (r"relaxation (times?)|relaxation_time|relaxationszeit(en)?", "relaxation time"),
    (r"decay (rate|constant)s?|abklingrate|relaxation rate", "decay rate"),
    (r"(stress )?relaxation modulus|relaxationsmodul|(shear |young'?s |tensile )?modulus|modul",
     "relaxation modulus"),
    (r"(test |step |elapsed |hold |pr[uü]f|abschnitts)?(time|zeit)", "time"),
    (r"term modulus|prony (coefficient|modulus|term)", "term"),
    (r"fraction|normali[sz]ed modulus|relative modulus", "fraction"),
    (r"(instantaneous|glassy) modulus|modulus at once", "modulus at once"),
    (r"(equilibrium|long[ -]term|relaxed|rubbery) modulus|modulus at rest", "modulus at rest"),
    (r"(oscillation |shear |dynamic |strain |test )?strain( amplitude)?( %)?|dehnung(samplitude)?"
     r"|deformation(samplitude)?|verformung|scherdeformation", "strain"),
    (r"set|sweep|run|segment", "set"),
)  # fmt: skip
"""Whole names in words, English and German, in any case; the first that fits counts."""
UNITS = {
    "relaxation modulus": "Pa", "storage modulus": "Pa", "loss modulus": "Pa",
    "modulus magnitude": "Pa", "term": "Pa", "modulus at once": "Pa", "modulus at rest": "Pa",
    "time": "s", "relaxation time": "s", "temperature": "K", "phase angle": "rad",
    "complex viscosity": "Pa*s", "storage compliance": "1/Pa", "loss compliance": "1/Pa",
    "decay rate": "1/s",
}  # fmt: skip
PURE = ("loss factor", "fraction", "set", "strain")
_CYCLES = {"hz": 1.0, "khz": 1e3, "mhz": 1e-3, "cycles/s": 1.0, "cps": 1.0}
_PER_SECOND = {"1/s", "s^-1", "s-1", "s⁻¹", "1/sec", "sec^-1", "sec-1", "/s", "s**-1", "s^{-1}"}
_PER_MINUTE = {"1/min", "min^-1", "min-1", "min⁻¹", "/min", "min**-1", "min^{-1}"}
_RADIANS = re.compile(r"rad(ians?)?(/s(ec)?|[.·*]?s(ec)?(\^?-1|⁻¹))")
_SHEAR = re.compile(r"(^|[|\s(_])(G|J|η|eta)t?(?![a-z])|shear|schub|viscosity|viskosit", re.I)
_YOUNG = re.compile(r"(^|[|\s(_])(E|D)t?(?![a-z])|young|tensile|dehn|zug|elongation|bending", re.I)
_LOGARITHM = re.compile(
    r"(?P<kind>ln|lg|log[_ ]?10|log)\s*(?:\((?P<inner>.+?)\)\s*(?P<unit>[\[({/,].*)?"
    r"|[\s_]\s*(?P<rest>\S.*))",
    re.IGNORECASE,
)
"""Headings "log10(omega)", "log G' (Pa)", "lg(E' / MPa)", "ln(t) [s]"."""
_NO_UNIT = {"t", "delta", "δ", "d", "ω", "w", "phi", "i"}
_BRACKETS = re.compile(r"^(.*?)\s*[\[({]\s*([^\])}]*?)\s*[\])}]\s*$")
_PARAMETERS = re.compile(r"^\s*([A-Za-z]\w*\s*=\s*[^;=]*;\s*)+([A-Za-z]\w*\s*=\s*[^;=]*)?$")
_HELD = re.compile(
    r"(?i)^\W*(?:test )?(?:temperature?|t)\b[^\d+-]*?([+-]?\d+(?:[.,]\d+)?)\s*(°?\s*C|K|degC|°?F)\b"
)
_RHEOMETER = re.compile(r"(?i)^(point no\.?|meas\. ?pts\.?|interval data:?|messpkt\.?|mess-?punkt)")


@dataclass(frozen=True, slots=True)
class FileColumn:
    """A column: its heading without the unit, the quantity that it names, unit and numbers."""

    name: str
    quantity: str | None
    unit: str
    cells: tuple[str, ...]
    form: NumberForm = field(default_factory=NumberForm)
    base: float | None = None
    """Base of the logarithm that the cells hold, taken of the number in the unit."""


@dataclass(frozen=True, slots=True)
class FileTable:
    """A table of a file.

    ``lines`` are the line numbers of its rows, ``part`` counts tables of one file from 0,
    ``stated`` gives units by column name, or by quantity where the file has none.
    """

    columns: tuple[FileColumn, ...]
    lines: tuple[int, ...]
    where: str
    part: int = 0
    stated: Mapping[str, str] = field(default_factory=dict)
    kelvin: float | None = None
    """Temperature that stands above the table, K."""
    rheometer: bool = False

    def find_column(self, *quantities: str) -> FileColumn | None:
        """Return the first column of one of the quantities."""
        generator = (c for q in quantities for c in self.columns if c.quantity == q)
        return next(generator, None)

    def require_column(self, *quantities: str) -> FileColumn:
        """Return the first column of one of the quantities; a DataError without one."""
        column = self.find_column(*quantities)
        if column is not None:
            return column
        shown = [s for s, q in SYMBOLS.items() if q in quantities]
        names = [*quantities, *shown]
        near = (nearest_match(column.name, names) for column in self.columns)
        raise DataError(
            Message(
                "no column for {quantities} among {columns}",
                quantities=" or ".join(quantities),
                columns=", ".join(text.excerpt(column.name) for column in self.columns),
            ),
            where=self.where,
            allowed=Message("one named {name}", name=", ".join(names[:6])),
            nearest=next(filter(None, near), None),
        )

    def numbers(self, column: FileColumn, infinite: bool = False) -> np.ndarray:
        """Return the numbers of a column as written; refuse them where one is missing."""
        try:
            values = np.array(column_numbers([_infinity(c) for c in column.cells], column.form))
        except ValueError:
            for line, cell in zip(self.lines, column.cells, strict=True):
                if not _is_number(cell, (column.form,)):
                    raise DataError(
                        Message(
                            '"{text}" in line {line} is not a number',
                            text=text.excerpt(cell),
                            line=line,
                        ),
                        where=self.where,
                        allowed="numbers",
                    ) from None
            raise
        if column.base is not None:
            values = column.base**values
        missing = np.flatnonzero(np.isnan(values) if infinite else ~np.isfinite(values))
        if missing.size:
            raise DataError(
                Message(
                    "{size} of {values_size} values are missing in the column {name}, the "
                    "first in line {line}",
                    size=missing.size,
                    values_size=values.size,
                    name=column.name,
                    line=self.lines[missing[0]],
                ),
                where=self.where,
                remedy="Remove the rows, or repair them at their source",
            )
        return values

    def unit(self, column: FileColumn, quantity: str | None = None) -> str:
        """Return the unit of a column: stated for it, of the file, of its quantity; "" without."""
        usual = self.stated.get(quantity or column.quantity or "", "")
        return (
            (self.stated.get(column.name) or column.unit or usual).strip().strip("[](){}").strip()
        )

    def si(self, column: FileColumn, infinite: bool = False) -> np.ndarray:
        """Return the numbers of a column in the SI unit of its quantity."""
        quantity = column.quantity or ""
        values = self.numbers(column, infinite)
        if quantity in PURE:
            return values * (0.01 if self.unit(column) == "%" else 1.0)
        unit, where = UNITS[quantity], column_place(self.where, column.name)
        written = self.unit(column)
        if written in ("", "-"):
            raise DataError(
                "no unit is given",
                where=where,
                allowed=Message(
                    "a unit of {unit} in the heading, in a row below it, or as an argument",
                    unit=unit,
                ),
                remedy="Moduli take theirs from --unit MPa" if unit == "Pa" else None,
            )
        zero, one = (_factor(n, written, unit, where) for n in (0, 1))
        return np.where(np.isinf(values), values, values * (one - zero) + zero)

    def angular_frequency(self) -> np.ndarray:
        """Return the angular frequency, rad/s. The unit decides; 1/s leaves it to the name.

        Raises:
            DataError: Neither decides, or they contradict each other.
        """
        column = self.require_column("angular frequency", "frequency")
        values, where = self.numbers(column), column_place(self.where, column.name)
        angular = column.quantity == "angular frequency"
        written = self.unit(column, "frequency")
        unit = written.replace(" ", "").casefold()
        if unit in ("", "-"):
            raise DataError(
                "no unit is given",
                where=where,
                allowed="Hz or rad/s in the heading, in a row below it, or as an argument",
            )
        if _RADIANS.fullmatch(unit):
            return values
        if unit in _PER_SECOND | _PER_MINUTE:
            seconds = 1.0 if unit in _PER_SECOND else 60.0
            return values * ((1.0 if angular else 2.0 * np.pi) / seconds)
        if unit in _CYCLES:
            if angular and column.name.casefold() not in ("w", "omega", "ω"):
                raise DataError(
                    Message(
                        'an angular frequency in "{written}": name and unit contradict each other',
                        written=written,
                    ),
                    where=where,
                    allowed="an angular frequency in rad/s or 1/s, a frequency in Hz",
                    remedy="Name the column frequency, or give its unit as rad/s",
                )
            # in lower case it is a millihertz
            cycles = 1e6 if written == "MHz" else _CYCLES[unit]
            return values * (2.0 * np.pi * cycles)
        return values * _factor(1, written, "rad/s", where)

    @property
    def shear(self) -> bool | None:
        """Whether its moduli are those of shear, as headed or as a rheometer's; None unknown."""
        headed = self.headed_shear
        return True if headed is None and self.rheometer else headed

    @property
    def headed_shear(self) -> bool | None:
        """Whether its moduli are those of shear; None where no heading tells."""
        if any(map(_of_young, self.columns)):
            return False
        return True if any(map(_of_shear, self.columns)) else None


def _has_kind(column: FileColumn) -> bool:
    """Return whether a column holds moduli, which are of shear or of tension."""
    unit = UNITS.get(column.quantity or "")
    return unit in ("Pa", "Pa*s", "1/Pa") or column.quantity == "fraction"


def _of_young(column: FileColumn) -> bool:
    return _has_kind(column) and _YOUNG.search(column.name) is not None


def _of_shear(column: FileColumn) -> bool:
    return _has_kind(column) and not _of_young(column) and _SHEAR.search(column.name) is not None


def _factor(number: float, unit: str, target: str, where: str) -> float:
    """Return ``number`` of a unit as files write it in the SI unit ``target``."""
    plain = unit.replace("²", "^2").replace("·", "*").replace("⁻¹", "^-1").replace("°", "deg")
    plain = re.sub(r"^(deg)?\s*(C|Celsius)$", "degC", plain)
    plain = re.sub(r"^(Pa|mPa|kPa|MPa)[ .\-]?s$", r"\1*s", plain)
    plain = {"sec": "s", "Grad": "deg", "kelvin": "K"}.get(plain, plain)
    try:
        return to_si(f"{number} {text.excerpt(plain)}", target, where=where)
    except InputError as error:
        raise DataError(
            error.what, where=where, allowed=error.allowed, nearest=error.nearest
        ) from error


def _size(unit: str, quantity: str) -> float | str:
    """Return a unit of a quantity in that of SI; "" of a word that leaves it open."""
    plain = unit.strip("[](){} ")
    folded = plain.replace(" ", "").casefold()
    if "frequency" in quantity:
        if _RADIANS.fullmatch(folded):
            return "rad/s"
        return _CYCLES.get(folded, "") if plain != "MHz" else 1e6
    try:
        return _factor(1, plain, UNITS.get(quantity, "1"), "")
    except DataError:
        return ""


def quantity_of(name: str) -> str | None:
    """Return the quantity that a heading without its unit names, or None."""
    plain = re.sub(r"[’′`´]", "'", name.strip()).replace("″", "''").replace('"', "''")
    if found := _named_by(plain):
        return found
    if len(plain) < 60:  # a symbol beside the word says the same: "Verlustfaktor tan δ"
        for gap in re.finditer(r"[\s,]+", plain):
            said = {_named_by(plain[: gap.start()]), _named_by(plain[gap.end() :])}
            if len(said) == 1 and None not in said:
                return said.pop()
    parts = _BRACKETS.match(plain)
    if parts and parts.group(1):
        return quantity_of(parts.group(1)) or quantity_of(parts.group(2))
    return None


def _named_by(plain: str) -> str | None:
    """Return the quantity of a symbol or of words alone."""
    if found := SYMBOLS.get(plain.replace(" ", "")):
        return found
    folded = re.sub(r"\s+", " ", plain.casefold()).strip()
    # a symbol beside the words says the same, and more: "Storage Modulus G'"
    bare = re.sub(r"[\s,]*\(?\|?\b(?<!tan )([eg]|[jd]|η|eta)\*?'{0,2}\|?\)?$", "", folded).strip()
    for candidate in (folded, bare):
        for pattern, quantity in WORDS:
            if re.fullmatch(pattern, candidate):
                return quantity
    return None


def without_logarithm(heading: str) -> tuple[str, float | None]:
    """Return a heading without the logarithm of a quantity that it names, and its base.

    "log" is decadic, as in a rheologist's plot.

    >>> without_logarithm("log10(omega) [rad/s]")
    ('omega [rad/s]', 10.0)
    """
    match = _LOGARITHM.fullmatch(heading.strip())
    inner = "" if match is None else match["rest"] or f"{match['inner']} {match['unit'] or ''}"
    if match is None or quantity_of(heading_of(inner)[0]) is None:
        return heading, None
    return inner.strip(), float(np.e) if match["kind"].casefold() == "ln" else 10.0


def heading_of(cell: str) -> tuple[str, str]:
    """Return name and unit of a heading: "f (Hz)", "f [Hz]", "f / Hz", "f, Hz", "f in Hz"."""
    cell = cell.strip()
    matched = _BRACKETS.match(cell)
    inside = matched.group(2) if matched else ""
    if (
        matched
        and inside.casefold() not in _NO_UNIT
        and (_is_unit(inside) or not quantity_of(inside))
    ):
        return matched.group(1).strip() or cell, matched.group(2)
    for pattern in (r"^(.*\S)\s+/\s+(\S.*)$", r"^(.*[^\s,]),\s*(\S+)$", r"^(.*\S)\s+in\s+(\S+)$",
                    r"^([^/\s]+)/(\S+)$"):  # fmt: skip
        parted = re.match(pattern, cell)
        if parted and _is_unit(parted.group(2)) and quantity_of(parted.group(1)):
            return parted.group(1), parted.group(2)
    return cell, ""


def _is_unit(cell: str) -> bool:
    plain = cell.strip().strip("[](){}").strip()
    if _RADIANS.fullmatch(plain.casefold().replace(" ", "")):
        return True
    if plain.casefold() in (
        *_CYCLES,
        *_PER_SECOND,
        *_PER_MINUTE,
        "-",
        "1",
        "%",
        "°",
        "deg",
        "grad",
        "°c",
        "c",
    ):
        return True
    if not plain or len(plain) > 12 or (quantity_of(plain) and plain not in ("K", "s")):
        return False
    for target in ("Pa", "s", "K", "rad", "rad/s", "Pa*s", "1/Pa", "1", "m", "N"):
        try:
            _factor(1, plain, target, "")
        except DataError:
            continue
        return True
    return False


def _infinity(cell: str) -> str:
    return "inf" if cell.strip().casefold() in ("∞", "inf", "infinity", "unendlich") else cell


_FORMS = (NumberForm(), NumberForm(",", True), NumberForm(".", True))


def _is_number(cell: str, forms: Sequence[NumberForm] = _FORMS) -> bool:
    def fits(form: NumberForm) -> bool:
        try:
            column_numbers([_infinity(cell)], form)
        except ValueError:
            return False
        return True

    return any(fits(form) for form in forms)


def _counts(cells: Sequence[str]) -> tuple[int, int]:
    """Return how many cells hold a number and how many hold anything."""
    filled = [cell for cell in cells if cell]
    number = sum(_is_number(c) and c.casefold() not in text.MISSING for c in filled)
    return number, len(filled)


def _is_row(cells: Sequence[str]) -> bool:
    number, filled = _counts(cells)
    return number > 0 and 2 * number >= filled


def _separator(lines: Sequence[str]) -> str | None:
    """Return what divides most lines into numbers; None: blanks."""

    def rows(separator: str | None) -> int:
        split = (text.cells_of(line, separator) for line in lines)
        return sum(len(cells) > 1 and all(map(_is_number, cells)) and _is_row(cells)
                   for cells in split)  # fmt: skip

    candidates = [s for s in (";", "\t", ",") if any(s in line for line in lines)]
    best = max([*candidates, None], key=rows)
    if rows(best):
        return best
    return next(iter(candidates), None)


def read_tables(path: Path | str, units: Mapping[str, str] | None = None) -> list[FileTable]:
    """Return the tables of a text file, in order.

    Encodings UTF-8, UTF-16 and Latin-1; separators comma, semicolon, tab or blanks, whatever
    stands between quotes; decimal commas and thousands (``core.numbers_text``); lines above and
    below tables; a row of units below the headings, in brackets or not; RepTate's line of
    parameters, after which units are its own (rad/s, Pa, s, degC).

    Raises:
        DataError: No table, no headings, rows of another length, a heading twice.
    """
    where = str(path)
    lines = text.with_content(text.numbered_lines(path, "Export it as text"))
    if len(lines) < 2:
        raise DataError("the file holds no table", where=where, allowed="headings and rows")
    separator = _separator([line for _, line in lines[:2000]])
    inside = units_in_cells([text.cells_of(line, separator) for _, line in lines[:2000]], _is_unit)
    drafts: list[_Draft] = []
    above: list[tuple[int, str, list[str]]] = []
    draft: _Draft | None = None
    for number, line in lines:
        cells = without_units(text.cells_of(line, separator), inside)
        if not _is_row(cells) or _PARAMETERS.match(line):
            draft = None
            above.append((number, line, cells))
            continue
        if draft is None:
            draft = _table_below(above, cells, inside, where, not drafts) or (
                drafts[-1] if drafts else None
            )
            if draft is None:  # a number in the lines above a table
                above.append((number, line, cells))
                continue
            if draft not in drafts:
                drafts.append(draft)
            above = []
        draft.add(number, cells, separator, where)
    if not drafts:
        raise _tableless(above, where)
    return [draft.table(where, n, units or {}) for n, draft in enumerate(drafts)]


def _tableless(above: Sequence[tuple[int, str, list[str]]], where: str) -> DataError:
    if any(_is_row(cells) for _, _, cells in above):
        return DataError(
            "the first line holds numbers and no headings",
            where=where,
            remedy="Name the columns with their units, for example: f (Hz), E_stor (MPa)",
        )
    named = any(_count_quantities(cells) for _, _, cells in above)
    what = "there are headings but no numbers" if named else "the file holds no table"
    return DataError(what, where=where, allowed="headings and rows")


def _count_quantities(cells: Sequence[str]) -> int:
    """Return how many cells name a quantity."""
    names = (heading_of(without_logarithm(cell)[0])[0] for cell in cells if cell)
    return sum(quantity_of(name) is not None for name in names)


@dataclass(slots=True)
class _Draft:
    """A table as it is read."""

    heads: list[str]
    units: list[str]
    rows: list[tuple[int, list[str]]] = field(default_factory=list)
    kelvin: float | None = None
    reptate: bool = False
    inside: Mapping[int, str] = field(default_factory=dict)
    """Units that stand in the cells, by column."""
    after: tuple[int, str] | None = None
    """A row that begins with a word, as below a table; among its rows it is damage."""

    def add(self, number: int, cells: list[str], separator: str | None, where: str) -> None:
        first = next(filter(None, cells))
        if self.rows and not _is_number(first):
            before = next(filter(None, self.rows[-1][1]))
            if _is_number(before):
                self.after = self.after or (number, first)
                return
        if self.after is not None:
            raise DataError(
                Message(
                    '"{text}" in line {line} is not a number',
                    text=text.excerpt(self.after[1]),
                    line=self.after[0],
                ),
                where=where,
                allowed="numbers",
            )
        width = len(self.heads)
        while len(cells) > width and not cells[-1]:
            cells = cells[:-1]
        cells = cells + [""] * (width - len(cells) if len(cells) > 0.5 * width else 0)
        if len(cells) != width:
            hint = None
            if separator == "," and len(cells) in (2 * width, 2 * width - 1):
                hint = "Commas seem to be both separator and decimal sign: export with semicolons"
            raise DataError(
                Message(
                    "line {number} has {count} values for {width} headings",
                    number=number,
                    count=len(cells),
                    width=width,
                ),
                where=where,
                remedy=hint,
            )
        self.rows.append((number, cells))

    def _unit(self, named: tuple[str, str], k: int, quantity: str | None, where: str) -> str:
        """Return the unit of a column: of its heading, the row below, its cells."""

        def same(first: str, other: str) -> bool:
            sizes = _size(first, quantity or ""), _size(other, quantity or "")
            return quantity is None or "" in sizes or sizes[0] == sizes[1]

        said = (named[1], self.units[k], self.inside.get(k, ""))
        return one_unit(said, same, column_place(where, text.excerpt(named[0])))

    def table(self, where: str, part: int, stated: Mapping[str, str]) -> FileTable:
        cells = list(zip(*(row for _, row in self.rows), strict=True))
        plain = [without_logarithm(head) for head in self.heads]
        named = [heading_of(head) for head, _ in plain]
        kept = [k for k, (name, _) in enumerate(named) if name]
        names = [named[k][0] for k in kept]
        twice = [name for name in names if names.count(name) > 1 and quantity_of(name)]
        if twice:
            raise DataError(
                Message(
                    "a heading occurs twice: {names}", names=text.excerpt(", ".join(names), 200)
                ),
                where=where,
            )
        quantities = [quantity_of(name) for name in names]
        numeric = [k for k, q in zip(kept, quantities, strict=True) if q is not None]
        forms = dict(zip(numeric, number_forms([cells[k] for k in numeric], where), strict=True))
        columns = tuple(
            FileColumn(
                names[n], quantities[n], self._unit(named[k], k, quantities[n], where), cells[k],
                forms.get(k, NumberForm()), plain[k][1],
            )
            for n, k in enumerate(kept)
        )  # fmt: skip
        if self.reptate:
            own = {"angular frequency": "rad/s", "time": "s", "temperature": "degC"}
            columns = tuple(
                replace(c, unit=c.unit or own.get(c.quantity or "", "Pa")) for c in columns
            )
        if any(map(_of_young, columns)):  # of a file with both kinds, one
            columns = tuple(c for c in columns if _of_young(c) or not _of_shear(c))
        rheometer = any(_RHEOMETER.match(head.strip()) for head in self.heads)
        lines = tuple(number for number, _ in self.rows)
        return FileTable(columns, lines, where, part, stated, self.kelvin, rheometer)


def _table_below(
    above: Sequence[tuple[int, str, list[str]]],
    row: Sequence[str],
    inside: Mapping[int, str],
    where: str,
    first: bool,
) -> _Draft | None:
    """Return a table whose headings are the nearest above its first row; None without any."""
    parameters = [line for _, line, _ in above if _PARAMETERS.match(line)]
    texts = [(line, cells) for _, line, cells in above if line not in parameters]
    named = [k for k, (_, cells) in enumerate(texts) if _count_quantities(cells)]
    best = max(named, key=lambda k: (_count_quantities(texts[k][1]), k), default=None)
    if best is None:
        words = [k for k, (_, cells) in enumerate(texts) if first and not _is_row(cells)]
        best = next((k for k in reversed(words) if len(texts[k][1]) == len(row)), None)
    if best is None:
        return None  # lines between rows of one table, or above the first
    heads = list(texts[best][1])
    while len(heads) > len(row) and not heads[-1]:
        heads.pop()
    while len(heads) > 1 and not heads[-1]:
        heads.pop()
    units = [""] * len(heads)
    for _, cells in texts[best + 1 :]:
        if sum(map(bool, cells)) and all(_is_unit(cell) for cell in cells if cell):
            units = [*cells, *[""] * len(heads)][: len(heads)]
            break
        if len(cells) == len(heads) and not any(map(_is_number, filter(None, cells))):
            units = list(cells)  # units that are not known are told when they are needed
    return _Draft(
        heads, units, kelvin=_temperature(texts, parameters, where), reptate=bool(parameters),
        inside=inside,
    )  # fmt: skip


def _temperature(
    texts: Sequence[tuple[str, Sequence[str]]], parameters: Sequence[str], where: str
) -> float | None:
    """Return the temperature (K) that lines above a table name; None without one."""
    for line in parameters:
        for part in line.split(";"):
            name, _, value = part.partition("=")
            if name.strip() == "T":
                if not _is_number(value):
                    raise DataError(
                        Message(
                            'the temperature "{text}" is not a number', text=text.excerpt(value)
                        ),
                        where=where,
                    )
                forms = [form for form in _FORMS if _is_number(value, (form,))]
                return _factor(forms[0].number(value), "degC", "K", where)
    for line, _ in reversed(texts):
        if match := _HELD.match(line):
            number = float(match.group(1).replace(",", "."))
            return _factor(number, match.group(2).replace(" ", ""), "K", where)
    return None
