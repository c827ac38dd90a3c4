"""Syntax trees of files of the source, parsed once a process, and their nodes in one list."""

import ast
import gc
from functools import cache
from pathlib import Path


@cache
def tree(path: Path) -> ast.Module:
    found = ast.parse(path.read_text(encoding="utf-8"))
    gc.freeze()
    return found


@cache
def nodes(path: Path) -> tuple[ast.AST, ...]:
    found = tuple(ast.walk(tree(path)))
    gc.freeze()  # they stay: no collection of garbage walks through a million nodes
    return found
