"""CG-D-39-80, Tables 1 and 2: levels of every line in pounds; the loads of the fifteen runs."""

import numpy as np
import pytest

from reduction.experiments.designs import FactorLevels, box_behnken, engineering_levels
from reduction.experiments.run_sheet import find_cautions, make_run_sheet

LOW_TO_HIGH = {"1/2, 3/4": (0.12, 0.30, 0.05, 0.12), "1, 1 1/4": (0.10, 0.22, 0.05, 0.10)}


def factors(levels):
    low, high, amplitude_low, amplitude_high = LOW_TO_HIGH[levels]
    return (
        FactorLevels("frequency", 0.1, 0.5),
        FactorLevels("mean_tension", low, high, "rated_break_strength"),
        FactorLevels("tension_amplitude", amplitude_low, amplitude_high, "rated_break_strength"),
    )


# Rated break strength [lb]; mean and amplitude at -1, 0, +1 [lb].  The ends are printed with
# Tables 3 to 19 (rounded there to the pound); the centres follow from Tables 1 and 2.
LINES = {
    "nylon double braid 1/2": ("1/2, 3/4", 6400, (768, 1344, 1920), (320, 544, 768)),
    "nylon 8-strand 1/2": ("1/2, 3/4", 5760, (691.2, 1209.6, 1728), (288, 489.6, 691.2)),
    "polyester 8-strand 1/2": ("1/2, 3/4", 6600, (792, 1386, 1980), (330, 561, 792)),
    "polyester double braid 1/2": ("1/2, 3/4", 7000, (840, 1470, 2100), (350, 595, 840)),
    "nylon double braid 3/4": ("1/2, 3/4", 19100, (2292, 4011, 5730), (955, 1623.5, 2292)),
    "nylon double braid 1 and 1 1/4": ("1, 1 1/4", 33600, (3360, 5376, 7392), (1680, 2520, 3360)),
}


@pytest.mark.parametrize("line", LINES)
def test_levels_of_a_line_in_pounds(line):
    levels, strength, mean, amplitude = LINES[line]
    coded = np.repeat([[-1.0], [0.0], [1.0]], 3, axis=1)
    found = engineering_levels(coded, factors(levels), rated_break_strength=strength)
    np.testing.assert_allclose(found[:, 0], [0.1, 0.3, 0.5], rtol=1e-12)
    np.testing.assert_allclose(found[:, 1], mean, rtol=1e-12)
    np.testing.assert_allclose(found[:, 2], amplitude, rtol=1e-12)


# (mean, amplitude), frequencies, peak and minimum [%] for both sets of levels, by rising peak
BLOCKS = [
    ((-1, -1), [0], (17, 7), (15, 5)),
    ((-1, 0), [-1, 1], (20.5, 3.5), (17.5, 2.5)),
    ((-1, 1), [0], (24, 0), (20, 0)),
    ((0, -1), [-1, 1], (26, 16), (21, 11)),
    ((0, 0), [0, 0, 0], (29.5, 12.5), (23.5, 8.5)),
    ((0, 1), [-1, 1], (33, 9), (26, 6)),
    ((1, -1), [0], (35, 25), (27, 17)),
    ((1, 0), [-1, 1], (38.5, 21.5), (29.5, 14.5)),
    ((1, 1), [0], (42, 18), (32, 12)),
]


@pytest.mark.parametrize("levels", LOW_TO_HIGH)
def test_the_fifteen_runs_rise_in_nine_blocks(levels):
    sheet = make_run_sheet(box_behnken(3), factors(levels), rated_break_strength=6400.0)
    column = 2 if levels == "1/2, 3/4" else 3
    expected = [
        (number, (frequency, *block[0]), block[column])
        for number, block in enumerate(BLOCKS, start=1)
        for frequency in block[1]
    ]
    for row, (number, coded, (peak, minimum)) in enumerate(expected):
        assert sheet.load_block[row] == number
        assert tuple(sheet.coded[row]) == coded
        assert 100 * sheet.peak_share[row] == pytest.approx(peak, abs=1e-9)
        assert 100 * sheet.minimum_share[row] == pytest.approx(minimum, abs=1e-9)
        assert sheet.peak_tension[row] == pytest.approx(64 * peak)
        assert sheet.minimum_tension[row] == pytest.approx(64 * minimum, abs=1e-9)


@pytest.mark.parametrize("line", LINES)
def test_one_run_of_every_line_reaches_zero_tension(line):
    levels, strength, *_ = LINES[line]
    sheet = make_run_sheet(box_behnken(3), factors(levels), rated_break_strength=strength)
    slack = next(caution for caution in find_cautions(sheet) if caution.kind == "slack")
    (run,) = slack.runs
    assert tuple(sheet.coded[sheet.run == run][0]) == (0, -1, 1)
    assert "reaches zero" in slack.message
