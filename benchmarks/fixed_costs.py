"""Processor time of the commands that people wait for, as ratios to other revisions.

    python benchmarks/fixed_costs.py --against REVISION [REVISION ...] [--rounds 3] [--only NAME]

Each revision is taken from the repository into a temporary folder and run there by this same
interpreter, in turn with the working tree, so that a machine that slows down slows all of them.
Processor time is user and system time of the command and of all processes that it started.  A
ratio is of the two runs of one round; printed are the median of the rounds and their range.  The
campaigns are those of raw/ of each revision (synthetic, but for the one of 17 rows): the same logs,
and a campaign.toml with the keys that it knows.
"""

from __future__ import annotations

import argparse
import os
import shutil
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from statistics import median

from figures import Figure, hand_on
from programs import ROOT, package_of, usage_of


def _run(campaign: str) -> list[str]:
    return ["run", f"raw/{campaign}/campaign.toml"]


# command, what is taken away before it, and the ratio that is wanted to revision 4ef6a00
COMMANDS: dict[str, tuple[list[str], str, float | None]] = {
    "tmt-synthetic": (_run("tmt-synthetic"), "processed/tmt-synthetic", 0.30),
    "tmt-synthetic, nothing changed": (_run("tmt-synthetic"), "", 0.16),
    "nylon-synthetic": (_run("nylon-synthetic"), "processed/nylon-synthetic", 0.30),
    "hose-synthetic": (_run("hose-synthetic"), "processed/hose-synthetic", 0.40),
    "one test of 17 rows": (
        _run("buoy-technology-1997"), "processed/buoy-technology-1997", 0.50,
    ),
    "look-up of a published line": (
        ["lookup", "rubber-tether-new-T-5", "--quantity", "tangent_modulus", "--strain", "200 %",
         "--branch", "ascending"], "", 0.25,
    ),
    "--help": (["--help"], "", None),
}  # fmt: skip


def _trees(scratch: Path, revisions: Sequence[str]) -> Iterator[tuple[str, Path, Path]]:
    """Name of each side, where its package lies, and a working folder of its own."""
    for name in ("this", *revisions):
        source, work = ROOT, scratch / f"work-{name}"
        if name != "this":
            source = package_of(name, scratch / f"tree-{name}", "raw")
        work.mkdir()
        shutil.copytree(source / "raw", work / "raw")
        yield name, source, work


def main(revisions: Sequence[str], rounds: int, only: Sequence[str]) -> list[Figure]:
    """Print a Markdown table: seconds of the working tree, and its ratio to each revision."""
    chosen = {name: one for name, one in COMMANDS.items() if not only or name in only}
    taken: dict[tuple[str, str], list[float]] = {}
    with tempfile.TemporaryDirectory() as folder:
        sides = list(_trees(Path(folder), revisions))
        # as installed, with its modules compiled once, whatever this shell says
        compiled = {"PYTHONDONTWRITEBYTECODE": "", "PYTHONPYCACHEPREFIX": f"{folder}/compiled"}
        for number in range(rounds + 1):  # the first compiles what is imported
            for what, (arguments, anew, _wanted) in chosen.items():
                for name, source, work in sides:
                    if anew:
                        shutil.rmtree(work / anew, ignore_errors=True)
                    used = usage_of(
                        [sys.executable, "-m", "reduction", *arguments], cwd=work,
                        env=os.environ | compiled | {"PYTHONPATH": str(source)},
                    )  # fmt: skip
                    if number:
                        taken.setdefault((what, name), []).append(used.processor)
    print("| processor time | this, s |" + "".join(f" ratio to {one} |" for one in revisions))
    print("|---|---|" + "---|" * len(revisions))
    figures = []
    for what, (_arguments, _anew, wanted) in chosen.items():
        own = taken[what, "this"]
        cells = []
        for revision in revisions:
            ratios = [a / b for a, b in zip(own, taken[what, revision], strict=True)]
            cells.append(f" {median(ratios):.2f} ({min(ratios):.2f} to {max(ratios):.2f}) |")
            figures.append(
                Figure(
                    what=what, values=tuple(own), against=f"of {revision}", ratios=tuple(ratios),
                    at_most=wanted if revision == "4ef6a00" else None,
                )
            )  # fmt: skip
        print(f"| {what} | {median(own):.2f} ({min(own):.2f} to {max(own):.2f}) |{''.join(cells)}")
    return figures


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--against", nargs="+", default=["4ef6a00"], metavar="REVISION")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--only", nargs="+", default=[], choices=list(COMMANDS), metavar="NAME")
    given = parser.parse_args()
    hand_on(main(given.against, given.rounds, given.only))
