#!/usr/bin/env bash
# researchpy 0.3.7 (newest), NumPy 2.4.6, SciPy 1.17.1, pandas 2.3.3, patsy 1.0.2, statsmodels 0.15.0, Python 3.11.
# Expected: ttest(a, b, paired=True) prints "Difference < 0 p value" and "Difference > 0 p value" of the difference a - b, which
#   stands in the first line: where a is clearly the greater, the first is near 1 and the second small (Student's t;
#   scipy.stats.ttest_rel with alternative "less" and "greater"). Exchanging a and b exchanges the two.
# Happens: where t is positive, the two are exchanged once more. "Difference < 0" always has the smaller p value, whichever
#   way the difference points, and "Difference > 0" is never below 0.5. The same data without paired=True are right, and so
#   is the two-sided p value. No warning.
# Consequence: shoes on a dry and a wetted floor, the same walkers: "the friction is lower dry, p = 0.0002" where every number
#   says higher; a planned one-sided test of an increase can never succeed, one of a decrease succeeds in the wrong place.
# Seen: twelve walkers, dry - wet 0.0314, t 4.90: package "< 0" 0.0002, "> 0" 0.9998; SciPy less 0.9998, greater 0.0002; wet -
#   dry, t -4.90: package "< 0" 0.0002, right. 400 studies without a difference: "> 0" below 0.05 in none, by SciPy in 25.
set -euo pipefail
export OMP_NUM_THREADS=1
d=$(mktemp -d); trap 'rm -rf "$d"' EXIT
python3 -m venv "$d/v"
"$d/v/bin/pip" install -q --disable-pip-version-check --no-compile researchpy==0.3.7 numpy==2.4.6 scipy==1.17.1 pandas==2.3.3 \
  patsy==1.0.2 statsmodels==0.15.0
"$d/v/bin/python" -W ignore::FutureWarning - <<'P'
import numpy as np
import pandas as pd
import researchpy
from scipy import stats

dry = pd.Series([.517, .541, .517, .435, .545, .385, .587, .471, .518, .515, .501, .527], name="dry")
wet = pd.Series([.499, .517, .461, .424, .516, .373, .528, .452, .450, .517, .470, .475], name="wet")

def p(a, b, **kw):
    r = researchpy.ttest(a, b, **kw)[1]
    r = dict(zip(r.iloc[:, 0].str.strip(), r["results"]))
    return [float(r[k]) for k in ("t =", "Two side test p value =", "Difference < 0 p value =", "Difference > 0 p value =")]

for a, b in ((dry, wet), (wet, dry)):
    t, two, less, more = p(a, b, paired=True)
    right = [stats.ttest_rel(a, b, alternative=k).pvalue for k in ("two-sided", "less", "greater")]
    u = p(a, b)
    own = [stats.ttest_ind(a, b, alternative=k).pvalue for k in ("less", "greater")]
    print(f"{a.name} - {b.name} = {a.mean() - b.mean():.4f}, t {t:.2f}: package two-sided {two:.4f}, < 0 {less:.4f}, > 0 {more:.4f}; "
          f"right {right[0]:.4f}, {right[1]:.4f}, {right[2]:.4f}; not paired: package {u[2]:.4f}, {u[3]:.4f}, "
          f"right {own[0]:.4f}, {own[1]:.4f}")
    assert abs(two - right[0]) < 1e-4 and np.allclose(u[2:], own, atol=1e-4)
    assert less < .001 and more > .999
    assert (right[1] > .999 and right[2] < .001) if t > 0 else (right[1] < .001 and right[2] > .999)

rng = np.random.default_rng(3)
hits = np.zeros(2)
for _ in range(400):
    a, b = (pd.Series(v, name=n) for v, n in zip(rng.normal(0, 1, (2, 12)), "ab"))
    hits += p(a, b, paired=True)[3] < .05, stats.ttest_rel(a, b, alternative="greater").pvalue < .05
print(f"400 studies without a difference: '> 0' below 0.05 in {hits[0]:.0f} (package), {hits[1]:.0f} (SciPy)")
assert hits[0] == 0 and hits[1] > 8
P
