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

from underfoot.core.fields import from_xarray
from underfoot.questions.comparison import case_differences, compare
from underfoot.report import page_text, write_report
from underfoot.report.viewer import colour_tables, unpacked, viewer_scene


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
    assert titles[:5] == [
        "Contact pressure", "Fluid pressure", "Film thickness", "Load carried by fluid",
        "Local shear",
    ]  # fmt: skip
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
        assert tab.complaints == []


@pytest.mark.browser
def test_the_sole_is_printed_with_the_page(page):
    with opened(page) as tab:
        tab.value("dispatchEvent(new Event('beforeprint'))")
        tab.call("Emulation.setEmulatedMedia", media="print")
        tab.settle()
        assert tab.value("getComputedStyle(document.querySelector('canvas')).display") == "none"
        tab.value("document.querySelector('img.print').scrollIntoView()")
        tab.value("document.querySelector('img.print').decode().then(() => true)")
        tab.settle()
        assert colourful(tab.picture("img.print")[0]) > 0.05
        assert tab.complaints == []


@pytest.mark.browser
def test_a_history_can_be_walked_through(worn_shoe_result, tmp_path):
    fields = worn_shoe_result.fields.copy()
    share = np.linspace(0.05, 1.0, fields.sizes["time"])
    frames = share[:, None, None] * fields.fluid_pressure.values
    fields["fluid_pressure_history"] = (("time", "x", "y"), frames, {"units": "Pa"})
    path = tmp_path / "history.html"
    result = dataclasses.replace(worn_shoe_result, data=from_xarray(fields))
    path.write_text(page_text(result, {}), encoding="utf-8")
    with opened(path) as tab:
        assert tab.value("document.querySelector('[data-part=time-row]').hidden")
        choose(tab, "Fluid pressure")
        assert not tab.value("document.querySelector('[data-part=time-row]').hidden")
        centre(tab)
        tab.settle()
        last = tab.picture("canvas")[0]
        tab.value(
            "(() => { const s = document.querySelector('[data-part=time]'); s.value = 0;"
            "s.dispatchEvent(new Event('input')) })()"
        )
        tab.settle()
        tab.settle()
        first = tab.picture("canvas")[0]
        assert changed(first, last) > 0.02
        at = f"{float(fields.time[0]) * 1e3:.3g} ms"
        assert tab.value("document.querySelector('[data-part=time-value]').textContent") == at
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
