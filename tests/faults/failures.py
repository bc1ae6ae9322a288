"""Make the n-th call of a run on files fail, for n in turn: ``PYTHONPATH=tests python -m faults.failures``.

Without options every call but reads of archives fails once, each with one of the errors that it may
have; ``--whole`` goes over all errors, those that stay, and the reads of archives too.
"""

import argparse
import contextlib
import errno
import re
import shutil
import signal
import sys
import tempfile
from collections import Counter
from pathlib import Path

from faults.calls import ALL, SHORT, mask
from faults.harness import (
    STATES,
    STATUSES,
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

READS = mask("read")
CHANGES = mask("write", "open to write", "fsync", "rename", "unlink", "mkdir", "ftruncate", "link")
# (error or SHORT, whether it stays): a bad sector, a disk that fills, rights that are taken
# away, a file system that the kernel makes read-only, fewer bytes than were asked for
ONCE = ((errno.EIO, False), (errno.EPERM, False))
WRITING = (
    (errno.ENOSPC, True), (errno.EROFS, True), (SHORT, False), (errno.EIO, False),
    (errno.EPERM, False), (errno.ENOSPC, False),
)  # fmt: skip
WORDS = {
    errno.EIO: "Input/output error", errno.ENOSPC: "No space left on device",
    errno.EPERM: "Operation not permitted", errno.EROFS: "Read-only file system",
}  # fmt: skip


class Failures:
    """Runs in which a call fails, one after the other."""

    def __init__(self, folder, others=None):
        """Take process and states of others, where there are such."""
        self.victim = others.victim if others else Victim(folder / "victim")
        self.states = others.states if others else make_states(self.victim, folder / "states")
        self.mender = others.mender if others else Mender(self.victim, is_verified=False)
        self.seen = Counter()
        self._place, self._scratch = folder / "failed", folder / "made"
        self.ended = None
        self._calls, self._made = {}, {}

    def calls(self, name):
        """The calls of an undisturbed run from a state."""
        if name not in self._calls:
            self.begin(name)
            self.victim.run(self._place, told=True)
            self._calls[name] = self.victim.calls.told()
        return self._calls[name]

    def find(self, name, call, path):
        """The first call whose name and path begin so: its number, the mask and number for `fail`."""
        for number, one, where in self.calls(name):
            if call in one and where.startswith(f"{self._place}/{path}"):
                return number, self.ways(name, number)[0][:2]
        raise LookupError(f"no {call} of {path}")

    def begin(self, name):
        """A folder as it is before a run, to be disturbed."""
        shutil.rmtree(self._place, ignore_errors=True)
        shutil.copytree(self.states[name].folder, self._place)
        return self._place

    def ways(self, name, number):
        """How a call may fail: a mask of what is counted, its number there, error, whether it stays."""
        _, call, _ = self.calls(name)[number - 1]
        if re.search("read", call):
            kinds = READS
        else:
            kinds = ALL & ~READS
        of_kind = sum(
            bool(re.search("read", one)) == (kinds == READS)
            for _, one, _ in self.calls(name)[:number]
        )
        is_write = re.search("write|fsync|rename|unlink|mkdir|truncate|open64|fopen", call)
        return [(kinds, of_kind, how, stays) for how, stays in (WRITING if is_write else ONCE)]

    def fail(self, name, number, kinds, at, how, stays):
        """Let one call fail; what was wrong afterwards."""
        _, call, path = self.calls(name)[number - 1]
        # what cannot be removed stays, until the next run
        may_be_left = stays or path.endswith("run.lock") or call == "unlink"
        state = self.states[name]
        self.begin(name)
        # an error of a full or read-only disk that stays is met by what changes something alone
        ended = self.ended = self.victim.run(
            self._place, at=at, how=how, kinds=kinds, then=CHANGES if stays else 0
        )  # fmt: skip
        now = contents(self._place)
        went_on = failed_tests(self._place)
        made_of = self._made_of(now) if went_on else None
        may_be_left |= ended.status == -signal.SIGSEGV
        wrong = faults(state, now, made_of=made_of, may_be_left=may_be_left)
        if not went_on and not is_in_order(mixture(state, now)):
            wrong.append(f"products are new in another order: {mixture(state, now)}")
        wrong += self._said(ended, how, path)
        if ended.status == 0 and (new := [k for k in state.after if now.get(k) != state.after[k]]):
            wrong.append(f"status 0, and not new: {new}")
        self.seen[f"status {ended.status}"] += 1
        wrong += self.mender.faults(state, self._place, now)
        return [f"{one}\n    {ended.said[:600]}" for one in wrong]

    def _made_of(self, now):
        """What tables and pages have to hold, made once for equal archives and messages."""
        archives = tuple((k, v) for k, v in now.items() if k.endswith((".nc", "status.csv")))
        if archives not in self._made:
            self._made[archives] = made_of_archives(self._place, self._scratch)
        return self._made[archives]

    def _said(self, ended, how, path):
        if ended.status == -signal.SIGSEGV and ".nc" in path:
            return []  # the netCDF library does not bear that a close fails: as if it were killed
        if ended.status not in STATUSES or ended.status == 1:
            return [f"status {ended.status}"]
        if "Traceback" in ended.said or "internal error" in ended.said:
            return ["a traceback"]
        if ended.status == 0:
            return []
        wrong = []
        # netCDF and HDF5 do not pass on what the system says
        is_hidden = ".nc" in path and re.search("NetCDF: .*HDF|Permission denied", ended.said)
        if how in WORDS and WORDS[how] not in ended.said and not is_hidden:
            wrong.append("the cause is not named")
        if not re.search(r"(processed|reports|raw)\b", ended.said):
            wrong.append("no file is named")
        return wrong

    def close(self):
        """End the process that forks."""
        self.victim.close()


def main():
    """Go over the calls of each state, and say what came of it; Ctrl-C ends it early."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--whole", action="store_true")
    parser.add_argument("--state", choices=STATES, action="append")
    parser.add_argument("--each", type=int, default=1, help="every so many-th call")
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--folder", type=Path)
    asked = parser.parse_args()
    n_wrong = 0
    with tempfile.TemporaryDirectory(dir=asked.folder) as folder:
        failures = Failures(Path(folder))
        with contextlib.suppress(KeyboardInterrupt):
            for name in asked.state or STATES:
                numbers = chosen(failures.calls(name), is_whole=asked.whole)
                for number in numbers[asked.first - 1 :: asked.each]:
                    ways = failures.ways(name, number)
                    for way in ways if asked.whole else [ways[number % len(ways)]]:
                        n_wrong += _tell(failures, name, number, way)
        failures.close()
    for what, count in sorted(failures.seen.items()):
        print(f"{count:6} {what}")  # noqa: T201
    print(f"{failures.mender.n_runs:6} states of the products that one more run mended")  # noqa: T201
    print(f"{n_wrong:6} faults")  # noqa: T201
    sys.exit(bool(n_wrong))


def chosen(calls, *, is_whole):
    """Numbers of calls; without ``is_whole`` no read of an archive."""
    return [number for number, name, _ in calls if is_whole or not name.startswith("pread")]


def _tell(failures, name, number, way):
    """Let a call fail; how much was wrong."""
    _, call, path = failures.calls(name)[number - 1]
    failures.seen[f"{name}: calls"] += 1
    wrong = failures.fail(name, number, *way)
    for one in wrong:
        where = re.sub(r".*?/(processed|reports|raw)", r"\1", path)
        print(f"{name} {number} {call} {where} {way[2:]}: {one}", flush=True)  # noqa: T201
    return len(wrong)


if __name__ == "__main__":
    main()
