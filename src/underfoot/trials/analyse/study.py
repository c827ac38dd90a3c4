"""What a whole folder says: fits, maps, means and tests over its usable files."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from underfoot.core import UnderfootError

from ..boundary import alpha_beta, friction_split
from ..floor_classes import class_scheme, cof_of_pendulum
from ..pressure_map import PressureScan, pressure_map
from ..protocols import Protocol
from ..statistics import precision
from ..stribeck_fit import METHODS as FIT_METHODS
from ..stribeck_fit import StribeckFit, stribeck_fit
from ..viscosity_speed_curve import master_curve
from .conditions import NUMBERS, person_condition
from .file_result import FileResult
from .study_tests import Finding, comparison_findings, persons_of, slip_findings
from .tables import (
    Table,
    condition_table,
    counted_steps,
    decimals_of,
    mean_and_interval,
    number_columns,
    quantity_name,
    scaled,
    steps_table,
)


@dataclass(frozen=True, slots=True)
class Study:
    """Results over the folder: ``tables``, ``findings`` (tests), and ``curves`` for figures."""

    tables: tuple[Table, ...] = ()
    findings: tuple[Finding, ...] = ()
    curves: Mapping[str, Any] = field(default_factory=dict)
    notes: tuple[str, ...] = ()


def study_of(files: Sequence[FileResult], protocol: Protocol) -> Study:
    """Return what the usable files say together, by the kind of the protocol.

    A fit, map or test that can't be done is a note with its reason, never an end.
    """
    usable = [one for one in files if one.usable]
    makers: dict[str, Callable[[list[FileResult], Protocol], Study]] = {
        "pin_on_disk": _pin_on_disk,
        "boundary": _boundary,
        "slip_tester": _slip_tester,
        "human_slip": _human_slip,
        "gait": _gait,
        "relaxation": _relaxation,
        "readings": _readings,
    }
    if not usable:
        return Study(notes=("no usable file",))
    try:
        return makers[protocol.kind](usable, protocol)
    except UnderfootError as error:
        # The numbers of the files are worth having even when they don't fit together.
        return Study(notes=(f"no result over all files: {error.what}",))


def _pin_on_disk(files: list[FileResult], protocol: Protocol) -> Study:
    keys = [key for key in protocol.words("group") if any(key in f.conditions for f in files)]
    groups = _grouped(files, keys)
    rows, notes, fits = [], [], []
    parameters: dict[str, list[Any]] = {"cof_bl": [], "tau_hydro": [], "cof_asymptote": []}
    for group, members in groups.items():
        points = [
            (f.main["speed"], f.main["cof"]) for f in members if {"speed", "cof"} <= {*f.main}
        ]
        label = ", ".join(group) or "all files"
        try:
            speed, cof = (np.array(c) for c in zip(*points, strict=True)) if points else ([], [])
            fit = stribeck_fit(speed, cof)
            simplex = stribeck_fit(speed, cof, method="nelder_mead")
        except UnderfootError as error:
            notes.append(f"{label}: not fitted ({error.what})")
            continue
        rows.append((*group, *_fit_cells(fit, simplex)))
        fits.append(
            {
                "label": label,
                "group": group[0] if group else "",
                "speed": [float(v) for v in speed],
                "cof": [float(v) for v in cof],
                "raw": list(fit.raw),
                "mean": float(np.mean(cof)),
                "verdict": fit.verdict,
                "r_squared": fit.r_squared,
            }
        )
        for parameter in (fit.boundary, fit.tau, fit.asymptote):
            keep = parameter.value is not None and not parameter.remark.startswith("not identified")
            value = parameter.value if keep else np.nan
            parameters[parameter.name].append((group[0] if group else "", value))
    columns = (
        *keys, "n", "R^2", "verdict",
        "COF_BL", "95 % low", "95 % high", "remark",
        "tau_hydro (m/s)", "95 % low", "95 % high", "remark",
        "COF_asymptote", "95 % low", "95 % high", "remark",
        "COF_BL by Nelder-Mead", "tau by Nelder-Mead", "asymptote by Nelder-Mead",
    )  # fmt: skip
    tables = [
        Table(
            "stribeck",
            "COF = asymptote + (COF_BL - asymptote) exp(-speed / tau), Eq. 17",
            columns,
            tuple(rows),
            (
                f"Fitted by {FIT_METHODS['separable']}; beside it {FIT_METHODS['nelder_mead']}.",
                "Intervals are profile likelihoods; a dash means that the profile does not close.",
                "Verdict: good above R^2 0.8, moderate above 0.5, else COF_BL is the mean COF.",
            ),
        )
    ]
    findings: list[Finding] = []
    shown: dict[str, Any] = {}
    for name, values in parameters.items():
        kept = [(g, v) for g, v in values if np.isfinite(v)]
        shown[name] = kept
        if len({g for g, _ in kept}) > 1:
            factor = protocol.text("compare", keys[0] if keys else "group")
            groups_of = {factor: [g for g, _ in kept]}
            made = comparison_findings(name, [v for _, v in kept], groups_of)
            lost = len(values) - len(kept)
            if lost and made:
                text = f"{lost} of {len(values)} series left out: not identified, or no good fit"
                made[0] = replace(made[0], cautions=(*made[0].cautions, text))
            findings += made
    curves: dict[str, Any] = {"fits": fits, "parameters": shown}
    wanted = [
        f for f in files if {"viscosity"} <= {*f.conditions} and {"speed", "cof"} <= {*f.main}
    ]
    if len(wanted) >= 6:
        viscosity = [float(f.conditions["viscosity"]) for f in wanted]
        speed = [f.main["speed"] for f in wanted]
        cof = [f.main["cof"] for f in wanted]
        try:
            curve = master_curve(viscosity, speed, cof)
            curves["master"] = {
                "product": [float(p) for p in np.multiply(viscosity, speed)],
                "cof": cof,
                "label": [str(f.conditions.get("fluid", "")) for f in wanted],
                "grid": curve.product.tolist(),
                "fitted": curve.fitted.tolist(),
                "residual_sd": curve.residual_sd,
                "r_squared": curve.r_squared,
            }
            tables.append(
                Table(
                    "master_curve",
                    "One curve of COF against viscosity times speed",
                    ("R^2", "residual sd", "points"),
                    ((curve.r_squared, curve.residual_sd, len(cof)),),
                    ("Isotonic regression: nothing is assumed but the fall.",),
                )
            )
        except UnderfootError as error:
            notes.append(f"no master curve: {error.what}")
    return Study(tuple(tables), tuple(findings), curves, tuple(notes))


def _fit_cells(fit: StribeckFit, simplex: StribeckFit) -> list[Any]:
    cells: list[Any] = [fit.n, fit.r_squared, fit.verdict]
    for parameter in (fit.boundary, fit.tau, fit.asymptote):
        cells += [parameter.value, parameter.low, parameter.high, parameter.remark]
    return cells + [p.value for p in (simplex.boundary, simplex.tau, simplex.asymptote)]


def _boundary(files: list[FileResult], protocol: Protocol) -> Study:
    dry, blocked = protocol.text("dry", "dry"), protocol.text("blocked", "sae_75w140")
    keys = protocol.words("pair")
    rows, notes, fluids, dry_adhesions, wet = [], [], [], [], []
    for pair, members in _grouped(files, keys).items():
        by_fluid: dict[str, list[float]] = {}
        for f in members:
            if "friction_force" in f.main:
                by_fluid.setdefault(str(f.conditions.get("fluid", "")), []).append(
                    f.main["friction_force"]
                )
        label = " on ".join(pair)
        if dry not in by_fluid or blocked not in by_fluid:
            notes.append(f"{label}: needs fluid {dry} and fluid {blocked}")
            continue
        others = {k: v for k, v in by_fluid.items() if k not in (dry, blocked)}
        split = friction_split(by_fluid[dry], by_fluid[blocked], others)
        for name, m in (
            ("dry", split.dry),
            ("hysteresis", split.hysteresis),
            ("adhesion", split.adhesion),
            *((f"adhesion with {k}", m) for k, m in split.lubricated_adhesion.items()),
        ):
            rows.append((*pair, name, m.value, m.uncertainty, m.n, "; ".join(map(str, m.flags))))
        for fluid, m in split.lubricated_adhesion.items():
            fluids.append(fluid)
            dry_adhesions.append(split.adhesion.value or 0.0)
            wet.append(m.value or 0.0)
    tables = [
        Table(
            "friction_split",
            "Adhesion and hysteresis, Eq. 22 to 25",
            (*keys, "part", "force (N)", "standard error (N)", "n", "flags"),
            tuple(rows),
            (f"Hysteresis is the friction with {blocked}: all adhesion is taken as blocked.",),
        )
    ]
    findings: list[Finding] = []
    curves: dict[str, Any] = {}
    try:
        fit = alpha_beta(fluids, dry_adhesions, wet)
        tables.append(
            Table(
                "alpha_beta",
                "Adhesion a fluid leaves, Eq. 26",
                ("fluid", "alpha (N)", "SE", "beta", "SE", "n"),
                tuple(
                    (r.fluid, r.alpha, r.alpha_error, r.beta, r.beta_error, r.n) for r in fit.fluids
                ),
                (
                    f"R^2 {fit.model.r_squared:.3f}, adjusted {fit.model.adjusted_r_squared:.3f}; "
                    f"mean absolute residual {fit.mean_absolute_residual:.3g} N.",
                ),
            )
        )
        findings += [Finding.of_anova(fit.type_two), Finding.of_anova(fit.type_three)]
        curves["alpha_beta"] = {
            "fluid": fluids,
            "dry": dry_adhesions,
            "wet": wet,
            "lines": [(r.fluid, r.alpha, r.beta) for r in fit.fluids],
        }
    except (UnderfootError, ValueError) as error:
        notes.append(f"Eq. 26 was not fitted: {getattr(error, 'what', error)}")
    return Study(tuple(tables), tuple(findings), curves, tuple(notes))


def _slip_tester(files: list[FileResult], protocol: Protocol) -> Study:
    keys = [key for key in protocol.words("group") if any(key in f.conditions for f in files)]
    tables, notes, maps = [], [], []
    table = condition_table(files, tuple(keys), ("cof",), person=_sample(files))
    if table:
        tables.append(table)
    rows = []
    wanted = next((r for r in protocol.rules if r.quantity == "repeats"), None)
    for group, members in _grouped(files, keys).items():
        label = ", ".join(group) or "all files"
        if wanted is not None and wanted.broken_by(float(len(members))):
            notes.append(f"{label}: {wanted.broken_by(float(len(members)))}")
        scans = [_scan(f) for f in members if "scan" in f.curves]
        if len(scans) < 2:
            continue
        spacing = protocol.number("scan_spacing", "m", 0.0) or None
        inlet = protocol.number("inlet_diameter", "m", 0.0) or None
        try:
            found = pressure_map(scans, spacing=spacing, inlet_diameter=inlet)
        except UnderfootError as error:
            notes.append(f"{label}: no map ({error.what})")
            continue
        rows.append(
            (
                label,
                len(scans),
                found.load.value,
                found.load.uncertainty,
                scaled("peak_pressure", found.peak.value),
                1e3 * (found.peak_along.value or 0.0),
                1e3 * (found.peak_lateral.value or 0.0),
                100 * found.outer_share,
                None if found.half_spacing_change is None else 100 * found.half_spacing_change,
                "; ".join(map(str, found.load.flags)),
                found.load.conventions.get("inlet", ""),
            )
        )
        thin = max(1, len(found.along) // 200)
        maps.append(
            {
                "label": label,
                "lateral": found.lateral.tolist(),
                "along": found.along[::thin].tolist(),
                "pressure": np.where(np.isnan(found.pressure), 0.0, found.pressure)[
                    :, ::thin
                ].tolist(),
                "load": found.load.value,
                "peak": found.peak.value,
                "peak_along": found.peak_along.value,
                "peak_lateral": found.peak_lateral.value,
            }
        )
    if rows:
        tables.append(
            Table(
                "maps",
                "Load carried by the fluid, Eq. 27",
                (
                    "map", "scans", "fluid load (N)", "of it sensor noise (N)", "peak (kPa)",
                    "peak from heel's back (mm)", "peak left of middle (mm)",
                    "share of outer scans (%)", "change at double spacing (%)", "flags",
                    "sensor inlet",
                ),
                tuple(rows),
                ("The load is what the scans cover; pressure beyond them is not in it.",),
            )
        )  # fmt: skip
    findings: list[Finding] = []
    labelled = [f for f in files if "cof" in f.main and all(k in f.conditions for k in keys)]
    if keys and len({str(f.conditions[keys[0]]) for f in labelled}) > 1:
        factors = {
            k: [str(f.conditions[k]) for f in labelled]
            for k in keys
            if len({str(f.conditions[k]) for f in labelled}) > 1
        }
        findings += comparison_findings("cof", [f.main["cof"] for f in labelled], factors)
    return Study(tuple(tables), tuple(findings), {"maps": maps}, tuple(notes))


def _human_slip(files: list[FileResult], protocol: Protocol) -> Study:
    keys = tuple(k for k in protocol.words("compare") if any(k in f.conditions for f in files))
    numbers = ("slip", "rcof", "acof", "peak_slipping_speed", "slip_distance", "peak_pressure")
    person = person_condition((f.conditions for f in files), protocol.text("subject"))
    tables = [condition_table(files, (), numbers, person=person)]
    for key in keys:
        name = f"conditions_{key}"
        tables.append(condition_table(files, (key,), numbers, person=person, name=name))
    findings, curves, notes = slip_findings(files, protocol, keys)
    # The table of all trials says nothing that one by conditions does not.
    made = [table for table in tables[1:] or tables if table]
    return Study((*made, steps_table(files)), tuple(findings), curves, tuple(notes))


def _gait(files: list[FileResult], protocol: Protocol) -> Study:
    with_rcof = [f for f in files if "rcof" in f.main]
    person = person_condition((f.conditions for f in files), protocol.text("subject"))
    factors = _factors(with_rcof, protocol.words("compare"), person)
    numbers = tuple(dict.fromkeys(["rcof", *(name for f in files for name in f.main)]))
    persons = persons_of(with_rcof, person)
    findings = comparison_findings("rcof", [f.main["rcof"] for f in with_rcof], factors, persons)
    tables = [condition_table(with_rcof, tuple(factors), numbers, person=person)]
    if len(factors) > 1:
        tables += [
            condition_table(with_rcof, (key,), numbers, person=person, name=f"conditions_{key}")
            for key in factors
        ]
    if person:
        tables.append(_person_table(with_rcof, tuple(factors), person))
    return Study((*(t for t in tables if t), steps_table(files)), tuple(findings))


def _factors(
    files: Sequence[FileResult], compare: Sequence[str], person: str
) -> dict[str, list[str]]:
    """Return the conditions to be tested: named by the protocol, or all that group the files."""
    keys = tuple(compare) or tuple(
        dict.fromkeys(
            key
            for f in files
            for key, value in f.conditions.items()
            if isinstance(value, str) and key != person and key not in NUMBERS
        )
    )
    factors = {
        key: [str(f.conditions[key]) for f in files]
        for key in keys
        if all(key in f.conditions for f in files)
    }
    return {k: v for k, v in factors.items() if 1 < len(set(v)) < max(len(files), 2)}


def _person_table(files: Sequence[FileResult], factors: tuple[str, ...], person: str) -> Table:
    groups: dict[tuple[str, ...], list[FileResult]] = {}
    for f in files:
        key = (str(f.conditions.get(person, f.file)), *(str(f.conditions[k]) for k in factors))
        groups.setdefault(key, []).append(f)
    rows = tuple(
        (*key, float(np.mean([f.main["rcof"] for f in own])), len(own),
         sum(map(counted_steps, own)))
        for key, own in sorted(groups.items())
    )  # fmt: skip
    columns = (person, *factors, "RCOF", "trials", "steps")
    note = "Mean of the trials' means; these are the values that the tests compare."
    return Table("persons", "Persons", columns, rows, (note,), {"RCOF": 4})


def _relaxation(files: list[FileResult], protocol: Protocol) -> Study:
    key = protocol.text("compare", "material")
    keys = (key,) if any(key in f.conditions for f in files) else ()
    forces = ("force_2_percent", "peak_force", "final_force")
    table = condition_table(files, keys, forces, person=_sample(files))
    return Study((table,) if table else ())


def _readings(files: list[FileResult], protocol: Protocol) -> Study:
    """Return means by sample with their classes, and the precision over operators or machines."""
    quantity = next(q for q in ("ptv", "angle", "cof") if any(q in f.main for f in files))
    keys = tuple(k for k in protocol.words("group") if any(k in f.conditions for f in files))
    keys = keys or tuple(
        dict.fromkeys(k for f in files for k, v in f.conditions.items() if isinstance(v, str))
    )
    name = protocol.text("classes")
    scheme = class_scheme(name) if name else None
    rows = []
    for f in files:
        m = f.measurements[0]
        low = high = None
        if m["spread"] is not None:
            _, _, low, high = mean_and_interval(np.array(f.curves["readings"]))
        cells: list[Any] = [f.file, *(f.conditions.get(k) for k in keys)]
        cells += [m["n"], m["value"], m["spread"], low, high]
        if quantity == "ptv":
            cells.append(cof_of_pendulum(float(m["value"])))
        if scheme is not None:
            ends = {scheme.class_of(v) for v in (low, high) if v is not None}
            own = scheme.class_of(float(m["value"]))
            cells.append(own)
            cells.append(", ".join(sorted(ends - {own})) or None)
        rows.append(tuple(cells))
    columns = ["file", *keys, "readings", *number_columns(quantity)]
    columns += ["COF from PTV"] if quantity == "ptv" else []
    columns += ["class", "interval reaches"] if scheme is not None else []
    notes = [
        "SD and 95 % interval (t) of the readings of one sample: they hold repeatability only."
    ]
    if scheme is not None:
        notes.append(f"Classes: {scheme.title}. {scheme.source[0].upper()}{scheme.source[1:]}.")
    spreads = [f.measurements[0]["uncertainty"] for f in files]
    places = max((decimals_of(u) for u in spreads if u), default=2)
    decimals = {**dict.fromkeys(number_columns(quantity), places), "COF from PTV": 3}
    title = f"Samples, {quantity_name(quantity)}"
    tables = [Table("samples", title, tuple(columns), tuple(rows), tuple(notes), decimals)]
    for by in ("laboratory", "operator", "machine"):
        tables += _precision(files, by, quantity, keys)
    return Study(tuple(tables))


def _precision(
    files: Sequence[FileResult], by: str, quantity: str, keys: tuple[str, ...]
) -> list[Table]:
    """Return repeatability and reproducibility of each floor over laboratories or operators."""
    groups: dict[tuple[str, ...], dict[str, list[float]]] = {}
    others = [k for k in keys if k != by]
    for f in files:
        if by in f.conditions:
            level = tuple(str(f.conditions.get(k, "")) for k in others)
            groups.setdefault(level, {})[str(f.conditions[by])] = f.curves["readings"]
    rows, tests = [], []
    for level, readings in groups.items():
        try:
            found = precision(readings)
        except UnderfootError:
            continue
        rows.append(
            (*level, found.laboratories, found.n, found.mean, found.repeatability,
             found.reproducibility, found.repeatability_limit, found.reproducibility_limit)
        )  # fmt: skip
        tests += [
            f"{', '.join(level) or 'all'}: {test.name}, {by} {test.laboratory}, {test.verdict} "
            f"({test.statistic:.3f}; 5 % {test.critical_5_percent:.3f}, 1 % "
            f"{test.critical_1_percent:.3f})"
            for test in found.outliers
            if test.verdict != "correct"
        ]
    if not rows:
        return []
    name = quantity_name(quantity)
    columns = (*others, {"laboratory": "laboratories"}.get(by, by + "s"), "readings", name, "s_r",
               "s_R", "r = 2.8 s_r", "R = 2.8 s_R")  # fmt: skip
    notes = (
        f"Repeatability s_r and reproducibility s_R over each {by} (ISO 5725-2); nothing left out.",
        *(tests or ("Cochran's and Grubbs' tests name no straggler or outlier.",)),
    )
    title = f"Repeatability and reproducibility by {by}"
    places = max(decimals_of(row[-3]) for row in rows)
    return [Table(f"precision_{by}", title, columns, tuple(rows), notes,
                  dict.fromkeys(columns[-5:], places))]  # fmt: skip


def _sample(files: Sequence[FileResult]) -> str:
    """Return the condition that names what was tested, where readings repeat it."""
    return next((n for n in ("sample", "specimen") if any(n in f.conditions for f in files)), "")


def _grouped(
    files: Sequence[FileResult], keys: Sequence[str]
) -> dict[tuple[str, ...], list[FileResult]]:
    groups: dict[tuple[str, ...], list[FileResult]] = {}
    for one in files:
        if all(key in one.conditions for key in keys):
            groups.setdefault(tuple(str(one.conditions[k]) for k in keys), []).append(one)
    return groups


def _scan(one: FileResult) -> PressureScan:
    c = one.curves["scan"]
    return PressureScan(
        one.file,
        np.array(c["along"]),
        np.array(c["pressure"]),
        c["lateral"],
        c["speed"],
        c["speed_change"],
        c["baseline_sd"],
        c["sample_load"],
    )
