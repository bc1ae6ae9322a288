"""The own check finds each fault that it looks for."""

import shutil

import netCDF4
import pytest
from archive_check import check_archive


@pytest.fixture
def path(archives, tmp_path):
    return shutil.copy(archives[-1], tmp_path)


def findings_after(path, change):
    with netCDF4.Dataset(path, "a") as file:
        file.set_auto_maskandscale(False)
        change(file)
    return check_archive(path)


def test_nothing_is_found_in_any_kind_of_product(archives):
    assert [check_archive(path) for path in archives] == [[], [], [], []]


def delete_attribute(variable, attribute):
    return lambda file: file[variable].delncattr(attribute)


def add_variable(name, dtype, dims):
    return lambda file: file.createVariable(name, dtype, dims)


@pytest.mark.parametrize(
    ("change", "finding"),
    [
        (lambda file: file.createGroup("g"), "group g is not one of the schema"),
        (lambda file: file.delncattr("schema_version"), "schema_version is not 1.0"),
        (lambda file: file.delncattr("history"), "global attribute history is missing"),
        (lambda file: file.createDimension("more", None), "dimension more is unlimited"),
        (add_variable("colour", "f8", ()), "colour is not in the schema"),
        (
            add_variable("measured_strain", "f8", ("sample", "specimen")),
            "measured_strain has dimensions ('sample', 'specimen'), not ('specimen', 'sample')",
        ),
        (
            add_variable("measured_strain", "f4", ("specimen", "sample")),
            "measured_strain has type float32, not f8",
        ),
        (add_variable("tension_band", str, ()), "tension_band holds strings of variable length"),
        (delete_attribute("specimen", "_Encoding"), "specimen does not say that it is utf-8"),
        (delete_attribute("tension", "units"), "tension has no units"),
        (delete_attribute("tension", "long_name"), "tension has no long_name"),
        (
            lambda file: file["phase"].__setitem__(0, 9),
            "phase has values without a meaning",
        ),
        (
            lambda file: file["quality_flag"].__setitem__((0, 0), 4096),
            "quality_flag has values without a meaning",
        ),
    ],
)
def test_each_fault_is_found(path, change, finding):
    assert finding in findings_after(path, change)


def test_text_in_another_type_is_found(path):
    found = findings_after(path, add_variable("cycles_counted_by_", "S1", ()))
    assert found == ["cycles_counted_by_ is not in the schema"]


def test_a_label_that_is_a_number_is_found(tmp_path):
    path = tmp_path / "a.nc"
    with netCDF4.Dataset(path, "w") as file:
        file.createDimension("specimen", 1)
        file.createDimension("specimen_strlen", 3)
        file.createVariable("specimen", "f8", ("specimen", "specimen_strlen"))
    assert "specimen is not text" in check_archive(path)
