"""Prony series as the material of a finite element deck, each in its own normalisation."""

from pathlib import Path

from underfoot.core import InputError, to_si
from underfoot.core.remark import Message

from .elastomer import bulk_modulus, shear_from_young
from .spectrum import LEAST_AT_REST, RelaxationSpectrum

FORMS = {".inp": "Abaqus", ".k": "LS-DYNA", ".feb": "FEBio", ".mac": "ANSYS"}
"""Endings of files, and the program whose deck it is."""
MOST_TERMS = {"LS-DYNA": 18, "FEBio": 6, "Abaqus": 1000, "ANSYS": 1000}
"""Terms that a material of a program holds."""


def deck_text(
    series: RelaxationSpectrum,
    form: str,
    *,
    poisson_ratio: float = 0.49,
    unit: str = "MPa",
    density: float = 1.1e-9,
    name: str = "RUBBER",
) -> str:
    """Return a material of the terms of Young's modulus as text; its bulk modulus is constant.

    Abaqus: *HYPERELASTIC, NEO HOOKE with moduli at once, and *VISCOELASTIC with fractions of them.
    LS-DYNA: *MAT_GENERAL_VISCOELASTIC, shear moduli and decay rates, a rate of 0 at rest. FEBio:
    "uncoupled viscoelastic" on Mooney-Rivlin at rest, factors of the modulus at rest. ANSYS:
    MP and TB,PRONY with fractions of the moduli at once.

    Parameters:
        series: Of Young's modulus, Pa.
        form: "Abaqus", "LS-DYNA", "FEBio" or "ANSYS".
        poisson_ratio: At once; below 0.5.
        unit: Of moduli in the deck; times are s.
        density: In the deck's units (LS-DYNA's card has to hold one).
        name: Of the material.

    Raises:
        InputError: Another form; more terms than its material holds; for FEBio nothing at rest;
            a Poisson ratio of 0.5 or more.
    """
    if form not in MOST_TERMS:
        raise InputError(f'no deck of "{form}"', where="form", allowed=", ".join(MOST_TERMS))
    if not 0.0 < poisson_ratio < 0.5:
        raise InputError(
            f"Poisson's ratio {poisson_ratio:g} has no bulk modulus for a deck",
            where="poisson_ratio",
            allowed="above 0, below 0.5",
        )
    pascal = to_si(f"1 {unit}", "Pa", where="unit")
    shear = shear_from_young(series, poisson_ratio).scale_moduli(1.0 / pascal)
    at_once, rest = shear.instantaneous_modulus, shear.equilibrium_modulus
    bulk = float(bulk_modulus(series.instantaneous_modulus / pascal, poisson_ratio))
    terms = [
        (float(g), float(tau))
        for g, tau in zip(shear.term_moduli, shear.relaxation_times, strict=True)
        if g > 0.0
    ]
    if len(terms) > MOST_TERMS[form]:
        raise InputError(
            Message("{count} terms", count=len(terms)),
            where="series",
            allowed=Message(
                "at most {most} in a material of {form}", most=MOST_TERMS[form], form=form
            ),
            remedy="Give fewer terms (underfoot.material.reduce_spectrum)",
        )
    if form == "FEBio" and rest <= LEAST_AT_REST * at_once:
        raise InputError(
            "nothing is left at rest, and FEBio counts from there",
            where="series",
            remedy="Give the modulus at rest: --at-rest",
        )
    lines = {"Abaqus": _abaqus, "LS-DYNA": _dyna, "FEBio": _febio, "ANSYS": _ansys}[form](
        terms, at_once, rest, bulk, density, name
    )
    return "\n".join(lines) + "\n"


def write_deck(path: Path, series: RelaxationSpectrum, **more: float | str) -> None:
    """Write ``deck_text`` to a file; its ending tells the program.

    Raises:
        InputError: Another ending, a file that is there, or see ``deck_text``.
    """
    form = FORMS.get(path.suffix.casefold())
    if form is None:
        raise InputError(
            f'"{path.suffix}" is no ending of a deck',
            where=str(path),
            allowed=", ".join(f"{end} ({one})" for end, one in FORMS.items()),
        )
    if path.exists():
        raise InputError(
            Message("{out} exists", out=path), where=str(path), remedy="Give another name"
        )
    path.write_text(deck_text(series, form, **more), encoding="utf-8")  # pyright: ignore[reportArgumentType]


Terms = list[tuple[float, float]]


def _abaqus(terms: Terms, once: float, rest: float, bulk: float, density: float, name: str):
    rows = [f"{g / once:.9g}, 0., {tau:.9g}" for g, tau in terms]
    lines = [f"*MATERIAL, NAME={name}", "*DENSITY", f"{density:.6g},"]
    lines += ["*HYPERELASTIC, NEO HOOKE, MODULI=INSTANTANEOUS", f"{once / 2:.9g}, {2 / bulk:.9g}"]
    return [*lines, *(["*VISCOELASTIC, TIME=PRONY"] if rows else []), *rows]


def _dyna(terms: Terms, once: float, rest: float, bulk: float, density: float, name: str):
    def card(*values: float) -> str:
        return ",".join(f"{value:.9g}" for value in values)

    rows = [card(rest, 0.0)] if rest > 0.0 else []
    rows += [card(g, 1.0 / tau) for g, tau in terms]
    head = ["*KEYWORD", "*MAT_GENERAL_VISCOELASTIC_TITLE", name]
    return [*head, card(1, density, bulk, 0, 0, 0, 0, 0), card(*[0] * 8), *rows, "*END"]


def _febio(terms: Terms, once: float, rest: float, bulk: float, density: float, name: str):
    lines = ['<?xml version="1.0" encoding="UTF-8"?>', '<febio_spec version="4.0">', "<Material>"]
    lines += [f'<material id="1" name="{name}" type="uncoupled viscoelastic">']
    lines += [f"<g0>1</g0><density>{density:.6g}</density><k>{bulk:.9g}</k>"]
    for n, (g, tau) in enumerate(terms, start=1):
        lines.append(f"<t{n}>{tau:.9g}</t{n}><g{n}>{g / rest:.9g}</g{n}>")
    lines += [f'<elastic type="Mooney-Rivlin"><density>{density:.6g}</density>']
    lines += [f"<c1>{rest / 2:.9g}</c1><c2>0</c2><k>{bulk:.9g}</k></elastic>"]
    return [*lines, "</material>", "</Material>", "</febio_spec>"]


def _ansys(terms: Terms, once: float, rest: float, bulk: float, density: float, name: str):
    young = 9.0 * bulk * once / (3.0 * bulk + once)
    ratio = (3.0 * bulk - 2.0 * once) / (2.0 * (3.0 * bulk + once))
    lines = [f"! {name}: moduli at once, fractions of the shear modulus at once"]
    lines += [f"MP,EX,1,{young:.9g}", f"MP,PRXY,1,{ratio:.9g}", f"MP,DENS,1,{density:.6g}"]
    if terms:
        lines.append(f"TB,PRONY,1,1,{len(terms)},SHEAR")
    for n, (g, tau) in enumerate(terms):
        lines.append(f"TBDATA,{2 * n + 1},{g / once:.9g},{tau:.9g}")
    return lines
