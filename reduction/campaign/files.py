"""Files that a campaign names: inside its folder, and there."""

from __future__ import annotations

from pathlib import Path

from reduction.address import is_address, shown_address
from reduction.campaign.faults import in_toml
from reduction.errors import LogError

__all__ = ["file_inside"]


def file_inside(path: Path, name: str, *, is_needed: bool = True) -> str:
    """Return a file name that stays inside the campaign folder, or `SettingsError`."""
    if is_address(name):
        raise in_toml(
            path, "only the log of a test may be an address on the net",
            found=repr(shown_address(name)), needed="a file inside the folder of campaign.toml",
        )  # fmt: skip
    try:
        folder = path.parent.resolve()
        target = (folder / name).resolve()
    except (ValueError, RuntimeError) as error:  # a null byte; links that lead to each other
        raise in_toml(
            path, "no file can have such a name", found=repr(name),
            needed="a path inside the folder of campaign.toml, links followed",
        ) from error  # fmt: skip
    if not name or Path(name).is_absolute() or not target.is_relative_to(folder):
        raise in_toml(
            path, "a file lies outside the campaign folder", found=repr(name),
            needed="a path inside the folder of campaign.toml, links followed",
        )  # fmt: skip
    if is_needed and not _is_file(target, path.parent / name):
        raise LogError(path.parent / name, "the file is not there", needed=f"as {path} says")
    return name


def _is_file(target: Path, shown: Path) -> bool:
    try:
        return target.is_file()
    except OSError as error:  # a folder that is closed to this user, a name that is too long
        raise LogError(
            shown, "the file cannot be read", found=error.strerror or str(error),
            needed="a file that this user may read",
        ) from error  # fmt: skip
