"""A designer's tasks on the drawn sole, in a browser: each within a minute, its clicks counted."""

import time

import numpy as np
import pytest
from chromium import PATIENCE
from test_web_truth import computed
from web_app import Cost, begin, drawn, page_of, project_of, served, unfold

from machine import slowness
from outsole_bodies import grooved, heel_body, triangles, write_stl
from underfoot.case import Case

pytest.importorskip("nicegui")
pytest.importorskip("playwright.sync_api")
pytestmark = [pytest.mark.browser, pytest.mark.slow]
LONGEST = 60  # s a task on a usual machine, of wall or processor (app and browser), the less
OUTLINE = """() => { const box = document.querySelector('canvas').getBoundingClientRect();
return [...document.querySelectorAll('.overlay .lug')].map((path) => path.getAttribute('d')
.slice(1).split('L').map((end) => end.split(' ').map(Number)))
.map((ends) => ends.map(([x, y]) => [x + box.left, y + box.top])); }"""


class Task:
    """One task: what it costs, and how many clicks it takes."""

    def __init__(self, page, name):
        self.page, self.name, self.clicks = page, name, 0

    def __enter__(self):
        self._cost = Cost().__enter__()
        return self

    def __exit__(self, kind, *_):
        self._cost.__exit__()
        print(f"{self.name}: {self.clicks} clicks, {self._cost}")
        assert kind is not None or self._cost.least < LONGEST * slowness()

    def click(self, place):
        self.clicks += 1
        place.click()

    def click_lug(self):
        """Click lugs from the middle of the sole outwards until one is chosen."""
        self.page.get_by_role("button", name="From below").click()
        box = self.page.locator(".sole-view canvas").bounding_box()
        for across in (0.5, 0.51, 0.52, 0.53, 0.54):
            for along in (0.6, 0.62, 0.64, 0.66):
                self.page.mouse.click(
                    box["x"] + across * box["width"], box["y"] + along * box["height"]
                )
                if self.page.locator(".lug-card").count():
                    self.clicks += 2  # the view and the lug: a person sees where it is
                    return
        raise AssertionError("no lug under the pointer")


@pytest.fixture(scope="module")
def app(tmp_path_factory):
    folder = tmp_path_factory.mktemp("sole")
    with served(folder / "project", folder / "home") as running:
        yield running


@pytest.fixture
def page(app):
    with page_of(app.link) as opened:
        skip = opened.get_by_role("button", name="Skip")
        if skip.count():
            skip.first.click()
        begin(opened, app.base) if not list((app.folder / "variants").glob("*.toml")) else None
        opened.goto(app.base + "design")
        drawn(opened)
        yield opened
        assert opened.complaints == []


def value(app, path):
    (file,) = (app.folder / "variants").glob("*.toml")
    return Case.load(file).value(path)


def until(met):
    limit = time.monotonic() + PATIENCE
    while not met():
        assert time.monotonic() < limit
        time.sleep(0.1)


def test_channels_are_widened_by_a_number_typed_at_a_lug_and_undone(app, page):
    before = value(app, "shoe.tread.channel_width")
    with Task(page, "widen the channels") as task:
        task.click_lug()
        field = page.locator("[name='lug shoe.tread.channel_width']")
        field.fill("4")
        field.press("Enter")
        until(lambda: value(app, "shoe.tread.channel_width") == pytest.approx(4e-3))
    for typed in ("", "abc", "4 N", "1,234", "4 5", "-4", "1e400", "NaN", "40"):
        field.fill(typed)
        field.press("Enter")
        page.locator("[name='lug shoe.tread.channel_width'][aria-invalid=true]").wait_for()
        assert value(app, "shoe.tread.channel_width") == pytest.approx(4e-3), typed
        field.fill("4")
        field.press("Enter")
        page.locator("[name='lug shoe.tread.channel_width'][aria-invalid=false]").wait_for()
    for typed, length in (("5/32 in", 3.96875e-3), ("4,15", 4.15e-3), ("0.4123 cm", 4.123e-3)):
        field.fill(typed)
        field.press("Enter")  # as it is typed, not at the slider's next step
        until(lambda to=length: value(app, "shoe.tread.channel_width") == pytest.approx(to, 1e-9))
    for _ in range(3):
        before_undo = value(app, "shoe.tread.channel_width")
        page.locator("[data-step=undo]").click()
        until(lambda old=before_undo: value(app, "shoe.tread.channel_width") != old)
    with Task(page, "take it back") as task:
        task.click(page.locator("[data-step=undo]"))
        until(lambda: value(app, "shoe.tread.channel_width") == before)


def test_the_edge_of_a_lug_is_dragged(app, page):
    before = value(app, "shoe.tread.lug_width")
    with Task(page, "drag the edge of a lug") as task:
        task.click_lug()
        page.wait_for_function("document.querySelectorAll('.overlay .lug').length >= 4")
        edges = page.evaluate(OUTLINE)
        longest = max(edges, key=lambda e: abs(e[0][1] - e[1][1]) - abs(e[0][0] - e[1][0]))
        centre = [sum(end[c] for edge in edges for end in edge) / len(edges) / 2 for c in (0, 1)]
        x, y = (sum(end[c] for end in longest) / 2 for c in (0, 1))
        page.mouse.move(x, y)
        page.mouse.down()
        outwards = 1 if x > centre[0] else -1
        for step in range(1, 5):
            page.mouse.move(x + outwards * 3 * step, y)
        page.mouse.up()
        task.clicks += 1
        until(lambda: value(app, "shoe.tread.lug_width") > before + 0.3e-3)
    assert value(app, "shoe.tread.lug_width") < before + 12e-3
    page.locator("[data-step=undo]").click()
    until(lambda: value(app, "shoe.tread.lug_width") == before)


def test_the_rear_of_the_heel_is_chamfered(app, page):
    before = value(app, "shoe.heel.profile.angle")
    with Task(page, "chamfer the heel") as task:
        slider = page.locator("input[name='shoe.heel.profile.angle']")
        task.click(slider)
        until(lambda: value(app, "shoe.heel.profile.angle") != before)
    page.locator("[data-step=undo]").click()
    until(lambda: value(app, "shoe.heel.profile.angle") == before)


def test_sipes_are_added(app, page):
    with Task(page, "add sipes") as task:
        task.click(page.get_by_role("button", name="Add sipes"))
        until(lambda: value(app, "shoe.tread.sipes.width") == pytest.approx(0.8e-3))
        page.locator("input[name='shoe.tread.sipes.width']").wait_for()
    page.locator("[data-step=undo]").click()
    until(lambda: value(app, "shoe.tread.sipes.width") is None)


def test_the_lug_that_floats_is_found(app, page):
    page.get_by_role("button", name="Compute friction").click()
    unfold(page)
    drawn(page)
    with Task(page, "find the lug that floats") as task:
        task.click(page.locator("tr[data-lug='0']"))
        page.wait_for_function("document.querySelectorAll('.overlay .lug').length >= 4")
        assert page.locator(".overlay .groove").count() == 1
        place = page.locator("[data-part=values-place]").inner_text()
    assert place.startswith("At x")


def test_two_treads_are_compared_at_equal_land_and_back(tmp_path):
    from underfoot.app.work_sole import LAND_EQUAL, _land_share

    project = project_of(tmp_path / "project", "A", "B")
    project.change("B", {"shoe.tread.pattern": "hexagons", "shoe.tread.channel_width": "4 mm"})
    with served(project.folder, tmp_path / "home") as app, page_of(app.link) as page:
        for name in ("A", "B"):
            computed(page, app, name)
        page.goto(app.base + "compare?variants=A|B")
        drawn(page)
        with Task(page, "compare at equal land") as task:
            task.click(page.get_by_role("button", name="At equal land"))
            page.get_by_role("link", name="B, land of A", exact=True).wait_for()
            drawn(page)
        page.locator(".pane-name", has_text="B, land of A").wait_for()
        assert page.locator(".pane-name").all_inner_texts() == ["A A", "B B, land of A"]
        page.get_by_text("give B the land of A").wait_for()
        a, b = (project.case(name) for name in ("A", "B, land of A"))
        assert abs(_land_share(a) - _land_share(b)) <= LAND_EQUAL
        assert b.replace("shoe.tread.channel_width", "4 mm").shoe == project.case("B").shoe
        page.locator("[data-step=undo]").click()
        page.get_by_role("link", name="B", exact=True).first.wait_for()
        assert set(project.variants()) == {"A", "B"}
        page.get_by_role("button", name="At equal land").click()
        page.get_by_role("link", name="B, land of A 2", exact=True).wait_for()
        page.goto(app.base + "design?variant=B, land of A 2")
        drawn(page)
        page.locator("[data-step=undo]").click()
        until(lambda: project.case("B, land of A 2").shoe == project.case("B").shoe)
        assert page.complaints == []


def test_land_that_no_channel_width_gives_is_refused_with_a_remedy(tmp_path):
    from underfoot.app.work_sole import equal_land
    from underfoot.core import InputError, silent

    body = write_stl(tmp_path / "sole.stl", triangles(heel_body(grooved(pitch=10e-3))))
    project = project_of(tmp_path / "project", "A", "B", "file")
    project.change("file", {"shoe.outsole.file": str(body)})
    files = {name: str(project.path(name)) for name in ("A", "B", "file")}
    for pair in (("A", "file"), ("file", "A")):
        with pytest.raises(InputError, match=r"comes from a file.*Compare at equal land two"):
            equal_land(*(files[name] for name in pair), progress=silent)
    assert equal_land(files["A"], files["B"], progress=silent)[0] == {}
    for changes, remedy in (
        ({"shoe.tread.pattern": "none"}, "Choose a pattern of lugs"),
        ({"shoe.tread.lug_width": "2.5 mm"}, "Change shoe.tread.lug_width"),
    ):
        project.change("B", changes)
        with pytest.raises(InputError, match=remedy):
            equal_land(files["A"], files["B"], progress=silent)
        project.undo("B")


LARGE_LUGS = {
    "shoe.tread.lug_width": "30 mm",
    "shoe.tread.channel_width": "4 mm",
}  # of 20 mm none floats
GROOVES = "shoe.tread.grooves"


def edges(page):
    """Return of how many lines the lugs of the drainage are drawn in all."""
    count = 0
    for row in page.locator("tr[data-lug] th").all():
        row.click()
        drawn(page)
        count += page.locator(".overlay .lug").count()
    return count


def test_the_advised_groove_is_cut_by_its_row_and_taken_out_again(tmp_path):
    project = project_of(tmp_path / "project", "A")
    project.change("A", LARGE_LUGS)
    with served(project.folder, tmp_path / "home") as app, page_of(app.link) as page:
        computed(page, app, "A")
        unfold(page)
        before, plain = project.summary("A"), edges(page)
        with Task(page, "cut the advised groove") as task:
            task.click(page.get_by_role("button", name="Cut this groove").first)
            until(lambda: project.summary("A") != before and project.is_current("A"))
            page.wait_for_selector(".verdict-place:not(.stale) .verdict")
            drawn(page)
        assert project.summary("A").cof > before.cof
        unfold(page)
        assert edges(page) > plain
        page.goto(app.base + "design?variant=A")
        drawn(page)
        page.get_by_role("button", name="Take out the last groove (1 in all)").click()
        until(lambda: value(app, GROOVES) is None)
        for step, there in (("undo", True), ("undo", False), ("redo", True)):
            page.locator(f"[data-step={step}]").click()
            until(lambda there=there: (value(app, GROOVES) is not None) == there)
        assert page.complaints == []


def test_the_advised_groove_lies_where_the_advice_was(tmp_path):
    from underfoot.app.work_sole import advised_groove
    from underfoot.compute.run import run
    from underfoot.core import silent
    from underfoot.report import write_report

    project = project_of(tmp_path / "project", "A")
    case = project.change("A", LARGE_LUGS)
    before = run(case)
    write_report(before, tmp_path / "result")
    arguments = str(project.path("A")), str(tmp_path / "result"), 0
    cut = project.change("A", advised_groove(*arguments, progress=silent))
    after = run(cut)
    assert after.scalars["fluid_load"].value < before.scalars["fluid_load"].value
    x, y, length, side = (
        float(before.data[f"lug_{name}"].values[0]) for name in ("x", "y", "groove", "groove_side")
    )
    along = np.array([(1, 0), (-1, 0), (0, 1), (0, -1)][int(side)])
    land = [each.data["land"].values.astype(bool) for each in (before, after)]
    assert not (land[1] & ~land[0]).any()
    for share in (0.0, 0.5, 0.95):  # from the peak to the lug's wall
        place = np.array([x, y]) + share * length * along
        i, j = (
            int(np.abs(before.data[a].values - c).argmin())
            for a, c in zip("xy", place, strict=True)
        )
        assert land[0][i, j]
        assert not land[1][i, j]
    width = cut.value(GROOVES)[0].width
    beside = np.argwhere(land[0] & ~land[1])
    places = np.column_stack(
        [before.data[a].values[k] for a, k in zip("xy", beside.T, strict=True)]
    ) - (x, y)
    assert np.abs(places @ along[::-1]).max() <= width / 2 + 0.6e-3  # half a cell
    two = advised_groove(*arguments, progress=silent)[GROOVES]  # a second one goes beside it
    assert case.replace(GROOVES, two[:1]).hash == cut.hash
    assert len(two) == 2
