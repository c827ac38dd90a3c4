"""COF against speed (Eq. 17 fitted, with its uncertainty) and against viscosity times speed."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import DataError, unknown_name
from underfoot.core.remark import Message


def linear_part(
    x: np.ndarray, y: np.ndarray, tau: np.ndarray, start: float | None, end: float | None
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return (end, start, residual sum) of y = end + (start - end) exp(-x / tau), each (m,).

    Both levels are kept at zero or above; a given ``start`` or ``end`` is not fitted.

    ``x`` and ``y``: shape (n,). ``tau``: decay constants to try, shape (m,).
    """
    e = np.exp(-x / np.maximum(tau[:, None], 1e-300))
    rise = 1.0 - e
    if start is not None or end is not None:

        def level(given: float | None, shape: np.ndarray, rest: np.ndarray) -> np.ndarray:
            if given is not None:
                return np.full(len(tau), given)
            return np.maximum((shape * rest).sum(axis=1) / _positive((shape**2).sum(axis=1)), 0.0)

        a, b = level(end, rise, y - (start or 0.0) * e), level(start, e, y - (end or 0.0) * rise)
    else:
        saa, sbb, sab = (rise**2).sum(axis=1), (e**2).sum(axis=1), (rise * e).sum(axis=1)
        ra, rb = rise @ y, e @ y
        det = saa * sbb - sab**2
        safe = det > 1e-12 * saa * sbb
        a = np.where(safe, (sbb * ra - sab * rb) / np.where(safe, det, 1.0), -1.0)
        b = np.where(safe, (saa * rb - sab * ra) / np.where(safe, det, 1.0), -1.0)
        # On a bound the other level is fitted alone; the better of the two bounds is taken.
        only_b = np.maximum(rb / _positive(sbb), 0.0)
        only_a = np.maximum(ra / _positive(saa), 0.0)
        gain_b = 2 * only_b * rb - only_b**2 * sbb
        gain_a = 2 * only_a * ra - only_a**2 * saa
        outside = (a < 0) | (b < 0)
        use_b = gain_b >= gain_a
        a = np.where(outside, np.where(use_b, 0.0, only_a), a)
        b = np.where(outside, np.where(use_b, only_b, 0.0), b)
    residual = y - a[:, None] * rise - b[:, None] * e
    return a, b, (residual**2).sum(axis=1)


def best_decay(
    x: np.ndarray,
    y: np.ndarray,
    low: float,
    high: float,
    *,
    start: float | None = None,
    end: float | None = None,
    points: int = 160,
) -> tuple[float, float, float, float]:
    """Return (end, start, tau, residual sum) of the best decay with tau in [low, high].

    A logarithmic grid finds the valley, golden sections narrow it down: nothing to start from.
    """

    def at(log_tau: np.ndarray) -> np.ndarray:
        return linear_part(x, y, np.exp(log_tau), start, end)[2]

    log_tau = _minimum(at, np.log(low), np.log(high), points)
    a, b, rss = linear_part(x, y, np.exp(np.array([log_tau])), start, end)
    return float(a[0]), float(b[0]), float(np.exp(log_tau)), float(rss[0])


def _minimum(
    function: Callable[[np.ndarray], np.ndarray], low: float, high: float, points: int
) -> float:
    """Return the place of the lowest value: grids of shrinking width around the best point."""
    grid = np.linspace(low, high, points)
    best = low
    for _ in range(14):
        values = function(grid)
        i = int(np.argmin(values))
        best = float(grid[i])
        left, right = grid[max(i - 1, 0)], grid[min(i + 1, len(grid) - 1)]
        if right - left < 1e-10:
            break
        grid = np.linspace(left, right, 21)
    return best


def _positive(values: np.ndarray) -> np.ndarray:
    return np.maximum(values, 1e-300)


METHODS = {
    "separable": "separable bounded least squares (grid over tau, linear in the two levels)",
    "nelder_mead": "bounded Nelder-Mead simplex (the grant report's method)",
}
GOOD, MODERATE = 0.8, 0.5  # R^2, the report's rule (G.2.1)
NOT_IDENTIFIED = "not identified in this speed range"


@dataclass(frozen=True, slots=True)
class FitParameter:
    """One parameter of Eq. 17.

    ``value`` is None where the report's rule gives none; ``standard_error``, from the curvature at
    the optimum, is None on a bound; ``low`` and ``high``, the profile-likelihood interval, are None
    where the profile does not close. ``identified``: False where the speeds don't tell it;
    ``remark`` says so.
    """

    name: str
    value: float | None
    unit: str = "1"
    standard_error: float | None = None
    low: float | None = None
    high: float | None = None
    remark: str = ""
    identified: bool = True


@dataclass(frozen=True, slots=True)
class StribeckFit:
    """Eq. 17: COF = asymptote + (boundary - asymptote) exp(-speed / tau).

    ``verdict`` is the report's rule: "good" (R^2 above 0.8), "moderate" (0.5 to 0.8) or "mean"
    (the fit is dropped, COF_BL is the mean COF, the others have no value).
    """

    boundary: FitParameter
    tau: FitParameter
    asymptote: FitParameter
    r_squared: float
    residual_sum: float
    n: int
    method: str
    verdict: str
    speed: np.ndarray
    cof: np.ndarray
    raw: tuple[float, float, float]
    warnings: tuple[str, ...] = ()

    def curve(self, speed: np.ndarray) -> np.ndarray:
        """Return the fitted COF at ``speed`` (m/s); the mean where the rule dropped the fit."""
        if self.verdict == "mean":
            return np.full(np.shape(speed), float(self.cof.mean()))
        boundary, tau, asymptote = self.raw
        return asymptote + (boundary - asymptote) * np.exp(-np.asarray(speed) / tau)


def stribeck_fit(
    speed: ArrayLike,
    cof: ArrayLike,
    *,
    method: str = "separable",
    boundary: float | None = None,
    confidence: float = 0.95,
) -> StribeckFit:
    """Return the fit of Eq. 17 to COF against speed.

    Both levels are kept at zero or above, as in the report. Intervals are profile likelihoods:
    the residual sum rises by the factor 1 + t^2 / (n - p). A parameter is "not identified in this
    speed range" when its profile does not close, or when tau exceeds the largest speed (the
    report's own remark for water).

    ``speed`` (n,) is in m/s, positive, repeats are welcome; ``method`` is ``"separable"`` or
    ``"nelder_mead"``; a known COF_BL (for example from a test at 0.01 m/s) is given as ``boundary``
    and not fitted. Fewer than one more speed than parameters, missing values and negative speeds
    are a DataError.

    Source: grant report G.2.1, Eq. 17. Separable: G. H. Golub, V. Pereyra, SIAM J. Numer. Anal.
    10 (1973) 413.
    """
    v, y = np.asarray(speed, dtype=float), np.asarray(cof, dtype=float)
    if method not in METHODS:
        raise unknown_name("method", method, METHODS, where="stribeck_fit")
    free = 3 if boundary is None else 2
    if v.shape != y.shape or not (np.isfinite(v).all() and np.isfinite(y).all()):
        raise DataError("speeds and COF must match and be finite", where="stribeck_fit")
    if (v < 0).any() or v.max(initial=0.0) <= 0:
        raise DataError("speeds must be positive", where="stribeck_fit")
    distinct = np.unique(v)
    if len(distinct) < free + 1 or np.ptp(y) == 0:
        raise DataError(
            Message(
                "{count} different speeds for {free} parameters", count=len(distinct), free=free
            ),
            where="stribeck_fit",
            allowed=Message("at least {free} speeds and a COF that varies", free=free + 1),
        )
    gaps = np.diff(np.concatenate(([0.0], distinct)))
    low, high = 0.05 * float(gaps[gaps > 0].min()), 1e3 * float(v.max())
    if method == "separable":
        asymptote, start, tau, rss = best_decay(v, y, low, high, start=boundary)
    else:
        asymptote, start, tau, rss = _nelder_mead(v, y, low, high, boundary)
    total = float(np.sum((y - y.mean()) ** 2))
    r_squared = 1.0 - rss / total
    verdict = "good" if r_squared > GOOD else "moderate" if r_squared >= MODERATE else "mean"
    warnings = []
    if tau > 0.99 * high or tau < 1.01 * low:
        warnings.append("tau lies on the edge of its search range: the data don't bend")
    if verdict == "mean":
        warnings.append(
            Message(
                "R^2 {r_squared:.2f} is below {moderate}: COF_BL is the mean COF",
                r_squared=r_squared, moderate=MODERATE,
            )
        )  # fmt: skip
        mean = float(y.mean())
        error = float(y.std(ddof=1) / np.sqrt(len(y)))
        why = Message("R^2 below {moderate}", moderate=MODERATE)
        parameters = (
            FitParameter("cof_bl", mean, "1", error, remark="mean COF"),
            FitParameter("tau_hydro", None, "m/s", remark=why, identified=False),
            FitParameter("cof_asymptote", None, remark=why, identified=False),
        )
    else:
        parameters = _parameters(v, y, (asymptote, start, tau, rss), boundary, confidence)
        if tau > v.max():
            warnings.append(
                Message(
                    "tau {tau:.3g} m/s exceeds the largest speed {fastest:.3g} m/s",
                    tau=tau, fastest=v.max(),
                )
            )  # fmt: skip
    raw = start, tau, asymptote
    quality = r_squared, rss, len(y), method, verdict
    return StribeckFit(*parameters, *quality, v, y, raw, tuple(warnings))


def _parameters(
    v: np.ndarray,
    y: np.ndarray,
    best: tuple[float, float, float, float],
    boundary: float | None,
    confidence: float,
) -> tuple[FitParameter, FitParameter, FitParameter]:
    from scipy.stats import t as student

    asymptote, start, tau, rss = best
    free = 3 if boundary is None else 2
    df = len(y) - free
    errors = _errors(v, asymptote, start, tau, rss / df, boundary is None)
    # Rounding leaves a residual even in exact data; profiles can't be narrower than that.
    least = len(y) * (1e-8 * float(np.ptp(y))) ** 2
    limit = max(rss, least) * (1.0 + float(student.ppf(0.5 + confidence / 2, df)) ** 2 / df)
    low, high = 1e-4 * float(v.max()), 1e4 * float(v.max())

    def of_tau(value: float) -> float:
        return float(linear_part(v, y, np.array([value]), boundary, None)[2][0])

    def of_asymptote(value: float) -> float:
        return best_decay(v, y, low, high, start=boundary, end=value)[3]

    def of_boundary(value: float) -> float:
        return best_decay(v, y, low, high, start=value)[3]

    scale = float(np.ptp(y))
    ends = {"cof_asymptote": _interval(of_asymptote, asymptote, limit, 0.02 * scale, 20 * scale)}
    ends["tau_hydro"] = _log_interval(of_tau, tau, limit, low, high)
    if boundary is None:
        ends["cof_bl"] = _interval(of_boundary, start, limit, 0.02 * scale, 20 * scale)

    def parameter(name: str, value: float, unit: str = "1") -> FitParameter:
        bottom, top = ends.get(name, (None, None))
        beyond = name == "tau_hydro" and tau > v.max()
        unknown = name in ends and (bottom is None or top is None or beyond)
        remark = NOT_IDENTIFIED if unknown else "" if name in ends else "given"
        return FitParameter(name, value, unit, errors.get(name), bottom, top, remark, not unknown)

    first, last = parameter("cof_bl", start), parameter("cof_asymptote", asymptote)
    return first, parameter("tau_hydro", tau, "m/s"), last


def _errors(
    v: np.ndarray, asymptote: float, start: float, tau: float, variance: float, fit_start: bool
) -> dict[str, float]:
    """Return standard errors from the Jacobian; none for a level on its bound."""
    e = np.exp(-v / tau)
    columns = {"cof_asymptote": 1.0 - e, "tau_hydro": (start - asymptote) * e * v / tau**2}
    if fit_start:
        columns["cof_bl"] = e
    if asymptote <= 0.0:
        columns.pop("cof_asymptote")
    if fit_start and start <= 0.0:
        columns.pop("cof_bl")
    jacobian = np.column_stack(list(columns.values()))
    normal = jacobian.T @ jacobian
    if np.linalg.cond(normal) > 1e14:
        return {}
    variances = np.diag(np.linalg.inv(normal)) * variance
    return {name: float(np.sqrt(var)) for name, var in zip(columns, variances, strict=True)}


def _interval(
    function: Callable[[float], float], best: float, limit: float, step: float, reach: float
) -> tuple[float | None, float | None]:
    """Return where a residual sum passes ``limit`` on both sides; a bound at zero is no end."""
    if function(best) >= limit:
        return None, None
    ends: list[float | None] = [None, None]
    for side, direction in enumerate((-1.0, 1.0)):
        inner, width = best, step
        while abs(inner - best) < reach and not (direction < 0 and inner <= 0.0):
            outer = max(inner + direction * width, 0.0)
            if function(outer) > limit:
                ends[side] = _passes(function, limit, inner, outer, xtol=1e-8)
                break
            inner, width = outer, 1.5 * width
    return ends[0], ends[1]


def _log_interval(
    function: Callable[[float], float], best: float, limit: float, low: float, high: float
) -> tuple[float | None, float | None]:
    """Return where a residual sum of a logarithm passes ``limit``, within ``low`` to ``high``."""
    if function(best) >= limit:
        return None, None
    ends: list[float | None] = [None, None]
    for side, (factor, stop) in enumerate(((0.8, low), (1.25, high))):
        inner = best
        while (inner > stop) == (factor < 1) and inner != stop:
            outer = inner * factor
            if function(outer) > limit:
                a, b = np.log(inner), np.log(outer)
                log = _passes(lambda x: function(float(np.exp(x))), limit, a, b)
                ends[side] = float(np.exp(log))
                break
            inner = outer
    return ends[0], ends[1]


def _passes(
    function: Callable[[float], float], limit: float, a: float, b: float, xtol: float = 2e-12
) -> float:
    from scipy.optimize import brentq

    root: Any = brentq(lambda x: function(x) - limit, a, b, xtol=xtol)
    return float(root)


def _nelder_mead(
    v: np.ndarray, y: np.ndarray, low: float, high: float, boundary: float | None
) -> tuple[float, float, float, float]:
    from scipy.optimize import minimize

    def levels(p: np.ndarray) -> tuple[float, float, float]:
        return (p[0], boundary, p[1]) if boundary is not None else (p[0], p[2], p[1])

    def residual_sum(p: np.ndarray) -> float:
        end, start, tau = levels(p)
        return float(np.sum((end + (start - end) * np.exp(-v / tau) - y) ** 2))

    # Start where a reader would: the slowest and the fastest COF, a third of the speeds.
    first = [float(y[np.argmax(v)]), float(v.max()) / 3.0, float(y[np.argmin(v)])]
    bounds = [(0.0, None), (low, high), (0.0, None)]
    count = 2 if boundary is not None else 3
    found = minimize(
        residual_sum,
        first[:count],
        method="Nelder-Mead",
        bounds=bounds[:count],
        options={"xatol": 1e-8, "fatol": 1e-12, "maxiter": 4000, "maxfev": 8000},
    )
    end, start, tau = levels(found.x)
    return float(end), float(start), float(tau), float(found.fun)


CURVES = {
    "isotonic": "decreasing steps (isotonic regression): no shape assumed but the fall",
    "spline": "cubic smoothing spline in log10, smoothness by generalised cross-validation",
}


@dataclass(frozen=True, slots=True)
class MasterCurve:
    """One curve through all conditions.

    ``product``: viscosity times speed (N/m), ascending, shape (n,). ``cof`` and ``fitted``:
    measured and fitted COF, shape (n,). ``residual_sd``: scatter about the curve: the price of
    taking all fluids as one. ``r_squared``: share of the variation that the product of viscosity
    and speed describes.
    """

    product: np.ndarray
    cof: np.ndarray
    fitted: np.ndarray
    residual_sd: float
    r_squared: float
    method: str

    def __call__(self, product: np.ndarray) -> np.ndarray:
        """Return the COF at ``product`` (N/m), interpolated in log10; constant outside."""
        return np.interp(np.log10(product), np.log10(self.product), self.fitted)


def master_curve(
    viscosity: ArrayLike, speed: ArrayLike, cof: ArrayLike, *, method: str = "isotonic"
) -> MasterCurve:
    """Return the curve of COF against log10(viscosity x speed).

    ``viscosity``, ``speed``, ``cof``: shape (n,): Pa s, m/s, 1. ``method``: ``"isotonic"`` or
    ``"spline"``.

    DataError: fewer than six points, values missing or not positive.
    """
    eta, v, y = (np.asarray(a, dtype=float) for a in (viscosity, speed, cof))
    if method not in CURVES:
        raise unknown_name("method", method, CURVES, where="master_curve")
    if not (eta.shape == v.shape == y.shape) or len(y) < 6:
        raise DataError("a master curve needs six complete points", where="master_curve")
    if not (np.isfinite(y).all() and (eta > 0).all() and (v > 0).all()):
        raise DataError("viscosity and speed must be positive, COF finite", where="master_curve")
    product = eta * v
    order = np.argsort(product, kind="stable")
    product, y = product[order], y[order]
    # Points at one place count as one with their mean, or the fit would depend on their order.
    unique, which, count = np.unique(product, return_inverse=True, return_counts=True)
    means = np.bincount(which, weights=y) / count
    if method == "isotonic":
        from scipy.optimize import isotonic_regression

        at_unique = isotonic_regression(means, weights=count.astype(float), increasing=False).x
        parameters = len(np.unique(np.round(at_unique, 12)))
    else:
        from scipy.interpolate import make_smoothing_spline

        if len(unique) < 5:
            raise DataError("a spline needs five different products", where="master_curve")
        spline = make_smoothing_spline(np.log10(unique), means, w=count.astype(float))
        at_unique, parameters = spline(np.log10(unique)), 4
    fitted = np.asarray(at_unique)[which]
    residual = y - fitted
    total = float(np.sum((y - y.mean()) ** 2))
    rss = float(residual @ residual)
    sd = float(np.sqrt(rss / max(len(y) - parameters, 1)))
    return MasterCurve(product, y, fitted, sd, 1.0 - rss / total if total else 0.0, method)
