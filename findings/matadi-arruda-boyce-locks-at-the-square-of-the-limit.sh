#!/usr/bin/env bash
# matadi 0.5.0 (newest), casadi 3.8.2, NumPy 2.4.6, SciPy 1.17.1, Matplotlib 3.10.8, Python 3.11.
# Expected: arruda_boyce(F, C1, limit) is the eight-chain rubber of Arruda and Boyce (J. Mech. Phys. Solids 41, 1993) in its series
#   of five terms: W = C1 sum of a_i (I1^i - 3^i) / limit^(2i - 2), a_i 1/2, 1/20, 11/1050, 19/7000, 519/673750, with limit the
#   stretch at which the chains lock, as in every finite element program. The author's other package, FElupe, has that.
# Happens: the power is limit^(4i - 4): beta is 1/limit^2 already and is raised to 2i - 2 once more. The material is that of a
#   locking stretch of limit squared: 2 acts as 4, 3 as 9; the stiffening is all but gone. No warning.
# Consequence: soles, seals and membranes with published constants are far too soft where it counts: at three times their length
#   with limit 2 the force is less than half of the right one; constants fitted with it do not fit any other program.
# Seen: C1 1 MPa, limit 2, uniaxial nominal stress at stretch 3: package 3.32 MPa, series 6.99 (inverse Langevin function itself
#   10.5), series with limit 4 3.32; at stretch 2 1.87, right 2.47 (2.49); initial shear modulus 1.040 MPa, right 1.197 (1.198).
set -euo pipefail
export OMP_NUM_THREADS=1 MPLBACKEND=Agg
d=$(mktemp -d); trap 'rm -rf "$d"' EXIT
python3 -m venv "$d/v"
"$d/v/bin/pip" install -q --disable-pip-version-check --no-compile matadi==0.5.0 casadi==3.8.2 numpy==2.4.6 scipy==1.17.1 \
  matplotlib==3.10.8
"$d/v/bin/python" - <<'P'
import numpy as np
from matadi import MaterialHyperelastic
from matadi.models import arruda_boyce
from scipy.optimize import brentq

A = [1 / 2, 1 / 20, 11 / 1050, 19 / 7000, 519 / 673750]

def nominal(stretch, limit):                                             # package, incompressible uniaxial: dW/dstretch
    m = MaterialHyperelastic(fun=arruda_boyce, C1=1., limit=limit, bulk=1.)
    F = np.diag([stretch, stretch**-.5, stretch**-.5]).reshape(3, 3, 1, 1)
    P = np.asarray(m.gradient([F])[0]).reshape(3, 3)
    return P[0, 0] - P[1, 1] * F[1, 1, 0, 0] / stretch

def series(stretch, limit):
    I1 = stretch**2 + 2 / stretch
    dW = sum(i * a * I1**(i - 1) / limit**(2 * i - 2) for i, a in enumerate(A, 1))
    return dW * 2 * (stretch - stretch**-2)

def exact(stretch, limit):                                               # the model itself, with the inverse Langevin function
    chain = np.sqrt((stretch**2 + 2 / stretch) / 3) / limit
    b = brentq(lambda b: 1 / np.tanh(b) - 1 / b - chain, 1e-6, 1e6)
    return limit * b / (3 * chain * limit) * (stretch - stretch**-2)

for limit in (2., 3., 5.):
    for s in (1.001, 2., 3.):
        p, r, e, sq = nominal(s, limit), series(s, limit), exact(s, limit), series(s, limit**2)
        print(f"limit {limit:.0f}, stretch {s}: package {p:.5g}, series {r:.5g}, inverse Langevin {e:.5g}; "
              f"series with limit {limit**2:.0f} {sq:.5g} MPa")
        assert abs(p / sq - 1) < 1e-6 and p < r * (1 if limit < 5 else 1.0001)
g = nominal(1.00001, 2.) / 3e-5, series(1.00001, 2.) / 3e-5, exact(1.00001, 2.) / 3e-5
print("initial shear modulus, limit 2: package %.4f, series %.4f, inverse Langevin %.4f MPa" % g)
assert abs(g[0] - 1.0402) < .002 and abs(g[1] / g[2] - 1) < .01 and g[1] > 1.19
assert nominal(3., 2.) < .55 * series(3., 2.)
P
