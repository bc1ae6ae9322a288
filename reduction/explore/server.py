"""A server on this machine alone, with limits on what it reads and how long it waits."""

from __future__ import annotations

import json
import secrets
import socket
import threading
from collections.abc import Callable
from contextlib import suppress
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any
from urllib.parse import urlsplit

from reduction.errors import SettingsError
from reduction.explore.guard import HEADERS, Guard
from reduction.explore.routes import Answer, Routes

__all__ = ["ExploreServer"]

HOST = "127.0.0.1"
MOST_BYTES = 64_000
"""Longest body of a request. [1]"""
PATIENCE = 10.0
"""How long a part of a request may take to arrive. [s]"""
DEADLINE = 60.0
"""How long a connection may live; each is of one request. [s]"""
MOST_AT_ONCE = 24
_PAGE = "text/html; charset=utf-8"


class ExploreServer(ThreadingHTTPServer):
    """A server of one session, on 127.0.0.1.

    Parameters
    ----------
    routes : Routes
        What it answers.
    port : int
        0 for a free one.
    told_of_defect : callable, optional
        Told of what is a defect of this program, of which a page learns no more than that.

    Raises
    ------
    SettingsError
        If the port cannot be had.
    """

    daemon_threads = True
    block_on_close = False
    allow_reuse_address = False

    def __init__(
        self,
        routes: Routes,
        port: int = 0,
        told_of_defect: Callable[[Exception], None] | None = None,
    ) -> None:
        try:
            super().__init__((HOST, port), _Handler)
        except (OSError, OverflowError) as error:
            raise SettingsError(
                "the port cannot be had",
                found=f"{port}: {getattr(error, 'strerror', None) or error}",
                needed="a free one from 1024 to 65535, or none: one is found then",
            ) from error
        self.routes = routes
        self.told_of_defect = told_of_defect
        self.guard = Guard(secrets.token_urlsafe(32), self.server_port)
        self._places = threading.BoundedSemaphore(MOST_AT_ONCE)

    @property
    def address(self) -> str:
        """The address of the page, with its token."""
        return f"http://{HOST}:{self.server_port}/?token={self.guard.token}"

    def server_bind(self) -> None:
        """Bind, without asking a name server for the name of this machine."""
        self.socket.bind(self.server_address)
        self.server_address = self.socket.getsockname()
        self.server_name, self.server_port = HOST, self.server_address[1]

    def process_request(self, request: Any, client_address: Any) -> None:
        """Give a request a thread, as long as there are not too many."""
        if not self._places.acquire(blocking=False):
            self.shutdown_request(request)
            return
        super().process_request(request, client_address)

    def process_request_thread(self, request: Any, client_address: Any) -> None:
        """Answer, and make room for the next; one that dawdles is cut off."""
        deadline = threading.Timer(DEADLINE, _cut_off, (request,))
        deadline.daemon = True
        deadline.start()
        try:
            super().process_request_thread(request, client_address)
        finally:
            deadline.cancel()
            self._places.release()

    def handle_error(self, request: Any, client_address: Any) -> None:
        """A connection that broke is nobody's business; requests answer their own faults."""


def _cut_off(request: socket.socket) -> None:
    with suppress(OSError):  # it ended by itself
        request.shutdown(socket.SHUT_RDWR)


class _Handler(BaseHTTPRequestHandler):
    """One connection, of one request."""

    server: ExploreServer
    protocol_version = "HTTP/1.1"
    timeout = PATIENCE

    def do_GET(self) -> None:
        """The page for one who knows the token; style and scripts hold nothing of a campaign."""
        self._answered(self._get)

    def do_POST(self) -> None:
        """A document for a document."""
        self._answered(self._post)

    def _answered(self, answer: Callable[[], None]) -> None:
        try:
            answer()
        except OSError:  # who asked is gone, or dawdles
            raise
        except Exception as error:
            # a stranger learns no more of a defect here than that it is one; the terminal does
            if self.server.told_of_defect is not None:
                self.server.told_of_defect(error)
            self._refuse(HTTPStatus.INTERNAL_SERVER_ERROR, "internal error, a defect here")

    def _get(self) -> None:
        asked = self._asked()
        if asked is None:
            return
        routes, (path, query) = self.server.routes, asked
        if path == "/":
            if self.server.guard.knows_address(query):
                self._send(Answer(HTTPStatus.OK, _PAGE, routes.page))
            else:
                self._refuse(
                    HTTPStatus.FORBIDDEN,
                    "the token is missing or wrong; open the address that the command printed",
                )
        elif path in routes.static:
            kind, body = routes.static[path]
            self._send(Answer(HTTPStatus.OK, kind, body))
        elif path in routes.posted:
            self._refuse(HTTPStatus.METHOD_NOT_ALLOWED, "only POST is answered here")
        else:
            self._refuse(HTTPStatus.NOT_FOUND, "there is nothing here")

    def _post(self) -> None:
        asked = self._asked()
        if asked is None:
            return
        path, _ = asked
        routes = self.server.routes
        if not self.server.guard.knows_token(self._headers()):
            self._refuse(HTTPStatus.FORBIDDEN, "the token is missing or wrong")
        elif path not in routes.posted:
            is_known = path == "/" or path in routes.static
            status = HTTPStatus.METHOD_NOT_ALLOWED if is_known else HTTPStatus.NOT_FOUND
            self._refuse(status, "nothing is posted here")
        elif (body := self._body()) is not None:
            self._send(routes.post(path, body))

    def _headers(self) -> dict[str, str]:
        return {name.lower(): value for name, value in self.headers.items()}

    def _asked(self) -> tuple[str, str] | None:
        """Path and query, of a request that comes from where it should."""
        refusal = self.server.guard.refusal(self._headers(), self.headers.get_all("Host") or [])
        if refusal is not None:
            self._refuse(*refusal)
            return None
        try:
            parts = urlsplit(self.path)
        except ValueError:
            self._refuse(HTTPStatus.BAD_REQUEST, "the address cannot be read")
            return None
        if parts.scheme or parts.netloc:
            self._refuse(HTTPStatus.NOT_FOUND, "there is nothing here")
            return None
        return parts.path, parts.query

    def _body(self) -> bytes | None:
        """The body of a request; None where it was refused."""
        kind = self.headers.get("Content-Type", "").partition(";")[0].strip().lower()
        length = self.headers.get("Content-Length", "")
        if kind != "application/json":
            self._refuse(HTTPStatus.UNSUPPORTED_MEDIA_TYPE, "application/json is needed")
        elif self.headers.get("Transfer-Encoding") or not (length.isascii() and length.isdigit()):
            self._refuse(HTTPStatus.LENGTH_REQUIRED, "the length of the request is needed")
        elif len(length) > 9 or int(length) > MOST_BYTES:
            self._refuse(HTTPStatus.REQUEST_ENTITY_TOO_LARGE, "the request is too long")
        else:
            body = self.rfile.read(int(length))
            if len(body) == int(length):
                return body
            self._refuse(HTTPStatus.BAD_REQUEST, "the request is cut off")
        return None

    def _refuse(self, status: int, text: str) -> None:
        """Say no, in words."""
        body = json.dumps({"error": text}).encode()
        self._send(Answer(status, "application/json; charset=utf-8", body))

    def _send(self, answer: Answer) -> None:
        self.request_version = self.protocol_version  # what is no request has headers too
        self.send_response_only(answer.status)
        for name, value in HEADERS.items():
            self.send_header(name, value)
        self.send_header("Content-Type", answer.kind)
        self.send_header("Content-Length", str(len(answer.body)))
        self.send_header("Connection", "close")
        self.close_connection = True
        self.end_headers()
        if self.command != "HEAD":
            self.wfile.write(answer.body)

    def send_error(self, code: int, message: str | None = None, explain: str | None = None) -> None:
        """Refuse what could not be read as a request, in the form of all refusals."""
        del message, explain  # may repeat what a stranger sent
        self._refuse(code, HTTPStatus(code).phrase.lower())

    def log_message(self, format: str, *args: Any) -> None:
        """Nothing: an address with its token is not for a terminal."""
