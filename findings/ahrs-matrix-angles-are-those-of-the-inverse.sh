#!/usr/bin/env bash
# ahrs 0.4.0 (newest), NumPy 2.4.6, SciPy 1.17.1, Python 3.11.
# Expected: roll, pitch and yaw go into a Quaternion, its to_DCM() gives the rotation matrix, and DCM.to_rpy() of that
#   matrix gives the three angles back, as Quaternion.to_angles() does. For one axis alone, and for SciPy, R = Rz Ry Rx.
# Happens: to_rpy() takes the angles of the transposed matrix. With one angle the sign is turned, which one may take for a
#   convention; with three, each is a mixture of all (the inverse of a turn by z, y, x is one by x, y, z). The rpy= of
#   DCM itself has a third order: its first angle is the one about z, so that DCM(rpy=a).to_rpy() is not a either.
# Consequence: roll, pitch and yaw of a foot sensor read from the matrix are wrong by up to the size of the angles, and
#   flipping signs does not mend them: at roll 10, pitch 20, yaw 30 the roll comes out as 1.1.
# Seen: 10, 20, 30 degrees: to_angles 10.00, 20.00, 30.00; to_rpy 1.12, -22.24, -28.45; SciPy 10, 20, 30;
#   roll 10 alone -10.00; DCM(rpy=10, 20, 30) by SciPy roll 30, pitch 20, yaw 10; its to_rpy -28.45, -22.24, 1.12.
set -euo pipefail
export OMP_NUM_THREADS=1
d=$(mktemp -d); trap 'rm -rf "$d"' EXIT
python3 -m venv "$d/v"
"$d/v/bin/pip" install -q --disable-pip-version-check --no-compile ahrs==0.4.0 numpy==2.4.6 scipy==1.17.1
"$d/v/bin/python" - <<'P'
import numpy as np
from ahrs import DCM, Quaternion
from scipy.spatial.transform import Rotation

a = np.radians([10., 20., 30.])
q = Quaternion(rpy=a)
R = q.to_DCM()
rx, ry, rz = (Rotation.from_euler(k, v).as_matrix() for k, v in zip("xyz", a))
assert np.allclose(R, rz @ ry @ rx)                                  # the matrix is right, turning vectors
assert np.allclose(q.rotate(np.array([1., 2., 3.])), rz @ ry @ rx @ [1, 2, 3])
scipy = Rotation.from_matrix(R).as_euler("ZYX", degrees=True)[::-1]
own = np.degrees(q.to_angles())
got = np.degrees(DCM(R).to_rpy())
print("Quaternion.to_angles", np.round(own, 2), " SciPy", np.round(scipy, 2), " DCM.to_rpy", np.round(got, 2))
assert np.allclose(own, [10, 20, 30]) and np.allclose(scipy, [10, 20, 30])
assert np.allclose(got, [1.12, -22.24, -28.45], atol=.01)
assert np.allclose(got, np.degrees(Quaternion(q.conjugate).to_angles()))
one = np.degrees(DCM(Quaternion(rpy=[a[0], 0., 0.]).to_DCM()).to_rpy())
print("roll 10 alone:", np.round(one, 2))
assert np.allclose(one, [-10, 0, 0])
D = DCM(rpy=a)
s = Rotation.from_matrix(np.asarray(D)).as_euler("ZYX", degrees=True)[::-1]
r = np.degrees(D.to_rpy())
print("DCM(rpy=10, 20, 30): roll, pitch, yaw by SciPy", np.round(s, 2), " its own to_rpy", np.round(r, 2))
assert np.allclose(s, [30, 20, 10]) and np.allclose(r, [-28.45, -22.24, 1.12], atol=.01)
P
