"""What pages read from the program: ``{listed} NAME``, ``{default}`KEY```; terms become links.

Each list is a function that returns Markdown, so that no page holds a second copy of what the code
says. The pages of the Python interface are written before anything is read.
"""

import ast
import importlib
import inspect
import math
import re
import tomllib
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path

from docutils import nodes
from sphinx import addnodes
from sphinx.transforms import SphinxTransform
from sphinx.util.docutils import SphinxDirective, SphinxRole

DOCS = Path(__file__).parent
ROOT = DOCS.parent


# --- glossary ---------------------------------------------------------------------------------


def terms() -> str:
    """Return the words that ``underfoot explain`` knows, as a glossary."""
    from underfoot.case.terms import TERMS

    entries = "\n\n".join(
        f"{name}\n  {text[0].upper()}{text[1:]}"
        for name, text in sorted(TERMS.items(), key=_folded)
    )
    return f"```{{glossary}}\n{entries}\n```"


def _folded(item: tuple[str, str]) -> str:
    return item[0].casefold()


# --- commands ---------------------------------------------------------------------------------


@cache
def command_tree() -> dict[str, object]:
    """Return every command of the command line by its full name, without ``underfoot``."""
    from typer.main import get_command

    from underfoot.cli.app import app

    found: dict[str, object] = {}

    def collect(group, prefix: str) -> None:
        for name in group.list_commands(None):
            command = group.get_command(None, name)
            if hasattr(command, "list_commands"):
                collect(command, f"{prefix}{name} ")
            else:
                found[f"{prefix}{name}"] = command

    collect(get_command(app), "")
    return found


def option_names(command) -> set[str]:
    """Return every spelling of the options of a command, those of all commands among them."""
    return {
        name
        for parameter in command.params
        for name in (*parameter.opts, *parameter.secondary_opts)
        if name.startswith("-")
    } | {"--help"}


def commands() -> str:
    """Return a table of every command with its arguments, what it does and its options."""
    lines = ["| command | what it does | options |", "|---|---|---|"]
    for name, command in sorted(command_tree().items()):
        arguments = [
            re.sub(r"^\{(.*)\}$", r"\1", each.metavar or each.name or "").upper()
            for each in command.params
            if each.param_type_name == "argument"
        ]
        text = " ".join((command.help or "").partition("\n\n")[0].split())
        options = " ".join(
            f"`{'/'.join((max(each.opts, key=len), *each.secondary_opts))}`"
            for each in command.params
            if each.param_type_name == "option" and not each.hidden and each.name != "help"
        )
        call = " ".join(["underfoot", name, *arguments])
        lines.append(f"| `{call}` | {_cell(text)} | {options} |")
    return "\n".join(lines)


def _cell(text: str) -> str:
    """Return plain text as the text of a cell; code of docstrings becomes code."""
    return text.replace("|", "\\|").replace("[[", "\\[[").replace("*", "\\*").replace("``", "`")


# --- options and defaults ---------------------------------------------------------------------


def option_table(slot: str) -> str:
    """Return the options of a slot of case files, with what each cites; the default is marked."""
    from underfoot.case.parts import slot_table

    option = slot_table()[slot]
    lines = [f"| `{slot}.{option.key}` | what | source |", "|---|---|---|"]
    for name, each in option.options().items():
        text = " ".join((inspect.getdoc(each) or "").partition("\n\n")[0].split())
        usual = " (default)" if name == option.usual else ""
        lines.append(f"| `{name}`{usual} | {_cell(text)} | {_cell(str(each.source))} |")
    return "\n".join(lines)


def default_text(path: str) -> str:
    """Return the default of a key of case files, as ``underfoot explain`` prints it.

    Raises:
        KeyError: No such key, or one without a default.
    """
    from underfoot.case.parts import field_at, keys
    from underfoot.case.quantity import default_of

    if path in (slots := keys()):
        return slots[path].usual
    field = field_at(path)
    known = default_of(field) if field is not None else None
    if known is not None:
        return str(known.text)
    if field is None or field.is_required():
        raise KeyError(path)
    return str(field.default)


# --- equations of the report ------------------------------------------------------------------


def equations() -> str:
    """Return the 27 equations of the report with the code that computes each."""
    from underfoot.case.equations import EQUATIONS

    lines = ["| Eq. | in the report | says | computed by |", "|---|---|---|---|"]
    for number, each in EQUATIONS.items():
        code = ", ".join(f"`{path.removeprefix('underfoot.')}`" for path in each.code)
        note = f"; {each.note}" if each.note else ""
        lines.append(f"| {number} | {each.place} | {_cell(each.title + note)} | {code or '-'} |")
    return "\n".join(lines)


# --- references -------------------------------------------------------------------------------

_YEAR = re.compile(r"\b(?:1[6-9]\d\d|20[0-3]\d)\b")
_SURNAME = re.compile(r"\b(?:Mc|De|Di)?[A-ZÄÖÜ][a-zäöüéèøåß]+(?:-[A-Z][a-zäöü]+)?")
_INITIALS = re.compile(r"(?:[A-Z]\.[- ]?)+$")
_STANDARD = re.compile(r"\b(?:EN ISO|ISO/TR|ISO|ASTM|ANSI|DIN|EN|BS)[ -][A-Z]?\d[\d.-]*\d")
_NO_NAME = set(
    "The Table Tables Fig Figure Eq Eqs Report Grant Final Section Contact Phys Rev Wear Annex "
    "Proc Soc Int Appl Mech Tribol Trans Version Sci Safety Science Statistical Limits That This "
    "May Since Definitions From Available Required Springer Oxford Thesis Chapter Range Boundary "
    "Friction Roughness Analysis Code Linear Water Shore Dry Goal After Before Chem Rubber Newton "
    "Biometrics In Of Pa Int On It If Dow An As At By To No Ra Rq Rz Formula Am Stat".split()
)


def sourced_texts() -> Iterator[tuple[str, str]]:
    """Yield every source that code, data and pages of the physics state: the file and the text."""
    for path in ROOT.glob("src/**/*.py"):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef):
                for found in re.findall(
                    r"Sources?:\s*(.*?)(?=\n\n|\Z)", ast.get_docstring(node) or "", re.DOTALL
                ):
                    yield _place(path), " ".join(found.split())
            elif isinstance(node, ast.Assign | ast.AnnAssign | ast.keyword):
                if not isinstance(node.value, ast.Constant):
                    continue
                named = node.arg if isinstance(node, ast.keyword) else ast.unparse(_target(node))
                if "source" in (named or "").casefold():
                    yield _place(path), str(node.value.value)
    for path in ROOT.glob("src/underfoot/data/**/*.toml"):
        for text in _stated(tomllib.loads(path.read_text("utf-8"))):
            yield _place(path), text
    for path in DOCS.glob("physics/*.md"):
        for text in re.findall(r"^\| Sources? \| (.*) \|$", path.read_text("utf-8"), re.MULTILINE):
            yield _place(path), text


def _target(node: ast.Assign | ast.AnnAssign) -> ast.expr:
    return node.targets[0] if isinstance(node, ast.Assign) else node.target


def _stated(item: object) -> Iterator[str]:
    if isinstance(item, dict):
        for key, value in item.items():
            if key in ("source", "reference") and isinstance(value, str):
                yield value
            else:
                yield from _stated(value)
    elif isinstance(item, list):
        for value in item:
            yield from _stated(value)


def _place(path: Path) -> str:
    """Return a page as a link target, a module by its dotted name, data by its path."""
    inside = path.relative_to(ROOT)
    if path.suffix == ".md":
        return f"/{path.relative_to(DOCS)}"
    if path.suffix == ".py":
        parts = inside.with_suffix("").parts
        return ".".join(parts[1 if parts[0] == "src" else 2 :]).removesuffix(".__init__")
    return str(inside).removeprefix("src/underfoot/")


def cited(text: str) -> Iterator[tuple[str, str]]:
    """Yield key and words of each publication that a source names: first author and year, or the
    number of a standard."""
    for part in re.split(r";\s", text):
        if standard := _STANDARD.search(part):
            yield standard.group(0).replace("-", " ", 1), part.strip()
            continue
        years = list(_YEAR.finditer(part))
        if not years or part.startswith(("report", "final progress report", "grant report")):
            continue
        before = _SURNAME.finditer(part[: years[-1].end()])
        if (name := next((each for each in before if each.group(0) not in _NO_NAME), None)) is None:
            continue
        initials = _INITIALS.search(part[: name.start()])
        start = initials.start() if initials else name.start()
        author = name.group(0).replace("ü", "ue").replace("ö", "oe")
        yield f"{author} {years[0].group(0)}", part[start:].strip().rstrip(".")


@cache
def references() -> dict[str, tuple[str, tuple[str, ...]]]:
    """Return every publication by its key: its fullest words and where it is used."""
    words: dict[str, str] = {}
    uses: dict[str, set[str]] = {}
    for place, text in sourced_texts():
        for key, entry in cited(text):
            words[key] = max(words.get(key, ""), entry, key=len)
            uses.setdefault(key, set()).add(place)
    for path in (*DOCS.glob("physics/*.md"), *DOCS.glob("guide/*.md")):
        text = " ".join(path.read_text("utf-8").split())
        for key in words:
            author, _, year = key.rpartition(" ")
            pattern = rf"\b{author}\b[^;|.]{{0,60}}\b{year}\b" if _YEAR.fullmatch(year) else key
            if re.search(pattern, text):
                uses[key].add(_place(path))
    return {key: (words[key], tuple(sorted(uses[key]))) for key in sorted(words)}


def reference_list() -> str:
    """Return the list of publications, each with the places that use it."""
    lines = []
    for text, places in sorted(references().values(), key=lambda each: _by_author(each[0])):
        used = ", ".join(
            f"[{Path(each).stem.replace('_', ' ')}]({each})" if each[0] == "/" else f"`{each}`"
            for each in places
        )
        lines.append(f"- {_cell(text)}. *Used by* {used}.")
    return "\n".join(lines)


def _by_author(text: str) -> str:
    names = [name for name in _SURNAME.findall(text) if name not in _NO_NAME]
    standard = _STANDARD.match(text)
    return (
        (standard.group(0) if standard or not names else names[0]).casefold()
        if (standard or names)
        else text.casefold()
    )


# --- symbols ----------------------------------------------------------------------------------


@cache
def symbol_rows() -> tuple[dict[str, str], ...]:
    """Return the table of symbols: symbol (LaTeX), meaning, unit, pages of the physics."""
    table = tomllib.loads((DOCS / "reference" / "symbols.toml").read_text("utf-8"))
    return tuple(table["symbol"])


def symbols() -> str:
    """Return the symbols of the physics, each with its unit and the pages that use it."""
    lines = ["| symbol | meaning | unit | pages |", "|---|---|---|---|"]
    for row in symbol_rows():
        pages = ", ".join(
            f"[{page.replace('_', ' ')}](/physics/{page}.md)" for page in row["pages"].split()
        )
        lines.append(f"| ${row['symbol']}$ | {row['meaning']} | {row['unit']} | {pages} |")
    return "\n".join(lines)


# --- scores -----------------------------------------------------------------------------------


def scores() -> dict[str, str]:
    """Return the numbers of the two pages that studies write: corpus and printed statements."""
    corpus = (DOCS / "studies" / "corpus.md").read_text("utf-8")
    summary = (DOCS / "studies" / "summary.md").read_text("utf-8")

    def cells(name: str) -> list[str]:
        row = re.search(rf"^\| {re.escape(name)} \|(.*)\|$", corpus, re.MULTILINE)
        assert row, name
        return [cell.strip(" *") for cell in row.group(1).split("|")]

    heads = re.search(r"^\| study \|(.*)\|$", summary, re.MULTILINE)
    counts = re.search(r"^\| all \|(.*)\|$", summary, re.MULTILINE)
    assert heads
    assert counts
    verdicts = dict(
        zip(
            (each.strip() for each in heads.group(1).split("|")),
            (each.strip() for each in counts.group(1).split("|")),
            strict=True,
        )
    )
    pair, ridge = cells("**pair**"), cells("ridge, five features")
    line, constant = cells("line in ln(viscosity x speed)"), cells("one constant")
    readings, laboratories = cells("readings"), cells("laboratories, handbooks and standards")
    return {
        "r2": pair[0],
        "r2_all": pair[3],
        "inside": pair[4],
        "rms": pair[1],
        "factor": f"{math.exp(float(pair[1])):.2f}",
        "ridge": ridge[0],
        "line": line[0],
        "constant": constant[0],
        "readings": readings[1],
        "laboratories": laboratories[1],
        "statements": str(sum(map(int, verdicts.values()))),
        **{name.replace(" ", "_"): count for name, count in verdicts.items()},
    }


def score_table() -> str:
    """Return the table of README.md, which no directive can fill."""
    return """\
| asked of the friction law | answer |
|---|---|
| share of the variance of ln COF explained, in laboratories it was not fitted to | {r2} |
| typical error there | a factor of {factor} |
| readings, laboratories ([the corpus](docs/studies/corpus.md)) | {readings}, {laboratories} |
| statements of its [source report](docs/studies/report.md): \
all, agreeing, disagreeing ([each](docs/studies/summary.md)) \
| {statements}, {agrees}, {disagrees} |
""".format(**scores())


# --- pages of the Python interface ------------------------------------------------------------

ROOMS = {
    "Units, materials, surfaces, fluids": (
        "underfoot.core", "underfoot.core.catalogue", "underfoot.reference", "underfoot.material",
        "underfoot.surface", "underfoot.fluid",
    ),
    "Contact, film, friction": (
        "underfoot.rough_contact", "underfoot.block", "underfoot.film", "underfoot.friction",
    ),
    "Whole shoe and slip": (
        "underfoot.shoe", "underfoot.shoe.files", "underfoot.shoe.parametric",
        "underfoot.shoe.worn", "underfoot.sole_contact", "underfoot.sole_contact.compliance",
        "underfoot.sole_contact.finite_element", "underfoot.slip", "underfoot.slip.dynamics",
    ),
    "Cases and questions": (
        "underfoot.case", "underfoot.compute.run", "underfoot.compute.slips",
        "underfoot.questions.risk", "underfoot.questions.effects", "underfoot.questions.changes",
        "underfoot.questions.method", "underfoot.questions.wear", "underfoot.questions.sensitivity",
        "underfoot.questions.outcomes", "underfoot.calibrate", "underfoot.studies",
        "underfoot.report", "underfoot.explore.study", "underfoot.explore.sweeps",
        "underfoot.explore.plan", "underfoot.explore.study_file",
        "underfoot.explore.goals", "underfoot.explore.result",
        "underfoot.explore.surrogate", "underfoot.explore.effects",
        "underfoot.explore.posterior", "underfoot.places.choice", "underfoot.places.machines",
    ),
    "Measurements": (
        "underfoot.trials", "underfoot.trials.recording.protocols",
        "underfoot.trials.machines.stribeck_fit", "underfoot.trials.machines.compression",
        "underfoot.trials.machines.pressure_map", "underfoot.trials.study.folder",
        "underfoot.trials.study.file_result", "underfoot.trials.study.study",
        "underfoot.trials.study.tables", "underfoot.trials.machines.pin_on_disk",
        "underfoot.trials.study.boundary", "underfoot.trials.machines.relaxation_test",
        "underfoot.trials.statistics", "underfoot.trials.simulator",
    ),
}  # fmt: skip
LONGEST_PAGE = 150
"""Lines of docstrings on one page: about 12,000 pixels on a laptop."""


def public_names(module: str) -> dict[str, object]:
    """Return the public functions and classes that a module defines or a room shows."""
    room = importlib.import_module(module)
    names = sorted({*dir(room), *getattr(room, "__all__", ())})
    items = {name: getattr(room, name) for name in names if name[0] != "_"}
    return {
        name: item
        for name, item in items.items()
        if (inspect.isfunction(item) or inspect.isclass(item))
        and (item.__module__ == module or item.__module__.startswith(module + "."))
    }


def _length(item: object) -> int:
    text = (inspect.getdoc(item) or "").splitlines()
    inner = (
        [each for name, each in vars(item).items() if name[0] != "_"]
        if inspect.isclass(item)
        else []
    )
    documented = [each for each in inner if callable(each) or isinstance(each, property)]
    return (
        3
        + len(text)
        + sum(3 + len((inspect.getdoc(each) or "").splitlines()) for each in documented)
    )


def write_interface_pages(folder: Path) -> list[str]:
    """Write a page for each room, several where a room has much to say; return their names."""
    examples = dict(
        re.findall(
            r"^## (\S+)\n(.*?)(?=^## |\Z)", (DOCS / "api/examples.md").read_text("utf-8"),
            re.DOTALL | re.MULTILINE,
        )
    )  # fmt: skip
    seen: set[int] = set()
    pages: dict[str, str] = {}
    index = []
    for title, modules in ROOMS.items():
        listed = []
        for module in modules:
            items = {k: v for k, v in public_names(module).items() if id(v) not in seen}
            seen |= set(map(id, items.values()))
            if not items:
                continue
            sheets: list[list[str]] = [[]]
            used = 0
            for name in sorted(items, key=lambda each: (items[each].__module__, each)):
                size = _length(items[name])
                if used and used + size > LONGEST_PAGE:
                    sheets.append([])
                    used = 0
                sheets[-1].append(name)
                used += size
            for number, names in enumerate(sheets, start=1):
                stem = module.replace(".", "_") + (f"_{number}" if len(sheets) > 1 else "")
                pages[stem] = _page(module, names, items, number, len(sheets), examples)
                listed.append(stem)
        index.append(
            f"## {title}\n\n```{{toctree}}\n:maxdepth: 1\n" + "\n".join(listed) + "\n```\n"
        )
    pages["index"] = "# By room\n\n" + "\n".join(index)
    _write_pages(folder, pages)
    return list(pages)


def _write_pages(folder: Path, pages: dict[str, str]) -> None:
    """Leave these pages and no others in a folder; one that says the same stays as it is."""
    folder.mkdir(exist_ok=True)
    for path in folder.glob("*.md"):
        if path.stem not in pages:
            path.unlink()
    for stem, text in pages.items():
        path = folder / f"{stem}.md"
        if not path.exists() or path.read_text("utf-8") != text:
            path.write_text(text, "utf-8")


def _page(
    module: str, names: list[str], items: dict, number: int, count: int, examples: dict[str, str]
) -> str:
    summary = (inspect.getdoc(importlib.import_module(module)) or "").partition("\n\n")[0]
    part = f", {number} of {count}: {names[0]} to {names[-1]}" if count > 1 else ""
    text = [f"# `{module}`{part}", " ".join(summary.split()).replace("``", "`")]
    if number == 1 and module in examples:
        text += ["An example, run with the tests:", examples[module].strip()]
    file = ""
    for name in names:
        if items[name].__module__ != file:
            file = items[name].__module__
            text.append(f"## From `{file}`")
        kind = "autoclass" if inspect.isclass(items[name]) else "autofunction"
        members = "\n   :members:" if kind == "autoclass" else ""
        text.append(f"```{{eval-rst}}\n.. {kind}:: {module}.{name}{members}\n```")
    return "\n\n".join(text) + "\n"


# --- notes of each version --------------------------------------------------------------------


def write_version_pages(folder: Path) -> list[str]:
    """Write what each released version broke, and what else it changed; return the pages' names."""
    pages: dict[str, str] = {}
    changes = (ROOT / "CHANGELOG.md").read_text("utf-8").replace("](docs/", "](../../")
    for version, date, notes in re.findall(
        r"^## (\d\S*) \((\S+)\)\n(.*?)(?=^## |\Z)", changes, re.DOTALL | re.MULTILINE
    ):
        sections = re.split(r"^(?=### )", notes.strip(), flags=re.MULTILINE)
        breaking = [text for text in sections if text.startswith("### Breaking")]
        others = [text for text in sections if text not in breaking]
        for what, some in (("what breaks", breaking), ("what is new and mended", others)):
            title = f"# {version} ({date}): {what}\n\n"
            pages[f"{version}_{what.split()[-1]}"] = title + "".join(some).replace("### ", "## ")
    _write_pages(folder, pages)
    return list(pages)


# --- Sphinx -----------------------------------------------------------------------------------

LISTS: dict[str, Callable[[], str]] = {
    "terms": terms,
    "commands": commands,
    "equations": equations,
    "references": reference_list,
    "symbols": symbols,
}


class Listed(SphinxDirective):
    """A list that the code writes; ``options SLOT`` are the options of a slot of case files.

    ``scores`` fills its content with the numbers of the studies, as ``{r2}``.
    """

    required_arguments = 1
    optional_arguments = 1
    has_content = True

    def run(self) -> list[nodes.Node]:
        """Return the list, parsed as Markdown."""
        name = self.arguments[0]
        if name == "scores":
            text = "\n".join(self.content).format(**scores())
        elif name == "options":
            text = option_table(self.arguments[1])
        else:
            text = LISTS[name]()
        return self.parse_text_to_nodes(text)


class Default(SphinxRole):
    """The default of a key of case files, read from the code."""

    def run(self) -> tuple[list[nodes.Node], list[nodes.system_message]]:
        """Return the value in the type of code."""
        return [nodes.literal(self.text, default_text(self.text))], []


MINUTES = {"app": 2, "designer": 3, "ergonomist": 4, "laboratory": 2, "tribologist": 1}
"""That the commands of a tutorial take at most, of one processor."""


class Minutes(SphinxRole):
    """The time of a tutorial."""

    def run(self) -> tuple[list[nodes.Node], list[nodes.system_message]]:
        """Return it in words."""
        count = MINUTES[self.text]
        return [nodes.Text(f"{count} minute{'s' * (count > 1)}")], []


class TermLinks(SphinxTransform):
    """Link the first mention of each term of the glossary on a page to the glossary."""

    default_priority = 400
    skipped = (
        *(nodes.title, nodes.reference, nodes.literal, nodes.literal_block, nodes.math),
        *(nodes.math_block, nodes.raw, nodes.term, addnodes.pending_xref, addnodes.desc),
    )

    def apply(self, **kwargs: object) -> None:
        """Replace words by references; pages of the interface and the glossary stay as they are."""
        if self.env.docname.startswith(("api/", "reference/")):
            return
        open_terms = _term_patterns()
        for text in list(self.document.findall(nodes.Text)):
            if not open_terms:
                return
            if _inside(text, self.skipped):
                continue
            pieces = self._linked(str(text), open_terms)
            if len(pieces) > 1:
                text.parent.replace(text, pieces)

    def _linked(self, text: str, open_terms: dict[str, re.Pattern[str]]) -> list[nodes.Node]:
        first = min(
            ((found.start(), name, found) for name, pattern in open_terms.items()
             if (found := pattern.search(text))),
            key=lambda each: (each[0], -len(each[1])), default=None,
        )  # fmt: skip
        if first is None:
            return [nodes.Text(text)] if text else []
        start, name, found = first
        del open_terms[name]
        link = addnodes.pending_xref(
            "", refdomain="std", reftype="term", reftarget=name, refdoc=self.env.docname,
            refexplicit=True, refwarn=True,
        )  # fmt: skip
        link += nodes.inline("", found.group(0), classes=["std-term", "jargon"])
        before = [nodes.Text(text[:start])] if start else []
        return [*before, link, *self._linked(text[found.end() :], open_terms)]


def _term_patterns() -> dict[str, re.Pattern[str]]:
    from underfoot.case.terms import TERMS

    return {
        name: re.compile(
            rf"(?<![\w-]){re.escape(name)}(?![\w-])",
            0 if name != name.lower() else re.IGNORECASE,
        )
        for name in TERMS
    }


def _inside(node: nodes.Node, kinds: tuple[type, ...]) -> bool:
    while (node := node.parent) is not None:
        if isinstance(node, kinds):
            return True
    return False


def setup(app) -> dict[str, bool]:
    """Called by Sphinx."""
    app.add_directive("listed", Listed)
    app.add_role("default", Default())
    app.add_role("minutes", Minutes())
    app.add_transform(TermLinks)
    app.connect("builder-inited", lambda _: write_interface_pages(DOCS / "api" / "rooms"))
    app.connect("builder-inited", lambda _: write_version_pages(DOCS / "reference" / "versions"))
    return {"parallel_read_safe": True}
