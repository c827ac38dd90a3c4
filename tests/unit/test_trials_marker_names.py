"""Names of markers in the usual sets, a laboratory's own, and what is said where none is known."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from underfoot.core import DataError, InputError
from underfoot.trials import Marker, Trial, read_trial, required_frictions, walkway_of
from underfoot.trials.readers.profile import profile_from
from underfoot.trials.recording.axes import heel_candidates
from underfoot.trials.recording.marker_names import landmark
from underfoot.trials.study.export import c3d_with_events
from underfoot.trials.walking.plausibility import unseen

WALK = Path(__file__).parents[1] / "data" / "trials" / "biomechzoo" / "HC030A05.c3d"
LEFT = {
    "heel": "LHEE L_FCC LFCC LPCA L_PCA CAL_L LCAL1 L_CALD HeelL FerseL TalonG Talon_Gauche "
    "Ferse_links l_heel LHeelBack Anna:LHEE L.Heel izq_talon LCA LHE LHL LHEB",
    "toe": "LTOE L_FM2 LMT1 LHLX L.Toe.Tip toe_left LFM1 LHX",
    "pelvis": "LASI L_IAS L_IPS L.PSIS LASIS LSIAS ASI_L EIASG EIPS_G BeckenVornLinks",
}
NONE = "LKNE LANK L_HLE LELB RSHO LHIP C7 LHeelForce RMT5 LeftKneeAngle STRN GAU"


@pytest.mark.parametrize(
    ("name", "kind"), [(name, kind) for kind, names in LEFT.items() for name in names.split()]
)
def test_names_of_the_usual_sets_have_place_and_side(name, kind):
    place = landmark(name)
    assert place is not None
    assert (place.kind, place.side) == (kind, "left")


@pytest.mark.parametrize("name", NONE.split())
def test_other_names_have_none(name):
    assert landmark(name) is None


@pytest.mark.parametrize("name", ["SACR", "V.Sacral", "Sacrum", "Kreuzbein"])
def test_the_sacrum_has_no_side(name):
    place = landmark(name)
    assert place is not None
    assert (place.kind, place.side) == ("pelvis", "")


def test_two_letters_are_a_heel_where_they_lie_lowest():
    """LHE is a heel, or an epicondyle of the humerus."""
    up = np.array([0.0, 0.0, 1.0])
    low, high = (Marker(np.full((9, 3), height), 100.0) for height in (0.03, 1.1))
    assert heel_candidates(Trial("x", markers={"LHE": low, "LSHO": high}), None, up)["left"]
    assert not heel_candidates(Trial("x", markers={"LHE": high, "LTOE": low}), None, up)["left"]


def renamed(names):
    trial = read_trial(WALK)
    markers = {names.get(name, name): marker for name, marker in trial.markers.items()}
    return replace(trial, markers=markers)


STRANGE = {
    "LHEE": "F07", "RHEE": "F12", "LHE1": "F08", "RHE1": "F13", "LASI": "B1", "RASI": "B2",
    "SACR": "B3",
}  # fmt: skip


SETS = {
    "IOR": "LCA RCA LFM RFM LASIS RASIS",
    "CAST": "L_FCC R_FCC L_FM2 R_FM2 L_IAS R_IAS",
    "Plug-in Gait": "LHEE RHEE LTOE RTOE LASI RASI",
    "Vaughan": "L.Heel R.Heel L.Toe R.Toe L.ASIS R.ASIS",
    "Rizzoli foot": "LCA RCA LSMH RSMH LASI RASI",
    "Oxford foot": "LPCA RPCA LHLX RHLX LASI RASI",
    "OpenSim": "L.Heel R.Heel L.Toe.Tip R.Toe.Tip L.ASIS R.ASIS",
    "Qualisys": "LHeelBack RHeelBack LToeTip RToeTip WaistLFront WaistRFront",
    "Rajagopal": "LCAL RCAL LTOE RTOE LASI RASI",
    "German": "FerseLinks FerseRechts ZehLinks ZehRechts SIAS_L SIAS_R",
    "French": "TalonG TalonD OrteilG OrteilD EIASG EIASD",
    "numbers": "M1 M2 M3 M4 M5 M6",
}
PLACES = "LHEE RHEE LTOE RTOE LASI RASI".split()


@pytest.mark.parametrize("name", SETS)
def test_a_file_of_each_set_has_its_heels_or_a_caution(tmp_path, name):
    """The recorded walk, written with the names of the set alone, gives its RCOF and its feet."""
    plain = read_trial(WALK)
    names = dict(zip(SETS[name].split(), PLACES, strict=True))
    markers = {own: plain.markers[place] for own, place in names.items()}
    stances = [step.stance for step in required_frictions(walkway_of(plain))]
    path = tmp_path / f"{name}.c3d"
    path.write_bytes(c3d_with_events(replace(plain, markers=markers), stances))
    walk = walkway_of(read_trial(path))
    heels = {side: names[heel] for side, heel in walk.heels.items()}
    steps = [step for step in required_frictions(walk) if step.measurement.estimated]
    known = {place.side for own in names if (place := landmark(own)) and place.kind == "heel"}
    assert heels == ({"left": "LHEE", "right": "RHEE"} if known else {})
    assert len(steps) == 2
    for step, other in zip(steps, required_frictions(walkway_of(plain)), strict=True):
        assert step.measurement.value == pytest.approx(other.measurement.value, abs=1e-3)
        told = [flag.name for flag in step.measurement.caution_flags]
        assert step.stance.side == other.stance.side if known else "heel" in told
    assert bool(walk.pelvis) == (name != "numbers")


def test_a_heel_of_no_known_name_makes_every_step_a_caution():
    trial = renamed(STRANGE)
    steps = [s for s in required_frictions(walkway_of(trial)) if s.measurement.estimated]
    assert steps
    for step in steps:
        assert "heel" in [flag.name for flag in step.measurement.caution_flags]
    assert [flag.name for flag in unseen(walkway_of(trial))] == ["heel", "pelvis"]
    assert not unseen(walkway_of(read_trial(WALK)))
    bare = replace(trial, markers={}, settings={})
    assert [flag.name for flag in unseen(walkway_of(bare))] == ["markers", "body mass"]


def test_a_laboratorys_own_names_stand_for_places():
    profile = profile_from(
        {"landmarks": {
            "F07": "left heel", "F12": "right heel", "B1": "left pelvis", "B2": "right pelvis",
            "B3": "pelvis",
        }}
    )  # fmt: skip
    walk = walkway_of(renamed(STRANGE), landmarks=profile.landmarks)
    assert walk.heels == {"left": "F07", "right": "F12"}
    plain = required_frictions(walkway_of(read_trial(WALK)))
    for own, other in zip(required_frictions(walk), plain, strict=True):
        assert own.measurement.value == other.measurement.value
        assert (own.stance.side, own.verdict) == (other.stance.side, other.verdict)


def test_own_names_win_and_are_checked():
    named = {"LTOE": "left heel"}
    assert heel_candidates(read_trial(WALK), named)["left"] == ["LTOE"]
    with pytest.raises(DataError, match="Did you mean"):
        heel_candidates(read_trial(WALK), {"LHEE2": "left heel"})
    with pytest.raises(InputError, match="left heel"):
        profile_from({"landmarks": {"F07": "left heal"}})
