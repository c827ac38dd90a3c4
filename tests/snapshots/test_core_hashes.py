"""Hashes that users have in results and caches, by their value; encodings at their limits."""

import functools
import json
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np
import pytest

from underfoot.core import Status, content_hash
from underfoot.core.text import cells_of, decode_text, excerpt, harmless, utf16_of
from underfoot.core.validity import ValidityRange
from underfoot.rough_contact import ExponentialLaw

LAW = ExponentialLaw(2e6, 0.49, 3e-6)
RANGE = ValidityRange(0.0, 2.5, "m", "a source")


def ring() -> list[Any]:
    """Return a list in a list that holds the first."""
    outer: list[Any] = [1]
    outer.append([outer, 2])
    return outer


KNOWN: dict[str, tuple[Any, str]] = {
    "int": (1, "03ebe41e58a9"),
    "bool": (True, "6574b1f32a70"),
    "text": ("1", "346922651b10"),
    "float": (2.5, "a39537b220be"),
    "None": (None, "6297dd5251a7"),
    "bytes": (b"a", "136d35c768ce"),
    "bytearray": (bytearray(b"a"), "c4fa0a245675"),
    "complex": (1 + 2j, "aefb3f63f25d"),
    "numpy": (np.float64(2.5), "a39537b220be"),
    "list": ([1, [2.0, "b"]], "319de7ad376f"),
    "tuple": ((1, 2), "78a3871b2b74"),
    "dict": ({"b": 1, "a": {"c": 2}}, "b574c2cdc382"),
    "keys": ({2: 1, "a": 3, 1: 0}, "328af9297093"),
    "view": (MappingProxyType({"a": 1}), "bc39176c43b6"),
    "set": ({"b", 2, "a", 1}, "10df80199548"),
    "frozen": (frozenset({3, 1}), "a9b50a85ac32"),
    "array": (np.arange(6.0).reshape(2, 3), "a8c9a2d8e539"),
    "integers": (np.arange(4, dtype="<i8"), "9d01822b0ee7"),
    "turned": (np.arange(6.0).reshape(2, 3).T, "d376f2bb8c4e"),
    "enum": (Status.CONVERGED, "1b6ccd2d9947"),
    "class": (Status, "5eb86b931a35"),
    "module": (json, "61ffc99b1ce1"),
    "object": (RANGE, "0ec11c034cd5"),
    "law": (LAW, "104a5c944cc3"),
    "function": (content_hash, "0520dfd9e18b"),
    "cached": (functools.cache(content_hash), "f5d4715c1561"),
    "method": (LAW.pressure, "3dc90864df9e"),
    "partial": (functools.partial(int, "3"), "776a82c8b923"),
    "ring": (ring(), "7fa47ed02064"),
}


@pytest.mark.parametrize("name", KNOWN)
def test_the_hash_of_a_thing_is_that_of_before(name):
    """Whoever changes one makes users' stored results and caches those of something else."""
    thing, known = KNOWN[name]
    assert content_hash(thing)[:12] == known


def test_parts_follow_one_another():
    assert content_hash(1, "a")[:12] == "0c20fa5dbb99"
    assert content_hash()[:12] == "e3b0c44298fc"


@dataclass
class Deep:
    """A thing in a thing."""

    inner: Any


@pytest.mark.parametrize(("count", "read"), [(61, True), (62, False)])
def test_of_things_in_things_sixty_one_are_read(count, read):
    def nest() -> list[Any]:
        made: list[Any] = []
        for _ in range(count - 1):
            made = [made]
        return made

    one, other = nest(), nest()
    assert content_hash(one) == content_hash(one)
    assert (content_hash(one) == content_hash(other)) == read
    assert content_hash(Deep(1)) == content_hash(Deep(1)) != content_hash(Deep(2))


def wide(text: str, name: str = "utf-16-le") -> bytes:
    return text.encode(name)


@pytest.mark.parametrize("name", ["utf-16-le", "utf-16-be"])
def test_text_without_a_mark_is_wide_where_four_fifths_of_it_are_latin(name):
    assert utf16_of(wide("abcdefghij", name)) == name
    assert utf16_of(wide("abcdefghi", name)) == ""  # too short to tell
    assert utf16_of(wide("abcdefghijk", name)[:-1]) == name  # half a letter is left
    assert utf16_of(wide("abcdefghħĦ", name)) == name
    assert utf16_of(wide("abcdefgħĦħ", name)) == ""
    assert utf16_of(wide("abcde\tfghij\r\n", name)) == name
    for sign in "\x01\x08\x0e\x1f":
        assert utf16_of(wide("abcdefghij" + sign, name)) == ""
    assert utf16_of(wide("abcdefghi\0", name)) == ""
    # the first 200 letters tell
    assert utf16_of(wide("a" * 200 + "ħ" * 300, name)) == name
    assert utf16_of(wide("a" * 159 + "ħ" * 41 + "a" * 900, name)) == ""
    assert decode_text(wide("time;force\n1;2\n", name), "a") == "time;force\n1;2\n"


def test_a_mark_tells_at_once_and_what_is_neither_is_latin():
    assert utf16_of(b"\xff\xfea\0") == utf16_of(b"\xfe\xff\0a") == "utf-16"
    assert utf16_of(b"\xffa" + b"a" * 30) == utf16_of(b"a" * 40) == utf16_of(b"") == ""
    assert decode_text("\ufeffa,b".encode(), "a") == "a,b"
    assert decode_text(b"10 \xb0C", "a") == "10 °C"


@pytest.mark.parametrize(("cell", "shown"), [
    ("=1", "'=1"), ("@a", "'@a"), ("\tx", "'\tx"), ("\rx", "'\rx"), ("+1", "+1"), ("-1", "-1"),
    ("-a|b", "'-a|b"), ("+a!b", "'+a!b"), ("-f(x)", "'-f(x)"), ("- (x)", "- (x)"), ("a=1", "a=1"),
    ("+1\n|x", "'+1\n|x"), ("", ""),
])  # fmt: skip
def test_a_cell_that_a_spreadsheet_would_run_is_quoted(cell, shown):
    assert harmless(cell) == shown


@pytest.mark.parametrize(("line", "separator", "cells"), [
    ("a, b ,c", ",", ["a", "b", "c"]), ("a  b\tc", None, ["a", "b", "c"]),
    ('"a, b", c', ",", ["a, b", "c"]), ('"a b" c "d"', None, ["a b", "c", "d"]),
    ('" a " b"c', None, ["a", 'b"c']), ('" x', None, ['"', "x"]), ('""', None, [""]),
])  # fmt: skip
def test_cells_of_a_line(line, separator, cells):
    assert cells_of(line, separator) == cells


def test_an_excerpt_is_forty_letters_at_most():
    assert excerpt("a" * 40) == "a" * 40
    assert excerpt("a" * 41) == "a" * 37 + "..."
    assert excerpt("a\0b\nc") == "a?b?c"
    assert excerpt("abcdef", 5) == "ab..."
