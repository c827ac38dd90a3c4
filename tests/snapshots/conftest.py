"""What several snapshots are taken in."""

import pytest


@pytest.fixture
def wide(monkeypatch):
    """A terminal of 100 columns."""
    monkeypatch.setenv("COLUMNS", "100")
    monkeypatch.setenv("TERM", "dumb")
