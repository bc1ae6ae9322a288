"""Where a campaign is worked on: in this process, on workers of this machine, or on the user's."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, nullcontext

from reduction.batch.executor import Workers, local_workers
from reduction.errors import SettingsError


@contextmanager
def chosen_workers(jobs: int | None, scheduler: str | None) -> Iterator[Workers | None]:
    """Give what ``--jobs`` or ``--scheduler`` asks for, and end it afterwards.

    Parameters
    ----------
    jobs : int or None
        Worker processes on this machine; one, or None, is this process itself.
    scheduler : str or None
        Address of a scheduler of Dask.

    Yields
    ------
    workers : Workers or None
        Ready to work; None where this process does it itself.

    Raises
    ------
    SettingsError
        If both are given, or Dask is not there for a scheduler.
    """
    if jobs is not None and scheduler is not None:
        raise SettingsError(
            "--jobs and --scheduler exclude each other",
            found=f"--jobs {jobs} --scheduler {scheduler}",
            hint="How many workers a scheduler has is said where they are started.",
        )
    if scheduler is None:
        with local_workers(jobs) if jobs is not None and jobs > 1 else nullcontext() as workers:
            yield workers
        return
    try:
        from reduction.batch.cluster import users_cluster
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] not in ("dask", "distributed"):
            raise
        raise SettingsError(
            "--scheduler needs Dask, which is not installed",
            found=f"no package '{error.name}'",
            hint="Install it with: pip install 'mooring-reduction[cluster]'. --jobs needs none.",
        ) from error
    with users_cluster(scheduler) as workers:
        yield workers
