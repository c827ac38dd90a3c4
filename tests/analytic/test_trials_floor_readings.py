"""Machines that give their own number, and testers with two channels."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from underfoot.core import DataError, InputError
from underfoot.trials import profile_from
from underfoot.trials.readers import read_trial
from underfoot.trials.recording.protocols import protocol
from underfoot.trials.statistics import precision
from underfoot.trials.study import analyse_folder
from underfoot.trials.study.floor_classes import SCHEMES, class_scheme, cof_of_pendulum


@pytest.mark.parametrize(
    ("scheme", "values"),
    [
        # Halves are rounded down: a mean of 35.5 is not 36.
        ("uksrg_pendulum", {24.5: "high", 24.6: "moderate", 35.5: "moderate", 36: "low"}),
        (
            "din_51130",
            {5.9: "none", 6: "R9", 10: "R9", 10.1: "R10", 19: "R10", 27.5: "R12", 36: "R13"},
        ),
        ("din_51097", {11.9: "none", 12: "A", 18: "B", 23.9: "B", 24: "C"}),
        ("dguv_tribometer", {0.29: "not sufficiently", 0.30: "conditionally", 0.45: "safe"}),
        (
            "ansi_a326_3",
            {0.41: "below", 0.42: "interior wet", 0.5: "interior wet plus", 0.55: "exterior wet"},
        ),
        ("ansi_a326_3_dry", {0.41: "below", 0.42: "interior dry", 0.6: "interior dry"}),
    ],
)
def test_classes(scheme, values):
    found = class_scheme(scheme)
    for value, name in values.items():
        assert found.class_of(value).startswith(name)
    assert "read at" in found.standing()
    assert ("not verified" in found.standing()) == (scheme == "dguv_tribometer")


def test_an_unknown_scheme_names_the_nearest():
    with pytest.raises(InputError, match="din_51130"):
        class_scheme("din_51131")


@given(st.sampled_from(sorted(SCHEMES)), st.floats(0, 90), st.floats(0, 90))
def test_higher_readings_are_never_a_lower_class(name, one, two):
    scheme = SCHEMES[name]
    order = ["none", *(label for _, label in scheme.limits)]
    low, high = sorted((one, two))
    assert order.index(scheme.class_of(low)) <= order.index(scheme.class_of(high))


def test_pendulum_values_as_cof():
    # The scale of the pendulum: 36 is 0.37, 24 is 0.24, 0 is 0.
    assert cof_of_pendulum(36)[0] == pytest.approx(0.367, abs=5e-4)
    assert cof_of_pendulum(24)[0] == pytest.approx(0.235, abs=5e-4)
    assert cof_of_pendulum(0) == (0, 0)
    value, error = cof_of_pendulum(36, 0.01)
    assert error == pytest.approx(cof_of_pendulum(36.01)[0] - value, rel=1e-3)


def study(folder, name):
    analysis = analyse_folder(folder, protocol(name), processes=1)
    return analysis, {t.name: t for t in analysis.study.tables}


def test_a_pendulum_survey(tmp_path):
    rows = ["surface;slider;condition;direction;PTV"]
    rows += [f"tile;96;wet;1;{v}" for v in (50, 45, 40, 34, 36, 35, 35, 37)]
    rows += [f"vinyl;96;wet;1;{v}" for v in (30, 30, 30, "22,0", 23, 22, 22, 21)]
    (tmp_path / "hall.csv").write_text("\n".join(rows))
    analysis, tables = study(tmp_path, "en_16165_pendulum")
    samples = [
        dict(zip(tables["samples"].columns, row, strict=True)) for row in tables["samples"].rows
    ]
    assert [s["PTV"] for s in samples] == pytest.approx([35.4, 22.0])
    assert [s["class"] for s in samples] == ["moderate slip potential", "high slip potential"]
    # 2.8 % of the calibration and the scatter of five readings: 2 u reaches 36.
    scatter = np.std([34, 36, 35, 35, 37], ddof=1) / np.sqrt(5)
    assert samples[0]["u"] == pytest.approx(np.hypot(scatter, 0.028 * 35.4))
    assert samples[0]["2 u reaches"] == "low slip potential"
    assert samples[0]["PTV SD"] == pytest.approx(np.std([34, 36, 35, 35, 37], ddof=1))
    assert samples[0]["COF from PTV"] == pytest.approx(3 * 35.4 / (330 - 35.4))
    assert any("Guidelines 2005" in note for note in tables["samples"].notes)
    assert all(f.verdict == "accepted" for f in analysis.files)
    said = analysis.files[0].measurements[0].conventions
    assert said["left out"].endswith("before those that count: 50, 45, 40")
    unverified = [text for text in analysis.methods if "Not verified" in text]
    assert len(unverified) == 1
    assert "conditioning, readings" in unverified[0]


def pendulum(tmp_path, rows, heads="surface,slider,condition,direction,run,PTV"):
    folder = tmp_path / "one"
    folder.mkdir(exist_ok=True)
    (folder / "x.csv").write_text("\n".join([heads, *rows]))
    return study(folder, "en_16165_pendulum")


def test_all_five_readings_of_a_report_count(tmp_path):
    analysis, _ = pendulum(tmp_path, [f"tile,96,wet,1,,{v}" for v in (34, 36, 35, 35, 36)])
    (one,) = analysis.files
    assert one.measurements[0].n == 5
    assert one.main["ptv"] == pytest.approx(35.2)
    assert one.verdict == "accepted"


@pytest.mark.parametrize(
    ("readings", "words"),
    [
        ((34, 36, 35), "3 readings, 3 of them used; expected are 5 or 8"),
        ((34, 36, 35, 35, 36, 35, 36), "7 readings, 5 of them used"),
        ((36, 36, 36, 37, 63), "readings differ by 27"),
    ],
)
def test_an_odd_number_of_readings_and_an_outlier_are_told(tmp_path, readings, words):
    analysis, _ = pendulum(tmp_path, [f"tile,96,wet,1,,{v}" for v in readings])
    assert words in " ".join(analysis.files[0].reasons)


def test_directions_are_told_each_with_the_lowest(tmp_path):
    means = {"along": 38, "across": 34, "diagonal": 40}
    rows = [f"tile,96,wet,{way},,{v}" for way, mean in means.items() for v in [mean] * 5]
    _, tables = pendulum(tmp_path, rows)
    row = dict(zip(tables["lowest"].columns, tables["lowest"].rows[0], strict=True))
    assert row["lowest"] == "across"
    assert row["PTV"] == 34
    assert row["class"] == "moderate slip potential"
    assert all(way in row["directions"] for way in means)
    assert not row["directions measured"]
    _, tables = pendulum(tmp_path, rows[:10])
    row = dict(zip(tables["lowest"].columns, tables["lowest"].rows[0], strict=True))
    assert row["directions measured"] == "2 of 3"


def test_slider_condition_and_direction_are_asked_for(tmp_path):
    analysis, _ = pendulum(tmp_path, [f"tile,{v}" for v in (34, 36, 35, 35, 36)], "surface,PTV")
    assert "not noted: slider, condition, direction" in analysis.files[0].reasons[0]


@pytest.mark.parametrize(
    ("reading", "slider", "verdict"),
    [(61, "96", "accepted"), (70, "96", "refused"), (61, "55", "refused")],
)
def test_check_surfaces_of_the_pendulum(tmp_path, reading, slider, verdict):
    rows = [f"lapping film,{slider},wet,1,check,{reading}" for _ in range(3)]
    rows += [f"tile,{slider},wet,1,,{v}" for v in (34, 36, 35, 35, 36)]
    analysis, _ = pendulum(tmp_path, rows)
    (one,) = analysis.files
    assert one.verdict == verdict
    assert f"slider {slider}" in one.measurements[0].conventions["check surfaces"] or slider == "55"


def test_a_check_of_the_other_slider_says_nothing(tmp_path):
    rows = ["float glass,55,wet,1,check,30"] + [f"tile,96,wet,1,,{v}" for v in (34, 36, 35, 35, 36)]
    analysis, _ = pendulum(tmp_path, rows)
    assert analysis.files[0].verdict == "accepted"
    rows[0] = "marble,96,wet,1,check,30"
    analysis, _ = pendulum(tmp_path, rows)
    assert "unknown surface" in analysis.files[0].reasons[0]


@pytest.mark.parametrize(
    ("protocol_name", "head", "values", "verdict"),
    [
        ("en_16165_pendulum", "PTV", "0.355 0.36 0.35 0.36 0.35", "refused"),
        ("en_16165_shod_ramp", "angle", "0.35 0.36", "refused"),
        ("en_16165_shod_ramp", "angle (rad)", "0.35 0.36 0.355", "accepted"),
        ("en_16165_shod_ramp", "angle", "20.1 20.6 20.3", "accepted"),
        ("en_16165_shod_ramp", "angle", "20.1 20.6", "caution"),
        ("en_16165_shod_ramp", "angle (gon)", "20.1 20.6", "refused"),
        ("machine_cof", "COF", "1.8 1.9", "caution"),
        ("machine_cof", "COF (%)", "42 44", "accepted"),
    ],
)
def test_a_quantity_or_unit_mistaken(tmp_path, protocol_name, head, values, verdict):
    rows = [f"tile,96,wet,1,{v}" for v in values.split()]
    (tmp_path / "x.csv").write_text(
        "\n".join([f"surface,slider,condition,direction,{head}", *rows])
    )
    (one,) = study(tmp_path, protocol_name)[0].files
    assert one.verdict == verdict
    if head == "angle (rad)":
        assert one.main["angle"] == pytest.approx(np.degrees(0.355))
    if head == "COF (%)":
        assert one.main["cof"] == pytest.approx(0.43)


def test_two_spellings_of_one_floor_are_refused(tmp_path):
    (tmp_path / "x.csv").write_text("surface,COF\nTile A,0.4\ntile a,0.5\n")
    (one,) = study(tmp_path, "machine_cof")[0].files
    assert one.verdict == "refused"
    assert '"Tile A"' in one.reasons[0]


def test_dry_readings_have_their_own_class(tmp_path):
    rows = ["condition,surface,COF", "dry,a,0.6", "dry,a,0.61", "wet,a,0.6", "wet,a,0.61"]
    (tmp_path / "x.csv").write_text("\n".join(rows))
    _, tables = study(tmp_path, "ansi_a326_3")
    classes = {row[1]: row[-2] for row in tables["samples"].rows}
    assert classes == {"dry": "interior dry", "wet": "exterior wet, oils and greases"}


def test_zero_and_conditioning_runs(tmp_path):
    text = "run,surface,COF\nzero,a,0.02\nzero,a,0.04\nconditioning,a,0.9\n,a,0.43\n,a,0.45\n"
    (tmp_path / "x.csv").write_text(text)
    analysis, _ = study(tmp_path, "ansi_a326_3")
    (one,) = analysis.files
    assert one.main["cof"] == pytest.approx(0.41)
    assert one.measurements[0].conventions["left out"] == "1 conditioning, 2 zero runs"
    (tmp_path / "x.csv").write_text("run,surface,PTV\nzero,a,3\n,a,40\n,a,41\n")
    analysis, _ = study(tmp_path, "en_16165_pendulum")
    assert "the zero run reads 3.0" in " ".join(analysis.files[0].reasons)
    (tmp_path / "x.csv").write_text("run,surface,PTV\nzero,a,0\n")
    analysis, _ = study(tmp_path, "en_16165_pendulum")
    assert "no reading is left" in analysis.files[0].reasons[0]


def test_impossible_or_missing_readings_are_refused(tmp_path):
    (tmp_path / "a.csv").write_text("surface,PTV\na,36\nb,410\n")
    (tmp_path / "b.csv").write_text("surface,height\na,36\n")
    analysis, _ = study(tmp_path, "en_16165_pendulum")
    assert [f.verdict for f in analysis.files] == ["refused", "refused"]
    assert "410" in analysis.files[0].reasons[0]
    words = "no column of readings was recognised among height. Allowed: ptv"
    assert words in analysis.files[1].reasons[0]


def test_precision_over_operators(tmp_path):
    rng = np.random.default_rng(1)
    rows = ["floor,operator,COF"]
    for operator in "ABCDE":
        shift = 0.05 if operator == "C" else 0.0
        rows += [f"tile,{operator},{0.5 + shift + 0.005 * rng.normal():.4f}" for _ in range(4)]
    (tmp_path / "ring.csv").write_text("\n".join(rows))
    _, tables = study(tmp_path, "machine_cof")
    row = dict(
        zip(tables["precision_operator"].columns, tables["precision_operator"].rows[0], strict=True)
    )
    assert row["operators"] == 5
    assert row["s_r"] == pytest.approx(0.005, rel=0.5)
    assert row["s_R"] > 3 * row["s_r"]
    assert any("operator C, outlier" in note for note in tables["precision_operator"].notes)


@pytest.mark.parametrize("shift", [0.0, 0.05])
def test_precision_of_equal_readings_is_not_resolved(tmp_path, shift):
    """0.1 + 0.2 and 0.3 are one reading: their scatter is below its resolution, not 0."""
    rows = ["floor,operator,COF"]
    for operator in "ABC":
        reading = 0.3 + (shift if operator == "C" else 0.0)
        rows += [f"tile,{operator},{value!r}" for value in (reading, reading + 1e-16, reading)]
    (tmp_path / "ring.csv").write_text("\n".join(rows))
    _, tables = study(tmp_path, "machine_cof")
    table = tables["precision_operator"]
    row = dict(zip(table.columns, table.rows[0], strict=True))
    assert row["s_r"] is None
    assert row["r = 2.8 s_r"] is None
    if shift:
        assert row["s_R"] == pytest.approx(shift / 3**0.5)  # SD of 0.3, 0.3 and 0.35
    else:
        assert row["s_R"] is None
    assert any("below the resolution" in note for note in table.notes)
    samples = tables["samples"]
    own = dict(zip(samples.columns, samples.rows[0], strict=True))
    assert own["COF"] == pytest.approx(0.3)
    assert (own["COF SD"], own["u"]) == (None, None)
    assert any("scatter by less than the resolution" in note for note in samples.notes)
    assert precision({"a": [1, 1], "b": [1, 1.0]}).repeatability is None


def write_run(path, cof=0.313):
    time = np.arange(0, 2, 0.002)
    normal = 500.0 * np.clip((time - 0.3) / 0.1, 0, 1)
    friction = cof * normal * np.clip((time - 0.5) / 0.02, 0, 1)
    lines = ["Zeit [s];Reibkraft [N];Normalkraft [N]"]
    lines += [
        ";".join(f"{v:.4f}".replace(".", ",") for v in row)
        for row in zip(time, friction, normal, strict=True)
    ]
    path.write_text("\n".join(lines))


OURS = """
[protocol.ours]
title = "Our tester"
kind = "slip_tester"
source = "manual"
[protocol.ours.method]
friction = "Reibkraft"
normal = "{normal}"
window_from = "sliding"
window_begin = "0.3 s"
window_end = "0.6 s"
"""


def test_a_tester_with_two_channels(tmp_path):
    folder = tmp_path / "runs"
    folder.mkdir()
    for i, cof in enumerate((0.313, 0.2), 1):
        write_run(folder / f"run{i}.csv", cof)
    (tmp_path / "p.toml").write_text(OURS.format(normal="Normalkraft"))
    analysis = analyse_folder(folder, protocol("ours", [tmp_path]), processes=1)
    assert [f.main["cof"] for f in analysis.files] == pytest.approx([0.313, 0.2], abs=1e-3)
    # The same column twice would count its force twice: 41 % too high.
    (tmp_path / "p.toml").write_text(OURS.format(normal="Reibkraft"))
    with pytest.raises(InputError, match="named twice"):
        analyse_folder(folder, protocol("ours", [tmp_path]), processes=1)


def test_profiles_refuse_the_same_column_twice():
    for plate in (
        {"force": ["R", "R", "N"]},
        {"friction": "R", "normal": "R"},
    ):
        with pytest.raises(InputError, match="named twice"):
            profile_from({"plates": {"t": plate}})
    with pytest.raises(InputError, match="both named"):
        profile_from({"plates": {"t": {"friction": "R"}}})
    with pytest.raises(InputError, match="needs its force columns"):
        profile_from({"plates": {"t": {"friction": "R", "normal": "N", "force": ["a", "b", "c"]}}})
    two = profile_from({"plates": {"t": {"force": ["", "R", "N"]}}})
    assert two.plates["t"].force == ("", "R", "N")


def test_units_of_a_heading_count(tmp_path):
    write_run(tmp_path / "run.csv")
    text = (tmp_path / "run.csv").read_text().replace("Normalkraft [N]", "Normalkraft [kN]")
    (tmp_path / "run.csv").write_text(text)
    profile = profile_from({"plates": {"t": {"friction": "Reibkraft", "normal": "Normalkraft"}}})
    trial = read_trial(tmp_path / "run.csv", profile, subtract_baseline=False)
    assert trial.plates[0].force[:, 2].max() == pytest.approx(500e3)
    with pytest.raises(DataError, match="no column"):
        read_trial(
            tmp_path / "run.csv",
            profile_from({"plates": {"t": {"friction": "Reibung", "normal": "Normalkraft"}}}),
        )


@pytest.mark.parametrize("who", ["operator", "walker", "Prüfperson", "person"])
@pytest.mark.parametrize("head", ["angle (deg)", "Akzeptanzwinkel [°]"])
def test_whoever_walks_a_tile_has_one_class(tmp_path, who, head):
    walks = [(1, "18,9"), (1, "19"), (1, "18,8"), (2, "19,3")]
    rows = "".join(f"tile;{p};{v}\n" for p, v in walks)
    (tmp_path / "x.csv").write_text(f"sample;{who};{head}\n{rows}")
    found = study(tmp_path, "en_16165_shod_ramp")[0].study
    (table,) = (one for one in found.tables if one.name == "walkers")
    assert table.rows[0][table.columns.index("angle (deg)")] == pytest.approx(19.1)
    (samples,) = (one for one in found.tables if one.name == "samples")
    assert "class" not in samples.columns


@pytest.mark.parametrize("sign", ["\u00b5", "\u03bc"])
def test_a_micro_sign_is_the_greek_letter(tmp_path, sign):
    (tmp_path / "x.csv").write_text(f"surface;Gleitreibwert {sign}\ntile;0,45\ntile;0,47\n")
    assert study(tmp_path, "machine_cof")[0].files[0].main["cof"] == pytest.approx(0.46)


@pytest.mark.parametrize("head", ["Swing {}", "{}", "Messung {}"])
def test_a_record_sheet_has_its_readings_beside_each_other(tmp_path, head):
    heads = ",".join(head.format(n) for n in range(1, 9))
    rows = "tile,96,wet,along,40,38,36,34,35,36,35,35\ntile,96,wet,across,41,38,36,30,31,32,31,31\n"
    (tmp_path / "x.csv").write_text(f"surface,slider,condition,direction,{heads}\n{rows}")
    found = study(tmp_path, "en_16165_pendulum")[0].files
    assert {f.conditions["direction"]: f.main["ptv"] for f in found} == {"along": 35, "across": 31}
    assert all(f.verdict == "accepted" for f in found)
