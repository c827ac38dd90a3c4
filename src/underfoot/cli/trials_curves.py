"""``underfoot trials curves``: curves of two conditions, held as arrays."""

from __future__ import annotations

import json as json_text
from pathlib import Path
from typing import Annotated

import typer

from .guard import say
from .options import AsJson, number


def curves(
    files: Annotated[
        list[Path],
        typer.Argument(help="One array each, or one file with both (YA, YB)."),
    ],
    component: Annotated[
        int, typer.Option(help="Of curves of vectors: 1, 2, ...", show_default=False)
    ] = 0,
    alpha: Annotated[
        float, typer.Option(parser=number, help="Chance of a false alarm on a whole curve.")
    ] = 0.05,
    json: AsJson = False,
) -> None:
    """Test curves of two conditions as a whole (SPM, paired t): a row a person, a column a node.

    NumPy (.npy, .npz), MATLAB (.mat) or text, as spm1d takes them. Row i of both arrays is the same
    person.
    """
    from underfoot.core import DataError, InputError
    from underfoot.trials.readers.curve_arrays import read_curves
    from underfoot.trials.statistics import paired_curve_test

    where = ", ".join(file.name for file in files)
    if not 0 < alpha < 1:
        raise InputError(f"{alpha:g}", where="--alpha", allowed="between 0 and 1")
    found = [(name, values) for file in files for name, values in read_curves(file).items()]
    if len(found) != 2:
        raise DataError(
            f"{len(found)} arrays of curves: {', '.join(name for name, _ in found)}",
            where=where,
            allowed="two: one for each condition",
            remedy="Save each condition as an array of its own",
        )
    (one, first), (other, second) = ((n, _component(v, component, n)) for n, v in found)
    if len(first) != len(second):
        raise DataError(
            f"{len(first)} and {len(second)} curves are not of the same persons",
            where=where,
            allowed="pairs: row i of both is the same person",
            remedy="For two groups of equal size and spread take spm1d's ttest2",
        )
    test = paired_curve_test(first, second, alpha=alpha)
    if json:
        clusters = [{"first_node": c.start, "last_node": c.stop, "p": c.p, "p_peak": c.p_peak}
                    for c in test.clusters]  # fmt: skip
        content = {"format": 1, "kind": "curves", "persons": test.persons, "nodes": test.t.size,
                   "threshold": test.threshold, "fwhm": test.fwhm, "p": test.p,
                   "t": [None if t != t else t for t in test.t.tolist()],
                   "clusters": clusters, "still": list(test.still)}  # fmt: skip
        print(json_text.dumps(content))
        return
    places = [f"nodes {c.start} to {c.stop}" if c.stop > c.start else f"node {c.start}"
              for c in test.clusters]  # fmt: skip
    differ = f"at {' and '.join(places)}" if places else "nowhere"
    say(f"{one} against {other}: they differ {differ}; p of the curve {test.p:.2g}.")
    say(
        f"{test.persons} persons, {test.t.size} nodes counted from 0; t beyond chance at "
        f"{alpha:g}: {test.threshold:.2f}; smoothness (FWHM) {test.fwhm:.1f} nodes."
    )
    for c, place in zip(test.clusters, places, strict=True):
        say(f"{place.capitalize()}: p of the length {c.p:.2g}, of the peak {c.p_peak:.2g}.")
    if test.still:
        say(f"Left out, no scatter: nodes {', '.join(map(str, test.still))}.")


def _component(values, component: int, name: str):
    from underfoot.core import InputError

    count = values.shape[2] if values.ndim == 3 else 0
    if bool(count) != bool(component) or component > count or component < 0:
        raise InputError(
            f'"{name}" has {count} components' if count else f'"{name}" has no components',
            where="--component",
            allowed=f"1 to {count}" if count else "curves of vectors only",
        )
    return values[:, :, component - 1] if count else values
