"""Two published tethers out of one table, with strain by the marks."""

import numpy as np
import pytest

from reduction.lines.line_lookup import look_up
from reduction.lines.published_source import published_sources
from reduction.lines.tether_comparison import compared_tethers

PSI = 6894.757293168
NEW, USED = "rubber-tether-new-T-1", "rubber-tether-used-T-1"


def pair(*names):
    return compared_tethers(*(published_sources()[name] for name in names))


def test_t1_is_compared_in_table_5_by_the_marks():
    found = pair(NEW, USED)
    assert all("Table 5" in one.source for one in (found.first, found.second))
    values = [
        float(look_up(one, "tangent_modulus", strain=1.0).value) / PSI
        for one in (found.first, found.second)
    ]
    # 137/1.1455 and 148/1.1632: b/f by hand from the marks of Table 3
    assert values == pytest.approx([137 / 1.1455, 148 / 1.1632], rel=2e-4)
    assert values[0] / values[1] == pytest.approx(0.94, abs=0.005)


def test_strain_at_the_marks_is_that_of_the_free_length():
    """At the stretched marks of the new tether, 19.37 ft: free 14.80 ft of 8.38 ft."""
    found = pair(NEW, USED)
    low, high = found.first.curves[0].low, found.first.curves[0].high
    position = np.array([19.37, 21.75, 24.12])
    by_fraction = 0.777446 * position / 8.38 - 1
    printed = np.array([0.775, 1.23])
    # a straight line through three marks, at the ends of the printed window
    by_marks = np.polyval(np.polyfit(by_fraction, [0.766, 1.023, 1.271], 1), printed)
    assert [low, high] == pytest.approx(list(by_marks), abs=2e-3)


def test_the_open_row_of_table_6_is_told_with_its_own_numbers():
    (told,) = (note for note in pair(NEW, USED).notes if "ambiguous" in note)
    # (145 - 80) lb / 0.42 / 0.8495 in2 / 1.1455, and (118 - 63) / 0.44 / 0.694 / 1.1632, in psi
    numbers = [float(part.split()[-1]) * 1e6 / PSI for part in told.split(" MPa")[:2]]
    assert numbers == pytest.approx([159.0, 154.9], abs=0.2)
    assert "ratio 0.97" in told


def test_other_tests_are_of_table_6_without_marks():
    found = pair("rubber-tether-new-T-2", "rubber-tether-used-T-2")
    assert all("Table 6" in one.source for one in (found.first, found.second))
    assert "tape readings are printed for T-1 only" in found.notes[1]


def test_one_table_serves_two_tests_where_the_other_has_an_open_row():
    found = pair(NEW, "rubber-tether-used-T-2")
    assert all("Table 5" in one.source for one in (found.first, found.second))


def test_a_rope_is_no_tether():
    assert pair("nylon-8-strand-plaited-0.5in-new", USED) is None


@pytest.mark.parametrize(("name", "ratio"), [(NEW, "1.145"), (USED, "1.163")])
def test_a_modulus_of_t1_warns_of_its_strain(name, ratio):
    (told,) = look_up(published_sources()[name], "tangent_modulus", strain=1.0).warnings
    assert ratio in told
