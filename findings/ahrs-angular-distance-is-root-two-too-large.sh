#!/usr/bin/env bash
# ahrs 0.4.0 (newest), NumPy 2.4.6, SciPy 1.17.1, Python 3.11.
# Expected: ahrs.utils.angular_distance(R1, R2) is the angle of the turn between the two attitudes, 0 to 180 degrees, as in the
#   paper that it names (Hartley et al., Rotation averaging, 2013: the norm of the rotation vector; at most pi).
# Happens: the norm is taken of the antisymmetric 3 x 3 matrix, in which each of the three numbers stands twice: every angle
#   is multiplied by 1.414. A half turn is 254.6 degrees. No warning.
# Consequence: an error of 3.0 degrees between a foot sensor and the cameras is reported as 4.2: filters fail limits that they
#   keep, and results can't be compared with those of others. The quaternion distance of the same module (qad) is right.
# Seen, degrees about z: 1 -> 1.41, 10 -> 14.14, 90 -> 127.28, 179 -> 253.14; SciPy and qad 1, 10, 90, 179.
set -euo pipefail
export OMP_NUM_THREADS=1
d=$(mktemp -d); trap 'rm -rf "$d"' EXIT
python3 -m venv "$d/v"
"$d/v/bin/pip" install -q --disable-pip-version-check --no-compile ahrs==0.4.0 numpy==2.4.6 scipy==1.17.1
"$d/v/bin/python" - <<'P'
import numpy as np
from ahrs import Quaternion
from ahrs.utils.metrics import angular_distance, qad
from scipy.spatial.transform import Rotation

base = Rotation.from_euler("zyx", [20, -35, 50], degrees=True)
q = lambda r: r.as_quat()[[3, 0, 1, 2]]
for deg, axis in ((1, [0, 0, 1]), (10, [0, 0, 1]), (90, [0, 0, 1]), (179, [0, 0, 1]), (40, [1, 2, -2])):
    turned = Rotation.from_rotvec(np.radians(deg) * np.array(axis) / np.linalg.norm(axis)) * base
    got = float(np.degrees(angular_distance(turned.as_matrix(), base.as_matrix())))
    own = float(np.degrees(qad(q(turned), q(base))))
    scipy = float(np.degrees((turned * base.inv()).magnitude()))
    print(f"turn of {deg:3d} degrees about {axis}: angular_distance {got:.2f}, qad {own:.2f}, SciPy {scipy:.2f}")
    assert abs(scipy - deg) < 1e-6 and abs(own - deg) < 1e-3
    assert abs(got / deg - np.sqrt(2)) < 1e-4
P
