"""What holds for every log: how it is printed must not change what is read."""

from itertools import pairwise

import numpy as np
from examples import examples
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from reduction.readers.delimited import read_delimited
from reduction.readers.layout import Layout
from reduction.readers.record_in_si import _on_common_time, to_record
from reduction.readers.sample_flags import _constant_runs, _time_faults
from reduction.record.settings import QualitySettings

NUMBERS = st.floats(-1e9, 1e9, allow_nan=False, allow_subnormal=False)
ROWS = st.lists(st.tuples(NUMBERS, NUMBERS, NUMBERS), min_size=1, max_size=20)
# lengths are positive, some load is there, and nothing is longer or stronger than 1e9
SOUND = st.lists(
    st.tuples(NUMBERS, st.floats(1e-3, 1e8), st.floats(1e-3, 1e8)), min_size=1, max_size=20
)
IN_TMP = settings(
    max_examples=examples(60),
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
NAMES = ("t", "x", "F")
KEYS = ("time", "crosshead_position", "tension.1")


def channels(units=("s", "m", "N")):
    made = {key: {"column": c, "unit": u} for key, c, u in zip(KEYS, NAMES, units, strict=True)}
    made["crosshead_position"]["datum"] = "pin-to-pin"
    return made


def printed(value, decimal, thousands):
    whole, _, rest = f"{value:,.6f}".partition(".")
    return whole.replace(",", thousands) + decimal + rest


@IN_TMP
@given(
    rows=ROWS,
    order=st.permutations(range(3)),
    marks=st.sampled_from([(".", "", ","), (",", ".", ";"), (",", " ", "\t"), (".", ",", ";")]),
    end=st.sampled_from(["\n", "\r\n", "\r"]),
    encoding=st.sampled_from(["utf-8", "utf-8-sig", "latin-1", "utf-16"]),
    quoted=st.booleans(),
    trailing=st.booleans(),
    comment_at=st.integers(0, 20),
)
def test_a_log_reads_the_same_however_it_is_printed(
    tmp_path, rows, order, marks, end, encoding, quoted, trailing, comment_at
):
    decimal, thousands, delimiter = marks
    lines = [delimiter.join(NAMES[place] for place in order)]
    for row in rows:
        fields = [printed(row[place], decimal, thousands) for place in order]
        lines.append(delimiter.join(f'"{text}"' if quoted else text for text in fields))
    lines = [line + delimiter * trailing for line in lines]
    lines.insert(min(comment_at, len(lines)), "# größer")
    path = tmp_path / "log.csv"
    path.write_bytes((end.join(lines) + end).encode(encoding))
    layout = Layout(
        format="delimited", delimiter=delimiter, decimal=decimal, thousands=thousands,
        encoding=encoding, comment="#", channels=channels(),
    )  # fmt: skip
    log = read_delimited(path, layout, name="log.csv")
    expected = np.array([[float(f"{value:.6f}") for value in row] for row in rows])
    for key, column in zip(KEYS, expected.T, strict=True):
        np.testing.assert_array_equal(log.columns[key], column)
    assert "größer" in log.metadata.values()


@IN_TMP
@given(rows=SOUND, feet=st.booleans(), pounds=st.booleans())
def test_units_change_nothing_but_the_last_digit(tmp_path, rows, feet, pounds):
    length, force = (
        ("ft", 0.3048) if feet else ("m", 1.0),
        ("lbf", 4.4482216152605) if pounds else ("N", 1.0),
    )
    path = tmp_path / "log.csv"
    text = [f"{i},{row[1] / length[1]!r},{row[2] / force[1]!r}" for i, row in enumerate(rows)]
    path.write_text("\n".join(["t,x,F", *text]))
    layout = Layout(format="delimited", channels=channels(("s", length[0], force[0])))
    record = to_record(
        [(read_delimited(path, layout, name="x"), layout)],
        test_id="T", specimens=["one"], quality=QualitySettings(),
    )  # fmt: skip
    np.testing.assert_allclose(
        record.crosshead_position, [row[1] for row in rows], rtol=1e-14, atol=1e-290
    )
    np.testing.assert_allclose(record.tension[0], [row[2] for row in rows], rtol=1e-14, atol=1e-290)


@given(
    values=st.lists(st.integers(0, 2), min_size=1, max_size=200).map(lambda v: np.array(v, float)),
    minimum=st.integers(2, 12),
)
def test_runs_cover_exactly_the_samples_that_repeat(values, minimum):
    mask = _constant_runs(values, minimum).mask(values)
    edges = np.r_[0, np.flatnonzero(np.diff(values)) + 1, values.size]
    expected = np.zeros(values.size, dtype=bool)
    for start, stop in pairwise(edges):
        expected[start:stop] = stop - start >= minimum
    assert np.array_equal(mask, expected)


@given(st.lists(st.floats(0, 100), min_size=2, max_size=100).map(np.array))
def test_backward_samples_are_those_not_above_all_before_them(time):
    expected = np.r_[False, time[1:] <= np.maximum.accumulate(time)[:-1]]
    timing = _time_faults(time, gap_factor=3.5, rate_tolerance=0.2)
    assert np.array_equal(timing.backward, expected)
    assert not np.any(timing.gap & timing.backward)


@given(
    slope=st.floats(-1e3, 1e3),
    offset=st.floats(-1e3, 1e3),
    rate=st.floats(1.1, 50.0),
    lag=st.floats(0, 1),
)
def test_a_straight_line_survives_resampling(slope, offset, rate, lag):
    slow = np.arange(0, 20, 1.0) + lag
    fast = np.arange(0, 22, 1.0 / rate)
    values = {"crosshead_position": slope * fast + offset, "tension.1": slow}
    result = _on_common_time(
        fast, values, {"tension.1": slow}, quality=QualitySettings(gap_factor=3.5)
    )
    found = result.values["crosshead_position"]
    known = np.isfinite(found)
    assert known.sum() >= 19
    np.testing.assert_allclose(found[known], (slope * slow + offset)[known], atol=1e-8)
