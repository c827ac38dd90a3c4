"""Machines that give their own number, and testers with two channels."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from underfoot.core import DataError, InputError
from underfoot.trials import profile_from
from underfoot.trials.analyse import analyse_folder
from underfoot.trials.analyse.readings import SCHEMES, class_scheme, cof_of_pendulum
from underfoot.trials.protocols import protocol
from underfoot.trials.readers import read_trial


@pytest.mark.parametrize(
    ("scheme", "values"),
    [
        ("uksrg_pendulum", {24.4: "high", 24.6: "moderate", 35.4: "moderate", 36: "low"}),
        (
            "din_51130",
            {5.9: "none", 6.1: "R9", 10: "R9", 10.1: "R10", 19: "R10", 27.5: "R12", 36: "R13"},
        ),
        ("din_51097", {11.9: "none", 12: "A", 18: "B", 23.9: "B", 24: "C"}),
        ("dguv_tribometer", {0.29: "unsafe", 0.30: "conditionally", 0.45: "safe"}),
        ("ansi_a326_3", {0.41: "below", 0.42: "at or above"}),
    ],
)
def test_classes(scheme, values):
    for value, name in values.items():
        assert class_scheme(scheme).class_of(value).startswith(name)
    assert "not verified" in class_scheme(scheme).source


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
    assert cof_of_pendulum(36) == pytest.approx(0.367, abs=5e-4)
    assert cof_of_pendulum(24) == pytest.approx(0.235, abs=5e-4)
    assert cof_of_pendulum(0) == 0


def study(folder, name):
    analysis = analyse_folder(folder, protocol(name), processes=1)
    return analysis, {t.name: t for t in analysis.study.tables}


def test_a_pendulum_survey(tmp_path):
    rows = ["surface;direction;PTV"]
    rows += [f"tile;1;{v}" for v in (50, 45, 40, 34, 36, 35, 35, 37)]
    rows += [f"vinyl;1;{v}" for v in (30, 30, 30, "22,0", 23, 22, 22, 21)]
    (tmp_path / "hall.csv").write_text("\n".join(rows))
    analysis, tables = study(tmp_path, "en_16165_pendulum")
    samples = [
        dict(zip(tables["samples"].columns, row, strict=True)) for row in tables["samples"].rows
    ]
    assert [s["PTV"] for s in samples] == pytest.approx([35.4, 22.0])
    assert [s["class"] for s in samples] == ["moderate slip potential", "high slip potential"]
    # The interval of the tile (t with 4 degrees of freedom) reaches 36.
    assert samples[0]["interval reaches"] == "low slip potential"
    assert samples[0]["PTV SD"] == pytest.approx(np.std([34, 36, 35, 35, 37], ddof=1))
    assert samples[0]["COF from PTV"] == pytest.approx(3 * 35.4 / (330 - 35.4))
    assert any("from memory" in note for note in tables["samples"].notes)
    assert all(f.verdict == "accepted" for f in analysis.files)


def test_zero_and_conditioning_runs(tmp_path):
    text = "run,surface,COF\nzero,a,0.02\nzero,a,0.04\nconditioning,a,0.9\n,a,0.43\n,a,0.45\n"
    (tmp_path / "x.csv").write_text(text)
    analysis, _ = study(tmp_path, "ansi_a326_3")
    (one,) = analysis.files
    assert one.main["cof"] == pytest.approx(0.41)
    assert one.measurements[0]["conventions"]["left out"] == "1 conditioning, 2 zero runs"
    (tmp_path / "x.csv").write_text("run,surface,PTV\nzero,a,3\n,a,40\n,a,41\n")
    analysis, _ = study(tmp_path, "en_16165_pendulum")
    assert analysis.files[0].verdict == "refused"  # three conditioning swings leave nothing
    assert "no reading is left" in analysis.files[0].reasons[0]


def test_impossible_or_missing_readings_are_refused(tmp_path):
    (tmp_path / "a.csv").write_text("surface,PTV\na,36\nb,410\n")
    (tmp_path / "b.csv").write_text("surface,height\na,36\n")
    analysis, _ = study(tmp_path, "en_16165_pendulum")
    assert [f.verdict for f in analysis.files] == ["refused", "refused"]
    assert "410" in analysis.files[0].reasons[0]
    assert "no column of readings" in analysis.files[1].reasons[0]


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
