"""Hold mutated campaigns against the invariant, and say what broke it.

    python tests/nightly_mutations.py 20000 --seed 7

Shares them among all formats, campaign.toml and the tables; ends with 1 where one broke it.
--kept FOLDER writes each of those as a campaign folder.  Several processes share the work with
--part 1/2 and --part 2/2.
"""

import argparse
import faulthandler
import sys
import time
import traceback
from collections import Counter
from pathlib import Path

from mutatedruns import hold
from mutations import strategies

LONGEST = 3600  # s without an end of one strategy: then it hangs where no signal reaches


def main():
    """Command line."""
    names = list(strategies())
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("n", type=int, help="mutated inputs of all parts together")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--part", default="1/1")
    parser.add_argument("--only", action="append", choices=names)
    parser.add_argument("--kept", type=Path)
    asked = parser.parse_args()
    part, parts = map(int, asked.part.split("/"))
    names, total = asked.only or names, Counter()

    def broken(mutation, error):
        total["written"] += 1
        print(f"BROKEN {mutation!r} ({mutation.expected}): {error}")
        if error.__cause__ is not None:
            last = traceback.extract_tb(error.__cause__.__traceback__)[-3:]
            print("".join(traceback.format_list(last)))
        if asked.kept is not None:
            folder = asked.kept / f"{mutation.case.name}-{asked.seed}-{part}-{total['written']}"
            folder.mkdir(parents=True)
            mutation.case.write(folder, mutation.files)

    for name in names[part - 1 :: parts]:
        faulthandler.dump_traceback_later(LONGEST, exit=True)
        start = time.monotonic()
        tally = hold(name, -(-asked.n // len(names)), seed=asked.seed, broken=broken)
        total += tally
        told = ", ".join(f"{n} {verdict}" for verdict, n in sorted(tally.items()))
        print(f"{name}: {told}; {time.monotonic() - start:.0f} s", flush=True)
    print(
        f"{total.total() - total['written']} mutated inputs, {total['broken']} broke the invariant"
    )
    return 1 if total["broken"] else 0


if __name__ == "__main__":
    sys.exit(main())
