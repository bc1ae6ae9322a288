"""The file is the one that xarray would write, to a reader; long series go in by blocks."""

import numpy as np
import pytest
import xarray as xr
from long_records import long_test

from reduction.archive import write as netcdf
from reduction.archive.open import open_archive
from reduction.archive.test_dataset import to_dataset
from reduction.archive.write import _write_netcdf
from reduction.record.samples import ColumnWriter, _is_on_disk, empty_like


def opened(path):
    return xr.open_dataset(path, engine="netcdf4", decode_times=False, decode_timedelta=False)


def test_xarray_reads_the_same_as_from_a_file_of_its_own(any_test, tmp_path):
    dataset = to_dataset(any_test, version="1.2.3", command="reduction run")
    _write_netcdf(dataset, tmp_path / "ours.nc")
    for variable in dataset.variables.values():
        variable.encoding["fletcher32"] = "chunksizes" in variable.encoding
    dataset.to_netcdf(tmp_path / "theirs.nc", format="NETCDF4", engine="netcdf4")
    with open_archive(tmp_path / "ours.nc") as ours, opened(tmp_path / "theirs.nc") as theirs:
        assert len(ours.attrs.pop("values_sha256")) == 64
        xr.testing.assert_identical(ours.load(), theirs.load())
        for name, variable in ours.variables.items():
            for key in (
                "dtype", "_FillValue", "zlib", "shuffle", "fletcher32", "chunksizes", "coordinates",
            ):  # fmt: skip
                assert str(variable.encoding.get(key)) == str(
                    theirs.variables[name].encoding.get(key)
                ), (name, key)


@pytest.mark.parametrize("on_disk", [False, True])
def test_a_series_in_blocks_and_from_disk_is_the_same_bytes(on_disk, tmp_path, monkeypatch):
    dataset = to_dataset(long_test(300), version="1.2.3", command="reduction run")
    _write_netcdf(dataset, tmp_path / "whole.nc")
    if on_disk:
        column = ColumnWriter(tmp_path)
        column.append(np.zeros(1 << 18))
        beside = column.finish()
        for name in ("time", "tension"):
            values = dataset[name].values
            scratch = empty_like(beside, shape=(1 << 18,))[: values.size].reshape(values.shape)
            scratch[...] = values
            assert _is_on_disk(scratch)
            dataset[name].variable.data = scratch
    monkeypatch.setattr(netcdf, "_BLOCK", 1000)
    _write_netcdf(dataset, tmp_path / "blocks.nc")
    with (
        open_archive(tmp_path / "whole.nc") as whole,
        open_archive(tmp_path / "blocks.nc") as blocks,
    ):
        xr.testing.assert_identical(whole.load(), blocks.load())


def test_texts_beyond_ascii_and_empty_ones_come_back(tmp_path):
    labels = xr.Variable(("label",), np.array(["größe", "", "m²"]))
    empty = xr.Variable(("label",), np.array(["", "", ""]))
    _write_netcdf(xr.Dataset({"word": labels, "nothing": empty}), tmp_path / "texts.nc")
    with opened(tmp_path / "texts.nc") as found:
        assert found["word"].values.astype(str).tolist() == ["größe", "", "m²"]
        assert found["nothing"].values.astype(str).tolist() == ["", "", ""]
