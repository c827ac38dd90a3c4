"""Studies and comparisons in the app: what the pages ask, and both pages in a browser."""

import shutil
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

pytest.importorskip("nicegui")

from web_app import drawn, held, page_of, served

from underfoot.app import work_studies as work
from underfoot.app.pages.studies import FIELDS, KINDS, _fields, _value
from underfoot.app.project import Project
from underfoot.case import Case, CaseError, load
from underfoot.compute.run import run
from underfoot.core import InputError
from underfoot.core.progress import silent
from underfoot.report import write_report

EXAMPLES = Path(__file__).parents[2] / "examples"
STUDY = """\
base = "../variants/Heel.toml"  # the worn heel

[vary]
"motion.speed" = { from = "0.3 m/s", to = "0.7 m/s", steps = 2 }
"shoe.material.shore_a" = [55, 65]

[outputs]
maximise = ["cof"]
"""


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    """Return a project of two results and a study."""
    made = Project(tmp_path_factory.mktemp("app") / "project")
    base = load(EXAMPLES / "work_shoe_untreaded_glycerol.toml")
    grid = {"numerics.grid_spacing": "3 mm", "numerics.quick_grid_spacing": "3 mm"}
    grid["numerics.tread_positions"] = 1  # on grids as coarse slower is less film at one angle
    for name, speed in (("Heel", 0.5), ("Slow heel", 0.3)):
        case = base.replace({**grid, "motion.speed": speed, "name": name})
        made.add(name, case.to_toml())
        write_report(run(case, quick=True), made.result_folder(name))
    (made.folder / "studies" / "Speeds.toml").write_text(STUDY)
    return made


@pytest.mark.slow
def test_a_study_is_checked_run_shown_and_a_design_of_it_becomes_a_case(project):
    file = str(project.inside("studies", "Speeds.toml"))
    at = (file, file.removesuffix(".toml"))
    before = work.state(*at, progress=silent)
    assert (before["begun"], before["ended"]) == (False, 0)
    assert "4 designs: 4 cases" in before["headline"][0]
    work.computed(*at, progress=silent)
    after = work.state(*at, progress=silent)
    assert (after["begun"], after["ended"], after["open"]) == (True, 4, False)
    assert "parts" not in after | work.state(*at, 4, progress=silent)
    look = work.state(*at, 3, progress=silent)  # as while it runs
    assert 0 < look["seconds"] < 60
    plots, rest = look["parts"]
    assert 'class="study"' in plots
    assert "Left, at most about" in plots
    assert "a lucky run looks better than it is" in plots
    assert "Best designs, as run" in rest
    plots, rest = work.results(*at, progress=silent)
    assert 'class="study"' in plots
    assert "Best designs" in rest
    assert "<html" not in plots + rest
    made = work.design(*at, 3, progress=silent)
    case = Case.from_text(made["case"])
    assert (case.motion.speed, case.shoe.material.shore_a) == (0.7, 65)
    assert "viewer" in made["html"]
    work.stop(*at, progress=silent)
    assert (Path(at[1]) / "stop").exists()
    text = Path(file).read_text()
    Path(file).write_text(text.replace("0.7 m/s", "0.7 parsec"))
    with pytest.raises(CaseError, match="line 4"):
        work.state(*at, progress=silent)
    Path(file).write_text(text)


@pytest.mark.slow
def test_results_side_by_side_know_every_pair(project):
    folders = [str(project.result_folder(name)) for name in ("Heel", "Slow heel")]
    found = work.comparison(folders, progress=silent)
    assert found["letters"] == ["A", "B"]
    (none, ahead), (behind, also_none) = found["chances"]
    assert (none, also_none) == ("", "")
    shares = [float(text.split()[-2]) for text in (ahead, behind)]
    assert sum(shares) == pytest.approx(100, abs=1)
    file = project.inside("results", "Heel", "Heel.glb")
    assert "lengths in m" in work.exported(folders[0], str(file), progress=silent)
    assert file.read_bytes()[:4] == b"glTF"


NUMBERS = {
    "shoe.material.shore_a": st.integers(0, 99).map(str) | st.just("62.5"),
    "shoe.tread.depth": st.sampled_from(["1 mm", "2.5 mm", "0.2 cm"]),
    "contaminant.viscosity": st.sampled_from(["219 cP", "0.04 Pa*s"]),
}
"""Path: what a file says of it."""


@given(
    st.sampled_from(sorted(FIELDS)),
    st.sampled_from(sorted(KINDS)),
    st.sampled_from(sorted(NUMBERS)),
    st.booleans(),
    st.data(),
)
def test_a_row_of_the_form_says_what_the_file_says(section, kind, path, comma, data):
    """A form can show what it writes, in either language; what it can't show it says so."""
    number = NUMBERS[path]
    if section == "uncertain":
        second = NUMBERS["shoe.material.shore_a"] if kind == "lognormal" else number
        fields = {"kind": kind, "first": data.draw(number), "second": data.draw(second)}
    elif section == "vary" and data.draw(st.booleans()):
        ends = {key: data.draw(number) for key in ("from", "to")}
        fields = {**ends, "steps": data.draw(st.sampled_from(["", "5"])), "values": ""}
    else:
        values = "; ".join(data.draw(st.lists(number, min_size=1, max_size=3)))
        fields = dict.fromkeys(FIELDS[section], "") | {"values": values}
    assert _fields(section, _value(section, path, fields, comma=comma)) == fields


def test_what_no_row_can_say_is_left_alone():
    assert _fields("vary", {"times": 1.5, "of": "shoe.tread.depth"}) is None
    assert _fields("uncertain", "posterior.csv") is None
    assert (
        _value("vary", "shoe.tread.depth", {"from": "1 mm", "to": "", "steps": "", "values": ""})
        is None
    )


@pytest.mark.browser
@pytest.mark.slow
def test_the_studies_page_changes_the_file_runs_stops_and_goes_on(project, tmp_path):
    pytest.importorskip("playwright")
    hold = tmp_path / "hold"
    few = project.case("Heel").replace({**held(hold, free=6), "name": "Held"})
    project.add("Held", few.to_toml())
    file = project.inside("studies", "More.toml")
    file.write_text(STUDY.replace("steps = 2", "steps = 20").replace("Heel.toml", "Held.toml"))
    with served(project.folder, tmp_path) as app, page_of(app.link) as page:
        page.goto(app.base + "studies?study=More")
        page.get_by_text("40 designs: 40 cases").wait_for()
        steps = page.get_by_label("Steps").first
        steps.fill("15")
        steps.blur()
        page.get_by_text("30 designs: 30 cases").wait_for()
        assert "steps = 15" in file.read_text()
        assert "# the worn heel" in file.read_text()
        page.get_by_role("button", name="Compute", exact=True).click()
        page.wait_for_function("document.querySelectorAll('.study circle').length > 1")
        page.get_by_text("Left, at most about").wait_for()
        bar = page.locator(".task .q-linear-progress__model")
        assert bar.evaluate("(bar) => getComputedStyle(bar).transitionDuration") == "0s"
        page.get_by_role("button", name="Stop", exact=True).click()
        page.locator(".task").wait_for(state="detached")
        stopped = len(list(ended(project)))
        assert 2 <= stopped < 30
        shutil.rmtree(hold)
        page.get_by_role("button", name="Go on").click()
        page.get_by_role("button", name="Computed").wait_for()
        assert len(list(ended(project))) == 30
        assert len(set(ended(project))) == 30  # none was done twice
        page.locator(".study circle").first.dispatch_event("click")
        drawn(page)
        page.get_by_role("button", name="Make a variant of it").click()
        page.get_by_text("is a variant now").wait_for()
        assert len(project.variants()) == 4
        assert page.complaints == []


def ended(project):
    """Yield each line of a case that the study has finished."""
    for path in (project.folder / "studies" / "More").glob("cases-*.jsonl"):
        yield from path.read_text().splitlines()


@pytest.mark.parametrize("typed", ["1e400", "-1e400", "nan", "inf", "abc", "1 2", "3 mm"])
def test_what_is_no_number_is_refused_at_its_field(typed):
    asked = []

    def read(key, reader):
        asked.append(key)
        return reader(ends[key])

    ends = {"from": "1", "to": typed, "steps": ""}
    with pytest.raises(InputError):
        _value("vary", "shoe.material.shore_a", ends, read=read)
    assert asked == ["from", "to"]


@pytest.mark.browser
@pytest.mark.slow
def test_the_comparison_shows_soles_pairs_and_a_table_to_sort(project, tmp_path):
    pytest.importorskip("playwright")
    with served(project.folder, tmp_path) as app, page_of(app.link) as page:
        page.goto(app.base + "compare?variants=Heel|Slow heel")
        drawn(page)
        assert page.locator(".viewer canvas").count() >= 1
        first = page.locator(".q-table tbody tr").first
        assert "Heel" in first.inner_text()
        page.get_by_role("columnheader", name="Load on the fluid").click()
        first.get_by_text("Slow heel").wait_for()  # the smaller load comes first
        with page.expect_download() as kept:
            page.get_by_role("button", name="Table (CSV)").click()
        assert Path(kept.value.path()).read_text().startswith("variant,state,verdict")
        assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
        assert page.complaints == []
