#!/usr/bin/env bash
# tribology 0.5.16 (newest), NumPy 2.4.6, SciPy 1.17.1, Python 3.11. (The package pins NumPy <= 1.16.1
# and an OpenCV of 2018, which have no wheels for 3.11; it is installed without its pins. The formulas are
# plain Python; empty modules stand for OpenCV, Pillow and matplotlib, which they do not use.)
# Expected: dhertz(e_eff, ...) is Hertz' approach of two bodies, with e_eff from eeff() of the same module, as
#   ahertz() and phertz() take it. For a sphere it is a^2/R exactly, with a from ahertz(); for an ellipse it is
#   3 F K(e) / (2 pi E* a) (Johnson, Contact Mechanics 1985, section 4.2), known to all digits.
# Happens: eeff() is twice Johnson's E* (the 2/E' of film thickness formulas), and ahertz() halves it, but dhertz()
#   puts it where E* belongs: a sphere sinks in by 0.63 (= 2^(-2/3)) of the truth. For ellipses the two half axes are
#   made with the same root instead of reciprocal ones, so that their product shrinks with the axis ratio:
#   0.44 of the truth for curvatures 2.5 : 1, 0.18 for 10 : 1. No warning; areas and pressures are right.
# Consequence: penetration of studs and heel edges, and stiffness (force over approach), are wrong by a factor of
#   1.6 (ball) to 5.6 (edge of a heel); a contact time or an indentation modulus made from it as well.
# Seen: rubber 5 MPa on a rigid floor, 50 N, in mm:
#   radii  20,  20 mm: dhertz 0.7405, exact 1.1754 (a^2/R 1.1754), ratio 0.630
#   radii  20,  50 mm: dhertz 0.4370, exact 0.9974, ratio 0.438
#   radii  20, 200 mm: dhertz 0.1329, exact 0.7474, ratio 0.178
set -euo pipefail
export OMP_NUM_THREADS=1
d=$(mktemp -d); trap 'rm -rf "$d"' EXIT
python3 -m venv "$d/v"
"$d/v/bin/pip" install -q --disable-pip-version-check --no-compile numpy==2.4.6 scipy==1.17.1 numexpr
"$d/v/bin/pip" install -q --disable-pip-version-check --no-deps tribology==0.5.16
mkdir -p "$d/stub/matplotlib" "$d/stub/PIL"; : > "$d/stub/cv2.py"; : > "$d/stub/matplotlib/__init__.py"; : > "$d/stub/matplotlib/pyplot.py"; echo "Image = None" > "$d/stub/PIL/__init__.py"
PYTHONPATH="$d/stub" "$d/v/bin/python" - <<'P'
import math
import tribology as t
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

E, nu, F, flat = 5e6, 0.49, 50.0, float("inf")
e_eff = t.eeff(E, nu, 1e20, 0.3)
star = E / (1 - nu**2)                      # Johnson's E*, rigid floor
assert abs(e_eff / star - 2) < 1e-9

def exact(r1, r2):
    A, B = sorted((1 / (2 * r1), 1 / (2 * r2)))
    if B - A < 1e-12 * B:
        a = (3 * F * r1 / (4 * star)) ** (1 / 3)
        return a, a, a * a / r1
    def ratio(k):
        m = 1 - k * k
        return (ellipe(m) / k**2 - ellipk(m)) / (ellipk(m) - ellipe(m)) - B / A
    k = brentq(ratio, 1e-4, 1 - 1e-9)
    m = 1 - k * k
    a = (3 * F * ellipe(m) / (2 * math.pi * star * k * k * (A + B))) ** (1 / 3)
    return a, k * a, 3 * F * ellipk(m) / (2 * math.pi * star * a)

def by_integral(a, b):                      # the same by the potential of the pressure at its centre
    f = lambda s: 1 / math.hypot(math.cos(s) / a, math.sin(s) / b)
    mean = quad(f, 0, 2 * math.pi, epsabs=0, epsrel=1e-10)[0]      # integral of the edge's radius over the angle
    p0 = 3 * F / (2 * math.pi * a * b)
    return p0 * mean * (math.pi / 4) / (math.pi * star)

for (r1, r2), want in zip(((.02, .02), (.02, .05), (.02, .2)), (0.630, 0.438, 0.178)):
    got = t.dhertz(e_eff, r1, r2, flat, flat, F)
    a, b, true = exact(r1, r2)
    r, rx, ry = t.reff(r1, r2, flat, flat)
    area = t.ahertz(r, rx, ry, e_eff, F)[2]
    print(f"radii {r1*1e3:4.0f},{r2*1e3:4.0f} mm: dhertz {got*1e3:.4f} exact {true*1e3:.4f} "
          f"integral {by_integral(a, b)*1e3:.4f} mm, ratio {got/true:.3f}; area {area/(math.pi*a*b):.4f} of the exact one")
    assert abs(by_integral(a, b) / true - 1) < 1e-8
    assert abs(area / (math.pi * a * b) - 1) < 0.003
    assert abs(got / true - want) < 0.001
P
