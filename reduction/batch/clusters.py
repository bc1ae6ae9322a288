"""Worker processes of Dask: started on this machine for one run, or the user's own."""

from __future__ import annotations

import logging
import os
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from multiprocessing.resource_tracker import ensure_running

import dask
from distributed import Client, LocalCluster

from reduction.batch.cluster import DEATHS, PATIENCE, Cluster
from reduction.errors import SettingsError, WorkerError

__all__ = ["local_cluster", "users_cluster"]

_ANSWER = 10.0  # how long a scheduler may take to answer [s]


@contextmanager
def local_cluster(n_workers: int) -> Iterator[Cluster]:
    """Start worker processes on this machine, and end them.

    Parameters
    ----------
    n_workers : int
        How many; they share the processors.

    Yields
    ------
    cluster : Cluster
        Reachable from this machine alone.

    Raises
    ------
    WorkerError
        If they do not start.
    """
    available = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    threads = str(max(1, (available or 1) // n_workers))
    settings = {
        "distributed.scheduler.allowed-failures": DEATHS,
        # samples of the stack and memory given back at every turn take a tenth of the time
        "distributed.worker.profile.enabled": False,
        "distributed.nanny.pre-spawn-environ": {},
    }
    with dask.config.set(settings), _silence():
        try:
            with _interrupts_later():
                cluster = LocalCluster(
                    n_workers=n_workers,
                    threads_per_worker=1,
                    processes=True,
                    dashboard_address="127.0.0.1:0",
                    worker_dashboard_address="127.0.0.1:0",
                    # as in one process, the system says when memory ends: a worker that waits for
                    # memory that it holds itself would wait for ever
                    memory_limit=0,
                    silence_logs=logging.CRITICAL,
                    env={"OMP_NUM_THREADS": threads, "OPENBLAS_NUM_THREADS": "1"},
                )
        except (OSError, RuntimeError, TimeoutError) as error:
            raise WorkerError(
                "worker processes cannot be started on this machine",
                found=f"{type(error).__name__}: {error}",
                hint="Run with --jobs 1, which needs none.",
            ) from error
        with cluster, Client(cluster, set_as_default=False) as client:
            yield Cluster(client)


@contextmanager
def users_cluster(address: str) -> Iterator[Cluster]:
    """Use the workers of a scheduler that runs already.

    Parameters
    ----------
    address : str
        ``tcp://HOST:PORT``.

    Yields
    ------
    cluster : Cluster
        Whose workers are left as they are.

    Raises
    ------
    SettingsError
        If no scheduler answers there.
    WorkerError
        If it has no worker.
    """
    with _silence(), _client(address) as client:
        try:
            client.wait_for_workers(1, timeout=PATIENCE)
        except TimeoutError as error:
            raise WorkerError(
                f"the scheduler {address} has no worker",
                found=f"none for {PATIENCE:.0f} s",
                needed=f"one started with `dask worker {address}`",
            ) from error
        yield Cluster(client)


def _client(address: str) -> Client:
    try:
        return Client(address, timeout=_ANSWER, set_as_default=False)
    except (OSError, ValueError, ImportError) as error:
        raise SettingsError(
            "no scheduler answers at the address of --scheduler",
            found=f"{address}: {error}",
            needed="the address that `dask scheduler` prints, tcp://HOST:PORT",
        ) from error


@contextmanager
def _interrupts_later() -> Iterator[None]:
    """Start processes that a Ctrl-C on the terminal passes by: this process ends them itself.

    What is blocked here stays so in every thread and process that is started meanwhile.
    """
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    ensure_running()  # a process of Python's own, whose start undoes the block
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


@contextmanager
def _silence() -> Iterator[None]:
    """Keep what Dask says of lost workers off the terminal: the run says it in its own words."""
    loud = [
        logger
        for name, logger in logging.root.manager.loggerDict.items()
        if name.partition(".")[0] in ("distributed", "tornado", "asyncio")
        and isinstance(logger, logging.Logger)
    ]
    before = [logger.level for logger in loud]
    for logger in loud:
        logger.setLevel(logging.CRITICAL + 1)
    try:
        yield
    finally:
        for logger, level in zip(loud, before, strict=True):
            logger.setLevel(level)
