"""Spreadsheets: .xlsx, .xlsm, .xlsb, .xls and .ods, one sheet a log.

Sheets are given by name or by number from 1; rows count as the sheet shows them.
"""

from __future__ import annotations

import struct
import zipfile
import zlib
from collections.abc import Sequence
from pathlib import Path

import fastexcel
import numpy as np

from reduction.errors import LogError
from reduction.ingest.cells import parsed, read_cells
from reduction.ingest.columns import check_lengths, find_column, wanted_columns
from reduction.ingest.layout import Layout
from reduction.ingest.limits import Watch
from reduction.ingest.markup import SoundMarkup, is_markup
from reduction.ingest.preamble import check_units
from reduction.ingest.rawlog import RawLog
from reduction.ingest.source import hash_source

_BLOCK = 1 << 20  # bytes
_NOT_ZIP = (
    zipfile.BadZipFile, zlib.error, OSError, EOFError, NotImplementedError, RuntimeError,
    struct.error, ValueError,
)  # fmt: skip


def open_workbook(path: Path, watch: Watch | None = None) -> fastexcel.ExcelReader:
    """Open a workbook that is sound.

    Raises
    ------
    LogError
        If the file is no workbook, or is damaged.
    """
    if zipfile.is_zipfile(path):
        _check_sound(path, watch or Watch(path))
    with parsed(
        path,
        "the file is not a spreadsheet that can be read",
        needed="an .xlsx, .xls or .ods workbook without a password",
    ):
        return fastexcel.read_excel(path)


def _check_sound(path: Path, watch: Watch) -> None:
    """Unpack every part once: the parser asks neither for checksums nor for sound markup."""
    try:
        with zipfile.ZipFile(path) as archive:
            parts = archive.infolist()
            watch.check_unpacked(sum(part.file_size for part in parts), "the workbook")
            for part in parts:
                markup = SoundMarkup(path, part.filename) if is_markup(part.filename) else None
                with archive.open(part) as stream:
                    while block := stream.read(_BLOCK):
                        watch.check_time()
                        if markup is not None:
                            markup.add(block)
                if markup is not None:
                    markup.finish()
    except LogError:
        raise
    except _NOT_ZIP as error:
        raise LogError(
            path, "the workbook is damaged", found=str(error), needed="an intact workbook",
            hint="Open it in a spreadsheet program and save it again, or get the file again.",
        ) from error  # fmt: skip


def find_sheet(path: Path, sheet_names: Sequence[str], sheet: str | int) -> int:
    """Place from 0 of a sheet given by name or by number from 1."""
    if isinstance(sheet, int) and 1 <= sheet <= len(sheet_names):
        return sheet - 1
    if sheet in sheet_names:
        return sheet_names.index(str(sheet))
    raise LogError(
        path,
        f"there is no sheet {sheet!r}",
        found=", ".join(repr(name) for name in sheet_names) or "no sheets",
        needed=f"one of these names, or a number from 1 to {len(sheet_names)}",
    )


def read_rows(
    path: Path, workbook: fastexcel.ExcelReader, sheet: int, n_rows: int
) -> list[list[str]]:
    """First rows of a sheet as text, from row 1 and column A on; blank cells are ''."""
    with parsed(path, f"sheet {sheet + 1} cannot be read"):
        top = workbook.load_sheet(
            sheet, header_row=None, skip_rows=0, n_rows=n_rows, dtypes="string"
        )
    columns = [column or [] for column in top.to_arrow().to_pydict().values()]
    first = min((info.absolute_index for info in top.selected_columns), default=0)
    return [
        [""] * first + ["" if cell is None else str(cell) for cell in row]
        for row in zip(*columns, strict=True)
    ]


def _head(
    path: Path, workbook: fastexcel.ExcelReader, sheet: int, layout: Layout
) -> tuple[list[list[str]], list[str], list[str]]:
    """Preamble rows, column names and units of a sheet."""
    n_rows = layout.preamble_rows + layout.has_name_row + layout.has_unit_row
    rows = read_rows(path, workbook, sheet, n_rows + 1)
    if len(rows) <= n_rows:
        raise LogError(
            path,
            f"sheet '{workbook.sheet_names[sheet]}' has no data rows",
            found=f"{len(rows)} rows",
            needed=f"more than the {n_rows} rows of its head",
        )
    units = rows[n_rows - 1] if layout.has_unit_row else [""] * len(rows[0])
    names = rows[layout.preamble_rows] if layout.has_name_row else [""] * len(rows[0])
    return rows[: layout.preamble_rows], names, units


def _metadata(sheet_name: str, preamble: list[list[str]]) -> dict[str, str]:
    """Preamble rows by their first cell where there are two, else by their number."""
    metadata = {"sheet": sheet_name}
    for row, cells in enumerate(preamble, start=1):
        texts = [cell.strip() for cell in cells if cell.strip()]
        key, value = f"row {row}", " ".join(texts)
        if len(texts) > 1:
            key, value = texts[0].rstrip(": "), " ".join(texts[1:])
        if texts:
            metadata[f"{key} (row {row})" if key in metadata else key] = value
    return metadata


def read_spreadsheet(
    path: Path, layout: Layout, *, name: str, watch: Watch | None = None
) -> RawLog:
    """Read the declared columns of one sheet.

    Parameters
    ----------
    path : pathlib.Path
        The workbook.
    layout : Layout
        ``sheet``, ``preamble_rows``, ``has_name_row``, ``has_unit_row``, ``missing`` and the
        channels.
    name : str
        Name of the file for the product.
    watch : Watch, optional
        Holds it against its limits.

    Returns
    -------
    log : RawLog
        Rows as the sheet counts them.  Rows at the end in which every declared column is
        blank are left out, with a note.

    Raises
    ------
    LogError
        If the file, the sheet, a column or a cell cannot be used.
    """
    watch = watch or Watch(path)
    source = hash_source(path, name)
    workbook = open_workbook(path, watch)
    sheet = find_sheet(path, workbook.sheet_names, layout.sheet)
    sheet_name = workbook.sheet_names[sheet]
    preamble, names, units = _head(path, workbook, sheet, layout)
    watch.check_columns(len(names))
    watch.check_time()
    first = layout.preamble_rows + layout.has_name_row + layout.has_unit_row
    wanted = wanted_columns(layout)
    places = [
        find_column(
            path,
            want,
            names,
            where=f"sheet '{sheet_name}'",
            row=layout.preamble_rows + 1 if layout.has_name_row else None,
        )
        for want in wanted
    ]
    check_units(
        path,
        list(zip(wanted, places, strict=True)),
        names=names,
        units=units,
        unit_row=first if layout.has_unit_row else None,
    )
    cells = read_cells(path, workbook, sheet, first, places, wanted, layout)
    all_blank = np.logical_and.reduce(cells.blanks)
    n_rows = all_blank.size - int(np.argmin(all_blank[::-1])) if not all_blank.all() else 0
    for want, blank in zip(wanted, cells.blanks, strict=True):
        if blank[:n_rows].any() and "" not in layout.missing:
            raise LogError(
                path,
                f"{int(blank[:n_rows].sum())} cells are blank, this is the first",
                row=first + int(np.argmax(blank)) + 1,
                channel=str(want.column),
                found="a blank cell",
                needed=f"a number in {want.unit}",
                hint='Add "" to the missing marks of the layout where a blank means missing.',
            )
    columns = {want.key: column[:n_rows] for want, column in zip(wanted, cells.values, strict=True)}
    left_out = all_blank.size - n_rows
    return RawLog(
        source=source,
        columns=columns,
        first_row=first + 1,
        n_rows_read=check_lengths(path, columns),
        text={key: texts[:n_rows] for key, texts in cells.text.items()},
        metadata=_metadata(sheet_name, preamble),
        notes=(f"{left_out} blank rows at the end of the sheet are left out",) if left_out else (),
    )
