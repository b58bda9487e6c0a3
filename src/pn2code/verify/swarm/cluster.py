"""The workers of a swarm, by `dask.distributed`: processes on this machine, or those of a scheduler elsewhere.

with Cluster(workers=2) as pool:
    pool.start(d)
    for result in pool.results(job, searches): ...

A worker that is killed is replaced, and what it had to do is done again: searches are repeatable. On this machine its
explorer ends with it.
"""

from __future__ import annotations

import importlib.util
import logging
import os
import queue
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from typing import Any

from pn2code.base.closing import Closing
from pn2code.base.deadline import NEVER, Deadline
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.verify.codes import SWARM_UNAVAILABLE
from pn2code.verify.swarm import task
from pn2code.verify.swarm.task import Job

INSTALL = "pip install 'pn2code[swarm]'"
_LOOK_S = 0.05
"""So often it is looked whether the time is over while all workers are busy."""
_CONNECT_S = 30.0


def dask_setup(_: object) -> None:
    """Called in each worker process of this machine when it starts: Ctrl-C is for the command, which passes it on."""
    os.setsid()


class Cluster(Closing):
    """A pool of workers, as long as the block lasts.

    Args:
        workers: processes on this machine.
        scheduler: the address of a scheduler that has workers; None: this machine does it.
    """

    def __init__(self, workers: int, scheduler: str | None = None) -> None:
        self._workers = workers
        self._scheduler = scheduler
        self._stack = ExitStack()
        self._client: Any = None
        self._job = ""
        self._futures: list[Any] = []

    def close(self) -> None:
        """Ends the workers that are here."""
        self._stack.close()
        self._client = None

    @property
    def is_here(self) -> bool:
        """Whether the workers are processes of this command."""
        return self._scheduler is None

    @property
    def workers(self) -> int:
        """How many there are now."""
        if self.is_here or self._client is None:
            return self._workers
        return len(self._client.nthreads())

    def start(self, d: Diagnostics, deadline: Deadline = NEVER) -> bool:
        """Makes them ready, if they are not, and waits no longer for a scheduler; False after an error."""
        if self._client is not None:
            return True
        if importlib.util.find_spec("distributed") is None:
            d.error(
                SWARM_UNAVAILABLE,
                "the package `distributed` is not installed, which carries out the searches of a swarm",
                Origin("--swarm"),
                hint=f"`{INSTALL}` brings it",
            )
            return False
        distributed: Any = importlib.import_module("distributed")
        try:
            address = self._scheduler or self._local(distributed)
            self._client = self._stack.enter_context(
                distributed.Client(address, timeout=_patience(deadline))
            )
            if not self.is_here and not self.workers:
                raise OSError("it has no workers")
        except (OSError, ValueError, RuntimeError) as problem:
            self._stack.close()
            self._client = None
            where = f"the scheduler at `{self._scheduler}`" if self._scheduler else "the workers"
            d.error(
                SWARM_UNAVAILABLE,
                f"{where} cannot be used: {problem}",
                Origin(self._scheduler or "--swarm"),
                hint="`dask scheduler` and `dask worker ADDRESS` start them; without `--scheduler` this machine does it"
                if self._scheduler
                else "without `--swarm` this process explores alone",
            )
            return False
        return True

    def _local(self, distributed: Any) -> Any:
        folder = self._stack.enter_context(tempfile.TemporaryDirectory(prefix="pn2code-"))
        return self._stack.enter_context(
            distributed.LocalCluster(
                n_workers=self._workers,
                threads_per_worker=1,
                processes=True,
                host="127.0.0.1",
                dashboard_address="127.0.0.1:0",  # any port that is free
                worker_dashboard_address=None,
                memory_limit=0,  # the explorers count their own
                local_directory=folder,
                silence_logs=logging.CRITICAL,
                preload=[__name__],
            )
        )

    def results(
        self, job: Job, searches: Sequence[tuple[str, ...]]
    ) -> Iterator[tuple[int, dict[str, Any]] | None]:
        """What each search has found, with its number, as soon as it has; now and then None, while all are at work."""
        client = self._client
        done: queue.SimpleQueue[int] = queue.SimpleQueue()
        self._job = job.name
        # One task makes the job, so that it is sent once to each worker, and can be made again where one has gone.
        common = client.submit(_same, job, key=f"job-{job.name}", pure=False)
        count = len(searches)
        self._futures = client.map(
            task.run,
            [common] * count,
            range(count),
            searches,
            key=[f"search-{job.name}-{i:06}" for i in range(count)],
            pure=False,
        )
        for i, future in enumerate(self._futures):
            future.add_done_callback(lambda _, i=i: done.put(i))
        left = len(searches)
        try:
            while left:
                try:
                    number = done.get(timeout=_LOOK_S)
                except queue.Empty:
                    yield None
                    continue
                left -= 1
                future = self._futures[number]
                if future.status == "finished":
                    result = future.result()
                    future.release()  # the worker need not keep it
                    yield number, result
                elif future.status == "error":
                    yield number, {"said": None, "problem": str(future.exception())}
                else:
                    yield number, {"said": None, "problem": ""}  # it was not wanted any more
        finally:
            client.cancel([*self._futures, common])
            self._futures = []

    def end(self, first: int, *, gently: bool) -> None:
        """Searches from that number on are not wanted any more; `gently`: but what they have found until now is."""
        client = self._client
        if client is None or not self._job:
            return
        if not gently:
            client.cancel(self._futures[first:])
        client.run(task.end_soon, self._job, first, gently, on_error="ignore", wait=False)


def _patience(deadline: Deadline) -> float:
    """Seconds that a scheduler has to answer."""
    left = deadline.left
    return _CONNECT_S if left is None else min(_CONNECT_S, max(left, _LOOK_S))


def _same(job: Job) -> Job:
    return job
