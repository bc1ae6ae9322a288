"""Cubics end where they cannot be trusted: by the tables, typed here, and by their own slope."""

import numpy as np
import pytest

from reduction.lines.line_lookup import look_up
from reduction.lines.published_source import published_sources
from reduction.record.errors import DataError, SettingsError

LBF = 4.4482216152605
REST = "quasi_static_spring_constant"
FIFTH = 0.196  # 1.96 times a tenth: sec. 4.4.1, new lines
# Table 9, nylon double braid, 5 years: B, C, D of strain, 1/lb, 1/lb2, 1/lb3
OLD_NYLON = (2.014e-4, -5.148e-8, 3.259e-12)
# Tables 6 and 8, plaited nylon, new: K_0 in lb, strain
PLAIT_STRAIN = (1.694e-4, -3.943e-8, 3.02e-12)


def slope(tension, terms):
    b, c, d = terms
    return b + 2 * c * tension + 3 * d * tension**2


def curve(name, quantity):
    return next(one for one in published_sources()[name].curves if one.quantity == quantity)


def test_strain_ends_where_its_cubic_turns():
    found = curve("nylon-double-braid-0.5in-5-years", "strain")
    b, c, d = OLD_NYLON
    turn = (-2 * c - np.sqrt(4 * c**2 - 12 * d * b)) / (6 * d)
    assert turn == pytest.approx(2597, abs=1)
    # within a node of 2,700/8,000 lb
    assert found.high / LBF == pytest.approx(turn, abs=0.4)
    line = published_sources()["nylon-double-braid-0.5in-5-years"]
    with pytest.raises(DataError, match="falls under more load"):
        look_up(line, "strain", tension=2650 * LBF)
    flagged = look_up(line, "strain", tension=2650 * LBF, extrapolate="flag")
    assert not flagged.is_inside
    assert any("falls under more load" in note for note in flagged.notes)


def test_rest_stiffness_ends_before_the_slope_is_as_wrong_as_it_is_below_zero():
    found = curve("nylon-double-braid-0.5in-5-years", REST)
    wrong = -slope(2700, OLD_NYLON)
    end = found.high / LBF
    assert wrong == pytest.approx(FIFTH * slope(end, OLD_NYLON), rel=2e-3)
    line = published_sources()["nylon-double-braid-0.5in-5-years"]
    for pounds in (2400, 2500, 2590):
        with pytest.raises(DataError, match="may be wrong by more than 20 %"):
            look_up(line, REST, mean_tension=pounds * LBF)
    assert look_up(line, REST, mean_tension=2000 * LBF).value == pytest.approx(
        LBF / slope(2000, OLD_NYLON), rel=1e-9
    )


@pytest.mark.parametrize(
    "name", [one for one, line in published_sources().items() if not line.is_tether]
)
def test_inside_its_range_rest_stiffness_is_positive_and_strain_rises(name):
    for found in published_sources()[name].curves:
        at = np.linspace(found.low, found.high, 301)
        values = look_up(published_sources()[name], found.quantity, **{found.variable: at}).value
        if found.quantity == "strain":
            assert np.all(np.diff(values) > 0)
        else:
            assert np.all(values > 0)


def test_two_curves_of_one_line_agree_within_the_range():
    found = curve("nylon-8-strand-plaited-0.5in-new", REST)
    line = published_sources()["nylon-8-strand-plaited-0.5in-new"]
    at = np.linspace(found.low, found.high, 201)
    both = look_up(line, REST, mean_tension=at).value * slope(at / LBF, PLAIT_STRAIN) / LBF
    assert np.max(np.abs(both - 1)) <= FIFTH * 1.001
    assert both[0] == pytest.approx(1 - FIFTH, abs=1e-3)
    # 348 lb at 165 lb, where strain says 6,384 lb
    with pytest.raises(DataError, match="differs from the slope of the load-strain cubic"):
        look_up(line, REST, mean_tension=165 * LBF)
    flagged = look_up(line, REST, mean_tension=165 * LBF, extrapolate="flag")
    assert not flagged.is_inside
    assert flagged.value == pytest.approx(348 * LBF, rel=0.01)
    assert 1 / slope(165, PLAIT_STRAIN) == pytest.approx(6384, rel=0.01)


def test_a_line_of_four_years_is_held_against_the_strain_of_five():
    # one row of Table 7 for both; Table 9 has no strain of plaited nylon after four years
    four, five = (curve(f"nylon-8-strand-plaited-0.5in-{age}-years", REST) for age in (4, 5))
    assert (four.low, four.high) == (five.low, five.high)
    # Table 9, 5 years
    terms = (3.08e-4, -11.17e-8, 13.5e-12)
    line = published_sources()["nylon-8-strand-plaited-0.5in-4-years"]
    value = look_up(line, REST, mean_tension=four.low).value / LBF
    assert value * slope(four.low / LBF, terms) == pytest.approx(1 - FIFTH, abs=2e-3)


def test_what_is_open_is_not_said_to_be_replaced():
    with pytest.raises(SettingsError, match="whose slope would take its place, is ambiguous"):
        look_up(published_sources()["polyester-8-strand-plaited-0.5in-new"], REST, mean_tension=1e3)
