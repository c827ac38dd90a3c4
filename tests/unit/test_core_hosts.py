"""What the core asks of its machine and of arrays that lie elsewhere."""

import os

import numpy as np
import pytest

from underfoot.core.pool import available_processors
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
