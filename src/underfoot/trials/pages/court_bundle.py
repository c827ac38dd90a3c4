"""The audit bundle of an analysis of trials: recordings, checksums, report, one page to sign."""

from __future__ import annotations

import json
import platform
import shutil
from collections.abc import Collection, Mapping, Sequence
from hashlib import sha256
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from underfoot.core import InputError, Progress, UnderfootError, silent
from underfoot.core.files import checksum
from underfoot.core.html import environment
from underfoot.core.provenance import package_version, program_hash
from underfoot.core.remark import Message, Remark

from ..recording.protocols import protocol
from ..study import analyse_folder
from ..study.tables import measurement_table
from .report import STORE, csv_text, lead_sentence, page_table, write_trials_report

if TYPE_CHECKING:
    from ..study import FolderAnalysis

SUMS, PAGE, SETTINGS, RECORDINGS = "SHA256SUMS", "audit.html", "bundle.json", "recordings"
_REPORT, _CATALOGUE, _NUMBERS = "report", "catalogue", "tables/measurements.csv"
_UNKNOWN = "0" * 64  # where the page names the checksum of the checksums
_ALL = 100_000  # rows: a court wants every number


def write_bundle(
    analysis: FolderAnalysis,
    source: Path,
    out: Path,
    settings: Mapping[str, Any],
    catalogues: Sequence[Path] = (),
    *,
    processes: int | None = None,
    progress: Progress = silent,
) -> Path:
    """Write the bundle of an analysis of ``source`` into the folder ``out``; return its page.

    ``recordings/``: the folder as analysed. ``report/``: report, tables, figures. ``catalogue/``:
    the user's own catalogue. ``bundle.json``: ``settings``, the arguments that make the analysis
    again, and the checksum of the page before it names that of ``SHA256SUMS``. ``SHA256SUMS``: all
    of these. ``audit.html``: files, edits, calibration, method, numbers with u, versions, the
    checksum of ``SHA256SUMS`` and room to sign.
    """
    shutil.copytree(source, out / RECORDINGS, ignore=shutil.ignore_patterns(".*"))
    for folder in catalogues:
        for path in folder.glob("*.toml"):
            (out / _CATALOGUE).mkdir(exist_ok=True)
            shutil.copy(path, out / _CATALOGUE)
    write_trials_report(analysis, out / _REPORT, processes=processes, progress=progress)
    shutil.rmtree(out / _REPORT / STORE, ignore_errors=True)
    page = sha256(audit_page(analysis, _UNKNOWN).encode()).hexdigest()
    text = json.dumps({**settings, "versions": _versions(), "page": page}, indent=2)
    (out / SETTINGS).write_text(text + "\n", encoding="utf-8")
    sums = "".join(
        f"{checksum(path)}  {path.relative_to(out).as_posix()}\n" for path in _files(out)
    )
    (out / SUMS).write_text(sums, encoding="utf-8")
    (out / PAGE).write_bytes(audit_page(analysis, checksum(out / SUMS)).encode("utf-8"))
    return out / PAGE


def audit_page(analysis: FolderAnalysis, fingerprint: str) -> str:
    """Return the page to sign as HTML text; ``fingerprint`` is the checksum of the checksums."""
    known = {table.name: page_table(table, limit=_ALL) for table in analysis.tables}
    said = dict.fromkeys(
        m.conventions[key]
        for file in analysis.files
        for m in file.measurements
        for key in ("calibration", "check surfaces")
        if key in m.conventions
    )
    return environment(__package__ or "").get_template("audit.html").render(
        analysis=analysis, lead=lead_sentence(analysis), tables=known, calibration=list(said),
        fingerprint=fingerprint, versions=_versions(),
    )  # fmt: skip


def bundle_faults(bundle: Path) -> list[Remark]:
    """Return what in a bundle is not as it was written: files, page, and all of it made again.

    Every byte of every file counts. Where recordings and settings are as they were written, the
    analysis is made again: with the versions that wrote the bundle report and page are compared
    byte by byte, with others the numbers are. A fault is ``about`` a file or folder of the bundle.

    InputError: the folder is no bundle, or its settings can't be read.
    """
    faults = changed_files(bundle)
    settings = _settings(bundle, faults)
    changed = {fault.about for fault in faults}
    if SETTINGS in changed:
        return faults
    own = [bundle / _CATALOGUE] if (bundle / _CATALOGUE).is_dir() else []
    try:
        chosen = protocol(settings["protocol"], own).with_settings(settings["method"])
        again = analyse_folder(bundle / RECORDINGS, chosen, **settings["options"])
    except UnderfootError as error:
        what = Message("the analysis can't be made again ({error})", error=error)
        return [*faults, Remark.of(RECORDINGS, what)]
    if settings["versions"] == _versions() and not any(
        Path(name).parts[0] == RECORDINGS for name in changed
    ):
        faults += _unlike_made_again(bundle, again, changed)
    numbers = bundle / _REPORT / _NUMBERS
    if not numbers.is_file():
        return faults
    old = numbers.read_text(encoding="utf-8", errors="replace").splitlines()
    new = csv_text(measurement_table(again.files)).splitlines()
    different = sum(a != b for a, b in zip(old, new, strict=False)) + abs(len(old) - len(new))
    if different:
        what = Message(
            "{different} of {count} numbers come out differently; made with underfoot {made}, "
            "checked with {present}",
            different=different,
            count=len(new) - 1,
            made=str(settings["versions"].get("underfoot")),
            present=package_version("underfoot"),
        )
        faults.append(Remark.of(numbers.relative_to(bundle).as_posix(), what))
    return faults


def changed_files(bundle: Path) -> list[Remark]:
    """Return the files of a bundle whose bytes are not those that were written and signed.

    InputError: the folder is no bundle.
    """
    if not (bundle / SUMS).is_file() or not (bundle / SETTINGS).is_file():
        what = Message(
            "{bundle} is no bundle: {sums} or {settings} is missing",
            bundle=bundle,
            sums=SUMS,
            settings=SETTINGS,
        )
        raise InputError(what, where="--check")
    lines = (bundle / SUMS).read_text(encoding="utf-8", errors="replace").splitlines()
    pairs = [line.split("  ", 1) for line in lines]
    written = {pair[1]: pair[0] for pair in pairs if len(pair) == 2}
    faults = [
        Remark(SUMS, "line {number} is no checksum of a file", number=number)
        for number, pair in enumerate(pairs, start=1)
        if len(pair) < 2
    ]
    there = {path.relative_to(bundle).as_posix(): path for path in _files(bundle)}
    faults += [Remark(name, "missing") for name in sorted(written.keys() - there.keys())]
    faults += [
        Remark(name, "not in {file}", file=SUMS) for name in sorted(there.keys() - written.keys())
    ]
    faults += [
        Remark(name, "changed") for name in sorted(written.keys() & there.keys())
        if checksum(there[name]) != written[name]
    ]  # fmt: skip
    fingerprint, page = checksum(bundle / SUMS), bundle / PAGE
    signed = page.read_bytes() if page.is_file() else b""
    if fingerprint.encode() not in signed:
        return [*faults, Remark(PAGE, "missing, or signed for other checksums")]
    blank = signed.replace(fingerprint.encode(), _UNKNOWN.encode())
    if sha256(blank).hexdigest() != _settings(bundle, faults)["page"]:
        faults.append(Remark(PAGE, "changed"))
    return faults


def _settings(bundle: Path, faults: Sequence[Remark]) -> dict[str, Any]:
    """Return the settings of a bundle; ``faults`` are those known of its other files."""
    kinds = {"protocol": str, "method": dict, "options": dict, "versions": dict, "page": str}
    settings: Any = None
    reason = "no object with names"
    try:
        settings = json.loads((bundle / SETTINGS).read_text(encoding="utf-8"))
    except (ValueError, RecursionError) as error:
        reason = str(error)
    if isinstance(settings, dict):
        lacking = [name for name, kind in kinds.items() if not isinstance(settings.get(name), kind)]
        options = () if "options" in lacking else settings["options"]
        lacking += [name for name in options if name not in ("names", "merge_spelling")]
        if not lacking:
            return settings
        reason = Message("wrong or missing: {lacking}", lacking=", ".join(lacking))
    remedy = Message("Ask for the bundle as it was signed")
    if others := [fault for fault in faults if fault.about != SETTINGS]:
        remedy = Message(
            "{remedy}; not as written are also: {others:; }", remedy=remedy, others=others
        )
    raise InputError(
        Message("is damaged ({reason}), so nothing can be made again", reason=reason),
        where=str(bundle / SETTINGS),
        allowed=Message(
            "the file that trials bundle wrote, an object with {kinds}", kinds=", ".join(kinds)
        ),
        remedy=remedy,
    )


def _unlike_made_again(
    bundle: Path, analysis: FolderAnalysis, known: Collection[str]
) -> list[Remark]:
    """Return the files of report and page, but those ``known``, that are not made so again."""
    with TemporaryDirectory() as place:
        folder = Path(place) / _REPORT
        write_trials_report(analysis, folder)
        shutil.rmtree(folder / STORE, ignore_errors=True)
        made = {
            path.relative_to(place).as_posix(): path.read_bytes()
            for path in folder.rglob("*")
            if path.is_file()
        }
    made[PAGE] = audit_page(analysis, checksum(bundle / SUMS)).encode("utf-8")
    return [
        Remark(name, "not what the recordings give again")
        for name, content in sorted(made.items())
        if name not in known
        and (bundle / name).is_file()
        and (bundle / name).read_bytes() != content
    ]


def _files(folder: Path) -> list[Path]:
    """Return the files that the checksums cover."""
    apart = {folder / SUMS, folder / PAGE}
    return sorted(path for path in folder.rglob("*") if path.is_file() and path not in apart)


def _versions() -> dict[str, str]:
    names = ("underfoot", "numpy", "scipy", "statsmodels", "matplotlib", "pillow", "openpyxl")
    return {
        **{name: package_version(name) for name in names},
        "program text (hash)": program_hash(), "python": platform.python_version(),
        "system": platform.platform(),
    }  # fmt: skip
