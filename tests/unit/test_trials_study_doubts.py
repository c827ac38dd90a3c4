"""What a study says against itself: speed, order, bodies, names, labels; sound studies say none."""

from dataclasses import replace

import numpy as np
import pytest

from underfoot.core import InputError
from underfoot.trials.recording.protocols import protocol
from underfoot.trials.statistics import drift
from underfoot.trials.study import analyse_folder
from underfoot.trials.study.body_doubts import one_body
from underfoot.trials.study.conditions import conditions_of
from underfoot.trials.study.file_result import FileResult, Number, StepResult
from underfoot.trials.study.person_measures import FORCE, HEIGHT
from underfoot.trials.study.study import study_of
from underfoot.trials.study.study_guard import (
    _same_in_another_order,
    _sides_as_persons,
    guarded_files,
    study_doubts,
)
from underfoot.trials.study.study_tests import comparison_findings

PERSONS, SHOES, TRIALS = 8, {"hard": 0.20, "medium": 0.22, "soft": 0.25}, 4


def study(change=lambda conditions, speed: (conditions, speed), seed=1, bodies=None):
    """A sound study of eight persons in three shoes, blocks in a random order, then changed."""
    rng = np.random.default_rng(seed)
    files = []
    for person in range(PERSONS):
        level, body = rng.normal(0, 0.02), rng.normal(0, 0.06, 5)
        body = body if bodies is None else bodies(person, body)
        for block, shoe in enumerate(rng.permutation(list(SHOES))):
            own = SHOES[shoe] + level + rng.normal(0, 0.003)
            for trial in range(TRIALS):
                rcof = own + rng.normal(0, 0.004)
                place = block * TRIALS + trial + 1
                conditions = {"subject": f"S{person:02d}", "shoe": str(shoe), "trial": float(place)}
                conditions, speed = change(conditions, 1.3 + rng.normal(0, 0.05))
                sizes = np.array([600, 1.0, 0.2, 0.25, 0.3]) * np.exp(body)
                sizes *= np.exp(rng.normal(0, [0.02, 0.004, 0.004, 0.004, 0.004]))
                names = (FORCE, HEIGHT, "A to B (m)", "A to C (m)", "B to D (m)")
                step = StepResult(rcof=rcof, walking_speed=speed, contact=0.1, peak_force=700.0)
                files.append(
                    FileResult(
                        f"S{person:02d}_{place:02d}.c3d",
                        numbers=(Number("rcof", rcof, main="rcof"),),
                        conditions=conditions,
                        steps=(step,),
                        body=dict(zip(names, map(float, sizes), strict=True)),
                    )
                )
    return files


def doubts(files):
    return [str(one) for one in study_doubts(files, protocol("level_walking"))]


def test_sound_studies_raise_no_doubt():
    said = [doubts(study(seed=seed)) for seed in range(12)]
    assert sum(map(len, said)) <= 1, said


def slower(conditions, speed):
    return conditions, speed * (0.8 if conditions["shoe"] == "soft" else 1.0)


def in_order(conditions, speed):
    first = list(SHOES).index(conditions["shoe"]) * TRIALS
    return {**conditions, "trial": first + 1 + (conditions["trial"] - 1) % TRIALS}, speed


def by_side(conditions, speed):
    side = "LR"[int(conditions["trial"]) % 2]
    return {**conditions, "subject": conditions["subject"] + side}, speed


def words(conditions, speed):
    floor = "hard wet" if conditions["subject"] != "S03" else "wet hard"
    return {**conditions, "floor": floor}, speed


def exchanged(conditions, speed):
    if conditions["subject"] == "S03":
        other = {"hard": "soft", "soft": "hard"}
        conditions = {**conditions, "shoe": other.get(conditions["shoe"], "medium")}
    return conditions, speed


def mislabelled(conditions, speed):
    if (
        conditions["subject"] == "S02"
        and conditions["shoe"] == "soft"
        and conditions["trial"] % 4 == 1
    ):
        conditions = {**conditions, "shoe": "hard"}
    return conditions, speed


def dated(conditions, speed):
    return {**conditions, "date": "2026-03-" + {"hard": "01", "medium": "02", "soft": "03"}[
        conditions["shoe"]]}, speed  # fmt: skip


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (slower, '"soft" at 1.0'), (in_order, '"hard" was walked early'),
        (by_side, "noted twice, by side"), (words, "are the same words"),
        (exchanged, "S03 has"), (mislabelled, 'reads as "soft" of S02'),
        (dated, '"date" can\'t be told from "shoe"'),
    ],
)  # fmt: skip
def test_what_goes_with_a_condition_is_a_doubt(change, told):
    assert any(told in text for text in doubts(study(change))), doubts(study(change))


def test_one_body_under_two_names_is_a_doubt():
    first = {}

    def twice(person, body):
        first.setdefault("body", body)
        return first["body"] if person == 5 else body

    said = doubts(study(bodies=twice))
    assert any("S00 and S05 have one body" in text for text in said), said


def small_study(persons, measures, trials, seed, twins=False, plates=False):
    """Files of a few persons by how far their bodies and trials scatter in recordings."""
    rng = np.random.default_rng(seed)
    names = (FORCE, HEIGHT, *(f"{a} to {b} (m)" for a, b in ("AB", "AC", "BD", "CD", "EF", "EG")))
    sizes, files = rng.normal(0, 0.04, persons), []
    bodies = sizes[:, None] + rng.normal(0, 0.035, (persons, len(names)))
    bodies[:, 0] += sizes + rng.normal(0, 0.14, persons)
    if plates:  # markers on a plate are as far apart on everybody
        bodies[:, 2:] = 0.0
    if twins:
        bodies[1] = bodies[0]
    for person, body in enumerate(bodies):
        for trial in range(trials):
            noise = rng.normal(0, [0.015, *[0.003] * (len(names) - 1)])
            measured = [600, 1.7, *[0.25] * (len(names) - 2)] * np.exp(body + noise)
            files.append(
                FileResult(
                    f"{person}_{trial}.c3d",
                    conditions={"subject": f"S{person}"},
                    body=dict(zip(names[:measures], measured.tolist(), strict=False)),
                )
            )
    return files


@pytest.mark.parametrize(
    ("measures", "trials", "least", "persons"),
    [
        *((3, 2, 0.6, persons) for persons in (2, 3, 4, 6)),
        *((3, 4, 0.75, persons) for persons in (2, 6)),
        *((4, 6, 0.8, persons) for persons in (2, 4)),
        *((5, 2, 0.8, persons) for persons in (3, 6)),
        *((8, 2, 0.8, persons) for persons in (2, 6)),
    ],
)
def test_one_body_of_a_few_persons_is_told_and_two_bodies_are_not(persons, measures, trials, least):
    """Of 60 studies with one body under two names this share at least, of 120 without none or one.

    Bounds of three measures: those of 150 other studies less two standard errors of 60.
    """

    def share(**how):
        studies = (small_study(persons, measures, trials, seed, **how) for seed in range(60))
        return np.mean([any(one_body(files, "subject")) for files in studies])

    assert share(twins=True) >= least
    assert share() + share(plates=True) <= 1 / 60 + 1e-9


@pytest.mark.parametrize(
    ("first", "second", "told"),
    [
        ("hard wet", "wet hard", True), ("hard_wet", "wet_hard", True),
        ("hard 2 wet", "wet hard 2", True), ("10 cP glycerol", "glycerol 10 cP", True),
        ("shoe 1 floor 2", "floor 2 shoe 1", True), ("shoe 1 floor 2", "shoe 2 floor 1", False),
        ("oil 5 water 10", "oil 10 water 5", False), ("A1 B2", "A2 B1", False),
        ("2026-03-01", "2026-01-03", False), ("ramp up 5", "ramp up -5", False),
        ("W 10", "10 W", False), ("hard wet", "hard_wet", False),
    ],
)  # fmt: skip
def test_numbers_stay_with_their_words(first, second, told):
    assert _same_in_another_order(first, second) == told


def test_an_order_of_shoes_is_no_exchange():
    def counterbalanced(conditions, speed):
        first = int(conditions["subject"][1:]) % 2
        return {**conditions, "order": ("hard soft", "soft hard")[first]}, speed

    files = study(counterbalanced)
    assert not any("same words" in text for text in doubts(files))


@pytest.mark.parametrize(
    ("names", "told"),
    [
        (("S01L", "S01R"), True), (("S01L", "S01R", "S02", "S03", "S04", "S05"), True),
        (("Anna left", "Anna right", "Ben", "Cem", "Dee"), True), (("S01_L", "S01_R", "S2"), True),
        (("1d", "1g", "2d", "2g"), True), (("ML", "MR", "AL", "AR"), True),
        (("ML", "MR"), False), (("ML", "MR", "AB", "CD"), False), (("Emil", "Emir"), False),
        (("S1a", "S1b", "S1d", "S1g"), False), (tuple(f"S1{c}" for c in "klmnopqrs"), False),
    ],
)  # fmt: skip
def test_sides_of_one_person_are_told_from_initials(names, told):
    files = [FileResult(f"{who}.c3d", conditions={"subject": who}) for who in names]
    assert any(_sides_as_persons(files, "subject")) == told


def test_speed_and_order_stand_in_a_table():
    tables = {
        table.name: table for table in study_of(study(slower), protocol("level_walking")).tables
    }
    rows = {row[1]: row for row in tables["speed_and_order"].rows}
    assert rows["soft"][2] == pytest.approx(0.8 * 1.3, abs=0.03)
    assert rows["hard"][2] == pytest.approx(1.3, abs=0.03)
    assert np.mean([row[4] for row in rows.values()]) == pytest.approx(50, abs=1)


def test_a_column_that_says_the_same_ends_nothing():
    """A date a shoe, a brand, a group that wore some shoes, initials of the persons."""
    files = study()
    values = [one.main["rcof"] for one in files]
    persons = [one.conditions["subject"] for one in files]
    shoe = [one.conditions["shoe"] for one in files]
    alone = comparison_findings("rcof", values, {"shoe": shoe}, persons)
    for column in (
        [dict(zip(SHOES, "123", strict=True))[one] for one in shoe],
        [dict(zip(SHOES, "xxy", strict=True))[one] for one in shoe],
        persons,
    ):
        found = comparison_findings("rcof", values, {"shoe": shoe, "other": column}, persons)
        assert [one.name for one in found] == [one.name for one in alone]
        assert found[0].table.rows == alone[0].table.rows
        told = [*found[0].cautions, *map(str, found[0].table.notes)]
        assert any(text.startswith(('"other"', "other:")) for text in told)
    group = ["m" if who < "S04" else "w" for who in persons]
    some = [
        i for i, one in enumerate(shoe) if one == "medium" or (one == "hard") == (group[i] == "m")
    ]
    found = comparison_findings(
        "rcof", [values[i] for i in some],
        {"shoe": [shoe[i] for i in some], "group": [group[i] for i in some]},
        [persons[i] for i in some],
    )  # fmt: skip
    mixed = next(one for one in found if one.name == "mixed_rcof")
    assert {row[0] for row in mixed.table.rows} == {"shoe", "group"}


@pytest.mark.parametrize(
    ("heading", "cells", "allowed"),
    [
        ("acof", ("21", "24"), "0 to 3"), ("rcof", ("0.2", "-0.2"), "0 to 3"),
        ("PTV", ("36", "360"), "0 to 150"), ("ramp angle", ("12", "120"), "-45 to 45 deg"),
    ],
)  # fmt: skip
def test_impossible_friction_in_a_table_of_conditions_is_refused(tmp_path, heading, cells, allowed):
    table = tmp_path / "conditions.csv"
    table.write_text(f"file,{heading}\na.c3d,{cells[0]}\nb.c3d,{cells[1]}\n")
    with pytest.raises(InputError) as error:
        conditions_of(tmp_path)
    assert allowed in str(error.value)


def test_units_of_friction_and_scales_are_known(tmp_path):
    table = tmp_path / "conditions.csv"
    table.write_text("file,acof (%),hardness (Shore A),ramp angle (deg)\na.c3d,21,67,18\n")
    noted = conditions_of(tmp_path)["a.c3d"]
    assert noted["acof"] == pytest.approx(0.21)
    assert noted["hardness"] == 67
    assert noted["ramp angle"] == pytest.approx(np.radians(18))


def readings(tmp_path, name, text):
    (tmp_path / "table.csv").write_text(text)
    return analyse_folder(tmp_path, protocol(name), processes=1)


def test_a_tile_has_one_class_of_all_who_walked_on_it(tmp_path):
    rows = "".join(
        f"tile,{who},{a}\n" for who, a in (("A", 19.2), ("A", 18.9), ("B", 18.9), ("B", 18.8))
    )
    found = readings(tmp_path, "en_16165_shod_ramp", "sample,operator,angle (deg)\n" + rows)
    tables = {table.name: table for table in found.study.tables}
    assert "class" not in tables["samples"].columns
    (row,) = tables["walkers"].rows
    told = dict(zip(tables["walkers"].columns, row, strict=True))
    assert (told["class"], told["2 u reaches"]) == ("R10", "R11")
    assert told["angle (deg)"] == pytest.approx(18.95)
    alone = readings(
        tmp_path, "en_16165_shod_ramp", "sample,operator,angle (deg)\ntile,A,20\ntile,A,21\n"
    )
    (row,) = next(table for table in alone.study.tables if table.name == "walkers").rows
    assert "1 of 2" in row


def test_boards_correct_the_angles_of_their_walkers(tmp_path):
    rows = [("tile", "A", "", a) for a in (19.4, 19.5, 19.6)]
    rows += [("tile", "B", "", a) for a in (18.6, 18.7, 18.8)]
    # A reads 0.8 deg too high on the lower board and 1.2 on the upper, B right on both
    for standard, off in ((8.7, 0.8), (27.3, 1.2)):
        rows += [(f"board {standard}", "A", standard, standard + off + e) for e in (-0.1, 0, 0.1)]
        rows += [(f"board {standard}", "B", standard, standard + e) for e in (-0.1, 0, 0.1)]
    head = "sample,operator,standard angle (deg),angle (deg)\n"
    text = head + "".join(",".join(map(str, row)) + "\n" for row in rows)
    found = readings(tmp_path, "en_16165_shod_ramp", text)
    (table,) = (one for one in found.study.tables if one.name == "walkers")
    told = [dict(zip(table.columns, row, strict=True)) for row in table.rows]
    assert [one["sample"] for one in told] == ["tile"]  # boards are no samples
    off = 0.8 + 0.4 * (19.5 - 9.5) / (28.5 - 9.5)
    assert told[0]["angle (deg)"] == pytest.approx((19.5 - 0.5 * off + 18.7) / 2)
    assert told[0]["class"] == "R10"  # 19.1 as read: R11
    lone = [line for line in text.splitlines() if not (line.startswith("board") and ",B," in line)]
    found = readings(tmp_path, "en_16165_shod_ramp", "\n".join(lone))
    (table,) = (one for one in found.study.tables if one.name == "walkers")
    assert dict(zip(table.columns, table.rows[0], strict=True))["angle (deg)"] == pytest.approx(
        19.1
    )
    (refused,) = readings(
        tmp_path, "en_16165_shod_ramp", text.replace("operator", "walked by")
    ).files
    assert not refused.usable
    assert "nobody walks" in " ".join(refused.reasons)


@pytest.mark.parametrize(
    ("values", "told"),
    [
        ((0.120, 0.108, 0.096, 0.084), True), ((0.120, 0.132, 0.144, 0.1561), True),
        ((0.120, 0.119, 0.121, 0.120), False), ((0.12, 0.12, 0.12, 0.12), False),
        ((0.120, 0.1203, 0.1206, 0.1209), False),
    ],
)  # fmt: skip
def test_readings_that_rise_or_fall_are_said(values, told):
    assert (drift(values) is not None) == told
    files = [
        FileResult(
            f"run_{i}.csv",
            numbers=(Number("cof", value, main="cof"),),
            conditions={"shoe": "A", "floor": "tile"},
        )
        for i, value in enumerate(values)
    ]
    said = [str(one) for one in study_doubts(files[::-1], protocol("en_iso_13287"))]
    assert any("from the first run to the last" in text for text in said) == told


def test_scatter_is_no_drift():
    rng = np.random.default_rng(3)
    assert np.mean([drift(rng.normal(0.2, 0.02, 5)) is not None for _ in range(2000)]) < 0.02


def test_one_recording_under_many_names_is_one_doubt():
    """Of 48 files of the same bytes each pair was a doubt of its own."""
    names = [f"f{n:02d}.c3d" for n in range(12)]
    values = {"peak": 700.123, "mean": 500.456, "rcof": 0.1987}
    numbers = tuple(Number(name, value, fact=name) for name, value in values.items())
    same = [[FileResult(name, "abc", numbers=numbers, conditions={"shoe": str(n % 2)})]
            for n, name in enumerate(names)]  # fmt: skip
    files, doubts = guarded_files(same)
    (doubt,) = doubts
    assert doubt.files == tuple(names)
    assert "the same bytes, noted differently" in doubt.message
    assert {one.verdict for one in files} == {"refused"}
    assert max(len(one.reasons[0]) for one in files) < 120
    # numbers join what bytes don't: one group, of the weaker kind
    joined = [*same[:2], [FileResult("x.c3d", "other", numbers=numbers, conditions={"shoe": "0"})]]
    (doubt,) = guarded_files(joined)[1]
    assert doubt.files == ("f00.c3d", "f01.c3d", "x.c3d")
    assert "the same numbers" in doubt.message


def test_half_of_the_persons_in_a_shoe_is_no_crowd():
    """Two persons with thirty conditions: the others have "0.5 with each"."""
    cells = [(n % 2, n % 15) for n in range(24)]
    files = [
        FileResult(f"{n}.c3d", numbers=(Number("rcof", 0.2, main="rcof"),),
                   conditions={"subject": f"S{who}", "shoe": f"shoe {shoe}"})
        for n, (who, shoe) in enumerate(cells)
    ]  # fmt: skip
    doubts = study_doubts(files, protocol("level_walking"))
    assert not [one for one in doubts if "and none with" in str(one)]


def test_a_trial_without_friction_or_person_is_no_doubt_and_hides_none():
    files = study(mislabelled)
    rest = [
        replace(files[5], numbers=()),
        replace(files[6], numbers=(Number("rcof", 0.0, main="rcof"),)),
        replace(files[7], conditions={"shoe": "soft"}),
    ]
    said = doubts([*files, *(replace(one, file=f"rest {k}") for k, one in enumerate(rest))])
    labels = [line for line in said if "another label" in line]
    assert [line for line in labels if 'reads as "soft" of S02' in line]
    assert not [line for line in labels if "rest " in line]
