"""Whole studies of made-up results: tables, tests, methods, doubts, figures and pages.

Of ``underfoot.trials.study.field_statistics``, ``underfoot.trials.study.study_tests``,
``underfoot.trials.study.tables``.
"""

import re
from dataclasses import replace
from functools import cache

import pytest

import trial_studies as made
from figure_lines import figure_lines
from snapshot import held
from underfoot.trials.pages import figures as drawn
from underfoot.trials.pages.figures import contact_sheets, sheets, trial_figures
from underfoot.trials.pages.report import (
    check_report_folder,
    csv_text,
    lead_sentence,
    page_table,
    study_parts,
    trials_page,
    write_spreadsheet,
    write_trials_report,
)
from underfoot.trials.recording import protocols
from underfoot.trials.study import field_statistics, study_tests, tables
from underfoot.trials.study.circumstances import (
    circumstance_table,
    gone_with,
    places_in_session,
    run_numbers,
    walking_speed,
)
from underfoot.trials.study.doubt import doubt_table
from underfoot.trials.study.file_result import FileResult, FileResultDraft
from underfoot.trials.study.folder import FolderAnalysis
from underfoot.trials.study.methods import methods_paragraphs
from underfoot.trials.study.study import study_of
from underfoot.trials.study.study_guard import guarded_files, study_doubts

protocol = cache(protocols.protocol)
STUDIES = {
    "gait": ("level_walking", made.gait_files, {"equivalence": 0.05}),
    "slips": ("report_g6", made.slip_files, {}),
    "treads": ("report_g5", made.slip_files, {}),
    "pins": ("report_g2", made.pin_files, {}),
    "boundary": ("report_g3", made.boundary_files, {}),
    "slides": ("report_g4", made.slide_files, {"equivalence": 0.02}),
    "blocks": ("report_g1_relaxation", made.relaxation_files, {}),
}


@cache
def analysis(name, *, refused=False):
    way, make, settings = STUDIES[name]
    chosen = protocol(way).with_settings(settings)
    files = make()
    if refused:
        files = [*files, made.refused_file(), made.EDITED]
    files, doubts = guarded_files([[one] for one in files])
    doubts += study_doubts(files, chosen)
    study = study_of(files, chosen)
    methods = methods_paragraphs(files, chosen, study, "0.0")
    return FolderAnalysis(chosen, tuple(files), study, tuple(methods), ("a note",), tuple(doubts))


def lines_of(table, cautions=()):
    """The lines of a table, each number by itself."""
    text = csv_text(table, cautions)
    return re.sub(r"(\d)e([-+])", r"\1E\2", text.replace(",", " | ")).splitlines()


def told(table, cautions=(), most=14):
    """A table as its text; of many rows the first and what all come to."""
    lines = lines_of(table, cautions)
    return {
        "title": table.title,
        "rows": len(lines),
        "text": "\n".join(lines[:most]),
        "notes": table.notes,
        "heads": [
            f"{h.name} {h.role} {h.quantity} {h.decimals} {h.always}"
            for h in table.heads
            if h.role != "plain" or h.decimals is not None
        ],
    }


def brief(table, cautions=()):
    """The first rows of a table, and how many there are."""
    lines = lines_of(table, cautions)
    return [len(lines), *lines[1:4], *table.notes[1:]]


def found(finding):
    return {
        **told(finding.table, finding.cautions),
        "marks": finding.marks,
        "outcome": finding.outcome,
        "by": f"{finding.response} {finding.factor} {finding.by_person}",
        "values": {k: list(v.values())[:3] for k, v in finding.values.items()},
    }


@pytest.mark.parametrize("name", STUDIES)
def test_studies(file_regression, name):
    whole = analysis(name)
    study = whole.study
    held(
        file_regression,
        {
            "tables": {t.name: told(t) for t in study.tables},
            "findings": {f.name: found(f) for f in study.findings},
            "curves": study.curves,
            "notes": study.notes,
            "methods": whole.methods,
            "lead": lead_sentence(whole),
            "doubts": [str(one) for one in whole.doubts],
            "person": whole.person,
            "models": {
                n: text.splitlines()[:3] if n.endswith("csv") else text
                for f in study.findings
                for n, text in f.files.items()
            }
            if name == "gait"
            else {},
            "names": [t.name for t in whole.tables],
        },
        f"study_{name}",
    )


def test_tables_of_files(file_regression):
    gait, slips = analysis("gait", refused=True), analysis("slips")
    every = {table.name: table for table in gait.tables}
    names = (
        "doubts",
        "files",
        "edits",
        "steps_wide",
        "steps_long",
        "stance_curves",
        "measurements",
    )
    parts = study_parts(gait)
    held(
        file_regression,
        {
            **{name: told(every[name], most=5) for name in names},
            "slips": told({table.name: table for table in slips.tables}["steps_wide"], most=4),
            "page": page_table(every["files"], limit=3),
            "parts": {k: parts[k] for k in ("lead", "counts", "reasons", "summary")},
            "of no doubt": doubt_table([]),
            "no curves": tables.curve_table([made.EDITED]),
            "no steps": tables.step_tables([made.EDITED]),
            "no edits": tables.edit_table(made.gait_files(1)),
            "no numbers": tables.condition_table(made.gait_files(1), (), ("cof",)),
            "two persons": told(
                tables.condition_table(made.gait_files(2), ("shoe",), ("rcof",), person="subject")
            ),
            "one person": told(
                tables.condition_table(made.gait_files(1), ("shoe",), ("rcof",), person="subject")
            ),
            "without persons": told(
                tables.condition_table(made.slip_files(2), (), ("slip", "rcof"))
            ),
            "names": [
                (
                    tables.quantity_name(n),
                    tables.shown_unit(n),
                    tables.heading(n, "SD"),
                    tables.scale_to_heading(n, 2.0),
                )
                for n in (
                    "rcof",
                    "slip_distance",
                    "peak_pressure",
                    "short-time stiffness",
                    "long-time modulus",
                    "short-time Young's modulus",
                    "angle",
                    "a_b",
                    "force_2_percent",
                    "crossed_array",
                )
            ],
            "scaled": tables.scale_to_heading("rcof", None),
            "decimals": [
                tables.decimals_of(x)
                for x in (0.0, -1.0, 0.02, 0.1, 0.099, 3.0, 1e-12, float("nan"))
            ],
            "means": [
                tables.mean_and_interval(*x)
                for x in (
                    ([], "rcof"),
                    ([0.2], "rcof"),
                    ([0.2, 0.2], "rcof"),
                    ([0.2, 0.3, 0.4], "rcof"),
                    ([0.2, 0.3], "rcof"),
                    ([-0.2, 0.3, 0.1], "slip_margin"),
                )
            ],
        },
    )


@pytest.mark.parametrize("name", STUDIES)
def test_figures(file_regression, name):
    whole = analysis(name)
    figures = trial_figures(whole, details=1)
    held(
        file_regression,
        {
            "names": [(one.name, one.chapter, one.caption) for one in figures],
            "figures": {one.name: figure_lines(one.figure) for one in figures[:3] + figures[-2:]},
        },
        f"figures_{name}",
    )


def test_figures_of_sensors_and_odd_curves(file_regression):
    pulses = [
        {
            "sensor": f"P{k}",
            "along": 0.03 * (k // 2),
            "across": 0.03 * (k % 2),
            "time": [0.0, 0.1],
            "kPa": [None, 2.0 + k],
        }
        for k in range(4)
    ]
    track = {"along": [0.0, 0.05], "across": [0.01, -0.01], "pulses": pulses}
    heel = made.slip_files(1)[0].curves["heel"][0]
    odd = {
        "time": heel["time"],
        "speed": heel["speed"],
        "start": None,
        "end": None,
        "peak": None,
        "peak_time": None,
        "threshold": 0.2,
    }
    slide = made.slide_files()[0].curves["slide"]
    rejected = {
        "time": [0.0, 0.1, 0.2],
        "normal": [10.0, 60.0, 70.0],
        "ratio": [0.5, 0.1, 0.2],
        "step": "step 3",
        "number": 3,
        "reason": "partial: " + 20 * "a long reason ",
    }
    files = [
        FileResult("a #1 of/b.c3d", curves={"track": [track], "heel": [odd]}),
        FileResult("no cof.csv", curves={"slide": slide}, verdict="refused", reasons=("no COF",)),
        FileResult(
            "long name of a file that is far too long for a tile.c3d",
            curves={"rejected": [rejected], "steps": made.gait_files(1)[0].curves["steps"] * 4},
        ),
        made.refused_file(),
    ]
    whole = replace(analysis("gait"), files=tuple(files), study=analysis("gait").study.__class__())
    figures = trial_figures(whole, details=9)
    held(
        file_regression,
        {
            "figures": {one.name: figure_lines(one.figure) for one in figures},
            "chosen": [f.file for f in drawn._choose_files(made.slip_files(), 4)],
            "sheets": list(sheets(files)),
        },
    )


@pytest.mark.parametrize("name", ["gait", "slips", "pins", "slides", "blocks"])
def test_contact_sheets(file_regression, name):
    files = [*STUDIES[name][1]()[:8], made.refused_file()]
    pages = [page for sheet in sheets(files) for page in contact_sheets(sheet)]
    many = list(
        contact_sheets(
            replace(next(iter(sheets(files))), tiles=next(iter(sheets(files))).tiles * 9)
        )
    )
    held(
        file_regression,
        {
            **{page.name: page.svg.replace("><", ">\n<") for page in pages},
            "many": [(page.name, len(page.svg.split("<g ")), page.svg[:120]) for page in many],
        },
        f"sheets_{name}",
    )


def test_pages(file_regression):
    whole = analysis("slides", refused=True)
    figures = [(one, b"png") for one in trial_figures(whole, details=1)]
    pages = [page for sheet in sheets(whole.files[:1]) for page in contact_sheets(sheet)]
    page = trials_page(whole, whole.tables, figures, pages)
    start = page.index("<body") if "<body" in page else 0
    bare = replace(analysis("blocks"), study=analysis("blocks").study.__class__())
    held(
        file_regression, {"page": page[start:], "bare": trials_page(bare, bare.tables, [])[-3000:]}
    )


def test_lead_sentences(file_regression):
    empty = analysis("gait").study.__class__()
    said = {name: lead_sentence(analysis(name)) for name in STUDIES}
    said["refused"] = lead_sentence(replace(analysis("gait"), files=(made.refused_file(),)))
    said["pins without tables"] = lead_sentence(replace(analysis("pins"), study=empty))
    said["walks without tables"] = lead_sentence(replace(analysis("gait"), study=empty))
    said["one slip"] = lead_sentence(replace(analysis("slips"), files=analysis("slips").files[:1]))
    said["with a refused file"] = lead_sentence(analysis("gait", refused=True))
    for count in (1, 2):
        files = made.gait_files(count)[::6]
        few = study_of(files, protocol("level_walking"))
        said[f"{count} walks"] = lead_sentence(
            replace(analysis("gait"), files=tuple(files), study=few)
        )
    held(file_regression, said)


def test_report_folder(file_regression, tmp_path):
    whole = analysis("blocks")
    told = []
    paths = write_trials_report(
        whole,
        tmp_path / "one",
        details=1,
        progress=lambda s, x, r=None: told.append((s, round(x, 3))),
    )
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "file").write_text("mine")
    from snapshot import refusal

    check_report_folder(tmp_path / "one")
    held(
        file_regression,
        {
            "paths": [path.relative_to(tmp_path).as_posix() for path in paths],
            "told": [told[0], told[-1]],
            "mark": (tmp_path / "one" / "analysis.txt").read_text(),
            "svg": sorted(
                {
                    line[:60]
                    for line in (tmp_path / "one" / "figures")
                    .glob("*hold.svg")
                    .__next__()
                    .read_text()
                    .splitlines()
                    if "clip" in line
                }
            )[:6],
            "refused": refusal(check_report_folder, tmp_path / "other").replace(
                str(tmp_path), "PLACE"
            ),
        },
    )


def test_spreadsheet(file_regression, tmp_path):
    import openpyxl

    odd = tables.TrialTable.of(
        "odd/name:[x]",
        "odd",
        ("a" * 70, "b"),
        [("=1+1", None), (float("inf"), True), ("x\x00y", 12345.678901234)],
        "note",
    )
    many = [odd, odd, odd, *analysis("blocks").tables]
    write_spreadsheet(many, ["how", "=much"], tmp_path / "a.xlsx")
    book = openpyxl.load_workbook(tmp_path / "a.xlsx")
    held(
        file_regression,
        {
            "sheets": {
                sheet.title: {
                    "rows": [list(row) for row in sheet.iter_rows(values_only=True)][:6],
                    "widths": {k: v.width for k, v in sheet.column_dimensions.items()},
                    "frozen": sheet.freeze_panes,
                    "bold": [cell.font.b for cell in next(sheet.iter_rows())],
                    "size": next(sheet.iter_rows())[0].font.sz,
                }
                for sheet in book.worksheets[:5]
            },
            "csv": csv_text(odd, ("one", "two")),
            "created": str(book.properties.created),
            "wrap": book.worksheets[0]["A1"].alignment.wrap_text,
        },
    )


def test_studies_with_little(file_regression):
    gait, slips, pins = made.gait_files(), made.slip_files(), made.pin_files()
    g6 = protocol("report_g6").with_settings({"tests": ["fisher", "anova"]})
    g5 = protocol("report_g5").with_settings({"compare": ["tread", "order"]})
    three = made.slip_files(outsoles=("hard", "soft", "worn"))
    bare = [replace(f, conditions={}) for f in slips]
    alone = [
        replace(f, conditions={k: v for k, v in f.conditions.items() if k != "subject"})
        for f in slips
    ]
    few = {
        "nothing": study_of([made.refused_file()], g6),
        "no persons": study_of(
            [replace(f, conditions={"shoe": f.conditions["shoe"]}) for f in gait],
            protocol("level_walking"),
        ),
        "two persons": study_of(gait[:12], protocol("level_walking")),
        "one walk": study_of(gait[:1], protocol("level_walking")),
        "bare slips": study_of(bare, g6),
        "slips without persons": study_of(alone, g6),
        "three outsoles": study_of(three, g6),
        "eight slips": study_of(slips[:8], g5),
        "three slips": study_of(slips[:3], g6),
        "six runs": study_of(pins[:6], protocol("report_g2")),
        "three runs": study_of(pins[:3], protocol("report_g2")),
        "one pair": study_of(made.boundary_files()[:8], protocol("report_g3")),
        "no oil": study_of(
            [f for f in made.boundary_files() if f.conditions["fluid"] != "sae_75w140"],
            protocol("report_g3"),
        ),
        "two scans": study_of(made.slide_files()[:2], protocol("report_g4")),
        "scans at one place": study_of(made.slide_files()[:1] * 2, protocol("report_g4")),
        "slides of a standard": study_of(made.slide_files(), protocol("en_iso_13287")),
        "one block": study_of(made.relaxation_files()[:1], protocol("report_g1_relaxation")),
    }
    held(
        file_regression,
        {
            name: {
                "tables": {t.name: brief(t) for t in one.tables if t.name != "steps"},
                "notes": one.notes,
                "findings": {f.name: brief(f.table, f.cautions) for f in one.findings},
            }
            for name, one in few.items()
        },
    )


def test_findings(file_regression):
    gait = made.gait_files(5, trials=1)
    gait = [
        replace(f, conditions={**f.conditions, "floor": ("dry", "wet")[i % 2]})
        for i, f in enumerate(gait)
    ]
    values = [f.main["rcof"] for f in gait]
    shoes, floors, who = ([f.conditions[k] for f in gait] for k in ("shoe", "floor", "subject"))
    columns = field_statistics.person_columns(values, shoes, who)
    skewed = [v + (0.3 if i in (3, 7) else 0.0) for i, v in enumerate(values)]
    own = [str(int(i)) for i in range(len(values))]
    comparison = study_tests.comparison_findings
    groups = {
        (f"sample {k}",): {
            "A": [0.3 + 0.02 * k, 0.31 + 0.02 * k],
            "B": [0.33 + 0.018 * k, 0.32 + 0.02 * k],
        }
        for k in range(5)
    }
    three = {k: {**v, "C": [0.3, 0.35]} for k, v in groups.items()}
    many = {
        "skewed": comparison("rcof", skewed, {"shoe": shoes}, who),
        "skewed, alone": comparison("rcof", skewed[:9], {"shoe": shoes[:9]}),
        "both": comparison("cof", values, {"shoe": shoes, "floor": floors}, margin=0.05),
        "each its own": comparison(
            "rcof", values, {"shoe": own, "one": ["x"] * 15, "persons": who}, who
        ),
        "confounded": comparison(
            "rcof", values, {"shoe": shoes, "colour": [s[0] for s in shoes]}, who
        ),
        "nothing": comparison("rcof", values, {}, ()),
        "constant": comparison("rcof", [0.2] * 15, {"shoe": shoes}, who),
        "exact": comparison(
            "rcof",
            [len(s) + 0.1 * len(w) for s, w in zip(shoes, who, strict=True)],
            {"shoe": shoes},
            who,
        ),
        "agreement": field_statistics.agreement_findings(groups, "laboratory", "cof"),
        "of three": field_statistics.agreement_findings(three, "operator", "ptv"),
        "of few": field_statistics.agreement_findings(
            dict(list(groups.items())[:2]), "operator", "ptv"
        ),
        "shares": field_statistics.share_findings(made.slip_files(), "outsole", "subject"),
    }
    held(
        file_regression,
        {
            **{
                name: {f.name: brief(f.table, f.cautions) for f in all_of}
                for name, all_of in many.items()
            },
            "columns": columns,
            "pairs": field_statistics.pair_values(columns, "soft", "hard"),
            "effects": field_statistics.effect_cells(columns, "soft", "hard"),
            "one in common": field_statistics.pair_values(
                {"a": {"x": 1.0, "y": 2.0}, "b": {"x": 3.0}}, "a", "b"
            ),
        },
    )


def test_circumstances(file_regression):
    gait = made.gait_files()
    shoes = {"soft": 1.0, "hard": 1.1, "worn": 1.2}
    faster = [
        replace(
            f,
            steps=tuple(
                replace(s, walking_speed=1.3 * shoes[f.conditions["shoe"]] + 0.01 * (7 * i % 5))
                for s in f.steps
            ),
        )
        for i, f in enumerate(gait)
    ]
    placed = [
        replace(f, conditions={**f.conditions, "n": str(6 - i % 6)}) for i, f in enumerate(gait)
    ]
    held(
        file_regression,
        {
            "speed": [walking_speed(gait[0]), walking_speed(made.refused_file())],
            "places": places_in_session(placed, "subject"),
            "runs": [
                run_numbers(gait[:4]),
                run_numbers(placed[:4]),
                run_numbers([FileResult("b"), FileResult("a")]),
                run_numbers([FileResult("b 2.0"), FileResult("a 1")]),
            ],
            "table": told(circumstance_table(placed, ("shoe", "floor"), "subject")),
            "none": circumstance_table(placed, (), "subject"),
            "gone": gone_with(faster, "shoe", "subject"),
            "placed": gone_with(placed, "shoe", "subject"),
            "not gone": gone_with(gait, "shoe", "subject"),
        },
    )


def test_file_results(file_regression):
    from underfoot.trials.recording.measurement import Measurement, caution

    draft = FileResultDraft("one", {"shoe": "a"}, "12")
    draft.note(float("nan"), "N", main="cof")
    draft.note(100.0, "N", fact="normal_force")
    draft.note(0.3, "m/s", main="speed", fact="sliding_speed")
    draft.add(
        "item", Measurement("cof", 0.2, uncertainty=0.1, flags=(caution("a doubt"),)), main="cof"
    )
    import numpy as np

    draft.curve(
        "c",
        time=np.linspace(0, 1, 1001),
        one=1.23456789012,
        lost=float("nan"),
        step="x",
        few=np.array([0.0, np.nan, 1.234567891e-5, np.inf]),
    )
    draft.curve("c", time=np.arange(401.0))
    one = draft.finish_result(protocol("en_iso_13287"))
    back = FileResult.from_dict(one.as_dict())
    held(
        file_regression,
        {
            "one": one,
            "same": back == replace(one, curves=back.curves),
            "main": one.main,
            "facts": one.facts,
            "usable": (one.usable, made.refused_file().usable),
            "measured": len(one.measurements),
            "dict": {k: v for k, v in one.as_dict().items() if k != "curves"},
            "packed": back.curves,
        },
    )
