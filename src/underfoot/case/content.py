"""The content of a case that changes its result, as one hash."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from underfoot.core import content_hash, to_si

from .unused import unused

if TYPE_CHECKING:
    from .case import Case

_NAMES = {"file_version", "name", "description"}


def case_hash(case: Case) -> str:
    """Return a hash of the values that are used and of their uncertainties.

    The same on every machine; names, comments, sources and unused values don't count.
    """
    content = case.model_dump(exclude=_NAMES)
    left_aside = unused(case)
    # the checksum tells which outsole it is, wherever the file lies
    for path in (*left_aside, "shoe.outsole.file"):
        *parents, key = path.split(".")
        table = content
        for parent in parents:
            table = table.get(parent) or {}
        table.pop(key, None)
    spreads = {
        path: spread(case, path)
        for path, origin in case.origins.items()
        if origin.leaf.uncertainty is not None and path not in left_aside
    }
    return content_hash(_rounded(content), _rounded(spreads))[:32]


def spread(case: Case, path: str) -> float | None:
    """Return the uncertainty of the value at a dotted path in SI, None when it has none."""
    from .case import unit_at

    origin = case.origins.get(path)
    if origin is None or origin.leaf.uncertainty is None:
        return None
    return to_si(origin.leaf.uncertainty, unit_at(path), where=f"{path}.uncertainty")


def _rounded(value: Any) -> Any:
    """Return the value with 12 significant digits: "219 cP" and "0.219 Pa*s" are the same."""
    if isinstance(value, float):
        return float(f"{value:.12g}")
    if isinstance(value, dict):
        return {key: _rounded(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_rounded(item) for item in value]
    return value
