"""An archive says of itself whether it is as it was written."""

import hashlib
import random

import netCDF4
import pytest
import xarray as xr

from reduction.archive.open import open_archive
from reduction.archive.seal import check_seal, has_seal, write_seal
from reduction.errors import ArchiveError


def flip(path, byte, bit):
    held = bytearray(path.read_bytes())
    held[byte] ^= 1 << bit
    path.write_bytes(held)


def test_the_sum_is_what_any_other_program_finds(tmp_path):
    path = tmp_path / "T-1.nc"
    path.write_bytes(b"as it is")
    write_seal(path)
    body, _, line = path.read_bytes().rpartition(b"\nsha256 of the bytes before this line: ")
    assert (body, line.decode()) == (b"as it is", f"{hashlib.sha256(b'as it is').hexdigest()}\n")
    assert check_seal(path)


def test_a_flipped_bit_anywhere_is_found(rich_test, write):
    path = write(rich_test)
    whole = path.read_bytes()
    places = random.Random(1).sample(range(len(whole)), 300)  # noqa: S311
    for number, byte in enumerate([0, len(whole) - 2, *places]):
        flip(path, byte, number % 8)
        if has_seal(path):
            with pytest.raises(ArchiveError, match=r"T-1\.nc is damaged: it is not as it was wri"):
                open_archive(path)
        else:  # a bit of the last line itself
            assert byte >= len(whole) - 104
        path.write_bytes(whole)
    open_archive(path).close()


def test_an_archive_that_is_cut_off_has_no_sum(rich_test, write):
    path = write(rich_test)
    path.write_bytes(path.read_bytes()[:-1])
    assert not has_seal(path)


@pytest.mark.parametrize("held", [b"", b"short", b"x" * 500])
def test_another_file_has_no_sum(tmp_path, held):
    path = tmp_path / "T-1.nc"
    path.write_bytes(held)
    assert not has_seal(path)
    assert not check_seal(path)


def test_a_program_that_changes_an_archive_takes_its_sum_away_and_it_still_opens(rich_test, write):
    path = write(rich_test)
    with netCDF4.Dataset(path, "a") as file:
        file.remark = "mine"
    assert not has_seal(path)
    with open_archive(path) as archive:
        assert archive.attrs["remark"] == "mine"


def test_other_programs_read_what_stands_before_the_sum(rich_test, write):
    path = write(rich_test)
    assert has_seal(path)
    with xr.open_dataset(path, engine="netcdf4", decode_timedelta=False) as theirs:
        assert theirs.sizes["specimen"] == 2
