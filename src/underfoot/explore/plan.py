"""The study file: base case, what varies, conditions, outputs and method; checked as a whole."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import product
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field, ValidationError
from scipy.stats import qmc

from underfoot.case import Case, CaseError
from underfoot.case import text as toml
from underfoot.case.errors import translated
from underfoot.case.quantity import Flag
from underfoot.case.section import Section
from underfoot.core import InputError, content_hash, to_si, unknown_name
from underfoot.core.arrays import Array
from underfoot.core.catalogue import Catalogue, catalogue_folders
from underfoot.shoe.geometry import CELLS_REFUSED

from .computing import MEASURES
from .goals import (
    WEAR,
    AnyGoal,
    Condition,
    Goal,
    Requirement,
    check_agreement,
    read_goal,
    read_requirement,
)
from .inputs import (
    Choice,
    Distribution,
    Follow,
    Input,
    JointDraws,
    Range,
    read_conditions,
    read_distribution,
    read_input,
    read_joint_draws,
)
from .record import Job

FILE_VERSION = 1
SECTIONS = (
    "file_version name description base set vary uncertain conditions outputs method reading"
).split()
UNITS = {
    **dict.fromkeys(("cof", "cof_adhesion", "cof_hysteresis", "cof_viscous"), "1"),
    **dict.fromkeys(("fluid_load", "fluid_load_sensor", "normal_force"), "N"),
    **dict.fromkeys(("peak_fluid_pressure", "peak_fluid_pressure_sensor"), "Pa"),
    "contact_area": "m^2",
    "minimum_film_thickness": "m",
    "slip_probability": "1",
    **MEASURES,
}
"""Outputs that a study may name, and their SI units."""
WIDTHS = ("shoe.tread.lug_width", "shoe.tread.channel_width", "shoe.tread.lug_length")
"""Lengths that need ``CELLS_REFUSED`` cells of the grid."""
ALIASES = {"wear": WEAR}
MOST_CASES = 1_000_000


Count = Annotated[int, Field(ge=1, le=10**6, strict=True)]


class Method(Section):
    """How a study is done.

    Attributes:
        kind: sweep, sensitivity, optimise or robust (optimise over draws).
        budget: Full runs at most; None where lists and steps say it all.
        design: grid, sobol or lhs; None for a grid where lists and steps make one, else sobol.
        analysis: morris or sobol, of a sensitivity.
        on: runs or surrogate, of a sensitivity.
        active: Share of the runs of a sweep that go where the surrogate is worst.
        draws: Of the uncertain inputs, the same for every design.
        batch: Designs that are proposed together.
        grid: Of the runs; ``front_grid`` that on which a front is run again, None for none.
        fields: Keep maps.
        seed: Of designs and draws.
    """

    kind: Literal["sweep", "sensitivity", "optimise", "robust"] = "sweep"
    budget: Count | None = None
    design: Literal["grid", "sobol", "lhs"] | None = None
    analysis: Literal["morris", "sobol"] = "sobol"
    on: Literal["runs", "surrogate"] = "surrogate"
    active: Annotated[float, Field(ge=0, le=0.9)] = 0.0
    draws: Count = 8
    batch: Count = 8
    grid: Literal["quick", "standard"] = "quick"
    front_grid: Literal["quick", "standard"] | None = None
    fields: Flag = False
    seed: Annotated[int, Field(ge=0, le=2**31, strict=True)] = 0

    @property
    def quick(self) -> bool:
        """Whether the runs are on the coarse grid."""
        return self.grid == "quick"


@dataclass(frozen=True, slots=True)
class Reading:
    """What was measured in one condition: an output, its value and standard deviation, SI."""

    output: str
    unit: str
    value: float
    sd: float


@dataclass(frozen=True)
class StudyPlan:
    """Everything a study is made of.

    Attributes:
        base: The case that is changed.
        vary: Ranges and lists of the designer, and of a sensitivity the uncertain inputs.
        follow: Values that keep their ratio to a varied one.
        draws: Changes of each common draw of the uncertain inputs.
        states: Conditions that every design is run in.
        remarks: What reading the file decided, in words.
        text: The study file.
        readings: Of a calibration: what was measured in each state.
    """

    name: str
    base: Case
    vary: tuple[Input, ...]
    follow: tuple[Follow, ...]
    uncertain: tuple[Distribution, ...]
    draws: tuple[Mapping[str, Any], ...]
    states: tuple[Condition, ...]
    maximise: tuple[AnyGoal, ...]
    minimise: tuple[AnyGoal, ...]
    require: tuple[Requirement, ...]
    method: Method
    remarks: tuple[str, ...]
    text: str
    readings: tuple[Reading, ...] = ()

    @property
    def dimensions(self) -> tuple[Input | Distribution, ...]:
        """What the unit cube of a design stands for."""
        if self.method.kind == "sensitivity":
            return (*self.vary, *self.uncertain)
        return self.vary

    @property
    def goals(self) -> tuple[AnyGoal, ...]:
        """What is to be large, then what is to be small."""
        return (*self.maximise, *self.minimise)

    @property
    def signs(self) -> Array:
        """1 for goals to be small, -1 for those to be large."""
        return np.array([-1.0] * len(self.maximise) + [1.0] * len(self.minimise))

    @property
    def cases_per_design(self) -> int:
        """Full runs that one design takes."""
        return len(self.states) * len(self.draws)

    @property
    def designs(self) -> int:
        """Number of designs that the budget allows."""
        if self.method.budget is None:
            return len(self.grid_points())
        return max(self.method.budget // self.cases_per_design, 1)

    def grid_points(self) -> list[tuple[float, ...]]:
        """Return the points of the full grid of lists and steps."""
        return list(product(*(one.shares() for one in self.vary)))

    def sampled_points(self, count: int) -> list[tuple[float, ...]]:
        """Return ``count`` places of the unit cube, evenly spread."""
        size = len(self.dimensions)
        if self.method.design == "lhs":
            sampler: Any = qmc.LatinHypercube(size, rng=self.method.seed)
            return [tuple(map(float, row)) for row in sampler.random(count)]
        sampler = qmc.Sobol(size, rng=self.method.seed)
        rows = sampler.random_base2(math.ceil(math.log2(max(count, 2))))
        return [tuple(map(float, row)) for row in rows[:count]]

    def design_changes(self, point: Sequence[float]) -> dict[str, Any]:
        """Return what a point of the unit cube changes in the case, followers included."""
        changes = {
            one.path: one.value(share) for one, share in zip(self.dimensions, point, strict=True)
        }
        return changes | {one.path: one.times * changes[one.of] for one in self.follow}

    def jobs(
        self,
        design: int,
        point: Sequence[float],
        batch: int,
        *,
        quick: bool | None = None,
    ) -> Iterator[Job]:
        """Yield the jobs of a design: every condition with every draw."""
        own = self.design_changes(point)
        quick = self.method.quick if quick is None else quick
        for state, draw in product(range(len(self.states)), range(len(self.draws))):
            changes = {**own, **self.draws[draw], **self.states[state].changes}
            key = content_hash(self.base.hash, {k: _rounded(v) for k, v in changes.items()}, quick)
            yield Job(
                key[:24],
                design,
                state,
                draw,
                batch,
                tuple(map(float, point)),
                changes,
                quick,
                self.method.fields,
            )


def load_plan(path: Path | str, *, catalogue: Catalogue | None = None) -> StudyPlan:
    """Return the plan of a study file.

    Raises:
        CaseError: Everything that is wrong with the file, each with its line.
    """
    path = Path(path)
    return read_plan(toml.read(path), path.parent, str(path), catalogue=catalogue)


def read_plan(
    text: str,
    folder: Path,
    file: str | None = None,
    *,
    base: Case | None = None,
    catalogue: Catalogue | None = None,
) -> StudyPlan:
    """Return the plan of a study's text; paths count from ``folder``; ``base`` is its case."""
    reader = _Reader(toml.parsed(text, file), file, toml.key_lines(text))
    plain = reader.plain
    for key in plain:
        if key not in SECTIONS:
            reader.fail(unknown_name("section", key, SECTIONS, where=reader.place(key)))
    reader.check_version()
    if base is None:
        case = reader.attempt(_base, plain, folder, reader.place("base"), catalogue)
    else:
        case = base
    if case is None:
        raise CaseError(reader.errors)
    known = case.catalogue
    fixed = reader.table("set")
    if fixed:
        case = reader.attempt(case.replace, fixed) or case
    vary: list[Input] = []
    follow: list[Follow] = []
    for path, given in reader.table("vary").items():
        found = reader.attempt(read_input, path, given, reader.place("vary", path), known)
        if isinstance(found, Follow):
            follow.append(found)
        elif found is not None:
            vary.append(found)
    for one in follow:
        if one.of not in [each.path for each in vary]:
            paths = [each.path for each in vary]
            reader.fail(unknown_name("path", one.of, paths, where=reader.place("vary", one.path)))
    uncertain: list[Distribution] = []
    joint: JointDraws | None = None
    for path, given in reader.table("uncertain").items():
        where = reader.place("uncertain", path)
        if path == "posterior":
            joint = reader.attempt(read_joint_draws, folder / str(given), where)
            continue
        distribution = reader.attempt(read_distribution, path, given, where, known)
        if distribution is not None:
            uncertain.append(distribution)
    calibrates = "reading" in plain
    if not vary and not uncertain and not reader.errors:
        reader.fail(
            InputError(
                "nothing is varied",
                where=reader.place("vary"),
                remedy='Write "shoe.tread.depth" = { from = "1 mm", to = "4 mm" } under [vary]',
            )
        )
    states, readings = reader.conditions(known), ()
    if calibrates:
        states, readings = reader.readings(known)
    taken = [one.path for one in (*vary, *follow, *uncertain)]
    taken += [*(joint.paths if joint else ()), *(states[0].changes if states else ())]
    for path in {path for path in taken if taken.count(path) > 1}:
        reader.fail(
            InputError(
                "is set twice",
                where=path,
                allowed="one of [vary], [uncertain], [conditions]",
                remedy="Keep it in one of them",
            )
        )
    method = reader.method(bool(uncertain or joint), vary)
    if calibrates:
        method = method.model_copy(update={"kind": "sensitivity"})
    require, maximise, minimise = reader.outputs(case, states)
    if not maximise + minimise and method.kind in ("optimise", "robust") and not reader.errors:
        reader.fail(
            InputError(
                "there is no goal",
                where=reader.place("outputs"),
                remedy='Write maximise = ["quantile(cof, 0.1)"] or minimise = ["rubber_volume"]',
            )
        )
    if reader.errors:
        raise CaseError(reader.errors)
    case, remarks = _on_finer_grid(case, vary, follow)
    draws: tuple[Mapping[str, Any], ...] = ({},)
    if method.kind != "sensitivity" and (uncertain or joint):
        draws = tuple(_common_draws(uncertain, joint, method))
    name = str(plain.get("name") or f"{case.name}: {method.kind}")
    plan = StudyPlan(
        name,
        case,
        tuple(vary),
        tuple(follow),
        tuple(uncertain),
        draws,
        states,
        maximise,
        minimise,
        require,
        method,
        remarks,
        text,
        readings,
    )
    total = plan.designs * plan.cases_per_design if method.budget else _grid_size(plan)
    if total > MOST_CASES:
        raise InputError(
            f"{total:.2g} cases", where=reader.place("method"), allowed=f"at most {MOST_CASES:g}"
        )
    if method.budget and method.budget < plan.cases_per_design:
        raise InputError(
            f"a budget of {method.budget} runs is less than one design takes",
            where=reader.place("method", "budget"),
            allowed=f"from {plan.cases_per_design} (conditions times draws)",
        )
    return plan


def _grid_size(plan: StudyPlan) -> float:
    return math.prod(len(one.shares()) for one in plan.vary) * plan.cases_per_design


def _base(plain: Mapping[str, Any], folder: Path, where: str, catalogue: Catalogue | None) -> Case:
    given = plain.get("base")
    if not isinstance(given, str):
        raise InputError("is missing", where=where, remedy='Write base = "my_case.toml"')
    path = folder / given
    return Case.load(path, catalogue=catalogue or Catalogue.load(catalogue_folders(path.parent)))


def _on_finer_grid(
    case: Case, vary: Sequence[Input], follow: Sequence[Follow]
) -> tuple[Case, tuple[str, ...]]:
    """Return the case on grids fine enough for the narrowest channel or lug that is varied.

    One grid for all designs: what two of them differ by must not be the grid.
    """
    lows = {one.path: one.low for one in vary if isinstance(one, Range)}
    lows |= {
        one.path: min(one.options)
        for one in vary
        if isinstance(one, Choice) and isinstance(one.options[0], float)
    }
    lows |= {one.path: one.times * lows[one.of] for one in follow if one.of in lows}
    narrowest = min((low for path, low in lows.items() if path in WIDTHS), default=math.inf)
    finest, changes = narrowest / CELLS_REFUSED, {}
    for name in ("grid_spacing", "quick_grid_spacing"):
        if getattr(case.numerics, name) > finest * (1 + 1e-9):
            changes[f"numerics.{name}"] = math.floor(finest * 1e5 + 1e-6) / 1e5
    if not changes:
        return case, ()
    said = ", ".join(f"{path} = {value * 1e3:g} mm" for path, value in changes.items())
    words = f"The narrowest lug or channel ({narrowest * 1e3:g} mm) needs a finer grid: {said}."
    return case.replace(changes), (words,)


def _common_draws(
    uncertain: Sequence[Distribution], joint: JointDraws | None, method: Method
) -> list[dict[str, Any]]:
    size = max(len(uncertain), 1)
    shares = qmc.LatinHypercube(size, rng=method.seed).random(method.draws)
    rows = [
        {one.path: one.value(float(share)) for one, share in zip(uncertain, row, strict=False)}
        for row in shares
    ]
    if joint is not None:
        rows = [row | more for row, more in zip(rows, joint.rows(method.draws), strict=True)]
    return rows


def _rounded(value: Any) -> Any:
    return float(f"{value:.12g}") if isinstance(value, float) else value


class _Reader:
    """A study file on its way to a plan: every error is kept with its place."""

    def __init__(
        self, plain: dict[str, Any], file: str | None, lines: Mapping[tuple[str, ...], int]
    ) -> None:
        self.plain, self.file, self.lines = plain, file, lines
        self.errors: list[InputError] = []

    def place(self, *keys: str) -> str:
        """Return the place of a key: ``vary."shoe.tread.depth" (file, line 4)``."""
        name = ".".join(f'"{key}"' if "." in key else key for key in keys)
        if self.file is None:
            return name
        parts = tuple(part for key in keys for part in key.split("."))
        while parts:
            if parts in self.lines:
                return f"{name} ({self.file}, line {self.lines[parts]})"
            parts = parts[:-1]
        return f"{name} ({self.file})"

    def fail(self, error: InputError) -> None:
        """Keep an error."""
        self.errors.append(error)

    def attempt(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """Return what a function returns; None, with its errors kept, where it refuses."""
        try:
            return function(*arguments)
        except CaseError as error:
            self.errors += error.errors
        except InputError as error:
            self.fail(error)
        return None

    def table(self, name: str) -> dict[str, Any]:
        """Return a section with flat, dotted keys; quoted and bare paths mean the same."""
        given = self.plain.get(name, {})
        if not isinstance(given, Mapping):
            self.fail(InputError(f"{given!r} is no section", where=self.place(name)))
            return {}
        flat: dict[str, Any] = {}

        def add(prefix: str, table: Mapping[str, Any]) -> None:
            for key, value in table.items():
                path = f"{prefix}.{key}" if prefix else key
                marks = {"from", "to", "times", "of", "normal", "sd", "lognormal", "factor"}
                if isinstance(value, Mapping) and value and not marks & set(value):
                    add(path, value)
                else:
                    flat[path] = value

        add("", given)
        return flat

    def check_version(self) -> None:
        """Refuse the file of a newer version."""
        version = self.plain.get("file_version", FILE_VERSION)
        if not isinstance(version, int) or isinstance(version, bool) or version > FILE_VERSION:
            self.fail(
                InputError(
                    f"the file was written for version {version} of the study format",
                    where=self.place("file_version"),
                    allowed=f"{FILE_VERSION} or older",
                    remedy="Update underfoot",
                )
            )

    def conditions(self, catalogue: Catalogue) -> tuple[Condition, ...]:
        """Return every combination of the conditions; one without changes where none are given."""
        choices = []
        for name, given in self.table("conditions").items():
            path = ALIASES.get(name, name)
            where = self.place("conditions", name)
            found = self.attempt(read_conditions, path, given, where, catalogue)
            if found is not None:
                listed = given if isinstance(given, list | tuple) else [given]
                choices.append(
                    [(path, v, str(t)) for v, t in zip(found.options, listed, strict=True)]
                )
        return tuple(
            Condition(", ".join(text for *_, text in row), {path: value for path, value, _ in row})
            for row in product(*choices)
        )

    def readings(self, catalogue: Catalogue) -> tuple[tuple[Condition, ...], tuple[Reading, ...]]:
        """Return the condition of each reading, and what was measured in it."""
        states, found, given = [], [], self.plain["reading"]
        for number, one in enumerate(given if isinstance(given, list) else [given], start=1):
            where = self.place("reading") + f"[{number}]"
            if not isinstance(one, Mapping) or not isinstance(one.get("when", {}), Mapping):
                self.fail(InputError(f"{one!r} is no table", where=where))
                continue
            changes = {}
            for path, value in one.get("when", {}).items():
                choice = self.attempt(
                    read_conditions, path, value, f'{where}.when."{path}"', catalogue
                )
                if choice is not None:
                    changes[path] = choice.options[0]
            outputs = [key for key in one if key not in ("when", "sd", "name")]
            if len(outputs) != 1 or outputs[0] not in UNITS or "sd" not in one:
                what = f"{', '.join(outputs) or 'nothing'} was measured"
                self.fail(
                    InputError(
                        what,
                        where=where,
                        allowed=f"one of {', '.join(UNITS)}, with its sd",
                        remedy="Write cof = 0.24, sd = 0.02",
                    )
                )
                continue
            unit = UNITS[outputs[0]]
            value, sd = (
                self.attempt(partial(to_si, where=f"{where}.{key}"), one[key], unit)
                for key in (outputs[0], "sd")
            )
            if value is None or sd is None:
                continue
            if sd <= 0:
                self.fail(InputError(f"{one['sd']}", where=f"{where}.sd", allowed="above 0"))
            states.append(Condition(str(one.get("name", f"reading {number}")), changes))
            found.append(Reading(outputs[0], unit, value, sd))
        return tuple(states), tuple(found)

    def outputs(
        self, case: Case, states: Sequence[Condition]
    ) -> tuple[tuple[Requirement, ...], tuple[AnyGoal, ...], tuple[AnyGoal, ...]]:
        """Return requirements, and goals to be large and to be small."""
        table, names = self.table("outputs"), ("maximise", "minimise", "require")
        for key in table:
            if key not in names:
                self.fail(unknown_name("key", key, names, where=self.place("outputs", key)))
        found: dict[str, list[Any]] = {}
        for name in reversed(names):  # requirements first: wear_life may rest on one
            given = table.get(name, [])
            for k, text in enumerate(given if isinstance(given, list) else [given]):
                where = f"{self.place('outputs', name)}[{k}]"
                if name == "require":
                    one = self.attempt(read_requirement, text, where, UNITS, states)
                else:
                    rest = found.get("require", [])
                    one = self.attempt(read_goal, text, where, UNITS, states, rest)
                if one is not None:
                    found.setdefault(name, []).append(one)
                    self._check_measured(one, case, where)
        maximise, minimise, require = (tuple(found.get(name, ())) for name in names)
        self.attempt(check_agreement, require, self.place("outputs", "require"))
        for goal in maximise:
            if goal in minimise:
                self.fail(
                    InputError(f"{goal} is to be both large and small", where=self.place("outputs"))
                )
        return require, maximise, minimise

    def _check_measured(self, one: Any, case: Case, where: str) -> None:
        goal = one.goal if isinstance(one, Requirement) else one
        if isinstance(goal, Goal) and goal.output == "mass" and not case.shoe.material.density:
            self.fail(
                InputError(
                    "the mass needs a density",
                    where=where,
                    remedy='Write "shoe.material.density" = "1150 kg/m^3" under [set], or take '
                    "rubber_volume",
                )
            )

    def method(self, uncertain: bool, vary: Sequence[Input]) -> Method:
        """Return the method with its defaults."""
        table = self.table("method")
        try:
            found = Method.model_validate(table)
        except ValidationError as error:
            self.errors += translated(error, Method, table, lambda key: self.place("method", key))
            return Method()
        steps = all(isinstance(one, Choice) or one.steps for one in vary)
        if found.design is None:
            plain = found.kind == "sweep" and steps and not found.budget
            found = found.model_copy(update={"design": "grid" if plain else "sobol"})
        if found.design == "grid" and not steps:
            self.fail(
                InputError(
                    "a grid needs steps",
                    where=self.place("method", "design"),
                    remedy='Write steps = 5 beside from and to, or design = "sobol"',
                )
            )
        if found.design != "grid" and found.budget is None:
            self.fail(
                InputError(
                    "is missing",
                    where=self.place("method", "budget"),
                    allowed="full runs at most, as budget = 200",
                )
            )
        if not vary and found.kind != "sensitivity" and "reading" not in self.plain:
            self.fail(
                InputError(
                    "nothing is varied",
                    where=self.place("method", "kind"),
                    remedy='Add [vary], or write kind = "sensitivity"',
                )
            )
        if found.kind == "robust" and not uncertain:
            self.fail(
                InputError(
                    "nothing is uncertain",
                    where=self.place("method", "kind"),
                    remedy='Add [uncertain], or write kind = "optimise"',
                )
            )
        return found
