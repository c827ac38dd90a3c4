"""Machines and signals at random: fits, windows, pulses, holds, pins and slides with two faults."""

from contextlib import suppress

import numpy as np
import pytest
from test_trials_machines import PINS, SLIDES, numbers, pin, short, slid

from snapshot import held, tried
from underfoot.core import UnderfootError
from underfoot.trials.machines.pin_on_disk import (
    correlated_error,
    friction_point,
    reduced_radius,
    steady_window,
)
from underfoot.trials.machines.pressures import PulseDefinition, pressure_pulse
from underfoot.trials.machines.relaxation_test import relaxation_reading
from underfoot.trials.machines.slip_friction import mean_friction, slide_friction
from underfoot.trials.machines.stribeck_fit import best_decay, master_curve, stribeck_fit
from underfoot.trials.recording.protocols import protocol
from underfoot.trials.recording.signals import (
    LowPass,
    bridge_gaps,
    contacts,
    is_saturated,
    longest_run,
    low_passed,
    runs,
    unloaded_samples,
    velocity,
)
from underfoot.trials.recording.trial import Channel, Trial


def block_of(force, travel, rate):
    """Return the record of a block under load."""
    return Trial("block", {"force": Channel(force, "N", rate),
                           "displacement": Channel(travel, "m", rate)})  # fmt: skip


def test_fits_of_random_curves(file_regression):
    told = {}
    for seed in range(7):
        rng = np.random.default_rng(seed)
        count = int(rng.integers(4, 14))
        speed = np.sort(rng.choice([0.3, 1.0]) * rng.random(count) + 0.01)
        tau, low, high = rng.choice([0.03, 0.2, 2.0]), 0.3 * rng.random(), 0.2 + 0.5 * rng.random()
        cof = (
            low
            + (high - low) * np.exp(-speed / tau)
            + rng.choice([1e-3, 0.03]) * rng.normal(size=count)
        )
        options = {"boundary": 1.1 * high} if seed % 4 == 1 else {}
        if seed % 5 == 2:
            options["confidence"] = 0.8
        told[f"{seed}"] = tried(stribeck_fit, speed, cof, **options)
        told[f"{seed} simplex"] = getattr(
            tried(stribeck_fit, speed, cof, method="nelder_mead", **options), "raw", None
        )
        told[f"{seed} decay"] = tried(best_decay, speed, cof, 0.02, 5.0, points=25)
        if seed < 4:
            one = master_curve(rng.choice([0.01, 0.1, 1.0], count + 6), rng.random(count + 6) + 0.1,
                               0.1 + 0.3 * rng.random(count + 6),
                               method=("isotonic", "spline")[seed % 2])  # fmt: skip
            told[f"{seed} master"] = one
    held(file_regression, told)


def test_windows_and_means_at_random(file_regression):
    told = {}
    for seed in range(12):
        rng = np.random.default_rng(50 + seed)
        count = int(rng.integers(60, 400))
        noise = np.convolve(rng.normal(size=count), np.ones(1 + seed), "same")
        values = 0.3 + 0.02 * noise + rng.choice([0.0, 0.3]) * np.exp(-np.arange(count) / 20)
        values += rng.choice([0.0, 5e-4]) * np.arange(count)
        told[f"{seed} steady"] = tried(steady_window, values)
        told[f"{seed} error"] = correlated_error(values)
        time = np.arange(300) / 1000.0
        load = np.clip(3000 * time * rng.random() * 3, 0, 400.0) + rng.choice([0.5, 20.0]) * (
            rng.normal(size=300)
        )
        push = 0.2 * load * (1 + 0.1 * np.sin(200 * time)) + rng.normal(size=300)
        told[f"{seed} mean"] = short(
            mean_friction(load, push, 1000.0, target=rng.choice([100.0, 300.0]),
                          window=rng.choice([0.01, 0.1]))
        )  # fmt: skip
        x = np.linspace(-0.01, 0.02, 40)
        bent = rng.choice([2.0, -7.0]) * (x - 0.004 * rng.random()) ** 2 + 2e-6 * rng.normal(
            size=40
        )
        told[f"{seed} radius"] = tried(reduced_radius, x, bent)
    held(file_regression, told)


def test_pulses_at_random(file_regression):
    told = {}
    for seed in range(14):
        rng = np.random.default_rng(90 + seed)
        time = np.arange(900) / 1000.0
        size, at = rng.choice([300.0, 2e3, 5e4]), 0.35 + 0.2 * rng.random()
        values = 500.0 + 60 * rng.normal(size=900)
        values += size * np.exp(-(((time - at) / rng.choice([0.004, 0.04])) ** 2))
        if seed % 3 == 1:
            values += 0.4 * size * np.exp(-(((time - at - 0.12) / 0.01) ** 2))
        if seed % 5 == 2:
            values[int(rng.integers(300, 700)) :][:20] = np.nan
        if seed % 4 == 3:
            values = np.minimum(values, 0.7 * size)
        definition = PulseDefinition() if seed % 2 else PulseDefinition(200.0, 0.2, 4)
        one = pressure_pulse("P", Channel(values, "Pa", 1000.0), 0.3, definition=definition,
                             until=0.6 if seed % 3 == 2 else None)  # fmt: skip
        told[f"{seed}"] = {
            "peak": short(one.peak), "duration": short(one.duration),
            "numbers": numbers([one.baseline, one.deviation, one.peak_time, one.first, one.last]),
        }  # fmt: skip
    held(file_regression, told)


def test_holds_at_random(file_regression):
    told = {}
    for seed in range(10):
        rng = np.random.default_rng(130 + seed)
        time = np.arange(1500) / 10.0
        ramp = np.clip((time - 3) / rng.choice([2.0, 9.0]), 0, 1)
        after = np.clip(time - 8, 0, None)
        force = 600 * ramp**1.3 * (0.7 + 0.3 * np.exp(-after / rng.choice([5.0, 60.0])))
        force += rng.choice([0.2, 4.0]) * rng.normal(size=1500) + 20 * (seed % 3)
        travel = 1.1e-3 * ramp + 1e-6 * rng.normal(size=1500)
        if seed % 4 == 1:
            force[int(rng.integers(200, 1200)) :][:9] = np.nan
        one = tried(relaxation_reading, block_of(force, travel, rate=10.0), 0.0055)
        told[f"{seed}"] = one if isinstance(one, str) else {
            "force": [short(m) for m in (one.force_2_percent, one.peak_force, one.final_force)],
            "numbers": numbers([one.hold_start, one.peak_displacement, one.ramp_time,
                                one.hold_time]),
            "notes": one.notes, "hold": one.hold,
        }  # fmt: skip
    held(file_regression, told)


@pytest.mark.parametrize("first", [0, 8])
def test_logs_with_two_faults(file_regression, first):
    told = {}
    for seed in range(first, first + 8):
        rng = np.random.default_rng(170 + seed)

        def both(columns, kinds, rng=rng):
            for name in rng.choice(list(kinds), 2, replace=False):
                change = kinds[name]
                with suppress(KeyError, RuntimeWarning):  # two that can't come together
                    columns = (change[0] if isinstance(change, tuple) else change)(columns)
            return columns

        try:
            log = slid(lambda c: both(c, SLIDES), seed=seed, cof=0.05 + 0.2 * rng.random(),
                       rise=rng.choice([0.05, 0.3]))  # fmt: skip
            way = ("report_g4", "en_iso_13287", "report_g6_tester")[seed % 3]
            one = slide_friction(log, protocol(way))
            told[f"slide {seed}"] = short(one.cof), numbers([one.onset, *one.window]), one.facts
        except UnderfootError as error:
            told[f"slide {seed}"] = f"{type(error).__name__}: {error}"
        try:
            point = friction_point(pin(lambda c: both(c, PINS), seed=seed, speed=0.3))
            told[f"pin {seed}"] = short(point.cof), numbers(
                [point.speed, point.normal, point.shear, *point.window]
            )  # fmt: skip
        except UnderfootError as error:
            told[f"pin {seed}"] = f"{type(error).__name__}: {error}"
    held(file_regression, told, f"logs from {first}")


def test_signals_at_random(file_regression):
    told = {}
    for seed in range(12):
        rng = np.random.default_rng(230 + seed)
        count, rate = int(rng.integers(120, 700)), float(rng.choice([100.0, 1000.0]))
        time = np.arange(count) / rate
        load = np.clip(600 * np.sin(2 * np.pi * time * rng.choice([1.0, 6.0])), 0, None)
        load += rng.choice([0.1, 6.0]) * rng.normal(size=count) + 8 * (seed % 2)
        if seed % 3 == 1:
            load = np.minimum(load, 450.0)
        if seed % 4 == 2:
            load[40:52] = np.nan
        path = np.column_stack([np.cumsum(rng.normal(size=count)) for _ in range(3)]) * 1e-3
        path[rng.random(count) < 0.05] = np.nan
        bridged, filled = bridge_gaps(path, int(rng.integers(1, 6)))
        whole = np.nan_to_num(load)
        told[f"{seed}"] = {
            "unloaded": tried(lambda v, r: np.flatnonzero(unloaded_samples(v, r)), load, rate),
            "saturated": tried(is_saturated, load, rate), "contacts": tried(contacts, whole, rate),
            "runs": np.array(runs(load > 300)).ravel(), "longest": longest_run(load > 300),
            "smooth": [tried(low_passed, whole, rate, LowPass(cutoff=c)) for c in (6.0, 30.0)],
            "bridged": np.nan_to_num(bridged), "filled": int(filled.sum()),
            "velocity": tried(velocity, np.nan_to_num(bridged), rate, LowPass(cutoff=10.0)),
        }  # fmt: skip
    held(file_regression, told)
