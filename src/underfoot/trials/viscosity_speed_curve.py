"""COF of all fluids against viscosity times speed (the report's Figure 16)."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import DataError, unknown_name

METHODS = {
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
    if method not in METHODS:
        raise unknown_name("method", method, METHODS, where="master_curve")
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
