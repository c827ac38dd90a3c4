"""Source of the element loops, unrolled so that the compiler vectorises them.

Node values of ``LANES`` elements lie side by side in one flat work array, element constants and
history in two more: with only three base pointers and literal row offsets LLVM drops its alias
checks and fills whole vector registers. The statements are plain arithmetic,
valid in C++ too: ``benchmarks`` compares both compilers.
"""

import re
from itertools import product

LANES = 64
ELEMENT_ROWS = 37
"""b (3 x 7), hX (4 x 3), V, hourglass stiffness, hourglass viscosity / dt, bulk viscosity / dt."""
VISCOUS_ROWS = 14
"""Last hourglass strains (12), last J, energy lost."""
WORK_ROWS = 66
PARAMETERS = ("half", "third", "one", "four", "eighth", "g0", "bulk")
"""First entries of the parameter array; decay and weight of each term follow."""
VARIANTS = tuple(product(("none", "one", "many"), (False, True)))
"""Number of Prony terms by kind, viscous forms or not."""

Statement = tuple[str, str]
BITS = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
MODES = [(1, 0, 0), (0, 1, 0), (0, 0, 1), (0, 1, 1), (1, 0, 1), (1, 1, 0), (1, 1, 1)]
"""xi, eta, zeta, eta zeta, xi zeta, xi eta, xi eta zeta."""
SYMMETRIC = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))


def kernel_name(terms: str, viscous: bool) -> str:
    """Return the name of one variant's element loop."""
    return f"element_forces_{terms}{'_viscous' if viscous else ''}"


def phases(terms: str, viscous: bool) -> list[list[Statement]]:
    """Return the statements of each pass over the lanes; targets like ``W[3]`` are stored rows."""
    strain = [*_modes(), *_gradient(), *_stress(viscous), *_hourglass(terms, viscous)]
    if terms == "many":
        kept = [(f"W[{39 + n}]", name) for n, name in enumerate(_square("h"))]
        kept += [(f"W[{30 + n}]", name) for n, name in enumerate(_square("t"))]
        kept += [(f"W[{48 + 4 * i + a}]", f"w{i}{a + 3}") for i in range(3) for a in range(4)]
        keep = kept + [(f"W[{24 + n}]", f"s{i}{j}") for n, (i, j) in enumerate(SYMMETRIC)]
        keep += [(f"W[{60 + n}]", "s00 - s00") for n in range(6)]
        again = [*_constants(), *((name, row) for row, name in kept)]
        again += [(f"q{i}{j}", f"W[{60 + n}]") for n, (i, j) in enumerate(SYMMETRIC)]
        again += [("v", "E[33]"), *_deformation(), *_relaxed_pressure()]
        return [[*strain, *keep], [*again, *_nodal()]]
    if terms == "one":
        for n, (i, j) in enumerate(SYMMETRIC):
            row = f"Q[{n + (VISCOUS_ROWS if viscous else 0)}]"
            strain += [(f"q{i}{j}", f"decay * {row} + weight * s{i}{j}"), (row, f"q{i}{j}")]
        strain += _relaxed_pressure()
    return [[*strain, *_nodal()]]


def term_pass() -> list[Statement]:
    """Return the statements that move one Prony term on; ``Q`` counts rows from its own first."""
    rows: list[Statement] = []
    for n in range(6):
        rows += [(f"r{n}", f"decay * Q[{n}] + weight * W[{24 + n}]"), (f"Q[{n}]", f"r{n}")]
        rows += [(f"W[{60 + n}]", f"W[{60 + n}] + r{n}")]
    return rows


def _square(name: str) -> list[str]:
    return [f"{name}{i}{j}" for i in range(3) for j in range(3)]


def _modes() -> list[Statement]:
    """M_iq = sum over nodes of u Lambda_q, by sums and differences along x, y, z."""
    rows: list[Statement] = []
    for i in range(3):
        for a, (x, y, z) in enumerate(BITS):
            rows.append((f"u{i}{x}{y}{z}", f"W[{8 * i + a}]"))
        for y, z in product((0, 1), (0, 1)):
            rows.append((f"a{i}0{y}{z}", f"u{i}1{y}{z} + u{i}0{y}{z}"))
            rows.append((f"a{i}1{y}{z}", f"u{i}1{y}{z} - u{i}0{y}{z}"))
        for p, z in product((0, 1), (0, 1)):
            rows.append((f"b{i}{p}0{z}", f"a{i}{p}1{z} + a{i}{p}0{z}"))
            rows.append((f"b{i}{p}1{z}", f"a{i}{p}1{z} - a{i}{p}0{z}"))
        for q, (p, r, s) in enumerate(MODES):
            sign = "-" if s else "+"
            rows.append((f"m{i}{q}", f"b{i}{p}{r}1 {sign} b{i}{p}{r}0"))
    return rows


def _constants() -> list[Statement]:
    return [(f"g{j}{q}", f"E[{7 * j + q}]") for j in range(3) for q in range(7)]


def _gradient() -> list[Statement]:
    return _constants() + [
        (f"h{i}{j}", " + ".join(f"m{i}{q} * g{j}{q}" for q in range(7)))
        for i, j in product(range(3), range(3))
    ]


def _deformation() -> list[Statement]:
    return [
        (f"f{i}{j}", f"one + h{i}{j}" if i == j else f"h{i}{j}")
        for i, j in product(range(3), range(3))
    ]


def _stress(viscous: bool) -> list[Statement]:
    """Volume times the first Piola-Kirchhoff stress; isochoric second one as s."""
    rows = _deformation()
    for i, j in product(range(3), range(3)):
        a, b = [k for k in range(3) if k != i], [k for k in range(3) if k != j]
        pair = (f"f{a[0]}{b[0]} * f{a[1]}{b[1]}", f"f{a[0]}{b[1]} * f{a[1]}{b[0]}")
        first, second = pair if (i + j) % 2 == 0 else pair[::-1]
        rows.append((f"c{i}{j}", f"{first} - {second}"))
    minors = " + ".join(
        f"(h{a}{a} * h{b}{b} - h{a}{b} * h{b}{a})" for a, b in [(0, 1), (0, 2), (1, 2)]
    )
    det = (
        "h00 * (h11 * h22 - h12 * h21) - h01 * (h10 * h22 - h12 * h20) "
        "+ h02 * (h10 * h21 - h11 * h20)"
    )
    rows += [
        ("v", "E[33]"),
        ("trace", "h00 + h11 + h22"),
        ("dj", f"trace + {minors} + {det}"),
        ("jac", "one + dj"),
        (
            "i1",
            "one + one + one + trace + trace + " + " + ".join(f"{n} * {n}" for n in _square("h")),
        ),
        ("y0", "one - third * dj"),
    ]
    rows += [(f"y{n + 1}", f"third * y{n} * (four - jac * y{n} * y{n} * y{n})") for n in range(3)]
    rows += [
        ("alpha", "g0 * y3 * y3"),
        ("inverse", "one / jac"),
        ("beta", "third * alpha * i1 * inverse"),
    ]
    pressure = "bulk * dj - beta"
    if viscous:
        rows += [
            ("change", "dj - Q[12]"),
            ("push", "E[36] * half * (change - abs(change))"),
            ("Q[12]", "dj"),
            ("lost", "v * push * change"),
        ]
        pressure += " + push"
    rows += [("volumetric", f"v * ({pressure})"), ("distortion", "v * alpha")]
    rows += [
        (f"p{i}{j}", f"distortion * f{i}{j} + volumetric * c{i}{j}")
        for i, j in product(range(3), range(3))
    ]
    rows.append(("gamma", "beta * inverse"))
    for i, j in SYMMETRIC:
        square = " + ".join(f"c{k}{i} * c{k}{j}" for k in range(3))
        rows.append((f"s{i}{j}", f"{'alpha' if i == j else ''} - gamma * ({square})".strip()))
    return rows


def _hourglass(terms: str, viscous: bool) -> list[Statement]:
    """Force of each non-linear mode, and its share that keeps linear fields free of it."""
    rows: list[Statement] = [("stiffness", "E[34]")]
    rows += [(f"x{a}{j}", f"E[{21 + 3 * (a - 3) + j}]") for a in range(3, 7) for j in range(3)]
    for i in range(3):
        for a in range(3, 7):
            linear = " + ".join(f"x{a}{j} * h{i}{j}" for j in range(3))
            rows.append((f"d{i}{a}", f"eighth * m{i}{a} - ({linear})"))
            if viscous:
                row = f"Q[{4 * i + a - 3}]"
                rows += [
                    (f"e{i}{a}", f"d{i}{a} - {row}"),
                    (row, f"d{i}{a}"),
                    (f"w{i}{a}", f"stiffness * d{i}{a} + E[35] * e{i}{a}"),
                ]
            else:
                rows.append((f"w{i}{a}", f"stiffness * d{i}{a}"))
        for j in range(3):
            share = " + ".join(f"w{i}{a} * x{a}{j}" for a in range(3, 7))
            rows.append((f"t{i}{j}", f"p{i}{j} - ({share})"))
    if viscous:
        square = " + ".join(f"e{i}{a} * e{i}{a}" for i in range(3) for a in range(3, 7))
        rows.append(("Q[13]", f"Q[13] + lost + E[35] * ({square})"))
    return rows


def _relaxed_pressure() -> list[Statement]:
    """P less F times the sum of the histories."""
    rows: list[Statement] = []
    for i, j in product(range(3), range(3)):
        inner = " + ".join(f"f{i}{k} * q{min(k, j)}{max(k, j)}" for k in range(3))
        rows.append((f"z{i}{j}", f"t{i}{j} - v * ({inner})"))
    return rows


def _nodal() -> list[Statement]:
    """Nodal forces: mode forces through the transposed sums and differences."""
    rows: list[Statement] = []
    for i in range(3):
        for q in range(7):
            force = " + ".join(f"STRESS{i}{j} * g{j}{q}" for j in range(3))
            rows.append((f"k{i}{q}", f"{force} + eighth * w{i}{q}" if q >= 3 else force))
        mode = {bits: f"k{i}{q}" for q, bits in enumerate(MODES)}
        for p, r in product((0, 1), (0, 1)):
            first = mode.get((p, r, 0))
            second = mode[(p, r, 1)]
            rows.append((f"l{i}{p}{r}1", f"{first} + {second}" if first else second))
            rows.append((f"l{i}{p}{r}0", f"{first} - {second}" if first else f"-{second}"))
        for p, z in product((0, 1), (0, 1)):
            rows.append((f"o{i}{p}1{z}", f"l{i}{p}0{z} + l{i}{p}1{z}"))
            rows.append((f"o{i}{p}0{z}", f"l{i}{p}0{z} - l{i}{p}1{z}"))
        for a, (x, y, z) in enumerate(BITS):
            sign = "+" if x else "-"
            rows.append((f"W[{8 * i + a}]", f"o{i}0{y}{z} {sign} o{i}1{y}{z}"))
    return rows


def variant(terms: str, viscous: bool) -> list[list[Statement]]:
    """Return the passes of one variant, ready to print."""
    name = "t" if terms == "none" else "z"
    return [[(a, b.replace("STRESS", name)) for a, b in rows] for rows in phases(terms, viscous)]


def lane(text: str, shift: str = "") -> str:
    """Return a statement with its rows spelt as offsets of the lane ``l``."""
    text = re.sub(r"\b([WE])\[(\d+)\]", lambda m: f"{m[1]}[{LANES * int(m[2])} + l]", text)
    return re.sub(r"\bQ\[(\d+)\]", lambda m: f"Q[{shift}{LANES * int(m[1])} + l]", text)


def python_loop(rows: list[Statement], shift: str = "", margin: str = "    ") -> str:
    """Return one pass as a Python loop over the lanes."""
    lines = [f"{margin}for l in range({LANES}):"]
    lines += [f"{margin}    {lane(a, shift)} = {lane(b, shift)}" for a, b in rows]
    return "\n".join(lines) + "\n"


def _element_function(terms: str, viscous: bool) -> str:
    passes = variant(terms, viscous)
    text = "@njit(cache=True, fastmath=True, error_model='numpy')\n"
    text += f"def {kernel_name(terms, viscous)}(W, E, Q, P):\n    prefer_wide_registers()\n"
    text += "".join(f"    {name} = P[{n}]\n" for n, name in enumerate(PARAMETERS))
    n = len(PARAMETERS)
    if terms == "one":
        text += f"    decay = P[{n}]\n    weight = P[{n + 1}]\n"
    text += python_loop(passes[0])
    if terms == "many":
        first = LANES * VISCOUS_ROWS if viscous else 0
        text += f"    for term in range((P.size - {n}) // 2):\n"
        text += f"        decay = P[{n} + 2 * term]\n        weight = P[{n + 1} + 2 * term]\n"
        text += f"        row = {first} + {6 * LANES} * term\n"
        text += python_loop(term_pass(), "row + ", "        ")
        text += python_loop(passes[1])
    return text


ADVANCE = """@njit(cache=True, error_model='numpy')
def NAME(count, nodes, mesh, E, Q, P, W, floor, state, control, terms):
    u, v, f = nodes
    offsets = mesh[0]
    for step in range(count):
        f[:] = 0.0
        for c in range(E.shape[0]):
            gather(u, W, c * LANES, offsets)
            KERNEL(W, E[c], Q[c], P)
            scatter(f, W, c * LANES, offsets)
        last = step == count - 1
        if last:
            element_energies(u, mesh, E, Q, control, terms, VISCOUS, state)
        contact(nodes, mesh, floor, state, control)
        move(nodes, mesh, state, control, last)
"""


HEAD = '''"""Element loops, one for each kind of material; made by ``generate``."""

from numba import njit

from underfoot.block._kernels.energy import element_energies
from underfoot.block._kernels.motion import contact, move
from underfoot.block._kernels.loops import prefer_wide_registers


@njit(cache=True, error_model="numpy")
def gather(field, W, first, offsets):
    prefer_wide_registers()
    stride = field.size // 3
    for axis in range(3):
        for corner in range(8):
            a = axis * stride + first + offsets[corner]
            r = (8 * axis + corner) * LANES
            nodes, lanes = field[a : a + LANES], W[r : r + LANES]
            for l in range(LANES):
                lanes[l] = nodes[l]
'''
"""``scatter`` follows from ``gather``: it adds the other way."""


def source() -> str:
    """Return the text of the module of all element loops."""
    head, gather = HEAD.replace("LANES", str(LANES)).split("\n\n\n")
    scatter = gather.replace("lanes[l] = nodes[l]", "nodes[l] += lanes[l]")
    blocks = [head, gather, scatter.replace("gather", "scatter")]
    for terms, viscous in VARIANTS:
        blocks.append(_element_function(terms, viscous))
        name = kernel_name(terms, viscous)
        body = ADVANCE.replace("NAME", name.replace("element_forces", "advance"))
        body = body.replace("KERNEL", name).replace("LANES", str(LANES))
        blocks.append(body.replace("VISCOUS", str(viscous)))
    return "\n\n".join(blocks)
