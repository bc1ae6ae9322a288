"""Archives appear whole or not at all, follow CF, and are the same bytes each time."""

import errno
import hashlib
import os
import pickle
import stat
import subprocess
import sys
from pathlib import Path

import netCDF4
import pytest
from rulesofcf import held_against_cf

from reduction.archive.atomic_write import (
    append_atomically,
    atomic_file,
    remove_abandoned,
    take_away,
    write_text_atomically,
)
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


# A file appears whole or not at all


def test_the_file_appears_when_the_block_ends_well(tmp_path):
    path = tmp_path / "folder" / "a.txt"
    with atomic_file(path) as part:
        part.write_text("new")
        assert not path.exists()
        assert part.parent == path.parent
    assert path.read_text() == "new"
    assert list(path.parent.iterdir()) == [path]


@pytest.mark.parametrize("error", [KeyboardInterrupt, ValueError])
def test_a_block_that_is_cut_short_leaves_the_file_before(tmp_path, error):
    path = tmp_path / "a.txt"
    path.write_text("old")

    def cut_short():
        with atomic_file(path) as part:
            part.write_text("half")
            raise error

    with pytest.raises(error):
        cut_short()
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_a_block_that_writes_nothing_leaves_the_file_before(tmp_path):
    path = tmp_path / "a.txt"
    path.write_text("old")

    def forget():
        with atomic_file(path):
            pass

    with pytest.raises(FileNotFoundError):
        forget()
    assert path.read_text() == "old"


def test_the_file_has_the_rights_that_any_new_file_has(tmp_path):
    plain = tmp_path / "plain.txt"
    plain.write_text("x")
    with atomic_file(tmp_path / "a.txt") as part:
        part.write_text("x")
    assert (tmp_path / "a.txt").stat().st_mode == plain.stat().st_mode


def refuse(number):
    def refused(*arguments, **options):
        raise OSError(number, os.strerror(number))

    return refused


def test_a_disk_that_refuses_to_clean_up_does_not_hide_why_a_file_was_not_written(
    tmp_path, monkeypatch
):
    path = tmp_path / "a.txt"
    path.write_text("old")

    def fill_the_disk():
        with atomic_file(path) as part:
            part.write_text("half")
            monkeypatch.setattr(Path, "unlink", refuse(errno.EROFS))
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with pytest.raises(OSError, match="No space left"):
        fill_the_disk()
    assert path.read_text() == "old"


@pytest.mark.skipif(os.name != "posix", reason="folders are not flushed elsewhere")
def test_a_folder_that_is_not_flushed_is_told_and_the_file_is_there(tmp_path, monkeypatch):
    path = tmp_path / "a.txt"
    flushed = os.fsync
    monkeypatch.setattr(
        os, "fsync", lambda handle: (refuse(errno.EIO) if is_folder(handle) else flushed)(handle)
    )

    def write():
        with atomic_file(path) as part:
            part.write_text("new")

    with pytest.raises(ArchiveError, match=r"a.txt is written, and may not be on the disk yet"):
        write()
    assert path.read_text() == "new"
    assert list(tmp_path.iterdir()) == [path]
    with pytest.raises(ArchiveError, match=r"a.txt is written, and may not"):
        write_text_atomically(path, "newer")  # and not that what was there before is kept


def is_folder(handle):
    return stat.S_ISDIR(os.fstat(handle).st_mode)


@pytest.mark.skipif(os.name != "posix", reason="folders are not flushed elsewhere")
def test_a_disk_that_knows_nothing_of_flushed_folders_is_none_the_worse(tmp_path, monkeypatch):
    flushed = os.fsync
    monkeypatch.setattr(
        os, "fsync", lambda handle: (refuse(errno.EINVAL) if is_folder(handle) else flushed)(handle)
    )
    with atomic_file(tmp_path / "a.txt") as part:
        part.write_text("new")
    assert (tmp_path / "a.txt").read_text() == "new"


def test_a_product_that_cannot_be_removed_is_told(tmp_path, monkeypatch):
    take_away(tmp_path / "not-there.csv")
    monkeypatch.setattr(Path, "unlink", refuse(errno.EPERM))
    with pytest.raises(ArchiveError, match=r"a.csv cannot be removed; found Operation not perm"):
        take_away(tmp_path / "a.csv")


@pytest.mark.skipif(os.name != "posix", reason="nothing there asks a process without ending it")
def test_what_a_process_that_is_no_more_began_of_a_file_is_removed_before_it_is_written(
    tmp_path, monkeypatch
):
    path = tmp_path / "a[1].txt"
    gone = subprocess.Popen([sys.executable, "-c", ""])
    gone.wait()
    names = {}
    for who, number in (("gone", gone.pid), ("alive", os.getppid()), ("no number", 10**30)):
        with monkeypatch.context() as of_other, atomic_file(path) as part:
            of_other.setattr(os, "getpid", lambda number=number: number)
            with atomic_file(path) as began:
                names[who] = began.name
                began.write_text("x")
            part.write_text("x")
    path.unlink()
    elsewhere = names["gone"].replace(names["gone"].split(".")[-2].split("-")[0], "00000000")
    for name in (*names.values(), elsewhere, ".b.txt.1-2.part"):
        (tmp_path / name).write_text("half")
    write_text_atomically(path, "new")
    left = {one.name for one in tmp_path.iterdir()}
    assert left == {path.name, names["alive"], names["no number"], elsewhere, ".b.txt.1-2.part"}
    remove_abandoned(tmp_path / "no-folder" / "a.txt")
