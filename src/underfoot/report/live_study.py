"""The live page of a study: live.html in its folder, and the same in the app.

Goals are as they were run: the surrogates that the report rests on take longer than such a page
may. What is drawn of many designs is chosen after a look at all of them.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from pathlib import Path
from typing import ClassVar

import numpy as np

from underfoot.core import Progress, UnderfootError
from underfoot.core.arrays import AnyArray, Array
from underfoot.core.page import PageSection, page, remark_sections
from underfoot.core.pool import available_processors
from underfoot.core.presentation import Table, quantity_text
from underfoot.core.progress import time_text
from underfoot.core.remark import NOTHING, Message
from underfoot.core.threads import threads_limited
from underfoot.explore.check import size_text
from underfoot.explore.cost import StudyCost, study_cost
from underfoot.explore.goals import AnyGoal
from underfoot.explore.jobs import BatchJobs
from underfoot.explore.record import Ending
from underfoot.explore.records import ENDINGS
from underfoot.explore.result import MOST_ROWS, Design, front_places
from underfoot.explore.scan import DesignScan, scan_cases
from underfoot.explore.status import StudyStatus
from underfoot.explore.study import Study

from .design_study import explorer, template

PAGE = "live.html"
PERIOD = 10.0
"""s between two pages at least, and between two looks at one."""
SHARE = 0.01
"""Of the time of a study's workers that its pages take at most."""
FIRST_COST = 0.3
"""CPU seconds that a page is thought to take before there was one."""
MOST_SHOWN, MOST_FRONT = 1000, 300
"""Runs of designs that are drawn, and of these on the front."""
LATEST = 20
"""Runs that are drawn because they were set last."""
TOGETHER = 1000
"""Designs whose draws of COF are taken together."""


@dataclass(frozen=True)
class LiveStudy(StudyStatus):
    """A study that runs, as its page shows it: goals as run, and of many designs some."""

    kind: ClassVar[str] = "live_study"

    jobs: BatchJobs
    cost: StudyCost | None = None

    # a run: the cases of a design, which stand together among the jobs

    @cached_property
    def scan(self) -> DesignScan:
        """What is asked of all finished cases."""
        outputs = {goal.output for goal in self.plan.shown_goals}
        draws = any(goal.of_draws for goal in self.plan.shown_goals)
        return scan_cases(self.records, outputs, draws=draws)

    @cached_property
    def _keys_of_runs(self) -> list[Sequence[str]]:
        keys, size = self.jobs.keys, self.plan.cases_per_design
        return [keys[k : k + size] for k in range(0, len(keys) - size + 1, size)]

    @cached_property
    def _endings_of_runs(self) -> AnyArray:
        """(runs, cases) places in ``ENDINGS``."""
        keys = (key for run in self._keys_of_runs for key in run)
        return self.records.ending_places(keys).reshape(-1, self.plan.cases_per_design)

    @cached_property
    def _values_of_runs(self) -> dict[AnyGoal, Array]:
        """(runs,) of each goal and requirement, SI; nan where a case has no numbers."""
        scan, plan = self.scan, self.plan
        shape = (-1, len(plan.states), len(plan.draws))
        last = len(scan.rows)  # of cases that are not finished
        rows = np.array([scan.rows.get(key, last) for run in self._keys_of_runs for key in run])
        rows = rows.astype(np.int64).reshape(shape)
        bad = (self._endings_of_runs != ENDINGS.index(Ending.COMPUTED)).any(axis=1)
        values = {}
        for goal in plan.shown_goals:
            columns = scan.draws if goal.of_draws else scan.outputs[goal.output][:, None]
            assert columns is not None
            parts = [
                goal.values(columns[rows[k : k + TOGETHER]], plan.states)
                for k in range(0, len(rows), TOGETHER)
            ]
            values[goal] = np.where(bad, np.nan, np.concatenate([*parts, np.empty(0)]))
        return values

    @cached_property
    def _allowed_runs(self) -> AnyArray:
        done = (self._endings_of_runs == ENDINGS.index(Ending.COMPUTED)).all(axis=1)
        for each in self.plan.require:
            done &= np.asarray(each.margin(self._values_of_runs[each.goal])) >= 0
        return done

    @cached_property
    def front_runs(self) -> list[int]:
        """Places of the runs on the front of all, the best in the first goal first."""
        if not self.plan.goals:
            return []
        values = np.column_stack([self._values_of_runs[goal] for goal in self.plan.goals])
        return front_places(values * self.plan.signs, self._allowed_runs)

    @cached_property
    def ended_runs(self) -> list[int]:
        """Places of the runs that have all their numbers, or can't have."""
        endings = self._endings_of_runs
        done = (endings != 0).all(axis=1) | (endings > 1).any(axis=1)
        return np.flatnonzero(done).tolist()

    @cached_property
    def shown_runs(self) -> list[int]:
        """Places of the runs that are drawn: all that ended, or of many those that say most."""
        ended = self.ended_runs
        if len(ended) <= MOST_SHOWN:
            return ended
        chosen = {*thin_evenly(self.front_runs, MOST_FRONT), *ended[-LATEST:]}
        for goal, sign in zip(self.plan.goals, self.plan.signs, strict=True):
            values = np.where(self._allowed_runs, sign * self._values_of_runs[goal], np.nan)
            order = np.argsort(values)[: np.count_nonzero(np.isfinite(values))]
            chosen |= {*order[:MOST_ROWS].tolist(), *order[-1:].tolist()}
        others = [k for k in ended if k not in chosen]
        return sorted({*chosen, *thin_evenly(others, MOST_SHOWN - len(chosen))})

    @cached_property
    def all_designs(self) -> list[Design]:
        """The runs that are shown."""
        shown, plan = self.shown_runs, self.plan
        cases = list(product(range(len(plan.states)), range(len(plan.draws))))
        jobs = self.jobs.at(k * plan.cases_per_design for k in shown)
        keys = [dict(zip(cases, self._keys_of_runs[k], strict=True)) for k in shown]
        runs = [(job.design, job.batch) for job in jobs]
        return self._designs_of(jobs, dict(zip(runs, keys, strict=True)))

    @cached_property
    def _place_of_run(self) -> dict[str, int]:
        return {self._keys_of_runs[k][0]: k for k in self.shown_runs}

    def _places(self, designs: Sequence[Design]) -> list[int]:
        return [self._place_of_run[design.records.key] for design in designs]

    def values(self, designs: Sequence[Design], goals: Sequence[AnyGoal]) -> Array:
        """Return (designs, goals) in SI of those that are asked for; nan where one has none."""
        places = self._places(designs)
        columns = [self._values_of_runs[goal][places] for goal in goals]
        return np.array(columns, dtype=float).reshape(len(goals), len(designs)).T

    def goal_estimates(
        self, designs: Sequence[Design], goals: Sequence[AnyGoal]
    ) -> tuple[Array, Array]:
        """Return goals as they were run, with deviations that are not known."""
        values = self.values(designs, goals)
        return values, np.full_like(values, np.nan)

    @cached_property
    def front(self) -> list[Design]:
        """Those of the front that are shown."""
        shown = dict(zip(self._places(self.shown), self.shown, strict=True))
        return [shown[k] for k in self.front_runs if k in shown]

    # what the page says

    @property
    def usable(self) -> bool:
        """Whether any case has numbers, or none ended yet."""
        return bool(self.endings[Ending.COMPUTED]) or set(self.endings) <= {str(Ending.OPEN)}

    @property
    def running_seconds(self) -> float:
        """Time by the clock in which any process worked on it."""
        total = last = 0.0
        for began, end in sorted((s["began"], s["ended"] or self.now) for s in self.sessions):
            total += max(0.0, end - max(began, last))
            last = max(last, end)
        return total

    def cautions(self) -> tuple[Message, ...]:
        """Return what keeps the numbers from being taken as they are, the noise of a run first."""
        texts: list[Message] = []
        if self.plan.goals:
            noises = [noise for goal in self.plan.goals if (noise := self._noise(goal))]
            known = Message(" (standard deviation: {noises:, })", noises=noises) if noises else ""
            texts.append(
                Message(
                    "Goals are as each design was run: a lucky run looks better than it is{known}. "
                    "The report ranks by means of all runs.",
                    known=known,
                )
            )
        if self.scan.every > 1:
            every = self.scan.every
            texts.append(Message("Of the draws of COF every {every}th counts here.", every=every))
        return (*texts, *super().cautions())

    def _noise(self, goal: AnyGoal) -> str:
        errors = self.scan.errors[goal.output]
        known = errors[np.isfinite(errors)]
        middle = float(np.median(known)) if known.size else 0.0
        return f"{goal.output} {quantity_text(middle, goal.unit)}" if middle > 0 else ""

    def table(self) -> Table:
        """Return the best designs as run, the first ones where there is no goal."""
        if not self.plan.goals:
            return self.design_table(self.shown[:MOST_ROWS], "Designs")
        best = self.best(MOST_ROWS) if len(self.plan.goals) == 1 else self.front
        title = "Best designs, as run" if len(self.plan.goals) == 1 else "Front, as run"
        return self.design_table(thin_evenly(best, MOST_ROWS), title)

    def cost_table(self) -> Table:
        """Return what the study took so far, and what is left of it."""
        ended = sum(self.endings.values()) - self.endings[Ending.OPEN]
        left, cost = self.cases_left, self.cost
        clock = self.seconds_left
        rows = [
            ("Cases", str(ended), str(left)),
            (
                "Processor",
                time_text(float(np.nansum(self.scan.case["cpu_seconds"]))),
                time_text(left * cost.cpu_seconds) if cost else "",
            ),
            ("Clock", time_text(self.running_seconds), "" if clock is None else time_text(clock)),
            (
                "Disk",
                size_text(ended * cost.disk) if cost else "",
                size_text(left * cost.disk) if cost else "",
            ),
        ]
        return Table("Cost", ("", "So far", "Left, at most about"), rows)

    def drawn_text(self) -> Message:
        """Return which designs are drawn, where not all that ended are."""
        ended, front, shown = (len(k) for k in (self.ended_runs, self.front_runs, self.shown_runs))
        if shown == ended:
            return NOTHING
        on = min(front, MOST_FRONT)
        of = Message("all {front}", front=front)
        if on < front:
            of = Message("{count} of the {front}", count=on, front=front)
        best = Message("{of} of the front, the best and the worst in each goal, ", of=of)
        return Message(
            "{shown} of {ended} designs that ended are drawn: {best}the {latest} that were set "
            "last, and the others evenly thinned. Front and best are of all.",
            shown=shown,
            ended=ended,
            best=best if front else NOTHING,
            latest=LATEST,
        )


def thin_evenly(items: Sequence, count: int) -> list:
    """Return ``count`` of some items, evenly from first to last; all where they are fewer."""
    places = np.linspace(0, len(items) - 1, min(max(count, 0), len(items))).round().astype(int)
    return [items[k] for k in places]


@threads_limited(1)  # small matrices, which threads make several times dearer
def live_study(study: Study) -> LiveStudy:
    """Return a study as it is in its folder now."""
    store, plan = study.store, study.plan
    jobs, records = store.jobs(), store.records()
    cost = study_cost(plan, store, jobs)
    return LiveStudy(plan, jobs, records, store.sessions(), time.time(), cost)


def live_sections(live: LiveStudy) -> list[PageSection]:
    """Return the designs, the best of them, and why some have no numbers."""
    html = explorer(live, live.shown) if live.shown else ""
    parts = [
        PageSection(
            "Designs", live.drawn_text() if html else "None ended yet.", html=html, first=True
        )
    ]
    table = live.table()
    if table.rows:
        parts.append(PageSection(table.title, table=table))
    return [*parts, *remark_sections(live)]


def live_page(study: Study) -> str:
    """Return the page that stands in the study's folder."""
    live, folder = live_study(study), study.store.folder
    total = sum(live.endings.values()) - live.endings[Ending.OPEN] + live.cases_left
    share = 1.0 - live.cases_left / max(total, 1)
    report = (folder / "report.html").exists() or not live.cases_left  # then it comes next
    head = template("live_study.html").render(
        share=share,
        now=1e3 * live.now,
        period=1e3 * PERIOD,
        working=live.working,
        report=report and not live.working,
    )
    steps = template("live_steps.html").render(
        folder=str(folder.absolute()), working=live.working, method=live.plan.method
    )
    sections = live_sections(live)
    so_far = PageSection("So far", html=head, table=live.cost_table(), first=True)
    parts = [so_far, *sections, PageSection("Stop, widen", html=steps)]
    names = ("sentences.js", "live_study.js", "design_study.js")
    script = "".join(template(name).render() for name in names)
    return page(live, parts, script=script)


def write_live_page(study: Study) -> None:
    """Write the page into the study's folder, whole or not at all."""
    now = Study(study.plan, study.store.folder)  # of all, whatever this process knows
    text = live_page(now)
    with now.store.view(PAGE) as part:
        part.write_text(text, encoding="utf-8")


@contextmanager
def with_live_page(study: Study, progress: Progress, workers: int | None) -> Iterator[Progress]:
    """Yield a receiver of progress that writes the study's page now and then, and at the end.

    Seldom enough that all pages take ``SHARE`` of the time of the workers; None for one a
    processor.
    """
    writer = _Writer(study, workers or available_processors())

    def tell_progress(stage: str, fraction: float, residual: float | None = None) -> None:
        progress(stage, fraction, residual)
        writer.write_if_due()

    try:
        yield tell_progress
    finally:
        at_work = any(session["ended"] is None for session in study.store.sessions())
        if (study.store.folder / PAGE).exists() and not at_work:  # who ends last says so
            writer.write()


class _Writer:
    def __init__(self, study: Study, workers: int) -> None:
        self._study, self._workers = study, workers
        self._began = self._looked = time.monotonic()
        self._spent, self._last = 0.0, FIRST_COST

    def write_if_due(self) -> None:
        now = time.monotonic()
        allowed = SHARE * self._workers * (now - self._began)
        if now - self._looked < PERIOD or self._spent + self._last > allowed:
            return
        self._looked = now
        if not _fresh(self._study.store.folder / PAGE):
            self.write()

    def write(self) -> None:
        began = time.process_time()
        try:
            write_live_page(self._study)
        except (OSError, UnderfootError):
            pass  # a full disk, a damaged case: the run tells
        except Exception as error:  # a fault of the page must not end days of computing
            logging.getLogger(__name__).warning("%s was not written: %r", PAGE, error)
        self._last = time.process_time() - began
        self._spent += self._last


def _fresh(path: Path) -> bool:
    """Return whether another process wrote the page lately."""
    with suppress(OSError):
        return abs(time.time() - path.stat().st_mtime) < PERIOD
    return False
