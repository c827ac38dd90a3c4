"""Whose body a recording shows: one under two names, another in the place of a person."""

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations
from math import gamma
from statistics import median

import numpy as np

from underfoot.core.remark import Message

from .condition_table import MASS
from .doubt import Doubt, names_of
from .file_result import FileResult
from .person_measures import FORCE, HEIGHT
from .tables import group_files

_BODY = {
    **dict.fromkeys(MASS, 0.05), "height": 0.02, "body height": 0.02, "sex": 0.0, "gender": 0.0
}  # fmt: skip
"""Conditions that a person keeps, and how far they may differ (relative)."""
_MEASURED = {FORCE: "mean force in stance", HEIGHT: "height of the highest marker"}
_LEAST, SCATTERS = 0.02, 6.0
_LARGEST = {FORCE: 0.10, HEIGHT: 0.04, "": 0.05}
"""A body is another's from six times the scatter within the study's persons, but at least 2 %, and
from these shares on whatever the scatter (relative; "" distances of markers); assumed."""
_SAME, _COUNTED, _ODDS, _CHANCE = 0.002, 3, 100.0, 0.01
_APART = {FORCE: 0.12, HEIGHT: 0.04, "": 0.04}
"""Scatter of a body's measures that is the least, and that between persons (relative; "" distances
of markers); distances count as so many measures at most, for they grow together; likelihood of one
body over that of two from which it is told, and chance that two of the study's persons have so
much; assumed."""


def one_body(files: Sequence[FileResult], person: str) -> Iterator[Doubt]:
    """Two persons with one body: weight, height and distances of markers agree as repeats do."""
    bodies: dict[str, list[Mapping[str, float]]] = {
        who: [result.body for result in results if result.body]
        for (who,), results in group_files(files, (person,)).items()
    }
    usual = {who: {name: median([b[name] for b in results if name in b]) for name in results[0]}
             for who, results in bodies.items() if results}  # fmt: skip
    names = dict.fromkeys(name for body in usual.values() for name in body)
    within: dict[str, float] = {}
    for name in names:
        values = [np.log(body[name]) for body in usual.values() if body.get(name, 0.0) > 0.0]
        off = [
            np.log(b[name] / usual[who][name]) * (len(results) / (len(results) - 1.0)) ** 0.5
            for who, results in bodies.items()
            for b in results
            if len(results) > 1 and b.get(name, 0.0) > 0.0 and usual[who].get(name, 0.0) > 0.0
        ]
        if len(off) < 3 or len(values) < 2:
            continue
        scatter = max(1.4826 * float(np.median(np.abs(off))), _SAME)
        # distances on a plate of markers are those of everybody who wears it; of two persons none
        # can be told from these, and all of them count as one
        if len(values) == 2 or float(np.ptp(values)) > 4.0 * scatter:
            within[name] = scatter
    pairs = list(combinations(sorted(usual), 2))
    counted = _COUNTED if len(pairs) > 1 else 1
    for one, other in pairs:
        shared = [n for n in within if n in usual[one] and n in usual[other]]
        evidence: dict[str, list[tuple[float, float]]] = defaultdict(list)
        for name in shared:
            apart = float(np.log(usual[one][name] / usual[other][name]))
            share = 1.0 / len(bodies[one]) + 1.0 / len(bodies[other])
            same = _SAME**2 + share * within[name] ** 2
            differ = same + 2.0 * _APART[_kind(name)] ** 2
            most = 0.5 * float(np.log(differ / same))
            evidence[_kind(name)].append((most, 0.5 * apart**2 * (1.0 / same - 1.0 / differ)))
        if not evidence:
            continue
        counts = [min(len(results), counted) for results in evidence.values()]
        means = [np.mean(results, axis=0) for results in evidence.values()]
        most, lost = np.sum([n * mean for n, mean in zip(counts, means, strict=True)], axis=0)
        # chi-square of two bodies below 2 lost, by its density at 0, which is the highest
        half = 0.5 * sum(counts)
        chance = float(np.exp(-most) * lost**half / gamma(half + 1.0))
        if most - lost > np.log(_ODDS) and chance * len(pairs) < _CHANCE:
            words = Message(
                "{who} and {other} have one body: {count} measures of it agree as "
                "those of one person's trials do; one person under two names?",
                who=one,
                other=other,
                count=len(shared),
            )
            yield Doubt(
                words, names_of([f for f in files if str(f.conditions.get(person)) == other])
            )


def bodies_noted(files: Sequence[FileResult], person: str) -> Iterator[Doubt]:
    """A person who is noted with two bodies."""
    for (who,), results in group_files(files, (person,)).items():
        for key, limit in _BODY.items():
            noted = {result.conditions[key] for result in results if key in result.conditions}
            numbers = [value for value in noted if isinstance(value, float)]
            apart = len(numbers) > 1 and max(numbers) > (1.0 + limit) * min(numbers)
            if apart or (len(noted) > 1 and not numbers):
                listed = ", ".join(f"{v:g}" if isinstance(v, float) else v for v in sorted(noted))
                words = Message(
                    "{key} of {who} is noted as {values}", key=key, who=who, values=listed
                )
                yield Doubt(words, names_of(results))


def bodies_measured(files: Sequence[FileResult], person: str) -> Iterator[Doubt]:
    """A recording that shows another body than the person's other recordings."""
    measured = {
        who: [(result.file, result.body) for result in results if result.body]
        for (who,), results in group_files(files, (person,)).items()
    }
    away: dict[tuple[str, str], dict[str, float]] = {}
    for who, results in measured.items():
        for file, body in results:
            others = [other for name, other in results if name != file]
            middles = {name: _middle(others, name) for name in body}
            away[who, file] = {n: body[n] / middle - 1.0 for n, middle in middles.items() if middle}
    limits = {}
    for kind, largest in _LARGEST.items():
        sizes = [abs(v) for one in away.values() for name, v in one.items() if _kind(name) == kind]
        scatter = 1.4826 * float(np.median(sizes)) if sizes else largest
        limits[kind] = min(max(SCATTERS * scatter, _LEAST), largest)
    usual = {
        who: {name: _middle([body for _, body in results], name) for name in results[0][1]}
        for who, results in measured.items()
        if results
    }
    for (who, file), one in away.items():
        beyond = {name: value for name, value in one.items() if abs(value) > limits[_kind(name)]}
        distances, wrong = (sum(not _kind(name) for name in part) for part in (one, beyond))
        texts = [
            Message("{measure} {change:+.0f} %", measure=_MEASURED[name], change=100 * v)
            for name, v in beyond.items()
            if name in _MEASURED
        ]
        if wrong > max(1, 0.3 * distances):
            texts.append(
                Message(
                    "{wrong} of {distances} distances of markers", wrong=wrong, distances=distances
                )
            )
        if texts:
            words = Message(
                "another person in the place of {who}? {texts:; } against the others{nearest}",
                who=who,
                texts=texts,
                nearest=_nearest(dict(measured[who])[file], who, usual),
            )
            yield Doubt(words, (file,))


def _kind(measure: str) -> str:
    return measure if measure in _LARGEST else ""


def _middle(bodies: Sequence[Mapping[str, float]], name: str) -> float:
    values = [body[name] for body in bodies if name in body]
    return median(values) if len(values) >= 2 else 0.0


def _nearest(body: Mapping[str, float], who: str, usual: Mapping[str, Mapping[str, float]]) -> str:
    """Return who of the others has the body, where somebody has."""
    distances = {}
    for other, middles in usual.items():
        shared = [abs(body[name] / m - 1.0) for name, m in middles.items() if m and name in body]
        if other != who and shared:
            distances[other] = max(shared)
    best = min(distances, key=lambda name: distances[name], default="")
    return Message(", nearest {who}", who=best) if best and distances[best] < _LEAST else ""
