"""The page of a design study in a browser, on made-up numbers of real soles."""

import math
from pathlib import Path

import pytest
from chromium import opened

from underfoot.case import load
from underfoot.explore import Study
from underfoot.explore.proposals import next_batch
from underfoot.explore.record import Ending, Record
from underfoot.explore.store import Store
from underfoot.explore.study_file import read_plan
from underfoot.report.design_study import write_study_report

EXAMPLES = Path(__file__).parents[2] / "examples"
STUDY = """\
name = "Depth and <pattern>"
[vary]
"shoe.tread.depth" = { from = "1 mm", to = "4 mm" }
"shoe.tread.pattern" = ["grid", "hexagons"]
[outputs]
maximise = ["cof"]
minimise = ["rubber_volume"]
[method]
budget = 16
"""


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    folder = tmp_path_factory.mktemp("study")
    base = load(EXAMPLES / "work_shoe_full_tread_glycerol.toml")
    study = Study(read_plan(STUDY, folder, base=base), folder)
    study.store = Store.open_folder(folder)
    study.store.adopt(study.plan)
    jobs = list(next_batch(study.plan, study.result()))
    study.store.add_batch(study.store.jobs(), jobs)
    for job in jobs[:-1]:
        x, y = job.point
        found = {"cof": 0.2 - 0.1 * x**2, "rubber_volume": 1e-4 * (1 + math.sqrt(1 - x) + 0.1 * y)}
        study.store.add_record(Record(job.key, Ending.COMPUTED, numbers=found))
    reason = "the sole is gone & <b>lost</b>"
    study.store.add_record(Record(jobs[-1].key, Ending.INFEASIBLE, reason))
    study.store.close()
    return write_study_report(study, study.result()).page


def test_the_page_stands_alone_and_says_how_good_its_surrogates_are(page):
    text = page.read_text()
    assert "Depth and &lt;pattern&gt;" in text
    assert "15 computed" in text
    assert "1 infeasible" in text
    assert "Q2 0.99" in text or "Q2 1.000" in text
    assert (page.parent / "surrogate.json").stat().st_size > 1000


@pytest.mark.browser
def test_a_click_on_a_point_shows_its_values_and_its_sole(page):
    with opened(page, width=1366, height=768) as session:
        session.value("new Promise((r) => setTimeout(r, 500)).then(() => true)")
        title = "document.querySelector('[data-part=title]').textContent"
        assert session.value("document.querySelectorAll('.study circle').length") == 15
        before = session.value(title)
        session.value(
            "(() => { const dots = [...document.querySelectorAll('.study circle.front')];"
            "dots.at(-1).dispatchEvent(new MouseEvent('click', {bubbles: true})); return true })()"
        )
        ready = "document.querySelector('.study .viewer')?.dataset.ready === 'yes'"
        session.value(
            f"new Promise((r) => {{ const t = setInterval(() => {{ if ({ready}) {{"
            "clearInterval(t); r(true) } }, 50) })"
        )
        assert session.value(title) != before
        assert session.value("document.querySelectorAll('.study .viewer').length") == 1
        values = session.value("document.querySelector('[data-part=values]').textContent")
        assert "grid" in values or "hexagons" in values
        # nothing stands out of the window, nothing is fetched, nothing complained
        assert session.value("document.documentElement.scrollWidth <= innerWidth")
        assert session.complaints == []
        session.value("document.querySelector('.study svg').scrollIntoView()")
        picture, _ = session.picture(".study svg")
        assert picture.std() > 0.01


@pytest.mark.browser
def test_the_page_in_german_has_no_english_sentence(page, monkeypatch):
    text = pytest.importorskip("underfoot.app.text")
    from test_web_language import assert_german, english, seen
    from web_app import page_of

    monkeypatch.setenv(text.LANGUAGE_VARIABLE, "de")
    spoken = page.with_name("german.html")
    spoken.write_bytes(page.read_bytes())
    text.put_language(spoken)
    own = {"Depth and <pattern>", "1 x the sole is gone & <b>lost</b>"}  # what a person named
    with page_of(spoken.as_uri()) as shown:
        lines = set(seen(shown, fold=False)) - own
        assert_german({"study": lines}, english.__wrapped__())
