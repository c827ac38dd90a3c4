#!/usr/bin/env bash
# UQpy 4.2.1 (newest), NumPy 1.26.4, SciPy 1.13.1, beartype 0.18.5, Python 3.11. (Installed without torch, scikit-learn and
# matplotlib, which these classes do not use; stand-ins with the names that are imported are put in their place.)
# Expected: JointIndependent([...]).rvs(n, random_state=7) draws independent inputs; random_state is documented as None, a
#   whole number or a RandomState, and a whole number makes the run repeatable. The correlation of two inputs is 0, and
#   the variance of x1 - x2 the sum of both.
# Happens: the number is handed to every input's own generator, so that all draw the same random numbers: inputs with one
#   distribution are equal, others follow one another exactly. With a RandomState or with None they are independent. The
#   sensitivity methods (Sobol, Chatterjee, Cramer-von Mises, generalised Sobol) draw their samples so. No warning.
# Consequence: whoever fixes the seed, as one should, gets the Monte Carlo spread and the sensitivity indices of another problem,
#   repeatably: for y = x1 + 2 x2 the index of the unimportant input doubles, and first order indices exceed total ones.
# Seen: correlation of two uniform inputs, seed 7: 1.000, RandomState(7) -0.006; variance of x1 - x2 0.000 and 0.674, right 2/3;
#   Sobol indices of y = x1 + 2 x2 (right 0.2 and 0.8): seed 7 first order 0.42, 0.86, total 0.33, 0.67; RandomState(7)
#   0.19, 0.81 and 0.24, 0.83; normal and lognormal input, seed 7: rank correlation 1.0000.
set -euo pipefail
export OMP_NUM_THREADS=1 MPLBACKEND=Agg
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
    return s[0][0] + 2 * s[0][1]
M
cd "$d"
PYTHONPATH="$d" "$d/v/bin/python" -W ignore - <<'P'
import logging
import numpy as np
logging.disable(logging.CRITICAL)
from UQpy.distributions import JointIndependent, Lognormal, Normal, Uniform
from UQpy.run_model.RunModel import RunModel
from UQpy.run_model.model_execution.PythonModel import PythonModel
from UQpy.sensitivity.SobolSensitivity import SobolSensitivity

two = JointIndependent([Uniform(-1, 2), Uniform(-1, 2)])
out = {}
for name, seed in (("7", 7), ("RandomState(7)", np.random.RandomState(7))):
    x = two.rvs(20000, random_state=seed)
    r, v = np.corrcoef(x.T)[0, 1], (x[:, 0] - x[:, 1]).var()
    again = 7 if name == "7" else np.random.RandomState(7)
    model = RunModel(model=PythonModel(model_script="model.py", model_object_name="f", var_names=["x1", "x2"]))
    s = SobolSensitivity(model, two, random_state=again)
    s.run(n_samples=4000)
    first, total = np.ravel(s.first_order_indices), np.ravel(s.total_order_indices)
    out[name] = r, v, first, total
    print(f"random_state {name:14s}: correlation {r:.3f}, variance of x1 - x2 {v:.3f} (right 0.667), "
          f"first order {np.round(first, 2)}, total {np.round(total, 2)} (right 0.2, 0.8)", flush=True)
mixed = JointIndependent([Normal(0, 1), Lognormal(.5)]).rvs(20000, random_state=7)
rank = np.corrcoef(np.argsort(np.argsort(mixed[:, 0])), np.argsort(np.argsort(mixed[:, 1])))[0, 1]
print(f"normal and lognormal, seed 7: rank correlation {rank:.4f}")
a, b = out["7"], out["RandomState(7)"]
assert a[0] > .999999 and a[1] < 1e-20 and rank > .9999
assert abs(b[0]) < .03 and abs(b[1] - 2 / 3) < .02
assert np.allclose(b[2], [.2, .8], atol=.08) and not np.allclose(a[2], [.2, .8], atol=.15)
P
