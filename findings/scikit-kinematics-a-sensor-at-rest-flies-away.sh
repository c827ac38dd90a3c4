#!/usr/bin/env bash
# scikit-kinematics 0.10.4 (newest), NumPy 2.4.6, SciPy 1.17.1, pandas 2.3.3, Matplotlib 3.10.8, SymPy 1.14.0, Python 3.11.
# (An empty module stands for tkinter, which only its file dialogues use.)
# Expected: an IMU object, given acceleration, angular velocity and R_init, the sensor's attitude in the room at the start,
#   has velocity and position in .vel and .pos, with gravity taken off. A sensor that lies still stays where it is,
#   however it is mounted; the function imus.analytical() with the same four arguments says so.
# Happens: the object keeps the orientation relative to its own first sample (the unit quaternion at the start) and takes
#   gravity off along the sensor's own z axis at the start, whatever R_init is. Unless that axis happens to be vertical, a
#   part of g stays and is integrated twice. The position that analytical() returned is thrown away. No warning.
# Consequence: the package's own example (R_init that turns y up) and every sensor on a shank, a thigh or a sloping shoe: stride
#   lengths and foot clearance are off by metres after a second. A mount of 10 degrees gives 0.85 m in 1 s.
# Seen, still for 10 s at 100 Hz: sensor's y axis up: .pos (0, 490.3, -490.3) m, analytical() (0, 0, 0); tilted by 10 degrees
#   about x: (0, 85.1, -7.4) m, analytical() 0; z axis up: 0 in both. 8 m along x from rest to rest, y axis up:
#   (8, 490.3, -490.3), analytical() (8, 0, 0).
set -euo pipefail
export OMP_NUM_THREADS=1 MPLBACKEND=Agg
d=$(mktemp -d); trap 'rm -rf "$d"' EXIT
python3 -m venv "$d/v"
"$d/v/bin/pip" install -q --disable-pip-version-check --no-compile numpy==2.4.6 scipy==1.17.1 pandas==2.3.3 matplotlib==3.10.8 \
  sympy==1.14.0
"$d/v/bin/pip" install -q --disable-pip-version-check --no-compile --no-deps scikit-kinematics==0.10.4
"$d/v/bin/python" - <<'P'
import sys
import types
for m in ("tkinter", "tkinter.filedialog"):
    sys.modules[m] = types.ModuleType(m)
sys.modules["tkinter"].filedialog = sys.modules["tkinter.filedialog"]
import numpy as np
from scipy.constants import g
from skinematics import imus, rotmat
from skinematics.sensors.manual import MyOwnSensor

rate, n = 100., 1001
t = np.arange(n) / rate
still = np.zeros((n, 3))
T = t[-1]
moving = still.copy()
moving[:, 0] = 8 * 2 * np.pi / T**2 * np.sin(2 * np.pi * t / T)          # from rest to rest, 8 m along x

def run(name, R, acc):
    f = (acc + [0, 0, g]) @ R                                             # what the accelerometer feels, in its own axes
    omega = np.zeros((n, 3))
    o = MyOwnSensor(in_file="by hand", in_data={"rate": rate, "acc": f, "omega": omega}, R_init=R)
    q, pos, vel = imus.analytical(R, omega, np.zeros(3), f, rate)
    print(f"{name}: .pos after {T:.0f} s {np.round(o.pos[-1], 1) + 0.}, analytical() {np.round(pos[-1], 3) + 0.}")
    return o.pos, pos

yup = np.array([[1., 0, 0], [0, 0, -1], [0, 1, 0]])                       # R_init of the package's example
a, b = run("still, y axis up", yup, still)
assert np.allclose(a[-1], [0, g * T**2 / 2, -g * T**2 / 2], rtol=1e-6) and abs(b).max() < 1e-6
a, b = run("still, tilted by 10 degrees", rotmat.R("x", 10), still)
s, c = np.sin(np.radians(10)), np.cos(np.radians(10))
assert np.allclose(a[-1], [0, g * s * T**2 / 2, g * (c - 1) * T**2 / 2], rtol=1e-6) and abs(b).max() < 1e-6
assert abs(a[100, 1] - .85) < .01
a, b = run("still, z axis up", np.eye(3), still)
assert abs(a).max() < 1e-6 and abs(b).max() < 1e-6
a, b = run("8 m along x, y axis up", yup, moving)
assert np.allclose(b[-1], [8, 0, 0], atol=.01) and np.linalg.norm(a[-1] - b[-1]) > 600
P
