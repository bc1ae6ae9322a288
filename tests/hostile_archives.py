"""Archives that mean harm: each is a function that changes a copy of a good one."""

import json

import h5py
import netCDF4
import numpy as np


def _changed(path, change):
    with netCDF4.Dataset(path, "a") as dataset:
        change(dataset)


def _attribute(path, name, value):
    _changed(path, lambda dataset: dataset.setncattr(name, value))


def _other(path, name, make):
    """Take a variable out and put another in its place."""
    with h5py.File(path, "a") as file:
        scales = [s.name for d in file[name].dims for s in d.values()] if name in file else []
        del file[name]
        make(file, scales)


def strain_is_text(path):
    _other(path, "strain", lambda file, _: file.create_dataset("strain", data=[b"a", b"b"]))


def strain_is_gone(path):
    _other(path, "strain", lambda file, _: None)


def moduli_are_gone(path):
    with h5py.File(path, "a") as file:
        for name in [name for name in file if "modul" in name]:
            del file[name]


def strain_bins_are_text(path):
    _other(path, "strain_bin", lambda file, _: file.create_dataset("strain_bin", data=[b"x"] * 40))


def a_huge_dimension(path):
    def change(dataset):
        dataset.createDimension("huge", 10**12)
        dataset.createVariable("huge", "f8", ("huge",), chunksizes=(1 << 20,))

    _changed(path, change)


def tension_is_huge(path):
    def make(file, _):
        file.create_dataset("tension", shape=(2, 10**12), dtype="f8", chunks=(1, 1 << 20))

    _other(path, "tension", make)


def coordinates_are_nan(path):
    def change(dataset):
        for name in ("strain_bin", "cycle", "sample"):
            if name in dataset.variables:
                variable = dataset.variables[name]
                variable[:] = np.nan if variable.dtype.kind == "f" else -1

    _changed(path, change)


def every_number_is_nan(path):
    def change(dataset):
        for variable in dataset.variables.values():
            if variable.dtype != str and variable.dtype.kind == "f":
                variable[...] = np.nan

    _changed(path, change)


def settings_are_no_json(path):
    _attribute(path, "settings", "{[[")


def settings_are_a_number(path):
    _attribute(path, "settings", 7.0)


def settings_are_a_list(path):
    _attribute(path, "settings", "[1, 2]")


def settings_are_nested(path):
    _attribute(path, "settings", "[" * 100_000)


def settings_are_large(path):
    _attribute(path, "settings", json.dumps({"a": "x" * 100_000_000}))


def id_is_a_path(path):
    def change(dataset):
        dataset.setncattr("id", "../../../etc/passwd")
        dataset.setncattr("campaign", "../../..")
        dataset.setncattr("test", "../../T-1")

    _changed(path, change)


def id_is_markup(path):
    def change(dataset):
        for name in ("id", "test", "title", "summary", "institution"):
            dataset.setncattr(name, "<script>alert(1)</script>")

    _changed(path, change)


def schema_is_a_list(path):
    _attribute(path, "schema_version", [1, 2, 3])


def schema_of_tomorrow(path):
    _attribute(path, "schema_version", "999")


def attributes_are_numbers(path):
    def change(dataset):
        for name in ("id", "campaign", "test", "raw_file", "raw_file_sha256", "history", "title"):
            dataset.setncattr(name, 3.5)

    _changed(path, change)


def attributes_are_gone(path):
    def change(dataset):
        for name in dataset.ncattrs():
            if name != "schema_version":
                dataset.delncattr(name)

    _changed(path, change)


def units_are_absurd(path):
    def change(dataset):
        for variable in dataset.variables.values():
            if "units" in variable.ncattrs():
                variable.units = "9**9**9 parsecs"

    _changed(path, change)


def time_is_packed(path):
    def change(dataset):
        for variable in dataset.variables.values():
            if variable.dtype != str and variable.dtype.kind == "f":
                variable.setncattr("scale_factor", "a lot")

    _changed(path, change)


def strain_elsewhere(path):
    secret = path.with_name("secret.h5")
    with h5py.File(secret, "w") as file:
        file["strain"] = np.full((2, 100), 4711.0)

    def make(file, _):
        file["strain"] = h5py.ExternalLink(str(secret), "/strain")

    _other(path, "strain", make)


def strain_is_passwd(path):
    def make(file, _):
        file.create_dataset("strain", shape=(2, 50), dtype="u1", external=[("/etc/passwd", 0, 100)])

    _other(path, "strain", make)


def groups_in_a_loop(path):
    with h5py.File(path, "a") as file:
        group = file.create_group("one")
        group["root"] = file["/"]


def names_without_end(path):
    with h5py.File(path, "a") as file:
        for number in range(2000):
            file[f"v{number}"] = 1.0


def cut_in_half(path):
    data = path.read_bytes()
    path.write_bytes(data[: len(data) // 2])


def empty(path):
    path.write_bytes(b"")


def an_old_netcdf(path):
    """A classic file of which the header claims 2^31 records."""
    path.write_bytes(
        b"CDF\x01\x7f\xff\xff\xff" + b"\x00\x00\x00\x0a\x7f\xff\xff\xff" + b"\xff" * 200
    )


def nothing_of_the_kind(path):
    path.write_bytes(b"\x89HDF\r\n\x1a\n" + b"\xff" * 4000)


ARCHIVES = [
    strain_is_text, strain_is_gone, moduli_are_gone, strain_bins_are_text,
    a_huge_dimension, tension_is_huge, coordinates_are_nan, every_number_is_nan,
    settings_are_no_json, settings_are_a_number, settings_are_a_list, settings_are_nested,
    settings_are_large, id_is_a_path, id_is_markup, schema_is_a_list, schema_of_tomorrow,
    attributes_are_numbers, attributes_are_gone, units_are_absurd, time_is_packed,
    strain_elsewhere, strain_is_passwd, groups_in_a_loop, names_without_end, cut_in_half, empty,
    an_old_netcdf, nothing_of_the_kind,
]  # fmt: skip
