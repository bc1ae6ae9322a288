"""Copies logs at remote addresses to this machine before they are read.

Retries after a fault are left to the package that accesses the store.  Its errors may contain a
password or a signature, so that they are reworded without it.
"""

from __future__ import annotations

import errno
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from reduction.record.errors import ArchiveError, LogError, ReductionError, SettingsError
from reduction.record.plain_text import is_address, secrets_of, shown_address, without_secrets

PACKAGES = {
    "s3": "s3fs", "gs": "gcsfs", "gcs": "gcsfs", "abfs": "adlfs", "az": "adlfs",
    "http": "aiohttp", "https": "aiohttp", "sftp": "paramiko",
}  # fmt: skip
"""Prefixes of supported addresses, and the package for each."""

Fault = Callable[..., ReductionError]
"""Constructor of an error from a place and a problem: `LogError`, or `product_fault`."""

# file-system fields that distinguish two states of a file, most reliable first
_MARKS = (
    "ETag", "etag", "generation", "md5Hash", "content_md5", "LastModified", "last_modified",
    "Last-Modified", "mtime", "modified", "updated", "created",
)  # fmt: skip

_FULL = (errno.ENOSPC, errno.EDQUOT)

# words in error names, which differ between packages
_CLOSED = ("Credential", "Forbidden", "AccessDenied", "Unauthorized", "Authentication")

_CUT_OFF = ("Connect", "Timeout", "Endpoint", "gaierror", "DNS")

_LONGEST = 200


def product_fault(place: str, problem: str, **parts: str | None) -> ArchiveError:
    """Error of a product, prefixed with its place."""
    return ArchiveError(f"{place}: {problem}", **parts)  # type: ignore[arg-type]  # no facts


def allowed(text: str, allow_remote: bool, *, what: str) -> bool:
    """Whether a text is an address; one that must not be fetched is refused."""
    if not is_address(text):
        return False
    shown = repr(shown_address(text))
    if not allow_remote:
        raise SettingsError(
            f"{what} is a URL, and URLs are refused without --allow-remote", found=shown,
            needed="--allow-remote (in Python allow_remote=True), or a file on this machine",
            hint="Use it only if you trust the author of the campaign.",
        )  # fmt: skip
    # not chained and not on this machine
    if text.partition("://")[0].lower() not in PACKAGES or "::" in text or not text.isprintable():
        raise SettingsError(
            f"{what} is not an address that can be used", found=shown,
            needed=f"one address that begins with {', '.join(f'{one}://' for one in PACKAGES)}; "
            "a file on this machine by its path",
        )  # fmt: skip
    return True


def base_name(address: str) -> str:
    """Name of the file at the end of an address; empty if that is not a name."""
    name = shown_address(address).rstrip("/").rpartition("/")[2]
    return "" if name in (".", "..") else name


def fetch(address: str, target: Path, *, fault: Fault = LogError) -> None:
    """Copy a file from a remote address."""
    system, path = _file_system(address)
    shown = shown_address(address)
    told: ReductionError | None = None
    try:
        before = _state(system, path)
        target.parent.mkdir(parents=True, exist_ok=True)
        system.get_file(path, str(target))
        size, after = target.stat().st_size, _state(system, path)
        if after != before:
            told = fault(
                shown, "the file changed while it was read",
                found=f"{_in_words(before)}, then {_in_words(after)}",
                needed="a file that nothing writes to",
                hint="Wait until the logger or the copy has ended.",
            )  # fmt: skip
        elif before[0] not in (None, size):
            told = fault(
                shown, "the transfer was interrupted", found=f"{size} bytes",
                needed=f"{before[0]} bytes", hint="Run again.",
            )  # fmt: skip
    except Exception as error:  # of any package that reads addresses
        told = _fault_of(error, address, fault)
    if told is not None:
        with suppress(OSError):  # a name that no disk accepts
            target.unlink()
        raise told  # raised here, without cause and context


def _file_system(address: str) -> tuple[Any, str]:
    """File system and path of an address."""
    protocol, _, rest = address.partition("://")
    protocol = protocol.lower()
    try:
        system, path = import_module("fsspec").url_to_fs(f"{protocol}://{rest}")
    except ImportError as error:
        package = "fsspec" if error.name == "fsspec" else PACKAGES[protocol]
        raise SettingsError(
            f"addresses that begin with {protocol}:// need a package that is not installed",
            found=shown_address(address), needed=package,
            hint=f'Install it: pip install "mooring-reduction[remote]" {PACKAGES[protocol]}.',
        ) from None  # fmt: skip
    except (TypeError, ValueError) as error:
        # user settings of the package: its message may contain a key
        raise SettingsError(
            f"addresses that begin with {protocol}:// cannot be used",
            found=f"{shown_address(address)}, {type(error).__name__}",
            needed="the settings that fsspec has for them",
        ) from None
    return system, path


def _state(system: Any, path: str) -> tuple[int | None, str]:
    """Size, if stated, and a mark that changes with the file."""
    system.invalidate_cache()
    about = system.info(path)
    if about.get("type") == "directory":
        raise IsADirectoryError
    mark = next((about[name] for name in _MARKS if about.get(name) is not None), "")
    size = about.get("size")
    return None if size is None else int(size), str(mark)


def _in_words(state: tuple[int | None, str]) -> str:
    size, mark = state
    words = "an unknown size" if size is None else f"{size} bytes"
    return f"{words} ({mark})" if mark else words


def _fault_of(error: Exception, address: str, fault: Fault) -> ReductionError:
    """A package's error converted to one of this program, not yet raised."""
    chain = list(_chain(error))
    # a package may report any failed request as a file that does not exist
    statuses = {_status(one): one for one in chain if _status(one) is not None}
    status, speaker = next(iter(statuses.items()), (None, error))
    said = without_secrets(" ".join(str(speaker).split()))
    for secret in secrets_of(address):
        said = said.replace(secret, "...")
    found: str | None = f"{type(speaker).__name__}: {said[:_LONGEST]}".rstrip(": ")
    names = [type(one).__name__ for one in chain]
    needed: str | None = None
    hint: str | None = None
    if any(isinstance(one, OSError) and one.errno in _FULL for one in chain):
        problem = "there is no room on this machine for a copy"
        hint = "Free some space, or name another folder in the variable TMPDIR."
    elif status in (401, 403) or _is_any(chain, PermissionError) or _has_word(names, _CLOSED):
        problem = "there is no permission: it cannot be read"
        needed = "credentials for the package that reads this kind of address"
    elif isinstance(error, IsADirectoryError):
        problem, found, needed = "it is a folder", None, "the address of a file"
    elif _is_any(chain, ConnectionError, TimeoutError) or _has_word(names, _CUT_OFF):
        problem = "its host cannot be reached, or the transfer was interrupted"
    elif status == 404 or (status is None and isinstance(error, FileNotFoundError)):
        problem, found, needed = "there is no such file", None, "the address of a file"
    else:
        problem = "it cannot be read"
    return fault(shown_address(address), problem, found=found, needed=needed, hint=hint)


def _chain(error: BaseException) -> Iterator[BaseException]:
    """An error and its causes, last raised first."""
    seen: list[BaseException] = []
    following: BaseException | None = error
    while following is not None and following not in seen:
        yield following
        seen.append(following)
        following = following.__cause__ or following.__context__


def _status(error: BaseException) -> int | None:
    """HTTP status, under any of the packages' names for it."""
    for name in ("status", "status_code", "code"):
        value = getattr(error, name, None)
        if isinstance(value, int):
            return value
    return None


def _is_any(chain: list[BaseException], *kinds: type[BaseException]) -> bool:
    return any(isinstance(one, kinds) for one in chain)


def _has_word(names: list[str], words: tuple[str, ...]) -> bool:
    return any(word in name for name in names for word in words)


@contextmanager
def scratch_folder() -> Iterator[Path]:
    """Make a temporary folder for copies, under ``TMPDIR``; it is removed at the end."""
    with TemporaryDirectory(prefix="reduction-", ignore_cleanup_errors=True) as name:
        yield Path(name).resolve()


def in_words(text: str, names: Mapping[str, str]) -> str:
    """A text with the paths of copies replaced by their addresses.

    Examples
    --------
    >>> in_words("copies/0/T-1.csv:5 [time]: a gap", {"copies/0/T-1.csv": "s3://bucket/T-1.csv"})
    's3://bucket/T-1.csv:5 [time]: a gap'
    """
    for path in sorted(names, key=len, reverse=True):
        text = text.replace(path, names[path])
    return text


@contextmanager
def renamed(names: Mapping[str, str]) -> Iterator[None]:
    """Make errors from the ``with`` block name addresses instead of the paths of their copies."""
    try:
        yield
    except ReductionError as error:
        for part in ("problem", "found", "needed", "hint", "path"):
            value = getattr(error, part, None)
            if value is not None:
                setattr(error, part, in_words(str(value), names))
        raise
