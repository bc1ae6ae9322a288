"""TDMS, Parquet and JSON files that mean harm: each is a function that writes one."""

import struct

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from nptdms import ChannelObject, TdmsWriter

N = 30
_COLUMNS = {"t": 0.1 * np.arange(N), "x": 1.0 + 0.01 * np.arange(N), "F": 5.0 + np.arange(N)}
_META, _NEW, _RAW = 2, 4, 8
_DOUBLE, _STRING = 10, 32


def good_tdms(path):
    with TdmsWriter(path) as writer:
        writer.write_segment([ChannelObject("log", n, v) for n, v in _COLUMNS.items()])
    return path


def _text(value):
    value = value.encode() if isinstance(value, str) else value
    return struct.pack("<I", len(value)) + value


def _object(name, count=N, properties=()):
    index = struct.pack("<IIQ", _DOUBLE, 1, count)
    listed = b"".join(properties)
    return (
        _text(f"/'log'/'{name}'")
        + struct.pack("<I", len(index) + 4)
        + index
        + struct.pack("<I", len(properties))
        + listed
    )


def _segment(objects, raw, following=None):
    meta = struct.pack("<I", len(objects)) + b"".join(objects)
    following = len(meta) + len(raw) if following is None else following
    head = struct.pack("<IIQQ", _META | _NEW | _RAW, 4713, following, len(meta))
    return b"TDSm" + head + meta + raw


_DATA = {name: values.astype("<f8").tobytes() for name, values in _COLUMNS.items()}
_TWO = [_object("t"), _object("x")]


def _with(path, force, **segment):
    path.write_bytes(_segment([*_TWO, force], b"".join(_DATA.values()), **segment))
    return path


def tdms_by_hand(path):
    return _with(path, _object("F"))


def tdms_of_more_values_than_bytes(path):
    return _with(path, _object("F", count=10**12))


def tdms_whose_next_segment_is_itself(path):
    return _with(path, _object("F"), following=2**64 - 28)


def tdms_of_one_value_a_chunk(path, count=100_000):
    """Millions of chunks of one value each."""
    objects = [_object(name, count=1) for name in _COLUMNS]
    path.write_bytes(_segment(objects, bytes(24 * count)))
    return path


def tdms_of_scales_in_a_circle(path):
    def number(name, value):
        return _text(name) + struct.pack("<II", 3, value)

    properties = (
        number("NI_Number_Of_Scales", 2),
        _text("NI_Scale[0]_Scale_Type") + struct.pack("<I", _STRING) + _text("Linear"),
        _text("NI_Scale[0]_Linear_Slope") + struct.pack("<Id", _DOUBLE, 2.0),
        _text("NI_Scale[0]_Linear_Y_Intercept") + struct.pack("<Id", _DOUBLE, 0.0),
        number("NI_Scale[0]_Linear_Input_Source", 1),
        _text("NI_Scale[1]_Scale_Type") + struct.pack("<I", _STRING) + _text("Linear"),
        _text("NI_Scale[1]_Linear_Slope") + struct.pack("<Id", _DOUBLE, 2.0),
        _text("NI_Scale[1]_Linear_Y_Intercept") + struct.pack("<Id", _DOUBLE, 0.0),
        number("NI_Scale[1]_Linear_Input_Source", 0),
    )
    return _with(path, _object("F", properties=properties))


def tdms_of_ten_to_the_nine_scales(path):
    properties = (_text("NI_Number_Of_Scales") + struct.pack("<II", 7, 10**9),)
    return _with(path, _object("F", properties=properties))


def tdms_with_an_index_of_its_own(path):
    """A second file beside it that says something else."""
    _with(path, _object("F"))
    path.with_name(path.name + "_index").write_bytes(
        b"TDSh" + struct.pack("<IIQQ", _META | _NEW, 4713, 2**62, 2**62)
    )
    return path


def tdms_of_a_waveform_that_lies(path):
    def number(name, value):
        return _text(name) + struct.pack("<Id", _DOUBLE, value)

    bad = (number("wf_increment", float("nan")), number("wf_start_offset", float("inf")))
    objects = [_object("x", properties=bad), _object("F", properties=bad)]
    path.write_bytes(_segment(objects, _DATA["x"] + _DATA["F"]))
    return path


def good_parquet(path):
    pq.write_table(pa.table(_COLUMNS), path)
    return path


def _footer(path, change):
    """The Thrift footer with some of its bytes changed."""
    data = path.read_bytes()
    size = struct.unpack("<I", data[-8:-4])[0]
    footer = change(data[-8 - size : -8])
    path.write_bytes(data[: -8 - size] + footer + struct.pack("<I", len(footer)) + b"PAR1")
    return path


def parquet_whose_footer_is_nested(path):
    """Structures in structures, a million deep."""
    return _footer(good_parquet(path), lambda footer: b"\x1c" * 1_000_000)


def _varint(value):
    value = (value << 1) ^ (value >> 63)
    out = b""
    while True:
        out += bytes([(value & 0x7F) | (0x80 if value > 0x7F else 0)])
        value >>= 7
        if not value:
            return out


def _rows(path, rows):
    """The footer says another number of rows, in the file and in its groups."""
    old, new = _varint(N), _varint(rows)
    return _footer(good_parquet(path), lambda footer: footer.replace(b"\x16" + old, b"\x16" + new))


def parquet_of_ten_to_the_twelve_rows(path):
    return _rows(path, 10**12)


def parquet_of_fewer_rows_than_stored(path):
    return _rows(path, 3)


def parquet_of_a_dictionary_of_long_texts(path, rows=100_000):
    """Rows that point to one text of 100 kB: 100 GB when they are written out."""
    texts = pa.DictionaryArray.from_arrays(
        pa.array(np.zeros(rows, "i4")), pa.array(["x" * 100_000])
    )
    table = pa.table({"t": np.arange(rows), "x": np.ones(rows), "F": texts})
    pq.write_table(table, path)
    return path


def parquet_of_a_unit_of_no_text(path):
    field = pa.field("F", pa.float64(), metadata={b"unit": b"\xff\xfe"})
    schema = pa.schema([pa.field("t", pa.float64()), pa.field("x", pa.float64()), field])
    pq.write_table(pa.table(_COLUMNS, schema=schema), path)
    return path


def parquet_of_a_schema_that_lies(path):
    """The schema of Arrow that stands in the metadata is not that of the file."""
    import base64

    schema = pa.schema([pa.field(n, pa.list_(pa.int8())) for n in ("t", "x", "F")])
    table = pa.table(_COLUMNS).replace_schema_metadata(
        {"ARROW:schema": base64.b64encode(schema.serialize().to_pybytes())}
    )
    pq.write_table(table, path, store_schema=False)
    return path


def parquet_of_an_extension_that_is_pickled(path):
    """A kind whose definition is a pickle, as pandas and Arrow once wrote them."""
    import pickle

    class Harm:
        def __reduce__(self):
            return (open, (str(path) + ".touched", "w"))

    metadata = {
        b"ARROW:extension:name": b"arrow.py_extension_type",
        b"ARROW:extension:metadata": pickle.dumps(Harm()),
    }
    fields = [pa.field(n, pa.float64(), metadata=metadata) for n in ("t", "x", "F")]
    pq.write_table(pa.table(_COLUMNS, schema=pa.schema(fields)), path)
    return path


def parquet_encrypted(path):
    path.write_bytes(b"PARE" + b"\0" * 100 + struct.pack("<I", 50) + b"PARE")
    return path


def json_of_many_brackets(path):
    path.write_text('{"rows": ' + "[" * 1_000_000 + "]" * 1_000_000 + "}")
    return path


def json_of_surrogates(path):
    path.write_text('{"rows": [[0, 1, 2]], "names": ["t", "x", "F"], "operator": "\\ud800"}')
    return path


for _maker in (json_of_many_brackets, json_of_surrogates):
    _maker.layout = 'matrix = "rows"\nmatrix_names = "names"'

TDMS = {
    "log.tdms": [
        good_tdms, tdms_by_hand, tdms_of_more_values_than_bytes,
        tdms_whose_next_segment_is_itself, tdms_of_one_value_a_chunk,
        tdms_of_scales_in_a_circle, tdms_of_ten_to_the_nine_scales,
        tdms_with_an_index_of_its_own, tdms_of_a_waveform_that_lies,
    ],
}  # fmt: skip
PARQUET = {
    "log.parquet": [
        good_parquet, parquet_whose_footer_is_nested, parquet_of_ten_to_the_twelve_rows,
        parquet_of_fewer_rows_than_stored, parquet_of_a_dictionary_of_long_texts,
        parquet_of_a_unit_of_no_text, parquet_of_a_schema_that_lies,
        parquet_of_an_extension_that_is_pickled, parquet_encrypted,
    ],
    "log.json": [
        json_of_many_brackets, json_of_surrogates,
    ],
}  # fmt: skip
