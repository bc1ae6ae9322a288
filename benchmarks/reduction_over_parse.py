"""Time of the whole reduction without archive over `pandas.read_csv` of the same file.

    python benchmarks/reduction_over_parse.py [ROWS] [REPEATS] [memory | disk]

Columns lie where a run puts them, in memory up to 64 MB of text and else on disk, or where asked.
The two run in turn, A B A B ..., each in a process of its own, so that the ratio holds when
the machine's speed drifts; hashing of the raw file is part of the reduction.  The file
is generated (synthetic) in the folder BENCHMARK_DATA, or a temporary one.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median

from figures import Figure, hand_on

HERE = Path(__file__).parent
WANTED, MOST_MB = 2.5, 1500.0  # times parsing; peak memory
PARSE = """
import time, json, resource, sys
import pandas
start = time.perf_counter()
table = pandas.read_csv(sys.argv[1])
print(json.dumps({"seconds": time.perf_counter() - start, "rows": len(table),
    "peak_mb": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024}))
"""
REDUCE = """
import time, json, resource, sys
from pathlib import Path
from reduction.batch.models import fit_strain_models
from reduction.batch.reduce import reduce_survey
from reduction.batch.survey import survey_log
from reduction.campaign.load import load_campaign
from reduction.ingest.parts import Parts
if sys.argv[2] != "usual":
    Parts.folder_of = lambda self, n_bytes: {"memory": None, "disk": self.folder}[sys.argv[2]]
campaign = load_campaign(Path(sys.argv[1]))
start = time.perf_counter()
[survey] = survey_log(campaign, "long")
if survey.error is not None:
    raise survey.error
located = time.perf_counter()
models, errors = fit_strain_models(campaign, [survey])
of_test = [models[survey.plan.id, name] for name in survey.plan.specimens]
test = reduce_survey(campaign, survey, of_test, None, "{}")
print(json.dumps({"seconds": time.perf_counter() - start, "located": located - start,
    "cycles": test.cycles.n_cycles,
    "peak_mb": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024}))
"""


def run(code: str, file: Path, where: str = "") -> dict[str, float]:
    """Run one side in a process of its own."""
    done = subprocess.run(
        [sys.executable, "-c", code, str(file), where], capture_output=True, text=True, check=True
    )
    return dict(json.loads(done.stdout))


def main(n_rows: int, repeats: int, where: str = "usual") -> list[Figure]:
    """Print a Markdown table of both sides and their ratio."""
    sys.path.insert(0, str(HERE))
    from generate import write_campaign

    folder = Path(os.environ.get("BENCHMARK_DATA", tempfile.gettempdir())) / "reduction-benchmark"
    campaign = write_campaign(folder, n_rows=n_rows)
    log = folder / f"long_{n_rows}.csv"
    pairs = [(run(REDUCE, campaign, where), run(PARSE, log)) for _ in range(repeats + 1)][1:]
    ratios = [ours["seconds"] / theirs["seconds"] for ours, theirs in pairs]
    print(
        f"{n_rows} rows, {log.stat().st_size / 1e6:.0f} MB, {pairs[0][0]['cycles']} cycles, "
        f"{os.cpu_count()} processors, {repeats} pairs after one warm-up"
        + (f", columns {'on' if where == 'disk' else 'in'} {where}" if where != "usual" else "")
    )
    print("| | median s | min | max | peak MB |\n|---|---|---|---|---|")
    for name, side in (("reduction, hashing included", 0), ("pandas.read_csv", 1)):
        seconds = sorted(pair[side]["seconds"] for pair in pairs)
        peak = max(pair[side]["peak_mb"] for pair in pairs)
        print(
            f"| {name} | {median(seconds):.2f} | {seconds[0]:.2f} | {seconds[-1]:.2f} "
            f"| {peak:.0f} |"
        )
    print(f"| ratio | {median(ratios):.2f} | {min(ratios):.2f} | {max(ratios):.2f} | |")
    return [
        Figure(
            what=f"reduction of {n_rows:,} rows, no archive",
            values=tuple(ours["seconds"] for ours, _ in pairs),
            against="times `pandas.read_csv`",
            ratios=tuple(ratios),
            at_most=WANTED,
        ),
        Figure(
            what="its peak memory",
            unit="MB",
            values=tuple(ours["peak_mb"] for ours, _ in pairs),
            at_most=MOST_MB,
            of="value",
        ),
    ]


if __name__ == "__main__":
    hand_on(
        main(
            int(sys.argv[1]) if len(sys.argv) > 1 else 5_760_000,
            int(sys.argv[2]) if len(sys.argv) > 2 else 3,
            *sys.argv[3:],
        )
    )
