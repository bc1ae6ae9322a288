"""What the server answers: a few routes, and nothing that names a file."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.resources import files
from typing import Any

from plotly.offline import get_plotlyjs  # type: ignore[import-untyped]

from reduction.errors import ReductionError, SettingsError
from reduction.explore.document import as_json, campaign_document, change_document
from reduction.explore.session import Session
from reduction.explore.work import Document, Told, Work
from reduction.units import UnitSystem

__all__ = ["Answer", "Routes"]

_WAIT = 1.0
"""How long an answer waits for a change before it says that it is at work. [s]"""
_MOST_CHANGES = 40
_LONGEST = 200
# of a character that UTF-16 writes as two: JSON can say one of them, and a file cannot hold it
_HALF = re.compile(r"[\ud800-\udfff]")


@dataclass(frozen=True)
class Answer:
    """Status, kind and bytes of an answer."""

    status: int
    kind: str
    body: bytes


def _json(status: int, document: Mapping[str, Any]) -> Answer:
    return Answer(status, "application/json; charset=utf-8", as_json(document))


class Routes:
    """The routes of one session.

    Parameters
    ----------
    session : Session
        The campaign; used by the thread of the work alone.
    work : Work
        That thread.
    units : UnitSystem
        What a reader is shown.
    """

    def __init__(self, session: Session, work: Work, units: UnitSystem) -> None:
        self._session = session
        self._work = work
        self._units = units
        ours, report = files("reduction.explore") / "static", files("reduction.report") / "static"
        script, style = "text/javascript; charset=utf-8", "text/css; charset=utf-8"
        self.page = (ours / "explore.html").read_bytes()
        self.static = {
            "/explore.css": (style, (ours / "explore.css").read_bytes()),
            "/explore.js": (script, (ours / "explore.js").read_bytes()),
            "/page.css": (style, (report / "page.css").read_bytes()),
            "/figures.js": (script, (report / "figures.js").read_bytes()),
            "/plotly.js": (script, get_plotlyjs().encode("utf-8")),
        }
        self.posted = {
            "/api/campaign": self._campaign,
            "/api/change": self._change,
            "/api/job": self._job,
            "/api/save": self._save,
            "/api/reload": self._reload,
        }

    def post(self, path: str, body: bytes) -> Answer:
        """Answer a request with a document; one that is not as it should be is refused in words."""
        try:
            asked = json.loads(body)
            if not isinstance(asked, dict):
                raise SettingsError("the request is not an object")
            return self.posted[path](asked)
        except (ValueError, RecursionError) as error:
            said = str(error) if isinstance(error, ReductionError) else "the request is not JSON"
            return _json(400, {"error": said})

    def _campaign(self, asked: Document) -> Answer:
        def work(told: Told) -> Document:
            return campaign_document(self._session, self._units)

        return self._started(work)

    def _reload(self, asked: Document) -> Answer:
        def work(told: Told) -> Document:
            told("reading the campaign again")
            self._session.read_again()
            return campaign_document(self._session, self._units)

        return self._started(work)

    def _change(self, asked: Document) -> Answer:
        test, changes = _test_of(asked), _changes_of(asked)

        def work(told: Told) -> Document:
            session = self._session
            before = session.made(test, session.text, told)
            text = session.changed(test, changes)
            after = session.made(test, text, told)
            told("drawing")
            found = change_document(session, test, text, before, after, self._units)
            return found | {"is_changed_on_disk": session.is_changed_on_disk}

        return self._started(work)

    def _save(self, asked: Document) -> Answer:
        test, changes = _test_of(asked), _changes_of(asked)
        before, after = _text_of(asked, "before"), _text_of(asked, "after")

        def work(told: Told) -> Document:
            told("saving")
            session = self._session
            text = session.changed(test, changes)
            if (session.text.digest, text.digest) != (before, after):
                raise SettingsError(
                    "the diff that was shown is not of this file any more",
                    hint="Nothing was written. Look at the diff again.",
                )
            diff = session.text.difference(text)
            session.save(text)
            return {"saved": str(session.path), "diff": diff}

        return self._started(work)

    def _started(self, work: Any) -> Answer:
        job = self._work.start(work)
        job.ended.wait(_WAIT)
        return _json(*job.answer())

    def _job(self, asked: Document) -> Answer:
        number = asked.get("job")
        job = self._work.job(number) if isinstance(number, int) else None
        if job is None:
            return _json(404, {"error": "there is no such work any more"})
        job.ended.wait(_WAIT)
        return _json(*job.answer())


def _text_of(asked: Document, name: str) -> str:
    value = asked.get(name)
    if not isinstance(value, str) or len(value) > _LONGEST:
        raise SettingsError(f"the request has no {name}", needed="a short text")
    return value


def _test_of(asked: Document) -> str:
    return _text_of(asked, "test")


def _changes_of(asked: Document) -> dict[str, str]:
    changes = asked.get("changes")
    if not isinstance(changes, dict) or len(changes) > _MOST_CHANGES:
        raise SettingsError("the request has no changes", needed="texts by key")
    for key, value in changes.items():
        if not isinstance(value, str) or len(value) > _LONGEST or len(key) > _LONGEST:
            raise SettingsError("a change is not a short text", found=repr(key)[:60])
        if any(_HALF.search(one) for one in (key, value)):
            raise SettingsError("a change is no text", found=ascii(value)[:60], needed="UTF-8")
    return changes
