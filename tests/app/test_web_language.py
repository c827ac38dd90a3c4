"""The app in German and in inches and pounds: no English word, no metric unit on its pages.

Sources and names of files stand as they are written; statistics of trials beyond those of the
example may be in English.
"""

import ast
import re
import tomllib
from pathlib import Path

import pytest
from package_messages import filled
from web_app import coarsened, drawn, page_of, served, settled

from outsole_bodies import grooved, heel_body, triangles, write_stl
from source_trees import nodes
from underfoot.core.errors import InputError, unknown_name
from underfoot.core.remark import Message, Remark, join_lines

pytest.importorskip("nicegui")
pytest.importorskip("playwright.sync_api")
text = pytest.importorskip("underfoot.app.text")
pytestmark = [pytest.mark.browser, pytest.mark.slow]
GUIDE = Path(__file__).resolve().parents[2] / "docs" / "guide"
WORD = re.compile(r"(?<![\w./])[^\W\d_]{2,}(?![\w/]|\.\w)")
BRACES = re.compile(
    r"\{\w*(?::[^}|]*)?\}|\(\?P<\w+>|(?:/[\w .-]+){3,}"
)  # placeholders, paths of files
CODE = re.compile(r'„[^“]*“|"[^"]*"|\[+[\w.{}]+\]+|[\w.]+(?= = )')
"""What is never translated: in quotes, tables and keys of a file."""
UNITS = {"deg", "cp", "pa", "mpa", "kpa", "um", "µm", "hz", "kg", "mm²", "cm²"}
FORMATS = {"iges", "brep", "off", "gltf"}
PLACE = """\
name = "Küche"
[fluids]
dry = 0.9
glycerol_90pct = 0.1
[[floor]]
name = "Lager"
[[shoe]]
name = "glatt"
from = "work_shoe_untreaded"
[[shoe]]
name = "profiliert"
from = "work_shoe_full_tread"
"""
TEXTS = """() => {
  const texts = new Set(), skipped = "script, style, pre, code, textarea, .q-icon, [translate=no]";
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walker.nextNode()) {
    const node = walker.currentNode;
    if (!node.parentElement.closest(skipped)) texts.add(node.data.trim());
  }
  for (const each of document.querySelectorAll("[aria-label], [title], [alt]")) {
    if (each.closest(skipped)) continue;
    for (const label of ["aria-label", "title", "alt"]) texts.add(each.getAttribute(label) || "");
  }
  return [...texts];
}"""


def words(text):
    return {word.lower() for word in WORD.findall(BRACES.sub(" ", CODE.sub(" ", text)))}


@pytest.fixture(scope="module")
def english():
    """Return words of the guide, the app and the package that are no German words too."""
    package = {
        english: german
        for name in ("package", "messages")
        for english, german in tomllib.loads(
            (text.FOLDER / f"de.{name}.toml").read_text("utf-8")
        ).items()
    }
    sources = [path.read_text("utf-8") for path in GUIDE.glob("*.md")]
    sources += [*text.catalogue("en").values(), *package]
    german = set().union(*map(words, (*text.catalogue("de").values(), *package.values())))
    known = set().union(*map(words, sources)) - german - UNITS - FORMATS
    assert {"friction", "load", "width", "shoe", "the"} <= known
    return known


@pytest.fixture
def app(tmp_path):
    with served(tmp_path / "project", tmp_path / "home") as running:
        yield running


def seen(page, *, fold=True):
    """Return every text on the page, what is folded away too."""
    settled(page)
    for each in page.query_selector_all(".q-expansion-item .q-item") if fold else ():
        each.click()
    if fold:
        page.evaluate("document.querySelectorAll('details').forEach((one) => { one.open = true })")
    settled(page)
    return page.evaluate(TEXTS)


def german(page, app):
    page.context.add_cookies([{"name": "language", "value": "de", "url": app.base}])
    page.goto(app.base)


def assert_german(texts, english):
    """Assert that no line of a page has an English word."""
    foreign = {
        f"{name}: {line}: {sorted(words(line) & english)}"
        for name, lines in texts.items()
        for line in lines
        if words(line) & english
    }
    assert not foreign, "\n".join(sorted(foreign))


def test_sentences_are_put_in_whole_and_numbers_have_their_signs(tmp_path):
    package = tomllib.loads((text.FOLDER / "de.package.toml").read_text("utf-8"))
    page_file = tmp_path / "page.html"
    page_file.write_text('<p aria-label="1.234 mm">0.138</p>')
    said = {
        "0.138": "0,138", "99,000": "99.000", "1,200.5 N": "1.200,5 N", "version 3.11.2":
        "version 3.11.2", "2 to 5 mm": "2 bis 5 mm", "a lamp goes to the moon":
        "a lamp goes to the moon", "front and rear": "vorn und hinten",
        "ours and theirs": "ours and theirs",
    }  # fmt: skip
    with page_of(page_file.as_uri()) as page:
        page.evaluate("w => { window.spoken = { words: w, decimal: ',' }; }", package)
        page.add_script_tag(path=text.FOLDER.parent / "static" / "language.js")
        for english, german in said.items():
            assert page.evaluate("t => inLanguage(t)", english) == german
        said = page.evaluate("t => inLanguage(t)", "below 93\u00a0%")
        assert said == "unter 93\u00a0%"
        # what is written is not read as English again: 1,234 would be a thousand
        page.evaluate("speakAll(document.body)")
        for _ in range(3):
            page.wait_for_timeout(50)
            label = page.evaluate("document.querySelector('p').ariaLabel")
            assert (label, page.inner_text("p")) == ("1,234 mm", "0,138")


def spoken(german, value):
    """Return a sentence of the catalogue with a value for each part, as ``filled`` gives them."""
    return re.sub(r"\{(\d+)\}", lambda part: value.format(part[1]), german)


def test_no_sentence_is_taken_for_another(tmp_path):
    """A short form, "{} with {}", took parts of sentences that have a translation of their own."""
    package = text.Text("de").of_package()
    page_file = tmp_path / "page.html"
    page_file.write_text("<p></p>")
    with page_of(page_file.as_uri()) as page:
        page.evaluate("w => { window.spoken = { words: w, decimal: ',' }; }", package)
        page.add_script_tag(path=text.FOLDER.parent / "static" / "language.js")
        for value in ("{}", "QX{}"):  # numbers, names
            given = [filled(each, value) for each in package]
            wanted = [spoken(each, value) for each in package.values()]
            told = page.evaluate("all => all.map((each) => inLanguage(each))", given)
            assert len(told) > 2500
            assert not [
                each for each in zip(given, wanted, told, strict=True) if each[1] != each[2]
            ]


def test_names_of_the_user_stay_as_they_are(tmp_path):
    """A shoe called "sample" was a "Probe" in a German sentence, a quoted word was German."""
    page_file = tmp_path / "page.html"
    page_file.write_text("<p></p>")
    said = {
        "sample has the highest COF, 0.02 above hard (probability 0.9).":
        "sample hat den höchsten Reibwert, 0,02 über hart (Wahrscheinlichkeit 0,9).",
        'there is no variant "hard"': 'die Variante "hard" gibt es nicht',
        "slip.csv: the file is empty": "slip.csv: die Datei ist leer",
        "no force plate can be used: slip.csv": "keine Kraftmessplatte ist brauchbar: slip.csv",
        "sample and hard": "sample und hart",
    }  # fmt: skip
    with page_of(page_file.as_uri()) as page:
        page.evaluate(
            "w => { window.spoken = { words: w, decimal: ',' }; window.namesOfUser = ['sample']; }",
            text.Text("de").sentences(),
        )
        page.add_script_tag(path=text.FOLDER.parent / "static" / "language.js")
        assert {each: page.evaluate("t => inLanguage(t)", each) for each in said} == said


APART = (
    "app", "block", "calibrate", "cli", "explore/engines", "material", "places/calibration",
    "questions/contact", "questions/method", "rough_contact", "shoe/parametric", "studies",
    "trials/pages", "trials/recording/protocols", "trials/study/run_sheet",
    "trials/walking/describe",
    "case/explanation", "case/numerics", "case/shoe",
)  # fmt: skip
"""What the app does not call, or calls in no way that an option could mend."""
MARKER = "made by underfoot"
OPTION = re.compile(r"(?<![\w-])--[a-z]{2,}")


def sentences_with_options():
    """Return the sentences of the package that name an option of a command, "x" for their parts."""
    package = text.FOLDER.parent.parent
    told = set()
    for path in package.rglob("*.py"):
        if path.relative_to(package).as_posix().startswith(APART):
            continue
        explained = {id(each.value) for each in nodes(path) if isinstance(each, ast.Expr)}
        for each in nodes(path):
            if isinstance(each, ast.JoinedStr):
                parts = [p.value if isinstance(p, ast.Constant) else "x" for p in each.values]
                explained |= set(map(id, each.values))
                told.add("".join(map(str, parts)))
            elif isinstance(each, ast.Constant) and id(each) not in explained:
                told.add(str(each.value))
    return {each for each in told if OPTION.search(each) and not each.startswith(MARKER)}


@pytest.mark.parametrize("language", ["en", "de"])
def test_the_app_names_its_fields_in_place_of_options(tmp_path, language):
    """An error of a job said "--out: ...", which no page has."""
    told = sentences_with_options()
    assert len(told) > 20
    page_file = tmp_path / "page.html"
    page_file.write_text("<p></p>")
    words = text.Text(language)
    with page_of(page_file.as_uri()) as page:
        page.add_script_tag(content=words.script().replace("const spoken", "window.spoken"))
        page.add_script_tag(path=text.FOLDER.parent / "static" / "language.js")
        for each in sorted(told):
            whole = f"a sole{each}" if each.startswith(";") else f"--out: {each}"
            said = page.evaluate("t => inLanguage(t)", whole)
            assert not OPTION.search(said), (each, said)
        # what is no sentence of the package stays as it is, with the blanks that hold it together
        assert page.evaluate("t => inLanguage(t)", "no\u00a0moon: so far") == "no\u00a0moon: so far"


def test_five_pages_and_the_report_have_no_english_word_in_german(app, english):
    with page_of(app.link) as page:
        german(page, app)
        texts = {"start": seen(page)}
        page.goto(app.base + "design")
        page.get_by_role("button", name="Mit einem Arbeitsschuh beginnen").click()
        page.wait_for_url("**/design?variant=*")
        drawn(page)
        assert page.evaluate("document.documentElement.lang") == "de"
        for tab in page.query_selector_all(".q-tab"):
            tab.click()
            settled(page)
            for choice in page.query_selector_all(".q-tab-panel .q-select"):
                choice.click()
                texts.setdefault("design", []).extend(seen(page, fold=False))
                page.keyboard.press("Escape")
            texts["design"].extend(seen(page))
        page.get_by_role("button", name="Reibung rechnen").click()
        page.wait_for_selector(".big")
        drawn(page)
        page.get_by_role("button", name="Diese Variante anlegen").first.wait_for(timeout=480_000)
        texts["answer"] = seen(page)
        page.get_by_role("button", name="Diese Variante anlegen").first.click()
        page.wait_for_url("**/answer?**beside**")
        page.wait_for_selector(".big", timeout=240_000)
        page.goto(app.base + "compare")
        drawn(page)
        texts["compare"] = seen(page)
        page.goto(app.base + "studies")
        texts["studies"] = seen(page)
        page.goto(next((app.folder / "results").glob("*/report.html")).as_uri())
        assert page.evaluate("document.documentElement.lang") == "de"
        texts["report"] = seen(page, fold=False)
        assert_german(texts, english)
        shown = " ".join(texts["answer"])
        assert re.search(r"\b0,\d\d\d\b", shown)
        assert not re.search(r"\b0\.\d\d\d\b", shown)
        assert page.complaints == []


def test_places_trials_and_errors_have_no_english_word_in_german(app, english, tmp_path):
    good, bad, sole = tmp_path / "kueche.toml", tmp_path / "falsch.toml", tmp_path / "sohle.stl"
    good.write_text(PLACE)
    bad.write_text(PLACE.replace("dry = 0.9", "dry = 0.5"))
    write_stl(sole, triangles(heel_body(grooved(pitch=10e-3))))
    (tmp_path / "text.stl").write_text("hallo\n" * 40)
    with page_of(app.link) as page:
        german(page, app)
        page.goto(app.base + "place")
        texts = {"place": seen(page)}
        page.locator("input[type=file][accept='.toml']").set_input_files(good)
        page.get_by_role("table").first.wait_for()
        texts["place computed"] = seen(page)
        page.locator("input[type=file][accept='.toml']").set_input_files(bad)
        page.locator(".caution", has_text="ergeben").wait_for()
        texts["place refused"] = seen(page)
        page.goto(app.base + "trials?example=slips")
        page.locator(".trial-card").first.wait_for()
        texts["trials"] = seen(page)
        page.locator(".trial-card").first.click()
        page.locator(".trial-summary").wait_for()
        texts["trial"] = seen(page)
        page.goto(app.base + "design")
        page.get_by_role("button", name="Mit einem Arbeitsschuh beginnen").click()
        page.wait_for_url("**/design?variant=*")
        drawn(page)
        page.locator("input[type=file][accept*=stl]").set_input_files(sole)
        page.get_by_role("button", name="Diese Sohle nehmen", exact=True).wait_for()
        texts["sole"] = seen(page, fold=False)
        page.locator("input[type=file][accept*=stl]").set_input_files(tmp_path / "text.stl")
        page.locator(".problem").wait_for()
        texts["sole refused"] = seen(page, fold=False)
        assert_german(texts, english)


def test_inches_and_pounds_on_every_page(app):
    with page_of(app.link) as page:
        page.get_by_role("button", name="Skip").first.click()
        page.get_by_role("button", name="Units: SI").click()
        page.get_by_text("US", exact=True).click()
        page.get_by_role("button", name="Units: US").wait_for()
        page.goto(app.base + "design")
        page.get_by_role("button", name="Begin with a work shoe").click()
        page.wait_for_url("**/design?variant=*")
        drawn(page)
        coarsened(page, app)
        assert page.locator("output[for^=slider]").first.inner_text() == "0.197 in"
        slider = page.locator("input[name='shoe.tread.lug_width']")
        slider.focus()
        for _ in range(10):
            page.keyboard.press("ArrowRight")
        page.wait_for_function("document.querySelector('output').textContent === '0.236 in'")
        page.get_by_role("button", name="Compute friction").click()
        page.wait_for_selector(".big")
        drawn(page)
        file = next((app.folder / "variants").glob("*.toml")).read_text()
        assert 'lug_width = "6 mm"' in file
        every = " ".join(seen(page, fold=False))
        for unit in (" lbf", " psi", " in²", " mil", " ft/s"):
            assert unit in every
        shown = page.locator(".side, .wide table").all_inner_texts()
        assert not re.search(r"\d (mm|µm|N|kPa|MPa|m/s|cm²)\b", " ".join(shown))
        report = next((app.folder / "results").glob("*/report.html")).read_text()
        assert "lbf" in report
        assert page.complaints == []


def test_messages_are_put_in_by_their_template_and_values(tmp_path, monkeypatch):
    """A comma that changed in a sentence left it English in the middle of a German page."""
    hole = Message(
        "{count} hole{count:|s} of {area:.3g} mm² in all filled from the surface around.",
        count=1, area=3.25,
    )  # fmt: skip
    said = {
        hole: "1 Loch von zusammen 3,25 mm² aus der Fläche ringsum gefüllt.",
        Remark("by hand", "the step is on {plate} ({why})", plate="B <1>", why="no plate A"):
        "von Hand: der Schritt ist auf B <1> (no plate A)",
        join_lines([Message("body weight"), "3.5 N"]): "des Körpergewichts; 3,5 N",
    }  # fmt: skip
    page_file = tmp_path / "page.html"
    lines = "".join(f"<p>{line.__html__()}</p>" for line in said)
    page_file.write_text(f"<html><head></head><body>{lines}</body></html>", encoding="utf-8")
    monkeypatch.setenv(text.LANGUAGE_VARIABLE, "de")
    text.put_language(page_file)
    with page_of(page_file.as_uri()) as page:
        page.wait_for_timeout(300)
        assert page.locator("p").all_inner_texts() == list(said.values())


def test_a_message_is_put_in_whole_and_what_is_quoted_stays(tmp_path):
    """In the page: a name that is a word too, a text without a template, a part of another."""
    walker = Message(
        "The walker {verdict}: peak heel speed {speed:.2f} m/s (slip above 0.2 m/s), distance "
        "{distance:.0f} mm ({outcome}).",
        verdict=Message("slips"), speed=0.5, distance=40.0, outcome="recovered",
    )  # fmt: skip
    unknown = Message("{x} of a thing without words", x=Message("{given} is no count", given="3"))
    error = InputError(Message("{given} is no count", given="1.5"), where="a.b", allowed="1 to 4")
    said = [walker, unknown, error.message, unknown_name("shoe", "load", ["new"]).message]
    speaker = (Path(text.__file__).parents[1] / "static" / "language.js").read_text("utf-8")
    file = tmp_path / "page.html"
    scripts = f"<script>{text.Text('de').script()}</script><script>{speaker}</script>"
    file.write_text(f"<meta charset=utf-8>{scripts}", encoding="utf-8")
    with page_of(file.as_uri()) as shown:
        spoken = [
            shown.evaluate("message => messageInLanguage(message)", each.page_data())
            for each in said
        ]
    assert spoken[0].startswith("Die Person rutscht: höchste Fersengeschwindigkeit 0,50 m/s")
    assert spoken[1:] == [
        "3 is no count of a thing without words",
        "a.b: 1,5 ist keine Anzahl. Erlaubt: 1 bis 4.",
        "unbekannt: shoe „load“. Erlaubt: new.",
    ]
