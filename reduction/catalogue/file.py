"""Catalogues of the campaigns of a folder: where they are, and all of them read together."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd
import pyarrow  # type: ignore[import-untyped]
import pyarrow.compute  # type: ignore[import-untyped]
import pyarrow.parquet  # type: ignore[import-untyped]

from reduction import __version__
from reduction.archive.products import archives_in
from reduction.catalogue.columns import CONDITIONS, NUMBER, column_type
from reduction.errors import SettingsError

FILE_NAME = "catalogue.parquet"
MARK = b"reduction_catalogue"
_FORMAT = "2"
_AGAIN = "Run the campaign again, or use --rebuild."
_NO_TESTS = pyarrow.schema(
    [("row", pyarrow.int32()), ("is_whole", pyarrow.bool_())]
    + [(name, column_type(name)) for name in CONDITIONS]
).empty_table()
_NO_VALUES = pyarrow.schema(
    [("row", pyarrow.int32())] + [(name, column_type(name)) for name in NUMBER]
).empty_table()


@dataclass(frozen=True)
class Catalogue:
    """Tests and numbers of a folder.

    Parameters
    ----------
    tests : pandas.DataFrame
        A row for each specimen of each archive, and one before them for the whole archive; the
        index is counted through.
    numbers : pandas.DataFrame
        ``row`` of ``tests``, ``quantity``, ``value``, ``standard_uncertainty`` (SI), and a column
        for each dimension along which numbers stand.
    unreadable : dict of str to str
        Campaigns and archives that are not in it, each with the reason.
    """

    tests: pd.DataFrame
    numbers: pd.DataFrame
    unreadable: dict[str, str]


def mark() -> bytes:
    """What a catalogue of this version says of itself."""
    return f"{_FORMAT} {__version__}".encode()


def load_catalogue(folder: Path, quantities: Sequence[str] | None = None) -> Catalogue:
    """Read the catalogues of all campaigns of a folder.

    Parameters
    ----------
    folder : pathlib.Path
        Holds a folder for each campaign.
    quantities : sequence of str, optional
        Whose numbers are read; left out: all.

    Returns
    -------
    catalogue : Catalogue
        Archives that are gone are not in it.

    Raises
    ------
    SettingsError
        If the folder is none of processed campaigns.
    """
    tests, values, unreadable = [_NO_TESTS], [_NO_VALUES], {}
    n_rows = 0
    for campaign in campaigns_below(folder):
        shown = shown_path(campaign.name)
        try:
            there = {shown_path(path.name) for path in archives_of(campaign)}
            if not there:
                continue
            about, found = _tables_of(campaign / FILE_NAME, quantities)
        except (OSError, pyarrow.ArrowException) as error:
            words = getattr(error, "strerror", None) or str(error).partition("\n")[0]
            unreadable[shown] = f"{shown}: {FILE_NAME} cannot be read; found {words}. {_AGAIN}"
            continue
        known = about["archive"]
        for name in sorted(there - set(known.to_pylist())):
            unreadable[f"{shown}/{name}"] = f"{shown}/{name} is not in {FILE_NAME}. {_AGAIN}"
        about = _counted_from(n_rows, about)
        path = pyarrow.compute.binary_join_element_wise(shown, known, "/")
        about = about.set_column(about.schema.get_field_index("archive"), "archive", path)
        tests.append(about.filter(pyarrow.compute.is_in(known, pyarrow.array(sorted(there)))))
        values.append(_counted_from(n_rows, found))
        n_rows += about.num_rows
    of_tests = pyarrow.concat_tables(tests, promote_options="default").to_pandas()
    numbers = pyarrow.concat_tables(values, promote_options="default").to_pandas()
    numbers = numbers[numbers["row"].isin(of_tests["row"])]
    return Catalogue(of_tests.set_index("row"), numbers, unreadable)


def _tables_of(path: Path, quantities: Sequence[str] | None) -> tuple[Any, Any]:
    """Rows of tests, and of numbers without what their tests say."""
    # opened here: a path may be no text; in one thread: of many small files each is quickest so
    with path.open("rb") as opened, pyarrow.parquet.ParquetFile(opened) as file:
        names = file.schema_arrow.names
        if (file.schema_arrow.metadata or {}).get(MARK) != mark():
            raise OSError("one of another version, or of another program")
        about = file.read_row_group(0, columns=_NO_TESTS.column_names, use_threads=False)
        numbers = file.read_row_groups(
            range(1, file.num_row_groups),
            columns=[name for name in names if name not in (*CONDITIONS, "is_whole")],
            use_threads=False,
        )
    if quantities is not None:
        wanted = pyarrow.array(list(quantities), pyarrow.string())
        numbers = numbers.filter(pyarrow.compute.is_in(numbers["quantity"], wanted))
    return about, numbers


def _counted_from(first: int, table: Any) -> Any:
    row = pyarrow.compute.add(table["row"], pyarrow.scalar(first, pyarrow.int32()))
    return table.set_column(table.schema.get_field_index("row"), "row", row)


def shown_path(path: str) -> str:
    r"""A path as text that any file takes: bytes that are no text stand as ``\\xff``.

    Examples
    --------
    >>> shown_path("campaign\udcff/T-1.nc")
    'campaign\\xff/T-1.nc'
    """
    return path.encode("utf-8", "surrogateescape").decode("utf-8", "backslashreplace")


def archives_of(campaign: Path) -> list[Path]:
    """Archives of a campaign, by name; what begins with a dot is none."""
    return [path for path in archives_in(campaign) if not path.name.startswith(".")]


def campaigns_below(folder: Path) -> list[Path]:
    """Folders of the campaigns of a folder of products.

    Parameters
    ----------
    folder : pathlib.Path
        Holds one folder for each campaign.

    Returns
    -------
    campaigns : list of pathlib.Path
        In order of their names; those whose names begin with a dot are left out.

    Raises
    ------
    SettingsError
        If there is no such folder, it cannot be read, or it is that of one campaign.
    """
    if not folder.is_dir():
        raise SettingsError(
            f"there is no folder {shown_path(str(folder))}",
            needed="a folder of processed campaigns",
            hint="Run a campaign first, or name the folder of its products.",
        )
    try:
        with os.scandir(folder) as entries:
            inside = sorted((Path(one.path) for one in entries), key=lambda path: path.name)
    except OSError as error:
        raise SettingsError(
            f"the folder {shown_path(str(folder))} cannot be read",
            found=error.strerror or str(error),
            needed="a folder of processed campaigns",
        ) from error
    for path in inside:
        if path.suffix == ".nc" and path.is_file():
            raise SettingsError(
                f"{shown_path(str(folder))} is the folder of one campaign",
                found=f"the archive {shown_path(path.name)}",
                needed="the folder above it, which holds the campaigns",
                hint="To see one of them, use --campaign.",
            )
    return [path for path in inside if not path.name.startswith(".") and path.is_dir()]
