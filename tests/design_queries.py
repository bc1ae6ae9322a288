"""Questions to the design-value page, and what the command line shows for them."""

import math
import re
from pathlib import Path

import numpy as np

from reduction.cli import lookup as command
from reduction.cli.export import line_of
from reduction.cli.lookuppoints import Wanted
from reduction.errors import ReductionError
from reduction.export.moordyn import moordyn_files
from reduction.units import display_unit

LONG_NUMBER = re.compile(r"(?<![\w.])-?(?=[\d.]{13})\d+\.\d+(?:e[-+]\d+)?(?=[ |\n])")
"""One of more than twelve signs, as only the rows of a line type and of a table have them."""


class Told:
    """What a command shows, kept in place of being printed."""

    is_text = True

    def __init__(self, units):
        self.units = units
        self.tables, self.texts = [], []

    def show(self, table):
        self.tables.append(table)

    def say(self, text):
        self.texts.append(text)

    def answer(self, document):
        self.document = document


def level_text(number, unit):
    return f"{number} {unit}" if unit != "1" else str(number)


def shown_by_command(question, lines, monkeypatch):
    """Row of the table, sentences, or the refusal, of `reduction lookup` for a question."""
    monkeypatch.setattr(command, "lines_of", lambda source: lines)
    output = Told(question["system"])
    wanted = Wanted(
        quantity=question["quantity"],
        levels={name: level_text(*given) for name, given in question["levels"].items()},
        name=question["name"],
        branch=question["branch"],
        extrapolate="flag" if question["flag"] else "refuse",
    )
    try:
        command.look_up_values("of the page", wanted, output=output)
    except ReductionError as error:
        return {"refused": str(error)}
    (table,) = output.tables
    heads = [str(column.header).replace("\\[", "[") for column in table.columns]
    cells = [next(iter(column.cells)) for column in table.columns]
    headline, *said = output.texts
    return {
        "headline": headline,
        "row": [list(pair) for pair in zip(heads, cells, strict=True)],
        "said": said,
    }


def levels_of(line, quantity, branch):
    """Names and tested ranges of what a quantity is asked at. [SI]"""
    name = "dissipation_spring_constant" if quantity == "dashpot_coefficient" else quantity
    surface = line.surfaces.get(name)
    if surface is not None:
        return {
            factor: (surface.low[place], surface.high[place])
            for place, factor in enumerate(line.factor_names)
        }
    (curve,) = [
        one for one in line.curves if one.quantity == name and one.branch in ("", branch)
    ]  # fmt: skip
    return {curve.variable: (curve.low, curve.high)}


def questions(sources, count, seed):
    """Random questions about lines: `sources` are (key, line) of the page, each is asked."""
    chance = np.random.default_rng(seed)
    found = []
    pairs = [(key, line, quantity) for key, line in sources for quantity in line.quantities]
    order = chance.permutation(len(pairs))
    for number in range(count):
        key, line, quantity = pairs[order[number % len(pairs)]]
        branches = [one.branch for one in line.curves if one.quantity == quantity and one.branch]
        branch = str(chance.choice(branches)) if branches else None
        system = str(chance.choice(["si", "us"]))
        where = str(chance.choice(["inside", "inside", "edge", "edge", "outside", "loads"]))
        ends = levels_of(line, quantity, branch)
        at = {name: _place(where, low, high, chance) for name, (low, high) in ends.items()}
        nodes = [one.at for one in line.curves if one.quantity == quantity and one.at.size]
        if where == "edge" and nodes and chance.integers(2):
            # a point of the curve itself: a joint of two pieces, or the end of a gap
            (name,) = at
            gaps = [one.gaps.ravel() for one in line.curves if one.gaps.size]
            at[name] = float(chance.choice(gaps[0] if gaps and chance.integers(2) else nodes[0]))
        if where == "loads" and "tension_amplitude" in at:
            at |= _loads(line, chance)
        levels = {
            name: _written(value, name, line, system, chance, is_exact=where in ("edge", "loads"))
            for name, value in at.items()
        }
        found.append(
            {
                "line": key, "name": line.name, "quantity": quantity, "levels": levels,
                "branch": branch, "flag": where == "loads" or bool(chance.integers(2)), "system": system,
            }
        )  # fmt: skip
    return found


def _loads(line, chance):
    """A cycle whose ends are about those that the rule of the source names."""
    own = line.tensile_strength
    strength = own if np.isfinite(own) else line.rated_break_strength
    beside = 1 + chance.choice([0.0, 1e-10, -1e-10, 1e-8, -1e-8, 0.01, -0.01])
    peak = chance.choice([0.6, 0.3, 1.0]) * strength * beside
    least = chance.choice([0.03, 0.03, 0.0]) * strength * (1 + chance.choice([0.0, 1e-8, -1e-8]))
    return {"mean_tension": (peak + least) / 2, "tension_amplitude": (peak - least) / 2}


def _place(where, low, high, chance):
    """A level between its ends, just beside one of them, or beyond."""
    if where == "inside":
        return chance.uniform(low, high)
    if where == "edge":
        # printed levels are rounded to a pound, and a change of units to a billionth
        beside = chance.choice([0.0, 0.0, 3e-10, 5e-9, 2e-8, 1e-4, 4e-4])
        end = float(chance.choice([low, (low + high) / 2, high]))
        return end + float(chance.choice([-1, 1])) * beside * (high - low)
    return chance.uniform(low - 0.3 * (high - low), high + 0.3 * (high - low))


def _written(value, name, line, system, chance, *, is_exact):
    """A level as a person writes it: a number of few or of many digits, and a unit."""
    digits = 17 if is_exact else int(chance.choice([3, 5, 17]))
    if name == "frequency":
        unit, factor = "Hz", 1.0
    elif name == "strain":
        unit, factor = str(chance.choice(["%", "1"])), 1.0
        factor = 100.0 if unit == "%" else 1.0
    elif np.isfinite(line.rated_break_strength) and chance.integers(2):
        unit, factor = "%RBS", 100 / line.rated_break_strength
    else:
        unit, factor = display_unit("N", system)
    return [float(f"{factor * value:.{digits}g}"), unit]


def page_lines(processed, lines_of):
    """Lines of a page by their keys, as the page has them, with what the command reads."""
    published = lines_of("published")
    found = [(line.name, line, published) for line in published]
    for folder in sorted(Path(processed).glob("*/")):
        own = lines_of(str(folder))
        found += [(f"{folder.name}/{line.name}", line, own) for line in own]
    return found


SHOWN_LINES = """LINES.map((line) => ({
  key: line.key, curves: Object.keys(line.export), is_surface: Object.keys(line.surfaces).length > 0,
  file: Object.values(line.export)[0].file ?? "none",
  archive: line.campaign ? [line.campaign, line.test, line.specimen] : null,
}))"""
"""What `types_of` needs of the lines of a page."""


def types_of(shown, sources, count, seed):
    """Random line types: `shown` are the lines of a page, `sources` the published ones by name."""
    chance = np.random.default_rng(seed)
    # surfaces of a campaign have no name on the command line of an export
    known = [one for one in shown if not (one["archive"] and one["is_surface"])]
    of_reports = [one for one in known if one["key"] in sources]
    found = []
    for number in range(count):
        among = known if number % 3 == 0 else of_reports
        one = among[chance.integers(len(among))]
        forms = (
            ["table", "static-dynamic", "load-dependent"] if one["key"] in sources else ["table"]
        )
        form = str(chance.choice(forms))
        found.append(
            {
                "line": one["key"], "archive": one["archive"], "file": one["file"], "form": form,
                "curve": str(chance.choice(one["curves"])), "flag": bool(chance.integers(2)),
                "levels": {} if form == "table" else _cycle(sources[one["key"]], chance),
                "stated": {
                    "diameter": chance.choice([None, 0.0131]),
                    "linear_density": chance.choice([None, 0.1, 0.12345, 1.3, 0.01]),
                    "wet_linear_density": chance.choice([None, None, 0.0123, 0.2]),
                },
            }
        )  # fmt: skip
    return found


def _cycle(line, chance):
    """Levels of a cycle, mostly inside what was tested."""
    surface = next(iter(line.surfaces.values()), None)
    low, high = (
        ([0.1, 500, 300], [0.5, 2000, 900]) if surface is None else (surface.low, surface.high)
    )
    is_share = np.isfinite(line.rated_break_strength) and chance.integers(2)
    levels = {}
    for name, least, most in zip(
        ("frequency", "mean_tension", "tension_amplitude"), low, high, strict=True
    ):
        value = least + chance.choice([0.0, 0.5, 1.0, *chance.uniform(size=3)]) * (most - least)
        unit, factor = ("Hz", 1.0) if name == "frequency" else ("N", 1.0)
        if is_share and name != "frequency":
            unit, factor = "%RBS", 100 / line.rated_break_strength
        levels[name] = [float(f"{factor * value:.4g}"), unit]
    return levels


def type_by_command(question, processed):
    """Files of `reduction export --to moordyn`, or the refusal, for a line type of the page."""
    stated = {name: value for name, value in question["stated"].items() if value is not None}
    levels = {name: level_text(*given) for name, given in question["levels"].items()}
    of_test = question["archive"]
    source = of_test and str(Path(processed) / of_test[0] / f"{of_test[1]}.nc")
    try:
        line = line_of(
            [source or question["line"]],
            question["curve"] or None,
            precedence=None,
            specimen=of_test[2] if of_test else None,
            stated=stated,
            levels=levels,
            extrapolate="flag" if question["flag"] else "refuse",
        )
        files = moordyn_files(line, question["file"], form=question["form"])
    except ReductionError as error:
        return {"refused": str(error)}
    return {"files": [[name or f"{question['file']}.dat", text] for name, text in files.items()]}


def same_text(shown, wanted):
    """Texts are one, but for the last digits of numbers that are written with fifteen.

    Those are compared as numbers, and a difference that is none has no sign: sums of products end
    in other bits on other processors.
    """
    shown, wanted = (text.replace("-0.0 percent", "+0.0 percent") for text in (shown, wanted))
    if shown == wanted:
        return True
    ours, theirs = LONG_NUMBER.findall(shown), LONG_NUMBER.findall(wanted)
    return LONG_NUMBER.sub("#", shown) == LONG_NUMBER.sub("#", wanted) and all(
        math.isclose(float(one), float(other), rel_tol=1e-9)
        for one, other in zip(ours, theirs, strict=True)
    )
