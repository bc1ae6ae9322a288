"""Worker processes of Dask: started on this machine for one run, or the user's own."""

from __future__ import annotations

import logging
import os
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from multiprocessing.resource_tracker import ensure_running

import dask
from distributed import Client, LocalCluster, Security
from distributed.comm.addressing import get_address_host_port

from reduction.batch.cluster import DEATHS, PATIENCE, Cluster, scheduler_lost
from reduction.errors import SettingsError, WorkerError

__all__ = ["local_cluster", "users_cluster"]

_ANSWER = 10.0  # how long a scheduler may take to answer [s]
_PORTS = 65_536


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
        # what Dask notes of itself many times a second takes two to four hundredths of a process
        "distributed.admin.tick.interval": "1s",
        "distributed.admin.tick.limit": "1h",
        "distributed.admin.system-monitor.interval": "1h",
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
        If no scheduler answers there, or that is no address.
    WorkerError
        If it has no worker, or is lost while one is waited for.
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
        except OSError as error:
            raise scheduler_lost() from error
        yield Cluster(client)


def _client(address: str) -> Client:
    # a client that fails before it asks waits at its end for an answer, and says so in its words
    if not _is_address(address):
        raise _no_answer(address)
    is_encrypted = address.partition("://")[0] in ("tls", "wss")
    if is_encrypted and Security().get_connection_args("client")["ssl_context"] is None:
        raise SettingsError(
            "the address of --scheduler asks for TLS, and no certificate is known",
            found=address,
            needed="distributed.comm.tls in the configuration of Dask, or tcp://",
        )
    try:
        return Client(address, timeout=_ANSWER, set_as_default=False)
    except (OSError, ValueError, ImportError) as error:
        raise _no_answer(f"{address}: {error}") from error


def _is_address(address: str) -> bool:
    """Whether a text names a host and a port."""
    try:
        return 0 < get_address_host_port(address)[1] < _PORTS
    except ValueError:
        return False


def _no_answer(found: str) -> SettingsError:
    return SettingsError(
        "no scheduler answers at the address of --scheduler",
        found=found,
        needed="the address that `dask scheduler` prints, such as tcp://192.0.2.1:8786",
    )


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
