"""The report gone through row by row, with its sentences and equations: docs/studies/report.md.

    python -m underfoot.studies.report_ledger docs/studies

writes the page from the rows (report_rows.toml), the verdicts that stand in summary.md, what the
default law gives today, and the table of equations.
"""

from __future__ import annotations

import re
import sys
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from underfoot.case.equations import EQUATIONS
from underfoot.core.catalogue import Catalogue
from underfoot.core.files import read_toml
from underfoot.friction import Pair, PairContactLaw, PairDraws, packaged_pair_draws
from underfoot.friction.pair_contact import Family
from underfoot.reference import soft_ehl_film

from . import studies, study
from .default_law import RQ_PER_RA, draws_without_report, viscosity_of
from .g3 import FLOORS, split
from .summary import folded_lines

ROWS = Path(__file__).with_name("report_rows.toml")
RATINGS = {"works": "works", "part": "in part", "outside": "outside the model"}
STANDS = {
    "with": "with the report",
    "against": "against the report",
    "part": "in part with it",
    "undecided": "undecided",
}
PRESSURE, SPEED = 266.1e3, 0.3
"""Pa and m/s: contact pressure of the report's pins, sliding speed of its slip tester in G.6."""
SUBJECTS = ("eq", "statement", "figure", "test", "command", "entry", "protocol", "erratum")


@dataclass(frozen=True, slots=True)
class LedgerRow:
    """One thing that the report holds: what a person runs for it, and what shows that it works."""

    number: str
    what: str
    how: str
    evidence: tuple[tuple[str, str], ...]
    rating: str
    cause: str

    def of(self, subject: str) -> tuple[str, ...]:
        """Return what the row's evidence names of one kind, as "statement"."""
        return tuple(name for kind, name in self.evidence if kind == subject)


@dataclass(frozen=True, slots=True)
class Sentence:
    """A sentence of the report's conclusions, and what the program finds by default."""

    text: str
    place: str
    finds: str
    stands: str
    why: str
    decides: str
    sources: str


def rows() -> tuple[LedgerRow, ...]:
    """Return the rows of the report."""
    claims = []
    for row in read_toml(ROWS)["row"]:
        evidence = tuple(
            (kind, name) for kind, _, name in (e.partition(" ") for e in row["evidence"])
        )
        claims.append(
            LedgerRow(
                row["n"],
                row["what"],
                row["how"],
                evidence,
                row.get("rating", "works"),
                row.get("cause", ""),
            )
        )
    return tuple(claims)


def sentences() -> tuple[Sentence, ...]:
    """Return the report's sentences with what the default law gives today."""
    numbers = default_numbers()
    return tuple(
        Sentence(**{**one, "finds": one["finds"].format(**numbers)})
        for one in read_toml(ROWS)["sentence"]
    )


def cof(
    *,
    shore_a: float = 60.0,
    sole_rq: float = 8e-6,
    floor_rq: float = 1.5e-6,
    family: Family = "aqueous",
    fluid: str = "",
    pressure: float = PRESSURE,
    speed: float = SPEED,
    draws: PairDraws | None = None,
) -> float:
    """Return the contact COF of the default law at its medians; no ``fluid`` is a dry floor.

    ``draws`` are the packaged ones by default.
    """
    viscosity = viscosity_of(fluid) if fluid else None
    pair = Pair(shore_a, (sole_rq, sole_rq), (floor_rq, floor_rq), family)
    law = PairContactLaw(pair, viscosity, draws or packaged_pair_draws())
    parts = law.contact_shear(np.array([pressure]), np.array([speed]))
    return float(sum(part[0] for part in parts)) / pressure


def default_numbers() -> dict[str, float]:
    """Return every number of the sentences by name."""
    oil: dict[str, Any] = {"family": "oil", "fluid": "canola_oil"}
    water: dict[str, Any] = {"fluid": "water"}
    blind = {"draws": draws_without_report()}
    glycerol: dict[str, Any] = {"fluid": "glycerol_50pct", **blind}
    dry: dict[str, Any] = {"family": "dry"}
    smooth = {"sole_rq": 2e-6, "floor_rq": 0.5e-6}
    rough = {"sole_rq": 8e-6, "floor_rq": 4e-6}
    pins = {"hard": (70.0, 3.39e-6), "soft": (60.0, 5.23e-6), "pu": (40.0, 6.46e-6)}
    adhesion = {}
    for name, (shore, ra) in pins.items():
        pair: dict[str, Any] = {"shore_a": shore, "sole_rq": RQ_PER_RA * ra, "speed": 0.01, **blind}
        pair["floor_rq"] = RQ_PER_RA * 1.89e-6
        oiled = cof(**pair, family="oil", fluid="gear_oil_75w140")
        adhesion[f"adhesion_{name}"] = 20.9 * (cof(**pair, family="dry") - oiled)
    splits = {
        floor: split(Catalogue.load(), draws_without_report(), "soft rubber", floor, 0)
        for floor in FLOORS
    }
    loss = {f"loss_{floor}": float(np.median(one.loss)) for floor, one in splits.items()}
    film = soft_ehl_film(
        viscosity=74.6e-3,
        entrainment_speed=1.0,
        load=20.9,
        radius=23.3e-3,
        effective_modulus=2.0e6,
    )[1]
    return {
        "oil_hard": cof(shore_a=75.0, **oil),
        "oil_soft": cof(shore_a=50.0, **oil),
        "oil_smooth": cof(sole_rq=2.5e-6, **oil),
        "oil_rough": cof(sole_rq=10e-6, **oil),
        "oil_floor_smooth": cof(floor_rq=0.5e-6, **oil),
        "oil_floor_rough": cof(floor_rq=4e-6, **oil),
        "dry_soft_smooth": cof(shore_a=50.0, **smooth, **dry),
        "dry_hard_rough": cof(shore_a=75.0, **rough, **dry),
        "water_smooth": cof(**smooth, **water),
        "water_rough": cof(**rough, **water),
        "water_light": cof(pressure=0.5 * PRESSURE, **water),
        "water_heavy": cof(pressure=2.0 * PRESSURE, **water),
        "dry_light": cof(pressure=0.5 * PRESSURE, **dry),
        "dry_heavy": cof(pressure=2.0 * PRESSURE, **dry),
        "glycerol_soft": cof(shore_a=50.0, **glycerol),
        "glycerol_hard": cof(shore_a=70.0, **glycerol),
        "lambda_canola": float(film) / float(np.hypot(8.2e-6, 1.34e-6)),
        **adhesion,
        **loss,
    }


def summary_verdicts(text: str) -> dict[str, str]:
    """Return the verdict of each statement in summary.md, by its text and place."""
    found = {}
    for line in text.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split(" | ")]
        if len(cells) == 7:
            found[cells[0]] = cells[5]
    return found


def beside_the_print(row: LedgerRow, verdicts: Mapping[str, str]) -> str:
    """Return the verdicts of a row's statements, as "2 agrees, 1 undecided"; "-" without any."""
    known = {
        statement.name: statement for name in studies() for statement in study(name).statements
    }
    given = Counter(
        verdicts.get(f"{known[name].text} ({known[name].place})", "not in the last run")
        for name in row.of("statement")
    )
    parts = [
        word if count == 1 == len(given) else f"{count} {word}" for word, count in given.items()
    ]
    return ", ".join(parts) or "-"


def markdown(verdicts: Mapping[str, str]) -> str:
    """Return the page."""
    every, told = rows(), sentences()
    counts = Counter(row.rating for row in every)
    stands = Counter(sentence.stands for sentence in told)
    against = [row for row in every if "disagrees" in beside_the_print(row, verdicts)]
    text = [
        "# The report, row by row",
        "",
        "Written by `python -m underfoot.studies.report_ledger docs/studies`; a test holds it to "
        "that. What the report defines, prints and concludes: what a person runs for it, and how "
        "the computed value stands beside the print. *Works* means that one command gives the "
        "thing, with print, the computed value and the cause where they differ. It does not mean "
        "that they agree: that is the column beside it, from "
        "[every printed statement beside the computed value](summary.md).",
        "",
        f"**{len(every)} rows**: "
        + ", ".join(f"{counts[k]} {v}" for k, v in RATINGS.items())
        + ". "
        f"In {len(against)} rows a printed statement is disagreed with.",
        "",
        "## What the report concluded, and what this program finds",
        "",
        "Contact friction by the default law at its medians (Shore A 60, sole Rq 8 µm, floor Rq "
        "1.5 µm, 266 kPa, 0.3 m/s, but for what is named). Where a sentence rests on friction "
        "that the report read, that law knows none of the report's readings. A level is known to "
        "a factor of two to three; a difference between two soles far better, but not to a few "
        "per cent (`underfoot compare` says how sure).",
        "",
        f"{len(told)} sentences: " + ", ".join(f"{stands[k]} {v}" for k, v in STANDS.items()) + ".",
        "",
    ]
    for number, sentence in enumerate(told, start=1):
        text += [
            f"{number}. **{sentence.text}** ({sentence.place}): *{STANDS[sentence.stands]}*. "
            f"{sentence.finds}",
            f"   Why: {sentence.why}",
        ]
        text += [f"   What would decide: {sentence.decides}"] if sentence.decides != "-" else []
        text += [f"   Evidence: {sentence.sources}.", ""]
    text += ["## Row by row", ""]
    table = [
        "| row | what | what a person runs | rating | beside the print | cause |",
        "|---|---|---|---|---|---|",
    ]
    for row in every:
        cells = (row.number, row.what, f"`{row.how}`" if row.how != "-" else "-")
        cells += (RATINGS[row.rating], beside_the_print(row, verdicts), row.cause or " ")
        table.append("| " + " | ".join(cells) + " |")
    text += [*folded_lines(f"Rows: {len(every)}", table), "## The 27 equations", ""]
    table = ["| equation | where | what | computed by |", "|---|---|---|---|"]
    for number, equation in EQUATIONS.items():
        code = ", ".join(f"`{path.removeprefix('underfoot.')}`" for path in equation.code) or "-"
        table.append(f"| {number} | {equation.place} | {equation.title} | {code} |")
    errata = [(name, entry) for name in studies() for entry in study(name).errata]
    text += [
        *folded_lines(f"Equations: {len(EQUATIONS)}", table),
        f"## Not taken as printed ({len(errata)})",
        "",
        "As `underfoot studies errata` lists.",
        "",
    ]
    table = ["| study | where | printed | used | why |", "|---|---|---|---|---|"]
    for name, entry in errata:
        table.append(
            "| " + " | ".join((name, *(re.sub(r"\|", "/", cell) for cell in entry))) + " |"
        )
    text += folded_lines(f"Corrections: {len(errata)}", table)
    return "\n".join(text).rstrip() + "\n"


def main(arguments: Sequence[str]) -> None:
    """Write report.md beside summary.md in a folder."""
    folder = Path(arguments[0])
    verdicts = summary_verdicts((folder / "summary.md").read_text(encoding="utf-8"))
    (folder / "report.md").write_text(markdown(verdicts), encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
