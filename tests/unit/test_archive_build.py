"""Long variables are stored in chunks of which a reader may take one, and no more of them than that needs."""

import math

import netCDF4
import numpy as np
import pytest

from reduction.archive.dataset_builder import build_dataset
from reduction.archive.write import _write_netcdf
from reduction.quantities.names import TEST_SCHEMA

# 65,536 doubles are half a megabyte: a few milliseconds to read, and 1,526 chunks in 1e8 samples
LARGEST = 65536


@pytest.mark.parametrize(
    ("name", "shape", "chunk"),
    [
        ("crosshead_position", (200_000,), (LARGEST,)),
        ("tension", (2, 200_000), (1, LARGEST)),
        ("tension", (2, 30_000), (2, 30_000)),
        ("hysteresis_energy", (2, 100_000), (1, LARGEST)),
        ("crosshead_rate", (100_000, 2), (LARGEST // 2, 2)),
        ("chord_modulus", (2, 40_000, 2), (1, LARGEST // 2, 2)),
        ("tangent_modulus_by_cycle", (2, 24, 2, 60), (2, 24, 2, 60)),
    ],
)
def test_a_chunk_holds_the_last_dimensions_up_to_half_a_megabyte(name, shape, chunk, tmp_path):
    values = {name: np.zeros(shape)}
    build_dataset(values, TEST_SCHEMA, attributes={}).to_netcdf(
        tmp_path / "long.nc", engine="netcdf4"
    )
    with netCDF4.Dataset(tmp_path / "long.nc") as file:
        stored = file[name]
        sizes = stored.chunking()
        filters = stored.filters()
    # the library keeps a chunk within the variable
    assert tuple(sizes) == tuple(min(one, length) for one, length in zip(chunk, shape, strict=True))
    assert filters["zlib"]
    assert filters["shuffle"]
    assert math.prod(sizes) <= LARGEST


def test_a_short_variable_is_not_cut(tmp_path):
    values = {"crosshead_position": np.zeros(4095)}
    build_dataset(values, TEST_SCHEMA, attributes={}).to_netcdf(
        tmp_path / "short.nc", engine="netcdf4"
    )
    with netCDF4.Dataset(tmp_path / "short.nc") as file:
        assert file["crosshead_position"].chunking() == "contiguous"


@pytest.mark.parametrize("is_quantised", [True, False])
def test_a_quantised_channel_is_stored_without_the_filter_that_would_make_it_larger(
    is_quantised, tmp_path
):
    rng = np.random.default_rng(12)
    tension = 400 + 100 * np.sin(np.arange(150_000) / 60) + rng.normal(0, 1, 150_000)
    if is_quantised:
        tension = np.round(tension / 1.085) * 1.085
    dataset = build_dataset({"tension": np.stack([tension, tension])}, TEST_SCHEMA, attributes={})
    sizes = {}
    for shuffle in (True, False):
        dataset["tension"].encoding["shuffle"] = shuffle
        _write_netcdf(dataset, tmp_path / "tried.nc")
        sizes[shuffle] = (tmp_path / "tried.nc").stat().st_size
    found = build_dataset({"tension": np.stack([tension, tension])}, TEST_SCHEMA, attributes={})
    assert found["tension"].encoding["shuffle"] is (sizes[True] < sizes[False])
    assert found["tension"].encoding["shuffle"] is not is_quantised
