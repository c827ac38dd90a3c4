"""Intervals on pages: no COF, share or distance has a bound below 0."""

import html
import re
from pathlib import Path

BOUNDED = re.compile(r"COF|share|slip|distance|load|pressure|adhesion|risk", re.IGNORECASE)
SIGNED = re.compile(
    r"\bICC\b|correlation|slope|change|differ|effect|ACOF - RCOF|half slip", re.IGNORECASE
)
INTERVAL = re.compile(r"(?<![\d.])([+-]?[\d.]+)(?: \S{1,4})? \(([-\N{MINUS SIGN}][\d.]+) to")
BLOCK = re.compile(r"<(?:tr|p|li|h\d|div|figcaption|dd|dt)\b")
HIDDEN = re.compile(r"<(script|style|svg)\b.*?</\1>", re.DOTALL)


def lines_of(page: Path) -> list[str]:
    """Return what a reader sees of a Markdown or HTML page: rows of tables, sentences, captions."""
    text = page.read_text(encoding="utf-8", errors="replace")
    if page.suffix != ".html":
        return text.splitlines()
    blocks = BLOCK.split(HIDDEN.sub("", text))
    return [" ".join(html.unescape(re.sub(r"<[^>]*>?", " ", f"<{b}")).split()) for b in blocks]


def columns_below_zero(page: Path) -> list[str]:
    """Return the rows of an HTML page whose column of low bounds goes below 0.

    Tables of differences and slopes carry signs and are exempt.
    """
    found = []
    for table in re.findall(r"<table.*?</table>", page.read_text("utf-8", "replace"), re.DOTALL):
        rows = [
            [html.unescape(re.sub(r"<[^>]*>", "", cell)).strip() for cell in cells]
            for row in re.split(r"<tr\b", table)
            if (cells := re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", row, re.DOTALL))
        ]
        if not rows or SIGNED.search(" ".join(rows[0])):
            continue
        lows = [k for k, head in enumerate(rows[0]) if re.search(r"\blow\b", head)]
        for row in rows[1:]:
            if any(re.match(r"[-\N{MINUS SIGN}]\d", row[k]) for k in lows if k < len(row)):
                found.append(f"{page.name}: {' | '.join(row)[:120]}")
    return found


def bounds_below_zero(page: Path) -> list[str]:
    """Return the lines with an interval "a (b to c)" of a positive quantity that has b below 0.

    Changes carry their sign and are exempt: their value is written with + or -.
    """
    columns = columns_below_zero(page) if page.suffix == ".html" else []
    return columns + [
        f"{page.name}: {line[:120]}"
        for line in lines_of(page)
        if BOUNDED.search(line) and not SIGNED.search(line)
        for value, low in INTERVAL.findall(line)
        if value[0] not in "+-" and float(low.replace("\N{MINUS SIGN}", "-")) < 0
    ]
