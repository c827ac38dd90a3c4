"""The study file: read as a whole, and every error in it told with its line and its remedy."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from itertools import product
from pathlib import Path
from typing import Any

from pydantic import ValidationError
from scipy.stats import qmc

from underfoot.case import Case, CaseError
from underfoot.case import text as toml
from underfoot.case.errors import place_error, translate_errors
from underfoot.compute.positions import run_cost
from underfoot.core import InputError, to_si, unknown_name
from underfoot.core.catalogue import Catalogue, catalogue_folders
from underfoot.core.remark import Message
from underfoot.core.units import spread_to_si
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
    read_choice,
    read_distribution,
    read_input,
    read_joint_draws,
    value_at,
)
from .plan import Method, Reading, StudyPlan

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
VALUE_KEYS = {"from", "to", "times", "of", "normal", "sd", "lognormal", "factor"}
"""Keys of a table that is one value, not a section of further paths."""
MOST_CASES = 1_000_000
YEAR = 365.25 * 24 * 3600.0
"""s."""


def load_plan(path: Path | str, *, catalogue: Catalogue | None = None) -> StudyPlan:
    """Return the plan of a study file.

    Raises:
        CaseError: Everything that is wrong with the file, each with its line.
    """
    path = Path(path)
    return read_plan(toml.read_text(path), path.parent, str(path), catalogue=catalogue)


def read_plan(
    text: str,
    folder: Path,
    file: str | None = None,
    *,
    base: Case | None = None,
    catalogue: Catalogue | None = None,
) -> StudyPlan:
    """Return the plan of a study's text; paths count from ``folder``; ``base`` is its case."""
    reader = _Reader(text, file)
    case = base or reader.base(folder, catalogue)
    known = case.catalogue
    if fixed := reader.table("set"):
        case = reader.attempt("", case.replace, fixed) or case
    vary, follow, fixed = reader.read_varied(known)
    uncertain, joint = reader.uncertain(known, folder)
    calibrates = "reading" in reader.plain
    states, readings = reader.readings(known) if calibrates else (reader.conditions(known), ())
    method, (require, maximise, minimise) = reader.method(vary), reader.outputs(case, states)
    reader.end()
    taken = [*fixed, *(one.path for one in (*vary, *follow, *uncertain))]
    taken += [*(joint.paths if joint else ()), *(states[0].changes if states else ())]
    for path in {path for path in taken if taken.count(path) > 1}:
        reader.refuse_if(
            True, path, "is set twice", allowed="one of [vary], [uncertain], [conditions]"
        )
    if calibrates:
        method = method.model_copy(update={"kind": "sensitivity"})
    reader.refuse_if(
        not (vary or (method.kind == "sensitivity" and (uncertain or joint))),
        "vary",
        "nothing is varied",
        remedy='Write "shoe.tread.depth" = { from = "1 mm", to = "4 mm" } under [vary], or '
        'kind = "sensitivity" for what is uncertain',
    )
    reader.refuse_if(
        method.kind == "robust" and not (uncertain or joint),
        "method.kind",
        "nothing is uncertain",
        remedy='Add [uncertain], or write kind = "optimise"',
    )
    reader.refuse_if(
        method.kind in ("optimise", "robust") and not maximise + minimise,
        "outputs",
        "there is no goal",
        remedy='Write maximise = ["quantile(cof, 0.1)"] or minimise = ["rubber_volume"]',
    )
    reader.end()
    lengths = reader.attempt("vary", _on_finer_grid, case, vary, follow, fixed)
    case, remarks = lengths or (case, ())
    draws: tuple[Mapping[str, Any], ...] = ({},)
    if method.kind != "sensitivity" and (uncertain or joint):
        draws = tuple(_common_draws(uncertain, joint, method))
    plan = StudyPlan(
        name=str(reader.plain.get("name") or f"{case.name}: {method.kind}"),
        base=case,
        vary=vary,
        follow=follow,
        fixed=fixed,
        uncertain=uncertain,
        draws=draws,
        states=states,
        maximise=maximise,
        minimise=minimise,
        require=require,
        method=method,
        remarks=remarks,
        text=text,
        readings=readings,
    )
    for goal in (*plan.goals, *(one.goal for one in require)):
        if isinstance(goal, Goal) and goal.statistic != "mean" and not goal.of_draws:
            reader.refuse_if(
                goal.numbers(states, len(draws)) < 2,
                "outputs",
                Message("{goal} is a statistic of one number", goal=goal),
                remedy="Write several [conditions], or draws of what is [uncertain]",
            )
    budget, grid = method.budget, method.design == "grid"
    few = Message("a budget of {budget} runs is less than one design takes", budget=budget)
    if grid:
        few = Message("a budget of {budget} runs is less than the grid takes", budget=budget)
    least = plan.cases_per_design * (plan.designs if grid else 1)
    reader.refuse_if(
        budget is not None and budget < least,
        "method.budget",
        few,
        allowed=Message(
            "from {least} ({grid}conditions times draws)", least=least, grid="designs times " * grid
        ),
    )
    cases = plan.designs * plan.cases_per_design
    low, high = (
        float(f"{cases * seconds / YEAR:.1g}")
        for seconds in run_cost(plan.base, quick=method.quick).seconds
    )
    cost = Message(", {low:g} to {high:g} years of one processor", low=low, high=high)
    reader.refuse_many("vary" if grid else "method", "cases", cases, cost)
    reader.end()
    if plan.goals and method.again_on and plan.again_is_the_same:
        remark = Message(
            "The best designs are not run again: on the same grid a sole without lugs, or one "
            "position of a tread, gives the same run. Take {setting}.",
            setting='front_grid = "standard"' if method.quick else 'grid = "quick"',
        )
        return replace(plan, remarks=(*remarks, remark))
    return plan


def _on_finer_grid(
    case: Case, vary: Sequence[Input], follow: Sequence[Follow], fixed: Mapping[str, Any]
) -> tuple[Case, tuple[str, ...]]:
    """Return the case on grids fine enough for the narrowest channel or lug that is varied.

    One grid for all designs: what two of them differ by must not be the grid.
    """
    lows = {
        one.path: one.low if isinstance(one, Range) else min(one.options)
        for one in vary
        if isinstance(one.value(0.0), float)
    }
    lows |= {one.path: one.times * lows[one.of] for one in follow if one.of in lows}
    lows |= fixed
    narrowest, path = min(
        ((low, path) for path, low in lows.items() if path in WIDTHS), default=(math.inf, "")
    )
    finest, changes = narrowest / CELLS_REFUSED, {}
    for name in ("grid_spacing", "quick_grid_spacing"):
        if getattr(case.numerics, name) > finest * (1 + 1e-9):
            changes[f"numerics.{name}"] = math.floor(finest * 1e5 + 1e-6) / 1e5
    if not changes:
        return case, ()
    settings = ", ".join(f"{name} = {value * 1e3:g} mm" for name, value in changes.items())
    words = Message(
        "The narrowest lug or channel ({narrowest:g} mm) needs a finer grid: {settings}",
        narrowest=narrowest * 1000.0,
        settings=settings,
    )
    try:
        return case.replace(changes), (f"{words}.",)
    except InputError as error:
        remedy = "Raise the low end of its range"
        raise InputError(words, where=f".{path}", allowed=error.allowed, remedy=remedy) from error


def _common_draws(
    uncertain: Sequence[Distribution], joint: JointDraws | None, method: Method
) -> list[dict[str, Any]]:
    size = max(len(uncertain), 1)
    shares = qmc.LatinHypercube(size, rng=method.seed).random(method.draws)
    rows = [
        {
            distribution.path: distribution.value(float(share))
            for distribution, share in zip(uncertain, row, strict=False)
        }
        for row in shares
    ]
    if joint is not None:
        rows = [row | more for row, more in zip(rows, joint.rows(method.draws), strict=True)]
    return rows


def _as_list(given: Any) -> Sequence[Any]:
    return given if isinstance(given, list | tuple) else [given]


def flat_paths(table: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Yield path and value; quoted and bare paths mean the same."""
    for key, value in table.items():
        if isinstance(value, Mapping) and value and not VALUE_KEYS & set(value):
            yield from flat_paths(value, f"{prefix}{key}.")
        else:
            yield f"{prefix}{key}", value


def _reading(table: Any, name: str, known: Catalogue) -> tuple[Condition, Reading]:
    if not isinstance(table, Mapping) or not isinstance(table.get("when", {}), Mapping):
        raise InputError(Message("{entry} is no table", entry=repr(table)))
    changes = {
        path: value_at(path, value, known, f".when.{path}")
        for path, value in table.get("when", {}).items()
    }
    outputs = [key for key in table if key not in ("when", "sd", "name")]
    if len(outputs) != 1 or outputs[0] not in UNITS or "sd" not in table:
        raise InputError(
            Message("{outputs} was measured", outputs=", ".join(outputs) or "nothing"),
            allowed=Message("one of {units}, with its sd", units=", ".join(UNITS)),
            remedy="Write cof = 0.24, sd = 0.02",
        )
    unit = UNITS[outputs[0]]
    given = table[outputs[0]]
    value = to_si(given, unit, where=f".{outputs[0]}")
    sd = spread_to_si(table["sd"], given, unit, where=".sd")
    if sd <= 0:
        raise InputError(f"{table['sd']}", where=".sd", allowed="above 0")
    return Condition((str(table.get("name", name)),), changes), Reading(outputs[0], unit, value, sd)


class _Reader:
    """A study file on its way to a plan: every error is kept with its place."""

    def __init__(self, text: str, file: str | None) -> None:
        self.plain, self.places = toml.parse_toml(text, file), toml.Places(file, text)
        self.errors: list[InputError] = []
        for key in self.plain:
            self.check_known(key, "section", key, SECTIONS)
        version = self.plain.get("file_version", FILE_VERSION)
        self.refuse_if(
            not isinstance(version, int) or isinstance(version, bool) or version > FILE_VERSION,
            "file_version",
            Message(
                "the file was written for version {version} of the study format", version=version
            ),
            allowed=Message("{file_version} or older", file_version=FILE_VERSION),
            remedy="Update underfoot",
        )

    def refuse_if(self, wrong: bool, path: str, what: str, **parts: str) -> None:
        """Keep an error where something is wrong at a path."""
        if wrong:
            self.errors.append(InputError(what, where=self.places(path), **parts))

    def check_known(self, path: str, kind: str, name: str, known: Sequence[str]) -> None:
        """Keep an error where a name is none of those that are known."""
        if name not in known:
            self.errors.append(unknown_name(kind, name, known, where=self.places(path)))

    def refuse_many(self, path: str, what: str, count: int, cost: str = "") -> bool:
        """Return whether there are more than a study may have, and keep that as an error."""
        many = count > MOST_CASES
        remedy = "Fewer steps, values or conditions; or a budget, whose designs are spread evenly"
        self.refuse_if(
            many,
            path,
            Message("{count:.2g} {what}{cost}", count=count, what=what, cost=cost),
            allowed=Message("at most {most:g}", most=MOST_CASES),
            remedy=remedy,
        )
        return many

    def attempt(self, path: str, function: Callable[..., Any], *arguments: Any) -> Any:
        """Return what a function says of a path; None, with its errors kept, where it refuses."""
        try:
            return function(*arguments)
        except CaseError as error:
            self.errors += error.errors
        except InputError as error:
            self.errors.append(place_error(error, lambda inner: self.places(f"{path}{inner}")))
        return None

    def end(self) -> None:
        """Raise all errors at once."""
        if self.errors:
            raise CaseError(self.errors)

    def table(self, name: str) -> dict[str, Any]:
        """Return a section with flat, dotted keys."""
        given = self.plain.get(name, {})
        self.refuse_if(
            not isinstance(given, Mapping),
            name,
            Message("{given} is no section", given=repr(given)),
        )
        pairs = list(flat_paths(given)) if isinstance(given, Mapping) else []
        paths = [ALIASES.get(path, path) for path, _ in pairs]
        for path in {one for one in paths if paths.count(one) > 1}:
            self.refuse_if(True, f"{name}.{path}", "stands twice", remedy="Drop one")
        return dict(pairs)

    def base(self, folder: Path, catalogue: Catalogue | None) -> Case:
        """Return the case that is changed; without it nothing else can be judged."""
        given = self.plain.get("base")
        if not isinstance(given, str):
            remedy = 'Write base = "my_case.toml"'
            self.refuse_if(True, "base", "is missing", remedy=remedy)
        else:
            path = folder / given
            known = catalogue or Catalogue.load(catalogue_folders(path.parent))
            if case := self.attempt("base", partial(Case.load, path, catalogue=known)):
                return case
        raise CaseError(self.errors)

    def read_varied(
        self, known: Catalogue
    ) -> tuple[tuple[Input, ...], tuple[Follow, ...], dict[str, Any]]:
        """Return what the designer chooses, what follows it, and what all designs share."""
        axes = [
            self.attempt(f"vary.{path}", read_input, path, given, known)
            for path, given in self.table("vary").items()
        ]
        follow = tuple(axis for axis in axes if isinstance(axis, Follow))
        vary = tuple(axis for axis in axes if isinstance(axis, Range | Choice))
        for one in follow:
            self.check_known(f"vary.{one.path}", "path", one.of, [each.path for each in vary])
        # a list of one is no input of a surrogate, where there are others
        lists = [
            choice for choice in vary if isinstance(choice, Choice) and len(choice.options) == 1
        ]
        fixed = {choice.path: choice.options[0] for choice in lists if len(lists) < len(vary)}
        return tuple(one for one in vary if one.path not in fixed), follow, fixed

    def uncertain(
        self, known: Catalogue, folder: Path
    ) -> tuple[tuple[Distribution, ...], JointDraws | None]:
        """Return distributions, and the draws of a calibration."""
        table = self.table("uncertain")
        file, joint = table.pop("posterior", None), None
        if file is not None:
            joint = self.attempt("uncertain.posterior", read_joint_draws, folder / str(file))
        distributions = [
            self.attempt(f"uncertain.{path}", read_distribution, path, given, known)
            for path, given in table.items()
        ]
        return tuple(filter(None, distributions)), joint

    def conditions(self, known: Catalogue) -> tuple[Condition, ...]:
        """Return every combination of the conditions; one without changes where none are given."""
        choices = []
        for name, given in self.table("conditions").items():
            path, texts = ALIASES.get(name, name), _as_list(given)
            choice = self.attempt(f"conditions.{name}", read_choice, path, texts, known)
            if choice is not None:
                choices.append([(path, *pair) for pair in zip(choice.options, texts, strict=True)])
        if self.refuse_many("conditions", "conditions", math.prod(map(len, choices))):
            return ()
        return tuple(
            Condition(tuple(str(text) for *_, text in row), {path: v for path, v, _ in row})
            for row in product(*choices)
        )

    def readings(self, known: Catalogue) -> tuple[tuple[Condition, ...], tuple[Reading, ...]]:
        """Return the condition of each reading, and what was measured in it."""
        readings = [
            self.attempt(f"reading[{number}]", _reading, one, f"reading {number}", known)
            for number, one in enumerate(_as_list(self.plain["reading"]), start=1)
        ]
        good = list(filter(None, readings))
        return tuple(state for state, _ in good), tuple(reading for _, reading in good)

    def outputs(
        self, case: Case, states: Sequence[Condition]
    ) -> tuple[tuple[Requirement, ...], tuple[AnyGoal, ...], tuple[AnyGoal, ...]]:
        """Return requirements, and goals to be large and to be small."""
        table, names = self.table("outputs"), ("maximise", "minimise", "require")
        for key in table:
            self.check_known(f"outputs.{key}", "key", key, names)

        def read_goals(name: str, function: Callable[..., Any], *more: Any) -> tuple[Any, ...]:
            goals = [
                self.attempt(f"outputs.{name}[{k}]", function, text, UNITS, states, *more)
                for k, text in enumerate(_as_list(table.get(name, [])))
            ]
            return tuple(filter(None, goals))

        require = read_goals("require", read_requirement)  # first: wear_life may rest on one
        maximise, minimise = (read_goals(name, read_goal, require) for name in names[:2])
        self.attempt("outputs.require", check_agreement, require)
        for goal in set(maximise) & set(minimise):
            self.refuse_if(
                True, "outputs", Message("{goal} is to be both large and small", goal=goal)
            )
        for name, goals in (("maximise", maximise), ("minimise", minimise)):
            for goal in {one for one in goals if goals.count(one) > 1}:
                self.refuse_if(
                    True,
                    f"outputs.{name}",
                    Message("{goal} stands twice", goal=goal),
                    remedy="Drop one",
                )
        wanted = (*maximise, *minimise, *(one.goal for one in require))
        weighed = any(isinstance(one, Goal) and one.output == "mass" for one in wanted)
        self.refuse_if(
            weighed and not case.shoe.material.density,
            "outputs",
            "the mass needs a density",
            remedy='Write "shoe.material.density" = "1150 kg/m^3" under [set], or take '
            "rubber_volume",
        )
        return require, maximise, minimise

    def method(self, vary: Sequence[Input]) -> Method:
        """Return the method with its defaults."""
        table = self.table("method")
        try:
            method = Method.model_validate(table)
        except ValidationError as error:
            place = self.places
            self.errors += translate_errors(
                error, Method, table, lambda key: place(f"method.{key}")
            )
            return Method()
        steps = all(isinstance(one, Choice) or one.steps for one in vary)
        if method.design is None:
            plain = method.kind == "sweep" and steps and not method.budget
            method = method.model_copy(update={"design": "grid" if plain else "sobol"})
        self.refuse_if(
            method.design == "grid" and not steps,
            "method.design",
            "a grid needs steps",
            remedy='Write steps = 5 beside from and to, or design = "sobol"',
        )
        self.refuse_if(
            method.design != "grid" and method.budget is None,
            "method.budget",
            "is missing",
            allowed="full runs at most, as budget = 200",
        )
        return method
