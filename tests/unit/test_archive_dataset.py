"""A reduced test becomes a dataset, a file, and the same dataset again."""

import hashlib
import os
import subprocess
import sys
from dataclasses import replace

import netCDF4
import numpy as np
import pytest
import xarray as xr
from compliance_checker.runner import CheckSuite, ComplianceChecker

from reduction.archive.dataset import to_dataset
from reduction.archive.open import open_archive
from reduction.archive.schema import SCHEMA, schema_of
from reduction.errors import ArchiveError


def build(test):
    return to_dataset(test, version="1.2.3", command="reduction run")


def test_every_kind_of_product_comes_back_as_it_was(any_test, write):
    dataset = build(any_test)
    with open_archive(write(any_test)) as back:
        xr.testing.assert_identical(dataset, back.load())


def test_the_rich_test_fills_every_variable_that_a_log_can_have(rich_test, bare_test):
    filled = set(build(rich_test).variables) | set(build(bare_test).variables)
    steps = {name for name, row in SCHEMA.items() if {"step", "interval"} & set(row.dims)}
    alternatives = {
        # another datum, control or strain method than that of the examples
        "tension_band", "tension_rate", "measured_strain", "free_fraction", "reference_position",
        "free_length_intercept", "free_length_slope", "splice_strain_ratio", "strain_gauge_length",
        "relaxed_gauge_length",
    }  # fmt: skip
    missing = {
        name.removesuffix("_standard_uncertainty") for name in set(SCHEMA) - filled - steps
    }
    assert missing <= alternatives
