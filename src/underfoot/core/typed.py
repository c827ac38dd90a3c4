"""One way to read a number that a person typed: comma or point, thousands, fractions, signs.

What is ambiguous is refused with both readings, never decided.
"""

from __future__ import annotations

import re
import unicodedata

from .errors import InputError
from .remark import Message

MINUS = "-\u2212\u2012\u2013\u2010\u2011\ufe63\uff0d"
"""Signs that people write for a minus: those of keyboards, of typesetting, of spreadsheets."""
_MINUS = dict.fromkeys(map(ord, MINUS), "-")
_FRACTION = re.compile(
    r"([+-]?)\s*(?:(\d+)[ -])?(\d+)\s*[/\u2044]\s*(\d+)(?![\d.,/])(.*)", re.DOTALL
)
_DIGITS = re.compile(
    r"([+-]?)\s*(\d+(?:[.,'\u2019]\d+| \d{3}(?![\d/]))*[.,]?|[.,]\d+)"  # sign, digits
    r"(?:[eE]([+-]?\d+))?(?![\d.,])(.*)",  # exponent, unit
    re.DOTALL,
)


def plain_signs(text: str) -> str:
    """Return a text with one kind of space and of minus, without signs that nobody sees.

    >>> plain_signs("\u22121\u2009234\u200b mm")
    '-1 234 mm'
    """
    if text.isascii():
        return text.replace("\t", " ")
    signs = {"Zs": " ", "Cf": ""}
    plain = "".join(signs.get(unicodedata.category(sign), sign) for sign in text)
    return plain.translate(_MINUS).replace("\t", " ")


def split_quantity(text: str, *, comma: bool = False) -> tuple[float, str] | None:
    """Return number and unit of a text such as "41,5 cP" or "3/8 in"; None where it has no number.

    Parameters:
        text: What was typed.
        comma: The writer's decimal sign is the comma: "1,234" is then 1.234, and "1.234" is asked.

    Raises:
        InputError: It can be read as two numbers, with both; it is not 0 and too small to be held.

    >>> split_quantity("1.234,5 N"), split_quantity("1 1/2 in"), split_quantity("\u22123 mm")
    ((1234.5, 'N'), (1.5, 'in'), (-3.0, 'mm'))
    """
    text = _vulgar(plain_signs(text)).strip()
    if (match := _FRACTION.fullmatch(text)) and int(match[4]):
        sign, whole, above, below, unit = match.groups()
        size = int(whole or 0) + int(above) / int(below)
        return (-size if sign == "-" else size), unit.strip()
    match = _DIGITS.fullmatch(text)
    if match is None:
        return None
    sign, digits, exponent, unit = match.groups()
    plain = _decimal(digits, text, "," if comma else ".")
    if plain is None:
        return None
    return float_of_text(f"{sign}{plain}e{exponent or 0}"), unit.strip()


def float_of_text(plain: str) -> float:
    """Return the number of a text as ``float`` takes it.

    Raises:
        InputError: It is not 0 and too small to be held.
    """
    number = float(plain)
    if is_lost(number, plain):
        raise InputError(
            Message("{plain} is too small to be told from 0", plain=plain),
            allowed="0, or a larger number",
        )
    return number


def is_lost(number: float, text: str) -> bool:
    """Return whether the number of a text is 0 because it is too small to be held."""
    return number == 0.0 and re.match(r"[^eE]*[1-9]", text) is not None


def _vulgar(text: str) -> str:
    """Write a fraction of one letter with a stroke: 1\u00bd as 1 1/2."""
    written = ""
    for letter in text:
        if unicodedata.decomposition(letter).startswith("<fraction>"):
            written = (written.rstrip() + " ").lstrip() + unicodedata.normalize("NFKC", letter)
        else:
            written += letter
    return written


def _decimal(digits: str, text: str, usual: str) -> str | None:
    """Return digits with a decimal point and no thousands, None for what is no number."""
    signs = [digit for digit in digits if not digit.isdigit()]
    if not signs:
        return digits
    last = signs[-1]
    if last in ".," and signs.count(last) == 1:
        whole, _, part = digits.rpartition(last)
        if not signs[:-1]:
            if last != usual and re.fullmatch(r"[1-9]\d{0,2}", whole) and len(part) == 3:
                readings = {"small": f"{whole}.{part}", "large": f"{whole}{part}"}
                raise InputError(
                    Message('"{text}" can be {small} or {large}', text=text, **readings),
                    allowed=f"{whole}{usual}{part} or {whole}{part}",
                    remedy="Write it without thousands, with the decimal sign of the page",
                )
            return f"{whole or 0}.{part or 0}"
        if _is_grouped(whole, signs[0]):
            return f"{whole.replace(signs[0], '')}.{part or 0}"
        return None
    if _is_grouped(digits, last):
        return digits.replace(last, "")
    return None


def _is_grouped(digits: str, sign: str) -> bool:
    """Return whether digits stand in thousands."""
    return re.fullmatch(rf"[1-9]\d{{0,2}}(?:{re.escape(sign)}\d{{3}})+", digits) is not None
