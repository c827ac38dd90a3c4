"""The methods paragraphs, written from what was done to each file and plate."""

from collections import Counter
from collections.abc import Mapping, Sequence

from underfoot.core.remark import Message, kind_of, of_several

from ..recording.measurement import MEAN_OF_STEPS
from ..recording.protocols import KINDS, Protocol
from ..recording.signals import CONTACT_FORCE
from .file_result import CAUTION, REFUSED, FileResult
from .steps import protocol_ramp
from .study import TrialStudy

_PLUS_MINUS = (
    "On screen ± is the standard uncertainty of a number (of a mean: its standard error). Tables "
    "name SD (standard deviation) and SE (standard error), and intervals by their level."
)


def methods_paragraphs(
    files: Sequence[FileResult], protocol: Protocol, study: TrialStudy, version: str
) -> list[str]:
    """Return paragraphs that say which files were used, how numbers were taken, which tests."""
    counts = Counter(file.verdict for file in files)
    n = len(files)
    first = (
        f"{n} {'file was' if n == 1 else 'files were'} analysed with underfoot {version} by the "
        f"protocol “{protocol.title}” ({KINDS[protocol.kind]}; {protocol.source}). "
        f"{n - counts[REFUSED]} gave usable numbers, {counts[CAUTION]} of them with cautions; "
        f"{counts[REFUSED]} {'was' if counts[REFUSED] == 1 else 'were'} refused."
    )
    paragraphs = [first, *_selection(files)]
    conventions = _conventions(files)
    conventions += [_DONE[table.name] for table in study.tables if table.name in _DONE]
    if conventions:
        paragraphs.append(" ".join(conventions))
    if protocol.kind in ("gait", "human_slip"):
        paragraphs.append(_surface(files, protocol))
    if protocol.rules:
        paragraphs.append(_rules(files, protocol))
    if study.findings:
        titles = "; ".join(dict.fromkeys(finding.title for finding in study.findings))
        paragraphs.append(
            f"Statistics: {titles}. Alpha is 0.05; intervals cover 95 %. Factors were coded to "
            "sum to zero."
        )
    paragraphs.append(_PLUS_MINUS)
    standing = " ".join(protocol.standing())
    return [*paragraphs, *([f"Where settings come from: {standing}"] if standing else [])]


def _rules(files: Sequence[FileResult], protocol: Protocol) -> str:
    """Return the rules, and which of them could not be judged for lack of the quantity."""
    text = (
        f"Rules checked on every trial: {'; '.join(rule.statement() for rule in protocol.rules)}."
    )
    usable = [file for file in files if file.usable]
    for rule in protocol.rules:
        lacking = sum(rule.quantity not in result.facts for result in usable)
        if lacking and rule.quantity != "repeats":
            name = rule.quantity.replace("_", " ")
            text += (
                f" Not judged in {lacking} of {len(usable)} files, which do not show it: {name}."
            )
    return text


def _surface(files: Sequence[FileResult], protocol: Protocol) -> str:
    """Return the surface walked on: level, a ramp with its resolution of forces, a treadmill."""
    ramp = protocol_ramp(protocol)
    named = protocol.text("surface")
    text = f"Surface: {named}, {ramp.description}." if named else f"Surface: {ramp.description}."
    if ramp.angle:
        text += " Normal force and shear are those normal and tangential to the walking surface" + (
            ", resolved from the plates' horizontal and vertical forces by the angle of the ramp."
            if ramp.plate_frame == "horizontal"
            else "; body weight in standing is their normal force over the cosine of the angle."
        )
    speeds = [
        step.belt_speed
        for file in files
        for step in file.steps
        if step.belt_speed is not None and step.rcof is not None
    ]
    if speeds:
        text += (
            f" Treadmill belts carried {len(speeds)} contacts at {min(speeds):.2f} to "
            f"{max(speeds):.2f} m/s, found where standing feet are carried backward; heel speeds "
            "are those over the belt. Its forces are those of steady walking only while the belt "
            "keeps its speed."
        )
    return text


def _selection(files: Sequence[FileResult]) -> list[str]:
    """Return how contacts were found and which were rejected for what, with counts."""
    steps = [step for file in files for step in file.steps]
    if not steps:
        return []
    counts = Counter(step.verdict for step in steps)
    reasons = Counter(
        step.reason.subject for step in steps if step.verdict == "rejected" and step.reason
    )
    used = counts["accepted"] + counts["caution"]
    text = (
        f"A contact is a stance with more than {CONTACT_FORCE:g} N of normal force. Of "
        f"{len(steps)} contacts {used} were used ({counts['caution']} with a caution)"
    )
    if reasons:
        listed = "; ".join(f"{reason} ({n})" for reason, n in reasons.most_common())
        text += f" and {len(steps) - used} rejected: {listed}"
    by_hand = sum(bool(step.by_hand) for step in steps)
    if by_hand:
        text += f". {by_hand} were changed by hand, see the log of edits"
    return [text + "."]


_TOLD = {
    "rcof": "Required friction (RCOF)",
    "cof": "Coefficient of friction (COF)",
    "peak slipping speed": "Peak slipping speed",
    "peak pressure": "Peak pressure of a sensor",
    "pressure duration": "Pressure duration",
    "peak force": "Forces of the relaxation test",
    "final force": "Force at the end of the hold",
}
_TOLD_BY = {"pressure duration": "peak pressure", "peak force": "final force"}
_SENTENCES: dict[str, tuple[str, ...]] = {
    "rcof": (
        "Required friction (RCOF) was taken as the {peak} of shear ({shear}) over normal force in "
        "the {searched}, {direction}, with the {gate}; forces were low-passed with: {filter}; "
        "baseline: {baseline}.",
    ),
    "peak slipping speed": (
        "Heel speed ({speed}) came from the heel marker, low-passed with: {marker filter}; gaps "
        "were {gaps}. The slip starts at the {slip start}; the peak slipping speed is the largest "
        "speed until the second local minimum, until the foot leaves the plate or until the heel "
        "lifts, and counts as a {threshold}.",
    ),
    "peak pressure": (
        "Fluid pressures count above {threshold} (baseline: {baseline}; {run}); pressure duration "
        "is the time {duration}.",
    ),
    "final force": ("The force at the end of the hold is the {final force}; {zero}.",),
    "cof": (
        "COF is the {average} from {window} (sliding start: {sliding start}); shear: {shear}; "
        "{filter}; baseline: {baseline}; calibration: {calibration}.",
        "COF is the {average} in a window of {window}; shear: {shear}; {filter}; baseline: "
        "{baseline}; calibration: {calibration}.",
        "COF is taken as {cof}, the {average} ({window}).",
    ),
}
_DONE = {
    "stribeck": (
        "COF against speed was fitted with COF = asymptote + (COF_BL - asymptote) exp(-v / tau) by "
        "separable bounded least squares with profile-likelihood intervals. Fits with R^2 above "
        "0.8 count as good, above 0.5 as moderate; below that the mean COF stands for COF_BL."
    ),
    "master_curve": "All COF were brought on one curve against viscosity times speed by isotonic "
    "regression.",
    "maps": (
        "Pressure scans were joined by the marker's position; the load on the fluid is the sum of "
        "pressure, distance between scans and displacement per sample."
    ),
    "friction_split": (
        "Hysteresis is the friction with the blocking oil, adhesion what exceeds it; standard "
        "errors were added in squares."
    ),
}
# What differs from file to file without being a choice: it stands with each number.
_PRIVATE = ("search ends", "sign", "uncertainty")


def _conventions(files: Sequence[FileResult]) -> list[str]:
    """Return one sentence for each quantity; where files or plates differ, each way with counts."""
    numbers: dict[
        str, list[tuple[str, Mapping[str, Message]]]
    ] = {}  # file and conventions, by name
    for file in files:
        for m in file.measurements:
            known = m.value is not None and m.name in _TOLD and m.item != MEAN_OF_STEPS
            if known and m.conventions:
                numbers.setdefault(m.name, []).append((file.file, m.conventions))
    sentences: list[str] = []
    for name, made in numbers.items():
        if _TOLD_BY.get(name) in numbers:
            continue
        keys = list(dict.fromkeys(k for _, c in made for k in c if k not in _PRIVATE))
        choices = {key: _choices(key, made) for key in keys}
        sentence = _sentence(name, choices)
        if not sentence:
            listed = "; ".join(f"{key}: {value}" for key, value in choices.items())
            sentence = f"{_TOLD[name]}: {listed}."
        elif way := choices.get("walking direction"):
            sentence += f" Walking direction: {way}."
        if sentence not in sentences:
            sentences.append(sentence)
    return sentences


def _choices(key: str, made: Sequence[tuple[str, Mapping[str, Message]]]) -> str:
    """Return what all numbers share, with the range of each number, or every way with its files."""
    alike: dict[object, list[tuple[str, Message]]] = {}  # place and choice, by kind
    for place, conventions in made:
        choice = conventions.get(key, Message("not recorded"))
        alike.setdefault(kind_of(choice), []).append((place, choice))
    ranges = {
        kind: of_several([choice for _, choice in members]) for kind, members in alike.items()
    }
    if len(alike) == 1:
        return next(iter(ranges.values()))
    parts = []
    for kind, members in sorted(alike.items(), key=lambda item: -len(item[1])):
        files = sorted({place for place, _ in members})
        named = ": " + ", ".join(files) if len(files) <= 3 else f" in {len(files)} files"
        parts.append(f"{ranges[kind]} ({len(members)} of {len(made)}{named})")
    return "; ".join(parts)


def _sentence(name: str, choices: Mapping[str, str]) -> str:
    """Return a sentence for a paper, or nothing when a convention it needs was not recorded."""
    for sentence in _SENTENCES.get(name, ()):
        try:
            return sentence.format_map(choices)
        except KeyError:
            continue
    return ""
