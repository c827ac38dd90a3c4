"""The choice of a shoe for a place in the app: a file dropped, stopped, computed, shown again."""

import json

import pytest

pytest.importorskip("nicegui")

from web_app import page_of, served

from underfoot.places.place import KEYS

pytestmark = [pytest.mark.browser, pytest.mark.slow]

PLACE = """\
name = "Hall"
[fluids]
dry = 0.9
glycerol_90pct = 0.1
[[floor]]
name = "hall"
roughness = { rq = "2 um" }
[[shoe]]
name = "smooth"
from = "work_shoe_untreaded"
[[shoe]]
name = "treaded"
from = "work_shoe_full_tread"
"""


def test_a_place_is_dropped_stopped_computed_shown_again_and_refused(tmp_path):
    good, bad = tmp_path / "hall.toml", tmp_path / "bad.toml"
    good.write_text(PLACE)
    bad.write_text(PLACE.replace("dry = 0.9", "dry = 0.5"))
    with served(tmp_path / "project", tmp_path / "home") as app, page_of(app.link) as page:
        page.goto(app.base + "place")
        zone = page.get_by_role("button", name="Drop a place here")

        def drop(file):
            with page.expect_file_chooser() as chooser:
                zone.click()
            chooser.value.set_files(file)

        drop(good)
        page.get_by_role("button", name="Stop").first.click()
        page.get_by_role("button", name="Compute", exact=True).or_(
            page.get_by_text("treaded is best")
        ).first.wait_for()
        drop(good)
        page.get_by_text("treaded is best").wait_for()
        page.get_by_role("table").first.wait_for()
        stored = app.folder / "places" / "hall"
        assert (stored / "report.html").exists()
        shown = json.loads((stored / "shown.json").read_text())
        assert any("best" in line["text"] for line in shown["headline"])
        page.goto(app.base + "place?place=hall")
        page.get_by_text("treaded is best").wait_for()  # from the folder
        page.emulate_media(media="print")
        assert not page.get_by_role("button", name="Drop a place here").is_visible()
        page.emulate_media(media="screen")
        drop(bad)
        page.get_by_text("the shares add to 0.6").first.wait_for()
        assert not [each for each in page.complaints if "favicon" not in each]


def test_the_page_names_the_parts_of_a_place(tmp_path):
    with served(tmp_path / "project", tmp_path / "home") as app, page_of(app.link) as page:
        page.goto(app.base + "place")
        page.get_by_text("floors, fluids, shoes and people").wait_for()
        assert {"floor", "fluids", "shoe", "people"} <= set(KEYS[""])
