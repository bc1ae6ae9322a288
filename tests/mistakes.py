"""Mistakes that people make when they set up the reduction of cyclic tension tests.

Written from the documents and the example campaigns alone, without reading the checks of the tool.
Each mistake edits a copy of a campaign that comes with the project:

    prepare(m.of, raw, folder, m.keep)   # a small copy of the campaign, without the mistake
    m.change(folder)                     # the mistake

`visible` says, beforehand, what can show it: "data", "band", "statement" or "no". `words` are the
alternatives of fragments (lower case) of which a message has to hold one alternative whole, to have
named the cause: `names_the_cause(m, text)`. Only what the unchanged copy does not say is to be judged.
"""

# fmt: off
# one mistake after another reads best as its author wrote it

from __future__ import annotations

import itertools
import math
import re
import shutil
import tomllib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

CAMPAIGN = {"tether": "tmt-synthetic", "rope": "nylon-synthetic", "hose": "hose-synthetic"}
# tests that stay where a mistake does not ask for others; all with ("*",)
KEEP = {
    "tether": ("T-1", "T-2"),
    "rope": ("R02", "R04", "R13", "Q01"),
    "hose": ("S-64", "L-64", "S-68"),
}
ALL = ("*",)


@dataclass(frozen=True)
class Mistake:
    name: str
    of: str
    change: Callable[[Path], None]
    visible: str
    cause: str
    words: tuple[tuple[str, ...], ...]
    keep: tuple[str, ...] = ()  # tests that prepare() must leave; empty: KEEP


# ------------------------------------------------------------------ copies of the campaigns


def _sections(text: str) -> list[tuple[str, str]]:
    """Header ("" before the first) and text of each table, in order."""
    parts = re.split(r"(?m)^(?=\[)", text)
    out = []
    for part in parts:
        head = re.match(r"\[+([^\]]+)\]+", part)
        out.append((head.group(1).strip() if head else "", part))
    return out


def prepare(of: str, raw: Path, folder: Path, keep: tuple[str, ...] = ()) -> None:
    source = Path(raw) / CAMPAIGN[of]
    keep = keep or KEEP[of]
    text = (source / "campaign.toml").read_text(encoding="utf-8")
    tests = tomllib.loads(text)["tests"]
    kept = set(tests) if keep == ALL else set(keep)
    assert kept <= set(tests), kept - set(tests)
    whole = kept == set(tests)
    parsed = tomllib.loads(text)
    out = []
    for head, part in _sections(text):
        first, _, rest = head.partition(".")
        if first == "tests" and rest.partition(".")[0] not in kept:
            continue
        if first == "experiments" and not whole:
            continue
        if first == "comparisons" and not whole:
            measured = parsed["comparisons"][rest]["measured"]
            if measured not in kept or rest == "H64-too-many":
                continue
        out.append(part)
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "campaign.toml").write_text("".join(out), encoding="utf-8")
    for name in kept:
        shutil.copy(source / tests[name]["file"], folder)
    marks = source / "marks.csv"
    if marks.exists():
        lines = marks.read_text(encoding="utf-8").splitlines(keepends=True)
        rows = [line for line in lines[1:] if line.split(",")[0] in kept]
        (folder / "marks.csv").write_text(lines[0] + "".join(rows), encoding="utf-8")


def make(mistake: Mistake, raw: Path, folder: Path) -> None:
    prepare(mistake.of, raw, folder, mistake.keep)
    mistake.change(folder)


# ------------------------------------------------------------------ edits


def sub(folder: Path, old: str, new: str, *, file: str = "campaign.toml", times: int | None = None) -> None:
    path = folder / file
    text = path.read_text(encoding="utf-8")
    assert old in text, f"{file}: {old!r} is not there"
    assert times is None or text.count(old) == times, (file, old, text.count(old))
    assert old != new
    path.write_text(text.replace(old, new), encoding="utf-8")


def setkey(folder: Path, table: str, key: str, value: str | None, *, new: bool = False) -> None:
    """The value of a key of one table; None takes the line away, new adds a key that is not there."""
    path = folder / "campaign.toml"
    out, done = [], False
    for head, part in _sections(path.read_text(encoding="utf-8")):
        if head == table and not done:
            pattern = re.compile(rf"(?m)^{re.escape(key)} *=.*\n")
            found = pattern.search(part)
            if new:
                assert not found, f"{table}.{key} is there already"
                first, _, rest = part.partition("\n")
                part = f"{first}\n{key} = {value}\n{rest}"
            else:
                assert found, f"{table}.{key} is not there"
                line = "" if value is None else f"{key} = {value}\n"
                assert line != found.group(0)
                part = part[: found.start()] + line + part[found.end() :]
            done = True
        out.append(part)
    assert done, f"[{table}] is not there"
    path.write_text("".join(out), encoding="utf-8")


def droptable(folder: Path, table: str) -> None:
    path = folder / "campaign.toml"
    parts = _sections(path.read_text(encoding="utf-8"))
    left = [part for head, part in parts if head != table]
    assert len(left) < len(parts), f"[{table}] is not there"
    path.write_text("".join(left), encoding="utf-8")


class Log:
    """A log as text: comment lines, names, rows of cells."""

    def __init__(self, path: Path) -> None:
        self.path = path
        lines = path.read_text(encoding="utf-8").splitlines()
        self.comments = [line for line in lines if line.startswith("#")]
        body = [line for line in lines if line and not line.startswith("#")]
        self.names = body[0].split(",")
        self.rows = [line.split(",") for line in body[1:]]
        assert self.rows and all(len(row) == len(self.names) for row in self.rows)

    def column(self, name: str) -> list[float]:
        i = self.names.index(name)
        return [float(row[i]) for row in self.rows]

    def put(self, name: str, values: list, fmt: str = "{:.4f}") -> None:
        values = [v if isinstance(v, str) else fmt.format(v) for v in values]
        assert len(values) == len(self.rows)
        if name in self.names:
            i = self.names.index(name)
            assert any(row[i] != v for row, v in zip(self.rows, values, strict=True))
            for row, v in zip(self.rows, values, strict=True):
                row[i] = v
        else:
            self.names.append(name)
            for row, v in zip(self.rows, values, strict=True):
                row.append(v)

    def map(self, name: str, f: Callable[[float], float], fmt: str = "{:.4f}") -> None:
        self.put(name, [f(v) for v in self.column(name)], fmt)

    def rename(self, old: str, new: str) -> None:
        self.names[self.names.index(old)] = new

    def drop(self, name: str) -> None:
        i = self.names.index(name)
        del self.names[i]
        for row in self.rows:
            del row[i]

    def write(self, delimiter: str = ",") -> None:
        lines = [*self.comments, delimiter.join(self.names), *(delimiter.join(r) for r in self.rows)]
        self.path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def logs(folder: Path, only: tuple[str, ...] = ()) -> list[Log]:
    found = sorted(p for p in folder.glob("*.csv") if p.name != "marks.csv" and (not only or p.stem in only))
    assert found and (not only or len(found) == len(only)), only
    return [Log(p) for p in found]


def each(folder: Path, f: Callable[[Log], None], only: tuple[str, ...] = (), delimiter: str = ",") -> None:
    for log in logs(folder, only):
        f(log)
        log.write(delimiter)


BARE = {
    "time_s": "time",
    "crosshead_ft": "crosshead",
    "load_new_lb": "load_new",
    "load_used_lb": "load_used",
    "stroke_in": "stroke",
    "load_lbf": "load",
    "extensometer_pct": "extensometer",
    "flange_to_flange_in": "flange_to_flange",
}


def rename(folder: Path, names: dict[str, str]) -> None:
    """Columns of all logs and of the layout get other names. What a comment says of units goes too."""

    def f(log: Log) -> None:
        log.comments = ["# synthetic"]
        for old, new in names.items():
            if old in log.names:
                log.rename(old, new)

    each(folder, f)
    path = folder / "campaign.toml"
    text = path.read_text(encoding="utf-8")
    hits = 0
    for old, new in names.items():
        new = new.replace('""', "").strip('"')  # a quoted cell of a log
        hits += text.count(f'column = "{old}"')
        text = text.replace(f'column = "{old}"', f'column = "{new}"')
    assert hits
    path.write_text(text, encoding="utf-8")


def bare(folder: Path) -> None:
    """Headers that do not state their units."""
    names = logs(folder)[0].names
    rename(folder, {old: new for old, new in BARE.items() if old in names})


LOADS = {"tether": ("load_new", "load_used"), "rope": ("load",), "hose": ("load",)}


def scale(folder: Path, columns: tuple[str, ...], factor: float, fmt: str = "{:.4f}", only: tuple[str, ...] = ()) -> None:
    def f(log: Log) -> None:
        for name in columns:
            log.map(name, lambda v: v * factor, fmt)

    each(folder, f, only)


def declare(folder: Path, channel: str, old: str, new: str) -> None:
    """The unit that the layout declares of a channel."""
    path = folder / "campaign.toml"
    text = path.read_text(encoding="utf-8")
    pattern = re.compile(rf'(?m)^({re.escape(channel)} = \{{ column = [^,]+, unit = )"{re.escape(old)}"')
    assert len(pattern.findall(text)) == 1, (channel, old)
    path.write_text(pattern.sub(rf'\1"{new}"', text), encoding="utf-8")


def channel(folder: Path, name: str, value: str) -> None:
    path = folder / "campaign.toml"
    text = path.read_text(encoding="utf-8")
    pattern = re.compile(rf"(?m)^{re.escape(name)} = \{{.*\}}$")
    assert len(pattern.findall(text)) == 1, name
    path.write_text(pattern.sub(lambda _: f"{name} = {value}", text), encoding="utf-8")


def also(folder: Path, name: str, more: str) -> None:
    """Another key in the line of a channel."""
    path = folder / "campaign.toml"
    text = path.read_text(encoding="utf-8")
    pattern = re.compile(rf"(?m)^({re.escape(name)} = \{{.*) \}}$")
    assert len(pattern.findall(text)) == 1, name
    path.write_text(pattern.sub(lambda m: f"{m.group(1)}, {more} }}", text), encoding="utf-8")


def marks(folder: Path, f: Callable[[list[str], dict[str, int]], list[str] | None]) -> None:
    path = folder / "marks.csv"
    lines = path.read_text(encoding="utf-8").splitlines()
    at = {name: i for i, name in enumerate(lines[0].split(","))}
    rows = [f(line.split(","), at) for line in lines[1:]]
    text = "\n".join([lines[0], *(",".join(r) for r in rows if r)]) + "\n"
    assert text != path.read_text(encoding="utf-8")
    path.write_text(text, encoding="utf-8")


TAPE = ("near_toe_ft", "far_toe_ft", "far_thimble_ft")

# ------------------------------------------------------------------ words


def u(*names: str) -> tuple[str, ...]:
    """A short word, such as it stands in a message and not inside of another word."""
    out = []
    for n in names:
        out += [f"({n})", f"[{n}]", f"`{n}`", f"'{n}'", f'"{n}"']
        out += [f"{a}{n}{b}" for a in " _/" for b in " ,.;:)]`'\"?/\n"]
    return tuple(out)


# fragments that many other words hold (calibRATIOn, fLAG, pLATEau, geneRATEd, deSIGN, reCORD, triANGLE)
NARROW = {
    "ratio": (" ratio",),
    "rate": (" rate ", " rate,", " rate:", " rate=", " rate.", " rate)", " rate;", "`rate", "'rate'", '"rate"', ".rate", "(rate"),
    "sign": ("sign = ", "sign=", " sign ", " sign,", " sign.", " sign:", " sign;", "`sign", "'sign'", '"sign"', ".sign"),
    "lag": (" lag", "`lag", ".lag"),
    "late": (" late ", " late,", " late:", " late.", " late;", "later"),
    "row": (" row",),
    "plan": (" plan",),
    "angle": (" angle",),
    "cord": (" cord", ".cord", "`cord"),
    "pa": (" pa", "kpa", "mpa", "gpa"),
    "rad": (" rad ", "rad/s", "radian"),
    "pi": ("2 pi", "2pi", "6.28"),
    "date": (" date", "`date"),
    "ends": (" ends",),
    "fit": (" fit",),
    "mm": u("mm"),
    "ft": u("ft"),
    "mean": (" mean",),
    "lead": (" lead",),
    "rest": (" rest",),
    "steps": ("in steps", " steps"),
    "end": (" end",),
}


def say(*groups: str | tuple[str, ...]) -> tuple[tuple[str, ...], ...]:
    """One word of each group: all the alternatives."""
    wide = [(g,) if isinstance(g, str) else g for g in groups]
    narrow = [dict.fromkeys(n for w in g for n in NARROW.get(w, (w,))) for g in wide]
    return tuple(itertools.product(*narrow))


def names_the_cause(mistake: Mistake, text: str) -> bool:
    """Whether a message, or the new lines of an output, name the cause."""
    text = f" {text.lower()}\n"
    return any(all(w in text for w in alternative) for alternative in mistake.words)


LOAD = ("tension", "load", "force")
POS = ("crosshead", "position", "length", "travel", "stroke", "flange")
UNIT = ("unit", "declare", "header", "column")
N = (*u("n"), "newton")
KN = (*u("kn"), "kilonewton")
KGF = ("kgf", "kilogram")
LBF = ("lb", "pound")
M = (*u("m"), "metre", "meter")
IN = ("inch", *(w for w in u("in") if w != " in "), "in in")
FT = (*u("ft"), "feet", "foot")
MM = (*u("mm"), "millimet")
FACTOR = ("factor", "gain", "scal", "volt", "unit")
DIAMETER = ("diameter",)
RATIO = ("ratio", "times", "factor", "instead of", "disagree", "against", "states", "stated")
SHIFT = ("lag", "late", "delay", "shift", "behind", "filter", "synchron")
SLACK = ("zero", "offset")
SAME = ("same", "identical", "equal", "copy", "twice", "duplicate", "byte for byte")
SWAP = ("swap", "exchang", "interchang", "other way", "mixed up", "another test", "other test", "wrong file", "each other")

MISTAKES_: list[Mistake] = []


def mistake(name: str, of: str, visible: str, cause: str, words: tuple, keep: tuple[str, ...] = ()):
    def take(f: Callable[[Path], None]) -> Callable[[Path], None]:
        assert of in CAMPAIGN and visible in ("data", "band", "statement", "no")
        assert name not in {m.name for m in MISTAKES_}, name
        assert words and all(isinstance(w, tuple) and w and all(x == x.lower() for x in w) for w in words)
        MISTAKES_.append(Mistake(name, of, f, visible, cause, words, keep))
        return f

    return take


def add(name: str, of: str, visible: str, cause: str, words: tuple, *steps: Callable[[Path], None], keep: tuple[str, ...] = ()) -> None:
    def change(folder: Path) -> None:
        for step in steps:
            step(folder)

    mistake(name, of, visible, cause, words, keep)(change)


def do(f: Callable, *args, **kwargs) -> Callable[[Path], None]:
    return lambda folder: f(folder, *args, **kwargs)


# ================================================================== tethers
T = "tether"
NEW, USED = "tension.1", "tension.2"


def both(new: str, old: str = "lbf") -> Callable[[Path], None]:
    def f(folder: Path) -> None:
        declare(folder, NEW, old, new)
        declare(folder, USED, old, new)

    return f


def no_stretched(folder: Path) -> None:
    droptable(folder, "specimens.new.stretched_diameter")
    droptable(folder, "specimens.used.stretched_diameter")


def diameters(new: str, used: str) -> Callable[[Path], None]:
    def f(folder: Path) -> None:
        setkey(folder, "specimens.new", "diameter", f'["{new}"]')
        setkey(folder, "specimens.used", "diameter", f'["{used}"]')

    return f


# -- unit, gain and sign of the load
for unit, _word in (("N", N), ("kN", KN), ("kgf", KGF)):
    add(f"tether-lbf-declared-{unit.lower()}", T, "statement",
        f"The log is in pounds-force, as its header says (load_new_lb), and the layout declares {unit}.",
        say(LBF, UNIT), both(unit))
for unit, _word in (("N", N), ("kN", KN)):
    add(f"tether-lbf-declared-{unit.lower()}-bare-header", T, "band",
        f"The log is in pounds-force and the layout declares {unit}; the header does not say: the modulus lies outside that of rubber.",
        say(LOAD, FACTOR, LBF), bare, both(unit))
# 2.2 times is within what rubbers differ by; the peak of T-6 is then 113 % of the rated break strength
add("tether-lbf-declared-kgf-bare-header", T, "band",
    "The log is in pounds-force and the layout declares kgf: in T-6 the tether would carry more than its rated break strength.",
    say(LOAD, ("lb", "gain", "factor", "unit")) + say("break strength", ("unit", "gain", "factor", "lb")),
    bare, both("kgf"), keep=("T-1", "T-2", "T-6"))
# without T-6 a modulus of 2 MPa and 39 % of the break strength are those of a somewhat harder rubber
add("tether-lbf-declared-kgf-low-tests", T, "no",
    "The log is in pounds-force and the layout declares kgf; only low tests are there, so a harder rubber would look the same.",
    say(LOAD, LBF), bare, both("kgf"))
add("tether-kn-log-declared-lbf", T, "band",
    "The log is in kilonewtons, which its header does not say, and the layout declares lbf.",
    say(LOAD, KN) + say(LOAD, ("unit", "factor", "gain")),
    bare, do(scale, LOADS[T], 0.00444822, "{:.5f}"))
add("tether-n-log-declared-lbf", T, "band",
    "The log is in newtons, which its header does not say, and the layout declares lbf: T-6 would reach more than twice the rated break strength.",
    say(LOAD, N) + say(LOAD, ("unit", "factor", "gain")),
    bare, do(scale, LOADS[T], 4.44822, "{:.3f}"), keep=("T-1", "T-2", "T-6"))
add("tether-one-channel-declared-n", T, "statement",
    "The second tension channel is declared in N; its header says lb, as that of the first.",
    say(LBF, UNIT), do(declare, USED, "lbf", "N"))
add("tether-one-test-logged-in-n", T, "data",
    "The log of T-2 alone was exported in newtons: the stiffness of both specimens jumps by 4.4 from T-1 to T-2.",
    say(("t-2", "t-1"), ("stiff", "modulus", "spring"), ("jump", "times", "factor", "ratio", "unit")),
    bare, do(scale, LOADS[T], 4.44822, "{:.3f}", only=("T-2",)))
for name, heads, style in (
    ("underscore", ("Load_new_kN", "Load_used_kN"), "Load_kN"),
    ("slash", ("Kraft neu/kN", "Kraft alt/kN"), "Kraft/kN"),
    ("comma", ('"Load new, kN"', '"Load used, kN"'), "Load, kN"),
    ("in", ("F new in kN", "F used in kN"), "F in kN"),
    ("parentheses", ("load new (kN)", "load used (kN)"), "load (kN)"),
    ("brackets", ("load new [kN]", "load used [kN]"), "load [kN]"),
):
    add(f"tether-header-kn-{name}", T, "statement",
        f"The header states kN in the style `{style}`, and the layout declares lbf.",
        say(KN, (*UNIT, *LOAD)),
        do(rename, {"load_new_lb": heads[0], "load_used_lb": heads[1]}),
        lambda folder, heads=heads: scale_quoted(folder, heads, 0.00444822))


def scale_quoted(folder: Path, heads: tuple[str, ...], factor: float) -> None:
    """Loads of logs whose names may hold a comma between quotes."""
    for path in sorted(folder.glob("T-*.csv")):
        lines = path.read_text(encoding="utf-8").splitlines()
        out, seen = [], False
        for line in lines:
            if line.startswith("#"):
                out.append(line)
            elif not seen:
                assert all(h in line for h in heads), line
                seen = True
                out.append(line)
            else:
                cells = line.split(",")
                out.append(",".join(cells[:2] + [f"{float(c) * factor:.5f}" for c in cells[2:]]))
        path.write_text("\n".join(out) + "\n", encoding="utf-8")


@mistake("tether-unit-row-kn", T, "statement",
         "The row of units below the names states kN, and the layout declares lbf.", say(KN, (*UNIT, "row", *LOAD)))
def _(folder: Path) -> None:
    bare(folder)
    scale(folder, LOADS[T], 0.00444822, "{:.5f}")
    for log in logs(folder):
        log.rows.insert(0, ["s", "ft", "kN", "kN"])
        log.write()
    setkey(folder, "layouts.logger", "has_unit_row", "true", new=True)


@mistake("tether-unit-row-not-declared", T, "data",
         "Below the names stands a row of units which the layout does not declare.",
         say(("has_unit_row", "row of units", "unit row", "units row")))
def _(folder: Path) -> None:
    bare(folder)
    for log in logs(folder):
        log.rows.insert(0, ["s", "ft", "lbf", "lbf"])
        log.write()


add("tether-volts-not-scaled", T, "band",
    "The log holds volts of the load amplifier (100 lbf per volt) and the layout has no factor.",
    say(LOAD, FACTOR), bare, do(scale, LOADS[T], 0.01, "{:.5f}"))
add("tether-volts-in-header", T, "statement",
    "The header says V, and the layout declares lbf without a factor.",
    say((*u("v"), "volt"), (*UNIT, "factor", *LOAD)),
    do(rename, {"load_new_lb": "load_new_V", "load_used_lb": "load_used_V"}),
    do(scale, ("load_new_V", "load_used_V"), 0.01, "{:.5f}"))
add("tether-gain-2", T, "band",
    "The load amplifier was set to double gain: T-6 would reach more than the rated break strength.",
    say(LOAD, ("gain", "factor")) + say("break strength", ("gain", "factor")),
    bare, do(scale, LOADS[T], 2.0, "{:.3f}"), keep=("T-1", "T-2", "T-6"))
add("tether-gain-2-one-test", T, "data",
    "In T-2 the load amplifier was set to double gain: the stiffness of both specimens doubles from T-1 to T-2.",
    say(("t-2", "t-1"), ("stiff", "modulus", "spring"), ("jump", "times", "factor", "ratio", "gain")),
    do(scale, ("load_new_lb", "load_used_lb"), 2.0, "{:.3f}", only=("T-2",)))
add("tether-gain-2-one-channel-one-test", T, "data",
    "In T-2 the amplifier of the used tether alone was set to double gain.",
    say("used", ("stiff", "modulus", "spring"), ("jump", "times", "factor", "ratio", "gain")),
    do(scale, ("load_used_lb",), 2.0, "{:.3f}", only=("T-2",)))
add("tether-factor-10", T, "band",
    "The factor of the tension channels is ten times too large.",
    say(LOAD, ("factor", "gain", "unit")) + say("break strength", ("factor", "gain", "unit")),
    do(also, NEW, "factor = 10"), do(also, USED, "factor = 10"))
add("tether-factor-tenth", T, "band",
    "The factor of the tension channels is ten times too small.",
    say(LOAD, ("factor", "gain", "unit")),
    do(also, NEW, "factor = 0.1"), do(also, USED, "factor = 0.1"))
# five percent is less than two tethers of one batch differ by, and no statement speaks of it
@mistake("tether-gain-range-in-the-log", T, "data", "The amplifier was switched to another range between the holds and the cycles of T-1.",
         say(("load", "tension"), ("step", "jump"), ("range", "gain", "factor")))
def _range_in_the_log(folder: Path) -> None:
    def f(log: Log) -> None:
        start = log.column("time_s").index(348.8)  # the machine waits for the cycles
        for name in LOADS[T]:
            name = f"{name}_lb"
            log.put(name, [v * (1.1 if i >= start else 1) for i, v in enumerate(log.column(name))], "{:.3f}")

    each(folder, f, ("T-1",))


add("tether-gain-5-percent", T, "no",
    "The calibration of the load cell is five percent off in all tests.",
    say(LOAD, ("gain", "factor")), do(scale, ("load_new_lb", "load_used_lb"), 1.05, "{:.3f}"))
add("tether-load-sign", T, "data",
    "The frame logs tension as negative, and the layout does not say sign = -1.",
    say("sign", (*LOAD, "channel", "-1")), do(scale, ("load_new_lb", "load_used_lb"), -1.0, "{:.3f}"))
add("tether-load-sign-one-channel", T, "data",
    "The load cell of the used tether alone is wired with reversed polarity.",
    say("sign", ("used", "tension.2", "load_used")), do(scale, ("load_used_lb",), -1.0, "{:.3f}"))


def shift(amount: float, columns: tuple[str, ...], only: tuple[str, ...] = (), fmt: str = "{:.3f}") -> Callable[[Path], None]:
    def f(log: Log) -> None:
        for name in columns:
            log.map(name, lambda v: v + amount, fmt)

    return lambda folder: each(folder, f, only)


TL = ("load_new_lb", "load_used_lb")
add("tether-zero-minus-5", T, "data", "The slack tethers read -5 lbf: the zero of the load cells was not set.",
    say(SLACK, (*LOAD, "slack")), shift(-5, TL))
add("tether-zero-plus-20", T, "data", "The weight of the fixture was not tared: the slack tethers read 20 lbf.",
    say(SLACK, (*LOAD, "slack")), shift(20, TL))
add("tether-zero-wrong-sign", T, "data",
    "The slack tethers read 20 lbf and the layout takes off -20 lbf: the zero was declared with the wrong sign.",
    say("zero", (*LOAD, "slack", "sign")), shift(20, TL),
    do(also, NEW, 'zero = "-20 lbf"'), do(also, USED, 'zero = "-20 lbf"'))


@mistake("tether-zero-drift", T, "data", "The zero of the load cell drifts by 30 lbf during a test: slack reads more after the cycles than before.",
         say(("zero", "slack"), ("drift", "before and after", "changes", "begin", "start", "first", "differ")))
def _(folder: Path) -> None:
    def f(log: Log) -> None:
        n = len(log.rows) - 1
        for name in TL:
            log.put(name, [v + 30 * i / n for i, v in enumerate(log.column(name))], "{:.3f}")

    each(folder, f)


@mistake("tether-load-saturated", T, "data", "The amplifier ends at 100 lbf: the peaks of the load are cut off.",
         say(("saturat", "clip", "limit of the range", "full scale", "cut off", "flat")))
def _(folder: Path) -> None:
    each(folder, lambda log: [log.map(n, lambda v: min(v, 100.0), "{:.3f}") for n in TL])


def lowpass(log: Log, columns: tuple[str, ...], tau: float, fmt: str, time: str = "time_s") -> None:
    t = log.column(time)
    for name in columns:
        x = log.column(name)
        y = [x[0]]
        for i in range(1, len(x)):
            y.append(y[-1] + (x[i] - y[-1]) * (1 - math.exp(-(t[i] - t[i - 1]) / tau)))
        log.put(name, y, fmt)


def late(log: Log, columns: tuple[str, ...], rows: int) -> None:
    for name in columns:
        i = log.names.index(name)
        cells = [row[i] for row in log.rows]
        log.put(name, [cells[0]] * rows + cells[:-rows])


@mistake("tether-load-filter-3s", T, "data",
         "A filter of 3 s stood in the load channel: the load comes after the position, with rounded peaks.",
         say(LOAD, SHIFT))
def _(folder: Path) -> None:
    each(folder, lambda log: lowpass(log, TL, 3.0, "{:.3f}"))


@mistake("tether-load-late-500ms", T, "data", "The load is logged 0.5 s after the position: it turns after the crosshead has turned.",
         say(LOAD, SHIFT))
def _(folder: Path) -> None:
    each(folder, lambda log: late(log, TL, 5))


# one sample of 10 Hz; the corner of a triangle shows it, five times the lag that the campaign states
@mistake("tether-load-late-100ms", T, "data", "The load is logged one sample (0.1 s) after the position, five times the stated lag.",
         say(LOAD, SHIFT))
def _(folder: Path) -> None:
    each(folder, lambda log: late(log, TL, 1))


@mistake("tether-position-late-1s", T, "data", "The position comes through a slow display, 1 s after the load.",
         say((*POS, *LOAD), (*SHIFT, "ahead", "before", "lead", "early")))
def _(folder: Path) -> None:
    each(folder, lambda log: late(log, ("crosshead_ft",), 10))


# -- numbers and files
def as_comma(log: Log) -> None:
    log.rows = [[c.replace(".", ",") for c in row] for row in log.rows]


add("tether-thousands-comma", T, "data",
    "`0,244` has a decimal comma and the layout calls the comma a thousands mark: loads are 1,000 times too large.",
    say(("decimal", "thousands"), ("comma", '","', "0,244", "`,`")),
    do(each, as_comma, delimiter=";"), do(setkey, "layouts.logger", "delimiter", '";"'),
    do(setkey, "layouts.logger", "thousands", '","', new=True))
add("tether-thousands-point", T, "data",
    "`0.244` has a decimal point and the layout calls the point a thousands mark.",
    say(("decimal", "thousands"), ("point", '"."', "0.244", "12.2559", "`.`")),
    do(setkey, "layouts.logger", "thousands", '"."', new=True), do(setkey, "layouts.logger", "decimal", '","', new=True))
add("tether-decimal-comma", T, "data", "The log has decimal commas, which the layout does not declare.",
    say("decimal", ("comma", '","', "`,`")),
    do(each, as_comma, delimiter=";"), do(setkey, "layouts.logger", "delimiter", '";"'))
add("tether-decimal-comma-and-delimiter", T, "data",
    "Decimal commas in a log whose cells are also separated by commas: every row has more cells than the header.",
    say(("decimal", "delimiter", "fields"), ("comma", '","', "fields", "`,`")), do(each, as_comma))
add("tether-delimiter", T, "data", "The cells are separated by semicolons and the layout says comma.",
    say(("delimiter", "semicolon", "parted")), do(each, lambda log: None, delimiter=";"))


@mistake("tether-second-header", T, "data", "The logger was started again in the middle and wrote its header a second time.",
         say(("header", "name row", "names"), ("second", "again", "repeat", "twice", "another", "row")))
def _(folder: Path) -> None:
    log = logs(folder, ("T-1",))[0]
    log.rows.insert(len(log.rows) // 2, list(log.names))
    log.write()


@mistake("tether-preamble", T, "data", "Three lines of the logger stand above the names, which the layout does not declare.",
         say(("preamble", "comment")))
def _(folder: Path) -> None:
    for log in logs(folder):
        log.comments = ["Logger 7", "Operator: AG", "Rate: 10 Hz"]
        log.write()


@mistake("tether-overflow-text", T, "data", "Where the amplifier was overloaded the logger wrote OVRFLW.",
         say("ovrflw", ("missing", "number")))
def _(folder: Path) -> None:
    log = logs(folder, ("T-1",))[0]
    i = log.names.index("load_new_lb")
    for row in log.rows[3000:3010]:
        row[i] = "OVRFLW"
    log.write()


@mistake("tether-missing-9999", T, "data", "The logger writes -9999 where it has no value, and the layout does not declare it.",
         say("9999") + say("missing", ("mark", "drop", "value")) + say(("spike", "drop-out"), LOAD))
def _(folder: Path) -> None:
    log = logs(folder, ("T-1",))[0]
    i = log.names.index("load_new_lb")
    for row in log.rows[100::400]:
        row[i] = "-9999"
    log.write()


@mistake("tether-encoding", T, "data", "The log is in Latin-1 (a degree sign in a comment) and is read as UTF-8.",
         say(("encoding", "utf-8", "latin")))
def _(folder: Path) -> None:
    path = folder / "T-1.csv"
    path.write_bytes("# Temperatur 21 °C\n".encode("latin-1") + path.read_bytes())


add("tether-column-misspelt", T, "statement", "The layout names a column that the log does not have.",
    say("load_new_lbf", ("column", "no ", "not")), do(sub, '"load_new_lb"', '"load_new_lbf"', times=1))


@mistake("tether-truncated", T, "statement", "The file of T-1 was cut in the middle of the cycles: fewer cycles than stated.",
         say(("n_cycles", "cycles"), ("n_cycles", "stated", "fewer", "expected", "plan")))
def _(folder: Path) -> None:
    log = logs(folder, ("T-1",))[0]
    log.rows = log.rows[:3720]
    log.write()


@mistake("tether-duplicated-block", T, "data", "A block of 300 rows was pasted twice: time runs backward.",
         say("time", ("backward", "repeat", "again", "earlier", "base", "not later")))
def _(folder: Path) -> None:
    log = logs(folder, ("T-1",))[0]
    log.rows = log.rows[:4000] + log.rows[3700:4000] + log.rows[4000:]
    log.write()


@mistake("tether-gap", T, "data", "Two minutes of the log are missing.", say(("gap", "missing rows")) + say("time", ("step", "jump")))
def _(folder: Path) -> None:
    log = logs(folder, ("T-1",))[0]
    del log.rows[2600:3800]
    log.write()


@mistake("tether-sorted-by-position", T, "data", "A spreadsheet sorted the rows by position: time jumps back and forth.",
         say("time", ("backward", "sort", "order", "repeat", "base", "again", "earlier", "not later")))
def _(folder: Path) -> None:
    log = logs(folder, ("T-1",))[0]
    log.rows.sort(key=lambda row: float(row[1]))
    log.write()


@mistake("tether-one-sample-in-40", T, "data", "The logger kept one row every 4 s: two or three samples per cycle.",
         say(("sample", "rows", "rate", "points"), ("cycle", "coarse", "few", "slow")))
def _(folder: Path) -> None:
    each(folder, lambda log: setattr(log, "rows", log.rows[::40]))


add("tether-same-log-twice", T, "statement", "T-2 names the file of T-1.",
    say(("t-1", "t-2"), SAME), do(sub, 'file = "T-2.csv"', 'file = "T-1.csv"', times=1))


@mistake("tether-same-log-exported-twice", T, "data", "T-2.csv is T-1 once more, exported with another start of time.",
         say(("t-1", "t-2"), SAME))
def _(folder: Path) -> None:
    shutil.copy(folder / "T-1.csv", folder / "T-2.csv")
    each(folder, lambda log: log.map("time_s", lambda v: v + 1000, "{:.1f}"), ("T-2",))


@mistake("tether-files-swapped", T, "statement", "The files of T-1 and T-2 were swapped: both contradict target_strain and the tape.",
         say(SWAP) + say(("t-1", "t-2"), "target_strain") + say("t-1", "t-2", ("fit", "tape", "marks")))
def _(folder: Path) -> None:
    sub(folder, 'file = "T-1.csv"', 'file = "X.csv"', times=1)
    sub(folder, 'file = "T-2.csv"', 'file = "T-1.csv"', times=1)
    sub(folder, 'file = "X.csv"', 'file = "T-2.csv"', times=1)


# -- channels
add("tether-one-column-for-both", T, "statement", "Both tension channels name one column.",
    say(("load_new", "tension.1", "tension.2", "channel", "column"), (*SAME, "both")),
    do(sub, '"load_used_lb"', '"load_new_lb"', times=1))


@mistake("tether-identical-channels", T, "data", "Both columns of the log hold the signal of one load cell.",
         say(("load_new", "load_used", "tension.1", "tension.2", "tension", "channel", "column", "specimens"), SAME))
def _(folder: Path) -> None:
    each(folder, lambda log: log.put("load_used_lb", [row[log.names.index("load_new_lb")] for row in log.rows]))


@mistake("tether-new-and-used-swapped", T, "statement",
         "The columns of the new and the used tether were swapped: the column of `new` is called load_used.",
         say(("load_new", "load_used", "column"), (*SWAP, "new", "used"), ("specimen", *SWAP)))
def _(folder: Path) -> None:
    sub(folder, '"load_used_lb"', '"X"', times=1)
    sub(folder, '"load_new_lb"', '"load_used_lb"', times=1)
    sub(folder, '"X"', '"load_new_lb"', times=1)


# both tethers are of one rubber and have nearly one stiffness; no header says which is which
@mistake("tether-specimens-swapped-bare-header", T, "no",
         "The order of the specimens is not that of the load cells, and the columns are called load_1 and load_2.",
         say(("specimen", "new", "used"), SWAP))
def _(folder: Path) -> None:
    rename(folder, {"load_new_lb": "load_1_lb", "load_used_lb": "load_2_lb"})
    sub(folder, 'specimens = ["new", "used"]', 'specimens = ["used", "new"]', times=1)


# 12 % up in one tether and 12 % down in the other is what rest and softening do from test to test
@mistake("tether-cables-swapped-in-one-test", T, "no", "In T-2 the cables of the two load cells were swapped.",
         say(("t-1", "t-2"), SWAP))
def _(folder: Path) -> None:
    def f(log: Log) -> None:
        i, j = (log.names.index(n) for n in TL)
        for row in log.rows:
            row[i], row[j] = row[j], row[i]

    each(folder, f, ("T-2",))


add("tether-one-specimen-named-twice", T, "statement", "Both load cells are assigned to the specimen `new`.",
    say(("new", "specimen"), (*SAME, "two", "both", "once", "more than")),
    do(sub, 'specimens = ["new", "used"]', 'specimens = ["new", "new"]', times=1))


@mistake("tether-load-and-position-swapped", T, "statement",
         "The load column is declared as position and the position column as load: both headers say another unit.",
         say(("crosshead_ft", "load_new_lb", *POS), (*UNIT, *SWAP, "ft", "lb"), ("ft", "lb", *SWAP)))
def _(folder: Path) -> None:
    sub(folder, '"crosshead_ft"', '"X"', times=1)
    sub(folder, '"load_new_lb"', '"crosshead_ft"', times=1)
    sub(folder, '"X"', '"load_new_lb"', times=1)


@mistake("tether-load-and-position-swapped-bare-header", T, "data",
         "The load column is declared as position and the position column as load: lengths fall below zero, the load does not at slack.",
         say(POS, ("below", "zero", "negative", *SWAP, "pin-to-pin"), ("length", "column", *SWAP, "load", "pin-to-pin")))
def _(folder: Path) -> None:
    rename(folder, {"crosshead_ft": "ch1", "load_new_lb": "ch2", "load_used_lb": "ch3", "time_s": "t"})
    swap_lines(folder, '"ch1"', '"ch2"')


@mistake("tether-counter-as-tension", T, "data", "The column of the cycle counter is declared as the tension of the used tether.",
         say(("tension.2", "used", "cycle", "load"), ("counter", "whole number", "does not follow", "correlat", "steps", "never falls", "monoton", "stuck", "does not rise", "not depend", "does not move", "integer")))
def _(folder: Path) -> None:
    def f(log: Log) -> None:
        t = log.column("time_s")
        log.put("count", [f"{max(0, min(11, int((v - 335) / 9.52) + 1)) if v > 335 else 0}" for v in t])

    each(folder, f)
    sub(folder, '"load_used_lb"', '"count"', times=1)


add("tether-time-as-tension", T, "statement", "The time column is declared as the tension of the used tether; its header says s.",
    say(("time_s", "time"), (*UNIT, "tension", "same", "both", "twice")), do(sub, '"load_used_lb"', '"time_s"', times=1))
# without a header that says so, the position asked for differs from the one reached by less than the noise
@mistake("tether-command-as-position", T, "no", "The column of the commanded position is taken for the measured one.", say(POS, ("command", "set point", "setpoint")))
def _(folder: Path) -> None:
    def f(log: Log) -> None:
        x = log.column("crosshead_ft")
        log.put("crosshead_ft", [sum(x[max(0, i - 1) : i + 2]) / len(x[max(0, i - 1) : i + 2]) for i in range(len(x))])

    each(folder, f)


# -- position
for unit, _word in (("m", M), ("in", IN)):
    add(f"tether-position-ft-declared-{unit}", T, "statement",
        f"The position is in feet, as its header says (crosshead_ft), and the layout declares {unit}.",
        say((*POS, "tape"), FT), do(declare, "crosshead_position", "ft", unit))
add("tether-position-ft-declared-m-bare-header", T, "statement",
    "The position is in feet and the layout declares m: the tape contradicts it.",
    say((*POS, "tape"), (*FT, *M, "unit", "factor")), bare, do(declare, "crosshead_position", "ft", "m"))
add("tether-header-position-mm", T, "statement", "The header says `Weg/mm`, and the layout declares ft.",
    say(MM, (*POS, *UNIT, "weg")), do(rename, {"crosshead_ft": "Weg/mm"}), do(scale, ("Weg/mm",), 304.8, "{:.2f}"))
add("tether-position-and-tape-in-m", T, "statement",
    "Position and tape are in feet and both are declared m: strains are right, the rate is 3.3 times that stated.",
    say("rate", (*RATIO, "ft/s", "m/s")), bare, do(declare, "crosshead_position", "ft", "m"),
    do(sub, "near_toe_ft,far_toe_ft,far_thimble_ft", "near_toe_m,far_toe_m,far_thimble_m", file="marks.csv"))
add("tether-displacement-as-pin-to-pin", T, "data",
    "The log holds travel from slack, and the layout calls it the distance of the pins.",
    say(POS, ("displacement", "datum", "pin-to-pin", "zero")), shift(-12.2559, ("crosshead_ft",), fmt="{:.4f}"))
add("tether-pin-to-pin-as-displacement", T, "statement",
    "The log holds the distance of the pins, and the layout calls it travel from 12.26 ft.",
    say(POS, ("displacement", "datum", "pin-to-pin", "zero", "reference_length")),
    do(sub, 'datum = "pin-to-pin"', 'datum = "displacement", reference_length = "12.26 ft"', times=1))
add("tether-reference-length-10in-off", T, "statement",
    "The reference length of the travel is ten inches short of the tape.",
    say(("reference_length", *POS), ("zero", "reference_length", "tape", "marks")),
    shift(-12.2559, ("crosshead_ft",), fmt="{:.4f}"),
    do(sub, 'datum = "pin-to-pin"', 'datum = "displacement", reference_length = "11.42 ft"', times=1))
add("tether-position-sign", T, "data", "Position falls as the tether is stretched: the travel is logged with the other sign.",
    say(POS, "sign"), do(each, lambda log: log.map("crosshead_ft", lambda v: 12.2559 - v)),
    do(sub, 'datum = "pin-to-pin"', 'datum = "displacement", reference_length = "12.26 ft"', times=1))
add("tether-position-doubled", T, "statement", "The string of the position sensor runs over a loose pulley: it moves half as far, and the factor 2 was forgotten.",
    say((*POS, "tape"), ("factor", "scal", "ratio", "times", "unit", "gain", "half")),
    do(each, lambda log: log.map("crosshead_ft", lambda v: 12.2559 + (v - 12.2559) / 2)))


@mistake("tether-encoder-wrap", T, "data", "The position encoder wraps at 22 ft: the position jumps by 16 ft and back.",
         say(POS, ("jump", "step", "wrap", "encoder", "spike", "slack")))
def _(folder: Path) -> None:
    each(folder, lambda log: log.map("crosshead_ft", lambda v: v - 16 if v > 22 else v))


@mistake("tether-encoder-lost-counts", T, "data", "The encoder lost counts in the middle of the cycles: position steps by 2 ft and stays there.",
         say(POS, ("step", "jump", "zero", "slip", "drift", "slack")))
def _(folder: Path) -> None:
    def f(log: Log) -> None:
        x = log.column("crosshead_ft")
        log.put("crosshead_ft", [v + (2.0 if i > 3850 else 0.0) for i, v in enumerate(x)])

    each(folder, f, ("T-1",))


add("tether-position-dead", T, "data", "The position sensor was not connected: its column holds one value.",
    say(POS, ("stuck", "constant", "one value", "does not move", "same value", "not move", "never", "equal")),
    do(each, lambda log: log.put("crosshead_ft", ["12.2559"] * len(log.rows))))
add("tether-load-dead", T, "data", "The load cell of the used tether was not connected: its column holds one value.",
    say(("tension.2", "used", "tension"), ("stuck", "constant", "one value", "zero", "same value", "throughout")),
    do(each, lambda log: log.put("load_used_lb", ["0.244"] * len(log.rows))))

# -- time
TIME = ("time", "rate", "clock", "sample_interval")
add("tether-time-minutes", T, "statement", "The time is in minutes and the layout declares s: the crosshead would move at 60 times its stated rate.",
    say(TIME, ("minute", *u("min"), "unit", "60", "ratio", "times")), bare,
    do(each, lambda log: log.map("time", lambda v: v / 60, "{:.6f}")))
add("tether-time-ms", T, "statement", "The time is in milliseconds and the layout declares s: the crosshead would move at a thousandth of its stated rate.",
    say(TIME, (*u("ms"), "millisecond", "unit", "0.001", "1000", "ratio", "times")), bare,
    do(each, lambda log: log.map("time", lambda v: v * 1000, "{:.0f}")))
add("tether-time-ms-in-header", T, "statement", "The header says time_ms, and the layout declares s.",
    say((*u("ms"), "millisecond"), (*UNIT, "time")), do(rename, {"time_s": "time_ms"}),
    do(each, lambda log: log.map("time_ms", lambda v: v * 1000, "{:.0f}")))


@mistake("tether-sample-interval", T, "statement", "The log has no time column and the layout states 1 s between rows; it was 0.1 s: the rate is a tenth of that stated.",
         say(TIME, ("rate", "sample_interval", "interval", "times", "ratio")))
def _(folder: Path) -> None:
    each(folder, lambda log: log.drop("time_s"))
    sub(folder, 'time = { column = "time_s", unit = "s" }\n', "", times=1)
    setkey(folder, "layouts.logger", "sample_interval", '"1 s"', new=True)
    # a comment of the log says 10 Hz; take it away, loggers seldom have it
    each(folder, lambda log: setattr(log, "comments", ["# synthetic"]))


def stamp(seconds: float, date: bool) -> str:
    s = 9 * 3600 + 45 * 60 + seconds
    h, m, r = int(s // 3600), int(s // 60) % 60, s % 60
    return (f"2026-02-23 {h:02d}:{m:02d}:{r:04.1f}") if date else f"{h:02d}:{m:02d}:{r:04.1f}"


add("tether-dates-as-time", T, "data", "The time column holds dates and times of day, and the layout says seconds.",
    say(("clock", "date", "time of day")), do(each, lambda log: log.put("time_s", [stamp(v, True) for v in log.column("time_s")])))
add("tether-clock-as-seconds", T, "data", "The time column holds times of day, and the layout says seconds.",
    say(("clock", "time of day")), do(each, lambda log: log.put("time_s", [stamp(v, False) for v in log.column("time_s")])))


@mistake("tether-time-starts-again", T, "data", "The logger was started again in the middle: time begins with zero a second time.",
         say("time", ("again", "two time bases", "backward", "restart", "bases")))
def _(folder: Path) -> None:
    each(folder, lambda log: log.put("time_s", [v if i < 4000 else v - 400.0 for i, v in enumerate(log.column("time_s"))], "{:.1f}"), ("T-1",))


# -- diameters
ST = say(DIAMETER, ("stretched", "constant volume", "constant-volume", "volume"))
DI = say(DIAMETER, ("radius", "half", "double", "twice", "modulus", "unit", "factor", "mm", "inch", "circumference"))
add("tether-radius-as-diameter", T, "statement", "The radius was entered as the diameter; the diameters on the stretched tethers contradict it.", ST + DI, diameters("0.52 in", "0.47 in"))
add("tether-double-diameter", T, "statement", "Twice the diameter was entered; the diameters on the stretched tethers contradict it.", ST + DI, diameters("2.08 in", "1.88 in"))
add("tether-diameter-mm-for-in", T, "statement", "`1.04 mm` was entered for 1.04 in; the diameters on the stretched tethers contradict it.", ST + say(DIAMETER, ("unit", *MM, *IN)), diameters("1.04 mm", "0.94 mm"))
add("tether-radius-as-diameter-alone", T, "band", "The radius was entered as the diameter, and nothing else is known of the size: a modulus four times that of a tether's rubber.", DI, no_stretched, diameters("0.52 in", "0.47 in"))
add("tether-double-diameter-alone", T, "band", "Twice the diameter was entered, and nothing else is known of the size: a quarter of the modulus of a tether's rubber.", DI, no_stretched, diameters("2.08 in", "1.88 in"))
add("tether-diameter-mm-for-in-alone", T, "band", "`1.04 mm` was entered for 1.04 in: a rubber of 600 MPa.", DI, no_stretched, diameters("1.04 mm", "0.94 mm"))
add("tether-diameter-cm-for-in", T, "band", "`1.04 cm` was entered for 1.04 in: a modulus 6.5 times that of a tether's rubber.", DI, no_stretched, diameters("1.04 cm", "0.94 cm"))
add("tether-circumference-as-diameter", T, "band", "The circumference was entered as the diameter: a tenth of the modulus of a tether's rubber.", DI, no_stretched, diameters("3.27 in", "2.95 in"))
add("tether-stretched-diameter-as-rest", T, "statement", "The diameter at 100 % stretch was entered as that before stretch; the stretched readings contradict it.", ST, diameters("0.73 in", "0.655 in"))
add("tether-diameters-of-each-other", T, "statement", "New and used tether have each other's diameter; the stretched readings contradict both.", ST + say(DIAMETER, SWAP), diameters("0.94 in", "1.04 in"))
# 1.23 times the modulus of the one and 0.82 of the other: less than tethers of one batch differ by
add("tether-diameters-of-each-other-alone", T, "no", "New and used tether have each other's diameter, and nothing else is known of the size.", say(DIAMETER, SWAP), no_stretched, diameters("0.94 in", "1.04 in"))
add("tether-diameter-typing-slip", T, "statement", "One of three readings of the diameter is ten times the others.",
    say(DIAMETER, ("reading", "10.4", "differ", "other", "scatter", "spread", "stretched", "volume")),
    do(setkey, "specimens.new", "diameter", '["1.04 in", "10.4 in", "1.03 in"]'))
add("tether-stretch-of-readings-swapped", T, "statement", "The diameters at 10 % and at 100 % stretch stand under each other's stretch.",
    say(DIAMETER, ("stretched", "volume", "10 %", "100 %")),
    do(sub, '"10 %" = ["0.997', '"X" = ["0.997', times=1), do(sub, '"100 %" = ["0.725', '"10 %" = ["0.725', times=1),
    do(sub, '"X" = ["0.997', '"100 %" = ["0.997', times=1))

# -- marks
MARK = ("marks", "mark ", "tape", "row")


def reorder(order: tuple[str, str, str]) -> Callable[[Path], None]:
    def f(row: list[str], at: dict[str, int]) -> list[str]:
        old = [row[at[n]] for n in order]
        for n, v in zip(TAPE, old, strict=True):
            row[at[n]] = v
        return row

    return lambda folder: marks(folder, f)


add("tether-marks-toes-swapped", T, "statement", "The columns of the near and the far toe are swapped in marks.csv.",
    say(("near_toe", "near toe"), (*SWAP, "rise", "<", "order", "column")), reorder(("far_toe_ft", "near_toe_ft", "far_thimble_ft")))
add("tether-marks-toe-and-thimble-swapped", T, "statement", "The columns of the far toe and the far thimble are swapped in marks.csv.",
    say(("far_toe", "far toe", "thimble"), (*SWAP, "rise", "<", "order", "column")), reorder(("near_toe_ft", "far_thimble_ft", "far_toe_ft")))


def retape(factor: float, digits: int = 2) -> Callable[[Path], None]:
    def f(row: list[str], at: dict[str, int]) -> list[str]:
        for n in TAPE:
            row[at[n]] = f"{float(row[at[n]]) * factor:.{digits}f}"
        return row

    return lambda folder: marks(folder, f)


add("tether-marks-inches-as-feet", T, "statement", "The tape was read in inches and the headers say feet.",
    say(MARK, (*IN, "unit"), ("unit", "fit", "header", "factor", "thimble")), retape(12, 1))
add("tether-marks-metres-as-feet", T, "statement", "The tape was read in metres and the headers say feet.",
    say(MARK, (*M, "unit"), ("unit", "fit", "header", "factor", "thimble")), retape(0.3048, 3))
add("tether-marks-feet-as-inches-header", T, "statement", "The header of marks.csv says inches and the readings are in feet.",
    say(MARK, (*FT, "unit")), do(sub, "near_toe_ft,far_toe_ft,far_thimble_ft", "near_toe_in,far_toe_in,far_thimble_in", file="marks.csv"))


def wrong_eye(row: list[str], at: dict[str, int]) -> list[str]:
    near, far, thimble = (float(row[at[n]]) for n in TAPE)
    row[at["near_toe_ft"]], row[at["far_toe_ft"]] = f"{thimble - far:.2f}", f"{thimble - near:.2f}"
    return row


# the free length is the difference of the toes: it is the same from either eye, and nothing goes wrong
add("tether-marks-from-the-other-eye", T, "no", "All tape readings were taken from the far thimble.", say(MARK, ("near", "eye", "thimble")), do(marks, wrong_eye))


@mistake("tether-marks-digits-swapped", T, "statement", "In one row of the marks two digits are swapped: 19.84 for 19.48 ft at the far toe.",
         say(MARK, ("centre", "far_toe", "far toe", "19.84")))
def _(folder: Path) -> None:
    sub(folder, "T-1,new,centre,100,2.56,19.48,21.75", "T-1,new,centre,100,2.56,19.84,21.75", file="marks.csv", times=1)


@mistake("tether-marks-slack-read-late", T, "statement", "The row `slack` of a test was read when the tether already was stretched.",
         say("slack", (*MARK, "thimble")))
def _(folder: Path) -> None:
    sub(folder, "T-1,new,slack,0,2.06,10.43,12.26", "T-1,new,slack,0,2.46,17.2,19.37", file="marks.csv", times=1)


# the toes of the two tethers differ by a few hundredths of a foot: one percent of strain
@mistake("tether-marks-of-the-other-tether", T, "no", "The marks of the new and the used tether are entered under each other's name.", say(MARK, SWAP))
def _(folder: Path) -> None:
    def f(row: list[str], at: dict[str, int]) -> list[str]:
        i = at["specimen"]
        row[i] = {"new": "used", "used": "new"}[row[i]]
        return row

    marks(folder, f)


@mistake("tether-marks-of-the-other-test", T, "statement", "The marks of T-1 and T-2 are entered under each other's name: no hold of the log lies where they do.",
         say(MARK, ("hold", "position", "crosshead", "t-1", "t-2")))
def _(folder: Path) -> None:
    def f(row: list[str], at: dict[str, int]) -> list[str]:
        i = at["test"]
        row[i] = {"T-1": "T-2", "T-2": "T-1"}[row[i]]
        return row

    marks(folder, f)


@mistake("tether-marks-of-a-longer-tether", T, "statement", "The marks are those of a tether two feet longer: slack, its thimble stands where the crosshead never was.",
         say((*MARK, "thimble"), (*POS, "thimble", "zero")))
def _(folder: Path) -> None:
    def f(row: list[str], at: dict[str, int]) -> list[str]:
        for n in ("far_toe_ft", "far_thimble_ft"):
            row[at[n]] = f"{float(row[at[n]]) + 2:.2f}"
        return row

    marks(folder, f)


add("tether-marks-test-misspelt", T, "statement", "marks.csv calls the tests T1 and T2.", say(("t1",), (*MARK, "test")),
    do(sub, "T-1,", "T1,", file="marks.csv"))
add("tether-marks-semicolons", T, "data", "A spreadsheet wrote marks.csv with semicolons.",
    say("marks", ("delimiter", "semicolon", "comma", "parted", "column")), do(sub, ",", ";", file="marks.csv"))


# -- gauge length, extensometer
def by_gauge(new: str, used: str) -> Callable[[Path], None]:
    def f(folder: Path) -> None:
        sub(folder, 'strain = { marks = "marks.csv" }', 'strain = { method = "gauge-length" }', times=1)
        (folder / "marks.csv").unlink()
        setkey(folder, "specimens.new", "gauge_length", f'"{new}"', new=True)
        setkey(folder, "specimens.used", "gauge_length", f'"{used}"', new=True)

    return f


GAUGE = ("gauge_length", "gauge length", "gauge")
add("tether-gauge-eye-to-eye", T, "statement", "The gauge length is that from eye to eye, splices and all: it equals the distance of the pins at slack, and the strain reached is 0.77 of target_strain.",
    say(GAUGE, ("eye", "splice", "pin-to-pin", "thimble", "target_strain")), by_gauge("12.26 ft", "12.25 ft"))
add("tether-gauge-times-10", T, "statement", "The gauge length has its decimal point in the wrong place: it is longer than the machine holds, and the strain is a tenth of target_strain.",
    say((*GAUGE, "target_strain"), ("10", "factor", "ratio", "times", "longer", "pin-to-pin", "target_strain")), by_gauge("83.7 ft", "83.4 ft"))
add("tether-gauge-m-for-ft", T, "statement", "`8.37 m` was entered for 8.37 ft: longer than the distance of the pins at slack.",
    say((*GAUGE, "target_strain"), (*M, "unit", "longer", "pin-to-pin", "factor", "ratio", "target_strain")), by_gauge("8.37 m", "8.34 m"))
add("tether-gauge-in-for-ft", T, "statement", "`8.37 in` was entered for 8.37 ft: strain is twelve times target_strain.",
    say((*GAUGE, "target_strain"), ("unit", "ft", "factor", "ratio", "times", "target_strain")), by_gauge("8.37 in", "8.34 in"))


def extensometer(factor: float, offset: float, unit: str) -> Callable[[Path], None]:
    """Columns of an extensometer, bare of units, in percent times factor plus offset."""

    def f(folder: Path) -> None:
        def g(log: Log) -> None:
            x = log.column("crosshead_ft")
            for n, gauge in (("ext_new", 8.37), ("ext_used", 8.34)):
                log.put(n, [factor * 90.0 * (v - 12.2559) / gauge + offset for v in x], "{:.5f}")

        each(folder, g)
        sub(folder, 'strain = { marks = "marks.csv" }', 'strain = { method = "extensometer" }', times=1)
        (folder / "marks.csv").unlink()
        setkey(folder, "layouts.logger.channels", "strain.1", f'{{ column = "ext_new", unit = "{unit}" }}', new=True)
        setkey(folder, "layouts.logger.channels", "strain.2", f'{{ column = "ext_used", unit = "{unit}" }}', new=True)

    return f


EXT = ("extensometer", "strain")
add("tether-extensometer-pct-as-mm-per-m", T, "statement", "The extensometer is in percent and declared mm/m: strain is a tenth of target_strain.",
    say(EXT, ("unit", "%", "percent", "per cent", "mm/m"), ("target_strain", "unit", "declared", "ratio", "factor", "times")), extensometer(1, 0, "mm/m"))
add("tether-extensometer-fraction-as-pct", T, "statement", "The extensometer is in m/m and declared percent: strain is a hundredth of target_strain.",
    say(EXT, ("target_strain", "unit", "declared", "ratio", "factor", "times")), extensometer(0.01, 0, "%"))
add("tether-extensometer-set-to-zero-at-preload", T, "data", "The extensometer was set to zero at a stretch of 20 %: slack, it reads -20 %.",
    say(EXT, ("zero", "slack", "offset", "negative", "below")), extensometer(1, -20, "%"))

# -- statements of the plan
add("tether-target-in-percent", T, "statement", "target_strain is written in percent without the sign: [75, 125].",
    say("target_strain", ("100", "%", "percent", "per cent", "ratio", "0.01", "factor", "times")),
    do(sub, "target_strain = [0.75, 1.25]", "target_strain = [75, 125]", times=1))
add("tether-targets-of-each-other", T, "statement", "T-1 and T-2 have each other's target_strain.", say("target_strain", ("t-1", "t-2", *RATIO)),
    do(sub, "target_strain = [0.75, 1.25]", "target_strain = [0.5, 1.50]", times=1),
    do(sub, "target_strain = [0.50, 1.50]", "target_strain = [0.75, 1.25]", times=1))
add("tether-n-cycles-times-10", T, "statement", "n_cycles is 100 in campaign.toml and the log holds ten.", say(("n_cycles", "cycles"), "100"),
    do(setkey, "tests.T-1", "n_cycles", "100"))
add("tether-rate-in-inches", T, "statement", "The rate is stated as 1 in/s; the log shows 1 ft/s.", say("rate", (*RATIO, "ft/s", "12", "m/s")), do(setkey, "defaults", "rate", '"1 in/s"'))
add("tether-rate-in-metres", T, "statement", "The rate is stated as 1 m/s; the log shows 1 ft/s.", say("rate", (*RATIO, "ft/s", "0.3")), do(setkey, "defaults", "rate", '"1 m/s"'))
add("tether-rate-times-10", T, "statement", "The rate is stated as 10 ft/s; the log shows 1 ft/s.", say("rate", (*RATIO, "0.1")), do(setkey, "defaults", "rate", '"10 ft/s"'))
add("tether-rate-as-frequency", T, "statement", "The rate is stated as 1 Hz; the log shows a cycle of 9.5 s.", say(("rate", "frequency"), (*RATIO, "0.1")), do(setkey, "tests.T-1", "rate", '"1 Hz"', new=True))
# docs/campaign.md has no keys frequency and mean_tension; the issue has. The words ask for the log, so that a refused key does not do
add("tether-frequency-statement", T, "statement", "frequency is stated as 1 Hz; the log shows 0.105 Hz.", say("frequency", ("0.10", "ratio", "the log", "9.5")), do(setkey, "tests.T-1", "frequency", '"1 Hz"', new=True))
add("tether-mean-tension-statement", T, "statement", "mean_tension is stated as 92 N; the log shows 92 lbf.", say(("mean_tension", "mean tension"), ("ratio", "the log", "420", "404", "94", "90", "4.")), do(setkey, "tests.T-1", "mean_tension", '"92 N"', new=True))
add("tether-waveform", T, "data", "The waveform is stated as sinusoidal; the branches run at a constant rate.", say("waveform", ("triang", "sinus", "constant rate")), do(setkey, "defaults", "waveform", '"sinusoidal"'))
add("tether-kind-tensile", T, "data", "A cyclic test is stated as tensile: the log holds ten cycles and does not break.", say(("kind", "tensile"), ("cycl", "break", "broke", "failed", "n_cycles")), do(setkey, "tests.T-1", "kind", '"tensile"', new=True))
add("tether-kind-relaxation", T, "data", "A cyclic test is stated as relaxation: the log holds ten cycles.", say(("kind", "relaxation"), ("cycl", "n_cycles")), do(setkey, "tests.T-1", "kind", '"relaxation"', new=True))
add("tether-specimen-kind-wire", T, "band", "The rubber tether is stated as a wire: no wire withstands a strain of 150 %.", say(("kind", "wire"), ("strain", "modulus", "rubber")), do(setkey, "specimens.new", "kind", '"wire"'))
# earlier and later test of two that overlap: softening goes from the one with the smaller peak to the other in either order
add("tether-order-reversed", T, "no", "T-2 was run before T-1; the campaign says the reverse.", say("order"),
    do(sub, "order = 1\n", "order = 9\n", times=1), do(sub, "order = 2\n", "order = 1\n", times=1), do(sub, "order = 9\n", "order = 2\n", times=1))
BREAK = ("rated_break_strength", "break strength")
add("tether-break-strength-kn-as-lbf", T, "band", "The rated break strength is 3.56 kN and was entered as 3.56 lbf: the tether carries 50 times that.", say(BREAK, ("unit", "share", "%", *KN, "times", "above", "beyond", "more than", "exceed")),
    do(sub, 'rated_break_strength = "800 lbf"', 'rated_break_strength = "3.56 lbf"'))
add("tether-break-strength-kn", T, "band", "The rated break strength was entered as 800 kN: a stress at break of 1,500 MPa.", say(BREAK, ("unit", "stress", "mpa", *LBF)),
    do(sub, 'rated_break_strength = "800 lbf"', 'rated_break_strength = "800 kN"'))
add("tether-linear-density-lb-per-ft", T, "band", "The mass per length is 0.35 lb/ft and was entered as 0.35 kg/m: a density of 640 kg/m3.", say(("linear_density", "linear density"), ("density", "kg/m", "lb/ft", "diameter")),
    do(setkey, "specimens.new", "linear_density", '"0.35 kg/m"', new=True))
add("tether-linear-density-grams", T, "band", "The mass per length is 520 g/m and was entered as 520 kg/m.", say(("linear_density", "linear density"), ("density", "kg/m", "g/m", "unit", "diameter")),
    do(setkey, "specimens.new", "linear_density", '"520 kg/m"', new=True))

# ================================================================== ropes
R = "rope"
for unit in ("N", "kN", "kgf"):
    add(f"rope-lbf-declared-{unit.lower()}", R, "statement", f"The log is in pounds-force, as its header says (load_lbf), and the layout declares {unit}.",
        say(LBF, UNIT), do(declare, "tension.1", "lbf", unit))
add("rope-lbf-declared-kn-bare-header", R, "band", "The log is in pounds-force and the layout declares kN; the header does not say: 90 times the rated break strength.",
    say((*LOAD, "break strength"), ("unit", "factor", "gain", "lb")), bare, do(declare, "tension.1", "lbf", "kN"))
add("rope-header-kraft-kn", R, "statement", "The header says `Kraft/kN`, and the layout declares lbf.", say(KN, (*UNIT, *LOAD, "kraft")),
    do(rename, {"load_lbf": "Kraft/kN"}), do(scale, ("Kraft/kN",), 0.00444822, "{:.5f}"))
EXPERIMENT = ("level", "coded", "plan", "runs", "experiment")
add("rope-experiment-load-in-n", R, "statement", "The loads were logged in newtons, which the header does not say, and declared lbf: mean and amplitude are 4.4 times the plan.",
    say((*LOAD, "mean_tension", "mean tension"), ("unit", *N, "factor", "gain"), EXPERIMENT), bare, do(scale, LOADS[R], 4.44822, "{:.2f}"), keep=ALL)
add("rope-experiment-lbf-declared-n", R, "statement", "The loads are in pounds-force and declared N, which the header does not contradict: mean and amplitude are 0.22 of the plan.",
    say((*LOAD, "mean_tension", "mean tension"), ("unit", *LBF, "factor", "gain"), EXPERIMENT), bare, do(declare, "tension.1", "lbf", "N"), keep=ALL)
add("rope-gain-of-extensometer-one-run", R, "data", "The extensometer was at another range in R04 alone, by a factor of 1.27.",
    say("extensometer", ("times", "factor", "ratio"), ("other", "r04")),
    lambda folder: each(folder, lambda log: log.map("extensometer_pct", lambda v: 1.27 * v), ("R04",)),
    keep=("R02", "R04", "R06", "R13", "Q01"))
add("rope-experiment-gain-2", R, "statement", "The load amplifier was set to double gain: mean and amplitude are twice the plan.",
    say((*LOAD, "mean_tension", "mean tension"), ("factor", "gain", "unit", "break", "ratio", "times"), EXPERIMENT), do(scale, ("load_lbf",), 2.0, "{:.2f}"), keep=ALL)
AMP = ("tension_amplitude", "amplitude")
add("rope-amplitude-as-range", R, "statement", "The levels of the amplitude are those of the range, from trough to crest.",
    say(AMP, ("range", "peak to peak", "peak-to-peak", "half", "double", "twice", "trough")),
    do(sub, 'factors.tension_amplitude = ["5 %RBS", "12 %RBS"]', 'factors.tension_amplitude = ["10 %RBS", "24 %RBS"]', times=1), keep=ALL)
add("rope-mean-as-peak", R, "statement", "The levels of the mean tension are those of the peaks: mean and amplitude together.",
    say(("mean_tension", "mean tension"), ("peak", "ratio", "times", "plan", "level", "coded", "reached")),
    do(sub, 'factors.mean_tension = ["12 %RBS", "30 %RBS"]', 'factors.mean_tension = ["20.5 %RBS", "38.5 %RBS"]', times=1), keep=ALL)
add("rope-mean-in-lbf-for-n", R, "statement", "The levels of the mean tension are pounds-force, written as N.",
    say(("mean_tension", "mean tension"), ("unit", *LBF, "ratio", "times", "factor")),
    do(sub, 'factors.mean_tension = ["12 %RBS", "30 %RBS"]', 'factors.mean_tension = ["768 N", "1920 N"]', times=1), keep=ALL)
add("rope-frequency-per-minute", R, "statement", "The levels of the frequency are cycles a minute, written as Hz.",
    say("frequency", ("minute", "60", "unit", "ratio", "times", "factor")), do(sub, 'factors.frequency = ["0.1 Hz", "0.5 Hz"]', 'factors.frequency = ["6 Hz", "30 Hz"]', times=1), keep=ALL)
add("rope-frequency-radians", R, "statement", "The levels of the frequency are radians a second, written as Hz.",
    say("frequency", ("rad", "pi", "6.28", "ratio", "times", "factor")), do(sub, 'factors.frequency = ["0.1 Hz", "0.5 Hz"]', 'factors.frequency = ["0.628 Hz", "3.142 Hz"]', times=1), keep=ALL)
add("rope-period-as-frequency", R, "statement", "The levels of the frequency are periods in seconds, written as Hz.",
    say("frequency", ("period", "unit", "ratio", "times", "plan", "reached", "level")), do(sub, 'factors.frequency = ["0.1 Hz", "0.5 Hz"]', 'factors.frequency = ["2 Hz", "10 Hz"]', times=1), keep=ALL)


def swap_lines(folder: Path, a: str, b: str) -> None:
    sub(folder, a, "\0", times=1)
    sub(folder, b, a, times=1)
    sub(folder, "\0", b, times=1)


add("rope-two-runs-swapped", R, "statement", "The files of R03 and R13 were swapped.", say("r03", "r13", (*SWAP, "coded", "plan", "level")),
    do(swap_lines, 'file = "R03.csv"', 'file = "R13.csv"'), keep=ALL)
add("rope-two-close-runs-swapped", R, "statement", "The files of R06 and R07, which differ in frequency alone, were swapped.", say("r06", "r07", (*SWAP, "coded", "plan", "level", "frequency")),
    do(swap_lines, 'file = "R06.csv"', 'file = "R07.csv"'), keep=ALL)


@mistake("rope-runs-shifted", R, "statement", "The rows of the plan are shifted by one against the runs: R01 has the levels of R02, and so on.",
         say(("plan", "coded", "level", "runs"), (*SWAP, "run", "shift", "order", "reached")), keep=ALL)
def _(folder: Path) -> None:
    path = folder / "campaign.toml"
    text = path.read_text(encoding="utf-8")
    found = re.findall(r"(?m)^(R\d\d) = (\[.*\])$", text)
    assert len(found) == 15
    for i, (run, levels) in enumerate(found):
        text = text.replace(f"{run} = {levels}", f"{run} = \0{found[(i + 1) % 15][1]}", 1)
    path.write_text(text.replace("\0", ""), encoding="utf-8")


@mistake("rope-plan-columns-swapped", R, "statement", "Mean and amplitude stand in each other's place in the rows of the plan.",
         say(("mean_tension", "mean tension", "amplitude"), (*SWAP, "plan", "coded", "level", "order")), keep=ALL)
def _(folder: Path) -> None:
    path = folder / "campaign.toml"
    text = path.read_text(encoding="utf-8")
    new, n = re.subn(r"(?m)^(R\d\d) = \[(.*), (.*), (.*)\]$", r"\1 = [\2, \4, \3]", text)
    assert n == 15 and new != text
    path.write_text(new, encoding="utf-8")


@mistake("rope-plan-frequency-sign", R, "statement", "The coded frequency has the wrong sign in every run.",
         say("frequency", ("sign", "swap", "plan", "coded", "level", "other way", "revers")), keep=ALL)
def _(folder: Path) -> None:
    path = folder / "campaign.toml"
    text = path.read_text(encoding="utf-8")
    new, n = re.subn(r"(?m)^(R\d\d) = \[(-?)1,", lambda m: f"{m.group(1)} = [{'' if m.group(2) else '-'}1,", text)
    assert n == 8
    path.write_text(new, encoding="utf-8")


for name, value, cause in (
    ("times-10", "64000 lbf", "The rated break strength has a zero too many: the runs lie at a tenth of the planned shares."),
    ("kgf", "6400 kgf", "The rated break strength is in pounds-force and was entered as kgf: the runs lie at 0.45 of the planned shares."),
    ("kn-as-lbf", "28.5 lbf", "The rated break strength is 28.5 kN and was entered as 28.5 lbf: the rope bears a hundred times that."),
    ("of-another-rope", "8500 lbf", "The rated break strength is that of another rope: the runs lie at three quarters of the planned shares."),
):
    add(f"rope-break-strength-{name}", R, "statement", cause,
        say(BREAK, (*EXPERIMENT, "unit", "ratio", "times", "share")), do(setkey, "specimens.line-1", "rated_break_strength", f'"{value}"'), keep=ALL)
add("rope-pull-is-a-cyclic-run", R, "statement", "The slow pull of the experiment names a cyclic run.", say(("quasi_static", "quasi-static", "slow pull"), ("r02", "cyclic", "kind")),
    do(sub, 'quasi_static = { line-1 = "Q01" }', 'quasi_static = { line-1 = "R02" }', times=1), keep=ALL)


@mistake("rope-pull-ends-early", R, "data", "The slow pull ends at 8 % of the break strength, below the mean tension of every run.",
         say(("q01", "quasi_static", "quasi-static", "slow pull", "pull"), ("mean", "range", "beyond", "extrapolat", "outside", "reach", "ends")), keep=ALL)
def _(folder: Path) -> None:
    each(folder, lambda log: setattr(log, "rows", log.rows[:300]), ("Q01",))


add("rope-pull-in-n", R, "data", "The load of the slow pull alone was logged in newtons: its stiffness is above that of the waves.",
    say(("q01", "quasi_static", "quasi-static", "slow pull", "line-1"), ("unit", "gain", "factor", "jump", "stiff", "times", "ratio", "spring")),
    bare, do(scale, ("load",), 4.44822, "{:.2f}", only=("Q01",)), keep=ALL)
add("rope-one-run-gain-2", R, "data", "In R04 the load amplifier was set to double gain.", say("r04", ("gain", "factor", "jump", "stiff", "times", "ratio", "spring", "modulus")),
    do(scale, ("load_lbf",), 2.0, "{:.2f}", only=("R04",)))
add("rope-rate-inches-a-second", R, "statement", "The rate of the slow pull is stated as 10 in/s; the log shows 10 in/min.", say("rate", (*RATIO, "in/min", "60")), do(setkey, "tests.Q01", "rate", '"10 in/s"'))
add("rope-frequency-statement", R, "statement", "frequency of R02 is stated as 18 Hz; the log shows 18 cycles a minute.", say("frequency", ("0.3", "ratio", "the log", "60")), do(setkey, "tests.R02", "frequency", '"18 Hz"', new=True))
add("rope-rate-as-frequency", R, "statement", "The rate of R02 is stated as 3 Hz; the log shows 0.3 Hz.", say(("frequency", "rate"), (*RATIO, "0.3", "10")), do(setkey, "tests.R02", "rate", '"3 Hz"', new=True))
add("rope-mean-tension-statement", R, "statement", "mean_tension of R02 is stated as 1344 N; the log shows 1344 lbf.", say(("mean_tension", "mean tension"), ("ratio", "the log", "4.4", "lb", "5978", "1344.")), do(setkey, "tests.R02", "mean_tension", '"1344 N"', new=True))
add("rope-n-cycles-times-10", R, "statement", "n_cycles is 130 in campaign.toml and the log holds thirteen.", say(("n_cycles", "cycles"), "130"), do(setkey, "tests.R02", "n_cycles", "130"))
add("rope-extensometer-declared-mm-per-m", R, "statement", "The extensometer is in percent, as its header says, and declared mm/m.", say(("extensometer", "strain"), ("pct", "%", "percent", "per cent")), do(declare, "strain.1", "%", "mm/m"))
add("rope-extensometer-pct-as-mm-per-m", R, "data", "The extensometer is in percent and declared mm/m, which the header does not contradict: the stroke over its reference length is ten times as much.",
    say(("extensometer", "strain"), ("stroke", "position", "crosshead", "travel", "displacement", "modulus", "reference_length"), ("unit", "factor", "times", "ratio", "%", "gain")), bare, do(declare, "strain.1", "%", "mm/m"))
add("rope-extensometer-fraction-as-pct", R, "data", "The extensometer is in m/m and declared percent: the stroke over its reference length is a hundred times as much.",
    say(("extensometer", "strain"), ("stroke", "position", "crosshead", "travel", "displacement", "modulus", "reference_length"), ("unit", "factor", "times", "ratio", "gain")), bare, do(scale, ("extensometer",), 0.01, "{:.6f}"))
add("rope-extensometer-gain-2", R, "data", "The extensometer stood at its other range: it shows half of what the stroke over its reference length does.",
    say(("extensometer", "strain"), ("stroke", "position", "crosshead", "travel", "displacement", "reference_length")), do(scale, ("extensometer_pct",), 0.5))
add("rope-extensometer-in-mm", R, "data", "The extensometer is in mm over 24 in and declared percent: six times what the stroke over its reference length is.",
    say(("extensometer", "strain"), ("stroke", "position", "crosshead", "travel", "displacement", "modulus", "reference_length"), ("unit", "factor", "times", "ratio", "gain", "mm")), bare, do(scale, ("extensometer",), 6.096, "{:.3f}"))


@mistake("rope-extensometer-slips", R, "data", "The extensometer slips in the middle of the cycles: strain steps by 3 % and stays there, load and stroke do not.",
         say(("extensometer", "strain"), ("step", "jump", "slip", "zero")))
def _(folder: Path) -> None:
    def f(log: Log) -> None:
        x = log.column("extensometer_pct")
        log.put("extensometer_pct", [v - (3.0 if i > 1400 else 0.0) for i, v in enumerate(x)])

    each(folder, f, ("R02",))


add("rope-stroke-declared-mm", R, "statement", "The stroke is in inches, as its header says (stroke_in), and the layout declares mm.", say(POS, ("_in", "inch", "states in", "in,", "says in", "unit in", "`in`", "'in'")), do(declare, "crosshead_position", "in", "mm"))
add("rope-stroke-declared-mm-bare-header", R, "data", "The stroke is in inches and declared mm: over its reference length it is a 25th of the extensometer's strain.",
    say(POS, ("unit", "factor", "ratio", "times", "scal", "gain", "extensometer")), bare, do(declare, "crosshead_position", "in", "mm"))
add("rope-load-and-extensometer-swapped", R, "statement", "The column of the load is declared as strain and that of the extensometer as load: both headers say another unit.",
    say(("load_lbf", "extensometer_pct", "extensometer"), ("unit", "declare", *SWAP, "header")), do(swap_lines, '"load_lbf"', '"extensometer_pct"'))
add("rope-load-sign", R, "data", "The frame logs tension as negative, and the layout does not say sign = -1.", say("sign", (*LOAD, "channel", "-1")), do(scale, ("load_lbf",), -1.0, "{:.2f}"))
add("rope-stroke-sign", R, "data", "The stroke is logged with the other sign: it falls as the rope is stretched.", say(POS, "sign"), do(scale, ("stroke_in",), -1.0))
add("rope-zero-plus-100", R, "data", "The weight of the shackle was not tared: the slack rope reads 100 lbf.", say(SLACK, (*LOAD, "slack")), shift(100, ("load_lbf",), fmt="{:.2f}"))


@mistake("rope-load-saturated", R, "data", "The amplifier ends at 1,500 lbf: the crests are cut off.", say(("saturat", "clip", "full scale", "cut off", "flat", "limit of the range")))
def _(folder: Path) -> None:
    each(folder, lambda log: log.map("load_lbf", lambda v: min(v, 1500.0), "{:.2f}"), ("R02", "R13"))


@mistake("rope-load-filter-1s", R, "data", "A filter of 1 s stood in the load channel: the load comes after the strain, and the loops turn the other way.",
         say((*LOAD, "loop", "hysteresis", "energy"), (*SHIFT, "negative", "other way", "clockwise", "below zero")))
def _(folder: Path) -> None:
    each(folder, lambda log: lowpass(log, ("load_lbf",), 1.0, "{:.2f}"))


add("rope-time-ms", R, "statement", "The time is in milliseconds and declared s, which the header does not contradict: frequencies are a thousandth of the plan.",
    say(("time", "frequency"), (*u("ms"), "unit", "0.001", "1000", "1,000", "ratio", "times", "factor", "plan")), bare, do(each, lambda log: log.map("time", lambda v: v * 1000, "{:.1f}")), keep=ALL)
add("rope-sampling-rate-halved", R, "statement", "The logger ran at twice the rate that was set: frequencies are half of the plan.",
    say(("time", "frequency"), ("ratio", "times", "factor", "plan", "coded", "level", "sampl", "half")), do(each, lambda log: log.map("time_s", lambda v: v * 2)), keep=ALL)
add("rope-same-log-twice", R, "statement", "R08 names the file of R02.", say(("r02", "r08"), SAME), do(sub, 'file = "R08.csv"', 'file = "R02.csv"', times=1), keep=ALL)


@mistake("rope-truncated", R, "statement", "The file of R13 was cut in the middle of its cycles.", say(("n_cycles", "cycles"), ("n_cycles", "stated", "fewer", "expected", "plan")))
def _(folder: Path) -> None:
    each(folder, lambda log: setattr(log, "rows", log.rows[:1900]), ("R13",))


@mistake("rope-quoted-thousands", R, "data", 'Loads above 999 are written as "1,344.23", between quotes; the layout has no thousands mark.',
         say("thousands"))
def _(folder: Path) -> None:
    def f(log: Log) -> None:
        i = log.names.index("load_lbf")
        for row in log.rows:
            v = float(row[i])
            if v >= 1000:
                row[i] = f'"{v:,.2f}"'

    for log in logs(folder):
        f(log)
        log.write()


add("rope-waveform", R, "data", "The waveform is stated as triangular; the log shows sines.", say(("waveform", "constant rate"), ("triang", "sinus", "constant rate")), do(setkey, "defaults", "waveform", '"triangular"'))
add("rope-break-in-too-long", R, "statement", "break_in_cycles is 40 and the log holds thirteen cycles.", say(("break_in_cycles", "break-in"), ("cycles",)), do(sub, "break_in_cycles = 4 ", "break_in_cycles = 40 ", times=1))
ROPED = say(DIAMETER, ("modulus", "unit", "factor", "radius", "circumference", "half", "stress", "mm", "inch", "double", "twice"))
for name, value, cause in (
    ("mm-for-in", "0.5 mm", "`0.5 mm` was entered for 0.5 in: a modulus of 800 GPa."),
    ("radius", "0.25 in", "The radius was entered as the diameter: 900 MPa nominal stress at the rated break strength, more than nylon rope has."),
    ("circumference", "1.57 in", "Ropes are named by their circumference in some trades, and it was entered as the diameter: 23 MPa at the rated break strength."),
    ("in-for-mm", "12.7 in", "`12.7 in` was entered for 12.7 mm."),
    ("decimal-point", "5 in", "The decimal point of the diameter is in the wrong place."),
):
    add(f"rope-diameter-{name}", R, "band", cause, ROPED, do(setkey, "specimens.line-1", "diameter", f'["{value}"]'))
add("rope-linear-density-per-100-ft", R, "band", "The mass is 8.3 lb a hundred feet and was entered as 8.3 kg/m: a density of 65,000 kg/m3.", say(("linear_density", "linear density"), ("density", "kg/m", "unit", "diameter", "lb")),
    do(setkey, "specimens.line-1", "linear_density", '"8.3 kg/m"', new=True))
# 0.083 kg/m for lb/ft is a fill of 58 %, 0.124 kg/m one of 86 %: ropes have both
add("rope-linear-density-lb-per-ft", R, "no", "The mass per length is 0.083 lb/ft and was entered as 0.083 kg/m.", say(("linear_density", "linear density"), ("lb", "unit")),
    do(setkey, "specimens.line-1", "linear_density", '"0.083 kg/m"', new=True))
add("rope-kind-rubber", R, "band", "The rope is stated as a rubber tether: no rubber has 1 GPa.", say(("kind", "rubber"), ("modulus", "rope", "strain", "unit")), do(setkey, "specimens.line-1", "kind", '"rubber tether"'))
add("rope-kind-wire", R, "band", "The rope is stated as a wire: no wire withstands 15 % in a third of its strength.", say(("kind", "wire"), ("modulus", "strain", "rope")), do(setkey, "specimens.line-1", "kind", '"wire"'))
add("rope-material-hmpe", R, "band", "The line is stated as HMPE, which breaks at 3 to 4 %; the log shows 16 % in a third of the strength.", say(("material", "hmpe"), ("modulus", "strain", "stiff")), do(setkey, "specimens.line-1", "material", '"HMPE (synthetic)"'))

# ================================================================== hoses
H = "hose"
H64 = "hoses.H64"
for unit in ("N", "kN"):
    add(f"hose-lbf-declared-{unit.lower()}", H, "statement", f"The log is in pounds-force, as its header says (load_lbf), and the layout declares {unit}.", say(LBF, UNIT), do(declare, "tension.1", "lbf", unit))
add("hose-lbf-declared-kgf-bare-header", H, "statement", "The log is in pounds-force and declared kgf, which the header does not contradict: 2.2 times the load that the design predicts.",
    say(LOAD, ("2.2", "lb", "unit", "factor", "gain", "times", "ratio")), bare, do(declare, "tension.1", "lbf", "kgf"))
add("hose-lbf-declared-n-bare-header", H, "statement", "The log is in pounds-force and declared N, which the header does not contradict: 0.22 of the load that the design predicts.",
    say(LOAD, ("4.4", "0.22", "lb", "unit", "factor", "gain", "times", "ratio")), bare, do(declare, "tension.1", "lbf", "N"))
add("hose-position-declared-cm", H, "statement", "The position is in inches, as its header says, and the layout declares cm.", say(POS, ("_in", "inch", "states in", "in,", "says in", "unit in", "`in`", "'in'")), do(declare, "crosshead_position", "in", "cm"))
add("hose-position-declared-mm-bare-header", H, "statement", "The position is in inches and declared mm: at rest the flanges would be 96 mm apart, the gauge length is 96 in.",
    say((*POS, "gauge"), ("unit", "factor", "ratio", "times", "inch", "25.4", "gauge_length", "gauge length")), bare, do(declare, "crosshead_position", "in", "mm"))
add("hose-gauge-ft-for-in", H, "statement", "`96 ft` was entered for a gauge length of 96 in: at rest the flanges are 96 in apart.", say(GAUGE, ("unit", "pin-to-pin", "position", "rest", "slack", "factor", "ratio", "length")),
    do(sub, 'gauge_length = "96 in"', 'gauge_length = "96 ft"'))
add("hose-gauge-half", H, "statement", "The gauge length is 46 in: half of the hose was measured; at rest the flanges are 96 in apart and the design is 96 in long.", say(GAUGE, ("pin-to-pin", "position", "rest", "slack", "factor", "ratio", "h64", "length")),
    do(sub, 'gauge_length = "96 in"', 'gauge_length = "46 in"'))
add("hose-load-sign", H, "data", "The frame logs tension as negative, and the layout does not say sign = -1.", say("sign", (*LOAD, "channel", "-1")), do(scale, ("load_lbf",), -1.0, "{:.1f}"))
add("hose-zero-plus-150", H, "data", "The weight of the flange was not tared: the slack hose reads 150 lbf.", say(SLACK, (*LOAD, "slack")), shift(150, ("load_lbf",), fmt="{:.1f}"))


@mistake("hose-load-saturated", H, "data", "The amplifier ends at 3,000 lbf: the peaks are cut off.", say(("saturat", "clip", "full scale", "cut off", "flat", "limit of the range")))
def _(folder: Path) -> None:
    each(folder, lambda log: log.map("load_lbf", lambda v: min(v, 3000.0), "{:.1f}"))


add("hose-time-days", H, "data", "The time column holds dates of a spreadsheet, which count days, and the layout says seconds.",
    say(TIME, ("counts days", "faster than any")), bare,
    do(each, lambda log: log.map("time", lambda v: 46000 + v / 86400, "{:.10f}")))
add("hose-files-swapped", H, "statement", "The files of S-64 and S-68 were swapped: L-64 and both designs contradict them.",
    say(("s-64", "s-68"), (*SWAP, "stiff", "jump", "wrap_angle", "l-64", "h68", "h64"), (*SWAP, "jump", "factor", "ratio", "times", "angle", "file", "differ", "stiff")), do(swap_lines, 'file = "S-64.csv"', 'file = "S-68.csv"'))
add("hose-same-log-twice", H, "statement", "S-68 names the file of S-64.", say(("s-64", "s-68"), SAME), do(sub, 'file = "S-68.csv"', 'file = "S-64.csv"', times=1))
add("hose-wrong-specimen", H, "statement", "S-64 is said to be a test of hose-68: its stiffness is not that of S-68, nor that of the design.",
    say(("s-64", "hose-68"), ("stiff", "jump", "specimen", "h64", "order"), ("factor", "ratio", "times", "specimen", "jump", "order", "differ", "hose-64")),
    do(setkey, "tests.S-64", "specimens", '["hose-68"]'))
add("hose-held-against-the-other-design", H, "statement", "The pull of the 68 degree hose is held against the design of the 64 degree hose.",
    say(("wrap_angle", "wrap angle", "h64", "angle"), ("hose-68", "68", "h68", "specimen", "construction")), do(setkey, "comparisons.H68-pull", "predicted", '"H64"'))
ANGLE = ("wrap_angle", "wrap angle", "angle")
add("hose-angle-complement", H, "statement", "The wrap angle was measured from the hoop: 26 deg for 64 deg from the axis.", say(ANGLE, ("axis", "complement", "90", "64", "54.7")), do(setkey, H64, "wrap_angle", '"26 deg"'))
add("hose-angle-in-radians", H, "statement", "The wrap angle is 1.117 rad and was entered as 1.117 deg.", say(ANGLE, ("rad", "unit", "axis", "54.7", "64")), do(setkey, H64, "wrap_angle", '"1.117 deg"'))
add("hose-wall-for-outer-diameter", H, "statement", "The thickness of the wall was entered as the outer diameter: it is less than the bore.", say(("outer_diameter", "outer diameter"), ("inner", "bore", "wrap", "wall")), do(setkey, H64, "outer_diameter", '"1.25 in"'))
# the measured curve lies 8 % beside the wrong design and 10 % beside the right one
add("hose-bore-radius-for-diameter", H, "no", "The radius of the bore was entered as the inner diameter: more rubber, and a load above the measured one.",
    say(("inner_diameter", "inner diameter", "bore", "rubber"), ("measured", "rubber_modulus", "ratio", "radius", "wall", "reject", "differ", "beyond", "calibrat")), do(setkey, H64, "inner_diameter", '"1.25 in"'))
add("hose-wrap-radius-for-diameter", H, "statement", "The radius of the cords was entered as the wrap diameter: the cords would lie in the bore.", say(("wrap_diameter", "wrap diameter"), ("inner", "bore", "wall", "radius")), do(setkey, H64, "wrap_diameter", '"1.75 in"'))
add("hose-wrap-diameter-ft", H, "statement", "`3.5 ft` was entered for a wrap diameter of 3.5 in: the cords would lie outside of the hose.", say(("wrap_diameter", "wrap diameter"), ("outer", "wall", "unit", "skin")), do(setkey, H64, "wrap_diameter", '"3.5 ft"'))
CORDS = ("cords_per_length", "cords per length", "cords")
add("hose-cords-one-layer", H, "statement", "The fabric was counted for half of its cords (17 per inch): the cords carry half of what was measured.",
    say((*CORDS, "cord"), ("17", "cord_load_scale", "measured", "ratio", "half", "times", "factor", "verdict")), do(setkey, H64, "cords_per_length", '"17 1/in"'))
add("hose-cords-both-layers", H, "statement", "Both layers were counted into the fabric (68 per inch): cords of 0.022 in would overlap.", say(CORDS, ("touch", "overlap", "cord_diameter", "cord diameter", "closer")), do(setkey, H64, "cords_per_length", '"68 1/in"'))
add("hose-cords-per-foot", H, "statement", "`34 1/ft` was entered for 34 cords per inch: the cords carry a twelfth.", say((*CORDS, "cord"), ("unit", "1/in", "cord_load_scale", "measured", "ratio", "times", "factor", "12")), do(setkey, H64, "cords_per_length", '"34 1/ft"'))
add("hose-cords-per-cm", H, "statement", "`34 1/cm` was entered for 34 cords per inch: cords of 0.022 in would overlap.", say(CORDS, ("touch", "overlap", "cord_diameter", "cord diameter", "closer", "unit")), do(setkey, H64, "cords_per_length", '"34 1/cm"'))
add("hose-cord-diameter-ten-times", H, "statement", "The decimal point of the cord's diameter is in the wrong place (0.22 in): 34 of them do not fit into an inch.", say(("cord_diameter", "cord diameter", "cords"), ("touch", "overlap", "cords_per_length", "fit", "closer")), do(setkey, H64, "cord_diameter", '"0.22 in"'))
add("hose-cord-diameter-mm", H, "band", "`0.022 mm` was entered for 0.022 in: a cord that breaks at 350 GPa.", say(("cord_diameter", "cord diameter", "cord"), ("unit", "stress", "strength", "pa", "mm")), do(setkey, H64, "cord_diameter", '"0.022 mm"'))


def cord(f: Callable[[str], str], key: str) -> Callable[[Path], None]:
    def g(folder: Path) -> None:
        text = (folder / "campaign.toml").read_text(encoding="utf-8")
        part = next(p for h, p in _sections(text) if h == "hoses.H64.cord")
        old = re.search(rf"(?m)^{key} = (.*)$", part).group(1)
        setkey(folder, "hoses.H64.cord", key, f(old))

    return g


add("hose-cord-lbf-as-n", H, "statement", "The load of the cord is in pounds-force and was entered as N: the cords carry 0.22 of what was measured.",
    say("cord", (*LBF, "unit", "cord_load_scale", "measured", "ratio", "times", "factor")), cord(lambda s: s.replace("lbf", "N"), "load"))
add("hose-cord-n-as-lbf", H, "statement", "The load of the cord is in newtons and was entered as lbf: the cords carry 4.4 times what was measured, and break at 2.4 GPa.",
    say("cord", (*N, "unit", "cord_load_scale", "measured", "ratio", "times", "factor", "stress", "strength")), cord(lambda s: re.sub(r'"([\d.]+) lbf"', lambda m: f'"{float(m.group(1)) * 4.44822:.2f} lbf"', s), "load"))
add("hose-cord-strain-in-percent", H, "band", "The strain of the cord is in percent without the sign: a nylon cord that breaks at 2,600 %.", say("cord", "strain", ("%", "percent", "per cent", "unit", "26", "100")),
    cord(lambda s: re.sub(r"[\d.]+", lambda m: f"{float(m.group(0)) * 100:.1f}", s), "strain"))
add("hose-cord-load-of-the-fabric", H, "band", "The load is that of an inch of fabric (34 cords), entered as that of one cord: it breaks at 18 GPa.", say("cord", ("34", "cords_per_length", "unit", "stress", "strength", "cord_load_scale", "measured", "ratio", "times", "factor", "pa")),
    cord(lambda s: re.sub(r'"([\d.]+) lbf"', lambda m: f'"{float(m.group(1)) * 34:.1f} lbf"', s), "load"))
RUBBER = ("rubber_modulus", "rubber modulus", "rubber")
add("hose-rubber-psi-as-kpa", H, "band", "The modulus of the rubber is 200 psi and was entered as 200 kPa: a seventh, and below that of any hose rubber.", say(RUBBER, ("psi", "unit", "ratio", "measured", "times", "factor", "pa")), do(setkey, H64, "rubber_modulus", '"200 kPa"'))
add("hose-rubber-psi-as-mpa", H, "band", "The modulus of the rubber is 200 psi and was entered as 200 MPa.", say(RUBBER, ("psi", "unit", "ratio", "measured", "times", "factor", "pa")), do(setkey, H64, "rubber_modulus", '"200 MPa"'))
add("hose-rubber-shear-modulus", H, "statement", "The shear modulus of the rubber (67 psi) was entered as Young's: a third of what the measured curve asks for.", say(RUBBER, ("measured", "ratio", "times", "factor", "shear", "calibrat", "third", "verdict")), do(setkey, H64, "rubber_modulus", '"67 psi"'))
add("hose-dead-length-ft", H, "statement", "`4 ft` was entered for a dead length of 4 in: half of the hose would not stretch.", say(("dead_length", "dead length", "dead"), ("unit", "share", "%", "length", "ratio", "half", "measured")), do(setkey, H64, "dead_length", '"4 ft"'))
add("hose-length-ft-for-in", H, "statement", "`96 ft` was entered for a length of 96 in; the gauge length of the tested hose is 96 in.", say("length", ("gauge", "96 in", "unit", "2.4", "specimen", "pin-to-pin", "hose-64")), do(setkey, H64, "length", '"96 ft"'))
add("hose-specimen-wall-for-diameter", H, "statement", "The thickness of the wall was entered as the diameter of the tested hose; its design is 5 in.", say(DIAMETER, ("outer_diameter", "outer diameter", "h64", "wall", "5 in", "modulus", "unit")), do(sub, 'diameter = ["5 in"]', 'diameter = ["1.25 in"]'))
add("hose-specimen-diameter-cm", H, "statement", "`5 cm` was entered for a diameter of 5 in; its design is 5 in.", say(DIAMETER, ("outer_diameter", "outer diameter", "h64", "unit", "5 in", "modulus")), do(sub, 'diameter = ["5 in"]', 'diameter = ["5 cm"]'))
add("hose-kind-wire", H, "band", "The hose is stated as a wire: no wire withstands 97 %.", say(("kind", "wire"), ("strain", "modulus", "hose")), do(sub, 'kind = "stretch hose"', 'kind = "wire"'))
add("hose-rate-times-10", H, "statement", "The rate of L-64 is stated as 0.1 Hz; the log shows 0.01 Hz.", say(("rate", "frequency"), (*RATIO, "0.01")), do(setkey, "tests.L-64", "rate", '"0.1 Hz"'))
add("hose-n-cycles-times-10", H, "statement", "n_cycles is 30 in campaign.toml and the log holds three.", say(("n_cycles", "cycles"), "30"), do(setkey, "tests.L-64", "n_cycles", "30"))
add("hose-time-ms", H, "statement", "The time is in milliseconds and declared s, which the header does not contradict: a thousandth of the stated 0.01 Hz.", say(("time", "rate", "frequency"), (*u("ms"), "unit", "0.001", "1000", "1,000", *RATIO)),
    bare, do(each, lambda log: log.map("time", lambda v: v * 1000, "{:.0f}")))
add("hose-pull-not-said-to-fail", H, "data", "B-64 is stated as not failed; its load falls from 10,000 to 2,500 lbf and stays there.", say(("failed", "broke", "break", "failure"), ("load", "tension", "false", "half", "peak", "falls", "b-64")),
    do(setkey, "tests.B-64", "failed", "false"), keep=("S-64", "L-64", "S-68", "B-64"))
add("hose-dynamic-as-static", H, "statement", "The record at 0.1 Hz is said to be a static one: its cords are 1.4 times as stiff as those of the slow pull.", say(("loading", "static"), ("dynamic", "rate", "0.1 hz", "frequency")),
    do(setkey, "comparisons.H64-dynamic", "loading", '"static"', new=True), keep=("S-64", "L-64", "S-68", "D-64"))
add("hose-waveform", H, "data", "The waveform of D-64 is stated as triangular; the log shows sines.", say(("waveform", "constant rate"), ("triang", "sinus", "constant rate")),
    do(setkey, "tests.D-64", "waveform", '"triangular"'), keep=("S-64", "L-64", "S-68", "D-64"))
# nothing that was logged depends on cycles that were not
add("hose-unlogged-cycles", H, "no", "The cycles of which there is no log are 115,000 and were entered as 1,150,000.", say("unlogged_cycles"),
    do(setkey, "tests.D-64", "unlogged_cycles", "1150000"), keep=("S-64", "L-64", "S-68", "D-64"))
# L-64 was made on a hose that does not soften
add("hose-order-reversed", H, "no", "L-64 was run before S-64; the campaign says the reverse.", say("order"),
    lambda folder: (setkey(folder, "tests.S-64", "order", "2"), setkey(folder, "tests.L-64", "order", "1")))

# ================================================================== a second list, by another hand


def over_time(columns: tuple[str, ...], f: Callable[[float, int, int], float], fmt: str = "{:.3f}", only: tuple[str, ...] = ()) -> Callable[[Path], None]:
    """Readings of some columns, each changed by its row and the number of rows."""
    def change(folder: Path) -> None:
        def of_log(log: Log) -> None:
            for name in columns:
                values = log.column(name)
                log.put(name, [f(v, i, len(values)) for i, v in enumerate(values)], fmt)

        each(folder, of_log, only)

    return change


add("tether-zero-drifts-down", T, "data", "The zero of the load cell drifts by -30 lbf during a test: slack reads less after the cycles than before.", say("zero", "drift"),
    over_time(TL, lambda v, i, n: v - 30 * i / n))
add("tether-zero-steps", T, "data", "Somebody pulled at the cable of the load cell: from the middle of the test on it reads 15 lbf more.", say("zero", ("drift", "steps")),
    over_time(TL, lambda v, i, n: v + 15 * (2 * i > n)))


@mistake("tether-tared-in-hold", T, "data", "The load cells were set to zero in the first hold, under load.", say("zero", ("drift", "steps")))
def _(folder: Path) -> None:
    def f(log: Log) -> None:
        for name in TL:
            values = log.column(name)
            log.put(name, [v - values[306] * (i >= 306) for i, v in enumerate(values)], "{:.3f}")

    each(folder, f)


@mistake("tether-peak-hold", T, "data", "The display of the load stood at peak hold: the load never falls.", say(("peak hold", "holds the peak")))
def _(folder: Path) -> None:
    def f(log: Log) -> None:
        for name in TL:
            log.put(name, list(itertools.accumulate(log.column(name), max)), "{:.3f}")

    each(folder, f)


add("tether-load-in-steps", T, "data", "The load was logged in steps of 10 lbf: the amplifier stood at its widest range.", say(("steps of", "resolution")),
    over_time(TL, lambda v, i, n: 10 * round(v / 10), "{:.1f}"))
add("tether-load-spikes", T, "data", "A radio put 500 lbf onto single readings of the load.", say("spike"),
    over_time(TL, lambda v, i, n: v + 500 * (i % 331 == 17)))
add("tether-time-whole-seconds", T, "data", "The time was exported in whole seconds: ten rows have the same.", say("time", ("repeated", "same", "whole")),
    over_time(("time_s",), lambda v, i, n: int(v), "{:.0f}"))


@mistake("tether-series-twice", T, "statement", "The series was run twice into one file: 20 cycles, and 10 are stated.", say("20", "10", "cycles"))
def _(folder: Path) -> None:
    def f(log: Log) -> None:
        end = log.column("time_s")[-1] + 0.1
        at = log.names.index("time_s")
        again = [list(row) for row in log.rows]
        for row in again:
            row[at] = f"{float(row[at]) + end:.1f}"
        log.rows += again

    each(folder, f)


@mistake("tether-mark-row-copied", T, "data", "The row `min` of the marks was copied and named `centre`.", say("marks", ("same", "copied")))
def _(folder: Path) -> None:
    before: dict[tuple[str, str], list[str]] = {}

    def f(row: list[str], at: dict[str, int]) -> list[str]:
        key = row[at["test"]], row[at["specimen"]]
        if row[at["hold"]] == "min":
            before[key] = row
        if row[at["hold"]] == "centre" and key in before:
            for name in TAPE:
                row[at[name]] = before[key][at[name]]
        return row

    marks(folder, f)


@mistake("rope-extensometer-ends", R, "data", "The extensometer ends at nine tenths of the greatest strain.", say(("strain", "extensometer"), ("range", "ends", "saturat")))
def _(folder: Path) -> None:
    def f(log: Log) -> None:
        values = log.column("extensometer_pct")
        log.put("extensometer_pct", [min(v, 0.9 * max(values)) for v in values])

    each(folder, f)


add("rope-dan-as-n", R, "band", "The load is in decanewtons, which the header does not say, and was declared N.", say("load in dan, not n"),
    do(rename, {"load_lbf": "load"}), do(scale, ("load",), 0.444822), do(declare, "tension.1", "lbf", "N"))
# the mean of R02 falls by 15 % of the one that is planned, within what runs miss a plan by
add("rope-accumulator-leaks", R, "data", "The accumulator leaks: the mean tension falls by a third during a run.", say("mean", ("fall", "drift")),
    over_time(("load_lbf", "extensometer_pct", "stroke_in"), lambda v, i, n: v * (1 - 0.3 * i / n), "{:.4f}", ("R02", "R04", "R13")))
add("hose-gain-2-in-one-test", H, "statement", "The load amplifier stood at double gain in S-68: twice the load that the design predicts.", say("s-68", "design", ("gain of 2", "2 times", "twice")),
    do(scale, ("load_lbf",), 2.0, only=("S-68",)))
add("hose-zero-drifts", H, "data", "The zero of the load cell drifts by 300 lbf during a pull and its way back.", say("zero", "drift"),
    over_time(("load_lbf",), lambda v, i, n: v + 300 * i / n, "{:.1f}"))
add("hose-newest-first", H, "data", "The log was exported with the newest row first.", say("time", ("newest first", "falls")),
    lambda folder: each(folder, lambda log: log.rows.reverse()))


@mistake("hose-load-late", H, "data", "The load of L-64 was logged 3 s after the position.", say(("lags", "late")))
def _(folder: Path) -> None:
    def f(log: Log) -> None:
        values = log.column("load_lbf")
        late = round(3 / log.column("time_s")[1])
        log.put("load_lbf", values[:1] * late + values[:-late], "{:.1f}")

    each(folder, f, ("L-64",))


MISTAKES: tuple[Mistake, ...] = tuple(MISTAKES_)

# areas of docs/robustness.md: the first of which a pattern is in the name of a mistake
AREAS = {
    "construction of a hose": "hose-(angle|wall|bore|wrap|cord|rubber|dead|length|specimen|held|dynamic)",
    "plan of an experiment": "rope-(experiment|amplitude|mean-as|mean-in|frequency-per|frequency-rad|period|runs|plan|pull|two)",
    "size and strength": "radius|diameter|circumference|stretch-of|break-strength|linear-density|gauge",
    "tape readings": "mark",
    "sign and zero": "load-sign|zero|tared",
    "gain of the load": "gain-|volts|factor",
    "form of the load signal": "saturated|filter|load-late|position-late|peak-hold|in-steps|spikes|-ends$|accumulator|load-dead",
    "unit of the load": "lbf-declared|(kn|n)-log|logged-in|header-k|unit-row|channel-declared|dan-as",
    "text of a log": "thousands|decimal|delimiter|second-header|preamble|overflow|9999|encoding|misspelt",
    "rows of a log": "truncated|duplicated|gap|sorted|one-sample|newest|series|starts-again",
    "files, channels, specimens": "twice|swapped|one-column|identical|as-tension|as-position$|wrong-specimen",
    "time": "time-|sample-interval|dates|clock|sampling-rate",
    "position and extensometer": "position|stroke|extensometer|displacement|pin-to|reference-length|encoder",
    "statements about the test": "",
}


def area_of(one: Mistake) -> str:
    """Area of docs/robustness.md in which a mistake is counted."""
    return next(area for area, pattern in AREAS.items() if re.search(pattern, one.name))
