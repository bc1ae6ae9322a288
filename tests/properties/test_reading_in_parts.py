"""What holds for every log (synthetic here): no number, row, note or error depends on the parts
that it is read in."""

import h5py
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from examples import examples
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from nptdms import ChannelObject, TdmsWriter

from reduction.readers.layout import Layout, LogParts
from reduction.readers.read_log import read_log
from reduction.record.errors import LogError

IN_TMP = settings(
    max_examples=examples(40),
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
TEXT = {
    "time": {"column": "t", "unit": "s"},
    "crosshead_position": {"column": "x", "unit": "mm", "datum": "pin-to-pin"},
    "tension.1": {"column": "F", "unit": "kN"},
}
BINARY = {key: TEXT[key] for key in ("time", "tension.1")}
LENGTHS = st.lists(st.integers(1, 400), min_size=1, max_size=3)
ENCODINGS = st.sampled_from(
    ["utf-8", "utf-8-sig", "latin-1", "cp1252", "utf-16", "utf-16-le", "utf-32", "cp037"]
)
ENDS = st.sampled_from(["\n", "\r\n", "\r"])
NUMBERS = st.sampled_from(["1.5", "-0.25", "1e3", "+7", " 2.5 ", '"3.5"', "-9999", "NaN", "", "12"])
ODD = st.sampled_from(["x", "inf", '"3', "nan1", "é", "1e999", 'a"b', "--", "1,2"])


def outcome(path, layout, parts=None):
    """All that a reader says of a file: its log to the last bit, or its error."""
    try:
        log = read_log(path, layout, name="log", parts=parts)
    except LogError as error:
        return str(error)
    return (
        {key: values.tobytes() for key, values in log.columns.items()},
        (log.first_row, None if log.row is None else log.row.tolist(), log.n_rows_read),
        (log.source, log.text, log.notes, list(log.metadata.items())),
    )


def check(path, layout, lengths):
    whole = outcome(path, layout)
    for n_bytes in (1, *lengths):
        for in_memory in (0, 1 << 20):
            parts = LogParts(in_memory=in_memory, n_bytes=n_bytes, folder=path.parent)
            assert outcome(path, layout, parts) == whole


@st.composite
def delimited_texts(draw):
    """A text log with all that may stand in one, and sometimes with what may not."""
    is_bad = draw(st.booleans())
    preamble = draw(
        st.lists(st.sampled_from(["Prüfer,Käthe", "", "free text", "# c", "a: b"]), max_size=4)
    )
    between = st.sampled_from(["", "  ", "# größer", "#", "\t ", "# a,b,c"])
    lines = [*preamble, "t,x,F"]
    for number in range(draw(st.integers(0, 12))):
        lines += draw(st.lists(between, max_size=1))
        fields = [f"{number / 10}", draw(NUMBERS), draw(NUMBERS)]
        if is_bad and draw(st.integers(0, 9)) == 0:
            fields[draw(st.integers(0, 2))] = draw(ODD)
        lines.append(",".join(fields[: 2 if is_bad and draw(st.integers(0, 19)) == 0 else 3]))
    end = draw(ENDS)
    last = draw(st.sampled_from(["", end, end * 3, f"{end}\x1a", f"{end}  {end}", f"{end}# end"]))
    return len(preamble), end.join(lines) + last


@IN_TMP
@given(
    text=delimited_texts(),
    encoding=ENCODINGS,
    comment=st.sampled_from(["", "#"]),
    thousands=st.sampled_from(["", "'"]),
    damage=st.none() | st.tuples(st.integers(0, 300), st.sampled_from([0, 0x81, 0xE9, 0xFF])),
    lengths=LENGTHS,
)
def test_delimited_text_reads_the_same_in_parts(
    tmp_path, text, encoding, comment, thousands, damage, lengths
):
    preamble_rows, content = text
    data = bytearray(content.encode(encoding, "replace"))
    if damage is not None and damage[0] < len(data):
        data[damage[0]] = damage[1]
    path = tmp_path / "log.csv"
    path.write_bytes(data)
    layout = Layout(
        format="delimited", channels=TEXT, encoding=encoding, comment=comment,
        thousands=thousands, preamble_rows=preamble_rows, missing=("", "NaN", "-9999"),
    )  # fmt: skip
    check(path, layout, lengths)


@st.composite
def block_texts(draw, *, has_unit_row):
    """Blocks of two kinds with lines between them; now and then a header is cut off."""
    lines = draw(st.sampled_from([[], ["MTS793|MPT|ENU|1|2|.|/|:|1|0|0|A"]]))
    loose = st.sampled_from(["", "Operator\tKäthe", "free", "Paused at 12:00", "  ", "Data cut"])
    for number in range(draw(st.integers(1, 5))):
        is_other = draw(st.booleans())
        lines = [*lines, *draw(st.lists(loose, max_size=2)), f"Data Acquisition\t{number}"]
        lines.append("Count\tPeak" if is_other else "t\tx\tF")
        if has_unit_row:
            lines.append("cycles\tkN" if is_other else "Sec\tmm\tkN")
        for place in range(draw(st.integers(0, 5))):
            value = draw(st.sampled_from(["1.5", "-2", "NaN", "", "1.5", "-2", "odd"]))
            lines.append(f"{place}\t{value}" if is_other else f"{number}.{place}\t0.5\t{value}")
    lines += draw(st.sampled_from([[], ["Data Acquisition end"], ["Data Acquisition end", "t\tx"]]))
    return draw(ENDS).join([*lines, *draw(st.sampled_from([[], [""], ["", "", ""]]))])


@IN_TMP
@given(has_unit_row=st.booleans(), encoding=ENCODINGS, lengths=LENGTHS, data=st.data())
def test_blocks_read_the_same_in_parts(tmp_path, has_unit_row, encoding, lengths, data):
    path = tmp_path / "log.dat"
    text = data.draw(block_texts(has_unit_row=has_unit_row))
    path.write_bytes(text.encode(encoding, "replace"))
    layout = Layout(
        format="blocks", delimiter="\t", has_unit_row=has_unit_row, block_marker="Data",
        encoding=encoding, channels=TEXT,
    )  # fmt: skip
    check(path, layout, lengths)


@st.composite
def columns(draw):
    """Time and tension, which may hold what a log may not."""
    size = draw(st.integers(0, 40))
    kind = draw(st.sampled_from(["f8", "f4", "i4", "i8"]))
    load = np.array(draw(st.lists(st.integers(-99, 99), min_size=size, max_size=size))).astype(kind)
    odd = {"f": [np.nan, np.inf, -99.9], "i": [2**60, 7]}[kind[0]] if kind != "i4" else [7]
    for place in draw(st.lists(st.integers(0, 39), max_size=3)):
        if place < size:
            load[place] = draw(st.sampled_from(odd))
    return np.arange(size) * 0.1, load


MISSING = st.sampled_from([("", "NaN"), ("",), ("NaN", "-99.9", "7")])


@IN_TMP
@given(
    log=columns(), missing=MISSING, cuts=st.sets(st.integers(0, 40)), wave=st.booleans(),
    lengths=LENGTHS,
)  # fmt: skip
def test_tdms_reads_the_same_in_parts(tmp_path, log, missing, cuts, wave, lengths):
    time, load = log
    path = tmp_path / "log.tdms"
    properties = {"wf_increment": 0.1, "wf_start_offset": 0.5} if wave else {}
    edges = sorted({0, load.size, *(cut for cut in cuts if cut < load.size)})
    with TdmsWriter(path) as writer:
        for start, stop in zip(edges, [*edges[1:], load.size], strict=True):
            part = slice(start, stop)
            writer.write_segment(
                [
                    ChannelObject("g", "F", load[part], properties),
                    ChannelObject("g", "t", time[part]),
                ]
            )
    channels = BINARY | {"time": {"column": "wf_increment" if wave else "t", "unit": "s"}}
    check(path, Layout(format="tdms", channels=channels, missing=missing), lengths)


@IN_TMP
@given(
    log=columns(), missing=MISSING, chunk=st.none() | st.integers(1, 50), lengths=LENGTHS,
    form=st.sampled_from(["columns", "wide columns", "matrix", "records"]),
)  # fmt: skip
def test_hdf5_reads_the_same_in_parts(tmp_path, log, missing, chunk, lengths, form):
    time, load = log
    path = tmp_path / "log.h5"
    together = {} if chunk is None or not load.size else {"chunks": min(chunk, load.size)}
    with h5py.File(path, "w") as file:
        if form == "matrix":
            if together:
                together["chunks"] = (together["chunks"], 1)
            file.create_dataset("m", data=np.column_stack([time, load.astype(float)]), **together)
            file["n"] = ["t", "F"]
        elif form == "records":
            records = np.zeros(load.size, dtype=[("t", "f8"), ("F", load.dtype)])
            records["t"], records["F"] = time, load
            file.create_dataset("m", data=records, **together)
        else:
            file.create_dataset("t", data=time, **together)
            file.create_dataset("F", data=load if form == "columns" else load.reshape(1, -1))
    names = {"matrix": {"matrix": "m", "matrix_names": "n"}, "records": {"matrix": "m"}}
    layout = Layout(format="hdf5", channels=BINARY, missing=missing, **names.get(form, {}))
    check(path, layout, lengths)


@IN_TMP
@given(
    log=columns(), missing=MISSING, group=st.integers(1, 50), lengths=LENGTHS,
    nulls=st.sets(st.integers(0, 39), max_size=3),
)  # fmt: skip
def test_parquet_reads_the_same_in_parts(tmp_path, log, missing, group, lengths, nulls):
    time, load = log
    path = tmp_path / "log.parquet"
    values = [None if place in nulls else value for place, value in enumerate(load.tolist())]
    array = pa.array(values, pa.from_numpy_dtype(load.dtype))
    pq.write_table(pa.table({"t": time, "F": array}), path, row_group_size=group)
    check(path, Layout(format="parquet", channels=BINARY, missing=missing), lengths)
