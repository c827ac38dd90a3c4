#!/usr/bin/env bash
# GTC 1.5.1 (newest), NumPy 2.4.6, SciPy 1.17.1, Python 3.11.
# Expected: type_a.line_fit(x, y).x_from_y([y0]) is the stimulus x that gave the response y0, (y0 - a) / b, with its uncertainty
#   (GUM, H.3). The unit of y does not matter: in farad or in picofarad the pressure is the same.
# Happens: a slope below 1e-15, whatever its unit, is taken for zero, and then the intercept is returned in the place of x: a
#   number in the unit of y with the uncertainty of the intercept. No warning. All the fits of the module do so.
# Consequence: a capacitive pressure insole (some 2e-19 F/Pa), a charge amplifier in coulomb, a rate per hour in small units,
#   calibrated in SI, reads 1.0e-9 Pa for every response, with a small and plausible uncertainty.
# Seen: 0, 1, 2, 3 MPa and 1.0000, 1.0002, 1.0004, 1.00061 nF, response 1.0003 nF: in nF x = 1488000 Pa, u 21000;
#   in F x = 9.999980e-10, u 3.2e-15; the slope itself is right in both (2.03e-19 F/Pa).
set -euo pipefail
export OMP_NUM_THREADS=1
d=$(mktemp -d); trap 'rm -rf "$d"' EXIT
python3 -m venv "$d/v"
"$d/v/bin/pip" install -q --disable-pip-version-check --no-compile GTC==1.5.1 numpy==2.4.6 scipy==1.17.1
"$d/v/bin/python" - <<'P'
import numpy as np
from GTC import ta, uncertainty, value

x = [0., 1e6, 2e6, 3e6]
nf = [1.0, 1.0002, 1.0004, 1.00061]
out = {}
for unit, k in (("nF", 1.), ("pF", 1e3), ("F", 1e-9)):
    y = [v * k for v in nf]
    f = ta.line_fit(x, y)
    p = f.x_from_y([1.0003 * k])
    slope, icept = np.polyfit(x, y, 1)
    right = (1.0003 * k - icept) / slope
    s = np.sqrt(sum((v - icept - slope * u)**2 for u, v in zip(x, y)) / 2)
    xm = np.mean(x)
    u = s / slope * np.sqrt(1 + 1 / 4 + (right - xm)**2 / sum((v - xm)**2 for v in x))
    out[unit] = value(p), uncertainty(p), right, u
    print(f"in {unit:2s}: slope {value(f.slope):.4g}, x_from_y {value(p):.7g} u {uncertainty(p):.3g}; by hand {right:.0f} u {u:.0f} Pa")
    assert abs(value(f.slope) / slope - 1) < 1e-6 and abs(right / out["nF"][2] - 1) < 1e-6
for unit in ("nF", "pF"):
    assert abs(out[unit][0] / out[unit][2] - 1) < 1e-6 and abs(out[unit][1] / out[unit][3] - 1) < .01
assert abs(out["F"][0] - 9.99998e-10) < 1e-15 and out["F"][2] > 1.4e6
P
