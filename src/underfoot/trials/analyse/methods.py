"""The methods paragraph, written from what was done."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from ..protocols import KINDS, Protocol
from .file_result import CAUTION, REFUSED, FileResult
from .study import Study


def methods_paragraphs(
    files: Sequence[FileResult], protocol: Protocol, study: Study, version: str
) -> list[str]:
    """Return paragraphs that say which files were used, how numbers were taken, which tests."""
    counts = Counter(one.verdict for one in files)
    n = len(files)
    first = (
        f"{n} {'file was' if n == 1 else 'files were'} analysed with underfoot {version} by the "
        f"protocol “{protocol.title}” ({KINDS[protocol.kind]}; {protocol.source}). "
        f"{n - counts[REFUSED]} gave usable numbers, {counts[CAUTION]} of them with cautions; "
        f"{counts[REFUSED]} {'was' if counts[REFUSED] == 1 else 'were'} refused."
    )
    paragraphs = [first]
    conventions = _conventions(files)
    conventions += [_DONE[table.name] for table in study.tables if table.name in _DONE]
    if conventions:
        paragraphs.append(" ".join(conventions))
    if protocol.rules:
        words = "; ".join(rule.words() for rule in protocol.rules)
        paragraphs.append(f"Rules checked on every trial: {words}.")
    if study.findings:
        titles = "; ".join(dict.fromkeys(finding.title for finding in study.findings))
        paragraphs.append(
            f"Statistics: {titles}. Alpha is 0.05; intervals cover 95 %. Factors were coded to "
            "sum to zero."
        )
    assumed = protocol.assumptions()
    if assumed:
        paragraphs.append("Set here and not by the source: " + "; ".join(assumed) + ".")
    return paragraphs


_TOLD = {
    "rcof": "Required friction (RCOF)",
    "cof": "Coefficient of friction (COF)",
    "peak slipping speed": "Peak slipping speed",
    "peak pressure": "Peak pressure of a sensor",
    "pressure duration": "Pressure duration",
    "peak force": "Forces of the relaxation test",
    "final force": "Force at the end of the hold",
}


_SENTENCES = {
    "rcof": (
        "Required friction (RCOF) was taken as the {peak} of shear ({shear}) over normal force in "
        "the {searched}, {direction}, with the {gate}; forces were low-passed with: {filter}; "
        "baseline: {baseline}."
    ),
    "peak slipping speed": (
        "Heel speed ({speed}) came from the heel marker, low-passed with: {marker filter}; gaps "
        "were {gaps}. The slip starts at the {slip start}; the peak slipping speed is the largest "
        "speed until the second local minimum, until the foot leaves the plate or until the heel "
        "lifts, and counts as a {threshold}."
    ),
    "peak pressure": (
        "Fluid pressures count above {threshold} (baseline: {baseline}; {run}); pressure duration "
        "is the time {duration}."
    ),
    "final force": "The force at the end of the hold is the {final force}; {zero}.",
    "cof": (
        "COF is the {average} from {window} (sliding start: {sliding start}); shear: {shear}; "
        "{filter}; baseline: {baseline}."
    ),
    "cof from force": (
        "COF is the {average} in a window of {window}; shear: {shear}; {filter}; baseline: "
        "{baseline}."
    ),
    "cof of a disk": "COF is {cof}, the {average} ({window}).",
}


def _general(key: str, value: str) -> str:
    """Leave the numbers of a single file out of a convention."""
    if key == "baseline" and "unloaded samples" in value:
        return "mean force of the unloaded plate subtracted"
    return value


def _sentence(name: str, said: dict[str, str]) -> str:
    """Return a sentence for a paper, or nothing when a convention it needs was not recorded."""
    for key, sentence in _SENTENCES.items():
        if key == name or key.startswith(f"{name} "):
            try:
                return sentence.format_map(said)
            except KeyError:
                continue
    return ""


_DONE = {
    "stribeck": (
        "COF against speed was fitted with COF = asymptote + (COF_BL - asymptote) exp(-v / tau) by "
        "separable bounded least squares with profile-likelihood intervals; fits with R^2 above "
        "0.8 count as good, above 0.5 as moderate, below the mean COF stands for COF_BL."
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


def _conventions(files: Sequence[FileResult]) -> list[str]:
    """Return one sentence for each quantity: the conventions that all or most files share."""
    seen: dict[str, Counter[tuple[tuple[str, str], ...]]] = {}
    # Per-file values (baselines, events) are in the table of measurements, not in the methods.
    private = {"walking direction", "search ends", "sign", "uncertainty"}
    for one in files:
        for m in one.measurements:
            shared = tuple(
                (key, _general(key, value))
                for key, value in m["conventions"].items()
                if key not in private
            )
            average = m["item"] == "mean of the steps"
            if shared and m["value"] is not None and m["name"] in _TOLD and not average:
                seen.setdefault(m["name"], Counter())[shared] += 1
    sentences, told = [], set()
    for name, kinds in seen.items():
        most, count = kinds.most_common(1)[0]
        if most in told or (name == "pressure duration" and "peak pressure" in seen):
            continue
        if name == "peak force" and "final force" in seen:
            continue
        told.add(most)
        words = "; ".join(f"{key}: {value}" for key, value in most)
        sentence = _sentence(name, dict(most)) or f"{_TOLD[name]}: {words}."
        rest = sum(kinds.values()) - count
        sentences.append(sentence + (f" {rest} numbers of it were made otherwise." if rest else ""))
    return sentences
