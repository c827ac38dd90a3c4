"""Where the cases of a study are computed: processes of this machine, or a Dask cluster.

A third engine needs no code: any number of ``underfoot study work`` share the study's folder.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Iterable, Iterator
from typing import Any

from underfoot.core import InputError, UnderfootError
from underfoot.core.optional import optional_module
from underfoot.core.pool import TRIES, answered, available_processors

from .record import Job, Record

Engine = Callable[
    [Callable[[Job], Record], Iterable[Job | None], Callable[[Job], Record]], Iterator[Record]
]
DASK = "dask"
AHEAD = 2
"""Cases that are sent ahead for each thread of a Dask cluster."""
WAIT = 20
"""s within which a scheduler must answer."""
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
        return lambda function, jobs, died: answered(function, jobs, count, died), count
    kind, _, address = on.partition(":")
    if kind != DASK:
        raise InputError(
            f'"{on}" is no engine',
            where="--on",
            allowed='"dask", "dask:tcp://host:8786", or nothing for processes of this machine',
            remedy="In an array job (Slurm, PBS) use underfoot study work in each task",
        )
    return lambda function, jobs, died: _on_dask(function, jobs, died, address, count, told), count


def _on_dask(
    function: Callable[[Job], Record],
    jobs: Iterable[Job | None],
    died: Callable[[Job], Record],
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
        waiting, sent = iter(jobs), {}
        ended = distributed.as_completed()
        try:
            while True:
                _await_worker(client, address, told)
                room = AHEAD * max(sum(client.nthreads().values()), 1) - len(sent)
                for job in _next(waiting, room):
                    future = client.submit(function, job, key=f"case-{job.key}", pure=False)
                    sent[future.key] = job
                    ended.add(future)
                if not sent:
                    return
                future = next(ended)
                job = sent.pop(future.key)
                yield died(job) if _was_killed(distributed, future) else future.result()
                del future
        except (OSError, distributed.CancelledError, distributed.comm.CommClosedError) as error:
            raise UnderfootError(
                f"the Dask scheduler {address} went away ({type(error).__name__})",
                remedy="Finished cases are kept; start it and give the same command again",
            ) from error


def _await_worker(client: Any, address: str, told: Callable[[str], None]) -> None:
    """Wait until a cluster has a worker, and tell what starts one where that takes long."""
    began = time.monotonic()
    while not client.nthreads():
        if time.monotonic() - began >= PATIENCE:
            told(f"No worker: start dask worker {address}")
        time.sleep(0.2)


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
            f"no Dask scheduler answers at {address} ({error})",
            where="--on",
            remedy="Start one with: dask scheduler, and workers with: dask worker ADDRESS",
        ) from error


def _next(jobs: Iterator[Job | None], count: int) -> list[Job]:
    """Return up to so many jobs, fewer where there are none for now."""
    chosen: list[Job] = []
    while len(chosen) < count and (job := next(jobs, None)) is not None:
        chosen.append(job)
    return chosen


def _was_killed(distributed: Any, future: Any) -> bool:
    return future.status == "error" and isinstance(future.exception(), distributed.KilledWorker)
