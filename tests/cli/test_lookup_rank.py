"""Lines in order at one load: the choice of sec. 3.2 and Figure 4 of CG-D-39-80."""

import json

import pytest

from reduction.lines.line_rank import rank_lines
from reduction.lines.published_source import published_sources
from reduction.record.errors import DataError

LBF = 4.4482216152605
ASKED = (
    "lookup", "published", "--rank", "--material", "nylon", "--construction", "double braid",
    "--condition", "new", "--quantity", "K_ap", "--mean-tension", "4000 lbf",
    "--tension-amplitude", "1600 lbf",
)  # fmt: skip


def name(size):
    return f"nylon-double-braid-{size}in-new"


def test_the_diameters_of_figure_4_with_ties_and_the_erratum(command):
    done = command(*ASKED, "--frequency", "0.3 Hz", "--json")
    assert done.returncode == 0, done.stderr
    answer = json.loads(done.stdout)
    ranked = answer["ranked"]
    assert [one["line"] for one in ranked] == [name(size) for size in ("1", "0.75", "1.25")]
    # Table 3 by hand, 1e4 lbf: reference audit of the report
    found = [one["value"] / LBF / 1e4 for one in ranked]
    assert found == pytest.approx([11.4, 11.9, 17.7], abs=0.05)
    assert [one["ties"] for one in ranked] == [[name("0.75")], [name("1")], []]
    for one in ranked:
        for other in ranked:
            if one is not other:
                overlap = (
                    one["interval"][0] <= other["interval"][1]
                    and other["interval"][0] <= one["interval"][1]
                )
                assert overlap == (other["line"] in one["ties"])
    assert answer["errata"] == ["CG-62"]
    assert [one["inside"] for one in ranked] == [False, True, False]
    # 88 % of 6,400 lb: the half-inch line is no choice
    assert answer["left_out"].keys() == {name("0.5")}
    assert "88 % of its break strength" in answer["left_out"][name("0.5")]


def test_what_has_to_be_read_before_a_value_stands_above_the_ranks(command):
    """K_ap of the 1 1/4 in line is printed above K_0 + K_1: the look-up of the line warns of it."""
    load = (
        "--frequency",
        "0.3 Hz",
        "--mean-tension",
        "4000 lbf",
        "--tension-amplitude",
        "1600 lbf",
    )
    kind = ("--material", "nylon", "--construction", "double braid", "--condition", "new")
    done = command("lookup", "published", *kind, "--quantity", "K_ap", "--rank", *load)
    first = done.stdout.split("\n")[0]
    assert first.startswith("warning of nylon-double-braid-1.25in-new: the printed numbers are")


def test_the_screen_says_what_is_below_the_tested_amplitudes(command):
    done = command(*ASKED, "--frequency", "0.1 Hz", "--units", "us")
    assert done.returncode == 0, done.stderr
    rows = {
        size: next(row for row in done.stdout.splitlines() if f" {name(size)}" in row)
        for size in ("1", "0.75", "1.25")
    }
    for size in ("1", "1.25"):
        assert (
            "tension amplitude 1,600 lbf, below 1,680 lbf, the lowest that was tested" in rows[size]
        )
    assert "tested from" not in rows["0.75"]
    assert rows["1"].startswith("1=") and rows["1.25"].startswith("3 ")
    assert "erratum CG-62" in done.stdout


def test_a_line_that_is_far_outside_has_no_place_unless_it_is_asked_for():
    lines = [published_sources()[name(size)] for size in ("0.75", "1", "1.25")]
    at = {"frequency": 0.3, "mean_tension": 4000 * LBF, "tension_amplitude": 1200 * LBF}
    with pytest.raises(DataError, match="fewer than two lines"):
        rank_lines(lines, "apparent_spring_constant", [at] * 3)
    found = rank_lines(lines, "apparent_spring_constant", [at] * 3, extrapolate="flag")
    assert len(found.ranked) == 3
    # the text orders diameters by K_ap alone
    energy = rank_lines(lines, "hysteresis_energy", [at] * 3, extrapolate="flag")
    assert energy.errata == ()


def test_one_way_to_put_lines_together(command):
    done = command(*ASKED, "--frequency", "0.3 Hz", "--against", name("1"))
    assert done.returncode == 2
    assert "only one option" in done.stderr
