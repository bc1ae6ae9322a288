"""Workers of a user's Dask cluster; only this module imports Dask."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from contextlib import contextmanager

from distributed import Client, KilledWorker, Security
from distributed.comm.addressing import get_address_host_port

from reduction.batch.workers import PATIENCE, Workers, _scheduler_lost
from reduction.record.errors import SettingsError, WorkerError

_ANSWER = 10.0  # time limit for an answer of the scheduler [s]

_PORTS = 65_536


@contextmanager
def users_cluster(address: str) -> Iterator[Workers]:
    """Use the workers of a running scheduler."""
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
            raise _scheduler_lost() from error
        executor = client.get_executor(pure=False)
        yield Workers(
            executor,
            end=lambda: executor.shutdown(wait=False),
            look=lambda: _look(client),
            deadly=(KilledWorker,),
        )


def _look(client: Client) -> None:
    """Refuse to wait for workers that do not appear."""
    try:
        if client.status != "running":
            raise _scheduler_lost()
        if client.nthreads():
            return
    except OSError as gone:  # the client has not noticed it yet
        raise _scheduler_lost() from gone
    raise WorkerError(
        "no worker is left",
        found=f"none, and no test ended for {PATIENCE:.0f} s",
        needed="a worker at the scheduler",
        hint="Archives that were finished are kept; start workers, and run again to continue.",
    )


def _client(address: str) -> Client:
    # a client that fails before it connects waits for an answer at its end, and prints its own
    # message
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
def _silence() -> Iterator[None]:
    """Suppress Dask's messages on lost workers: the run reports them itself."""
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
