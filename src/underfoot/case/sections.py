"""The sections of a case: frozen, SI inside. The schema of case files is made from here."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import Field

from .quantity import Quantity, default
from .sections_base import Force, Length, Section
from .sections_motion import Speed
from .sections_outsole import OutsoleFile
from .sections_sole import HeelShape
from .sections_tread import Tread, Wear

_REPORT = "final progress report on shoe-floor friction"
_HEEL = "assumption"

_mm, _um = 1e-3, 1e-6
Roughness_ = Annotated[float, Quantity("m", 1e-9, 1e-3)]
Cutoff = Annotated[float, Quantity("m", 1e-6, 0.1)]
Modulus = Annotated[float, Quantity("Pa", 1e4, 1e12)]
TermModulus = Annotated[float, Quantity("Pa", 0.0, 1e12, open_low=True)]
Hardness = Annotated[float, Quantity("1", 0.0, 100.0, open_low=True)]
Poisson = Annotated[float, Quantity("1", 0.0, 0.5)]
RelaxationTime = Annotated[float, Quantity("s", 0.0, 1e12, open_low=True)]
Viscosity = Annotated[float, Quantity("Pa*s", 1e-5, 1e3)]
Temperature = Annotated[float, Quantity("K", 250.0, 450.0)]
Density = Annotated[float, Quantity("kg/m^3", 10.0, 3e4)]
Fraction = Annotated[float, Quantity("1", 0.0, 1.0)]
Friction = Annotated[float, Quantity("1", 0.0, 5.0)]
Tolerance = Annotated[float, Quantity("1", 1e-10, 0.1)]


class RelaxationTerm(Section):
    """One Maxwell element: shear modulus that decays with a time constant."""

    shear_modulus: TermModulus
    time: RelaxationTime


class Relaxation(Section):
    """Relaxation spectrum G(t) = equilibrium + sum of terms exp(-t / time)."""

    equilibrium_shear_modulus: TermModulus
    terms: tuple[RelaxationTerm, ...]


class Material(Section):
    """Outsole compound. A measured modulus goes before one from hardness."""

    shore_a: Hardness | None = Field(default=None, description="Shore A hardness")
    modulus: Modulus | None = Field(default=None, description="measured Young's modulus")
    poisson_ratio: Poisson = default(0.49, 0.49, "rubber, nearly incompressible", assumed=True)
    bulk_modulus: Modulus | None = None
    density: Density | None = None
    relaxation: Relaxation | None = None


class SurfaceRoughness(Section):
    """Roughness numbers of a profile after the cut-off."""

    ra: Roughness_ | None = Field(default=None, description="mean deviation")
    rq: Roughness_ | None = Field(default=None, description="root-mean-square deviation")
    rz: Roughness_ | None = Field(default=None, description="mean peak-to-valley height")
    rp: Roughness_ | None = Field(default=None, description="highest peak")
    rt: Roughness_ | None = Field(default=None, description="total height")
    cutoff: Cutoff | None = Field(default=None, description="cut-off wavelength of the filter")

    @property
    def rq_or_estimate(self) -> float | None:
        """Rq as given, else 1.25 Ra (Gaussian heights: sqrt(pi/2) = 1.253), m; None if unknown."""
        if self.rq is not None:
            return self.rq
        return None if self.ra is None else RQ_PER_RA * self.ra


RQ_PER_RA = math.sqrt(math.pi / 2)


class Sole(Section):
    """What carries the tread: outsole layer and midsole on a stiff foot."""

    outsole_thickness: Length = default(25 * _mm, "25 mm", _HEEL, assumed=True)
    midsole_modulus: Modulus | None = None
    midsole_thickness: Length | None = None
    midsole_poisson_ratio: Poisson = default(0.3, 0.3, "foam", assumed=True)


class Shoe(Section):
    """Heel of a shoe: compound, surface, shape, tread, wear, layers."""

    material: Material
    roughness: SurfaceRoughness
    outsole: OutsoleFile = OutsoleFile()
    heel: HeelShape = HeelShape()
    tread: Tread
    wear: Wear = Wear()
    sole: Sole = Sole()


class Floor(Section):
    """Hard floor."""

    roughness: SurfaceRoughness
    shore_a: Annotated[float, Quantity("1", 0.0, 100.0, open_low=True)] | None = None


class Boundary(Section):
    """Friction measured where the film carries nothing, and how it falls with speed."""

    cof_bl: Friction | None = Field(
        default=None, description="COF in boundary lubrication (Eq. 17)"
    )
    tau_hydro: Speed | None = Field(default=None, description="decay speed (Eq. 17)")
    cof_asymptote: Friction | None = Field(default=None, description="COF at high speed (Eq. 17)")
    alpha: Annotated[float, Quantity("N", 0.0, 1e4)] | None = Field(
        default=None, description="adhesion independent of the pair (Eq. 26)"
    )
    beta: Annotated[float, Quantity("1", 0.0, 1.0)] | None = Field(
        default=None, description="share of dry adhesion left (Eq. 26)"
    )
    load: Force | None = Field(default=None, description="load at which alpha was measured")
    pair: str | None = Field(default=None, description="sole and floor it was measured on")


class Contaminant(Section):
    """Fluid on the floor. Give its viscosity, or the share of glycerol in water."""

    viscosity: Viscosity | None = Field(default=None, description="dynamic viscosity as measured")
    glycerol_fraction: Fraction | None = None
    fraction_basis: Literal["mass", "volume"] | None = None
    temperature: Temperature = default(293.15, "20 degC", "room temperature", assumed=True)
    pool_depth: Annotated[float, Quantity("m", 1e-6, 0.05)] = default(
        0.6 * _mm, "0.6 mm", f"{_REPORT}, G.6.1 (150 ml on 0.4 m x 0.6 m)"
    )
    boundary: Boundary = Boundary()


class FrictionReading(Section):
    """One reading of a user's own friction table."""

    speed: Speed
    cof: Friction
    sd: Friction | None = None
    pressure: Annotated[float, Quantity("Pa", 0.0, 1e8, open_low=True)] | None = None
    viscosity: Viscosity | None = None


class Interface(Section):
    """What sole and floor make together; the least known part of a case."""

    effective_rq: Roughness_ | None = Field(
        default=None,
        description="roughness that lets fluid leak and asperities touch; default: composite of "
        "the stylus Rq of shoe and floor times roughness_beyond_cutoff",
    )
    roughness_beyond_cutoff: Annotated[float, Quantity("1", 1.0, 10.0)] = default(
        2.0,
        2.0,
        "chosen on one reading of the report (G.4, untreaded work shoe in glycerol, 201 N); "
        "the stylus sees no waves beyond its cut-off of 0.8 mm, the leaking fluid does",
        assumed=True,
    )
    hurst: Annotated[float, Quantity("1", 0.1, 1.0)] = default(
        0.8, 0.8, "common for worn and abraded surfaces", assumed=True
    )
    longest_wave: Length = default(
        2 * _mm,
        "2 mm",
        "where a roughness that grows as the length to the power 0.8 has doubled "
        "since the stylus' cut-off of 0.8 mm",
        assumed=True,
    )
    shortest_wave: Annotated[float, Quantity("m", 1e-6, 1e-2)] = default(
        125 * _um,
        "0.125 mm",
        "what a grid of 128 cells holds; sets contact area, hardly the gap",
        assumed=True,
    )
    constant_cof: Friction | None = Field(
        default=None, description="for models.friction = 'constant'"
    )
    hysteresis_cof: Friction | None = Field(
        default=None, description="hysteresis part, if measured"
    )
    dry_adhesion_cof: Friction | None = Field(
        default=None, description="adhesion part dry, if measured"
    )
    fine_roughness: Annotated[float, Quantity("m", 1e-10, 1e-4)] | None = Field(
        default=None,
        description="roughness finer than a stylus sees, for models.friction = 'asperity_ehl'; "
        "default: the one calibrated on the report's fluids",
    )
    friction_table: str | None = Field(
        default=None,
        description="for models.friction = 'table': file (CSV, XLSX) with columns speed, cof and, "
        "where known, sd, pressure, viscosity; the path counts from the case file's folder",
    )
    friction_readings: tuple[FrictionReading, ...] | None = Field(
        default=None, description="the same readings written in the case"
    )
    friction_source: str | None = Field(default=None, description="who read them, and on what")
    shear_strength: Annotated[float, Quantity("Pa", 0.0, 1e9)] | None = Field(
        default=None,
        description="of the real contact, for models.friction = 'bowden_tabor'",
    )


class Models(Section):
    """One model for each slot of the physics."""

    hardness: Literal["gent", "ruess"] = default("gent", "gent", "Gent 1958")
    asperity: Literal["exponential", "contact_table"] = default(
        "exponential", "exponential", "Persson 2007, low-load form"
    )
    compliance: Literal["layered", "finite_element", "half_space"] = default(
        "layered", "layered", "outsole layer with free edges"
    )
    friction: Literal[
        "boundary",
        "stribeck",
        "adhesion_blocking",
        "constant",
        "asperity_ehl",
        "mean_film_sharing",
        "viscoelastic_area",
        "bowden_tabor",
        "table",
    ] = default("stribeck", "stribeck", "friction of the pair and fluid as measured at the speed")


class Numerics(Section):
    """Grid and tolerance."""

    grid_spacing: Annotated[float, Quantity("m", 5e-5, 0.005)] = default(
        0.6 * _mm, "0.6 mm", "four cells in the narrowest channel of the report"
    )
    quick_grid_spacing: Annotated[float, Quantity("m", 5e-5, 0.005)] = default(
        1.0 * _mm, "1 mm", "for a first look"
    )
    seed: Annotated[int, Field(ge=0, le=2**31, strict=True)] = default(
        0, 0, "of the draws behind the intervals; the same seed gives the same numbers"
    )
    tolerance: Tolerance = default(1e-4, 1e-4, "relative imbalance of volume and load")
    grid_check: Annotated[bool, Field(strict=True)] = default(
        False, False, "one grid; true solves the quick one too and estimates the grid's error"
    )
    most_memory: Annotated[float, Quantity("B", 2e8, 1e13)] = default(
        2e9, "2 GB", "a run that would take more is refused before it starts"
    )


class Risk(Section):
    """Who walks: the required friction of the people concerned."""

    rcof_mean: Friction = default(
        0.20, 0.20, "adults on level floor; derived from G.6, see slip probability", assumed=True
    )
    rcof_sd: Friction = default(
        0.03, 0.03, "adults on level floor; derived from G.6, see slip probability", assumed=True
    )
    model: Literal["report_g6", "beschorner_2016", "chang_2004"] = default(
        "report_g6", "report_g6", f"{_REPORT}, G.6.3"
    )
