"""A whole run with MKL and without it: the same numbers within the solver's accuracy."""

import pytest

from underfoot.compute.run import run
from underfoot.core import fourier, sparse


def test_run_without_mkl_gives_the_same_numbers(worn_shoe_case, worn_shoe_result, monkeypatch):
    assert sparse.back_end() == "pardiso", "MKL belongs to the environment of the tests"
    monkeypatch.setenv(sparse.VARIABLE, "superlu")
    monkeypatch.setenv(fourier.VARIABLE, "scipy")
    without = run(worn_shoe_case)
    for name in ("cof", "fluid_load", "peak_fluid_pressure", "contact_area"):
        assert without.value(name) == pytest.approx(worn_shoe_result.value(name), rel=1e-4), name
