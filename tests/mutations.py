"""Strategies that spoil a good campaign: its log by bytes, rows, columns, units and encoding, its
campaign.toml by bytes and keys, and its tables by bytes and cells.

Each draws a `Mutation`: the files, what was done, and what has to become of it.  *harmless* is
the same content otherwise written; *fault* has to be refused or flagged; *another log* says
something else, and the product has to be what it says.
"""

import csv
import io
import json
import re
import warnings
import zipfile
from dataclasses import dataclass, replace

import numpy as np
from fuzzcases import CASES, GOOD, N_ROWS, Case
from hypothesis import strategies as st

__all__ = ["Mutation", "campaigns", "logs", "strategies", "tables"]

UNITS = {
    "t": ("ms", "min", "h", "N", "", "1"),
    "x": ("m", "cm", "ft", "in", "N", "", "mm/s"),
    "F": ("kN", "lbf", "kgf", "mm", "", "N m"),
}
JUNK = (b"\0", b"\xff", b"\xef\xbb\xbf", b"\xc2\xa0", b"nan", b"1e308", b"-", b'"', b",", b";", b"#", b"\n",
        b"\r", b"\t", b" ", b"'", b"[", b"]", b"{", b"=", b"\\", b"_", b"\xe2\x88\x92", b"0x1p3", b"\x1a")  # fmt: skip


@dataclass(frozen=True)
class Mutation:
    """A spoilt campaign."""

    case: Case
    files: dict[str, bytes]
    what: str
    expected: str

    def __repr__(self):
        return f"<{self.case.name}: {self.what}>"


def _log(case, data, what, expected):
    return Mutation(case, case.files | {case.log: data}, what, expected)


@st.composite
def spoilt_bytes(draw, data, most=3):
    """Bytes with a few flipped, put in, taken out, cut off or repeated; and what was done."""
    done = []
    for _ in range(draw(st.integers(1, most))):
        if not data:
            break
        place = draw(st.integers(0, len(data) - 1))
        how = draw(
            st.sampled_from(["flip", "set", "insert", "delete", "truncate", "repeat", "word"])
        )
        if how == "flip":
            bit = 1 << draw(st.integers(0, 7))
            data = data[:place] + bytes([data[place] ^ bit]) + data[place + 1 :]
        elif how == "set":
            data = data[:place] + draw(st.binary(min_size=1, max_size=1)) + data[place + 1 :]
        elif how == "insert":
            data = data[:place] + draw(st.sampled_from(JUNK)) + data[place:]
        elif how == "truncate":
            data = data[:place]
        elif how == "word":  # sizes and counts of binary formats
            word = draw(st.sampled_from([0, 1, 0x7F, 0xFF, 0x7FFFFFFF, 0xFFFFFFFF, 0x80000000]))
            data = data[:place] + word.to_bytes(4, "little") + data[place + 4 :]
        else:
            end = place + draw(st.integers(1, 64))
            data = data[:place] + data[place:end] * (2 * (how == "repeat")) + data[end:]
        done.append(f"{how} at {place}")
    return data, ", ".join(done)


@st.composite
def logs_by_bytes(draw, case):
    """A log of which some bytes are others; of a workbook also those inside the archive."""
    data = case.files[case.log]
    if case.name == "spreadsheet" and draw(st.booleans()):
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            members = {name: archive.read(name) for name in archive.namelist()}
        name = draw(st.sampled_from([*sorted(members), *["xl/worksheets/sheet1.xml"] * 4]))
        members[name], what = draw(spoilt_bytes(members[name]))
        stream = io.BytesIO()
        with zipfile.ZipFile(stream, "w") as archive:
            for member, content in members.items():
                archive.writestr(member, content)
        return _log(case, stream.getvalue(), f"{what} of {name}", "another log")
    if not case.is_text and draw(st.booleans()):  # where the headers stand
        edge = draw(st.sampled_from([256, 1024]))
        head, what = draw(spoilt_bytes(data[:edge]))
        return _log(case, head + data[edge:], what, "another log")
    data, what = draw(spoilt_bytes(data))
    return _log(case, data, what, "another log")


# -- rows and columns, in any format


def _inside(draw, length):
    """First of so many rows that stand in the cycles, well off both ends."""
    return draw(st.integers(70, N_ROWS - 100 - length))


def _drop_rows(draw, table):
    length = draw(st.sampled_from([1, 2, 3, 5, 20, 60]))
    first = _inside(draw, length)
    kept = np.r_[0:first, first + length : N_ROWS]
    expected = "another log" if length < 3 else "fault"
    return (
        replace(table, values=table.values[:, kept]),
        f"{length} rows dropped at {first}",
        expected,
    )


def _drop_ends(draw, table):
    first, last = draw(st.integers(0, 30)), N_ROWS - draw(st.integers(0, 30))
    return (
        replace(table, values=table.values[:, first:last]),
        f"rows {first} to {last}",
        "another log",
    )


def _repeat_rows(draw, table):
    length, first = draw(st.sampled_from([1, 2, 10, 48])), draw(st.integers(0, N_ROWS - 60))
    order = np.r_[0 : first + length, first:N_ROWS]
    return replace(table, values=table.values[:, order]), f"{length} rows twice at {first}", "fault"


def _swap_rows(draw, table):
    first = draw(st.integers(0, N_ROWS - 60))
    order = np.arange(N_ROWS)
    second = first + draw(st.sampled_from([1, 2, 50]))
    order[[first, second]] = second, first
    return replace(table, values=table.values[:, order]), f"rows {first}, {second} swapped", "fault"


def _reverse(draw, table):
    first = draw(st.sampled_from([0, 0, 100, 200]))
    order = np.r_[0:first, N_ROWS - 1 : first - 1 if first else None : -1]
    return replace(table, values=table.values[:, order]), f"backward from {first}", "fault"


def _jump(draw, table):
    first, step = _inside(draw, 1), draw(st.sampled_from([-30.0, -1.0, 2.0, 100.0, 1e6]))
    values = table.values.copy()
    values[0, first:] += step
    return replace(table, values=values), f"time jumps {step} s at {first}", "fault"


def _blank(draw, table):
    channel, first = draw(st.integers(0, 2)), _inside(draw, 60)
    length = draw(st.sampled_from([1, 3, 60]))
    values = table.values.copy()
    values[channel, first : first + length] = np.nan
    return (
        replace(table, values=values),
        f"{length} of {table.names[channel]} blank at {first}",
        "fault",
    )


def _one_value(draw, table):
    channel, row = draw(st.integers(0, 2)), draw(st.integers(0, N_ROWS - 1))
    change = draw(st.sampled_from(["digit", "tenfold", "sign", "zero", "huge", "infinite"]))
    values = table.values.copy()
    value = values[channel, row]
    text = list(f"{value:.2f}")
    if change == "digit":
        text[draw(st.integers(0, len(text) - 4))] = str(draw(st.integers(0, 9)))
        values[channel, row] = float("".join(text))
    else:
        values[channel, row] = {
            "tenfold": 10 * value, "sign": -value, "zero": 0.0, "huge": 1e30, "infinite": np.inf,
        }[change]  # fmt: skip
    expected = "fault" if change in ("huge", "infinite") else "another log"
    return replace(table, values=values), f"{change} of {table.names[channel]}[{row}]", expected


def _stuck(draw, table):
    first = _inside(draw, 120)
    values = table.values.copy()
    values[2, first : first + 120] = values[2, first]
    return replace(table, values=values), f"load stands at {first}", "fault"


def _scaled(draw, table):
    """From some row on in another unit."""
    channel, first = draw(st.integers(1, 2)), draw(st.integers(0, N_ROWS - 1))
    values = table.values.copy()
    values[channel, first:] *= draw(st.sampled_from([0.3048, 4.4482216152605, 0.1]))
    return (
        replace(table, values=values),
        f"{table.names[channel]} scaled from {first}",
        "another log",
    )


def _reorder(draw, table):
    order = draw(st.permutations(range(3)))
    made = replace(
        table, values=table.values[list(order)], names=tuple(table.names[i] for i in order),
        units=tuple(table.units[i] for i in order),
    )  # fmt: skip
    return made, f"columns {order}", "harmless"


def _drop_column(draw, table):
    gone = draw(st.integers(0, 2))
    kept = [i for i in range(3) if i != gone]
    made = replace(
        table, values=table.values[kept], names=tuple(table.names[i] for i in kept),
        units=tuple(table.units[i] for i in kept),
    )  # fmt: skip
    return made, "a column dropped", "fault"


def _more_columns(draw, table):
    source, name = (
        draw(st.integers(0, 2)),
        draw(st.sampled_from(["y", "t", "x", "F", "F ", "f", "T"])),
    )
    extra = table.values[source] + draw(st.sampled_from([0.0, 5.0]))
    made = replace(
        table, values=np.vstack([table.values, extra]), names=(*table.names, name),
        units=(*table.units, table.units[source]),
    )  # fmt: skip
    # of two variables of a name the library of MATLAB's files writes the later one
    return made, f"one more column {name!r}", "another log" if name in "txF" else "harmless"


def _rename(draw, table):
    place, name = (
        draw(st.integers(0, 2)),
        draw(st.sampled_from(["", "y", "time", "1", "Größe", "a,b", "=1+1"])),
    )
    names = tuple(name if i == place else n for i, n in enumerate(table.names))
    return replace(table, names=names), f"{table.names[place]} is called {name!r}", "fault"


def _swap_names(draw, table):
    a, b = draw(st.permutations(range(3)))[:2]
    names, units = list(table.names), list(table.units)
    names[a], names[b] = names[b], names[a]
    units[a], units[b] = units[b], units[a]
    made = replace(table, names=tuple(names), units=tuple(units))
    return made, f"names {a}, {b} swapped", "another log"


def _other_unit(draw, table):
    place = draw(st.integers(0, 2))
    unit = draw(st.sampled_from(UNITS[table.names[place]]))
    units = tuple(unit if i == place else u for i, u in enumerate(table.units))
    return replace(table, units=units), f"{table.names[place]} is said to be in {unit!r}", "unit"


_OF_TABLE = (
    _drop_rows, _drop_ends, _repeat_rows, _swap_rows, _reverse, _jump, _blank, _one_value, _one_value,
    _stuck, _scaled, _reorder, _drop_column, _more_columns, _rename, _swap_names, _other_unit, _other_unit,
)  # fmt: skip
_UNITLESS = ("matlab", "matlab-packed", "matlab-4")


@st.composite
def logs_by_table(draw, case):
    """A log whose rows, columns or units are others; two such changes at times."""
    table, done, expected = GOOD, [], "harmless"
    table, what, expected = draw(st.sampled_from(_OF_TABLE))(draw, table)
    done.append(what)
    if expected == "unit":
        unit = next(u for u, good in zip(table.units, GOOD.units, strict=True) if u != good)
        # a blank states nothing; a name with other words in its brackets is another name
        is_stated = case.name == "continental" or (unit and case.name not in _UNITLESS)
        expected = "fault" if is_stated else "harmless"
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", UserWarning)
            data = case.make_log(table)
    except (
        ValueError,
        TypeError,
        IndexError,
        UserWarning,
    ):  # the library of the format writes no such thing
        return _log(case, case.files[case.log], "nothing", "harmless")
    if expected == "fault" and data == case.files[case.log]:
        expected = "harmless"
    return _log(case, data, "; ".join(done), expected)


# -- text alone


def _lines(draw, data):
    end = draw(st.sampled_from([b"\n", b"\r\n", b"\r"]))
    return re.sub(rb"\r\n|\n", end, data), f"lines end in {end!r}", "harmless"


def _mixed_lines(draw, data):
    place = draw(st.integers(0, len(data)))
    changed = re.sub(rb"\r\n|\n", draw(st.sampled_from([b"\n", b"\r\n"])), data[place:])
    return data[:place] + changed, f"line ends change at {place}", "harmless"


def _blank_lines(draw, data):
    end = b"\r\n" if b"\r\n" in data else b"\n"
    lines = data.split(end)
    for _ in range(draw(st.integers(1, 4))):
        place = draw(st.integers(min(5, len(lines)), len(lines)))
        lines.insert(place, draw(st.sampled_from([b"", b" ", b"   "])))
    return end.join(lines), "blank lines", "harmless"


def _mark(draw, data):
    return b"\xef\xbb\xbf" + data, "byte-order mark of UTF-8", "mark"


def _other_encoding(draw, data):
    codec = draw(
        st.sampled_from(["utf-16", "utf-16-le", "utf-16-be", "utf-32", "utf-7", "cp037", "utf-8"])
    )
    text = data.decode("latin-1")
    return text.encode(codec), f"written in {codec}", "another log"


def _other_digits(draw, data):
    zero = draw(st.sampled_from([0x0660, 0x0966, 0xFF10, 0x1D7CE]))
    text = data.decode("latin-1")
    place = draw(st.integers(60, len(text) - 1))
    number = re.compile(r"\d+").search(text, place)
    if number is None:
        return data, "nothing", "harmless"
    digits = "".join(chr(zero + int(digit)) for digit in number[0])
    return (
        (text[: number.start()] + digits + text[number.end() :]).encode(),
        "digits of another script",
        "another log",
    )


def _decimal_comma(draw, data):
    return data.replace(b".", b","), "decimal commas", "another log"


def _decimal_point(draw, data):
    return data.replace(b",", b"."), "points for commas", "another log"


def _group_digits(draw, data):
    text = re.sub(
        rb"(?<![\d.,])(\d)(\d{3})\.(\d\d)\b",
        draw(st.sampled_from([rb"\1 \2.\3", rb"\1'\2.\3", rb"\1_\2.\3"])),
        data,
    )
    return text, "grouped digits", "another log"


def _quotes(draw, data):
    text = re.sub(rb"(?m)^(\d[^,;\t\r\n]*)(?=[,;\t])", rb'"\1"', data)
    return text, "first fields in quotes", "harmless"


def _trailing(draw, data):
    mark = b";" if b";" in data else b"\t" if b"\t" in data else b","
    return re.sub(rb"(\r?\n)", mark + rb"\1", data), "trailing delimiters", "another log"


def _no_end(draw, data):
    return data.rstrip(b"\r\n"), "no last line end", "harmless"


def _nothing_left(draw, data):
    return (
        draw(st.sampled_from([b"", b"\n", b" ", b"\xef\xbb\xbf", b"\0", data[:30]])),
        "next to nothing",
        "fault",
    )


_OF_TEXT = (
    _lines, _mixed_lines, _blank_lines, _mark, _other_encoding, _other_digits, _decimal_comma,
    _decimal_point, _group_digits, _quotes, _trailing, _no_end, _nothing_left,
)  # fmt: skip


@st.composite
def logs_as_text(draw, case):
    """A text log otherwise written."""
    data, what, expected = draw(st.sampled_from(_OF_TEXT))(draw, case.files[case.log])
    if expected == "mark":
        expected = "fault" if case.name == "continental" else "harmless"
    if case.name == "json" and expected == "harmless":
        expected = "another log"  # blanks and quotes have another meaning there
    return _log(case, data, what, expected)


@st.composite
def json_keys(draw):
    """A JSON log with keys and values of another kind."""
    case = CASES["json"]
    content = json.loads(case.files[case.log])
    key = draw(st.sampled_from(sorted(content)))
    how = draw(st.sampled_from(["drop", "kind", "row", "cell", "twice"]))
    odd = [None, True, "12", 10**400, [], {}, [1.0], 1e308, -0.0, "NaN", float("inf"), float("nan")]
    if how == "drop":
        del content[key]
    elif how == "kind":
        content[key] = draw(st.sampled_from(odd))
    elif how == "row":
        content["rows"][draw(st.integers(0, N_ROWS - 1))] = draw(
            st.sampled_from([*odd, [1.0, 2.0], [1, 2, 3, 4]])
        )
    elif how == "cell":
        content["rows"][draw(st.integers(0, N_ROWS - 1))][draw(st.integers(0, 2))] = draw(
            st.sampled_from(odd)
        )
    text = json.dumps(content)
    if how == "twice":
        text = text[:-1] + f', "{key}": {json.dumps(content[key][:2])}}}'
    return _log(case, text.encode(), f"JSON {how} {key}", "another log")


@st.composite
def logs(draw, name):
    """A spoilt log of a case."""
    case = CASES[name]
    ways = [logs_by_bytes(case), logs_by_table(case), logs_by_table(case)]
    if case.is_text:
        ways.append(logs_as_text(case))
    if name == "json":
        ways.append(json_keys())
    return draw(st.one_of(ways))


# -- campaign.toml and tables

_VALUES = (
    '""', '"?"', '"2"', '"2 m"', '"2 ft"', '"-2 m"', '"0 m"', '"1e9 m"', '"nan m"', '"inf N"', '"1 N"', '"1 lbf"',
    '"-1"', '"1e400 m"', '"m"', '"2m"', '"2 mm"', '"٢ m"', '"1_0 mm"', '"2 furlong"', '"2 N m"', '"0x10 m"',
    "0", "1", "-1", "1e308", "nan", "inf", "-inf", "true", "false", "[]", "[[]]", "{}", "1979-05-27", "07:32:00",
    '["20 mm", "40 mm"]', '["20 mm", ""]', '"../A.csv"', '"/etc/passwd"', '"A\\u0000.csv"', '"."', '"one"', '"F"',
    '"x"', '"t"', "3", "99999999999999999999999", '"cyclic"', '"rubber tether"', '"utf-16"', '"rot13"', '"\\t"', '" "', '","',
    '"displacement"', '"load"', '"sinusoidal"', '"N"', '"kN"', '"mm"', '"s"', '"ms"', '"clock"', '"hex"', '"%"',
)  # fmt: skip
_MORE = (
    'sign = -1', 'zero = "5 N"', 'zero = "0.5 m"', 'factor = 2.0', 'factor = 0', 'factor = -1.0', 'factor = nan', 'factor = inf',
    'reference_length = "2 m"', 'standard_uncertainty = "1 N"', 'standard_uncertainty = "-1 mm"',
    'verified_range = ["0 N", "500 N"]', 'verified_range = ["500 N", "0 N"]', 'time_column = "t"',
)  # fmt: skip
_NUMBERS = (
    "quality.stuck_samples = 3", "quality.spike_factor = 3", "quality.gap_factor = 1.01", "quality.gap_factor = nan",
    "quality.rate_tolerance = inf", 'phases.minimum_duration = "0.5 s"', 'phases.position_tolerance = "1 m"',
    'cycles.band = "1 mm"', 'cycles.band = "3 m"', "cycles.trim_threshold = 0.0", "cycles.trim_threshold = 1.0",
    "cycles.break_in_cycles = 2", "cycles.break_in_cycles = 1e30", 'modulus.strain_bin_width = "0.01 %"', "modulus.window = 1e-4",
    "modulus.window = 10", "modulus.minimum_count = 3", "modulus.minimum_count = 1e15", "modulus.maximum_segments = 8",
    "modulus.selected_cycles = 2", "modulus.stress_at_strain = []", "modulus.stress_at_strain = [nan]",
    "modulus.stress_at_strain = [-1, 0, 1e9]", 'holds.minimum_duration = "1 s"', 'holds.times = ["1 s", "0 s", "-1 s"]',
    "archive.longest_record = 1000", "rope.last_cycles = 1", 'rope.reference_time = "1e9 s"', "slip.minimum_cycles = 20",
)  # fmt: skip


@st.composite
def _toml_keys(draw, text):
    """One line of campaign.toml dropped, repeated, moved, with another value or another key."""
    lines = text.split("\n")
    filled = [i for i, line in enumerate(lines) if line.strip()]
    place = draw(st.sampled_from(filled))
    how = draw(
        st.sampled_from(
            ["drop", "repeat", "move", "value", "value", "value", "key", "inner", "more", "number"]
        )
    )
    line = lines[place]
    if how == "drop":
        del lines[place]
    elif how == "repeat":
        lines.insert(place, line)
    elif how == "move":
        lines.insert(draw(st.integers(0, len(lines) - 1)), lines.pop(place))
    elif how == "value" and " = " in line:
        key = line.partition(" = ")[0]
        lines[place] = f"{key} = {draw(st.sampled_from(_VALUES))}"
    elif how == "key":
        lines[place] = (
            draw(st.sampled_from(["x", "Kind", "a.b", '""', "_"])) + " " + line.partition(" ")[2]
        )
    elif how == "inner" and "{" in line:
        inner = list(re.finditer(r'= ("[^"]*")', line))
        match = draw(st.sampled_from(inner)) if inner else None
        if match:
            lines[place] = (
                line[: match.start(1)] + draw(st.sampled_from(_VALUES)) + line[match.end(1) :]
            )
    elif how == "more":
        channel = draw(st.sampled_from([i for i in filled if "column =" in lines[i]]))
        lines[channel] = lines[channel].replace(" }", f", {draw(st.sampled_from(_MORE))} }}")
        line = lines[channel]
    elif how == "number":
        line = "reduction." + draw(st.sampled_from(_NUMBERS))
        lines.append(line)
    gone, new = set(text.split("\n")) - set(lines), set(lines) - set(text.split("\n"))
    return "\n".join(lines), f"{how}: {min(gone, default='')[:60]} -> {min(new, default='')[:90]}"


_PLAUSIBLE = (
    (r'unit = "mm"', tuple(f'unit = "{unit}"' for unit in ("m", "cm", "in", "ft", "dm", "inch"))),
    (r'unit = "N"', tuple(f'unit = "{unit}"' for unit in ("kN", "lbf", "kgf", "MN", "lb"))),
    (r'unit = "s"', tuple(f'unit = "{unit}"' for unit in ("ms", "min", "h", "sec"))),
    (r'(column = "x".*) }', tuple(rf"\1, {more} }}" for more in (
        "sign = -1", 'zero = "0.5 m"', 'zero = "-1 ft"', "factor = 2.0", "factor = 0.3048",
        'standard_uncertainty = "1 mm"'))),
    (r'(column = "F".*) }', tuple(rf"\1, {more} }}" for more in (
        "sign = -1", 'zero = "-2 N"', 'zero = "10 lbf"', "factor = 4.448", "factor = 0.1",
        'standard_uncertainty = "1 lbf"', 'verified_range = ["0 N", "2 kN"]'))),
    (r'(column = "t".*) }', (r"\1, factor = 0.5 }", r"\1, factor = 60.0 }")),
    (r'datum = "pin-to-pin"', tuple(
        f'datum = "displacement", reference_length = "{size}"' for size in ("2 m", "6 ft", "-1 m"))),
    (r'"20 mm"', ('"25 mm"', '"2 cm"', '"0.8 in"', '"20 mm", "22 mm"')),
    (r'gauge_length = "2 m"', ('gauge_length = "2.5 m"', 'gauge_length = "80 in"', 'gauge_length = "200 cm"')),
    (r'kind = "rope"', ('kind = "wire"', 'kind = "stretch hose"')),
    (r'(specimens = \["one"\])', tuple(rf"\1\n{more}" for more in (
        'control = "load"', 'waveform = "other"', 'waveform = "sinusoidal"', 'kind = "bedding-in"',
        'kind = "fatigue"', "order = 1", "n_cycles = 6", 'note = "x"'))),
)  # fmt: skip


@st.composite
def _toml_plausible(draw, text):
    """What a person may well have written instead."""
    pattern, others = draw(st.sampled_from(_PLAUSIBLE))
    other = draw(st.sampled_from(others))
    return re.sub(pattern, other, text, count=1), f"{pattern} -> {other}"


@st.composite
def campaigns(draw, name="delimited"):
    """A campaign.toml that is spoilt; settings are numbers that a person may choose."""
    case = CASES[name]
    data = case.files["campaign.toml"]
    if draw(st.integers(0, 4)) == 0:
        data, what = draw(spoilt_bytes(data))
    else:
        change = draw(st.sampled_from([_toml_keys, _toml_plausible, _toml_plausible]))
        text, what = draw(change(data.decode()))
        data = text.encode("utf-8", "surrogatepass")
    return Mutation(case, case.files | {"campaign.toml": data}, what, "another log")


@st.composite
def tables(draw):
    """Marks, tests and results by bytes, rows, columns and cells."""
    case = CASES["marked"]
    name = draw(st.sampled_from(["marks.csv", "marks.csv", "tests.csv", "results.csv"]))
    data = case.files[name]
    if draw(st.integers(0, 2)) == 0:
        data, what = draw(spoilt_bytes(data))
        return Mutation(case, case.files | {name: data}, f"{name}: {what}", "another log")
    rows = [row for row in csv.reader(data.decode().splitlines()) if row]
    row, column = draw(st.integers(0, len(rows) - 1)), draw(st.integers(0, len(rows[0]) - 1))
    how = draw(
        st.sampled_from(
            ["cell", "cell", "cell", "drop", "repeat", "column", "swap", "short", "unit"]
        )
    )
    odd = [
        "", " ", "nan", "inf", "-1", "0", "1e9", "1e-9", "1_000.0", "٤٠٠", "400,0", "=1+1", "?", "slack", "max", "A", "one",
        "0.75", "75 %", "yes", "no", "²", "--5", "-", "1e400", "0x10", "kN", "lbf", "m", "+400.0", "400.0 mm", "x" * 200_000,
        "A.csv", "../A.csv", "\u2212400", "true", "6.0",
    ]  # fmt: skip
    if how == "cell":
        rows[row][column] = draw(st.sampled_from(odd))
    elif how == "drop":
        del rows[row]
    elif how == "repeat":
        rows.insert(row, rows[row])
    elif how == "column":
        for one in rows:
            del one[column]
    elif how == "swap":
        other = draw(st.integers(0, len(rows[0]) - 1))
        for one in rows[draw(st.integers(0, 1)) :]:
            one[column], one[other] = one[other], one[column]
    elif how == "short":
        rows[row] = rows[row][:column]
    else:
        rows[0] = [
            re.sub("_mm$", draw(st.sampled_from(["_m", "_cm", "_ft", "_in", ""])), cell)
            for cell in rows[0]
        ]
    stream = io.StringIO()
    csv.writer(stream, lineterminator="\n").writerows(rows)
    files = case.files | {name: stream.getvalue().encode()}
    return Mutation(case, files, f"{name}: {how} {row},{column}", "another log")


def strategies():
    """Every strategy by its name."""
    return {
        **{name: logs(name) for name in CASES if name != "marked"},
        "campaign": campaigns("delimited"),
        "campaign-without-units": campaigns("matlab"),
        "campaign-of-tables": campaigns("marked"),
        "tables": tables(),
    }
