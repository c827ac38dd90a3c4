"""RCOF of a folder under every definition: what the choice does to the numbers."""

from collections.abc import Sequence
from functools import reduce
from pathlib import Path

import numpy as np

from underfoot.core import Progress, UnderfootError, silent

from ..readers import TrialsProfile, read_trials
from ..recording.trial import Trial, join_trials
from ..walking.events import EditError
from ..walking.gait import DEFINITIONS, required_friction, required_frictions
from ..walking.walkway import walkway_of
from .conditions import profile_of, study_folder
from .edit_table import edits_of
from .tables import Cell, TrialTable, mean_and_interval, plain_columns


def definition_tables(
    folder: Path, *, profile: Path | None = None, progress: Progress = silent
) -> tuple[TrialTable, TrialTable]:
    """Return RCOF under all ``DEFINITIONS``: one row a definition, and one row a step.

    Files that can't be read are named in the notes; edits by hand are applied. A folder without
    trials, a wrong profile and a wrong edit are an `InputError`.
    """
    folder = Path(folder)
    read, _ = profile_of(folder, profile)
    recordings = study_folder(folder).recordings
    edits = edits_of(folder, [recording.name for recording in recordings])
    rows: list[tuple[Cell, ...]] = []
    notes = []
    for number, recording in enumerate(recordings, start=1):
        try:
            trial = reduce(join_trials, (read_trials(file, read)[0] for file in recording.paths))
            trial = trial.with_edits(*edits.get(recording.name, []))
            rows += [(recording.name, *row) for row in _steps(trial, read)]
        except EditError:
            raise
        except UnderfootError as error:
            notes.append(f"{recording.name}: {error}")
        progress("reading trials", number / len(recordings))
    title = "RCOF of every step under every definition"
    heads = ("file", "step", "verdict", *plain_columns(*DEFINITIONS, decimals=4))
    steps = TrialTable.of("definitions_steps", title, heads, rows, *notes)
    return _summary(rows), steps


def _steps(trial: Trial, profile: TrialsProfile) -> list[tuple[Cell, ...]]:
    walk = walkway_of(
        trial, vertical=profile.vertical, walking=profile.walking, landmarks=profile.landmarks
    )
    rows: list[tuple[Cell, ...]] = []
    for step in required_frictions(walk):
        if step.measurement.value is None:
            continue
        values = [
            required_friction(walk, step.stance, definition, checked=False)
            for definition in DEFINITIONS.values()
        ]
        rows.append((step.stance.label, step.verdict, *(v.measurement.value for v in values)))
    return rows


def _summary(rows: Sequence[tuple[Cell, ...]]) -> TrialTable:
    values = np.array([row[3:] for row in rows], dtype=float).reshape(len(rows), len(DEFINITIONS))
    out: list[tuple[Cell, ...]] = []
    for i, (name, definition) in enumerate(DEFINITIONS.items()):
        known = np.isfinite(values[:, i])
        numbers = values[known, i]
        change = numbers - values[known, 0]
        mean, spread, *_ = mean_and_interval(numbers, "rcof")
        changes = (
            (float(change.mean()), float(np.abs(change).max())) if len(change) else (None,) * 2
        )
        choices = "; ".join(definition.conventions().values())
        out.append((name, len(numbers), mean, spread, *changes, choices))
    numbers = plain_columns("mean RCOF", "SD", "mean change", "largest change", decimals=4)
    note = "Change: step by step against the default. SD is the standard deviation between steps."
    heads = ("definition", "steps", *numbers, "choices")
    return TrialTable.of("definitions", "RCOF under every definition", heads, out, note)
