"""One door to every format."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from reduction.ingest.blocks import read_blocks
from reduction.ingest.bounded import bounded
from reduction.ingest.delimited import read_delimited
from reduction.ingest.hdf5 import read_hdf5
from reduction.ingest.layout import Format, Layout
from reduction.ingest.limits import Watch
from reduction.ingest.matlab import read_matlab
from reduction.ingest.matrix import read_json
from reduction.ingest.parquet import read_parquet
from reduction.ingest.parts import Parts
from reduction.ingest.rawlog import RawLog
from reduction.ingest.source import unchanged
from reduction.ingest.spreadsheet import read_spreadsheet
from reduction.ingest.tdms import read_tdms
from reduction.settings import Limits

_IN_PARTS: dict[Format, Callable[..., RawLog]] = {
    "delimited": read_delimited,
    "blocks": read_blocks,
    "tdms": read_tdms,
    "hdf5": read_hdf5,
    "parquet": read_parquet,
}
_WHOLE: dict[Format, Callable[..., RawLog]] = {
    "spreadsheet": read_spreadsheet,
    "matlab": read_matlab,
    "json": read_json,
}
_TEXTS = ("delimited", "blocks", "json")  # read by this package, in this process


def read_log(
    path: Path,
    layout: Layout,
    *,
    name: str,
    parts: Parts | None = None,
    limits: Limits | None = None,
) -> RawLog:
    """Read a log in its declared layout.

    Parameters
    ----------
    path : pathlib.Path
        The file.
    layout : Layout
        What it looks like.
    name : str
        File name relative to the campaign folder.
    parts : Parts, optional
        How much is read at a time, and from which length on columns lie on disk.  No number
        depends on it.
    limits : Limits, optional
        What it may be; the defaults where left out.

    Returns
    -------
    log : RawLog
        Declared columns in the file's own units.

    Raises
    ------
    LogError
        If the file is not what the layout says, is beyond a limit, or changes while it is read.
    DataError
        If the scratch files of a long log do not fit on the disk.
    """
    watch = Watch(path, limits)
    with unchanged(path) as n_bytes:
        watch.check_size(n_bytes)
        given: dict[str, Any] = {"name": name, "watch": watch}
        if layout.format in _IN_PARTS:
            given["parts"] = parts or Parts()
        read = (_IN_PARTS | _WHOLE)[layout.format]
        if layout.format in _TEXTS:
            return read(path, layout, **given)
        return bounded(read, path, layout, **given)
