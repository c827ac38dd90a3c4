"""Laws of friction: stresses, ranges, tables, draws, classes of shoes, errors of treads."""

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
import pytest

from snapshot import held, refusal
from underfoot.core import SourcedValue
from underfoot.film import NewtonianFilm
from underfoot.fluid import AdhesionBlocking
from underfoot.friction.adhesion_blocking import AdhesionBlockingLaw
from underfoot.friction.asperity_ehl import ONE_CURVE, OWN_BOUNDARY, AsperityEHL, asperity_ehl_law
from underfoot.friction.asperity_scale import AsperityScale, self_affine_scale, spectrum_scale
from underfoot.friction.boundary import BoundaryLaw
from underfoot.friction.bowden_tabor import BowdenTaborLaw, ShearStrength, shear_strength_from_cof
from underfoot.friction.coefficient import cof
from underfoot.friction.constant import ConstantLaw
from underfoot.friction.film_shear import FilmShearLaw
from underfoot.friction.law import (
    FrictionParts,
    check_arguments,
    coefficient,
    viscous_shear,
    with_values,
)
from underfoot.friction.measured import (
    BoundaryFriction,
    boundary_friction_at,
    friction_left,
    viscous_decay,
)
from underfoot.friction.moore_2012 import StribeckLaw, stribeck_cof, stribeck_law_at
from underfoot.friction.pair_contact import (
    Pair,
    PairContactLaw,
    UnexpectedReading,
    contact_terms,
    even_rows,
    packaged_pair_draws,
    read_pair_draws,
    real_slope,
    relative_area,
)
from underfoot.friction.propagation import (
    named_shares,
    normal_draws,
    probability_higher,
    propagate_spread,
)
from underfoot.friction.rival_speed_effects import (
    MeanFilmSharing,
    ViscoelasticArea,
    modulus_exponent,
)
from underfoot.friction.sampled_cof import LawDraws, sampled_cof, sampled_points
from underfoot.friction.shoe_class import (
    ShoeClass,
    certificate_line,
    exclusive,
    of_class,
    shoe_class,
    shoe_classes,
    slip_tests,
)
from underfoot.friction.speed_effect import SpeedEffectLaw, cof_with_speed, fluid_share
from underfoot.friction.speed_table import SpeedTableLaw
from underfoot.friction.tread_error import (
    PRIOR,
    SharedError,
    fluid_class,
    learned_deviation,
    likeness,
    log_posterior,
    range_density,
    tread_deviation,
    tread_error,
    tread_pairs,
    variance_between,
)
from underfoot.friction.two_states import TwoStateLaw, between_states
from underfoot.surface import IsotropicSpectrum


def number(value: float | None, unit: str = "1", **more: Any) -> SourcedValue:
    return SourcedValue(value, unit, source="made up", **more)


SCALE = AsperityScale(5e-6, 4e-6, 0.5, 2e-8)
THIN = BoundaryFriction("thin", "a on b", 1e-3, number(0.6, uncertainty=0.02),
                        number(0.9, "m/s", uncertainty=0.1), number(0.001, uncertainty=0.01)
)  # fmt: skip
MIDDLE = BoundaryFriction("middle", "a on b", 8e-3, number(0.5, uncertainty=0.03),
                          number(0.2, "m/s", uncertainty=0.02), number(0.11, uncertainty=0.02)
)  # fmt: skip
THICK = BoundaryFriction(
    "thick", "a on b", 0.05, number(0.4, uncertainty=0.04, assumed=True, note="Guessed"),
    number(0.04, "m/s", uncertainty=0.01), number(0.09, uncertainty=0.03),
)  # fmt: skip
NO_FIT = BoundaryFriction("oil", "a on b", 0.06, number(0.3, assumed=True))
FLUIDS = (THIN, MIDDLE, THICK)
DRAWS = packaged_pair_draws().rows(np.arange(300))
ROUGH = Pair(65.0, (2e-6, 6e-6), (3e-6, 3e-6), "aqueous")
KNOWN = Pair(
    55.0, (4e-6, 4e-6), (1e-6, 5e-6), "detergent", hysteresis=0.08, full_contact=1e6,
    polymer="nitrile", shore_a_deviation=3.0, sole_slope=0.4, floor_slope=0.3,
    contact_deviation=0.2, measured=(True, True), hysteresis_origin="a test",
)  # fmt: skip
TABLE = SpeedTableLaw(
    np.array([0.01, 0.1, 1.0]), np.array([0.5, 0.3, 0.2]), "own readings", 0.25, 0.02,
    np.array([0.02, 0.03, 0.04]), (5e4, 3e5),
)  # fmt: skip
LAWS: dict[str, Callable[[], Any]] = {
    "blocking": lambda: AdhesionBlockingLaw(
        AdhesionBlocking(2.0, 0.4, "here"), number(0.5, uncertainty=0.05),
        number(0.1, uncertainty=0.01), 0.2),
    "blocking little": lambda: AdhesionBlockingLaw(
        AdhesionBlocking(2.0, 0.4, "here"), number(0.05), number(0.1)),
    "asperities": lambda: asperity_ehl_law(
        SCALE, modulus=5e6, viscosity=0.02, modulus_deviation=1e6, roughness_deviation=0.2),
    "asperities of a fluid": lambda: asperity_ehl_law(
        SCALE, modulus=5e6, poisson_ratio=0.4, viscosity=0.008, friction=MIDDLE,
        cof_hysteresis=number(0.1, uncertainty=0.02), fine_roughness=number(3e-8, "m")),
    "asperities, no limit": lambda: asperity_ehl_law(
        SCALE, modulus=5e6, viscosity=None, friction=NO_FIT),
    "boundary": lambda: BoundaryLaw.from_measured(THICK, others=FLUIDS),
    "boundary of a pair": lambda: BoundaryLaw.from_measured(MIDDLE, cof_hysteresis=number(0.9)),
    "bowden": lambda: BowdenTaborLaw(
        ShearStrength(2e6, "here", 0.1, 0.02, 1e5), lambda p, _: p / 2e6, lambda p, v: 0.1 + v,
        0.1, "a table"),
    "bowden alone": lambda: BowdenTaborLaw(ShearStrength(2e6, "here"), lambda p, _: p / 1e5, 0.05),
    "constant": lambda: ConstantLaw(0.3, 0.05, "given", 0.1, 0.02, 0.01),
    "constant alone": lambda: ConstantLaw(0.3, 0.0, "given"),
    "stribeck": lambda: StribeckLaw.from_measured(MIDDLE),
    "stribeck at its bound": lambda: StribeckLaw.from_measured(THIN, others=FLUIDS),
    "stribeck assumed": lambda: StribeckLaw.from_measured(THICK, cof_hysteresis=number(0.2)),
    "stribeck between": lambda: stribeck_law_at(0.02, FLUIDS),
    "table": lambda: TABLE,
    "table alone": lambda: SpeedTableLaw(np.array([0.1, 1.0]), np.array([0.5, 0.3]), "own"),
    "area": lambda: SpeedEffectLaw(ViscoelasticArea(0.12), number(0.5), number(0.1), 0.1),
    "mean film": lambda: SpeedEffectLaw(
        MeanFilmSharing(5e-3, 20.9, 1e7, 5e-6), number(0.5, uncertainty=0.1),
        number(0.6, uncertainty=0.1), 0.1, 0.03, (),
        {"rq": number(5e-6, "m", uncertainty=1e-6)}),
    "pair": lambda: PairContactLaw(ROUGH, 0.2, DRAWS),
    "pair, known": lambda: PairContactLaw(KNOWN, 0.005, DRAWS),
    "pair, dry": lambda: PairContactLaw(replace(ROUGH, family="dry", loss_tangent=(0.2, 0.2)),
                                        None, DRAWS),
    "pair, oil": lambda: PairContactLaw(replace(ROUGH, family="oil"), 0.06, DRAWS),
    "film shear": lambda: FilmShearLaw(ConstantLaw(0.3, 0.05, "given", 0.1), NewtonianFilm(0.1)),
    "two states": lambda: TwoStateLaw(StribeckLaw.from_measured(MIDDLE), 0.3),
}  # fmt: skip
PRESSURE = np.array([0.0, 0.5, 2e4, 2.6e5, 3e5, 2e6])
SPEED = np.array([0.0, 0.004, 0.05, -0.3, 1.0, 3.0])
FILM = np.array([0.0, 2e-7, 1e-6, 2e-5, 1e-4, 1e-3])


@pytest.mark.parametrize("name", LAWS)
def test_laws(file_regression, name):
    law = LAWS[name]()
    half = {key: 0.5 * (one.value or 1.0) for key, one in law.inputs.items()}
    fluid = {} if name == "pair, dry" else {"viscosity": 0.05}
    below = {key: 1.0 if key == "roughness_factor" else -1.0 for key in law.inputs}
    said = {
        "stresses": law(PRESSURE, SPEED, FILM),
        "total": law(PRESSURE, SPEED, FILM).total,
        "one": law(1e5, 0.3, 1e-5),
        "inputs": law.inputs,
        "half": law.at({**half, **fluid})(PRESSURE[1:], SPEED[1:], FILM[1:]).total,
        "below": None
        if name.startswith("pair")  # its draws are logarithms
        else law.at(below)(PRESSURE[1:], SPEED[1:], FILM[1:]).total,
        "same": law.at({})(1e5, 0.3, 1e-5).total,
        "error": law.error_of_model,
        "breaches": [
            law.breaches(contact_pressure=p, speed=v, film_thickness=h)
            for p, v, h in ((1e5, 0.3, 1e-5), (PRESSURE, SPEED, FILM + 1e-9), (0.0, 0.01, 2e-7))
        ],
        "name": law.name, "source": law.source, "assumptions": law.assumptions,
    }  # fmt: skip
    if hasattr(law, "table") and name not in ("film shear", "two states"):
        said |= {"table": law.table(), "short": repr(law)}
    if name in ("boundary", "blocking", "boundary of a pair"):
        said["parts"] = law.cof_parts
    for extra in ("highest", "full_contact", "spread_basis", "medians"):
        if name.startswith("pair"):
            said[extra] = getattr(law, extra)
    points = sampled_points(law, contact_pressure=[1e5, 3e5], speed=0.3, film_thickness=1e-3,
                            samples=100)  # fmt: skip
    said["points"] = points and {"value": points.value, "low": points.low, "high": points.high,
                                 "draws": points.draws, "left": points.left_out}  # fmt: skip
    held(file_regression, said, f"law {name.replace(',', '')}")


def test_mechanisms(file_regression):
    speeds = np.array([0.0, 0.01, 0.1, -1.0])
    bearing, sharing = AsperityEHL(SCALE, 5e6), AsperityEHL(SCALE, 5e6, 0.4, 5e-8, "sharing")
    rival = MeanFilmSharing(5e-3, 20.9, 1e7, 5e-6, 1e5, 1.0, 3e6)
    said: dict[str, Any] = {}
    for name, one in {"bearing": bearing, "sharing": sharing, "rival": rival,
                      "area": ViscoelasticArea(0.12, 0.1)}.items():  # fmt: skip
        said[name] = {
            "left": one.adhesion_left(viscosity=0.02, speed=speeds, contact_pressure=2e5),
            "dry": one.adhesion_left(viscosity=None, speed=speeds, contact_pressure=2e5),
            "pressures": one.adhesion_left(viscosity=0.02, speed=0.1, contact_pressure=PRESSURE),
            "cof": cof_with_speed(one, viscosity=0.02, speed=speeds, cof_boundary=0.5,
                                  cof_hysteresis=0.1),
            "all lost": cof_with_speed(one, viscosity=0.02, speed=0.1, cof_boundary=0.1,
                                       cof_hysteresis=0.2),
            "assumes": one.assumptions, "it": one,
        }  # fmt: skip
    said["film"] = bearing.film_thickness(viscosity=0.02, speed=speeds, contact_pressure=2e5)
    said["of all"] = rival.film_thickness(viscosity=0.02, speed=speeds)
    said["rougher"] = bearing.at({"roughness_factor": 2.0, "modulus": 1e6})
    said["levels"] = ONE_CURVE, OWN_BOUNDARY
    said["share"] = fluid_share([0.0, 1e-3, 0.5, 2.0, 50.0], [0.0, 0.0, 1.0, 3.0, 2.0])
    said["exponent"] = [
        modulus_exponent(lambda w, n=n: 1e6 * (1j * w) ** n, 1.0, 1e3) for n in (0.2, -0.1)
    ]
    said["scale"] = self_affine_scale(1e-5, rq=2e-6, longest_wave=1e-3, hurst=0.7)
    said["area"] = SCALE.contact_fraction([0.0, 0.01, 0.3, 5.0])
    said["spot"] = SCALE.spot_pressure([0.0, 0.01, 0.3, 5.0])
    said["strength"] = shear_strength_from_cof(0.4, 2e5, 0.05, "here")
    said["bell"] = ShearStrength(2e6, "here", 0.1)(np.array([0.0, 1e-7, 0.01, -1.0]))
    said["stribeck"] = stribeck_cof(speeds, 0.5, 0.2, 0.1), stribeck_cof(0.3, 0.2, 0.2, 0.05)
    waves = np.geomspace(1e3, 1e7, 60)
    spectrum = IsotropicSpectrum(
        waves, 1e-9 * waves**-3.6, 2 * np.pi * waves * np.gradient(waves), (2e3, 5e6)
    )
    said["spectrum"] = [spectrum_scale(wave, spectrum) for wave in (5e-6, 1e-4)]
    said["beyond"] = [refusal(spectrum_scale, wave, spectrum) for wave in (1e-6, 3e-3)]
    held(file_regression, said)


def test_measured_fluids(file_regression):
    plain = replace(MIDDLE, cof_boundary=number(0.5))
    said = {
        "left": [friction_left(one) for one in (FLUIDS, (MIDDLE,), (replace(
            MIDDLE, cof_asymptote=number(0.0100001)),))],
        "decay": viscous_decay(FLUIDS),
        "between": [boundary_friction_at(eta, FLUIDS) for eta in (1e-4, 1e-3, 3e-3, 0.02, 1.0)],
        "named": boundary_friction_at(0.01, (plain, THICK), fluid="soap"),
        "one": refusal(boundary_friction_at, 0.01, (THIN,)),
        "pairs": refusal(boundary_friction_at, 0.01, (THIN, replace(THICK, pair="c"))),
        "none": refusal(boundary_friction_at, 0.01,
                        (THIN, replace(THICK, cof_boundary=number(None, reason="none")))),
        "none first": refusal(boundary_friction_at, 0.01,
                              (replace(THIN, cof_boundary=number(None, reason="none")), THICK)),
        "negative": refusal(boundary_friction_at, 0.0, FLUIDS),
        "bound": refusal(friction_left, (replace(MIDDLE, cof_asymptote=number(0.0099)), NO_FIT)),
        "few": refusal(viscous_decay, (THIN, NO_FIT)),
        "fluid": refusal(replace, THIN, viscosity=0.0),
    }  # fmt: skip
    held(file_regression, said)


REFUSED: dict[str, Callable[[], Any]] = {
    "dry": lambda: BoundaryLaw.from_measured(None),
    "not measured": lambda: BoundaryLaw.from_measured(
        replace(THIN, cof_boundary=number(None, reason="no"))),
    "no fit": lambda: StribeckLaw.from_measured(NO_FIT),
    "no decay": lambda: StribeckLaw(number(0.5), number(0.0), number(0.1)),
    "viscosity": lambda: StribeckLaw(number(0.5), number(0.2), number(0.1), 0.0),
    "negative": lambda: coefficient(number(-0.1), "a"),
    "infinite": lambda: coefficient(number(math.inf), "a"),
    "missing": lambda: coefficient(number(None, reason="no"), "a"),
    "adhesion": lambda: ConstantLaw(-0.1, 0.1, "a"),
    "deviation": lambda: ConstantLaw(0.1, 0.1, "a", None, -0.1),
    "source": lambda: ConstantLaw(0.1, 0.1, " "),
    "strength": lambda: ShearStrength(-1.0, "a"),
    "width": lambda: ShearStrength(1.0, "a", -1.0),
    "peak": lambda: ShearStrength(1.0, "a", 1.0, 0.0),
    "no source": lambda: ShearStrength(1.0, ""),
    "fraction": lambda: shear_strength_from_cof(0.1, 1e5, 0.0, "a"),
    "more": lambda: shear_strength_from_cof(0.1, 1e5, 1.01, "a"),
    "pressure": lambda: shear_strength_from_cof(0.1, 0.0, 0.1, "a"),
    "cof": lambda: shear_strength_from_cof(-0.1, 1e5, 0.1, "a"),
    "loss": lambda: BowdenTaborLaw(ShearStrength(1.0, "a"), lambda p, _: p, -0.1),
    "lengths": lambda: SpeedTableLaw(np.ones(2), np.ones(3), "a"),
    "single": lambda: SpeedTableLaw(np.ones(1), np.ones(1), "a"),
    "falls": lambda: SpeedTableLaw(np.array([1.0, 1.0]), np.ones(2), "a"),
    "rest": lambda: SpeedTableLaw(np.array([0.0, 1.0]), np.ones(2), "a"),
    "below": lambda: SpeedTableLaw(np.array([0.1, 1.0]), -np.ones(2), "a"),
    "spread": lambda: SpeedTableLaw(np.array([0.1, 1.0]), np.ones(2), "a",
                                    cof_deviation=-np.ones(2)),
    "spreads": lambda: SpeedTableLaw(np.array([0.1, 1.0]), np.ones(2), "a",
                                     cof_deviation=np.ones(3)),
    "hysteresis": lambda: SpeedTableLaw(np.array([0.1, 1.0]), np.ones(2), "a", -0.1),
    "unnamed": lambda: SpeedTableLaw(np.array([0.1, 1.0]), np.ones(2), " "),
    "model": lambda: SpeedEffectLaw(ViscoelasticArea(0.1), number(0.5), number(0.1), None, -0.1),
    "exponent": lambda: ViscoelasticArea(-0.1),
    "rest speed": lambda: ViscoelasticArea(0.1, 0.0),
    "radius": lambda: MeanFilmSharing(0.0, 1.0, 1.0, 1.0),
    "entrainment": lambda: MeanFilmSharing(1.0, 1.0, 1.0, 1.0, entrainment=0.0),
    "stiffness": lambda: MeanFilmSharing(1.0, 1.0, 1.0, 1.0, stiffness=0.0),
    "frequencies": lambda: modulus_exponent(lambda w: w, 2.0, 1.0),
    "no frequency": lambda: modulus_exponent(lambda w: w, 0.0, 1.0),
    "blocking": lambda: AsperityEHL(SCALE, 5e6, blocking="bearin"),
    "modulus": lambda: AsperityEHL(SCALE, 0.0),
    "fine": lambda: AsperityEHL(SCALE, 1e6, fine_roughness=0.0),
    "scale": lambda: replace(SCALE, slope=0.0),
    "factor": lambda: SCALE.rougher(0.0),
    "wave": lambda: self_affine_scale(1e-3, rq=1e-6, longest_wave=1e-3),
    "no wave": lambda: self_affine_scale(0.0, rq=1e-6, longest_wave=1e-3),
    "family": lambda: PairContactLaw(ROUGH, None, DRAWS),
    "no family": lambda: PairContactLaw(replace(ROUGH, family="dry"), 0.1, DRAWS),
    "rq": lambda: PairContactLaw(replace(ROUGH, sole_rq=(0.0, 1e-6)), 0.1, DRAWS),
    "turned": lambda: PairContactLaw(replace(ROUGH, floor_rq=(2e-6, 1e-6)), 0.1, DRAWS),
    "nan": lambda: check_arguments(math.nan, 0.1, 0.1),
    "no speed": lambda: check_arguments(1.0, math.nan, 0.1),
    "pull": lambda: check_arguments([1.0, -2.0], 0.1, 0.1),
    "samples": lambda: propagate_spread(lambda v: v["a"], {"a": number(1.0)}, samples=99),
    "confidence": lambda: propagate_spread(lambda v: v["a"], {"a": number(1.0)}, confidence=1.0),
    "no confidence": lambda: propagate_spread(lambda v: v["a"], {"a": number(1.0)}, confidence=0.0),
    "no value": lambda: propagate_spread(lambda v: v["a"], {"a": number(None, reason="no")}),
    "not finite": lambda: propagate_spread(lambda _: np.inf, {"a": number(1.0)}),
    "class": lambda: shoe_class("EN ISO 20346"),
    "test": lambda: certificate_line("tile", 0.3, "lower", None, "a"),
    "kind": lambda: certificate_line("tile_glycerine", 0.3, "low", None, "a"),
    "no cof": lambda: certificate_line("tile_glycerine", 0.0, "lower", None, "a"),
    "high cof": lambda: certificate_line("tile_glycerine", 5.0, "lower", None, "a"),
}  # fmt: skip


def test_what_is_refused(file_regression, tmp_path):
    said = {name: refusal(call) for name, call in REFUSED.items()}
    flat = FrictionParts(*(np.ones((2, 2)) for _ in range(3)))
    one = np.ones((2, 2))
    bad = {
        "cells": partial(cof, flat, one, one, spacing=0.0),
        "shapes": partial(cof, flat, one, np.ones(2), spacing=1.0),
        "wet": partial(cof, flat, one, one, spacing=1.0, wet=np.ones(3)),
        "no number": partial(cof, flat, one, np.inf * one, spacing=1.0),
        "no load": partial(cof, flat, 0 * one, 0 * one, spacing=1.0),
    }
    said |= {f"cof {name}": refusal(call) for name, call in bad.items()}
    for name, text in {"empty": "", "no rows": "# source: a\na,b\n1,2\n",
                       "words": "# a\na\n" + "x\n" * 120}.items():  # fmt: skip
        (tmp_path / "draws.csv").write_text(text, encoding="utf-8")
        why = refusal(read_pair_draws, tmp_path / "draws.csv")
        said[f"draws {name}"] = why.replace(str(tmp_path), "FOLDER")
    held(file_regression, said)


def test_coefficients(file_regression):
    rng = np.random.default_rng(1)
    contact, fluid = rng.uniform(0, 3e5, (9, 8)), rng.uniform(0, 2e5, (9, 8))
    contact[:3] = 0.0
    film, wet = rng.uniform(1e-6, 1e-4, (9, 8)), rng.random((9, 8)) < 0.7
    area, film_area = rng.uniform(0.5, 1, (9, 8)), rng.uniform(0.5, 1, (9, 8))
    law = PairContactLaw(ROUGH, 0.2, DRAWS)
    parts = law(contact, 0.3, film)
    plain = cof(parts, contact, fluid, spacing=1e-3)
    places = {"wet": wet, "area": area, "film_area": film_area}
    drawn = {"speed": 0.3, "samples": 120, **places}
    fluid_input = {"viscosity": number(0.2, "Pa*s", uncertainty=0.03)}
    errors = {name: 0.3 * normal_draws(0, name, 120) for name in "abcdefgh"}
    sampled = sampled_cof(law, contact, fluid, film, fluid_inputs=fluid_input, **drawn)
    assert sampled is not None
    stated = {"x": {"adhesion": errors["a"], "hysteresis": errors["b"], "viscous": errors["c"],
                    "odds": errors["d"], "normal": errors["e"]}}  # fmt: skip
    whole = sampled_cof(
        law, contact, fluid, film, film_error=errors["a"], rough_errors={"gap": errors["b"]},
        tread_error=3 * errors["c"], film_shear=errors["d"], zero=0.1 * errors["e"], stated=stated,
        contact_factor=rng.uniform(1, 2, (9, 8)),
        suction=(number(3e4, "Pa", uncertainty=3e4), 0.4), confidence=0.9, seed=3, **drawn,
    )  # fmt: skip
    dry = sampled_cof(law, contact, 0 * fluid, film, film_error=errors["a"], zero=errors["e"],
                      speed=0.3, samples=120)  # fmt: skip
    constant = ConstantLaw(0.3, 0.05, "given", 0.1, 0.2, 0.01)
    steady = sampled_cof(constant, contact, fluid, film, **drawn)
    nothing = sampled_cof(ConstantLaw(0.3, 0.05, "a", 0.1, 0.0, 0.0), contact, fluid, film, **drawn)
    assert nothing is None
    assert sampled_cof(ConstantLaw(0.3, 0.05, "a"), contact, fluid, film, **drawn) is None
    effect = StribeckLaw.from_measured(MIDDLE)
    modelled = sampled_cof(replace(effect, model_deviation=0.1), contact, fluid, film, **drawn)
    draws = LawDraws(np.array([0.5, 1.0, 9.0]), np.ones(3), np.array([1.0, 2.0, 0.0]), 0.01,
                     np.array([0.1, 1.0, 2.0]), np.array([-1.0, 0.0, 2.0]), -0.5, 1.0, 2.0
    )  # fmt: skip
    many = (rng.uniform(0, 3e5, (12, 9)), np.full((12, 9), 1e4), rng.uniform(1e-6, 1e-4, (12, 9)))
    unwetted = {**drawn, "wet": np.zeros((9, 8), bool)}
    said = {
        "many": sampled_cof(law, *many, speed=0.3, samples=100),
        "unwetted": sampled_cof(law, contact, fluid, film, film_shear=errors["a"], **unwetted),
        "plain": plain,
        "placed": cof(parts, contact, fluid, spacing=1e-3, sampled=sampled, source="a", **places),
        "sampled": sampled, "whole": whole, "dry": dry, "steady": steady, "modelled": modelled,
        "of the whole": whole and [whole.sourced_value(n, number(0.1)) for n in ("cof", "viscous")],
        "exact": steady and steady.sourced_value("viscous", number(0.1)),
        "at": draws.at(0.6, adhesion=0.2, hysteresis=0.1, viscous=0.05, more_odds=0.5),
        "all": draws.at(1.0, adhesion=0.2, hysteresis=0.1, viscous=0.0),
    }  # fmt: skip
    held(file_regression, said)


def test_draws_of_what_is_not_known(file_regression):
    given = {"a": number(2.0, uncertainty=0.1), "b": number(1.0, uncertainty=0.34),
             "c": number(3.0), "d": number(-1.0, uncertainty=0.9)}  # fmt: skip

    def of(values):
        return values["a"] * values["b"] + np.array([values["c"], values["d"]])

    first = propagate_spread(of, given, samples=120)
    second = propagate_spread(of, given, samples=120, seed=4, model_deviation=0.2, confidence=0.5,
                              joint={"a": np.linspace(1, 3, 120)})  # fmt: skip
    bare = propagate_spread(of, given, samples=120, shares=False)
    low, high = np.arange(5.0), np.array([1.0, 1, 1, 1, 1])
    said = {
        "first": first, "second": second, "bare": bare.share,
        "higher": [
            probability_higher((1, 0.1, low), (1, 0.2, high), shared=True),
            probability_higher((1, 0.1, low), (1.1, 0.2, high), shared=False),
            probability_higher((1, 0.1, low), (1.1, 0.2, high[:2]), shared=True),
            probability_higher((1, None, low), (1.1, 0.2, high), shared=False),
            probability_higher((1, 0.1, low), (1.1, None, high), shared=False),
            probability_higher((1, 0.0, None), (1.1, 0.0, None), shared=True),
            probability_higher((1, 0.0, None), (1.0, 0.0, None), shared=True),
        ],
        "shares": named_shares(3, "a", 50), "normal": normal_draws(3, "a", 50),
        "rows": even_rows(np.array([0.1, 0.0, 0.6, 0.3]), 10, 0.5),
    }  # fmt: skip
    held(file_regression, said)


def test_pairs(file_regression, tmp_path):
    DRAWS.write(tmp_path / "draws.csv")
    again = read_pair_draws(tmp_path / "draws.csv")
    numbers = {"sole_rq": 4e-6, "floor_rq": 2e-6, "shore_a": 70.0}
    given = {**numbers, "loss_tangent": 0.3, "sole_slope": 0.5, "floor_slope": 0.2}
    errors = {
        "laboratory": np.linspace(-0.2, 0.4, 300),
        "dry part of the laboratory": np.zeros(300),
    }
    read = replace(DRAWS, errors=errors, notes=("a",), outside=(
        UnexpectedReading("plate", "COF", 0.4, 0.1, 0.2, 0.3),
        UnexpectedReading("pendulum", "PTV", 40.4, 10.1, 20.2, 30.3)))  # fmt: skip
    law = PairContactLaw(ROUGH, 0.2, read)
    said: dict[str, Any] = {
        "read again": again, "kept rows": read.rows([3, 1]), "outside": [
            one.text for one in read.outside],
        "law": (law.assumptions, law.spread_basis, law.medians, law.known_errors(400)),
        "joint": law.joint_draws(350, 2), "basis": PairContactLaw(
            ROUGH, 0.2, replace(DRAWS, basis="b")).spread_basis,
        "slopes": real_slope([1e-7, 8.3e-6, 1e-3]), "area": relative_area([1.0, 1e5, 1e7], 3e6),
        "names": [(one.compound_and_floor, one.sole_roughness) for one in (ROUGH, KNOWN)],
        "known": KNOWN.draw_inputs(DRAWS, 1), "rough": ROUGH.draw_inputs(DRAWS, 1),
    }  # fmt: skip
    for family in ("aqueous", "detergent", "oil", "dry"):
        for name, each in (("plain", numbers), ("given", given)):
            terms = contact_terms(DRAWS.constants, each, family=family)
            said[f"{family} {name}"] = terms, terms.adhesion(1e5, 0.01), terms.adhesion(1e5, None)
    held(file_regression, said)


PLACE = np.array([0.4, -0.2, 1.0, 0.3, 0.0, 0.7])


def test_shoes_of_known_class(file_regression):
    law = PairContactLaw(ROUGH, 0.2, DRAWS)
    read = PairContactLaw(ROUGH, 0.2, replace(DRAWS, errors={"laboratory": np.full(300, -0.5)}))
    value = ShoeClass("own", "a house", (
        certificate_line("tile_glycerine", 0.2, "value", 0.02, "a"),
        certificate_line("steel_glycerine", 0.3, "upper", None, "a")))  # fmt: skip
    low, high = (certificate_line("tile_glycerine", cof, kind, None, "a")
                 for cof, kind in ((0.3, "lower"), (0.2, "upper")))  # fmt: skip
    said: dict[str, Any] = {
        "tests": slip_tests(), "classes": [shoe_class(name) for name in shoe_classes()],
        "lines": [str(one) for one in (*value.readings, low)],
        "exclude": exclusive([low, high]) is not None,
        "agree": [exclusive([low]), exclusive([replace(low, cof=0.1), high]),
                  exclusive([low, replace(high, test=slip_tests()["steel_glycerine"])])],
    }  # fmt: skip
    for name, one, known, place in (
        ("class", law, shoe_class("EN ISO 20345 SR"), PLACE),
        ("flat", law, shoe_class("EN ISO 20345 SRC"), np.zeros(6)),
        ("value", law, value, PLACE),
        ("fails", law, ShoeClass("bad", "a house", (low,), fails=True), PLACE),
        ("too good", law, ShoeClass("best", "a", (replace(low, cof=4.9),)), PLACE),
        ("own readings", read, shoe_class("EN ISO 20345 SR"), PLACE),
        ("against readings", read, ShoeClass("best", "a", (replace(low, cof=1.5),)), PLACE),
    ):
        made = of_class(one, known, place, 5)
        draws = made.law.draws
        said[name] = {
            "passing": made.passing, "against": made.contradicted, "medians": made.law.medians,
            "notes": draws.notes, "basis": made.law.spread_basis, "source": draws.source,
            "constants": draws.constants, "errors": draws.errors, "count": draws.count,
        }  # fmt: skip
    held(file_regression, said)


def test_errors_of_treads(file_regression):
    apart = np.array([0.1, 0.2, -0.5, 0.0, 2.0, 0.0])
    error, film = tread_error(0.2), SharedError("film load, a", 0.5)
    known = {error.name(apart): np.linspace(-1, 1, 300), "another: 1 2": np.ones(300)}
    pairs = [one for one in tread_pairs() if one.fluid == "thick"]
    said = {
        "classes": [fluid_class(one) for one in (None, 1.99e-3, 2e-3)],
        "learned": {name: tread_deviation(name) for name in PRIOR},
        "errors": [tread_error(one) for one in (None, 1e-3, 0.2)],
        "alike": (likeness(PLACE, apart), likeness(PLACE, PLACE), variance_between(PLACE, apart),
                  variance_between(PLACE, PLACE), variance_between(PLACE, 0 * PLACE)),
        "name": error.name(PLACE),
        "draws": error.draws(PLACE, samples=300, seed=2),
        "few": error.draws(PLACE, samples=200, seed=2),
        "plain": error.draws(0 * PLACE, samples=300, seed=2),
        "known": error.draws(PLACE, samples=300, seed=2, known=known),
        "same": error.draws(apart, samples=300, seed=2, known=known),
        "film": film.draws(PLACE, samples=300, seed=2), "flat": film.draws(
            0 * PLACE, samples=300, seed=2),
        "posterior": log_posterior(pairs, 0.5), "of none": learned_deviation([], 0.5),
        "ranges": [range_density(np.array([0.0, 0.5, 2.0]), n) for n in (2, 3, 8)],
        "pairs": [replace(one, source="") for one in tread_pairs()[:6]],
    }  # fmt: skip
    held(file_regression, said)


def test_two_states_and_changed_laws(file_regression):
    sealed, wiped = (FrictionParts(*(np.array(x) for x in three))
                     for three in (((1.0, 2.0), (3.0, 4.0), (5.0, 6.0)),
                                   ((3.0, 8.0), (1.0, 1.0), (0.0, 0.0))))  # fmt: skip
    said = {
        "between": between_states(sealed, wiped, 0.25),
        "each": between_states(sealed, wiped, np.array([0.0, 1.0])),
        "changed": with_values(ConstantLaw(0.3, 0.0, "a", 0.1), {
            "cof_adhesion": -1.0, "cof_hysteresis": -1.0, "viscosity": 0.2, "source": 3.0}),
        "viscous": viscous_shear(0.1, np.array([0.3, 0.3]), np.array([1e-7, 1e-3])),
        "none": viscous_shear(None, np.array([0.3]), np.array([1e-7])),
    }  # fmt: skip
    held(file_regression, said)
