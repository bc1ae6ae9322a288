"""Files go over the net whole or not at all, and what goes wrong is said in words."""

import errno
import pickle
import sys

import pytest
import stores

from reduction.errors import ArchiveError, LogError, SettingsError
from reduction.remote.faults import product_fault, said_of
from reduction.remote.mirror import put_at_end
from reduction.remote.place import allowed, base_name, below, connect, folder_of
from reduction.remote.transfer import fetch, listing, put, remove
from reduction.report.page import is_page_beside

DATA = bytes(range(256)) * 1000


@pytest.fixture
def bucket():
    with stores.object_store() as store:
        store.objects["bucket/raw/T.csv"] = DATA
        yield store


@pytest.fixture
def memory():
    with stores.memory_store() as system:
        yield system


@pytest.fixture
def site():
    with stores.server() as server:
        server.files["raw/T.csv"] = DATA
        yield server


def test_a_file_of_a_store_is_copied_whole(bucket, tmp_path):
    copy = tmp_path / "0" / "T.csv"
    state = fetch("s3://bucket/raw/T.csv", copy)
    assert copy.read_bytes() == DATA and state.size == len(DATA)


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
    assert fetch(site.address("raw/T.csv"), tmp_path / "T.csv").size is None
    assert (tmp_path / "T.csv").read_bytes() == DATA


def test_pages_that_a_folder_no_longer_has_are_taken_away_and_nothing_else(memory, tmp_path):
    there = {
        name: f"/reports/{name}"
        for name in (
            "small/client-report.html", "small/tests-01.html", "small/mine.html",
            "small/below/client-report.html", "other/client-report.html", "client-report.html",
        )
    }  # fmt: skip
    for path in there.values():
        memory.pipe_file(path, b"of an earlier run")
    folder = tmp_path / "reports"
    with put_at_end("memory://reports", folder, beside=is_page_beside):
        (folder / "small").mkdir(parents=True)
        (folder / "small" / "index.html").write_text("new")
        (folder / "small" / "tests-01.html").write_text("new")
    left = {path.removeprefix("/reports/") for path in memory.find("/reports")}
    assert left == set(there) - {"small/client-report.html"} | {"small/index.html"}
    assert memory.cat_file("/reports/small/tests-01.html") == b"new"


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
    fault_of(address, tmp_path / "T", "raw/T.csv: its host cannot be reached; found ")


def test_a_server_with_a_fault_of_its_own(site, tmp_path):
    site.statuses["raw/T.csv"] = 500
    fault_of(site.address("raw/T.csv"), tmp_path / "T", "it cannot be read; found .*500")


def test_a_transfer_that_breaks_off(bucket, site, tmp_path):
    bucket.cut["bucket/raw/T.csv"] = 1000
    message = (
        r"^s3://bucket/raw/T.csv: the transfer broke off; found 1000 of 256000 bytes; RuntimeError: "
        r"the other side is gone; needed all of it. Run again"
    )
    fault_of("s3://bucket/raw/T.csv", tmp_path / "T", message)
    site.cut["raw/T.csv"] = 1000
    address = site.address("raw/T.csv", query="signature=abcdef")
    fault_of(address, tmp_path / "T", r"the transfer broke off; found \d+ of 256000 bytes")


def test_a_transfer_that_loses_a_byte_in_silence(bucket, tmp_path):
    bucket.short.add("bucket/raw/T.csv")
    message = "T.csv: the transfer broke off; found 255999 bytes; needed 256000 bytes"
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


def test_the_fault_of_a_package_is_told_by_its_kind():
    class NoCredentialsError(Exception):
        pass

    address = "gs://bucket/T.csv"
    told = said_of(NoCredentialsError("no key"), address, product_fault, doing="written")
    assert isinstance(told, ArchiveError)
    assert str(told).startswith(
        "gs://bucket/T.csv: there is no permission: it cannot be written; found NoCredentialsError"
    )
    told = said_of(ValueError("a key"), "https://h/T?sig=a key", LogError, doing="read")
    assert str(told) == "https://h/T: it cannot be read; found ValueError: ..."
    told = said_of(ValueError(), "https://h/T", LogError, doing="removed")
    assert str(told) == "https://h/T: it cannot be removed; found ValueError"


@pytest.mark.parametrize(
    ("protocol", "needed"), [("gs", "gcsfs"), ("abfs", "adlfs"), ("oci", "Install ocifs")]
)
def test_the_package_of_a_protocol_is_named(protocol, needed, monkeypatch):
    known = sys.modules["fsspec.registry"].known_implementations
    monkeypatch.setitem(known, protocol, known[protocol] | {"class": "no_such_package.Store"})
    message = (
        f"begin with {protocol}:// need a package that is not installed; found "
        f"'?{protocol}://bucket/T.csv'?; needed {needed}"
    )
    with pytest.raises(SettingsError, match=message):
        connect(f"{protocol}://bucket/T.csv?secret=1")


def test_fsspec_itself_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "fsspec", None)
    message = r'need fsspec; found no .*Install it: pip install "mooring-reduction\[remote\]"'
    with pytest.raises(SettingsError, match=message):
        connect("s3://bucket/T.csv")


def test_a_protocol_that_nobody_knows():
    with pytest.raises(SettingsError, match="begin with gopher:// are not known; found gopher://h"):
        connect("gopher://h/T.csv")


@pytest.mark.parametrize(
    "address",
    [
        "file:///etc/passwd", "LOCAL://etc/passwd", "simplecache::s3://bucket/T.csv",
        "zip://T.csv::https://h/T.zip", "git://repo/T.csv", "s3://bucket/T\n.csv",
    ],
)  # fmt: skip
def test_an_address_of_this_machine_or_a_chained_one_is_refused(address):
    with pytest.raises(SettingsError, match="the log is no address that can be used; found "):
        allowed(address, True, what="the log")


def test_nothing_is_fetched_unasked(site):
    address = site.address("raw/T.csv", user="ann:secret", query="signature=abcdef")
    message = (
        f"^--processed is an address on the net, and none is fetched unasked; found "
        f"'{site.address('raw/T.csv')}'; needed --allow-remote "
    )
    with pytest.raises(SettingsError, match=message):
        allowed(address, False, what="--processed")
    assert allowed(address, True, what="--processed") and not allowed("a/b", False, what="a file")
    assert site.asked == []


def test_what_lies_beside_a_file_on_the_net():
    assert folder_of("https://u:p@h/raw/c.toml?sig=a/b") == "https://u:p@h/raw"
    assert below("https://u:p@h/raw", "a b/100 %.csv") == "https://u:p@h/raw/a%20b/100%20%25.csv"
    assert below("s3://bucket/raw/", "a b.csv") == "s3://bucket/raw/a b.csv"
    assert base_name("https://u:p@h/raw/c.toml?sig=a/b") == "c.toml"


def test_an_object_is_put_whole(bucket, tmp_path):
    (tmp_path / "T.nc").write_bytes(DATA)
    put(tmp_path / "T.nc", "s3://bucket/new/T.nc")
    assert bucket.objects["bucket/new/T.nc"] == DATA and bucket.written == ["bucket/new/T.nc"]


def test_elsewhere_a_file_is_put_beside_and_renamed(memory, tmp_path):
    (tmp_path / "T.nc").write_bytes(DATA)
    put(tmp_path / "T.nc", "memory://p/T.nc")
    put(tmp_path / "T.nc", "memory://p/T.nc")
    assert memory.find("/p") == ["/p/T.nc"] and memory.cat("/p/T.nc") == DATA


def test_a_file_that_is_not_put_leaves_what_was_there(memory, tmp_path, monkeypatch):
    memory.pipe("/p/T.nc", b"before")
    (tmp_path / "T.nc").write_bytes(DATA)

    def half(self, source, target, **kwargs):
        self.pipe(target, DATA[:10])
        raise OSError("the line is cut")

    monkeypatch.setattr(type(memory), "put_file", half)
    message = "^memory://p/T.nc: it cannot be written; found OSError: the line is cut"
    with pytest.raises(ArchiveError, match=message):
        put(tmp_path / "T.nc", "memory://p/T.nc")
    assert memory.find("/p") == ["/p/T.nc"] and memory.cat("/p/T.nc") == b"before"


def test_a_file_that_may_not_be_put(bucket, tmp_path):
    (tmp_path / "T.nc").write_bytes(DATA)
    bucket.closed.add("bucket/T.nc")
    with pytest.raises(ArchiveError, match="no permission: it cannot be written; found Permission"):
        put(tmp_path / "T.nc", "s3://bucket/T.nc")
    with pytest.raises(ArchiveError, match="no permission: it cannot be removed"):
        remove("s3://bucket/T.nc")


def test_a_bucket_that_is_not_there(bucket, tmp_path, monkeypatch):
    def nowhere(self, source, target, **kwargs):
        raise FileNotFoundError("The specified bucket does not exist")

    (tmp_path / "T.nc").write_bytes(DATA)
    monkeypatch.setattr(bucket, "put_file", nowhere)
    with pytest.raises(ArchiveError, match="^s3://none/T.nc: there is no such bucket or folder"):
        put(tmp_path / "T.nc", "s3://none/T.nc")


def test_a_file_that_does_not_arrive_whole(bucket, tmp_path):
    (tmp_path / "T.nc").write_bytes(DATA)
    bucket.short.add("bucket/T.nc")
    message = "s3://bucket/T.nc: the file did not arrive whole; found 255999 bytes; needed 256000"
    with pytest.raises(ArchiveError, match=message):
        put(tmp_path / "T.nc", "s3://bucket/T.nc")


def test_nothing_is_written_or_listed_over_http(tmp_path):
    (tmp_path / "T.nc").write_bytes(DATA)
    with pytest.raises(
        SettingsError, match="nothing can be written to https://; found https://h/T"
    ):
        put(tmp_path / "T.nc", "https://u:p@h/T.nc")
    with pytest.raises(SettingsError, match="a folder behind http:// cannot be listed; found http"):
        listing("http://h/processed")


def test_a_folder_is_listed_as_it_is_now(bucket):
    assert listing("s3://bucket/none") == {}
    bucket.objects["bucket/p/x/A.nc"] = b"1"
    assert list(listing("s3://bucket/p/x/")) == ["A.nc"]
    bucket.objects["bucket/p/x/tables/a.csv"] = b"12"
    assert {name: one.size for name, one in listing("s3://bucket/p/x").items()} == {
        "A.nc": 1, "tables/a.csv": 2,
    }  # fmt: skip


def test_a_folder_that_may_not_be_looked_at(bucket, monkeypatch):
    def closed(self, path, **kwargs):
        raise PermissionError("Access Denied")

    monkeypatch.setattr(bucket, "find", closed)
    with pytest.raises(ArchiveError, match="^s3://bucket/p: there is no permission"):
        listing("s3://bucket/p")


def test_a_name_that_this_machine_refuses_is_told_as_such(site, tmp_path):
    name = "n" * 300
    site.files[name] = DATA
    with pytest.raises(LogError, match=r"it cannot be copied; found OSError: .*name too long"):
        fetch(site.address(name), tmp_path / name)
    assert list(tmp_path.iterdir()) == []


def test_a_file_that_is_the_folder_of_another_has_no_copy(bucket, tmp_path):
    bucket.objects["bucket/raw/T.csv/part.csv"] = DATA
    fetch("s3://bucket/raw/T.csv", tmp_path / "T.csv")
    fault_of(
        "s3://bucket/raw/T.csv/part.csv", tmp_path / "T.csv" / "part.csv",
        r"part.csv: its copy would lie where another file is; found File exists; needed files of",
    )  # fmt: skip
    assert (tmp_path / "T.csv").read_bytes() == DATA


@pytest.mark.parametrize("address", ["https://host/raw/..", "https://host/raw/./", "https://host"])
def test_what_is_no_name_of_a_file_is_no_name_of_a_copy(address):
    assert base_name(address) in ("", "host")
