"""What holds for any outcomes."""

import csv
import io
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from examples import examples
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from reduction.campaign.outcome_results import _read_results
from reduction.experiments.life_statistics import fit_life
from reduction.experiments.outcome_groups import fatigue_rows, strength_rows
from reduction.experiments.outcomes import Outcome
from reduction.experiments.strength_statistics import one_way, ratio_of_means

positive = st.floats(1e-2, 1e6)
spread_lives = st.lists(
    st.tuples(st.floats(1e2, 1e7), st.booleans()), min_size=3, max_size=12
).filter(lambda rows: np.ptp([np.log(life) for life, stopped in rows if not stopped] or [0]) > 0.05)


@settings(max_examples=examples(40), deadline=None)
@given(spread_lives, st.floats(0.01, 100), st.sampled_from(["weibull", "lognormal"]))
def test_lives_in_another_unit_are_the_same_lives(rows, factor, law):
    lives, stopped = map(np.array, zip(*rows, strict=True))
    one = fit_life(lives, stopped, distribution=law)
    other = fit_life(lives * factor, stopped, distribution=law)
    assert other.life == pytest.approx(one.life * factor, rel=1e-5)
    assert other.log_scale == pytest.approx(one.log_scale, rel=1e-5)
    assert other.low == pytest.approx(one.low * factor, rel=1e-4)
    assert one.low < one.life < one.high


@settings(max_examples=examples(40), deadline=None)
@given(spread_lives)
def test_a_test_that_ran_longer_never_shortens_the_median(rows):
    lives, stopped = map(np.array, zip(*rows, strict=True))
    assume(stopped.any())
    longer = np.where(stopped, lives * 1.5, lives)
    assert fit_life(longer, stopped).life >= fit_life(lives, stopped).life * (1 - 1e-9)


@given(
    st.lists(
        st.tuples(positive, st.floats(0.001, 0.2), st.integers(2, 40)), min_size=2, max_size=2
    ),
    st.floats(0.01, 100),
)
def test_a_change_has_no_unit_and_lies_in_its_interval(groups, factor):
    (m1, v1, n1), (m0, v0, n0) = groups
    one, other = (
        ratio_of_means(
            k * m1, k * m1 * v1, n1, reference_mean=k * m0,
            reference_standard_deviation=k * m0 * v0, reference_n=n0,
        )
        for k in (1.0, factor)
    )  # fmt: skip
    assert other.change == pytest.approx(one.change)
    assert (one.reason == 3) == bool(np.isnan(one.low))
    if one.reason == 0:
        assert one.low < one.change < one.high
        assert other.high == pytest.approx(float(one.high), rel=1e-6)


def of_values(groups):
    """One-way F from the values themselves."""
    deviations = [np.std(group, ddof=1) for group in groups]
    return one_way([np.mean(group) for group in groups], deviations, [len(one) for one in groups])


@given(st.lists(st.lists(st.floats(-100, 100), min_size=2, max_size=8), min_size=2, max_size=5))
def test_f_does_not_know_the_order_of_the_groups(groups):
    assume(max(np.ptp(group) for group in groups) > 1e-3)
    one, other = of_values(groups), of_values(groups[::-1])
    assert float(other.f_statistic) == pytest.approx(float(one.f_statistic), rel=1e-6, abs=1e-9)


def test_f_of_two_groups_is_t_squared():
    rng = np.random.default_rng(2)
    from scipy import stats

    first, second = rng.normal(0, 1, 6), rng.normal(1, 2, 9)
    f = float(of_values([first, second]).f_statistic)
    assert f == pytest.approx(stats.ttest_ind(first, second).statistic ** 2)


word = st.text(st.characters(categories=("L", "N")), max_size=6)
outcomes = st.builds(
    Outcome,
    quantity=st.sampled_from(
        ["tensile_strength", "strain_at_failure", "cycles_to_failure", "abrasion_cycles"]
    ),
    value=positive,
    line=word,
    condition=st.sampled_from(["new", "worn"]),
    exposure=st.floats(0, 50),
    peak_load_ratio=st.floats(0.01, 1.0),
    place=st.sampled_from(["free", "splice_toe", "splice", "thimble", "grip", "not_stated"]),
    is_valid=st.booleans(),
    is_suspended=st.booleans(),
    note=word,
)


@settings(max_examples=examples(40), deadline=None)
@given(st.lists(outcomes, min_size=1, max_size=12))
def test_what_is_written_is_read(rows):
    units = {"tensile_strength": "N", "strain_at_failure": "1"}
    text = io.StringIO()
    writer = csv.writer(text)
    writer.writerow(
        ["quantity", "value", "unit", "line", "condition", "exposure_years", "peak_load_pct_RBS",
         "place", "valid", "suspended", "note"]
    )  # fmt: skip
    for row in rows:
        writer.writerow(
            [row.quantity, repr(row.value), units.get(row.quantity, ""), row.line, row.condition,
             repr(row.exposure), repr(100 * row.peak_load_ratio), row.place,
             "yes" if row.is_valid else "no", "yes" if row.is_suspended else "no", row.note]
        )  # fmt: skip
    with TemporaryDirectory() as folder:
        path = Path(folder) / "results.csv"
        path.write_text(text.getvalue(), encoding="utf-8")
        read = _read_results(path)
    assert len(read) == len(rows)
    for one, other in zip(read, rows, strict=True):
        for name in ("quantity", "line", "condition", "place", "is_valid", "is_suspended", "note"):
            assert getattr(one, name) == getattr(other, name)
        for name in ("value", "exposure", "peak_load_ratio"):
            assert getattr(one, name) == pytest.approx(getattr(other, name), rel=1e-12)


@settings(max_examples=examples(40), deadline=None)
@given(st.lists(outcomes, min_size=1, max_size=20))
def test_every_outcome_is_counted_once(rows):
    counted = 0
    for row in strength_rows(rows):
        counted += sum(int(value) for name, value in row.items() if name.endswith("_count"))
    for row in fatigue_rows(rows):
        counted += row["failed_count"] + row["suspended_count"] + row["excluded_count"]
    assert counted == len(rows)
