"""Tables written block by block: the same bytes, in bounded memory."""

import tracemalloc

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from experiments import ABOUT, screening_experiment, surface_experiment
from table_cells import text_of_columns

from reduction.archive.csv_columns import column_blocks, table_blocks
from reduction.archive.csv_definitions import EXPERIMENT_TABLES, TABLES
from reduction.archive.csv_tables import _by_response, table_of, write_tables
from reduction.archive.dataset_builder import SCHEMA_VERSION
from reduction.archive.open import open_archive
from reduction.archive.surfaces_dataset import surfaces_to_dataset
from reduction.record.errors import SettingsError

N_CYCLES = 30000
PER_CYCLE = ("mean_tension", "tension_amplitude", "loss_factor", "hysteresis_energy")


def text_of(archive, table, block_rows):
    blocks = list(column_blocks(archive, archive.variables, table, block_rows=block_rows))
    assert all(0 < len(place) <= block_rows for place, _ in blocks)
    return "".join(text_of_columns(*columns) for _, columns in blocks)


@pytest.mark.parametrize(
    "block_rows",
    [1, 7, *(pytest.param(number, marks=pytest.mark.nightly) for number in (2, 3, 40))],
)
def test_tables_of_tests_are_the_same_for_blocks_of_any_size(archives, block_rows):
    n_filled = 0
    for path in archives:
        with open_archive(path) as archive:
            for table in TABLES:
                whole = text_of(archive, table, 10**9)
                assert text_of(archive, table, block_rows) == whole, table.name
                n_filled += bool(whole)
    assert n_filled > len(TABLES)


@pytest.mark.parametrize("block_rows", [pytest.param(1, marks=pytest.mark.nightly), 5, 64])
def test_tables_of_experiments_are_the_same_for_blocks_of_any_size(block_rows):
    results = [surface_experiment(), screening_experiment()]
    dataset = _by_response(surfaces_to_dataset(results, origin=ABOUT))
    for table in EXPERIMENT_TABLES:
        assert text_of(dataset, table, block_rows) == text_of(dataset, table, 10**9), table.name


@pytest.fixture
def long_archive(tmp_path):
    """An archive that holds nothing but numbers of many cycles."""
    rng = np.random.default_rng(3)
    names = [f"{name}{suffix}" for name in PER_CYCLE for suffix in ("", "_standard_uncertainty")]
    dataset = xr.Dataset(
        {name: (("specimen", "cycle"), rng.random((2, N_CYCLES))) for name in names},
        coords={"specimen": ["new", "used"], "cycle": np.arange(1, N_CYCLES + 1)},
        attrs={"schema_version": SCHEMA_VERSION, "test": "long", "synthetic": "yes"},
    )
    path = tmp_path / "long.nc"
    dataset.to_netcdf(path, engine="netcdf4")
    return path


@pytest.mark.nightly
def test_a_table_of_many_cycles_takes_the_memory_of_a_few_blocks(long_archive, tmp_path):
    write_tables([long_archive], tmp_path / "warm")  # what stays is made before it is measured
    tracemalloc.start()
    write_tables([long_archive], tmp_path / "tables")
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    written = (tmp_path / "tables" / "cycles.csv").stat().st_size
    assert written > 12e6
    assert peak < 12e6
    lines = (tmp_path / "tables" / "cycles.csv").read_bytes().split(b"\r\n")
    assert len(lines) == 2 * N_CYCLES + 2


def test_blocks_read_no_more_of_an_archive_than_their_rows(long_archive):
    (cycles,) = (table for table in TABLES if table.name == "cycles")
    with open_archive(long_archive) as archive:
        assert len(list(table_blocks(archive, cycles))) == 2 * -(-N_CYCLES // 4096)
        assert not any(archive[name].variable._in_memory for name in PER_CYCLE)


def test_a_table_of_an_archive_is_that_of_its_file(archives, tmp_path):
    with open_archive(archives[-1]) as archive:
        write_tables(archives[-1:], tmp_path)
        written = pd.read_csv(tmp_path / "cycles.csv")
        pd.testing.assert_frame_equal(table_of(archive, "cycles"), written, check_dtype=False)
        assert table_of(archive, "stepwise").empty
        with pytest.raises(SettingsError, match="found 'cycle'; needed one of .*cycles"):
            table_of(archive, "cycle")
