#!/usr/bin/env bash
# scikit-posthocs 0.17.1 (newest), NumPy 2.4.6, SciPy 1.17.1, pandas 2.3.3, statsmodels 0.15.0, Python 3.11.
# Expected: test_osrt is Hayter's one-sided studentised range test (JASA 1990, 778-785): against means that rise in the given
#   order. Its statistic is the greatest of the differences later minus earlier group; where the means fall, it is
#   zero or negative and p near 1.
# Happens: the absolute differences are taken and the p value is that of the two-sided range: it is the smallest p of Tukey's
#   test, whatever the order of the groups. Falling means are as significant as rising ones, and where they do rise, p is
#   twice too large. No warning.
# Consequence: "friction rises with wear, p = 0.003" is confirmed by data in which it falls; a real but weak rise is missed.
# Seen: five stages of wear, five runs each, means 0.470 0.455 0.440 0.425 0.410: falling p 0.0031, turned round 0.0031,
#   shuffled 0.0031, Tukey's smallest p 0.0031; by simulation of Hayter's statistic 1.00 falling, 0.0016 rising; means that
#   rise from 0.44 to 0.48: package 0.067, Hayter 0.038.
set -euo pipefail
export OMP_NUM_THREADS=1 MPLBACKEND=Agg
d=$(mktemp -d); trap 'rm -rf "$d"' EXIT
python3 -m venv "$d/v"
"$d/v/bin/pip" install -q --disable-pip-version-check --no-compile scikit-posthocs==0.17.1 numpy==2.4.6 scipy==1.17.1 pandas==2.3.3 statsmodels==0.15.0
"$d/v/bin/python" -W ignore - <<'P'
import numpy as np
import pandas as pd
import scikit_posthocs as sp
from scipy.stats import tukey_hsd

base = np.array([-.028, -.013, 0, .011, .030])                     # the same scatter in every group
n, k = 5, 5

def package(means):
    d = pd.DataFrame({"stage": np.repeat(np.arange(k), n), "cof": np.concatenate([m + base for m in means])})
    p, stat, df = sp.test_osrt(d, val_col="cof", group_col="stage")
    return float(p), float(stat), int(df)

rng = np.random.default_rng(1)
null = rng.normal(size=(400000, k)) / np.sqrt(n)
low = np.minimum.accumulate(null, axis=1)
hayter = (null - low).max(axis=1) / np.sqrt(rng.chisquare(k * (n - 1), 400000) / (k * (n - 1))) * np.sqrt(n)

def right(means):
    s = base.std(ddof=1)
    t = max(means[j] - means[i] for i in range(k) for j in range(i + 1, k)) / s * np.sqrt(n)
    return float((hayter >= t).mean())

fall = [.470, .455, .440, .425, .410]
weak = [.44, .45, .46, .47, .48]
out = {}
for name, means in (("falling", fall), ("rising", fall[::-1]), ("shuffled", [.44, .41, .47, .425, .455]), ("weak rise", weak)):
    p, stat, df = package(means)
    tukey = float(tukey_hsd(*[m + base for m in means]).pvalue.min())
    out[name] = p, right(means), tukey
    print(f"{name:9s} {means}: package p {p:.5f} (statistic {stat:.2f}, {df} dof), Tukey's smallest {tukey:.5f}, Hayter {right(means):.5f}")
    assert abs(p - tukey) < 1e-4
assert out["falling"][0] < .01 and abs(out["falling"][0] - out["rising"][0]) < 1e-9 and abs(out["shuffled"][0] - out["rising"][0]) < 1e-9
assert out["falling"][1] > .99 and out["rising"][1] < out["rising"][0]
assert out["weak rise"][0] > .05 > out["weak rise"][1]
P
