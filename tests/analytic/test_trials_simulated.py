"""Made-up trials: the analysis must find the truth that was put in."""

import csv
from pathlib import Path

import numpy as np
import pytest

from underfoot.core import DataError, InputError
from underfoot.trials import Channel, Marker, read_profile, read_trial
from underfoot.trials.machines.pressure_map import pressure_map, pressure_scan
from underfoot.trials.recording.protocols import protocol
from underfoot.trials.simulator import (
    Defects,
    ScanTruth,
    SlipTruth,
    scan_columns,
    simulated_folder,
    slip_truth,
    walk_c3d,
    walk_with_slip,
)
from underfoot.trials.study import analyse_folder


def _truth(folder: Path) -> dict[str, dict[str, str]]:
    with (folder / "truth.csv").open(encoding="utf-8") as stream:
        return {row["file"]: row for row in csv.DictReader(stream)}


@pytest.fixture(scope="module")
def slips(tmp_path_factory):
    folder = tmp_path_factory.mktemp("slips")
    simulated_folder("slips", folder, count=24)
    return folder, analyse_folder(folder, protocol("report_g6"), processes=1)


@pytest.mark.slow
def test_slips_are_found_with_speed_and_start(slips):
    """Issue limits: peak slipping speed within 3 %, slip start within 25 ms."""
    folder, analysis = slips
    truth = _truth(folder)
    slipped = 0
    for one in analysis.files:
        facts = truth[one.file]
        true_speed = float(facts["peak_slipping_speed"])
        assert one.main["slip"] == float(true_speed > 0.2)
        numbers = {(m.item, m.name): m.value for m in one.measurements}
        start = numbers["slip on plate 2", "slip start"]
        assert start == pytest.approx(float(facts["slip_start"]), abs=0.025)
        if true_speed > 0.2:
            slipped += 1
            assert one.main["peak_slipping_speed"] == pytest.approx(true_speed, rel=0.03)
    assert 4 <= slipped <= 20


def test_required_friction_of_made_up_steps(slips):
    folder, analysis = slips
    truth = _truth(folder)
    for one in analysis.files:
        assert one.main["rcof"] == pytest.approx(float(truth[one.file]["rcof"]), abs=0.003)


def test_peak_pressures_of_the_sensors(slips):
    folder, analysis = slips
    truth = _truth(folder)
    for one in analysis.files:
        for m in one.measurements:
            if m.name == "peak pressure" and m.item.startswith("sensor P"):
                expected = float(truth[one.file]["peak_pressure_" + m.item.split()[1]])
                # The largest of some thousand noisy samples lies 3 to 4 sd of 240 Pa high.
                assert m.value == pytest.approx(expected, abs=1200.0)


@pytest.mark.parametrize("speed", [0.3, 1.0, 2.4])
@pytest.mark.parametrize("noise", [0.0, 0.3e-3])
def test_single_slips_over_a_range_of_speeds(speed, noise, tmp_path):
    truth = SlipTruth(peak_speed=speed, rise=0.15, fall=0.22)
    recording = walk_with_slip(truth, Defects(marker_noise=noise), np.random.default_rng(3))
    path = tmp_path / "one.c3d"
    path.write_bytes(walk_c3d(recording))
    trial = read_trial(path)
    from underfoot.trials import slip

    found = slip(
        trial.marker("LHEE"), recording.truth["heel_contact"], up=np.array([0.0, 0.0, 1.0])
    )
    assert found.peak_speed.value == pytest.approx(speed, rel=0.03)
    assert found.start.value == pytest.approx(recording.truth["slip_start"], abs=0.025)


def test_c3d_written_here_is_read_back(tmp_path):
    recording = walk_with_slip(SlipTruth(), Defects(missing_frames=5), np.random.default_rng(0))
    path = tmp_path / "walk.c3d"
    path.write_bytes(walk_c3d(recording))
    trial = read_trial(path, subtract_baseline=False)
    assert set(trial.markers) == set(recording.markers)
    heel = recording.markers["LHEE"]
    assert np.isnan(trial.marker("LHEE").positions).any(axis=1).sum() == 5
    assert trial.marker("LHEE").positions == pytest.approx(heel, abs=1e-6, nan_ok=True)
    for plate, force in zip(trial.plates, recording.force, strict=True):
        assert plate.force == pytest.approx(force, abs=1e-3)
    place = trial.plates[0].centre_of_pressure
    firm = recording.force[0][:, 2] > 300
    assert place is not None
    assert place[firm] == pytest.approx(recording.centre[0][firm], abs=2e-2)
    assert trial.channel("P22").unit == "Pa"
    assert trial.channel("P22").values == pytest.approx(recording.pressures["P22"], rel=1e-6)


def _scans(truth, places, tmp_path, noise=1.0):
    rng = np.random.default_rng(7)
    found = []
    for place in places:
        columns = scan_columns(truth, float(place), rng, noise=noise)
        path = tmp_path / "scan.csv"
        data = np.column_stack(list(columns.values()))
        np.savetxt(path, data, delimiter=",", header=",".join(columns), comments="", fmt="%.6g")
        trial = read_trial(path)
        found.append(
            pressure_scan(
                trial, trial.channel("pressure"), trial.marker("heel"), position=(0.3, 0.0, 0.0)
            )
        )
    return found


def test_map_load_where_covered(tmp_path):
    """Issue limit: the map's load within 2 % where covered (Eq. 27), and the peak's place."""
    truth = ScanTruth()
    places = 0.01 * np.arange(-3, 4)
    found = pressure_map(_scans(truth, places, tmp_path), spacing=0.01, inlet_diameter=0.01)
    assert found.load.value == pytest.approx(truth.covered_load(places, 0.01), rel=0.02)
    assert found.peak.value == pytest.approx(truth.pressure, rel=0.02)
    assert found.peak_along.value == pytest.approx(truth.middle[0], abs=0.003)
    assert found.peak_lateral.value == pytest.approx(truth.middle[1], abs=0.001)
    assert found.lateral == pytest.approx(places, abs=5e-4)
    measured = pressure_map(_scans(truth, places, tmp_path))
    assert measured.load.value == pytest.approx(found.load.value, rel=0.02)


def test_coverage_is_judged(tmp_path):
    """Seven scans of 5 mm lose 20 % and more of a wide bump: the outer scans tell."""
    truth = ScanTruth(widths=(0.016, 0.02))
    narrow = pressure_map(_scans(truth, 0.005 * np.arange(-3, 4), tmp_path))
    assert narrow.load.value < 0.8 * truth.load
    assert narrow.outer_share > 0.02
    assert any("outermost scans" in flag.message for flag in narrow.load.flags)
    thin = ScanTruth(widths=(0.016, 0.004))
    hidden = pressure_map(_scans(thin, 0.01 * np.arange(-3, 4) + 0.004, tmp_path))
    assert hidden.half_spacing_change is not None
    assert hidden.half_spacing_change > 0.3


def test_maps_refuse_what_they_cannot_join(tmp_path):
    one = _scans(ScanTruth(), [0.0], tmp_path)
    with pytest.raises(DataError, match="no map"):
        pressure_map(one)
    with pytest.raises(DataError, match="same place"):
        pressure_map([*one, *one])
    marker = Marker(np.tile([0.0, 0.0, 0.0], (400, 1)), 200.0)
    from underfoot.trials import Trial

    with pytest.raises(DataError, match="hardly moves"):
        pressure_scan(
            Trial("still"), Channel(np.zeros(2000), "Pa", 1000.0), marker, position=(0.1, 0, 0)
        )


def test_slip_tester_folder(tmp_path):
    simulated_folder("tester", tmp_path, count=7)
    analysis = analyse_folder(tmp_path, protocol("report_g4"), processes=1)
    truth = _truth(tmp_path)
    for one in analysis.files:
        assert one.main["cof"] == pytest.approx(float(truth[one.file]["cof"]), abs=0.001)
        assert one.facts["sliding_speed"] == pytest.approx(0.7, rel=0.02)
        assert one.facts["normal_force"] == pytest.approx(
            500 if "none" in one.file else 250, rel=0.01
        )
    loads = {row[0].split(",")[0]: row[2] for row in analysis.study.tables[1].rows}
    for shoe, load in loads.items():
        expected = float(truth[f"{shoe}_scan_1.csv"]["fluid_load"])
        if expected > 10:
            assert load == pytest.approx(expected, rel=0.02)
        else:
            assert load < 5.0  # the report: negligible below 5 N


def test_pin_on_disk_folder(tmp_path):
    simulated_folder("pin_on_disk", tmp_path, count=2)
    analysis = analyse_folder(tmp_path, protocol("report_g2"), processes=1)
    truth = _truth(tmp_path)
    errors = [one.main["cof"] - float(truth[one.file]["cof"]) for one in analysis.files]
    assert np.abs(errors).max() < 0.006
    table = analysis.study.tables[0]
    by_fluid = {row[0]: row for row in table.rows}
    verdict = table.columns.index("verdict")
    assert by_fluid["glycerol_50pct"][verdict] == "good"
    assert by_fluid["canola_oil"][verdict] == "mean"
    assert by_fluid["glycerol_50pct"][5] == pytest.approx(0.47, rel=0.15)
    assert any(t.name == "master_curve" for t in analysis.study.tables)


def test_relaxation_folder(tmp_path):
    simulated_folder("relaxation", tmp_path, count=2)
    analysis = analyse_folder(tmp_path, protocol("report_g1_relaxation"), processes=1)
    truth = _truth(tmp_path)
    for one in analysis.files:
        assert one.main["peak_force"] == pytest.approx(
            float(truth[one.file]["peak_force"]), rel=0.01
        )
        assert one.main["final_force"] == pytest.approx(
            float(truth[one.file]["final_force"]), rel=0.01
        )


def test_simulated_folders_are_labelled_and_repeatable(tmp_path):
    for name in ("a", "b"):
        simulated_folder("slips", tmp_path / name, count=2)
    first, second = sorted((tmp_path / "a").iterdir()), sorted((tmp_path / "b").iterdir())
    assert [p.name for p in first] == [p.name for p in second]
    assert all(p.read_bytes() == q.read_bytes() for p, q in zip(first, second, strict=True))
    assert "SYNTHETIC" in (tmp_path / "a" / "SYNTHETIC.txt").read_text()
    assert read_profile(tmp_path / "a" / "profile.toml").name == "synthetic walkway"
    assert slip_truth(3, 1) == slip_truth(3, 1)
    assert slip_truth(3, 1) != slip_truth(3, 2)
    with pytest.raises(InputError, match="pin_on_disk"):
        simulated_folder("pin_on_disc", tmp_path / "c")


def test_boundary_folder(tmp_path):
    """Forces built from known adhesion and hysteresis: Eq. 22 to 26 must give them back."""
    from underfoot.trials.simulator.folder import disk_run

    rng = np.random.default_rng(9)
    pairs = {
        ("pu", "vinyl"): (5.0, 3.0),
        ("soft", "vinyl"): (9.0, 2.0),
        ("hard", "marble"): (13.0, 1.0),
    }
    fluids = {"water": (2.0, 0.1), "gly50": (1.0, 0.3)}
    lines = ["file,shoe,floor,fluid,speed (m/s)"]
    for (shoe, floor), (adhesion, hysteresis) in pairs.items():
        forces = {"dry": adhesion + hysteresis, "sae_75w140": hysteresis}
        forces |= {f: hysteresis + a + b * adhesion for f, (a, b) in fluids.items()}
        for fluid, force in forces.items():
            for repeat in range(3):
                name = f"{shoe}_{fluid}_{repeat}.csv"
                columns = disk_run(force / 20.9, 0.01, rng)
                data = np.column_stack(list(columns.values()))
                np.savetxt(
                    tmp_path / name, data, delimiter=",", header=",".join(columns), comments=""
                )
                lines.append(f"{name},{shoe},{floor},{fluid},0.01")
    (tmp_path / "conditions.csv").write_text("\n".join(lines) + "\n")
    analysis = analyse_folder(tmp_path, protocol("report_g3"), processes=1)
    assert all(one.usable for one in analysis.files)
    split = {row[:3]: row[3] for row in analysis.study.tables[0].rows}
    for pair, (adhesion, hysteresis) in pairs.items():
        assert split[*pair, "adhesion"] == pytest.approx(adhesion, abs=0.15)
        assert split[*pair, "hysteresis"] == pytest.approx(hysteresis, abs=0.1)
    rows = {row[0]: row for row in analysis.study.tables[1].rows}
    for fluid, (alpha, beta) in fluids.items():
        assert rows[fluid][1] == pytest.approx(alpha, abs=0.3)
        assert rows[fluid][3] == pytest.approx(beta, abs=0.03)
    ranges = {row[0]: row for row in analysis.study.tables[2].rows}
    for (shoe, _), (adhesion, _) in pairs.items():  # a sole stands on one floor here
        left = {fluid: a + b * adhesion for fluid, (a, b) in fluids.items()}
        assert ranges[shoe][4] == max(left, key=left.get)
        expected = max(left.values()) - min(left.values())
        assert ranges[shoe][5] == pytest.approx(expected, abs=0.2)
    titles = [finding.title for finding in analysis.study.findings]
    assert any("type II " in title for title in titles)
    assert any("type III " in title for title in titles)
    for response in ("dry adhesion", "hysteresis", "lubricated adhesion"):
        # hard is on marble alone, the others on vinyl: shoe and floor can't be told apart
        own = [one for one in analysis.study.findings if f"variance of {response}" in one.title]
        assert own, titles


def test_boundary_folder_tells_shoe_floor_and_lubricant_apart():
    """Adhesion made of a shoe, a lubricant and one interaction: the terms that are there show."""
    from underfoot.trials.study.study import _crossed_findings

    rng = np.random.default_rng(2)
    readings = [
        (
            3.0 + 2.0 * (shoe == "hard") + 1.5 * (fluid == "water")
            + 1.0 * (shoe == "hard" and fluid == "water") + 0.2 * rng.normal(),
            {"shoe": shoe, "floor": floor, "lubricant": fluid},
        )
        for shoe in ("hard", "soft", "pu")
        for floor in ("vinyl", "marble")
        for fluid in ("water", "oil")
        for _ in range(5)
    ]  # fmt: skip
    found = _crossed_findings("lubricated_adhesion", readings)
    anova = next(one for one in found if one.name.startswith("anova")).table
    place = anova.columns.index("p")
    p = {row[0]: row[place] for row in anova.rows}
    assert {"shoe:floor", "shoe:lubricant", "floor:lubricant", "shoe:floor:lubricant"} <= set(p)
    for term in ("shoe", "lubricant", "shoe:lubricant"):
        assert p[term] < 0.001, term
    for term in ("floor", "shoe:floor", "floor:lubricant", "shoe:floor:lubricant"):
        assert p[term] > 0.01, term


@pytest.mark.slow
def test_pin_on_disk_tells_fluid_and_roughness_apart(tmp_path):
    """G.2's second question: COF_BL by fluid and by the roughness of the pin, and both together."""
    from underfoot.trials.simulator.folder import disk_run

    rng = np.random.default_rng(4)
    lines = ["file,fluid,roughness,repeat,speed (m/s)"]
    for fluid, level in (("thin", 0.6), ("thick", 0.4)):
        for roughness, more in (("fine", 0.0), ("coarse", 0.12)):
            for repeat in range(3):
                for speed in (0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0):
                    own = level + more + 0.005 * rng.normal()
                    cof = 0.1 + (own - 0.1) * np.exp(-speed / 0.3)
                    name = f"{fluid}_{roughness}_{repeat}_{speed:g}.csv"
                    columns = disk_run(cof, speed, rng)
                    data = np.column_stack(list(columns.values()))
                    np.savetxt(
                        tmp_path / name, data, delimiter=",", header=",".join(columns), comments=""
                    )
                    lines.append(f"{name},{fluid},{roughness},{repeat},{speed:g}")
    (tmp_path / "conditions.csv").write_text("\n".join(lines) + "\n")
    analysis = analyse_folder(tmp_path, protocol("report_g2"), processes=1)
    anova = next(f for f in analysis.study.findings if f.name.startswith("anova_cof_bl"))
    place = anova.table.columns.index("p")
    p = {row[0]: row[place] for row in anova.table.rows}
    assert p["fluid"] < 0.001
    assert p["roughness"] < 0.001
    assert p["fluid:roughness"] > 0.01
