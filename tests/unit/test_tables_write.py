"""Tables of a campaign: complete, explained, deterministic, whole."""

import csv
import shutil
from dataclasses import replace

import pytest
from experiments import ABOUT, screening_experiment, surface_experiment

from reduction.archive.csv_definitions import EXPERIMENT_TABLES, TABLES
from reduction.archive.csv_tables import (
    ENVELOPE_COLUMNS,
    STATIC_DYNAMIC_COLUMNS,
    write_tables,
)
from reduction.archive.shared_errors import SHARED, SHARED_OF_CHANNELS
from reduction.archive.surfaces_dataset import surfaces_to_dataset
from reduction.archive.write import write_archive
from reduction.quantities.names import QUANTITIES, RESPONSES, TEST_SCHEMA
from reduction.quantities.row import SUFFIXES
from reduction.record.errors import ArchiveError


def read(path):
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


@pytest.fixture(scope="session")
def surfaces(tmp_path_factory):
    """Archive of experiments of each kind."""
    path = tmp_path_factory.mktemp("surfaces") / "surfaces.nc"
    results = [
        surface_experiment(),
        surface_experiment("two lines", names=RESPONSES[:2], specimens=("a", "b"), missing=(3,)),
        screening_experiment(),
    ]
    write_archive(surfaces_to_dataset(results, origin=ABOUT), path)
    return path


@pytest.fixture(scope="session")
def tables(archives, surfaces, tmp_path_factory):
    """Tables of one archive of each kind, to be read."""
    folder = tmp_path_factory.mktemp("tables")
    write_tables(archives, folder, surfaces=surfaces)
    return folder


@pytest.fixture
def folder(tables, tmp_path):
    """The same, to be changed."""
    return shutil.copytree(tables, tmp_path / "tables")


def test_a_campaign_with_everything_fills_every_table(tables):
    names = {table.name for table in (*TABLES, *EXPERIMENT_TABLES)}
    names |= {"envelope", "static_dynamic", "columns"}
    assert {path.stem for path in tables.iterdir()} == names


def test_the_paths_given_back_are_the_files(archives, tmp_path):
    paths = write_tables(archives, tmp_path / "tables")
    assert sorted(paths) == sorted((tmp_path / "tables").iterdir())


def test_moduli_and_cycles_have_what_the_contract_names(tables):
    moduli = set(read(tables / "moduli.csv")[0])
    assert {
        "test", "specimen", "branch", "segment", "segment_tension_low [N]",
        "segment_tension_high [N]", "segment_strain_low [1]", "segment_strain_high [1]",
        "segment_modulus [Pa]", "n_cycles", "strain_method",
    } <= moduli  # fmt: skip
    assert {
        "test", "specimen", "cycle", "frequency [Hz]", "mean_tension [N]", "tension_amplitude [N]",
        "mean_strain [1]", "strain_amplitude [1]", "peak_tension [N]", "valley_tension [N]",
        "apparent_spring_constant [N]", "hysteresis_energy [J m-1]", "loss_factor [1]",
        "storage_spring_constant [N]", "loss_spring_constant [N]",
    } <= set(read(tables / "cycles.csv")[0])  # fmt: skip


def test_every_column_of_every_table_is_explained(tables):
    explained = {(row["table"], row["column"]): row for row in read(tables / "columns.csv")}
    for path in tables.iterdir():
        with path.open(encoding="utf-8", newline="") as file:
            header = next(csv.reader(file))
        assert len(header) == len(set(header))
        for place, column in enumerate(header):
            row = explained.pop((path.name, column))
            assert row["meaning"]
            name = column.partition(" [")[0]
            follower = header[place + 1] if place + 1 < len(header) else ""
            has_uncertainty = follower.startswith(f"{name}_standard_uncertainty [")
            assert has_uncertainty != bool(row["no_uncertainty"]), (path.name, column)
            if " [" in column:
                assert row["unit"] == column.partition(" [")[2].removesuffix("]")
    assert not explained


def test_every_column_is_a_quantity_of_the_vocabulary():
    for columns in [
        *(table.columns for table in (*TABLES, *EXPERIMENT_TABLES)), ENVELOPE_COLUMNS, STATIC_DYNAMIC_COLUMNS,
    ]:  # fmt: skip
        for column in columns:
            suffix = next((one for one in SUFFIXES if column.name.endswith(one)), "")
            names = {column.name, column.name.removesuffix(suffix)}
            assert names & set(QUANTITIES) or column.name == "branch"


def test_every_number_of_an_archive_but_the_samples_is_in_a_table():
    sources = {column.variable.name for table in TABLES for column in table.columns}
    elsewhere = {
        # samples and what only serves to find them
        "sample", "branch_first_sample", "branch_last_sample", "cycle_first_sample",
        "cycle_last_sample", "crosshead_rate", "tension_rate", "position_band", "tension_band",
        "cycles_counted_by", "strain_window",
        # as two columns
        "chord_modulus", "strain_bin_bounds", "first_loading_strain_bin_bounds",
        # in the archive alone
        "strain_coefficient_correlation", "coefficient_name", "coefficient_name_other",
        "tangent_modulus_by_cycle", "selected_cycle", "elastomer_parameter_fit",
        "crosshead_position_standard_uncertainty", "crosshead_displacement_standard_uncertainty",
        "tension_standard_uncertainty", "diameter_reading", "stretched_diameter",
        "stretched_diameter_strain", "standstill_position_tolerance", "slack_tension",
        "hold_tension_tolerance",
        *(f"{name}_uncertainty_contribution" for name in SHARED_OF_CHANNELS),
        # what an error does to each place of a curve
        *(f"{name}_uncertainty_contribution" for name, dims in SHARED.items()
          if {"strain_bin", "first_loading_strain_bin", "ratio_strain_bin", "hold_time", "tension_grid"} & set(dims)),
    }  # fmt: skip
    missing = {
        name
        for name, row in TEST_SCHEMA.items()
        if "sample" not in row.dims and not name.endswith("_standard_uncertainty")
    } - sources
    assert missing <= elsewhere


def test_tests_stand_in_the_order_of_their_history(bare_test, write, tmp_path):
    paths = []
    for name, order in (("T-10", None), ("T-3", 2), ("T-2", None), ("T-9", 1)):
        about = replace(bare_test.description, test_id=name, order=order)
        paths.append(write(replace(bare_test, description=about)))
    write_tables(paths, tmp_path / "tables")
    rows = read(tmp_path / "tables" / "trend.csv")
    assert [row["test"] for row in rows] == ["T-9", "T-3", "T-2", "T-10"]


def test_the_order_of_the_archives_changes_no_byte(archives, surfaces, tables, tmp_path):
    write_tables(archives[::-1], tmp_path / "again", surfaces=surfaces)
    first, again = (
        {path.name: path.read_bytes() for path in folder.iterdir()}
        for folder in (tables, tmp_path / "again")
    )
    assert first
    assert first == again


def test_a_table_without_rows_is_not_written_and_a_stale_one_is_removed(
    folder, holds_only_test, write
):
    (folder / "notebook.csv").write_text("not ours")
    write_tables([write(holds_only_test)], folder)
    assert {path.name for path in folder.iterdir()} == {
        "columns.csv", "notebook.csv", "notes.csv", "relaxation.csv", "relaxation_times.csv",
        "rows.csv", "specimens.csv",
    }  # fmt: skip


def test_a_failed_run_keeps_the_tables_of_the_last_one(folder, tmp_path):
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    with pytest.raises(ArchiveError, match="there is no archive"):
        write_tables([tmp_path / "gone.nc"], folder)
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before


def test_a_note_that_looks_like_a_formula_is_escaped(tables):
    notes = [row["note"] for row in read(tables / "notes.csv")]
    assert "'=1+1 looks like a formula" in notes


def test_synthetic_rows_say_so(tables):
    assert {(row["test"], row["synthetic"]) for row in read(tables / "notes.csv")} >= {
        ("T-1", "yes"),
        ("static", "no"),
    }
