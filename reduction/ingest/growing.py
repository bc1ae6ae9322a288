"""A text log that grows by parts: its columns, its clocks, and the rows that they stand in."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from pathlib import Path

import numpy as np

from reduction.errors import ReductionError
from reduction.ingest.clock import clock_to_seconds
from reduction.ingest.columns import Wanted
from reduction.ingest.fields import Fields
from reduction.ingest.layout import CLOCK, Layout
from reduction.ingest.textrows import TextRows
from reduction.record import Floats, Integers
from reduction.samples.blocks import BLOCK
from reduction.samples.scratch import ColumnWriter

AT_A_TIME = 2
"""Parts whose numbers are read together. [1]."""

_WORKERS = 4


def in_order(
    workers: Executor, read: Callable[[TextRows], Fields], parts: Iterator[TextRows]
) -> Iterator[tuple[TextRows, Fields]]:
    """Parts with what has been read from each, a few at the same time.

    An error in the making of a part is told after what stands above it.
    """
    waiting: deque[tuple[TextRows, Future[Fields]]] = deque()
    error: ReductionError | None = None
    is_done = False
    while waiting or not is_done:
        try:
            part = None if is_done else next(parts, None)
        except ReductionError as found:
            part, error = None, found
        is_done = part is None
        if part is not None:
            waiting.append((part, workers.submit(read, part)))
        while waiting and (is_done or len(waiting) >= AT_A_TIME):
            first, fields = waiting.popleft()
            yield first, fields.result()
    if error is not None:
        raise error


class GrowingLog:
    """Columns of a text log, in memory or, where a folder is given, in scratch files there.

    Parameters
    ----------
    wanted : sequence of Wanted
        The columns.
    folder : pathlib.Path or None
        Where the scratch files lie.  The text of a clock stays in memory.
    """

    def __init__(self, wanted: Sequence[Wanted], folder: Path | None) -> None:
        """Begin with no rows."""
        self._wanted = wanted
        self._folder = folder
        self._columns = {want.key: ColumnWriter(folder) for want in wanted if want.unit != CLOCK}
        self._clock: dict[str, list[str]] = {want.key: [] for want in wanted if want.unit == CLOCK}
        self._row: ColumnWriter | None = None
        self.n_rows = 0
        self.first_row = 0

    def add(self, fields: Fields, first_row: int) -> None:
        """Add data rows that follow; the first of them stands in an editor's row.

        Raises
        ------
        DataError
            If the disk is full.
        """
        if not fields.n_rows:
            return
        row = fields.row
        first = first_row if row is None else int(row[0])
        last = first_row + fields.n_rows - 1 if row is None else int(row[-1])
        if not self.n_rows:
            self.first_row = first
        is_next = first == self.first_row + self.n_rows
        if self._row is None and not (is_next and last - first == fields.n_rows - 1):
            self._row = _counted(self._folder, self.first_row, self.n_rows)
        if self._row is not None:
            self._row.append(np.arange(first, last + 1) if row is None else row)
        with ThreadPoolExecutor(_WORKERS) as workers:  # fresh memory is slow to touch
            list(workers.map(self._append, fields.numbers, fields.numbers.values()))
        for key, texts in fields.clock.items():
            self._clock[key] += texts
        self.n_rows += fields.n_rows

    def finish(self, path: Path, layout: Layout) -> dict[str, Floats]:
        """All columns, shape (n_rows,); of a clock the elapsed seconds.

        Raises
        ------
        LogError
            If a text is no clock time.
        """
        self.row: Integers | None = None if self._row is None else self._row.finish()
        self.text = {key: tuple(texts) for key, texts in self._clock.items()}
        with ThreadPoolExecutor(_WORKERS) as workers:
            columns = dict(
                zip(
                    self._columns,
                    workers.map(ColumnWriter.finish, self._columns.values()),
                    strict=True,
                )
            )
        for want in self._wanted:
            if want.unit == CLOCK:
                columns[want.key] = clock_to_seconds(
                    path,
                    self.text[want.key],
                    channel=str(want.column),
                    missing=layout.missing,
                    row=self.row,
                    first_row=self.first_row,
                )
        return {want.key: columns[want.key] for want in self._wanted}

    def _append(self, key: str, pieces: Sequence[Floats]) -> None:
        for piece in pieces:
            self._columns[key].append(piece)


def _counted(folder: Path | None, first: int, size: int) -> ColumnWriter:
    """Rows so far, which were consecutive."""
    writer = ColumnWriter(folder, np.int64)
    for start in range(0, size, BLOCK):
        writer.append(np.arange(first + start, first + min(start + BLOCK, size)))
    return writer
