"""What is to happen to the calls of a process on files; the other half of calls.c."""

import mmap
import os
import shutil
import struct
import subprocess
from pathlib import Path

SOURCE = Path(__file__).with_name("calls.c")
KINDS = (
    "write", "open to write", "open to read", "read", "fsync", "rename", "unlink", "mkdir", "stat",
    "close", "ftruncate", "list", "link",
)  # fmt: skip
ALL = (1 << len(KINDS)) - 1
BEFORE, AFTER, TORN, SHORT = 1001, 1002, 1003, 1004
_NUMBERS = struct.Struct("8l")
_TEXTS = struct.Struct("2048s1024s")


def compiler():
    """A C compiler, or None."""
    return shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")


def compiled(folder):
    """The library that is loaded before that of the system, built in a folder."""
    library = folder / "calls.so"
    subprocess.run(
        [compiler(), "-O1", "-shared", "-fPIC", "-w", "-o", library, SOURCE, "-ldl"], check=True
    )
    return library


def mask(*names):
    """Kinds of calls as bits."""
    return sum(1 << KINDS.index(name) for name in names)


class Calls:
    """Counts the calls of processes that were started with `environment`, and spoils some."""

    def __init__(self, folder, folders):
        """Count calls on files below ``folders`` (absolute paths)."""
        self._path = folder / "plan"
        self._record = folder / "record"
        self._path.write_bytes(bytes(_NUMBERS.size + _TEXTS.size))
        self._library = compiled(folder)
        with self._path.open("rb+") as file:
            self._map = mmap.mmap(file.fileno(), 0)
        self.watch(folders)

    @property
    def environment(self):
        """Variables of a process whose calls count."""
        return os.environ | {"LD_PRELOAD": str(self._library), "FAULTS": str(self._path)}

    def watch(self, folders):
        """Count calls on files below these folders."""
        names = "".join(f"{folder}\n" for folder in folders).encode()
        _TEXTS.pack_into(self._map, _NUMBERS.size, names, str(self._record).encode())

    def arm(self, *, at=0, how=0, kinds=ALL, then=0, told=False):
        """Begin to count; the ``at``-th call of ``kinds`` is spoilt, and all of ``then`` after it.

        ``how`` is an error of the system or one of BEFORE, AFTER, TORN, SHORT.
        """
        self._record.unlink(missing_ok=True)
        _NUMBERS.pack_into(self._map, 0, 1, at, how, kinds, then, told, 0, 0)

    def disarm(self):
        """Stop, and say how many calls were counted and how many spoilt."""
        *_, count, done = _NUMBERS.unpack_from(self._map, 0)
        _NUMBERS.pack_into(self._map, 0, *(8 * [0]))
        return count, done

    def told(self):
        """The calls that were written down: number, name of the call, path."""
        if not self._record.exists():
            return []
        lines = self._record.read_text().splitlines()
        return [
            (int(number), name, path) for number, name, path in (one.split(" ", 2) for one in lines)
        ]
