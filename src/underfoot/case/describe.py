"""A case in words: what was assumed, what leaves a tested range, what differs from another."""

import math

from underfoot.core import Breach
from underfoot.core.remark import Amount, Message, Remark

from .case import Case, value_text
from .contact import HardnessOption
from .parts import unit_at
from .surfaces import STYLUS_WAVES

_NOT_PHYSICAL = ("numerics.", "sensor.", "slip.")


def assumptions(case: Case) -> list[Remark]:
    """Return in words what no measurement or publication stands behind, alike ones on one line."""
    groups: dict[tuple[str, str], list[Message]] = {}
    for path, origin in case.origins.items():
        leaf = origin.leaf
        if path.startswith("shoe.wear.") and case.shoe.wear.depth == 0:
            continue
        if path.startswith(_NOT_PHYSICAL) or path in case.idle_paths or path == "friction.pair":
            continue
        if leaf.verified and not leaf.assumed:
            continue
        section, _, key = path.rpartition(".")
        memory = "" if leaf.verified else Message("from memory, not verified")
        parts = [*filter(None, (leaf.note, leaf.erratum, leaf.source, memory))]
        reason = Message("{parts:; }", parts=parts) if parts else Message("assumed")
        given = value_text(origin, unit_at(path), spread=False)
        value = Message("{key} = {value}", key=key, value=given)
        groups.setdefault((section, reason), []).append(value)
    lines = [
        Remark(section, "{values} ({why})", values=values, why=why)
        for (section, why), values in groups.items()
    ]
    lines += [
        Remark(section, "{names}: given, but nothing that is chosen reads it", names=names)
        for section, names in case.idle_given.items()
    ]
    if case.interface.name == "composite":
        for path, roughness in (("shoe", case.shoe.roughness), ("floor", case.floor.roughness)):
            if roughness.rq_or_estimate is None:
                lines.append(Remark(f"{path}.roughness", "not given, the middle of what is usual"))
            elif roughness.rq is None:
                rq = Amount(roughness.rq_or_estimate or 0.0, "m")
                told = Message("rq = {rq} (1.25 Ra, Gaussian heights)", rq=rq)
                if roughness.ra is None:
                    told = Message("rq = {rq} (Rz over 5.7; it is over 4 to 8)", rq=rq)
                lines.append(Remark.of(f"{path}.roughness", told))
            if roughness.file is None and (roughness.cutoff or math.inf) < STYLUS_WAVES[1]:
                lines.append(
                    Remark(
                        f"{path}.roughness",
                        "cutoff = {cutoff}: waves from there to {longest} count as none",
                        cutoff=Amount(roughness.cutoff or 0.0, "m"),
                        longest=Amount(STYLUS_WAVES[1], "m"),
                    )
                )
        rq = case.effective_rq
        if rq.assumed:
            lines.append(
                Remark(
                    "interface",
                    "effective_rq = {value} ({source}; {note})",
                    value=Amount(float(rq), rq.unit),
                    source=rq.source,
                    note=rq.note,
                )
            )
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
