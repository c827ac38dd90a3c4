#!/usr/bin/env bash
# mcerp 1.1.1 (newest), NumPy 2.4.6, SciPy 1.17.1, Python 3.11.
# Expected: LogNormal(mu, sigma) is exp of a normal with mean mu and standard deviation sigma, as in its companion soerp
#   (same author, same names and order), in GUM Supplement 1 and in NumPy's lognormal: median exp(mu),
#   mean exp(mu + sigma^2/2). mu is negative for whatever is below one.
# Happens: mu itself is the median; sigma is that of the logarithm. For mu <= 0 every sample is nan: sigma is checked, mu
#   is not.
# Consequence: a viscosity of 100 mPa s known to 25 per cent, given as log(100), becomes one of 4.6; a friction of 0.5, given
#   as log(0.5), is nan, or, in a model with a maximum or a comparison, silently none at all.
# Seen: LogNormal(log 100, 0.25): mean 4.75, median 4.61; soerp and SciPy mean 103.17, median 100;
#   LogNormal(log 0.5, 0.1): mean nan, right 0.5025; share of it below 1: 0, right 1.
set -euo pipefail
export OMP_NUM_THREADS=1
d=$(mktemp -d); trap 'rm -rf "$d"' EXIT
python3 -m venv "$d/v"
"$d/v/bin/pip" install -q --disable-pip-version-check --no-compile mcerp==1.1.1 soerp==1.0.1 numpy==2.4.6 scipy==1.17.1
"$d/v/bin/python" - <<'P'
import math
import numpy as np
import mcerp
import soerp

np.random.seed(1)
mu, s = math.log(100), .25
v = mcerp.LogNormal(mu, s)
numpy = np.random.default_rng(1).lognormal(mu, s, 400000)
print(f"LogNormal(log 100, 0.25): mean {v.mean:.2f} median {v.percentile(.5):.2f}; soerp mean {soerp.LogN(mu, s).mean:.2f}; "
      f"NumPy mean {numpy.mean():.2f} median {np.median(numpy):.2f}; by formula {math.exp(mu + s*s/2):.2f}")
assert abs(v.mean - 4.75) < .02 and abs(v.percentile(.5) - mu) < .01
assert abs(soerp.LogN(mu, s).mean - math.exp(mu + s * s / 2)) < 1e-6 and abs(numpy.mean() - 103.17) < .3
f = mcerp.LogNormal(math.log(.5), .1)
print(f"LogNormal(log 0.5, 0.1): mean {f.mean}, soerp {soerp.LogN(math.log(.5), .1).mean:.4f}; share below 1: {f < 1}")
assert math.isnan(f.mean) and (f < 1) == 0
assert abs(soerp.LogN(math.log(.5), .1).mean - .5025) < 1e-4
P
