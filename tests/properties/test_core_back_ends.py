"""A whole run with MKL and without it: the same numbers within the solver's accuracy."""

import pytest

from underfoot.compute.run import run
from underfoot.core import fourier, sparse


@pytest.mark.parametrize("tolerance", [1e-4, 1e-6])
def test_run_without_mkl_gives_the_same_numbers(tolerance, worn_shoe_case, monkeypatch):
    """Within a hundredth of the tolerance, anywhere within which a march may end."""
    assert sparse.back_end() == "pardiso", "MKL belongs to the environment of the tests"
    case = worn_shoe_case.replace("numerics.tolerance", tolerance)
    with_mkl = run(case).scalars
    monkeypatch.setenv(sparse.VARIABLE, "superlu")
    monkeypatch.setenv(fourier.VARIABLE, "scipy")
    for name, scalar in run(case).scalars.items():
        size = with_mkl["cof" if name == "cof_shoe_angle" else name].value  # a difference of COF
        assert abs(scalar.value - with_mkl[name].value) <= 0.01 * tolerance * size, name
