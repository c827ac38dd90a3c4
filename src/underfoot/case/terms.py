"""Words of the field, each in a sentence."""

import tomllib
from importlib.resources import files

TERMS: dict[str, str] = tomllib.loads((files("underfoot.case") / "terms.toml").read_text("utf-8"))


def term(name: str) -> str | None:
    """Return the sentence of a word, whichever case it is written in, or None."""
    return {key.casefold(): text for key, text in TERMS.items()}.get(name.casefold())
