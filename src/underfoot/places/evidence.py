"""What machines read of floors, beside what is predicted with its source left out."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from importlib import resources
from typing import Any, ClassVar

import numpy as np
from scipy.optimize import minimize
from scipy.stats import spearmanr

from underfoot.case.surfaces import RQ_PER_RA
from underfoot.core import to_si
from underfoot.core.arrays import Array
from underfoot.core.presentation import Presentable, Table, percent
from underfoot.core.remark import Message
from underfoot.friction import packaged_pair_draws
from underfoot.friction.tread_error import READING

from .calibration import FloorReading, class_bounds
from .joint import PlaceDraws, interval
from .machines import FLUIDS, RZ_SPREAD, Learned, Machine, machine, machines

DRAWS = 8000
NOTHING = Learned(0.0, 0.0, 0.0, 0.0)
LEAST_SPREAD = 0.02
"""Smallest standard deviation of ln COF between readers or floors that a fit may return."""
CORPUS = {"polished_concrete_2015": "bot-3000e", "fiberon_decking": "english-xl"}
"""Machine of a source of the corpus whose device is called a slipmeter there."""
SOFT = 70.0
"""Shore A between the sliders 55 and 96."""


@dataclass(frozen=True, slots=True)
class Evidence:
    """A published reading of a floor: who read, Rq (m) of the floor, its bounds, the sentence.

    ``printed`` tells a roughness that the source prints from the range of a printed finish.
    """

    source: str
    floor: str
    rq: tuple[float, float]
    printed: bool
    bounds: tuple[FloorReading, ...]
    sentence: str

    @property
    def machine(self) -> Machine:
        """The machine that read."""
        return self.bounds[0].machine

    @property
    def ends(self) -> tuple[float, float]:
        """Lowest and highest reading that the source allows, in the machine's unit."""
        lower = [bound.value for bound in self.bounds if bound.kind != "upper"]
        upper = [bound.value for bound in self.bounds if bound.kind != "lower"]
        return max(lower, default=0.0), min(upper, default=np.inf)

    @property
    def middle(self) -> float | None:
        """The reading, or the middle of its range or class; None of a bound alone."""
        low, high = self.ends
        return (low + high) / 2 if 0 < low <= high < np.inf else None

    def prior_moments(self, machine: Machine) -> tuple[float, float]:
        """Return mean and variance of ln COF by a machine that has learned nothing."""
        log = np.log(self.unlearned_cof(PlaceDraws(count=DRAWS), machine))
        return float(np.median(log)), float(np.var(log))

    def unlearned_cof(self, joint: PlaceDraws, machine: Machine | None = None) -> Array:
        """Return draws (count,) of the COF by a machine that has learned nothing."""
        taught = replace(machine or self.machine, learned=NOTHING)
        return taught.cof(joint, self.floor, self.rq, self.bounds[0].fluid)


@cache
def evidence() -> tuple[Evidence, ...]:
    """Return every published reading: those of the corpus and those of ``evidence.toml``."""
    return (*_of_corpus(), *_of_file())


def _of_corpus() -> Iterator[Evidence]:
    folder = resources.files("underfoot") / "data" / "measurements"
    for file in sorted(folder.iterdir(), key=lambda each: each.name):
        table, name = tomllib.loads(file.read_text("utf-8")), file.name.removesuffix(".toml")
        for entry in table.get("condition", ()):
            at = {**table.get("conditions", {}), **entry}
            device = _machine_of_corpus(name, at)
            if device is None or at["fluid"] != device.fluids[0]:
                continue
            measured = at["measured"]
            ends = [measured.get("low", measured.get("cof")), measured.get("high")]
            values = [_reading(end, device) for end in ends if end is not None]
            kinds = ("value",) if len(values) == 1 else ("lower", "upper")
            fluid = device.fluid_of_standard()
            rq, printed = _floor_rq(at, name)
            bounds = tuple(
                FloorReading(device, fluid, value, kind)
                for value, kind in zip(values, kinds, strict=True)
            )
            reader = str(table.get("laboratory", name))
            yield Evidence(reader, f"{name}, {at['floor']}", rq, printed, bounds, at["quote"])


def _floor_rq(at: Mapping[str, Any], name: str) -> tuple[tuple[float, float], bool]:
    """Return Rq (m) of the floor of a condition, and whether it is printed."""
    given, factor = at.get("floor_rq"), 1.0
    if given is None:
        given, factor = at["floor_ra"], RQ_PER_RA
    spread = isinstance(given, Mapping) and "range" in given
    ends = given["range"] if spread else [given["value"] if isinstance(given, Mapping) else given]
    low, *_, high = [factor * to_si(end, "m", where=name) for end in (*ends, ends[-1])]
    return (low, high), not spread


def _machine_of_corpus(name: str, at: Mapping[str, Any]) -> Machine | None:
    if at.get("device") == "pendulum":
        soft = at["shore_a"]["range"][1] < SOFT
        return machine("pendulum-55" if soft else "pendulum-96")
    if "BOT-3000" in at.get("quote", "") and at["shore_a"]["range"][1] > SOFT:
        return machine("bot-3000e")
    return machine(CORPUS[name]) if name in CORPUS else None


def _reading(given: Any, device: Machine) -> float:
    if isinstance(given, str):
        return float(given.removesuffix(" PTV"))
    return float(device.scale.reading(given))


def _of_file() -> Iterator[Evidence]:
    text = resources.files("underfoot.places").joinpath("evidence.toml").read_text("utf-8")
    for entry in tomllib.loads(text)["reading"]:
        device, source = machine(entry["machine"]), entry["source"]
        printed = "rz" in entry
        low, high = (to_si(end, "m", where=source) for end in entry["rz" if printed else "rq"])
        if printed:
            low, high = low / RZ_SPREAD[1], high / RZ_SPREAD[0]
        fluid = device.fluid_of_standard()
        bounds = (
            class_bounds(device, entry["class"], source)
            if "class" in entry
            else (FloorReading(device, fluid, entry["value"], entry.get("kind", "value")),)
        )
        yield Evidence(source, f"{source}, {entry['floor']}", (low, high), printed, bounds,
                       entry["sentence"])  # fmt: skip


def learn_machine(device: Machine, left_out: str = "") -> Learned | None:
    """Return what readings teach of a machine, those of one source left out.

        ln COF = ln COF of the law + f + u_source + v_floor + e

    u and v are normal; their standard deviations maximise the restricted likelihood, f is the
    generalised least-squares estimate. v is no smaller than the law's own error of a pair. e is the
    error of a reading and of what the floor's roughness leaves open. None of fewer than three
    readings or two sources.

    Source: Patterson and Thompson 1971, Biometrika 58:545.
    """
    read = [
        each
        for each in evidence()
        if each.machine.name == device.name and each.middle is not None
        and each.source != left_out
    ]  # fmt: skip
    sources = [each.source for each in read]
    if len(read) < 3 or len(set(sources)) < 2:
        return None
    law = np.array([_unlearned_scatter(each) for each in read])
    off = np.log([float(device.scale.cof(each.middle)) for each in read]) - law[:, 0]
    alike = np.array([[one == other for one in sources] for other in sources], dtype=float)
    pair = float(np.median(packaged_pair_draws().sd_pair))
    reading = np.diag(law[:, 1] + READING**2 + pair**2)
    ones = np.ones(len(read))

    def covariance(logs: Array) -> Array:
        source, floor = np.maximum(np.exp(logs), LEAST_SPREAD) ** 2
        return reading + source * alike + floor * np.eye(len(read))

    def loss(logs: Array) -> float:
        inverse = np.linalg.inv(covariance(logs))
        weight = ones @ inverse @ ones
        rest = off - ones @ inverse @ off / weight
        return float(
            rest @ inverse @ rest + np.linalg.slogdet(covariance(logs))[1] + np.log(weight)
        )

    spreads = minimize(loss, np.log([0.2, 0.3]), method="Nelder-Mead").x
    inverse = np.linalg.inv(covariance(spreads))
    weight = ones @ inverse @ ones
    source, floor = np.maximum(np.exp(spreads), LEAST_SPREAD)
    factor = float(ones @ inverse @ off / weight)
    return Learned(factor, float(weight**-0.5), float(source), float(np.hypot(floor, pair)))


def floor_likeness(left_out: str = "") -> float:
    """Return how alike two machines find a floor beyond its roughness: a correlation of ln COF.

    Its posterior mean over 0 to 1, by the restricted likelihood of all readings as in
    ``learn_machine``, with the machines' spreads as learned. Machines that read one floor share
    what is not known of its roughness besides. A source is one laboratory whatever it reads with.

    Parameters:
        left_out: A source whose readings do not count.
    """
    read = [
        each
        for each in evidence()
        if each.middle is not None and each.machine.learned and each.source != left_out
    ]
    joint = PlaceDraws(count=DRAWS)
    law = np.log([each.unlearned_cof(joint) for each in read])
    off = np.log([float(each.machine.scale.cof(each.middle)) for each in read])
    off -= np.median(law, axis=1)

    def alike(what: Callable[[Evidence], str]) -> Array:
        names = np.array([what(each) for each in read])
        return (names[:, None] == names).astype(float)

    floor, device = alike(lambda e: e.floor), alike(lambda e: e.machine.name)
    spreads = [(e.machine.learned.source_sd, e.machine.learned.floor_sd)
               for e in read if e.machine.learned]  # fmt: skip
    of_source, of_floor = (np.outer(sd, sd) for sd in np.transpose(spreads))
    rest = np.cov(law) * floor + READING**2 * np.eye(len(read))
    rest += of_source * alike(lambda e: e.source)
    machines_of = np.unique(device, axis=0).T

    def loss(likeness: float) -> float:
        whole = rest + of_floor * floor * np.where(device > 0, 1.0, likeness)
        inverse = np.linalg.inv(whole)
        weight = machines_of.T @ inverse @ machines_of
        left = off - machines_of @ np.linalg.solve(weight, machines_of.T @ inverse @ off)
        volumes = np.linalg.slogdet(whole)[1] + np.linalg.slogdet(weight)[1]
        return float(left @ inverse @ left + volumes)

    grid = np.linspace(0, 1, 101)
    losses = np.array([loss(float(each)) for each in grid])
    density = np.exp(-0.5 * (losses - losses.min()))
    return float(grid @ density / density.sum())


@cache
def _unlearned_scatter(each: Evidence) -> tuple[float, float]:
    return each.prior_moments(each.machine)


@dataclass(frozen=True, slots=True)
class ScoredReading:
    """A published reading and its prediction, median and 95 %, in the machine's unit.

    ``constant`` is the rival: the median of the machine's other sources.
    """

    evidence: Evidence
    predicted: tuple[float, float, float]
    constant: float | None

    @property
    def inside(self) -> bool:
        """Whether the interval of the prediction holds the reading, or reaches its bounds."""
        low, high = self.evidence.ends
        return low <= self.predicted[2] and high >= self.predicted[0]

    @property
    def error(self) -> float | None:
        """Median less reading; None of a bound."""
        return None if self.evidence.middle is None else self.predicted[1] - self.evidence.middle


@dataclass(frozen=True, slots=True)
class MachineScore:
    """How well readings are foreseen: median error in the unit, rank correlation, coverage."""

    count: int
    sources: int
    error: float
    constant_error: float
    rank: float
    inside: float


def score(rows: Sequence[ScoredReading]) -> MachineScore:
    """Return the score of readings that are no bounds."""
    known = [row for row in rows if row.error is not None]
    errors = [abs(row.error or 0.0) for row in known]
    rivals = [
        abs(row.constant - row.evidence.middle)
        for row in known
        if row.constant is not None and row.evidence.middle is not None
    ]
    read = [row.evidence.middle for row in known]
    rank: Any = (
        spearmanr([row.predicted[1] for row in known], read)[0] if len(known) > 2 else np.nan
    )
    return MachineScore(
        len(known),
        len({row.evidence.source for row in known}),
        float(np.median(errors)) if errors else np.nan,
        float(np.median(rivals)) if rivals else np.nan,
        float(rank),
        float(np.mean([row.inside for row in rows])),
    )


@dataclass(frozen=True, slots=True)
class MachineScores(Presentable):
    """The machines, and how their predictions compare with what can be read."""

    kind: ClassVar[str] = "machine_scores"

    rows: tuple[ScoredReading, ...]

    def of(self, *names: str, printed: bool = False) -> tuple[ScoredReading, ...]:
        """Return the readings of some machines, of floors of printed roughness alone if asked."""
        return tuple(
            row
            for row in self.rows
            if row.evidence.machine.name in names and (row.evidence.printed or not printed)
        )

    def heading(self) -> str:
        """Return the title."""
        return "Machines that read floors"

    def headline(self) -> tuple[Message, ...]:
        """Return the score of the pendulum, and what its roughness rests on."""
        rows = self.of("pendulum-96", "pendulum-55")
        told, printed = score(rows), [row for row in self.rows if row.evidence.printed]
        floors = len({row.evidence.floor for row in rows})
        return (
            Message(
                "Pendulum: {count} wet readings of {floors} floors by {sources} sources, each "
                "predicted without its source: {error:.0f} PTV off in the median (the median of "
                "the others: {constant:.0f}), rank correlation {rank:.2f}, {inside} inside the "
                "95 % interval.",
                count=told.count, floors=floors, sources=told.sources, error=told.error,
                constant=told.constant_error, rank=told.rank, inside=percent(told.inside),
            ),
            Message(
                "{printed} of all {count} readings are of floors whose roughness is printed; of "
                "the others a range stands for the finish that is printed.",
                printed=len(printed), count=len(self.rows),
            ),
        )  # fmt: skip

    def table(self) -> Table:
        """Return each reading beside its prediction."""
        rows = []
        for row in self.rows:
            each = row.evidence
            low, median, high = (f"{x:.{_digits(each.machine)}f}" for x in row.predicted)
            ends = " to ".join(f"{1e6 * end:.3g}" for end in each.rq)
            read = ", ".join(bound.value_text for bound in each.bounds)
            verdict = "inside" if row.inside else "OUTSIDE"
            basis = "printed" if each.printed else "finish"
            interval = Message("{low} to {high}", low=low, high=high)
            rows.append((each.floor, each.machine.title, ends, basis,
                         read, median, interval, verdict))  # fmt: skip
        heads = ("Source and floor", "Machine", "Rq, um", "by", "Read", "Predicted", "95 %", "")
        return Table("Readings of floors", heads, rows)

    def tables(self) -> tuple[Table, ...]:
        """Return scores, readings and the machines."""
        rows, scores = [], []
        for one in machines().values():
            taught = one.learned
            rows.append((one.name, one.standard, ", ".join(one.fluids), one.reproducibility,
                         "nothing" if taught is None else
                         f"{np.exp(taught.factor):.2f} ({np.exp(taught.factor_sd):.2f})",
                         "" if taught is None else f"{taught.source_sd:.2f}",
                         "" if taught is None else f"{taught.floor_sd:.2f}"))  # fmt: skip
            if mine := self.of(one.name):
                told = score(mine)
                scores.append((one.title, len(mine), told.sources,
                               *("" if np.isnan(x) else f"{x:.2g}" for x in
                                 (told.error, told.constant_error, told.rank)),
                               percent(told.inside)))  # fmt: skip
        return (
            Table("Each source left out", (
                "Machine", "Readings", "Sources of values", "Off in the median",
                "The others' median", "Rank correlation", "Inside 95 %"), scores),
            self.table(),
            Table("Machines", (
                "Machine", "Standard", "Fluids", "Between those who read",
                "COF over the law's (factor of its sd)", "sd of ln, readers", "floors"), rows),
        )  # fmt: skip


def _digits(device: Machine) -> int:
    return 2 if device.scale.unit == "COF" else 0


def machine_scores(seed: int = 0) -> MachineScores:
    """Return every reading that can be read beside its prediction with the source left out."""
    return MachineScores(tuple(_score_floor(each, seed) for each in evidence()))


def _score_floor(each: Evidence, seed: int) -> ScoredReading:
    device = replace(each.machine, learned=learn_machine(each.machine, each.source))
    joint = PlaceDraws(count=DRAWS, seed=seed)
    read = device.draw_readings(joint, each.floor, each.rq, FLUIDS[device.fluids[0]])
    others = [
        other.middle
        for other in evidence()
        if other.machine.name == device.name and other.source != each.source
        and other.middle is not None
    ]  # fmt: skip
    constant = float(np.median(others)) if others else None
    return ScoredReading(each, interval(read), constant)
