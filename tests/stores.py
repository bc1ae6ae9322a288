"""Places on the net for tests, without a net: an object store, and a server on this machine."""

import base64
import threading
from contextlib import contextmanager
from hashlib import sha256
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from io import BytesIO

import fsspec
from fsspec.registry import _registry


class ObjectStore(fsspec.AbstractFileSystem):
    """What S3 is to a program that reads: objects by their keys.

    ``closed`` are keys that nobody may touch, ``cut`` says after how many bytes reading one
    breaks off, ``moving`` are keys whose content is another one after each read, ``short``
    those of which the last byte is lost on the way here.
    """

    protocol = "s3"
    cachable = False
    objects: dict = {}  # noqa: RUF012  # one store for all instances, as on the net
    closed: set = set()  # noqa: RUF012
    cut: dict = {}  # noqa: RUF012
    moving: set = set()  # noqa: RUF012
    short: set = set()  # noqa: RUF012

    @classmethod
    def empty(cls):
        for held in (cls.objects, cls.closed, cls.cut, cls.moving, cls.short):
            held.clear()

    def _check(self, path):
        if path in self.closed:
            raise PermissionError("Access Denied")

    def info(self, path, **kwargs):
        path = self._strip_protocol(path)
        self._check(path)
        if path in self.objects:
            data = self.objects[path]
            return {
                "name": path, "size": len(data), "type": "file", "ETag": sha256(data).hexdigest(),
            }  # fmt: skip
        if any(name.startswith(f"{path}/") for name in self.objects):
            return {"name": path, "size": 0, "type": "directory"}
        raise FileNotFoundError(path)

    def _open(self, path, mode="rb", **kwargs):
        if mode != "rb":
            raise NotImplementedError("nothing is written")
        self._check(path)
        data = self.objects[path]
        if path in self.moving:
            self.objects[path] = data + b"\n"
        if path in self.short:
            data = data[:-1]
        return _Cut(data, self.cut.get(path))

    def ls(self, path, detail=True, **kwargs):
        raise NotImplementedError("a file is asked for by its name")

    cp_file = _rm = created = modified = sign = ls


class _Cut(BytesIO):
    """Bytes that end with an error after some of them."""

    def __init__(self, data, cut):
        super().__init__(data if cut is None else data[:cut])
        self.is_cut = cut is not None
        self.size = len(data)

    def read(self, size=-1):
        data = super().read(size)
        if not data and self.is_cut:
            raise RuntimeError("the other side is gone")
        return data


@contextmanager
def object_store():
    """An empty store at s3://; what a user has at that address is not asked."""
    before = _registry.get("s3")
    _registry["s3"] = ObjectStore
    ObjectStore.empty()
    try:
        yield ObjectStore
    finally:
        ObjectStore.empty()
        _registry.pop("s3")
        if before is not None:
            _registry["s3"] = before


class Server(ThreadingHTTPServer):
    """Files by their paths; ``user`` has to be named, ``statuses`` refuse, ``cut`` breaks off.

    Of one that is ``stopped`` half is sent, and then nothing; of one that is ``unsized`` neither
    size nor mark is announced.
    """

    def __init__(self):
        super().__init__(("127.0.0.1", 0), _Handler)
        self.files = {}
        self.statuses = {}
        self.cut = {}
        self.stopped = set()
        self.unsized = set()
        self.has_stopped = threading.Event()
        self.user = ""
        self.asked = []

    def address(self, name, *, user="", query=""):
        host = f"127.0.0.1:{self.server_address[1]}"
        return f"http://{user}{'@' if user else ''}{host}/{name}{'?' if query else ''}{query}"


class _Handler(BaseHTTPRequestHandler):
    def log_message(self, *args):
        """Nothing on standard error."""

    def do_HEAD(self):
        self._answer(with_body=False)

    def do_GET(self):
        self._answer(with_body=True)

    def _answer(self, *, with_body):
        self.server.asked.append(self.path)
        name = self.path.partition("?")[0].lstrip("/")
        status = self.server.statuses.get(name, 200 if name in self.server.files else 404)
        wanted = base64.b64encode(self.server.user.encode()).decode()
        if self.server.user and self.headers.get("Authorization") != f"Basic {wanted}":
            status = 401
        self.send_response(status)
        data = self.server.files.get(name, b"") if status == 200 else b""
        if name not in self.server.unsized:
            self.send_header("Content-Length", str(len(data)))
        if status == 200 and name not in self.server.unsized:
            self.send_header("ETag", f'"{sha256(data).hexdigest()}"')
        self.end_headers()
        if with_body and name in self.server.stopped:
            self.wfile.write(data[: len(data) // 2])
            self.wfile.flush()
            self.server.has_stopped.set()
            self.connection.recv(1)  # until the other side is gone
        elif with_body:
            self.wfile.write(data[: self.server.cut.get(name, len(data))])


@contextmanager
def server():
    """A server on the loopback of this machine."""
    with Server() as one:
        thread = threading.Thread(
            target=one.serve_forever, kwargs={"poll_interval": 0.02}, daemon=True
        )
        thread.start()
        try:
            yield one
        finally:
            one.shutdown()
            thread.join()
