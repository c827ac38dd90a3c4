"""The words of the app in each language, as catalogue files that another language can copy.

``en.toml``, ``de.toml``: what the app says, by key. ``de.package.toml``: what the package says
(results, remarks, catalogue, errors), by the English sentence; ``{}`` stands for a part that
changes, ``{0}``, ``{1}`` for these parts in the other language. ``en.package.toml``: the same of
sentences that name options of the command line, which the app has fields for.
``de.messages.toml``: the messages of the package (``core.remark.Message``), by the template that is
their code, with the same fields. The browser puts these in.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import tomllib
from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

from underfoot.core.files import whole_file
from underfoot.core.unit_text import SYSTEMS

FOLDER = files("underfoot.app.text")
LANGUAGE_VARIABLE = "UNDERFOOT_LANGUAGE"
"""Environment variable with the language of who asked, in the processes that compute."""


class Text:
    """The words of one language: ``text("start.title")``, ``text("jobs.open", count=3)``.

    Raises:
        KeyError: No such key, or a placeholder without a value.
    """

    def __init__(self, language: str = "en") -> None:
        self.language = language
        self._messages = catalogue(language)

    def __call__(self, key: str, **values: Any) -> str:
        """Return the words of a key with its placeholders filled."""
        return self._messages[key].format(**values)

    def of_package(self) -> dict[str, str]:
        """Return the sentences of the package in this language, by their English."""
        return _sentences(f"{self.language}.package.toml")

    def messages(self) -> dict[str, str]:
        """Return the templates of the package's messages in this language, by their code."""
        return _sentences(f"{self.language}.messages.toml")

    def sentences(self) -> dict[str, str]:
        """Return what a page puts in where it has no message: sentences, and messages as these."""
        return {**_as_sentences(self.messages()), **self.of_package()}

    def script(self) -> str:
        """Return the script that tells a page its language and the words of the package."""
        return _script(self.language)

    @property
    def script_name(self) -> str:
        """Name of the script as a file, another one for other words: a browser may keep it."""
        return _script_name(self.language)

    @property
    def comma(self) -> bool:
        """True where the decimal sign is a comma."""
        return self("frame.decimal") == ","

    def number(self, value: float | None, digits: int = 4) -> str:
        """Return a number as a field shows it, "" for none."""
        return "" if value is None else f"{value:.{digits}g}".replace(".", self("frame.decimal"))

    def unit_systems(self) -> dict[str, str]:
        """Return the name of each system of units."""
        return {system: self(f"frame.{system}") for system in SYSTEMS}

    def get(self, key: str, otherwise: str) -> str:
        """Return the words of a key, or ``otherwise`` where there is none."""
        return self._messages.get(key, otherwise)


def put_language(page: Path | None) -> None:
    """Let a report that was written speak the language of who asked, without the app too."""
    language = os.environ.get(LANGUAGE_VARIABLE, "en")
    if page is not None and language != "en":
        speaker = files("underfoot.app").joinpath("static", "language.js").read_text("utf-8")
        script = f"<head>\n<script>{Text(language).script()}</script>\n<script>{speaker}</script>"
        spoken = page.read_text(encoding="utf-8").replace("<head>", script, 1)
        with whole_file(page) as part:
            part.write_text(spoken, encoding="utf-8")


def as_json(content: Any) -> str:
    """Return data as JSON that may stand in a page."""
    return json.dumps(content, ensure_ascii=False).replace("<", "\\u003c")


@cache
def _script(language: str) -> str:
    text = Text(language)
    words = {"words": text.sentences(), "messages": text.messages()}
    spoken = as_json({**words, "decimal": text("frame.decimal")})
    return f'document.documentElement.lang = "{language}"; const spoken = {spoken};'


_FIELD = re.compile(r"\{(\w+)(?::([^}]*))?\}")
_LEAST = 12
"""Letters that a template has besides its fields, to be known again in a line of several."""


def _as_sentences(messages: Mapping[str, str]) -> dict[str, str]:
    """Return messages as sentences, by which text of old results and of joined lines is known."""
    sentences: dict[str, str] = {}
    for code, words in messages.items():
        if len(re.findall("[A-Za-z]", _FIELD.sub("", code))) < _LEAST:
            continue
        for many in (True, False) if "|" in code else (True,):
            names: list[str] = []

            def put(field: re.Match[str], many: bool = many, names: list[str] = names) -> str:
                if "|" in (field[2] or ""):
                    return field[2].split("|")[many]
                names.append(field[1])
                return "{}"

            english = _FIELD.sub(put, code).strip()
            places = {name: place for place, name in reversed([*enumerate(names)])}

            def back(
                field: re.Match[str], many: bool = many, places: dict[str, int] = places
            ) -> str:
                if "|" in (field[2] or ""):
                    return field[2].split("|")[many]
                return f"{{{places[field[1]]}}}"

            sentences[english] = _FIELD.sub(back, words).strip()
    return sentences


def _sentences(name: str) -> dict[str, str]:
    file = FOLDER.joinpath(name)
    return tomllib.loads(file.read_text("utf-8")) if file.is_file() else {}


@cache
def _script_name(language: str) -> str:
    mark = hashlib.sha256(_script(language).encode()).hexdigest()[:12]
    return f"{language}-{mark}.js"


@cache
def catalogue(language: str) -> dict[str, str]:
    """Return the words of a language by dotted key."""
    return _flat(tomllib.loads(FOLDER.joinpath(f"{language}.toml").read_text("utf-8")))


def chosen_language(cookie: str | None, accepted: str) -> str:
    """Return the language that a person chose, or the first of the browser's that there is."""
    wanted = [cookie or "", *(part.partition(";")[0].strip()[:2] for part in accepted.split(","))]
    return next((code for code in wanted if code in LANGUAGES), "en")


def _flat(table: Mapping[str, Any], start: str = "") -> dict[str, str]:
    flat: dict[str, str] = {}
    for key, value in table.items():
        path = f"{start}{key}"
        flat |= _flat(value, f"{path}.") if isinstance(value, Mapping) else {path: value}
    return flat


LANGUAGES = {
    code: catalogue(code)["frame.language_name"]
    for code, _, rest in sorted(file.name.partition(".") for file in FOLDER.iterdir())
    if rest == "toml"
}
"""Name of each language in itself, by its code: one for each file."""
