"""Where the cases of a study are computed: processes of this machine, or a Dask cluster.

A third engine needs no code: any number of ``underfoot study work`` share the study's folder.
"""

from __future__ import annotations

import logging
import math
import time
from collections.abc import Callable, Iterable, Iterator
from typing import Any

from underfoot.core import InputError, UnderfootError
from underfoot.core.optional import optional_module
from underfoot.core.pool import TRIES, answers_of, available_processors
from underfoot.core.remark import Message

from .record import CaseJob, Record

Engine = Callable[
    [Callable[[CaseJob], Record], Iterable[CaseJob | None], Callable[[CaseJob], Record]],
    Iterator[Record],
]
DASK = "dask"
AHEAD = 2
"""Cases that are sent ahead for each thread of a Dask cluster."""
WAIT = 20
"""s within which a scheduler must answer."""
FRESH = 1.0
"""s for which the number of workers of a cluster is taken as it was."""
PATIENCE = 10.0
"""s after which it is said that a study waits for a worker."""


def engine(on: str | None, workers: int | None, told: Callable[[str], None]) -> tuple[Engine, int]:
    """Return the engine of a name and its number of workers.

    Parameters:
        on: None for processes of this machine, ``"dask"`` for a Dask cluster in this process,
            ``"dask:tcp://host:8786"`` (or a scheduler file) for one that runs.
        workers: None for one a processor.
        told: Receives what keeps the study waiting.

    Raises:
        InputError: Another name.
    """
    count = workers or available_processors()
    if on is None or on == "pool":
        return lambda function, jobs, died: answers_of(function, jobs, count, died), count
    kind, _, address = on.partition(":")
    if kind != DASK:
        raise InputError(
            Message('"{name}" is no engine', name=on),
            where="--on",
            allowed='"dask", "dask:tcp://host:8786", or nothing for processes of this machine',
            remedy="In an array job (Slurm, PBS) use underfoot study work in each task",
        )
    return lambda function, jobs, died: _on_dask(function, jobs, died, address, count, told), count


def _on_dask(
    function: Callable[[CaseJob], Record],
    jobs: Iterable[CaseJob | None],
    died: Callable[[CaseJob], Record],
    address: str,
    workers: int,
    told: Callable[[str], None],
) -> Iterator[Record]:
    """Yield records from a Dask cluster; its nannies replace workers that die."""
    distributed = optional_module("distributed", "dask", "--on dask")
    configured = optional_module("dask.config", "dask", "--on dask").set
    settings = {"distributed.scheduler.allowed-failures": TRIES - 1}
    # a scheduler that goes away is told in a sentence below, not in its client's traceback
    logging.getLogger("distributed.client").setLevel(logging.CRITICAL)
    with configured(settings), _client(distributed, address, workers) as client:
        waiting, sent, threads, asked = iter(jobs), {}, 0, -math.inf
        ended = distributed.as_completed(with_results=True, raise_errors=False)
        try:
            while True:
                if time.monotonic() - asked > FRESH:  # a question to the scheduler each time
                    threads, asked = _threads(client, address, told), time.monotonic()
                for job in _next(waiting, AHEAD * threads - len(sent)):
                    future = client.submit(function, job, key=f"case-{job.key}", pure=False)
                    sent[future.key] = job
                    ended.add(future)
                if not sent:
                    return
                # an answer that came counts, even where its worker has been lost since
                following: Any = next(ended, (None, None))
                future, answer = following
                if future is None or isinstance(answer, distributed.CancelledError):
                    raise distributed.CancelledError("the scheduler no longer knows the cases")
                job, failed = sent.pop(future.key), not isinstance(answer, Record)
                if failed and not isinstance(answer[1], distributed.KilledWorker):
                    raise answer[1]
                yield died(job) if failed else answer
                del following, future, answer
        except (OSError, distributed.CancelledError, distributed.comm.CommClosedError) as error:
            raise UnderfootError(
                Message(
                    "the Dask scheduler {address} went away ({name})",
                    address=address,
                    name=type(error).__name__,
                ),
                remedy="Finished cases are kept; start it and give the same command again",
            ) from error


def _threads(client: Any, address: str, told: Callable[[str], None]) -> int:
    """Return the threads of a cluster; wait for some, and tell what starts a worker."""
    began = time.monotonic()
    while not (threads := sum(client.nthreads().values())):
        if time.monotonic() - began >= PATIENCE:
            told(Message("No worker: start dask worker {address}", address=address))
        time.sleep(0.2)
    return threads


def _client(distributed: Any, address: str, workers: int) -> Any:
    if not address:
        cluster = distributed.LocalCluster(
            n_workers=workers, threads_per_worker=1, processes=True, dashboard_address=None
        )
        return cluster.get_client()
    try:
        if address.endswith(".json"):
            return distributed.Client(scheduler_file=address, timeout=WAIT)
        return distributed.Client(address, timeout=WAIT)
    except (OSError, ValueError) as error:
        raise InputError(
            Message(
                "no Dask scheduler answers at {address} ({error})", address=address, error=error
            ),
            where="--on",
            remedy="Start one with: dask scheduler, and workers with: dask worker ADDRESS",
        ) from error


def _next(jobs: Iterator[CaseJob | None], count: int) -> list[CaseJob]:
    """Return up to so many jobs, fewer where there are none for now."""
    chosen: list[CaseJob] = []
    while len(chosen) < count and (job := next(jobs, None)) is not None:
        chosen.append(job)
    return chosen
