"""Campaigns whose logs and products lie on the net: the same numbers, and nothing left behind."""

import csv
import json
import os
import pickle
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest
import smallcampaign
import stores
import xarray as xr

import reduction
from reduction.batch import secondpass
from reduction.campaign import staged
from reduction.errors import ArchiveError, LogError, SettingsError
from reduction.remote.mirror import mirrored

ROOT = Path(__file__).parents[2]
CAMPAIGN = f'tests = "tests.csv"\n{smallcampaign.CAMPAIGN}'
SECRETS = ("anneliese", "pass-word-7q", "k9vQx2Zt", "se=2026")
USER, QUERY = "anneliese:pass-word-7q", "signature=k9vQx2Zt&se=2026"


def write_campaign(folder):
    """Two synthetic logs, their marks, a table of tests, and a campaign."""
    smallcampaign.write_logs(folder, "logs")
    table = "id,file,n_cycles,marks\nA,logs/A.csv,10,marks.csv\nB,logs/B.csv,10,marks.csv\n"
    (folder / "tests.csv").write_text(table)
    (folder / "campaign.toml").write_text(CAMPAIGN)
    return folder


def files_below(folder):
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


def without_seconds(status):
    return [row[:-1] for row in csv.reader(status.decode().splitlines())]


@pytest.fixture(scope="session")
def here(tmp_path_factory, command):
    """The campaign and its products on this machine."""
    folder = tmp_path_factory.mktemp("here")
    write_campaign(folder / "raw")
    done = command("run", "raw/campaign.toml", "--quiet", cwd=folder)
    assert done.returncode == 0, done.stderr
    return folder


@pytest.fixture(autouse=True)
def scratch(tmp_path_factory, monkeypatch):
    """Where copies go; it is empty after every test, also after one of a failure."""
    folder = tmp_path_factory.mktemp("scratch")
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    yield folder
    assert list(folder.iterdir()) == []


@pytest.fixture
def bucket(here):
    """The campaign in an object store, without products."""
    with stores.object_store() as store:
        for name, data in files_below(here / "raw").items():
            store.objects[f"bucket/raw/{name}"] = data
        yield store


@pytest.fixture
def processed(bucket, here):
    """Its products there too."""
    for name, data in files_below(here / "processed").items():
        bucket.objects[f"bucket/processed/{name}"] = data
    return bucket


def products_in(objects, root):
    return {
        name.removeprefix(f"{root}/"): data
        for name, data in objects.items()
        if name.startswith(f"{root}/")
    }


def assert_same_products(found, expected):
    assert sorted(found) == sorted(expected)
    for name, data in expected.items():
        if name.endswith("status.csv"):
            assert without_seconds(found[name]) == without_seconds(data)
        else:
            # where products lie on the net there is no page of design values to lead to
            assert found[name] == data.replace(LINK, b""), name


LINK = b"""<p class="beside"><a href="../design-values.html">Design values of all campaigns</a></p>
"""
RUN = (
    "run", "s3://bucket/raw/campaign.toml", "--processed", "s3://bucket/processed", "--reports",
    "s3://bucket/reports", "--allow-remote",
)  # fmt: skip


def test_products_of_a_remote_campaign_are_byte_for_byte_those_of_a_local_one(
    bucket, here, command, tmp_path
):
    done = command(*RUN, "--json", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    for kind in ("processed", "reports"):
        expected = files_below(here / kind)
        # it is of all campaigns, of which the copy here holds one
        assert (expected.pop("design-values.html", None) is not None) == (kind == "reports")
        assert_same_products(products_in(bucket.objects, f"bucket/{kind}"), expected)
    assert list(tmp_path.iterdir()) == []  # nothing on this machine
    answer = json.loads(done.stdout)
    assert answer["processed"] == "s3://bucket/processed/small"
    assert answer["report"] == "s3://bucket/reports/small/index.html"
    assert "s3://bucket/processed/small/tables/moduli.csv" in answer["tables"]
    # archives before tables, the table of what was done after them, the page at the end
    kinds = [re.sub(r".*/", "", name) for name in bucket.written]
    assert kinds[:2] == ["A.nc", "B.nc"] and kinds[-2:] == ["status.csv", "index.html"]


def test_the_same_in_a_store_in_which_files_are_renamed(here, command, tmp_path):
    with stores.memory_store() as memory:
        memory.put(f"{here / 'raw'}/", "/raw/", recursive=True)
        done = command(*(word.replace("s3://bucket", "memory:/") for word in RUN), cwd=tmp_path)
        assert done.returncode == 0, done.stderr
        found = {
            name.removeprefix("/processed/"): memory.cat(name) for name in memory.find("/processed")
        }
        assert_same_products(found, files_below(here / "processed"))
        assert "products: memory://processed/small" in done.stdout


def test_a_second_run_finds_everything_unchanged_and_writes_what_it_did(
    processed, here, command, tmp_path
):
    done = command(*RUN, "--json", cwd=tmp_path)
    assert [test["status"] for test in json.loads(done.stdout)["tests"]] == ["unchanged"] * 2
    assert sorted(processed.written) == [
        "bucket/processed/small/status.csv", "bucket/reports/small/index.html",
    ]  # fmt: skip
    one = command(*RUN, "--test", "A", "--force", cwd=tmp_path)
    assert one.returncode == 0, one.stderr
    rows = without_seconds(processed.objects["bucket/processed/small/status.csv"])
    assert [row[:2] for row in rows[1:]] == [["A", "reduced_with_notes"], ["B", "unchanged"]]


def test_what_the_laboratory_states_goes_with_the_archives_and_is_taken_away_with_them(
    processed, command, tmp_path
):
    campaign = processed.objects["bucket/raw/campaign.toml"]
    processed.objects["bucket/raw/campaign.toml"] = campaign + b'\n[report]\nnumber = "17"\n'
    answer = json.loads(command(*RUN, "--json", cwd=tmp_path).stdout)
    assert [test["status"] for test in answer["tests"]] == ["unchanged"] * 2
    assert answer["client_report"] == "s3://bucket/reports/small/client-report.html"
    assert b'"number": "17"' in processed.objects["bucket/processed/small/report.json"]
    page = processed.objects["bucket/reports/small/client-report.html"]
    again = command(
        "report", "s3://bucket/processed/small", "--reports", tmp_path / "pages", "--allow-remote"
    )
    assert again.returncode == 0, again.stderr
    assert (tmp_path / "pages" / "small" / "client-report.html").read_bytes() == page
    processed.objects["bucket/raw/campaign.toml"] = campaign
    assert json.loads(command(*RUN, "--json", cwd=tmp_path).stdout)["client_report"] is None
    assert "bucket/processed/small/report.json" not in processed.objects


def test_logs_behind_signed_addresses_leave_no_secret_anywhere(here, command, tmp_path):
    raw = tmp_path / "raw"
    shutil.copytree(here / "raw", raw)
    with stores.server() as site:
        site.user = USER
        for name in ("A.csv", "B.csv"):
            site.files[f"raw/{name}"] = (raw / "logs" / name).read_bytes()
            (raw / "logs" / name).unlink()
        table = (raw / "tests.csv").read_text()
        for name in ("A.csv", "B.csv"):
            address = site.address(f"raw/{name}", user=USER, query=QUERY)
            table = table.replace(f"logs/{name}", address)
        (raw / "tests.csv").write_text(table)
        refused = command("run", raw / "campaign.toml", cwd=tmp_path)
        assert refused.returncode == 2 and site.asked == []
        done = command("run", raw / "campaign.toml", "--allow-remote", cwd=tmp_path)
        assert done.returncode == 0, done.stderr
        names = {name: site.address(f"raw/{name}") for name in ("A.csv", "B.csv")}
        site.statuses["raw/B.csv"] = 403
        failed = command("run", raw / "campaign.toml", "--allow-remote", cwd=tmp_path / "raw")
        assert failed.returncode == 3
    assert f"{names['B.csv']}: there is no permission: it cannot be read" in failed.stderr
    assert "reduced_with_notes" in failed.stdout  # the other test
    for text in (refused.stderr, done.stdout, done.stderr, failed.stdout, failed.stderr):
        assert not any(secret in text for secret in SECRETS)
    products = {**files_below(tmp_path / "processed"), **files_below(tmp_path / "reports")}
    after_the_fault = files_below(raw / "processed") | files_below(raw / "reports")
    for name, data in [*products.items(), *after_the_fault.items()]:
        assert not any(secret.encode() in data for secret in SECRETS), name
    expected = files_below(here / "processed")
    assert products.keys() >= expected.keys()
    for test in ("A", "B"):
        with (
            xr.open_dataset(tmp_path / "processed" / "small" / f"{test}.nc") as found,
            xr.open_dataset(here / "processed" / "small" / f"{test}.nc") as local,
        ):
            other = {name for name in local.attrs if found.attrs[name] != local.attrs[name]}
            assert other == {"raw_file"}
            assert found.attrs["raw_file"] == names[f"{test}.csv"]
            xr.testing.assert_identical(found.drop_attrs(), local.drop_attrs())
    for name, data in expected.items():
        if name.endswith(".csv") and "status" not in name:
            assert products[name] == data, name


@pytest.mark.parametrize(
    ("words", "what"),
    [
        (("run", "s3://bucket/raw/campaign.toml"), "the campaign"),
        (("check", "s3://bucket/raw/campaign.toml"), "the campaign"),
        (("run", "raw/campaign.toml", "--processed", "s3://bucket/p"), "--processed"),
        (("run", "raw/campaign.toml", "--reports", "s3://bucket/p"), "--reports"),
        (("report", "s3://bucket/processed/small"), "the source"),
        (("report", "processed", "--reports", "s3://bucket/p"), "--reports"),
        (("lookup", "s3://bucket/processed/small", "--list"), "the source"),
        (("lookup", "published", "--quantity", "K_ap", "--against", "s3://bucket/p"), "the source"),
        (("export", "s3://bucket/p/A.nc", "--to", "csv", "--out", "a.csv"), "the source"),
        (("budget", "s3://bucket/p/A.nc"), "the source"),
        (("composite", "s3://bucket/p/A.nc"), "the source"),
        (("compare", "s3://bucket/p/A.nc", "c.toml"), "the source"),
    ],
)  # fmt: skip
def test_without_the_option_nothing_is_fetched(here, bucket, command, monkeypatch, words, what):
    monkeypatch.setattr(bucket, "info", None)  # an attempt would be told
    done = command(*words, cwd=here)
    assert done.returncode == 2
    assert f"{what} is an address on the net, and none is fetched unasked" in done.stderr
    assert "needed --allow-remote" in done.stderr


@pytest.mark.parametrize("name", ["tests", "results", "marks"])
def test_a_table_is_never_an_address(here, tmp_path, name):
    raw = tmp_path / "raw"
    shutil.copytree(here / "raw", raw)
    text = (raw / "campaign.toml").read_text()
    line = 'marks = "s3://b/t.csv"' if name == "marks" else f'{name} = "s3://k:pw@b/t.csv"'
    if name == "tests":
        text = text.replace('tests = "tests.csv"', line)
    elif name == "results":
        text = f"{line}\n{text}"
    else:
        text += f"strain = {{ {line} }}\n"
    (raw / "campaign.toml").write_text(text)
    message = "only the log of a test may be an address on the net; found 's3://b/t.csv'; needed a"
    with (
        pytest.raises(SettingsError, match=message),
        staged.staged_campaign(raw / "campaign.toml", allow_remote=True),
    ):
        pass


def test_check_reads_a_remote_campaign_and_writes_nothing(bucket, command, tmp_path):
    done = command(
        "check", "s3://bucket/raw/campaign.toml", "--allow-remote", "--json", cwd=tmp_path
    )
    assert done.returncode == 0, done.stderr
    assert [test["n_cycles"] for test in json.loads(done.stdout)["tests"]] == [10, 10]
    assert bucket.written == []


def test_a_log_that_is_not_there_is_the_error_of_its_test(bucket, command, tmp_path, scratch):
    del bucket.objects["bucket/raw/logs/B.csv"]
    bucket.objects["bucket/processed/small/Z.nc"] = b"no archive"
    done = command(*RUN, cwd=tmp_path)
    assert done.returncode == 3
    message = "s3://bucket/raw/logs/B.csv: there is no such file; needed the address of a file"
    assert message in done.stderr
    rows = without_seconds(bucket.objects["bucket/processed/small/status.csv"])
    assert [row[:2] for row in rows[1:]] == [["A", "reduced_with_notes"], ["B", "failed"]]
    assert rows[2][3] == message
    assert "bucket/processed/small/B.nc" not in bucket.objects
    page = bucket.objects["bucket/reports/small/index.html"].decode()
    assert message in page and str(scratch) not in page
    assert "s3://bucket/processed/small/Z.nc: belongs to no test of this campaign" in done.stderr
    assert "Z.nc is not a netCDF file" in page


def test_a_fault_in_a_remote_log_is_told_by_its_address_and_row(bucket, command, tmp_path):
    lines = bucket.objects["bucket/raw/logs/B.csv"].split(b"\n")
    lines[20] = lines[20].replace(b",", b",x", 1)
    bucket.objects["bucket/raw/logs/B.csv"] = b"\n".join(lines)
    done = command(*RUN, cwd=tmp_path)
    assert done.returncode == 3
    assert "\ns3://bucket/raw/logs/B.csv:21 [crosshead_ft]: " in done.stderr


@pytest.mark.parametrize(
    ("change", "status", "message"),
    [
        ({"campaign.toml": b"[campaign"}, 2, "s3://bucket/raw/campaign.toml: the campaign is not TOML"),
        (
            {"campaign.toml": CAMPAIGN.encode() + b"colour = 1\n"}, 2,
            "s3://bucket/raw/campaign.toml: 1 setting cannot be used, first 'defaults.colour'",
        ),
        ({"tests.csv": None}, 3, "s3://bucket/raw/tests.csv: the file is not there; needed as s3://"),
        ({"marks.csv": None}, 3, "s3://bucket/raw/marks.csv: the file is not there"),
        ({"campaign.toml": None}, 3, "s3://bucket/raw/campaign.toml: there is no such file"),
        (
            {"tests.csv": b"id,file\nA,../secret.csv\n"}, 2,
            "s3://bucket/raw/campaign.toml: a file lies outside the campaign folder; found '../sec",
        ),
        (
            {"tests.csv": b"id,file,marks\nA,logs/A.csv,../../marks.csv\n"}, 2,
            "a file lies outside the campaign folder; found '../../marks.csv'",
        ),
        (
            {"tests.csv": b"id,file\nA,file:///etc/passwd\n"}, 2,
            "the log of test 'A' is no address that can be used; found 'file:///etc/passwd'",
        ),
        (
            {"tests.csv": b"id,file\nA,s3://k:pw@b/x?v=1\nB,s3://b/x?v=2\n"}, 2,
            "two addresses of logs differ only in what is not shown of them; found 's3://b/x'",
        ),
        ({"marks.csv": b"test,a"}, 3, "s3://bucket/raw/marks.csv:1: the marks file lacks a column"),
    ],
)  # fmt: skip
def test_a_fault_of_a_remote_campaign_is_told_by_its_address(
    bucket, command, tmp_path, change, status, message
):
    for name, data in change.items():
        if data is None:
            del bucket.objects[f"bucket/raw/{name}"]
        else:
            bucket.objects[f"bucket/raw/{name}"] = data
    done = command(*RUN, "--json", cwd=tmp_path)
    assert done.returncode == status
    assert message in done.stderr
    assert json.loads(done.stdout)["error"] == done.stderr.strip("\n")
    assert bucket.written == []


def test_a_campaign_goes_to_a_worker_with_its_copies_and_without_its_addresses(here, tmp_path):
    shutil.copytree(here / "raw", tmp_path / "raw")
    with stores.server() as site:
        site.files["A.csv"] = (here / "raw" / "logs" / "A.csv").read_bytes()
        table = "id,file,n_cycles,marks\n"
        for name in ("A", "B"):
            address = site.address(f"{name}.csv", user=USER, query=QUERY)
            table += f"{name},{address},10,marks.csv\n"
        (tmp_path / "raw" / "tests.csv").write_text(table)
        with staged.staged_campaign(tmp_path / "raw" / "campaign.toml", allow_remote=True) as one:
            sent = pickle.dumps(one)
            there = pickle.loads(sent)  # noqa: S301
            assert there.file(site.address("A.csv")).read_bytes() == site.files["A.csv"]
            with pytest.raises(LogError, match=f"^{site.address('B.csv')}: there is no such file"):
                there.file(site.address("B.csv"))
    assert not any(secret.encode() in sent for secret in SECRETS)
    assert not any(secret in repr(there) for secret in SECRETS)


def test_a_table_that_may_not_be_read_is_told(bucket):
    bucket.closed.add("bucket/raw/marks.csv")
    with (
        pytest.raises(LogError, match="^s3://bucket/raw/marks.csv: there is no permission"),
        staged.staged_campaign("s3://bucket/raw/campaign.toml", allow_remote=True),
    ):
        pass


def test_logs_that_have_no_room_are_not_begun(bucket, monkeypatch):
    usage = shutil.disk_usage("/")._replace(free=1000)
    monkeypatch.setattr(shutil, "disk_usage", lambda path: usage)
    message = (
        r"^s3://bucket/raw/campaign.toml: there is no room on this machine for copies of the logs; "
        r"found 1000 bytes free in .*; needed \d+ bytes. Free some space, or .* TMPDIR"
    )
    with (
        pytest.raises(LogError, match=message),
        staged.staged_campaign("s3://bucket/raw/campaign.toml", allow_remote=True),
    ):
        pass


def test_each_file_is_announced_and_fetched_once(bucket, monkeypatch):
    fetched = []
    monkeypatch.setattr(
        staged, "fetch", lambda address, target, before=None, fetch=staged.fetch: (
            fetched.append(address), fetch(address, target, before=before),
        ),
    )  # fmt: skip
    said = []
    with staged.staged_campaign(
        "s3://bucket/raw/campaign.toml",
        allow_remote=True,
        progress=lambda stage, name: said.append((stage, name)),
    ) as campaign:
        assert campaign.file("logs/A.csv").read_bytes() == bucket.objects["bucket/raw/logs/A.csv"]
        assert campaign.shown("logs/A.csv") == "s3://bucket/raw/logs/A.csv"
        assert campaign.addresses == {}
    names = ["campaign.toml", "tests.csv", "marks.csv", "logs/A.csv", "logs/B.csv"]
    assert said == [("fetch", name) for name in names]
    assert fetched == [f"s3://bucket/raw/{name}" for name in names]


def test_products_that_were_finished_before_an_interruption_are_kept(
    bucket, command, tmp_path, monkeypatch
):
    done = []
    bring = secondpass.bring_up_to_date

    def interrupted(*arguments, **options):
        if done:
            raise KeyboardInterrupt
        done.append(bring(*arguments, **options))
        return done[0]

    monkeypatch.setattr(secondpass, "bring_up_to_date", interrupted)
    ended = command(*RUN, cwd=tmp_path)
    assert ended.returncode == 130
    assert bucket.written == ["bucket/processed/small/A.nc"]


@pytest.mark.skipif(os.name != "posix", reason="needs signals")
def test_a_command_that_is_told_to_end_takes_its_copies_away(here, tmp_path):
    with stores.server() as site:
        site.files |= {f"raw/{name}": data for name, data in files_below(here / "raw").items()}
        site.stopped.add("raw/logs/B.csv")
        scratch = tmp_path / "scratch"
        scratch.mkdir()
        words = ("run", site.address("raw/campaign.toml"), "--allow-remote")
        with subprocess.Popen(
            [sys.executable, "-m", "reduction", *words],
            cwd=tmp_path, env=os.environ | {"TMPDIR": str(scratch), "PYTHONPATH": str(ROOT)},
            stderr=subprocess.PIPE, text=True,
        ) as process:  # fmt: skip
            assert site.has_stopped.wait(60)
            assert (next(scratch.iterdir()) / "campaign" / "logs" / "A.csv").is_file()
            process.terminate()
            _, told = process.communicate(timeout=60)
    assert process.returncode == 130
    assert told == "interrupted; products that were finished are kept\n"
    assert list(scratch.iterdir()) == []


def test_two_runs_do_not_mix(processed, here, tmp_path):
    address = "s3://bucket/processed/small"
    message = (
        "^s3://bucket/processed/small: another run has written here meanwhile; found B.nc, "
        "status.csv; needed one run at a time in a folder of products. Nothing of this run"
    )
    run = mirrored(address, tmp_path / "small")
    run.__enter__()
    (tmp_path / "small" / "A.nc").write_bytes(b"of this run")
    processed.objects["bucket/processed/small/B.nc"] = b"of another"
    processed.objects["bucket/processed/small/status.csv"] = b"of another one"
    with pytest.raises(ArchiveError, match=message):
        run.__exit__(None, None, None)
    assert processed.written == []


def test_one_run_at_a_time_puts_its_products(processed, here, tmp_path):
    address = "s3://bucket/processed/small"
    run = mirrored(address, tmp_path / "small")
    run.__enter__()
    (tmp_path / "small" / "A.nc").write_bytes(b"of this run")
    processed.objects["bucket/processed/small/put.lock"] = b"of another"
    message = (
        "^s3://bucket/processed/small: another run puts its products here; found put.lock; needed "
        "one run at a time in a folder of products. Nothing of this run was put there. Run again"
    )
    with pytest.raises(ArchiveError, match=message):
        run.__exit__(None, None, None)
    assert processed.written == []
    assert processed.objects["bucket/processed/small/put.lock"] == b"of another"


def test_a_folder_that_may_not_be_written_to_is_told(processed, tmp_path):
    run = mirrored("s3://bucket/processed/small", tmp_path / "small")
    run.__enter__()
    (tmp_path / "small" / "A.nc").write_bytes(b"of this run")
    processed.closed.add("bucket/processed/small/put.lock")
    message = "^s3://bucket/processed/small/put.lock: there is no permission: it cannot be written"
    with pytest.raises(ArchiveError, match=message):
        run.__exit__(None, None, None)


def test_products_in_a_store_whose_listing_marks_files_in_its_own_way(tmp_path):
    with stores.memory_store() as memory:
        memory.pipe("/p/small/A.nc", b"1")
        listed, looked_at = memory.find("/p", detail=True), memory.info("/p/small/A.nc")
        assert listed["/p/small/A.nc"]["created"] != looked_at["created"]
        with mirrored("memory://p/small", tmp_path / "small"):
            (tmp_path / "small" / "B.nc").write_bytes(b"2")
        assert {name: memory.cat(name) for name in memory.find("/p")} == {
            "/p/small/A.nc": b"1", "/p/small/B.nc": b"2",
        }  # fmt: skip


def test_a_product_that_a_run_takes_away_is_gone_and_others_are_left_alone(processed, tmp_path):
    processed.objects["bucket/processed/small/notes of a person.txt"] = b"mine"
    with mirrored("s3://bucket/processed/small", tmp_path / "small"):
        assert not (tmp_path / "small" / "notes of a person.txt").exists()
        (tmp_path / "small" / "A.nc").unlink()
        (tmp_path / "small" / ".B.nc.1.part").write_bytes(b"not finished")
    assert "bucket/processed/small/A.nc" not in processed.objects
    assert processed.objects["bucket/processed/small/notes of a person.txt"] == b"mine"
    assert processed.written == []


def test_nothing_is_written_over_http(here, command, tmp_path):
    done = command(
        "run", here / "raw" / "campaign.toml", "--processed", "https://ann:pass-word@h/p",
        "--allow-remote", cwd=tmp_path,
    )  # fmt: skip
    assert done.returncode == 2
    assert "nothing can be written to https://; found https://h/p/small; needed a" in done.stderr


def pair(command, words, here, out):
    """The answer to a line that names archives of this machine, and the same on the net."""
    local = command(*words("processed"), cwd=here)
    remote = command(*words("s3://bucket/processed"), "--allow-remote", cwd=out)
    assert local.returncode == remote.returncode == 0, remote.stderr
    return local.stdout, remote.stdout


@pytest.mark.parametrize(
    "words",
    [
        lambda root: ("lookup", f"{root}/small", "--list"),
        lambda root: ("lookup", f"{root}/small/A.nc", "--list", "--json"),
        lambda root: (
            "lookup", f"{root}/small", "--quantity", "tangent_modulus", "--line", "A new",
            "--strain", "100 %", "--branch", "ascending",
        ),
        lambda root: ("budget", f"{root}/small/A.nc"),
        lambda root: ("composite", f"{root}/small/A.nc", f"{root}/small/B.nc", "--specimen", "new"),
    ],
)  # fmt: skip
def test_a_command_that_reads_archives_answers_the_same_of_remote_ones(
    processed, here, command, tmp_path, words
):
    local, remote = pair(command, words, here, tmp_path)
    assert remote == local and len(local) > 100


@pytest.mark.parametrize("source", ["small/A.nc", "small"])
def test_an_export_of_a_remote_archive_is_that_of_a_local_one(
    processed, here, command, tmp_path, source
):
    words = ("--specimen", "new", "--to", "csv", "--out", "a.csv")
    out = tmp_path / "local"
    out.mkdir()
    local = command("export", here / "processed" / source, *words, cwd=out)
    remote = command(
        "export", f"s3://bucket/processed/{source}", *words, "--allow-remote", cwd=tmp_path
    )
    assert local.returncode == remote.returncode == 0, remote.stderr
    assert (tmp_path / "a.csv").read_bytes() == (out / "a.csv").read_bytes()


def test_the_report_of_remote_archives_is_put_there(processed, here, command, tmp_path):
    done = command(
        "report", "s3://bucket/processed/small", "--reports", "s3://bucket/pages",
        "--allow-remote", cwd=tmp_path,
    )  # fmt: skip
    assert done.stdout == "report: s3://bucket/pages/small/index.html\n", done.stderr
    page = processed.objects["bucket/pages/small/index.html"]
    assert page == (here / "reports" / "small" / "index.html").read_bytes().replace(LINK, b"")


def test_an_address_without_archives_is_told(bucket, command, tmp_path):
    done = command("lookup", "s3://bucket/none", "--list", "--allow-remote", cwd=tmp_path)
    assert done.returncode == 6
    assert "no archive in s3://bucket/none; needed the folder of one campaign" in done.stderr
    done = command("budget", "s3://bucket/none/A.nc", "--allow-remote", cwd=tmp_path)
    assert done.returncode == 6
    assert "s3://bucket/none/A.nc: there is no such file" in done.stderr


def test_a_broken_archive_is_told_by_its_address(bucket, command, tmp_path):
    bucket.objects["bucket/p/A.nc"] = b"no archive"
    done = command("budget", "s3://bucket/p/A.nc", "--allow-remote", cwd=tmp_path)
    assert done.stderr.startswith("s3://bucket/p/A.nc is not a netCDF file; found ")
    assert str(tempfile.gettempdir()) not in done.stderr


def test_open_campaign_reads_copies_until_it_is_closed(processed, here, scratch):
    address = "s3://bucket/processed/small"
    with pytest.raises(SettingsError, match=r"needed --allow-remote \(in Python allow_remote=True"):
        reduction.open_campaign(address)
    with (
        reduction.open_campaign(address, allow_remote=True) as found,
        reduction.open_campaign(here / "processed" / "small") as local,
    ):
        assert found.identical(local) and found.name == "small"
        assert len(list(scratch.iterdir())) == 1
    assert list(scratch.iterdir()) == []
    with (
        reduction.open_campaign(f"{address}/A.nc", allow_remote=True) as found,
        reduction.open_campaign(here / "processed" / "small" / "A.nc") as local,
    ):
        xr.testing.assert_identical(found, local)
        assert found.encoding["source"].endswith("/small/A.nc")
    assert list(scratch.iterdir()) == []


def test_open_campaign_leaves_no_copy_of_what_cannot_be_opened(processed, scratch):
    processed.objects["bucket/processed/small/A.nc"] = b"no archive"
    with pytest.raises(
        ArchiveError, match="^s3://bucket/processed/small/A.nc is not a netCDF file"
    ):
        reduction.open_campaign("s3://bucket/processed/small", allow_remote=True)


def test_an_archive_of_a_whole_campaign_is_copied_with_those_beside_it(processed, tmp_path):
    from reduction.remote.mirror import copied

    processed.objects["bucket/processed/small/surfaces.nc"] = b"1"
    path = copied("s3://bucket/processed/small/surfaces.nc", tmp_path, beside=True)
    assert {one.name for one in path.parent.iterdir()} == {"A.nc", "B.nc", "surfaces.nc"}
