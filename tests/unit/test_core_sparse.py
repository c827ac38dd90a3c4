"""One face for sparse systems and Fourier transforms: both back ends, errors, choice by name."""

import numpy as np
import pytest
import scipy.sparse as sp

from underfoot.core import ConvergenceError, InputError, MissingExtraError, fourier, mkl, sparse

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


def film_matrix(size=100):
    """Return an upwinded film equation on a rough gap: factors of conductance of e^6 and more."""
    random = np.random.default_rng(size)
    gap = np.exp(random.normal(0.0, 2.0, (size, size)))
    cell = np.arange(size**2).reshape(size, size)
    diagonal, rows, columns, values = np.zeros(size**2), [], [], []
    for one, two, height in (
        (cell[:-1], cell[1:], gap[:-1] + gap[1:]),
        (cell[:, :-1], cell[:, 1:], gap[:, :-1] + gap[:, 1:]),
    ):
        conductance = height.ravel() ** 3
        carried = 0.5 * random.random(conductance.size) * conductance
        rows += [one.ravel(), two.ravel()]
        columns += [two.ravel(), one.ravel()]
        values += [carried - conductance, -conductance - carried]
        np.add.at(diagonal, one.ravel(), conductance + carried)
        np.add.at(diagonal, two.ravel(), conductance - carried)
    entries = np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))
    matrix = sp.csr_matrix(entries) + sp.diags(diagonal + 1e-3 * diagonal.mean())
    matrix = sp.csr_matrix(matrix)
    matrix.sort_indices()
    return matrix


def solutions(count=10):
    """Return solutions of film equations of one sparsity, by the back end in use."""
    matrix, random = film_matrix(), np.random.default_rng(0)
    factors = sparse.factorization(matrix)
    answers = []
    for _ in range(count):
        changed = matrix.copy()
        changed.data *= 1.0 + 0.1 * random.random(matrix.nnz)
        factors.factorise(changed)
        answers.append(factors.solve(random.normal(size=matrix.shape[0])))
    return np.array(answers)


def test_back_ends_agree_on_a_film_of_any_gap(monkeypatch):
    answers = []
    for name in sparse.back_ends():
        monkeypatch.setenv(sparse.VARIABLE, name)
        answers.append(solutions())
    for other in answers[1:]:
        assert np.abs(other - answers[0]).max() < 1e-9 * np.abs(answers[0]).max()


def test_a_factorization_that_is_wrong_on_two_threads_is_caught(monkeypatch):
    """Minimum degree with the two-level factorization: the residual of a first solve tells."""
    library = mkl.mkl_library()
    if library is None:
        pytest.skip("MKL, an extra, has no wheel for this machine or is left out")
    made = mkl._System.__init__

    def wrong(self, matrix, kind):
        made(self, matrix, kind)
        self.options[1], self.options[23] = 0, 10
        self._set_threads = lambda _: library.MKL_Set_Num_Threads_Local(2)

    monkeypatch.setattr(mkl._System, "__init__", wrong)
    monkeypatch.setenv(sparse.VARIABLE, "pardiso")
    before = library.MKL_Get_Dynamic()
    library.MKL_Set_Dynamic(0)  # two threads on one processor too
    try:
        with pytest.raises(
            ConvergenceError,
            match=r"^film: a solution by pardiso is wrong.*UNDERFOOT_SPARSE=superlu",
        ):
            solutions(30)
    finally:
        library.MKL_Set_Dynamic(before)
        library.MKL_Set_Num_Threads_Local(0)
