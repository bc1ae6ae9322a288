"""Files come over the net whole or not at all, and what goes wrong is said in words."""

import errno
import pickle
import sys

import pytest
import stores

from reduction.readers.remote_files import PACKAGES, allowed, base_name, fetch, product_fault
from reduction.record.errors import ArchiveError, LogError, SettingsError

DATA = bytes(range(256)) * 1000


@pytest.fixture
def bucket():
    with stores.object_store() as store:
        store.objects["bucket/raw/T.csv"] = DATA
        yield store


@pytest.fixture
def site():
    with stores.server() as server:
        server.files["raw/T.csv"] = DATA
        yield server


def test_a_file_of_a_store_is_copied_whole(bucket, tmp_path):
    copy = tmp_path / "0" / "T.csv"
    fetch("s3://bucket/raw/T.csv", copy)
    assert copy.read_bytes() == DATA


@pytest.mark.parametrize(
    ("user", "query"), [("", ""), ("ann:secret", ""), ("ann:secret", "signature=abcdef")]
)
def test_a_file_of_a_server_is_copied_whole(site, tmp_path, user, query):
    site.user = user
    fetch(site.address("raw/T.csv", user=user, query=query), tmp_path / "T.csv")
    assert (tmp_path / "T.csv").read_bytes() == DATA
    assert all(path.endswith(query) for path in site.asked)


def test_a_file_of_unknown_size_is_copied(site, tmp_path):
    site.unsized.add("raw/T.csv")
    fetch(site.address("raw/T.csv"), tmp_path / "T.csv")
    assert (tmp_path / "T.csv").read_bytes() == DATA


def fault_of(address, target, match):
    with pytest.raises(LogError, match=match) as caught:
        fetch(address, target)
    assert not target.exists()
    assert "secret" not in str(caught.value) and "abcdef" not in str(caught.value)
    # what a package raised may hold a signature, and may not go to another process
    assert caught.value.__cause__ is None and caught.value.__context__ is None
    assert str(pickle.loads(pickle.dumps(caught.value))) == str(caught.value)  # noqa: S301
    return caught.value


def test_a_file_that_is_not_there(bucket, site, tmp_path):
    message = r"^s3://bucket/raw/U.csv: there is no such file; needed the address of a file"
    fault_of("s3://bucket/raw/U.csv", tmp_path / "U", message)
    message = rf"^{site.address('raw/U.csv')}: there is no such file"
    address = site.address("raw/U.csv", user="ann:secret", query="signature=abcdef")
    fault_of(address, tmp_path / "U", message)


def test_a_folder_is_no_file(bucket, tmp_path):
    message = "^s3://bucket/raw: it is a folder; needed the address of a file"
    fault_of("s3://bucket/raw", tmp_path / "raw", message)


def test_a_file_that_may_not_be_read(bucket, site, tmp_path):
    bucket.closed.add("bucket/raw/T.csv")
    message = "^s3://bucket/raw/T.csv: there is no permission: it cannot be read; found PermissionE"
    fault_of("s3://bucket/raw/T.csv", tmp_path / "T", message)
    for status in (401, 403):
        site.statuses["raw/T.csv"] = status
        address = site.address("raw/T.csv", user="ann:secret", query="signature=abcdef")
        fault_of(address, tmp_path / "T", "raw/T.csv: there is no permission: it cannot be read")


def test_a_host_that_does_not_answer(tmp_path):
    with stores.server() as gone:
        address = gone.address("raw/T.csv", user="ann:secret")
    fault_of(address, tmp_path / "T", "raw/T.csv: its host cannot be reached, or .*; found ")


def test_a_server_with_a_fault_of_its_own(site, tmp_path):
    site.statuses["raw/T.csv"] = 500
    fault_of(site.address("raw/T.csv"), tmp_path / "T", "it cannot be read; found .*500")


def test_a_transfer_that_breaks_off(bucket, site, tmp_path):
    bucket.cut["bucket/raw/T.csv"] = 1000
    message = (
        "^s3://bucket/raw/T.csv: it cannot be read; found RuntimeError: the other side is gone"
    )
    fault_of("s3://bucket/raw/T.csv", tmp_path / "T", message)
    site.cut["raw/T.csv"] = 1000
    address = site.address("raw/T.csv", query="signature=abcdef")
    fault_of(
        address, tmp_path / "T", r"raw/T.csv: it cannot be read; found \w*(Payload|Length)Error"
    )


def test_a_transfer_that_loses_a_byte_in_silence(bucket, tmp_path):
    bucket.short.add("bucket/raw/T.csv")
    message = "T.csv: the transfer was interrupted; found 255999 bytes; needed 256000 bytes"
    fault_of("s3://bucket/raw/T.csv", tmp_path / "T", message)


def test_a_file_that_changes_while_it_is_read(bucket, tmp_path):
    bucket.moving.add("bucket/raw/T.csv")
    message = (
        r"T.csv: the file changed while it was read; found 256000 bytes \(\w+\), then 256001 bytes "
        r"\(\w+\); needed a file that nothing writes to. Wait until the logger or the copy has ended"
    )
    fault_of("s3://bucket/raw/T.csv", tmp_path / "T", message)


def test_a_full_disk_is_told_from_a_fault_of_the_store(bucket, tmp_path, monkeypatch):
    def full(self, *args, **kwargs):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(bucket, "get_file", full)
    message = "there is no room on this machine for a copy; found OSError: .*TMPDIR"
    fault_of("s3://bucket/raw/T.csv", tmp_path / "T", message)


@pytest.mark.parametrize(
    ("error", "told"),
    [
        (("NoCredentialsError", "no key"), "there is no permission: it cannot be read; found NoC"),
        (("EndpointConnectionError", "no"), "its host cannot be reached, or .*; found EndpointC"),
        (("SomeError", "a key of abcdef, and secret"), "it cannot be read; found SomeError: a key"),
        (("SomeError", ""), "it cannot be read; found SomeError$"),
    ],
)
def test_the_fault_of_a_package_is_told_by_its_kind(bucket, tmp_path, monkeypatch, error, told):
    name, text = error

    def refuse(self, *args, **kwargs):
        raise type(name, (Exception,), {})(text)

    monkeypatch.setattr(bucket, "get_file", refuse)
    monkeypatch.setattr(
        bucket, "_strip_protocol", classmethod(lambda cls, path: "bucket/raw/T.csv")
    )
    fault_of(
        "s3://ann:secret@bucket/raw/T.csv?sig=abcdef", tmp_path / "T",
        f"^s3://bucket/raw/T.csv: {told}",
    )  # fmt: skip


def test_the_fault_of_a_product_is_one_of_an_archive(bucket, tmp_path):
    with pytest.raises(ArchiveError, match="^s3://bucket/A.nc: there is no such file"):
        fetch("s3://bucket/A.nc", tmp_path / "A.nc", fault=product_fault)


@pytest.mark.parametrize(("protocol", "needed"), [("gs", "gcsfs"), ("abfs", "adlfs")])
def test_the_package_of_a_protocol_is_named(protocol, needed, monkeypatch, tmp_path):
    known = sys.modules["fsspec.registry"].known_implementations
    monkeypatch.setitem(known, protocol, known[protocol] | {"class": "no_such_package.Store"})
    message = (
        f"begin with {protocol}:// need a package that is not installed; found "
        f"'?{protocol}://bucket/T.csv'?; needed {needed}"
    )
    with pytest.raises(SettingsError, match=message):
        fetch(f"{protocol}://bucket/T.csv?secret=1", tmp_path / "T")


def test_fsspec_itself_is_named(monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, "fsspec", None)
    message = r'needed fsspec. Install it: pip install "mooring-reduction\[remote\]" s3fs'
    with pytest.raises(SettingsError, match=message):
        fetch("s3://bucket/T.csv", tmp_path / "T")


@pytest.mark.parametrize(
    "address",
    [
        "file:///etc/passwd", "LOCAL://etc/passwd", "simplecache::s3://bucket/T.csv",
        "zip://T.csv::https://h/T.zip", "git://repo/T.csv", "s3://bucket/T\n.csv", "gopher://h/T.csv",
        "memory://a/T.csv",
    ],
)  # fmt: skip
def test_an_address_of_this_machine_a_chained_one_or_another_kind_is_refused(address):
    with pytest.raises(SettingsError, match="the log is not an address that can be used; found "):
        allowed(address, True, what="the log")


def test_nothing_is_fetched_unasked(site):
    address = site.address("raw/T.csv", user="ann:secret", query="signature=abcdef")
    message = (
        f"^--processed is a URL, and URLs are refused without --allow-remote; found "
        f"'{site.address('raw/T.csv')}'; needed --allow-remote "
    )
    with pytest.raises(SettingsError, match=message):
        allowed(address, False, what="--processed")
    assert allowed(address, True, what="--processed") and not allowed("a/b", False, what="a file")
    assert site.asked == []


def test_every_kind_that_has_a_package_is_let_pass():
    assert all(allowed(f"{one.upper()}://h/T.csv", True, what="a log") for one in PACKAGES)


def test_a_name_that_this_machine_refuses_is_told_as_such(site, tmp_path):
    name = "n" * 300
    site.files[name] = DATA
    with pytest.raises(LogError, match=r"it cannot be read; found OSError: .*name too long"):
        fetch(site.address(name), tmp_path / name)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("address", ["https://host/raw/..", "https://host/raw/./", "https://host"])
def test_what_is_no_name_of_a_file_is_no_name_of_a_copy(address):
    assert base_name(address) in ("", "host")
