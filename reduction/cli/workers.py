"""Where a campaign is worked on: in this process, on workers of this machine, or on the user's."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from reduction.batch.executor import Executor, Serial
from reduction.errors import SettingsError

__all__ = ["chosen_executor"]


@contextmanager
def chosen_executor(jobs: int | None, scheduler: str | None) -> Iterator[Executor]:
    """Give what ``--jobs`` or ``--scheduler`` asks for, and end it afterwards.

    Parameters
    ----------
    jobs : int or None
        Worker processes on this machine; one, or None, is this process itself.
    scheduler : str or None
        Address of a scheduler of Dask.

    Yields
    ------
    executor : Executor
        Ready to work.

    Raises
    ------
    SettingsError
        If both are given, or Dask is not there.
    """
    if jobs is not None and scheduler is not None:
        raise SettingsError(
            "--jobs and --scheduler exclude each other",
            found=f"--jobs {jobs} --scheduler {scheduler}",
            hint="How many workers a scheduler has is said where they are started.",
        )
    if scheduler is None and jobs in (None, 1):
        yield Serial()
        return
    try:
        from reduction.batch.clusters import local_cluster, users_cluster
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] not in ("dask", "distributed"):
            raise
        raise SettingsError(
            "several workers need Dask, which is not installed",
            found=f"no package '{error.name}'",
            hint="Install it with: pip install 'mooring-reduction[cluster]'",
        ) from error
    cluster = local_cluster(jobs or 1) if scheduler is None else users_cluster(scheduler)
    with cluster as executor:
        yield executor
