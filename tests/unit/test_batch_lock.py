"""One run at a time on the products of a campaign, whatever became of the one before."""

import errno
import json
import os
import platform
import subprocess
import sys
from pathlib import Path

import pytest

from reduction.batch import lock as module
from reduction.batch.lock import LOCK_NAME, RunLock, run_lock
from reduction.errors import ArchiveError

ROOT = Path(__file__).parents[2]
# takes the lock, adds a line to a file twice with time between, and says who it was
CONTENDER = """
import sys, time
from pathlib import Path
from reduction.batch.lock import run_lock
from reduction.errors import ArchiveError
folder = Path(sys.argv[1])
try:
    with run_lock(folder, remark=lambda text: None):
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
from reduction.batch.lock import run_lock
with run_lock(Path(sys.argv[1]), remark=print):
    (Path(sys.argv[1]) / ".T-1.nc.1.part").touch()
    print(os.getpid(), flush=True)
    os._exit(1)
"""


def started(code, folder):
    return subprocess.Popen(
        [sys.executable, "-c", code, str(folder)], stdout=subprocess.PIPE, text=True,
        env=os.environ | {"PYTHONPATH": str(ROOT)},
    )  # fmt: skip


def held(folder, **changes):
    """The lock of this process in a folder, with other words in it."""
    with run_lock(folder, remark=pytest.fail):
        text = (folder / LOCK_NAME).read_text()
        (folder / "kept").touch()
    (folder / LOCK_NAME).write_text(json.dumps(json.loads(text) | changes))


def test_a_lock_says_who_holds_it_since_when_and_with_what_command(tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "argv", ["/usr/bin/reduction", "run", "my campaign.toml"])
    with run_lock(tmp_path, remark=pytest.fail) as lock:
        found = json.loads(lock.path.read_text())
        assert found["host"] == platform.node() and found["pid"] == os.getpid()
        assert found["command"] == "reduction run 'my campaign.toml'"
        assert found["started"].endswith("+00:00")
        lock.confirm()
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_was_made_for_nothing_is_not_left(tmp_path):
    with run_lock(tmp_path / "processed" / "a", remark=pytest.fail):
        assert (tmp_path / "processed" / "a" / LOCK_NAME).exists()
    assert list(tmp_path.iterdir()) == []


def test_a_lock_is_given_back_after_an_error(tmp_path):
    with pytest.raises(KeyboardInterrupt), run_lock(tmp_path, remark=pytest.fail):
        raise KeyboardInterrupt
    with run_lock(tmp_path, remark=pytest.fail):
        pass


def test_a_second_run_is_told_who_holds_the_folder(tmp_path):
    with (
        run_lock(tmp_path, remark=pytest.fail),
        pytest.raises(
            ArchiveError,
            match=rf"^another run holds .*process {os.getpid()} on .*, since 20.*one run at a time.*"
            "Wait for it or end it; products that it finished are kept",
        ),
        run_lock(tmp_path, remark=pytest.fail),
    ):
        pass


def test_the_lock_of_a_process_that_is_no_more_is_taken_over_and_its_parts_removed(tmp_path):
    process = started(DIES, tmp_path)
    (pid,) = process.stdout.read().split()
    # its output ends before it does; it is a zombie then, until it is waited for
    os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)
    said = []
    with run_lock(tmp_path, remark=said.append):
        assert [path.name for path in tmp_path.iterdir()] == [LOCK_NAME]
    assert len(said) == 1
    assert "taken over from" in said[0] and f"process {pid} on" in said[0]
    process.communicate()


@pytest.mark.parametrize(
    "changes",
    [
        {"boot": "another boot of the machine"},
        pytest.param(
            {"process_start": "1"},
            marks=pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="no /proc"),
        ),
        {"pid": 2**22 + 1},
    ],
)
def test_a_process_that_has_the_number_of_another_does_not_hold_its_lock(changes, tmp_path):
    held(tmp_path, **changes)
    said = []
    with run_lock(tmp_path, remark=said.append):
        pass
    assert len(said) == 1


@pytest.mark.parametrize(("start", "is_gone"), [("1", True), ("", False)])
def test_without_the_start_of_processes_their_number_decides(start, is_gone, tmp_path, monkeypatch):
    monkeypatch.setattr(module, "_process_start", lambda pid: None)
    held(tmp_path, process_start="", **({"pid": 2**22 + 1} if is_gone else {}))
    said = []
    if is_gone:
        with run_lock(tmp_path, remark=said.append):
            pass
        assert len(said) == 1
    else:
        with (
            pytest.raises(ArchiveError, match="another run holds"),
            run_lock(tmp_path, remark=pytest.fail),
        ):
            pass


@pytest.mark.parametrize("changes", [{"host": "elsewhere"}, {"space": "pid:[1]"}])
def test_a_lock_of_another_machine_or_container_is_left_to_a_person(changes, tmp_path):
    held(tmp_path, pid=2**22 + 1, **changes)
    with (
        pytest.raises(ArchiveError, match=r"which cannot be seen from .*, delete the file"),
        run_lock(tmp_path, remark=pytest.fail),
    ):
        pass
    assert (tmp_path / LOCK_NAME).exists()


@pytest.mark.parametrize("text", ["", "no lock at all", '{"host": "a"}', "[1]", "null"])
def test_a_text_that_is_no_lock_is_left_to_a_person(text, tmp_path):
    (tmp_path / LOCK_NAME).write_text(text)
    with (
        pytest.raises(ArchiveError, match="a text that is no lock; .*if no run is at work there"),
        run_lock(tmp_path, remark=pytest.fail),
    ):
        pass


def test_a_folder_that_cannot_be_written_to_is_told(tmp_path, monkeypatch):
    def refuse(*arguments, **options):
        raise OSError(30, "Read-only file system")

    monkeypatch.setattr(Path, "open", refuse)
    with (
        pytest.raises(ArchiveError, match=r"run\.lock cannot be written; found Read-only file sys"),
        run_lock(tmp_path, remark=pytest.fail),
    ):
        pass


def test_of_many_runs_at_once_none_works_beside_another(tmp_path):
    """Also where all of them find the lock of one that is no more."""
    started(DIES, tmp_path).communicate()
    processes = [started(CONTENDER, tmp_path) for _ in range(6)]
    said = [process.communicate()[0].strip() for process in processes]
    assert set(said) <= {"held", "refused"} and "held" in said
    assert list(tmp_path.iterdir()) == []


def test_the_lock_of_a_quicker_one_is_put_back(tmp_path):
    path = tmp_path / LOCK_NAME
    path.write_text("of the quicker one")
    assert not module._put_away(path, "of one that is no more")
    assert path.read_text() == "of the quicker one"
    assert [one.name for one in tmp_path.iterdir()] == [LOCK_NAME]


def test_a_lock_that_was_put_away_by_another_is_no_concern(tmp_path):
    assert not module._put_away(tmp_path / LOCK_NAME, "")


def test_work_goes_on_under_its_own_lock_alone(tmp_path):
    with run_lock(tmp_path, remark=pytest.fail) as lock:
        with pytest.raises(ArchiveError, match=r"is not the lock of this run any more; found '"):
            RunLock(lock.path, "of another").confirm()
        lock.path.unlink()
        with pytest.raises(ArchiveError, match="found no such file on this machine"):
            lock.confirm()
        lock.path.write_text("{}")
        with pytest.raises(ArchiveError, match="found another text"):
            lock.confirm()
        lock.path.unlink()


@pytest.mark.parametrize("step", ["fsync", "link"])
def test_a_lock_that_could_not_be_written_holds_nothing(step, tmp_path, monkeypatch):
    def refuse(*arguments, **options):
        raise OSError(28, "No space left on device")

    folder = tmp_path / "processed" / "a"
    with monkeypatch.context() as full:
        full.setattr(module.os, step, refuse)
        with (
            pytest.raises(ArchiveError, match=r"cannot be written; found No space left on device"),
            run_lock(folder, remark=pytest.fail),
        ):
            pass
    assert list(tmp_path.iterdir()) == []
    with run_lock(folder, remark=pytest.fail) as lock:
        lock.confirm()


@pytest.mark.parametrize("ends", ["fsync", "link"])
def test_a_process_that_ends_while_it_takes_the_lock_leaves_none_without_text(ends, tmp_path):
    """As if it were killed: nothing is cleaned up behind it."""
    code = DIES.replace("from pathlib", f"os.{ends} = lambda *any: os._exit(9)\nfrom pathlib")
    process = started(code, tmp_path)
    process.communicate()
    assert process.returncode == 9
    assert not (tmp_path / LOCK_NAME).exists()
    with run_lock(tmp_path, remark=pytest.fail):
        assert [path.name for path in tmp_path.iterdir()] == [LOCK_NAME]


def test_where_there_are_no_links_the_lock_is_made_in_its_place(tmp_path, monkeypatch):
    def refuse(*arguments):
        raise OSError(errno.EPERM, "Operation not permitted")

    monkeypatch.setattr(module.os, "link", refuse)
    with run_lock(tmp_path, remark=pytest.fail) as lock:
        lock.confirm()
        with (
            pytest.raises(ArchiveError, match="another run holds"),
            run_lock(tmp_path, remark=pytest.fail),
        ):
            pass
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_no_disk_can_have_is_told(tmp_path):
    with (
        pytest.raises(ArchiveError, match=r"cannot be written; found File name too long"),
        run_lock(tmp_path / ("n" * 300), remark=pytest.fail),
    ):
        pass


def test_what_a_killed_worker_began_is_taken_away_at_the_end(tmp_path):
    with run_lock(tmp_path, remark=pytest.fail):
        (tmp_path / "tables").mkdir()
        begun = [tmp_path / ".T-1.nc.7-a2b9.part", tmp_path / "tables" / ".moduli.csv.7-a2b9.part"]
        for path in begun:
            path.touch()
        (tmp_path / "T-2.nc").touch()
    assert not any(path.exists() for path in begun)
    assert (tmp_path / "T-2.nc").exists()


def test_what_another_run_began_is_left_to_it(tmp_path):
    with run_lock(tmp_path, remark=pytest.fail):
        lock = tmp_path / LOCK_NAME
        lock.write_text(lock.read_text().replace('"token": "', '"token": "another'))
        (tmp_path / ".T-1.nc.8-a2b9.part").touch()
    assert (tmp_path / ".T-1.nc.8-a2b9.part").exists()


@pytest.mark.parametrize("kind", ["folder", "refused"])
def test_a_lock_that_cannot_be_read_is_left_to_a_person_and_the_reason_told(
    kind, tmp_path, monkeypatch
):
    path = tmp_path / LOCK_NAME
    if kind == "folder":
        path.mkdir()
        why = "Is a directory"
    else:
        path.write_text("{}")
        monkeypatch.setattr(Path, "read_text", refused)
        why = "Input/output error"
    with (
        pytest.raises(
            ArchiveError, match=rf"another run holds .*run.lock: {why}; .*delete the file"
        ),
        run_lock(tmp_path, remark=pytest.fail),
    ):
        pytest.fail("it was taken")
    assert path.exists()


def refused(*arguments, **options):
    raise OSError(errno.EIO, os.strerror(errno.EIO))


def test_a_lock_that_cannot_be_read_any_more_ends_the_run_with_the_reason(tmp_path, monkeypatch):
    with run_lock(tmp_path, remark=pytest.fail) as lock, monkeypatch.context() as disk:
        disk.setattr(Path, "read_text", refused)
        with pytest.raises(ArchiveError, match="the lock of this run, cannot be read; found Input"):
            lock.confirm()


def test_a_lock_is_given_back_where_the_folder_cannot_be_looked_through(tmp_path, monkeypatch):
    with monkeypatch.context() as disk:
        with run_lock(tmp_path, remark=pytest.fail):
            disk.setattr(Path, "rglob", refused)
        assert list(tmp_path.iterdir()) == []
