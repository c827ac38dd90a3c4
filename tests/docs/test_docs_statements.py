"""No stale sentence: what pages name of the program is there, and defaults are what they say.

Every word in code type is looked up. A call is held to the command and its options, a dotted key to
the keys of case files, a value to what its key allows, a file to the repository, a name to the
code; everything else must at least be a word of the program. Defaults stand on pages by the role
``{default}`` or the list ``options``; the few that pages explain in words have a value here.
"""

import importlib
import inspect
import re
import shlex
import subprocess
import sys
import tomllib
from functools import cache
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "docs"))

import generated

from underfoot.case.explanation import explanation
from underfoot.case.parts import FILE_VERSION, field_at, keys, paths, slot_table
from underfoot.core import InputError
from underfoot.core.catalogue import KINDS, catalogue
from underfoot.explore.study_file import FILE_VERSION as STUDY_VERSION
from underfoot.questions.method import NICKNAMES
from underfoot.questions.worn_states import MODES
from underfoot.studies import studies
from underfoot.trials import RcofDefinition
from underfoot.trials.recording.protocols import protocol_names

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
CODE = re.compile(r"(?<![`\w}])`([^`\n]+(?:\n[^`\n]+)?)`(?!`)")
ROLE = re.compile(r"\{[\w:]+\}`[^`]+`")
GENERATED = {"rooms", "versions"}  # of the code and of CHANGELOG.md, which names what is gone
PAGES = [
    ROOT / "README.md",
    ROOT / "CONTRIBUTING.md",
    *(page for page in sorted(DOCS.rglob("*.md")) if page.parent.name not in GENERATED),
]
WRITTEN = {"report.md", "summary.md"}  # pages that studies write, held to them elsewhere


def prose(page):
    return re.sub(r"^```.*?^```", "", page.read_text(), flags=re.DOTALL | re.MULTILINE)


def spans(page):
    """Return everything in code type outside of blocks, cells of tables with their bars."""
    text = ROLE.sub("", prose(page))
    return [" ".join(found.replace("\\|", "|").split()) for found in CODE.findall(text)]


def calls(page):
    """Return every call of the program: inline, and each line of blocks that a reader types."""
    lines = [
        call for span in spans(page) if span.startswith("underfoot ") for call in span.split("; ")
    ]
    lines = [line for line in lines if line.startswith("underfoot ")]
    for language, body in re.findall(
        r"^```(\w*)\n(.*?)^```", page.read_text(), re.DOTALL | re.MULTILINE
    ):
        if language in ("", "sh"):
            lines += [
                line.strip()
                for line in body.replace("\\\n", " ").splitlines()
                if line.strip().startswith("underfoot ")
            ]
    return lines


PLACEHOLDERS = {"COMMAND", "NAME", "GROUP", "..."}


def problem_of(call):
    """Return what is wrong with a call, or ""."""
    text = re.sub(r"\s+#\s.*", "", call).split(" && ")[0].split(" > ")[0]
    text = re.sub(r"[\[\]]", " ", text).partition(", ")[0]
    try:
        words = shlex.split(text)[1:]
    except ValueError:
        words = text.split()[1:]
    tree = generated.command_tree()
    groups = {name.split()[0] for name in tree if " " in name}
    while words and words[0].startswith("-"):  # options of the program itself
        if words[0] not in ("--version", "--units", "--help"):
            return f"no option {words[0]}"
        words = words[2 if words[0] == "--units" else 1 :]
    if not words or words[0] in PLACEHOLDERS:
        return ""
    name = words[0]
    if name in groups:
        if len(words) == 1 or words[1] in PLACEHOLDERS:
            return ""
        name = f"{name} {words[1]}"
    if name not in tree:
        return f"no command {name}"
    if (why := value_problem(name, words[len(name.split()) :])) != "":
        return why
    options = generated.option_names(tree[name])
    given = {word.partition("=")[0].rstrip(",;.") for word in words if re.match(r"--\w", word)}
    given = {part for word in given for part in word.split("|")}
    return "".join(f"no option {each} " for each in sorted(given - options))


def value_problem(name, words):
    """Return what is wrong with the names that a call gives, or ""."""
    first = words[0] if words else ""
    if name == "explain" and first not in PLACEHOLDERS and first and first != "WORD":
        try:
            explanation(first, catalogue())
        except InputError:
            return f"explain knows no {first}"
    if name == "catalogue" and first and first not in {*KINDS, "KIND"} and first[0] != "-":
        return f"no kind {first}"
    if name == "studies run" and first not in {*studies(), "all", "NAME", "gN"}:
        return f"no study {first}"
    for option, known in (("--protocol", protocols), ("--method", methods)):
        if option in words[:-1] and name.split()[0] in ("trials", "test"):
            value = words[words.index(option) + 1]
            if not (value.isupper() or value.endswith(".toml") or known(value)):
                return f"no {option} {value}"
    return ""


def protocols(name):
    return name in protocol_names()


def methods(name):
    plain = name.replace("-", "_")
    return ("setup", NICKNAMES.get(plain, plain)) in catalogue().entries


def test_every_command_that_a_page_shows_is_one_with_its_options():
    found = [(page, call) for page in PAGES for call in calls(page)]
    wrong = [f"{page.name}: {call}: {why}" for page, call in found if (why := problem_of(call))]
    assert not wrong, "\n".join(wrong)
    assert len(found) > 250


def test_a_call_with_a_wrong_option_or_command_is_seen():
    assert problem_of("underfoot risk case.toml --wanted 5") == "no option --wanted "
    assert problem_of("underfoot calibrate pears x") == "no command calibrate pears"
    assert problem_of('underfoot run case.toml --set "a.b=1" --out out/a # a note') == ""


def old_names():
    from underfoot.cli.groups import RENAMED

    return {name for renamed in RENAMED.values() for name in renamed}


def test_every_option_that_a_page_names_belongs_to_a_command():
    known = set().union(*map(generated.option_names, generated.command_tree().values()))
    known |= {"--version", "--units", *old_names()}
    # of other programs
    elsewhere = {
        "--regen-all",
        "--mend",
        "--count",
        "--with",
        "--array",
        "--wrap",
        "--sizes",
        "--peers",
    }
    count = 0
    for page in PAGES:
        for span in spans(page):
            for option in re.findall(r"(?<![\w-])--[a-z][\w-]*", span):
                assert option in known | elsewhere, f"{page.name}: {option} in `{span}`"
                count += 1
    assert count > 150


KEY = re.compile(r"\b[a-z_]+(?:\.[a-z_]+)+\b")


def keys_named(page):
    """Return every dotted key of case files in code type, and the value given to it."""
    for span in spans(page):
        found = re.fullmatch(r'([a-z_]+(?:\.[a-z_]+)+)(?: ?= ?"?([^"]+)"?)?', span)
        if found and found.group(1).split(".")[0] in {p.split(".")[0] for p in paths()}:
            yield found.group(1), found.group(2)


def test_every_key_of_case_files_that_a_page_names_is_one_and_takes_the_value():
    known, slots, count = set(paths()), keys(), 0
    for page in PAGES:
        for key, value in keys_named(page):
            if importable(f"underfoot.{key}") or key.endswith(
                (".toml", ".csv", ".py", ".html", ".md")
            ):
                continue
            assert key in known or field_at(key) is not None, f"{page.name}: {key}"
            if value and key in slots:
                options = slots[key].options()
                assert value in options or ":" in value, f"{page.name}: {key} = {value}"
            count += 1
    assert count > 60


@cache
def importable(name):
    room, _, member = name.rpartition(".")
    try:
        module = importlib.import_module(room)
    except ImportError:
        return False
    return hasattr(module, member)


@cache
def files_of_the_repository():
    return subprocess.run(
        ["git", "ls-files", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    ).stdout.split("\n")


@cache
def words_of_the_program():
    """Return every identifier and file name of sources, data, examples and build files."""
    words = set()
    for name in files_of_the_repository():
        path = ROOT / name
        words |= set(re.findall(r"\w+", name))
        if name.startswith(("docs/", "CHANGELOG", "tests/data")) and path.suffix != ".py":
            continue
        if (
            path.suffix in (".py", ".toml", ".js", ".html", ".json", ".lock", ".css", ".yml")
            or name == "Makefile"
        ):
            words |= set(re.findall(r"\w+", path.read_text("utf-8", errors="ignore")))
    return words


ELSEWHERE = set(
    "array_peak_row_N design_N sbatch SLURMCluster my_package NAME_history hrad walks_done "
    "study_done".split()
)
"""Words of other programs, and names that an example on the page makes up."""


def test_every_word_in_code_type_is_a_word_of_the_program():
    known, missing, count = words_of_the_program(), [], 0
    for page in PAGES:
        if page.name in WRITTEN:
            continue
        for span in spans(page):
            for word in re.findall(r"[A-Za-z_][A-Za-z_0-9]{3,}", span):
                count += 1
                if word not in known | ELSEWHERE and word.upper() != word:
                    missing.append(f"{page.relative_to(ROOT)}: {word} in `{span}`")
    assert not missing, "\n".join(missing)
    assert count > 2500


def test_every_file_that_a_page_names_is_in_the_repository():
    listed = files_of_the_repository()
    inside = {*listed, *(str(parent) for name in listed for parent in Path(name).parents)}
    count = 0
    for page in PAGES:
        for span in spans(page):
            if re.fullmatch(
                r"(?:src|tests|docs|examples|benchmarks|packaging|schema)/[\w./-]+", span
            ):
                assert span.rstrip("/") in inside, f"{page.name}: {span}"
                count += 1
    assert count > 80


def anchor(heading):
    text = re.sub(r"[`*]|\{[^}]*\}", "", heading).strip().casefold()
    return re.sub(r"[^\w\- ]", "", text).replace(" ", "-")


def test_every_link_to_a_place_of_a_page_leads_there():
    count = 0
    for page in PAGES:
        for target, place in re.findall(r"\]\(([^)#\s]*)#([\w-]+)\)", page.read_text()):
            if "://" in target:
                continue
            path = (page.parent / target).resolve() if target else page
            headings = re.findall(r"^#+ (.*)$", path.read_text(), re.MULTILINE)
            assert place in {anchor(each) for each in headings}, f"{page.name}: {target}#{place}"
            count += 1
    assert count > 40


def test_every_target_of_make_that_a_page_names_exists():
    targets = set(re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(), re.MULTILINE))
    count = 0
    for page in PAGES:
        for name in re.findall(r"(?:`|^)make ([a-z-]+)", page.read_text(), re.MULTILINE):
            assert name in targets, f"{page.name}: make {name}"
            count += 1
    assert count > 20


def test_every_case_in_a_page_is_of_the_present_version_and_its_keys_are_known():
    count = 0
    known = {*paths(), "file_version"}
    for page in PAGES:
        for language, body in re.findall(
            r"^```(\w+)\n(.*?)^```", page.read_text(), re.DOTALL | re.MULTILINE
        ):
            if language != "toml":
                continue
            table = tomllib.loads(re.sub(r"^\.\.\.$", "", body, flags=re.MULTILINE))
            if "file_version" in table:
                present = STUDY_VERSION if "vary" in table else FILE_VERSION
                assert table["file_version"] == present, page.name
                count += 1
            for name in set(table) & {"friction", "motion", "numerics", "interface"}:
                if isinstance(table[name], dict):
                    for key in set(table[name]) - {"from"}:
                        assert f"{name}.{key}" in known or field_at(f"{name}.{key}"), (
                            f"{page.name}: {name}.{key}"
                        )
                        count += 1
    assert count > 10


# --- defaults ---------------------------------------------------------------------------------


def default(path):
    return generated.default_text(path)


def coarse(command):
    quick = next(p for p in generated.command_tree()[command].params if "--quick" in p.opts)
    return quick.default


def test_every_default_that_a_page_takes_from_the_code_is_there():
    found = [key for page in PAGES for key in re.findall(r"\{default\}`([^`]+)`", page.read_text())]
    assert all(default(key) for key in found)
    assert len(found) >= 25


@pytest.mark.parametrize(
    ("slot", "option", "page"),
    [
        ("hardness", "gent", "rubber"),
        ("friction", "pair", "friction_law"),
        ("compliance", "layered", "sole_compliance"),
        ("risk", "report_g6", "slip_probability"),
        ("rough_contact", "exponential", "contact_table"),
    ],
)
def test_an_option_that_a_page_calls_usual_is_so(slot, option, page):
    assert (DOCS / "physics" / f"{page}.md").is_file()
    assert slot_table()[slot].usual == option


@pytest.mark.parametrize(
    ("function", "argument", "value"),
    [
        ("underfoot.surface.profile_roughness", "standard", "ISO 21920-2:2021"),
        ("underfoot.surface.profile_roughness", "ends", "drop"),
        ("underfoot.trials.statistics.t_test", "kind", "welch"),
        ("underfoot.material.dynamic_master_curve", "shift_by", "storage"),
    ],
)
def test_an_argument_that_a_page_names_has_this_default(function, argument, value):
    module, _, name = function.rpartition(".")
    item = getattr(importlib.import_module(module), name)
    assert inspect.signature(item).parameters[argument].default == value


def test_rcof_is_defined_as_its_page_says():
    one = RcofDefinition()
    assert (one.gate, one.shear, one.peak, one.braking, one.part) == (
        100.0, "resultant", "largest-local-maximum", True, 0.5
    )  # fmt: skip
    assert (one.filter.kind, one.filter.cutoff) == ("butterworth-4-zero-phase", 36.0)


def test_other_defaults_that_pages_explain():
    from underfoot.case import compose
    from underfoot.compute.sole import RESOLVED
    from underfoot.trials import PlateAccuracy

    assert (default("numerics.cells_along"), RESOLVED) == ("auto", 8)  # coupled_contact
    assert compose.MEASURED_CONTACT == "contact_table"
    assert MODES[0] == "walk"  # wear
    rate = float(default("shoe.wear.wear_rate").split()[0])  # mm3/(N m)
    assert rate == pytest.approx(150 / (10 * 40))  # the abrasive sheet of ISO 4649
    assert default("slip.heel_brake") == "recorded"
    assert default("film.lug_edges") in ("True", "yes")
    assert default("motion.duration") == "None"  # steady sliding
    assert (PlateAccuracy().gain, PlateAccuracy().crosstalk) == (0.01, 0.01)
    assert all(map(coarse, ("risk", "sensitivity", "wear", "slip")))
    assert not coarse("run")
