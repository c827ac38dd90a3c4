"""The page in a real browser: no complaint, a picture that follows its controls, values."""

import base64
import dataclasses
import functools
import itertools
import re

import matplotlib
import numpy as np
import pytest
from chromium import opened

from underfoot.core import SourcedValue, Status, display
from underfoot.core.fields import from_xarray
from underfoot.core.html import environment
from underfoot.questions.comparison import case_differences, compare
from underfoot.questions.outcomes import CaseOutcome
from underfoot.questions.wear import WearSeries
from underfoot.questions.wear_limit import WearPoint
from underfoot.report import page_text, write_report
from underfoot.report.viewer import (
    colour_tables,
    scene_section,
    viewer_scene,
    viewer_script,
)
from underfoot.report.wear_page import wear_scene
from underfoot.shoe import Heel, Tread, WearPlane, heel_surface
from underfoot.shoe.worn import wear_measures
from viewer_fields import unpacked


@pytest.fixture(scope="module")
def page(worn_shoe_result, tmp_path_factory):
    path = tmp_path_factory.mktemp("page") / "report.html"
    path.write_text(page_text(worn_shoe_result, {}), encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def tab(page):
    with opened(page) as session:
        yield session


def centre(tab):
    box = tab.value(
        "(() => { document.querySelector('canvas').scrollIntoView({block: 'center'});"
        "const b = document.querySelector('canvas').getBoundingClientRect();"
        "return [b.left + b.width / 2, b.top + b.height / 2] })()"
    )
    return tuple(round(v) for v in box)


def colourful(picture):
    """Share of the pixels that are no grey: data, not rubber, floor or paper."""
    return float(np.mean(np.ptp(picture, axis=2) > 0.12))


def choose(tab, title):
    tab.value(
        "[...document.querySelectorAll('.choice label')]"
        f".find((one) => one.textContent === {title!r}).querySelector('input').click()"
    )
    tab.settle()


def changed(first, second):
    return float(np.mean(np.abs(first - second).max(axis=2) > 0.05))


@pytest.mark.browser
def test_the_sole_is_drawn_in_colour_and_nothing_is_complained_of(tab):
    picture, _ = tab.picture("canvas")
    assert colourful(picture) > 0.05
    assert len(np.unique((picture * 255).astype(int).reshape(-1, 3), axis=0)) > 300
    assert tab.complaints == []
    assert tab.value("document.querySelector('.viewer').dataset.ready") == "yes"


@pytest.mark.browser
def test_every_quantity_gives_its_own_picture_and_scale(tab):
    seen = {}
    centre(tab)
    titles = tab.value("[...document.querySelectorAll('.choice label')].map((l) => l.textContent)")
    assert titles[:4] == ["Contact pressure", "Fluid pressure", "Film thickness", "Local shear"]
    for title in titles:
        choose(tab, title)
        legend = tab.value("document.querySelector('[data-part=bar-title]').textContent")
        assert legend.startswith(title)
        assert "(" in legend, "no unit"
        ticks = tab.value("document.querySelectorAll('.ticks span').length")
        assert 2 <= ticks <= 9, title
        seen[title] = tab.picture("canvas")[0]
    for first, second in itertools.pairwise(titles):
        assert changed(seen[first], seen[second]) > 0.01, (first, second)
    assert tab.complaints == []


@pytest.mark.browser
def test_mouse_keyboard_and_height_move_the_sole(tab):
    tab.value("document.querySelector('[data-view=oblique]').click()")
    x, y = centre(tab)
    tab.settle()
    still, _ = tab.picture("canvas")
    assert changed(still, tab.picture("canvas")[0]) == 0.0
    pictures = [still]

    def moved(what):
        tab.settle()
        pictures.append(tab.picture("canvas")[0])
        assert changed(pictures[-2], pictures[-1]) > 0.01, what

    tab.drag((x, y), (x + 90, y + 20))
    moved("drag")
    tab.drag((x, y), (x - 60, y), modifiers=8)
    moved("shift and drag")
    tab.value("document.querySelector('canvas').focus()")
    tab.key("ArrowLeft")
    moved("arrow")
    tab.key("+")
    moved("plus")
    tab.value(
        "(() => { const s = document.querySelector('[data-part=stretch]'); s.value = 8;"
        "s.dispatchEvent(new Event('input')) })()"
    )
    moved("height")
    tab.value("document.querySelector('[data-part=stretch]').value = 1")
    tab.value("document.querySelector('[data-part=stretch]').dispatchEvent(new Event('input'))")
    tab.key("0")
    tab.settle()
    back = tab.picture("canvas")[0]
    assert changed(still[8:-8, 8:-8], back[8:-8, 8:-8]) < 0.01  # without the ring of the focus


@pytest.mark.browser
def test_a_point_tells_the_values_of_the_field_there(tab, worn_shoe_result):
    tab.value("document.querySelector('[data-view=below]').click()")
    tab.settle()
    x, y = centre(tab)
    tab.drag((x, y + 60), (x, y + 60))
    place = tab.value("document.querySelector('[data-part=values-place]').textContent")
    at = [float(v) * 1e-3 for v in re.findall(r"-?\d+\.\d", place)]
    field = worn_shoe_result.fields["film_thickness"].sel(x=at[0], y=at[1], method="nearest")
    told = tab.value("document.querySelector('[data-part=values-table]').innerText")
    (value,) = re.findall(r"Film thickness\s+([\d.]+) µm", told)
    assert float(value) * 1e-6 == pytest.approx(float(field), rel=6e-3)
    before = place
    tab.value("document.querySelector('canvas').focus()")
    tab.key("ArrowUp", modifiers=1)
    after = tab.value("document.querySelector('[data-part=values-place]').textContent")
    assert after != before
    tab.key("Escape")
    assert tab.value("document.querySelector('[data-part=values]').hidden")


@pytest.mark.browser
def test_the_value_stands_beside_the_pointer(tab, worn_shoe_result):
    tab.value("document.querySelector('[data-view=below]').click()")
    choose(tab, "Film thickness")
    x, y = centre(tab)
    tab.drag((x, y + 60), (x, y + 60))
    told = tab.value("document.querySelector('[data-part=values-table]').innerText")
    tab.call("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y + 61)
    tab.settle()
    tip = tab.value("document.querySelector('.tip').textContent")
    assert re.fullmatch(r"[\d.]+ µm", tip)
    pinned = float(re.findall(r"Film thickness\s+([\d.]+) µm", told)[0])
    assert float(tip.split()[0]) == pytest.approx(pinned, rel=0.2)  # a pixel aside
    tab.call("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=5)
    tab.settle()
    assert tab.value("document.querySelector('.tip').hidden")
    tab.key("Escape")


@pytest.mark.browser
def test_the_loads_of_both_pressures_are_told(tab, worn_shoe_result):
    for title, name in (("Fluid pressure", "fluid_load"), ("Contact pressure", "contact_load")):
        choose(tab, title)
        note = tab.value("document.querySelector('[data-part=bar-note]').textContent")
        (load,) = re.findall(r"([\d.]+) N in all", note)
        values = {"fluid_load": float(worn_shoe_result.fields.position_fluid_load[0])}
        values["contact_load"] = worn_shoe_result.value("normal_force") - values["fluid_load"]
        assert float(load) == pytest.approx(values[name], rel=0.01)


@pytest.mark.browser
def test_pressed_the_sole_looks_different(tab):
    tab.value("document.querySelector('[data-view=side]').click()")
    tab.settle()
    free = tab.picture("canvas")[0]
    tab.value("document.querySelector('[data-part=load]').click()")
    tab.settle()
    assert changed(free, tab.picture("canvas")[0]) > 1e-3
    tab.value("document.querySelector('[data-part=load]').click()")
    tab.settle()
    assert changed(free, tab.picture("canvas")[0]) == 0.0


def whole_result(result, tread=0.01):
    """A result of a whole sole whose file is gone: the computed part lies in a longer one."""
    fields = result.fields
    x, y = fields.x.values, fields.y.values
    side = x[1] - x[0]
    along = x[0] + side * np.arange(3 * x.size)
    height = np.full((along.size, y.size), tread)
    height[: x.size] = np.where(fields.inside, fields.clearance, np.nan)
    more = {
        "whole_clearance": (("whole_x", "whole_y"), height),
        "whole_pressed_height": (("whole_x", "whole_y"), height),
        "whole_land": (("whole_x", "whole_y"), np.isfinite(height)),
    }
    fields = fields.assign(more).assign_coords(whole_x=along, whole_y=y)
    gone = result.case_text + '\n[shoe.outsole]\nfile = "/nowhere/sole.stl"\n'
    return dataclasses.replace(result, data=from_xarray(fields), case_text=gone)


def test_a_whole_sole_is_drawn_with_its_computed_part(worn_shoe_result):
    part = viewer_scene([worn_shoe_result])["panes"][0]
    whole = viewer_scene([whole_result(worn_shoe_result)])["panes"][0]
    assert part["computed"] is None
    assert whole["nx"] > 2 * part["nx"]
    rows = whole["computed"][1] - whole["computed"][0]
    assert (
        rows
        == worn_shoe_result.fields.sizes["x"]
        - (np.nonzero(worn_shoe_result.fields.inside.values.any(axis=1))[0][0])
    )
    shape = (whole["nx"], whole["ny"])
    film = unpacked(whole["fields"]["film_thickness"], shape)
    assert np.isfinite(film).sum() == worn_shoe_result.fields.inside.values.sum()
    assert np.isnan(film[whole["computed"][1] :]).all()


@pytest.mark.browser
def test_outside_the_computed_part_nothing_is_claimed(worn_shoe_result, tmp_path):
    path = tmp_path / "whole.html"
    path.write_text(page_text(whole_result(worn_shoe_result), {}), encoding="utf-8")
    with opened(path, width=1366, height=768) as tab:
        note = tab.value("document.querySelector('[data-part=bar-note]').textContent")
        assert "outside the part that was computed" in note
        tab.value("document.querySelector('[data-view=below]').click()")
        x, y = centre(tab)
        tab.settle()
        tab.drag((x, y), (x, y))
        told = tab.value("document.querySelector('[data-part=values-table]').innerText")
        assert "not computed" in told
        before = tab.picture("canvas")[0]
        tab.value("document.querySelector('[data-view=part]').click()")
        tab.settle()
        assert colourful(tab.picture("canvas")[0]) > 2 * colourful(before)
        # the colour bar and the picture are seen at once
        top, low = tab.value(
            "[document.querySelector('.bar').getBoundingClientRect().top,"
            "document.querySelector('canvas').getBoundingClientRect().bottom]"
        )
        assert low - top < 768
        assert tab.complaints == []


@pytest.mark.browser
def test_on_a_telephone_it_fits_and_follows_two_fingers(page):
    with opened(page, width=390, height=844, touch=True, dark=True) as tab:
        assert tab.value("document.documentElement.scrollWidth") <= 390
        x, y = centre(tab)
        tab.settle()
        before, _ = tab.picture("canvas")
        assert before[5, 5].mean() < 0.3, "not dark"
        tab.touch(
            [(x - 30, y), (x + 30, y)], [(x - 45, y), (x + 45, y)], [(x - 70, y), (x + 70, y)]
        )
        assert changed(before, tab.picture("canvas")[0]) > 0.05
        tab.value("document.querySelector('.theme').click()")
        tab.settle()
        assert tab.picture("canvas")[0][5, 5].mean() > 0.7, "not light"
        small = tab.value(
            "[...document.querySelectorAll('button, .choice span, input[type=range]')]"
            ".filter((one) => one.offsetParent && one.getBoundingClientRect().height < 43.9)"
            ".map((one) => one.textContent || one.dataset.part)"
        )
        assert small == []
        # a thumb on the picture scrolls the page
        assert (
            tab.value("getComputedStyle(document.querySelector('canvas')).touchAction") == "pan-y"
        )
        assert tab.complaints == []


@pytest.mark.browser
def test_the_sole_is_printed_with_the_page(page):
    with opened(page) as tab:
        limit = "new Promise((done) => setTimeout(() => done(true), 2000))"
        tab.value(limit)  # pictures for the printer are made when the sole rests
        pdf = base64.b64decode(tab.call("Page.printToPDF", printBackground=True)["data"])
        size = tab.value("(() => { const c = document.querySelector('canvas'); return c.width })()")
        assert f"/Width {size}".encode() in pdf
        # what is folded on the screen is unfolded on paper
        assert tab.value("document.querySelectorAll('details').length") > 0
        assert tab.value("[...document.querySelectorAll('details')].every((one) => one.open)")
        tab.call("Emulation.setEmulatedMedia", media="print")
        tab.settle()
        assert tab.value("getComputedStyle(document.querySelector('canvas')).display") == "none"
        titles = "[...document.querySelectorAll('details.section > summary')]"
        assert tab.value(f"{titles}.every((one) => getComputedStyle(one).display !== 'none')")
        tab.value("document.querySelector('img.print').scrollIntoView()")
        tab.value("document.querySelector('img.print').decode().then(() => true)")
        tab.settle()
        assert colourful(tab.picture("img.print")[0]) > 0.03
        assert tab.complaints == []


@pytest.mark.browser
def test_a_history_can_be_walked_through(worn_shoe_result, tmp_path):
    fields = worn_shoe_result.fields.copy()
    times = fields.time.values
    fields = fields.assign_coords(time=times * 20.6 / times[-1])  # as of a film that stays late
    share = np.linspace(0.05, 1.0, fields.sizes["time"])
    frames = share[:, None, None] * fields.fluid_pressure.values
    fields["fluid_pressure_history"] = (("time", "x", "y"), frames, {"units": "Pa"})
    path = tmp_path / "history.html"
    result = dataclasses.replace(worn_shoe_result, data=from_xarray(fields))
    path.write_text(page_text(result, {}), encoding="utf-8")
    with opened(path) as tab:
        choose(tab, "Film thickness")
        assert tab.value("document.querySelector('[data-part=time-row]').hidden")
        choose(tab, "Fluid pressure")
        assert not tab.value("document.querySelector('[data-part=time-row]').hidden")
        centre(tab)
        tab.settle()
        last = tab.picture("canvas")[0]
        told = "document.querySelector('[data-part=time-value]').textContent"
        assert tab.value(told) == "20.6 s"
        tab.value(
            "(() => { const s = document.querySelector('[data-part=time]'); s.value = 0;"
            "s.dispatchEvent(new Event('input')) })()"
        )
        tab.settle()
        tab.settle()
        first = tab.picture("canvas")[0]
        assert changed(first, last) > 0.02
        at = display(float(fields.time[0]), "s")
        assert tab.value(told) == at
        # nothing of the end stands beside an earlier instant without a word
        tab.value("document.querySelector('canvas').dispatchEvent("
                  "new KeyboardEvent('keydown', {key: 'Enter'}))")  # fmt: skip
        tab.settle()
        place = tab.value("document.querySelector('[data-part=values-place]').textContent")
        assert place.endswith(f"; Fluid pressure after {at}, the rest at the end")
        note = "document.querySelector('[data-part=bar-note]').textContent"
        assert "in all" not in tab.value(note)
        choose(tab, "Film thickness")
        tab.settle()
        place = tab.value("document.querySelector('[data-part=values-place]').textContent")
        assert "after" not in place
        assert tab.complaints == []


def worn_series():
    """A heel in three states of wear, without the friction that a run would give."""
    heel = Heel(
        length=0.06, width=0.06, rear_radius=0.028, outsole_thickness=0.02,
        tread=Tread("grid", 9e-3, 5e-3, 3e-3),
    )  # fmt: skip
    depths = (0.0, 1e-3, 2e-3)
    soles = [heel.with_wear(WearPlane(depth) if depth else None) for depth in depths]
    failed = CaseOutcome(
        "", "", {"cof": SourcedValue(None, "1")}, {}, Status.NOT_CONVERGED, "", (), (), 0.0
    )
    points = tuple(WearPoint(wear_measures(sole), failed) for sole in soles)
    surfaces = tuple(heel_surface(sole, spacing=1e-3) for sole in soles)
    return WearSeries("heel", "plane", 5.0, points, {}, (), soles=surfaces), depths


def test_the_scene_of_wear_holds_what_each_state_has_lost():
    series, depths = worn_series()
    pane = wear_scene(series)["panes"][0]
    shape = (pane["nx"], pane["ny"])
    frames = [unpacked(each, shape) for each in pane["histories"]["lost"]["frames"]]
    assert np.isnan(frames[0]).all(), "new"
    for frame, depth in zip(frames[1:], depths[1:], strict=True):
        assert np.nanmax(frame) == pytest.approx(depth * 1e3, rel=0.05)
    first, last = (unpacked(pane["states"][k]["height"], shape) for k in (0, -1))
    assert np.nanmax(last - first) == pytest.approx(depths[-1], rel=0.05)
    assert pane["histories"]["lost"]["labels"][0].startswith("new")


def test_the_last_state_of_wear_is_the_sole_without_tread():
    series, _ = worn_series()
    bare = heel_surface(
        Heel(length=0.06, width=0.06, rear_radius=0.028, outsole_thickness=0.02), spacing=1e-3
    )
    without = {"untreaded": series.points[0].outcome, "soles": (*series.soles, bare)}
    pane = wear_scene(dataclasses.replace(series, **without))["panes"][0]
    labels = pane["histories"]["left"]["labels"]
    assert len(labels) == len(pane["states"]) == 4
    assert labels[-1].startswith("no tread at all")
    shape = (pane["nx"], pane["ny"])
    left = unpacked(pane["histories"]["left"]["frames"][-1], shape)
    assert np.nanmax(left) == 0.0


@pytest.mark.browser
def test_a_slider_wears_the_sole_down(tmp_path):
    path = tmp_path / "wear.html"
    sheets = ("style.css", "viewer.css")
    styles = "".join(environment().get_template(name).render() for name in sheets)
    path.write_text(
        f"<!doctype html><html><head><style>{styles}</style></head><body>"
        f"{scene_section(wear_scene(worn_series()[0]))}<script>{viewer_script()}</script>",
        encoding="utf-8",
    )
    with opened(path) as tab:
        centre(tab)
        tab.settle()
        new = tab.picture("canvas")[0]
        assert np.ptp(new) > 0.3, "no sole"
        assert colourful(new) == 0.0
        tab.value(
            "(() => { const s = document.querySelector('[data-part=time]'); s.value = s.max;"
            "s.dispatchEvent(new Event('input')) })()"
        )
        for _ in range(20):  # the last state is unpacked and meshed first
            tab.settle()
        assert colourful(tab.picture("canvas")[0]) > 0.005
        choose(tab, "Tread left")
        assert changed(new, tab.picture("canvas")[0]) > 0.01
        label = tab.value("document.querySelector('[data-part=time-value]').textContent")
        assert label.startswith("2 mm lost")
        assert tab.complaints == []


@pytest.mark.browser
def test_without_webgl_the_page_says_so(page, tmp_path):
    text = page.read_text().replace('getContext("webgl2"', 'getContext("none"')
    plain = tmp_path / "plain.html"
    plain.write_text(text)
    with opened(plain) as tab:
        said = tab.value("document.querySelector('[data-part=loading]').textContent")
        assert "can't be shown here" in said
        assert tab.value("document.querySelector('.body').hidden")


@pytest.mark.browser
def test_compared_soles_turn_together(worn_shoe_result, tmp_path):
    write_report(compare(worn_shoe_result, worn_shoe_result), tmp_path / "out")
    with opened(tmp_path / "out" / "report.html") as tab:
        assert tab.complaints == []
        x, y = centre(tab)
        tab.settle()
        second = functools.partial(tab.picture, ".stage:nth-child(2) canvas")
        before, _ = second()
        tab.drag((x, y), (x + 80, y))
        assert changed(before, second()[0]) > 0.01
        tab.value("document.querySelector('[data-view=below]').click()")
        tab.settle()
        one, two = tab.picture(".stage:nth-child(1) canvas")[0], second()[0]
        assert changed(one[80:], two[80:]) < 0.01


@pytest.mark.browser
def test_differences_to_the_first_sole(worn_shoe_result, tmp_path):
    doubled = worn_shoe_result.fields.assign(
        fluid_pressure=2 * worn_shoe_result.fields.fluid_pressure
    )
    other = dataclasses.replace(worn_shoe_result, name="other", data=from_xarray(doubled))
    path = tmp_path / "compared.html"
    path.write_text(page_text(compare(worn_shoe_result, other), {}), encoding="utf-8")
    with opened(path) as tab:
        tab.value("document.querySelector('[data-part=difference]').click()")
        tab.settle()
        first, second = (f".stage:nth-child({k}) canvas" for k in (1, 2))
        centre(tab)
        tab.settle()
        assert colourful(tab.picture(second)[0]) < 0.01, "contact is the same"
        choose(tab, "Fluid pressure")
        title = tab.value("document.querySelector('[data-part=bar-title]').textContent")
        assert "more than A" in title
        seen = tab.picture(second)[0]
        red = np.mean((seen[..., 0] > seen[..., 2] + 0.15) & (seen[..., 0] > 0.4))
        blue = np.mean((seen[..., 2] > seen[..., 0] + 0.15) & (seen[..., 2] > 0.4))
        assert red > 0.005 > blue
        assert colourful(tab.picture(first)[0]) < 0.01
        assert tab.complaints == []


@pytest.mark.browser
def test_twelve_soles_stand_in_even_rows(worn_shoe_result, tmp_path):
    path = tmp_path / "twelve.html"
    path.write_text(page_text(compare(*[worn_shoe_result] * 12), {}), encoding="utf-8")
    tops = "[...document.querySelectorAll('.stage')].map((s) => s.getBoundingClientRect().top)"
    with opened(path, width=1920, height=1080) as tab:
        rows = tab.value(tops)
        assert [rows.count(top) for top in sorted(set(rows))] == [6, 6]
        assert tab.value("document.documentElement.scrollWidth") <= 1920
        assert tab.complaints == []


def test_the_page_holds_the_fields_to_three_digits(worn_shoe_result):
    scene = viewer_scene([worn_shoe_result])
    pane = scene["panes"][0]
    fields = worn_shoe_result.fields
    film = unpacked(pane["fields"]["film_thickness"], (pane["nx"], pane["ny"]))
    i = int(np.argmin(np.abs(fields.x.values - pane["x0"])))
    j = int(np.argmin(np.abs(fields.y.values - pane["y0"])))
    own = fields.film_thickness.values[i : i + pane["nx"], j : j + pane["ny"]] * 1e6
    there = np.isfinite(film)
    assert there.sum() == fields.inside.values.sum()
    np.testing.assert_allclose(film[there], own[there], rtol=6e-4)


def test_differences_between_cases_are_listed_for_any_number(worn_shoe_case):
    thin = worn_shoe_case.replace("contaminant.viscosity", "41 cP")
    assert case_differences([worn_shoe_case, worn_shoe_case, thin]) == [
        ("contaminant.viscosity", "219 cP", "219 cP", "41 cP")
    ]


def test_the_colour_tables_are_those_of_matplotlib():
    for name, table in colour_tables().items():
        colours = matplotlib.colormaps[name](np.arange(256))[:, :3] * 255
        stored = np.frombuffer(base64.b64decode(table), np.uint8).reshape(256, 3)
        assert np.array_equal(stored, colours.round())


def test_the_word_at_the_toe_stays_whole_in_the_picture(page):
    """As far as one zooms in or out, in a narrow window too."""
    beyond = """(() => {
      const toe = document.querySelector(".toe"), range = document.createRange();
      range.selectNodeContents(toe);
      const text = range.getBoundingClientRect(), box = toe.parentElement.getBoundingClientRect();
      return Math.max(box.left - text.left, text.right - box.right, box.top - text.top,
        text.bottom - box.bottom);
    })()"""
    zoom = """(() => {
      const canvas = document.querySelector("canvas");
      canvas.focus();
      canvas.dispatchEvent(new WheelEvent("wheel", { deltaY: WAY, cancelable: true }));
    })()"""
    for width in (390, 1280):
        with opened(page, width=width) as session:
            assert session.value(beyond) <= 0.5
            for way in [-120] * 6 + [120] * 8:
                session.value(zoom.replace("WAY", str(way)))
                session.settle()
                assert session.value(beyond) <= 0.5
