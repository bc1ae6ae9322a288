"""What the archive of a long log costs, by default and with every sample, over parsing the log.

    python benchmarks/archive_cost.py [ROWS] [REPEATS]

Three programs run in turn, A B C A B C ..., each in a process of its own, so that a ratio holds
when the machine's speed drifts: `pandas.read_csv` of the log; the reduction, hashing included, with
the archive as it is by default; the same with every sample in it. Programs are imported before the
clock starts. The log is generated (synthetic) in the folder BENCHMARK_DATA, or a temporary one.
"""

from __future__ import annotations

import os
from pathlib import Path
from statistics import median

from figures import Figure, hand_on
from programs import PARSE, REDUCE, run, seconds_of, sizes, synthetic_log

WANTED = 5.0  # times parsing, with the default archive
STORE = f"""
import netCDF4, xarray
from reduction.archive.test_dataset import to_dataset
from reduction.archive.test_dataset import kept_samples
from reduction.archive.write import write_archive
{REDUCE}
kept = kept_samples(test, survey.plan.settings)
archive = Path(sys.argv[2])
write_archive(to_dataset(test, version="0", command="benchmark", kept=kept), archive)
done = time.perf_counter()
say(seconds=done - start, archive=done - reduced, cycles=test.cycles.n_cycles,
    stored=test.record.n_samples if kept is None else kept.index.size, size=archive.stat().st_size)
"""


def keeping_all(campaign: Path) -> Path:
    """Write the campaign again, with every sample of its test in the archive."""
    whole = campaign.with_name(campaign.name.replace("campaign", "whole"))
    # the last table is the test
    whole.write_text(
        campaign.read_text(encoding="utf-8") + 'reduction.archive.test_dataset = "all"\n',
        encoding="utf-8",
    )
    return whole


def main(n_rows: int, repeats: int) -> list[Figure]:
    """Print a Markdown table of the three and their ratios."""
    campaign, log = synthetic_log(n_rows)
    whole, archive = keeping_all(campaign), log.with_name("archive.nc")
    turns = [
        (run(PARSE, log), run(STORE, campaign, archive), run(STORE, whole, archive))
        for _ in range(repeats + 1)
    ][1:]
    archive.unlink()
    print(
        f"{n_rows} rows, {log.stat().st_size / 1e6:.0f} MB, {turns[0][1]['cycles']} cycles, "
        f"{len(os.sched_getaffinity(0))} processors, {repeats} turns after one warm-up\n"
    )
    print("| | s (min to max) | over parsing | archive alone | over parsing | MB on disk | samples "
          "| peak MB |\n|---|---|---|---|---|---|---|---|")  # fmt: skip
    for name, place in (("parsing alone", 0), ("default archive", 1), ("whole record", 2)):
        own = [turn[place] for turn in turns]
        seconds = sorted(one["seconds"] for one in own)
        cells = [name, f"{median(seconds):.2f} ({seconds[0]:.2f} to {seconds[-1]:.2f})"]
        for key in ("seconds", "archive"):
            if place:
                ratio = median(turn[place][key] / turn[0]["seconds"] for turn in turns)
                cells += [f"{median(one[key] for one in own):.2f}"] * (key == "archive")
                cells.append(f"{ratio:.1f}")
            else:
                cells += [""] * (1 + (key == "archive"))
        cells += [f"{own[0]['size'] / 1e6:.1f}", f"{own[0]['stored']}"] if place else ["", ""]
        cells.append(f"{max(one['peak_mb'] for one in own):.0f}")
        print(f"| {' | '.join(cells)} |")
    found = []
    for name, place in (("default archive", 1), ("whole record in the archive", 2)):
        own = [turn[place] for turn in turns]
        found += [
            Figure(
                what=f"reduction of {n_rows:,} rows, {name}",
                values=seconds_of(own),
                against="times `pandas.read_csv`",
                ratios=tuple(turn[place]["seconds"] / turn[0]["seconds"] for turn in turns),
                at_most=WANTED if place == 1 else None,
            ),
            Figure(
                what=f"its {name} alone",
                values=seconds_of(own, "archive"),
                against="times `pandas.read_csv`",
                ratios=tuple(turn[place]["archive"] / turn[0]["seconds"] for turn in turns),
            ),
            Figure(
                what=f"its peak memory, {name}",
                unit="MB",
                values=tuple(one["peak_mb"] for one in own),
            ),
        ]
    return found


if __name__ == "__main__":
    hand_on(main(*sizes()))
