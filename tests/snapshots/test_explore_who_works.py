"""Whether another process of a study works, by when it was last heard of."""

import json
import os
import platform

import pytest

from underfoot.explore import store as module
from underfoot.explore.store import SILENT, Store

FAR = "another_machine-12-abcdef"


@pytest.fixture
def store(tmp_path):
    (tmp_path / "alive").mkdir()
    made = Store(tmp_path)
    (tmp_path / "alive" / made.name).write_text("{}")
    return made


def heard(store, ago, name=FAR, **said):
    """Let a process be heard of so many seconds before this one."""
    path = store.folder / "alive" / name
    path.write_text(json.dumps(said) if said else "")
    # of the clock of the file system, by which the own file is touched
    now = (store.folder / "alive" / store.name).stat().st_mtime
    os.utime(path, (now - ago, now - ago))
    return path


@pytest.mark.parametrize(("ago", "alive"), [(0, True), (SILENT - 5, True), (SILENT + 5, False)])
def test_a_process_elsewhere_works_while_it_is_heard_of(store, ago, alive):
    heard(store, ago)
    assert store._alive(FAR) is alive
    heard(store, ago, ended=None)
    assert store._alive(FAR) is alive
    heard(store, ago, ended=12.0)
    assert store._alive(FAR) is False


def test_a_mark_stands_in_for_a_process_without_a_file(store):
    assert store._alive(FAR) is False
    mark = store.folder / "half"
    mark.write_text("half")
    assert store._alive(FAR, mark) is True
    assert store._alive("", mark) is True
    long_ago = mark.stat().st_mtime - SILENT - 5
    os.utime(mark, (long_ago, long_ago))
    assert store._alive(FAR, mark) is False
    heard(store, 0)  # its own file counts before the mark
    assert store._alive(FAR, mark) is True
    mark.unlink()
    (store.folder / "alive" / FAR).unlink()
    assert store._alive(FAR, mark) is False


def test_a_process_of_this_machine_that_is_gone_is_not_alive(store, monkeypatch):
    monkeypatch.setattr(module, "_runs", lambda number: number == 7)
    here = platform.node() or "host"
    for number, alive in ((7, True), (8, False)):
        heard(store, 0, f"{here}-{number}-abcdef")
        assert store._alive(f"{here}-{number}-abcdef") is alive
    heard(store, 0, f"{here}x-8-abcdef")  # of another machine it can't be asked
    assert store._alive(f"{here}x-8-abcdef") is True


def test_where_the_clock_was_set_back_the_time_since_it_moved_counts(store, monkeypatch):
    clock = [1000.0]
    monkeypatch.setattr(module.time, "monotonic", lambda: clock[0])
    path = heard(store, -500)
    for seconds, alive in ((0.0, True), (SILENT - 5, True), (SILENT + 5, False)):
        clock[0] = 1000.0 + seconds
        assert store._alive(FAR) is alive, seconds
    later = path.stat().st_mtime + 1.0
    os.utime(path, (later, later))
    assert store._alive(FAR) is True
    clock[0] += SILENT - 5
    assert store._alive(FAR) is True
    clock[0] += 10
    assert store._alive(FAR) is False


def test_without_a_file_of_its_own_the_folder_tells_the_time(store):
    path = heard(store, 0)
    (store.folder / "alive" / store.name).unlink()
    now = (store.folder / "alive").stat().st_mtime
    for ago, alive in ((SILENT - 5, True), (SILENT + 5, False)):
        os.utime(path, (now - ago, now - ago))
        assert store._alive(FAR) is alive


def test_processes_of_this_machine(monkeypatch):
    def answers(error):
        def kill(number, signal):
            assert (number, signal) == (5, 0)
            if error:
                raise error

        monkeypatch.setattr(module.os, "kill", kill)
        return module._runs(5)

    assert [answers(each) for each in (None, ProcessLookupError(), PermissionError())] == [
        True, False, True,
    ]  # fmt: skip
    with monkeypatch.context() as patch:
        patch.setattr(module.os, "name", "nt")
        runs = module._runs(5)
    assert runs is True
