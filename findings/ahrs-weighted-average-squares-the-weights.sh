#!/usr/bin/env bash
# ahrs 0.4.0 (newest), NumPy 2.4.6, SciPy 1.17.1, Python 3.11.
# Expected: QuaternionArray.average(weights=w) is the weighted mean attitude of Markley et al. (J. Guidance 2007), the
#   largest eigenvector of sum of w_i q_i q_i^T, as its documentation writes. Weights are counts or inverse variances:
#   weight 3 is the same as the attitude given three times.
# Happens: the quaternions are multiplied by the weights before the products are formed, so the matrix is
#   sum of w_i^2 q_i q_i^T: weight 3 acts as 9. Without weights it is right.
# Consequence: a foot's mean attitude in stance from gyroscope and accelerometer, weighted by inverse variances, leans on
#   the better one far more than its variance warrants; foot angles at heel strike are off by degrees.
# Seen: two attitudes, 0 and 40 degrees about the vertical, weights 1 and 3: package 36.23 degrees; the four quaternions
#   (one, and three times the other) without weights 30.31; SciPy's weighted mean 30.31; weights 1 and 9 in SciPy 36.23.
set -euo pipefail
export OMP_NUM_THREADS=1
d=$(mktemp -d); trap 'rm -rf "$d"' EXIT
python3 -m venv "$d/v"
"$d/v/bin/pip" install -q --disable-pip-version-check --no-compile ahrs==0.4.0 numpy==2.4.6 scipy==1.17.1
"$d/v/bin/python" - <<'P'
import numpy as np
from ahrs import QuaternionArray
from scipy.spatial.transform import Rotation

q = np.array([[np.cos(a / 2), 0, 0, np.sin(a / 2)] for a in np.radians([0, 40])])
angle = lambda v: float(np.degrees(2 * np.arctan2(v[3], v[0])) % 360)
scipy = lambda w: float(np.degrees(Rotation.from_quat(q[:, [1, 2, 3, 0]]).mean(weights=w).as_rotvec()[2]))
weighted = angle(QuaternionArray(q).average(weights=np.array([1., 3.])))
repeated = angle(QuaternionArray(q[[0, 1, 1, 1]]).average())
equal = angle(QuaternionArray(q).average(weights=np.array([1., 1.])))
print(f"weights 1, 3: {weighted:.2f}  the same four without weights: {repeated:.2f}  "
      f"SciPy 1, 3: {scipy([1, 3]):.2f}  SciPy 1, 9: {scipy([1, 9]):.2f}  weights 1, 1: {equal:.2f}")
assert abs(weighted - 36.23) < .01 and abs(weighted - scipy([1, 9])) < 1e-6
assert abs(repeated - scipy([1, 3])) < 1e-6 and abs(repeated - 30.31) < .01
assert abs(equal - 20) < 1e-6
P
