"""A file appears whole or not at all."""

import pytest

from reduction.archive.whole import whole_file


def test_the_file_appears_when_the_block_ends_well(tmp_path):
    path = tmp_path / "folder" / "a.txt"
    with whole_file(path) as part:
        part.write_text("new")
        assert not path.exists()
        assert part.parent == path.parent
    assert path.read_text() == "new"
    assert list(path.parent.iterdir()) == [path]


@pytest.mark.parametrize("error", [KeyboardInterrupt, ValueError])
def test_a_block_that_is_cut_short_leaves_the_file_before(tmp_path, error):
    path = tmp_path / "a.txt"
    path.write_text("old")

    def cut_short():
        with whole_file(path) as part:
            part.write_text("half")
            raise error

    with pytest.raises(error):
        cut_short()
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_a_block_that_writes_nothing_leaves_the_file_before(tmp_path):
    path = tmp_path / "a.txt"
    path.write_text("old")

    def forget():
        with whole_file(path):
            pass

    with pytest.raises(FileNotFoundError):
        forget()
    assert path.read_text() == "old"


def test_the_file_has_the_rights_that_any_new_file_has(tmp_path):
    plain = tmp_path / "plain.txt"
    plain.write_text("x")
    with whole_file(tmp_path / "a.txt") as part:
        part.write_text("x")
    assert (tmp_path / "a.txt").stat().st_mode == plain.stat().st_mode
