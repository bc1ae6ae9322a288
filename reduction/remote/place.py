"""The file system behind an address, as the user's own packages give it."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from typing import Any
from urllib.parse import quote

from reduction.address import is_address, shown_address
from reduction.errors import SettingsError

__all__ = ["Place", "allowed", "base_name", "below", "connect", "folder_of"]

_PACKAGES = {
    "s3": "s3fs", "s3a": "s3fs", "gs": "gcsfs", "gcs": "gcsfs", "http": "aiohttp",
    "https": "aiohttp", "abfs": "adlfs", "abfss": "adlfs", "az": "adlfs", "sftp": "paramiko",
    "ssh": "paramiko",
}  # fmt: skip
# they read this machine: a campaign names its own files by their paths, inside its folder
_HERE = {
    "file", "local", "git", "asynclocal", "data", "dir", "dvc", "libarchive", "reference", "tar",
    "zip",
}  # fmt: skip
# they are of no use without another address behind them, which may lead here
_AROUND = {
    "async_wrapper", "asyncwrapper", "blockcache", "cached", "dask", "filecache", "generic",
    "simplecache",
}  # fmt: skip
_HTTP = {"http", "https"}
# stores of objects
_WHOLE = {"s3", "s3a", "gs", "gcs", "abfs", "abfss", "az", "adl", "oci", "oss", "tos", "hf"}


@dataclass(frozen=True)
class Place:
    """A file system of fsspec and a path in it; ``protocol`` is the scheme of its address."""

    system: Any
    path: str
    protocol: str

    @property
    def is_whole(self) -> bool:
        """Whether a file is shown when all of it is there; elsewhere it is seen to grow."""
        return self.protocol in _WHOLE


def allowed(text: str, allow_remote: bool, *, what: str) -> bool:
    """Whether a text is an address; one that may not be fetched is refused.

    Parameters
    ----------
    text : str
        As it was written.
    allow_remote : bool
        Whether the user said so.
    what : str
        What is to be found there, for the message.

    Returns
    -------
    is_remote : bool
        False of a file of this machine.

    Raises
    ------
    SettingsError
        If it is an address and addresses are not allowed, are chained, or lead to this machine.
    """
    if not is_address(text):
        return False
    shown = repr(shown_address(text))
    if not allow_remote:
        raise SettingsError(
            f"{what} is an address on the net, and none is fetched unasked", found=shown,
            needed="--allow-remote (in Python allow_remote=True), or a file on this machine",
            hint="Allow it where you know who wrote the campaign.",
        )  # fmt: skip
    scheme = text.partition("://")[0].lower()
    if "::" in text or scheme in _HERE | _AROUND or not text.isprintable():
        raise SettingsError(
            f"{what} is no address that can be used", found=shown,
            needed="one address, such as s3://bucket/raw/T-1.csv; a file on this machine by its "
            "path",
        )  # fmt: skip
    return True


def connect(address: str) -> Place:
    """Find the file system of an address.

    Parameters
    ----------
    address : str
        As `allowed` lets it pass.

    Returns
    -------
    place : Place
        Nothing is read yet.

    Raises
    ------
    SettingsError
        If fsspec, or the package of this protocol, is not installed, or nothing knows it.
    """
    protocol = address.partition("://")[0].lower()
    shown = shown_address(address)
    try:
        fsspec = import_module("fsspec")
    except ImportError:
        raise SettingsError(
            "addresses on the net need fsspec", found="no package of that name", needed="fsspec",
            hint='Install it: pip install "mooring-reduction[remote]".',
        ) from None  # fmt: skip
    try:
        system, path = fsspec.url_to_fs(f"{protocol}://{address.partition('://')[2]}")
    except ImportError as error:
        package = _PACKAGES.get(protocol)
        raise SettingsError(
            f"addresses that begin with {protocol}:// need a package that is not installed",
            found=shown, needed=package or str(error),
            hint=f"Install it: pip install {package}." if package else None,
        ) from None  # fmt: skip
    except (TypeError, ValueError) as error:
        raise SettingsError(
            f"addresses that begin with {protocol}:// are not known", found=shown,
            needed="s3://, gs://, https:// or another protocol of fsspec",
            hint=None if "not known" in str(error) else type(error).__name__,
        ) from None  # fmt: skip
    return Place(system, path, protocol)


def folder_of(address: str) -> str:
    """Address of the folder that a file lies in; a query, which is of the file, is left out."""
    return address.partition("?")[0].rpartition("/")[0]


def base_name(address: str) -> str:
    """Name of the file or folder that an address ends with; empty where that is no name."""
    name = shown_address(address).rstrip("/").rpartition("/")[2]
    return "" if name in (".", "..") else name


def below(folder: str, name: str) -> str:
    """Address of what lies in a folder on the net."""
    is_http = folder.partition("://")[0].lower() in _HTTP
    return f"{folder.rstrip('/')}/{quote(name) if is_http else name}"
