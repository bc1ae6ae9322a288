"""Only an archive of this schema is opened."""

import errno
import os
import sys

import h5py
import netCDF4
import pytest

from reduction.archive import open as module
from reduction.archive import sound
from reduction.archive.open import failing_reads, open_archive, reading
from reduction.archive.version import SCHEMA_VERSION
from reduction.errors import ArchiveError


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
    with pytest.raises(ArchiveError, match=r"is not a netCDF file; found .*; needed an archive"):
        open_archive(path)


@pytest.mark.parametrize(("version", "found"), [(None, "none"), ("0", "version 0")])
def test_another_schema_is_refused(tmp_path, version, found):
    path = tmp_path / "T-1.nc"
    with netCDF4.Dataset(path, "w") as file:
        if version is not None:
            file.schema_version = version
    with pytest.raises(ArchiveError, match=rf"has another schema; found {found}; needed version 1"):
        open_archive(path)


def test_the_cache_of_other_files_is_left_as_it_was(rich_test, write):
    before = netCDF4.get_chunk_cache()
    with open_archive(write(rich_test)):
        assert netCDF4.get_chunk_cache() == before


def test_an_archive_that_the_system_refuses_is_told_so(tmp_path, monkeypatch):
    def refused(path):
        raise OSError(errno.EIO, os.strerror(errno.EIO))

    path = tmp_path / "T-1.nc"
    path.touch()
    monkeypatch.setattr(module, "check_seal", refused)
    with pytest.raises(ArchiveError, match="T-1.nc cannot be read; found Input/output error"):
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


def test_a_disk_that_refuses_the_library_is_no_fault_of_the_form(rich_test, write, monkeypatch):
    def refused(*_):
        # what h5py 3.16 says
        raise OSError(
            "Link iteration failed (file read failed: time = Sun Nov 22 13:45:19 2026\n, filename ="
            " 'A.nc', file descriptor = 9, errno = 5, error message = 'Input/output error')"
        )

    monkeypatch.setattr(sound, "_faults_stored", refused)
    with pytest.raises(ArchiveError, match=r"\.nc cannot be read; found Input/output error\."):
        open_archive(write(rich_test))


@pytest.mark.skipif(sys.platform != "linux", reason="names of files are bytes on Linux alone")
def test_a_name_that_the_process_cannot_write_down_is_no_fault_of_the_file(tmp_path):
    path = tmp_path / os.fsdecode(b"pr\xfcfung.nc")
    path.write_bytes(b"not read so far")
    with pytest.raises(
        ArchiveError, match=r"cannot be given to the netCDF library; found .*Set PYTHONUTF8=1"
    ):
        open_archive(path)
