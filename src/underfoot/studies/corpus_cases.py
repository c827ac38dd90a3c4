"""Cases that stand for the corpus: both sides of each published effect, and whole-shoe readings.

What a source leaves open takes the geometric middle of its range, or a usual value, an open
roughness two values; each such number is named beside the case. What cannot be computed is named
with the reason.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

from underfoot.case import Case
from underfoot.case.sole import Lugs
from underfoot.case.surfaces import FLOOR_RQ, SOLE_RQ
from underfoot.compute.resolve import resolve_context
from underfoot.core import InputError, to_si, unknown_name
from underfoot.film import Strike, touch_time
from underfoot.rough_contact import ExponentialLaw

from .sources import RQ_PER_RA, PublishedCondition, PublishedEffect, Source, Span

WHOLE_SHOE = ("whole shoe", "walking")
FLAT = ("block", "pin", "slipmeter", "pull slipmeter", "drop pad")
HEEL = {
    "length": "75 mm",
    "width": "65 mm",
    "profile": {"model": "rocker", "radius": "100 mm", "start": "35 mm"},
}
"""Rounded heel of a whole shoe (assumed): no source prints its shape."""
SPECIMEN = {
    "length": "30 mm",
    "width": "30 mm",
    "rear_radius": "0 mm",
    "profile": {"model": "flat"},
}
"""Flat block, pin or pad (assumed): no source prints its size."""
METHOD = {"from": "en_iso_13287"}
SLID_FLAT = {"speed": "0.3 m/s", "normal_force": "100 N", "shoe_angle": "0 deg"}
MOTION = {
    "speed": ("speed", "m/s"),
    "load": ("normal_force", "N"),
    "shoe_angle": ("shoe_angle", "rad"),
}
VISCOSITY = {"water": 1e-3, "detergent": 1e-3, "oil": 75e-3, "aqueous": 0.2}
"""Pa s, where a source names the fluid alone."""
USUAL_RQ = {"sole": SOLE_RQ, "floor": FLOOR_RQ}
SHORE_A = {"neolite": 93.0}
USUAL_SHORE_A = 61.0
"""Middle of 50 to 75, the market of outsoles; of Neolite from memory."""
TREAD = {"depth": 3e-3, "channel_width": 3e-3, "lug_width": 5e-3, "edge_radius": 0.0}
"""m, where not printed."""
PITCH = 10e-3
"""m, of a grid of which the share of land is printed."""
GROOVES = {"across": "transverse", "along": "longitudinal", "oblique": "transverse"}
OBLIQUE = "45 deg"
PATTERNS = {
    "grooves": GROOVES,
    "strips": GROOVES,
    "market": {"across": "grid"},
    "not printed": {"across": "grid"},
}
"""Pattern of the case by the printed pattern and direction."""
OPEN_SHARES = (0.25, 0.75)
"""Where between its bounds a roughness that the source leaves open is taken, evenly in its
logarithm: a case each, for smooth pairs wipe and seal where rough ones do not."""
STRIKE = 50e-3
"""s from a drop pad's touching the pool to the end of its pull (assumed)."""
WEAR = {"new": "0 mm", "slight": "1 mm", "through": "3.5 mm"}
"""Worn off at 7 deg (assumed): none is printed."""
WALKING = {"forwards": "0 deg", "backwards": "7 deg"}
"""Shoe angle (assumed): the most friction of a step forwards is had flat on the sole, of one
backwards on the heel."""
TOPICS = {
    "shore_a": "hardness",
    "sole_ra": "roughness",
    "sole_rq": "roughness",
    "floor_ra": "roughness",
    "tread.direction": "groove direction",
    "tread.depth": "depth",
    "tread.edge_radius": "edge radius",
    "tread.land": "tread area",
    "wear": "wear",
    "fluid": "fluid",
    "shoe_angle": "shoe angle",
    "walking": "shoe angle",
}
"""What an effect is about, by the number that differs between its sides."""
ABSENT, DECIDED = 0.02, 0.75
"""|ln ratio| below which an effect is absent; probability at which its sign is right."""


@dataclass(frozen=True, slots=True)
class Stand:
    """Cases whose mean COF stands for one condition, and what its source leaves open.

    ``contact_time`` is the share of a drop pad's pull during which it touches, 1 for all else.
    """

    cases: tuple[Case, ...] = ()
    taken: tuple[str, ...] = ()
    reason: str = ""
    contact_time: float = 1.0


@dataclass(frozen=True, slots=True)
class Contrast:
    """One published effect under one fluid: COF of ``over`` against that of ``under``.

    ``rises`` is the published sign. ``low`` and ``high`` bound the published ratio (or slope, over
    ``step`` in its unit); nan where the sign alone is published. Both sides are the
    highest and the lowest of ``extremes_of``.
    """

    source: str
    effect: str
    fluid: str
    topic: str
    over: Stand
    under: Stand
    rises: bool
    low: float = math.nan
    high: float = math.nan
    step: float = math.nan
    extremes_of: int = 2

    @property
    def reason(self) -> str:
        """Why it cannot be computed; empty where it can."""
        return self.over.reason or self.under.reason

    @property
    def published(self) -> str:
        """What the source prints, in words."""
        if math.isnan(self.low):
            return "higher" if self.rises else "lower"
        numbers = " to ".join(f"{x:g}" for x in dict.fromkeys((self.low, self.high)))
        return f"{'ratio' if math.isnan(self.step) else 'per mm'} {numbers}"


def verdict(ratio: float, chance: float) -> str:
    """Return the verdict of an effect by its ratio and the probability of the published sign."""
    if abs(math.log(ratio)) < ABSENT:
        return "absent"
    if chance >= DECIDED:
        return "right"
    return "wrong" if chance <= 1 - DECIDED else "undecided"


def contrasts(source: Source) -> list[Contrast]:
    """Return every effect of a source, once for each fluid and step of an order."""
    return [contrast for effect in source.effects for contrast in _of(effect, source)]


def whole_shoe_stands(source: Source) -> list[tuple[PublishedCondition, Stand]]:
    """Return each condition of whole shoes with the cases that stand for it."""
    return [
        (c, stand(condition_table(c)))
        for c in source.conditions
        if c.labels.get("device") in WHOLE_SHOE
    ]


def condition_table(condition: PublishedCondition) -> dict[str, Any]:
    """Return a condition as one table, as effects write theirs."""
    members = [condition_table(member) for member in condition.members]
    table = {**condition.labels, **condition.numbers}
    return {**table, "members": members} if members else table


def stand(table: Mapping[str, Any]) -> Stand:
    """Return the cases of a condition's or effect's contents, or why there is none."""
    taken: dict[str, None] = {}
    try:
        members = [_Contents({**table, **one}, taken) for one in table.get("members") or [{}]]
        cases = tuple(case for member in members for case in member.cases())
        if table.get("device") == "drop pad" and cases[0].contaminant:
            taken |= dict.fromkeys(("tread.lug_width", "pool", "drop", "pull time"))
            times = [_contact_time(case) for case in cases]
            return Stand(cases, tuple(taken), contact_time=sum(times) / len(times))
    except InputError as error:
        why = " ".join(str(error).split())
        return Stand(reason=why)
    return Stand(cases, tuple(taken))


def _contact_time(case: Case) -> float:
    """Return the share of a drop pad's pull during which half its load rests on the floor."""
    tread, context = case.shoe.tread, resolve_context(case)
    if not isinstance(tread, Lugs) or context.viscosity_value is None:
        return 1.0
    asperities = ExponentialLaw(context.youngs_modulus, context.poisson_ratio, context.rq_value)
    strike = Strike(tread.channel_width, tread.depth, tread.lug_width, context.viscosity_value)
    return max(1 - touch_time(strike, asperities.pressure) / STRIKE, 0.0)


def _of(effect: PublishedEffect, source: Source) -> Iterator[Contrast]:
    content = effect.content
    base = content.get("conditions", {})
    low = high = step = math.nan
    if effect.kind == "order":
        pairs = [(two, one, two["change"] == "up") for one, two in pairwise(content["sequence"])]
        pairs = [({"wear": a["wear"]}, {"wear": b["wear"]}, up) for a, b, up in pairs]
    elif effect.kind == "slope":
        first, last = content["over"]
        low, high = content["low"], content["high"]
        first_m, last_m = (to_si(end, "m", where=effect.id) for end in (first, last))
        step = 1e3 * (last_m - first_m)
        pairs = [(_nest_path(content["per"], last), _nest_path(content["per"], first), low > 0)]
    elif effect.kind == "ratio":
        low = content.get("low", content.get("ratio"))
        high = content.get("high", content.get("ratio"))
        pairs = [(_side(content, "numerator", source), _side(content, "denominator", source))]
        pairs = [(*pairs[0], low > 1)]
    else:
        pairs = [(content["higher"], content["lower"], True)]
    for over, under, rises in pairs:
        for fluid in content.get("fluids", [None]):
            shared = base if fluid is None else {**base, "fluid": fluid}
            yield Contrast(
                source.name,
                effect.id + (f": {over['wear']}" if effect.kind == "order" else ""),
                fluid or _fluid(_merge_settings(shared, over), _merge_settings(shared, under)),
                _topic(over, under),
                stand(_merge_settings(shared, over)),
                stand(_merge_settings(shared, under)),
                rises,
                low,
                high,
                step,
                content.get("extremes_of", 2),
            )


def _side(content: Mapping[str, Any], name: str, source: Source) -> Mapping[str, Any]:
    if f"{name}_conditions" in content:
        return content[f"{name}_conditions"]
    return condition_table(next(c for c in source.conditions if c.id == content[name]))


def _fluid(over: Mapping[str, Any], under: Mapping[str, Any]) -> str:
    tables = [member for side in (over, under) for member in side.get("members") or [side]]
    return ", ".join(dict.fromkeys(str(table.get("fluid", "not given")) for table in tables))


def _nest_path(path: str, item: Any) -> dict[str, Any]:
    head, _, rest = path.partition(".")
    return {head: _nest_path(rest, item) if rest else item}


def _merge_settings(base: Mapping[str, Any], more: Mapping[str, Any]) -> dict[str, Any]:
    both = {key: {**base[key], **more[key]} for key in base.keys() & more.keys() if key == "tread"}
    return {**base, **more, **both}


def _topic(over: Mapping[str, Any], under: Mapping[str, Any]) -> str:
    flat = [
        {**side, **{f"tread.{key}": item for key, item in side.get("tread", {}).items()}}
        for side in (over, under)
    ]
    names = [TOPICS[key] for key in TOPICS if flat[0].get(key) != flat[1].get(key)]
    return ", ".join(dict.fromkeys(names)) or "other"


@dataclass(frozen=True, slots=True)
class _Contents:
    """What a source writes of a condition; ``taken`` collects what it leaves open."""

    table: Mapping[str, Any]
    taken: dict[str, None]
    share: float = 0.5

    def cases(self) -> tuple[Case, ...]:
        """Return the case, or one each at the shares of an open roughness."""
        self.case()
        if not {"sole_rq", "floor_rq"} & self.taken.keys():
            return (self.case(),)
        return tuple(replace(self, share=share).case() for share in OPEN_SHARES)

    def case(self) -> Case:
        device = self.table.get("device")
        whole = device in WHOLE_SHOE
        if not whole and device not in FLAT:
            raise InputError(f"{device} is no device of the program", where="device")
        motion: dict[str, Any] = dict(METHOD if whole else SLID_FLAT)
        for key, (name, unit) in MOTION.items():
            if key in self.table:
                motion[name] = f"{self.middle(key, unit):.6g} {unit}"
            else:
                self.taken[key] = None
        if "walking" in self.table:
            motion["shoe_angle"] = WALKING[self.table["walking"]]
        self.taken["shape" if whole else "size"] = None
        return Case.from_mapping(
            {
                "name": str(device),
                "shoe": {
                    "material": self.material(),
                    "roughness": {"rq": self.rq("sole")},
                    "heel": HEEL if whole else SPECIMEN,
                    "tread": self.tread(whole),
                    "wear": {"depth": self.wear(), "angle": "7 deg" if whole else "0 deg"},
                },
                "floor": {"roughness": {"rq": self.rq("floor")}},
                "contaminant": self.fluid(),
                "motion": motion,
                "numerics": {"tread_positions": 1},
            }
        )

    def middle(self, key: str, unit: str) -> float:
        """Return a number in SI, the geometric middle of a range."""
        return self._middle(self.table[key], key, unit)

    def _ends(self, item: Any, key: str, unit: str) -> tuple[float, float]:
        if isinstance(item, Span):
            return item.low, item.high
        ends = item if isinstance(item, list) else [item]
        low, high = (to_si(end, unit, where=key) for end in (ends[0], ends[-1]))
        return low, high

    def _middle(self, item: Any, key: str, unit: str) -> float:
        low, high = self._ends(item, key, unit)
        if high > low:
            self.taken[key] = None
        return math.sqrt(low * high)

    def material(self) -> dict[str, Any]:
        compound = self.table.get("compound")
        named = {"polymer": compound} if compound else {}
        return {**named, "shore_a": self.shore_a()}

    def shore_a(self) -> float:
        if "shore_a" in self.table:
            return self.middle("shore_a", "1")
        self.taken["shore_a"] = None
        return SHORE_A.get(self.table.get("compound", ""), USUAL_SHORE_A)

    def rq(self, part: str) -> str:
        low, high = USUAL_RQ[part]
        for name, factor in ((f"{part}_ra", RQ_PER_RA), (f"{part}_rq", 1.0)):
            if name in self.table:
                low, high = (factor * end for end in self._ends(self.table[name], name, "m"))
                break
        if high > low:
            self.taken[f"{part}_rq"] = None
        return f"{1e6 * low * (high / low) ** self.share:.4g} um"

    def fluid(self) -> Any:
        fluid = self.table.get("fluid")
        if fluid == "dry":
            return "none"
        if fluid not in VISCOSITY:
            raise InputError("the source names no fluid", where="fluid")
        viscosity = VISCOSITY[fluid]
        if "viscosity" in self.table:
            viscosity = self.middle("viscosity", "Pa*s")
        else:
            self.taken["viscosity"] = None
        family = {"oil": "oil", "detergent": "detergent"}.get(fluid, "aqueous")
        return {"viscosity": f"{1e3 * viscosity:.6g} cP", "family": family}

    def tread(self, whole: bool) -> dict[str, Any]:
        printed = self.table.get("tread", {})
        if not printed and not whole:
            return {"pattern": "none"}
        usual = "not printed" if whole else "grooves"
        drawn = PATTERNS.get(printed.get("pattern", usual))
        pattern = drawn and drawn.get(printed.get("direction", "across"))
        if pattern is None:
            written = " ".join(map(str, printed.values()))
            raise unknown_name("pattern", written, PATTERNS, where="tread")
        numbers = dict(TREAD)
        for key in TREAD:
            if key in printed:
                numbers[key] = self._middle(printed[key], f"tread.{key}", "m")
            else:
                self.taken[f"tread.{key}"] = None
        if "land" in printed:
            numbers["lug_width"] = PITCH * math.sqrt(printed["land"])
            numbers["channel_width"] = PITCH - numbers["lug_width"]
        texts = {key: f"{1e3 * number:.6g} mm" for key, number in numbers.items()}
        if printed.get("direction") == "oblique":
            self.taken["tread.angle"] = None
            texts["angle"] = OBLIQUE
        return {"pattern": pattern, **texts}

    def wear(self) -> str:
        worn = self.table.get("wear", "new")
        if worn not in WEAR:
            raise unknown_name("wear", str(worn), WEAR, where="wear")
        if worn != "new":
            self.taken["wear"] = None
        return WEAR[worn]
