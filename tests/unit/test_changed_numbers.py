"""Numbers that changed and moved, and rows that go together: on numbers worked out by hand."""

import math

import numpy as np
import pytest

from reduction.archive.product_differences import (
    Change,
    _kind_of,
    _pair_by_name,
    _rows_by_labels,
    _shifts_between,
    _worst_change,
)

NAN = math.nan


def flags(before, after, uncertainty, **more):
    given = None if uncertainty is None else np.array([uncertainty])
    changed, moved, shift = _shifts_between(np.array([before]), np.array([after]), given, **more)
    return bool(changed[0]), bool(moved[0]), float(shift[0])


@pytest.mark.parametrize(
    ("before", "after", "uncertainty", "changed", "moved"),
    [
        (10.0, 10.0, 1.0, False, False),
        (10.0, 10.5, 1.0, True, False),  # half an uncertainty is not more than half
        (10.0, 10.51, 1.0, True, True),
        (10.0, 9.4, 1.0, True, True),
        (10.0, 10.1, NAN, True, True),  # nothing says that it may
        (10.0, 10.1, 0.0, True, True),
        (10.0, 10.1, None, True, True),
        (1.0, 1.0 + 5e-10, 1e-12, False, False),  # rounding, whatever it is said to be known to
        (1.0, 1.0 + 2e-9, 1e-12, True, True),
        (10.0, NAN, 1.0, True, True),
        (NAN, 10.0, 1.0, True, True),
        (NAN, NAN, 1.0, False, False),
        (math.inf, math.inf, 1.0, False, False),
        (math.inf, 1.0, 1.0, True, True),
        (math.inf, 1.0, None, True, True),
        (0.0, 1e-300, None, True, True),
    ],
)
def test_a_number_changes_by_a_billionth_and_moves_by_half_its_uncertainty(
    before, after, uncertainty, changed, moved
):
    assert flags(before, after, uncertainty)[:2] == (changed, moved)


def test_the_shift_has_the_sign_of_the_change():
    assert flags(10.0, 8.0, 0.5)[2] == -4.0
    assert flags(10.0, 12.0, 0.5)[2] == 4.0


def test_beside_a_large_number_of_the_same_variable_dust_is_no_change():
    before, after = np.array([1e6, 1e-9]), np.array([1e6, 3e-9])
    assert not _shifts_between(before, after, None)[0].any()
    assert _shifts_between(before, after, None, is_exact=True)[0].tolist() == [False, True]


def test_exact_takes_the_last_bit_and_no_missing_number_for_another():
    one = 0.1
    assert flags(one, np.nextafter(one, 1), 1.0)[:2] == (False, False)
    assert flags(one, np.nextafter(one, 1), 1.0, is_exact=True)[:2] == (True, True)
    assert flags(NAN, NAN, 1.0, is_exact=True)[:2] == (False, False)
    assert flags(NAN, 1.0, 1.0, is_exact=True)[:2] == (True, True)
    large = np.array([2**60]), np.array([2**60 + 1])  # one number as floats
    assert _shifts_between(*large, None, is_exact=True)[0].all()


def worst(before, after, uncertainty=None, *, name="x", is_read=False, is_exact=False):
    kind = _kind_of(name, has_uncertainty=uncertainty is not None)
    return _worst_change(
        Change("a.nc", name, kind), np.array(before), np.array(after),
        None if uncertainty is None else np.array(uncertainty),
        lambda at: {"place": str(at)}, is_exact=is_exact, is_read=is_read,
    )  # fmt: skip


def test_the_worst_is_the_largest_in_uncertainties_and_not_in_numbers():
    found = worst([100.0, 1.0, 5.0], [110.0, 2.0, 5.0], [20.0, 0.5, 1.0])
    assert (found.n, found.n_changed, found.n_moved) == (3, 2, 1)
    assert (found.before, found.after, found.shift) == (1.0, 2.0, 2.0)
    assert found.where == {"place": "(1,)"} and found.change == "changed"
    assert found.standard_uncertainty == 0.5 and found.relative == 1.0


def test_what_came_or_went_is_counted_and_shown_where_nothing_moved_in_numbers():
    found = worst([1.0, NAN, 3.0], [9.0, 2.0, NAN], [1.0, NAN, 1.0])
    assert (found.n_moved, found.n_came, found.n_went) == (3, 1, 1)
    assert (found.change, found.shift) == ("changed", 8.0)
    assert worst([1.0, NAN], [1.2, 2.0], [1.0, NAN]).change == "came"
    went = worst([1.0, 2.0], [1.0, NAN], [1.0, 1.0])
    assert (went.change, went.before, went.after, went.shift) == ("went", 2.0, None, None)


def test_a_series_that_shares_an_uncertainty_is_one_answer():
    before = np.ones((2, 5))
    after = before + np.array([[0, 0.1, 0.2, 0.9, 0], [0, 0, 0, 0, 0]])
    found = worst(before, after, [[1.0], [1.0]])
    assert (found.n, found.n_changed, found.n_moved) == (2, 1, 1)
    assert found.where == {"place": "(0, 3)"} and found.shift == pytest.approx(0.9)


def test_a_number_without_uncertainty_moves_where_it_is_read():
    assert worst([1.0], [1.1]).n_moved == 0
    assert worst([1.0], [1.1]).n_changed == 1
    assert worst([1.0], [1.1], is_read=True).n_moved == 1
    assert worst([1.0], [1.1], is_exact=True).n_moved == 1
    part = "x_uncertainty_contribution"
    assert worst([1.0], [1.1], name=part, is_read=True).n_moved == 0


def test_an_uncertainty_is_held_against_itself():
    found = worst([2.0, 2.0], [2.9, 3.1], [2.0, 2.0], name="x_standard_uncertainty")
    assert (found.kind, found.n_moved) == ("uncertainty", 1)
    assert _kind_of("x_random_standard_uncertainty", has_uncertainty=True) == "number"


def test_names_that_stand_in_several_groups_go_by_the_ends_of_their_paths():
    pairs = _pair_by_name(["/a/n", "/b/n", "/m"], ["/old/b/n", "/old/a/n", "/c/n"])
    assert pairs == {"/a/n": "/old/a/n", "/b/n": "/old/b/n"}
    assert _pair_by_name(["/n"], ["/deep/er/n", "/deep/n"]) == {"/n": "/deep/n"}


def test_rows_of_one_label_go_in_their_order():
    rows = _rows_by_labels([np.array(["a", "b", "a"])], [np.array(["a", "a", "a", "b"])])
    assert [places.tolist() for places in rows.places] == [[0, 1, 2], [0, 3, 1]]
    assert (rows.removed, rows.added) == ([], ["a"])


def test_the_last_bit_of_a_bin_makes_no_other_bin():
    before = np.array([0.815, 0.825])
    rows = _rows_by_labels([before], [np.nextafter(before, 1)])
    assert [places.tolist() for places in rows.places] == [[0, 1], [0, 1]]
    assert rows.words(1) == ["0.825"]
