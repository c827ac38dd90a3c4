"""A place as its file describes it: floors, fluids, shoes and people."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from underfoot.case import Case
from underfoot.case import text as toml
from underfoot.case.surfaces import STEEPEST_RAMP
from underfoot.core import InputError, RangeError, to_si, unknown_name
from underfoot.core.catalogue import Catalogue
from underfoot.core.remark import Message, Remark
from underfoot.friction.shoe_class import ShoeClass, shoe_class, slip_tests

from .calibration import FloorReading
from .joint import CofReading, check_kind
from .machines import machine

ANY_ROUGHNESS = {"rq": {"value": "1.73 um", "uncertainty": "1.91 um"}}
"""``ANY_FLOOR_RQ`` as a case writes it."""
LEAST_REGION, MOST_REGION = 2e-3, 90e-3
"""Sides (m) of a worn region: below, no tread is gone; above, it is larger than a heel."""
MOTION = "whole_shoe_g6"
"""The setting of the slip tester whose friction the slip model was fitted to."""
KEYS = {
    "": ("name", "people", "fluids", "floor", "shoe"),
    "people": ("rcof_mean", "rcof_sd", "steps_per_day", "days_per_year", "task", "reported_slips"),
    "people.task": ("name", "share", "rcof"),
    "floor": ("name", "from", "area", "slope", "rz", "roughness", "fluids", "reading"),
    "floor.reading": ("machine", "value", "kind", "sd", "fluid"),
    "shoe": (
        "name", "from", "class", "present", "price", "months", "wear_per_month",
        "worn_region", "reading", "material", "roughness", "heel", "tread", "sole", "outsole",
        "wear",
    ),
    "shoe.reading": ("test", "cof", "kind", "sd"),
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class ShoeReading:
    """COF of a sole in one of the tests of certificates."""

    test: str
    reading: CofReading


@dataclass(frozen=True, slots=True)
class PlaceFloor:
    """A floor: ``share`` of the steps, slope in rad, share of the steps under each fluid."""

    name: str
    section: Mapping[str, Any]
    share: float
    slope: float
    known: bool
    fluids: Mapping[str, float]
    readings: tuple[FloorReading, ...]


@dataclass(frozen=True, slots=True)
class PlaceShoe:
    """A shoe; ``wear_depth`` (m) is worn off when it is replaced after ``months``.

    ``worn_region`` is length and width (m) of the heel without tread that a ruler finds today.
    """

    name: str
    section: Mapping[str, Any]
    present: bool
    price: float | None
    months: float | None
    wear_depth: float
    worn_region: tuple[float, float] | None
    known_class: ShoeClass | None
    readings: tuple[ShoeReading, ...]


@dataclass(frozen=True, slots=True)
class Task:
    """What people do: share of the steps, and the mean friction it needs."""

    name: str
    share: float
    rcof: float


@dataclass(frozen=True, slots=True)
class Place:
    """A place with everything that the choice depends on.

    ``steps`` of a worker in a day; ``reported`` slips per 100 workers and year of today.
    Files of shoes and floors count from ``folder``, that of the place's file.
    """

    name: str
    floors: tuple[PlaceFloor, ...]
    shoes: tuple[PlaceShoe, ...]
    tasks: tuple[Task, ...]
    rcof_sd: float
    steps: float
    assumed: tuple[str, ...]
    reported: float | None = None
    folder: Path | None = None

    @property
    def wet_share(self) -> float:
        """Share of the steps that are in a fluid."""
        return sum(
            floor.share * often
            for floor in self.floors
            for fluid, often in floor.fluids.items()
            if fluid != "dry"
        )

    @property
    def wet_steps(self) -> float:
        """Steps of a worker in a day that are in a fluid."""
        return self.steps * self.wet_share

    def fluids(self) -> tuple[str, ...]:
        """Return every fluid of the place once, in alphabetical order."""
        return tuple(sorted({fluid for floor in self.floors for fluid in floor.fluids} - {"dry"}))

    def case(self, shoe: PlaceShoe, floor: PlaceFloor, fluid: str, worn: bool = False) -> Case:
        """Return the case of a shoe on a floor under a fluid, as the slip tester slides it."""
        section, slope = dict(shoe.section), f"{floor.slope!r} rad"
        if worn and shoe.worn_region is not None:
            depth = self.case(shoe, floor, fluid).value("shoe.tread.depth")
            if not depth:
                raise InputError(
                    "a sole without tread has no worn region",
                    where=f"shoe {shoe.name}.worn_region",
                    remedy="Name the sole with the tread that it had when new",
                )
            along, across = (f"{1e3 * side:.6g} mm" for side in shoe.worn_region)
            size = {"patch_length": along, "patch_width": across}
            section["wear"] = {"mode": "patch", "depth": f"{1e3 * depth:.6g} mm", **size}
        elif worn:
            section["wear"] = {"depth": f"{1e3 * shoe.wear_depth:.6g} mm", "angle": "7 deg"}
        return Case.from_mapping(
            {
                "name": f"{shoe.name} on {floor.name}, {fluid}",
                "shoe": section,
                "floor": {**floor.section, **({"slope": slope} if floor.slope else {})},
                "contaminant": fluid,
                "motion": MOTION,
                "friction": {"model": "pair"},
                "numerics": {"tread_positions": 1},
            },
            folder=self.folder,
        )


def fluid_name(entry: str) -> str:
    """Return the title of a fluid of the catalogue as it stands within a sentence."""
    title = Catalogue.load().entry("fluid", entry).title
    return title if title[1:2].isupper() else title[:1].lower() + title[1:]  # SAE stays SAE


def read_place(path: Path) -> Place:
    """Return the place of a file.

    Raises:
        InputError: No such file; an unknown key; shares that do not add to 1; a floor, shoe or
            reading that cannot be.
    """
    return place_of(
        toml.parse_toml(toml.read_text(path), str(path)), name=path.stem, folder=path.parent
    )


def place_of(table: Mapping[str, Any], name: str = "place", folder: Path | None = None) -> Place:
    """Return the place of the contents of a file in ``folder``; raises as ``read_place``."""
    _check_keys(table, "", "")
    assumed: list[str] = []
    common = _shares(table.get("fluids"), "fluids") if "fluids" in table else None
    entries = _tables(table, "floor")
    floors = tuple(_floor(entry, common, assumed) for entry in entries)
    shoes = tuple(_shoe(each) for each in _tables(table, "shoe"))
    _share_steps(entries, assumed)
    if common is not None and all("fluids" in entry for entry in entries):
        remedy = "Leave these out, or those of the floors"
        raise InputError("each floor has its own", where="fluids", remedy=remedy)
    today = [shoe.name for shoe in shoes if shoe.present]
    if len(today) > 1:
        raise InputError(
            Message("{count} shoes: {today}", count=len(today), today=", ".join(today)),
            where="shoe.present",
            allowed="one shoe, with which changes are compared",
        )
    for kind, each in (("floor", floors), ("shoe", shoes)):
        names = [one.name for one in each]
        twice = next((one for one in names if names.count(one) > 1), None)
        if twice is not None:
            what = Message('"{name}" stands twice', name=twice)
            raise InputError(what, where=kind, allowed="one name each")
    area = sum(floor.share for floor in floors)
    floors = tuple(
        PlaceFloor(
            each.name, each.section, each.share / area, each.slope, each.known, each.fluids,
            each.readings,
        )
        for each in floors
    )  # fmt: skip
    if all(set(floor.fluids) == {"dry"} for floor in floors):
        raise InputError(
            "every floor is dry",
            where="fluids",
            allowed="a fluid on some steps",
            remedy="On dry, clean floors no shoe can be told from another by this model",
        )
    people = table.get("people", {})
    _check_keys(people, "people", "people")
    mean = _number(people, "rcof_mean", "people", 0.20, (0.05, 0.6))
    steps = _number(people, "steps_per_day", "people", 8000.0, (1, 1e5))
    if "days_per_year" in people:  # files of 0.2 have it
        _number(people, "days_per_year", "people", 220.0, (1, 366))
        assumed.append("people.days_per_year: no number of the choice hangs on it")
    if "steps_per_day" not in people:
        assumed.append("people.steps_per_day: not given; 8000 assumed")
    named = _table_list(people, "task", "people")
    tasks = tuple(_task(each, mean) for each in named) or (Task("walking", 1.0, mean),)
    of_tasks = all("rcof" in each for each in named or [{}])
    if "rcof_mean" in people and of_tasks:
        remedy = "Leave it out, or the rcof of the tasks that need no more than the mean"
        raise InputError("each task has its own rcof", where="people.rcof_mean", remedy=remedy)
    if "rcof_mean" not in people and not of_tasks:
        assumed.append("people.rcof_mean: not given; 0.20 of adults who walk straight on the level")
    if "rcof_sd" not in people:
        assumed.append("people.rcof_sd: not given; 0.03 between steps assumed")
    _adds_to_one([task.share for task in tasks], "people.task", "")
    place = Place(
        str(table.get("name", name)),
        floors,
        shoes,
        tasks,
        _number(people, "rcof_sd", "people", 0.03, (0.001, 0.2)),
        steps,
        tuple(assumed),
        _number(people, "reported_slips", "people", 0.0, (0.0, 1e6))
        if "reported_slips" in people
        else None,
        folder,
    )
    _check_cases(place)
    return place


def _share_steps(floors: Sequence[Mapping[str, Any]], assumed: list[str]) -> None:
    """Say how steps are shared between floors without areas; refuse areas of some of them."""
    without = [floor["name"] for floor in floors if "area" not in floor]
    if without and len(without) < len(floors):
        raise InputError(
            "is missing, other floors have one",
            where=f"floor {without[0]}.area",
            allowed="the area of each floor in one unit, or of none",
        )
    if without and len(floors) > 1:
        assumed.append("floor.area: not given; each floor has as many steps")


def _check_cases(place: Place) -> None:
    """Refuse what no case can hold, at the shoe or floor of the place that it stands in."""
    first, fluid = place.shoes[0], place.fluids()[0]
    wanted = [(first, floor, each) for floor in place.floors for each in floor.fluids]
    wanted += [(shoe, place.floors[0], fluid) for shoe in place.shoes[1:]]
    for shoe, floor, each in wanted:
        try:
            wet = fluid if each == "dry" else each
            place.case(shoe, floor, wet, shoe.worn_region is not None)
        except InputError as error:
            section, _, rest = (error.where or "").partition(".")
            rest = f".{rest}" if rest else ""
            owner = {"floor": f"floor {floor.name}{rest}", "shoe": f"shoe {shoe.name}{rest}"}
            owner["contaminant"] = f"floor {floor.name}.fluids"
            parts = {**error.parts, "where": owner.get(section, error.where)}
            raise InputError(error.what, **parts) from error


def _tables(table: Mapping[str, Any], key: str) -> Sequence[Mapping[str, Any]]:
    entries = table.get(key)
    if not isinstance(entries, list) or not entries:
        raise InputError(
            "is missing",
            where=key,
            allowed=f"tables [[{key}]]",
            remedy=Message("Write [[{key}]] and name", key=key),
        )
    for number, entry in enumerate(entries, start=1):
        _check_keys(entry, key, f"{key} {number}")
        if not isinstance(entry.get("name"), str) or not entry["name"].strip():
            raise InputError("is missing", where=f"{key} {number}.name", allowed="a name")
    return entries


def _table_list(table: Mapping[str, Any], key: str, where: str) -> Sequence[Any]:
    """Return a list of tables within one; one table by itself is refused as such."""
    entries = table.get(key, [])
    if not isinstance(entries, list):
        allowed = "a list of tables, as [{ ... }]"
        raise InputError(f"{entries!r}", where=f"{where}.{key}", allowed=allowed)
    return entries


def _check_keys(table: Any, section: str, where: str) -> None:
    if not isinstance(table, Mapping):
        raise InputError(Message("{entry} is no table", entry=repr(table)), where=where or "PLACE")
    for key in table:
        if key not in KEYS[section]:
            raise unknown_name("key", key, KEYS[section], where=where or "PLACE")


def _number(
    table: Mapping[str, Any], key: str, where: str, usual: float, ends: tuple[float, float]
) -> float:
    value = table.get(key, usual)
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise InputError(f"{value!r}", where=f"{where}.{key}", allowed="a number")
    if not ends[0] <= value <= ends[1]:
        allowed = f"{ends[0]:g} to {ends[1]:g}"
        raise RangeError(f"{value:g}", where=f"{where}.{key}", allowed=allowed)
    return float(value)


def _shares(table: Any, where: str) -> Mapping[str, float]:
    if not isinstance(table, Mapping) or not table:
        raise InputError(
            f"{table!r}", where=where, allowed="shares of the steps, as { dry = 0.9, water = 0.1 }"
        )
    shares = {name: _number(table, name, where, 0.0, (0.0, 1.0)) for name in table}
    _adds_to_one(list(shares.values()), where, "A share named dry takes what no fluid has")
    return {name: share for name, share in sorted(shares.items()) if share > 0}


def _adds_to_one(shares: Sequence[float], where: str, remedy: str) -> None:
    if abs(sum(shares) - 1) > 0.005:
        raise InputError(
            Message("the shares add to {sum:.3g}", sum=sum(shares)),
            where=where,
            allowed="shares of all steps, which add to 1",
            remedy=remedy or None,
        )


def _task(entry: Any, mean: float) -> Task:
    _check_keys(entry, "people.task", "people.task")
    name = str(entry.get("name", "task"))
    where = f"people.task {name}"
    return Task(
        name,
        _number(entry, "share", where, 1.0, (0.0, 1.0)),
        _number(entry, "rcof", where, mean, (0.05, 0.6)),
    )


def _floor(
    entry: Mapping[str, Any], common: Mapping[str, float] | None, assumed: list[str]
) -> PlaceFloor:
    name = entry["name"]
    where = f"floor {name}"
    fluids = _shares(entry["fluids"], f"{where}.fluids") if "fluids" in entry else common
    if fluids is None:
        raise InputError(
            "is missing", where=f"{where}.fluids", allowed="shares, or [fluids] of all"
        )
    slope = to_si(entry.get("slope", "0 deg"), "rad", where=f"{where}.slope")
    if not 0 <= slope <= STEEPEST_RAMP:
        raise RangeError(
            Message(
                "{degrees:.3g} deg is no floor that people walk on as on the level",
                degrees=math.degrees(slope),
            ),
            where=f"{where}.slope",
            allowed=Message("0 deg to {degrees:.0f} deg", degrees=math.degrees(STEEPEST_RAMP)),
            remedy="Stairs and steeper ramps need their own required friction",
        )
    section: dict[str, Any] = {key: entry[key] for key in ("from", "roughness") if key in entry}
    if "rz" in entry:
        if "roughness" in entry:
            remedy = "Give the one that was measured"
            raise InputError("stands beside roughness", where=f"{where}.rz", remedy=remedy)
        section["roughness"] = {"rz": entry["rz"]}
        assumed.append(Message("{where}.roughness: Rq is Rz over 4 to 8", where=where))
    readings = tuple(
        _floor_reading(each, f"{where}.reading {number}")
        for number, each in enumerate(_table_list(entry, "reading", where), start=1)
    )
    if not section and not readings:
        assumed.append(
            Remark(where, "neither roughness nor reading; it was drawn over all usual floors")
        )
    share = _number(entry, "area", where, 1.0, (1e-9, 1e9))
    known = bool(section or readings)
    if not section:
        section["roughness"] = ANY_ROUGHNESS if readings else {}
    return PlaceFloor(name, section, share, slope, known, fluids, readings)


def _floor_reading(entry: Any, where: str) -> FloorReading:
    _check_keys(entry, "floor.reading", where)
    device = machine(str(entry.get("machine", "")), f"{where}.machine")
    fluid = device.fluid_of_standard(str(entry.get("fluid", "")), f"{where}.fluid")
    if "value" not in entry:
        raise InputError("is missing", where=f"{where}.value", allowed="what the machine printed")
    value = device.check_reading(entry["value"], f"{where}.value")
    kind = str(entry.get("kind", "value"))
    spread = _number(entry, "sd", where, 0.0, (1e-6, device.most)) if "sd" in entry else None
    check_kind(kind, f"{where}.kind")
    return FloorReading(device, fluid, value, kind, spread)


def _shoe(entry: Mapping[str, Any]) -> PlaceShoe:
    name = entry["name"]
    where = f"shoe {name}"
    own = {
        "name", "class", "present", "price", "months", "wear_per_month", "worn_region", "reading",
    }  # fmt: skip
    section = {key: value for key, value in entry.items() if key not in own}
    months = _number(entry, "months", where, 0.0, (0.1, 240)) if "months" in entry else None
    rate = 0.0
    if "wear_per_month" in entry:
        rate = to_si(entry["wear_per_month"], "m", where=f"{where}.wear_per_month")
        if months is None:
            raise InputError(
                "is missing", where=f"{where}.months", allowed="months in use until it is replaced"
            )
        if not 0 < rate * months < 20e-3:
            raise RangeError(
                Message("{rate:.3g} mm worn off", rate=1000.0 * rate * months),
                where=f"{where}.wear_per_month",
                allowed="above 0, below 20 mm in all its months",
            )
    region = _worn_region(entry, where) if "worn_region" in entry else None
    if "wear" in entry and (rate or region):
        raise InputError(
            "stands beside wear_per_month or worn_region",
            where=f"{where}.wear",
            remedy="Give the tread that is left (tread.depth), and its wear from then on",
        )
    readings = []
    for number, each in enumerate(_table_list(entry, "reading", where), start=1):
        at = f"{where}.reading {number}"
        _check_keys(each, "shoe.reading", at)
        test = str(each.get("test", ""))
        if test not in slip_tests():
            raise unknown_name("test", test, slip_tests(), where=f"{at}.test")
        if "cof" not in each:
            raise InputError("is missing", where=f"{at}.cof", allowed="the COF of the certificate")
        cof = _number(each, "cof", at, 0.0, (0.01, 2.0))
        sd = _number(each, "sd", at, 0.0, (1e-6, 2.0)) if "sd" in each else None
        kind = str(each.get("kind", "value"))
        check_kind(kind, f"{at}.kind")
        readings.append(ShoeReading(test, CofReading(cof, kind, sd)))
    known = shoe_class(str(entry["class"]), f"{where}.class") if "class" in entry else None
    present = entry.get("present", False)
    if not isinstance(present, bool):
        raise InputError(f"{present!r}", where=f"{where}.present", allowed="true or false")
    return PlaceShoe(
        name,
        section,
        present,
        _number(entry, "price", where, 0.0, (0.0, 1e5)) if "price" in entry else None,
        months,
        rate * (months or 0.0),
        region,
        known,
        tuple(readings),
    )


def _worn_region(entry: Mapping[str, Any], where: str) -> tuple[float, float]:
    at, given = f"{where}.worn_region", entry["worn_region"]
    if not isinstance(given, list) or len(given) != 2:
        allowed = 'length along and width across the shoe, as ["30 mm", "25 mm"]'
        raise InputError(f"{given!r}", where=at, allowed=allowed)
    if "wear_per_month" in entry:
        remedy = "Give the one that you measured"
        raise InputError("stands beside wear_per_month", where=at, remedy=remedy)
    length, width = (to_si(side, "m", where=at) for side in given)
    for side in (length, width):
        if not LEAST_REGION <= side <= MOST_REGION:
            ends = Message(
                "{least:g} mm to {most:g} mm", least=1e3 * LEAST_REGION, most=1e3 * MOST_REGION
            )
            raise RangeError(f"{1e3 * side:g} mm", where=at, allowed=ends)
    return length, width


def same_shoe(first: PlaceShoe, second: PlaceShoe) -> bool:
    """Return whether two shoes differ in name and price alone."""
    parts = ("section", "wear_depth", "worn_region", "known_class", "readings")
    return all(getattr(first, part) == getattr(second, part) for part in parts)
