"""Addresses on the net as texts: what is one, and what of it may be shown.

An address may hold a password before its host, or a signature behind its path.  Neither is
ever said, written or kept.
"""

from __future__ import annotations

import re

_SCHEME = r"[A-Za-z][A-Za-z0-9+.\-]*://"
_IN_TEXT = re.compile(rf"{_SCHEME}[^\s'\"<>]*")
_STOPS = ".,:;)"
_PORT = re.compile(r":\d*")
_SHORTEST = 4  # characters of a secret: a shorter one stands in every other word


def is_address(text: str) -> bool:
    """Whether a text names something on the net, rather than a file of this machine.

    Parameters
    ----------
    text : str
        As a person wrote it.

    Returns
    -------
    is_address : bool
        True of ``scheme://..``, also where one scheme is chained to another.

    Examples
    --------
    >>> [is_address(text) for text in ("s3://bucket/T-1.csv", "raw/T-1.csv", "C:/raw/T-1.csv")]
    [True, False, False]
    """
    return "://" in text


def shown_address(address: str) -> str:
    """An address without user, password, query and fragment.

    Parameters
    ----------
    address : str
        One address.

    Returns
    -------
    shown : str
        What may stand in a product and in a message.

    Examples
    --------
    >>> shown_address("https://ann:secret@host:8080/raw/T-1.csv?signature=abc#row")
    'https://host:8080/raw/T-1.csv'
    """
    scheme, _, rest = re.split(r"[?#]", address, maxsplit=1)[0].partition("://")
    host, slash, path = rest.partition("/")
    if "@" in host:
        host = host.rpartition("@")[2]
    elif _has_password(host):
        # a key with a slash in it, unquoted: what comes before the last @ is no path
        _, at, behind = path.rpartition("@")
        host, slash, path = behind.partition("/") if at else ("...", slash, path)
    return f"{scheme}://{host}{slash}{path}"


def _has_password(host: str) -> bool:
    """A colon, and neither a port nor the digits of IPv6 behind it."""
    name, colon, _ = host.partition(":")
    return bool(colon) and not host.startswith("[") and not _PORT.fullmatch(host[len(name) :])


def without_secrets(text: str) -> str:
    """A text in which every address is as `shown_address` gives it.

    Parameters
    ----------
    text : str
        A message.

    Returns
    -------
    text : str
        The same where it holds no address.

    Examples
    --------
    >>> without_secrets("found 'https://ann:secret@host/T.csv?sig=abc', needed a file")
    "found 'https://host/T.csv', needed a file"
    """
    if "://" not in text:
        return text
    return _IN_TEXT.sub(_shown, text)


def _shown(found: re.Match[str]) -> str:
    """What may be shown of an address; a stop behind it is of the sentence."""
    address = found[0].rstrip(_STOPS)
    return shown_address(address) + found[0][len(address) :]


def secrets_of(address: str) -> tuple[str, ...]:
    """What of an address is not to be shown, piece by piece.

    Parameters
    ----------
    address : str
        One address.

    Returns
    -------
    secrets : tuple of str
        User and password, and the values of the query; the longest first.

    Examples
    --------
    >>> secrets_of("https://ann:secret@host/T.csv?signature=abcdef")
    ('signature=abcdef', 'secret', 'abcdef')
    """
    path, _, behind = address.partition("?")
    before = path.partition("://")[2].rpartition("@")[0]
    pieces = [*before.split(":", 1), behind]
    pieces += [part.partition("=")[2] for part in re.split(r"[&#;]", behind)]
    found = dict.fromkeys(piece for piece in pieces if len(piece) >= _SHORTEST)
    return tuple(sorted(found, key=len, reverse=True))
