"""The products of campaigns in other surroundings, byte by byte.

    python benchmarks/same_bytes.py [CAMPAIGN ...] [--python PYTHON] [--only WORD]

Each campaign of raw/, or each that is named by its folder, is run as it is and then once in each of
the surroundings below: another time zone, locale, home, umask, working folder, place of the raw
files and of the products, hash seed, number of processors, number of processes.  All files that a
run leaves are compared, but for the seconds in ``status.csv``.  The exit status is 1 where one
differs.  ``--python`` is the interpreter of another environment in which the package is installed,
such as the locked one; ``--only`` takes the surroundings whose name has that word.  A locale that
the system lacks is made by ``localedef`` in a scratch folder.
"""

from __future__ import annotations

import argparse
import csv
import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

__all__ = [
    "ALL_AT_ONCE",
    "SURROUNDINGS",
    "Surroundings",
    "differences",
    "locales",
    "products",
    "run",
]

RAW = Path(__file__).parents[1] / "raw"
# long, with blanks, letters outside of ASCII and signs of the shell
ODD = "Prüfung 1, Ł & Söhne's [ßø] #100%/" + "/".join(["a folder far down"] * 6)


@dataclass(frozen=True, kw_only=True)
class Surroundings:
    """What is other than in the run that the others are held against.

    ``changed`` are variables of the environment, None for one that is taken away; ``folder`` is
    where raw files and products lie below a scratch folder; ``processors`` how many may be used.
    """

    name: str
    changed: Mapping[str, str | None] = field(default_factory=dict)
    umask: int = 0o022
    folder: str = "work"
    works_in: str = "."
    processors: int | None = None
    options: tuple[str, ...] = ()
    python_options: tuple[str, ...] = ()
    is_read_only: bool = False


ALL_AT_ONCE = Surroundings(
    name="all at once",
    changed={
        "TZ": "Pacific/Kiritimati", "LC_ALL": "tr_TR.UTF-8", "LANG": "tr_TR.UTF-8",
        "PYTHONUTF8": "0", "PYTHONHASHSEED": "4242", "HOME": None, "XDG_CACHE_HOME": None,
        "SOURCE_DATE_EPOCH": "86400", "COLUMNS": "20",
    },
    umask=0o077, folder=ODD, works_in="elsewhere/deep", processors=1, python_options=("-OO",),
    is_read_only=True,
)  # fmt: skip
SURROUNDINGS = (
    Surroundings(name="again"),
    Surroundings(name="14 hours ahead", changed={"TZ": "Pacific/Kiritimati"}),
    Surroundings(name="3.5 hours behind", changed={"TZ": "America/St_Johns"}),
    Surroundings(name="Turkish", changed={"LC_ALL": "tr_TR.UTF-8", "LANG": "tr_TR.UTF-8"}),
    Surroundings(name="German", changed={"LC_ALL": "de_DE.UTF-8", "LANGUAGE": "de"}),
    Surroundings(
        name="Turkish, ISO 8859-9", changed={"LC_ALL": "tr_TR.ISO-8859-9", "PYTHONUTF8": "0"}
    ),
    Surroundings(
        name="C, ASCII",
        changed={"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"},
    ),
    Surroundings(name="POSIX", changed={"LC_ALL": "POSIX", "PYTHONUTF8": "0"}),
    Surroundings(name="no home", changed={"HOME": None, "XDG_CACHE_HOME": None, "USER": None}),
    Surroundings(name="umask 077", umask=0o077),
    Surroundings(name="hash seed 1", changed={"PYTHONHASHSEED": "1"}),
    Surroundings(name="hash seed 4294967295", changed={"PYTHONHASHSEED": "4294967295"}),
    Surroundings(name="odd path", folder=ODD),
    Surroundings(name="another working folder", works_in="elsewhere/deep"),
    Surroundings(name="one processor", processors=1),
    Surroundings(name="two processors", processors=2),
    Surroundings(name="two processes", options=("--jobs", "2")),
    Surroundings(name="without docstrings", python_options=("-OO",)),
    Surroundings(name="another date of build", changed={"SOURCE_DATE_EPOCH": "86400"}),
    Surroundings(name="narrow terminal", changed={"COLUMNS": "20", "TERM": "dumb"}),
    Surroundings(name="raw files read only and of another time", is_read_only=True),
    ALL_AT_ONCE,
)  # fmt: skip


def locales(names: Sequence[str], folder: Path) -> dict[str, str]:
    """Variables by which the named locales are found; one that cannot be had is told and left out.

    ``LOCPATH`` replaces the folder of the system, so that all of them are made.
    """
    made = []
    for name in names:
        language, _, encoding = name.partition(".")
        command = ["localedef", "-i", language, "-f", encoding, str(folder / name)]
        if shutil.which("localedef") is None:
            continue
        folder.mkdir(parents=True, exist_ok=True)
        # 1 is a warning, after which the locale is there
        subprocess.run(command, capture_output=True, check=False)
        if (folder / name).is_dir():
            made.append(name)
    for name in sorted(set(names) - set(made)):
        print(f"{name}: not to be had here; its run has the locale C", file=sys.stderr)
    return {"LOCPATH": str(folder)} if made else {}


def products(folder: Path) -> dict[str, str]:
    """Hash of each file below a folder, by its path; seconds in tables of tests are left out."""
    found = {}
    for path in sorted(folder.rglob("*")):
        if path.is_file():
            raw = path.read_bytes()
            if path.name == "status.csv":
                raw = _without_seconds(raw.decode("utf-8")).encode("utf-8")
            found[path.relative_to(folder).as_posix()] = hashlib.sha256(raw).hexdigest()
    return found


def _without_seconds(text: str) -> str:
    rows = list(csv.reader(text.splitlines()))
    place = rows[0].index("seconds")
    return repr([row[:place] + row[place + 1 :] for row in rows])


def differences(one: Mapping[str, str], other: Mapping[str, str]) -> list[str]:
    """Files that are in one of two runs alone, or not the same in both."""
    return sorted(name for name in one.keys() | other.keys() if one.get(name) != other.get(name))


def run(
    campaign: Path,
    surroundings: Surroundings,
    scratch: Path,
    *,
    python: Path = Path(sys.executable),
    environment: Mapping[str, str] | None = None,
) -> dict[str, str]:
    """Run a copy of a campaign's folder in these surroundings, and hash what it makes.

    Raises
    ------
    RuntimeError
        If the command fails, or says anything to standard error but its progress.
    """
    base = scratch / surroundings.folder
    raw = base / "raw" / campaign.name
    shutil.copytree(campaign, raw)
    works_in = base / surroundings.works_in
    works_in.mkdir(parents=True, exist_ok=True)
    if surroundings.is_read_only:
        for path in [*raw.rglob("*"), raw]:
            os.utime(path, (86400, 86400))
            path.chmod(0o555 if path.is_dir() else 0o444)
    variables = dict(os.environ) | dict(environment or {})
    for name, value in surroundings.changed.items():
        variables.pop(name, None)
        if value is not None:
            variables[name] = value
    command = [
        str(python), *surroundings.python_options, "-m", "reduction", "run",
        os.path.relpath(raw / "campaign.toml", works_in),
        "--processed", os.path.relpath(base / "made" / "processed", works_in),
        "--reports", os.path.relpath(base / "made" / "reports", works_in),
        *surroundings.options,
    ]  # fmt: skip
    done = subprocess.run(
        command, cwd=works_in, env=variables, capture_output=True, check=False,
        umask=surroundings.umask, preexec_fn=_only(surroundings.processors),
    )  # fmt: skip
    if done.returncode:
        raise RuntimeError(f"{surroundings.name}: {done.returncode}\n{done.stderr[-3000:]!r}")
    found = products(base / "made")
    for path in [raw, *raw.rglob("*")]:
        path.chmod(0o755 if path.is_dir() else 0o644)
    shutil.rmtree(scratch / Path(surroundings.folder).parts[0])
    return found


def _only(processors: int | None) -> Callable[[], None] | None:
    """What a child does first, where it may not use all processors."""
    if processors is None or not hasattr(os, "sched_setaffinity"):
        return None
    chosen = sorted(os.sched_getaffinity(0))[:processors]
    return lambda: os.sched_setaffinity(0, chosen)


def main(campaigns: Sequence[Path], python: Path, only: str | None) -> int:
    """Print a line for each run; give the exit status."""
    chosen = [one for one in SURROUNDINGS if only is None or only in one.name]
    named = [one.changed.get("LC_ALL") or "" for one in chosen]
    is_bad = False
    with tempfile.TemporaryDirectory() as name:
        scratch = Path(name)
        found = locales([one for one in named if "." in one], scratch / "locales")
        for campaign in campaigns:
            start = time.perf_counter()
            first = run(campaign, SURROUNDINGS[0], scratch, python=python, environment=found)
            print(f"{campaign.name}: {len(first)} files, {time.perf_counter() - start:.1f} s")
            for one in chosen:
                own = run(campaign, one, scratch, python=python, environment=found)
                other = differences(first, own)
                is_bad |= bool(other)
                print(f"  {one.name}: {', '.join(other) or 'same bytes'}", flush=True)
    return int(is_bad)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("campaign", nargs="*", type=Path)
    parser.add_argument("--python", type=Path, default=Path(sys.executable))
    parser.add_argument("--only")
    given = parser.parse_args()
    folders = given.campaign or sorted(path.parent for path in RAW.glob("*/campaign.toml"))
    sys.exit(main([one.absolute() for one in folders], given.python.absolute(), given.only))
