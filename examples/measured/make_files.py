"""Writes the scans and the rubber test of this folder: made up, from published numbers.

No public scan of a shoe sole or a walked floor, and no dynamic sweep of a shoe rubber, could be had
with a licence to pass it on. These files are what instruments would write for:

- floor.csv: a matt tile, Rq 3 um; sole.csv: a heel worn in, Rq 8 um (Ra 6.4; the report's work shoe
  has 5.7 to 7.2). Isotropic, self-affine, Hurst exponent 0.8, roll-off 0.2 mm: usual for abraded
  surfaces (Persson et al. 2005, J. Phys.: Condens. Matter 17, R1). A stylus trace of 12.5 mm, the
  report's length (G.1.1), every 2 um, heights to 1 nm.
- dma.csv: a filled rubber, 5 MPa at 1 Hz and 25 C (Shore A 68 by Gent 1958), loss tangent 0.19,
  moved by the shift of SBR (WLF constants 4.57 and 113.6 K at 25 C, Ferry 1980; from memory),
  -40 to 40 C, 0.1 to 100 Hz, with 1 % of scatter.

The recording of a walker is a real one: tests/data/trials/kineticstoolkit/c3d_sample.c3d, three
steps (Apache 2.0).
"""

from pathlib import Path

import numpy as np

from underfoot.material import WlfShift, power_law_spectrum
from underfoot.surface import self_affine

FOLDER = Path(__file__).parent
KELVIN = 273.15


def scan(name: str, rq: float, seed: int) -> None:
    """Write a line of a random surface as position and height."""
    length, spacing = 12.5e-3, 2e-6
    shape = (round(length / spacing), 512)
    surface = self_affine(shape, spacing, rq, 0.8, 1.0e-3, 4 * spacing, seed, roll_off=0.2e-3)
    height = surface.heights[:, 0]
    position = spacing * np.arange(height.size)
    rows = [f"{1e3 * x:.3f},{1e6 * z:.3f}" for x, z in zip(position, height, strict=True)]
    (FOLDER / name).write_text("\n".join(["x (mm),z (um)", *rows, ""]), encoding="utf-8")


def sweep(name: str) -> None:
    """Write storage and loss modulus at nine temperatures."""
    shift = WlfShift(4.57, 113.6, 25 + KELVIN)
    rubber = power_law_spectrum(1.0, 0.12, shortest_time=1e-14, longest_time=1e8)
    rubber = rubber.scale_moduli(5e6 / float(rubber.storage_modulus(2 * np.pi)))
    random, rows = np.random.default_rng(25), ["T (degC),f (Hz),E' (MPa),E'' (MPa)"]
    for celsius in range(-40, 41, 10):
        for hertz in np.geomspace(0.1, 100, 13):
            at = 2 * np.pi * hertz * float(shift.shift_factor(celsius + KELVIN))
            modulus = complex(rubber(at)) * 1e-6
            parts = [part * (1 + 0.01 * random.standard_normal()) for part in
                     (modulus.real, modulus.imag)]  # fmt: skip
            rows.append(f"{celsius},{hertz:.4g},{parts[0]:.4f},{parts[1]:.4f}")
    (FOLDER / name).write_text("\n".join([*rows, ""]), encoding="utf-8")


if __name__ == "__main__":
    scan("floor.csv", 3e-6, 3)
    scan("sole.csv", 8e-6, 8)
    sweep("dma.csv")
