"""Contact tables, flow factors and theories: cost (process CPU time) and error."""

import tempfile
import time
from pathlib import Path

import numpy as np

from underfoot.core import Cache
from underfoot.material import power_law_spectrum
from underfoot.rough_contact.contact_table import QUANTITIES, ContactTable, leave_out_errors
from underfoot.rough_contact.cutoff import cutoff_dependence
from underfoot.rough_contact.flow_factor import flow_factors
from underfoot.rough_contact.persson import persson
from underfoot.rough_contact.steady import steady_sliding
from underfoot.surface import isotropic_spectrum, self_affine, spectral_moments

RUBBER = power_law_spectrum(1.3e6, 0.12)


def main() -> None:
    flow_against_patir_cheng()
    flow_cost()
    theory_beside_half_space()
    table()
    shortest_wave()


def flow_against_patir_cheng() -> None:
    print("Pressure flow factor of undeformed isotropic roughness, mean of 3 surfaces, 256 x 256")
    print("h/sigma   solved   Patir-Cheng 1978   1 - 1.5 (sigma/h)^2")
    maps = [self_affine(256, 1e-6, 1e-6, 0.8, 64e-6, 16e-6, seed).heights for seed in range(3)]
    for ratio in (6.0, 4.0, 3.0, 2.0, 1.0):
        phi = np.mean([flow_factors(np.maximum(h + ratio * 1e-6, 0.0)).mean for h in maps])
        fit, dilute = 1 - 0.9 * np.exp(-0.56 * ratio), 1 - 1.5 / ratio**2
        print(f"{ratio:7.1f} {phi:8.4f} {fit:18.4f} {dilute:21.4f}")


def flow_cost() -> None:
    print("\nCost of both flow factors, s of CPU")
    for n in (128, 256, 512):
        h = self_affine(n, 1e-6, 1e-6, 0.8, n * 0.25e-6, 8e-6, 0).heights
        for level in (3.0, 1.0, 0.3, -0.2):
            gap = np.maximum(h + level * 1e-6, 0.0)
            begin = time.process_time()
            found = flow_factors(gap)
            spent = time.process_time() - begin
            share = 100 * np.mean(gap == 0)
            print(f"{n:4d}^2, contact {share:4.1f} %: phi {found.mean:.4f}, {spent:.2f} s")


def theory_beside_half_space() -> None:
    print("\nElastic contact: half-space (3 surfaces, 192 x 192) beside Persson")
    print("p/(E* h')   area   Persson   gap um   Yang-Persson")
    maps = [self_affine(192, 4e-6, 4e-6, 0.8, 192e-6, 32e-6, seed) for seed in range(3)]
    q = np.geomspace(2 * np.pi / 192e-6, 2 * np.pi / 32e-6, 300)
    c = q**-3.6
    slope = np.mean([spectral_moments(isotropic_spectrum(s)).m2 for s in maps])
    c *= slope / (np.pi * np.trapezoid(q**4 * c, np.log(q)))
    for ratio in (0.01, 0.02, 0.05, 0.1, 0.3, 0.5, 0.8):
        p = ratio * 2e6 / 0.75 * np.sqrt(2 * slope)
        found = [steady_sliding(s.heights, s.spacing, 2e6, 0.0, p) for s in maps]
        area = np.mean([contact.real_contact_fraction_corrected for contact in found])
        gap = np.mean([contact.mean_gap for contact in found])
        theory = persson([p], q, c, 2e6)
        assert theory.mean_gap is not None
        print(
            f"{ratio:8.2f} {area:9.4f} {theory.real_contact_fraction[0]:8.4f} "
            f"{gap * 1e6:8.3f} {theory.mean_gap[0] * 1e6:10.3f}"
        )


def table() -> None:
    maps = [self_affine(128, 8e-6, 5e-6, 0.8, 256e-6, 64e-6, seed) for seed in range(8)]
    pressure, speed = np.geomspace(1e4, 6e5, 9), np.geomspace(0.01, 2.0, 5)
    with tempfile.TemporaryDirectory() as folder:
        begin = time.process_time()
        found = ContactTable.from_surfaces(
            maps, RUBBER, pressure, speed, cache=Cache("benchmark", Path(folder))
        )
        spent = time.process_time() - begin
        dense = ContactTable.from_surfaces(
            maps[:2],
            RUBBER,
            np.geomspace(1e4, 6e5, 17),
            np.geomspace(0.01, 2.0, 9),
            cache=Cache("benchmark", Path(folder)),
        )
    solutions = len(maps) * pressure.size * speed.size
    print(f"\nTable of 9 pressures x 5 speeds x 8 surfaces of 128 x 128: {spent:.1f} s of CPU, ")
    print(f"{1e3 * spent / solutions:.0f} ms for each contact with its flow factors")
    halfway = leave_out_errors(dense), leave_out_errors(dense, "speed")
    for name in QUANTITIES:
        spread = found.deviation[name] / np.maximum(np.abs(found.values[name]), 1e-12)
        spread = spread[np.abs(found.values[name]) > 1e-2 * np.abs(found.values[name]).max()]
        print(
            f"{name:22s} halfway between nodes {halfway[0][name]:.1e} (pressure) "
            f"{halfway[1][name]:.1e} (speed); "
            f"spread between surfaces {100 * np.median(spread):.1f} %"
        )


def shortest_wave() -> None:
    print("\nThe shortest wave: 512 x 512, rms 5 um, 100 kPa, 0.3 m/s")
    surface = self_affine(512, 1e-6, 5e-6, 0.8, 256e-6, 4e-6, 0)
    found = cutoff_dependence(surface, RUBBER, 0.3, 1e5, [128e-6, 64e-6, 32e-6, 16e-6, 8e-6, 4e-6])
    for wave, area, cof, gap in zip(
        found.shortest_wave,
        found.real_contact_fraction,
        found.cof_hysteresis,
        found.mean_gap,
        strict=True,
    ):
        print(f"{wave * 1e6:5.0f} um: contact {area:.4f}, COF {cof:.4f}, gap {gap * 1e6:.2f} um")
    print(found.note)
