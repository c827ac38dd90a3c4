"""A rough rubber block slid over a rough rigid floor by explicit finite elements (G.1)."""

import math
import time
from pathlib import Path

import numpy as np

from underfoot.core import Breach, Cancelled, Progress, Status, ValidityRange, content_hash, silent
from underfoot.core.files import check_writable_folder
from underfoot.core.status import worst

from .assembly import (
    IMPACT_ALLOWED,
    MASS_SCALING_ALLOWED,
    ExplicitSettings,
    assemble_march,
    mass_scaling_error,
)
from .inputs import MicroBlock, MicroLoading, MicroMaterial, MicroSurface
from .march import COLUMNS, BlockMarch, averages, ledger, loaded_state, saved_state
from .result import MicroResult, resolution_note

STATE_VERSION = 2
"""Of restart files; raised when their content changes."""
LEDGER_TOLERANCE = 1e-3
"""Largest drift of the energy ledger while sliding, in units of load times distance."""
LOSS_TOLERANCE = 0.15
"""What the small-strain estimate of the material's loss may miss of it; 8 % at slopes of 0.27."""


def explicit_sliding(
    block: MicroBlock,
    floor: MicroSurface,
    material: MicroMaterial,
    loading: MicroLoading,
    settings: ExplicitSettings | None = None,
    *,
    output: Path | None = None,
    snapshots: int = 0,
    restart: Path | None = None,
    overwrite: bool = False,
    progress: Progress = silent,
) -> MicroResult:
    """Return the history of a block pressed on a floor and slid along +x, without friction.

    Total-Lagrangian 8-node hexahedra with one mean gradient each, W = G0/2 (J^(-2/3) I1 - 3) +
    K/2 (J - 1)^2 with the isochoric stress relaxing by any number of Prony terms (Eq. 7), hourglass
    control, penalty contact that is minus the gradient of an energy, central differences. The top
    carries the load and moves in one piece; rubber is at rest and the floor passes underneath.

    Parameters:
        block, material, loading: As ``inputs`` describes them.
        floor: Rigid, heights positive towards the rubber.
        settings: Time step, hourglass form, penalty, mass scaling, precision.
        output: Folder for ``restart.npz`` (rewritten as the run goes on) and ``snapshots`` VTU
            files of the slide with ``block.pvd``, which ParaView opens.
        restart: A restart file of the same inputs: the run goes on from there.
        overwrite: Allow an ``output`` that holds something.
        progress: Receives the stage and the fraction done; ``Cancelled`` raised by it ends the run
            early with the status CANCELLED and a restart file (with ``output``).

    Validity: spectrum and bulk modulus of a nearly incompressible solid; real contact area needs 13
    or more elements a wavelength (marked below that); counted by nodes even 26 overestimate it by
    20 %, without its edges by some 4 %.

    Raises:
        InputError: What the mesh, the step or the contact can't carry.
        ConvergenceError: NaN, an element turned inside out, energy made by the march: with the last
            good state saved.
        DataError: A restart file of another case.

    Source: grant report G.1; Flanagan and Belytschko (1981) Int. J. Numer. Methods Eng. 17:679
    (mean gradient, hourglass); Simo (1987) Comput. Methods Appl. Mech. Eng. 60:153 (histories).
    """
    settings = ExplicitSettings() if settings is None else settings
    if output is not None:
        output = Path(output)
        check_writable_folder(output, overwrite=overwrite or restart is not None)
    assembly = assemble_march(block, floor, material, loading, settings)
    march = BlockMarch(
        assembly=assembly,
        loading=loading,
        area=block.nominal_area,
        wavelength=floor.wavelength if floor.rough else 0.25 * block.size[0],
        samples_per_wavelength=settings.samples_per_wavelength,
        confined_modulus=material.bulk_modulus + 4.0 / 3.0 * material.shear.instantaneous_modulus,
        key=content_hash(STATE_VERSION, block, floor, material, loading, settings),
        progress=progress,
        output=output,
        snapshots=snapshots,
    )
    if restart is not None:
        march.restore(loaded_state(Path(restart), march.key))
    begun = time.process_time()
    status, notes = Status.CONVERGED, []
    try:
        march.run()
    except Cancelled:
        status = Status.CANCELLED
        notes.append(f"cancelled after {march.steps} steps")
    if output is not None:
        saved_state(output / "restart.npz", march.state())
    seconds = time.process_time() - begun
    rows = np.array(march.rows).reshape(-1, len(COLUMNS))
    area = block.nominal_area
    if not march.settled:
        status = worst(status, Status.NOT_CONVERGED)
        notes.append(
            "the load had not settled to 1 % before sliding: raise hold_time or contact_damping"
        )
    out_of_range = _breaches(march, block, floor, material, rows)
    if march.assembly.mass_scaling > 1.0:
        bound = mass_scaling_error(
            loading.speed, material.wave_speeds[1], march.assembly.mass_scaling
        )
        notes.append(
            f"density times {march.assembly.mass_scaling:.3g}: at most {bound:.1%} on area "
            f"over force and {march.assembly.impact_friction:.1g} on the COF"
        )
    if settings.hourglass == "viscous":
        notes.append(
            "viscous hourglass control takes energy of its own: read hourglass_loss beside the COF"
        )
    energy = ledger(rows)
    moving = rows[:, 1] > 0.0
    if moving.sum() > 2:
        drift = float(np.ptp(energy.residual[moving]))
        scale = float(rows[moving, 2].mean()) * float(rows[-1, 1])
        notes.append(f"energy ledger open by {drift / scale:.1e} of load times distance")
        lost = float(np.ptp(energy.material_loss[moving]))
        if drift > LEDGER_TOLERANCE * scale + LOSS_TOLERANCE * lost:
            status = worst(status, Status.OUT_OF_RANGE)
            notes.append("the ledger drifts too far: lower cfl before trusting the COF")
    means = averages(rows, floor.wavelength, area) if floor.rough else None
    if means is None and loading.speed > 0.0 and status is not Status.CANCELLED:
        notes.append("no whole floor wavelength was slid: there is no mean")
    elif means is not None and means.wavelengths == 1 and rows[-1, 1] < 1.99 * floor.wavelength:
        notes.append("one wavelength only: it holds the start of sliding")
    if means is not None:
        notes += resolution_note(means)
    if out_of_range:
        status = worst(status, Status.OUT_OF_RANGE)
    return MicroResult(
        *rows[:, :6].T,
        corrected_contact_area=np.maximum(rows[:, 5] - rows[:, 19], 0.0),
        height=rows[:, 8],
        nominal_area=area,
        averages=means,
        energy=energy,
        status=status,
        notes=tuple(notes),
        breaches=tuple(out_of_range),
        steps=march.steps,
        time_step=march.assembly.time_step,
        process_seconds=seconds,
    )


def _breaches(
    march: BlockMarch,
    block: MicroBlock,
    floor: MicroSurface,
    material: MicroMaterial,
    rows: np.ndarray,
) -> list[Breach]:
    """Return what leaves the range in which the numbers were checked."""
    assembly, speed = march.assembly, march.loading.speed
    tests: list[tuple[str, float, float, float, str]] = []
    waves = [s.wavelength for s in (block.roughness, floor) if s.rough and s.form != "paraboloid"]
    if waves:
        step = max(block.size[0] / block.elements[0], block.size[1] / block.elements[1])
        per_wave, source = min(waves) / step * (1.0 + 1e-9), "contact area against the half-space"
        tests.append(("elements a wavelength", per_wave, 12.0, math.inf, source))
    heights = [s.peak_to_valley for s in (block.roughness, floor) if s.peak_to_valley > 0.0]
    if heights and len(rows) and rows[-1, 5] > 0.0:
        sunk = float(rows[-1, 2] / rows[-1, 5]) / assembly.penalty / min(heights)
        tests.append(("penetration over roughness", sunk, 0.0, 0.02, "penalty scan"))
    if assembly.mass_scaling > 1.0:
        error = mass_scaling_error(speed, material.wave_speeds[1], assembly.mass_scaling)
        allowed, impact = MASS_SCALING_ALLOWED * (1 + 1e-9), IMPACT_ALLOWED * (1 + 1e-9)
        tests.append(("mass scaling error", error, 0.0, allowed, "density scan"))
        tests.append(
            ("COF of scaled inertia", assembly.impact_friction, 0.0, impact, "energy ledger")
        )
    return [
        Breach("explicit_sliding", quantity, value, value, ValidityRange(low, high, "1", source))
        for quantity, value, low, high, source in tests
        if not low <= value <= high
    ]
