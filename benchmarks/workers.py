"""Two workers of --jobs against two bare processes, on a campaign of many synthetic tests.

    python benchmarks/workers.py [TESTS] [ROWS] [REPEATS]

Each side reads, locates, reduces and archives all tests: one process; two processes that share
nothing and have half of the tests each; two workers.  Imports and the start
of the workers are excluded everywhere.  The sides run in turn, so that the ratios hold when the
machine's speed drifts.  Wanted: two workers reach at least 85 % of the ratio over one process
that two bare processes reach.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import time
from dataclasses import replace
from functools import partial
from pathlib import Path
from statistics import median

from figures import Figure, hand_on

from reduction.batch.campaign_status import Silent
from reduction.batch.reduce_tests import reduce_campaign
from reduction.batch.reuse import basis_of
from reduction.batch.run_lock import run_lock
from reduction.batch.survey import survey_campaign
from reduction.batch.test_history import earlier_tests_of, fit_strain_models
from reduction.batch.workers import Workers, local_workers
from reduction.campaign.load import load_campaign
from reduction.campaign.plan import Campaign

BARE = """
import sys, time
from pathlib import Path
sys.path.insert(0, sys.argv[1])
import workers
campaign = workers.part_of(Path(sys.argv[2]), int(sys.argv[3]), int(sys.argv[4]))
print("ready", flush=True)
sys.stdin.readline()
workers.reduce_all(campaign, Path(sys.argv[5]))
print("done", flush=True)
"""


def write_many(folder: Path, n_tests: int, n_rows: int) -> Path:
    """A campaign of synthetic logs that differ in their noise."""
    import numpy as np
    from generate import CAMPAIGN, columns, write_marks

    folder.mkdir(parents=True, exist_ok=True)
    text = CAMPAIGN.format(file="long.csv").partition("[tests.long]")[0]
    for number in range(n_tests):
        name = "long" if number == 0 else f"T{number:03}"
        table = columns(n_rows, seed=number + 1)
        np.savetxt(
            folder / f"{name}.csv", np.column_stack(list(table.values())), delimiter=",",
            fmt=["%.2f", "%.4f", "%.3f", "%.3f"], header=",".join(table), comments="",
        )  # fmt: skip
        text += f'[tests.{name}]\nfile = "{name}.csv"\norder = {number + 1}\n'
    marks = folder / "marks.csv"
    write_marks(marks)
    head, *lines = marks.read_text(encoding="utf-8").splitlines()
    # each half of the tests has marks of its own
    lines += [line.replace("long", "T001") for line in lines]
    marks.write_text("\n".join([head, *lines]) + "\n", encoding="utf-8")
    (folder / "campaign.toml").write_text(text, encoding="utf-8")
    return folder / "campaign.toml"


def part_of(path: Path, first: int, step: int) -> Campaign:
    """Every so many tests of the campaign, from one of them on."""
    campaign = load_campaign(path)
    names = list(campaign.tests)[first::step]
    return replace(campaign, tests={name: campaign.tests[name] for name in names})


def reduce_all(campaign: Campaign, folder: Path, workers: Workers | None = None) -> None:
    """Both passes over the tests, to their archives."""
    with run_lock(folder) as lock:
        first = survey_campaign(campaign, workers=workers, lock=lock)
        models, errors = fit_strain_models(campaign, first.surveys)
        statuses = reduce_campaign(
            campaign, first, first.surveys, errors=errors, folder=folder, workers=workers,
            basis=partial(
                basis_of, campaign, past=earlier_tests_of(first.surveys, models), pulls={}
            ),
            lock=lock, progress=Silent(), clock=time.perf_counter, force=True, command="benchmark",
        )  # fmt: skip
    bad = [one.message for one in statuses if one.status == "failed"]
    if bad:
        raise RuntimeError(bad[0])


def bare(path: Path, folder: Path, n_processes: int) -> float:
    """Wall time of processes that share nothing."""
    processes = [
        subprocess.Popen(
            [sys.executable, "-c", BARE, str(Path(__file__).parent), str(path), str(number),
             str(n_processes), str(folder / f"bare-{n_processes}-{number}")],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
        )
        for number in range(n_processes)
    ]  # fmt: skip
    for process in processes:
        process.stdout.readline()
    start = time.perf_counter()
    for process in processes:
        process.stdin.write("go\n")
        process.stdin.flush()
    for process in processes:
        if process.stdout.readline() != "done\n":
            raise RuntimeError("a process failed")
    taken = time.perf_counter() - start
    for process in processes:
        process.communicate()
    return taken


def with_workers(path: Path, folder: Path, n_workers: int) -> float:
    """Wall time of worker processes, which are there already."""
    campaign = load_campaign(path)
    few = replace(campaign, tests=dict(list(campaign.tests.items())[: 2 * n_workers]))
    with local_workers(n_workers) as workers:
        reduce_all(few, folder / "imports", workers)
        start = time.perf_counter()
        reduce_all(campaign, folder / f"workers-{n_workers}", workers)
        return time.perf_counter() - start


def main(n_tests: int, n_rows: int, repeats: int) -> list[Figure]:
    """Print the times and the ratios."""
    sys.path.insert(0, str(Path(__file__).parent))
    sides = {
        "one process": lambda path, folder: bare(path, folder, 1),
        "two bare processes": lambda path, folder: bare(path, folder, 2),
        "two workers": lambda path, folder: with_workers(path, folder, 2),
    }
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        path = write_many(folder / "raw", n_tests, n_rows)
        taken: dict[str, list[float]] = {side: [] for side in sides}
        for _ in range(repeats):
            for side, run in sides.items():
                taken[side].append(run(path, folder))
                print(f"{side}: {taken[side][-1]:.2f} s", file=sys.stderr, flush=True)
    print(f"{n_tests} synthetic tests of {n_rows} rows, {repeats} runs of each, seconds:\n")
    print("| | median | min | max | ratio over one process, run by run |\n|---|---|---|---|---|")
    ratios = {}
    for side, times in taken.items():
        ratios[side] = [one / own for one, own in zip(taken["one process"], times, strict=True)]
        listed = ", ".join(f"{ratio:.2f}" for ratio in ratios[side])
        print(f"| {side} | {median(times):.2f} | {min(times):.2f} | {max(times):.2f} | {listed} |")
    shares = [
        own / plain
        for own, plain in zip(ratios["two workers"], ratios["two bare processes"], strict=True)
    ]
    print(
        f"\nShare of the ratio of bare processes that workers reach: median {median(shares):.2f} "
        f"({min(shares):.2f} to {max(shares):.2f}); wanted at least 0.85."
    )
    tests = f"{n_tests} tests of {n_rows:,} rows"
    return [
        *(
            Figure(
                what=f"{tests}, {side}",
                values=tuple(times),
                against="times as fast as one process",
                ratios=tuple(ratios[side]),
            )
            for side, times in taken.items()
        ),
        Figure(
            what=f"{tests}, two workers",
            against="of the gain of two bare processes",
            ratios=tuple(shares),
            at_least=0.85,
        ),
    ]


if __name__ == "__main__":
    given = [int(one) for one in sys.argv[1:]]
    hand_on(main(*(given + [64, 6000, 3][len(given) :])))
