"""Lists of XML elements that hold nothing but numbers, read without a tree."""

import numpy as np
from numpy.typing import NDArray

from underfoot.core.compiled import njit

Bytes = NDArray[np.uint8]
COMPLETE, OTHER, MISSING, NO_NUMBER = 0, 1, 2, 3
"""All read; something else than such elements; an attribute is missing; a value is no number."""


@njit(cache=True)
def element_numbers(
    text: Bytes, tag: Bytes, names: Bytes, width: int, out: NDArray[np.float64]
) -> tuple[int, int]:
    """Fill ``out`` (n, 3) with three attributes of each element; return a state and how many.

    Parameters:
        text: ``<tag a="1" b="2" c="3"/>`` n times, with any attributes in any order.
        tag: Name of the elements.
        names: The three attributes' names, ``width`` bytes each.
    """
    place, end, count = 0, text.size, 0
    while True:
        while place < end and text[place] <= 32:
            place += 1
        if place == end:
            return COMPLETE, count
        if text[place] != 60 or place + 1 + tag.size >= end:
            return OTHER, count
        place += 1
        for n in range(tag.size):
            if text[place + n] != tag[n]:
                return OTHER, count
        place += tag.size
        if text[place] > 32 and text[place] != 47:
            return OTHER, count
        found = 0
        while True:
            while place < end and text[place] <= 32:
                place += 1
            if place + 1 >= end:
                return OTHER, count
            if text[place] == 47:  # />
                if text[place + 1] != 62:
                    return OTHER, count
                place += 2
                break
            begin = place
            while place < end and text[place] > 32 and text[place] != 61 and text[place] != 62:
                place += 1
            length = place - begin
            while place < end and text[place] <= 32:
                place += 1
            if place >= end or text[place] != 61:
                return OTHER, count
            place += 1
            while place < end and text[place] <= 32:
                place += 1
            if place >= end or (text[place] != 34 and text[place] != 39):
                return OTHER, count
            quote = text[place]
            place += 1
            value = place
            while place < end and text[place] != quote:
                if text[place] == 38 or text[place] == 60:  # an entity, a tag
                    return OTHER, count
                place += 1
            if place >= end:
                return OTHER, count
            if length == width:
                for k in range(3):
                    same = True
                    for n in range(width):
                        same = same and text[begin + n] == names[k * width + n]
                    if same:
                        number, good = _number(text, value, place)
                        if not good:
                            return NO_NUMBER, count
                        out[count, k] = number
                        found |= 1 << k
            place += 1
        if found != 7:
            return MISSING, count
        count += 1


@njit(cache=True)
def _number(text: Bytes, begin: int, end: int) -> tuple[float, bool]:
    """Return the decimal number between two places, exact to 15 digits, and whether it is one."""
    while begin < end and text[begin] <= 32:
        begin += 1
    while end > begin and text[end - 1] <= 32:
        end -= 1
    negative = begin < end and text[begin] == 45
    if begin < end and (text[begin] == 45 or text[begin] == 43):
        begin += 1
    digits, power, some, point = np.int64(0), 0, False, False
    while begin < end:
        c = text[begin]
        if 48 <= c <= 57:
            some = True
            if digits < 900_000_000_000_000_000:
                digits = digits * 10 + (c - 48)
                power -= int(point)
            else:
                power += int(not point)
        elif c == 46 and not point:
            point = True
        else:
            break
        begin += 1
    if begin < end and (text[begin] == 101 or text[begin] == 69) and some:
        begin += 1
        down = begin < end and text[begin] == 45
        if begin < end and (text[begin] == 45 or text[begin] == 43):
            begin += 1
        exponent, any_digit = 0, False
        while begin < end and 48 <= text[begin] <= 57:
            exponent = min(exponent * 10 + int(text[begin] - 48), 9999)
            any_digit = True
            begin += 1
        some = any_digit
        power += -exponent if down else exponent
    value = float(digits)
    if power < 0:
        value = value / 10.0 ** min(-power, 308)
    elif power > 0:
        value = value * 10.0 ** min(power, 308)
    return -value if negative else value, some and begin == end
