#!/usr/bin/env bash
# suncal 1.7.1 (newest), NumPy 2.4.6, SciPy 1.17.1, Matplotlib 3.10.8, SymPy 1.14.0, Pint 0.25.3, Python 3.11.
# Expected: a3_testinterval() (method A3 of NCSLI RP-1) tests with the binomial distribution whether the share found in tolerance
#   contradicts the target, from below as from above. The "current interval rejection confidence" is 1 minus twice the tail:
#   1 - 2 P(X <= x) below the target, 1 - 2 P(X >= x) above it. Above the wanted confidence the interval is shortened, or
#   lengthened. The reliability range is Clopper and Pearson's.
# Happens: above the target the confidence is P(X <= x) - 1, which is never positive and is shown as 0. The interval is never
#   lengthened, unless every single calibration was in tolerance. Below the target it is right. Besides, with exactly one
#   in tolerance the range is that of all in tolerance. No warning.
# Consequence: force plates, torque tools, thermometers that are in tolerance in 199 of 200 calibrations, where 90 per cent are
#   wanted, stay at their interval for ever, "rejection confidence 0 per cent"; with 200 of 200 it doubles.
# Seen: target 0.9, 365 days, 200 calibrations, 170, 190, 199, 200 in tolerance: rejection 0.967, 0.000, 0.000, 1.000; right
#   0.967, 0.984, 1.000, 1.000; interval 327, 365, 365, 730 days. One of 20: range 0.966 to 1 (observed 0.05), right 0.014 to 0.129.
set -euo pipefail
export OMP_NUM_THREADS=1 MPLBACKEND=Agg
d=$(mktemp -d); trap 'rm -rf "$d"' EXIT
python3 -m venv "$d/v"
"$d/v/bin/pip" install -q --disable-pip-version-check --no-compile suncal==1.7.1 numpy==2.4.6 scipy==1.17.1 matplotlib==3.10.8 \
  sympy==1.14.0 pint==0.25.3
"$d/v/bin/python" - <<'P'
from scipy import stats
from suncal.intervals import A3Params, a3_testinterval

def case(x, n=200, target=.9):
    r = a3_testinterval(A3Params(intol=x, n=n, I0=365, target=target, maxchange=2, conf=.5))
    below, above = stats.binom.cdf(x, n, target), stats.binom.sf(x - 1, n, target)
    right = max(1 - 2 * (below if x / n < target else above), 0)
    exact = stats.binomtest(x, n).proportion_ci(.5, "exact")
    lo, hi = (float(v) for v in r.reliability_range)
    print(f"{x} of {n} in tolerance: rejection {float(r.rejection):.3f} (right {right:.3f}), interval {float(r.interval):.0f} days, "
          f"calculated {float(r.calculated):.0f}; range {lo:.3f} to {hi:.3f} (exact {exact.low:.3f} to {exact.high:.3f})")
    return float(r.rejection), right, float(r.interval), (lo, hi), exact

for x in (160, 170):                                                      # too few in tolerance: right, shortened
    got, right, days, rng, exact = case(x)
    assert abs(got - right) < 1e-9 and days < 365
for x in (190, 195, 199):                                                 # many more than wanted: nothing happens
    got, right, days, rng, exact = case(x)
    assert got == 0 and right > .95 and days == 365
    assert abs(rng[0] - exact.low) < 1e-6 and abs(rng[1] - exact.high) < 1e-6
got, right, days, rng, exact = case(200)
assert got > .99 and days == 730
got, right, days, rng, exact = case(1, 20)
assert rng[0] > .96 and exact.high < .2
P
