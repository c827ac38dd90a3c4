#!/usr/bin/env bash
# psignifit 4.3 (newest), NumPy 2.4.6, SciPy 1.17.1, Python 3.11.
# Expected: Result.threshold(p) gives the stimulus of another proportion than the fitted one and its interval; "these CI are
#   only upper bounds", says the documentation: wide rather than narrow. The lower bound is below the upper, the estimate
#   between them. Right: the quantiles of the same quantity over the posterior of the same result, or a refit with that
#   proportion as the threshold, or a plain probit fit.
# Happens: the lower bound is made of the smallest threshold with the smallest width, the upper of the largest with the
#   largest. That widens above 0.5 only. Below, where a wide curve lies further left, the two work against each other: at
#   0.25 the interval is a third of the right one, at 0.10 and 0.05 it is upside down. No warning.
# Consequence: the friction demand at which 5 or 10 per cent of walkers slip, which is what one fits such a curve for, gets
#   an interval that is far too narrow, or reversed and therefore empty; sorted, its ends look exact to 0.015 where the
#   truth is a span of 0.075.
# Seen: 20 walkers at each of 8 demands, slips 0 0 1 3 10 14 19 19, 95 per cent: at 0.10 estimate 0.229, interval 0.235 to
#   0.220, posterior 0.190 to 0.265, refit 0.188 to 0.263, probit 0.197 to 0.255; at 0.05: 0.223 to 0.189, posterior
#   0.161 to 0.250; at 0.25: 0.256 to 0.271, posterior 0.237 to 0.291; at 0.90: 0.323 to 0.437, posterior 0.339 to 0.427.
set -euo pipefail
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
d=$(mktemp -d); trap 'rm -rf "$d"' EXIT
python3 -m venv "$d/v"
"$d/v/bin/pip" install -q --disable-pip-version-check --no-compile psignifit==4.3 numpy==2.4.6 scipy==1.17.1
"$d/v/bin/python" - <<'P'
import numpy as np
import psignifit as ps
from scipy.optimize import minimize
from scipy.stats import norm

x = np.array([.10, .15, .20, .25, .30, .35, .40, .45])
k = np.array([0, 0, 1, 3, 10, 14, 19, 19])
n = np.full(8, 20)
data = np.c_[x, k, n]
r = ps.psignifit(data, experiment_type="yes/no", sigmoid="norm", debug=True)
s = r.posterior_samples(20000, np.random.default_rng(1))
curve = r.configuration.make_sigmoid()

def probit(p):                                   # maximum likelihood and the delta method, nothing of psignifit
    f = lambda b: -(k * norm.logcdf(b[0] + b[1] * x) + (n - k) * norm.logsf(b[0] + b[1] * x)).sum()
    b = minimize(f, [-3., 10.], method="Nelder-Mead", options=dict(xatol=1e-9, fatol=1e-11, maxiter=9999)).x
    eta = b[0] + b[1] * x
    w = n * norm.pdf(eta)**2 / (norm.cdf(eta) * norm.sf(eta))
    cov = np.linalg.inv(np.array([[w.sum(), (w * x).sum()], [(w * x).sum(), (w * x * x).sum()]]))
    e = (norm.ppf(p) - b[0]) / b[1]
    g = np.array([-1 / b[1], -e / b[1]])
    se = np.sqrt(g @ cov @ g)
    return e - 1.96 * se, e + 1.96 * se

out = {}
for p in (.05, .10, .25, .50, .90):
    est, ci = r.threshold(np.array(p), unscaled=True)
    lo, hi = (float(v) for v in ci["0.95"])
    post = np.quantile(curve.inverse(p, s["threshold"], s["width"], 0, 0), [.025, .975])
    out[p] = float(est), lo, hi, post
    print(f"at {p:.2f}: estimate {float(est):.3f} interval {lo:.3f} to {hi:.3f}  posterior {post[0]:.3f} to {post[1]:.3f}  "
          f"probit {probit(p)[0]:.3f} to {probit(p)[1]:.3f}")
again = ps.psignifit(data, experiment_type="yes/no", sigmoid="norm", thresh_PC=.1).confidence_intervals["threshold"]["0.95"]
print(f"refit with the threshold at 0.10: {again[0]:.3f} to {again[1]:.3f}")
for p in (.05, .10):
    est, lo, hi, post = out[p]
    assert lo > hi and post[0] < est < post[1] and post[1] - post[0] > 4 * abs(hi - lo) * (p == .1)
est, lo, hi, post = out[.25]
assert 0 < hi - lo < .35 * (post[1] - post[0])
est, lo, hi, post = out[.5]
assert abs(lo - post[0]) < .006 and abs(hi - post[1]) < .006
est, lo, hi, post = out[.9]
assert lo < post[0] and hi > post[1]
assert abs(again[0] - out[.1][3][0]) < .02 and abs(again[1] - out[.1][3][1]) < .02
P
