import codecs
import hashlib
import os

import pytest

from reduction.readers import raw_log as source
from reduction.readers.raw_log import hash_source, read_bytes, source_of, unchanged
from reduction.readers.text_rows import decode
from reduction.record.errors import ArchiveError, LogError, SettingsError


@pytest.fixture
def log(tmp_path):
    path = tmp_path / "log.csv"
    path.write_bytes(b"time,load\n0,1\n")
    return path


def test_hash_is_the_sha256_of_the_bytes(log):
    found = hash_source(log, "a/log.csv")
    assert (found.name, found.size) == ("a/log.csv", 14)
    assert found.sha256 == hashlib.sha256(b"time,load\n0,1\n").hexdigest()
    assert source_of(log.read_bytes(), "a/log.csv") == found


def test_hash_of_a_file_larger_than_one_block_is_the_same(tmp_path):
    path = tmp_path / "large.csv"
    data = b"0.1,0.2\n" * 400_000
    path.write_bytes(data)
    assert hash_source(path, "x").sha256 == hashlib.sha256(data).hexdigest()


@pytest.mark.parametrize("read", [read_bytes, lambda path: hash_source(path, "x")])
def test_an_empty_file_is_refused(tmp_path, read):
    path = tmp_path / "log.csv"
    path.touch()
    with pytest.raises(LogError, match=r"log\.csv: the file is empty; found 0 bytes; needed a log"):
        read(path)


@pytest.mark.parametrize("read", [read_bytes, lambda path: hash_source(path, "x")])
def test_a_file_that_is_not_there_is_refused(tmp_path, read):
    with pytest.raises(LogError, match="the file cannot be read; found No such file"):
        read(tmp_path / "log.csv")


def test_a_folder_is_refused(tmp_path):
    with pytest.raises(LogError, match="this is not a readable file; found a folder"):
        read_bytes(tmp_path)


@pytest.mark.parametrize(("after", "verb"), [(b"time", "shrank"), (b"x" * 20, "grew")])
def test_a_file_whose_size_changes_while_read_is_refused(log, after, verb):
    with (
        pytest.raises(LogError, match=rf"{verb} while it was read; found 14 bytes, then"),
        unchanged(log),
    ):
        log.write_bytes(after)


def test_a_file_that_is_rewritten_while_read_is_refused(log):
    with (
        pytest.raises(LogError, match="changed while it was read.*Wait until the logger"),
        unchanged(log),
    ):
        os.utime(log, ns=(0, 1))


def test_ascii_is_handed_on_as_it_is(log):
    assert decode(log, b"a,b\n", "utf-8") == b"a,b\n"


def test_utf8_with_a_byte_order_mark_is_accepted(log):
    text = "Kraft [µN]\n".encode()
    for encoding in ("utf-8", "utf-8-sig", "UTF8", "ascii"):
        assert decode(log, codecs.BOM_UTF8 + text, encoding) == text


def test_other_encodings_become_utf8(log):
    assert decode(log, "Prüfzeit\n".encode("latin-1"), "latin-1") == "Prüfzeit\n".encode()
    for encoding in ("utf-16", "utf-16-le"):
        data = codecs.BOM_UTF16_LE + "Prüfzeit\n".encode("utf-16-le")
        assert decode(log, data, encoding) == "Prüfzeit\n".encode()


def test_a_wrong_encoding_names_the_row(log):
    data = "time\nload\nPrüfzeit\n".encode("latin-1")
    with pytest.raises(
        LogError,
        match=r"log\.csv:3: the file is not in the declared encoding; found byte 0xfc; needed "
        r'text in utf-8\. Declare the encoding that the machine wrote, often "latin-1"',
    ):
        decode(log, data, "utf-8")


def test_text_cut_off_in_a_wide_encoding_is_refused(log):
    with pytest.raises(LogError, match=r"log\.csv: the file is not in the declared encoding"):
        decode(log, codecs.BOM_UTF16_LE + b"a\0b", "utf-16")


def test_a_byte_order_mark_of_another_encoding_is_refused(log):
    data = codecs.BOM_UTF16_LE + "time".encode("utf-16-le")
    with pytest.raises(LogError, match='byte-order mark of utf-16; .*Declare encoding = "utf-16"'):
        decode(log, data, "utf-8")
    with pytest.raises(LogError, match="byte-order mark of utf-8; needed latin-1"):
        decode(log, codecs.BOM_UTF8 + b"time", "latin-1")


def test_a_binary_file_is_refused_with_its_row(log):
    with pytest.raises(LogError, match=r"log\.csv:2: the file is binary, not text; found a NUL"):
        decode(log, b"PK\n\x03\0\x04", "utf-8")


def test_an_unknown_encoding_is_a_setting(log):
    with pytest.raises(SettingsError, match="an encoding is not known; found 'klingon'"):
        decode(log, b"a", "klingon")


def test_a_file_that_shrinks_between_look_and_read_is_refused(log, monkeypatch):
    sizes = iter([(14, 1), (4, 1)])
    monkeypatch.setattr(source, "_state", lambda path: next(sizes))
    with pytest.raises(LogError, match="the file shrank while it was read"):
        read_bytes(log)


def test_what_the_system_refuses_of_a_file_that_is_open_is_told_of_that_file(log):
    with (
        pytest.raises(LogError, match=r"log\S*: the file cannot be read; found Input/output error"),
        unchanged(log),
    ):
        raise OSError(5, "Input/output error")  # such as of a close


def test_what_is_refused_of_another_file_meanwhile_is_told_as_it_is(log):
    with pytest.raises(ArchiveError, match=r"^of another file$"), unchanged(log):
        raise ArchiveError("of another file")
