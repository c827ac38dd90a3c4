"""How likely a sound step looks like this one: each feature against recorded steps, both sides."""

import csv
import io
import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

from underfoot.core.remark import NOTHING, Message, Remark

from ..recording.measurement import Flag, remark

UNLIKELY = 0.002  # of sound steps lie as far out; 0.05 over some 25 features, before any fault
IMPOSSIBLE = 1e-6  # for features that mechanics bounds
_NEEDS = {
    "mass": ("body mass", "a gain of the normal force"),
    "pelvis": ("pelvis markers with a centre of pressure", "a gain or tilt of the shear"),
}


@dataclass(frozen=True, slots=True)
class Reference:
    """Distribution of one feature over recorded steps: a normal one, known from ``persons``.

    They walked at ``slowest`` to ``fastest`` (m/s), with a standard deviation of ``speed_sd``.

    ``logarithm``: of the natural logarithm. ``bound``: mechanics, not habit, sets it: a value that
    is impossible rejects the step. ``needs`` names what a recording must hold ("mass", "pelvis").
    """

    feature: str
    mean: float
    sd: float
    persons: int
    steps: int
    logarithm: bool
    bound: bool
    needs: str
    source: str
    slowest: float = 0.0
    fastest: float = math.inf
    speed_sd: float = 1.0

    def likelihood(self, value: float, speed: float | None = None) -> float:
        """Return the share of sound steps that lie as far from the mean as ``value``, two-sided.

        Student's t of a new step after ``steps`` with mean and deviation estimated from
        ``persons``, steps - 1 degrees of freedom: t = (x - mean) / (sd sqrt(1 + (1 + z^2) /
        persons)). z is how far the ``speed`` (m/s) lies beyond those recorded, over their standard
        deviation: the error of a line over the speed (whose slope is taken as 0) grows so.
        """
        from scipy.special import stdtr

        t = abs(value - self.mean) / self._deviation(speed)
        return float(2.0 * stdtr(self.steps - 1, -t))

    def limit(self, value: float, speed: float | None = None) -> float:
        """Return the value on the same side whose likelihood is ``UNLIKELY``."""
        from scipy.special import stdtrit

        t = float(stdtrit(self.steps - 1, 1.0 - 0.5 * UNLIKELY))
        return self.mean + math.copysign(t * self._deviation(speed), value - self.mean)

    def _deviation(self, speed: float | None) -> float:
        beyond = 0.0 if speed is None else max(self.slowest - speed, speed - self.fastest, 0.0)
        return self.sd * math.sqrt(1.0 + (1.0 + (beyond / self.speed_sd) ** 2) / self.persons)

    def displayed_value(self, value: float) -> float:
        """Return a value of the feature as people read it."""
        return math.exp(value) if self.logarithm else value


@cache
def references() -> tuple[Reference, ...]:
    """Return the packaged references, learned by ``python -m benchmarks.walk_screen --learn``."""
    text = (files("underfoot") / "data" / "step_features.csv").read_text(encoding="utf-8")
    rows = csv.DictReader(io.StringIO(text))
    return tuple(
        Reference(
            row["feature"], float(row["mean"]), float(row["sd"]), int(row["persons"]),
            int(row["steps"]), row["logarithm"] == "yes", row["bound"] == "yes", row["needs"],
            row["source"], *(float(row[name]) for name in ("slowest", "fastest", "speed_sd")),
        )
        for row in rows
    )  # fmt: skip


def unlikely_flags(
    features: Mapping[str, float],
    known: tuple[Reference, ...] | None = None,
    *,
    speed: float | None = None,
) -> tuple[Flag, ...]:
    """Return a caution for each feature that is unlikely, and a remark on what can't be judged.

    ``speed``: of the walk (m/s), None where it is not known.
    """
    flags = []
    known = references() if known is None else known
    for law in known:
        if law.feature not in features:
            continue
        value = features[law.feature]
        likelihood = law.likelihood(value, speed)
        if likelihood < UNLIKELY:
            rare = Message("no step in 100 000")
            if likelihood > 1e-5:
                rare = Message("1 step in {steps:.0f}", steps=1.0 / likelihood)
            text = Message(
                "{feature} {value:.3g}, where sound steps have {usual:.3g}: as far out lies {rare}",
                feature=law.feature,
                value=law.displayed_value(value),
                usual=law.displayed_value(law.mean),
                rare=rare,
            )
            limit = law.displayed_value(law.limit(value, speed))
            flags.append(
                Flag(
                    law.feature,
                    text,
                    True,
                    law.displayed_value(value),
                    limit,
                    "",
                    law.source,
                    likelihood,
                )
            )
    for need, (what, missed) in _NEEDS.items():
        if not any(
            reference.needs == need and reference.feature in features for reference in known
        ):
            flags.append(
                remark("without {what} {missed} can't be judged", what=what, missed=missed)
            )
    return tuple(flags)


def impossible(
    features: Mapping[str, float],
    known: tuple[Reference, ...] | None = None,
    *,
    speed: float | None = None,
) -> Message:
    """Return why a step at a ``speed`` (m/s) can't be one of walking, or nothing."""
    for reference in references() if known is None else known:
        value = features.get(reference.feature)
        if (
            reference.bound
            and value is not None
            and reference.likelihood(value, speed) < IMPOSSIBLE
        ):
            return Remark(
                reference.feature,
                "{value:.3g} is impossible (sound steps {usual:.3g}): gain, unit or axes of the "
                "forces?",
                value=reference.displayed_value(value),
                usual=reference.displayed_value(reference.mean),
            )
    return NOTHING


_SHEAR_GAIN = ("slope of the force line", "both impulses")
_DRIFTING_GAIN = "braking impulse"  # of the half step with the peak: no other follows it alone
_NORMAL_GAIN = ("mass by acceleration",)
_MASS_GAIN = 0.14  # logarithm, from the mean force over body weight: 0.74 to 0.97 about 0.84
_ANY_GAIN = 0.35  # logarithm, of a normal force that nothing is compared with: its units at least


def unseen_gain(
    features: Mapping[str, float],
    value: float,
    *,
    mass: bool,
    speed: float | None = None,
    known: tuple[Reference, ...] | None = None,
) -> tuple[Flag, ...]:
    """Return by how much RCOF ``value`` may be off by gains that no check would notice.

    From a sound step the gain of the shear, or of the normal force, must grow to the limit of the
    narrowest feature that follows it; both together, as squares. One that drifts within the step
    is held by the braking impulse alone: the larger bound is ``measured``. ``mass``: body mass is
    known. ``speed``: of the walk (m/s).
    """
    if not features:
        return ()
    reach = {
        reference.feature: reference.limit(reference.mean + 1e-12, speed) - reference.mean
        for reference in (references() if known is None else known)
        if reference.feature in features
    }
    shear = min((reach[name] for name in _SHEAR_GAIN if name in reach), default=_ANY_GAIN)
    judged = [reach[name] for name in _NORMAL_GAIN if name in reach]
    normal = min([*judged, _MASS_GAIN if mass else _ANY_GAIN])
    drift = max(reach.get(_DRIFTING_GAIN, shear), shear)
    bound, drifting = (value * math.expm1(math.hypot(one, normal)) for one in (shear, drift))
    text = Message(
        "gains that no check sees (shear {shear:.0f} %, normal force {normal:.0f} %) could move "
        "RCOF by {bound:.2f}, a gain of the shear that drifts within the step by {drifting:.2f}; "
        "not in its uncertainty",
        shear=100 * math.expm1(shear),
        normal=100 * math.expm1(normal),
        bound=bound,
        drifting=drifting,
    )
    return (Flag("unseen gain", text, False, drifting, None, "1"),)
