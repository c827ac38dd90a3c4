"""Damage to the bytes of a file, as Hypothesis draws it."""

from __future__ import annotations

from hypothesis import strategies as st

INSERTS = [b"\t", b"\n", b",", b"nan", b"\0" * 40, b"1e999", b"=", b"\xff\xfe", b"-", b"1,5;", b"P"]


@st.composite
def damages(draw):
    """Cut, overwrite, remove or insert; half of it in the first 4 kB, where headers lie."""
    kind = draw(st.sampled_from(["cut", "overwrite", "remove", "insert"]))
    near = draw(st.booleans())
    place = draw(st.floats(0.0, 1.0, exclude_max=True))
    many = draw(st.integers(1, 8))
    values = draw(st.binary(min_size=many, max_size=many))
    return kind, near, place, values, draw(st.sampled_from(INSERTS))


def damaged(data: bytes, damage) -> bytes:
    kind, near, place, values, insert = damage
    at = int(place * (min(len(data), 4096) if near else len(data)))
    if kind == "cut":
        return data[:at]
    if kind == "remove":
        return data[:at] + data[at + 37 * len(values) :]
    if kind == "insert":
        return data[:at] + insert + data[at:]
    changed = bytearray(data)
    for i, value in enumerate(values):
        changed[(at + 97 * i) % len(data)] = value
    return bytes(changed)
