"""What an answer was when somebody last looked at it: any value, page or file as lines of text.

``file_regression`` (pytest-regressions) keeps the lines beside the test, and ``pytest --regen-all``
with its path writes them anew: the difference in the repository is what a change did. Numbers
compare as numbers, since another processor rounds otherwise.
"""

import dataclasses
import json
import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence, Set
from enum import Enum
from pathlib import Path, PurePath
from typing import Any

import numpy as np
import pandas as pd
import pydantic
import xarray as xr

MOST = 12
"""Numbers in a row that stand one by one; of more stand what they come to."""
LONGEST = 160
"""Characters of a line that holds a whole object."""
RELATIVE = 1e-5
FAULT = re.compile(r"\b(Type|Name|UnboundLocal)Error: ")
"""What no answer holds: it would be a fault of the program, or of the test itself."""
NUMBER = re.compile(r"(?<![\w#.])[-+−]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+−]?\d+)?")
RUN = re.compile(rf"(?:{NUMBER.pattern}[\sMLHVCQSTAZmlhvcqstaz,]*){{{MOST + 1},}}")
SILENT = (
    (re.compile(re.escape(str(Path(__file__).resolve().parents[1]))), "REPOSITORY"),
    (re.compile(r"<style.*?</style>|<!--.*?-->", re.DOTALL), ""),
    (re.compile(r"<script(?![^>]*json).*?</script>", re.DOTALL), ""),
    (re.compile(r"\s?data-message='[^']*'|\s?data-message=\"[^\"]*\""), ""),
    (re.compile(r"(?<=base64,)[\w+/=]+"), "BYTES"),
    (re.compile(r"\b(?=[0-9a-f]*\d)(?=[0-9a-f]*[a-f])[0-9a-f]{8,64}\b"), "HASH"),
    (re.compile(r"\b\d{4}-\d\d-\d\d(?:[T ]\d\d:\d\d(?::\d\d(?:\.\d+)?)?(?:Z|\+\d\d:\d\d)?)?"),
     "DATE"),
    (re.compile(r"\b(Underfoot|underfoot) \d+\.\d+\.\d+\S*"), r"\1 VERSION"),
)  # fmt: skip


def snapshot_lines(value: Any) -> str:
    """Return a value as lines: fields of objects, parts of lists, what arrays come to."""
    return "\n".join(_lines(value, "", ())) + "\n"


def same_lines(obtained: Path, kept: Path) -> None:
    """Raise ``AssertionError`` where files differ by more than rounding, with the first lines."""
    now, before = (path.read_text(encoding="utf-8").splitlines() for path in (obtained, kept))
    differ = [
        f"{number}: {one}\n  now: {other}"
        for number, (one, other) in enumerate(zip(before, now, strict=False), 1)
        if not _alike(one, other)
    ]
    if len(now) != len(before):
        differ.append(f"{len(before)} lines\n  now: {len(now)}")
    assert not differ, f"{kept}: {len(differ)} lines differ\n" + "\n".join(differ[:12])


def held(file_regression: Any, value: Any, name: str | None = None, *, hide: str = "") -> None:
    """Hold a value to its lines of before.

    ``name``: of the file of lines, else that of the test. ``hide``: a pattern of what differs with
    each run, such as the time that it took.
    """
    folder = file_regression.request.getfixturevalue("tmp_path")
    # a folder within the repository has lost its beginning already
    above = "|".join(re.escape(each(str(folder.parent))) for each in (str, _of_text))
    made = rf"[^\s\"'(>=]*(?:{above})/[^/\s\"'<)]*"
    text = re.sub(made, "FOLDER", snapshot_lines(value))
    if hide:
        text = re.sub(hide, "HIDDEN", text)
    assert not (fault := FAULT.search(text)), text[fault.start() :][:200]
    file_regression.check(
        text, basename=name, encoding="utf-8", extension=".txt", check_fn=same_lines
    )


def tried(call: Callable[..., Any], *args: Any, **options: Any) -> Any:
    """Return what a call answers, else the error that it ends with, and its text."""
    try:
        return call(*args, **options)
    except Exception as error:  # which one is part of what is held
        return f"{type(error).__name__}: {error}"


def refusal(call: Callable[..., Any], *args: Any, **options: Any) -> str:
    """Return the error that a call must end with, and its text."""
    try:
        answer = call(*args, **options)
    except Exception as error:  # which one is part of what is held
        return f"{type(error).__name__}: {error}"
    raise AssertionError(f"no error, but {answer!r}")


def folder_lines(folder: Path, *patterns: str) -> dict[str, Any]:
    """Return what the files of a folder hold, by their names: pages, JSON, tables, text."""
    paths = {path for pattern in patterns or ("*",) for path in folder.rglob(pattern)}
    return {
        path.relative_to(folder).as_posix(): _of_file(path)
        for path in sorted(paths)
        if path.is_file()
    }


def _of_file(path: Path) -> Any:
    if path.suffix == ".json":
        return json.loads(path.read_text(encoding="utf-8"))
    try:
        return path.read_text(encoding="utf-8")
    except UnicodeDecodeError:
        return path.stat().st_size


def _lines(value: Any, name: str, above: tuple[int, ...]) -> Iterator[str]:
    if id(value) in above or len(above) > 20:
        yield f"{name}: ..."
        return
    inside = (*above, id(value))
    if parts := _parts(value):
        kind, fields = parts
        stated = [(key, part) for key, part in fields if not _is_nothing(part)]
        simple = [f"{key}={_text(part)}" for key, part in stated if _parts(part) is None]
        line = f"{name}: {kind}({', '.join(simple)})"
        if len(simple) == len(stated) and "\n" not in line and len(line) <= LONGEST:
            yield line
            return
        if kind:
            yield f"{name}: {kind}"
        for key, part in stated:
            yield from _lines(part, f"{name}.{key}" if name else str(key), inside)
        return
    text = _text(value)
    label = f"{name}: " if name else ""
    if "\n" not in text:
        yield label + text
        return
    if name:
        yield f"{name}:"
    yield from text.splitlines()


def _parts(value: Any) -> tuple[str, list[tuple[Any, Any]]] | None:
    """Return the kind of a compound value and its named parts, None of a simple one."""
    if isinstance(value, Mapping):
        return "", list(value.items())
    if isinstance(value, xr.DataArray | xr.Dataset):
        named = {str(key): one for key, one in value.coords.items()}
        data = dict(value.data_vars) if isinstance(value, xr.Dataset) else {"values": value}
        arrays = {**named, **{str(key): one for key, one in data.items()}}
        return type(value).__name__, [(key, one.to_numpy()) for key, one in arrays.items()]
    if isinstance(value, pd.DataFrame):
        return "DataFrame", [(column, value[column].to_numpy()) for column in value]
    if isinstance(value, pydantic.BaseModel):
        return type(value).__name__, [
            (key, getattr(value, key)) for key in type(value).model_fields
        ]
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        of_class = dataclasses.fields(value)
        return type(value).__name__, [(f.name, getattr(value, f.name)) for f in of_class]
    if isinstance(value, tuple) and hasattr(value, "_fields"):
        return type(value).__name__, list(zip(value._fields, value, strict=True))
    if isinstance(value, np.ndarray):
        if value.dtype.names:
            return "", [(key, value[key]) for key in value.dtype.names]
        return ("", list(enumerate(value))) if value.dtype == object else None
    if isinstance(value, Set):
        return "", list(enumerate(sorted(value, key=str)))
    if isinstance(value, Sequence) and not isinstance(value, str | bytes):
        if len(value) > MOST and all(isinstance(one, int | float) for one in value):
            return None
        return "", list(enumerate(value))
    if type(value).__module__.startswith("underfoot") and not isinstance(value, str | Enum):
        fields = getattr(value, "__dict__", {})
        return type(value).__name__, [(k, v) for k, v in fields.items() if not k.startswith("_")]
    return None


def _is_nothing(value: Any) -> bool:
    return value is None or (isinstance(value, str | bytes | Sequence | Mapping) and not value)


def _text(value: Any) -> str:
    if isinstance(value, np.ndarray | Sequence) and not isinstance(value, str | bytes):
        return _of_numbers(np.asarray(value))
    if isinstance(value, str | PurePath):
        return _of_text(str(value))
    if isinstance(value, Enum):
        return f"{type(value).__name__}.{value.name}"
    if isinstance(value, bool | int | np.bool_ | np.integer) or value is None:
        return str(value)
    if isinstance(value, float | np.floating):
        return f"{float(value):#.8g}"
    if isinstance(value, bytes):
        return f"{len(value)} bytes"
    return getattr(value, "__qualname__", None) or type(value).__name__


def _of_numbers(values: np.ndarray) -> str:
    """Return a row of numbers, or of a long one its shape and what a change of any would change."""
    if values.dtype.kind in "USMmO":
        return " ".join(map(str, values.ravel()))
    if values.size <= MOST:
        return f"{values.shape} " + " ".join(_text(one) for one in values.ravel().tolist())
    flat = values.astype(complex if values.dtype.kind == "c" else float).ravel()
    flat = np.concatenate([flat.real, flat.imag]) if flat.dtype.kind == "c" else flat
    good = np.isfinite(flat)
    large = float(np.abs(flat[good]).max()) if good.any() else 0.0
    with_place = flat[good] * np.cos(0.7 * np.arange(flat.size)[good])
    parts = (flat[good].min(), flat[good].max(), flat[good].mean(), np.abs(with_place).mean(),
             with_place.mean()) if good.any() else ()  # fmt: skip
    shares = " ".join(f"{float(one) / (large or 1.0):.6f}" for one in parts)
    missing = f", {flat.size - good.sum()} not finite" if not good.all() else ""
    return f"{values.shape} of {large:#.8g}: {shares}{missing}"


def _of_text(text: str) -> str:
    for pattern, instead in SILENT:
        text = pattern.sub(instead, text)
    if "</" in text:
        text = re.sub(r">\s*<", ">\n<", text)
    text = RUN.sub(_run, text)
    return "\n".join(line.rstrip() for line in text.strip().splitlines() if line.strip())


def _run(match: re.Match[str]) -> str:
    text = match.group()
    values = [float(one.replace("−", "-")) for one in NUMBER.findall(text)]
    return f"[{_of_numbers(np.array(values))}]" + text[len(text.rstrip()) :]


def _alike(one: str, other: str) -> bool:
    if one == other:
        return True
    if NUMBER.split(one) != NUMBER.split(other):
        return False
    return all(map(_near, NUMBER.findall(one), NUMBER.findall(other)))


def _near(one: str, other: str) -> bool:
    """Return whether two numbers as written differ by rounding alone."""
    if one == other:
        return True
    if not re.search(r"[.eE]", one):  # a count
        return False
    (first, digits), (second, _) = map(_number, (one, other))
    written = re.sub(r"[eE].*|\D", "", one).lstrip("0")  # 1e9 has one digit, and no rounded last
    last = 1.01 * 10.0**-digits if len(written) > 2 else 0.0
    return math.isclose(first, second, rel_tol=RELATIVE, abs_tol=last)


def _number(text: str) -> tuple[float, int]:
    """Return a number and the digits behind its point, where the last one counts."""
    mantissa, _, power = text.replace("−", "-").lower().partition("e")
    digits = len(mantissa.partition(".")[2])
    return float(mantissa + ("e" + power if power else "")), digits - int(power or 0)
