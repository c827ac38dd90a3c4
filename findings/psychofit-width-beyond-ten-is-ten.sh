#!/usr/bin/env bash
# psychofit 1.0.0.post0 (newest), NumPy 2.4.6, SciPy 1.17.1, Python 3.11.
# Expected: mle_fit_psycho(data, "erf_psycho") finds bias, width and lapse of a psychometric function in the unit of the stimulus:
#   the same answers to stimuli in per cent, in fractions or in newtons give the same curve, its width in that unit.
# Happens: the upper bound of the second parameter is 10 by default, whatever the stimuli are; beyond it the likelihood is that
#   of a wall, and the fit comes back with 10, and with a lapse rate that makes up for the steepness. The help says
#   "some reasonable defaults are used". No warning, and the likelihood is returned as of a good fit.
# Consequence: how slippery a floor people call safe, asked over 0 to 100 per cent or 0 to 300 N, comes out steeper than
#   measured, with people who err in 7 of 100 answers; divided by ten, the same answers have no lapses.
# Seen: answers exactly on erf(x / 30) at -60 to 60: width 9.99, lapse 0.067, log likelihood -2182; the same stimuli in tenths 3.000,
#   lapse 0.000, -1914; in hundredths 0.300, -1914; with parmax given 30.00, lapse 0.000, -1914.
set -euo pipefail
export OMP_NUM_THREADS=1 MPLBACKEND=Agg
d=$(mktemp -d); trap 'rm -rf "$d"' EXIT
python3 -m venv "$d/v"
"$d/v/bin/pip" install -q --disable-pip-version-check --no-compile --only-binary :all: psychofit==1.0.0.post0 numpy==2.4.6 scipy==1.17.1
"$d/v/bin/python" -W error - <<'P'
import numpy as np
import psychofit
from scipy.special import erf

x = np.array([-60., -40, -20, 0, 20, 40, 60])
answers = .5 * (1 + erf(x / 30))
seen = {}
for name, unit, limits in (("as asked", 1., {}), ("in tenths", .1, {}), ("in hundredths", .01, {}),
                           ("with parmax", 1., {"parmax": np.array([60., 100., .4])})):
    np.random.seed(1)                                             # its restarts take NumPy's own stream
    (bias, width, lapse), likelihood = psychofit.mle_fit_psycho(np.vstack((x * unit, np.full(7, 1000), answers)), "erf_psycho", **limits)
    seen[name] = width / unit, lapse, likelihood
    print(f"{name:13s}: width {width:.3f} ({width / unit:.2f} in the first unit), lapse {lapse:.3f}, log likelihood {likelihood:.1f}")
wall, lapse, likelihood = seen.pop("as asked")
assert 9.9 < wall <= 10 and lapse > .05
for width, none, better in seen.values():
    assert abs(width - 30) < .1 and none < .002 and better > likelihood + 200
P
