"""Which markers are heels, toes and the pelvis, and of which side, by what they are called.

Names as their sets have them: Plug-in Gait (LHEE, LTOE, LASI, LPSI), CAST and IOR (L_FCC or LCA,
L_FM2, L_IAS, L_IPS), Helen Hayes and Vaughan (L.Heel, V.Sacral), Rizzoli and Oxford foot (CA, LPCA,
LHLX), OpenSim and Rajagopal (R.ASIS, RCAL, RTOE), Qualisys (LHeelBack), German and French words
(from the sets' own pages and recordings that name them so; from memory where none was at hand).
"""

import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from underfoot.core import DataError, InputError, nearest_match, unknown_name
from underfoot.core.remark import Message

from .trial import Marker, Trial, once_a_record

HEEL, TOE, PELVIS = "heel", "toe", "pelvis"
LANDMARKS = ("left heel", "right heel", "left toe", "right toe", "left pelvis", "right pelvis",
             "pelvis")  # fmt: skip
"""What an own name may stand for."""
_LOW = 0.12  # m above the lowest marker; the heel stands lower than a hand or a shin


@dataclass(frozen=True, slots=True)
class Landmark:
    """A place on the body: ``kind`` (heel, toe, pelvis) and ``side`` (left, right or empty).

    ``short``: by two or three letters that other places could have too; where it lies decides.
    """

    kind: str
    side: str = ""
    short: bool = False


_SIDES = {
    "left": r"left|links|li|gauche|gau|izq(?:uierd[ao])?|esq|g|l",
    "right": r"right|rechts|re|droite?|dro|der(?:ech[ao])?|d|r",
}
_PART = r"(?:back|bck|rear|post(?:erior)?|lat(?:eral)?|med(?:ial)?|low(?:er)?|upper|prox|dist)"
_STEMS = {
    (HEEL, False): rf"heel{_PART}?|{_PART}heel|hee|cal|cald|calp|calc(?:an(?:eus|eum|ee)?)?|fcc|"
    r"pca|ferse|talon|taluspost|hiel|calcagno|tal[oó]n",
    (HEEL, True): r"ca|he|hl|heb|hb",
    (TOE, False): r"toe(?:s|tip|\.?tip)?|bigtoe|greattoe|hallux|hlx|mt[12]|mth?[12]|met[12]|"
    r"metatarsal[12]|fm[12]|fmh|smh|d[12]m|zeh(?:e|en)?|grosszehe|orteil|grosorteil|forefoot|"
    r"mtp[12]?|hx",
    (PELVIS, False): r"asis?|psis?|[se]?ias|[se]?ips|sacr(?:um|al|o)?|v?sac|vsacr(?:al|um)?|"
    r"midpsis|waist[lr]?(?:front|back)|becken(?:vorne?|hinten)?|kreuzbein",
}  # fmt: skip
_NO_PLACE = re.compile(r"force|moment|angle|power|grf|scale", re.IGNORECASE)
_WORDS = {  # that say the place among others that no set has
    HEEL: re.compile("heel|hee$|cal$|calc|talon|ferse|hiel", re.IGNORECASE),
    TOE: re.compile(r"toe$|mt[12]$|toe[ _.\-]?[lr]?$", re.IGNORECASE),
    PELVIS: re.compile(r"asis?$|psis?$|sacr(um)?$|v?sac$", re.IGNORECASE),
}


@lru_cache(maxsize=4096)
def landmark(name: str) -> Landmark | None:
    """Return the place that a marker's name means in the usual sets, or None.

    A subject before a colon ("Anna:LHEE"), a number at the end (LCAL1) and signs between the
    letters count for nothing; the side may stand first or last.
    """
    own = name.rsplit(":", 1)[-1].strip()
    if _NO_PLACE.search(own):
        return None
    plain = re.sub(r"[\s_.\-]+", "", re.sub(r"(?<=[a-z])(?=[A-Z])", "_", own)).casefold()
    for (kind, short), stems in _STEMS.items():
        number = r"\d?" if kind == HEEL else ""
        if not short and re.fullmatch(rf"(?:{stems}){number}", plain):
            return Landmark(kind)
        for side, words in _SIDES.items():
            pattern = rf"(?:{words})(?:{stems}){number}|(?:{stems}){number}(?:{words})"
            if re.fullmatch(pattern, plain):
                return Landmark(kind, side, short)
    kinds = (kind for kind, words in _WORDS.items() if words.search(own))
    return next((Landmark(kind, _side_of(own)) for kind in kinds), None)


def _side_of(name: str) -> str:
    words = re.split(r"[\s_.\-]+", re.sub(r"(?<=[a-z])(?=[A-Z])", "_", name).casefold())
    for side, each in _SIDES.items():
        if any(re.fullmatch(each, word) for word in words):
            return side
    return {"l": "left", "r": "right"}.get(words[0][0], "")


def own_landmarks(
    table: Mapping[str, str], names: Iterable[str], *, where: str
) -> dict[str, Landmark]:
    """Return the markers of a recording that a laboratory's own table names, with their places.

    ``table``: a marker's name and one of ``LANDMARKS`` ("Fuss_h_li" = "left heel"). A recording may
    lack some of the names, not all of those of one place: that is a DataError.
    """
    present = list(names)
    found: dict[str, Landmark] = {}
    for name, place in table.items():
        if name in present:
            side, _, kind = place.rpartition(" ")
            found[name] = Landmark(kind, side)
    for place in dict.fromkeys(table.values()):
        called = [name for name, one in table.items() if one == place]
        if not any(name in found for name in called):
            raise DataError(
                Message(
                    "no marker is called {name}, the {part} of the profile",
                    name=" or ".join(called),
                    part=place,
                ),
                where=where,
                allowed=", ".join(present[:12]) or "the recording has no markers",
                nearest=nearest_match(called[0], present),
                remedy="Name the marker under [landmarks] in profile.toml",
            )
    return found


def heel_candidates(
    trial: Trial, landmarks: Mapping[str, str] | None = None, up: np.ndarray | None = None
) -> dict[str, list[str]]:
    """Return the markers that may be heels by side: ``left``, ``right``, ``unknown``.

    ``landmarks``: a laboratory's own names with their places ("left heel"), which win; see
    ``own_landmarks`` for the DataError. The best-seen candidates come first. Names of two or three
    letters count with ``up`` alone, the vertical (3,), where they lie lowest.
    """
    return _by_side(trial, HEEL, landmarks, up)


def toe_candidates(
    trial: Trial, landmarks: Mapping[str, str] | None = None, up: np.ndarray | None = None
) -> dict[str, list[str]]:
    """Return the markers that may be toes by side, as ``heel_candidates`` does."""
    return _by_side(trial, TOE, landmarks, up)


def pelvis_markers(trial: Trial, landmarks: Mapping[str, str] | None = None) -> dict[str, str]:
    """Return the side of each marker of the pelvis by its name: left, right or empty."""
    own = own_landmarks(landmarks or {}, trial.markers, where=trial.name)
    found = {name: own.get(name) or landmark(name) for name in trial.markers}
    own_ones = {name for name, place in own.items() if place.kind == PELVIS}
    return {
        name: place.side
        for name, place in found.items()
        if place is not None and place.kind == PELVIS and (not own_ones or name in own_ones)
    }


def _by_side(
    trial: Trial, kind: str, landmarks: Mapping[str, str] | None, up: np.ndarray | None
) -> dict[str, list[str]]:
    names_by_side: dict[str, list[str]] = {"left": [], "right": [], "unknown": []}
    own, ranks = own_landmarks(landmarks or {}, trial.markers, where=trial.name), {}
    given = {place.side for place in own.values() if place.kind == kind}
    for name, marker in trial.markers.items():
        place = own.get(name) or landmark(name)
        if place is None or place.kind != kind or marker.missing.all():
            continue
        if name not in own and (place.side in given or (place.short and not _low(trial, name, up))):
            continue
        ranks[name] = place.short, int(marker.missing.sum())
        names_by_side[place.side or "unknown"].append(name)
    for names in names_by_side.values():
        names.sort(key=ranks.__getitem__)
    return names_by_side


def _low(trial: Trial, name: str, up: np.ndarray | None) -> bool:
    """Whether a marker comes as low as the lowest of them."""
    if up is None:
        return False
    lowest = {key: _lowest(marker, tuple(up.tolist())) for key, marker in trial.markers.items()}
    return lowest[name] < np.nanmin(list(lowest.values())) + _LOW


@once_a_record
def _lowest(marker: Marker, up: tuple[float, ...]) -> float:
    seen = (marker.positions @ np.array(up))[~marker.missing]
    return float(np.percentile(seen, 1)) if len(seen) else math.nan


def checked_landmark(place: object, where: str) -> str:
    """Return the place of a laboratory's table; an unknown one is an InputError."""
    if not isinstance(place, str):
        raise InputError(
            Message("{place} is no place", place=repr(place)),
            where=where,
            allowed=", ".join(LANDMARKS),
        )
    if place not in LANDMARKS:
        raise unknown_name("place of a marker", place, LANDMARKS, where=where)
    return place
