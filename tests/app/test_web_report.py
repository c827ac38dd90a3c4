"""The page of a project: its variants on one sheet, other projects, a copy that stays by itself."""

import csv
import re
import shutil

import pytest
from web_app import Cost, drawn, page_of, project_of, served, settled

pytest.importorskip("nicegui")

from underfoot.app import work
from underfoot.core import silent

pytest.importorskip("playwright.sync_api")
pytestmark = [pytest.mark.browser, pytest.mark.slow]


@pytest.fixture
def project(tmp_path):
    return project_of(tmp_path / "project", "heel", "other")


def computed(page, app, name):
    page.goto(f"{app.base}answer?variant={name}")
    page.get_by_role("button", name="Compute friction").click()
    page.wait_for_selector(".big")
    drawn(page)


def files(folder):
    return {path: path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def test_the_report_of_a_project_says_what_each_number_is_of(tmp_path, project):
    with served(project.folder, tmp_path / "home") as app, page_of(app.link) as page:
        computed(page, app, "heel")
        page.goto(app.base + "project")
        row = page.get_by_role("row", name=re.compile("^heel"))
        row.get_by_text("of its present inputs").wait_for()
        summary = project.summary("heel")
        shown = row.inner_text()
        assert f"{summary.cof:.3f}" in shown
        assert f"{summary.low:.3f} to {summary.high:.3f}" in shown
        assert re.search("Grips|Doubtful|Slips", shown)
        assert "not computed yet" in page.get_by_role("row", name=re.compile("^other")).inner_text()
        project.change("heel", {"shoe.tread.depth": "2 mm"})
        row.get_by_text("of earlier inputs").wait_for()
        page.emulate_media(media="print")
        assert row.is_visible()
        assert not page.get_by_text("Other projects").is_visible()
        assert page.locator("table").bounding_box()["width"] <= 1366
        assert page.complaints == []


def test_lists_show_the_sole_of_each_variant(tmp_path, project):
    """500 variants: the table and the pictures in sight are there in seconds."""
    project.change("other", {"shoe.tread.pattern": "hexagons"})
    text = project.text("other")
    for number in range(498):
        project.path(f"sole {number}").write_text(text.replace('"other"', f'"sole {number}"'))
    project.path("broken").write_text("[shoe\n")
    shown = (
        "(name) => { const one = [...document.querySelectorAll('.sole-picture')]"
        ".find((each) => each.alt === name); return one?.complete && one.naturalWidth }"
    )
    with served(project.folder, tmp_path / "home") as app, page_of(app.link) as page:
        page.goto(app.base)
        page.wait_for_function("document.querySelectorAll('.sole-picture').length === 8")
        with Cost() as cost:
            page.goto(app.base + "project")
            page.wait_for_function(f"({shown})('Tread of heel') > 50")
        print(f"500 variants: {cost}")
        assert cost.least < 20
        places = [page.get_by_role("img", name=f"Tread of {name}") for name in ("heel", "other")]
        sources = [place.get_attribute("src") for place in places]
        fetched = "(address) => fetch(address).then((answer) => answer.text())"
        first, second = (page.evaluate(fetched, each) for each in sources)
        assert first.startswith("<svg")
        assert first != second
        assert page.evaluate(fetched, sources[0]) == first
        project.change("heel", {"shoe.wear.depth": "1 mm"})
        changed = page.get_by_role("img", name="Tread of heel")
        page.wait_for_function(
            "(before) => [...document.querySelectorAll('.sole-picture')]"
            ".some((one) => one.alt === 'Tread of heel' && !one.src.endsWith(before))",
            arg=sources[0],
        )
        assert changed.count() == 1
        assert page.complaints == []


def test_all_that_is_missing_is_computed_in_one_click(tmp_path, project):
    for number in range(3):
        project.copy("heel", f"heel {number}", {"shoe.tread.channel_width": f"{3 + number / 2} mm"})
    project.path("broken").write_text("[shoe\n")
    with served(project.folder, tmp_path / "home") as app, page_of(app.link) as page:
        page.goto(app.base + "project")
        page.get_by_role("button", name="Compute all that is missing (5)").click()
        page.get_by_text("of 5 computed").wait_for()
        page.get_by_role("button", name="Stop all").click()
        page.get_by_role("button", name="Stop all").wait_for(state="hidden")
        assert len(project.results()) < 5
        page.reload()  # what is missing is computed: nothing twice
        page.get_by_role("button", name=re.compile("missing")).click()
        page.get_by_role("button", name="Nothing to compute").wait_for()
        page.get_by_role("button", name="Stop all").wait_for(state="hidden")
        page.wait_for_function(
            "[...document.querySelectorAll('.result-table tbody tr')]"
            ".filter((row) => row.innerText.includes('of its present inputs')).length === 5"
        )
        assert "can't be read" in page.get_by_role("row", name=re.compile("^broken")).inner_text()
        page.get_by_role("columnheader", name="COF").click()
        page.wait_for_selector(".result-table th.sorted")
        settled(page)
        cells = page.locator(".result-table tbody tr td:nth-child(2)").all_inner_texts()
        shown = [float(cell.split()[0]) for cell in cells if cell]
        assert len(shown) == 5
        assert shown == sorted(shown)
        with page.expect_download() as got:
            page.get_by_role("button", name="Table (CSV)").click()
        lines = list(csv.DictReader(got.value.path().read_text().splitlines()))
        row = next(line for line in lines if line["variant"] == "heel 1")
        summary = project.summary("heel 1")
        assert float(row["shoe.tread.channel_width (m)"]) == pytest.approx(3.5e-3)
        for column, value in (("cof (1)", summary.cof), ("cof, 95 % low (1)", summary.low)):
            assert float(row[column]) == pytest.approx(value)
        page.goto(f"{app.base}answer?variant=heel 1")
        page.get_by_role("button", name="Simulate what would help").wait_for()
        page.goto(f"{app.base}compare?variants=heel 0|heel 1")
        page.get_by_text("What would tell", exact=False).first.wait_for()
        page.wait_for_function("!document.querySelector('.task')")
        folders = [str(project.result_folder(f"heel {n}")) for n in (0, 1)]
        told = work.separated(folders, progress=silent)
        assert told["open"]
        for sentence in told["headline"]:
            assert sentence.replace(" %", "\u00a0%") in page.locator(".lead").last.inner_text()
        assert page.complaints == []


def test_another_project_opens_beside_this_one(tmp_path, project):
    with served(project.folder, tmp_path / "home") as app, page_of(app.link) as page:
        page.goto(app.base + "project")
        page.get_by_role("button", name="Open", exact=True).click()
        page.get_by_text("a folder is needed").wait_for()
        page.get_by_label("Folder of another project").fill("second")
        page.get_by_role("button", name="Open", exact=True).click()
        page.wait_for_url(lambda url: not url.startswith(app.base))
        second = page.url
        page.goto(second + "project")
        page.get_by_role("heading", name="second").wait_for()
        assert (tmp_path / "second" / "variants").is_dir()
        page.get_by_role("button", name=str(project.folder)).wait_for()  # the way back
        page.goto(app.base + "project")
        page.get_by_role("button", name=str(tmp_path / "second")).click()
        page.wait_for_url(lambda url: url.startswith(second))  # its server runs already
        page.goto(app.base + "project")
        (tmp_path / "file").write_text("")
        page.get_by_label("Folder of another project").fill("file")
        page.get_by_role("button", name="Open", exact=True).click()
        page.get_by_text("can't be used as a project").first.wait_for()


def test_others_of_the_network_open_no_folder_of_this_machine(tmp_path):
    with (
        served(tmp_path / "project", tmp_path / "home", "--host", "0.0.0.0") as app,
        page_of(re.sub(r"//[^:/]+", "//127.0.0.1", app.link)) as page,
    ):
        page.goto(re.sub(r"//[^:/]+", "//127.0.0.1", app.base) + "project")
        page.get_by_role("heading", name="project").wait_for()
        assert page.get_by_text("Other projects").count() == 0


def test_a_copied_project_writes_nothing_elsewhere(tmp_path, project):
    with served(project.folder, tmp_path / "home") as app, page_of(app.link) as page:
        computed(page, app, "heel")
    copy = tmp_path / "copy"
    shutil.copytree(project.folder, copy)
    before, home = files(project.folder), files(tmp_path / "home")
    with served(copy, tmp_path / "home") as app, page_of(app.link) as page:
        page.goto(f"{app.base}design?variant=heel")
        drawn(page)
        slider = page.locator("input[name='shoe.tread.depth']")
        slider.focus()
        page.keyboard.press("ArrowLeft")
        page.wait_for_function("document.querySelector('[data-step=undo]').disabled === false")
        computed(page, app, "heel")
        page.locator(".help button").first.or_(page.get_by_text("No simulated change")).wait_for()
    assert files(project.folder) == before
    copied = files(copy)
    changed = {path.relative_to(copy).parts[0] for path, data in copied.items()
               if before.get(project.folder / path.relative_to(copy)) != data}  # fmt: skip
    assert {"variants", "results", "history.jsonl", "jobs.jsonl"} <= changed
    assert {path.name for path in files(tmp_path / "home").keys() - home.keys()} <= {"projects.txt"}
