"""Profile files: a small TOML that says what a laboratory's columns, axes and markers mean."""

import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, TypeVar

from underfoot.core import InputError, nearest_match, to_si
from underfoot.core.remark import Message

from ..recording.marker_names import checked_landmark
from ..recording.tester_calibration import TesterCalibration
from ..recording.trial import PlateAccuracy
from .text import force_unit, known_units, si_unit

T = TypeVar("T")
_DIRECTIONS = ("x", "y", "z", "+x", "+y", "+z", "-x", "-y", "-z")
# Tables of a profile with the keys they may have; none: any key, as the laboratory's own names.
_PARTS: dict[str, tuple[str, ...]] = {
    "file": tuple(
        "delimiter header_line sheet rate time time_unit length_unit subtract_baseline".split()
    ),
    "channels": (),
    "plates": (),
    "markers": (),
    "axes": ("vertical", "walking"),
    "heel": ("left", "right"),
    "landmarks": (),
    "subject": ("mass",),
    "sensors": (),
    "accuracy": ("gain", "crosstalk", "source"),
}


@dataclass(frozen=True, slots=True)
class PlateColumns:
    """Columns of one force plate in a table; an empty name in ``force`` means no such channel."""

    force: tuple[str, str, str]
    unit: str = ""
    force_is: str = "on the foot"
    sign: tuple[float, float, float] = (1.0, 1.0, 1.0)
    centre_of_pressure: tuple[str, str, str] | None = None
    moment: tuple[str, str, str] | None = None
    length_unit: str = "m"
    corners: tuple[tuple[float, float, float], ...] | None = None


@dataclass(frozen=True, slots=True)
class TrialsProfile:
    """What a profile file says; every part is optional.

    See ``docs/guide/trials_reading.md`` for the file. ``landmarks``: the laboratory's own names of
    markers with their places ("left heel"). ``calibration`` is the record of the tester,
    which stands in a file of its own.
    """

    name: str = ""
    delimiter: str | None = None
    header_line: int | None = None
    sheet: str | None = None
    rate: float | None = None
    time: str | None = None
    time_unit: str | None = None
    length_unit: str | None = None
    subtract_baseline: bool = True
    channels: Mapping[str, tuple[str, str, float]] = field(default_factory=dict)
    plates: Mapping[str, PlateColumns] = field(default_factory=dict)
    markers: Mapping[str, tuple[tuple[str, str, str], str]] = field(default_factory=dict)
    vertical: str | None = None
    walking: str | None = None
    landmarks: Mapping[str, str] = field(default_factory=dict)
    body_mass: float | None = None
    sensors: Mapping[str, tuple[float, float, float]] = field(default_factory=dict)
    accuracy: PlateAccuracy | None = None
    calibration: TesterCalibration | None = None


def read_profile(path: Path) -> TrialsProfile:
    """Return the profile in a TOML file.

    InputError: not TOML, an unknown key or unit, a wrong type; names the key and the nearest match.
    """
    path = Path(path)
    try:
        data = tomllib.loads(path.read_bytes().decode("utf-8-sig"))
    except OSError as error:
        raise InputError(
            Message("can't read the profile: {strerror}", strerror=error.strerror), where=str(path)
        ) from error
    except (UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise InputError(
            Message("the profile is not valid TOML: {error}", error=error), where=str(path)
        ) from error
    return profile_from(data, where=path.name)


def profile_from(data: Mapping[str, Any], *, where: str = "profile") -> TrialsProfile:
    """Return the profile in plain data (the parsed TOML); errors as ``read_profile``."""
    _check_keys(data, ("name", *_PARTS), where)
    parts = {name: _part(data, name, keys, where) for name, keys in _PARTS.items()}
    file, axes, subject = parts["file"], parts["axes"], parts["subject"]
    for key, axis in axes.items():
        if axis not in _DIRECTIONS:
            allowed = ", ".join(_DIRECTIONS)
            raise InputError(
                Message('"{axis}" is no axis', axis=axis),
                where=f"{where}.axes.{key}",
                allowed=allowed,
            )
    header = file.get("header_line")
    if header is not None and (not isinstance(header, int) or header < 1):
        raise InputError(
            Message("{header} is no line number", header=repr(header)),
            where=f"{where}.file.header_line",
        )

    def each(name: str, read: Callable[[object, str], T]) -> dict[str, T]:
        return {str(key): read(v, f"{where}.{name}.{key}") for key, v in parts[name].items()}

    return TrialsProfile(
        name=str(data.get("name", "")),
        delimiter=_text(file, "delimiter", where),
        sheet=_text(file, "sheet", where),
        time=_text(file, "time", where),
        time_unit=_text(file, "time_unit", where),
        length_unit=(
            _unit(file["length_unit"], "m", f"{where}.file.length_unit")
            if "length_unit" in file
            else None
        ),
        header_line=header,
        rate=_quantity(file, "rate", "Hz", f"{where}.file"),
        subtract_baseline=bool(file.get("subtract_baseline", True)),
        channels=each("channels", _channel),
        plates=each("plates", _plate),
        markers=each("markers", _marker),
        vertical=axes.get("vertical"),
        walking=axes.get("walking"),
        landmarks={
            **{str(name): f"{side} heel" for side, name in parts["heel"].items()},
            **each("landmarks", checked_landmark),
        },
        body_mass=_quantity(subject, "mass", "kg", f"{where}.subject"),
        sensors=_sensors(parts["sensors"], f"{where}.sensors"),
        accuracy=_accuracy(parts["accuracy"], f"{where}.accuracy"),
    )


def _check_keys(data: Mapping[str, Any], allowed: tuple[str, ...], where: str) -> None:
    for key in data:
        if key not in allowed:
            raise InputError(
                Message('unknown key "{key}"', key=key),
                where=where,
                allowed=", ".join(allowed),
                nearest=nearest_match(str(key), allowed),
            )


def _part(
    data: Mapping[str, Any], key: str, allowed: tuple[str, ...], where: str
) -> Mapping[str, Any]:
    part = data.get(key, {})
    if not isinstance(part, Mapping):
        raise InputError(
            Message("{part} is not a table", part=repr(part)),
            where=f"{where}.{key}",
            allowed=f"[{key}]",
        )
    if allowed:
        _check_keys(part, allowed, f"{where}.{key}")
    return part


def _text(data: Mapping[str, Any], key: str, where: str) -> str | None:
    value = data.get(key)
    if value is not None and not isinstance(value, str):
        raise InputError(
            Message("{given} is not text", given=repr(value)), where=f"{where}.file.{key}"
        )
    return value


def _unit(text: object, dimension: str, where: str) -> str:
    read = force_unit if dimension == "N" else si_unit
    unit = read(text) if isinstance(text, str) else None
    if unit is None or (dimension and unit[0] != dimension):
        what = Message("{given} is no known unit", given=repr(text))
        if dimension:
            what = Message("{given} is no known unit of {unit}", given=repr(text), unit=dimension)
        raise InputError(
            what,
            where=where,
            nearest=nearest_match(str(text), known_units(dimension)),
        )
    return str(text)


def _quantity(data: Mapping[str, Any], key: str, unit: str, where: str) -> float | None:
    if key not in data:
        return None
    number = to_si(data[key], unit, where=f"{where}.{key}")
    if number <= 0:
        raise InputError(
            Message("{value} is not positive", value=repr(data[key])), where=f"{where}.{key}"
        )
    return number


def _channel(value: object, where: str) -> tuple[str, str, float]:
    if not isinstance(value, Mapping) or not isinstance(value.get("column"), str):
        raise InputError("a channel needs its column", where=where, allowed='column = "P1"')
    _check_keys(value, ("column", "unit", "scale"), where)
    unit = _unit(value["unit"], "", f"{where}.unit") if "unit" in value else ""
    scale = value.get("scale", 1.0)
    if not _is_number(scale):
        raise InputError(Message("{name} is no number", name=repr(scale)), where=f"{where}.scale")
    return value["column"], unit, float(scale)


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _three(value: object, where: str) -> tuple[str, str, str]:
    if not isinstance(value, list) or len(value) != 3 or not all(isinstance(v, str) for v in value):
        raise InputError(
            Message("{given} are not three column names", given=repr(value)), where=where
        )
    return value[0], value[1], value[2]


def _numbers(value: object, where: str) -> tuple[float, float, float]:
    if not isinstance(value, list) or len(value) != 3 or not all(map(_is_number, value)):
        raise InputError(Message("{given} are not three numbers", given=repr(value)), where=where)
    return float(value[0]), float(value[1]), float(value[2])


def _plate(value: object, where: str) -> PlateColumns:
    if not isinstance(value, Mapping):
        raise InputError("a plate needs its force columns", where=where)
    _check_keys(value, (*PlateColumns.__dataclass_fields__, "friction", "normal"), where)
    force = _force_columns(value, where)
    force_is = value.get("force_is", "on the foot")
    if force_is not in ("on the foot", "on the plate"):
        allowed = '"on the foot" or "on the plate"'
        raise InputError(f"{force_is!r}", where=f"{where}.force_is", allowed=allowed)
    corners = value.get("corners")
    if corners is not None and (not isinstance(corners, list) or len(corners) != 4):
        raise InputError("a plate has four corners", where=f"{where}.corners")
    three = {
        key: _three(value[key], f"{where}.{key}")
        for key in ("centre_of_pressure", "moment")
        if key in value
    }
    return PlateColumns(
        force,
        unit=_unit(value["unit"], "N", f"{where}.unit") if "unit" in value else "",
        force_is=force_is,
        sign=_numbers(value.get("sign", [1, 1, 1]), f"{where}.sign"),
        length_unit=_unit(value.get("length_unit", "m"), "m", f"{where}.length_unit"),
        corners=tuple(_numbers(c, f"{where}.corners") for c in corners) if corners else None,
        **three,
    )


def _force_columns(value: Mapping[str, Any], where: str) -> tuple[str, str, str]:
    """Return the columns of x, y, z; ``friction`` and ``normal`` are a machine's x and z."""
    two = {"friction", "normal"} & set(value)
    if ("force" in value) == bool(two):
        allowed = 'force = ["Fx", "Fy", "Fz"], or friction = "..." and normal = "..."'
        raise InputError("a plate needs its force columns", where=where, allowed=allowed)
    if two:
        names = [value.get("friction"), "", value.get("normal")]
        if not all(isinstance(name, str) for name in names) or not (names[0] and names[2]):
            raise InputError("friction and normal are two columns, both named", where=where)
        force = _three(names, where)
    else:
        force = _three(value["force"], f"{where}.force")
    columns = [name for name in force if name]
    if len(set(columns)) < len(columns):
        twice = next(name for name in columns if columns.count(name) > 1)
        raise InputError(
            Message(
                'the column "{twice}" is named twice: its force would count twice', twice=twice
            ),
            where=where,
            remedy='Leave a missing channel empty, or write friction = "..." and normal = "..."',
        )
    return force


def with_channels(
    profile: TrialsProfile, friction: str, normal: str, *, where: str
) -> TrialsProfile:
    """Return the profile with the two channels of a tester that a protocol names."""
    if not friction and not normal:
        return profile
    if profile.plates:
        words = "the protocol and the profile both name force columns"
        raise InputError(words, where=where, remedy="Name them in one place")
    columns = _plate({"friction": friction, "normal": normal}, where)
    return replace(profile, plates={"tester": columns})


def _marker(value: object, where: str) -> tuple[tuple[str, str, str], str]:
    if not isinstance(value, Mapping) or "columns" not in value:
        raise InputError("a marker needs its three columns", where=where)
    _check_keys(value, ("columns", "unit"), where)
    unit = _unit(value.get("unit", "m"), "m", f"{where}.unit")
    return _three(value["columns"], f"{where}.columns"), unit


def _accuracy(part: Mapping[str, Any], where: str) -> PlateAccuracy | None:
    """Specification of the plates: gain and crosstalk as shares ("0.5 %"), and its source."""
    if not part:
        return None
    shares = {
        key: to_si(part[key], "1", where=f"{where}.{key}")
        for key in ("gain", "crosstalk")
        if key in part
    }
    return PlateAccuracy(**shares, source=str(part.get("source", "profile")))


def _sensors(part: Mapping[str, Any], where: str) -> dict[str, tuple[float, float, float]]:
    unit = si_unit(_unit(part.get("unit", "m"), "m", f"{where}.unit"))
    factor = unit[1] if unit else 1.0
    found = {}
    for name, value in part.items():
        if name != "unit":
            x, y, z = _numbers(value, f"{where}.{name}")
            found[str(name)] = (x * factor, y * factor, z * factor)
    return found
