"""Workers of Dask under a campaign: what they give, and what becomes of work at which they die."""

import os
import signal
import time

import cloudpickle
import pytest
from distributed import Client, LocalCluster
from distributed.comm import CommClosedError

from reduction.batch import cluster as module
from reduction.batch import clusters
from reduction.batch.clusters import local_cluster, users_cluster
from reduction.batch.executor import Serial
from reduction.errors import DataError, LogError, SettingsError, WorkerError


@pytest.fixture(scope="module")
def cluster():
    with local_cluster(2) as found:
        yield found


def double(value):
    return 2 * value


def raise_data_error(value):
    raise DataError("no sense in it", found=value, file="a.csv", row=3, channel="load")


def wait_a_little(value):
    time.sleep(0.1)
    return value


def variables():
    return {name: os.environ.get(name) for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS")}


def die_in_good_company(folder, value):
    """End the worker the first time."""
    mark = folder / f"{value}"
    if not mark.exists():
        mark.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return value


# the workers cannot import this file: what stands in the main program is sent to them whole
for sent in (double, raise_data_error, wait_a_little, variables, die_in_good_company):
    sent.__module__ = "__main__"


@pytest.mark.parametrize("kind", ["serial", "cluster"])
def test_every_task_gives_its_result_with_the_name_of_its_test(kind, request):
    executor = Serial() if kind == "serial" else request.getfixturevalue("cluster")
    sent = executor.send(21)
    first = [executor.start(double, sent, stage="survey", test=name) for name in "abc"]
    second = [executor.start(double, one, stage="", test=one.test) for one in first]
    ended = {one.test: one for one in executor.ended(second)}
    assert {name: one.value for name, one in ended.items()} == {"a": 84, "b": 84, "c": 84}
    assert all(one.error is None for one in ended.values())
    assert all(one.worker.startswith("tcp://") == executor.is_elsewhere for one in ended.values())


@pytest.mark.parametrize("kind", ["serial", "cluster"])
def test_the_begin_of_work_is_told_of_stages_that_have_a_name(kind, request, monkeypatch):
    executor = Serial() if kind == "serial" else request.getfixturevalue("cluster")
    told = []
    monkeypatch.setattr(executor, "begun", told.append)
    kept = executor.start(double, 1, stage="survey", test="a")
    list(executor.ended([executor.start(double, kept, stage="", test="a")]))
    end = time.monotonic() + 5
    while not told and time.monotonic() < end:
        time.sleep(0.01)
    assert told == ["a"]


def test_serial_work_is_done_once_and_in_order():
    order = []
    executor = Serial()
    kept = executor.start(order.append, "kept", stage="survey", test="a")
    tasks = [
        executor.start(lambda _, n=n: order.append(n), kept, stage="x", test="") for n in "123"
    ]
    assert order == []
    assert len(list(executor.ended(tasks))) == 3
    assert order == ["kept", "1", "2", "3"]


def test_the_largest_work_is_begun_first():
    begun = []
    with local_cluster(1) as one:
        one.begun = begun.append
        tasks = [one.start(wait_a_little, 0, stage="reduce", test="held")]
        tasks += [
            one.start(wait_a_little, size, stage="reduce", test=str(size), size=size)
            for size in (2, 9, 1, 5)
        ]
        assert len(list(one.ended(tasks))) == 5
    assert begun[-3:] == ["9", "5", "1"]  # the worker had the others by then


def test_an_error_with_words_of_a_worker_is_raised_with_all_its_parts(cluster):
    task = cluster.start(raise_data_error, "7", stage="reduce", test="a")
    with pytest.raises(DataError, match=r"^a.csv:3 \[load\]: no sense in it; found 7$") as caught:
        list(cluster.ended([task]))
    assert caught.value.facts == {"file": "a.csv", "row": 3, "channel": "load"}


def test_another_error_of_a_worker_is_told_by_its_kind(cluster):
    task = cluster.start(int, "no number", stage="reduce", test="a")
    with pytest.raises(
        WorkerError, match="a worker could not do what it was asked; found ValueErr"
    ):
        list(cluster.ended([task]))


def test_a_worker_of_another_version_is_refused(cluster, monkeypatch):
    monkeypatch.setattr(module, "__version__", "0.0.7")
    task = cluster.start(double, 1, stage="reduce", test="a")
    with pytest.raises(SettingsError, match=r"has another version of reduction.*needed 0\.0\.7"):
        list(cluster.ended([task]))


def test_workers_of_one_machine_share_its_processors(cluster, monkeypatch):
    (ended,) = cluster.ended([cluster.start(variables, stage="reduce", test="a")])
    processors = len(os.sched_getaffinity(0))
    assert ended.value == {
        "OMP_NUM_THREADS": str(max(1, processors // 2)), "OPENBLAS_NUM_THREADS": "1",
    }  # fmt: skip


def test_a_worker_that_dies_costs_its_tasks_a_retry(cluster, tmp_path):
    tasks = [
        cluster.start(wait_a_little, number, stage="reduce", test=str(number))
        for number in range(8)
    ]
    tasks.append(cluster.start(die_in_good_company, tmp_path, 8, stage="reduce", test="8"))
    ended = list(cluster.ended(tasks))
    assert sorted(one.value for one in ended) == list(range(9))


def slow_pid():
    time.sleep(0.5)
    return os.getpid()


slow_pid.__module__ = "__main__"


def kill_holder(cluster, task):
    end = time.monotonic() + 20
    while task.future.status != "finished" and time.monotonic() < end:
        time.sleep(0.01)
    (holder,) = next(iter(cluster._client.who_has([task.future]).values()))
    pid = cluster._client.run(os.getpid)[holder]
    os.kill(pid, signal.SIGKILL)
    return pid


def test_a_result_that_is_lost_with_its_worker_is_made_again(cluster, monkeypatch):
    monkeypatch.setattr(module, "_LOOK", 0.1)
    task = cluster.start(slow_pid, stage="reduce", test="a")
    pid = kill_holder(cluster, task)
    (ended,) = cluster.ended([task])
    assert ended.error is None and ended.value != pid


def test_a_result_that_is_lost_after_it_was_said_to_have_ended_is_made_again(cluster, monkeypatch):
    monkeypatch.setattr(module, "_LOOK", 0.1)
    tasks = {name: cluster.start(slow_pid, stage="reduce", test=name) for name in "ab"}
    ending = cluster.ended(tasks.values())
    first = next(ending)
    (other,) = (task for name, task in tasks.items() if name != first.test)
    pid = kill_holder(cluster, other)
    end = time.monotonic() + 20
    while other.future.status == "finished" and time.monotonic() < end:
        time.sleep(0.001)
    assert other.future.status in ("lost", "pending")
    (ended,) = ending
    assert ended.error is None and ended.value != pid


def test_a_result_that_takes_long_to_arrive_is_waited_for(cluster, monkeypatch):
    """Each time that it is looked for it is fetched from its first byte on."""
    monkeypatch.setattr(module, "_LOOK", 0.05)
    task = cluster.start(slow_pid, stage="reduce", test="a")
    whole = task.future.result

    def slow(timeout):
        if timeout < 0.5:
            time.sleep(timeout)
            raise TimeoutError
        return whole(timeout=timeout)

    monkeypatch.setattr(task.future, "result", slow)
    (ended,) = cluster.ended([task])
    assert ended.error is None and ended.value != os.getpid()


def test_a_scheduler_that_is_lost_in_the_moment_in_which_it_is_asked_is_told(cluster, monkeypatch):
    def closed():
        raise CommClosedError("in <TCP (closed) ConnectionPool.ncores>")

    monkeypatch.setattr(module, "_LOOK", 0.05)
    monkeypatch.setattr(cluster._client, "nthreads", closed)
    task = cluster.start(slow_pid, stage="reduce", test="a")
    with pytest.raises(WorkerError, match="the scheduler was lost"):
        list(cluster.ended([task]))


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


def test_a_test_at_which_workers_die_fails_alone_and_with_words(cluster):
    kept = cluster.start(os._exit, 1, stage="survey", test="deadly")
    tasks = [
        cluster.start(wait_a_little, number, stage="survey", test=str(number))
        for number in range(12)
    ]
    tasks.append(cluster.start(double, kept, stage="", test="deadly"))
    ended = {one.test: one for one in cluster.ended(tasks)}
    assert [ended[str(number)].value for number in range(12)] == list(range(12))
    dead = ended["deadly"]
    assert dead.value is None and isinstance(dead.error, WorkerError)
    assert str(dead.error).startswith("every worker that began this test died at it")
    assert dead.error.exit_status == 1


def test_an_address_where_no_scheduler_answers_is_refused(monkeypatch):
    monkeypatch.setattr(clusters, "_ANSWER", 0.3)
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
    monkeypatch.setattr(clusters, "Client", pytest.fail)
    with (
        pytest.raises(
            SettingsError, match="no scheduler answers at .* such as tcp://192.0.2.1:8786$"
        ) as caught,
        users_cluster(address),
    ):
        pass
    assert "pass-word" not in str(caught.value)


def test_an_address_with_tls_needs_certificates(monkeypatch):
    monkeypatch.setattr(clusters, "Client", pytest.fail)
    with (
        pytest.raises(SettingsError, match="asks for TLS, and no certificate is known; found tls"),
        users_cluster("tls://127.0.0.1:1"),
    ):
        pass


def test_a_scheduler_without_workers_is_refused(monkeypatch):
    monkeypatch.setattr(clusters, "PATIENCE", 0.3)
    with (
        LocalCluster(n_workers=0, dashboard_address="127.0.0.1:0") as bare,
        pytest.raises(WorkerError, match="has no worker; found none for 0 s"),
        users_cluster(bare.scheduler_address),
    ):
        pass


def test_a_run_does_not_wait_for_ever_for_workers_that_are_lost(monkeypatch):
    monkeypatch.setattr(module, "PATIENCE", 0.5)
    monkeypatch.setattr(module, "_LOOK", 0.1)
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
        task = found.start(time.sleep, 0.3, stage="reduce", test="a")
        own.scale(0)
        again = found.start(wait_a_little, 1, stage="reduce", test="b")
        with pytest.raises(WorkerError, match="no worker is left"):
            list(found.ended([task, again]))


@pytest.mark.parametrize(
    "error",
    [
        LogError("a.csv", "odd", row=3, channel="load", found="x"),
        DataError("odd", found="1", needed="2", hint="Do.", file="a", row=1, channel="c"),
        WorkerError("lost"),
    ],
)
def test_an_error_goes_to_another_process_whole(error):
    again = cloudpickle.loads(cloudpickle.dumps(error))
    assert type(again) is type(error) and str(again) == str(error)
    assert again.args == error.args and again.facts == error.facts
