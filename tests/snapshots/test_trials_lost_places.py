"""Places that cameras lost, at random: held, coded, straight and far, and how they are told."""

import json
import shutil
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import trial_studies as made
from recording_texts import TEXTS, read_lines
from snapshot import held
from underfoot.trials.pages import court_bundle
from underfoot.trials.readers.seen import coded_forces, unseen
from underfoot.trials.recording.plates import ordered_corners
from underfoot.trials.study import condition_table, folder


def path(seed: int) -> np.ndarray:
    """Return a marker's path at 100 Hz with some of its frames not seen."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(90, 260))
    time = np.arange(count) / 100.0
    way = np.column_stack([
        0.9 * time, 0.05 * np.sin(7 * time + seed), 0.1 + 0.06 * np.cos(rng.choice([5, 11]) * time)
    ])  # fmt: skip
    way += rng.choice([0.0, 2e-5, 5e-4]) * rng.normal(size=way.shape)
    if seed % 3 == 0:
        way = np.round(way, int(rng.choice([3, 4])))
    first, long = int(rng.integers(10, 40)), int(rng.integers(2, 40))
    lost = slice(first, first + long)
    kind = seed % 7
    if kind == 1:
        way[lost] = way[first]
    elif kind == 2:
        ends = way[first - 1], way[first + long]
        share = (np.arange(long) + 1)[:, None] / (long + 1)
        way[lost] = ends[0] + share * (ends[1] - ends[0])
    elif kind == 3:
        way[lost] = rng.choice([0.0, 999.0, -9999.0, 5.0])
    elif kind == 4:
        way[lost, 0] = -way[lost, 0] * 50
    elif kind == 5:
        way[lost] = way[first]
        way[first + 50 : first + 60] = way[first + 50]
    elif kind == 6:
        way[lost] = np.nan
        way[first + 45 : first + 49] = 0.0
    return way


def test_frames_that_were_not_seen(file_regression):
    told = {}
    for seed in range(42):
        for every in (False, True):
            found = unseen(path(seed), every_repeat=every)
            told[f"{seed} {every}"] = {
                kind: f"{mask.sum()}: {np.flatnonzero(mask)[[0, -1]] if mask.any() else ''}"
                for kind, mask in found.items()
            }
    for seed in range(12):
        rng = np.random.default_rng(seed)
        force = rng.normal(size=(80, 3)) * [30, 30, 300]
        at = slice(int(rng.integers(5, 40)), 40 + seed)
        force[at] = rng.choice([0.0, 1e5, -9999.0, 2e3])
        told[f"force {seed}"] = np.flatnonzero(coded_forces(force))
    held(file_regression, told)


@pytest.mark.parametrize(("count", "said"), [(6, ""), (7, "and 1 more markers"), (9, "and 3 more")])
def test_six_markers_that_were_not_seen_are_named(count, said, tmp_path):
    time = np.arange(60) / 100.0
    names = [f"M{k}" for k in range(count)]
    heads = ",".join(f"{name}_{axis} (m)" for name in names for axis in "xyz")
    rows = [f"time (s),{heads}"]
    for k, t in enumerate(time):
        places = [
            (9999.0,) * 3 if 20 <= k < 30 else (0.7 * t + 0.1 * n, 0.05 * np.sin(9 * t + n), 0.2)
            for n in range(count)
        ]
        rows.append(f"{t:.2f}," + ",".join(f"{v:.4f}" for place in places for v in place))
    lines = read_lines(tmp_path, "m.csv", "\n".join(rows))
    (note,) = (text for text in lines.values() if "taken as not seen" in text)
    assert ("more markers" in note) == bool(said)
    assert said in note
    assert note.count("10 frames") == min(count, 6)


def test_an_older_take_has_an_empty_line_above_its_names(tmp_path):
    """What leaves the heads of rows empty names its markers below the kinds, empty lines or not."""
    text = TEXTS["take.csv"]()
    whole = read_lines(tmp_path, "take.csv", text)
    older = [line.replace(",Name", ",").replace(",Type", ",") for line in text.split("\n")]
    assert "refused" not in whole
    for k in range(1, 4):
        assert read_lines(tmp_path, "take.csv", "\n".join([*older[:k], "", *older[k:]])) == whole


def test_a_bundle_holds_the_catalogues_of_its_user(tmp_path, monkeypatch):
    source, out = tmp_path / "in", tmp_path / "out"
    own, more = tmp_path / "own", tmp_path / "more"
    for where, names in ((source, ("a.csv", ".hidden")), (own, ("a.toml", "note.txt")),
                         (more, ("b.toml",))):  # fmt: skip
        where.mkdir()
        for name in names:
            (where / name).write_text(name, encoding="utf-8")
    (tmp_path / "empty").mkdir()

    def report(analysis, where, *, processes, progress):
        (where / court_bundle.STORE).mkdir(parents=True)
        (where / "page.html").write_text("page", encoding="utf-8")

    monkeypatch.setattr(court_bundle, "write_trials_report", report)
    monkeypatch.setattr(court_bundle, "audit_page", lambda analysis, sums: f"signed for {sums}")
    page = court_bundle.write_bundle(
        SimpleNamespace(), source, out, {"protocol": "p", "method": {}, "options": {}},
        [own, tmp_path / "empty", more],
    )  # fmt: skip
    inside = sorted(p.relative_to(out).as_posix() for p in out.rglob("*") if p.is_file())
    assert inside == ["SHA256SUMS", "audit.html", "bundle.json", "catalogue/a.toml",
                      "catalogue/b.toml", "recordings/a.csv", "report/page.html"]  # fmt: skip
    assert page == out / "audit.html"
    sums = dict(reversed(line.split("  ")) for line in
                (out / "SHA256SUMS").read_text().splitlines())  # fmt: skip
    assert sorted(sums) == inside[2:]
    settings = json.loads((out / "bundle.json").read_text())
    assert set(settings) == {"protocol", "method", "options", "versions", "page"}
    assert court_bundle.changed_files(out) == []
    (out / "recordings" / "a.csv").write_text("b.csv", encoding="utf-8")
    (out / "catalogue" / "b.toml").unlink()
    (out / "new.txt").write_text("x", encoding="utf-8")
    told = [str(one) for one in court_bundle.changed_files(out)]
    assert told == ["catalogue/b.toml: missing", "new.txt: not in SHA256SUMS",
                    "recordings/a.csv: changed"]  # fmt: skip
    shutil.rmtree(out)


def test_corners_on_a_line_stay_as_they_are():
    line = np.outer([0.0, 3.0, 1.0, 2.0], [1.0, 0.0, 0.0])
    found, crossed = ordered_corners(line)
    assert not crossed
    np.testing.assert_array_equal(found, line)
    square = np.array([[0.0, 0, 0], [1, 1, 0], [1, 0, 0], [0, 1, 0]])
    for down in (True, False):
        found, crossed = ordered_corners(square, down=down)
        assert crossed
        sides = np.linalg.norm(np.diff(np.vstack([found, found[:1]]), axis=0), axis=1)
        assert sides == pytest.approx(np.ones(4))


def test_what_is_a_unit_and_what_a_word():
    assert [condition_table._is_si(unit) for unit in ("cm", "kPa", "1", "hall", "%")] == [
        True, True, False, False, False]  # fmt: skip


def test_a_file_that_is_gone_is_refused(tmp_path):
    job: Any = ("gone.csv", [tmp_path / "gone.csv"], {"shoe": "a"}, (), None, None, "base", None)
    (one,) = folder._job(job)
    assert (one.file, one.verdict, one.conditions) == ("gone.csv", "refused", {"shoe": "a"})
    assert "can't be read" in one.reasons[0]
    (dead,) = folder._death_result(job)
    assert (dead.file, dead.checksum, dead.verdict) == ("gone.csv", "", "refused")
    assert made.refused_file().verdict == "refused"
