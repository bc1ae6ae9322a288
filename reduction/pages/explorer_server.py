"""The server of the explorer, on this machine only, and the documents for its page.

A request has to come from a page of this server, with its own name.  Size and duration of a request
are limited, so that a slow client does not delay the others.
"""

from __future__ import annotations

import hmac
import json
import secrets
import socket
import threading
from collections.abc import Callable, Mapping
from contextlib import suppress
from functools import partial
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from importlib.resources import files
from math import isfinite
from typing import Any
from urllib.parse import parse_qs, urlsplit

import numpy as np
from plotly.offline import get_plotlyjs

from reduction.batch.survey import Survey
from reduction.campaign.model import dimension_of, limits_of
from reduction.pages.explorer_campaign import (
    CampaignText,
    Session,
    Setting,
    Written,
    settings_of_kind,
)
from reduction.quantities.units import UnitSystem, display_unit, parse_quantity
from reduction.record.errors import ReductionError, SettingsError
from reduction.report.page_template import render_section
from reduction.report.test_section import make_section
from reduction.report.test_view import TestView
from reduction.report.text_style import number_text

# name in the archive of the value found where none was stated
_FOUND = {
    "phases.position_tolerance": ("standstill_position_tolerance",),
    "phases.tension_tolerance": ("hold_tension_tolerance",),
    "phases.slack_tension": ("slack_tension",),
    "cycles.band": ("position_band", "tension_band"),
    "modulus.window": ("strain_window",),
}


def _campaign_document(session: Session, units: UnitSystem) -> dict[str, Any]:
    """The campaign and its tests."""
    attributes = session.campaign.attributes
    return {
        "campaign": session.campaign.id,
        "title": attributes.get("title", ""),
        "synthetic": attributes.get("synthetic") == "yes",
        "file": str(session.path),
        "units": units,
        "tests": [
            {
                "id": one.plan.id,
                "kind": one.plan.kind,
                "rows": one.n_rows,
                "error": "" if one.error is None else session.campaign.in_words(str(one.error)),
            }
            for one in session.surveys
        ],
    }


def _change_document(
    session: Session, units: UnitSystem, *, test: str, changes: Mapping[str, str]
) -> dict[str, Any]:
    """Settings of a test, its section of the report, and the diff of campaign.toml."""
    text = session.changed(test, changes)
    made = session.made(test, text)
    key = "standing" if text.digest == session.text.digest else "changed"
    view = None if made.dataset is None else TestView(key, made.dataset, units)
    survey = made.survey
    settings = [
        _setting(one, text, survey, view, units) for one in settings_of_kind(survey.plan.kind)
    ]
    return {
        "test": test,
        "settings": settings + _step_settings(survey, text),
        "error": made.error,
        # names from files are escaped in it, and none of its scripts run
        "section": "" if view is None else render_section(make_section(view), is_folded=False).html,
        "diff": session.text.difference(text),
        "before": session.text.digest,
        "after": text.digest,
        "also": list(made.also),
        "is_standing": made.is_standing,
        "seconds": made.seconds,
        "rows": survey.n_rows,
    }


def _save_document(
    session: Session, *, test: str, changes: Mapping[str, str], before: str, after: str
) -> dict[str, Any]:
    """Write the change shown; ``before`` and ``after`` are the digests sent with the diff."""
    text = session.changed(test, changes)
    if (session.text.digest, text.digest) != (before, after):
        raise SettingsError(
            "the diff that was shown is not of this file any more",
            hint="Nothing was written. Look at the diff again.",
        )
    session.save(text)
    return {"saved": str(session.path)}


def _step_settings(survey: Survey, text: CampaignText) -> list[dict[str, Any]]:
    """Both ends of a step, which are not settings of a reduction."""
    if not survey.plan.step_place:
        return []
    ends = text.step_ends(survey.plan.log, survey.plan.step_place - 1)
    return [
        {
            "key": key, "group": "Steps", "words": f"{key.rpartition('.')[2]}, of this step",
            "value": value, "shown": value, "place": "test", "choices": [], "slider": None,
        }
        for key, value in ends.items()
    ]  # fmt: skip


def _setting(
    setting: Setting,
    text: CampaignText,
    survey: Survey,
    view: TestView | None,
    units: UnitSystem,
) -> dict[str, Any]:
    written = text.written(survey.plan.log, setting)
    in_force = _in_force(setting, survey, view)
    return {
        "key": setting.key,
        "group": setting.group,
        "words": setting.words,
        "value": written.text if written.place == "test" else "",
        "shown": written.text or _shown(setting, survey, in_force, units),
        "place": _place(setting, survey, written),
        "choices": list(setting.choices),
        "slider": _slider(setting, survey, in_force),
    }


def _place(setting: Setting, survey: Survey, written: Written) -> str:
    """Origin of the value in force; one that was not stated is a default, or was found."""
    if written.place != "nowhere" and (written.text or written.place == "table"):
        return written.place
    return "found" if _stated(setting, survey) is None else "default"


def _stated(setting: Setting, survey: Survey) -> Any:
    """Planned value of a setting, in SI; None where it is to be found."""
    group, _, name = setting.key.rpartition(".")
    return getattr(getattr(survey.plan.settings, group or "cycles"), name)


def _in_force(setting: Setting, survey: Survey, view: TestView | None) -> Any:
    """Value of a setting, in SI; the value found in the record where none was stated."""
    value = _stated(setting, survey)
    if value is not None or view is None:
        return value
    if setting.key == "strain.method":
        return ", ".join(dict.fromkeys(view.texts("strain_method")))
    if setting.key == "modulus.strain_bin_width":
        bounds = view.array("strain_bin_bounds")
        return None if bounds is None or not bounds.size else float(bounds[0, 1] - bounds[0, 0])
    values = (view.array(one) for one in _FOUND.get(setting.key, ()))
    return next((float(np.ravel(one)[0]) for one in values if one is not None and one.size), None)


def _shown(setting: Setting, survey: Survey, value: Any, units: UnitSystem) -> str:
    """A value as a person would write it, in display units."""
    if value is None:
        return ""
    if isinstance(value, str):
        return value
    group, _, name = setting.key.partition(".")
    dimension = dimension_of(group, name, control=survey.plan.control)
    if isinstance(value, tuple):
        return ", ".join(_quantity(one, dimension, units) for one in value)
    return _quantity(float(value), dimension, units)


def _quantity(value: float, dimension: str | None, units: UnitSystem) -> str:
    if not isfinite(value):
        return ""
    if dimension == "strain":
        return f"{number_text(100 * value).rstrip('0').rstrip('.')} %"
    si = {"time": "s", "length": "m", "force": "N"}.get(dimension or "")
    if si is None:
        return f"{value:.6g}"
    unit, factor = display_unit(si, units)
    return f"{value * factor:.4g} {unit}"


def _slider(setting: Setting, survey: Survey, in_force: Any) -> dict[str, Any] | None:
    """Ends, step and position of a slider; wide enough for the value in force."""
    slider = setting.slider
    if slider is None:
        return None
    scale = 1.0
    if slider.unit:
        scale = parse_quantity(f"1 {slider.unit}", "strain")
    value = in_force / scale if isinstance(in_force, int | float) else slider.low
    group, _, name = setting.key.partition(".")
    least, greatest = limits_of(group, name)
    high = slider.high
    if setting.key == "cycles.break_in_cycles":
        high = max(1, survey.n_cycles - 1)
    return {
        "low": max(min(slider.low, value), least / scale),
        "high": min(max(high, value), greatest / scale) if isfinite(greatest) else max(high, value),
        "step": slider.step,
        "unit": slider.unit,
        "value": value,
    }


HOST = "127.0.0.1"

MOST_BYTES = 64_000
"""Greatest size of the body of a request. [byte]"""

PATIENCE = 10.0
"""Time limit for the arrival of a part of a request, and for the receipt of an answer. [s]"""

DEADLINE = 30.0
"""Time limit for the arrival of a whole request; each connection has one request. [s]"""

MOST_AT_ONCE = 24

_TO_LEAVE = 1.0
"""Time limit for a connection that was cut off to free its place. [s]"""

_MOST_CHANGES = 40

_LONGEST = 200

_NAMES = (HOST, "localhost")

_JSON, _PAGE = "application/json; charset=utf-8", "text/html; charset=utf-8"

_SCRIPT, _STYLE = "text/javascript; charset=utf-8", "text/css; charset=utf-8"

_HEADERS = {
    "Cache-Control": "no-store",
    # plotly inserts its style sheet into the page, so styles have to be allowed in it
    "Content-Security-Policy": (
        "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src data:"
        " blob:; connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    ),
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Permissions-Policy": "camera=(), geolocation=(), microphone=()",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
}
"""Headers of every answer: no caching, framing, type guessing or referrer."""

Reply = tuple[int, str, bytes]


class _Refused(Exception):  # noqa: N818 - it is an answer, not an error of this program
    """A refused request: status and words."""


class ExploreServer(ThreadingHTTPServer):
    """A server of one session, on 127.0.0.1.

    Parameters
    ----------
    session : Session
        The campaign; it handles one request at a time.
    units : UnitSystem
        Display units.
    port : int
        0 for a free port.
    on_defect : callable, optional
        Called for a defect of this program; the page learns only that there was one.

    Raises
    ------
    SettingsError
        If the port is not available.
    """

    daemon_threads = True
    block_on_close = False
    allow_reuse_address = False
    # more than five simultaneous connections would wait a second or more for a retry
    request_queue_size = MOST_AT_ONCE

    def __init__(
        self,
        session: Session,
        units: UnitSystem,
        port: int = 0,
        on_defect: Callable[[Exception], None] = lambda error: None,
    ) -> None:
        try:
            super().__init__((HOST, port), _Handler)
        except (OSError, OverflowError) as error:
            raise SettingsError(
                "the port cannot be had",
                found=f"{port}: {getattr(error, 'strerror', None) or error}",
                needed="a free one from 1024 to 65535, or none: one is found then",
            ) from error
        self.token = secrets.token_urlsafe(32)
        self.on_defect = on_defect
        self.working = threading.Lock()
        self._places = threading.BoundedSemaphore(MOST_AT_ONCE)
        # oldest first, without those at work: connections that wait for their client
        self._waiting: dict[socket.socket, None] = {}
        self._waiting_lock = threading.Lock()
        ours, report = (
            files("reduction.pages") / "explorer_static",
            files("reduction.report") / "static",
        )
        self.page = (ours / "explore.html").read_bytes()
        self.static = {
            "/explore.css": (_STYLE, (ours / "explore.css").read_bytes()),
            "/explore.js": (_SCRIPT, (ours / "explore.js").read_bytes()),
            "/page.css": (_STYLE, (report / "page.css").read_bytes()),
            "/inflate.js": (_SCRIPT, (report / "inflate.js").read_bytes()),
            "/figures.js": (_SCRIPT, (report / "figures.js").read_bytes()),
            "/plotly.js": (_SCRIPT, get_plotlyjs().encode("utf-8")),
        }

        def again() -> dict[str, Any]:
            session.read_again()
            return _campaign_document(session, units)

        # function for each requested document, and the fields that it needs from a request
        self.documents: dict[str, tuple[Callable[..., dict[str, Any]], tuple[str, ...]]] = {
            "/api/campaign": (partial(_campaign_document, session, units), ()),
            "/api/reload": (again, ()),
            "/api/change": (partial(_change_document, session, units), ("test", "changes")),
            "/api/save": (partial(_save_document, session), ("test", "changes", "before", "after")),
        }

    @property
    def address(self) -> str:
        """The address of the page, with its token."""
        return f"http://{HOST}:{self.server_port}/?token={self.token}"

    def server_bind(self) -> None:
        """Bind, without asking a name server for the name of this machine."""
        self.socket.bind(self.server_address)
        self.server_address = self.socket.getsockname()
        self.server_name, self.server_port = HOST, self.server_address[1]

    def process_request(self, request: Any, client_address: Any) -> None:
        """Give a request a thread; if there are too many, the slowest connection is closed."""
        # a request takes a place and is counted as waiting in one step, or does neither
        with self._waiting_lock:
            taken = self._places.acquire(blocking=False)
            oldest = None if taken else next(iter(self._waiting), None)
            if oldest is not None:
                del self._waiting[oldest]
                _cut_off(oldest)
            if taken:
                self._waiting[request] = None
        if not taken:
            if oldest is None or not self._places.acquire(timeout=_TO_LEAVE):
                self.shutdown_request(request)
                return
            with self._waiting_lock:
                self._waiting[request] = None
        super().process_request(request, client_address)

    def process_request_thread(self, request: Any, client_address: Any) -> None:
        """Answer, and free the place."""
        try:
            super().process_request_thread(request, client_address)
        finally:
            self.is_at_work(request)
            self._places.release()

    def is_at_work(self, request: Any) -> None:
        """Mark a request that has arrived completely: its connection is not closed for others."""
        with self._waiting_lock:
            self._waiting.pop(request, None)

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Ignore broken connections; requests answer their own errors."""


def _cut_off(request: socket.socket) -> None:
    with suppress(OSError):  # it was already closed
        request.shutdown(socket.SHUT_RDWR)


class _Handler(BaseHTTPRequestHandler):
    """One connection with one request."""

    server: ExploreServer
    protocol_version = "HTTP/1.1"
    timeout = PATIENCE

    def setup(self) -> None:
        super().setup()
        self._deadline = threading.Timer(DEADLINE, _cut_off, (self.connection,))
        self._deadline.daemon = True
        self._deadline.start()

    def finish(self) -> None:
        self._deadline.cancel()
        super().finish()

    def do_GET(self) -> None:
        """The page for a client with the token; style and scripts contain no campaign data."""
        self._answer(self._got)

    def do_POST(self) -> None:
        """A document for a document."""
        self._answer(self._posted)

    def _answer(self, made: Callable[[str, str], Reply]) -> None:
        try:
            reply = made(*self._address())
        except _Refused as refusal:
            status, text = refusal.args
            reply = _as_json(status, {"error": text})
        except ReductionError as error:
            reply = _as_json(HTTPStatus.UNPROCESSABLE_ENTITY, {"error": str(error)})
        except OSError:  # the client has gone, or is too slow
            raise
        except Exception as error:
            # the page learns only that there was a defect; the terminal gets the details
            self.server.on_defect(error)
            said = f"internal error, a defect of this program: {type(error).__name__}"
            reply = _as_json(HTTPStatus.INTERNAL_SERVER_ERROR, {"error": said})
        self._send(*reply)

    def _address(self) -> tuple[str, str]:
        """Path and query of a request with a permitted origin."""
        known = {f"{name}:{self.server.server_port}" for name in _NAMES}
        hosts = self.headers.get_all("Host") or []
        if len(hosts) != 1 or hosts[0].lower() not in known:
            # a foreign host name that resolves to this machine
            raise _Refused(HTTPStatus.FORBIDDEN, "this server answers to its own address alone")
        origin = self.headers.get("Origin", f"http://{hosts[0]}").lower()
        site = self.headers.get("Sec-Fetch-Site", "none")
        if origin not in {f"http://{one}" for one in known} or site not in ("none", "same-origin"):
            raise _Refused(HTTPStatus.FORBIDDEN, "a page of another server asked")
        try:
            parts = urlsplit(self.path)
        except ValueError:
            raise _Refused(HTTPStatus.BAD_REQUEST, "the address cannot be read") from None
        if parts.scheme or parts.netloc:
            raise _Refused(HTTPStatus.NOT_FOUND, "there is nothing here")
        return parts.path, parts.query

    def _needs_token(self, given: list[str]) -> None:
        # compared in constant time
        own = self.server.token.encode()
        if len(given) != 1 or not hmac.compare_digest(given[0].encode("utf-8", "replace"), own):
            raise _Refused(
                HTTPStatus.FORBIDDEN,
                "the token is missing or wrong; open the address that the command printed",
            )

    def _got(self, path: str, query: str) -> Reply:
        if path in self.server.static:
            return HTTPStatus.OK, *self.server.static[path]
        if path != "/":
            raise _nothing_at(path in self.server.documents)
        try:
            given = parse_qs(query, max_num_fields=4).get("token", [])
        except ValueError:  # too many fields
            given = []
        self._needs_token(given)
        return HTTPStatus.OK, _PAGE, self.server.page

    def _posted(self, path: str, query: str) -> Reply:
        scheme, _, given = self.headers.get("Authorization", "").partition(" ")
        self._needs_token([given.strip()] if scheme.lower() == "bearer" else [])
        if path not in self.server.documents:
            raise _nothing_at(path == "/" or path in self.server.static)
        make, names = self.server.documents[path]
        asked = _read(self._body())
        missing = [name for name in names if name not in asked]
        if missing:
            raise _Refused(HTTPStatus.BAD_REQUEST, f"the request has no {missing[0]}")
        # the request has arrived completely: processing has no time limit
        self._deadline.cancel()
        self.server.is_at_work(self.connection)
        with self.server.working:
            return _as_json(HTTPStatus.OK, make(**{name: asked[name] for name in names}))

    def _body(self) -> bytes:
        """The body of a request that states its type and length."""
        kind = self.headers.get("Content-Type", "").partition(";")[0].strip().lower()
        length = self.headers.get("Content-Length", "")
        if kind != "application/json":
            raise _Refused(HTTPStatus.UNSUPPORTED_MEDIA_TYPE, "application/json is needed")
        if self.headers.get("Transfer-Encoding") or not (length.isascii() and length.isdigit()):
            raise _Refused(HTTPStatus.LENGTH_REQUIRED, "the length of the request is needed")
        if len(length) > len(str(MOST_BYTES)) or int(length) > MOST_BYTES:
            raise _Refused(HTTPStatus.REQUEST_ENTITY_TOO_LARGE, "the request is too long")
        body = self.rfile.read(int(length))
        if len(body) != int(length):
            raise _Refused(HTTPStatus.BAD_REQUEST, "the request is cut off")
        return body

    def _send(self, status: int, kind: str, body: bytes) -> None:
        self.request_version = self.protocol_version  # answers to invalid requests have headers too
        self.send_response_only(status)
        for name, value in _HEADERS.items():
            self.send_header(name, value)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(body)))
        self.send_header("Connection", "close")
        self.close_connection = True
        self.end_headers()
        if self.command != "HEAD":
            self.wfile.write(body)

    def send_error(self, code: int, message: str | None = None, explain: str | None = None) -> None:
        """Refuse an invalid request, in the form of all refusals."""
        del message, explain  # may repeat text of the client
        self._send(*_as_json(code, {"error": HTTPStatus(code).phrase.lower()}))

    def log_message(self, format: str, *args: Any) -> None:
        """Log nothing, since an address with its token does not belong on a terminal."""


def _nothing_at(is_known: bool) -> _Refused:
    if is_known:
        return _Refused(HTTPStatus.METHOD_NOT_ALLOWED, "not in this way")
    return _Refused(HTTPStatus.NOT_FOUND, "there is nothing here")


def _read(body: bytes) -> dict[str, Any]:
    """Document of a request: short texts, and changes as short texts by key."""
    try:
        asked: dict[str, Any] = json.loads(body)
        changes = asked.get("changes", {})
        texts = [*changes, *changes.values()]
        texts += [value for name, value in asked.items() if name != "changes"]
        # an unpaired surrogate of UTF-16 is valid in JSON, but in no file
        is_short = all(len(text.encode("utf-8")) <= _LONGEST for text in texts)
    except (ValueError, RecursionError, AttributeError, TypeError):
        is_short = False
    if not is_short or len(changes) > _MOST_CHANGES:
        raise _Refused(HTTPStatus.BAD_REQUEST, "the request is not one of short texts as JSON")
    return asked


def _as_json(status: int, document: dict[str, Any]) -> Reply:
    """Document in the form sent; a number that is not finite would be invalid JSON."""
    return status, _JSON, json.dumps(document, allow_nan=False).encode("utf-8")
