"""Questions to the design-value page, and what the command line shows for them."""

import json
import math
import re
from decimal import Decimal
from itertools import zip_longest
from pathlib import Path

import numpy as np

from reduction.cli import lookup as command
from reduction.cli.lookup import LookupRequest
from reduction.cli.output import CommandOutput
from reduction.quantities.units import display_unit
from reduction.record.errors import ReductionError

NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d+)?(?:e[-+]\d+)?")


class Told(CommandOutput):
    """What a command shows, kept in place of being printed."""

    is_text = True

    def __init__(self, units):
        super().__init__(units=units)
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
    """Row, warnings, other tables, sentences, or the refusal, of `reduction lookup`."""
    monkeypatch.setattr(command, "lines_of_source", lambda source: lines)
    output = Told(question["system"])
    wanted = LookupRequest(
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
    (heads, [cells]), *tables = map(heads_and_rows, output.tables)
    of = output.document
    warnings = [text for text in output.texts if text.startswith("warning: ")]
    headline, *said = [text for text in output.texts if text not in warnings]
    intros = [text for text in said if text.endswith(":")]
    return {
        "headline": headline,
        "warnings": [text.removeprefix("warning: ") for text in warnings],
        "row": [list(pair) for pair in zip(heads, cells, strict=True)],
        "tables": [
            {"intro": intro, "heads": heads, "rows": rows}
            for intro, (heads, rows) in zip_longest(intros, tables, fillvalue="")
        ],
        "said": [text for text in said if text not in intros],
        "values": [
            of["value"], *of["interval"], *of["surface_interval"], *of["line_interval"],
            of["peak_share"], of["minimum_share"],
        ],
    }  # fmt: skip


def heads_and_rows(table):
    heads = [str(column.header).replace("\\[", "[") for column in table.columns]
    return heads, [
        list(row) for row in zip(*(column.cells for column in table.columns), strict=True)
    ]


def same_answer(shown, wanted):
    """Numbers are one to a millionth; texts are one, but for a half of the last digit."""
    if shown.keys() != wanted.keys():
        return False
    if "refused" in wanted:
        return same_text(shown["refused"], wanted["refused"])
    size = abs(wanted["values"][0] or 0)
    return (
        all(
            one == other
            if one is None or other is None
            else math.isclose(one, other, rel_tol=1e-6, abs_tol=1e-6 * size)
            for one, other in zip(shown["values"], wanted["values"], strict=True)
        )
        and same_text(shown["headline"], wanted["headline"])
        and all(
            same_text(json.dumps(shown[part]), json.dumps(wanted[part]))
            for part in ("warnings", "row", "tables", "said")
        )
    )


def same_text(shown, wanted):
    """Texts are one, but for numbers that differ by one in their last digit."""
    ours, theirs = NUMBER.findall(shown), NUMBER.findall(wanted)
    return NUMBER.sub("#", shown) == NUMBER.sub("#", wanted) and all(
        one == other or abs(Decimal(one) - Decimal(other)) <= last_place(other)
        for one, other in zip(ours, theirs, strict=True)
    )


def last_place(text):
    """One in the last digit of a number that is written so."""
    power = Decimal(text).as_tuple().exponent
    return Decimal(1).scaleb(power)


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
    pairs = [
        (key, line, quantity)
        for key, line in sources
        for quantity in line.quantities
        # the page has no levels of single tests
        if not any(one.quantity == quantity for one in line.levels)
    ]
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
