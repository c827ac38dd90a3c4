#!/usr/bin/env bash
# tribology 0.5.16 (newest), NumPy 2.4.6, SciPy 1.17.1, Python 3.11. (Installed without its pins of 2018, which have
# no wheels for 3.11; empty modules stand for OpenCV, Pillow and matplotlib, which the formulas do not use.)
# Expected: ahertz(r_eff, r_eff_x, r_eff_y, ...) returns "the contact area half axis in x-direction" first and that in
#   y-direction second. The ellipse is long where the body is flat: with r_eff_x > r_eff_y it is long in x
#   (Hertz; Johnson, Contact Mechanics 1985, section 4.1), and turning the body by 90 degrees exchanges the two.
# Happens: the ratio of the radii is inverted when it is above one, and the result is not turned back: the first half
#   axis is the shorter one, whichever way the body lies. Swapping the radii changes nothing. No warning; the area
#   and the pressure, which is what one would check, are right.
# Consequence: a heel edge across the walking direction gets the footprint of one along it, four times as long in the
#   direction of sliding: entrainment length, squeeze-out time, overlap with a groove or a tile's joint are wrong.
# Seen: rubber 5 MPa, 50 N, radii 200 mm in x and 20 mm in y: half axes x 3.14, y 14.12 mm; right x 14.15, y 3.14 mm;
#   radii 20 in x and 200 in y: the same x 3.14, y 14.12 mm, right here.
set -euo pipefail
export OMP_NUM_THREADS=1
d=$(mktemp -d); trap 'rm -rf "$d"' EXIT
python3 -m venv "$d/v"
"$d/v/bin/pip" install -q --disable-pip-version-check --no-compile numpy==2.4.6 scipy==1.17.1 numexpr
"$d/v/bin/pip" install -q --disable-pip-version-check --no-deps tribology==0.5.16
mkdir -p "$d/stub/matplotlib" "$d/stub/PIL"; : > "$d/stub/cv2.py"; : > "$d/stub/matplotlib/__init__.py"; : > "$d/stub/matplotlib/pyplot.py"; echo "Image = None" > "$d/stub/PIL/__init__.py"
PYTHONPATH="$d/stub" "$d/v/bin/python" - <<'P'
import math
import numpy as np
import tribology as t
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

E, nu, F, flat = 5e6, 0.49, 50.0, float("inf")
star = E / (1 - nu**2)
e_eff = t.eeff(E, nu, 1e20, 0.3)

def exact(rx, ry):                           # half axes in x and y from the elliptic integrals
    A, B = sorted((1 / (2 * rx), 1 / (2 * ry)))
    def ratio(k):
        m = 1 - k * k
        return (ellipe(m) / k**2 - ellipk(m)) / (ellipk(m) - ellipe(m)) - B / A
    k = brentq(ratio, 1e-4, 1 - 1e-9)
    a = (3 * F * ellipe(1 - k * k) / (2 * math.pi * star * k * k * (A + B))) ** (1 / 3)
    return (a, k * a) if rx > ry else (k * a, a)

def check(ax, ay, rx, ry):                   # does that pressure bend the surface to the body's two curvatures?
    p0 = 3 * F / (2 * math.pi * ax * ay)     # curvature of the half-space under p0 sqrt(1 - x^2/ax^2 - y^2/ay^2)
    s = (np.arange(200000) + .5) / 200000 * math.pi / 2
    q = np.cos(s)**2 / ax**2 + np.sin(s)**2 / ay**2
    kx = 2 * p0 / star / ax**2 / ay**2 * (np.sin(s)**2 / q**1.5).mean() * math.pi / 2
    ky = 2 * p0 / star / ax**2 / ay**2 * (np.cos(s)**2 / q**1.5).mean() * math.pi / 2
    return 1 / kx, 1 / ky

seen = {}
for rx, ry in ((.2, .02), (.02, .2)):
    r, ex, ey = t.reff(rx, ry, flat, flat)
    assert (ex, ey) == (rx, ry)
    got = t.ahertz(r, ex, ey, e_eff, F)[:2]
    want = exact(rx, ry)
    back = check(*want, rx, ry)
    seen[rx] = got, want
    print(f"radii x {rx*1e3:.0f} y {ry*1e3:.0f} mm: ahertz x {got[0]*1e3:.2f} y {got[1]*1e3:.2f}  "
          f"exact x {want[0]*1e3:.2f} y {want[1]*1e3:.2f} (these give radii {back[0]*1e3:.1f} and {back[1]*1e3:.1f})")
    assert abs(back[0] / rx - 1) < 1e-4 and abs(back[1] / ry - 1) < 1e-4
assert seen[.2][0] == seen[.02][0]                                  # turning the body changes nothing
assert abs(seen[.02][0][0] / seen[.02][1][0] - 1) < .005            # right for the one
assert abs(seen[.2][0][0] / seen[.2][1][1] - 1) < .005              # across for the other
assert seen[.2][1][0] / seen[.2][0][0] > 4
P
