"""Coefficient of friction of a sole with its uncertainty, by sampling the law's inputs."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import SourcedValue
from underfoot.core.arrays import Array, Mask
from underfoot.core.remark import NOTHING, Message

from .law import SMALLEST_FILM, FrictionLaw, FrictionParts
from .propagation import Propagated, propagate_spread

PARTS = ("adhesion", "hysteresis", "viscous")
CLASSES = 64
"""Classes of contact pressure that stand for the cells under the sole in the draws."""
SAMPLES = 500
MODEL = "model"
FILM, SUCTION, TREAD = "film load", "suction", "tread"
ROUGH = GAP, FLOW, LEAK = "gap", "flow", "leak"
"""Parts of the error of the load on the film that the rough contact makes: its gap, its flow, or
the roughness that lets fluid leak."""
SHEAR, ZERO = "film shear", "zero"
APART = (MODEL, FILM, *ROUGH, SUCTION, TREAD, SHEAR, ZERO)
"""What is drawn beside the inputs of the law."""
VACUUM = 1e5
HIGHEST = 3.0
"""COF that no error of the tread leads beyond, where the law has none of its own."""


@dataclass(frozen=True, slots=True, eq=False)
class LawDraws:
    """What is drawn of a sole whatever its film carries: (samples,) each, or one number for all.

    Attributes:
        adhesion, hysteresis, viscous: Draws of the law over its value, each part by itself.
        model: Error of the law, added to the friction coefficient of the contact.
        suction: Factor on the contact friction.
        odds: Error of ln F / (W - F), F the load on the film, W the whole.
        zero: Added to COF by the film.
        tread: Error of ln COF.
        highest: COF that no error of the tread leads beyond.
    """

    adhesion: Array
    hysteresis: Array
    viscous: Array
    model: Array | float = 0.0
    suction: Array | float = 1.0
    odds: Array | float = 0.0
    zero: Array | float = 0.0
    tread: Array | float = 0.0
    highest: float = HIGHEST

    def at(
        self,
        contact: Array | float,
        *,
        adhesion: Array | float,
        hysteresis: Array | float,
        viscous: Array | float,
        more_odds: Array | float = 0.0,
    ) -> dict[str, Array]:
        """Return draws of COF, of its parts and of ``contact``, (samples,) each, by name.

        Loads are drawn, and each newton of the contact has the friction that the law draws for it:
        no draw has more contact than the whole load.

        Parameters:
            contact: Share of the load on the contact as computed, 0 to 1.
            adhesion, hysteresis, viscous: COF by each as computed at that share.
            more_odds: What is to be added to ``odds``.
        """
        film = 1.0 - np.asarray(contact)
        onto = 1.0 / (contact + film * np.exp(self.odds + more_odds))
        slow = hysteresis * self.hysteresis
        solid = np.maximum(adhesion * self.adhesion + slow + self.model * contact, 0.0)
        solid, slow = (each * onto * self.suction for each in (solid, slow))
        slow = np.minimum(slow, solid)
        shear = np.maximum(viscous * self.viscous + self.zero, 0.0)
        most = np.maximum(self.highest / np.maximum(solid + shear, 1e-9), 1.0)
        factor = np.minimum(np.exp(self.tread), most)
        parts = {"adhesion": solid - slow, "hysteresis": slow, "viscous": shear}
        drawn = {"cof": solid + shear, **parts}
        drawn = {name: each * factor for name, each in drawn.items()}
        return {**drawn, "contact": contact * onto}


@dataclass(frozen=True, slots=True, eq=False)
class SampledCof:
    """Draws of COF and of its parts, each (samples,), and what they rest on.

    ``share``: part of the variance of COF that goes with each input ("model": the law's own error),
    squared correlations over their sum, 1. ``left_out``: inputs taken as exact because their spread
    is not known. ``contact``: share of the load on the contact in each draw. ``law``: what was
    drawn, for other loads.
    """

    cof: Array
    adhesion: Array
    hysteresis: Array
    viscous: Array
    share: Mapping[str, float]
    left_out: tuple[str, ...]
    confidence: float
    seed: int
    contact: Array
    law: LawDraws

    def sourced_value(self, name: str, value: SourcedValue) -> SourcedValue:
        """Return ``value`` with the standard deviation and the interval of the draws ``name``."""
        draws = getattr(self, name)
        if np.std(draws) <= 1e-9 * np.abs(draws).max(initial=0.0):
            exact = self.left_out or Message("what it depends on")
            why = Message("{exact} came without a standard deviation", exact=exact)
            return replace(value, reason=why)
        tail = 0.5 * (1 - self.confidence)
        low, high = np.quantile(draws, [tail, 1 - tail])
        return replace(
            value,
            uncertainty=float(np.std(draws, ddof=1)),
            interval=(float(low), float(high)),
            reason=NOTHING,
        )


def sampled_cof(
    law: FrictionLaw,
    contact_pressure: ArrayLike,
    fluid_pressure: ArrayLike,
    film_thickness: ArrayLike,
    *,
    speed: float,
    wet: ArrayLike | None = None,
    area: Array | float = 1.0,
    film_area: Array | float = 1.0,
    fluid_inputs: Mapping[str, SourcedValue] | None = None,
    film_error: Array | None = None,
    rough_errors: Mapping[str, Array] | None = None,
    tread_error: Array | None = None,
    stated: Mapping[str, Mapping[str, Array]] | None = None,
    film_shear: Array | None = None,
    zero: Array | None = None,
    contact_factor: ArrayLike = 1.0,
    suction: tuple[SourcedValue, float] | None = None,
    confidence: float = 0.95,
    samples: int = SAMPLES,
    seed: int = 0,
) -> SampledCof | None:
    """Return draws of Eq. (1): the inputs of the law within their spreads, and the law's own error.

    Contact and film stay as they were computed, but for the load that the film carries: the
    logarithm of its odds F / (W - F) is off by ``film_error``, and the contact carries the rest in
    the same distribution. COF is off by the factor exp(``tread_error``), not beyond what the law
    calls its highest. The law's own error is one normal draw for the whole sole, in proportion to
    the load on the contact; contact friction is not drawn below 0. Cells are put into classes of
    equal pressure (with their film); what the classes miss of each part is made up for by a factor.

    Parameters:
        contact_pressure, fluid_pressure, film_thickness, wet, area, film_area: (nx, ny) Pa, Pa, m,
            where the film is and what cells stand for, as ``cof`` takes them.
        speed: m/s.
        fluid_inputs: "viscosity" (Pa s) with its standard deviation; where it has none it counts as
            exact.
        film_error: Draws (samples,) of the error of ln F / (W - F); None takes the load as exact.
        rough_errors: Those of ``ROUGH``: draws (samples,) of what each adds to the error of the
            load on the film.
        tread_error: Draws (samples,) of the error of ln COF by the tread; None counts none.
        stated: Draws (samples,) of inputs that contact and film were solved for, by input and name:
            "adhesion" and "hysteresis" of ln of what a newton of the contact has of each,
            "viscous" of that of the film's shear, "odds" of what is added to ln F / (W - F),
            "normal" of the input itself. No newton gets more than the law's highest COF by them.
        film_shear: Draws (samples,) of ln of the film's shear stress over that computed.
        zero: Draws (samples,) of what a reading of COF under a film is off by.
        contact_factor: On the contact friction of the law, (nx, ny), 1.
        suction: Highest suction behind edges (Pa, drawn between 0 and that of a vacuum), and the
            share of the contact friction that its value makes.

    Returns None when one of the law's own inputs has no standard deviation, or when nothing has
    one: an interval of the rest alone would be too narrow.
    """
    stated = stated or {}
    beyond = {name: SourcedValue(0.0, "1", "", 1.0) for name in stated}
    inputs = _inputs(law, {**(fluid_inputs or {}), **beyond})
    if inputs is None:
        return None
    joint = {
        **_joint(law, samples, seed),
        **{name: each["normal"] for name, each in stated.items()},
    }
    highest = getattr(law, "highest", HIGHEST)
    beside = {FILM: film_error, SHEAR: film_shear, ZERO: zero, **(rough_errors or {})}
    beside = beside if np.any(fluid_pressure) else {}
    for name, draws in {**beside, TREAD: tread_error}.items():
        if draws is not None and draws.any():
            inputs[name] = SourcedValue(0.0, "1", "", float(np.std(draws)))
            joint[name] = draws
    pull, pull_share = suction or (None, 0.0)
    if pull is not None and pull.value and pull_share:
        inputs[SUCTION] = pull
    contact = np.asarray(contact_pressure, dtype=float)
    film = np.broadcast_to(np.asarray(film_thickness, dtype=float), contact.shape)
    mask = np.ones(contact.shape, bool) if wet is None else np.asarray(wet, dtype=bool)
    cells = np.broadcast_to(np.asarray(area, dtype=float), contact.shape)
    solid_load = float((contact * cells).sum())
    load = solid_load + float((np.asarray(fluid_pressure) * film_area).sum())
    carried = solid_load / load
    pressure, gap, counts, wet_counts = _classes(contact, film, mask, cells)

    def sums(shear: FrictionParts, solid: Any, fluid: Any) -> Array:
        weighted = ((shear.adhesion, solid), (shear.hysteresis, solid), (shear.viscous, fluid))
        return np.array([np.vdot(part, weight) for part, weight in weighted]) / load

    exact = sums(law(contact, speed, film), contact_factor * cells, mask * cells)
    coarse = sums(law(pressure, speed, gap), counts, wet_counts)
    factor = np.where(coarse > 0, exact / np.where(coarse > 0, coarse, 1.0), 1.0)

    def parts(values: Mapping[str, float]) -> Array:
        drawn = law.at({k: v for k, v in values.items() if k not in (*APART, *stated)})
        return factor * sums(drawn(pressure, speed, gap), counts, wet_counts)

    options = {"samples": samples, "seed": seed, "shares": False}
    spread = propagate_spread(parts, inputs, confidence=confidence, joint=joint, **options)
    drawn, suctions = spread.drawn, 1.0
    if SUCTION in drawn and pull is not None and pull.value:
        ratio = np.clip(drawn[SUCTION], 0.0, VACUUM) / pull.value
        suctions = 1.0 + pull_share * (ratio - 1.0)
    of_law = np.where(exact > 0, spread.draws / np.where(exact > 0, exact, 1.0), 1.0).T
    of_law[2] *= np.exp(drawn.get(SHEAR, 0.0))
    if stated:
        of_law *= np.exp(
            np.sum([[each[name] for name in PARTS] for each in stated.values()], axis=0)
        )
        newton, most = exact[:2] @ of_law[:2], max(highest * carried, float(exact[:2].sum()))
        of_law[:2] /= np.maximum(newton / max(most, 1e-30), 1.0)
    draws = LawDraws(
        *of_law,
        model=drawn.get(MODEL, 0.0),
        suction=suctions,
        odds=sum(drawn.get(name, 0.0) for name in (FILM, *ROUGH))
        + sum(each["odds"] for each in stated.values()),
        zero=drawn.get(ZERO, 0.0),
        tread=drawn.get(TREAD, 0.0),
        highest=highest,
    )
    here = draws.at(carried, **dict(zip(PARTS, map(float, exact), strict=True)))
    return SampledCof(
        **here,
        share=_shares(here["cof"], drawn),
        left_out=tuple(name for name in spread.left_out if SHEAR not in inputs),
        confidence=confidence,
        seed=seed,
        law=draws,
    )


def sampled_points(
    law: FrictionLaw,
    *,
    contact_pressure: ArrayLike,
    speed: ArrayLike,
    film_thickness: ArrayLike,
    fluid_inputs: Mapping[str, SourcedValue] | None = None,
    samples: int = SAMPLES,
    seed: int = 0,
) -> Propagated | None:
    """Return COF at operating points that carry all their load on the contact, with its spread.

    Pressure (Pa), speed (m/s) and film (m) broadcast; otherwise as ``sampled_cof``: one draw holds
    for all points.

    Parameters:
        law: Friction law.
        contact_pressure: Pa.
        speed: Of sliding, m/s.
        film_thickness: m.
        fluid_inputs: "viscosity" (Pa s) with its standard deviation.
        samples: Number of draws.
        seed: Of the random numbers: equal seeds give equal draws.
    """
    inputs = _inputs(law, fluid_inputs)
    if inputs is None:
        return None
    pressure = np.asarray(contact_pressure, dtype=float)

    def points(values: Mapping[str, float]) -> Array:
        drawn = law.at({k: v for k, v in values.items() if k != MODEL})
        shear = drawn(pressure, speed, film_thickness)
        solid = (shear.adhesion + shear.hysteresis) / pressure + values.get(MODEL, 0.0)
        return np.maximum(solid, 0.0) + shear.viscous / pressure

    joint = _joint(law, samples, seed)
    return propagate_spread(points, inputs, samples=samples, seed=seed, shares=False, joint=joint)


def _inputs(
    law: FrictionLaw, fluid_inputs: Mapping[str, SourcedValue] | None
) -> dict[str, SourcedValue] | None:
    """Return what is drawn: inputs of law and fluid and the law's error; None without spreads."""
    if any(value.uncertainty is None for value in law.inputs.values()):
        return None
    inputs = {**law.inputs, **(fluid_inputs or {})}
    if law.error_of_model:
        inputs[MODEL] = SourcedValue(0.0, "1", law.source, law.error_of_model)
    return inputs if any(value.uncertainty for value in inputs.values()) else None


def _joint(law: FrictionLaw, samples: int, seed: int) -> Mapping[str, Array]:
    """Return joint draws of inputs that depend on each other, where the law has such."""
    draws: Any = getattr(law, "joint_draws", None)
    return {} if draws is None else draws(samples, seed)


def _shares(cof: Array, drawn: Mapping[str, Array]) -> dict[str, float]:
    if np.std(cof) <= 1e-9 * np.abs(cof).max(initial=0.0):
        return {}
    squares = {
        name: float(np.corrcoef(draws, cof)[0, 1]) ** 2
        for name, draws in drawn.items()
        if np.std(draws) > 0
    }
    total = sum(squares.values())
    return {name: square / total for name, square in squares.items()} if total > 0 else {}


def _classes(contact: Array, film: Array, wet: Mask, cells: Array) -> tuple[Array, ...]:
    """Return pressure, film, cells (as many as ``cells`` says) and wet cells of each class.

    Pressure is the mean of a class; the film is such that eta V / h has the class's mean over its
    wet cells.
    """
    order = np.lexsort((film.ravel(), contact.ravel()))
    groups = np.array_split(order, min(CLASSES, order.size))
    starts = np.cumsum([0, *(group.size for group in groups[:-1])])

    def per_class(values: Array | float) -> Array:
        return np.add.reduceat((values * cells).ravel()[order], starts)

    counts, wet_counts = per_class(1.0), per_class(wet.astype(float))
    thin = per_class(np.where(wet, 1.0 / np.maximum(film, SMALLEST_FILM), 0.0))
    gap = np.where(thin > 0, wet_counts / np.where(thin > 0, thin, 1.0), 1.0)
    return per_class(contact) / counts, gap, counts, wet_counts
