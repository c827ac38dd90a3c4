"""Finished cases of the explicit matrix, kept on disk so that a stopped run goes on from there."""

from __future__ import annotations

import json
import signal
from collections.abc import Iterator, Sequence
from dataclasses import asdict, replace
from functools import cache
from pathlib import Path

import numpy as np

from underfoot.core.cache import Cache, content_hash

from .g1_cases import G1Case, G1Outcome, G1Row, G1Settings, explicit_outcome

ROOM = "g1_explicit-1"


def explicit_outcomes(cases: Sequence[G1Case], settings: G1Settings) -> Iterator[G1Outcome]:
    """Yield the outcome of every case as it is found, the kept ones first.

    Each is kept under the content of its case, settings and the finite elements' own source, so
    that another version never takes over old numbers. One process a case, ``settings.processes``
    at the same time; leaving the iterator early ends them.
    """
    kept = Cache(ROOM)
    missing: list[G1Case] = []
    for case in cases:
        stored = kept.load(_key(case, settings))
        if stored is None:
            missing.append(case)
        else:
            yield _outcome(stored)
    if not missing:
        return
    if settings.processes == 1:
        for case in missing:
            outcome = explicit_outcome(case, settings)
            kept.store(_key(case, settings), _arrays(outcome))
            yield outcome
        return
    from concurrent.futures import ProcessPoolExecutor, as_completed
    from multiprocessing import active_children, get_context

    # The terminal's Ctrl-C reaches every process of its group: only the first one answers it.
    pool = ProcessPoolExecutor(
        settings.processes,
        mp_context=get_context("spawn"),
        initializer=signal.signal,
        initargs=(signal.SIGINT, signal.SIG_IGN),
    )
    others = set(active_children())
    ended = False
    try:
        waiting = {pool.submit(explicit_outcome, case, settings): case for case in missing}
        for done in as_completed(waiting):
            outcome = done.result()
            kept.store(_key(waiting[done], settings), _arrays(outcome))
            yield outcome
        ended = True
    finally:
        pool.shutdown(wait=ended, cancel_futures=True)
        if not ended:
            for process in set(active_children()) - others:
                process.terminate()


def kept_cases(settings: G1Settings, cases: Sequence[G1Case]) -> int:
    """Return how many of the cases an earlier run has left."""
    folder = Cache(ROOM).folder
    return sum((folder / f"{_key(case, settings)}.npz").is_file() for case in cases)


def _key(case: G1Case, settings: G1Settings) -> str:
    # What other cases are run, and how many at a time, changes nothing in this one.
    alone = replace(settings, series=(case.series,), speeds=(0.0, case.speed), processes=1)
    return content_hash(case, alone, _source())


@cache
def _source() -> str:
    """Return a hash of the program text that the numbers come from."""
    from underfoot.asperity import finite_element

    assert finite_element.__file__ is not None
    files = sorted(Path(finite_element.__file__).parent.rglob("*.py"))
    here = Path(__file__).with_name("g1_cases.py")
    return content_hash(*[path.read_text(encoding="utf-8") for path in (*files, here)])


def _arrays(outcome: G1Outcome) -> dict[str, np.ndarray]:
    return {"row": np.array(json.dumps(asdict(outcome.row))), **outcome.history}


def _outcome(stored: dict[str, np.ndarray]) -> G1Outcome:
    row = G1Row(**json.loads(str(stored["row"])))
    history = {name: array for name, array in stored.items() if name != "row"}
    return G1Outcome(row, history)
