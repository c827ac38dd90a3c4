#!/usr/bin/env bash
# soerp 1.0.1 (newest), NumPy 2.4.6, SciPy 1.17.1, Python 3.11.
# Expected: soerp is second order error propagation: exact for a square. Of x with mean zero and variance s^2, x**2 has
#   mean s^2 (for every distribution) and, for a normal one, variance 2 s^4; x**2 and x*x are the same.
# Happens: where the mean is zero (below 1e-10) the power has a branch of its own, and there the second derivative of x**2
#   is set to 1 instead of 2: mean 1/2 s^2, variance a quarter. x*x is right, and so is x**2 with a mean of 1e-9. Skewness
#   and kurtosis do not change, so that the shape looks right. No warning.
# Consequence: quadratic terms of centred errors (tilt of a plate squared, cosine and alignment errors, squares of offsets)
#   carry half of their bias and a quarter of their variance into the budget. A tilt of 0 with u = 1 degree loses half of
#   the mean cosine error.
# Seen: N(0, 1): x**2 mean 0.5, variance 0.5; x*x mean 1, variance 2; N(1e-9, 1)**2 mean 1, variance 2;
#   chi squared with 1 degree of freedom: mean 1, variance 2.
set -euo pipefail
export OMP_NUM_THREADS=1
d=$(mktemp -d); trap 'rm -rf "$d"' EXIT
python3 -m venv "$d/v"
"$d/v/bin/pip" install -q --disable-pip-version-check --no-compile soerp==1.0.1 numpy==2.4.6 scipy==1.17.1
"$d/v/bin/python" - <<'P'
import numpy as np
from scipy.stats import chi2
from soerp import N, U

x, y, u = N(0, 1), N(1e-9, 1), U(-1, 1)
for name, v in (("x**2", x**2), ("x*x", x * x), ("x**2 at mean 1e-9", y**2)):
    m = v.moments()
    print(f"{name:18s} mean {m[0]:.4f} variance {float(m[1]):.4f} skewness {float(m[2]):.4f} kurtosis {float(m[3]):.4f}")
print(f"chi squared, 1 dof mean {chi2.mean(1):.4f} variance {chi2.var(1):.4f} skewness {chi2.stats(1, moments='s'):.4f} "
      f"kurtosis {3 + chi2.stats(1, moments='k'):.4f}")
print(f"uniform -1..1: x**2 mean {(u**2).mean:.4f}, x*x mean {(u*u).mean:.4f}, right {1/3:.4f}")
a, b, c = (x**2).moments(), (x * x).moments(), (y**2).moments()
assert np.allclose(a[:2], [.5, .5]) and np.allclose(b[:2], [1, 2]) and np.allclose(c[:2], [1, 2])
assert abs((u**2).mean - 1 / 6) < 1e-9 and abs((u * u).mean - 1 / 3) < 1e-9
draw = np.random.default_rng(1).normal(size=400000)**2
assert abs(draw.mean() - 1) < .02 and abs(draw.var() - 2) < .06
P
