"""The explorer's server: who is answered, what is refused, and how long it waits."""

import http.client
import json
import socket
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing, suppress
from pathlib import Path
from types import SimpleNamespace

import pytest

from reduction.pages import explorer_server as server_module
from reduction.pages.explorer_server import ExploreServer
from reduction.record.errors import DataError, SettingsError

ROUTES = ("/api/campaign", "/api/change", "/api/save", "/api/reload")
STATIC = ("/plotly.js", "/inflate.js", "/figures.js", "/explore.js", "/explore.css", "/page.css")
HOSTILE = '<img src=x onerror="alert(1)">\n</script>' + "x" * 500


class Campaign:
    """What the server asks of a session, with names that are markup."""

    path = Path("campaign.toml")

    def __init__(self):
        plan = SimpleNamespace(id=HOSTILE, kind="cyclic")
        self.surveys = [SimpleNamespace(plan=plan, n_rows=3, error=None)]
        self.campaign = SimpleNamespace(
            id="c", attributes={"title": HOSTILE}, in_words=lambda text: text
        )
        self.text = SimpleNamespace(digest="d")
        self.wait = threading.Event()
        self.entered = threading.Event()
        self.at_work = 0

    def read_again(self):
        self.entered.set()
        assert self.wait.wait(20)

    def changed(self, test, changes):
        return SimpleNamespace(digest="e")

    def made(self, test, text):
        self.at_work += 1
        threading.Event().wait(0.005)
        assert self.at_work == 1, "one change at a time"
        self.at_work -= 1
        if test == "defect":
            raise ZeroDivisionError("of a secret")
        raise DataError(f"no such test: {test}")


@pytest.fixture
def session():
    made = Campaign()
    yield made
    made.wait.set()


@pytest.fixture
def server(session):
    defects = []
    with ExploreServer(session, "si", 0, defects.append) as made:
        made.defects = defects
        thread = threading.Thread(target=made.serve_forever, kwargs={"poll_interval": 0.02})
        thread.start()
        yield made
        session.wait.set()
        made.shutdown()
        thread.join()


def ask(server, method, path, body=None, **changed):
    """One request as the page sends it, with some of its headers changed or left out."""
    headers = {"Host": f"127.0.0.1:{server.server_port}"}
    if method == "POST":
        headers["Content-Type"] = "application/json"
        headers["Authorization"] = f"Bearer {server.token}"
        body = json.dumps(body).encode() if isinstance(body, dict) else body
        headers["Content-Length"] = str(len(body or b""))
    headers |= {name.replace("_", "-"): value for name, value in changed.items()}
    with closing(http.client.HTTPConnection("127.0.0.1", server.server_port, timeout=20)) as line:
        line.putrequest(method, path, skip_host=True, skip_accept_encoding=True)
        for name, value in headers.items():
            if value is not None:
                line.putheader(name, value)
        line.endheaders(body)
        answer = line.getresponse()
        text = answer.read()
        return SimpleNamespace(status=answer.status, headers=answer.headers, text=text)


def raw(server, text, *, close=False):
    """What comes back for bytes that no client would send."""
    with socket.create_connection(("127.0.0.1", server.server_port), timeout=20) as line:
        line.sendall(text)
        if close:
            line.shutdown(socket.SHUT_WR)
        found = b""
        while part := line.recv(65536):
            found += part
    return found


def until(server, *, is_answered):
    """Ask until an answer comes, or until none comes any more."""
    for _ in range(400):
        try:
            found = ask(server, "GET", "/explore.css").status == 200
        except (ConnectionError, http.client.HTTPException):
            found = False
        if found is is_answered:
            return True
        threading.Event().wait(0.02)
    return False


def test_it_listens_on_this_machine_alone(server):
    assert server.socket.getsockname()[0] == "127.0.0.1"
    assert server.address.startswith(f"http://127.0.0.1:{server.server_port}/?token=")
    assert len(server.token) >= 40


def test_a_port_that_is_taken_is_refused_in_words(server, session):
    with pytest.raises(SettingsError, match=r"the port cannot be had; found \d+: .*in use"):
        ExploreServer(session, "si", server.server_port)


def test_every_token_is_another(server, session):
    with ExploreServer(session, "si") as other:
        assert other.token != server.token


def test_the_page_opens_with_the_address_that_was_printed(server):
    found = ask(
        server, "GET", server.address.removeprefix(f"http://127.0.0.1:{server.server_port}")
    )
    assert found.status == 200 and b"<title>Explore a campaign</title>" in found.text


@pytest.mark.parametrize(
    "query", ["", "?token=", "?token=wrong", "?token={0}x", "?token={0}&token={0}", "?Token={0}",
              "?token=%C3%BF", "?" + "a" * 300, "?" + "&".join("abcdefgh")],
)  # fmt: skip
def test_the_page_needs_its_token(server, query):
    found = ask(server, "GET", "/" + query.format(server.token))
    assert found.status == 403
    assert json.loads(found.text)["error"].startswith("the token is missing or wrong")


@pytest.mark.parametrize("path", ROUTES)
@pytest.mark.parametrize(
    "given", [None, "", "Bearer", "Bearer wrong", "Basic {0}", "Bearer {0}x", "{0}", "Bearer \xff"]
)
def test_every_document_needs_the_token(server, path, given):
    given = given and given.format(server.token)
    assert ask(server, "POST", path, {}, Authorization=given).status == 403


def test_style_and_scripts_hold_nothing_of_a_campaign_and_are_the_only_files(server):
    for path in STATIC:
        found = ask(server, "GET", path)
        assert found.status == 200 and len(found.text) > 100
        assert server.token.encode() not in found.text


@pytest.mark.parametrize("method", ["GET", "POST"])
@pytest.mark.parametrize(
    "host", [None, "", "evil.example", "127.0.0.1", "127.0.0.1:1", "localhost", "127.0.0.1.evil.example:{0}",
             "evil.example:{0}", "[::1]:{0}", "127.1:{0}"],
)  # fmt: skip
def test_a_name_that_was_made_to_lead_here_is_not_answered(server, method, host):
    host = host and host.format(server.server_port)
    path = "/api/campaign" if method == "POST" else f"/?token={server.token}"
    found = ask(server, method, path, {}, Host=host)
    assert found.status == 403 and b"its own address alone" in found.text


def test_two_names_of_the_host_are_not_answered(server):
    here = f"127.0.0.1:{server.server_port}"
    text = f"GET /explore.js HTTP/1.1\r\nHost: {here}\r\nHost: {here}\r\n\r\n"
    assert raw(server, text.encode()).startswith(b"HTTP/1.1 403 ")


@pytest.mark.parametrize(
    ("name", "value"),
    [("Origin", "https://evil.example"), ("Origin", "null"), ("Origin", "http://127.0.0.1:1"),
     ("Origin", "https://127.0.0.1:{0}"), ("Sec-Fetch-Site", "cross-site"),
     ("Sec-Fetch-Site", "same-site")],
)  # fmt: skip
def test_a_page_of_another_server_is_not_answered(server, name, value):
    changed = {name.replace("-", "_"): value.format(server.server_port)}
    for method, path in (("GET", "/plotly.js"), ("POST", "/api/campaign")):
        found = ask(server, method, path, {}, **changed)
        assert found.status == 403 and b"a page of another server" in found.text


@pytest.mark.parametrize("name", ["127.0.0.1", "localhost"])
def test_its_own_page_is_answered(server, name):
    here = f"{name}:{server.server_port}"
    found = ask(
        server, "POST", "/api/campaign", {}, Host=here, Origin=f"http://{here}",
        Sec_Fetch_Site="same-origin",
    )  # fmt: skip
    assert found.status == 200


def test_names_that_are_markup_go_as_text_in_json(server):
    found = ask(server, "POST", "/api/campaign", {})
    assert found.headers["Content-Type"] == "application/json; charset=utf-8"
    document = json.loads(found.text)
    assert document["title"] == HOSTILE and document["tests"][0]["id"] == HOSTILE


@pytest.mark.parametrize(
    "path", ["/api", "/campaign.toml", "/../../etc/passwd", "/..%2f..%2fetc/passwd", "/explore.js/",
             "/EXPLORE.JS", "/static/explore.js", "http://evil.example/explore.js",
             "/api/campaign/../save", "/%00", "/[::1"],
)  # fmt: skip
def test_nothing_names_a_file(server, path):
    assert ask(server, "GET", path).status in (404, 400)
    assert ask(server, "POST", path, {}).status in (404, 400)


def test_a_known_path_in_another_way_is_refused(server):
    assert ask(server, "GET", "/api/save").status == 405
    assert ask(server, "POST", "/explore.js", {}).status == 405


@pytest.mark.parametrize("method", ["PUT", "DELETE", "OPTIONS", "HEAD", "TRACE", "PATCH", "FOO"])
def test_other_methods_are_not_known(server, method):
    found = ask(server, method, "/")
    assert found.status == 501
    assert "Access-Control-Allow-Origin" not in found.headers


@pytest.mark.parametrize("path", ["/", "/explore.js", "/api/campaign", "/nothing"])
def test_every_answer_is_kept_by_nobody_framed_by_nobody_and_guessed_by_nobody(server, path):
    headers = ask(server, "GET", path).headers
    assert headers["Cache-Control"] == "no-store"
    assert headers["X-Content-Type-Options"] == "nosniff"
    assert headers["Referrer-Policy"] == "no-referrer"
    assert headers["X-Frame-Options"] == "DENY"
    assert headers["Cross-Origin-Resource-Policy"] == "same-origin"
    policy = headers["Content-Security-Policy"]
    assert "default-src 'none'" in policy and "script-src 'self';" in policy
    for name in ("frame-ancestors", "base-uri", "form-action"):
        assert f"{name} 'none'" in policy
    assert headers["Server"] is None


@pytest.mark.parametrize(
    ("changed", "status"),
    [({"Content_Type": "text/plain"}, 415), ({"Content_Type": None}, 415),
     ({"Content_Length": None}, 411), ({"Content_Length": "-1"}, 411),
     ({"Content_Length": "1e3"}, 411), ({"Content_Length": "²"}, 411),
     ({"Content_Length": "64001"}, 413), ({"Content_Length": "9" * 4000}, 413),
     ({"Transfer_Encoding": "chunked"}, 411)],
)  # fmt: skip
def test_a_body_states_what_it_is_and_how_long(server, changed, status):
    text = "".join(
        f"{name}: {value}\r\n"
        for name, value in (
            {"Host": f"127.0.0.1:{server.server_port}", "Content-Type": "application/json",
             "Content-Length": "2", "Authorization": f"Bearer {server.token}"}
            | {name.replace("_", "-"): value for name, value in changed.items()}
        ).items()
        if value is not None
    )  # fmt: skip
    found = raw(server, f"POST /api/campaign HTTP/1.1\r\n{text}\r\n{{}}".encode())
    assert found.startswith(f"HTTP/1.1 {status} ".encode())


@pytest.mark.parametrize(
    "body", [b"", b"{", b"[]", b"null", b"\xff", b"[" * 60_000, b'{"test": 1, "changes": {}}',
             b'{"test": "T", "changes": {"a": 1}}', b'{"test": "T", "changes": []}',
             b'{"test": "T", "changes": {"cycles.band": "\\ud800"}}',
             b'{"test": "T"}', json.dumps({"test": "T" * 300, "changes": {}}).encode(),
             json.dumps({"test": "T", "changes": dict.fromkeys(map(str, range(50)), "")}).encode()],
)  # fmt: skip
def test_a_body_that_is_not_as_it_should_be_is_refused_in_words(server, body):
    found = ask(server, "POST", "/api/change", body)
    assert found.status == 400
    assert json.loads(found.text)["error"].startswith("the request")


def test_a_save_says_what_it_saves(server):
    found = ask(server, "POST", "/api/save", {"test": "T", "changes": {}, "before": "d"})
    assert found.status == 400 and b"the request has no after" in found.text


@pytest.mark.parametrize(
    "text", [b"\r\n\r\n", b"GET\r\n\r\n", b"GET / HTTP/9.9\r\n\r\n", b"\x16\x03\x01\x02\x00\r\n\r\n",
             b"GET /" + b"a" * 70_000 + b" HTTP/1.1\r\n\r\n",
             b"GET / HTTP/1.1\r\n" + b"X: y\r\n" * 200 + b"\r\n",
             b"GET / HTTP/1.1\r\nX: " + b"y" * 70_000 + b"\r\n\r\n"],
)  # fmt: skip
def test_what_is_no_request_ends_without_a_word_of_python(server, text):
    found = raw(server, text, close=True)
    assert found == b"" or found[:10] == b"HTTP/1.1 4" or found[:12] == b"HTTP/1.1 505"
    assert b"Traceback" not in found and b"Python" not in found and b"<" not in found
    assert ask(server, "POST", "/api/campaign", {}).status == 200


def test_an_error_of_a_test_is_a_message(server):
    found = ask(server, "POST", "/api/change", {"test": "none", "changes": {}})
    assert found.status == 422 and json.loads(found.text)["error"] == "no such test: none"


def test_a_defect_of_an_answer_is_told_in_the_terminal_and_not_to_who_asked(server, monkeypatch):
    def broken(*_):
        raise ZeroDivisionError("of a secret")

    monkeypatch.setattr(server_module, "_read", broken)
    found = ask(server, "POST", "/api/change", {"test": "T-1", "changes": {}})
    assert found.status == 500
    assert b"secret" not in found.text
    assert [str(one) for one in server.defects] == ["of a secret"]


def test_a_defect_is_a_line_on_the_page_and_told_in_the_terminal(server):
    found = ask(server, "POST", "/api/change", {"test": "defect", "changes": {}})
    assert found.status == 500
    said = "internal error, a defect of this program: ZeroDivisionError"
    assert json.loads(found.text)["error"] == said
    assert [str(one) for one in server.defects] == ["of a secret"]


def test_a_request_that_dawdles_is_cut_off(server, monkeypatch):
    monkeypatch.setattr(server_module._Handler, "timeout", 0.2)
    assert raw(server, b"GET / HTTP/1.1\r\nHo") == b""
    head = f"POST /api/campaign HTTP/1.1\r\nHost: 127.0.0.1:{server.server_port}\r\n"
    head += f"Authorization: Bearer {server.token}\r\nContent-Type: application/json\r\n"
    assert raw(server, f"{head}Content-Length: 10\r\n\r\n{{".encode()) == b""


def test_a_connection_has_an_end_however_it_goes_on(server, monkeypatch):
    monkeypatch.setattr(server_module, "DEADLINE", 0.3)
    with socket.create_connection(("127.0.0.1", server.server_port), timeout=20) as line:
        line.sendall(b"GET / HTTP/1.1\r\n")
        assert line.recv(100) == b""


def test_slow_connections_make_room_for_one_that_asks(server):
    lines = [
        socket.create_connection(("127.0.0.1", server.server_port), timeout=20)
        for _ in range(server_module.MOST_AT_ONCE + 8)
    ]
    for line in lines:
        with suppress(OSError):  # those that came first were turned away for those that came last
            line.sendall(b"GET / HTTP/1.1\r\n")
    began = time.monotonic()
    assert ask(server, "GET", "/explore.css").status == 200
    assert time.monotonic() - began < server_module.PATIENCE / 2
    for line in lines:
        line.close()
    assert until(server, is_answered=True)


def test_more_at_work_than_there_are_places_are_turned_away(server, session):
    with ThreadPoolExecutor(server_module.MOST_AT_ONCE) as pool:
        asked = [
            pool.submit(ask, server, "POST", "/api/reload", {})
            for _ in range(server_module.MOST_AT_ONCE)
        ]
        end = time.monotonic() + 20
        while server._places._value or server._waiting:  # until every place is at work
            assert time.monotonic() < end, [one.done() and one.exception() for one in asked]
            threading.Event().wait(0.01)
        with pytest.raises((ConnectionError, http.client.HTTPException)):
            ask(server, "GET", "/explore.css")
        session.wait.set()
        assert {one.result(20).status for one in asked} == {200}
    assert until(server, is_answered=True)


def test_work_takes_longer_than_a_request_may_take_to_arrive(server, session, monkeypatch):
    monkeypatch.setattr(server_module, "DEADLINE", 0.3)
    later = threading.Timer(1.0, session.wait.set)
    later.start()
    found = ask(server, "POST", "/api/reload", {})
    assert found.status == 200 and json.loads(found.text)["campaign"] == "c"
    later.join()


def test_what_is_asked_while_another_is_at_work_waits_for_it(server, session):
    with ThreadPoolExecutor(2) as pool:
        first = pool.submit(ask, server, "POST", "/api/reload", {})
        assert session.entered.wait(20)
        second = pool.submit(ask, server, "POST", "/api/campaign", {})
        # style and scripts, and refusals, do not wait
        assert ask(server, "GET", "/explore.css").status == 200
        assert ask(server, "POST", "/api/campaign", {}, Authorization="").status == 403
        assert not second.done()
        session.wait.set()
        assert first.result(20).status == second.result(20).status == 200


def test_changes_at_once_do_not_mix(server):
    def change(number):
        told = {"test": f"T{number}", "changes": {}}
        return json.loads(ask(server, "POST", "/api/change", told).text)["error"]

    with ThreadPoolExecutor(8) as pool:
        answers = list(pool.map(change, range(24)))
    assert answers == [f"no such test: T{number}" for number in range(24)]
    assert server.defects == []
