#!/usr/bin/env bash
# UQpy 4.2.1 (newest), NumPy 1.26.4, SciPy 1.13.1, beartype 0.18.5, Python 3.11. (Installed without torch, scikit-learn and
# matplotlib, which these classes do not use; stand-ins with the names that are imported are put in their place.)
# Expected: SobolSensitivity.run(estimate_second_order=True) estimates the second order index of every pair of inputs,
#   whatever their number. Of y = 3 x1 x2 + x3 + x4 with all inputs uniform on -1 to 1 they are known: the variance is
#   1 + 1/3 + 1/3, so S12 = 0.6, S3 = S4 = 0.2, every other index of first or second order is 0, and all add up to 1.
# Happens: with exactly four inputs all second order indices are 0.0. With three inputs (without x4) and with five (one
#   more that does nothing) the same model has its interaction. First and total order are right with four. No warning.
# Consequence: four inputs (load, speed, viscosity, roughness, say) are what a friction study has, and the interaction of
#   load and viscosity is reported as none: a design or a surrogate without that term is the wrong one.
# Seen, 8000 samples: S12 with three inputs 0.80 (right 0.75), with four 0.000 (right 0.60), with five 0.64 (right 0.60);
#   with four, total minus first order of x1 is 0.61, so that total and second order contradict each other.
set -euo pipefail
export OMP_NUM_THREADS=1
d=$(mktemp -d); trap 'rm -rf "$d"' EXIT
python3 -m venv "$d/v"
"$d/v/bin/pip" install -q --disable-pip-version-check --no-compile numpy==1.26.4 scipy==1.13.1 beartype==0.18.5 'setuptools<81'
"$d/v/bin/pip" install -q --disable-pip-version-check --no-compile --no-deps UQpy==4.2.1
mkdir -p "$d/sklearn" "$d/matplotlib"
echo 'class Tensor: pass' > "$d/torch.py"
: > "$d/matplotlib/__init__.py"; : > "$d/matplotlib/pyplot.py"
echo 'linear_model = None' > "$d/sklearn/__init__.py"
echo 'class GaussianProcessRegressor: pass' > "$d/sklearn/gaussian_process.py"
echo 'class NearestNeighbors: pass' > "$d/sklearn/neighbors.py"
cat > "$d/model.py" <<'M'
def f(s):
    x = s[0]
    return 3 * x[0] * x[1] + x[2] + (x[3] if len(x) > 3 else 0)
M
cd "$d"
PYTHONPATH="$d" "$d/v/bin/python" -W ignore - <<'P' 2>&1 | grep -v INFO
import itertools
import logging
import numpy as np
logging.disable(logging.CRITICAL)
from UQpy.distributions import JointIndependent, Uniform
from UQpy.run_model.RunModel import RunModel
from UQpy.run_model.model_execution.PythonModel import PythonModel
from UQpy.sensitivity.SobolSensitivity import SobolSensitivity

out = {}
for m in (3, 4, 5):
    names = [f"x{i + 1}" for i in range(m)]
    model = RunModel(model=PythonModel(model_script="model.py", model_object_name="f", var_names=names))
    s = SobolSensitivity(model, JointIndependent([Uniform(-1, 2)] * m), random_state=np.random.RandomState(7))
    s.run(n_samples=8000, estimate_second_order=True)
    second = np.ravel(s.second_order_indices)
    first, total = np.ravel(s.first_order_indices), np.ravel(s.total_order_indices)
    var = 1 + (1 / 3 if m == 3 else 2 / 3)
    x = np.random.default_rng(1).uniform(-1, 1, (200000, m))           # the truth by simulation, too
    y = 3 * x[:, 0] * x[:, 1] + x[:, 2] + (x[:, 3] if m > 3 else 0)
    assert abs(y.var() / var - 1) < .02 and abs((3 * x[:, 0] * x[:, 1]).var() - 1) < .02
    print(f"{m} inputs: S12 {second[0]:.3f} right {1 / var:.3f}; the others",
          np.round(second[1:], 2), f"; total minus first order of x1 {total[0] - first[0]:.3f}", flush=True)
    out[m] = second, first, total, 1 / var
for m in (3, 5):
    assert abs(out[m][0][0] - out[m][3]) < .15
assert len(out[4][0]) == 6 and not out[4][0].any()
assert abs(out[4][2][0] - out[4][1][0] - .6) < .15
P
