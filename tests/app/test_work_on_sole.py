"""Work on the drawn sole: lugs and their drainage, places kept, a section, two soles by turns."""

import re
import time
from pathlib import Path

import numpy as np
import pytest
from chromium import PATIENCE, opened

from underfoot.case import Case
from underfoot.compute.run import run
from underfoot.questions.comparison import compare
from underfoot.report import page_text

pytestmark = [pytest.mark.browser, pytest.mark.slow]
CASE = Path(__file__).parents[2] / "examples" / "work_shoe_full_tread_glycerol.toml"
BOX = """(() => { const c = document.querySelector('%s');
c.scrollIntoView({block: 'center'}); const b = c.getBoundingClientRect();
return [b.left, b.top, b.width, b.height]; })()"""


@pytest.fixture(scope="module")
def treaded():
    return run(Case.load(CASE), quick=True)


@pytest.fixture
def tab(treaded, tmp_path):
    path = tmp_path / "report.html"
    path.write_text(page_text(treaded, {}), encoding="utf-8")
    with opened(path, width=1366, height=768) as session:
        session.value("document.querySelector('[data-view=below]').click()")
        session.settle()
        yield session
        assert session.complaints == []


def click(tab, x, y):
    for kind in ("mousePressed", "mouseReleased"):
        tab.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)
    tab.settle()


def click_at(tab, mark):
    """Click where an element is drawn on the sole."""
    left, top, *_ = tab.value(BOX % "canvas")
    x, y = map(float, tab.value(f"document.querySelector('{mark}').style.transform").split("(")[1]
               .removesuffix(")").replace("px", "").split(","))  # fmt: skip
    click(tab, left + x, top + y)


def escape(tab):
    """Press Escape on the sole: nothing is chosen any more."""
    tab.value("document.querySelector('canvas').dispatchEvent("
              "new KeyboardEvent('keydown', {key: 'Escape'}))")  # fmt: skip
    tab.settle()


def text(tab, part):
    return tab.value(f"document.querySelector('{part}').textContent")


def test_a_row_of_drainage_shows_its_lug_and_a_lug_its_row(tab, treaded):
    rows = tab.value("[...document.querySelectorAll('tr[data-lug]')].map((r) => r.innerText)")
    assert len(rows) == 6
    for number in (0, 3):
        tab.value(f"document.querySelectorAll('tr[data-lug]')[{number}].click()")
        tab.settle()
        x, y = (1e3 * float(treaded.data[f"lug_{axis}"].values[number]) for axis in "xy")
        place = re.findall(r"-?\d+\.\d", text(tab, "[data-part=values-place]"))
        np.testing.assert_allclose([float(v) for v in place], [x, y], atol=0.05)
        assert tab.value("document.querySelectorAll('.overlay .lug').length") >= 4
        assert tab.value("document.querySelectorAll('.overlay .groove').length") == 1
    mark = tab.value("document.querySelector('.mark').style.transform")
    chosen = "[...document.querySelectorAll('tr.chosen')].map((row) => row.dataset.lug)"
    escape(tab)
    assert tab.value(chosen) == []
    tab.value(f"document.querySelector('.mark').style.transform = '{mark}'")
    click_at(tab, ".mark")  # where the lug of row 3 was
    assert tab.value(chosen) == ["3"]
    assert tab.value("document.querySelectorAll('.overlay .lug').length") >= 4


def test_places_stay_and_follow_what_is_shown(tab, treaded):
    tab.value("document.querySelectorAll('tr[data-lug]')[0].click()")
    tab.settle()
    tab.value("document.querySelector('[data-part=keep]').click()")
    fields = treaded.data
    i, j = (
        int(np.argmin(np.abs(fields[axis].values - fields[f"lug_{axis}"].values[0])))
        for axis in "xy"
    )
    for title, name, factor in (
        ("Fluid pressure", "fluid_pressure", 1e3),
        ("Film thickness", "film_thickness", 1e-6),
    ):
        tab.value(f"[...document.querySelectorAll('.choice label')].find((each) => "
                  f"each.innerText === '{title}').click()")  # fmt: skip
        tab.settle()
        limit = time.monotonic() + PATIENCE
        while title not in text(tab, "[data-part=probes-head]"):
            assert time.monotonic() < limit
        value = float(tab.value("document.querySelector('[data-part=probes-rows] td:nth-child(3)')"
                                ".textContent.split(' ')[0]"))  # fmt: skip
        assert value == pytest.approx(float(fields[name].values[i, j]) / factor, rel=6e-3)
    escape(tab)
    assert tab.value("document.querySelectorAll('.overlay circle').length") == 1
    tab.value("document.querySelector('[data-part=probes-rows] button').click()")
    tab.settle()
    assert tab.value("document.querySelectorAll('.overlay circle').length") == 0


def test_a_section_shows_gap_film_and_pressures_along_its_line(tab, treaded):
    tab.value("document.querySelector('[data-part=section]').click()")
    left, top, wide, high = tab.value(BOX % "canvas")
    for share in (0.44, 0.56):
        click(tab, left + share * wide, top + 0.72 * high)
    limit = time.monotonic() + PATIENCE
    while tab.value("document.querySelectorAll('[data-section]').length") < 4:
        assert time.monotonic() < limit
    names = tab.value("[...document.querySelectorAll('[data-section]')].map((s) => "
                      "s.dataset.section)")  # fmt: skip
    assert set(names) == {"gap", "contact_pressure", "fluid_pressure", "film_thickness"}
    ends = [float(v) / 1e3 for v in
            re.findall(r"[xy] (-?\d+\.\d)", text(tab, "[data-part=profile-place]"))]  # fmt: skip
    fields = treaded.data
    x, y, pressure = fields["x"].values, fields["y"].values, fields["contact_pressure"].values
    line = np.linspace(ends[:2], ends[2:], 241)
    i, j = (np.abs(axis - each[:, None]).argmin(axis=1)
            for axis, each in zip((x, y), line.T, strict=True))  # fmt: skip
    along = pressure[i, j]
    contact = ("[...document.querySelectorAll('.profile h4')].find((each) => "
               "each.textContent.startsWith('Contact')).textContent")  # fmt: skip
    told = float(tab.value(contact).split()[-1])
    # between cells the line is lower than at their middles, by what a cell's row differs
    around = pressure[np.clip(i[:, None] + [-1, 0, 1], 0, len(x) - 1), j[:, None]]
    assert 0.5 * along.max() <= told * 1e3 <= 1.01 * around.max()
    drawn = tab.value("document.querySelector('[data-section=gap]').innerHTML")
    assert drawn.count("<polyline") >= 1


def test_two_soles_are_shown_by_turns_at_one_place(treaded, tmp_path):
    path = tmp_path / "compared.html"
    path.write_text(page_text(compare(treaded, treaded), {}), encoding="utf-8")
    shown = ("[...document.querySelectorAll('.stage')].map((stage) => "
             "getComputedStyle(stage).visibility)")  # fmt: skip
    with opened(path, width=1366, height=768) as tab:
        tab.value("document.querySelector('[data-part=blink]').click()")
        tab.settle()
        places = tab.value("[...document.querySelectorAll('.stage')].map((stage) => "
                           "stage.getBoundingClientRect().left)")  # fmt: skip
        assert places[0] == places[1]
        states, limit = set(), time.monotonic() + PATIENCE
        while len(states) < 2:
            states.add(tuple(tab.value(shown)))
            assert time.monotonic() < limit
        assert states == {("visible", "hidden"), ("hidden", "visible")}
        tab.value("document.querySelector('[data-part=blink]').click()")
        assert tab.value(shown) == ["visible", "visible"]
        assert tab.complaints == []
