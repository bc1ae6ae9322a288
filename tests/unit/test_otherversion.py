"""Another revision of the software: found, unpacked, and what is said where it cannot be."""

import subprocess
import sys
from pathlib import Path

import pytest

from reduction.cli import diff as otherversion
from reduction.cli.output import CommandOutput
from reduction.record.errors import SettingsError

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
