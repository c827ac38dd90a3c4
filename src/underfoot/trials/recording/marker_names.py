"""What markers are called: heels, toes and the pelvis in the usual sets, with their side.

Names as their sets have them: Plug-in Gait (LHEE, LTOE, LASI, LPSI), CAST and IOR (L_FCC or LCA,
L_FM2, L_IAS, L_IPS), Helen Hayes and Vaughan (L.Heel, V.Sacral), Rizzoli and Oxford foot (CA, LPCA,
LHLX), OpenSim and Rajagopal (R.ASIS, RCAL, RTOE), Qualisys (LHeelBack), German and French words
(from the sets' own pages and recordings that name them so; from memory where none was at hand).
"""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import lru_cache

from underfoot.core import DataError, InputError, nearest_match, unknown_name

HEEL, TOE, PELVIS = "heel", "toe", "pelvis"
LANDMARKS = ("left heel", "right heel", "left toe", "right toe", "left pelvis", "right pelvis",
             "pelvis")  # fmt: skip
"""What an own name may stand for."""


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
                f"no marker is called {' or '.join(called)}, the {place} of the profile",
                where=where,
                allowed=", ".join(present[:12]) or "the recording has no markers",
                nearest=nearest_match(called[0], present),
                remedy="Name the marker under [landmarks] in profile.toml",
            )
    return found


def checked_landmark(place: object, where: str) -> str:
    """Return the place of a laboratory's table; an unknown one is an InputError."""
    if not isinstance(place, str):
        raise InputError(f"{place!r} is no place", where=where, allowed=", ".join(LANDMARKS))
    if place not in LANDMARKS:
        raise unknown_name("place of a marker", place, LANDMARKS, where=where)
    return place
