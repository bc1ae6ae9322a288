"""The invariant of a run over any input, and what it says of a mutated campaign.

A run ends with an exit status of the list and a message, or with a product; never with an
exception that is not ours, after the deadline, above the memory, or with numbers that are wrong
and not flagged.  docs/adr/0026 says what *wrong* means; `judge` is that rule.
"""

import os
import re
import signal
import time
import warnings
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Literal

import numpy as np
from fuzzcases import CASES
from secondreading import read_again
from secondreduction import numbers_that_differ, readings_that_differ

from reduction.batch.reduce_tests import dataset_of
from reduction.batch.reuse import basis_of
from reduction.batch.survey import _read_test
from reduction.batch.test_history import earlier_tests_of, fit_strain_models
from reduction.campaign.load import load_campaign
from reduction.record.errors import ReductionError

__all__ = ["InvariantError", "Verdict", "answer_of", "judge"]

STATUSES = (2, 3, 4, 5, 6)
DEADLINE = 30.0  # s; an answer takes 0.1 s, and longer on a machine that has other work
READING = 10.0  # s, after which a library that never ends is ended
MEMORY = 300e6  # bytes above those of the process; with its packages that is below 600 MB

Expected = Literal["harmless", "fault", "another log"]
Verdict = Literal["refused", "as before", "flagged", "another log"]


class InvariantError(AssertionError):
    """The invariant does not hold."""


class Hang(BaseException):
    """Nothing in between may catch it."""


@dataclass
class Answer:
    """What became of a folder: a refusal, or the product of its one test."""

    status: int = 0
    message: str = ""
    dataset: object = None
    notes: frozenset = frozenset()
    outcomes: tuple = ()
    seconds: float = 0.0
    n_bytes: float = 0.0
    facts: dict = field(default_factory=dict)


def _refused(error):
    return Answer(error.exit_status, str(error))


def _product(campaign):
    """The stages of a run, one test after another, up to what would be written."""
    name = next(iter(campaign.tests))
    survey = _read_test(campaign, campaign.tests[name])[0]
    if survey.error is not None:
        return _refused(survey.error)
    models, errors = fit_strain_models(campaign, [survey])
    if errors:
        return _refused(next(iter(errors.values())))
    basis = basis_of(campaign, survey, earlier_tests_of([survey], models), pulls={})
    dataset, notes = dataset_of(campaign, survey, basis, command="")
    said = frozenset((one.stage, re.sub(r"[-+]?\d[\d.,e+-]*", "#", str(one))) for one in notes)
    values = tuple(outcome.value for outcome in campaign.outcomes)
    return Answer(dataset=dataset, notes=said, outcomes=values)


def answer_of(campaign_toml):
    """Run a campaign of one test in this process; exceptions that are not ours pass."""
    try:
        campaign = load_campaign(campaign_toml)
        seconds = min(campaign.limits.time, READING)
        return _product(replace(campaign, limits=replace(campaign.limits, time=seconds)))
    except ReductionError as error:
        return _refused(error)


def _hang(signum, frame):
    raise Hang


@contextmanager
def _watched(answer):
    """Deadline and memory of what is done inside, where the system tells them."""
    before = signal.signal(signal.SIGALRM, _hang)
    signal.setitimer(signal.ITIMER_REAL, DEADLINE)
    start, used = time.monotonic(), _peak_memory(reset=True)
    try:
        yield
    except Hang:
        raise InvariantError(f"no answer after {DEADLINE:g} s") from None
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    answer["seconds"] = time.monotonic() - start
    answer["n_bytes"] = _peak_memory() - used


def _peak_memory(*, reset=False):
    """Most memory that the process had since the last reset [bytes]; 0 where nothing tells."""
    status = Path("/proc/self/status")
    if not status.exists():
        return 0.0
    if reset:
        try:
            Path("/proc/self/clear_refs").write_text("5")
        except OSError:
            return 0.0
    text = status.read_text()
    return 1024.0 * float(re.search(r"VmHWM:\s+(\d+)", text)[1])


@cache
def _good(name):
    case = CASES[name]
    with TemporaryDirectory() as folder:
        answer = answer_of(case.write(Path(folder)))
    if answer.status:
        raise InvariantError(f"the good campaign is refused: {answer.message}")
    return answer


def _as_before(dataset, good):
    """Whether every number of a product is that of the good file, to 1e-9."""
    if set(dataset.variables) != set(good.variables):
        return False
    for name, variable in good.variables.items():
        found, wanted = dataset.variables[name].values, variable.values
        if wanted.dtype.kind not in "iuf":
            continue
        if found.shape != wanted.shape:
            return False
        if not np.allclose(found, wanted, rtol=1e-9, atol=1e-300, equal_nan=True):
            return False
    return True


def _flagged(answer, good):
    """Notes and flags that the good file does not have."""
    said = [f"{stage}: {text}" for stage, text in sorted(answer.notes - good.notes)]
    more = answer.dataset["n_flagged"].values > good.dataset["n_flagged"].values
    masks = answer.dataset["quality_mask"].values
    return said + [str(masks[mask]) for mask in np.flatnonzero(more.any(axis=0))]


def judge(case, files, expected: Expected):
    """Hold the answer to mutated files against the rule.

    Parameters
    ----------
    case : Case
        From which the mutation started.
    files : dict of str to bytes
        The folder.
    expected : {"harmless", "fault", "another log"}
        What the mutation is: the same numbers otherwise written; what has to be told; or bytes
        that say something else, which nobody can tell from a measurement.

    Returns
    -------
    verdict : str
        How the invariant holds; `InvariantError` where it does not.
    """
    good, seen = _good(case.name), {}
    with TemporaryDirectory() as folder:
        toml = case.write(Path(folder), files)
        hashes = {name: hash((Path(folder) / name).read_bytes()) for name in files}
        try:
            with _watched(seen), warnings.catch_warnings():
                warnings.simplefilter("error")
                answer = answer_of(toml)
        except Exception as error:
            if isinstance(error, InvariantError):
                raise
            raise InvariantError(f"internal error: {type(error).__name__}: {error}") from error
        if sorted(os.listdir(folder)) != sorted(files) or hashes != {
            name: hash((Path(folder) / name).read_bytes()) for name in files
        }:
            raise InvariantError("the folder of the campaign is not what it was")
    if seen["n_bytes"] > MEMORY:
        raise InvariantError(f"{seen['n_bytes'] / 1e6:.0f} MB more than before")
    if answer.status:
        if answer.status not in STATUSES or not answer.message.strip():
            raise InvariantError(f"exit status {answer.status}: {answer.message!r}")
        return "refused"
    return _judge_product(answer, good, files, expected)


def _judge_product(answer, good, files, expected):
    try:
        with np.errstate(all="ignore"):
            reading = read_again(files)
    except Exception as error:
        raise InvariantError(
            f"a product of files that say nothing: {type(error).__name__}: {error}"
        ) from error
    in_order = "sorted by time", "repeated rows", "newest first"
    if any(words in text for _, text in answer.notes for words in in_order):
        reading = reading.in_order()
    if differing := readings_that_differ(reading, answer.dataset):
        raise InvariantError("; ".join(differing))
    if not np.allclose(answer.outcomes, reading.results, rtol=1e-9, equal_nan=True):
        raise InvariantError(f"outcomes {answer.outcomes} for {reading.results}")
    if flags := _flagged(answer, good):
        answer.facts["flags"] = flags
        return "flagged"
    if expected == "fault":
        raise InvariantError("a fault of the file is neither refused nor flagged")
    if _as_before(answer.dataset, good.dataset):
        return "as before"
    if expected == "harmless":
        raise InvariantError("other numbers, of what changes none")
    if differing := numbers_that_differ(reading, answer.dataset):
        raise InvariantError("; ".join(differing))
    return "another log"
