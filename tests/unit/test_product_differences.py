"""Two archives, tables or folders held against each other; the files are written here."""

import math
import subprocess
import sys
from pathlib import Path

import netCDF4
import numpy as np
import pytest

from reduction.archive.product_differences import (
    Change,
    _kind_of,
    _pair_by_name,
    _rows_by_labels,
    _shifts_between,
    _worst_change,
    differences_between,
)
from reduction.cli import diff as otherversion
from reduction.cli.output import CommandOutput
from reduction.record.errors import ArchiveError, DataError, SettingsError

NAN = np.nan


def texts(*words):
    size = max(map(len, words))
    return np.array([list(word.ljust(size, "\0").encode()) for word in words], "u1").view("S1")


def put(path, variables, **attributes):
    """Write variables as name: (dimensions, values, attributes); of a group by ``group/name``."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with netCDF4.Dataset(path, "w") as file:
        file.setncatts(attributes)
        for name, (dims, values, *more) in variables.items():
            values = np.asarray(values)
            if values.dtype.kind == "U":
                values = texts(*values.tolist())
                dims = f"{dims} {name.rpartition('/')[2]}_letters"
            dims = dims.split()
            for dim, size in zip(dims, values.shape, strict=True):
                if dim not in file.dimensions:
                    file.createDimension(dim, size)
            variable = file.createVariable(name, values.dtype, dims)
            variable.setncatts({"units": "Pa"} | (more[0] if more else {}))
            variable[...] = values
    return path


def modulus(values=(1.0, 2.0), uncertainty=(0.1, 0.1), specimens=("new", "used"), **more):
    return {
        "specimen": ("specimen", list(specimens)),
        "modulus": (
            "specimen",
            list(values),
            {"ancillary_variables": "modulus_standard_uncertainty"},
        ),
        "modulus_standard_uncertainty": ("specimen", list(uncertainty)),
    } | more


def compare(tmp_path, before, after, *, is_exact=False, of_before=(), of_after=()):
    return differences_between(
        put(tmp_path / "before.nc", before, **dict(of_before)),
        put(tmp_path / "after.nc", after, **dict(of_after)),
        is_exact=is_exact,
    )


def only(found, *, n=1):
    changed = [one for one in found.changes if one.n_changed]
    assert len(changed) == n, changed
    return changed[0]


def test_two_that_are_equal_have_no_differences(tmp_path):
    for is_exact in (False, True):
        found = compare(tmp_path, modulus((1.0, NAN)), modulus((1.0, NAN)), is_exact=is_exact)
        assert not found.is_moved
        assert not any(one.n_changed for one in found.changes)
        assert not (found.added or found.removed or found.regrouped or found.attributes)


def test_a_shift_is_in_uncertainties_of_the_product_before(tmp_path):
    found = compare(tmp_path, modulus((1.0, 2.0)), modulus((1.0, 2.3), (9.0, 0.11)))
    one = next(one for one in found.changes if one.variable == "modulus")
    assert (one.n, one.n_moved, one.where, one.unit) == (2, 1, {"specimen": "used"}, "Pa")
    assert one.shift == pytest.approx(3.0)
    assert found.is_moved


def test_of_a_number_without_one_it_is_that_of_the_product_after(tmp_path):
    found = compare(tmp_path, modulus((1.0, 2.0), (NAN, 0.1)), modulus((1.1, 2.0), (1.0, 0.1)))
    one = next(one for one in found.changes if one.variable == "modulus")
    assert one.shift == pytest.approx(0.1) and not one.n_moved


def test_less_than_half_an_uncertainty_moves_nothing_but_exactly(tmp_path):
    after = modulus((np.nextafter(1.0, 2), 2.0))
    assert not compare(tmp_path, modulus(), after).is_moved
    assert compare(tmp_path, modulus(), after, is_exact=True).is_moved
    assert not compare(tmp_path, modulus(), modulus((1.04, 2.0))).is_moved


@pytest.mark.parametrize("values", [(1.0, NAN), (NAN, 2.0)])
def test_a_number_that_came_or_went_has_moved(tmp_path, values):
    found = compare(tmp_path, modulus(), modulus(values))
    assert only(found).change == "went" and found.is_moved
    found = compare(tmp_path, modulus(values), modulus())
    assert only(found).change == "came" and found.is_moved


def test_an_archive_in_groups_is_held_against_a_flat_one(tmp_path):
    flat = modulus() | {"frequency": ("cycle", [0.1, 0.2]), "cycle": ("cycle", np.array([1, 2]))}
    grouped = {
        {"modulus": "design/modulus", "frequency": "cycles/frequency",
         "modulus_standard_uncertainty": "uncertainty/modulus_standard_uncertainty"}.get(name, name): one
        for name, one in flat.items()
    }  # fmt: skip
    found = compare(tmp_path, flat, grouped, is_exact=True)
    assert not found.is_moved and not (found.added or found.removed)
    assert {one["variable"]: one["after"] for one in found.regrouped} == {
        "modulus": "/design/modulus", "frequency": "/cycles/frequency",
        "modulus_standard_uncertainty": "/uncertainty/modulus_standard_uncertainty",
    }  # fmt: skip
    grouped["design/modulus"] = ("specimen", [1.0, 2.3])
    assert only(compare(tmp_path, flat, grouped)).shift == pytest.approx(3.0)
    assert only(compare(tmp_path, grouped, flat)).shift == pytest.approx(-3.0)


def test_rows_go_by_their_labels_and_not_by_their_places(tmp_path):
    after = modulus((2.0, 5.0, 1.0), (0.1, 0.1, 0.1), ("used", "third", "new"))
    found = compare(tmp_path, modulus(), after, is_exact=True)
    assert not found.is_moved
    assert found.added == [
        {"kind": "rows", "file": "before.nc", "name": "specimen", "n": 1, "rows": ["third"]}
    ]
    after["modulus"] = ("specimen", [2.0, 5.0, 1.4])
    assert only(compare(tmp_path, modulus(), after)).where == {"specimen": "new"}


def holds(specimens, numbers, values):
    """Rows without a label of their own but for two variables together."""
    return {
        "hold": ("hold", np.arange(len(values)) + 1),
        "hold_specimen": ("hold", list(specimens)),
        "hold_number": ("hold", np.array(numbers)),
        "drop": ("hold", list(values)),
        "drop_standard_uncertainty": ("hold", [0.1] * len(values)),
    }


def test_a_number_that_runs_through_a_file_is_no_label_where_there_are_better_ones(tmp_path):
    before = holds(["new", "new"], [1, 2], [1.0, 2.0])
    after = holds(["first", "new", "first", "new"], [1, 1, 2, 2], [7.0, 1.0, 8.0, 2.0])
    found = compare(tmp_path, before, after)
    assert not found.is_moved
    assert found.added[0]["rows"] == ["first, 1", "first, 2"]


def test_dimensions_may_have_other_names(tmp_path):
    after = {name: ("rope", *rest) for name, (_, *rest) in modulus((1.0, 2.3)).items()}
    after["rope"] = after.pop("specimen")
    found = compare(tmp_path, modulus(), after)
    assert only(found).where == {"specimen": "used"}
    assert [one["name"] for one in found.added] == ["rope"]


def test_without_labels_rows_go_by_their_places_or_not_at_all(tmp_path):
    plain = {"modulus": ("row", [1.0, 2.0]), "modulus_standard_uncertainty": ("row", [0.1, 0.1])}
    longer = {
        "modulus": ("row", [1.0, 2.0, 3.0]),
        "modulus_standard_uncertainty": ("row", [0.1] * 3),
    }
    assert not compare(tmp_path, plain, plain).is_moved
    found = compare(tmp_path, plain, longer)
    assert {(one.variable, one.change, one.before, one.after) for one in found.changes} == {
        ("modulus", "shape", "2", "3"), ("modulus_standard_uncertainty", "shape", "2", "3"),
    }  # fmt: skip
    assert found.is_moved


def test_a_scalar_that_has_a_dimension_now_has_another_shape(tmp_path):
    found = compare(tmp_path, {"x": ("", np.array(1.0))}, {"x": ("row", [1.0])})
    assert (only(found).change, only(found).before) == ("shape", "one value")


def test_flags_and_texts_are_told_and_move_no_answer(tmp_path):
    before = modulus(flag=("specimen", np.array([0, 3], "u2")), law=("specimen", ["yeoh", "ogden"]))
    after = modulus(flag=("specimen", np.array([0, 4], "u2")), law=("specimen", ["yeoh", "neo"]))
    found = compare(tmp_path, before, after)
    changed = {one.variable: one for one in found.changes if one.n_changed}
    assert (changed["flag"].before, changed["flag"].after) == (3, 4)
    assert (changed["law"].kind, changed["law"].after) == ("text", "neo")
    assert not found.is_moved
    assert compare(tmp_path, before, after, is_exact=True).is_moved  # of the flag
    after["flag"] = before["flag"]
    assert not compare(tmp_path, before, after, is_exact=True).is_moved


def test_a_text_of_variable_length_and_a_text_of_none(tmp_path):
    paths = [tmp_path / "a.nc", tmp_path / "b.nc"]
    for path, word in zip(paths, ("one", "two"), strict=True):
        with netCDF4.Dataset(path, "w") as file:
            file.createVariable("word", str)[...] = word
            file.createVariable("letter", "S1")[...] = b"x"
            file.createDimension("none", 0)
            file.createVariable("empty", "f8", ("none",))
            file.createVariable("no_letters", "S1", ("none",))
            pair = file.createCompoundType(np.dtype([("a", "f8"), ("b", "i4")]), "pair")
            file.createVariable("pairs", pair)[...] = np.array((1.0, 2), pair.dtype)
    (one,) = [one for one in differences_between(*paths).changes if one.n_changed]
    assert (one.variable, one.before, one.after) == ("word", "one", "two")


def test_values_that_were_never_written_are_missing(tmp_path):
    path = put(tmp_path / "a.nc", {"x": ("row", [1.0, 2.0])})
    with netCDF4.Dataset(tmp_path / "b.nc", "w") as file:
        file.createDimension("row", 2)
        file.createVariable("x", "f8", ("row",))[0] = 1.0
    assert only(differences_between(path, tmp_path / "b.nc")).change == "went"


def test_attributes_are_told_and_settings_key_by_key(tmp_path):
    found = compare(
        tmp_path, modulus(), modulus(),
        of_before={"title": "old", "gone": 1, "software_version": "1", "history": "a\nb",
                   "settings": '{"modulus": {"window": 0.1, "bins": [1, 2]}}'},
        of_after={"title": "new", "software_version": "2", "history": "a\nc",
                  "settings": '{"modulus": {"window": 0.2, "bins": [1, 2]}, "new": {}}'},
    )  # fmt: skip
    assert {one["attribute"]: (one["before"], one["after"]) for one in found.attributes} == {
        "title": ("old", "new"), "gone": (1, None), "settings.new": (None, {}),
        "settings.modulus.window": (0.1, 0.2),
    }  # fmt: skip
    assert {one["attribute"]: (one["before"], one["after"]) for one in found.history} == {
        "software_version": ("1", "2"), "history": (["b"], ["c"]),
    }  # fmt: skip
    assert not found.is_moved


def test_attributes_of_a_variable_and_its_type_are_told(tmp_path):
    after = modulus()
    after["modulus"] = ("specimen", np.array([1, 2], "f4"), {"units": "kPa"})
    found = compare(tmp_path, modulus(), after)
    assert {(one["of"], one["attribute"], one["after"]) for one in found.attributes} == {
        ("modulus", "units", "kPa"), ("modulus", "type", "float32"),
        ("modulus", "ancillary_variables", None),
    }  # fmt: skip


def table(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return path


HEAD = "test,specimen,hold,hold_number,drop [1],drop_standard_uncertainty [1],misfit [N],law\n"


def tables(tmp_path, before, after, **more):
    return differences_between(
        table(tmp_path / "a.csv", before), table(tmp_path / "b.csv", after), **more
    )


def test_rows_of_a_table_go_by_their_first_columns(tmp_path):
    found = tables(
        tmp_path,
        HEAD + "T-1,new,1,1,0.5,0.1,3,a\nT-1,new,2,2,0.6,0.1,,a\n",
        HEAD + "T-1,old,1,1,9,0.1,3,a\nT-1,new,2,1,0.5,0.1,3,b\nT-1,new,3,2,0.9,0.1,4,a\n",
    )
    changed = {one.variable: one for one in found.changes if one.n_changed}
    assert changed.keys() == {"hold", "drop", "misfit", "law"}
    drop = changed["drop"]
    assert drop.where == {"test": "T-1", "specimen": "new", "hold_number": "2"}
    assert (drop.unit, drop.shift, drop.n_moved) == ("1", pytest.approx(3.0), 1)
    assert changed["misfit"].change == "came" and changed["law"].kind == "text"
    assert found.added[0]["rows"] == ["T-1, old, 1"]


def test_columns_that_came_and_went(tmp_path):
    found = tables(tmp_path, "test,a [N]\nT-1,1.5\n", "test,a [N],b [N]\nT-1,1.5,2\n")
    assert [(one["kind"], one["name"]) for one in found.added] == [("column", "b [N]")]
    assert not found.is_moved


def test_a_number_of_a_table_moves_with_its_last_bit_where_it_is_asked_for(tmp_path):
    before, after = (f"test,a [N]\nT-1,{one!r}\n" for one in (0.1, float(np.nextafter(0.1, 1))))
    assert not tables(tmp_path, before, after).is_moved
    assert tables(tmp_path, before, after, is_exact=True).is_moved
    assert tables(tmp_path, before, "test,a [N]\nT-1,0.1000001\n").is_moved


def test_numbers_alone_are_no_labels_of_their_rows(tmp_path):
    found = tables(tmp_path, "a,b\n100,1\n200,2\n", "a,b\n100,1\n201,2\n")
    one = only(found)
    assert (one.variable, one.before, one.after, one.where) == ("a", 200.0, 201.0, {"row": "2"})


def test_a_table_whose_rows_nothing_matches_has_another_shape(tmp_path):
    found = tables(tmp_path, "a [N]\n1.5\n2.5\n", "a [N]\n1.5\n")
    assert (only(found).change, only(found).after) == ("shape", "1 row") and found.is_moved


def campaign(folder, values=(1.0, 2.0), status="T-1,reduced,0,,abc,1.5", table_value=1.5):
    put(folder / "T-1.nc", modulus(values))
    table(folder / "tables" / "moduli.csv", f"test,misfit [N]\nT-1,{table_value}\n")
    table(folder / "status.csv", f"test,status,exit_status,message,raw_sha256,seconds\n{status}\n")
    return folder


def test_folders_of_one_campaign(tmp_path):
    before = campaign(tmp_path / "a" / "tmt")
    found = differences_between(before, campaign(tmp_path / "b" / "other", (1.0, 2.3)))
    assert [(one.file, one.variable) for one in found.changes if one.n_moved] == [
        ("T-1.nc", "modulus")
    ]
    found = differences_between(before, campaign(tmp_path / "c" / "tmt", table_value=1.6))
    assert only(found).file == "tables/moduli.csv" and found.is_moved


def test_folders_of_several_campaigns_go_by_their_names(tmp_path):
    for side, names in (("a", "xy"), ("b", "yz")):
        for name in names:
            campaign(tmp_path / side / name, (1.0, 2.3 if side == "b" else 2.0))
    found = differences_between(tmp_path / "a", tmp_path / "b")
    assert only(found).file == "y/T-1.nc"
    assert (found.removed[0]["name"], found.added[0]["name"]) == ("x", "z")
    found = differences_between(tmp_path / "a", tmp_path / "b" / "y")
    assert only(found).file == "y/T-1.nc"


def test_archives_and_tests_that_came_and_went(tmp_path):
    before, after = (campaign(tmp_path / side / "tmt") for side in "ab")
    put(after / "T-2.nc", modulus())
    (before / "superseded").mkdir()
    put(before / "superseded" / "T-3.nc", modulus())
    table(after / "status.csv", "test,status,exit_status,message,seconds\nT-2,reduced,0,,9\n")
    found = differences_between(before, after)
    assert [(one["kind"], one["name"]) for one in found.added] == [("archive", "T-2.nc")]
    assert [(one["test"], one["change"]) for one in found.tests] == [
        ("T-1", "removed"), ("T-2", "added"),
    ]  # fmt: skip
    assert not found.is_moved


def test_a_test_that_fails_now_moves_its_answers_and_its_time_is_no_matter(tmp_path):
    before = campaign(tmp_path / "a" / "tmt")
    slower = campaign(tmp_path / "b" / "tmt", status="T-1,reduced,0,,abc,9.5")
    assert not differences_between(before, slower).tests
    failed = campaign(tmp_path / "c" / "tmt", status="T-1,failed,3,no such file,abc,1.5")
    found = differences_between(before, failed)
    assert found.tests[0]["after"]["message"] == "no such file"
    assert found.is_moved
    assert not differences_between(failed, before).is_moved


def test_what_cannot_be_read_is_an_error_of_its_own(tmp_path):
    good = put(tmp_path / "good.nc", modulus())
    (tmp_path / "text.nc").write_text("no netCDF")
    (tmp_path / "cut.nc").write_bytes(good.read_bytes()[:-400])
    (tmp_path / "empty.nc").touch()
    for name in ("text.nc", "cut.nc", "empty.nc"):
        with pytest.raises(ArchiveError, match=f"{name} cannot be read as netCDF; found "):
            differences_between(good, tmp_path / name)
    (tmp_path / "empty.csv").touch()
    (tmp_path / "bytes.csv").write_bytes(b"test\n\xff\xfe\n")
    (tmp_path / "ragged.csv").write_text("a,b\n1,2\n1,2,3,4\n")
    for name in ("empty.csv", "bytes.csv", "ragged.csv"):
        with pytest.raises(ArchiveError, match=f"{name} cannot be read as a table; found "):
            differences_between(tmp_path / name, tmp_path / name)


def test_what_is_missing_empty_or_of_another_kind(tmp_path):
    good = put(tmp_path / "good.nc", modulus())
    with pytest.raises(ArchiveError, match="there is no file or folder"):
        differences_between(good, tmp_path / "none.nc")
    (tmp_path / "nothing").mkdir()
    with pytest.raises(ArchiveError, match="nothing: no archive was found"):
        differences_between(tmp_path / "nothing", tmp_path / "nothing")
    with pytest.raises(SettingsError, match="these two cannot be compared"):
        differences_between(good, tmp_path)
    other = put(tmp_path / "other.nc", {"y": ("row", [1.0])})
    with pytest.raises(DataError, match="have nothing in common"):
        differences_between(good, other)


NAN_OF_NUMBERS = math.nan


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
        (10.0, 10.1, NAN_OF_NUMBERS, True, True),  # nothing says that it may
        (10.0, 10.1, 0.0, True, True),
        (10.0, 10.1, None, True, True),
        (1.0, 1.0 + 5e-10, 1e-12, False, False),  # rounding, whatever it is said to be known to
        (1.0, 1.0 + 2e-9, 1e-12, True, True),
        (10.0, NAN_OF_NUMBERS, 1.0, True, True),
        (NAN_OF_NUMBERS, 10.0, 1.0, True, True),
        (NAN_OF_NUMBERS, NAN_OF_NUMBERS, 1.0, False, False),
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
    assert flags(NAN_OF_NUMBERS, NAN_OF_NUMBERS, 1.0, is_exact=True)[:2] == (False, False)
    assert flags(NAN_OF_NUMBERS, 1.0, 1.0, is_exact=True)[:2] == (True, True)
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
    found = worst(
        [1.0, NAN_OF_NUMBERS, 3.0], [9.0, 2.0, NAN_OF_NUMBERS], [1.0, NAN_OF_NUMBERS, 1.0]
    )
    assert (found.n_moved, found.n_came, found.n_went) == (3, 1, 1)
    assert (found.change, found.shift) == ("changed", 8.0)
    assert worst([1.0, NAN_OF_NUMBERS], [1.2, 2.0], [1.0, NAN_OF_NUMBERS]).change == "came"
    went = worst([1.0, 2.0], [1.0, NAN_OF_NUMBERS], [1.0, 1.0])
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


# another revision of the software: found, unpacked, and what is said where it cannot be

# a package of that name, which writes what it was asked for where products go
STUB = """
import pathlib, sys
words = sys.argv[1:]
folder = pathlib.Path(words[words.index("--processed") + 1]) / "stub"
folder.mkdir(parents=True)
(folder / "said.txt").write_text("VERSION " + " ".join(words))
"""


def git(folder, *words):
    who = ("-c", "user.name=a", "-c", "user.email=a@example.org", "-c", "init.defaultBranch=main")
    command = ["git", "-C", folder, *who, *words]
    subprocess.run(command, check=True, capture_output=True)


@pytest.fixture
def checkout(tmp_path):
    """Two commits, the first of which is called `old`."""
    folder = tmp_path / "checkout"
    (folder / "reduction").mkdir(parents=True)
    git(folder, "init", "-q")
    for version in ("old", "new"):
        (folder / "reduction" / "__init__.py").write_text(f'__version__ = "{version}"\n')
        (folder / "reduction" / "__main__.py").write_text(STUB.replace("VERSION", version))
        git(folder, "add", "-A")
        git(folder, "commit", "-qm", version)
        git(folder, "tag", version)
    return folder


def test_a_revision_is_unpacked_and_the_checkout_left_alone(checkout, tmp_path):
    (checkout / "reduction" / "__init__.py").write_text("of now\n")
    source = otherversion._export_revision(checkout, "old", tmp_path)
    assert (source / "reduction" / "__init__.py").read_text() == '__version__ = "old"\n'
    assert (checkout / "reduction" / "__init__.py").read_text() == "of now\n"
    assert not (checkout / ".git" / "worktrees").exists()


@pytest.mark.parametrize("revision", ["none", "--all", "", "old:reduction"])
def test_a_revision_that_there_is_not_is_refused(checkout, tmp_path, revision):
    with pytest.raises(SettingsError, match="no such revision; found"):
        otherversion._export_revision(checkout, revision, tmp_path)


def test_a_package_that_is_in_no_checkout_has_no_revisions(checkout, tmp_path):
    assert otherversion._find_checkout(checkout) == checkout
    for folder in (tmp_path, checkout / "environment" / "site-packages"):
        folder.mkdir(parents=True, exist_ok=True)
        with pytest.raises(SettingsError, match="--against needs the git checkout"):
            otherversion._find_checkout(folder)


def test_without_git_it_is_said_what_is_missing(monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(SettingsError, match="git cannot be started"):
        otherversion._find_checkout(tmp_path)


@pytest.mark.nightly
def test_what_pip_says_is_handed_on(tmp_path):
    (tmp_path / "source").mkdir()
    with pytest.raises(SettingsError, match="revision old cannot be installed; found ") as refused:
        otherversion._install(tmp_path / "source", tmp_path, "old")
    assert "pyproject.toml' found. pip needs network access" in str(refused.value)
    versions = (tmp_path / "versions.txt").read_text().splitlines()
    assert any(one.startswith("numpy==") for one in versions)
    assert not any(one.startswith("mooring-reduction") for one in versions)


@pytest.fixture
def installed(checkout, monkeypatch):
    """The stub in place of this package, and run from where it was unpacked to."""
    runs = []

    def run(command):
        if "-I" not in command:
            return original(command)
        runs.append(command)
        return original([sys.executable, str(runs_from / "reduction"), *command[4:]])

    original, runs_from = otherversion._run, checkout.parent / "scratch" / "source"
    monkeypatch.setattr(otherversion.reduction, "__file__", str(checkout / "reduction" / "x"))
    monkeypatch.setattr(otherversion, "_run", run)
    monkeypatch.setattr(otherversion, "_install", lambda *given: Path("python"))
    return checkout.parent / "scratch"


def test_the_campaign_is_run_by_the_revision(installed):
    installed.mkdir()
    made = otherversion._run_revision("old", Path("c.toml"), installed, CommandOutput(quiet=True))
    assert made == installed / "processed" / "stub"
    said = (made / "said.txt").read_text()
    assert said.startswith("old run c.toml --processed ") and said.endswith(" --quiet")


def test_a_revision_that_cannot_read_the_campaign_says_why(installed, checkout):
    installed.mkdir()
    (checkout / "reduction" / "__main__.py").write_text(
        "raise SystemExit('campaign.toml: no key x')"
    )
    git(checkout, "commit", "-qam", "refuses")
    with pytest.raises(SettingsError, match="HEAD cannot run c.toml; found .*no key x"):
        otherversion._run_revision("HEAD", Path("c.toml"), installed, CommandOutput(quiet=True))
