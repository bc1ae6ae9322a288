"""What went wrong with a file on the net, in words that hold neither password nor signature.

Each package that speaks to a store raises errors of its own; what they have in common is
looked at: the kinds of Python, the status of HTTP, the name of the class.
"""

from __future__ import annotations

import errno
from collections.abc import Callable, Iterator
from typing import TypeVar

from reduction.address import secrets_of, shown_address, without_secrets
from reduction.errors import ArchiveError, ReductionError

__all__ = ["Fault", "attempt", "product_fault", "said_of"]

Result = TypeVar("Result")

Fault = Callable[..., ReductionError]
"""An error of a place and a problem, with ``found``, ``needed`` and ``hint``: `LogError`,
or `product_fault`."""

_LONGEST = 200
_FULL = (errno.ENOSPC, errno.EDQUOT)
_CLOSED = ("Credential", "Forbidden", "AccessDenied", "Unauthorized", "Authentication")
_CUT_OFF = ("Connect", "Timeout", "Endpoint", "gaierror", "DNS")


def product_fault(place: str, problem: str, **parts: str) -> ArchiveError:
    """An error of a product, its place in front."""
    return ArchiveError(f"{place}: {problem}", **parts)


def attempt(
    function: Callable[[], Result],
    address: str,
    fault: Fault,
    *,
    doing: str,
    begun: Callable[[], str] = str,
) -> Result:
    """Do what a package does; an error of it becomes one of this program.

    Parameters
    ----------
    function : callable
        Of nothing.
    address, fault, doing
        As `said_of` takes them.
    begun : callable
        How much was copied when an error came.

    Returns
    -------
    result
        Of the function.

    Raises
    ------
    ReductionError
        From ``fault``. Nothing of what the package raised goes with it: that may hold a
        signature, and not every package raises what can be sent to another process.
    """
    try:
        return function()
    except Exception as error:
        told = said_of(error, address, fault, doing=doing, begun=begun())
    raise told  # out here it has no cause and no context


def said_of(
    error: Exception, address: str, fault: Fault, *, doing: str, begun: str = ""
) -> ReductionError:
    """The error of a package as one of this one.

    Parameters
    ----------
    error : Exception
        As it was raised.
    address : str
        Of the file.
    fault : callable
        Makes the error.
    doing : str
        What was done with the file: ``read``, ``copied``, ``written`` or ``removed``.
    begun : str
        How much of it was copied when the error came; empty before a copy begins.

    Returns
    -------
    error : ReductionError
        Not raised yet.
    """
    place = shown_address(address)
    chain = list(_chain(error))
    # a package may call every answer but the right one a file that is not there
    status, speaker = next(
        ((_status(one), one) for one in chain if _status(one) is not None), (None, error)
    )
    found = f"{type(speaker).__name__}: {_text_of(speaker, address)}".rstrip(": ")
    if any(isinstance(one, OSError) and one.errno in _FULL for one in chain):
        return fault(
            place, "there is no room on this machine for a copy", found=found,
            hint="Free some space, or name another folder in the variable TMPDIR.",
        )  # fmt: skip
    if any(_is_closed(one) for one in chain):
        return fault(
            place, f"there is no permission: it cannot be {doing}", found=found,
            needed="credentials as the package of this kind of address takes them",
        )  # fmt: skip
    if isinstance(error, IsADirectoryError):
        return fault(place, "it is a folder", needed="the address of a file")
    if begun and not isinstance(error, FileNotFoundError):
        return fault(
            place, "the transfer broke off", found=f"{begun}; {found}", needed="all of it",
            hint="Run again.",
        )  # fmt: skip
    if any(_is_cut_off(one) for one in chain):
        return fault(place, "its host cannot be reached", found=found)
    if status == 404 or (status is None and isinstance(error, FileNotFoundError)):
        if doing == "written":
            return fault(place, "there is no such bucket or folder", needed="one that is there")
        return fault(place, "there is no such file", needed="the address of a file")
    return fault(place, f"it cannot be {doing}", found=found)


def _chain(error: BaseException) -> Iterator[BaseException]:
    """An error and what caused it, from the one that was raised last."""
    seen: list[BaseException] = []
    following: BaseException | None = error
    while following is not None and following not in seen:
        yield following
        seen.append(following)
        following = following.__cause__ or following.__context__


def _status(error: BaseException) -> int | None:
    """Status of HTTP, under the names that packages give it."""
    for name in ("status", "status_code", "code"):
        value = getattr(error, name, None)
        if isinstance(value, int):
            return value
    return None


def _is_closed(error: BaseException) -> bool:
    name = type(error).__name__
    return (
        isinstance(error, PermissionError)
        or _status(error) in (401, 403)
        or any(word in name for word in _CLOSED)
    )


def _is_cut_off(error: BaseException) -> bool:
    name = type(error).__name__
    return isinstance(error, ConnectionError | TimeoutError) or any(
        word in name for word in _CUT_OFF
    )


def _text_of(error: BaseException, address: str) -> str:
    """First line of what a package said, without any part of the address that is secret."""
    text = without_secrets(" ".join(str(error).split()))
    for secret in secrets_of(address):
        text = text.replace(secret, "...")
    return text[:_LONGEST]
