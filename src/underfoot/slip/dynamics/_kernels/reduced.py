"""Time stepping of the reduced slip: film height and foot speed, compiled."""

import math

import numpy as np

from underfoot.core.compiled import njit

# places of the constants in the parameter vector
AREA, AREA_POWER, AREA_ANGLE = 0, 1, 2
STIFFNESS, DECAY, LEAK, LEAK_ANGLE = 3, 4, 5, 6
WEDGE, WEDGE_ANGLE, LENGTH, START, SHEAR = 7, 8, 9, 10, 11
LEAK_BEND, WEDGE_BEND = 12, 13  # how leakage and wedge bend with the angle
COUNT = 14
REFERENCE_LOAD = 500.0
GAMMA = 1.0 - 1.0 / math.sqrt(2.0)
SMALLEST = 1e-7


@njit(cache=True)
def _contact_pressure(h, p, p0, u):
    """Contact share of a mean pressure: p0 exp(-h/u), rounded off at p."""
    raw = p0 * math.exp(-h / u)
    low, high = min(raw, p), max(raw, p)
    if low <= 0.0:
        return 0.0
    # smooth minimum: all the load at most, and never quite without film while film is there
    return low / (1.0 + (low / high) ** 4) ** 0.25


@njit(cache=True)
def _film_rate(h, v, p, lean, c, viscosity, pool):
    """Rate of the mean film height: leakage under its pressure, inflow by the wedge."""
    pc = _contact_pressure(h, p, c[STIFFNESS], c[DECAY])
    pf = p - pc
    leak = c[LEAK] * math.exp(c[LEAK_ANGLE] * lean + c[LEAK_BEND] * lean**2)
    out = leak * h**3 * pf / (12.0 * viscosity)
    if v <= 0.0:
        return -out
    growth = math.exp(c[WEDGE_ANGLE] * lean + c[WEDGE_BEND] * lean**2)
    drawn = max(c[WEDGE] * growth * viscosity * v, 1e-30)
    height = 1.0 / (1.0 / pool + max(pf, 0.0) / drawn)
    return -out + 0.5 * v / c[LENGTH] * (height - h)


@njit(cache=True)
def _solved_height(base, share, v, p, lean, c, viscosity, pool):
    """Solve h = base + share * rate(h) by bisection safeguarded secant steps."""
    low, high = SMALLEST, 4.0 * pool
    h = min(max(base, low), high)
    for _ in range(60):
        g = h - base - share * _film_rate(h, v, p, lean, c, viscosity, pool)
        if g > 0.0:
            high = h
        else:
            low = h
        eps = 1e-6 * h + 1e-12
        slope = (
            h + eps - base - share * _film_rate(h + eps, v, p, lean, c, viscosity, pool) - g
        ) / eps
        new = h - g / slope if slope > 0.0 else 0.5 * (low + high)
        if not (low < new < high):
            new = 0.5 * (low + high)
        if abs(new - h) < 1e-12 + 1e-9 * h:
            return new
        h = new
    return h


@njit(cache=True)
def _area(load, lean, c):
    return (
        c[AREA]
        * (max(load, 1.0) / REFERENCE_LOAD) ** c[AREA_POWER]
        * math.exp(c[AREA_ANGLE] * lean)
    )


@njit(cache=True)
def _friction(v, h, load, lean, c, viscosity, table_speed, table_cof):
    """Friction force and film load of a state."""
    area = _area(load, lean, c)
    p = load / area
    pc = _contact_pressure(h, p, c[STIFFNESS], c[DECAY]) if viscosity > 0.0 else p
    cof = np.interp(v, table_speed, table_cof)
    force = cof * pc * area
    if viscosity > 0.0:
        force += c[SHEAR] * viscosity * v * area / h
    return force, (p - pc) * area


@njit(cache=True)
def _solved_speed(v, share, push, h, load, lean, c, viscosity, table_speed, table_cof):
    """Root of V - v - share (push - FF(V)) between rest and the speed without friction."""
    low, high = 0.0, v + share * push
    ff, _f = _friction(0.0, h, load, lean, c, viscosity, table_speed, table_cof)
    at_low = -v - share * (push - ff)
    if at_low >= 0.0 or high <= 1e-12:
        return 0.0
    ff, _f = _friction(high, h, load, lean, c, viscosity, table_speed, table_cof)
    at_high = share * ff
    found, side = high, 0
    for _ in range(60):
        if at_high - at_low <= 0.0:
            break
        found = (low * at_high - high * at_low) / (at_high - at_low)
        ff, _f = _friction(found, h, load, lean, c, viscosity, table_speed, table_cof)
        value = found - v - share * (push - ff)
        if abs(value) < 1e-13 or high - low < 1e-13:
            break
        if value < 0.0:
            low, at_low = found, value
            if side < 0:
                at_high *= 0.5
            side = -1
        else:
            high, at_high = found, value
            if side > 0:
                at_low *= 0.5
            side = 1
    return found


@njit(cache=True)
def carry_slip(
    times, normals, drives, leans, dry_speed, transfer, given_speed, mass, c, viscosity, pool,
    table_speed, table_cof, over,
):  # fmt: skip
    """Return speed, film, friction, film load, work, loss, load, drive and the last index.

    ``motion.slip_motion`` in compiled form. With ``given_speed`` (n,) of numbers the speed is
    that, not solved; nan lets the foot move.
    Film by SDIRK2 (L-stable), speed by the trapezoidal rule with the film at both ends.
    """
    n = times.size
    speed, film = np.zeros(n), np.zeros(n)
    friction, fluid = np.zeros(n), np.zeros(n)
    work, lost = np.zeros(n), np.zeros(n)
    wet = viscosity > 0.0
    normals, drives = normals.copy(), drives.copy()
    at_start = -1.0
    speed[0], film[0] = dry_speed[0], c[START]
    held = not math.isnan(given_speed[0])
    if held:
        speed[0] = given_speed[0]
    acceleration, began = 0.0, drives[0]
    last, _f = _friction(
        speed[0], film[0], normals[0], leans[0], c, viscosity, table_speed, table_cof
    )
    end = n - 1
    for i in range(n - 1):
        dt = times[i + 1] - times[i]
        v = speed[i]
        braked = dry_speed[i + 1] - dry_speed[i]
        brake = mass * braked / dt
        if at_start >= 0.0 and normals[i + 1] > at_start:
            share = max(at_start / normals[i + 1], transfer)
            normals[i + 1] *= share
            drives[i + 1] *= share
        net = began + brake - last
        guess = given_speed[i + 1] if held else max(v + dt * acceleration + braked, 0.0)
        new = guess
        h = film[i]
        for _ in range(4 if not held else 1):
            if wet:
                # two implicit stages, load and speed linear within the step
                t1 = GAMMA
                f1 = normals[i] + t1 * (normals[i + 1] - normals[i])
                l1 = leans[i] + t1 * (leans[i + 1] - leans[i])
                v1 = v + t1 * (new - v)
                p1 = f1 / _area(f1, l1, c)
                h1 = _solved_height(film[i], GAMMA * dt, v1, p1, l1, c, viscosity, pool)
                k1 = (h1 - film[i]) / (GAMMA * dt)
                f2, l2 = normals[i + 1], leans[i + 1]
                p2 = f2 / _area(f2, l2, c)
                base = film[i] + (1.0 - GAMMA) * dt * k1
                h = _solved_height(base, GAMMA * dt, new, p2, l2, c, viscosity, pool)
            if held:
                break
            before = new
            load, lean, drive = normals[i + 1], leans[i + 1], drives[i + 1] + brake
            if v <= 1e-9:
                most, _f = _friction(0.0, h, load, lean, c, viscosity, table_speed, table_cof)
                if drive <= most:
                    new = 0.0
                    break
            push = drive + (max(net, 0.0) if v <= 1e-9 else net)
            new = _solved_speed(
                v, 0.5 * dt / mass, push, h, load, lean, c, viscosity, table_speed, table_cof
            )
            if abs(new - before) < 1e-10:
                break
        ff, wf = _friction(
            new, h, normals[i + 1], leans[i + 1], c, viscosity, table_speed, table_cof
        )
        excess = drives[i + 1] + brake - ff
        last = ff
        if new <= 1e-9 and not held:
            new, at_start = 0.0, -1.0
            ff = min(max(drives[i + 1] + brake, 0.0), ff)
        elif at_start < 0.0 and excess > 0.0 and not held:
            before = min(net, 0.0) / (min(net, 0.0) - excess)
            at_start = normals[i] + before * (normals[i + 1] - normals[i])
        speed[i + 1], film[i + 1], friction[i + 1], fluid[i + 1] = new, h, ff, wf
        moved = 0.5 * (v + new) * dt
        asked = 0.5 * (began + drives[i + 1]) + brake
        work[i + 1] = work[i] + asked * moved
        lost[i + 1] = lost[i] + (asked - mass * (new - v) / dt) * moved
        acceleration = (drives[i + 1] - ff) / mass if new > 0.0 else 0.0
        began = drives[i + 1]
        if not held and new <= 1e-9 and times[i + 1] > over:
            end = i + 1
            break
    return speed, film, friction, fluid, work, lost, normals, drives, end
