"""Logistic regression: separation checked first, maximum likelihood and Firth side by side.

Maximum likelihood and estimating equations are those of statsmodels. Firth's penalty and profile
intervals are ours: no maintained package has them, or converges on predictors as small as a COF.
"""

import warnings as python_warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import ConvergenceError, DataError, InputError, unknown_name
from underfoot.core.optional import optional_module
from underfoot.core.remark import NOTHING, Message

_PURPOSE = "A logistic regression"


def log_likelihood(eta: np.ndarray, y: np.ndarray) -> float:
    """Return sum(y eta - log(1 + exp eta))."""
    return float(np.sum(y * eta - np.logaddexp(0.0, eta)))


def information(matrix: np.ndarray, eta: np.ndarray) -> np.ndarray:
    """Return X' diag(p (1 - p)) X, shape (p, p)."""
    p = probability(eta)
    return matrix.T @ ((p * (1.0 - p))[:, None] * matrix)


def probability(eta: np.ndarray) -> np.ndarray:
    """Return 1 / (1 + exp(-eta)) without overflow."""
    return 0.5 * (1.0 + np.tanh(0.5 * eta))


def objective(matrix: np.ndarray, eta: np.ndarray, y: np.ndarray, firth: bool) -> float:
    """Return the log-likelihood, plus half the log-determinant of the information for Firth."""
    value = log_likelihood(eta, y)
    if not firth:
        return value
    sign, logdet = np.linalg.slogdet(information(matrix, eta))
    return value + 0.5 * float(logdet) if sign > 0 else -np.inf


def maximise_likelihood(
    matrix: np.ndarray,
    y: np.ndarray,
    start: np.ndarray,
    free: np.ndarray,
    firth: bool,
    *,
    steps: int = 200,
    tolerance: float = 1e-17,
) -> tuple[np.ndarray, float, bool]:
    """Return (coefficients, objective, converged); only ``free`` coefficients move.

    The penalty is that of an orthonormal basis of the columns: another constant than
    ``objective`` of the matrix itself.

    Newton steps on the (modified) score with the Fisher information as curvature, at most 5 in
    any scaled coefficient, halved until the objective rises; settled when a step promises less
    than ``tolerance``, or when rounding hides a promise below 1e-8.
    """
    beta = start.copy()
    eta = matrix @ beta
    # The penalty and the leverages depend on the space of the columns only: an orthonormal basis
    # keeps them exact when the columns are nearly alike.
    basis = np.linalg.qr(matrix)[0]
    value = objective(basis, eta, y, firth)
    for _ in range(steps):
        p = probability(eta)
        weight = p * (1.0 - p)
        curvature = matrix.T @ (weight[:, None] * matrix)
        residual = y - p
        if firth:
            inverse = np.linalg.pinv(basis.T @ (weight[:, None] * basis))
            leverage = weight * np.einsum("ij,jk,ik->i", basis, inverse, basis)
            residual = residual + leverage * (0.5 - p)
        score = matrix[:, free].T @ residual
        step = np.linalg.lstsq(curvature[np.ix_(free, free)], score, rcond=None)[0]
        # Twice the expected rise of the objective: the same in every unit of the predictors.
        gain = float(score @ step)
        if np.max(np.abs(step), initial=0.0) > 5.0:
            step *= 5.0 / np.max(np.abs(step))
        scale = 1.0
        for _ in range(40):
            trial = beta.copy()
            trial[free] += scale * step
            trial_eta = matrix @ trial
            trial_value = objective(basis, trial_eta, y, firth)
            if trial_value >= value - 1e-13 * abs(value):
                break
            scale *= 0.5
        else:
            return beta, value, gain < 1e-8
        beta, eta, value = trial, trial_eta, trial_value
        if gain < tolerance:
            return beta, value, True
    return beta, value, False


METHODS = {
    "maximum_likelihood": "maximum likelihood",
    "firth": "Firth's penalised likelihood (bias reduced; finite under separation)",
    "clustered": "generalised estimating equations, errors by person",
}


@dataclass(frozen=True, slots=True)
class Separation:
    """``kind`` is "none", "quasi-complete" or "complete".

    ``infinite`` marks the coefficients (intercept first) whose maximum-likelihood estimate does
    not exist.
    """

    kind: str
    infinite: tuple[bool, ...]

    @property
    def separated(self) -> bool:
        """True when maximum likelihood has no finite answer."""
        return self.kind != "none"


def separation(matrix: np.ndarray, outcome: np.ndarray) -> Separation:
    """Return whether a direction b exists with X b >= 0 where y = 1 and <= 0 where y = 0.

    ``matrix``: shape (n, p) of full rank, intercept first. ``outcome``: shape (n,), 0 or 1.

    Source: K. Konis, Linear programming algorithms for detecting separated data in binary
    logistic regression models, thesis, Oxford 2007.
    """
    from scipy.optimize import linprog

    scale = np.abs(matrix).max(axis=0)
    signed = np.where(outcome > 0.5, 1.0, -1.0)[:, None] * matrix / scale
    n, p = signed.shape

    def most(direction: np.ndarray, sides: np.ndarray, *margin: tuple[float, float]) -> float:
        """Return the largest step in a direction that leaves every observation on its side."""
        bounds = [(-1.0, 1.0)] * p + list(margin)
        optimize_result = linprog(-direction, A_ub=-sides, b_ub=np.zeros(n), bounds=bounds)
        return -float(optimize_result.fun) if optimize_result.success else 0.0

    infinite = tuple(max(most(e, signed), most(-e, signed)) > 1e-7 for e in np.eye(p))
    if not any(infinite):
        return Separation("none", infinite)
    # Complete: every observation can be put on its side by one and the same margin.
    together = most(np.eye(p + 1)[p], np.column_stack((signed, -np.ones(n))), (0.0, 1.0))
    return Separation("complete" if together > 1e-7 else "quasi-complete", infinite)


@dataclass(frozen=True, slots=True)
class Coefficient:
    """One coefficient: estimate, standard error, interval and p of zero.

    Interval and p are those of the profile of the likelihood and its ratio; of clustered data see
    ``clustered_logistic``. ``low`` or ``high`` is None where the profile does not close, ``p``
    where zero is not tested.
    """

    name: str
    estimate: float
    standard_error: float
    low: float | None
    high: float | None
    p: float | None


@dataclass(frozen=True, slots=True)
class _Fit:
    method: str
    coefficients: tuple[Coefficient, ...]
    covariance: np.ndarray

    def __getitem__(self, name: str) -> Coefficient:
        return next(c for c in self.coefficients if c.name == name)

    @property
    def estimates(self) -> np.ndarray:
        """Coefficients, intercept first, shape (p,)."""
        return np.array([c.estimate for c in self.coefficients])


@dataclass(frozen=True, slots=True)
class LogisticFit(_Fit):
    """A fitted logistic model log(p / (1 - p)) = b0 + b1 x1 + ..."""

    log_likelihood: float
    penalised_log_likelihood: float | None
    n: int
    events: int
    separation: Separation
    warnings: tuple[Message, ...]

    @property
    def deviance(self) -> float:
        """-2 log-likelihood (of the unpenalised likelihood)."""
        return -2.0 * self.log_likelihood

    def probability(self, **values: float | np.ndarray) -> np.ndarray:
        """Return the modelled probability at predictor values."""
        eta = self.coefficients[0].estimate + sum(
            c.estimate * np.asarray(values[c.name], dtype=float) for c in self.coefficients[1:]
        )
        return probability(np.asarray(eta, dtype=float))


def logistic_regression(
    outcome: ArrayLike,
    predictors: Mapping[str, ArrayLike],
    *,
    method: str = "maximum_likelihood",
    confidence: float = 0.95,
) -> LogisticFit:
    """Return a logistic regression with profile-likelihood intervals.

    Separation is looked for first (linear programme): maximum likelihood has then no finite
    answer and is refused; ``"firth"`` gives one. Predictors are scaled (and centred for the
    slopes) before iterating, so that predictors of the size of a COF converge.

    ``outcome``: shape (n,), 0 or 1 (1 = slip). ``predictors``: numbers, each shape (n,).
    ``method``: ``"maximum_likelihood"`` or ``"firth"``.

    DataError: outcome not binary or all equal; missing values; separated data with maximum
    likelihood; predictors that depend on each other. ConvergenceError: the iteration did not
    settle.

    Source: D. Firth, Biometrika 80 (1993) 27; G. Heinze, M. Schemper, Stat. Med. 21 (2002) 2409.
    """
    y, matrix, names = _check_outcome(outcome, predictors)
    firth = method == "firth"
    if method not in ("maximum_likelihood", "firth"):
        raise unknown_name("method", method, tuple(METHODS)[:2], where="logistic regression")
    separated = separation(matrix, y)
    warnings = []
    if separated.separated:
        message = Message(
            "{kind} separation: no finite maximum-likelihood estimate of {names}",
            kind=separated.kind,
            names=[n for n, inf in zip(names, separated.infinite, strict=True) if inf],
        )
        if not firth:
            raise DataError(message, where="logistic regression", remedy="Use method firth")
        warnings.append(message)
    rarer = int(min(y.sum(), len(y) - y.sum()))
    if rarer < 5 * len(predictors):
        warnings.append(
            Message(
                "{rarer} of the rarer outcome for {count} predictors: overfits",
                rarer=rarer,
                count=len(predictors),
            )
        )
    centred, scale, back = _scale_matrix(matrix)
    start = np.zeros(len(names))
    mean = float(y.mean())
    start[0] = np.log(mean / (1.0 - mean))
    if not firth:
        start = _maximum_likelihood(y, centred)
    # From the maximum this only adds the value of the objective that profiles are measured from.
    scaled, best, converged = maximise_likelihood(
        centred, y, start, np.ones(len(names), dtype=bool), firth
    )
    if not converged:
        raise ConvergenceError("the likelihood did not settle", where="logistic regression")
    beta = back @ scaled
    eta = matrix @ beta
    covariance = back @ np.linalg.inv(information(centred, eta)) @ back.T
    errors = np.sqrt(np.diag(covariance))
    coefficients = []
    # The intercept is a sum of the centred coefficients: axes with it as the first keep columns of
    # one size, where those of the predictors themselves may lie far from 0.
    axes, reach = np.linalg.qr(back[0][:, None], mode="complete")
    axes *= np.sign(reach[0, 0])
    for j, name in enumerate(names):
        work, at, unit = centred, scaled, scale[j]
        if j == 0:
            work, at, unit = centred @ axes, axes.T @ scaled, 1 / abs(reach[0, 0])
        *ends, p, open_ends = _profile(work, y, at, j, firth, best, confidence, errors[j] * unit)
        if open_ends:
            warnings.append(Message("{name}: {open_ends}", name=name, open_ends=open_ends))
        low, high = (None if end is None else float(end / unit) for end in ends)
        coefficients.append(Coefficient(name, float(beta[j]), float(errors[j]), low, high, p))
    likelihoods = log_likelihood(eta, y), objective(matrix, eta, y, True) if firth else None
    counted = len(y), int(y.sum()), separated, tuple(warnings)
    return LogisticFit(method, tuple(coefficients), covariance, *likelihoods, *counted)


def _scale_matrix(matrix: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the centred and scaled matrix, the scales, and what brings coefficients back."""
    scale = np.concatenate(([1.0], matrix[:, 1:].std(axis=0)))
    centre = np.concatenate(([0.0], matrix[:, 1:].mean(axis=0)))
    back = np.diag(1.0 / scale)
    back[0, 1:] = -centre[1:] / scale[1:]
    return (matrix - centre) / scale, scale, back


def _maximum_likelihood(y: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    models = optional_module("statsmodels.discrete.discrete_model", "trials", _PURPOSE)
    fit = models.Logit(y, matrix).fit(disp=0, method="newton", maxiter=100, warn_convergence=False)
    if not fit.mle_retvals["converged"]:
        raise ConvergenceError("the likelihood did not settle", where="logistic regression")
    return np.asarray(fit.params)


def _profile(
    matrix: np.ndarray,
    y: np.ndarray,
    best_beta: np.ndarray,
    j: int,
    firth: bool,
    best: float,
    confidence: float,
    error: float,
) -> tuple[float | None, float | None, float, str]:
    """Return the profile interval of coefficient ``j``, the p of zero, and what is left open.

    An end whose profile does not settle is None, and p is then Wald's where its own does not.
    """
    from scipy.optimize import brentq
    from scipy.stats import chi2, norm

    free = np.ones(len(best_beta), dtype=bool)
    free[j] = False
    limit = 0.5 * float(chi2.ppf(confidence, 1))
    # The others follow the fixed coefficient along the tangent: without that, an intercept far
    # from the data throws all probabilities to 0 or 1 before the first step.
    spread = np.linalg.inv(information(matrix, matrix @ best_beta))
    tangent = spread[:, j] / spread[j, j]
    last = {0: best_beta.copy()}

    def drop(value: float) -> float:
        start = last[0] + tangent * (value - last[0][j])
        start[j] = value
        beta, reached, converged = maximise_likelihood(
            matrix, y, start, free, firth, tolerance=1e-12
        )
        if not converged:
            raise ConvergenceError("a profile did not settle", where="logistic regression")
        last[0] = beta
        return best - reached

    def end(direction: float) -> float | None:
        last[0] = best_beta.copy()
        inner, step = float(best_beta[j]), error
        for _ in range(12):
            outer = inner + direction * step
            if drop(outer) > limit:
                root: Any = brentq(lambda v: drop(v) - limit, inner, outer, xtol=1e-9)
                return float(root)
            inner, step = outer, 1.6 * step
        return None

    ends: list[float | None] = []
    lost = []
    for direction, side in ((-1.0, Message("lower end")), (1.0, Message("upper end"))):
        try:
            ends.append(end(direction))
        except ConvergenceError:
            ends.append(None)
            lost.append(side)
    last[0] = best_beta.copy()
    try:
        p = float(chi2.sf(max(2.0 * drop(0.0), 0.0), 1))
    except ConvergenceError:
        p = 2.0 * float(norm.sf(abs(best_beta[j]) / error))
        lost.append(Message("likelihood-ratio p (Wald's in its place)"))
    text = Message("the profile did not settle at its {lost}", lost=lost) if lost else NOTHING
    return ends[0], ends[1], p, text


def _check_outcome(
    outcome: ArrayLike, predictors: Mapping[str, ArrayLike]
) -> tuple[np.ndarray, np.ndarray, list[str]]:
    where = "logistic regression"
    y = np.asarray(outcome, dtype=float)
    if not np.isin(y, (0.0, 1.0)).all():
        raise DataError("the outcome must be 0 or 1", where=where)
    if not 0 < y.sum() < len(y):
        raise DataError(
            Message("all {count} outcomes are equal", count=len(y)),
            where=where,
            remedy="Nothing to model; give a rate",
        )
    columns = [np.asarray(values, dtype=float) for values in predictors.values()]
    if any(len(column) != len(y) for column in columns):
        raise DataError("predictors and outcome differ in length", where=where)
    matrix = np.column_stack([np.ones(len(y)), *columns])
    if not np.isfinite(matrix).all():
        raise DataError("predictors hold missing values", where=where)
    scaled = matrix / np.maximum(np.abs(matrix).max(axis=0), 1e-300)
    scaled[:, 1:] -= scaled[:, 1:].mean(axis=0)
    if np.linalg.matrix_rank(scaled, tol=1e-9) < matrix.shape[1]:
        raise DataError("a predictor is constant or follows from the others", where=where)
    return y, matrix, ["intercept", *predictors]


_ALL_FLIPS, _FLIPS = 14, 10_000


@dataclass(frozen=True, slots=True)
class ClusteredFit(_Fit):
    """Population-averaged logistic model with exchangeable working correlation.

    ``covariance`` is the small-sample one, shape (p, p), intercept first.
    """

    correlation: float
    clusters: int
    n: int


def clustered_logistic(
    outcome: ArrayLike,
    predictors: Mapping[str, ArrayLike],
    cluster: Sequence[object],
    *,
    confidence: float = 0.95,
) -> ClusteredFit:
    """Return generalised estimating equations with exchangeable correlation within clusters.

    Two slips of one person are not two persons. Errors are the sandwich of Liang and Zeger in
    the bias-corrected form of Kauermann and Carroll; intervals take t with (clusters - parameters)
    degrees of freedom. p of a predictor compares its score, where it has no
    effect, with the scores of the same clusters with their signs flipped: all flips of up to 14
    clusters, else 9,999 at random. In small studies t calls less than 5 % of effects of
    zero significant, flips 5 % (docs/physics/trial_statistics.md).

    Where the outcomes of a cluster are so alike that no correlation fits, clusters are taken as
    independent rows (correlation 0) and the errors alone allow for it.

    ``outcome`` and ``predictors``: as for ``logistic_regression``. ``cluster``: whom each row
    belongs to, shape (n,).

    DataError: separated data, fewer clusters than needed, lengths differ. ConvergenceError: the
    estimating equations did not settle.

    Source: K.-Y. Liang, S. L. Zeger, Biometrika 73 (1986) 13; G. Kauermann, R. J. Carroll, J. Am.
    Stat. Assoc. 96 (2001) 1387; J. Hemerik, J. J. Goeman, L. Finos, J. R. Stat. Soc. B 82 (2020)
    841.
    """
    from scipy.stats import t as student

    y, matrix, names = _check_outcome(outcome, predictors)
    labels = [str(c) for c in cluster]
    if len(labels) != len(y):
        raise DataError("one cluster label per row is needed", where="cluster")
    order = {label: i for i, label in enumerate(dict.fromkeys(labels))}
    df = len(order) - len(names)
    if df <= 1:
        text = Message(
            "{clusters} clusters for {parameters} parameters",
            clusters=len(order),
            parameters=len(names),
        )
        raise DataError(text, where="cluster", allowed="more clusters")
    # Refuses separated data with its own message, and starts the iteration at its answer.
    start = logistic_regression(y.astype(int), dict(predictors)).estimates
    centred, _, back = _scale_matrix(matrix)
    groups = np.array([order[label] for label in labels])
    params, dependence = _estimate_equations(y, centred, groups, np.linalg.solve(back, start))
    clusters = _cluster_scores(y, centred, groups, centred @ params, dependence)
    corrected = back @ sandwich(*clusters, 0.5) @ back.T
    estimates, errors = back @ params, np.sqrt(np.diag(corrected))
    reach = float(student.ppf(0.5 + confidence / 2, df)) * errors
    p = [None, *(_flipped_p(y, centred, groups, j) for j in range(1, len(names)))]
    columns = estimates, errors, estimates - reach, estimates + reach
    coefficients = tuple(
        Coefficient(name, *numbers, p=own)
        for name, own, *numbers in zip(names, p, *(c.tolist() for c in columns), strict=True)
    )
    return ClusteredFit("clustered", coefficients, corrected, dependence, len(order), len(y))


def _estimate_equations(
    y: np.ndarray, matrix: np.ndarray, groups: np.ndarray, start: np.ndarray
) -> tuple[np.ndarray, float]:
    """Coefficients (p,) of the estimating equations and the correlation within clusters."""
    models = optional_module("statsmodels.genmod.api", "trials", _PURPOSE)
    largest = int(np.bincount(groups).max())
    for structure in (models.cov_struct.Exchangeable(), models.cov_struct.Independence()):
        family = models.families.Binomial()
        model = models.GEE(y, matrix, groups, family=family, cov_struct=structure)
        with np.errstate(all="ignore"), python_warnings.catch_warnings():
            python_warnings.simplefilter("ignore")  # whether the fit has settled is asked below
            fit: Any = model.fit(maxiter=200, ctol=1e-12, start_params=start, first_dep_update=0)
        alike = float(np.asarray(structure.dep_params or 0.0))
        # Of persons who always do the same the moments give 1 and more: no correlation matrix.
        if fit.converged and (largest == 1 or -1.0 / (largest - 1) < alike < 1.0):
            return np.asarray(fit.params), alike
    raise ConvergenceError("the estimating equations did not settle", where="clusters")


def _cluster_scores(
    y: np.ndarray, matrix: np.ndarray, groups: np.ndarray, eta: np.ndarray, correlation: float
) -> tuple[np.ndarray, np.ndarray]:
    """Scores D' V^-1 (y - mu), shape (k, p), and D' V^-1 D, shape (k, p, p), of the clusters."""
    mean = probability(eta)
    sd = np.sqrt(mean * (1.0 - mean))
    rows = np.column_stack((matrix * sd[:, None], (y - mean) / sd))
    sums = np.array([rows[groups == k].sum(axis=0) for k in range(groups.max() + 1)])
    products = np.array([rows[groups == k].T @ rows[groups == k] for k in range(len(sums))])
    share = correlation / (1.0 + (np.bincount(groups) - 1.0) * correlation)
    products -= share[:, None, None] * sums[:, :, None] * sums[:, None, :]
    products /= 1.0 - correlation
    return products[:, :-1, -1], products[:, :-1, :-1]


def sandwich(scores: np.ndarray, curvatures: np.ndarray, power: float) -> np.ndarray:
    """Return the covariance (p, p) of coefficients from what clusters add to score and curvature.

    ``scores``: (k, p); ``curvatures``: (k, p, p). The residuals of a cluster are divided by its
    (1 - leverage) to the ``power``: 0 Liang and Zeger, 1/2 Kauermann and Carroll, 1 Mancl and
    DeRouen.
    """
    root = np.linalg.cholesky(np.linalg.inv(curvatures.sum(axis=0)))
    leverage, axes = np.linalg.eigh(root.T @ curvatures @ root)
    own = np.einsum("kji,kj->ki", axes, scores @ root) * (1.0 - leverage) ** -power
    moved = np.einsum("kij,kj->ki", axes, own) @ root.T
    return np.asarray(moved.T @ moved)


def _flipped_p(y: np.ndarray, matrix: np.ndarray, groups: np.ndarray, column: int) -> float:
    """p of no effect of a column: its effective score against flipped signs of the clusters."""
    rest = np.arange(matrix.shape[1]) != column
    mean = float(y.mean())
    start = np.where(np.flatnonzero(rest) == 0, np.log(mean / (1.0 - mean)), 0.0)
    params, dependence = _estimate_equations(y, matrix[:, rest], groups, start)
    scores, curvatures = _cluster_scores(y, matrix, groups, matrix[:, rest] @ params, dependence)
    whole = curvatures.sum(axis=0)
    nuisance = np.linalg.solve(whole[np.ix_(rest, rest)], whole[rest, column])
    effective = scores[:, column] - scores[:, rest] @ nuisance
    count = len(effective)
    if count <= _ALL_FLIPS:
        signs = 1.0 - 2.0 * (np.arange(2**count)[:, None] >> np.arange(count) & 1)
    else:
        signs = np.random.default_rng(0).choice([-1.0, 1.0], (_FLIPS, count))
        signs[0] = 1.0  # what was seen is one of the flips
    sums = np.abs(signs @ effective)
    return float(np.mean(sums >= abs(effective.sum()) * (1.0 - 1e-9)))


@dataclass(frozen=True, slots=True)
class LogisticLine:
    """p(x) = 1 / (1 + exp(-(intercept + slope x))) given by two published numbers."""

    intercept: float
    slope: float
    source: str = ""

    def probability(self, x: float | np.ndarray) -> np.ndarray:
        """Return the slip probability at ``x``."""
        return 0.5 * (1.0 + np.tanh(0.5 * (self.intercept + self.slope * np.asarray(x, float))))

    def at_probability(self, probability: float) -> float:
        """Return the x at which the risk equals ``probability``."""
        _between(probability)
        return float((np.log(probability / (1.0 - probability)) - self.intercept) / self.slope)


@dataclass(frozen=True, slots=True)
class RiskCurve:
    """A fitted risk curve on a grid, with its band.

    ``x``, ``risk``, ``low``, ``high``: shape (m,). ``half``: x at a risk of one half, and its
    standard error (delta method).
    """

    name: str
    x: np.ndarray
    risk: np.ndarray
    low: np.ndarray
    high: np.ndarray
    half: float
    half_error: float
    method: str
    confidence: float


def risk_curve(
    fit: LogisticFit | ClusteredFit, x: np.ndarray | None = None, *, confidence: float = 0.95
) -> RiskCurve:
    """Return the risk curve of a logistic fit with one predictor, with a pointwise band.

    The band is symmetric on the logit: eta +- z sqrt(var(b0) + 2 x cov + x^2 var(b1)). It covers
    the curve, not single persons. With errors by person (``clustered_logistic``) it is as wide as
    the number of persons asks for.

    ``x``: where to evaluate, shape (m,); by default where the risk runs from 0.5 % to 99.5 %.

    InputError: a fit with several predictors, or a slope of zero.
    """
    from scipy.stats import norm

    if len(fit.coefficients) != 2:
        raise InputError(
            Message("{count} predictors", count=len(fit.coefficients) - 1),
            where="risk_curve",
            allowed="one",
        )
    _between(confidence)
    b0, b1 = fit.estimates
    if b1 == 0:
        raise InputError("the slope is zero", where="risk_curve")
    line = LogisticLine(float(b0), float(b1))
    if x is None:
        ends = sorted((line.at_probability(0.005), line.at_probability(0.995)))
        x = np.linspace(ends[0], ends[1], 201)
    x = np.asarray(x, dtype=float)
    rows = np.column_stack((np.ones_like(x), x))
    error = np.sqrt(np.einsum("ij,jk,ik->i", rows, fit.covariance, rows))
    eta = b0 + b1 * x
    z = float(norm.ppf(0.5 + confidence / 2))
    half = float(-b0 / b1)
    gradient = np.array([-1.0 / b1, b0 / b1**2])
    half_error = float(np.sqrt(gradient @ fit.covariance @ gradient))
    risk, low, high = (
        0.5 * (1.0 + np.tanh(0.5 * value)) for value in (eta, eta - z * error, eta + z * error)
    )
    name = fit.coefficients[1].name
    return RiskCurve(name, x, risk, low, high, half, half_error, fit.method, confidence)


def _between(value: float) -> None:
    if not 0.0 < value < 1.0:
        raise InputError(
            Message("{given} is not a probability", given=value),
            where="risk",
            allowed="between 0 and 1",
        )
