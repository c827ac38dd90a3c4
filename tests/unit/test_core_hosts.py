"""What the core asks of its machine and of arrays that lie elsewhere."""

import os
from types import SimpleNamespace

import numpy as np
import pytest

from underfoot.core import device
from underfoot.core.pool import available_processors
from underfoot.core.text import cells_of
from underfoot.core.threads import on_host


@pytest.mark.parametrize(("count", "usable"), [(None, 1), (3, 3)])
def test_a_system_without_affinity_has_the_processors_it_counts_or_one(monkeypatch, count, usable):
    monkeypatch.delattr(os, "sched_getaffinity", raising=False)
    monkeypatch.setattr(os, "cpu_count", lambda: count)
    assert available_processors() == usable


def test_an_array_of_another_device_is_brought_to_this_one():
    class Far:
        def __array_namespace__(self, api_version=None):
            return np

        def to_device(self, device, /, stream=None):
            assert device == "cpu"
            return np.arange(3.0)

    found = on_host(Far())
    assert isinstance(found, np.ndarray)
    assert found.tolist() == [0, 1, 2]


def test_free_memory_is_what_the_system_calls_available_in_kibibytes(monkeypatch):
    lines = "MemTotal:  9000 kB\nMemFree:  100 kB\nMemAvailable:    2048 kB\n"
    told = SimpleNamespace(is_file=lambda: True, read_text=lambda: lines)
    monkeypatch.setattr(device, "Path", lambda _: told)
    assert device.free_memory(np.zeros(1)) == 2 * 1024**2
    monkeypatch.setattr(device, "Path", lambda _: SimpleNamespace(is_file=lambda: False))
    assert device.free_memory(np.zeros(1)) is None


@pytest.mark.parametrize(
    ("line", "cells"),
    [
        ('1 "" 2', ["1", "", "2"]),
        ('"a b"  c', ["a b", "c"]),
        ('" x " "', ["x", '"']),
        ("1 2", ["1", "2"]),
    ],
)
def test_cells_between_blanks_may_stand_in_quotes(line, cells):
    assert cells_of(line, None) == cells
