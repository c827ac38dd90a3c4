"""Which files of a folder are trials, and what the laboratory noted about each."""

import os
import re
import unicodedata
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from underfoot.core import DataError, InputError, nearest_match
from underfoot.core.remark import Message

from ..readers import TrialsProfile, read_profile, trial_suffixes
from ..readers.text import is_number
from .condition_table import (
    MASS,
    coded_levels,
    column_values,
    numbers_of_columns,
    table_columns,
)
from .file_result import FileResult

NAMES = ("conditions.csv", "conditions.xlsx")
REPORT_MARK = "analysis.txt"  # stands in the folder of a report, which holds no trials
PERSON = ("subject", "person", "participant", "proband", "volunteer", "vp", "id")
FILE = ("file", "filename", "file name", "datei", "dateiname")
_NOT_TRIALS = re.compile(
    r"(conditions|edits|truth|synthetic|notes?|notizen|read[-_ ]?me|liesmich|licen[cs]e|protocol"
    r"|todo|session[-_ ]?metadata)([-_ .].*)?$",
    re.IGNORECASE,
)
_PERSON_FOLDER = re.compile(
    r"(s|p|vp|sub|subj|subject|person|participant|proband|id)[-_ ]?0*\d+\w?$", re.IGNORECASE
)
_FORCES = (".forces", ".mot", ".sto")


def _label(path: Path, folder: Path) -> str:
    return path.relative_to(folder).as_posix()


@dataclass(frozen=True, slots=True)
class Recording:
    """Files that belong to one recording; ``name`` is the path below the folder of the study."""

    name: str
    paths: tuple[Path, ...]
    conditions: Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class StudyFolder:
    """The recordings of a folder and of those below it; ``notes`` name files left aside."""

    recordings: tuple[Recording, ...]
    notes: tuple[str, ...]


def study_folder(
    folder: Path, *, conditions: Path | None = None, names: str = "", merge_spelling: bool = False
) -> StudyFolder:
    """Return the recordings in a folder with their conditions.

    Conditions come from tables (``conditions.csv`` or ``.xlsx`` in the folder or beside the files,
    or the table ``conditions``), from ``names`` (a regular expression with named groups, searched
    in each path below ``folder`` without its ending, such as
    ``S(?P<subject>\\d+)_(?P<shoe>[a-z]+)_(?P<n>\\d+)``), or else from the folders: a level whose
    folders are called like ``S01`` or ``subject 7`` names the person, another level with several
    folders is a condition called "folder". Spellings that differ in capitals, blanks, "-" or "_"
    are one with ``merge_spelling``. An `InputError` says that there is no such folder or no trial
    file, that a table or pattern is wrong, that two sources describe a file differently, or that a
    condition has several spellings.
    """
    groups, notes = _groups(folder)
    labels = [_label(group[0], folder) for group in groups]
    noted_by_file = [_session(group[0], folder) for group in groups]
    for noted, label, added in zip(noted_by_file, labels, _from_names(labels, names), strict=True):
        _add(noted, added, label)
    members = {_label(p, folder): i for i, group in enumerate(groups) for p in group}
    for table, below in _tables(folder, conditions):
        described = conditions_of(below, table)
        absent = []
        for file, added in described.items():
            label = named_file(file, list(members), _label(below, folder))
            if label is None:
                absent.append(file)
                continue
            _add(noted_by_file[members[label]], added, label)
        if absent and len(absent) == len(described):
            raise InputError(
                Message(
                    'none of its {count} files is in the folder, the first is "{absent}"',
                    count=len(absent),
                    absent=absent[0],
                ),
                where=table.name,
                allowed=", ".join(sorted(members)[:3]) + " ...",
                nearest=nearest_match(absent[0], members),
            )
        notes += [
            Message("{file}: in {table}, but there is no such file", file=file, table=table.name)
            for file in absent
        ]
    one_spelling(noted_by_file, merge_spelling)
    recordings = tuple(
        Recording(label, tuple(group), noted)
        for label, group, noted in zip(labels, groups, noted_by_file, strict=True)
    )
    return StudyFolder(tuple(sorted(recordings, key=lambda r: r.name)), tuple(notes))


def named_file(name: str, labels: Sequence[str], below: str = ".") -> str | None:
    """Return the one file that a table names, by its path or its bare name; None if absent.

    Capitals don't matter, and the ending may be left out. A name that stands for several files is
    an `InputError`.
    """
    plain = name.replace("\\", "/")
    if plain in labels:
        return plain
    plain = plain.casefold()
    inside = plain if below in (".", "") else f"{below.casefold()}/{plain}"
    folded = {label: label.casefold() for label in labels}
    own = {label: text.rsplit("/", 1)[-1] for label, text in folded.items()}
    bare = {label: text.rsplit(".", 1)[0] for label, text in own.items()}
    for wanted, known in ((inside, folded), (plain, own), (plain, bare)):
        same = [label for label, text in known.items() if text == wanted]
        if same:
            break
    if len(same) > 1:
        text = Message(
            '"{name}" names {count} files: {same}',
            name=name,
            count=len(same),
            same=", ".join(same[:4]),
        )
        raise InputError(text, where="file", remedy="Write the folder too")
    return same[0] if same else None


def _groups(folder: Path) -> tuple[list[list[Path]], list[str]]:
    """Return trial files, markers joined with the forces of the same name, and notes."""
    if not folder.is_dir():
        raise InputError(Message("there is no folder {folder}", folder=folder), where="FOLDER")
    trials: list[Path] = []
    suffixes = trial_suffixes()
    notes: list[str] = []
    for place, below, files in os.walk(folder):
        if REPORT_MARK in files and Path(place) != folder:
            below.clear()
            notes.append(
                Message("{place}: holds a report, left aside", place=_label(Path(place), folder))
            )
            continue
        below[:] = sorted(name for name in below if not name.startswith("."))
        for name in sorted(files):
            path = Path(place) / name
            ending = path.suffix.casefold()
            if name.startswith(".") or ending == ".toml" or name == REPORT_MARK:
                continue
            if _NOT_TRIALS.match(path.stem) and ending not in (".c3d", ".trc"):
                if not re.match("conditions|edits|truth|synthetic|session", name, re.IGNORECASE):
                    notes.append(
                        Message("{path}: notes by its name, not a trial", path=_label(path, folder))
                    )
            elif ending in suffixes:
                trials.append(path)
            else:
                notes.append(
                    Message(
                        "{path}: not a measurement file by its ending, left aside",
                        path=_label(path, folder),
                    )
                )
    if not trials:
        raise InputError(
            Message("the folder {folder} holds no trial file", folder=folder),
            where="FOLDER",
            allowed=", ".join(suffixes),
        )
    markers = {_stem(path): path for path in trials if path.suffix.casefold() == ".trc"}
    partners = {p for p in trials if p.suffix.casefold() in _FORCES and _stem(p) in markers}
    return [
        [path, *sorted(p for p in partners if markers[_stem(p)] == path)]
        for path in trials
        if path not in partners
    ], notes


def _stem(path: Path) -> Path:
    """Path without ending; OpenCap keeps markers and motions of one trial in two folders."""
    place = path.parent
    if place.name == "MarkerData":
        place = place.parent
    elif place.name == "Kinematics" and place.parent.name == "OpenSimData":
        place = place.parent.parent
    return place / path.stem


def _session(path: Path, folder: Path) -> dict[str, Any]:
    """Return person and mass of an OpenCap session (sessionMetadata.yaml above the file)."""
    for place in path.parents:
        meta = place / "sessionMetadata.yaml"
        if meta.is_file():
            text = meta.read_text(encoding="utf-8", errors="replace")
            pairs = dict(re.findall(r"^(\w+):[ \t]*['\"]?([^'\"\n#]+)", text, re.MULTILINE))
            noted: dict[str, Any] = {"subject": str(pairs.get("subjectID", place.name)).strip()}
            mass = pairs.get("mass_kg", "").strip()
            if is_number(mass):
                noted["mass"] = float(mass)
            return noted
        if place == folder:
            break
    return {}


def _from_names(labels: Sequence[str], names: str) -> list[dict[str, Any]]:
    if not names:
        return _from_folders(labels)
    try:
        pattern = re.compile(names)
    except re.error as error:
        raise InputError(
            Message("the pattern of names is wrong: {error}", error=error), where="names"
        ) from error
    if not pattern.groupindex:
        allowed = r"for example S(?P<subject>\d+)_(?P<shoe>[a-z]+)_(?P<n>\d+)"
        text = "the pattern of names has no named group"
        raise InputError(text, where="names", allowed=allowed)
    matches = [pattern.search(label.rsplit(".", 1)[0]) for label in labels]
    without = [label for label, match in zip(labels, matches, strict=True) if match is None]
    if without:
        raise InputError(
            Message(
                "{count} of {total} names do not match the pattern {pattern}",
                count=len(without),
                total=len(labels),
                pattern=names,
            ),
            where="names",
            allowed=Message(
                "names such as the first one that fails: {without}", without=without[0]
            ),
            remedy="Correct the pattern, rename the files, or note conditions in conditions.csv",
        )
    return [
        {key.casefold(): value for key, value in match.groupdict().items() if value}
        for match in matches
        if match
    ]


def _from_folders(labels: Sequence[str]) -> list[dict[str, Any]]:
    parents = [label.split("/")[:-1] for label in labels]
    noted: list[dict[str, Any]] = [{} for _ in labels]
    for level, values in enumerate(zip(*parents, strict=False)):
        if len(set(values)) < 2 and not _PERSON_FOLDER.match(values[0]):
            continue
        person = all(_PERSON_FOLDER.match(value) for value in values)
        name = "subject" if person else f"folder {level + 1}" if level else "folder"
        for conditions, value in zip(noted, values, strict=True):
            conditions.setdefault(name, value)
    return noted


def _tables(folder: Path, given: Path | None) -> list[tuple[Path, Path]]:
    """Return tables of conditions with the folder that their file names start from."""
    if given is not None:
        return [(given, folder)]
    tables = []
    for place, below, files in os.walk(folder):
        if REPORT_MARK in files and Path(place) != folder:
            below.clear()  # a report has a table of its own called so
            continue
        below[:] = sorted(name for name in below if not name.startswith("."))
        found = [Path(place) / name for name in NAMES if name in files]
        if len(found) > 1:
            text = Message("two tables of conditions: {names}", names=" and ".join(NAMES))
            raise InputError(text, where=place, remedy="Keep one, or name it with --conditions")
        tables += [(path, Path(place)) for path in found]
    return tables


def _add(noted: dict[str, Any], added: Mapping[str, Any], label: str) -> None:
    for key, value in added.items():
        if noted.get(key, value) != value:
            raise InputError(
                Message(
                    '{name} is "{first}" by one source and "{second}" by another',
                    name=key,
                    first=noted[key],
                    second=value,
                ),
                where=label,
                remedy="Correct the table of conditions, the names or the folders",
            )
        noted[key] = value


def one_spelling(noted: Sequence[dict[str, Any]], merge: bool) -> None:
    """Refuse a condition that is written in two ways, or take the usual one with ``merge``.

    Spellings are one when they differ in capitals, blanks, "-", "_", accents (Müller, Mueller) or
    leading zeros (S1, S01); those of a person also in the letters before the number (S01, 01).
    """
    for key in dict.fromkeys(k for own in noted for k in own):
        spellings: dict[str, Counter[str]] = {}
        for conditions in noted:
            if isinstance(conditions.get(key), str):
                plain = plain_spelling(conditions[key], person=key in PERSON)
                spellings.setdefault(plain, Counter())[conditions[key]] += 1
        for counts in spellings.values():
            if len(counts) < 2:
                continue
            written = [
                Message('"{text}" ({count} files)', text=text, count=count)
                for text, count in counts.most_common()
            ]
            if not merge:
                raise InputError(
                    Message("{key} is written {written}", key=key, written=written),
                    where="conditions",
                    remedy="Write it one way, or take the spellings as one with --merge-spelling",
                )
            usual = counts.most_common(1)[0][0]
            for conditions in noted:
                if conditions.get(key) in counts:
                    conditions[key] = usual


def plain_spelling(text: str, *, person: bool = False) -> str:
    """Return a name without what spellings of one name differ in."""
    plain = re.sub(r"[\s_-]+", "", text).casefold()
    for letter, pair in {"ä": "ae", "ö": "oe", "ü": "ue", "ø": "oe", "å": "aa"}.items():
        plain = plain.replace(letter, pair)
    plain = unicodedata.normalize("NFKD", plain).encode("ascii", "ignore").decode() or plain
    plain = re.sub(r"(?<!\d)(?<!\d[.,])0+(?=\d)", "", plain)
    return (
        re.sub(r"^(s|p|vp|subj?|subject|person|participant|proband|id)(?=\d)", "", plain)
        if person
        else plain
    )


def person_condition(files: Iterable[FileResult], preferred: str = "") -> str:
    """Return the name of the condition that says which person a file is of, or nothing."""
    names = {name for file in files for name in file.conditions}
    return next((n for n in (preferred, *PERSON) if n in names), "")


def conditions_of(folder: Path, table: Path | None = None) -> dict[str, dict[str, Any]]:
    """Return the noted conditions by file name: numbers in SI where a unit is written, else text.

    The first line holds the headings, with units in brackets: ``file, shoe, viscosity (cP)``. A
    column counts as numbers when all its filled cells are numbers; "?", "-", "n/a", "unknown" and
    their like are empty cells. ``conditions.csv`` or ``.xlsx``
    in the folder is read when ``table`` is None. An `InputError` says that the table has no column
    "file", names a file twice, or can't be read.
    """
    path = table or next((folder / name for name in NAMES if (folder / name).is_file()), None)
    if path is None:
        return {}
    found, lines = table_columns(path, FILE)
    cells = {name.casefold(): (unit, own) for name, unit, own in found}
    files = next((name for name in FILE if name in cells), "")
    if not files:
        raise InputError(
            'the table of conditions has no column "file"',
            where=path.name,
            allowed=", ".join(cells) or "headings in the first line",
            nearest=nearest_match("file", cells),
        )
    try:
        numbers = numbers_of_columns({name: own for name, (_, own) in cells.items()}, path.name)
    except DataError as error:
        raise InputError(error.what, where=path.name, remedy=error.remedy) from error
    # A person called 1, 2, 3 is a name, not a number.
    persons = next((own for name, (_, own) in cells.items() if name in PERSON), ())
    columns = {
        name: own
        if name in PERSON
        else coded_levels(name, unit, numbers[name], persons)
        or column_values(own, numbers[name], unit, lines, path.name, name)
        for name, (unit, own) in cells.items()
        if name != files
    }
    if not any(cells[files][1]):
        raise InputError("the table of conditions has no row with a file", where=path.name)
    noted: dict[str, dict[str, Any]] = {}
    for number, file in enumerate(cells[files][1]):
        if not file:
            continue
        if file in noted:
            raise InputError(Message('"{file}" is named twice', file=file), where=path.name)
        noted[file] = {n: c[number] for n, c in columns.items() if c[number] not in ("", None)}
    return noted


def profile_of(folder: Path, given: Path | None) -> tuple[TrialsProfile, str]:
    """Return the given profile, else that of the folder, else the plain one; and its text."""
    path = given or folder / "profile.toml"
    if given is None and not path.is_file():
        return TrialsProfile(), ""
    return read_profile(path), path.read_text(encoding="utf-8-sig")


def body_mass_noted(noted: Mapping[str, Any]) -> float | None:
    """Return the person's mass (kg) among the conditions of a file, or None."""
    return next((float(noted[k]) for k in MASS if isinstance(noted.get(k), float)), None)
