#!/usr/bin/env bash
# hypothetical 0.3.0 (newest), NumPy 1.26.4, SciPy 1.13.1 (newer ones lack a function it imports), pandas 2.2.3, Python 3.11.
# Expected: McNemarTest(table) compares two yes/no results of the same subjects: chi squared =
#   (|n12 - n21| - 1)^2 / (n12 + n21) (McNemar, Psychometrika 1947; Edwards' correction), as its own documentation
#   writes. The pairs that agree, n11 and n22, do not enter.
# Happens: with the correction, the default, it is (|n11 - n22| - 1)^2 / (n11 + n22): the pairs that agree are tested.
#   Without the correction the numerator is of the pairs that agree and the denominator of those that differ. Its
#   asymptotic z, in the same summary, is of the right cells. No warning.
# Consequence: 40 walkers on two floors, 19 slip on neither, 1 on both, 10 on the first only and 10 on the second only:
#   no difference at all, but the package reports p = 0.0001. Where the first is clearly worse (12 against 1), it finds
#   none.
# Seen: [[1, 10], [10, 19]]: package chi2 14.45, p 0.0001, right 0.05, p 0.82;
#   [[14, 12], [1, 13]]: package 0.00, p 1.00, right 7.69, p 0.0055.
set -euo pipefail
export OMP_NUM_THREADS=1
d=$(mktemp -d); trap 'rm -rf "$d"' EXIT
python3 -m venv "$d/v"
"$d/v/bin/pip" install -q --disable-pip-version-check --no-compile hypothetical==0.3.0 numpy==1.26.4 scipy==1.13.1 pandas==2.2.3 statsmodels==0.14.4
"$d/v/bin/python" - <<'P'
import numpy as np
from scipy.stats import binom, chi2
from statsmodels.stats.contingency_tables import mcnemar
from hypothetical.contingency import McNemarTest

def right(t, c):
    x = (abs(t[0, 1] - t[1, 0]) - c)**2 / (t[0, 1] + t[1, 0])
    s = mcnemar(t, exact=False, correction=bool(c))
    assert abs(s.statistic - x) < 1e-9 and abs(s.pvalue - chi2.sf(x, 1)) < 1e-9
    return x, chi2.sf(x, 1)

out = {}
for name, t in (("no difference", [[1, 10], [10, 19]]), ("first floor worse", [[14, 12], [1, 13]])):
    t = np.array(t)
    for c in (1, 0):
        m = McNemarTest(t, continuity=bool(c))
        w, pw = right(t, c)
        out[name, c] = float(m.mcnemar_x2_statistic), float(m.mcnemar_p_value), w, pw
        print(f"{name} {t.tolist()} correction {c}: package chi2 {m.mcnemar_x2_statistic:.2f} p {m.mcnemar_p_value:.4f}, "
              f"right {w:.2f} p {pw:.4f}; its own z squared {m.z_asymptotic_statistic**2:.2f}")
        assert abs(m.z_asymptotic_statistic**2 - w) < 1e-9
    n, k = t[0, 1] + t[1, 0], min(t[0, 1], t[1, 0])
    print("   exact, by the binomial:", round(min(1, 2 * binom.cdf(k, n, .5)), 4))
a, b = out["no difference", 1], out["first floor worse", 1]
assert a[1] < .001 < .8 < a[3] and abs(a[0] - 14.45) < .01
assert b[1] > .99 and b[3] < .006 and abs(b[2] - 7.69) < .01
P
