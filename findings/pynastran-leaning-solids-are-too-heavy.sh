#!/usr/bin/env bash
# pyNastran 1.4.1 (newest), NumPy 1.26.4 (it wants below 2), SciPy 1.17.1, pandas 2.3.3, Matplotlib 3.10.8, Python 3.11.
# Expected: mass_properties(model) and Volume() of a CHEXA, CPENTA or CPYRAM give the solid's mass and volume. A block that
#   leans keeps its volume, base times height, whatever corner the numbering starts from, and the six tetrahedra that fill it
#   have the same. A pyramid's centre of gravity lies at a quarter of its height.
# Happens: the mean of two opposite faces is multiplied by the distance of their centres, which is the slant, not the height:
#   the volume grows by 1 / cos of the lean. A CPYRAM's centre is put at half of its height, a tapered hexahedron gets the
#   mean of its two faces. CTETRA is right, upright bricks too, which is why one does not see it. No warning.
# Consequence: soles, tyres and feet are meshed with leaning bricks: weight, inertia and centre of gravity are off, the mass by
#   15 per cent at 30 degrees and 41 at 45; they change when the elements are renumbered, and are not those of the same
#   block in tetrahedra.
# Seen: block 10 x 10 x 10 mm leaning by 45 degrees: CHEXA 1414 or 1000 mm3, by numbering, two CPENTA 1414, six CTETRA 1000, right
#   1000; pyramid 12 mm high: centre at 6.0, right 3.0; leaning one 566, right 400 mm3; frustum 100 to 4 mm2: 520, right 413.
set -euo pipefail
export OMP_NUM_THREADS=1 MPLBACKEND=Agg
d=$(mktemp -d); trap 'rm -rf "$d"' EXIT
python3 -m venv "$d/v"
"$d/v/bin/pip" install -q --disable-pip-version-check --no-compile pyNastran==1.4.1 numpy==1.26.4 scipy==1.17.1 pandas==2.3.3 \
  matplotlib==3.10.8
"$d/v/bin/python" -W ignore - <<'P'
import numpy as np
from pyNastran.bdf.bdf import BDF
from pyNastran.bdf.mesh_utils.mass_properties import mass_properties
from scipy.spatial import ConvexHull

RHO = 1.1e-9                                                             # t/mm3, rubber

def case(name, points, cards):
    m = BDF(debug=None)
    for i, p in enumerate(points, 1):
        m.add_grid(i, p)
    m.add_mat1(1, 5., None, .49, rho=RHO)
    m.add_psolid(1, 1)
    for i, (card, nodes) in enumerate(cards, 1):
        getattr(m, "add_" + card)(i, 1, nodes)
    m.cross_reference()
    mass, cg, inertia = mass_properties(m)
    right = ConvexHull(points).volume
    print(f"{name}: mass over density {mass / RHO:.1f} mm3 (right {right:.1f}), centre of gravity {np.round(cg, 2)}")
    assert abs(sum(e.Volume() for e in m.elements.values()) * RHO / mass - 1) < 1e-9
    return mass / RHO, right, cg

base = np.array([[0., 0, 0], [10, 0, 0], [10, 10, 0], [0, 10, 0]])
block = lambda lean: np.vstack([base, base + [10 * np.tan(np.radians(lean)), 0, 10]])
brick = [1, 2, 3, 4, 5, 6, 7, 8]
side = [1, 2, 6, 5, 4, 3, 7, 8]                                          # the same brick, numbered from another face
tets = [[1, 2, 3, 7], [1, 3, 4, 7], [1, 5, 6, 7], [1, 6, 2, 7], [1, 4, 8, 7], [1, 8, 5, 7]]
for lean in (0, 30, 45):
    v, right, _ = case(f"CHEXA leaning by {lean} degrees", block(lean), [("chexa", brick)])
    assert abs(right - 1000) < 1e-6 and abs(v * np.cos(np.radians(lean)) - 1000) < 1e-6
v, right, _ = case("CHEXA leaning by 45 degrees, other numbering", block(45), [("chexa", side)])
assert abs(v - 1000) < 1e-6
v, right, _ = case("two CPENTA leaning by 45 degrees", block(45), [("cpenta", [1, 2, 3, 5, 6, 7]), ("cpenta", [1, 3, 4, 5, 7, 8])])
assert abs(v - 1414.2) < .1
v, right, _ = case("six CTETRA leaning by 45 degrees", block(45), [("ctetra", t) for t in tets])
assert abs(v - 1000) < 1e-6
v, right, cg = case("CPYRAM 12 mm high", np.vstack([base, [[5, 5, 12]]]), [("cpyram", [1, 2, 3, 4, 5])])
assert abs(v - right) < 1e-6 and abs(cg[2] - 6) < 1e-9                    # right: 3
v, right, cg = case("the same as two CTETRA", np.vstack([base, [[5, 5, 12]]]), [("ctetra", [1, 2, 3, 5]), ("ctetra", [1, 3, 4, 5])])
assert abs(v - right) < 1e-6 and abs(cg[2] - 3) < 1e-9
v, right, cg = case("CPYRAM leaning by 45 degrees", np.vstack([base, [[17, 5, 12]]]), [("cpyram", [1, 2, 3, 4, 5])])
assert abs(right - 400) < 1e-6 and abs(v - 565.7) < .1
v, right, cg = case("CHEXA, frustum", np.vstack([base, (base - [5, 5, 0]) * .2 + [5, 5, 10]]), [("chexa", brick)])
assert abs(right - 413.333) < .01 and abs(v - 520) < 1e-6
P
