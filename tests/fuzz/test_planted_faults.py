"""The rule itself: faults planted in the package are seen, each by the rule that is meant for it."""

from dataclasses import replace

import pytest
from fuzzcases import CASES, GOOD
from invariant import InvariantError, judge

from reduction.readers import delimited
from reduction.readers import read_log as record_of_test
from reduction.readers import record_in_si as piece
from reduction.record.errors import LogError
from reduction.stages.cycles import loops


def log_of(name, **changes):
    case = CASES[name]
    return case, case.files | {case.log: case.make_log(replace(GOOD, **changes))}


@pytest.fixture
def plant(monkeypatch):
    """Put a function of another making in the place of one; the good answers are made before."""

    def put(case, module, name, make):
        assert judge(case, case.files, "harmless") == "as before"
        monkeypatch.setattr(module, name, make(getattr(module, name)))

    return put


def test_a_bad_row_that_is_skipped_is_seen(plant, tmp_path):
    def skipping(read_log):
        def read(path, layout, **options):
            try:
                return read_log(path, layout, **options)
            except LogError as error:
                lines = path.read_bytes().split(b"\n")
                (tmp_path / "A.csv").write_bytes(
                    b"\n".join(lines[: error.row - 1] + lines[error.row :])
                )
                return read_log(tmp_path / "A.csv", layout, **options)

        return read

    case = CASES["delimited"]
    files = case.files | {"A.csv": case.files["A.csv"].replace(b"\n10.00,", b"\nx,", 1)}
    assert judge(case, files, "another log") == "refused"
    plant(case, record_of_test, "read_log", skipping)
    with pytest.raises(InvariantError, match="a product of files that say nothing"):
        judge(case, files, "another log")


def test_a_unit_row_that_is_not_compared_is_seen(plant):
    case, files = log_of("delimited", units=("s", "ft", "N"))
    assert judge(case, files, "fault") == "refused"
    plant(case, delimited, "check_units", lambda _: lambda *args, **options: None)
    with pytest.raises(InvariantError, match="a fault of the file is neither refused nor flagged"):
        judge(case, files, "fault")


def test_a_unit_of_the_layout_that_is_ignored_is_seen(plant):
    case = CASES["matlab"]
    toml = case.files["campaign.toml"].replace(b'unit = "N"', b'unit = "kN"')
    files = case.files | {"campaign.toml": toml}
    judge(case, files, "another log")

    def in_newton(scale):
        return lambda channel, dimension: scale(
            channel.model_copy(update={"unit": "N"}) if dimension == "force" else channel, dimension
        )

    plant(case, piece, "_scale", in_newton)
    with pytest.raises(InvariantError, match="tension: 420 values differ"):
        judge(case, files, "another log")


def test_a_number_of_the_cycles_that_the_samples_do_not_give_is_seen(plant):
    values = GOOD.values.copy()
    values[2, 150] += 1.0
    case, files = log_of("parquet", values=values)
    assert judge(case, files, "another log") == "another log"

    def too_high(quantities):
        def of_cycles(*args, **options):
            numbers, uncertainty = quantities(*args, **options)
            return numbers | {"peak_tension": numbers["peak_tension"] + 30.0}, uncertainty

        return of_cycles

    plant(case, loops, "_quantities_of_cycles", too_high)
    with pytest.raises(InvariantError, match="peak_tension: 6 values differ"):
        judge(case, files, "another log")
