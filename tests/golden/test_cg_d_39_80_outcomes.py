"""Strength, exposure, one-way F and abrasion of CG-D-39-80, typed from the report.

Tables 10, 20, 21, A-3 and A-4, section 6.2.2.  Where a printed number does not follow from the
table's own numbers, both stand here.
"""

from math import floor

import numpy as np
import pytest

from reduction.experiments.life_statistics import fit_life, ratio_to_published_life
from reduction.experiments.strength_statistics import (
    fit_exposure_trend,
    group_statistics,
    one_way,
    ratio_of_means,
    strength_after,
)

NAN = float("nan")
# mean, deviation, n; reference mean, deviation, n; printed change, change of the table's numbers
TABLE_10 = {
    "polyester double braid, 5 years, lb": (3241, NAN, 2, 6400, 473, 16, -49, -49),
    "polyester double braid, 5 years, strain": (0.197, NAN, 2, 0.132, 0.014, 16, 51, 49),
    "polyester plaited, 4 years, lb": (5096, 471, 5, 6690, 335, 10, -23, -24),
    "polyester plaited, 4 years, strain": (0.205, 0.037, 5, 0.184, 0.031, 10, 11, 11),
    "nylon double braid, 5 years, lb": (2783, 248, 4, 6512, 455, 20, -57, -57),
    "nylon double braid, 5 years, strain": (0.312, 0.021, 4, 0.211, 0.028, 20, 47, 48),
    "nylon plaited, 4 years, lb": (3525, NAN, 4, 7878, 461, 13, -55, -55),
    "nylon plaited, 5 years, lb": (4416, NAN, 1, 7878, 461, 13, -44, -44),
    "nylon plaited, 5 years, strain": (0.40, NAN, 1, 0.284, 0.023, 13, 40, 41),
}
# printed with the digits cut off, or (first) with .13 for .132
NOT_ROUNDED = {name for name, row in TABLE_10.items() if row[6] != row[7]}


def change_of(mean, deviation, n, reference, reference_deviation, reference_n):
    return ratio_of_means(
        mean, deviation, n, reference_mean=reference,
        reference_standard_deviation=reference_deviation, reference_n=reference_n,
    )  # fmt: skip


@pytest.mark.parametrize("name", TABLE_10)
def test_changes_of_table_10(name):
    *numbers, printed, computed = TABLE_10[name]
    change = 100 * float(change_of(*numbers).change)
    assert change == pytest.approx(computed, abs=0.5)
    if name not in NOT_ROUNDED:
        assert change == pytest.approx(printed, abs=0.5)


def test_what_table_10_prints_otherwise_is_cut_off_or_of_the_shorter_strain():
    assert len(NOT_ROUNDED) == 4
    assert 100 * (0.197 / 0.13 - 1) == pytest.approx(51, abs=0.6)
    for name in NOT_ROUNDED - {"polyester double braid, 5 years, strain"}:
        *numbers, printed, _ = TABLE_10[name]
        assert int(100 * float(change_of(*numbers).change)) == printed


def test_all_changes_with_known_scatter_are_told_from_zero_but_one():
    known = {name: row for name, row in TABLE_10.items() if row[1] == row[1]}
    crosses = set()
    for name, row in known.items():
        change = change_of(*row[:6])
        assert change.low < change.change < change.high
        if change.low < 0 < change.high:
            crosses.add(name)
    # a strain that rises 11 % with deviations of 17 and 18 % and five specimens
    assert crosses == {"polyester plaited, 4 years, strain"}


def test_changes_of_table_21():
    change = change_of([4365, 0.20], [321, 0.045], [4, 4], [6400, 0.13], [473, 0.014], [16, 16])
    np.testing.assert_allclose(100 * change.change, [-31.8, 53.8], atol=0.05)
    np.testing.assert_allclose(np.rint(100 * change.change), [-32, 54])


def test_relative_variability_of_table_21():
    for mean, deviation, printed in (
        (6400, 473, 0.073), (4365, 321, 0.073), (0.13, 0.014, 0.107), (0.20, 0.045, 0.225),
    ):  # fmt: skip
        (value,) = of_sample(mean, deviation, 16).relative_variability
        assert floor(1000 * value + 1e-9) / 1000 == printed


# mean, deviation, n of both; printed F, F of the numbers; printed degrees of freedom and
# critical value, correct critical value
TABLES_A3_A4 = {
    "A-3 1/2, dry and wet": ((7850, 460, 13), (6920, 320, 9), 26.87, 27.4, 20, 4.35, 4.35),
    "A-3 1/2, before and after": ((6920, 320, 9), (7640, 180, 6), 29.24, 24.7, 13, 4.67, 4.67),
    "A-3 13/16, before and after": ((17530, 900, 9), (17030, 1630, 6), 0.61, 0.59, 13, 4.67, 4.67),
    "A-3 1/2, dry and after": ((7850, 460, 13), (7640, 180, 6), 1.30, 1.14, 17, 3.45, 4.45),
    "A-4 1/2, low and wet": ((38.3, 2.0, 3), (42, 6.8, 9), 0.83, 0.82, 10, 4.96, 4.96),
    "A-4 1/2, high and wet": ((24.7, 1.42, 3), (42, 6.8, 9), 18.13, 18.0, 10, 4.96, 4.96),
    "A-4 1/2, low and high": ((38.3, 2.0, 3), (24.7, 1.42, 3), 89.79, 92.2, 4, 7.71, 7.71),
    "A-4 13/16, low and wet": ((41.9, 9.82, 3), (39.7, 4.57, 9), 0.33, 0.30, 10, 4.96, 4.96),
    "A-4 13/16, high and wet": ((39.5, 9.12, 3), (39.7, 4.57, 9), 0.003, 0.003, 10, 4.96, 4.96),
    "A-4 13/16, low and high": ((41.9, 9.82, 3), (39.5, 9.12, 3), 0.10, 0.10, 14, 7.71, 7.71),
}


@pytest.mark.parametrize("name", TABLES_A3_A4)
def test_one_way_f_of_tables_a3_and_a4(name):
    first, second, printed, computed, freedom, printed_critical, critical = TABLES_A3_A4[name]
    analysis = one_way(*np.transpose([first, second]))
    digits = len(str(computed).partition(".")[2])
    assert float(analysis.f_statistic) == pytest.approx(computed, abs=0.51 * 10**-digits)
    assert float(analysis.critical) == pytest.approx(critical, abs=0.005)
    # the verdict of the report stands, with its own critical value and with the correct one
    assert (computed > critical) == (printed > printed_critical)
    misprinted = {"A-3 1/2, dry and after": 17, "A-4 13/16, low and high": 14}
    assert (int(analysis.within) == freedom) or (misprinted[name], int(analysis.within)) == (14, 4)


# mean, deviation, n, printed relative variability
TABLE_20 = {
    ("nylon", "double braid"): (13606, 3331, 45, 0.24),
    ("nylon", "plaited"): (13173, 3278, 26, 0.24),
    ("nylon", "twisted"): (12575, 2835, 21, 0.22),
    ("polyester", "double braid"): (8134, 1963, 38, 0.24),
    ("polyester", "plaited"): (8212, 1763, 39, 0.21),
    ("polyester", "twisted"): (8086, 1660, 33, 0.20),
    ("polypropylene", "plaited"): (4254, 1221, 29, 0.28),
    ("polypropylene", "twisted"): (6064, 1621, 12, 0.26),  # prints 126
}


def of_sample(mean, deviation, n):
    """Statistics of a sample that has exactly this mean and deviation."""
    raw = np.random.default_rng(n).normal(size=n)
    sample = mean + deviation * (raw - raw.mean()) / raw.std(ddof=1)
    return group_statistics(sample, np.zeros(n, int), np.zeros(n, int), n_groups=1)


@pytest.mark.parametrize("line", TABLE_20, ids=" ".join)
def test_relative_variability_of_table_20_is_printed_cut_off(line):
    mean, deviation, n, printed = TABLE_20[line]
    statistics = of_sample(mean, deviation, n)
    assert statistics.n == n
    assert statistics.mean == pytest.approx(mean)
    assert floor(100 * float(statistics.relative_variability[0])) / 100 == printed


@pytest.mark.parametrize(
    ("material", "construction", "ratio"),
    [
        ("nylon", "plaited", 3.10),
        ("polyester", "plaited", 1.93),
        ("nylon", "twisted", 2.07),
        ("polyester", "twisted", 1.33),
    ],
)
def test_ratios_to_polypropylene(material, construction, ratio):
    result = change_of(
        *TABLE_20[material, construction][:3], *TABLE_20["polypropylene", construction][:3]
    )
    assert float(result.ratio) == pytest.approx(ratio, abs=0.005)
    assert result.low + 1 > 1  # more resistant, with 95 % confidence
    # "three times" and "two times" hold for plaited line, and not for twisted
    claimed = {"nylon": 3, "polyester": 2}[material]
    assert (result.low + 1 < claimed < result.high + 1) == (construction == "plaited")


def test_jacket_lasts_four_to_six_times_longer_than_the_mode():
    lives = np.array([29e3, 39e3, 41e3])
    of_mode = change_of(lives, NAN, 1, 7000.0, NAN, 1)
    np.testing.assert_allclose(of_mode.ratio, [4.14, 5.57, 5.86], atol=0.005)
    assert of_mode.ratio.mean() == pytest.approx(5.2, abs=0.05)
    assert lives.mean() / 8134 == pytest.approx(4.5, abs=0.05)


def test_jacketed_samples_known_only_to_last_longer_raise_the_ratio():
    # the lives of the other ten of thirteen are not printed; they rose from test to test, so that
    # each is taken to have passed the third
    reference = {"reference_mean": 8134, "reference_standard_deviation": 1963, "reference_n": 38}
    three = ratio_to_published_life([29e3, 39e3, 41e3], [False] * 3, **reference)
    all_of_them = ratio_to_published_life(
        [29e3, 39e3] + [41e3] * 11, [False] * 3 + [True] * 10, **reference
    )
    assert all_of_them[0] > three[0] and all_of_them[1] > three[1]
    median = fit_life([29e3, 39e3] + [41e3] * 11, [False] * 3 + [True] * 10)
    assert median.life > 41e3


FIGURE_15 = ([0, 2, 3, 5], [6400, 4672, 4365, 3241], [473, NAN, 321, NAN], [16, 1, 4, 2])


def test_polyester_double_braid_loses_a_tenth_of_its_strength_a_year():
    line = fit_exposure_trend(*FIGURE_15)
    slope, intercept = np.polyfit(*FIGURE_15[:2], 1, w=np.sqrt(FIGURE_15[3]))
    assert (line.intercept, line.slope) == pytest.approx((intercept, slope))
    # "linear", "approximately 50 %" after five years
    assert line.lack_of_fit_p_value > 0.05
    _, low, high, _ = strength_after(line, 5.0)
    assert low / 6400 < 0.5 < high / 6400
