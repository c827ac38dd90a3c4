#!/usr/bin/env bash
# mcerp 1.1.1 (newest), NumPy 2.4.6, SciPy 1.17.1, Python 3.11.
# Expected: Weibull(lamda, k) has lamda as "the scale parameter" and k as the shape: 1 - exp(-(x/lamda)^k), mean
#   lamda Gamma(1 + 1/k). Its companion soerp, with the same arguments, is that.
# Happens: lamda goes into SciPy's exponentiated Weibull as the power of the distribution function, and the scale stays 1:
#   the samples are those of the greatest of lamda draws from a Weibull of scale 1. They hardly depend on lamda. Only
#   lamda = 1 is right. No warning.
# Consequence: lives in the thousands of steps, wind or wear depths with a Weibull law come out near 2, whatever the scale;
#   and in what unit it is given changes the answer's shape.
# Seen: Weibull(100, 2): mean 2.26, median 2.23; right 88.62 and 83.26 (SciPy, soerp); Weibull(1000, 2): mean 2.72, right
#   886.2; Weibull(1, 2): 0.886, right.
set -euo pipefail
export OMP_NUM_THREADS=1
d=$(mktemp -d); trap 'rm -rf "$d"' EXIT
python3 -m venv "$d/v"
"$d/v/bin/pip" install -q --disable-pip-version-check --no-compile mcerp==1.1.1 soerp==1.0.1 numpy==2.4.6 scipy==1.17.1
"$d/v/bin/python" - <<'P'
import math
import numpy as np
import mcerp
import soerp
from scipy.stats import weibull_min

np.random.seed(1)
got = {}
for scale in (1., 100., 1000.):
    w = mcerp.Weibull(scale, 2.)
    right = scale * math.gamma(1.5)
    got[scale] = float(w.mean)
    print(f"Weibull({scale:g}, 2): mean {w.mean:.3f} median {w.percentile(.5):.3f}; right mean {right:.3f} "
          f"median {weibull_min(2, scale=scale).median():.3f}; soerp mean {soerp.Weib(scale, 2.).mean:.3f}")
    assert abs(weibull_min(2, scale=scale).mean() - right) < 1e-9 * scale
    assert abs(soerp.Weib(scale, 2.).mean - right) < 1e-9 * scale
draws = np.random.default_rng(2).weibull(2, (4000, 100)).max(axis=1).mean()
print(f"mean of the greatest of 100 draws of scale 1: {draws:.3f}")
assert abs(got[100.] - 2.262) < .01 and abs(got[100.] - draws) < .03
assert abs(got[1000.] - 2.72) < .02 and abs(got[1.] - .886) < .002
P
