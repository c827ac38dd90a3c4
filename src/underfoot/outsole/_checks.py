"""Checks of single numbers, with the place and what is allowed."""

from __future__ import annotations

import math

from underfoot.core import InputError


def positive(value: float, where: str) -> None:
    """Refuse a value that is not a finite number above 0."""
    if not (math.isfinite(value) and value > 0):
        raise InputError(
            f"{value:g} is not positive", where=where, allowed="a finite number above 0"
        )


def not_negative(value: float, where: str) -> None:
    """Refuse a value that is not a finite number of at least 0."""
    if not (math.isfinite(value) and value >= 0):
        raise InputError(
            f"{value:g} is negative", where=where, allowed="a finite number, 0 or more"
        )


def between(value: float, low: float, high: float, where: str, shown: str) -> None:
    """Refuse a value outside [low, high]; ``shown`` is the allowed range as a person reads it."""
    if not low <= value <= high:
        raise InputError(f"{value:g} is out of range", where=where, allowed=shown)
