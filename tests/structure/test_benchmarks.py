"""One command runs every benchmark, judges what it measured, and says what it could not run."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
import suite
from figures import Figure

ROOT = Path(__file__).parents[2]
SCRIPTS = ROOT / "benchmarks"
IN_SUITE = [one.name for one in suite.BENCHMARKS]


def test_every_script_is_in_the_suite_or_said_not_to_be():
    scripts = sorted(path.stem for path in SCRIPTS.glob("*.py"))
    assert sorted([*IN_SUITE, *suite.NOT_IN_SUITE]) == scripts


@pytest.mark.parametrize("name", IN_SUITE)
def test_every_script_of_the_suite_hands_its_figures_on(name):
    text = (SCRIPTS / f"{name}.py").read_text(encoding="utf-8")
    assert "hand_on(" in text.partition('if __name__ == "__main__":')[2]


def test_every_script_of_the_suite_has_small_sizes():
    assert all(one.quick for one in suite.BENCHMARKS)


def test_the_cheapest_runs_and_gives_a_table():
    done = subprocess.run(
        [sys.executable, SCRIPTS / "suite.py", "--quick", "--only", "hose"],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    table = [line for line in done.stdout.splitlines() if line.startswith("| hose |")]
    assert len(table) == 2
    ratio = r"\| [\d.,]+ \([\d.,]+ to [\d.,]+\) times `np.sqrt` of the array \|"
    assert re.search(ratio, table[0])
    assert table[0].endswith("| at most 90 | not judged |")
    assert re.search(r"\d of \d+ processors usable, \d+ GiB", done.stdout)
    assert re.search(r"Load [\d.]+ before, and [\d.]+ after", done.stdout)
    # what the script itself prints stays out of the table
    assert "square roots" in done.stderr
    assert "square roots" not in done.stdout


@pytest.mark.parametrize(
    ("ratios", "limits", "wanted", "is_met"),
    [
        ((2.5, 2.0, 9.0), {"at_most": 2.5}, "at most 2.5", True),
        ((2.5, 2.6, 9.0), {"at_most": 2.5}, "at most 2.5", False),
        ((0.85,), {"at_least": 0.85}, "at least 0.85", True),
        ((0.84,), {"at_least": 0.85}, "at least 0.85", False),
        ((11.5,), {"at_least": 9, "at_most": 11}, "at least 9, at most 11", False),
        ((), {"at_most": 2.5}, "at most 2.5", None),
        ((1.0,), {}, "", None),
    ],
)
def test_a_verdict_is_of_the_median(ratios, limits, wanted, is_met):
    figure = Figure(what="one", values=(100.0,), ratios=ratios, **limits)
    assert figure.wanted == wanted
    assert figure.is_met is is_met
