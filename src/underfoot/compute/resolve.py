"""Materials and roughness of a case, resolved once: the context that options build from."""

import math
from dataclasses import replace

from underfoot.case import Case
from underfoot.case.contact import HARDNESS_SPREAD
from underfoot.case.context import Context
from underfoot.case.surfaces import STYLUS_WAVES
from underfoot.core import Breach, Progress, SourcedValue, ValidityRange, breaches, silent
from underfoot.material import shore_a_gent

SOFTEST = 0.16e6
"""Pa, Young's modulus of Shore A 0 (Gent)."""


def resolve_context(case: Case, progress: Progress = silent) -> Context:
    """Return what the options of a case are built from."""
    modulus, beyond = youngs_modulus(case)
    surfaces = case.shoe.roughness, case.floor.roughness
    return Context(
        shoe=case.shoe,
        floor=case.floor,
        contaminant=case.contaminant,
        motion=case.motion,
        interface=case.interface,
        modulus=modulus,
        modulus_breaches=(*beyond, *_untested_rates(case), *_soft_floor(case, modulus)),
        viscosity=None if case.contaminant is None else case.contaminant.build(),
        rq=case.effective_rq,
        rq_deviation=case.interface.rq_deviation(*surfaces),
        leak_deviation=case.interface.leak_deviation(*surfaces),
        fluid=case.entries.get("contaminant", "the fluid"),
        catalogue=case.consulted,
        progress=progress,
        rough_contact=case.rough_contact.table,
    )


def _untested_rates(case: Case) -> list[Breach]:
    """Return whether asperities work the rubber at rates (rad/s) beyond those of its test."""
    material, waves = case.shoe.material, (STYLUS_WAVES[1], STYLUS_WAVES[0])
    if material.relaxation is None or material.fastest_tested is None:
        return []
    tested = ValidityRange(
        material.slowest_tested or 0.0, material.fastest_tested, "rad/s", "test of the compound"
    )
    rates = [2 * math.pi * abs(case.motion.speed) / wave for wave in waves]
    return breaches("compound", {"frequency": tested}, {"frequency": rates})


def _soft_floor(case: Case, modulus: SourcedValue) -> list[Breach]:
    """Return whether the floor gives way with the sole: the solver takes it as rigid."""
    if case.floor.shore_a is None or modulus.value is None:
        return []
    least = modulus.value * (1 / HARDNESS_SPREAD - 1)  # of the floor: E E_f / (E + E_f) is 0.7 E
    softest = float(shore_a_gent(max(least, SOFTEST)))
    rigid = ValidityRange(
        softest, 100.0, "1", "a rigid floor: it softens the contact by less than 30 %"
    )
    return breaches("floor", {"Shore A": rigid}, {"Shore A": case.floor.shore_a})


def turn_context(context: Context, turn: float) -> Context:
    """Return the context with ``turn`` (rad) added to the shoe angle."""
    angle = {"shoe_angle": context.motion.shoe_angle + turn}
    return replace(context, motion=context.motion.model_copy(update=angle))


def youngs_modulus(case: Case) -> tuple[SourcedValue, list[Breach]]:
    """Return the outsole's Young's modulus: measured, or from hardness by the chosen relation."""
    material = case.shoe.material
    if case.hardness is None:
        return material.sourced_value("modulus"), []
    assert material.shore_a is not None  # the case checks that one of the two is there
    return case.hardness.build(material.shore_a)
