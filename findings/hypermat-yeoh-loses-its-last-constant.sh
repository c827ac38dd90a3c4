#!/usr/bin/env bash
# hypermat 0.1.2 (newest), NumPy 2.4.6, SciPy 1.17.1, tensortrax 0.29.0, lmfit 1.3.4, Python 3.11.
# Expected: Yeoh(C10=0.5, C20=-0.01, C30=0.2, K=2000), the line of its README, is Yeoh's rubber of three constants:
#   nominal stress in tension 2 (l - l^-2) (C10 + 2 C20 (I1 - 3) + 3 C30 (I1 - 3)^2).
# Happens: the bulk modulus is taken out of the arguments before the energy is formed, and the energy leaves out the last
#   argument in the belief that it is K: C30 never counts. Yeoh of two constants is neo-Hooke. No warning.
# Consequence: a rubber fitted elsewhere loses its stiffening, the reason for which Yeoh is chosen: at twice its length it
#   is a sixth as stiff; a fit with hypermat returns as C30 its own starting value, of which the curve knows nothing.
# Seen: stretch 1.5, 2, 2.5: package 1.031, 1.610, 1.961 MPa; the same constants in its Biderman (C01 = 0) 1.462, 10.010,
#   48.019; by hand 1.462, 10.010, 48.019; C30 = 0.2 and C30 = 200 give the same; Yeoh(C10, C20) equals NeoHooke(C10).
set -euo pipefail
export OMP_NUM_THREADS=1 MPLBACKEND=Agg
d=$(mktemp -d); trap 'rm -rf "$d"' EXIT
python3 -m venv "$d/v"
"$d/v/bin/pip" install -q --disable-pip-version-check --no-compile --only-binary :all: hypermat==0.1.2 numpy==2.4.6 scipy==1.17.1 tensortrax==0.29.0 lmfit==1.3.4 \
  matplotlib==3.11.2
"$d/v/bin/python" -W ignore - <<'P'
import numpy as np
from hypermat import Biderman, NeoHooke, Yeoh

def stress(material, stretch):
    """Nominal stress in tension, volume kept: the transverse stress is taken off as pressure."""
    f = np.diag([stretch, stretch**-.5, stretch**-.5]).reshape(3, 3, 1, 1)
    p = np.asarray(material.jacobian(f)).reshape(3, 3)
    return float(p[0, 0] - p[1, 1] * stretch**-1.5)

def hand(l, c10, c20, c30):
    i = l * l + 2 / l - 3
    return 2 * (l - l**-2) * (c10 + 2 * c20 * i + 3 * c30 * i * i)

for l in (1.5, 2., 2.5):
    yeoh = stress(Yeoh(C10=.5, C20=-.01, C30=.2, K=2000), l)
    large = stress(Yeoh(C10=.5, C20=-.01, C30=200., K=2000), l)
    biderman = stress(Biderman(C10=.5, C20=-.01, C30=.2, C01=0., K=2000), l)
    right = hand(l, .5, -.01, .2)
    print(f"stretch {l}: Yeoh {yeoh:.3f} (C30 a thousand times {large:.3f}), as Biderman {biderman:.3f}, by hand {right:.3f} MPa")
    assert abs(biderman - right) < 1e-6 * right and abs(yeoh - large) < 1e-9
    assert abs(yeoh - hand(l, .5, -.01, 0)) < 1e-6 and yeoh < .8 * right
    two, neo = stress(Yeoh(C10=.5, C20=.1, K=2000), l), stress(NeoHooke(C10=.5, K=2000), l)
    print(f"             Yeoh(C10, C20) {two:.3f}, NeoHooke(C10) {neo:.3f}, by hand {hand(l, .5, .1, 0):.3f} MPa")
    assert abs(two - neo) < 1e-9
P
