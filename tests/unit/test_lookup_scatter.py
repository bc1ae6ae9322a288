"""Intervals of the kind and of another specimen: by hand, and against lines that were drawn."""

import numpy as np
import pytest

from reduction.lines.line_curve import interval_between_lines
from reduction.lines.line_lookup import look_up
from reduction.lines.published_source import published_sources

LBF = 4.4482216152605
K_AP = "apparent_spring_constant"
T_5 = 2.570582  # 95 %, two-sided, 5 degrees of freedom


def at_centre(name):
    line = published_sources()[name]
    surface = line.surfaces[K_AP]
    middle = (surface.low + surface.high) / 2
    return look_up(line, K_AP, **dict(zip(line.factor_names, middle, strict=True)))


@pytest.mark.parametrize(
    ("name", "share", "n_lines"),
    # sec. 4.4.1; lines of Tables 3 and 5
    [
        ("nylon-double-braid-0.5in-new", 0.1, 3),
        ("polyester-double-braid-0.5in-5-years", 0.5, 2),
        # not printed: two, the fewest of any
        ("nylon-double-braid-1in-new", 0.1, 2),
    ],
)
def test_another_line_is_as_far_as_the_report_says(name, share, n_lines):
    found = at_centre(name)
    own = np.log(1 + share**2)
    run = (found.high - found.value) / found.value
    another = np.sqrt(T_5**2 * own * (1 + 1 / n_lines) + run**2)
    assert np.log(found.line_high / found.value) == pytest.approx(another, rel=1e-6)
    of_mean = (found.surface_high - found.value) / found.value
    kind = np.sqrt(T_5**2 * own / n_lines + of_mean**2)
    assert np.log(found.kind_high / found.value) == pytest.approx(kind, rel=1e-6)
    assert 0 < found.line_low < found.low < found.value < found.high < found.line_high
    assert found.line_low < found.kind_low < found.kind_high < found.line_high
    assert found.interval_of == "one more run of the same specimens"
    assert any(
        f"by about {100 * share:.0f} % (CG-D-39-80, sec. 4.4.1): " in one for one in found.notes
    )


def test_the_scatter_between_lines_is_that_of_one_quantity():
    line = published_sources()["nylon-double-braid-0.5in-new"]
    levels = {"frequency": 0.3, "mean_tension": 1344 * LBF, "tension_amplitude": 544 * LBF}
    found = look_up(line, "hysteresis_energy", **levels)
    assert np.isnan(found.line_high)
    assert np.isnan(found.kind_low)
    assert np.isfinite(found.high)
    assert any("scatter between specimens is not included" in one for one in found.notes)


def test_ninety_five_of_a_hundred_lines_that_were_drawn_are_inside():
    """The scatter is known: very many degrees of freedom; lines of a factor, normal in its log."""
    rng = np.random.default_rng(3)
    size, n_lines, share = 20_000, 3, 0.5
    sigma = np.sqrt(np.log(1 + share**2))
    tested = np.exp(rng.normal(0, sigma, (size, n_lines)).mean(axis=1))
    another = np.exp(rng.normal(0, sigma, size))
    ends = [
        interval_between_lines(
            tested, tested, tested, line_scatter=share, n_lines=n_lines, degrees_of_freedom=1e9,
            is_another=is_another,
        )
        for is_another in (True, False)
    ]  # fmt: skip
    covered = [
        np.mean((low < x) & (x < high)) for (low, high), x in zip(ends, (another, 1.0), strict=True)
    ]
    assert covered == pytest.approx([0.95, 0.95], abs=3 * np.sqrt(0.05 * 0.95 / size))


def test_what_is_not_above_zero_has_no_share():
    value = np.array([-1.0, 0.0, 1.0])
    low, high = interval_between_lines(
        value, value - 0.1, value + 0.1, line_scatter=0.1, n_lines=2, degrees_of_freedom=5,
        is_another=True,
    )  # fmt: skip
    assert np.isnan(low[:2]).all()
    assert np.isfinite(high).tolist() == [False, False, True]


def test_it_is_never_narrower_than_what_it_is_made_from():
    # exp(-0.9) is 0.41: the lower limit of one more run is farther out
    value, low, high = np.array([1.0]), np.array([0.1]), np.array([1.9])
    found = interval_between_lines(
        value, low, high, line_scatter=0.1, n_lines=3, degrees_of_freedom=5, is_another=True
    )
    assert found[0] == low
    assert found[1] > high
