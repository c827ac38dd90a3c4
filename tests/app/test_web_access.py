"""Access: axe on every page, light and dark; names and labels of others stay text."""

import numpy as np
import pytest
from tests.files.trials_c3d_writing import c3d_bytes
from web_app import begin, drawn, page_of, served, settled

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
    """Return what axe says against the page in both looks, but for what is minor."""
    found = []
    for look in ("light", "dark"):
        page.emulate_media(color_scheme=look)
        dark = str(look == "dark").lower()
        page.wait_for_function(  # a report has no such mark: its style sheet asks the browser
            "document.querySelector('.nicegui-content') === null || "
            f"document.body.classList.contains('body--dark') === {dark}"
        )
        settled(page)
        found += [
            f"{name}, {look}: {rule['id']} ({rule['impact']}): {rule['nodes'][0]['html'][:120]}"
            for rule in Axe().run(page).response["violations"]
            if rule["impact"] in GRAVE
        ]
    return found


def test_axe_has_nothing_against_any_page(app):
    with page_of(app.link) as page:
        found = faults(page, "tour")
        page.get_by_role("button", name="Skip").first.click()
        found += faults(page, "start")
        begin(page, app.base, coarse=app)
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
        page.goto(app.base + "project")
        page.locator("tbody tr").first.wait_for()
        found += faults(page, "project")
        page.goto(app.base + "studies")
        found += faults(page, "studies")
        page.get_by_role("button", name="New study of the variant changed last").click()
        page.wait_for_url("**/studies?study=*")
        found += faults(page, "study")
        page.goto(app.base + "trials")
        page.get_by_role("button", name="Try it with made-up slips").click()
        page.wait_for_url("**/trials?study=*")
        page.locator(".trial-card").first.wait_for()
        found += faults(page, "trials")
        page.locator(".trial-card").first.click()
        page.get_by_role("button", name="Next trial").wait_for()
        found += faults(page, "trial")
        page.goto(next((app.folder / "results").glob("*/report.html")).as_uri())
        drawn(page)
        found += faults(page, "report")
        assert not found


def test_labels_titles_and_catalogue_text_of_others_stay_text(app):
    """C3D labels, the name and text of a study, and a catalogue beside the variants."""
    trials, studies = app.folder / "trials" / "strange", app.folder / "studies"
    trials.mkdir()
    groups = {"POINT": {"LABELS": [STRANGE], "UNITS": [STRANGE]}}
    groups["ANALOG"] = {"LABELS": [STRANGE], "UNITS": ["N"], "RATE": np.array([1000.0])}
    frames = np.ones((100, 1, 3))
    recording = c3d_bytes(frames, np.ones((1000, 1)), groups=groups)
    (trials / "walk.c3d").write_bytes(recording)
    catalogue = app.folder / "variants" / "catalogue"
    catalogue.mkdir()
    (catalogue / "strange.toml").write_text(
        f'[floor.strange]\ntitle = "{STRANGE}"\nsource = "{STRANGE}"\nroughness.rq = "2 um"\n'
    )
    with page_of(app.link) as page:
        begin(page, app.base)
        case = next((app.folder / "variants").glob("*.toml"))
        (studies / "strange.toml").write_text(
            f'file_version = 1\nname = "{STRANGE}"\ndescription = "{STRANGE}"\n'
            f'base = "../variants/{case.name}"\n\n[vary]\n"motion.speed" = ["0.3 m/s", "0.5 m/s"]\n'
        )
        page.get_by_role("tab", name="Floor").click()
        page.locator(".q-tab-panel:visible .q-select").first.click()
        page.get_by_text(STRANGE).first.click()
        settled(page)
        assert STRANGE in page.content().replace("&lt;", "<").replace("&gt;", ">")
        page.get_by_role("tab", name="Assumptions").click()
        settled(page)
        for address in ("studies", "studies?study=strange", "trials", "trials?study=strange"):
            page.goto(app.base + address)
            settled(page)
            assert page.evaluate("document.body.dataset.hit") is None
            assert page.locator("img[src=x]").count() == 0
        page.goto(app.base + "trials?study=strange")
        page.locator(".trial-card").first.click()
        settled(page)
        assert page.evaluate("document.body.dataset.hit") is None
        assert page.locator("img[src=x]").count() == 0
