"""Runs that are not alone, or have no room: ``PYTHONPATH=tests python -m faults.company 60``.

Two runs of one campaign at once, one of them killed; a run of which a worker is killed; a run on a
disk (a tmpfs, so root alone can) that becomes full at a random byte.
"""

import argparse
import contextlib
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections import Counter
from pathlib import Path

import psutil
from faults.harness import (
    RUN,
    STATES,
    Mender,
    Victim,
    contents,
    failed_tests,
    faults,
    is_in_order,
    made_of_archives,
    make_states,
    mixture,
)

HOW = ("two", "worker", "full")


class Company:
    """Runs beside others, one after the other."""

    def __init__(self, folder, seed):
        """Make the states."""
        self.victim = Victim(folder / "victim")
        self.other = Victim(folder / "other")
        self.states = make_states(self.victim, folder / "states")
        self.mender = Mender(self.victim, is_verified=False)
        self.seen = Counter()
        self._random = random.Random(seed)  # noqa: S311 - moments, not secrets
        self._place, self._scratch, self._disk = folder / "two", folder / "made", folder / "disk"
        self._disk.mkdir()

    def _begin(self, name):
        shutil.rmtree(self._place, ignore_errors=True)
        shutil.copytree(self.states[name].folder, self._place)

    def two(self, name, seconds=1.5):
        """Two runs begin within ``seconds``, of which the first is killed at some moment."""
        self._begin(name)
        state, second = self.states[name], []
        wait, moment = self._random.uniform(0, seconds), self._random.uniform(0, 1.5 * seconds)

        def beside():
            time.sleep(wait)
            second.append(self.other.run(self._place))

        def meanwhile(process):
            time.sleep(moment)
            # where the run was quicker there is nobody to kill
            with contextlib.suppress(ProcessLookupError):
                os.kill(process, signal.SIGKILL)

        thread = threading.Thread(target=beside)
        thread.start()
        first = self.victim.run(self._place, meanwhile=meanwhile)
        thread.join()
        wrong = []
        for one in (first, *second):
            self.seen[f"two: status {one.status}"] += 1
            if one.status not in (0, 6, -signal.SIGKILL) or "Traceback" in one.said:
                wrong.append(f"status {one.status}: {one.said}")
            if one.status == 6 and "run.lock" not in one.said:
                wrong.append(f"refused for another reason: {one.said}")
        now = contents(self._place)
        ended = {first.status, second[0].status}
        # who comes last sweeps what the dead one began
        wrong += faults(state, now, may_be_left=first.status != 0 and second[0].status != 0)
        if 0 in ended and (old := [k for k in state.after if now.get(k) != state.after[k]]):
            # one that ended before the other was killed has made all; nobody came after
            wrong.append(f"a run ended with 0, and not new: {old}")
        wrong += self.mender.faults(state, self._place, now)
        return [
            f"{name}, second after {wait:.3f}, killed after {moment:.3f} s: {one}" for one in wrong
        ]

    def worker(self, name, seconds=6.0):
        """A run of two workers, of which one is killed at some moment."""
        self._begin(name)
        state, moment, killed = self.states[name], self._random.uniform(0.5, seconds), []

        def meanwhile(process):
            time.sleep(moment)
            with contextlib.suppress(psutil.NoSuchProcess):
                workers = [
                    one
                    for one in psutil.Process(process).children(recursive=True)
                    if "resource_tracker" not in " ".join(one.cmdline())
                ]
                if workers:
                    killed.append(self._random.choice(workers))
                    killed[0].kill()

        ended = self.victim.run(self._place, *RUN, "--jobs", "2", meanwhile=meanwhile)
        self.seen[f"worker: {len(killed)} killed, status {ended.status}"] += 1
        now = contents(self._place)
        wrong = faults(state, now)
        is_told = "a worker process died" in ended.said or "cannot be started" in ended.said
        if ended.status != (1 if killed and is_told else 0):
            wrong.append(f"status {ended.status}: {ended.said}")
        elif ended.status == 0 and now != state.after:
            wrong.append("other products than those of one process")
        wrong += self.mender.faults(state, self._place, now)
        return [f"{name}, worker killed after {moment:.3f} s: {one}" for one in wrong]

    def full(self, name):
        """A run on a disk that is full at some byte, and one more when there is room."""
        state = self.states[name]
        room = _size(state.folder) + self._random.randint(0, 2 * _size(self.states["older"].folder))
        with _disk(self._disk, room):
            place = self._disk / "campaign"
            shutil.copytree(state.folder, place)
            ended = self.victim.run(place)
            self.seen[f"full: status {ended.status}"] += 1
            now = contents(place)
            made_of = made_of_archives(place, self._scratch) if failed_tests(place) else None
            wrong = faults(state, now, made_of=made_of)
            if made_of is None and not is_in_order(mixture(state, now)):
                wrong.append(f"products are new in another order: {mixture(state, now)}")
            if ended.status not in (0, 6) or "Traceback" in ended.said:
                wrong.append(f"status {ended.status}: {ended.said}")
            if ended.status == 6 and "space" not in ended.said:
                wrong.append(f"the cause is not named: {ended.said}")
            _command("mount", "-o", "remount,size=200m", self._disk)
            again = self.victim.run(place)
            if again.status != 0 or contents(place) != state.after:
                wrong.append(f"one more run: status {again.status}: {again.said}")
        return [f"{name}, room for {room} bytes: {one}" for one in wrong]

    def close(self):
        """End the processes that fork."""
        self.victim.close()
        self.other.close()


def _size(folder):
    """Bytes of the files below a folder, in pages of a disk in memory."""
    return sum(-(-path.stat().st_size // 4096) * 4096 for path in folder.rglob("*"))


@contextlib.contextmanager
def _disk(folder, n_bytes):
    _command("mount", "-t", "tmpfs", "-o", f"size={n_bytes}", "tmpfs", folder)
    try:
        yield
    finally:
        _command("umount", folder)


def _command(name, *words):
    subprocess.run([shutil.which(name), *words], check=True)


def main():
    """Try so many of each, and say what came of it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("number", type=int)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", choices=HOW, action="append")
    asked = parser.parse_args()
    n_wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        company = Company(Path(folder), asked.seed)
        for how in asked.only or HOW:
            for number in range(asked.number):
                for one in getattr(company, how)(STATES[number % len(STATES)]):
                    n_wrong += 1
                    print(f"{how}: {one}", flush=True)  # noqa: T201
        company.close()
    for what, count in sorted(company.seen.items()):
        print(f"{count:5} {what}")  # noqa: T201
    print(f"{n_wrong:5} faults")  # noqa: T201
    sys.exit(bool(n_wrong))


if __name__ == "__main__":
    main()
