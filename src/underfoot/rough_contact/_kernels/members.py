"""Contacts that are solved side by side: the members of a batch, the first axis of each field."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from underfoot.core.arrays import AnyArray
from underfoot.core.threads import namespace, on_host


def each(values: Sequence[float], like: AnyArray) -> Any:
    """Return one number a member, as it meets the fields ``like``: a float where there is one."""
    if len(values) == 1:
        return values[0]
    xp = namespace(like)
    column = xp.asarray(values, dtype=like.dtype, device=like.device)
    return xp.reshape(column, (-1, *[1] * (like.ndim - 1)))


def members(field: AnyArray, index: Sequence[int]) -> AnyArray:
    """Return the members ``index`` of a field: itself where they are all of them in their order."""
    if list(index) == list(range(field.shape[0])):
        return field
    xp = namespace(field)
    return xp.take(field, xp.asarray(np.array(index), device=field.device), axis=0)


def flat(field: AnyArray, xp: Any) -> AnyArray:
    """Return the values of each member in a row."""
    return xp.reshape(field, (field.shape[0], -1))


def count_true(inside: AnyArray, xp: Any) -> list[int]:
    """Return how many values of each row are true."""
    if inside.shape[0] == 1:
        return [int(xp.count_nonzero(inside))]
    return on_host(xp.count_nonzero(inside, axis=1)).tolist()


def products(rows: AnyArray, vector: AnyArray) -> AnyArray:
    """Return the products (members, n) of ``rows`` (members, n, size) with a vector."""
    if rows.shape[0] == 1:
        return (rows[0, ...] @ vector[0, ...])[None, :]
    return (rows @ vector[:, :, None])[:, :, 0]


def sums(factors: AnyArray, rows: AnyArray) -> AnyArray:
    """Return the sums (members, size) of ``factors`` (members, n) times ``rows``."""
    if rows.shape[0] == 1:
        return (factors[0, ...] @ rows[0, ...])[None, :]
    return (factors[:, None, :] @ rows)[:, 0, :]
