"""What a test of a large batch costs: reduction, archive, tables and page, by number of tests.

    python benchmarks/batch.py 20 60 240 1000 [--jobs 2] [--against REVISION]

A batch is of copies of the logs T-1, T-2, T-3, T-5 and T-6 of raw/tmt-synthetic (synthetic) under
new names, five to a pair of specimens.  Printed are, for each number of tests, processor seconds
(user and system, of all processes) and wall seconds per test of a first run, of a run with nothing
changed, and of a run with one log changed, with the largest memory of a process and of all
processes together.  With ``--against`` the same by another revision, batch by batch in turn.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from figures import Figure, hand_on
from programs import ROOT, package_of, usage_of

LOGS = ("T-1", "T-2", "T-3", "T-5", "T-6")


def write_batch(folder: Path, n_tests: int, tree: Path) -> Path:
    """Write the logs, the marks and campaign.toml of a batch, from the campaign of a revision."""
    folder.mkdir(parents=True)
    raw = tree / "raw" / "tmt-synthetic"
    text = (raw / "campaign.toml").read_text(encoding="utf-8")
    head = re.sub(r'id = "[^"]*"', 'id = "batch"', text.partition("[report]")[0], count=1)
    # tables of both specimens, which each pair has under names of its own
    general, _, sheets = head.partition("[specimens.new]")
    sheets, layouts, rest = ("[specimens.new]" + sheets).partition("[layouts.logger]")
    parts = [general]
    tests = []
    header, *rows = (raw / "marks.csv").read_text(encoding="utf-8").splitlines()
    marks = [header]
    for number in range(n_tests):
        log, pair = LOGS[number % len(LOGS)], number // len(LOGS) + 1
        name, new, used = f"B{number + 1:04}", f"new-{pair:03}", f"used-{pair:03}"
        if number % len(LOGS) == 0:
            own = sheets.replace("specimens.new", f"specimens.{new}")
            parts.append(own.replace("specimens.used", f"specimens.{used}"))
        shutil.copyfile(raw / f"{log}.csv", folder / f"{name}.csv")
        low, high = re.search(  # type: ignore[union-attr]
            rf"\[tests\.{log}\].*?target_strain = \[([\d.]+), ([\d.]+)\]", text, re.DOTALL
        ).groups()
        tests.append(
            f'[tests.{name}]\nfile = "{name}.csv"\norder = {number % len(LOGS) + 1}\n'
            f'specimens = ["{new}", "{used}"]\ntarget_strain = [{low}, {high}]\nn_cycles = 10\n'
        )
        for row in rows:
            test, specimen, rest_of_row = row.split(",", 2)
            if test == log:
                marks.append(f"{name},{new if specimen == 'new' else used},{rest_of_row}")
    defaults = text.partition("[defaults]")[2].partition("[tests.")[0]
    defaults = defaults.replace('specimens = ["new", "used"]\n', "")
    parts += [layouts, rest, "[defaults]", defaults, *tests]
    (folder / "campaign.toml").write_text("\n".join(parts), encoding="utf-8")
    (folder / "marks.csv").write_text("\n".join(marks) + "\n", encoding="utf-8")
    return folder / "campaign.toml"


def change_log(path: Path) -> None:
    """Move one reading in the middle of a log by its last digit."""
    lines = path.read_text(encoding="utf-8").splitlines()
    middle = len(lines) // 2
    cells = lines[middle].split(",")
    cells[-1] = f"{float(cells[-1]) + 0.01:.2f}"
    lines[middle] = ",".join(cells)
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def main(sizes: Sequence[int], jobs: int, revision: str) -> list[Figure]:
    """Print a row for each batch and run."""
    figures = []
    print("| tests | run | | processor s per test | wall s per test | MB, largest | MB, all |")
    print("|---|---|---|---|---|---|---|", flush=True)
    with tempfile.TemporaryDirectory() as scratch:
        trees = {"this": ROOT}
        if revision:
            trees[revision] = package_of(revision, Path(scratch) / "tree", "raw")
        for n_tests in sizes:
            folders = {side: Path(scratch) / f"{side}-{n_tests}" for side in trees}
            campaigns = {side: write_batch(folder / "raw", n_tests, trees[side]) for side, folder
                         in folders.items()}  # fmt: skip
            for what in ("first", "nothing changed", "one log changed"):
                seconds = {}
                for side, tree in trees.items():
                    if what == "one log changed":
                        change_log(campaigns[side].with_name("B0003.csv"))
                    used = usage_of(
                        [sys.executable, "-m", "reduction", "run", str(campaigns[side]),
                         "--quiet", "--jobs", str(jobs)],
                        cwd=folders[side], env=os.environ | {"PYTHONPATH": str(tree)},
                    )  # fmt: skip
                    seconds[side] = used.processor / n_tests
                    print(
                        f"| {n_tests} | {what} | {side} | {seconds[side]:.3f} "
                        f"| {used.wall / n_tests:.3f} | {used.largest_mb:.0f} "
                        f"| {used.together_mb:.0f} |",
                        flush=True,
                    )
                figures.append(
                    Figure(
                        what=f"{n_tests} tests, {what}, --jobs {jobs}, per test",
                        values=(seconds["this"],), against=f"of {revision}" if revision else "",
                        ratios=(seconds["this"] / seconds[revision],) if revision else (),
                    )
                )  # fmt: skip
            pages = sorted((folders["this"] / "reports").rglob("*.html"))
            listed = ", ".join(f"{one.name} {one.stat().st_size / 1e6:.1f}" for one in pages)
            print(f"\nPages [MB] of {n_tests} tests: {listed}\n", flush=True)
            for folder in folders.values():
                shutil.rmtree(folder)
    return figures


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("tests", nargs="*", type=int, default=[20, 60])
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--against", default="", metavar="REVISION")
    given = parser.parse_args()
    hand_on(main(given.tests, given.jobs, given.against))
