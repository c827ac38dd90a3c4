"""Access: axe on every page, light and dark; names and labels of others stay text."""

import pytest
from web_app import begin, drawn, page_of, served

pytest.importorskip("nicegui")
pytest.importorskip("playwright.sync_api")
Axe = pytest.importorskip("axe_playwright_python.sync_playwright").Axe
pytestmark = [pytest.mark.browser, pytest.mark.slow]

GRAVE = ("moderate", "serious", "critical")
STRANGE = "<img src=x onerror=document.body.dataset.hit=1>"


@pytest.fixture
def app(tmp_path):
    with served(tmp_path / "project", tmp_path / "home") as running:
        yield running


def faults(page, name):
    """Return what axe says against the page, but for what is minor."""
    page.wait_for_timeout(1500)
    rules = Axe().run(page).response["violations"]
    return [
        f"{name}: {rule['id']} ({rule['impact']}): {rule['nodes'][0]['html'][:120]}"
        for rule in rules
        if rule["impact"] in GRAVE
    ]


@pytest.mark.parametrize("dark", [False, True])
def test_axe_has_nothing_against_any_page(app, dark):
    with page_of(app.link, dark=dark) as page:
        found = faults(page, "tour")
        page.get_by_role("button", name="Skip").first.click()
        found += faults(page, "start")
        begin(page, app.base)
        for tab in page.get_by_role("tab").all():
            tab.click()
            found += faults(page, f"design, {tab.inner_text()}")
        page.get_by_role("button", name="Compute friction").click()
        page.get_by_role("button", name="Make this variant").first.click(timeout=480_000)
        page.wait_for_url("**/answer?**beside**")
        page.wait_for_selector(".big", timeout=240_000)
        drawn(page)
        found += faults(page, "answer")
        page.goto(app.base + "compare")
        drawn(page)
        found += faults(page, "compare")
        page.goto(app.base + "studies")
        found += faults(page, "studies")
        page.get_by_role("button", name="New study of the variant changed last").click()
        page.wait_for_url("**/studies?study=*")
        found += faults(page, "study")
        page.goto(app.base + "trials")
        page.get_by_role("button", name="Try it with made-up slips").click()
        page.wait_for_url("**/trials?folder=*")
        page.locator("a[href*='trial=']").first.wait_for()
        found += faults(page, "trials")
        page.locator("a[href*='trial=']").first.click()
        page.get_by_role("button", name="Next trial").wait_for()
        found += faults(page, "trial")
        page.goto(next((app.folder / "results").glob("*/report.html")).as_uri())
        drawn(page)
        found += faults(page, "report")
        assert not found
