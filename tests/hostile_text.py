"""Hostile texts and campaigns (all synthetic): logs, TOML, tables, paths and names."""

import os

from hostile import ROOT, Case

RAW = ROOT / "raw" / "tmt-synthetic" / "T-1.csv"
HEADER = b"t,x,F\n"
N_ROWS = 3  # of a log that is refused before anything is reduced
LAYOUT = """[layouts.log]
format = "delimited"
{settings}
channels.time = {{ column = "t", unit = "s" }}
channels.crosshead_position = {{ column = "x", unit = "m", datum = "pin-to-pin" }}
channels.tension.1 = {{ column = "F", unit = "N" }}
"""
HEAD = """[campaign]
id = "hostile"
title = "Hostile files (synthetic)"
source = "synthetic"
"""
REST = """[specimens.new]
kind = "rubber tether"
diameter = ["1 in"]
[defaults]
layout = "log"
specimens = ["new"]
"""
TEST = """[tests.T-1]
file = "log.csv"
"""


def rows(count=N_ROWS):
    return b"".join(b"%d,%d,%d\n" % (n, 10 + n, 100 + n) for n in range(count))


def campaign(folder, *, head=HEAD, settings="", rest=REST, tests=TEST, command="check"):
    text = head + LAYOUT.format(settings=settings) + rest + tests
    (folder / "campaign.toml").write_bytes(text if isinstance(text, bytes) else text.encode())
    return [command, folder / "campaign.toml"]


def log(data, settings="", more=""):
    """A campaign whose log holds these bytes."""

    def make(folder):
        (folder / "log.csv").write_bytes(data)
        return campaign(folder, settings=settings, tests=TEST + more)

    return make


def sniffed(data):
    def make(folder):
        (folder / "log.csv").write_bytes(data)
        return ["sniff", folder / "log.csv"]

    return make


def good(change=lambda data: data, settings='comment = "#"'):
    """A log of the project, its bytes changed in a way that leaves every number as it was."""

    def make(folder):
        data = RAW.read_bytes()
        for old, new in (
            (b"time_s,crosshead_ft,load_new_lb,load_used_lb", b"t,x,F,G"),
            (b"\r\n", b"\n"),
        ):
            data = data.replace(old, new)
        (folder / "log.csv").write_bytes(change(data))
        rest = REST.replace("[defaults]", 'gauge_length = "4 m"\n[defaults]')
        return [*campaign(folder, settings=settings, rest=rest), "--json"]

    return make


def one_line(folder, n_bytes, limit=""):
    """One line of so many digits."""
    with (folder / "log.csv").open("wb") as file:
        file.write(HEADER + b"1,")
        for _ in range(n_bytes // 1_000_000):
            file.write(b"1" * 1_000_000)
        file.write(b",1\n")
    return campaign(folder, tests=TEST + limit)


def sniffed_line(folder):
    one_line(folder, 10**9)
    return ["sniff", folder / "log.csv"]


def sparse(folder, n_bytes):
    """A log, and behind it so many NUL bytes, which take no room on the disk."""
    with (folder / "log.csv").open("wb") as file:
        file.write(HEADER + rows())
        file.truncate(n_bytes)
    return campaign(folder)


def wide_log(folder, n_columns, limit=""):
    names = b"t,x,F," + b",".join(b"c%d" % n for n in range(n_columns - 3))
    with (folder / "log.csv").open("wb") as file:
        for line in (names, b"1," * (n_columns - 1) + b"1", b"2," * (n_columns - 1) + b"2"):
            file.write(line + b"\n")
    return campaign(folder, tests=TEST + limit)


def value(text, settings=""):
    return log(HEADER + rows() + b"9,19," + text + b"\n" + b"10,20,110\n", settings)


def toml(text):
    """A campaign.toml that holds nothing but this, which a large text is made for when it runs."""

    def make(folder):
        said = text() if callable(text) else text
        (folder / "campaign.toml").write_bytes(said if isinstance(said, bytes) else said.encode())
        return ["check", folder / "campaign.toml"]

    return make


def added(text, at="end"):
    """A good campaign.toml with more in it."""

    def make(folder):
        (folder / "log.csv").write_bytes(HEADER + rows())
        if at == "campaign":
            return campaign(folder, head=HEAD + text)
        return campaign(folder, tests=TEST + text)

    return make


def many_tests(folder, count):
    (folder / "log.csv").write_bytes(HEADER + rows())
    tests = "".join(f'[tests.T-{n}]\nfile = "missing/{n}.csv"\n' for n in range(count))
    return [*campaign(folder, tests=tests), "--quiet"]


def table(name, text, key="", rest=REST):
    """A table of tests, marks or results."""

    def make(folder):
        (folder / "log.csv").write_bytes(HEADER + rows())
        data = text if isinstance(text, bytes) else text.encode()
        (folder / name).write_bytes(data)
        head, tests = HEAD, TEST
        if name == "tests.csv":
            head, tests = HEAD + 'tests = "tests.csv"\n', ""
        elif name == "results.csv":
            head = HEAD + 'results = "results.csv"\n'
        else:
            tests = TEST + 'strain = { marks = "marks.csv" }\n'
        return campaign(folder, head=head, tests=tests, rest=rest)

    return make


def named(name, key="log"):
    """A campaign in a folder of its own that names a file so, in one of its keys."""

    def make(folder):
        inside = folder / "campaign"
        inside.mkdir()
        (folder / "outside.csv").write_bytes(HEADER + rows())
        (inside / "log.csv").write_bytes(HEADER + rows())
        (inside / "ring").symlink_to("ring")
        (inside / "out.csv").symlink_to(folder / "outside.csv")
        (inside / "zero.csv").symlink_to("/dev/zero")
        (inside / "up").symlink_to(folder)
        os.mkfifo(inside / "pipe.csv")
        (inside / "folder.csv").mkdir()
        quoted = "'" + name + "'" if "'" not in name else '"' + name + '"'
        head, tests = HEAD, f"[tests.T-1]\nfile = {quoted}\n"
        if key != "log":
            tests = TEST
        if key == "pieces":
            tests = f'[tests.T-1]\nfile = [{{ file = "log.csv" }}, {{ file = {quoted} }}]\n'
        elif key == "marks":
            tests += f"strain = {{ marks = {quoted} }}\n"
        elif key in ("tests", "results"):
            head += f"{key} = {quoted}\n"
        elif key == "in tests.csv":
            head, tests = head + 'tests = "tests.csv"\n', ""
            (inside / "tests.csv").write_text(f'id,file\nT-1,"{name}"\n')
        elif key == "marks in tests.csv":
            head, tests = head + 'tests = "tests.csv"\n', ""
            (inside / "tests.csv").write_text(f'id,file,marks\nT-1,log.csv,"{name}"\n')
        return campaign(inside, head=head, tests=tests)

    return make


def test_id(*names):
    def make(folder):
        (folder / "log.csv").write_bytes(HEADER + rows())
        tests = "".join(f"[tests.'{name}']\nfile = 'log.csv'\n" for name in names)
        return campaign(folder, tests=tests)

    return make


def opened(name):
    """A command on something that is no file: it must not wait for it."""

    def make(folder):
        os.mkfifo(folder / "pipe")
        return [*name[:-1], {"pipe": folder / "pipe"}.get(name[-1], name[-1])]

    return make


def deep(depth):
    return "x = " + "[" * depth + "]" * depth + "\n"


OUTSIDE = "a file lies outside the campaign folder"
NO_NAME = "no file can have such a name"
NOT_A_NUMBER = "[F]: a value is not a number"
TWICE = "Cannot declare"

TEXT = (
    Case("a line of 20 MB", lambda folder: one_line(folder, 20_000_000), 3, "a line is too long"),
    Case(
        "200 GB, nearly all of it NUL bytes",
        lambda folder: sparse(folder, 200 * 10**9),
        3,
        "raise file_size",
    ),
    Case(
        "10 GB, nearly all of it NUL bytes",
        lambda folder: sparse(folder, 10**10),
        3,
        "log.csv:5: the file is binary",
    ),
    Case(
        "100,000 columns",
        lambda folder: wide_log(folder, 100_000),
        3,
        "the file has too many columns; found 100,000; needed 10,000 at most",
    ),
    Case(
        "a million columns, lines of 2 MB",
        lambda folder: wide_log(folder, 1_000_000),
        3,
        "a line is too long",
    ),
    Case("a NUL byte at the start", log(b"\0" + HEADER + rows()), 3, "a NUL byte"),
    Case(
        "a NUL byte far below", log(HEADER + rows(50_000) + b"1,\0,2\n"), 3, ":50002: the file is"
    ),
    Case(
        "UTF-16 that the layout does not declare",
        log((HEADER + rows()).decode().encode("utf-16")),
        3,
        "the byte-order mark of utf-16",
    ),
    Case(
        "UTF-16 with an odd byte at its end",
        log((HEADER + rows()).decode().encode("utf-16") + b"1", 'encoding = "utf-16"'),
        3,
        "the file is not in the declared encoding",
    ),
    Case(
        "UTF-16 with half a pair",
        log((HEADER + rows()).decode().encode("utf-16") + b"\0\xd8\n\0", 'encoding = "utf-16"'),
        3,
        "the file is not in the declared encoding",
    ),
    Case(
        "UTF-8 above, Latin-1 below",
        log(HEADER + rows() + b"# \xb0C\n" + rows(), 'comment = "#"'),
        3,
        "log.csv:5: the file is not in the declared encoding",
    ),
    Case(
        "an encoding that is no text",
        log(HEADER, 'encoding = "base64"'),
        2,
        "an encoding is not known",
    ),
    Case(
        "an encoding of escapes",
        log(HEADER, 'encoding = "unicode_escape"'),
        2,
        "an encoding is not known",
    ),
    Case("a byte-order mark", good(lambda data: b"\xef\xbb\xbf" + data), 0, '"n_rows": 7632'),
    Case(
        "two byte-order marks",
        log(b"\xef\xbb\xbf\xef\xbb\xbf" + HEADER + rows()),
        3,
        r"found '\ufefft'",
    ),
    Case(
        "a byte-order mark in the middle",
        log(HEADER + rows() + b"\xef\xbb\xbf7,17,107\n"),
        3,
        "[t]: a value is not a number",
    ),
    Case("a byte-order mark alone", log(b"\xef\xbb\xbf"), 3, "there are no data rows"),
    Case("nothing at all", log(b""), 3, "the file is empty"),
    Case(
        "carriage returns alone", good(lambda data: data.replace(b"\n", b"\r")), 0, '"n_rows": 7632'
    ),
    Case(
        "three kinds of line end",
        good(lambda data: data.replace(b"\n", b"\r\n", 3000).replace(b"\r\n", b"\r", 1000)),
        0,
        '"n_rows": 7632',
    ),
    Case(
        "escape sequences of a terminal",
        value(b"\x1b[31m1\x1b]0;x\x07"),
        3,
        r"found '\x1b[31m1\x1b]0;x\x07'",
    ),
    Case("a name of escape sequences", log(b"t,\x1b[2J,F\n" + rows()), 3, r"'\x1b[2J'"),
    Case(
        "a quote that is never closed",
        log(HEADER + b'1,2,"3\n' + rows(1000)),
        3,
        "log.csv:2: a quoted field continues beyond its line",
    ),
    Case(
        "a quote that is never closed in the header",
        log(b't,x,"F\n' + rows()),
        4,
        "the record is too short",
    ),
    Case(
        "a million commas",
        log(HEADER + b"," * 900_000 + b"\n"),
        3,
        "found 900,001; needed 10,000 at most",
    ),
    Case("a million blank lines", log(b"\n" * 5_000_000), 3, "there are no data rows"),
    Case(
        "200,000 comment lines",
        log(b"# x\n" * 200_000, 'comment = "#"'),
        3,
        "there are no data rows",
    ),
    *(
        Case(f"the number {text.decode()[:24]}", value(text), 3, NOT_A_NUMBER)
        for text in (
            b"1e400",
            b"-1e400",
            b"inf",
            b"-Infinity",
            b"-nan",
            b"0x10",
            b"1_000",
            b"1d5",
            b"1e",
            b"TRUE",
            b"=1+1",
            "\u0663".encode(),
            "\uff11\uff12".encode(),
            "\u22125".encode(),
            b"1'000",
            b"1 000",
            b"1.5.5",
            b"1;5",
            b"9" * 900_000,
            b"1e" + b"9" * 900_000,
        )
    ),
    Case("a decimal comma among points", value(b'"1,5"'), 3, NOT_A_NUMBER),
    Case(
        "a decimal point among commas",
        log(b"t;x;F\n1,5;2,5;3,5\n2,5;3.5;4,5\n", 'delimiter = ";"\ndecimal = ","'),
        3,
        "[x]: a value is not a number",
    ),
    Case(
        "a separator that no parser knows",
        log(HEADER, 'delimiter = "\\u00a7"'),
        2,
        "cannot be told from its text",
    ),
    Case("sniffed: a million blank lines", sniffed(b"\n" * 1_000_000), 3, "no table of numbers"),
    Case("sniffed: one line", sniffed(b"1" * 20_000_000), 3, "no table of numbers"),
    Case(
        "sniffed: 10,000 columns",
        sniffed(b"1,2," * 5_000 + b"3\n" + b"1,2," * 5_000 + b"3\n"),
        0,
        "format",
    ),
    Case("sniffed: a pipe that nobody writes", opened(["sniff", "pipe"]), 3, "found a pipe"),
    Case("sniffed: a device that never ends", opened(["sniff", "/dev/zero"]), 3, "found a device"),
)
TOML = (
    Case("100,000 brackets", toml(deep(100_000)), 2, "is not TOML"),
    Case("100,000 braces", toml("x = " + "{a=" * 100_000), 2, "is not TOML"),
    Case("a key of 20,000 parts", toml("a" + ".a" * 20_000 + " = 1\n"), 2, "more than 40 parts"),
    Case("a table of 2,000 parts", toml("[a" + '."a"' * 2_000 + "]\n"), 2, "more than 40 parts"),
    Case("settings of 30 parts", added("reduction.cycles" + ".a" * 28 + " = 1\n"), 2, "reduction"),
    Case(
        "a million keys",
        toml(lambda: "".join(f"k{n} = 1\n" for n in range(1_000_000))),
        2,
        "more than 500,000 lines",
    ),
    Case(
        "10,000 keys",
        toml("".join(f"k{n} = 1\n" for n in range(10_000))),
        2,
        "and 9991 more",
        megabytes=200,
    ),
    Case("a text of a megabyte", added(f'note = "{"x" * 1_000_000}"\n'), 2, "tests.T-1.note"),
    Case("a file of 100 MB", toml(lambda: "#" + "x" * 100_000_000), 2, "too large to be a table"),
    Case("a whole number of 5,000 digits", added(f"order = {'9' * 5000}\n"), 2, "is not TOML"),
    Case("a whole number of 4,000 digits", added(f"order = {'9' * 4000}\n"), 2, "tests.T-1.order"),
    Case("a huge number where one counts", added(f"reduction.cycles.band = {'9' * 400}\n"), 2, ""),
    Case(
        "infinitely many",
        added("reduction.cycles.break_in_cycles = inf\n"),
        2,
        "is not a whole number",
    ),
    Case("nan as a number", added("reduction.cycles.trim_threshold = nan\n"), 2, ""),
    Case("nan as a strain", added("target_strain = [nan]\n"), 2, ""),
    Case(
        "1e400 ft",
        added('reduction.phases.position_tolerance = "1e400 ft"\n'),
        2,
        "not finite",
    ),
    Case("a key twice", added('file = "log.csv"\n'), 2, "Cannot overwrite"),
    Case("a table twice", added(TEST), 2, TWICE),
    Case("a date where a text is meant", added("operator = 2026-11-22\n"), 2, "tests.T-1.operator"),
    Case("a date that is none", added("date = 2026-13-45\n"), 2, "is not TOML"),
    Case("bytes that are no UTF-8", toml(b'[campaign]\nid = "\xff"\n'), 2, "is not TOML"),
    Case("a NUL byte", toml(b"[campaign]\n\0"), 2, "is not TOML"),
    Case("UTF-16", toml(HEAD.encode("utf-16")), 2, "is not TOML"),
    Case("a campaign that is a pipe", opened(["check", "pipe"]), 2, "found a pipe"),
    Case("a campaign that is a device", opened(["check", "/dev/zero"]), 2, "found a device"),
    Case(
        "a campaign of 300 tests without logs",
        lambda folder: many_tests(folder, 300),
        3,
        "missing/299.csv",
    ),
    Case("escape sequences in a key", toml('"\\u001b[2J" = 1\n'), 2, r"\x1b[2J"),
)
MARKS = "test,specimen,hold,near_toe_ft,far_toe_ft,far_thimble_ft\n"
RESULTS = "id,quantity,specimen,value,unit\n"
TABLES = (
    Case(
        "tests.csv with a cell of a megabyte",
        table("tests.csv", "id,file,note\nT-1,log.csv," + "x" * 1_000_000 + "\n"),
        2,
        "cannot be split into cells",
    ),
    Case(
        "tests.csv with a quote that is never closed",
        table("tests.csv", 'id,file,note\nT-1,log.csv,"open\nT-2,log.csv,\nT-3,log.csv,\n'),
        2,
        "tests.csv:2: a row of the table of tests cannot be split into cells",
    ),
    Case(
        "tests.csv with a quote over two rows",
        table("tests.csv", 'id,file,note\nT-1,log.csv,"a\nT-2,log.csv,b"\n'),
        2,
        "tests.csv:2:",
    ),
    Case("tests.csv with a NUL byte", table("tests.csv", b"id,file\nT-1,log\0.csv\n"), 2, ""),
    Case(
        "tests.csv with 100,000 columns",
        table("tests.csv", "id,file" + ",note" * 100_000),
        2,
        "no usable header",
    ),
    Case("tests.csv in UTF-16", table("tests.csv", "id,file\n".encode("utf-16")), 2, "not UTF-8"),
    *(
        Case(
            f"tests.csv with order {text}",
            table("tests.csv", f"id,file,order\nT-1,log.csv,{text}\n"),
            2,
            "order is not a whole number",
        )
        for text in ("\u00b2", "\u0663", "--5", "9" * 5000, "1_0", "1e3", "inf")
    ),
    Case("tests.csv that is empty", table("tests.csv", ""), 2, "no usable header"),
    *(
        Case(
            f"marks with {text[:20]}",
            table("marks.csv", MARKS + f"T-1,new,min,1.0,9.0,{text}\n"),
            3,
            "a mark is not a number",
        )
        for text in ("1_0", "inf", "nan", "1e400", "\u0663", "0x1", "9" * 5000, "12." + "0" * 5000)
    ),
    Case(
        "marks with a hold of nan",
        table("marks.csv", MARKS + "T-1,new,nan,1,9,10\n"),
        3,
        "unknown name of a hold",
    ),
    Case(
        "marks with a quote that is never closed",
        table("marks.csv", MARKS + 'T-1,"new,min,1,9,10\nT-1,new,max,1,9,10\n'),
        3,
        "marks.csv:2: a row of the marks file cannot be split",
    ),
    Case(
        "results with 1e400",
        table("results.csv", RESULTS + "B-1,tensile_strength,new,1e400,lbf\n"),
        3,
        "not finite",
    ),
    Case(
        "results with a cell of a megabyte",
        table("results.csv", RESULTS + f"B-1,tensile_strength,new,{'9' * 1_000_000},lbf\n"),
        3,
        "cannot be split into cells",
    ),
    Case("a table of runs that is a device", opened(["surface", "/dev/zero"]), 3, "found a device"),
    Case("a table of runs that is a pipe", opened(["surface", "pipe"]), 3, "found a pipe"),
)
OTHER_KEYS = ("pieces", "marks", "tests", "results", "in tests.csv", "marks in tests.csv")
LEADS_AWAY = (
    ("../outside.csv", 2, OUTSIDE),
    ("out.csv", 2, OUTSIDE),
    ("C:\\logs\\T-1.csv", 2, OUTSIDE),
    ("ring", 2, NO_NAME),
    ("pipe.csv", 3, "found a pipe"),
)
LEADS_NOWHERE = (
    ("/etc/passwd", 2, OUTSIDE),
    ("up/outside.csv", 2, OUTSIDE),
    ("zero.csv", 2, OUTSIDE),
    ("\\\\host\\share\\T-1.csv", 2, OUTSIDE),
    ("CON", 2, NO_NAME),
    ("aux.csv", 2, NO_NAME),
    ("file:///etc/passwd", 2, "is a URL"),
    ("https://host/T.csv", 2, "is a URL"),
    ("folder.csv", 3, "found a folder"),
    ("~/T-1.csv", 3, "No such file"),
    ("$(touch x).csv", 3, "No such file"),
    ("-rf", 3, "No such file"),
    ("x" * 300, 3, "File name too long"),
    ("a/../../campaign/nothing.csv", 3, "No such file"),
)
PATHS = (
    *(
        Case(f"log: {name[:40]}", named(name, "log"), status, says)
        for name, status, says in (*LEADS_AWAY, *LEADS_NOWHERE)
    ),
    *(
        Case(f"{key}: {name}", named(name, key), status, says)
        for key in OTHER_KEYS
        for name, status, says in LEADS_AWAY
    ),
)
NAMES = (
    *(
        Case(f"test {name[:24]!r}", test_id(name), 2, "tests")
        for name in ("../x", "a/b", "a\\b", "x.", "x ", "", ".", "x" * 300, "a b", "<b>", "=1+1",
                     "a;b", "\u00e9", "a\u202eb", "-x", "$(x)")
    ),
    *(
        Case(f"test {name!r}", test_id(name), 2, "a device on Windows")
        for name in ("CON", "nul", "Com1", "LPT9")
    ),
    Case("tests a and A", test_id("a", "A"), 2, "differ only in capital letters"),
    Case("test Surfaces", test_id("Surfaces"), 2, "the name of another archive"),
    Case("steps that differ in capital letters", added(
        '[[tests.T-1.steps]]\nname = "a b"\nfrom = 1\nto = 2\n'
        '[[tests.T-1.steps]]\nname = "A-b"\nfrom = 3\nto = 4\n'), 2, "have the same name"),
)  # fmt: skip
# too long for the tests
SLOW = (
    Case("a line of 1 GB", lambda folder: one_line(folder, 10**9), 3, "a line is too long"),
    Case("a line of 1 GB, sniffed", sniffed_line, 3, "no table of numbers"),
    Case(
        "a line of 20 MB where 100 MB are allowed",
        lambda folder: one_line(folder, 20_000_000, '[limits]\nline_length = "100 MB"\n'),
        3,
        "[x]: a value is not a number",
        megabytes=1000,
    ),
    Case(
        "a million columns where a million are allowed",
        lambda folder: wide_log(
            folder, 1_000_000, '[limits]\nline_length = "100 MB"\ncolumns = 1_000_000\n'
        ),
        4,
        "too short",
        seconds=120,
        megabytes=4000,
    ),
    Case(
        "a campaign of 100,000 tests without logs",
        lambda folder: many_tests(folder, 100_000),
        3,
        "missing/99999.csv",
        seconds=300,
        megabytes=1500,
    ),
)
CASES = (*TEXT, *TOML, *TABLES, *PATHS, *NAMES)
