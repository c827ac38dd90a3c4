#!/usr/bin/env bash
# pingouin 0.7.0 (newest), NumPy 2.4.6, SciPy 1.17.1, pandas 2.3.3, statsmodels 0.15.0, Python 3.11.
# Expected: chi2_independence() gives the power of the test at the effect it found. Cohen's effect size is
#   w = sqrt(chi2 / n) (Cohen 1988, chapter 7), which is Cramer's V times sqrt(min(rows, columns) - 1); power_chi2() of the
#   same package is documented to take w.
# Happens: V is passed as w. For tables with two rows or two columns both are the same; from 3 x 3 on the power is that of
#   an effect smaller by sqrt(2), sqrt(3), ... No warning.
# Consequence: three shoes on three floors, slips counted in three grades: a study with power 0.91 is reported as having
#   0.60, and one plans nearly twice the walkers, or takes a null result for a weak study.
# Seen: 3 x 3 table, n = 120, chi2 15.84, V 0.257, w 0.363: pingouin 0.600, noncentral chi squared and statsmodels 0.909;
#   share of 3000 simulated studies with p < 0.05: 0.923. Its first two rows alone: 0.508 in all three.
set -euo pipefail
export OMP_NUM_THREADS=1
d=$(mktemp -d); trap 'rm -rf "$d"' EXIT
python3 -m venv "$d/v"
"$d/v/bin/pip" install -q --disable-pip-version-check --no-compile pingouin==0.7.0 numpy==2.4.6 scipy==1.17.1 pandas==2.3.3 statsmodels==0.15.0
"$d/v/bin/python" -W ignore - <<'P'
import numpy as np
import pandas as pd
import pingouin as pg
from scipy.stats import chi2, chi2_contingency, ncx2
from statsmodels.stats.power import GofChisquarePower

def study(t):
    t = np.array(t)
    rows, cols = np.indices(t.shape)
    d = pd.DataFrame({"shoe": np.repeat(rows.ravel(), t.ravel()), "slip": np.repeat(cols.ravel(), t.ravel())})
    r = pg.chi2_independence(d, "shoe", "slip", correction=False)[2]
    r = r[r["test"] == "pearson"].iloc[0]
    x, p, dof, _ = chi2_contingency(t, correction=False)
    n = t.sum()
    w = np.sqrt(x / n)
    right = float(ncx2.sf(chi2.ppf(.95, dof), dof, n * w * w))
    sm = float(GofChisquarePower().power(w, n, .05, n_bins=dof + 1))
    assert abs(sm - right) < 1e-6 and abs(r["chi2"] - x) < 1e-3
    assert abs(float(pg.power_chi2(dof=dof, w=w, n=n)) - right) < 1e-6
    print(f"{t.shape[0]} x {t.shape[1]}, n {n}: chi2 {x:.2f} V {r['cramer']:.3f} w {w:.3f}; "
          f"chi2_independence power {r['power']:.3f}, with w {right:.3f}, statsmodels {sm:.3f}")
    return float(r["power"]), right, t

got, right, t = study([[22, 12, 6], [13, 14, 13], [7, 13, 20]])
rng = np.random.default_rng(1)
sims = [chi2_contingency(rng.multinomial(t.sum(), t.ravel() / t.sum()).reshape(t.shape), correction=False)[1] < .05
        for _ in range(3000)]
print(f"share of 3000 simulated studies with p < 0.05: {np.mean(sims):.3f}")
assert got < right - .2 and abs(np.mean(sims) - right) < .05
two = study(t[:2])
assert abs(two[0] - two[1]) < .001
P
