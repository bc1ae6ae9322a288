"""Time of reading and hashing a log over `pandas.read_csv` of the same file.

    python benchmarks/reading_over_parse.py [ROWS] [REPEATS]

The two run in turn, A B A B ..., each in a process of its own.  Reading is everything up to the
declared columns in the file's own units: the hash, the look for odd characters, and the check that
the file did not change meanwhile.  The log is that of `reduction_over_parse.py` (synthetic).
"""

from __future__ import annotations

from figures import Figure, hand_on
from programs import PARSE, print_sides, run, seconds_of, sizes, synthetic_log

READ = """
from reduction.campaign.load import load_campaign
from reduction.readers.read_log import read_log
campaign = load_campaign(Path(sys.argv[1]))
(name, layout), = campaign.tests["long"].files
start = time.perf_counter()
log = read_log(campaign.file(name), campaign.layouts[layout], name=name)
say(seconds=time.perf_counter() - start, rows=log.n_rows_read)
"""


def main(n_rows: int, repeats: int) -> list[Figure]:
    """Print a Markdown table of both sides and their ratio."""
    campaign, log = synthetic_log(n_rows)
    pairs = [(run(READ, campaign), run(PARSE, log)) for _ in range(repeats + 1)][1:]
    if any(one["rows"] != n_rows for pair in pairs for one in pair):
        raise SystemExit(f"not {n_rows} rows: {pairs}")
    ours, theirs = zip(*pairs, strict=True)
    print(f"{n_rows} rows, {log.stat().st_size / 1e6:.0f} MB, {repeats} pairs after one warm-up")
    ratios = print_sides({"reading alone, hashing included": ours, "pandas.read_csv": theirs})
    return [
        Figure(what=f"pandas.read_csv, {n_rows:,} rows", values=seconds_of(theirs)),
        Figure(
            what="reading alone, hashing included",
            values=seconds_of(ours),
            against="times `pandas.read_csv`",
            ratios=ratios,
        ),
    ]


if __name__ == "__main__":
    hand_on(main(*sizes()))
