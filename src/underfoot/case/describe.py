"""A case in words: what was assumed, what leaves a tested range, what differs from another."""

from underfoot.core import Breach, display
from underfoot.core.remark import Remark

from .case import Case, value_text
from .contact import HardnessOption
from .parts import unit_at

_NOT_PHYSICAL = ("numerics.", "sensor.", "slip.")


def assumptions(case: Case) -> list[Remark]:
    """Return in words what no measurement or publication stands behind, alike ones on one line."""
    groups: dict[tuple[str, str], list[str]] = {}
    for path, origin in case.origins.items():
        leaf = origin.leaf
        if path.startswith("shoe.wear.") and case.shoe.wear.depth == 0:
            continue
        if path.startswith(_NOT_PHYSICAL) or path in case.idle_paths or path == "friction.pair":
            continue
        if leaf.verified and not leaf.assumed:
            continue
        section, _, key = path.rpartition(".")
        memory = "" if leaf.verified else "from memory, not verified"
        reason = "; ".join(filter(None, (leaf.note, leaf.erratum, leaf.source, memory)))
        given = value_text(origin, unit_at(path), spread=False)
        groups.setdefault((section, reason or "assumed"), []).append(f"{key} = {given}")
    lines = [
        Remark(section, f"{', '.join(keys)} ({why})") for (section, why), keys in groups.items()
    ]
    if case.interface.name == "composite":
        for path, roughness in (("shoe", case.shoe.roughness), ("floor", case.floor.roughness)):
            if roughness.rq_or_estimate is None:
                lines.append(Remark(f"{path}.roughness", "not given, the middle of what is usual"))
            elif roughness.rq is None:
                rq = display(roughness.rq_or_estimate or 0.0, "m")
                told = f"rq = {rq} (1.25 Ra, Gaussian heights)"
                if roughness.ra is None:
                    told = f"rq = {rq} (Rz over 5.7; it is over 4 to 8)"
                lines.append(Remark(f"{path}.roughness", told))
        rq = case.effective_rq
        value = display(rq.value or 0.0, rq.unit)
        if rq.assumed:
            lines.append(Remark("interface", f"effective_rq = {value} ({rq.source}; {rq.note})"))
    return lines


def tested_range_breaches(case: Case) -> list[Remark]:
    """Return in words which inputs leave the range on which a property relation was tested."""
    breaches: list[Breach] = []
    shore_a = case.shoe.material.shore_a
    if isinstance(case.hardness, HardnessOption) and shore_a is not None:
        breaches += case.hardness.build(shore_a)[1]
    if case.contaminant is not None:
        breaches += case.contaminant.breaches()
    return [breach.remark for breach in breaches]
