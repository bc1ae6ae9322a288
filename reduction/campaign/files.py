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
    folder = path.parent.resolve()
    target = (folder / name).resolve()
    if not name or Path(name).is_absolute() or not target.is_relative_to(folder):
        raise in_toml(
            path, "a file lies outside the campaign folder", found=repr(name),
            needed="a path inside the folder of campaign.toml, links followed",
        )  # fmt: skip
    if is_needed and not target.is_file():
        raise LogError(path.parent / name, "the file is not there", needed=f"as {path} says")
    return name
