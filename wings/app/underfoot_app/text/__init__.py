"""The words of the app: one file a language, looked up by key.

What the package itself computes and says (results, remarks, errors) is English.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from typing import Any

LANGUAGES = {"en": "English", "de": "Deutsch"}
"""Name of each language in itself, by its code."""


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

    def get(self, key: str, otherwise: str) -> str:
        """Return the words of a key, or ``otherwise`` where there is none."""
        return self._messages.get(key, otherwise)


@cache
def catalogue(language: str) -> dict[str, str]:
    """Return the words of a language by dotted key."""
    file = files("underfoot_app.text").joinpath(f"{language}.toml")
    return _flat(tomllib.loads(file.read_text("utf-8")))


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
