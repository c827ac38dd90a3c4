"""Doubts about the files of a study: each limit just below and just above, and who is named."""

import numpy as np
import pytest

from underfoot.trials.recording.protocols import protocol
from underfoot.trials.study import body_doubts
from underfoot.trials.study import study_guard as guard
from underfoot.trials.study.doubt import Doubt, doubt_table
from underfoot.trials.study.file_result import FileResult, Number, StepResult
from underfoot.trials.study.person_measures import FORCE, HEIGHT
from underfoot.trials.study.study_guard import guarded_files

WALK, TESTER = protocol("level_walking"), protocol("en_iso_13287")


def file(name, main=None, body=None, steps=(), checksum="", **conditions):
    """A usable file with a few numbers."""
    numbers = tuple(Number(key, value, main=key) for key, value in (main or {}).items())
    named = {key.replace("_", " "): value for key, value in conditions.items()}
    return FileResult(name, numbers=numbers, conditions=named, steps=tuple(steps), body=body or {},
                      checksum=checksum)  # fmt: skip


def told(doubts):
    return [str(one) for one in doubts]


def test_a_doubt_names_four_files():
    one = Doubt("odd", ("a", "b", "c", "d"))
    assert str(one) == "odd (a, b, c, d)"
    five = Doubt("odd", ("a", "b", "c", "d", "e"), True)
    assert str(five) == "odd (a, b, c, d ...); left out"
    assert doubt_table([]) is None
    table = doubt_table([one, five])
    assert table is not None
    assert [row[1:3] for row in table.rows] == [("", 4), ("yes", 5)]


def test_a_condition_that_half_of_the_files_have_is_meant_for_all():
    for count, out in ((3, True), (2, False)):
        files = [file(f"f{n}", **({"shoe": "a"} if n < count else {})) for n in range(6)]
        (doubt,) = guard._incomplete(files)
        assert doubt.out == out
        assert doubt.files == tuple(f"f{n}" for n in (range(3, 6) if out else range(2)))
        assert f"for {count} of 6 files" in str(doubt)
        numbers = [file(f"f{n}", **({"age": 3.0} if n < count else {})) for n in range(6)]
        assert len([*guard._numbers_lacking(numbers)]) == out
    assert not [*guard._incomplete([file("a", shoe="x"), file("b", shoe="y")])]
    assert not [*guard._numbers_lacking([file("a", shoe="x"), file("b", shoe="y"), file("c")])]


def crowd(hard, soft, others=(2, 2), persons=4):
    files = [
        file(f"p{p} {shoe} {n}", person=f"P{p}", shoe=shoe)
        for p in range(1, persons)
        for shoe, count in zip(("hard", "soft"), others, strict=True)
        for n in range(count)
    ]
    own = [file(f"p0 {shoe} {n}", person="P0", shoe=shoe)
           for shoe, count in (("hard", hard), ("soft", soft)) for n in range(count)]  # fmt: skip
    return told(guard._crowded_levels(own + files, "person"))


def test_a_person_with_twice_the_trials_of_one_level_and_none_of_another():
    (doubt,) = crowd(4, 0)
    assert 'P0 has 4 trials with shoe "hard" and none with "soft": the others 2' in doubt
    assert "p0 hard 0, p0 hard 1, p0 hard 2, p0 hard 3" in doubt
    assert not crowd(3, 0)
    assert not crowd(4, 1)
    assert crowd(0, 4)
    assert not crowd(4, 0, persons=2)  # half of the persons wear one: a condition between persons
    assert crowd(4, 0, persons=3)


def test_a_trial_far_from_the_others_of_its_person():
    rng = np.random.default_rng(2)

    def files(change, count=8, scatter=0.01):
        logs = np.log(0.2) + scatter * rng.normal(size=count)
        logs[0] = np.log(0.2) + change
        return [file(f"f{n}", {"rcof": float(np.exp(v))}, person="a") for n, v in enumerate(logs)]

    for change, out in ((0.28, False), (0.33, True), (-0.33, True)):
        doubts = told(guard._unlike_trials(files(change), "person"))
        assert bool(doubts) == out
        if out:
            assert "f0" in doubts[0]
            assert f"{100 * np.expm1(change):+.0f}"[:2] in doubts[0]
    assert not told(guard._unlike_trials(files(0.5, 7), "person"))
    # six times the scatter of the others
    assert not told(guard._unlike_trials(files(0.6, 40, 0.12), "person"))
    assert told(guard._unlike_trials(files(1.2, 40, 0.12), "person"))


@pytest.mark.parametrize(
    ("a", "b", "slip"),
    [("vinyl", "vinyl", False), ("vinyl", "vinil", True), ("vinyl", "vinl", True),
     ("vinyl", "vinyyl", True), ("vinyl", "viynl", True), ("vinyl", "vyinl", False),
     ("vinyl", "vniyl", True),
     ("vinyl", "vi", False), ("vinyl", "finil", False), ("vinyl", "vlnyi", False),
     ("vinyl", "vinylx", True), ("vinyl", "vinylxx", False), ("vinyl", "xvinyl", True)],
)  # fmt: skip
def test_words_that_are_one_slip_of_the_finger_apart(a, b, slip):
    assert guard._one_slip(a, b) == guard._one_slip(b, a) == slip


def test_a_rare_level_one_letter_from_a_usual_one():
    def doubts(rare, count, usual="ceramic", many=6):
        files = [file(f"r{n}", floor=rare) for n in range(count)]
        files += [file(f"u{n}", floor=usual) for n in range(many)]
        return told(guard._near_names(files, "person"))

    (doubt,) = doubts("ceramik", 2)
    assert 'floor "ceramik" (2) is one letter from "ceramic" (6) (r0, r1)' in doubt
    assert not doubts("ceramik", 2, many=5)
    assert not doubts("ceramik", 1, many=2)
    assert doubts("ceramik", 1, many=3)
    assert not doubts("tie", 1, "tile")
    assert doubts("tils", 1, "tile")
    assert not doubts("tile1", 1, "tile2")


def test_one_trial_of_a_level_where_the_others_have_three():
    def doubts(*counts, key="shoe"):
        files = [
            file(f"{n} {k}", **{key: f"L{n}"})
            for n, count in enumerate(counts)
            for k in range(count)
        ]
        return told(guard._single_levels(files, "person"))

    assert doubts(1, 3, 3)
    assert not doubts(1, 2, 2)
    assert len(doubts(1, 1, 5, 5, 5)) == 2
    assert not doubts(1, 1, 5)
    assert not doubts(1, 3, 3, key="date")


def test_what_a_person_keeps():
    def doubts(key, first, second):
        files = [file("a", person="A", **{key: first}), file("b", person="A", **{key: second}),
                 file("c", person="B", **{key: 1.0})]  # fmt: skip
        return told(body_doubts.bodies_noted(files, "person"))

    assert not doubts("body mass", 70.0, 73.4)
    assert "body mass of A is noted as 70, 73.6" in doubts("body mass", 70.0, 73.6)[0]
    assert not doubts("height", 1.7, 1.733)
    assert doubts("height", 1.7, 1.735)
    assert doubts("body_height", 1.7, 1.735)
    assert doubts("sex", "f", "m")
    assert not doubts("sex", "f", "f")


def bodies(change, scatter=0.001, measure="A to B (m)", count=6, more=()):
    """Six recordings of one person whose last shows other measures, and of two others."""
    rng = np.random.default_rng(4)
    names = (measure, *more)
    files = []
    for p in range(3):
        for n in range(count):
            own = {name: (1.0 + 0.3 * p) * float(np.exp(scatter * rng.normal())) for name in names}
            if p == 0 and n == count - 1:
                own = dict.fromkeys(names, 1.0 + change)
            files.append(file(f"p{p} {n}", body=own, person=f"P{p}"))
    return told(body_doubts.bodies_measured(files, "person"))


def test_a_recording_that_shows_another_body():
    for measure, least, most in ((FORCE, 0.02, 0.10), (HEIGHT, 0.02, 0.04)):
        assert not bodies(0.9 * least, measure=measure)
        assert bodies(1.1 * least, measure=measure)
        assert any("p0 5" in one for one in bodies(1.3 * most, 0.001, measure))
    (force,) = bodies(0.03, measure=FORCE)
    assert "another person in the place of P0? mean force in stance +3 %" in force
    markers = ("B to C (m)", "C to D (m)")
    assert not bodies(0.03)  # one distance alone tells nothing
    (doubt,) = bodies(0.03, more=markers)
    assert "3 of 3 distances of markers" in doubt
    (near,) = bodies(0.305, measure=FORCE)
    assert "nearest P1" in near
    (far,) = bodies(0.34, measure=FORCE)
    assert "nearest" not in far


def plates(mean, scatter=0.02, count=8, key="rcof"):
    rng = np.random.default_rng(6)
    noise = rng.normal(size=count)
    noise = scatter * (noise - noise.mean()) / noise.std(ddof=1)
    files = []
    for n in range(count):
        usual = {"rcof": 0.2, "peak_force": 700.0}
        read = usual | {key: usual[key] * float(np.exp(mean + noise[n]))}
        steps = [StepResult(plate="one", **read), StepResult(plate="two", **usual)]
        files.append(file(f"f{n}", steps=steps))
    return told(guard._plates_apart(files))


def test_two_plates_that_read_differently():
    assert not plates(0.079)
    (doubt,) = plates(0.081)
    assert "RCOF is +8 % on one against two in 8 recordings" in doubt
    assert "RCOF is -8 %" in plates(-0.081)[0]
    assert not plates(0.081, count=7)
    # four standard errors of eight recordings
    assert not plates(0.1, scatter=0.1 / 3.9 * 8**0.5)
    assert plates(0.1, scatter=0.1 / 4.1 * 8**0.5)
    assert not plates(0.039, key="peak_force")
    assert "peak of the normal force is +4 %" in plates(0.041, key="peak_force")[0]


def repeats(last, count=5, scatter=0.0):
    values = [0.3 + scatter * (-1) ** n for n in range(count - 1)] + [last]
    files = [file(f"f{n}", {"cof": v}, shoe="a", floor="b") for n, v in enumerate(values)]
    return told(guard._repeats(files, TESTER))


def test_a_repeat_far_from_the_others():
    assert not repeats(0.344)
    (doubt,) = repeats(0.346)
    assert "COF 0.346 against 0.300 of the other repeats" in doubt
    assert repeats(0.254)
    assert not repeats(0.256)
    assert not repeats(0.4, 3)
    assert repeats(0.4, 4)
    # six times 1.4826 of the median deviation, 10 mCOF
    assert not repeats(0.31 + 0.08, 6, 0.01)
    assert repeats(0.31 + 0.14, 6, 0.01)


def turned(own, spread=0.01, persons=6):
    """Five persons with a difference of 0.2 of two shoes, and one with another."""
    rng = np.random.default_rng(8)
    noise = rng.normal(size=persons - 1)
    noise = spread * (noise - noise.mean()) / noise.std(ddof=1)
    files = []
    for p, change in enumerate([own, *(0.2 + noise)]):
        for shoe, value in (("hard", 0.2), ("soft", 0.2 * float(np.exp(-change)))):
            files += [
                file(f"p{p} {shoe} {n}", {"rcof": value}, person=f"P{p}", shoe=shoe) for n in (1, 2)
            ]
    return told(guard._levels_exchanged(files, "person"))


def test_a_person_whose_levels_are_the_other_way_round():
    (doubt,) = turned(-0.2)
    assert 'P0 has "hard" and "soft" (shoe) the other way round' in doubt
    assert "p0 hard 1" in doubt
    assert turned(-0.171)
    assert not turned(-0.169)
    assert not turned(-0.231)
    assert not turned(-0.2, 0.051)
    assert turned(-0.2, 0.049)
    assert not turned(-0.2, persons=5 - 1)
    assert turned(-0.2, persons=5)


def mislabelled(value, *, same=3):
    """One trial of the first person's hard shoe reads otherwise; all else scatters by 0.01."""
    files, rng = [], np.random.default_rng(9)
    for p in range(4):
        for shoe, level in (("hard", 0.2), ("soft", 0.25)):
            for n in range(same):
                rcof = level * float(np.exp(0.01 * (-1, 0, 1)[n % 3]))
                if (p, shoe, n) == (0, "hard", 1):
                    rcof = value
                files.append(file(f"p{p} {shoe} {n}", {"rcof": rcof}, person=f"P{p}", shoe=shoe))
    rng.shuffle(files)
    return told(guard._trials_mislabelled(files, "person"))


def test_a_trial_that_reads_as_one_of_another_label():
    (doubt,) = mislabelled(0.25)
    assert 'noted as shoe "hard", reads as "soft" of P0: another label? (p0 hard 1)' in doubt
    assert not mislabelled(0.2)
    assert not mislabelled(0.2 * float(np.exp(0.07)))
    assert not mislabelled(0.3)
    # within three times the scatter of the other label's mean
    assert mislabelled(0.25 * float(np.exp(0.04)))
    assert not mislabelled(0.25 * float(np.exp(0.05)))
    assert not mislabelled(0.25, same=2)


def test_copies_are_refused_and_the_first_counts():
    one = file("a", {"rcof": 0.2}, checksum="1", shoe="x")
    copy, other = (
        file("b", {"rcof": 0.3}, checksum="1", shoe="x"),
        file("c", {"rcof": 0.3}, checksum="2"),
    )
    files, doubts = guarded_files([[one], [copy], [other]])
    assert [each.usable for each in files] == [True, False, True]
    assert told(doubts) == ["the same bytes as a, which counts (b); left out"]
    unlike = file("b", {"rcof": 0.3}, checksum="1", shoe="y")
    files, doubts = guarded_files([[one], [unlike], [other]])
    assert [each.usable for each in files] == [False, False, True]
    assert "nobody knows whose they are" in str(doubts[0])
    number = file("b", {"rcof": 0.3}, checksum="3", shoe="x", trial=7.0)
    again = file("a", {"rcof": 0.3}, checksum="3", shoe="x", trial=8.0)
    assert "which counts" in str(guarded_files([[again], [number]])[1][0])
    many = [[file(f"f{n}", checksum="1", shoe=f"{n}")] for n in range(7)]
    files, _ = guarded_files(many)
    assert "f0, f1, f2, f3, f4, f5 ..., noted differently" in str(files[0].reasons[0])
    assert guard._join_groups([(0, 1), (3,), (1, 2), (4, 5)], 6) == [[0, 1, 2], [4, 5]]
