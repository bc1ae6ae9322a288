"""Binary files and archives that mean harm: refused with a message, in little memory and time."""

import shutil
import tomllib

import numpy as np
import pytest
from commandruns import loaded_process
from hostile_archives import ARCHIVES
from hostile_hdf5 import HDF5
from hostile_matlab import MATLAB
from hostile_tables import PARQUET, TDMS
from hostile_workbooks import WORKBOOKS

LIMITS = {"unpacked_size": 50_000_000, "columns": 1000, "time": 30.0}
MOST_MEMORY = 700_000_000  # of which the package itself takes 180 MB; sniff has wider limits
DEADLINE = 120  # s, on a machine that does much else
FORMATS = {
    "xlsx": "spreadsheet", "xlsm": "spreadsheet", "xls": "spreadsheet", "ods": "spreadsheet",
    "h5": "hdf5", "mat": "matlab", "tdms": "tdms", "parquet": "parquet",
    "json": "json",
}  # fmt: skip
CHANNELS = {
    "time": {"column": "t", "unit": "s"},
    "crosshead_position": {"column": "x", "unit": "m", "datum": "pin-to-pin"},
    "tension": {"1": {"column": "F", "unit": "kN"}},
}
# of each format those that stand for what can become of a file; all of them are nightly
OFTEN = {
    "bomb_of_a_sheet", "external_entity", "formulas_with_values", "encrypted",
    "xls_with_a_huge_table", "ods_with_a_row_that_repeats",
    "every_column_ten_to_the_nine", "external_link_on_the_way",
    "cells_nested_a_hundred_thousand_times", "same_variable_twice",
    "tdms_of_ten_to_the_nine_scales", "tdms_whose_next_segment_is_itself",
    "parquet_of_ten_to_the_twelve_rows", "json_of_many_brackets",
}  # fmt: skip
OFTEN_OF_ARCHIVES = {
    "strain_is_text", "a_huge_dimension", "every_number_is_nan", "settings_are_nested",
    "id_is_a_path", "schema_of_tomorrow", "strain_is_passwd", "names_without_end", "cut_in_half",
}  # fmt: skip


def of_each_kind(makers, often):
    """Parameters of which those that stand for what can become of a file are run by default."""
    return [
        pytest.param(
            *values,
            id="-".join([*values[:-1], values[-1].__name__]),
            marks=() if values[-1].__name__ in often else pytest.mark.nightly,
        )
        for values in makers
    ]


CASES = of_each_kind(
    [
        (name, maker)
        for table in (WORKBOOKS, HDF5, MATLAB, TDMS, PARQUET)
        for name, makers in table.items()
        for maker in makers
    ],
    OFTEN,
)
# odd, but what is read of them is what stands there
READ = {
    "external_link", "formulas_with_values", "formulas_without_values", "macros", "good",
    "groups_in_a_loop", "name_with_a_nul", "attribute_of_twenty_megabytes",
    "bomb_in_another_variable", "v73_class_of_no_text", "good_tdms", "tdms_by_hand",
    "tdms_whose_next_segment_is_itself", "tdms_of_one_value_a_chunk",
    "tdms_with_an_index_of_its_own", "good_parquet", "parquet_of_fewer_rows_than_stored",
    "parquet_of_a_schema_that_lies", "parquet_of_an_extension_that_is_pickled",
    "json_of_surrogates", "one_cell_in_the_last_row", "shape_below_zero",
}  # fmt: skip
# what is read where that is not what every good file says
LOADS = sum(5.0 + np.arange(30))  # kN
READ_AS = {
    "external_link": f"read 31 rows, loads {LOADS:g};",
    "formulas_with_values": f"read 31 rows, loads {LOADS:g};",
    "formulas_without_values": f"read 32 rows, loads {LOADS:g};",
    "name_with_a_nul": "read 30 rows, loads 0;",
    "one_cell_in_the_last_row": f"read 1048575 rows, loads {LOADS:g};",
    "tdms_of_one_value_a_chunk": "read 100000 rows",
    "parquet_of_fewer_rows_than_stored": "read 3 rows",
    "json_of_surrogates": "read 1 rows",
}
_BROKE = "the library that reads this format crashed on the file"
SAID = {
    "bomb_of_a_sheet": "the workbook unpacks to more memory than is allowed",
    "one_cell_in_the_last_corner": _BROKE,
    "overlapping_members": "the workbook unpacks to more memory than is allowed",
    "strings_that_claim_billions": _BROKE,
    "external_entity": "declares a document type",
    "encrypted": "password",
    "xls_with_a_huge_table": _BROKE,
    "xls_whose_sectors_run_in_a_circle": "there is no sheet 1",
    "shape_of_a_million_million_in_chunks": "no room for 8000000 MB",
    "every_column_ten_to_the_nine": "has values that were never written",
    "one_chunk_of_zeros": "a chunk of '/F' unpacks to more memory than is allowed",
    "columns_without_end": "the file has too many columns",
    "external_link_on_the_way": "is a link",
    "attribute_of_twenty_megabytes": "'operator' is not stored: it has 20,000,000 characters",
    "complex_numbers": "'F' is not an array; found complex numbers",
    "cells_nested_a_hundred_thousand_times": f"{_BROKE}; found an end by SIGSEGV",
    "same_variable_twice": "two variables of that name",
    "tdms_of_ten_to_the_nine_scales": "1000 scales at most",
    "parquet_of_ten_to_the_twelve_rows": "no room for",
}
VERIFIED = {"id_is_a_path", "attributes_are_numbers", "time_is_packed"}
REFUSED_ARCHIVES = {
    "strain_is_text", "strain_bins_are_text", "a_huge_dimension", "tension_is_huge",
    "coordinates_are_nan", "every_number_is_nan", "settings_are_no_json", "settings_are_a_number",
    "settings_are_a_list", "settings_are_nested", "settings_are_large", "schema_is_a_list",
    "schema_of_tomorrow", "strain_elsewhere", "strain_is_passwd",
    "groups_in_a_loop", "attributes_are_gone", "cut_in_half", "empty", "an_old_netcdf", "nothing_of_the_kind",
}  # fmt: skip


@pytest.fixture(scope="module")
def bounded():
    return loaded_process()


def check_ended(done, statuses):
    """A status of the list and a message; no traceback, no hang, not too much memory."""
    assert not done.is_late, done
    assert done.status in statuses, done
    assert done.memory < MOST_MEMORY, done
    for word in ("Traceback", "panicked", "internal error"):
        assert word not in done.text, done


@pytest.mark.parametrize(("name", "maker"), CASES)
def test_a_hostile_log_is_refused_with_a_message_in_little_memory(bounded, tmp_path, name, maker):
    path = tmp_path / name
    maker(path)
    layout = {"format": FORMATS[name.rsplit(".")[-1]], "channels": CHANNELS}
    layout |= tomllib.loads(getattr(maker, "layout", ""))
    done = bounded.read(path, layout, LIMITS, seconds=DEADLINE)
    check_ended(done, {0} if maker.__name__ in READ else {3, 4})
    assert SAID.get(maker.__name__, "") in done.text
    if done.status == 0:
        assert READ_AS.get(maker.__name__, f"read 30 rows, loads {LOADS:g};") in done.text
    if done.status == 3:
        assert f"refused: {path}" in done.text
    assert "4711" not in done.text and "root:" not in done.text
    assert not path.with_name(path.name + ".touched").exists()


@pytest.mark.parametrize("change", of_each_kind([(one,) for one in ARCHIVES], OFTEN_OF_ARCHIVES))
def test_a_hostile_archive_is_refused_or_looked_up(bounded, synthetic, tmp_path, change):
    folder = tmp_path / "processed" / "tmt-synthetic"
    folder.mkdir(parents=True)
    path = folder / "T-1.nc"
    shutil.copy(synthetic.processed / "T-1.nc", path)
    change(path)
    statuses = {0, 2, 3, 4, 5, 6}
    looked_up = [
        "lookup",
        path,
        "--quantity",
        "tension",
        "--strain",
        "100 %",
        "--line",
        "new",
        "--branch",
        "ascending",
    ]
    done = bounded.run(*looked_up, seconds=DEADLINE)
    check_ended(done, {6} if change.__name__ in REFUSED_ARCHIVES else statuses)
    if change.__name__ in REFUSED_ARCHIVES:
        assert str(path) in done.text
    elif change.__name__ in VERIFIED:
        check_ended(bounded.run("verify", folder, seconds=DEADLINE), {6})
    assert "4711" not in done.text
