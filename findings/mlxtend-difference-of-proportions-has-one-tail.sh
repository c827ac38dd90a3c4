#!/usr/bin/env bash
# mlxtend 0.25.0 (newest), NumPy 2.4.6, SciPy 1.17.1, pandas 2.3.3, scikit-learn 1.9.1, Matplotlib 3.10.8, statsmodels 0.15.0,
# Python 3.11.
# Expected: proportion_difference(p1, p2, n1, n2) returns z and the p value of the difference of two proportions; its guide
#   tests the hypothesis that they are equal, rejects above |z| = 1.96, and takes a p value below 0.05 as the same thing.
#   Exchanging the two proportions does not change p. Two-sided: 2 P(Z > |z|).
# Happens: the p value is P(Z < z): half of the right one where the first proportion is the smaller, near 1 where it is the
#   greater. z is right. No warning, no word of a side in the documentation; permutation_test of the same package is
#   two-sided unless asked. In the guide's own example z is -1.754, p 0.040, and it concludes that they differ.
# Consequence: slips with two shoes, 40 of 100 and 20 of 100: p = 0.999, no difference; typed in the other order p = 0.001. A
#   difference of z = -1.75 is called significant at 5 per cent. A tenth of all equal pairs would be, in one of the orders.
# Seen: 0.40 and 0.20 of 100: z 3.16, p 0.9992; exchanged p 0.0008; right 0.0016 both times; 0.84 and 0.92 of 100: p 0.0397,
#   right 0.079; 4000 pairs with equal rates, p below 0.05 in one of the two orders: 10 per cent, two-sided right 5.
set -euo pipefail
export OMP_NUM_THREADS=1 MPLBACKEND=Agg
d=$(mktemp -d); trap 'rm -rf "$d"' EXIT
python3 -m venv "$d/v"
"$d/v/bin/pip" install -q --disable-pip-version-check --no-compile mlxtend==0.25.0 numpy==2.4.6 scipy==1.17.1 pandas==2.3.3 \
  scikit-learn==1.9.1 matplotlib==3.10.8 statsmodels==0.15.0
"$d/v/bin/python" - <<'P'
import numpy as np
from mlxtend.evaluate import proportion_difference
from scipy.stats import norm
from statsmodels.stats.proportion import test_proportions_2indep

def case(a, b, n):
    z, p = proportion_difference(a, b, n)
    right = 2 * norm.sf(abs(z))
    sm = test_proportions_2indep(a * n, n, b * n, n, method="wald")
    print(f"{a:.2f} and {b:.2f} of {n}: z {z:.3f}, p {p:.4f}; right {right:.4f}; statsmodels z {sm.statistic:.3f}, p {sm.pvalue:.4f}")
    assert abs(sm.statistic - z) < 1e-9 and abs(sm.pvalue - right) < 1e-9
    return p, right

p, right = case(.40, .20, 100)
assert p > .999 and abs(right - .0016) < 1e-4
p, right = case(.20, .40, 100)
assert p < .001 and abs(p / right - .5) < 1e-9
p, right = case(.84, .92, 100)                                            # the guide's example
assert p < .05 < right
rng = np.random.default_rng(1)
x = rng.binomial(300, .3, (4000, 2)) / 300
pa = np.array([proportion_difference(a, b, 300)[1] for a, b in x])
pb = np.array([proportion_difference(b, a, 300)[1] for a, b in x])
z = np.array([proportion_difference(a, b, 300)[0] for a, b in x])
either, two = np.mean(np.minimum(pa, pb) < .05), np.mean(2 * norm.sf(abs(z)) < .05)
print(f"4000 pairs of equal rates: p below 0.05 in one of the orders {either:.3f}, two-sided {two:.3f}")
assert either > .09 and two < .06
P
