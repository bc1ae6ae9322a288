"""The products of campaigns by other releases of Python and of the libraries, number by number.

    python benchmarks/between_versions.py PYTHON [PYTHON ...] [--campaign CAMPAIGN ...]
        [--set NAME=VALUE ...] [--within 1e-12] [--most 12]

Each interpreter is one of an environment with the libraries in it; the package is that of this
checkout.  Every campaign of raw/, or each that is named, is run by each of them, and all archives
and tables are held against those of the first.  Texts, integers, flags and which numbers are
missing have to be equal.  Of numbers the largest differences are printed, over the number itself
and over the largest of its variable (a number that is what is left of two large ones has no more
digits than they have); the exit status is 1 where one differs by more than ``--within`` of the
largest.  ``--set`` adds a run by the first interpreter with a variable of the environment, such as
``OPENBLAS_CORETYPE=Haswell`` or ``NPY_DISABLE_CPU_FEATURES="AVX512F AVX2"``: what another
processor does.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import netCDF4
import numpy as np

__all__ = ["Difference", "compared", "differences", "differences_of_archives", "run"]

ROOT = Path(__file__).parents[1]
_OF_FILES = ("raw_file_sha256", "raw_file_bytes")
SAID = """
import importlib.metadata as m, platform
print("Python", platform.python_version(), *(
    f"{name} {m.version(name)}" for name in ("numpy", "scipy", "pandas", "xarray", "netCDF4")
), sep=", ")
"""


@dataclass(frozen=True, kw_only=True)
class Difference:
    """What is not the same in two runs.

    ``relative`` is over the number itself and ``of_largest`` over the largest number of its
    variable; both are infinite where the two are not to be called the same at all.
    """

    where: str
    relative: float = float("inf")
    of_largest: float = float("inf")
    said: str = ""


def differences_of_archives(one: Path, other: Path) -> Iterator[Difference]:
    """Every variable and attribute of two archives that is not the same in both."""
    with netCDF4.Dataset(one) as first, netCDF4.Dataset(other) as second:
        for file in (first, second):
            file.set_auto_mask(False)
        yield from _attributes(one.name, first, second)
        own, its = _variables(first), _variables(second)
        if list(own) != list(its):
            yield Difference(where=one.name, said=f"variables {sorted(set(own) ^ set(its))}")
        for name in own:
            if name in its:
                where = f"{one.name}:{name.rpartition('/')[2]}"
                yield from _attributes(where, own[name], its[name])
                yield from compared(where, own[name][...], its[name][...])


def _variables(file: netCDF4.Dataset) -> dict[str, netCDF4.Variable[Any]]:
    """Variables of the root and of the groups, by their paths."""
    inside = {
        f"{group}/{name}": variable
        for group, held in file.groups.items()
        for name, variable in held.variables.items()
    }
    return {**file.variables, **inside}


def _attributes(where: str, first: Any, second: Any) -> Iterator[Difference]:
    for name in sorted({*first.ncattrs(), *second.ncattrs()}):
        one, other = (getattr(file, name, None) for file in (first, second))
        place = f"{where}@{name}"
        if name in _OF_FILES and one is not None and other is not None:
            one, other = (_of_raw_files(file, name) for file in (first, second))
        if isinstance(one, str) and one.startswith("{") and isinstance(other, str):
            yield from _documents(place, json.loads(one), json.loads(other))
        elif isinstance(one, (np.ndarray, np.number)) and other is not None:
            yield from compared(place, np.asarray(one), np.asarray(other))
        elif one != other:
            yield Difference(where=place, said=f"{one!r:.200} and {other!r:.200}")


def _of_raw_files(file: Any, name: str) -> str:
    """Hashes or sizes of raw files: those of archives from which one was made differ with them."""
    pairs = zip(file.raw_file.split("\n"), getattr(file, name).split("\n"), strict=True)
    return "\n".join(said for raw, said in pairs if not raw.endswith(".nc"))


def _documents(where: str, one: Any, other: Any) -> Iterator[Difference]:
    """Two documents of JSON."""
    if isinstance(one, dict) and isinstance(other, dict) and one.keys() == other.keys():
        for name, value in one.items():
            yield from _documents(f"{where}.{name}", value, other[name])
    elif isinstance(one, list) and isinstance(other, list) and len(one) == len(other):
        for number, (value, its) in enumerate(zip(one, other, strict=True)):
            yield from _documents(f"{where}.{number}", value, its)
    elif isinstance(one, float) and isinstance(other, float):
        yield from compared(where, np.asarray(one), np.asarray(other))
    elif one != other:
        yield Difference(where=where, said=f"{one!r:.200} and {other!r:.200}")


def compared(where: str, one: Any, other: Any) -> Iterator[Difference]:
    """Two arrays: nothing where they are the same."""
    if one.shape != other.shape or one.dtype != other.dtype:
        said = f"{one.dtype} {one.shape} and {other.dtype} {other.shape}"
        yield Difference(where=where, said=said)
        return
    if one.dtype.kind not in "fc":
        unlike = one != other
        if np.any(unlike):
            first, second = one[unlike].flat[0], other[unlike].flat[0]
            said = f"{np.count_nonzero(unlike)} of {one.size}, first {first!r} and {second!r}"
            yield Difference(where=where, said=said)
        return
    if not np.array_equal(np.isfinite(one), np.isfinite(other)):
        yield Difference(where=where, said="numbers are missing at other places")
        return
    is_number = np.isfinite(one)
    a, b = one[is_number], other[is_number]
    gap = np.abs(a - b)
    if not np.any(gap):
        return
    size = np.maximum(np.abs(a), np.abs(b))
    own = np.divide(gap, size, out=np.zeros_like(gap), where=size > 0)
    worst = int(np.argmax(own))
    yield Difference(
        where=where,
        relative=float(own[worst]),
        of_largest=float(np.max(gap) / np.max(size)),
        said=f"{float(a[worst])!r} and {float(b[worst])!r}",
    )


def run(python: Path, campaign: Path, folder: Path, **variables: str) -> Path:
    """Run a campaign by one interpreter; the folder of its products.

    Raises
    ------
    RuntimeError
        If the command fails.
    """
    done = subprocess.run(
        [str(python), "-m", "reduction", "run", str(campaign / "campaign.toml"), "--quiet",
         "--processed", str(folder / "processed"), "--reports", str(folder / "reports")],
        env=os.environ | {"PYTHONPATH": str(ROOT)} | variables, capture_output=True, text=True,
        check=False,
    )  # fmt: skip
    if done.returncode:
        raise RuntimeError(f"{python} {variables}: {done.returncode}\n{done.stderr[-3000:]}")
    return folder / "processed" / campaign.name


def differences(one: Path, other: Path) -> list[Difference]:
    """All of the archives of two folders, those first that are no numbers, then the largest."""
    names = [{path.name for path in folder.glob("*.nc")} for folder in (one, other)]
    found = [Difference(where=name, said="in one alone") for name in names[0] ^ names[1]]
    for name in sorted(names[0] & names[1]):
        found += differences_of_archives(one / name, other / name)
    return sorted(found, key=lambda difference: -difference.of_largest)


def worst_of_each(found: Sequence[Difference]) -> list[Difference]:
    """Of each variable, whatever archive it is in, the largest difference."""
    kept: dict[str, Difference] = {}
    for one in found:
        kept.setdefault(one.where.partition(":")[2] or one.where, one)
    return list(kept.values())


def main(
    pythons: Sequence[Path],
    campaigns: Sequence[Path],
    settings: Sequence[str],
    *,
    within: float,
    most: int,
) -> int:
    """Print what differs, most of all first; give the exit status."""
    sides: list[tuple[str, Path, dict[str, str]]] = []
    for python in pythons:
        said = subprocess.run([str(python), "-c", SAID], capture_output=True, text=True, check=True)
        sides.append((said.stdout.strip().replace(",", "", 1), python, {}))
    for setting in settings:
        name, _, value = setting.partition("=")
        sides.append((setting, pythons[0], {name: value}))
    is_bad = False
    for campaign in campaigns:
        with tempfile.TemporaryDirectory() as name:
            scratch = Path(name)
            print(f"{campaign.name}, against {sides[0][0]}", flush=True)
            base = run(pythons[0], campaign, scratch / "0")
            for number, (words, python, variables) in enumerate(sides[1:], start=1):
                own = run(python, campaign, scratch / str(number), **variables)
                found = worst_of_each(differences(base, own))
                beyond = [one for one in found if one.of_largest > within]
                is_bad |= bool(beyond)
                print(f"  {words}: {len(found)} variables differ, {len(beyond)} by more")
                for one in (beyond or found)[:most]:
                    print(f"    {one.relative:.1e} {one.of_largest:.1e} {one.where}: {one.said}")
                sys.stdout.flush()
    return int(is_bad)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("python", nargs="+", type=Path)
    parser.add_argument("--campaign", nargs="+", type=Path)
    parser.add_argument("--set", nargs="+", default=[])
    parser.add_argument("--within", type=float, default=1e-12)
    parser.add_argument("--most", type=int, default=12)
    given = parser.parse_args()
    folders = given.campaign or sorted(path.parent for path in (ROOT / "raw").glob("*/*.toml"))
    sys.exit(
        main(
            [one.absolute() for one in given.python], folders, given.set, within=given.within,
            most=given.most,
        )
    )  # fmt: skip
