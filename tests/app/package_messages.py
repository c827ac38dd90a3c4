"""What the package can tell a user of the app, as forms: "{}" for each part that changes.

Read from the source: what makers of errors, flags, remarks, doubts and tables are given, and the
reasons that functions return. Both arms of a condition, pieces joined by + and names that stand for
text count. Left out, by rule:

* a function that nothing names on the way from the app: commands and callers from Python alone
  meet it;
* errors of Python (ValueError and the like): mistakes of the program, which no page shows;
* what is no phrase: names, units, patterns, markup.
"""

import ast
import math
import re
from functools import cache
from itertools import product
from pathlib import Path

import underfoot
from source_trees import tree

PACKAGE = Path(underfoot.__file__).parent
APART = ("cli/", "studies/", "block/", "reference/")
"""Rooms that no page asks: commands, and studies of this program about itself."""
ROOMS = (
    *("app/", "calibrate/", "case/", "compute/", "core/", "explore/", "fluid/", "friction/"),
    *("material/", "places/", "questions/", "report/", "shoe/", "slip/", "sole_contact/"),
    *("surface/", "trials/"),
)
REASONS = ("compute/", "core/registry", "places/", "questions/", "shoe/files/", "trials/")
"""Where a function that returns text returns a reason; elsewhere it may be a name or a script."""
MAKER = re.compile(
    r"(Error|_error|_refused?)$"
    r"|^(problem|Flag|Remark|assumed|caution|remark|Doubt|Table|MissingExtraError"
    r"|exactly_one|between|host_array|refuse|refuse_if)$"
)
TEMPLATES = {"Message", "Remark", "assumed", "caution", "remark"}
"""Makers whose text is a template: ``test_messages`` holds these to the languages."""
PARTS = {"what", "allowed", "remedy", "missing", "message", "reason", "note", "notes", "title"}
OF_PYTHON = {
    *("ValueError", "TypeError", "AttributeError", "KeyError", "AssertionError", "OSError"),
    *("NotImplementedError", "RuntimeError", "ImportError", "ValidationError"),
    "PydanticCustomError",
}
"""Errors of Python and pydantic: what a caller of a function reads, none on a page."""
PHRASE = re.compile(r"[A-Za-z]{2}.* .*[A-Za-z]{2}|[a-z]{2,} \{\}|\{\} [a-z]{3,}")
WORD = re.compile(r"[a-z]{4,}")
"""Of an error one word is a message too: "empty"."""
FUNCTION = ast.FunctionDef | ast.AsyncFunctionDef
MOST = 24
"""Forms of one sentence, and values of one name, that are followed."""


class Piece:
    """A function, or a statement of a module or of a class."""

    def __init__(self, file, owner, node):
        self.file, self.owner, self.node = file, owner, node
        self.name = node.name if isinstance(node, FUNCTION) else ""
        self.names = set(_names(node))

    def is_reached(self, names):
        """Return whether the app names it, or it belongs to what is named."""
        if self.file.startswith("app/"):
            return True
        if not self.name:
            return bool(self.targets() & names) if not self.owner else self.owner in names
        called = self.name in names or bool(self.node.decorator_list)
        if not self.owner:
            return called
        return self.owner in names and (called or self.name.startswith("__"))

    def targets(self):
        """Return the names that the statement gives a value."""
        targets = getattr(self.node, "targets", None) or [getattr(self.node, "target", None)]
        return {
            each.id
            for target in targets
            if target is not None
            for each in ast.walk(target)
            if isinstance(each, ast.Name)
        }


def _names(node):
    for each in ast.walk(node):
        if isinstance(each, ast.Name):
            yield each.id
        elif isinstance(each, ast.Attribute):
            yield each.attr
        elif isinstance(each, ast.Constant) and re.fullmatch(r"[\w.]+:\w+", str(each.value)):
            yield each.value.partition(":")[2]  # in another process, behind a door


@cache
def trees():
    """Return the syntax tree of each file."""
    return {
        path.relative_to(PACKAGE).as_posix(): tree(path) for path in sorted(PACKAGE.rglob("*.py"))
    }


@cache
def reached():
    """Return the pieces that can run for a page: by name, from those of the app."""
    left = [
        Piece(file, node.name if isinstance(node, ast.ClassDef) else "", each)
        for file, tree in trees().items()
        if not file.startswith(APART)
        for node in tree.body
        for each in (node.body if isinstance(node, ast.ClassDef) else [node])
    ]
    names, pieces = set(), []
    while new := [each for each in left if each.is_reached(names)]:
        pieces += new
        taken = set(map(id, new))
        left = [each for each in left if id(each) not in taken]
        names.update(*(each.names for each in new))
    return pieces


def _values(block, values, blocks, path=()):
    """Note what each name of a block stands for: end of the statement, its blocks, expression.

    ``blocks`` gets the lines of each block and the blocks that it is within.
    """
    path += (id(block),)
    if block:
        blocks.append((block[0].lineno, block[-1].end_lineno, path))
    for statement in block:
        if isinstance(statement, ast.ClassDef):
            continue
        inner = [getattr(statement, part, []) for part in ("body", "orelse", "finalbody")]
        for each in (*inner, *(handler.body for handler in getattr(statement, "handlers", ()))):
            _values(each, values, blocks, path)
        value, target = getattr(statement, "value", None), getattr(statement, "target", None)
        if isinstance(statement, ast.AugAssign):
            value = ast.BinOp(target, ast.Add(), value)
        elif not isinstance(statement, ast.Assign | ast.AnnAssign) or value is None:
            continue
        for each in getattr(statement, "targets", None) or [target]:
            pairs = [(each, value)]
            if isinstance(each, ast.Tuple) and isinstance(value, ast.Tuple):
                pairs = zip(each.elts, value.elts, strict=False)
            for name, stands_for in pairs:
                if isinstance(name, ast.Name):
                    entry = (statement.end_lineno, path, stands_for)
                    values.setdefault(name.id, []).append(entry)


@cache
def _of_module(file):
    values = {}
    _values([node for node in trees()[file].body if not isinstance(node, FUNCTION)], values, [])
    return values


class Forms:
    """The forms of the expressions of a piece."""

    def __init__(self, piece):
        self.own, self.outer, self.blocks = {}, _of_module(piece.file), []
        if isinstance(piece.node, FUNCTION):
            self.own = {each.arg: [] for each in ast.walk(piece.node) if isinstance(each, ast.arg)}
            _values(piece.node.body, self.own, self.blocks)

    def _stands_for(self, name):
        """Return the expressions that a name may stand for at its place."""
        if name.id not in self.own:
            return [value for _, _, value in self.outer.get(name.id, ())]
        around = [each for each in self.blocks if each[0] <= name.lineno <= each[1]]
        here = max((path for *_, path in around), key=len, default=())
        live = []
        for end, path, value in self.own[name.id]:
            if end < name.lineno:
                # what is set anew on every way here is told no more
                always = here[: len(path)] == path
                live = [] if always else [each for each in live if each[0][: len(path)] != path]
                live.append((path, value))
        return [value for _, value in live]

    def of(self, node):
        """Return the forms of an expression, "{}" where the source does not say its text."""
        match node:
            case ast.Constant(value=str(text)):
                return [text]
            case ast.JoinedStr():
                return self._joined(node.values)
            case ast.FormattedValue(conversion=-1, format_spec=None):
                return self.of(node.value)
            case ast.IfExp():
                return self._several([node.body, node.orelse])
            case ast.BoolOp(op=ast.Or()):
                return self._several(node.values)
            case ast.BinOp(op=ast.Add()):
                return self._joined([node.left, node.right])
            case ast.Name():
                values = self._stands_for(node)
                return self._several(values) if 0 < len(values) < MOST else ["{}"]
        return ["{}"]

    def _several(self, nodes):
        forms = list(dict.fromkeys(form for node in nodes for form in self.of(node)))
        return forms if len(forms) <= MOST else ["{}"]

    def _joined(self, nodes):
        parts = [self.of(node) for node in nodes]
        if math.prod(map(len, parts)) > MOST:
            parts = [each if len(each) == 1 else ["{}"] for each in parts]
        return list(dict.fromkeys("".join(each) for each in product(*parts)))


def _told(piece):
    """Yield the expressions of a piece that are told, and whether one word is told as well."""
    returns = getattr(piece.node, "returns", None)
    text = returns is not None and ast.unparse(returns) in ("str", "str | None", "tuple[str, ...]")
    for each in ast.walk(piece.node):
        if isinstance(each, ast.Call):
            name = getattr(each.func, "id", getattr(each.func, "attr", ""))
            if name not in OF_PYTHON and name not in TEMPLATES:
                error = name.endswith("Error") and name != "MissingExtraError"
                yield from ((part, error) for part in each.args if MAKER.search(name))
                yield from ((key.value, False) for key in each.keywords if key.arg in PARTS)
            elif name == "Remark":  # what it is about
                yield each.args[0], False
        elif isinstance(each, ast.Return) and text and piece.file.startswith(REASONS):
            yield from [(each.value, False)] if each.value and piece.name != "__repr__" else ()


def messages():
    """Return each form with the places that tell it."""
    found = {}
    for piece in reached():
        if piece.file.startswith(ROOMS):
            forms = Forms(piece)
            for node, short in _told(piece):
                parts = node.elts if isinstance(node, ast.Tuple | ast.List) else [node]
                for form in (form for part in parts for form in forms.of(part)):
                    form = re.sub(r"(\{\})+", "{}", form).replace(" ()", "").strip(" ,;\n")
                    told = PHRASE.search(form) or (short and WORD.fullmatch(form))
                    if told and form[:1] not in "<[":
                        found.setdefault(form, []).append(f"{piece.file}:{node.lineno}")
    return found


BREAK = re.compile(r"(?<=[.!?]) (?=[A-Z]|⟦?\d+⟧? of ⟦?\d)")


class Words:
    """The words of a language, looked up as ``language.js`` does.

    >>> words = Words({"{} N": "{0} N", "the shoe": "der Schuh"})
    >>> words.has("3 N"), words.has("The shoe."), words.has("the shoe slips")
    (True, True, False)
    """

    def __init__(self, words):
        self.exact = {each for each in words if "{}" not in each}
        self.forms, self.known = [], {}
        for each in (one for one in words if "{}" in one):
            pieces = each.split("{}")
            text = "".join(pieces)
            few = re.fullmatch(r"\W*(\w+|\w{1,5} \w{1,5})\W*", text, re.ASCII)
            between = few and not re.search(r"\w", pieces[0] + pieces[-1], re.ASCII)
            beside = "{} {}" in each and len(text) < 9
            long = re.search("[A-Za-z]{4}|[A-Z]{2}", text)
            short = between or beside or len(text) < 6
            joins, length = short or not long, float(len(text))
            if short and not re.search(r"[^\w\s]", text):
                length = len(text) / 1e3 - 1
            if short and not re.search(r"\w", text):
                length = 0.0
            within = short and re.search(r"\w", text) and ";" not in text
            form = re.compile("(.+?)".join(map(re.escape, pieces)), re.S)
            whole = joins and re.search("[a-z]", text) is not None
            self.forms.append((length, joins, whole, within, form))
        self.forms.sort(key=lambda each: -each[0])

    def has(self, text):
        """Return whether every word of a text, with numbers for its parts, has a translation."""
        text = text.strip()
        if not re.search("[A-Za-z]{2}", text):
            return True
        if text not in self.known:
            self.known[text] = False  # what a form of itself would come back to
            self.known[text] = self._has(text)
        return self.known[text]

    def _has(self, text):
        small = text[0].lower() + text[1:]
        if self.exact & {text, small, text.removesuffix("."), small.removesuffix(".")}:
            return True
        if (known := self._by_form(text, small, joins=False)) is not None:
            return known
        where, _, what = text.partition(": ")
        if where in self.exact:
            return self.has(what)
        sentences = BREAK.split(text)
        if len(sentences) > 1:
            return all(map(self.has, sentences))
        if text.endswith("."):
            return self.has(text[:-1])
        return bool(self._by_form(text, small, joins=True))

    def _by_form(self, text, small, *, joins):
        for _, joining, whole, within, form in self.forms:
            if joining is not joins:
                continue
            for each in dict.fromkeys(
                (text, small, text.removesuffix("."), small.removesuffix("."))
            ):
                parts = form.fullmatch(each)
                if parts and within and any("; " in part for part in parts.groups()):
                    continue
                if parts and (joins or not any(map(BREAK.search, parts.groups()))):
                    known = all(map(self.has, parts.groups()))
                    if known or not whole:
                        return known
                    break
        return None


def filled(form, value="⟦{}⟧"):
    """Return a form with a value for each part, by its place."""
    pieces = form.split("{}")
    return "".join(
        piece + (value.format(k) if k < len(pieces) - 1 else "") for k, piece in enumerate(pieces)
    )
