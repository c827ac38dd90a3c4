"""Errors, values, status, validity, cache and whole folders."""

from importlib import import_module

import numpy as np
import pytest

from underfoot.core import (
    Breach,
    Cache,
    ConvergenceError,
    DataError,
    InputError,
    MissingExtraError,
    RangeError,
    SourcedValue,
    Status,
    ValidityRange,
    breaches,
    content_hash,
    unknown_name,
)
from underfoot.core.errors import Cancelled
from underfoot.core.files import whole_folder
from underfoot.core.provenance import Provenance
from underfoot.core.status import worst
from underfoot.trials import Belt, Ramp
from underfoot.trials.recording.measurement import caution


def test_an_error_says_where_what_allowed_nearest_and_remedy():
    error = InputError("a", where="b", allowed="c", nearest="d", remedy="e")
    assert str(error) == 'b: a. Allowed: c. Did you mean "d"? e.'


def test_an_unknown_name_lists_what_is_known():
    error = unknown_name("fluid", "glycerin_50", ["glycerol_50pct", "water"], where="contaminant")
    assert error.nearest == "glycerol_50pct"
    assert "water" in str(error)


def test_an_unknown_uncertainty_is_never_zero():
    value = SourcedValue(2.0, "N")
    assert (value.assumed, value.uncertainty, value.interval) == (False, None, None)
    assert value.uncertainty is None
    assert value.reason
    assert "not estimated" in str(SourcedValue(None, "N", reason="two repeats"))
    with pytest.raises(ValueError, match="negative"):
        SourcedValue(1.0, uncertainty=-1.0)


def test_a_provenance_holds_what_made_a_result_and_of_an_old_one_nothing_that_nobody_recorded():
    old, new = Provenance("abc"), Provenance.now("abc", grid=1e-3, closures={"film": "own"})
    absent = {name for name, value in old.to_dict().items() if not value}
    assert absent == old.to_dict().keys() - {"case_hash"}
    known = {name for name, value in new.to_dict().items() if value}
    assert known == {"case_hash", "closures", "versions", "created", "result_hash", "threads"}
    assert new.threads >= 1
    finer = Provenance.now("abc", grid=0.5e-3, closures={"film": "own"})
    assert finer.result_hash != new.result_hash


def test_every_status_but_success_has_a_remedy():
    assert all(status.remedy or status is Status.CONVERGED for status in Status)
    assert worst(Status.CONVERGED, Status.NOT_CONVERGED, Status.OUT_OF_RANGE) == "not converged"
    assert not Status.NOT_CONVERGED.usable


def test_breaches_name_the_quantity_and_the_tested_range():
    ranges = {"speed": ValidityRange(0.01, 1.0, "m/s", "paper")}
    assert breaches("law", ranges, {"speed": [0.01, 1.0]}) == []
    (found,) = breaches("law", ranges, {"speed": np.array([0.5, 3.0])})
    assert isinstance(found, Breach)
    assert "law: speed 0.5 m/s to 3 m/s is outside the tested range 0.01 m/s" in str(found)


def test_an_open_range_is_left_at_its_closed_end_only():
    cells = {"cells": ValidityRange(4.0, float("inf"))}
    assert breaches("grid", cells, {"cells": 1e9}) == []
    (found,) = breaches("grid", cells, {"cells": 2.4})
    assert "4 or more" in str(found)


def test_the_hash_follows_content_not_identity():
    array = np.arange(6.0).reshape(2, 3)
    assert content_hash({"a": 1, "b": array}) == content_hash({"b": array.copy(), "a": 1})
    assert content_hash(array) != content_hash(array.T)
    assert content_hash(1) != content_hash(1.0)
    assert content_hash(["ab"]) != content_hash(["a", "b"])


def test_the_cache_returns_what_was_stored_and_survives_damage(tmp_path):
    cache = Cache("room-1", tmp_path)
    assert cache.load("k") is None
    cache.store("k", {"x": np.eye(3)})
    loaded = cache.load("k")
    assert loaded is not None
    assert np.array_equal(loaded["x"], np.eye(3))
    (entry,) = (tmp_path / "room-1").rglob("k.npz")
    entry.write_bytes(entry.read_bytes()[:40])
    assert cache.load("k") is None
    assert not entry.exists()


def interrupted(target):
    with whole_folder(target) as folder:
        (folder / "half").write_text("x")
        raise KeyboardInterrupt


def test_a_folder_is_whole_or_absent(tmp_path):
    target = tmp_path / "out"
    with pytest.raises(KeyboardInterrupt):
        interrupted(target)
    assert list(tmp_path.iterdir()) == []
    with whole_folder(target) as folder:
        (folder / "a").write_text("1")
    with pytest.raises(InputError, match="not empty"), whole_folder(target):
        pass
    with pytest.raises(ValueError, match="boom"), whole_folder(target, overwrite=True):
        raise ValueError("boom")
    assert (target / "a").read_text() == "1"
    with whole_folder(target, overwrite=True) as folder:
        (folder / "b").write_text("2")
    assert sorted(path.name for path in target.iterdir()) == [".underfoot", "b"]
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


def test_a_folder_of_others_is_never_replaced(tmp_path):
    target = tmp_path / "mine"
    target.mkdir()
    (target / "keep.txt").write_text("keep")
    with pytest.raises(InputError, match="not made by underfoot and holds keep"):
        with_content(target)
    assert (target / "keep.txt").read_text() == "keep"


def with_content(target):
    with whole_folder(target, overwrite=True) as folder:
        (folder / "a").write_text("1")


def test_a_link_to_a_folder_is_followed(tmp_path):
    real, link = tmp_path / "real", tmp_path / "link"
    with_content(real)
    link.symlink_to(real)
    with_content(link)
    assert link.is_symlink()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["link", "real"]


def test_an_old_name_answers_and_warns_at_the_line_that_calls():
    belt = Belt(np.zeros(1), np.array([[1.25, 0.0, 0.0]]), "foot markers", 0.01)
    with pytest.warns(FutureWarning, match=r"Belt.words is speed_text now.* in 0.4") as told:
        assert belt.words(0.0) == belt.speed_text(0.0)
    assert told[0].filename == __file__


def test_old_names_of_a_field_a_property_and_a_method_answer():
    belt = Belt(np.zeros(1), np.array([[1.25, 0.0, 0.0]]), "foot markers", 0.01)
    for old, new in (
        (lambda: caution("noise").words, "noise"),
        (lambda: Ramp().words, "level"),
        (lambda: belt.words(0.0), belt.speed_text(0.0)),
    ):
        with pytest.warns(FutureWarning, match=r"\.words is .* now; the old name goes in 0.4"):
            assert old() == new


@pytest.mark.parametrize(
    ("package", "old", "new"),
    [
        ("core", "Range", "ValidityRange"),
        ("core.page", "Section", "PageSection"),
        ("trials.readers.draft", "Draft", "RecordingDraft"),
        ("calibrate", "calibrated", "calibrate_model"),
        ("friction", "propagated", "propagate_spread"),
        ("material", "reduced", "reduce_spectrum"),
        ("shoe", "Profile", "HeelProfile"),
        ("slip.dynamics", "judged", "judge_slip"),
        ("surface", "squared", "square_cells"),
        ("studies", "StudyResult", "PublishedStudyResult"),
        ("trials", "Profile", "TrialsProfile"),
        ("trials.readers", "Draft", "RecordingDraft"),
        ("trials.statistics", "Pair", "LevelPair"),
        ("trials.study", "Table", "TrialTable"),
    ],
)
def test_an_old_name_of_a_package_answers_and_warns(package, old, new):
    room = import_module(f"underfoot.{package}")
    with pytest.warns(FutureWarning, match=rf"{package}\.{old} is {new} now.* in 0.5") as told:
        assert getattr(room, old) is getattr(room, new)
    assert told[0].filename == __file__
    with pytest.raises(AttributeError, match="has no attribute 'NoClass'"):
        getattr(room, "NoClass")  # noqa: B009 - the error is what is asked for


def test_each_kind_of_error_ends_a_command_with_its_own_code():
    codes = {
        InputError("a"): 2, RangeError("a"): 2, DataError("a"): 3, ConvergenceError("a"): 4,
        MissingExtraError("a", "b", "c"): 5, Cancelled("a"): 130,
    }  # fmt: skip
    assert [error.exit_code for error in codes] == list(codes.values())
