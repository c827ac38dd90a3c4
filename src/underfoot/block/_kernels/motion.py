"""Contact of the lower face with the floor, and the central-difference move of all nodes."""

import math

from numba import njit

from . import names as at
from .floor import cosine_floor, floor_height


@njit(cache=True, inline="always")
def _smooth(t):
    """Return 0 to 1 with a level start and end."""
    return 0.0 if t <= 0.0 else (1.0 if t >= 1.0 else 0.5 - 0.5 * math.cos(math.pi * t))


@njit(cache=True, inline="always")
def _slide_speed(time, control):
    since = time - control[at.SLIDE_START]
    if since < 0.0:
        return 0.0
    if since >= control[at.RAMP]:
        return control[at.SPEED]
    return control[at.SPEED] * _smooth(since / control[at.RAMP])


@njit(cache=True, error_model="numpy", fastmath=True)
def _cosine_gaps(x, y, z, ux, uy, uz, numbers, slid, out):
    gap, slope_x, slope_y = out[0], out[1], out[2]
    for n in range(x.size):
        h, hx, hy = cosine_floor(x[n] + ux[n] + slid, y[n] + uy[n], numbers)
        gap[n] = z[n] + uz[n] - h
        slope_x[n] = hx
        slope_y[n] = hy


@njit(cache=True, error_model="numpy")
def _gaps(x, y, z, ux, uy, uz, floor, slid, out):
    form, numbers, coefficients, highest = floor
    for n in range(x.size):
        zn = z[n] + uz[n]
        out[0, n] = 1.0
        if zn > highest:
            continue
        h, hx, hy = floor_height(x[n] + ux[n] + slid, y[n] + uy[n], form, numbers, coefficients)
        out[0, n] = zn - h
        out[1, n] = hx
        out[2, n] = hy


@njit(cache=True, error_model="numpy")
def contact(nodes, mesh, floor, state, control):
    """Take the floor's push off the internal forces; minus the gradient of k A gap^2 / 2."""
    u, v, f = nodes
    _, x, y, z, area, stiffness, root, _, _, _, _, out = mesh
    stride = u.size // 3
    size = x.size
    ux, uy, uz = u[:size], u[stride : stride + size], u[2 * stride : 2 * stride + size]
    slid = state[at.SLID]
    speed = _slide_speed(state[at.TIME], control)
    zeta, dt = control[at.ZETA], control[at.DT]
    if floor[0] == 1:
        _cosine_gaps(x, y, z, ux, uy, uz, floor[1], slid, out)
    else:
        _gaps(x, y, z, ux, uy, uz, floor, slid, out)
    fx = fy = fz = closed = energy = lost = 0.0
    for n in range(size):
        gap = out[0, n]
        if gap >= 0.0:
            continue
        hx, hy = out[1, n], out[2, n]
        k = stiffness[n]  # 0, as the area, of nodes that stand for others
        elastic = -k * gap
        push = elastic
        if zeta > 0.0:
            rate = v[2 * stride + n] - hx * (v[n] + speed) - hy * v[stride + n]
            push = elastic - 2.0 * zeta * root[n] * rate
            if push < 0.0:
                push = 0.0
            lost += (elastic - push) * rate * dt
        energy += 0.5 * k * gap * gap
        closed += area[n]
        f[n] += push * hx
        f[stride + n] += push * hy
        f[2 * stride + n] -= push
        fx += push * hx
        fy += push * hy
        fz += push
    # Against sliding: the floor pushes the block towards -x with the sum of push * h_x.
    state[at.FLOOR_WORK] += 0.5 * (state[at.LAST_SHEAR] + fx) * state[at.LAST_STEP]
    state[at.LAST_SHEAR] = fx
    state[at.CONTACT_LOSS] += lost
    state[at.CONTACT_ENERGY] = energy
    state[at.NORMAL] += fz
    state[at.SHEAR] += fx
    state[at.LATERAL] -= fy
    state[at.AREA] += closed
    state[at.ABSOLUTE] += abs(fx)
    state[at.RESULTANT] += math.sqrt(fx * fx + fy * fy)
    state[at.COUNT] += 1.0


@njit(cache=True, error_model="numpy")
def _join_sides(f, mesh_size, columns, rows, layers):
    """Give the nodes of opposite sides the sum of their forces."""
    stride = mesh_size
    plane = columns * rows
    for axis in range(3):
        for k in range(layers):
            base = axis * stride + k * plane
            for j in range(rows):
                a, b = base + j * columns, base + j * columns + columns - 1
                f[a] += f[b]
                f[b] = f[a]
            for i in range(columns):
                a, b = base + i, base + (rows - 1) * columns + i
                f[a] += f[b]
                f[b] = f[a]


@njit(cache=True, error_model="numpy", fastmath=True)
def _move_free(u, v, f, inverse, dt, keep, gain):
    for n in range(u.size):
        speed = keep * v[n] - gain * f[n] * inverse[n]
        v[n] = speed
        u[n] += dt * speed


@njit(cache=True, error_model="numpy", fastmath=True)
def _kinetic(v, f, inverse, mass, keep, gain):
    total = 0.0
    for n in range(v.size):
        total += 0.5 * mass[n] * (keep * v[n] - gain * f[n] * inverse[n]) * v[n]
    return total


@njit(cache=True, error_model="numpy", fastmath=True)
def _damping_work(v, f, inverse, mass, keep, gain):
    total = 0.0
    for n in range(v.size):
        mean = 0.5 * ((1.0 + keep) * v[n] - gain * f[n] * inverse[n])
        total += mass[n] * mean * mean
    return total


@njit(cache=True, error_model="numpy")
def move(nodes, mesh, state, control, sample):
    """Move every node by a step: the top in one piece, the rest freely; the floor slides on."""
    u, v, f = nodes
    inverse, mass = mesh[7], mesh[8]
    top_mass = mesh[9][0]
    columns, rows, layers = int(control[at.COLUMNS]), int(control[at.ROWS]), int(control[at.LAYERS])
    plane = columns * rows
    stride = u.size // 3
    free = plane * (layers - 1)
    dt, alpha = control[at.DT], control[at.ALPHA]
    keep = (1.0 - 0.5 * alpha * dt) / (1.0 + 0.5 * alpha * dt)
    gain = dt / (1.0 + 0.5 * alpha * dt)

    reaction = 0.0
    for n in range(2 * stride + free, 2 * stride + free + plane):
        reaction += f[n]
    if control[at.PERIODIC] != 0.0:
        _join_sides(f, stride, columns, rows, layers)
    if sample:
        state[at.KINETIC] = 0.0
    for axis in range(3):
        a, b = axis * stride, axis * stride + free
        ua, va, fa = u[a:b], v[a:b], f[a:b]
        if sample:
            state[at.KINETIC] += _kinetic(va, fa, inverse, mass, keep, gain)
        if alpha > 0.0:
            state[at.DAMPING_LOSS] += alpha * dt * _damping_work(va, fa, inverse, mass, keep, gain)
        _move_free(ua, va, fa, inverse, dt, keep, gain)

    before = state[at.TOP_SPEED]
    after = 0.0
    push = reaction
    if control[at.FREE] != 0.0:
        load = control[at.LOAD]
        if control[at.LOAD_TIME] > 0.0:
            load *= _smooth(state[at.TIME] / control[at.LOAD_TIME])
        drag = control[at.PLATE_DAMPING]
        total = control[at.PLATE_MASS] + top_mass
        after = before * (total - 0.5 * dt * drag) - dt * (reaction + load)
        after /= total + 0.5 * dt * drag
        push += top_mass * (after - before) / dt
    state[at.TOP_WORK] += 0.5 * dt * push * before
    if sample:
        state[at.KINETIC] += 0.5 * top_mass * before * after
        state[at.SAMPLE_TOP_WORK] = state[at.TOP_WORK]
        state[at.SAMPLE_FLOOR_WORK] = state[at.FLOOR_WORK]
    state[at.TOP_WORK] += 0.5 * dt * push * after
    state[at.TOP_SPEED] = after
    state[at.TOP] += dt * after
    for n in range(2 * stride + free, 2 * stride + free + plane):
        u[n] = state[at.TOP]
        v[n] = after
    on = dt * _slide_speed(state[at.TIME] + 0.5 * dt, control)
    state[at.LAST_STEP] = on
    state[at.SLID] += on
    state[at.TIME] += dt
