"""Sentences are short: what takes more than 45 words is said in two."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
WORDS = 45
PAGES = [
    ROOT / "README.md",
    ROOT / "CONTRIBUTING.md",
    *(
        page
        for page in sorted((ROOT / "docs").rglob("*.md"))
        if page.parent.name not in ("rooms", "versions", "api")
    ),
]


def sentences(text):
    """Yield the sentences of a page without blocks, formulas and tables; code in one is a word."""
    text = re.sub(r"^(`{3,}).*?^\1$", "", text, flags=re.DOTALL | re.MULTILINE)
    text = re.sub(r"\$\$.*?\$\$", "", text, flags=re.DOTALL)
    text = re.sub(r"^(?:#|\||:::| {4}\S).*$", "", text, flags=re.MULTILINE)
    text = re.sub(r"`[^`]+`|\$[^$]+\$", "x", text)
    text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", text)
    for block in re.split(r"\n\s*\n|\n\s*(?:[-*]|\d+\.) ", text):
        parts = re.split(r"(?<=[.!?])\W*\s+|[:;]\s+(?=[A-Z*])", block)
        yield from filter(words, parts)


def words(sentence):
    return len(re.findall(r"[^\W_](?:\S*\w)?", sentence))


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_no_sentence_of_a_page_is_longer_than_45_words(page):
    long = [each for each in sentences(page.read_text("utf-8")) if words(each) > WORDS]
    assert not long, "\n\n".join(" ".join(each.split()) for each in long)


def test_a_long_sentence_is_seen_and_code_tables_and_lists_are_not():
    said = "The film carries " + "more and " * 22
    assert [words(each) for each in sentences(f"One. {said}.\n")] == [1, 47]
    assert [words(each) for each in sentences("A `long (piece) of code`, then.")] == [3]
    assert not list(sentences(f"| {said} |\n\n```python\n{said}\n```\n"))
    assert max(words(each) for each in sentences("- more and more\n" * 30)) == 3
