"""Work on tests in this process, in processes beside it, and on workers of Dask."""

import os
import pickle
import platform
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import cloudpickle
import psutil
import pytest
import workerdeeds
from distributed import Client, KilledWorker, LocalCluster
from distributed.comm import CommClosedError
from workerdeeds import add_a_line, die_slowly, double, raise_data_error, say_and_wait, variables

from reduction.batch import dask_cluster as cluster
from reduction.batch import workers as executor
from reduction.batch.dask_cluster import users_cluster
from reduction.batch.workers import Task, Workers, local_workers, work_on
from reduction.record.errors import DataError, LogError, SettingsError, WorkerError

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def local():
    with local_workers(2) as found:
        yield found


@pytest.fixture(scope="module")
def dask_workers():
    # these workers cannot import the file of deeds: it is sent to them whole
    cloudpickle.register_pickle_by_value(workerdeeds)
    with (
        LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, memory_limit=0,
            dashboard_address="127.0.0.1:0",
        ) as own,
        users_cluster(own.scheduler_address) as found,
    ):  # fmt: skip
        yield found
    cloudpickle.unregister_pickle_by_value(workerdeeds)


@pytest.fixture(params=["here", "local", "dask_workers"])
def workers(request):
    return None if request.param == "here" else request.getfixturevalue(request.param)


@pytest.fixture(params=["local", "dask_workers"])
def others(request):
    return request.getfixturevalue(request.param)


def test_every_task_gives_its_result_with_the_name_of_its_test(workers):
    ended = {
        one.test: one
        for one in work_on(double, [Task(name, (name,)) for name in "abc"], workers=workers)
    }
    assert {name: one.value for name, one in ended.items()} == {"a": "aa", "b": "bb", "c": "cc"}
    assert all(one.error is None for one in ended.values())
    pids = {one.worker.rpartition(":")[2] for one in ended.values()}
    assert pids == {""} if workers is None else str(os.getpid()) not in pids


def test_work_of_this_process_is_done_in_order_each_when_it_is_asked_for():
    order = []

    def tasks():
        for name in "ab":
            order.append(f"{name} made")
            yield Task(name, (name,), size=1 if name == "b" else 0)

    ending = work_on(
        lambda name: order.append(f"{name} done"),
        tasks(),
        workers=None,
        begun=lambda name: order.append(f"{name} begun"),
    )
    order.extend(f"{one.test} told" for one in ending)
    assert order == [
        f"{name} {what}" for name in "ab" for what in ("made", "begun", "done", "told")
    ]


def test_the_largest_work_is_begun_first(tmp_path):
    file = tmp_path / "order"
    tasks = [Task(str(size), (file, size), size) for size in (2, 9, 1, 5)]
    with local_workers(1) as one:
        assert len(list(work_on(add_a_line, tasks, workers=one))) == 4
    assert file.read_text().split() == ["9", "5", "2", "1"]


def test_an_error_with_words_of_a_worker_is_raised_with_all_its_parts(others):
    with pytest.raises(DataError, match=r"^a.csv:3 \[load\]: no sense in it; found 7$") as caught:
        list(work_on(raise_data_error, [Task("a", ("7",))], workers=others))
    assert caught.value.facts == {"file": "a.csv", "row": 3, "channel": "load"}


def test_another_error_of_a_worker_is_told_by_its_kind(others):
    with pytest.raises(
        WorkerError, match="a worker could not do what it was asked; found ValueErr"
    ):
        list(work_on(int, [Task("a", ("no number",))], workers=others))


def test_a_worker_of_another_version_is_refused(others, monkeypatch):
    monkeypatch.setattr(executor, "__version__", "0.0.7")
    with pytest.raises(SettingsError, match=r"has another version of reduction.*needed 0\.0\.7"):
        list(work_on(double, [Task("a", (1,))], workers=others))


def test_workers_of_one_machine_share_its_processors(local):
    (ended,) = work_on(variables, [Task("a", ())], workers=local)
    processors = len(os.sched_getaffinity(0))
    assert ended.value == {
        "OMP_NUM_THREADS": str(max(1, processors // 2)), "OPENBLAS_NUM_THREADS": "1",
    }  # fmt: skip


def test_a_worker_process_that_dies_ends_the_work_and_the_tests_at_work_are_named():
    tasks = [Task(str(size), (None if size == 5 else size,), size) for size in range(1, 9)]
    told = []
    with (
        local_workers(2) as two,
        pytest.raises(
            WorkerError,
            match=r"^a worker process died; found it working on one of \d, \d; needed workers that "
            "live .*The usual cause is too little memory.*Archives that were finished are kept; run "
            "again",
        ) as caught,
    ):
        told.extend(one.value for one in work_on(die_slowly, tasks, workers=two))
    assert caught.value.exit_status == 1
    assert {8, 7} <= set(told) <= {8, 7, 6, 4} and "5" in caught.value.found
    with pytest.raises(WorkerError, match="a worker process died"):
        list(work_on(double, [Task("a", (1,))], workers=two))


def test_processes_that_cannot_begin_are_told(monkeypatch):
    monkeypatch.setattr(executor, "_begin", workerdeeds.refuse_to_begin)
    with (
        pytest.raises(
            WorkerError, match="cannot be started on this machine; found BrokenProc.* --jobs 1"
        ),
        local_workers(2),
    ):
        pass


RUNS = """
import sys, threading, time
from pathlib import Path
from workerdeeds import say_and_wait
from reduction.batch.workers import Task, local_workers, work_on
if __name__ == "__main__":
    if sys.argv[2] == "spawn":
        threading.Thread(target=time.sleep, args=(600,), daemon=True).start()
    with local_workers(2) as two:
        tasks = [Task(name, (Path(sys.argv[1]),)) for name in "ab"]
        list(work_on(say_and_wait, tasks, workers=two))
"""


@pytest.mark.parametrize("way", ["fork", "spawn"])
def test_worker_processes_end_with_the_one_that_started_them(way, tmp_path):
    """Also where it is killed, and can end nobody; however they were started.

    They are forked where no other thread could hold a lock then, and start anew elsewhere.
    """
    process = subprocess.Popen(
        [sys.executable, "-c", RUNS, tmp_path, way],
        env=os.environ | {"PYTHONPATH": f"{ROOT}:{ROOT / 'tests'}", "OPENBLAS_NUM_THREADS": "1"},
    )
    end = time.monotonic() + 60
    while len(list(tmp_path.iterdir())) < 2 and time.monotonic() < end:
        time.sleep(0.02)
    workers = [psutil.Process(int(path.name)) for path in tmp_path.iterdir()]
    assert len(workers) == 2
    can_fork = sys.platform == "linux" and way == "fork"
    assert [RUNS in one.cmdline() for one in workers] == [can_fork, can_fork]
    process.kill()
    process.wait()
    assert psutil.wait_procs(workers, timeout=10)[1] == []


def test_what_workers_do_is_ended_with_the_run(tmp_path):
    found = []

    def interrupted():
        with local_workers(1) as one:
            one.executor.submit(say_and_wait, tmp_path)
            while not found:
                found.extend(tmp_path.iterdir())
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert not psutil.pid_exists(int(found[0].name))


def test_a_test_at_which_workers_of_a_scheduler_die_fails_alone_and_with_words():
    def of_dask(value):
        if value == 5:
            raise KilledWorker("_work-5", None, 3)
        return value

    tasks = [Task(str(number), (number,)) for number in range(12)]
    with ThreadPoolExecutor(2) as threads:
        workers = Workers(threads, threads.shutdown, deadly=(KilledWorker,))
        ended = {one.test: one for one in work_on(of_dask, tasks, workers=workers)}
    dead = ended.pop("5")
    assert {name: one.value for name, one in ended.items()} == {
        str(number): number for number in range(12) if number != 5
    }
    assert dead.value is None and isinstance(dead.error, WorkerError)
    assert str(dead.error).startswith("every worker that began this test died; found more")
    assert dead.error.exit_status == 1


def test_a_scheduler_that_is_lost_while_tests_are_at_work_is_told(monkeypatch):
    def closed():
        raise CommClosedError("in <TCP (closed) ConnectionPool.ncores>")

    monkeypatch.setattr(executor, "PATIENCE", 0.1)
    with (
        LocalCluster(
            n_workers=1, processes=False, protocol="tcp", dashboard_address="127.0.0.1:0"
        ) as own,
        users_cluster(own.scheduler_address) as found,
    ):
        monkeypatch.setattr(found.executor._client, "nthreads", closed)
        with pytest.raises(WorkerError, match="the scheduler was lost"):
            list(work_on(time.sleep, [Task("a", (1,))], workers=found))


def test_a_scheduler_that_is_lost_while_workers_are_waited_for_is_told(monkeypatch):
    def lost(client, n_workers, timeout):
        raise OSError("Timed out trying to connect")

    monkeypatch.setattr(Client, "wait_for_workers", lost)
    with (
        LocalCluster(n_workers=0, dashboard_address="127.0.0.1:0") as bare,
        pytest.raises(WorkerError, match="the scheduler was lost"),
        users_cluster(bare.scheduler_address),
    ):
        pass


def test_an_address_where_no_scheduler_answers_is_refused(monkeypatch):
    monkeypatch.setattr(cluster, "_ANSWER", 0.3)
    with (
        pytest.raises(SettingsError, match="no scheduler answers at the address of --scheduler"),
        users_cluster("tcp://127.0.0.1:9"),
    ):
        pass


@pytest.mark.parametrize(
    "address",
    ["nonsense://x:1", "127.0.0.1:not-a-port", "localhost", "", "tcp://host", "tcp://host:99999",
     "tcp://ann:pass-word@host:1", "http://127.0.0.1:8786"],
)  # fmt: skip
def test_an_address_that_is_none_is_refused_before_a_client_is_made(address, monkeypatch):
    monkeypatch.setattr(cluster, "Client", pytest.fail)
    with (
        pytest.raises(
            SettingsError, match="no scheduler answers at .* such as tcp://192.0.2.1:8786$"
        ) as caught,
        users_cluster(address),
    ):
        pass
    assert "pass-word" not in str(caught.value)


def test_an_address_with_tls_needs_certificates(monkeypatch):
    monkeypatch.setattr(cluster, "Client", pytest.fail)
    with (
        pytest.raises(SettingsError, match="asks for TLS, and no certificate is known; found tls"),
        users_cluster("tls://127.0.0.1:1"),
    ):
        pass


def test_a_scheduler_without_workers_is_refused(monkeypatch):
    monkeypatch.setattr(cluster, "PATIENCE", 0.3)
    with (
        LocalCluster(n_workers=0, dashboard_address="127.0.0.1:0") as bare,
        pytest.raises(WorkerError, match="has no worker; found none for 0 s"),
        users_cluster(bare.scheduler_address),
    ):
        pass


def test_a_run_does_not_wait_for_ever_for_workers_that_are_lost(monkeypatch):
    monkeypatch.setattr(executor, "PATIENCE", 0.5)
    with (
        LocalCluster(
            n_workers=1,
            threads_per_worker=1,
            processes=False,
            protocol="tcp",
            dashboard_address="127.0.0.1:0",
        ) as own,
        users_cluster(own.scheduler_address) as found,
    ):
        ending = work_on(time.sleep, [Task("a", (0.3,)), Task("b", (0.3,))], workers=found)
        next(ending)
        own.scale(0)
        with pytest.raises(WorkerError, match="no worker is left"):
            list(work_on(time.sleep, [Task("c", (0.3,))], workers=found))


@pytest.mark.parametrize(
    "error",
    [
        LogError("a.csv", "odd", row=3, channel="load", found="x"),
        DataError("odd", found="1", needed="2", hint="Do.", file="a", row=1, channel="c"),
        WorkerError("lost"),
    ],
)
@pytest.mark.parametrize("way", [pickle, cloudpickle])
def test_an_error_goes_to_another_process_whole(error, way):
    again = way.loads(way.dumps(error))
    assert type(again) is type(error) and str(again) == str(error)
    assert again.args == error.args and again.facts == error.facts


_FAULTS = """
import resource, sys
import numpy as np
from reduction.batch.workers import keep_freed_memory
if sys.argv[1] == "kept":
    keep_freed_memory()
for _ in range(3):
    before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
    np.ones(500_000) + np.ones(500_000)
print(resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before)
"""


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="others have no such choice")
def test_memory_that_was_freed_is_taken_again_without_the_system():
    given, kept = (
        int(subprocess.check_output([sys.executable, "-c", _FAULTS, how]))
        for how in ("given back", "kept")
    )
    pages = 500_000 * 8 // 4096
    assert kept < pages / 2 < given
