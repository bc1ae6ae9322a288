"""One run at a time on the products of a campaign, whatever became of the one before."""

import errno
import os
import platform
import subprocess
import sys
from pathlib import Path

import pytest

from reduction.batch import run_lock as module
from reduction.batch.run_lock import LOCK_NAME, RunLock, _run_named, run_lock
from reduction.record.errors import ArchiveError

ROOT = Path(__file__).parents[2]
# takes the lock, makes a file that nobody else may have, and says who it was
CONTENDER = """
import sys, time
from pathlib import Path
from reduction.batch.run_lock import run_lock
from reduction.record.errors import ArchiveError
folder = Path(sys.argv[1])
try:
    with run_lock(folder):
        with (folder / "inside").open("x"):
            time.sleep(0.3)
        (folder / "inside").unlink()
        print("held")
except ArchiveError as error:
    print("refused" if "another run holds" in str(error) else error)
"""
DIES = """
import os, sys
from pathlib import Path
from reduction.batch.run_lock import run_lock
with run_lock(Path(sys.argv[1])):
    (Path(sys.argv[1]) / ".T-1.nc.1.part").touch()
    print(os.getpid(), flush=True)
    os._exit(1)
"""


def started(code, folder):
    return subprocess.Popen(
        [sys.executable, "-c", code, str(folder)], stdout=subprocess.PIPE, text=True,
        env=os.environ | {"PYTHONPATH": str(ROOT)},
    )  # fmt: skip


def names(folder):
    return [path.name for path in folder.iterdir()]


def test_a_lock_says_who_holds_it_since_when_and_with_what_command(tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "argv", ["/usr/bin/reduction", "run", "my campaign.toml"])
    with run_lock(tmp_path) as lock:
        found = _run_named(tmp_path)
        assert found.startswith("'reduction run '\"'\"'my campaign.toml") or found.startswith(
            "'reduction run 'my campaign.toml'', process"
        )
        assert f"process {os.getpid()} on {platform.node()}, since 20" in found
        assert found.endswith("+00:00")
        lock.confirm()


def test_an_address_in_the_command_keeps_no_password(tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "argv", ["reduction", "run", "https://ann:secret@host/c.toml?s=abcd"])
    with run_lock(tmp_path):
        found = _run_named(tmp_path)
    assert "https://host/c.toml" in found and "secret" not in found and "abcd" not in found


def test_the_file_stays_and_names_nobody_when_the_run_has_ended(tmp_path):
    """Two runs that find it gone could each make and lock one of their own."""
    folder = tmp_path / "processed" / "a"
    with run_lock(folder):
        before = (folder / LOCK_NAME).stat().st_ino
    assert names(folder) == [LOCK_NAME] and _run_named(folder) == ""
    with run_lock(folder):
        assert (folder / LOCK_NAME).stat().st_ino == before


def test_a_folder_that_was_never_worked_on_names_nobody(tmp_path):
    assert _run_named(tmp_path) == _run_named(tmp_path / "nowhere") == ""


def test_a_lock_is_given_back_after_an_error(tmp_path):
    with pytest.raises(KeyboardInterrupt), run_lock(tmp_path):
        raise KeyboardInterrupt
    assert _run_named(tmp_path) == ""
    with run_lock(tmp_path):
        pass


def test_a_second_run_is_told_who_holds_the_folder(tmp_path):
    with run_lock(tmp_path) as lock:
        for _ in range(2):
            with (
                pytest.raises(
                    ArchiveError,
                    match=rf"^another run holds .*process {os.getpid()} on .*, since 20.*one run at a "
                    "time.*Wait for it or end it; archives that it finished are kept",
                ),
                run_lock(tmp_path),
            ):
                pass
        lock.confirm()  # who was refused has changed nothing


def test_the_lock_of_a_process_that_is_no_more_is_free_and_its_parts_are_removed(tmp_path):
    process = started(DIES, tmp_path)
    (pid,) = process.stdout.read().split()
    # its output ends before it does; it is a zombie then, until it is waited for
    os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)
    assert f"process {pid} on" in _run_named(tmp_path)  # it was killed at work
    with run_lock(tmp_path):
        assert names(tmp_path) == [LOCK_NAME]
        assert f"process {os.getpid()} on" in _run_named(tmp_path)
    process.communicate()


@pytest.mark.parametrize("text", ["", "no lock at all", '{"host": "a"}', "ä" * 5000])
def test_a_text_of_another_program_holds_nothing(text, tmp_path):
    (tmp_path / LOCK_NAME).write_text(text)
    with run_lock(tmp_path) as lock:
        lock.confirm()


def test_of_many_runs_at_once_none_works_beside_another(tmp_path):
    """Also where all of them find the lock of one that is no more."""
    started(DIES, tmp_path).communicate()
    processes = [started(CONTENDER, tmp_path) for _ in range(6)]
    said = [process.communicate()[0].strip() for process in processes]
    assert set(said) <= {"held", "refused"} and "held" in said
    assert names(tmp_path) == [LOCK_NAME] and _run_named(tmp_path) == ""


def test_a_process_that_is_started_meanwhile_does_not_hold_the_lock(tmp_path):
    with run_lock(tmp_path):
        child = started("import time; time.sleep(60)", tmp_path)
    with run_lock(tmp_path):
        assert child.poll() is None
    child.kill()
    child.communicate()


def test_work_goes_on_under_its_own_lock_alone(tmp_path):
    with run_lock(tmp_path) as lock:
        with pytest.raises(ArchiveError, match=r"is no longer the lock of this run; found '"):
            RunLock(lock.path, "of another").confirm()
        text = lock.path.read_text()
        lock.path.write_text("")
        with pytest.raises(ArchiveError, match="found an empty lock"):
            lock.confirm()
        lock.path.write_text(text)
        lock.confirm()
        lock.path.unlink()
        with pytest.raises(ArchiveError, match="found no such file on this machine"):
            lock.confirm()


def test_a_lock_that_cannot_be_read_any_more_ends_the_run_with_the_reason(tmp_path, monkeypatch):
    with run_lock(tmp_path) as lock, monkeypatch.context() as disk:
        disk.setattr(Path, "read_text", refused)
        with pytest.raises(ArchiveError, match="no longer the lock of this run; found Input/out"):
            lock.confirm()


def refused(*arguments, **options):
    raise OSError(errno.EIO, os.strerror(errno.EIO))


def test_a_folder_that_cannot_be_written_to_is_told(tmp_path, monkeypatch):
    def refuse(*arguments, **options):
        raise OSError(30, "Read-only file system")

    monkeypatch.setattr(Path, "open", refuse)
    with (
        pytest.raises(ArchiveError, match=r"run\.lock cannot be written; found Read-only file sys"),
        run_lock(tmp_path),
    ):
        pass


def test_a_folder_that_no_disk_can_have_is_told(tmp_path):
    with (
        pytest.raises(ArchiveError, match=r"cannot be written; found File name too long"),
        run_lock(tmp_path / ("n" * 300)),
    ):
        pass


def test_a_lock_that_is_a_folder_is_told(tmp_path):
    (tmp_path / LOCK_NAME).mkdir()
    with (
        pytest.raises(ArchiveError, match=r"run.lock cannot be written; found Is a directory"),
        run_lock(tmp_path),
    ):
        pytest.fail("it was taken")


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EPERM])
def test_a_lock_that_could_not_be_written_holds_nothing_and_names_nobody(
    number, tmp_path, monkeypatch
):
    def refuse(*arguments, **options):
        raise OSError(number, os.strerror(number))

    with monkeypatch.context() as full:
        full.setattr(module.os, "fsync", refuse)
        with (
            pytest.raises(ArchiveError, match=f"cannot be written; found {os.strerror(number)}"),
            run_lock(tmp_path),
        ):
            pass
    assert _run_named(tmp_path) == ""
    with run_lock(tmp_path) as lock:
        lock.confirm()


def test_what_a_killed_worker_began_is_taken_away_at_the_end(tmp_path):
    with run_lock(tmp_path):
        (tmp_path / "tables").mkdir()
        begun = [tmp_path / ".T-1.nc.7-a2b9.part", tmp_path / "tables" / ".moduli.csv.7-a2b9.part"]
        for path in begun:
            path.touch()
        (tmp_path / "T-2.nc").touch()
    assert not any(path.exists() for path in begun)
    assert (tmp_path / "T-2.nc").exists()


def test_what_another_run_began_is_left_to_it(tmp_path):
    """A person has removed the file of a run that is at work, and another has begun."""
    with run_lock(tmp_path) as lock:
        lock.path.unlink()
        lock.path.write_text("'reduction run', process 1 on another machine")
        (tmp_path / ".T-1.nc.8-a2b9.part").touch()
    assert (tmp_path / ".T-1.nc.8-a2b9.part").exists()
    assert _run_named(tmp_path) == "'reduction run', process 1 on another machine"


def test_a_lock_is_given_back_where_the_folder_cannot_be_looked_through(tmp_path, monkeypatch):
    with monkeypatch.context() as disk:
        with run_lock(tmp_path):
            disk.setattr(Path, "rglob", refused)
        assert _run_named(tmp_path) == ""


def test_a_disk_that_keeps_no_locks_is_told_and_the_file_left_as_it_is(tmp_path, monkeypatch):
    def refuse(file):
        raise OSError(errno.ENOLCK, "No locks available")

    (tmp_path / LOCK_NAME).write_text("of a run on another machine")
    monkeypatch.setattr(module, "_take", refuse)
    with (
        pytest.raises(ArchiveError, match="run.lock cannot be written; found No locks available"),
        run_lock(tmp_path),
    ):
        pass
    assert _run_named(tmp_path) == "of a run on another machine"
