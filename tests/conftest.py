"""What several tests share."""

import os

import pytest

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("MKL_NUM_THREADS", "1")


@pytest.fixture(autouse=True)
def _own_cache(tmp_path_factory, monkeypatch):
    """Keep every test out of the user's cache."""
    monkeypatch.setenv("UNDERFOOT_CACHE", str(tmp_path_factory.getbasetemp() / "cache"))


@pytest.fixture(scope="session")
def worn_shoe_case():
    """The untreaded work shoe in glycerol on a coarse grid."""
    from underfoot.case import Case

    return Case.from_mapping(
        {
            "name": "worn work shoe",
            "shoe": "work_shoe_untreaded",
            "floor": "vinyl_g4",
            "contaminant": "glycerol_90pct",
            "motion": {"from": "slip_tester_g4"},
            "sensor": {"from": "slip_tester_g4"},
            "numerics": {"grid_spacing": "2 mm", "quick_grid_spacing": "3 mm"},
        }
    )


@pytest.fixture(scope="session")
def worn_shoe_result(worn_shoe_case):
    """Its result."""
    from underfoot.case.run import run

    return run(worn_shoe_case)
