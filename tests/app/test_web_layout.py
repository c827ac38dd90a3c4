"""What is seen of every page and report: nothing cut, nothing on top of another, no empty box."""

import os
import re
from pathlib import Path

import pytest
from test_web_studies import STUDY
from web_app import page_of, project_of, served, settled

from outsole_bodies import grooved, heel_body, triangles, write_stl

pytest.importorskip("nicegui")
pytest.importorskip("playwright.sync_api")
pytestmark = [pytest.mark.browser, pytest.mark.slow]
WIDTHS = (390, 820, 1366, 3840)
FAULTS = Path(__file__).with_name("layout_faults.js").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    """Return a project with two results and a study; beside it reports of wear and of a file."""
    from underfoot.app import work, work_studies
    from underfoot.core import silent
    from underfoot.questions.wear import wear_series
    from underfoot.report import write_report
    from underfoot.report.outsole import inspect_outsole
    from underfoot.shoe.files import FileSettings

    folder = tmp_path_factory.mktemp("layout")
    made = project_of(folder / "project", "Heel", "Heel with wide channels")
    made.change("Heel with wide channels", {"shoe.tread.channel_width": "4 mm"})
    for name in made.variants():
        path, result = str(made.path(name)), str(made.result_folder(name))
        work.computed(path, result, progress=silent)
    work.advised(str(made.path("Heel")), str(made.result_folder("Heel")), progress=silent)
    study = made.folder / "studies" / "Speeds.toml"
    study.write_text(STUDY)
    work_studies.computed(str(study), str(study.with_suffix("")), progress=silent)
    write_report(wear_series(made.case("Heel"), mode="plane", steps=2, band=False), folder / "wear")
    sole = write_stl(made.folder / "soles" / "sole.stl", triangles(heel_body(grooved(pitch=10e-3))))
    write_report(inspect_outsole(sole, FileSettings()), folder / "file")
    return made


def faults(page, name):
    """Return what is cut, covered or empty on a page at every width."""
    found = []
    for width in WIDTHS:
        page.set_viewport_size({"width": width, "height": max(768, width // 2)})
        settled(page)
        found += [f"{name}, {width} px: {each}" for each in page.evaluate(FAULTS)]
    return found


PAGES = ("", "design?variant=Heel", "answer?variant=Heel", "compare", "place", "project",
         "studies", "studies?study=Speeds", "trials?example=slips")  # fmt: skip


def pages(app, project):
    """Yield the address of every page and report by its name."""
    for route in PAGES:
        yield route or "start", app.base + route
    reports = [
        *project.folder.glob("results/*/report.html"),
        *project.folder.glob("studies/*/*.html"),
    ]
    reports += project.folder.parent.glob("*/report.html")
    for path in reports:
        yield str(path.relative_to(project.folder.parent)), path.as_uri()


@pytest.mark.parametrize("language", ["en", "de"])
def test_nothing_is_cut_covered_or_empty(project, tmp_path, language):
    found = []
    with served(project.folder, tmp_path / "home") as app, page_of(app.link) as page:
        page.context.add_cookies([{"name": "language", "value": language, "url": app.base}])
        page.reload()
        settled(page)
        found += faults(page, "tour")
        for name, address in pages(app, project):
            page.set_viewport_size({"width": 1366, "height": 768})
            page.goto(address)
            settled(page)
            for tab in page.query_selector_all(".q-tab") or [None]:
                page.set_viewport_size({"width": 1366, "height": 768})
                if tab:
                    tab.click()
                    settled(page)
                label = tab.inner_text() if tab else ""
                found += faults(page, f"{name} {label}".strip())
                if folder := os.environ.get("UNDERFOOT_PICTURES"):
                    page.set_viewport_size({"width": 390, "height": 844})
                    file = re.sub(r"\W+", "_", f"{language} {name} {label}")
                    page.screenshot(path=f"{folder}/{file}_390.png")
                    page.set_viewport_size({"width": 1366, "height": 768})
                    page.screenshot(path=f"{folder}/{file}_1366.png")
    print("\n".join(found))
    assert not found


LONG = "Work shoe, half of the tread worn off, channels of 4 mm"


def test_a_ranking_and_a_progress_line_fit_a_telephone(tmp_path):
    """A long name leaves the numbers beside it in view; words of what is computed are whole."""
    made = project_of(tmp_path / "project", LONG, f"{LONG}, 2")
    with (
        served(made.folder, tmp_path / "home") as app,
        page_of(app.link, width=390, height=844) as page,
    ):
        page.goto(app.base + "project")
        page.get_by_role("button", name="Compute all that is missing (2)").click()
        page.get_by_text("0 of 2 computed").wait_for()
        first = ".result-table tbody tr:first-child"
        shown = [f"{first} .named", f"{first} td:nth-child(2)", ".task > :first-child"]
        shown += [".task .q-linear-progress", ".task button"]
        # at one instant: the table is drawn anew with each answer
        boxes = """(shown) => { const all = shown.map((each) => document.querySelector(each));
            return all.every(Boolean) && all.map((each) => each.getBoundingClientRect()); }"""
        name, row, words, bar, stop = page.wait_for_function(boxes, arg=shown).json_value()
        assert page.evaluate(FAULTS) == []
        page.get_by_role("button", name="Stop all").click()
    assert name["width"] < 390 / 2
    assert row["x"] + row["width"] < 390
    assert words["width"] > 0.8 * 390
    assert words["y"] + words["height"] <= bar["y"]
    assert bar["width"] > 390 / 2
    assert stop["x"] + stop["width"] <= 390


@pytest.mark.parametrize("language", ["en", "de"])
def test_name_and_settings_share_a_row_of_a_telephone(tmp_path, language):
    made = project_of(tmp_path / "project", "Heel")
    rows = """[...document.querySelectorAll('.app-bar button, .app-bar nav')].map((e) => {
    const box = e.getBoundingClientRect(); return [box.top, box.bottom, e.tagName]; })"""
    with (
        served(made.folder, tmp_path / "home") as app,
        page_of(app.link, width=390, height=844) as page,
    ):
        page.context.add_cookies([{"name": "language", "value": language, "url": app.base}])
        page.goto(app.base + "place")
        page.locator(".app-bar .idle").wait_for()
        boxes = page.evaluate(rows)
        (nav,) = (box for box in boxes if box[2] == "NAV")
        buttons = [box for box in boxes if box[2] == "BUTTON"]
        assert len(buttons) >= 3
        assert max(bottom for _, bottom, _ in buttons) <= nav[0] + 1
        assert max(top for top, *_ in buttons) < min(bottom for _, bottom, _ in buttons)
        assert page.locator(".app-bar .idle").get_attribute("aria-label")
