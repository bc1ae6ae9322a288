"""Archives that are read once and given again: the same values, from memory, until the file is another."""

from contextlib import contextmanager

import h5py
import netCDF4
import numpy as np
import pytest

from reduction.archive import inmemory as module
from reduction.archive.inmemory import ArchivesInMemory
from reduction.archive.open import reading
from reduction.errors import ArchiveError


@pytest.fixture
def opened(monkeypatch):
    """Names of the files that are opened."""
    names = []

    def told(path):
        names.append(path.name)
        return reading(path)

    monkeypatch.setattr(module, "reading", told)
    return names


def test_an_archive_is_opened_once_and_given_as_it_is_on_the_disk(rich_test, write, opened):
    path, archives = write(rich_test), ArchivesInMemory()
    with reading(path) as on_disk:
        for _ in range(3):
            with archives.reading(path) as archive:
                assert archive.identical(on_disk)
                assert list(archive.variables) == list(on_disk.variables)
                for name, variable in archive.variables.items():
                    assert variable.dtype == on_disk.variables[name].dtype
    assert opened == [path.name]


def test_a_file_that_was_replaced_is_read_anew(rich_test, bare_test, write, opened):
    path, archives = write(rich_test), ArchivesInMemory()
    with archives.reading(path):
        pass
    write(bare_test).replace(path)
    with archives.reading(path) as archive, reading(path) as on_disk:
        assert archive.identical(on_disk)
    assert len(opened) == 2


def test_a_file_that_is_replaced_while_it_is_read_is_read_anew(
    rich_test, bare_test, write, monkeypatch, tmp_path
):
    path, archives = write(rich_test), ArchivesInMemory()
    path = path.replace(tmp_path / "one.nc")
    other = write(bare_test)
    opened = module.reading

    @contextmanager
    def replaced(place):
        with opened(place) as archive:
            if other.exists():
                other.replace(place)
            yield archive

    monkeypatch.setattr(module, "reading", replaced)
    with archives.reading(path):
        pass
    with archives.reading(path) as archive, reading(path) as on_disk:
        assert archive.identical(on_disk)


def test_what_cannot_be_read_is_told_to_who_asks_for_it(rich_test, write):
    path, archives = write(rich_test), ArchivesInMemory()
    with netCDF4.Dataset(path, "a") as file:
        file.createDimension("own", 5000)
        file.createVariable("own", "f8", ("own",), compression="zlib")[:] = 1.0
        file.createVariable("notes", "f8", ("own",), compression="zlib")[:] = range(5000)
    with h5py.File(path) as file:
        chunk = file["notes"].id.get_chunk_info(0)
    with path.open("r+b") as file:
        file.seek(chunk.byte_offset)
        file.write(b"\xff" * chunk.size)
    for _ in range(2):
        with archives.reading(path) as archive:
            assert archive["tension"].size
        with pytest.raises(ArchiveError, match="NetCDF: "), archives.reading(path) as archive:
            archive["notes"].load()


def test_a_file_that_is_gone_is_not_given_from_memory(rich_test, write):
    path, archives = write(rich_test), ArchivesInMemory()
    with archives.reading(path):
        path.unlink()
    with pytest.raises(ArchiveError, match="there is no archive"), archives.reading(path):
        pass


def test_a_step_cannot_change_what_the_next_one_is_given(rich_test, write):
    path, archives = write(rich_test), ArchivesInMemory()
    for _ in range(2):
        with archives.reading(path) as archive:
            assert "added" not in archive
            archive["added"] = 1.0
            for variable in archive.drop_vars("added").variables.values():
                with pytest.raises(ValueError, match="read-only"):
                    variable.values[...] = 0
                for attribute in variable.attrs.values():
                    assert not (isinstance(attribute, np.ndarray) and attribute.flags.writeable)
            archive.attrs["title"] = ""
    with archives.reading(path) as archive, reading(path) as on_disk:
        assert archive.identical(on_disk)


def test_as_many_are_kept_as_there_is_room_for(
    rich_test, bare_test, write, opened, tmp_path, monkeypatch
):
    monkeypatch.setattr(module, "_MOST", 1)
    first, archives = write(rich_test), ArchivesInMemory()
    first = first.replace(tmp_path / "first.nc")
    second = write(bare_test)
    for _ in range(2):
        for path in (first, second):
            with archives.reading(path) as archive:
                assert np.all(np.isfinite(archive["diameter"]))
    assert opened == ["first.nc", second.name, second.name]


@pytest.mark.parametrize("limit", ["_LARGEST", "_ROOM"])
def test_what_is_large_is_not_read_whole(limit, rich_test, write, opened, monkeypatch):
    monkeypatch.setattr(module, limit, 100)
    path, archives = write(rich_test), ArchivesInMemory()
    for _ in range(2):
        with archives.reading(path) as archive:
            assert not archive.variables["tension"]._in_memory
    assert len(opened) == 2


def test_an_error_in_a_block_is_that_of_the_block(rich_test, write):
    path, archives = write(rich_test), ArchivesInMemory()
    for _ in range(2):
        with pytest.raises(KeyError, match="none"), archives.reading(path) as archive:
            archive.variables["none"]
