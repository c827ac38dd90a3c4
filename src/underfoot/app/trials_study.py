"""A folder of trials in a project: how it is analysed, and the edits that can be undone."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from underfoot.core.files import whole_file

from .project import Project

STANDARD = {"protocol": "level_walking", "names": "", "merge_spelling": False}


def studies(project: Project) -> list[str]:
    """Return the names of the folders of trials."""
    folders = project.inside("trials").iterdir()
    return sorted(folder.name for folder in folders if folder.is_dir() and folder.name[0] != ".")


def free_name(project: Project, wanted: str) -> str:
    """Return ``wanted``, with a number behind it where a folder of trials has that name already."""
    name, number = wanted, 1
    while project.inside("trials", name).exists():
        number += 1
        name = f"{wanted} {number}"
    return name


class TrialsFolder:
    """A folder of trials. How it was analysed last stands beside it, as ``trials/NAME.json``.

    Attributes:
        settings: protocol, names and merge_spelling, as ``underfoot trials analyse`` takes them.
        files: Names of the results in their order, once the folder has been looked at.
        done, undone: Texts of ``edits.csv`` before and after each edit of this page.
    """

    def __init__(self, project: Project, name: str) -> None:
        self.name = name
        self.folder = project.inside("trials", name)
        self.report = project.inside("results", f"{name} trials")
        self._file = project.inside("trials", f"{name}.json")
        self.settings: dict[str, Any] = dict(STANDARD)
        self.files: list[str] = []
        self.done: list[tuple[str, str]] = []
        self.undone: list[tuple[str, str]] = []
        try:
            kept = json.loads(self._file.read_text(encoding="utf-8"))
            self.settings = {key: type(value)(kept[key]) for key, value in STANDARD.items()}
        except (OSError, ValueError, KeyError, TypeError):
            pass  # never analysed, or not a file of ours: the standard

    def keep(self, settings: Mapping[str, Any]) -> bool:
        """Keep how the folder is analysed; return whether that is new."""
        new = {**self.settings, **settings}
        if new == self.settings:
            return False
        self.settings = new
        with whole_file(self._file) as part:
            part.write_text(json.dumps(new, indent=2, ensure_ascii=False), encoding="utf-8")
        return True

    @property
    def asked(self) -> dict[str, Any]:
        """What the computing process is asked about, as plain data."""
        return {"folder": str(self.folder), "report": str(self.report), **self.settings}

    @property
    def command(self) -> str:
        """The command that says the same, in the folder of the project."""
        parts = ["underfoot trials analyse", _in_quotes(f"trials/{self.name}"), "--protocol"]
        parts += [self.settings["protocol"], "--out", _in_quotes(f"results/{self.name} trials")]
        if self.settings["names"]:
            parts += ["--names", _in_quotes(self.settings["names"])]
        return " ".join(parts + ["--merge-spelling"] * self.settings["merge_spelling"])


def _in_quotes(text: str) -> str:
    """Return a text as one word of a command, for shells of all systems."""
    return json.dumps(text, ensure_ascii=False)
