"""No rule hangs on the text of a message: what a line means is handed on as a value."""

import ast
from collections.abc import Iterable
from pathlib import Path

import pytest

import underfoot
from source_trees import nodes

SOURCE = Path(underfoot.__file__).parent
CUTS = {
    *("endswith", "find", "index", "partition", "removeprefix", "removesuffix"),
    *("replace", "rpartition", "rsplit", "split", "startswith"),
}
FORMATS = {
    "app": "text of requests and of its own file of languages",
    "block/_kernels/generate.py": "source text of kernels",
    "case/errors.py": "what pydantic allows",
    "case/explanation.py": "docstrings",
    "case/tables.py": "tables of users",
    "case/text.py": "what tomlkit says",
    "cli/output.py": "brackets are cut off where a line is too long",
    "case/section.py": "addresses module:Class",
    "cli/outsole_make.py": "addresses module:Class",
    "core/installation.py": "requirements of packages",
    "core/registry.py": "addresses module:Class",
    "core/remark.py": "stored lines",
    "explore/engines.py": "addresses of queues",
    "explore/inputs.py": "addresses module:Class",
    "material": "tables of instruments",
    "report/sole_export.py": "files",
    "shoe/files": "files",
    "slip/dynamics/gait.py": "tables",
    "surface/instruments.py": "files",
    "surface/read.py": "files",
    "trials/readers": "recordings",
    "trials/recording/marker_names.py": "recordings",
    "trials/statistics/linear.py": "terms of a model",
    "trials/study/condition_table.py": "headings of users' tables",
    "trials/study/conditions.py": "headings of users' tables",
    "trials/study/model_scripts.py": "terms of a model",
}
"""Rooms and files that read text of others, and whose."""
PATTERNS = {
    "pages/figures.py": "names of files of users",
    "pages/report.py": "bytes of pictures and archives that other libraries wrote",
    "readers": "recordings",
    "recording/axes.py": "axes that a user names",
    "recording/marker_names.py": "recordings",
    "recording/tester_calibration.py": "records of users",
    "statistics/samples.py": "labels of users",
    "study/circumstances.py": "names of files of users",
    "study/condition_table.py": "tables of users",
    "study/conditions.py": "tables of users",
    "study/model_scripts.py": "names of columns of users",
    "study/readings.py": "tables of users",
    "study/study_guard.py": "names of persons of users",
    "walking/gait_context.py": "recordings",
}
"""Where trials look for patterns in text, and in whose."""


def _reads_text(node: ast.AST) -> bool:
    """Whether a node cuts a text at a sentence's mark or words, or looks for words in it."""
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
        given = [part for each in node.args for part in ast.walk(each)]
        return node.func.attr in CUTS and any(map(_of_a_sentence, given))
    if not isinstance(node, ast.Compare) or not isinstance(node.ops[0], ast.In | ast.NotIn):
        return False
    read = ast.unparse(node.comparators[0])
    return _of_a_sentence(node.left) or (
        isinstance(node.left, ast.Constant) and read.startswith(("str(", "message", "remark"))
    )


def _of_a_sentence(node: ast.AST) -> bool:
    if not isinstance(node, ast.Constant) or not isinstance(node.value, str):
        return False
    words = node.value.strip(" .:;(").split(" ")
    return node.value in (": ", ":", " (", "; ", ". ", "±") or (
        len(words) > 1 and (words[0].isalpha() or node.value.startswith(" ")) and words[0] != "ISO"
    )


def _found(within: Iterable[ast.AST]) -> list[int]:
    return [node.lineno for node in within if _reads_text(node)]


@pytest.mark.parametrize(
    "code",
    [
        'line.partition(":")[0]',
        'note.startswith("no record of it")',
        'limit.replace(" of the load", "")',
        '"not converged" in remark',
        '"converged" in str(error)',
        'column.endswith(" 95 % low")',
    ],
)
def test_reading_a_sentence_back_is_seen(code):
    assert _found(ast.walk(ast.parse(code))) == [1]


def test_no_text_of_ours_is_read_back():
    found = {}
    for file in sorted(SOURCE.rglob("*.py")):
        place = file.relative_to(SOURCE).as_posix()
        if not any(place == known or place.startswith(f"{known}/") for known in FORMATS):
            lines = _found(nodes(file))
            found |= {place: lines} if lines else {}
    assert not found


def _imported(file: Path) -> set[str]:
    statements = [one for one in nodes(file) if isinstance(one, ast.Import)]
    from_ = [one for one in nodes(file) if isinstance(one, ast.ImportFrom)]
    return {n.name for one in statements for n in one.names} | {str(one.module) for one in from_}


def test_trials_look_for_patterns_in_text_of_others_alone():
    rooms = SOURCE / "trials"
    files = {file.relative_to(rooms).as_posix(): file for file in rooms.rglob("*.py")}
    found = {place for place, file in files.items() if "re" in _imported(file)}
    assert {p.split("/")[0] if p.startswith("readers/") else p for p in found} == PATTERNS.keys()
