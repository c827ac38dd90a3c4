"""Numbers of a run over the positions of its tread or its shoe angles: means, and draws of them."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

import numpy as np

from underfoot.case import Case
from underfoot.core import SourcedValue, content_hash
from underfoot.core.arrays import Array
from underfoot.core.remark import NOTHING, Amount, Message, Remark
from underfoot.friction import FrictionCoefficients, SampledCof
from underfoot.friction.propagation import normal_draws

ANGLE_BAND = math.radians(1)
"""The shoe angle lies evenly within this of the case's, rad; assumed: how well an upper is held."""
ANGLE_DEVIATION = ANGLE_BAND / math.sqrt(3)
"""Standard deviation of that band, rad."""
FACET_DEVIATION = math.radians(1)
"""Standard deviation of the angle of a heel's bevel that nobody measured, rad; assumed: ground or
worn by hand, as ``underfoot sensitivity`` varies it."""
GOLDEN = (math.sqrt(5) - 1) / 2
LOADS = ("fluid_load", "contact_load")
ON_CONTACT = ("cof_adhesion", "cof_hysteresis")
COF_PARTS = (*ON_CONTACT, "cof_viscous")
FAINT = 1e-6
"""Share of the load that film and contact have at least where the odds of one are asked for."""


def log_film_odds(film: Array | float, contact: Array | float) -> Array:
    """Return ln F / (W - F) of loads F on the film and W - F on the contact, N."""
    least = FAINT * (film + contact)
    return np.log(np.maximum(film, least) / np.maximum(contact, least))


@dataclass(frozen=True, slots=True)
class TreadPlace:
    """Where a tread lies: its pattern shifted by (x, y), m, and turned by ``yaw``, rad.

    ``turn``, rad, is added to the shoe angle; ``finer``: how many times the steps in time.
    """

    shift: tuple[float, float] = (0.0, 0.0)
    turn: float = 0.0
    yaw: float = 0.0
    finer: int = 1


@dataclass(frozen=True, slots=True)
class UncertainBevel:
    """The bevel of a heel whose angle is not exact: steeper, the film sees the shoe toe down.

    Attributes:
        deviation: Standard deviation of its angle, rad.
        assumed: Whether that is assumed, as where nobody measured the angle.
        heel: Name of the heel: its draws are one in all results.
        seed: Of the draws.
    """

    deviation: float
    assumed: bool
    heel: str
    seed: int

    @classmethod
    def of(cls, case: Case) -> "UncertainBevel | None":
        """Return that of a case; None where the angle counts as exact or there is no bevel."""
        path = "shoe.heel.profile.angle"
        if path in case.idle_paths or not case.value(path):
            return None
        angle = case.sourced_value(path)
        deviation = angle.uncertainty or FACET_DEVIATION * angle.assumed
        name, seed = content_hash(case.named_values("shoe.heel.")), case.numerics.seed
        return cls(deviation, not angle.uncertainty, name, seed) if deviation else None

    def turns(self, count: int) -> Array:
        """Return by how much the shoe is turned against its bevel in each draw, (count,), rad."""
        return self.deviation * normal_draws(self.seed, f"bevel of heel {self.heel}", count)

    @property
    def message(self) -> Message:
        """What is drawn of it."""
        return Message("angle ±{angle} deg, drawn", angle=Amount(math.degrees(self.deviation)))


@dataclass(frozen=True, slots=True)
class TreadPositions:
    """Numbers of a run at some positions of the tread.

    Attributes:
        places: Of the pattern and the shoe.
        values: Name of a result's scalar: its value at each place, SI.
        left_out: Number of positions that did not converge.
        at_own_place: The scalars at the case's own place, on the grid of the run.
        between: Name of a scalar: what the difference of two grids leaves unknown of its mean.
        by_angle: Name of a scalar: what ``ANGLE_DEVIATION``, toe up, adds to its value at the
            case's own place; empty where that is not known or in the values.
        film_by_angle: What it adds to ln F / (W - F), F the load on the film of W.
        bevel: Of the heel, where its angle is not exact.
        further: Scalars by name at turns (rad) that only such a bevel reaches; not in the means.
        uncompared: Cells, m, where no other grid was compared with; else 0.
        in_time: Of a motion that ends: the scalars at one place on the quick grid, with the steps
            of the run and with twice as many; empty of steady sliding and where one is missing.
    """

    origin: ClassVar[str] = "tread_position"
    held: ClassVar[str] = "position of the tread"
    several: ClassVar[str] = "positions of the tread"

    places: tuple[TreadPlace, ...]
    values: Mapping[str, Array]
    left_out: int
    at_own_place: Mapping[str, float]
    between: Mapping[str, float] = field(default_factory=dict, kw_only=True)
    by_angle: Mapping[str, float] = field(default_factory=dict, kw_only=True)
    film_by_angle: float = field(default=0.0, kw_only=True)
    bevel: UncertainBevel | None = field(default=None, kw_only=True)
    further: Mapping[float, Mapping[str, float]] = field(default_factory=dict, kw_only=True)
    uncompared: float = field(default=0.0, kw_only=True)
    in_time: tuple[Mapping[str, float], ...] = field(default=(), kw_only=True)

    def answer(self, name: str) -> float:
        """Return the scalar of the result: its mean over the places."""
        return float(self.values[name].mean())

    def draw_scalar(self, name: str, count: int) -> Array:
        """Return the scalar (count,) at each place in turn, drawn over the angle and the bevel.

        The angle moves the load on the film by its odds, and adds to other numbers.
        """
        if name != "fluid_load":
            return self._beside_film(name, count)
        film, contact = (self._each(load, count) for load in LOADS)
        more = film * np.exp(self._more_odds(count))
        return more * (film + contact) / (more + contact)

    def _each(self, name: str, count: int) -> Array:
        """Return the scalar (count,) at each place in turn, at the angle of the case."""
        return self.values[name][np.arange(count) % len(self.places)]

    def _turns(self, count: int, *, bevel: bool = True) -> Array:
        """Return turns (count,) evenly over the band of the angle, in its standard deviations.

        ``bevel``: with that of the heel, where it was not measured.
        """
        turns = math.sqrt(3) * (2 * np.mod(GOLDEN * np.arange(count), 1) - 1)
        if self.bevel and bevel:
            turns = turns + self.bevel.turns(count) / ANGLE_DEVIATION
        return turns

    def _more_odds(self, count: int, *, bevel: bool = True) -> Array:
        """Return what the angle adds to ln F / (W - F) of the places in turn, (count,)."""
        return self.film_by_angle * self._turns(count, bevel=bevel)

    def _beside_film(self, name: str, count: int) -> Array:
        """Return draws (count,) of a scalar other than the load on the film."""
        more = self.by_angle.get(name, 0.0) * self._turns(count)
        return np.maximum(self._each(name, count) + more, 0)

    def friction(
        self, friction: FrictionCoefficients, sampled: SampledCof | None
    ) -> tuple[FrictionCoefficients, SampledCof | None]:
        """Return COF and its draws over the positions, which the draws take in turn.

        Each draw of the law meets the contact and the film of a place, turned by an angle.
        """
        values = {name: values for name, values in self.values.items() if name.startswith("cof")}
        new = {name: replace(getattr(friction, name), value=self.answer(name)) for name in values}
        if sampled is not None:
            count = sampled.cof.size
            film, contact = (self._each(load, count) for load in LOADS)
            parts = {name.removeprefix("cof_"): self._each(name, count) for name in COF_PARTS}
            law = sampled.law

            def draw_law(*, bevel: bool) -> dict[str, Array]:
                more_odds = self._more_odds(count, bevel=bevel)
                return law.at(contact / (film + contact), **parts, more_odds=more_odds)

            draws = draw_law(bevel=True)
            more = {self.origin: float(np.var(values["cof"]))}
            if self.by_angle:
                more["shoe_angle"] = self.by_angle["cof"] ** 2
            if self.bevel:
                more["bevel"] = float(np.var(draws["cof"] - draw_law(bevel=False)["cof"]))
            law_variance = float(np.var(sampled.cof))
            whole = law_variance + sum(more.values())
            share = {name: each * law_variance / whole for name, each in sampled.share.items()}
            share |= {name: each / whole for name, each in more.items()}
            sampled = replace(sampled, share=share, **draws)
            for name, value in new.items():
                if value.uncertainty is not None:  # what the law leaves open stays open
                    new[name] = sampled.sourced_value(name.removeprefix("cof_"), value)
            note = Message("spread of the friction law, its inputs and the {held}", held=self.held)
            new["cof"] = replace(new["cof"], note=note)
        load = self.answer("fluid_load")
        force = self.answer("cof") * friction.normal_force
        return replace(friction, **new, fluid_load=load, friction_force=force), sampled

    def average_numbers(self, numbers: Mapping[str, SourcedValue]) -> dict[str, SourcedValue]:
        """Return the numbers with means over the positions, and the spread of COF over them."""
        means = dict(numbers)
        if len(self.places) == 1:
            return means
        for name in self.values:
            if name in numbers and not name.startswith("cof"):
                means[name] = replace(numbers[name], value=self.answer(name))
        means["fluid_load"] = replace(
            means["fluid_load"], note=self._range_over_places("fluid_load", "N")
        )
        means[f"cof_{self.origin}"] = SourcedValue(
            float(np.std(self.values["cof"])),
            source=f"contact and film at another {self.held}",
            reason="itself a standard deviation",
            note=self._range_over_places("cof"),
        )
        if self.by_angle:
            means["cof_shoe_angle"] = SourcedValue(
                abs(self.by_angle["cof"]),
                source="contact and film with the shoe turned",
                reason="itself a standard deviation",
            )
        return means

    def labels(self) -> dict[str, str]:
        """Return what was averaged in words."""
        failed, count, told = NOTHING, self.left_out, {}
        if count:
            failed = Message("; {count} did not converge and are left out", count=count)
            told["positions_left_out"] = Message(
                "{count} of {all} positions of the tread did not converge. Most such positions "
                "float: COF may be lower and the load on the film higher than the means over the "
                "others.",
                count=count, all=count + len(self.places),
            )  # fmt: skip
        told |= self._bevel_label()
        if len(self.places) == 1:
            alone = Message(
                "as the case describes it; {count} did not converge and are left out of the "
                "average",
                count=count,
            )
            return {"tread_position": alone, **told}
        if not self.by_angle:
            told["angle_as_exact"] = Message(
                "The shoe could not be solved turned: its angle counts as exact, and the interval "
                "is too narrow."
            )
        else:
            told["shoe_angle"] = Message(
                "{up} deg toe up, one standard deviation of it, moves COF by {cof} and the load "
                "on the film by {film}",
                up=Amount(math.degrees(ANGLE_DEVIATION)), cof=Amount(self.by_angle["cof"]),
                film=Amount(self.by_angle["fluid_load"], "N"),
            )  # fmt: skip
        average = Message(
            "COF {range}, load on the film {loads} over {count} positions of the tread. Numbers "
            "are means over them; maps, histories and drainage show the position that the case "
            "describes (COF {cof}, {load} on the film){failed}",
            **self._ranges(), count=len(self.places), failed=failed,
        )  # fmt: skip
        return {"tread_position": average, **told}

    def _ranges(self) -> dict[str, Any]:
        """Return the ranges of COF and film load over all places, and both at the case's own."""
        cof, load = self.at_own_place["cof"], self.at_own_place["fluid_load"]
        values = {"range": self._range("cof"), "loads": self._range("fluid_load", "N")}
        return {**values, "cof": Amount(cof), "load": Amount(load, "N")}

    def _bevel_label(self) -> dict[str, str]:
        """Return that the bevel of the heel is drawn; empty where its angle counts as exact."""
        return {"heel_bevel": self.bevel.message} if self.bevel else {}

    def assumptions(self) -> tuple[Remark, ...]:
        """Return the band of the shoe angle, where it was used, and that of the heel's bevel."""
        angle = bool(self.by_angle) or any(place.turn for place in self.places)
        yaw = any(place.yaw for place in self.places)
        bevel = bool(self.bevel and self.bevel.assumed)
        return (
            *([Remark.of("shoe.heel.profile", self.bevel.message)] if self.bevel and bevel else ()),
            *(Remark("motion.shoe_angle", "±1 deg"),) * angle,
            *(Remark("shoe.tread", "turned ±1 deg against the heel's corner"),) * yaw,
        )

    def fields(self) -> dict[str, Any]:
        """Return the variables of a data set: where the positions are, COF and load there."""

        def at(values: Any, unit: str, name: str, **more: float) -> tuple[str, Any, dict[str, Any]]:
            return ("tread_position", values, {"units": unit, "long_name": name, **more})

        cof, film = ({"as_described": self.at_own_place[n]} for n in ("cof", "fluid_load"))
        shift = np.array([place.shift for place in self.places])
        yaw = [place.yaw for place in self.places]
        return {
            "position_yaw": at(yaw, "rad", "turn of the tread's pattern, anticlockwise"),
            "position_shift_x": at(shift[:, 0], "m", "shift of the tread's pattern, forward"),
            "position_shift_y": at(shift[:, 1], "m", "shift of the tread's pattern, across"),
            "position_cof": at(self.values["cof"], "1", "coefficient of friction", **cof),
            "position_fluid_load": at(self.values["fluid_load"], "N", "load on the film", **film),
        }

    def _range_over_places(self, name: str, unit: str = "1") -> Message:
        return Message(
            "{range} over {count} positions of the tread",
            range=self._range(name, unit), count=len(self.places),
        )  # fmt: skip

    def _range(self, name: str, unit: str = "1") -> Message:
        values = self.values[name]
        return Message(
            "{low} to {high}", low=Amount(values.min(), unit), high=Amount(values.max(), unit)
        )


@dataclass(frozen=True, slots=True)
class ShoeAngles(TreadPositions):
    """Numbers of a run of a sole without lugs at its own shoe angle and beside it."""

    origin = "shoe_angle"
    held = "shoe angle"
    several = "shoe angles"

    def _range_over_places(self, name: str, unit: str = "1") -> Message:
        return Message(
            "{range} over {count} shoe angles",
            range=self._range(name, unit), count=len(self.places),
        )  # fmt: skip

    def _more_odds(self, count: int, *, bevel: bool = True) -> Array:
        """Return what the bevel adds: the odds at its turn less those at the place's own."""
        if not (self.bevel and bevel):
            return np.zeros(count)
        (turns, film), (_, contact) = (self._over_angle(load) for load in LOADS)
        odds = log_film_odds(film, contact)
        before, after = (np.interp(turn, turns, odds) for turn in self._turns_beside(count))
        return after - before

    def _beside_film(self, name: str, count: int) -> Array:
        """Return the scalar (count,) at the turn of its angle and bevel."""
        if not self.bevel:
            return self._each(name, count)
        return np.interp(self._turns_beside(count)[1], *self._over_angle(name))

    def _turns_beside(self, count: int) -> tuple[Array, Array]:
        """Return the turns of the places in turn, (count,), rad, without the bevel and with it."""
        turn = np.array([place.turn for place in self.places])[np.arange(count) % len(self.places)]
        return turn, turn + (self.bevel.turns(count) if self.bevel else 0.0)

    def _over_angle(self, name: str) -> tuple[Array, Array]:
        """Return all turns that were solved, rising, rad, and the scalar there."""
        turn = np.array([*(place.turn for place in self.places), *self.further])
        values = np.array([*self.values[name], *(one[name] for one in self.further.values())])
        order = np.argsort(turn)
        return turn[order], values[order]

    def labels(self) -> dict[str, str]:
        """Return what the interval holds in words."""
        if len(self.places) == 1:
            return {}
        least, most = (math.degrees(bound([p.turn for p in self.places])) for bound in (min, max))
        average = Message(
            "COF {range}, load on the film {loads} from {least:.1f} to +{most:.1f} deg beside the "
            "case's angle. Numbers are means over them; maps and histories show the case's angle "
            "(COF {cof}, {load} on the film)",
            **self._ranges(), least=least, most=most,
        )  # fmt: skip
        return {"shoe_angle": average, **self._bevel_label()}

    def fields(self) -> dict[str, Any]:
        """Return the variables of a data set: the angles, COF and load there."""
        fields = super(ShoeAngles, self).fields()
        turn = [place.turn for place in self.places]
        about = {"units": "rad", "long_name": "change of the shoe angle"}
        kept = {
            name: each for name, each in fields.items() if "shift" not in name and "yaw" not in name
        }
        return {"position_turn": ("tread_position", turn, about), **kept}
