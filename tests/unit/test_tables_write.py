"""Tables of a campaign: complete, explained, deterministic, whole."""

import csv
import shutil
import tracemalloc
from contextlib import ExitStack
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from csvrows import csv_rows
from experiments import ABOUT, screening_experiment, surface_experiment
from table_cells import table_rows, text_of_columns

from reduction.archive.csv_columns import (
    SYNTHETIC,
    CsvColumn,
    TableFile,
    _shown_values,
    column_blocks,
    column_descriptions,
    csv_text,
    table_blocks,
    uncertainty_of,
)
from reduction.archive.csv_definitions import EXPERIMENT_TABLES, TABLES
from reduction.archive.csv_tables import (
    ENVELOPE_COLUMNS,
    STATIC_DYNAMIC_COLUMNS,
    _by_response,
    _Curve,
    _envelope_rows,
    _on_grid,
    _Slope,
    _static_dynamic_rows,
    table_of,
    write_tables,
)
from reduction.archive.dataset_builder import SCHEMA_VERSION
from reduction.archive.open import open_archive
from reduction.archive.shared_errors import SHARED, SHARED_OF_CHANNELS
from reduction.archive.surfaces_dataset import surfaces_to_dataset
from reduction.archive.test_dataset import to_dataset
from reduction.archive.write import write_archive
from reduction.quantities.names import QUANTITIES, RESPONSES, TEST_SCHEMA
from reduction.quantities.row import SUFFIXES
from reduction.record.contributions import Component, Contributions
from reduction.record.errors import ArchiveError, SettingsError


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
    moduli = set(csv_rows(tables / "moduli.csv")[0])
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
    } <= set(csv_rows(tables / "cycles.csv")[0])  # fmt: skip


def test_every_column_of_every_table_is_explained(tables):
    explained = {(row["table"], row["column"]): row for row in csv_rows(tables / "columns.csv")}
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
    rows = csv_rows(tmp_path / "tables" / "trend.csv")
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
    notes = [row["note"] for row in csv_rows(tables / "notes.csv")]
    assert "'=1+1 looks like a formula" in notes


def test_synthetic_rows_say_so(tables):
    assert {(row["test"], row["synthetic"]) for row in csv_rows(tables / "notes.csv")} >= {
        ("T-1", "yes"),
        ("static", "no"),
    }


# tables written block by block: the same bytes, in bounded memory

N_CYCLES = 30000
PER_CYCLE = ("mean_tension", "tension_amplitude", "loss_factor", "hysteresis_energy")


def text_of(archive, table, block_rows):
    blocks = list(column_blocks(archive, archive.variables, table, block_rows=block_rows))
    assert all(0 < len(place) <= block_rows for place, _ in blocks)
    return "".join(text_of_columns(*columns) for _, columns in blocks)


@pytest.mark.parametrize(
    "block_rows",
    [1, 7, *(pytest.param(number, marks=pytest.mark.nightly) for number in (2, 3, 40))],
)
def test_tables_of_tests_are_the_same_for_blocks_of_any_size(archives, block_rows):
    n_filled = 0
    for path in archives:
        with open_archive(path) as archive:
            for table in TABLES:
                whole = text_of(archive, table, 10**9)
                assert text_of(archive, table, block_rows) == whole, table.name
                n_filled += bool(whole)
    assert n_filled > len(TABLES)


@pytest.mark.parametrize("block_rows", [pytest.param(1, marks=pytest.mark.nightly), 5, 64])
def test_tables_of_experiments_are_the_same_for_blocks_of_any_size(block_rows):
    results = [surface_experiment(), screening_experiment()]
    dataset = _by_response(surfaces_to_dataset(results, origin=ABOUT))
    for table in EXPERIMENT_TABLES:
        assert text_of(dataset, table, block_rows) == text_of(dataset, table, 10**9), table.name


@pytest.fixture
def long_archive(tmp_path):
    """An archive that holds nothing but numbers of many cycles."""
    rng = np.random.default_rng(3)
    names = [f"{name}{suffix}" for name in PER_CYCLE for suffix in ("", "_standard_uncertainty")]
    dataset = xr.Dataset(
        {name: (("specimen", "cycle"), rng.random((2, N_CYCLES))) for name in names},
        coords={"specimen": ["new", "used"], "cycle": np.arange(1, N_CYCLES + 1)},
        attrs={"schema_version": SCHEMA_VERSION, "test": "long", "synthetic": "yes"},
    )
    path = tmp_path / "long.nc"
    dataset.to_netcdf(path, engine="netcdf4")
    return path


@pytest.mark.nightly
def test_a_table_of_many_cycles_takes_the_memory_of_a_few_blocks(long_archive, tmp_path):
    write_tables([long_archive], tmp_path / "warm")  # what stays is made before it is measured
    tracemalloc.start()
    write_tables([long_archive], tmp_path / "tables")
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    written = (tmp_path / "tables" / "cycles.csv").stat().st_size
    assert written > 12e6
    assert peak < 12e6
    lines = (tmp_path / "tables" / "cycles.csv").read_bytes().split(b"\r\n")
    assert len(lines) == 2 * N_CYCLES + 2


def test_blocks_read_no_more_of_an_archive_than_their_rows(long_archive):
    (cycles,) = (table for table in TABLES if table.name == "cycles")
    with open_archive(long_archive) as archive:
        assert len(list(table_blocks(archive, cycles))) == 2 * -(-N_CYCLES // 4096)
        assert not any(archive[name].variable._in_memory for name in PER_CYCLE)


def test_a_table_of_an_archive_is_that_of_its_file(archives, tmp_path):
    with open_archive(archives[-1]) as archive:
        write_tables(archives[-1:], tmp_path)
        written = pd.read_csv(tmp_path / "cycles.csv")
        pd.testing.assert_frame_equal(table_of(archive, "cycles"), written, check_dtype=False)
        assert table_of(archive, "stepwise").empty
        with pytest.raises(SettingsError, match="found 'cycle'; needed one of .*cycles"):
            table_of(archive, "cycle")


# cells and headers of the tables


def test_a_real_has_its_unit_in_the_header_and_a_label_or_count_has_none():
    assert (
        CsvColumn("segment_modulus", TEST_SCHEMA["segment_modulus"]).header
        == "segment_modulus [Pa]"
    )
    assert CsvColumn("segment", TEST_SCHEMA["segment"]).header == "segment"
    assert CsvColumn("strain_method", TEST_SCHEMA["strain_method"]).header == "strain_method"


def test_a_measured_column_is_followed_by_its_uncertainty():
    column = uncertainty_of(CsvColumn("segment_modulus", TEST_SCHEMA["segment_modulus"]))
    assert column.header == "segment_modulus_standard_uncertainty [Pa]"


def test_a_number_comes_back_from_its_digits_exactly():
    numbers = [0.1, 1 / 3, 1e-300, 123456789.123456789, -0.0]
    text = csv_text(["x [1]"], [[cell] for cell in numbers])
    assert [float(line) for line in text.split("\r\n")[1:-1]] == numbers


def test_what_is_not_known_is_an_empty_field():
    assert text_of_columns(np.array([1.5, np.nan]), ["a", "b"]) == "1.5,a\r\n,b\r\n"


def test_a_count_is_written_without_a_point():
    assert text_of_columns(np.array([3], dtype=np.int32)) == "3\r\n"


def test_flags_are_written_in_words():
    branches = _shown_values(np.array([1, 2, 7]), TEST_SCHEMA["branch"])
    assert list(branches) == ["ascending", "descending", "7"]
    flags = _shown_values(np.array([0, 33]), TEST_SCHEMA["quality_flag"])
    assert list(flags) == ["", "missing spike"]


def test_a_table_of_columns_is_that_of_its_rows():
    labels = ["=1+1", 'a "b", c', "d\ne", "f\rg", "", " h", "größe", "'i"]
    rows = [[label, 0.1 * place, None] for place, label in enumerate(labels)]
    text = text_of_columns(
        _shown_values(np.array(labels), QUANTITIES["test"]),
        np.array([row[1] for row in rows]),
        [None] * len(rows),
    )
    assert csv_text(["a", "b", "c"], rows) == f"a,b,c\r\n{text}"


@pytest.mark.parametrize("start", ["=", "+", "-", "@", "\t", "\r"])
def test_text_that_a_spreadsheet_would_run_is_escaped(start):
    text = csv_text(["note"], [[f"{start}cmd"], ["plain = text"]])
    assert f"'{start}cmd" in text
    assert "plain = text" in text
    assert "'plain" not in text


def test_a_negative_number_is_not_taken_for_a_formula():
    assert csv_text(["x"], [[-1.5]]) == "x\r\n-1.5\r\n"


def test_text_with_commas_quotes_and_line_ends_is_quoted():
    assert csv_text(["note"], [['a "b", c\nd']]) == 'note\r\n"a ""b"", c\nd"\r\n'


def test_a_label_says_why_it_has_no_uncertainty():
    assert CsvColumn("test", QUANTITIES["test"]).description == ["test", "", "test", "label"]
    assert CsvColumn("segment_modulus", TEST_SCHEMA["segment_modulus"]).description == [
        "segment_modulus [Pa]",
        "Pa",
        "modulus of the straight-line segment",
        "",
    ]


# why a cell of a table is empty beside a number


def _lonely(columns, path, diameters):
    with ExitStack() as whole:
        table = TableFile(path, columns, whole)
        table.add_columns([np.array(diameters), np.array([np.nan, 1e-4]), ["no", "no"]])
        return table.lonely


def test_an_empty_cell_beside_a_number_has_a_reason_and_a_full_column_needs_none(tmp_path):
    diameter = CsvColumn("diameter", QUANTITIES["diameter"])
    columns = [diameter, uncertainty_of(diameter), SYNTHETIC]
    holed = _lonely(columns, tmp_path / "holed.csv", [0.02, 0.02])
    full = _lonely(columns, tmp_path / "full.csv", [np.nan, 0.02])
    assert (holed, full) == ({1}, set())
    (_, of_holed, _) = column_descriptions(columns, holed)
    assert of_holed[-1] == (
        "is an uncertainty; empty where there is one reading, and nothing is stated of it"
    )
    (_, of_full, _) = column_descriptions(columns, full)
    assert of_full[-1] == "is an uncertainty"


# rows of a table hold the numbers of the archive, each in its place

BY_NAME = {table.name: table for table in TABLES}


def rows_of(test, name):
    """Rows as dicts, and the dataset they come from."""
    dataset = to_dataset(test, version="1.2.3", command="reduction run")
    table = BY_NAME[name]
    columns = [column.name for column in table.columns]
    return [dict(zip(columns, row, strict=True)) for row in table_rows(dataset, table)]


def test_a_segment_that_a_branch_does_not_have_has_no_row(rich_test):
    rows = rows_of(rich_test, "moduli")
    assert len(rows) == 2 * 2 * 3 - 1
    last = rows[-1]
    assert (last["test"], last["specimen"], last["branch"], last["segment"]) == (
        "T-1", "used", "descending", 2,
    )  # fmt: skip
    assert last["segment_modulus"] == rich_test.segments.segment_modulus[1, 1, 1]
    shared = rich_test.contributions.values["segment_modulus"][:, 1, 1, 1]
    random = rich_test.segments.segment_modulus_standard_uncertainty[1, 1, 1]
    assert last["segment_modulus_standard_uncertainty"] == pytest.approx(
        np.sqrt(random**2 + np.sum(shared**2))
    )
    assert last["n_cycles"] == 4
    assert last["strain_method"] == "tension-driven"
    assert last["synthetic"] == "yes"


def test_every_cycle_of_every_specimen_has_a_row(rich_test):
    rows = rows_of(rich_test, "cycles")
    assert [(row["specimen"], row["cycle"]) for row in rows] == [
        (specimen, cycle) for specimen in ("new", "used") for cycle in (1, 2, 3, 4)
    ]
    assert rows[5]["loss_factor"] == rich_test.loops.loss_factor[1, 1]
    assert (
        rows[5]["loss_factor_standard_uncertainty"]
        == rich_test.loops.uncertainty["loss_factor"][1, 1]
    )


def test_a_bin_keeps_its_edges_and_its_untrimmed_modulus(rich_test):
    row = rows_of(rich_test, "tangent_modulus")[0]
    low, high = rich_test.curves.strain_bin_bounds[0]
    assert (row["strain_bin_low"], row["strain_bin_high"]) == (low, high)
    assert row["tangent_modulus"] is None
    assert row["tangent_modulus_untrimmed"] == rich_test.curves.tangent_modulus_untrimmed[0, 0, 0]


def test_each_parameter_of_a_law_has_a_row_with_what_is_said_of_the_law(rich_test):
    rows = rows_of(rich_test, "elastomer")
    assert [row["elastomer_parameter_name"] for row in rows] == [
        "shear_modulus", "modulus_1", "exponent_1",
    ]  # fmt: skip
    assert [row["elastomer_law"] for row in rows] == ["neo-hookean", "ogden-2", "ogden-2"]
    assert [row["elastomer_is_stable"] for row in rows] == ["yes", "no", "no"]
    assert rows[2]["elastomer_exponent"] == 1.4
    assert rows[2]["elastomer_modulus"] is None


def test_a_stepwise_reading_names_its_specimen_and_its_flags(stepwise_test):
    rows = rows_of(stepwise_test, "stepwise")
    assert [row["clock"] for row in rows] == ["1130", "1140", "1205"]
    assert {row["specimen"] for row in rows} == {"tether"}
    assert [row["branch"] for row in rows] == ["ascending", "ascending", "descending"]
    assert rows[1]["step_flag"] == "length_and_elongation_disagree creep"
    assert rows[0]["relaxed_gauge_length"] == 0.1556


def test_an_interval_without_a_slope_has_no_row(stepwise_test):
    rows = rows_of(stepwise_test, "stepwise_moduli")
    assert len(rows) == 1
    assert rows[0]["interval_modulus"] == 8e5
    assert rows[0]["interval_branch"] == "descending"


def test_a_hold_keeps_the_reason_of_its_refusal(rich_test):
    rows = rows_of(rich_test, "relaxation")
    assert (
        rows[1]["hold_refusal"]
        == "Prony series not given: the hold lasts 25 s; rate not given: too short"
    )
    assert [row["specimen"] for row in rows] == ["new", "used", "new"]
    assert len(rows_of(rich_test, "prony")) == 4


def test_slips_that_were_not_found_show_in_the_trend_table(bare_test):
    assert rows_of(bare_test, "slips") == []
    assert rows_of(bare_test, "trend")[0]["n_slips"] == 0


def test_rows_of_the_log_are_accounted_for(rich_test):
    rows = rows_of(rich_test, "rows")
    spikes = [row for row in rows if row["quality_mask"] == "spike"]
    assert [row["n_flagged"] for row in spikes] == [0, 1, 0]
    assert {(row["n_rows_read"], row["n_rows_kept"]) for row in rows} == {(61, 60)}


@pytest.mark.parametrize("table", TABLES, ids=lambda table: table.name)
def test_an_archive_without_the_subject_gives_no_row(table, holds_only_test):
    dataset = to_dataset(holds_only_test, version="1", command="reduction run")
    rows = table_rows(dataset, table)
    assert bool(rows) == (
        table.name in {"relaxation", "relaxation_times", "specimens", "notes", "rows"}
    )


def test_a_table_has_as_many_cells_as_columns(rich_test):
    dataset = to_dataset(rich_test, version="1", command="reduction run")
    filled = {table: rows for table in TABLES if (rows := table_rows(dataset, table))}
    assert len(filled) > len(TABLES) // 2
    for table, rows in filled.items():
        assert {len(row) for row in rows} == {len(table.columns)}


# A step has one static stiffness and one creep: of its last pair, and of its longest hold

(PROGRAMME,) = (table for table in TABLES if table.name == "rope_programme")


def cells(**variables):
    dataset = xr.Dataset(
        {"programme_step": ((), "step"), **variables}, coords={"specimen": ["a", "b"]},
        attrs={"test": "T"},
    )  # fmt: skip
    header = [column.name for column in PROGRAMME.columns]
    return [dict(zip(header, row, strict=True)) for row in table_rows(dataset, PROGRAMME)]


def test_the_last_pair_that_has_a_stiffness_stands_for_the_step():
    first, second = cells(
        held_pair_specimen=("held_pair", ["a", "a", "a"]),
        static_stiffness=("held_pair", [1.0, 2.0, np.nan]),
        held_pair_low_tension=("held_pair", [10.0, 20.0, 30.0]),
    )
    assert (first["static_stiffness"], first["held_pair_low_tension"]) == (2.0, 20.0)
    assert second["static_stiffness"] is None
    assert second["programme_step"] == "step"


def test_the_longest_hold_stands_for_the_step():
    first, second = cells(
        hold_specimen=("hold", ["a", "b", "a", "b"]),
        hold_duration=("hold", [600.0, 600.0, 60.0, 60.0]),
        creep_rate_per_decade=("hold", [0.1, 0.2, 0.3, 0.4]),
    )
    assert (first["creep_rate_per_decade"], second["creep_rate_per_decade"]) == (0.1, 0.2)


def test_a_test_that_is_no_step_has_no_row():
    dataset = xr.Dataset(coords={"specimen": ["a"]})
    assert table_rows(dataset, PROGRAMME) == []


# the envelope over all tests, on one strain grid


def curve(test, strain, modulus, *, specimen="new", width=0.1, synthetic="no"):
    return _Curve(
        test=test,
        specimen=specimen,
        branch="ascending",
        synthetic=synthetic,
        strain=np.asarray(strain),
        width=width,
        modulus=np.asarray(modulus, dtype=float),
        uncertainty=np.full(len(strain), 2.0),
    )


def test_a_straight_line_stays_a_straight_line():
    strain = np.arange(0.05, 1.0, 0.1)
    grid = np.array([0.05, 0.1, 0.33, 0.95])
    modulus, uncertainty = _on_grid(curve("T-1", strain, 3 + 4 * strain), grid)
    np.testing.assert_allclose(modulus, 3 + 4 * grid, rtol=1e-14)
    np.testing.assert_allclose(uncertainty, 2.0)


def test_nothing_is_extrapolated_and_no_gap_is_bridged():
    strain = np.array([0.05, 0.15, 0.25, 0.35, 0.45])
    modulus, _ = _on_grid(
        curve("T-1", strain, [1, 2, np.nan, 4, 5]), np.array([0.0, 0.1, 0.2, 0.3, 0.4, 0.5])
    )
    assert np.isfinite(modulus).tolist() == [False, True, False, False, True, False]


def test_a_bin_centre_that_is_off_by_rounding_keeps_its_value():
    modulus, _ = _on_grid(
        curve("T-1", [0.1, 0.2, 0.3], [1, 2, 3]), np.array([0.1 - 1e-16, 0.3 + 1e-16])
    )
    assert modulus.tolist() == [1.0, 3.0]


def test_a_curve_without_a_number_has_none_on_the_grid():
    modulus, uncertainty = _on_grid(curve("T-1", [0.1, 0.2], [np.nan, np.nan]), np.array([0.1]))
    assert np.isnan(modulus).all()
    assert np.isnan(uncertainty).all()


def test_the_envelope_names_the_tests_that_make_it():
    rows = _envelope_rows(
        [
            curve("T-1", [0.1, 0.2, 0.3], [5, 6, 7]),
            curve("T-2", [0.2, 0.3, 0.4], [9, 1, 2], synthetic="yes"),
            curve("T-1", [0.1], [50], specimen="used"),
        ]
    )
    assert rows == [
        ["new", "ascending", 0.1, 5.0, 2.0, "T-1", 5.0, 2.0, "T-1", 1, "yes"],
        ["new", "ascending", 0.2, 6.0, 2.0, "T-1", 9.0, 2.0, "T-2", 2, "yes"],
        ["new", "ascending", 0.3, 1.0, 2.0, "T-2", 7.0, 2.0, "T-1", 2, "yes"],
        ["new", "ascending", 0.4, 2.0, 2.0, "T-2", 2.0, 2.0, "T-2", 1, "yes"],
        ["used", "ascending", 0.1, 50.0, 2.0, "T-1", 50.0, 2.0, "T-1", 1, "no"],
    ]


def test_the_widest_bins_make_the_grid():
    fine = curve("T-1", np.arange(0.05, 1.0, 0.05), np.arange(19), width=0.05)
    wide = curve("T-2", [0.3, 0.5, 0.7], [1, 1, 1], width=0.2)
    strains = [row[2] for row in _envelope_rows([fine, wide])]
    assert strains == pytest.approx([0.1, 0.3, 0.5, 0.7, 0.9])


def test_a_campaign_without_curves_has_no_envelope():
    assert _envelope_rows([]) == []


# static slopes beside dynamic curves: one branch, one strain, nothing extrapolated


def curve_of_comparison(branch="ascending", gap=None):
    strain = np.arange(0.5, 1.55, 0.1)
    modulus = 1e6 * strain
    if gap is not None:
        modulus[gap] = np.nan
    return _Curve("T-2", "new", branch, "yes", strain, 0.1, modulus, 0.02 * modulus)


def slope(strain, branch="ascending", modulus=5e5):
    return _Slope("static", "short", branch, "no", strain, modulus, 0.01 * modulus)


def rows_of_table(slopes, curves):
    names = [column.name for column in STATIC_DYNAMIC_COLUMNS]
    found = _static_dynamic_rows(slopes, curves)
    return [dict(zip(names, row, strict=True)) for row in found]


def test_the_ratio_is_static_over_dynamic_at_the_strain_of_the_slope():
    (row,) = rows_of_table([slope(0.75)], [curve_of_comparison()])
    assert row["tangent_modulus"] == pytest.approx(7.5e5)
    assert row["static_dynamic_ratio"] == pytest.approx(2 / 3)
    assert row["static_dynamic_ratio_standard_uncertainty"] == pytest.approx(
        2 / 3 * np.hypot(0.01, 0.02)
    )
    assert (row["static_test"], row["test"], row["synthetic"]) == ("static", "T-2", "yes")


def test_slopes_stand_beside_their_own_branch_alone():
    found = rows_of_table(
        [slope(0.8), slope(0.9, "descending")],
        [curve_of_comparison(), curve_of_comparison("descending")],
    )
    assert [(row["branch"], row["interval_strain"]) for row in found] == [
        ("ascending", 0.8), ("descending", 0.9),
    ]  # fmt: skip


def test_outside_the_curve_and_in_a_gap_of_it_there_is_no_row():
    assert rows_of_table([slope(0.4), slope(1.6), slope(1.0)], [curve_of_comparison(gap=5)]) == []


def test_without_stepwise_or_cyclic_tests_there_is_no_table():
    assert (
        _static_dynamic_rows([], [curve_of_comparison()])
        == _static_dynamic_rows([slope(1.0)], [])
        == []
    )


CELL, TAPE, DIAMETER = (
    Component("tension_gain", "A"), Component("gauge_length", "short"),
    Component("diameter", "short"),
)  # fmt: skip


def test_what_static_and_dynamic_share_cancels_and_the_rest_does_not():
    """One cell of 5 % in both, one diameter, a tape in the static one, scatter of 1 and 2 %."""
    bare = curve_of_comparison()
    rows = np.array([0.05, -0.02])[:, None] * bare.modulus
    dynamic = replace(
        bare,
        uncertainty=np.sqrt(0.05**2 + 0.02**2 + 0.02**2) * bare.modulus,
        shared=Contributions((CELL, DIAMETER), {"tangent_modulus": rows}),
    )
    static = replace(
        slope(0.75),
        uncertainty=5e5 * np.sqrt(0.05**2 + 0.02**2 + 0.03**2 + 0.01**2),
        shared={CELL: 0.05 * 5e5, DIAMETER: -0.02 * 5e5, TAPE: 0.03 * 5e5},
    )
    (row,) = rows_of_table([static], [dynamic])
    expected = np.sqrt(0.03**2 + 0.01**2 + 0.02**2)
    ratio = row["static_dynamic_ratio"]
    assert row["static_dynamic_ratio_standard_uncertainty"] / ratio == pytest.approx(expected)
    # another cell is another error
    other = replace(static, shared={Component("tension_gain", "B"): 0.05 * 5e5})
    (row,) = rows_of_table([other], [dynamic])
    apart = np.sqrt(0.05**2 + 0.02**2 + 0.02**2 + 0.05**2 + 0.02**2 + 0.03**2 + 0.01**2)
    assert row["static_dynamic_ratio_standard_uncertainty"] / ratio == pytest.approx(apart)


def test_a_slope_without_an_uncertainty_leaves_that_of_the_ratio_empty():
    bare = _Slope("static", "short", "ascending", "no", 0.8, 5e5, float("nan"))
    (row,) = rows_of_table([bare], [curve_of_comparison()])
    assert row["static_dynamic_ratio"] == pytest.approx(0.625)
    assert row["interval_modulus_standard_uncertainty"] is None
    assert row["static_dynamic_ratio_standard_uncertainty"] is None


# numbers are written as Python writes them, whatever their size

RNG = np.random.default_rng(20)
SIZES = 10.0 ** np.arange(-8, 20)
NUMBERS = {
    "of any bits": RNG.integers(0, 2**63, 20000, dtype=np.int64).view(np.float64),
    "of sizes that occur": RNG.normal(size=20000) * RNG.choice(SIZES, 20000),
    "of few digits": np.round(RNG.normal(size=20000) * RNG.choice(SIZES[8:14], 20000), 3),
    "whole": RNG.integers(-(10**9), 10**9, 20000).astype(float),
    "at powers of ten": np.concatenate(
        [SIZES, np.nextafter(SIZES, 0), np.nextafter(SIZES, np.inf), -SIZES]
    ),
    "special": np.array([0.0, -0.0, np.inf, -np.inf, 5e-324, 1.7976931348623157e308, 2.0**53]),
}


@pytest.mark.parametrize("name", NUMBERS)
def test_a_number_is_written_as_python_writes_it(name):
    numbers = NUMBERS[name][~np.isnan(NUMBERS[name])]
    lines = text_of_columns(numbers).split("\r\n")[:-1]
    assert lines == [repr(number) for number in numbers.tolist()]
