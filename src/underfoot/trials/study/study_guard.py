"""What the files of a study say against each other, told before any statistics."""

import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import combinations
from typing import Any

import numpy as np

from underfoot.core.remark import Message

from ..machines.slip_friction import UNCALIBRATED
from ..recording.protocols import Protocol
from ..statistics import drift, names_persons, told_apart
from .body_doubts import SCATTERS, bodies_measured, bodies_noted, one_body
from .circumstances import gone_with, run_numbers
from .condition_table import NUMBERS, ORDERS
from .conditions import PERSON, person_condition, plain_spelling
from .doubt import Doubt, names_of
from .file_result import REFUSED, FileResult
from .readings import NO_CHECKS, NO_ZERO
from .tables import group_files

_JUDGED, _UNLIKE = 8, 0.3  # trials needed; ln of RCOF over the person's others; assumed
_NAMED = 6  # files that a reason names
_STEP = ("contact", "peak_force")  # what tells one step from all others
_TIMES, _ALIKE, _CORRELATED, _NOISE = 0.004, 0.004, 0.6, 120
"""Two steps are one: stance time (s), forces over their peak (rms; steps of one person differ by
0.02 and more), correlation of the second differences of so many samples (by chance 0.09)."""
_SIDE = re.compile(
    r"(.*[^\W_])([ _-]?)(l|r|left|right|li|re|links|rechts|g|d|gauche|droite)", re.IGNORECASE
)
_PAIRS, _SURE = 8, 4.0
_PLATES = {"rcof": 0.08, "peak_force": 0.04}
"""Recordings and standard errors that tell two plates apart, and how far (logarithm) left and right
feet of one person may differ beyond them, who meet the same plates in the same order; assumed."""
_MACHINES = ("machine", "tribometer", "device", "tester", "instrument", "gerät", "maschine")
_MOST = 0.5  # share of the files from which a condition counts as meant for all


def guarded_files(
    recordings: Sequence[Sequence[FileResult]],
) -> tuple[list[FileResult], list[Doubt]]:
    """Return all results with copies refused, and the doubts about copies.

    Of equal bytes, numbers or steps (a copy cut, filtered, or exported with another start or gain)
    under two names the first counts, where all that is noted agrees.
    Where it does not, nobody knows whose they are, and none counts.
    """
    bytes_of: dict[object, list[int]] = defaultdict(list)
    numbers_of: dict[object, list[int]] = defaultdict(list)
    for i, results in enumerate(recordings):
        if results and results[0].checksum:
            bytes_of[results[0].checksum].append(i)
        values = [v for result in results for v in result.facts.values()]
        values += [m.value for result in results for m in result.measurements]
        values += [
            getattr(step, key) for result in results for step in result.steps for key in _STEP
        ]
        numbers = tuple(float(f"{v:.6g}") for v in values if isinstance(v, float) and v % 1.0)
        if len(numbers) >= 3:
            numbers_of[numbers].append(i)
    equal = [*bytes_of.values(), *numbers_of.values()]
    doubts: list[Doubt] = []
    refused: dict[int, tuple[Message, Message]] = {}
    for members in _join_groups([*equal, *_with_same_steps(recordings)], len(recordings)):
        alike = ("bytes", bytes_of), ("numbers", numbers_of)
        shared = next((name for name, kind in alike if members in kind.values()), "steps")
        what = Message("the same {shared}", shared=shared)
        names = tuple(recordings[i][0].file for i in members)
        noted = [_noted_conditions(recordings[i][0]) for i in members]
        same = all(one == noted[0] for one in noted)
        words = Message("{what} as {file}, which counts", what=what, file=names[0])
        if not same:
            words = Message(
                "{what}, noted differently: nobody knows whose they are, none counts", what=what
            )
        doubts.append(Doubt(words, names[1:] if same else names, True))
        listed = ", ".join(names[:_NAMED]) + (" ..." if len(names) > _NAMED else "")
        refused |= dict.fromkeys(
            members[1:] if same else members,
            (
                Message("{what} as {file}", what=what, file=names[0]),
                Message("{what} as another file", what=what),
            )
            if same
            else (
                Message("{what} under {files}, noted differently", what=what, files=listed),
                Message("{what}, noted differently", what=what),
            ),
        )
    files = [
        replace(
            result,
            verdict=REFUSED,
            reasons=(refused[i][0], *result.reasons),
            kinds=(refused[i][1],),
        )
        if i in refused
        else result
        for i, results in enumerate(recordings)
        for result in results
    ]
    return sorted(files, key=lambda one: one.file), doubts


def _join_groups(groups: Iterable[Sequence[int]], count: int) -> list[list[int]]:
    """Return the sets of several of ``count`` recordings that hang together by ``groups``."""
    label = list(range(count))
    for first, *others in (group for group in groups if len(group) > 1):
        joined = {label[other] for other in others}
        label = [label[first] if one in joined else one for one in label]
    found: dict[int, list[int]] = defaultdict(list)
    for i, one in enumerate(label):
        found[one].append(i)
    return [members for members in found.values() if len(members) > 1]


def _with_same_steps(recordings: Sequence[Sequence[FileResult]]) -> set[tuple[int, int]]:
    """Pairs of recordings that share steps: their forces and noise, whatever the gain."""
    shapes, noises, times, owners = [], [], [], []
    for i, results in enumerate(recordings):
        steps = [c for result in results for c in result.curves.get("steps", ()) if "along" in c]
        forces = [c for result in results for c in result.curves.get("normalised", ())]
        for step, curves in zip(steps, forces, strict=False):
            shape = np.concatenate([curves[name][::5] for name in ("vertical", "braking")])
            along = np.diff(np.nan_to_num(step["along"]), 2)
            noise = along[len(along) // 4 :][:_NOISE]
            if len(noise) == _NOISE and noise.any():
                shapes.append(shape / max(float(shape.max()), 1.0))
                noises.append(noise / np.linalg.norm(noise))
                times.append(step["time"][-1])
                owners.append(i)
    order = np.argsort(times)
    time, owner = (np.array(values)[order] for values in (times, owners))
    shape, noise = (np.array(values)[order] for values in (shapes, noises)) if owners else ([], [])
    shared: Counter[tuple[int, int]] = Counter()
    for i, last in enumerate(np.searchsorted(time, time + _TIMES)):
        near = slice(i + 1, last)
        apart = np.sqrt(np.mean((shape[near] - shape[i]) ** 2, axis=1))
        same = (apart < _ALIKE) & (noise[near] @ noise[i] > _CORRELATED)
        for other in owner[near][same]:
            shared[(int(min(owner[i], other)), int(max(owner[i], other)))] += 1
    steps_of = Counter(owners)
    return {
        pair
        for pair, n in shared.items()
        if pair[0] != pair[1] and 2 * n >= min(steps_of[i] for i in pair)
    }


def study_doubts(files: Sequence[FileResult], protocol: Protocol) -> list[Doubt]:
    """Return the doubts about the usable files of a study, each with the files it is about."""
    usable = [file for file in files if file.usable]
    person = person_condition(usable, protocol.text("subject"))
    tables = protocol.kind == "readings"
    doubts = [*_incomplete(usable), *_numbers_lacking(usable), *_near_names(usable, person)]
    doubts += _words_exchanged(usable)
    if not tables:
        doubts += [*_single_levels(usable, person), *_confounded_factors(usable, person)]
    if any(result.steps for result in usable):
        doubts += [*_circumstances(usable, person), *_plates_apart(usable)]
    if person:
        doubts += [*one_body(usable, person), *_sides_as_persons(usable, person)]
        doubts += [*_levels_exchanged(usable, person), *_trials_mislabelled(usable, person)]
        doubts += [*bodies_noted(usable, person), *bodies_measured(usable, person)]
        doubts += [*_crowded_levels(usable, person), *_unlike_trials(usable, person)]
    if protocol.kind == "slip_tester":
        doubts += [*_repeats(usable, protocol), *_drifts(usable, protocol)]
    if protocol.kind in ("slip_tester", "readings"):
        doubts += _not_on_record(usable, protocol)
    return doubts


def _noted_conditions(result: FileResult) -> dict[str, Any]:
    return {k: v for k, v in result.conditions.items() if k not in NUMBERS}


def _factors(files: Sequence[FileResult]) -> dict[str, list[FileResult]]:
    """Return the files that have each condition in words."""
    having: dict[str, list[FileResult]] = defaultdict(list)
    for file in files:
        for key, value in file.conditions.items():
            if isinstance(value, str) and value and key not in NUMBERS:
                having[key].append(file)
    return having


def _incomplete(files: Sequence[FileResult]) -> Iterator[Doubt]:
    for key, having in _factors(files).items():
        named = set(names_of(having))
        lacking = [file for file in files if file.file not in named]
        if not lacking:
            continue
        if len(having) >= _MOST * len(files):
            words = Message(
                '"{key}" is noted for {count} of {all} files, not for these',
                key=key,
                count=len(having),
                all=len(files),
            )
            yield Doubt(words, names_of(lacking), True)
        else:
            words = Message(
                '"{key}" is noted for {count} of {all} files only: no factor',
                key=key,
                count=len(having),
                all=len(files),
            )
            yield Doubt(words, names_of(having))


def _numbers_lacking(files: Sequence[FileResult]) -> Iterator[Doubt]:
    for key in dict.fromkeys(k for file in files for k in file.conditions if k not in NUMBERS):
        lacking = [file for file in files if key not in file.conditions]
        having = len(files) - len(lacking)
        number = any(isinstance(file.conditions.get(key), float) for file in files)
        if number and lacking and having >= _MOST * len(files):
            words = Message(
                '"{key}" is noted for {count} of {all} files, not for these',
                key=key,
                count=having,
                all=len(files),
            )
            yield Doubt(words, names_of(lacking))


def _crowded_levels(files: Sequence[FileResult], person: str) -> Iterator[Doubt]:
    """A person who has twice the trials of a level and lacks another that the others have."""
    for key, having in _factors([file for file in files if person in file.conditions]).items():
        counts = {
            who: Counter(str(result.conditions[key]) for result in results)
            for (who,), results in group_files(having, (person,)).items()
        }
        usual = {
            level: float(np.median([count[level] for count in counts.values()]))
            for level in {level for count in counts.values() for level in count}
        }
        if key == person or 2 * sum(len(count) > 1 for count in counts.values()) <= len(counts):
            continue  # a condition between persons
        for who, count in counts.items():
            lacks = [level for level, n in usual.items() if n >= 1 and not count[level]]
            crowd = [level for level, n in count.items() if n >= 2 * max(usual[level], 1.0)]
            if lacks and crowd:
                words = Message(
                    '{who} has {count} trials with {key} "{level}" and none with "{other}": the '
                    "others {usual:g} with each?",
                    who=who,
                    count=count[crowd[0]],
                    key=key,
                    level=crowd[0],
                    other=sorted(lacks)[0],
                    usual=usual[crowd[0]],
                )
                named = [o for o in having if str(o.conditions[person]) == who]
                yield Doubt(words, names_of([o for o in named if o.conditions[key] == crowd[0]]))


def _unlike_trials(files: Sequence[FileResult], person: str) -> Iterator[Doubt]:
    """A trial whose RCOF lies far from the person's others, levels of conditions allowed for."""
    having = [
        file for file in files if file.main.get("rcof", 0.0) > 0.0 and person in file.conditions
    ]
    left = np.log([result.main["rcof"] for result in having])
    for key in (person, *(k for k in _factors(having) if k != person), person):
        for level in {str(result.conditions.get(key)) for result in having}:
            own = [i for i, result in enumerate(having) if str(result.conditions.get(key)) == level]
            left[own] -= np.median(left[own])
    if len(having) < _JUDGED:
        return
    limit = max(SCATTERS * 1.4826 * float(np.median(np.abs(left))), _UNLIKE)
    for result, away in zip(having, left, strict=True):
        if abs(away) > limit:
            words = Message(
                "RCOF {rcof:.3f}, {change:+.0f} % against the other trials of "
                "{who}: gain, or another?",
                rcof=result.main["rcof"],
                change=100 * np.expm1(away),
                who=result.conditions[person],
            )
            yield Doubt(words, (result.file,))


def _near_names(files: Sequence[FileResult], person: str) -> Iterator[Doubt]:
    """Two levels one slip of the finger apart, one of them rare."""
    for key, having in _factors(files).items():
        counts = Counter(str(result.conditions[key]) for result in having)
        for rare, n in counts.items():
            plain = plain_spelling(rare, person=key in PERSON)
            if len(plain) < 4 or any(letter.isdigit() for letter in plain):
                continue
            for usual, m in counts.items():
                other = plain_spelling(usual, person=key in PERSON)
                if m >= max(2, 3 * n) and _one_slip(plain, other):
                    words = Message(
                        '{key} "{rare}" ({rare_count}) is one letter from "{usual}" '
                        "({usual_count})",
                        key=key,
                        rare=rare,
                        rare_count=n,
                        usual=usual,
                        usual_count=m,
                    )
                    yield Doubt(words, names_of([o for o in having if o.conditions[key] == rare]))


def _one_slip(a: str, b: str) -> bool:
    """True when one letter is wrong, missing, too many, or two neighbours are exchanged."""
    if a == b or abs(len(a) - len(b)) > 1:
        return False
    start = next(
        (i for i, (x, y) in enumerate(zip(a, b, strict=False)) if x != y), min(map(len, (a, b)))
    )
    a, b = a[start:], b[start:]
    return a[1:] == b[1:] or a[1:] == b or a == b[1:] or (a[:2] == b[1::-1] and a[2:] == b[2:])


def _words_exchanged(files: Sequence[FileResult]) -> Iterator[Doubt]:
    """Two levels of the same words in another order: "hard wet" beside "wet hard"."""
    for key, having in _factors(files).items():
        levels = dict.fromkeys(str(result.conditions[key]) for result in having)
        for first, second in combinations(levels, 2) if key not in ORDERS else ():
            if not _same_in_another_order(first, second):
                continue
            both = [[o for o in having if str(o.conditions[key]) == one] for one in (first, second)]
            words = Message(
                '{key} "{first}" ({first_count}) and "{second}" ({second_count}) '
                "are the same words: one level?",
                key=key,
                first=first,
                first_count=len(both[0]),
                second=second,
                second_count=len(both[1]),
            )
            yield Doubt(words, names_of(min(both, key=len)))


def _same_in_another_order(first: str, second: str) -> bool:
    """Whether levels are the same words; numbers stay with the word before them, or after."""
    levels = [re.findall(r"[^\W\d_]+|\d+", one.casefold()) for one in (first, second)]
    if levels[0] == levels[1] or any(sum(not w.isdigit() for w in own) < 2 for own in levels):
        return False
    for way in (1, -1):
        groups: list[list[tuple[str, ...]]] = []
        for own in levels:
            made: list[tuple[str, ...]] = []
            for word in own[::way]:
                number = word.isdigit() and made
                made[-1:] = [(*made[-1], word)] if number else [*made[-1:], (word,)]
            groups.append(sorted(made))
        if groups[0] == groups[1]:
            return True
    return False


def _compared_conditions(files: Sequence[FileResult], person: str) -> dict[str, list[FileResult]]:
    """Return the conditions in words that a study can compare, with the files that have them."""
    return {
        key: having
        for key, having in _factors(files).items()
        if key != person
        and 1 < len({result.conditions[key] for result in having}) < len(having)
        and not names_persons(
            [result.conditions[key] for result in having],
            [result.conditions[person] for result in having if person in result.conditions],
        )
    }


def _confounded_factors(files: Sequence[FileResult], person: str) -> Iterator[Doubt]:
    having = _compared_conditions(files, person)
    every = [key for key, results in having.items() if len(results) == len(files)]
    factors = {key: [str(file.conditions[key]) for file in files] for key in every}
    if len(factors) > 1:
        for confounded in told_apart(factors)[1]:
            words = Message("{pair}: what is found for one may be of the other", pair=confounded)
            yield Doubt(words, ("all",))


def _circumstances(files: Sequence[FileResult], person: str) -> Iterator[Doubt]:
    """A condition that was walked faster or slower than another, or always early or late."""
    for key, having in _compared_conditions(files, person).items():
        if key in ORDERS:
            continue
        for what, means in gone_with(having, key, person).items():
            low, high = min(means, key=means.__getitem__), max(means, key=means.__getitem__)
            words = Message(
                '{key} "{high}" was walked at {fast:.2f} m/s, "{low}" at '
                "{slow:.2f} m/s: RCOF changes with speed",
                key=key,
                high=high,
                fast=means[high],
                low=low,
                slow=means[low],
            )
            if what == "place":
                words = Message(
                    '{key} "{low}" was walked early in the session, "{high}" late: '
                    "order and {key} can't be told apart",
                    key=key,
                    low=low,
                    high=high,
                )
            yield Doubt(words, names_of([o for o in having if o.conditions[key] in (low, high)]))


def _sides_as_persons(files: Sequence[FileResult], person: str) -> Iterator[Doubt]:
    """Left and right of persons noted as two: S01L, S01R; of most where these may be initials."""
    own = group_files(files, (person,))
    sides: dict[str, set[str]] = defaultdict(set)
    sure: dict[str, bool] = {}
    for (who,) in own:
        parts = _SIDE.fullmatch(who)
        if parts:
            stem, gap, side = parts[1], parts[2], parts[3].casefold()
            sides[stem].add(side[0].replace("g", "l").replace("d", "r"))
            sure[stem] = bool(gap) or len(side) > 1 or stem[-1].isdigit()
    # among A to T of one name two letters are no sides
    lettered = Counter(who[:-1] for (who,) in own if who[-1:].isalpha())
    both = [stem for stem, two in sides.items() if len(two) > 1 and lettered[stem] <= 2]
    if any(sure[stem] for stem in both) or (len(both) > 1 and 4 * len(both) > len(own)):
        words = Message(
            "one person is noted twice, by side ({who}): left and right of one person are no two "
            "persons; note the side in a column of its own",
            who=both[0],
        )
        if len(both) > 1:
            words = Message(
                "{count} persons are noted twice, by side ({who}): left and right of one person "
                "are no two persons; note the side in a column of its own",
                count=len(both),
                who=both[0],
            )
        yield Doubt(words, ("all",))


def _levels_exchanged(files: Sequence[FileResult], person: str) -> Iterator[Doubt]:
    """A person whose difference of two levels is that of all others with its sign turned."""
    for key, having in _compared_conditions(files, person).items():
        values = [
            (str(o.conditions[person]), str(o.conditions[key]), np.log(o.main["rcof"]))
            for o in having
            if person in o.conditions and o.main.get("rcof", 0.0) > 0.0
        ]
        cells: dict[str, dict[str, list[float]]] = defaultdict(lambda: defaultdict(list))
        for who, level, value in values:
            cells[who][level].append(float(value))
        for first, second in combinations(dict.fromkeys(level for _, level, _ in values), 2):
            apart = {who: float(np.mean(own[first]) - np.mean(own[second]))
                     for who, own in cells.items() if first in own and second in own}  # fmt: skip
            for who, difference in apart.items():
                others = [d for other, d in apart.items() if other != who]
                if len(others) < 4:
                    continue
                mean, spread = float(np.mean(others)), float(np.std(others, ddof=1))
                turned = abs(difference + mean) < 3.0 * spread < 0.75 * abs(mean)
                if turned and abs(difference - mean) > SCATTERS * spread:
                    words = Message(
                        '{who} has "{first}" and "{second}" ({key}) the other way round '
                        "than all others: labels exchanged?",
                        who=who,
                        first=first,
                        second=second,
                        key=key,
                    )
                    named = [o for o in having if str(o.conditions.get(person)) == who]
                    yield Doubt(
                        words, names_of([o for o in named if o.conditions[key] in (first, second)])
                    )


def _trials_mislabelled(files: Sequence[FileResult], person: str) -> Iterator[Doubt]:
    """A trial far from its person's others with the same label, and as those with another."""
    for key, having in _compared_conditions(files, person).items():
        having = [o for o in having if person in o.conditions and o.main.get("rcof", 0.0) > 0.0]
        cells = group_files(having, (person, key))
        left = [
            np.log(result.main["rcof"]) - np.median([np.log(o.main["rcof"]) for o in results])
            for results in cells.values() if len(results) > 2 for result in results
        ]  # fmt: skip
        if len(left) < 20:
            continue
        scatter = max(1.4826 * float(np.median(np.abs(left))), 1e-3)
        for (who, level), results in cells.items():
            for result in results:
                value = np.log(result.main["rcof"])
                same = [np.log(o.main["rcof"]) for o in results if o is not result]
                if len(same) < 2 or abs(value - np.mean(same)) < SCATTERS * scatter:
                    continue
                for (other, label), those in cells.items():
                    logs = [np.log(o.main["rcof"]) for o in those]
                    near = abs(value - np.mean(logs)) < 3.0 * scatter
                    if other == who and label != level and len(logs) > 1 and near:
                        words = Message(
                            'noted as {key} "{level}", reads as "{label}" of {who}: another label?',
                            key=key,
                            level=level,
                            label=label,
                            who=who,
                        )
                        yield Doubt(words, (result.file,))
                        break


def _single_levels(files: Sequence[FileResult], person: str) -> Iterator[Doubt]:
    for key, having in _factors(files).items():
        counts = Counter(str(result.conditions[key]) for result in having)
        usual = float(np.median(list(counts.values())))
        rare = [level for level, n in counts.items() if n == 1]
        if usual >= 3 and 0 < len(rare) <= 0.5 * len(counts) and key != "date":
            for level in rare:
                words = Message(
                    '{key} "{level}" has one trial, the others {usual:g}',
                    key=key,
                    level=level,
                    usual=usual,
                )
                yield Doubt(words, names_of([o for o in having if o.conditions[key] == level]))


def _plates_apart(files: Sequence[FileResult]) -> Iterator[Doubt]:
    """Two plates that read one walk after the other differently: a gain, crosstalk or compression.

    Of each recording with steps on both the logarithm of the ratio of their numbers; the mean of
    all must lie beyond four standard errors and beyond what feet differ by.
    """
    for key, what in (("rcof", "RCOF"), ("peak_force", "peak of the normal force")):
        ratios: dict[tuple[str, str], list[float]] = defaultdict(list)
        for file in files:
            values: dict[str, list[float]] = defaultdict(list)
            for step in file.steps:
                if (step.rcof or 0.0) > 0.0 and getattr(step, key):
                    values[step.plate].append(float(np.log(getattr(step, key))))
            for pair in combinations(sorted(values), 2):
                ratios[pair].append(float(np.mean(values[pair[0]]) - np.mean(values[pair[1]])))
        for (first, second), logs in ratios.items():
            mean, count = float(np.mean(logs)), len(logs)
            if count < _PAIRS or abs(mean) < _PLATES[key]:
                continue
            if abs(mean) > _SURE * float(np.std(logs, ddof=1)) / count**0.5:
                share = 100.0 * (float(np.exp(mean)) - 1.0)
                words = Message(
                    "{what} is {share:+.0f} % on {first} against {second} in {count} "
                    "recordings: a gain, crosstalk or compression of one of them?",
                    what=what,
                    share=share,
                    first=first,
                    second=second,
                    count=count,
                )
                yield Doubt(words, names_of(files))


def _repeats(files: Sequence[FileResult], protocol: Protocol) -> Iterator[Doubt]:
    """A COF far from the other repeats of the same shoe, floor and fluid."""
    keys = tuple(k for k in protocol.texts("group") if any(k in f.conditions for f in files))
    for level, results in group_files(files, keys).items() if keys else ():
        values = np.array([result.main["cof"] for result in results if "cof" in result.main])
        if len(values) < 4:
            continue
        middle = float(np.median(values))
        usual = 1.4826 * float(np.median(np.abs(values - middle)))
        for result in results:
            away = abs(result.main.get("cof", middle) - middle)
            if away > max(6.0 * usual, 0.15 * middle):
                words = Message(
                    "{level}: COF {cof:.3f} against {usual:.3f} of the other repeats: "
                    "gain or sample?",
                    level=level,
                    cof=result.main["cof"],
                    usual=middle,
                )
                yield Doubt(words, (result.file,))


def _drifts(files: Sequence[FileResult], protocol: Protocol) -> Iterator[Doubt]:
    """Repeats of one shoe, floor and fluid that rise or fall from the first to the last."""
    keys = tuple(k for k in protocol.texts("group") if any(k in f.conditions for f in files))
    for level, results in group_files([f for f in files if "cof" in f.main], keys).items():
        places = run_numbers(results)
        rise = drift(
            [result.main["cof"] for result in sorted(results, key=lambda f: places[f.file])]
        )
        if rise is not None:
            words = Message(
                "{level}: COF {way} by {change:.0f} % from the first run to the last: is the floor "
                "cleaned, does the fluid dry, does the sole wear?",
                level=list(level) or Message("all runs"),
                way=Message("rises") if rise > 0 else Message("falls"),
                change=100 * abs(rise),
            )
            yield Doubt(words, names_of(results))


def _not_on_record(files: Sequence[FileResult], protocol: Protocol) -> Iterator[Doubt]:
    """Yield the checks that need a person, each once."""
    said = [m.conventions for file in files for m in file.measurements]
    if any(c.get("calibration") == UNCALIBRATED for c in said):
        words = Message(
            "no calibration record (calibration.toml): the tester's gain can't be judged"
        )
        yield Doubt(words, ("all",))
    any_machine = protocol.kind == "readings" and not protocol.text("classes")
    unnamed = [
        f for f in files if "cof" in f.main and not any(n in f.conditions for n in _MACHINES)
    ]
    if any_machine and len(unnamed) == len(files) > 0:
        words = Message(
            '"machine" is noted for no reading: another machine gives another '
            "COF, and how far machines differ is not estimated"
        )
        yield Doubt(words, ("all",))
    if protocol.text("quantity") == "ptv":
        lacking = [
            name
            for name, key, without in (("zero runs", "zero", NO_ZERO),
                                       ("check surfaces", "check surfaces", NO_CHECKS))
            if any(c.get(key) == without for c in said)
        ]  # fmt: skip
        if lacking:
            words = Message("not in the table: {names} of the pendulum", names=lacking)
            yield Doubt(words, ("all",))
