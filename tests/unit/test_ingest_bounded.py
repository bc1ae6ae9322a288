"""The process that reads binary files: what breaks there is told, and the run goes on."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import broken_readers as readers
import h5py
import numpy as np
import pytest
from fuzzcases import CASES

from reduction.batch.run_campaign import run_campaign
from reduction.campaign.load import load_campaign
from reduction.readers import bounded_reader as module
from reduction.readers import read_log as read
from reduction.readers.bounded_reader import bounded
from reduction.readers.layout import Layout, LogParts, Watch
from reduction.readers.read_log import read_log
from reduction.record.errors import LogError
from reduction.record.samples import _is_on_disk
from reduction.record.settings import Limits

SHORT = Limits(time=1.0)
BROKE = "the library that reads this format crashed on the file; found an end "
SAVE = "It may be damaged: save it again with the program that wrote it. "
RAISE = "If that is what was logged, raise {} under [limits] of campaign.toml."
MEMORY = f"needed an intact file that takes 2,500,000,000 bytes of memory at most. {SAVE}"
WORDS = {
    readers.crash: f"{BROKE}by SIGSEGV; {MEMORY}{RAISE.format('unpacked_size')}",
    readers.give_up: f"{BROKE}by SIGABRT; {MEMORY}{RAISE.format('unpacked_size')}",
    readers.leave: f"{BROKE}with status 0; {MEMORY}{RAISE.format('unpacked_size')}",
    readers.panic: f"{BROKE.removesuffix('an end ')}BaseException: a check of the library failed; {MEMORY}{RAISE.format('unpacked_size')}",
    readers.swallow: "the file takes more memory than is allowed; found more while it was read; needed "
    f"2,500,000,000 bytes at most. {SAVE}{RAISE.format('unpacked_size')}",
}
ON_LINUX = pytest.mark.skipif(sys.platform != "linux", reason="memory is bounded on Linux alone")
BROKEN = [
    pytest.param(r, marks=ON_LINUX if r is readers.swallow else (), id=r.__name__) for r in WORDS
]


@pytest.fixture
def path(tmp_path):
    made = tmp_path / "log.h5"
    with h5py.File(made, "w") as file:
        file["t"], file["F"] = np.arange(1000.0), np.arange(1000.0) ** 2
    return made


LAYOUT = Layout.model_validate(
    {
        "format": "hdf5",
        "channels": {
            "time": {"column": "t", "unit": "s"},
            "tension.1": {"column": "F", "unit": "N"},
        },
    }
)


def check_is_read(path):
    log = read_log(path, LAYOUT, name="log")
    np.testing.assert_array_equal(log.columns["tension.1"], np.arange(1000.0) ** 2)


@pytest.mark.parametrize("reader", BROKEN)
def test_a_reader_that_breaks_is_told_and_the_next_file_is_read(path, reader, capfd):
    with pytest.raises(LogError) as caught:
        bounded(reader, path, watch=Watch(path))
    assert str(caught.value) == f"{path}: {WORDS[reader]}"
    check_is_read(path)
    assert capfd.readouterr() == ("", "")


def test_a_reader_that_hangs_is_ended(path):
    module._end_reader()
    begin = time.monotonic()
    with pytest.raises(
        LogError, match=r"the file takes too long to read; .*needed 1 s at most"
    ) as e:
        bounded(readers.hang, path, watch=Watch(path, SHORT))
    assert e.value.hint == RAISE.format("time")
    assert time.monotonic() - begin < 60
    check_is_read(path)


def test_one_process_reads_all_files_until_one_breaks_it(path):
    first, again = (bounded(readers.whereabouts, path, watch=Watch(path))[1] for _ in range(2))
    assert first == again != os.getpid()
    with pytest.raises(LogError, match="is not in the file"):
        read_log(path, LAYOUT.model_copy(update={"group": "log"}), name="log")
    assert bounded(readers.whereabouts, path, watch=Watch(path))[1] == first
    with pytest.raises(LogError, match="SIGSEGV"):
        bounded(readers.crash, path, watch=Watch(path))
    assert bounded(readers.whereabouts, path, watch=Watch(path))[1] != first


def test_what_a_library_prints_is_not_shown(path, capfd):
    assert bounded(readers.chatter, path, watch=Watch(path)) == "read"
    assert capfd.readouterr() == ("", "")


def test_a_fault_of_this_package_is_none_of_the_file(path):
    with pytest.raises(KeyError, match="no such key") as caught:
        bounded(readers.stumble, path, watch=Watch(path))
    assert "in stumble" in caught.value.__notes__[0]


def test_a_path_is_that_of_the_folder_in_which_it_is_asked_for(path, monkeypatch):
    bounded(readers.whereabouts, path, watch=Watch(path))
    monkeypatch.chdir(path.parent)
    short = Path(path.name)
    assert bounded(readers.whereabouts, short, watch=Watch(short))[0] == path.resolve()
    with pytest.raises(LogError) as caught:
        bounded(readers.crash, short, watch=Watch(short))
    assert str(caught.value).startswith("log.h5: ")


def test_columns_on_disk_are_taken_over(path, tmp_path):
    parts = LogParts(in_memory=0, folder=tmp_path / "scratch")
    parts.folder.mkdir()
    log = read_log(path, LAYOUT, name="log", parts=parts)
    assert not list(parts.folder.iterdir())
    assert all(_is_on_disk(column) for column in log.columns.values())
    np.testing.assert_array_equal(log.columns["tension.1"], np.arange(1000.0) ** 2)
    log.columns["tension.1"][0] = 1.0  # its own from now on
    with pytest.raises(LogError, match="SIGSEGV"):
        bounded(readers.crash_with_columns_on_disk, path, parts=parts, watch=Watch(path))
    assert not list(parts.folder.iterdir())


@pytest.mark.posix
def test_the_process_ends_with_the_run_however_that_ends(path):
    code = (
        "import broken_readers as readers, sys, time; from pathlib import Path;"
        "from reduction.readers.bounded_reader import bounded; from reduction.readers.layout import Watch;"
        "p = Path(sys.argv[1]); print(bounded(readers.whereabouts, p, watch=Watch(p))[1], flush=True);"
        "time.sleep(1000)"
    )
    run = subprocess.Popen(
        [sys.executable, "-c", code, str(path)],
        stdout=subprocess.PIPE,
        env=os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
    )
    reader = int(run.stdout.readline())
    run.kill()
    run.wait()
    run.stdout.close()
    for _ in range(600):
        try:
            os.kill(reader, 0)
        except ProcessLookupError:
            return
        if (stat := Path(f"/proc/{reader}/stat")).exists() and ") Z " in stat.read_text():
            return  # ended, and waits for the system to take note
        time.sleep(0.1)
    os.kill(reader, signal.SIGKILL)
    pytest.fail("the process was left behind")


@ON_LINUX
def test_a_run_goes_on_with_the_other_tests(tmp_path, monkeypatch):
    """A good log after one that crashes its reader, one that hangs it and one that swallows memory."""
    raw, text = tmp_path / "raw", CASES["hdf5"].files["campaign.toml"].decode()
    raw.mkdir()
    (raw / "A.h5").write_bytes(CASES["hdf5"].files["A.h5"])
    head, good = text[: text.index("[tests.A]")], text[text.index("[tests.A]") :]
    layout = head[head.index("[layouts.logger]") :]
    expected = []
    for name, kind, readers_of, reader, words in (
        (
            "B",
            "tdms",
            read._IN_PARTS,
            readers.crash,
            "crashed on the file; found an end by SIGSEGV",
        ),
        ("C", "parquet", read._IN_PARTS, readers.hang, "needed 3 s at most"),
        ("D", "matlab", read._WHOLE, readers.swallow, "takes more memory than is allowed"),
    ):
        monkeypatch.setitem(readers_of, kind, reader)
        (raw / f"{name}.bin").write_bytes(b"anything")
        head += layout.replace("logger", kind).replace('"hdf5"', f'"{kind}"')
        head += (
            good[: good.index("layout")].replace("A.h5", f"{name}.bin").replace(".A]", f".{name}]")
        )
        head += good[good.index("layout") :].replace("logger", kind)
        expected.append((name, 3, words))
    (raw / "campaign.toml").write_text(head + good + '[limits]\ntime = "3 s"\n')
    places = {"processed": tmp_path / "processed", "reports": tmp_path / "reports"}
    done = run_campaign(load_campaign(raw / "campaign.toml"), **places, clock=lambda: 0.0)
    assert [one.test for one in done.tests] == ["B", "C", "D", "A"]
    for one, (name, status, words) in zip(done.tests, expected, strict=False):
        assert one.exit_status == status and words in one.message
        assert one.message.startswith(f"{raw}/{name}.bin: ") and "under [limits]" in one.message
    assert done.tests[-1].exit_status == 0 and done.tests[-1].n_rows == 420
    assert done.exit_status == 3
