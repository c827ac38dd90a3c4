"""What a whole folder says: fits, maps, means and tests over its usable files."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from underfoot.core import UnderfootError
from underfoot.core.remark import Message, join_lines

from ..machines.pressure_map import PressureScan, pressure_map
from ..machines.stribeck_fit import METHODS as FIT_METHODS
from ..machines.stribeck_fit import master_curve, stribeck_fit
from ..recording.protocols import Protocol
from ..statistics import ordered_levels, precision
from . import tables
from .boundary import alpha_beta, friction_split
from .circumstances import circumstance_table
from .condition_table import MASS, NUMBERS, ORDERS
from .conditions import person_condition
from .field_statistics import agreement_findings, curve_findings
from .file_result import FileResult
from .floor_classes import ClassScheme, class_scheme, cof_of_pendulum
from .readings import HOW_READ, NOTED, board_correction
from .study_tests import columns_of, comparison_findings, persons_of, slip_findings, varying
from .tables import (
    Finding,
    Role,
    TrialColumn,
    TrialTable,
    condition_columns,
    condition_table,
    plain_columns,
    quantity_name,
)


@dataclass(frozen=True, slots=True)
class TrialStudy:
    """Results over the folder: ``tables``, ``findings`` (tests), and ``curves`` for figures."""

    tables: tuple[TrialTable, ...] = ()
    findings: tuple[Finding, ...] = ()
    curves: Mapping[str, Any] = field(default_factory=dict)
    notes: tuple[str, ...] = ()


def study_of(files: Sequence[FileResult], protocol: Protocol) -> TrialStudy:
    """Return what the usable files say together, by the kind of the protocol.

    A fit, map or test that can't be done is a note with its reason, never an end.
    """
    usable = [file for file in files if file.usable]
    if not usable:
        return TrialStudy(notes=(Message("no usable file"),))
    try:
        return _STUDIES[protocol.kind](usable, protocol)
    except UnderfootError as error:
        # The numbers of the files are worth having even when they don't fit together.
        return TrialStudy(notes=(Message("no result over all files: {error}", error=error.what),))


def _keys(files: Sequence[FileResult], wanted: Sequence[str]) -> tuple[str, ...]:
    """Return those of the wanted conditions that some file has."""
    return tuple(key for key in wanted if any(key in f.conditions for f in files))


def _pin_on_disk(files: list[FileResult], protocol: Protocol) -> TrialStudy:
    keys = _keys(files, protocol.texts("group"))
    rows, notes, fits = [], [], []
    parameters: dict[str, list[Any]] = {"cof_bl": [], "tau_hydro": [], "cof_asymptote": []}
    for group, members in tables.group_files(files, keys).items():
        label = ", ".join(group) or "all files"
        speed, cof = _speed_and_cof(members)
        try:
            fit = stribeck_fit(speed, cof)
            simplex = stribeck_fit(speed, cof, method="nelder_mead")
        except UnderfootError as error:
            notes.append(Message("{label}: not fitted ({error})", label=label, error=error.what))
            continue
        fitted = (fit.boundary, fit.tau, fit.asymptote)
        cells = (cell for p in fitted for cell in (p.value, p.low, p.high, p.remark))
        beside = (p.value for p in (simplex.boundary, simplex.tau, simplex.asymptote))
        rows.append((*group, fit.n, fit.r_squared, fit.verdict, *cells, *beside))
        first = group[0] if group else ""
        mean = float(np.mean(cof))
        fits.append(
            {"label": label, "group": first, "speed": speed, "cof": cof, "raw": list(fit.raw),
             "mean": mean, "verdict": fit.verdict, "r_squared": fit.r_squared}
        )  # fmt: skip
        levels = dict(zip(keys, group, strict=True))
        for parameter in fitted:
            keep = parameter.value is not None and parameter.identified
            parameters[parameter.name].append((levels, parameter.value) if keep else None)
    intervals = (
        (name, "95 % low", "95 % high", TrialColumn("remark", Role.LONG))
        for name in ("COF_BL", "tau_hydro (m/s)", "COF_asymptote")
    )
    heads = (
        *condition_columns(keys), "n", "R^2", "verdict",
        *(head for four in intervals for head in four),
        "COF_BL by Nelder-Mead", "tau by Nelder-Mead", "asymptote by Nelder-Mead",
    )  # fmt: skip
    title = "COF = asymptote + (COF_BL - asymptote) exp(-speed / tau), Eq. 17"
    explained = (
        Message(
            "Fitted by {separable}; beside it {nelder_mead}.",
            separable=FIT_METHODS["separable"], nelder_mead=FIT_METHODS["nelder_mead"],
        ),
        "Intervals are profile likelihoods; a dash means that the profile does not close.",
        "Verdict: good above R^2 0.8, moderate above 0.5, else COF_BL is the mean COF.",
    )  # fmt: skip
    made = [TrialTable.of("stribeck", title, heads, rows, *explained)]
    findings: list[Finding] = []
    compared = protocol.texts("compare") or keys[:1]
    for name, values in parameters.items():
        kept = [pair for pair in values if pair is not None]
        factors = {key: [level[key] for level, _ in kept] for key in compared if key in keys}
        tests = comparison_findings(name, [value for _, value in kept], factors)
        lost = len(values) - len(kept)
        if lost and tests:
            text = Message(
                "{lost} of {count} series left out: not identified, or no good fit",
                lost=lost, count=len(values),
            )  # fmt: skip
            tests[0] = replace(tests[0], cautions=(*tests[0].cautions, text))
        findings += tests
    curves: dict[str, Any] = {"fits": fits}
    wanted = [
        f
        for f in files
        if isinstance(f.conditions.get("viscosity"), float) and {"speed", "cof"} <= {*f.main}
    ]
    if len(wanted) >= 6:
        viscosity = [float(f.conditions["viscosity"]) for f in wanted]
        speed, cof = _speed_and_cof(wanted)
        try:
            curve = master_curve(viscosity, speed, cof)
            numbers = {"r_squared": curve.r_squared, "residual_sd": curve.residual_sd}
            curves["master"] = {
                "product": np.multiply(viscosity, speed).tolist(), "cof": cof,
                "label": [str(f.conditions.get("fluid", "")) for f in wanted],
                "grid": curve.product.tolist(), "fitted": curve.fitted.tolist(), **numbers,
            }  # fmt: skip
            title = "One curve of COF against viscosity times speed"
            heads = ("R^2", "residual sd", "points")
            note = "Isotonic regression: nothing is assumed but the fall."
            row = (*numbers.values(), len(cof))
            made.append(TrialTable.of("master_curve", title, heads, [row], note))
        except UnderfootError as error:
            notes.append(Message("no master curve: {error}", error=error.what))
    return TrialStudy(tuple(made), tuple(findings), curves, tuple(notes))


def _speed_and_cof(files: Sequence[FileResult]) -> tuple[list[float], list[float]]:
    both = [(f.main["speed"], f.main["cof"]) for f in files if {"speed", "cof"} <= {*f.main}]
    return [speed for speed, _ in both], [cof for _, cof in both]


def _boundary(files: list[FileResult], protocol: Protocol) -> TrialStudy:
    dry, blocked = protocol.text("dry", "dry"), protocol.text("blocked", "sae_75w140")
    keys = protocol.texts("pair")
    rows, notes, fluids, dry_adhesions, wet = [], [], [], [], []
    parts: dict[str, list[tuple[float, dict[str, str]]]] = {
        "dry_adhesion": [],
        "hysteresis": [],
        "lubricated_adhesion": [],
    }
    for pair, members in tables.group_files(files, keys).items():
        by_fluid: dict[str, list[float]] = {}
        for f in members:
            if "friction_force" in f.main:
                fluid = str(f.conditions.get("fluid", ""))
                by_fluid.setdefault(fluid, []).append(f.main["friction_force"])
        if dry not in by_fluid or blocked not in by_fluid:
            notes.append(
                Message(
                    "{pair: on }: needs fluid {dry} and fluid {blocked}",
                    pair=pair, dry=dry, blocked=blocked,
                )
            )  # fmt: skip
            continue
        others = {k: v for k, v in by_fluid.items() if k not in (dry, blocked)}
        split = friction_split(by_fluid[dry], by_fluid[blocked], others)
        own = dict(zip(keys, pair, strict=True))
        oiled = float(split.hysteresis)
        parts["dry_adhesion"] += [(force - oiled, own) for force in by_fluid[dry]]
        parts["hysteresis"] += [(force, own) for force in by_fluid[blocked]]
        parts["lubricated_adhesion"] += [
            (force - oiled, {**own, "lubricant": fluid})
            for fluid, forces in others.items()
            for force in forces
        ]
        for name, m in (
            ("dry", split.dry),
            ("hysteresis", split.hysteresis),
            ("adhesion", split.adhesion),
            *(
                (Message("adhesion with {fluid}", fluid=k), m)
                for k, m in split.lubricated_adhesion.items()
            ),
        ):
            rows.append((*pair, name, m.value, m.uncertainty, m.n, join_lines(m.flags)))
        for fluid, m in split.lubricated_adhesion.items():
            fluids.append(fluid)
            dry_adhesions.append(float(split.adhesion))
            wet.append(float(m))
    title = "Adhesion and hysteresis, Eq. 22 to 25"
    flags = TrialColumn("flags", Role.LONG)
    heads = (*condition_columns(keys), "part", "force (N)", "standard error (N)", "n", flags)
    note = Message(
        "Hysteresis is the friction with {blocked}: all adhesion is taken as blocked.",
        blocked=blocked,
    )
    made = [TrialTable.of("friction_split", title, heads, rows, note)]
    findings: list[Finding] = []
    curves: dict[str, Any] = {}
    try:
        fit = alpha_beta(fluids, dry_adhesions, wet)
        heads = ("fluid", "alpha (N)", "SE", "beta", "SE", "n")
        lines = [(r.fluid, r.alpha, r.alpha_error, r.beta, r.beta_error, r.n) for r in fit.fluids]
        note = Message(
            "R^2 {r_squared:.3f}, adjusted {adjusted:.3f}; mean "
            "absolute residual {residual:.3g} N.",
            r_squared=fit.model.r_squared, adjusted=fit.model.adjusted_r_squared,
            residual=fit.mean_absolute_residual,
        )  # fmt: skip
        title = "Adhesion a fluid leaves, Eq. 26"
        made.append(TrialTable.of("alpha_beta", title, heads, lines, note))
        findings += [Finding.of_anova(fit.type_two), Finding.of_anova(fit.type_three)]
        drawn = [(r.fluid, r.alpha, r.beta) for r in fit.fluids]
        curves["alpha_beta"] = {"fluid": fluids, "dry": dry_adhesions, "wet": wet, "lines": drawn}
    except (UnderfootError, ValueError) as error:
        notes.append(Message("Eq. 26 was not fitted: {error}", error=getattr(error, "what", error)))
    if parts["lubricated_adhesion"]:
        made.append(_range_over_fluids(keys[0], parts["lubricated_adhesion"]))
    for name, readings in parts.items():
        findings += _crossed_findings(name, readings)
    return TrialStudy(tuple(made), tuple(findings), curves, tuple(notes))


def _range_over_fluids(key: str, readings: Sequence[tuple[float, Mapping[str, str]]]) -> TrialTable:
    """Return how far apart the fluids are on each sole, of means over floors and repeats."""
    rows = []
    for sole in ordered_levels(own[key] for _, own in readings):
        by_fluid: dict[str, list[float]] = {}
        for force, own in readings:
            if own[key] == sole:
                by_fluid.setdefault(own["lubricant"], []).append(force)
        mean = {fluid: float(np.mean(forces)) for fluid, forces in by_fluid.items()}
        low, high = min(mean, key=mean.__getitem__), max(mean, key=mean.__getitem__)
        rows.append((sole, mean[low], low, mean[high], high, mean[high] - mean[low]))
    title = "Range of adhesion over the fluids: a small one is a polymer that no fluid blocks more"
    heads = (*condition_columns([key]), "lowest (N)", "under", "highest (N)", "under", "range (N)")
    note = "The report: polyurethane 0.89 N, soft rubber 3.88 N, hard rubber 4.61 N."
    return TrialTable.of("fluid_range", title, heads, rows, note)


def _crossed_findings(
    response: str, readings: Sequence[tuple[float, Mapping[str, str]]]
) -> list[Finding]:
    """Return the analysis of variance of a force on all conditions with every interaction.

    Tukey's comparisons of the levels follow. Adhesions of a pair share its mean under the oil.
    """
    values = [value for value, _ in readings]
    keys = readings[0][1] if readings else ()
    factors = {key: [own[key] for _, own in readings] for key in keys}
    return comparison_findings(response, values, factors)


def _slip_tester(files: list[FileResult], protocol: Protocol) -> TrialStudy:
    keys = _keys(files, protocol.texts("group"))
    notes, maps, rows = [], [], []
    wanted = next((r for r in protocol.rules if r.quantity == "repeats"), None)
    for group, members in tables.group_files(files, keys).items():
        label = ", ".join(group) or "all files"
        broken = wanted.broken_by(float(len(members))) if wanted is not None else None
        if broken:
            notes.append(Message("{label}: {broken}", label=label, broken=broken))
        scans = [PressureScan(f.file, **_scan(f)) for f in members if "scan" in f.curves]
        if len(scans) < 2:
            continue
        spacing, inlet = (
            protocol.number(name, "m", 0.0) or None for name in ("scan_spacing", "inlet_diameter")
        )
        try:
            mapped = pressure_map(scans, spacing=spacing, inlet_diameter=inlet)
        except UnderfootError as error:
            notes.append(Message("{label}: no map ({error})", label=label, error=error.what))
            continue
        load, change = mapped.load, mapped.half_spacing_change
        place = (1e3 * float(p) for p in (mapped.peak_along, mapped.peak_lateral))
        rows.append(
            (label, len(scans), load.value, load.uncertainty,
             tables.scale_to_heading("peak_pressure", mapped.peak.value), *place,
             100 * mapped.outer_share,
             None if change is None else 100 * change, join_lines(load.flags),
             load.conventions.get("inlet", ""))
        )  # fmt: skip
        thin = max(1, len(mapped.along) // 200)
        numbers = ("load", "peak", "peak_along", "peak_lateral")
        maps.append(
            {"label": label, "lateral": mapped.lateral.tolist(),
             "along": mapped.along[::thin].tolist(),
             "pressure": np.nan_to_num(mapped.pressure[:, ::thin]).tolist(),
             **{name: getattr(mapped, name).value for name in numbers}}
        )  # fmt: skip
    made = [condition_table(files, keys, ("cof",), person=_sample(files))]
    if rows:
        heads = (
            "map", "scans", "fluid load (N)", "of it sensor noise (N)", "peak (kPa)",
            "peak from heel's back (mm)", "peak left of middle (mm)", "share of outer scans (%)",
            "change at double spacing (%)", TrialColumn("flags", Role.LONG), "sensor inlet",
        )  # fmt: skip
        note = "The load is what the scans cover; pressure beyond them is not in it."
        title = "Load carried by the fluid, Eq. 27"
        made.append(TrialTable.of("maps", title, heads, rows, note))
    labelled = [f for f in files if "cof" in f.main and all(k in f.conditions for k in keys)]
    values, margin = [f.main["cof"] for f in labelled], protocol.number("equivalence", "1", 0.0)
    findings = comparison_findings("cof", values, columns_of(labelled, keys), margin=margin)
    shown = tuple(table for table in made if table)
    return TrialStudy(shown, tuple(findings), {"maps": maps}, tuple(notes))


def _condition_tables(
    files: list[FileResult], keys: Sequence[str], numbers: tuple[str, ...], person: str
) -> list[TrialTable]:
    """Return the table of each condition alone, without those that have nothing to show."""
    made = (
        condition_table(files, (key,), numbers, person=person, name=f"conditions_{key}")
        for key in keys
    )
    return [table for table in made if table]


def _human_slip(files: list[FileResult], protocol: Protocol) -> TrialStudy:
    keys = _keys(files, protocol.texts("compare"))
    numbers = ("slip", "rcof", "acof", "peak_slipping_speed", "slip_distance", "peak_pressure")
    person = person_condition(files, protocol.text("subject"))
    made = _condition_tables(files, keys, numbers, person)
    if not keys:
        # The table of all trials says nothing that one by conditions does not.
        table = condition_table(files, (), numbers, person=person)
        made = [table] if table else []
    walked = circumstance_table(files, keys, person)
    made += [walked] if walked else []
    findings, curves = slip_findings(files, protocol, keys)
    return TrialStudy((*made, tables.steps_table(files)), tuple(findings), curves)


def _gait(files: list[FileResult], protocol: Protocol) -> TrialStudy:
    with_rcof = [f for f in files if "rcof" in f.main]
    person = person_condition(files, protocol.text("subject"))
    keys = protocol.texts("compare") or tuple(
        dict.fromkeys(
            key
            for f in with_rcof
            for key, value in f.conditions.items()
            if isinstance(value, str) and key != person and key not in NUMBERS
        )
    )
    numbers_noted = dict.fromkeys(
        key
        for f in with_rcof
        for key, value in f.conditions.items()
        if isinstance(value, float) and key not in (*keys, *ORDERS, *MASS)
    )
    noted = columns_of(with_rcof, keys)
    numbers = tuple(dict.fromkeys(["rcof", *(name for f in files for name in f.main)]))
    persons = persons_of(with_rcof, person)
    factors, _ = varying("rcof", noted, persons)
    values, margin = [f.main["rcof"] for f in with_rcof], protocol.number("equivalence", "1", 0.0)
    findings = comparison_findings("rcof", values, noted, persons, margin=margin)
    findings += curve_findings(with_rcof, tuple(factors), person)
    table = condition_table(with_rcof, tuple(factors), numbers, person=person)
    if table and numbers_noted:
        listed = ", ".join(numbers_noted)
        words = Message(
            "Measured numbers are no levels and are not compared: {listed}.", listed=listed
        )
        table = replace(table, notes=(*table.notes, words))
    made = [table] if table else []
    if len(factors) > 1:
        made += _condition_tables(with_rcof, tuple(factors), numbers, person)
    walked = circumstance_table(with_rcof, tuple(factors), person)
    made += [walked] if walked else []
    if person:
        made.append(_person_table(with_rcof, tuple(factors), person))
    return TrialStudy((*made, tables.steps_table(files)), tuple(findings))


def _person_table(files: Sequence[FileResult], factors: tuple[str, ...], person: str) -> TrialTable:
    groups: dict[tuple[str, ...], list[FileResult]] = {}
    for who, f in zip(persons_of(files, person), files, strict=True):
        groups.setdefault((who, *(str(f.conditions[k]) for k in factors)), []).append(f)
    rows = tuple(
        (*key, float(np.mean([f.main["rcof"] for f in results])), len(results),
         sum(map(tables.counted_steps, results)))
        for key, results in tables.in_order(dict(sorted(groups.items()))).items()
    )  # fmt: skip
    heads = (
        *condition_columns([person, *factors]),
        TrialColumn("RCOF", decimals=4),
        "trials",
        "steps",
    )
    note = "Mean of the trials' means; these are the values that the tests compare."
    return TrialTable.of("persons", "Persons", heads, rows, note)


MODULI = (
    "short-time stiffness", "long-time stiffness", "short-time modulus", "long-time modulus",
    "short-time Young's modulus", "long-time Young's modulus",
)  # fmt: skip


def _relaxation(files: list[FileResult], protocol: Protocol) -> TrialStudy:
    keys = _keys(files, (protocol.text("compare", "material"),))
    numbers = ("force_2_percent", "peak_force", "final_force", *MODULI)
    table = condition_table(files, keys, numbers, person=_sample(files))
    return TrialStudy((table,) if table else ())


def _readings(files: list[FileResult], protocol: Protocol) -> TrialStudy:
    """Return means by sample with their classes, and the precision over operators or machines."""
    quantity = next(q for q in ("ptv", "angle", "cof") if any(q in f.main for f in files))
    keys = _keys(files, protocol.texts("group")) or tuple(
        dict.fromkeys(k for f in files for k, v in f.conditions.items() if isinstance(v, str))
    )
    files, keys = _told_apart(files, keys)
    rows, schemes = [], {}
    for f in files:
        m = f.measurements[0]
        low = high = None
        if m.spread is not None:
            _, _, low, high = tables.mean_and_interval(f.sample.readings, quantity)
        cells: list[Any] = [f.file, *(f.conditions.get(k) for k in keys)]
        cells += [m.n, m.value, m.spread, low, high, m.uncertainty]
        if quantity == "ptv":
            cof, error = cof_of_pendulum(f.main["ptv"], m.uncertainty or 0.0)
            cells += cof, error or None
        name = f.sample.scheme
        if name and not (quantity == "angle" and "operator" in keys):
            scheme = schemes.setdefault(name, class_scheme(name))
            cells += _classes(scheme, f.main[quantity], m.uncertainty)
        rows.append(tuple(cells))
    notes = [
        "SD and 95 % interval (t, on the logarithm): repeatability of one sample; u: standard "
        "uncertainty, with the calibration where it is known."
    ]
    samples = [f.measurements[0] for f in files]
    untold = [m.n for m in samples if m.spread is None]
    if any(n < 2 for n in untold):
        notes.append("Of a single reading SD, interval and u are not estimated: it has no scatter.")
    if any(n > 1 for n in untold):
        notes.append(
            "Of equal readings SD, interval and u are not resolved: they scatter by less than the "
            "resolution of a reading."
        )
    notes += [
        Message("Classes: {scheme}. {standing}.", scheme=s.title, standing=s.standing())
        for s in schemes.values()
    ]
    places = max((tables.decimals_of(m.uncertainty) for m in samples if m.uncertainty), default=2)
    numbers = (*tables.number_columns(quantity, places), TrialColumn("u", decimals=places))
    heads: list[TrialColumn | str] = ["file", *condition_columns(keys), "readings", *numbers]
    heads += plain_columns("COF from PTV", "u of COF", decimals=3) if quantity == "ptv" else ()
    heads += ("class", "2 u reaches") if schemes else ()
    made = [
        TrialTable.of(
            "samples",
            Message("Samples, {quantity}", quantity=quantity_name(quantity)),
            heads,
            rows,
            *notes,
        )
    ]
    if quantity == "angle":
        made += _walkers(files, keys, places, protocol.number("board_share", "1", 1.0))
    made += _lowest(files, quantity, keys, places, int(protocol.number("directions", "1", 1.0)))
    findings: list[Finding] = []
    for by in ("laboratory", "operator", "machine"):
        groups = _readings_by(files, by, keys)
        made += _precision(groups, by, quantity, keys)
        findings += agreement_findings(groups, by, quantity)
    return TrialStudy(tuple(made), tuple(findings))


def _told_apart(
    files: list[FileResult], keys: tuple[str, ...]
) -> tuple[list[FileResult], tuple[str, ...]]:
    """Return files and keys, with the table as a condition where nothing else names the samples.

    So it is where two tables agree in all conditions, and where a table has none but how it was
    read.
    """
    levels = {(f.sample.source, *(f.conditions.get(key) for key in keys)) for f in files}
    named = all(any(key in f.conditions for key in keys if key not in HOW_READ) for f in files)
    alike = len({level[1:] for level in levels}) < len(levels)
    if len({f.sample.source for f in files}) < 2 or (named and not alike):
        return files, keys
    told = [replace(f, conditions={"source": f.sample.source, **f.conditions}) for f in files]
    return told, ("source", *keys)


def _readings_by(
    files: Sequence[FileResult], by: str, keys: tuple[str, ...]
) -> dict[tuple[str, ...], dict[str, Sequence[float]]]:
    """Return readings by the other conditions, and by laboratory, operator or machine."""
    groups: dict[tuple[str, ...], dict[str, Sequence[float]]] = {}
    for f in files:
        if by in f.conditions:
            level = tuple(str(f.conditions.get(k, "")) for k in keys if k != by)
            groups.setdefault(level, {})[str(f.conditions[by])] = f.sample.readings
    return groups


def _classes(scheme: ClassScheme, value: float, u: float | None) -> tuple[str, str | None]:
    """Return the class of a value and the others that twice its uncertainty ``u`` reaches."""
    wide = 2.0 * (u or 0.0)
    own = scheme.class_of(value)
    others = {scheme.class_of(end) for end in (value - wide, value + wide)} - {own}
    return own, ", ".join(sorted(others)) or None


def _walkers(
    files: Sequence[FileResult], keys: tuple[str, ...], places: int, share: float
) -> list[TrialTable]:
    """Return each sample with the angle of all who walked on it, which gives its class."""
    others = tuple(k for k in keys if k != "operator")
    rows, corrected = [], False
    for level, members in tables.group_files(files, others).items() if "operator" in keys else ():
        boards = [f.sample.boards for f in members]
        changes = [
            board_correction(f.main["angle"], own, share)
            for f, own in zip(members, boards, strict=True)
        ]
        everybody = all(len(own) for own in boards)
        corrected |= everybody
        # one walker without boards: the angles of both as they were read
        added = [change if everybody else 0.0 for change, _ in changes]
        angles = [f.main["angle"] + change for f, change in zip(members, added, strict=True)]
        mean = float(np.mean(angles))
        inside = [f.measurements[0].uncertainty or 0.0 for f in members]
        inside += [error for _, error in changes if everybody]
        apart = float(np.std(angles, ddof=1)) if len(angles) > 1 else 0.0
        u = max(float(np.hypot.reduce(inside)) / len(members), apart / np.sqrt(len(angles)))
        told = "; ".join(
            f"{f.conditions.get('operator', '')} {f.main['angle']:.{places}f}"
            + (f" {change:+.{places}f}" if everybody else "")
            for f, change in zip(members, added, strict=True)
        )
        scheme = members[0].sample.scheme
        classes = _classes(class_scheme(scheme), mean, u) if scheme else (None, None)
        few = "1 of 2" if len(members) < 2 else ""
        rows.append((*level, told, mean, u, *classes, few))
    if not rows:
        return []
    numbers = plain_columns("angle (deg)", "u", decimals=places)
    classes = ("class", "2 u reaches", "walkers measured")
    heads = (*condition_columns(others), "walkers", *numbers, *classes)
    notes = (
        "The class of a sample is that of the mean angle of its walkers, two of them.",
        Message(
            "Angles are corrected by {share:.0f} % of what each walker reads off "
            "on the calibration boards, between boards by straight lines.",
            share=100 * share,
        )
        if corrected
        else "Angles are as read: no calibration boards of all walkers (a column standard angle).",
    )
    return [TrialTable.of("walkers", "Samples, all walkers, angle", heads, rows, *notes)]


def _lowest(
    files: Sequence[FileResult],
    quantity: str,
    keys: tuple[str, ...],
    places: int,
    directions: int,
) -> list[TrialTable]:
    """Return each sample with all its directions and the lowest, which gives the class."""
    heading = next((k for k in keys if k in NOTED["direction"]), "")
    others = tuple(k for k in keys if k != heading)
    rows = []
    for level, members in tables.group_files(files, others).items() if heading else ():
        values = {str(f.conditions.get(heading, "")): f.main[quantity] for f in members}
        low = min(members, key=lambda f: f.main[quantity])
        scheme, u = low.sample.scheme, low.measurements[0].uncertainty
        told = "; ".join(f"{name} {value:.{places}f}" for name, value in values.items())
        lacking = f"{len(values)} of {directions}" if len(values) < directions else ""
        numbers = low.main[quantity], u
        classes = _classes(class_scheme(scheme), *numbers) if scheme else (None, None)
        rows.append((*level, told, low.conditions.get(heading), *numbers, *classes, lacking))
    if not rows:
        return []
    name = quantity_name(quantity)
    numbers = plain_columns(name, "u", decimals=places)
    classes = ("class", "2 u reaches", "directions measured")
    heads = (*condition_columns(others), "directions", "lowest", *numbers, *classes)
    note = "The class of a sample is that of its lowest direction."
    return [
        TrialTable.of(
            "lowest", Message("Samples, lowest direction, {name}", name=name), heads, rows, note
        )
    ]


_UNRESOLVED = (
    "Where the readings are equal s_r or s_R is not resolved (–): it is below the resolution of a "
    "reading, not 0."
)


def _precision(
    groups: Mapping[tuple[str, ...], Mapping[str, Sequence[float]]],
    by: str,
    quantity: str,
    keys: tuple[str, ...],
) -> list[TrialTable]:
    """Return repeatability and reproducibility of each floor over laboratories or operators."""
    others = [k for k in keys if k != by]
    rows, tests, tried = [], [], False
    for level, readings in groups.items():
        try:
            spread = precision(readings)
        except UnderfootError:
            continue
        tried |= bool(spread.outliers)
        rows.append(
            (*level, spread.laboratories, spread.n, spread.mean, spread.repeatability,
             spread.reproducibility, spread.repeatability_limit, spread.reproducibility_limit)
        )  # fmt: skip
        tests += [
            Message(
                "{level}: {test}, {by} {laboratory}, {verdict} ({statistic:.3f}; 5 % {five:.3f}, "
                "1 % {one_percent:.3f})",
                level=level or "all", test=test.name, by=by, laboratory=test.laboratory,
                verdict=test.verdict, statistic=test.statistic, five=test.critical_5_percent,
                one_percent=test.critical_1_percent,
            )
            for test in spread.outliers
            if test.verdict != "correct"
        ]  # fmt: skip
    if not rows:
        return []
    places = max((tables.decimals_of(row[-3]) for row in rows if row[-3]), default=2)
    spreads = ("s_r", "s_R", "r = 2.8 s_r", "R = 2.8 s_R")
    numbers = plain_columns(quantity_name(quantity), *spreads, decimals=places)
    things = {"laboratory": "laboratories"}.get(by, by + "s")
    heads = (*condition_columns(others), things, "readings", *numbers)
    notes = (
        Message(
            "Repeatability s_r and reproducibility s_R over each {by} (ISO "
            "5725-2); nothing left out.",
            by=by,
        ),
        *(
            tests
            or (("Cochran's and Grubbs' tests name no straggler or outlier.",) if tried else ())
        ),
        *((_UNRESOLVED,) if any(None in row[-4:] for row in rows) else ()),
    )
    title = Message("Repeatability and reproducibility by {by}", by=by)
    return [TrialTable.of(f"precision_{by}", title, heads, rows, *notes)]


def _sample(files: Sequence[FileResult]) -> str:
    """Return the condition that names what was tested, where readings repeat it."""
    return next((n for n in ("sample", "specimen") if any(n in f.conditions for f in files)), "")


def _scan(result: FileResult) -> dict[str, Any]:
    stored = result.curves["scan"]
    return {**stored, **{key: np.array(stored[key]) for key in ("along", "pressure")}}


_STUDIES: Mapping[str, Callable[[list[FileResult], Protocol], TrialStudy]] = {
    "pin_on_disk": _pin_on_disk,
    "boundary": _boundary,
    "slip_tester": _slip_tester,
    "human_slip": _human_slip,
    "gait": _gait,
    "relaxation": _relaxation,
    "readings": _readings,
}
