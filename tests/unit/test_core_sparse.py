"""One face for sparse systems and Fourier transforms: both back ends, errors, choice by name."""

import numpy as np
import pytest
import scipy.sparse as sp

from underfoot.core import ConvergenceError, InputError, MissingExtraError, fourier, sparse

BOTH = pytest.mark.parametrize("name", sparse.back_ends())


def positive_definite(size=200):
    root = sp.random(size, size, 0.03, random_state=1)
    return sp.csr_matrix(root @ root.T + 2 * sp.eye(size))


def of_kind(kind):
    matrix = positive_definite()
    if kind == "symmetric":  # indefinite: every third unknown turned
        sign = sp.diags(np.where(np.arange(200) % 3, 1.0, -1.0))
        matrix = sp.csr_matrix(matrix + 3.0 * sign)
    if kind == "general":
        matrix = matrix.copy()
        matrix.data *= 1.0 + 0.3 * np.random.default_rng(0).random(matrix.nnz)
    matrix.sort_indices()
    return matrix


@BOTH
@pytest.mark.parametrize("kind", ["general", "symmetric", "positive definite"])
def test_factors_solve_one_side_and_several_and_take_new_values(name, kind):
    matrix = of_kind(kind)
    right = np.random.default_rng(1).random((200, 3))
    factors = sparse.factorization(matrix, name, kind=kind)
    np.testing.assert_allclose(matrix @ factors.solve(right[:, 0]), right[:, 0], atol=1e-10)
    np.testing.assert_allclose(matrix @ factors.solve(right), right, atol=1e-10)
    factors.factorise(2.0 * matrix)
    np.testing.assert_allclose(2.0 * matrix @ factors.solve(right[:, 1]), right[:, 1], atol=1e-10)


@BOTH
@pytest.mark.parametrize("kind", ["symmetric", "positive definite"])
def test_schur_complement_is_the_dense_one(name, kind):
    matrix = of_kind(kind)
    retained = np.array([3, 7, 50, 120, 199])
    others = np.setdiff1d(np.arange(200), retained)
    full = matrix.toarray()
    between = full[np.ix_(retained, others)]
    exact = full[np.ix_(retained, retained)] - between @ np.linalg.solve(
        full[np.ix_(others, others)], between.T
    )
    upper = sparse.upper_triangle(matrix)
    assert upper.nnz == (matrix.nnz + 200) // 2
    complement = sparse.schur_complement(upper, retained, name, kind=kind)
    np.testing.assert_allclose(complement, exact, atol=1e-11)


def test_complement_by_solves_goes_in_batches(monkeypatch):
    upper = sparse.upper_triangle(of_kind("symmetric"))
    at_once = sparse.schur_complement(upper, np.arange(7), "superlu")
    monkeypatch.setattr(sparse, "BATCH", 3)
    parts = sparse.schur_complement(upper, np.arange(7), "superlu")
    np.testing.assert_allclose(parts, at_once, rtol=1e-12, atol=1e-14)


@BOTH
def test_singular_or_damaged_matrix_is_an_error_with_the_place(name):
    holed = positive_definite()
    holed.data[5] = np.nan
    with pytest.raises(ConvergenceError, match=r"^shoe: .*singular"):
        sparse.factorization(holed, name, where="shoe")
    with pytest.raises(ConvergenceError, match=r"^shoe: .*singular"):
        sparse.schur_complement(sparse.upper_triangle(holed), np.arange(2), name, where="shoe")


def test_indefinite_matrix_is_not_positive_definite():
    if "pardiso" in sparse.back_ends():
        with pytest.raises(ConvergenceError, match="positive definite"):
            sparse.factorization(of_kind("symmetric"), "pardiso", kind="positive definite")


def test_unknown_names_are_answered_with_the_nearest():
    with pytest.raises(InputError, match=r'Did you mean "superlu"'):
        sparse.back_end("super_lu")
    with pytest.raises(InputError, match=r'Did you mean "scipy"'):
        fourier.fourier_library("scipi")


def test_environment_chooses_and_a_wrong_choice_is_refused(monkeypatch):
    monkeypatch.setenv("UNDERFOOT_SPARSE", "superlu")
    monkeypatch.setenv("UNDERFOOT_FFT", "scipy")
    assert sparse.back_end() == "superlu"
    assert isinstance(fourier.transform((8, 8), np.float64), fourier.ArrayTransform)
    monkeypatch.setenv("UNDERFOOT_SPARSE", "umfpack")
    with pytest.raises(InputError, match=r"^UNDERFOOT_SPARSE: unknown"):
        sparse.back_end()


def test_without_mkl_the_rest_remains_and_the_extra_is_named(monkeypatch):
    monkeypatch.setattr(sparse, "mkl_library", lambda: None)
    monkeypatch.setattr(fourier, "mkl_library", lambda: None)
    assert sparse.back_end() == "superlu"
    assert fourier.fourier_library() == "scipy"
    with pytest.raises(MissingExtraError, match=r"underfoot\[fast\]"):
        sparse.back_end("pardiso")
    with pytest.raises(MissingExtraError, match=r"underfoot\[fast\]"):
        fourier.fourier_library("mkl")
