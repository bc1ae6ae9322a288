from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from reduction.readers.columns import (
    DeclaredColumn,
    check_lengths,
    check_unit,
    declared_columns,
    find_column,
    without_marks,
)
from reduction.readers.layout import Layout
from reduction.record.errors import LogError

PATH = Path("log.h5")
LOAD = DeclaredColumn("tension.1", "load", "kN", "force")


def layout(**settings):
    channels = {
        "time": {"column": "t"},
        "tension": {"1": {"column": "a", "unit": "kN"}, "2": {"column": "b", "unit": "V"}},
    }
    channels["time"]["unit"] = "s"
    channels["tension"]["2"] |= {"unit": "kN", "factor": 2.0, "time_column": "tb"}
    return Layout.model_validate({"format": "hdf5", "channels": channels, **settings})


def test_wanted_columns_are_the_channels_and_their_own_times():
    wanted = declared_columns(layout())
    assert [(want.key, want.column, want.dimension) for want in wanted] == [
        ("time", "t", "time"),
        ("tension.1", "a", "force"),
        ("tension.2", "b", "force"),
        ("tension.2.time", "tb", "time"),
    ]
    assert [want.is_compared for want in wanted] == [True, True, False, True]


def test_names_are_found_without_the_blanks_around_them():
    assert find_column(PATH, LOAD, ["time", " load "]) == 1


def test_a_long_list_of_columns_is_cut():
    names = [f"c{number}" for number in range(50)]
    with pytest.raises(LogError, match="'c39' and 10 more"):
        find_column(PATH, LOAD, names)


def test_a_column_is_not_in_a_file_without_columns():
    with pytest.raises(LogError, match="'load' is not in the file; found no columns"):
        find_column(PATH, LOAD, [])


def test_a_name_is_not_found_where_columns_have_none():
    with pytest.raises(LogError, match="found columns without names, numbers 1 to 3"):
        find_column(PATH, LOAD, ["", "", ""])


def test_a_name_that_stands_twice_is_refused():
    with pytest.raises(
        LogError, match=r"'load' appears 2 times in the file; found numbers 1, 3"
    ) as e:
        find_column(PATH, LOAD, ["load", "t", "load"])
    assert "by its number" in str(e.value)


@pytest.mark.parametrize("number", [0, 3, -1])
def test_a_number_outside_the_columns_is_refused(number):
    wanted = DeclaredColumn("tension.1", number, "kN", "force")
    with pytest.raises(LogError, match="needed a number from 1 to 2"):
        find_column(PATH, wanted, ["a", "b"])


def test_a_number_is_refused_where_columns_have_no_order():
    with pytest.raises(LogError, match="needed a name"):
        find_column(PATH, DeclaredColumn("tension.1", 1, "kN", "force"), ["a", "b"], in_order=False)


@pytest.mark.parametrize("stated", ["kN", " [kN] ", "(kN)", "kilonewton"])
def test_other_spellings_of_the_declared_unit_agree_with_it_alone(stated):
    check_unit(PATH, LOAD, stated)
    with pytest.raises(LogError, match="the unit in the file is not the declared one"):
        check_unit(PATH, replace(LOAD, unit="N"), stated)


@pytest.mark.parametrize("unit", ["kN", "N"])
@pytest.mark.parametrize("stated", ["", "-"])
def test_a_unit_that_is_not_stated_contradicts_none(stated, unit):
    assert check_unit(PATH, replace(LOAD, unit=unit), stated) is None


def test_pounds_of_a_force_are_pound_force():
    check_unit(PATH, replace(LOAD, unit="lbf"), "lb")
    with pytest.raises(LogError, match="found 'lb'; needed 'kN'"):
        check_unit(PATH, LOAD, "lb")


@pytest.mark.parametrize(
    ("stated", "problem"),
    [
        ("N", "the unit in the file is not the declared one; found 'N'; needed 'kN'"),
        ("mm", "not a unit of force"),
        ("daPs", "is not known"),
        ("kN/", "unit 'kN/' is not known"),
        ("kN (raw", "is not known"),
        ("kN/0", "is not known"),
        ("9**9**9**9", "is not known"),
        ("x" * 99, "is not known"),
    ],
)
def test_another_unit_is_refused(stated, problem):
    with pytest.raises(LogError, match=problem) as error:
        check_unit(PATH, LOAD, stated, row=2)
    assert error.value.row == 2


def test_a_unit_is_not_compared_where_the_file_has_volts():
    check_unit(PATH, replace(LOAD, is_compared=False), "V")
    with pytest.raises(LogError, match="not a unit of force"):
        check_unit(PATH, LOAD, "V")


def test_a_factor_of_one_that_is_stated_is_of_a_column_in_another_quantity():
    load = replace(LOAD, has_factor=True)
    for stated in ("%MBL", "MPa", "V"):
        check_unit(PATH, load, stated)
    with pytest.raises(LogError, match="found 'N'; needed 'kN'"):
        check_unit(PATH, load, "N")
    with pytest.raises(LogError, match="such as stress or % of break strength, state factor"):
        check_unit(PATH, LOAD, "%MBL")
    channels = {"tension.1": {"column": "Load", "unit": "kN", "factor": 1}}
    (declared,) = declared_columns(Layout(format="delimited", channels=channels))
    assert declared.has_factor and declared.is_compared


def test_columns_of_one_length_have_that_many_rows():
    assert check_lengths(PATH, {"time": np.zeros(3), "tension.1": np.ones(3)}) == 3


def test_two_time_bases_are_refused():
    with pytest.raises(LogError, match=r"two time bases; found time 3 values, tension\.1 2 values"):
        check_lengths(PATH, {"time": np.zeros(3), "tension.1": np.ones(2)})


def test_a_channel_with_own_times_may_have_its_own_length():
    columns = {"time": np.zeros(3), "tension.1": np.ones(2), "tension.1.time": np.ones(2)}
    assert check_lengths(PATH, columns) == 3


def test_own_times_must_have_the_length_of_their_channel():
    columns = {"time": np.zeros(3), "tension.1": np.ones(2), "tension.1.time": np.ones(3)}
    with pytest.raises(LogError, match=r"two time bases; found tension\.1 2 values"):
        check_lengths(PATH, columns)


def test_no_rows_and_no_channels_are_refused():
    with pytest.raises(LogError, match="there are no data rows"):
        check_lengths(PATH, {"time": np.zeros(0)})
    with pytest.raises(LogError, match="declares no channels"):
        check_lengths(PATH, {})


def test_marks_that_are_numbers_become_missing_in_the_precision_of_the_column():
    marked = layout(missing=["", "-99.9", "x", "inf"])
    values = np.array([1.0, -99.9, 2.0], dtype=np.float32)
    assert np.isnan(without_marks(values, marked)).tolist() == [False, True, False]
    assert without_marks(np.array([1, 2], dtype=np.int16), marked).tolist() == [1.0, 2.0]
