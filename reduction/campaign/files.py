"""Files that a campaign names: inside its folder, regular, and there."""

from __future__ import annotations

import re
from pathlib import Path, PureWindowsPath

from reduction.address import is_address, shown_address
from reduction.campaign.faults import in_toml
from reduction.errors import LogError, SettingsError
from reduction.ingest.limits import check_regular
from reduction.visible import cut

DEVICE = re.compile(
    r"(con|prn|aux|nul|conin\$|conout\$|com[0-9¹²³]|lpt[0-9¹²³]) *(\..*)?", re.IGNORECASE
)
"""Names that are devices of Windows in every folder, whatever stands behind their point."""


def file_inside(path: Path, name: str, *, is_needed: bool = True) -> str:
    """A file name that stays inside the campaign folder.

    Parameters
    ----------
    path : pathlib.Path
        campaign.toml.
    name : str
        As written there or in one of its tables; the same names are refused on every system.
    is_needed : bool
        Whether it has to be there.

    Returns
    -------
    name : str
        As written.

    Raises
    ------
    SettingsError
        If it is an address, or leads out of the folder, by itself or through links.
    LogError
        If it is needed and is not there, or is no regular file.
    """
    shown = repr(cut(name, 200))
    if is_address(name):
        raise in_toml(
            path, "only the log of a test may be an address on the net",
            found=repr(shown_address(name)), needed="a file inside the folder of campaign.toml",
        )  # fmt: skip
    if any(map(DEVICE.fullmatch, re.split(r"[/\\]", name))):
        raise _no_name(path, shown)
    try:
        folder = path.parent.resolve()
        target = (folder / name).resolve()
    except (ValueError, RuntimeError, OSError) as error:  # a null byte, links in a ring, length
        raise _no_name(path, shown) from error
    windows = PureWindowsPath(name)
    is_absolute = Path(name).is_absolute() or windows.drive or windows.root
    if not name or is_absolute or not target.is_relative_to(folder):
        raise in_toml(
            path, "a file lies outside the campaign folder", found=shown,
            needed="a path inside the folder of campaign.toml, links followed",
        )  # fmt: skip
    if is_needed:
        _check_there(path, target, path.parent / name)
    return name


def _no_name(path: Path, shown: str) -> SettingsError:
    return in_toml(
        path, "no file can have such a name", found=shown,
        needed="a path inside the folder of campaign.toml, links followed",
    )  # fmt: skip


def _check_there(path: Path, target: Path, shown: Path) -> None:
    try:
        mode = target.stat().st_mode
    except FileNotFoundError as error:
        raise LogError(shown, "the file is not there", needed=f"as {path} says") from error
    except OSError as error:  # a folder that is closed to this user, a name that is too long
        raise LogError(
            shown, "the file cannot be read", found=error.strerror or str(error),
            needed="a file that this user may read",
        ) from error  # fmt: skip
    check_regular(shown, mode)
