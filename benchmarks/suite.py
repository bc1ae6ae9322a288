"""All benchmarks, one after another, as one Markdown table of what was measured in this run.

    python benchmarks/suite.py [--quick] [--only NAME ...]

Each benchmark is a program of its own; what it prints goes to standard error, and the table to
standard output.  A ratio is of two sides that ran in turn.  ``--quick`` takes small sizes, for
which nothing is wanted but of what does not depend on them; ``--only`` takes those that are named.
Generated logs lie in the folder BENCHMARK_DATA, or a temporary one.  What is not installed is said
and left out.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from statistics import median
from time import perf_counter

from figures import TARGET, Figure, figures_in
from machine import described, load, processors

HERE = Path(__file__).parent


@dataclass(frozen=True, kw_only=True)
class Benchmark:
    """A script, what it is told, and what in a quick run.

    ``is_sized`` says that what is wanted holds for the whole size alone.
    """

    name: str
    told: tuple[str, ...] = ()
    quick: tuple[str, ...] = ()
    is_sized: bool = True


BENCHMARKS = (
    Benchmark(name="reading_over_parse", quick=("200000", "2")),
    Benchmark(name="reduction_over_parse", quick=("200000", "2")),
    Benchmark(name="archive_cost", quick=("200000", "2")),
    Benchmark(name="report_page", quick=("200000", "1")),
    Benchmark(name="uncertainty_cost", quick=("200000", "2")),
    Benchmark(name="long_logs", quick=("100000", "1000000")),
    Benchmark(name="hysteresis_package", quick=("300", "400")),
    Benchmark(name="surfaces", quick=("1000",)),
    Benchmark(name="hose", quick=("1000", "200")),
    Benchmark(name="lookup", quick=("100000",)),
    Benchmark(name="spreadsheet", quick=("50000", "1")),
    Benchmark(name="lazy_reading", quick=("200000",)),
    Benchmark(name="catalogue", quick=("20",)),
    Benchmark(name="fixed_costs", quick=("--rounds", "1"), is_sized=False),
    Benchmark(name="batch", told=("20", "60", "240", "1000"), quick=("10",)),
)
NOT_IN_SUITE = {
    "suite": "this one",
    "figures": "what the others hand on",
    "machine": "the words at the top",
    "generate": "the logs that the others take",
    "programs": "what runs in processes of its own",
    "accuracy": "errors against a truth, not cost; docs/method.md",
    "coverage_strangers": "coverage of intervals, not cost; docs/uncertainty.md",
    "coverage_ropes": "coverage of intervals, not cost; docs/uncertainty.md",
    "coverage_surfaces": "coverage of intervals, not cost; docs/method.md",
    "coverage_tethers": "coverage of intervals, not cost; docs/uncertainty.md",
    "same_bytes": "products in other surroundings, not cost; docs/reproducing.md",
    "monte_carlo": "uncertainty against draws, not cost; docs/benchmarks.md",
    "hostile": "files that are refused; docs/robustness.md",
}
HEAD = "| benchmark | what | median (least to most) | ratio | wanted | |\n|---|---|---|---|---|---|"


def run(benchmark: Benchmark, *, is_quick: bool) -> tuple[Figure, ...]:
    """Run one to its end and take what it hands on, or a line that says what went wrong."""
    script = HERE / f"{benchmark.name}.py"
    if not script.exists():
        return (Figure(what=script.name, remark="failed: there is no such script"),)
    told = benchmark.quick if is_quick else benchmark.told
    with tempfile.TemporaryDirectory() as folder:
        target = Path(folder) / "figures.json"
        done = subprocess.run(
            [sys.executable, str(script), *told], env=os.environ | {TARGET: str(target)},
            stdout=sys.stderr, stderr=subprocess.PIPE, text=True, check=False,
        )  # fmt: skip
        sys.stderr.write(done.stderr)
        if done.returncode:
            last = (done.stderr.strip().splitlines() or ["it said nothing"])[-1]
            return (Figure(what=script.name, remark=f"failed: {last}"),)
        if not target.exists():
            return (Figure(what=script.name, remark="failed: it hands nothing on"),)
        return figures_in(target)


def number(value: float) -> str:
    """Three digits, or all before the point."""
    return f"{value:,.0f}" if abs(value) >= 100 else f"{value:#.3g}".rstrip(".")


def spread(values: tuple[float, ...]) -> str:
    """Median, and the range where there are several."""
    if len(values) < 2:
        return "".join(number(value) for value in values)
    return f"{number(median(values))} ({number(min(values))} to {number(max(values))})"


def row(name: str, figure: Figure, *, is_judged: bool) -> str:
    """One line of the table."""
    value = f"{spread(figure.values)} {figure.unit}".strip() if figure.values else figure.remark
    ratio = f"{spread(figure.ratios)} {figure.against}" if figure.ratios else ""
    verdict = {None: "not measured", True: "met", False: "**not met**"}[figure.is_met]
    if not is_judged:
        verdict = "not judged"
    if not figure.wanted:
        verdict = ""
    cells = (name, figure.what, value, ratio, figure.wanted, verdict)
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


def rows(
    chosen: tuple[Benchmark, ...], found: dict[str, tuple[Figure, ...]], *, is_quick: bool
) -> Iterator[str]:
    """Lines of all benchmarks, in order."""
    for benchmark in chosen:
        is_judged = not (is_quick and benchmark.is_sized)
        for figure in found[benchmark.name]:
            yield row(benchmark.name, figure, is_judged=is_judged)


def measured(chosen: tuple[Benchmark, ...], *, is_quick: bool) -> tuple[str, bool]:
    """Run them; the section of this run in Markdown, and whether every one came to its end."""
    begun, before = datetime.now(UTC), load()
    found, taken = {}, {}
    for benchmark in chosen:
        print(f"\n{benchmark.name}:", file=sys.stderr, flush=True)
        start = perf_counter()
        found[benchmark.name] = run(benchmark, is_quick=is_quick)
        taken[benchmark.name] = perf_counter() - start
    title = f"## {begun:%Y-%m-%d %H:%M} UTC" + (", quick" if is_quick else "")
    text = "\n".join([
        title, "",
        f"{described()}. Load {before} before, and {load()} after, with the benchmarks in it, on "
        f"{processors()} processors. "
        "Logs and loops are generated (synthetic)."
        + (" Small sizes: what is wanted of whole ones is not judged." if is_quick else ""),
        "", HEAD, *rows(chosen, found, is_quick=is_quick), "",
        "Seconds of each, with what it makes ready: "
        + ", ".join(f"{name} {seconds:.0f}" for name, seconds in taken.items()) + ".",
    ])  # fmt: skip
    is_whole = not any(
        figure.remark.startswith("failed") for figures in found.values() for figure in figures
    )
    return text, is_whole


def main() -> int:
    """Print the section of this run; 1 where a benchmark failed."""
    parser = argparse.ArgumentParser(description="Run the benchmarks one after another.")
    names = [one.name for one in BENCHMARKS]
    parser.add_argument("--quick", action="store_true", help="small sizes")
    parser.add_argument("--only", nargs="+", choices=names, metavar="NAME", help=", ".join(names))
    given = parser.parse_args()
    chosen = tuple(one for one in BENCHMARKS if given.only is None or one.name in given.only)
    text, is_whole = measured(chosen, is_quick=given.quick)
    print(text)
    return 0 if is_whole else 1


if __name__ == "__main__":
    sys.exit(main())
