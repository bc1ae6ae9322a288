"""Runs that are killed, and runs whose calls fail: the old products or the new ones, never others."""

import errno
import os
import shutil
import signal
import time

import pytest
from faults.calls import AFTER, ALL, SHORT, compiler, mask
from faults.failures import CHANGES, Failures
from faults.harness import RUN, STATES, VERIFY, contents, is_in_order, is_left_over
from faults.kills import Kills

pytestmark = pytest.mark.skipif(
    os.name != "posix" or compiler() is None, reason="there is no C compiler for the library"
)
TOUCHES = CHANGES | mask("open to write")


@pytest.fixture(scope="module")
def kills(tmp_path_factory):
    made = Kills(tmp_path_factory.mktemp("kills"), seed=20261122, is_verified=False)
    yield made
    made.close()


@pytest.fixture(scope="module")
def failures(kills, tmp_path_factory):
    return Failures(tmp_path_factory.mktemp("failures"), kills)


NIGHTLY = pytest.mark.nightly


@pytest.mark.parametrize(
    "number", [0, *(pytest.param(number, marks=NIGHTLY) for number in range(1, 8))]
)
def test_a_run_that_is_killed_leaves_old_or_new_products_and_the_next_one_mends_them(number, kills):
    assert kills.kill(STATES[number % 3], by_time=number < 3) == []


@pytest.mark.parametrize(
    ("call", "path", "how", "stays", "status"),
    [
        ("write", "processed/short/.B.nc.", errno.ENOSPC, True, 6),
        *(
            pytest.param(*case, marks=NIGHTLY)
            for case in (
                ("open", "raw/B.csv", errno.EIO, False, 3),
                ("close", "raw/A.csv", errno.EIO, False, 3),
                ("rename", "processed/short/tables/trend.csv", errno.EROFS, True, 6),
                ("unlink", "processed/short/tables/slips.csv", errno.EPERM, False, 6),
                ("write", "reports/short/.index.html.", SHORT, False, 0),
            )
        ),
    ],
)
def test_a_call_that_fails_is_told_and_leaves_old_or_new_products(
    call, path, how, stays, status, failures
):
    number, wanted = failures.find("older", call, path)
    assert failures.fail("older", number, *wanted, how, stays) == []
    assert failures.ended.status == status


@pytest.mark.parametrize(
    "share", [0.35, *(pytest.param(share, marks=NIGHTLY) for share in (0.05, 0.65, 0.95))]
)
def test_a_disk_that_fails_while_an_archive_is_read_is_told_with_the_file(share, failures):
    reads = [number for number, call, path in failures.calls("older") if "pread" in call]
    number = reads[int(share * len(reads))]
    assert failures.fail("older", number, *failures.ways("older", number)[0]) == []


@NIGHTLY
def test_products_of_two_runs_are_told_by_verify(failures, kills):
    """Killed after the first table, and its lock removed by a person."""
    _, (kinds, at) = failures.find("older", "rename", "processed/short/tables/columns.csv")
    folder = failures.begin("older")
    assert kills.victim.run(folder, kinds=kinds, at=at, how=AFTER).status == -signal.SIGKILL
    (folder / "processed" / "short" / "run.lock").unlink()
    ended = kills.victim.run(folder, *VERIFY[:-1])
    assert ended.status == 6 and "tables/" in ended.said, ended
    assert kills.victim.run(folder).status == 0
    ended = kills.victim.run(folder, *VERIFY)
    assert ended.status == 0, ended


@pytest.mark.parametrize("number", [signal.SIGINT, pytest.param(signal.SIGTERM, marks=NIGHTLY)])
def test_a_request_to_end_at_any_moment_leaves_old_or_new_products_and_no_lock(number, kills):
    assert kills.kill("older", by_time=True, number=number) == []


def test_the_order_in_which_products_become_new_is_known():
    assert is_in_order((2, 2, 1, 0)) and is_in_order((0, 0)) and is_in_order(())
    assert not is_in_order((1, 2)) and not is_in_order((0, 1))


@NIGHTLY
def test_no_command_opens_a_raw_file_for_writing_or_touches_its_folder(kills, tmp_path):
    """Seen from below Python, so that the libraries of the formats are seen too."""
    folder = tmp_path / "all"
    shutil.copytree(kills.states["none"].folder, folder)
    before = {path: (path.stat(), path.read_bytes()) for path in sorted((folder / "raw").iterdir())}
    raw_folder = (folder / "raw").stat()
    for words in (
        RUN, ("check", "raw/campaign.toml", "--quiet"), ("report", "processed/short", "--quiet"),
        VERIFY, ("catalogue", "processed", "--quiet"),
    ):  # fmt: skip
        ended = kills.victim.run(folder, *words, kinds=TOUCHES, watched=["raw"])
        assert (ended.status, ended.n_calls) == (0, 0), (words, ended)
    seen = kills.victim.run(folder, watched=["raw"], kinds=mask("open to read"))
    assert seen.n_calls > 0, "the library does not see what it should"
    for path, (state, data) in before.items():
        now = path.stat()
        assert path.read_bytes() == data
        assert (now.st_mtime_ns, now.st_ctime_ns) == (state.st_mtime_ns, state.st_ctime_ns)
    assert (folder / "raw").stat().st_mtime_ns == raw_folder.st_mtime_ns


@NIGHTLY
def test_times_of_files_that_lie_ahead_or_went_back_change_no_product(kills, tmp_path):
    state = kills.states["none"]
    folder = tmp_path / "times"
    shutil.copytree(state.folder, folder)
    now = time.time()
    for ahead in (40 * 365 * 86400, -10 * 365 * 86400):
        for path in folder.rglob("*"):
            os.utime(path, (now + ahead, now + ahead))
        assert kills.victim.run(folder).status == 0
        assert contents(folder) == state.after


def test_what_a_killed_process_began_is_no_product():
    assert is_left_over("reports/short/.index.html.1a2b3c4d-17-9c8d7e6f.part")
    assert is_left_over("processed/short/run.lock") and not is_left_over("processed/short/A.nc")
    assert ALL & TOUCHES == TOUCHES
