"""A file appears whole or not at all."""

import errno
import os
import stat
import subprocess
import sys
from pathlib import Path

import pytest

from reduction.archive.atomic_write import (
    atomic_file,
    remove_abandoned,
    take_away,
    write_text_atomically,
)
from reduction.record.errors import ArchiveError


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
