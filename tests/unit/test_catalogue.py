"""The catalogue says what the archives say, and names those that it lacks."""

import os
import shutil
import tracemalloc

import netCDF4
import numpy as np
import pandas as pd
import pyarrow.csv
import pyarrow.parquet
import pytest
import xarray as xr

from reduction.archive.dataset_builder import SCHEMA_VERSION
from reduction.archive.open import open_archive, reading
from reduction.batch import catalogue as file
from reduction.batch import catalogue_entries
from reduction.batch.catalogue import (
    CONDITIONS,
    FILE_NAME,
    Query,
    _shown_path,
    answer,
    campaigns_below,
    condition_of,
    load_catalogue,
    meaning_of,
    needed_quantities,
    quantities_there,
    unit_of,
    write_answer,
)
from reduction.batch.catalogue_entries import (
    LEFT_OUT,
    _kept_cycles,
    entry_of,
    rebuild,
    write_catalogue,
)
from reduction.quantities.names import QUANTITIES, STEPWISE_SCHEMA, TEST_SCHEMA
from reduction.record.errors import ArchiveError, SettingsError


def made(folder):
    """The catalogues of a folder, made of the archives that are there."""
    assert rebuild(folder) == {}
    return load_catalogue(folder)


def asked(index, **options):
    return answer(index, Query(**options)).to_pylist()


@pytest.fixture(scope="module")
def catalogued_once(archives, tmp_path_factory):
    """Two campaigns: every kind of test in one, the rich test alone in the other."""
    processed = tmp_path_factory.mktemp("two") / "processed"
    for campaign, paths in (("one", archives), ("two", archives[-1:])):
        (processed / campaign).mkdir(parents=True)
        for path in paths:
            shutil.copyfile(path, processed / campaign / path.name)
    made(processed)
    return processed


@pytest.fixture
def catalogued(catalogued_once, tmp_path):
    """The two campaigns and their catalogues, to be changed at will."""
    return shutil.copytree(catalogued_once, tmp_path / "processed")


@pytest.fixture
def folder(catalogued):
    """The two campaigns as runs left them before there were catalogues."""
    for path in catalogued.rglob(FILE_NAME):
        path.unlink()
    return catalogued


@pytest.fixture(scope="module")
def index(archives, tmp_path_factory):
    processed = tmp_path_factory.mktemp("processed")
    (processed / "one").mkdir()
    for path in archives:
        shutil.copyfile(path, processed / "one" / path.name)
    return made(processed)


def rename(path, **attributes):
    with netCDF4.Dataset(path, "a") as archive:
        archive.setncatts(attributes)


def test_every_specimen_of_every_test_is_a_row(index):
    rows = asked(index)
    assert [(row["test"], row["specimen"], row["test_kind"]) for row in rows] == [
        ("T-1", "new", "cyclic"),
        ("T-1", "used", "cyclic"),
        ("bare", "new", "cyclic"),
        ("hold", "new", "relaxation"),
        ("static", "tether", "stepwise"),
    ]
    assert {row["campaign"] for row in rows} == {"tmt"}
    assert [row["synthetic"] for row in rows] == ["yes", "yes", "no", "yes", "no"]
    assert list(rows[0]) == list(CONDITIONS)


def test_conditions_are_those_of_the_archive(index, rich_test):
    rows = asked(index, names={"test": ("T-1",)})
    for place, row in enumerate(rows):
        assert row["test_frequency"] == rich_test.amplitude.frequency[place]
        assert row["n_cycles"] == len(rich_test.cycles.first)
        reached = [rich_test.strain[place]]
        mean, half = rich_test.loops.mean_strain[place], rich_test.loops.strain_amplitude[place]
        reached += [mean - half, mean + half]
        assert row["least_strain"] == np.nanmin(np.concatenate(reached))
        assert row["greatest_strain"] == np.nanmax(np.concatenate(reached))


def test_every_number_of_an_archive_that_stands_on_its_specimens_is_there(index, archives):
    with open_archive(archives[-1]) as archive:
        names = [
            name
            for name in archive.data_vars
            if archive[name].dims == ("specimen",) and archive[name].dtype.kind == "f"
        ]
        wanted = {
            name: archive[name].to_numpy()[np.isfinite(archive[name].to_numpy())].tolist()
            for name in names
            if name in QUANTITIES
        }
    assert len(wanted) > 40
    for name, numbers in wanted.items():
        query = Query(names={"test": ("T-1",)}, quantity=(name,), by_cycle=True)
        found = answer(index, query)
        assert [one for one in found[name].to_pylist() if one is not None] == numbers, name


def test_a_number_comes_with_its_place_and_its_uncertainty(index, rich_test, archives):
    rows = asked(index, names={"test": ("T-1",)}, quantity=("segment_modulus",))
    modulus = rich_test.segments.segment_modulus
    assert len(rows) == np.isfinite(modulus).sum()
    with open_archive(archives[-1]) as archive:
        spread = archive["segment_modulus_standard_uncertainty"].to_numpy()
    for row in rows:
        at = (
            ["new", "used"].index(row["specimen"]),
            ["ascending", "descending"].index(row["branch_name"]),
            int(row["segment"]) - 1,
        )
        assert row["segment_modulus"] == modulus[at]
        assert row["segment_modulus_standard_uncertainty"] == spread[at]


def test_quantities_of_one_place_share_a_row_and_those_of_the_test_stand_beside(index, rich_test):
    rows = asked(
        index,
        names={"specimen": ("new",), "test": ("T-1",)},
        quantity=("tangent_modulus", "branch_tension", "loss_factor"),
    )
    first = next(row for row in rows if row["branch_name"] == "ascending")
    assert (
        first["tangent_modulus"] is None
    )  # as in the archive: the tension is known, not the slope
    assert first["branch_tension"] == rich_test.curves.branch_tension[0, 0, 0]
    assert {row["test_loss_factor"] for row in rows} == {rich_test.amplitude.loss_factor[0]}
    assert len(rows) == rich_test.curves.branch_tension[0].size


def test_a_quantity_of_the_cycles_is_its_mean_over_the_test_unless_cycles_are_asked_for(
    index, rich_test
):
    mean = asked(index, quantity=("apparent_spring_constant",))
    assert [row["test_apparent_spring_constant"] for row in mean] == list(
        rich_test.amplitude.apparent_spring_constant
    )
    each = asked(index, quantity=("apparent_spring_constant",), by_cycle=True)
    shown = [row["apparent_spring_constant"] for row in each if row["specimen"] == "used"]
    assert shown == list(rich_test.loops.apparent_spring_constant[1][[0, 1, 3]])
    assert [row["cycle"] for row in each if row["specimen"] == "used"] == [1, 2, 4]


def test_a_hold_is_of_its_specimen(index, rich_test):
    rows = asked(index, names={"test": ("T-1",)}, quantity=("relaxation_drop",))
    found = sorted((row["specimen"], row["relaxation_drop"]) for row in rows)
    assert found == sorted((one.specimen, one.relaxation_drop) for one in rich_test.holds)


def test_a_ratio_of_two_specimens_is_of_the_test(index):
    rows = asked(index, quantity=("modulus_ratio",))
    assert {row["specimen"] for row in rows} == {None}
    assert {row["comparison"] for row in rows} == {"new over used"}


def test_numbers_of_different_places_stand_in_rows_of_their_own(index):
    together = asked(index, quantity=("segment_modulus", "relaxation_drop", "relaxed_free_length"))
    for name in ("segment_modulus", "relaxation_drop"):
        alone = asked(index, quantity=(name,))
        assert sum(row[name] is not None for row in together) == len(alone)


@pytest.mark.parametrize(
    ("where", "tests"),
    [
        ("n_cycles = 4", {"T-1"}),
        ("n_cycles != 4", set()),
        ("test_kind = CYCLIC", {"T-1", "bare"}),
        ("test_kind != cyclic", {"hold", "static"}),
        ("frequency > 0 Hz", {"T-1"}),
        ("frequency < 0 Hz", set()),
        ("loss_factor >= 0", {"T-1"}),
        ("diameter = 25.7 mm", {"static"}),
        ("diameter <= 2 cm", {"bare"}),
    ],
)  # fmt: skip
def test_a_condition_leaves_the_tests_of_which_it_holds(index, where, tests):
    assert {row["test"] for row in asked(index, where=(condition_of(where),))} == tests


def test_a_share_of_the_break_strength_is_of_each_row(index, rich_test):
    strength = np.array([one.rated_break_strength for one in rich_test.specimens], float)
    share = rich_test.amplitude.mean_tension / strength
    between = condition_of(f"mean_tension >= {100 * (1 - 1e-9) * np.nanmean(share):.12f} %RBS")
    rows = asked(index, where=(between,))
    names = [one.name for one in rich_test.specimens]
    assert [row["specimen"] for row in rows] == [
        name for name, one in zip(names, share, strict=True) if one >= np.nanmean(share)
    ]


def test_conditions_on_places_and_order_hold_for_rows_of_numbers(index):
    rows = asked(
        index,
        quantity=("segment_modulus",),
        where=(condition_of("segment >= 2"), condition_of("branch_name = descending")),
        sort=("segment_modulus",),
        descending=True,
        limit=3,
    )
    assert {row["branch_name"] for row in rows} == {"descending"}
    assert len(rows) == 3 and min(row["segment"] for row in rows) >= 2
    numbers = [row["segment_modulus"] for row in rows]
    assert numbers == sorted(numbers, reverse=True)


def test_names_are_patterns_and_words_begin_words(index):
    assert {row["test"] for row in asked(index, names={"test": ("t-*", "HOLD")})} == {"T-1", "hold"}
    texts = {row["specimen_material"] for row in asked(index)} - {None, ""}
    for text in texts:
        start = text.split()[0][:3]
        found = asked(index, words={"specimen_material": start.upper()})
        assert found and all(start in row["specimen_material"] for row in found)


def test_synthetic_and_measured_part_the_rows(index):
    synthetic, measured = asked(index, synthetic=True), asked(index, synthetic=False)
    assert len(synthetic) + len(measured) == len(asked(index))
    assert {row["test"] for row in measured} == {"bare", "static"}


def test_a_quantity_that_no_test_has_gives_no_row(index):
    assert asked(index, quantity=("cord_tension",)) == []
    assert asked(index, sort=("hose_wall",) if "hose_wall" in QUANTITIES else ("cord_tension",))


def test_numbers_in_several_places_are_asked_for_before_they_are_a_condition(index):
    with pytest.raises(SettingsError, match=r"'segment_modulus' has several values in a test"):
        asked(index, where=(condition_of("segment_modulus > 1 Pa"),))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("frequency", "--where is not a condition"),
        ("frequency >=", "--where is not a condition"),
        ("frequncy > 1 Hz", "names no quantity: 'frequncy'"),
        ("medium > wet", "'medium' is text"),
        ("frequency > 1 m", "unit 'm' is not a unit of frequency"),
        ("frequency > 1", "a value has no unit"),
        ("mean_tension > 1.2.3 %RBS", "--where has no number"),
        ("hysteresis_energy > 1", "the value of 'hysteresis_energy' is not a number with a unit"),
        ("hysteresis_energy > 1 s", "'s' is not a unit of hysteresis_energy"),
    ],
)  # fmt: skip
def test_a_condition_that_is_none_is_refused(text, words):
    with pytest.raises(SettingsError, match=words):
        condition_of(text)


def test_a_unit_of_a_quantity_without_a_dimension_of_its_own_is_converted():
    # 1 ft lbf / ft = 1 lbf of energy per length
    assert condition_of("hysteresis_energy > 1 lbf").value == pytest.approx(4.4482216152605)
    assert condition_of("strain_bin >= 100 %").value == 1.0


@pytest.mark.parametrize("option", ["quantity", "sort"])
def test_a_name_that_the_vocabulary_lacks_is_refused(option):
    with pytest.raises(SettingsError, match=f"--{option} names no quantity: 'stiffnes'"):
        needed_quantities(Query(**{option: ("stiffnes",)}))


def test_what_is_known_of_a_campaign_is_what_its_archives_were_when_it_was_made(catalogued):
    with netCDF4.Dataset(catalogued / "two" / "T-1.nc", "a") as archive:
        archive["cycles/test_frequency"][:] = [0.25, 0.5]
    found = made(catalogued)
    rows = asked(found, names={"test": ("T-1",)})
    assert [row["test_frequency"] for row in rows if row["archive"] == "two/T-1.nc"] == [0.25, 0.5]
    others = [row["test_frequency"] for row in rows if row["archive"] == "one/T-1.nc"]
    assert others and not {0.25, 0.5} & set(others)


def test_numbers_of_several_campaigns_stay_with_their_own(folder):
    found = made(folder)
    rows = asked(found, quantity=("segment_modulus",))
    one, two = (
        [row for row in rows if row["archive"] == f"{name}/T-1.nc"] for name in ("one", "two")
    )
    assert one and [row | {"archive": ""} for row in one] == [row | {"archive": ""} for row in two]
    assert [row["archive"] for row in rows] == sorted(row["archive"] for row in rows)


def test_an_archive_that_is_gone_is_not_answered_from(catalogued):
    (catalogued / "one" / "hold.nc").unlink()
    found = load_catalogue(catalogued)
    assert "hold" not in {row["test"] for row in asked(found)} and not found.unreadable
    assert "hold" not in {row["test"] for row in asked(found, quantity=("relaxation_drop",))}
    (catalogued / "two" / "T-1.nc").unlink()
    assert {row["archive"].split("/")[0] for row in asked(load_catalogue(catalogued))} == {"one"}


def test_an_archive_that_the_catalogue_lacks_is_named(catalogued):
    shutil.copyfile(catalogued / "one" / "hold.nc", catalogued / "two" / "hold.nc")
    found = load_catalogue(catalogued)
    assert list(found.unreadable) == ["two/hold.nc"]
    assert found.unreadable["two/hold.nc"] == (
        "two/hold.nc is not in catalogue.parquet. Run the campaign again, or use --rebuild."
    )
    assert len(asked(found)) == 7
    assert len(asked(made(catalogued))) == 8


def test_a_campaign_without_a_catalogue_is_named_and_hides_no_other(catalogued):
    (catalogued / "two" / FILE_NAME).unlink()
    found = load_catalogue(catalogued)
    assert found.unreadable == {
        "two": "two: catalogue.parquet cannot be read; found No such file or directory. Run the "
        "campaign again, or use --rebuild."
    }
    assert {row["archive"].split("/")[0] for row in asked(found)} == {"one"}


@pytest.mark.parametrize("left", [b"", b"PAR1 is not all of it PAR1"])
def test_a_catalogue_that_is_damaged_is_named_and_made_again(catalogued, left):
    (catalogued / "two" / FILE_NAME).write_bytes(left)
    assert list(load_catalogue(catalogued).unreadable) == ["two"]
    assert len(asked(made(catalogued))) == 7


def test_a_catalogue_of_another_program_is_named_and_made_again(catalogued):
    pyarrow.parquet.write_table(pyarrow.table({"archive": ["x"]}), catalogued / "two" / FILE_NAME)
    assert "another version, or of another program" in load_catalogue(catalogued).unreadable["two"]
    assert len(asked(made(catalogued))) == 7


@pytest.mark.parametrize(
    ("damage", "words"),
    [
        (lambda path: path.write_bytes(b"not netCDF"), "cannot be read as a netCDF file"),
        pytest.param(
            lambda path: path.write_bytes(path.read_bytes()[:20_000]),
            "cannot be read as a netCDF file", marks=pytest.mark.nightly,
        ),
        (lambda path: rename(path, schema_version="99"), "has another schema"),
    ],
)  # fmt: skip
def test_a_broken_archive_is_named_and_hides_no_other(folder, damage, words):
    damage(folder / "one" / "T-1.nc")
    left_out = rebuild(folder)
    assert list(left_out) == ["one/T-1.nc"] and words in left_out["one/T-1.nc"]
    found = load_catalogue(folder)
    assert {row["archive"] for row in asked(found)} == {
        "one/bare.nc", "one/hold.nc", "one/static.nc", "two/T-1.nc",
    }  # fmt: skip
    assert list(found.unreadable) == ["one/T-1.nc"]
    shutil.copyfile(folder / "two" / "T-1.nc", folder / "one" / "T-1.nc")
    assert not made(folder).unreadable
    damage(folder / "one" / "T-1.nc")
    with pytest.raises(ArchiveError, match=words):
        write_catalogue([folder / "one" / "T-1.nc"], folder / "one" / FILE_NAME)


def test_a_netcdf_file_whose_parts_are_not_those_of_an_archive_is_named(tmp_path):
    path = tmp_path / "odd.nc"
    with netCDF4.Dataset(path, "w") as odd:
        odd.setncatts({"schema_version": SCHEMA_VERSION})
        for name, size in {"specimen": 2, "cycle": 4, "reading": 3}.items():
            odd.createDimension(name, size)
        odd.createVariable("mean_strain", "f8", ("specimen", "cycle"))[:] = 1.0
        odd.createVariable("strain_amplitude", "f8", ("specimen", "reading"))[:] = 1.0
    with pytest.raises(ArchiveError, match="odd.nc is not made as an archive is; found "):
        write_catalogue([path], tmp_path / FILE_NAME)


@pytest.mark.parametrize(
    "name", ["two words", "größe-µ", "a'b\"c", "[red]x[bold]", "50 %, dry; =1", "line\nbreak", "*"]
)
def test_a_campaign_of_any_name_is_found(archives, tmp_path, name):
    (tmp_path / name).mkdir()
    shutil.copyfile(archives[1], tmp_path / name / "hold.nc")
    assert [row["archive"] for row in asked(made(tmp_path))] == [f"{name}/hold.nc"]


def test_a_name_that_is_no_text_is_shown_by_its_bytes():
    assert _shown_path(os.fsdecode(b"one/\xff.nc")) == "one/\\xff.nc"


def test_a_name_that_is_no_text_is_kept(archives, tmp_path):
    folder = os.fsdecode(os.fsencode(tmp_path) + b"/camp\xff")
    try:
        os.mkdir(folder)
    except OSError:
        pytest.skip("this file system takes texts alone")
    shutil.copyfile(archives[1], os.path.join(folder, "hold.nc"))
    left_out = rebuild(tmp_path)
    known = [row["archive"] for row in asked(load_catalogue(tmp_path))] + list(left_out)
    assert known == ["camp\\xff/hold.nc"]


def test_parts_of_files_and_other_files_are_left_alone(folder):
    (folder / "one" / ".T-9.nc.12.part").write_bytes(b"")
    (folder / "one" / ".hidden.nc").write_bytes(b"")
    (folder / "one" / "status.csv").write_text("")
    (folder / "notes.txt").write_text("")
    (folder / ".git").mkdir()
    (folder / "empty").mkdir()
    assert len(asked(made(folder))) == 7
    assert not (folder / "empty" / FILE_NAME).exists()


def test_a_folder_that_is_none_is_refused(tmp_path):
    with pytest.raises(SettingsError, match="there is no folder .*nowhere"):
        campaigns_below(tmp_path / "nowhere")


def test_the_folder_of_one_campaign_is_refused(folder):
    with pytest.raises(SettingsError, match="is the folder of one campaign"):
        campaigns_below(folder / "one")


def test_an_empty_folder_has_an_empty_catalogue(tmp_path):
    found = made(tmp_path)
    assert asked(found) == [] and quantities_there(found) == {}
    assert asked(found, quantity=("loss_factor",), where=(condition_of("frequency > 0 Hz"),)) == []


def test_a_folder_that_takes_no_file_is_named(folder):
    (folder / "two" / FILE_NAME).mkdir()
    left_out = rebuild(folder)
    assert list(left_out) == ["two"] and "catalogue.parquet cannot be written" in left_out["two"]
    assert not [one for one in (folder / "two").iterdir() if one.name.endswith(".part")]


def test_a_catalogue_is_the_same_bytes_when_it_is_made_again_in_any_order(catalogued):
    path = catalogued / "one" / FILE_NAME
    first = path.read_bytes()
    path.unlink()
    write_catalogue(sorted((catalogued / "one").glob("*.nc"), reverse=True), path)
    assert path.read_bytes() == first


def test_a_catalogue_that_is_written_in_parts_answers_the_same(catalogued, monkeypatch):
    path = catalogued / "one" / FILE_NAME
    whole = pd.read_parquet(path)
    monkeypatch.setattr(catalogue_entries, "_ARCHIVES_AT_ONCE", 1)
    write_catalogue(sorted((catalogued / "one").glob("*.nc")), path)
    parts = pd.read_parquet(path)
    order = ["row", "quantity", "cycle", "branch_name", "strain_bin", "segment", "hold"]
    known = [name for name in order if name in whole]
    pd.testing.assert_frame_equal(
        *(one.sort_values(known, kind="stable", ignore_index=True) for one in (whole, parts))
    )
    assert not whole.equals(parts)


def test_a_question_gets_the_same_answer_from_the_numbers_that_it_needs(folder):
    whole = made(folder)
    some = load_catalogue(folder, ["segment_modulus"])
    query = Query(quantity=("segment_modulus",))
    assert answer(some, query).equals(answer(whole, query))
    assert quantities_there(some).keys() == {"segment_modulus"}


def test_the_file_of_a_campaign_can_be_read_by_itself(catalogued, rich_test):
    rows = pd.read_parquet(catalogued / "two" / FILE_NAME)
    own = rows[(rows["quantity"] == "test_loss_factor") & (rows["specimen"] == "used")]
    assert own["value"].tolist() == [rich_test.amplitude.loss_factor[1]]
    assert own["test_frequency"].tolist() == [rich_test.amplitude.frequency[1]]
    assert own["archive"].tolist() == ["T-1.nc"]


def test_cycles_that_are_kept_end_with_the_last():
    assert (_kept_cycles(1) + 1).tolist() == [1]
    assert (_kept_cycles(10) + 1).tolist() == [1, 2, 5, 10]
    assert len(_kept_cycles(1_000_000)) == 19


def test_a_table_is_written_with_units(index, tmp_path):
    table = answer(index, Query(quantity=("segment_modulus",)))
    write_answer(table, tmp_path / "all.csv")
    write_answer(table, tmp_path / "all.parquet")
    csv = pyarrow.csv.read_csv(tmp_path / "all.csv")
    assert csv.num_rows == table.num_rows
    assert csv["segment_modulus [Pa]"].to_pylist() == table["segment_modulus"].to_pylist()
    parquet = pyarrow.parquet.read_table(tmp_path / "all.parquet")
    assert parquet.to_pylist() == table.to_pylist()
    field = parquet.schema.field("segment_modulus_standard_uncertainty")
    assert field.metadata[b"units"] == b"Pa"
    assert b"standard uncertainty" in field.metadata[b"long_name"]


def test_a_table_of_another_ending_is_refused(index, tmp_path):
    with pytest.raises(SettingsError, match="--export does not know this file ending"):
        write_answer(answer(index, Query()), tmp_path / "all.xlsx")


def test_a_disk_that_refuses_is_an_error_of_the_archive(index, tmp_path):
    (tmp_path / "all.csv").mkdir()
    with pytest.raises(ArchiveError, match="all.csv cannot be written"):
        write_answer(answer(index, Query()), tmp_path / "all.csv")


def test_every_column_has_a_row_in_the_vocabulary(index):
    of_values = set(index.numbers.columns)
    own = {"quantity", "row", "value", "standard_uncertainty"}
    for name in (*CONDITIONS, *sorted(of_values - own)):
        assert name in QUANTITIES, name
        assert meaning_of(name) != name or QUANTITIES[name].long_name == name
        assert unit_of(name) == QUANTITIES[name].unit
    dims = {dim for row in (TEST_SCHEMA | STEPWISE_SCHEMA).values() for dim in row.dims}
    for dim in dims - LEFT_OUT - {"specimen"}:
        assert dim in QUANTITIES or dim.endswith("_other"), dim


def test_of_many_cycles_those_that_are_not_kept_are_not_read(tmp_path):
    n_cycles, names = 60_000, ("loss_factor", "hysteresis_energy", "secant_modulus")
    numbers = np.arange(2.0 * n_cycles).reshape(2, n_cycles)
    data = xr.Dataset(
        {name: (("specimen", "cycle"), numbers + place) for place, name in enumerate(names)},
        coords={"specimen": ["new", "used"], "cycle": np.arange(1, n_cycles + 1)},
        attrs={"schema_version": SCHEMA_VERSION, "test": "long"},
    )
    path = tmp_path / "long.nc"
    data.to_netcdf(path, engine="netcdf4")

    def read():
        with reading(path) as archive:
            return entry_of(path, archive)

    read()  # what stays is made before it is measured
    tracemalloc.start()
    entry = read()
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < len(names) * numbers.nbytes
    (block,) = (one.to_pandas() for one in entry.numbers)
    last = block[(block["row"] == 2) & (block["cycle"] == n_cycles)]["value"]
    assert sorted(last) == [2 * n_cycles - 1, 2 * n_cycles, 2 * n_cycles + 1]


def test_a_folder_that_is_closed_is_named_and_hides_no_other(catalogued, monkeypatch):
    whole = file.archives_in

    def closed(path):
        if path.name == "two":
            raise PermissionError(13, "Permission denied", str(path))
        return whole(path)

    monkeypatch.setattr(file, "archives_in", closed)
    found = load_catalogue(catalogued)
    assert {row["archive"].partition("/")[0] for row in asked(found)} == {"one"}
    assert list(found.unreadable) == ["two"] and "Permission denied" in found.unreadable["two"]
    assert list(rebuild(catalogued)) == ["two"]


def test_a_folder_of_campaigns_that_is_closed_is_refused(folder, monkeypatch):
    def closed(path):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(file.os, "scandir", closed)
    with pytest.raises(SettingsError, match="processed cannot be read; found Permission denied"):
        campaigns_below(folder)


@pytest.mark.posix
def test_a_link_to_itself_is_no_campaign(folder):
    before = campaigns_below(folder)
    (folder / "round").symlink_to("round")
    (folder / "round.nc").symlink_to("round.nc")
    assert campaigns_below(folder) == before


@pytest.mark.posix
def test_a_folder_or_a_link_with_the_name_of_an_archive_is_named(folder):
    (folder / "one" / "odd.nc").mkdir()
    (folder / "one" / "gone.nc").symlink_to(folder / "nothing.nc")
    assert set(rebuild(folder)) == {"one/odd.nc", "one/gone.nc"}
    assert len(asked(load_catalogue(folder))) == 7
