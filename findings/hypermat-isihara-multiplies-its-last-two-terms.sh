#!/usr/bin/env bash
# hypermat 0.1.2 (newest), NumPy 2.4.6, SciPy 1.17.1, tensortrax 0.29.0, lmfit 1.3.4, Python 3.11.
# Expected: Isihara(C10, C20, C01) is W = C10 (I1 - 3) + C20 (I1 - 3)^2 + C01 (I2 - 3) (Isihara, Hashitsume, Tatibana,
#   J. Chem. Phys. 19 (1951) 1508): shear modulus 2 (C10 + C01); with C20 = 0 it is Mooney and Rivlin's rubber.
# Happens: the last two terms are multiplied, C20 (I1 - 3)^2 C01 (I2 - 3): at small strain neither counts, the shear modulus is
#   2 C10, and with C20 = 0 or C01 = 0 both are gone. Constants are no longer of one unit. No warning.
# Consequence: rubber of the published constants is too soft from the first strain on, by C01 / (C10 + C01): a third here;
#   Mooney's part, by which tension and pressure differ, is lost in every analysis of a sole.
# Seen: C10 0.4, C20 0.02, C01 0.2 MPa: stress at stretch 1.01, 1.5, 2: package 0.0238, 0.851, 1.498 MPa; the same constants in its
#   Biderman (C30 = 0) 0.0355, 1.175, 2.030; by hand 0.0355, 1.175, 2.030; C20 = 0: package = NeoHooke(C10), right = MooneyRivlin.
set -euo pipefail
export OMP_NUM_THREADS=1 MPLBACKEND=Agg
d=$(mktemp -d); trap 'rm -rf "$d"' EXIT
python3 -m venv "$d/v"
"$d/v/bin/pip" install -q --disable-pip-version-check --no-compile --only-binary :all: hypermat==0.1.2 numpy==2.4.6 scipy==1.17.1 tensortrax==0.29.0 lmfit==1.3.4 \
  matplotlib==3.11.2
"$d/v/bin/python" -W ignore - <<'P'
import numpy as np
from hypermat import Biderman, Isihara, MooneyRivlin, NeoHooke

def stress(material, stretch):
    """Nominal stress in tension, volume kept: the transverse stress is taken off as pressure."""
    f = np.diag([stretch, stretch**-.5, stretch**-.5]).reshape(3, 3, 1, 1)
    p = np.asarray(material.jacobian(f)).reshape(3, 3)
    return float(p[0, 0] - p[1, 1] * stretch**-1.5)

def hand(l, c10, c20, c01):
    return 2 * (l - l**-2) * (c10 + 2 * c20 * (l * l + 2 / l - 3) + c01 / l)

for l in (1.01, 1.5, 2.):
    isihara = stress(Isihara(C10=.4, C20=.02, C01=.2, K=2000), l)
    biderman = stress(Biderman(C10=.4, C20=.02, C30=0., C01=.2, K=2000), l)
    right = hand(l, .4, .02, .2)
    print(f"stretch {l}: Isihara {isihara:.4f}, as Biderman {biderman:.4f}, by hand {right:.4f} MPa")
    assert abs(biderman - right) < 1e-6 * right and isihara < .75 * right
    plain, neo = stress(Isihara(C10=.4, C20=0., C01=.2, K=2000), l), stress(NeoHooke(C10=.4, K=2000), l)
    mooney = stress(MooneyRivlin(C10=.4, C01=.2, K=2000), l)
    print(f"            without C20 {plain:.4f}, NeoHooke {neo:.4f}, MooneyRivlin {mooney:.4f} MPa")
    assert abs(plain - neo) < 1e-9 and abs(mooney - hand(l, .4, 0, .2)) < 1e-6
P
