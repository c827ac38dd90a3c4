"""The trials page in a browser: a folder dropped, an event moved, a step excluded, all undone."""

import filecmp
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from web_app import COMMAND, page_of, served

pytest.importorskip("nicegui")
pytest.importorskip("playwright")
pytestmark = [pytest.mark.browser, pytest.mark.slow]

DATA = Path(__file__).parents[1] / "data" / "trials" / "biomechzoo"
WALK, OTHER = "HC030A05.c3d", "HC036A23.c3d"


def _dropped(page, folder):
    """Drop a folder of the disk on the page, as from a file manager."""
    box = page.locator(".folder-drop").bounding_box()
    talk = page.context.new_cdp_session(page)
    data = {"items": [], "files": [str(folder)], "dragOperationsMask": 1}
    place = {"x": box["x"] + box["width"] / 2, "y": box["y"] + 15}
    for kind in ("dragEnter", "dragOver", "drop"):
        talk.send("Input.dispatchDragEvent", {"type": kind, "data": data, **place})


def _dragged(page, event, by):
    wide = "document.querySelectorAll('.trial-plot svg')[1]?.getAttribute('width') > 1000"
    page.wait_for_function(wide)
    box = page.locator(f'[data-event="{event}"] .knob').bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + 4
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + by / 2, y)
    page.mouse.move(x + by, y)
    page.mouse.up()


def _press(page, name):
    page.get_by_role("button", name=name, exact=True).click()


def test_a_folder_is_dropped_edited_and_reported(tmp_path):
    folder = tmp_path / "my walks"
    folder.mkdir()
    for name in (WALK, OTHER):
        shutil.copy(DATA / name, folder)
    (folder / "text.c3d").write_text("this is text\n")
    (folder / ".hidden").write_text("not sent\n")
    kept = tmp_path / "project" / "trials" / "my walks"
    with (
        served(tmp_path / "project", tmp_path / "home") as app,
        page_of(app.link) as page,
    ):
        page.goto(app.base + "trials")
        _dropped(page, folder)
        page.locator(".trial-card").nth(2).wait_for()
        assert sorted(path.name for path in kept.iterdir()) == [WALK, OTHER, "text.c3d"]
        page.get_by_text("not a C3D file").wait_for()
        page.locator(".trial-card", has_text=WALK).click()
        page.get_by_text("step 1 on plate 2: RCOF 0.2159").wait_for()

        _dragged(page, "contact", 60)
        page.get_by_text("RCOF 0.2159 → 0.214").wait_for()
        assert not (kept / "edits.csv").exists()
        _press(page, "Keep")
        page.get_by_text("An edit by hand needs its reason").wait_for()
        page.get_by_label("Why?").fill("seen in the video")
        page.keyboard.press("Enter")
        page.get_by_role("heading", name="Edits by hand").wait_for()
        row = (kept / "edits.csv").read_text().splitlines()[1]
        assert re.fullmatch(rf"{WALK},1,contact,3\.07\d\d s,seen in the video", row)

        page.get_by_role("slider", name="toe off").focus()
        page.keyboard.press("Shift+ArrowLeft")
        page.get_by_text("toe off 3.6440 s → 3.6340 s").wait_for()
        _press(page, "Discard")
        page.get_by_label("Why?").wait_for(state="detached")

        _press(page, "2 left: 0.252")
        page.get_by_text("step 2 on plate 1: RCOF").wait_for()
        _press(page, "Exclude this step")
        page.get_by_label("Why?").fill("targeted the plate")
        _press(page, "Keep")
        page.get_by_text("2 left: –").wait_for()
        page.get_by_text("excluded by hand: targeted the plate").first.wait_for()
        shown = page.locator(".trial-summary").inner_text()
        _press(page, "All trials")
        _press(page, "Write the report")
        link = page.get_by_role("link", name="Open the report")
        link.wait_for(timeout=300_000)  # figures are drawn: seconds, more on a busy machine
        made = page.evaluate("(at) => fetch(at).then((r) => r.text())", link.get_attribute("href"))
        assert "targeted the plate" in made

        _same_as_by_command(kept, tmp_path, shown)

        page.locator(".trial-card", has_text=WALK).click()
        edits = page.locator(".edit")
        edits.nth(1).wait_for()
        page.get_by_role("button", name="Take back").first.click()
        edits.nth(1).wait_for(state="detached")
        _press(page, "Undo the last edit")
        edits.nth(1).wait_for()
        assert len((kept / "edits.csv").read_text().splitlines()) == 3
        _press(page, "Redo the edit")
        edits.nth(1).wait_for(state="detached")
        page.reload()
        page.get_by_text("step 1 on plate 2: RCOF 0.2159").wait_for()
        assert page.complaints == []


def _same_as_by_command(kept, place, shown):
    """The report of the page is, byte for byte, that of the command; the page shows its number."""
    out, report = place / "by command", place / "project" / "results" / "my walks trials"
    arguments = ["trials", "analyse", kept, "--protocol", "level_walking", "--out", out]
    command = [sys.executable, "-c", COMMAND, *map(str, arguments), "--processes", "1"]
    subprocess.run(command, check=True, capture_output=True)
    names = ["report.html", *(f"tables/{path.name}" for path in (out / "tables").iterdir())]
    assert sorted(filecmp.cmpfiles(out, report, names, shallow=False)[0]) == sorted(names)
    files = (out / "tables" / "files.csv").read_text()
    rcof = float(re.search(rf"{WALK},accepted,(0\.\d+)", files)[1])
    assert f"RCOF {rcof:.3g}" in shown


def test_what_can_not_be_read_gets_words_and_a_way_on(tmp_path):
    project = tmp_path / "project"
    for name in ("photos", "walks"):
        (project / "trials" / name).mkdir(parents=True)
    (project / "trials" / "photos" / "photo.jpg").write_bytes(b"\xff\xd8\xff")
    (project / "trials" / "walks" / "<img src=x onerror=alert(1)>.c3d").write_text("text")
    (project / "trials" / "walks" / "edits.csv").write_text("file,step\nx,1\n")
    with served(project, tmp_path / "home") as app, page_of(app.link) as page:
        page.goto(app.base + "trials?study=photos")
        page.get_by_text("holds no trial file").wait_for()
        _press(page, "All folders")
        page.get_by_role("button", name="walks").click()
        page.get_by_text('there is no column "edit"').wait_for()
        (project / "trials" / "walks" / "edits.csv").unlink()
        _press(page, "All folders")
        page.get_by_role("button", name="walks").click()
        page.locator(".trial-card", has_text="<img src=x").click()
        page.get_by_text("not a C3D file").wait_for()
        assert page.complaints == []
