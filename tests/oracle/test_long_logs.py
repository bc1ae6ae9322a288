"""A log that lies on disk gives the numbers of one in memory, in memory that does not grow."""

import dataclasses
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from reduction.batch.reduce_tests import _reduce_survey
from reduction.batch.survey import survey_log
from reduction.batch.test_history import fit_strain_models
from reduction.campaign.load import load_campaign
from reduction.readers import sample_flags as constant
from reduction.readers.layout import LogParts
from reduction.record import samples as blocks
from reduction.record import samples as intervals
from reduction.record import samples as scratch
from reduction.record import samples as search
from reduction.stages import standstills as still_blocks
from reduction.stages.cycles import cycle_pairing as runs
from reduction.stages.holds import relaxation_and_creep
from reduction.stages.moduli import loop_balance as tensionlevel

pytestmark = pytest.mark.slow

RAW = Path(__file__).parents[2] / "raw"
BENCHMARKS = Path(__file__).parents[2] / "benchmarks"
# of each kind: cycles of a tether, a pull, a hold
TESTS = (
    ("tmt-synthetic", "T-1"),
    ("tmt-synthetic", "overnight-hold"),
    ("hose-synthetic", "B-64"),
)
# and a long test, cycles of a sine and of a hose, more pulls
MORE_TESTS = (
    ("tmt-synthetic", "T-4-extended"),
    ("nylon-synthetic", "R01"),
    ("nylon-synthetic", "Q01"),
    ("hose-synthetic", "L-64"),
    ("hose-synthetic", "D-64"),
)


def with_size(size, larger):
    """Every test with a size that cuts it often; nightly more tests, and a larger size."""
    nightly = [(*one, size) for one in MORE_TESTS]
    nightly += [(*one, larger) for one in (*TESTS, *MORE_TESTS)]
    return [
        *((*one, size) for one in TESTS),
        *(pytest.param(*one, marks=pytest.mark.nightly) for one in nightly),
    ]


def of_test(marks, test):
    kept = [row for row, one in enumerate(marks.test) if one == test]
    rows = {
        field.name: tuple(value[row] for row in kept) if isinstance(value, tuple) else value[kept]
        for field in dataclasses.fields(marks)
        if isinstance(value := getattr(marks, field.name), (tuple, np.ndarray))
    }
    return dataclasses.replace(marks, **rows)


def reduced(campaign, name):
    """The test, with models of its own marks alone where it has any, else of those of T-1."""
    loaded = load_campaign(RAW / campaign / "campaign.toml")
    marks = {
        specimen: of_test(rows, name if name in rows.test else "T-1")
        for specimen, rows in loaded.marks.items()
    }
    loaded = dataclasses.replace(loaded, marks=marks)
    surveys = survey_log(loaded, name)
    for survey in surveys:
        if survey.error is not None:
            raise survey.error
    models, errors = fit_strain_models(loaded, surveys)
    if errors:
        raise next(iter(errors.values()))
    return [
        _reduce_survey(
            loaded, survey, [models[survey.plan.id, one] for one in survey.plan.specimens], None, ""
        )
        for survey in surveys
    ]


def numbers(product, place=""):
    """Every array and number of a product, by where it stands."""
    if dataclasses.is_dataclass(product):
        for item in dataclasses.fields(product):
            yield from numbers(getattr(product, item.name), f"{place}.{item.name}")
    elif isinstance(product, dict):
        for key, value in product.items():
            yield from numbers(value, f"{place}[{key}]")
    elif isinstance(product, (tuple, list)):
        yield f"{place}.length", len(product)
        for number, value in enumerate(product):
            yield from numbers(value, f"{place}[{number}]")
    else:
        yield place, product


def assert_same(found, expected, *, relative=0.0):
    one, other = dict(numbers(found)), dict(numbers(expected))
    assert one.keys() == other.keys()
    for place, value in one.items():
        if isinstance(value, (np.ndarray, float)) and np.asarray(value).dtype.kind == "f":
            wanted = np.asarray(other[place])
            size = np.nanmax(np.abs(wanted), initial=0.0) if np.isfinite(wanted).any() else 0.0
            np.testing.assert_allclose(
                value, wanted, rtol=relative, atol=relative * size, err_msg=place
            )
        elif isinstance(value, np.ndarray):
            np.testing.assert_array_equal(value, other[place], err_msg=place)
        elif relative == 0 or not isinstance(value, str):
            assert value == other[place], place


@pytest.fixture
def on_disk(monkeypatch, tmp_path):
    """Make every log one that is read in parts of some length and lies on disk."""

    def set_up(part):
        monkeypatch.setattr(LogParts, "folder_of", lambda self, n_bytes: tmp_path)
        monkeypatch.setattr(LogParts, "length_of", lambda self, n_bytes: part)
        monkeypatch.setattr(scratch, "_ON_DISK_FROM", 1)

    return set_up


@pytest.mark.parametrize(("campaign", "name", "part"), with_size(4_001, 100_000))
def test_a_log_on_disk_gives_the_numbers_of_one_in_memory(on_disk, campaign, name, part):
    in_memory = reduced(campaign, name)
    assert not any(scratch._is_on_disk(test.record.tension) for test in in_memory)
    on_disk(part)
    found = reduced(campaign, name)
    assert all(scratch._is_on_disk(test.record.tension) for test in found)
    assert all(scratch._is_on_disk(test.strain) for test in found)
    assert_same(found, in_memory)


@pytest.mark.parametrize(("campaign", "name", "length"), with_size(997, 4096))
def test_the_length_of_the_blocks_is_in_no_number(monkeypatch, campaign, name, length):
    expected = reduced(campaign, name)
    cut = (
        blocks, intervals, search, runs, constant, tensionlevel, still_blocks,
        relaxation_and_creep,
    )  # fmt: skip
    for module in cut:
        monkeypatch.setattr(module, "BLOCK", length)
    monkeypatch.setitem(blocks.sample_blocks.__kwdefaults__, "size", length)
    assert_same(reduced(campaign, name), expected, relative=1e-12)


REDUCE = """
import json, resource, sys
from pathlib import Path
sys.path.insert(0, sys.argv[1])
from generate import write_campaign
from reduction.batch.test_history import fit_strain_models
from reduction.batch.reduce_tests import _reduce_survey
from reduction.batch.survey import survey_log
from reduction.campaign.load import load_campaign
from reduction.readers.layout import LogParts
LogParts.folder_of = lambda self, n_bytes: self.folder
LogParts.length_of = lambda self, n_bytes: 1 << 22
campaign = load_campaign(write_campaign(Path(sys.argv[2]), n_rows=int(sys.argv[3])))
[survey] = survey_log(campaign, "long")
models, _ = fit_strain_models(campaign, [survey])
test = _reduce_survey(
    campaign, survey, [models["long", name] for name in survey.plan.specimens], None, "{}"
)
peak = [line.split()[1] for line in open("/proc/self/status") if line.startswith("VmHWM")]
print(json.dumps({"peak": int(peak[0]) / 1024, "cycles": test.cycles.n_cycles}))
"""


@pytest.mark.nightly
@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="no /proc to read the peak from")
def test_a_log_four_times_as_long_takes_no_more_memory(tmp_path):
    def peak(n_rows):
        done = subprocess.run(
            [sys.executable, "-c", REDUCE, BENCHMARKS, tmp_path, str(n_rows)],
            capture_output=True, text=True, check=True,
        )  # fmt: skip
        return json.loads(done.stdout)["peak"]

    # 1.2 million rows more are 200 MB more in memory: 160 bytes a row and two specimens
    assert peak(1_600_000) - peak(400_000) < 60


HOLD = """
import sys
from pathlib import Path
import numpy as np
from reduction.stages.holds.relaxation_and_creep import reduce_holds
from reduction.stages.standstills import Standstills
from reduction.record.samples import ColumnWriter
from reduction.record.settings import HoldSettings
n_samples, kind = int(sys.argv[1]), sys.argv[2]
rest = n_samples // 4  # at slack, and as long a ramp; then the hold
columns = [ColumnWriter(Path(sys.argv[3])) for _ in range(4)]
for low in range(0, n_samples, 50_000):
    row = np.arange(low, min(low + 50_000, n_samples))
    since = np.maximum(row / rest - 2, 0)
    missing = np.where(row % 1000 == 3, np.nan, 0.0)
    strain = np.clip(row / rest - 1, 0, 1)
    load = 400 * strain + 0.02 * np.sin(row) + missing
    if kind == "creep":
        strain = strain + 0.01 * np.log1p(9 * since)
    else:
        load = load - 60 * (1 - np.exp(-since / 0.2))
    for column, part in zip(columns, (row / 100, 5 * (1 + strain), load, strain), strict=True):
        column.append(part)
time, position, tension, strain = (column.finish() for column in columns)
first, last = np.array([0, 2 * rest]), np.array([rest, n_samples - 1])
stand = Standstills(
    first, last, time[first], time[last], np.array([5.0, 10.0]), np.array([[0.0, 350.0]]),
    np.array([True, False]), 0.05, 5.0, 1.0 if kind == "creep" else None,
)
[hold] = reduce_holds(
    time, position, tension[None], strain[None], stand, specimens=("synthetic",),
    settings=HoldSettings(), kind=kind,
)
assert np.isfinite(hold.prony_time if kind == "relaxation" else hold.hold_strain).all(), hold
peak = [line.split()[1] for line in open("/proc/self/status") if line.startswith("VmHWM")]
print(int(peak[0]) / 1024)
"""


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="no /proc to read the peak from")
@pytest.mark.parametrize("kind", ["relaxation", pytest.param("creep", marks=pytest.mark.nightly)])
def test_a_hold_six_times_as_long_takes_no_more_memory(tmp_path, kind):
    def peak(n_samples):
        done = subprocess.run(
            [sys.executable, "-c", HOLD, str(n_samples), kind, tmp_path],
            capture_output=True, text=True, check=True,
        )  # fmt: skip
        return float(done.stdout)

    # 2.5 million samples more, all in memory, are 250 MB more
    assert peak(3_000_000) - peak(500_000) < 60
