"""The named numbers of a result, each with its spread or the reason why there is none."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from underfoot.case import Case
from underfoot.case.quantity import one_spelling
from underfoot.core import Breach, SourcedValue, Status, content_hash, display
from underfoot.core.arrays import Array
from underfoot.core.remark import NOTHING, Amount, Message, join_lines
from underfoot.film import SHARE_LIMITS, Lubrication, lubrication_by_load_share
from underfoot.friction import FrictionCoefficients, SampledCof
from underfoot.slip import RcofPopulation, SlipModel, SlipRisk, slip_risk
from underfoot.sole_contact import SensorReading
from underfoot.sole_contact.sole_state import FAINT, SoleState
from underfoot.sole_contact.solver import SoleContact

from .sole import file_outsole
from .stated_spreads import ODDS, WHOLE, sum_of_draws

_NOT_ESTIMATED = "heel shape and interface roughness dominate; their spread is not propagated"
UNKNOWN_SPREAD = ("contact_area", "minimum_film_thickness")
CONTACT_SHARE = 1e-3
"""Contact pressure below this share of the mean pressure doesn't count as contact."""
BEARING_SHARE = 0.99
"""Share of the contact's load whose pressures decide whether the law of the asperities is left."""
INPUTS = {
    "cof_boundary": "friction at rest",
    "cof_hysteresis": "hysteresis",
    "cof_asymptote": "friction at high speed",
    "cof_adhesion": "adhesion",
    "dry_adhesion": "dry adhesion",
    "tau_hydro": "decay speed",
    "fine_roughness": "fine roughness",
    "roughness_factor": "roughness",
    "shear_strength": "shear strength",
    "film": "boundary film",
    "rest": "adhesion at rest",
    "dry": "dry-like part",
    "kappa": "fading of the dry-like part",
    "hysteresis": "hysteresis of the rough contact",
    "full_contact": "real contact area",
    "gap": "gap between the rough surfaces",
    "flow": "flow between the rough surfaces",
    "leak": "roughness that lets fluid leak",
    "laboratory": "difference between laboratories",
    "pair": "difference between pairs",
    "model": "the law itself",
    "tread_position": "position of the tread",
    "shoe_angle": "shoe angle",
    "bevel": "bevel of the heel",
    "numerical": "grid",
    "film load": "load on the film",
    "suction": "suction behind the edges of lugs",
    "tread": "the model of the tread",
    "film shear": "warmth of the film",
    "zero": "zero of the load cell",
}
"""Names of what the spread of a COF comes from, by the name in the draws of a law."""
ROUGH, SMALL = ("hysteresis", "full_contact", "gap", "flow"), 0.005
"""What the rough contact adds to the spread: told however small; others from this share on."""
FILM_ERROR = math.log(1.74)
"""Standard deviation of ln F / (W - F), F the load on the film: the model's error on the untreaded
heels of the report's slip tester (docs/studies/calibration.md), assumed of every sole. It holds the
lengths of a heel that nobody measured: theirs were none either (benchmarks heel_shapes)."""
SUCTION_SPREAD = 29e3
"""Pa: standard deviation of a suction anywhere between 0 and 100 kPa."""
ZERO = 0.005 / math.sqrt(3)
"""Standard deviation of COF by the zero of a load cell: anywhere within what the checks of a log of
a tester let pass (0.005, assumed)."""
GRID_NAMES: tuple[str, ...] = (
    "cof",
    "fluid_load",
    "fluid_load_sensor",
    "peak_fluid_pressure",
    "peak_fluid_pressure_sensor",
)
"""Numbers whose numerical error is estimated."""


def scalars(
    case: Case,
    contact: SoleContact,
    friction: FrictionCoefficients,
    sensor: SensorReading,
    sampled: SampledCof | None = None,
    model: SlipModel | None = None,
) -> tuple[dict[str, SourcedValue], SlipRisk]:
    """Return the numbers of a result by name, and the slip risk behind one of them."""
    draws = None if sampled is None else sampled.cof
    probability, risk = slip_probability(case, friction.cof, draws, model)

    def computed_value(value: float, unit: str, note: str = "") -> SourcedValue:
        return SourcedValue(
            value, unit, source="coupled contact and film", reason=_NOT_ESTIMATED, note=note
        )

    under_load = touching_cells(contact) | (contact.fluid_pressure > 0)
    thinnest = None
    if under_load.any() and case.contaminant is not None:
        thinnest = float(contact.film_thickness[under_load].min())
    numbers = {
        "cof": friction.cof,
        "cof_adhesion": friction.cof_adhesion,
        "cof_hysteresis": friction.cof_hysteresis,
        "cof_viscous": friction.cof_viscous,
        "normal_force": case.sourced_value("motion.normal_force"),
        "fluid_load": computed_value(contact.fluid_load, "N"),
        "fluid_load_sensor": sensor.load,
        "peak_fluid_pressure": computed_value(float(contact.fluid_pressure.max()), "Pa"),
        "peak_fluid_pressure_sensor": sensor.peak_pressure,
        "contact_area": computed_value(contact_area(contact), "m^2", "apparent, on the grid"),
        "minimum_film_thickness": computed_value(thinnest, "m")
        if thinnest is not None
        else SourcedValue(None, "m", reason="no fluid: no film"),
        "slip_probability": probability,
    }
    return numbers, risk


def with_film_spread(
    values: Mapping[str, SourcedValue],
    film_odds: Array,
    drawn: Callable[[str, int], Array] | None = None,
    stated: Mapping[str, Mapping[str, Array]] | None = None,
) -> dict[str, SourcedValue]:
    """Return the numbers of the film with the spread of its load, and that over places.

    ln F / (W - F), F the load on the film, W the whole, is off by ``film_odds`` (n,); what sensors
    read and peaks go with F, place by place. ``drawn`` gives a number over positions of the tread
    and shoe angles, in the order of the draws of COF. ``stated`` (``ContactFriction``) moves F by
    its odds and W, the others by what each moves beside F.
    """
    stated = stated or {}
    load, whole = values["fluid_load"].value, values["normal_force"].value
    if not load or not whole:
        return dict(values)
    loads = load if drawn is None else drawn("fluid_load", film_odds.size)
    share = np.minimum(np.asarray(loads) / whole, 1.0)
    factors = 1 / (share + (1 - share) * np.exp(-film_odds - sum_of_draws(stated, ODDS)))
    most = whole * np.exp(sum_of_draws(stated, WHOLE))
    result = dict(values)
    for name in GRID_NAMES[1:]:
        value = values[name].value
        if not value:
            continue
        draws = (value if drawn is None else drawn(name, factors.size)) * factors
        if name == "fluid_load":
            draws = np.minimum(draws * (most / whole), most)
        else:
            beside = (
                sum_of_draws(stated, name)
                - sum_of_draws(stated, "fluid_load")
                + sum_of_draws(stated, WHOLE)
            )
            draws = draws * np.exp(beside)
        low, high = (float(end) for end in np.quantile(draws, [0.025, 0.975]))
        known = values[name].uncertainty or 0.0
        own = 1.96 * known / value
        down = math.log(value / min(low, value)) if low > 0 else math.inf  # a place without film
        result[name] = replace(
            values[name],
            uncertainty=math.hypot(float(np.std(draws)), known),
            interval=(
                value * math.exp(-math.hypot(down, own)),
                value * math.exp(math.hypot(math.log(max(high, value) / value), own)),
            ),
            reason="",
        )
    return result


def with_stated(
    values: Mapping[str, SourcedValue], stated: Mapping[str, Mapping[str, Array]]
) -> dict[str, SourcedValue]:
    """Return the numbers whose own spread is not estimated with that of what the case states.

    In their note: an interval of it alone would be too narrow.
    """
    result = dict(values)
    for name in UNKNOWN_SPREAD:
        value, draws = values[name], sum_of_draws(stated, name)
        if value.value and np.std(draws) > 0:
            off = display(float(np.std(value.value * np.exp(draws))), value.unit)
            words = Message("± {off} by what the case states", off=off)
            note = join_lines([value.note, words]) if value.note else words
            result[name] = replace(value, note=note)
    return result


def required_friction(case: Case) -> RcofPopulation:
    """Return what the people of a case need on its floor, down its slope if it has one."""
    mean, sd, slope = map(case.sourced_value, ("risk.rcof_mean", "risk.rcof_sd", "floor.slope"))
    # the case itself lists an assumed required friction, so the population need not do so again
    level = RcofPopulation(
        case.risk.rcof_mean,
        case.risk.rcof_sd,
        mean.source,
        mean_deviation=mean.uncertainty or 0.0,
        sd_deviation=sd.uncertainty or 0.0,
    )
    return level.on_slope(case.floor.slope or 0.0, slope.uncertainty or 0.0)


def slope_words(case: Case) -> Message:
    """Return what a slope asks of people; nothing on the level."""
    if not case.floor.slope:
        return NOTHING
    return Message(
        "{slope} down: people who need {level:.2f} on the level need {needed:.2f} here",
        slope=Amount(case.floor.slope, "rad"), level=case.risk.rcof_mean,
        needed=required_friction(case).mean,
    )  # fmt: skip


def slip_probability(
    case: Case, acof: SourcedValue, draws: ArrayLike | None = None, model: SlipModel | None = None
) -> tuple[SourcedValue, SlipRisk]:
    """Return the slip probability at an available friction, and the risk behind it.

    ``draws`` (n,) of the friction stand for its spread; ``model`` takes the place of the case's.
    """
    mean, spread = case.sourced_value("risk.rcof_mean"), case.sourced_value("risk.rcof_sd")
    risk = slip_risk(
        acof, rcof=required_friction(case), model=model or case.risk.build(), samples=draws
    )
    probability = replace(
        risk.probability,
        assumed=risk.probability.assumed or mean.assumed or spread.assumed,
        note=join_lines(
            Message(
                "extrapolated: {quantity} = {value:.3f} is outside the tested {low:g} to {high:g}",
                quantity=breach.quantity, value=breach.low, low=breach.range.low,
                high=breach.range.high,
            )
            for breach in risk.breaches
        ),
    )  # fmt: skip
    return probability, risk


def undetermined_numbers(case: Case, status: Status) -> dict[str, SourcedValue]:
    """Return the same names without numbers: what a computation that failed may show."""
    units = {
        "fluid_load": "N",
        "fluid_load_sensor": "N",
        "peak_fluid_pressure": "Pa",
        "peak_fluid_pressure_sensor": "Pa",
        "contact_area": "m^2",
        "minimum_film_thickness": "m",
    }
    names = ("cof", "cof_adhesion", "cof_hysteresis", "cof_viscous", *units, "slip_probability")
    scalars = {name: SourcedValue(None, units.get(name, "1"), reason=str(status)) for name in names}
    return {**scalars, "normal_force": case.sourced_value("motion.normal_force")}


def regime(share: float) -> dict[str, str]:
    """Return the lubrication regime by the share of the load that the fluid carries."""
    low, high = SHARE_LIMITS
    name = lubrication_by_load_share(min(max(share, 0.0), 1.0))
    return {
        "regime": str(name)
        if name is Lubrication.FULL_FILM
        else Message("{name} lubrication", name=name),
        "regime_rule": Message(
            "by load share: below {low:g} % boundary, above {high:g} % full film",
            low=100 * low, high=100 * high,
        ),
    }  # fmt: skip


def overload_words(overload: Sequence[Breach]) -> Message:
    """Return a caution where contact pressure exceeds what the rubber can bear."""
    if not overload:
        return NOTHING
    return Message(
        "{share:.0%} of the load rests on pressures above the modulus of the rubber, which it "
        "cannot bear, and so does this COF",
        share=overload[0].high,
    )


def no_result_words(contact: SoleContact, overload: Sequence[Breach]) -> Message:
    """Return what was under the sole where a march ended without a result."""
    share = contact.fluid_load / contact.normal_force if contact.normal_force else 0.0
    where = Message(
        "the march stopped at {time}, where the film carried {share:.0%} of {load}",
        time=Amount(contact.time, "s"), share=share, load=Amount(contact.normal_force, "N"),
    )  # fmt: skip
    if overload:
        return Message(
            "lugs crushed: {share:.0%} of the load rests on pressures above the modulus of the "
            "rubber; {where}. More land, less load or a harder compound",
            share=overload[0].high, where=where,
        )  # fmt: skip
    if share > SHARE_LIMITS[1]:
        return Message("the sole floats and tips from one film to another: {where}", where=where)
    return Message(
        "film and contact change places faster than steps in time can follow: {where}", where=where
    )


def spread_origin(sampled: SampledCof | None) -> dict[str, str]:
    """Return in words which inputs the spread of COF comes from, and how it was sampled."""
    if sampled is None:
        return {}
    parts = [
        Message("{input} {share:.0%}", input=INPUTS.get(name, name), share=share)
        if share >= SMALL
        else Message("{input} below 1%", input=INPUTS[name])
        for name, share in sorted(sampled.share.items(), key=lambda one: -one[1])
        if share >= SMALL or name in ROUGH
    ]
    if sampled.left_out:
        names = [INPUTS.get(name, name) for name in sampled.left_out]
        parts.append(Message("taken as exact: {names}", names=names))
    held = Message("film thickness as computed")
    if "tread_position" in sampled.share:
        held = Message("contact and film at each position of the tread in turn")
    elif "shoe_angle" in sampled.share:
        held = Message("contact and film at each shoe angle in turn")
    drawn = {"count": sampled.cof.size, "seed": sampled.seed, "held": held}
    return {
        "cof_spread_from": Message("{parts}", parts=parts),
        "cof_spread_how": Message("{count} draws, seed {seed}; {held}", **drawn),
    }


def touching_cells(state: SoleState) -> NDArray[np.bool_]:
    """Return where the rough surfaces touch: contact pressure above 1e-3 of the mean pressure."""
    loaded = float(state.cut.area[state.total_pressure > FAINT].sum())
    mean = state.normal_force / max(loaded * state.spacing**2, state.spacing**2)
    return state.contact_pressure > CONTACT_SHARE * mean


def bearing_pressure(state: SoleState) -> float:
    """Return the contact pressure (Pa) up to which 99 % of the contact's load is borne.

    The highest is that of a few cells at the edges of lugs, and grows as the grid is refined.
    """
    pressure = state.contact_pressure.ravel()
    order = np.argsort(pressure)
    borne = np.cumsum((pressure * state.cut.area.ravel())[order])
    return float(pressure[order][np.searchsorted(borne, BEARING_SHARE * borne[-1])])


def contact_area(state: SoleState) -> float:
    """Return the apparent area on which the rough surfaces touch, m^2."""
    return float(state.cut.area[touching_cells(state)].sum()) * state.spacing**2


def sole_name(case: Case) -> str:
    """Return a name of the geometry of the case's sole: those of one share its grid's error."""
    return _sole_key(case, "heel", "tread", "sole", "wear")


def heel_name(case: Case) -> str:
    """Return a name of the case's sole without its tread: what shares the error of the film."""
    return _sole_key(case, "heel", "sole", "wear")


def _sole_key(case: Case, *parts: str) -> str:
    if case.shoe.outsole is not None:
        given, read = case.shoe.outsole, file_outsole(case)
        part = given.sha256, given.solid, given.region, given.region_length
        return content_hash([*part, read.unit, read.down, read.forward])
    if case.shoe.wear.depth == 0:  # then no wear of the sole differs from another
        case = case.replace("shoe.wear", {"edge_radius": case.shoe.wear.edge_radius})
    heads = (f"shoe.{part}." for part in parts)
    return content_hash(case.named_values(*heads, spelled=one_spelling))


def readings(contact: SoleContact, cof: float, sensor: SensorReading) -> dict[str, float]:
    """Return the numbers that errors of grid and steps in time are estimated for."""
    values = (
        *(cof, contact.fluid_load, float(sensor.load)),
        *(float(contact.fluid_pressure.max()), float(sensor.peak_pressure)),
    )
    return dict(zip(GRID_NAMES, values, strict=True))
