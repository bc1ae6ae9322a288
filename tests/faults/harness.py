"""Runs that are disturbed, and what may be there afterwards."""

import csv
import hashlib
import io
import json
import re
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from faults.calls import Calls
from shortcampaign import TESTS, write_short

from reduction.archive.csv_tables import write_tables
from reduction.batch.catalogue import FILE_NAME
from reduction.batch.catalogue_entries import write_catalogue
from reduction.pages.design_values import write_design_page
from reduction.report.campaign_page import write_report

VICTIM = Path(__file__).with_name("victim.py")
ROOT = Path(__file__).parents[2]
# of these every number of a specimen is another
OTHER = {"diameter": "1.05 in", "gauge_length": "2.01 ft", "number": "2026-016"}
VERIFY = ("verify", "processed/short", "--campaign", "raw/campaign.toml", "--quiet")
RUN = ("run", "raw/campaign.toml", "--quiet")
STATUSES = (0, 1, 2, 3, 4, 5, 6, 130)
STATES = ("none", "older", "unchanged")


@dataclass(frozen=True)
class Ended:
    """How a run ended, and what it said."""

    status: int
    said: str
    n_calls: int = 0
    n_spoilt: int = 0


class Victim:
    """Runs of the command that can be ended or disturbed at any moment."""

    def __init__(self, folder):
        """Import everything once."""
        self.folder = folder
        folder.mkdir(parents=True, exist_ok=True)
        self.calls = Calls(folder, [])
        warm = folder / "warm"
        write_short(warm / "raw")
        self._process = subprocess.Popen(
            [sys.executable, VICTIM], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
            env=self.calls.environment
            | {"PYTHONPATH": str(ROOT), "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"},
        )  # fmt: skip
        self._tell([RUN, str(warm)])
        assert self._hear() == "ready"

    def _tell(self, what):
        self._process.stdin.write(json.dumps(what) + "\n")
        self._process.stdin.flush()

    def _hear(self):
        return json.loads(self._process.stdout.readline())

    def close(self):
        """End it."""
        self._process.stdin.close()
        self._process.wait()
        self._process.stdout.close()

    def run(
        self, folder, *arguments, meanwhile=None, watched=("processed", "reports", "raw"), **spoilt
    ):
        """Run the command in a folder; ``spoilt`` is what `Calls.arm` takes.

        ``meanwhile`` is called with the number of its process once it has begun; calls count on
        files below the folders ``watched``.
        """
        said = self.folder / "said.txt"
        self.calls.watch([folder / name for name in watched])
        self.calls.arm(**spoilt)
        self._tell(
            {
                "arguments": list(arguments or RUN),
                "folder": str(folder),
                "said": str(said),
            }
        )
        process = self._hear()
        if meanwhile is not None:
            meanwhile(process)
        status = self._hear()
        return Ended(status, said.read_text(errors="replace"), *self.calls.disarm())


def make_states(victim, folder):
    """Folders before a run, one a state, and what is there after an undisturbed one.

    none: no products; older: of other settings, all to be replaced; unchanged: of these settings.
    """
    for state, settings in (("none", {}), ("older", OTHER), ("unchanged", {})):
        write_short(folder / state / "raw", **settings)
        if state != "none":
            ended = victim.run(folder / state)
            assert ended.status == 0, ended.said
    shutil.rmtree(folder / "older" / "raw")
    shutil.copytree(folder / "none" / "raw", folder / "older" / "raw")
    # of equal logs and settings, wherever a run begins
    after = contents(folder / "unchanged")
    return {state: State(folder / state, contents(folder / state), after) for state in STATES}


@dataclass(frozen=True)
class State:
    """Where a disturbed run begins, what is there, and what an undisturbed one leaves."""

    folder: Path
    before: dict
    after: dict


def contents(folder):
    """What each product holds, by its name, but for what the last run says of itself."""
    found = {}
    for root in ("processed", "reports"):
        for path in sorted((folder / root).rglob("*")):
            if path.is_file():
                data = path.read_bytes()
                if path.name == "run.lock" and not data:
                    continue  # given back
                if path.name == "finished-run.json":
                    continue  # digests of what a run left: where it is behind, all is looked at
                if path.name == "status.csv":
                    data = _without_run(data)
                if path.name == "design-values.html":
                    data = re.sub(rb'"state":"[0-9a-f]{64}"', b"", data)
                found[path.relative_to(folder).as_posix()] = hashlib.sha256(data).hexdigest()
    return found


def _without_run(data):
    """status.csv without whether this run, or an earlier one, made an archive."""
    rows = list(csv.reader(io.StringIO(data.decode(), newline="")))
    for row in rows[1:]:
        row[1] = {"unchanged": "stands", "reduced": "stands", "check": "stands"}.get(row[1], row[1])
    return repr(rows).encode()


def is_left_over(name):
    """Whether a file is one that only a run at work has."""
    base = name.rpartition("/")[2]
    return base == "run.lock" or (base.startswith(".") and base != ".campaign")


def faults(state, now, *, made_of=None, may_be_left=False):
    """What is wrong with the products after a disturbed run: nothing, if all is well.

    Parameters
    ----------
    state : State
        Where it began.
    now : dict
        Of `contents`.
    made_of : dict, optional
        What tables and pages hold that are made of the archives as they stand; of a run that went
        on after a test had failed.
    may_be_left : bool
        Whether files of a run at work may be there.
    """
    wrong = []
    for name in sorted({*state.before, *state.after, *now}):
        if is_left_over(name):
            if not may_be_left:
                wrong.append(f"{name} is left over")
        elif now.get(name) not in (state.before.get(name), state.after.get(name)):
            if made_of is None:
                wrong.append(f"{name} is neither the old nor the new one")
            elif now.get(name) != made_of.get(name):
                wrong.append(f"{name} is not made of the archives that are there")
    return wrong


# what a run puts in place, one layer after the other; within one in any order
LAYERS = (
    r"processed/[^/]+/[^/]+\.nc", r"processed/[^/]+/status\.csv", r"processed/[^/]+/report\.json",
    r"processed/[^/]+/tables/[^/]+", r"processed/[^/]+/catalogue\.parquet", r"reports/[^/]+/[^/]+", r"reports/design-values\.html",
)  # fmt: skip


def mixture(state, now):
    """How far the new products go: layers that are old (0), in part (1) and all new (2).

    Of those layers in which anything differs between the old and the new ones.
    """
    found = []
    for layer in LAYERS:
        names = [
            name
            for name in sorted({*state.before, *state.after})
            if re.fullmatch(layer, name) and state.before.get(name) != state.after.get(name)
        ]
        new = sum(now.get(name) == state.after.get(name) for name in names)
        if names:
            found.append(0 if not new else 2 if new == len(names) else 1)
    return tuple(found)


def is_in_order(layers):
    """Whether nothing of a layer is new before all of those before it are."""
    text = "".join(map(str, layers))
    return re.fullmatch("2*1?0*", text) is not None


def failed_tests(folder):
    """Tests that failed in the last run, as status.csv says."""
    path = folder / "processed" / "short" / "status.csv"
    if not path.is_file():
        return []
    rows = csv.DictReader(io.StringIO(path.read_text(), newline=""))
    return [row["test"] for row in rows if row["status"] == "failed"]


def made_of_archives(folder, scratch):
    """What tables and pages hold that are made, undisturbed, of the archives of a folder."""
    shutil.rmtree(scratch, ignore_errors=True)
    shutil.copytree(folder / "processed", scratch / "processed")
    products = scratch / "processed" / "short"
    tests = [products / f"{name}.nc" for name in TESTS]
    shutil.rmtree(products / "tables", ignore_errors=True)
    there = [path for path in tests if path.exists()]
    write_tables(there, products / "tables")
    write_catalogue(there, products / FILE_NAME)
    page = scratch / "reports" / "short"
    write_report(products, page, values_page="../design-values.html")
    write_design_page(scratch / "processed", scratch / "reports")
    return contents(scratch)


def _of_campaign(products):
    """All but the page of all campaigns, which is written when a run has given back its lock."""
    return {name: what for name, what in products.items() if "design-values" not in name}


class Mender:
    """One more run after a disturbed one; one for each state of the folder that came about.

    Of each kind of mixture, `reduction verify` is asked before and after, where that is wanted.
    """

    def __init__(self, victim, *, is_verified):
        self._victim = victim
        self._is_verified = is_verified
        self._known, self._seen = {}, set()

    def faults(self, state, folder, now):
        """What differs from the products of an undisturbed run, after one more run."""
        left = [
            (name.rpartition(".")[2] if is_left_over(name) else name, what)
            for name, what in now.items()
            if not name.endswith("run.lock")
        ]
        key = (state.folder, tuple(sorted(set(left))), any("run.lock" in name for name in now))
        if key not in self._known:
            self._known[key] = self._faults(state, folder, now)
        return self._known[key]

    def _faults(self, state, folder, now):
        wrong = []
        layers = mixture(state, now)
        is_new_kind = self._is_verified and (state.folder, layers) not in self._seen
        self._seen.add((state.folder, layers))
        is_whole = any(
            _of_campaign(now) == _of_campaign(one) for one in (state.before, state.after)
        )
        if not is_whole and is_new_kind and self._victim.run(folder, *VERIFY).status == 0:
            wrong.append("verify finds nothing where products are not of one run")
        ended = self._victim.run(folder)
        if ended.status != 0:
            wrong.append(f"status {ended.status} of one more run: {ended.said}")
        then = contents(folder)
        wrong += [
            f"{name} is not that of an undisturbed run, after one more"
            for name in sorted({*state.after, *then})
            if then.get(name) != state.after.get(name)
        ]
        if is_new_kind and (ended := self._victim.run(folder, *VERIFY)).status != 0:
            wrong.append(f"verify after one more run: {ended.said}")
        return wrong

    @property
    def n_runs(self):
        """How many states came about."""
        return len(self._known)
