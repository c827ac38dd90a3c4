"""Commands on a case: ``check``, ``run``, ``slip``, ``compare``, ``risk``, ``test`` and so on."""

from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from .guard import say
from .options import CasePath, Shared, catalogue_for, optional, sharing
from .output import finish

RcofFrom = Annotated[
    Path | None,
    optional("measurements.csv of `underfoot trials analyse`: its RCOF replace risk.rcof_*."),
]


def _measured_rcof(path: Path | None, *, steps: bool = False) -> list[str]:
    """Return the settings of a case that hold the RCOF of measured walkers."""
    if path is None:
        return []
    from underfoot.questions.slips import measured_rcof

    measured = measured_rcof(path)
    say(measured.text)
    return measured.settings(steps=steps)


@sharing(without=("out", "quick", "processes", "overwrite"))
def check(shared: Shared, case: CasePath) -> None:
    """Read a case and print its values, sources, assumptions and the cost of a run."""
    from underfoot.compute.check import case_check

    answer = case_check(shared.case(case))
    finish(answer, None, json=shared.json, everything=shared.everything)


@sharing()
def run(
    shared: Shared,
    case: CasePath,
    no_advice: Annotated[
        bool,
        typer.Option(
            "--no-advice", help="Do not simulate possible changes (never done with --quick)."
        ),
    ] = False,
    maps: Annotated[
        bool, typer.Option("--maps", help="Draw PNG maps too; report.html draws its own.")
    ] = False,
    rcof_from: RcofFrom = None,
) -> None:
    """Compute the friction of a case, then the effect of possible changes on the coarse grid.

    Data and report.html go to --out, by default out/CASE. With --json and no --out nothing
    is written.
    """
    from underfoot.compute.run import run as result_of
    from underfoot.core.files import check_writable_folder
    from underfoot.core.progress import bar
    from underfoot.questions.risk import risk_assessment
    from underfoot.report import write_report

    given = shared.case(case, _measured_rcof(rcof_from))
    folder = shared.out if shared.out is not None or shared.json else Path("out") / case.stem
    if folder is not None:
        check_writable_folder(folder, overwrite=shared.overwrite)
    with bar(given.name) as progress:
        result = result_of(given, quick=shared.quick, processes=shared.processes, progress=progress)
    written = advice = None
    if folder is not None:  # before the advice, which may take longer than the answer
        written = write_report(result, folder, overwrite=shared.overwrite, maps=maps)
    if result.usable and not (shared.quick or no_advice):
        with bar("effect of possible changes") as progress:
            advice = risk_assessment(
                given, result=result, processes=shared.processes, progress=progress
            )
        if folder is not None:
            written = write_report(result, folder, overwrite=True, advice=advice, maps=maps)
    finish(result, written, json=shared.json, everything=shared.everything, advice=advice)


@sharing()
def ask(
    shared: Shared,
    question: Annotated[str, typer.Argument(help="Its name.")],
    case: CasePath,
) -> None:
    """Answer a question that another package asks of a case (docs/extending.md)."""
    from underfoot.questions.ask import ask as answer_of

    shared.ask(shared.case(case), partial(answer_of, question))


@sharing(quick=True, without=("processes",))
def slip(
    shared: Shared,
    case: CasePath,
    subjects: Annotated[
        int | None, typer.Option("--subjects", min=1, help="Number of walkers.")
    ] = None,
    full_model: Annotated[
        bool, typer.Option("--full-model", help="Full model for every walker: seconds each.")
    ] = False,
    history: Annotated[
        list[Path] | None,
        typer.Option(
            "--history",
            help="Steps of your own instead of the packaged ones: a force-plate recording or a "
            "table; may be repeated.",
        ),
    ] = None,
    rcof_from: RcofFrom = None,
) -> None:
    """Simulate slips for a population of walkers: who slips, speed, distance, pressures.

    Data, figure and animated report.html go to --out, by default out/CASE_slip. A stopped run
    continues.
    """
    from underfoot.questions.slips import own_histories, slip_population

    given = shared.case(case, _measured_rcof(rcof_from, steps=True))
    steps = [step for path in history or () for step in own_histories(path)]
    if shared.out is None and not shared.json:
        shared.out = Path("out") / f"{case.stem}_slip"
    shared.answer(
        given.name,
        lambda progress: slip_population(
            given,
            subjects=subjects,
            histories=steps,
            full_model=full_model,
            quick=shared.quick,
            progress=progress,
        ),
    )


@sharing(without=("processes",))
def compare(
    shared: Shared,
    paths: Annotated[
        list[Path],
        typer.Argument(metavar="A B [C ...]", help="Result folders or case files."),
    ],
) -> None:
    """Rank two to twelve results or cases by friction, with the probability of the order.

    Where the order is open it is computed under other fluids, angles and worn: what would tell.

    With --out: the soles side by side, one colour scale, maps of the differences. --set and
    --quick apply to case files.
    """
    from underfoot.compute.result import Result
    from underfoot.questions.comparison import check_paths
    from underfoot.questions.comparison import compare as compared

    check_paths(paths)
    items = [Result.load(path) if path.is_dir() else shared.case(path) for path in paths]
    known = catalogue_for(shared.catalogue)
    shared.answer(
        " and ".join(item.name for item in items),
        lambda progress: compared(
            *items, quick=shared.quick, catalogue=known, separate=True, progress=progress
        ),
    )


@sharing(quick=True)
def sensitivity(shared: Shared, case: CasePath) -> None:
    """Vary the assumed inputs of a case one at a time and show the effect on its results.

    Two runs an input, each kept on disk: a second call answers at once, a stopped one continues.
    """
    from underfoot.questions.sensitivity import sensitivity as effects

    shared.ask(shared.case(case), effects)


@sharing(quick=True)
def risk(
    shared: Shared,
    case: CasePath,
    target: Annotated[
        str, typer.Option("--target", help="Slip probability to aim at, as 5 % or 0.05.")
    ] = "5 %",
) -> None:
    """Predict the slip probability, what limits the friction and the effect of changes.

    Every change (tread, compound, floor, cleaning, shorter steps) is simulated, on the coarse grid
    unless --full.
    """
    from underfoot.core import to_si
    from underfoot.questions.risk import risk_assessment

    share = to_si(target, "1", where="--target")
    shared.ask(shared.case(case), risk_assessment, target=share)


@sharing(quick=True)
def wear(
    shared: Shared,
    case: CasePath,
    mode: Annotated[
        str | None,
        typer.Option(
            "--mode",
            help="walk (cut by the floor at the angles of landing; the default), archard (pressure "
            "times sliding), plane or patch.",
        ),
    ] = None,
    steps: Annotated[int, typer.Option("--steps", help="Worn states to compute.", min=2)] = 6,
    limit: Annotated[
        str, typer.Option("--limit", help='Fluid load that counts as worn out: "5 N" or "20 %".')
    ] = "5 N",
    to: Annotated[
        str | None,
        typer.Option("--to", help='Last state: "2 mm" lost, or "1500 mm^2" of patch.'),
    ] = None,
    band: Annotated[
        bool, typer.Option("--band/--no-band", help="Vary the least known inputs (4 runs a state).")
    ] = True,
    pair: Annotated[
        str | None,
        typer.Option(
            "--worn-pair",
            help='A pair you measured, "1.2 mm after 300 km" or "after 5 months".',
        ),
    ] = None,
    seed: Annotated[int, typer.Option("--seed", help="Seed of the interval's draws.", min=0)] = 0,
) -> None:
    """Wear the sole of a case step by step: friction, film, and when it is worn out.

    Every state is kept on disk: a stopped series continues.
    """
    from underfoot.questions.walked import worn_pair
    from underfoot.questions.wear import deepest_wear, limit_load, wear_mode, wear_series

    given = shared.case(case)
    chosen = wear_mode(mode, given)
    shared.ask(
        given,
        wear_series,
        mode=chosen,
        steps=steps,
        deepest=deepest_wear(to, chosen),
        limit=limit_load(limit, given.motion.normal_force),
        band=band,
        seed=seed,
        pair=worn_pair(pair),
    )


@sharing()
def by_method(
    shared: Shared,
    case: CasePath,
    method: Annotated[
        str,
        typer.Option(
            "--method",
            help="iso13287 or astmf2913 (heel; iso13287-forepart, iso13287-flat: whole soles), "
            "slip-prediction-13-deg, report-slip-tester, report-whole-shoe or a set-up of the "
            "catalogue.",
        ),
    ] = "iso13287",
    keep: Annotated[
        list[str] | None,
        typer.Option(
            "--keep",
            help="Keep a part of the case against the method: floor, contaminant, normal_force, "
            "shoe_angle or speed; may be repeated.",
        ),
    ] = None,
) -> None:
    """Predict a standard test method: COF of the shoe, or a machine's reading of the floor.

    Angle, load, speed, floor, contaminant and averaging window are the method's, each listed with
    its source. With --quick the uncertainty is that of the friction law alone.
    """
    from underfoot.questions.method import method_prediction

    shared.ask(
        shared.case(case),
        method_prediction,
        method=method,
        keep=keep or (),
        with_band=not shared.quick,
    )
