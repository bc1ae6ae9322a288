"""A campaign run by another revision of this software, in an environment of its own."""

from __future__ import annotations

import os
import subprocess
import sys
import tarfile
from collections.abc import Sequence
from importlib.metadata import distributions
from io import BytesIO
from pathlib import Path

import reduction
from reduction.cli.commandoutput import CommandOutput
from reduction.cli.progress import campaign_progress
from reduction.cli.remote import in_order
from reduction.errors import SettingsError


def run_revision(revision: str, campaign: Path, scratch: Path, output: CommandOutput) -> Path:
    """Reduce a campaign with a revision of the checkout that this package is installed from.

    Parameters
    ----------
    revision : str
        A commit, tag or branch, as git takes it.
    campaign : pathlib.Path
        The campaign.toml.
    scratch : pathlib.Path
        Folder for the source, the environment and the products.
    output : CommandOutput
        Shows what takes long.

    Returns
    -------
    products : pathlib.Path
        Folder of the campaign.

    Raises
    ------
    SettingsError
        If the package is in no checkout, the revision is unknown, it cannot be installed, or
        makes nothing of this campaign.
    """
    checkout = find_checkout(Path(reduction.__file__).parents[1])
    source = export_revision(checkout, revision, scratch)
    processed = scratch / "processed"
    with in_order(), campaign_progress(output) as bar:
        bar.stage(f"building {revision}", 0)
        python = install(source, scratch, revision)
        bar.stage(f"reducing with {revision}", 0)
        # isolated, so that neither this folder nor PYTHONPATH puts another version in its place
        done = _run(
            [str(python), "-I", "-m", "reduction", "run", str(campaign), "--processed",
             str(processed), "--reports", str(scratch / "reports"), "--quiet"]
        )  # fmt: skip
    made = sorted(processed.iterdir()) if processed.is_dir() else []
    if not made:
        raise SettingsError(
            f"revision {revision} makes nothing of {campaign}",
            found=_last_line(done.stderr) or f"exit status {done.returncode}",
            hint="A key of campaign.toml may be newer than that revision.",
        )
    return made[0]


def find_checkout(folder: Path) -> Path:
    """Folder of the git checkout that a package was installed from in place."""
    done = _git(folder, "ls-files", "--error-unmatch", "reduction/__init__.py")
    if done.returncode:
        raise SettingsError(
            "--against needs the git checkout of this software",
            found=f"{folder}: {_last_line(done.stderr)}",
            needed="a clone, installed in place: pip install -e .",
        )
    return folder


def export_revision(checkout: Path, revision: str, scratch: Path) -> Path:
    """Unpack the source of a revision; the checkout is left as it is."""
    known = _git(checkout, "rev-parse", "--verify", "--end-of-options", f"{revision}^{{commit}}")
    if known.returncode:
        raise SettingsError(
            "--against: no such revision",
            found=repr(revision),
            needed=f"a commit, tag or branch of {checkout}",
        )
    packed = _git(checkout, "archive", "--format=tar", known.stdout.decode().strip())
    if packed.returncode:
        raise SettingsError(
            f"revision {revision} cannot be unpacked", found=_last_line(packed.stderr)
        )
    source = scratch / "source"
    with tarfile.open(fileobj=BytesIO(packed.stdout)) as files:
        files.extractall(source, filter="data")
    return source


def install(source: Path, scratch: Path, revision: str) -> Path:
    """Install a source with the versions of other packages that are installed here."""
    environment = scratch / "environment"
    versions = scratch / "versions.txt"
    installed = {one.name: one.version for one in distributions() if one.name}
    installed.pop("mooring-reduction", None)
    # a difference is then one of this software
    versions.write_text("".join(f"{name}=={number}\n" for name, number in installed.items()))
    python = environment / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    for command in (
        [sys.executable, "-m", "venv", str(environment)],
        [str(python), "-I", "-m", "pip", "install", "--quiet", "--disable-pip-version-check",
         "--constraint", str(versions), str(source)],
    ):  # fmt: skip
        done = _run(command)
        if done.returncode:
            raise SettingsError(
                f"revision {revision} cannot be installed",
                found=_last_line(done.stderr) or _last_line(done.stdout),
                hint="pip needs the net, or what it has kept of it.",
            )
    return python


def _git(folder: Path, *words: str) -> subprocess.CompletedProcess[bytes]:
    return _run(["git", "-C", str(folder), *words])


def _run(command: Sequence[str]) -> subprocess.CompletedProcess[bytes]:
    try:
        return subprocess.run(command, capture_output=True, check=False)  # noqa: S603  # no shell
    except OSError as error:
        raise SettingsError(
            f"{command[0]} cannot be started", found=error.strerror or str(error)
        ) from error


def _last_line(said: bytes) -> str:
    lines = said.decode(errors="replace").strip().splitlines()
    return lines[-1].rstrip(".") if lines else ""
