"""The live page of a study: what it says of made-up cases, when it is written, how it is shown."""

import time
from pathlib import Path

import numpy as np
import pytest
from benchmarks.study_page import ROBUST, SWEEP, TEXT, made, record
from chromium import opened

from commands import called
from underfoot.core.progress import silent
from underfoot.explore import study as module
from underfoot.explore.result import front_places
from underfoot.explore.store import Store
from underfoot.explore.study import Stopped, Study
from underfoot.report import live_study as live

COUNT = 4000


@pytest.fixture(scope="module")
def sweep(tmp_path_factory):
    return made(tmp_path_factory.mktemp("sweep"), TEXT + SWEEP, COUNT)


@pytest.fixture(scope="module")
def robust(tmp_path_factory):
    text = (TEXT + ROBUST).replace("quantile(cof, 0.1) over conditions", "quantile(cof, 0.1)")
    return made(tmp_path_factory.mktemp("robust"), text, 640)


@pytest.mark.parametrize("name", ["sweep", "robust"])
def test_goals_as_run_are_those_of_the_records_read_whole(name, request):
    study = request.getfixturevalue(name)
    page, whole = live.live_study(study), study.result()
    read = {one.number: one for one in whole.designs}
    shown = page.designs
    assert len(shown) > 30
    same = [read[one.number] for one in shown]
    assert [one.ending for one in shown] == [one.ending for one in same]
    goals = page.plan.shown_goals
    np.testing.assert_allclose(page.values(shown, goals), whole.values(same, goals), rtol=1e-6)
    assert page.endings == whole.endings
    assert page.case_seconds == pytest.approx(sum(r.seconds for r in whole.records.values()))


def test_of_many_designs_the_front_is_that_of_all_and_the_page_says_what_it_drew(sweep):
    page, whole = live.live_study(sweep), sweep.result()
    values = whole.values(whole.designs, whole.plan.goals) * whole.plan.signs
    land = whole.values(whole.designs, [whole.plan.require[0].goal])[:, 0]
    with np.errstate(invalid="ignore"):
        good = np.isfinite(values).all(axis=1) & (land > 0.4)
    beaten = [((values[good] <= v).all(1) & (values[good] < v).any(1)).any() for v in values]
    front = np.flatnonzero(good & ~np.array(beaten))
    assert sorted(one.number for one in page.front) == front.tolist()
    assert len(page.designs) == live.MOST_SHOWN < len(page.ended_runs) == 0.9 * COUNT
    assert f"{live.MOST_SHOWN} of 3600 designs that ended are drawn: all {len(front)} of" in (
        page.drawn_text()
    )
    lost = [one for one in page.designs if not one.usable]
    assert 0.01 < len(lost) / len(page.designs) < 0.03  # one in fifty, as of all
    assert sum(int(line.split()[0]) for line in page.remarks()["Without numbers"]) == 72


def test_no_row_of_a_front_is_beaten_and_every_other_is():
    generator = np.random.default_rng(1)
    for size in (1, 2, 3):
        values = generator.integers(0, 6, (200, size)).astype(float)
        values[3] = np.nan
        allowed = generator.random(200) < 0.8
        front = front_places(values, allowed)
        assert allowed[front].all()
        assert len({tuple(row) for row in values[front]}) == len(front)
        assert (np.diff(values[front, 0]) >= 0).all()
        good = values[allowed & np.isfinite(values).all(axis=1)]
        for row in good:
            beaten = ((good <= row).all(axis=1) & (good < row).any(axis=1)).any()
            assert beaten != (values[front] == row).all(axis=1).any()


def test_pages_take_their_share_of_the_time_at_most(sweep, monkeypatch):
    """Looks are a second apart; a page takes 0.5 s, so that one comes every 50 s."""
    clock, written = [0.0, 0.0], []
    monkeypatch.setattr(time, "monotonic", lambda: clock[0])
    monkeypatch.setattr(time, "process_time", lambda: clock[1])
    monkeypatch.setattr(live, "_fresh", lambda path: False)

    def write(study):
        clock[1] += 0.5
        written.append(clock[0])

    monkeypatch.setattr(live, "write_live_page", write)
    with live.with_live_page(sweep, silent, 1) as told:
        for second in range(1, 401):
            clock[0] = float(second)
            told("Cases", 0.5)
    assert written[0] <= 40
    assert len(written) >= 6
    for count, moment in enumerate(written[1:], start=2):
        assert 0.5 * count <= live.SHARE * moment + 1e-9


def test_a_page_that_could_not_be_written_whole_leaves_the_one_before(robust, monkeypatch):
    folder, real = robust.store.folder, Path.write_text
    live.write_live_page(robust)
    before = (folder / live.PAGE).read_bytes()

    def half(path, text, **options):
        real(path, text[: len(text) // 2], **options)
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_text", half)
    with pytest.raises(OSError, match="No space"):
        live.write_live_page(robust)
    assert (folder / live.PAGE).read_bytes() == before
    assert not list(folder.glob(".live*"))


def test_a_full_disk_or_a_damaged_case_costs_the_page_and_not_the_study(sweep, monkeypatch):
    def write(study):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(live, "write_live_page", write)
    writer = live._Writer(sweep, 1)
    writer.write()
    assert not (sweep.store.folder / live.PAGE).exists()


def test_a_stopped_study_takes_no_further_case_and_goes_on_when_it_is_run(robust, monkeypatch):
    study, count = Study(robust.plan, robust.store.folder), []

    def computed(base, job):
        count.append(job)
        if len(count) == 3:
            Store(study.store.folder).stop()
        monkeypatch.setattr(module, "PAUSE", -1.0)  # every look is due
        return record(job, 1)

    monkeypatch.setattr(module, "compute_job", computed)
    before = len(study.store.records())
    with pytest.raises(Stopped, match=r"every finished case is kept.*underfoot study run goes on"):
        study.run(workers=1)
    assert len(count) == 3
    assert len(Store(study.store.folder).records()) == before + 3
    with pytest.raises(Stopped):
        Study(robust.plan, study.store.folder).work()
    assert len(count) == 3
    said = called("study", "stop", study.store.folder).stdout
    assert "nobody works" in said


@pytest.mark.browser
@pytest.mark.parametrize(("width", "touch"), [(1366, False), (390, True)])
def test_the_page_shows_front_failures_cost_and_commands_and_keeps_what_was_chosen(
    sweep, width, touch
):
    store = Store(sweep.store.folder)
    with store.working(2):  # somebody works on it
        live.write_live_page(sweep)
    page = sweep.store.folder / live.PAGE
    with opened(page, width=width, height=768, touch=touch) as session:
        assert session.value("document.querySelector('.study circle').checkVisibility()")
        session.value("document.querySelectorAll('details').forEach((d) => { d.open = true })")
        words = session.value("document.body.innerText")
        for part in ("3600 of 4000 cases ended", "2 workers at work", "Processor", "lugs overlap"):
            assert part in words
        assert f'underfoot study stop "{sweep.store.folder}"' in words
        assert "Raise budget = 4000" in words
        assert session.value("document.querySelectorAll('.study circle').length") > 900
        assert session.value("document.querySelectorAll('.study polyline.lost').length") > 10
        session.value(
            "(() => { const s = document.querySelector('[data-part=across]'); s.value = 0;"
            "s.dispatchEvent(new Event('change'));"
            "document.querySelector('circle[data-number]').dispatchEvent(new Event('click'));"
            "return true })()"
        )
        chosen = session.value("document.querySelector('[data-part=title]').textContent")
        session.go(page)
        assert session.value("document.querySelector('[data-part=across]').value") == "0"
        assert session.value("document.querySelector('[data-part=title]').textContent") == chosen
        assert session.value("document.querySelector('p.live input').checked")
        assert session.value("document.documentElement.scrollWidth <= innerWidth")
        assert session.complaints == []
