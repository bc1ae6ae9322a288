"""What a run does when files change, vanish or are refused under it."""

import errno
import json
import os
import shutil
import subprocess
import sys

import pytest
from commandruns import ROOT
from shortcampaign import write_short

from reduction.archive import product_files as products_module
from reduction.archive.open import reading
from reduction.batch import reduce_tests as reduce_module
from reduction.batch.run_lock import _run_named
from reduction.batch.survey import as_reduction_error, survey_log
from reduction.campaign.load import load_campaign
from reduction.pages import design_values as campaigns_module
from reduction.record.errors import ArchiveError
from reduction.report.campaign_page import CampaignPage

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def made(tmp_path_factory, command):
    """A campaign and its products, of another diameter than it says now."""
    folder = tmp_path_factory.mktemp("short")
    write_short(folder / "raw", diameter="1.05 in")
    assert command("run", "raw/campaign.toml", "--quiet", cwd=folder).returncode == 0
    shutil.rmtree(folder / "raw")
    write_short(folder / "raw")
    return folder


@pytest.fixture
def older(made, tmp_path):
    shutil.copytree(made, tmp_path / "run")
    return tmp_path / "run"


def run(command, folder, *words):
    return command("run", "raw/campaign.toml", "--quiet", *words, cwd=folder)


def test_a_log_that_vanishes_while_the_campaign_runs_fails_its_test_and_keeps_the_older_product(
    older, command, monkeypatch
):
    changed_at_the_end(monkeypatch, lambda path: path.unlink())
    before = (older / "processed/short/A.nc").read_bytes()
    done = run(command, older, "--test", "A")
    assert done.returncode == 3
    assert "raw/A.csv: the file cannot be read; found No such file or directory" in done.stderr
    assert (older / "processed/short/A.nc").read_bytes() == before
    assert _run_named(older / "processed/short") == ""


def test_a_log_that_changes_while_the_campaign_runs_is_found_out_though_size_and_time_are_kept(
    older, command, monkeypatch
):
    def change(path):
        state, data = path.stat(), bytearray(path.read_bytes())
        data[-10] = ord("1") if data[-10] != ord("1") else ord("2")
        path.write_bytes(data)
        os.utime(path, ns=(state.st_atime_ns, state.st_mtime_ns))

    changed_at_the_end(monkeypatch, change)
    before = (older / "processed/short/A.nc").read_bytes()
    done = run(command, older, "--test", "A")
    assert done.returncode == 3
    assert "raw/A.csv: the file changed while the campaign ran; found sha256" in done.stderr
    assert "as it was read. The earlier archive is kept." in done.stderr
    assert (older / "processed/short/A.nc").read_bytes() == before


def changed_at_the_end(monkeypatch, change):
    """A log changes when its test is reduced, and not yet written."""
    whole = reduce_module.dataset_of

    def made(campaign, survey, *rest, **options):
        found = whole(campaign, survey, *rest, **options)
        change(campaign.file(survey.plan.files[0][0]))
        return found

    monkeypatch.setattr(reduce_module, "dataset_of", made)


def without_a(step):
    """A step of a run that cannot read the archive of test A."""

    def refused(path):
        if path.name == "A.nc":
            raise ArchiveError(f"{path} is damaged")
        return reading(path)

    return lambda *given, **options: step(*given, **options | {"opener": refused})


def spoil(path):
    with path.open("rb+") as file:
        file.truncate(5000)


def test_an_archive_that_the_report_cannot_read_leaves_the_page_as_it_was(
    older, command, monkeypatch
):
    whole = CampaignPage.add

    def add(page, path, archive):
        if path.name == "A.nc":
            page._not_shown[path.name] = "A.nc is damaged"
        else:
            whole(page, path, archive)

    monkeypatch.setattr(CampaignPage, "add", add)
    page = older / "reports" / "short" / "index.html"
    before = page.read_bytes()
    done = run(command, older)
    assert done.returncode == 6
    said = (
        "processed/short/A.nc cannot be read, and the report is left as it was; found A.nc is dam"
    )
    assert said in done.stderr
    assert page.read_bytes() == before
    spoil(older / "processed" / "short" / "A.nc")
    done = command("report", "processed/short", "--quiet", cwd=older)
    assert done.returncode == 6, "asked for by itself, the page names what it lacks"
    assert "processed/short/A.nc is not in the report: A.nc cannot be read" in done.stderr
    assert page.read_bytes() != before


def test_an_archive_that_was_just_made_and_cannot_be_read_leaves_the_design_values_as_they_were(
    older, command, monkeypatch
):
    monkeypatch.setattr(
        campaigns_module, "write_design_page", without_a(campaigns_module.write_design_page)
    )
    page = older / "reports" / "design-values.html"
    before = page.read_bytes()
    done = run(command, older)
    assert done.returncode == 6
    assert (
        "processed/short/A.nc cannot be read, so the design-value page was not updated"
        in done.stderr
    )
    assert page.read_bytes() == before


def test_a_damaged_archive_is_no_part_of_the_design_values_and_it_is_said(older, command):
    assert run(command, older).returncode == 0
    other = older / "processed" / "other"
    shutil.copytree(older / "processed" / "short", other)
    for folder in (other, older / "processed" / "short"):
        spoil(folder / "B.nc")
    done = command("report", "processed/short", "--quiet", cwd=older)
    assert done.returncode == 6
    said = [line for line in done.stderr.splitlines() if "is not on the page of design" in line]
    assert len(said) == 2 and any("other/B.nc" in line for line in said)
    shutil.rmtree(older / "processed" / "short")
    shutil.copytree(other, older / "processed" / "short")
    assert run(command, older).returncode == 0, "one of another campaign is said, and no failure"


def test_what_the_system_refuses_in_a_command_has_a_status_and_names_the_file(
    older, command, monkeypatch
):
    def refused(folder):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(folder))

    monkeypatch.setattr(products_module.os, "listdir", refused)
    done = command("report", "processed/short", "--json", cwd=older)
    assert done.returncode == 6
    assert "processed/short cannot be used; found Permission denied" in done.stderr
    assert json.loads(done.stdout)["exit_status"] == 6


def test_a_log_that_the_system_refuses_is_no_defect_of_the_program(older, monkeypatch):
    campaign = load_campaign(older / "raw" / "campaign.toml")

    def refused(*arguments, **options):
        raise OSError(errno.EIO, os.strerror(errno.EIO))

    monkeypatch.setattr("reduction.batch.survey.read_record", refused)
    (found,) = survey_log(campaign, "A")
    assert str(found.error) == (
        "A.csv: the file cannot be read; found Input/output error; "
        "needed a file that this user may read"
    )
    assert as_reduction_error(PermissionError(1, "no", "x.nc")).exit_status == 6
    assert "a defect" in str(as_reduction_error(OSError("of a library, without a number")))


def test_a_folder_that_is_not_there_has_no_archives_and_one_that_is_refused_is_told(tmp_path):
    assert products_module.archives_of_tests(tmp_path / "none") == []
    (tmp_path / "file").touch()
    assert products_module.archives_of_tests(tmp_path / "file") == []


WATCH = """
import os, sys
raw = os.path.realpath(sys.argv[1]) + os.sep
changes = {
    "os.rename", "os.remove", "os.mkdir", "os.rmdir", "os.link", "os.symlink", "os.chmod",
    "os.chown", "os.utime", "os.truncate", "shutil.move", "shutil.rmtree",
}
def hook(event, arguments):
    if event == "open":
        flags = arguments[2] if isinstance(arguments[2], int) else 0
        if not flags & (os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC):
            return
    elif event not in changes:
        return
    for one in arguments[:2]:
        if isinstance(one, (str, bytes, os.PathLike)):
            if (os.path.realpath(os.fsdecode(one)) + os.sep).startswith(raw):
                print("WRITES", event, arguments, file=sys.stderr)
sys.addaudithook(hook)
if sys.argv[2] == "itself":
    open(raw + "new", "w").close()
    sys.exit()
from reduction.cli.main import app
sys.argv[1:] = sys.argv[2:]
app()
"""


def test_a_run_opens_raw_files_to_read_them_and_touches_nothing_beside(tmp_path):
    write_short(tmp_path / "raw")
    before = {path.name: path.read_bytes() for path in (tmp_path / "raw").iterdir()}
    done = watched(tmp_path, "run", "raw/campaign.toml", "--quiet")
    assert done.returncode == 0 and "WRITES" not in done.stderr, done.stderr
    assert {path.name: path.read_bytes() for path in (tmp_path / "raw").iterdir()} == before
    assert "WRITES open" in watched(tmp_path, "itself").stderr


def watched(folder, *words):
    return subprocess.run(
        [sys.executable, "-c", WATCH, str(folder / "raw"), *words],
        cwd=folder, capture_output=True, text=True, check=False,
        env=os.environ | {"PYTHONPATH": str(ROOT)},
    )  # fmt: skip


def test_a_folder_of_campaigns_that_is_refused_does_not_count_as_empty(older, monkeypatch):
    def refused(folder):
        raise PermissionError(errno.EPERM, os.strerror(errno.EPERM), str(folder))

    assert campaigns_module._read_campaigns(older / "none", room=1) == []
    monkeypatch.setattr(campaigns_module.Path, "iterdir", refused)
    with pytest.raises(PermissionError, match="processed"):
        campaigns_module._read_campaigns(older / "processed", room=1)
