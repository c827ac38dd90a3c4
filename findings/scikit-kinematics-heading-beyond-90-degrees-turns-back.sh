#!/usr/bin/env bash
# scikit-kinematics 0.10.4 (newest), NumPy 2.4.6, SciPy 1.17.1, pandas 2.3.3, Matplotlib 3.10.8, SymPy 1.14.0, Python 3.11.
# (An empty module stands for tkinter, which only its file dialogues use.)
# Expected: quat.quat2seq(q) gives the nautical angles (yaw, pitch, roll; Rz Ry Rx) of a quaternion. Yaw and roll run over the
#   whole circle: back through seq2quat they give the same attitude. rotmat.sequence of the same package, from the matrix,
#   does that (arctan2), and so does SciPy.
# Happens: yaw and roll are taken as arcsines of one matrix element, which knows -90 to 90 degrees only: 120 comes out as 60,
#   180 as 0, a roll of 170 as 10. Helmholtz angles fold in the same way. No warning; the documentation names no limit.
# Consequence: a walker who turns round with a sensor on foot or pelvis, or walks down the laboratory's other direction, is seen
#   to turn by 90 degrees and then back; headings of walks at more than 90 degrees to the axis are mirrored; a sensor
#   strapped upside down reads a roll near zero.
# Seen: yaw 60, 120, 170, 180 with pitch 5 and roll 3: quat2seq 60, 60, 10, 0; rotmat.sequence and SciPy 60, 120, 170, 180; the
#   attitude from 170 read back through seq2quat is off by 160 degrees.
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
from scipy.spatial.transform import Rotation
from skinematics import quat, rotmat

def case(yaw, roll):
    r = Rotation.from_euler("ZYX", [yaw, 5, roll], degrees=True)
    q = r.as_quat()[[3, 0, 1, 2]]
    made = rotmat.seq2quat([yaw, 5, roll])[0]
    assert min(abs(made - q).max(), abs(made + q).max()) < 1e-9         # the way there is right
    got = quat.quat2seq(q)[0]
    own = np.degrees(rotmat.sequence(rotmat.R("z", yaw) @ rotmat.R("y", 5) @ rotmat.R("x", roll), "nautical"))
    scipy = r.as_euler("ZYX", degrees=True)
    back = Rotation.from_quat(rotmat.seq2quat(got)[0][[1, 2, 3, 0]])
    off = np.degrees((back * r.inv()).magnitude())
    print(f"yaw {yaw}, pitch 5, roll {roll}: quat2seq {np.round(got, 1)}, rotmat.sequence {np.round(own, 1)}, "
          f"SciPy {np.round(scipy, 1)}; attitude read back off by {off:.1f} degrees")
    turn = abs((own - [yaw, 5, roll] + 180) % 360 - 180)
    assert turn.max() < 1e-6 and abs((scipy - own + 180) % 360 - 180).max() < 1e-6
    return got, off

for yaw, folded in ((60, 60), (-80, -80), (120, 60), (170, 10), (180, 0)):
    got, off = case(yaw, 3)
    assert abs(got[0] - folded) < 1e-6 and (off < 1e-5 if abs(yaw) < 90 else off > 50)
got, off = case(20, 170)
assert abs(got[2] - 10) < 1e-6 and off > 150
P
