"""Time of the report page over `pandas.read_csv` of the log that it shows.

    python benchmarks/report_page.py [ROWS] [REPEATS]

The log of `reduction_over_parse.py` (synthetic) is reduced once, with the archive as it is by
default; then page and parsing run in turn, each in a process of its own, programs imported before
the clock starts.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

from figures import Figure, hand_on
from programs import PARSE, print_sides, run, seconds_of, sizes, synthetic_log

PAGE = """
import netCDF4, xarray
from reduction.report.campaign_page import write_report
folder = Path(sys.argv[1])
start = time.perf_counter()
page = write_report(folder, folder / "report")
say(seconds=time.perf_counter() - start, size=page.stat().st_size)
"""


def main(n_rows: int, repeats: int) -> list[Figure]:
    """Print a Markdown table of both sides and their ratio."""
    campaign, log = synthetic_log(n_rows)
    with tempfile.TemporaryDirectory() as place:
        command = [sys.executable, "-m", "reduction", "run", str(campaign), "--quiet"]
        places = ["--processed", f"{place}/processed", "--reports", f"{place}/reports"]
        subprocess.run([*command, *places], check=True, stdout=subprocess.DEVNULL)
        processed = Path(place) / "processed" / "benchmark"
        pairs = [(run(PAGE, processed), run(PARSE, log)) for _ in range(repeats + 1)][1:]
    ours, theirs = zip(*pairs, strict=True)
    print(f"{n_rows} rows, page of {ours[0]['size'] / 1e6:.1f} MB, {repeats} pairs after a warm-up")
    ratios = print_sides({"report page": ours, "pandas.read_csv": theirs})
    return [
        Figure(
            what=f"report page of a log of {n_rows:,} rows, from its archive",
            values=seconds_of(ours),
            against="times `pandas.read_csv`",
            ratios=ratios,
        )
    ]


if __name__ == "__main__":
    hand_on(main(*sizes()))
