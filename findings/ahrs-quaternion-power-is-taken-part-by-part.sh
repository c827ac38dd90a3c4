#!/usr/bin/env bash
# ahrs 0.4.0 (newest), NumPy 2.4.6, SciPy 1.17.1, Python 3.11.
# Expected: Quaternion ** a is [cos(a t), u sin(a t)] for a turn of 2 t about u, as its documentation writes: q ** 1 is q,
#   q ** 2 is q * q, q ** 0 is no turn, q ** 0.5 is half the turn. All have length 1.
# Happens: the exponential is taken of each of the four numbers by itself, not of the quaternion: the first is always 1,
#   the length never. Quaternion.exponential of the same class is right. No error, four plausible numbers.
# Consequence: a part of a turn (interpolation between frames, half the knee's motion for a joint's mid frame, an average
#   rate) points anywhere: half of a turn of 60 degrees about x comes out as one of 125 degrees about (0.68, 0.52, 0.52).
# Seen: 60 degrees about x: q (0.866, 0.5, 0, 0); q ** 1 (1, 1.688, 1, 1); q ** 2 (1, 2.850, 1, 1), q * q (0.5, 0.866, 0, 0);
#   q ** 0 (1, 1, 1, 1); q ** 0.5, normalised: 125.0 degrees, 30.0 is right.
set -euo pipefail
export OMP_NUM_THREADS=1
d=$(mktemp -d); trap 'rm -rf "$d"' EXIT
python3 -m venv "$d/v"
"$d/v/bin/pip" install -q --disable-pip-version-check --no-compile ahrs==0.4.0 numpy==2.4.6 scipy==1.17.1
"$d/v/bin/python" - <<'P'
import numpy as np
from ahrs import Quaternion
from scipy.spatial.transform import Rotation

t = np.radians(30)
q = Quaternion([np.cos(t), np.sin(t), 0, 0])                        # 60 degrees about x
turn = Rotation.from_rotvec([np.radians(60), 0, 0])
for a in (0., .5, 1., 2.):
    got = np.asarray(q ** a)
    right = np.array([np.cos(a * t), np.sin(a * t), 0, 0])
    scipy = (turn ** a).as_quat()[[3, 0, 1, 2]]
    own = np.asarray(Quaternion(a * q.logarithm, versor=False).exponential) if a else np.array([1., 0, 0, 0])
    u = got / np.linalg.norm(got)
    print(f"q ** {a}: package {np.round(got, 3)}, as a turn {2 * np.degrees(np.arccos(u[0])):.1f} about "
          f"{np.round(u[1:] / np.linalg.norm(u[1:]), 2)}; right {np.round(right, 3)}, {60 * a:.1f} about x")
    assert np.allclose(right, scipy) and np.allclose(own, right)
    assert np.allclose(got, [1, np.exp(a * t), 1, 1])
assert np.allclose(np.asarray(q * q), [.5, np.sqrt(3) / 2, 0, 0])
assert not np.allclose(np.asarray(q ** 1.0), np.asarray(q))
u = np.asarray(q ** .5); u = u / np.linalg.norm(u)
assert abs(2 * np.degrees(np.arccos(u[0])) - 125.0) < .1
P
