#!/usr/bin/env bash
# reliability 0.9.0 (newest), NumPy 2.4.6, SciPy 1.17.1, pandas 2.3.3, Python 3.11.
# Expected: reliability_test_duration() returns "the required test duration to meet the input parameters": the shortest test
#   with which a product at the required MTBF passes with at most the consumer's risk and one at the design MTBF fails with
#   at most the producer's. For a ratio of 3 and 20 per cent each that is 4.3 times the required MTBF with two failures
#   allowed, true risks 17.5 and 19.7 per cent: plan XVII-D of MIL-HDBK-781.
# Happens: the failures allowed are counted up until the producer's risk is met, and then the result of one failure fewer is
#   returned, which does not meet it. With many failures (design near required) that is little, with few it is much:
#   3.0 times, one failure, producer's risk 26 per cent. No warning, the printed report repeats the 20 per cent.
# Consequence: a wear or life test of soles or sliders planned with it rejects a good product in a third of the cases,
#   where a fifth or a tenth was agreed.
# Seen: required 2500, risks 0.2 and 0.2: design 7500: 7486 (2.99 times), producer's risk 0.264, right 10698 (4.28), 0.173;
#   design 10000: 4024, risk 0.331, right 7486, 0.173; of 20000 simulated tests of 7486 at 7500 fail 0.268.
set -euo pipefail
export OMP_NUM_THREADS=1 MPLBACKEND=Agg
d=$(mktemp -d); trap 'rm -rf "$d"' EXIT
python3 -m venv "$d/v"
"$d/v/bin/pip" install -q --disable-pip-version-check --no-compile reliability==0.9.0 numpy==2.4.6 scipy==1.17.1 pandas==2.3.3
"$d/v/bin/python" -W ignore - <<'P'
import numpy as np
from scipy.stats import chi2, poisson
from reliability.Reliability_testing import reliability_test_duration

required, consumer, producer = 2500., .2, .2

def plan(failures):                       # the length at which a bad product passes with exactly the consumer's risk
    return chi2.ppf(1 - consumer, 2 * failures + 2) * required / 2

def right(design):
    for c in range(1000):
        t = plan(c)
        assert abs(poisson.cdf(c, t / required) - consumer) < 1e-9
        if poisson.sf(c, t / design) <= producer:
            return t, c, poisson.sf(c, t / design)

seen = {}
for design in (3000., 7500., 10000.):
    got = reliability_test_duration(MTBF_required=required, MTBF_design=design, consumer_risk=consumer,
                                    producer_risk=producer, show_plot=False, print_results=False)
    c = min(range(200), key=lambda k: abs(plan(k) - got))
    assert abs(plan(c) - got) < 1e-6 * got
    risk = poisson.sf(c, got / design)
    t, cr, rr = right(design)
    seen[design] = got, c, risk, t, cr, rr
    print(f"design {design:.0f}: package {got:.0f} ({got/required:.2f} times, {c} failures allowed), producer's risk {risk:.3f}; "
          f"right {t:.0f} ({t/required:.2f} times, {cr} allowed), {rr:.3f}")
    assert cr == c + 1 and risk > producer >= rr
got, c, risk, t, cr, rr = seen[7500.]
assert abs(t / required - 4.3) < .05 and cr == 2 and abs(rr - .175) < .003        # plan XVII-D
assert abs(got / required - 2.99) < .01 and abs(risk - .264) < .001
rng = np.random.default_rng(1)
fails = (rng.exponential(7500., (20000, c + 1)).sum(axis=1) < got).mean()           # one failure more than allowed in time
print(f"share of 20000 simulated tests of {got:.0f} that fail at an MTBF of 7500: {fails:.3f}")
assert abs(fails - risk) < .012
P
