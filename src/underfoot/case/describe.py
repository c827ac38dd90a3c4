"""A case in words: its composition with the origin of each value, and what was assumed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from underfoot.core import display

from .compose import CATALOGUE, GIVEN
from .schema import fields
from .unused import unused

if TYPE_CHECKING:
    from .case import Case

_NOT_PHYSICAL = ("numerics.", "sensor.", "models.")


def composition(case: Case) -> str:
    """Return the whole case, one value a line, with where it comes from."""
    lines = [f"{case.name}  [{case.hash[:12]}]"]
    if case.description:
        lines.append(case.description)
    section = ""
    for path, value, origin in rows(case):
        head, _, key = path.partition(".")
        if head != section:
            section = head
            entry = case.entries.get(head)
            lines.append(f"{head}" + (f'  (from "{entry}")' if entry else ""))
        lines.append(f"  {key:28} {value:18} {origin}")
    if case.contaminant is None:
        lines.append("contaminant  none: dry floor")
    rq = case.effective_rq
    lines.append(f"effective Rq of the interface {rq}: {rq.source}")
    return "\n".join(lines)


def rows(case: Case) -> list[tuple[str, str, str]]:
    """Return (dotted path, value as given, origin in words) of every value that is set."""
    found = []
    left_aside = unused(case)
    for path, _ in fields(type(case)):
        if "." not in path or path in left_aside or case.value(path) is None:
            continue
        origin = case.origins.get(path)
        if origin is None:
            continue
        leaf = origin.leaf
        words = {GIVEN: "given", CATALOGUE: f"catalogue: {origin.entry}"}.get(
            origin.kind, "default"
        )
        if leaf.assumed:
            words += ", assumed"
        if not leaf.verified:
            words += ", from memory"
        if leaf.source:
            words += f" ({leaf.source})"
        found.append((path, _text(leaf.given, leaf.uncertainty), words))
    return found


def assumptions(case: Case) -> list[str]:
    """Return in words what no measurement or publication stands behind, alike ones on one line."""
    left_aside = unused(case)
    groups: dict[tuple[str, str], list[str]] = {}
    for path, origin in case.origins.items():
        leaf = origin.leaf
        if path.startswith(_NOT_PHYSICAL) or path in left_aside or case.value(path) is None:
            continue
        if path == "contaminant.boundary.pair" or (leaf.verified and not leaf.assumed):
            continue
        section, _, key = path.rpartition(".")
        parts = [leaf.note, leaf.source, "" if leaf.verified else "from memory, not verified"]
        reason = "; ".join(part for part in parts if part) or "assumed"
        groups.setdefault((section, reason), []).append(f"{key} = {_text(leaf.given, None)}")
    found = [f"{section}: {', '.join(keys)} ({why})" for (section, why), keys in groups.items()]
    if case.shoe.outsole.file is not None:
        from .build_outsole import outsole_notes

        found += outsole_notes(case)
    if case.interface.effective_rq is None:
        for path, roughness in (("shoe", case.shoe.roughness), ("floor", case.floor.roughness)):
            if roughness.rq is None and roughness.ra is not None:
                rq = display(roughness.rq_or_estimate or 0.0, "m")
                found.append(f"{path}.roughness: rq = {rq} (1.25 Ra, Gaussian heights)")
        rq = case.effective_rq
        shown = display(rq.value or 0.0, rq.unit)
        found.append(f"interface: effective_rq = {shown} ({rq.source}; {rq.note})")
    return found


def tested_range_breaches(case: Case) -> list[str]:
    """Return in words which inputs leave the range on which a property relation was tested."""
    from underfoot.fluid import glycerol_water_breaches
    from underfoot.material import gent_breaches

    found: list[object] = []
    material, fluid = case.shoe.material, case.contaminant
    if material.modulus is None and material.shore_a is not None and case.models.hardness == "gent":
        found += gent_breaches(material.shore_a)
    if fluid is not None and fluid.glycerol_fraction is not None:
        found += glycerol_water_breaches(fluid.glycerol_fraction, fluid.temperature)
    return [str(breach) for breach in found]


def given_in_vain(case: Case) -> list[str]:
    """Return what the case file gives and no chosen shape, fluid or model looks at."""
    from .compose import GIVEN

    return [
        f"{path} = {origin.leaf.given}"
        for path, origin in case.origins.items()
        if origin.kind == GIVEN and path in unused(case) and case.value(path) is not None
    ]


def differences(first: Case, second: Case) -> list[tuple[str, str, str]]:
    """Return (path, first, second) of the values in which two cases differ."""
    left, right = ({path: value for path, value, _ in rows(case)} for case in (first, second))
    paths = [*left, *(path for path in right if path not in left)]
    return [
        (path, left.get(path, "-"), right.get(path, "-"))
        for path in paths
        if left.get(path) != right.get(path)
    ]


def _text(given: Any, spread: Any) -> str:
    if isinstance(given, bool):
        return "yes" if given else "no"
    if isinstance(given, list | tuple):
        return f"{len(given)} terms"
    return f"{given}" + ("" if spread is None else f" ± {spread}")
