"""A whole run with MKL and without it: the same numbers within the solver's accuracy."""

import pytest

from underfoot.compute.run import run
from underfoot.core import fourier, sparse


@pytest.mark.parametrize(
    ("tolerance", "positions", "apart"),
    [
        (1e-4, 1, 1e-6),
        # films trapped under a turned heel drain late: a march ends anywhere within its tolerance
        pytest.param(1e-4, 4, 1e-5, marks=pytest.mark.slow),
    ],
)
def test_run_without_mkl_gives_the_same_numbers(
    tolerance, positions, apart, worn_shoe_case, monkeypatch
):
    """Solutions of one system agree to 1e-9; a march ends anywhere within its own tolerance."""
    assert sparse.back_end() == "pardiso", "MKL belongs to the environment of the tests"
    numerics = {"numerics.tolerance": tolerance, "numerics.tread_positions": positions}
    case = worn_shoe_case.replace(numerics)
    with_mkl = run(case).scalars
    monkeypatch.setenv(sparse.VARIABLE, "superlu")
    monkeypatch.setenv(fourier.VARIABLE, "scipy")
    for name, scalar in run(case).scalars.items():
        assert scalar.value == pytest.approx(with_mkl[name].value, rel=apart), name
