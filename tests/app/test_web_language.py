"""The app in German and in inches and pounds: no English word, no metric unit on its pages."""

import re
import tomllib
from pathlib import Path

import pytest
from web_app import drawn, page_of, served

pytest.importorskip("nicegui")
pytest.importorskip("playwright.sync_api")
text = pytest.importorskip("underfoot_app.text")
pytestmark = [pytest.mark.browser, pytest.mark.slow]
GUIDE = Path(__file__).resolve().parents[2] / "docs" / "guide"
WORD = re.compile(r"(?<![\w./])[^\W\d_]{2,}(?![\w/]|\.\w)")
BRACES = re.compile(r"\{\w*\}|\(\?P<\w+>")
UNITS = {"deg", "cp", "pa", "mpa", "kpa", "um", "µm"}
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
    return {word.lower() for word in WORD.findall(BRACES.sub(" ", text))}


@pytest.fixture(scope="module")
def english():
    """Return words of the guide, the app and the package that are no German words too."""
    package = tomllib.loads((text.FOLDER / "de.package.toml").read_text("utf-8"))
    sources = [path.read_text("utf-8") for path in GUIDE.glob("*.md")]
    sources += [*text.catalogue("en").values(), *package]
    german = set().union(*map(words, (*text.catalogue("de").values(), *package.values())))
    known = set().union(*map(words, sources)) - german - UNITS
    assert {"friction", "load", "width", "shoe", "the"} <= known
    return known


@pytest.fixture
def app(tmp_path):
    with served(tmp_path / "project", tmp_path / "home") as running:
        yield running


def seen(page, *, fold=True):
    """Return every text on the page, what is folded away too."""
    page.wait_for_timeout(1500)
    for each in page.query_selector_all(".q-expansion-item .q-item") if fold else ():
        each.click()
    page.wait_for_timeout(500)
    return page.evaluate(TEXTS)


def test_five_pages_have_no_english_word_in_german(app, english):
    with page_of(app.link) as page:
        page.context.add_cookies([{"name": "language", "value": "de", "url": app.base}])
        page.goto(app.base)
        texts = {"start": seen(page)}
        page.goto(app.base + "design")
        page.get_by_role("button", name="Mit einem Arbeitsschuh beginnen").click()
        page.wait_for_url("**/design?variant=*")
        drawn(page)
        assert page.evaluate("document.documentElement.lang") == "de"
        for tab in page.query_selector_all(".q-tab"):
            tab.click()
            page.wait_for_timeout(600)
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
        foreign = {
            f"{name}: {line}: {sorted(words(line) & english)}"
            for name, lines in texts.items()
            for line in lines
            if words(line) & english
        }
        assert not foreign
        shown = " ".join(texts["answer"])
        assert re.search(r"\b0,\d\d\d\b", shown)
        assert not re.search(r"\b0\.\d\d\d\b", shown)
        assert page.complaints == []


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
