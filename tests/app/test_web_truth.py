"""What a page shows is of the inputs it stands beside: revisions, previews, two tabs, ways out."""

import contextlib
import csv
import json
import os
import random
import re

import pytest
from test_web_pages import act, until
from web_app import COARSE, drawn, page_of, project_of, served

from outsole_bodies import grooved, heel_body, triangles, write_stl

pytest.importorskip("nicegui")

from underfoot.app.project import Project

Error = pytest.importorskip("playwright.sync_api").Error
pytestmark = [pytest.mark.browser, pytest.mark.slow]


@pytest.fixture
def project(tmp_path):
    return project_of(tmp_path / "project", "heel")


@pytest.fixture
def app(tmp_path, project):
    with served(project.folder, tmp_path / "home") as running:
        yield running


def computed(page, app, name="heel"):
    """Compute a variant from its answer page."""
    page.goto(f"{app.base}answer?variant={name}")
    page.get_by_role("button", name="Compute friction").click()
    page.wait_for_selector(".big")
    drawn(page)


def typed(field, text):
    """Type as a person does, who goes on once the text stands there."""

    def stands():
        field.fill(text)
        field.page.wait_for_timeout(500)
        return field.input_value() == text

    until(stands)


def sole(path, pitch):
    return write_stl(path, triangles(heel_body(grooved(pitch=pitch))))


def dropped(page, path):
    page.locator("input[type=file][accept*=stl]").set_input_files(path)
    page.get_by_role("button", name="Use this sole").wait_for()


def test_a_second_export_of_a_sole_locks_no_variant(app, project, tmp_path):
    (tmp_path / "a").mkdir()
    (tmp_path / "b").mkdir()
    first, second = (
        sole(tmp_path / folder / "sole.stl", pitch) for folder, pitch in (("a", 10e-3), ("b", 7e-3))
    )
    project.change("heel", {"shoe.tread.lug_width": "6 mm"})  # drawn with a slider before
    with page_of(app.link) as page:
        page.goto(f"{app.base}design?variant=heel")
        drawn(page)
        dropped(page, first)
        page.get_by_role("button", name="Use this sole").click()
        page.get_by_text("The sole comes from sole.stl").wait_for()
        copy = project.copy("heel", "copy")
        page.goto(f"{app.base}design?variant={copy}")
        drawn(page)
        dropped(page, second)
        page.get_by_role(
            "button", name="Use it here and in place of its other revisions: heel"
        ).wait_for()
        page.get_by_role("button", name="Use this sole").click()
        page.get_by_text("The sole comes from sole, revision 2.stl").wait_for()
        page.goto(f"{app.base}design?variant=heel")
        page.get_by_text("The sole comes from sole.stl").wait_for()
        page.goto(f"{app.base}design?variant={copy}")
        page.get_by_text("revision 2.stl").first.wait_for()
        page.get_by_role("button", name="Undo").click()
        page.get_by_text("The sole comes from sole.stl").wait_for()
        assert page.complaints == []
    assert (project.folder / "soles" / "sole.stl").read_bytes() == first.read_bytes()
    for name in project.variants():
        project.case(name)


def test_a_variant_whose_file_is_gone_or_another_is_repaired_on_its_page(app, project, tmp_path):
    with page_of(app.link) as page:
        page.goto(f"{app.base}design?variant=heel")
        drawn(page)
        dropped(page, sole(tmp_path / "sole.stl", 10e-3))
        page.get_by_role("button", name="Use this sole").click()
        page.get_by_text("The sole comes from sole.stl").wait_for()
        stored = project.folder / "soles" / "sole.stl"
        stored.rename(stored.with_name("renamed.stl"))
        page.goto(f"{app.base}answer?variant=heel")
        page.get_by_text("This variant can't be read").wait_for()
        page.get_by_role("button", name="Take renamed.stl: the same content").click()
        page.wait_for_selector("text=has not been computed yet")
        sole(stored.with_name("renamed.stl"), 7e-3)  # exported over it
        page.goto(f"{app.base}design?variant=heel")
        page.get_by_role("button", name="Take renamed.stl as it is now").click()
        page.get_by_text("The sole comes from renamed.stl").wait_for()
        stored.with_name("renamed.stl").unlink()
        page.reload()
        page.locator(".repair input[type=file]").set_input_files(tmp_path / "sole.stl")
        page.get_by_text("The sole comes from sole.stl").wait_for()
        assert page.complaints == []


def test_a_refused_preview_leaves_no_number_and_the_full_run_answers(app):
    with page_of(app.link) as page:
        computed(page, app)
        page.locator(".big").wait_for()
        speed = page.locator("input[name='motion.speed']")
        speed.focus()
        page.keyboard.press("ArrowLeft")
        preview = page.locator("[data-live=preview]")
        page.get_by_text("Preview: COF").wait_for()
        wear = page.locator("input[name='shoe.wear.depth']")
        wear.focus()
        page.keyboard.press("End")  # 4 mm of a tread of 3 mm
        page.get_by_text("No preview of this setting").wait_for()
        assert "COF" not in preview.inner_text()
        assert page.locator(".sole-view.unanswered").count() == 1
        page.get_by_text("Full run: COF").wait_for()
        page.wait_for_selector(".sole-view:not(.unanswered)")
        page.get_by_text("No preview of this setting").wait_for(state="hidden")
        page.get_by_role("button", name="Keep it as a variant").click()
        page.wait_for_url(re.compile(r"variant=heel.+speed.+per.s"))
        (kept,) = {path.stem for path in (app.folder / "variants").glob("*.toml")} - {"heel"}
        assert kept.startswith("heel, Sliding speed 0.")
        page.wait_for_selector(".big")
        assert page.locator(".stale").count() == 0
        page.goto(f"{app.base}compare?variants=heel|{kept}")
        page.locator("td", has_text=kept).first.wait_for()
        assert page.complaints == []


def test_a_change_in_one_tab_marks_the_numbers_of_the_others(app, project):
    with page_of(app.link) as page:
        computed(page, app)
        start = page.context.new_page()
        start.goto(app.base)
        start.get_by_text("COF 0.").wait_for()
        assert start.get_by_text("of earlier inputs").count() == 0
        design = page.context.new_page()
        design.goto(f"{app.base}design?variant=heel")
        drawn(design)
        project.change("heel", {"shoe.tread.lug_width": "7 mm"})  # as another program or tab
        page.get_by_text("these numbers are of earlier inputs").wait_for()
        page.wait_for_selector(".stale .big")
        assert page.locator(".sliders input").count() == 0
        start.get_by_text("of earlier inputs").wait_for()
        slider = design.locator("input[name='shoe.tread.lug_width']")
        until(lambda: slider.get_attribute("aria-valuetext") == "7 mm")
        design.get_by_role("button", name="Undo").click()
        page.wait_for_selector(".sliders input")
        assert page.locator(".stale").count() == 0
        start.get_by_text("of earlier inputs").wait_for(state="detached")


def test_two_tabs_that_move_sliders_at_once_end_as_the_file(app, project):
    names = ("shoe.tread.lug_width", "shoe.tread.depth")
    with page_of(app.link) as page:
        tabs = [page, page.context.new_page()]
        for tab in tabs:
            tab.goto(f"{app.base}design?variant=heel")
            drawn(tab)

        def shown(tab, name):
            slider = tab.locator(f"input[name='{name}']")
            return float((slider.get_attribute("aria-valuetext") or "0").split()[0])

        def as_the_file():
            values = {name: 1e3 * project.case("heel").value(name) for name in names}
            pairs = [(shown(tab, name), values[name]) for tab in tabs for name in names]
            return all(seen == pytest.approx(value, abs=1e-6) for seen, value in pairs)

        before = [project.case("heel").value(name) for name in names]
        for step in (1, 2):
            for tab, name in zip(tabs, names, strict=True):
                tab.locator(f"input[name='{name}']").press("ArrowRight")
            moved = pytest.approx([value + step * 1e-4 for value in before])
            until(lambda moved=moved: [project.case("heel").value(n) for n in names] == moved)
            until(as_the_file)
        assert page.complaints == []


def test_one_worn_shoe_gives_the_life_in_months(app, project):
    with page_of(app.link) as page:
        computed(page, app)
        page.get_by_text("How long it lasts").click()
        lost, months = page.get_by_label("Thickness lost"), page.get_by_label("In months")
        typed(lost, "0,5 kg")
        page.get_by_role("button", name="Compute its wear").click()
        page.locator(".q-field--error").wait_for()
        typed(lost, "1,2")
        typed(months, "5")
        page.get_by_role("button", name="Compute its wear").click()
        page.get_by_text("The last state has lost").wait_for()
        with (project.folder / "studies" / "heel, wear" / "wear.csv").open() as file:
            life = float(list(csv.DictReader(file))[-1]["months_low"])
        assert life > 5  # it goes on beyond what that shoe lost
        text = page.get_by_text("The last state has lost").inner_text()
        assert f"{float(f'{life:.1g}'):.0f} months" in text
        rows = page.locator("table", has_text="Walked").locator("tr")
        assert rows.count() == 9  # a head, new, six worn states and the one without tread
        assert page.complaints == []


def test_looking_starts_nothing_and_the_last_variant_comes_back(app, project):
    with page_of(app.link) as page:
        page.goto(f"{app.base}answer?variant=heel&run=1")
        page.get_by_text("has not been computed yet").wait_for()
        assert not (app.folder / "jobs.jsonl").exists()
        page.get_by_role("button", name="More for this variant").click()
        page.locator(".q-menu .q-item", has_text="Remove").first.click()
        page.get_by_role("button", name="Restore heel").click()
        page.wait_for_url(re.compile(r"variant=heel$"))
        until(lambda: project.path("heel").exists())
        page.goto(f"{app.base}trials")
        page.get_by_role("button", name="Try it with made-up slips").click()
        page.wait_for_url("**/trials?study=*")
        page.go_back()
        page.get_by_role("heading", name="Folders of this project").wait_for()


def shown_truly(page, project):
    """Assert that a page shows no number but of present inputs, and has a way on."""
    route = re.sub(r".*:\d+|\?.*", "", page.url)
    names = project.variants()
    if route == "/":
        for row in page.locator(".recent-row").all():
            name, text = row.locator("a").first.inner_text(), row.inner_text()
            if "COF" in text and name in names:
                assert ("earlier inputs" in text) != project.is_current(name), text
        return
    if not names:
        assert page.get_by_role("button", name="Begin with a work shoe").count() or route == "/"
        return
    assert page.get_by_role("button", name="Compute friction").count() or (
        page.locator(".repair").count()
    ), page.url
    shown = page.locator(".variant input").first.input_value()
    if route == "/answer" and shown in names and page.locator(".big").count():
        assert (page.locator(".stale .big").count() == 0) == project.is_current(shown), page.url
    if route == "/design" and shown in names:
        case = project.case(shown)
        slider = page.locator("input[name='motion.speed'], input[name='shoe.wear.depth']").first
        if slider.count():
            value = case.value(slider.get_attribute("name"))
            given = float(slider.get_attribute("aria-valuetext").split()[0])
            assert given == pytest.approx(1e3 * (value or 0.0), abs=0.06)


def test_two_tabs_show_no_number_of_other_inputs(app, project):
    """Random actions in two tabs; after each some pages are read beside the files.

    UNDERFOOT_ACTIONS=1000 for more.
    """
    chance, count = random.Random(29), int(os.environ.get("UNDERFOOT_ACTIONS", "60"))
    with page_of(app.link) as page:
        page.goto(f"{app.base}design?variant=heel")
        drawn(page)
        tabs = [page, page.context.new_page()]
        tabs[1].goto(app.base)
        read = 0
        for number in range(count):
            tab = tabs[chance.randrange(2)]
            tab.set_default_timeout(3000)
            with contextlib.suppress(Error):
                if chance.random() < 0.15:
                    tab.get_by_role("button", name="Compute friction").click()
                elif chance.random() < 0.1 and project.variants():
                    name = chance.choice(project.variants())
                    project.change(
                        name, {**COARSE, "motion.speed": f"0.{chance.randrange(3, 9)} m/s"}
                    )
                else:
                    act(tab, chance, app.base)
            if number % 5 == 4:
                for each in tabs:
                    read += _read(each, project)
        assert read > 0.8 * 2 * (count // 5)
        assert app.process.poll() is None
        history = (app.folder / "history.jsonl").read_text().splitlines()
        again = Project(app.folder)
        assert {json.loads(line)["variant"] for line in history} == {
            *again.variants(),
            *again.removed_variants(),
        }


def _read(page, project):
    """Return whether a page showed the truth within ten looks; pages that move on are left out."""
    page.set_default_timeout(30_000)
    problem = None
    for _ in range(10):
        page.wait_for_timeout(1500)
        try:
            shown_truly(page, project)
            return True
        except Error:
            continue
        except AssertionError as error:
            problem = error
    if problem is not None:
        raise problem
    return False
