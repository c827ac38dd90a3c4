"""Studies of which files are missing at random, of few persons or of one level: each finding.

Of ``underfoot.trials.study.boundary``, ``underfoot.trials.study.field_statistics``,
``underfoot.trials.study.study_tests``, ``underfoot.trials.study.tables``.
"""

from dataclasses import replace

import numpy as np
import pytest
from test_trials_study_results import STUDIES, lines_of, protocol

import trial_studies as made
from snapshot import held
from underfoot.trials.pages.report import lead_sentence
from underfoot.trials.study.folder import FolderAnalysis
from underfoot.trials.study.methods import methods_paragraphs
from underfoot.trials.study.study import study_of
from underfoot.trials.study.study_guard import guarded_files, study_doubts

CASES = {
    "gait, one trial": ("gait", lambda: made.gait_files(6, 1, seed=22), 0.0, {"equivalence": 0.2}),
    "gait, two persons": ("gait", lambda: made.gait_files(2, 3, seed=23), 0.1, {}),
    "slips, three soles": (
        "slips", lambda: made.slip_files(4, seed=25, outsoles=("hard", "soft", "worn")), 0.0, {}
    ),
    "treads": ("treads", lambda: made.slip_files(4, seed=26), 0.2, {}),
    "pins": ("pins", lambda: made.pin_files(seed=27), 0.25, {}),
    "boundary": ("boundary", lambda: made.boundary_files(seed=28), 0.3, {}),
    "slides": ("slides", lambda: made.slide_files(seed=29), 0.2, {"equivalence": 0.05}),
    "blocks": ("blocks", lambda: made.relaxation_files(), 0.2, {}),
}  # fmt: skip


def of_table(table, cautions=()):
    lines = lines_of(table, cautions)
    return [table.title, len(lines), *lines[:6], lines[-1], *table.notes]


@pytest.mark.parametrize("name", CASES)
def test_uneven_studies(file_regression, name):
    kind, make, lost, settings = CASES[name]
    way, *_ = STUDIES[kind]
    chosen = protocol(way).with_settings(settings)
    rng = np.random.default_rng(len(name))
    files = [one for one in make() if rng.random() >= lost]
    # one without a condition and one with a number less
    first, second, *rest = files
    conditions = dict(list(first.conditions.items())[:-1])
    files = [replace(first, conditions=conditions), replace(second, numbers=second.numbers[:-1])]
    files, doubts = guarded_files([[one] for one in [*files, *rest]])
    doubts += study_doubts(files, chosen)
    study = study_of(files, chosen)
    methods = methods_paragraphs(files, chosen, study, "0.0")
    whole = FolderAnalysis(chosen, tuple(files), study, tuple(methods), (), tuple(doubts))
    held(file_regression, {
        "tables": {t.name: of_table(t) for t in study.tables},
        "findings": {f.name: [*of_table(f.table, f.cautions), f.marks, f.outcome]
                     for f in study.findings},
        "curves": {key: len(each) for key, each in study.curves.items()}, "notes": study.notes,
        "lead": lead_sentence(whole), "doubts": [str(one) for one in doubts],
    }, f"uneven {name}")  # fmt: skip
