"""House rules that the source shows: circles, start, paths of machines, versions."""

import ast
import os
import pkgutil
import re
import subprocess
import sys
import tomllib
from functools import cache
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

from source_trees import nodes, tree

REPOSITORY = Path(__file__).resolve().parents[2]
SOURCE = REPOSITORY / "src"
START = 0.2  # of the CPU time of NumPy, SciPy and pydantic that `import underfoot` may take
SAY_NOTHING = {"found", "kept", "one", "own", "said", "there", "words"}
WITH_AN_EXTRA = {
    "underfoot.app": {"fastapi", "nicegui", "uvicorn"},  # the command asks for them
    "underfoot.block._kernels": {"numba"},  # the package asks for it
    "underfoot.core.compiled": {"numba"},  # loops run interpreted without
    "underfoot.explore.store": {"duckdb"},
    "underfoot.sole_contact.finite_element.elasticity": {"ngsolve"},  # its mesh asks for it
}
"""What imports a package that a bare installation lacks, other than by ``optional_module``."""
BROUGHT = {"PIL": "matplotlib", "pydantic_core": "pydantic"}
FIRST = 2.2  # of it until a case is read and all that `run` needs is imported


def files(folders=(SOURCE,)):
    """Return the path of each module by its dotted name."""
    paths = {}
    for folder in folders:
        for path in sorted(folder.rglob("*.py")):
            parts = path.relative_to(folder).with_suffix("").parts
            paths[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return paths


@cache
def import_statements(path):
    """Return the import statements of a file, at any depth."""
    waiting, statements = [tree(path)], []
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.Import | ast.ImportFrom):
            statements.append(node)
        for inside in ("body", "orelse", "finalbody", "handlers", "cases"):
            waiting += getattr(node, inside, ())
    return statements


def imports(name, path, known):
    """Return which known modules a file names in import statements, wherever they stand."""
    package = name.split(".") if path.name == "__init__.py" else name.split(".")[:-1]
    needed = set()
    for node in import_statements(path):
        if isinstance(node, ast.Import):
            needed |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            above = package[: len(package) - node.level + 1] if node.level else []
            home = ".".join([*above, *([node.module] if node.module else [])])
            for alias in node.names:
                inner = f"{home}.{alias.name}"
                needed.add(inner if inner in known else home)
    return (needed & known) - {name}


def circle(graph):
    """Return one circle of a graph as text, or None."""
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        return " <- ".join(error.args[1])
    return None


def test_imports_are_read_in_every_form(tmp_path):
    path = tmp_path / "x.py"
    path.write_text(
        "import p.a\nfrom . import b\nfrom .c import name\nfrom ..q import d\n"
        "def f():\n    from p.r.e import g\nif TYPE_CHECKING:\n    from .t import T\n"
        "try:\n    import p.f\nexcept E:\n    import p.g\nelse:\n    with x:\n        import p.h\n"
        "finally:\n    match x:\n        case 1:\n            import p.i\n"
    )
    known = {"p.a", "p.r.b", "p.r.c", "p.q.d", "p.r.e", "p.r.t", "p.r.x", "p.r"}
    known |= {f"p.{letter}" for letter in "fghi"}
    assert imports("p.r.x", path, known) == known - {"p.r.x", "p.r"}


def test_no_files_import_each_other_in_a_circle():
    """Imports for types and inside functions count: a reader needs an order too."""
    paths = files()
    graph = {name: imports(name, path, set(paths)) for name, path in paths.items()}
    assert circle(graph) is None, circle(graph)


def test_circle_is_told_as_a_path():
    assert circle({"a": {"b"}, "b": {"c"}, "c": set()}) is None
    assert circle({"a": {"b"}, "b": {"c"}, "c": {"a"}}).count("<-") == 3


def test_a_bare_installation_has_what_is_imported_without_a_word():
    """Pages drew with a package of an extra once: the main job then failed where it was missing."""
    project = tomllib.loads((REPOSITORY / "pyproject.toml").read_text())["project"]
    bare = {re.split(r"[^\w-]", line)[0].replace("-", "_") for line in project["dependencies"]}
    bare |= {name for name, above in BROUGHT.items() if above in bare}
    lacking = set()
    for name, path in files().items():
        allowed = {p for room, some in WITH_AN_EXTRA.items() for p in some if is_in(name, room)}
        for node in import_statements(path):
            modules = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            if isinstance(node, ast.ImportFrom) and not node.level:
                modules = [node.module]
            tops = {module.partition(".")[0] for module in modules} - set(sys.stdlib_module_names)
            lacking |= {(name, top) for top in tops - {"underfoot"} - bare - allowed}
    assert not lacking


def is_in(name, room):
    """Return whether a module is this one or lies in this package."""
    return f"{name}.".startswith(f"{room}.")


def test_what_is_loaded_takes_little_time_beside_numpy_scipy_and_pydantic():
    """In CPU seconds of one moment: a busy machine is slow for one of three starts, not for all."""
    parts = ("fft", "linalg", "ndimage", "sparse", "special")
    libraries = "import numpy, pydantic, " + ", ".join(f"scipy.{part}" for part in parts)
    case = "uf.load('examples/work_shoe_full_tread_glycerol.toml')"
    codes = (libraries, "import underfoot", f"import underfoot as uf; uf.run; {case}")
    environment = {**os.environ, "PYTHONPATH": str(SOURCE)}
    # without bytecode every start compiles what was changed
    environment.pop("PYTHONDONTWRITEBYTECODE", None)

    def seconds(code: str) -> float:
        script = f"import time; s = time.process_time(); {code}; print(time.process_time() - s)"
        printed = subprocess.run(
            [sys.executable, "-c", script],
            cwd=REPOSITORY, env=environment, capture_output=True, text=True, check=True,
        )  # fmt: skip
        return float(printed.stdout)

    rounds = ([seconds(code) for code in codes] for _ in range(5))
    assert any(start < START * least and first < FIRST * least for least, start, first in rounds)


def test_no_line_names_a_path_of_a_machine():
    path = re.compile(r"""["'\s](/(?:home|root|work|Users|mnt|opt)/|[A-Z]:\\)""")
    lines = [
        f"{file.relative_to(REPOSITORY)}:{number}"
        for folder in ("src", "docs", "examples")
        for file in (REPOSITORY / folder).rglob("*")
        if file.suffix in {".py", ".md", ".toml", ".css", ".js", ".html"}
        for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1)
        if path.search(line)
    ]
    assert not lines


def test_lock_holds_each_dependency_at_an_allowed_version():
    settings = tomllib.loads((REPOSITORY / "pyproject.toml").read_text())
    project = settings["project"]
    text = (REPOSITORY / "requirements.lock").read_text()
    locked = {
        re.sub(r"[-_.]+", "-", name).lower(): version
        for name, version in re.findall(r"^([\w.-]+)==([\w.]+)", text, re.MULTILINE)
    }

    def numbers(version):
        return [int(part) for part in re.findall(r"\d+", version)]

    wanted = [*project["dependencies"]]
    for name, extra in (project["optional-dependencies"] | settings["dependency-groups"]).items():
        if name != "accelerator":  # a gigabyte that goes by the machine's graphics processor
            wanted += [line for line in extra if not line.startswith("underfoot[")]
    for line in wanted:
        match = re.match(r"([\w.-]+)>=([\w.]+)", line)
        assert match, f"no lowest version: {line}"
        name = re.sub(r"[-_.]+", "-", match[1]).lower()
        assert numbers(locked[name]) >= numbers(match[2]), line


def test_each_package_that_the_source_imports_is_declared():
    """In the dependencies, or in an extra; what comes along with another package does not count."""
    project = tomllib.loads((REPOSITORY / "pyproject.toml").read_text())["project"]
    lines = [*project["dependencies"]]
    for extra in project["optional-dependencies"].values():
        lines += extra
    declared = {re.split(r"[^\w.-]", line)[0].lower().replace("-", "_") for line in lines}
    declared |= {"netgen", "pydantic_core"}  # of NGSolve, pydantic
    declared |= {"pil"} if "pillow" in declared else set()
    imported = {
        name.partition(".")[0].lower() for path in files().values() for name in imported_names(path)
    }
    standard = {name.lower() for name in sys.stdlib_module_names}
    ours = {path.name for path in SOURCE.iterdir()}
    assert imported - declared - standard <= ours


def imported_names(path):
    """Yield the modules that statements import and calls of ``optional_module`` name."""
    for node in import_statements(path):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and not node.level:
            yield node.module
    yield from re.findall(r"\boptional_module\(\s*\"([\w.]+)\"", path.read_text(encoding="utf-8"))


def test_one_version_stands_everywhere():
    version = tomllib.loads((REPOSITORY / "pyproject.toml").read_text())["project"]["version"]
    assert f"\nversion: {version}\n" in (REPOSITORY / "CITATION.cff").read_text()
    assert re.search(rf"^## {re.escape(version)} ", (REPOSITORY / "CHANGELOG.md").read_text(), re.M)


def test_the_map_for_contributors_names_every_room():
    told = (REPOSITORY / "CONTRIBUTING.md").read_text().split("```")[1]
    rooms = {path.parent.name for path in (SOURCE / "underfoot").glob("*/__init__.py")}
    assert rooms - {"data"} <= set(re.findall(r"\w+", told))


def names_of(path):
    """Yield the names of functions, their parameters and fields in a file, with their lines."""
    for node in nodes(path):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            yield node.name, node.lineno
            yield from (
                (each.arg, each.lineno) for each in ast.walk(node.args) if hasattr(each, "arg")
            )
        elif isinstance(node, ast.ClassDef):
            for field in node.body:
                if isinstance(field, ast.AnnAssign) and isinstance(field.target, ast.Name):
                    yield field.target.id, field.lineno
        elif isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store):
            yield node.attr, node.lineno


def test_a_public_class_has_its_name_alone():
    homes = {}
    for name, path in files().items():
        for node in tree(path).body:
            if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                homes.setdefault(node.name, []).append(name)
    assert {name: where for name, where in homes.items() if len(where) > 1} == {}


LONE = re.compile(
    r"(?!_read$)_?([a-z]+(?<!e)ed|told|made|drawn|found|shown|given|chosen|read|written|held|known|taken"
    r"|built|laid|left|begun|fallen|seen|worn|spread)"
)
NO_LONE = {
    "underfoot.case.quantity": "plug-ins import ``required``",
    "underfoot.studies.pair_law": "stored fits have keys that hash its text",
    "underfoot.app.work": "jobs of a project on disk name it",
    "underfoot.app.work_studies": "as work",
    "underfoot.app.work_table": "as work",
}


def test_no_function_is_a_lone_participle():
    """What a property holds may be named by one: ``self._drawn``."""
    lone = [
        f"{name}:{node.lineno} {node.name}"
        for name, path in files().items()
        if name not in NO_LONE
        for node in nodes(path)
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)
        and LONE.fullmatch(node.name)
        and not any(
            "property" in (text := ast.unparse(each)) or text.endswith(".setter")
            for each in node.decorator_list
        )
    ]
    assert lone == []


def test_names_of_functions_parameters_and_fields_say_what_they_are():
    empty = [
        f"{path.relative_to(REPOSITORY)}:{line} {name}"
        for path in sorted(SOURCE.rglob("*.py"))
        for name, line in names_of(path)
        if name.strip("_") in SAY_NOTHING
    ]
    assert not empty


def test_each_costly_test_is_there_once():
    lines = (REPOSITORY / "tests/costly.txt").read_text("utf-8").splitlines()
    file, text, seen = "", "", set()
    for line in lines:
        if line.startswith("tests/"):
            file = line
            text = (REPOSITORY / file).read_text("utf-8")
        elif line.startswith("  "):
            assert f"def {line.strip()}(" in text, (file, line)
            assert (file, line) not in seen, (file, line)
            seen.add((file, line))


def test_names_that_texts_of_the_source_give_are_there_and_not_old():
    """A remedy that names a function, a docstring that names a class: with its full path."""
    gone = []
    for name, path in files().items():
        if name == "underfoot.core.moved":
            continue  # pairs of old and new
        for node in nodes(path):
            if isinstance(node, ast.Constant) and isinstance(node.value, str):
                for text in re.findall(r"\bunderfoot(?:\.\w+)+", node.value):
                    try:
                        pkgutil.resolve_name(text)
                    except (AttributeError, ImportError, FutureWarning):
                        gone.append(f"{name}:{node.lineno} {text}")
    doors = {"underfoot.catalogues", "underfoot.DOOR"}  # groups of entry points
    assert [each for each in gone if each.split()[1] not in doors] == []
