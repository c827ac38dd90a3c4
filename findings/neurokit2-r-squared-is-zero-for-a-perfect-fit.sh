#!/usr/bin/env bash
# neurokit2 0.3.0 (newest), NumPy 2.4.6, SciPy 1.17.1, pandas 2.3.3, Python 3.11.
# Expected: fit_error() and fit_r2() give R squared = 1 - SSE / SST, with SST the sum of squares about the mean: 1 for a perfect
#   fit, 0 for the mean, the same in newton and in kilonewton; adjusted, 1 - (1 - R2) (n - 1) / (n - p).
# Happens: "R2" is SSE / SST, so that it is 0 for a perfect fit, and SST is n times the standard deviation instead of the
#   variance, so that it has the unit of the data: a force in newton instead of kilonewton changes R2 by 1000. The
#   adjusted value is turned the right way round but has the same SST. MSE and RMSE are right. No warning.
# Consequence: a line that explains 95 per cent of a force is reported with R2 = 10.1 and adjusted R2 = -9.3 in newton, and with
#   0.0101 and 0.990 in kilonewton; models compared by it are ranked by the scatter of their data.
# Seen: y = line + scatter, n = 40, SD of y 222 N: right R2 0.955, adjusted 0.953; package in N 10.06, -9.33; in kN 0.0101,
#   0.990; perfect fit 0 (right 1); the mean as the fit 221.8 in N (right 0).
set -euo pipefail
export OMP_NUM_THREADS=1 MPLBACKEND=Agg
d=$(mktemp -d); trap 'rm -rf "$d"' EXIT
python3 -m venv "$d/v"
"$d/v/bin/pip" install -q --disable-pip-version-check --no-compile neurokit2==0.3.0 numpy==2.4.6 scipy==1.17.1 pandas==2.3.3
"$d/v/bin/python" -W ignore - <<'P'
import numpy as np
import neurokit2 as nk
from scipy.stats import linregress

rng = np.random.default_rng(4)
x = np.arange(40.)
newton = 500 + 19 * x + rng.normal(0, 45, 40)
out = {}
for unit, k in (("N", 1.), ("kN", 1e-3)):
    y = newton * k
    r = linregress(x, y)
    fit = r.intercept + r.slope * x
    e = nk.fit_error(y, fit, n_parameters=2)
    right = 1 - ((y - fit)**2).sum() / ((y - y.mean())**2).sum()
    assert abs(right - r.rvalue**2) < 1e-12
    adj = 1 - (1 - right) * 39 / 38
    out[unit] = float(e["R2"]), float(e["R2_adjusted"]), right, adj, y.std()
    print(f"{unit:2s}: SD {y.std():.4g}  package R2 {e['R2']:.4g} adjusted {e['R2_adjusted']:.4g}  right {right:.4f} adjusted {adj:.4f}")
    assert abs(e["RMSE"] - np.sqrt(((y - fit)**2).mean())) < 1e-9
    assert abs(nk.fit_r2(y, fit, adjusted=False) - (1 - right) * y.std()) < 1e-9
perfect = nk.fit_error(newton, newton.copy())["R2"]
mean = nk.fit_error(newton, np.full(40, newton.mean()))["R2"]
print(f"perfect fit: package {perfect}, right 1; the mean as the fit: package {mean:.1f}, right 0")
assert perfect == 0 and mean > 100
assert out["N"][2] > .9 and out["N"][0] > 1 and out["N"][1] < 0
assert abs(out["N"][0] / out["kN"][0] - 1000) < 1e-6 and abs(out["N"][2] - out["kN"][2]) < 1e-12
P
