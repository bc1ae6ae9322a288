"""Who may ask: one who knows the token, from a page of this server, by its own name."""

from __future__ import annotations

import hmac
from collections.abc import Mapping
from dataclasses import dataclass
from http import HTTPStatus
from urllib.parse import parse_qs

__all__ = ["HEADERS", "Guard"]

HEADERS = {
    "Cache-Control": "no-store",
    "Content-Security-Policy": (
        "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; "
        "img-src data: blob:; connect-src 'self'; base-uri 'none'; form-action 'none'; "
        "frame-ancestors 'none'"
    ),
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Permissions-Policy": "camera=(), geolocation=(), microphone=()",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
}
"""Of every answer: nothing is kept, framed, guessed or told to others.

plotly puts its style sheet into the page, so that styles have to be allowed in it; scripts are not.
"""

_NAMES = ("127.0.0.1", "localhost")
_SCHEME = "bearer "


@dataclass(frozen=True)
class Guard:
    """What a request has to bring; ``port`` is that of the server."""

    token: str
    port: int

    def refusal(
        self, headers: Mapping[str, str], hosts: list[str]
    ) -> tuple[HTTPStatus, str] | None:
        """Why nothing at all is answered: another name of the host, or a page of another server.

        Parameters
        ----------
        headers : mapping of str to str
            Of the request, by names in small letters.
        hosts : list of str
            Every ``Host`` of it.
        """
        known = {f"{name}:{self.port}" for name in _NAMES}
        if len(hosts) != 1 or hosts[0].lower() not in known:
            # a name of somebody else's that was made to lead here
            return HTTPStatus.FORBIDDEN, "this server answers to its own address alone"
        origin = headers.get("origin")
        if origin is not None and origin.lower() not in {f"http://{one}" for one in known}:
            return HTTPStatus.FORBIDDEN, "a page of another server asked"
        if headers.get("sec-fetch-site", "none") not in ("none", "same-origin"):
            return HTTPStatus.FORBIDDEN, "a page of another server asked"
        return None

    def knows_token(self, headers: Mapping[str, str]) -> bool:
        """Whether the token stands in the header ``Authorization: Bearer``."""
        given = headers.get("authorization", "")
        is_bearer = given[: len(_SCHEME)].lower() == _SCHEME
        return is_bearer and self._is_token(given[len(_SCHEME) :].strip())

    def knows_address(self, query: str) -> bool:
        """Whether the token stands in the query of an address, once."""
        try:
            given = parse_qs(query, max_num_fields=4).get("token", [])
        except ValueError:  # more fields than that
            return False
        return len(given) == 1 and self._is_token(given[0])

    def _is_token(self, given: str) -> bool:
        # in a time that does not tell how much of it was right
        return hmac.compare_digest(given.encode("utf-8", "replace"), self.token.encode())
