"""The audit bundle of an analysis of trials: recordings, checksums, report, one page to sign."""

from __future__ import annotations

import json
import platform
import shutil
from collections.abc import Mapping, Sequence
from hashlib import sha256
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from underfoot.core import InputError, Progress, silent
from underfoot.core.files import checksum
from underfoot.core.html import environment
from underfoot.core.provenance import package_version, program_hash

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
        m["conventions"][key]
        for one in analysis.files
        for m in one.measurements
        for key in ("calibration", "check surfaces")
        if key in m["conventions"]
    )
    return environment(__package__ or "").get_template("audit.html").render(
        analysis=analysis, lead=lead_sentence(analysis), tables=known, calibration=list(said),
        fingerprint=fingerprint, versions=_versions(),
    )  # fmt: skip


def bundle_faults(bundle: Path) -> list[str]:
    """Return what in a bundle is not as it was written: files, page, and all of it made again.

    Every byte of the page counts, and every checksum. With the versions that wrote the bundle the
    report and the page are made again and compared byte by byte; with others, the numbers are.

    InputError: the folder is no bundle.
    """
    if not (bundle / SUMS).is_file() or not (bundle / SETTINGS).is_file():
        raise InputError(f"{bundle} is no bundle: {SUMS} or {SETTINGS} is missing", where="--check")
    lines = (bundle / SUMS).read_text(encoding="utf-8").splitlines()
    written = {name: digest for digest, name in (line.split("  ", 1) for line in lines)}
    there = {path.relative_to(bundle).as_posix(): path for path in _files(bundle)}
    faults = [f"{name}: missing" for name in sorted(written.keys() - there.keys())]
    faults += [f"{name}: not in {SUMS}" for name in sorted(there.keys() - written.keys())]
    faults += [
        f"{name}: changed" for name in sorted(written.keys() & there.keys())
        if checksum(there[name]) != written[name]
    ]  # fmt: skip
    settings = json.loads((bundle / SETTINGS).read_text(encoding="utf-8"))
    fingerprint, page = checksum(bundle / SUMS), bundle / PAGE
    signed = page.read_bytes() if page.is_file() else b""
    if fingerprint.encode() not in signed:
        faults.append(f"{PAGE}: missing, or signed for other checksums")
    else:
        blank = signed.replace(fingerprint.encode(), _UNKNOWN.encode())
        if sha256(blank).hexdigest() != settings.get("page"):
            faults.append(f"{PAGE}: changed")
    own = [bundle / _CATALOGUE] if (bundle / _CATALOGUE).is_dir() else []
    chosen = protocol(settings["protocol"], own).with_settings(settings["method"])
    again = analyse_folder(bundle / RECORDINGS, chosen, **settings["options"])
    own = f"{RECORDINGS}/"
    if settings["versions"] == _versions() and not any(one.startswith(own) for one in faults):
        faults += _unlike_made_again(bundle, again, faults)
    old = (bundle / _REPORT / _NUMBERS).read_text(encoding="utf-8").splitlines()
    new = csv_text(measurement_table(again.files)).splitlines()
    different = sum(a != b for a, b in zip(old, new, strict=False)) + abs(len(old) - len(new))
    if different:
        faults.append(
            f"{different} of {len(old) - 1} numbers come out differently; made with underfoot "
            f"{settings['versions']['underfoot']}, checked with {package_version('underfoot')}"
        )
    return faults


def _unlike_made_again(bundle: Path, analysis: FolderAnalysis, known: Sequence[str]) -> list[str]:
    """Return the files of report and page that are not those that the recordings give again."""
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
    told = {fault.split(":", 1)[0] for fault in known}
    return [
        f"{name}: not what the recordings give again"
        for name, content in sorted(made.items())
        if name not in told
        and (bundle / name).is_file()
        and (bundle / name).read_bytes() != content
    ]


def _files(folder: Path) -> list[Path]:
    """Return the files that the checksums cover."""
    apart = {folder / SUMS, folder / PAGE}
    return sorted(
        path for path in folder.rglob("*")
        if path.is_file() and path not in apart and not path.name.startswith(".")
    )  # fmt: skip


def _versions() -> dict[str, str]:
    names = ("underfoot", "numpy", "scipy", "statsmodels", "matplotlib", "pillow", "openpyxl")
    return {
        **{name: package_version(name) for name in names},
        "program text (hash)": program_hash(), "python": platform.python_version(),
        "system": platform.platform(),
    }  # fmt: skip
