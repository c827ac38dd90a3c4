"""The cases of the grant report's micro-model: materials, roughness, speeds, and how to run one."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from underfoot.core import InputError, Status, unknown_name

if TYPE_CHECKING:
    from underfoot.asperity.condensed_block import CondensedBlock
    from underfoot.asperity.finite_element import (
        MicroBlock,
        MicroLoading,
        MicroMaterial,
        MicroResult,
        MicroSurface,
    )

MATERIALS = ("neolite", "rubber")
SHOE_RZ = (12.1e-6, 35.1e-6)
"""m, Table 1: neolite's own (low) and the rubber's own (high); both are run on both materials."""
FLOOR_RZ = (16.6e-6, 24.3e-6, 35.1e-6)
"""m, Table 1: low, medium, high."""
OWN_SHOE_RZ = {"neolite": 12.1e-6, "rubber": 35.1e-6}
SPEEDS = (0.1, 0.25, 0.5, 0.75, 1.0)
SHOE_WAVELENGTH, FLOOR_WAVELENGTH = 0.5e-3, 0.4e-3
"""m; assumed, see the errata."""
POISSON_RATIO = 0.499
PRINTED_BULK_MODULUS = {"neolite": 9324e6, "rubber": 2180e6}
"""Pa, Table 2."""
BROAD = {"neolite": (18.66e6, 0.10), "rubber": (0.44e6, 0.12)}
"""|G*| at 1 rad/s (Table 2's relaxed modulus) and exponent (assumed) of the broad spectrum."""
SERIES = {
    "report": "the report's parameters: Table 2, one relaxation term",
    "broad": "assumed broad spectrum: |G*| of Table 2 at 1 rad/s, loss tangent 0.19 (rubber) and "
    "0.16 (neolite) at every frequency; a stand-in, not a measurement",
}
HOLD_TIME = {"condensed": 0.3e-3, "explicit": 1.0e-3}
"""s; stiff neolite with scaled mass settles to 1 % of the load in the longer one."""
HISTORY = ("time", "distance", "normal_force", "shear_force", "real_contact_area")
FINE = (26, 16, 9)
COARSE = (20, 13, 7)


@dataclass(frozen=True, slots=True)
class G1Settings:
    """How the matrix is run.

    Parameters
    ----------
    series
        "report", "broad" or both.
    solver
        "condensed" or "explicit".
    control
        "displacement" (the report's: height kept while sliding) or "load".
    bulk_modulus
        "corrected" (from Poisson's ratio 0.499) or "printed" (Table 2).
    shoe_wavelength, floor_wavelength
        m.
    speeds
        m/s.
    slide_distance
        m; the floor is 2.125 mm long, which leaves 1.3 mm.
    steps_per_wavelength
        Of the condensed solver.
    elements
        Of the block.
    processes
        For the explicit solver.
    """

    series: tuple[str, ...] = ("report", "broad")
    solver: str = "condensed"
    control: str = "displacement"
    bulk_modulus: str = "corrected"
    shoe_wavelength: float = SHOE_WAVELENGTH
    floor_wavelength: float = FLOOR_WAVELENGTH
    speeds: tuple[float, ...] = SPEEDS
    slide_distance: float = 1.2e-3
    steps_per_wavelength: int = 64
    elements: tuple[int, int, int] = FINE
    processes: int = 1

    def __post_init__(self) -> None:
        for name in self.series:
            if name not in SERIES:
                raise unknown_name("series of G.1", name, SERIES, where="series")
        if self.solver not in ("condensed", "explicit"):
            raise unknown_name("solver", self.solver, ("condensed", "explicit"), where="solver")
        if self.bulk_modulus not in ("corrected", "printed"):
            raise unknown_name(
                "bulk modulus", self.bulk_modulus, ("corrected", "printed"), where="bulk_modulus"
            )
        if len(self.speeds) < 2 or sorted(self.speeds) != list(self.speeds):
            raise InputError(
                f"{self.speeds}", where="speeds", allowed="two or more speeds, ascending"
            )
        whole = self.slide_distance / self.floor_wavelength
        if whole < 1.0 - 1e-9:
            raise InputError(
                f"a slide of {self.slide_distance:g} m over waves of {self.floor_wavelength:g} m",
                where="slide_distance",
                allowed="one whole wavelength or more",
                remedy="The report prints 4 and 5 mm for a block of 0.8 mm; 0.4 and 0.5 mm fit",
            )

    @property
    def quick(self) -> G1Settings:
        """The same with the end speeds only, a coarser mesh and shorter slides."""
        from dataclasses import replace

        return replace(
            self,
            speeds=(self.speeds[0], self.speeds[-1]),
            slide_distance=2.0 * self.floor_wavelength,
            steps_per_wavelength=32,
            elements=COARSE,
        )


@dataclass(frozen=True, slots=True)
class G1Case:
    """One cell of the matrix; lengths in m, speed in m/s."""

    series: str
    material: str
    shoe_rz: float
    floor_rz: float
    speed: float


@dataclass(frozen=True, slots=True)
class G1Row:
    """One cell of the matrix with its averages over whole floor wavelengths (Eq. 8 to 12).

    ``area_per_force`` in m^2/N, ``mean_pressure`` in Pa, ``seconds`` of process time; NaN where
    the run gave no result (then ``status`` and ``note`` say why).
    """

    series: str
    material: str
    shoe_rz: float
    floor_rz: float
    speed: float
    cof_hysteresis: float
    cof_absolute: float
    cof_resultant: float
    area_per_force: float
    area_per_force_corrected: float
    real_contact_fraction: float
    mean_pressure: float
    status: str
    note: str
    seconds: float


@dataclass(frozen=True, slots=True, eq=False)
class G1Outcome:
    """A row with its history: ``HISTORY``, arrays (n,) in SI."""

    row: G1Row
    history: dict[str, np.ndarray]


def matrix(settings: G1Settings) -> Iterator[G1Case]:
    """Yield every case; those that share a block follow one another."""
    for shoe in SHOE_RZ:
        for series in settings.series:
            for material in MATERIALS:
                for floor in FLOOR_RZ:
                    for speed in settings.speeds:
                        yield G1Case(series, material, shoe, floor, speed)


def material_of(case: G1Case, bulk: str = "corrected") -> MicroMaterial:
    """Return the rubber of a case; density assumed."""
    from underfoot.asperity.finite_element import MicroMaterial
    from underfoot.material import (
        RelaxationSpectrum,
        bulk_modulus,
        power_law_spectrum,
        report_elastomer,
        shear_from_young,
        youngs_modulus_from_shear,
    )

    if case.series == "report":
        young = report_elastomer(case.material).modulus
        assert isinstance(young, RelaxationSpectrum)
        shear = shear_from_young(young, POISSON_RATIO)
    else:
        shear = power_law_spectrum(*BROAD[case.material], terms_per_decade=2)
    if bulk == "printed":
        k = PRINTED_BULK_MODULUS[case.material]
    else:
        relaxed = youngs_modulus_from_shear(shear.equilibrium_modulus, POISSON_RATIO)
        k = float(bulk_modulus(relaxed, POISSON_RATIO))
    return MicroMaterial(shear, k, name=case.material, source=shear.source)


def parts_of(
    case: G1Case, settings: G1Settings
) -> tuple[MicroBlock, MicroSurface, MicroMaterial, MicroLoading]:
    """Return block, floor, material and loading of a case."""
    from underfoot.asperity.finite_element import MicroBlock, MicroLoading, MicroSurface

    rough = MicroSurface.checkerboard(case.shoe_rz, settings.shoe_wavelength)
    return (
        MicroBlock(elements=settings.elements, roughness=rough),
        MicroSurface.checkerboard(case.floor_rz, settings.floor_wavelength),
        material_of(case, settings.bulk_modulus),
        MicroLoading(
            speed=case.speed,
            slide_distance=settings.slide_distance,
            control=settings.control,
            hold_time=HOLD_TIME[settings.solver],
        ),
    )


class CondensedRuns:
    """Runs cases with the condensed block and keeps the compliance between them."""

    def __init__(self, settings: G1Settings) -> None:
        self.settings = settings
        self._key: tuple[float, float] | None = None
        self._block: CondensedBlock | None = None

    def __call__(self, case: G1Case) -> MicroResult:
        """Return the history of one case."""
        from underfoot.asperity.condensed_block import (
            condensed_block,
            condensed_poisson_ratio,
            condensed_sliding,
        )

        block, floor, material, loading = parts_of(case, self.settings)
        key = (case.shoe_rz, round(condensed_poisson_ratio(material), 9))
        if self._block is None or key != self._key:
            self._block = condensed_block(block, condensed_poisson_ratio(material))
            self._key = key
        return condensed_sliding(
            self._block,
            floor,
            material,
            loading,
            steps_per_wavelength=self.settings.steps_per_wavelength,
        )


def explicit_outcome(case: G1Case, settings: G1Settings) -> G1Outcome:
    """Return one case by explicit finite elements, mass scaled within its error bounds."""
    from underfoot.asperity.finite_element import ExplicitSettings, explicit_sliding

    block, floor, material, loading = parts_of(case, settings)
    return outcome_of(
        case,
        explicit_sliding(block, floor, material, loading, ExplicitSettings(mass_scaling="auto")),
    )


def outcome_of(case: G1Case, result: MicroResult) -> G1Outcome:
    """Return a case's row and the history that Fig. 3 shows."""
    return G1Outcome(row_of(case, result), {name: getattr(result, name) for name in HISTORY})


def row_of(case: G1Case, result: MicroResult) -> G1Row:
    """Return the averages of a case as one row."""
    averages = result.averages if result.status.usable else None
    values = [
        math.nan if averages is None else float(getattr(averages, name))
        for name in (
            "cof_hysteresis",
            "cof_absolute",
            "cof_resultant",
            "area_per_force",
            "area_per_force_corrected",
            "real_contact_fraction",
            "mean_pressure",
        )
    ]
    status = result.status
    if averages is None and status.usable:
        status = Status.NOT_CONVERGED
    note = "; ".join((*result.notes, *(str(breach) for breach in result.breaches)))
    return G1Row(
        case.series,
        case.material,
        case.shoe_rz,
        case.floor_rz,
        case.speed,
        *values,
        status=str(status),
        note=note,
        seconds=result.process_seconds,
    )


def changes(
    rows: Sequence[G1Row], quantity: str, along: str, *, speed: float | None = None
) -> tuple[float, ...]:
    """Return the relative change of ``quantity`` from the lowest to the highest of ``along``.

    One value for each combination of the other conditions; ``speed`` keeps one speed only.
    """
    others = [name for name in ("shoe_rz", "floor_rz", "speed") if name != along]
    chosen = [row for row in rows if speed is None or row.speed == speed]
    found = []
    for key in sorted({tuple(getattr(row, name) for name in others) for row in chosen}):
        same = [row for row in chosen if tuple(getattr(row, name) for name in others) == key]
        same.sort(key=lambda row: getattr(row, along))
        first, last = (getattr(same[i], quantity) for i in (0, -1))
        with np.errstate(divide="ignore", invalid="ignore"):
            found.append(float(np.float64(last) / np.float64(first) - 1.0))
    return tuple(found)
