"""Is a log of a slip tester what it looks like? Checks of zero, channels, slides and clock.

Limits are assumed where no source is named; they are the same on both sides. A flag that matters
makes the number a caution; `log_kind` tells a slide from a walking step before anything is read.
"""

import math
from collections.abc import Iterator

import numpy as np

from underfoot.core.remark import Message

from ..recording.measurement import Flag
from ..recording.signals import longest_run, runs, unloaded_samples
from ..recording.tester_calibration import TesterCalibration
from ..recording.trial import Plate
from ..walking.plausibility import HELD, Limit
from .pressure_map import PressureScan
from .slip_friction import SlideFriction

ZERO = Limit("zero", 0.005, "1", "change of COF by the unloaded level at the slide; assumed")
LOW = Limit("COF", 0.02, "1", "few shoes on lubricated floors lie below (lowest known 0.008)")
HIGH = Limit("COF", 1.2, "1", "rubber on a clean dry floor; assumed")
DEAD = Limit("dead channel", 5.0, "1", "friction over its standard error, unloaded; assumed")
CLIPPED = Limit("saturation", 0.02, "1", "share of loaded samples at the extreme value; assumed")
WRAPPED = Limit("range", 0.3, "1", "share of the friction from one side to the other; assumed")
FULL = Limit("saturation", 0.98, "1", "share of the range in the calibration record; assumed")
STEP = Limit("resolution", 0.004, "1", "half a step of the converter in COF; assumed")
STRAIGHT = Limit("interpolated", 0.5, "1", "share of samples on straight lines; assumed")
OUTLIERS = Limit("outliers", 0.04, "1", "mean against median COF of the window; assumed")
TREND = Limit("steadiness", 0.25, "1", "change of COF along the window; assumed")
SWING = Limit("normal force", 0.1, "1", "standard deviation over the mean in the window; assumed")
QUIET = Limit("scatter", 1.2, "1", "scatter of sliding over that of the unloaded channel; assumed")
STOPS = Limit("sliding", 0.5, "1", "lowest over mean speed in the window; assumed")
LONGEST = Limit("slide", 1.5, "m", "length of the slide, longer than a tester's travel; assumed")
SLOWEST = Limit("slide", 20.0, "s", "time under load; assumed")
CROSSTALK = Limit("crosstalk", 0.01, "1", "friction over normal force before sliding; assumed")
NOISE = Limit("noise", 2.5, "1", "noise of the unloaded channel over that on record; assumed")
LOW_PRESSURE = Limit("pressure", 1000.0, "Pa", "the report's smallest peak is 2 kPa; assumed")
_REVERSED = 0.25  # smaller over larger impulse along the shear: a step brakes, then drives
_STUCK = 0.9  # of the loaded samples at the largest value, none above: a normal force swings
_STEADY = 0.5  # share of the contact within 5 % of its median force: a step has two humps


def log_kind(plate: Plate, up: np.ndarray) -> str:
    """Return "walk" or "slide" for what stands on a plate; "" where neither is clear.

    A step brakes and then drives, and its normal force is never steady; a tester holds its normal
    force and pushes one way.
    """
    normal = plate.force @ up
    level = float(np.nanpercentile(normal, 99)) if len(normal) else 0.0
    loaded = normal > 0.2 * level
    if level < 50.0 or loaded.sum() < 20:
        return ""
    first = max(runs(loaded), key=lambda run: run[1] - run[0])
    part = np.nan_to_num(plate.force[first[0] : first[1]])
    normal = part @ up
    shear = part - np.outer(normal, up)
    axis = np.linalg.eigh(shear.T @ shear)[1][:, -1]
    along = shear @ axis
    impulses = sorted((float(along[along > 0].sum()), -float(along[along < 0].sum())))
    back = impulses[0] / impulses[1] if impulses[1] > 0 else 0.0
    steady = float(np.mean(np.abs(normal / np.median(normal) - 1.0) < 0.05))
    if back > _REVERSED and steady < _STEADY:
        return "walk"
    sliding = float(np.median(np.abs(along) / np.maximum(normal, 1.0))) > LOW.value
    return "slide" if back < 0.5 * _REVERSED and steady > _STEADY and sliding else ""


def slide_flags(
    slide: SlideFriction, plate: Plate, up: np.ndarray, record: TesterCalibration | None = None
) -> tuple[Flag, ...]:
    """Return what is doubtful about one slide; its COF has a value.

    ``plate`` has its baseline subtracted; ``up`` (3,) is the unit vector out of the floor.
    """
    # Saturation is judged here: a load that stands still dwells on one step of a coarse converter.
    flags = [flag for flag in plate.flags if flag.matters and flag.name != "saturated"]
    if not np.isfinite(slide.normal).all():
        return tuple(flags)
    check = _Slide(slide, plate, up)
    count = int(check.inside.sum())
    if count < 10:
        words = Message("{count} samples in the window: are clock and rate right?", count=count)
        return (*flags, Flag("rate", words, True, count, 10, "1"))
    flags += [
        *check.zero(), *check.size(), *check.channels(), *check.window(), *check.course(),
        *check.crosstalk(),
    ]  # fmt: skip
    return tuple(flags + (list(check.against(record)) if record is not None else []))


def scan_flags(scan: PressureScan, record: TesterCalibration | None = None) -> tuple[Flag, ...]:
    """Return what is doubtful about the size and sign of a pressure scan."""
    flags: list[Flag] = []
    peak, least, noise = float(scan.pressure.max()), float(scan.pressure.min()), scan.baseline_sd
    if -least > max(2.0 * peak, 8.0 * noise):
        flags.append(
            Flag(
                "pressure", Message("the pressure falls by {fall:.3g} Pa: wrong sign?", fall=-least)
            )
        )
    elif 8.0 * noise < peak < LOW_PRESSURE.value:
        words = Message("a clear peak of {peak:.3g} Pa only: is the unit right?", peak=peak)
        flags.append(LOW_PRESSURE.flag(peak, words))
    known = record.channel("pressure").noise if record else None
    if record and known and noise:
        ratio = noise / (known * record.channel("pressure").factor)
        words = Message(
            "noise of the pressure {noise:.3g} Pa, on record {known:.3g} Pa: unit or gain?",
            noise=noise,
            known=known,
        )
        flags += NOISE.above(max(ratio, 1.0 / ratio), words)
    return tuple(flags)


class _Slide:
    """One slide with what several checks need."""

    def __init__(self, slide: SlideFriction, plate: Plate, up: np.ndarray) -> None:
        self.slide, self.rate, self.time, self.up = slide, plate.rate, slide.time, up
        self.cof = slide.cof.value or 0.0
        self.normal, self.force = slide.normal, plate.force
        self.shear = plate.force - np.outer(slide.normal, up)
        self.inside = (self.time >= slide.window[0]) & (self.time <= slide.window[1])
        self.inside &= np.isfinite(self.normal)
        self.level = max(float(np.sum(self.normal[self.inside])) / max(self.inside.sum(), 1), 1.0)
        mean = self.shear[self.inside].sum(axis=0)
        self.axis = mean / max(float(np.linalg.norm(mean)), 1e-9)
        self.along = self.shear @ self.axis
        self.loaded = np.nan_to_num(self.normal) > 0.5 * self.level
        self.rest = unloaded_samples(self.normal, plate.rate)

    def _noise(self, values: np.ndarray) -> float:
        """Standard deviation (N) of an unloaded channel without its slow course; 0: unknown."""
        steps = np.diff(values[self.rest])
        # Where nearly all neighbours are equal the converter's steps hide the noise.
        if len(steps) < 10 or np.mean(steps != 0) < 0.05:
            return 0.0
        usual = np.quantile(np.abs(steps[steps != 0]), 0.9)
        return float(np.std(steps[np.abs(steps) <= 20.0 * usual])) / math.sqrt(2.0)  # no spikes

    def zero(self) -> Iterator[Flag]:
        """Flag the unloaded level: as it lies at the slide, and before against after."""
        if self.rest.sum() < 20:
            return
        centre = 0.5 * sum(self.slide.window)
        first = float(self.time[self.loaded][0])
        pairs = np.column_stack((self.along, self.normal))[self.rest]
        time = self.time[self.rest] - centre
        sides = [pairs[time < first - centre], pairs[time > first - centre]]
        levels = [side.mean(axis=0) for side in sides if len(side) >= 20]
        levels = [0.5 * (levels[1] - levels[0])] if len(levels) == 2 else levels
        levels.append(np.median(pairs, axis=0) - pairs.mean(axis=0))  # spikes, loads
        if len(sides[1]) >= 60:  # a zero that creeps back after the load
            early, _, late = np.array_split(sides[1], 3)
            levels.append(early.mean(axis=0) - late.mean(axis=0))
        slope, at = np.polyfit(time, pairs, 1)
        x = time - time.mean()
        error = np.std(pairs - at - np.outer(time, slope), axis=0)
        error = error * np.sqrt(1.0 / len(x) + time.mean() ** 2 / float(x @ x))
        levels.append(np.where(np.abs(at) > 4.0 * error, at, 0.0))
        effect = max(abs(a) + self.cof * abs(n) for a, n in levels) / self.level
        words = Message(
            "the unloaded level moves COF by {effect:.3f}: zero or drift", effect=effect
        )
        yield from ZERO.above(effect, words)

    def size(self) -> Iterator[Flag]:
        """Flag a COF that few shoes have, and friction that the channel does not show."""
        rest = self.along[self.rest]
        window = self.along[self.inside]
        standing_out = float(window.mean()) / max(
            self._noise(self.along) / math.sqrt(len(window)), 1e-9
        )
        if len(rest) > 10 and standing_out < DEAD.value:
            yield DEAD.flag(
                standing_out, Message("the friction does not stand out of the unloaded channel")
            )
        elif self.cof < LOW.value:
            yield LOW.flag(
                self.cof, Message("COF {cof:.3f}: a dead channel or a wrong unit?", cof=self.cof)
            )
        elif self.cof > HIGH.value:
            yield HIGH.flag(
                self.cof,
                Message("COF {cof:.2f}: channels exchanged or a wrong unit?", cof=self.cof),
            )

    def channels(self) -> Iterator[Flag]:
        """Flag samples that no instrument gives: clipped, held, interpolated, in coarse steps."""
        fine, upward = True, int(np.argmax(np.abs(self.up)))
        still = np.ones(int(self.loaded.sum()) - 1, dtype=bool)
        for i, name in enumerate("xyz"):
            values = self.force[self.loaded, i]
            steps = np.diff(values)
            if not np.ptp(self.force[:, i]) > 0:
                continue
            still &= steps == 0.0
            part = np.unique(self.force[self.inside, i])
            idle = np.unique(self.force[self.rest, i])
            if len(idle) == 1 and self.rest.sum() > 20 and len(part) > 30:
                text = Message(
                    "the unloaded force along {name} is one number: a dead band or zeroed?",
                    name=name,
                )
                yield Flag("scatter", text, True, 0.0)
            quantum = float(np.min(np.diff(idle))) if 1 < len(idle) < 30 else 0.0
            coarse = quantum > 0.0 and len(part) < 30
            share = self.cof if i == upward else abs(float(self.axis[i]))
            carries = i == upward or share > 0.5
            if len(part) <= 2 and (not coarse or (carries and len(idle) >= 4)):
                text = Message(
                    "the force along {name} does not scatter in the window: held or clipped",
                    name=name,
                )
                yield Flag("scatter", text, True, 0.0)
            elif coarse and len(part) <= 3:
                size = 0.5 * quantum * share / self.level
                text = Message(
                    "steps of {quantum:.3g} N along {name} hide {effect:.3f} of COF",
                    quantum=quantum,
                    name=name,
                    effect=size,
                )
                yield from STEP.above(size, text)
            fine = fine and not coarse
            seen = self.force[self.inside, i] if coarse else values
            ends = max(float(np.mean(seen == end)) for end in (values.max(), values.min()))
            stuck = float(np.mean(values == values.max()))
            ends = stuck if coarse and i == upward and stuck > _STUCK else ends
            scatters = len(part) > 2 or ends > _STUCK
            if scatters and ends * len(seen) >= 5 and (not coarse or (carries and ends > 0.5)):
                text = Message(
                    "{share:.0f} % of the samples along {name} lie at their extreme",
                    share=100 * ends,
                    name=name,
                )
                yield from CLIPPED.above(ends, text)
            if coarse:
                continue
            bend = np.abs(np.diff(values, 2)) < 0.02 * float(np.std(steps))
            line = longest_run(bend & (steps[1:] != 0.0)) / self.rate
            straight = max(float(np.mean(bend)), STRAIGHT.value + 1e-9 if line > 0.02 else 0.0)
            text = Message(
                "the samples along {name} lie on straight lines: interpolated", name=name
            )
            yield from STRAIGHT.above(straight, text)
        pairs = np.column_stack((self.along[:-1], self.along[1:]))[self.loaded[1:]]
        crossing = np.abs(pairs[pairs.prod(axis=1) < 0.0]).min(axis=1).max(initial=0.0)
        text = Message("the friction leaps from one side to the other: does its range wrap?")
        yield from WRAPPED.above(crossing / max(float(np.abs(pairs).max()), 1.0), text)
        held = longest_run(still) + 1
        idle = longest_run((np.diff(self.force[self.rest], axis=0) == 0.0).all(axis=1))
        if held >= 4 + 2 * idle and held / self.rate >= (HELD.value if fine else 0.05):
            yield HELD.flag(
                held / self.rate,
                Message("all forces stand still for {samples} samples", samples=held),
            )

    def window(self) -> Iterator[Flag]:
        """Flag a mean that does not stand for its window."""
        ratio = self.slide.ratio[self.inside]
        ratio = ratio[np.isfinite(ratio)]
        if len(ratio) < 10:
            return
        away = abs(float(ratio.mean()) - float(np.median(ratio)))
        if away > 0.004:
            text = Message("outliers move the mean COF by {away:.3f} against the median", away=away)
            yield from OUTLIERS.above(away / self.cof, text)
        change = abs(float(np.polyfit(np.linspace(-0.5, 0.5, len(ratio)), ratio, 1)[0]))
        if change > 0.01:
            text = Message(
                "COF changes by {change:.3f} along the window: the mean depends on it",
                change=change,
            )
            yield from TREND.above(change / self.cof, text)
        along = self.along[self.inside]
        x = np.linspace(-1.0, 1.0, len(along))
        scatter = float(np.std(along - np.polyval(np.polyfit(x, along, 2), x)))
        noise = self._noise(self.along)
        if 0.0 < 1.7 * noise < 0.01 * float(along.mean()) and scatter < 1.2 * noise:
            text = Message(
                "sliding adds nothing to the noise of the friction channel: clipped or made up?"
            )
            yield QUIET.flag(scatter / noise, text)
        swing = float(np.std(self.normal[self.inside])) / self.level
        yield from SWING.above(
            swing, Message("the normal force swings by {swing:.0f} %", swing=100 * swing)
        )

    def course(self) -> Iterator[Flag]:
        """Flag more than one slide, a shoe that stops, and a clock that can't be right."""
        gap = max(1, round(0.05 * self.rate))
        loads = _join_runs(runs(self.loaded), gap)
        loads = [run for run in loads if run[1] - run[0] > 0.1 * (loads[0][1] - loads[0][0])]
        count, speed = len(loads), self.slide.speed
        lasting = float(self.loaded.sum()) / self.rate
        text = Message("{lasting:.3g} s under load: is the clock right?", lasting=lasting)
        yield from SLOWEST.above(lasting, text)
        if speed is not None:
            size = np.abs(np.nan_to_num(speed.values))
            loaded = np.interp(speed.time, self.time, self.loaded.astype(float)) > 0.5
            inside = (speed.time >= self.slide.window[0]) & (speed.time <= self.slide.window[1])
            top = float(np.percentile(size[loaded], 95)) if loaded.any() else 0.0
            moving = _join_runs(runs(loaded & (size > 0.3 * top)), round(0.05 * speed.rate))
            moving = [run for run in moving if run[1] - run[0] > 0.05 * speed.rate]
            count = max(count, len(moving))
            if inside.any() and size[inside].mean() > 0:
                lowest = float(size[inside].min() / size[inside].mean())
                if lowest < STOPS.value:
                    yield STOPS.flag(lowest, Message("the shoe starts or stops within the window"))
            length = float(size[loaded].sum()) / speed.rate
            yield from LONGEST.above(
                length, Message("a slide of {length:.3g} m: clock or unit of speed?", length=length)
            )
        if count > 1:
            text = Message(
                "{count} slides in the file: the number is that of the first; cut the others",
                count=count,
            )
            yield Flag("slides", text, True, count, 1.0, "1")

    def crosstalk(self) -> Iterator[Flag]:
        """Flag friction in proportion to the normal force before the shoe slides.

        A shoe that is pushed while it is lowered pushes in proportion to nothing exactly.
        """
        end = (self.slide.onset or self.time[0]) - 0.01
        part = (np.nan_to_num(self.normal) > 20.0) & (self.time < end)
        share, along, noise = (
            self.normal[part] / self.level,
            self.along[part],
            self._noise(self.along),
        )
        if len(share) < 20 or np.ptp(share) < 0.5 or not noise:
            return
        matrix = np.column_stack((share, share**2))
        inverse = np.linalg.inv(matrix.T @ matrix)
        rise, bend = inverse @ matrix.T @ along
        scatter = float(np.std(along - matrix @ (rise, bend)))
        error = noise * math.sqrt(float(inverse[1, 1]))
        if (
            scatter < 1.3 * noise
            and error < 0.1 * abs(rise)
            and abs(bend) < 2.0 * error + 0.1 * abs(rise)
        ):
            slope = float(along @ share / (share @ share)) / self.level
            words = Message(
                "before the shoe slides the friction is {share:.1f} % of the "
                "normal force, in proportion: crosstalk?",
                share=100 * slope,
            )
            yield from CROSSTALK.above(abs(slope), words)

    def against(self, record: TesterCalibration) -> Iterator[Flag]:
        """Flag what the calibration record contradicts: range, largest reference, noise."""
        for name, values in (("normal", self.normal), ("friction", self.along)):
            channel = record.channel(name)
            top = float(np.nanpercentile(np.abs(values[self.loaded]), 99))
            if channel.range:
                share = top / (channel.range * channel.factor)
                yield from FULL.above(
                    share, Message("the {name} force reaches the channel's range", name=name)
                )
            if top > 1.1 * channel.highest:
                words = Message(
                    "{name} force of {force:.0f} N: calibrated up to {highest:.0f} N",
                    name=name,
                    force=top,
                    highest=channel.highest,
                )
                yield Flag("calibration", words, True, top, channel.highest, "N")
            noise = self._noise(values)
            if channel.noise and noise:
                ratio = noise / (channel.noise * channel.factor)
                words = Message(
                    "noise of the {name} force {noise:.2g} N, on record {known:.2g} N: unit or "
                    "gain?",
                    name=name,
                    noise=noise,
                    known=channel.noise,
                )
                yield from NOISE.above(max(ratio, 1.0 / ratio), words)


def _join_runs(parts: list[tuple[int, int]], gap: int) -> list[tuple[int, int]]:
    """Return the runs with gaps of at most ``gap`` samples closed."""
    out: list[tuple[int, int]] = []
    for start, stop in parts:
        if out and start - out[-1][1] <= gap:
            out[-1] = (out[-1][0], stop)
        else:
            out.append((start, stop))
    return out
