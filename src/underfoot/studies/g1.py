"""Grant report G.1: the micro finite-element model's matrix, beside what the report prints."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import asdict, astuple, dataclass
from typing import Any

import numpy as np

from underfoot.core import Progress, silent

from .g1_cases import (
    SERIES,
    CondensedRuns,
    G1Case,
    G1Outcome,
    G1Row,
    G1Settings,
    matrix,
    outcome_of,
)
from .g1_kept import explicit_outcomes, kept_cases
from .g1_lines import printed_lines, series_notes
from .verdict import ComparedLine, Erratum

ERRATA = (
    Erratum(
        "G.1.1, wavelengths",
        "shoe 5 mm, floor 4 mm",
        "0.5 mm and 0.4 mm",
        "the block is 0.8 mm long; scan length over number of peaks (12.5 mm / 25 and 31) gives "
        "these. They are settings",
    ),
    Erratum(
        "Table 2, bulk modulus of rubber",
        "2180 MPa",
        "2 G_inf (1 + nu) / (3 (1 - 2 nu)) = 220 MPa",
        "neolite's 9324 MPa follows this rule with nu = 0.499; the printed value would be nu = "
        "0.4999. It is a setting",
    ),
    Erratum(
        "Table 2, beta",
        "0.013 and 0.025 1/s",
        "as printed in the series of the report's parameters",
        "relaxation in 77 and 40 s, slides of milliseconds: practically no viscous loss. A second "
        "series with a broad spectrum shows what loss does",
    ),
    Erratum(
        "G.1.1, equations",
        "Eq. 10 is missing",
        "COF_adhesion proportional to A_c / F_N",
        "9 gives F = s A_c, 11 divides by F_N",
    ),
    Erratum(
        "G.1.1, mesh",
        "0.03125 mm elements on 0.8 mm",
        "26 elements of 30.8 um",
        "0.8 / 0.03125 = 25.6 is no whole number",
    ),
)
FIGURE_3 = ("rubber", 35.1e-6, 35.1e-6)
"""Material, shoe and floor roughness (m) of Fig. 3."""


@dataclass(frozen=True, slots=True, eq=False)
class G1History:
    """Fig. 3: time (s), sliding (m), forces (N) and real contact area (m^2) of one case."""

    series: str
    speed: float
    time: np.ndarray
    distance: np.ndarray
    normal_force: np.ndarray
    shear_force: np.ndarray
    real_contact_area: np.ndarray


@dataclass(frozen=True, slots=True, eq=False)
class G1Study:
    """The matrix with its comparison.

    Parameters
    ----------
    settings
        How it was run.
    rows
        One for each case.
    lines
        Printed statements beside ours.
    histories
        Fig. 3, one for each series, at the highest speed.
    errata
        Where the text was not taken as printed.
    notes
        What a reader must know.
    seconds, process_seconds
        Wall clock, and process time of all cases, kept ones with what they took.
    """

    settings: G1Settings
    rows: tuple[G1Row, ...]
    lines: tuple[ComparedLine, ...]
    histories: tuple[G1History, ...]
    errata: tuple[Erratum, ...]
    notes: tuple[str, ...]
    seconds: float
    process_seconds: float

    def as_dict(self) -> dict[str, Any]:
        """Return plain data for JSON (SI units); NaN as None."""
        rows = [
            {key: None if value != value else value for key, value in asdict(row).items()}
            for row in self.rows
        ]
        return {
            "study": "g1",
            "settings": asdict(self.settings),
            "series": {name: SERIES[name] for name in self.settings.series},
            "lines": [line.as_dict() for line in self.lines],
            "errata": [asdict(erratum) for erratum in self.errata],
            "notes": list(self.notes),
            "rows": rows,
            "seconds": self.seconds,
            "process_seconds": self.process_seconds,
        }


def run(settings: G1Settings | None = None, *, progress: Progress = silent) -> G1Study:
    """Return the whole matrix: materials x shoe roughness x floors x speeds for each series.

    Explicit cases are kept in the user's cache as they end: a run stopped early goes on from there.

    Percent changes are taken as the report words them: roughness at the lowest speed (Fig. 5 and
    8), speed from the lowest to the highest (Fig. 6 and 7); ranges run over the other conditions.

    Errors
    ------
    InputError
        Settings that can't be: wavelengths longer than the block, a slide shorter than one.
    """
    settings = settings or G1Settings()
    begun, process = time.perf_counter(), time.process_time()
    cases = list(matrix(settings))
    rows: list[G1Row] = []
    histories: list[G1History] = []
    before = kept_cases(settings, cases) if settings.solver == "explicit" else 0
    for outcome in _outcomes(cases, settings):
        row = outcome.row
        rows.append(row)
        progress(_stage(row), len(rows) / len(cases), None)
        which = (row.material, row.shoe_rz, row.floor_rz)
        if which == FIGURE_3 and row.speed == max(settings.speeds):
            histories.append(G1History(row.series, row.speed, **outcome.history))
    order = {astuple(case): number for number, case in enumerate(cases)}
    rows.sort(key=lambda row: order[row.series, row.material, row.shoe_rz, row.floor_rz, row.speed])
    lines = [line for name in settings.series for line in printed_lines(rows, name)]
    return G1Study(
        settings,
        tuple(rows),
        tuple(lines),
        tuple(histories),
        ERRATA,
        _notes(rows, settings, before),
        time.perf_counter() - begun,
        time.process_time() - process
        if settings.solver == "condensed"
        else float(np.sum([row.seconds for row in rows])),
    )


def _outcomes(cases: Sequence[G1Case], settings: G1Settings) -> Iterator[G1Outcome]:
    """Yield the outcomes; explicit ones as they end."""
    if settings.solver == "explicit":
        yield from explicit_outcomes(cases, settings)
        return
    runs = CondensedRuns(settings)
    for case in cases:
        yield outcome_of(case, runs(case))


def _stage(case: G1Row) -> str:
    return (
        f"{case.series}: {case.material} {case.shoe_rz * 1e6:g} um on {case.floor_rz * 1e6:g} um, "
        f"{case.speed:g} m/s"
    )


def _notes(rows: Sequence[G1Row], settings: G1Settings, before: int) -> tuple[str, ...]:
    notes = [f"{name}: {series_notes(name)}" for name in settings.series]
    notes.append(
        "rougher shoe: Rz 12.1 to 35.1 um; rougher floor: 16.6 to 35.1 um, both at "
        f"{settings.speeds[0]:g} m/s; own shoes and experiment: neolite with 12.1 um, rubber with "
        "35.1 um; ranges run over all other conditions"
    )
    pressures = np.array([row.mean_pressure for row in rows]) * 1e-3
    if np.isfinite(pressures).any():
        notes.append(
            f"mean pressure while sliding {np.nanmin(pressures):.0f} to "
            f"{np.nanmax(pressures):.0f} kPa"
            + (
                " (160 kPa at the end of pressing; the height, not the load, is kept)"
                if settings.control == "displacement"
                else ""
            )
        )
    if before:
        notes.append(f"{before} of {len(rows)} cases were kept from an earlier run")
    lost = [row for row in rows if row.cof_hysteresis != row.cof_hysteresis]
    if lost:
        notes.append(f"{len(lost)} of {len(rows)} cases gave no result")
    notes.append(
        "area per force counts every node that carries force, as finite elements do: 26 % too "
        "much at 13 elements a wavelength and 36 % contact, more for smaller spots (neolite); "
        "cases.csv has it without the edges of the spots too"
    )
    return tuple(notes)
