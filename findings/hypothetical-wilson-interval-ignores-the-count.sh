#!/usr/bin/env bash
# hypothetical 0.3.0 (newest), NumPy 1.26.4, SciPy 1.13.1 (newer ones lack a function it imports), pandas 2.2.3, Python 3.11.
# Expected: BinomialTest(n, x).wilson_score_interval is Wilson's interval (JASA 1927) of the rate x/n: the rates p for
#   which |x/n - p| <= z sqrt(p (1 - p) / n). Textbook value: 3 slips of 40 gives 0.026 to 0.199.
# Happens: x is not in the formula: in its place stands p, the rate of the null hypothesis (0.5 by default). Every
#   count gives the same interval, around the hypothesis. With p = 0.1 it is one around 0.1. The Clopper-Pearson and
#   Agresti-Coull intervals in the same summary are right and contradict it. No warning.
# Consequence: a floor on which 3 of 40 walkers slip is reported with 35 to 65 per cent, one on which 37 slip too;
#   and the hypothesis always lies inside its own interval, so nothing is ever significant by it.
# Seen: n 40, x 0, 3, 20, 37: package 0.352 to 0.648 each time; Wilson 0.000 to 0.088, 0.026 to 0.199,
#   0.352 to 0.648, 0.801 to 0.974; Clopper-Pearson of x = 3 in the same object 0.016 to 0.204.
set -euo pipefail
export OMP_NUM_THREADS=1
d=$(mktemp -d); trap 'rm -rf "$d"' EXIT
python3 -m venv "$d/v"
"$d/v/bin/pip" install -q --disable-pip-version-check --no-compile hypothetical==0.3.0 numpy==1.26.4 scipy==1.13.1 pandas==2.2.3 statsmodels==0.14.4
"$d/v/bin/python" - <<'P'
from scipy.optimize import brentq
from scipy.stats import binomtest, norm
from hypothetical.hypothesis import BinomialTest

n, z = 40, norm.ppf(.975)
got, want = {}, {}
for x in (0, 3, 20, 37):
    b = BinomialTest(n, x, continuity=False)
    got[x] = tuple(float(v) for v in b.wilson_score_interval["interval"])
    f = lambda p: (x / n - p)**2 - z * z * p * (1 - p) / n          # the definition, solved
    want[x] = (brentq(f, 0, x / n) if x else 0.0, brentq(f, x / n + 1e-9, 1))
    ci = binomtest(x, n).proportion_ci(method="wilson")
    assert abs(ci.low - want[x][0]) < 1e-6 and abs(ci.high - want[x][1]) < 1e-6
    cp = b.clopper_pearson_interval["interval"]
    print(f"{x:2d} of {n}: package {got[x][0]:.3f} to {got[x][1]:.3f}, Wilson {want[x][0]:.3f} to {want[x][1]:.3f}, "
          f"Clopper-Pearson of the package {cp[0]:.3f} to {cp[1]:.3f}")
assert len(set(got.values())) == 1
assert abs(got[3][0] - .352) < .001 and abs(want[3][1] - .199) < .001
assert abs(got[20][0] - want[20][0]) < 1e-6                          # right when x/n happens to be p
low, high = BinomialTest(n, 3, p=.1, continuity=False).wilson_score_interval["interval"]
ci = binomtest(4, n).proportion_ci(method="wilson")                 # 4 of 40 is the hypothesis itself
print(f" 3 of 40, hypothesis 0.1: package {low:.3f} to {high:.3f}, which is the interval of 4 of 40")
assert abs(low - ci.low) < 1e-6 and abs(high - ci.high) < 1e-6
P
