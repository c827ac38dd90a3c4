"""A project as a folder of files: states, names, what other programs do to it."""

import json
from zipfile import ZipFile

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

pytest.importorskip("nicegui")

from underfoot.app.project import Project
from underfoot.app.variant_bar import USUAL
from underfoot.app.work import zipped
from underfoot.case import Case, CaseError
from underfoot.case.template import template
from underfoot.core import InputError
from underfoot.core.catalogue import Catalogue

TEXT = template(**USUAL, catalogue=Catalogue.load(), name="one")


@pytest.fixture
def project(tmp_path):
    made = Project(tmp_path / "p")
    made.add("one", TEXT)
    return made


def speed(project, name="one"):
    return Case.load(project.path(name)).motion.speed


def test_states_go_back_and_forward_over_a_restart(project):
    project.change("one", {"motion.speed": "0.5 m/s"})
    project.change("one", {"motion.speed": "0.3 m/s"})
    project.undo("one")
    assert speed(project) == 0.5
    again = Project(project.folder)
    assert again.can_undo("one")
    assert again.can_redo("one")
    again.redo("one")
    assert speed(again) == 0.3
    again.undo("one")
    again.undo("one")
    assert speed(again) == 0.7
    assert not again.can_undo("one")
    again.change("one", {"motion.speed": "0.4 m/s"})
    assert not again.can_redo("one"), "a new state ends what was undone"


@settings(max_examples=25, deadline=None)
@given(st.lists(st.sampled_from(["change", "undo", "redo"]), max_size=12))
def test_undo_and_redo_walk_one_line_of_states(tmp_path_factory, moves):
    project = Project(tmp_path_factory.mktemp("p"))
    project.add("one", TEXT)
    states, at = [TEXT], 0
    for number, move in enumerate(moves):
        if move == "change":
            project.change("one", {"motion.speed": f"{0.1 + number / 100:.2f} m/s"})
            states, at = [*states[: at + 1], project.text("one")], at + 1
        elif move == "undo":
            project.undo("one")
            at = max(at - 1, 0)
        else:
            project.redo("one")
            at = min(at + 1, len(states) - 1)
        assert project.text("one") == states[at]
    assert Project(project.folder).text("one") == states[at]


def test_what_another_program_writes_is_a_state(project):
    other = project.text("one").replace('# speed = "0.7 m/s"', 'speed = "0.2 m/s"')
    project.path("one").write_text(other)
    project.change("one", {"motion.normal_force": "400 N"})
    project.undo("one")
    assert project.text("one") == other


def test_a_refused_change_leaves_the_file(project):
    before = project.text("one")
    with pytest.raises(CaseError, match=r"motion\.speed"):
        project.change("one", {"motion.speed": "5 kg"})
    assert project.text("one") == before


def test_removed_variants_come_back(project):
    project.change("one", {"motion.speed": "0.5 m/s"})
    project.remove("one")
    assert project.variants() == []
    again = Project(project.folder)
    assert again.removed_variants() == ["one"]
    again.restore("one")
    assert speed(again) == 0.5


def test_copies_and_new_names(project):
    second = project.copy("one", "one", {"shoe.wear.depth": "1 mm"})
    assert second == "one 2"
    assert project.case(second).name == "one 2"
    assert project.rename(second, "worn") == "worn"
    assert set(project.variants()) == {"one", "worn"}
    with pytest.raises(InputError, match="exists"):
        project.rename("worn", "one")


@pytest.mark.parametrize("name", ["../x", "", ".hidden", "a/b", "a\\b", "x" * 61, "con\n", "a."])
def test_names_that_are_no_files_are_refused(project, name):
    with pytest.raises(InputError, match="is no name"):
        project.add(name, TEXT)


def test_paths_stay_inside(project):
    with pytest.raises(InputError, match="outside the project"):
        project.inside("soles", "..", "..", "etc")


def test_a_line_cut_short_by_a_power_cut_is_left_out(project):
    project.change("one", {"motion.speed": "0.5 m/s"})
    with (project.folder / "history.jsonl").open("a") as stream:
        stream.write('{"variant": "one", "acti')
    again = Project(project.folder)
    again.change("one", {"motion.speed": "0.4 m/s"})
    last = (project.folder / "history.jsonl").read_text().splitlines()[-1]
    assert json.loads(last)["action"] == "set"
    again.undo("one")
    assert speed(again) == 0.5


def test_a_variant_of_another_program_is_shown_where_nothing_can_be_written(project):
    history = project.folder / "history.jsonl"
    kept = history.read_text()
    history.unlink()
    history.mkdir()  # as on a disk that is full or read only
    project.path("two").write_text(TEXT)
    assert not project.can_undo("two")
    with pytest.raises(OSError, match=r"history\.jsonl"):
        project.change("two", {"motion.speed": "0.5 m/s"})
    assert project.text("two") == TEXT
    history.rmdir()
    history.write_text(kept)
    project.change("two", {"motion.speed": "0.5 m/s"})
    assert Project(project.folder).can_undo("two")


def test_a_file_is_no_project(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="can't be used as a project"):
        Project(tmp_path / "file")


def test_damaged_results_are_none(project):
    folder = project.result_folder("one")
    folder.mkdir()
    (folder / "result.json").write_text("{")
    assert project.summary("one") is None
    assert project.results() == []


def test_lines_of_other_programs_in_the_history_are_left_out(project):
    history = project.folder / "history.jsonl"
    foreign = ['{"a": 1}', '{"variant": 3, "action": "set"}', '{"variant": "one"}', "[]", "7"]
    odd = ['{"variant": "one", "action": "set", "text": 5}', '{"variant": "new", "action": "undo"}']
    history.write_text("\n".join([*foreign, history.read_text(), *odd, ""]))
    again = Project(project.folder)
    assert again.variants() == project.variants()
    assert again.removed_variants() == []
    assert again.text("one") == project.text("one")


@pytest.mark.parametrize("action", ["undo", "redo"])
def test_steps_beyond_the_ends_of_a_history_stop_there(project, action):
    """Two branches merged may hold more steps back or forward than there are states."""
    project.change("one", {"motion.speed": "0.5 m/s"})
    with (project.folder / "history.jsonl").open("a") as stream:
        stream.write(3 * (json.dumps({"variant": "one", "action": action}) + "\n"))
    if action == "undo":
        project.path("one").write_text(TEXT)
    again = Project(project.folder)
    assert (again.can_undo("one"), again.can_redo("one")) == (action == "redo", action == "undo")
    (again.redo if action == "undo" else again.undo)("one")
    assert speed(again) == (0.5 if action == "undo" else 0.7)


def test_a_result_is_of_the_inputs_that_it_was_computed_from(project):
    folder = project.result_folder("one")
    folder.mkdir()
    stored = {
        "cof": {"value": 0.2, "interval": [0.1, 0.3]},
        "status": {"value": "converged"},
        "provenance": {"case_hash": project.case("one").hash, "created": "2026-01-01"},
    }
    (folder / "result.json").write_text(json.dumps(stored))
    assert project.is_current("one")
    before = project.state("one")
    project.change("one", {"motion.speed": "0.6 m/s"})
    assert not project.is_current("one")
    assert project.state("one") != before
    project.undo("one")
    assert project.is_current("one")
    assert project.state("one") == before
    project.remove("one")
    assert not project.is_current("one")
    assert project.state("one")[0] is None


def test_a_project_as_a_zip_is_a_project(tmp_path):
    project = Project(tmp_path / "mine")
    project.add("shoe", TEXT)
    (project.folder / "results" / ".tried").mkdir()
    (project.folder / "results" / ".tried" / "x.txt").write_text("x")
    file = zipped(str(project.folder), progress=lambda *_: None)
    with ZipFile(file) as archive:
        assert not any("tried" in name for name in archive.namelist())
        archive.extractall(tmp_path / "elsewhere")
    assert Project(tmp_path / "elsewhere" / "mine").case("shoe").hash == project.case("shoe").hash
