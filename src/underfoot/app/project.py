"""A project: a folder of plain files that the command line reads too.

    variants/NAME.toml   cases; ``underfoot run variants/NAME.toml`` computes one
    soles/               outsole files that cases use
    measured/            scans and rubber tests that cases use
    results/NAME/        what ``underfoot run --out`` writes
    studies/, trials/    design studies and measurements
    history.jsonl        every state of every variant, for undo and redo
    known.txt            the variant whose shoe the person knows

Each file is written as a whole or not at all. A file that another program changed meanwhile counts
as one more state: nothing is lost.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime
from os import SEEK_END
from pathlib import Path
from typing import Any

from underfoot.case import Case
from underfoot.core import InputError
from underfoot.core.errors import UnderfootError, first_names
from underfoot.core.files import whole_file
from underfoot.core.remark import Message

FOLDERS = ("variants", "soles", "measured", "results", "studies", "trials")
NAME = re.compile(r"[^\W_][\w .,+()'-]{0,59}")
ALLOWED = "1 to 60 letters, digits, spaces and . , + ( ) ' - _, a letter or digit first"
MOST_STATES = 500
"""States of a variant that undo goes back."""
OWN = ("shoe.material", "shoe.roughness", "shoe.wear", "shoe.sole.midsole")
"""Parts of a shoe that stay as the person set them where an outsole comes from a file."""


@dataclass(frozen=True, slots=True)
class Summary:
    """A finished result in short: ``cof`` with its 95 % interval, None where there is none."""

    name: str
    status: str
    cof: float | None
    low: float | None
    high: float | None
    slip_probability: float | None
    case_hash: str
    created: str


@dataclass
class _States:
    texts: list[str | None] = field(default_factory=list)
    at: int = -1

    def add(self, text: str | None) -> None:
        """Make a text the newest state; what was undone before is gone."""
        self.texts = [*self.texts[: self.at + 1], text][-MOST_STATES:]
        self.at = len(self.texts) - 1


class Project:
    """Variants, their states and results in a folder, which is made if it is missing.

    Raises:
        InputError: The folder is a file or can't be made.
    """

    def __init__(self, folder: Path | str) -> None:
        self.folder = Path(folder).resolve()
        try:
            for name in FOLDERS:
                (self.folder / name).mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise InputError(
                Message(
                    "{folder} can't be used as a project: {strerror}",
                    folder=self.folder,
                    strerror=(error.strerror or "").lower(),
                ),
                where="project",
                allowed="a folder that can be written",
            ) from error
        self._states: dict[str, _States] = {}
        self._summaries: dict[str, tuple[tuple[int, int], Summary | None]] = {}
        self._replay()

    @property
    def name(self) -> str:
        """Name of the folder."""
        return self.folder.name

    @property
    def known(self) -> str | None:
        """Name of the variant whose shoe the person knows; results are shown beside it."""
        file = self.folder / "known.txt"
        return file.read_text(encoding="utf-8") if file.exists() else None

    @known.setter
    def known(self, name: str | None) -> None:
        with whole_file(self.folder / "known.txt") as part:
            part.write_text(name or "", encoding="utf-8")

    def inside(self, *parts: str) -> Path:
        """Return a path in the project.

        Raises:
            InputError: The path leads out of the project.
        """
        path = self.folder.joinpath(*parts).resolve()
        if not path.is_relative_to(self.folder):
            outside = Message('"{path}" is outside the project', path="/".join(parts))
            raise InputError(outside, where="project")
        return path

    # variants

    def variants(self) -> list[str]:
        """Return the names of all variants, the last changed first."""
        files = list((self.folder / "variants").glob("*.toml"))
        files.sort(key=lambda file: file.stat().st_mtime_ns, reverse=True)
        return [file.stem for file in files if NAME.fullmatch(file.stem)]

    def removed_variants(self) -> list[str]:
        """Return the names of variants that were removed and can be restored."""
        present = set(self.variants())
        return sorted(name for name in self._states if name not in present)

    def path(self, name: str) -> Path:
        """Return the case file of a variant.

        Raises:
            InputError: No name for a file.
        """
        if not NAME.fullmatch(name) or name.endswith((".", " ")):
            what = Message('"{name}" is no name', name=name)
            raise InputError(what, where="variant", allowed=ALLOWED)
        return self.folder / "variants" / f"{name}.toml"

    def case(self, name: str) -> Case:
        """Return the case of a variant.

        Raises:
            InputError: No variant of this name.
            CaseError: Everything that is wrong with its file.
        """
        return Case.load(self._present(name))

    def text(self, name: str) -> str:
        """Return the case file of a variant as text."""
        return self._present(name).read_text(encoding="utf-8")

    def free_name(self, wanted: str) -> str:
        """Return ``wanted``, with a number behind it where a variant or a result has that name."""
        results = (each.name for each in (self.folder / "results").iterdir())
        taken = {each.casefold() for each in (*self.variants(), *self._states, *results)}
        cleaned = re.sub(r"[^\w .,+()'-]", " ", wanted).strip(" ._")[:50].strip() or "Variant"
        name, number = cleaned, 1
        while name.casefold() in taken:
            number += 1
            name = f"{cleaned} {number}"
        return name

    def add(self, name: str, text: str) -> str:
        """Write a new variant and return its name.

        Raises:
            InputError: No name for a file, or one that is taken.
        """
        if self.path(name).exists():
            what = Message('"{name}" exists', name=name)
            raise InputError(what, where="variant", remedy="Choose another name")
        self._set(name, text)
        return name

    def copy(self, name: str, wanted: str, changes: Mapping[str, Any] | None = None) -> str:
        """Write a variant like ``name`` with ``changes`` (path: value); return its name."""
        new = self.free_name(wanted)
        return self.add(new, self.case(name).replace({**(changes or {}), "name": new}).to_toml())

    def rename(self, name: str, to: str) -> str:
        """Give a variant another name; its result moves along.

        Raises:
            InputError: No name for a file, or one that is taken.
        """
        if name == to:
            return to
        self.add(to, self.case(name).replace("name", to).to_toml())
        result, target = self.result_folder(name), self.result_folder(to)
        if result.is_dir() and not target.exists():
            result.rename(target)
        self.remove(name)
        return to

    def remove(self, name: str) -> None:
        """Remove a variant; ``restore`` brings it back, and its result stays."""
        self._present(name)
        self._set(name, None)

    def restore(self, name: str) -> None:
        """Bring a removed variant back."""
        texts = [text for text in self._states[name].texts if text is not None]
        self._set(name, texts[-1])

    def change(self, name: str, changes: Mapping[str, Any]) -> Case:
        """Change values (path: value, None for the catalogue's) of a variant; return its case.

        Raises:
            CaseError: What is wrong with the new values; the file stays as it was.
        """
        case = self.case(name).replace(changes)
        self.write(name, case.to_toml())
        return case

    def take_sole(self, name: str, shoe: Mapping[str, Any]) -> Case:
        """Give a variant the shoe that a case of a file has; what a person set of it stays."""
        case = self.case(name)
        kept = {part: entry for part, entry in case.entries.items() if part.startswith(OWN)} | {
            path: case.value(path)
            for path, origin in case.origins.items()
            if path.startswith(OWN) and origin.kind == "given"
        }
        return self.change(name, {"shoe": shoe, **kept})

    def write(self, name: str, text: str) -> None:
        """Replace the text of a variant."""
        if text != self.text(name):
            self._current_states(name)
            self._set(name, text)

    # undo and redo

    def can_undo(self, name: str) -> bool:
        """Return whether there is an earlier state."""
        states = self._current_states(name)
        return states.at > 0 and states.texts[states.at - 1] is not None

    def can_redo(self, name: str) -> bool:
        """Return whether a state was undone."""
        states = self._current_states(name)
        return states.at + 1 < len(states.texts) and states.texts[states.at + 1] is not None

    def undo(self, name: str) -> None:
        """Go back one state, where there is one."""
        if self.can_undo(name):
            self._go(name, -1)

    def redo(self, name: str) -> None:
        """Go forward one state, where one was undone."""
        if self.can_redo(name):
            self._go(name, 1)

    # results

    def result_folder(self, name: str) -> Path:
        """Return the folder of a variant's result, whether it is there or not."""
        self.path(name)
        return self.folder / "results" / name

    def state(self, name: str) -> tuple[str | None, str | None]:
        """Return what pages show of a variant: its text, and when its result was made.

        None for a variant or a result that is not there.
        """
        path, summary = self.path(name), self.summary(name)
        try:
            text = path.read_text(encoding="utf-8")
        except OSError:
            text = None
        return text, summary and summary.created

    def is_current(self, name: str) -> bool:
        """Return whether there is a result of what the file of a variant says now."""
        summary = self.summary(name)
        try:
            return summary is not None and summary.case_hash == self.case(name).hash
        except UnderfootError:
            return False

    def results(self) -> list[Summary]:
        """Return the finished results, the newest first."""
        summaries = [self.summary(folder.name) for folder in (self.folder / "results").iterdir()]
        return sorted(filter(None, summaries), key=lambda each: each.created, reverse=True)

    def summary(self, name: str) -> Summary | None:
        """Return a result in short; None where there is none that can be read."""
        path = self.folder / "results" / name / "result.json"
        try:
            made, size = path.stat().st_mtime_ns, path.stat().st_size
        except OSError:
            return None
        if self._summaries.get(name, (None,))[0] != (made, size):  # pages ask every second
            self._summaries[name] = (made, size), self._summary(name, path)
        return self._summaries[name][1]

    def _summary(self, name: str, path: Path) -> Summary | None:
        try:
            stored = json.loads(path.read_text(encoding="utf-8"))
            cof, slip = stored["cof"], stored.get("slip_probability") or {}
            low, high = cof.get("interval") or (None, None)
            made = stored["provenance"]
            return Summary(
                name,
                stored["status"]["value"],
                cof["value"],
                low,
                high,
                slip.get("value"),
                made["case_hash"],
                made["created"],
            )
        except (OSError, ValueError, KeyError, TypeError):
            return None

    # states

    def _present(self, name: str) -> Path:
        path = self.path(name)
        if not path.is_file():
            known = first_names(self.variants()) or "none yet"
            what = Message('there is no variant "{name}"', name=name)
            raise InputError(what, where="variant", allowed=known)
        return path

    def _current_states(self, name: str) -> _States:
        """Return the states of a variant, with what another program wrote as one of them.

        Where the history can't be written now (a full disk, a folder to read only) it is tried
        again with the next question: who only looks is not stopped.
        """
        states, text = self._states.setdefault(name, _States()), self.text(name)
        if states.at < 0 or states.texts[states.at] != text:
            try:
                self._record(name, "set", text)
            except OSError:
                states = _States(list(states.texts), states.at)
            states.add(text)
        return states

    def _set(self, name: str, text: str | None) -> None:
        self._record(name, "set", text)
        self._states.setdefault(name, _States()).add(text)
        self._put(name, text)

    def _go(self, name: str, step: int) -> None:
        states = self._states[name]
        self._record(name, "undo" if step < 0 else "redo")
        states.at += step
        self._put(name, states.texts[states.at])

    def _put(self, name: str, text: str | None) -> None:
        path = self.path(name)
        if text is None:
            path.unlink(missing_ok=True)
            return
        with whole_file(path) as part:
            part.write_text(text, encoding="utf-8")

    def _record(self, name: str, action: str, text: str | None = None) -> None:
        line: dict[str, Any] = {"time": _now(), "variant": name, "action": action}
        if action == "set":
            line["text"] = text
        append_line(self.folder / "history.jsonl", line)

    def _replay(self) -> None:
        for line in lines(self.folder / "history.jsonl"):
            name, action, text = (line.get(key) for key in ("variant", "action", "text"))
            if not isinstance(name, str) or not NAME.fullmatch(name):
                continue  # another program's line, as a merge leaves it
            if action == "set" and isinstance(text, str | None):
                self._states.setdefault(name, _States()).add(text)
            elif action in ("undo", "redo") and name in self._states:
                states, step = self._states[name], -1 if action == "undo" else 1
                states.at = min(max(states.at + step, 0), len(states.texts) - 1)


def append_line(path: Path, content: Mapping[str, Any]) -> None:
    """Add one line of JSON to a file; what a power cut left of the last one stays by itself."""
    with path.open("ab+") as stream:
        if stream.seek(0, SEEK_END):
            stream.seek(-1, SEEK_END)
            if stream.read(1) != b"\n":
                stream.write(b"\n")
        stream.write(json.dumps(content, ensure_ascii=False).encode() + b"\n")


def lines(path: Path) -> list[dict[str, Any]]:
    """Return the lines of JSON of a file; one cut short by a power cut is left out."""
    lines_by_path = []
    if path.is_file():
        for line in path.read_text(encoding="utf-8", errors="replace").splitlines():
            try:
                lines_by_path.append(json.loads(line))
            except ValueError:
                continue
    return [line for line in lines_by_path if isinstance(line, dict)]


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="seconds")
