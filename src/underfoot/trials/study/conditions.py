"""Which files of a folder are trials, and what the laboratory noted about each."""

import csv
import io
import math
import os
import re
import unicodedata
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from underfoot.core import DataError, InputError, nearest_match, units
from underfoot.core.numbers_text import NumberForm, number_forms
from underfoot.core.remark import Message
from underfoot.core.text import decode_text

from ..readers import TrialsProfile, read_profile, trial_suffixes
from ..readers.sheet import is_workbook, workbook_sheets
from ..readers.text import is_number, is_written_number, name_and_unit, si_unit
from ..recording.tester_calibration import written_day
from .file_result import FileResult

NAMES = ("conditions.csv", "conditions.xlsx")
REPORT_MARK = "analysis.txt"  # stands in the folder of a report, which holds no trials
PERSON = ("subject", "person", "participant", "proband", "volunteer", "vp", "id")
SHEET = "sheet"
FILE = ("file", "filename", "file name", "datei", "dateiname")
MASS = ("mass", "body mass", "weight", "body weight", "masse", "körpermasse", "gewicht",
        "körpergewicht")  # fmt: skip
QUANTITIES = {
    "ptv": ("ptv", "srv", "bpn", "pendulum test value", "pendulum", "pendelwert", "srt-wert",
            "ptv wet", "ptv dry"),
    "angle": ("angle", "ramp angle", "acceptance angle", "angle of slip", "winkel",
              "akzeptanzwinkel", "neigungswinkel"),
    "cof": (
        "cof", "dcof", "scof", "coefficient of friction", "friction", "slip resistance", "mu", "μ",
        "slip index", "reibwert", "reibzahl", "gleitreibwert", "gleitreibungskoeffizient",
        "gleitreibwert μ",
    ),
}  # fmt: skip
LARGEST = {"ptv": 150.0, "angle": 45.0, "cof": 3.0}  # no ramp goes beyond 45 deg
_FRICTIONS = ("acof", "rcof", *QUANTITIES["cof"])
_RANGES = {
    **dict.fromkeys(MASS, (10.0, 300.0, "kg", "(kg), (lb)")),
    **dict.fromkeys(("height", "body height", "körpergröße"), (0.5, 2.5, "m", "(m), (cm)")),
    **dict.fromkeys(_FRICTIONS, (0.0, LARGEST["cof"], "", "(%)")),
    **dict.fromkeys(QUANTITIES["ptv"], (0.0, LARGEST["ptv"], "", "(PTV)")),
}
"""Least and largest number, its unit, and headings with a unit, by the name of a column."""
_COMPUTED = {"viscosity": "(cP)", "thickness": "(mm)", "area": "(mm^2)"}
"""Columns from which numbers are computed, so that a unit decides them; their usual headings."""
_SI_UNITS = {
    **{name: si or "1" for name, (_, _, si, _) in _RANGES.items()},
    "viscosity": "Pa*s",
    "thickness": "m",
    "area": "m^2",
    "speed": "m/s",
    "walking speed": "m/s",
}
"""SI unit of what a column holds by its name: a unit of something else is refused."""
_ANGLES = QUANTITIES["angle"]
_SCALE = re.compile(
    r"(shore|asker)[ -]?(a|am|b|c|d|do|e|m|o|oo|0|00|000)?|irhd|ptv|srv|bpn|hr[a-z]|points?|scores?"
    r"|count|#|no|nr",
    re.IGNORECASE,
)
"""Scales that have no SI unit: their numbers stay as they are."""
_EMPTY = ("", "?", "-", "--", "–", "—", ".", "n/a", "#n/a", "n.a.", "n. a.", "na", "nan", "null",
          "missing", "unknown", "unbekannt", "tbd", "k.a.", "k. a.", "keine angabe",
          "fehlt")  # fmt: skip
_DAYS = re.compile(r"(^|[\W_])(date|day|tag)([\W_]|$)|datum$", re.IGNORECASE)
# Names of conditions that number trials: never factors of a test.
NUMBERS = ("n", "no", "nr", "trial", "number", "rep", "repeat", "repetition", "run", "take")
ORDERS = (*NUMBERS, "order", "sequence", "reihenfolge")
COUNTED = (*ORDERS, "reading", "swing", "test", "value", "pass", "cycle", "messung", "schwung",
           "wert", "versuch", "lauf", "wiederholung")  # fmt: skip
"""Columns that number the readings of a sample."""
_MEASURED = ("age", "alter", "temperature", "temp", "temperatur", "humidity", "feuchte",
             "luftfeuchte", "speed", "walking speed", "geschwindigkeit", "bmi", "size", "shoe size",
             "eu size", "schuhgröße", "years", "experience", "jahre", "falls", "slip", "slipped",
             "fall", "fell", "outcome", "gerutscht", "sturz", "ergebnis")  # fmt: skip
"""Columns whose numbers, equal or not, were measured or seen: their values are no levels."""
MOST_LEVELS = 6
"""Different numbers of a column that may be the codes of levels; assumed."""
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
        or _column(own, numbers[name], unit, lines, path.name, name)
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


TableColumns = tuple[list[tuple[str, str, list[str]]], list[int]]
"""(Heading, unit, cells) of each column of a table, and the line number of each row."""


def table_columns(path: Path, needed: Sequence[str]) -> TableColumns:
    """Return the columns of the one table of a file that has a column ``needed``.

    Where none has, those of the first of ``tables_of``. InputError: two of them have it.
    """
    tables = tables_of(path)
    wanted = [
        name
        for name, (columns, _) in tables.items()
        if any(head.casefold() in needed for head, _, _ in columns)
    ]
    if len(wanted) > 1:
        raise InputError(
            Message(
                "several sheets hold such a table, with other headings: {names}",
                names=", ".join(wanted),
            ),
            where=path.name,
            remedy="Write the same headings in each sheet, or keep one",
        )
    return tables[next(iter([*wanted, *tables]))]


def tables_of(path: Path) -> dict[str, TableColumns]:
    """Return the columns of each table of a file, by the first sheet that it stands in.

    Sheets of a workbook with the same headings are one table, with a column "sheet". Empty lines
    and columns without a heading are left out; the first line holds the headings; cells such as
    "n.a.", "-" and "k.A." are empty. Days in a column that says so ("date", "Datum") are written
    one way (2026-03-05). A row with more cells than headings, and two columns of one name, are an
    `InputError`.
    """
    filled = {
        sheet: [(line, row) for line, row in enumerate(rows, start=1) if any(row)]
        for sheet, rows in _sheets(path).items()
    }
    alike: dict[tuple[str, ...], list[str]] = {}
    for sheet, lines in filled.items():
        if lines or len(filled) == 1:
            alike.setdefault(tuple(lines[0][1]) if lines else (), []).append(sheet)
    return {
        sheets[0]: _columns(list(heads), {sheet: filled[sheet][1:] for sheet in sheets}, path.name)
        for heads, sheets in alike.items()
    } or {"": ([], [])}


def _columns(
    headings: list[str], sheets: Mapping[str, list[tuple[int, list[str]]]], where: str
) -> TableColumns:
    heads = [name_and_unit(cell) for cell in headings]
    lines = [pair for rows in sheets.values() for pair in rows]
    for line, row in lines:
        if any(row[len(heads) :]):
            raise InputError(
                Message(
                    "line {line} has {count} cells, the headings are {width}",
                    line=line,
                    count=len(row),
                    width=len(heads),
                ),
                where=where,
                remedy='A comma within a cell ("0,45") needs quotes, or semicolons between cells',
            )
    folded = [name.casefold() for name, _ in heads if name]
    twice = next((name for name in folded if folded.count(name) > 1), "")
    if twice:
        raise InputError(Message('two columns are called "{twice}"', twice=twice), where=where)
    columns = [
        (
            name,
            unit,
            [
                _cell(row[i], days=bool(_DAYS.search(name))) if i < len(row) else ""
                for _, row in lines
            ],
        )
        for i, (name, unit) in enumerate(heads)
        if name
    ]
    if len(sheets) > 1 and SHEET not in folded:
        columns.append((SHEET, "", [sheet for sheet, rows in sheets.items() for _ in rows]))
    return columns, [line for line, _ in lines]


def _cell(text: str, *, days: bool) -> str:
    """Return a cell as the rest of a table is read: nothing where it says nothing, a day as one."""
    if text.casefold() in _EMPTY:
        return ""
    day = written_day(text) if days else None
    return text if day is None else day.isoformat()


def numbers_of_columns(
    cells: Mapping[str, Sequence[str]], where: str
) -> dict[str, list[float | None]]:
    """Return the numbers of each column, None where a cell is empty or holds no finite one.

    DataError: a number can be two and nothing in the table decides.
    """
    numeric = {n: own for n, own in cells.items() if all(map(is_written_number, filter(None, own)))}
    forms = dict(zip(numeric, number_forms(list(numeric.values()), where), strict=True))
    return {n: [_number(c, forms.get(n, NumberForm())) for c in own] for n, own in cells.items()}


def coded_levels(
    name: str,
    unit: str,
    numbers: Sequence[float | None],
    persons: Sequence[str] = (),
    *,
    most: int = MOST_LEVELS,
    fewest: int = 2,
) -> list[str] | None:
    """Return the levels that a column of numbers stands for (shoe 1, 2, 3; hardness 45, 60).

    None where it holds measured numbers: a quantity with a unit or a known range, numbers that are
    not whole, more than ``most`` of them, or one that comes less than ``fewest`` times (among
    several persons: that fewer persons have).

    Parameters:
        name: Heading of the column, in small letters.
        unit: Its unit as written, or nothing; numbers on a scale (Shore A) can be levels.
        numbers: One a row, None in an empty cell.
        persons: Who walked in each row; empty where nobody is named.
        most: Different numbers that can be levels.
        fewest: Rows, or persons, of each.
    """
    quantities = {*_RANGES, *_ANGLES, *_MEASURED, *COUNTED, *_COMPUTED}
    if name in quantities or (unit and not _SCALE.fullmatch(unit)):
        return None
    rows: dict[float, list[int]] = {}
    for i, number in enumerate(numbers):
        if number is not None:
            rows.setdefault(number, []).append(i)
    several = len(set(persons)) > 1
    units_of = [len({persons[i] for i in own} if several else own) for own in rows.values()]
    if not 1 < len(rows) <= most or min(units_of) < fewest or any(number % 1 for number in rows):
        return None
    return ["" if number is None else f"{number:g} {unit}".strip() for number in numbers]


def first_text(cells: Sequence[str], numbers: Sequence[float | None]) -> int | None:
    """Return the place of a column's first filled cell that holds no number."""
    pairs = enumerate(zip(cells, numbers, strict=True))
    return next((i for i, (cell, number) in pairs if cell and number is None), None)


def _number(cell: str, form: NumberForm) -> float | None:
    try:
        number = form.number(cell)
    except ValueError:
        return None
    return number if is_number(form.plain(cell)) and math.isfinite(number) else None


def profile_of(folder: Path, given: Path | None) -> tuple[TrialsProfile, str]:
    """Return the given profile, else that of the folder, else the plain one; and its text."""
    path = given or folder / "profile.toml"
    if given is None and not path.is_file():
        return TrialsProfile(), ""
    return read_profile(path), path.read_text(encoding="utf-8-sig")


def _sheets(path: Path) -> dict[str, list[list[str]]]:
    """Return the cells of each sheet of a CSV or XLSX file, row by row; errors as `InputError`."""
    try:
        data = path.read_bytes()
    except OSError as error:
        raise InputError(
            Message("can't be read: {strerror}", strerror=error.strerror or error), where=str(path)
        ) from error
    if is_workbook(data):
        try:
            return workbook_sheets(data, path.name)
        except DataError as error:
            raise InputError(error.what, where=path.name) from error
    try:
        text = decode_text(data, path.name)
    except DataError as error:
        raise InputError(error.what, where=path.name) from error
    lines = csv.reader(io.StringIO(text), delimiter=table_delimiter(text))
    return {"": [[cell.strip() for cell in row] for row in lines]}


def table_delimiter(text: str) -> str:
    """Return what divides the headings of a CSV table: comma, semicolon or tab."""
    return max(",;\t", key=text.split("\n", 1)[0].count)


def _column(
    cells: list[str],
    numbers: Sequence[float | None],
    unit: str,
    lines: Sequence[int],
    where: str,
    name: str,
) -> list[Any]:
    """Return a column in SI, or as text where not every cell is a number."""
    bad = first_text(cells, numbers)
    if bad is not None and not unit and name in _SI_UNITS and name not in _RANGES:
        written = _quantities(cells, _SI_UNITS[name])
        return list(cells) if written is None else written
    if bad is not None and (name in MASS or si_unit(unit) or _is_si(unit)):
        raise InputError(
            Message('line {line}: {name} is "{cell}"', line=lines[bad], name=name, cell=cells[bad]),
            where=where,
            allowed="a number; its unit stands in the heading, as in mass (kg)",
        )
    if bad is not None or not any(cells):
        return list(cells)
    if name in _COMPUTED and not unit:
        raise InputError(
            Message("{name} has no unit", name=name),
            where=where,
            remedy=Message(
                "Write the unit in the heading: {name} {unit}", name=name, unit=_COMPUTED[name]
            ),
        )
    place = Message("{file}, column {column}", file=where, column=name)
    if unit and name in _SI_UNITS:
        _refuse_other_unit(unit, _SI_UNITS[name], place)
    factor, offset = _to_si(unit, place)
    values = [None if number is None else number * factor + offset for number in numbers]
    low, high, si, headings = _RANGES.get(name, (-math.inf, math.inf, "", ""))
    if name in _ANGLES:
        high = math.radians(LARGEST["angle"]) if unit else LARGEST["angle"]
        low, si, headings = -high, "rad" if unit else "deg", "(deg), (rad)"
    for i, value in enumerate(values):
        if value is not None and not low <= value <= high:
            raise InputError(
                Message('line {line}: {name} is "{cell}"', line=lines[i], name=name, cell=cells[i]),
                where=where,
                allowed=f"{low:g} to {high:g} {si}".strip(),
                remedy=Message(
                    "Write the unit in the heading: {headings}",
                    headings=headings.replace("(", f"{name} ("),
                ),
            )
    return values


def body_mass_noted(noted: Mapping[str, Any]) -> float | None:
    """Return the person's mass (kg) among the conditions of a file, or None."""
    return next((float(noted[k]) for k in MASS if isinstance(noted.get(k), float)), None)


def _quantities(cells: Sequence[str], si: str) -> list[float | None] | None:
    """Return cells that each hold a number with its unit ("6 cP"); None where one is a word."""
    try:
        return [units.to_si(cell, si, where="") if cell else None for cell in cells]
    except InputError:
        return None


def _refuse_other_unit(unit: str, si: str, where: str) -> None:
    """Refuse a unit of something else than the column holds (an area in mm, a mass in cm)."""
    if _SCALE.fullmatch(unit):
        return
    known = si_unit(unit)
    plain = known[0] if known and unit not in ("g", "mN", "MN") else unit
    if plain == si:
        return
    try:
        units.to_si(f"1 {plain}", si, where=where)
    except InputError as error:
        allowed = "a number" if si == "1" else Message("a unit of {si}", si=si)
        raise InputError(
            Message('is in "{unit}"', unit=unit), where=where, allowed=allowed
        ) from error


def _is_si(unit: str) -> bool:
    try:
        return units.si_unit(f"1 {unit}", where="") != "1"
    except InputError:  # of a scale, or no unit but a word of the heading
        return False


def _to_si(unit: str, where: str) -> tuple[float, float]:
    """Return factor and offset of a unit written in a heading; none leaves numbers as they are."""
    if not unit or _SCALE.fullmatch(unit):
        return 1.0, 0.0
    known = si_unit(unit)
    # "g" is a force in tribometer logs and a mass here.
    if known and unit not in ("g", "mN", "MN"):
        return known[1], known[2]
    return units.to_si(f"1 {unit}", units.si_unit(f"1 {unit}", where=where), where=where), 0.0
