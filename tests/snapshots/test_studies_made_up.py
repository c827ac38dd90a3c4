"""Studies whole, their solutions made up: quantities, tables, figures and what they conclude."""

import csv
from dataclasses import dataclass, replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from test_studies_answers import drawn, told

import made_answers as made
from snapshot import held, refusal
from underfoot.block.result import MicroAverages, MicroResult
from underfoot.core import Cache, ConvergenceError, DataError, SourcedValue, Status
from underfoot.friction import Pair, packaged_pair_draws
from underfoot.friction.tread_error import TreadPair
from underfoot.questions.sensitivity import InputEffect, Sensitivity
from underfoot.slip.dynamics import FrictionDraws
from underfoot.studies import (
    calibration,
    corpus,
    default_law,
    g1,
    g4,
    g5,
    lug_states,
    pair_law,
    report_ledger,
    runner,
    sources,
    summary,
    tread_pairs,
)
from underfoot.studies import study as study_named
from underfoot.studies.runner import Computed, Options, PublishedStudyResult, StudyTable
from underfoot.studies.verdict import ComputedQuantity


def whole(computed, rows=5):
    """Return all that a study computed, in lines."""
    return {
        "quantities": told(computed.quantities),
        "tables": {one.name: [one.title, one.columns, *one.rows[:rows]] for one in computed.tables},
        "figures": {name: drawn(figure) for name, figure in computed.figures.items()},
        "says": [*computed.conclusions, *computed.notes, *map(str, computed.assumptions)],
    }


def noise(*shape, seed=0):
    """Numbers between -1 and 1 that no library draws."""
    size = int(np.prod(shape))
    return np.cos(12.9898 * (1 + seed) * (1 + np.arange(size)) ** 1.3).reshape(shape)


# everybody's measurements

SOME = (
    "report_g6", "strobel_2012", "li_2006", "groenqvist_1995", "mohamed_2011", "baker_1975",
    "liu_2013", "yamaguchi_2012",
)  # fmt: skip


@pytest.fixture
def few(monkeypatch):
    """Six sources of the corpus."""
    every = [one for one in sources.corpus() if one.name in SOME]
    monkeypatch.setattr(corpus, "corpus", lambda: every)
    return every


@pytest.mark.parametrize("quick", [True, False])
def test_everybodys_measurements(file_regression, few, monkeypatch, quick):
    asked: list[Any] = []

    def cached(room, function, items, keys, *, processes):
        asked.append([room, function.__name__, len(items), len(set(keys)), processes])
        for number, item in enumerate(items):
            if isinstance(item, corpus.LaboratorySplit):
                own = [c for c in corpus.readings() if c.laboratory == item.laboratory]
                level = np.nan_to_num(pair_law.middle(own), nan=-1.4)
                at = 0.9 * level - 0.1 + 0.05 * noise(len(own), seed=number)
                pairs = [(i, i + 1, at[i + 1], at[i + 1] - 0.3, at[i + 1] + 0.4)
                         for i in range(len(own) - 1)
                         if np.isfinite([level[i], level[i + 1]]).all()]  # fmt: skip
                draws = at + 0.4 * noise(40, len(own), seed=number)
                yield item, {"draws": draws, "expected": at, "after": np.array(pairs)}
            elif number == 2:
                yield item, {"reason": np.array("no contact")}
            else:
                cof = 0.2 + 0.1 * np.cos(2.1 * number)
                yield item, {"cof": np.array(cof), "draws": cof * np.exp(0.2 * noise(40))}

    def fitted(law, conditions, *, steps, seed):
        asked.append(["fit", law.name, len(conditions), steps, seed])
        prior = np.array(law.prior)
        theta = prior[:, 0] + 0.2 * prior[:, 1] * noise(60, len(prior))
        return pair_law.PairPosterior(law, theta, 0.3 + 0.1 * noise(60, 4), 50.0)

    monkeypatch.setattr(corpus, "cached_arrays", cached)
    monkeypatch.setattr(corpus, "fit_law", fitted)
    heard: list[Any] = []
    options = Options(quick, 3, 5, progress=lambda *said: heard.append(said))
    made_of = corpus.compute(options)
    held(
        file_regression,
        {**whole(made_of), "asked": asked, "heard": [heard[0], heard[-1]]},
        f"corpus {'quick' if quick else 'full'}",
    )


def test_a_whole_case_of_the_corpus(file_regression, monkeypatch):
    def run(case, *, quick):
        if case == "bad":
            raise ConvergenceError("no  answer\nat all")
        data = {"cof_draws": SimpleNamespace(values=np.arange(3.0))}
        return SimpleNamespace(value=lambda name: (name, quick), data=data)

    monkeypatch.setattr(corpus, "run", run)
    bad: Any = "bad"
    some = corpus.readings()[::9]
    monkeypatch.setattr(corpus, "readings", lambda: some)
    rival = next(iter(pair_law.FEATURE_RIVALS))
    left = corpus.draws_of(corpus.LaboratorySplit(rival, some[0].laboratory, 5))
    held(
        file_regression,
        {
            "run": corpus.whole_cof(cast(Any, "good")), "reason": corpus.whole_cof(bad)["reason"],
            "left": left,
        },
    )  # fmt: skip


# six shoes in two fluids


def effect_of(number, one):
    low, high = (made.outcome(fluid=f * (1 + 0.1 * number)) for f in (70.0, 160.0))
    return InputEffect(one.path, one.reason, 1.0, 2.0, "1", low, high)


def test_six_shoes_in_two_fluids(file_regression, monkeypatch):
    asked: list[Any] = []

    def varied(case, *, inputs, processes=1):
        asked.append([case.name, len(inputs), processes, case.numerics.tread_positions])
        paths = [one.path for one in inputs]
        if "athletic, untreaded, det" in case.name and "shoe.heel.facet_angle" in paths:
            raise ConvergenceError("no")
        effects = tuple(effect_of(k, one) for k, one in enumerate(inputs))
        return Sensitivity(made.outcome(fluid=110.0), effects)

    def run(case):
        asked.append([case.name, case.numerics.grid_spacing])
        bare, oily = "untreaded" in case.name, "glycerol" in case.name
        load = 900.0 * bare * oily + 40.0 * bare + 9.0 * oily + 6e3 * case.numerics.grid_spacing
        one = made.result(cof=0.1 + 0.05 * (not oily), fluid=load + 10 * ("work" in case.name))
        peak = SourcedValue(150.0 * load + 20.0, "Pa", uncertainty=9.0 * load)
        return replace(one, scalars=one.scalars | {g4.PEAK: peak})

    def outcomes(cases, *, quick, processes):
        asked.append([len(cases), quick, processes, cases[0].motion.normal_force])
        return [made.outcome(0.2, fluid=3e3 / (1 + k) ** 3) for k, _ in enumerate(cases)]

    monkeypatch.setattr(g4, "sensitivity", varied)
    monkeypatch.setattr(g4, "run", run)
    monkeypatch.setattr(g4, "outcomes", outcomes)
    heard: list[Any] = []
    said = {}
    for quick in (True, False):
        options = Options(quick, 2, progress=lambda *said: heard.append(said))
        said["quick" if quick else "full"] = whole(g4.compute(options), 2 if quick else 4)
    said["asked"] = asked
    said["heard"] = [[stage, round(share, 3)] for stage, share, *_ in heard[:12:3]]
    held(file_regression, said)


# slips of persons


@dataclass(frozen=True)
class People:
    """A population of a study of slips, by hand."""

    subjects: tuple[Any, ...]
    friction: float
    population: Any
    setting: Any = None
    representative: Any = None
    sole: Any = None
    by_friction: Any = None

    def of(self, name):
        return np.array([getattr(one.seen, name) for one in self.subjects], float)

    def at_friction_draws(self, law=None, draws=40, seed=0):
        cof = self.friction * (1 + 0.3 * noise(draws)) * (1.0 if law is None else 1.2)
        levels = [
            SimpleNamespace(of=lambda name, f=f: self.of(name) * (f if "speed" in name else 1))
            for f in (1.0, 0.8)
        ]
        return FrictionDraws(tuple(levels), (noise(draws, seed=1) > 0).astype(int), cof, seed)

    def correlation(self):
        return 0.87 if self.friction < 0.2 else None

    def rows(self):
        return np.mean([one.seen.row_peaks for one in self.subjects], axis=0)

    def sensor_passages(self):
        count = 4 * len(self.subjects)
        own = sum(one.seen.peak_speed for one in self.subjects)
        lateral = 0.015 + 0.014 * noise(count, seed=int(10 * own))
        row, speed = 1 + np.arange(count) % 3, 1 + 0.4 * noise(count, seed=2)
        peak = 2e5 - 5e6 * lateral + 3e4 * speed + 1e4 * row
        return {"lateral": lateral, "row": row.astype(float), "speed": speed, "peak": peak}

    def peak_speed_at(self, *, effective_mass):
        return None if effective_mass > 0.5 else 0.53 / effective_mass**0.5


def people(count, friction, **more):
    seen = [
        SimpleNamespace(crossed=k != 1, slipped=k % 3 > 0, peak_speed=1.2 + 0.1 * k,
                        peak_pressure=1e5 + 9e3 * k, duration=np.nan if k == 2 else 0.07,
                        row_peaks=(1e5, 8e4 - 1e3 * k, 5e4))
        for k in range(count)
    ]  # fmt: skip
    normal = SimpleNamespace(mean=0.2, sd=0.03)
    population = SimpleNamespace(effective_mass=0.114, rcof=normal, heel_speed=normal)
    setting = SimpleNamespace(friction=SimpleNamespace(assumptions=("a law by hand",)))
    subjects = tuple(SimpleNamespace(seen=one, walker=k) for k, one in enumerate(seen))
    return People(subjects, friction, population, setting, **more)


FILMS = [
    g5.HeldFilm(v, s, np.geomspace(1e-3, 1.0, 9), 90 * v**0.3 * s**0.2 / (1 + np.arange(9) / 4))
    for v, s in [(v, 0.5) for v in g5.HELD_VISCOSITIES]
    + [(v, s) for v in g5.CURVES for s in g5.HELD_SPEEDS if s != 0.5]
]


def test_slips_of_persons(file_regression, monkeypatch):
    asked: list[Any] = []

    def slips(case, *, progress):
        asked.append([case.name, case.numerics.quick_grid_spacing, case.slip])
        progress("slips", 1.0)
        fine = case.numerics.quick_grid_spacing < 0.9e-3
        return people(9 - fine, 0.12) if "untreaded" in case.name else people(7 + fine, 0.3)

    def cached(room, function, items, keys, *, processes):
        asked.append([room, function.__name__, len(items), len(set(keys)), processes])
        return [(item, {"done": np.array(True)}) for item in items]

    monkeypatch.setattr(g5, "slips", slips)
    monkeypatch.setattr(g5, "cached_arrays", cached)
    monkeypatch.setattr(g5, "held_films", lambda options: FILMS)
    monkeypatch.setattr(g5, "law_as_g6_leaves_it", lambda study: "calibrated")
    monkeypatch.setattr(g5, "DRAWS", 50)
    drawn_of = g5.population_draws
    monkeypatch.setattr(
        g5,
        "population_draws",
        lambda study, count, seed: drawn_of(study, count, draws=50, seed=seed),
    )
    heard: list[Any] = []
    said: dict[str, Any] = {}
    for name, options in (
        ("quick", Options(True, 1, progress=lambda *said: heard.append(said))),
        ("full", Options(False, 2, 3, progress=lambda *said: heard.append(said))),
    ):
        said[name] = whole(g5.compute(options))
    said["asked"], said["heard"] = asked, heard
    lonely = replace(people(9, 0.12), subjects=people(9, 0.12).subjects[:2])
    said["lonely"] = sorted(drawn_of(lonely, 3, draws=20))
    said["numbers"] = g5.numbers_of(cast(Any, people(5, 0.3)))
    held(file_regression, said)


@dataclass(frozen=True)
class HeldSetting:
    """What a held heel begins with."""

    settings: Any
    viscosity: float = 0.1
    shoe_angle: float = 0.2
    key: str = "k"


@dataclass(frozen=True)
class Start:
    """Where a film starts."""

    start_film: float = 1.0


def test_a_held_heel(file_regression, monkeypatch):
    lines: list[Any] = []

    class Foot:
        def __init__(self, setting, angle):
            lines.append([setting.viscosity, setting.settings.start_film, setting.key, angle])
            self.count = 0

        def advance(self, step, **held_at):
            self.count += 1
            if self.count < 3:
                lines.append([step, held_at])
            return SimpleNamespace(usable=self.count < 41 - 2 * (len(lines) > 4),
                                   fluid_load=400.0 / self.count)  # fmt: skip

    monkeypatch.setattr(g5, "SoleFoot", Foot)
    begin: Any = HeldSetting(Start())
    film = g5.held_film(begin, 0.02, 0.5)
    held(
        file_regression,
        {
            "film": film, "lines": lines, "at": [film.at(t) for t in (0.0, 1e-3, 0.2, 9.0)],
            "lost": refusal(g5.held_film, begin, 0.02, 0.3), "steps": g5.HELD_STEPS,
            "words": g5.wedge_sentence(FILMS),
            "quantities": told(g5._wedge_squeeze_quantities(FILMS)),
        },
    )  # fmt: skip


# what the data fix


@dataclass(frozen=True)
class Sole:
    """A reduced sole whose slips follow its friction."""

    cofs: Any

    def motion(self, walker):
        return float(self.cofs.mean()) + 0.01 * walker


def test_what_the_data_fix(file_regression, monkeypatch):
    asked: list[Any] = []

    def outcomes(cases, *, quick, processes, progress, stage):
        asked.append([len(cases), quick, processes, stage])
        side = round((len(cases) / 2) ** 0.5)
        load, peak = (
            [calibration.printed_value(name, kind, unit) for kind in calibration.KINDS]
            for name, unit in (("fluid_load", "N"), ("peak_pressure", "Pa"))
        )
        made_of = []
        for k, _ in enumerate(cases):
            shoe, i, j = k // side**2, k // side % side, k % side
            numbers = {
                calibration.LOAD: load[shoe] * (0.8 + 0.22 * i),
                calibration.PEAK: peak[shoe] * (0.75 + 0.2 * j + 0.1 * shoe),
            }
            made_of.append(SimpleNamespace(number=numbers.__getitem__))
        return made_of

    def slips(case, *, progress):
        asked.append(case.name)
        cof = SimpleNamespace(cof=0.2 + 0.1 * noise(60))
        return people(5, 0.2, sole=Sole(np.array([0.3, 0.4])), by_friction=cof)

    def judged(motion):
        speed = None if motion > 0.45 else max(2.0 * (0.45 - motion), 0.0)
        return SimpleNamespace(peak_speed=SimpleNamespace(value=speed))

    monkeypatch.setattr(calibration, "outcomes", outcomes)
    monkeypatch.setattr(calibration, "slips", slips)
    monkeypatch.setattr(calibration, "judge_slip", judged)
    lines = -49.2 + 9 * noise(40), -0.06 + 0.01 * noise(40)
    monkeypatch.setattr(calibration, "precision_of_published", lambda: lines)
    found = {quick: whole(calibration.compute(Options(quick, 2)), 7) for quick in (True, False)}
    held(file_regression, {"quick": found[True], "full": found[False], "asked": asked})


# the law without the report


def test_the_law_without_the_report(file_regression, monkeypatch, tmp_path):
    law = default_law.law_without_report()
    few = packaged_pair_draws().rows(np.arange(30))
    monkeypatch.setenv("UNDERFOOT_CACHE", str(tmp_path))
    prior = np.array(law.prior)
    asked: list[Any] = []

    def fitted(law, conditions, *, steps, seed):
        asked.append([len(conditions), sorted({c.source for c in conditions})[:4], steps, seed])
        theta = prior[:, 0] + 0.1 * prior[:, 1] * noise(3000, len(prior))
        return pair_law.PairPosterior(law, theta, 0.3 + 0.1 * noise(3000, 4), 50.0)

    class Empty(Cache):
        def load(self, key):
            asked.append("looked")

        def store(self, key, arrays):
            asked.append(sorted(arrays))

    monkeypatch.setattr(default_law, "fit_law", fitted)
    monkeypatch.setattr(default_law, "Cache", Empty)
    blind = default_law.draws_without_report.__wrapped__(7)
    pair = Pair(60.0, (3e-6, 5e-6), (1e-6, 1e-6), "aqueous")
    cof, hysteresis, middle = default_law.cof_draws(pair, 2e-3, [0.1, 0.5], 2e5, few, seed=2)
    steps = [np.array([3.0, 2.0, 1.0]), np.array([2.0, 2.0, 0.5]), np.array([1.0, 1.0, 0.6])]
    held(
        file_regression,
        {
            "prior": law.prior, "asked": asked, "source": blind.source, "count": blind.count,
            "sd": [blind.sd_laboratory.mean(), blind.sd_dry_part.mean(), blind.sd_pair.mean(),
                   blind.sd_reading.mean()],
            "constants": blind.constants, "cof": cof, "hysteresis": hysteresis, "middle": middle,
            "viscosities": {name: default_law.viscosity_of(name) for name in default_law.FAMILIES},
            "reading": default_law.with_reading_error(np.ones((30, 2)), few, "a", seed=1),
            "order": [default_law.chance_of_order(steps), default_law.chance_of_order(steps, 0.7),
                      default_law.chance_of_order(steps[:2])],
        },
    )  # fmt: skip


# treads in pairs


def test_treads_in_pairs(file_regression, monkeypatch, tmp_path, capsys):
    names = ("report_g6", "blanchette_2015", "khaday_2021")
    every = [one for one in sources.corpus() if one.name in names]
    monkeypatch.setattr(tread_pairs, "corpus", lambda: every)
    monkeypatch.setattr(tread_pairs, "_place", lambda case: np.arange(6) / 10)
    counted: list[Any] = []

    def of_case(case):
        counted.append(case.value("film.dewetting"))
        if len(counted) == 7:
            raise DataError("no answer")
        cof = 0.2 + 0.1 * np.cos(1.7 * len(counted))
        return np.append(cof, cof * np.exp(0.2 * noise(60)))

    pairs = list(tread_pairs.computed_pairs(of_case))
    monkeypatch.setattr(tread_pairs, "computed_pairs", lambda: iter(pairs))
    tread_pairs.write(tmp_path / "pairs.csv")
    contrast = SimpleNamespace(low=np.nan, high=np.nan, rises=True, step=np.nan)
    ends = {
        "rises": contrast, "falls": SimpleNamespace(**vars(contrast) | {"rises": False}),
        "ratio": SimpleNamespace(**vars(contrast) | {"low": 0.8, "high": 1.3}),
        "slope": SimpleNamespace(**vars(contrast) | {"low": 0.01, "high": 0.02, "step": 3.0}),
    }  # fmt: skip
    held(
        file_regression,
        {
            "pairs": pairs, "left out": capsys.readouterr().err, "wiping": counted,
            "table": (tmp_path / "pairs.csv").read_text(),
            "ends": {name: tread_pairs._published_bounds(cast(Any, one), 0.2)
                     for name, one in ends.items()},
            "contrasts": [[one.source, one.effect, one.topic]
                          for one in tread_pairs.tread_contrasts()],
        },
    )  # fmt: skip


def test_states_of_lugs(file_regression, monkeypatch):
    def pairs(of_case):
        at = float(of_case.__defaults__[0])
        for k, (source, fluid) in enumerate(
            (("report_g6", "thin"), ("li_2006", "thin"), ("li_2006", "thick"), ("x", "thick"))
        ):
            ratio = 0.3 * np.cos(k) + 0.5 * at
            yield TreadPair(source, f"e{k}", fluid, -0.1, 0.4, ratio, 0.2, np.full(6, 0.1 * k),
                            np.zeros(6), 2)  # fmt: skip

    monkeypatch.setattr(lug_states, "computed_pairs", pairs)
    scores = lug_states.states_scores((0.0, 0.5, 2.0))
    held(
        file_regression,
        [[one.stress, one.fitted, one.left_out, one.left_out_thin, len(one.pairs)]
         for one in scores],
    )  # fmt: skip


# the runner, and the ledger


def test_studies_are_run_and_read_again(file_regression, monkeypatch, tmp_path):
    chosen = study_named("g5")
    first = next(one for one in chosen.statements if one.claim == "value")
    small = replace(chosen, statements=(first,))
    counted: list[Any] = []

    def compute(options):
        counted.append([options.quick, options.seed, options.settings])
        if options.seed == 9:
            raise ConvergenceError("no")
        quantity = ComputedQuantity.of(1.0, first.si_unit)
        if options.seed == 2:
            quantity = replace(quantity, unconverged=("a",))
        table = StudyTable("t", "T", ("a", "b"), [(np.float64(1.5), np.nan), ("x", None)])
        return Computed({first.quantity: quantity}, [table], {}, ["so"], ["how"], ["what"])

    class Kept(Cache):
        def __init__(self, room):
            super().__init__(room)
            self.folder = tmp_path / room

    module = SimpleNamespace(compute=compute)
    monkeypatch.setattr(runner, "study_module", lambda name: module)
    monkeypatch.setattr(runner, "study", lambda name: small)
    monkeypatch.setattr(runner, "Cache", Kept)
    heard: list[Any] = []
    options = Options(True, progress=lambda *said: heard.append(said[:2]))
    results = [runner.run_study(small, replace(options, seed=seed)) for seed in (0, 0, 2, 2)]
    said: dict[str, Any] = {"counted": list(counted), "heard": list(heard)}
    one = results[0]
    again = PublishedStudyResult.from_dict(one.to_dict())
    hidden = ("seconds", "process_seconds")
    said["dict"] = {k: v for k, v in again.to_dict().items() if k not in hidden}
    said["with figures"] = sorted(one.to_dict(figures=True))
    said["says"] = (one.heading(), one.headline(), one.cautions(), one.usable, repr(one),
                    one.table(), len(one.tables()), sorted(one.remarks()))  # fmt: skip
    said["settings"] = refusal(runner.run_study, small, Options(settings=3))
    heard.clear()
    every = list(runner.run_all(["g5", "g3"], replace(options, seed=9, settings=4)))
    failed = every[0]
    said["failed"] = (failed.error, failed.headline(), failed.usable, failed.judgements, heard)
    for name in ("g3", "g5"):
        (tmp_path / "r" / name).mkdir(parents=True)
    said["summary"] = summary.summary_markdown([one, failed])
    summary.write_summary([failed], tmp_path)
    with (tmp_path / "summary.csv").open(encoding="utf-8-sig") as stream:
        said["rows"] = list(csv.reader(stream))
    arrays = runner.cached_arrays("room", lambda x: {"a": [x, 2 * x]}, [1, 2], ["k1", "k2"])
    said["arrays"] = list(arrays)
    said["again"] = list(runner.cached_arrays("room", lambda x: {}, [2, 1], ["k2", "k1"]))
    held(file_regression, said)


def test_a_ledger_of_few_rows(file_regression, monkeypatch, tmp_path):
    row = report_ledger.rows()[0]
    name = study_named("g3").statements[0]
    rows = (
        replace(row, evidence=(("statement", name.name), ("test", "t"))),
        replace(row, number="2", how="-", rating="part", cause="by a | bar", evidence=()),
    )
    sentence = report_ledger.Sentence("It slips.", "p. 1", "COF 0.3", "with", "w", "-", "s")
    monkeypatch.setattr(report_ledger, "rows", lambda: rows)
    monkeypatch.setattr(
        report_ledger,
        "sentences",
        lambda: (sentence, replace(sentence, stands="part", decides="d")),
    )
    key = f"{name.text} ({name.place})"
    text = f"| {key} | 1 | t | 2 | - | disagrees | why |\n| a | b |\n"
    verdicts = report_ledger.summary_verdicts(text)
    page = report_ledger.markdown(verdicts)
    (tmp_path / "summary.md").write_text(text, encoding="utf-8")
    report_ledger.main([str(tmp_path)])
    assert (tmp_path / "report.md").read_text(encoding="utf-8") == page
    held(
        file_regression,
        {
            "verdicts": verdicts, "page": page[:4500], "equations": page.count("\n| "),
            "cof": [report_ledger.cof(fluid="water"),
                    report_ledger.cof(fluid="water", shore_a=70.0),
                    report_ledger.cof(family="oil", fluid="canola_oil", sole_rq=3e-6, speed=0.1),
                    report_ledger.cof(family="dry", pressure=1e5, floor_rq=4e-6)],
        },
    )  # fmt: skip


# blocks


def slid(case):
    """What a block that nobody slid gives."""
    where, time = np.maximum(np.arange(9.0) - 3, 0) * 2e-4, 1e-4 * np.arange(9)
    level = 0.02 * case.speed + 2e2 * case.shoe_rz + 1e3 * case.floor_rz
    soft = case.material == "rubber"
    area = 1e-6 * (1 + 9 * soft) / (1 + case.speed)
    pressure = 1.6e5 + 1e4 * case.speed
    loss = 1.0 if soft else 0.5 * (case.series == "broad")
    means = MicroAverages(level * loss, 2 * level, 2.1 * level, area, 0.1, pressure, 2, 0.01, 9e-7,
                          0.09)  # fmt: skip
    lost = (case.speed, case.series, soft) == (1.0, "report", False) and case.floor_rz < 2e-5
    status = Status.NOT_CONVERGED if lost else Status.CONVERGED
    waves = 0.02 * np.sin(2 * np.pi * where / 4e-4)
    return MicroResult(time, where, 0.06 + 0 * time, waves + 0.001, 0 * time, 1e-7 + 1e-8 * time,
                       9e-8 + 0 * time, -1e-5 + 0 * time, 4e-7, means, None, status, 9, 1e-5, 0.5,
                       ("a note",) if soft else ())  # fmt: skip


def test_blocks_of_made_up_runs(file_regression, monkeypatch, tmp_path):
    asked: list[Any] = []
    now: list[Any] = []
    parts = g1.parts_of

    def block(shape, ratio):
        asked.append([shape.elements, round(ratio, 6)])
        return "block"

    def parts_of(case, settings):
        now[:] = [case, settings]
        return parts(case, settings)

    def sliding(block, floor, rubber, loading, *, steps_per_wavelength):
        assert (block, loading.speed) == ("block", now[0].speed)
        if len(asked) < 3:
            asked.append([steps_per_wavelength, loading.control, loading.hold_time,
                          loading.slide_distance])  # fmt: skip
        return slid(now[0])

    monkeypatch.setattr(g1, "parts_of", parts_of)
    monkeypatch.setattr(g1.condensed, "condensed_block", block)
    monkeypatch.setattr(g1.condensed, "condensed_sliding", sliding)
    heard: list[Any] = []
    both = g1.Settings(speeds=(0.1, 1.0))
    said: dict[str, Any] = {}
    for name, quick, settings in (
        ("full", False, both), ("quick", True, None),
        ("by load", False, replace(both, series=("broad",), control="load")),
    ):  # fmt: skip
        options = Options(quick, 1, 0, settings, lambda *told: heard.append(told[:2]))
        computed = whole(g1.compute(options), 3)
        said[name] = computed if name == "full" else [computed["says"], computed["quantities"]]
    said["heard"] = [heard[0], heard[-1], len(heard)]
    said["asked"] = asked[:8]

    def marched(*given):
        asked.append([one.__class__.__name__ for one in given])
        return slid(now[0])

    monkeypatch.setattr(g1.explicit, "explicit_sliding", marched)
    monkeypatch.setattr(g1, "Cache", lambda room: SimpleNamespace(folder=tmp_path))
    monkeypatch.setattr(
        g1, "cached_arrays",
        lambda room, function, items, keys, *, processes: [
            (item, function(item)) for item in items[::-1]
        ],
    )  # fmt: skip
    explicit = replace(both, solver="explicit", series=("report",))
    cells = list(g1.matrix(explicit))
    (tmp_path / f"{g1._key(cells[0], explicit)}.npz").touch()
    said["kept"] = g1.kept_cases(explicit, cells), g1.kept_cases(both, cells)
    options = Options(False, 2, 0, explicit, lambda *told: None)
    computed = whole(g1.compute(options), 5)
    said["explicit"] = [computed["says"], computed["tables"], asked[-1]]
    held(file_regression, said)
