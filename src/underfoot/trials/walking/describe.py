"""What is in a measurement file and what was made of it, for people to check before they trust."""

import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from underfoot.core import InputError, unknown_name
from underfoot.core.errors import first_names
from underfoot.core.remark import Message

from ..readers import TrialsProfile, read_profile, read_trials
from ..recording.axes import LEVEL, Axes, DirectionSource, Ramp, axis_name
from ..recording.marker_names import heel_candidates
from ..recording.measurement import mean_of
from ..recording.trial import Edit, Plate, Trial, join_trials
from .gait import DEFINITIONS, RcofDefinition, RequiredFriction, required_frictions
from .walkway import walkway_of

_SHOWN = 12


@dataclass(frozen=True, slots=True)
class Description:
    """A trial with its axes, heels and stances; ``text()`` prints it, ``as_dict()`` is data."""

    trial: Trial
    axes: Axes
    heels: dict[str, list[str]]
    steps: tuple[RequiredFriction, ...]
    conventions: dict[str, str]

    def as_dict(self) -> dict[str, Any]:
        """Return plain data for JSON."""
        trial, axes = self.trial, self.axes
        return {
            "name": trial.name,
            "format": trial.source,
            "checksum": trial.checksum,
            "settings": dict(trial.settings),
            "notes": list(trial.notes),
            "edits": [_edit_words(e) for e in trial.edits],
            "axes": {
                "vertical": axis_name(axes.up),
                "vertical_from": axes.up_from,
                "walking": axis_name(axes.walking),
                "walking_from": axes.walking_from,
                "surface": axes.ramp.description,
            },
            "plates": [_plate_data(plate) for plate in trial.plates],
            "markers": list(trial.markers),
            "heels": self.heels,
            "channels": {
                name: _parts(channel, "unit rate note") for name, channel in trial.channels.items()
            },
            "events": [_parts(event, "name side time source") for event in trial.events],
            "stances": [_stance_data(step) for step in self.steps],
            "conventions": self.conventions,
        }

    def text(self) -> str:
        """Return the description as lines of text."""
        trial = self.trial
        axes = self.axes
        events = [f"  {e.time:8.3f} s  {e.side:6s} {e.name}" for e in trial.events[:40]]
        lines = [
            f"{trial.name}: {trial.source}, sha256 {trial.checksum[:12]}",
            *(f"  {key}: {value}" for key, value in list(trial.settings.items())[:_SHOWN]),
            *(
                "",
                "Axes",
                Message(
                    "  vertical {axis_name} ({up_from})",
                    axis_name=axis_name(axes.up),
                    up_from=axes.up_from,
                ),
            ),
            f"  walking  {axis_name(axes.walking)} ({axes.walking_from})",
            f"  surface  {axes.ramp.description}",
            *(*self._plates(), *self._markers(), *self._channels()),
            *(["", "Events in the file", *events] if events else []),
            *self._stances(),
        ]
        for title, items in (("Notes", trial.notes), ("Edits", map(_edit_words, trial.edits))):
            listed = [f"  - {item}" for item in items]
            lines += ["", title, *listed] if listed else []
        return "\n".join(lines)

    def _plates(self) -> list[str]:
        if not self.trial.plates:
            return ["", "Force plates", "  none"]
        lines = ["", "Force plates (force of the floor on the foot)"]
        for plate in self.trial.plates:
            if plate.problem:
                lines.append(f"  {plate.name}: not usable: {plate.problem} [{plate.kind}]")
                continue
            seconds = len(plate.force) / plate.rate
            lines.append(f"  {plate.name}: {plate.kind}, {plate.rate:g} Hz, {seconds:.2f} s")
            lines.append(Message("    baseline {baseline}", baseline=_baseline(plate)))
            lines += [f"    ! {note}" for note in (*plate.flags, *plate.notes)]
        return lines

    def _markers(self) -> list[str]:
        markers = self.trial.markers
        if not markers:
            return ["", "Markers", "  none"]
        first = next(iter(markers.values()))
        lines = [
            "",
            Message("Markers: {count} at {rate:g} Hz", count=len(markers), rate=first.rate),
        ]
        lines.append("  " + first_names(markers, _SHOWN))
        for side, names in self.heels.items():
            for name in names:
                lost = 100.0 * float(markers[name].missing.mean()) if name in markers else 0.0
                lines.append(f"  {side} heel candidate: {name} (missing {lost:.0f} %)")
        if not any(self.heels.values()):
            lines.append("  no heel was recognised: name it under [landmarks] in a profile")
        return lines

    def _channels(self) -> list[str]:
        channels = self.trial.channels
        if not channels:
            return []
        rates = sorted({channel.rate for channel in channels.values()})
        lines = [
            "",
            Message(
                "Channels: {count} at {rates} Hz",
                count=len(channels),
                rates=", ".join(f"{r:.6g}" for r in rates),
            ),
        ]
        shown = [f"{name} ({channel.unit or 'unit?'})" for name, channel in channels.items()]
        return [*lines, "  " + first_names(shown, 2 * _SHOWN)]

    def _stances(self) -> list[str]:
        if not any(plate.usable for plate in self.trial.plates):
            return []
        lines = ["", "Contacts with the plates"]
        if not self.steps:
            return [*lines, "  none"]
        for step in self.steps:
            stance, rcof = step.stance, step.measurement
            lines.append(
                f"  {stance.number:2d}  {stance.contact:7.3f} s  {stance.plate}, "
                f"{1e3 * stance.duration:.0f} ms, peak {stance.peak:.0f} N, {stance.side} foot, "
                f"walking {axis_name(stance.walking)}"
            )
            under = []
            way = stance.direction
            if way.vector is not None and way.source is not DirectionSource.MARKERS:
                under.append(f"walking direction: {way.explanation}")
            if rcof.value is None:
                under.append(f"rejected: {rcof.reason}")
            else:
                number = f"{rcof.value:.3f} ± {rcof.uncertainty or 0:.3f}"
                after = 1e3 * (step.peak_time - stance.contact)
                under.append(f"{step.verdict}: RCOF {number}, {after:.0f} ms after contact")
            lines += [" " * 13 + text for text in (*under, *(f"! {flag}" for flag in rcof.flags))]
        good = [step.measurement for step in self.steps if step.measurement.estimated]
        doubtful = sum(bool(measurement.caution_flags) for measurement in good)
        if len(good) > 1:
            mean = mean_of(good)
            lines.append(
                Message(
                    "  RCOF mean {value:.3f}, SD {spread:.3f} between {count} steps "
                    "({doubtful} with a caution), standard error {uncertainty:.3f}",
                    value=mean.value,
                    spread=mean.spread,
                    count=len(good),
                    doubtful=doubtful,
                    uncertainty=mean.uncertainty,
                )
            )
        if good:
            lines += ["", "Conventions behind RCOF"]
            lines += [f"  {key}: {value}" for key, value in self.conventions.items()]
        return lines


def describe_trial(
    trial: Trial,
    *,
    definition: RcofDefinition | None = None,
    vertical: str | None = None,
    walking: str | None = None,
    profile: TrialsProfile | None = None,
    ramp: Ramp = LEVEL,
) -> Description:
    """Return the description of a trial.

    ``vertical`` and ``walking`` are overrides such as ``"z"``, ``"+x"``; a profile's are used when
    these are not given.
    """
    profile = profile or TrialsProfile()
    definition = definition or DEFINITIONS["default"]
    walk = walkway_of(
        trial,
        vertical=vertical or profile.vertical,
        walking=walking or profile.walking,
        ramp=ramp,
        landmarks=profile.landmarks,
    )
    steps = required_frictions(walk, definition)
    said = {**definition.conventions(), "surface": walk.surfaces}
    return Description(
        trial, walk.axes, heel_candidates(trial, profile.landmarks, walk.up), tuple(steps), said
    )


def described_file(
    path: Path | str,
    *,
    companion: Path | str | None = None,
    profile: TrialsProfile | Path | str | None = None,
    definition: str = "default",
    vertical: str | None = None,
    walking: str | None = None,
    subtract_baseline: bool = True,
    ramp: Ramp = LEVEL,
) -> tuple[Description, ...]:
    """Return the descriptions of the trials in a file (one a step for tribometer logs).

    ``companion`` is a second file of the same recording (.forces beside .trc), with one trial in
    each; ``definition`` a name in ``DEFINITIONS``; ``ramp`` the slope of the walkway with the axes
    in which its plates measure. A file that can't be read is a DataError; a wrong profile, axis or
    definition an InputError.
    """
    if definition not in DEFINITIONS:
        raise unknown_name("RCOF definition", definition, DEFINITIONS, where="definition")
    if profile is not None and not isinstance(profile, TrialsProfile):
        profile = read_profile(Path(profile))
    if vertical:
        profile = replace(profile or TrialsProfile(), vertical=vertical)
    trials = read_trials(path, profile, subtract_baseline=subtract_baseline)
    if companion is not None:
        others = read_trials(companion, profile, subtract_baseline=subtract_baseline)
        if len(trials) != 1 or len(others) != 1:
            raise InputError("only files that hold one trial each can be joined", where="--with")
        trials = (join_trials(trials[0], others[0]),)
    chosen: Any = {"definition": DEFINITIONS[definition], "profile": profile, "ramp": ramp}
    return tuple(describe_trial(t, vertical=vertical, walking=walking, **chosen) for t in trials)


def _baseline(plate: Plate) -> str:
    if plate.baseline is None:
        return "not subtracted"
    if not np.abs(plate.baseline).max() > 5e-4:
        return Message(
            "zero ({baseline_samples} unloaded samples)", baseline_samples=plate.baseline_samples
        )
    pairs = zip("xyz", plate.baseline, strict=True)
    numbers = ", ".join(f"{name} {value:.1f}" for name, value in pairs)
    return Message(
        "{numbers} N, mean of {baseline_samples} unloaded samples, subtracted",
        numbers=numbers,
        baseline_samples=plate.baseline_samples,
    )


def _edit_words(edit: Edit) -> Message:
    value = f"{edit.value:g} s" if isinstance(edit.value, float) else edit.value or ""
    change = {"what": f"{edit.what} {value}".rstrip(), "why": edit.why}
    return Message("{step}: {what} ({why})", step=edit.step_words, **change)


def _parts(thing: object, names: str) -> dict[str, Any]:
    return {name: getattr(thing, name) for name in names.split()}


def _plate_data(plate: Plate) -> dict[str, Any]:
    return {
        **_parts(plate, "name kind problem rate baseline_samples"),
        "samples": len(plate.force),
        "baseline": None if plate.baseline is None else plate.baseline.tolist(),
        "corners": None if plate.corners is None else plate.corners.tolist(),
        "notes": [*map(str, plate.flags), *plate.notes],
    }


def _stance_data(step: RequiredFriction) -> dict[str, Any]:
    stance = step.stance
    return {
        **_parts(stance, "plate contact toe_off peak side heel number accepted reason"),
        "walking": axis_name(stance.walking),
        "walking_from": stance.direction.explanation,
        "verdict": step.verdict,
        "peak_time": None if math.isnan(step.peak_time) else step.peak_time,
        "rcof": step.measurement.as_dict(),
    }
