#!/usr/bin/env bash
# GTC 1.5.1 (newest), NumPy 2.4.6, SciPy 1.17.1, Python 3.11.
# Expected: type_a.estimate_digitized(readings, step) follows Willink (Metrologia 44, 2007, 73-81): when the readings show two
#   neighbouring digits only, the uncertainty of their mean is at least |middle - mean| / sqrt(3), because the true value may
#   lie anywhere between. Adding 100 to every reading changes nothing: 19 readings of 0.0 and one of 0.1 give 0.0260.
# Happens: "one step apart" is tested with an absolute tolerance of ten times the machine's epsilon, 2.2e-15. 100.1 - 100.0
#   differs from 0.1 by 6e-15, so the rule is missed and the plain standard deviation of the mean is returned: 0.0050. Which
#   it is depends on the digits: 20.4 and 20.5 are right, 101.3 and 101.4 are not; from about 32 on every pair can fall out.
# Consequence: a balance, a force display in newton or a thermometer that flickers between two digits gets a fifth of its
#   uncertainty, with 19 degrees of freedom to vouch for it, near zero the right one.
# Seen: 19 x b and 1 x b + 0.1, step 0.1: b = 0 0.0260, 20.3 0.0260, 100 0.0050, 1000 0.0050, right 0.0260;
#   simulated: share of true values inside the 95 per cent interval 1.00 at b = 0, 0.64 at b = 700.
set -euo pipefail
export OMP_NUM_THREADS=1
d=$(mktemp -d); trap 'rm -rf "$d"' EXIT
python3 -m venv "$d/v"
"$d/v/bin/pip" install -q --disable-pip-version-check --no-compile GTC==1.5.1 numpy==2.4.6 scipy==1.17.1
"$d/v/bin/python" - <<'P'
from decimal import Decimal
import math
import numpy as np
from scipy.stats import t as student
from GTC import ta, uncertainty, value

def right(readings, step):                       # Willink's rule in decimal numbers
    x = [Decimal(str(r)) for r in readings]
    n, mu = len(x), sum(x) / len(x)
    var = sum((v - mu)**2 for v in x) / (n - 1) / n
    if max(x) - min(x) == Decimal(str(step)):
        var = max(var, ((max(x) + min(x)) / 2 - mu)**2 / 3)
    return math.sqrt(var)

seen = {}
for b in (0., 20.3, 100., 1000.):
    d = [b] * 19 + [round(b + .1, 1)]
    u = uncertainty(ta.estimate_digitized(d, .1))
    seen[b] = u
    print(f"19 x {b}, 1 x {d[-1]}: package {u:.4f}, right {right(d, .1):.4f}; the same less {b:g}: "
          f"{uncertainty(ta.estimate_digitized([round(v - b, 1) for v in d], .1)):.4f}")
    assert abs(right(d, .1) - .02598) < 1e-5
assert abs(seen[0.] - .02598) < 1e-5 and abs(seen[20.3] - .02598) < 1e-5
assert abs(seen[100.] - .005) < 1e-6 and abs(seen[1000.] - .005) < 1e-6

def share(b, seed=1, n=20):                      # true values anywhere, noise of a sixth of a step, two digits shown
    rng, hit, all_ = np.random.default_rng(seed), 0, 0
    while all_ < 1500:
        true = rng.uniform(.0, .1)
        d = [round(b + round(float(v), 1), 1) for v in true + rng.normal(0, .017, n)]
        if len(set(d)) != 2:
            continue
        r = ta.estimate_digitized(d, .1)
        hit += abs(value(r) - b - true) <= student.ppf(.975, n - 1) * uncertainty(r)
        all_ += 1
    return hit / all_
a, c = share(0.), share(700.)
print(f"true value inside the 95 per cent interval: readings near 0 {a:.2f}, near 700 {c:.2f}")
assert a > .93 and c < .75
P
