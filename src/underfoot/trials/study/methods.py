"""The methods paragraphs, written from what was done to each file and plate."""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence

from underfoot.core.remark import (
    NOTHING,
    Message,
    Remark,
    join_lines,
    kind_of,
    of_several,
    together,
)

from ..recording.measurement import MEAN_OF_STEPS
from ..recording.protocols import KINDS, Protocol
from ..recording.signals import CONTACT_FORCE
from .file_result import CAUTION, REFUSED, FileResult
from .steps import protocol_ramp
from .study import TrialStudy

_PLUS_MINUS = Message(
    "On screen ± is the standard uncertainty of a number (of a mean: its standard error). Tables "
    "name SD (standard deviation) and SE (standard error), and intervals by their level."
)


def methods_paragraphs(
    files: Sequence[FileResult], protocol: Protocol, study: TrialStudy, version: str
) -> list[Message]:
    """Return paragraphs that say which files were used, how numbers were taken, which tests."""
    counts = Counter(file.verdict for file in files)
    first = Message(
        "{count} {count:file was|files were} analysed with underfoot {version} by the protocol "
        "“{protocol}” ({kind}; {source}). {usable} gave usable numbers, {cautions} of them with "
        "cautions; {refused} {refused:was|were} refused.",
        count=len(files), version=version, protocol=protocol.title, kind=KINDS[protocol.kind],
        source=protocol.source, usable=len(files) - counts[REFUSED], cautions=counts[CAUTION],
        refused=counts[REFUSED],
    )  # fmt: skip
    paragraphs = [first, *_selection(files)]
    conventions = _conventions(files)
    conventions += [_DONE[table.name] for table in study.tables if table.name in _DONE]
    if conventions:
        paragraphs.append(together(conventions))
    if protocol.kind in ("gait", "human_slip"):
        paragraphs.append(_surface(files, protocol))
    if protocol.rules:
        paragraphs.append(_rules(files, protocol))
    if study.findings:
        paragraphs.append(
            Message(
                "Statistics: {titles:; }. Alpha is 0.05; intervals cover 95 %. Factors were coded "
                "to sum to zero.",
                titles=dict.fromkeys(finding.title for finding in study.findings),
            )
        )
    paragraphs.append(_PLUS_MINUS)
    if standing := protocol.standing():
        standing = together(standing)
        paragraphs.append(Message("Where settings come from: {standing}", standing=standing))
    return paragraphs


def _rules(files: Sequence[FileResult], protocol: Protocol) -> Message:
    """Return the rules, and which of them could not be judged for lack of the quantity."""
    statements = [rule.statement() for rule in protocol.rules]
    sentences = [Message("Rules checked on every trial: {rules:; }.", rules=statements)]
    usable = [file for file in files if file.usable]
    for rule in protocol.rules:
        lacking = sum(rule.quantity not in result.facts for result in usable)
        if lacking and rule.quantity != "repeats":
            sentences.append(
                Message(
                    "Not judged in {lacking} of {count} files, which do not show it: {name}.",
                    lacking=lacking, count=len(usable), name=rule.quantity.replace("_", " "),
                )
            )  # fmt: skip
    return together(sentences)


def _surface(files: Sequence[FileResult], protocol: Protocol) -> Message:
    """Return the surface walked on: level, a ramp with its resolution of forces, a treadmill."""
    ramp = protocol_ramp(protocol)
    surface = [each for each in (protocol.text("surface"), ramp.description) if each]
    sentences = [Message("Surface: {surface}.", surface=surface)]
    if ramp.angle and ramp.plate_frame == "horizontal":
        sentences.append(
            Message(
                "Normal force and shear are those normal and tangential to the walking surface, "
                "resolved from the plates' horizontal and vertical forces by the angle of the ramp."
            )
        )
    elif ramp.angle:
        sentences.append(
            Message(
                "Normal force and shear are those normal and tangential to the walking surface; "
                "body weight in standing is their normal force over the cosine of the angle."
            )
        )
    speeds = [
        step.belt_speed
        for file in files
        for step in file.steps
        if step.belt_speed is not None and step.rcof is not None
    ]
    if speeds:
        sentences.append(
            Message(
                "Treadmill belts carried {count} contacts at {low:.2f} to {high:.2f} m/s, found "
                "where standing feet are carried backward; heel speeds are those over the belt. "
                "Its forces are those of steady walking only while the belt keeps its speed.",
                count=len(speeds), low=min(speeds), high=max(speeds),
            )
        )  # fmt: skip
    return together(sentences)


def _selection(files: Sequence[FileResult]) -> list[Message]:
    """Return how contacts were found and which were rejected for what, with counts."""
    steps = [step for file in files for step in file.steps]
    if not steps:
        return []
    counts = Counter(step.verdict for step in steps)
    reasons = Counter(
        step.reason.subject for step in steps if step.verdict == "rejected" and step.reason
    )
    used = counts["accepted"] + counts["caution"]
    rejected = NOTHING
    if reasons:
        listed = [
            Message("{reason} ({count})", reason=reason, count=count)
            for reason, count in reasons.most_common()
        ]
        count = {"count": len(steps) - used}
        rejected = Message(" and {count} rejected: {reasons:; }", reasons=listed, **count)
    sentences = [
        Message(
            "A contact is a stance with more than {force:g} N of normal force.",
            force=CONTACT_FORCE,
        ),
        Message(
            "Of {count} contacts {used} were used ({cautions} with a caution){rejected}.",
            count=len(steps), used=used, cautions=counts["caution"], rejected=rejected,
        ),
    ]  # fmt: skip
    if by_hand := sum(bool(step.by_hand) for step in steps):
        sentences.append(
            Message("{count} were changed by hand, see the log of edits.", count=by_hand)
        )
    return [together(sentences)]


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
_SENTENCES: dict[str, tuple[Callable[[Mapping[str, Message]], Message], ...]] = {
    "rcof": (
        lambda of: Message(
            "Required friction (RCOF) was taken as the {peak} of shear ({shear}) over normal force "
            "in the {searched}, {direction}, with the {gate}; forces were low-passed with: "
            "{filter}; baseline: {baseline}.",
            peak=of["peak"], shear=of["shear"], searched=of["searched"], gate=of["gate"],
            direction=of["direction"], filter=of["filter"], baseline=of["baseline"],
        ),
    ),
    "peak slipping speed": (
        lambda of: Message(
            "Heel speed ({speed}) came from the heel marker, low-passed with: {filter}; gaps were "
            "{gaps}. The slip starts at the {start}; the peak slipping speed is the largest speed "
            "until the second local minimum, until the foot leaves the plate or until the heel "
            "lifts, and counts as a {threshold}.",
            speed=of["speed"], filter=of["marker filter"], gaps=of["gaps"],
            start=of["slip start"], threshold=of["threshold"],
        ),
    ),
    "peak pressure": (
        lambda of: Message(
            "Fluid pressures count above {threshold} (baseline: {baseline}; {run}); pressure "
            "duration is the time {duration}.",
            threshold=of["threshold"], baseline=of["baseline"], run=of["run"],
            duration=of["duration"],
        ),
    ),
    "final force": (
        lambda of: Message(
            "The force at the end of the hold is the {force}; {zero}.",
            force=of["final force"], zero=of["zero"],
        ),
    ),
    "cof": (
        lambda of: Message(
            "COF is the {average} from {window} (sliding start: {start}); shear: {shear}; "
            "{filter}; baseline: {baseline}; calibration: {calibration}.",
            average=of["average"], window=of["window"], start=of["sliding start"],
            shear=of["shear"], filter=of["filter"], baseline=of["baseline"],
            calibration=of["calibration"],
        ),
        lambda of: Message(
            "COF is the {average} in a window of {window}; shear: {shear}; {filter}; baseline: "
            "{baseline}; calibration: {calibration}.",
            average=of["average"], window=of["window"], shear=of["shear"], filter=of["filter"],
            baseline=of["baseline"], calibration=of["calibration"],
        ),
        lambda of: Message(
            "COF is taken as {cof}, the {average} ({window}).",
            cof=of["cof"], average=of["average"], window=of["window"],
        ),
    ),
}  # fmt: skip
_DONE = {
    "stribeck": Message(
        "COF against speed was fitted with COF = asymptote + (COF_BL - asymptote) exp(-v / tau) by "
        "separable bounded least squares with profile-likelihood intervals. Fits with R^2 above "
        "0.8 count as good, above 0.5 as moderate; below that the mean COF stands for COF_BL."
    ),
    "master_curve": Message(
        "All COF were brought on one curve against viscosity times speed by isotonic regression."
    ),
    "maps": Message(
        "Pressure scans were joined by the marker's position; the load on the fluid is the sum of "
        "pressure, distance between scans and displacement per sample."
    ),
    "friction_split": Message(
        "Hysteresis is the friction with the blocking oil, adhesion what exceeds it; standard "
        "errors were added in squares."
    ),
}
# What differs from file to file without being a choice: it stands with each number.
_PRIVATE = ("search ends", "sign", "uncertainty")


def _conventions(files: Sequence[FileResult]) -> list[Message]:
    """Return one sentence for each quantity; where files or plates differ, each way with counts."""
    numbers: dict[
        str, list[tuple[str, Mapping[str, Message]]]
    ] = {}  # file and conventions, by name
    for file in files:
        for m in file.measurements:
            known = m.value is not None and m.name in _TOLD and m.item != MEAN_OF_STEPS
            if known and m.conventions:
                numbers.setdefault(m.name, []).append((file.file, m.conventions))
    sentences: list[Message] = []
    for name, made in numbers.items():
        if _TOLD_BY.get(name) in numbers:
            continue
        keys = list(dict.fromkeys(k for _, c in made for k in c if k not in _PRIVATE))
        choices = {key: _choices(key, made) for key in keys}
        sentence = _sentence(name, choices)
        if sentence is None:
            listed = [Remark.of(key, value) for key, value in choices.items()]
            sentence = Message("{what}: {choices:; }.", what=_TOLD[name], choices=listed)
        elif way := choices.get("walking direction"):
            sentence = together([sentence, Message("Walking direction: {way}.", way=way)])
        if sentence not in sentences:
            sentences.append(sentence)
    return sentences


def _choices(key: str, made: Sequence[tuple[str, Mapping[str, Message]]]) -> Message:
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
        named = Message(" in {count} files", count=len(files))
        if len(files) <= 3:
            named = Message(": {files}", files=files)
        counts = {"count": len(members), "all": len(made), "named": named}
        parts.append(Message("{choice} ({count} of {all}{named})", choice=ranges[kind], **counts))
    return join_lines(parts)


def _sentence(name: str, choices: Mapping[str, Message]) -> Message | None:
    """Return a sentence for a paper, or nothing when a convention it needs was not recorded."""
    for sentence in _SENTENCES.get(name, ()):
        try:
            return sentence(choices)
        except KeyError:
            continue
    return None
