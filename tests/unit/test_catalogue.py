"""The catalogue says what the archives say, and notices when they change."""

import os
import shutil
import tracemalloc

import netCDF4
import numpy as np
import pyarrow.csv
import pyarrow.parquet
import pytest
import xarray as xr

from reduction.archive.open import open_archive
from reduction.archive.schema import SCHEMA, schema_of
from reduction.archive.version import SCHEMA_VERSION
from reduction.catalogue import files
from reduction.catalogue.changes import changes_since
from reduction.catalogue.columns import CONDITIONS, LEFT_OUT
from reduction.catalogue.condition import condition_of
from reduction.catalogue.files import archives_below, shown_path
from reduction.catalogue.index import INDEX_NAME, Index, load_index, save_index
from reduction.catalogue.query import Query, answer, needed_quantities, quantities_there
from reduction.catalogue.read import kept_cycles, read_entry
from reduction.catalogue.refresh import refresh
from reduction.catalogue.write import meaning_of, unit_of, write_answer
from reduction.errors import ArchiveError, SettingsError
from reduction.vocabulary import QUANTITIES


def brought_up_to_date(folder, jobs=1):
    """What the command does before it answers; how many archives it read."""
    path = folder / INDEX_NAME
    known = load_index(path)
    changes = changes_since(known, folder)
    if known is not None and changes.is_none:
        return known, 0
    done = refresh(known, changes, path, jobs=jobs)
    return done.index, done.n_read


def same_values(one, other):
    pairs = zip(one.values, other.values, strict=True)
    return all(left.select(right.column_names).equals(right) for left, right in pairs)


def asked(index, **options):
    return answer(index, Query(**options)).to_pylist()


@pytest.fixture
def folder(archives, tmp_path):
    """Two campaigns: every kind of test in one, the rich test alone in the other."""
    processed = tmp_path / "processed"
    for campaign, paths in (("one", archives), ("two", archives[-1:])):
        (processed / campaign).mkdir(parents=True)
        for path in paths:
            shutil.copyfile(path, processed / campaign / path.name)
    return processed


@pytest.fixture(scope="module")
def index(archives, tmp_path_factory):
    processed = tmp_path_factory.mktemp("processed")
    (processed / "one").mkdir()
    for path in archives:
        shutil.copyfile(path, processed / "one" / path.name)
    return brought_up_to_date(processed)[0]


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
            name: archive[name].values[np.isfinite(archive[name].values)].tolist()
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
        spread = archive["segment_modulus_standard_uncertainty"].values
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
    between = condition_of(f"mean_tension >= {100 * np.nanmean(share):.9f} %RBS")
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
    with pytest.raises(SettingsError, match=r"'segment_modulus' stands in several places"):
        asked(index, where=(condition_of("segment_modulus > 1 Pa"),))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("frequency", "--where is no condition"),
        ("frequency >=", "--where is no condition"),
        ("frequncy > 1 Hz", "names no quantity: 'frequncy'"),
        ("medium > wet", "'medium' is a text"),
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


def test_an_index_that_fits_is_not_read_again(folder):
    assert brought_up_to_date(folder)[1] == 5
    assert brought_up_to_date(folder)[1] == 0


def test_a_changed_archive_is_read_again_and_the_others_are_not(folder):
    brought_up_to_date(folder)
    with netCDF4.Dataset(folder / "two" / "T-1.nc", "a") as archive:
        archive["test_frequency"][:] = [0.25, 0.5]
    found, n_read = brought_up_to_date(folder)
    assert n_read == 1
    rows = asked(found, names={"test": ("T-1",)})
    assert [row["test_frequency"] for row in rows if row["archive"] == "two/T-1.nc"] == [0.25, 0.5]
    others = [row["test_frequency"] for row in rows if row["archive"] == "one/T-1.nc"]
    assert others and not {0.25, 0.5} & set(others)


def test_an_archive_put_in_place_with_the_old_size_and_time_is_told_by_what_it_says(folder):
    path = folder / "two" / "T-1.nc"
    rename(path, id="tmt/T-1", raw_file_sha256="ab" * 32)
    brought_up_to_date(folder)
    before = path.stat()
    other = folder.parent / "other.nc"
    shutil.copyfile(path, other)
    rename(other, raw_file_sha256="cd" * 32)
    with netCDF4.Dataset(other, "a") as archive:
        archive["test_frequency"][:] = [0.25, 0.5]
    assert other.stat().st_size == before.st_size
    os.utime(other, ns=(before.st_atime_ns, before.st_mtime_ns))
    other.replace(path)
    found, n_read = brought_up_to_date(folder)
    assert n_read == 1
    rows = asked(found, where=(condition_of("frequency = 0.25 Hz"),))
    assert [row["archive"] for row in rows] == ["two/T-1.nc"]


def test_a_copy_of_the_same_archive_is_not_read_again(folder):
    first, _ = brought_up_to_date(folder)
    path = folder / "two" / "T-1.nc"
    shutil.copy2(path, folder.parent / "copy.nc")
    (folder.parent / "copy.nc").replace(path)
    second, n_read = brought_up_to_date(folder)
    assert n_read == 0
    assert asked(second) == asked(first)
    assert changes_since(load_index(folder / INDEX_NAME), folder).is_none


def test_an_archive_that_is_gone_is_gone_from_the_index(folder):
    brought_up_to_date(folder)
    shutil.rmtree(folder / "two")
    found, n_read = brought_up_to_date(folder)
    assert n_read == 0
    assert {row["archive"].split("/")[0] for row in asked(found)} == {"one"}
    assert set(found.states()) == {f"one/{name}.nc" for name in ("T-1", "bare", "hold", "static")}


def test_a_part_of_the_index_read_again_is_the_index_made_at_once(folder):
    brought_up_to_date(folder)
    (folder / "one" / "T-1.nc").touch()
    (folder / "three").mkdir()
    shutil.copyfile(folder / "one" / "hold.nc", folder / "three" / "hold.nc")
    found, _ = brought_up_to_date(folder)
    (folder / INDEX_NAME).unlink()
    anew, _ = brought_up_to_date(folder)
    assert found.tests.equals(anew.tests)
    assert quantities_there(found) == quantities_there(anew)
    for name in quantities_there(anew):
        query = Query(quantity=(name,), by_cycle=True)
        assert answer(found, query).equals(answer(anew, query)), name


def test_two_processes_read_what_one_reads(folder):
    alone, _ = brought_up_to_date(folder)
    (folder / INDEX_NAME).unlink()
    together, _ = brought_up_to_date(folder, jobs=2)
    assert together.tests.equals(alone.tests) and same_values(together, alone)


@pytest.mark.parametrize("left", [b"", b"PAR1 is not all of it PAR1"])
def test_an_index_that_is_damaged_is_made_again(folder, left):
    brought_up_to_date(folder)
    (folder / INDEX_NAME).write_bytes(left)
    assert load_index(folder / INDEX_NAME) is None
    assert brought_up_to_date(folder)[1] == 5


def test_an_index_of_another_program_is_made_again(folder):
    pyarrow.parquet.write_table(pyarrow.table({"archive": ["x"]}), folder / INDEX_NAME)
    assert brought_up_to_date(folder)[1] == 5


@pytest.mark.parametrize(
    ("damage", "words"),
    [
        (lambda path: path.write_bytes(b"not netCDF"), "is not a netCDF file"),
        (lambda path: path.write_bytes(path.read_bytes()[:20_000]), "is not a netCDF file"),
        (lambda path: rename(path, schema_version="99"), "has another schema"),
    ],
)  # fmt: skip
def test_a_broken_archive_is_named_and_hides_no_other(folder, damage, words):
    damage(folder / "two" / "T-1.nc")
    found, _ = brought_up_to_date(folder)
    assert list(found.unreadable()) == ["two/T-1.nc"]
    assert words in found.unreadable()["two/T-1.nc"]
    assert {row["archive"].split("/")[0] for row in asked(found)} == {"one"}
    # it is not opened again at each question, and comes back when it is mended
    assert brought_up_to_date(folder)[1] == 0
    shutil.copyfile(folder / "one" / "T-1.nc", folder / "two" / "T-1.nc")
    mended, n_read = brought_up_to_date(folder)
    assert n_read == 1 and not mended.unreadable()


def test_a_netcdf_file_whose_parts_are_not_those_of_an_archive_is_named(tmp_path):
    path = tmp_path / "odd.nc"
    with netCDF4.Dataset(path, "w") as odd:
        odd.setncatts({"schema_version": "1"})
        for name, size in {"specimen": 2, "cycle": 4, "reading": 3}.items():
            odd.createDimension(name, size)
        odd.createVariable("mean_strain", "f8", ("specimen", "cycle"))[:] = 1.0
        odd.createVariable("strain_amplitude", "f8", ("specimen", "reading"))[:] = 1.0
    entry = read_entry(path, "one/odd.nc")
    assert "odd.nc is not made as an archive is; found " in entry.fault


@pytest.mark.parametrize(
    "name", ["two words", "größe-µ", "a'b\"c", "[red]x[bold]", "50 %, dry; =1", "line\nbreak", "*"]
)
def test_a_campaign_of_any_name_is_found(archives, tmp_path, name):
    (tmp_path / name).mkdir()
    shutil.copyfile(archives[1], tmp_path / name / "hold.nc")
    found, _ = brought_up_to_date(tmp_path)
    assert [row["archive"] for row in asked(found)] == [f"{name}/hold.nc"]
    assert brought_up_to_date(tmp_path)[1] == 0


def test_a_name_that_is_no_text_is_shown_by_its_bytes():
    assert shown_path(os.fsdecode(b"one/\xff.nc")) == "one/\\xff.nc"


def test_a_name_that_is_no_text_is_kept_in_the_index(archives, tmp_path):
    folder = os.fsdecode(os.fsencode(tmp_path) + b"/camp\xff")
    try:
        os.mkdir(folder)
    except OSError:
        pytest.skip("this file system takes texts alone")
    shutil.copyfile(archives[1], os.path.join(folder, "hold.nc"))
    found, _ = brought_up_to_date(tmp_path)
    known = [row["archive"] for row in asked(found)] + list(found.unreadable())
    assert known == ["camp\\xff/hold.nc"]


def test_parts_of_files_and_other_files_are_left_alone(folder):
    (folder / "one" / ".T-9.nc.12.part").write_bytes(b"")
    (folder / "one" / ".hidden.nc").write_bytes(b"")
    (folder / "one" / "status.csv").write_text("")
    (folder / "notes.txt").write_text("")
    (folder / ".git").mkdir()
    assert len(archives_below(folder)) == 5


def test_a_link_to_nothing_is_no_archive(folder):
    (folder / "one" / "gone.nc").symlink_to(folder / "nothing.nc")
    assert len(changes_since(None, folder).states) == 5


def test_a_folder_that_is_none_is_refused(tmp_path):
    with pytest.raises(SettingsError, match="there is no folder .*nowhere"):
        archives_below(tmp_path / "nowhere")


def test_the_folder_of_one_campaign_is_refused(folder):
    with pytest.raises(SettingsError, match="is the folder of one campaign"):
        archives_below(folder / "one")


def test_an_empty_folder_has_an_empty_catalogue(tmp_path):
    found, n_read = brought_up_to_date(tmp_path)
    assert n_read == 0 and asked(found) == []
    assert asked(found, quantity=("loss_factor",), where=(condition_of("frequency > 0 Hz"),)) == []
    assert brought_up_to_date(tmp_path)[1] == 0


def test_an_index_that_cannot_be_written_answers_all_the_same(folder):
    (folder / INDEX_NAME).mkdir()
    done = refresh(None, changes_since(None, folder), folder / INDEX_NAME)
    assert INDEX_NAME in done.not_kept
    assert len(asked(done.index)) == 7
    assert not [one for one in folder.iterdir() if one.name.endswith(".part")]


def test_the_index_is_the_same_bytes_when_it_is_made_again(folder):
    brought_up_to_date(folder)
    first = (folder / INDEX_NAME).read_bytes()
    (folder / INDEX_NAME).unlink()
    brought_up_to_date(folder)
    assert (folder / INDEX_NAME).read_bytes() == first


def test_what_is_read_of_an_index_is_what_was_written(index, tmp_path):
    save_index(index, tmp_path / INDEX_NAME)
    back = load_index(tmp_path / INDEX_NAME)
    assert back.tests.equals(index.tests) and same_values(back, index)
    some = load_index(tmp_path / INDEX_NAME, ["segment_modulus"])
    query = Query(quantity=("segment_modulus",))
    assert answer(some, query).to_pylist() == answer(index, query).to_pylist()
    assert quantities_there(some).keys() == {"segment_modulus"}


def test_cycles_that_are_kept_end_with_the_last():
    assert (kept_cycles(1) + 1).tolist() == [1]
    assert (kept_cycles(10) + 1).tolist() == [1, 2, 5, 10]
    assert len(kept_cycles(1_000_000)) == 19


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
    with pytest.raises(SettingsError, match="--export does not know the ending"):
        write_answer(answer(index, Query()), tmp_path / "all.xlsx")


def test_a_disk_that_refuses_is_an_error_of_the_archive(index, tmp_path):
    (tmp_path / "all.csv").mkdir()
    with pytest.raises(ArchiveError, match="all.csv cannot be written"):
        write_answer(answer(index, Query()), tmp_path / "all.csv")


def test_every_column_has_a_row_in_the_vocabulary(index):
    of_values = {name for part in index.values for name in part.column_names}
    own = {"quantity", "row", "value", "standard_uncertainty"}
    for name in (*CONDITIONS, *sorted(of_values - own)):
        assert name in QUANTITIES, name
        assert meaning_of(name) != name or QUANTITIES[name].long_name == name
        assert unit_of(name) == QUANTITIES[name].unit
    dims = {dim for row in (SCHEMA | schema_of(is_stepwise=True)).values() for dim in row.dims}
    for dim in dims - LEFT_OUT - {"specimen"}:
        assert dim in QUANTITIES or dim.endswith("_other"), dim


def test_an_index_of_nothing_has_no_quantity():
    assert quantities_there(Index.empty()) == {}


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
    read_entry(path, "one/long.nc")  # what stays is made before it is measured
    tracemalloc.start()
    entry = read_entry(path, "one/long.nc")
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < len(names) * numbers.nbytes
    (block,) = entry.blocks
    last = block.value[(block.specimen == 1) & (block.place["cycle"] == n_cycles)]
    assert last.tolist() == [2 * n_cycles - 1, 2 * n_cycles, 2 * n_cycles + 1]


def test_a_folder_that_is_closed_is_named_and_hides_no_other(folder, monkeypatch):
    whole = files.os.scandir

    def closed(path):
        if os.fspath(path).endswith("two"):
            raise PermissionError(13, "Permission denied", os.fspath(path))
        return whole(path)

    monkeypatch.setattr(files.os, "scandir", closed)
    index, _ = brought_up_to_date(folder)
    assert {row["archive"].partition("/")[0] for row in asked(index)} == {"one"}
    assert list(index.unreadable()) == ["two"]
    assert "one that this user may not look into" in index.unreadable()["two"]
    monkeypatch.undo()
    index, _ = brought_up_to_date(folder)
    assert not index.unreadable()
    assert {row["archive"].partition("/")[0] for row in asked(index)} == {"one", "two"}


def test_a_folder_of_campaigns_that_is_closed_is_refused(folder, monkeypatch):
    def closed(path):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(files.os, "scandir", closed)
    with pytest.raises(SettingsError, match="processed cannot be read; found Permission denied"):
        archives_below(folder)


def test_a_link_to_itself_is_no_campaign(folder):
    before = archives_below(folder)
    (folder / "round").symlink_to("round")
    (folder / "round.nc").symlink_to("round.nc")
    assert archives_below(folder) == before


def test_a_folder_with_the_name_of_an_archive_is_called_a_folder(folder):
    (folder / "one" / "odd.nc").mkdir()
    index, _ = brought_up_to_date(folder)
    assert "one/odd.nc is a folder that is no archive" in index.unreadable()["one/odd.nc"]
