"""What serves others: workers by their words, cards and memory, files that can not be written."""

import errno
import os
import stat
import sys
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from snapshot import refusal
from underfoot.core import Cancelled, UnderfootError, device, pool, worker
from underfoot.core.errors import error_text, file_trouble, nearest_match, unknown_name
from underfoot.core.files import (
    check_writable_folder,
    named_for,
    read_toml,
    whole_file,
    whole_folder,
)
from underfoot.core.page import LONGEST_NUMBER, MOST_ITEMS, PageSection, page_part
from underfoot.core.presentation import Table


class Pipe:
    """The end of a pipe that a worker has: what it hears, and what it said."""

    def __init__(self, *heard: Any, refuses: Any = ()) -> None:
        self.heard, self.refuses, self.said = list(heard), refuses, list[Any]()

    def recv(self) -> Any:
        if not self.heard:
            raise EOFError
        return self.heard.pop(0)

    def send(self, message: Any) -> None:
        if self.refuses and any(part is self.refuses for part in message):
            raise TypeError("cannot pickle")
        self.said.append(message)


def test_a_worker_of_a_pool_answers_until_its_pipe_ends(monkeypatch):
    watched: list[Any] = []
    monkeypatch.setattr(pool, "watch_parent", lambda *given: watched.append(given))
    odd = ValueError("odd")

    def half(number: int) -> Any:
        if number == 5:
            return lock
        if number % 2:
            raise odd
        return number // 2

    lock = SimpleNamespace()
    pipe: Any = Pipe(4, 3, 5, refuses=lock)
    pool._serve(pipe, half, 17, False)
    assert watched == [(17, False)]
    *first, (good, error) = pipe.said
    assert first == [(True, None), (True, 2), (False, odd)]
    assert not good
    assert str(error).startswith("SimpleNamespace: namespace()")


def test_a_worker_of_jobs_tells_progress_answers_and_errors(monkeypatch):
    watched: list[Any] = []
    monkeypatch.setattr(worker, "watch_parent", lambda *given: watched.append(given))
    stopped = SimpleNamespace(is_set=lambda: len(pipe.said) > 4)
    lock = SimpleNamespace()

    def work(count: int, *, progress: Any, more: Any = None) -> Any:
        for number in range(count):
            progress("s", number / count, 0.5)
        if more == "lock":
            return lock
        if more:
            raise ValueError(more)
        return count

    pipe: Any = Pipe(
        (1, work, (2,), {}), (2, work, (0,), {"more": "bad"}), (3, work, (0,), {"more": "lock"}),
        (4, work, (1,), {}), refuses=lock,
    )  # fmt: skip
    worker._serve(pipe, stopped, ("json",), 17, True)
    assert watched == [(17, True)]
    assert pipe.said[:3] == [(1, "progress", ("s", 0.0, 0.5)), (1, "progress", ("s", 0.5, 0.5)),
                             (1, "answer", 2)]  # fmt: skip
    assert [(number, kind, type(content)) for number, kind, content in pipe.said[3:]] == [
        (2, "error", ValueError), (3, "error", UnderfootError), (4, "error", Cancelled),
    ]  # fmt: skip


def test_a_worker_ends_with_its_parent(monkeypatch):
    ended: list[Any] = []
    monkeypatch.setattr(os, "_exit", ended.append)
    monkeypatch.setattr(pool, "wait", lambda given: ended.append(given))
    monkeypatch.setattr(pool.multiprocessing, "parent_process", lambda: SimpleNamespace(sentinel=9))
    pool._end_with_parent()
    monkeypatch.setattr(pool.multiprocessing, "parent_process", lambda: None)
    pool._end_with_parent()
    assert ended == [[9], 1, 1]
    signals: list[Any] = []
    kernel = SimpleNamespace(prctl=lambda *given: signals.append(given))
    monkeypatch.setattr(pool.ctypes, "CDLL", lambda name: kernel)
    ended.clear()
    for system, by_kernel, parent in (
        ("linux", True, os.getppid()), ("linux", False, 1), ("win32", True, 1), ("linux", True, -5),
    ):  # fmt: skip
        monkeypatch.setattr(sys, "platform", system)
        pool.kill_with(parent, by_kernel)
        assert len(ended) == (parent == -5)
    assert signals == [(1, 9), (1, 9)]


def torch(there: bool) -> Any:
    """Return what stands for PyTorch with a card of 140 GB, or without one."""
    cuda = SimpleNamespace(
        is_available=lambda: there, get_device_name=lambda: "a card",
        get_device_properties=lambda number: {0: SimpleNamespace(total_memory=140.4e9)}[number],
        memory_reserved=lambda place: 50, memory_allocated=lambda place: 20,
        mem_get_info=lambda place: (1000, 9000),
    )  # fmt: skip
    return SimpleNamespace(cuda=cuda, asarray=lambda array, device: (array, device))


def test_a_card_is_there_where_pytorch_finds_one(monkeypatch):
    monkeypatch.setattr(device, "find_spec", lambda name: None)
    assert device.card() is None
    assert device.described_card().startswith("none looked for")
    assert refusal(device.on_card, "cuda", 1).startswith("MissingExtraError")
    assert not device.on_card("auto", 10**9)
    monkeypatch.setattr(device, "find_spec", lambda name: name == "torch" or None)
    monkeypatch.setitem(sys.modules, "torch", torch(False))
    assert device.card() is None
    assert device.described_card() == "none; rough contact runs on the processor"
    assert refusal(device.on_card, "cuda", 1).startswith("InputError: device: no graphics card")
    monkeypatch.setitem(sys.modules, "torch", torch(True))
    assert device.card() == "a card"
    assert device.described_card() == "a card, 140 GB"
    assert [device.on_card(name, 512 * 512) for name in device.DEVICES] == [True, False, True]
    assert [device.on_card(name, 512 * 512 - 1) for name in device.DEVICES] == [False, False, True]
    assert device.to_card("x") == ("x", "cuda")
    assert "device" in refusal(device.on_card, "gpu", 1)


def test_memory_is_that_of_the_place_where_an_array_lies(monkeypatch):
    """What PyTorch keeps for itself and does not use is free too."""
    monkeypatch.setitem(sys.modules, "torch", torch(True))
    lies: Any = SimpleNamespace(device=SimpleNamespace(type="cuda"))
    assert device.free_memory(lies) == 1030
    cupy: Any = SimpleNamespace(device=SimpleNamespace(mem_info=(700, 900)))
    assert device.free_memory(cupy) == 700
    here = device.free_memory(np.zeros(1))
    assert here is None or here > 1024**2


def test_a_file_that_can_not_be_written_is_named_whole(tmp_path):
    path, other = tmp_path / "a.txt", tmp_path / "other.txt"
    with whole_file(path) as part:
        part.write_text("one", encoding="utf-8")
        assert not path.exists()
    assert path.read_text(encoding="utf-8") == "one"

    def write(error: Exception) -> str:
        def fails() -> None:
            with whole_file(path) as part:
                part.write_text("two", encoding="utf-8")
                if isinstance(error, OSError) and error.filename in ("part", "text"):
                    error.filename = part if error.filename == "part" else str(part)
                raise error

        with pytest.raises(type(error)) as told:
            fails()
        assert [one.name for one in tmp_path.iterdir()] == ["a.txt"]
        assert path.read_text(encoding="utf-8") == "one"
        return str(getattr(told.value, "filename", None))

    assert write(OSError(errno.ENOSPC, "full", "part")) == str(path)
    assert write(OSError(errno.ENOSPC, "full", "text")) == str(path)
    assert write(OSError(errno.ENOSPC, "full")) == str(path)
    assert write(OSError(errno.ENOSPC, "full", str(other))) == str(other)
    assert write(OSError("no number")) == "None"
    assert write(ValueError("a")) == "None"
    made = named_for(PermissionError(errno.EACCES, "refused", "hidden"), path)
    assert (type(made), made.errno, made.strerror) == (PermissionError, errno.EACCES, "refused")


def test_a_folder_that_is_made_whole_may_be_read_by_all(tmp_path):
    with whole_folder(tmp_path / "a") as staging:
        (staging / "b").touch()
    assert stat.S_IMODE((tmp_path / "a").stat().st_mode) == 0o755


def test_folders_that_can_not_be_made_say_why(tmp_path, monkeypatch):
    file = tmp_path / "file"
    file.touch()
    assert "is a file" in refusal(check_writable_folder, file)
    within = refusal(check_writable_folder, file / "a" / "b")
    assert f"can't be made: nothing can be written in {file} (it is a file)" in within
    check_writable_folder(tmp_path / "new" / "folder")
    assert not (tmp_path / "new").exists()
    from underfoot.core import files

    def refuses(error: OSError) -> str:
        def folder(**_: Any) -> Any:
            raise error

        monkeypatch.setattr(files.tempfile, "TemporaryDirectory", folder)
        return refusal(check_writable_folder, tmp_path / "new")

    assert "(no space left)" in refuses(OSError(errno.ENOSPC, "No Space left"))
    assert "(strange)" in refuses(OSError("Strange"))
    full = tmp_path / "full"
    full.mkdir()
    for count, more in ((3, False), (4, True)):
        for name in "abcd"[:count]:
            (full / name).touch()
        text = refusal(check_writable_folder, full, overwrite=True)
        assert "holds a, b, c" in text
        assert ("and 1 more" in text) == more


def test_what_went_wrong_with_a_file_is_told_with_its_name():
    for number, words in (
        (errno.ENOENT, "a does not exist."), (errno.EISDIR, "a is a folder; a file is needed."),
        (errno.EACCES, "no permission to use a."), (errno.EPERM, "no permission to use a."),
        (errno.ENOSPC, "no space left on the disk for a."), (errno.EEXIST, "a exists already."),
        (errno.EIO, "broken: a."),
    ):  # fmt: skip
        assert file_trouble(OSError(number, "broken", "a")) == words
    assert file_trouble(OSError(errno.EIO, "broken")) == "broken."
    assert file_trouble(OSError("strange")) == "strange."
    assert file_trouble(OSError(errno.ENOENT, "x")) == "the file does not exist."
    assert "not enough memory" in error_text(MemoryError())
    assert error_text(KeyError("a")).startswith("internal error: KeyError: 'a'")


def test_names_that_are_close_and_lists_that_are_long():
    assert nearest_match("COFF", ["fluid_load", "cof"]) == "cof"
    assert nearest_match("ab", ["abxx"]) == "abxx"  # 2 of 3 letters in one order
    assert nearest_match("ab", ["abxxxxx"]) is None
    assert nearest_match("ab", ["abxx"], least=0.7) is None
    names = [f"n{k:02d}" for k in range(13)]
    assert "n11 or" not in str(unknown_name("key", "x", names[:12]))
    assert "more" not in str(unknown_name("key", "x", names[:12]))
    assert "and 1 more" in str(unknown_name("key", "x", names))
    assert "n12" not in str(unknown_name("key", "x", names))
    assert "none defined" in str(unknown_name("key", "x", []))


def test_a_file_of_toml_with_a_mark_and_one_that_is_none(tmp_path):
    path = tmp_path / "a.toml"
    path.write_bytes(b"\xef\xbb\xbfa = 1.5\n")
    assert read_toml(path) == {"a": 1.5}
    path.write_bytes(b"a = \xff")
    assert "is no TOML file" in refusal(read_toml, path)
    assert "a.toml" in refusal(read_toml, tmp_path / "b.toml")
    assert refusal(read_toml, tmp_path / "b.toml").startswith("InputError")


def test_cells_of_a_page_that_start_with_a_number_stand_flush_right():
    def flush(cell: str) -> bool:
        html = page_part([PageSection("t", table=Table("t", ("a", "b"), [("x", cell)]))])
        return 'class="num' in html or 'class="n"' in html or "number" in html

    cells = ["0.30", "-1,000 N", "0.30 ± 0.02", "below 3", "above 3 m", "-", "1" * 31]
    assert all(map(flush, cells)), [cell for cell in cells if not flush(cell)]
    assert not any(map(flush, ["about 3", "3 of the many", "1" * LONGEST_NUMBER]))


@pytest.mark.parametrize(("count", "folds"), [(MOST_ITEMS, False), (MOST_ITEMS + 1, True)])
def test_lists_of_a_page_fold_away_beyond_the_third_line(count, folds):
    html = page_part([PageSection("t", items=[f"line {k}" for k in range(count)])])
    assert html.count("line ") == count
    assert ("<details" in html) == folds


def test_a_job_has_an_answer_once_it_is_done_or_its_error():
    job = worker.Job(3)
    assert "job 3 is not done" in refusal(job.result)
    job.done, job.answer = True, 7
    assert job.result() == 7
    job.error = Cancelled("stopped")
    assert refusal(job.result).startswith("Cancelled")


class Told(worker.Worker):
    """A worker whose process is made up: it is started and killed by name alone."""

    def _start(self) -> None:
        self.killed = getattr(self, "killed", 0)
        self._pipe: Any = Words()
        self._cancelled: Any = SimpleNamespace(set=lambda: None, clear=lambda: None)
        self._process: Any = SimpleNamespace(
            kill=self._kill, join=lambda: None, is_alive=lambda: True
        )

    def _kill(self) -> None:
        self.killed += 1


class Words:
    """A pipe that has what its worker said."""

    def __init__(self) -> None:
        self.said, self.sent = list[Any](), list[Any]()

    def poll(self, seconds: float) -> bool:
        return bool(self.said)

    def recv(self) -> Any:
        word = self.said.pop(0)
        if word is EOFError:
            raise EOFError
        return word

    def send(self, message: Any) -> None:
        self.sent.append(message)

    def close(self) -> None:
        pass


def test_a_worker_has_one_job_at_a_time_and_hears_no_word_of_an_old_one():
    made = Told()
    assert made.poll() is None
    assert made.cancel() is None
    assert not made.busy
    job = made.submit(len, "abc", more=1)
    assert made.busy
    assert made._pipe.sent == [(1, len, ("abc",), {"more": 1})]
    assert "the worker is busy" in refusal(made.submit, len)
    made._pipe.said += [(0, "answer", 9), (1, "progress", ("s", 0.5, 2.0)), (1, "answer", 3)]
    assert made.poll() is job
    assert (job.stage, job.fraction, job.residual, job.answer) == ("s", 1.0, 2.0, 3)
    assert not made.busy
    assert made.killed == 0
    again = made.submit(len)
    assert again.number == 2
    made._pipe.said += [(2, "error", ValueError("bad")), (2, "answer", 1)]
    assert made.poll() is again
    assert refusal(made.wait, again).startswith("ValueError")
    lost = made.submit(len)
    made._pipe.said = [EOFError]
    assert made.poll() is lost
    assert "worker process died" in refusal(lost.result)
    assert made.killed == 1
    deaf = made.submit(len)
    assert made.cancel() is deaf
    assert refusal(deaf.result).startswith("Cancelled")
    assert made.killed == 2
    heeds = made.submit(len)
    made._pipe.said = [(5, "progress", ("s", 0.1, None)), (5, "error", Cancelled("stopped"))]
    assert made.cancel() is heeds
    assert refusal(heeds.result).startswith("Cancelled")
    assert made.killed == 2
    dead = made._process
    dead.is_alive = lambda: False
    made.submit(len)
    assert made._process is not dead
    assert made.killed == 3
    with made:
        pass
    assert made.killed == 4
