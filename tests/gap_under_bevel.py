"""Makes ``tests/data/gap_under_bevel.csv``: how a bevelled heel gives way, by elements of order 4.

Nothing of Underfoot is used: a solid of constructive geometry (Netgen), tetrahedra of the order
given (NGSolve), half of the heel. Run: python tests/gap_under_bevel.py [order] (4: minutes).
"""

import csv
import math
import sys
from pathlib import Path

import netgen.occ as occ
import ngsolve as ng

MM = 1e-3
LENGTH, WIDTH, RADIUS, FACET, ANGLE = 75 * MM, 70 * MM, 33 * MM, 30 * MM, math.radians(10)
MODULUS, RATIO, PRESSURE = 4e6, 0.49, 2e5
SOFT = 2e6, 0.3
BODIES = {"rubber": (25 * MM, 0.0), "rubber on foam": (10 * MM, 15 * MM)}
LOADS = {"facet": (0.0, 1.0), "rear": (0.0, 12 * MM), "front": (18 * MM, 1.0)}
"""From and to which place along x (m, from the rear end) of the facet the pressure acts."""
REAR = -FACET * math.tan(ANGLE) * math.sin(ANGLE)
PLACES = [(x * MM, y * MM) for y in (0.5, 15.0) for x in (4, 8, 12, 16, 20, 24, 28, 32, 36)]


def solid(rubber: float, foam: float):
    """Return half the heel (y > 0) tilted so that its facet is level, in m."""
    half, top = WIDTH / 2, rubber + foam
    body = occ.Box((RADIUS, 0, 0), (LENGTH, half, top)) + occ.Box(
        (0, 0, 0), (RADIUS, half - RADIUS, top)
    )
    body += occ.Cylinder((RADIUS, half - RADIUS, 0), occ.Z, r=RADIUS, h=top) * occ.Box(
        (-1, 0, -1), (1, 1, 1)
    )
    normal = occ.Vec(-math.sin(ANGLE), 0, -math.cos(ANGLE))
    body = body * occ.HalfSpace(occ.Pnt(FACET, 0, 0), normal)
    parts = [body]
    if foam:
        layer = occ.Box((-1, -1, -1), (1, 1, rubber))
        parts = [body * layer, body - layer]
    for part, name in zip(parts, ("rubber", "foam"), strict=False):
        part.mat(name)
    level = occ.Axis((0, 0, 0), occ.Y)
    glued = occ.Glue(parts).Rotate(level, -math.degrees(ANGLE))
    floor = FACET * math.sin(ANGLE)
    for face in glued.faces:
        at = face.center
        up = -at.x * math.sin(ANGLE) + at.z * math.cos(ANGLE)  # along the shoe's normal
        face.name = "side"
        if abs(up - top) < 1e-6:
            face.name = "foot"
        elif abs(at.z - floor) < 1e-5:
            face.name, face.maxh = "facet", 3 * MM
        elif abs(at.y) < 1e-6:
            face.name = "middle"
    return glued, floor


def rises(rubber: float, foam: float, order: int) -> dict[str, list[float]]:
    """Return the rise (m) at ``PLACES`` under each load."""
    shape, floor = solid(rubber, foam)
    mesh = ng.Mesh(occ.OCCGeometry(shape).GenerateMesh(maxh=7 * MM, grading=0.4))
    mesh.Curve(2)
    space = ng.VectorH1(mesh, order=order, dirichlet="foot", dirichlety="middle")
    u, v = space.TnT()

    def strain(field):
        return 0.5 * (ng.Grad(field) + ng.Grad(field).trans)

    def lame(modulus, ratio):
        return modulus / (2 * (1 + ratio)), modulus * ratio / ((1 + ratio) * (1 - 2 * ratio))

    both = {"rubber": lame(MODULUS, RATIO), "foam": lame(*SOFT)}
    shear, bulk = (mesh.MaterialCF({name: pair[k] for name, pair in both.items()}) for k in (0, 1))
    form = ng.BilinearForm(space, symmetric=True, condense=True)
    form += (
        2 * shear * ng.InnerProduct(strain(u), strain(v)) + bulk * ng.div(u) * ng.div(v)
    ) * ng.dx
    form.Assemble()
    inverse = form.mat.Inverse(space.FreeDofs(True), inverse="sparsecholesky")
    answer = {}
    for name, (start, end) in LOADS.items():
        load = ng.LinearForm(space)
        on = ng.IfPos(ng.x - REAR - start, 1, 0) * ng.IfPos(end + REAR - ng.x, 1, 0)
        load += PRESSURE * on * v[2] * ng.ds("facet", bonus_intorder=12)
        load.Assemble()
        field = ng.GridFunction(space)
        load.vec.data += form.harmonic_extension_trans * load.vec
        field.vec.data = inverse * load.vec
        field.vec.data += form.harmonic_extension * field.vec
        field.vec.data += form.inner_solve * load.vec
        answer[name] = []
        for x, y in PLACES:
            rising = max(0.0, x + REAR - FACET * math.cos(ANGLE)) * math.tan(ANGLE)
            answer[name].append(field(mesh(x + REAR, y, floor + rising + 1e-6))[2])
    print(rubber, foam, order, space.ndof, [round(1e6 * a, 1) for a in answer["facet"][:9]])
    return answer


if __name__ == "__main__":
    order = int(sys.argv[1]) if len(sys.argv) > 1 else 4
    rows = []
    for body, (rubber, foam) in BODIES.items():
        for load, rise in rises(rubber, foam, order).items():
            for (x, y), value in zip(PLACES, rise, strict=True):
                rows.append([body, load, f"{x / MM:g}", f"{y / MM:g}", f"{1e6 * value:.1f}"])
    with (Path(__file__).parent / "data" / "gap_under_bevel.csv").open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["body", "load", "x_mm", "y_mm", "rise_um"])
        writer.writerows(rows)
