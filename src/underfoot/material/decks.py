"""Viscoelastic materials of finite element decks: LS-DYNA, Abaqus and CalculiX, FEBio."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from underfoot.core import DataError, InputError, text, to_si
from underfoot.core.remark import Message

from .spectrum import RelaxationSpectrum

SUFFIXES = {".k": "LS-DYNA", ".key": "LS-DYNA", ".dyn": "LS-DYNA",
            ".inp": "Abaqus", ".feb": "FEBio"}  # fmt: skip
_ASK = "Name the unit of its moduli: --unit MPa (times are in seconds then)"


@dataclass(frozen=True, slots=True)
class Deck:
    """A series of a deck, whether it is of shear, and what was taken."""

    series: RelaxationSpectrum
    shear: bool
    notes: tuple[str, ...]


def is_deck(path: Path) -> bool:
    """Return whether the name of a file is that of a deck."""
    return path.suffix.casefold() in SUFFIXES


def read_deck(path: Path | str, modulus_unit: str | None = None) -> Deck:
    """Return the first viscoelastic material of a deck.

    LS-DYNA *MAT_VISCOELASTIC and *MAT_GENERAL_VISCOELASTIC (shear moduli and decay rates; a rate
    of 0 is the modulus at rest); Abaqus and CalculiX *ELASTIC or *HYPERELASTIC (Neo-Hooke,
    Mooney-Rivlin, polynomial of first order, Yeoh) with *VISCOELASTIC, TIME=PRONY (fractions of
    the instantaneous modulus); FEBio "viscoelastic" and "uncoupled viscoelastic" (factors of the
    modulus of its elastic part at rest). Decks have no units: ``modulus_unit`` names that of
    moduli; times are taken as seconds.

    Raises:
        DataError: No such material, a part of it that is not read, no unit.
    """
    path = text.existing(path)
    where = str(path)
    content = text.decode_text(path.read_bytes(), where)
    read = {"LS-DYNA": _dyna, "Abaqus": _abaqus, "FEBio": _febio}[SUFFIXES[path.suffix.casefold()]]
    rest, terms, tau, shear, said = read(content, where)
    if modulus_unit is None:
        raise DataError("a deck has no units", where=where, allowed="MPa, Pa, GPa", remedy=_ASK)
    try:
        unit = to_si(f"1 {modulus_unit}", "Pa", where="--unit")
    except InputError as error:
        raise DataError(error.what, where="--unit", allowed="MPa, kPa, Pa, GPa") from error
    series = RelaxationSpectrum(rest * unit, np.array(terms) * unit, np.array(tau), source=where)
    return Deck(
        series,
        shear,
        (Message("{name}; moduli in {unit}, times in s", name=said, unit=modulus_unit),),
    )


Parts = tuple[float, list[float], list[float], bool, str]


def _cards(content: str) -> list[tuple[str, list[str]]]:
    """Return keywords of a deck in capitals with their lines, comments left out."""
    found: list[tuple[str, list[str]]] = []
    for line in content.splitlines():
        if line.startswith(("$", "**")) or not line.strip():
            continue
        if line.startswith("*"):
            found.append((re.sub(r"\s*,\s*", ",", line.strip()).upper(), []))
        elif found:
            found[-1][1].append(line)
    return found


def _numbers(line: str, where: str) -> list[float]:
    """Return the numbers of a card: with commas, or in fields of ten columns."""
    fields = line.split(",") if "," in line else [line[n : n + 10] for n in range(0, len(line), 10)]
    try:
        return [
            float(re.sub(r"(?<=\d)[dD]", "e", field)) if field.strip() else 0.0 for field in fields
        ]
    except ValueError:
        raise DataError(
            Message('"{line}" is no card of numbers', line=text.excerpt(line.strip())),
            where=where,
            allowed="fields of ten columns, or commas",
        ) from None


def _dyna(content: str, where: str) -> Parts:
    for keyword, lines in _cards(content):
        name = keyword.removeprefix("*MAT_")
        rows = lines[1:] if name.endswith("_TITLE") else lines
        name = name.removesuffix("_TITLE")
        if name in ("GENERAL_VISCOELASTIC", "076"):
            rest, terms, tau = 0.0, [], []
            for row in rows[2:]:
                g, beta = (*_numbers(row, where), 0.0, 0.0)[:2]
                if g == 0.0:
                    continue
                if beta < 0.0 or g < 0.0:
                    raise InputError(
                        Message(
                            "a term of {modulus:g} with a rate of {rate:g}", modulus=g, rate=beta
                        ),
                        where=where,
                        allowed="moduli and rates of 0 or more",
                    )
                if beta == 0.0:
                    rest += g
                else:
                    terms.append(g)
                    tau.append(1.0 / beta)
            if not terms and rows[1:] and _numbers(rows[1], where)[0]:
                raise DataError(
                    "its terms are those of a curve (LCID)",
                    where=where,
                    remedy="Write the terms that LS-DYNA fits into the card",
                )
            return rest, terms, tau, True, "LS-DYNA *MAT_GENERAL_VISCOELASTIC"
        if name in ("VISCOELASTIC", "006"):
            card = _numbers(rows[0], where)
            at_once, rest, beta = card[3:6]
            return rest, [at_once - rest], [1.0 / beta], True, "LS-DYNA *MAT_VISCOELASTIC"
    raise _none("*MAT_GENERAL_VISCOELASTIC or *MAT_VISCOELASTIC", where)


def _abaqus(content: str, where: str) -> Parts:
    shear: float | None = None
    at_rest = False
    for keyword, lines in _cards(content):
        options = keyword.split(",")
        values = [_commas(line, where) for line in lines]
        if options[0] in ("*HYPERELASTIC", "*ELASTIC"):
            shear = _elastic(options, values[0] if values else [], where)
            at_rest = "MODULI=INSTANTANEOUS" not in _bare(options)  # Abaqus' default: long term
        if options[0] == "*VISCOELASTIC":
            if "TIME=PRONY" not in _bare(options):
                raise DataError("*VISCOELASTIC without TIME=PRONY", where=where,
                                remedy="Write its Prony series")  # fmt: skip
            if shear is None:
                raise DataError("*VISCOELASTIC without *ELASTIC or *HYPERELASTIC before it",
                                where=where)  # fmt: skip
            if not values or min(map(len, values)) < 3:
                raise DataError(
                    "a row of *VISCOELASTIC without g, k and tau",
                    where=where,
                    allowed="g_i, k_i, tau_i in each row",
                )
            shares = [row[0] for row in values]
            if min(shares) < 0.0 or sum(shares) > 1.0 + 1e-6:
                raise InputError(
                    Message("shares of the modulus at once that sum to {sum:g}", sum=sum(shares)),
                    where=where,
                    allowed="0 or more, together 1 at most",
                )
            left = max(1.0 - sum(shares), 0.0)
            if at_rest and left == 0.0:
                raise DataError("a modulus at rest, and shares that leave none", where=where)
            at_once = shear / left if at_rest else shear
            said = f"Abaqus *VISCOELASTIC on moduli {'at rest' if at_rest else 'at once'}"
            return (at_once * left, [share * at_once for share in shares],
                    [row[2] for row in values], True, said)  # fmt: skip
    raise _none("*VISCOELASTIC, TIME=PRONY", where)


def _bare(options: Sequence[str]) -> str:
    return ",".join(options).replace(" ", "")


def _commas(line: str, where: str) -> list[float]:
    try:
        return [float(one) if one.strip() else 0.0 for one in line.rstrip().rstrip(",").split(",")]
    except ValueError:
        return []


def _elastic(options: Sequence[str], card: Sequence[float], where: str) -> float:
    """Return the shear modulus of *ELASTIC or *HYPERELASTIC."""
    if options[0] == "*ELASTIC" and len(card) >= 2:
        return card[0] / (2.0 * (1.0 + card[1]))
    kinds = {option.replace(" ", "").replace("-", "") for option in options[1:]}
    if kinds & {"NEOHOOKE", "NEOHOOKEAN", "YEOH", "REDUCEDPOLYNOMIAL"} and card:
        return 2.0 * card[0]
    if kinds & {"MOONEYRIVLIN", "POLYNOMIAL"} and len(card) >= 2:
        return 2.0 * (card[0] + card[1])
    if "OGDEN" in kinds and len(card) >= 2:
        count = next((int(kind[2:]) for kind in kinds if re.fullmatch(r"N=\d+", kind)), 1)
        return sum(card[0 : 2 * count : 2])
    raise DataError(
        "an elastic part that is not read", where=where,
        allowed="*ELASTIC; *HYPERELASTIC with NEO HOOKE, MOONEY-RIVLIN, POLYNOMIAL, YEOH, OGDEN",
    )  # fmt: skip


def _febio(content: str, where: str) -> Parts:
    from defusedxml import ElementTree

    try:
        root = ElementTree.fromstring(content.encode("utf-8") if "encoding" not in content[:80]
                                      else re.sub(r"<\?xml.*?\?>", "", content))  # fmt: skip
    except Exception as error:
        raise DataError("not valid XML", where=where, remedy="Export it again") from error
    for material in root.iter("material"):
        if material.get("type") not in ("viscoelastic", "uncoupled viscoelastic"):
            continue
        values = {part.tag: _value(part, where) for part in material
                  if re.fullmatch(r"[tg]\d+", part.tag)}  # fmt: skip
        numbers = sorted(int(tag[1:]) for tag in values if tag[0] == "t")
        elastic = next((e for e in material if e.tag == "elastic"), None)
        if elastic is None:
            raise DataError("a viscoelastic material without its elastic part", where=where)
        parts = {part.tag: _value(part, where) for part in elastic if part.text}
        kind = (elastic.get("type") or "").casefold()
        if "c1" in parts:
            rest = 2.0 * (parts["c1"] + parts.get("c2", 0.0))
        elif "E" in parts and "v" in parts:
            rest = parts["E"] / (2.0 * (1.0 + parts["v"]))
        else:
            raise DataError(
                Message('an elastic part "{kind}" that is not read', kind=kind),
                where=where,
                allowed="neo-Hookean, isotropic elastic, Mooney-Rivlin",
            )
        terms = [values.get(f"g{n}", 0.0) * rest for n in numbers]
        rest *= values.get("g0", 1.0)
        if min(terms, default=0.0) < 0.0:
            raise InputError("a negative factor g", where=where, allowed="0 or more")
        return rest, terms, [values[f"t{n}"] for n in numbers], True, "FEBio viscoelastic"
    raise _none('type="viscoelastic" or "uncoupled viscoelastic"', where)


def _value(part: Any, where: str) -> float:
    try:
        return float((part.text or "0").split(",")[0])
    except ValueError:
        raise DataError(
            Message(
                '"{text}" in <{tag}> is not a number', text=text.excerpt(part.text), tag=part.tag
            ),
            where=where,
        ) from None


def _none(wanted: str, where: str) -> DataError:
    return DataError(Message("the deck holds no {name}", name=wanted), where=where)
