"""Kill a run at random moments: ``PYTHONPATH=tests python -m faults.kills 300``.

Half of the moments are spread over the time of a run, half over its calls on files: before the call,
after it, or with half of the bytes written.
"""

import argparse
import contextlib
import os
import random
import shutil
import signal
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

from faults.calls import AFTER, ALL, BEFORE, TORN, mask
from faults.harness import (
    STATES,
    Mender,
    Victim,
    contents,
    faults,
    is_in_order,
    make_states,
    mixture,
)

# most calls read an archive that was just written, of which nothing is seen from outside
COUNTED = ALL & ~mask("read")


class Kills:
    """Runs that are killed, one after the other."""

    def __init__(self, folder, seed, *, is_verified=True):
        """Make the states."""
        self.victim = Victim(folder / "victim")
        self.states = make_states(self.victim, folder / "states")
        self.mender = Mender(self.victim, is_verified=is_verified)
        self.seen = Counter()
        self._random = random.Random(seed)  # noqa: S311 - moments, not secrets
        self._place = folder / "killed"
        self._measures = {}

    def _begin(self, state):
        shutil.rmtree(self._place, ignore_errors=True)
        shutil.copytree(state.folder, self._place)

    def _measured(self, name):
        """Calls and seconds of an undisturbed run from a state."""
        if name not in self._measures:
            self._begin(self.states[name])
            start = time.monotonic()
            n_calls = self.victim.run(self._place, kinds=COUNTED).n_calls
            self._measures[name] = n_calls, time.monotonic() - start
        return self._measures[name]

    def kill(self, name, *, by_time, number=signal.SIGKILL):
        """Kill one run from a state, or ask it to end; what was wrong afterwards."""
        state = self.states[name]
        n_calls, seconds = self._measured(name)
        self._begin(state)
        if by_time:
            moment = self._random.uniform(0, 1.05 * seconds)

            def meanwhile(process):
                time.sleep(moment)
                # where the run was quicker there is nobody to kill
                with contextlib.suppress(ProcessLookupError):
                    os.kill(process, number)

            ended = self.victim.run(self._place, meanwhile=meanwhile)
            how = f"after {moment:.3f} s"
        else:
            at = self._random.randint(1, n_calls)
            kind = self._random.choice((BEFORE, AFTER, TORN))
            ended = self.victim.run(self._place, at=at, how=kind, kinds=COUNTED)
            how = f"at call {at} ({kind})"
        now = contents(self._place)
        layers = mixture(state, now)
        # before the command heeds a request to end, the system does
        killed = ended.status in (-number, *([130] if number != signal.SIGKILL else []))
        self.seen["killed" if killed else "ended before"] += 1
        self.seen[f"{name}: {' '.join(map(str, layers))}"] += killed
        wrong = faults(state, now, may_be_left=killed and number == signal.SIGKILL)
        if not is_in_order(layers):
            wrong.append(f"products are new in another order: {layers}")
        if not killed and ended.status != 0:
            wrong.append(f"status {ended.status}: {ended.said}")
        wrong += self.mender.faults(state, self._place, now)
        return [f"{name}, killed {how}: {one}" for one in wrong]

    def close(self):
        """End the process that forks."""
        self.victim.close()


def main():
    """Kill so many runs, and say what came of it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("number", type=int)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--folder", type=Path)
    parser.add_argument("--signal", choices=("SIGKILL", "SIGINT", "SIGTERM"), default="SIGKILL")
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory(dir=asked.folder) as folder:
        # one that is asked to end gives the lock back, and of pages verify says nothing
        kills = Kills(Path(folder), asked.seed, is_verified=asked.signal == "SIGKILL")
        wrong = []
        for number in range(asked.number):
            by_time = number // 3 % 2 == 0 or asked.signal != "SIGKILL"
            found = kills.kill(
                STATES[number % len(STATES)], by_time=by_time, number=signal.Signals[asked.signal]
            )
            wrong += found
            for one in found:
                print(one, flush=True)  # noqa: T201
        kills.close()
    for what, count in sorted(kills.seen.items()):
        print(f"{count:5} {what}")  # noqa: T201
    print(f"{kills.mender.n_runs:5} states of the products that one more run mended")  # noqa: T201
    print(f"{len(wrong):5} faults")  # noqa: T201
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
