"""``underfoot contact``: rubber on one rough surface, dry, at rest or sliding."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from .contact_input import RubberChoice, SurfaceChoice, rubber_from, surface_from
from .options import AsJson, Overwrite

_METRES = re.compile(r"(?<![\w.])(\d+(?:\.\d+)?(?:e[+-]?\d+)?) m\b(?!/)")

if TYPE_CHECKING:
    from underfoot.asperity import SteadySliding
    from underfoot.asperity.cutoff import CutoffDependence
    from underfoot.asperity.flow_factor import FlowFactors
    from underfoot.surface import HeightMap


def contact(
    surface: Annotated[
        Path | None,
        typer.Argument(help="Measured profile or height map.", show_default=False),
    ] = None,
    pressure: Annotated[
        str, typer.Option("--pressure", help='Mean contact pressure, as "160 kPa".')
    ] = "160 kPa",
    speed: Annotated[
        str, typer.Option("--speed", help='Sliding speed, as "0.3 m/s"; 0 m/s is at rest.')
    ] = "0 m/s",
    modulus: Annotated[
        str | None, typer.Option("--modulus", help='Young\'s modulus, as "5 MPa": elastic.')
    ] = None,
    shore: Annotated[
        float | None, typer.Option("--shore", help="Shore A hardness: elastic, by Gent.")
    ] = None,
    spectrum: Annotated[
        Path | None,
        typer.Option("--spectrum", help="Prony series or dynamic sweep: viscoelastic."),
    ] = None,
    material: Annotated[
        str | None, typer.Option("--material", help="The grant report's: neolite or rubber.")
    ] = None,
    poisson: Annotated[float, typer.Option("--poisson", help="Poisson's ratio.")] = 0.5,
    rms: Annotated[
        str | None, typer.Option("--rms", help='Random surface of this rms height, as "5 um".')
    ] = None,
    hurst: Annotated[float, typer.Option("--hurst", help="Its Hurst exponent.")] = 0.8,
    longest: Annotated[
        str | None, typer.Option("--longest", help="Its longest wave; 0.5 mm by default.")
    ] = None,
    shortest: Annotated[
        str | None,
        typer.Option("--shortest", help="Its shortest wave; eight grid points by default."),
    ] = None,
    checkerboard: Annotated[
        tuple[str, str] | None,
        typer.Option("--checkerboard", help='Peak to valley and wavelength: "24.3 um" "0.4 mm".'),
    ] = None,
    points: Annotated[int, typer.Option("--points", help="Grid points a side.")] = 256,
    seed: Annotated[int, typer.Option("--seed", help="Number of the random surface.")] = 0,
    cutoffs: Annotated[
        bool, typer.Option("--cutoffs", help="Show how it depends on the shortest wave.")
    ] = False,
    out: Annotated[
        Path | None,
        typer.Option("--out", help="Folder for the picture and the numbers.", show_default=False),
    ] = None,
    json: AsJson = False,
    overwrite: Overwrite = False,
) -> None:
    """Press and slide rubber over a rough surface: real contact, hysteresis, gap, leakage.

    A profile is turned into a random surface with its spectrum; a map whose edges do not meet
    is mirrored. Nothing wet, no adhesion.
    """
    from underfoot.core import to_si
    from underfoot.core.files import check_writable_folder, whole_folder

    load = to_si(pressure, "Pa", where="--pressure")
    velocity = to_si(speed, "m/s", where="--speed")
    if out is not None:
        check_writable_folder(out, overwrite=overwrite)
    rubber, described, assumed = rubber_from(RubberChoice(modulus, shore, spectrum, material))
    floor = surface_from(
        SurfaceChoice(surface, rms, hurst, longest, shortest, checkerboard, points, seed)
    )
    found, flow = solved(floor, rubber, velocity, load, poisson)
    scales = scale_dependence(floor, rubber, velocity, load, poisson) if cutoffs else None
    notes = [with_units(note) for note in (*assumed, *found.notes, *floor.processing)]
    content = as_data(floor, found, flow, scales, described, notes)
    if out is not None:
        with whole_folder(out, overwrite=overwrite) as staging:
            _write(staging, floor, found, content)
    if json:
        import json as json_text

        print(json_text.dumps(content, indent=2, ensure_ascii=False))
    else:
        _show(content, out)
    if not found.status.usable:
        raise typer.Exit(4)


def with_units(note: str) -> str:
    """Return a note with its lengths as people write them: 3.125e-05 m as 31.3 um."""
    from underfoot.core import display

    return _METRES.sub(lambda match: display(float(match.group(1)), "m"), note)


def solved(
    floor: HeightMap, rubber: Any, speed: float, pressure: float, poisson_ratio: float
) -> tuple[SteadySliding, FlowFactors]:
    """Return the contact and the flow factors of its gap."""
    import numpy as np

    from underfoot.asperity import steady_sliding
    from underfoot.asperity.flow_factor import FlowFactors, flow_factors

    found = steady_sliding(floor.heights, floor.spacing, rubber, speed, pressure, poisson_ratio)
    if not found.status.usable:
        return found, FlowFactors(np.nan, np.nan, np.nan, np.nan, np.nan)
    return found, flow_factors(np.where(found.pressure > 0.0, 0.0, found.gap), floor.spacing)


def scale_dependence(
    floor: HeightMap, rubber: Any, speed: float, pressure: float, poisson_ratio: float
) -> CutoffDependence:
    """Return the contact at up to five shortest waves, each half the one before."""
    from underfoot.asperity.cutoff import cutoff_dependence

    last = max(floor.resolution or 0.0, 4.0 * floor.spacing)
    waves = [last * 2.0**n for n in range(4, -1, -1) if last * 2.0**n < 0.5 * min(floor.size)]
    if len(waves) < 2:
        from underfoot.core import InputError

        raise InputError(
            f"waves from {last:.3g} m on a side of {min(floor.size):.3g} m: nothing to compare",
            where="--cutoffs",
            remedy="Take more --points or a surface with several scales",
        )
    return cutoff_dependence(floor, rubber, speed, pressure, waves, poisson_ratio)


def as_data(
    floor: HeightMap,
    found: SteadySliding,
    flow: FlowFactors,
    scales: CutoffDependence | None,
    described: str,
    notes: list[str],
) -> dict[str, Any]:
    """Return everything as plain data in SI units; numbers of a failed solution are None."""
    from underfoot.surface import rms_slope

    usable = found.status.usable
    values = {
        "real_contact_fraction": found.real_contact_fraction_corrected,
        "cof_hysteresis": found.cof_hysteresis,
        "mean_gap_m": found.mean_gap,
        "flow_factor_along": flow.along,
        "flow_factor_across": flow.across,
    }
    content: dict[str, Any] = {
        "rubber": described,
        "pressure_Pa": found.nominal_pressure,
        "speed_m_per_s": found.speed,
        "rms_height_m": floor.rms_height,
        "rms_slope": rms_slope(floor),
        "grid": list(floor.shape),
        "spacing_m": floor.spacing,
        "shortest_wave_m": floor.resolution,
        **{name: float(value) if usable else None for name, value in values.items()},
        "status": str(found.status),
        "iterations": found.iterations,
        "complementarity_error": found.complementarity_error,
        "notes": notes,
        "breaches": [str(breach) for breach in found.breaches],
    }
    if scales is not None:
        content["shortest_waves"] = [
            {
                "shortest_wave_m": wave,
                "real_contact_fraction": area if area == area else None,
                "cof_hysteresis": cof if cof == cof else None,
            }
            for wave, area, cof in zip(
                scales.shortest_wave.tolist(),
                scales.real_contact_fraction.tolist(),
                scales.cof_hysteresis.tolist(),
                strict=True,
            )
        ]
        content["notes"] = [*notes, scales.note]
    return content


def _write(folder: Path, floor: HeightMap, found: SteadySliding, content: dict[str, Any]) -> None:
    import json as json_text

    import numpy as np

    from underfoot.core import display
    from underfoot.document.contact_figure import save_contact_figure

    (folder / "contact.json").write_text(
        json_text.dumps(content, indent=2, ensure_ascii=False), encoding="utf-8"
    )
    if found.status.usable:
        np.savez_compressed(
            folder / "contact.npz",
            heights=floor.heights,
            spacing=floor.spacing,
            pressure=found.pressure,
            gap=found.gap,
        )
        title = (
            f"{display(found.nominal_pressure, 'Pa')}, {display(found.speed, 'm/s')}: "
            f"real contact {100.0 * found.real_contact_fraction_corrected:.3g} %, "
            f"hysteresis COF {found.cof_hysteresis:.3g}"
        )
        save_contact_figure(folder / "contact.png", floor.heights, floor.spacing, found, title)


def _show(content: dict[str, Any], folder: Path | None) -> None:
    from rich.console import Console
    from rich.table import Table

    from underfoot.core import display

    console = Console(highlight=False)
    console.print("\nRough contact", style="bold")
    console.print(f"{content['rubber']}", markup=False)
    table = Table(show_header=False, box=None, pad_edge=False)

    def row(label: str, key: str, unit: str = "1", remark: str = "") -> None:
        value = content[key]
        shown = "not estimated" if value is None else display(value, unit)
        table.add_row(label, shown, f"[dim]{remark}[/dim]")

    row("Mean pressure", "pressure_Pa", "Pa")
    row("Sliding speed", "speed_m_per_s", "m/s")
    row("Surface, rms height", "rms_height_m", "m")
    row("Surface, rms slope", "rms_slope", "1", "both directions together")
    row("Shortest wave", "shortest_wave_m", "m", "contact and friction belong to it")
    row("Real contact fraction", "real_contact_fraction", "1", "edges of patches corrected")
    row("Hysteresis COF", "cof_hysteresis")
    row("Mean gap", "mean_gap_m", "m", "contact counted as zero")
    row("Flow factor along", "flow_factor_along", "1", "of a smooth gap of that mean; 0: sealed")
    row("Flow factor across", "flow_factor_across")
    table.add_row("Status", content["status"], f"[dim]{content['iterations']} iterations[/dim]")
    console.print(table)
    if "shortest_waves" in content:
        scales = Table("Shortest wave", "Real contact fraction", "Hysteresis COF", box=None)
        for entry in content["shortest_waves"]:
            values = (entry["real_contact_fraction"], entry["cof_hysteresis"])
            scales.add_row(
                display(entry["shortest_wave_m"], "m"),
                *("not converged" if v is None else display(v, "1") for v in values),
            )
        console.print(scales)
    for title, lines in (
        ("Notes", content["notes"]),
        ("Outside a tested range", content["breaches"]),
    ):
        if lines:
            console.print(f"\n{title}:", markup=False)
            for line in lines:
                console.print(f"  - {line}", markup=False)
    if folder is not None:
        console.print(f"\nFiles in {folder}; open {folder / 'contact.png'}", markup=False)
