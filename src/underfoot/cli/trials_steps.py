"""``underfoot trials edit``, ``definitions`` and ``export``: steps looked at and set by hand."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from .guard import say
from .options import Overwrite, optional

if TYPE_CHECKING:
    from underfoot.trials.walking.gait import RequiredFriction

ProfilePath = Annotated[
    Path | None,
    optional("Profile (TOML) of columns, axes and heels; else profile.toml in the folder."),
]


def edit(
    file: Annotated[Path, typer.Argument(help="Recording with force plates.")],
    reason: Annotated[str, optional("Why; it goes to the edit log.")],
    step: Annotated[
        str, optional('Number of the step as `describe` prints it, or a time in it, as "3.1 s".')
    ],
    contact: Annotated[str | None, optional('New time of contact, as "3.060 s".')] = None,
    toe_off: Annotated[str | None, optional('New time of toe off, as "3.65 s".')] = None,
    side: Annotated[str | None, optional("left or right.")] = None,
    plate: Annotated[str | None, optional('The plate the step is on, as "plate 2".')] = None,
    exclude: Annotated[bool, typer.Option("--exclude", help="Leave the step out.")] = False,
    profile: ProfilePath = None,
) -> None:
    """Set an event by hand: old and new number are shown, and edits.csv beside FILE keeps it.

    An edit that names no step, changes nothing or contradicts another is refused.
    """
    from underfoot.core import InputError
    from underfoot.trials.readers import read_trial
    from underfoot.trials.study.conditions import profile_of
    from underfoot.trials.study.edit_table import (
        edit_from,
        edit_text,
        edits_of,
        with_edit_row,
        write_edit_text,
    )
    from underfoot.trials.walking.gait import required_frictions
    from underfoot.trials.walking.walkway import walkway_of

    given = {"contact": contact, "toe off": toe_off, "side": side, "plate": plate}
    changes = [(what, value) for what, value in given.items() if value is not None]
    if exclude:
        changes.append(("exclude", ""))
    if len(changes) != 1:
        raise InputError(
            f"{len(changes)} changes at once",
            where="trials edit",
            allowed="one of --contact, --toe-off, --side, --plate, --exclude",
        )
    what, value = changes[0]
    read, _ = profile_of(file.parent, profile)
    trial = read_trial(file, read)
    text = edit_text(file.parent)
    new = edit_from(step, what, value, reason, "this edit")
    earlier = edits_of(file.parent, [file.name], others=True).get(file.name, [])
    walk = walkway_of(trial, vertical=read.vertical, walking=read.walking, landmarks=read.landmarks)
    before, after = (
        required_frictions(replace(walk, trial=trial.with_edits(*edits)))
        for edits in (earlier, [*earlier, new])
    )
    for old, changed in zip(before, after, strict=True):
        if old.stance.by_hand != changed.stance.by_hand:
            print(f"{old.stance.label}: {_step_text(old)} -> {_step_text(changed)}")
    write_edit_text(file.parent, with_edit_row(text, (file.name, step, what, value, reason)))
    say(f"written to {file.parent / 'edits.csv'}")


def _step_text(step: RequiredFriction) -> str:
    stance, value = step.stance, step.measurement.value
    number = f"RCOF {value:.4f}" if value is not None else step.measurement.reason
    return f"{stance.side}, {stance.contact:.4f} to {stance.toe_off:.4f} s, {number}"


def definitions(
    folder: Annotated[Path, typer.Argument(help="Folder of walking trials.")],
    out: Annotated[Path | None, optional("Folder for both tables (CSV).")] = None,
    profile: ProfilePath = None,
    overwrite: Overwrite = False,
) -> None:
    """Show the RCOF of a folder under every definition: what the choice does to the numbers."""
    from underfoot.core.files import whole_folder
    from underfoot.core.progress import bar
    from underfoot.trials.pages.report import csv_text
    from underfoot.trials.study.definitions import definition_tables

    with bar("reading trials") as progress:
        summary, steps = definition_tables(folder, profile=profile, progress=progress)
    print(f"{'definition':<20} {'steps':>5} {'mean':>7} {'SD':>7} {'change':>8} {'largest':>8}")
    for name, count, *numbers, _ in summary.rows:
        cells = ["–" if n is None else f"{n:.4f}" for n in numbers]
        print(f"{name:<20} {count:>5} {cells[0]:>7} {cells[1]:>7} {cells[2]:>8} {cells[3]:>8}")
    for note in (*summary.notes, *steps.notes):
        say(f"note: {note}")
    if out is not None:
        with whole_folder(out, overwrite=overwrite) as made:
            for table in (summary, steps):
                (made / f"{table.name}.csv").write_text(csv_text(table), encoding="utf-8")


def export(
    file: Annotated[Path, typer.Argument(help="Recording.")],
    out: Annotated[Path, optional("File to write: .c3d, .trc (markers), .mot or .sto (forces).")],
    companion: Annotated[
        Path | None, optional("Second file of the same recording.", "--with")
    ] = None,
    profile: ProfilePath = None,
) -> None:
    """Write a recording as C3D with the contacts found as events, or as TRC or MOT of OpenSim."""
    from underfoot.core import InputError
    from underfoot.trials.readers import TrialsProfile, read_profile, read_trial
    from underfoot.trials.recording.trial import join_trials
    from underfoot.trials.study.export import c3d_with_events, mot_text, trc_text
    from underfoot.trials.walking.events import stances
    from underfoot.trials.walking.walkway import walkway_of

    if out.exists():
        raise InputError(f"{out} is there already", where="--out", remedy="Choose another name")
    kind = out.suffix.casefold()
    if kind not in (".c3d", ".trc", ".mot", ".sto"):
        raise InputError(f'"{out.suffix}" is no format of an export', where="--out",
                         allowed=".c3d, .trc, .mot, .sto")  # fmt: skip
    read = read_profile(profile) if profile else TrialsProfile()
    trial = read_trial(file, read)
    if companion is not None:
        trial = join_trials(trial, read_trial(companion, read))
    if kind != ".c3d":
        made = trc_text(trial) if kind == ".trc" else mot_text(trial)
        out.write_text(made, encoding="utf-8")
        say(f"{out} is written, y up")
        return
    walk = walkway_of(trial, vertical=read.vertical, walking=read.walking, landmarks=read.landmarks)
    found = stances(walk)
    out.write_bytes(c3d_with_events(trial, found))
    count = sum(s.accepted for s in found)
    say(f"{count} {'step' if count == 1 else 'steps'} as events in {out}")
