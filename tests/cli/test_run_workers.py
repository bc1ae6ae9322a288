"""Campaigns on several workers: the same bytes, whoever does the work and whoever dies at it."""

import contextlib
import json
import os
import platform
import signal
import subprocess
import sys
import time
from dataclasses import replace

import psutil
import pytest
from csvrows import csv_rows
from manytests import ROOT, archives, products, run, start, wait_for, write_many
from nopage import leave_out_page

from reduction.batch.run_campaign import run_campaign
from reduction.batch.run_lock import _run_named
from reduction.batch.workers import local_workers
from reduction.campaign.load import load_campaign

N_TESTS = 6
SOUND = {"T01", "T02.a", "T02.b", *(f"T{number:02}" for number in range(4, N_TESTS + 1))}


@pytest.fixture(scope="module")
def campaign(tmp_path_factory):
    return write_many(tmp_path_factory.mktemp("many") / "raw", N_TESTS)


@pytest.fixture(scope="module")
def serial(campaign, tmp_path_factory):
    """What one process makes of it."""
    folder = tmp_path_factory.mktemp("serial")
    status, _, errors = run(campaign, folder)
    assert status == 3 and "T03.csv" in errors
    return products(folder)


@pytest.fixture
def scheduler(tmp_path):
    """A scheduler and two workers, started by hand on this machine."""
    with contextlib.ExitStack() as opened:
        file = tmp_path / "scheduler.json"
        local = ("--host", "127.0.0.1", "--dashboard-address", "127.0.0.1:0")
        processes = [_dask(opened, "scheduler", *local, "--port", 0, "--scheduler-file", file)]
        wait_for(lambda: file.exists() and file.stat().st_size)
        address = json.loads(file.read_text())["address"]
        processes += [
            _dask(opened, "worker", address, *local, "--nthreads", 1, "--no-nanny",
                  "--local-directory", tmp_path / f"worker-{number}")
            for number in (1, 2)
        ]  # fmt: skip
        yield address, processes


def _dask(opened, *words):
    process = subprocess.Popen(
        [sys.executable, "-m", "dask", *map(str, words)],
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        env=os.environ | {"PYTHONPATH": str(ROOT)},
    )  # fmt: skip
    opened.callback(process.wait)
    opened.callback(process.kill)
    return process


def of_tests(folder):
    return {row["test"]: row for row in csv_rows(folder / "processed" / "many" / "status.csv")}


def is_at_work(folder, *, made=1):
    return lambda: len(archives(folder)) >= made


def test_the_serial_run_holds_all_but_the_log_that_cannot_be_read(serial):
    assert {name.removesuffix(".nc") for name in serial if name.endswith(".nc")} == SOUND
    assert any(name.startswith("tables/") for name in serial)


@pytest.mark.parametrize("jobs", [2, 3])
def test_products_have_the_same_bytes_on_any_number_of_workers(jobs, campaign, serial, tmp_path):
    status, said, errors = run(campaign, tmp_path, "--jobs", str(jobs))
    assert status == 3
    assert products(tmp_path) == serial
    lines = errors.splitlines()
    assert (
        sum(line.lstrip().split("/")[0].isdigit() for line in lines[: N_TESTS + 1]) == N_TESTS + 1
    )
    assert f"{N_TESTS + 1}/{N_TESTS + 1} " in errors and " reduced, " in errors
    assert f" s, {platform.node()}:" in errors and said.startswith("test ")


def test_one_job_starts_no_worker_and_names_none(campaign, serial, tmp_path):
    status, said, errors = run(
        campaign, tmp_path, "--jobs", "1", "--json", "--test", "T01", "--test", "T02"
    )
    assert status == 0 and errors == ""
    answer = json.loads(said)["tests"]
    assert [test["id"] for test in answer] == ["T01", "T02.a", "T02.b"]
    assert {test["worker"] for test in answer} == {""}
    made = products(tmp_path)
    assert all(serial[name] == made[name] for name in made if name.endswith(".nc"))


def test_a_worker_of_the_users_scheduler_that_is_killed_changes_nothing(
    campaign, serial, scheduler, tmp_path
):
    address, (_, first, _) = scheduler
    process = start(campaign, tmp_path, "--scheduler", address, "--json")
    wait_for(is_at_work(tmp_path, made=2))
    first.send_signal(signal.SIGKILL)
    assert len(archives(tmp_path)) < len(SOUND), "it was killed too late to show anything"
    said, errors = process.communicate(timeout=120)
    assert process.returncode == 3, errors
    assert products(tmp_path) == serial
    tests = json.loads(said)["tests"]
    assert {test["id"] for test in tests if test["status"] == "failed"} == {"T03"}


def test_a_scheduler_that_is_lost_ends_the_run_with_words_and_nothing_half_written(
    campaign, serial, scheduler, tmp_path
):
    address, (master, *_) = scheduler
    process = start(campaign, tmp_path, "--scheduler", address)
    wait_for(is_at_work(tmp_path, made=2))
    master.send_signal(signal.SIGKILL)
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 1
    assert "the scheduler was lost. Archives that were finished are kept" in errors
    assert "Traceback" not in errors and "distributed" not in errors
    made = products(tmp_path)
    assert made and all(serial[name] == made[name] for name in made)


def test_a_run_that_was_killed_goes_on_where_it_was(campaign, serial, tmp_path):
    process = start(campaign, tmp_path, "--jobs", "2")
    wait_for(is_at_work(tmp_path, made=3))
    process.kill()
    process.communicate()
    done = archives(tmp_path)
    assert 3 <= len(done) < len(SOUND)
    folder = tmp_path / "processed" / "many"
    assert f"process {process.pid} on" in _run_named(folder)
    (folder / ".T09.nc.12345.part").write_text("half")
    status, _, _ = run(campaign, tmp_path)
    assert status == 3
    assert products(tmp_path) == serial
    unchanged = {name for name, row in of_tests(tmp_path).items() if row["status"] == "unchanged"}
    # a worker may have finished one more before it saw that it was alone
    assert done <= unchanged < SOUND and len(unchanged) <= len(done) + 2


@pytest.mark.posix
def test_an_interrupt_ends_the_workers_and_gives_back_the_lock(campaign, tmp_path):
    process = start(campaign, tmp_path, "--jobs", "2")
    wait_for(is_at_work(tmp_path, made=1))
    os.killpg(process.pid, signal.SIGSTOP)  # or it may end while this looks
    children = psutil.Process(process.pid).children(recursive=True)
    assert len(children) >= 2
    assert len(archives(tmp_path)) < len(SOUND), "it was stopped too late to show anything"
    began = time.monotonic()
    # as a terminal does, to every process of the group
    os.killpg(process.pid, signal.SIGINT)
    os.killpg(process.pid, signal.SIGCONT)
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 130
    assert errors.splitlines()[-1] == "interrupted; archives that were finished are kept"
    assert "Traceback" not in errors
    assert time.monotonic() - began < 15
    assert psutil.wait_procs(children, timeout=10)[1] == []
    assert products(tmp_path)  # and no lock


@contextlib.contextmanager
def heeding(request_, how):
    """What is started meanwhile takes over how this process heeds a request."""
    before = signal.signal(getattr(signal, request_), how)
    try:
        yield
    finally:
        signal.signal(getattr(signal, request_), before)


@pytest.mark.posix
@pytest.mark.parametrize(("jobs", "request_"), [(1, "SIGTERM"), (1, "SIGHUP"), (2, "SIGTERM")])
def test_a_request_to_end_is_an_interrupt(jobs, request_, campaign, tmp_path):
    """A queue that ends a job may start the next on another machine, which cannot see it is gone."""
    with heeding(request_, signal.SIG_DFL):
        process = start(campaign, tmp_path, "--jobs", str(jobs))
    wait_for(is_at_work(tmp_path, made=1))
    children = psutil.Process(process.pid).children(recursive=True)
    process.send_signal(getattr(signal, request_))
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 130
    assert errors.splitlines()[-1] == "interrupted; archives that were finished are kept"
    assert psutil.wait_procs(children, timeout=10)[1] == []
    assert products(tmp_path)  # and no lock


@pytest.mark.posix
def test_a_request_to_end_that_is_ignored_stays_so(campaign, serial, tmp_path):
    """As under nohup."""
    with heeding("SIGHUP", signal.SIG_IGN):
        process = start(campaign, tmp_path)
    wait_for(is_at_work(tmp_path, made=1))
    process.send_signal(signal.SIGHUP)
    process.communicate(timeout=60)
    assert process.returncode == 3
    assert products(tmp_path) == serial


def test_a_second_run_on_the_same_products_is_refused(campaign, serial, tmp_path):
    first = start(campaign, tmp_path)
    wait_for(lambda: _run_named(tmp_path / "processed" / "many"))
    status, said, errors = run(campaign, tmp_path)
    assert status == 6 and said == ""
    assert "another run holds" in errors and f"process {first.pid} on" in errors
    assert "Wait for it or end it" in errors
    first.communicate(timeout=120)
    assert first.returncode == 3
    assert products(tmp_path) == serial


@pytest.mark.posix
def test_a_worker_of_jobs_that_is_killed_ends_the_run_with_words_and_what_was_made_is_kept(
    campaign, serial, tmp_path
):
    process = start(campaign, tmp_path, "--jobs", "2")
    wait_for(is_at_work(tmp_path, made=2))
    os.killpg(process.pid, signal.SIGSTOP)  # or it may end while this looks
    worker = next(
        child
        for child in psutil.Process(process.pid).children(recursive=True)
        if "resource_tracker" not in " ".join(child.cmdline())
    )
    done = archives(tmp_path)
    assert len(done) < len(SOUND), "it was stopped too late to show anything"
    worker.kill()
    os.killpg(process.pid, signal.SIGCONT)
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 1
    assert "a worker process died; found it working on one of T" in errors
    assert "The usual cause is too little memory" in errors and "Traceback" not in errors
    made = products(tmp_path)
    assert done <= archives(tmp_path)
    assert all(serial[name] == made[name] for name in made)
    status, _, _ = run(campaign, tmp_path)
    assert status == 3
    assert products(tmp_path) == serial
    unchanged = {name for name, row in of_tests(tmp_path).items() if row["status"] == "unchanged"}
    assert done <= unchanged < SOUND


def test_slow_pulls_and_surfaces_are_the_same_with_workers(tmp_path, monkeypatch):
    """Runs whose products rest on another test, which is worked on between the passes."""
    leave_out_page(monkeypatch)
    whole = load_campaign(ROOT / "raw" / "nylon-synthetic" / "campaign.toml")
    kept = ("R01", "R07", "Q01")
    plan = whole.experiments["nylon"]
    few = replace(
        whole,
        id="many",
        tests={name: whole.tests[name] for name in kept},
        experiments={"nylon": replace(plan, runs={name: plan.runs[name] for name in kept[:2]})},
    )
    found = []
    with local_workers(2) as two:
        for name, workers in (("serial", None), ("workers", two)):
            result = run_campaign(
                few, processed=tmp_path / name / "processed", reports=tmp_path / "r",
                clock=time.perf_counter, workers=workers,
            )  # fmt: skip
            assert {test.exit_status for test in result.tests} == {0}
            found.append(products(tmp_path / name))
    assert found[0] == found[1]
    assert {"R01.nc", "Q01.nc", "surfaces.nc", "tables/slow_pull.csv"} <= set(found[0])


def test_jobs_and_scheduler_exclude_each_other(campaign, command, tmp_path):
    done = command("run", campaign, "--jobs", "2", "--scheduler", "tcp://127.0.0.1:1", cwd=tmp_path)
    assert done.returncode == 2
    assert "--jobs and --scheduler exclude each other; found --jobs 2 --scheduler" in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_a_scheduler_without_dask_says_what_to_install(campaign, command, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    for name in ("workers", "dask_cluster"):  # which a test before may have imported
        monkeypatch.delitem(sys.modules, f"reduction.batch.{name}", raising=False)
    done = command("run", campaign, "--scheduler", "tcp://127.0.0.1:1", cwd=tmp_path)
    assert done.returncode == 2
    assert "--scheduler needs Dask, which is not installed" in done.stderr
    assert "pip install 'mooring-reduction[cluster]'" in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_several_jobs_need_no_dask(campaign, serial, tmp_path):
    bare = tmp_path / "bare"
    bare.mkdir()
    # found before those that are installed, and by no library that only asks whether there is one
    (bare / "sitecustomize.py").write_text(
        "import sys\nsys.modules |= dict.fromkeys(['dask', 'distributed'])\n"
    )
    status, _, errors = run(
        campaign, tmp_path, "--jobs", "2", "--test", "T01", "--test", "T02",
        PYTHONPATH=f"{bare}{os.pathsep}{ROOT}",
    )  # fmt: skip
    assert status == 0, errors
    made = products(tmp_path)
    assert all(serial[name] == made[name] for name in made if name.endswith(".nc"))


def test_a_folder_of_products_that_workers_do_not_see_ends_the_run(campaign, scheduler, tmp_path):
    """The lock that the run holds is not there where the workers look."""
    address, _ = scheduler
    process = start(campaign, tmp_path, "--scheduler", address)
    folder = tmp_path / "processed" / "many"
    wait_for(lambda: _run_named(folder))
    (folder / "run.lock").unlink()
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 6
    assert "is no longer the lock of this run; found no such file on this machine" in errors
    assert not archives(tmp_path)


_SENDS_MUCH = """
import os, sys, time
from reduction import __version__
from reduction.batch.workers import _work, local_workers

def give_back(data):
    time.sleep(0.05)
    return data

if __name__ == "__main__":
    data = os.urandom(30_000_000)
    with local_workers(2) as workers:
        for _ in range(20):
            workers.executor.submit(_work, __version__, give_back, data)
        time.sleep(float(sys.argv[1]))
        raise KeyboardInterrupt
"""


@pytest.mark.posix
@pytest.mark.parametrize("after", [0.4, 0.5])
def test_workers_that_are_ended_while_they_send_leave_nobody_waiting_for_the_rest(after, tmp_path):
    script = tmp_path / "sends.py"
    script.write_text(_SENDS_MUCH)
    ended = subprocess.run(
        [sys.executable, script, str(after)], timeout=30, capture_output=True, text=True,
        check=False,
    )  # fmt: skip
    assert ended.stderr.splitlines()[-1] == "KeyboardInterrupt"
