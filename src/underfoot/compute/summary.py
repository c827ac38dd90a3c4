"""A result in sentences and table rows: number, unit, uncertainty, then the caution."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from types import MappingProxyType
from typing import Literal

from underfoot.core import SourcedValue, Status
from underfoot.core.fields import Fields
from underfoot.core.presentation import (
    Part,
    Table,
    interval_text,
    percent,
    probability_text,
    quantity_text,
    shows_interval,
    value_text,
)
from underfoot.core.remark import NOTHING, Message, Remark, subjects
from underfoot.shoe.lug_drainage import MATTERS, TO_SIDES, across_text

FILM_MATTERS = 0.05
"""Share of the load carried by the film above which drainage can raise the friction."""
FILM_BEARS = 0.5
"""Share of the load above which the film, not what touches, makes the friction."""
GAIN_MATTERS = 1.1
"""Ratio of the COF without the film to the present one above which drainage is worth naming."""
QUANTITIES: Mapping[str, tuple[str, str]] = {
    "cof": ("Coefficient of friction", ""),
    "later_cof": (Part("held on"), "load, speed and shoe angle stay"),
    "cof_tread_position": (Part("spread over tread positions"), ""),
    "cof_shoe_angle": (Part("spread over a degree of shoe angle"), ""),
    "cof_adhesion": (Part("from adhesion"), ""),
    "cof_hysteresis": (Part("from hysteresis"), ""),
    "cof_viscous": (Part("from shearing the fluid"), ""),
    "fluid_load": ("Load carried by the fluid", "under the whole sole"),
    "later_fluid_load": (Part("held on"), "load, speed and shoe angle stay"),
    "fluid_load_sensor": (Part("as floor sensors read it"), ""),
    "peak_fluid_pressure": ("Peak fluid pressure", "anywhere under the sole"),
    "peak_fluid_pressure_sensor": (Part("as a floor sensor reads it"), ""),
    "array_peak": (Part("highest in the sensor array"), "the sensors stay in the floor"),
    **{
        f"array_peak_row_{n}": (Part(Message("row {count} of the array", count=n)), "")
        for n in range(1, 10)
    },
    "array_duration": (Part("pressure lasts in the array"), ""),
    "contact_area": ("Contact area", "where the rough surfaces touch"),
    "micro_contact": (Part("real contact within it"), ""),
    "micro_hysteresis": (Part("hysteresis COF of the rough contact"), ""),
    "micro_gap": (Part("mean gap between the rough surfaces"), ""),
    "micro_flow": (Part("flow factor of that gap"), ""),
    "minimum_film_thickness": ("Thinnest film", "mean gap between the surfaces"),
    "slip_probability": ("Slip probability", "walkers as described in the case"),
}
"""Label and remark of each quantity, in the order of the summary; parts are indented."""
GRIPS, SLIPS = 1e-3, 0.05
"""Slip probability that every verdict "grips" lies below, the least that is printed; and that every
verdict "slips" lies above: 1 in 20, that of a floor at the end of "high slip potential" (pendulum
value 24; as printed by C. Harris, Tomorrow's Health & Safety, April 2023, after HSE and BRE)."""
LONGEST_SLIDE = 0.5
"""m, assumed: no slip tester slides further in one reading."""
LUGS_SHOWN = 6
"""Most lugs in the table of their drainage."""
LABELS = {
    "cof_spread_from": "Uncertainty of the COF",
    "film_spread": "Spread of the film",
    "stated_spreads": "Stated spreads",
    "stated_idle": "Stated without effect",
    "slope": "Slope",
    "tread_position": "Tread position",
    "shoe_angle": "Shoe angle",
    "grid_error": "Numerical error",
    "edge_peak": "Caution on pressures",
    "drainage": "Drainage",
    "lug_edges": "Edges of the lugs",
    "sipes": "Sipes",
    "sensor": "Caution on the sensor",
    "objects": "Computed with an object in place of the case's option",
}
CAUTIONS = ("floor_reading", "positions_left_out", "angle_as_exact", "stated_left_out")
"""Labels that are cautions, the most serious first."""
PARTS: Mapping[str, str] = {
    "exponential": "how closely rough surfaces come together under this pressure",
    "persson": "how closely rough surfaces come together under this pressure",
    "greenwood_williamson_1966": "how closely rough surfaces come together under this pressure",
    "pair": "the friction of this sole on this floor",
    "stribeck": "the friction of this sole on this floor",
    "speed_table": "the friction of this sole on this floor",
    "compound": "how the rubber answers at the rates of sliding",
    "grid": "the tread, which has few cells of the grid across its details",
    "tread": "channels that the summits of the rough surfaces fill",
    "forefoot": "push-off: the forefoot of a shoe bends where this sole stays straight",
    "compliance": "how the rubber gives way under the load",
    "gent_1958": "the stiffness of a rubber of this hardness",
    "ruess": "the stiffness of a rubber of this hardness",
    "bs903_1950": "the stiffness of a rubber of this hardness",
    "cheng_2008": "the viscosity of the glycerol",
    "strobel_2012": "how much adhesion this fluid leaves",
    "patir_cheng_1978": "how roughness slows the fluid",
}
"""What each model is for, in words for readers who do not know its name."""
DECISIVE = ("interface", "shoe.heel", "shoe.tread", "shoe.sole", "motion")
"""Sections whose assumed inputs move the film load most, the most sensitive first."""


@dataclass(frozen=True, slots=True)
class FrictionLimit:
    """What keeps the friction low.

    ``cof_without_film`` is the COF if the film carried no load and the present friction of the
    touching part acted everywhere: (COF - viscous part) / (1 - film share). Without a fluid in the
    case (a dry floor, or a COF that was measured with one) ``film_share`` is nan.
    """

    film_share: float
    cof: float
    cof_without_film: float

    @property
    def kind(self) -> Literal["film", "shear", "boundary", "no fluid"]:
        """Return what limits the friction: film, its shear, blocked adhesion or the pair."""
        if math.isnan(self.film_share):
            return "no fluid"
        drainage = self.cof_without_film > GAIN_MATTERS * self.cof
        if self.film_share > FILM_MATTERS and drainage:
            return "film"
        return "shear" if self.film_share > FILM_BEARS else "boundary"

    def sentence(self, regime: str = "") -> Message:
        """Return the limit as a sentence; ``regime`` ("mixed") stands behind the film's load."""
        if self.kind == "no fluid":
            return Message(
                "The case has no fluid: the friction of the pair, as given, is the limit."
            )
        limit = Message(
            "the rest touches the floor, where wet rubber sticks less than dry: that is the limit."
        )
        if self.kind == "film":
            limit = Message(
                "without the film the same surfaces would have a COF of about {cof:.2f}.",
                cof=self.cof_without_film,
            )
        elif self.kind == "shear":
            touching = (1.0 - self.film_share) * self.cof_without_film / self.cof
            sheared = percent(1.0 if math.isnan(touching) else 1.0 - touching)
            limit = Message("shearing the fluid makes {share} of this COF.", share=sheared)
        values = {"share": percent(self.film_share), "limit": limit}
        if not regime:
            return Message("The film carries {share} of the load; {limit}", **values)
        return Message(
            "The film carries {share} of the load ({regime}); {limit}", **values, regime=regime
        )

    def __str__(self) -> str:
        return self.sentence()


def friction_limit(scalars: Mapping[str, SourcedValue]) -> FrictionLimit:
    """Return what limits the friction of a usable result."""
    cof = _number(scalars, "cof")
    if scalars["minimum_film_thickness"].value is None:
        return FrictionLimit(math.nan, cof, cof)
    share = _number(scalars, "fluid_load") / _number(scalars, "normal_force")
    solid = cof - _number(scalars, "cof_viscous")
    return FrictionLimit(share, cof, solid / (1.0 - share) if share < 1.0 else math.nan)


def verdict(
    scalars: Mapping[str, SourcedValue], labels: Mapping[str, str]
) -> Literal["grips", "doubtful", "slips", ""]:
    """Return what a person may expect of a step; empty where no slip probability is known.

    Both ends of its 95 % interval decide. Pressures that the rubber cannot bear leave a doubt.
    """
    slip = scalars.get("slip_probability")
    if slip is None or slip.value is None:
        return ""
    low, high = slip.interval or (slip.value, slip.value)
    if low > SLIPS:
        return "slips"
    return "grips" if high < GRIPS and "overload" not in labels else "doubtful"


def verdict_sentence(
    scalars: Mapping[str, SourcedValue], labels: Mapping[str, str]
) -> tuple[str, Message]:
    """Return the verdict and what it means for steps, both empty where there is none."""
    word = verdict(scalars, labels)
    slip = scalars.get("slip_probability", SourcedValue(None, reason="not asked for"))
    if slip.value is None:
        return "", NOTHING
    low, high = map(probability_text, slip.interval or (slip.value, slip.value))
    steps = Message("from {low} to {high} of steps may slip", low=low, high=high)
    if word == "grips":
        steps = Message("fewer than 1 of {count:.0f} steps slips", count=1 / GRIPS)
    elif word == "slips":
        steps = Message("more than 1 of {count:.0f} steps slips", count=1 / SLIPS)
    if slip.note:
        return word, Message("{steps} (95 % interval, extrapolated)", steps=steps)
    return word, Message("{steps} (95 % interval)", steps=steps)


def headline(
    status: Status, scalars: Mapping[str, SourcedValue], labels: Mapping[str, str]
) -> tuple[Message, ...]:
    """Return the answer in a few sentences: COF and what spoils it, film, slip probability.

    Parameters:
        status: Of the result.
        scalars: Its numbers by name.
        labels: Its sentences by name.
    """
    if not status.usable:
        return (no_result(status, labels.get("no_result", "")),)
    cof = scalars["cof"]
    parts: list[str] = [value_text("cof", cof)]
    if cof.uncertainty is not None:
        basis = labels.get("cof_spread_basis") or Message("of friction law and film load")
        parts.append(
            Message("95 % interval {basis}", basis=basis)
            if shows_interval("cof", cof)
            else Message("one standard deviation {basis}", basis=basis)
        )
    if "cof_tread_position" in scalars:
        parts.append(Message("mean over positions of the tread"))
    if "instant" in labels:
        parts.append(labels["instant"])
    sentences = [Message("Available COF {parts}.", parts=parts), *steadiness(scalars)]
    if "overload" in labels:
        sentences.append(Message("{overload:capital}.", overload=labels["overload"]))
    sentences.append(friction_limit(scalars).sentence(labels.get("regime", "")))
    slip = scalars.get("slip_probability")
    if slip is not None and slip.value is not None:
        values = {"value": value_text("slip_probability", slip)}
        sentences.append(
            Message("Slip probability {value}, extrapolated.", **values)
            if slip.note
            else Message("Slip probability {value}.", **values)
        )
    return tuple(sentences)


def no_result(status: Status, reason: str = "") -> Message:
    """Return that there is no result, why, and what to do."""
    values = {"status": str(status), "remedy": status.remedy}
    if not reason:
        return Message("No result: {status}. {remedy}", **values)
    return Message("No result: {status} ({reason}). {remedy}", **values, reason=reason)


def steadiness(scalars: Mapping[str, SourcedValue]) -> tuple[Message, ...]:
    """Return what to say of an answer that is not that of steady sliding, or only of a long one."""
    if "later_cof" in scalars:
        time, film = (
            quantity_text(_number(scalars, f"later_{name}"), unit)
            for name, unit in (("time", "s"), ("fluid_load", "N"))
        )
        cof = value_text("later_cof", scalars["later_cof"])
        values = {"time": time, "cof": cof, "film": film}
        return (
            Message(
                "Not steady: held on to {time} COF is {cof}, the load on the film {film}.", **values
            ),
        )
    slide = scalars.get("steady_slide")
    if slide is None or float(slide) <= LONGEST_SLIDE:
        return ()
    way = quantity_text(float(slide), "m")
    return (
        Message("Sliding is steady only after {way}, further than a slip tester slides.", way=way),
    )


def cautions(
    status: Status,
    scalars: Mapping[str, SourcedValue],
    breaches: Sequence[Remark],
    assumptions: Sequence[Remark],
    slip_model: str = "",
    labels: Mapping[str, str] = MappingProxyType({}),
) -> tuple[str, ...]:
    """Return why the numbers of a usable result may not be trusted; ``slip_model`` is its name."""
    if not status.usable:
        return ()
    reasons = [labels[name] for name in CAUTIONS if name in labels]
    slip = scalars.get("slip_probability")
    if slip is not None and slip.note:
        reasons.append(Message("Slip probability {note}.", note=slip.note))
    if others := [name for name in subjects(breaches) if name != slip_model]:
        reasons.append(beyond_tests(others))
    sections = subjects(assumptions)
    left_out = {}
    if "film_spread_basis" not in labels:
        left_out["interface"] = Message("interface roughness")
    if "film_heel_basis" not in labels:
        left_out["shoe.heel.profile"] = Message("heel shape")
    inputs = [text for name, text in left_out.items() if name in sections]
    mind = inputs or "film_inlet" in labels
    filmed = bool(mind) and friction_limit(scalars).kind in ("film", "shear")
    if inputs and filmed:
        reasons.append(
            Message(
                "The film load depends on assumed values ({inputs: and }) that its interval leaves "
                "out; underfoot sensitivity gives their effect.",
                inputs=inputs,
            )
        )
    if "film_inlet" in labels and filmed:
        reasons.append(labels["film_inlet"])
    return tuple(reasons)


def beyond_tests(models: Iterable[str]) -> Message:
    """Return in plain words which parts of the answer go beyond what their models were tested for.

    The technical name of each model stands in brackets, as the list of ranges has it.
    """
    named = [
        Message("{part} ({model})", part=PARTS[name], model=name) if name in PARTS else name
        for name in models
    ]
    return Message("Beyond what was tested: {named}.", named=named)


def in_words(breaches: Iterable[Remark]) -> tuple[str, ...]:
    """Return breaches of tested ranges that begin with what their model is for; its name ends them.

    A model that ``PARTS`` does not know keeps its name in front.
    """
    lines: list[Message] = []
    for breach in breaches:
        part = PARTS.get(breach.about, "")
        named = Message(
            "{part:capital}: {what} [{model}]", part=part, what=breach.what, model=breach.about
        )
        lines.append(named if part else breach)
    return tuple(lines)


def table(scalars: Mapping[str, SourcedValue], labels: Mapping[str, str]) -> Table:
    """Return label, value with uncertainty, and remark of every quantity of a result."""
    rows: list[tuple[str, str, str]] = []
    for name, (label, remark) in QUANTITIES.items():
        scalar = scalars.get(name)
        if scalar is None:
            continue
        interval = interval_text(name, scalar)
        value = value_text(name, scalar)
        if interval and interval not in value:
            remark = f"95 %: {interval}"
        elif not interval:
            remark = scalar.note or _load_share(scalars, name) or remark
        rows.append((label, value, remark))
        if name == "cof_viscous" and "regime" in labels:
            rows.append(("Lubrication regime", labels["regime"], labels.get("regime_rule", "")))
    return Table("Results", ("Quantity", "Value", "Remark"), rows)


def drainage_table(fields: Fields) -> Table:
    """Return the lugs that bear most of the film, and the way out for their fluid."""
    names = ("share", "load", "x", "y", "way", "side", "groove", "groove_side", "relief")
    lugs = zip(*(fields[f"lug_{name}"].values for name in names), strict=True)
    rows = [
        (
            Message("{x} from the rear, {y}", x=quantity_text(x, "m"), y=across_text(y)),
            Message("{load}, {share}", load=quantity_text(load, "N"), share=percent(share)),
            Message("{way} {to}", way=quantity_text(way, "m"), to=TO_SIDES[int(side)]),
            Message(
                "{groove} {to}, {relief} of it",
                groove=quantity_text(groove, "m"), to=TO_SIDES[int(to)], relief=percent(relief),
            ),
        )
        for share, load, x, y, way, side, groove, to, relief in islice(lugs, LUGS_SHOWN)
        if share >= MATTERS
    ]  # fmt: skip
    columns = ("Lug", "Load on its film", "Way out", "Best groove, relief")
    return Table("Drainage of lugs", columns, rows, "lug")


def notes(labels: Mapping[str, str]) -> tuple[str, ...]:
    """Return the remarks of a result that are sentences, with their title in front."""
    return tuple(Remark.of(title, labels[key]) for key, title in LABELS.items() if key in labels)


def ranked_assumptions(assumptions: Sequence[Remark]) -> list[Remark]:
    """Return the assumptions, those of the sections that move the film load most first.

    The first line of each section precedes its further lines, so that the top of the list names
    different parts of the case.
    """
    sections = [line.about or line for line in assumptions]
    order = {name: number for number, name in enumerate(DECISIVE)}

    def place(k: int) -> tuple[int, bool, int, int]:
        name = sections[k]
        return sections[:k].count(name), name not in order, order.get(name, 0), k

    return [assumptions[k] for k in sorted(range(len(sections)), key=place)]


def _load_share(scalars: Mapping[str, SourcedValue], name: str) -> str:
    if name not in ("fluid_load", "fluid_load_sensor"):
        return ""
    load, total = scalars[name].value, scalars["normal_force"].value
    if load is None or not total:
        return NOTHING
    return Message("{share} of the load", share=percent(load / total))


def _number(scalars: Mapping[str, SourcedValue], name: str) -> float:
    value = scalars[name].value
    return math.nan if value is None else value
