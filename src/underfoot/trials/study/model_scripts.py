"""The data of a mixed model with scripts of R and Python that find its numbers again."""

import csv
import io
import re
from collections.abc import Mapping, Sequence

import numpy as np

from .. import statistics

_R = """\
# {title}
# Finds the numbers of the report again: lme4, lmerTest and pbkrtest. Rscript {name}.R{note}
library(lmerTest)
options(contrasts = c("contr.sum", "contr.poly"))
d <- read.csv("{name}.csv", check.names = FALSE)
for (factor in c({columns})) d[[factor]] <- factor(d[[factor]])
fit <- lmer({response} ~ {fixed} + {random}, d,
            control = lmerControl(optimizer = "bobyqa", optCtrl = list(rhoend = 1e-9)))
print(VarCorr(fit))
print(anova(fit, type = 3, ddf = "Kenward-Roger"), digits = 8)
"""
_PYTHON = """\
# {title}
# Finds the numbers of the report again: python {name}.py
from pathlib import Path

import pandas

from underfoot.trials.statistics import mixed_model

d = pandas.read_csv(Path(__file__).with_suffix(".csv"), dtype={{{text}}})
factors = {{name: d[name].tolist() for name in [{factors}]}}
model = mixed_model(d["{response}"], factors, d["person"].tolist(), [{terms}], name="{response}")
print({{name: variance**0.5 for name, variance in model.variances.items() if variance > 0}})
for row in model.tests:
    print(f"{{row.term}}: F({{row.df}}, {{row.error_df:.4g}}) = {{row.f:.6g}}, p = {{row.p:.4g}}")
"""
_SINGULAR = """
# A variance of the report is below zero (trials of one condition differ more than conditions do).
# R keeps variances at zero or above: its F tests differ here."""


def model_files(
    name: str,
    title: str,
    model: statistics.MixedModel,
    response: str,
    values: Sequence[float],
    factors: Mapping[str, Sequence[str]],
    persons: Sequence[str],
) -> dict[str, str]:
    """Return name.csv (one row a trial), name.R and name.py by their names.

    Columns are named as R takes them: letters, digits and underscores.
    """
    plain = _plain_names(["person", response, *factors])
    own, measured, *columns = plain.values()
    rows = io.StringIO()
    writer = csv.writer(rows, lineterminator="\n")
    writer.writerow([own, *columns, measured])
    writer.writerows(zip(persons, *factors.values(), map(repr, map(float, values)), strict=True))

    def term(parts: str) -> str:
        return ":".join(plain.get(part, part) for part in parts.split(":"))

    # NaN: one with a later one, as a person's condition is with the trial where none repeats
    random = [term(what) for what, variance in model.variances.items()
              if what != "trial" and np.isfinite(variance)]  # fmt: skip
    singular = any(variance < 0 for variance in model.variances.values())
    words = {
        "title": title,
        "name": name,
        "note": _SINGULAR if singular else "",
        "columns": ", ".join(f'"{one}"' for one in (own, *columns)),
        "response": measured,
        "fixed": " + ".join(map(term, model.design.terms)),
        "random": " + ".join(f"(1 | {what})" for what in random),
        "text": ", ".join(f'"{one}": str' for one in (own, *columns)),
        "factors": ", ".join(f'"{column}"' for column in columns),
        "terms": ", ".join(f'"{term(one)}"' for one in model.design.terms),
    }
    return {
        f"{name}.csv": rows.getvalue(),
        f"{name}.R": _R.format(**words),
        f"{name}.py": _PYTHON.format(**words),
    }


def _plain_names(names: Sequence[str]) -> dict[str, str]:
    """Return each name as one that R and Python take, none twice."""
    found: dict[str, str] = {}
    for name in names:
        plain = re.sub(r"[^0-9A-Za-z_]", "_", name).lstrip("_0123456789") or "factor"
        while plain in found.values():
            plain += "_"
        found[name] = plain
    return found
