"""Only an archive of this schema is opened."""

import errno
import os
import subprocess
import sys
from contextlib import contextmanager

import h5py
import netCDF4
import numpy as np
import pytest

from reduction import __version__
from reduction.archive import open as module
from reduction.archive.dataset_builder import SCHEMA_VERSION
from reduction.archive.open import (
    ReadOnce,
    as_kept,
    failing_reads,
    in_memory,
    open_archive,
    reading,
)
from reduction.archive.test_dataset import to_dataset
from reduction.archive.write import write_archive
from reduction.record.errors import ArchiveError


def test_text_and_elapsed_time_come_back_decoded(rich_test, write):
    with open_archive(write(rich_test)) as archive:
        assert archive["specimen"].values.tolist() == ["new", "used"]
        assert archive["strain_method"].values.tolist() == ["tension-driven"] * 2
        assert archive["time"].values[1] == 0.1
        assert archive["rated_break_strength_source"].values.tolist() == ["maker", ""]


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(ArchiveError, match=r"there is no archive .*T-9.nc"):
        open_archive(tmp_path / "T-9.nc")


def test_a_file_that_is_not_netcdf_is_refused(tmp_path):
    path = tmp_path / "T-1.nc"
    path.write_text("time,tension\n0,1\n")
    with pytest.raises(
        ArchiveError, match=r"cannot be read as a netCDF file; found .*; needed an archive"
    ):
        open_archive(path)


@pytest.fixture
def of_schema(rich_test, write):
    """A whole archive that states another schema."""

    def change(**attributes):
        path = write(rich_test)
        with netCDF4.Dataset(path, "a") as file:
            file.setncatts(attributes)
        return path

    return change


@pytest.mark.parametrize(
    ("attributes", "message"),
    [
        ({"schema_version": "0.9"}, "has another schema; found version 0.9; needed .*1.x"),
        ({"schema_version": "1"}, "has another schema; found version 1;"),
        ({"schema_version": "1.x"}, "has another schema"),
        ({"schema_name": "tide gauge"}, "has another schema; found tide gauge, version 1.0"),
        (
            {"schema_version": "2.0", "software_version": "3.1.4"},
            r"written by a later version .*; found schema version 2\.0, software 3\.1\.4; needed "
            r"schema version 1\.x\. Open it with that version",
        ),
        ({"schema_version": "10.0"}, "written by a later version"),
    ],
)  # fmt: skip
def test_another_schema_is_refused(of_schema, attributes, message):
    with pytest.raises(ArchiveError, match=message):
        open_archive(of_schema(**attributes))


def test_a_file_without_a_schema_is_refused(tmp_path):
    path = tmp_path / "T-1.nc"
    netCDF4.Dataset(path, "w").close()
    with pytest.raises(ArchiveError, match="has another schema; found none; needed .*1.x"):
        open_archive(path)


def test_a_later_minor_version_is_read_and_what_it_adds_passed_over(of_schema):
    path = of_schema(schema_version="1.7")
    with netCDF4.Dataset(path, "a") as file:
        file.createVariable("colour_of_the_tether", "f8", ())[...] = 3.0
    with open_archive(path) as archive:
        assert archive.attrs["schema_version"] == "1.7"
        assert float(archive["colour_of_the_tether"]) == 3.0
        assert "tension" in archive


def test_the_cache_of_other_files_is_left_as_it_was(rich_test, write):
    before = netCDF4.get_chunk_cache()
    with open_archive(write(rich_test)):
        assert netCDF4.get_chunk_cache() == before


def test_an_archive_that_the_system_refuses_is_told_so(tmp_path, monkeypatch):
    def refused(path):
        raise OSError(errno.EIO, os.strerror(errno.EIO))

    path = tmp_path / "T-1.nc"
    path.touch()
    monkeypatch.setattr(module, "_fault_stored", refused)
    with pytest.raises(ArchiveError, match="T-1.nc cannot be read .*Input/output error"):
        open_archive(path)


@pytest.fixture
def rotten(tmp_path):
    """An archive that opens, and no part of whose ``tension`` can be unpacked."""
    path = tmp_path / "T-1.nc"
    with netCDF4.Dataset(path, "w") as file:
        file.schema_version = SCHEMA_VERSION
        file.createDimension("specimen", 1)
        file.createDimension("sample", 5000)
        made = file.createVariable("tension", "f8", ("specimen", "sample"), compression="zlib")
        made[:] = range(5000)
    with h5py.File(path) as file:
        chunk = file["tension"].id.get_chunk_info(0)
    with path.open("r+b") as file:
        file.seek(chunk.byte_offset)
        file.write(b"\xff" * chunk.size)
    return path


def test_an_error_of_the_library_while_values_are_read_names_the_file(rotten):
    with reading(rotten) as archive:
        assert archive["tension"].shape == (1, 5000)
    with (
        pytest.raises(ArchiveError, match=r"\.nc cannot be read; found NetCDF: .*Check the disk"),
        reading(rotten) as archive,
    ):
        archive["tension"].load()


@pytest.mark.parametrize(
    "error",
    [
        AttributeError("NetCDF: Can't open HDF5 attribute"),
        OSError(-101, "NetCDF: HDF error", "T-1.nc"),
        RuntimeError("NetCDF: HDF error"),
    ],
)
def test_the_library_fails_in_three_ways(error):
    with (
        pytest.raises(ArchiveError, match=r"T-1\.nc cannot be read; found NetCDF: \w"),
        failing_reads("T-1.nc"),
    ):
        raise error


@pytest.mark.parametrize("error", [AttributeError("'NoneType'"), OSError(5, "x"), RuntimeError()])
def test_errors_that_are_not_of_the_library_are_passed_on(error):
    with pytest.raises(type(error)) as raised, failing_reads("T-1.nc"):
        raise error
    assert raised.value is error


@pytest.mark.skipif(sys.platform != "linux", reason="names of files are bytes on Linux alone")
def test_a_name_that_the_process_cannot_write_down_is_no_fault_of_the_file(tmp_path):
    path = tmp_path / os.fsdecode(b"pr\xfcfung.nc")
    h5py.File(tmp_path / "named.nc", "w").close()
    (tmp_path / "named.nc").rename(path)
    with pytest.raises(
        ArchiveError, match=r"cannot be given to the netCDF library; found .*Set PYTHONUTF8=1"
    ):
        open_archive(path)


@pytest.fixture
def opened(monkeypatch):
    """Names of the files that are opened."""
    names = []

    def told(path):
        names.append(path.name)
        return reading(path)

    monkeypatch.setattr(module, "reading", told)
    return names


@pytest.mark.parametrize("version", [__version__, "1.2.3"])
def test_an_archive_is_opened_once_and_given_as_it_is_on_the_disk(
    rich_test, tmp_path, opened, version
):
    path, opener = tmp_path / "T-1.nc", ReadOnce()
    write_archive(to_dataset(rich_test, version=version, command="reduction run"), path)
    with open_archive(path) as on_disk:
        for _ in range(3):
            with opener(path) as archive:
                assert archive.identical(on_disk)
                assert list(archive.variables) == list(on_disk.variables)
                for name, variable in archive.variables.items():
                    assert variable.dtype == on_disk.variables[name].dtype
    assert opened == [path.name]


def test_a_file_that_was_replaced_is_read_anew(rich_test, bare_test, write, opened):
    path, opener = write(rich_test), ReadOnce()
    with opener(path):
        pass
    write(bare_test).replace(path)
    with opener(path) as archive, open_archive(path) as on_disk:
        assert archive.identical(on_disk)
    assert len(opened) == 2


def test_a_file_that_is_replaced_while_it_is_read_is_read_anew(
    rich_test, bare_test, write, monkeypatch, tmp_path
):
    path, opener = write(rich_test), ReadOnce()
    path = path.replace(tmp_path / "one.nc")
    other = write(bare_test)
    opened = module.reading

    @contextmanager
    def replaced(place):
        with opened(place) as archive:
            if other.exists():
                other.replace(place)
            yield archive

    monkeypatch.setattr(module, "reading", replaced)
    with opener(path):
        pass
    with opener(path) as archive, open_archive(path) as on_disk:
        assert archive.identical(on_disk)


def test_a_file_that_is_gone_is_not_given_from_memory(rich_test, write):
    path, opener = write(rich_test), ReadOnce()
    with opener(path):
        path.unlink()
    with pytest.raises(ArchiveError, match="there is no archive"), opener(path):
        pass


def test_a_step_cannot_change_what_the_next_one_is_given(rich_test, write):
    path, opener = write(rich_test), ReadOnce()
    for _ in range(2):
        with opener(path) as archive:
            assert "added" not in archive
            archive["added"] = 1.0
            archive.variables["diameter"].values[...] = 0
    with opener(path) as archive, open_archive(path) as on_disk:
        assert archive.identical(on_disk)


def test_where_the_disk_is_full_archives_are_read_again(rich_test, write, opened, monkeypatch):
    def full(self, content):
        raise OSError(errno.ENOSPC, "no space left")

    monkeypatch.setattr(module.ScratchFile, "put", full)
    path, opener = write(rich_test), ReadOnce()
    for _ in range(2):
        with opener(path) as archive, open_archive(path) as on_disk:
            assert archive.identical(on_disk)
    assert len(opened) == 2


def test_an_archive_in_memory_outlives_its_file(rich_test, write):
    path = write(rich_test)
    with open_archive(path) as archive:
        kept = in_memory(archive)
    with open_archive(path) as on_disk:
        assert kept.identical(on_disk)


def test_as_many_are_kept_as_there_is_room_for(
    rich_test, bare_test, write, opened, tmp_path, monkeypatch
):
    monkeypatch.setattr(module, "_ROOM", 0)
    first, opener = write(rich_test), ReadOnce()
    first = first.replace(tmp_path / "first.nc")
    second = write(bare_test)
    for _ in range(2):
        for path in (first, second):
            with opener(path) as archive:
                assert np.all(np.isfinite(archive["diameter"]))
    assert opened == ["first.nc", second.name, second.name]


def test_what_is_large_is_not_read_whole(rich_test, write, opened, monkeypatch):
    monkeypatch.setattr(module, "LARGEST", 100)
    path, opener = write(rich_test), ReadOnce()
    for _ in range(2):
        with opener(path) as archive:
            assert not archive.variables["tension"]._in_memory
    assert len(opened) == 2


def test_an_error_in_a_block_is_that_of_the_block(rich_test, write):
    path, opener = write(rich_test), ReadOnce()
    for _ in range(2):
        with pytest.raises(KeyError, match="none"), opener(path) as archive:
            archive.variables["none"]


def test_what_is_read_by_the_schema_is_what_xarray_opens(rich_test, write):
    path = write(rich_test)
    with open_archive(path) as on_disk:
        found = module._read_own(path)
        assert found is not None
        assert found.identical(on_disk)
        assert list(found.variables) == list(on_disk.variables)


def test_what_is_kept_of_an_archive_that_was_just_written_is_what_a_reader_finds(any_test, write):
    built = to_dataset(any_test, version=__version__, command="reduction run")
    path, opener = write(any_test), ReadOnce()
    opener.keep(path, as_kept(built))
    with opener(path) as kept, open_archive(path) as on_disk:
        del on_disk.attrs["values_sha256"]  # of the file
        assert kept.identical(on_disk)
        assert list(kept.variables) == list(on_disk.variables)
        for name, variable in kept.variables.items():
            assert variable.dtype == on_disk.variables[name].dtype


def test_to_open_an_archive_and_take_entries_of_it_loads_neither_dask_nor_pint(rich_test, write):
    code = f"""
import sys
from pathlib import Path
import numpy as np
import xarray as xr
from reduction.archive.open import open_archive
from reduction.archive.variables import at_places
with open_archive(Path({str(write(rich_test))!r})) as found:
    both = {{name: found.variables[name] for name in ("specimen", "diameter")}}
    cut = xr.Dataset({{name: at_places(one, "specimen", np.array([1])) for name, one in both.items()}})
    print(sorted({{"dask.base", "pint"}} & set(sys.modules)))
    xr.testing.assert_equal(cut, found[["specimen", "diameter"]].isel(specimen=[1]))
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"
