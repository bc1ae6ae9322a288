"""Archives appear whole or not at all, follow CF, and are the same bytes each time."""

import hashlib
import os
import pickle
import subprocess
import sys

import netCDF4
import pytest
from rulesofcf import held_against_cf

from reduction.archive.atomic_write import append_atomically, write_text_atomically
from reduction.archive.test_dataset import to_dataset
from reduction.archive.write import write_archive
from reduction.record.errors import ArchiveError

AGAIN = """
import pickle, sys
from pathlib import Path
from reduction import __version__
from reduction.archive.test_dataset import to_dataset
from reduction.archive.write import write_archive
test = pickle.loads(Path(sys.argv[1]).read_bytes())
write_archive(to_dataset(test, version=__version__, command="reduction run"), Path(sys.argv[2]))
"""


@pytest.mark.parametrize(
    "looked_at",
    [
        pytest.param(slice(-1, None), id="rich"),
        pytest.param(slice(None), id="every kind", marks=pytest.mark.nightly),
    ],
)
@pytest.mark.slow
def test_the_outside_checker_finds_nothing_in_any_kind_of_product(archives, looked_at):
    done = held_against_cf(*archives[looked_at])
    assert done.returncode == 0, done.stdout
    groups = []
    for path in archives[looked_at]:
        with netCDF4.Dataset(path) as file:
            groups += ["root", *file.groups]
    assert done.stdout.count("All tests passed!") == len(groups) > len(archives[looked_at])


def test_another_process_writes_the_same_bytes(rich_test, archives, tmp_path):
    first = archives[-1].read_bytes()
    stored = tmp_path / "test.pickle"
    stored.write_bytes(pickle.dumps(rich_test))
    again = tmp_path / "again.nc"
    subprocess.run(
        [sys.executable, "-c", AGAIN, stored, again],
        check=True,
        env={**os.environ, "PYTHONHASHSEED": "4711"},
    )
    assert hashlib.sha256(again.read_bytes()).digest() == hashlib.sha256(first).digest()


def test_nothing_is_left_beside_the_archive(rich_test, tmp_path):
    path = tmp_path / "T-1.nc"
    write_archive(to_dataset(rich_test, version="1.2.3", command="reduction run"), path)
    assert [entry.name for entry in path.parent.iterdir()] == ["T-1.nc"]


def test_a_disk_that_refuses_is_an_archive_error(bare_test, tmp_path):
    (tmp_path / "file").write_text("not a folder")
    dataset = to_dataset(bare_test, version="1.2.3", command="reduction run")
    with pytest.raises(ArchiveError, match=r"bare.nc cannot be written; found .* is kept"):
        write_archive(dataset, tmp_path / "file" / "bare.nc")


def test_a_full_disk_is_an_archive_error_and_the_file_before_is_kept(bare_test, write, monkeypatch):
    path = write(bare_test)
    before = path.read_bytes()
    dataset = to_dataset(bare_test, version="1.2.3", command="reduction run")

    def full(dataset, part):
        part.write_bytes(b"half")
        raise RuntimeError("NetCDF: HDF error")

    monkeypatch.setattr("reduction.archive.write._write_netcdf", full)
    with pytest.raises(ArchiveError, match=r"bare.nc cannot be written; found NetCDF: HDF error"):
        write_archive(dataset, path)
    assert path.read_bytes() == before
    assert [entry.name for entry in path.parent.iterdir()] == ["bare.nc"]


def test_a_text_is_written_as_it_is(tmp_path):
    path = tmp_path / "new folder" / "a.csv"
    write_text_atomically(path, "größe\r\n1\r\n")
    assert path.read_bytes() == "größe\r\n1\r\n".encode()


def test_a_text_that_cannot_be_written_is_an_archive_error(tmp_path):
    (tmp_path / "file").write_text("not a folder")
    with pytest.raises(ArchiveError, match=r"file.a.csv cannot be written; found File exists"):
        write_text_atomically(tmp_path / "file" / "a.csv", "1")


def test_a_text_that_is_added_to_appears_when_all_of_it_is_there(tmp_path):
    path = tmp_path / "a.csv"
    with append_atomically(path) as append:
        append("größe\r\n")
        append("1\r\n")
        assert not path.exists()
    assert path.read_bytes() == "größe\r\n1\r\n".encode()
    assert list(tmp_path.iterdir()) == [path]


def test_what_fails_beside_a_text_is_told_as_it_is_and_the_file_before_is_kept(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("before")

    def write():
        with append_atomically(path) as append:
            append("after")
            raise OSError("the log is gone")

    with pytest.raises(OSError, match="the log is gone"):
        write()
    assert path.read_text() == "before"
    assert list(tmp_path.iterdir()) == [path]


def test_a_text_that_cannot_be_added_to_names_its_file(tmp_path):
    folder = tmp_path / "folder"

    def write():
        with append_atomically(folder / "a.csv") as append:
            folder.rmdir()
            append("1")

    with pytest.raises(ArchiveError, match=r"a.csv cannot be written; found No such file"):
        write()
