"""One command runs every benchmark, judges what it measured, and says what it could not run."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
import figures
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


def test_figures_are_the_same_after_they_were_handed_on(tmp_path, monkeypatch):
    given = (
        Figure(what="one", values=(1.0, 2.5), against="times two", ratios=(0.5,), at_most=5),
        Figure(what="two", remark="not installed"),
    )
    monkeypatch.setenv(figures.TARGET, str(tmp_path / "handed.json"))
    figures.hand_on(given)
    assert figures.figures_in(tmp_path / "handed.json") == given


def test_figures_that_nobody_wants_go_nowhere(tmp_path, monkeypatch):
    monkeypatch.delenv(figures.TARGET, raising=False)
    monkeypatch.chdir(tmp_path)
    figures.hand_on([Figure(what="one", values=(1.0,))])
    assert not list(tmp_path.iterdir())


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


def test_a_value_is_judged_where_it_is_what_is_wanted():
    figure = Figure(what="a", unit="MB", values=(700.0,), ratios=(1.0,), at_most=600, of="value")
    assert figure.wanted == "at most 600 MB"
    assert figure.is_met is False
    counted = Figure(what="a", unit="", values=(6000,), at_least=6000, at_most=6000, of="value")
    assert (counted.wanted, counted.is_met) == ("6000", True)


def test_a_line_says_what_was_measured_and_whether_it_is_met():
    figure = Figure(
        what="a", values=(1.0, 3.0, 2.0), against="times b", ratios=(2.0, 4.0, 1234.5), at_most=3
    )
    expected = "| x | a | 2.00 (1.00 to 3.00) s | 4.00 (2.00 to 1,234) times b | at most 3 |"
    assert suite.row("x", figure, is_judged=True) == f"{expected} **not met** |"
    assert suite.row("x", figure, is_judged=False) == f"{expected} not judged |"
    missing = Figure(what="R", remark="not installed", at_most=3)
    assert suite.row("x", missing, is_judged=True) == (
        "| x | R | not installed |  | at most 3 | not measured |"
    )


@pytest.mark.parametrize(
    ("script", "remark"),
    [
        ("raise SystemExit('no such thing')", "failed: no such thing"),
        ("raise SystemExit(3)", "failed: it said nothing"),
        ("print('all is well')", "failed: it hands nothing on"),
        (None, "failed: there is no such script"),
    ],
)
def test_a_benchmark_that_fails_is_a_line_and_the_others_run(
    script, remark, tmp_path, monkeypatch, capfd
):
    monkeypatch.setattr(suite, "HERE", tmp_path)
    if script is not None:
        (tmp_path / "bad.py").write_text(script, encoding="utf-8")
    (tmp_path / "good.py").write_text(
        f"import os\nopen(os.environ['{figures.TARGET}'], 'w').write('[{{\"what\": \"a\"}}]')",
        encoding="utf-8",
    )
    both = tuple(suite.Benchmark(name=name) for name in ("bad", "good"))
    text, is_whole = suite.measured(both, is_quick=False)
    assert not is_whole
    assert f"| bad | bad.py | {remark} |" in text
    assert "| good | a |" in text


def test_the_table_is_printed_and_a_failure_is_the_exit_status(monkeypatch, capfd):
    monkeypatch.setattr(suite, "measured", lambda chosen, *, is_quick: (f"## {len(chosen)}", True))
    monkeypatch.setattr(sys, "argv", ["suite.py", "--only", "hose", "lookup"])
    assert suite.main() == 0
    assert capfd.readouterr().out == "## 2\n"
    monkeypatch.setattr(suite, "measured", lambda chosen, *, is_quick: ("## bad", False))
    monkeypatch.setattr(sys, "argv", ["suite.py"])
    assert suite.main() == 1
